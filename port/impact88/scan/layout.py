"""Where the program's page lies on the grid: which line of print is which, and which cells hold
numbers. Blanks and inked cells decide; no character is read."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from .ink import Floats

LINES = (
    "ENTER THE INITIAL VELOCITY COMPONENTS OF MA :Vax,Vay,Wa ?{REPLY_A}",
    "ENTER THE INITIAL VELOCITY COMPONENTS OF MB :Vbx,Vby,Wb ?{REPLY_B}",
    "MA= {MA} MB= {MB} IA= {IA} IB= {IB}",
    "DA= {DA} DB= {DB}",
    " PA PB TA TB GA",
    " {PA}      {PB}      {TA}      {TB}      {GA}",
    "UX= {UX} UY= {UY} WA= {WA} XA= {XA} YA= {YA}",
    "VX= {VX} VY= {VY} WB= {WB} XB= {XB} YB= {YB}",
    " E= {E} MU= {MUP} EM= {EM}",
    "INITIAL KE= {KI} KE LOSS= {LOSS} %",
    "*****",
    "VAX= {VAX} VAY= {VAY} (XA={XAF} YA= {YAF})",
    "VBX= {VBX} VBY= {VBY} (XB={XBF} YB= {YBF})",
    " WA= {WAF} WB= {WBF}",
    "*****",
)
"""Listing lines 200 to 770, as a person sees them."""
VARIANTS = {k: re.sub(",([VW])", r", \1", LINES[k].replace(" :", ": ")) for k in (0, 1)}
VARIANTS[4] = " PA      PB      TA      TB      GA"
"""Lines as the chapter has them, too."""
OPTIONAL = (0, 1, 10, 13, 14)
"""Lines that genuine pages lack: the prompts, the final spins where M = 4, rows of asterisks."""
SPACED = (4, 5)
"""The lines of the angles, whose blanks people retype by eye."""
REPLY_LENGTHS, NUMBER_LENGTHS = (5, 42), (1, 15)
"""Characters: from ``0,0,0`` to three of the longest numbers; of what the program prints."""
WRAP = 40
"""Columns of the Apple's screen, at which its lines break."""

_ABSENT, _STRANGE, _WRAPPED = 30.0, 4.0, 2.0
"""What it costs, in units of log odds, to miss a line, to pass over a line of the paper, and to
take two lines of it for one that was broken. A line that is there gains about 3 an inked cell."""
_FEWEST = 20
"""Numbers of a printout; with fewer lines it is not verified from the picture."""
_GAPS = (1, 14)
_BLANK_IN_REPLY = -0.3


class Place(NamedTuple):
    """A character's place: line of the grid, cell."""

    line: int
    cell: int


@dataclass
class Piece:
    """A label's text, blanks included, or a number (``name``), and where its characters stand."""

    name: str
    text: str
    places: list[Place]


class Row(NamedTuple):
    """Where a line of print begins: line of the grid, how many of its lines it takes, the cell of
    its first column, and the line as it is written."""

    start: int
    used: int
    margin: int
    text: str

    def place(self, column: int) -> Place:
        """Where a column of the printed line stands."""
        if self.used == 2 and column >= WRAP:
            return Place(self.start + 1, column - WRAP + self.margin)
        return Place(self.start, column + self.margin)

    def cells(self, values: Sequence[Floats]) -> Floats:
        """What is given for the grid's cells, by column of the printed line."""
        rows = values[self.start : self.start + self.used]
        first, *rest = (row[self.margin :] if self.margin >= 0 else np.r_[0.0, row] for row in rows)
        return np.r_[first[:WRAP], rest[0]] if rest else first

    def column(self, place: Place) -> int:
        """The column of a place."""
        return place.cell - self.margin + (WRAP if place.line > self.start else 0)


@dataclass
class Sheet:
    """One printout on the grid: its pieces and rows by line of `LINES`."""

    pieces: dict[int, list[Piece]] = field(default_factory=dict)
    rows: dict[int, Row] = field(default_factory=dict)
    gain: float = 0.0

    @property
    def whole(self) -> bool:
        """Whether every line that a printout must have was found."""
        return all(line in self.rows for line in range(len(LINES)) if line not in OPTIONAL)

    def beyond(self, place: Place) -> bool:
        """Whether a place is right of where this printout's lines are broken."""
        rows = self.rows.values()
        return any(row.used == 2 and place.cell >= row.margin + WRAP for row in rows)

    @property
    def numbers(self) -> dict[str, Piece]:
        """The numbers and replies by name."""
        found = (piece for line in self.pieces.values() for piece in line)
        return {piece.name: piece for piece in found if piece.name}


