"""Numbers of a table, and the digits that they are written with."""

import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from .evaluation import Floats

FULL_PRECISION = 15  # digits from which a column is taken for doubles written in full
MAX_CELLS = 2000  # of a column, in which its digits are counted
_NUMBER = re.compile(r"[-+]?(\d*)\.?(\d*)(?:[eEdD]([-+]?\d+))?")


def number(text: Any) -> float:
    """Return a cell's number, NaN if it has none."""
    try:
        return float(text)
    except (TypeError, ValueError):
        return np.nan


def numbers(column: Any) -> Floats:
    """Return a column of texts or numbers as doubles; NaN where a cell has none."""
    array = np.asarray(column)
    if array.dtype.kind in "fiu":
        return array.astype(np.float64)
    try:
        return array.astype(np.float64)
    except (TypeError, ValueError):
        return np.array([number(cell) for cell in array.tolist()], np.float64)


def _digits(text: str) -> tuple[int, int] | None:
    """Return the decimals and the significant digits of a number that is not 0."""
    match = _NUMBER.fullmatch(text.strip())
    if not match:
        return None
    whole, fraction, exponent = match.groups()
    digits = (whole + fraction).lstrip("0")
    if not digits:
        return None
    return len(fraction) - int(exponent or 0), len(digits)


def digits_written(column: Any) -> tuple[int, int] | None:
    """Return the most decimals and significant digits of a column; None if all numbers are 0."""
    cells = np.asarray(column)
    cells = cells[np.linspace(0, cells.size - 1, min(MAX_CELLS, cells.size)).astype(int)]
    digits = [d for d in map(_digits, map(str, cells.tolist())) if d]
    if not digits:
        return None
    return max(decimals for decimals, _ in digits), max(count for _, count in digits)


def units(columns: Mapping[str, Any]) -> dict[str, Floats]:
    """Return one unit of the last digit that each number is written with.

    Notes
    -----
    A format has a fixed number of decimals or of digits, and trailing zeros may be cut: what counts
    is the longest number of a column. A column of zeros has the digits of the longest column. From
    `FULL_PRECISION` digits on the unit is 0.
    """
    counts = {name: d for name, c in columns.items() if (d := digits_written(c)) is not None}
    longest = max((s for _, s in counts.values()), default=FULL_PRECISION)
    decimals = max((d for d, _ in counts.values()), default=FULL_PRECISION)
    result = {}
    for name, column in columns.items():
        values = np.abs(numbers(column))
        places, significant = counts.get(name, (decimals, longest))
        if significant >= FULL_PRECISION:
            result[name] = np.zeros(values.size)
            continue
        with np.errstate(all="ignore"):
            exponents = np.floor(np.log10(values))
            exponents = np.where(np.isfinite(exponents), exponents, -np.inf)
            result[name] = np.fmax(10.0**-places, 10.0 ** (exponents - significant + 1))
    return result
