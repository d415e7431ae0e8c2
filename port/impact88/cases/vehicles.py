"""Vehicles: estimates of a yaw inertia that was not measured, and limits beyond which a value is
implausible.

``IA = "estimate"`` (also ``"estimate +- 20 %"``) takes one of two rules:

- with the vehicle's length and width given as LA and BA, a uniform rectangle, m (L² + W²)/12. Cars
  carry less of their mass at the corners: it is 6 to 14 % high on seven crash-tested vehicles.
- from the weight alone, a line fitted to passenger cars measured by NHTSA, 1.03 W - 1206 in
  lb-ft-s² for W in lb (Garrott, Monk and Chrstos, SAE paper 881767, 1988, as later texts quote it;
  the paper itself was not at hand). On the same seven vehicles it is 6 to 29 % high, most for sport
  utilities and light trucks. Other weights than passenger cars' are refused.

A remark never refuses a value: a scene may be a model, a barrier or a test of the program.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf, nan
from typing import Any

from ..decimals import to_text
from ..errors import UserError
from ..names import INERTIA, LENGTH, MASS, SPIN, VELOCITY, quantity
from .amounts import Amount
from .motion import Amounts
from .units import POUND, View

ESTIMATE = "estimate"
SIZES = ("LA", "BA", "LB", "BB")
"""Length and width of each vehicle, for an estimate of its inertia alone."""
MIN_WEIGHT = 1500  # lb; cars of the fitted sample lie between these two
MAX_WEIGHT = 6000  # lb
SLOPE = 1.03  # ft-s² for each lb, as published
OFFSET = 1206.0  # lb-ft-s², as published

LIMITS = {
    MASS: (200.0, 60_000.0, "no vehicle has that mass (200 kg to 60 t)"),
    VELOCITY: (0.0, 500 / 3.6, "no vehicle is as fast (500 km/h)"),
    SPIN: (0.0, 20.0, "no vehicle spins as fast (20 rad/s, three turns a second)"),
    LENGTH: (0.0, 15.0, "the contact point is more than 15 m from the center of gravity"),
    # a motorcycle has .65 m, a car .8 to 1.6, a tractor with semitrailer 5.2
    INERTIA: (0.5**2, 6.0**2, "no vehicle has that radius of gyration (0.5 to 6 m)"),
}
"""Smallest and largest size in m, kg, s of what a vehicle has, by the rule of the quantity; of a
yaw inertia for each kg."""
MAX_SIDESLIP = 45.0 + 1e-9  # degrees from a course to the heading; rounding may exceed an exact 45


def estimate(name: str, text: str, amounts: Amounts, view: View) -> tuple[str, str]:
    """Return the entry of an estimated yaw inertia, of four digits in units of the view, and a
    remark.

    Parameters
    ----------
    name : {"IA", "IB"}
        The inertia.
    text : str
        The entry as written: what follows its first word, a tolerance, is kept.
    amounts : mapping of str to Amount
        The mass, and the length and width if they are known.
    view : View
        Its units are those of the result.

    Raises
    ------
    UserError
        Without a mass; without length and width, for the weight of no passenger car, and without
        units.
    """
    vehicle = name[1]
    pair = f"L{vehicle}", f"B{vehicle}"
    mass = amounts.get(f"M{vehicle}", Amount.exactly(0.0)).value
    sizes = [amounts[size].value for size in pair if size in amounts]
    pounds = round(mass * float(view.base_size(MASS) / POUND), 6)  # 1,500 lb from kg
    if mass > 0 and len(sizes) == 2:
        value = mass * sum(size**2 for size in sizes) / 12
        rule = "mass (length² + width²)/12, a uniform rectangle; 6 to 14 % high on seven cars"
    elif view.units and not sizes and MIN_WEIGHT <= pounds <= MAX_WEIGHT:
        value = (SLOPE * pounds - OFFSET) * float(view.map(name, "lb-ft-s2")[0])
        rule = (
            f"{SLOPE} times the mass in lb, less {OFFSET:.0f} lb-ft-s2, for passenger cars; "
            "6 to 29 % high on seven of them"
        )
    else:
        raise UserError(
            f"{name} = {ESTIMATE} needs M{vehicle}, for passenger cars of {MIN_WEIGHT:,} to "
            f'{MAX_WEIGHT:,} lb, with units = "us" or another; expected {name}, or '
            f"M{vehicle} and {' and '.join(pair)}"
        )
    number = f"{to_text(float(f'{value:.4g}'))} {view.unit(name)}"
    return number + text.removeprefix(ESTIMATE), f"{name} = {number} is estimated: {rule}"


def implausible(
    values: Mapping[str, Any], view: View, courses: Mapping[str, Any]
) -> Iterator[tuple[str, Any, str]]:
    """Yield remarks on implausible values, which a wrong unit, decimal mark or direction may have
    made: name, True where the remark applies (of columns a mask), and words.

    Parameters
    ----------
    values : mapping of str to float or array
        In base units, along the listing's axes.
    view : View
        Without units, magnitudes are not looked at.
    courses : mapping of str to float or array
        The vehicles' courses in degrees, by "TA" and "TB".
    """
    is_body = values.get("M", 6.0) != 4
    for name, value in values.items() if view.units else ():
        rule = quantity(name).unit
        if rule in LIMITS:
            low, high, words = LIMITS[rule]
            if rule == INERTIA:
                mass = values.get(f"M{name[1]}", nan) * float(view.base_size(MASS))
                low, high = low * mass, high * mass
            size: Any = abs(value) * float(view.base_size(rule))
            is_off = (size < low) | ((size > high) & (size < inf))
            yield name, is_off & ((rule in (MASS, VELOCITY)) | is_body), words
    for name, course in courses.items():
        if name in values:
            front = values[name] + 180.0 * (name == "TA")
            yield (
                name,
                (abs((course - front + 180.0) % 360.0 - 180.0) > MAX_SIDESLIP) & is_body,
                f"{name[1]} moves more than 45° off the way it faces (A faces TA + 180 and B faces "
                "TB in the listing's axes); are velocities and headings in one convention? (axes, "
                "headings)",
            )
    yield (
        "EM",
        (values.get("EM", 1.0) == 0) & is_body,
        "the moment at the contact leaves both vehicles with one spin; no moment is EM = 1",
    )
