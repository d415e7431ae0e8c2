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
from operator import attrgetter
from typing import Any

import numpy as np

from ...collision.doubles import double
from ...collision.fields import FIELDS, INPUTS, scene_name
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
_LEFT = 14.0
"""Bits of a number that a cause leaves unexplained: more than of a slip besides (10 to 13.5), so
that a cause with the slip comes before the one without. Doubled, one page lists fewer."""
_ALIKE = 8.0
"""Causes that leave the same unexplained and ask for no more bits than these more share a rank; of
two pages the first rank grows when it is doubled."""
_WORSE = 15.0
"""What asks for so many bits more than the best is no cause; doubled, three pages list more."""
_ENOUGH = 26.0
"""Causes that take longer are tried where none asks for so few bits: two slips (21 to 25). Doubled,
none changes; halved, five do."""
_MOST_BITS = 50.0
"""What asks for more is no explanation: four slips of the likelier kinds. Twice as much names slips
on a page that nothing explains."""
_BY_COPY = 12
"""Slips, of each kind of ranking, that are tried in a copy of the listing."""
_LAST_PLACE = 8.0
"""Bits more for a result misread by one in its last place, where another arithmetic is likelier;
and for misread inputs on a page on which nothing worse is wrong. Doubled, one page has another
first."""
_SLIP = min(slips.BITS.values())
"""Bits of a slip besides, at least."""


@np.errstate(all="ignore")  # a cause tried may leave a double's range, and then explains nothing
def explain(found: Judged, rereading: Rereading, in_time: Callable[[], bool]) -> list[Cause]:
    """Causes that make more of a differing printout agree, those that ask least first.
    ``rereading``: slips in its inputs; ``in_time``: whether more causes may still be tried."""
    page = PageEvidence(found)
    causes = [*_slipped(page, (), page.base, found.recovered.outcome.fields), *_labels(page)]
    if not found.recovered.missing and any(not name.startswith("label ") for name in page.base):
        rows = Rows(page)
        causes += [
            *_reread(page, rereading.best(single=True)),
            *rows.causes(),
            *machines.causes(page),
        ]
        for more in (
            lambda: _reread(page, rereading.best()),
            lambda: (*rows.searched(), *_exchanged_and_slipped(page, rows, rereading)),
            lambda: other_programs(page),
        ):
            costs = [cause.bits for cause in causes if not cause.left]
            if in_time() and min(costs, default=math.inf) > _ENOUGH:
                causes += more()
        longer = any(page.decimals(name) > (FIELDS[name].places or 9) for name in page.texts)
        accused = any(_accuses(cause) and not cause.left for cause in causes)
        if page.only_last_places and len(page.base) > 1 and not longer and not accused:
            bits = slips.BITS[slips.DIGIT] + _LAST_PLACE  # as one of them misread
            note = f"all that differs is off by one in its last place; {NOT_APPLESOFT}"
            causes.append(Cause("another arithmetic", note, bits, frozenset()))
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
        tried = [reread.changes for reread in rereading.best()[:_BY_COPY]]
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
        label
        for label in page.paper.mislabelled
        if label.name in page.checks and page.checks[label.name].same
    ]
    if wrong:
        read, printed = (sorted(map(attrgetter(name), wrong)) for name in ("read", "printed"))
        kind = LABELS_EXCHANGED if read == printed else LABEL_WRONG
        changes = tuple(Change(kind, label.name, label.read, label.printed) for label in wrong)
        left = page.base - {f"label {label.name}" for label in wrong}
        note, bits = "the numbers are what the program prints there", slips.BITS[slips.DIGIT]
        yield Cause(kind, note, bits, left, changes)


def _reread(page: PageEvidence, rereads: Iterable[Reread]) -> Iterator[Cause]:
    """Inputs put right, with what results are then still a slip away."""
    best = math.inf
    for changes, run in rereads:
        least = sum(map(_believed, changes)) + _SLIP * (len(run.wrong) - page.most_left)
        if changes and least <= min(best + _WORSE, _MOST_BITS):
            left = page.left(run.scene, run.outcome, changes) | run.wrong & set(INPUTS)
            for cause in _slipped(page, changes, left, run.outcome.fields):
                best = min(best, _weight(cause))
                yield cause


def _exchanged_and_slipped(page: PageEvidence, rows: Rows, rereading: Rereading) -> Iterator[Cause]:
    """Inputs of a side or an axis exchanged, and a slip in another."""
    for row, exchanged in rows.exchanges():
        texts = {change.field: change.would_be for change in exchanged}
        for reread in rereading.best(single=True, exchanged=texts):
            changes = (*exchanged, *reread.changes)
            bits = row.bits + sum(map(_believed, reread.changes))
            run = reread.scored
            left = page.left(run.scene, run.outcome, changes) | run.wrong & set(INPUTS)
            for cause in _slipped(page, changes, left):
                yield replace(cause, bits=bits, note=row.note)


