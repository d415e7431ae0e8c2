"""Explanations of a printout that differs: causes, each tested by replay, the likeliest first.

A cause is an edit: of what is printed (slips, labels), of the inputs or results as a whole (the
rows of ``hypotheses.txt``), of the machine or its printing, or of one line of the listing. Each has
an improbability in bits, plus the bits of a slip for every number that it leaves unexplained; the
fewest bits come first. A cause is offered only when it
explains nearly all that differs. Causes of about equal bits that leave the same unexplained
share a rank: the page cannot tell them apart.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from operator import attrgetter
from typing import Any

import numpy as np

from ...collision.doubles import double, opposite
from ...collision.fields import ANGLES, FIELDS, INPUTS, scene_name
from ..judging.judgement import Judged
from ..reading.differences import Kind, differences_along
from ..reading.numerals import compare
from ..recovery import slips
from ..recovery.replays import run_all
from ..recovery.rereading import Reread, Rereading
from ..recovery.search import printed_in_doubles
from ..recovery.slips import Change
from ..recovery.typedtext import longer_texts, mu_turned
from . import machines
from .causes import (
    LABEL_WRONG,
    LABELS_EXCHANGED,
    NOT_APPLESOFT,
    ROWS,
    Cause,
    PageEvidence,
    differing,
    in_last_places,
)
from .hypotheses import Rows, other_programs

MAX_EXPLANATIONS = 6
UNEXPLAINED_BITS = 14.0
"""Bits of a number that a cause leaves unexplained: more than an additional slip (10 to 13.5), so
that a cause with the slip comes before the one without. Doubled, one page lists fewer."""
SAME_RANK_BITS = 8.0
"""Difference in bits up to which causes that leave the same unexplained share a rank; doubled, the
first rank of two pages grows."""
MAX_EXCESS_BITS = 15.0
"""Bits above the best cause beyond which none is listed; doubled, three pages list more."""
GOOD_BITS = 26.0
"""Slower causes are tried only if none has fewer bits: two slips have 21 to 25. Doubled, no page
changes; halved, five do."""
MAX_BITS = 50.0
"""Bits beyond which a cause is no explanation: four slips of the likelier kinds. Twice as many name
slips on a page that nothing explains."""
MAX_SLIPS_BY_COPY = 12  # slips of each ranking that are tried in a copy of the listing
LAST_PLACE_BITS = 8.0
"""Bits added for a result misread by one in its last place, where another arithmetic is likelier;
and for misread inputs on a page with no larger difference. Doubled, one page has another first."""
MIN_SLIP_BITS = min(slips.BITS.values())
MORE_DIGITS = "typed with more digits than are printed"
MORE_DIGITS_BITS = 12.0
"""Bits of an input typed with more digits than are printed: as rare as a digit lost."""


@np.errstate(all="ignore")  # a cause tried may leave a double's range, and then explains nothing
def explain(found: Judged, rereading: Rereading) -> list[Cause]:
    """Return causes that make more of a differing printout agree, fewest bits first.

    ``rereading`` searches for slips in its inputs. Slower causes are tried only where no quicker
    one is likely; the slowest of 1,558 pages takes 1.6 s in all.
    """
    page = PageEvidence(found)
    causes = [*_slip_causes(page, (), page.base, found.recovered.outcome.fields), *_labels(page)]
    causes += _rows(page)
    of_form = {ROWS, *(name for name in page.base if name.startswith("label "))}
    if not found.recovered.missing and page.base - of_form:
        rows = Rows(page)
        causes += [
            *_input_slips(page, rereading.best),
            *_longer_inputs(page),
            *rows.causes(),
            *machines.causes(page),
        ]
        for try_more in (
            lambda: (*rows.unit_causes(), *_exchanges_with_slips(page, rows, rereading)),
            lambda: other_programs(page),
        ):
            costs = [cause.bits for cause in causes if not cause.left]
            if min(costs, default=math.inf) > GOOD_BITS:
                causes += try_more()
        longer = any(page.decimals(name) > (FIELDS[name].places or 9) for name in page.texts)
        machine_accused = any(_accuses(cause) and not cause.left for cause in causes)
        if page.only_last_places and len(page.base) > 1 and not longer and not machine_accused:
            bits = slips.BITS[slips.DIGIT] + LAST_PLACE_BITS  # as one of them misread
            note = f"all that differs is off by one in its last place; {NOT_APPLESOFT}"
            causes.append(Cause("another arithmetic", note, bits, frozenset()))
    return _rank_causes(page, causes)


@np.errstate(all="ignore")
def explain_copy(
    found: Judged, rejudge: Callable[[Judged, Mapping[str, str]], Judged | None]
) -> list[Cause]:
    """Return the slips that explain a page compared with a copy of the listing.

    Slips whose results are nearest to the page's are tried first. ``rejudge`` judges the printout
    by the copy with corrected inputs (texts by field).
    """
    page = PageEvidence(found)
    causes = [*_slip_causes(page, (), page.base, found.recovered.outcome.fields), *_labels(page)]
    if not found.recovered.missing:
        rereading = Rereading(found.recovered)
        reread_changes = [reread.changes for reread in rereading.best[:MAX_SLIPS_BY_COPY]]
        nearest = _nearest_slips(page, rereading)[:MAX_SLIPS_BY_COPY]
        for changes in filter(None, dict.fromkeys([*nearest, *reread_changes])):
            judgement = rejudge(found, {change.field: change.would_be for change in changes})
            if judgement is not None:
                causes += _slip_causes(
                    page, changes, differing(judgement), judgement.recovered.outcome.fields
                )
    return _rank_causes(page, causes)


# --- slips and labels ---


def _labels(page: PageEvidence) -> Iterator[Cause]:
    """Yield a cause of labels that are exchanged or wrong, where the numbers are the program's."""
    wrong = [
        label
        for label in page.paper.mislabelled
        if label.name in page.checks and page.checks[label.name].same
    ]
    if wrong:
        read, printed_labels = (
            sorted(map(attrgetter(name), wrong)) for name in ("read", "printed")
        )
        kind = LABELS_EXCHANGED if read == printed_labels else LABEL_WRONG
        changes = tuple(Change(kind, label.name, label.read, label.printed) for label in wrong)
        unexplained = page.base - {f"label {label.name}" for label in wrong}
        note, bits = "the numbers are what the program prints there", slips.BITS[slips.DIGIT]
        yield Cause(kind, note, bits, unexplained, changes)


