"""Extremes of functions over a box, by differential evolution (Storn and Price 1997).

A population seeded with corners, faces and points inside (or with draws) improves by differences of
its own points. Steps beyond the box end on its faces, so that corners are reached exactly. Each
extreme is attained; that no value lies farther is likely, not proven.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np

from .impacts import Array

Function = Callable[[Array], Array]

POPULATION = 48
GENERATIONS = 120
FACTOR = (0.3, 0.9)  # of a difference, from and to (Storn and Price 1997)
CROSSOVER = 0.9
SINGLE = 3  # every third generation changes one coordinate alone
NEAR = 0.02  # standard deviation of such a change, over the width of the box
MAX_CORNERS = 1 << 12


def extremes(
    function: Function,
    seeds: Array,
    box: tuple[Array, Array],
    rng: np.random.Generator,
    generations: int = GENERATIONS,
) -> tuple[Array, Array]:
    """Return the least and the greatest values of several outputs, and where they are.

    Parameters
    ----------
    function : callable
        Takes points (n rows), returns a table of outputs (n rows, one column an output); NaN where
        a point does not count.
    seeds : ndarray
        Points, some of which count.
    box : tuple of ndarray
        Lower and upper ends of each coordinate.
    rng : numpy.random.Generator
        Source of random numbers.
    generations : int
        Number of generations.

    Returns
    -------
    values : ndarray
        Shape (2, outputs): least and greatest values.
    points : ndarray
        Shape (2, outputs, coordinates): where they are attained.
    """
    low, high = box
    table = function(seeds)
    signed = np.concatenate([-table, table], 1)  # one population for each output and sense
    heights = np.nan_to_num(signed, nan=-np.inf).T
    best = np.argsort(-heights, axis=1)[:, :POPULATION]
    points, heights = seeds[best], np.take_along_axis(heights, best, 1)
    m, n, d = points.shape
    own, rows = np.arange(m) % (m // 2), np.arange(m)[:, None]
    sense = np.where(np.arange(m) < m // 2, -1.0, 1.0)[:, None]
    for generation in range(1, generations + 1):
        first, second = rng.integers(0, n, (2, m, n))
        factor = rng.uniform(*FACTOR, (m, n, 1))
        mutant = points + factor * (
            points[:, :1] - points + points[rows, first] - points[rows, second]
        )
        if generation % SINGLE == 0:
            mutant = _one_changed(points.reshape(m * n, d), box, rng).reshape(m, n, d)
        crossed = np.where(rng.random((m, n, d)) < CROSSOVER, mutant, points)
        trial = np.clip(crossed, low, high)
        table = function(trial.reshape(m * n, d)).reshape(m, n, m // 2)
        new = np.nan_to_num(sense * table[rows, np.arange(n), own[:, None]], nan=-np.inf)
        better = new > heights
        points[better], heights[better] = trial[better], new[better]
        order = np.argsort(-heights, axis=1, kind="stable")
        points, heights = points[rows, order], np.take_along_axis(heights, order, 1)
    values = (sense[:, 0] * heights[:, 0]).reshape(2, m // 2)
    return values, points[:, 0].reshape(2, m // 2, d)


def _one_changed(points: Array, box: tuple[Array, Array], rng: np.random.Generator) -> Array:
    """Return points with one coordinate at an end of the box, or near its present value."""
    low, high = box
    n, d = points.shape
    rows, columns = np.arange(n), rng.integers(0, d, n)
    near = points[rows, columns] + rng.normal(0, NEAR, n) * (high - low)[columns]
    changed = points.copy()
    changed[rows, columns] = np.choose(rng.integers(0, 3, n), [low[columns], high[columns], near])
    return changed


def box_seeds(low: Array, high: Array, rng: np.random.Generator, count: int = 2000) -> Array:
    """Return corners (all, or as many at random), points on faces and points inside of a box."""
    d = len(low)
    if 2**d <= MAX_CORNERS:
        corners = np.array(list(product((0.0, 1.0), repeat=d))).reshape(-1, d)
    else:
        corners = rng.integers(0, 2, (MAX_CORNERS, d)).astype(float)
    inside = rng.random((count, d))
    faces = np.where(rng.random((count, d)) < 0.5, np.round(rng.random((count, d))), inside)
    unit = np.concatenate([corners, faces, inside])
    return np.where(unit < 1, low + unit * (high - low), high)
