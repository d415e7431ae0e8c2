"""Remarks on implausible values: a wrong unit or decimal mark, other axes, other angles; and values
that no impact has.

A remark never refuses a value: a scene may be a model, a barrier or a test of the program. The
rules are elementwise, for the numbers of a case and for the columns of a table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf, nan
from typing import Any, NamedTuple

from ..names import INERTIA, LENGTH, MASS, VELOCITY, quantity
from .units import View

LIMITS = {
    MASS: (200.0, 60_000.0, "no vehicle has that mass (200 kg to 60 t)"),
    VELOCITY: (0.0, 500 / 3.6, "no vehicle is as fast (500 km/h)"),
    LENGTH: (0.0, 15.0, "the contact point is more than 15 m from the center of gravity"),
    # a motorcycle has .65 m, a car .8 to 1.6, a tractor with semitrailer 5.2
    INERTIA: (
        0.5**2,
        6.0**2,
        "no vehicle has that radius of gyration (0.5 to 6 m; below 5 t, to 3.5)",
    ),
}
"""Smallest and largest size in m, kg, s of what a vehicle has, by the rule of the quantity; of a
yaw inertia for each kg."""
LIGHT = 5000.0  # kg
LIGHT_RADIUS = 3.5  # m: lb-ft² of a car typed for lb-ft-s² give 4 and more
MAX_SIDESLIP = 45.0 + 1e-9  # degrees from a course to the heading; rounding may exceed an exact 45
RESISTANCES = {"UX": "MA", "UY": "MA", "VX": "MB", "VY": "MB", "WA": "IA", "WB": "IB"}
"""Velocities, each with the mass or inertia that is infinite for a barrier."""


class Remark(NamedTuple):
    """A remark on a value; ``where``: True or False, of a column a mask."""

    name: str
    where: Any
    words: str


def implausible(
    values: Mapping[str, Any], view: View, courses: Mapping[str, Any]
) -> Iterator[Remark]:
    """Yield the remarks that may apply to values.

    Parameters
    ----------
    values : mapping of str to float or array
        In base units, along the listing's axes.
    view : View
        Without units, magnitudes are not looked at.
    courses : mapping of str to float or array
        The vehicles' courses in degrees, by "A" and "B".
    """
    has_size = values.get("M", 6.0) != 4
    for name, value in values.items() if view.units else ():
        rule = quantity(name).unit
        if rule in LIMITS and (rule != LENGTH or name in ("DA", "DB")):
            low, high, words = LIMITS[rule]
            size: Any = abs(value) * float(view.base_size(rule))
            if rule == INERTIA:
                mass = values.get(f"M{name[1]}", nan) * float(view.base_size(MASS))
                high = high - (high - LIGHT_RADIUS**2) * (mass < LIGHT)
                low, high = low * mass, high * mass
            is_off = (size < low) | ((size > high) & (size < inf))
            yield Remark(name, is_off & ((rule in (MASS, VELOCITY)) | has_size), words)
    for vehicle, course in courses.items():
        if f"T{vehicle}" in values:
            front = values[f"T{vehicle}"] + 180.0 * (vehicle == "A")
            sideslip = abs((course - front + 180.0) % 360.0 - 180.0)
            words = (
                f"{vehicle} moves more than 45° off the way it faces (A faces TA + 180 and B faces "
                "TB in the listing's axes); are velocities and headings in one convention? (axes, "
                "headings)"
            )
            yield Remark(f"T{vehicle}", (sideslip > MAX_SIDESLIP) & has_size, words)
    words = "the moment at the contact leaves both vehicles with one spin; no moment is EM = 1"
    yield Remark("EM", (values.get("EM", 1.0) == 0) & has_size, words)


def impossible(values: Mapping[str, Any]) -> Iterator[Remark]:
    """Yield the reasons why values may be those of no impact; ``values`` as for `implausible`."""
    has_size = values["M"] != 4
    yield Remark("M", has_size & (values["M"] != 6), "is neither 6 nor 4 (point masses)")
    for name in ("MA", "MB", "IA", "IB"):
        is_used = name[0] == "M" or has_size
        yield Remark(name, (values.get(name, 1.0) <= 0) & is_used, "is not above 0")
    for name, inertia in RESISTANCES.items():
        moves = (values.get(inertia, 0.0) == inf) & (values.get(name, 0.0) != 0)
        yield Remark(name, moves, f"is not 0, and {inertia} is infinite: a barrier rests")
