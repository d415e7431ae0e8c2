"""Extremes over impacts that no box holds: climbing and evolution by turns.

Climbing (`ascent`) ends at a bend of a constraint, and draws hardly reach where several known
values are at their limits at once. So the draws are spread over all that lies within limits first,
whatever its density; then the best for each extreme evolve by differences of one another (Storn and
Price, *Differential Evolution*, 1997), which cross bends and pass from branch to branch, and where
they come farther than the climbers did these climb again from there. The search has come to its end
when evolution finds nothing farther.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .ascent import OUTSIDE, Landscape, below_all, climb

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

SPREAD, SPREADING_STEPS = 2000, 30  # points spread over all within limits, and their steps
STARTS = 4  # climbers of each extreme in the first round
AGAIN = 2  # climbers of each extreme where evolution found something farther
MAX_ROUNDS = 6  # of climbing and evolution
POPULATION, GENERATIONS = 24, 40  # of each extreme's evolution
LARGER = 4  # times as many, where a climber came to no end or evolution came farther
SHARED = 0.3  # steps by differences of the spread points, not of an extreme's own
CHANGED = 0.7  # of the coordinates a step changes, at least one
LEAST_GAIN = 1e-7  # of a quantity's range: not worth a climber's step
NO_FARTHER = 1e-4  # of a quantity's range: who gains less has found nothing farther
CHUNK = 1 << 13


class Extremes(NamedTuple):
    """Lowest and highest values of m functions (2, m), the points (2, m, coordinates) and states
    (2, m) they lie at, and whether the search for each came to its end."""

    values: Array
    at: Array
    states: Array
    done: Flags


class _Pool:
    """Points within limits (n, coordinates) with their state and functions."""

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


def _looked_at(ground: Landscape, u: Array, x: Array) -> tuple[_Pool, Flags]:
    """Return points with their functions, and which of them lie within all limits."""
    functions, good = [], []
    for first in range(0, len(u), CHUNK):
        part = slice(first, first + CHUNK)
        _, own, walls, usable = ground.at(u[part], x[None, part])
        functions.append(own)
        beyond = np.maximum(-walls, walls - 1).max(axis=1, initial=0.0)
        good.append(usable & (beyond <= OUTSIDE))
    inside = np.concatenate(good) & (np.abs(u - 0.5) <= 0.5).all(axis=1)
    return _Pool(u, x, np.concatenate(functions)), inside


def extremes(
    ground: Landscape,
    u: Array,
    x: Array,
    rng: np.random.Generator,
    progress: Callable[[int], object] = lambda points: None,
) -> Extremes:
    """Seek the extremes of all functions from draws ``u`` (n, coordinates) within limits, in the
    states ``x`` (n)."""
    drawn, _ = _looked_at(ground, u, x)
    count = drawn.functions.shape[1]
    # the last points are those spread already
    spread = _spread(ground, drawn[-SPREAD:], rng)
    pool = drawn + spread
    number, sense = np.tile(np.arange(count), 2), np.repeat([-1.0, 1.0], count)
    every = np.arange(2 * count)
    open_ones, size = every, 1

    def heights(of: _Pool) -> Array:
        return below_all(of.functions[:, number] * sense)

    parts = [np.arange(i, len(pool.u), STARTS) for i in range(min(STARTS, len(pool.u)))]
    height = heights(pool)
    first = np.stack([part[height[part].argmax(axis=0)] for part in parts])
    begin, goals = pool[first.reshape(-1)], np.tile(every, len(first))
    done, gone_on = np.zeros((2, 2 * count), bool)
    for _ in range(MAX_ROUNDS):
        most = heights(pool).max(axis=0)
        width = np.maximum(np.nan_to_num(most + np.roll(most, count), neginf=0.0), 0.0)
        ends, states, _, ended = climb(
            *(ground, begin.u, begin.x[None], number[goals], sense[goals]),
            LEAST_GAIN * width[goals],
        )
        # climbers may stand outside by rounding, as draws may
        reached, _ = _looked_at(ground, ends, states[0])
        pool = pool + reached
        height = heights(pool)
        most = height.max(axis=0)
        came = heights(reached)[ended].max(axis=0, initial=-np.inf)
        done |= came >= most - NO_FARTHER * width
        evolved = _evolved(
            *(ground, pool, spread, height[:, open_ones], number[open_ones], sense[open_ones]),
            *(size * POPULATION, rng),
        )
        pool = pool + evolved
        gained = heights(evolved).max(axis=0) > most + NO_FARTHER * width
        done &= ~gained
        # a climber that came to no end goes on once, others where there is farther to go
        again = np.flatnonzero(gained | (~done & ~gone_on))
        gone_on |= ~gained & ~done
        open_ones, size = again, LARGER
        if not len(again):
            break
        goals = np.repeat(again, AGAIN)
        top = np.argsort(-heights(pool)[:, again], axis=0, kind="stable")[:AGAIN]
        begin = pool[top.T.reshape(-1)]
    height = heights(pool)
    best, most = height.argmax(axis=0), height.max(axis=0)
    values = sense * np.where(np.isneginf(most), np.nan, most)
    return Extremes(
        values.reshape(2, count),
        pool.u[best].reshape(2, count, -1),
        pool.x[best].reshape(2, count),
        done.reshape(2, count),
    )


def _spread(ground: Landscape, points: _Pool, rng: np.random.Generator) -> _Pool:
    """Return points spread over all that lies within limits, by steps of their differences."""
    size = points.u.shape[1]
    for _ in range(SPREADING_STEPS):
        one, two = rng.integers(len(points.u), size=(2, len(points.u)))
        length = 1.19 / np.sqrt(size) * np.exp(rng.standard_normal(len(points.u)))
        tried = points.u + length[:, None] * (points.u[one] - points.u[two])
        found, good = _looked_at(ground, np.clip(tried, 0.0, 1.0), points.x)
        points.u[good], points.functions[good] = found.u[good], found.functions[good]
    return points


def _evolved(
    ground: Landscape,
    pool: _Pool,
    spread: _Pool,
    height: Array,
    number: NDArray[np.intp],
    sense: Array,
    members: int,
    rng: np.random.Generator,
) -> _Pool:
    """Return the populations that evolve from the best points for each extreme: ``height``, of all
    points (n, extremes)."""
    goals, members = height.shape[1], min(members, len(height))
    order = np.argsort(-height, axis=0, kind="stable")
    # half the best of all, half from many more, of other branches
    half = members // 2
    chosen = np.concatenate([order[:half], order[half :: max(1, len(order) // 20 // members)]])
    population = pool[chosen[:members].T.reshape(-1)]
    goal = np.repeat(np.arange(goals), members)
    rows, own_number, own_sense = np.arange(len(goal)), number[goal], sense[goal]
    now = below_all(population.functions[rows, own_number] * own_sense)
    size = pool.u.shape[1]
    for _ in range(GENERATIONS):
        one, two = goal * members + rng.integers(members, size=(2, len(goal)))
        by = population.u[one] - population.u[two]
        first, second = rng.integers(len(spread.u), size=(2, len(goal)))
        shared = rng.random(len(goal)) < SHARED
        by[shared] = (spread.u[first] - spread.u[second])[shared]
        length = 0.5 * np.exp(1.0 * rng.standard_normal(len(goal)))
        changed = rng.random((len(goal), size)) < CHANGED
        changed[rows, rng.integers(size, size=len(goal))] = True
        tried = np.clip(population.u + length[:, None] * by * changed, 0.0, 1.0)
        found, good = _looked_at(ground, tried, population.x)
        after = below_all(found.functions[rows, own_number] * own_sense)
        better = good & (after > now)
        population.u[better], now[better] = found.u[better], after[better]
        population.functions[better] = found.functions[better]
    return population
