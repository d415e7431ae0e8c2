"""Panels of a chart: two axes with round numbers, what is drawn between them, and a key. Nothing is
hatched, which some renderers of SVG paint black; a grey copy reads the same."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from . import drawing as d
from .drawing import BLACK, GREY, ROW, TEXT, Box, Drawing, Path, Text

MARKS = {"o": (24, 0), "s": (4, 45), "D": (4, 0), "^": (3, 90), "v": (3, -90), ">": (3, 0)}
MARKS |= {"P": (5, 90), "_": (2, 0)}
"""Corners of each mark, and where the first of them stands in degrees."""
BELOW = 3.3
"""From the axis down to the numbers' baseline, in mm."""


class Axis(NamedTuple):
    """Numbers from ``low`` to ``high`` on paper from ``start`` to ``end``."""

    low: float
    high: float
    start: float
    end: float
    log: bool = False

    def __call__(self, value: Any) -> Any:
        """Where a number, or an array of them, is."""
        low, high = self.low, self.high
        if self.log:
            low, high, value = math.log10(low), math.log10(high), np.log10(value)
        return self.start + (value - low) / (high - low) * (self.end - self.start)


def span(values: Any, margin: float = 0.05) -> tuple[float, float]:
    """From the smallest to the largest finite value, and a share of that beyond both."""
    values = np.asarray(values, float).ravel()
    values = values[np.isfinite(values)]
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
    more = margin * (high - low) or 0.05 * abs(low) or 1.0
    return low - more, high + more


def ticks(low: float, high: float, most: int) -> list[tuple[float, str]]:
    """At most so many round numbers from ``low`` to ``high``, each with its text."""
    power = math.floor(math.log10((high - low) / most))
    for power_, step in ((power, 1), (power, 2), (power, 5), (power + 1, 1), (power + 1, 2)):
        size = step * 10.0**power_
        numbers = range(math.ceil(low / size - 1e-9), math.floor(high / size + 1e-9) + 1)
        if len(numbers) <= most:
            break
    decimals = max(0, -power_)
    largest = max(abs(low), abs(high))
    if largest < 1e6 and decimals <= 4:
        texts = [f"{number * size:.{decimals}f}" for number in numbers]
    else:
        digits = max(0, math.floor(math.log10(largest)) - power_)
        texts = [f"{number * size:.{digits}e}" for number in numbers]
    return [(n * size, t.replace("-", "−")) for n, t in zip(numbers, texts, strict=True)]


def powers(low: float, high: float, step: int) -> list[tuple[float, str]]:
    """Powers of ten, every ``step``-th with a text."""
    first, last = round(math.log10(low)), round(math.log10(high))
    return [
        (10.0**n, "1" if n == 0 else f"1e{n}".replace("-", "−") if n % step == 0 else "")
        for n in range(first, last + 1)
    ]


