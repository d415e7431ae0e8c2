"""Units and amounts: unit sizes, systems, and the grammar of numbers, units, ranges and tolerances.

    -25 mph   3,091 lb   5 1/2 ft   6 ft 6 in   6'6"   8°30'   2,000 lb ft2   a number with a unit
    -31..-29 mph      30 mph .. 35 mph         between two values
    30 +- 2 mph       143.5 slug +- 5%         a middle and a half width (±, +/-)
    +- 2 mph          +- 5%                    the same, around a value given elsewhere
    uniform A B    triangular A M B    normal MEAN SD [within A .. B]
    estimate          estimate +- 20 %         a yaw inertia (`collision.estimates`)

If only one of the numbers has a unit, it applies to all of them. Numbers side by side without a
unit between them, or with a sign, are refused, and so is a comma that may be a decimal one (1,234.5
can only be thousands). A bare number without any system of units keeps its text, digit for digit.

An amount is converted once, by exact fractions, to its system's base: ft, slug and s, or m, kg and
s; angles are in degrees, spins in radians a second. A unit is an expression of symbols ("slug ft2",
"lb-ft-s2"), whose dimension is computed and compared with that of the quantity: "lb ft2" is an
inertia only if lb is a mass, "lb-ft-s2" only if it is a force. A units library would take a quarter
of a second to import, and knows only one "lb".
"""

import re
from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from math import inf, isfinite
from typing import Any, NamedTuple, NoReturn

from ..errors import UserError, quoted
from ..names import (
    ANGLE,
    ENERGY,
    FORCE,
    IMPULSE,
    INERTIA,
    LENGTH,
    MASS,
    NO_AMOUNTS,
    NUMBER,
    PERCENT,
    PIVOT,
    SPIN,
    TIME,
    TURNING,
    VELOCITY,
    quantity,
)
from .doubles import BARE, digits, double, is_number, opposite

_FOOT = Fraction("0.3048")
_POUND = Fraction("0.45359237")
_GRAVITY = Fraction("9.80665")
_SLUG = _POUND * _GRAVITY / _FOOT
_MPH = 5280 * _FOOT / 3600
_DEGREE = Fraction("0.017453292519943295769236907684886127134")
GRAVITY = float(_GRAVITY / _FOOT)  # ft/s²: pounds in a slug
MPH = float(_MPH / _FOOT)  # ft/s

Dimension = tuple[int, ...]
"""Exponents of length, mass, time and angle."""
_LENGTH = (1, 0, 0, 0)
_MASS = (0, 1, 0, 0)
_TIME = (0, 0, 1, 0)
_ANGLE = (0, 0, 0, 1)
_SPEED = (1, 0, -1, 0)
_RATE = (0, 0, -1, 1)
_FORCE = (1, 1, -2, 0)
_ENERGY = (2, 1, -2, 0)
_US = "us"
_SI = "metric"


class Unit(NamedTuple):
    """A unit that amounts may have: the ``symbols`` that stand for it, between blanks and in small
    letters; its dimension; its size in m, kg, s and radians; and the side it is of, `_US` or `_SI`
    ("" of both): units of two sides do not stand in one amount."""

    symbols: str
    dimension: Dimension
    size: Fraction
    side: str


