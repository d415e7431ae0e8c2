"""Estimates of a yaw inertia that was not measured.

``IA = "estimate"`` (also ``"estimate +- 20 %"``) takes one of two rules:

- with the vehicle's length and width given as LA and BA, a uniform rectangle, m (L² + W²)/12. Cars
  carry less of their mass at the corners: it is 6 to 14 % high on seven crash-tested vehicles.
- from the weight alone, a line fitted to passenger cars measured by NHTSA, 1.03 W - 1206 in
  lb-ft-s² for W in lb (Garrott, Monk and Chrstos, SAE paper 881767, 1988, as later texts quote it;
  the paper itself was not at hand). On the same seven vehicles it is 6 to 29 % high, most for sport
  utilities and light trucks. Other weights than passenger cars' are refused.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..errors import UserError
from ..names import INERTIA, MASS
from .units import POUND, View, unit_of

MIN_WEIGHT = 1500  # lb; cars of the fitted sample lie between these two
MAX_WEIGHT = 6000  # lb
SLOPE = 1.03  # ft-s² for each lb, as published
OFFSET = 1206.0  # lb-ft-s², as published


def rectangle_inertia(mass: Any, length: float, width: float) -> Any:
    """Return the yaw inertia of a uniform rectangle, m (L² + W²)/12; masses may be an array."""
    return mass * (length**2 + width**2) / 12


def weight(mass: Any, view: View) -> Any:
    """Return the weight in lb of a mass in base units."""
    return mass * float(view.base_size(MASS) / POUND)


def inertia_of_weight(pounds: Any, view: View) -> Any:
    """Return the yaw inertia of a passenger car of a weight, in base units."""
    size = unit_of(INERTIA, "lb-ft-s2").size / view.base_size(INERTIA)
    return (SLOPE * pounds - OFFSET) * float(size)


def is_car(pounds: Any) -> Any:
    """Return True for the weight of a passenger car."""
    return (pounds >= MIN_WEIGHT - 1e-6) & (pounds <= MAX_WEIGHT + 1e-6)  # 1,500 lb from kg


def estimate(name: str, mass: float, sizes: Sequence[float], view: View) -> tuple[float, str]:
    """Return an estimated yaw inertia of four digits, in base units, and its rule in words.

    Parameters
    ----------
    name : {"IA", "IB"}
        The inertia.
    mass : float
        In base units.
    sizes : sequence of float
        Length and width in base units, or nothing.
    view : View
        Its units are those of the words.

    Raises
    ------
    UserError
        Without sizes, for the weight of no passenger car, and without units.
    """
    vehicle = name[1]
    if not mass > 0:
        raise UserError(f"{name} = estimate needs M{vehicle} above 0")
    pounds = weight(mass, view)
    if sizes:
        value = rectangle_inertia(mass, sizes[0], sizes[1])
        rule = (
            f"M{vehicle} (L{vehicle}² + B{vehicle}²)/12, a uniform rectangle; "
            "6 to 14 % high on seven passenger cars"
        )
        if view.units and not is_car(pounds):
            rule += ", and this is none"
    elif not view.units:
        raise UserError(
            f'{name} = estimate from the weight needs units = "us" (or metric, si, chapter); '
            f"or give L{vehicle} and B{vehicle}"
        )
    elif not is_car(pounds):
        raise UserError(
            f"{name} = estimate from the weight is for passenger cars of {MIN_WEIGHT:,} to "
            f"{MAX_WEIGHT:,} lb, and M{vehicle} is {pounds:,.0f} lb; "
            f"expected {name}, or L{vehicle} and B{vehicle}"
        )
    else:
        value = inertia_of_weight(pounds, view)
        rule = (
            f"{SLOPE} times the mass in lb, less {OFFSET:.0f} lb-ft-s2, for passenger cars; "
            "6 to 29 % high on seven of them"
        )
    return float(f"{value:.4g}"), rule
