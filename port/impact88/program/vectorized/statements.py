"""The listing over arrays: lines 280 to 760 and 1000 to 1170, for a block of scenes of one `Kind`.

Each value is computed by the listing's own expression, operation by operation, in its order. Only
repetition is saved, where that cannot change a bit:

- sines and cosines that several lines use are computed once;
- MA * (COS (GA) - MU * SIN (GA)) of line 530 is A(3,2) of line 410: a left operand is rounded
  anyway, so storing it first changes nothing. Likewise UY - D4 * WA in line 540 is YA of line 340,
  and the sums of line 550 are A(5,2) and A(5,3);
- (-EM) * MA is the negative of EM * MA (the sign does not affect the mantissa), but a quotient is
  computed with its own sign, because the ROM's division can lose it;
- a value known to be zero in every scene costs nothing (`reals`).

The same code runs on arrays (`reals`) and on symbolic values that record it (`compiled`).
"""

from collections.abc import Mapping
from itertools import groupby
from typing import Any, NamedTuple

from ...apple.applesoft import decimaltext as scalar
from ...collision.fields import ANGLES, FIELDS
from .blockerrors import BlockErrors, stamp
from .polynomials import cos, sin, square
from .realcolumns import PLACES
from .reals import ZERO, Reals, constant, from_number, select

C_1E3 = from_number(scalar.read("1E3")[0])
C_1E4 = from_number(scalar.read("1E4")[0])
C_1E_9 = from_number(scalar.read("1E-9")[0]).rounded()
AG = (from_number(scalar.read("3.14159265")[0]) / 180).rounded()
"""Radians per degree, as line 300 computes them."""
MINUS_10 = constant(-10)

ZERO_DETERMINANT = 1  # `BlockErrors.code` of the END at line 1160, which is not an error
SOLVED = stamp(570, 900)  # the place after line 570's GOSUB 1000
NEAR_OVERFLOW = 2.0**120  # smaller numbers do not overflow in sums or when line 620 ff. floor them


class Kind(NamedTuple):
    """The kind of a block's scenes: the order M (6 or 4), and whether line 390 jumps (a pivot)."""

    M: int
    pivot: bool


ASSIGNED: dict[str, int] = {
    "KI": stamp(320),
    "XA": stamp(340, 1),
    "YA": stamp(340, 2),
    "XB": stamp(340, 3),
    "YB": stamp(340, 4),
    "MUP": stamp(*PLACES["MU"]),
    "VAX": SOLVED,
    "VAY": SOLVED,
    "VBX": SOLVED,
    "VBY": SOLVED,
    "WAF": SOLVED,
    "WBF": SOLVED,
    "KF": stamp(580),
    "LOSS": stamp(690, 2),
    "XAF": stamp(700, 1),
    "YAF": stamp(700, 2),
    "XBF": stamp(710, 1),
    "YBF": stamp(710, 2),
}
"""Result -> the place in the program that assigns it: a scene that got past it has the value."""

PRINTED: dict[str, int] = {
    field.name: stamp(line, position)
    for line, row in groupby(FIELDS.values(), key=lambda field: field.line)
    for position, field in enumerate(row)
}
"""Field of the printout -> its place: line, and position among the line's fields."""

_FACTORS = {2: constant(100), 3: C_1E3, 4: constant(10000)}
FLOORED: dict[str, Reals] = {
    field.name: _FACTORS[field.places]
    for field in FIELDS.values()
    if field.places and field.name != "LOSS"  # line 690's percentage is an expression of its own
}
"""Field -> the factor of its INT (factor * x) / factor."""


