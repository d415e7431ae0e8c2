"""The program's page laid on the grid: which line of print is which, and which cells hold numbers.

Each cell has log odds of being inked (`Grid.odds`). A layout gains half the log odds of every cell
that it takes for inked, and loses half the log odds of an inked cell that it takes for blank; the
layout with the largest total gain is found by dynamic programming. No character is read.
"""

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
"""Lines as the chapter prints them, where they differ from `LINES`."""
SPACED = (4, 5)
"""The lines of the angles, whose blanks people retype by eye."""
REPLY_LENGTHS = (5, 42)  # characters: from ``0,0,0`` to three of the longest numbers
NUMBER_LENGTHS = (1, 15)  # characters of a number that the program prints
WRAP = 40
"""Columns of the Apple's screen, at which its lines break."""

# Penalties are in units of log odds; a line that is there gains about 3 for each inked cell.
_MISSING_LINE = 30.0  # for a printed line that is not on the paper
_STRANGE_LINE = 4.0  # for a line of the paper that is passed over, or taken for the rest of one
_BREAK_COLUMNS = 7
"""Columns before a line break, one of which is inked: the program prints no longer gap."""
_MIN_SEPARATION = 3
"""Blanks after a line behind which other text may stand."""
_TEXT_BEHIND = 12.0
"""Penalty for such text, whatever its length. It gains at most half of what the line itself gains,
so that no line is taken for an annex of five asterisks."""
_HOLE = -10.0
"""Gain of a clearly blank cell within a number, in which the program prints none; a faint character
costs as much as three letters that are missing."""
AS_GOOD = 12.0
"""Difference in gain, that of four inked cells, up to which two lines of print fit as well."""
_MIN_NUMBERS = 20
"""Numbers of a printout; with fewer it is not verified from the picture."""
_GAPS = (1, 14)  # blanks between angles; doubled, the verdicts of 5 pages stay
_CLEARLY_BLANK = -2.0  # half the log odds of a cell without any ink
_MIN_REPLY_GAIN = -0.3  # of a typed cell, blank or not; doubled, 5 verdicts of 5 stay


class Place(NamedTuple):
    """A character's place: line of the grid, cell."""

    line: int
    cell: int


class Piece(NamedTuple):
    """A part of a line: a label's text with its blanks, or a number (``name``), and its cells."""

    name: str
    text: str
    places: list[Place]


class Row(NamedTuple):
    """A line of print on the grid.

    Attributes
    ----------
    start : int
        Line of the grid in which it begins.
    used : int
        Lines of the grid that it takes: 1, or 2 for a line that was broken.
    margin : int
        Cell of its first column.
    text : str
        The line as it is written, one of `LINES` or `VARIANTS`.
    pieces : sequence of Piece
        Its parts.
    """

    start: int
    used: int
    margin: int
    text: str = ""
    pieces: Sequence[Piece] = ()

    @property
    def lines(self) -> range:
        """The lines of the grid that it takes."""
        return range(self.start, self.start + self.used)

    def place(self, column: int) -> Place:
        """Return the place of a column of the printed line."""
        if self.used == 2 and column >= WRAP:
            return Place(self.start + 1, column - WRAP + self.margin)
        return Place(self.start, column + self.margin)

    def cells(self, values: Sequence[Floats]) -> Floats:
        """Return values of the grid's cells by column of the printed line."""
        rows = values[self.start : self.start + self.used]
        first, *continuation = (
            row[self.margin :] if self.margin >= 0 else np.r_[0.0, row] for row in rows
        )
        return np.r_[first[:WRAP], continuation[0]] if continuation else first

    def column(self, place: Place) -> int:
        """Return the column of the printed line that stands at a place."""
        return place.cell - self.margin + (WRAP if place.line > self.start else 0)


