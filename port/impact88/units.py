"""Units: from what a person writes to a consistent set, and back for what is shown.

The mechanics takes any consistent units, so a value with a unit ("-25 mph", "3091 lb", "3.5 ft") is
converted once, by exact fractions, to its system's base: ft, slug and s, or m, kg and s. Angles are
in degrees and spins in radians per second in both. A bare number in a file that says ``units =
"us"`` (or "metric", "si", "chapter") is in that system's usual units: a weight in lb, a speed in
mph. Text whose number needs no factor keeps its digits as written.

The dozen units of the field are a table here: a units library would bring a dependency, an import
of a quarter of a second and a grammar of thousands of names, of which "lb" alone, weight or mass,
would still have to be told apart by hand.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from fractions import Fraction
from math import isinf
from typing import NamedTuple

from .errors import UserError, quoted
from .names import quantity

_FOOT = Fraction("0.3048")
_POUND = Fraction("0.45359237")
_SLUG = _POUND * Fraction("9.80665") / _FOOT
_MILE = 5280 * _FOOT
_FOOT_POUND = _SLUG * _FOOT**2

LENGTH, VELOCITY, MASS, SPIN = "length", "length/time", "mass", "rad/time"
INERTIA, ENERGY = "mass·length²", "mass·length²/time²"
FORCE, IMPULSE, TURNING = "mass·length/time²", "mass·length/time", "mass·length²/time"
TIME, ANGLE, NUMBER, PERCENT = "time", "degree", "1", "percent"
_PI_ON_180 = Fraction("0.017453292519943295769236907684886127134")

_US, _SI = "us", "metric"
UNITS: dict[str, tuple[str, Fraction, str]] = {
    "ft": (LENGTH, _FOOT, _US),
    "in": (LENGTH, _FOOT / 12, _US),
    "m": (LENGTH, Fraction(1), _SI),
    "cm": (LENGTH, Fraction(1, 100), _SI),
    "mm": (LENGTH, Fraction(1, 1000), _SI),
    "mph": (VELOCITY, _MILE / 3600, _US),
    "ft/s": (VELOCITY, _FOOT, _US),
    "km/h": (VELOCITY, Fraction(1000, 3600), _SI),
    "m/s": (VELOCITY, Fraction(1), _SI),
    "lb": (MASS, _POUND, _US),
    "slug": (MASS, _SLUG, _US),
    "kg": (MASS, Fraction(1), _SI),
    "t": (MASS, Fraction(1000), _SI),
    "lb-ft-s2": (INERTIA, _FOOT_POUND, _US),
    "slug-ft2": (INERTIA, _FOOT_POUND, _US),
    "kg-m2": (INERTIA, Fraction(1), _SI),
    "ft-lb": (ENERGY, _FOOT_POUND, _US),
    "J": (ENERGY, Fraction(1), _SI),
    "kJ": (ENERGY, Fraction(1000), _SI),
    "rad/s": (SPIN, Fraction(1), ""),
    "deg/s": (SPIN, _PI_ON_180, ""),
    "deg": (ANGLE, Fraction(1), ""),
    "rad": (ANGLE, 1 / _PI_ON_180, ""),
    "%": (PERCENT, Fraction(1), ""),
}
"""Unit -> what it measures, its size in m, kg and s (angles in degrees), and whose it is. "lb" is
the weight that a mass has: 1/32.174 slug, .4536 kg."""


class System(NamedTuple):
    """A consistent set and how its quantities are written.

    ``base``: sizes of its length and mass in m and kg (its time is the second); ``usual``: the unit
    of a bare number, by what it measures; ``labels``: of what has no unit of its own in `UNITS`.
    """

    name: str
    base: tuple[Fraction, Fraction]
    usual: dict[str, str]
    labels: dict[str, str]

    def scale(self, rule: str) -> Fraction:
        """The size in m, kg and s of one base unit of what ``rule`` measures."""
        length, mass = self.base
        sizes = {LENGTH: length, VELOCITY: length, MASS: mass, INERTIA: mass * length**2}
        sizes |= {ENERGY: mass * length**2, TURNING: mass * length**2}
        sizes |= {FORCE: mass * length, IMPULSE: mass * length}
        return sizes.get(rule, Fraction(1))

    def label(self, rule: str) -> str:
        """The unit that values of a rule ("length/time") are shown in."""
        return self.usual.get(rule) or self.labels.get(rule, rule)

    def factor(self, name: str) -> float:
        """What a quantity's value in base units is multiplied with to be shown."""
        return self.shown(quantity(name).unit, 1.0)

    def shown(self, rule: str, value: float) -> float:
        """A value in base units as it is shown."""
        unit = self.usual.get(rule)
        return value * float(self.scale(rule) / UNITS[unit][1]) if unit else value


_FEET, _METRES = (_FOOT, _SLUG), (Fraction(1), Fraction(1))
_FEET_LABELS = {FORCE: "lb", IMPULSE: "lb-s", TURNING: "ft-lb-s", TIME: "s"}
_METRE_LABELS = {FORCE: "N", IMPULSE: "N-s", TURNING: "N-m-s", TIME: "s"}
_COMMON = {SPIN: "rad/s", ANGLE: "deg"}
_US_UNITS = {LENGTH: "ft", INERTIA: "lb-ft-s2", ENERGY: "ft-lb", **_COMMON}
_SI_UNITS = {LENGTH: "m", MASS: "kg", INERTIA: "kg-m2", ENERGY: "J", **_COMMON}
SYSTEMS = {
    system.name: system
    for system in (
        System("us", _FEET, {**_US_UNITS, VELOCITY: "mph", MASS: "lb"}, _FEET_LABELS),
        System("chapter", _FEET, {**_US_UNITS, VELOCITY: "ft/s", MASS: "slug"}, _FEET_LABELS),
        System("metric", _METRES, {**_SI_UNITS, VELOCITY: "km/h"}, _METRE_LABELS),
        System("si", _METRES, {**_SI_UNITS, VELOCITY: "m/s"}, _METRE_LABELS),
    )
}
"""What ``units = "..."`` and ``--units`` may say."""
RULES = System("", _METRES, {}, {})
"""No units given: rules stand for units ("length/time"), and values are shown as they are."""


