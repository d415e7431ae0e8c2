"""Remarks on implausible values: a wrong unit or decimal mark, other axes, other angles.

A remark never refuses a value: a scene may be a model, a barrier or a test of the program.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from ..names import MASS, VELOCITY, quantity

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from .units import System

MIN_MASS = 200.0  # kg; vehicles within these two pass without a remark
MAX_MASS = 60_000.0  # kg
MAX_ARM = 15.0  # m, from a vehicle's center of gravity to the contact point
MAX_SPEED = 500 / 3.6  # m/s
INERTIA_RATIO = (0.3, 3.0)
"""Range of a yaw inertia divided by its estimate (`collision.estimates`)."""
MAX_SIDESLIP = 45.0  # degrees between a moving vehicle's course and its heading
_SIDESLIP_TOL = 1e-9  # degrees; rounding may put an exact 45 slightly above
BEYOND_ARM = "the contact point is more than 15 m from the center of gravity; is its unit as meant?"
ONE_SPIN = "the moment at the contact leaves both vehicles with one spin; no moment is EM = 1"
VELOCITY_NAMES = {"A": ("UX", "UY", "SA", "HA"), "B": ("VX", "VY", "SB", "HB")}
"""Components, speed and course of each vehicle's velocity before the impact."""
MEASURES = {
    MASS: (
        MIN_MASS,
        MAX_MASS,
        "no vehicle has that mass (200 kg to 60 t); is its unit as meant?",
    ),
    VELOCITY: (
        -MAX_SPEED,
        MAX_SPEED,
        "no vehicle is as fast (500 km/h); is its unit as meant?",
    ),
}


def remarks(
    numbers: Mapping[str, float],
    texts: Mapping[str, str],
    system: System | None,
    outlines: Mapping[str, float],
) -> dict[str, str]:
    """Return remarks on implausible values, by name.

    Parameters
    ----------
    numbers
        Nominal values in base units and the listing's axes.
    texts
        The entries as written.
    system
        Units the values are shown in, None without units: magnitudes are not checked then.
    outlines
        LA BA LB BB, in base units.
    """
    return {
        **({} if system is None or system.is_bare else _sizes(numbers, texts, system, outlines)),
        **_directions(numbers),
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

    remarks_by_name: dict[str, str] = {}
    for name, value in numbers.items():
        rule = rule_of_name(name)
        size = value * float(system.scale(rule)) if rule in MEASURES else math.nan
        low, high, words = MEASURES.get(rule, (0.0, 0.0, ""))
        if rule == "mass" and not size > 0:
            continue  # refused elsewhere, or ends the program
        if rule in MEASURES and math.isfinite(size) and not low <= size <= high:
            remarks_by_name[name] = f"{name} = {texts.get(name, '')}: {words}"
    arm = {"DA": "DA", "DB": "DB", "CAF": "DA", "CAL": "DA", "CBF": "DB", "CBL": "DB"}
    longest = MAX_ARM / float(system.scale("length"))
    for name in ("DA", "DB"):
        if abs(numbers.get(name, 0.0)) > longest and numbers.get("M") != 4:
            entries = [
                f"{n} = {texts[n]}"
                for n, names_replaced in arm.items()
                if names_replaced == name and n in texts
            ]
            remarks_by_name[name] = f"{', '.join(entries)}: {BEYOND_ARM}"
    for vehicle in "AB" if numbers.get("M") != 4 else "":
        name, mass = f"I{vehicle}", numbers.get(f"M{vehicle}", math.nan)
        inertia = numbers.get(name, math.nan)
        estimate = rule_of(vehicle, mass, outlines, system)
        if estimate is None or not 0 < inertia < math.inf or f"M{vehicle}" in remarks_by_name:
            continue
        ratio = inertia / estimate
        if not INERTIA_RATIO[0] <= ratio <= INERTIA_RATIO[1]:
            remarks_by_name[name] = inertia_words(name, texts.get(name, ""), ratio)
    return remarks_by_name


def inertia_words(name: str, text: str, ratio: float) -> str:
    """Return the remark on an inertia that is ``ratio`` times its estimate."""
    return (
        f'{name} = {text} is {ratio:.2g} times what {name} = "estimate" gives; are its unit and '
        "the mass as meant?"
    )


def is_sideways(sideslip: Any) -> Any:
    """Return True if a course that many degrees off the heading is sideways, elementwise."""
    return sideslip > MAX_SIDESLIP + _SIDESLIP_TOL


def sideways_words(vehicle: str, sideslip: float) -> str:
    """Return the remark on a vehicle that moves ``sideslip`` degrees off its heading."""
    rule = "A faces TA + 180" if vehicle == "A" else "B faces TB"
    return (
        f"{vehicle} moves {sideslip:.0f}° off the way it faces ({rule} in the listing's axes); are "
        "velocities and headings in one convention? (axes, headings)"
    )


def rule_of_name(name: str) -> str:
    """Return the unit rule of a value ("length/time"); "" for an unknown name."""
    try:
        rule: str = quantity(name).unit
    except KeyError:
        return ""
    return rule


def _directions(numbers: Mapping[str, float]) -> dict[str, str]:
    """Return remarks on vehicles that move sideways or backwards."""
    remarks_by_name: dict[str, str] = {}
    for vehicle, (x, y, speed, course) in VELOCITY_NAMES.items():
        name = f"T{vehicle}"
        if name not in numbers or numbers.get("M") == 4:
            continue
        if x in numbers and y in numbers and (numbers[x] or numbers[y]):
            direction = math.degrees(math.atan2(numbers[y], numbers[x]))
        elif course in numbers and numbers.get(speed, 1.0):
            direction = numbers[course]
        else:
            continue
        facing = numbers[name] + (180.0 if vehicle == "A" else 0.0)
        if not math.isfinite(direction - facing):
            continue
        sideslip = abs(math.remainder(direction - facing, 360.0))
        if is_sideways(sideslip):
            remarks_by_name[name] = sideways_words(vehicle, sideslip)
    return remarks_by_name


def _moment(numbers: Mapping[str, float], texts: Mapping[str, str]) -> dict[str, str]:
    """Return a remark on EM = 0."""
    if numbers.get("EM") != 0 or numbers.get("M") == 4:
        return {}
    return {"EM": f"EM = {texts.get('EM', '0')}: {ONE_SPIN}"}