@dataclass
class Sheet:
    """One printout on the grid: its rows by line of `LINES`, and their total gain."""

    rows: dict[int, Row] = field(default_factory=dict)
    gain: float = 0.0

    @property
    def whole(self) -> bool:
        """True if every line that a printout must have was found."""
        return all(line in self.rows for line in range(len(LINES)) if line not in MAY_BE_MISSING)

    def beyond(self, place: Place) -> bool:
        """Return True for a place to the right of the column at which lines are broken."""
        rows = self.rows.values()
        return any(row.used == 2 and place.cell >= row.margin + WRAP for row in rows)


@lru_cache
def parts(line: str) -> tuple[tuple[str, str], ...]:
    """Return the parts of a line of `LINES` as (name, text), one of which is empty.

    A blank that begins a line, which the chapter leaves out, is a part of its own.
    """
    matches = re.findall(r"\{(\w+)\}|(^ | {2,}|(?:[^{} ]| (?! ))+)", line)
    return tuple((name, text) for name, text in matches)


def _lengths(name: str, text: str, first: bool) -> tuple[int, int]:
    """Return the smallest and largest number of cells that a part takes."""
    if name:
        return REPLY_LENGTHS if name.startswith("REPLY") else NUMBER_LENGTHS
    if text.strip() or (len(text) == 1 and not first):
        return len(text), len(text)
    return _GAPS if len(text) > 1 else (0, 1)


def _division_gains(line: str, inked: Floats, blank: Floats) -> tuple[list[Floats], list[Floats]]:
    """Return the gains of dividing rows of cells into the parts of a line.

    Parameters
    ----------
    line : str
        A line of `LINES`.
    inked, blank : ndarray, shape (rows, cells)
        Gain of each cell if it is taken for inked, and for blank.

    Returns
    -------
    gains : list of ndarray, shape (rows, cells + 1)
        ``gains[n][row, k]`` is the largest gain with the first n parts in the first k cells; the
        last also has the gain of the cells behind k.
    part_sums : list of ndarray, shape (rows, cells + 1)
        For each part the cumulative gain of cells taken for it: a part of variable length in cells
        i to k gains ``part_sums[n][row, k] - part_sums[n][row, i]``.
    """
    rows, cells = inked.shape
    edge = np.zeros((rows, 1))
    solid = np.where(inked < _CLEARLY_BLANK, _HOLE, inked)
    number_sums, blank_sums, reply_sums = (
        np.hstack([edge, np.cumsum(values, axis=1)])
        for values in (solid, blank, np.maximum(inked, _MIN_REPLY_GAIN))
    )
    best = np.full((rows, cells + 1), -np.inf)
    best[:, 0] = 0.0
    gains, part_sums = [best], list[Floats]()
    for name, text in parts(line):
        sums = blank_sums if not name else reply_sums if name.startswith("REPLY") else number_sums
        shortest, longest = _lengths(name, text, first=not part_sums)
        extended = np.full_like(best, -np.inf)
        if shortest < longest:
            start = best - sums
            for length in range(shortest, min(longest, cells) + 1):
                part = extended[:, length:]
                np.maximum(part, start[:, : cells + 1 - length], out=part)
            extended += sums
        elif shortest <= cells:
            size = cells + 1 - shortest
            extended[:, shortest:] = best[:, :size]
            for offset, char in enumerate(text):
                extended[:, shortest:] += (blank if char == " " else inked)[
                    :, offset : offset + size
                ]
        best = extended
        gains.append(best)
        part_sums.append(sums)
    remainder = np.hstack([np.cumsum(blank[:, ::-1], axis=1)[:, ::-1], edge])
    text_behind = np.maximum(inked, blank)[:, ::-1].cumsum(axis=1)[:, ::-1]
    gap = blank_sums[:, _MIN_SEPARATION:] - blank_sums[:, :-_MIN_SEPARATION]
    half = np.maximum(best[:, : -_MIN_SEPARATION - 1], 0) / 2
    gap[:, :-1] += np.minimum(text_behind[:, _MIN_SEPARATION:], half)
    np.maximum(
        remainder[:, :-_MIN_SEPARATION], gap - _TEXT_BEHIND, out=remainder[:, :-_MIN_SEPARATION]
    )
    gains[-1] = best + remainder
    return gains, part_sums


