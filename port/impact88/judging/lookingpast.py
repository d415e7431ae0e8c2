"""Looking past a reader's mistakes: a printout judged anew where nothing but its reader is wrong.

A page that a machine read may differ because of the reading alone. Scenes in which slips are put
right (`rereading`) are then judged as if they were the printout's own; `judgement.settled` says
whether what is still wrong is the reader's.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property

from ..doubles import double
from ..fields import ANGLES, INPUTS
from ..reading.anglerow import cut_as
from ..reading.numerals import compare
from ..reading.printout import Printout, Reading
from ..recovery.choices import reply_ways
from ..recovery.recovered import Recovered
from ..recovery.rereading import Reread, Rereading
from ..recovery.search import MISMATCH, Scored, Search
from .judgement import Judged, Status, Verdict, judge, settled

_TRIED = 8
"""Scenes of each kind that are judged, those that explain most."""
_UNREAD, _MOST_COST = 0.6, 2 * MISMATCH
"""What an input costs of which nothing was read, by the digit, and what one may cost at most."""
_FULL_TURN, _TURNED = 360.0, 2.0
"""Beyond it nobody types an angle, and what it costs to believe that somebody did."""
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
        return Rereading(self._recovered).best(deep=True)

    def judged(self) -> Judged | None:
        """The printout judged with its reader's slips put right; None where they are not its alone.

        The scene that explains most decides, and every other that explains the page as well must
        bear it out: a digit altered in one angle can be made good by a sign of the angle beside it.
        """
        shown = self._shown
        if not shown.machine_read or shown.fragment_of_run or shown.ending or shown.unread:
            return None
        search = self._recovered.search
        scenes = list(self._slips_put_right())
        costs = [paper_cost(shown, search, one) for one in scenes]
        best: Judged | None = None
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


def paper_cost(shown: Printout, search: Search, scored: Scored) -> float:
    """What a replayed scene costs as the explanation of all that was read: inputs, replies and
    results alike, however the scene was come by."""
    return _without_row(shown, search, scored) + _row_cost(shown, scored)


def _row_cost(shown: Printout, scored: Scored) -> float:
    """What the row of angles costs, where blanks alone do not cut it."""
    if not _in_one_row(shown, scored):
        return 0.0
    row, texts = shown.angle_row, tuple(scored.outcome.fields[name] for name in ANGLES)
    pieces = zip(texts, cut_as(row, texts), strict=False)
    return sum(
        min(compare(row[start:stop], text).cost, _MOST_COST) for text, (start, stop) in pieces
    )


def _in_one_row(shown: Printout, scored: Scored) -> bool:
    """Whether the angles stand in a row that blanks alone do not cut."""
    return bool(shown.angle_row) and all(name in scored.outcome.fields for name in ANGLES)


def _without_row(shown: Printout, search: Search, scored: Scored) -> float:
    """What all the rest costs."""
    fields = scored.outcome.fields
    row = _in_one_row(shown, scored)
    cost = search.results_cost(scored)
    for name in INPUTS:
        reading = shown.fields.get(name)
        if name in fields and not (row and name in ANGLES):
            cost += _read_cost(reading, fields[name])
    cost += sum(_TURNED for name in ANGLES if abs(double(scored.scene[name])) > _FULL_TURN)
    for name, reply in shown.replies.items():
        ways = reply_ways(reply)
        prices = [price for text, _, price in ways if double(text) == double(scored.scene[name])]
        cost += min(prices, default=MISMATCH)
    return cost


def _read_cost(reading: Reading | None, printed: str) -> float:
    if reading is None:
        return _UNREAD * len(printed)
    match = compare(reading.region, printed, reading.cut, reading.sign_free, reading.closing)
    return min(match.cost, _MOST_COST)