def _rows(page: PageEvidence) -> Iterator[Cause]:
    """Yield a cause of rows that are out of the program's order or printed twice."""
    if ROWS in page.base:
        kind = "rows exchanged" if page.paper.out_of_order else "row printed twice"
        note = "; ".join([*page.paper.exchanged, *page.paper.contradicting])
        yield Cause(kind, note, slips.BITS[slips.SWAP], page.base - {ROWS})


def _input_slips(page: PageEvidence, rereads: Iterable[Reread]) -> Iterator[Cause]:
    """Yield corrected inputs as causes, with the results that are then a slip away."""
    best = math.inf
    for changes, run in rereads:
        least = sum(map(_bits_of, changes)) + MIN_SLIP_BITS * (len(run.wrong) - page.max_left)
        if changes and least <= min(best + MAX_EXCESS_BITS, MAX_BITS):
            unexplained = page.left(run.scene, run.outcome, changes) | run.wrong & set(INPUTS)
            for cause in _slip_causes(page, changes, unexplained, run.outcome.fields):
                best = min(best, _total_bits(cause))
                yield cause


def _longer_inputs(page: PageEvidence) -> Iterator[Cause]:
    """Yield inputs typed with digits that are not printed, and that enter the sums."""
    scene = page.recovered.scene
    trials: list[tuple[Change, dict[str, str]]] = []
    for name, printed in page.recovered.assumed.items():
        is_turned = name == "MUP" and mu_turned(scene["MU"], printed)
        for text in longer_texts(printed, name in ANGLES):
            typed = opposite(text) if is_turned else text
            change = Change(MORE_DIGITS, name, printed, text)
            trials.append((change, {**scene, scene_name(name): typed}))
    outcomes = run_all([trial for _, trial in trials])
    best: dict[str, Cause] = {}
    for (change, trial), outcome in zip(trials, outcomes, strict=True):
        unexplained = page.left(trial, outcome)
        known = best.get(change.field)
        if unexplained < page.base and (known is None or len(unexplained) < len(known.left)):
            cause = Cause(MORE_DIGITS, "", MORE_DIGITS_BITS, unexplained, (change,))
            best[change.field] = cause
    yield from best.values()


