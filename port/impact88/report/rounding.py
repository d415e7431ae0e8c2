"""The one rule of rounding: how many digits of a number a person reads.

A number has four significant digits of the largest number of its group, which is all numbers of an
answer in one unit; ratios, percentages and angles have decimals of their own. A number with an
interval has two significant digits of half the interval's width (GUM 7.2.6)."""

from __future__ import annotations

import math
from collections.abc import Iterable

from ..names import ANGLE, NUMBER, PERCENT

SIGNIFICANT = 4  # digits: a speed to 0.01 mph, an energy to 0.1 %
OF_INTERVAL = 2  # digits of a half width (GUM 7.2.6)
EXTRA = 2  # decimals that a narrow interval may add
DECIMALS = {NUMBER: 3, PERCENT: 2, ANGLE: 1, "bits": 0}
"""Decimals of quantities that have no group."""
MAX_PLAIN = 1e9  # from here on with an exponent
MAX_DECIMALS = 9  # smaller numbers are written with an exponent


def decimals_of(number: float, digits: int = SIGNIFICANT) -> int:
    """Return the decimals that show ``digits`` significant digits of a number.

    Negative for large numbers: -2 rounds to hundreds.

    Examples
    --------
    >>> decimals_of(36.53), decimals_of(123456.0)
    (2, -2)
    """
    return digits - 1 - math.floor(math.log10(abs(number))) if number else 0


def decimals_in(rule: str, group: Iterable[float], width: float = 0.0) -> int:
    """Return the decimals of a number.

    Parameters
    ----------
    rule : str
        The rule of its unit (`impact88.names`).
    group : iterable of float
        The numbers with that rule.
    width : float, default 0
        Width of its interval.

    Examples
    --------
    >>> decimals_in("length/time", [36.53, -0.02]), decimals_in("length/time", [36.53], 6.6)
    (2, 1)
    """
    largest = max((abs(x) for x in group if math.isfinite(x)), default=0.0)
    decimals = DECIMALS.get(rule, decimals_of(largest))
    return min(decimals_of(width / 2, OF_INTERVAL), decimals + EXTRA) if width else decimals


def round_number(value: float, decimals: int) -> str:
    """Return a number with a number of decimals, as everywhere: without -0, "" for NaN.

    Examples
    --------
    >>> round_number(-0.001, 2), round_number(123456.0, -2), round_number(2.5e-12, 15)
    ('0.00', '123500', '2.500e-12')
    """
    if math.isnan(value):
        return ""
    if abs(value) >= MAX_PLAIN or (value and decimals > MAX_DECIMALS):
        return f"{value:.{SIGNIFICANT - 1}e}"
    return f"{round(value, decimals):z.{max(0, min(decimals, MAX_DECIMALS))}f}"
