"""The lowest and highest values several functions take over a box.

The functions come as one array function on the unit cube, all evaluated together, smooth where they
count: a `Piece`. What jumps (line 400's sign of MU makes results jump) is given as several pieces,
each with the margin that says where it counts, and searched piece by piece, along the surface where
the margin is zero too. The search needs no derivatives and survives points without a value (nan).
It starts from the corners, all of them while there are few, from points on faces, in the interior
and on the surface, where edges pass through it first of all, and climbs from the best of them:
along each coordinate, along random directions, and along the quasi-Newton (BFGS) direction of a
gradient by differences, which follows curved ridges; the best of all of these is taken, and the
step reduced when none improves. A move that leaves the piece is put back onto its surface.

Where a denominator changes its sign inside, the functions it divides go to infinity; that is found
by looking at both sides of its zero, and the extreme is then infinite.

What it returns is attained (or, at a surface that belongs to the other piece, approached): the true
extremes lie no closer. It is no proof that none lies farther.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

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
SURE_STEP = FIRST_STEP / 16
"""From this step down a slope that promises nothing ends a climb."""
DIFFERENCE = 1e-5
"""Half the distance a slope is taken over."""
LENGTHS = 2.0 ** np.arange(2, -11, -1)
"""Of the quasi-Newton step: what is tried of it."""
LEAST_GAIN = 1e-10
"""Of a function's range over the points tried: smaller improvements are no reason to go on, where
nothing else is asked for."""
ONE_HILL = 1e-2
"""Of two points nearer than that the lower one climbs no farther: they are on one hill."""
ROUNDS = 300
"""At most so many rounds of climbing."""
SURFACE_PAIRS = 1024
"""Pairs of points on both sides of a surface between which it is looked for."""
SURFACE_HALVES = 34
"""Times their distance is halved."""
SHALLOW = 1e-9
"""How far inside its surface a piece is met, of the largest margin seen."""
BESIDE_POLE = (1e-4, 1e-6)
"""Where functions are taken beside a denominator's zero, of the distance between two points on
either side of it: a pole makes them a hundred times as large at the second as at the first."""
POLE_HALVES = 28
"""Times the distance is halved: a zero is then known well below the distances beside it."""
POLE_GROWTH = 30.0
POLE_PAIRS = 64
"""Pairs of points between which a denominator's zeros are looked for before climbing."""


class Piece(NamedTuple):
    """m functions of k coordinates, smooth where they count.

    ``function``: points of the unit cube, n x k -> values, n x (m + q): the m functions, ``size``
    is m, and q denominators, finite and continuous: where one is zero functions may have a pole.
    ``margin``: points -> n, smooth; the functions count where it is not negative (None:
    everywhere).
    """

    function: Callable[[Array], Array]
    size: int
    margin: Callable[[Array], Array] | None = None


@dataclass(frozen=True)
class Extremes:
    """For m functions of k coordinates: ``lower`` and ``upper`` (m); ``at_lower`` and ``at_upper``
    (m, k), points of the unit cube; ``corner_lower`` and ``corner_upper`` (m), over the corners
    evaluated; ``evaluations``, points at which the functions were taken.

    A function without any finite value has nan everywhere. An extreme is infinite where a pole lies
    inside; its point is then one close to the pole.
    """

    lower: Array
    upper: Array
    at_lower: Array
    at_upper: Array
    corner_lower: Array
    corner_upper: Array
    evaluations: int


