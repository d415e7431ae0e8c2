"""Units, axes and headings: for each name one affine map between what is shown and computed.

A scene is computed in base units (ft, slug, s or m, kg, s; degrees; rad/s) along the listing's
axes. Whatever a file shows instead is ``base = offset + factor * shown``, with exact fractions:
a unit is the factor, SAE axes its sign, compass headings the offset. Results use the inverse.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from fractions import Fraction
from functools import lru_cache
from math import isfinite
from typing import Any, NamedTuple

from ..decimals import to_text
from ..errors import UserError, quoted
from ..names import NUMBER, PIVOT, quantity

_TABLE = """
length              | us     | us chapter | ft              | ft foot feet
length              | us     |            | 0.0254          | in inch inches
length              | us     |            | 0.9144          | yd yard yards
length              | us     |            | 1609.344        | mi mile miles
length              | metric | metric si  | 1               | m meter meters metre metres
length              | metric |            | 0.01            | cm
length              | metric |            | 0.001           | mm
length              | metric |            | 1000            | km
length/time         | us     | us         | 0.44704         | mph mi/h
length/time         | us     | chapter    | ft              | ft/s fps ft/sec
length/time         | us     |            | 463/900         | kn kt knot knots
length/time         | metric | metric     | 5/18            | km/h kph kmh
length/time         | metric | si         | 1               | m/s m/sec
mass                | us     | us         | lb              | lb lbs pound pounds
mass                | us     | chapter    | lb g per-ft     | slug slugs
mass                | metric | metric si  | 1               | kg kgs kilogram kilograms
mass                | metric |            | 1000            | t tonne tonnes
mass                | metric |            | per-g           | N
mass                | metric |            | 1000 per-g      | kN
mass·length²        | us     | us chapter | lb g ft         | lb-ft-s2 ft-lb-s2 slug-ft2
mass·length²        | us     |            | lb g 0.0254     | lb-in-s2 in-lb-s2
mass·length²        | us     |            | lb ft ft        | lb-ft2
mass·length²        | metric | metric si  | 1               | kg-m2 N-m-s2
mass·length²/time²  | us     | us chapter | lb g ft         | ft-lb lb-ft
mass·length²/time²  | metric | metric si  | 1               | J N-m
mass·length²/time²  | metric |            | 1000            | kJ kN-m
mass·length/time²   | us     | us chapter | lb g            | lb lbs pound pounds
mass·length/time²   | metric | metric si  | 1               | N
mass·length/time²   | metric |            | 1000            | kN
mass·length/time    | us     | us chapter | lb g            | lb-s slug-ft/s
mass·length/time    | metric | metric si  | 1               | N-s kg-m/s
mass·length/time    | metric |            | 1000            | kN-s
mass·length²/time   | us     | us chapter | lb g ft         | ft-lb-s lb-ft-s
mass·length²/time   | metric | metric si  | 1               | N-m-s kg-m2/s
time                |        | all        | 1               | s sec second seconds
time                |        |            | 0.001           | ms
rad/time            |        | all        | 1               | rad/s rad/sec
rad/time            |        |            | pi 1/180        | deg/s °/s degree/s degrees/s deg/sec
rad/time            |        |            | pi 1/30         | rpm
degree              |        | all        | 1               | deg ° degree degrees
degree              |        |            | 180 per-pi      | rad radian radians
percent             |        |            | 1               | % percent
1                   |        |            | 0.01            | % percent
"""
"""The units that an amount may have: rule of the quantity (`names`), side, systems that show it,
size in m, kg, s, degrees and rad/s as a product, and spellings, the first of which is shown. A mass
may be given as its weight."""
FOOT = Fraction("0.3048")  # m
POUND = Fraction("0.45359237")  # kg
GRAVITY = Fraction("9.80665")  # m/s²
PI = Fraction("3.14159265358979323846264338327950288419716939937510")
_FACTORS = {"lb": POUND, "g": GRAVITY, "ft": FOOT}
_FACTORS |= {"per-ft": 1 / FOOT, "per-g": 1 / GRAVITY, "pi": PI, "per-pi": 1 / PI}
_BASES = {"us": "chapter", "chapter": "chapter", "metric": "si", "si": "si"}
"""Choices of ``units``, each with the system whose units are its base units."""
_CHOICES = {"units": _BASES, "axes": ("listing", "sae"), "headings": ("listing", "compass")}


class Unit(NamedTuple):
    """A unit: the symbol shown, its size, its side, "us", "metric" or "" for both, and the systems
    that show it."""

    symbol: str
    size: Fraction
    side: str
    systems: str


@lru_cache(maxsize=1)
def _units() -> dict[str, dict[str, Unit]]:
    """Return the units of `_TABLE` by rule and normalized spelling."""
    units: dict[str, dict[str, Unit]] = {}
    for row in _TABLE.strip().splitlines():
        rule, side, systems, product, spellings = (cell.strip() for cell in row.split("|"))
        size = Fraction(1)
        for factor in product.split():
            size *= _FACTORS.get(factor) or Fraction(factor)
        systems = systems.replace("all", " ".join(_BASES))
        unit = Unit(spellings.partition(" ")[0], size, side, systems)
        symbols = {_normalize(symbol): unit for symbol in spellings.split()}
        units[rule] = units.get(rule, {}) | symbols
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
        choices = ", ".join(dict.fromkeys(unit.symbol for unit in units.values()))
        kind = "a ratio" if rule == NUMBER else rule.replace("·", " ")
        raise UserError(f"{symbol} is not a unit of {kind}; expected {choices}")
    return units[_normalize(symbol)]


@lru_cache(maxsize=256)
def shown_unit(rule: str, system: str) -> Unit | None:
    """Return the unit in which a system shows values of a rule, None without one."""
    units = _units().get(rule, {}).values()
    return next((unit for unit in units if system in unit.systems.split()), None)


def is_measured(rule: str) -> bool:
    """Return True for a rule whose base unit depends on the system."""
    unit = shown_unit(rule, "si")
    return bool(unit and unit.side)


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
    def of(cls, where: str | None = None, **words: str | None) -> View:
        """Return the view of the words of a file or of options.

        Parameters
        ----------
        where : str, optional
            Place of the words for messages.
        **words : str or None
            ``units``, ``axes``, ``headings``; None or "" for the default.

        Raises
        ------
        UserError
            For a word that is not among the choices.
        """
        chosen = {name: (word or "").strip().lower() for name, word in words.items()}
        for name, word in chosen.items():
            if word and word not in _CHOICES[name]:
                choices = ", ".join(_CHOICES[name])
                raise UserError(f"{name} = {quoted(words[name])}; expected {choices}", where)
        return cls(**{n: word for n, word in chosen.items() if word != "listing"})

    def words(self) -> dict[str, str]:
        """Return the entries of a file with this view, without defaults."""
        return {name: word for name, word in asdict(self).items() if word}

    def base_size(self, rule: str) -> Fraction:
        """Return the size of the base unit of a rule in m, kg, s."""
        unit = shown_unit(rule, _BASES.get(self.units, ""))
        return unit.size if unit else Fraction(1)

    def unit(self, name: str) -> str:
        """Return the unit a quantity is shown in; "" for a pure number and without units."""
        unit = shown_unit(quantity(name).unit, self.units)
        return unit.symbol if unit else ""

    def heading(self, name: str) -> str:
        """Return the heading of a column, such as ``DVA [mph]``."""
        unit = self.unit(name)
        return f"{name} [{unit}]" if unit else name

    def meaning(self, name: str) -> str:
        """Return the meaning of a quantity in words, with the zero of its direction."""
        zero = "clockwise from north" if self._turns(name) else "from the x axis"
        meaning: str = quantity(name).meaning.replace("from the x axis", zero)
        return meaning

    def map(self, name: str, unit: str = "") -> tuple[Fraction, Fraction]:
        """Return factor and offset of ``base = offset + factor * shown``.

        Parameters
        ----------
        name : str
            The quantity.
        unit : str, optional
            Symbol of the unit of the shown number, by default that of `unit`.
        """
        rule = quantity(name).unit
        symbol = unit or self.unit(name)
        factor = unit_of(rule, symbol).size / self.base_size(rule) if symbol else Fraction(1)
        if self.headings and name in FROM_NORTH:
            north = 0 if self.axes else 90  # north is y, of SAE axes x
            return -factor, Fraction(north + 180 * (name == "TA"))  # A faces TA + 180
        return (-factor if self.axes and name in MIRRORED else factor), Fraction(0)

    def shown(self, name: str, value: Any) -> Any:
        """Return a base value, a number or an array, as the file shows it.

        A single number has the fewest digits that are read as the same base value. Headings are
        reduced to one turn."""
        if isinstance(value, int | float):
            return float(self.shown_text(name, float(value)))
        factor, offset = self.map(name)
        if factor == 1 and not offset:
            return value
        result = (value - float(offset)) * float(1 / factor) + 0.0  # no -0
        if name == "MUP":  # the pivot's mark keeps its sign
            result = result + 2 * PIVOT * (value == PIVOT)
        return result % 360.0 if self._turns(name) else result

    def shown_text(self, name: str, value: float) -> str:
        """Return a single number as `shown`, as decimal text."""
        factor, offset = self.map(name)
        if (factor == 1 and not offset) or not isfinite(value) or (name, value) == ("MUP", PIVOT):
            return to_text(value)
        exact = (Fraction(value) - offset) / factor
        turns = exact // 360 * 360 if self._turns(name) else 0
        for places in (15, 16, 17):
            text = to_text(float(f"{float(exact - turns):.{places}g}"))
            if float(offset + factor * (Fraction(text) + turns)) == value:
                break
        return text

    def shown_ends(self, name: str, low: float, high: float) -> tuple[float, float]:
        """Return two limits as shown, the lower first; directions are not reduced to one turn."""
        factor, offset = (float(x) for x in self.map(name))
        ends = (low - offset) / factor, (high - offset) / factor
        return min(ends), max(ends)

    def _turns(self, name: str) -> bool:
        """Return True for directions that are shown from 0 to 360 degrees, from north."""
        return bool(self.headings) and name in FROM_NORTH


PLAIN = View()
"""Base units, whatever they are, along the listing's axes."""


def system_using(units: Iterable[Unit]) -> str:
    """Return the system, us or metric, of values written with units, "" if the units name none.
    Raises UserError for units of two systems."""
    sides = {unit.side for unit in units} - {""}
    if len(sides) > 1:
        raise UserError('units of two systems; expected units = "us" or "metric", too (--units)')
    return "".join(sides)
