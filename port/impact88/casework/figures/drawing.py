"""Drawings as lists of paths and texts on paper, which `canvas` only copies; labels are put beside
what they name, off every line and every other text.

Points are complex numbers, x + iy in millimetres, y upwards; a page reaches from 0 at its top left
corner down to -height. Texts are measured with the widths of DejaVu Sans, matplotlib's font and as
wide as any likely to stand in for it, so texts that do not overlap here overlap nowhere.
"""

import cmath
import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache, partial
from itertools import groupby, pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import UserError, printable

Floats = NDArray[np.float64]
Points = NDArray[np.complex128]
Places = NDArray[np.intp]

DRAWABLE = 1e100
"""The largest number that is drawn: products of some must be doubles too."""
COLUMN = 85.0
"""Width in millimetres of a column in print."""
MM_PER_POINT = 25.4 / 72
TEXT = 6.5  # size of most texts, in points
ROW = 3.4  # distance of their lines, in mm

# Okabe and Ito's colours, which stay apart for every common kind of colour blindness
BLACK = "#000000"
GREY = "#666666"
WHITE = "#ffffff"
BLUE = "#0072b2"
VERMILION = "#d55e00"
ORANGE = "#e69f00"

_ASCII = """318 401 460 838 637 951 780 275 391 391 500 838 318 361 318 337 637 637 637 637 637 637
637 637 637 637 337 337 838 838 838 531 1000 685 687 699 771 632 576 775 752 295 295 656 558 863
749 788 604 788 695 635 611 732 685 989 686 611 686 391 337 391 838 500 500 613 635 550 635 616 353
635 634 278 278 580 278 975 634 612 635 635 412 521 393 634 592 818 592 592 525 637 337 637 838"""
_OTHERS = {"·": 318, "²": 401, "°": 500, "–": 500, "Γ": 558, "κ": 590, "θ": 612, "μ": 637, "φ": 660}
_WIDTHS = dict(zip(map(chr, range(32, 127)), map(int, _ASCII.split()), strict=True))
_WIDTHS |= {"Δ": 685, "Ω": 765, "…": 1000, **_OTHERS, **dict.fromkeys("ω×→±−", 838)}
"""Advances in thousandths of the size."""
BOLD = 1.15
"""Largest width of a bold character, relative to the regular one."""
# as fractions of the size of type, as usual in print
ASCENT = 0.78
DESCENT = 0.24
SUBSCRIPT_SIZE = 0.7
SUBSCRIPT_DROP = 0.2

# Placing of labels: of 323 labels in 24 drawings 1 covers a line; none with twice the directions,
# 2 with half, 4 with twice the step
DIRECTIONS = 24  # directions tried
GAP = 0.9  # least distance of two texts, in mm
STEP = 0.4  # distance of the points at which a line is sampled, in mm
LEADER_FROM = 3.6  # distance from which on a thin line leads to the point, in mm
REACHES = (0.9, 2.0, 3.4, 5.0, 7.0, 10.0, 14.0, 20.0)
"""Distances in mm tried between the point named and the nearest edge of the text; doubled, 4."""
WEIGHTS = {
    "glass": 0.4,
    "heading": 1.5,
    "body": 0.0,
    "after": 2.5,
    "impulse": 2.5,
    "head": 2.5,
    "spin": 2.0,
    "moment": 2.5,
    "before": 2.0,
    "angle": 1.5,
    "change": 1.5,
}
"""Cost of covering a line whose role ends so, 1 for any other: doubled, 2 labels move; without
them, 4 labels cover lines."""


class Path(NamedTuple):
    """Straight pieces through ``points``; closed and filled when ``fill`` is given."""

    points: tuple[complex, ...]
    stroke: str | None = BLACK
    width: float = 0.25
    dash: tuple[float, ...] = ()
    fill: str | None = None
    role: str = ""


class Text(NamedTuple):
    """One line at its baseline. ``_xy`` and ``_{x, y}`` in ``text`` are subscripts; ``anchor`` is
    start, middle or end; ``size`` in points."""

    at: complex
    text: str
    size: float = TEXT
    anchor: str = "start"
    colour: str = BLACK
    bold: bool = False
    role: str = ""


class Label(NamedTuple):
    """A text for the point ``at``, best placed in direction ``towards`` (of any length)."""

    at: complex
    towards: complex
    text: str
    size: float = 8.0
    colour: str = BLACK
    bold: bool = False
    role: str = ""