UNITS = (
    Unit("s sec secs second seconds", _TIME, Fraction(1), ""),
    Unit("ms", _TIME, Fraction(1, 1000), ""),
    Unit("h hr hour hours", _TIME, Fraction(3600), ""),
    Unit("ft foot feet '", _LENGTH, _FOOT, _US),
    Unit("in inch inches \" ''", _LENGTH, _FOOT / 12, _US),
    Unit("yd yard yards", _LENGTH, 3 * _FOOT, _US),
    Unit("mi mile miles", _LENGTH, 5280 * _FOOT, _US),
    Unit("m meter meters metre metres", _LENGTH, Fraction(1), _SI),
    Unit("cm", _LENGTH, Fraction(1, 100), _SI),
    Unit("mm", _LENGTH, Fraction(1, 1000), _SI),
    Unit("km kilometer kilometers kilometre kilometres", _LENGTH, Fraction(1000), _SI),
    Unit("mph", _SPEED, _MPH, _US),
    Unit("fps", _SPEED, _FOOT, _US),
    Unit("kph kmh", _SPEED, Fraction(1000, 3600), _SI),
    Unit("kn kt knot knots", _SPEED, Fraction(1852, 3600), _US),
    Unit("lb lbs pound pounds lbm", _MASS, _POUND, _US),
    Unit("lbf", _FORCE, _POUND * _GRAVITY, _US),
    Unit("slug slugs", _MASS, _SLUG, _US),
    Unit("oz ounce ounces", _MASS, _POUND / 16, _US),
    Unit("kg kgs kilogram kilograms", _MASS, Fraction(1), _SI),
    Unit("t tonne tonnes", _MASS, Fraction(1000), _SI),
    Unit("n", _FORCE, Fraction(1), _SI),
    Unit("j", _ENERGY, Fraction(1), _SI),
    Unit("kj", _ENERGY, Fraction(1000), _SI),
    Unit("rad radian radians", _ANGLE, Fraction(1), ""),
    Unit("deg degree degrees °", _ANGLE, _DEGREE, ""),
    Unit("rev", _ANGLE, 360 * _DEGREE, ""),
    Unit("rpm", _RATE, 6 * _DEGREE, ""),
    Unit("% percent", (0, 0, 0, 0), Fraction(1, 100), ""),
)
SYMBOLS = {
    symbol: (unit.dimension, unit.size, unit.side)
    for unit in UNITS
    for symbol in unit.symbols.split()
}
"""Symbol -> dimension, size in m, kg, s and radians, and system ("" if both systems use it)."""
_RULE_SYMBOLS = {
    **SYMBOLS,
    "length": (_LENGTH, Fraction(1), ""),
    "mass": (_MASS, Fraction(1), ""),
    "time": (_TIME, Fraction(1), ""),
}
"""Symbols of rules, which name what is measured; an amount has units only."""
_ARC = {"'": _DEGREE / 60, "min": _DEGREE / 60, '"': _DEGREE / 3600, "''": _DEGREE / 3600}
"""Symbols of minutes and seconds of arc, in angles only."""
_WEIGHTS = ("lb", "lbs", "pound", "pounds")
"""Symbols of a mass or of its weight, a force."""

_EXPONENT = r"(?:[²³]|(?:\^|\*\*)-?[1-9]|[23](?![\w.,'\"°]))"
_FACTOR = rf"(?:[a-zA-Z]+(?:\.(?![.\d]))?{_EXPONENT}?|[°%\"]|''?)"
UNIT = rf"{_FACTOR}(?:(?: ?[-*·/] ?| ){_FACTOR})*"
"""Pattern of a unit: symbols with exponents, multiplied and divided."""
_STEP = re.compile(rf"( ?[-*·/] ?| |)({_FACTOR})")
_POWER = re.compile(r"(.+?)\.?(?:([²³])|(?:\^|\*\*)?(-?\d))?")
_EXPONENTS = {"²": 2, "³": 3}


@lru_cache(maxsize=4096)
def size_of(unit: str, rule: str) -> tuple[Fraction, str] | None:
    """Return the size of a unit in m, kg, s and radians, and its system; None if its dimension is
    not that of ``rule`` ("length/time")."""
    if rule in (NUMBER, PERCENT):
        return (Fraction(1 if rule == PERCENT else Fraction(1, 100)), "") if unit == "%" else None
    dimension = _dimension(rule)
    words = re.sub(r" per ", "/", unit)
    for force in (False, True):
        product = _product(words, rule == ANGLE, force)
        if product and product[0] == dimension:
            return product[1:]
    return None


@lru_cache
def _dimension(rule: str) -> Dimension:
    """Return the dimension of a rule such as "length/time"."""
    product = _product(rule, False, False, _RULE_SYMBOLS)
    return product[0] if product else (0, 0, 0, 0)


def _product(
    text: str,
    arc: bool,
    force: bool,
    symbols: Mapping[str, tuple[Dimension, Fraction, str]] = SYMBOLS,
) -> tuple[Dimension, Fraction, str] | None:
    """Return dimension, size and system of a unit; None if it has unknown symbols or mixes systems.

    ``arc``: accept minutes and seconds of arc; ``force``: read pounds as forces."""
    dimension: Dimension = (0, 0, 0, 0)
    size, systems, position = Fraction(1), set(), 0
    while position < len(text):
        step = _STEP.match(text, position)
        if not step:
            return None
        position = step.end()
        match = _POWER.fullmatch(step[2])
        assert match is not None
        symbol, power = match[1].lower(), int(_EXPONENTS.get(match[2]) or match[3] or 1)
        entry = symbols.get(symbol)
        if arc and symbol in _ARC:
            entry = (_ANGLE, _ARC[symbol], "")
        elif force and symbol in _WEIGHTS:
            entry = SYMBOLS["lbf"]
        if entry is None:
            return None
        power = -power if "/" in step[1] else power
        dimension = tuple(d + power * k for d, k in zip(dimension, entry[0], strict=True))
        size *= entry[1] ** power
        systems.add(entry[2])
    systems -= {""}
    if len(systems) > 1:
        return None
    return dimension, size, systems.pop() if systems else ""


