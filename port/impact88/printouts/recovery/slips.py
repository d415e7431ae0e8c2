"""Slips of a reader or typist: the texts one slip away from a number.

One digit taken for another, two adjacent digits swapped, a sign or a decimal point lost, added or
moved, one digit lost or doubled, two digits of one number. Nothing here is a verdict: `explaining`
names what is found, and `judging` says when a reader's slips may be looked past.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import combinations
from operator import ne
from typing import NamedTuple

from ...decimals import negated as opposite
from ...decimals import to_double as double
from ..fields import ANGLES
from ..reading.numerals import is_number, printable

DIGIT = "digit misread"
SWAP = "digits swapped"
SIGN = "sign misread"
POINT = "decimal point misread"
COUNT = "digit lost or added"
TWO_DIGITS = "two digits misread"

BITS = {SIGN: 9.5, DIGIT: 10.0, POINT: 10.5, SWAP: 11.0, COUNT: 12.5, TWO_DIGITS: 19.0}
"""Improbability of each kind, in bits: a misread digit is one of 9 others at one of some 200 places
on a page, and the other kinds are about as likely by their number; chosen so that the slips of the
test pages are named first."""
UNLIKE_SHAPE_BITS = 0.4
"""Bits added for each rank of dissimilarity between two digits' shapes."""
NOT_ALIKE = 4
"""Rank of two digits that are not taken for one another."""
_ALIKE = {
    text[0]: text[1:]
    for text in "0869 1742 2713 3859 4917 5638 6805 7129 83069 94807".split()
}  # fmt: skip
"""For each digit, the digits it is most easily taken for, most alike first."""


class Change(NamedTuple):
    """One corrected input: the kind of slip, the field, its text as printed or given separately,
    and the corrected text."""

    kind: str
    field: str
    printed: str
    would_be: str

    @property
    def bits(self) -> float:
        """Improbability of the change in bits; 0 for a change that is not a slip."""
        bits = BITS.get(self.kind, 0.0)
        if self.kind == DIGIT:
            bits += UNLIKE_SHAPE_BITS * _unlikeness(self.printed, self.would_be)
        if bits and self.field in ANGLES and abs(double(self.would_be)) > 360:
            bits += BITS[DIGIT]  # nobody types more than a full turn
        return bits


def slip_penalty(bits: float) -> float:
    """Return the prior penalty of a slip: one misread digit (2.7) is cheaper than a result that
    differs (3.0), two are dearer."""
    return 0.7 + bits / 5


def slips_of(name: str, text: str) -> list[tuple[float, Change]]:
    """Return the texts that are a number and one slip away from a field's, each with its prior
    penalty, smallest first."""
    changes = (Change(kind, name, text, other) for other, kind in misreadings(text).items())
    possible = [change for change in changes if is_number(change.would_be)]
    some = [(slip_penalty(change.bits), change) for change in possible]
    return sorted(some, key=lambda pair: (pair[0], pair[1].would_be))


def neighbours(name: str, text: str) -> dict[str, float]:
    """Return the printable texts that a reader may have misread as a field's in one slip, each with
    its prior penalty. Two digits misread are left to explanations: there are too many of them."""
    return {
        change.would_be: cost
        for cost, change in slips_of(name, text)
        if change.kind != TWO_DIGITS and printable(change.would_be)
    }


def misreadings(text: str) -> dict[str, str]:
    """Return the texts one slip away, with the likeliest kind of each."""
    kinds: dict[str, str] = {text: ""}
    for kind, other in _slips_of(text):
        kinds.setdefault(other, kind)
    del kinds[text]
    return kinds


def slip(text: str, other: str) -> str | None:
    """Return the kind of slip that turns one text into the other; None if one is not enough."""
    if len(text) == len(other):
        near = sum(map(ne, text, other)) <= 2 or text.replace(".", "") == other.replace(".", "")
    else:
        short, long = sorted((text, other), key=len)
        near = any(long[:at] + long[at + 1 :] == short for at in range(len(long)))
    return misreadings(text).get(other) if near else None


def _unlikeness(text: str, other: str) -> int:
    """Return the dissimilarity of two texts that differ in one digit, from 0 to `NOT_ALIKE`."""
    old, new = next(pair for pair in zip(text, other, strict=True) if pair[0] != pair[1])
    place = _ALIKE.get(old, "").find(new)
    return place if place >= 0 else NOT_ALIKE


def _slips_of(text: str) -> Iterator[tuple[str, str]]:
    """Yield the texts one slip away with their kinds, commoner kinds first; some repeat."""
    places = [index for index, glyph in enumerate(text) if glyph.isdigit()]
    for place in places:
        for digit in "0123456789":
            yield DIGIT, text[:place] + digit + text[place + 1 :]
    yield SIGN, opposite(text)
    if "E" in text:
        yield SIGN, re.sub("E.", "E+" if "E-" in text else "E-", text)
    sign = "-" * text.startswith("-")
    size, mark, exponent = text.removeprefix("-").partition("E")
    exponent = mark + exponent
    figures = size.replace(".", "")
    yield POINT, sign + figures + exponent
    for place in range(len(figures)):
        yield POINT, sign + figures[:place] + "." + figures[place:] + exponent
    for place in places[:-1]:
        if text[place + 1].isdigit():
            yield SWAP, text[:place] + text[place + 1] + text[place] + text[place + 2 :]
    for place in range(len(size) + 1):
        if size[place : place + 1].isdigit() and len(figures) > 1:
            yield COUNT, sign + size[:place] + size[place + 1 :] + exponent
        for digit in "0123456789":
            yield COUNT, sign + size[:place] + digit + size[place:] + exponent
    for first_place, two in combinations(places[:9], 2):
        for first in "0123456789".replace(text[first_place], ""):
            for second in "0123456789".replace(text[two], ""):
                other = (
                    text[:first_place]
                    + first
                    + text[first_place + 1 : two]
                    + second
                    + text[two + 1 :]
                )
                yield TWO_DIGITS, other
