"""Where labels go: beside what they name, off every line and every other text."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from .drawing import Box, Drawing, Path, Point, Text, extent, text_box

DIRECTIONS = 24
REACHES = (0.9, 2.0, 3.4, 5.0, 7.0, 10.0, 14.0, 20.0)
"""Distances in mm tried between the point named and the nearest edge of the text."""
LEADER_FROM = 3.6
"""Beyond this distance a thin line leads from the label to its point."""
WEIGHTS = {
    **{"glass": 0.4, "heading": 1.5, "body": 0.0, "after": 2.5, "impulse": 2.5, "head": 2.5},
    **{"spin": 2.0, "moment": 2.5, "before": 2.0, "angle": 1.5, "change": 1.5},
}
"""What crossing a line of the role ending so costs, against 1 for any other."""


class Label(NamedTuple):
    """A text for the point ``at``, best placed in direction ``towards`` (need not be a unit)."""

    at: Point
    towards: Point
    text: str
    size: float = 8.0
    colour: str = "#000000"
    bold: bool = False
    role: str = ""


def place(drawing: Drawing, labels: Sequence[Label], frame: Box) -> None:
    """Add the labels to the drawing, first come first served, each at the cheapest place inside
    ``frame``: no overlap with a text (never, unless there is no room at all), then few lines
    crossed, near, and in the direction wished for."""
    taken = [text_box(text) for text in drawing.texts()]
    obstacles = [
        _obstacle(item) for item in drawing.items if isinstance(item, Path) and _weight(item.role)
    ]
    for label in labels:
        best: tuple[float, Text, float] | None = None
        for cost, text, reach in _candidates(label):
            if best is not None and cost >= best[0]:
                continue
            box = text_box(text)
            cost += 1e4 * sum(box.overlaps(other, 0.9) for other in taken)
            cost += 0.0 if frame.contains(box) else 1e3
            if best is not None and cost >= best[0]:
                continue
            cost += 4.0 * sum(
                weight
                for around, strokes, weight in obstacles
                if box.overlaps(around) and any(box.crosses(*stroke) for stroke in strokes)
            )
            if reach > LEADER_FROM:
                start, end = _leader_ends(label.at, box)
                between = extent((start, end))
                cost += 1.0 + 2.0 * sum(
                    weight
                    for around, strokes, weight in obstacles
                    if between.overlaps(around)
                    and any(_cross(start, end, *stroke) for stroke in strokes)
                )
            if best is None or cost < best[0]:
                best = (cost, text, reach)
        assert best is not None
        text = best[1]
        if best[2] > LEADER_FROM:
            leader = Path(_leader_ends(label.at, text_box(text)), label.colour, 0.12, role="leader")
            drawing.items.append(leader)
            obstacles.append(_obstacle(leader))
        drawing.items.append(text)
        taken.append(text_box(text))


def _candidates(label: Label) -> Iterator[tuple[float, Text, float]]:
    """Places for a label: what distance and direction alone cost, the text there, its reach."""
    for reach in REACHES:
        for step in range(DIRECTIONS):
            angle = math.tau * step / DIRECTIONS
            cost = 0.6 * reach + 1.5 * (1 - _agreement(label.towards, angle))
            yield cost, _beside(label, angle, reach), reach


def _obstacle(path: Path) -> tuple[Box, list[tuple[Point, Point]], float]:
    """A path as something to keep off: the box around it, its pieces and its weight."""
    return extent(path.points), _strokes(path), _weight(path.role)


def _strokes(path: Path) -> list[tuple[Point, Point]]:
    points = (*path.points, path.points[0]) if path.fill else path.points
    return list(pairwise(points))


def _weight(role: str) -> float:
    return WEIGHTS.get(role.rpartition(" ")[2], 1.0)


def _agreement(wish: Point, angle: float) -> float:
    size = math.hypot(*wish)
    if size == 0:
        return 1.0
    return (wish[0] * math.cos(angle) + wish[1] * math.sin(angle)) / size


def _beside(label: Label, angle: float, reach: float) -> Text:
    """The text whose box touches a circle of radius ``reach`` around the point at ``angle``."""
    probe = Text(0, 0, label.text, label.size, "start", label.colour, label.bold, label.role)
    box = text_box(probe)
    half = ((box.right - box.left) / 2, (box.top - box.bottom) / 2)
    along = (math.cos(angle), math.sin(angle))
    # how far the box's middle must be so that its edge is `reach` away in this direction
    inner = min(
        half[0] / abs(along[0]) if abs(along[0]) > 1e-9 else math.inf,
        half[1] / abs(along[1]) if abs(along[1]) > 1e-9 else math.inf,
    )
    middle = (
        label.at[0] + (reach + inner) * along[0],
        label.at[1] + (reach + inner) * along[1],
    )
    return probe._replace(
        x=middle[0] - half[0] - box.left, y=middle[1] - (box.top + box.bottom) / 2
    )


def _leader_ends(point: Point, box: Box) -> tuple[Point, Point]:
    """From just off the point named to the nearest place of the text's box."""
    nearest = (min(max(point[0], box.left), box.right), min(max(point[1], box.bottom), box.top))
    length = math.dist(point, nearest)
    share = min(0.8 / length, 1.0) if length else 1.0
    start = (point[0] + share * (nearest[0] - point[0]), point[1] + share * (nearest[1] - point[1]))
    return start, nearest


def _cross(start: Point, end: Point, first: Point, second: Point) -> bool:
    """Whether two straight pieces cross."""

    def side(a: Point, b: Point, c: Point) -> float:
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

    return (
        side(start, end, first) * side(start, end, second) < 0
        and side(first, second, start) * side(first, second, end) < 0
    )
