"""Units, and amounts as people write them: sizes, systems, and the one grammar of numbers, units,
ranges and tolerances.

    -25 mph   3,091 lb   5 1/2 ft   6 ft 6 in   6'6"   8°30'   2,000 lb ft2   a number with a unit
    -31..-29 mph      30 mph .. 35 mph         between two values
    30 +- 2 mph       143.5 slug +- 5%         a middle and a half width (±, +/-)
    +- 2 mph          +- 5%                    the same, around the value known otherwise
    uniform A B    triangular A M B    normal MEAN SD [within A .. B]
    estimate          estimate +- 20 %         a yaw inertia (`collision.estimates`)

A unit that one number has and others lack belongs to all of them. Numbers that stand side by side
without a unit between them, or with a sign, are refused, and so is a comma that may be a decimal
one (1,234.5 can only be thousands). A bare number without any system of units stays the text it is,
digit for digit.

An amount is converted once, by exact fractions, to its system's base: ft, slug and s, or m, kg and
s; angles are in degrees, spins in radians a second. A unit is an expression of symbols ("slug ft2",
"lb-ft-s2"), whose dimension is worked out and compared with what a quantity measures: in "lb ft2"
only the mass gives an inertia, in "lb-ft-s2" only the force. A units library would take a quarter
of a second to import, and has one "lb".
"""

import re
from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from math import inf, isfinite
from typing import Any, NamedTuple, NoReturn

from ..errors import UserError, quoted
from ..names import NO_AMOUNTS, PIVOT, quantity
from .doubles import BARE, digits, double, is_number

_FOOT = Fraction("0.3048")
_POUND = Fraction("0.45359237")
_GRAVITY = Fraction("9.80665")
_SLUG = _POUND * _GRAVITY / _FOOT
_DEGREE = Fraction("0.017453292519943295769236907684886127134")

LENGTH, VELOCITY, MASS, SPIN = "length", "length/time", "mass", "rad/time"
INERTIA, ENERGY = "mass·length²", "mass·length²/time²"
FORCE, IMPULSE, TURNING = "mass·length/time²", "mass·length/time", "mass·length²/time"
TIME, ANGLE, NUMBER, PERCENT = "time", "degree", "1", "percent"

Dimension = tuple[int, ...]
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
    dimension: Dimension = (0, 0, 0, 0)
    size, systems, at = Fraction(1), set(), 0
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
        dimension = tuple(d + power * k for d, k in zip(dimension, known[0], strict=True))
        size *= known[1] ** power
        systems.add(known[2])
    systems -= {""}
    if len(systems) > 1:
        return None
    return dimension, size, systems.pop() if systems else ""


class Convention(NamedTuple):
    """Directions other than the listing's. ``axes``: "sae": y to the right of x, angles and spins
    clockwise; ``headings``: "compass": headings of the vehicles' fronts and courses clockwise from
    north, which is y (with "sae" x)."""

    axes: str = ""
    headings: str = ""

    def turned(self, name: str) -> tuple[int, int] | None:
        """Return sign and offset (degrees) by which a value in the listing's axes is shown, and a
        shown one read; None where it is the same."""
        if self.headings and name in COURSES:
            # A faces TA + 180
            return -1, (0 if self.axes else 90) + (180 if name == "TA" else 0)
        return (-1, 0) if self.axes and name in MIRRORED else None


AXES = ("listing", "sae")
"""What ``axes = "..."`` and ``--axes`` may say."""
HEADINGS = ("listing", "compass")
"""What ``headings = "..."`` and ``--headings`` may say."""
COURSES = ("TA", "TB", "HA", "HB", "HAF", "HBF")
"""Directions of vehicles and velocities."""
MIRRORED = frozenset(
    "UY WA VY WB VAY WAF VBY WBF YA YB YAF YBF GA PA PB TA TB HA HB HAF HBF PT PM MUP MUC "
    "CAY CBY CY".split()
)
"""What has the other sign where y and the sense of turning are the other way round. Left and right,
forward and PDOF are said in the vehicle, and stay."""


