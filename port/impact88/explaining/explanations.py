"""Explaining a printout that differs: causes, each tested by replay, the likeliest first.

A cause is an edit: of what is printed (slips, labels), of the inputs or results as a whole (the
rows of ``hypotheses.txt``), of the machine or its printing, or of one line of the listing. Each
asks for some bits to be believed, and for as many more as every number that it leaves unexplained
would take as a slip of its own; the fewest bits come first. A cause is offered only when it
explains nearly all that differs. Causes that ask for about as much and leave the same unexplained
share a rank: the page cannot tell them apart.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from dataclasses import field as default
from decimal import Decimal
from functools import cached_property
from typing import Any

import numpy as np

from ..fields import FIELDS, INPUTS
from ..judging.judgement import Judged, Status, same_value
from ..reading.numerals import value_of
from ..recovery import misprints
from ..recovery.recovered import Recovered
from ..recovery.rereading import Change, Reread, Rereading
from . import hypotheses, machines, programs
from .predictions import Evidence

MOST = 6
"""Explanations given at most."""
NO_SINGLE_SLIP = "no single slip explains this"
LABELS_EXCHANGED, LABEL_WRONG = "labels exchanged", "another label"
_LABEL = 10.0
"""Bits of wrong labels on numbers that are what the program prints."""
_LEFT = 14.0
"""Bits of a number that a cause leaves unexplained: more than of a slip besides (10 to 13.5), so
that a cause with the slip comes before the one without."""
_NEARLY_ALL = 0.15
"""An explanation that leaves more than this of what differs is none."""
_SLIPS_IN_RESULTS = 3
_MOST_BITS = 50.0
"""What asks for more is no explanation: four slips of the likelier kinds."""
_ALIKE = 8.0
"""Causes that leave the same unexplained and ask for no more bits than these more share a rank."""
_WORSE = 15.0
"""What asks for so many bits more than the best is no cause."""
_GOOD, _MORE = 16.0, 10.0
"""Up to so many bits nothing further is looked for, and so many more before what takes a second."""
_LOOKED_AT = {*misprints.KINDS_OF_SLIPS, LABELS_EXCHANGED, LABEL_WRONG}
"""Kinds of changes that the paper itself can show."""
_BY_COPY = 12
_KINDS = {
    misprints.DIGIT: 10.0,
    misprints.SIGN: 9.5,
    misprints.POINT: 10.5,
    misprints.SWAP: 11.0,
    misprints.COUNT: 12.5,
    misprints.TWO_DIGITS: 19.0,
}
"""Bits of a slip; one more for each after the first, and up to 1.6 for digits that look unlike."""
_UNLIKE, _EACH = 0.4, 1.0
_LAST_PLACE = 8.0
"""Bits more for a result misread by one in its last place, where another arithmetic is likelier;
and for misread inputs on a page on which nothing worse is wrong."""
_OTHER_ARITHMETIC = 17.0
"""Bits of an arithmetic that is not among those tried: less than two last places misread (37)."""
_ENERGY_DIGITS, _ENERGY_UNITS = 9, 2
"""The kinetic energy is printed to so many digits; other arithmetics end within so many units of
the last of them."""


@dataclass
class Explanation:
    """A cause that would make printed and recomputed agree in ``explains`` of the differing numbers
    and leaves ``remaining`` differences. ``changes``: every printed number it puts right, and where
    it stands. ``look``: where to look on the paper. ``rank``: from 1; explanations that the page
    cannot tell apart share it. ``weight``: the bits it asks for."""

    kind: str
    note: str
    weight: float
    explains: int
    unexplained: frozenset[str]
    changes: list[dict[str, Any]] = default(default_factory=list)
    look: list[str] = default(default_factory=list)
    rank: int = 1

    @property
    def remaining(self) -> int:
        """How many numbers differ still."""
        return len(self.unexplained)

    @property
    def field(self) -> str | None:
        """The first number it puts right."""
        return self.changes[0]["field"] if self.changes else None

    @property
    def printed(self) -> str | None:
        """What stands there."""
        return self.changes[0]["printed"] if self.changes else None

    @property
    def would_be(self) -> str | None:
        """What would stand there."""
        return self.changes[0]["would_be"] if self.changes else None

    def as_json(self) -> dict[str, Any]:
        """The object `impact88 verify --json` prints."""
        return {
            "kind": self.kind, "field": self.field, "printed": self.printed,
            "would_be": self.would_be, "explains": self.explains, "remaining": self.remaining,
            "note": self.note, "changes": self.changes, "look": self.look, "rank": self.rank,
        }  # fmt: skip

    @property
    def puts_right(self) -> frozenset[tuple[str, str]]:
        """The numbers it puts right, and as what."""
        return frozenset((change["field"], change["would_be"]) for change in self.changes)

    @property
    def accuses(self) -> bool:
        """Whether it says that another program or machine made the page."""
        return self.note.endswith(machines.NOT_APPLESOFT)


@np.errstate(all="ignore")  # a cause tried may leave a double's range, and then explains nothing
def explain(
    found: Judged,
    rereads: Sequence[Reread] | None = None,
    in_time: Callable[[], bool] = lambda: True,
) -> list[Explanation]:
    """Causes that make more of a differing printout agree, those that ask least first. ``rereads``:
    slips that were tried already, where those are all there can be; ``in_time``: whether another
    kind of cause may still be tried."""
    work = _Work(found)
    causes = [*work.by_results_alone(), *work.labels_exchanged()]

    def wanting(bits: float) -> bool:
        return in_time() and min((one.weight for one in causes), default=100.0) > bits

    if not found.recovered.missing and any(not one.startswith("label ") for one in work.base):
        rereading = Rereading(found.recovered, apart=True)
        causes += work.rereads(list(rereading.best() if rereads is None else rereads))
        tables = hypotheses.Tables(work.evidence)
        causes += work.rows(tables.nearest)
        causes += work.results_otherwise()
        causes += map(work.machine, machines.causes(work.evidence))
        causes += work.last_places_alone()
        if wanting(_GOOD + _MORE):
            causes += work.rows(list(tables.searched()))
            causes += work.exchanged_and_slipped(tables.exchanges(), rereading)
        if wanting(_GOOD + _MORE):
            causes += map(work.machine, programs.causes(work.evidence, work.base))
    return _chosen(causes, len(work.base))


@np.errstate(all="ignore")
def explain_copy(
    found: Judged,
    recovered: Recovered,
    held: Callable[[Recovered], Judged],
) -> list[Explanation]:
    """The same of a page held against a copy of the listing: slips, judged by the copy's own page.
    ``recovered``: by the restored listing, whose nearest slips are tried; ``held``: the page
    judged by the copy for another scene."""
    work = _Work(found)
    causes = [*work.by_results_alone(), *work.labels_exchanged()]
    if not recovered.missing:
        for one in Rereading(recovered).best()[:_BY_COPY]:
            scored = one.scored
            by = held(replace(recovered, scene=scored.scene, assumed=scored.assumed))
            wrong = frozenset(check.name for check in by.contradicted)
            same = scored._replace(outcome=by.recovered.outcome, wrong=wrong)
            causes += work.rereads([one._replace(scored=same)])
    return _chosen(causes, len(work.base))


class _Work:
    """What all explanations are measured against: the names that differ."""

    def __init__(self, found: Judged) -> None:
        self.shown, self.recovered, self.replies = found.shown, found.recovered, found.replies
        self.checks = {check.name: check for check in found.fields}
        replies = set(map(id, found.replies))
        self.base = frozenset(
            [f"{'reply ' * (id(one) in replies)}{one.name}" for one in found.contradicted]
            + [f"label {one.name}" for one in found.shown.mislabelled]
        )

    @cached_property
    def evidence(self) -> Evidence:
        """The page as evidence."""
        return Evidence(self.shown, self.recovered, self.base)

    @cached_property
    def last_places(self) -> bool:
        """Whether nothing differs but results, in their last places."""
        return all(
            name in self.checks
            and name not in INPUTS
            and _in_last_places(name, self.checks[name].printed, self.checks[name].recomputed)
            for name in self.base
        )

    def by_results_alone(self) -> Iterator[Explanation]:
        """Results and replies that are one slip away from what they should be."""
        changes = list(self._slips(self.base, self.recovered.outcome.fields))
        if changes:
            yield self._slipped(changes, self.base - {change.field for change in changes})

    def last_places_alone(self) -> Iterator[Explanation]:
        """An arithmetic that is none of those tried: results off by one in their last places."""
        longer = any(
            self.evidence.decimals(n) > (FIELDS[n].places or 9) for n in self.evidence.texts
        )
        if self.last_places and len(self.base) > 1 and not longer:
            note = f"all that differs is off by one in its last place; {machines.NOT_APPLESOFT}"
            yield self._explanation("another arithmetic", note, _OTHER_ARITHMETIC, frozenset(), [])

    def labels_exchanged(self) -> Iterator[Explanation]:
        """Labels that stand in each other's place, or say another number, on numbers that are what
        the program prints where they stand."""
        wrong = [
            one
            for one in self.shown.mislabelled
            if one.name in self.checks and self.checks[one.name].status == Status.READ
        ]
        if not wrong:
            return
        exchanged = sorted(one.read for one in wrong) == sorted(one.printed for one in wrong)
        kind = LABELS_EXCHANGED if exchanged else LABEL_WRONG
        described = [
            _described(kind, one.name, one.read, one.printed, one.line, one.column) for one in wrong
        ]
        unexplained = self.base - {f"label {one.name}" for one in wrong}
        note = "the numbers are what the program prints where they stand"
        yield self._explanation(kind, note, _LABEL, unexplained, described)

    def rereads(self, reread: Iterable[Reread]) -> Iterator[Explanation]:
        """Inputs put right, with what results are then still a slip away."""
        for one in reread:
            if not one.changes:
                continue
            wrong = self._wrong(one, one.changes)
            changes = list(one.changes)
            if len(wrong & self.base) <= _SLIPS_IN_RESULTS:
                changes += self._slips(wrong & self.base, one.scored.outcome.fields)
            yield self._slipped(changes, wrong - {change.field for change in changes})

    def rows(self, every: Sequence[hypotheses.Hypothesis]) -> Iterator[Explanation]:
        """Inputs in other places and units, replayed."""
        for one, wrong in hypotheses.unexplained(self.evidence, every):
            wrong |= self._wrong_replies(one.scene) | self._inputs_left(one.changes)
            described = list(map(self._change, one.changes))
            yield self._explanation(one.row.kind, one.row.note, one.row.bits, wrong, described)

    def results_otherwise(self) -> Iterator[Explanation]:
        """Results in other places and units."""
        for row, wrong, changes in hypotheses.results_otherwise(self.evidence):
            described = list(map(self._change, changes))
            yield self._explanation(row.kind, row.note, row.bits, wrong, described)

    def machine(self, one: machines.Cause) -> Explanation:
        """Another machine, another print, another line of the listing."""
        wrong = one.wrong | self._wrong_replies(one.scene) | self._inputs_left(())
        return self._explanation(one.kind, one.note, one.bits, wrong, [])

    def exchanged_and_slipped(
        self, exchanges: Sequence[hypotheses.Hypothesis], rereading: Rereading
    ) -> Iterator[Explanation]:
        """Inputs of a side or an axis exchanged, and a slip in another."""
        for exchange in exchanges:
            texts = {one.field: exchange.assumed[one.field] for one in exchange.changes}
            for one in rereading.best(texts):
                changes = [*exchange.changes, *one.changes]
                bits = exchange.row.bits + sum(map(_believed, one.changes)) + _EACH
                made = self._slipped(changes, self._wrong(one, changes), bits)
                made.note = exchange.row.note
                yield made

    def _wrong(self, one: Reread, changes: Sequence[Change]) -> frozenset[str]:
        """What differs from the page of a scene put right; a number that contradicted the same
        text before still does."""
        now, before = one.scored.outcome.fields, self.recovered.outcome.fields
        still = {n for n in self.base if n not in INPUTS and n in now and now[n] == before.get(n)}
        wrong = one.scored.wrong | still | self._wrong_replies(one.scored.scene)
        return wrong | self._inputs_left(changes)

    def _inputs_left(self, changes: Sequence[Change]) -> frozenset[str]:
        """Printed inputs that differ and that these changes leave as they are."""
        changed = {change.field for change in changes}
        return self.base & frozenset(INPUTS) - {"MUP"} - changed

    def _wrong_replies(self, scene: dict[str, str]) -> frozenset[str]:
        return frozenset(
            f"reply {check.name}"
            for check in self.replies
            if check.printed is not None
            and check.status in (Status.READ, Status.CONTRADICTED)
            and not same_value(check.printed, scene[check.name])
        )

    def _slips(self, names: Iterable[str], fields: dict[str, str]) -> Iterator[Change]:
        replies = {f"reply {check.name}": check for check in self.replies}
        for name in sorted(names):
            check = replies.get(name) or self.checks.get(name)
            if check is None:
                continue
            should = self.recovered.scene.get(check.name) if name in replies else fields.get(name)
            if check.printed is None or should is None:
                continue
            kind = misprints.slip(check.printed, should)
            if kind is None and misprints.differ_in_two(check.printed, should):
                kind = misprints.TWO_DIGITS
            if kind:
                yield Change(kind, name, check.printed, should)

    def _slipped(
        self, changes: Sequence[Change], unexplained: frozenset[str], bits: float | None = None
    ) -> Explanation:
        if bits is None:
            bits = sum(map(_believed, changes)) + _EACH * (len(changes) - 1)
        if all(change.field in INPUTS for change in changes) and self.last_places:
            bits += _LAST_PLACE
        note = ""
        if changes[0].field.startswith("reply "):
            note = "in the typed reply"
        elif any(one.field in self.recovered.apart for one in changes):
            note = "in the inputs given apart"
        kind = " and ".join(dict.fromkeys(change.kind for change in changes))
        return self._explanation(kind, note, bits, unexplained, list(map(self._change, changes)))

    def _explanation(
        self,
        kind: str,
        note: str,
        bits: float,
        unexplained: frozenset[str],
        changes: list[dict[str, Any]],
    ) -> Explanation:
        look = [change["look"] for change in changes if change["kind"] in _LOOKED_AT]
        explains = len(self.base - unexplained)
        bits += _LEFT * len(unexplained)
        return Explanation(kind, note, bits, explains, unexplained, changes, look)

    def _change(self, change: Change) -> dict[str, Any]:
        name = change.field.removeprefix("reply ")
        source = self.shown.replies if change.field.startswith("reply ") else self.shown.fields
        reading = source.get(name)
        if reading is None:
            return _described(change.kind, name, change.printed, change.would_be)
        at = reading.line, reading.column
        made = _described(change.kind, name, change.printed, change.would_be, *at)
        if change.kind == misprints.DIGIT:
            pairs = enumerate(zip(change.printed, change.would_be, strict=False))
            index = next((i for i, (read, true) in pairs if read != true), 0)
            if index < len(reading.region):
                at = self.shown.place(reading.region[index].offset)
            digit = change.would_be[index]
            is_this = f"is this {change.printed[index]} {'an' if digit == '8' else 'a'} {digit}?"
            made["look"] = f"line {at[0]}, column {at[1]}: {is_this}"
        return made


def _described(
    kind: str,
    name: str,
    printed: str,
    would_be: str,
    line: int | None = None,
    column: int | None = None,
) -> dict[str, Any]:
    look = "" if line is None else f"line {line}, column {column}: is this {printed} {would_be}?"
    return {
        "kind": kind, "field": name, "printed": printed, "would_be": would_be,
        "line": line, "column": column, "look": look,
    }  # fmt: skip


def _believed(change: Change) -> float:
    bits = _KINDS[change.kind]
    if change.kind == misprints.DIGIT:
        bits += _UNLIKE * misprints.likeness(change.printed, change.would_be)
    if change.field not in INPUTS:
        bits += _LAST_PLACE * _in_last_places(change.field, change.printed, change.would_be)
    return bits


def _in_last_places(name: str, printed: str | None, other: str | None) -> bool:
    """Whether a result is another by no more than other arithmetics leave open: one in the last
    place it is floored to, or the last of the digits of the kinetic energy."""
    one, two = value_of(printed or ""), value_of(other or "")
    if one is None or two is None or name not in FIELDS:
        return False
    places = FIELDS[name].places
    if places is not None:
        return abs(one - two) <= Decimal(1).scaleb(-places)
    return abs(one - two) <= _ENERGY_UNITS * Decimal(1).scaleb(two.adjusted() - _ENERGY_DIGITS + 1)


# --- which are offered, and in what order ---


def _chosen(explanations: Iterable[Explanation], base: int) -> list[Explanation]:
    """Those that explain nearly all, the least to believe first; none that only adds to a simpler
    one, or says it again."""
    kept = [
        one
        for one in sorted(explanations, key=lambda one: one.weight)
        if one.explains > 0
        and one.remaining <= int(_NEARLY_ALL * base)
        and one.weight <= _MOST_BITS
    ]
    chosen: list[Explanation] = []
    for one in kept:
        if one.weight <= kept[0].weight + _WORSE and not any(_adds_to(one, o) for o in chosen):
            chosen.append(one)
    # a misreading that would do is not left out where another machine is named
    shown, others = chosen[:MOST], chosen[MOST:]
    innocent = next((one for one in others if not one.accuses), None)
    if innocent is not None and all(one.accuses for one in shown):
        shown[-1] = innocent
    return _ranked(shown)


def _ranked(chosen: list[Explanation]) -> list[Explanation]:
    """The same, with ranks; those of one rank beside each other. That another program or machine
    made the page is said beside no misreading that explains it better."""
    leaders: list[Explanation] = []
    for one in chosen:
        alike = (
            rank
            for rank, other in enumerate(leaders, 1)
            if one.unexplained == other.unexplained
            and one.weight <= other.weight + _ALIKE
            and (other.accuses or not one.accuses)
        )
        one.rank = next(alike, len(leaders) + 1)
        if one.rank > len(leaders):
            leaders.append(one)
    return sorted(chosen, key=lambda one: (one.rank, one.weight))


def _adds_to(one: Explanation, other: Explanation) -> bool:
    """Whether a cause puts right what a likelier one does and more, or the same numbers in the
    same way, or says the same."""
    if not other.changes:
        return not one.changes and (one.kind, one.note) == (other.kind, other.note)
    if one.kind == other.kind and {n for n, _ in one.puts_right} == {
        n for n, _ in other.puts_right
    }:
        return one.remaining > other.remaining or one.puts_right == other.puts_right
    return other.puts_right < one.puts_right
