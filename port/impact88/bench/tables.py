"""The benchmark's numbers as tables for people (and for the README)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from ..plaintable import table
from .filespeed import Door
from .measure import Measured
from .paths import GENERAL, Floor, Path, Size
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


def ratios(rows: Sequence[Measured]) -> str:
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


def paths(by_kind: Sequence[Path], by_output: Sequence[Path]) -> str:
    """What each short path and each selection of results saves."""
    whole = next(path for path in by_kind if path.name == GENERAL)
    lines = [
        [
            path.name,
            str(path.passes),
            f"{path.nanoseconds:.0f}",
            f"{100 * (1 - path.nanoseconds / whole.nanoseconds):.0f} %",
            "" if path.as_columns is None else f"{path.as_columns:.0f}",
            ""
            if path.as_columns is None
            else f"{100 * (1 - path.as_columns / whole.nanoseconds):.0f} %",
        ]
        for path in by_kind
    ]
    first = table(lines, ["kind of block", "passes", "ns/scene", "saved", "as columns", "saved"])
    everything = by_output[-1]
    lines = [
        [
            path.name,
            str(path.passes),
            f"{path.nanoseconds:.0f}",
            f"{100 * (1 - path.nanoseconds / everything.nanoseconds):.0f} %",
        ]
        for path in by_output
    ]
    second = table(lines, ["results asked for", "passes", "ns/scene", "saved"])
    return "\n".join([*first, "", *second])


def floor(times: Floor) -> str:
    return (
        f"six velocities: {times.solve:.0f} ns a scene on one core; six sines and cosines alone: "
        f"{times.numpy_sines:.0f} ns by numpy,\n{times.own_sines:.0f} ns by closedform.degrees "
        f"({times.solve / times.own_sines:.1f} times that floor)\n"
        f"six velocities of one scene: {times.one_scene / 1e3:.0f} microseconds a call as plain "
        f"numbers, {times.array_of_one / 1e3:.0f} as arrays of one"
    )


def sizes(measured: Sequence[Size]) -> str:
    lines = [
        [
            f"{size.scenes:,}",
            f"{size.seconds:.4f}",
            f"{1e9 * size.seconds / size.scenes:.0f}",
            f"{1e9 * size.seconds_out / size.scenes:.0f}",
            f"{size.extra_bytes / 2**20:.1f}",
        ]
        for size in measured
    ]
    return "\n".join(
        table(lines, ["scenes", "seconds", "ns/scene", "with out=", "MiB beside the results"])
    )


def doors(rows: int, found: Sequence[Door]) -> str:
    """Files beside the computation alone."""
    alone = found[0].seconds
    lines = [
        [d.name, f"{d.seconds:.2f}", f"{d.processor:.2f}", f"{d.seconds / alone:.1f}"]
        for d in found
    ]
    heading = [f"{rows:,} rows, all results", "seconds", "of processors", "times the computation"]
    return "\n".join(table(lines, heading))


def machine(told: dict[str, Any]) -> str:
    text = (
        f"{told['processor']}, {told['cores']} cores; Python {told['python']}, numpy "
        f"{told['numpy']}, impact88 {told['impact88']}"
    )
    if told["load"] is not None and told["load"] > BUSY:
        text += f"\nthe machine was busy (load {told['load']}): times are longer than they could be"
    return text
