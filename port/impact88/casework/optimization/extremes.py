"""Extremes of several functions over a box.

The functions come as one array function on the unit cube, smooth within a `Piece`. Where results
jump (line 400 changes the sign of MU), each side of the jump is a piece of its own, bounded by a
margin function that acts as a constraint. The search (`boxsearch`) begins at the best of corners,
points on faces and points in the interior. Where a denominator changes its sign inside the box, the
functions divided by it may have a pole: they are evaluated on both sides of its zero.

Each extreme returned is attained (or, at the boundary of the other piece, approached). It is no
proof that no value lies farther."""

from collections.abc import Callable, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .ascent import CONSTRAINT_TOL, replace_nonfinite
from .boxsearch import Pool, find_extremes

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

# Chosen on 26 bounds. Doubling any of these moves no bound by 1e-4 of its range, unless noted.
MAX_FULL_CORNERS = 12  # up to this many coordinates all 2^k corners are evaluated
# Random points on faces, in the interior (and corners, beyond MAX_FULL_CORNERS). Twice as many
# move a bound beside excluded scenes by .002 of its range.
RANDOM_POINTS = 4096
STARTS = 3  # searches per extreme, from each of corners, interior and faces
DIFFERENCE_STEP = 1e-5  # central differences, half width
BISECTIONS = 34  # to locate a denominator's zero; 17 do as well
# A function is compared at these two distances from a zero, as fractions of the bracket: a pole
# makes it a hundred times as large at the second. Thresholds from 3 to 60 find the same poles.
POLE_DISTANCES = (1e-4, 1e-6)
POLE_GROWTH = 30.0  # least ratio of the two
POLE_PAIRS = 64  # pairs of points between which a denominator's zeros are bracketed
# Random steps beside points without a value. Twice or half as many move a bound beside excluded
# scenes by .005 of its range, either way.
STEP_LENGTHS = 0.25 * 0.85 ** np.arange(80)
STEPS_PER_LENGTH = 32  # from each end

_SENSE = np.array([[-1.0], [1.0]])  # the minimum of f is minus the maximum of -f


class Extremes(NamedTuple):
    """Lowest and highest values of m functions of k coordinates.

    ``bound`` (2 x m): infinite where a pole lies inside, nan where no value is finite. ``at`` (2 x
    m x k): points of the unit cube; for an infinite bound one close to the pole. ``corner`` (2 x
    m): the extremes over the corners evaluated. ``evaluations``: points evaluated."""

    bound: Array
    at: Array
    corner: Array
    evaluations: int


def merge(pieces: Sequence[Extremes]) -> Extremes:
    """Return the extremes over all ``pieces`` together."""
    bound, points_there, corner = (np.stack([piece[i] for piece in pieces]) for i in range(3))
    best = np.where(np.isnan(bound), -np.inf, _SENSE * bound).argmax(axis=0)
    sides, functions = np.indices(best.shape)
    corner = _SENSE * np.fmax.reduce(_SENSE * corner)
    evaluations = sum(piece.evaluations for piece in pieces)
    return Extremes(
        bound[best, sides, functions], points_there[best, sides, functions], corner, evaluations
    )