def _exchanges_with_slips(page: PageEvidence, rows: Rows, rereading: Rereading) -> Iterator[Cause]:
    """Yield causes of two kinds together: exchanged inputs of a side or an axis, and one slip."""
    for row, exchange in rows.exchanges():
        texts = {change.field: change.would_be for change in exchange}
        for reread in rereading.with_one(texts):
            changes = (*exchange, *reread.changes)
            bits = row.bits + sum(map(_bits_of, reread.changes))
            run = reread.scored
            unexplained = page.left(run.scene, run.outcome, changes) | run.wrong & set(INPUTS)
            for cause in _slip_causes(page, changes, unexplained):
                yield replace(cause, bits=bits, note=row.note)


def _nearest_slips(page: PageEvidence, rereading: Rereading) -> list[tuple[Change, ...]]:
    """Return single slips of printed inputs, those first whose results are nearest to the page's.

    Results are computed in double precision, and corrected by its difference from the program's
    for the recovered scene.
    """
    scene, fields = page.recovered.scene, page.recovered.outcome.fields
    candidates = [
        change for change in rereading.single_changes() if change.kind != slips.TWO_DIGITS
    ]
    columns = {name: np.full(len(candidates) + 1, double(text)) for name, text in scene.items()}
    for row, change in enumerate(candidates, 1):
        mu_reversed = change.field == "MUP" and mu_turned(scene["MU"], change.printed)
        columns[scene_name(change.field)][row] = double(change.would_be) * (
            -1 if mu_reversed else 1
        )
    results = {
        name: column - column[0] + double(fields[name])
        for name, column in printed_in_doubles(
            columns, [n for n in page.results if n in fields]
        ).items()
    }
    order = np.argsort(page.median_error(results, len(candidates) + 1)[1:], kind="stable")
    return [(candidates[index],) for index in order]


def _slip_causes(
    page: PageEvidence,
    changes: tuple[Change, ...],
    left: frozenset[str],
    outcome: Mapping[str, str] | None = None,
) -> Iterator[Cause]:
    """Yield the slips ``changes`` as a cause. With ``outcome``, the fields then printed, numbers
    and replies that are one slip away from it are included."""
    if outcome and len(left - page.base) <= page.max_left:
        for name in sorted(left & page.checks.keys() & page.base):
            page_text = page.checks[name].printed or ""
            texts = page.recovered.scene if name.startswith("reply ") else outcome
            program_text = texts.get(name.removeprefix("reply "), "")
            if page_text and program_text and (kind := slips.slip(page_text, program_text)):
                changes = (*changes, Change(kind, name, page_text, program_text))
    if not changes:
        return
    bits = sum(map(_bits_of, changes))
    if all(change.field in INPUTS for change in changes) and page.only_last_places:
        bits += LAST_PLACE_BITS
    note = ""
    if changes[0].field.startswith("reply "):
        note = "in the typed reply"
    elif any(change.field in page.recovered.apart for change in changes):
        note = "in the inputs given separately"
    kind = " and ".join(dict.fromkeys(change.kind for change in changes))
    yield Cause(kind, note, bits, left - {change.field for change in changes}, changes)


