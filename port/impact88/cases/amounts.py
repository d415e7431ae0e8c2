"""Amounts: a number with its unit and its tolerance, as written and as computed.

    25    -25 mph    3,091 lb    6 ft 6 in            one value
    28 .. 32 mph     uniform 28 32 mph                between two values
    30 +- 2 mph      30 mph +- 5 %                    a middle and its half width (± is +-)
    triangular 28 30 33                               lower limit, most likely value, upper limit
    normal 30 1.5                                     mean and standard deviation
    85 %                                              of MU: a share of the critical friction
    skid 62 ft at 0.7 +- 0.05                         of SAF, SBF: a skid to rest

A unit beside one of the numbers is the unit of all. Every number is an exact fraction until it is
in base units (`units`), so that the digits of a bare number reach the 1988 program as typed.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any, Literal, NamedTuple

from ..decimals import negated, to_text
from ..errors import UserError, quoted
from ..names import LENGTH, PERCENT, PIVOT, quantity
from .units import GRAVITY, PLAIN, Unit, View, shown_unit, unit_of

Kind = Literal["exact", "uniform", "triangular", "normal"]

TOLERANCE = "+-"
"""Mark of a half width; ± and +/- are read as this."""
MAX_DRAG = 2.0  # tires on dry pavement reach about 1; 7 is a lost point
SPEEDS = ("SA", "SB", "SAF", "SBF")
"""Speeds: sizes, whose directions are HA HB HAF HBF."""
WORDS = {
    "course": (math.nan, ("TA", "TB")),  # known once the velocity is
    "locked": (PIVOT, ("MU", "MUP")),
    "-10": (PIVOT, ("MU", "MUP")),  # which has no direction
    "inf": (math.inf, ("MA", "MB", "IA", "IB")),  # a barrier
}
"""Words in place of a number, with its value and the quantities that may have it."""
MAX_LENGTH = 70  # characters of an entry; three and their commas fit the 239 that INPUT keeps
EXPECTED = (
    "expected such as 25, 28 .. 32, 30 +- 2, 30 +- 5 %, normal 30 1.5, triangular 28 30 33, with "
    "a unit or without (mph, ft, lb, deg); course of TA TB, locked of MU, estimate of IA IB, skid "
    "60 ft at 0.7 of SAF SBF"
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
        For limits in the wrong order, or a negative standard deviation.

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
        is_ordered = math.isnan(self.value) or self.low <= self.value <= self.high
        if not is_ordered or self.sd < 0:
            raise UserError("expected the lower limit first, and no negative tolerance")

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
        width = reach * self.sd if self.kind == "normal" else math.inf
        return max(self.low, self.value - width), min(self.high, self.value + width)

    def mapped(self, factor: Fraction, offset: Fraction = Fraction(0)) -> Amount:
        """Return ``offset + factor * self``, each number correctly rounded.

        The digits are kept where only the sign changes.

        Parameters
        ----------
        factor : Fraction
            The scale.
        offset : Fraction, default 0
            Added to the product.

        Returns
        -------
        Amount

        Raises
        ------
        OverflowError
            Beyond the range of doubles.

        Examples
        --------
        >>> from fractions import Fraction
        >>> Amount.exactly(2.5, "2.50").mapped(Fraction(-1)).text
        '-2.50'
        """

        def image(x: float | Fraction) -> float:
            return float(offset + factor * Fraction(x)) if math.isfinite(x) else float(factor) * x

        value, *ends = map(image, (self.value, self.low, self.high))
        text = "" if offset or abs(factor) != 1 else self.text
        if text and factor < 0 and value:
            text = negated(text)
        return Amount(
            value,
            min(ends),
            max(ends),
            self.kind if ends[0] != ends[1] else "exact",
            float(abs(factor) * Fraction(self.sd)),
            text,
            self.share,
        )


# -- the notation

_DIGITS = r"(?:[1-9]\d{0,2}(?:,\d{3})+(?!\d)(?:\.\d*)?|\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_NUMBER = re.compile(
    rf"([-+]? ?{_DIGITS}) ?"
    rf"(?:(?:ft|foot|feet) ?(\d+\.?\d*) ?(in|inch|inches)|([a-zA-Z°%].*))?",
    re.ASCII,
)
_SKID = re.compile(r"skid (.+) at ((?:[-+.\d]|normal |uniform |triangular ).*)")
_SPELLINGS = str.maketrans({"−": "-", "–": "-", "º": "°", "±": TOLERANCE})
_COUNTS = {"uniform": 2, "triangular": 3, "normal": 2, "around": 2}
"""Kinds of several numbers; the first word of a text may be one. "around": a middle and its half
width."""
_MARKS = {"around": TOLERANCE, "uniform": ".."}
"""Marks between the numbers of kinds."""


class Numeral(NamedTuple):
    """A number as written: its exact value, its unit, and its digits ("" of feet and inches)."""

    value: Fraction
    unit: Unit | None
    digits: str


def read(name: str, text: str, view: View = PLAIN) -> Amount:
    """Return the amount that a text gives a quantity, in base units along the listing's axes.

    Parameters
    ----------
    name : str
        The quantity, a name of `names`.
    text : str
        As in a file, in the notation at the head of this module.
    view : View, optional
        Units, axes and headings of the file.

    Raises
    ------
    UserError
        For any other text, a unit that does not measure the quantity, a comma that may be a decimal
        one, limits in the wrong order, a negative speed, and numbers beyond the range of doubles.

    Examples
    --------
    >>> read("UX", "30 +- 5 %", View("us")).high
    46.2
    >>> read("TB", "271 +- 1 %", View(headings="compass")).low
    -183.71
    """
    words = normalize(text)
    entry = f"{name} = {quoted(words)}"
    value, names = WORDS.get(words.lower(), (0.0, ()))
    if name in names:
        return Amount.exactly(value)
    try:
        if len(words) > MAX_LENGTH:
            raise UserError(f"is longer than {MAX_LENGTH} characters; expected an amount")
        amount = (_skid if words.startswith("skid") else _amount)(name, words, view)
        if name in SPEEDS and amount.limits(0.0)[0] < 0:
            raise UserError(
                f"a speed is not negative; expected 0 or more, or H{name[1:]} turned by 180"
            )
        return amount
    except UserError as error:
        raise UserError(f"{entry}: {error}") from None
    except OverflowError:
        raise UserError(f"{entry} is beyond the range of doubles") from None
    except ValueError:
        raise UserError(f"{entry} is not an amount; {EXPECTED}") from None


def normalize(text: str) -> str:
    """Return a text with one spelling of signs and blanks."""
    return " ".join(text[: MAX_LENGTH + 1].translate(_SPELLINGS).replace("+/-", TOLERANCE).split())


@lru_cache(maxsize=4096)
def parse(rule: str, words: str) -> tuple[Any, tuple[Numeral, ...]]:
    """Return the kind of a `normalize`d amount, one of `Amount` or "around" for a half width, and
    its numbers.

    Raises ValueError for a text that is no amount, UserError for one refused for another reason,
    OverflowError for numbers beyond the range of doubles."""
    kind, _, remainder = words.partition(" ")
    parts = re.split(r" (?=[-+]?\.?\d)", remainder)
    if kind not in _COUNTS:
        kind = next((kind for kind, mark in _MARKS.items() if mark in words), "exact")
        parts = words.split(_MARKS[kind]) if kind in _MARKS else [words]
    if len(parts) != _COUNTS.get(kind, 1) or "..." in words:
        raise ValueError(words)
    if kind == "around" and parts[1].endswith("%"):
        if rule == PERCENT or "%" in parts[0]:
            raise UserError("a percentage of a percentage; expected such as '37 +- 2'")
        middle, share = _number(rule, parts[0]), _number(PERCENT, parts[1]).value / 100
        return kind, (middle, middle._replace(value=abs(middle.value) * share))
    return kind, tuple(_number(rule, part) for part in parts)


def _number(rule: str, text: str) -> Numeral:
    """Return the one number of a text. Raises ValueError, and OverflowError beyond the range of
    doubles."""
    match = _NUMBER.fullmatch(text.strip())
    if match is None:
        raise ValueError(text)
    digits, inches, inch, symbol = match.groups(default="")
    plain = re.sub("[, ]", "", digits)
    if math.isinf(float(plain)):
        raise OverflowError
    value = Fraction(plain) if float(plain) else Fraction(0)  # 1E-999999999, too
    if inches:
        value = 12 * value + Fraction("-" * digits.startswith("-") + inches)
    unit = unit_of(rule, inch or symbol) if inch or symbol else None
    return Numeral(value, unit, "" if inches else plain)


def _amount(name: str, words: str, view: View) -> Amount:
    """Return the amount of a `normalize`d text in base units. Raises as `parse` does."""
    rule = quantity(name).unit
    kind, numbers = parse(rule, words)
    units = [number.unit for number in numbers if number.unit]
    if units and name == "MUP":
        raise UserError("expected a number without %; MU takes shares of the critical")
    unit = units[0] if units else shown_unit(rule, view.units)
    if "," in words and {each.side for each in (unit, *units)} != {"us"}:
        raise UserError(
            f"the comma may be a decimal one; expected {words.replace(',', '')}, or a decimal point"
        )
    values: list[Any] = [  # exact fractions, until they are mapped
        number.value * (number.unit or unit).size / unit.size for number in numbers
    ]
    place = (len(values) - 1) // 2  # of the nominal value
    value, low, high, sd = values[place], values[0], values[-1], 0.0
    digits = numbers[place].digits
    if kind == "uniform":
        value, digits = (low + high) / 2, ""
    elif kind == "around":
        kind, low, high = "uniform", value - high, value + high
    elif kind == "normal":
        sd = high
        reach = math.inf if sd else 0
        low, high = value - reach, value + reach
    amount = Amount(value, low, high, kind, sd, digits, name == "MU" and bool(units))
    return amount.mapped(*view.map(name, unit.symbol))


def _skid(name: str, words: str, view: View) -> Amount:
    """Return the speed at the start of a skid to rest, v = sqrt(2 mu g d).

    One distribution is kept between the limits of the speed; of two, the speed is taken as normal.
    Raises UserError."""
    match = _SKID.fullmatch(words)
    if name not in ("SAF", "SBF"):
        raise UserError("a skid to rest gives a speed after the impact; expected SAF or SBF")
    if match is None or not view.units:
        raise UserError("expected distance, unit and friction, such as skid 60 ft at 0.7")
    distance, friction = parts = read("DA", match[1], view), read("E", match[2])
    (near, far), (slick, rough) = (part.limits() for part in parts)
    if min(near, slick) <= 0 or rough > MAX_DRAG:
        raise UserError(f"expected a distance and a friction above 0, and at most {MAX_DRAG:g}")
    gravity = float(GRAVITY / view.base_size(LENGTH))
    products = near * slick, distance.value * friction.value, far * rough
    slow, value, fast = (math.sqrt(2 * gravity * product) for product in products)
    kinds = [part.kind for part in parts if part.varies] or ["exact"]
    kind = kinds[0] if len(kinds) == 1 else "normal"
    spread = math.hypot(*(part.standard_deviation / part.value for part in parts))
    return Amount(value, slow, fast, kind, value / 2 * spread if kind == "normal" else 0.0)