def extremes(
    piece: Piece,
    coordinates: int,
    rng: np.random.Generator,
    known: Array | None = None,
) -> Extremes:
    """Seek the extremes of a piece's functions. ``known``: further points to start from, n x k."""
    groups = [_corners(coordinates, rng), interior := _spread_out(coordinates, SCATTERED, rng)]
    on_faces = rng.random(interior.shape) < 0.5
    groups.append(np.where(on_faces, np.round(rng.random(interior.shape)), interior))
    middle = np.full((1, coordinates), 0.5)
    groups.append(middle if known is None else np.concatenate([middle, known]))
    margins = None
    evaluations = 0
    if piece.margin is not None:
        margins = piece.margin(np.concatenate(groups))
        surface = _surface(piece.margin, groups, margins, rng)
        evaluations = len(margins) + SURFACE_HALVES * len(surface)
        groups.append(surface)
        margins = np.concatenate([margins, piece.margin(surface)])
    points = np.concatenate(groups)
    values = piece.function(points)
    evaluations += len(points)
    if margins is not None:
        values = np.where(margins[:, None] >= 0, values, np.nan)
    functions = values.shape[1]
    # one row per extreme sought: the function's number and +1 to climb it, -1 to climb down
    number = np.tile(np.arange(functions), 2)
    sense = np.repeat([-1.0, 1.0], functions)
    height = _finite(values[:, number] * sense)
    corner_best = height[: len(groups[0])].max(axis=0)
    starts = _best_of_each(groups, height)
    finite = np.isfinite(values[:, piece.size :]).all(axis=1)
    inside, inside_values = points[finite], values[finite]
    poles = _Poles(piece, values.shape[1])
    poles.look_between(inside, rng)
    wanted = np.concatenate([~np.isinf(poles.lower), ~np.isinf(poles.upper)])
    # a denominator seen on both sides of zero need not be followed to its ends
    with np.errstate(invalid="ignore"):
        both = (inside_values > 0).any(axis=0) & (inside_values < 0).any(axis=0)
    wanted &= ~np.tile(both & (np.arange(functions) >= piece.size), 2)
    place = points[starts].reshape(starts.size, coordinates)
    best = np.take_along_axis(height, starts, axis=0).reshape(-1)
    climbers = _Climbers(
        piece.function,
        len(number),
        np.tile(number, len(starts)),
        np.tile(sense, len(starts)),
        _least_gain(values),
        piece.margin,
        0.0 if margins is None else SHALLOW * float(np.abs(margins).max()),
    )
    # nobody climbs from where there is no value
    wanted = np.tile(wanted, len(starts)) & ~np.isneginf(best)
    place, best = climbers.climb(place, best, rng, wanted)
    heights = best.reshape(len(starts), -1)
    winner = heights.argmax(axis=0)
    every = np.arange(2 * functions)
    highest = heights[winner, every]
    reached = np.where(np.isneginf(highest), np.nan, highest) * sense
    at: Array = place.reshape(*starts.shape, coordinates)[winner, every]
    at_corner = np.where(np.isneginf(corner_best), np.nan, corner_best) * sense
    found = Extremes(
        lower=reached[:functions],
        upper=reached[functions:],
        at_lower=at[:functions],
        at_upper=at[functions:],
        corner_lower=at_corner[:functions],
        corner_upper=at_corner[functions:],
        evaluations=evaluations + climbers.taken,
    )
    # a denominator may change its sign only where the climbers got to
    for j in range(piece.size, functions):
        poles.look(j, found.at_lower[j][None], found.at_upper[j][None])
    return poles.put_into(found)


def merged(pieces: Sequence[Extremes]) -> Extremes:
    """The extremes over several pieces together."""

    def first(values: list[Array], order: float) -> Array:
        return np.argmax(_finite_or_infinite(np.stack(values) * order), axis=0)

    def pick(values: list[Array], which: Array) -> Array:
        result: Array = np.stack(values)[which, np.arange(len(which))]
        return result

    low, high = first([p.lower for p in pieces], -1), first([p.upper for p in pieces], 1)
    corner_low = first([p.corner_lower for p in pieces], -1)
    corner_high = first([p.corner_upper for p in pieces], 1)
    return Extremes(
        lower=pick([p.lower for p in pieces], low),
        upper=pick([p.upper for p in pieces], high),
        at_lower=pick([p.at_lower for p in pieces], low),
        at_upper=pick([p.at_upper for p in pieces], high),
        corner_lower=pick([p.corner_lower for p in pieces], corner_low),
        corner_upper=pick([p.corner_upper for p in pieces], corner_high),
        evaluations=sum(p.evaluations for p in pieces),
    )


def _finite_or_infinite(values: Array) -> Array:
    return np.where(np.isnan(values), -np.inf, values)


def _best_of_each(groups: Sequence[Array], height: Array) -> NDArray[np.intp]:
    """The numbers of the `STARTS` highest points of each group of points."""
    first = 0
    starts = []
    for group in groups:
        last = first + len(group)
        order = np.argsort(-height[first:last], axis=0, kind="stable")[:STARTS]
        starts.append(first + order)
        first = last
    return np.concatenate(starts)


