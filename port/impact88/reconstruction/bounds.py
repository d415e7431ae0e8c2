"""Bounds, quantiles and drivers of the results of a scene that is known within limits.

"Reasonable ranges of these variables should be used and the resulting velocity changes can be used
to provide upper and lower bounds on vehicle speed" (chapter, Section V). Bounds are the extremes
over the box of the limits, whatever the correlations, by differential evolution (`extremes`);
quantiles are those of random draws.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..cases.amounts import Amount
from ..cases.motion import line_of_motion
from ..errors import UserError
from ..mechanics.solve import POINT, evaluate
from ..names import FINAL_VELOCITIES, RESULTS, SCENE, check_names, missing, split_names
from ..status import Status
from .densities import draw_correlated, sampling_error
from .extremes import box_seeds, extremes
from .impacts import COURSES, FORCES, SPEEDS, Array
from .known import as_amounts, check_moment
from .problem import CONTACT_POINT, ZERO, unwrap_angles, with_arms

OUTPUTS = (*FINAL_VELOCITIES, "DVA", "DVB", "LOSS")
QUANTILES = (0.025, 0.05, 0.5, 0.95, 0.975)
SWEEP_POINTS = 21  # of each input alone: the top of a parabola is missed by 0.3 % at most
MAX_DRAWS = 10_000_000  # 80 MB for each output
BOUNDED = (*RESULTS, *SPEEDS, *COURSES, *FORCES, "DVAF", "DVAR", "DVBF", "DVBR", "EL", "DT")
INPUTS = (*SCENE, *CONTACT_POINT)


@dataclass(frozen=True)
class Bound:
    """Bounds of one output.

    Parameters
    ----------
    nominal : float
        The value at the nominal inputs.
    lower, upper : float
        Least and greatest values found within all limits; NaN if they were not wanted.
    quantiles : mapping of float to float
        Quantiles of the draws.
    drivers : mapping of str to float
        Input -> range of the output if only that input varies; largest range first.
    """

    nominal: float
    lower: float
    upper: float
    quantiles: Mapping[float, float]
    drivers: Mapping[str, float]

    @property
    def interval(self) -> tuple[float, float]:
        """90 % interval of the draws."""
        return self.quantiles[0.05], self.quantiles[0.95]


@dataclass(frozen=True)
class Bounds:
    """Bounds of results.

    Parameters
    ----------
    inputs : mapping of str to Amount
        The inputs that vary.
    outputs : mapping of str to Bound
        Bounds by result.
    warnings : mapping of str to float
        Name of a STATUS bit -> fraction of the draws that have it.
    draws : mapping of str to ndarray
        The draws by result.
    sampling_error : float
        Largest Monte Carlo standard error of an interval's end, relative to the interval's width.

    Examples
    --------
    >>> answer = impact88.bounds({**impact88.sample(1), "MU": "0.7 .. 0.9"}, "LOSS", samples=100)
    >>> round(answer.outputs["LOSS"].lower, 2)
    52.93
    """

    inputs: Mapping[str, Amount]
    outputs: Mapping[str, Bound]
    warnings: Mapping[str, float]
    draws: Mapping[str, Array] = field(default_factory=dict, repr=False)
    sampling_error: float = 0.0


class _Box:
    """The inputs: exact ones, and the limits of those that vary."""

    def __init__(self, amounts: dict[str, Amount]) -> None:
        if amounts["M"].value == POINT:
            amounts = {"WA": ZERO, "WB": ZERO} | amounts
            line = None if "GA" in amounts else line_of_motion(amounts)
            if line is not None:  # nothing acts along the plane
                amounts |= {"GA": Amount.exactly(line), "MU": ZERO}
        elif "EM" in amounts:
            check_moment(*amounts["EM"].limits())
        self.amounts = amounts
        self.varied = {name: amount for name, amount in amounts.items() if amount.varies}
        if not self.varied:
            raise UserError("no value is known within limits; expected one such as 0.7 .. 0.9")
        self.low, self.high = np.array([amount.limits() for amount in self.varied.values()]).T
        self.nominal = np.array([[amount.value for amount in self.varied.values()]])

    def results(
        self, points: Array, wanted: Sequence[str]
    ) -> tuple[dict[str, Array], dict[str, tuple[str, ...]]]:
        """Return results of inputs (rows), and the inputs that other results lack."""
        columns: dict[str, Any] = {name: amount.value for name, amount in self.amounts.items()}
        columns = with_arms(columns | dict(zip(self.varied, points.T, strict=True)))
        if "MU" in columns and self.amounts["MU"].share:
            values, lacking = evaluate({**columns, "MU": 0.0}, ("MUC", "gt"))
            if lacking:
                return {}, lacking
            turn = np.where(values["gt"] > 0, -1.0, 1.0)  # line 400 turns it again
            columns["MU"] = turn * columns["MU"] * values["MUC"]
        values, lacking = evaluate(columns, wanted)
        return {name: np.broadcast_to(x, len(points)) for name, x in values.items()}, lacking


def bounds(
    values: Mapping[str, Any],
    outputs: Sequence[str] | str | None = None,
    *,
    samples: int = 100_000,
    seed: int = 0,
    correlations: Mapping[tuple[str, str], float] | None = None,
    limits: bool = True,
) -> Bounds:
    """Return bounds, quantiles and drivers of the results of a scene known within limits.

    Parameters
    ----------
    values : mapping of str to float, str or Amount
        The inputs by name, in one consistent set of units; M is 6 by default. CX and CY move the
        contact point in both vehicles along x and y.
    outputs : sequence of str, or str, optional
        Names of results; by default final velocities, velocity changes and the loss, as far as
        their inputs are given.
    samples : int, default 100000
        Random draws.
    seed : int, default 0
        Random seed.
    correlations : mapping of (str, str) to float, optional
        Correlations of inputs (of the normal variates of a Gaussian copula).
    limits : bool, default True
        False to leave out the least and the greatest values, which take most of the time.

    Returns
    -------
    Bounds
        Bounds by result.

    Raises
    ------
    UserError
        For values that cannot be used, missing inputs, unknown names, correlations that contradict
        one another, and limits within which no scene has finite results.

    Notes
    -----
    Equations 13 to 18; differential evolution over the box of the limits, in which a normal input
    ends at three standard deviations.

    Examples
    --------
    >>> answer = impact88.bounds({**impact88.sample(1), "GA": "-30 +- 5"}, ["DVA"], samples=100)
    >>> round(answer.outputs["DVA"].lower, 2), round(answer.outputs["DVA"].upper, 2)
    (13.42, 18.37)
    """
    box = _Box(as_amounts(values, INPUTS))
    names = list(dict.fromkeys(OUTPUTS if outputs is None else split_names(outputs)))
    check_names(names, BOUNDED, "result")
    middle, lacking = box.results(box.nominal, names)
    if lacking and (outputs is not None or not middle):
        name, inputs = next(iter(lacking.items()))
        raise UserError(f"{name} cannot be computed: {missing(inputs)}")
    names = list(middle)
    if not 2 <= samples <= MAX_DRAWS:
        raise UserError(f"{samples} samples; expected 2 to {MAX_DRAWS:,}")

    def table(points: Array) -> Array:
        results, _ = box.results(points, names)
        columns = [unwrap_angles(name, results[name], float(middle[name][0])) for name in names]
        return np.where(np.isfinite(columns), columns, np.nan).T

    ends = np.full((2, len(names)), np.nan)
    if limits:
        rng = np.random.default_rng([seed, 0])
        seeds = np.concatenate([box.nominal, box_seeds(box.low, box.high, rng)])
        ends = extremes(table, seeds, (box.low, box.high), rng)
    inputs_drawn = draw_correlated(
        box.varied, samples, np.random.default_rng([seed, 1]), correlations or {}
    )
    draws = table(inputs_drawn)
    if not np.isfinite(draws).any(0).all() or np.isinf(ends).any():
        raise UserError("no scene within these limits has a finite result; expected others")
    drivers = _drivers(box, table)
    nominal = table(box.nominal)[0].tolist()
    results, error = {}, 0.0
    for k, name in enumerate(names):
        column = draws[np.isfinite(draws[:, k]), k]
        levels = dict(zip(QUANTILES, np.quantile(column, QUANTILES).tolist(), strict=True))
        lower, upper = ends[:, k].tolist()
        results[name] = bound = Bound(nominal[k], lower, upper, levels, drivers[k])
        error = max(error, sampling_error(column, bound.interval, np.arange(len(column))))
    columns = dict(zip(names, draws.T, strict=True))
    return Bounds(box.varied, results, _warnings(box, inputs_drawn), columns, error)


def _drivers(box: _Box, table: Callable[[Array], Array]) -> list[dict[str, float]]:
    """Return for each output the inputs with their effect alone, largest first."""
    effects = []
    for k, ends in enumerate(zip(box.low, box.high, strict=True)):
        sweep = np.repeat(box.nominal, SWEEP_POINTS, 0)
        sweep[:, k] = np.linspace(*ends, SWEEP_POINTS)
        results = table(sweep)
        effects.append(np.nanmax(results, 0) - np.nanmin(results, 0))
    rows = [zip(box.varied, effect, strict=True) for effect in np.transpose(effects).tolist()]
    return [dict(sorted(row, key=lambda pair: -pair[1])) for row in rows]


def _warnings(box: _Box, inputs: Array) -> dict[str, float]:
    """Return the fraction of the draws that have each STATUS bit."""
    results, _ = box.results(inputs, ("STATUS",))
    bits = results.get("STATUS", np.zeros(1)).astype(int)
    return {s.name or "": share for s in Status if (share := float(np.mean(bits & s != 0)))}
