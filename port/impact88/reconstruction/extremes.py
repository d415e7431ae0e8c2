"""Extremes of functions over a box, by differential evolution (Storn and Price 1997).

A population seeded with corners, faces and points inside (or with draws) improves by differences of
its own points. Steps beyond the box end on its faces, so that corners are reached exactly. Each
extreme is attained; that no value lies farther is likely, not proven.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.random import Generator

from .impacts import Array

POPULATION = 48
GENERATIONS = 120
FACTOR = (0.3, 0.9)  # of a difference, from and to (Storn and Price 1997)
CROSSOVER = 0.9
SEEDS = 6000  # points of a box that a population starts from


def extremes(
    function: Callable[[Array], Array],
    seeds: Array,
    box: tuple[Array, Array],
    rng: Generator,
) -> Array:
    """Return the least and the greatest values of several outputs.

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

    Returns
    -------
    ndarray
        Shape (2, outputs): least and greatest values.
    """

    def heights_of(points: Array) -> Array:
        table = function(points)
        return np.asarray(np.nan_to_num(np.concatenate([-table, table], 1), nan=-np.inf))

    table = heights_of(seeds).T  # one population for each output and sense
    order = np.argsort(-table, axis=1)[:, :POPULATION]
    points, heights = seeds[order], np.take_along_axis(table, order, 1)
    m, n, d = points.shape
    rows, columns = np.arange(m)[:, None], np.arange(n)
    for _ in range(GENERATIONS):
        first, second = rng.integers(0, n, (2, m, n))
        factor = rng.uniform(*FACTOR, (m, n, 1))
        mutant = points + factor * (
            points[:, :1] - points + points[rows, first] - points[rows, second]
        )
        trial = np.clip(np.where(rng.random((m, n, d)) < CROSSOVER, mutant, points), *box)
        new = heights_of(trial.reshape(m * n, d)).reshape(m, n, m)[rows, columns, rows]
        is_better = new > heights
        points[is_better], heights[is_better] = trial[is_better], new[is_better]
        order = np.argsort(-heights, axis=1, kind="stable")
        points, heights = points[rows, order], np.take_along_axis(heights, order, 1)
    return heights[:, 0].reshape(2, m // 2) * [[-1.0], [1.0]]


def box_seeds(low: Array, high: Array, rng: Generator) -> Array:
    """Return random corners, points on faces and points inside of a box."""
    unit = rng.random((SEEDS, len(low)))
    share = rng.random((SEEDS, 1))  # of coordinates at an end: none inside, all at corners
    unit = np.where(rng.random(unit.shape) < share, np.round(unit), unit)
    return np.where(unit < 1, low + unit * (high - low), high)