def run(
    errors: BlockErrors, scene: Mapping[str, Reals], kind: Kind, matrix: bool = False
) -> dict[str, Reals]:
    """Run lines 280 to 760 on a block and return its results by name.

    ``scene``: stored reals by the listing's names, without M; ``errors`` records the errors, after
    which a scene's values have no meaning; ``matrix``: also return the elements of A as the program
    leaves them, named "A(1,1)"."""
    # not split: the listing's lines in order, as in `program.listing`
    E, MU, EM, DA, DB = (scene[name] for name in ("E", "MU", "EM", "DA", "DB"))
    MA, MB, IA, IB = (scene[name] for name in ("MA", "MB", "IA", "IB"))
    UX, UY, WA, VX, VY, WB = (scene[name] for name in ("UX", "UY", "WA", "VX", "VY", "WB"))
    M, pivot = kind
    last = M + 1
    at = errors.at

    at(300)
    PA, PB, TA, TB, GA = (radians(scene[name]) for name in ANGLES)
    at(320)
    moving = MA * (square(UX) + square(UY)) + MB * (square(VX) + square(VY))
    KI = ((moving + IA * square(WA) + IB * square(WB)) / 2).rounded()
    at(330)
    TBPB, TAPA = TB + PB, TA + PA
    D1, D2 = (DB * sin(TBPB)).rounded(), (DB * cos(TBPB)).rounded()
    D3, D4 = (DA * sin(TAPA)).rounded(), (DA * cos(TAPA)).rounded()
    at(340, 1)
    XA = (UX + D3 * WA).rounded()
    at(340, 2)
    YA = (UY - D4 * WA).rounded()
    at(340, 3)
    d1wb = D1 * WB
    XB = (VX - d1wb).rounded()
    at(340, 4)
    d2wb = D2 * WB
    YB = (VY + d2wb).rounded()

    # 370, 380
    A = {(row, column): ZERO for row in range(1, 7) for column in range(1, 8)}
    A[1, 1] = A[2, 2] = MA
    A[1, 3] = A[2, 4] = MB

    SIN, COS = sin(GA), cos(GA)
    MUP = MU
    if not pivot:  # 390
        at(400)
        reverse = (XA * SIN - YA * COS) < (XB * SIN - YB * COS)
        if reverse.any():
            MUP = select(reverse, -MU, MU)
        at(410)
        A[3, 2] = (MA * (COS - MUP * SIN)).rounded()
        A[3, 3] = (MB * (SIN + MUP * COS)).rounded()
    else:
        A[3, 1], A[3, 2] = SIN.rounded(), -(COS.rounded())  # 430
        A[3, 3], A[3, 4] = -A[3, 1], -A[3, 2]
        at(440)
        A[3, 5] = (DA * cos(TAPA - GA)).rounded()
        A[3, 6] = (DB * cos(TBPB - GA)).rounded()

    A[4, 1], A[4, 2] = COS.rounded(), SIN.rounded()  # 450
    A[4, 3], A[4, 4] = -A[4, 1], -A[4, 2]
    at(460)
    A[4, 5] = (D3 * COS - D4 * SIN).rounded()
    A[4, 6] = (D1 * COS - D2 * SIN).rounded()
    at(470)
    A[5, 2], A[5, 3] = (MA * (D2 + D4)).rounded(), (MB * (D1 + D3)).rounded()
    A[5, 5], A[5, 6] = IA, IB
    at(480)
    product = EM * MA
    A[6, 1], A[6, 2] = (-product * D3 / IA).rounded(), (product * D4 / IA).rounded()
    product = EM * MB
    A[6, 3], A[6, 4] = (-product * D1 / IB).rounded(), (product * D2 / IB).rounded()
    at(490)
    A[6, 5], A[6, 6] = (2 * EM - 1).rounded(), (1 - 2 * EM).rounded()

    at(500)
    A[1, last], A[2, last] = (MA * UX + MB * VX).rounded(), (MA * UY + MB * VY).rounded()
    A[3, last] = ZERO if pivot else _line_530(errors, MUP, A[3, 2], A[3, 3], UY, VX)
    at(540)
    A[4, last] = (-E * ((YA - VY - d2wb) * SIN + (XA - VX + d1wb) * COS)).rounded()
    at(550)
    angular = (A[5, 2] * UY + A[5, 3] * VX + IA * WA + IB * WB).rounded()
    at(560)
    turning = -MA * D3 * UX / IA + MA * D4 * UY / IA - MB * D1 * VX / IB + MB * D2 * VY / IB
    A[6, last] = (EM * (turning + WA - WB)).rounded()
    A[5, last] = angular  # only now: for M = 4 it overwrites A(5,5) = IA

    eliminate(errors, A, M, matrix)  # 570
    V = [A[row, last] for row in range(1, 7)]  # for M = 4 lines 700 and 710 use rows 5 and 6, too

    at(580)
    moving = MA * (square(V[0]) + square(V[1])) + MB * (square(V[2]) + square(V[3]))
    KF = (moving / 2).rounded()
    results = {"KF580": KF}
    if M == 6:
        at(590)
        KF = (KF + (IA * square(V[4]) + IB * square(V[5])) / 2).rounded()

    # 600: the angles themselves are computed when printed
    for position, angle in enumerate((TA, TB, PA, PB, GA)):
        if angle.exceeds(NEAR_OVERFLOW):
            at(600, position)
            _ = (angle / AG).rounded()

    results |= {"KI": KI, "KF": KF, "XA": XA, "YA": YA, "XB": XB, "YB": YB, "MUP": MUP}
    for name in ("XA", "YA", "XB", "YB"):
        _check(errors, name, results[name])
    at(*_place("LOSS"))
    results["LOSS"] = printed_value("LOSS", KI, KF).rounded()

    final = {}
    at(700, 1)
    final["XAF"] = (V[0] + D3 * V[4]).rounded()
    at(700, 2)
    final["YAF"] = (V[1] - D4 * V[4]).rounded()
    at(710, 1)
    final["XBF"] = (V[2] - D1 * V[5]).rounded()
    at(710, 2)
    final["YBF"] = (V[3] + D2 * V[5]).rounded()
    final |= dict(zip(("VAX", "VAY", "VBX", "VBY", "WAF", "WBF"), V[:M], strict=False))
    for name, value in final.items():
        _check(errors, name, value)
    if matrix:
        results |= {f"A({row},{column})": value for (row, column), value in A.items()}
    return results | final