class Panel:
    """Two axes around ``box``; the numbers stand below and left of it, the upper axis's name above
    it, the lower one's below. ``x`` and ``y`` are (lowest, highest)."""

    def __init__(
        self,
        drawing: Drawing,
        box: Box,
        x: tuple[float, float],
        y: tuple[float, float],
        x_label: str = "",
        y_label: str = "",
        *,
        x_ticks: Sequence[tuple[float, str]] | int = 6,
        y_ticks: Sequence[tuple[float, str]] | int = 4,
        log: bool = False,
        grid: bool = False,
    ) -> None:
        self.drawing, self.box = drawing, box
        self.x = Axis(*x, box.left, box.right, log)
        self.y = Axis(*y, box.bottom, box.top, log)
        self._ground = len(drawing.items)
        corner, right, _, top = box.corners
        for end in (right, top):
            drawing.add(Path((corner, end), BLACK, 0.2, role="axis"))
        up, left = 1j * box.height, -1.5 - 0.8j
        for axis, given, inward, outward, shift, look in (
            (self.x, x_ticks, up, -0.9j, -1j * BELOW, ("middle", "x tick")),
            (self.y, y_ticks, box.width, -0.9, left, ("end", "y tick")),
        ):
            marks = ticks(axis.low, axis.high, given) if isinstance(given, int) else given
            for value, text in marks:
                place = axis(value)
                at = complex(place, box.bottom) if axis is self.x else complex(box.left, place)
                if grid:
                    drawing.add(Path((at, at + inward), "#dddddd", 0.14, role="grid"))
                drawing.add(Path((at, at + outward), BLACK, 0.2, role="tick"))
                drawing.add(Text(at + shift, text, anchor=look[0], role=look[1]))
        room = box.width + 8
        at = complex((box.left + box.right) / 2, box.bottom - BELOW - ROW + 0.2)
        for line in d.wrapped(x_label, room) if x_label else []:
            drawing.add(Text(at, line, anchor="middle", role="x label"))
            at -= 1j * ROW
        if y_label:
            drawing.add(Text(complex(box.left - 1, box.top + 1.8), y_label, role="y label"))

    def at(self, x: float, y: float) -> complex:
        """Where a pair of numbers is on paper."""
        return complex(self.x(x), self.y(y))

    def line(self, xs: Any, ys: Any, colour: str, width: float = 0.4, **look: Any) -> None:
        """A line through pairs of numbers; pieces with one that is not finite are left out.
        ``look``: as of a `Path`."""
        points = self.x(np.asarray(xs, float)) + 1j * self.y(np.asarray(ys, float))
        finite = np.isfinite(points)
        for piece in np.split(points, np.flatnonzero(np.diff(finite)) + 1):
            if len(piece) > 1 and np.isfinite(piece[0]):
                self.drawing.add(Path(tuple(map(complex, piece)), colour, width, **look))

    def rule(self, x: float, colour: str = BLACK, **look: Any) -> None:
        """A line over the whole height."""
        self.line([x, x], [self.y.low, self.y.high], colour, 0.35, **look)

    def shade(self, low: float, high: float, colour: str) -> None:
        """A stretch of the horizontal axis, behind everything."""
        box = Box(self.x(low), self.box.bottom, self.x(high), self.box.top)
        self.drawing.items.insert(self._ground, Path(box.corners, None, fill=colour, role="shade"))

    def mark(self, x: float, y: float, shape: str = "o", *look: Any, **looks: Any) -> None:
        """A mark at a pair of numbers, if they are finite."""
        at = self.at(x, y)
        if math.isfinite(abs(at)):
            self.drawing.add(mark(at, shape, *look, **looks))


def mark(
    at: complex, shape: str, colour: str = BLACK, filled: bool = True, role: str = "mark"
) -> Path:
    corners, turn = MARKS[shape]
    points = tuple(at + 0.9 * d.unit(turn + 360 * i / corners) for i in range(corners))
    return Path(points, colour, 0.3, (), colour if filled else d.WHITE, role)


def key(drawing: Drawing, y: float, *entries: tuple[str, str, Any], note: str = "") -> float:
    """Samples of what is drawn and what they mean, in rows from ``y`` on; returns where what
    follows goes on. An entry is (text, colour, look): a mark (``o``, or ``o `` for an open one),
    dashes of a line, or None for an area."""
    x, sample = 2.0, 6.0
    for text, colour, look in entries:
        width = sample + 1.2 + d.text_width(text, TEXT)
        if x > 2.0 and x + width > drawing.width - 2:
            x, y = 2.0, y - ROW
        start = complex(x, y + 0.8)
        if isinstance(look, str):
            drawing.add(mark(start + sample / 2, look[0], colour, look[-1] != " ", "key"))
        elif look is None:
            ends = Box(x, start.imag - 0.9, x + sample, start.imag + 0.9).corners
            drawing.add(Path(ends, GREY, 0.15, fill=colour, role="key"))
        else:
            drawing.add(Path((start, start + sample), colour, 0.4, look, role="key"))
        drawing.add(Text(complex(x + sample + 1.2, y), text, role="legend"))
        x += width + 3.0
    if note:
        y -= ROW
        drawing.add(Text(complex(2, y), note, colour=GREY, role="note"))
    return y - ROW
