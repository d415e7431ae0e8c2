"""Looking past a reader's mistakes: a printout judged anew where nothing but its reader is wrong.

A page that a machine read may differ because of the reading alone. Scenes in which slips are put
right are judged as if they were the printout's own; what is still wrong must be the reader's. Of
110 readings of genuine pages 6 are settled so.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from ..reading.numerals import Doubt
from ..recovery.slips import Rereading
from .judgement import FieldCheck, Judged, Status, Verdict, judge

_TRIED = 8
"""Scenes that are judged, those that explain most."""
_AS_WELL = 1.0
"""Scenes that cost so little more than the best explain the page as well."""
_READ_WELL = 0.6
"""Part of the numbers that must be read as the program prints them, doubtfully at worst."""
_LOST_AND_ADDED = 3
"""So many numbers with a glyph lost or added may be put down to a reader."""


def looked_past(found: Judged, rereading: Rereading) -> Judged | None:
    """The printout judged with its reader's slips put right; None where they are not its alone.

    The scene that explains most decides, and every other that explains the page as well must
    bear it out: a digit altered in one angle can be made good by a sign of the angle beside it.
    """
    shown, recovered = found.shown, found.recovered
    no_reader = not shown.machine_read or shown.fragment_of_run or shown.ending or shown.unread
    if no_reader or recovered.missing:
        return None
    apart = set(recovered.apart)
    own = [r for r in rereading.best() if apart.isdisjoint(one.field for one in r.changes)]
    scenes = [one.scored for one in own[:_TRIED]]
    scenes.append(recovered.search.replayed_scene(recovered.scene, recovered.assumed))
    scenes.sort(key=lambda scored: scored.cost)
    every = [
        judge(shown, replace(recovered, scene=one.scene, assumed=one.assumed, outcome=one.outcome))
        for one in scenes
        if one.cost <= scenes[0].cost + _AS_WELL
    ]
    if not all(settled(one.fields, one.replies) for one in every):
        return None
    best = every[0]
    for check in [*best.fields, *best.replies]:
        if check.status == Status.CONTRADICTED:
            check.status = Status.DOUBTFUL
    best.verdict = Verdict.IDENTICAL_AS_READ
    return best


def settled(checks: Sequence[FieldCheck], replies: Sequence[FieldCheck]) -> bool:
    """Whether all that a machine-read page contradicts is its reader's doing.

    A reader loses and adds signs and points, and a digit of a number here and there, and where it
    takes one digit for another it does so in more places than one. A digit altered on the paper
    stands alone: a digit cleanly read as another is not looked past unless the page shows the
    same mistake again.
    """
    every = [*checks, *replies]
    if any(check.status in (Status.NOT_READ, Status.NOT_COMPARED) for check in checks):
        return False
    wrong = [check for check in every if check.status == Status.CONTRADICTED]
    read = sum(check.status in (Status.READ, Status.DOUBTFUL) for check in every)
    swapped = Counter(pair for check in every for pair in check.swapped())
    return (
        read >= _READ_WELL * len(every)
        and 1 not in swapped.values()
        and all(_digits_lost_or_added(check) <= 1 for check in wrong)
        and sum(not check.swapped() for check in wrong) <= _LOST_AND_ADDED
    )


def _digits_lost_or_added(check: FieldCheck) -> int:
    """How many digits of a number were not read, or read where none is printed; all that is lost
    behind a point is lost in one piece, for the program ends no number so."""
    wrong = [doubt for doubt in check.doubts if doubt.how == Doubt.CONTRADICTS]
    if check.printed and check.printed.endswith(".") and not any(doubt.read for doubt in wrong):
        return 1
    return sum(
        (one.read + one.printed).isdigit() for one in wrong if not (one.read and one.printed)
    )
