"""Drawings as lists of paths and texts, in millimetres on paper, y upwards.

What a drawing shows is decided once, here and above; writing it as SVG (`figures.svg`, no library
needed) or with matplotlib (`figures.canvas`) only copies it. Sizes of texts are reckoned with the
widths of DejaVu Sans, matplotlib's own font and as wide as any likely to stand in for it, so texts
that do not overlap here overlap nowhere.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

from ..errors import UserError

Point = tuple[float, float]

DRAWABLE = 1e100
"""The largest number that is drawn: products of some must be doubles too."""
COLUMN = 85.0
"""Width in millimetres of a column in print."""
MM_PER_POINT = 25.4 / 72
FONTS = "'DejaVu Sans', Verdana, Arial, sans-serif"

# Okabe and Ito's colours, which stay apart for every common kind of colour blindness
BLACK, GREY, WHITE = "#000000", "#666666", "#ffffff"
BLUE, VERMILION, PURPLE, GREEN, ORANGE, SKY = (
    "#0072b2",
    "#d55e00",
    "#cc79a7",
    "#009e73",
    "#e69f00",
    "#56b4e9",
)

_WIDTHS = {
    character: width
    for width, characters in (
        (0.275, "'"),
        (0.278, "ijl"),
        (0.295, "IJ"),
        (0.318, " ,.·"),
        (0.337, "/:;\\|"),
        (0.352, "f"),
        (0.361, "-"),
        (0.39, "()[]"),
        (0.392, "t"),
        (0.401, "!²"),
        (0.411, "r"),
        (0.5, "*_°–"),
        (0.521, "s"),
        (0.525, "z"),
        (0.55, "c"),
        (0.557, "LΓ"),
        (0.579, "kF"),
        (0.592, "vxyκ"),
        (0.613, "PTYaoeθ"),
        (0.636, "Ehnubdgpqμ$0123456789{}S"),
        (0.66, "Kφ"),
        (0.686, "AVΔXZB"),
        (0.698, "RC"),
        (0.752, "UNH"),
        (0.787, "ΩDGOQ&"),
        (0.838, "wω#+<=>^~−×→±"),
        (0.863, "M"),
        (0.974, "m%"),
        (1.0, "W@…"),
    )
    for character in characters
}
BOLD = 1.15
"""A bold character is at most about so much wider."""
ASCENT, DESCENT = 0.78, 0.24
"""Of the size, above and below the baseline, of capitals and of letters with tails."""
SUBSCRIPT_SIZE, SUBSCRIPT_DROP = 0.7, 0.2


class Path(NamedTuple):
    """Straight pieces through ``points``; closed and filled when ``fill`` is given."""

    points: tuple[Point, ...]
    stroke: str | None = BLACK
    width: float = 0.25
    dash: tuple[float, ...] = ()
    fill: str | None = None
    role: str = ""


class Text(NamedTuple):
    """One line at its baseline. ``_x`` and ``_{xy}`` in ``text`` are subscripts; ``anchor`` is
    start, middle or end; ``size`` in points."""

    x: float
    y: float
    text: str
    size: float = 7.0
    anchor: str = "start"
    colour: str = BLACK
    bold: bool = False
    role: str = ""


class Run(NamedTuple):
    """A piece of a text in one size, placed."""

    x: float
    y: float
    text: str
    size: float


class Box(NamedTuple):
    """A rectangle along the axes."""

    left: float
    bottom: float
    right: float
    top: float

    def overlaps(self, other: Box, gap: float = 0.0) -> bool:
        """Whether the two share area, or come nearer than ``gap``."""
        return (
            self.left < other.right + gap
            and other.left < self.right + gap
            and self.bottom < other.top + gap
            and other.bottom < self.top + gap
        )

    def contains(self, other: Box) -> bool:
        """Whether ``other`` lies inside."""
        return (
            self.left <= other.left
            and self.bottom <= other.bottom
            and other.right <= self.right
            and other.top <= self.top
        )

    def crosses(self, start: Point, end: Point) -> bool:
        """Whether the straight line from ``start`` to ``end`` enters the rectangle."""
        low, high = 0.0, 1.0
        for origin, target, near, far in (
            (start[0], end[0], self.left, self.right),
            (start[1], end[1], self.bottom, self.top),
        ):
            run = target - origin
            if run == 0:
                if not near <= origin <= far:
                    return False
                continue
            first, second = sorted(((near - origin) / run, (far - origin) / run))
            low, high = max(low, first), min(high, second)
        return low <= high


def check_drawable(values: Iterable[float], name: str) -> None:
    """Raises UserError for a finite number too large to draw, of what ``name`` says."""
    for value in values:
        if DRAWABLE < abs(value) < math.inf:
            raise UserError(f"{value:g} is too large to be drawn", name)


@dataclass
class Drawing:
    """``width`` x ``height`` mm with what is drawn on it, lowest first, all of it written
    ``enlarged`` times as large. ``description`` tells in
    words what a reader who cannot see it misses."""

    width: float
    height: float
    title: str
    description: str = ""
    items: list[Path | Text] = field(default_factory=list)
    enlarged: float = 1.0

    def texts(self) -> list[Text]:
        """The texts only."""
        return [item for item in self.items if isinstance(item, Text)]

    def segments(self) -> Iterator[tuple[Point, Point]]:
        """Every straight piece drawn with a stroke."""
        for item in self.items:
            if isinstance(item, Path) and item.stroke:
                points = (*item.points, item.points[0]) if item.fill else item.points
                yield from pairwise(points)


def pieces(text: str) -> list[tuple[str, bool]]:
    """``text`` cut at its subscripts: (piece, whether it is one)."""
    result: list[tuple[str, bool]] = []
    rest = text
    while "_" in rest:
        before, _, rest = rest.partition("_")
        if before:
            result.append((before, False))
        if rest.startswith("{") and "}" in rest:
            below, _, rest = rest[1:].partition("}")
        else:
            below, rest = rest[:1], rest[1:]
        result.append((below, True))
    return [*result, (rest, False)] if rest else result


def text_width(text: str, size: float, bold: bool = False) -> float:
    """Width in millimetres of a line with subscripts, ``size`` points high."""
    ems = sum(
        (SUBSCRIPT_SIZE if below else 1.0)
        * sum(_WIDTHS.get(character, 0.75) for character in piece)
        for piece, below in pieces(text)
    )
    return ems * size * MM_PER_POINT * (BOLD if bold else 1.0)


def text_runs(text: Text) -> list[Run]:
    """The pieces of a text and where each starts."""
    x = text.x - _SHIFT[text.anchor] * text_width(text.text, text.size, text.bold)
    runs = []
    for piece, below in pieces(text.text):
        size = text.size * (SUBSCRIPT_SIZE if below else 1.0)
        drop = SUBSCRIPT_DROP * text.size * MM_PER_POINT if below else 0.0
        runs.append(Run(x, text.y - drop, piece, size))
        x += text_width(piece.replace("_", " "), size, text.bold)
    return runs


_SHIFT = {"start": 0.0, "middle": 0.5, "end": 1.0}


def text_box(text: Text) -> Box:
    """The rectangle a text takes up."""
    width, height = text_width(text.text, text.size, text.bold), text.size * MM_PER_POINT
    left = text.x - _SHIFT[text.anchor] * width
    below = DESCENT + (SUBSCRIPT_DROP if "_" in text.text else 0.0) / 2
    return Box(left, text.y - below * height, left + width, text.y + ASCENT * height)


def arrow(
    start: Point,
    end: Point,
    colour: str = BLACK,
    width: float = 0.35,
    dash: tuple[float, ...] = (),
    head: float = 2.0,
    role: str = "",
) -> list[Path]:
    """A shaft and a filled head of length ``head``, shorter where the arrow itself is short."""
    length = math.dist(start, end)
    if length == 0:
        return []
    head = min(head, 0.6 * length)
    along = ((end[0] - start[0]) / length, (end[1] - start[1]) / length)
    neck = (end[0] - 0.85 * head * along[0], end[1] - 0.85 * head * along[1])
    return [
        Path((start, neck), colour, width, dash, role=role),
        Path(_head(end, along, head), None, fill=colour, role=role and f"{role} head"),
    ]


def _head(tip: Point, along: Point, head: float) -> tuple[Point, ...]:
    back = (tip[0] - head * along[0], tip[1] - head * along[1])
    half = 0.36 * head
    return (
        tip,
        (back[0] - half * along[1], back[1] + half * along[0]),
        (back[0] + half * along[1], back[1] - half * along[0]),
    )


def turning_arrow(
    center: Point,
    radius: float,
    counterclockwise: bool,
    colour: str = BLACK,
    width: float = 0.35,
    dash: tuple[float, ...] = (),
    opening: float = 90.0,
    span: float = 250.0,
    role: str = "",
) -> list[Path]:
    """An arc around ``center`` with a head showing the sense; ``opening`` is the direction in
    degrees the gap between its ends looks to."""
    sense = 1 if counterclockwise else -1
    first = math.radians(opening + sense * (360 - span) / 2)
    turn = math.radians(sense * span)
    head = min(1.7, radius)
    steps = 24
    arc = tuple(
        (center[0] + radius * math.cos(angle), center[1] + radius * math.sin(angle))
        for angle in (first + turn * step / steps for step in range(steps + 1))
    )
    last = first + turn
    # the head's tip goes on a little along the tangent, its back sits on the arc
    along = (-sense * math.sin(last), sense * math.cos(last))
    tip = (arc[-1][0] + 0.6 * head * along[0], arc[-1][1] + 0.6 * head * along[1])
    return [
        Path(arc, colour, width, dash, role=role),
        Path(_head(tip, along, head), None, fill=colour, role=role and f"{role} head"),
    ]


def dashes(points: Sequence[Point], pattern: Sequence[float]) -> list[tuple[Point, ...]]:
    """The drawn pieces of a line dashed by ``pattern`` (drawn, left out, drawn ... in mm)."""
    pieces: list[tuple[Point, ...]] = []
    piece: list[Point] = [points[0]]
    count, left = 0, pattern[0]
    for start, end in pairwise(points):
        length, done = math.dist(start, end), 0.0
        while length - done > left:
            done += left
            share = done / length
            place = (start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1]))
            if count % 2 == 0:
                pieces.append((*piece, place))
            count += 1
            piece, left = [place], pattern[count % len(pattern)]
        left -= length - done
        piece.append(end)
    if count % 2 == 0 and len(piece) > 1:
        pieces.append(tuple(piece))
    return pieces


def circle(center: Point, radius: float) -> tuple[Point, ...]:
    """A circle as a polygon of 32 corners."""
    return tuple(
        (
            center[0] + radius * math.cos(math.tau * step / 32),
            center[1] + radius * math.sin(math.tau * step / 32),
        )
        for step in range(32)
    )


def extent(points: Sequence[Point]) -> Box:
    """The rectangle around points."""
    xs, ys = [point[0] for point in points], [point[1] for point in points]
    return Box(min(xs), min(ys), max(xs), max(ys))