class Convention(NamedTuple):
    """Directions other than the listing's.

    ``axes``: "sae" has y to the right of x, angles and spins clockwise. ``headings``: "compass" has
    headings of the vehicles' fronts and courses clockwise from north, which is y (with "sae" x).
    "" is the listing's convention."""

    axes: str = ""
    headings: str = ""

    def sign_and_offset(self, name: str) -> tuple[int, int] | None:
        """Return (sign, offset in degrees) of ``shown = offset + sign * value``; None if the value
        is shown unchanged. The sign is -1, so the same pair converts back."""
        if self.headings and name in FROM_NORTH:
            # A faces TA + 180
            return -1, (0 if self.axes else 90) + (180 if name == "TA" else 0)
        return (-1, 0) if self.axes and name in MIRRORED else None


AXES = ("listing", "sae")
"""Choices of ``axes = "..."`` and ``--axes``."""
HEADINGS = ("listing", "compass")
"""Choices of ``headings = "..."`` and ``--headings``."""
FROM_NORTH = ("TA", "TB", "HA", "HB", "HAF", "HBF")
"""Names of directions of vehicles and velocities."""
MIRRORED = frozenset(
    "UY WA VY WB VAY WAF VBY WBF YA YB YAF YBF GA PA PB TA TB HA HB HAF HBF PT PM MUP MUC "
    "CAY CBY CY".split()
)
"""Names whose sign changes when y and the sense of rotation are reversed. Left, right, forward and
PDOF are relative to the vehicle and do not change."""


@lru_cache(maxsize=256)
def _scale(base: tuple[Fraction, Fraction], rule: str) -> Fraction:
    """Return `System.scale` for base units of these sizes."""
    if rule == ANGLE:
        return _DEGREE
    length, mass, _, _ = _dimension(rule)
    return Fraction(base[0] ** length * base[1] ** mass)


class System(NamedTuple):
    """A consistent system of units and directions.

    ``base``: sizes of the base units of length and mass in m and kg (time is in seconds);
    ``usual``: the unit of a bare number, by rule; ``convention``: directions, None for the
    listing's."""

    name: str
    base: tuple[Fraction, Fraction]
    usual: dict[str, str]
    convention: Convention | None = None

    @property
    def is_bare(self) -> bool:
        """True without units: rules stand in for units, and values are shown unchanged."""
        return not self.usual

    @property
    def base_name(self) -> str:
        """The name of the system whose usual units are these base units."""
        return "si" if self.base == _METRES else "chapter"

    def scale(self, rule: str) -> Fraction:
        """Return the size of the base unit of ``rule`` in m, kg, s and radians."""
        return _scale(self.base, rule)

    def label(self, rule: str) -> str:
        """Return the unit in which values of a rule ("length/time") are shown."""
        return self.usual.get(rule, rule)

    def display_value(self, rule: str, value: float) -> float:
        """Return a value in base units, converted to the unit it is shown in."""
        size = size_of(self.usual.get(rule, ""), rule)
        return value * float(self.scale(rule) / size[0]) if size else value

    def factor(self, name: str) -> float:
        """Return the factor from base units to the unit a quantity is shown in."""
        return self.display_value(quantity(name).unit, 1.0)

    def display(self, name: str, value: Any) -> Any:
        """Return values in base units and the listing's axes, numbers or arrays, as they are shown.

        A single float is rounded to the shortest digits that convert back, so that a value typed as
        -25 is shown as -25."""
        if isinstance(value, float) and isfinite(value):
            return double(shown_text(name, digits(value), self))
        turn = self.convention.sign_and_offset(name) if self.convention else None
        if turn is None:
            factor = self.factor(name)
            return value if factor == 1 else value * factor
        sign, offset = turn
        if self.convention and self.convention.headings and name in FROM_NORTH:
            return (offset + sign * value) % 360.0
        # MUP = -10 marks a pivot and keeps its sign
        sign = 1 - 2 * (value != PIVOT) if name == "MUP" else sign
        return sign * value * self.factor(name)

    def is_turned(self, name: str) -> bool:
        """Return True if the sign of a value is opposite to that in the listing's axes."""
        turn = self.convention.sign_and_offset(name) if self.convention else None
        return turn is not None and turn[0] < 0

    def display_unwrapped(self, name: str, value: Any) -> Any:
        """Return values like `display`, but directions not reduced to one turn, to keep limits in
        order."""
        turn = self.convention.sign_and_offset(name) if self.convention else None
        if turn and name in FROM_NORTH:
            return turn[1] + turn[0] * value
        return self.display(name, value)

    def ends(self, name: str, low: Any, high: Any) -> tuple[Any, Any]:
        """Return two limits as shown (`display_unwrapped`), the lower one first."""
        low, high = (self.display_unwrapped(name, end) for end in (low, high))
        return (high, low) if self.is_turned(name) else (low, high)

    def unit(self, name: str) -> str:
        """Return the unit a quantity is shown in; "" for a pure number or without units."""
        label = self.label(quantity(name).unit)
        is_known = not self.is_bare and label not in (NUMBER, PERCENT, "bits")
        return label if is_known else ""

    def heading(self, name: str) -> str:
        """Return the heading of a column, such as ``DVA [mph]``."""
        unit = self.unit(name)
        return f"{name} [{unit}]" if unit else name


