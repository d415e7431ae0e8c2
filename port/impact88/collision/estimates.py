"""Yaw inertia where none is known, estimated from the weight, or from mass, length and width.

``IA = "estimate"`` (``"estimate +- 15%"`` where tolerances are taken) stands for one of two
estimates, and the result is marked as one:

- with the vehicle's length and width given as LA BA (LB BB), a uniform rectangle's, m (L² + W²)/12.
  Cars carry less of their mass at the corners than a rectangle does: expect it 5 to 20 % high (6
  to 14 % on seven vehicles that were crash tested).
- from the weight alone, the straight line fitted to passenger cars that NHTSA measured: 1.03 W -
  1206 in lb-ft-s², W in lb (Garrott, Monk and Chrstos, "Vehicle Inertial Parameters - Measured
  Values and Approximations", SAE paper 881767, 1988; its two numbers as later texts quote them, the
  paper itself was not at hand). Beside the 22 inertias of the chapter's Table 1, assigned by class
  of size, it is 13 % low to 37 % high; on the seven 6 to 29 % high. Of sport utilities and light
  trucks it is highest; outside `CARS` it is refused.

Beside a known inertia LA BA are the outline that is drawn. A weight needs no estimate of its mass.
"""

from collections.abc import Mapping
from math import inf
from typing import Any

from ..errors import UserError
from .doubles import digits, double
from .units import INERTIA, MASS, SYMBOLS, SYSTEMS, System, nominal

WORD = "estimate"
"""What stands in a file for an inertia that is not known."""
CARS = (1500, 6000)
"""Weights in lb between which the line from the weight is used."""
SIZES = {"A": ("LA", "BA"), "B": ("LB", "BB")}
"""Length and width of each vehicle."""
_SLOPE, _OFFSET = 1.03, 1206
"""Of the line from the weight, as published."""


def with_estimates(
    texts: Mapping[str, str], source: str, units: str | None
) -> tuple[dict[str, str], dict[str, str], dict[str, float]]:
    """The texts with estimates of IA and IB where they are asked for, without LA BA LB BB; for each
    estimated name how it was found; and the vehicles' sizes that were given. ``texts``: by name, in
    base units; ``units``: the name of their system, None if it is not known. An estimate has four
    digits. Beside a known inertia a size is the vehicle's outline and no more. Raises UserError
    where the mass, one of two sizes or the system is missing, and for a weight that is no car's."""
    values, how, outlines = dict(texts), {}, {}
    for vehicle, sizes in SIZES.items():
        name, given = f"I{vehicle}", [size for size in sizes if size in values]
        text = values.get(name, "")
        if given and len(given) < len(sizes):
            absent = next(size for size in sizes if size not in values)
            raise UserError(f"{absent} is missing beside {given[0]}", source)
        for size in given:
            outlines[size] = _number(values.pop(size), size, f"the outline of {vehicle}", source)
        if (text or not given) and text.partition(" ")[0] != WORD:
            continue
        mass = _number(values.get(f"M{vehicle}", ""), f"M{vehicle}", name, source)
        if given:
            length, width = (outlines[size] for size in sizes)
            inertia = mass * (length**2 + width**2) / 12
            how[name] = (
                f"M{vehicle} ({sizes[0]}² + {sizes[1]}²)/12, a uniform rectangle{_bias(6, 14)}"
            )
        else:
            inertia = _of_weight(mass, name, source, units)
            how[name] = f"1.03 W - 1206 for passenger cars, from the weight alone{_bias(6, 29)}"
        values[name] = digits(float(f"{inertia:.4g}")) + text.removeprefix(WORD)
    return values, how, outlines


def _bias(least: int, most: int) -> str:
    """Return how far a rule lay above the yaw inertias of seven vehicles that were crash tested,
    the sport utilities farthest."""
    return f"; {least} to {most} % high on seven tested vehicles, sport utilities most"


def rule_of(
    vehicle: str, mass: float, outlines: Mapping[str, float], system: System
) -> float | None:
    """Return the yaw inertia that the rules give a vehicle of that mass, in base units; None where
    neither its size is known nor its weight is a car's."""
    if not 0 < mass < inf:
        return None
    length, width = (outlines.get(size) for size in SIZES[vehicle])
    if length and width:
        return mass * (length**2 + width**2) / 12
    if system.is_bare:
        return None
    weight, inertia = weight_line(mass, system)
    return float(inertia) if CARS[0] <= weight <= CARS[1] else None


def weight_line(mass: Any, system: System) -> tuple[Any, Any]:
    """Return the weight in lb, and the inertia that the line from it gives, in base units; of an
    array as well as of a number. The line is for `CARS`."""
    weight = mass * float(system.scale(MASS) / SYMBOLS["lb"][1])
    scale = float(SYSTEMS["us"].scale(INERTIA) / system.scale(INERTIA))
    return weight, (_SLOPE * weight - _OFFSET) * scale


def _number(text: str, name: str, wanted: str, source: str) -> float:
    """The value, or the middle of one known within limits."""
    try:
        value = double(nominal(name, text, source))
    except ValueError:
        value = 0.0
    if not 0 < value < inf:
        raise UserError(f"{wanted} needs a number above 0 for {name}", source)
    return value


def _of_weight(mass: float, name: str, source: str, units: str | None) -> float:
    if units is None:
        raise UserError(
            f'{name} is to be estimated from the weight; expected units = "us" (or metric, si, '
            "chapter) in the file, or the vehicle's length and width",
            source,
        )
    system = SYSTEMS[units]
    weight = round(mass * float(system.scale(MASS) / SYMBOLS["lb"][1]), 6)
    if not CARS[0] <= weight <= CARS[1]:
        raise UserError(
            f"{name} is to be estimated from the weight, {weight:.0f} lb; expected a passenger "
            f"car's, {CARS[0]:,} to {CARS[1]:,} lb",
            source,
        )
    return (_SLOPE * weight - _OFFSET) * float(SYSTEMS["us"].scale(INERTIA) / system.scale(INERTIA))
