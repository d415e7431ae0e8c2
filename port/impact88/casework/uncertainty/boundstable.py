"""The answer of `bounds`: the numbers, a table to read, and JSON to process."""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from textwrap import wrap
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ...collision.uncertain import Uncertain
from ...collision.units import System, display_values, system_of
from ...messages import notebook
from ...messages.plaintable import number, plain
from ...messages.plaintable import table as columns
from ...names import quantity

Array = NDArray[np.float64]


def quantiles_of(values: Array, fractions: Sequence[float]) -> list[float]:
    """Return quantiles as `numpy.quantile` interpolates them, to the bit.

    That function asks `numpy.unique`, which imports `numpy.ma`: 30 ms at its first call.
    """
    sorted_values = np.sort(values)
    if np.isnan(sorted_values[-1:]).any():  # sorted last
        return [math.nan] * len(fractions)
    quantiles = []
    for fraction in fractions:
        place = (len(sorted_values) - 1) * fraction
        below = math.floor(place)
        low, high = sorted_values[below], sorted_values[min(below + 1, len(sorted_values) - 1)]
        part, step = place - below, high - low
        quantiles.append(float(high - step * (1 - part) if part >= 0.5 else low + step * part))
    return quantiles


@dataclass(frozen=True)
class Spread:
    """Mean, standard deviation and quantiles of one result over random draws.

    Parameters
    ----------
    mean, deviation : float
        Mean and standard deviation of the draws, in the result's unit.
    quantiles : dict of float to float
        The value at each probability.
    """

    mean: float
    deviation: float
    quantiles: dict[float, float]

    @classmethod
    def of(cls, values: Array, quantiles: Sequence[float]) -> Self:
        """Return the spread of values; nan without values.

        Parameters
        ----------
        values : ndarray of float
            The draws.
        quantiles : sequence of float
            Probabilities, 0 to 1.

        Returns
        -------
        Spread
            Mean, standard deviation and quantiles.
        """
        if not len(values):
            return cls(math.nan, math.nan, dict.fromkeys(quantiles, math.nan))
        numbers = quantiles_of(values, quantiles)
        deviation = float(values.std(ddof=1)) if len(values) > 1 else 0.0
        return cls(float(values.mean()), deviation, dict(zip(quantiles, numbers, strict=True)))


@dataclass(frozen=True)
class Drive:
    """Influence of one input on one result.

    Parameters
    ----------
    rank_correlation : float
        Spearman's rank correlation over the draws, nan if either does not vary.
    at_low, at_high : float
        The result with this input at its lower and upper limit and the others nominal.
    lowest, highest : float
        Extremes of the result as this input alone runs through its range. They lie beyond
        ``at_low`` and ``at_high`` if the result turns around in between.
    """

    rank_correlation: float
    at_low: float
    at_high: float
    lowest: float
    highest: float

    @property
    def swing(self) -> float:
        """Range of the result as this input alone runs through its range."""
        return self.highest - self.lowest


@dataclass(frozen=True)
class Bound:
    """Lowest and highest value of one result, and the inputs that give them.

    A bound is infinite if the range holds a scene without a solution; the inputs given for it are
    then close to that scene's.

    Parameters
    ----------
    nominal : float
        The result with every input at its nominal value.
    lower, upper : float
        Lowest and highest value within the limits of all inputs.
    at_lower, at_upper : dict of str to float
        The inputs at which these are attained.
    corner_lower, corner_upper : float
        Lowest and highest value over the corners of the box of limits that were evaluated.
    lower_warnings, upper_warnings : tuple of str
        STATUS names of the impacts at the two bounds.
    """

    nominal: float
    lower: float
    upper: float
    at_lower: dict[str, float]
    at_upper: dict[str, float]
    corner_lower: float
    corner_upper: float
    lower_warnings: tuple[str, ...]
    upper_warnings: tuple[str, ...]


