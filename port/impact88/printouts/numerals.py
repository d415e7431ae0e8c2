"""Numbers as printed and as typed: what a damaged one may be, and what prints like another."""

from __future__ import annotations

import re
from decimal import Decimal
from functools import lru_cache
from itertools import product

from ..apple.applesoft import decimaltext
from ..apple.applesoft.errorcodes import ApplesoftError
from ..apple.applesoft.real import divide, multiply, rounded, to_stored
from .costs import ALIKE, SLIGHT, WRONG
from .glyphs import LOOKALIKES

PRINTED = re.compile(r"-?(?:[0-9]{1,9}(?:\.[0-9]{1,9})?|\.[0-9]{1,9})(?:E[-+]?[0-9]{1,2})?")
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
        None if the number is too large.
    """
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
    shorter = [Decimal(f"{value:.{k}E}") for k in range(digits - 1)]
    texts = [
        f"{number.normalize():f}"
        for number in shorter
        if abs(number - value) <= abs(value) * Decimal("5e-8")
    ]
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
    entries = [
        stored_and_printed(text) if TYPED.fullmatch(text) else None for text in (first, second)
    ]
    return entries[0] is not None and entries[1] is not None and entries[0][0] == entries[1][0]


def as_printed(text: str) -> str:
    """Return a number that people wrote as Applesoft prints it; another text unchanged."""
    if not RETYPED.search(text) or not TYPED.fullmatch(text):
        return text
    entry = stored_and_printed(text)
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
            for digit in NUMBER_CHARS:
                if char in LOOKALIKES[digit]:
                    options.append((digit, ALIKE))
                elif char == "?":
                    options.append((digit, ALIKE if digit.isdigit() else 2 * ALIKE))
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
def slips(text: str) -> list[tuple[str, float]]:
    """Return the printed numbers one slip from another, with the cost of the slip.

    A slip replaces, loses, adds or exchanges characters.
    """
    costs: dict[str, float] = {}
    for k in range(len(text) + 1):
        before, char, after = text[:k], text[k : k + 1], text[k + 1 :]
        variants = [(before + new + char + after, WRONG + SLIGHT) for new in NUMBER_CHARS]
        if char:
            variants += [(before + new + after, WRONG) for new in NUMBER_CHARS]
            variants.append((before + after, WRONG + SLIGHT))
            variants.append((before + after[:1] + char + after[1:], WRONG + SLIGHT))
        for variant, cost in variants:
            if PRINTED.fullmatch(variant) and as_printed(variant) == variant != text:
                costs.setdefault(variant, cost)
    return [*costs.items()]