_FEET = (_FOOT, _SLUG)
_METRES = (Fraction(1), Fraction(1))
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
"""Choices of ``units = "..."`` and ``--units``."""
RULES = System("", _METRES, {})
"""The system without units: rules ("length/time") stand in for units, values are unchanged."""


def base_of(system: System) -> str:
    """Return the base units in words."""
    base = "m, kg, s" if system.base == _METRES else "ft, slug, s"
    return base if not system.is_bare else "any consistent units"


def gravity_in(system: System) -> float | None:
    """Return standard gravity in the system's base units; None without units."""
    return None if system.is_bare else float(_GRAVITY / system.base[0])


def system_of(name: str | None) -> System:
    """Return the system of that name, `RULES` for None."""
    return SYSTEMS[name] if name else RULES


def system_named(name: str, source: str) -> System:
    """Return the system of that name. Raises UserError."""
    if not isinstance(name, str) or name.lower() not in SYSTEMS:
        names = " ".join(SYSTEMS)
        raise UserError(f"{quoted(name)} is not a system of units; expected {names}", source)
    return SYSTEMS[name.lower()]


def system_using(units: Iterable[tuple[str, str]], source: str) -> System:
    """Return the system to show values in that were written in ``units``, pairs of unit and rule.

    Of the systems with the same base units, the one that uses most of these units; `RULES` if all
    systems have them. Raises UserError for units of two systems."""
    uses = set(units)
    sides = {size[1] for unit, rule in uses if (size := size_of(unit, rule))} - {""}
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
            for unit, rule in uses
            if rule in (VELOCITY, MASS)
        )

    return max((s for s in SYSTEMS.values() if s.base == base), key=matching)


def check_unit(unit: str, rule: str, what: str, source: str) -> None:
    """Raise UserError, which names ``what``, if a unit does not have the dimension of ``rule``."""
    if size_of(unit, rule) is None:
        measures = "a ratio" if rule == NUMBER else rule.replace("·", " ")
        units = dict.fromkeys(s.usual[rule] for s in SYSTEMS.values() if rule in s.usual)
        advice = f"; expected {', '.join(units)}" if units else ""
        raise UserError(f"{what}: {unit} is not a unit of {measures}{advice}", source)


def display_values(values: Mapping[str, float], system: System) -> dict[str, float]:
    """Return values in base units as they are shown, by name."""
    if system.is_bare and not system.convention:
        return dict(values)
    return {name: system.display(name, value) for name, value in values.items()}


ACCEPTED = (
    "expected a number, a number with its unit (-25 mph, 3,091 lb, 5 1/2 ft, 6 ft 6 in, 8 deg), "
    "'A .. B', 'N +- D', 'N +- P%', 'uniform A B', 'triangular A M B' or "
    "'normal MEAN SD [within A .. B]'"
)
NO_SKID = "is not a skid; expected its friction, too, such as 'skid 62 ft at 0.7 +- .1'"
ENTRY = "units"
"""Entry of a file that names its system of units."""
SHARED = ("MU", "MUP")
"""Ratios whose percentage refers to another value; the code that knows it reads them."""

_MEANT = str.maketrans(
    {"−": "-", "′": "'", "’": "'", "″": '"', "”": '"', "⋅": "·", "×": "*", "•": "·", "º": "°"}
    | {"\u00a0": " ", "\u202f": " ", "\u2009": " ", "½": " 1/2", "¼": " 1/4", "¾": " 3/4"}
)
_DECIMAL = r"(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_NUMBER = rf"\d{{1,3}}(?:,\d{{3}})+(?:\.\d*)?(?![\d,])|(?:\d+ )?\d+ ?/ ?\d+|{_DECIMAL}"
_DECIMAL_COMMA = re.compile(r"\d{1,3},\d{3}|0,.*")
"""Numbers that may have a decimal comma, unless their unit shows that the writer uses points. A
second comma, or a point after it, shows that the comma separates thousands."""
_AFTER = r"[a-zA-Z°%²³^]"
_PART = re.compile(rf"({_NUMBER})(?![\d,/]) ?(?:({UNIT})(?!{_AFTER})|(?!{_AFTER})) ?")
_FORMS = (
    ("uniform", r"uniform (.+)", (2,), "uniform {} {}"),
    ("triangular", r"triangular (.+)", (3,), "triangular {} {} {}"),
    ("normal", r"normal (.+?) within (.+?) ?\.\. ?(.+)", (2, 1, 1), "normal {} {} within {} .. {}"),
    ("normal", r"normal (.+)", (2,), "normal {} {}"),
    ("around", rf"(.*?) ?(?:\+-|±|\+/-) ?({_DECIMAL}) ?%", (1, 1), "{} +- {}%"),
    ("around", r"(.*?) ?(?:\+-|±|\+/-) ?(.+)", (1, 1), "{} +- {}"),
    ("range", r"(.+?) ?\.\. ?(.+)", (1, 1), "{} .. {}"),
)
"""Notations of a range: kind, pattern, number of amounts in each group, layout."""
SKID = re.compile(r"skid (.+) at (.+)")
"""A skid to rest: its distance and its friction."""
_PHRASES: dict[str, tuple[re.Pattern[str], tuple[str, ...]]] = {
    "estimate": (re.compile(r"estimate(?: (.+))?"), ("",)),
    "skid": (SKID, (LENGTH, NUMBER)),
}
"""Phrases that contain amounts: the pattern, and the rule of each amount ("": that of the entry).
The phrase is kept, with its amounts in base units, for the code that reads the entry."""


