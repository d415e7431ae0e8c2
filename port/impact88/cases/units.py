"""Units, axes and headings: for each name one affine map between what is shown and computed.

A scene is computed in base units (ft, slug, s or m, kg, s; degrees; rad/s) along the listing's
axes. Whatever a file shows instead is ``base = offset + factor * shown``, with exact fractions:
a unit is the factor, SAE axes its sign, compass headings the offset. Results use the inverse.
"""

from __future__ import annotations

import re
from dataclasses import asdict, dataclass
from fractions import Fraction
from functools import lru_cache
from math import isfinite
from typing import Any, NamedTuple

from ..decimals import to_text
from ..errors import UserError, quoted
from ..names import (
    ANGLE,
    ENERGY,
    FORCE,
    IMPULSE,
    INERTIA,
    LENGTH,
    MASS,
    NUMBER,
    PIVOT,
    SPIN,
    TIME,
    TURNING,
    VELOCITY,
    quantity,
)

_TABLE = """
length              | us     | ft                | ft foot feet
length              | us     | 0.0254            | in inch inches
length              | us     | 0.9144            | yd yard yards
length              | us     | 1609.344          | mi mile miles
length              | metric | 1                 | m meter meters metre metres
length              | metric | 0.01              | cm
length              | metric | 0.001             | mm
length              | metric | 1000              | km
length/time         | us     | 0.44704           | mph mi/h
length/time         | us     | ft                | ft/s fps ft/sec
length/time         | us     | 463/900           | kn kt knot knots
length/time         | metric | 5/18              | km/h kph kmh
length/time         | metric | 1                 | m/s m/sec
mass                | us     | lb                | lb lbs pound pounds lbm lbf
mass                | us     | lb g per-ft       | slug slugs
mass                | metric | 1                 | kg kgs kilogram kilograms
mass                | metric | 1000              | t tonne tonnes
mass                | metric | per-g             | N
mass                | metric | 1000 per-g        | kN
mass·length²        | us     | lb g ft           | lb-ft-s2 ft-lb-s2 lbf-ft-s2 ft-lbf-s2 slug-ft2
mass·length²        | us     | lb g 0.0254       | lb-in-s2 in-lb-s2
mass·length²        | us     | lb ft ft          | lb-ft2 lbm-ft2
mass·length²        | metric | 1                 | kg-m2 N-m-s2
mass·length²/time²  | us     | lb g ft           | ft-lb lb-ft ft-lbf lbf-ft
mass·length²/time²  | metric | 1                 | J N-m
mass·length²/time²  | metric | 1000              | kJ kN-m
mass·length/time²   | us     | lb g              | lb lbs pound pounds lbf
mass·length/time²   | metric | 1                 | N
mass·length/time²   | metric | 1000              | kN
mass·length/time    | us     | lb g              | lb-s lbf-s slug-ft/s
mass·length/time    | metric | 1                 | N-s kg-m/s
mass·length/time    | metric | 1000              | kN-s
mass·length²/time   | us     | lb g ft           | ft-lb-s lb-ft-s ft-lbf-s lbf-ft-s
mass·length²/time   | metric | 1                 | N-m-s kg-m2/s
time                |        | 1                 | s sec second seconds
time                |        | 0.001             | ms
rad/time            |        | 1                 | rad/s rad/sec
rad/time            |        | pi 1/180          | deg/s °/s degree/s degrees/s deg/sec
rad/time            |        | pi 1/30           | rpm
degree              |        | 1                 | deg ° degree degrees
degree              |        | 180 per-pi        | rad radian radians
percent             |        | 1                 | % percent
1                   |        | 0.01              | % percent
"""
"""The units that an amount may have: rule of the quantity (`names`), side, size in m, kg, s,
degrees and rad/s as a product, and spellings, the first of which is shown. A mass may be given as
its weight."""
FOOT = Fraction("0.3048")  # m
POUND = Fraction("0.45359237")  # kg
GRAVITY = Fraction("9.80665")  # m/s²
SLUG = POUND * GRAVITY / FOOT  # kg
PI = Fraction("3.14159265358979323846264338327950288419716939937510")
_FACTORS = {"lb": POUND, "g": GRAVITY, "ft": FOOT, "pi": PI}
_FACTORS |= {f"per-{name}": 1 / factor for name, factor in _FACTORS.items()}


class Unit(NamedTuple):
    """A unit: the symbol shown, its size, and its side, "us", "metric" or "" for both."""

    symbol: str
    size: Fraction
    side: str


@lru_cache(maxsize=1)
def _units() -> dict[tuple[str, str], Unit]:
    """Return the units of `_TABLE` by rule and normalized spelling."""
    units: dict[tuple[str, str], Unit] = {}
    for row in _TABLE.strip().splitlines():
        rule, side, product, spellings = (cell.strip() for cell in row.split("|"))
        size = Fraction(1)
        for factor in product.split():
            size *= _FACTORS.get(factor) or Fraction(factor)
        unit = Unit(spellings.partition(" ")[0], size, side)
        units |= {(rule, _normalize(symbol)): unit for symbol in spellings.split()}
    return units


