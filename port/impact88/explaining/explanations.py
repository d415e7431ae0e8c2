"""Explaining a printout that differs: causes, each tested by replay, best first.

A cause is a slip or two in what is printed (`rereading`), two numbers in each other's place,
another unit, another program or arithmetic (`otherruns`), or two of a side or an axis exchanged and
a slip besides. What counts is how many of the numbers that differ then agree and how much has to be
believed for it; a cause is offered only when it explains nearly all that differs. Causes that ask
for about as much and leave the same unexplained share a rank: the page cannot tell them apart.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from dataclasses import field as default
from decimal import Decimal
from functools import cached_property
from typing import Any

from ..fields import FIELDS, INPUTS
from ..judging.judgement import FieldCheck, Status
from ..reading.numerals import value_of
from ..reading.printout import Printout
from ..recovery import misprints
from ..recovery.recovered import Recovered
from ..recovery.rereading import Change, Reread, Rereading
from ..recovery.search import Scored
from . import otherruns, refining
from .hypothesis import NATURAL, NOT_APPLESOFT, Hypothesis

MOST = 6
"""Explanations given at most."""
_NEARLY_ALL = 0.15
"""An explanation that leaves more than this of what differs is none."""
_SLIPS_IN_RESULTS = 3
_MOST_SLIPS = 4
"""More slips than these are no explanation: nobody makes them all."""
_ALIKE = 0.8
"""Causes that leave the same unexplained and ask for no more than this more share a rank."""
_WORSE = 1.5
"""What asks for so much more than the best is no cause."""
_GOOD = 1.6
_SLIPS_BESIDES = 60
_TWINS = 8
LABELS_EXCHANGED = "labels exchanged"
LABEL_WRONG = "another label"
NO_SINGLE_SLIP = "no single slip explains this"

_COST = {
    misprints.DIGIT: 1.0,
    misprints.SIGN: 0.95,
    misprints.POINT: 1.05,
    misprints.SWAP: 1.1,
    misprints.COUNT: 1.25,
    misprints.TWO_DIGITS: 1.9,
}
"""How much a slip asks to be believed."""
_LAST_PLACE = 0.8
"""A result wrong by one in its last place is more likely another arithmetic than a misreading, and
so is a page on which nothing worse is wrong."""
_ENERGY_DIGITS, _ENERGY_UNITS = 9, 2
"""The kinetic energy is printed to so many digits; other arithmetics end within so many units of
the last of them."""


@dataclass
class Explanation:
    """A cause that would make printed and recomputed agree in ``explains`` of the differing numbers
    and leaves ``remaining`` differences. ``changes``: every printed number it puts right, and where
    it stands; ``field``, ``printed``, ``would_be``: the first of them. ``look``: where to look on
    the paper. ``rank``: from 1; explanations that the page cannot tell apart share it."""

    kind: str
    field: str | None
    printed: str | None
    would_be: str | None
    explains: int
    remaining: int
    note: str = ""
    changes: list[dict[str, Any]] = default(default_factory=list)
    look: list[str] = default(default_factory=list)
    rank: int = 1
    weight: float = 0.0
    unexplained: frozenset[str] = frozenset()

    def as_json(self) -> dict[str, Any]:
        """The object `impact88 verify --json` prints."""
        shown = dict(vars(self))
        del shown["weight"], shown["unexplained"]
        return shown


def explain(
    shown: Printout,
    recovered: Recovered,
    checks: Sequence[FieldCheck],
    replies: Sequence[FieldCheck],
    ending: FieldCheck,
    rereads: Sequence[Reread] | None = None,
    in_time: Callable[[], bool] = lambda: True,
) -> list[Explanation]:
    """Causes that make more of a differing printout agree, those that ask least first. ``rereads``:
    slips that were tried already, where those are all there can be; ``in_time``: whether another
    kind of cause may still be tried."""
    base = frozenset(
        [check.name for check in checks if check.status == Status.CONTRADICTED]
        + [f"reply {check.name}" for check in replies if check.status == Status.CONTRADICTED]
        + ([ending.name] if ending.status == Status.CONTRADICTED else [])
        + [f"label {one.name}" for one in shown.mislabelled]
    )
    work = _Work(shown, recovered, base, {check.name: check for check in checks})
    alone = work.by_results_alone(replies)
    explanations = [*([alone] if alone else []), *work.labels_exchanged()]
    if not recovered.missing and any(not name.startswith("label ") for name in base):
        reread = list(work.rereading.best() if rereads is None else rereads)
        explanations += work.rereads(reread, replies)
        hypotheses = otherruns.hypotheses(shown, recovered)
        explanations += work.others(hypotheses, replies)
        if in_time() and (not explanations or min(one.weight for one in explanations) > _GOOD):
            doubles = work.rereading.double_slips()
            explanations += work.rereads(doubles, replies)
            reread += doubles
        explanations += work.twins(reread, replies)
        if in_time() and (not explanations or min(one.weight for one in explanations) > _GOOD + 1):
            refined = list(refining.refined(recovered, hypotheses))
            explanations += work.others(refined, replies)
            explanations += work.exchanged_and_slipped(hypotheses, replies)
    return _chosen(explanations, len(base))


@dataclass
class _Work:
    """What all explanations are measured against: the names that differ."""

    shown: Printout
    recovered: Recovered
    base: frozenset[str]
    checks: dict[str, FieldCheck]

    @cached_property
    def rereading(self) -> Rereading:
        """Slips in inputs, wherever they come from."""
        return Rereading(self.recovered, apart=True)

    @cached_property
    def last_places(self) -> bool:
        """Whether nothing differs but results, in their last places."""
        return all(
            name in self.checks
            and name not in INPUTS
            and _in_last_places(name, self.checks[name].printed, self.checks[name].recomputed)
            for name in self.base
        )

    def by_results_alone(self, replies: Sequence[FieldCheck]) -> Explanation | None:
        """Results and replies that are one slip away from what they should be."""
        names = {name for name in self.base if name != "ENDING" and not name.startswith("label ")}
        changes = list(self._slips(names, self.recovered.outcome.fields, replies))
        if not changes:
            return None
        unexplained = self.base - {change.field for change in changes}
        return self._explanation(changes, unexplained, len(unexplained))

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
        read, printed = (
            sorted(getattr(one, side) for one in wrong) for side in ("read", "printed")
        )
        kind = LABELS_EXCHANGED if read == printed else LABEL_WRONG
        unexplained = self.base - {f"label {one.name}" for one in wrong}
        changes = [
            {
                "kind": kind, "field": one.name, "printed": one.read, "would_be": one.printed,
                "line": one.line, "column": one.column,
                "look": f"line {one.line}, column {one.column}: is this {one.read} {one.printed}?",
            }
            for one in wrong
        ]  # fmt: skip
        first = wrong[0]
        yield Explanation(
            kind, first.name, first.read, first.printed, len(wrong), len(unexplained),
            "the numbers are what the program prints where they stand", changes,
            [str(change["look"]) for change in changes],
            weight=1.0 + len(unexplained), unexplained=unexplained,
        )  # fmt: skip

    def rereads(
        self, reread: Sequence[Reread], replies: Sequence[FieldCheck]
    ) -> Iterator[Explanation]:
        """Inputs put right, with what results are then still a slip away."""
        for one in reread:
            if not one.changes:
                continue
            wrong = self._wrong(one.scored, replies) | self._inputs_left(one.changes)
            changes = list(one.changes)
            names = {name for name in wrong if name in self.base}
            if len(names) <= _SLIPS_IN_RESULTS:
                changes += self._slips(names, one.scored.outcome.fields, replies)
            unexplained = len(wrong) - (len(changes) - len(one.changes))
            yield self._explanation(changes, wrong - {c.field for c in changes}, unexplained)

    def twins(
        self, reread: Sequence[Reread], replies: Sequence[FieldCheck]
    ) -> Iterator[Explanation]:
        """The best of the same by the other angle of a sum."""
        best = sorted(reread, key=lambda one: one.scored.cost)[:_TWINS]
        return self.rereads(list(self.rereading.twins(best)), replies)

    def others(
        self, hypotheses: Sequence[Hypothesis], replies: Sequence[FieldCheck]
    ) -> Iterator[Explanation]:
        """Other units, places, programs and arithmetics, tried."""
        for one in otherruns.tried(self.shown, self.recovered, hypotheses):
            wrong = one.wrong | self._wrong_replies(one.scene, replies)
            if one.hypothesis.outcome is None:
                wrong |= self._inputs_left(one.hypothesis.changes)
            explained = len(self.base - wrong)
            shown = Explanation(
                one.hypothesis.kind,
                None,
                None,
                None,
                explained,
                len(wrong),
                one.hypothesis.note,
                weight=one.hypothesis.weight + len(wrong),
                unexplained=wrong,
            )
            first = one.hypothesis.changes[0] if one.hypothesis.changes else None
            if first is not None:
                shown.field, shown.printed, shown.would_be = (
                    first.field,
                    first.printed,
                    first.would_be,
                )
                shown.changes = [self._change(change) for change in one.hypothesis.changes]
            yield shown

    def exchanged_and_slipped(
        self, hypotheses: Sequence[Hypothesis], replies: Sequence[FieldCheck]
    ) -> Iterator[Explanation]:
        """Inputs of a side or an axis exchanged, and a slip in another."""
        printed = set(self.recovered.assumed)
        exchanges = [
            one
            for one in hypotheses
            if one.assumed is not None
            and one.weight <= NATURAL
            and one.changes
            # inputs that were given apart stand nowhere on the page to be exchanged
            and {change.field for change in one.changes} <= printed
        ]
        texts = [
            {change.field: (one.assumed or {})[change.field] for change in one.changes}
            for one in exchanges
        ]
        if not texts:
            return
        for number, one in self.rereading.besides(texts, _SLIPS_BESIDES):
            hypothesis = exchanges[number]
            wrong = self._wrong(one.scored, replies)
            wrong |= self._inputs_left([*hypothesis.changes, *one.changes])
            believed = hypothesis.weight + sum(map(_believed, one.changes)) + 0.1
            made = self._explanation(
                [*hypothesis.changes, *one.changes], wrong, len(wrong), believed
            )
            made.note = hypothesis.note
            yield made

    def _inputs_left(self, changes: Sequence[Change]) -> frozenset[str]:
        """Printed inputs that differ and that these changes leave as they are."""
        changed = {change.field for change in changes}
        return self.base & frozenset(INPUTS) - {"MUP"} - changed

    def _wrong(self, scored: Scored, replies: Sequence[FieldCheck]) -> frozenset[str]:
        return scored.wrong | self._wrong_replies(scored.scene, replies)

    def _wrong_replies(
        self, scene: dict[str, str], replies: Sequence[FieldCheck]
    ) -> frozenset[str]:
        from ..judging.judgement import same_value

        return frozenset(
            f"reply {check.name}"
            for check in replies
            if check.printed is not None
            and check.status in (Status.READ, Status.CONTRADICTED)
            and not same_value(check.printed, scene[check.name])
        )

    def _slips(
        self, names: set[str], fields: dict[str, str], replies: Sequence[FieldCheck]
    ) -> Iterator[Change]:
        for name in sorted(names - {"ENDING"}):
            if name.startswith("label "):
                continue
            if name.startswith("reply "):
                check = next(one for one in replies if f"reply {one.name}" == name)
                should = self.recovered.scene.get(check.name)
            else:
                check, should = self.checks[name], fields.get(name)
            if check.printed is None or should is None:
                continue
            kind = misprints.slip(check.printed, should)
            if kind is None and misprints.differ_in_two(check.printed, should):
                kind = misprints.TWO_DIGITS
            if kind:
                yield Change(kind, name, check.printed, should)

    def _explanation(
        self,
        changes: Sequence[Change],
        unexplained: frozenset[str],
        remaining: int,
        believed: float | None = None,
    ) -> Explanation:
        first = changes[0]
        kinds = list(dict.fromkeys(change.kind for change in changes))
        kind = kinds[0] if len(kinds) == 1 else " and ".join(kinds)
        if believed is None:
            believed = sum(map(_believed, changes)) + 0.1 * (len(changes) - 1)
        if all(change.field in INPUTS for change in changes) and self.last_places:
            believed += _LAST_PLACE
        weight = believed + remaining
        explains = len(self.base - unexplained)
        name = first.field.removeprefix("reply ")
        note = ""
        if first.field.startswith("reply "):
            note = "in the typed reply"
        elif any(one.field in self.recovered.apart for one in changes):
            note = "in the inputs given apart"
        described = [self._change(change) for change in changes]
        look = [one["look"] for one in described if one["look"]]
        return Explanation(
            kind, name, first.printed, first.would_be, explains, max(0, remaining), note,
            described, look, weight=weight, unexplained=unexplained,
        )  # fmt: skip

    def _change(self, change: Change) -> dict[str, Any]:
        name = change.field.removeprefix("reply ")
        source = self.shown.replies if change.field.startswith("reply ") else self.shown.fields
        reading = source.get(name)
        where = (reading.line, reading.column) if reading else (None, None)
        look = ""
        if reading is not None and change.kind == misprints.DIGIT:
            pairs = enumerate(zip(change.printed, change.would_be, strict=False))
            index = next((i for i, (read, true) in pairs if read != true), 0)
            if index < len(reading.region):
                line, column = self.shown.place(reading.region[index].offset)
                read, true = change.printed[index], change.would_be[index]
                article = "an" if true == "8" else "a"
                look = f"line {line}, column {column}: is this {read} {article} {true}?"
        elif reading is not None:
            look = (
                f"line {reading.line}, column {reading.column}: is this {change.printed} "
                f"{change.would_be}?"
            )
        return {
            "kind": change.kind, "field": name, "printed": change.printed,
            "would_be": change.would_be, "line": where[0], "column": where[1], "look": look,
        }  # fmt: skip


def _believed(change: Change) -> float:
    cost = _COST[change.kind]
    if change.kind == misprints.DIGIT:
        cost += 0.04 * misprints.likeness(change.printed, change.would_be)
    if change.field not in INPUTS:
        cost += _LAST_PLACE * _in_last_places(change.field, change.printed, change.would_be)
    return cost


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


def _chosen(explanations: list[Explanation], base: int) -> list[Explanation]:
    """Those that explain nearly all, the least to believe first; none twice."""
    most_left = max(0, int(_NEARLY_ALL * base))
    kept = [
        one
        for one in explanations
        if one.explains > 0 and one.remaining <= most_left and _few_slips(one)
    ]
    kept = [one for one in kept if not any(_completes(other, one) for other in kept)]
    kept.sort(key=lambda one: one.weight)
    if kept:
        kept = [one for one in kept if one.weight <= kept[0].weight + _WORSE]
    chosen: list[Explanation] = []
    for one in kept:
        # what only adds to a simpler cause, or says it again, is none of its own
        if not any(_adds_to(one, other) or _says(one) == _says(other) for other in chosen):
            chosen.append(one)
    # a misreading that would do is not left out where another machine is named
    shown, others = chosen[:MOST], chosen[MOST:]
    innocent = next((one for one in others if not _accuses(one)), None)
    if innocent is not None and all(map(_accuses, shown)):
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
            and (_accuses(other) or not _accuses(one))
        )
        one.rank = next(alike, len(leaders) + 1)
        if one.rank > len(leaders):
            leaders.append(one)
    return sorted(chosen, key=lambda one: (one.rank, one.weight))


def _accuses(one: Explanation) -> bool:
    return one.note.endswith(NOT_APPLESOFT)


def _few_slips(one: Explanation) -> bool:
    count = sum(change["kind"] in misprints.KINDS_OF_SLIPS for change in one.changes)
    return count <= _MOST_SLIPS


def _completes(one: Explanation, other: Explanation) -> bool:
    """Whether one puts right what the other does and, slip for slip, what that leaves."""
    more = len(_changes(one)) - len(_changes(other))
    return (
        bool(other.changes)
        and one.unexplained < other.unexplained
        and _changes(other) < _changes(one)
        and more <= len(other.unexplained - one.unexplained)
    )


def _adds_to(one: Explanation, other: Explanation) -> bool:
    """Whether one puts right what the other does and more, the same in the same way, or the same
    numbers in the same way and worse."""
    changes, others = _changes(one), _changes(other)
    if one.kind == other.kind and one.remaining > other.remaining:
        return {name for name, _ in changes} == {name for name, _ in others} != set()
    return bool(others) and (others < changes or (others == changes and one.kind == other.kind))


def _says(one: Explanation) -> tuple[str, str, frozenset[tuple[str, str]]]:
    return one.kind, one.note, _changes(one)


def _changes(one: Explanation) -> frozenset[tuple[str, str]]:
    return frozenset((change["field"], change["would_be"]) for change in one.changes)
