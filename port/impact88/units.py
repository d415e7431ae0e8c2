"""Units: their sizes, the systems they belong to, and what values are shown in.

An amount with a unit ("-25 mph", see `impact88.amounts`) is converted once, by exact fractions, to
its system's base: ft, slug and s, or m, kg and s; angles are in degrees, spins in radians a second.
A unit is an expression of symbols ("slug ft2", "lb-ft-s2"), whose dimension is worked out and
compared with what a quantity measures: in "lb ft2" only the mass gives an inertia, in "lb-ft-s2"
only the force. A units library would take a quarter of a second to import, and has one "lb".
"""

import re
from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

from .errors import UserError, quoted
from .names import quantity

_FOOT = Fraction("0.3048")
_POUND = Fraction("0.45359237")
_GRAVITY = Fraction("9.80665")
_SLUG = _POUND * _GRAVITY / _FOOT
_DEGREE = Fraction("0.017453292519943295769236907684886127134")

LENGTH, VELOCITY, MASS, SPIN = "length", "length/time", "mass", "rad/time"
INERTIA, ENERGY = "mass·length²", "mass·length²/time²"
FORCE, IMPULSE, TURNING = "mass·length/time²", "mass·length/time", "mass·length²/time"
TIME, ANGLE, NUMBER, PERCENT = "time", "degree", "1", "percent"

Dimension = tuple[int, int, int, int]
"""Exponents of length, mass, time and angle."""
_LENGTH, _MASS, _TIME, _ANGLE = (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)
_SPEED, _RATE, _FORCE, _ENERGY = (1, 0, -1, 0), (0, 0, -1, 1), (1, 1, -2, 0), (2, 1, -2, 0)
_US, _SI = "us", "metric"

SYMBOLS: dict[str, tuple[Dimension, Fraction, str]] = {
    name: (dimension, size, system)
    for names, dimension, size, system in (
        ("length", _LENGTH, Fraction(1), ""),
        ("mass", _MASS, Fraction(1), ""),
        ("time s sec secs second seconds", _TIME, Fraction(1), ""),
        ("ms", _TIME, Fraction(1, 1000), ""),
        ("h hr hour hours", _TIME, Fraction(3600), ""),
        ("ft foot feet '", _LENGTH, _FOOT, _US),
        ("in inch inches \" ''", _LENGTH, _FOOT / 12, _US),
        ("yd yard yards", _LENGTH, 3 * _FOOT, _US),
        ("mi mile miles", _LENGTH, 5280 * _FOOT, _US),
        ("m meter meters metre metres", _LENGTH, Fraction(1), _SI),
        ("cm", _LENGTH, Fraction(1, 100), _SI),
        ("mm", _LENGTH, Fraction(1, 1000), _SI),
        ("km kilometer kilometers kilometre kilometres", _LENGTH, Fraction(1000), _SI),
        ("mph", _SPEED, 5280 * _FOOT / 3600, _US),
        ("fps", _SPEED, _FOOT, _US),
        ("kph kmh", _SPEED, Fraction(1000, 3600), _SI),
        ("kn kt knot knots", _SPEED, Fraction(1852, 3600), _US),
        ("lb lbs pound pounds lbm", _MASS, _POUND, _US),
        ("lbf", _FORCE, _POUND * _GRAVITY, _US),
        ("slug slugs", _MASS, _SLUG, _US),
        ("oz ounce ounces", _MASS, _POUND / 16, _US),
        ("kg kgs kilogram kilograms", _MASS, Fraction(1), _SI),
        ("t tonne tonnes", _MASS, Fraction(1000), _SI),
        ("n", _FORCE, Fraction(1), _SI),
        ("j", _ENERGY, Fraction(1), _SI),
        ("kj", _ENERGY, Fraction(1000), _SI),
        ("rad radian radians", _ANGLE, Fraction(1), ""),
        ("deg degree degrees °", _ANGLE, _DEGREE, ""),
        ("rev", _ANGLE, 360 * _DEGREE, ""),
        ("rpm", _RATE, 6 * _DEGREE, ""),
        ("% percent", (0, 0, 0, 0), Fraction(1, 100), ""),
    )
    for name in names.split()
}
"""Symbol -> its dimension, its size in m, kg, s and radians, and whose it is."""
_ARC = {"'": _DEGREE / 60, "min": _DEGREE / 60, '"': _DEGREE / 3600, "''": _DEGREE / 3600}
"""What else divides an angle."""
_WEIGHTS = ("lb", "lbs", "pound", "pounds")
"""Symbols of a mass, or of the force that is its weight."""

