"""Where labels go: beside what they name, off every line and every other text."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from .drawing import Box, Drawing, Path, Text, text_box

DIRECTIONS = 24
"""Half as many leave labels on lines that a step of 15 degrees clears; twice as many change
nothing."""
REACHES = (0.9, 2.0, 3.4, 5.0, 7.0, 10.0, 14.0, 20.0)
"""Distances in mm tried between the point named and the nearest edge of the text."""
LEADER_FROM = 3.6
"""Beyond this distance a thin line leads from the label to its point."""
GAP = 0.9
"""Least distance in mm of two texts."""
STEP = 0.4
"""Distance in mm of the points that lines are looked at by: a fifth of a text's height."""
WEIGHTS = {
    **{"glass": 0.4, "heading": 1.5, "body": 0.0, "after": 2.5, "impulse": 2.5, "head": 2.5},
    **{"spin": 2.0, "moment": 2.5, "before": 2.0, "angle": 1.5, "change": 1.5},
}
"""What covering a line of the role ending so costs, against 1 for any other."""


def place(drawing: Drawing, frame: Box) -> None:
    """Turn the drawing's labels into texts, each at the cheapest place inside ``frame``: off other
    texts where there is room, few lines covered, near, and in the direction wished for."""
    reach, turn = (
        values.ravel()
        for values in np.meshgrid(REACHES, np.arange(DIRECTIONS) * (2 * np.pi / DIRECTIONS))
    )
    along = np.exp(1j * turn)
    lines = [_samples(path) for path in drawing.paths()]
    points, weights = (np.concatenate(parts) for parts in zip(*lines, strict=True))
    taken = [text_box(text) for text in drawing.texts()]
    for label in drawing.labels:
        text = Text(0j, label.text, label.size, "start", *label[4:])
        box = text_box(text)
        half = complex(box.width, box.height) / 2
        # how far the box's middle must be so that its edge is `reach` away in this direction
        with np.errstate(divide="ignore"):
            inner = np.minimum(half.real / np.abs(along.real), half.imag / np.abs(along.imag))
        middles = label.at + (reach + inner) * along
        low, high = middles[:, None] - half, middles[:, None] + half
        wish = label.towards / abs(label.towards) if label.towards else 0j
        cost = 0.6 * reach + 1.5 * (1 - (wish.conjugate() * along).real) + (reach > LEADER_FROM)
        left, bottom, right, top = np.array(taken).reshape(-1, 4).T
        near = (low.real < right + GAP) & (high.real > left - GAP)
        near &= (low.imag < top + GAP) & (high.imag > bottom - GAP)
        inside = (low.real >= frame.left) & (high.real <= frame.right)
        inside &= (low.imag >= frame.bottom) & (high.imag <= frame.top)
        covered = (low.real < points.real) & (points.real < high.real)
        covered &= (low.imag < points.imag) & (points.imag < high.imag)
        cost += 1e4 * near.sum(1) + 1e3 * ~inside[:, 0] + 1.5 * (covered @ weights)
        best = int(np.argmin(cost))
        text = text._replace(at=complex(low[best, 0]) - complex(box.left, box.bottom))
        box = text_box(text)
        if reach[best] > LEADER_FROM:
            x, y = label.at.real, label.at.imag
            end = complex(min(max(x, box.left), box.right), min(max(y, box.bottom), box.top))
            start = label.at + min(0.8 / abs(end - label.at), 1.0) * (end - label.at)
            drawing.add(Path((start, end), label.colour, 0.12, role="leader"))
        drawing.add(text)
        taken.append(box)
    drawing.labels.clear()


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