@lru_cache
def parts(line: str) -> tuple[tuple[str, str], ...]:
    """A line of `LINES` as (name, text): one of the two is empty. A blank that begins a line, which
    the chapter leaves out, is a part of its own."""
    found = re.findall(r"\{(\w+)\}|(^ | {2,}|(?:[^{} ]| (?! ))+)", line)
    return tuple((name, text) for name, text in found)


def _gains(line: str, inked: Floats, blank: Floats) -> tuple[Floats, list[Floats]]:
    """How well rows of cells divide into the parts of a line: the best gain of each row, and the
    gains after each part by the cell it ends before, each of shape (rows, cells + 1)."""
    rows, cells = inked.shape
    edge = np.zeros((rows, 1))
    filled, emptied, typed = (
        np.hstack([edge, np.cumsum(values, axis=1)])
        for values in (inked, blank, np.maximum(inked, _BLANK_IN_REPLY))
    )
    best = np.full((rows, cells + 1), -np.inf)
    best[:, 0] = 0.0
    after = [best]
    for name, text in parts(line):
        new = np.full_like(best, -np.inf)
        lengths = _lengths(name, text, first=len(after) == 1)
        if lengths:
            run = emptied if not name else typed if name.startswith("REPLY") else filled
            start = best - run
            for length in range(lengths[0], min(lengths[1], cells) + 1):
                part = new[:, length:]
                np.maximum(part, start[:, : cells + 1 - length], out=part)
            new += run
        elif len(text) <= cells:
            size = cells + 1 - len(text)
            value = best[:, :size].copy()
            for offset, char in enumerate(text):
                value += (blank if char == " " else inked)[:, offset : offset + size]
            new[:, len(text) :] = value
        best = new
        after.append(best)
    rest = np.hstack([np.cumsum(blank[:, ::-1], axis=1)[:, ::-1], edge])
    after.append(best + rest)
    return after[-1].max(axis=1), after


def _lengths(name: str, text: str, first: bool) -> tuple[int, int] | None:
    """The least and most cells of a part; None where it has as many as its text."""
    if name:
        return REPLY_LENGTHS if name.startswith("REPLY") else NUMBER_LENGTHS
    if text.strip() or (len(text) == 1 and not first):
        return None
    return _GAPS if len(text) > 1 else (0, 1)


def _ends(line: str, inked: Floats, blank: Floats) -> list[int]:
    """Where the parts of a line end in the best division of one row of cells."""
    _, after = _gains(line, inked[None], blank[None])
    ends = [int(np.argmax(after[-1][0]))]
    cuts = [np.r_[0.0, np.cumsum(v)] for v in (inked, blank, np.maximum(inked, _BLANK_IN_REPLY))]
    for which, (name, text) in reversed(list(enumerate(parts(line)))):
        at, before = ends[-1], after[which][0]
        lengths = _lengths(name, text, first=which == 0) or (len(text), len(text))
        run = cuts[1 if not name else 2 if name.startswith("REPLY") else 0]
        starts = np.arange(max(0, at - lengths[1]), at - lengths[0] + 1)
        ends.append(int(starts[np.argmax(before[starts] - run[starts])]))
    return ends[::-1]