_EXPONENT = r"(?:[²³]|(?:\^|\*\*)-?[1-9]|[23](?![\w.,'\"°]))"
_FACTOR = rf"(?:[a-zA-Z]+(?:\.(?![.\d]))?{_EXPONENT}?|[°%\"]|''?)"
UNIT = rf"{_FACTOR}(?:(?: ?[-*·/] ?| ){_FACTOR})*"
"""What a unit looks like: symbols with exponents, multiplied and divided."""
_STEP = re.compile(rf"( ?[-*·/] ?| |)({_FACTOR})")
_POWER = re.compile(r"(.+?)\.?(?:([²³])|(?:\^|\*\*)?(-?\d))?")
_EXPONENTS = {"²": 2, "³": 3}


@lru_cache(maxsize=4096)
def size_of(unit: str, rule: str) -> tuple[Fraction, str] | None:
    """The size of a unit in m, kg, s and radians, and whose it is; None for one that does not
    measure what ``rule`` says ("length/time")."""
    if rule in (NUMBER, PERCENT):
        return (Fraction(1 if rule == PERCENT else Fraction(1, 100)), "") if unit == "%" else None
    wanted = _dimension(rule)
    words = re.sub(r" per ", "/", unit)
    for force in (False, True):
        found = _product(words, rule == ANGLE, force)
        if found and found[0] == wanted:
            return found[1:]
    return None


@lru_cache
def _dimension(rule: str) -> Dimension:
    found = _product(rule, False, False)
    return found[0] if found else (0, 0, 0, 0)


def _product(text: str, arc: bool, force: bool) -> tuple[Dimension, Fraction, str] | None:
    """Dimension, size and system of an expression; ``force``: its pounds are forces; ``arc``: of an
    angle, which has minutes."""
    dimension, size, systems, at = [0, 0, 0, 0], Fraction(1), set(), 0
    while at < len(text):
        step = _STEP.match(text, at)
        if not step:
            return None
        at = step.end()
        match = _POWER.fullmatch(step[2])
        assert match is not None
        symbol, power = match[1].lower(), int(_EXPONENTS.get(match[2]) or match[3] or 1)
        known = SYMBOLS.get(symbol)
        if arc and symbol in _ARC:
            known = (_ANGLE, _ARC[symbol], "")
        elif force and symbol in _WEIGHTS:
            known = SYMBOLS["lbf"]
        if known is None:
            return None
        power = -power if "/" in step[1] else power
        dimension = [d + power * k for d, k in zip(dimension, known[0], strict=True)]
        size *= known[1] ** power
        systems.add(known[2])
    systems -= {""}
    if len(systems) > 1:
        return None
    length, mass, time, angle = dimension
    return (length, mass, time, angle), size, systems.pop() if systems else ""


class System(NamedTuple):
    """A consistent set and how its quantities are written. ``base``: sizes of its length and mass
    in m and kg (its time is the second); ``usual``: the unit of a bare number, by what it
    measures."""

    name: str
    base: tuple[Fraction, Fraction]
    usual: dict[str, str]

    def scale(self, rule: str) -> Fraction:
        """The size in m, kg, s and radians of one base unit of what ``rule`` measures."""
        if rule == ANGLE:
            return _DEGREE
        length, mass, _, _ = _dimension(rule)
        return Fraction(self.base[0] ** length * self.base[1] ** mass)

    def label(self, rule: str) -> str:
        """The unit that values of a rule ("length/time") are shown in."""
        return self.usual.get(rule, rule)

    def shown(self, rule: str, value: float) -> float:
        """A value in base units as it is shown."""
        size = size_of(self.usual.get(rule, ""), rule)
        return value * float(self.scale(rule) / size[0]) if size else value

    def factor(self, name: str) -> float:
        """What a quantity's value in base units is multiplied with to be shown."""
        return self.shown(quantity(name).unit, 1.0)

    def unit(self, name: str) -> str:
        """The unit a quantity is shown in; nothing for a mere number or where none is known."""
        label = self.label(quantity(name).unit)
        known = self is not RULES and label not in (NUMBER, PERCENT, "bits")
        return label if known else ""

    def heading(self, name: str) -> str:
        """A column's heading: ``DVA [mph]``."""
        unit = self.unit(name)
        return f"{name} [{unit}]" if unit else name


