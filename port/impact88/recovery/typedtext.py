"""From what the program printed back to what was typed: decimal texts that print as shown.

A printed value has at most nine digits, and need not read back to itself: a typed -64.42 prints as
-64.4200001. Angles go the longer way of lines 300 and 600, into radians and back, so that -133 may
print as -132.999999. And a value may have been typed with zeros that do not print, which can
change its last bit (72.80 is 7280 divided twice by ten, 72.8 is 728 divided once).
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from decimal import ROUND_HALF_EVEN, Decimal
from functools import lru_cache
from itertools import islice

from ..applesoft import decimaltext
from ..applesoft.errorcodes import ApplesoftError
from ..applesoft.real import Number, divide, multiply, rounded, to_stored
from ..doubles import double
from ..reading.numerals import value_of

_TYPED_ZEROS = 3
"""How many zeros after the last decimal are thought to have been typed at most."""
_NEIGHBOURS = 3
"""How far from the printed text, in units of its last digit, a typed one is looked for."""

_PRINTED_DIGITS = 9
"""Digits a number is printed with at most."""

_DECIMAL = re.compile(r"([+-]?)([0-9]*)(?:[.]([0-9]*))?(?:E([+-]?[0-9]{1,2}))?")


@lru_cache(maxsize=1)
def _radians_per_degree() -> Number:
    """AG of line 300."""
    degrees = decimaltext.number("180")
    return rounded(divide(decimaltext.number("3.14159265"), degrees))


@lru_cache(maxsize=65536)
def stored_and_printed(text: str, angle: bool = False) -> tuple[bytes, str] | None:
    """What a typed value enters the equations as, five bytes (an angle in radians, line 300), and
    what the printout then shows (an angle back in degrees, line 600). None when it overflows."""
    try:
        value = rounded(decimaltext.number(text))
        back = value
        if angle:
            value = rounded(multiply(value, _radians_per_degree()))
            back = rounded(divide(value, _radians_per_degree()))
        return to_stored(value), decimaltext.write(back)
    except (ApplesoftError, ValueError):
        return None


@lru_cache(maxsize=16384)
def texts_that_print(printed: str, angle: bool = False) -> tuple[str, ...]:
    """Texts which, typed, print as ``printed``: the shortest first, then others that enter the
    equations with other bits. Empty when none is found: then no Apple II printed it."""
    figures = printed.partition("E")[0].replace(".", "").lstrip("-0")
    if len(figures) > _PRINTED_DIGITS:
        return ()  # no Apple prints as many

    def printing(some: Iterable[str]) -> Iterator[str]:
        for text in some:
            if (seen := stored_and_printed(text, angle)) and seen[1] == printed:
                yield text

    found = [*islice(printing(_shorter(printed)), 1), *printing([printed])]
    found = found or [*islice(printing(_neighbours(printed)), 1)]
    others = [other for text in found for other in _with_zeros(text)]
    if found and min(map(_digits, found)) >= _PRINTED_DIGITS:
        # all the digits there are: more may have been typed than are printed
        others += _neighbours(printed)
    texts: dict[bytes, str] = {}
    for text in [*found, *printing(others)]:
        if seen := stored_and_printed(text, angle):
            texts.setdefault(seen[0], text)
    return tuple(texts.values())


def opposite(text: str) -> str:
    """A number with the other sign; it may be written with a plus sign and blanks."""
    size = text.strip()
    return size[1:] if size.startswith("-") else "-" + size.removeprefix("+")


def mu_turned(typed: str, printed: str) -> bool:
    """Whether line 400 gave MU the other sign than it was typed with."""
    return (double(typed) < 0) != printed.startswith("-")


def with_opposite_mu(scene: Mapping[str, str]) -> Iterator[dict[str, str]]:
    """The scene with MU typed with the other sign; none where MU has no sign."""
    if double(scene["MU"] or "0"):
        yield {**scene, "MU": opposite(scene["MU"])}


def _digits(text: str) -> int:
    """How many significant digits a text has."""
    value = value_of(text)
    return 0 if value is None else len(value.normalize().as_tuple().digits)


def _text(value: Decimal, like: str) -> str:
    """A decimal as one would type it: with an exponent only where the printout has one."""
    if "E" in like:
        mantissa, _, exponent = f"{value:E}".partition("E")
        return f"{_trimmed(mantissa)}E{exponent}"
    return _trimmed(f"{value:f}")


def _trimmed(text: str) -> str:
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    sign = "-" if text.startswith("-") else ""
    size = text.lstrip("-")
    return sign + (size[1:] if size.startswith("0.") else size)


def _shorter(printed: str) -> list[str]:
    """The printed value with fewer and fewer digits left out: one digit, two digits ..."""
    value = value_of(printed)
    if value is None or not value:
        return []
    digits = len(value.as_tuple().digits)
    # within the printed digits a shorter text prints as shown only if it is very near
    texts = []
    for count in range(1, digits):
        quantum = Decimal(1).scaleb(value.adjusted() - count + 1)
        rounded = value.quantize(quantum, rounding=ROUND_HALF_EVEN)
        if abs(rounded - value) <= abs(value) * Decimal("5e-8"):
            texts.append(_text(rounded, printed))
    return texts


def _neighbours(printed: str) -> list[str]:
    """Texts of as many digits or one more, near the printed value, nearest first."""
    value = value_of(printed)
    if value is None:
        return []
    last = Decimal(1).scaleb(value.adjusted() - _PRINTED_DIGITS + 1)
    steps = [sign * step for step in range(1, _NEIGHBOURS + 1) for sign in (1, -1)]
    tenths = [sign * step for step in range(1, 10) for sign in (1, -1)]
    return [
        *(_text(value + step * last, printed) for step in steps),
        *(_text(value + step * last / 10, printed) for step in tenths),
    ]


def _with_zeros(text: str) -> list[str]:
    """The same value typed with more zeros, or without its exponent."""
    match = _DECIMAL.fullmatch(text)
    if match is None:
        return []
    sign, whole, decimals, exponent = match.groups(default="")
    if exponent:
        plain = value_of(text)
        return [] if plain is None or abs(plain.adjusted()) > 20 else [_trimmed(f"{plain:f}")]
    return [f"{sign}{whole}.{decimals}{'0' * count}" for count in range(1, _TYPED_ZEROS + 1)]