def eliminate(errors: BlockErrors, A: dict[tuple[int, int], Reals], M: int, matrix: bool) -> None:
    """Run lines 1000-1170: compute column M + 1 of ``A`` in place; with ``matrix`` all of A.

    All its oddities are kept, see `accuracy.elimination.eliminate`. Column J is skipped: A(J,J) /
    AP is exactly 1, and the elements that line 1040 leaves in column J are never read again, so
    they matter only if they overflow. (They are not always zero: the ROM's product by 1 can be
    inexact.)"""
    RX: dict[int, Any] = {}  # row -> the scenes in which RX is that row
    for J in range(1, M + 1):
        # 1080-1110
        RX = errors.drop_empty(RX) if J < M else {}
        largest = C_1E_9
        for row in range(J, M + 1) if J < M else ():
            if not A[row, J].zero:
                size = abs(A[row, J])
                is_larger = ~size.is_below(largest)
                largest = select(is_larger, size, largest)
                before = {row_before: scenes & ~is_larger for row_before, scenes in RX.items()}
                RX = before | {row: before[row] | is_larger if row in before else is_larger}
        # 1140
        for row, scenes in RX.items():
            if row == J or not scenes.any():
                continue
            for column in range(J, M + 2):
                mine, theirs = A[J, column], A[row, column]
                if not (mine.zero and theirs.zero):
                    A[J, column] = select(scenes, theirs, mine)
                    A[row, column] = select(scenes, mine, theirs)
        errors.at(1160, order=stamp(570, 100 * J))
        AP = A[J, J]
        is_singular = abs(AP).is_below(C_1E_9)
        if errors.record_error(is_singular, ZERO_DETERMINANT):
            AP = select(is_singular, constant(1), AP)
        cells = [A[row, column] for row in range(1, M + 1) for column in range(J, M + 2)]
        whole_matrix = matrix or any(x.exceeds(NEAR_OVERFLOW) for x in cells)
        first = J if whole_matrix else J + 1
        columns = [column for column in range(first, M + 2) if not A[J, column].zero]
        errors.at(1150, order=stamp(570, 100 * J + 1))
        for column in columns:
            A[J, column] = (A[J, column] / AP).rounded()
        errors.at(1040, order=stamp(570, 100 * J + 2))
        for row in [row for row in range(1, M + 1) if row != J and not A[row, J].zero]:
            AR = A[row, J]
            for column in columns:
                A[row, column] = (A[row, column] - A[J, column] * AR).rounded()


def _line_530(
    errors: BlockErrors, MU: Reals, A32: Reals, A33: Reals, UY: Reals, VX: Reals
) -> Reals:
    """Return A(3,M+1) of lines 510-530: 0, as for a pivot, if MU is -10 or less, which it also is
    after line 400 reversed a MU of 10."""
    like_pivot = ~(MU > MINUS_10)
    has_any = bool(like_pivot.any())
    errors.skip(like_pivot if has_any else None)
    errors.at(530)
    value = (A32 * UY + A33 * VX).rounded()
    errors.skip(None)
    return select(like_pivot, ZERO, value) if has_any else value


def radians(degrees: Reals) -> Reals:
    """Return angles in radians, by the multiplication of line 300."""
    return (degrees * AG).rounded()


def printed_value(name: str, x: Reals, KF: Reals | None = None) -> Reals:
    """Return the value that PRINT receives for a field, extension included.

    ``x``: the value of the field; for LOSS it is KI, and ``KF`` is given, too.
    """
    if KF is not None:
        return (C_1E4 * (x - KF) / x).floor() / 100
    if name in FLOORED:
        return (FLOORED[name] * x).floor() / FLOORED[name]
    return (radians(x) / AG).rounded() if name in ANGLES else x


def _place(name: str) -> tuple[int, int]:
    """Return the line that prints a field, and the position in it."""
    return divmod(PRINTED[name], 1000)


def _check(errors: BlockErrors, name: str, x: Reals) -> None:
    """Record an OVERFLOW of printing a velocity; its digits are computed on first use."""
    if x.exceeds(NEAR_OVERFLOW / 1e4):
        errors.at(*_place(name))
        printed_value(name, x)
