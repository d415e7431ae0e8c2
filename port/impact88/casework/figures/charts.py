"""Charts: draws and drivers of bounds, the friction sweep, staged collisions; and their panels, two
axes with round numbers, and key. Nothing is hatched, which some renderers of SVG paint black."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...collision.units import RULES, System, system_of
from ...errors import UserError
from ...names import PIVOT, quantity
from ...program.scene import numbers_of
from ...status import Status
from ...tables.sweep import swept_columns
from . import drawing as d
from .drawing import BLACK, GREY, ROW, TEXT, Box, Drawing, Path, Text, short

if TYPE_CHECKING:
    from ..uncertainty.boundstable import Bounds

MOST_PANELS = 12  # panels that fit a page
MOST_BARS = 8  # bars that fit a panel
BINS = 60  # bars of a histogram, two a millimetre
WARNED = "STATUS has a warning"
"""The key's text for stretches that are shaded."""
SWEEP = 801  # points of a sweep, ten a millimetre
WIDEST_SWEEP = 5.0  # largest friction coefficient swept
# in mm
_LEFT = 13.0  # for the numbers left of a panel
_TOP = 6.0  # for the name above a panel
_BELOW = 3.3  # from the axis down to the baseline of its numbers
_DASHED = (1.3, 0.8)
_DOTTED = (0.4, 0.6)
_CLEAR = 2.0  # least distance of an axis's name from the page's edge
_APART = 1.2  # least distance of the numbers of an axis
_EDGE = 0.6  # least distance of a number from the page's edge
_FLAT = 1e-9  # values that differ by less, as a fraction of the largest, are drawn as one
_SQUEEZED = 3.0
"""An axis shows only the physical part of a result whose whole range is this many times that."""
_UNPHYSICAL = "#f7dfae"
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


def span(values: Any, margin: float = 0.05) -> tuple[float, float]:
    """Return the range of the finite values, extended at both ends by a fraction of it."""
    values = np.asarray(values, float).ravel()
    values = values[np.isfinite(values)]
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
    flat = high - low <= _FLAT * max(abs(low), abs(high))
    extension = (0.05 * abs(low) or 1.0) if flat else margin * (high - low)
    return low - extension, high + extension


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
    entries = zip(numbers, texts, strict=True)
    return [(n * size, t.replace("-", "−") if n else "0") for n, t in entries]


def powers(low: float, high: float, step: int) -> list[tuple[float, str]]:
    """Powers of ten, every ``step``-th with a text."""
    first, last = round(math.log10(low)), round(math.log10(high))
    return [
        (10.0**n, "1" if n == 0 else f"1e{n}".replace("-", "−") if n % step == 0 else "")
        for n in range(first, last + 1)
    ]


def fitting_ticks(axis: Axis, most: int, page: float) -> list[tuple[float, str]]:
    """Round numbers along a horizontal axis, at most ``most``, with texts that stand apart and off
    the edges of the ``page``, in mm; where there is no room for a text it has a mark only."""
    marks: list[tuple[float, str]] = []
    for count in range(most, 0, -1):
        marks = ticks(axis.low, axis.high, count)
        places = [(axis(value), d.text_width(text, TEXT) / 2) for value, text in marks]
        inside = [
            i for i, (x, half) in enumerate(places) if min(x - half, page - x - half) >= _EDGE
        ]
        for step in range(1, max(2, len(inside))):
            indices = inside[::step]
            gaps = (
                places[b][0] - places[a][0] - places[a][1] - places[b][1]
                for a, b in pairwise(indices)
            )
            if all(gap >= _APART for gap in gaps) and (len(indices) > 1 or count == 1):
                return [(v, text if i in indices else "") for i, (v, text) in enumerate(marks)]
    return marks


def label_lines(drawing: Drawing, box: Box, label: str) -> list[str]:
    """Return the lines of the name below an axis: in its middle, and clear of the page's edges."""
    middle = (box.left + box.right) / 2
    space = min(middle, drawing.width - middle) - _CLEAR
    return d.wrap_text(label, min(box.width + 8, 2 * space))