def base_of(system: System) -> str:
    """The base units in words."""
    if system is RULES:
        return "any consistent units"
    return "m, kg, s" if system.base == _METRES else "ft, slug, s"


_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_UNIT = "|".join(re.escape(unit) for unit in sorted(UNITS, key=len, reverse=True))
_AMOUNT = re.compile(rf"({_NUMBER})(?:\s*({_UNIT})(?![\w/-]))?")
_PLAIN = frozenset("0123456789+-.eE \t±")
_WORDS = ("title", "correlations", "M")
"""Entries that have no unit, whatever they say."""
ENTRY = "units"
"""The entry of a file that names its system."""


def has_units(texts: Mapping[str, str]) -> bool:
    """Whether some text has a unit, or an entry names a system."""
    return ENTRY in texts or any(
        match[2] and match[2] != "%"
        for name, text in texts.items()
        if name not in _WORDS and not _PLAIN.issuperset(text)
        for match in _AMOUNT.finditer(text)
    )


def system_of(name: str | None) -> System:
    """The system of that name, `RULES` for none."""
    return SYSTEMS[name] if name else RULES


def system_named(name: str, source: str) -> System:
    """The system of that name. Raises UserError."""
    if name.lower() not in SYSTEMS:
        expected = " ".join(SYSTEMS)
        raise UserError(f"{quoted(name)} is no system of units; expected {expected}", source)
    return SYSTEMS[name.lower()]


def to_base(
    texts: Mapping[str, str], source: str, system: System | None = None
) -> tuple[dict[str, str], System | None]:
    """The texts in base units, and the system they belong to (None where nothing tells).

    ``texts``: by name, numbers or values within limits, with units or bare, and perhaps the entry
    ``units``; ``system``: of bare numbers, where no entry says. Raises UserError for a unit that
    does not measure the quantity, for bare numbers among others with units, and for units of two
    systems where none is named.
    """
    entries = dict(texts)
    named = entries.pop(ENTRY, None)
    if named is not None:
        system = system_named(named, source)
    if system is None:
        used = {
            UNITS[match[2]][2]
            for name, text in entries.items()
            if name not in _WORDS and not _PLAIN.issuperset(text)
            for match in _AMOUNT.finditer(text)
            if match[2]
        } - {""}
        if len(used) > 1:
            raise UserError(
                'units of two systems; expected units = "us" or "metric" in the file', source
            )
        if not used:
            return {n: _bare(n, t, source) for n, t in entries.items()}, None
        system = SYSTEMS[used.pop()]
        return {n: _based(n, t, source, system, strict=True) for n, t in entries.items()}, system
    return {n: _based(n, t, source, system, strict=False) for n, t in entries.items()}, system


def _bare(name: str, text: str, source: str) -> str:
    """A text of a file without a system: only angles and spins can have a unit."""
    if name in _WORDS or _PLAIN.issuperset(text):
        return text
    return _based(name, text, source, RULES, strict=False)


def _based(name: str, text: str, source: str, system: System, strict: bool) -> str:
    """One text in base units; ``strict``: bare numbers that measure something are refused."""
    if name in _WORDS or not text:
        return text
    try:
        rule = quantity(name).unit
    except KeyError:
        return text  # told by whoever knows which names belong
    matches = list(_AMOUNT.finditer(text))
    own = {match[2] for match in matches if match[2] and not _is_share(text, match)}
    # a unit behind the last number is meant for all of them: "-25 +- 2 mph"
    common = own.pop() if len(own) == 1 else None

    def based(match: re.Match[str]) -> str:
        if _is_share(text, match):
            return match[0]
        unit = match[2] or common or system.usual.get(rule)
        if match[2] is None and common is None and strict and rule not in _UNITLESS:
            if float(match[1]) != 0:
                raise UserError(f"{name} = {text} has no unit, and others have", source)
            return match[1]
        if unit is None:
            return match[1]
        measures, size, _ = UNITS[unit]
        if measures != rule and not (unit == "%" and rule == PERCENT):
            raise UserError(
                f"{name} = {text}: {unit} is no unit of its {rule.replace('·', ' ')}", source
            )
        factor = size / system.scale(rule)
        if factor == 1:
            return match[1]
        number = float(match[1])
        try:
            if isinf(number):
                raise OverflowError
            if not number:  # exponents of nine digits are not worked out
                return "0"
            return repr(float(Fraction(match[1]) * factor)).removesuffix(".0").upper()
        except OverflowError:
            raise UserError(f"{name} = {text} is too large for a double", source) from None

    return _AMOUNT.sub(based, text)


_UNITLESS = (NUMBER, ANGLE, SPIN, PERCENT)


def _is_share(text: str, match: re.Match[str]) -> bool:
    """Whether a number is the percentage of a tolerance, "143.5 +- 5%"."""
    return match[2] == "%" and text[: match.start()].rstrip().endswith(("+-", "±"))
