"""Alignment of glyphs with cells of the page by dynamic programming (Needleman and Wunsch, 1970).

With s the cost of a glyph in a cell, a that of a glyph added after a cell and l that of a lost
cell, the least cost of having read i glyphs and passed j cells is

    D[i, j] = min(D[i-1, j-1] + s, D[i-1, j] + a, D[i, j-1] + l)

The costs are those of `costs`.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from .costs import ALIKE, UNPAIRED, WRONG
from .glyphs import LINE_GAP, LOOKALIKES, Glyph
from .numerals import NUMBER_CHARS
from .page import CELLS, MANY, Cell

Costs = NDArray[np.float64]
PLACES = 6
"""Decimal places to which costs are compared."""
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
        return UNPAIRED
    if cell.kind == "slot":
        if char in NUMBER_CHARS or (cell.name.startswith("REPLY") and char in ",;"):
            return 0.0
        return ALIKE if char in _IN_NUMBERS or char in "E+?" else WRONG
    if char == cell.char:
        return 0.0
    is_alike = char in LOOKALIKES.get(cell.char, "")
    return (ALIKE if is_alike else WRONG) + UNPAIRED * (char in NUMBER_CHARS)


@lru_cache(maxsize=500)
class Aligner:
    """Alignment with some cells of the page.

    Parameters
    ----------
    places : tuple of int
        The cells (`CELLS`), in the page's order.
    """

    def __init__(self, places: tuple[int, ...]) -> None:
        self.places = places
        self.cells = cells = [CELLS[j] for j in places]
        lost = [0.0 if cell.kind == "between" else UNPAIRED for cell in cells]
        self.lost_sums = np.cumsum([0.0, *lost])
        self.own_gaps = np.array([*map(_own_gaps, cells)]).reshape(-1, LINE_GAP + 1)
        self.added_gaps = np.array([[0.0] * 4, *map(_added_gaps, cells)])
        self._costs: dict[str, tuple[Costs, Costs]] = {}

    def _costs_of(self, char: str) -> tuple[Costs, Costs]:
        """Return the costs of a character in each cell, and of it added after each."""
        if char not in self._costs:
            costs = [glyph_cost(cell, char) for cell in self.cells]
            extra = [
                WRONG if cell.kind == "word" else cost
                for cell, cost in zip(self.cells, costs, strict=True)
            ]
            extra = [UNPAIRED, *extra]
            extra[-1] = min(extra[-1], UNPAIRED)
            self._costs[char] = np.array(costs), np.array(extra)
        return self._costs[char]

    def align(self, glyphs: Sequence[Glyph]) -> list[int]:
        """Return the cell of each glyph in the cheapest alignment.

        Parameters
        ----------
        glyphs : sequence of Glyph
            What is in the text.

        Returns
        -------
        list of int
            The cell of each glyph, also of those after the first of a slot; 0 for none.
        """
        row = self.lost_sums
        steps = []  # for each number of cells passed: that at the glyph, and whether it has a cell
        for glyph in glyphs:
            cell_costs, extra_costs = self._costs_of(glyph.char)
            own_row = np.append(np.inf, row[:-1] + cell_costs + self.own_gaps[:, glyph.gap])
            costs = (row + extra_costs + self.added_gaps[:, glyph.gap]).round(PLACES)
            is_own = own_row.round(PLACES) <= costs
            costs = (np.where(is_own, own_row, costs) - self.lost_sums).round(PLACES)
            least = np.minimum.accumulate(costs)
            is_less = np.append(True, costs[1:] < least[:-1])
            at = np.maximum.accumulate(np.where(is_less, np.arange(len(costs)), 0))
            steps.append((at.tolist(), is_own.tolist()))
            row = least + self.lost_sums
        places = []
        j = len(self.cells)
        for at, is_own in reversed(steps):
            j = at[j]
            is_placed = j and (is_own[j] or self.cells[j - 1].kind == "slot")
            places.append(self.places[j - 1] if is_placed else 0)
            j -= is_own[j]
        return places[::-1]


def _own_gaps(cell: Cell) -> list[float]:
    """Return the cost of each width of gap before a glyph in a cell."""
    if cell.kind != "word" or cell.first:
        return [0.0, 0.0, 0.0, 0.0]
    return [0.0, ALIKE, ALIKE, WRONG]


def _added_gaps(cell: Cell) -> list[float]:
    """Return the cost of each width of gap before a glyph added after a cell."""
    if cell.kind != "slot":
        return [0.0, 0.0, 0.0, 0.0]
    if cell.name in MANY:
        return [0.0, 0.0, 0.0, UNPAIRED]
    return [0.0, UNPAIRED, UNPAIRED, WRONG]
