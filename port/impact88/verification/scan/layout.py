"""Where the program's page lies on the grid: which line of print is which, and which cells hold
numbers. Blanks and inked cells decide; no character is read."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import product
from typing import NamedTuple

import numpy as np

from ..reading.alignment import LINES, MAY_BE_MISSING
from .ink import Floats

VARIANTS = {k: re.sub(",([VW])", r", \1", LINES[k].replace(" :", ": ")) for k in (0, 1)}
VARIANTS[4] = " PA      PB      TA      TB      GA"
"""Lines as the chapter has them, too."""
SPACED = (4, 5)
"""The lines of the angles, whose blanks people retype by eye."""
REPLY_LENGTHS, NUMBER_LENGTHS = (5, 42), (1, 15)
"""Characters: from ``0,0,0`` to three of the longest numbers; of what the program prints."""
WRAP = 40
"""Columns of the Apple's screen, at which its lines break."""

_ABSENT, _STRANGE, _WRAPPED = 30.0, 4.0, 2.0
"""What it costs, in units of log odds, to miss a line, to pass over a line of the paper, and to
take two lines of it for one that was broken. A line that is there gains about 3 an inked cell."""
_LAST = 7
"""Columns before the break of which one is inked: the program prints no longer gap."""
_APART, _BESIDE = 3, 12.0
"""Blanks after a line behind which other text may stand, and what that costs, whatever its length;
it is explained as far as half of what the line itself is: no line is taken for an annex of five
asterisks."""
_HOLE = -10.0
"""Log odds of a clearly blank cell within a number, in which the program prints none; a faint
character costs as much as three letters that are missing."""
_FEWEST = 20
"""Numbers of a printout; with fewer lines it is not verified from the picture."""
_GAPS = (1, 14)  # blanks between angles; doubled, the verdicts of 5 pages stay
_CLEARLY = -2.0  # log odds, halved, of a cell without any ink
_BLANK_IN_REPLY = -0.3  # log odds at least of a typed cell; doubled, 5 verdicts of 5 stay


class Place(NamedTuple):
    """A character's place: line of the grid, cell."""

    line: int
    cell: int


class Piece(NamedTuple):
    """A label's text, blanks included, or a number (``name``), and where its characters stand."""

    name: str
    text: str
    places: list[Place]


class Row(NamedTuple):
    """Where a line of print begins: line of the grid, how many of its lines it takes, the cell of
    its first column; the line as it is written, and its parts."""

    start: int
    used: int
    margin: int
    text: str = ""
    pieces: Sequence[Piece] = ()

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
    """One printout on the grid: its rows by line of `LINES`."""

    rows: dict[int, Row] = field(default_factory=dict)
    gain: float = 0.0

    @property
    def whole(self) -> bool:
        """Whether every line that a printout must have was found."""
        return all(line in self.rows for line in range(len(LINES)) if line not in MAY_BE_MISSING)

    def beyond(self, place: Place) -> bool:
        """Whether a place is right of where this printout's lines are broken."""
        rows = self.rows.values()
        return any(row.used == 2 and place.cell >= row.margin + WRAP for row in rows)


@lru_cache
def parts(line: str) -> tuple[tuple[str, str], ...]:
    """A line of `LINES` as (name, text): one of the two is empty. A blank that begins a line, which
    the chapter leaves out, is a part of its own."""
    found = re.findall(r"\{(\w+)\}|(^ | {2,}|(?:[^{} ]| (?! ))+)", line)
    return tuple((name, text) for name, text in found)


def _lengths(name: str, text: str, first: bool) -> tuple[int, int]:
    """The least and most cells of a part."""
    if name:
        return REPLY_LENGTHS if name.startswith("REPLY") else NUMBER_LENGTHS
    if text.strip() or (len(text) == 1 and not first):
        return len(text), len(text)
    return _GAPS if len(text) > 1 else (0, 1)


def _divided(line: str, inked: Floats, blank: Floats) -> tuple[list[Floats], list[Floats]]:
    """Rows of cells divided into the parts of a line: the best gains before and after each part by
    the cell it ends before, the last with the rest of the row; and what a part of any length gains
    up to each cell. Each of shape (rows, cells + 1)."""
    rows, cells = inked.shape
    edge = np.zeros((rows, 1))
    whole = np.where(inked < _CLEARLY, _HOLE, inked)
    filled, emptied, typed = (
        np.hstack([edge, np.cumsum(values, axis=1)])
        for values in (whole, blank, np.maximum(inked, _BLANK_IN_REPLY))
    )
    best = np.full((rows, cells + 1), -np.inf)
    best[:, 0] = 0.0
    after, runs = [best], list[Floats]()
    for name, text in parts(line):
        run = emptied if not name else typed if name.startswith("REPLY") else filled
        least, most = _lengths(name, text, first=not runs)
        new = np.full_like(best, -np.inf)
        if least < most:
            start = best - run
            for length in range(least, min(most, cells) + 1):
                part = new[:, length:]
                np.maximum(part, start[:, : cells + 1 - length], out=part)
            new += run
        elif least <= cells:
            size = cells + 1 - least
            new[:, least:] = best[:, :size]
            for offset, char in enumerate(text):
                new[:, least:] += (blank if char == " " else inked)[:, offset : offset + size]
        best = new
        after.append(best)
        runs.append(run)
    rest = np.hstack([np.cumsum(blank[:, ::-1], axis=1)[:, ::-1], edge])
    if cells > _APART:
        other = np.maximum(inked, blank)[:, ::-1].cumsum(axis=1)[:, ::-1]
        gap = emptied[:, _APART:] - emptied[:, :-_APART]
        half = np.maximum(best[:, : -_APART - 1], 0) / 2
        gap[:, :-1] += np.minimum(other[:, _APART:], half)
        np.maximum(rest[:, :-_APART], gap - _BESIDE, out=rest[:, :-_APART])
    after[-1] = best + rest
    return after, runs


