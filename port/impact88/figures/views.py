"""Drawings of several views: before, impact and after; the configurations of Figure 4."""

import cmath
from collections.abc import Mapping
from typing import Any

from ..errors import UserError
from . import drawing as d
from . import sceneview as view
from .drawing import ROW, Box, Drawing, Path, Text, View
from .labels import place
from .scenegeometry import Motion, Plan, Vehicle, plan
from .sceneview import COLOURS

_GAP = 6.0
"""Between the views of a strip, in mm."""


def strip_drawing(
    scene: Any, result: Mapping[str, Any], title: str = "Before, impact and after"
) -> Drawing:
    """Before, impact and after side by side, two columns wide, in one scale; the vehicles move and
    turn for the time in which the faster one goes its own length. Arguments as `scene_drawing`.
    Raises UserError without final velocities."""
    shapes, units = view.planned(scene, result, None, None)
    if not all(vehicle.after for vehicle in shapes.vehicles):
        raise UserError("there are no velocities after the impact to draw")
    bodies = shapes.bodies
    size = max(vehicle.length for vehicle in bodies)
    speed = max(m.speed for v in bodies for m in (v.before, v.after) if m)
    time = size / speed if speed else 0.0
    frames = {
        "before": [_carried(v, v.before, -time) for v in bodies],
        "impact": bodies,
        "after": [_carried(v, v.after, time) for v in bodies if v.after],
    }
    boxes = {
        kind: d.extent(p for v in moved for p in (*v.outline, _tip(v, kind, 0.5 * time)))
        for kind, moved in frames.items()
    }
    drawing = Drawing(2 * d.COLUMN, title, view.description(shapes, units))
    top = drawing.heading() - 2 * ROW
    room = drawing.width - 4.0 - 2 * _GAP
    wide, high = sum(b.width for b in boxes.values()), max(b.height for b in boxes.values())
    scale = min(room / wide, view.FIELD / high)
    left, bottom = 2.0 + (room - scale * wide) / 2, top - scale * high - 2
    for kind, moved in frames.items():
        box = boxes[kind]
        low = bottom + scale * (high - box.height) / 2
        at = View(complex(left - scale * box.left, low - scale * box.bottom), scale)
        view.draw_bodies(drawing, moved, at)
        for vehicle in moved:
            tail, tip = at.all((vehicle.center, _tip(vehicle, kind, 0.5 * time)))
            if abs(tip - tail) > 0.5:
                drawing.add(*view.velocity_arrow(vehicle, kind, tail, tip))
            drawing.add(view.name_label(vehicle, tail, -vehicle.front))
        if kind == "impact" and shapes.impulse:
            force = 0.5 * size * shapes.impulse / abs(shapes.impulse)
            for end in (force, -force):
                drawing.add(*d.arrow(at(0), at(end), view.IMPULSE, 0.7, head=2.4, role="impulse"))
        middle = complex(left + scale * box.width / 2, top + 0.8 * ROW)
        drawing.add(Text(middle, kind, 7.5, "middle", bold=True, role="caption"))
        place(drawing, Box(0.8, bottom, drawing.width - 0.8, top))
        left += scale * box.width + _GAP
    view.table_and_notes(drawing, shapes, bottom, units)
    return drawing


def _carried(vehicle: Vehicle, motion: Motion, time: float) -> Vehicle:
    """A vehicle, uncrushed, after it has moved and turned for a time, which may be negative."""
    center = vehicle.center + time * motion.velocity
    turn = cmath.rect(1.0, motion.spin * time)
    outline = tuple(center + turn * (point - vehicle.center) for point in vehicle.outline)
    return vehicle._replace(
        center=center, front=turn * vehicle.front, outline=outline, kept=outline
    )


def _tip(vehicle: Vehicle, kind: str, time: float) -> complex:
    """Where the arrow of a vehicle's velocity ends."""
    motion = vehicle.after if kind == "after" and vehicle.after else vehicle.before
    return vehicle.center + (time if kind != "impact" else 0.0) * motion.velocity


_PANEL_GAP, _TITLE, _PAD = 4.0, 5.0, 3.5
"""In mm: between panels, of a panel's title, within a panel."""


def configurations() -> Drawing:
    """One collision of each category as it stood at contact, velocities before, one scale."""
    from ..chapter.staged import collisions

    chosen: dict[str, Any] = {}
    for collision in collisions():
        chosen.setdefault(collision.category, collision)
    plans = [plan({**item.scene, "E": 0, "MU": 0, "EM": -1, "M": 6}) for item in chosen.values()]
    arrow = 0.8 * max(v.length for shapes in plans for v in shapes.vehicles)
    boxes = [
        d.extent(p for v in shapes.vehicles for p in (*v.outline, _tail(v, shapes, arrow)))
        for shapes in plans
    ]
    wide = (d.COLUMN - _PANEL_GAP) / 2
    # one scale for all four: real cars of comparable size
    scale = min((wide - 2 * _PAD) / box.width for box in boxes)
    description = "Staged collisions: " + "; ".join(category.lower() for category in chosen) + "."
    drawing = Drawing(d.COLUMN, "Experimental collision configurations", description)
    top = 0.0
    for count, (category, collision) in enumerate(chosen.items()):
        row, column = divmod(count, 2)
        box, left = boxes[count], column * (wide + _PANEL_GAP)
        tall = scale * max(other.height for other in boxes[2 * row : 2 * row + 2]) + 2 * _PAD
        title = f"{'abcd'[count]}. {category.lower()} (no. {collision.number})"
        drawing.add(Text(complex(left + 1, top - 3.6), title, 7, role="panel title"))
        middle = complex(left + wide / 2, top - _TITLE - tall / 2)
        at = View(middle - scale * complex(box.left + box.right, box.bottom + box.top) / 2, scale)
        bottom = top - _TITLE - tall
        frame = Box(left + 0.3, bottom + 0.3, left + wide - 0.3, top - _TITLE + 0.5)
        view.draw_bodies(drawing, plans[count].vehicles, at)
        for vehicle in plans[count].vehicles:
            colour, center = COLOURS[vehicle.name], at(vehicle.center)
            start = at(_tail(vehicle, plans[count], arrow))
            drawing.add(*view.velocity_arrow(vehicle, "before", start, center, head=2.0))
            drawing.add(Path(d.circle(center, 0.5), colour, 0.3, fill=d.WHITE))
            drawing.add(view.name_label(vehicle, center, 0.3 + 1j, 8))
        drawing.add(Path(d.circle(at(0), 0.5), d.BLACK, 0.3, fill=d.WHITE))
        place(drawing, frame)
        if column:
            top = bottom
    drawing.height = 1.0 - top
    return drawing


def _tail(vehicle: Vehicle, shapes: Plan, arrow: float) -> complex:
    """Where the arrow of a vehicle's velocity starts; the fastest one's is ``arrow`` long."""
    fastest = max(other.before.speed for other in shapes.vehicles)
    return vehicle.center - arrow / fastest * vehicle.before.velocity
