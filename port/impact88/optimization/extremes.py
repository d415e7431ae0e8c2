"""The lowest and highest values several functions take over a box.

The functions come as one array function on the unit cube, smooth where they count: a `Piece`. What
jumps (line 400's sign of MU makes results jump) is searched piece by piece, the margin that says
where each counts a wall. The search climbs (`ascent`) from the best of corners, points on faces and
in the interior. Where a denominator changes its sign inside, the functions it divides may go to
infinity: looked for on both sides of its zero.

What it returns is attained (or, at a surface that belongs to the other piece, approached). It is no
proof that no value lies farther.
"""

from collections.abc import Callable, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .ascent import OUTSIDE, below_all, extremes_of, spread_out

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

# chosen on 26 bounds, doubled there: where nothing is said, no bound moves by 1e-4 of its range
CORNERS_IN_FULL = 12
"""Up to this many coordinates all corners are evaluated; beyond, `SCATTERED` of them at random."""
SCATTERED = 4096
"""Points on faces, and in the interior, that are tried before climbing: with twice as many a bound
beside excluded scenes lies .002 of its range farther."""
STARTS = 3
"""Points climbed from, per extreme, among the corners, the interior and the faces each."""
DIFFERENCE = 1e-5
"""Half the distance a slope is taken over."""
LEAST_GAIN = 1e-10
"""Of a function's range over the points tried: a gain not worth a step."""
HALVES = 34
"""Times a distance is halved to find a zero: well below the distances beside it; 17 do as well."""
BESIDE_POLE, POLE_GROWTH = (1e-4, 1e-6), 30.0
"""Where functions are taken beside a denominator's zero, of the distance between two points on
either side of it: a pole makes them a hundred times as large at the second as at the first. Growths
from 3 to 60 find the same poles."""
STEPS, STEPS_AT_ONCE = 0.25 * 0.85 ** np.arange(80), 32
"""Lengths of random steps, and how many of each: as many more or fewer move a bound beside excluded
scenes by .005 of its range, either way."""
POLE_PAIRS = 64
"""Pairs of points between which a denominator's zeros are looked for."""


_SENSE = np.array([[-1.0], [1.0]])
"""Of the lowest and the highest."""


class Extremes(NamedTuple):
    """Of m functions of k coordinates: ``bound``, 2 x m, infinite where a pole lies inside, nan
    where no value is finite; ``at``, 2 x m x k, points of the unit cube, at a pole one close to it;
    ``corner``, 2 x m, over the corners evaluated; ``evaluations``, points looked at."""

    bound: Array
    at: Array
    corner: Array
    evaluations: int


def merged(pieces: Sequence[Extremes]) -> Extremes:
    """The extremes over several pieces together."""
    bound, at, corner = (np.stack([piece[i] for piece in pieces]) for i in range(3))
    which = np.where(np.isnan(bound), -np.inf, _SENSE * bound).argmax(axis=0)
    side, function = np.indices(which.shape)
    corners = _SENSE * np.fmax.reduce(_SENSE * corner)
    taken = sum(piece.evaluations for piece in pieces)
    return Extremes(bound[which, side, function], at[which, side, function], corners, taken)