@dataclass(frozen=True)
class Bounds:
    """The answer of `bounds`.

    Parameters
    ----------
    problem : str
        The problem that was solved.
    inputs : dict of str to Uncertain
        All inputs; those that vary have limits.
    limits : dict of str to tuple of float
        The box that was searched.
    bounds : dict of str to Bound
        Lower and upper bound of each output, attained within the box.
    spreads : dict of str to Spread
        Quantiles of the draws of each output.
    drives : dict of str to dict of str to Drive
        By output, then input: how far the input alone moves the output.
    warnings : dict of str to float
        STATUS name and the fraction of the draws that carry it.
    unusable : float
        Fraction of the draws without a finite result or excluded, left out of the spreads.
    samples, seed : int
        Number of draws and their random seed.
    sigmas : float
        Cut-off for unbounded normal inputs, in standard deviations.
    evaluations : int
        Scenes solved in search of the bounds.
    corners_in_full : bool
        True where every corner of the box was looked at.
    correlations : dict of tuple of str to float
        Correlations of inputs.
    draws : dict of str to ndarray
        Each output's draws, kept on request.
    units : str, optional
        The system of units of all of it (`in_units`); None for base units or any others that are
        consistent.

    Examples
    --------
    >>> found = impact88.bounds({**impact88.sample(1), "MU": "0.7 .. 0.9"}, ["LOSS"], samples=100)
    >>> round(found.bounds["LOSS"].lower, 2), round(found.bounds["LOSS"].upper, 2)
    (52.93, 57.39)
    """

    problem: str
    inputs: dict[str, Uncertain]
    limits: dict[str, tuple[float, float]]
    bounds: dict[str, Bound]
    spreads: dict[str, Spread]
    drives: dict[str, dict[str, Drive]]
    warnings: dict[str, float]
    unusable: float
    samples: int
    seed: int
    sigmas: float
    evaluations: int
    corners_in_full: bool
    correlations: dict[tuple[str, str], float]
    draws: dict[str, NDArray[np.float64]] = field(default_factory=dict, repr=False)
    units: str | None = None

    def __repr__(self) -> str:
        varying = " ".join(name for name, value in self.inputs.items() if value.varies)
        count = len(self.bounds)
        results = " ".join(self.bounds) if count <= 6 else f"{count} results"
        return f"<Bounds of {results} over {varying}; {self.samples:,} draws>"

    def _repr_html_(self) -> str:
        """Return the output of the command as HTML for a notebook."""
        return notebook.preformatted_html(table(self))


def in_units(bounds: Bounds, system: System | str | None) -> Bounds:
    """Return ``bounds`` converted from base units and the listing's axes to ``system`` (or its
    name); unchanged for None."""
    # not split: a function for each part of the bounds, and one system for all
    system = system_of(system) if system is None or isinstance(system, str) else system
    if system.is_bare and not system.convention:
        return bounds

    place = system.display_unwrapped

    def in_order(name: str, low: Any, high: Any) -> tuple[Any, Any]:
        return (high, low) if system.is_turned(name) else (low, high)

    def bound(name: str, value: Bound) -> Bound:
        """Return a bound whose lower side is the lower one in the new system."""
        lower, upper = in_order(name, value.lower, value.upper)
        corner_lower, corner_upper = in_order(name, value.corner_lower, value.corner_upper)
        at_lower, at_upper = in_order(name, value.at_lower, value.at_upper)
        lower_warnings, upper_warnings = in_order(name, value.lower_warnings, value.upper_warnings)
        return Bound(
            nominal=place(name, value.nominal),
            lower=place(name, lower),
            upper=place(name, upper),
            at_lower=display_values(at_lower, system),
            at_upper=display_values(at_upper, system),
            corner_lower=place(name, corner_lower),
            corner_upper=place(name, corner_upper),
            lower_warnings=lower_warnings,
            upper_warnings=upper_warnings,
        )

    def spread(name: str, value: Spread) -> Spread:
        quantiles = value.quantiles
        if system.is_turned(name):  # shares are tabled in pairs about the half
            values = [*reversed(quantiles.values())]
            fractions = [round(1 - fraction, 12) for fraction in reversed(quantiles)]
            quantiles = dict(zip(fractions, values, strict=True))
        converted = {fraction: place(name, quantile) for fraction, quantile in quantiles.items()}
        deviation = value.deviation * system.factor(name)
        return Spread(place(name, value.mean), deviation, converted)

    def drive(output: str, name: str, value: Drive) -> Drive:
        low, high = in_order(name, value.at_low, value.at_high)
        lowest, highest = in_order(output, value.lowest, value.highest)
        rank = value.rank_correlation * (
            -1 if system.is_turned(name) != system.is_turned(output) else 1
        )
        return Drive(rank, *(place(output, end) for end in (low, high, lowest, highest)))

    def uncertain(name: str, item: Uncertain) -> Uncertain:
        low, high = in_order(name, item.low, item.high)
        deviation = item.deviation * system.factor(name)
        converted = {"low": place(name, low), "high": place(name, high), "deviation": deviation}
        return replace(item, nominal=place(name, item.nominal), **converted)

    return replace(
        bounds,
        inputs={n: uncertain(n, item) for n, item in bounds.inputs.items()},
        limits={n: system.ends(n, *pair) for n, pair in bounds.limits.items()},
        bounds={n: bound(n, value) for n, value in bounds.bounds.items()},
        spreads={n: spread(n, value) for n, value in bounds.spreads.items()},
        drives={
            output: {name: drive(output, name, value) for name, value in drives.items()}
            for output, drives in bounds.drives.items()
        },
        draws={n: place(n, values) for n, values in bounds.draws.items()},
        units=system.name or None,
    )