def _surface(
    margin: Callable[[Array], Array],
    groups: Sequence[Array],
    margins: Array,
    rng: np.random.Generator,
) -> Array:
    """Points on the surface where the margin is zero, hardly inside: on the cube's edges, as far as
    all corners are known, and between points on faces and in the interior."""
    corners, coordinates = groups[0], groups[0].shape[1]
    inside, outside = [], []
    if coordinates <= CORNERS_IN_FULL:
        for axis in range(coordinates):
            # corners stand in the order of binary numbers
            other = np.arange(len(corners)) ^ (1 << (coordinates - 1 - axis))
            crossing = np.flatnonzero((margins[: len(corners)] >= 0) & (margins[other] < 0))
            inside.append(corners[crossing])
            outside.append(corners[other[crossing]])
    points = np.concatenate(groups)
    positive, negative = np.flatnonzero(margins >= 0), np.flatnonzero(margins < 0)
    if len(positive) and len(negative):
        for chosen, of in ((inside, positive), (outside, negative)):
            chosen.append(points[rng.choice(of, SURFACE_PAIRS)])
    if not inside:
        return np.empty((0, coordinates))
    near, far = np.concatenate(inside), np.concatenate(outside)
    for _ in range(SURFACE_HALVES):
        half = 0.5 * (near + far)
        within = (margin(half) >= 0)[:, None]
        near, far = np.where(within, half, near), np.where(within, far, half)
    return near


class _Poles:
    """Which functions of a piece a pole makes infinite: ``lower`` and ``upper`` are so or nan, and
    ``at_lower`` and ``at_upper`` points beside a pole."""

    def __init__(self, piece: Piece, functions: int) -> None:
        self.piece = piece
        self.functions = functions
        self.lower, self.upper = np.full((2, functions), np.nan)
        self.at_lower: dict[int, Array] = {}
        self.at_upper: dict[int, Array] = {}
        self.crossed: set[int] = set()
        """Denominators whose zeros were found."""

    def look_between(self, points: Array, rng: np.random.Generator) -> None:
        """Look between pairs of points of the piece, taken at random."""
        if len(points) and self.functions > self.piece.size:
            start, end = points[rng.integers(len(points), size=(2, POLE_PAIRS))]
            for j in range(self.piece.size, self.functions):
                self.look(j, start, end)

    def look(self, j: int, start: Array, end: Array) -> None:
        """Look for zeros of denominator ``j`` between two lots of points, and at the functions on
        either side of them. Zeros outside the piece are none."""
        if j in self.crossed:
            return
        for side in self._beside_zeros(j, start, end):
            self.crossed.add(j)
            values = [self.piece.function(points) for points in side]
            values[1][:, self.piece.size :] = 0.0  # denominators have no poles
            with np.errstate(all="ignore"):
                growing = np.abs(values[1]) > POLE_GROWTH * np.abs(values[0])
                growing &= np.abs(values[0]) > 0
            for bound, at, sign in (
                (self.lower, self.at_lower, -1),
                (self.upper, self.at_upper, 1),
            ):
                endless = growing & (values[1] * sign > 0)
                for function in np.flatnonzero(endless.any(axis=0)).tolist():
                    bound[function] = sign * np.inf
                    at[function] = side[1][endless[:, function].argmax()]

    def _beside_zeros(self, j: int, start: Array, end: Array) -> list[list[Array]]:
        """Points beside the zeros: on either side, at each of the distances `BESIDE_POLE`."""

        def sign_at(share: Array) -> Array:
            points = start + share[:, None] * (end - start)
            return np.sign(self.piece.function(points)[:, j])

        low, high = np.zeros(len(start)), np.ones(len(start))
        first = sign_at(low)
        changes = first * sign_at(high) < 0
        if not changes.any():
            return []
        start, end, low, high = start[changes], end[changes], low[changes], high[changes]
        first = first[changes]
        for _ in range(POLE_HALVES):
            half = 0.5 * (low + high)
            same = sign_at(half) == first
            low, high = np.where(same, half, low), np.where(same, high, half)
        if self.piece.margin is not None:
            counts = self.piece.margin(start + low[:, None] * (end - start)) >= 0
            start, end, low = start[counts], end[counts], low[counts]
        return [
            [start + (low + away * side)[:, None] * (end - start) for away in BESIDE_POLE]
            for side in (-1, 1)
            if len(low)
        ]

    def put_into(self, whole: Extremes) -> Extremes:
        """The extremes of the functions, the denominators left out, with what is infinite."""
        count = self.piece.size
        at_lower, at_upper = whole.at_lower[:count].copy(), whole.at_upper[:count].copy()
        for place, at in ((at_lower, self.at_lower), (at_upper, self.at_upper)):
            for function, point in at.items():
                place[function] = point
        lower, upper = self.lower[:count], self.upper[:count]
        return Extremes(
            lower=np.where(np.isinf(lower), lower, whole.lower[:count]),
            upper=np.where(np.isinf(upper), upper, whole.upper[:count]),
            at_lower=at_lower,
            at_upper=at_upper,
            corner_lower=whole.corner_lower[:count],
            corner_upper=whole.corner_upper[:count],
            evaluations=whole.evaluations,
        )


