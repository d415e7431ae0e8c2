"""Uncertainty of a reconstruction beyond the first order: random draws and bounds.

Both are over the admissible impacts within the limits of what is known, of all branches
(`posterior`): draws by sequential Monte Carlo (`sampler`), bounds by a search from the draws
(`optimization.boxsearch`)."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...collision.geometry import within_doubles
from ...collision.uncertain import Uncertain, fixed_value, random_numbers
from ...mechanics.state import SPEEDS
from ...names import VELOCITIES
from ..optimization.boxsearch import find_extremes, pool_of, spread
from ..optimization.effort import granted
from ..uncertainty.boundstable import Spread
from .leastsquares import pseudo_inverse
from .posterior import MAX_VELOCITY, MIN_SIZE, FeasibleRegion, Posterior
from .sampler import Sample
from .solution import NULL_TOL, Reconstruction
from .system import System

Floats = NDArray[np.float64]
Progress = Callable[[int], object]

GROUPS = 8  # of draws; searches begin at the best of each
REST = 1e-10  # of the square of a speed's upper bound: with less a vehicle stands
MIN_GAIN = 1e-7  # of a quantity's range: the resolution of bounds
LIMIT_REACHED = 0.5  # of the largest velocity: draws beyond hang on that limit
# A condition ends an interval if most of the outermost draws, and far more of them than of all
# draws, lie at its border
OUTERMOST = 0.05  # fraction of draws
AT_BORDER = 0.03  # of the distance between a condition's borders
MOST = 0.5  # fraction of the outermost draws


@dataclass(frozen=True)
class Draws:
    """Random draws of admissible impacts.

    ``values`` of each quantity; ``sample``: their points; ``effective``: the number of independent
    draws that tell as much, of the quantity where it is least; ``beyond_friction``: the fraction
    with friction beyond its limits before these are widened; ``unlimited``: the fraction that only
    the largest velocity limits; ``cut_by``: for each quantity the condition of the admissible set
    that ends its draws below and above, "" for none; ``counted``: that set in one sentence."""

    values: dict[str, Floats]
    sample: Sample = field(repr=False)
    effective: float
    beyond_friction: float = 0.0
    unlimited: float = 0.0
    cut_by: dict[str, tuple[str, str]] = field(default_factory=dict)
    counted: str = ""

    @property
    def suffice(self) -> bool:
        """True if the draws tell enough to be shown."""
        return self.effective >= min(MIN_SIZE, 0.25 * len(self.sample.branches))

    def spread(self, name: str, quantiles: Sequence[float]) -> Spread:
        """Return mean, standard deviation and quantiles of the draws."""
        values = self.values[name]
        return Spread.of(values[np.isfinite(values)], quantiles)


@dataclass(frozen=True)
class Range:
    """Lowest and highest value found of a quantity, and the known values that give them.

    NaN where no impact was found within all limits; infinite where E = 0 lies within its limits.
    ``searched``: True if the search converged."""

    lower: float
    upper: float
    at_lower: dict[str, float]
    at_upper: dict[str, float]
    searched: bool = True


@within_doubles
def draws(
    solution: Reconstruction,
    names: Sequence[str],
    count: int,
    seed: int = 0,
    progress: Progress = lambda impacts: None,
) -> Draws | None:
    """Return ``count`` random draws of the quantities ``names`` over the admissible impacts that
    agree with what is known; None where none was found."""
    posterior = Posterior(solution, progress)
    sample = posterior.sample(count, random_numbers(seed, 1))
    if sample is None:
        return None
    all_names = [*names, *VELOCITIES]
    rows, conditions, is_beyond = posterior.described(sample.points, sample.branches, all_names)
    rows, speeds = rows[: len(names)], rows[len(names) :]
    values = dict(zip(names, rows, strict=True))
    effective = min((sample.effective_size(row) for row in rows), default=float(count))
    limits = np.array([[MAX_VELOCITY * posterior.system.scale(n)] for n in VELOCITIES])
    unlimited = (np.abs(speeds) > LIMIT_REACHED * limits).any(axis=0).mean()
    cut_by = {name: _ends(row, conditions) for name, row in values.items()}
    counted = posterior.admissible.sentence()
    beyond = float(is_beyond.mean())
    return Draws(values, sample, effective, beyond, float(unlimited), cut_by, counted)


def _ends(values: Floats, conditions: Mapping[str, Floats]) -> tuple[str, str]:
    """Return the conditions that end the draws of a quantity below and above."""
    order, count = np.argsort(values), int(OUTERMOST * len(values))
    ends = []
    for outermost in (order[:count], order[len(values) - count :]):
        fractions = {
            name: (_at_border(row[outermost]), _at_border(row)) for name, row in conditions.items()
        }
        ending = [n for n, (own, all_) in fractions.items() if own > max(MOST, 4 * all_)]
        ends.append(max(ending, key=lambda n: fractions[n][0]) if ending else "")
    return ends[0], ends[1]


def _at_border(row: Floats) -> float:
    return float((np.abs(row - 0.5) > 0.5 - AT_BORDER).mean()) if len(row) else 0.0


@within_doubles
def ranges(
    solution: Reconstruction,
    names: Sequence[str],
    seed: int = 0,
    drawn: Draws | None = None,
    progress: Progress = lambda impacts: None,
) -> dict[str, Range]:
    """Return the lowest and highest value of each quantity over the admissible impacts within the
    limits of what is known, searched for from the draws ``drawn``, or from own ones."""
    posterior = Posterior(solution, progress)
    count = granted().draws_of_bounds
    sample = drawn.sample if drawn else posterior.sample(count, random_numbers(seed, 0))
    if sample is None:
        return {name: Range(np.nan, np.nan, {}, {}) for name in names}
    region = FeasibleRegion(posterior, names, sample.points)
    near = region.near_exact(sample.points, sample.branches)
    if not len(near):
        return {name: Range(np.nan, np.nan, {}, {}) for name in names}
    u, states = region.fractions(sample.points[:, near]), sample.branches[None, near].astype(float)
    pool, _ = pool_of(region, u, states)
    last = pool.chosen(slice(-granted().spread_points, None))  # the most widely spread
    pool = pool.joined(spread(region, last, random_numbers(seed, 2)))
    groups = [np.arange(i, len(pool.u), GROUPS) for i in range(min(GROUPS, len(pool.u)))]
    found = find_extremes(region, pool, groups, granted().starts)
    components = slice(0, posterior.coordinates.free)
    results = {}
    for i, name in enumerate(names):
        ends, branches = found.at[:, i], found.states[0, :, i]
        low, high = (region.known_values(ends[side], branches[side]) for side in (0, 1))
        is_inside = (np.abs(ends[:, components] - 0.5) < 0.5).all()
        lower, upper = found.values[:, i].tolist()
        if name in SPEEDS:
            lower = 0.0 if lower <= REST * upper else math.sqrt(lower)
            upper = math.sqrt(upper)
        is_searched = bool(found.done[:, i].all()) and bool(is_inside)
        results[name] = Range(lower, upper, low, high, is_searched)
    for name in _unbounded_names(solution, posterior.known, names):
        results[name] = Range(-np.inf, np.inf, {}, {})
    return results


def _unbounded_names(
    solution: Reconstruction, known: Mapping[str, Uncertain], names: Sequence[str]
) -> list[str]:
    """Return the quantities that nothing determines when E is 0, if E may be 0."""
    system = solution.system
    if "E" not in known or not known["E"].low <= 0 <= known["E"].high:
        return []
    at_zero = System({**known, "E": fixed_value(0.0)}, adjusted=True)
    kept = [row for row, name in enumerate(system.variables) if name in at_zero.variables]
    x = solution.x[kept]
    _, null = pseudo_inverse(at_zero.jacobian(x))
    slopes = at_zero.gradients(x, names)
    null_parts = np.abs(slopes @ null).max(axis=1, initial=0.0)
    is_unbounded = null_parts > NULL_TOL * np.abs(slopes).max(axis=1, initial=0.0)
    return [name for name, flag in zip(names, is_unbounded, strict=True) if flag]
