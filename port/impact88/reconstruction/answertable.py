"""The answer in a few lines: speeds before the impact, changes of velocity, what is not known."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from textwrap import wrap

from ..plaintable import number
from ..units import RULES, System
from .impulse import clock

_VELOCITY = "length/time"
_ROAD = {"ft/s": ("mph", 3600 / 5280), "m/s": ("km/h", 3.6)}
"""What a speed on the road is said in beside units that it is not."""
_SPINS = ("WA", "WB", "WAF", "WBF")
_SHARE = 0.05
"""Of a speed's variance: less is not named."""
_LEFT = 16
_WIDTH = 104


@dataclass(frozen=True)
class Spread:
    """What is uncertain of a quantity: standard deviation, attained bounds, the shares of its
    variance by known value."""

    deviation: float
    lower: float = math.nan
    upper: float = math.nan
    drivers: Sequence[tuple[str, float]] = ()


@dataclass(frozen=True)
class Open:
    """What is not determined, and further values that would determine all of it."""

    names: Sequence[str] = ()
    helpful: Sequence[str] = field(default=())


def answer(
    values: Mapping[str, float],
    spreads: Mapping[str, Spread],
    still_open: Open,
    remarks: int,
    units: System = RULES,
) -> list[str]:
    """The answer's lines; ``values`` and ``spreads`` in base units."""
    vehicles = "A" if math.isinf(values.get("MB", 0.0)) else "AB"
    rows = [("BEFORE IMPACT", _speed(v, values, spreads, units)) for v in vehicles]
    rows += [("DELTA-V", _change(v, values, spreads, units)) for v in vehicles]
    if still_open.names:
        rows.append(("NOT FOUND", _missing(still_open)))
    rows += [("DEPENDS ON", _depends(v, spreads)) for v in vehicles]
    some = f"{remarks}, below" if remarks else "none"
    rows.append(("REMARKS", some))
    lines: list[str] = []
    told = ""
    for label, text in rows:
        if text:
            head = "" if label == told else label
            first, *more = wrap(text, _WIDTH - _LEFT)
            lines += [f"{head:{_LEFT}}{first}", *(f"{'':{_LEFT}}{line}" for line in more)]
            told = label
    return lines


def _size(value: float, units: System) -> str:
    """A speed with its unit, and as it is said on the road."""
    unit, shown = units.label(_VELOCITY), units.shown(_VELOCITY, value)
    if units is RULES:
        return number(shown, 3)
    other = _ROAD.get(unit)
    road = f" ({number(shown * other[1], 3)} {other[0]})" if other else ""
    return f"{number(shown, 3)} {unit}{road}"


def _spread(spread: Spread | None, units: System) -> str:
    if spread is None:
        return ""
    numbers = (spread.deviation, spread.lower, spread.upper)
    deviation, lower, upper = (number(units.shown(_VELOCITY, value), 3) for value in numbers)
    return f", sd {deviation}" + (f", between {lower} and {upper}" if lower and upper else "")


def _speed(
    vehicle: str, values: Mapping[str, float], spreads: Mapping[str, Spread], units: System
) -> str:
    name, course = f"S{vehicle}", f"H{vehicle}"
    if name not in values:
        return f"{vehicle} unknown"
    text = f"{vehicle} {_size(values[name], units)}{_spread(spreads.get(name), units)}"
    if values[name] and course in values:
        text += f", heading {number(values[course], 3)}"
    return text


def _change(
    vehicle: str, values: Mapping[str, float], spreads: Mapping[str, Spread], units: System
) -> str:
    name, origin = f"DV{vehicle}", values.get(f"PDOF{vehicle}", math.nan)
    if name not in values:
        return f"{vehicle} unknown"
    text = f"{vehicle} {_size(values[name], units)}{_spread(spreads.get(name), units)}"
    if not math.isnan(origin):
        text += f", force from {clock(origin)} ({number(round(origin), 3)} deg)"
    return text


def _missing(still_open: Open) -> str:
    names = list(still_open.names)
    if set(_SPINS) <= set(names):
        names = ["spins", *(name for name in names if name not in _SPINS)]
    text = ", ".join(names)
    if still_open.helpful:
        *most, last = still_open.helpful
        text += f": give {', '.join(most)}{' and ' if most else ''}{last}"
    return text


def _depends(vehicle: str, spreads: Mapping[str, Spread]) -> str:
    spread = spreads.get(f"S{vehicle}")
    shares = [(n, s) for n, s in spread.drivers if s >= _SHARE] if spread else []
    named = ", ".join(f"{name} {100 * share:.0f} %" for name, share in shares)
    return f"{vehicle}'s speed: {named}" if named else ""