def _normalize(symbol: str) -> str:
    """Return a spelling of a unit without blanks, marks of products and powers, and capitals."""
    return re.sub(r"[\s·*.^-]", "", symbol.replace("²", "2").replace(" per ", "/")).lower()


def unit_of(rule: str, symbol: str) -> Unit:
    """Return the unit of a rule that a text spells. Raises UserError if it does not measure the
    quantity."""
    unit = _units().get((rule, _normalize(symbol)))
    if unit is None:
        choices = dict.fromkeys(u.symbol for (r, _), u in _units().items() if r == rule)
        kind = "a ratio" if rule == NUMBER else rule.replace("·", " ")
        raise UserError(f"{symbol} is not a unit of {kind}; expected {', '.join(choices)}")
    return unit


DIMENSIONS = {
    LENGTH: (1, 0),
    VELOCITY: (1, 0),
    MASS: (0, 1),
    INERTIA: (2, 1),
    ENERGY: (2, 1),
    FORCE: (1, 1),
    IMPULSE: (1, 1),
    TURNING: (2, 1),
}
"""Powers of length and mass, of the rules whose base unit depends on the system."""


class System(NamedTuple):
    """A system of units: its base units of length and mass in m and kg, and the unit in which
    values of each rule are shown."""

    length: Fraction
    mass: Fraction
    shown: dict[str, str]


_BOTH = {TIME: "s", SPIN: "rad/s", ANGLE: "deg"}
_FEET = {
    LENGTH: "ft",
    INERTIA: "lb-ft-s2",
    ENERGY: "ft-lb",
    FORCE: "lb",
    IMPULSE: "lb-s",
    TURNING: "ft-lb-s",
    **_BOTH,
}
_METERS = {
    LENGTH: "m",
    INERTIA: "kg-m2",
    ENERGY: "J",
    FORCE: "N",
    IMPULSE: "N-s",
    TURNING: "N-m-s",
    MASS: "kg",
    **_BOTH,
}
SYSTEMS = {
    "us": System(FOOT, SLUG, {**_FEET, VELOCITY: "mph", MASS: "lb"}),
    "chapter": System(FOOT, SLUG, {**_FEET, VELOCITY: "ft/s", MASS: "slug"}),
    "metric": System(Fraction(1), Fraction(1), {**_METERS, VELOCITY: "km/h"}),
    "si": System(Fraction(1), Fraction(1), {**_METERS, VELOCITY: "m/s"}),
}
"""Choices of ``units``."""
_CHOICES = {
    "units": tuple(SYSTEMS),
    "axes": ("listing", "sae"),
    "headings": ("listing", "compass"),
}

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

    @lru_cache(maxsize=256)  # noqa: B019 - views are few, and equal ones share an entry
    def base_size(self, rule: str) -> Fraction:
        """Return the size of the base unit of a rule in m, kg, s."""
        if rule not in DIMENSIONS or not self.units:
            return Fraction(1)
        system, (length, mass) = SYSTEMS[self.units], DIMENSIONS[rule]
        return system.length**length * system.mass**mass

    def unit(self, name: str) -> str:
        """Return the unit a quantity is shown in; "" for a pure number and without units."""
        return SYSTEMS[self.units].shown.get(quantity(name).unit, "") if self.units else ""

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
        return _affine_map(self, name, unit)

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
        first, second = sorted((end - offset) / factor for end in (low, high))
        return first, second

    def _turns(self, name: str) -> bool:
        """Return True for directions that are shown from 0 to 360 degrees, from north."""
        return bool(self.headings) and name in FROM_NORTH


PLAIN = View()
"""Base units, whatever they are, along the listing's axes."""


@lru_cache(maxsize=1024)
def _affine_map(view: View, name: str, unit: str) -> tuple[Fraction, Fraction]:
    """Return `View.map`."""
    rule = quantity(name).unit
    symbol = unit or view.unit(name)
    factor = unit_of(rule, symbol).size / view.base_size(rule) if symbol else Fraction(1)
    if view.headings and name in FROM_NORTH:
        north = 0 if view.axes else 90  # north is y, of SAE axes x
        return -factor, Fraction(north + 180 * (name == "TA"))  # A faces TA + 180
    return (-factor if view.axes and name in MIRRORED else factor), Fraction(0)


def system_using(units: list[tuple[str, str]]) -> str:
    """Return the system, us or metric, of values written with units, "" if the units name none.

    Parameters
    ----------
    units : list of (str, str)
        Rule and symbol of each unit.

    Raises
    ------
    UserError
        For units of two systems.
    """
    sides = {unit_of(rule, symbol).side for rule, symbol in units} - {""}
    if len(sides) > 1:
        raise UserError('units of two systems; expected units = "us" or "metric", too (--units)')
    return "".join(sides)