class System(NamedTuple):
    """A consistent set and how its quantities are written. ``base``: sizes of its length and mass
    in m and kg (its time is the second); ``usual``: the unit of a bare number, by what it
    measures; ``convention``: directions, where they are not the listing's."""

    name: str
    base: tuple[Fraction, Fraction]
    usual: dict[str, str]
    convention: Convention | None = None

    @property
    def is_bare(self) -> bool:
        """Whether no units are given: rules stand for units, and values are shown as they are."""
        return not self.usual

    @property
    def base_name(self) -> str:
        """The name of the system that is shown in these base units."""
        return "si" if self.base == _METRES else "chapter"

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

    def displayed(self, name: str, value: Any) -> Any:
        """Return values in base units and the listing's axes, numbers or arrays, as they are shown.
        The factor is put right by the last digits, so that what was typed as -25 is -25 again."""
        if isinstance(value, float) and isfinite(value):
            return double(shown_text(name, digits(value), self))
        turn = self.convention.turned(name) if self.convention else None
        if turn is None:
            factor = self.factor(name)
            return value if factor == 1 else value * factor
        sign, offset = turn
        if self.convention and self.convention.headings and name in COURSES:
            return (offset + sign * value) % 360.0
        # the pivot's -10 is no friction
        sign = 1 - 2 * (value != PIVOT) if name == "MUP" else sign
        return sign * value * self.factor(name)

    def is_turned(self, name: str) -> bool:
        """Return whether a value grows here where it falls in the listing's axes."""
        turn = self.convention.turned(name) if self.convention else None
        return turn is not None and turn[0] < 0

    def placed(self, name: str, value: Any) -> Any:
        """Return `displayed` values, directions not brought within a turn: limits stay in order."""
        turn = self.convention.turned(name) if self.convention else None
        if turn and name in COURSES:
            return turn[1] + turn[0] * value
        return self.displayed(name, value)

    def ends(self, name: str, low: Any, high: Any) -> tuple[Any, Any]:
        """Return two limits as they are placed, the lower one first."""
        low, high = (self.placed(name, end) for end in (low, high))
        return (high, low) if self.is_turned(name) else (low, high)

    def unit(self, name: str) -> str:
        """The unit a quantity is shown in; nothing for a mere number or where none is known."""
        label = self.label(quantity(name).unit)
        known = not self.is_bare and label not in (NUMBER, PERCENT, "bits")
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
    base = "m, kg, s" if system.base == _METRES else "ft, slug, s"
    return base if not system.is_bare else "any consistent units"


def gravity_in(system: System) -> float | None:
    """Standard gravity in the system's base units; None where there are no units."""
    return None if system.is_bare else float(_GRAVITY / system.base[0])


def system_of(name: str | None) -> System:
    """The system of that name, `RULES` for none."""
    return SYSTEMS[name] if name else RULES


def system_named(name: str, source: str) -> System:
    """The system of that name. Raises UserError."""
    if not isinstance(name, str) or name.lower() not in SYSTEMS:
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
            if rule in (VELOCITY, MASS)
        )

    return max((s for s in SYSTEMS.values() if s.base == base), key=matching)


def check_unit(unit: str, rule: str, what: str, source: str) -> None:
    """Raises UserError, naming ``what`` has it, for a unit that does not measure ``rule``."""
    if size_of(unit, rule) is None:
        measures = "a ratio" if rule == NUMBER else rule.replace("·", " ")
        raise UserError(f"{what}: {unit} is not a unit of {measures}", source)


def written(values: Mapping[str, float], system: System) -> dict[str, float]:
    """Values in base units as they are shown."""
    if system.is_bare and not system.convention:
        return dict(values)
    return {name: system.displayed(name, value) for name, value in values.items()}


ACCEPTED = (
    "expected a number, a number with its unit (-25 mph, 3,091 lb, 5 1/2 ft, 6 ft 6 in, 8 deg), "
    "'A .. B', 'N +- D', 'N +- P%', 'uniform A B', 'triangular A M B' or "
    "'normal MEAN SD [within A .. B]'"
)
ENTRY = "units"
"""The entry of a file that names its system."""
SHARED = ("MU", "MUP")
"""Ratios whose percentage is a share of something else; kept for the code that knows of what."""

