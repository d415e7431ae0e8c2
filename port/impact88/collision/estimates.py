"""Estimates of an unknown yaw inertia, from the weight, or from mass, length and width.

``IA = "estimate"`` (``"estimate +- 15%"`` where tolerances are accepted) selects one of two
estimates, and the value is marked as estimated:

- with the vehicle's length and width given as LA BA (LB BB), that of a uniform rectangle,
  m (L² + W²)/12. Cars carry less of their mass at the corners than a rectangle does: expect it 5 to
  20 % high (6 to 14 % on seven crash-tested vehicles).
- from the weight alone, a line fitted to passenger cars measured by NHTSA: 1.03 W - 1206 in
  lb-ft-s², W in lb (Garrott, Monk and Chrstos, "Vehicle Inertial Parameters - Measured Values and
  Approximations", SAE paper 881767, 1988; both numbers as later texts quote them, the paper itself
  was not at hand). Compared with the 22 inertias of the chapter's Table 1, assigned by size class,
  it is 13 % low to 37 % high; on the seven crash-tested vehicles 6 to 29 % high, most for sport
  utilities and light trucks. Outside `CARS` it is refused.

With a known inertia LA BA are only the outline that is drawn. The mass is never estimated: it
follows from the weight.
"""

from collections.abc import Mapping
from math import inf
from typing import Any

from ..errors import UserError
from ..names import INERTIA, MASS
from .doubles import digits, double
from .units import SYMBOLS, SYSTEMS, System, nominal, size_of

WORD = "estimate"
"""The word in a file for an unknown inertia."""
CARS = (1500, 6000)
"""Range of weights in lb in which the line from the weight is used."""
SIZES = {"A": ("LA", "BA"), "B": ("LB", "BB")}
"""Length and width of each vehicle."""
_SLOPE = 1.03  # ft-s2 per lb of weight, as published
_OFFSET = 1206  # lb-ft-s2, as published


def with_estimates(
    texts: Mapping[str, str], source: str, units: str | None
) -> tuple[dict[str, str], dict[str, str], dict[str, float]]:
    """Return the texts with IA and IB estimated where asked for and without LA BA LB BB; the rule
    used for each estimate, by name; and the vehicles' sizes.

    ``texts``: by name, in base units; ``units``: the name of their system, None if unknown. An
    estimate has four digits. A size given with a known inertia is only the vehicle's outline.
    Raises UserError if the mass, one of two sizes or the system is missing, or if the weight is not
    that of a passenger car."""
    values, rules, outlines = dict(texts), {}, {}
    for vehicle, sizes in SIZES.items():
        name, sizes_given = f"I{vehicle}", [size for size in sizes if size in values]
        text = values.get(name, "")
        if sizes_given and len(sizes_given) < len(sizes):
            absent = next(size for size in sizes if size not in values)
            raise UserError(f"{absent} is missing beside {sizes_given[0]}", source)
        for size in sizes_given:
            outlines[size] = _number(values.pop(size), size, f"the outline of {vehicle}", source)
        if (text or not sizes_given) and text.partition(" ")[0] != WORD:
            continue
        mass = _number(values.get(f"M{vehicle}", ""), f"M{vehicle}", name, source)
        if sizes_given:
            length, width = (outlines[size] for size in sizes)
            inertia = mass * (length**2 + width**2) / 12
            rules[name] = (
                f"M{vehicle} ({sizes[0]}² + {sizes[1]}²)/12, a uniform rectangle{_bias(6, 14)}"
            )
            if units is not None and not _is_car(mass, SYSTEMS[units]):
                rules[name] += "; they were passenger cars, and this is none"
        else:
            inertia = _inertia_from_weight(mass, name, source, units)
            rules[name] = f"{_weight_words(units)}, for passenger cars{_bias(6, 29)}"
        values[name] = digits(float(f"{inertia:.4g}")) + text.removeprefix(WORD)
    return values, rules, outlines


def _weight_words(units: str | None) -> str:
    """Return the rule of the weight alone in a user's units."""
    system = SYSTEMS[units or "us"]
    mass, inertia = system.label(MASS), system.label(INERTIA)
    pounds = float(size_of(mass, MASS)[0] / SYMBOLS["lb"][1])  # type: ignore[index]
    size = float(size_of(inertia, INERTIA)[0] / SYSTEMS["us"].scale(INERTIA))  # type: ignore[index]
    slope, offset = _SLOPE * pounds / size, _OFFSET / size
    return f"{slope:.4g} times the mass in {mass}, less {offset:.4g} {inertia}"


def _bias(least: int, most: int) -> str:
    """Return in words by how much a rule exceeds the measured inertias of seven tested vehicles."""
    return f"; {least} to {most} % high on seven tested vehicles, sport utilities most"


def usual_inertia(
    vehicle: str, mass: Any, outlines: Mapping[str, float], system: System
) -> tuple[Any, Any]:
    """Return the estimated yaw inertia of a vehicle of this mass, in base units, and whether the
    rule holds for it; elementwise. Without the vehicle's size it is that of a passenger car."""
    length, width = (outlines.get(size) for size in SIZES[vehicle])
    if length and width:
        return mass * (length**2 + width**2) / 12, mass > 0
    weight = mass * float(system.scale(MASS) / SYMBOLS["lb"][1])
    scale = float(SYSTEMS["us"].scale(INERTIA) / system.scale(INERTIA))
    return (_SLOPE * weight - _OFFSET) * scale, (CARS[0] <= weight) & (weight <= CARS[1])


def _is_car(mass: float, system: System) -> bool:
    """Return True if a mass in base units is that of a passenger car, or its weight is unknown."""
    if system.is_bare:
        return True
    weight = mass * float(system.scale(MASS) / SYMBOLS["lb"][1])
    return CARS[0] <= round(weight, 6) <= CARS[1]


def _number(text: str, name: str, purpose: str, source: str) -> float:
    """Return the value, or the middle of a range. Raises UserError unless it is above 0."""
    try:
        value = double(nominal(name, text, source))
    except ValueError:
        value = 0.0
    if not 0 < value < inf:
        raise UserError(f"{purpose} needs a number above 0 for {name}", source)
    return value


def _inertia_from_weight(mass: float, name: str, source: str, units: str | None) -> float:
    """Return 1.03 W - 1206 in base units. Raises UserError outside `CARS` or without units."""
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
            f"car's, {CARS[0]:,} to {CARS[1]:,} lb, or {' and '.join(SIZES[name[1]])}",
            source,
        )
    return (_SLOPE * weight - _OFFSET) * float(SYSTEMS["us"].scale(INERTIA) / system.scale(INERTIA))
