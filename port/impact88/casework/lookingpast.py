"""Looking past a reader's mistakes: a printout judged anew where nothing but its reader is wrong.

A page that a machine read may differ, or lack an input, because of the reading alone. Scenes in
which slips are put right (`rereading`) or inputs solved for (`inversion`) are then judged as if
they were the printout's own; `judging.settled` says whether what is still wrong is the reader's,
and `borneout` whether what was not read hangs on what was.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

from .borneout import borne_out
from .inversion import paper_cost, scenes_found
from .judging import FieldCheck, Status, field_checks, machine_read, reply_checks, settled
from .printout import Printout
from .recovery import Recovered, recover
from .rereading import Reread, Rereading
from .search import MISMATCH, Scored
from .ways import unreadable_digit

_TRIED = 8
"""Scenes of each kind that are judged, those that explain most."""
_AS_WELL = 1.0
"""Scenes that cost so little more than the best explain the page as well."""


@dataclass
class Rejudged:
    """The printout judged with the slips of its reader looked past."""

    scene: dict[str, str | None]
    fields: list[FieldCheck]
    replies: list[FieldCheck]


class LookingPast:
    """Looking past the reader of one printout. ``fixed``: inputs come from elsewhere than the page,
    so that none is solved for."""

    def __init__(self, shown: Printout, recovered: Recovered, fixed: bool = False) -> None:
        self._shown = shown
        self._recovered = recovered
        self._fixed = fixed

    @cached_property
    def rereads(self) -> list[Reread] | None:
        """Scenes with slips put right, those that explain most first; None for a page that no
        machine read, or that lacks an input."""
        if not machine_read(self._shown) or self._recovered.missing:
            return None
        return Rereading(self._recovered).best(deep=True)

    def judged(self) -> Rejudged | None:
        """The printout judged with its reader's slips put right; None where they are not its alone.

        The scene that explains most decides, and every other that explains the page as well must
        bear it out: a digit altered in one angle can be made good by a sign of the angle beside it.
        """
        shown = self._shown
        if not machine_read(shown) or shown.fragment_of_run or shown.ending:
            return None
        search = self._recovered.search
        scenes = list(self._slips_put_right())
        costs = [paper_cost(shown, search, one) for one in scenes]
        if not self._fixed and min(costs, default=MISMATCH + _AS_WELL) >= MISMATCH + _AS_WELL:
            recovered = self._recovered
            for other in self._unreadable_put_right():
                cost = paper_cost(shown, search, other)
                if cost < min(costs, default=cost + 1):
                    scenes.append(other)
                    costs.append(cost)
            found = scenes_found(shown, search, recovered.scene, recovered.missing, _TRIED)
            scenes += found
            costs += [paper_cost(shown, search, one) for one in found]
        best: Rejudged | None = None
        for cost, _, scored in sorted(zip(costs, range(len(scenes)), scenes, strict=True)):
            if cost > min(costs) + _AS_WELL:
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

    def _unreadable_put_right(self) -> Iterator[Scored]:
        """The scenes of a page whose reader cannot read one digit, that digit put right throughout;
        and one slip besides."""
        digit = unreadable_digit(self._shown)
        if not digit:
            return
        other = recover(self._shown, unreadable=digit)
        if other.missing:
            return
        yield other.search.replayed_scene(other.scene, other.assumed)
        if other.wrong:
            yield from (one.scored for one in Rereading(other).best()[:_TRIED])


def _judged(shown: Printout, recovered: Recovered, scored: Scored) -> Rejudged | None:
    """The printout judged as one of a scene; None where more than its reader is wrong."""
    other = replace(
        recovered,
        scene=scored.scene,
        assumed=scored.assumed,
        outcome=scored.outcome,
        missing=[],
    )
    checks = field_checks(shown, other)
    replies = reply_checks(shown, other)
    if not borne_out(shown, other, checks) or not settled(shown, checks, replies):
        return None
    for check in [*checks, *replies]:
        if check.status == Status.CONTRADICTED:
            check.status, check.same = Status.DOUBTFUL, None
    return Rejudged(other.scene_or_missing(), checks, replies)