class Piece:
    """m functions of k coordinates, smooth where they count: what `ascent` climbs.

    ``function``: points of the unit cube, n x k -> n x (m + q): the m functions, ``size`` is m, and
    q denominators, finite and continuous: where one is zero functions may have a pole. ``margin``:
    points -> n, smooth; the functions count where it is not negative (None: everywhere): the only
    wall. ``deepest``: the largest margin seen; ``taken``: points looked at.
    """

    def __init__(
        self,
        function: Callable[[Array], Array],
        size: int,
        margin: Callable[[Array], Array] | None = None,
    ) -> None:
        self.function, self.size, self.margin = function, size, margin
        self.deepest, self.taken = 1.0, 0

    @np.errstate(all="ignore")
    def extremes(
        self, coordinates: int, rng: np.random.Generator, known: Array | None = None
    ) -> Extremes:
        """Seek the extremes of the functions. ``known``: further points to start from, n x k."""
        if coordinates <= CORNERS_IN_FULL:
            corners = np.array([*product((0.0, 1.0), repeat=coordinates)])
        else:
            corners = np.round(rng.random((SCATTERED, coordinates)))
        interior = spread_out(coordinates, SCATTERED, rng)
        on_faces = rng.random(interior.shape) < 0.5
        faces = np.where(on_faces, np.round(rng.random(interior.shape)), interior)
        middle = np.full((1, coordinates), 0.5)
        others = middle if known is None else np.concatenate([middle, known])
        points = np.concatenate(groups := [corners, interior, faces, others])
        if self.margin is not None:
            self.deepest = float(np.abs(self.margin(points)).max())
        values = self.values(points)
        ends = np.cumsum([len(group) for group in groups])
        bound, at, _ = extremes_of(
            *(self, points, values, np.split(np.arange(len(points)), ends[:-1]), STARTS),
            *(LEAST_GAIN, lambda begin: np.empty((0, len(begin)))),
        )
        lacking = np.isnan(values[:, : self.size]).any(axis=1)
        if self.margin is not None:
            lacking &= self.margin(points) >= 0
        if lacking.any() and coordinates:
            at, bound = self.stepped(at, bound, rng)
        corner = _SENSE * below_all(_SENSE[:, :, None] * values[: len(corners)].T).max(axis=2)
        corner[np.isinf(corner)] = np.nan
        finite = np.isfinite(values[:, self.size :]).all(axis=1)
        if finite.any():
            pairs = points[finite][rng.integers(finite.sum(), size=(2, POLE_PAIRS))]
            for j in range(self.size, values.shape[1]):
                self.seek_poles(j, bound, at, np.concatenate([pairs, at[:, j, None]], axis=1))
        size = self.size
        return Extremes(bound[:, :size], at[:, :size], corner[:, :size], self.taken)

    def values(self, points: Array) -> Array:
        """The functions, nan outside the piece."""
        values = self.function(points)
        self.taken += len(points)
        if self.margin is not None:
            values = np.where(self.margin(points)[:, None] >= 0, values, np.nan)
        return values

    def walls(self, points: Array) -> Array:
        """From 0 to 1 inside; what `ascent` takes for touching it is inside, too."""
        if self.margin is None:
            return np.empty((len(points), 0))
        shares = self.margin(points)[:, None] / (4 * self.deepest or 1.0)
        return np.where(np.isnan(shares), -1.0, shares - 2 * OUTSIDE)

    def at(self, u: Array, guess: Array) -> tuple[Array, Array, Array, Flags]:
        """`ascent.Landscape`; there are no states."""
        values = self.values(u)
        values = np.where(np.isfinite(values), values, np.nan)
        return guess, values, self.walls(u), np.ones(len(u), bool)

    def slopes(self, u: Array, x: Array) -> tuple[Array, Array, Array]:
        """`ascent.Landscape`: by central differences, one-sided at the cube's faces."""
        n, k = u.shape
        aside = DIFFERENCE * np.eye(k)
        ahead, behind = (
            np.clip(u[:, None] + side * aside, 0.0, 1.0).reshape(n * k, k) for side in (1, -1)
        )
        distance = (ahead - behind).reshape(n, k, k).diagonal(axis1=1, axis2=2)
        self.taken += 2 * n * k
        functions, walls = (
            np.nan_to_num((f(ahead) - f(behind)).reshape(n, k, -1) / distance[:, :, None])
            for f in (self.function, self.walls)
        )
        return functions.swapaxes(1, 2), walls.swapaxes(1, 2), np.empty((n, 0, k))

    def stepped(self, at: Array, bound: Array, rng: np.random.Generator) -> tuple[Array, Array]:
        """Where functions have no value at some points slopes say nothing of the edge they end at:
        points better than ``at``, by random steps, shorter and shorter."""
        shape, count = at.shape, at.shape[1]
        at, highest = at.reshape(2 * count, -1).copy(), (_SENSE * bound).ravel()
        every = np.arange(2 * count)
        for length in STEPS:
            aside = length * rng.standard_normal((len(at), STEPS_AT_ONCE, at.shape[1]))
            tried = np.clip(at[:, None] + aside, 0.0, 1.0)
            values = self.values(tried.reshape(-1, at.shape[1])).reshape(*tried.shape[:2], -1)
            own = values[every, :, every % count] * np.where(every < count, -1.0, 1.0)[:, None]
            height = below_all(own)
            choice = height.argmax(axis=1)
            better = height[every, choice] > below_all(highest)
            at = np.where(better[:, None], tried[every, choice], at)
            highest = np.where(better, height[every, choice], highest)
        return at.reshape(shape), _SENSE * highest.reshape(2, count)

    def seek_poles(self, j: int, bound: Array, at: Array, pairs: Array) -> None:
        """Look for zeros of denominator ``j`` between ``pairs`` of points, take the functions on
        either side of them, and note in ``bound`` and ``at`` those that a pole makes infinite.
        Zeros outside the piece are none."""
        first, last = (np.sign(self.function(points)[:, j]) for points in pairs)
        low, high = ends = pairs[:, first * last < 0]
        first, apart = first[first * last < 0], ends[1] - ends[0]
        for _ in range(HALVES if len(low) else 0):
            half = 0.5 * (low + high)
            same = (np.sign(self.function(half)[:, j]) == first)[:, None]
            low, high = np.where(same, half, low), np.where(same, high, half)
        if self.margin is not None and len(low):
            counts = self.margin(low) >= 0
            low, apart = low[counts], apart[counts]
        for side in (-1, 1) if len(low) else ():
            places = [low + away * side * apart for away in BESIDE_POLE]
            far, near = (self.function(points)[:, : self.size] for points in places)
            growing = (np.abs(near) > POLE_GROWTH * np.abs(far)) & (np.abs(far) > 0)
            for which, sign in enumerate((-1, 1)):
                endless = growing & (near * sign > 0)
                for function in np.flatnonzero(endless.any(axis=0)).tolist():
                    bound[which, function] = sign * np.inf
                    at[which, function] = places[1][endless[:, function].argmax()]
