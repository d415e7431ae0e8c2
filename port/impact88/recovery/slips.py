"""Slips: what a printed or typed number may really have been, and which slips in the inputs, put
right, make the page agree with itself.

One digit taken for another, two adjacent digits swapped, a sign or a decimal point lost, added or
moved, one digit lost or doubled, two digits of one number. Nothing here is a verdict: `explaining`
names what is found, and `judging` says when a reader's slips may be looked past.
"""

import re
from collections.abc import Iterator, Mapping
from functools import cached_property
from itertools import combinations
from typing import NamedTuple

from ..doubles import double
from ..fields import ANGLES, INPUTS, scene_name
from ..reading.numerals import is_number, printable
from .recovered import Recovered
from .search import Column, Scored
from .typedtext import opposite

DIGIT = "digit misread"
SWAP = "digits swapped"
SIGN = "sign misread"
POINT = "decimal point misread"
COUNT = "digit lost or added"
TWO_DIGITS = "two digits misread"

BITS = {SIGN: 9.5, DIGIT: 10.0, POINT: 10.5, SWAP: 11.0, COUNT: 12.5, TWO_DIGITS: 19.0}
"""What it takes to believe each kind: a digit misread is one of 9 others of some 200 on a page, and
the other kinds about as likely by their number; chosen so that the given slips are named first."""
_UNLIKE = 0.4
"""Bits more for each rank in the likeness of two digits' shapes."""
_BITS_A_UNIT, _ALWAYS = 5.0, 0.7
"""Bits of a unit of cost in the search, and the cost of no bits: one slip (2.7) is cheaper than a
result that differs (3.0), two slips dearer."""
_TWO_SLIPS, _ONE_SLIP = 5.93, 3.5
"""What two slips may cost: two neighbors swapped (2.9) and a digit misread (3.02); and one."""
_FULL_TURN, _TURNED = 360.0, 10.0
"""Beyond it nobody types an angle, and the bits it takes to believe that somebody did."""
_ROOM, _FEW, _REPLAYED = 100_000, 1_000, 320
_FIGURES = 9
"""Of a number the Apple keeps so many."""
_ALIKE = {
    text[0]: text[1:]
    for text in "0869 1742 2713 3859 4917 5638 6805 7129 83069 94807".split()
}  # fmt: skip
"""For each digit those it is most easily taken for."""


class Change(NamedTuple):
    """One input put right: the kind of slip, the field, its text as printed or given apart, the
    true one."""

    kind: str
    field: str
    printed: str
    would_be: str

    @property
    def bits(self) -> float:
        """What it takes to believe it."""
        bits = BITS.get(self.kind, 0.0)
        if self.kind == DIGIT:
            bits += _UNLIKE * _unlikeness(self.printed, self.would_be)
        if self.kind in BITS and self.field in ANGLES and abs(double(self.would_be)) > _FULL_TURN:
            bits += _TURNED
        return bits


class Reread(NamedTuple):
    """A scene with some inputs put right."""

    changes: tuple[Change, ...]
    scored: Scored


class Rereading:
    """The slips of one printout's inputs, tried. ``apart``: those in inputs that stand nowhere on
    the page and were given apart, too; they are slips of what was typed there, as INPUT reads it:
    blanks and small letters make no difference."""

    def __init__(self, recovered: Recovered, apart: bool = False) -> None:
        self._recovered = recovered
        self._base = {name: recovered.assumed[name] for name in INPUTS if name in recovered.assumed}
        for name in recovered.apart if apart else ():
            self._base[name] = recovered.scene[scene_name(name)].replace(" ", "").upper()

    def best(self, exchanged: Mapping[str, str] | None = None) -> list[Reread]:
        """Scenes with one input put right, or two, those that explain most first. ``exchanged``:
        texts printed in place of others, by field; then one of the other inputs is put right."""
        exchanged = exchanged or {}
        slips: dict[str, list[Change]] = {}
        columns = []
        for name in INPUTS:
            text = self._base.get(name, self._recovered.scene[scene_name(name)])
            ways = self._slips.get(name, [])
            if exchanged:
                ways = [] if name in exchanged else [way for way in ways if way[1] <= _ONE_SLIP]
            slips[name] = [change for change, _ in ways]
            options = [((change.would_be,), cost) for change, cost in ways]
            apart = name not in self._recovered.assumed
            first = (exchanged.get(name, text),)
            columns.append(Column((name,), [(first, 0.0), *options], apart))
        columns.append(Column(("M",), [((self._recovered.scene["M"],), 0.0)], True))
        search = self._recovered.search
        effort = (_FEW, 2, _ONE_SLIP) if exchanged else (_ROOM, _REPLAYED, _TWO_SLIPS)
        picks = search.promising(columns, *effort, self._recovered.wrong)
        rereads = [
            Reread(
                tuple(slips[name][at - 1] for name, at in zip(INPUTS, pick, strict=False) if at),
                scored,
            )
            for pick, scored in zip(picks.tolist(), search.replayed(columns, picks), strict=True)
        ]
        return sorted(rereads, key=lambda one: one.scored.cost)

    @cached_property
    def _slips(self) -> dict[str, list[tuple[Change, float]]]:
        """The slips of every input with what each costs, cheapest first."""
        slips = {}
        for name, text in self._base.items():
            possible = printable if name in self._recovered.assumed else is_number
            ways = [
                (change := Change(kind, name, text, other), _cost(change))
                for other, kind in misreadings(text).items()
                if possible(other)
            ]
            slips[name] = sorted(ways, key=lambda way: way[1])
        return slips


def _cost(change: Change) -> float:
    """What a slip costs in the search."""
    return _ALWAYS + change.bits / _BITS_A_UNIT


def misreadings(text: str) -> dict[str, str]:
    """The texts one slip away, with the likeliest kind of each."""
    kinds: dict[str, str] = {text: ""}
    for kind, other in _slips_of(text):
        kinds.setdefault(other, kind)
    del kinds[text]
    return kinds


def slip(text: str, other: str) -> str | None:
    """The kind of slip that makes one text of the other, None when one slip is not enough."""
    return misreadings(text).get(other) if abs(len(text) - len(other)) <= 1 else None


def _unlikeness(text: str, other: str) -> int:
    """How unlike two texts that differ in one digit look: 0 most alike, 4 not."""
    old, new = next(pair for pair in zip(text, other, strict=True) if pair[0] != pair[1])
    place = _ALIKE.get(old, "").find(new)
    return place if place >= 0 else 4


def _slips_of(text: str) -> Iterator[tuple[str, str]]:
    """The texts one slip away, each with its kind, some more than once; commoner kinds first."""
    places = [index for index, glyph in enumerate(text) if glyph.isdigit()]
    for place in places:
        for digit in "0123456789":
            yield DIGIT, text[:place] + digit + text[place + 1 :]
    yield SIGN, opposite(text)
    if "E" in text:
        yield SIGN, re.sub("E.", "E+" if "E-" in text else "E-", text)
    sign, size, exponent = _parts(text)
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
    for one, two in combinations(places[:_FIGURES], 2):
        for first in "0123456789".replace(text[one], ""):
            for second in "0123456789".replace(text[two], ""):
                other = text[:one] + first + text[one + 1 : two] + second + text[two + 1 :]
                yield TWO_DIGITS, other


def _parts(text: str) -> tuple[str, str, str]:
    sign = "-" if text.startswith("-") else ""
    size, mark, exponent = text[len(sign) :].partition("E")
    return sign, size, mark + exponent
