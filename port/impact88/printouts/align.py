"""Alignment of glyphs with cells of the page by dynamic programming (Needleman and Wunsch, 1970).

With s the cost of a glyph in a cell, a that of a glyph added after a cell and l that of a lost
cell, the least cost of having read i glyphs and passed j cells is

    D[i, j] = min(D[i-1, j-1] + s, D[i-1, j] + a, D[i, j-1] + l)

The costs are those of `costs`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .costs import ALIKE, FOREIGN, LOST, WRONG
from .glyphs import LOOKALIKES, Glyph
from .numerals import NUMBER_CHARS
from .page import Cell

Pair = tuple[int | None, int | None]
Costs = NDArray[np.int64]
SCALE = 1000
"""Costs are compared as whole numbers, so that the way back through the table is exact."""
_IN_NUMBERS = "".join(LOOKALIKES[char] for char in NUMBER_CHARS)


def glyph_cost(cell: Cell, char: str) -> float:
    """Return the cost of a character in a cell.

    Parameters
    ----------
    cell : Cell
        A place of the page.
    char : str
        The character that was read.

    Returns
    -------
    float
        The cost, 0 for the printed character, or for one of a number in a slot.
    """
    if cell.kind == "between":
        return FOREIGN + ALIKE * char.isdigit()  # a digit is rather a number's
    if cell.kind == "slot":
        if char in NUMBER_CHARS or (cell.name.startswith("REPLY") and char in ",;"):
            return 0.0
        return ALIKE if char in _IN_NUMBERS or char in "E+?" else WRONG
    if char == cell.char:
        return 0.0
    is_alike = char in LOOKALIKES.get(cell.char, "")
    return (ALIKE if is_alike else WRONG) + FOREIGN * (char in NUMBER_CHARS)


class Aligner:
    """Alignment with some cells of the page.

    Parameters
    ----------
    cells : sequence of Cell
        The cells, in the page's order.
    """

    def __init__(self, cells: Sequence[Cell]) -> None:
        self.cells = cells
        self.lost = [0 if cell.kind == "between" else round(SCALE * LOST) for cell in cells]
        self.lost_sums = np.cumsum([0, *self.lost])
        self.own_gaps = np.array([self._own_gap(j) for j in range(len(cells))], np.int64)
        self.added_gaps = np.array([self._added_gap(j) for j in range(-1, len(cells))], np.int64)
        self._costs: dict[str, tuple[Costs, Costs]] = {}

    def _own_gap(self, j: int) -> list[int]:
        """Return the cost of each width of gap before a glyph in a cell."""
        cell = self.cells[j]
        if cell.kind != "word":
            return [0, 0, 0, 0]
        if not cell.first:
            return [0, *[round(SCALE * ALIKE)] * 2, round(SCALE * WRONG)]
        is_behind_number = cell.char.isalpha() and j > 0 and self.cells[j - 1].kind == "slot"
        return [round(SCALE * FOREIGN) * is_behind_number, 0, 0, 0]

    def _added_gap(self, j: int) -> list[int]:
        """Return the cost of each width of gap before a glyph added after a cell."""
        if j < 0 or self.cells[j].kind != "slot":
            return [0, 0, 0, 0]
        if self.cells[j].name in ("ANGLES", "REPLY_A", "REPLY_B"):
            return [0, 0, 0, round(SCALE * FOREIGN)]
        return [0, *[round(SCALE * FOREIGN)] * 2, round(SCALE * WRONG)]

    def _costs_of(self, char: str) -> tuple[Costs, Costs]:
        """Return the costs of a character in each cell, and of it added after each."""
        if char not in self._costs:
            own = [glyph_cost(cell, char) for cell in self.cells]
            outside = FOREIGN + ALIKE * char.isdigit()
            added = [
                WRONG + ALIKE * char.isdigit() if cell.kind == "word" else cost
                for cell, cost in zip(self.cells, own, strict=True)
            ]
            added[-1] = min(added[-1], outside)
            self._costs[char] = (
                np.rint(SCALE * np.array(own)).astype(np.int64),
                np.rint(SCALE * np.array([FOREIGN, *added])).astype(np.int64),
            )
        return self._costs[char]

    def _pass_cells(self, row: Costs) -> Costs:
        """Return the costs of a row of the table with cells lost."""
        costs: Costs = np.minimum.accumulate(row - self.lost_sums) + self.lost_sums
        return costs

    def align(self, glyphs: Sequence[Glyph]) -> list[Pair]:
        """Return the cheapest alignment.

        Parameters
        ----------
        glyphs : sequence of Glyph
            What stands in the text.

        Returns
        -------
        list of pairs
            Index of a glyph and of its cell, in order; None for an added glyph's cell and for a
            lost cell's glyph.
        """
        table = np.empty((len(glyphs) + 1, len(self.cells) + 1), np.int64)
        first = np.full(len(self.cells) + 1, 10**6 * SCALE)
        first[0] = 0
        table[0] = self._pass_cells(first)
        for i, glyph in enumerate(glyphs):
            own, added = self._costs_of(glyph.char)
            row = table[i] + added + self.added_gaps[:, glyph.gap]
            np.minimum(row[1:], table[i, :-1] + own + self.own_gaps[:, glyph.gap], out=row[1:])
            table[i + 1] = self._pass_cells(row)
        return self._trace(table, glyphs)

    def _trace(self, table: Costs, glyphs: Sequence[Glyph]) -> list[Pair]:
        """Return the way back through the table."""
        pairs: list[Pair] = []
        i, j = len(glyphs), len(self.cells)
        while i or j:  # of ways of equal cost the one with the first cells
            if j and table[i, j - 1] + self.lost[j - 1] == table[i, j]:
                j -= 1
                pairs.append((None, j))
                continue
            i -= 1
            own, _ = self._costs_of(glyphs[i].char)
            step = own[j - 1] + self.own_gaps[j - 1, glyphs[i].gap]
            is_own = bool(j) and table[i, j - 1] + step == table[i + 1, j]
            j -= is_own
            pairs.append((i, j if is_own else None))
        return pairs[::-1]
