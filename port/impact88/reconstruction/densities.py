"""Probability densities of amounts: random draws, log densities, Gaussian copula."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from statistics import NormalDist

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from ..cases.amounts import Amount
from ..errors import UserError

Array = NDArray[np.float64]

TABLE_END = 8.3  # standard normal variates beyond occur once in 1e16
ROUNDING = 1e-12  # width of an interval of which only rounding varies, relative to its ends
TABLE_SIZE = 8193  # values of a table: quantiles to 1e-7 of the width


def log_density(amount: Amount, values: Array) -> Array:
    """Return the log density at values within the limits, up to a constant."""
    off = values - amount.value
    if amount.kind == "normal":
        return -0.5 * np.square(off / amount.sd)
    if amount.kind != "triangular":
        return np.zeros(np.shape(values))
    side = np.where(off > 0, amount.high - amount.value, amount.value - amount.low)
    with np.errstate(divide="ignore"):
        return np.log(np.clip(1.0 - np.abs(off) / np.maximum(side, 1e-300), 0.0, 1.0))


def draw(amount: Amount, count: int, rng: Generator) -> Array:
    """Return independent random values."""
    if amount.kind == "uniform":
        return rng.uniform(amount.low, amount.high, count)
    return from_normal(amount, rng.standard_normal(count))


def from_normal(amount: Amount, variates: Array) -> Array:
    """Return the values at the quantiles of standard normal variates (interpolated in a table)."""
    if -amount.low == amount.high == math.inf:
        return amount.value + amount.sd * variates
    return np.clip(np.interp(variates, *_quantile_table(amount)), amount.low, amount.high)


@lru_cache(maxsize=64)
def _quantile_table(amount: Amount) -> tuple[Array, Array]:
    """Return standard normal variates and the values at the same quantiles."""
    variates, standard = np.linspace(-TABLE_END, TABLE_END, TABLE_SIZE), NormalDist()
    shares = [standard.cdf(variate) for variate in variates.tolist()]
    values = np.linspace(*amount.limits(TABLE_END), TABLE_SIZE)
    density = np.exp(log_density(amount, values))
    sums = np.cumsum(density[1:] + density[:-1])  # trapezoidal rule
    return variates, np.interp(shares, [0.0, *(sums / sums[-1])], values)


def sampling_error(column: Array, ends: tuple[float, float], family: NDArray[np.int64]) -> float:
    """Return the larger Monte Carlo standard error of the ends of an interval of draws, relative to
    its width.

    It follows from the scatter of the families of draws (Lee and Whiteley 2018); of draws that are
    independent, each a family, it is the binomial one."""
    width = ends[1] - ends[0]
    if width <= ROUNDING * max(map(abs, ends)):
        return 0.0
    is_below = column < np.array(ends)[:, None]
    shares = is_below.mean(1)
    off = [np.bincount(family, part - share) for part, share in zip(is_below, shares, strict=True)]
    errors = np.sqrt(np.square(off).sum(1)) / len(column)
    low, high = np.quantile(column, np.clip([shares - errors, shares + errors], 0.0, 1.0))
    return float((high - low).max() / 2 / width)


def draw_correlated(
    amounts: Mapping[str, Amount],
    count: int,
    rng: Generator,
    correlations: Mapping[tuple[str, str], float],
) -> Array:
    """Return random values (rows), correlated through a Gaussian copula.

    Raises
    ------
    UserError
        For an unknown name, and correlations that contradict one another.
    """
    names = list(amounts)
    matrix = np.eye(len(names))
    for (first, second), value in correlations.items():
        if len({first, second} & {*names}) < 2 or not -1.0 <= value <= 1.0:
            raise UserError(
                f"correlation of {first} and {second} is {value}; expected two of the values known "
                f"within limits ({' '.join(names)}) and a number from -1 to 1"
            )
        row, column = names.index(first), names.index(second)
        matrix[row, column] = matrix[column, row] = value
    try:
        normal = rng.multivariate_normal(
            np.zeros(len(names)), matrix, count, "raise", method="eigh"
        )
    except ValueError:
        raise UserError("these correlations contradict one another") from None
    return np.stack(list(map(from_normal, amounts.values(), normal.T)), 1)
