"""Figure 4: the four configurations of the staged collisions, from Table 1's own numbers."""

from __future__ import annotations

from typing import Any

from . import drawing as d
from .drawing import Box, Drawing, Path, Text, View
from .labels import place
from .scenegeometry import Plan, Vehicle, plan
from .sceneview import ARROWS, COLOURS, draw_bodies, name_label

_GAP = 4.0
_TITLE = 5.0
_PAD = 3.5


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
    wide = (d.COLUMN - _GAP) / 2
    # one scale for all four: real cars of comparable size
    scale = min((wide - 2 * _PAD) / box.width for box in boxes)
    description = "Staged collisions: " + "; ".join(category.lower() for category in chosen) + "."
    drawing = Drawing(d.COLUMN, "Experimental collision configurations", description)
    top = 0.0
    for count, (category, collision) in enumerate(chosen.items()):
        row, column = divmod(count, 2)
        box, left = boxes[count], column * (wide + _GAP)
        tall = scale * max(other.height for other in boxes[2 * row : 2 * row + 2]) + 2 * _PAD
        title = f"{'abcd'[count]}. {category.lower()} (no. {collision.number})"
        drawing.add(Text(complex(left + 1, top - 3.6), title, 7, role="panel title"))
        middle = complex(left + wide / 2, top - _TITLE - tall / 2)
        at = View(middle - scale * complex(box.left + box.right, box.bottom + box.top) / 2, scale)
        bottom = top - _TITLE - tall
        frame = Box(left + 0.3, bottom + 0.3, left + wide - 0.3, top - _TITLE + 0.5)
        _panel(drawing, plans[count], at, arrow, frame)
        if column:
            top = bottom
    drawing.height = 1.0 - top
    return drawing


def _tail(vehicle: Vehicle, shapes: Plan, arrow: float) -> complex:
    """Where the arrow of a vehicle's velocity starts; the fastest one's is ``arrow`` long."""
    fastest = max(other.before.speed for other in shapes.vehicles)
    return vehicle.center - arrow / fastest * vehicle.before.velocity


def _panel(drawing: Drawing, shapes: Plan, at: View, arrow: float, frame: Box) -> None:
    draw_bodies(drawing, shapes.vehicles, at)
    for vehicle in shapes.vehicles:
        colour, center = COLOURS[vehicle.name], at(vehicle.center)
        start, (_, width, dash, _) = at(_tail(vehicle, shapes, arrow)), ARROWS["before"]
        role = f"{vehicle.name} before"
        drawing.add(*d.arrow(start, center, colour, width, dash, 2.0, role))
        drawing.add(Path(d.circle(center, 0.5), colour, 0.3, fill=d.WHITE))
        drawing.add(name_label(vehicle, center, 0.3 + 1j, 8))
    drawing.add(Path(d.circle(at(0), 0.5), d.BLACK, 0.3, fill=d.WHITE))
    place(drawing, frame)
