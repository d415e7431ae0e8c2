"""The verdict on a printout in a picture: what the margins of its cells allow to be said.

`THRESHOLDS` is the one table of thresholds, with what they were estimated on.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from ..judging.judgement import Verdict
from .holding import Cell
from .layout import Sheet
from .scenes import WORST, Candidate
from .typeface import BLANK


class Thresholds(NamedTuple):
    """``holds``: a cell with a smaller margin is the character predicted; ``differs``: one with a
    larger margin is another; ``label``: a label with a smaller margin holds; ``blank``: blank paper
    with a larger margin is not blank; ``foreign``: a cell this many times as far from a mean as is
    usual was not made by that type; ``kind``: a label that is nearer than this to another
    letter's mean is that letter."""

    holds: float
    differs: float
    label: float
    blank: float
    foreign: float
    kind: float


THRESHOLDS = Thresholds(holds=-0.12, differs=0.3, label=0.1, blank=-0.15, foreign=20.0, kind=15.0)
RATES = (
    "Basis of the thresholds: 314 pages with known truth whose scene was found and that were "
    "settled. On 160 scans and photographs (74 clean, 62 hard, 24 photographed) none of 21,707 "
    "digits has a margin above -0.32, and of 215,685 trials of a digit as another that occurs on "
    "its page none has one below +0.43; on 154 pages drawn afterwards, half of them in type on "
    "which nothing was chosen, none of 20,865 digits is above -0.23, and of 211,797 trials two, of "
    "one photograph, are below +0.30 (+0.27). Cells of a page are not independent: no page of 314 "
    "is at most 1 in 105, at 95 % confidence. A point taken for a comma is in doubt from -0.05 on "
    "badly faded pages."
)
"""Said of the margins wherever they are shown; measured anew when `held` changes."""
MOST_DOUBTFUL, MOST_DIFFERING = 4, 4
"""Cells that may be doubtful on a page that is settled, or differ on one that is accused: with more
it was the reading that went wrong."""
MOST_MISREAD = 2 * WORST
"""What the first reading may contradict the scene beyond the cells that differ: 240 of 245 pages
that were altered stay within, three genuine ones that had been accused had 20 to 36."""
_MARKS = frozenset(".,-")
"""Characters of so little ink that a speck, or a faint pin, makes or unmakes them."""


@dataclass
class Judged:
    """A verdict with its reasons: the cells that differ and those in doubt, and a sentence where
    the page as a whole was not read."""

    verdict: Verdict
    differing: list[Cell] = field(default_factory=list)
    doubtful: list[Cell] = field(default_factory=list)
    reason: str = ""


def judged(sheet: Sheet, candidate: Candidate, cells: Sequence[Cell]) -> Judged:
    """The verdict on one printout of a page, whose cells were held against its scene."""
    differing = [cell for cell in cells if state(cell) == "differs"]
    doubtful = [cell for cell in cells if state(cell) == "doubtful"]
    spins = "WAF" in candidate.outcome.fields
    reason = ""
    if not sheet.whole:
        reason = "lines of the printout were not found"
    elif len(differing) + len(doubtful) > MOST_DIFFERING + MOST_DOUBTFUL:
        reason = "too little was read for certain"
    elif candidate.outcome.ending is not None or spins is not (13 in sheet.rows):
        reason = "the final spins were not found"
    elif differing and all(_retyped(cell, [*differing, *doubtful]) for cell in differing):
        reason = "a reply is typed otherwise than was expected"
    if reason:
        return Judged(Verdict.INCOMPLETE, differing, doubtful, reason)
    if not differing:
        if not doubtful:
            return Judged(Verdict.IDENTICAL)
        slight = len(doubtful) <= MOST_DOUBTFUL and all(map(_slight, doubtful))
        return Judged(Verdict.IDENTICAL_AS_READ if slight else Verdict.INCOMPLETE, [], doubtful)
    misread = candidate.cost - WORST * len(differing)
    sure = len(differing) <= MOST_DIFFERING and all(map(_slight, doubtful))
    sure = sure and misread <= MOST_MISREAD
    return Judged(Verdict.DIFFERS if sure else Verdict.INCOMPLETE, differing, doubtful)


def state(cell: Cell) -> str:
    """``holds``, ``doubtful`` or ``differs``."""
    limits = THRESHOLDS
    if cell.cut:
        return "doubtful" if cell.name and cell.predicted != BLANK else "holds"
    if cell.predicted == BLANK:
        if cell.margin < limits.blank or cell.other in _MARKS:
            return "holds" if cell.margin < limits.differs or not cell.name else "doubtful"
        return "differs" if cell.margin > limits.differs else "doubtful"
    if (cell.hand and cell.count < 2) or (cell.lost and cell.margin > limits.holds):
        return "doubtful"
    if not cell.name:
        if cell.margin < limits.label:
            return "holds"
        # another letter only where the page has it elsewhere and the cell is of its kind
        known = min(cell.count, cell.other_count) > 2 and cell.other != BLANK
        near = cell.other_distance < limits.kind and cell.distance > 2 * cell.other_distance
        return "differs" if known and near and cell.margin > 2 * limits.differs else "doubtful"
    if cell.margin < limits.holds:
        return "holds" if cell.distance < limits.foreign else "doubtful"
    if cell.margin < limits.differs or (cell.predicted in _MARKS and cell.other in f"{BLANK}.,-"):
        return "doubtful"
    # a blot is like nothing, another hand's digit like that of a known style
    return "differs" if cell.other_distance < limits.foreign or cell.hand else "doubtful"


def _retyped(cell: Cell, others: Sequence[Cell]) -> bool:
    """Whether a cell belongs to a reply that is another in several cells, or in a mark: one number
    can be typed in many ways, and what was typed never outranks what was printed."""
    several = sum(one.name == cell.name for one in others) > 1
    digits = cell.predicted.isdigit() and cell.other.isdigit()
    return cell.name.startswith("REPLY") and (several or not digits)


def _slight(cell: Cell) -> bool:
    """Whether a doubt leaves every digit beyond doubt: it is about a mark, a speck or a label. A
    digit that is like nothing on the page is in doubt, whatever it is least unlike."""
    if cell.lost and (not cell.name or cell.predicted in _MARKS):
        return True
    if not cell.name or cell.predicted == BLANK:
        return cell.margin < 0.5
    if cell.predicted in _MARKS and cell.other in _MARKS and cell.margin < 0.5:
        return True
    near = cell.predicted in _MARKS or cell.distance < THRESHOLDS.foreign
    return near and not cell.hand and cell.margin < THRESHOLDS.holds