def _pieces(row: Row, inked: Floats, blank: Floats) -> list[Piece]:
    """The parts of a line in the best division of its cells."""
    after, runs = _divided(row.text, inked[None], blank[None])
    stop, pieces = int(np.argmax(after[-1])), list[Piece]()
    for which, (name, text) in reversed(list(enumerate(parts(row.text)))):
        least, most = _lengths(name, text, first=not which)
        starts = np.arange(max(0, stop - most), stop - least + 1)
        start = int(starts[np.argmax((after[which] - runs[which])[0, starts])])
        pieces.append(Piece(name, text, [row.place(column) for column in range(start, stop)]))
        stop = start
    return pieces[::-1]


def sheets_of(odds: Sequence[Floats], tops: Floats) -> list[Sheet]:
    """The printouts on a grid. ``odds``: for each line the log odds that each cell is inked;
    ``tops``: where the lines are, in pitches down the page."""
    # the cell that most lines begin in, or near it
    begins = [int(np.argmax(row > 0)) for row in odds if np.any(row > 0)]
    first = int(np.bincount(begins).argmax()) if begins else 0
    margins = [margin for margin in (first, first - 1, first - 2, first + 1) if margin >= -1]
    tried: list[tuple[Row, Floats]] = []
    for margin, start in product(margins, range(len(odds))):
        whole, broken = Row(start, 1, margin), Row(start, 2, margin)
        cells = whole.cells(odds)
        tried.append((whole, cells))
        followed = start + 1 < len(odds) and tops[start + 1] - tops[start] <= 3.2
        filled = len(cells) >= WRAP and np.any(cells[WRAP - _LAST : WRAP] > 0)
        if followed and filled and not np.any(cells[WRAP:] > 2):
            tried.append((broken, broken.cells(odds)))
    width = max(len(cells) for _, cells in tried)
    padded = np.stack([np.pad(cells, (0, width - len(cells))) for _, cells in tried])
    # what cells gain when they are taken for inked or blank
    inked, blank = np.clip(padded, -6, 6) / 2, -np.clip(padded, 0, 6) / 2
    left = [np.r_[0.0, np.cumsum(np.clip(row, 0, None))] for row in odds]
    lost = [
        sum(column[max(row.margin, 0)] for column in left[row.start : row.start + row.used])
        + _WRAPPED * (row.used == 2)
        for row, _ in tried
    ]
    fits: dict[int, _Fits] = {margin: {} for margin in margins}
    for line in range(len(LINES)):
        texts = [LINES[line], *([VARIANTS[line]] if line in VARIANTS else [])]
        gains = np.stack([_divided(text, inked, blank)[0][-1].max(axis=1) for text in texts])
        for at, ((row, _), which) in enumerate(zip(tried, gains.argmax(axis=0), strict=True)):
            gain = float(gains[which, at] - lost[at])
            fit = gain, at, row._replace(text=texts[which])
            fits[row.margin][row.start, row.used, line] = fit
    alone = [float(np.clip(row, 0, 6).sum()) for row in odds]
    aligned = {margin: _aligned(fits[margin], alone) for margin in margins}
    margin = max(margins, key=lambda edge: aligned[edge][0])
    sheets = [Sheet()]
    for key in aligned[margin][1]:
        if key is None:
            sheets.append(Sheet())
            continue
        gain, at, row = fits[margin][key]
        sheets[-1].gain += gain
        sheets[-1].rows[key[2]] = row._replace(pieces=_pieces(row, inked[at], blank[at]))
    return [
        sheet
        for sheet in sheets
        if sum(bool(piece.name) for row in sheet.rows.values() for piece in row.pieces) >= _FEWEST
    ]


_Key = tuple[int, int, int]
_Fits = dict[_Key, tuple[float, int, Row]]
"""By line of the grid, how many of its lines are taken, and line of print: the gain, and the row
with its place among those tried."""


def _aligned(fits: _Fits, alone: Sequence[float]) -> tuple[float, list[_Key | None]]:
    """Lines of paper and lines of print side by side, one printout or several: the total gain, and
    the lines found, None where another printout begins. ``alone``: how much ink a line has."""
    count, last = len(alone), len(LINES)
    # best[i, j]: i lines of the paper are used, j lines of the print are behind
    best = {(0, 0): (0.0, (0, 0), False)}
    for i in range(count + 1):
        for j in [*range(last + 1), 0]:  # once more from 0: a printout that ended begins another
            if (i, j) not in best:
                continue
            now = best[i, j][0]
            steps = []
            if j == last:
                steps.append((i, 0, now - 1.0, True))
            else:
                missed = 0.5 if j in MAY_BE_MISSING else _ABSENT
                steps.append((i, j + 1, now - missed, False))
            if i < count:
                lost = alone[i] * 0.5 if 0 < j < last else 0.0
                steps.append((i + 1, j, now - _STRANGE - lost, False))
                steps += [
                    (i + used, j + 1, now + fits[i, used, j][0], True)
                    for used in (1, 2)
                    if (i, used, j) in fits
                ]
            for to_i, to_j, value, told in steps:
                if (to_i, to_j) not in best or value > best[to_i, to_j][0]:
                    best[to_i, to_j] = value, (i, j), told
    at = max(((count, 0), (count, last)), key=lambda place: best[place][0])
    total, found = best[at][0], list[_Key | None]()
    while at != (0, 0):
        _, before, told = best[at]
        if told:
            used = at[0] - before[0]
            found.append((before[0], used, before[1]) if used else None)
        at = before
    return total, found[::-1]
