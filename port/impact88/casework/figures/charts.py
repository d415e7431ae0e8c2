"""Charts of the chapter, Figures 1 and 5; and panels, two axes with round numbers, and key."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from . import drawing as d
from .drawing import BLACK, GREY, ROW, TEXT, Box, Drawing, Path, Text

# in mm
_LEFT = 13.0  # for the numbers left of a panel
_TOP = 6.0  # for the name above a panel
_BELOW = 3.3  # from the axis down to the baseline of its numbers
_DASHED = (1.3, 0.8)
_PALE = "#c6dff0"

MARKS = {"o": (24, 0), "s": (4, 45), "D": (4, 0), "^": (3, 90), "v": (3, -90), ">": (3, 0)}
MARKS |= {"P": (5, 90), "_": (2, 0)}
"""Corners of each mark, and where the first of them stands in degrees."""


class Axis(NamedTuple):
    """Numbers from ``low`` to ``high`` on paper from ``start`` to ``end``."""

    low: float
    high: float
    start: float
    end: float
    log: bool = False

    def __call__(self, value: Any) -> Any:
        low, high = self.low, self.high
        if self.log:
            low, high, value = math.log10(low), math.log10(high), np.log10(value)
        return self.start + (value - low) / (high - low) * (self.end - self.start)


def powers(low: float, high: float, step: int) -> list[tuple[float, str]]:
    """Powers of ten, every ``step``-th with a text."""
    first, last = round(math.log10(low)), round(math.log10(high))
    return [
        (10.0**n, "1" if n == 0 else f"1e{n}".replace("-", "−") if n % step == 0 else "")
        for n in range(first, last + 1)
    ]


class Panel:
    """Two axes around ``box``; the numbers stand below and left of it, the upper axis's name above
    it, the lower one's below. ``x`` and ``y`` are (lowest, highest), on a grid if ``log``."""

    def __init__(
        self,
        drawing: Drawing,
        box: Box,
        x: tuple[float, float],
        y: tuple[float, float],
        x_label: str,
        y_label: str,
        *,
        x_ticks: Sequence[tuple[float, str]],
        y_ticks: Sequence[tuple[float, str]],
        log: bool = False,
    ) -> None:
        # nine arguments: a box, and three for each axis
        self.drawing, self.box = drawing, box
        self.x = Axis(*x, box.left, box.right, log)
        self.y = Axis(*y, box.bottom, box.top, log)
        corner, right, _, top = box.corners
        for end in (right, top):
            drawing.add(Path((corner, end), BLACK, 0.2, role="axis"))
        up, left = 1j * box.height, -2.0 - 0.8j
        for axis, ticks, inward, outward, shift, look in (
            (self.x, x_ticks, up, -0.9j, -1j * _BELOW, ("middle", "x tick")),
            (self.y, y_ticks, box.width, -0.9, left, ("end", "y tick")),
        ):
            for value, text in ticks:
                place = axis(value)
                at = complex(place, box.bottom) if axis is self.x else complex(box.left, place)
                if log:
                    drawing.add(Path((at, at + inward), "#dddddd", 0.14, role="grid"))
                drawing.add(Path((at, at + outward), BLACK, 0.2, role="tick"))
                if text:
                    drawing.add(Text(at + shift, text, anchor=look[0], role=look[1]))
        at = complex((box.left + box.right) / 2, box.bottom - _BELOW - ROW + 0.2)
        drawing.add(Text(at, x_label, anchor="middle", role="x label"))
        if y_label:
            drawing.add(Text(complex(box.left - 1, box.top + 1.8), y_label, role="y label"))

    def at(self, x: float, y: float) -> complex:
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
        self.line([x, x], [self.y.low, self.y.high], colour, 0.35, **look)

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
    follows goes on. An entry is (text, colour, look): a mark (``o``, or ``o `` for an open one) or
    dashes of a line."""
    x, sample = 2.0, 6.0
    for text, colour, look in entries:
        width = sample + 1.2 + d.text_width(text, TEXT)
        if x > 2.0 and x + width > drawing.width - 2:
            x, y = 2.0, y - ROW
        start = complex(x, y + 0.8)
        if isinstance(look, str):
            drawing.add(mark(start + sample / 2, look[0], colour, look[-1] != " ", "key"))
        else:
            drawing.add(Path((start, start + sample), colour, 0.4, look, role="key"))
        drawing.add(Text(complex(x + sample + 1.2, y), text, role="legend"))
        x += width + 3.0
    if note:
        y -= ROW
        drawing.add(Text(complex(2, y), note, colour=GREY, role="note"))
    return y - ROW


def figure_5() -> Drawing:
    """Figure 5 from our own computation: the impact equations with Table 2's coefficients, and
    Equation 19 with its energy loss, against the measured ΔV (Table 2's where Table 1's is lost).
    """
    from ..chapter.staged import collisions, experimental, forward, predict_delta_v

    series: Mapping[str, list[tuple[float, float, str]]]
    series = {"impact equations": [], "Equation 19": []}
    for collision in collisions():
        measurements = experimental(collision)
        for name, column in (("DVA", "dVa_exp"), ("DVB", "dVb_exp")):
            x = (
                measurements[name]
                if math.isfinite(measurements[name])
                else collision.table2[column]
            )
            for points, rule in zip(series.values(), (forward, predict_delta_v), strict=True):
                points.append((x, float(rule(collision)[name]), name[-1]))
    drawing = Drawing(
        d.COLUMN,
        "Staged collisions: calculated against experimental ΔV",
        "Each vehicle's ΔV by the impact equations and by Equation 19 against the measured one; "
        "the line is where they are equal.",
    )
    top = drawing.heading() - _TOP
    limit = 1.06 * max(max(x, y) for points in series.values() for x, y, _ in points)
    box = Box(_LEFT, top - 65, _LEFT + 65, top)
    names = ("experimental ΔV, ft/s", "calculated ΔV, ft/s")
    marks = [(value, str(value)) for value in range(0, int(limit) + 1, 20)]
    ends = 0.0, limit
    panel = Panel(drawing, box, ends, ends, *names, x_ticks=marks, y_ticks=marks)
    panel.line([0, limit], [0, limit], GREY, 0.3)
    looks = {"impact equations": ("o", d.BLUE), "Equation 19": ("^", d.VERMILION)}
    for name, points in series.items():
        for x, y, vehicle in points:
            panel.mark(x, y, *looks[name], vehicle == "A", name)
    entries = [(name, colour, mark) for name, (mark, colour) in looks.items()]
    entries.append(("equal", GREY, ()))  # type: ignore[arg-type]
    note = "filled: vehicle A; open: vehicle B"
    drawing.height = 2 - key(drawing, box.bottom - 11.5, *entries, note=note)
    return drawing


def force_and_impulse() -> Drawing:
    """Figure 1: a typical force between vehicles, and the average force of the same impulse."""
    drawing = Drawing(
        d.COLUMN,
        "Force between vehicles and its impulse",
        "A typical force rises to its peak F_M and falls to 0 at t_f; the average force F_A over "
        "the same time has the same impulse.",
    )
    time = np.linspace(0, 1, 201)
    # a skewed hump, its peak two to three times the mean as Section III says of F_M
    force = time**2.6 * (1 - time) ** 4.2 * (1 + 0.1 * np.sin(9 * np.pi * time))
    force /= force.max()
    mean = float(((force[1:] + force[:-1]) / 2 * np.diff(time)).sum())
    top = drawing.heading() - 2 * ROW
    for left, level, name, title, xs, ys in (
        (9.0, 1.0, "F_M", "a. typical force", time, force),
        (50.0, mean, "F_A", "b. average force", [0, 0, 1, 1], [0, mean, mean, 0]),
    ):
        panel = Panel(
            drawing,
            Box(left, top - 28, left + 33, top),
            (0, 1.15),
            (0, 1.18),
            "time",
            title,
            x_ticks=[(0, "0"), (1, "t_f")],
            y_ticks=[(level, name)],
        )
        panel.line(xs, ys, d.BLUE, fill=_PALE, role="force")
        panel.line([0, 1], [level] * 2, GREY, 0.2, dash=_DASHED)
        at = panel.at(0.4, 0.35 * mean)
        drawing.add(Text(at, "impulse", anchor="middle"))
    drawing.height = 38 - top
    return drawing
