"""The benchmark's figures: error against time, against condition, and its distribution."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..accuracy.errorbound import APPLESOFT, DOUBLE, relative_bounds
from ..figures.charts import Panel, key, powers
from ..figures.drawing import GREY, ORANGE, VERMILION, Box, Drawing, Text, wrapped
from .measure import Row
from .methods import METHODS
from .populations import POPULATIONS

WIDTH = 174.0
"""Millimetres: two columns."""
_ROW, _PANELS = 56.0, 3
_TIMES, _ERRORS = (1e-9, 2e-2), (1e-17, 1e4)
_CONDITIONS, _SHARES = (1.0, 1e16), (1e-4, 1.0)
_LABEL = "relative error of the final velocities"
_MARKS = {method.key: (method.mark, method.colour) for method in METHODS}
SCATTERED = ("applesoft", "lapack-fill", "closed-form")
"""Methods whose errors are shown scene by scene."""
MOST_MARKS = 250
"""Scenes shown of each method; more cover each other."""


_Axis = tuple[tuple[float, float], str, Sequence[tuple[float, str]]]


class _Page:
    """A drawing of rows of panels with both axes logarithmic, and a key below them."""

    def __init__(self, title: str, described: str, rows: Sequence[Row]) -> None:
        told = [
            f"{row['name']} on {row['population']}: {row['seconds']:.2g} s, median "
            f"{row['median']:.2g}, largest {row['largest']:.2g}"
            for row in rows
            if "median" in row
        ]
        self.rows = rows
        self.names = list(dict.fromkeys(row["population"] for row in rows))
        self.drawing = Drawing(WIDTH, title, f"{described}. {'; '.join(told)}.")
        self.top = self.drawing.heading() - 11

    def panel(
        self, left: float, right: float, row: int, title: Sequence[str], x: _Axis, y: _Axis
    ) -> Panel:
        """Each axis: its ends, label and ticks."""
        top = self.top - _ROW * row
        for count, line in enumerate(title[::-1]):
            at = complex(left, top + 5 + 2.8 * count)
            self.drawing.add(Text(at, line, 6, bold=line == title[0], role="panel title"))
        box, (xs, x_label, x_ticks), (ys, y_label, y_ticks) = Box(left, top - 38, right, top), x, y
        ticks: Any = {"x_ticks": x_ticks, "y_ticks": y_ticks}
        return Panel(self.drawing, box, xs, ys, x_label, y_label, **ticks, log=True)

    def finished(self, rows: int, methods: Sequence[str], note: str) -> Drawing:
        names = {row["method"]: row["name"] for row in self.rows if row["method"] in methods}
        look = {"mpmath": ((0.4, 0.6), GREY), **_MARKS}
        samples = [(name, look[method][1], look[method][0]) for method, name in names.items()]
        self.drawing.height = 2 - key(self.drawing, self.top - _ROW * rows + 8, *samples, note=note)
        return self.drawing


def _mark(panel: Panel, x: float, error: float, method: str) -> None:
    shape, colour = _MARKS[method]
    panel.mark(x, _shown(error), shape[0], colour, shape[-1] != " ", method)


def _shown(error: float) -> float:
    return min(max(error, _ERRORS[0]), _ERRORS[1])  # an error of 0 stands on the axis


_ERROR_TICKS = powers(1e-15, 1e3, 3)[::3]


def work_precision(rows: Sequence[Row], roof: float) -> Drawing:
    """A panel for each population: every method's median error (mark) and largest error (end of the
    line) against its time per scene. Down and left is better; nothing that reads its scenes from
    memory is left of ``roof``, seconds a scene."""
    page = _Page("Error against time", "Time per scene and median relative error", rows)
    for place, name in enumerate(page.names):
        across, column = divmod(place, _PANELS)
        title = [name, *wrapped(POPULATIONS[name].meaning, 52, 6)]
        panel = page.panel(
            *(12 + 56.0 * column, 56 + 56.0 * column, across, title),
            (_TIMES, "time per scene, s", powers(1e-9, 1e-2, 2)),
            (_ERRORS, "" if column else _LABEL, _ERROR_TICKS),
        )
        panel.rule(roof, dash=(1.2, 0.6), role="memory roof")
        for row in rows:
            if row["population"] != name:
                continue
            if row["method"] not in _MARKS:
                panel.rule(row["seconds"], GREY, dash=(0.4, 0.6))
                continue
            colour, ends = _MARKS[row["method"]][1], (_shown(row["median"]), _shown(row["largest"]))
            panel.line([row["seconds"]] * 2, ends, colour, 0.3)
            panel.mark(row["seconds"], ends[1], "_", colour)
            _mark(panel, row["seconds"], row["median"], row["method"])
    note = "mark: median; end of line: largest; dashed: what memory alone takes"
    return page.finished(-(-len(page.names) // _PANELS), [*_MARKS, "mpmath"], note)


def error_distribution(rows: Sequence[Row]) -> Drawing:
    """Two panels for each population: every scene's error, by its `errorbound.scales`, against its
    COND, the bound `relative_bounds` of each precision as a line; and the share of scenes with a
    larger error."""
    title = "Error against condition, and the distribution of errors"
    rows = [row for row in rows if row["method"] in SCATTERED]
    page = _Page(title, "Errors against condition and their distribution", rows)
    for place, name in enumerate(page.names):
        errors = page.panel(
            *(12, 84, place, [name]),
            (_CONDITIONS, "condition", powers(1, 1e16, 4)),
            (_ERRORS, "" if place else "error by the scene's speeds and spins", _ERROR_TICKS),
        )
        for unit, colour in ((DOUBLE, ORANGE), (APPLESOFT, VERMILION)):
            line = [_shown(x) for x in relative_bounds(_CONDITIONS, unit).tolist()]
            errors.line(_CONDITIONS, line, colour, dash=(1.2, 0.6), role="bound")
        shares = page.panel(
            *(98, 170, place, []),
            (_ERRORS, "the same error", _ERROR_TICKS),
            (_SHARES, "" if place else "share of scenes with a larger error", powers(1e-4, 1, 1)),
        )
        for row in rows:
            if row["population"] != name:
                continue
            method, found = row["method"], row["errors"]
            every = max(1, len(found) // MOST_MARKS)
            for condition, error in zip(row["conditions"][::every], found[::every], strict=True):
                _mark(errors, float(np.clip(condition, *_CONDITIONS)), float(error), method)
            ordered = np.clip(np.sort(found), *_ERRORS)
            share = 1 - np.arange(len(ordered)) / len(ordered)
            mark, colour = _MARKS[method]
            dash = (0.4, 0.6) if mark[-1] == " " else ()
            shares.line(ordered, share, colour, dash=dash, role=method)
    note = "dashed: 16 × condition × unit roundoff, of double precision and of the 1988 program"
    return page.finished(len(page.names), SCATTERED, note)
