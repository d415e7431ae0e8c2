"""Draws from a density with limits, over several branches: sequential Monte Carlo.

From wide proposals about every impact found, through ever harder limits, to the density itself (Del
Moral, Doucet and Jasra, *Sequential Monte Carlo Samplers*, 2006). Particles move by proposals
independent of where they are, fitted to all particles, over two kinds of coordinates in turns: what
is a pole or a thin tip over the one is smooth over the other.

How much the draws tell is counted by families, the descendants of one proposal: the variance of a
mean is that of the sums over families (Chan and Lai, *Annals of Statistics* 41, 2013). Where moves
forget the ancestor, that is the number of draws; where one branch or a far corner hangs on few
ancestors, it is about their number."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..optimization.effort import CHUNK, granted

Floats = NDArray[np.float64]
Branches = NDArray[np.int64]
Flags = NDArray[np.bool_]

PROPOSAL_FACTOR = 12  # proposals per particle, so that thin parts of the distribution are found
# After each hardening of the limits particles move until so many moves of each were accepted, on
# average. With fewer, what resampling lost does not come back: low closing speeds are missed
ACCEPTED_MOVES = 4.0
MAX_MOVES = 24  # of each particle, where few are accepted
MOVES_ALIKE = 4  # moves before proposals are fitted anew
THINNING = 2  # moves between one set of draws and the next
COPIES = 4  # of each particle, which move on apart while draws are collected: fewer, longer sets
MAX_STAGES = 25  # hardenings of the limits; if these do not suffice, no impact lies within limits
MIN_EFFECTIVE = 0.5  # fraction of particles that stay effective from stage to stage
DEGREES_OF_FREEDOM = 4.0  # of the proposals, Student's t
# Independent proposals: Student's t about clusters of the particles, and a broad one about all
CLUSTERS = 8  # on each branch
CLUSTER_ROUNDS = 10  # of k means
SHARE_OF_ALL = 0.02  # of the covariance of all, added to a cluster's
BROAD = 0.1  # least fraction of the broad proposals
FIRST = 0.05  # weight of the first proposals, which reach every branch
FLOOR = 1e-6  # least variance, relative to that of each coordinate


@dataclass(frozen=True)
class Proposal:
    """Student's t about a center, on one branch: ``root`` of its covariance; ``fraction`` of all
    proposals."""

    center: Floats
    branch: int
    root: Floats
    fraction: float


class Density(Protocol):
    """The density that is sampled."""

    def logarithms(self, points: Floats, branches: Branches) -> tuple[Floats, Floats]:
        """Return the log density at points (coordinates, n), limits aside, and the sum of squares
        of the distances beyond each limit, in half-widths."""

    def proposals(self) -> Sequence[Proposal]:
        """Return the distribution to begin with."""

    @property
    def other(self) -> object:
        """Other coordinates of the same points, None where there are none."""

    def turned(
        self, points: Floats, branches: Branches, back: bool = False
    ) -> tuple[Floats, Branches, Floats]:
        """Return points over the other coordinates, or ``back`` from these, their branches and the
        log volume of these coordinates that a unit of the first is."""


@dataclass(frozen=True)
class Sample:
    """``points`` (coordinates, n) on ``branches`` (n), and the ``families`` they belong to."""

    points: Floats
    branches: Branches
    families: NDArray[np.intp]

    def effective_size(self, values: Floats) -> float:
        """Return the number of independent draws whose mean rank is as accurate as that of these
        values (n)."""
        ranks = np.empty(len(values))
        ranks[np.argsort(values)] = np.arange(len(values)) - (len(values) - 1) / 2
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
    """``mixtures``: what moves propose in turns; ``proposed``: the log density of particles as each
    proposes them."""

    def __init__(self, density: Density, rng: np.random.Generator) -> None:
        self.density, self.rng = density, rng
        self.first = _Mixture(density.proposals())
        self.mixtures: list[_Mixture | _Turned] = [self.first]
        self.proposed: list[Floats] = []
        self.families = 0

    def run(self, count: int) -> Sample | None:
        size = len(self.first.parts[0].center)
        number = min(granted().particles, max(count, 4 * size, 200))
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
            hardness = next_hardness
            self._move_on(particles, hardness)
            if hardness == np.inf:
                break
        else:
            return None
        copies = min(COPIES, -(-count // number))
        particles = particles.chosen(np.tile(np.arange(number), copies))
        self._adapt(particles)
        self._move(particles, np.inf, granted().burn_in_moves // copies)
        return self._collect(particles, count)

    def _collect(self, particles: _Particles, count: int) -> Sample:
        """Return draws from particles as they move."""
        number, parts = len(particles.branches), []
        self._adapt(particles)
        for first in range(0, count, number):
            if first:
                self._move(particles, np.inf, THINNING)
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
        return low if hardness < low else None

    def _propose(self, count: int) -> _Particles:
        """Return the first particles."""
        points, branches = self.first.draw(count, self.rng)
        self.families = count
        return _Particles(points, branches, self._logarithms(points, branches), np.arange(count))

    def _logarithms(self, points: Floats, branches: Branches) -> tuple[Floats, Floats, Floats]:
        """Return the logarithms of particles, computed in blocks that bound the memory."""
        parts = [slice(i, i + CHUNK) for i in range(0, points.shape[1], CHUNK)]
        rows = [self.density.logarithms(points[:, part], branches[part]) for part in parts]
        return (
            np.concatenate([row[0] for row in rows]),
            np.concatenate([row[1] for row in rows]),
            self.first.log_density(points, branches),
        )

    def _adapt(self, particles: _Particles) -> None:
        """Let the next moves propose what these particles resemble."""
        points, branches = particles.points, particles.branches
        first = [replace(p, fraction=FIRST * p.fraction) for p in self.first.parts]
        self.mixtures = [_Mixture([*_fit(points, branches, self.rng), *first])]
        if self.density.other is not None:
            points, branches, _ = self.density.turned(points, branches)
            if parts := _fit(points, branches, self.rng):
                self.mixtures.append(_Turned(_Mixture(parts), self.density))
        self.proposed = [
            mixture.log_density(particles.points, particles.branches) for mixture in self.mixtures
        ]

    def _move_on(self, particles: _Particles, hardness: float) -> None:
        """Move all particles until they have forgotten where they were."""
        accepted = 0.0
        for _ in range(0, MAX_MOVES, MOVES_ALIKE):
            self._adapt(particles)
            accepted += self._move(particles, hardness, MOVES_ALIKE)
            if accepted >= ACCEPTED_MOVES:
                break

    def _move(self, particles: _Particles, hardness: float, moves: int) -> float:
        """Move all particles so often; return how many moves of each were accepted, on average."""
        number, accepted = len(particles.branches), 0.0
        for move in range(moves):
            turn = move % len(self.mixtures)
            points, branches, there = self.mixtures[turn].propose(number, self.rng)
            families = self.families + np.arange(number)
            self.families += number
            trial = _Particles(points, branches, self._logarithms(points, branches), families)
            rows = self._accept(particles, trial, hardness, self.proposed[turn] - there)
            accepted += float(rows.mean())
            for other, (mixture, proposed) in enumerate(
                zip(self.mixtures, self.proposed, strict=True)
            ):
                proposed[rows] = (
                    there[rows]
                    if other == turn
                    else mixture.log_density(points[:, rows], branches[rows])
                )
        return accepted

    def _accept(
        self, particles: _Particles, trial: _Particles, hardness: float, proposed: Floats
    ) -> Flags:
        """Replace particles by their trials, where the Metropolis rule accepts them; return True
        for each. ``proposed``: how much likelier the move back is proposed, as a logarithm."""
        gain = trial.log_density(hardness) - particles.log_density(hardness) + proposed
        rows = -self.rng.standard_exponential(len(gain)) < gain
        particles.points[:, rows] = trial.points[:, rows]
        particles.branches[rows] = trial.branches[rows]
        particles.families[rows] = trial.families[rows]
        for log, trial_log in zip(particles.logs, trial.logs, strict=True):
            log[rows] = trial_log[rows]
        return np.asarray(rows)


class _Mixture:
    """Student's t of several centers and branches."""

    def __init__(self, parts: Sequence[Proposal]) -> None:
        self.parts = parts
        fractions = np.array([part.fraction for part in parts])
        self.fractions = fractions / fractions.sum()
        self.branches = np.array([part.branch for part in parts])
        self.inverses = np.linalg.inv(np.array([part.root for part in parts]))
        self.offsets = self.inverses @ np.array([part.center for part in parts])[:, :, None]
        self.logs = np.linalg.slogdet(self.inverses)[1] + np.log(self.fractions)

    def draw(self, count: int, rng: np.random.Generator) -> tuple[Floats, Branches]:
        """Return random points and their branches."""
        chosen = np.sort(rng.choice(len(self.parts), size=count, p=self.fractions))
        normal = rng.standard_normal((len(self.parts[0].center), count))
        chi = np.sqrt(rng.chisquare(DEGREES_OF_FREEDOM, count) / DEGREES_OF_FREEDOM)
        ends = np.searchsorted(chosen, np.arange(len(self.parts) + 1))
        points = np.concatenate(
            [
                part.center[:, None] + part.root @ (normal / chi)[:, first:last]
                for part, first, last in zip(self.parts, ends[:-1], ends[1:], strict=True)
            ],
            axis=1,
        )
        order = rng.permutation(count)
        branches = self.branches[chosen]
        return points[:, order], branches[order]

    def propose(self, count: int, rng: np.random.Generator) -> tuple[Floats, Branches, Floats]:
        """Return random points, their branches and their log density."""
        points, branches = self.draw(count, rng)
        return points, branches, self.log_density(points, branches)

    def log_density(self, points: Floats, branches: Branches) -> Floats:
        size = len(points)
        away = self.inverses @ points
        away -= self.offsets  # in place: fresh memory takes longer than the sums
        away *= away
        squares = away.sum(axis=1)
        logs = self.logs[:, None] - (DEGREES_OF_FREEDOM + size) / 2 * np.log1p(
            squares / DEGREES_OF_FREEDOM
        )
        logs[self.branches[:, None] != branches] = -np.inf
        largest = logs.max(axis=0)
        sums = np.exp(logs - np.where(np.isfinite(largest), largest, 0.0)).sum(axis=0)
        return np.asarray(largest + np.log(sums))


