"""Where labels go: beside what they name, off every line and every other text."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .drawing import BLACK, Box, Drawing, Path, Text, text_box

if TYPE_CHECKING:
    from numpy.typing import NDArray

DIRECTIONS = 24
"""Half as many leave labels on lines that a step of 15 degrees clears; twice as many change
nothing."""
REACHES = (0.9, 2.0, 3.4, 5.0, 7.0, 10.0, 14.0, 20.0)
"""Distances in mm tried between the point named and the nearest edge of the text."""
LEADER_FROM = 3.6
"""Beyond this distance a thin line leads from the label to its point."""
STEP = 0.4
"""Distance in mm of the points that lines are looked at by: a fifth of a text's height."""
WEIGHTS = {
    **{"glass": 0.4, "heading": 1.5, "body": 0.0, "after": 2.5, "impulse": 2.5, "head": 2.5},
    **{"spin": 2.0, "moment": 2.5, "before": 2.0, "angle": 1.5, "change": 1.5},
}
"""What covering a line of the role ending so costs, against 1 for any other."""


class Label(NamedTuple):
    """A text for the point ``at``, best placed in direction ``towards`` (of any length)."""

    at: complex
    towards: complex
    text: str
    size: float = 8.0
    colour: str = BLACK
    bold: bool = False
    role: str = ""


def place(drawing: Drawing, labels: Sequence[Label], frame: Box) -> None:
    """Add the labels to the drawing, first come first served, each at the cheapest place inside
    ``frame``: no overlap with a text (unless there is no room at all), then few lines covered,
    near, and in the direction wished for."""
    reach, turn = (
        values.ravel()
        for values in np.meshgrid(REACHES, np.arange(DIRECTIONS) * (2 * np.pi / DIRECTIONS))
    )
    along = np.exp(1j * turn)
    lines = [_samples(path) for path in drawing.paths()]
    points, weights = (np.concatenate(parts) for parts in zip(*lines, strict=True))
    taken = [text_box(text) for text in drawing.texts()]
    for label in labels:
        text = Text(0j, label.text, label.size, "start", *label[4:])
        box = text_box(text)
        half = complex(box.width, box.height) / 2
        # how far the box's middle must be so that its edge is `reach` away in this direction
        with np.errstate(divide="ignore"):
            inner = np.minimum(half.real / np.abs(along.real), half.imag / np.abs(along.imag))
        middles = label.at + (reach + inner) * along
        boxes = Box(
            *(middles.real - half.real, middles.imag - half.imag),
            *(middles.real + half.real, middles.imag + half.imag),
        )
        wish = label.towards / abs(label.towards) if label.towards else 0j
        cost = 0.6 * reach + 1.5 * (1 - (wish.conjugate() * along).real) + (reach > LEADER_FROM)
        for other in taken:
            cost += 1e4 * _shared(boxes, other)
        inside = (boxes.left >= frame.left) & (boxes.right <= frame.right)
        cost += 1e3 * ~(inside & (boxes.bottom >= frame.bottom) & (boxes.top <= frame.top))
        cost += 1.5 * (_covered(boxes, points) @ weights)
        best = int(np.argmin(cost))
        start = complex(middles[best]) - half - complex(box.left, box.bottom)
        text = text._replace(at=start)
        box = text_box(text)
        if reach[best] > LEADER_FROM:
            near = complex(
                min(max(label.at.real, box.left), box.right),
                min(max(label.at.imag, box.bottom), box.top),
            )
            away = label.at + min(0.8 / abs(near - label.at), 1.0) * (near - label.at)
            drawing.items.append(Path((away, near), label.colour, 0.12, role="leader"))
        drawing.items.append(text)
        taken.append(box)


def _samples(path: Path) -> tuple[NDArray[np.complex128], NDArray[np.float64]]:
    """Points along a path, and what covering each costs."""
    weight = WEIGHTS.get(path.role.rpartition(" ")[2], 1.0)
    ends = (*path.points, path.points[0]) if path.fill else path.points
    runs = [
        start + (end - start) * np.linspace(0, 1, int(abs(end - start) / STEP) + 2)
        for start, end in pairwise(ends)
        if weight
    ]
    points = np.concatenate(runs) if runs else np.empty(0, complex)
    return points, np.full(len(points), weight)


def _shared(boxes: Box, other: Box, gap: float = 0.9) -> NDArray[np.bool_]:
    """Which boxes (of arrays) come nearer than ``gap`` to another."""
    return np.asarray(
        (boxes.left < other.right + gap)
        & (boxes.right > other.left - gap)
        & (boxes.bottom < other.top + gap)
        & (boxes.top > other.bottom - gap)
    )


def _covered(boxes: Box, points: NDArray[np.complex128]) -> NDArray[np.bool_]:
    """Which points lie in which of the boxes."""
    left, bottom, right, top = (np.asarray(side)[:, None] for side in boxes)
    x, y = points.real, points.imag
    return np.asarray((left < x) & (x < right) & (bottom < y) & (y < top))
