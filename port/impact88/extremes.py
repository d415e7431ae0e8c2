"""The lowest and highest values several functions take over a box.

The functions come as one array function on the unit cube, all evaluated together. The search needs
no derivatives and survives jumps (line 400's sign of MU makes results jump) and points without a
value (nan). It starts from the corners, all of them while there are few, from points on faces and
in the interior, and climbs from the best of them, each coordinate by itself and along random
directions, halving the step when nothing improves.

What it returns is attained: the true extremes lie no closer. It is no proof that none lies farther.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

CORNERS_IN_FULL = 12
"""Up to this many coordinates all corners are evaluated; beyond, `SCATTERED` of them at random."""
SCATTERED = 4096
"""Points on faces, and in the interior, that are tried before climbing."""
STARTS = 4
"""Points climbed from, per extreme."""
FIRST_STEP = 0.25
LAST_STEP = 1e-8
"""Of the cube's edge."""
ROUNDS = 300
"""At most so many rounds of climbing."""


@dataclass(frozen=True)
class Extremes:
    """For m functions of k coordinates: ``lower`` and ``upper`` (m); ``at_lower`` and ``at_upper``
    (m, k), points of the unit cube; ``corner_lower`` and ``corner_upper`` (m), over the corners
    evaluated; ``evaluations``, points at which the functions were taken.

    A function without any finite value has nan everywhere.
    """

    lower: Array
    upper: Array
    at_lower: Array
    at_upper: Array
    corner_lower: Array
    corner_upper: Array
    evaluations: int


def extremes(
    function: Callable[[Array], Array], coordinates: int, rng: np.random.Generator
) -> Extremes:
    """Seek the extremes of ``function``, (n, k) points of the unit cube -> (n, m) values."""
    corners = _corners(coordinates, rng)
    interior = _spread_out(coordinates, rng)
    faces = np.where(
        rng.random(interior.shape) < 0.5, np.round(rng.random(interior.shape)), interior
    )
    points = np.concatenate([corners, interior, faces, np.full((1, coordinates), 0.5)])
    values = function(points)
    evaluations = len(points)
    functions = values.shape[1]
    # one row per extreme sought: the function's number and +1 to climb it, -1 to climb down
    number = np.tile(np.arange(functions), 2)
    sense = np.repeat([-1.0, 1.0], functions)
    height = _finite(values[:, number] * sense)
    corner_best = height[: len(corners)].max(axis=0)
    starts = np.argsort(-height, axis=0, kind="stable")[:STARTS]
    place = points[starts].reshape(starts.size, coordinates)
    best = np.take_along_axis(height, starts, axis=0).reshape(-1)
    climbers = (np.tile(number, len(starts)), np.tile(sense, len(starts)))
    place, best, steps = _climb(function, place, best, *climbers, rng)
    evaluations += steps
    heights = best.reshape(len(starts), -1)
    winner = heights.argmax(axis=0)
    every = np.arange(2 * functions)
    highest = heights[winner, every]
    reached = np.where(np.isneginf(highest), np.nan, highest) * sense
    at: Array = place.reshape(*starts.shape, coordinates)[winner, every]
    at_corner = np.where(np.isneginf(corner_best), np.nan, corner_best) * sense
    return Extremes(
        lower=reached[:functions],
        upper=reached[functions:],
        at_lower=at[:functions],
        at_upper=at[functions:],
        corner_lower=at_corner[:functions],
        corner_upper=at_corner[functions:],
        evaluations=evaluations,
    )


def _corners(coordinates: int, rng: np.random.Generator) -> Array:
    if coordinates <= CORNERS_IN_FULL:
        corners = list(product((0.0, 1.0), repeat=coordinates))
        return np.array(corners).reshape(2**coordinates, coordinates)
    return np.round(rng.random((SCATTERED, coordinates)))


def _spread_out(coordinates: int, rng: np.random.Generator) -> Array:
    """A Latin hypercube: each coordinate visits every one of its SCATTERED strata once."""
    strata = rng.permuted(np.tile(np.arange(SCATTERED), (coordinates, 1)), axis=1).T
    return (strata + rng.random(strata.shape)) / SCATTERED


def _finite(height: Array) -> Array:
    return np.where(np.isfinite(height), height, -np.inf)


def _climb(
    function: Callable[[Array], Array],
    place: Array,
    best: Array,
    number: NDArray[np.intp],
    sense: Array,
    rng: np.random.Generator,
) -> tuple[Array, Array, int]:
    """Climb with all the climbers (c of them) at once until each has the last step behind it."""
    coordinates = place.shape[1]
    place, best = place.copy(), best.copy()
    step = np.full(len(place), FIRST_STEP)
    taken = 0
    axes = np.concatenate([np.eye(coordinates), -np.eye(coordinates)])
    for _ in range(ROUNDS):
        active = np.flatnonzero(step >= LAST_STEP) if coordinates else np.empty(0, np.intp)
        if not len(active):
            break
        slanting = rng.standard_normal((len(active), coordinates, coordinates))
        slanting /= np.sqrt(np.square(slanting).sum(axis=2, keepdims=True))
        moves = np.concatenate(
            [np.broadcast_to(axes, (len(active), *axes.shape)), slanting], axis=1
        )
        tried = place[active, None] + step[active, None, None] * moves
        np.clip(tried, 0.0, 1.0, out=tried)
        values = function(tried.reshape(-1, coordinates))
        taken += len(values)
        height = _finite(
            values.reshape(len(active), moves.shape[1], -1)[
                np.arange(len(active)), :, number[active]
            ]
            * sense[active, None]
        )
        choice = height.argmax(axis=1)
        reached = height[np.arange(len(active)), choice]
        better = reached > best[active]
        up = active[better]
        place[up] = tried[better, choice[better]]
        best[up] = reached[better]
        step[up] = np.minimum(2 * step[up], FIRST_STEP)
        step[active[~better]] /= 4
    return place, best, taken
