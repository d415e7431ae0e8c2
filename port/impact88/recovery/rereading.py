"""Rereading: which slips in the printed inputs, put right, make the page agree with itself.

Every slip in every input (`misprints`) is a hypothesis, alone and in pairs; two digits of one
number are another. Nothing here is a verdict: `explain` names what is found, and `judging` says
when a reader's slips may be looked past.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from itertools import combinations as pairs_of
from typing import NamedTuple

from ..doubles import double
from ..fields import ANGLES, INPUTS
from ..reading.numerals import is_number, printable
from . import misprints
from .choices import Column, scene_name
from .recovered import Recovered
from .search import AGREES, MISMATCH, Scored

COSTS = {
    misprints.DIGIT: 2.7,
    misprints.SIGN: 2.6,
    misprints.POINT: 2.8,
    misprints.SWAP: 2.9,
    misprints.COUNT: 3.2,
    misprints.TWO_DIGITS: 4.4,
}
"""What it costs to believe a slip; a result that differs costs `search.MISMATCH`."""
_UNLIKE = 0.05
"""What a digit costs more by each rank in the likeness of its shape."""
_TWO_SLIPS, _ONE_SLIP = 5.85, 3.5
"""What two slips may cost, neither of them a digit lost or added; and one."""
_FULL_TURN, _TURNED = 360.0, 2.0
"""Beyond it nobody types an angle, and what it costs to believe that somebody did."""
_ROOM, _FEW, _REPLAYED = 100_000, 1_000, 320
_DIGITS = 9
"""Of a number the Apple keeps so many digits."""


class Change(NamedTuple):
    """One input put right: the kind of slip, the field, its text as printed or given apart, the
    true one."""

    kind: str
    field: str
    printed: str
    would_be: str


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
        slips: dict[str, list[Change]] = {}
        columns = []
        for name in INPUTS:
            text = self._base.get(name, self._recovered.scene[scene_name(name)])
            ways = self._slips.get(name, [])
            if exchanged:
                ways = [] if name in exchanged else [way for way in ways if way[1] <= _ONE_SLIP]
                text = exchanged.get(name, text)
            slips[name] = [change for change, _ in ways]
            options = [((change.would_be,), cost) for change, cost in ways]
            apart = name not in self._recovered.assumed
            columns.append(Column((name,), [((text,), 0.0), *options], apart))
        columns.append(Column(("M",), [((self._recovered.scene["M"],), 0.0)], True))
        search = self._recovered.search
        effort = (_FEW, 2, _ONE_SLIP) if exchanged else (_ROOM, _REPLAYED, _TWO_SLIPS)
        picks = search.promising(columns, *effort, self._recovered.wrong)
        rereads = [
            Reread(
                tuple(
                    slips[name][index - 1]
                    for name, index in zip(INPUTS, pick, strict=False)
                    if index
                ),
                scored,
            )
            for pick, scored in zip(picks.tolist(), search.replayed(columns, picks), strict=True)
        ]
        return sorted(rereads, key=lambda one: one.scored.cost)

    @cached_property
    def _slips(self) -> dict[str, list[tuple[Change, float]]]:
        """The slips of every input with what each costs, cheapest first."""
        return {
            name: sorted(self._slips_of(name, text), key=lambda way: way[1])
            for name, text in self._base.items()
        }

    def _slips_of(self, name: str, text: str) -> Iterator[tuple[Change, float]]:
        possible = printable if name in self._recovered.assumed else is_number
        for kind, other in misprints.misreadings(text):
            if possible(other):
                cost = COSTS[kind]
                if kind == misprints.DIGIT:
                    cost += _UNLIKE * misprints.likeness(text, other)
                yield Change(kind, name, text, other), cost + self._turned(name, other)
        for other in _two_digits(text):
            if possible(other):
                change = Change(misprints.TWO_DIGITS, name, text, other)
                yield change, COSTS[misprints.TWO_DIGITS] + self._turned(name, other)

    def _turned(self, name: str, text: str) -> float:
        """What an angle costs that nobody types."""
        return _TURNED if name in ANGLES and abs(double(text)) > _FULL_TURN else 0.0


def _two_digits(text: str) -> Iterator[str]:
    """Texts that differ in two of the digits that count."""
    places = [index for index, glyph in enumerate(text) if glyph.isdigit()][:_DIGITS]
    for one, two in pairs_of(places, 2):
        for first in "0123456789":
            for second in "0123456789":
                if first != text[one] and second != text[two]:
                    yield text[:one] + first + text[one + 1 : two] + second + text[two + 1 :]


__all__ = ["AGREES", "MISMATCH", "Change", "Reread", "Rereading"]
