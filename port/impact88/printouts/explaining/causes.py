"""A page as evidence: its numbers, and the numbers that a cause leaves unexplained.

A cause predicts a range for each number, of one value where it says what is printed. Bits and
limits in this package were chosen on the classes of tests/support/slippedpages.py; the effect of
doubling one was measured on 37 of their pages.
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

LABELS_EXCHANGED = "labels exchanged"
LABEL_WRONG = "another label"
ROWS = "rows"
NOT_APPLESOFT = "then this program on an Apple II did not print it"
MAX_LEFT_FRACTION = 0.15
"""Largest fraction of the differing numbers that a cause may leave; doubled, one page changes."""
_ENERGY_DIGITS = 9  # digits that the kinetic energy is printed with
_ENERGY_UNITS = 2
"""Units of the energy's last digit by which other arithmetics may differ. Doubled, no page changes;
with none, one page of IEEE doubles is not recognized."""


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
    """A judged page. ``base``: the names of all that differs (``reply UX`` for a reply, ``label
    UX`` for a label); ``results``: by name, the possible values of a result, the likeliest first;
    ``texts``: the numbers read clean; ``max_left``: the number of differences that a cause may
    leave unexplained."""

    def __init__(self, found: Judged) -> None:
        self.found, self.paper, self.recovered = found, found.paper, found.recovered
        self.checks = {check.name: check for check in found.fields}
        self.checks |= {f"reply {check.name}": check for check in found.replies}
        self.base = differing(found)
        self.max_left = int(MAX_LEFT_FRACTION * len(self.base))
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
        """Return the number of decimals of a field on the page."""
        return decimals_of(self.texts.get(name, ""))

    def median_error(self, found: Mapping[str, Any], count: int) -> Any:
        """Return the median relative error of ``count`` sets of results (arrays by name)."""
        rows = [
            np.nan_to_num(np.abs(column - number) / (abs(number) + 0.1), nan=1.0)
            for name, column in found.items()
            for number in self.results.get(name, [])[:1]
        ]
        return np.median(rows, axis=0) if rows else np.zeros(count)

    def fits(self, found: Mapping[str, Any], count: int, units: float, part: float) -> Any:
        """Return a mask of the sets of results that may explain the page.

        ``found`` has arrays of ``count`` results in double precision by name. A result fits within
        ``units`` of its last place plus the fraction ``part`` of its value.
        """
        misfits = np.zeros(count, int)
        mu = double(self.recovered.scene["MU"])
        if abs(mu) >= -PIVOT != -mu:  # double precision does not follow line 510 past the pivot's
            found = {}
        for name, column in found.items():
            unit = 10.0 ** -min(FIELDS[name].places or 9, self.decimals(name))
            numbers = self.results.get(name, [])
            matches = [np.abs(column - x) <= units * unit + part * abs(x) for x in numbers]
            misfits += ~np.any(matches, axis=0) if matches else 0
        return misfits <= self.max_left

    def left(
        self,
        scene: Mapping[str, str],
        outcome: Outcome,
        right: Iterable[Change] = (),
        otherwise: Mapping[str, Range] | None = None,
        spared: frozenset[str] = frozenset(),
    ) -> frozenset[str]:
        """Return the names that a scene leaves unexplained.

        These are results outside the ranges of its outcome (or of ``otherwise``, where given),
        printed inputs that differ (but not those in ``spared`` or corrected by ``right``), the
        ending, and replies that are not its values.
        """
        ranges = {**as_printed(outcome), **(otherwise or {})}
        inputs = set(INPUTS) - {change.field for change in right}
        wrong = self.base & inputs - {"MUP"}
        names = self.results.keys() | self.texts.keys() & ranges.keys() & inputs - spared
        for name in names:
            low, high = ranges.get(name, (math.nan, math.nan))
            if not any(low <= number <= high for number in self.numbers[name]):
                wrong |= {name}
        # what contradicts the program's number contradicts a cause that predicts the same
        wrong |= {n for n, value in self._contradicted.items() if ranges.get(n, value) == value}
        wrong |= {"ENDING"} if self.paper.ending not in (None, outcome.ending) else set()
        wrong |= self.base & {ROWS}
        for check in self.found.replies:
            read = check.status in (Status.READ, Status.CONTRADICTED)
            if read and not same_value(check.printed or "", scene.get(check.name, "")):
                wrong |= {f"reply {check.name}"}
        return wrong

    @cached_property
    def only_last_places(self) -> bool:
        """True if only results differ, in their last places."""
        return all(
            name in self.checks
            and name not in INPUTS
            and in_last_places(name, self.checks[name].printed, self.checks[name].recomputed)
            for name in self.base
        )


def differing(found: Judged) -> frozenset[str]:
    """Return the names of all that differs; replies and labels are marked as such."""
    replies = set(map(id, found.replies))
    return frozenset(
        [f"{'reply ' * (id(check) in replies)}{check.name}" for check in found.contradicted]
        + [f"label {label.name}" for label in found.paper.mislabelled]
        + [ROWS] * found.paper.rows_contradict
    )


def as_printed(outcome: Outcome) -> dict[str, Range]:
    """Return the printed fields of a run as ranges of one number."""
    return {name: (float(text), float(text)) for name, text in outcome.fields.items()}


def decimals_of(text: str) -> int:
    """Return the number of decimals in a text; 0 if it is no number."""
    value = value_of(text)
    return 0 if value is None else max(0, -int(value.as_tuple().exponent))


def digits_of(text: str | None) -> int:
    """Return the number of digits in a text; 0 if it is no number."""
    value = value_of(text or "")
    return 0 if value is None else len(value.normalize().as_tuple().digits)


def in_last_places(name: str, printed: str | None, other: str | None) -> bool:
    """Return True if two texts of a result differ by no more than other arithmetics may: one unit
    of the last place it is floored to, or two of the last digit of the kinetic energy."""
    first, second = value_of(printed or ""), value_of(other or "")
    if first is None or second is None or name not in FIELDS:
        return False
    places = FIELDS[name].places
    units = 1 if places is not None else _ENERGY_UNITS
    last = second.adjusted() - _ENERGY_DIGITS + 1 if places is None else -places
    return abs(first - second).scaleb(-last) <= units
