"""Remarks on implausible values: a wrong unit or decimal mark, other axes, other angles.

A remark never refuses a value: a scene may be a model, a barrier or a test of the program. The
rules are elementwise: for the numbers of a scene, and for the columns of a table.
"""

from __future__ import annotations

import math
from collections import namedtuple
from collections.abc import Iterator, Mapping

from ..names import LENGTH, MASS, VELOCITY, quantity

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from .units import System

MIN_MASS = 200.0  # kg; vehicles within these two pass without a remark
MAX_MASS = 60_000.0  # kg
MAX_ARM = 15.0  # m, from a vehicle's center of gravity to the contact point
MAX_SPEED = 500 / 3.6  # m/s
MIN_INERTIA_RATIO = 0.3  # of a yaw inertia to its estimate (`collision.estimates`)
MAX_INERTIA_RATIO = 3.0
MAX_SIDESLIP = 45.0  # degrees between a moving vehicle's course and its heading
_SIDESLIP_TOL = 1e-9  # degrees; rounding may put an exact 45 slightly above
_MASS_WORDS = "{entry}: no vehicle has that mass (200 kg to 60 t); is its unit as meant?"
_SPEED_WORDS = "{entry}: no vehicle is as fast (500 km/h); is its unit as meant?"
_ARM_WORDS = (
    "{entry}: the contact point is more than 15 m from the center of gravity; is its unit as meant?"
)
_INERTIA_WORDS = (
    '{entry} is {amount:.2g} times what I%s = "estimate" gives; are its unit and the mass as meant?'
)
_SIDEWAYS_WORDS = (
    "%s moves {amount:.0f}° off the way it faces (%s in the listing's axes); are "
    "velocities and headings in one convention? (axes, headings)"
)
_FACING = {"A": "A faces TA + 180", "B": "B faces TB"}
_SPIN_WORDS = (
    "{entry}: the moment at the contact leaves both vehicles with one spin; no moment is EM = 1"
)
_ARMS = {"DA": ("DA", "CAF", "CAL"), "DB": ("DB", "CBF", "CBL")}
"""The entries that an arm comes from."""
_VELOCITIES = {"A": ("UX", "UY", "SA", "HA"), "B": ("VX", "VY", "SB", "HB")}
"""Components, speed and course of each vehicle's velocity before the impact."""


class Implausible(namedtuple("Implausible", "name where words amount", defaults=(0.0,))):
    """A finding on a value. ``where`` it is implausible: True or False, of a column a mask;
    ``words``: the remark, with places for the entry as written and for ``amount``, of a column an
    array."""

    __slots__ = ()


def implausible(
    values: Mapping[str, Any],
    courses: Mapping[str, Any],
    system: System | None,
    outlines: Mapping[str, float],
) -> Iterator[Implausible]:
    """Yield where values are implausible.

    Parameters
    ----------
    values
        Numbers, or columns of numbers, in base units and the listing's axes.
    courses
        The courses of the vehicles before the impact in degrees, by "A" and "B".
    system
        Units the values are shown in, None without units: magnitudes are not checked then.
    outlines
        LA BA LB BB, in base units.
    """
    has_size = values.get("M") != 4
    if system is not None and not system.is_bare:
        yield from _sizes(values, system, has_size)
        yield from _inertias(values, system, outlines, has_size)
    for vehicle, course in courses.items():
        if (name := f"T{vehicle}") in values:
            turn = 180.0 if vehicle == "A" else 0.0
            sideslip = abs((course - values[name] - turn + 180.0) % 360.0 - 180.0)
            is_sideways = sideslip > MAX_SIDESLIP + _SIDESLIP_TOL
            words = _SIDEWAYS_WORDS % (vehicle, _FACING[vehicle])
            yield Implausible(name, is_sideways & has_size, words, sideslip)
    yield Implausible("EM", (values.get("EM", 1.0) == 0) & has_size, _SPIN_WORDS)


def _sizes(values: Mapping[str, Any], system: System, has_size: Any) -> Iterator[Implausible]:
    """Yield implausible masses, speeds and arms."""
    mass_scale, speed_scale, arm_scale = (
        float(system.scale(rule)) for rule in (MASS, VELOCITY, LENGTH)
    )
    for name, value in values.items():
        rule = _rule_of(name)
        if rule == MASS:  # one not above 0 is refused elsewhere, or ends the program
            mass = value * mass_scale
            is_off = (mass > 0) & (mass < MIN_MASS) | (mass > MAX_MASS) & (mass < math.inf)
            yield Implausible(name, is_off, _MASS_WORDS)
        elif rule == VELOCITY:
            speed = abs(value) * speed_scale
            yield Implausible(name, (speed > MAX_SPEED) & (speed < math.inf), _SPEED_WORDS)
        elif name in _ARMS:
            arm = abs(value) * arm_scale
            is_off = (arm > MAX_ARM) & (arm < math.inf) & has_size
            yield Implausible(name, is_off, _ARM_WORDS)


def _inertias(
    values: Mapping[str, Any], system: System, outlines: Mapping[str, float], has_size: Any
) -> Iterator[Implausible]:
    """Yield yaw inertias far from their estimates, of vehicles with a plausible mass."""
    from .estimates import usual_inertia

    for vehicle in "AB":
        mass, inertia = values.get(f"M{vehicle}"), values.get(f"I{vehicle}")
        if mass is None or inertia is None:
            continue
        kilograms = mass * float(system.scale(MASS))
        usual, is_known = usual_inertia(vehicle, mass, outlines, system)
        is_known = is_known & (kilograms >= MIN_MASS) & (kilograms <= MAX_MASS) & has_size
        is_known = is_known & (inertia > 0) & (inertia < math.inf)
        if is_known if isinstance(is_known, bool) else is_known.any():
            ratio = inertia / usual
            is_off = is_known & ((ratio < MIN_INERTIA_RATIO) | (ratio > MAX_INERTIA_RATIO))
            yield Implausible(f"I{vehicle}", is_off, _INERTIA_WORDS % vehicle, ratio)


def remarks(
    numbers: Mapping[str, float],
    texts: Mapping[str, str],
    system: System | None,
    outlines: Mapping[str, float],
) -> dict[str, str]:
    """Return remarks on the implausible values of a scene, by name.

    Parameters
    ----------
    numbers
        Nominal values, as `implausible` takes them.
    texts
        The entries as written.
    system, outlines
        As for `implausible`.
    """
    remarks_by_name = {}
    for name, is_off, words, amount in implausible(numbers, courses_of(numbers), system, outlines):
        if is_off:
            entries = [f"{n} = {texts[n]}" for n in _ARMS.get(name, (name,)) if n in texts]
            remarks_by_name[name] = words.format(entry=", ".join(entries), amount=amount)
    return remarks_by_name


def _rule_of(name: str) -> str:
    """Return the unit rule of a value ("length/time"); "" for an unknown name."""
    try:
        rule: str = quantity(name).unit
    except KeyError:
        return ""
    return rule


def courses_of(numbers: Mapping[str, float]) -> dict[str, float]:
    """Return the vehicles' courses before the impact in degrees from the x axis, by "A" and "B";
    without those of vehicles at rest."""
    courses = {}
    for vehicle, (x, y, speed, course) in _VELOCITIES.items():
        if x in numbers and y in numbers and (numbers[x] or numbers[y]):
            courses[vehicle] = math.degrees(math.atan2(numbers[y], numbers[x]))
        elif course in numbers and numbers.get(speed, 1.0):
            courses[vehicle] = numbers[course]
    return courses