class Panel:
    """Two axes around ``box``; the numbers stand below and left of it, the upper axis's name above
    it, the lower one's below. ``x`` and ``y`` are (lowest, highest), on a grid if ``log``."""

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
    ) -> None:
        self.drawing, self.box = drawing, box
        self.x = Axis(*x, box.left, box.right, log)
        self.y = Axis(*y, box.bottom, box.top, log)
        self._ground = len(drawing.items)
        corner, right, _, top = box.corners
        for end in (right, top):
            drawing.add(Path((corner, end), BLACK, 0.2, role="axis"))
        up, left = 1j * box.height, -2.0 - 0.8j
        for axis, given, inward, outward, shift, look in (
            (self.x, x_ticks, up, -0.9j, -1j * _BELOW, ("middle", "x tick")),
            (self.y, y_ticks, box.width, -0.9, left, ("end", "y tick")),
        ):
            if isinstance(given, int) and axis is self.x:
                given = fitting_ticks(axis, given, drawing.width)
            marks = ticks(axis.low, axis.high, given) if isinstance(given, int) else given
            for value, text in marks:
                place = axis(value)
                at = complex(place, box.bottom) if axis is self.x else complex(box.left, place)
                if log:
                    drawing.add(Path((at, at + inward), "#dddddd", 0.14, role="grid"))
                drawing.add(Path((at, at + outward), BLACK, 0.2, role="tick"))
                if text:
                    drawing.add(Text(at + shift, text, anchor=look[0], role=look[1]))
        at = complex((box.left + box.right) / 2, box.bottom - _BELOW - ROW + 0.2)
        for line in label_lines(drawing, box, x_label) if x_label else []:
            drawing.add(Text(at, line, anchor="middle", role="x label"))
            at -= 1j * ROW
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


def _label(name: str, units: System) -> str:
    """The name of an axis: the quantity's meaning, without what its table says besides, and the
    unit where it has one."""
    row = quantity(name)
    meaning: str = row.meaning.partition(";")[0]
    if row.unit == "1":
        return meaning
    unit = {"percent": "%"}.get(row.unit, units.label(row.unit))
    return f"{meaning}, {unit}"


def _system(scene: Any) -> System:
    """Return what a scene's values are shown in."""
    case = getattr(scene, "case", None)
    return case.system if case else RULES


def _check_count(outputs: Sequence[str]) -> None:
    if len(outputs) > MOST_PANELS:
        raise UserError(f"{len(outputs)} results do not fit a page; expected {MOST_PANELS} at most")


def _start_drawing(
    result: Bounds, outputs: Sequence[str] | None, title: str
) -> tuple[list[str], Drawing]:
    """Return the names of the results drawn, and a drawing that says their nominal values and
    bounds."""
    names, units = list(outputs or result.bounds), system_of(result.units)
    for name in names:
        if name not in result.bounds:
            names_known = " ".join(result.bounds)
            raise UserError(f"{name!r} is not among the results; expected {names_known}")
    _check_count(names)
    bounds = [(_label(name, units), result.bounds[name]) for name in names]
    sentences = (
        f"{label}: {short(bound.nominal)}, bounds {short(bound.lower)} to {short(bound.upper)}."
        for label, bound in bounds
    )
    return names, Drawing(d.COLUMN, title, " ".join(sentences))


