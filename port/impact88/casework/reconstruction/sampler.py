"""Draws from a density with limits, over several branches: sequential Monte Carlo.

From wide proposals about every impact found, through ever harder limits, to the density itself (Del
Moral, Doucet and Jasra, *Sequential Monte Carlo Samplers*, 2006). Particles move by differential
evolution Markov chains (ter Braak, 2006) in two halves.

How much the draws tell is counted by families, the descendants of one proposal: the variance of a
mean is that of the sums over families (Chan and Lai, *Annals of Statistics* 41, 2013). Where moves
forget the ancestor, that is the number of draws; where one branch or a far corner hangs on few
ancestors, it is about their number."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..optimization.effort import granted

Floats = NDArray[np.float64]
Branches = NDArray[np.int64]

PROPOSAL_FACTOR = 12  # proposals per particle, so that thin parts of the distribution are found
MOVES_PER_STAGE = 6  # moves of every particle after each hardening of the limits
ENOUGH = 1000  # effective draws of every coordinate; with fewer, moves go on
MAX_BURN_INS = 6
THINNING = 6  # moves between one set of draws and the next
MAX_STAGES = 80  # hardenings of the limits; if these do not suffice, no impact lies within limits
MIN_EFFECTIVE = 0.5  # fraction of particles that stay effective from stage to stage
MAX_HARDNESS = 40.0  # logarithm of the hardness where limits count as hard
# Probability of a step by the full difference of two particles, which leads to another branch
JUMP_PROBABILITY = 0.1
MIN_FAMILIES = 100  # fewer, and families are counted anew
_GRID = 1e-7  # grid of coordinates, relative to the spread of the proposals
_CHUNK = 1 << 13  # points at a time, bounds the memory
DEGREES_OF_FREEDOM = 4.0  # of the proposals, Student's t


@dataclass(frozen=True)
class Proposal:
    """Student's t about a center, on one branch: ``root`` of its covariance; ``fraction`` of all
    proposals."""

    center: Floats
    branch: int
    root: Floats
    fraction: float


class Density(Protocol):
    """What is sampled from."""

    def logarithms(self, points: Floats, branches: Branches) -> tuple[Floats, Floats]:
        """Return the log density at points (coordinates, n), limits aside, and the sum of squares
        of the distances beyond each limit, in half-widths."""

    def proposals(self) -> Sequence[Proposal]:
        """Return the distribution to begin with."""

    def neighbours(self, branches: Branches, rng: np.random.Generator) -> Branches:
        """Return branches to try from each branch."""


@dataclass(frozen=True)
class Sample:
    """``points`` (coordinates, n) on ``branches`` (n), and the ``families`` they belong to."""

    points: Floats
    branches: Branches
    families: NDArray[np.intp]

    def effective_size(self, values: Floats) -> float:
        """Return the number of independent draws whose mean rank is as accurate as that of these
        values (n)."""
        ranks = np.argsort(np.argsort(values, kind="stable"), kind="stable").astype(float)
        ranks -= ranks.mean()
        sums = np.bincount(self.families, weights=ranks)
        families = np.count_nonzero(np.bincount(self.families))
        if families < 2:
            return 0.0
        variance = np.square(sums).sum() * families / (families - 1)
        size = float(len(ranks) * np.square(ranks).sum() / variance) if variance > 0 else np.inf
        return min(size, float(len(ranks)))


@dataclass
class _Particles:
    """``logs``: log density, excess beyond limits, log density of the proposals."""

    points: Floats
    branches: Branches
    logs: tuple[Floats, Floats, Floats]
    families: NDArray[np.intp]

    def chosen(self, rows: NDArray[np.intp]) -> "_Particles":
        logs = tuple(log[rows] for log in self.logs)
        return _Particles(
            self.points[:, rows],
            self.branches[rows],
            (logs[0], logs[1], logs[2]),
            self.families[rows],
        )

    def log_density(self, hardness: float) -> Floats:
        """Return the log density with softened limits, from the proposals (hardness 0) to the
        density itself (infinite)."""
        density, excess, proposed = self.logs
        if hardness == np.inf:
            return np.where(excess > 0, -np.inf, density)
        if hardness == 0:
            return proposed
        weight = -np.expm1(-hardness)
        return np.asarray(weight * density + (1 - weight) * proposed - np.expm1(hardness) * excess)


def sample(density: Density, count: int, rng: np.random.Generator) -> Sample | None:
    """Return ``count`` random draws, None where nothing was found within all limits."""
    with np.errstate(all="ignore"):
        try:
            return _Sampler(density, rng).run(count)
        except np.linalg.LinAlgError:
            return None


class _Sampler:
    def __init__(self, density: Density, rng: np.random.Generator) -> None:
        self.density, self.rng = density, rng
        self.proposals = density.proposals()
        self.inverses = [np.linalg.inv(proposal.root) for proposal in self.proposals]
        self.grid = _GRID * np.linalg.norm(self.proposals[0].root, axis=1)[:, None]

    def run(self, count: int) -> Sample | None:
        size = len(self.proposals[0].center)
        number = min(granted().particles, max(count, 4 * size, 200)) // 2 * 2
        particles = self._propose(PROPOSAL_FACTOR * number)
        hardness = 0.0
        for _ in range(MAX_STAGES):
            # of the first proposals many break a law
            usable = min(number, int(np.isfinite(particles.logs[0]).sum()))
            next_hardness = self._next_hardness(particles, hardness, MIN_EFFECTIVE * usable)
            if next_hardness is None:
                return None
            weights = particles.log_density(next_hardness) - particles.log_density(hardness)
            particles = particles.chosen(_resample(np.exp(_shifted(weights)), number, self.rng))
            if len(np.unique(particles.families)) < MIN_FAMILIES:
                particles.families = np.arange(number)
            hardness = next_hardness
            for _ in range(MOVES_PER_STAGE):
                self._move(particles, hardness)
            if hardness == np.inf:
                break
        else:
            return None
        for _ in range(MAX_BURN_INS):
            for _ in range(granted().burn_in_moves):
                self._move(particles, np.inf)
            drawn = self._collect(particles, count)
            if min(map(drawn.effective_size, drawn.points)) >= min(ENOUGH, 0.25 * count):
                break
        return drawn

    def _collect(self, particles: _Particles, count: int) -> Sample:
        """Return draws from particles as they move."""
        number, parts = len(particles.branches), []
        for first in range(0, count, number):
            for _ in range(THINNING if first else 0):
                self._move(particles, np.inf)
            order = self.rng.permutation(number)[: count - first]
            parts.append(particles.chosen(order))
        return Sample(
            np.concatenate([part.points for part in parts], axis=1),
            np.concatenate([part.branches for part in parts]),
            np.concatenate([part.families for part in parts]),
        )

    def _next_hardness(
        self, particles: _Particles, hardness: float, min_effective: float
    ) -> float | None:
        """Return the hardness at which so many particles stay effective, by bisection; None where
        limits cannot be hardened further."""
        present = particles.log_density(hardness)

        def is_effective(value: float) -> bool:
            return _effective_size(particles.log_density(value) - present) >= min_effective

        if is_effective(np.inf):
            return np.inf
        low, high = hardness, hardness + 4.0
        for _ in range(30):
            middle = (low + high) / 2
            low, high = (middle, high) if is_effective(middle) else (low, middle)
        return low if hardness < low <= MAX_HARDNESS else None

    def _propose(self, count: int) -> _Particles:
        """Return the first particles."""
        fractions = np.array([proposal.fraction for proposal in self.proposals])
        chosen = self.rng.choice(len(self.proposals), size=count, p=fractions / fractions.sum())
        size = len(self.proposals[0].center)
        normal = self.rng.standard_normal((count, size))
        chi = np.sqrt(self.rng.chisquare(DEGREES_OF_FREEDOM, count) / DEGREES_OF_FREEDOM)
        roots = np.stack([proposal.root for proposal in self.proposals])
        steps = (roots[chosen] @ (normal / chi[:, None])[:, :, None])[:, :, 0]
        centers = np.stack([proposal.center for proposal in self.proposals])
        points = self._on_grid((centers[chosen] + steps).T)
        branches = np.array([proposal.branch for proposal in self.proposals])[chosen]
        return _Particles(points, branches, self._logarithms(points, branches), np.arange(count))

    def _logarithms(self, points: Floats, branches: Branches) -> tuple[Floats, Floats, Floats]:
        """Return the logarithms of particles, computed in blocks that bound the memory."""
        parts = [slice(i, i + _CHUNK) for i in range(0, points.shape[1], _CHUNK)]
        rows = [self.density.logarithms(points[:, part], branches[part]) for part in parts]
        return (
            np.concatenate([row[0] for row in rows]),
            np.concatenate([row[1] for row in rows]),
            self._proposal_density(points, branches),
        )

    def _proposal_density(self, points: Floats, branches: Branches) -> Floats:
        total, size = np.full(points.shape[1], -np.inf), len(points)
        for proposal, inverse in zip(self.proposals, self.inverses, strict=True):
            square = np.square(inverse @ (points - proposal.center[:, None])).sum(axis=0)
            log = -(DEGREES_OF_FREEDOM + size) / 2 * np.log1p(square / DEGREES_OF_FREEDOM)
            log += np.linalg.slogdet(inverse)[1] + np.log(proposal.fraction)
            total = np.logaddexp(total, np.where(branches == proposal.branch, log, -np.inf))
        return total

    def _on_grid(self, points: Floats) -> Floats:
        """Return points rounded to a fine grid. Differential evolution multiplies rounding errors:
        without a grid, draws would depend on the system of units."""
        center = self.proposals[0].center[:, None]
        return np.asarray(center + np.round((points - center) / self.grid) * self.grid)

    def _move(self, particles: _Particles, hardness: float) -> None:
        """Move all particles by one step of differential evolution, each half along differences of
        the other half, accepted by the Metropolis rule."""
        rng, (size, number) = self.rng, particles.points.shape
        order = rng.permutation(number)
        for moving, partners in (
            (order[: number // 2], order[number // 2 :]),
            (order[number // 2 :], order[: number // 2]),
        ):
            count = len(moving)
            first, second = (rng.choice(partners, count) for _ in range(2))
            length = 2.38 / np.sqrt(2 * size) * np.exp(0.5 * rng.standard_normal(count))
            length = np.where(rng.random(count) < JUMP_PROBABILITY, 1.0, length)
            spread = particles.points[:, partners].std(axis=1, keepdims=True)
            step = length * (particles.points[:, first] - particles.points[:, second])
            step = step + 1e-3 * spread * rng.standard_normal((size, count))
            points = self._on_grid(particles.points[:, moving] + step)
            present = particles.chosen(moving)
            branches = self.density.neighbours(present.branches, rng)
            trial = _Particles(
                points, branches, self._logarithms(points, branches), present.families
            )
            gain = trial.log_density(hardness) - present.log_density(hardness)
            accepted = -rng.standard_exponential(count) < gain
            rows = moving[accepted]
            particles.points[:, rows] = points[:, accepted]
            particles.branches[rows] = branches[accepted]
            for log, trial_log in zip(particles.logs, trial.logs, strict=True):
                log[rows] = trial_log[accepted]


def _shifted(logarithms: Floats) -> Floats:
    """Return logarithms less the largest, those that are nan as -inf."""
    clean = np.where(np.isnan(logarithms), -np.inf, logarithms)
    return np.asarray(clean - clean.max(initial=-1e300))


def _effective_size(logarithms: Floats) -> float:
    """Return the effective number of particles with these log weights: (sum w)² / sum w²."""
    weights = np.exp(_shifted(logarithms))
    total = weights.sum()
    return float(total * total / np.square(weights).sum()) if total > 0 else 0.0


def _resample(weights: Floats, count: int, rng: np.random.Generator) -> NDArray[np.intp]:
    """Return the numbers of ``count`` surviving particles, by systematic resampling."""
    positions = (rng.random() + np.arange(count)) / count
    sums = np.cumsum(weights / weights.sum())
    return np.minimum(np.searchsorted(sums, positions), len(weights) - 1)
