"""Amounts: a number with its unit and its tolerance, as written and as computed.

    25    -25 mph    3,091 lb    6 ft 6 in            one value
    28 .. 32 mph     uniform 28 32 mph                between two values
    30 +- 2 mph      30 mph +- 5 %                    a middle and its half width (± is +-)
    triangular 28 30 33                               lower limit, most likely value, upper limit
    normal 30 1.5                                     mean and standard deviation
    85 %                                              of MU: a share of the critical friction
    skid 62 ft at 0.7 +- 0.05                         of a speed: a skid to rest

A unit beside one of the numbers is the unit of all. Every number is an exact fraction until it is
in base units (`units`), so that the digits of a bare number reach the 1988 program as typed.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any, Literal, NamedTuple

from ..decimals import exact, is_number, negated, to_double, to_text
from ..errors import UserError, quoted
from ..names import INERTIA, LENGTH, MASS, NUMBER, PERCENT, PIVOT, quantity
from .units import DIMENSIONS, GRAVITY, PLAIN, View, system_using, unit_of

Kind = Literal["exact", "uniform", "triangular", "normal"]
Ends = tuple[Fraction | float, Fraction | float]

TOLERANCE = "+-"
"""Mark of a half width; ± and +/- are read as this."""
SKIDDING = ("SA", "SB", "SAF", "SBF")
MAX_LENGTH = 200  # characters of an entry; bounds the time to read it
EXPECTED = (
    "expected such as 25, -25 mph, 6 ft 6 in, 28 .. 32 mph, 30 +- 2 mph, 30 +- 5 %, "
    "normal 30 1.5, triangular 28 30 33"
)


@dataclass(frozen=True, slots=True)
class Amount:
    """A value, exact or known within limits: the one type of uncertainty in this package.

    Parameters
    ----------
    value : float
        Nominal value: the only one, the middle, the mode or the mean.
    low, high : float
        Limits; equal to ``value`` if exact, infinite for a normal.
    kind : {"exact", "uniform", "triangular", "normal"}, default "exact"
        Distribution between the limits.
    sd : float, default 0
        Standard deviation of a normal.
    text : str, default ""
        Digits of ``value`` as typed, where no conversion has changed them.
    share : bool, default False
        True if the numbers are shares of the critical friction (``MU = "85 %"`` is 0.85).

    Raises
    ------
    UserError
        For an unknown kind, limits in the wrong order, or a negative standard deviation.

    Examples
    --------
    >>> from fractions import Fraction
    >>> Amount(30.0, 28.0, 32.0, "uniform").mapped(Fraction(-2), Fraction(90)).low
    26.0
    """

    value: float
    low: float
    high: float
    kind: Kind = "exact"
    sd: float = 0.0
    text: str = ""
    share: bool = False

    def __post_init__(self) -> None:
        if self.kind not in ("exact", "uniform", "triangular", "normal"):
            raise UserError(
                f"kind is {quoted(self.kind)}; expected exact, uniform, triangular or normal"
            )
        if self.low > self.high or not (math.isnan(self.value) or self.low <= self.value):
            raise UserError(
                f"limits {self.low:g} and {self.high:g} around {self.value:g}; "
                "expected low <= value <= high"
            )
        if not self.sd >= 0:
            raise UserError(f"the standard deviation is {self.sd:g}; expected 0 or more")

    @classmethod
    def exactly(cls, value: float, text: str = "") -> Amount:
        """Return an exact amount.

        Parameters
        ----------
        value : float
            The value.
        text : str, optional
            Its digits as typed.
        """
        return cls(value, value, value, text=text)

    @property
    def varies(self) -> bool:
        """True if the value is known within limits only."""
        return self.kind != "exact"

    @property
    def typed(self) -> str:
        """The digits of the nominal value for the 1988 program."""
        return self.text.upper() or to_text(self.value)

    @property
    def standard_deviation(self) -> float:
        """Standard deviation of the distribution, 0 if exact."""
        a, c, b = self.low, self.value, self.high
        if self.kind == "uniform":
            return (b - a) / math.sqrt(12)
        if self.kind == "triangular":
            return math.sqrt(((b - a) ** 2 + (c - a) * (c - b)) / 18)
        return self.sd

    def limits(self, reach: float = 3.0) -> tuple[float, float]:
        """Return lower and upper limit.

        Parameters
        ----------
        reach : float, default 3
            Where a normal ends, in standard deviations.

        Returns
        -------
        tuple of float
        """
        if self.kind != "normal":
            return self.low, self.high
        width = reach * self.sd
        return max(self.low, self.value - width), min(self.high, self.value + width)

    def mapped(self, factor: Fraction, offset: Fraction = Fraction(0)) -> Amount:
        """Return ``offset + factor * self``, each number correctly rounded.

        Digits as typed are mapped exactly, and kept where only the sign changes.

        Parameters
        ----------
        factor : Fraction
            The scale.
        offset : Fraction, default 0
            Added to the product.

        Returns
        -------
        Amount

        Examples
        --------
        >>> from fractions import Fraction
        >>> Amount.exactly(2.5, "2.50").mapped(Fraction(-1)).text
        '-2.50'
        """
        if factor == 1 and not offset:
            return self
        value = exact(self.text) if self.text else self.value
        return _image(self, value, (self.low, self.high), self.sd, factor, offset)


def _image(
    like: Amount,
    value: Fraction | float,
    ends: Ends,
    sd: Fraction | float,
    factor: Fraction,
    offset: Fraction,
) -> Amount:
    """Return the amount of the kind and digits of ``like`` whose numbers are the images of these.

    Raises OverflowError beyond the range of doubles."""

    def image(x: Fraction | float) -> float:
        if isinstance(x, float) and not math.isfinite(x):
            return x * (1 if factor > 0 else -1)
        return float(offset + factor * Fraction(x))

    nominal, text = image(value), ""
    if offset == 0 and abs(factor) == 1 and like.text:
        text = negated(like.text) if factor < 0 and nominal else like.text
    if like.kind == "exact":
        return Amount(nominal, nominal, nominal, text=text, share=like.share)
    low, high = map(image, ends if factor > 0 else ends[::-1])
    spread = float(abs(factor) * Fraction(sd))
    return Amount(nominal, low, high, like.kind, spread, text, like.share)


# -- the notation

_DIGITS = r"(?:\d{1,3}(?:,\d{3})+(?!\d)(?:\.\d*)?|\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_UNIT = r"[a-zA-Z°%](?:[a-zA-Z°/·*.^²-]|[23](?!\d)| (?=[a-zA-Z/·*]))*"
_PART = re.compile(rf"([-+]?) ?({_DIGITS}) ?({_UNIT})? ?")
_SKID = re.compile(r"skid (.+) at (.+)")
_SPELLINGS = str.maketrans({"−": "-", "–": "-", "⋅": "·", "×": "*", "º": "°", "±": TOLERANCE})
_DECIMAL_COMMA = re.compile(r"\d{1,3},\d{3}")
_COUNTS = {"uniform": 2, "triangular": 3, "normal": 2}
"""Kinds that are named, with how many numbers follow."""


class Number(NamedTuple):
    """A number as written: its exact value, the symbol of its unit ("" without), and its digits
    ("" of one in several units, such as feet and inches)."""

    value: Fraction
    unit: str
    digits: str


class Notation(NamedTuple):
    """An amount as written, with exact numbers in one ``unit`` ("" without); otherwise as
    `Amount`."""

    unit: str
    kind: Kind
    value: Fraction | float
    ends: Ends
    sd: Fraction = Fraction(0)
    text: str = ""


def read(name: str, text: str, view: View = PLAIN, unit: str = "") -> Amount:
    """Return the amount that a text gives a quantity, in base units along the listing's axes.

    Parameters
    ----------
    name : str
        The quantity, a name of `names`.
    text : str
        As in a file, in the notation at the head of this module.
    view : View, optional
        Units, axes and headings of the file.
    unit : str, optional
        The unit of a bare number, by default that of the view.

    Raises
    ------
    UserError
        For any other text, a unit that does not measure the quantity, a comma that may be a decimal
        one, limits in the wrong order, and numbers beyond the range of doubles.

    Examples
    --------
    >>> read("UX", "30 +- 5 %", View("us")).high
    46.2
    >>> read("TB", "271 +- 1 %", View(headings="compass")).low
    -183.71
    """
    words = normalize(text)
    if match := _SKID.fullmatch(words):
        return _skid(name, match[1], match[2], view)
    if words.lower() == "inf" and quantity(name).unit in (MASS, INERTIA):
        return Amount.exactly(math.inf)  # a barrier
    notation = parse(name, words, unit or view.unit(name))
    if notation.unit and not view.units and quantity(name).unit in DIMENSIONS:
        raise UserError(f"{name} = {quoted(text)} has a unit; expected units, too, such as us")
    factor, offset = view.map(name, notation.unit or unit)
    if name == "MUP" and notation.value == PIVOT:
        factor = abs(factor)  # the pivot's mark has no direction
    share = name == "MU" and notation.unit == "%"
    like = Amount(0.0, 0.0, 0.0, notation.kind, text=notation.text, share=share)
    try:
        return _image(like, notation.value, notation.ends, notation.sd, factor, offset)
    except OverflowError:
        raise UserError(f"{name} = {quoted(text)} is beyond the range of doubles") from None


def normalize(text: str) -> str:
    """Return a text with one spelling of signs and blanks."""
    return " ".join(text[: MAX_LENGTH + 1].translate(_SPELLINGS).replace("+/-", TOLERANCE).split())


def units_in(name: str, text: str) -> list[tuple[str, str]]:
    """Return rule and symbol of the unit of an amount, none if it is a bare number. Raises
    UserError for a text that is no amount."""
    words = normalize(text)
    if match := _SKID.fullmatch(words):
        return units_in("DA", match[1])
    unit = parse(name, words, None).unit
    return [(quantity(name).unit, unit)] if unit else []


def parse(name: str, words: str, usual: str | None) -> Notation:
    """Return the notation of a `normalize`d text.

    ``usual``: the unit of a bare number, which decides what its comma means; None takes any comma.
    Raises UserError."""
    entry = f"{name} = {quoted(words)}"
    if len(words) > MAX_LENGTH:
        raise UserError(f"{entry} is longer than {MAX_LENGTH} characters; expected an amount")
    rule = quantity(name).unit
    try:
        kind, numbers = _numbers(rule, words)
        unit, values = _in_one_unit(rule, numbers)
        if usual is not None:
            _check_commas(rule, numbers, unit or usual)
    except UserError as error:
        raise UserError(f"{entry}: {error}") from None
    except ValueError:
        raise UserError(f"{entry} is not an amount; {EXPECTED}") from None
    if name in ("MUP", "RR0") and unit:
        raise UserError(f"{entry}: expected a number without %; MU takes shares of the critical")
    nominal = numbers[1 if kind == "triangular" else 0]
    text = "" if kind == "uniform" else nominal.digits.replace(",", "")
    notation = _notation(kind, values, unit, text)
    low, high = notation.ends
    if not low <= notation.value <= high or notation.sd < 0:
        raise UserError(f"{entry}: expected the lower limit first, and no negative tolerance")
    return notation._replace(kind="exact") if low == high else notation


def _notation(kind: Any, values: Sequence[Fraction], unit: str, text: str) -> Notation:
    """Return the notation of the values of a kind of `_numbers`."""
    first, last = values[0], values[-1]
    if kind == "normal":
        ends = (-math.inf, math.inf) if last else (first, first)
        return Notation(unit, kind, first, ends, last, text)
    if kind == "around":
        return Notation(unit, "uniform", first, (first - last, first + last), text=text)
    middle = values[1] if kind == "triangular" else (first + last) / 2
    return Notation(unit, kind, middle, (first, last), text=text)


def _numbers(rule: str, words: str) -> tuple[str, list[Number]]:
    """Return the kind of an amount, one of `Amount` or "around" for a half width, and its numbers.

    Raises ValueError for a text that is no amount, UserError for one refused for another reason."""
    kind, _, remainder = words.partition(" ")
    if kind in _COUNTS:
        numbers = _parts(rule, remainder)
        if len(numbers) != _COUNTS[kind]:
            raise ValueError(words)
        return kind, numbers
    first, mark, second = (part.strip() for part in words.partition(TOLERANCE))
    if mark and second.endswith("%"):
        if rule == PERCENT or "%" in first:
            raise UserError("a percentage of a percentage; expected such as '37 +- 2'")
        middle, share = _number(rule, first), _number(NUMBER, second.rstrip("% "))
        return "around", [
            middle,
            share._replace(value=abs(middle.value) * share.value / 100, unit=middle.unit),
        ]
    if mark:
        return "around", [_number(rule, first), _number(rule, second)]
    first, mark, second = (part.strip() for part in words.partition(".."))
    if mark and "..." not in words:
        return "uniform", [_number(rule, first), _number(rule, second)]
    if is_number(words) and not re.search(r"\d \d", words):  # as INPUT takes it: "." is 0
        return "exact", [Number(_fraction(words), "", words.replace(" ", ""))]
    return "exact", [_number(rule, words)]


def _parts(rule: str, words: str) -> list[Number]:
    """Return the numbers of a text side by side. Raises ValueError."""
    parts: list[Number] = []
    place = 0
    while place < len(words) or not parts:
        match = _PART.match(words, place)
        if match is None:
            raise ValueError(words)
        sign, digits, symbol = match.groups(default="")
        unit = unit_of(rule, symbol).symbol if symbol else ""
        parts.append(Number(_fraction(sign + digits), unit, sign + digits))
        place = match.end()
    return parts


def _number(rule: str, words: str) -> Number:
    """Return the one number of a text: a part, or parts of smaller and smaller units, of which none
    but the first has a sign. Raises ValueError."""
    first, *smaller = _parts(rule, words)
    if not smaller:
        return first
    value = abs(first.value)
    for larger, part in pairwise((first, *smaller)):
        ratio = _ratio(rule, part.unit, larger.unit)
        if not 0 < ratio < 1 or part.digits[0] in "+-":
            raise ValueError(words)
        value += part.value * _ratio(rule, part.unit, first.unit)
    return Number(-value if first.digits[0] == "-" else value, first.unit, "")


def _ratio(rule: str, unit: str, other: str) -> Fraction:
    """Return the size of a unit in another one, 0 if there are not two, 1 for the same."""
    if unit == other:
        return Fraction(1)
    return unit_of(rule, unit).size / unit_of(rule, other).size if unit and other else Fraction(0)


def _in_one_unit(rule: str, numbers: Sequence[Number]) -> tuple[str, list[Fraction]]:
    """Return the unit of the first number that has one, and the values in it. Raises UserError for
    numbers without beside several units."""
    units = [number.unit for number in numbers if number.unit]
    is_mixed = len({*units}) > 1 or not all(number.digits for number in numbers)
    if is_mixed and len(units) < len(numbers):
        raise UserError("expected a unit beside each number")
    common = units[0] if units else ""
    return common, [n.value * _ratio(rule, n.unit or common, common) for n in numbers]


def _check_commas(rule: str, numbers: Sequence[Number], unit: str) -> None:
    """Raise UserError for a comma that may be a decimal one: 1,234 is a thousand only with an
    American unit."""
    is_american = bool(unit) and unit_of(rule, unit).side == "us"
    for number in numbers:
        digits = number.digits.lstrip("+-")
        if _DECIMAL_COMMA.fullmatch(digits) and (digits[0] == "0" or not is_american):
            choices = f"{digits.replace(',', '')} or {digits.replace(',', '.')}"
            raise UserError(f"the comma of {digits} may be a decimal one; expected {choices}")


def _fraction(digits: str) -> Fraction:
    """Return a number as written, exactly; 0 where it is 0 as a double. Raises UserError beyond the
    range of doubles."""
    plain = digits.replace(",", "")
    value = to_double(plain)
    if math.isinf(value):
        raise UserError(f"{digits} is beyond the range of doubles")
    return exact(plain) if value else Fraction(0)


def _skid(name: str, distance: str, friction: str, view: View) -> Amount:
    """Return the speed at the start of a skid to rest, v = sqrt(2 mu g d).

    Distance and friction are independent. One that varies gives the speed its distribution; two
    give a normal within the limits of both, its standard deviation to first order."""
    entry = f"{name} = skid {distance} at {friction}"
    if name not in SKIDDING:
        raise UserError(f"{entry}: a skid is a speed; expected {', '.join(SKIDDING)}")
    system = view.units or system_using(units_in("DA", distance))
    if not system:
        raise UserError(f"{entry} needs units; expected such as 'skid 62 ft at 0.7'")
    parts = [read("DA", distance, View(system)), read("E", friction)]
    low, high = zip(*(part.limits() for part in parts), strict=True)
    if min(low) <= 0:
        raise UserError(f"{entry}: expected a distance and a friction above 0")
    gravity = float(GRAVITY / View(system).base_size(LENGTH))
    slow, value, fast = (
        math.sqrt(2 * gravity * d * mu) for d, mu in (low, [part.value for part in parts], high)
    )
    kinds = [part.kind for part in parts if part.varies] or ["exact"]
    kind = kinds[0] if len(kinds) == 1 else "normal"
    spread = math.hypot(*(part.standard_deviation / part.value for part in parts))
    return Amount(value, slow, fast, kind, value / 2 * spread if kind == "normal" else 0.0)
