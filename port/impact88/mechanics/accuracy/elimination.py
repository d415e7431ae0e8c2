"""The listing's 6x6 equations in double precision, for comparison with the closed form.

`fill` sets up for many scenes the matrices of lines 370 to 560; `eliminate` is the listing's own
subroutine (lines 1000 to 1170) for one scene in whatever arithmetic its numbers have.
"""

from collections.abc import Mapping, Sequence
from functools import reduce
from operator import add
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...names import PIVOT

Array = NDArray[Any]

LISTING_PI = 3.14159265
"""The pi of line 300."""
VELOCITIES_OF_BOTH = ("UX", "UY", "VX", "VY", "WA", "WB")
"""The velocities before, in the order of the unknowns, `FINAL_VELOCITIES`."""


class Terms:
    """A scene's numbers ``g``, in whatever arithmetic, and lines 300 to 340 on them. How sines and
    sums are made of them its subclasses say."""

    def __init__(self, g: Mapping[str, Any], point: bool, pivot: bool, zero: Any) -> None:
        self.g, self.point, self.pivot, self.zero = g, point, pivot, zero
        self.s, self.c = self.turn(g["GA"])
        self.D1 = self.D2 = self.D3 = self.D4 = self.WA = self.WB = zero
        if not point:
            s, c = self.turn(g["TB"], g["PB"])
            self.D1, self.D2 = g["DB"] * s, g["DB"] * c
            s, c = self.turn(g["TA"], g["PA"])
            self.D3, self.D4 = g["DA"] * s, g["DA"] * c
            self.WA, self.WB = g["WA"], g["WB"]
        across = g["UX"], self.D3 * self.WA, -g["VX"], self.D1 * self.WB
        along = g["UY"], -(self.D4 * self.WA), -g["VY"], -(self.D2 * self.WB)
        self.gn = self.products(self.s, along, self.c, across)
        self.gt = self.products(self.c, along, -self.s, across)
        self.mu = g["MU"] if pivot else self.opposing(g["MU"], self.gt)

    def turn(self, *degrees: Any) -> tuple[Any, Any]:
        """Sine and cosine of a sum of angles."""
        raise NotImplementedError

    def products(self, a: Any, x: Sequence[Any], b: Any, y: Sequence[Any]) -> Any:
        return a * reduce(add, x) + b * reduce(add, y)

    def opposing(self, mu: Any, slip: Any) -> Any:
        """MU by the sign rule of line 400."""
        return -mu if slip > self.zero else mu

    def before(self) -> list[Any]:
        """The velocities before the impact, in the order of `FINAL_VELOCITIES`."""
        return [*(self.g[name] for name in VELOCITIES_OF_BOTH[:4]), self.WA, self.WB]


def listing_rows(t: Terms) -> list[list[Any]]:
    """The rows of lines 370 to 560 (6 of 7 numbers, or 4 of 5 for a point mass)."""
    g, s, c, zero = t.g, t.s, t.c, t.zero
    MA, MB = g["MA"], g["MB"]
    D1, D2, D3, D4 = t.D1, t.D2, t.D3, t.D4
    UX, UY, VX, VY, WA, WB = g["UX"], g["UY"], g["VX"], g["VY"], t.WA, t.WB
    if t.pivot:
        # DA*COS(PA+TA-GA) = D4 cos GA + D3 sin GA, and B likewise
        slip = [s, -c, -s, c, D4 * c + D3 * s, D2 * c + D1 * s, zero]
    else:
        fa, fb = MA * (c - t.mu * s), MB * (s + t.mu * c)
        slip = [zero, fa, fb, zero, zero, zero, fa * UY + fb * VX]
    rebound = [c, s, -c, -s, D3 * c - D4 * s, D1 * c - D2 * s, -g["E"] * t.gn]
    matrix = [
        [MA, zero, MB, zero, zero, zero, MA * UX + MB * VX],
        [zero, MA, zero, MB, zero, zero, MA * UY + MB * VY],
        slip,
        rebound,
    ]
    if t.point:
        return [row[:4] + row[6:] for row in matrix]
    IA, IB, EM = g["IA"], g["IB"], g["EM"]
    turn_a, turn_b = MA * (D2 + D4), MB * (D1 + D3)
    angular = turn_a * UY + turn_b * VX + IA * WA + IB * WB
    matrix.append([zero, turn_a, turn_b, zero, IA, IB, angular])
    moment = [-EM * MA * D3 / IA, EM * MA * D4 / IA, -EM * MB * D1 / IB, EM * MB * D2 / IB]
    before = moment[0] * UX + moment[1] * UY + moment[2] * VX + moment[3] * VY
    matrix.append([*moment, 2 * EM - 1, 1 - 2 * EM, before + EM * (WA - WB)])
    return matrix


