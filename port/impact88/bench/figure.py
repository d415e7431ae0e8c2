"""The work-precision figure: error against time per scene, both on log axes (needs matplotlib)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..figures.canvas import new_figure, style
from ..figures.drawing import BLACK, BLUE, GREY, ORANGE, VERMILION
from .measure import Measured
from .populations import POPULATIONS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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


def work_precision(rows: Sequence[Measured]) -> Figure:
    """A panel for each population: every method's median error (mark) and largest error (end of the
    line) against its time per scene. Down and left is better."""
    names = list(dict.fromkeys(row.population for row in rows))
    across = 3
    down = -(-(len(names) + 1) // across)
    with style():
        figure = new_figure(WIDTH, 10 + 52 * down)
        panels = figure.subplots(down, across, sharex=True, sharey=True, squeeze=False).ravel()
        for axes, name in zip(panels, names, strict=False):
            _panel(axes, name, [row for row in rows if row.population == name])
        for axes in panels[len(names) :]:
            axes.axis("off")
        # the bottom panel of each column names the axis; a shared one may be switched off
        for i, axes in enumerate(panels[: len(names)]):
            if i + across >= len(names):
                axes.set_xlabel("time per scene, s")
                axes.tick_params(labelbottom=True)
            if i % across == 0:
                axes.set_ylabel("relative error of the final velocities")
        handles, labels = panels[0].get_legend_handles_labels()
        panels[-1].legend(
            handles,
            labels,
            loc="center left",
            title="mark: median; end of line: largest",
            title_fontsize=6.5,
            labelspacing=0.7,
        )
        figure.tight_layout(pad=0.6)
    return figure


def _panel(axes: Axes, name: str, rows: Sequence[Measured]) -> None:
    from matplotlib.ticker import LogLocator, NullFormatter

    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(1e-8, 2e-2)
    axes.set_ylim(1e-17, 1e4)
    axes.xaxis.set_major_locator(LogLocator(numticks=20))
    axes.yaxis.set_major_locator(LogLocator(base=1000, numticks=20))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.tick_params(which="minor", length=0)
    axes.grid(which="major", color="#dddddd", linewidth=0.4)
    axes.set_axisbelow(True)
    axes.set_title(f"{name}\n{POPULATIONS[name].meaning}", fontsize=6, linespacing=1.4)
    reference = next((row for row in rows if row.method == "mpmath"), None)
    for row in rows:
        if row.method not in MARKS:
            continue
        mark, colour, filled = MARKS[row.method]
        axes.plot([row.seconds] * 2, [row.median, row.largest], color=colour, linewidth=0.9)
        axes.plot(
            row.seconds,
            row.median,
            marker=mark,
            markersize=4.5,
            linestyle="none",
            color=colour,
            markerfacecolor=colour if filled else "white",
            markeredgewidth=0.9,
            label=row.name,
            zorder=5,
        )
        axes.plot(row.seconds, row.largest, marker="_", markersize=4, color=colour)
    if reference is not None:
        axes.axvline(
            reference.seconds, color=GREY, linewidth=0.8, linestyle=":", label=reference.name
        )
