"""Extremes over a region that is no box, by sequential linear programming and evolution in turns.

Sequential linear programming (`ascent`) can stop where a constraint is strongly curved, and random
draws hardly reach points where several known values are at their limits together. So the draws are
first spread over the whole feasible region, whatever its density. Then a population for each
extreme evolves by differential evolution (Storn and Price, 1997), which crosses such places and
passes from branch to branch; where it improves an extreme, sequential linear programming starts
again from there. An extreme has converged when evolution does not improve it."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .ascent import CONSTRAINT_TOL, SearchProblem, climb, replace_nonfinite
from .effort import granted

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

RESTARTS = 2  # local searches per extreme where evolution improved it
POPULATION = 24  # members per extreme
POPULATION_FACTOR = 4  # larger populations from the second round on
SPREAD_FRACTION = 0.3  # of steps are differences of the spread points, not of the population
CROSSOVER = 0.7  # probability that a step changes a coordinate; it changes one at least
MIN_GAIN = 1e-10  # of a quantity's range: a local search stops below
IMPROVEMENT_TOL = 1e-4  # of a quantity's range: a smaller improvement does not count
CHUNK = 1 << 13  # points evaluated at a time, bounds the memory


class Extremes(NamedTuple):
    """Lowest and highest values of m functions (2, m), the points (2, m, coordinates) and states
    (2, m) they lie at, and True in ``done`` for each search that converged."""

    values: Array
    at: Array
    states: Array
    done: Flags


class _Pool:
    """Feasible points (n, coordinates) with their states and functions."""

    def __init__(self, u: Array, x: Array, functions: Array) -> None:
        self.u, self.x, self.functions = u, x, functions

    def __add__(self, other: "_Pool") -> "_Pool":
        return _Pool(
            np.concatenate([self.u, other.u]),
            np.concatenate([self.x, other.x]),
            np.concatenate([self.functions, other.functions]),
        )

    def __getitem__(self, which: NDArray[np.intp] | slice) -> "_Pool":
        return _Pool(self.u[which], self.x[which], self.functions[which])


def _evaluate(problem: SearchProblem, u: Array, x: Array) -> tuple[_Pool, Flags]:
    """Return points with their functions, and True for each within all limits."""
    functions, usable_parts = [], []
    for first in range(0, len(u), CHUNK):
        block = slice(first, first + CHUNK)
        _, values, constraints, usable = problem.evaluate(u[block], x[None, block])
        functions.append(values)
        excess = np.maximum(-constraints, constraints - 1).max(axis=1, initial=0.0)
        usable_parts.append(usable & (excess <= CONSTRAINT_TOL))
    inside = np.concatenate(usable_parts) & (np.abs(u - 0.5) <= 0.5).all(axis=1)
    return _Pool(u, x, np.concatenate(functions)), inside


def extremes(
    problem: SearchProblem,
    u: Array,
    x: Array,
    rng: np.random.Generator,
    progress: Callable[[int], object] = lambda points: None,
) -> Extremes:
    """Search for the extremes of all functions from random ``u`` (n, coordinates) within limits, in
    the states ``x`` (n)."""
    effort = granted()
    draws, _ = _evaluate(problem, u, x)
    count = draws.functions.shape[1]
    # the last draws are the most widely spread
    spread_pool = _spread_points(problem, draws[-effort.spread_points :], rng)
    pool = draws + spread_pool
    index, sense = np.tile(np.arange(count), 2), np.repeat([-1.0, 1.0], count)
    all_goals = np.arange(2 * count)
    open_goals, population_factor = all_goals, 1

    def objectives(points: _Pool) -> Array:
        return replace_nonfinite(points.functions[:, index] * sense)

    starts = min(effort.starts, len(pool.u))
    parts = [np.arange(i, len(pool.u), starts) for i in range(starts)]
    values = objectives(pool)
    start_numbers = np.stack([part[values[part].argmax(axis=0)] for part in parts])
    start_pool, goals = pool[start_numbers.reshape(-1)], np.tile(all_goals, len(start_numbers))
    converged, retried_once = np.zeros((2, 2 * count), bool)
    for _ in range(effort.rounds):
        best_values = objectives(pool).max(axis=0)
        ranges = np.maximum(
            np.nan_to_num(best_values + np.roll(best_values, count), neginf=0.0), 0.0
        )
        points, states, _, climb_converged = climb(
            problem,
            start_pool.u,
            start_pool.x[None],
            index=index[goals],
            sense=sense[goals],
            min_gain=MIN_GAIN * ranges[goals],
        )
        # keep points outside by rounding, as draws may be
        end_pool, _ = _evaluate(problem, points, states[0])
        pool = pool + end_pool
        values = objectives(pool)
        best_values = values.max(axis=0)
        end_values = objectives(end_pool)[climb_converged].max(axis=0, initial=-np.inf)
        converged |= end_values >= best_values - IMPROVEMENT_TOL * ranges
        offspring = _evolve(
            problem,
            pool,
            spread_pool,
            values=values[:, open_goals],
            index=index[open_goals],
            sense=sense[open_goals],
            members=population_factor * POPULATION,
            rng=rng,
        )
        pool = pool + offspring
        has_gained = objectives(offspring).max(axis=0) > best_values + IMPROVEMENT_TOL * ranges
        converged &= ~has_gained
        # a search that did not converge is continued once, others while they improve
        next_goals = np.flatnonzero(has_gained | (~converged & ~retried_once))
        retried_once |= ~has_gained & ~converged
        open_goals, population_factor = next_goals, POPULATION_FACTOR
        if not len(next_goals):
            break
        goals = np.repeat(next_goals, RESTARTS)
        best_rows = np.argsort(-objectives(pool)[:, next_goals], axis=0, kind="stable")[:RESTARTS]
        start_pool = pool[best_rows.T.reshape(-1)]
    values = objectives(pool)
    winners, best_values = values.argmax(axis=0), values.max(axis=0)
    extreme_values = sense * np.where(np.isneginf(best_values), np.nan, best_values)
    return Extremes(
        extreme_values.reshape(2, count),
        pool.u[winners].reshape(2, count, -1),
        pool.x[winners].reshape(2, count),
        converged.reshape(2, count),
    )


def _spread_points(problem: SearchProblem, points: _Pool, rng: np.random.Generator) -> _Pool:
    """Return the points spread over the feasible region, by steps along differences of one
    another; the points given stay where they are."""
    points = _Pool(points.u.copy(), points.x, points.functions.copy())
    dimensions = points.u.shape[1]
    for _ in range(granted().spread_steps):
        first, second = rng.integers(len(points.u), size=(2, len(points.u)))
        length = 1.19 / np.sqrt(dimensions) * np.exp(rng.standard_normal(len(points.u)))
        trial = points.u + length[:, None] * (points.u[first] - points.u[second])
        trial_pool, inside = _evaluate(problem, np.clip(trial, 0.0, 1.0), points.x)
        points.u[inside], points.functions[inside] = (
            trial_pool.u[inside],
            trial_pool.functions[inside],
        )
    return points


def _evolve(
    problem: SearchProblem,
    pool: _Pool,
    spread_pool: _Pool,
    values: Array,
    index: NDArray[np.intp],
    sense: Array,
    members: int,
    rng: np.random.Generator,
) -> _Pool:
    """Return the populations that evolve from the best points for each extreme. ``values``: the
    objective of each extreme at all points (n, extremes)."""
    goal_count, members = values.shape[1], min(members, len(values))
    order = np.argsort(-values, axis=0, kind="stable")
    # half the best of all, half sampled from far more, for other branches
    half = members // 2
    chosen = np.concatenate([order[:half], order[half :: max(1, len(order) // 20 // members)]])
    population = pool[chosen[:members].T.reshape(-1)]
    goal = np.repeat(np.arange(goal_count), members)
    rows, own_index, own_sense = np.arange(len(goal)), index[goal], sense[goal]
    own_values = replace_nonfinite(population.functions[rows, own_index] * own_sense)
    dimensions = pool.u.shape[1]
    for _ in range(granted().generations):
        first, second = goal * members + rng.integers(members, size=(2, len(goal)))
        difference = population.u[first] - population.u[second]
        spread_first, spread_second = rng.integers(len(spread_pool.u), size=(2, len(goal)))
        from_spread = rng.random(len(goal)) < SPREAD_FRACTION
        difference[from_spread] = (spread_pool.u[spread_first] - spread_pool.u[spread_second])[
            from_spread
        ]
        length = 0.5 * np.exp(1.0 * rng.standard_normal(len(goal)))
        crossover = rng.random((len(goal), dimensions)) < CROSSOVER
        crossover[rows, rng.integers(dimensions, size=len(goal))] = True
        trial = np.clip(population.u + length[:, None] * difference * crossover, 0.0, 1.0)
        trial_pool, inside = _evaluate(problem, trial, population.x)
        trial_values = replace_nonfinite(trial_pool.functions[rows, own_index] * own_sense)
        better = inside & (trial_values > own_values)
        population.u[better], own_values[better] = trial_pool.u[better], trial_values[better]
        population.functions[better] = trial_pool.functions[better]
    return population