class Box(NamedTuple):
    """A rectangle along the axes."""

    left: float
    bottom: float
    right: float
    top: float

    @property
    def width(self) -> float:
        return self.right - self.left

    @property
    def height(self) -> float:
        return self.top - self.bottom

    @property
    def corners(self) -> tuple[complex, ...]:
        """The corners, counterclockwise from the lower left one."""
        left, bottom, right, top = self
        points = (left, bottom), (right, bottom), (right, top), (left, top)
        return tuple(complex(*point) for point in points)

    def overlaps(self, other: "Box") -> bool:
        is_beside = self.left >= other.right or other.left >= self.right
        return not is_beside and self.bottom < other.top and other.bottom < self.top


class View(NamedTuple):
    """Map from points of a plan to paper."""

    origin: complex
    scale: float

    def __call__(self, point: complex) -> complex:
        return self.origin + self.scale * point

    def all(self, points: Iterable[complex]) -> tuple[complex, ...]:
        return tuple(self(point) for point in points)


def check_drawable(values: Iterable[float], name: str) -> None:
    """Raises UserError for a finite number too large to draw, of what ``name`` says."""
    for value in values:
        if DRAWABLE < abs(value) < math.inf:
            raise UserError(f"{value:g} is too large to be drawn", name)


@dataclass
class Drawing:
    """A page ``width`` x ``height`` mm with what is drawn on it, lowest first, written ``enlarged``
    times as large; ``labels`` are still to be placed. ``description``: the drawing in words."""

    width: float
    title: str
    description: str = ""
    height: float = 0.0
    items: list[Path | Text] = field(default_factory=list)
    labels: list[Label] = field(default_factory=list)
    enlarged: float = 1.0

    def __post_init__(self) -> None:
        """Show what does not print in a user's title as an escape: no SVG may hold a control
        character, and a mark may turn the writing direction of all that follows."""
        self.title = printable(self.title)
        self.description = printable(self.description)

    def add(self, *items: Path | Text | Label) -> None:
        """Draw something over all that is there, or note a label."""
        self.items += [item for item in items if not isinstance(item, Label)]
        self.labels += [item for item in items if isinstance(item, Label)]

    def texts(self) -> list[Text]:
        return [item for item in self.items if isinstance(item, Text)]

    def paths(self) -> list[Path]:
        return [item for item in self.items if isinstance(item, Path)]

    def heading(self) -> float:
        """Write the title in bold at the top; returns where what follows goes on."""
        # a user's words: no symbols with subscripts
        lines = wrap_text(self.title.replace("_", r"\_"), (self.width - 4) / BOLD, 7)
        for count, line in enumerate(lines, 1):
            self.add(Text(complex(2, -ROW * count), line, 7, bold=True, role="title"))
        return -ROW * len(lines)


def pieces(text: str) -> list[tuple[str, bool]]:
    r"""``text`` cut at its subscripts: (piece, whether it is one); ``\_`` is an underscore."""
    matches = re.finditer(r"_\{([^}]*)\}|_([^\W_]+)|_|\\_|[^_\\]+|\\", text)
    cut = [
        (m[1] or m[2] or "", True) if m[0][0] == "_" else (m[0].replace(r"\_", "_"), False)
        for m in matches
    ]
    spans: list[tuple[str, bool]] = []
    for below, alike in groupby(cut, lambda piece: piece[1]):
        texts = [piece for piece, _ in alike]
        spans += [(piece, True) for piece in texts] if below else [("".join(texts), False)]
    return spans


def text_width(text: str, size: float, bold: bool = False) -> float:
    """Width in millimetres of a line with subscripts, ``size`` points high."""
    thousandths = sum(
        (SUBSCRIPT_SIZE if below else 1.0) * sum(_WIDTHS.get(letter, 1000) for letter in piece)
        for piece, below in pieces(text)
    )
    return thousandths / 1000 * size * MM_PER_POINT * (BOLD if bold else 1.0)


def wrap_text(text: str, room: float, size: float = TEXT) -> list[str]:
    """The words of a text in lines at most ``room`` mm wide, where a word is not wider itself."""
    lines = [""]
    for word in text.split(" "):
        longer = f"{lines[-1]} {word}".strip()
        if text_width(longer, size) > room and lines[-1]:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines


def _start(text: Text) -> complex:
    share = {"start": 0.0, "middle": 0.5, "end": 1.0}[text.anchor]
    return text.at - share * text_width(text.text, text.size, text.bold)


def text_runs(text: Text) -> list[tuple[complex, str, float]]:
    """The pieces of a text: where each starts, its text, its size."""
    at, runs = _start(text), []
    for piece, below in pieces(text.text):
        size = text.size * (SUBSCRIPT_SIZE if below else 1.0)
        drop = SUBSCRIPT_DROP * text.size * MM_PER_POINT if below else 0.0
        runs.append((at - 1j * drop, piece, size))
        at += text_width(piece.replace("_", r"\_"), size, text.bold)
    return runs


def text_box(text: Text) -> Box:
    start, height = _start(text), text.size * MM_PER_POINT
    drop = SUBSCRIPT_DROP if any(low for _, low in pieces(text.text)) else 0.0
    below = DESCENT + drop / 2
    width = text_width(text.text, text.size, text.bold)
    bottom, top = start.imag - below * height, start.imag + ASCENT * height
    return Box(start.real, bottom, start.real + width, top)


def unit(degrees: float) -> complex:
    """The direction so many degrees from the x axis."""
    return cmath.rect(1.0, math.radians(degrees))


def degrees(direction: complex) -> float:
    return math.degrees(cmath.phase(direction))


def arrow(tail: complex, tip: complex, *look: Any, head: float = 2.0, role: str = "") -> list[Path]:
    """A shaft and a filled head of length ``head``, shorter where the arrow itself is short.
    ``look``: colour, width and dashes of the shaft."""
    length = abs(tip - tail)
    if length == 0:
        return []
    along = min(head, 0.6 * length) * (tip - tail) / length
    return _add_head((tail, tip - 0.85 * along), tip, along, look or (BLACK, 0.35), role)


def _add_head(
    shaft: tuple[complex, ...], tip: complex, along: complex, look: tuple[Any, ...], role: str
) -> list[Path]:
    head = (tip, tip - along * (1 - 0.36j), tip - along * (1 + 0.36j))
    arrowhead = Path(head, None, fill=look[0], role=role and f"{role} head")
    return [Path(shaft, *look)._replace(role=role), arrowhead]


def turning_arrow(
    center: complex, radius: float, sense: int, gap: float, *look: Any, span: float, role: str
) -> list[Path]:
    """An arc of ``span`` degrees around ``center`` with a head, counterclockwise for a ``sense`` of
    1, else -1; ``gap`` is the direction in degrees the gap between its ends looks to."""
    points = arc(center, gap + sense * (360 - span) / 2, sense * span, radius)
    # the head's tip goes on a little along the tangent, its back sits on the arc
    along = min(1.7, radius) * sense * 1j * (points[-1] - center) / radius
    return _add_head(points, points[-1] + 0.6 * along, along, look, role)


def arc(center: complex, first: float, turn: float, radius: float) -> tuple[complex, ...]:
    """An arc of ``turn`` degrees from the direction ``first``, a point every ten degrees or so."""
    steps = max(6, round(abs(turn) / 10))
    return tuple(center + radius * unit(first + turn * i / steps) for i in range(steps + 1))


def circle(center: complex, radius: float) -> tuple[complex, ...]:
    return arc(center, 0, 360, radius)[1:]


def dashes(points: Sequence[complex], pattern: Sequence[float]) -> list[tuple[complex, ...]]:
    """The drawn pieces of a line dashed by ``pattern`` (drawn, left out, drawn ... in mm)."""
    dashes, piece, count, left = [], [points[0]], 0, pattern[0]
    for start, end in pairwise(points):
        length, place_along = abs(end - start), 0.0
        while length - place_along > left:
            place_along += left
            place = start + place_along / length * (end - start)
            if count % 2 == 0:
                dashes.append((*piece, place))
            count += 1
            piece, left = [place], pattern[count % len(pattern)]
        left -= length - place_along
        piece.append(end)
    if count % 2 == 0:
        dashes.append(tuple(piece))
    return dashes


def extent(points: Iterable[complex]) -> Box:
    xs, ys = zip(*((point.real, point.imag) for point in points), strict=True)
    return Box(min(xs), min(ys), max(xs), max(ys))