def sheets_of(odds: Sequence[Floats], tops: Floats) -> list[Sheet]:
    """The printouts on a grid. ``odds``: for each line the log odds that each cell is inked;
    ``tops``: where the lines are, in pitches down the page."""
    # the cell that most lines begin in, or near it
    begins = [int(np.argmax(row > 0)) for row in odds if np.any(row > 0)]
    first = int(np.bincount(begins).argmax()) if begins else 0
    margins = [margin for margin in (first, first - 1, first - 2, first + 1) if margin >= -1]
    keys, rows = [], []
    for margin in margins:
        for start in range(len(odds)):
            keys.append((margin, start, 1))
            whole = Row(start, 1, margin, "").cells(odds)
            rows.append(whole)
            followed = start + 1 < len(odds) and tops[start + 1] - tops[start] <= 3.2
            if followed and len(whole) >= WRAP and not np.any(whole[WRAP:] > 2):
                keys.append((margin, start, 2))
                rows.append(Row(start, 2, margin, "").cells(odds))
    width = max(map(len, rows))
    padded = np.stack([np.pad(row, (0, width - len(row))) for row in rows])
    # what cells gain when they are taken for inked or blank
    inked, blank = np.clip(padded, -6, 6) / 2, -np.clip(padded, 0, 6) / 2
    before = [np.r_[0.0, np.cumsum(np.clip(row, 0, None))] for row in odds]
    lost = [
        sum(before[at][max(margin, 0)] for at in range(start, start + used))
        + _WRAPPED * (used == 2)
        for margin, start, used in keys
    ]
    fits: dict[int, dict[tuple[int, int, int], tuple[float, str]]]
    fits = {margin: {} for margin in margins}
    for line in range(len(LINES)):
        texts = [LINES[line], *([VARIANTS[line]] if line in VARIANTS else [])]
        gains = np.stack([_gains(text, inked, blank)[0] for text in texts])
        which = gains.argmax(axis=0)
        for row, (margin, start, used) in enumerate(keys):
            gain = float(gains[which[row], row] - lost[row])
            fits[margin][start, used, line] = gain, texts[which[row]]
    alone = [float(np.clip(row, 0, 6).sum()) for row in odds]
    aligned = {m: _aligned(fits[m], len(odds), alone) for m in margins}
    margin = max(margins, key=lambda one: aligned[one][0])
    sheets = [Sheet()]
    for start, used, line in aligned[margin][1]:
        if used == 0:
            sheets.append(Sheet())
            continue
        gain, text = fits[margin][start, used, line]
        row = keys.index((margin, start, used))
        sheets[-1].gain += gain
        laid = sheets[-1].rows[line] = Row(start, used, margin, text)
        ends = pairwise(_ends(text, inked[row], blank[row]))
        sheets[-1].pieces[line] = [
            Piece(*part, [laid.place(column) for column in range(*span)])
            for part, span in zip(parts(text), ends, strict=True)
        ]
    return [sheet for sheet in sheets if len(sheet.numbers) >= _FEWEST]


def _aligned(
    fits: dict[tuple[int, int, int], tuple[float, str]], count: int, alone: Sequence[float]
) -> tuple[float, list[tuple[int, int, int]]]:
    """Lines of paper and lines of print side by side, one printout or several: the total gain, and
    the lines found: line of the grid, how many of them it takes (0: another printout begins), line
    of print."""
    last = len(LINES)
    # best[i][j]: i lines of the paper are used, j lines of the print are behind
    best = np.full((count + 1, last + 1), -np.inf)
    back: dict[tuple[int, int], tuple[int, int, int]] = {}
    best[0, 0] = 0.0
    for i in range(count + 1):
        for j in [*range(last + 1), 0]:  # once more from 0: a printout that ended begins another
            now = best[i, j]
            if not np.isfinite(now):
                continue
            steps = []
            if j == last:
                steps.append((i, 0, now - 1.0, 0))
            else:
                steps.append((i, j + 1, now - (0.5 if j in OPTIONAL else _ABSENT), 0))
            if i < count:
                lost = alone[i] * 0.5 if 0 < j < last else 0.0
                steps.append((i + 1, j, now - _STRANGE - lost, 0))
                for used in (1, 2):
                    if j < last and (i, used, j) in fits:
                        steps.append((i + used, j + 1, now + fits[i, used, j][0], used))
            for to_i, to_j, value, used in steps:
                if value > best[to_i, to_j]:
                    best[to_i, to_j] = value
                    back[to_i, to_j] = (i, j, used)
    ends = [j for j in (0, last) if np.isfinite(best[count, j])]
    if not ends:
        return -np.inf, []
    at = (count, max(ends, key=lambda j: float(best[count, j])))
    total, found = float(best[at]), []
    while at in back:
        i, j, used = back[at]
        if (j, at[1]) == (last, 0) or used:
            found.append((i, used, j))
        at = (i, j)
    return total, found[::-1]