def _corners(coordinates: int, rng: np.random.Generator) -> Array:
    if coordinates <= CORNERS_IN_FULL:
        corners = list(product((0.0, 1.0), repeat=coordinates))
        return np.array(corners).reshape(2**coordinates, coordinates)
    return np.round(rng.random((SCATTERED, coordinates)))


def _spread_out(coordinates: int, count: int, rng: np.random.Generator) -> Array:
    """A Latin hypercube: each coordinate visits every one of its ``count`` strata once."""
    strata = rng.permuted(np.tile(np.arange(count), (coordinates, 1)), axis=1).T
    return (strata + rng.random(strata.shape)) / count


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
    """c points that climb at once, each its own function up (``sense`` +1) or down (-1), to as many
    ``extremes`` in turn."""

    function: Callable[[Array], Array]
    extremes: int
    number: NDArray[np.intp]
    sense: Array
    least: Array
    margin: Callable[[Array], Array] | None = None
    shallow: float = 0.0
    taken: int = 0

    def heights(self, who: NDArray[np.intp], points: Array) -> Array:
        """Points, a x p x k for the climbers ``who`` -> how high each stands, a x p."""
        values = self.function(points.reshape(-1, points.shape[2]))
        self.taken += len(values)
        own = values.reshape(*points.shape[:2], -1)[np.arange(len(who)), :, self.number[who]]
        return _finite(own * self.sense[who, None])

    def climb(
        self, place: Array, best: Array, rng: np.random.Generator, wanted: NDArray[np.bool_]
    ) -> tuple[Array, Array]:
        """Where the climbers end, c x k, and how high; those not ``wanted`` stay."""
        count, size = place.shape
        place, best = place.copy(), best.copy()
        step = np.where(wanted, FIRST_STEP, 0.0)
        model = _Curvature(count, size)
        axes = np.concatenate([np.eye(size), -np.eye(size)])
        for _ in range(ROUNDS):
            who = np.flatnonzero(step >= LAST_STEP) if size else np.empty(0, np.intp)
            if not len(who):
                break
            slope = self.gradient(who, place[who])
            known = ~np.isnan(slope).any(axis=1)
            normal, margins = self.normals(place[who])
            slope = self.along_surface(np.nan_to_num(slope), normal, margins)
            along, uphill = model.direction(who, place[who], slope, step[who])
            aslant = rng.standard_normal((len(who), size, size))
            aslant /= np.sqrt(np.square(aslant).sum(axis=2, keepdims=True))
            around = np.concatenate(
                [np.broadcast_to(axes, (len(who), *axes.shape)), aslant], axis=1
            )
            moves = np.concatenate(
                [step[who, None, None] * around, LENGTHS[None, :, None] * along[:, None]], axis=1
            )
            tried = np.clip(place[who, None] + moves, 0.0, 1.0)
            tried, inside = self.put_back(tried, normal)
            height = np.where(inside, self.heights(who, tried), -np.inf)
            choice = height.argmax(axis=1)
            reached = height[np.arange(len(who)), choice]
            least = self.least[self.number[who]]
            better = reached > best[who] + least
            # a slope that promises nothing ends it, once shorter steps did not help either
            there = ~better & known & (step[who] * uphill <= least) & (step[who] <= SURE_STEP)
            up, stuck = who[better], who[~better]
            place[up] = tried[better, choice[better]]
            best[up] = reached[better]
            step[up] = np.minimum(2 * step[up], FIRST_STEP)
            step[stuck] /= 4
            step[who[there]] = LAST_STEP / 2
            model.forget(stuck)
            step[self.overtaken(place, best, step > 0)] = 0.0
        return place, best

    def overtaken(
        self, place: Array, best: Array, climbing: NDArray[np.bool_]
    ) -> NDArray[np.bool_]:
        """Which points have a higher one of the same extreme beside them."""
        places = place.reshape(-1, self.extremes, place.shape[1])
        heights, going = best.reshape(-1, self.extremes), climbing.reshape(-1, self.extremes)
        order = np.arange(len(heights))[:, None, None]
        higher = heights[None] > heights[:, None]
        higher |= (heights[None] == heights[:, None]) & (order.transpose(1, 0, 2) < order)
        apart = np.zeros(higher.shape)
        for i in range(place.shape[1]):
            np.maximum(apart, np.abs(places[None, :, :, i] - places[:, None, :, i]), out=apart)
        beside = higher & going[None] & (apart < ONE_HILL)
        return np.asarray(beside.any(axis=1)).reshape(-1)

    def normals(self, place: Array) -> tuple[Array, Array]:
        """The margin's slopes at some points, a x k, and the margins there."""
        if self.margin is None:
            return np.zeros_like(place), np.zeros(len(place))
        aside = DIFFERENCE * np.eye(place.shape[1])
        here = place[:, None]
        points = np.concatenate([here + aside, here - aside, here], axis=1)
        margins = self.margin(points.reshape(-1, place.shape[1])).reshape(len(place), -1)
        self.taken += margins.size
        ahead, behind = np.split(margins[:, :-1], 2, axis=1)
        return np.nan_to_num((ahead - behind) / (2 * DIFFERENCE)), margins[:, -1]

    def along_surface(self, slope: Array, normal: Array, margins: Array) -> Array:
        """Slopes without the part that leads out of the piece, for points on its surface."""
        if self.margin is None:
            return slope
        square = np.square(normal).sum(axis=1)
        out = (slope * normal).sum(axis=1)
        leaving = (margins < 1e3 * self.shallow) & (out < 0) & (square > 0)
        part = np.where(leaving, out / np.where(square > 0, square, 1.0), 0.0)
        return slope - part[:, None] * normal

    def put_back(self, tried: Array, normal: Array) -> tuple[Array, NDArray[np.bool_]]:
        """Points tried, a x p x k, those that left the piece put back onto its surface along its
        normal, a x k; and which of them lie in it now."""
        if self.margin is None:
            return tried, np.ones(tried.shape[:2], bool)
        margins = self.margin(tried.reshape(-1, tried.shape[2])).reshape(tried.shape[:2])
        self.taken += margins.size
        outside = margins < 0
        if not outside.any():
            return tried, ~outside
        points, outward = tried[outside], normal[np.nonzero(outside)[0]]
        depth = margins[outside]
        for _ in range(4):
            if (depth >= 0).all():
                break
            # a coordinate on a face it would leave through stays there
            held = (points <= 0) & (outward < 0) | (points >= 1) & (outward > 0)
            way = np.where(held, 0.0, outward)
            square = np.square(way).sum(axis=1)
            length = (2 * self.shallow - depth) / np.where(square > 0, square, np.inf)
            points = np.clip(points + length[:, None] * way, 0.0, 1.0)
            depth = self.margin(points)
            self.taken += len(points)
        tried, margins = tried.copy(), margins.copy()
        tried[outside], margins[outside] = points, depth
        return tried, margins >= 0

    def gradient(self, who: NDArray[np.intp], place: Array) -> Array:
        """Slopes by central differences, one-sided at the cube's faces; nan where none is known."""
        aside = DIFFERENCE * np.eye(place.shape[1])
        ahead = np.clip(place[:, None] + aside, 0.0, 1.0)
        behind = np.clip(place[:, None] - aside, 0.0, 1.0)
        height = self.heights(who, np.concatenate([ahead, behind], axis=1))
        rise = np.subtract(*np.split(np.where(np.isneginf(height), np.nan, height), 2, axis=1))
        slope: Array = rise / np.einsum("aii->ai", ahead - behind)
        return slope


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

    def direction(
        self, who: NDArray[np.intp], place: Array, slope: Array, step: Array
    ) -> tuple[Array, Array]:
        """The move to try: quasi-Newton where known, else a step of steepest ascent; no coordinate
        leaves through a face it stands on. And how steep it is uphill."""
        self._learn(who, place, slope)
        free = ~((place <= 0) & (slope < 0) | (place >= 1) & (slope > 0))
        uphill = np.where(free, slope, 0.0)
        size = np.sqrt(np.square(uphill).sum(axis=1, keepdims=True))
        steepest = step[:, None] * uphill / np.where(size > 0, size, 1.0)
        newton = np.where(free, np.einsum("aij,aj->ai", self.inverse[who], uphill), 0.0)
        usable = self.known[who] & ((newton * uphill).sum(axis=1) > 0)
        return np.where(usable[:, None], newton, steepest), size[:, 0]

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
