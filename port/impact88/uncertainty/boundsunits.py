"""What `bounds` found, in the units its inputs came in.

A result is found in base units; what is shown is a multiple of it, so everything that has a unit is
multiplied: nominal values, limits, bounds, spreads, and the scenes that attain the bounds.
"""

from collections.abc import Mapping
from dataclasses import astuple, replace
from typing import Any

from ..units import RULES, system_of, written
from .boundstable import Bounds
from .draws import Drive


def in_units(found: Bounds, name: str | None) -> Bounds:
    """What was found in base units, in those of the system of that name; as it is for None."""
    units = system_of(name)
    if units is RULES:
        return found
    factors = {name: units.factor(name) for name in (*found.inputs, *found.bounds)}

    def times(records: Mapping[str, Any], *fields: str) -> dict[str, Any]:
        """Records by name, with the fields of those names multiplied."""
        return {
            name: replace(one, **{field: getattr(one, field) * factors[name] for field in fields})
            for name, one in records.items()
        }

    bounds = times(found.bounds, "nominal", "lower", "upper", "corner_lower", "corner_upper")
    spreads = times(found.spreads, "mean", "deviation")
    return replace(
        found,
        inputs=times(found.inputs, "nominal", "low", "high", "deviation"),
        limits={
            name: (low * factors[name], high * factors[name])
            for name, (low, high) in found.limits.items()
        },
        bounds={
            name: replace(
                one, at_lower=written(one.at_lower, units), at_upper=written(one.at_upper, units)
            )
            for name, one in bounds.items()
        },
        spreads={
            name: replace(one, quantiles={q: v * factors[name] for q, v in one.quantiles.items()})
            for name, one in spreads.items()
        },
        drives={
            name: {
                source: Drive(one.rank_correlation, *(x * factors[name] for x in astuple(one)[1:]))
                for source, one in drives.items()
            }
            for name, drives in found.drives.items()
        },
        draws={name: draws * factors[name] for name, draws in found.draws.items()},
        units=units.name,
    )