_MEANT = str.maketrans(
    {"−": "-", "′": "'", "’": "'", "″": '"', "”": '"', "⋅": "·", "×": "*", "•": "·", "º": "°"}
    | {"\u00a0": " ", "\u202f": " ", "\u2009": " ", "½": " 1/2", "¼": " 1/4", "¾": " 3/4"}
)
_DECIMAL = r"(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_NUMBER = rf"\d{{1,3}}(?:,\d{{3}})+(?:\.\d*)?(?![\d,])|(?:\d+ )?\d+ ?/ ?\d+|{_DECIMAL}"
_DECIMAL_COMMA = re.compile(r"\d{1,3},\d{3}|0,.*")
"""What may be a number with a decimal comma, where the unit does not show how its writer counts; a
second comma, or a point behind it, shows that a comma divides thousands."""
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
"""Notations of a value known within limits: pattern, how many amounts each part holds, layout."""
_PHRASES: dict[str, tuple[re.Pattern[str], tuple[str, ...]]] = {
    "estimate": (re.compile(r"estimate(?: (.+))?"), ("",)),
    "skid": (re.compile(r"skid (.+) at (.+)"), (LENGTH, NUMBER)),
}
"""Phrases that hold values of their own: the pattern, and what each value measures ("": what the
entry does). Whoever reads the entry finds the phrase again, its values in base units."""


class Amount(NamedTuple):
    """One amount: its ``sign``, its numbers as written, each with its unit ("" for none)."""

    sign: str
    parts: tuple[tuple[str, str], ...]

    @property
    def units(self) -> list[str]:
        """The units it has."""
        return [unit for _, unit in self.parts if unit]


class Notation(NamedTuple):
    """A text taken apart: its ``kind`` ("fixed" or one of the notations above), its ``amounts`` in
    order (the middle of ``around`` may be None), whether the last is a share in percent, and its
    ``layout``."""

    kind: str
    amounts: tuple[Amount | None, ...]
    share: bool = False
    layout: str = "{}"

    @property
    def units(self) -> list[str]:
        """The units it has."""
        return [unit for amount in self.amounts if amount for unit in amount.units]


def parse(text: str) -> Notation:
    """A value or range taken apart. Raises ValueError for what is neither."""
    words = " ".join(text.replace("⁻¹", "^-1").replace("⁻²", "^-2").translate(_MEANT).split())
    if "..." in words or any(c.isdecimal() and not c.isascii() for c in words):
        raise ValueError(text)  # INPUT knows the Apple's digits alone
    for kind, pattern, counts, layout in _FORMS:
        if match := re.fullmatch(pattern, words):
            amounts: list[Amount | None] = []
            for part, count in zip(match.groups(), counts, strict=True):
                amounts += _split(part, count) if part or kind != "around" else [None]
            return Notation(kind, tuple(amounts), layout.endswith("%"), layout)
    if is_number(words) and not re.search(r"\d \d", words):
        return Notation("fixed", (Amount("", ((words, ""),)),))
    return Notation("fixed", (_amount(words),))


def _amount(text: str) -> Amount:
    sign = text[0] if text[:1] in ("+", "-") else ""
    rest = text.removeprefix(sign).lstrip()
    parts: list[tuple[str, str]] = []
    while rest:
        part = _PART.match(rest)
        if not part or (parts and not parts[-1][1]):
            raise ValueError(text)
        parts.append((part[1], part[2] or ""))
        rest = rest[part.end() :]
    if not parts or (len(parts) > 1 and not _descend([unit for _, unit in parts])):
        raise ValueError(text)
    return Amount(sign, tuple(parts))


def _descend(units: list[str]) -> bool:
    """Whether units are such as may follow one another: feet and inches, degrees and minutes."""
    for rule in (LENGTH, ANGLE, MASS):
        sizes = [size_of(unit, rule) for unit in units]
        if all(sizes) and all(a[0] > b[0] for a, b in pairwise(filter(None, sizes))):
            return len({system for _, system in filter(None, sizes)} - {""}) < 2
    return False


def _split(text: str, count: int) -> list[Amount]:
    """So many amounts that stand side by side. Raises ValueError unless there is one way."""
    if count == 1:
        return [_amount(text)]
    found = []
    for at in [match.start() for match in re.finditer(" ", text)]:
        try:
            found.append([_amount(text[:at]), *_split(text[at + 1 :], count - 1)])
        except ValueError:
            continue
    if len(found) != 1:
        raise ValueError(text)
    return found[0]


def is_amount(text: str, rule: str) -> bool:
    """Return whether a text is an amount of what ``rule`` measures, or limits of one, with no comma
    that may be a decimal one."""
    try:
        value = _Value("", text, rule, "", advise=False)
        based = value.based(RULES, False)
    except UserError:
        return False
    if value.notation.kind != "range":
        return True
    lower, _, upper = based.partition(" .. ")
    return double(lower) <= double(upper)


def _accepted_forms(text: str, rule: str) -> str:
    """How an amount is written that is not accepted as it stands; nothing where that is unclear."""
    from .suggestions import suggestions  # needed for a message only

    forms = suggestions(text.translate(_MEANT), lambda form: is_amount(form, rule))
    return f"write {' or '.join(map(quoted, forms))}" if forms else ""


