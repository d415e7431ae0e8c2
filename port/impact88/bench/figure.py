"""The work-precision figure: error against time per scene, both on log axes."""

from __future__ import annotations

from collections.abc import Sequence

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
"""Method -> mark, colour, whether filled: told apart in grey as well."""
WIDTH = 174.0
"""Millimetres: two columns."""
_ACROSS = 3
_TIMES, _ERRORS = (1e-8, 2e-2), (1e-17, 1e4)


def work_precision(rows: Sequence[Measured]) -> Drawing:
    """A panel for each population: every method's median error (mark) and largest error (end of the
    line) against its time per scene. Down and left is better."""
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
            drawing.items.append(Text(at, line, 6, bold=line == name, role="panel title"))
        label = "relative error of the final velocities" if column == 0 else ""
        panel = Panel(
            *(drawing, box, _TIMES, _ERRORS, "time per scene, s", label),
            x_ticks=powers(1e-8, 1e-2, 2),
            y_ticks=powers(1e-15, 1e3, 3)[::3],
            log=True,
            grid=True,
        )
        _draw(panel, [row for row in rows if row.population == name])
    entries = {row.name: row for row in rows if row.method in MARKS or row.method == "mpmath"}
    samples = []
    for name, one in entries.items():
        shape, colour, filled = MARKS.get(one.method, ("", GREY, True))
        look = (shape if filled else f"{shape} ") if shape else (0.4, 0.6)
        samples.append((name, colour, look))
    bottom = top - 56 * -(-len(names) // _ACROSS) + 8
    drawing.height = 2 - key(drawing, bottom, *samples, note="mark: median; end of line: largest")
    return drawing


def _draw(panel: Panel, rows: Sequence[Measured]) -> None:
    def shown(error: float) -> float:
        return min(max(error, _ERRORS[0]), _ERRORS[1])  # an error of 0 stands on the axis

    for row in rows:
        if row.method == "mpmath":
            panel.rule(row.seconds, GREY, (0.4, 0.6))
        if row.method not in MARKS:
            continue
        shape, colour, filled = MARKS[row.method]
        median, largest = shown(row.median), shown(row.largest)
        panel.line([row.seconds] * 2, [median, largest], colour, 0.3)
        panel.mark(row.seconds, largest, "_", colour)
        panel.mark(row.seconds, median, shape, colour, filled, row.method)