def _nearest_slips(page: PageEvidence, rereading: Rereading) -> list[tuple[Change, ...]]:
    """The single slips of printed inputs, those first whose results are nearest to the page's by
    double precision; that differs from what the program prints as in the scene recovered."""
    scene, fields = page.recovered.scene, page.recovered.outcome.fields
    tried = [change for change in rereading.single() if change.kind != slips.TWO_DIGITS]
    columns = {name: np.full(len(tried) + 1, double(text)) for name, text in scene.items()}
    for row, change in enumerate(tried, 1):
        turned = change.field == "MUP" and mu_turned(scene["MU"], change.printed)
        columns[scene_name(change.field)][row] = double(change.would_be) * (-1 if turned else 1)
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
    elif any(change.field in page.recovered.apart for change in changes):
        note = "in the inputs given separately"
    kind = " and ".join(dict.fromkeys(change.kind for change in changes))
    yield Cause(kind, note, bits, left - {change.field for change in changes}, changes)


def _believed(change: Change) -> float:
    last = change.field not in INPUTS and in_last_places(*change[1:])
    return change.bits + _LAST_PLACE * last


# --- which are offered, and in what order ---


def _ranked(page: PageEvidence, causes: Iterable[Cause]) -> list[Cause]:
    """Those that explain nearly all, the least to believe first, with ranks; none that only adds
    to a simpler one, or says it again."""
    nearly = [c for c in causes if len(c.left) <= page.most_left and page.base - c.left]
    offered = sorted((c for c in nearly if _weight(c) <= _MOST_BITS), key=_weight)
    chosen: list[Cause] = []
    for cause in offered:
        near = _weight(cause) <= _weight(offered[0]) + _WORSE
        if near and not any(_adds_to(cause, other) for other in chosen):
            chosen.append(cause)
    # a misreading that would do is not left out where another machine is named
    innocent = next((cause for cause in chosen if not _accuses(cause)), None)
    if innocent in chosen[MOST:]:
        chosen[MOST - 1] = innocent
    leaders: list[Cause] = []
    ranked = []
    for cause in chosen[:MOST]:
        # that another program or machine made the page is said beside no misreading that explains
        # it better
        alike = (
            rank
            for rank, other in enumerate(leaders, 1)
            if cause.left == other.left
            and _weight(cause) <= _weight(other) + _ALIKE
            and (_accuses(other) or not _accuses(cause))
        )
        rank = next(alike, len(leaders) + 1)
        leaders += [cause] * (rank > len(leaders))
        changes = [_described(page, change) for change in cause.right]
        found = len(page.base - cause.left), len(page.base), changes, rank
        ranked.append(Cause(cause.kind, cause.note, cause.bits, cause.left, cause.right, *found))
    return sorted(ranked, key=lambda cause: (cause.rank, _weight(cause)))


def _weight(cause: Cause) -> float:
    return cause.bits + _LEFT * len(cause.left)


def _accuses(cause: Cause) -> bool:
    return cause.note.endswith(NOT_APPLESOFT)


def _adds_to(cause: Cause, other: Cause) -> bool:
    """Whether a cause puts right what a likelier one does and more, or the same numbers in the
    same way, or says the same."""
    if not other.right:
        return not cause.right and (cause.kind, cause.note) == (other.kind, other.note)
    rights, others = ({(c.field, c.would_be) for c in each.right} for each in (cause, other))
    if cause.kind == other.kind and dict(rights).keys() == dict(others).keys():
        return len(cause.left) > len(other.left) or rights == others
    return others < rights


def _described(page: PageEvidence, change: Change) -> dict[str, Any]:
    """A number put right, where it stands, and what to ask of the paper there."""
    kind, name, printed, would_be = change
    readings = page.paper.replies if name.startswith("reply ") else page.paper.fields
    name = name.removeprefix("reply ")
    reading = readings.get(name)
    label = kind in (LABELS_EXCHANGED, LABEL_WRONG)
    place = next((check for check in page.paper.labels if label and check.name == name), reading)
    line, column = (place.line, place.column) if place else (None, None)
    look = ""
    if place and (label or kind in slips.BITS):
        at, asked = (line, column), f"{printed} or {would_be}"
        if kind == slips.DIGIT and reading is not None:
            index = next(at for at in range(len(printed)) if printed[at] != would_be[at])
            asked = f"{printed[index]} {'an' if would_be[index] == '8' else 'a'} {would_be[index]}"
            if index < len(reading.region):
                at = page.paper.page.place(reading.region[index].offset)
        look = f"line {at[0]}, column {at[1]}: is this {asked}?"
    return {
        "kind": kind, "field": name, "printed": printed, "would_be": would_be,
        "line": line, "column": column, "look": look,
    }  # fmt: skip
