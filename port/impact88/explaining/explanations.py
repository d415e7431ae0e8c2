"""Explaining a printout that differs: causes, each tested by replay, the likeliest first.

A cause is an edit: of what is printed (slips, labels), of the inputs or results as a whole (the
rows of ``hypotheses.txt``), of the machine or its printing, or of one line of the listing. Each
asks for some bits to be believed, and for as many more as every number that it leaves unexplained
would take as a slip of its own; the fewest bits come first. A cause is offered only when it
explains nearly all that differs. Causes that ask for about as much and leave the same unexplained
share a rank: the page cannot tell them apart.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..doubles import double
from ..fields import FIELDS, INPUTS, scene_name
from ..judging.judgement import Judged
from ..recovery import slips
from ..recovery.search import in_doubles
from ..recovery.slips import Change, Reread, Rereading
from ..recovery.typedtext import mu_turned
from . import machines
from .causes import (
    LABEL_WRONG,
    LABELS_EXCHANGED,
    NOT_APPLESOFT,
    Cause,
    PageEvidence,
    differing,
    in_last_places,
)
from .hypotheses import Rows, other_programs

MOST = 6
"""Explanations given at most."""
_LABEL = 10.0
"""Bits of wrong labels on numbers that are what the program prints: as a digit misread."""
_LEFT = 14.0
"""Bits of a number that a cause leaves unexplained: more than of a slip besides (10 to 13.5), so
that a cause with the slip comes before the one without."""
_ALIKE = 8.0
"""Causes that leave the same unexplained and ask for no more bits than these more share a rank."""
_WORSE = 15.0
"""What asks for so many bits more than the best is no cause."""
_ENOUGH = 26.0
"""Causes that take longer are tried where none asks for so few bits: two slips (21 to 25)."""
_MOST_BITS = 50.0
"""What asks for more is no explanation: four slips of the likelier kinds. Twice as much names slips
on a page that nothing explains."""
_BY_COPY = 12
"""Slips, of each kind of ranking, that are tried in a copy of the listing."""
_LAST_PLACE = 8.0
"""Bits more for a result misread by one in its last place, where another arithmetic is likelier;
and for misread inputs on a page on which nothing worse is wrong."""
_SLIP = min(slips.BITS.values())
"""Bits of a slip besides, at least."""
_ANOTHER_ARITHMETIC = 17.0
"""Bits of an arithmetic that is not among those tried: less than two last places misread (37)."""


@np.errstate(all="ignore")  # a cause tried may leave a double's range, and then explains nothing
def explain(found: Judged, rereading: Rereading, in_time: Callable[[], bool]) -> list[Cause]:
    """Causes that make more of a differing printout agree, those that ask least first.
    ``rereading``: slips in its inputs; ``in_time``: whether more causes may still be tried."""
    page = PageEvidence(found)
    causes = [*_slipped(page, (), page.base, found.recovered.outcome.fields), *_labels(page)]
    if not found.recovered.missing and any(not one.startswith("label ") for one in page.base):
        rows = Rows(page)
        causes += [*_reread(page, rereading.best(1)), *rows.causes(), *machines.causes(page)]
        for more in (
            lambda: _reread(page, rereading.best()),
            lambda: (*rows.searched(), *_exchanged_and_slipped(page, rows, rereading)),
            lambda: other_programs(page),
        ):
            whole = [one.bits for one in causes if not one.left]
            if in_time() and min(whole, default=math.inf) > _ENOUGH:
                causes += more()
        longer = any(page.decimals(name) > (FIELDS[name].places or 9) for name in page.texts)
        accused = any(_accuses(one) and not one.left for one in causes)
        if page.only_last_places and len(page.base) > 1 and not longer and not accused:
            note = f"all that differs is off by one in its last place; {NOT_APPLESOFT}"
            causes.append(Cause("another arithmetic", note, _ANOTHER_ARITHMETIC, frozenset()))
    return _ranked(page, causes)


@np.errstate(all="ignore")
def explain_copy(
    found: Judged, put_right: Callable[[Judged, Mapping[str, str]], Judged | None]
) -> list[Cause]:
    """The same of a page held against a copy of the listing: slips, those nearest to its results
    first. ``put_right``: the printout judged by the copy with other inputs printed."""
    page = PageEvidence(found)
    causes = [*_slipped(page, (), page.base, found.recovered.outcome.fields), *_labels(page)]
    if not found.recovered.missing:
        rereading = Rereading(found.recovered)
        tried = [one.changes for one in rereading.best()[:_BY_COPY]]
        nearest = _nearest_slips(page, rereading)[:_BY_COPY]
        for changes in filter(None, dict.fromkeys([*nearest, *tried])):
            other = put_right(found, {change.field: change.would_be for change in changes})
            if other is not None:
                causes += _slipped(page, changes, differing(other), other.recovered.outcome.fields)
    return _ranked(page, causes)


# --- slips and labels ---


def _labels(page: PageEvidence) -> Iterator[Cause]:
    """Labels that stand in each other's place, or name another number, where the number is what
    the program prints."""
    wrong = [
        one
        for one in page.shown.mislabelled
        if one.name in page.checks and page.checks[one.name].same
    ]
    if wrong:
        exchanged = sorted(one.read for one in wrong) == sorted(one.printed for one in wrong)
        kind = LABELS_EXCHANGED if exchanged else LABEL_WRONG
        changes = tuple(Change(kind, one.name, one.read, one.printed) for one in wrong)
        left = page.base - {f"label {one.name}" for one in wrong}
        yield Cause(kind, "the numbers are what the program prints there", _LABEL, left, changes)


def _reread(page: PageEvidence, rereads: Iterable[Reread]) -> Iterator[Cause]:
    """Inputs put right, with what results are then still a slip away."""
    best = math.inf
    for one in rereads:
        wrong = page.left(one.scored.scene, one.scored.outcome, one.changes)
        least = sum(map(_believed, one.changes)) + _SLIP * (len(wrong) - page.most_left)
        if one.changes and least <= min(best + _WORSE, _MOST_BITS):
            for cause in _slipped(page, one.changes, wrong, one.scored.outcome.fields):
                best = min(best, _weight(cause))
                yield cause


def _exchanged_and_slipped(page: PageEvidence, rows: Rows, rereading: Rereading) -> Iterator[Cause]:
    """Inputs of a side or an axis exchanged, and a slip in another."""
    for row, exchanged in rows.exchanges():
        texts = {change.field: change.would_be for change in exchanged}
        for one in rereading.best(1, texts):
            changes = (*exchanged, *one.changes)
            bits = row.bits + sum(map(_believed, one.changes))
            left = page.left(one.scored.scene, one.scored.outcome, changes)
            for cause in _slipped(page, changes, left):
                yield replace(cause, bits=bits, note=row.note)


def _nearest_slips(page: PageEvidence, rereading: Rereading) -> list[tuple[Change, ...]]:
    """The single slips of printed inputs, those first whose results are nearest to the page's by
    double precision; that differs from what the program prints as in the scene recovered."""
    scene, fields = page.recovered.scene, page.recovered.outcome.fields
    tried = [one for one in rereading.single() if one.kind != slips.TWO_DIGITS]
    columns = {name: np.full(len(tried) + 1, double(text)) for name, text in scene.items()}
    for row, one in enumerate(tried, 1):
        turned = one.field == "MUP" and mu_turned(scene["MU"], one.printed)
        columns[scene_name(one.field)][row] = double(one.would_be) * (-1 if turned else 1)
    found = {
        name: column - column[0] + double(fields[name])
        for name, column in in_doubles(columns, [n for n in page.results if n in fields]).items()
    }
    order = np.argsort(page.far(found, len(tried) + 1)[1:], kind="stable")
    return [(tried[index],) for index in order]


def _slipped(
    page: PageEvidence,
    changes: tuple[Change, ...],
    left: frozenset[str],
    outcome: Mapping[str, str] | None = None,
) -> Iterator[Cause]:
    """Slips as a cause; ``outcome``: what is then printed: numbers and replies may be one slip away
    from it, too."""
    if outcome and len(left - page.base) <= page.most_left:
        for name in sorted(left & page.checks.keys() & page.base):
            printed = page.checks[name].printed or ""
            known = page.recovered.scene if name.startswith("reply ") else outcome
            should = known.get(name.removeprefix("reply "), "")
            if printed and should and (kind := slips.slip(printed, should)):
                changes = (*changes, Change(kind, name, printed, should))
    if not changes:
        return
    bits = sum(map(_believed, changes))
    if all(change.field in INPUTS for change in changes) and page.only_last_places:
        bits += _LAST_PLACE
    note = ""
    if changes[0].field.startswith("reply "):
        note = "in the typed reply"
    elif any(one.field in page.recovered.apart for one in changes):
        note = "in the inputs given separately"
    kind = " and ".join(dict.fromkeys(change.kind for change in changes))
    yield Cause(kind, note, bits, left - {one.field for one in changes}, changes)


def _believed(change: Change) -> float:
    last = change.field not in INPUTS and in_last_places(*change[1:])
    return change.bits + _LAST_PLACE * last


# --- which are offered, and in what order ---


def _ranked(page: PageEvidence, causes: Iterable[Cause]) -> list[Cause]:
    """Those that explain nearly all, the least to believe first, with ranks; none that only adds
    to a simpler one, or says it again."""
    offered = [
        one
        for one in causes
        if len(one.left) <= page.most_left and page.base - one.left and _weight(one) <= _MOST_BITS
    ]
    offered.sort(key=_weight)
    chosen: list[Cause] = []
    for one in offered:
        near = _weight(one) <= _weight(offered[0]) + _WORSE
        if near and not any(_adds_to(one, other) for other in chosen):
            chosen.append(one)
    # a misreading that would do is not left out where another machine is named
    innocent = next((one for one in chosen if not _accuses(one)), None)
    if innocent in chosen[MOST:]:
        chosen[MOST - 1] = innocent
    leaders: list[Cause] = []
    ranked = []
    for one in chosen[:MOST]:
        # that another program or machine made the page is said beside no misreading that explains
        # it better
        alike = (
            rank
            for rank, other in enumerate(leaders, 1)
            if one.left == other.left
            and _weight(one) <= _weight(other) + _ALIKE
            and (_accuses(other) or not _accuses(one))
        )
        rank = next(alike, len(leaders) + 1)
        leaders += [one] * (rank > len(leaders))
        changes = [_described(page, change) for change in one.right]
        found = len(page.base - one.left), len(page.base), changes, rank
        ranked.append(Cause(one.kind, one.note, one.bits, one.left, one.right, *found))
    return sorted(ranked, key=lambda one: (one.rank, _weight(one)))


def _weight(one: Cause) -> float:
    return one.bits + _LEFT * len(one.left)


def _accuses(one: Cause) -> bool:
    return one.note.endswith(NOT_APPLESOFT)


def _adds_to(one: Cause, other: Cause) -> bool:
    """Whether a cause puts right what a likelier one does and more, or the same numbers in the
    same way, or says the same."""
    if not other.right:
        return not one.right and (one.kind, one.note) == (other.kind, other.note)
    rights, others = ({(c.field, c.would_be) for c in each.right} for each in (one, other))
    if one.kind == other.kind and dict(rights).keys() == dict(others).keys():
        return len(one.left) > len(other.left) or rights == others
    return others < rights


def _described(page: PageEvidence, change: Change) -> dict[str, Any]:
    """A number put right, where it stands, and what to ask of the paper there."""
    kind, name, printed, would_be = change
    readings = page.shown.replies if name.startswith("reply ") else page.shown.fields
    name = name.removeprefix("reply ")
    reading = readings.get(name)
    label = kind in (LABELS_EXCHANGED, LABEL_WRONG)
    one = next((one for one in page.shown.labels if label and one.name == name), reading)
    line, column = (one.line, one.column) if one else (None, None)
    look = ""
    if one and (label or kind in slips.BITS):
        at, asked = (line, column), f"{printed} or {would_be}"
        if kind == slips.DIGIT and reading is not None:
            index = next(at for at in range(len(printed)) if printed[at] != would_be[at])
            asked = f"{printed[index]} {'an' if would_be[index] == '8' else 'a'} {would_be[index]}"
            if index < len(reading.region):
                at = page.shown.page.place(reading.region[index].offset)
        look = f"line {at[0]}, column {at[1]}: is this {asked}?"
    return {
        "kind": kind, "field": name, "printed": printed, "would_be": would_be,
        "line": line, "column": column, "look": look,
    }  # fmt: skip
