"""A page as evidence: which of its results a cause leaves unexplained.

A cause predicts for each result a range of numbers, of one number where it says what is printed.
"""

import math
from collections.abc import Callable, Container, Iterable, Mapping
from decimal import Decimal
from typing import Any, NamedTuple

import numpy as np

from ..fields import FIELDS, INPUTS
from ..reading.numerals import value_of
from ..reading.printout import Printout
from ..recovery.recovered import Recovered
from ..recovery.replays import Outcome
from ..recovery.search import AGREES, expected_results
from ..recovery.slips import Change

Range = tuple[Decimal, Decimal]

CUTS: dict[str, Callable[[float], int]] = {
    "floored": math.floor,
    "rounded": lambda units: math.floor(units + 0.5),
    "truncated": math.trunc,
}
"""How programs bring a number to so many decimals; the listing floors."""
NOT_APPLESOFT = "then this program on an Apple II did not print it"
_LARGEST = 1e22
"""To here powers of ten are exact in double precision."""
_FAR = 0.1
"""What a result counts at most that is far off, relatively."""
_ENERGY_DIGITS, _ENERGY_UNITS = 9, 2
"""The kinetic energy is printed to so many digits; other arithmetics end within so many units of
the last of them."""


class Cause(NamedTuple):
    """A cause tried: its kind, what is added, its bits, the scene it was computed with (None: it
    was not computed anew), the names it leaves unexplained, and the numbers it puts right."""

    kind: str
    note: str
    bits: float
    scene: Mapping[str, str] | None
    wrong: frozenset[str]
    changes: tuple[Change, ...] = ()


class Evidence:
    """The numbers of a printout, the scene it was found to show, and ``contradicted``: the names of
    those that are not what the program prints for it."""

    def __init__(
        self, shown: Printout, recovered: Recovered, contradicted: Container[str] = ()
    ) -> None:
        self.shown, self.recovered = shown, recovered
        self._contradicted = {
            name: one for name, one in as_printed(recovered.outcome).items() if name in contradicted
        }
        self.results = {
            one.name: [
                number
                for text in sorted(one.texts, key=one.texts.__getitem__)
                if one.texts[text] < AGREES and (number := value_of(text)) is not None
            ]
            for one in expected_results(shown)
            if one.default >= AGREES
        }
        self.texts = {
            name: reading.text
            for name, reading in shown.fields.items()
            if reading.clean and value_of(reading.text) is not None
        }

    def decimals(self, name: str) -> int:
        """How many decimals a number has on the page."""
        return max(0, -int(Decimal(self.texts[name]).as_tuple().exponent))

    def digits(self, name: str) -> int:
        """How many digits it has."""
        return digits_of(self.texts.get(name))

    @property
    def longer(self) -> bool:
        """Whether a number has more decimals than the program prints."""
        return any(self.decimals(name) > (FIELDS[name].places or 9) for name in self.texts)

    def named(self, names: Iterable[str]) -> list[str]:
        """Those of some names that are results read on the page."""
        return [name for name in names if self.results.get(name)]

    def far(self, found: Mapping[str, Any], count: int) -> Any:
        """How far off results are, arrays of ``count`` by name: relatively and on average."""
        rows = [
            np.nan_to_num(np.abs(column - number) / (abs(number) + 0.1), nan=1.0)
            for name, column in found.items()
            for number in map(float, self.results.get(name, [])[:1])
        ]
        return np.minimum(rows, _FAR).mean(axis=0) if rows else np.zeros(count)

    def differing(
        self,
        predicted: Mapping[str, Range],
        ending: str | None,
        inputs: Mapping[str, str] | None = None,
    ) -> frozenset[str]:
        """The names in which the page is not what is predicted; ``inputs``: texts of those that are
        to be compared, too."""
        wrong = {
            name
            for name, numbers in self.results.items()
            if name not in predicted
            or not any(predicted[name][0] <= one <= predicted[name][1] for one in numbers)
        }
        # what contradicts the program's number contradicts a cause that predicts the same
        wrong |= {
            name for name, one in self._contradicted.items() if predicted.get(name, one) == one
        }
        for name, text in (inputs or {}).items():
            if name in INPUTS and name in self.texts:
                own = self.texts[name]
                if text != own and value_of(text) != value_of(own):
                    wrong.add(name)
        if self.shown.ending is not None and ending != self.shown.ending:
            wrong.add("ENDING")
        return frozenset(wrong)


def as_printed(outcome: Outcome) -> dict[str, Range]:
    """What a run prints, as ranges of one number."""
    numbers = {name: value_of(text) for name, text in outcome.fields.items()}
    return {name: (number, number) for name, number in numbers.items() if number is not None}


def cut(value: float, places: int, how: str) -> Range | None:
    """A value brought to so many decimals, either way where the Apple's 32 bits may make a tie of
    it; None where no program prints it."""
    units = value * 10.0**places
    if not math.isfinite(units) or abs(units) > _LARGEST:
        return None
    slack = abs(units) * 2.0**-31
    low, high = (Decimal(CUTS[how](units + way)).scaleb(-places) for way in (-slack, slack))
    return low, high


def within(number: Decimal, range: Range | None) -> bool:
    """Whether a number is one of those predicted."""
    return range is not None and range[0] <= number <= range[1]


def around(value: float, slack: Decimal | float) -> Range | None:
    """A value and what is that near to it."""
    if not math.isfinite(value):
        return None
    return Decimal(value) - Decimal(slack), Decimal(value) + Decimal(slack)


def places_of(name: str) -> int:
    """The decimals that the listing brings a result to."""
    return FIELDS[name].places or 0


def digits_of(text: str | None) -> int:
    """The digits of a number; 0 of none."""
    value = value_of(text or "")
    return 0 if value is None else len(value.normalize().as_tuple().digits)


def in_last_places(name: str, printed: str | None, other: str | None) -> bool:
    """Whether a result is another by no more than other arithmetics leave open: one in the last
    place it is floored to, or the last of the digits of the kinetic energy."""
    one, two = value_of(printed or ""), value_of(other or "")
    if one is None or two is None or name not in FIELDS:
        return False
    places = FIELDS[name].places
    if places is not None:
        return abs(one - two) <= Decimal(1).scaleb(-places)
    return abs(one - two) <= _ENERGY_UNITS * Decimal(1).scaleb(two.adjusted() - _ENERGY_DIGITS + 1)
