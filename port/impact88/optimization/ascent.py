"""Climbing within limits: steps of sequential linear programming, many climbers at once.

A function of k coordinates, each from 0 to 1, with r walls (functions that must stay from 0 to 1,
too) is replaced by its slopes within reach of each climber. The linear programs that remain are
solved by a primal-dual interior-point method; where the walls bend away from their slopes the
program is solved again with them put right. A step that gains doubles the reach, one that does not
cuts it to a quarter.
"""

from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

# chosen on 26 problems of bounds; doubled, only ROUNDS moves a bound by 1e-4 of its range
REACH, LAST_REACH = 0.5, 1e-7
"""The longest step of a coordinate, and the shortest that is tried."""
OUTSIDE = 1e-9
"""A wall passed by no more is touched."""
ROUNDS = 80
"""Of climbing at most; a vertex takes about ten, a bend inside twenty to forty. Doubled, one
bound lies 2e-4 of its range farther."""
CORRECTIONS = 3
"""Times the walls are put right; with a single time bounds of reconstructions are up to
8 % narrower."""
ITERATIONS = 20
"""Of the interior-point method, at most: each leaves about a fifth of what the last one did."""
CENTRED = 1e-8
"""Where it ends: ended by the iterations alone it takes twice the time."""


class Landscape(Protocol):
    """What is climbed: m functions and r walls over k coordinates."""

    def at(self, u: Array, guess: Array) -> tuple[Array, Array, Array, Flags]:
        """Coordinates, n x k, and the states they are reached from, s x n -> the states there, the
        functions, n x m, the walls, n x r, and whether there is anything at all."""

    def slopes(self, u: Array, x: Array) -> tuple[Array, Array, Array]:
        """Of functions, n x m x k, walls, n x r x k, and states, n x s x k."""


def climb(
    ground: Landscape,
    u: Array,
    x: Array,
    number: NDArray[np.intp],
    sense: Array,
    least: Array,
) -> tuple[Array, Array, Array, Flags]:
    """Where c climbers that start at ``u`` (c x k) and the states ``x`` (s x c) end: coordinates,
    states, all functions there, and whether each came to its end. ``number``: whose function each
    climbs, -1 for those who only seek the way inside the walls; ``sense``: +1 up, -1 down;
    ``least``: the gain not worth a step."""
    x, functions, walls, usable = ground.at(u, x)
    u, reach = u.copy(), np.where(usable, REACH, 0.0)
    for _ in range(ROUNDS):
        who = np.flatnonzero(reach >= LAST_REACH)
        if not u[who].size:
            break
        slopes, bends, turns = ground.slopes(u[who], x[:, who])
        here, inside = u[who], walls[who]
        at = np.arange(len(who))
        uphill = sense[who, None] * slopes[at, number[who]]
        height = _height(functions[who], inside, number[who], sense[who])
        seeking = number[who] < 0
        away = (inside < 0).astype(float) - (inside > 1)
        uphill[seeking] = np.einsum("cr,crk->ck", away, bends)[seeking]
        low, high = np.maximum(-here, -reach[who, None]), np.minimum(1 - here, reach[who, None])
        # who stands outside a wall may go no farther out
        below, above = np.minimum(-inside, 0.0), np.maximum(1 - inside, 0.0)
        outer = np.maximum(np.maximum(-inside, inside - 1).max(axis=1, initial=0.0), OUTSIDE)
        bent = np.zeros_like(inside)
        step = best(uphill, low, high, bends, below, above)
        promised = (uphill * step).sum(axis=1)
        for again in range(CORRECTIONS):
            tried = np.clip(here + step, 0.0, 1.0)
            guess = x[:, who] + np.einsum("csk,ck->sc", turns, tried - here)
            state, values, reached, good = ground.at(tried, guess)
            passed = np.maximum(-reached, reached - 1).max(axis=1, initial=0.0)
            out = good & (passed > outer)
            if not out.any() or again == CORRECTIONS - 1:
                break
            bent[out] = (reached - inside - np.einsum("crk,ck->cr", bends, tried - here))[out]
            step[out] = best(
                *(part[out] for part in (uphill, low, high, bends, below - bent, above - bent))
            )
        gain = _height(values, reached, number[who], sense[who]) - height
        better = good & ~out & (gain > 0)
        up = who[better]
        u[up], x[:, up] = tried[better], state[:, better]
        functions[up], walls[up] = values[better], reached[better]
        reach[who] = np.where(better, np.minimum(2 * reach[who], REACH), reach[who] / 4)
        # nothing is promised any more
        reach[who[promised <= least[who]]] = 0.0
    return u, x, functions, reach < LAST_REACH


