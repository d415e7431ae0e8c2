"""Before, impact and after side by side."""

from __future__ import annotations

import cmath
from collections.abc import Mapping
from typing import Any

from ..errors import UserError
from . import drawing as d
from .drawing import ROW, Box, Drawing, Text, View
from .labels import place
from .scenegeometry import Motion, Vehicle
from .sceneview import (
    ARROWS,
    COLOURS,
    FIELD,
    IMPULSE,
    description,
    draw_bodies,
    name_label,
    planned,
    table_and_notes,
)

_GAP = 6.0


def strip_drawing(
    scene: Any, result: Mapping[str, Any], title: str = "Before, impact and after"
) -> Drawing:
    """Before, impact and after side by side, two columns wide, in one scale. The vehicles move and
    turn as they did for the time in which the faster one goes its own length. Arguments as
    `scene_drawing`; ``result`` must hold the final velocities. Raises UserError without them."""
    shapes, units = planned(scene, result, None, None)
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
    drawing = Drawing(2 * d.COLUMN, title, description(shapes, units))
    top = drawing.heading() - 2 * ROW
    room = drawing.width - 4.0 - 2 * _GAP
    wide, high = sum(b.width for b in boxes.values()), max(b.height for b in boxes.values())
    scale = min(room / wide, FIELD / high)
    left, bottom = 2.0 + (room - scale * wide) / 2, top - scale * high - 2
    for kind, moved in frames.items():
        box = boxes[kind]
        low = bottom + scale * (high - box.height) / 2
        at = View(complex(left - scale * box.left, low - scale * box.bottom), scale)
        draw_bodies(drawing, moved, at)
        for vehicle in moved:
            tail, tip = at.all((vehicle.center, _tip(vehicle, kind, 0.5 * time)))
            if abs(tip - tail) > 0.5:
                look, role = ARROWS[kind][1:], f"{vehicle.name} {kind}"
                drawing.add(*d.arrow(tail, tip, COLOURS[vehicle.name], *look, role))
            drawing.add(name_label(vehicle, tail, -vehicle.front))
        if kind == "impact" and shapes.impulse:
            force = 0.5 * size * shapes.impulse / abs(shapes.impulse)
            for end in (force, -force):
                drawing.add(*d.arrow(at(0), at(end), IMPULSE, 0.7, head=2.4, role="impulse"))
        middle = complex(left + scale * box.width / 2, top + 0.8 * ROW)
        drawing.add(Text(middle, kind, 7.5, "middle", bold=True, role="caption"))
        place(drawing, Box(0.8, bottom, drawing.width - 0.8, top))
        left += scale * box.width + _GAP
    table_and_notes(drawing, shapes, bottom, units)
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
