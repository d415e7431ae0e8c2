"""Errors that the reader of a page may have made: a machine misreads characters, a person does not.

A page with signs of an optical reader (`Printout.machine_read`) may differ by its reader's errors.
Here is decided which differences are attributed to the reader; `judgement.is_alteration` says when
a page that a machine read differs all the same.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from ..reading.differences import Kind
from ..recovery.rereading import Rereading
from .judgement import FieldCheck, Judged, Status, Verdict, judge

TIE_COST = 1.0
"""Cost above the best up to which scenes explain the page as well; doubled or halved, the result of
none of 95 differing readings changes."""
MAX_GLYPH_ERRORS = 3
"""Numbers with a lost or added glyph that may be attributed to a reader; doubled, 1 of 95 more is
attributed, and with one 1 of 10 fewer."""


def attribute_to_reader(found: Judged, rereading: Rereading) -> Judged | None:
    """Judge the printout with its reader's errors corrected. Return None unless every difference
    can be attributed to the reader; where it is as likely that some cannot, the page is incomplete.

    Scenes with corrected slips are judged as if they were the printout's own; what still differs
    must be the reader's error. Of 110 readings of genuine pages, 6 are decided here. The scene
    that explains most decides, and every other that explains the page as well must confirm it: a
    digit altered in one angle can be compensated by a sign of the angle beside it.
    """
    paper, base = found.paper, found.recovered
    no_reader = not paper.machine_read or paper.fragment_of_run or paper.ending or paper.unread
    if no_reader or base.missing:
        return None
    apart = set(base.apart)
    rereads = [r for r in rereading.best if apart.isdisjoint(change.field for change in r.changes)]
    runs = [reread.scored for reread in rereads]
    runs.append(base.search.replayed_scene(base.scene, base.assumed))
    runs.sort(key=lambda run: run.cost)
    best = None
    for run in runs:
        if run.cost <= runs[0].cost + TIE_COST:
            scene = replace(base, scene=run.scene, assumed=run.assumed, outcome=run.outcome)
            judgement = judge(paper, scene)
            if not is_reader_error(judgement.fields, judgement.replies):
                if best:
                    best.verdict = Verdict.INCOMPLETE
                return best
            best = best or judgement
    assert best is not None
    for check in [*best.fields, *best.replies]:
        if check.status == Status.CONTRADICTED:
            check.status = Status.DOUBTFUL
    best.verdict = Verdict.IDENTICAL_AS_READ
    return best


def is_reader_error(checks: Sequence[FieldCheck], replies: Sequence[FieldCheck]) -> bool:
    """Return True if all differences of a machine-read page can be attributed to its reader.

    A reader loses and adds signs and points, and a digit of a number here and there, and where it
    takes one digit for another it does so in more places than one. A digit altered on the paper
    stands alone: a digit cleanly read as another is attributed to the reader only if the page
    shows the same misreading elsewhere.
    """
    all_checks = [*checks, *replies]
    if any(check.status in (Status.NOT_READ, Status.NOT_COMPARED) for check in checks):
        return False
    wrong = [check for check in all_checks if check.status == Status.CONTRADICTED]
    swap_counts = Counter(pair for check in all_checks for pair in check.swapped())
    return (
        1 not in swap_counts.values()
        and all(_digits_lost_or_added(check) <= 1 for check in wrong)
        and sum(not check.swapped() for check in wrong) <= MAX_GLYPH_ERRORS
    )


def _digits_lost_or_added(check: FieldCheck) -> int:
    """Return the number of digits that were not read, or read where none is printed. Digits lost
    behind a final point count as one, for the program ends no number with a point."""
    wrong = [doubt for doubt in check.doubts if doubt.kind is Kind.CONTRADICTS]
    if check.printed and check.printed.endswith(".") and not any(doubt.read for doubt in wrong):
        return 1
    return sum(
        (doubt.read + doubt.printed).isdigit()
        for doubt in wrong
        if not (doubt.read and doubt.printed)
    )
