"""Numbers of a table, and the digits that they are written with."""

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .evaluation import Floats

FULL_PRECISION = 15  # digits from which a column is taken for doubles written in full
MAX_CELLS = 2000  # of a column, in which its digits are counted
EMPTY = ("", "nan", "null", "none")
"""Cells without a number."""
_NUMBER = re.compile(r"[-+]?(\d*)\.?(\d*)(?:[eEdD]([-+]?\d+))?")


def spread(values: NDArray[Any], count: int) -> NDArray[Any]:
    """Return evenly spread values of an array, at most a given number."""
    return values.take(np.linspace(0, values.size - 1, min(count, values.size)).astype(int))


def number(text: Any) -> float:
    """Return a cell's number, Fortran's 1D2 too; NaN if it has none."""
    try:
        return float(str(text).upper().replace("D", "E"))
    except ValueError:
        return np.nan


def numbers(column: Any) -> Floats:
    """Return a column of texts or numbers as doubles; NaN where a cell has none."""
    array = np.asarray(column)
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
    cells = spread(np.asarray(column), MAX_CELLS)
    digits = [d for d in map(_digits, map(str, cells.tolist())) if d]
    if not digits:
        return None
    return max(decimals for decimals, _ in digits), max(count for _, count in digits)


def units(columns: Mapping[str, Any]) -> dict[str, Floats]:
    """Return one unit of the last digit that each number is written with.

    Notes
    -----
    A format has a fixed number of decimals or of digits, and trailing zeros may be cut: what counts
    is the longest number of a column. A column of zeros has the decimals of the longest column.
    From `FULL_PRECISION` digits on decimals alone count: 1e12 with three decimals has 16 digits.
    """
    counts = {name: d for name, c in columns.items() if (d := digits_written(c)) is not None}
    longest = max(counts.values(), default=(FULL_PRECISION, FULL_PRECISION))
    result = {}
    for name, column in columns.items():
        values = np.abs(numbers(column))
        places, significant = counts.get(name, longest)
        with np.errstate(all="ignore"):
            exponents = np.floor(np.log10(values))
            exponents = np.where(np.isfinite(exponents), exponents, -np.inf)
            last_digits = 10.0 ** (exponents - significant + 1) * (significant < FULL_PRECISION)
            result[name] = np.fmax(10.0**-places, last_digits)
    return result
