"""Explaining a printout that differs: causes, each tested by replay, the likeliest first.

A cause is an edit: of what is printed (slips, labels), of the inputs or results as a whole (the
rows of ``hypotheses.txt``), of the machine or its printing, or of one line of the listing. Each
asks for some bits to be believed, and for as many more as every number that it leaves unexplained
would take as a slip of its own; the fewest bits come first. A cause is offered only when it
explains nearly all that differs. Causes that ask for about as much and leave the same unexplained
share a rank: the page cannot tell them apart.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from dataclasses import field as default
from functools import cached_property
from typing import Any

import numpy as np

from ..doubles import double
from ..fields import INPUTS, scene_name
from ..judging.judgement import Judged, Status, same_value
from ..reading.numerals import printable
from ..recovery import slips
from ..recovery.search import in_doubles
from ..recovery.slips import Change, Reread, Rereading
from ..recovery.typedtext import mu_turned
from . import hypotheses, machines, programs
from .predictions import NOT_APPLESOFT, Cause, Evidence, in_last_places

MOST = 6
"""Explanations given at most."""
LABELS_EXCHANGED, LABEL_WRONG = "labels exchanged", "another label"
_LABEL = 10.0
"""Bits of wrong labels on numbers that are what the program prints: as a digit misread."""
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
_ENOUGH = 26.0
"""Causes that take seconds to try are tried where none asks for so few bits: two slips (21)."""
_BY_COPY = 12
"""Slips, of each kind of ranking, that are tried in a copy of the listing."""
_EACH = 1.0
"""Bits of each slip after the first, besides its own."""
_LAST_PLACE = 8.0
"""Bits more for a result misread by one in its last place, where another arithmetic is likelier;
and for misread inputs on a page on which nothing worse is wrong."""
_ANOTHER_ARITHMETIC = 17.0
"""Bits of an arithmetic that is not among those tried: less than two last places misread (37)."""


@dataclass
class Explanation:
    """A cause that would make printed and recomputed agree in ``explains`` of the differing numbers
    and leaves ``unexplained`` ones. ``changes``: every printed number it puts right, and where it
    stands; ``field``, ``printed``, ``would_be``: the first of them. ``look``: where to look on the
    paper. ``rank``: from 1; explanations that the page cannot tell apart share it. ``weight``: the
    bits it asks for."""

    kind: str
    note: str
    weight: float
    explains: int
    unexplained: frozenset[str]
    changes: list[dict[str, Any]] = default(default_factory=list)
    look: list[str] = default(default_factory=list)
    rank: int = 1

    def __post_init__(self) -> None:
        first = self.changes[0] if self.changes else {}
        self.field, self.printed, self.would_be = map(first.get, ("field", "printed", "would_be"))

    @property
    def remaining(self) -> int:
        """How many numbers differ still."""
        return len(self.unexplained)

    def as_json(self) -> dict[str, Any]:
        """The object `impact88 verify --json` prints."""
        names = ("kind", "field", "printed", "would_be", "explains", "remaining", "note", "changes")
        return {name: getattr(self, name) for name in (*names, "look", "rank")}

    @property
    def puts_right(self) -> frozenset[tuple[str, str]]:
        """The numbers it puts right, and as what."""
        return frozenset((change["field"], change["would_be"]) for change in self.changes)

    @property
    def accuses(self) -> bool:
        """Whether it says that another program or machine made the page."""
        return self.note.endswith(NOT_APPLESOFT)


@np.errstate(all="ignore")  # a cause tried may leave a double's range, and then explains nothing
def explain(
    found: Judged, rereads: Callable[[], Sequence[Reread]], in_time: Callable[[], bool]
) -> list[Explanation]:
    """Causes that make more of a differing printout agree, those that ask least first. ``rereads``:
    scenes with slips put right; ``in_time``: whether another kind of cause may still be tried."""
    page = _Page(found)
    offered = page.explanations(page.without_replay())

    def wanting() -> bool:
        return in_time() and min((one.weight for one in offered), default=100.0) > _ENOUGH

    if not found.recovered.missing and any(not one.startswith("label ") for one in page.base):
        tables = hypotheses.Tables(page.evidence)
        offered += page.explanations(
            [
                *page.rereads(rereads()),
                *hypotheses.unexplained(page.evidence, tables.nearest),
                *machines.causes(page.evidence),
            ]
        )
        if not any(one.accuses and not one.unexplained for one in offered):
            offered += page.explanations(page.last_places_alone())
        if wanting():
            searched = hypotheses.unexplained(page.evidence, list(tables.searched()))
            both = page.exchanged_and_slipped(tables.exchanges())
            offered += page.explanations([*searched, *both])
        if wanting():
            offered += page.explanations(programs.causes(page.evidence, page.base))
    return _chosen(offered, len(page.base))


@np.errstate(all="ignore")
def explain_copy(
    found: Judged, put_right: Callable[[Judged, Mapping[str, str]], Judged | None]
) -> list[Explanation]:
    """The same of a page held against a copy of the listing: slips, those nearest to its results
    first. ``put_right``: the printout judged by the copy with other inputs printed."""
    page = _Page(found)
    causes = list(page.without_replay())
    if not found.recovered.missing:
        tried: list[tuple[Change, ...]] = [(one,) for one in page.nearest_slips()[:_BY_COPY]]
        tried += [one.changes for one in Rereading(found.recovered).best()[:_BY_COPY]]
        for changes in filter(None, dict.fromkeys(tried)):
            other = put_right(found, {change.field: change.would_be for change in changes})
            if other is not None:
                outcome = other.recovered.outcome.fields
                causes.append(page.slipped(changes, _differing(other), outcome))
    return _chosen(page.explanations(causes), len(page.base))


class _Page:
    """What all explanations are measured against: the page, and the names that differ on it."""

    def __init__(self, found: Judged) -> None:
        self.found, self.shown, self.recovered = found, found.shown, found.recovered
        self.checks = {check.name: check for check in found.fields}
        self.checks |= {f"reply {check.name}": check for check in found.replies}
        self.base = _differing(found)

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
            and in_last_places(name, self.checks[name].printed, self.checks[name].recomputed)
            for name in self.base
        )

    # --- causes ---

    def without_replay(self) -> Iterator[Cause]:
        """Results and replies that are one slip away from what they should be; labels that stand in
        each other's place, or name another number, where the number is what the program prints."""
        if changes := self._slips(self.base, self.recovered.outcome.fields):
            yield self.slipped(changes, self.base)
        wrong = [
            one
            for one in self.shown.mislabelled
            if one.name in self.checks and self.checks[one.name].status == Status.READ
        ]
        if wrong:
            exchanged = sorted(one.read for one in wrong) == sorted(one.printed for one in wrong)
            kind = LABELS_EXCHANGED if exchanged else LABEL_WRONG
            changes = tuple(Change(kind, one.name, one.read, one.printed) for one in wrong)
            left = self.base - {f"label {one.name}" for one in wrong}
            note = "the numbers are what the program prints there"
            yield Cause(kind, note, _LABEL, None, left, changes)

    def last_places_alone(self) -> Iterator[Cause]:
        """An arithmetic that is none of those tried: results off by one in their last places."""
        if self.last_places and len(self.base) > 1 and not self.evidence.longer:
            note = f"all that differs is off by one in its last place; {NOT_APPLESOFT}"
            yield Cause("another arithmetic", note, _ANOTHER_ARITHMETIC, None, frozenset())

    def rereads(self, reread: Iterable[Reread]) -> Iterator[Cause]:
        """Inputs put right, with what results are then still a slip away."""
        for one in reread:
            if one.changes:
                outcome = one.scored.outcome.fields
                yield self.slipped(one.changes, self._wrong(one, one.changes), outcome)

    def nearest_slips(self) -> list[Change]:
        """The single slips of printed inputs, those first whose results are nearest to the page's
        by double precision; that differs from what the program prints as in the scene recovered."""
        scene, assumed = self.recovered.scene, self.recovered.assumed
        tried = [
            Change(kind, name, text, other)
            for name, text in assumed.items()
            for other, kind in slips.misreadings(text).items()
            if printable(other) and kind != slips.TWO_DIGITS
        ]
        columns = {name: np.full(len(tried) + 1, double(text)) for name, text in scene.items()}
        for row, one in enumerate(tried, 1):
            turned = one.field == "MUP" and mu_turned(scene["MU"], one.printed)
            columns[scene_name(one.field)][row] = double(one.would_be) * (-1 if turned else 1)
        fields = self.recovered.outcome.fields
        found = {
            name: column - column[0] + double(fields[name])
            for name, column in in_doubles(columns, self.evidence.named(fields)).items()
        }
        order = np.argsort(self.evidence.far(found, len(tried) + 1)[1:], kind="stable")
        return [tried[index] for index in order]

    def exchanged_and_slipped(self, exchanges: Iterable[hypotheses.Hypothesis]) -> Iterator[Cause]:
        """Inputs of a side or an axis exchanged, and a slip in another."""
        rereading = Rereading(self.recovered, apart=True)
        for exchange in exchanges:
            texts = {one.field: exchange.assumed[one.field] for one in exchange.changes}
            for one in rereading.best(texts):
                changes = (*exchange.changes, *one.changes)
                bits = exchange.row.bits + sum(map(_believed, one.changes)) + _EACH
                cause = self.slipped(changes, self._wrong(one, changes))
                yield cause._replace(bits=bits, note=exchange.row.note)

    def _wrong(self, one: Reread, changes: Sequence[Change]) -> frozenset[str]:
        """What differs from the page of a scene put right; a number that contradicted the same
        text before still does."""
        now, before = one.scored.outcome.fields, self.recovered.outcome.fields
        still = {n for n in self.base if n not in INPUTS and n in now and now[n] == before.get(n)}
        return self._left(one.scored.wrong | still, one.scored.scene, changes)

    def _left(
        self, wrong: frozenset[str], scene: Mapping[str, str], changes: Iterable[Change]
    ) -> frozenset[str]:
        """What a scene leaves unexplained: ``wrong``, replies that are not its values, and printed
        inputs that differ and that no change puts right."""
        replies = {
            f"reply {check.name}"
            for check in self.found.replies
            if check.printed is not None
            and check.status in (Status.READ, Status.CONTRADICTED)
            and not same_value(check.printed, scene.get(check.name, ""))
        }
        inputs = self.base & frozenset(INPUTS) - {"MUP"} - {change.field for change in changes}
        return wrong | replies | inputs

    def _slips(self, names: Iterable[str], fields: Mapping[str, str]) -> tuple[Change, ...]:
        """The single slips of printed numbers and replies that make them what they should be."""
        found = []
        for name in sorted(names):
            check = self.checks.get(name)
            reply = name.startswith("reply ")
            should = self.recovered.scene.get(name[6:]) if reply else fields.get(name)
            if check is None or check.printed is None or should is None:
                continue
            if kind := slips.slip(check.printed, should):
                found.append(Change(kind, name, check.printed, should))
        return tuple(found)

    def slipped(
        self,
        changes: tuple[Change, ...],
        wrong: frozenset[str],
        outcome: Mapping[str, str] | None = None,
    ) -> Cause:
        """Slips as a cause; ``outcome``: what is then printed, of which a few may be slips too."""
        if outcome and len(wrong & self.base) <= _SLIPS_IN_RESULTS:
            changes = (*changes, *self._slips(wrong & self.base, outcome))
        bits = sum(map(_believed, changes)) + _EACH * (len(changes) - 1)
        if all(change.field in INPUTS for change in changes) and self.last_places:
            bits += _LAST_PLACE
        note = ""
        if changes[0].field.startswith("reply "):
            note = "in the typed reply"
        elif any(one.field in self.recovered.apart for one in changes):
            note = "in the inputs given separately"
        kind = " and ".join(dict.fromkeys(change.kind for change in changes))
        return Cause(kind, note, bits, None, wrong - {one.field for one in changes}, changes)

    # --- as explanations ---

    def explanations(self, causes: Iterable[Cause]) -> list[Explanation]:
        """Causes with what they leave unexplained of this page."""
        every = []
        for one in causes:
            left = one.wrong
            if one.scene is not None:
                left = self._left(left, one.scene, one.changes)
            bits = one.bits + _LEFT * len(left)
            made = list(map(self._described, one.changes))
            look = [change["look"] for change in made if change["look"]]
            explains = len(self.base - left)
            every.append(Explanation(one.kind, one.note, bits, explains, left, made, look))
        return every

    def _described(self, change: Change) -> dict[str, Any]:
        """A number put right, where it stands, and what to ask of the paper there."""
        kind, name, printed, would_be = change
        reply = name.startswith("reply ")
        name = name.removeprefix("reply ")
        reading = (self.shown.replies if reply else self.shown.fields).get(name)
        label = kind in (LABELS_EXCHANGED, LABEL_WRONG)
        one = next((one for one in self.shown.labels if label and one.name == name), reading)
        line, column = (one.line, one.column) if one else (None, None)
        look = ""
        if one and (label or kind in slips.BITS):
            at, asked = (line, column), f"{printed} or {would_be}"
            if kind == slips.DIGIT and reading is not None:
                pairs = enumerate(zip(printed, would_be, strict=True))
                index, (read, true) = next(pair for pair in pairs if pair[1][0] != pair[1][1])
                asked = f"{read} {'an' if true == '8' else 'a'} {true}"
                if index < len(reading.region):
                    at = self.shown.place(reading.region[index].offset)
            look = f"line {at[0]}, column {at[1]}: is this {asked}?"
        return {
            "kind": kind, "field": name, "printed": printed, "would_be": would_be,
            "line": line, "column": column, "look": look,
        }  # fmt: skip


def _differing(found: Judged) -> frozenset[str]:
    """The names of what differs; replies and labels are marked as such."""
    replies = set(map(id, found.replies))
    return frozenset(
        [f"{'reply ' * (id(one) in replies)}{one.name}" for one in found.contradicted]
        + [f"label {one.name}" for one in found.shown.mislabelled]
    )


def _believed(change: Change) -> float:
    bits = change.bits
    if change.field not in INPUTS:
        bits += _LAST_PLACE * in_last_places(change.field, change.printed, change.would_be)
    return bits


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
    fields, others = ({name for name, _ in each.puts_right} for each in (one, other))
    if one.kind == other.kind and fields == others:
        return one.remaining > other.remaining or one.puts_right == other.puts_right
    return other.puts_right < one.puts_right