class Amount(NamedTuple):
    """One amount: its ``sign``, and ``parts``, its numbers as written with their units ("" for
    none)."""

    sign: str
    parts: tuple[tuple[str, str], ...]

    @property
    def units(self) -> list[str]:
        """Its units, in order."""
        return [unit for _, unit in self.parts if unit]


class Notation(NamedTuple):
    """A parsed text.

    ``kind``: "fixed" or a kind of `_FORMS`; ``amounts``: in order (the middle of "around" may be
    None); ``share``: True if the last is a percentage; ``layout``: a format for the amounts."""

    kind: str
    amounts: tuple[Amount | None, ...]
    share: bool = False
    layout: str = "{}"

    @property
    def units(self) -> list[str]:
        """Its units, in order."""
        return [unit for amount in self.amounts if amount for unit in amount.units]


def parse(text: str) -> Notation:
    """Parse a value or range. Raises ValueError for any other text."""
    words = " ".join(text.replace("⁻¹", "^-1").replace("⁻²", "^-2").translate(_MEANT).split())
    if "..." in words or any(c.isdecimal() and not c.isascii() for c in words):
        raise ValueError(text)  # INPUT reads ASCII digits only
    if is_number(words) and not re.search(r"\d \d", words):
        return Notation("fixed", (Amount("", ((words, ""),)),))
    for kind, pattern, counts, layout in _FORMS:
        if match := re.fullmatch(pattern, words):
            amounts: list[Amount | None] = []
            for part, count in zip(match.groups(), counts, strict=True):
                amounts += _split(part, count) if part or kind != "around" else [None]
            return Notation(kind, tuple(amounts), layout.endswith("%"), layout)
    return Notation("fixed", (_amount(words),))


def _amount(text: str) -> Amount:
    """Parse one amount, such as "-25 mph" or "6 ft 6 in". Raises ValueError."""
    sign = text[0] if text[:1] in ("+", "-") else ""
    remaining = text.removeprefix(sign).lstrip()
    parts: list[tuple[str, str]] = []
    while remaining:
        part = _PART.match(remaining)
        if not part or (parts and not parts[-1][1]):
            raise ValueError(text)
        parts.append((part[1], part[2] or ""))
        remaining = remaining[part.end() :]
    if not parts or (len(parts) > 1 and not _descend([unit for _, unit in parts])):
        raise ValueError(text)
    return Amount(sign, tuple(parts))


def _descend(units: list[str]) -> bool:
    """Return True if units decrease like feet and inches or degrees and minutes, in one system."""
    for rule in (LENGTH, ANGLE, MASS):
        sizes = [size_of(unit, rule) for unit in units]
        if all(sizes) and all(a[0] > b[0] for a, b in pairwise(filter(None, sizes))):
            return len({system for _, system in filter(None, sizes)} - {""}) < 2
    return False


def _split(text: str, count: int) -> list[Amount]:
    """Split a text at blanks into ``count`` amounts. Raises ValueError unless exactly one way
    works."""
    if count == 1:
        return [_amount(text)]
    splits = []
    for at in [match.start() for match in re.finditer(" ", text)]:
        try:
            splits.append([_amount(text[:at]), *_split(text[at + 1 :], count - 1)])
        except ValueError:
            continue
    if len(splits) != 1:
        raise ValueError(text)
    return splits[0]


def is_amount(text: str, rule: str) -> bool:
    """Return True if a text is an amount or range with the dimension of ``rule``, and none of its
    commas may be a decimal one."""
    try:
        value = _Value("", text, rule, "", advise=False)
        base_text = value.in_base(RULES, False)
    except UserError:
        return False
    if value.notation.kind != "range":
        return True
    lower, _, upper = base_text.partition(" .. ")
    return double(lower) <= double(upper)