class _Value:
    """The text of one entry, and what it measures. Raises UserError for what is not an amount."""

    def __init__(self, name: str, text: str, rule: str, source: str, advise: bool = True) -> None:
        self.text, self.advise = text, advise
        self.entry, self.rule, self.source = f"{name} = {text}", rule, source
        if rule == NUMBER and is_number(text):  # as INPUT takes it: "1 0" is ten
            self.notation = Notation("fixed", (Amount("", ((text.strip(), ""),)),))
            return
        try:
            self.notation = parse(text)
        except ValueError:
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
        """The units it has, each with what it measures."""
        return [(unit, self.rule) for unit in self.notation.units]

    def based(self, system: System, strict: bool) -> str:
        """The text in base units; ``strict``: bare numbers that measure something are refused."""
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
                    f"{self.entry} has no unit, and others have; expected one, or the system of "
                    f'bare numbers: units = "{system.name}" (--units {system.name})',
                    self.source,
                )
            numbers.append(self._number(amount, common or system.usual.get(self.rule, ""), system))
        return self.notation.layout.format(*numbers).lstrip()

    def _number(self, amount: Amount, usual: str, system: System) -> str:
        """One amount as a number of base units: the digits as written where no factor is needed."""
        known = [size_of(unit or usual, self.rule) for _, unit in amount.parts]
        sizes = [size[0] if size else Fraction(1) for size in known]
        scale = system.scale(self.rule) if usual or amount.units else Fraction(1)
        for (number, _), size in zip(amount.parts, known, strict=True):
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
        advice = (self.advise and _accepted_forms(self.text, self.rule)) or ACCEPTED
        raise UserError(f"{what}; {advice}", self.source)


_UNITLESS = (NUMBER, ANGLE, SPIN, PERCENT)


def _fraction(text: str) -> Fraction:
    """A number as written, exactly. Raises OverflowError where no double is as large."""
    number = text.replace(",", "")
    if "/" in number:
        whole, _, part = number.replace(" /", "/").replace("/ ", "/").rpartition(" ")
        return Fraction(whole or 0) + Fraction(part)
    value = double(number)
    if abs(value) == inf:
        raise OverflowError
    if not value:  # exponents of nine digits are not worked out
        return Fraction(0)
    try:
        return Fraction(number)
    except ValueError:  # what only INPUT takes, such as 1E
        return Fraction(value)


def nominal(name: str, text: str, source: str) -> str:
    """The single value that stands for a value or range in base units: as written where it is, the
    middle of two limits. Raises UserError for what is neither, and for a tolerance alone."""
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


def _taken_apart(name: str, text: str, source: str) -> tuple[str, list[_Value]]:
    """The values an entry holds, and its text with ``{}`` in place of each; no values where it is
    read elsewhere, or refused there."""
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
        return "{}".join(between), [_Value(name, part, own or rule, source) for part, own in parts]
    return "{}", [_Value(name, text, rule, source)]


def in_base(
    texts: Mapping[str, str], source: str, units: str | None = None
) -> tuple[dict[str, str], str | None]:
    """The texts in base units, and the name of their system (None where nothing says). ``texts``:
    by name, as they were written, and perhaps the entry ``units``; ``units``: the system of bare
    numbers, where no entry says. Raises UserError for what is not an amount, a unit that does not
    measure the quantity, for bare numbers among others with units, and for units of two systems
    where none is named."""
    entries = dict(texts)
    system = system_named(units, "--units") if units else None
    if (named := entries.pop(ENTRY, None)) is not None:
        system = system_named(named, source)
    held = {name: _taken_apart(name, text, source) for name, text in entries.items()}
    strict = system is None
    system = system or system_using(
        [use for _, values in held.values() for value in values for use in value.uses], source
    )
    strict = strict and not system.is_bare
    for name, (layout, values) in held.items():
        if values and (not system.is_bare or not BARE.issuperset(entries[name])):
            entries[name] = layout.format(*(v.based(system, strict) for v in values))
    return entries, system.name or None


def converted(name: str, text: str, system: System) -> str:
    """One entry in base units; its bare numbers are the system's. Raises UserError."""
    layout, values = _taken_apart(name, text, "")
    return layout.format(*(v.based(system, False) for v in values)) if values else text


