"""The benchmark's figure: error against time."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..casework.figures.charts import Panel, key, powers
from ..casework.figures.drawing import GREY, Box, Drawing, Text, wrap_text
from .measure import Row
from .methods import METHODS
from .populations import POPULATIONS

WIDTH = 174.0
"""Millimetres: two columns."""
_ROW_HEIGHT = 56.0  # mm: 38 of panel, a title of three lines, numbers and axis below
_PANELS_PER_ROW = 3
# ends of the axes
_TIMES = (1e-9, 2e-2)  # s a scene: 1/20 of memory alone, and ten times what 50 digits take
_ERRORS = (1e-17, 1e4)  # an error of 0 is drawn at the lower end
_LABEL = "relative error of the final velocities"
_MARKS = {method.key: (method.mark, method.colour) for method in METHODS}

_Axis = tuple[tuple[float, float], str, Sequence[tuple[float, str]]]


def _finish(drawing: Drawing, low: float, rows: Sequence[Row], note: str) -> Drawing:
    """Add a key from ``low`` on and a description of the rows, and set the height."""
    summaries = [
        f"{row['name']} on {row['population']}: {row['seconds']:.2g} s, median "
        f"{row['median']:.2g}, largest {row['largest']:.2g}"
        for row in rows
        if "median" in row
    ]
    drawing.description = f"{drawing.description}. {'; '.join(summaries)}."
    look = {"mpmath": ((0.4, 0.6), GREY), **_MARKS}
    samples = {row["name"]: (row["name"], *look[row["method"]][::-1]) for row in rows}
    drawing.height = 2 - key(drawing, low + 8, *samples.values(), note=note)
    return drawing


def _panel(drawing: Drawing, box: Box, title: Sequence[str], x: _Axis, y: _Axis) -> Panel:
    """Add a panel with two logarithmic axes, each given as its ends, label and ticks."""
    for count, line in enumerate(title[::-1]):
        at = complex(box.left, box.top + 5 + 2.8 * count)
        drawing.add(Text(at, line, 6, bold=line == title[0], role="panel title"))
    ticks: Any = {"x_ticks": x[2], "y_ticks": y[2]}
    return Panel(drawing, box, x[0], y[0], x[1], y[1], **ticks, log=True)


def _mark(panel: Panel, x: float, error: float, method: str) -> None:
    shape, colour = _MARKS[method]
    panel.mark(x, _clip_error(error), shape[0], colour, shape[-1] != " ", method)


def _clip_error(error: Any) -> Any:
    return np.clip(error, *_ERRORS)


_ERROR_TICKS = powers(1e-15, 1e3, 3)[::3]


def work_precision(rows: Sequence[Row], roof: float) -> Drawing:
    """A panel for each population: every method's median error (mark) and largest error (end of the
    line) against its time per scene. Down and left is better; nothing that reads its scenes from
    memory is left of ``roof``, seconds a scene."""
    drawing = Drawing(WIDTH, "Error against time", "Time per scene and median relative error")
    top = drawing.heading() - 11
    names = list(dict.fromkeys(row["population"] for row in rows))
    for place, name in enumerate(names):
        below, column = divmod(place, _PANELS_PER_ROW)
        left, upper = 12 + 56.0 * column, top - _ROW_HEIGHT * below
        panel = _panel(
            drawing,
            Box(left, upper - 38, left + 44, upper),
            [name, *wrap_text(POPULATIONS[name].meaning, 52, 6)],
            (_TIMES, "time per scene, s", powers(1e-9, 1e-2, 2)),
            (_ERRORS, "" if column else _LABEL, _ERROR_TICKS),
        )
        panel.rule(roof, dash=(1.2, 0.6), role="memory roof")
        for row in [row for row in rows if row["population"] == name]:
            method, seconds = row["method"], row["seconds"]
            if method not in _MARKS:
                panel.rule(seconds, GREY, dash=(0.4, 0.6))
                continue
            colour, ends = _MARKS[method][1], _clip_error((row["median"], row["largest"]))
            panel.line([seconds] * 2, ends, colour, 0.3)
            panel.mark(seconds, ends[1], "_", colour)
            _mark(panel, seconds, row["median"], method)
    low = top - _ROW_HEIGHT * -(-len(names) // _PANELS_PER_ROW)
    note = "mark: median; end of line: largest; dashed: what memory alone takes"
    return _finish(drawing, low, rows, note)
