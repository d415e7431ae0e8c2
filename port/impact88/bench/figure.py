"""The benchmark's figures: error against time, against condition, and its distribution."""

from collections.abc import Sequence

import numpy as np

from ..accuracy.errorbound import APPLESOFT, DOUBLE, relative_bounds
from ..figures.axes import Panel, key, powers
from ..figures.drawing import BLACK, BLUE, GREY, ORANGE, VERMILION, Box, Drawing, Text, wrapped
from .measure import Measured
from .populations import POPULATIONS

MARKS = {
    "applesoft": ("s", VERMILION, False),
    "replay": ("s", VERMILION, True),
    "float64": ("o", BLUE, False),
    "elimination": ("v", BLUE, True),
    "lapack": ("^", GREY, True),
    "lapack-changes": (">", GREY, True),
    "lapack-fill": ("^", GREY, False),
    "closed-form": ("D", ORANGE, True),
    "closed-form-2": ("D", BLACK, False),
    "closed-form-numpy": ("D", ORANGE, False),
    "replay-numpy": ("P", VERMILION, False),
}
"""Method -> mark, colour, whether filled: distinct in grey as well."""
WIDTH = 174.0
"""Millimetres: two columns."""
_ACROSS = 3
_TIMES, _ERRORS = (1e-9, 2e-2), (1e-17, 1e4)


def work_precision(rows: Sequence[Measured], roof: float) -> Drawing:
    """A panel for each population: every method's median error (mark) and largest error (end of the
    line) against its time per scene. Down and left is better; nothing that reads its scenes from
    memory is left of ``roof``, seconds a scene."""
    names = list(dict.fromkeys(row.population for row in rows))
    told = [
        f"{row.name} on {row.population}: {row.seconds:.2g} s, {row.median:.2g}" for row in rows
    ]
    description = "Time per scene and median relative error. " + "; ".join(told) + "."
    drawing = Drawing(WIDTH, "Error against time", description)
    top = drawing.heading() - 11
    for place, name in enumerate(names):
        row, column = divmod(place, _ACROSS)
        left, upper = 12 + 56.0 * column, top - 56 * row
        box = Box(left, upper - 38, left + 44, upper)
        what = POPULATIONS[name].meaning
        for count, line in enumerate([name, *wrapped(what, 52, 6)][::-1]):
            at = complex(left, upper + 5 + 2.8 * count)
            drawing.add(Text(at, line, 6, bold=line == name, role="panel title"))
        label = "relative error of the final velocities" if column == 0 else ""
        panel = Panel(
            *(drawing, box, _TIMES, _ERRORS, "time per scene, s", label),
            x_ticks=powers(1e-9, 1e-2, 2),
            y_ticks=powers(1e-15, 1e3, 3)[::3],
            log=True,
            grid=True,
        )
        panel.rule(roof, BLACK, (1.2, 0.6), "memory roof")
        _draw(panel, [row for row in rows if row.population == name])
    entries = {row.name: row for row in rows if row.method in MARKS or row.method == "mpmath"}
    samples = []
    for name, one in entries.items():
        shape, colour, filled = MARKS.get(one.method, ("", GREY, True))
        look = (shape if filled else f"{shape} ") if shape else (0.4, 0.6)
        samples.append((name, colour, look))
    note = "mark: median; end of line: largest; dashed: what memory alone takes"
    bottom = top - 56 * -(-len(names) // _ACROSS) + 8
    drawing.height = 2 - key(drawing, bottom, *samples, note=note)
    return drawing


def _draw(panel: Panel, rows: Sequence[Measured]) -> None:
    for row in rows:
        if row.method == "mpmath":
            panel.rule(row.seconds, GREY, (0.4, 0.6))
        if row.method not in MARKS:
            continue
        shape, colour, filled = MARKS[row.method]
        median, largest = _shown(row.median), _shown(row.largest)
        panel.line([row.seconds] * 2, [median, largest], colour, 0.3)
        panel.mark(row.seconds, largest, "_", colour)
        panel.mark(row.seconds, median, shape, colour, filled, row.method)


SCATTERED = ("applesoft", "lapack-fill", "closed-form")
"""Methods whose errors are shown scene by scene."""
MOST_MARKS = 250
"""Scenes shown of each method; more cover each other."""
_CONDITIONS, _SHARES = (1.0, 1e16), (1e-4, 1.0)


def error_distribution(rows: Sequence[Measured]) -> Drawing:
    """Two panels for each population: every scene's error against its condition, the bound
    `relative_bounds` of each precision as a line; and the share of scenes with a larger error."""
    names = list(dict.fromkeys(row.population for row in rows))
    shown = [row for row in rows if row.method in SCATTERED]
    told = [
        f"{row.name} on {row.population}: median {row.median:.2g}, largest {row.largest:.2g}"
        for row in shown
    ]
    description = "Errors against condition and their distribution. " + "; ".join(told) + "."
    drawing = Drawing(WIDTH, "Error against condition, and the distribution of errors", description)
    top = drawing.heading() - 11
    for place, name in enumerate(names):
        upper = top - 56 * place
        mine = [row for row in shown if row.population == name]
        heading = Text(complex(12, upper + 5), name, 6, bold=True, role="panel title")
        drawing.add(heading)
        label = "relative error of the final velocities" if not place else ""
        errors = Panel(
            *(drawing, Box(12, upper - 38, 84, upper), _CONDITIONS, _ERRORS, "condition", label),
            x_ticks=powers(1, 1e16, 4),
            y_ticks=powers(1e-15, 1e3, 3)[::3],
            log=True,
            grid=True,
        )
        for unit, colour in ((DOUBLE, ORANGE), (APPLESOFT, VERMILION)):
            line = [max(_shown(float(x)), _ERRORS[0]) for x in relative_bounds(_CONDITIONS, unit)]
            errors.line(_CONDITIONS, line, colour, 0.4, (1.2, 0.6), role="bound")
        shares = Panel(
            *(drawing, Box(98, upper - 38, 170, upper), _ERRORS, _SHARES),
            *("relative error", "share of scenes with a larger error" if not place else ""),
            x_ticks=powers(1e-15, 1e3, 3)[::3],
            y_ticks=powers(1e-4, 1, 1),
            log=True,
            grid=True,
        )
        for row in mine:
            shape, colour, filled = MARKS[row.method]
            every = max(1, len(row.errors) // MOST_MARKS)
            pairs = zip(row.conditions[::every], row.errors[::every], strict=True)
            for condition, error in pairs:
                at = min(max(float(condition), 1.0), 1e16)
                errors.mark(at, _shown(float(error)), shape, colour, filled, row.method)
            ordered = np.clip(np.sort(row.errors), *_ERRORS)
            share = 1 - np.arange(len(ordered)) / len(ordered)
            shares.line(ordered, share, colour, 0.4, () if filled else (0.4, 0.6), role=row.method)
    entries = {row.method: row.name for row in shown}
    samples = [
        (name, MARKS[method][1], MARKS[method][0] + ("" if MARKS[method][2] else " "))
        for method, name in entries.items()
    ]
    bottom = top - 56 * len(names) + 8
    note = "dashed: 16 × condition × unit roundoff, of double precision and of the 1988 program"
    drawing.height = 2 - key(drawing, bottom, *samples, note=note)
    return drawing


def _shown(error: float) -> float:
    return min(max(error, _ERRORS[0]), _ERRORS[1])  # an error of 0 stands on the axis