def short(value: float, digits: int = 4) -> str:
    """A number to ``digits`` digits, without an exponent up to a million (with at most three where
    larger or very small), with a true minus sign."""
    text = f"{value:.{digits}g}"
    if "e" in text:
        plain = 1 < abs(float(text)) < 1e6
        text = f"{float(text):.0f}" if plain else f"{value:.{min(digits, 3)}g}"
    return text.replace("-", "−")


def fitting(value: float, width: float) -> str:
    """A number as `short` has it, with fewer digits where that is wider than ``width`` mm."""
    texts = [short(value, digits) for digits in (4, 3, 2, 1)]
    return next((text for text in texts if text_width(text, TEXT) <= width), texts[-1])


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
    x, y = points.real.copy(), points.imag.copy()  # side by side in memory
    boxes = [text_box(text) for text in drawing.texts()]
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
        own_cost = 0.6 * reach + 1.5 * (1 - (wish.conjugate() * along).real) + (reach > LEADER_FROM)
        left, bottom, right, top = np.array(boxes).reshape(-1, 4).T
        is_near = (low.real < right + GAP) & (high.real > left - GAP)
        is_near &= (low.imag < top + GAP) & (high.imag > bottom - GAP)
        inside = (low.real >= frame.left) & (high.real <= frame.right)
        inside &= (low.imag >= frame.bottom) & (high.imag <= frame.top)
        penalty = 1e4 * is_near.sum(1) + 1e3 * ~inside[:, 0]
        covering = partial(_covering, low, high, x, y, weights)
        best = _cheapest_place(own_cost, penalty, covering)
        text = text._replace(at=complex(low[best, 0]) - complex(box.left, box.bottom))
        box = text_box(text)
        if reach[best] > LEADER_FROM:
            end = complex(
                min(max(label.at.real, box.left), box.right),
                min(max(label.at.imag, box.bottom), box.top),
            )
            start = label.at + min(0.8 / abs(end - label.at), 1.0) * (end - label.at)
            drawing.add(Path((start, end), label.colour, 0.12, role="leader"))
        drawing.add(text)
        boxes.append(box)
    drawing.labels.clear()


def _cheapest_place(own: Floats, misplaced: Floats, covering: Callable[[Places], Floats]) -> int:
    """Return the first of the cheapest places.

    Its cost is its own, that of being misplaced, and that of the lines it covers. Lines only add to
    a cost: a place that costs more without them than another one with them is not compared with
    them.
    """
    uncovered = own + misplaced

    def cost(places: Places) -> Floats:
        return np.asarray(own[places] + (misplaced[places] + 1.5 * covering(places)))

    limit = cost(np.array([uncovered.argmin()]))
    places = np.flatnonzero(~(uncovered > limit))
    return int(places[cost(places).argmin()])


def _covering(
    low: Points, high: Points, x: Floats, y: Floats, weights: Floats, places: Places
) -> Floats:
    """Return what the lines cost that boxes at some places cover: the sum of their points' weights.

    ``low``, ``high``: lower left and upper right corners of all boxes, in a column."""
    low, high = low[places], high[places]
    within = (low.real.min() < x) & (x < high.real.max())
    within &= (low.imag.min() < y) & (y < high.imag.max())
    across, up = x[within], y[within]
    is_covered = (low.real.copy() < across) & (across < high.real.copy())
    is_covered &= (low.imag.copy() < up) & (up < high.imag.copy())
    # einsum: a product by BLAS would wake its threads, which then spin
    return np.asarray(np.einsum("ij,j->i", is_covered, weights[within]))


@lru_cache(maxsize=256)
def _fractions(count: int) -> Floats:
    """Return that many numbers from 0 to 1, evenly spaced."""
    return np.linspace(0, 1, count)


def _samples(path: Path) -> tuple[Points, Floats]:
    """Points along a path, and what covering each costs."""
    weight = WEIGHTS.get(path.role.rpartition(" ")[2], 1.0)
    ends = (*path.points, path.points[0]) if path.fill else path.points
    runs = [
        start + (end - start) * _fractions(int(abs(end - start) / STEP) + 2)
        for start, end in pairwise(ends)
        if weight
    ]
    points = np.concatenate(runs) if runs else np.empty(0, complex)
    return points, np.full(len(points), weight)
