"""What random draws tell: the `Spread` of a result, and which input makes it, `Drive`."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Spread:
    """Monte Carlo: mean, standard deviation and quantiles (share -> value) of one result."""

    mean: float
    deviation: float
    quantiles: dict[float, float]


@dataclass(frozen=True)
class Drive:
    """What one input does to one result.

    ``rank_correlation``: Spearman's, over the draws; nan where either does not vary; ``at_low`` and
    ``at_high``: the result with this input at its limits and the others nominal; ``lowest`` and
    ``highest``: over the whole sweep, beyond the former where the result turns around.
    """

    rank_correlation: float
    at_low: float
    at_high: float
    lowest: float
    highest: float

    @property
    def swing(self) -> float:
        """How far the result goes as this input alone runs through its range."""
        return self.highest - self.lowest


def spread_of(values: Array, quantiles: Sequence[float]) -> Spread:
    """NaN of no values."""
    if not len(values):
        return Spread(float("nan"), float("nan"), dict.fromkeys(quantiles, float("nan")))
    found = np.quantile(values, list(quantiles)).tolist() if quantiles else []
    deviation = float(values.std(ddof=1)) if len(values) > 1 else 0.0
    return Spread(float(values.mean()), deviation, dict(zip(quantiles, found, strict=True)))


def ranks(values: Array) -> Array:
    """Ranks from 0, equal values sharing the mean of theirs."""
    ordered = np.sort(values)
    below = np.searchsorted(ordered, values, side="left")
    return (below + np.searchsorted(ordered, values, side="right") - 1) / 2


def drive_of(sweep: Array, input_ranks: Array, output_ranks: Array) -> Drive:
    first, second = input_ranks - input_ranks.mean(), output_ranks - output_ranks.mean()
    size = np.sqrt((first @ first) * (second @ second))
    correlation = float(first @ second / size) if size > 0 else float("nan")
    finite = sweep[np.isfinite(sweep)] if np.isfinite(sweep).any() else np.array([np.nan])
    ends = (sweep[0], sweep[-1], finite.min(), finite.max())
    return Drive(correlation, *(float(end) for end in ends))


def spread_out(coordinates: int, count: int, rng: np.random.Generator) -> Array:
    """A Latin hypercube: each coordinate visits every one of its ``count`` strata once."""
    strata = rng.permuted(np.tile(np.arange(count), (coordinates, 1)), axis=1).T
    return (strata + rng.random(strata.shape)) / count