def _accepted_forms(text: str, rule: str) -> str:
    """Return advice on how to write an amount that is not accepted; "" if its meaning is
    unclear."""
    from .suggestions import suggestions  # needed for a message only

    forms = suggestions(text.translate(_MEANT), lambda form: is_amount(form, rule))
    return f"write {' or '.join(map(quoted, forms))}" if forms else ""


class _Value:
    """An entry's amount or range, parsed and checked against the rule of its quantity.

    Raises UserError if the text is not an amount or has a unit of something else; ``advise``: with
    a suggestion how to write it."""

    def __init__(self, name: str, text: str, rule: str, source: str, advise: bool = True) -> None:
        self.text, self.advise = text, advise
        self.entry, self.rule, self.source = f"{name} = {text}", rule, source
        if rule == NUMBER and is_number(text):  # as INPUT takes it: "1 0" is ten
            self.notation = Notation("fixed", (Amount("", ((text.strip(), ""),)),))
            return
        try:
            self.notation = parse(text)
        except ValueError:
            if text.split()[:1] == ["skid"]:
                raise UserError(f"{name} = {quoted(text)} {NO_SKID}", source) from None
            self._refuse(f"{name} = {quoted(text)} is not an amount")
        for unit in self.notation.units:
            try:
                check_unit(unit, rule, self.entry, source)
            except UserError as error:
                if not (advise and (forms := _accepted_forms(text, rule))):
                    raise
                raise UserError(f"{error}; {forms}") from None
        if self.notation.share and (rule == PERCENT or "%" in self.notation.units):
            raise UserError(f"{self.entry}: percent of a percentage; expected '37 +- 2'", source)

    @property
    def uses(self) -> list[tuple[str, str]]:
        """The units of the text, each with the rule of the quantity."""
        return [(unit, self.rule) for unit in self.notation.units]

    def in_base(self, system: System, strict: bool) -> str:
        """Return the text in base units; ``strict``: refuse bare numbers of quantities with
        units."""
        units = set(self.notation.units)
        common = units.pop() if len(units) == 1 else None
        numbers = []
        for at, amount in enumerate(self.notation.amounts):
            if amount is None or (at == 1 and self.notation.share):
                numbers.append(amount.parts[0][0] if amount else "")
                continue
            bare = not amount.units and common is None
            if bare and strict and self.rule not in _UNITLESS and _fraction(amount.parts[0][0]):
                raise UserError(
                    f"some values have units and {self.entry} does not; add a unit, or name a "
                    f'system for numbers without units: units = "{system.name}" '
                    f"(--units {system.name})",
                    self.source,
                )
            numbers.append(self._number(amount, common or system.usual.get(self.rule, ""), system))
        return self.notation.layout.format(*numbers).lstrip()

    def _number(self, amount: Amount, usual: str, system: System) -> str:
        """Return one amount in base units, with its digits as written if the factor is 1."""
        unit_sizes = [size_of(unit or usual, self.rule) for _, unit in amount.parts]
        sizes = [size[0] if size else Fraction(1) for size in unit_sizes]
        scale = system.scale(self.rule) if usual or amount.units else Fraction(1)
        for (number, _), size in zip(amount.parts, unit_sizes, strict=True):
            if _DECIMAL_COMMA.fullmatch(number) and (
                number[0] == "0" or not size or size[1] != "us"
            ):
                self._refuse(f"{self.entry}: the comma of {number} may be a decimal one")
        number = amount.parts[0][0]
        if sizes == [scale] and "/" not in number:
            return amount.sign + number.replace(",", "")
        try:
            parts = zip(amount.parts, sizes, strict=True)
            value = float(sum(_fraction(number) * size for (number, _), size in parts) / scale)
        except (OverflowError, ZeroDivisionError):
            self._refuse(f"{self.entry}: too large for a double")
        return "0" if not value else ("-" if amount.sign == "-" else "") + digits(value)

    def _refuse(self, what: str) -> NoReturn:
        """Raise UserError with advice on how to write the amount."""
        advice = (self.advise and _accepted_forms(self.text, self.rule)) or ACCEPTED
        raise UserError(f"{what}; {advice}", self.source)


_UNITLESS = (NUMBER, ANGLE, SPIN, PERCENT)


def _fraction(text: str) -> Fraction:
    """Return a number as written, exactly. Raises OverflowError past the range of doubles."""
    number = text.replace(",", "")
    if "/" in number:
        integer, _, fraction = number.replace(" /", "/").replace("/ ", "/").rpartition(" ")
        return Fraction(integer or 0) + Fraction(fraction)
    value = double(number)
    if abs(value) == inf:
        raise OverflowError
    if not value:  # a Fraction of 1E-999999999 would take for ever
        return Fraction(0)
    try:
        return Fraction(number)
    except ValueError:  # a number to INPUT only, such as 1E
        return Fraction(value)


