"""Looking past a reader's mistakes: a printout judged anew where nothing but its reader is wrong.

A page that a machine read may differ because of the reading alone. Scenes in which slips are put
right (`rereading`) are then judged as if they were the printout's own; `judgement.settled` says
whether what is still wrong is the reader's.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property

from ..reading.printout import Printout
from ..recovery.recovered import Recovered
from ..recovery.search import Scored
from ..recovery.slips import Reread, Rereading
from .judgement import Judged, Status, Verdict, judge, settled

_TRIED = 8
"""Scenes of each kind that are judged, those that explain most."""
_AS_WELL = 1.0
"""Scenes that cost so little more than the best explain the page as well."""


class LookingPast:
    """Looking past the reader of one printout."""

    def __init__(self, shown: Printout, recovered: Recovered) -> None:
        self._shown = shown
        self._recovered = recovered

    @cached_property
    def rereads(self) -> list[Reread] | None:
        """Scenes with slips put right, those that explain most first; None for a page that no
        machine read, or that lacks an input."""
        if not self._shown.machine_read or self._recovered.missing:
            return None
        return Rereading(self._recovered).best()

    def judged(self) -> Judged | None:
        """The printout judged with its reader's slips put right; None where they are not its alone.

        The scene that explains most decides, and every other that explains the page as well must
        bear it out: a digit altered in one angle can be made good by a sign of the angle beside it.
        """
        shown = self._shown
        if not shown.machine_read or shown.fragment_of_run or shown.ending or shown.unread:
            return None
        scenes = sorted(self._slips_put_right(), key=lambda scored: scored.cost)
        best: Judged | None = None
        for scored in scenes:
            if scored.cost > scenes[0].cost + _AS_WELL:
                break
            judged = _judged(shown, self._recovered, scored)
            if judged is None:
                return None
            best = best or judged
        return best

    def _slips_put_right(self) -> Iterator[Scored]:
        """The scene as read, and with slips put right. Where one number's slip explains the page,
        nothing needs to be solved for."""
        recovered = self._recovered
        if not recovered.missing:
            yield recovered.search.replayed_scene(recovered.scene, recovered.assumed)
        yield from (one.scored for one in (self.rereads or [])[:_TRIED])


def _judged(shown: Printout, recovered: Recovered, scored: Scored) -> Judged | None:
    """The printout judged as one of a scene; None where more than its reader is wrong."""
    other = replace(
        recovered,
        scene=scored.scene,
        assumed=scored.assumed,
        outcome=scored.outcome,
        missing=[],
    )
    found = judge(shown, other)
    if not settled(shown, found.fields, found.replies):
        return None
    for check in [*found.fields, *found.replies]:
        if check.status == Status.CONTRADICTED:
            check.status, check.same = Status.DOUBTFUL, None
    found.verdict = Verdict.IDENTICAL_AS_READ
    return found