_FEET, _METRES = (_FOOT, _SLUG), (Fraction(1), Fraction(1))
_COMMON = {SPIN: "rad/s", ANGLE: "deg", TIME: "s", PERCENT: "percent"}
_US_UNITS = {LENGTH: "ft", INERTIA: "lb-ft-s2", ENERGY: "ft-lb", **_COMMON}
_US_UNITS |= {FORCE: "lb", IMPULSE: "lb-s", TURNING: "ft-lb-s"}
_SI_UNITS = {LENGTH: "m", MASS: "kg", INERTIA: "kg-m2", ENERGY: "J", **_COMMON}
_SI_UNITS |= {FORCE: "N", IMPULSE: "N-s", TURNING: "N-m-s"}
SYSTEMS = {
    "us": System("us", _FEET, {**_US_UNITS, VELOCITY: "mph", MASS: "lb"}),
    "chapter": System("chapter", _FEET, {**_US_UNITS, VELOCITY: "ft/s", MASS: "slug"}),
    "metric": System("metric", _METRES, {**_SI_UNITS, VELOCITY: "km/h"}),
    "si": System("si", _METRES, {**_SI_UNITS, VELOCITY: "m/s"}),
}
"""What ``units = "..."`` and ``--units`` may say."""
RULES = System("", _METRES, {})
"""No units given: rules stand for units ("length/time"), and values are shown as they are."""


def base_of(system: System) -> str:
    """The base units in words."""
    if system is RULES:
        return "any consistent units"
    return "m, kg, s" if system.base == _METRES else "ft, slug, s"


def gravity_in(system: System) -> float | None:
    """Standard gravity in the system's base units; None where there are no units."""
    return None if system is RULES else float(_GRAVITY / system.base[0])


def system_of(name: str | None) -> System:
    """The system of that name, `RULES` for none."""
    return SYSTEMS[name] if name else RULES


def system_named(name: str, source: str) -> System:
    """The system of that name. Raises UserError."""
    if name.lower() not in SYSTEMS:
        expected = " ".join(SYSTEMS)
        raise UserError(f"{quoted(name)} is not a system of units; expected {expected}", source)
    return SYSTEMS[name.lower()]


def system_using(units: Iterable[tuple[str, str]], source: str) -> System:
    """The system that values with some units, each with what it measures, are shown in: of those
    they belong to, the one that uses most of them. `RULES` where they belong to all. Raises
    UserError for units of two systems."""
    used = set(units)
    sides = {size[1] for unit, rule in used if (size := size_of(unit, rule))} - {""}
    if len(sides) > 1:
        raise UserError(
            'units of two systems; expected units = "us" or "metric" in the file', source
        )
    if not sides:
        return RULES
    base = SYSTEMS[sides.pop()].base

    def matching(system: System) -> int:
        return sum(
            size_of(unit, rule) == size_of(system.usual[rule], rule)
            for unit, rule in used
            if rule in (VELOCITY, MASS) and rule in system.usual
        )

    return max((s for s in SYSTEMS.values() if s.base == base), key=matching)


def check_unit(unit: str, rule: str, what: str, source: str) -> None:
    """Raises UserError, naming ``what`` has it, for a unit that does not measure ``rule``."""
    if size_of(unit, rule) is None:
        measures = "a ratio" if rule == NUMBER else rule.replace("·", " ")
        raise UserError(f"{what}: {unit} is not a unit of {measures}", source)


def written(values: Mapping[str, float], system: System) -> dict[str, float]:
    """Values in base units as they are shown."""
    if system is RULES:
        return dict(values)
    return {name: value * system.factor(name) for name, value in values.items()}