def nominal(name: str, text: str, source: str) -> str:
    """Return the nominal value of a value or range in base units, as text: a single value, mode or
    mean as written, else the middle of two limits. Raises UserError for any other text and for a
    tolerance without a value."""
    try:
        kind, amounts, *_ = parse(text)
    except ValueError:
        kind, amounts = "", (None,)
    first = amounts[1 if kind == "triangular" else 0]
    if first is None:
        raise UserError(f"{name} = {text!r} is not an amount; {ACCEPTED}", source)
    numbers = [a.sign + a.parts[0][0] for a in (first, amounts[-1]) if a]
    shares = name in SHARED and any("%" in amount.units for amount in amounts if amount)
    share = " %" if shares else ""
    if kind not in ("range", "uniform"):
        return numbers[0] + share
    return digits(float(sum(map(_fraction, numbers)) / 2)) + share


def _parse_entry(name: str, text: str, source: str) -> tuple[str, list[_Value]]:
    """Return an entry's text with ``{}`` in place of each amount, and the amounts; none if the
    entry is read, or refused, elsewhere."""
    if name in NO_AMOUNTS or not any(character.isdigit() for character in text):
        return text, []
    try:
        rule = quantity(name).unit
    except KeyError:
        return text, []
    if name in SHARED and "%" in text:
        return text, []
    words = " ".join(text.split())
    pattern, rules = _PHRASES.get(words.partition(" ")[0], (None, ()))
    if match := pattern and pattern.fullmatch(words):
        ends = [0, *(place for at in range(len(rules)) for place in match.span(at + 1)), None]
        between = [words[a:b] for a, b in zip(ends[::2], ends[1::2], strict=True)]
        parts = zip(match.groups(), rules, strict=True)
        return "{}".join(between), [
            _Value(name, part, part_rule or rule, source) for part, part_rule in parts
        ]
    return "{}", [_Value(name, text, rule, source)]


def in_base(
    texts: Mapping[str, str], source: str, units: str | None = None
) -> tuple[dict[str, str], str | None]:
    """Return the texts in base units and the name of their system, None without units.

    ``texts``: by name, as written, optionally with the entry ``units``; ``units``: the system of
    bare numbers if there is no such entry. Raises UserError if a text is not an amount, a unit does
    not measure the quantity, bare numbers stand among amounts with units, or units belong to two
    systems and none is named."""
    entries = dict(texts)
    system = system_named(units, "--units") if units else None
    if (name_of_system := entries.pop(ENTRY, None)) is not None:
        system = system_named(name_of_system, source)
    entry_values = {name: _parse_entry(name, text, source) for name, text in entries.items()}
    strict = system is None
    system = system or system_using(
        [use for _, values in entry_values.values() for value in values for use in value.uses],
        source,
    )
    strict = strict and not system.is_bare
    for name, (layout, values) in entry_values.items():
        if values and (not system.is_bare or not BARE.issuperset(entries[name])):
            entries[name] = layout.format(*(v.in_base(system, strict) for v in values))
    return entries, system.name or None


def text_in_base(name: str, text: str, system: System) -> str:
    """Return one entry in base units; bare numbers are in ``system``. Raises UserError."""
    layout, values = _parse_entry(name, text, "")
    return layout.format(*(v.in_base(system, False) for v in values)) if values else text


def convention_named(axes: str | None, headings: str | None, source: str) -> Convention | None:
    """Return the convention of that name; None for the listing's own. Raises UserError."""
    for name, text, choices in (("axes", axes, AXES), ("headings", headings, HEADINGS)):
        if text and text.lower() not in choices:
            choice_words = " or ".join(f'"{word}"' for word in choices)
            raise UserError(f"{name} = {quoted(text)}; expected {choice_words}", source)
    chosen = Convention(*((text or "").lower().replace("listing", "") for text in (axes, headings)))
    return chosen if any(chosen) else None


def in_listing_axes(texts: Mapping[str, str], system: System, source: str) -> dict[str, str]:
    """Return texts in base units, converted from the directions of ``system`` to the listing's.
    Raises UserError."""
    assert system.convention is not None
    turns = {name: system.convention.sign_and_offset(name) for name in texts}
    return {
        name: text
        if turn is None or not _has_digits(text)
        else reorient_text(name, text, *turn, source)
        for name, text in texts.items()
        for turn in [turns[name]]
    }


def _has_digits(text: str) -> bool:
    return any(map(str.isdigit, text))