def _pieces(row: Row, inked: Floats, blank: Floats) -> list[Piece]:
    """Return the parts of a line in the division of its cells with the largest gain."""
    gains, part_sums = _division_gains(row.text, inked[None], blank[None])
    stop, pieces = int(np.argmax(gains[-1])), list[Piece]()
    for number, (name, text) in reversed(list(enumerate(parts(row.text)))):
        shortest, longest = _lengths(name, text, first=not number)
        starts = np.arange(max(0, stop - longest), stop - shortest + 1)
        start = int(starts[np.argmax((gains[number] - part_sums[number])[0, starts])])
        pieces.append(Piece(name, text, [row.place(column) for column in range(start, stop)]))
        stop = start
    return pieces[::-1]


class LineFit(NamedTuple):
    """A line of print, by its number in `LINES`, that may stand in a row of cells; its gain."""

    gain: float
    line: int
    row: Row


@dataclass
class Layout:
    """The printouts on a grid.

    Attributes
    ----------
    sheets : list of Sheet
        The printouts, their rows in the program's order.
    """

    sheets: list[Sheet]
    _fits: "_Fits"
    _inked: Floats
    _blank: Floats

    def divided(self, key: "_Key") -> LineFit:
        """Return a line of print with its cells divided into its parts."""
        gain, at, row = self._fits[key]
        pieces = _pieces(row, self._inked[at], self._blank[at])
        return LineFit(gain, key[2], row._replace(pieces=pieces))

    def candidates(self, start: int, used: int) -> list[LineFit]:
        """Return the lines of print that may begin on a line of the grid and take ``used`` lines of
        it: those that gain anything there, and within `AS_GOOD` of the most."""
        gains = {key: fit[0] for key, fit in self._fits.items() if key[:2] == (start, used)}
        least = max(max(gains.values(), default=0.0) - AS_GOOD, 0.0)
        return [self.divided(key) for key, gain in gains.items() if gain > least]


def layout_of(odds: Sequence[Floats], tops: Floats) -> Layout:
    """Return the printouts on a grid.

    Each line of print is laid on each line of the grid, in a few margins, whole or broken in two;
    of the margins the one counts whose best sequence of lines gains most.

    Parameters
    ----------
    odds : sequence of ndarray
        For each line of the grid the log odds that each cell is inked.
    tops : ndarray
        Place of each line of the grid, in pitches down the page.
    """
    trials = _trials(odds, tops)
    width = max(len(cells) for _, cells in trials)
    odds_by_trial = np.stack([np.pad(cells, (0, width - len(cells))) for _, cells in trials])
    # what cells gain when they are taken for inked or blank
    inked_gains, blank_gains = np.clip(odds_by_trial, -6, 6) / 2, -np.clip(odds_by_trial, 0, 6) / 2
    ink_before = [np.r_[0.0, np.cumsum(np.clip(row, 0, None))] for row in odds]
    penalties = [
        sum(ink_before[line][max(row.margin, 0)] for line in row.lines)
        + _STRANGE_LINE * (row.used == 2)
        for row, _ in trials
    ]
    fits: dict[int, _Fits] = {row.margin: {} for row, _ in trials}
    for line in range(len(LINES)):
        variants = [LINES[line], *([VARIANTS[line]] if line in VARIANTS else [])]
        divisions = [_division_gains(text, inked_gains, blank_gains)[0] for text in variants]
        gains = np.stack([by_part[-1].max(axis=1) for by_part in divisions])
        for at, ((row, _), variant) in enumerate(zip(trials, gains.argmax(axis=0), strict=True)):
            gain = float(gains[variant, at] - penalties[at])
            fit = gain, at, row._replace(text=variants[variant])
            fits[row.margin][row.start, row.used, line] = fit
    line_ink = [float(np.clip(row, 0, 6).sum()) for row in odds]
    alignments = {margin: _assign_lines(fits[margin], line_ink) for margin in fits}
    margin = max(fits, key=lambda edge: alignments[edge][0])
    layout = Layout([], fits[margin], inked_gains, blank_gains)
    sheets = [Sheet()]
    for key in alignments[margin][1]:
        if key is None:
            sheets.append(Sheet())
            continue
        gain, line, row = layout.divided(key)
        sheets[-1].gain += gain
        sheets[-1].rows[line] = row
    layout.sheets = [
        sheet
        for sheet in sheets
        if sum(bool(piece.name) for row in sheet.rows.values() for piece in row.pieces)
        >= _MIN_NUMBERS
    ]
    return layout


