"""The benchmark's numbers as tables for people (and for the README)."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ..plaintable import table
from .measure import Measured
from .populations import POPULATIONS

BUSY = 0.5
"""Load of other work from which times are not to be trusted."""


def _rate(per_second: float) -> str:
    """Scenes per second to two significant digits."""
    if per_second >= 1e6:
        return f"{per_second / 1e6:.2g} M" if per_second < 99.5e6 else f"{per_second / 1e6:.0f} M"
    digits = max(0, math.floor(math.log10(per_second)) - 1)
    return f"{round(per_second, -digits):,.0f}"


def _error(value: float) -> str:
    return "0" if value == 0 else f"{value:.1e}".replace("e-0", "e-").replace("e+0", "e+")


def _times(value: float) -> str:
    return f"{value:.1f}" if value < 99.5 else _error(value)


def _share(value: float) -> str:
    return f"{100 * value:.0f} %"


def _whole(value: float) -> str:
    return f"{value:,.0f}"


COLUMNS: dict[str, tuple[str, Callable[[Any], str]]] = {
    "name": ("", str),
    "population": ("population", str),
    "result": ("result", str),
    "scenes": ("scenes", _whole),
    "passes": ("passes", _whole),
    "seconds": ("seconds", "{:.6f}".format),
    "processor": ("of processors", "{:.2f}".format),
    "times": ("times the first", "{:.1f}".format),
    "nanoseconds": ("ns/scene", _whole),
    "saved": ("saved", _share),
    "nanoseconds_out": ("with out=", _whole),
    "extra_mib": ("MiB beside the results", "{:.1f}".format),
    "median": ("median", _error),
    "largest": ("largest", _error),
    "over_rounding": ("/rounding", _times),
}
"""Key of a row -> heading and how its values are written."""


def listing(rows: Sequence[Mapping[str, Any]]) -> str:
    """Rows of one kind as a table."""
    keys = list(rows[0])
    lines = [[COLUMNS[key][1](row[key]) for key in keys] for row in rows]
    return "\n".join(table(lines, [COLUMNS[key][0] for key in keys]))


def results(rows: Sequence[Measured]) -> str:
    """One table for each population."""
    parts = []
    for name in dict.fromkeys(row.population for row in rows):
        population = POPULATIONS[name]
        mine = [row for row in rows if row.population == name]
        parts.append(
            f"{name} ({population.level}): {population.meaning}; {mine[0].scenes:,} scenes"
        )
        heading = ["", "scenes/s", "median", "99.9 %", "largest", "/(cond u)", "/(sens u)", "none"]
        lines = []
        for row in mine:
            if row.method == "mpmath":
                lines.append([row.name, _rate(row.per_second), *["reference", "", "", "", "", ""]])
                continue
            errors = [_error(x) for x in (row.median, row.per_mille, row.largest)]
            over = [_times(row.over_condition), _times(row.over_sensitivity)]
            none = f"{row.unanswered:,}" if row.unanswered else ""
            lines.append([row.name, _rate(row.per_second), *errors, *over, none])
        parts.append("\n".join(table(lines, heading)) + "\n")
    parts.append(
        "relative error of the final velocities; cond: condition number of the equilibrated 6x6\n"
        "matrix, sens: sensitivity to the scene's numbers, u: unit roundoff (2^-32 for Applesoft,\n"
        "2^-53 for double), each for the worst scene; none: scenes without an answer"
    )
    return "\n".join(parts)


def components(rows: Sequence[Mapping[str, Any]]) -> str:
    """The closed form's errors, result by result."""
    return (
        "closed form, each result's error relative to itself; /rounding: the largest, relative to\n"
        "what rounding every number of the scene to a double does to the result\n" + listing(rows)
    )


def ratios(rows: Sequence[Measured], roof: float | None = None) -> str:
    """What the closed form's aims are measured by."""
    by = {(row.population, row.method): row for row in rows}
    lines = []
    if ("casework", "closed-form") in by:
        mine = by["casework", "closed-form"]
        for other, what in (
            ("lapack", "times as fast as LAPACK on ready-made matrices"),
            ("lapack-fill", "times as fast as filling the matrices and solving"),
            ("float64", "times as fast as the port in float64"),
            ("applesoft", "times as fast as the Applesoft port"),
            ("closed-form-numpy", "times as fast as by numpy alone"),
        ):
            ratio = by["casework", other].seconds / mine.seconds
            lines.append(f"closed form, one core: {ratio:,.0f} {what}")
        if roof:
            lines.append(
                f"closed form, one core: {mine.seconds / roof:.1f} times what memory alone takes"
            )
        for other, what in (
            ("lapack-fill", "LAPACK's"),
            ("lapack-changes", "LAPACK's with velocity changes for unknowns"),
        ):
            lapack = by["casework", other].largest / mine.largest
            size = f"{lapack:.1f} times smaller" if lapack > 1 else f"{1 / lapack:.1f} times larger"
            lines.append(f"largest error on casework (it depends on the seed): {size} than {what}")
        faster = by["casework", "applesoft"].seconds / by["casework", "replay"].seconds
        lines.append(
            f"replay: {faster:.0f} times as fast as the Applesoft port, bit for bit the same"
        )
    if ("heavy", "closed-form") in by:
        for other, what in (
            ("elimination", "the listing's elimination in double"),
            ("lapack-changes", "LAPACK's with velocity changes for unknowns"),
        ):
            ratio = by["heavy", other].largest / by["heavy", "closed-form"].largest
            lines.append(
                f"largest error on heavy mass ratios: {_error(ratio)} times smaller than {what}"
            )
    return "\n".join(lines)


def machine(told: Mapping[str, Any]) -> str:
    text = (
        f"{told['processor']}, {told['cores']} cores; Python {told['python']}, numpy "
        f"{told['numpy']}, impact88 {told['impact88']} ({told['instructions'] or 'numpy alone'})"
    )
    if told["load"] is not None and told["load"] > BUSY:
        text += f"\nthe machine was busy (load {told['load']}): times are longer than they could be"
    return text