def as_json(bounds: Bounds) -> dict[str, Any]:
    """Return everything as a JSON object; a value that does not exist is null."""
    units = system_of(bounds.units)

    def output(name: str, bound: Bound) -> dict[str, Any]:
        spread = bounds.spreads[name]
        return {
            "meaning": quantity(name).meaning,
            "unit": units.label(quantity(name).unit),
            **asdict(bound),
            "unbounded": unbounded_sides(bound),
            **asdict(spread),
            "quantiles": {f"{share:g}": value for share, value in spread.quantiles.items()},
            "drives": {source: asdict(drive) for source, drive in bounds.drives[name].items()},
        }

    alike = ("problem", "samples", "seed", "sigmas", "evaluations", "unusable", "warnings")
    record: dict[str, Any] = plain(
        {
            **{name: getattr(bounds, name) for name in alike},
            "all_corners": bounds.corners_in_full,
            "correlations": [
                {"names": pair, "correlation": value} for pair, value in bounds.correlations.items()
            ],
            "inputs": {
                name: {
                    "kind": item.kind,
                    "nominal": item.nominal,
                    "limits": bounds.limits[name],
                    "unit": units.label(quantity(name).unit),
                }
                for name, item in bounds.inputs.items()
            },
            "outputs": {name: output(name, bound) for name, bound in bounds.bounds.items()},
        }
    )
    return record


def unbounded_sides(bound: Any) -> list[str]:
    """Return the sides on which a bound (with ``lower`` and ``upper``) is infinite."""
    return [side for side in ("lower", "upper") if math.isinf(getattr(bound, side))]


def _width(bound: Bound) -> float:
    width = bound.upper - bound.lower
    return width if math.isfinite(width) else 0.0


def table(bounds: Bounds) -> str:
    """Return the table of bounds, quantiles and drivers, at most 100 characters wide."""
    units = system_of(bounds.units)
    lines = [f"Inputs that vary ({bounds.problem} problem)", ""]
    lines.append(f"{'':6}{'from':>12}{'to':>12}{'nominal':>12}  {'kind':<12}{'unit':<16}symbol")
    for name, item in bounds.inputs.items():
        low, high = bounds.limits[name]
        what = quantity(name)
        numbers = "".join(f"{value:>12.6g}" for value in (low, high, item.nominal))
        lines.append(f"{name:6}{numbers}  {item.kind:<12}{units.label(what.unit):<16}{what.symbol}")
    spreads = next(iter(bounds.spreads.values())).quantiles
    lines += ["", "Bounds, and quantiles of the draws", ""]
    heading = ["", "nominal", "lower", "", "upper", ""]
    heading += [*(f"{100 * share:g} %" for share in spreads), "unit"]
    rows = []
    for name, bound in bounds.bounds.items():
        ends = (bound.lower, bound.corner_lower), (bound.upper, bound.corner_upper)
        width = _width(bound)
        below, above = ("*" if abs(end - at) > 1e-6 * width else "" for end, at in ends)
        nominal = bound.nominal if abs(bound.nominal) > 1e-12 * width else 0.0
        cells = [number(nominal, 4), number(bound.lower, 5), below, number(bound.upper, 5), above]
        cells += [number(q, 4) for q in bounds.spreads[name].quantiles.values()]
        rows.append([name, *cells, units.label(quantity(name).unit)])
    lines += columns(rows, heading, left=(0, 3, 5, len(heading) - 1))
    lines += [
        "",
        "What drives them: rank correlation, and how far the result goes with that alone",
        "",
    ]
    for name in bounds.bounds:
        ranked = sorted(bounds.drives[name].items(), key=lambda entry: -abs(entry[1].swing or 0.0))
        drivers = "".join(
            f"  {source:<4}{drive.rank_correlation:>+6.2f} ({drive.swing:.3g})".ljust(23)
            for source, drive in ranked[:4]
            if drive.swing > 1e-9 * _width(bounds.bounds[name])
        )
        lines.append(f"{name:6}{drivers}".rstrip())
    lines.append("")
    if any("*" in row for row in rows):
        lines.append("* beyond every corner tried: the result turns around, or jumps, inside")
    if any(map(unbounded_sides, bounds.bounds.values())):
        lines.append("inf: unbounded; somewhere in the ranges the equations have no solution")
    lines += _warnings_at_bounds(bounds)
    corners = "all corners" if bounds.corners_in_full else "corners at random"
    lines += [
        f"Bounds: attained; sought in {bounds.evaluations:,} scenes ({corners}, faces, interior,",
        "climbing), not proven to be the farthest. Correlations do not narrow them.",
        f"Draws: {bounds.samples:,}, seed {bounds.seed}.",
    ]
    for name, share in bounds.warnings.items():
        lines.append(f"{100 * share:.3g} % of the draws: {name}")
    if bounds.unusable:
        share = 100 * bounds.unusable
        lines.append(f"{share:.3g} % of the draws have no finite result or are excluded: left out")
    return "\n".join(lines)


def _warnings_at_bounds(answer: Bounds) -> list[str]:
    places: dict[str, list[str]] = {}
    for name, bound in answer.bounds.items():
        for side, warnings in (("lower", bound.lower_warnings), ("upper", bound.upper_warnings)):
            for warning in warnings:
                places.setdefault(warning, []).append(f"{side} {name}")
    lines = []
    for warning, bounds in places.items():
        text = f"! {warning} at the bounds: {', '.join(bounds)} (--exclude {warning})"
        lines += wrap(text, 96, subsequent_indent="  ")
    return lines
