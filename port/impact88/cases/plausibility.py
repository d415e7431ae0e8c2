"""Remarks on implausible values: a wrong unit or decimal mark, other axes, other angles.

A remark never refuses a value: a scene may be a model, a barrier or a test of the program. The
rules are elementwise, for the numbers of a case and for the columns of a table."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from ..names import LENGTH, MASS, VELOCITY, quantity
from .estimates import inertia_of_weight, is_car, rectangle_inertia, weight
from .units import View

MIN_MASS = 200.0  # kg; vehicles within these two pass without a remark
MAX_MASS = 60_000.0  # kg
MAX_ARM = 15.0  # m, from a vehicle's center of gravity to the contact point
MAX_SPEED = 500 / 3.6  # m/s
MIN_INERTIA_RATIO = 0.3  # of a yaw inertia to its estimate
MAX_INERTIA_RATIO = 3.0
MAX_SIDESLIP = 45.0  # degrees between a moving vehicle's course and its heading
SIDESLIP_TOL = 1e-9  # degrees; rounding may put an exact 45 above it


class Implausible(NamedTuple):
    """A remark on a value.

    ``where``: True or False, of a column a mask; ``words``: the remark, with places for the
    ``entry`` as written and for ``amount``, of a column an array."""

    name: str
    where: Any
    words: str
    amount: Any = 0.0


def implausible(
    values: Mapping[str, Any],
    view: View,
    courses: Mapping[str, Any],
    sizes: Mapping[str, float],
) -> Iterator[Implausible]:
    """Yield the remarks that may apply to values.

    Parameters
    ----------
    values : mapping of str to float or array
        In base units, along the listing's axes.
    view : View
        Without units, magnitudes are not looked at.
    courses : mapping of str to float or array
        The vehicles' courses in degrees, by "A" and "B".
    sizes : mapping of str to float
        LA BA LB BB in base units.
    """
    has_size = values.get("M", 6.0) != 4
    if view.units:
        yield from _magnitudes(values, view, has_size)
        for vehicle in "AB":
            if f"M{vehicle}" in values and f"I{vehicle}" in values:
                yield _inertia(vehicle, values, view, sizes, has_size)
    for vehicle, course in courses.items():
        if f"T{vehicle}" in values:
            front = values[f"T{vehicle}"] + 180.0 * (vehicle == "A")
            sideslip = abs((course - front + 180.0) % 360.0 - 180.0)
            yield Implausible(
                f"T{vehicle}",
                (sideslip > MAX_SIDESLIP + SIDESLIP_TOL) & has_size,
                f"{vehicle} moves {{amount:.0f}}° off the way it faces "
                f"({'A faces TA + 180' if vehicle == 'A' else 'B faces TB'} in the listing's "
                "axes); are velocities and headings in one convention? (axes, headings)",
                sideslip,
            )
    if "EM" in values:
        words = (
            "{entry}: the moment at the contact leaves both vehicles with one spin; "
            "no moment is EM = 1"
        )
        yield Implausible("EM", (values["EM"] == 0) & has_size, words)


_LIMITS = {
    MASS: (MIN_MASS, MAX_MASS, "{entry}: no vehicle has that mass (200 kg to 60 t)"),
    VELOCITY: (0.0, MAX_SPEED, "{entry}: no vehicle is as fast (500 km/h)"),
    LENGTH: (
        0.0,
        MAX_ARM,
        "{entry}: the contact point is more than 15 m from the center of gravity",
    ),
}
"""Smallest and largest size in m, kg, s, and the remark, by the rule of the quantity."""


def _magnitudes(values: Mapping[str, Any], view: View, has_size: Any) -> Iterator[Implausible]:
    """Yield remarks on masses, speeds and arms that no vehicle has."""
    for name, value in values.items():
        rule = quantity(name).unit
        if rule in _LIMITS and (rule != LENGTH or name in ("DA", "DB")):
            low, high, words = _LIMITS[rule]
            size = abs(value) * float(view.base_size(rule))
            is_off = ((size > 0) & (size < low)) | ((size > high) & (size < math.inf))
            yield Implausible(name, is_off & (has_size if rule == LENGTH else True), words)


def _inertia(
    vehicle: str,
    values: Mapping[str, Any],
    view: View,
    sizes: Mapping[str, float],
    has_size: Any,
) -> Implausible:
    """Return the remark on a yaw inertia far from its estimate, of a vehicle of plausible mass."""
    mass, inertia = values[f"M{vehicle}"], values[f"I{vehicle}"]
    kilograms, pounds = mass * float(view.base_size(MASS)), weight(mass, view)
    length, width = sizes.get(f"L{vehicle}"), sizes.get(f"B{vehicle}")
    is_known = (kilograms >= MIN_MASS) & (kilograms <= MAX_MASS)
    is_known = is_known & (inertia > 0) & (inertia < math.inf) & has_size
    if length and width:
        usual = rectangle_inertia(mass, length, width)
    else:
        usual, is_known = inertia_of_weight(pounds, view), is_known & is_car(pounds)
    ratio = inertia / (usual + (usual == 0))
    is_off = (ratio < MIN_INERTIA_RATIO) | (ratio > MAX_INERTIA_RATIO)
    words = f'{{entry}} is {{amount:.2g}} times what I{vehicle} = "estimate" gives'
    return Implausible(f"I{vehicle}", is_known & is_off, words, ratio)
