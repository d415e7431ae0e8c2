"""The lowest and highest values several functions take over a box.

The functions come as one array function on the unit cube, all evaluated together. The search needs
no derivatives and survives jumps (line 400's sign of MU makes results jump) and points without a
value (nan). It starts from the corners, all of them while there are few, from points on faces and
in the interior, and climbs from the best of them: along each coordinate, along random directions,
and along the quasi-Newton (BFGS) direction of a gradient by differences, which follows curved
ridges; the best of all of these is taken, and the step reduced when none improves.

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
STARTS = 3
"""Points climbed from, per extreme, among the corners, the interior and the faces each."""
FIRST_STEP = 0.25
LAST_STEP = 1e-7
"""Of the cube's edge."""
DIFFERENCE = 1e-5
"""Half the distance a slope is taken over."""
LENGTHS = 2.0 ** np.arange(2, -11, -1)
"""Of the quasi-Newton step: what is tried of it."""
LEAST_GAIN = 1e-10
"""Of a function's range over the points tried: smaller improvements are no reason to go on."""
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
    first, second = len(corners), len(corners) + len(interior)
    starts = np.concatenate(
        [
            start + np.argsort(-height[start:stop], axis=0, kind="stable")[:STARTS]
            for start, stop in ((0, first), (first, second), (second, len(points)))
        ]
    )
    place = points[starts].reshape(starts.size, coordinates)
    best = np.take_along_axis(height, starts, axis=0).reshape(-1)
    climbers = _Climbers(
        function, np.tile(number, len(starts)), np.tile(sense, len(starts)), _least_gain(values)
    )
    place, best = climbers.climb(place, best, rng)
    evaluations += climbers.taken
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


def _least_gain(values: Array) -> Array:
    """Of each function: the gain not worth another round."""
    finite = np.isfinite(values)
    high = np.where(finite, values, -np.inf).max(axis=0)
    low = np.where(finite, values, np.inf).min(axis=0)
    return LEAST_GAIN * np.where(high > low, high - low, 0.0)


@dataclass
class _Climbers:
    """c points that climb at once, each its own function up (``sense`` +1) or down (-1)."""

    function: Callable[[Array], Array]
    number: NDArray[np.intp]
    sense: Array
    least: Array
    taken: int = 0

    def heights(self, who: NDArray[np.intp], points: Array) -> Array:
        """Points, a x p x k for the climbers ``who`` -> how high each stands, a x p."""
        values = self.function(points.reshape(-1, points.shape[2]))
        self.taken += len(values)
        own = values.reshape(*points.shape[:2], -1)[np.arange(len(who)), :, self.number[who]]
        return _finite(own * self.sense[who, None])

    def climb(self, place: Array, best: Array, rng: np.random.Generator) -> tuple[Array, Array]:
        """Where the climbers end, c x k, and how high."""
        count, size = place.shape
        place, best = place.copy(), best.copy()
        step = np.full(count, FIRST_STEP)
        model = _Curvature(count, size)
        axes = np.concatenate([np.eye(size), -np.eye(size)])
        for _ in range(ROUNDS):
            who = np.flatnonzero(step >= LAST_STEP) if size else np.empty(0, np.intp)
            if not len(who):
                break
            slope = self.gradient(who, place[who])
            along = model.direction(who, place[who], slope, step[who])
            aslant = rng.standard_normal((len(who), size, size))
            aslant /= np.sqrt(np.square(aslant).sum(axis=2, keepdims=True))
            around = np.concatenate(
                [np.broadcast_to(axes, (len(who), *axes.shape)), aslant], axis=1
            )
            moves = np.concatenate(
                [step[who, None, None] * around, LENGTHS[None, :, None] * along[:, None]], axis=1
            )
            tried = np.clip(place[who, None] + moves, 0.0, 1.0)
            height = self.heights(who, tried)
            choice = height.argmax(axis=1)
            reached = height[np.arange(len(who)), choice]
            better = reached > best[who] + self.least[self.number[who]]
            up, stuck = who[better], who[~better]
            place[up] = tried[better, choice[better]]
            best[up] = reached[better]
            step[up] = np.minimum(2 * step[up], FIRST_STEP)
            step[stuck] /= 4
            model.forget(stuck)
        return place, best

    def gradient(self, who: NDArray[np.intp], place: Array) -> Array:
        """Slopes by central differences, one-sided at the cube's faces; 0 where there is none."""
        aside = DIFFERENCE * np.eye(place.shape[1])
        ahead = np.clip(place[:, None] + aside, 0.0, 1.0)
        behind = np.clip(place[:, None] - aside, 0.0, 1.0)
        height = self.heights(who, np.concatenate([ahead, behind], axis=1))
        rise = np.subtract(*np.split(np.where(np.isneginf(height), np.nan, height), 2, axis=1))
        return np.nan_to_num(rise / np.einsum("aii->ai", ahead - behind))


class _Curvature:
    """What each climber has learnt of the curvature: the BFGS inverse Hessian of -height."""

    def __init__(self, count: int, size: int) -> None:
        self.inverse = np.zeros((count, size, size))
        self.known = np.zeros(count, bool)
        self.place = np.full((count, size), np.nan)
        self.slope = np.full((count, size), np.nan)

    def forget(self, who: NDArray[np.intp]) -> None:
        """Start afresh with steepest ascent."""
        self.known[who] = False
        self.place[who] = np.nan

    def direction(self, who: NDArray[np.intp], place: Array, slope: Array, step: Array) -> Array:
        """The move to try: quasi-Newton where known, else a step of steepest ascent; no coordinate
        leaves through a face it stands on."""
        self._learn(who, place, slope)
        free = ~((place <= 0) & (slope < 0) | (place >= 1) & (slope > 0))
        uphill = np.where(free, slope, 0.0)
        size = np.sqrt(np.square(uphill).sum(axis=1, keepdims=True))
        steepest = step[:, None] * uphill / np.where(size > 0, size, 1.0)
        newton = np.where(free, np.einsum("aij,aj->ai", self.inverse[who], uphill), 0.0)
        usable = self.known[who] & ((newton * uphill).sum(axis=1) > 0)
        return np.where(usable[:, None], newton, steepest)

    def _learn(self, who: NDArray[np.intp], place: Array, slope: Array) -> None:
        moved, turned = place - self.place[who], self.slope[who] - slope
        self.place[who], self.slope[who] = place, slope
        # on a face a coordinate takes no part: its slope's change says nothing of the others
        turned = np.where((moved == 0) & ((place <= 0) | (place >= 1)), 0.0, turned)
        product = (moved * turned).sum(axis=1)
        square = np.square(turned).sum(axis=1)
        good = product > 1e-10 * np.sqrt(np.square(moved).sum(axis=1) * square)
        if not good.any():
            return
        who, moved, turned = who[good], moved[good], turned[good]
        product, square = product[good], square[good]
        unit = np.eye(place.shape[1])
        fresh = (product / square)[:, None, None] * unit
        before = np.where(self.known[who, None, None], self.inverse[who], fresh)
        left = unit - np.einsum("ai,aj->aij", moved, turned) / product[:, None, None]
        outer = np.einsum("ai,aj->aij", moved, moved) / product[:, None, None]
        self.inverse[who] = left @ before @ left.transpose(0, 2, 1) + outer
        self.known[who] = True