class _Columns(Terms):
    """The terms of many scenes, as arrays."""

    def __init__(self, g: Mapping[str, Array], pi: float) -> None:
        self.pi = pi
        super().__init__(g, False, False, np.float64(0.0))

    def turn(self, *degrees: Array) -> tuple[Array, Array]:
        angle = sum(x * (self.pi / 180) for x in degrees)
        return np.sin(angle), np.cos(angle)

    def opposing(self, mu: Array, slip: Array) -> Array:
        return np.where(slip > 0, -mu, mu)


def fill(columns: Mapping[str, Any], pi: float = np.pi) -> tuple[Array, Array]:
    """The matrices (n, 6, 6) and right-hand sides (n, 6) of n scenes with M = 6.

    ``columns``: scene name -> array of shape (n,) or number. Where line 510 takes for a pivot what
    is none (MU below -10), this does not.
    """
    g = {name: np.asarray(value, dtype=np.float64) for name, value in columns.items()}
    t = _Columns(g, pi)
    rows = listing_rows(t)
    pivot = g["MU"] == PIVOT
    if pivot.any():
        t.pivot = True
        rows[2] = [np.where(pivot, x, y) for x, y in zip(listing_rows(t)[2], rows[2], strict=True)]
    shape = np.broadcast_shapes(*(v.shape for v in g.values()))
    A, b = np.zeros((*shape, 6, 6)), np.zeros((*shape, 6))
    for i, (*row, right) in enumerate(rows):
        b[:, i] = right
        for j, x in enumerate(row):
            if x is not t.zero:
                A[:, i, j] = x
    return A, b


def changes(columns: Mapping[str, Any], A: Array) -> tuple[Array, Array]:
    """Right-hand sides (n, 6) with which the matrices of `fill` give what the velocities *change*,
    and the velocities before (n, 6). They are small where a body is heavy; the listing's unknowns,
    the velocities themselves, then lose them."""
    b, before = np.zeros((2, len(A), 6))
    for i, name in enumerate(VELOCITIES_OF_BOTH):
        before[:, i] = columns[name]
    # gn and, of a pivot, gt are what rows 4 and 3 make of the velocities before
    approach, slip = (np.einsum("ij,ij->i", A[:, row], before) for row in (3, 2))
    b[:, 2] = np.where(np.asarray(columns["MU"]) == PIVOT, -slip, 0.0)
    b[:, 3] = -(1 + np.asarray(columns["E"])) * approach
    b[:, 5] = (1 - np.asarray(columns["EM"])) * (before[:, 4] - before[:, 5])
    return b, before


def lapack(A: Array, b: Array) -> Array:
    """The solutions (n, 6) by ``numpy.linalg.solve``; NaN throughout if LAPACK finds an exact zero
    pivot in any of the matrices (it then solves none)."""
    try:
        solution: Array = np.linalg.solve(A, b[..., np.newaxis])[..., 0]
    except np.linalg.LinAlgError:
        return np.full(b.shape, np.nan)
    return solution


def eliminate(A: list[list[Any]], smallest: Any) -> list[Any] | None:
    """The listing's elimination, statement by statement, on the rows ``A`` (M rows of M + 1).

    ``smallest``: line 1080's 1E-9. Returns the solution, None for ZERO DETERMINANT. The listing's
    ways are kept: no scaling, ties and the last pivot take the later row, the pivot is tested
    against an absolute 1E-9, and RX keeps its last value when a whole column is smaller, so that a
    row already used may be taken again.
    """
    A = [list(row) for row in A]
    M = len(A)
    RX = 0
    for J in range(M):
        MX = smallest
        for RO in range(J, M):
            # line 1090; RO * CO < M * M fails only in the last row of the last column
            if abs(MX) > abs(A[RO][J]) and (RO + 1) * (J + 1) < M * M:
                continue
            MX, RX = A[RO][J], RO
        if abs(A[RX][J]) < smallest:
            return None
        AP = A[RX][J]
        for OL in range(J, M + 1):
            A[J][OL], A[RX][OL] = A[RX][OL], A[J][OL]
            A[J][OL] = A[J][OL] / AP
        for RO in range(M):
            if RO == J:
                continue
            AR = A[RO][J]
            for CO in range(J, M + 1):
                A[RO][CO] = A[RO][CO] - A[J][CO] * AR
    return [row[M] for row in A]