def convention_named(axes: str | None, headings: str | None, source: str) -> Convention | None:
    """Return the convention of that name; None for the listing's own. Raises UserError."""
    for name, text, known in (("axes", axes, AXES), ("headings", headings, HEADINGS)):
        if text and text.lower() not in known:
            expected = " or ".join(f'"{word}"' for word in known)
            raise UserError(f"{name} = {quoted(text)}; expected {expected}", source)
    chosen = Convention(*((text or "").lower().replace("listing", "") for text in (axes, headings)))
    return chosen if any(chosen) else None


def in_listing_axes(texts: Mapping[str, str], system: System, source: str) -> dict[str, str]:
    """Return texts in base units, from the directions of ``system`` to the listing's. Raises
    UserError."""
    assert system.convention is not None
    turns = {name: system.convention.turned(name) for name in texts}
    return {
        name: text if turn is None else turned(name, text, *turn, source)
        for name, text in texts.items()
        for turn in [turns[name]]
    }


def opposite(text: str) -> str:
    """Return a number, or limits, in base units with the other sign."""
    return turned("", text, -1, 0)


def turned(name: str, text: str, sign: int, offset: int, source: str = "") -> str:
    """Return a number, or limits, of ``offset + sign * value``."""
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
    turned = [_number_turned(text, sign, offset) if text else "" for text in numbers[:places]]
    numbers = [
        *(reversed(turned) if kind in ("range", "uniform", "triangular") else turned),
        *(numbers[places:2] if kind == "normal" else numbers[places:]),
    ]
    if kind == "normal" and len(amounts) == 4:
        ends = [amount.sign + amount.parts[0][0] for amount in amounts[2:] if amount]
        numbers += [_number_turned(text, sign, offset) for text in reversed(ends)]
    return layout.format(*numbers).lstrip()


def _number_turned(text: str, sign: int, offset: int) -> str:
    """Return ``offset + sign * value`` of a number, its digits kept where only the sign changes."""
    if not double(text):
        return str(offset) if offset else text
    if not offset and sign < 0:
        return text[1:] if text[0] == "-" else "-" + text.removeprefix("+")
    return digits(float(offset + sign * _fraction(text)))


def middle_of(name: str, text: str, system: System, source: str) -> str:
    """Return the middle of a text as it was written, with its unit: what a tolerance alone is
    around."""
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
        words = [f"{number} {own or unit}".strip() for number, own in first.parts]
        return first.sign + " ".join(words)
    ends = [amount for amount in amounts if amount]
    if all(len(end.parts) == 1 for end in ends) and (unit or not any(e.units for e in ends)):
        middle = (
            sum(_fraction(end.parts[0][0]) * (-1 if end.sign == "-" else 1) for end in ends) / 2
        )
        return f"{digits(float(middle))} {unit}".strip()
    based = nominal(name, converted(name, text, system), source)
    rule = quantity(name).unit
    base = SYSTEMS[system.base_name].usual.get(rule, "")
    return f"{based} {base}".strip()


def shown_text(name: str, text: str, system: System) -> str:
    """A number in base units as one of the system's usual units, in its directions: the fewest
    digits that are read as the same number again; as it stands where no factor is needed."""
    turn = system.convention.turned(name) if system.convention else None
    if turn and any(map(str.isdigit, text)) and "%" not in text:
        text = turned(name, text, *turn)
        headings = system.convention is not None and system.convention.headings
        if headings and name in COURSES and is_number(text):
            return digits(double(text) % 360.0)
    factor = system.factor(name)
    if factor == 1 or not is_number(text):
        return text
    value, rounded = double(text), ""
    for places in (15, 16, 17):
        rounded = f"{value * factor:.{places}g}".upper()
        if double(converted(name, rounded, system)) == value:
            break
    return rounded


def units_in(name: str, text: str) -> list[tuple[str, str]]:
    """The units in a text, each with what it measures; none where it is not an amount."""
    try:
        return [use for value in _taken_apart(name, text, "")[1] for use in value.uses]
    except UserError:
        return []


def remarks(texts: Mapping[str, str], system: str | None) -> dict[str, str]:
    """What a reader should know of how entries were understood, by name."""
    bare = [n for n in ("IA", "IB") if (text := texts.get(n, "").strip()) and is_number(text)]
    if system != "us" or not bare:
        return {}
    return {
        bare[0]: f"{' and '.join(bare)} without a unit: read as slug ft2 (lb-ft-s2); for pounds "
        "times feet squared write 'lb ft2', 1/32.17 of it"
    }
