"""Figure 4: the four configurations of the staged collisions, from Table 1's own numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from . import drawing as d
from .drawing import Box, Drawing, Path, Point, Text
from .labels import Label, place
from .scenegeometry import Plan, plan
from .sceneview import COLOURS, draw_bodies

_GAP = 4.0
_TITLE = 5.0
_PAD = 3.5


def configurations() -> Drawing:
    """One collision of each category as it stood at contact, velocities before, one scale."""
    from ..chapter.staged import collisions

    chosen: dict[str, Any] = {}
    for collision in collisions():
        chosen.setdefault(collision.category, collision)
    plans = [
        plan({**collision.scene, "E": 0, "MU": 0, "EM": -1, "M": 6})
        for collision in chosen.values()
    ]
    arrow = 0.8 * max(v.length for shapes in plans for v in shapes.vehicles)
    boxes = [d.extent(_points(shapes, arrow)) for shapes in plans]
    wide = (d.COLUMN - _GAP) / 2
    # one scale for all four: real cars of comparable size
    scale = min((wide - 2 * _PAD) / (box.right - box.left) for box in boxes)
    rows = [
        max(scale * (box.top - box.bottom) for box in boxes[i : i + 2]) + 2 * _PAD + _TITLE
        for i in range(0, len(boxes), 2)
    ]
    drawing = Drawing(
        d.COLUMN,
        sum(rows) + 1.0,
        "Experimental collision configurations",
        "Staged collisions: " + "; ".join(category.lower() for category in chosen) + ".",
    )
    top = drawing.height
    for place_, (category, collision) in enumerate(chosen.items()):
        row, column = divmod(place_, 2)
        left = column * (wide + _GAP)
        upper = top - sum(rows[:row])
        box = boxes[place_]
        origin = (
            left + wide / 2 - scale * (box.left + box.right) / 2,
            upper - _TITLE - (rows[row] - _TITLE) / 2 - scale * (box.bottom + box.top) / 2,
        )
        title = f"{'abcd'[place_]}. {category.lower()} (no. {collision.number})"
        drawing.items.append(Text(left + 1.0, upper - 3.6, title, 7, role="panel title"))
        frame = Box(left + 0.3, upper - rows[row] + 0.3, left + wide - 0.3, upper - _TITLE + 0.5)
        _panel(drawing, plans[place_], origin, scale, arrow, frame)
    return drawing


def _points(shapes: Plan, arrow: float) -> list[Point]:
    fastest = max(vehicle.before.speed for vehicle in shapes.vehicles)
    points = [point for vehicle in shapes.vehicles for point in vehicle.outline]
    for vehicle in shapes.vehicles:
        run = arrow / fastest
        x, y = vehicle.before.velocity
        points.append((vehicle.center[0] - run * x, vehicle.center[1] - run * y))
    return points


def _panel(
    drawing: Drawing, shapes: Plan, origin: Point, scale: float, arrow: float, frame: Box
) -> None:
    def at(point: Point) -> Point:
        return (origin[0] + scale * point[0], origin[1] + scale * point[1])

    def ats(points: Sequence[Point]) -> tuple[Point, ...]:
        return tuple(at(point) for point in points)

    labels = []
    fastest = max(vehicle.before.speed for vehicle in shapes.vehicles)
    draw_bodies(drawing.items, shapes.vehicles, ats)
    for vehicle in shapes.vehicles:
        colour = COLOURS[vehicle.name]
        x, y = vehicle.before.velocity
        if vehicle.before.speed:
            run = arrow / fastest
            start = at((vehicle.center[0] - run * x, vehicle.center[1] - run * y))
            drawing.items += d.arrow(
                start, at(vehicle.center), colour, 0.45, (1.3, 0.7), 2.0, f"{vehicle.name} before"
            )
        drawing.items.append(Path(d.circle(at(vehicle.center), 0.5), colour, 0.3, fill=d.WHITE))
        labels.append(Label(at(vehicle.center), (0.3, 1.0), vehicle.name, 8, colour, True))
    drawing.items.append(Path(d.circle(at((0.0, 0.0)), 0.5), d.BLACK, 0.3, fill=d.WHITE))
    place(drawing, labels, frame)
