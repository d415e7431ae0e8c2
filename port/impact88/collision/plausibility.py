"""Remarks on values that are hardly meant: a wrong unit or decimal mark, other axes, other angles.

A remark refuses nothing: a scene may be a model, a barrier or a test of the program.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from ..names import quantity

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from .units import System

LIGHTEST = 200.0
"""Mass in kg of the lightest vehicle that passes without a remark."""
HEAVIEST = 60_000.0
"""Mass in kg of the heaviest."""
LONGEST_ARM = 15.0
"""Distance in m from a vehicle's center of gravity to the contact point."""
FASTEST = 500 / 3.6
"""Speed in m/s."""
INERTIA_RATIO = (0.3, 3.0)
"""A yaw inertia over that of the rule (`collision.estimates`)."""
SIDEWAYS = 45.0
"""Degrees between a moving vehicle's course and its heading."""
_ROUNDING = 1e-9
"""Degrees by which what is exactly `SIDEWAYS` may seem more."""
BEYOND_ARM = "the contact point is more than 15 m from the center of gravity; is its unit as meant?"
ONE_SPIN = "the moment at the contact leaves both vehicles with one spin; no moment is EM = 1"
SPEEDS = {"A": ("UX", "UY", "SA", "HA"), "B": ("VX", "VY", "SB", "HB")}
MEASURES = {
    "mass": (
        LIGHTEST,
        HEAVIEST,
        "no vehicle has that mass (200 kg to 60 t); is its unit as meant?",
    ),
    "length/time": (-FASTEST, FASTEST, "no vehicle is as fast (500 km/h); is its unit as meant?"),
}


def remarks(
    numbers: Mapping[str, float],
    texts: Mapping[str, str],
    system: System,
    outlines: Mapping[str, float],
) -> dict[str, str]:
    """Return, by name, what of a case is hardly meant.

    Parameters
    ----------
    numbers
        The nominal values in base units and the listing's axes.
    texts
        The same as they were written.
    system
        What they are shown in; sizes are looked at where it has units.
    outlines
        LA BA LB BB, in base units.
    """
    return {
        **({} if system.is_bare else _sizes(numbers, texts, system, outlines)),
        **_directions(numbers, system),
        **_moment(numbers, texts),
    }


def _sizes(
    numbers: Mapping[str, float],
    texts: Mapping[str, str],
    system: System,
    outlines: Mapping[str, float],
) -> dict[str, str]:
    """Return remarks on masses, speeds, arms and inertias."""
    from .estimates import rule_of

    found: dict[str, str] = {}
    for name, value in numbers.items():
        rule = rule_of_name(name)
        size = value * float(system.scale(rule)) if rule in MEASURES else math.nan
        low, high, words = MEASURES.get(rule, (0.0, 0.0, ""))
        if rule == "mass" and not size > 0:
            continue  # which is refused, or ends the program
        if rule in MEASURES and math.isfinite(size) and not low <= size <= high:
            found[name] = f"{name} = {texts.get(name, '')}: {words}"
    arm = {"DA": "DA", "DB": "DB", "CAF": "DA", "CAL": "DA", "CBF": "DB", "CBL": "DB"}
    longest = LONGEST_ARM / float(system.scale("length"))
    for name in ("DA", "DB"):
        if abs(numbers.get(name, 0.0)) > longest and numbers.get("M") != 4:
            written = [f"{n} = {texts[n]}" for n, own in arm.items() if own == name and n in texts]
            found[name] = f"{', '.join(written)}: {BEYOND_ARM}"
    for vehicle in "AB" if numbers.get("M") != 4 else "":
        name, mass = f"I{vehicle}", numbers.get(f"M{vehicle}", math.nan)
        inertia = numbers.get(name, math.nan)
        usual = rule_of(vehicle, mass, outlines, system)
        if usual is None or not 0 < inertia < math.inf or f"M{vehicle}" in found:
            continue
        ratio = inertia / usual
        if not INERTIA_RATIO[0] <= ratio <= INERTIA_RATIO[1]:
            found[name] = inertia_words(name, texts.get(name, ""), ratio)
    return found


def inertia_words(name: str, text: str, ratio: float) -> str:
    """Return the remark on an inertia that is ``ratio`` times the rule's."""
    return (
        f'{name} = {text} is {ratio:.2g} times what {name} = "estimate" gives; are its unit and '
        "the mass as meant?"
    )


def is_sideways(apart: Any) -> Any:
    """Return whether so many degrees off its heading are sideways; of an array, of each."""
    return apart > SIDEWAYS + _ROUNDING


def sideways_words(vehicle: str, apart: float) -> str:
    """Return the remark on a vehicle that moves so many degrees off its heading."""
    rule = "A faces TA + 180" if vehicle == "A" else "B faces TB"
    return (
        f"{vehicle} moves {apart:.0f}° off the way it faces ({rule} in the listing's axes); are "
        "velocities and headings in one convention? (axes, headings)"
    )


def rule_of_name(name: str) -> str:
    """Return what a value measures; nothing for a name of no table."""
    try:
        rule: str = quantity(name).unit
    except KeyError:
        return ""
    return rule


def _directions(numbers: Mapping[str, float], system: System) -> dict[str, str]:
    """Return remarks on vehicles that move sideways or backwards."""
    found: dict[str, str] = {}
    for vehicle, (x, y, speed, course) in SPEEDS.items():
        name = f"T{vehicle}"
        if name not in numbers or numbers.get("M") == 4:
            continue
        if x in numbers and y in numbers and (numbers[x] or numbers[y]):
            way = math.degrees(math.atan2(numbers[y], numbers[x]))
        elif course in numbers and numbers.get(speed, 1.0):
            way = numbers[course]
        else:
            continue
        facing = numbers[name] + (180.0 if vehicle == "A" else 0.0)
        if not math.isfinite(way - facing):
            continue
        apart = abs(math.remainder(way - facing, 360.0))
        if is_sideways(apart):
            found[name] = sideways_words(vehicle, apart)
    return found


def _moment(numbers: Mapping[str, float], texts: Mapping[str, str]) -> dict[str, str]:
    """Return a remark on EM = 0."""
    if numbers.get("EM") != 0 or numbers.get("M") == 4:
        return {}
    return {"EM": f"EM = {texts.get('EM', '0')}: {ONE_SPIN}"}
