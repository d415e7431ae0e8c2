"""Units, axes and headings: for each name one affine map between what is shown and computed.

A scene is computed in base units (ft, slug, s or m, kg, s; degrees; rad/s) along the listing's
axes. Whatever a file shows instead is ``base = offset + factor * shown``, with exact fractions:
a unit is the factor, SAE axes its sign, compass headings the offset. Results use the inverse.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import inf, isfinite, prod, remainder
from typing import Any, NamedTuple

from ..errors import UserError, quoted
from ..names import NUMBER, PIVOT, quantity

_TABLE = """
length              | us     | us chapter           | ft              | ft foot feet
length              | us     |                      | 0.0254          | in inch inches
length              | us     |                      | 0.9144          | yd yard yards
length              | us     |                      | 1609.344        | mi mile miles
length              | metric | metric si            | 1               | m meter meters metre metres
length              | metric |                      | 0.01            | cm
length              | metric |                      | 0.001           | mm
length              | metric |                      | 1000            | km
length/time         | us     | us                   | 0.44704         | mph mi/h
length/time         | us     | chapter              | ft              | ft/s fps ft/sec
length/time         | us     |                      | 463/900         | kn kt knot knots
length/time         | metric | metric               | 5/18            | km/h kph kmh
length/time         | metric | si                   | 1               | m/s m/sec
mass                | us     | us                   | lb              | lb lbs pound pounds
mass                | us     | chapter              | lb g per-ft     | slug slugs
mass                | metric | metric si            | 1               | kg kgs kilogram kilograms
mass                | metric |                      | 1000            | t tonne tonnes
mass                | metric |                      | per-g           | N
mass                | metric |                      | 1000 per-g      | kN
mass·length²        | us     | us chapter           | lb g ft         | lb-ft-s2 ft-lb-s2 slug-ft2
mass·length²        | us     |                      | lb g 0.0254     | lb-in-s2 in-lb-s2
mass·length²        | us     |                      | lb ft ft        | lb-ft2
mass·length²        | metric | metric si            | 1               | kg-m2 N-m-s2
mass·length²/time²  | us     | us chapter           | lb g ft         | ft-lb lb-ft
mass·length²/time²  | metric | metric si            | 1               | J N-m
mass·length²/time²  | metric |                      | 1000            | kJ kN-m
mass·length/time²   | us     | us chapter           | lb g            | lb lbs pound pounds
mass·length/time²   | metric | metric si            | 1               | N
mass·length/time²   | metric |                      | 1000            | kN
mass·length/time    | us     | us chapter           | lb g            | lb-s slug-ft/s
mass·length/time    | metric | metric si            | 1               | N-s kg-m/s
mass·length/time    | metric |                      | 1000            | kN-s
mass·length²/time   | us     | us chapter           | lb g ft         | ft-lb-s lb-ft-s
mass·length²/time   | metric | metric si            | 1               | N-m-s kg-m2/s
time                |        | us chapter metric si | 1               | s sec second seconds
time                |        |                      | 0.001           | ms
rad/time            |        | us chapter metric si | 1               | rad/s rad/sec
rad/time            |        |                      | pi 1/180        | deg/s °/s degrees/s deg/sec
rad/time            |        |                      | pi 1/30         | rpm
degree              |        | us chapter metric si | 1               | deg ° degree degrees
degree              |        |                      | 180 per-pi      | rad radian radians
percent             |        |                      | 1               | % percent
1                   |        |                      | 0.01            | % percent
"""
"""The units that an amount may have: rule of the quantity (`names`), side, systems that show it,
size in m, kg, s, degrees and rad/s as a product, and spellings, the first of which is shown. A mass
may be given as its weight."""
FOOT = Fraction("0.3048")  # m
POUND = Fraction("0.45359237")  # kg
GRAVITY = Fraction("9.80665")  # m/s²
PI = Fraction("3.14159265358979323846264338327950288419716939937510")
_FACTORS = {
    "lb": POUND,
    "g": GRAVITY,
    "per-g": 1 / GRAVITY,
    "ft": FOOT,
    "per-ft": 1 / FOOT,
    "pi": PI,
    "per-pi": 1 / PI,
}
_BASES = {"us": "chapter", "chapter": "chapter", "metric": "si", "si": "si"}
"""Choices of ``units``, each with the system whose units are its base units."""
_CHOICES = {"units": _BASES, "axes": ("listing", "sae"), "headings": ("listing", "compass")}


class Unit(NamedTuple):
    """A unit: the symbol shown, its size, its side, "us", "metric" or "" for both, and the systems
    that show it."""

    symbol: str = ""
    size: Fraction = Fraction(1)
    side: str = ""
    systems: str = ""


@lru_cache(maxsize=1)
def _units() -> dict[str, dict[str, Unit]]:
    """Return the units of `_TABLE` by rule and normalized spelling."""
    units: dict[str, dict[str, Unit]] = {}
    for row in _TABLE.strip().splitlines():
        rule, side, systems, product, spellings = (cell.strip() for cell in row.split("|"))
        size = prod(_FACTORS.get(factor) or Fraction(factor) for factor in product.split())
        symbols = spellings.split()
        unit = Unit(symbols[0], Fraction(size), side, systems)
        units.setdefault(rule, {}).update({_normalize(symbol): unit for symbol in symbols})
    return units


def _normalize(symbol: str) -> str:
    """Return a spelling of a unit without blanks, marks of products and powers, capitals, and the
    letter of lbf and lbm."""
    plain = symbol.lower().replace("²", "2").replace(" per ", "/")
    return re.sub(r"[\s·*.^-]|(?<=lb)[fm](?![a-z])", "", plain)


def unit_of(rule: str, symbol: str) -> Unit:
    """Return the unit of a rule that a text spells. Raises UserError if it does not measure the
    quantity."""
    units = _units().get(rule, {})
    if _normalize(symbol) not in units:
        kind = "a ratio" if rule == NUMBER else rule.replace("·", " ")
        raise UserError(
            f"{symbol} is not a unit of {kind}; expected "
            f"{', '.join(dict.fromkeys(unit.symbol for unit in units.values()))}"
        )
    return units[_normalize(symbol)]


@lru_cache(maxsize=256)
def shown_unit(rule: str, system: str) -> Unit:
    """Return the unit in which a system shows values of a rule; one without a symbol for pure
    numbers, and without a system."""
    units = _units().get(rule, {}).values()
    return next((unit for unit in units if system in unit.systems.split()), Unit())


FROM_NORTH = frozenset("TA TB HA HB HAF HBF".split())
"""Directions of vehicles and velocities, clockwise from north with compass headings."""
MIRRORED = FROM_NORTH | frozenset(
    "UY WA VY WB VAY WAF VBY WBF YA YB YAF YBF GA PA PB PT PM MUP MUC CAY CBY CY "
    "UT VT VAT VBT".split()
)
"""Names whose sign changes with SAE axes (y to the right of x, angles and spins clockwise). Left,
right, forward and PDOF are a vehicle's own and do not change."""