@dataclass(frozen=True)
class _Turned:
    """A mixture over the other coordinates."""

    mixture: _Mixture
    density: Density

    def propose(self, count: int, rng: np.random.Generator) -> tuple[Floats, Branches, Floats]:
        """Return random points, their branches and their log density over the coordinates."""
        points, branches, there = self.mixture.propose(count, rng)
        points, branches, volume = self.density.turned(points, branches, back=True)
        return points, branches, there - volume

    def log_density(self, points: Floats, branches: Branches) -> Floats:
        turned, branches, volume = self.density.turned(points, branches)
        return self.mixture.log_density(turned, branches) + volume


def _fit(points: Floats, branches: Branches, rng: np.random.Generator) -> list[Proposal]:
    """Return Student's t that resemble points: on each branch some about the means of clusters, and
    one about all."""
    proposals, count = [], len(branches)
    for branch in np.unique(branches):
        own = points[:, branches == branch].T
        spread = own.std(axis=0)
        if len(own) < 2 * own.shape[1] or not spread.all():
            continue
        scaled = own / spread
        whole = np.cov(scaled.T).reshape(len(spread), len(spread)) + FLOOR * np.eye(len(spread))
        clusters = _clusters(scaled, rng)
        numbers = np.bincount(clusters, minlength=CLUSTERS)
        mixture = []
        for cluster in np.flatnonzero(numbers > 4 * len(spread)):
            part = scaled[clusters == cluster]
            covariance = np.cov(part.T).reshape(whole.shape) + SHARE_OF_ALL * whole
            fraction = (1 - BROAD) * numbers[cluster] / len(own)
            mixture.append((fraction, part.mean(axis=0), covariance))
        rest = 1 - sum(fraction for fraction, _, _ in mixture)  # of small clusters, too
        mixture.append((rest, scaled.mean(axis=0), whole))
        proposals += [
            Proposal(
                center * spread,
                int(branch),
                spread[:, None] * np.linalg.cholesky(covariance),
                fraction * len(own) / count,
            )
            for fraction, center, covariance in mixture
        ]
    return proposals


def _clusters(points: Floats, rng: np.random.Generator) -> NDArray[np.intp]:
    """Return the cluster of each point (n, coordinates), by k means."""
    centers = points[rng.integers(len(points), size=CLUSTERS)]
    for _ in range(CLUSTER_ROUNDS):
        # less |point|², which all have
        distances = np.square(centers).sum(axis=1) - 2 * points @ centers.T
        nearest = distances.argmin(axis=1)
        numbers = np.bincount(nearest, minlength=CLUSTERS)
        sums = (nearest[:, None] == np.arange(CLUSTERS)).astype(float).T @ points
        centers = np.where(numbers[:, None], sums / np.maximum(numbers, 1)[:, None], centers)
    return np.asarray(nearest)


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
