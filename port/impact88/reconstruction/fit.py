"""Every impact that agrees with what is known: weighted least squares from many starts.

The Levenberg-Marquardt method (Moré 1978) goes from random starts, many at a time, to minima of
the sum of squared misfits in standard deviations. Exact values are observations with a tolerance
that shrinks, and hold exactly at the end (Gauss-Newton in their null space). Starts go on until the
expected number of minima not yet seen is below 0.05 (Boender and Rinnooy Kan 1987).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from .densities import draw
from .impacts import AFTER, BEFORE, Array, Impacts
from .problem import ANGLES, Problem

BATCH = 120  # starts at a time
MAX_STARTS = 480
MAX_UNSEEN = 0.05  # expected number of minima not seen, at which starts end
MAX_IMPACTS = 24
MOVED = 1e-6  # sum of squares above which values were adjusted
RIDGE = 0.1  # sum of squares that separates two minima
STAGES = ((1e-2, 12), (1e-4, 12), (1e-6, 16))  # tolerance of exact values, in sizes; iterations
LIMITED_STAGES = ((1e-1, 12), (1e-2, 12), (1e-3, 12), (1e-4, 12), (1e-6, 16))
"""`STAGES` within limits, whose bends stop wider steps."""
EXACT_TOL = 1e-9  # misfit of exact values that is rounding of doubles, in sizes
TYPED_TOL = 1e-3  # misfit of exact values that is rounding of what was typed: three digits
ADMISSIBLE_TOL = 1e-5  # misfit of exact values and limits of an admissible impact, in typical sizes
CONVERGED = 0.9  # proportion of iterations at their ends, from which the others do not count
POLISHING_STEPS = 12
POLISHED_TOL = 1e-10  # longest step at which polishing ends
SAME_TOL = 1e-4  # difference of velocities, in typical ones, of one and the same impact
CANDIDATE_TOL = 1e-4  # misfit at which iterations end near an impact
NEWTON_STEPS = 10  # from an impact to one whose known values differ within their limits
STEP = 1e-7  # of difference quotients; smaller slopes and excesses are rounding
RESULT_STEP = 1e-6  # of those of results, in typical sizes; a smaller slope is rounding


@dataclass
class Fit:
    """One impact that agrees with what is known, or comes nearest, and the impacts around it.

    Parameters
    ----------
    search : Search
        The problem with its coordinates and measured values.
    point : ndarray
        Values of the coordinates.
    squares, misfit : float
        Sum of squares of what has tolerances, and the largest misfit of exact values.
    open_directions : ndarray
        Changes (columns) of the coordinates that no known value resists.
    sensitivity : ndarray
        Changes of the coordinates by one standard deviation of each measured value.
    leverage : ndarray
        Leverage of each measured value on itself, along the limits.
    """

    search: Search
    point: Array
    squares: float
    misfit: float
    open_directions: Array
    sensitivity: Array
    leverage: Array

    @property
    def problem(self) -> Problem:
        """The problem."""
        return self.search.problem

    @property
    def redundancy(self) -> int:
        """Number of measured values more than needed; at least one where values had to move: a
        limit takes away a degree of freedom."""
        return max(round(float((1.0 - self.leverage).sum())), int(self.squares > MOVED))

    @property
    def probability(self) -> float:
        """Probability of a sum of squares as large or larger (chi-square)."""
        return chi_square_tail(self.squares, self.redundancy) if self.redundancy else 1.0

    @cached_property
    def impacts(self) -> Impacts:
        """The impact."""
        return self.problem.impacts(self.point[None])

    @cached_property
    def key(self) -> Array:
        """All velocities, which tell impacts apart."""
        return self.search.invariants(self.point[None] / self.search.sizes)[:, 0]

    @cached_property
    def settled(self) -> list[bool]:
        """For each velocity, True if known values determine it."""
        return [not self.is_open(name) for name in (*BEFORE, *AFTER)]

    @cached_property
    def _nearby(self) -> tuple[Array, Impacts]:
        """Lengths of open directions and sensitivities in typical sizes, and the impacts a small
        step ahead along each, then a step back."""
        shifts = np.concatenate([self.open_directions.T, self.sensitivity.T])
        lengths = np.abs(shifts / self.search.sizes).max(1, initial=1e-300)
        steps = RESULT_STEP * shifts / lengths[:, None]
        points = self.point + np.concatenate([steps, -steps])
        return lengths, self.problem.impacts(points)

    def value(self, name: str) -> float:
        """Return a result of the impact."""
        return float(np.ravel(self.impacts[name])[0])

    def nearest_limits(self, margin: float) -> list[str]:
        """Return the conditions of physics within which the impact lies by less than a margin, in
        typical sizes."""
        rows = self.problem.margins(self.impacts)
        return list(dict.fromkeys(name for name, row in rows if not np.ravel(row)[0] >= margin))

    @property
    def violations(self) -> list[str]:
        """The conditions of physics that the impact violates; friction is none."""
        return [name for name in self.nearest_limits(-STEP) if name != "friction"]

    def slopes(self, name: str) -> Array:
        """Return changes of a result: along open directions, then by a standard deviation of each
        measured value."""
        lengths, impacts = self._nearby
        column = np.broadcast_to(impacts[name], 2 * len(lengths))
        with np.errstate(invalid="ignore"):
            change = column[: len(lengths)] - column[len(lengths) :]
        if name in ANGLES:
            change = (change + 180.0) % 360.0 - 180.0
        return np.asarray(change / (2 * RESULT_STEP) * lengths)

    def open_slopes(self, name: str) -> Array:
        """Return changes of a result along open directions, in typical sizes."""
        count = self.open_directions.shape[1]
        lengths, _ = self._nearby
        return np.asarray(self.slopes(name)[:count] / lengths[:count] / self.problem.size(name))

    def is_open(self, name: str) -> bool:
        """Return True for a result that the known values leave open."""
        return bool((np.abs(self.open_slopes(name)) > RESULT_STEP).any())


class Search:
    """Least squares of one problem.

    Parameters
    ----------
    problem : Problem
        The problem.
    limited : bool, default False
        Count what physics forbids as a misfit.
    within : bool, default False
        Count values beyond their limits as a misfit, too.
    """

    def __init__(self, problem: Problem, limited: bool = False, within: bool = False) -> None:
        self.problem, self.limited, self.within = problem, limited, within
        self.priors = problem.coordinates
        self.sizes = np.array([item.size for item in self.priors])
        self.places = [k for k, name in enumerate(problem.names) if name in problem.known]
        self.soft = [item for item in problem.observed if item.sd]
        self.hard = [item for item in problem.observed if not item.sd]
        self.measured = [*(self.priors[k] for k in self.places), *self.soft]

    def residuals(self, points: Array) -> tuple[Array, Array]:
        """Return misfits in standard deviations, and those of exact values in sizes (columns)."""
        count = len(points)
        impacts = self.problem.impacts(points * self.sizes)
        soft = [
            (points[:, k] * self.sizes[k] - self.priors[k].amount.value) / self.priors[k].sd
            for k in self.places
        ]
        soft += [self.problem.misfit(impacts, item) / item.sd for item in self.soft]
        hard = [self.problem.misfit(impacts, item) / item.size for item in self.hard]
        if self.limited:
            hard += [np.minimum(row, 0.0) for _, row in self.problem.margins(impacts)]
        if self.within:
            for off, item in zip(soft, self.measured, strict=True):
                value = item.amount.value + item.sd * off
                hard.append((value - np.clip(value, *item.amount.limits())) / item.sd)
        return _columns(soft, count), _columns(hard, count)

    def slopes(self, points: Array) -> list[Array]:
        """Return derivatives of both kinds of residuals at points, by central differences: point,
        residual, coordinate."""
        d = points.shape[1]
        tables = self._residuals_beside(points, STEP * np.concatenate([np.eye(d), -np.eye(d)]))
        return [(table[..., :d] - table[..., d:]) / (2 * STEP) for table in tables]

    def _residuals_beside(self, points: Array, steps: Array) -> list[Array]:
        """Return residuals of points moved by each step: point, residual, step."""
        count, number = len(points), len(steps)
        tables = self.residuals(np.repeat(points, number, 0) + np.tile(steps, (count, 1)))
        return [table.reshape(count, number, table.shape[1]).swapaxes(1, 2) for table in tables]

    def starts(self, count: int, rng: Generator) -> Array:
        """Return random points over the whole range of impacts."""
        columns = []
        for item in self.priors:
            if item.name in self.problem.known or item.name in ANGLES:
                columns.append(draw(item.amount, count, rng) / item.size)
            elif item.name == "PN":
                columns.append(rng.uniform(-2.0 * self.problem.point, 2.0, count))
            else:
                columns.append(rng.uniform(-1.5, 1.5, count))
        return np.stack(columns, 1)

    def descend(self, points: Array) -> Array:
        """Return the ends of Levenberg-Marquardt iterations."""
        settled = 1e-8 if self.limited else 1e-6  # polishing stops at the bends of limits
        for tolerance, iterations in LIMITED_STAGES if self.limited else STAGES:
            damping = np.full(len(points), 1e-2)
            residual = self._all_residuals(points, tolerance)
            for _ in range(iterations):
                step = self._damped_step(points, residual, tolerance, damping)
                trial = self._all_residuals(points + step, tolerance)
                better = (trial**2).sum(1) < (residual**2).sum(1)
                points = np.where(better[:, None], points + step, points)
                residual = np.where(better[:, None], trial, residual)
                damping = np.clip(np.where(better, damping * 0.1, damping * 8), 1e-12, 1e8)
                if (np.abs(step).max(1) < settled).mean() > CONVERGED:
                    break
        return points

    def _damped_step(
        self, points: Array, residual: Array, tolerance: float, damping: Array
    ) -> Array:
        """Return a Levenberg-Marquardt step of each point, at most 2 typical sizes long."""
        slope = self._forward_slopes(points, residual, tolerance, [])
        square = np.einsum("nij,nik->njk", slope, slope)
        gradient = np.einsum("nij,ni->nj", slope, residual)
        diagonal = np.einsum("njj->nj", square)
        floor = 1e-8 * diagonal.max(1, keepdims=True) + 1e-30
        square = square + (damping[:, None] * (diagonal + floor))[:, :, None] * np.eye(
            points.shape[1]
        )
        step = -np.linalg.solve(square, gradient[..., None])[..., 0]
        length = np.maximum(np.abs(step).max(1, keepdims=True), 1e-300)
        return np.asarray(step * np.minimum(1.0, 2.0 / length))

    def _all_residuals(self, points: Array, tolerance: float = 1.0) -> Array:
        soft, hard = self.residuals(points)
        return np.concatenate([soft, hard / tolerance], 1)

    def _forward_slopes(
        self, points: Array, residual: Array, tolerance: float, fixed: list[int]
    ) -> Array:
        """Return derivatives of all residuals by coordinates that are not fixed."""
        steps = np.delete(STEP * np.eye(points.shape[1]), fixed, 0)
        soft, hard = self._residuals_beside(points, steps)
        return (np.concatenate([soft, hard / tolerance], 1) - residual[:, :, None]) / STEP

    def polish(self, starts: Array) -> Array:
        """Return the minima nearby at which exact values hold (Gauss-Newton in their null
        space)."""
        points = starts
        for _ in range(POLISHING_STEPS):
            soft, hard = self.residuals(points)
            by_soft, by_hard = self.slopes(points)
            inverse = pseudo_inverse(by_hard)
            free = np.eye(points.shape[1]) - inverse @ by_hard
            step = -inverse @ hard[..., None]
            rest = soft[..., None] + by_soft @ step
            step = (step - pseudo_inverse(by_soft @ free, by_soft) @ rest)[..., 0]
            size = np.abs(step).max(1, keepdims=True, initial=1e-300)
            points = points + step * np.minimum(1.0, 1.0 / size)
            if size.max() < POLISHED_TOL:
                break
        before, after = (
            np.abs(self.residuals(x)[1]).max(1, keepdims=True, initial=0.0)
            for x in (starts, points)
        )
        # a step that crosses a limit again does not count
        return np.where((after <= before) | (after < EXACT_TOL), points, starts)

    def follow(self, points: Array, moves: Array) -> tuple[Array, NDArray[np.bool_]]:
        """Return impacts whose measured values are off by ``moves`` (rows, in standard deviations),
        from points near them whose measured coordinates are so, and whether Newton's method ended
        in one; as many values are measured as determine an impact."""
        points = points / self.sizes
        exact = self.residuals(points[:1])[1].shape[1]  # with the limits of physics, if searched
        target = np.pad(moves, ((0, 0), (0, exact)))
        free = np.delete(np.arange(len(self.sizes)), self.places)
        for k in range(NEWTON_STEPS):
            residual = self._all_residuals(points)
            off = residual - target
            misfit = np.abs(off).max(1)
            if (misfit < STEP).all():
                break
            if k % 2 == 0:  # slopes serve for two steps
                slope = self._forward_slopes(points, residual, 1.0, self.places)
                square = slope.swapaxes(1, 2) @ slope + STEP**2 * np.eye(len(free))
                inverse = np.linalg.solve(square, slope.swapaxes(1, 2))
            points[:, free] -= np.clip(np.einsum("nij,nj->ni", inverse, off), -1.0, 1.0)
        return points * self.sizes, misfit < CANDIDATE_TOL

    def describe(self, point: Array) -> Fit:
        """Return a minimum with what it leaves open and what it depends on."""
        soft, hard = self.residuals(point[None])
        by_soft, by_limits = (table[0] for table in self.slopes(point[None]))
        basis = null_space(by_limits[: len(self.hard)])
        along = by_soft @ basis
        # a limit at which it lies checks known values, but makes none more certain
        limited = by_soft @ null_space(by_limits)
        return Fit(
            search=self,
            point=point * self.sizes,
            squares=float((soft[0] ** 2).sum()),
            misfit=float(np.abs(hard).max(initial=0.0)),
            open_directions=basis @ null_space(along) * self.sizes[:, None],
            sensitivity=basis @ np.linalg.pinv(along, STEP) * self.sizes[:, None],
            leverage=np.diag(limited @ np.linalg.pinv(limited, STEP)),
        )

    def run(self, seed: int = 0) -> tuple[list[Fit], int]:
        """Return all minima found, the best first, and the number of starts that led to one."""
        if not self.priors:
            return [self.describe(np.empty(0))], 1
        rng = np.random.default_rng(seed)
        fits: list[Fit] = []
        ends = 0
        for _ in range(MAX_STARTS // BATCH):
            ends += self._collect(self.descend(self.starts(BATCH, rng)), fits)
            count = sum(fit.misfit < EXACT_TOL for fit in fits)
            unseen = expected_unseen(count, ends) if ends else 0.0
            if len(fits) == MAX_IMPACTS or unseen < MAX_UNSEEN:
                break
        return sorted(fits, key=lambda fit: (fit.misfit > EXACT_TOL, fit.squares)), ends

    def nearest(self, fits: Sequence[Fit], seed: int = 0) -> Fit | None:
        """Return the least minimum at which exact values and limits hold, from impacts, others
        around them and random ones; None if there is none."""
        rng, points = np.random.default_rng(seed), np.empty((1, 0))
        if self.priors:
            values = [[fit.value(name) for name in self.problem.names] for fit in fits]
            near = np.reshape(values, (-1, len(self.sizes))) / self.sizes
            near = near[np.isfinite(near).all(1)]
            around = np.repeat(near, 2, 0)
            around += rng.normal(0, 0.1, around.shape)
            points = self.descend(np.concatenate([near, around, self.starts(BATCH // 2, rng)]))
            points = self.polish(self._in_order(points)[0])
        points, count = self._in_order(points, ADMISSIBLE_TOL)
        return self.describe(points[0]) if count else None

    def _in_order(self, points: Array, tolerance: float = CANDIDATE_TOL) -> tuple[Array, int]:
        """Return points at which exact values hold, those with the least sum of squares first, then
        the others; and the number of the first."""
        soft, hard = self.residuals(points)
        misfit = np.abs(hard).max(1, initial=0.0)
        is_far = misfit > tolerance
        order = np.lexsort([np.where(is_far, misfit, (soft**2).sum(1)), is_far])
        return points[order], int((~is_far).sum())

    def _collect(self, ends: Array, fits: list[Fit]) -> int:
        """Add the minima at ends of iterations to ``fits``; return the number of those ends."""
        points, count = self._in_order(ends)
        points = self.polish(points[: count or 1])
        for fit in fits:
            points = points[~self._leads_to(fit, points)]
        while len(points) and len(fits) < (MAX_IMPACTS if count else 1):
            fits.append(self.describe(points[0]))
            points = points[~self._leads_to(fits[-1], points)]
        return count

    def _leads_to(self, fit: Fit, points: Array) -> NDArray[np.bool_]:
        """Return True for points that lead to an impact: one equal in all that is determined or, of
        measurements, one without a ridge between."""
        keys = self.invariants(points).T
        is_seen = (np.abs(keys - fit.key)[:, fit.settled] < SAME_TOL).all(1)
        if self.measured:
            end = fit.point / self.sizes
            between = self._heights((points + end) / 2)
            is_seen |= (
                between <= np.maximum(self._heights(points), self._heights(end[None])) + RIDGE
            )
        return np.asarray(is_seen)

    def _heights(self, points: Array) -> Array:
        soft, hard = self.residuals(points)
        return np.asarray((soft**2).sum(1) + ((hard / TYPED_TOL) ** 2).sum(1))

    def invariants(self, points: Array) -> Array:
        """Return all velocities (rows) of impacts (columns) in typical ones, which tell impacts
        apart."""
        impacts = self.problem.impacts(points * self.sizes)
        velocities = [impacts[name] / self.problem.size(name) for name in (*BEFORE, *AFTER)]
        return np.stack([np.broadcast_to(x, len(points)) for x in velocities])


def expected_unseen(minima: int, starts: int) -> float:
    """Return the expected number of minima not yet seen, after as many starts led to some."""
    if starts <= minima + 2:
        return math.inf
    return minima * (minima + 1) / (starts - minima - 2)


def null_space(matrix: Array) -> Array:
    """Return an orthonormal basis (columns) of what a matrix maps to 0, or to rounding."""
    _, s, vt = np.linalg.svd(matrix)
    rank = int((s > STEP * s.max(initial=1e-300)).sum())
    return np.asarray(vt[rank:].T)


def pseudo_inverse(matrices: Array, scale: Array | None = None) -> Array:
    """Return pseudo-inverses; singular values that are rounding of ``scale`` (by default of the
    matrices themselves) count as 0."""
    u, s, vt = np.linalg.svd(matrices, full_matrices=False)
    size = np.abs(matrices if scale is None else scale).max((1, 2), initial=1e-300)
    inverse = np.where(s > STEP * size[:, None], 1.0 / np.maximum(s, 1e-300), 0.0)
    return np.asarray((vt.swapaxes(1, 2) * inverse[:, None]) @ u.swapaxes(1, 2))


def chi_square_tail(x: float, degrees: int) -> float:
    """Return the probability of a chi-square variate above ``x`` (Abramowitz and Stegun 26.4)."""
    half = min(x / 2, 1e3)  # beyond, the probability is 0 in doubles
    powers = np.arange(degrees % 2 / 2, degrees / 2).tolist()
    total: float = math.exp(-half) * sum(half**k / math.gamma(k + 1) for k in powers)
    return min(1.0, total + math.erfc(math.sqrt(half)) * (degrees % 2))


def _columns(rows: Sequence[Array], count: int) -> Array:
    """Return rows as columns of a table, with large numbers where they are not finite."""
    if not rows:
        return np.empty((count, 0))
    table = np.stack([np.broadcast_to(row, count) for row in rows], 1)
    return np.nan_to_num(table, nan=1e6, posinf=1e6, neginf=-1e6)
