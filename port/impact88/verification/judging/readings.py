"""Several readings of one paper: what any of them supports, another's slip does not contradict.

Each reader makes slips of its own; a number altered on the paper is read so by all. Every reading
is held against the page of each scene that one of them shows, and of the scenes the one counts that
leaves least contradicted in all readings of a number.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from ..reading.printout import Printout
from ..recovery.recovered import Recovered, recover
from .judgement import Doubtful, FieldCheck, Judged, Status, Verdict, judge

_SAME_PAPER = 10
"""Numbers that two readings of one paper have in common, at least."""
_AGREED_AGAINST = 2
"""So many readings that agree on another number outweigh one that supports the program's."""


def matching(paper: Printout, others: Sequence[Sequence[Printout]]) -> list[Printout]:
    """Return the readings of one printout among those of other texts: of each text the printout
    that has most numbers in common with it, ten at least."""
    readings = []
    for printouts in others:
        counts = [
            sum(paper.text(name) == other.text(name) for name in paper.fields)
            for other in printouts
        ]
        if counts and max(counts) >= _SAME_PAPER:
            readings.append(printouts[counts.index(max(counts))])
    return readings


def judged_together(papers: Sequence[Printout], given: Mapping[str, str] | None) -> Judged | None:
    """Return the first of several readings of a paper, judged by what all of them support; None
    where it was read in one only, or no reading shows a whole scene."""
    scenes = [recover(paper, given) for paper in papers]
    whole = [recovered for recovered in scenes if not recovered.missing]
    if len(papers) < 2 or not whole:
        return None
    best = min((_merged(papers, recovered) for recovered in whole), key=_left_open)
    return best


def _left_open(judged: Judged) -> tuple[int, int]:
    checks = [*judged.fields, *judged.replies]
    wrong = sum(check.status is Status.CONTRADICTED for check in checks)
    return wrong + len(judged.paper.mislabelled), sum(
        check.status is not Status.READ for check in checks
    )


def _merged(papers: Sequence[Printout], recovered: Recovered) -> Judged:
    """The readings held against one scene's page, number by number."""
    each = [judge(paper, recovered) for paper in papers]
    first = each[0]
    fields = list(_supported([judged.fields for judged in each]))
    replies = list(_supported([judged.replies for judged in each]))
    wrong = {
        label.name
        for label in papers[0].mislabelled
        if all(label.name in {other.name for other in paper.mislabelled} for paper in papers)
    }
    endings = [judged.ending for judged in each if judged.ending.status is Status.READ]
    ending = endings[0] if endings else first.ending
    verdict = Verdict.IDENTICAL_AS_READ
    if all(judged.verdict is Verdict.IDENTICAL for judged in each):
        verdict = Verdict.IDENTICAL
    if any(check.status in (Status.NOT_READ, Status.NOT_COMPARED) for check in fields):
        verdict = Verdict.INCOMPLETE
    if ending.same is None or papers[0].fragment_of_run or papers[0].unread:
        verdict = Verdict.INCOMPLETE
    every = [*fields, *replies, ending]
    if wrong or any(check.status is Status.CONTRADICTED for check in every):
        verdict = Verdict.DIFFERS
    return Judged(papers[0], recovered, fields, replies, ending, verdict, first.notes)


def _supported(readings: Sequence[Sequence[FieldCheck]]) -> Iterator[FieldCheck]:
    """Each number as far as any reading supports it."""
    by_name = [{check.name: check for check in checks} for checks in readings]
    for name in dict.fromkeys(name for checks in by_name for name in checks):
        checks = [checks[name] for checks in by_name if name in checks]
        yield _supported_check(checks)


def _supported_check(checks: Sequence[FieldCheck]) -> FieldCheck:
    first = checks[0]
    supporting = [check for check in checks if check.status in (Status.READ, Status.DOUBTFUL)]
    against = [check for check in checks if check.status is Status.CONTRADICTED]
    texts = [check.printed for check in against]
    agreed = max((texts.count(text) for text in texts), default=0)
    if not supporting:
        return against[0] if against and first.status is not Status.CONTRADICTED else first
    best = min(supporting, key=lambda check: check.status is Status.DOUBTFUL)
    if not against:
        status = best.status
    elif agreed >= _AGREED_AGAINST:
        status = Status.NOT_READ
    else:
        status = Status.DOUBTFUL
    doubts = list(best.doubts)
    for check in against:
        place = check.line or 0, check.column or 0, check.start or 0
        doubts.append(
            Doubtful(*place, check.printed or "", check.recomputed or "", "another reading")
        )
    printed = best.printed if first.status is Status.CONTRADICTED else first.printed or best.printed
    return replace(first, printed=printed, status=status, doubts=doubts)
