"""Lines 1000-1170 over arrays: the listing's elimination with its own pivot search.

All its oddities are kept: no scaling of rows; on a tie, and for the last pivot whatever its size,
the later row; pivots judged against an absolute 1E-9; and RX, the row to exchange with, keeping its
last value when a whole column is below that, even a row that is done already.

Columns J of the rows being eliminated are left out: A(I,J) / AP is exactly 1, and what line 1040
leaves in column J is never read again. (Not always zero: the ROM's multiplication by 1 can miss.)
With ``matrix`` they are computed too.

Elements known to be zero in every scene are left out as well: x - 0 * y and x - y * 0 are x, whose
extension is zero already, and 0 / AP is 0.
"""

from __future__ import annotations

import numpy as np

from ..applesoft import decimaltext as scalar
from .reals import Bools, Floats, Reals, compare, from_floats, from_number, select
from .unit import Ints, Unit, stamp

ZERO_DETERMINANT = 1
"""What `Unit.code` says for the listing's own END at line 1160, which is no error."""
DONE = stamp(570, 900)
"""The place after line 570's GOSUB 1000."""

NEAR_OVERFLOW = 2.0**120
C_1E_9 = from_number(scalar.read("1E-9")[0])


def solve(unit: Unit, A: dict[tuple[int, int], Reals], M: int, matrix: bool = False) -> list[Reals]:
    """The solution, column M + 1, of the M equations in ``A``. Records zero determinants.

    With ``matrix``, ``A`` gets all elements as the program leaves them.
    """
    places = [(row, column) for row in range(1, M + 1) for column in range(1, M + 2)]
    length = max(A[place].v.shape[-1] for place in places)
    block = np.zeros((M + 1, M + 2, length))  # row 0 is there too: RX is 0 until a pivot is found
    filled = np.zeros((M + 1, M + 2), bool)
    for place in places:
        block[place] = A[place].v
        filled[place] = A[place].high > 0
    low = min(A[place].low for place in places)
    high = max(A[place].high for place in places)
    RX = np.zeros(length, np.int64)
    for J in range(1, M + 1):
        RX = _pivot_rows(block, J, M, RX)
        AP = np.take_along_axis(block[:, J], RX[np.newaxis], axis=0)[0]
        unit.at(1160, order=stamp(570, 100 * J))
        none = compare(Reals(np.abs(AP), unit, low, high, True), C_1E_9) > 0
        if none.any():
            unit.record(none, ZERO_DETERMINANT)
            AP[none] = 1.0
        _exchange(block, filled, J, RX)
        # what column J becomes is known, and not looked at again; that it overflows is not known
        known = not matrix and high < NEAR_OVERFLOW
        columns = np.flatnonzero(filled[J, :] & (np.arange(M + 2) > J - (not known)))
        rows = np.flatnonzero(filled[:, J] & (np.arange(M + 1) != J))
        if not columns.size:
            continue
        unit.at(1150, order=stamp(570, 100 * J + 1))
        pivot_row = (
            Reals(block[J, columns], unit, low, high, True)
            / Reals(AP, unit, max(low, 2.0**-30), high, True, True)
        ).rounded()
        block[J, columns] = pivot_row.v
        low, high = min(low, pivot_row.low), max(high, pivot_row.high)
        if not rows.size:
            continue
        unit.at(1040, order=stamp(570, 100 * J + 2))
        if low < 2.0**-60:  # too low a bound to rule out underflow: look again
            low, high = _bounds(block[1:, J:], unit)
        corner = np.ix_(rows, columns)
        AR = Reals(block[rows, J, np.newaxis], unit, low, high, True)
        others = (Reals(block[corner], unit, low, high, True) - pivot_row * AR).rounded()
        block[corner] = others.v
        filled[corner] = True
        low, high = min(low, others.low), max(high, others.high)
    if matrix:
        for place in places:
            A[place] = from_floats(block[place], unit, True)
    return [from_floats(block[row, M + 1], unit, True) for row in range(1, M + 1)]


def solve_one_by_one(
    unit: Unit, A: dict[tuple[int, int], Reals], M: int, matrix: bool = False
) -> list[Reals]:
    """`solve`, an element at a time and every row of every column: for what takes each operation by
    itself. A scene whose pivot stays below 1E-9 is recorded, whatever RX would be there."""
    least = C_1E_9.rounded()
    for J in range(1, M + 1):
        if J < M:
            largest, taken = least, {}
            for row in range(J, M + 1):
                if A[row, J].high:
                    size = abs(A[row, J])
                    taken[row] = ~(size.v < largest.v)
                    largest = select(taken[row], size, largest)
                    for earlier in [other for other in taken if other < row]:
                        taken[earlier] = taken[earlier] & ~taken[row]
            for row in [row for row in taken if row > J]:
                for column in range(J, M + 2):
                    mine, theirs = A[J, column], A[row, column]
                    if mine.high or theirs.high:
                        A[J, column] = select(taken[row], theirs, mine)
                        A[row, column] = select(taken[row], mine, theirs)
        AP = A[J, J]
        unit.record(abs(AP).v < least.v, ZERO_DETERMINANT)
        for column in [column for column in range(J + 1, M + 2) if A[J, column].high]:
            A[J, column] = (A[J, column] / AP).rounded()
            for row in range(1, M + 1):
                if row != J and A[row, J].high:
                    product = A[J, column] * A[row, J]
                    A[row, column] = (A[row, column] - product).rounded()
    return [A[row, M + 1] for row in range(1, M + 1)]


def _bounds(part: Floats, unit: Unit) -> tuple[float, float]:
    """The least and the largest magnitude, zero apart."""
    values = from_floats(part, unit, True)
    return values.low, values.high


def _pivot_rows(block: Floats, J: int, M: int, RX: Ints) -> Ints:
    """Lines 1080-1110: the row of the largest element from the diagonal down, the later of equals.

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


def _exchange(block: Floats, filled: Bools, J: int, RX: Ints) -> None:
    """Line 1140: exchange rows J and RX from column J on.

    ``filled`` tells which elements may be other than zero: after a row is exchanged in some scenes
    only, what either row could hold.
    """
    counts = np.bincount(RX, minlength=1)
    for row in np.flatnonzero(counts).tolist():
        if row == J:
            continue
        if counts[row] == RX.size:
            block[[J, row], J:] = block[[row, J], J:]
            filled[[J, row], J:] = filled[[row, J], J:]
            continue
        chosen = row == RX
        mine, theirs = block[J, J:], block[row, J:]
        exchanged = np.where(chosen, theirs, mine)
        block[row, J:] = np.where(chosen, mine, theirs)
        block[J, J:] = exchanged
        filled[[J, row], J:] = filled[J, J:] | filled[row, J:]
