"""The one rule of rounding: how many digits of a number a person reads.

A number has four significant digits of the largest number of its group, which is all numbers of an
answer in one unit; ratios, percentages and angles are rounded on their own. A number with an
interval has two significant digits of half the interval's width (GUM 7.2.6)."""

from __future__ import annotations

import math
from collections.abc import Iterable

from ..names import ANGLE, NUMBER, PERCENT

SIGNIFICANT = 4  # digits: a speed to 0.01 mph, an energy to 0.1 %
OF_INTERVAL = 2  # digits of a half width (GUM 7.2.6)
EXTRA = 2  # decimals that a narrow interval may add to those of the group
MOST_DECIMALS = {NUMBER: 3, PERCENT: 2, ANGLE: 1}
"""Decimals of quantities that are rounded on their own, at most."""
MAX_PLAIN = 1e9  # from here on with an exponent
MAX_DECIMALS = 9  # smaller numbers are written with an exponent


def decimals_of(numbers: Iterable[float], digits: int = SIGNIFICANT) -> int:
    """Return the decimals that show ``digits`` significant digits of the largest number.

    Negative for large numbers: -2 rounds to hundreds.

    Examples
    --------
    >>> decimals_of([36.53, -0.02]), decimals_of([123456.0])
    (2, -2)
    """
    largest = max((abs(x) for x in numbers if math.isfinite(x)), default=0.0)
    if not largest:
        return 0
    return digits - 1 - math.floor(math.log10(largest))


def own_decimals(rule: str, value: float) -> int | None:
    """Return the decimals of a ratio, percentage or angle; None for a quantity of a group."""
    most = MOST_DECIMALS.get(rule)
    return None if most is None else min(most, max(0, decimals_of([value])) if value else most)


def decimals_with(interval: tuple[float, float], decimals: int) -> int:
    """Return the decimals of a number with an interval; ``decimals`` are those without."""
    half = (interval[1] - interval[0]) / 2
    if not half or not math.isfinite(half):
        return decimals
    return min(decimals_of([half], OF_INTERVAL), decimals + EXTRA)


def rounded(value: float, decimals: int) -> str:
    """Return a number with a number of decimals, as everywhere: without -0, "" for NaN.

    Examples
    --------
    >>> rounded(-0.001, 2), rounded(123456.0, -2), rounded(2.5e-12, 15)
    ('0.00', '123500', '2.500e-12')
    """
    if math.isnan(value):
        return ""
    if not math.isfinite(value):
        return str(value)
    if abs(value) >= MAX_PLAIN or decimals > MAX_DECIMALS:
        return f"{value:.{SIGNIFICANT - 1}e}" if value else "0"
    text = f"{round(value, decimals):.{max(0, decimals)}f}"
    return text.removeprefix("-") if float(text) == 0 else text
