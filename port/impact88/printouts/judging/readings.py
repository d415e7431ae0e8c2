"""Several readings of one paper: a number that one reading supports is not contradicted by
another's slip.

Each reader makes slips of its own; a number altered on the paper is read so by all. Every reading
is compared with the page of each scene that one of them shows; the scene counts that leaves the
fewest numbers contradicted in all readings.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from ..reading.printout import Printout
from ..recovery.recovered import Recovered, recover
from .judgement import Doubtful, FieldCheck, Judged, Status, Verdict, judge

MIN_COMMON_NUMBERS = 10  # equal numbers in two readings of one paper, at least
OUTWEIGHING_READINGS = 2
"""Readings that agree on another number and so outweigh one that supports the program's."""


def matching_readings(paper: Printout, others: Sequence[Sequence[Printout]]) -> list[Printout]:
    """Return other readings of a printout: from each of ``others``, the printouts in another text,
    the one with most numbers in common, if it has at least ten."""
    readings = []
    for printouts in others:
        counts = [
            sum(paper.text(name) == candidate.text(name) for name in paper.fields)
            for candidate in printouts
        ]
        if counts and max(counts) >= MIN_COMMON_NUMBERS:
            readings.append(printouts[counts.index(max(counts))])
    return readings


def judge_together(papers: Sequence[Printout], given: Mapping[str, str] | None) -> Judged | None:
    """Judge a paper by several readings of it, and return the judgement of the first. None if there
    is only one reading, or none shows a complete scene."""
    scenes = [recover(paper, given) for paper in papers]
    complete_scenes = [scene for scene in scenes if not scene.missing]
    if len(papers) < 2 or not complete_scenes:
        return None
    best = min((_merge(papers, scene) for scene in complete_scenes), key=_count_open)
    return best


def _count_open(judged: Judged) -> tuple[int, int]:
    checks = [*judged.fields, *judged.replies]
    wrong = sum(check.status is Status.CONTRADICTED for check in checks)
    return wrong + len(judged.paper.mislabelled), sum(
        check.status is not Status.READ for check in checks
    )


def _merge(papers: Sequence[Printout], recovered: Recovered) -> Judged:
    """Judge the readings by one scene's page, number by number."""
    judgements = [judge(paper, recovered) for paper in papers]
    first = judgements[0]
    fields = list(_supported_checks([judgement.fields for judgement in judgements]))
    replies = list(_supported_checks([judgement.replies for judgement in judgements]))
    wrong = {
        label.name
        for label in papers[0].mislabelled
        if all(
            label.name in {label_in_reading.name for label_in_reading in paper.mislabelled}
            for paper in papers
        )
    }
    endings = [
        judgement.ending for judgement in judgements if judgement.ending.status is Status.READ
    ]
    ending = endings[0] if endings else first.ending
    verdict = Verdict.IDENTICAL_AS_READ
    if all(judgement.verdict is Verdict.IDENTICAL for judgement in judgements):
        verdict = Verdict.IDENTICAL
    if any(check.status in (Status.NOT_READ, Status.NOT_COMPARED) for check in fields):
        verdict = Verdict.INCOMPLETE
    if ending.same is None or papers[0].fragment_of_run or papers[0].unread:
        verdict = Verdict.INCOMPLETE
    all_checks = [*fields, *replies, ending]
    if wrong or any(check.status is Status.CONTRADICTED for check in all_checks):
        verdict = Verdict.DIFFERS
    return Judged(papers[0], recovered, fields, replies, ending, verdict, first.notes)


def _supported_checks(readings: Sequence[Sequence[FieldCheck]]) -> Iterator[FieldCheck]:
    """Yield a check of each number: supported where any reading supports it."""
    by_name = [{check.name: check for check in checks} for checks in readings]
    for name in dict.fromkeys(name for checks in by_name for name in checks):
        checks = [checks[name] for checks in by_name if name in checks]
        yield _supported_check(checks)


def _supported_check(checks: Sequence[FieldCheck]) -> FieldCheck:
    first = checks[0]
    supporting = [check for check in checks if check.status in (Status.READ, Status.DOUBTFUL)]
    against = [check for check in checks if check.status is Status.CONTRADICTED]
    texts = [check.printed for check in against]
    agreeing_count = max((texts.count(text) for text in texts), default=0)
    if not supporting:
        return against[0] if against and first.status is not Status.CONTRADICTED else first
    best = min(supporting, key=lambda check: check.status is Status.DOUBTFUL)
    if not against:
        status = best.status
    elif agreeing_count >= OUTWEIGHING_READINGS:
        status = Status.NOT_READ
    else:
        status = Status.DOUBTFUL
    doubts = list(best.doubts)
    for check in against:
        place = check.line or 0, check.column or 0, check.start or 0
        doubts.append(
            Doubtful(*place, check.printed or "", check.recomputed or "", "another reading")
        )
    best_text = (
        best.printed if first.status is Status.CONTRADICTED else first.printed or best.printed
    )
    return replace(first, printed=best_text, status=status, doubts=doubts)