class Piece:
    """m functions of k coordinates, smooth where they count: an `ascent.SearchProblem`.

    ``function`` maps points of the unit cube (n x k) to n x (m + q) values: the m functions (m is
    ``size``), then q denominators, finite and continuous; where one is zero, functions may have a
    pole. ``margin`` maps points to n smooth values; the functions count where it is not negative
    (None: everywhere). It is the only constraint. ``deepest`` is the largest margin seen, ``taken``
    the number of points evaluated."""

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
        """Search for the extremes of the functions. ``known`` (n x k): further points to start
        from."""
        if coordinates <= MAX_FULL_CORNERS:
            corners = np.array([*product((0.0, 1.0), repeat=coordinates)])
        else:
            corners = np.round(rng.random((RANDOM_POINTS, coordinates)))
        interior = latin_hypercube(coordinates, RANDOM_POINTS, rng)
        on_faces = rng.random(interior.shape) < 0.5
        faces = np.where(on_faces, np.round(rng.random(interior.shape)), interior)
        middle = np.full((1, coordinates), 0.5)
        starts = middle if known is None else np.concatenate([middle, known])
        points = np.concatenate(groups := [corners, interior, faces, starts])
        if self.margin is not None:
            self.deepest = float(np.abs(self.margin(points)).max())
        values = self.values(points)
        ends = np.cumsum([len(group) for group in groups])
        found = find_extremes(
            self,
            Pool(points, np.empty((0, len(points))), values),
            np.split(np.arange(len(points)), ends[:-1]),
            STARTS,
        )
        bounds, points_there = found.values, found.at
        valueless = np.isnan(values[:, : self.size]).any(axis=1)
        if self.margin is not None:
            valueless &= self.margin(points) >= 0
        if valueless.any() and coordinates:
            points_there, bounds = self.step_randomly(points_there, bounds, rng)
        corners_there = _SENSE * replace_nonfinite(
            _SENSE[:, :, None] * values[: len(corners)].T
        ).max(axis=2)
        corners_there[np.isinf(corners_there)] = np.nan
        finite = np.isfinite(values[:, self.size :]).all(axis=1)
        if finite.any():
            pairs = points[finite][rng.integers(finite.sum(), size=(2, POLE_PAIRS))]
            for column in range(self.size, values.shape[1]):
                self.seek_poles(
                    column,
                    bounds,
                    points_there,
                    np.concatenate([pairs, points_there[:, column, None]], axis=1),
                )
        size = self.size
        return Extremes(
            bounds[:, :size], points_there[:, :size], corners_there[:, :size], self.taken
        )

    def values(self, points: Array) -> Array:
        """Return the functions, nan outside the piece."""
        values = self.function(points)
        self.taken += len(points)
        if self.margin is not None:
            values = np.where(self.margin(points)[:, None] >= 0, values, np.nan)
        return values

    def constraints(self, points: Array) -> Array:
        """Return the margin scaled to lie from 0 to 1 inside the piece, shifted by the search's
        tolerance so that points it accepts are inside, and one at the edge is accepted."""
        if self.margin is None:
            return np.empty((len(points), 0))
        fractions = self.margin(points)[:, None] / (4 * self.deepest or 1.0)
        return np.where(np.isnan(fractions), -1.0, fractions - CONSTRAINT_TOL)

    def evaluate(self, u: Array, guess: Array) -> tuple[Array, Array, Array, Flags]:
        """Evaluate points (`ascent.SearchProblem`); there are no states."""
        values = self.function(u)
        self.taken += len(u)
        values = np.where(np.isfinite(values), values, np.nan)
        return guess, values, self.constraints(u), np.ones(len(u), bool)

    def slopes(self, u: Array, x: Array) -> tuple[Array, Array, Array]:
        """Return central differences (`ascent.SearchProblem`), one-sided at the cube's faces."""
        count, dimensions = u.shape
        offsets = DIFFERENCE_STEP * np.eye(dimensions)
        ahead, behind = (
            np.clip(u[:, None] + side * offsets, 0.0, 1.0).reshape(count * dimensions, dimensions)
            for side in (1, -1)
        )
        distance = (
            (ahead - behind).reshape(count, dimensions, dimensions).diagonal(axis1=1, axis2=2)
        )
        self.taken += 2 * count * dimensions
        functions, constraints = (
            np.nan_to_num(
                (evaluate(ahead) - evaluate(behind)).reshape(count, dimensions, -1)
                / distance[:, :, None]
            )
            for evaluate in (self.function, self.constraints)
        )
        return (
            functions.swapaxes(1, 2),
            constraints.swapaxes(1, 2),
            np.empty((count, 0, dimensions)),
        )

    def step_randomly(
        self, points_there: Array, bounds: Array, rng: np.random.Generator
    ) -> tuple[Array, Array]:
        """Return points better than ``points_there`` and their values, found by ever shorter random
        steps.

        At the edge of excluded points, where functions have no value, their slopes say nothing of
        the edge: sequential linear programming stops short of it."""
        shape, count = points_there.shape, points_there.shape[1]
        points_there, highest = (
            points_there.reshape(2 * count, -1).copy(),
            (_SENSE * bounds).ravel(),
        )
        rows = np.arange(2 * count)
        for length in STEP_LENGTHS:
            offsets = length * rng.standard_normal(
                (len(points_there), STEPS_PER_LENGTH, points_there.shape[1])
            )
            trials = np.clip(points_there[:, None] + offsets, 0.0, 1.0)
            function_values = self.values(trials.reshape(-1, points_there.shape[1])).reshape(
                *trials.shape[:2], -1
            )
            objectives = (
                function_values[rows, :, rows % count] * np.where(rows < count, -1.0, 1.0)[:, None]
            )
            values = replace_nonfinite(objectives)
            best = values.argmax(axis=1)
            better = values[rows, best] > replace_nonfinite(highest)
            points_there = np.where(better[:, None], trials[rows, best], points_there)
            highest = np.where(better, values[rows, best], highest)
        return points_there.reshape(shape), _SENSE * highest.reshape(2, count)

    def seek_poles(
        self, denominator: int, bounds: Array, points_there: Array, pairs: Array
    ) -> None:
        """Make infinite, in ``bounds``, those functions that have a pole where a denominator is
        zero.

        Zeros of column ``denominator`` are bracketed between ``pairs`` of points and bisected;
        functions that grow towards a zero have a pole there. ``points_there`` receives a point
        beside it. Zeros outside the piece do not count."""
        signs, end_signs = (np.sign(self.function(points)[:, denominator]) for points in pairs)
        low, high = ends = pairs[:, signs * end_signs < 0]
        signs, separation = signs[signs * end_signs < 0], ends[1] - ends[0]
        for _ in range(BISECTIONS if len(low) else 0):
            middle = 0.5 * (low + high)
            unchanged = (np.sign(self.function(middle)[:, denominator]) == signs)[:, None]
            low, high = np.where(unchanged, middle, low), np.where(unchanged, high, middle)
        if self.margin is not None and len(low):
            inside = self.margin(low) >= 0
            low, separation = low[inside], separation[inside]
        for side in (-1, 1) if len(low) else ():
            places = [low + fraction * side * separation for fraction in POLE_DISTANCES]
            far_values, near_values = (self.function(points)[:, : self.size] for points in places)
            growing = (np.abs(near_values) > POLE_GROWTH * np.abs(far_values)) & (
                np.abs(far_values) > 0
            )
            for end, sign in enumerate((-1, 1)):
                diverging = growing & (near_values * sign > 0)
                for function in np.flatnonzero(diverging.any(axis=0)).tolist():
                    bounds[end, function] = sign * np.inf
                    points_there[end, function] = places[1][diverging[:, function].argmax()]


def latin_hypercube(dimensions: int, count: int, rng: np.random.Generator) -> Array:
    """Return ``count`` points of a Latin hypercube: each coordinate has one point in each of
    ``count`` strata."""
    strata = rng.permuted(np.tile(np.arange(count), (dimensions, 1)), axis=1).T
    return (strata + rng.random(strata.shape)) / count
