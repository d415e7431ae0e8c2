"""Looking past a reader's mistakes: a printout judged anew where nothing but its reader is wrong.

A page that a machine read may differ, or lack an input, because of the reading alone. Scenes in
which slips are put right (`rereading`) or inputs solved for (`inversion`) are then judged as if
they were the printout's own; `judging.settled` says whether what is still wrong is the reader's,
and `borneout` whether what was not read hangs on what was.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from ..reading.numerals import Habit
from ..reading.printout import Printout
from ..recovery.choices import noughts_unreadable
from ..recovery.inversion import paper_cost, scenes_found
from ..recovery.recovered import Recovered, recover
from ..recovery.rereading import Reread, Rereading
from ..recovery.search import KINETIC, MISMATCH, Scored
from .borneout import borne_out
from .judgement import (
    FieldCheck,
    Status,
    alike,
    field_checks,
    reply_checks,
    settled,
    swapped_digits,
)

_TRIED = 8
"""Scenes of each kind that are judged, those that explain most."""
_HABITS = 2
"""So many are put right throughout the page, one at a time."""
_A_HABIT = 1.0
"""What it costs to believe in a habit, besides each place where it shows."""
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
        if not self._shown.machine_read or self._recovered.missing:
            return None
        return Rereading(self._recovered).best(deep=True)

    def judged(self) -> Rejudged | None:
        """The printout judged with its reader's slips put right; None where they are not its alone.

        The scene that explains most decides, and every other that explains the page as well must
        bear it out: a digit altered in one angle can be made good by a sign of the angle beside it.
        """
        shown = self._shown
        if not shown.machine_read or shown.fragment_of_run or shown.ending:
            return None
        search = self._recovered.search
        scenes = list(self._slips_put_right())
        costs = [paper_cost(shown, search, one) for one in scenes]
        if not self._fixed and min(costs, default=MISMATCH + _AS_WELL) >= MISMATCH + _AS_WELL:
            for other, cost in self._habits_put_right():
                if cost < min(costs, default=cost + 1):
                    scenes.append(other)
                    costs.append(cost)
            found = scenes_found(shown, search, *self._to_begin_with(), _TRIED)
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

    @cached_property
    def _by_habit(self) -> list[Recovered]:
        """The printout recovered with a habit of its reader put right throughout."""
        return [recover(self._shown, habit=habit) for habit in self._habits()]

    def _habits_put_right(self) -> Iterator[tuple[Scored, float]]:
        """The scenes of the page with a habit put right, and one slip besides; with what each
        costs."""
        for other in self._by_habit:
            if other.missing:
                continue
            scenes = [other.search.replayed_scene(other.scene, other.assumed)]
            if 0 < len(other.wrong) < len(self._recovered.wrong):
                scenes += [one.scored for one in Rereading(other).best()[:_TRIED]]
            for one in scenes:
                yield one, _A_HABIT + paper_cost(self._shown, other.search, one)

    def _to_begin_with(self) -> tuple[Mapping[str, str], list[str]]:
        """The scene to solve for inputs from, and what is missing of it: as read where the printed
        kinetic energy comes out, else with a habit or slips put right so that it does."""
        for one in (self._recovered, *self._by_habit):
            if "KI" not in one.wrong:
                return one.scene, one.missing
            if not KINETIC & set(one.missing) and (scored := Rereading(one).with_energy()):
                return scored.scene, one.missing
        return self._recovered.scene, self._recovered.missing

    def _habits(self) -> list[Habit]:
        """What the reader may take a digit for throughout: zeros for whatever is like them, or one
        digit for another as in a number where nothing else is wrong."""
        noughts = noughts_unreadable(self._shown)
        swapped = Counter(
            pair
            for check in field_checks(self._shown, self._recovered)
            if len(pairs := list(swapped_digits(check))) == 1
            for pair in pairs
            if alike(pair)
        )
        often = [pair for pair, _ in swapped.most_common(_HABITS)]
        seen = [Habit(printed, frozenset(read)) for printed, read in often]
        return [noughts, *seen][:_HABITS] if noughts else seen


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
