"""Numbers as printed and as typed: what a damaged one may be, and what prints like another."""

from __future__ import annotations

import re
from decimal import Decimal
from functools import lru_cache
from itertools import product

from ..apple.applesoft import decimaltext
from ..apple.applesoft.errorcodes import ApplesoftError
from ..apple.applesoft.real import divide, multiply, rounded, to_stored
from .costs import ALIKE, SLIGHT
from .glyphs import LOOKALIKES

PRINTED = re.compile(r"-?(?:[0-9]{1,9}(?:\.[0-9]{1,9})?|\.[0-9]{1,10})(?:E[-+]?[0-9]{1,2})?")
"""A number as Applesoft prints it."""
TYPED = re.compile(r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:E[-+]?[0-9]{1,2})?")
"""A number as it can be typed."""
RETYPED = re.compile(r"^[-+]0|^0.|[.][0-9]*0$|^[-+]?[.]00|^[+]|[.]$|^-?[0-9]{10}")
"""Marks of a number that people wrote: a zero or plus sign in front, zeros after, no exponent."""
BARRED_ZERO = re.compile(r".{1,2}\)")
"""A zero with a bar, as readers tear it into two or three characters."""
NUMBER_CHARS = "0123456789.-"
MAX_DIGITS = 9
"""Digits that Applesoft prints."""
MAX_READINGS = 100
"""Texts that a damaged number may be: the cheapest ones."""
_RADIANS = rounded(divide(decimaltext.number("3.14159265"), decimaltext.number("180")))


@lru_cache(maxsize=50_000)
def stored_and_printed(text: str, is_angle: bool = False) -> tuple[bytes, str] | None:
    """Return what the Apple stores of a typed number, and what it prints.

    Parameters
    ----------
    text : str
        The number as typed.
    is_angle : bool, default False
        True for an angle, which line 300 turns into radians and line 600 back.

    Returns
    -------
    tuple of bytes and str, or None
        None for another text, and for a number that is too large.
    """
    if not TYPED.fullmatch(text):
        return None
    try:
        value = printed_value = rounded(decimaltext.number(text))
        if is_angle:
            value = rounded(multiply(value, _RADIANS))
            printed_value = rounded(divide(value, _RADIANS))
        return to_stored(value), decimaltext.write(printed_value)
    except (ApplesoftError, ValueError):
        return None


@lru_cache(maxsize=20_000)
def spellings(printed: str, is_angle: bool = False) -> tuple[str, ...]:
    """Return typed texts that print as a given text does, the shortest first.

    Each is stored as other bits. Parameters as for `stored_and_printed`.
    """
    try:
        value = Decimal(printed)
    except ArithmeticError:
        return ()
    digits = len(value.as_tuple().digits)
    texts = [f"{Decimal(f'{value:.{k}E}').normalize():f}" for k in range(digits - 1)]
    plain = f"{value:f}"
    texts += [plain, *(plain + "." * ("." not in plain) + "0" * k for k in (1, 2, 3))]
    by_bits: dict[bytes, str] = {}
    for text in [*texts, printed]:
        short = re.sub(r"^(-?)0\.", r"\1.", text)
        entry = stored_and_printed(short, is_angle)
        if entry and entry[1] == printed:
            by_bits.setdefault(entry[0], short)
    return tuple(by_bits.values())


def opposite(text: str) -> str:
    """Return a number's text with the other sign."""
    return text[1:] if text.startswith("-") else "-" + text.removeprefix("+")


def is_same_value(first: str, second: str) -> bool:
    """Return True if the Apple stores two typed texts as the same number."""
    bits = [entry and entry[0] for entry in map(stored_and_printed, (first, second))]
    return bits[0] is not None and bits[0] == bits[1]


def as_printed(text: str) -> str:
    """Return a number that people wrote as Applesoft prints it; another text unchanged."""
    entry = stored_and_printed(text) if RETYPED.search(text) else None
    return entry[1] if entry and Decimal(entry[1]) == Decimal(text) else text


@lru_cache(maxsize=4000)
def readings(chars: str) -> dict[str, float]:
    """Return the printed texts that a number's characters may be, with the cost of each.

    Characters of numbers are themselves, others are look-alikes of some or dirt; "?" is any digit.
    """
    if PRINTED.fullmatch(number := as_printed(chars)):
        return {number: SLIGHT * (number != chars)}
    ways: list[tuple[str, float]] = [("", 0.0)]
    for char in chars:
        options = [(char, 0.0)] if char in "0123456789.-E" else []
        if not options or char == "E":
            alike = [digit for digit in NUMBER_CHARS if char in LOOKALIKES[digit] + "?"]
            options += [(digit, ALIKE) for digit in alike]
            options.append(("", 2 * ALIKE))
        elif char in ".-":
            options.append(("", 3 * ALIKE))
        longer = (
            (text + piece, cost + price) for (text, cost), (piece, price) in product(ways, options)
        )
        ways = sorted(longer, key=lambda way: way[1])[:MAX_READINGS]
    texts: dict[str, float] = {"0": ALIKE} if BARRED_ZERO.fullmatch(chars) else {}
    for text, cost in ways:
        number = as_printed(text)
        if PRINTED.fullmatch(number):
            texts.setdefault(number, cost + SLIGHT * (number != text))
    return texts


@lru_cache(maxsize=1000)
def slips(text: str) -> list[str]:
    """Return the printed numbers one slip from another.

    A slip replaces, loses, adds or exchanges characters.
    """
    variants = []
    for k in range(len(text) + 1):
        before, char, after = text[:k], text[k : k + 1], text[k + 1 :]
        variants += [before + new + after for new in NUMBER_CHARS]
        variants += [before + after, before + after[:1] + char + after[1:]]
        variants += [before + new + char + after for new in NUMBER_CHARS]
    return [
        variant
        for variant in dict.fromkeys(variants)
        if PRINTED.fullmatch(variant) and as_printed(variant) == variant != text
    ]
