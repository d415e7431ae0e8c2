"""What `bounds` found, in the units its inputs came in.

A result is found in base units; what is shown is a multiple of it, so everything that has a unit is
multiplied: nominal values, limits, bounds, spreads, and the scenes that attain the bounds.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ..units import RULES, System, system_of
from .boundstable import Bound, Bounds
from .draws import Spread


def in_units(found: Bounds, name: str | None) -> Bounds:
    """What was found in base units, in those of the system of that name; as it is for None."""
    units = system_of(name)
    if units is RULES:
        return found
    factors = {name: units.factor(name) for name in (*found.inputs, *found.bounds)}
    return replace(
        found,
        inputs={
            name: _times(factors[name], item, "nominal", "low", "high", "deviation")
            for name, item in found.inputs.items()
        },
        limits={
            name: (low * factors[name], high * factors[name])
            for name, (low, high) in found.limits.items()
        },
        bounds={name: _bound(one, factors[name], units) for name, one in found.bounds.items()},
        spreads={name: _spread(one, factors[name]) for name, one in found.spreads.items()},
        drives={
            name: {
                source: _times(factors[name], drive, "at_low", "at_high", "lowest", "highest")
                for source, drive in drives.items()
            }
            for name, drives in found.drives.items()
        },
        draws={name: draws * factors[name] for name, draws in found.draws.items()},
        units=units.name,
    )


def _times(factor: float, record: Any, *names: str) -> Any:
    """The record with the fields of those names multiplied."""
    return replace(record, **{name: getattr(record, name) * factor for name in names})


def _scene(values: Mapping[str, float], units: System) -> dict[str, float]:
    return {name: value * units.factor(name) for name, value in values.items()}


def _bound(one: Bound, factor: float, units: System) -> Bound:
    scenes = {"at_lower": _scene(one.at_lower, units), "at_upper": _scene(one.at_upper, units)}
    values = ("nominal", "lower", "upper", "corner_lower", "corner_upper")
    scaled: Bound = replace(_times(factor, one, *values), **scenes)
    return scaled


def _spread(one: Spread, factor: float) -> Spread:
    quantiles = {share: value * factor for share, value in one.quantiles.items()}
    return Spread(one.mean * factor, one.deviation * factor, quantiles)
