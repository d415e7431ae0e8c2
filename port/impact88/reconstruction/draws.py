"""Random draws of all impacts that physics allows, weighted by what is known.

The method is sequential Monte Carlo (Del Moral, Doucet and Jasra 2006). The prior is flat over
velocities before the impact, e, e_m and P_t/P_n; each known value multiplies it by its density.
Particles start from the coordinates' own densities; the observations' are raised to powers that
grow from 0 to 1; between, particles move by differences of others (ter Braak 2006), which suits any
affine shape.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from ..cases.amounts import Amount
from ..mechanics.laws import MAX_FRICTION
from .densities import draw, log_density
from .fit import Fit
from .impacts import COEFFICIENTS, IMPULSES, Array, Impacts
from .problem import RANGES, WIDEST, Known, Problem

PARTICLES = 8000  # 2,000 left 45 to 80 independent families in hard problems
KEPT_PROPORTION = 0.5  # of the effective sample size, at each power (Del Moral et al. 2006)
MIN_FAMILIES = 20  # independent draws, below which they tell nothing
EXACT_WIDTH = 5e-4  # standard deviation of exact observations, in typical sizes
SOFT_LIMIT = 0.02  # softness of a limit while particles move, in half widths
ACCEPTANCE = 0.25  # proportion of proposals accepted, aimed at (ter Braak 2006)
JUMP = 2.38  # scale of a differential-evolution move, over sqrt(2 d) (ter Braak 2006)
MODE_JUMPS = 0.05  # proportion of moves by a whole difference, between modes
STAGE_MOVES = 3.0  # accepted moves of each particle, on average: at each power, between draws
LAST_MOVES = 8.0  # at the last power
PRIOR_ROUNDS = 8  # of points from the prior, until their effective number is `PARTICLES`
MAX_ROUNDS = 60  # of points from the prior, of moves, and of draws that are kept


class State(NamedTuple):
    """Particles: points, log densities of prior and observations, and whether these hold."""

    points: Array
    prior: Array
    likelihood: Array
    holds: NDArray[np.bool_]

    def chosen(self, rows: NDArray[np.int64]) -> State:
        """Return some of the particles."""
        return State(self.points[rows], self.prior[rows], self.likelihood[rows], self.holds[rows])


@dataclass
class Sample:
    """Draws: ``points`` (rows) over the coordinates of ``problem``, and the number of the particle
    of the prior that each descends from."""

    problem: Problem
    points: Array
    family: NDArray[np.int64]

    @property
    def families(self) -> float:
        """Number of independent particles that the draws descend from."""
        sizes = np.bincount(self.family)
        return float(sizes.sum() ** 2 / (sizes**2).sum())

    @cached_property
    def impacts(self) -> Impacts:
        """The impacts."""
        return self.problem.impacts(self.points)

    def __getitem__(self, name: str) -> Array:
        """Return the values of a quantity."""
        return np.broadcast_to(self.impacts[name], len(self.points))


def draw_prior(problem: Problem, count: int, rng: Generator) -> tuple[Array, Array]:
    """Return points, and the log of their weights under the prior: coefficients that are not
    given are drawn, and give the impulses."""
    columns: dict[str, Array] = {}
    weights = np.zeros(count)
    for item in problem.coordinates:
        name = item.name
        if name not in IMPULSES or name in problem.known:
            columns[name] = draw(item.amount, count, rng)
            continue
        name = COEFFICIENTS[IMPULSES.index(name)]
        if name == "MUP":
            angle = np.arctan(MAX_FRICTION)
            columns[name] = np.tan(rng.uniform(-angle, angle, count))
            weights += np.log1p(columns[name] ** 2)
        else:  # half of them near 0, where an inverse makes much of little
            share = rng.random(count) ** rng.choice([1, 3], count)
            weights -= np.log(3.0 + share ** (-2 / 3))  # the density of this mixture
            columns[name] = max(RANGES[name], key=abs) * share
    impacts = problem.complete(columns)
    with np.errstate(all="ignore"):
        weights += problem.log_density(impacts)
    values = impacts | columns
    return np.stack([np.broadcast_to(values[name], count) for name in problem.names], 1), weights


def log_limits(problem: Problem, points: Array) -> Array:
    """Return the log densities of known coordinates; -inf beyond their limits."""
    total = np.zeros(len(points))
    for item, column in zip(problem.coordinates, points.T, strict=True):
        low, high = item.amount.limits()
        if item.amount.kind != "uniform":
            total += log_density(item.amount, np.clip(column, low, high))
        total[(column < low) | (column > high)] = -np.inf
    return total


def log_densities(problem: Problem, points: Array) -> State:
    """Return points with the log densities of the prior and of the observations."""
    prior = log_limits(problem, points)
    rows = np.flatnonzero(np.isfinite(prior))
    impacts = problem.impacts(points[rows])
    prior[rows] += _log_volume(problem, impacts)
    likelihood, holds = np.zeros(len(points)), np.zeros(len(points), bool)
    holds[rows] = True
    for item in problem.observed:
        density, is_within = observation(item, problem.misfit(impacts, item))
        likelihood[rows] += density
        holds[rows] &= is_within
    likelihood = np.nan_to_num(likelihood, nan=-1e300, neginf=-1e300)
    return State(points, prior, likelihood, holds)


@np.errstate(all="ignore")
def _log_volume(problem: Problem, impacts: Impacts) -> Array:
    """Return the log of the prior's density of coordinates; -inf where physics forbids."""
    volume = problem.log_density(impacts)
    is_allowed = np.isfinite(volume)
    for _, margin in problem.margins(impacts):
        is_allowed &= margin >= 0
    for name in ("UX", "UY", "VX", "VY"):
        is_allowed &= np.abs(impacts[name]) <= WIDEST * problem.speed
    return np.where(is_allowed, volume, -np.inf)


