"""Yaw inertia where none is known, estimated from the weight, or from mass, length and width.

In a scene or a reconstruction file ``IA = "estimate"`` (``"estimate +- 15%"`` where tolerances are
taken) stands for one of two estimates, and the result is always marked as one:

- with the length and width of the vehicle given as LA BA (LB BB), the inertia of a uniform
  rectangle, m (L² + W²)/12, in any consistent units. Cars carry less of their mass at the corners
  than a rectangle does: expect it 5 to 20 % high.
- from the weight alone, by the straight line fitted to passenger cars that NHTSA measured:
  1.03 W - 1206 in lb-ft-s², W in lb (Garrott, Monk and Chrstos, "Vehicle Inertial Parameters -
  Measured Values and Approximations", SAE paper 881767, 1988; its two numbers as later texts quote
  them, the paper itself was not at hand). Beside the inertias of the 22 vehicles of the chapter's
  Table 1, which were assigned by class of size, it is 13 % low to 37 % high. It is for cars: sport
  utilities and light trucks lie lower, and outside `CARS` it is refused.

The mass needs no estimate: "3091 lb" is a weight, and becomes the mass it has (`impact88.units`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from math import inf

from .doubles import double, is_number
from .errors import UserError

WORD = "estimate"
"""What stands in a file for an inertia that is not known."""
CARS = (1500, 6000)
"""Weights in lb between which the line from the weight is used."""
SIZES = {"A": ("LA", "BA"), "B": ("LB", "BB")}
"""Length and width of each vehicle."""
_SLOPE, _OFFSET = 1.03, 1206
_BEGINS_WITH_A_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def wanted(texts: Mapping[str, str]) -> bool:
    """Whether the texts of a file ask for an estimate."""
    sizes = {name for names in SIZES.values() for name in names}
    return not sizes.isdisjoint(texts) or any(_asked(texts.get(name, "")) for name in ("IA", "IB"))


def with_estimates(
    texts: Mapping[str, str], source: str, units: str | None
) -> tuple[dict[str, str], dict[str, str]]:
    """The texts with estimates of IA and IB where they are asked for, without LA BA LB BB; and for
    each estimated name how it was found.

    ``texts``: by name, in base units; ``units``: the name of their system, None if it is not known.
    An estimate has four digits. Raises UserError where the mass, a size or the system is missing,
    where the inertia is given beside its vehicle's size, and for a weight that is no car's.
    """
    values, how = dict(texts), {}
    for vehicle, sizes in SIZES.items():
        name, given = f"I{vehicle}", [size for size in sizes if size in values]
        text = values.get(name, "")
        asked = _asked(text)
        if not given and not asked:
            continue
        if given and text and not asked:
            raise UserError(f'{name} and {given[0]} are both given; expected "{WORD}"', source)
        if given and len(given) < len(sizes):
            absent = next(size for size in sizes if size not in values)
            raise UserError(f"{absent} is missing beside {given[0]}", source)
        mass = _number(values.get(f"M{vehicle}", ""), f"M{vehicle}", name, source)
        if given:
            length, width = (_number(values.pop(size), size, name, source) for size in sizes)
            inertia = mass * (length**2 + width**2) / 12
            how[name] = f"M{vehicle} ({sizes[0]}² + {sizes[1]}²)/12, a uniform rectangle"
        else:
            inertia = _of_weight(mass, name, source, units)
            how[name] = "1.03 W - 1206 for passenger cars, from the weight alone"
        values[name] = _four_digits(inertia) + text.removeprefix(WORD)
    return values, how


def _asked(text: str) -> bool:
    return text.partition(" ")[0] == WORD


def _number(text: str, name: str, wanted: str, source: str) -> float:
    """What ``text`` begins with: the middle of a value within limits, or the value."""
    match = _BEGINS_WITH_A_NUMBER.match(text.strip())
    if not match or not is_number(match[0]) or not 0 < (value := double(match[0])) < inf:
        raise UserError(
            f"{wanted} is to be estimated; expected a number above 0 for {name}", source
        )
    return value


def _of_weight(mass: float, name: str, source: str, units: str | None) -> float:
    if units is None:
        raise UserError(
            f'{name} is to be estimated from the weight; expected units = "us" (or metric, si, '
            "chapter) in the file, or the vehicle's length and width",
            source,
        )
    from .units import INERTIA, MASS, SYSTEMS, UNITS

    system = SYSTEMS[units]
    weight = round(mass * float(system.scale(MASS) / UNITS["lb"][1]), 6)
    if not CARS[0] <= weight <= CARS[1]:
        raise UserError(
            f"{name} is to be estimated from the weight, {weight:.0f} lb; expected a passenger "
            f"car's, {CARS[0]:,} to {CARS[1]:,} lb",
            source,
        )
    return (_SLOPE * weight - _OFFSET) * float(UNITS["lb-ft-s2"][1] / system.scale(INERTIA))


def _four_digits(value: float) -> str:
    text = f"{value:.4g}"
    return text if "e" not in text else repr(float(text)).removesuffix(".0").upper()


def told(how: Mapping[str, str], values: Mapping[str, str]) -> list[str]:
    """A line for each estimate, for people who see the result."""
    return [f"{name} = {values[name]} is estimated: {rule}" for name, rule in how.items()]