def _trials(odds: Sequence[Floats], tops: Floats) -> list[tuple[Row, Floats]]:
    """Return the rows of cells on which each line of print is laid, with their log odds: each line
    of the grid from a few margins, by itself and with the next as a line that was broken."""
    # the cell that most lines begin in, or near it
    begins = [int(np.argmax(row > 0)) for row in odds if np.any(row > 0)]
    first = int(np.bincount(begins).argmax()) if begins else 0
    margins = [margin for margin in (first, first - 1, first - 2, first + 1) if margin >= -1]
    trials: list[tuple[Row, Floats]] = []
    for margin, start in product(margins, range(len(odds))):
        unbroken, broken = Row(start, 1, margin), Row(start, 2, margin)
        cells = unbroken.cells(odds)
        trials.append((unbroken, cells))
        has_next = start + 1 < len(odds) and 0 < tops[start + 1] - tops[start] <= 3.2
        is_full = len(cells) >= WRAP and np.any(cells[WRAP - _BREAK_COLUMNS : WRAP] > 0)
        if has_next and is_full and not np.any(cells[WRAP:] > 2):
            trials.append((broken, broken.cells(odds)))
    return trials


_Key = tuple[int, int, int]
_Fits = dict[_Key, tuple[float, int, Row]]
"""Gain, number of the trial, and row, by (line of the grid, lines taken, line of print)."""


def _assign_lines(fits: _Fits, line_ink: Sequence[float]) -> tuple[float, list[_Key | None]]:
    """Return the best assignment of lines of print to lines of paper, for one printout or several.

    Parameters
    ----------
    fits : dict
        Gain of each line of print on each line or two of the paper.
    line_ink : sequence of float
        Summed log odds of the inked cells of each line of the paper.

    Returns
    -------
    gain : float
        Total gain.
    keys : list
        Keys of the ``fits`` that are used, in order; None where another printout begins.
    """
    count, last = len(line_ink), len(LINES)
    # best[i, j]: i lines of the paper are used, j lines of the print are behind
    best = {(0, 0): (0.0, (0, 0), False)}
    for i in range(count + 1):
        for j in [*range(last + 1), 0]:  # once more from 0: a printout that ended begins another
            gain = best[i, j][0]
            steps = []
            if j == last:
                steps.append((i, 0, gain - 1.0, True))
            else:
                penalty = 0.5 if j in MAY_BE_MISSING else _MISSING_LINE
                steps.append((i, j + 1, gain - penalty, False))
            if i < count:
                unread = line_ink[i] * 0.5 if 0 < j < last else 0.0
                steps.append((i + 1, j, gain - _STRANGE_LINE - unread, False))
                steps += [
                    (i + taken, j + 1, gain + fits[i, taken, j][0], True)
                    for taken in (1, 2)
                    if (i, taken, j) in fits
                ]
            for to_i, to_j, value, is_match in steps:
                if (to_i, to_j) not in best or value > best[to_i, to_j][0]:
                    best[to_i, to_j] = value, (i, j), is_match
    at = max(((count, 0), (count, last)), key=lambda place: best[place][0])
    total, keys = best[at][0], list[_Key | None]()
    while at != (0, 0):
        _, before, is_match = best[at]
        if is_match:
            taken = at[0] - before[0]
            keys.append((before[0], taken, before[1]) if taken else None)
        at = before
    return total, keys[::-1]
