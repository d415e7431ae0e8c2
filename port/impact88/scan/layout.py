"""Where the program's page lies on the grid: which line of print is which, and which cells hold
numbers. Blanks and inked cells decide; no character is read."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
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
VARIANTS = {
    line: (LINES[line], LINES[line].replace(" :", ": ").replace(",V", ", V").replace(",W", ", W"))
    for line in (0, 1)
}
"""Lines as the chapter has them, too."""
OPTIONAL = (0, 1, 10, 13, 14)
"""Lines that genuine pages lack: the prompts, the final spins where M = 4, rows of asterisks."""
ANGLES = 5
"""The line whose blanks people retype by eye."""
REPLY_LENGTHS, NUMBER_LENGTHS = (5, 42), (1, 15)
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

    def column(self, place: Place) -> int:
        """The column of a place."""
        return place.cell - self.margin + (WRAP if place.line > self.start else 0)


@dataclass
class Sheet:
    """One printout on the grid: its pieces and where they begin, by line of `LINES`."""

    pieces: dict[int, list[Piece]] = field(default_factory=dict)
    rows: dict[int, Row] = field(default_factory=dict)
    gain: float = 0.0

    @property
    def numbers(self) -> dict[str, Piece]:
        """The numbers and replies by name."""
        found = (piece for line in self.pieces.values() for piece in line)
        return {piece.name: piece for piece in found if piece.name}


@lru_cache
def parts(line: str) -> tuple[tuple[str, str], ...]:
    """A line of `LINES` as (name, text): one of the two is empty. A blank that begins a line is a
    part of its own, which the chapter leaves out."""
    found = re.findall(r"\{(\w+)\}|(^ | {2,}|[^{}]+)", line)
    return tuple((name, text) for name, text in found)


class _Fit(NamedTuple):
    gain: float
    text: str
    ends: tuple[int, ...]


def _fit(line: str, inked: Floats, blank: Floats) -> _Fit:
    """The best division of a row of cells into the parts of a line, and where each part ends.
    ``inked``, ``blank``: what each cell gains when taken for inked or blank, shape (cells,)."""
    cells = len(inked)
    filled, emptied = np.r_[0.0, np.cumsum(inked)], np.r_[0.0, np.cumsum(blank)]
    typed = np.r_[0.0, np.cumsum(np.maximum(inked, _BLANK_IN_REPLY))]
    best = np.full(cells + 1, -np.inf)
    best[0] = 0.0
    back: list[np.ndarray] = []
    for name, text in parts(line):
        new = np.full(cells + 1, -np.inf)
        came = np.zeros(cells + 1, int)
        gap = not name and not text.strip() and (len(text) > 1 or not back)
        if name or gap:
            least, most = NUMBER_LENGTHS if name else _GAPS if len(text) > 1 else (0, 1)
            run = emptied if gap else filled
            if name.startswith("REPLY"):
                (least, most), run = REPLY_LENGTHS, typed
            for length in range(least, min(most, cells) + 1):
                value = best[: cells + 1 - length] + run[length:] - run[: cells + 1 - length]
                better = value > new[length:]
                new[length:][better] = value[better]
                came[length:][better] = length
        else:
            size = len(text)
            if size <= cells:
                value = best[: cells + 1 - size].copy()
                for offset, char in enumerate(text):
                    row = blank if char == " " else inked
                    value += row[offset : offset + cells + 1 - size]
                new[size:] = value
                came[size:] = size
        back.append(came)
        best = new
    after = np.r_[np.cumsum(blank[::-1])[::-1], 0.0]
    total = best + after
    at = int(np.argmax(total))
    if not np.isfinite(total[at]):
        return _Fit(-np.inf, line, ())
    ends = [at]
    for came in reversed(back):
        ends.append(ends[-1] - int(came[ends[-1]]))
    return _Fit(float(total[at]), line, tuple(reversed(ends)))


def sheets_of(odds: Sequence[Floats], tops: Floats) -> list[Sheet]:
    """The printouts on a grid. ``odds``: for each line the log odds that each cell is inked;
    ``tops``: where the lines are, in pitches down the page."""
    first = _margin(odds)
    candidates = [margin for margin in (first, first - 1, first - 2, first + 1) if margin >= -1]
    best: tuple[float, list[Sheet]] = (-np.inf, [])
    for margin in candidates:
        gain, sheets = _laid_at(odds, tops, margin)
        if gain > best[0] + 1e-9:
            best = (gain, sheets)
    return best[1]


def _margin(odds: Sequence[Floats]) -> int:
    """The cell that most lines begin in, or near it."""
    starts = [int(np.argmax(row > 0)) for row in odds if np.any(row > 0)]
    return int(np.bincount(starts).argmax()) if starts else 0


def _laid_at(odds: Sequence[Floats], tops: Floats, margin: int) -> tuple[float, list[Sheet]]:
    gains: dict[tuple[int, int, int], _Fit] = {}
    count = len(odds)
    rows = [row[margin:] if margin >= 0 else np.r_[np.zeros(-margin), row] for row in odds]
    before = [float(np.clip(row[: max(margin, 0)], 0, None).sum()) for row in odds]
    alone = [float(np.clip(row, 0, 6).sum()) for row in odds]
    for start in range(count):
        for used in (1, 2):
            if start + used > count or (used == 2 and tops[start + 1] - tops[start] > 3.2):
                continue
            row = rows[start]
            if used == 2:
                if len(row) < WRAP or np.any(row[WRAP:] > 2):
                    continue
                row = np.r_[row[:WRAP], rows[start + 1]]
            inked, blank = np.clip(row, -6, 6) / 2, -np.clip(row, 0, 6) / 2
            for line in range(len(LINES)):
                texts = VARIANTS.get(line, (LINES[line],))
                one = max((_fit(text, inked, blank) for text in texts), key=lambda fit: fit.gain)
                lost = sum(before[start : start + used]) + (_WRAPPED if used == 2 else 0)
                gains[start, used, line] = one._replace(gain=one.gain - lost)
    return _aligned(gains, count, margin, alone)


def _aligned(
    gains: dict[tuple[int, int, int], _Fit],
    count: int,
    margin: int,
    alone: Sequence[float],
) -> tuple[float, list[Sheet]]:
    """Lines of paper and lines of print side by side; after the last line of print may come the
    first of another printout."""
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
                    if j < last and (i, used, j) in gains:
                        steps.append((i + used, j + 1, now + gains[i, used, j].gain, used))
            for to_i, to_j, value, used in steps:
                if value > best[to_i, to_j]:
                    best[to_i, to_j] = value
                    back[to_i, to_j] = (i, j, used)
    ends = [j for j in (0, last) if np.isfinite(best[count, j])]
    if not ends:
        return -np.inf, []
    at = (count, max(ends, key=lambda j: float(best[count, j])))
    total = float(best[at])
    sheets: list[Sheet] = [Sheet()]
    while at in back:
        i, j, used = back[at]
        if (j, at[1]) == (last, 0):
            sheets.append(Sheet())
        elif used:
            fit = gains[i, used, j]
            sheets[-1].gain += fit.gain
            _place(sheets[-1], j, Row(i, used, margin, fit.text), fit.ends)
        at = (i, j)
    return total, [sheet for sheet in reversed(sheets) if len(sheet.numbers) >= _FEWEST]


def _place(sheet: Sheet, line: int, row: Row, ends: tuple[int, ...]) -> None:
    pieces = []
    for (name, text), begin, end in zip(parts(row.text), ends, ends[1:], strict=False):
        pieces.append(Piece(name, text, [row.place(column) for column in range(begin, end)]))
    sheet.pieces[line] = pieces
    sheet.rows[line] = row
