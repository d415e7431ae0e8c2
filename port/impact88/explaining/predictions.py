"""A page as evidence: which of its results a cause leaves unexplained.

A cause predicts for each result a range of numbers, of one number where it says what is printed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Mapping
from decimal import Decimal

from ..fields import FIELDS, INPUTS
from ..reading.numerals import value_of
from ..reading.printout import Printout
from ..recovery.recovered import Recovered
from ..recovery.replays import Outcome
from ..recovery.search import AGREES, expected_results

Range = tuple[Decimal, Decimal]
Cut = Callable[[float], int]

CUTS: dict[str, Cut] = {
    "floored": math.floor,
    "rounded": lambda units: math.floor(units + 0.5),
    "truncated": math.trunc,
}
"""How programs bring a number to so many decimals; the listing floors."""
_LARGEST = 1e22
"""To here powers of ten are exact in double precision."""


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
    """A value brought to so many decimals; None where no program prints it."""
    units = value * 10.0**places
    if not math.isfinite(units) or abs(units) > _LARGEST:
        return None
    number = Decimal(CUTS[how](units)).scaleb(-places)
    return number, number


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
