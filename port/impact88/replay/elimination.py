"""Lines 1000-1170 over arrays: the listing's elimination with its own pivot search.

All its oddities are kept: no scaling of rows; on a tie, and for the last pivot whatever its size, the
later row; pivots judged against an absolute 1E-9; and RX, the row to exchange with, keeping its last
value when a whole column is below that, even a row that is done already.

Columns J of the rows being eliminated are left out: A(I,J) / AP is exactly 1, and what line 1040
leaves in column J is never read again. (Not always zero: the ROM's multiplication by 1 can miss.)
With ``matrix`` they are computed too.
"""

from __future__ import annotations

import numpy as np

from ..applesoft import decimaltext as scalar
from .reals import Bools, Floats, Reals, compare, from_floats, from_number
from .unit import Ints, Unit, stamp

ZERO_DETERMINANT = 1
"""What `Unit.code` says for the listing's own END at line 1160, which is no error."""
DONE = stamp(570, 900)
"""The place after line 570's GOSUB 1000."""

C_1E_9 = from_number(scalar.read("1E-9")[0])


def solve(
    unit: Unit, A: dict[tuple[int, int], Reals], M: int, matrix: bool = False
) -> list[Reals]:
    """The solution, column M + 1, of the M equations in ``A``. Records zero determinants.

    With ``matrix``, ``A`` gets all elements as the program leaves them.
    """
    length = max(A[row, column].v.shape[-1] for row in range(1, M + 1) for column in range(1, M + 2))
    block = np.empty((M + 1, M + 2, length))
    block[0] = 0.0  # row 0 exists too, and RX is 0 as long as no pivot was found
    for row in range(1, M + 1):
        for column in range(1, M + 2):
            block[row, column] = A[row, column].v
    low = min(A[row, column].low for row in range(1, M + 1) for column in range(1, M + 2))
    high = max(A[row, column].high for row in range(1, M + 1) for column in range(1, M + 2))
    RX = np.zeros(length, np.int64)
    for J in range(1, M + 1):
        RX = _pivot_rows(block, J, M, RX)
        AP = np.take_along_axis(block[:, J], RX[np.newaxis], axis=0)[0]
        unit.at(1160, order=stamp(570, 100 * J))
        none = compare(Reals(np.abs(AP), unit, low, high, True), C_1E_9) > 0
        if none.any():
            unit.record(none, ZERO_DETERMINANT)
            AP[none] = 1.0
        _exchange(block, J, RX)
        unit.at(1150, order=stamp(570, 100 * J + 1))
        first = J if matrix else J + 1
        pivot_row = (
            Reals(block[J, first:], unit, low, high, True)
            / Reals(AP, unit, max(low, 2.0**-30), high, True, True)
        ).rounded()
        block[J, first:] = pivot_row.v
        rows = [row for row in range(1, M + 1) if row != J]
        unit.at(1040, order=stamp(570, 100 * J + 2))
        AR = Reals(block[rows, J, np.newaxis], unit, low, high, True)
        others = (Reals(block[rows, first:], unit, low, high, True) - pivot_row * AR).rounded()
        block[rows, first:] = others.v
        low, high = min(pivot_row.low, others.low), max(pivot_row.high, others.high)
    if matrix:
        for row in range(1, M + 1):
            for column in range(1, M + 2):
                A[row, column] = from_floats(block[row, column], unit, True)
    return [from_floats(block[row, M + 1], unit, True) for row in range(1, M + 1)]


def _pivot_rows(block: Floats, J: int, M: int, RX: Ints) -> Ints:
    """Lines 1080-1110: the row of the largest element on or below the diagonal, the later of equals.

    RX is left where nothing reaches 1E-9, but the very last element is always taken.
    """
    if J == M:
        return np.full_like(RX, M)
    largest = np.full(RX.shape, C_1E_9.rounded().v[0])
    for row in range(J, M + 1):
        size = np.abs(block[row, J])
        taken: Bools = largest <= size
        np.copyto(largest, size, where=taken)
        RX = np.where(taken, row, RX)
    return RX


def _exchange(block: Floats, J: int, RX: Ints) -> None:
    """Line 1140: exchange rows J and RX from column J on."""
    found = np.bincount(RX, minlength=1)
    for row in np.flatnonzero(found).tolist():
        if row == J:
            continue
        if found[row] == RX.size:
            block[[J, row], J:] = block[[row, J], J:]
            continue
        here = RX == row
        mine, theirs = block[J, J:], block[row, J:]
        exchanged = np.where(here, theirs, mine)
        block[row, J:] = np.where(here, mine, theirs)
        block[J, J:] = exchanged