def _bits_of(change: Change) -> float:
    last = change.field not in INPUTS and in_last_places(*change[1:])
    return change.bits + LAST_PLACE_BITS * last


# --- selection and ranking ---


def _rank_causes(page: PageEvidence, causes: Iterable[Cause]) -> list[Cause]:
    """Return the causes that explain nearly all, fewest bits first, with ranks.

    A cause that only adds to a simpler one, or repeats it, is dropped.
    """
    nearly = [c for c in causes if len(c.left) <= page.max_left and page.base - c.left]
    candidates = sorted((c for c in nearly if _total_bits(c) <= MAX_BITS), key=_total_bits)
    chosen: list[Cause] = []
    for cause in candidates:
        is_plausible = _total_bits(cause) <= _total_bits(candidates[0]) + MAX_EXCESS_BITS
        if is_plausible and not any(_adds_to(cause, other) for other in chosen):
            chosen.append(cause)
    # where another machine is named, the best misreading is always listed, too
    innocent = next((cause for cause in chosen if not _accuses(cause)), None)
    if innocent in chosen[MAX_EXPLANATIONS:]:
        chosen[MAX_EXPLANATIONS - 1] = innocent
    leaders: list[Cause] = []
    explanations = []
    for cause in chosen[:MAX_EXPLANATIONS]:
        # another program or machine never shares the rank of a misreading that explains the
        # page better
        alike = (
            rank
            for rank, other in enumerate(leaders, 1)
            if cause.left == other.left
            and _total_bits(cause) <= _total_bits(other) + SAME_RANK_BITS
            and (_accuses(other) or not _accuses(cause))
        )
        rank = next(alike, len(leaders) + 1)
        leaders += [cause] * (rank > len(leaders))
        changes = [_change_as_json(page, change) for change in cause.right]
        details = len(page.base - cause.left), len(page.base), changes, rank
        explanations.append(
            Cause(cause.kind, cause.note, cause.bits, cause.left, cause.right, *details)
        )
    return sorted(explanations, key=lambda cause: (cause.rank, _total_bits(cause)))


def _total_bits(cause: Cause) -> float:
    return cause.bits + UNEXPLAINED_BITS * len(cause.left)


def _accuses(cause: Cause) -> bool:
    return cause.note.endswith(NOT_APPLESOFT)


def _adds_to(cause: Cause, other: Cause) -> bool:
    """Return True if a cause corrects all that a likelier one does and more, or the same numbers in
    the same way, or repeats its sentence."""
    if not other.right:
        return not cause.right and (cause.kind, cause.note) == (other.kind, other.note)
    rights, other_rights = (
        {(c.field, c.would_be) for c in member.right} for member in (cause, other)
    )
    if cause.kind == other.kind and dict(rights).keys() == dict(other_rights).keys():
        return len(cause.left) > len(other.left) or rights == other_rights
    return other_rights < rights


def _change_as_json(page: PageEvidence, change: Change) -> dict[str, Any]:
    """Return a corrected number as JSON: its place, and the question to ask of the paper there."""
    kind, name, page_text, would_be = change
    readings = page.paper.replies if name.startswith("reply ") else page.paper.fields
    name = name.removeprefix("reply ")
    reading = readings.get(name)
    labels = [label for label in page.paper.mislabelled if label.name == name]
    line, column, look = None, None, ""
    if kind in (LABELS_EXCHANGED, LABEL_WRONG):
        line, column = labels[0].line, labels[0].column
        look = f"line {line}, column {column}: is this {page_text} or {would_be}?"
    elif reading is not None:
        line, column = reading.line, reading.column
        path = compare(reading.region, would_be).path
        places = [*differences_along(page.paper.page, name, reading.region, would_be, path)]
        places = [one for one in places if one.kind is Kind.CONTRADICTS] or places
        look = "; ".join(one.question for one in places) if kind in slips.BITS else ""
    return {
        "kind": kind, "field": name, "printed": page_text, "would_be": would_be,
        "line": line, "column": column, "look": look,
    }  # fmt: skip
