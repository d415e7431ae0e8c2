"""Charts with axes: draws and drivers of bounds, the friction sweep, staged collisions.

Every function returns a matplotlib figure one column (85 mm) wide. Nothing is told by colour alone:
marks, line styles and lightness differ as well, so a grey copy reads the same. Nothing is hatched:
some renderers of SVG paint patterns black.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from textwrap import fill
from typing import TYPE_CHECKING, Any

from ..errors import UserError
from ..names import PIVOT
from ..scene import numbers_of
from ..status import Status
from ..units import RULES, System, system_of
from .canvas import new_figure, style
from .drawing import BLACK, BLUE, COLUMN, GREY, ORANGE, VERMILION, check_drawable
from .sceneview import short

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..uncertainty.boundstable import Bounds

MOST_PANELS = 12
MOST_BARS = 8
BINS = 60
_LABEL = 22
"""Characters of a line of an axis label: what two panels side by side have room for."""
SWEEP = 801
WIDEST_SWEEP = 5.0
"""Friction coefficients beyond are not swept."""


def symbol(text: str) -> str:
    """A symbol of the table of names as mathtext, its index lowered: V_ax -> $V_{ax}$."""
    base, _, index = text.partition("_")
    close = "|" if index.endswith("|") else ""
    lowered = f"{base}_{{{index.rstrip('|')}}}{close}" if index else base
    return "$\\mathregular{" + lowered.replace(" ", r"\ ") + "}$"


def _axis_label(name: str, units: System) -> str:
    from ..names import quantity

    what = quantity(name)
    unit = {"percent": "%"}.get(what.unit, units.label(what.unit))
    glued = f"{what.meaning},\x00{unit}"  # a unit stays with the word before it
    return fill(glued, _LABEL).replace("\x00", " ")


def _chosen(result: Bounds, outputs: Sequence[str] | None) -> list[str]:
    wanted = list(outputs or result.bounds)
    for name in wanted:
        if name not in result.bounds:
            raise UserError(
                f"{name!r} is not among the results; expected {' '.join(result.bounds)}"
            )
    if len(wanted) > MOST_PANELS:
        raise UserError(f"{len(wanted)} results do not fit a page; expected {MOST_PANELS} at most")
    return wanted


def histograms(result: Bounds, outputs: Sequence[str] | None = None) -> Figure:
    """The draws of up to twelve results, with quantiles, nominal value and bounds.

    ``result`` must have been made with ``keep_draws=True``. Raises UserError for a result it lacks
    and for more than fit.
    """
    import numpy as np

    names = _chosen(result, outputs)
    columns = 1 if len(names) == 1 else 2
    rows = -(-len(names) // columns)
    with style():
        figure = new_figure(COLUMN, 33 * rows + 14)
        figure.set_layout_engine("constrained", h_pad=0.03, w_pad=0.04)
        panels = figure.subplots(rows, columns, squeeze=False).ravel()
        for axes in panels[len(names) :]:
            axes.axis("off")
        for name, axes in zip(names, panels, strict=False):
            draws = result.draws[name]
            draws = draws[np.isfinite(draws)]
            check_drawable((draws.min(), draws.max()), name)
            bound, spread = result.bounds[name], result.spreads[name]
            axes.hist(
                draws,
                BINS,
                weights=np.full(len(draws), 100 / len(draws)),
                histtype="stepfilled",
                facecolor="#c6dff0",
                edgecolor=BLUE,
                linewidth=0.6,
            )
            low, high = spread.quantiles[0.05], spread.quantiles[0.95]
            top = axes.get_ylim()[1] * 1.08
            axes.set_ylim(0, top)
            axes.axvline(bound.nominal, color=BLACK, linewidth=1.0)
            for share in (low, high):
                axes.axvline(share, color=VERMILION, linewidth=1.0, linestyle=(0, (3, 2)))
            axes.plot(
                [bound.lower, bound.upper],
                [0.03 * top] * 2,
                linestyle="none",
                marker="d",
                color=BLACK,
                markersize=4.5,
                clip_on=False,
                zorder=5,
            )
            axes.set_xlabel(_axis_label(name, system_of(result.units)))
            axes.margins(x=0.05)
            axes.xaxis.set_major_locator(_ticks(5 if columns == 2 else 8))
            axes.yaxis.set_major_locator(_ticks(4))
        for axes in panels[::columns]:
            axes.set_ylabel("% of draws")
        figure.legend(
            handles=_keys(
                ("line", BLACK, "-", "nominal"),
                ("line", VERMILION, (0, (3, 2)), "5 % and 95 %"),
                ("mark", BLACK, "d", "bounds"),
            ),
            loc="outside lower center",
            ncols=3,
        )
    return figure


def tornado(result: Bounds, outputs: Sequence[str] | None = None) -> Figure:
    """How far each input alone takes each result, longest first; one panel a result.

    Bars end at the results of the input's limits, whiskers where the result goes in between.
    Raises UserError for a result it lacks.
    """
    from ..names import quantity

    names = _chosen(result, outputs)
    bars = min(len(result.inputs), MOST_BARS)
    with style():
        figure = new_figure(COLUMN, len(names) * (4.2 * bars + 14) + 7)
        figure.set_layout_engine("constrained", h_pad=0.04)
        panels = figure.subplots(len(names), 1, squeeze=False).ravel()
        for name, axes in zip(names, panels, strict=True):
            bound = result.bounds[name]
            drives = sorted(result.drives[name].items(), key=lambda entry: -entry[1].swing)
            for _, drive in drives:
                check_drawable((drive.lowest, drive.highest), name)
            ticks = []
            for place, (source, drive) in enumerate(drives[:bars]):
                ends = [(drive.at_low, "#ffffff", ""), (drive.at_high, BLUE, "")]
                # where both lie on one side the shorter bar stands on the longer
                for value, colour, hatch in sorted(
                    ends, key=lambda end: -abs(end[0] - bound.nominal)
                ):
                    axes.barh(
                        place,
                        value - bound.nominal,
                        left=bound.nominal,
                        height=0.62,
                        facecolor=colour,
                        edgecolor=BLUE,
                        hatch=hatch,
                        linewidth=0.6,
                    )
                axes.plot([drive.lowest, drive.highest], [place] * 2, color=BLACK, linewidth=0.8)
                low, high = result.limits[source]
                what = symbol(quantity(source).symbol)
                unit = system_of(result.units).unit(source)
                ticks.append(f"{what}  {short(low)} … {short(high)} {unit}".strip())
            axes.set_yticks(range(len(ticks)), ticks)
            axes.tick_params(axis="y", length=0)
            axes.invert_yaxis()
            axes.axvline(bound.nominal, color=BLACK, linewidth=0.8)
            axes.set_xlabel(_axis_label(name, system_of(result.units)))
            axes.xaxis.set_major_locator(_ticks(6))
            axes.margins(x=0.04)
        figure.legend(
            handles=_keys(
                ("bar", "#ffffff", "", "at its lower limit"),
                ("bar", BLUE, "", "at its upper limit"),
                ("line", BLACK, "-", "in between"),
            ),
            loc="outside lower center",
            ncols=3,
            columnspacing=1.2,
        )
    return figure


def friction_sweep(scene: Any) -> Figure:
    """Energy loss and both ΔV against the size of friction that opposes the sliding, all else as in
    ``scene``: from none to beyond the critical coefficient, at which the sliding ends.

    More friction than that would reverse the sliding, which friction cannot do: shaded. Raises
    UserError when a value of the scene is no number.
    """
    import numpy as np

    from ..closedform.solve import solve

    values: dict[str, Any] = numbers_of(scene)
    units = system_of(getattr(scene, "units", None))
    speed = units.shown("length/time", 1.0)
    signed = solve({**values, "MU": PIVOT}, ["MUC", "PN", "PT"])
    # as one would type it: line 400 turns the sign of what is typed where gt > 0
    sign = float(np.sign(solve({**values, "MU": 1.0}, ["MUP"])["MUP"]))
    critical = sign * float(signed["MUC"])
    own = critical if values["MU"] == PIVOT else values["MU"]
    limit = critical if np.isfinite(critical) and 0 < critical <= WIDEST_SWEEP else 0.0
    reach = min(max(1.0, 1.3 * limit, 1.2 * own), WIDEST_SWEEP)
    low = min(0.0, 1.2 * own)  # a scene whose friction drives the sliding shows itself
    friction = np.linspace(max(low, -WIDEST_SWEEP), reach, SWEEP)
    results = solve({**values, "MU": friction}, ["LOSS", "DVA", "DVB", "STATUS"])
    for name in ("LOSS", "DVA", "DVB"):
        check_drawable(results[name], name)
    faults = Status.FRICTION_ABOVE_CRITICAL | Status.FRICTION_WRONG_DIRECTION
    beyond = (results["STATUS"] & np.uint16(faults)) != 0
    own_results = {
        name: float(value) for name, value in solve(values, ["LOSS", "DVA", "DVB"]).items()
    }
    with style():
        figure = new_figure(COLUMN, 92)
        figure.set_layout_engine("constrained", h_pad=0.03)
        upper, lower = figure.subplots(2, 1, sharex=True)
        upper.plot(friction, results["LOSS"], color=BLACK)
        upper.axhline(0, color=GREY, linewidth=0.6)
        upper.set_ylabel("kinetic energy lost, %")
        lower.plot(friction, speed * results["DVA"], color=BLUE, label=symbol("ΔV_a"))
        lower.plot(friction, speed * results["DVB"], color=VERMILION, linestyle=(0, (4, 1.5)))
        lower.set_ylabel("ΔV" if units is RULES else f"ΔV, {units.label('length/time')}")
        lower.set_xlabel("friction coefficient as typed (MU)")
        lower.set_ylim(bottom=0)
        if friction[0] <= own <= friction[-1]:
            upper.plot(own, own_results["LOSS"], "o", color=BLACK, markersize=4, zorder=6)
            for name, colour in (("DVA", BLUE), ("DVB", VERMILION)):
                lower.plot(
                    own, speed * own_results[name], "o", color=colour, markersize=4, zorder=6
                )
        for axes in (upper, lower):
            axes.set_xlim(friction[0], friction[-1])
            _shade(axes, friction, beyond)
            if limit:
                axes.axvline(critical, color=BLACK, linewidth=1.0, linestyle=(0, (1, 1.5)))
        entries = [
            ("line", BLUE, "-", symbol("ΔV_a")),
            ("line", VERMILION, (0, (4, 1.5)), symbol("ΔV_b")),
            ("mark", BLACK, "o", "pivot" if values["MU"] == PIVOT else "this scene"),
        ]
        if limit:
            entries.append(("line", BLACK, (0, (1, 1.5)), f"critical: {short(critical)}"))
        if beyond.any():
            entries.append(("bar", _GAINED, "", "not admissible"))
        figure.legend(
            handles=_keys(*entries), loc="outside lower center", ncols=3, columnspacing=1.2
        )
    return figure


def swept(scene: Any, name: str, values: Sequence[float], outputs: Sequence[str]) -> Figure:
    """Results of a scene along one of its values, one panel each; shaded where a bit of STATUS says
    that the impact is unphysical. Raises UserError for more results than fit a page."""
    import numpy as np

    from ..closedform.solve import solve

    if len(outputs) > MOST_PANELS:
        raise UserError(f"{len(outputs)} results do not fit a page; expected {MOST_PANELS} at most")
    numbers: dict[str, Any] = numbers_of(scene)
    units = system_of(getattr(scene, "units", None))
    axis, shown = np.asarray(values), units.factor(name)
    results = solve({**numbers, name: axis}, [*outputs, "STATUS"])
    faulty = results["STATUS"] != 0
    check_drawable(axis, name)
    for output in outputs:
        check_drawable(results[output], output)
    with style():
        figure = new_figure(COLUMN, 34 * len(outputs) + 12)
        figure.set_layout_engine("constrained", h_pad=0.03)
        panels = figure.subplots(len(outputs), 1, sharex=True, squeeze=False).ravel()
        for output, axes in zip(outputs, panels, strict=True):
            factor = units.factor(output)
            axes.plot(axis * shown, results[output] * factor, color=BLUE)
            axes.set_ylabel(_axis_label(output, units))
            if min(values) <= numbers[name] <= max(values):
                here = float(solve(numbers, [output])[output]) * factor
                axes.plot(numbers[name] * shown, here, "o", color=BLACK, markersize=4, zorder=6)
            _shade(axes, axis * shown, faulty)
        panels[-1].set_xlabel(_axis_label(name, units))
        entries = [("mark", BLACK, "o", "this scene")]
        if faulty.any():
            entries.append(("bar", _GAINED, "", "unphysical: see STATUS"))
        figure.legend(handles=_keys(*entries), loc="outside lower center", ncols=2)
    return figure


_GAINED = "#f7dfae"


def _shade(axes: Axes, friction: Any, gained: Any) -> None:
    """Shade the stretches of the horizontal axis where ``gained`` holds."""
    import numpy as np

    edges = np.flatnonzero(np.diff(np.concatenate([[0], gained.astype(int), [0]])))
    for first, last in edges.reshape(-1, 2):
        axes.axvspan(
            friction[first],
            friction[last - 1],
            facecolor=_GAINED,
            linewidth=0,
            zorder=0,
        )


def figure_5() -> Figure:
    """Figure 5 from our own computation: the impact equations with Table 2's coefficients, and
    Equation 19 with its energy loss, against the measured ΔV (Table 2's where Table 1's is lost).
    """
    from ..chapter.staged import collisions, experimental, forward, predicted

    equations, equation_19 = [], []
    for collision in collisions():
        measured = experimental(collision)
        computed, rule = forward(collision), predicted(collision)
        for name, printed in (("DVA", "dVa_exp"), ("DVB", "dVb_exp")):
            x = measured[name]
            if not math.isfinite(x):
                x = collision.table2[printed]
            equations.append((x, float(computed[name]), name[-1]))
            equation_19.append((x, float(rule[name]), name[-1]))
    return staged_comparison({"impact equations": equations, "Equation 19": equation_19})


def staged_comparison(points: Mapping[str, Sequence[tuple[float, float, str]]]) -> Figure:
    """Figure 5: calculated against experimental ΔV.

    ``points``: series name -> (experimental, calculated, vehicle A or B); at most three series,
    each with a mark of its own, filled for A and open for B.
    """
    marks = ("o", "^", "s")
    with style():
        figure = new_figure(COLUMN, 92)
        figure.set_layout_engine("constrained")
        axes = figure.subplots()
        top = 1.06 * max(max(x, y) for series in points.values() for x, y, _ in series)
        axes.plot([0, top], [0, top], color=GREY, linewidth=0.8)
        for series, mark, colour in zip(
            points.values(), marks, (BLUE, VERMILION, BLACK), strict=False
        ):
            for x, y, vehicle in series:
                axes.plot(
                    x,
                    y,
                    linestyle="none",
                    marker=mark,
                    markersize=4.5,
                    markeredgewidth=0.9,
                    color=colour,
                    markerfacecolor=colour if vehicle == "A" else "#ffffff",
                    zorder=3,
                )
        axes.set_xlim(0, top)
        axes.set_ylim(0, top)
        axes.set_aspect("equal")
        axes.set_xlabel("experimental ΔV, ft/s")
        axes.set_ylabel("calculated ΔV, ft/s")
        entries = [
            ("mark", colour, mark, name)
            for name, mark, colour in zip(points, marks, (BLUE, VERMILION, BLACK), strict=False)
        ]
        figure.legend(
            handles=[
                *_keys(*entries, ("line", GREY, "-", "equal")),
            ],
            title="filled: vehicle A; open: vehicle B",
            title_fontsize=6.5,
            loc="outside lower center",
            ncols=2,
        )
    return figure


def force_and_impulse() -> Figure:
    """Figure 1: a typical force between vehicles, and the average force of the same impulse."""
    import numpy as np

    with style():
        figure = new_figure(COLUMN, 48)
        figure.set_layout_engine("constrained", w_pad=0.05)
        typical, average = figure.subplots(1, 2)
        time = np.linspace(0, 1, 201)
        # a skewed hump, its peak two to three times the mean as Section III says of F_M
        force = time**2.6 * (1 - time) ** 4.2 * (1 + 0.1 * np.sin(9 * np.pi * time))
        force /= force.max()
        # by hand: numpy has renamed its function for it
        mean = float(((force[1:] + force[:-1]) / 2 * np.diff(time)).sum())
        typical.fill_between(time, force, facecolor="#c6dff0", edgecolor=BLUE, linewidth=1.2)
        average.fill_between([0, 1], mean, facecolor="#c6dff0", edgecolor=BLUE, linewidth=1.2)
        for axes, level, name in ((typical, 1.0, "F_M"), (average, mean, "F_A")):
            axes.plot([0, 1], [level] * 2, color=GREY, linewidth=0.6, linestyle=(0, (3, 2)))
            axes.set_yticks([level], [symbol(name)])
            axes.set_xticks([0, 1], ["0", symbol("t_f")])
            axes.set_xlim(0, 1.15)
            axes.set_ylim(0, 1.18)
            axes.set_xlabel("time")
            axes.text(0.4, 0.4 * mean, "impulse", ha="center", va="center")
        typical.set_ylabel("force")
        typical.set_title("a. typical force", loc="left")
        average.set_title("b. average force", loc="left")
    return figure


def _ticks(most: int) -> Any:
    from matplotlib.ticker import MaxNLocator

    return MaxNLocator(nbins=most, min_n_ticks=2)


def _keys(*entries: tuple[str, str, Any, str]) -> list[Any]:
    """Legend samples: ("line", colour, line style, text), ("mark", colour, marker, text) or
    ("bar", face colour, hatch, text)."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    result: list[Any] = []
    for kind, colour, look, text in entries:
        if kind == "line":
            result.append(Line2D([], [], color=colour, linestyle=look, label=text))
        elif kind == "mark":
            result.append(
                Line2D(
                    [], [], color=colour, marker=look, linestyle="none", markersize=4.5, label=text
                )
            )
        else:
            edge = ORANGE if colour == _GAINED else BLUE
            result.append(
                Patch(facecolor=colour, edgecolor=edge, hatch=look, linewidth=0.6, label=text)
            )
    return result
