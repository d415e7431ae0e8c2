"""Before, impact and after side by side."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from ..errors import UserError
from ..units import System, system_of
from . import drawing as d
from .drawing import Box, Drawing, Point, Text
from .labels import Label, place
from .scenegeometry import Motion, Vehicle, minus, plan, plus, scaled
from .sceneview import (
    ARROWS,
    COLOURS,
    FIELD,
    IMPULSE,
    ROW,
    TEXT,
    description,
    draw_bodies,
    draw_table,
    notes_of,
)


def strip_drawing(
    scene: Any,
    result: Mapping[str, Any],
    title: str = "Before, impact and after",
    units: System | None = None,
    outlines: Mapping[str, float] | None = None,
) -> Drawing:
    """Before, impact and after side by side, two columns wide, in one scale. The vehicles move and
    turn as they did for the time in which the faster one goes its own length. Arguments as
    `scene_drawing`; ``result`` must hold the final velocities. Raises UserError without them."""
    if outlines is None and hasattr(scene, "entries"):
        outlines = scene.entries.outlines
    if units is None:
        units = system_of(getattr(scene, "units", None))
    shapes = plan(scene, result, outlines)
    if not all(vehicle.after for vehicle in shapes.vehicles):
        raise UserError("there are no velocities after the impact to draw")
    vehicles = [vehicle for vehicle in shapes.vehicles if not vehicle.wall]
    size = max(vehicle.length for vehicle in vehicles)
    speed = max(m.speed for v in vehicles for m in (v.before, v.after) if m)
    time = size / speed if speed else 0.0
    frames = {
        "before": [_carried(v, v.before, -time) for v in vehicles],
        "impact": vehicles,
        "after": [_carried(v, v.after, time) for v in vehicles if v.after],
    }
    boxes = {
        kind: d.extent([p for v in moved for p in (*v.outline, _tip(v, kind, 0.5 * time))])
        for kind, moved in frames.items()
    }
    width, gap = 2 * d.COLUMN, 6.0
    room = width - 4.0 - 2 * gap
    scale = min(
        room / sum(box.right - box.left for box in boxes.values()),
        FIELD / max(box.top - box.bottom for box in boxes.values()),
    )
    tall = scale * max(box.top - box.bottom for box in boxes.values())
    notes = notes_of(shapes, units, width - 4)
    foot = ROW * (len(notes) + len(shapes.vehicles) + 2)
    drawing = Drawing(width, tall + foot + 3 * ROW + 4, title, description(shapes, units))
    drawing.items.append(Text(2.0, drawing.height - ROW, title, 7, bold=True, role="title"))
    left = 2.0 + (room - scale * sum(box.right - box.left for box in boxes.values())) / 2
    for kind, moved in frames.items():
        box = boxes[kind]
        low = foot + 2 + (tall - scale * (box.top - box.bottom)) / 2
        start, base = left - scale * box.left, low - scale * box.bottom

        def ats(
            points: Sequence[Point], start: float = start, base: float = base
        ) -> tuple[Point, ...]:
            return tuple((start + scale * x, base + scale * y) for x, y in points)

        draw_bodies(drawing.items, moved, ats)
        labels = []
        for vehicle in moved:
            colour = COLOURS[vehicle.name]
            tail, tip = ats((vehicle.center, _tip(vehicle, kind, 0.5 * time)))
            if math.dist(tail, tip) > 0.5:
                _, thick, dash, head = ARROWS[kind]
                role = f"{vehicle.name} {kind}"
                drawing.items += d.arrow(tail, tip, colour, thick, dash, head, role)
            back = scaled(vehicle.front, -1.0)
            labels.append(Label(tail, back, vehicle.name, 10, colour, True, "name"))
        if kind == "impact" and shapes.impulse:
            force = scaled(shapes.impulse, 0.5 * size / math.hypot(*shapes.impulse))
            for end in (force, scaled(force, -1.0)):
                tail, tip = ats(((0.0, 0.0), end))
                drawing.items += d.arrow(tail, tip, IMPULSE, 0.7, head=2.4, role="impulse")
        middle = left + scale * (box.right - box.left) / 2
        top = foot + tall + 2 + 0.8 * ROW
        drawing.items.append(Text(middle, top, kind, 7.5, "middle", bold=True, role="caption"))
        place(drawing, labels, Box(0.8, foot, width - 0.8, foot + tall + 2))
        left += scale * (box.right - box.left) + gap
    y = draw_table(drawing, shapes, foot, units)
    for note in notes:
        drawing.items.append(Text(2.0, y, note, TEXT, colour=d.GREY, role="note"))
        y -= ROW
    return drawing


def _carried(vehicle: Vehicle, motion: Motion, time: float) -> Vehicle:
    """A vehicle a time later, or earlier, whole and as it moved and turned meanwhile."""
    center = plus(vehicle.center, scaled(motion.velocity, time))
    turn = motion.spin * time
    cosine, sine = math.cos(turn), math.sin(turn)

    def turned(point: Point) -> Point:
        x, y = minus(point, vehicle.center)
        return plus(center, (cosine * x - sine * y, sine * x + cosine * y))

    outline = tuple(map(turned, vehicle.outline))
    front = minus(turned(plus(vehicle.center, vehicle.front)), center)
    return vehicle._replace(center=center, front=front, outline=outline, kept=outline)


def _tip(vehicle: Vehicle, kind: str, time: float) -> Point:
    """Where the arrow of a vehicle's velocity ends."""
    motion = vehicle.after if kind == "after" and vehicle.after else vehicle.before
    return plus(vehicle.center, scaled(motion.velocity, time if kind != "impact" else 0.0))
