"""A page as evidence: the numbers on it, and which of them a cause leaves unexplained.

A cause predicts a range for each number, of one value where it says what is printed. Bits and
limits of this room were chosen on the classes of tests/support/slippedpages.py; what doubling one
does was seen on 37 of their pages.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from dataclasses import field as default
from functools import cached_property
from typing import Any

import numpy as np

from ...collision.doubles import double
from ...collision.fields import FIELDS, INPUTS
from ...names import PIVOT
from ..judging.judgement import Judged, Status, same_value
from ..reading.numerals import value_of
from ..recovery.replays import Outcome
from ..recovery.search import AGREES
from ..recovery.slips import Change

Range = tuple[float, float]

LABELS_EXCHANGED, LABEL_WRONG = "labels exchanged", "another label"
NOT_APPLESOFT = "then this program on an Apple II did not print it"
_ALL_BUT = 0.15
"""A cause that leaves more than this part of what differs is none; doubled, one page changes."""
_ENERGY_DIGITS, _ENERGY_UNITS = 9, 2
"""The kinetic energy is printed to so many digits; other arithmetics end within so many units of
the last of them. Doubled, none changes; without, one in IEEE double is not told."""


@dataclass
class Cause:
    """A cause that was tried for the differences of a page.

    One that is offered as an explanation also has ``field``, ``printed`` and ``would_be``, the
    first of its changes; ``look``, the places to look at on the paper; and ``remaining``, the
    number of differences that it leaves.

    Parameters
    ----------
    kind : str
        Kind of cause, such as "digit misread".
    note : str
        A note on it.
    bits : float
        Improbability of the cause, in bits.
    left : frozenset of str
        The fields that it leaves unexplained.
    right : tuple of Change
        The numbers that it puts right.
    explains, differing : int
        How many of the differing numbers it explains.
    changes : list of dict
        All that it puts right, with places.
    rank : int
        Rank from 1; explanations that the page cannot tell apart share it.
    """

    kind: str
    note: str
    bits: float
    left: frozenset[str]
    right: tuple[Change, ...] = ()
    explains: int = 0
    differing: int = 0
    changes: list[dict[str, Any]] = default(default_factory=list)
    rank: int = 1

    def __post_init__(self) -> None:
        first = self.changes[0] if self.changes else {}
        self.field, self.printed, self.would_be = map(first.get, ("field", "printed", "would_be"))
        self.remaining = len(self.left)
        self.look = [change["look"] for change in self.changes if change["look"]]

    def __str__(self) -> str:
        what = self.kind
        if self.kind == LABELS_EXCHANGED:
            pairs = (" and ".join(sorted((c["printed"], c["would_be"]))) for c in self.changes)
            what = f"labels {', '.join(dict.fromkeys(pairs))} exchanged"
        elif self.kind == LABEL_WRONG:
            what = "; ".join(f"{c['would_be']} labelled {c['printed']}" for c in self.changes)
        elif self.changes:
            what += ": " + "; ".join(
                f"{c['field']} {c['printed']}, would be {c['would_be']}" for c in self.changes[:6]
            )
        return what + (f" ({self.note})" if self.note else "")

    def as_json(self) -> dict[str, Any]:
        """Return the object that ``impact88 verify --json`` prints.

        Returns
        -------
        dict of str to object
            The explanation as JSON types.
        """
        names = ("kind", "field", "printed", "would_be", "explains", "remaining", "note", "changes")
        return {name: getattr(self, name) for name in (*names, "look", "rank")}


class PageEvidence:
    """A judged page. ``base``: the names of what differs, ``reply UX`` and ``label UX`` for those;
    ``results``: by name what a result may read, the likeliest first; ``texts``: the numbers that
    are read clean; ``most_left``: how many numbers a cause may leave unexplained."""

    def __init__(self, found: Judged) -> None:
        self.found, self.paper, self.recovered = found, found.paper, found.recovered
        self.checks = {check.name: check for check in found.fields}
        self.checks |= {f"reply {check.name}": check for check in found.replies}
        self.base = differing(found)
        self.most_left = int(_ALL_BUT * len(self.base))
        self.results = {
            expected.name: [
                float(text)
                for text in sorted(expected.texts, key=expected.texts.__getitem__)
                if expected.texts[text] < AGREES and value_of(text) is not None
            ]
            for expected in self.recovered.search.expected
            if expected.default >= AGREES
        }
        self.texts = {
            name: reading.text
            for name, reading in self.paper.fields.items()
            if reading.clean and value_of(reading.text) is not None
        }
        self.numbers = {name: [float(text)] for name, text in self.texts.items()} | self.results
        printed = as_printed(self.recovered.outcome)
        self._contradicted = {name: value for name, value in printed.items() if name in self.base}

    def decimals(self, name: str) -> int:
        """How many decimals a number has on the page."""
        return decimals_of(self.texts.get(name, ""))

    def far(self, found: Mapping[str, Any], count: int) -> Any:
        """How far off results are, arrays of ``count`` by name: relatively, their median."""
        rows = [
            np.nan_to_num(np.abs(column - number) / (abs(number) + 0.1), nan=1.0)
            for name, column in found.items()
            for number in self.results.get(name, [])[:1]
        ]
        return np.median(rows, axis=0) if rows else np.zeros(count)

    def fits(self, found: Mapping[str, Any], count: int, units: float, part: float) -> Any:
        """Where so few results, arrays of ``count`` by name in double precision, are off by more
        than so many units of their last place and such a part of them that a cause may explain
        the page."""
        misfits = np.zeros(count, int)
        mu = double(self.recovered.scene["MU"])
        if abs(mu) >= -PIVOT != -mu:  # double precision does not follow line 510 past the pivot's
            found = {}
        for name, column in found.items():
            unit = 10.0 ** -min(FIELDS[name].places or 9, self.decimals(name))
            numbers = self.results.get(name, [])
            near = [np.abs(column - x) <= units * unit + part * abs(x) for x in numbers]
            misfits += ~np.any(near, axis=0) if near else 0
        return misfits <= self.most_left

    def left(
        self,
        scene: Mapping[str, str],
        outcome: Outcome,
        right: Iterable[Change] = (),
        otherwise: Mapping[str, Range] | None = None,
        spared: frozenset[str] = frozenset(),
    ) -> frozenset[str]:
        """What a scene leaves unexplained: results that are not as its outcome has them, or
        ``otherwise``; printed inputs but those that are ``spared``, or that a change puts
        ``right``; the ending; replies that are not its values."""
        predicted = {**as_printed(outcome), **(otherwise or {})}
        inputs = set(INPUTS) - {change.field for change in right}
        wrong = self.base & inputs - {"MUP"}
        compared = self.results.keys() | self.texts.keys() & predicted.keys() & inputs - spared
        for name in compared:
            low, high = predicted.get(name, (math.nan, math.nan))
            if not any(low <= number <= high for number in self.numbers[name]):
                wrong |= {name}
        # what contradicts the program's number contradicts a cause that predicts the same
        wrong |= {n for n, value in self._contradicted.items() if predicted.get(n, value) == value}
        wrong |= {"ENDING"} if self.paper.ending not in (None, outcome.ending) else set()
        for check in self.found.replies:
            read = check.status in (Status.READ, Status.CONTRADICTED)
            if read and not same_value(check.printed or "", scene.get(check.name, "")):
                wrong |= {f"reply {check.name}"}
        return wrong

    @cached_property
    def only_last_places(self) -> bool:
        """Whether nothing differs but results, in their last places."""
        return all(
            name in self.checks
            and name not in INPUTS
            and in_last_places(name, self.checks[name].printed, self.checks[name].recomputed)
            for name in self.base
        )


def differing(found: Judged) -> frozenset[str]:
    """The names of what differs; replies and labels are marked as such."""
    replies = set(map(id, found.replies))
    return frozenset(
        [f"{'reply ' * (id(check) in replies)}{check.name}" for check in found.contradicted]
        + [f"label {label.name}" for label in found.paper.mislabelled]
    )


def as_printed(outcome: Outcome) -> dict[str, Range]:
    """What a run prints, as ranges of one number."""
    return {name: (float(text), float(text)) for name, text in outcome.fields.items()}


def decimals_of(text: str) -> int:
    """The decimals of a number; 0 of none."""
    value = value_of(text)
    return 0 if value is None else max(0, -int(value.as_tuple().exponent))


def digits_of(text: str | None) -> int:
    """The digits of a number; 0 of none."""
    value = value_of(text or "")
    return 0 if value is None else len(value.normalize().as_tuple().digits)


def in_last_places(name: str, printed: str | None, other: str | None) -> bool:
    """Whether a result is another by no more than other arithmetics leave open: one in the last
    place it is floored to, or the last of the digits of the kinetic energy."""
    first, second = value_of(printed or ""), value_of(other or "")
    if first is None or second is None or name not in FIELDS:
        return False
    places = FIELDS[name].places
    units = 1 if places is not None else _ENERGY_UNITS
    last = second.adjusted() - _ENERGY_DIGITS + 1 if places is None else -places
    return abs(first - second).scaleb(-last) <= units