@dataclass(frozen=True, slots=True)
class View:
    """Units, axes and headings in which a file shows its numbers and results.

    Parameters
    ----------
    units : {"", "us", "chapter", "metric", "si"}, default ""
        System of units; "" for any consistent units, whose names are not known.
    axes : {"", "sae"}, default ""
        Axes; "" is the listing's.
    headings : {"", "compass"}, default ""
        Directions of TA TB HA HB HAF HBF; "" is counterclockwise from x.

    Examples
    --------
    >>> View("us").shown("UX", 44.0), View("us").unit("UX")
    (30.0, 'mph')
    >>> View(headings="compass").shown("TB", 0.0)
    90.0
    """

    units: str = ""
    axes: str = ""
    headings: str = ""

    @classmethod
    def of(cls, **words: str | None) -> View:
        """Return the view of the entries of a file or of options.

        Parameters
        ----------
        **words : str or None
            ``units``, ``axes``, ``headings``, None or "" for the default; others do not count.

        Raises
        ------
        UserError
            For a word that is not among the choices.
        """
        chosen = {
            name: re.sub("^listing$", "", (words.get(name) or "").strip().lower())
            for name in _CHOICES
        }
        for name, word in chosen.items():
            if word and word not in _CHOICES[name]:
                raise UserError(
                    f"{name} = {quoted(words[name])}; expected {', '.join(_CHOICES[name])}"
                )
        return cls(**chosen)

    def base_size(self, rule: str) -> Fraction:
        """Return the size of the base unit of a rule in m, kg, s."""
        return shown_unit(rule, _BASES.get(self.units, "")).size

    def unit(self, name: str) -> str:
        """Return the unit a quantity is shown in; "" for a pure number and without units."""
        return shown_unit(quantity(name).unit, self.units).symbol

    def heading(self, name: str) -> str:
        """Return the heading of a column, such as ``DVA [mph]``."""
        unit = self.unit(name)
        return f"{name} [{unit}]" if unit else name

    def meaning(self, name: str) -> str:
        """Return the meaning of a quantity in words, with the zero of its direction; where headings
        are those of a compass, also TA is the way the vehicle faces."""
        text = str(quantity(name).meaning)
        if self._turns(name):
            return text.partition(";")[0].replace("from the x axis", "clockwise from north")
        return text

    def map(self, name: str, symbol: str = "") -> tuple[Fraction, Fraction]:
        """Return factor and offset of ``base = offset + factor * shown``.

        Parameters
        ----------
        name : str
            The quantity.
        symbol : str, optional
            The unit of the shown number, by default that of `unit`.

        Raises
        ------
        UserError
            For a unit that does not measure the quantity; and for one of length, mass or speed in a
            view without units, which would leave open those of the other numbers.
        """
        rule = quantity(name).unit
        unit = unit_of(rule, symbol) if symbol else shown_unit(rule, self.units)
        if unit.side and not self.units:
            raise UserError(
                f'{name} is in {symbol}; expected units = "us", "chapter", "metric" or "si" '
                "(--units), those of numbers without one and of results"
            )
        factor = unit.size / self.base_size(rule)
        if self._turns(name):
            north = 0 if self.axes else 90  # north is y, of SAE axes x
            return -factor, Fraction(north + 180 * (name == "TA"))  # A faces TA + 180
        return (-factor if self.axes and name in MIRRORED else factor), Fraction(0)

    def shown(self, name: str, value: Any, one_turn: bool = True) -> Any:
        """Return a base value, a number or an array, as the file shows it.

        A single number has the fewest digits that are read as the same base value, the pivot's mark
        no direction.

        Parameters
        ----------
        name : str
            The quantity.
        value : float or array
            In base units along the listing's axes.
        one_turn : bool, default True
            Reduce compass headings to 0 .. 360.
        """
        factor, offset = self.map(name)
        if factor == 1 and not offset:
            return value
        is_pivot = (value == PIVOT) & (name == "MUP")
        result = (value - float(offset)) * float(1 / factor) + 2 * PIVOT * is_pivot + 0.0  # no -0
        if one_turn and self._turns(name):
            result = result % 360.0
        if not isinstance(value, float) or not isfinite(value):
            return result
        short = float(f"{result:.15g}")
        base = float(offset + factor * Fraction(short))
        return short if remainder(base - value, 360.0 if offset else inf) == 0 else result

    def _turns(self, name: str) -> bool:
        """Return True for directions that are shown from 0 to 360 degrees, from north."""
        return bool(self.headings) and name in FROM_NORTH


PLAIN = View()
"""Base units, whatever they are, along the listing's axes."""