@np.errstate(all="ignore")
def observation(item: Known, off: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return log densities of an observation, softened at limits, and whether it is within them."""
    amount = item.amount
    if not amount.varies:
        amount = Amount(amount.value, -np.inf, np.inf, "normal", EXACT_WIDTH * item.size)
    low, high = (limit - amount.value for limit in amount.limits())
    beyond = np.maximum(np.maximum(off - high, low - off), 0.0)
    inside = log_density(amount, np.clip(off, low, high) + amount.value)
    return inside - 0.5 * (beyond / (SOFT_LIMIT * (high - low) / 2)) ** 2, beyond <= 0


def sample(
    problem: Problem,
    count: int = 20_000,
    seed: int = 0,
) -> Sample | None:
    """Return draws, or None if no admissible impact is found within all limits.

    Parameters
    ----------
    problem : Problem
        The problem, with at least one coordinate.
    count : int, default 20000
        Number of draws.
    seed : int, default 0
        Random seed.
    """
    rng = np.random.default_rng([seed, 1])
    first = _first(problem, rng)
    if first is None:
        return None
    state, log_weights = first
    family, power, scale = np.arange(len(state.points)), 0.0, 1.0
    while power < 1.0:
        step = _next_power(log_weights, state.likelihood, power)
        rows = _resample(log_weights + (step - power) * state.likelihood, PARTICLES, rng)
        state, family, power = state.chosen(rows), family[rows], step
        log_weights = np.zeros(PARTICLES)
        moves = STAGE_MOVES if power < 1.0 else LAST_MOVES
        state, scale = _move(problem, state, power, scale, moves, rng)
    if state.holds.sum() < MIN_FAMILIES:
        return None
    points, families = [state.points[state.holds]], [family[state.holds]]
    while sum(map(len, points)) < count and len(points) < MAX_ROUNDS:
        state, scale = _move(problem, state, power, scale, STAGE_MOVES, rng)
        points.append(state.points[state.holds])
        families.append(family[state.holds])
    draws = Sample(problem, np.concatenate(points)[:count], np.concatenate(families)[:count])
    return draws if draws.families >= MIN_FAMILIES else None


def push_forward(fit: Fit, count: int, seed: int = 0) -> Sample | None:
    """Return draws around an impact that as many values determine as are known: each value is drawn
    from its own density. Draws that physics forbids do not count; None if few are left."""
    rng = np.random.default_rng([seed, 1])
    search, problem = fit.search, fit.problem
    moves = np.stack(
        [(draw(item.amount, count, rng) - item.amount.value) / item.sd for item in search.measured],
        1,
    )
    points, is_impact = search.follow(fit.point + moves @ fit.sensitivity.T, moves)
    points = points[is_impact]
    margins = problem.margins(problem.impacts(points))
    points = points[np.all([row >= 0 for _, row in margins], axis=0)]
    draws = Sample(problem, points, np.arange(len(points)))
    return draws if len(points) >= MIN_FAMILIES else None


def _first(problem: Problem, rng: Generator) -> tuple[State, Array] | None:
    """Return particles of the prior that physics allows, and the log of their weights."""
    states: list[State] = []
    log_weights = np.empty(0)
    for rounds in range(MAX_ROUNDS):
        points, weights = draw_prior(problem, 5 * PARTICLES, rng)
        state = log_densities(problem, points)
        rows = np.flatnonzero(np.isfinite(state.prior))
        states.append(state.chosen(rows))
        log_weights = np.append(log_weights, weights[rows])
        if len(log_weights) >= 2 * PARTICLES and (
            rounds >= PRIOR_ROUNDS or _effective_number(log_weights) >= PARTICLES
        ):
            break
    if len(log_weights) < MIN_FAMILIES:
        return None
    return State(*map(np.concatenate, zip(*states, strict=True))), log_weights


def _next_power(log_weights: Array, likelihood: Array, power: float) -> float:
    """Return the power at which half of the effective sample size is left (bisection)."""

    def effective(step: float) -> float:
        return _effective_number(log_weights + (step - power) * likelihood)

    least = KEPT_PROPORTION * min(effective(power), 2 * PARTICLES)
    if effective(1.0) >= least:
        return 1.0
    low, high = np.log(max(power, 1e-12) * (1 + 1e-9)), 0.0
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if effective(np.exp(middle)) >= least else (low, middle)
    return float(np.exp(low))


def _effective_number(log_weights: Array) -> float:
    """Return the effective sample size of weights."""
    weights = np.exp(log_weights - log_weights.max())
    return float(weights.sum() ** 2 / (weights**2).sum())


def _resample(log_weights: Array, count: int, rng: Generator) -> NDArray[np.int64]:
    """Return systematic choices in proportion to weights."""
    total = np.cumsum(np.exp(log_weights - log_weights.max()))
    places = (rng.random() + np.arange(count)) / count * total[-1]
    return np.asarray(np.minimum(np.searchsorted(total, places), len(total) - 1), np.int64)


def _move(
    problem: Problem,
    state: State,
    power: float,
    scale: float,
    distance: float,
    rng: Generator,
) -> tuple[State, float]:
    """Move particles until each was accepted ``distance`` times on average; return them and the
    adapted scale of moves."""
    count, d = state.points.shape
    state = state.chosen(np.arange(count))  # a copy
    points = state.points
    total = 0.0
    for rounds in range(MAX_ROUNDS):
        first, second, third = rng.integers(0, count, (3, count))
        jump = JUMP / np.sqrt(2 * d) * scale * np.exp(rng.normal(0, 0.5, (count, 1)))
        jump[rng.random(count) < MODE_JUMPS] = 1.0
        proposal = points + jump * (points[first] - points[second])
        proposal += 1e-6 * (points[first] - points[third])
        angles = proposal[:, problem.circular]
        proposal[:, problem.circular] = (angles + 180) % 360 - 180
        new = log_densities(problem, proposal)
        gain = new.prior - state.prior + power * (new.likelihood - state.likelihood)
        accept = np.log(rng.random(count)) < gain
        for column, proposed in zip(state, new, strict=True):
            column[accept] = proposed[accept]
        rate = float(accept.mean())
        scale = float(np.clip(scale * np.exp(rate - ACCEPTANCE), 0.02, 2.0))
        total += rate
        if total >= distance and rounds >= 1:
            break
    return state, scale