def reorient_text(name: str, text: str, sign: int, offset: int, source: str = "") -> str:
    """Return the text of ``offset + sign * value`` for a number or range. Raises UserError."""
    if name in SHARED and "%" in text:
        raise UserError(f"{name} = {text}: a share has no sign to turn; expected MU", source)
    try:
        kind, amounts, _, layout = parse(text)
    except ValueError:
        raise UserError(f"{name} = {quoted(text)} is not an amount; {ACCEPTED}", source) from None
    if name == "MUP" and kind == "fixed" and double(text) == PIVOT:
        return text
    numbers = [amount.sign + amount.parts[0][0] if amount else "" for amount in amounts]
    places = {"around": 1, "normal": 1, "triangular": 3}.get(kind, len(numbers))
    new_numbers = [
        _reorient_number(text, sign, offset) if text else "" for text in numbers[:places]
    ]
    numbers = [
        *(reversed(new_numbers) if kind in ("range", "uniform", "triangular") else new_numbers),
        *(numbers[places:2] if kind == "normal" else numbers[places:]),
    ]
    if kind == "normal" and len(amounts) == 4:
        normal_limits = [amount.sign + amount.parts[0][0] for amount in amounts[2:] if amount]
        numbers += [_reorient_number(text, sign, offset) for text in reversed(normal_limits)]
    return layout.format(*numbers).lstrip()


def _reorient_number(text: str, sign: int, offset: int) -> str:
    """Return ``offset + sign * value`` of a number; its digits are kept if only the sign
    changes."""
    if not double(text):
        return str(offset) if offset else text
    if not offset and sign < 0:
        return opposite(text)
    return digits(float(offset + sign * _fraction(text)))


def middle_of(name: str, text: str, system: System, source: str) -> str:
    """Return the middle of a text as written, with its unit, to put a tolerance around."""
    if text.strip().startswith("estimate"):
        return "estimate"
    try:
        kind, amounts, *_ = parse(text)
    except ValueError:
        return text
    common = {unit for amount in amounts if amount for unit in amount.units}
    unit = common.pop() if len(common) == 1 else ""
    first = amounts[1 if kind == "triangular" else 0]
    if first is None:
        return ""
    if kind not in ("range", "uniform"):
        words = [f"{number} {part_unit or unit}".strip() for number, part_unit in first.parts]
        return first.sign + " ".join(words)
    ends = [amount for amount in amounts if amount]
    if all(len(end.parts) == 1 for end in ends) and (unit or not any(e.units for e in ends)):
        middle = (
            sum(_fraction(end.parts[0][0]) * (-1 if end.sign == "-" else 1) for end in ends) / 2
        )
        return f"{digits(float(middle))} {unit}".strip()
    nominal_text = nominal(name, text_in_base(name, text, system), source)
    rule = quantity(name).unit
    base = SYSTEMS[system.base_name].usual.get(rule, "")
    return f"{nominal_text} {base}".strip()


def shown_text(name: str, text: str, system: System) -> str:
    """Return a number in base units in the system's usual unit and directions, with the fewest
    digits that convert back to the same number; unchanged if the factor is 1."""
    turn = system.convention.sign_and_offset(name) if system.convention else None
    if turn and any(map(str.isdigit, text)) and "%" not in text:
        text = reorient_text(name, text, *turn)
        headings = system.convention is not None and system.convention.headings
        if headings and name in FROM_NORTH and is_number(text):
            return digits(double(text) % 360.0)
    factor = system.factor(name)
    if factor == 1 or not is_number(text):
        return text
    rule = quantity(name).unit
    size = size_of(system.usual[rule], rule)
    assert size is not None  # otherwise the factor is 1
    value, shortest, ratio = double(text), "", size[0] / system.scale(rule)
    for places in (15, 16, 17):
        shortest = f"{value * factor:.{places}g}".upper()
        try:
            is_same = float(_fraction(shortest) * ratio) == value
        except OverflowError:
            raise UserError(f"{name} = {shortest}: too large for a double; {ACCEPTED}") from None
        if is_same:
            break
    return shortest


def units_in(name: str, text: str) -> list[tuple[str, str]]:
    """Return the units in a text, each with its rule; none if it is not an amount."""
    try:
        return [use for value in _parse_entry(name, text, "")[1] for use in value.uses]
    except UserError:
        return []


def remarks(texts: Mapping[str, str], system: str | None) -> dict[str, str]:
    """Return remarks on the interpretation of entries, by name."""
    bare = [n for n in ("IA", "IB") if (text := texts.get(n, "").strip()) and is_number(text)]
    if system != "us" or not bare:
        return {}
    return {
        bare[0]: f"{' and '.join(bare)} without a unit: read as slug ft2 (lb-ft-s2); for pounds "
        "times feet squared write 'lb ft2', 1/32.17 of it"
    }
