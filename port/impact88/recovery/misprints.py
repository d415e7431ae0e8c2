"""Misreadings: what a printed number may really have been, one slip away.

One digit taken for another, two adjacent digits swapped, a sign or a decimal point lost, added or
moved, one digit lost or doubled. Digits of similar shape come first.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

DIGIT = "digit misread"
SWAP = "digits swapped"
SIGN = "sign misread"
POINT = "decimal point misread"
COUNT = "digit lost or added"
TWO_DIGITS = "two digits misread"

KINDS = (DIGIT, SIGN, POINT, SWAP, COUNT)
"""In the order of how common they are taken to be."""
KINDS_OF_SLIPS = frozenset((*KINDS, TWO_DIGITS))
"""All of them."""

_ALIKE = {
    "0": "869",
    "1": "742",
    "2": "713",
    "3": "859",
    "4": "917",
    "5": "638",
    "6": "805",
    "7": "129",
    "8": "3069",
    "9": "4807",
}
"""For each digit those it is most easily taken for."""


def misreadings(text: str) -> Iterator[tuple[str, str]]:
    """The texts one slip away from ``text``, each with the kind of slip; none twice."""
    seen = {text}
    for kind, other in _slips(text):
        if other not in seen:
            seen.add(other)
            yield kind, other


def slip(text: str, other: str) -> str | None:
    """The kind of slip that makes one text of the other, None when one slip is not enough."""
    if abs(len(text) - len(other)) > 1:
        return None
    return next((kind for kind, near in _slips(text) if near == other), None)


def differ_in_two(text: str, other: str) -> bool:
    """Whether two texts differ in two digits and nothing else."""
    if len(text) != len(other):
        return False
    pairs = [(old, new) for old, new in zip(text, other, strict=True) if old != new]
    return len(pairs) == 2 and all(old.isdigit() and new.isdigit() for old, new in pairs)


def likeness(text: str, other: str) -> int:
    """How alike two texts that differ in one digit look: 0 most alike, 4 not."""
    for old, new in zip(text, other, strict=False):
        if old != new:
            place = _ALIKE.get(old, "").find(new)
            return place if place >= 0 else 4
    return 4


def opposite(text: str) -> str:
    """A number with the other sign; it may be written with a plus sign and blanks."""
    size = text.strip()
    return size[1:] if size.startswith("-") else "-" + size.removeprefix("+")


def _slips(text: str) -> Iterator[tuple[str, str]]:
    places = [index for index, glyph in enumerate(text) if glyph.isdigit()]
    for place in places:
        alike = _ALIKE[text[place]]
        for digit in alike + "".join(sorted(set("0123456789") - set(alike))):
            yield DIGIT, text[:place] + digit + text[place + 1 :]
    yield SIGN, opposite(text)
    if "E" in text:
        yield SIGN, re.sub("E.", "E+" if "E-" in text else "E-", text)
    for place in places[:-1]:
        if text[place + 1].isdigit() and text[place] != text[place + 1]:
            yield SWAP, text[:place] + text[place + 1] + text[place] + text[place + 2 :]
    sign, size, exponent = _parts(text)
    digits = size.replace(".", "")
    yield POINT, sign + digits + exponent
    for place in range(len(digits)):
        yield POINT, sign + digits[:place] + "." + digits[place:] + exponent
    for place in range(len(size)):
        if size[place].isdigit() and len(digits) > 1:
            yield COUNT, sign + size[:place] + size[place + 1 :] + exponent
    for place in range(len(size) + 1):
        for digit in "0123456789":
            yield COUNT, sign + size[:place] + digit + size[place:] + exponent


def _parts(text: str) -> tuple[str, str, str]:
    sign = "-" if text.startswith("-") else ""
    size, mark, exponent = text[len(sign) :].partition("E")
    return sign, size, mark + exponent
