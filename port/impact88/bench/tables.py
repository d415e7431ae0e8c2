"""The benchmark's numbers as tables for people (and for the README)."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ..messages.plaintable import table
from .measure import Row
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


COLUMNS: dict[str, tuple[str, Callable[[Any], str]]] = {
    "name": ("", str),
    "per_second": ("scenes/s", _rate),
    "median": ("median", _error),
    "percentile_99": ("99 %", _error),
    "largest": ("largest", _error),
    "over_condition": ("/(cond u)", _times),
    "over_sensitivity": ("/(sens u)", _times),
    "unanswered": ("none", lambda count: f"{count:,}" if count else ""),
}
"""Key of a row -> heading and how its values are written."""


def results(rows: Sequence[Row]) -> str:
    """One table for each population."""
    parts = []
    for name in dict.fromkeys(row["population"] for row in rows):
        measured_rows = [{**row, "per_second": 1 / row["seconds"]} for row in rows]
        measured_rows = [row for row in measured_rows if row["population"] == name]
        population = POPULATIONS[name]
        count = measured_rows[0]["scenes"]
        parts.append(f"{name} ({population.level}): {population.meaning}; {count:,} scenes")
        lines = [
            [write(row[key]) if key in row else "" for key, (_, write) in COLUMNS.items()]
            for row in measured_rows
        ]
        parts += [*table(lines, [heading for heading, _ in COLUMNS.values()]), ""]
    parts.append(
        "relative error of the final velocities; cond: COND, sens: sensitivity to the scene's\n"
        "numbers, u: unit roundoff (2^-32 for Applesoft, 2^-53 for double), each for the worst\n"
        "scene; none: scenes without an answer"
    )
    return "\n".join(parts)


def summary(rows: Sequence[Row]) -> str:
    """One line for each method: its time on the first population, its errors on each."""
    names = list(dict.fromkeys(row["population"] for row in rows))
    by = {(row["population"], row["method"]): row for row in rows}
    lines = []
    for row in (row for row in rows if row["population"] == names[0]):
        line = [row["name"], f"{1e9 * row['seconds']:,.3g}", _rate(1 / row["seconds"])]
        for name in names:
            errors = by.get((name, row["method"]), {})
            line += [_error(errors[key]) if key in errors else "" for key in ("median", "largest")]
        lines.append(line)
    heading = ["", "ns/scene", "scenes/s"]
    for name in names:
        heading += [f"{name}: median", "largest"]
    sizes = f"{rows[0]['scenes']:,} scenes of each population"
    caption = f"relative error of the final velocities; {sizes}; times: {names[0]}"
    return "\n".join([caption, *table(lines, heading)])


_RATIOS = (
    ("casework", "seconds", "lapack", "closed-form", "LAPACK on ready-made matrices"),
    ("casework", "seconds", "lapack-fill", "closed-form", "filling the matrices and solving"),
    ("casework", "seconds", "float64", "closed-form", "the port in float64"),
    ("casework", "seconds", "applesoft", "closed-form", "the Applesoft port"),
    ("casework", "seconds", "closed-form-numpy", "closed-form", "by numpy alone"),
    ("casework", "seconds", "closed-form", "closed-form-2", "one core"),
    ("casework", "seconds", "plain", "closed-form", "plain C, -O3"),
    ("casework", "seconds", "plain-fast", "closed-form", "plain C, -ffast-math"),
    ("casework", "seconds", "applesoft", "replay", "the Applesoft port, bit for bit the same"),
    ("casework", "largest", "lapack-fill", "closed-form", "LAPACK (it depends on the seed)"),
    ("heavy", "largest", "elimination", "closed-form", "the listing's elimination in double"),
    ("heavy", "largest", "lapack-changes", "closed-form", "LAPACK with velocity changes"),
)
"""Population, what is compared, of which method, with which, and the words for it."""


def ratios(rows: Sequence[Row]) -> str:
    """Return the ratios that the aims are stated in: times, and largest errors on a population."""
    by = {(row["population"], row["method"]): row for row in rows}
    lines = []
    for population, key, other, mine, words in _RATIOS:
        if (population, mine) in by and (population, other) in by:
            ratio = by[population, other][key] / by[population, mine][key]
            how = "times as fast as" if key == "seconds" else "times more accurate than"
            name = by[population, mine]["name"]
            lines.append(f"{name}, {population}: {_times(ratio)} {how} {words}")
    if ("casework", "closed-form") in by:
        row = by["casework", "closed-form"]
        ratio = row["seconds"] / row["memory"]
        lines.append(f"closed form, one core: {ratio:.1f} times what memory alone takes")
    return "\n".join(lines)


def machine(row: Mapping[str, Any]) -> str:
    text = (
        f"{row['processor']}, {row['cores']} cores; Python {row['python']}, numpy "
        f"{row['numpy']}, impact88 {row['impact88']} ({row['instructions'] or 'numpy alone'})"
    )
    if row["plain_c"]:
        text += f"\nplain C: {row['plain_c']}, " + " and ".join(row["plain_c_flags"])
        text += "\nmemory alone: a loop in plain C that reads 20 columns and writes six"
    else:
        text += "\nplain C is left out: there is no C compiler (cc, gcc, clang)"
    if row["load"] is not None and row["load"] > BUSY:
        text += f"\nthe machine was busy (load {row['load']}): times are longer than they could be"
    return text