def extremes_of(
    ground: Landscape,
    points: Array,
    functions: Array,
    groups: Sequence[NDArray[np.intp]],
    starts: int,
    gain: float,
    states: Callable[[Array], Array],
) -> tuple[Array, Array, Flags]:
    """The lowest and the highest values of m functions, 2 x m: the values (nan where there is
    none), the coordinates there, and whether the climb came to its end. Climbers start from the
    best ``starts`` of each group of the ``points``, given by number, and their ``states``;
    ``gain``: of a function's range, not worth a step."""
    count = functions.shape[1]
    number, sense = np.tile(np.arange(count), 2), np.repeat([-1.0, 1.0], count)
    height = below_all(functions[:, number] * sense)
    first = np.concatenate(
        [group[np.argsort(-height[group], axis=0, kind="stable")[:starts]] for group in groups]
    )
    most = height.max(axis=0)
    least = gain * np.maximum(np.nan_to_num(most + np.roll(most, count), neginf=0.0), 0.0)
    begin = points[first.reshape(-1)]
    number, sense, least = (np.tile(each, len(first)) for each in (number, sense, least))
    u, _, reached, ended = climb(ground, begin, states(begin), number, sense, least)
    final = below_all(reached[np.arange(len(u)), number] * sense).reshape(first.shape)
    winner, every = final.argmax(axis=0), np.arange(2 * count)
    best = final[winner, every]
    at: Array = u.reshape(*first.shape, points.shape[1])[winner, every]
    values = sense[: 2 * count] * np.where(np.isneginf(best), np.nan, best)
    came = ended.reshape(first.shape)[winner, every]
    return values.reshape(2, count), at.reshape(2, count, -1), came.reshape(2, count)


def below_all(height: Array) -> Array:
    """Heights, those that are no number below all others."""
    return np.where(np.isfinite(height), height, -np.inf)


def spread_out(coordinates: int, count: int, rng: np.random.Generator) -> Array:
    """A Latin hypercube: each coordinate visits every one of its ``count`` strata once."""
    strata = rng.permuted(np.tile(np.arange(count), (coordinates, 1)), axis=1).T
    return (strata + rng.random(strata.shape)) / count


def _height(functions: Array, walls: Array, number: NDArray[np.intp], sense: Array) -> Array:
    own = sense * functions[np.arange(len(functions)), number]
    outside = np.maximum(np.maximum(-walls, walls - 1), 0.0).sum(axis=1)
    return np.where(number < 0, -outside, own)


def best(uphill: Array, low: Array, high: Array, rows: Array, below: Array, above: Array) -> Array:
    """The steps, c x k, that go farthest ``uphill`` from ``low`` to ``high`` while ``rows`` (c x r
    x k) times the step stays from ``below`` to ``above``: c linear programs of one size, by a
    primal-dual interior-point method. Where a program has no solution, anything."""
    free = np.where(uphill > 0, high, np.where(uphill < 0, low, 0.0))
    met = np.einsum("crk,ck->cr", rows, free)
    walled = ((met < below) | (met > above)).any(axis=1)
    if walled.any():
        parts = (uphill, low, high, rows, below, above)
        free[walled] = _best_between_walls(*(part[walled] for part in parts))
    return free


def _best_between_walls(
    uphill: Array, low: Array, high: Array, rows: Array, below: Array, above: Array
) -> Array:
    """`best` where a wall stands in the way of the step that goes farthest without any."""
    c, r, k = rows.shape
    size = np.abs(uphill).max(axis=1, keepdims=True)
    unit = np.maximum(high, -low).max(axis=1)[:, None]
    goal = uphill / np.where(size > 0, size, 1.0)
    every = np.concatenate([np.broadcast_to(np.eye(k), (c, k, k)), rows], axis=1)
    every = np.concatenate([every, -every], axis=1)
    most = np.concatenate([high, above, -low, -below], axis=1) / unit

    def longest(values: Array, changes: Array) -> Array:
        """The longest share of the changes that leaves values above 0, nearly."""
        shares = np.where(changes < 0, -values / np.where(changes < 0, changes, -1.0), np.inf)
        return np.asarray(np.minimum(1.0, 0.99 * shares.min(axis=1))[:, None])

    step = 0.5 * (low + high) / unit
    gap = np.tile(np.maximum(most[:, : k + r] + most[:, k + r :], 1e-12), 2)
    room = np.clip(most - np.einsum("crk,ck->cr", every, step), 0.1 * gap, gap)
    push = 1 / np.maximum(room, 0.1)
    for _ in range(ITERATIONS):
        mean = 0.1 * (room * push).mean(axis=1)[:, None]
        going = mean > CENTRED
        if not going.any():
            break
        off = most - np.einsum("crk,ck->cr", every, step) - room
        want = (mean - push * off) / room
        right = goal - np.einsum("crk,cr->ck", every, want)
        matrix = every.swapaxes(1, 2) @ (every * (push / room)[:, :, None])
        finite = np.isfinite(matrix).all(axis=(1, 2)) & np.isfinite(right).all(axis=1)
        matrix[~finite], right[~finite] = np.eye(k), 0.0
        try:
            move = np.linalg.solve(matrix, right[:, :, None])[:, :, 0]
        except np.linalg.LinAlgError:
            break
        away = off - np.einsum("crk,ck->cr", every, move)
        pushed = (mean - push * (room + away)) / room
        first, second = going * longest(room, away), going * longest(push, pushed)
        step, room, push = step + first * move, room + first * away, push + second * pushed
    return np.asarray(np.clip(np.nan_to_num(step * unit), low, high))
