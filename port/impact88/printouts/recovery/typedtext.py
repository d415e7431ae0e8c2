"""Typed texts of printed numbers: decimal texts that print as shown.

A printed value has at most nine digits, and need not read back to itself: a typed -64.42 prints as
-64.4200001. Angles go the longer way of lines 300 and 600, into radians and back, so that -133 may
print as -132.999999. And a value may have been typed with zeros that do not print, which can
change its last bit (72.80 is 7280 divided twice by ten, 72.8 is 728 divided once).
"""

import re
from collections.abc import Iterator, Mapping
from decimal import Decimal
from functools import lru_cache

from ...apple.applesoft import decimaltext
from ...apple.applesoft.errorcodes import ApplesoftError
from ...apple.applesoft.real import divide, multiply, rounded, to_stored
from ...decimals import negated as opposite
from ...decimals import to_double as double
from ..reading.numerals import value_of

_TYPED_ZEROS = 3  # trailing zeros that may have been typed
_PRINTED_DIGITS = 9  # most digits that a number is printed with
_RADIANS = rounded(divide(decimaltext.number("3.14159265"), decimaltext.number("180")))
"""AG of line 300."""


@lru_cache(maxsize=65536)
def stored_and_printed(text: str, angle: bool = False) -> tuple[bytes, str] | None:
    """Return the stored value of a typed text (five bytes; an angle in radians, line 300) and its
    printed text (an angle back in degrees, line 600); None if it overflows."""
    try:
        value = rounded(decimaltext.number(text))
        back = value
        if angle:
            value = rounded(multiply(value, _RADIANS))
            back = rounded(divide(value, _RADIANS))
        return to_stored(value), decimaltext.write(back)
    except (ApplesoftError, ValueError):
        return None


@lru_cache(maxsize=16384)
def texts_that_print(printed: str, angle: bool = False) -> tuple[str, ...]:
    """Return texts that, typed, print as ``printed``: the shortest first, then others that enter
    the equations with other bits. Empty when none is found: then no Apple II printed it."""
    figures = printed.partition("E")[0].replace(".", "").lstrip("-0")
    value = value_of(printed)
    if value is None or len(figures) > _PRINTED_DIGITS:
        return ()

    def prints(text: str) -> bool:
        return (stored_and_printed(text, angle) or ("", ""))[1] == printed

    exact = [text for text in [*_shorter(value, printed), printed] if prints(text)]
    exact = exact or [text for text in _neighbours(value, printed) if prints(text)][:1]
    variants = [variant for text in exact for variant in _with_zeros(text)]
    if len(figures) == _PRINTED_DIGITS and exact == [printed]:
        # more digits may have been typed than are printed
        variants += _neighbours(value, printed)
    texts: dict[bytes, str] = {}
    for text in [*exact, *filter(prints, variants)]:
        if seen := stored_and_printed(text, angle):
            texts.setdefault(seen[0], text)
    return tuple(texts.values())


def longer_texts(printed: str, angle: bool = False) -> list[str]:
    """Return texts of more digits than Applesoft prints that print as ``printed`` and are stored as
    other numbers: -10.00000001 for -10."""
    value, own = value_of(printed), stored_and_printed(printed, angle)
    if not value or own is None:
        return []
    texts: dict[bytes, str] = {}
    for text in _neighbours(value, printed):
        seen = stored_and_printed(text, angle)
        if seen is not None and seen[1] == printed and seen[0] != own[0]:
            texts.setdefault(seen[0], text)
    return [*texts.values()]


def mu_turned(typed: str, printed: str) -> bool:
    """Return True if line 400 reversed the sign that MU was typed with."""
    return (double(typed) < 0) != printed.startswith("-")


def with_opposite_mu(scene: Mapping[str, str]) -> Iterator[dict[str, str]]:
    """Yield the scene with MU typed with the other sign; nothing where MU is zero."""
    if double(scene["MU"] or "0"):
        yield {**scene, "MU": opposite(scene["MU"])}


def _text(value: Decimal, like: str) -> str:
    """Return a decimal as one would type it: with an exponent only where the printout has one."""
    value = value.normalize()
    return re.sub(r"^(-?)0(?=[.])", r"\1", f"{value:E}" if "E" in like else f"{value:f}")


def _shorter(value: Decimal, printed: str) -> Iterator[str]:
    """Yield the printed value rounded to one digit, two, ..., where that is very near."""
    for decimals in range(len(value.as_tuple().digits) - 1):
        shorter = Decimal(f"{value:.{decimals}E}")
        if abs(shorter - value) <= abs(value) * Decimal("5e-8"):
            yield _text(shorter, printed)


def _neighbours(value: Decimal, printed: str) -> list[str]:
    """Return texts of as many digits or one more, at most three units of the last digit away."""
    last = Decimal(1).scaleb(value.adjusted() - _PRINTED_DIGITS + 1)
    steps = [*range(1, 4), *(Decimal(step) / 10 for step in range(1, 10))]
    return [_text(value + sign * step * last, printed) for step in steps for sign in (1, -1)]


def _with_zeros(text: str) -> list[str]:
    """Return texts of the same value with trailing zeros, or without its exponent."""
    if "E" in text:
        value = Decimal(text)
        return [_text(value, "")] if abs(value.adjusted()) <= 20 else []
    zeros = range(1, _TYPED_ZEROS + 1)
    return [f"{text}{'' if '.' in text else '.'}{'0' * count}" for count in zeros]