def histograms(result: Bounds, outputs: Sequence[str] | None = None) -> Drawing:
    """The draws of up to twelve results, with quantiles, nominal value and bounds. ``result`` must
    have been made with ``keep_draws=True``. Raises UserError for a result it lacks, or too many."""
    names, drawing = _start_drawing(result, outputs, "Results of the draws")
    units = system_of(result.units)
    columns = 1 if len(names) == 1 else 2
    wide = (d.COLUMN - 2) / columns
    top = drawing.heading()
    labels = [d.wrap_text(_label(name, units), wide - _LEFT + 4) for name in names]
    tallest = max(map(len, labels))
    for place, name in enumerate(names):
        row, column = divmod(place, columns)
        draws = result.draws[name]
        draws = draws[np.isfinite(draws)]
        d.check_drawable((draws.min(), draws.max()), name)
        bound, quantiles = result.bounds[name], result.spreads[name].quantiles
        heights, edges = np.histogram(draws, BINS)
        heights = heights * (100 / len(draws))
        upper = top - (30 + ROW * tallest) * row - _TOP
        left = _LEFT + column * wide - 3 * column
        box = Box(left, upper - 18, left + wide - _LEFT + (1 if column else -1), upper)
        panel = Panel(
            drawing,
            box,
            span([*edges, bound.lower, bound.upper]),
            (0.0, 1.08 * heights.max()),
            _label(name, units),
            "% of draws" if column == 0 else "",
            x_ticks=4 if columns == 2 else 8,
        )
        steps = np.repeat(edges, 2), np.concatenate([[0], np.repeat(heights, 2), [0]])
        panel.line(*steps, d.BLUE, 0.2, fill=_PALE, role="draws")
        panel.rule(bound.nominal, role="nominal")
        for share in (0.05, 0.95):
            panel.rule(quantiles[share], d.VERMILION, dash=_DASHED, role="quantile")
        for end in (bound.lower, bound.upper):
            panel.mark(end, 0.03 * panel.y.high, "D", role="bound")
    rows = -(-len(names) // columns)
    looks = (("5 % and 95 %", d.VERMILION, _DASHED), ("bounds", BLACK, "D"))
    low = top - (30 + ROW * tallest) * rows - 1
    drawing.height = 2 - key(drawing, low, ("nominal", BLACK, ()), *looks)
    return drawing


def tornado(result: Bounds, outputs: Sequence[str] | None = None) -> Drawing:
    """Draw the range of each result over each input alone, longest first; one panel per result.

    Bars end at
    the results of the input's limits, whiskers where the result goes in between. Raises UserError
    for a result it lacks."""
    names, drawing = _start_drawing(result, outputs, "What drives the results")
    units = system_of(result.units)
    bars = min(len(result.inputs), MOST_BARS)
    texts = {}
    for source in result.inputs:
        low, high = result.limits[source]
        amount = f"{short(low)} … {short(high)} {units.unit(source)}".strip()
        texts[source] = f"{quantity(source).symbol}  {amount}"
    left = max(d.text_width(text, TEXT) for text in texts.values()) + 4.5
    beyond = False
    top = drawing.heading() - 2
    for name in names:
        bound = result.bounds[name]
        drives = sorted(result.drives[name].items(), key=lambda entry: -entry[1].swing)
        for _, drive in drives:
            d.check_drawable((drive.lowest, drive.highest), name)
        ends = [x for _, drive in drives[:bars] for x in (drive.lowest, drive.highest)]
        ticks = [(-place, texts[source]) for place, (source, _) in enumerate(drives[:bars])]
        box = Box(left, top - 4.2 * bars, d.COLUMN - 4, top)
        limits = span([*ends, bound.nominal]), (0.5 - bars, 0.5)
        panel = Panel(drawing, box, *limits, _label(name, units), y_ticks=ticks, x_ticks=5)
        for place, (source, drive) in enumerate(drives[:bars]):
            sides = [(drive.at_low, d.WHITE, "low"), (drive.at_high, d.BLUE, "high")]
            # where both lie on one side the shorter bar stands on the longer
            for value, colour, end in sorted(sides, key=lambda side: -abs(side[0] - bound.nominal)):
                start, stop = panel.at(bound.nominal, -place), panel.at(value, -place)
                bar = d.extent((start - 1.3j, stop + 1.3j)).corners
                drawing.add(Path(bar, d.BLUE, 0.2, fill=colour, role=f"{source} {end}"))
            # only where the result goes beyond what the input's limits give
            inner = bound.nominal, drive.at_low, drive.at_high
            for whisker in ((drive.lowest, min(inner)), (max(inner), drive.highest)):
                if whisker[1] - whisker[0] > 1e-9 * (limits[0][1] - limits[0][0]):
                    panel.line(whisker, [-place] * 2, BLACK, 0.3, role="whisker")
                    beyond = True
        panel.rule(bound.nominal, role="nominal")
        top = box.bottom - 11.5 - ROW * (len(label_lines(drawing, box, _label(name, units))) - 1)
    looks: list[tuple[str, str, Any]] = [("at its upper limit", d.BLUE, None)]
    if beyond:
        looks.append(("in between", BLACK, ()))
    drawing.height = 2 - key(drawing, top, ("at its lower limit", d.WHITE, None), *looks)
    return drawing


def friction_sweep(scene: Any) -> Drawing:
    """Energy loss and both ΔV against the friction that opposes the sliding, from none to beyond
    the critical coefficient, at which the sliding ends; more would reverse it, which friction
    cannot do: shaded. Raises UserError when a value of the scene is no number."""
    from ...mechanics.closedform.solve import solve

    values: dict[str, Any] = numbers_of(scene)
    pivot = solve({**values, "MU": PIVOT}, ["MUC"])
    # as one would type it: line 400 turns the sign of what is typed where gt > 0
    sign = float(np.sign(solve({**values, "MU": 1.0}, ["MUP"])["MUP"]))
    critical = sign * float(pivot["MUC"])
    marked_value = critical if values["MU"] == PIVOT else values["MU"]
    limit = critical if np.isfinite(critical) and 0 < critical <= WIDEST_SWEEP else 0.0
    reach = min(max(1.0, 1.3 * limit, 1.2 * marked_value), WIDEST_SWEEP)
    low = min(0.0, 1.2 * marked_value)  # a scene whose friction drives the sliding shows itself
    faults = Status.FRICTION_ABOVE_CRITICAL | Status.FRICTION_WRONG_DIRECTION
    axis = np.linspace(max(low, -WIDEST_SWEEP), reach, SWEEP)
    groups = [["LOSS"], ["DVA", "DVB"]]
    titles = ("Energy loss and ΔV against friction", "friction coefficient as typed (MU)")
    words = _Words(*titles, "pivot" if values["MU"] == PIVOT else "this scene")
    curves = _Curves(scene, "MU", axis, [output for group in groups for output in group], faults)
    marked_value, limit = (curves.units.display_unwrapped("MU", x) for x in (marked_value, limit))
    return _along(curves, groups, marked_value, words, limit)


def swept(scene: Any, name: str, values: Sequence[float], outputs: Sequence[str]) -> Drawing:
    """Results of a scene along one of its values, a panel each; shaded where STATUS says that the
    impact is unphysical. Raises UserError for more results than fit a page."""
    _check_count(outputs)
    units = _system(scene)
    titles = (f"Results against {quantity(name).meaning.partition(';')[0]}", _label(name, units))
    own, words = numbers_of(scene)[name], _Words(*titles, "this scene")
    groups = [[output] for output in outputs]
    axis = np.unique(np.asarray(values, float))
    if len(axis) < 2 or axis[-1] - axis[0] <= _FLAT * np.abs(axis).max():
        raise UserError(f"{name}: a sweep of one value is no curve; expected two or more, apart")
    if axis[0] < own < axis[-1] and own != PIVOT:
        axis = np.union1d(axis, [own])  # the curve passes through what is marked
    curves = _Curves(scene, name, axis, outputs, ~0)
    return _along(curves, groups, curves.units.display_unwrapped(name, own), words)


class _Curves:
    """Results of a scene along one of its values, as they are shown.

    Parameters
    ----------
    scene
        The scene.
    name
        The value that runs.
    axis
        Its numbers, rising.
    outputs
        Names of the results.
    faults
        Bits of STATUS under which the impact is unphysical.

    Attributes
    ----------
    axis : ndarray
        The numbers along which the curves run.
    values : dict of str to ndarray
        The results along them.
    here : dict of str to float
        The results of the scene itself.
    faulty : ndarray
        Where STATUS has a fault.
    shaded : ndarray
        First and last number of each stretch that has one.
    """

    def __init__(
        self, scene: Any, name: str, axis: Any, outputs: Sequence[str], faults: int
    ) -> None:
        from ...mechanics.closedform.solve import solve

        numbers: dict[str, Any] = numbers_of(scene)
        self.units = units = _system(scene)
        case = getattr(scene, "case", None)

        def columns(axis: Any) -> dict[str, Any]:
            return swept_columns(case, name, axis) if case else {**numbers, name: axis}

        def is_faulty(axis: Any) -> Any:
            bits = solve(columns(axis), ["STATUS"])["STATUS"]
            return (bits & np.uint16(faults & 0xFFFF)) != 0

        results = solve(columns(axis), outputs)
        for output in outputs:
            d.check_drawable(results[output], output)
        d.check_drawable(axis, name)
        self.faulty = is_faulty(axis)
        self.axis = units.display_unwrapped(name, axis)
        self.shaded = units.display_unwrapped(name, faulty_stretches(axis, is_faulty))
        self.values = {n: units.display_unwrapped(n, results[n]) for n in outputs}
        own = solve(numbers, outputs)
        self.here = {n: units.display_unwrapped(n, float(value)) for n, value in own.items()}


class _Words(NamedTuple):
    """A sweep's title, the name of its axis, and what is said of the scene's own mark."""

    title: str
    axis: str
    own: str


def _along(
    curves: _Curves, groups: Sequence[Sequence[str]], own: float, words: _Words, limit: float = 0.0
) -> Drawing:
    """Draw a panel for each of the ``groups`` of results, with the scene's ``own`` value marked,
    faults shaded, and a line at ``limit``."""
    units = curves.units
    says = (f"{_label(n, units)}: {short(value)}." for n, value in curves.here.items())
    drawing = Drawing(d.COLUMN, words.title, f"In this scene: {' '.join(says)}")
    top = drawing.heading() - _TOP
    reaches = [
        _reach([(curves.values[o], curves.here[o]) for o in group], curves.faulty)
        for group in groups
    ]
    numbers_y = (text for y in reaches for _, text in ticks(*y, 4))
    left = max(_LEFT, max(d.text_width(text, TEXT) for text in numbers_y) + 3.2)
    entries: list[tuple[str, str, Any]] = []
    ends = float(curves.axis[0]), float(curves.axis[-1])
    for group, y in zip(groups, reaches, strict=True):
        box = Box(left, top - 27, d.COLUMN - 4, top)
        label = _label(group[0], units)
        if len(group) > 1:  # sizes
            label = f"ΔV,{label.rpartition(',')[2]}"
        panel = Panel(drawing, box, ends, y, words.axis if group == groups[-1] else "", label)
        entries += _draw_curves(panel, curves, group, own)
        for first, last in curves.shaded:
            panel.shade(first, last, _UNPHYSICAL)
        if limit:
            panel.rule(limit, dash=_DOTTED, role="critical")
        top = box.bottom - 11.5
    entries.append((words.own, BLACK, "o"))
    if limit:
        entries.append((f"critical: {short(limit)}", BLACK, _DOTTED))
    if curves.faulty.any():
        entries.append((WARNED, _UNPHYSICAL, None))
    drawing.height = 2 - key(drawing, top, *entries)
    return drawing


def _draw_curves(
    panel: Panel, curves: _Curves, group: Sequence[str], own: float
) -> list[tuple[str, str, Any]]:
    """Draw a panel's curves, with the scene's own values marked; return the entries of the key,
    which one curve alone does not need."""
    axis, several = curves.axis, len(group) > 1
    entries: list[tuple[str, str, Any]] = []
    low, high = panel.y.low, panel.y.high
    if low < 0 < high:
        panel.line(axis[[0, -1]], [0, 0], GREY, 0.2)
    for output, colour, dash in zip(group, (d.BLUE, d.VERMILION), ((), _DASHED), strict=False):
        curve = curves.values[output]
        curve = np.where((curve < low) | (curve > high), np.nan, curve)
        panel.line(axis, curve, colour, dash=dash, role=output)
        if several:
            entries.append((quantity(output).symbol, colour, dash))
        if axis.min() <= own <= axis.max():
            panel.mark(own, curves.here[output], colour=colour if several else BLACK)
    return entries


def _reach(curves: Sequence[tuple[Any, float]], faulty: Any) -> tuple[float, float]:
    """Return the ends of the axis of a panel's curves, each with its value in this scene: of the
    physical part and half of that beyond it where all would squeeze it. Several curves are sizes,
    from 0 on."""
    ends = span([x for curve, here in curves for x in (*curve, here)])
    if faulty.any() and not faulty.all():
        low, high = span([x for curve, here in curves for x in (*curve[~faulty], here)])
        if ends[1] - ends[0] > _SQUEEZED * (high - low):
            extension = 0.5 * (high - low)
            ends = max(ends[0], low - extension), min(ends[1], high + extension)
    return (0.0, ends[1]) if len(curves) > 1 else ends


def faulty_stretches(axis: Any, is_faulty: Callable[[Any], Any]) -> Any:
    """Return first and last value of each stretch of a rising axis that is faulty: ends between two
    of its values are found by bisection."""
    faulty = is_faulty(axis)
    at = np.flatnonzero(faulty[1:] != faulty[:-1])
    low, high = axis[at].astype(float), axis[at + 1].astype(float)
    for _ in range(40 if len(at) else 0):
        middle = (low + high) / 2
        has_changed = is_faulty(middle) != faulty[at]
        low, high = np.where(has_changed, low, middle), np.where(has_changed, middle, high)
    ends = [*([axis[0]] if faulty[0] else []), *high, *([axis[-1]] if faulty[-1] else [])]
    return np.reshape(ends, (-1, 2))


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
    panel = Panel(drawing, box, (0.0, limit), (0.0, limit), *names, y_ticks=6)
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
