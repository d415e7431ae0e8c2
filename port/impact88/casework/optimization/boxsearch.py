"""Extremes of several functions over a region: sequential quadratic programming from many points.

Searches (`ascent`) begin at the best of the points given, for each function and either sense. All
ends are then points for every function: where the end of another search is better, a function is
searched from there, until none is."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .ascent import CONSTRAINT_TOL, MAX_STEP, SearchProblem, climb, excess, replace_nonfinite
from .effort import CHUNK, granted

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Numbers = NDArray[np.intp]

MIN_GAIN = 1e-10  # of a function's range: a search stops below
# Initial trust-region radii of searches, in turns: long steps lead to one of several extremes,
# short ones to the nearest
FIRST_STEPS = (0.02, 0.5, 0.1, 0.004)
IMPROVEMENT_TOL = 1e-4  # of a function's range: a smaller improvement does not count


class Found(NamedTuple):
    """Lowest and highest values of m functions (2 x m), nan where there is none at any point; the
    points (2 x m x k) and states (s x 2 x m) they lie at, and True in ``done`` for each search that
    converged."""

    values: Array
    at: Array
    states: Array
    done: Flags


class Pool(NamedTuple):
    """Points ``u`` (n x k) with their states ``x`` (s x n) and functions (n x m)."""

    u: Array
    x: Array
    functions: Array

    def chosen(self, which: Numbers | Flags | slice) -> "Pool":
        """Return some of the points."""
        return Pool(self.u[which], self.x[:, which], self.functions[which])

    def joined(self, other: "Pool") -> "Pool":
        """Return the points of both."""
        return Pool(
            np.concatenate([self.u, other.u]),
            np.concatenate([self.x, other.x], axis=1),
            np.concatenate([self.functions, other.functions]),
        )


def pool_of(problem: SearchProblem, u: Array, x: Array) -> tuple[Pool, Flags]:
    """Return points with their functions, and True for each within all limits."""
    blocks = []
    for first in range(0, len(u), CHUNK):
        block = slice(first, first + CHUNK)
        states, functions, constraints, usable = problem.evaluate(u[block], x[:, block])
        within = excess(constraints).max(axis=1, initial=0.0) <= CONSTRAINT_TOL
        blocks.append((states, functions, usable & within))
    all_states = np.concatenate([states for states, _, _ in blocks], axis=1)
    pool = Pool(u, all_states, np.concatenate([functions for _, functions, _ in blocks]))
    inside = np.concatenate([inside for _, _, inside in blocks])
    return pool, inside & (np.abs(u - 0.5) <= 0.5).all(axis=1)


def spread(problem: SearchProblem, points: Pool, rng: np.random.Generator) -> Pool:
    """Return points spread over the feasible region, whatever their density, by steps along
    differences of one another; the points given stay where they are."""
    u, functions = points.u.copy(), points.functions.copy()
    count, dimensions = u.shape
    for _ in range(granted().spread_steps):
        first, second = rng.integers(count, size=(2, count))
        length = 1.19 / np.sqrt(dimensions) * np.exp(rng.standard_normal(count))
        trial = np.clip(u + length[:, None] * (u[first] - u[second]), 0.0, 1.0)
        reached, inside = pool_of(problem, trial, points.x)
        u[inside], functions[inside] = trial[inside], reached.functions[inside]
    return Pool(u, points.x, functions)


def find_extremes(
    problem: SearchProblem,
    pool: Pool,
    groups: Sequence[Numbers],
    starts: int,
) -> Found:
    """Return the extremes of all functions from a pool of points within limits. Searches start from
    the best ``starts`` of each group of points (their numbers)."""
    return _Search(problem, pool).run(groups, starts)


class _Search:
    """Goals are the m functions, minimized, then maximized."""

    def __init__(self, problem: SearchProblem, pool: Pool) -> None:
        self.problem, self.pool = problem, pool
        count = pool.functions.shape[1]
        self.index, self.sense = np.tile(np.arange(count), 2), np.repeat([-1.0, 1.0], count)
        self.ends = np.full(2 * count, -np.inf)  # of searches that converged

    def objectives(self, points: Pool) -> Array:
        """Return what each goal maximizes at points."""
        return replace_nonfinite(points.functions[:, self.index] * self.sense)

    def run(self, groups: Sequence[Numbers], starts: int) -> Found:
        values, goals = self.objectives(self.pool), np.arange(len(self.index))
        best_of_groups = [
            group[np.argpartition(-values[group], min(starts, len(group)) - 1, axis=0)[:starts]]
            for group in groups
        ]
        begin = np.concatenate(best_of_groups)
        steps = np.resize(FIRST_STEPS, len(begin))
        self.climb(begin.reshape(-1), np.tile(goals, len(begin)), np.repeat(steps, len(goals)))
        for _ in range(granted().rounds):
            best = self.objectives(self.pool).max(axis=0)
            goals = np.flatnonzero(self.ends < best - IMPROVEMENT_TOL * self.ranges(best))
            if not goals.size:
                break
            self.climb(self.objectives(self.pool)[:, goals].argmax(axis=0), goals)
        return self.found()

    def ranges(self, best: Array) -> Array:
        """Return the range of each goal's function."""
        count = len(best) // 2
        return np.maximum(np.nan_to_num(best + np.roll(best, count), neginf=0.0), 0.0)

    def climb(self, begin: Numbers, goals: Numbers, reach: Array | float = MAX_STEP) -> None:
        """Search from points of the pool, one for each of some goals, and add where they end."""
        start = self.pool.chosen(begin)
        gains = MIN_GAIN * self.ranges(self.objectives(self.pool).max(axis=0))[goals]
        u, x, _, converged = climb(
            self.problem, start.u, start.x, self.index[goals], self.sense[goals], gains, reach
        )
        reached, inside = pool_of(self.problem, u, x)
        values = self.objectives(reached)[np.arange(len(goals)), goals]
        is_end = inside & converged
        np.maximum.at(self.ends, goals[is_end], values[is_end])
        self.pool = self.pool.joined(reached.chosen(inside))

    def found(self) -> Found:
        values = self.objectives(self.pool)
        winners, best = values.argmax(axis=0), values.max(axis=0)
        done = self.ends >= best - IMPROVEMENT_TOL * self.ranges(best)
        extreme = self.sense * np.where(np.isneginf(best), np.nan, best)
        at, states = self.pool.u[winners], self.pool.x[:, winners]
        return Found(
            extreme.reshape(2, -1),
            at.reshape(2, len(best) // 2, at.shape[1]),
            states.reshape(len(states), 2, len(best) // 2),
            done.reshape(2, -1),
        )
