"""The listing over arrays: lines 280 to 760 and what each leaves behind, for a block of scenes.

The scenes of a block run the same statements: all with the same M, all pivots or none (`Kind`).
Each value is computed by the listing's own expression, operation by operation and in its order, so
every bit agrees. What is saved is repetition only, and only where it cannot change a bit:

- the sines and cosines, which several lines ask for, are computed once, and all together;
- MA * (COS (GA) - MU * SIN (GA)) of line 530 is A(3,2) of line 410: a left operand is rounded, so
  being stored first changes nothing. Likewise UY - D4 * WA in line 540 is YA of line 340, and the
  sums of line 550 are A(5,2) and A(5,3);
- (-EM) * MA is the negative of EM * MA (signs are apart from mantissas), but a quotient keeps its
  own sign, because the ROM's division can lose it;
- a value known to be zero in every scene costs nothing (`reals`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ..applesoft import decimaltext as scalar
from . import elimination, functions
from .columns import PLACES
from .reals import LARGEST, ZERO, Bools, Reals, constant, floor, from_number, select, stack
from .unit import Unit, stamp

C_1E3 = from_number(scalar.read("1E3")[0])
C_1E4 = from_number(scalar.read("1E4")[0])
AG = (from_number(scalar.read("3.14159265")[0]) / 180).rounded()
"""Line 300's radians per degree."""
C_2, C_100, C_10000, MINUS_10 = constant(2), constant(100), constant(10000), constant(-10)


class Kind(NamedTuple):
    """What the scenes of a block have in common: the order M, and whether line 390 jumps."""

    M: int
    pivot: bool


ASSIGNED: dict[str, int] = {
    **{"KI": stamp(320), "XA": stamp(340, 1), "YA": stamp(340, 2)},
    **{"XB": stamp(340, 3), "YB": stamp(340, 4), "MUP": stamp(*PLACES["MU"])},
    **dict.fromkeys(("VAX", "VAY", "VBX", "VBY", "WAF", "WBF"), elimination.DONE),
    **{"KF": stamp(580), "LOSS": stamp(690, 2), "XAF": stamp(700, 1), "YAF": stamp(700, 2)},
    **{"XBF": stamp(710, 1), "YBF": stamp(710, 2)},
}
"""Result -> the place in the program that sets it: a scene that got past it has the value."""

PRINTED: dict[str, int] = {
    **{name: stamp(620, i) for i, name in enumerate(("MA", "MB", "IA", "IB"))},
    **{name: stamp(630, i) for i, name in enumerate(("DA", "DB"))},
    **{name: stamp(650, i) for i, name in enumerate(("PA", "PB", "TA", "TB", "GA"))},
    **{name: stamp(660, i) for i, name in enumerate(("UX", "UY", "WA", "XA", "YA"))},
    **{name: stamp(670, i) for i, name in enumerate(("VX", "VY", "WB", "XB", "YB"))},
    **{name: stamp(680, i) for i, name in enumerate(("E", "MUP", "EM"))},
    **{name: stamp(690, i) for i, name in enumerate(("KI", "LOSS"))},
    **{name: stamp(730, i) for i, name in enumerate(("VAX", "VAY", "XAF", "YAF"))},
    **{name: stamp(740, i) for i, name in enumerate(("VBX", "VBY", "XBF", "YBF"))},
    **{name: stamp(760, i) for i, name in enumerate(("WAF", "WBF"))},
}
"""Field of the printout -> its place: line, and position among the line's fields."""

ANGLES = ("GA", "PA", "PB", "TA", "TB")
FLOORED: dict[str, Reals] = {
    **dict.fromkeys(("XA", "YA", "XB", "YB", "XAF", "YAF", "XBF", "YBF"), C_100),
    **dict.fromkeys(("VAX", "VAY", "VBX", "VBY"), C_1E3),
    **dict.fromkeys(("WAF", "WBF"), C_10000),
}
"""Field -> the factor of its INT (factor * x) / factor."""

Places = Sequence[tuple[int, int]]


def each(
    unit: Unit, places: Places, operation: Callable[..., Reals], *operands: Sequence[Reals]
) -> list[Reals]:
    """An operation on several rows of operands at once, each row at its own place in the program.

    What all scenes share (arrays of length 1) is kept apart from what each has of its own, and so
    computed once.
    """
    count = len(places)
    results = [ZERO] * count
    wide = [any(column[i].v.shape[-1] > 1 for column in operands) for i in range(count)]
    for rows in ([i for i in range(count) if wide[i]], [i for i in range(count) if not wide[i]]):
        if len(rows) == 1:
            (i,) = rows
            unit.at(*places[i])
            results[i] = operation(*(column[i] for column in operands))
        elif rows:
            unit.at_each([places[i] for i in rows])
            done = operation(*(stack([column[i] for i in rows], unit) for column in operands))
            for row, i in enumerate(rows):
                results[i] = done[row]
    return results


def _times(
    unit: Unit, places: Places, left: Sequence[Reals], right: Sequence[Reals]
) -> list[Reals]:
    """Products, leaving out the rows in which a factor is known to be zero."""
    rows = [i for i in range(len(places)) if left[i].high and right[i].high]
    done = each(
        unit,
        [places[i] for i in rows],
        Reals.__mul__,
        [left[i] for i in rows],
        [right[i] for i in rows],
    )
    results = [ZERO] * len(places)
    for i, product in zip(rows, done, strict=True):
        results[i] = product
    return results


def _squares(unit: Unit, places: Places, values: Sequence[Reals]) -> list[Reals]:
    """x ^ 2 of each, which is EXP (2 * LOG (x)); 0 ^ 2 is 0."""
    rows = [i for i in range(len(places)) if values[i].high]
    done = each(unit, [places[i] for i in rows], _square, [values[i] for i in rows])
    results = [ZERO] * len(places)
    for i, square in zip(rows, done, strict=True):
        results[i] = square
    return results


def _square(x: Reals) -> Reals:
    return functions.power(x, C_2)


def _over(unit: Unit, places: Places, left: Sequence[Reals], right: Sequence[Reals]) -> list[Reals]:
    """Quotients. A known zero is divided by itself apart, to find the divisors that are zero."""
    results = list(left)
    rows = [i for i in range(len(places)) if left[i].high]
    for i in range(len(places)):
        if not left[i].high:
            unit.at(*places[i])
            results[i] = left[i] / right[i]
    done = each(
        unit,
        [places[i] for i in rows],
        Reals.__truediv__,
        [left[i] for i in rows],
        [right[i] for i in rows],
    )
    for i, quotient in zip(rows, done, strict=True):
        results[i] = quotient
    return results


def _rounded(values: list[Reals]) -> list[Reals]:
    """Stored."""
    return [value.rounded() for value in values]


def radians(unit: Unit, angles: Sequence[Reals]) -> list[Reals]:
    """Line 300."""
    places = [(300, i) for i in range(len(angles))]
    return _rounded(_times(unit, places, angles, [AG] * len(angles)))


def run(
    unit: Unit, scene: Mapping[str, Reals], kind: Kind, matrix: bool = False
) -> dict[str, Reals]:
    """Run the listing on a block. ``scene``: stored reals by the listing's names, all but M.

    Returns the results by name, whatever failed on the way (``unit`` knows); with ``matrix`` also
    each element of A as the program leaves it, as "A(1,1)". Values are meaningless in a scene that
    did not get as far.
    """
    E, MU, EM, DA, DB = (scene[name] for name in ("E", "MU", "EM", "DA", "DB"))
    MA, MB, IA, IB = (scene[name] for name in ("MA", "MB", "IA", "IB"))
    UX, UY, WA, VX, VY, WB = (scene[name] for name in ("UX", "UY", "WA", "VX", "VY", "WB"))
    M, pivot = kind

    GA, PA, PB, TA, TB = radians(unit, [scene[name] for name in ANGLES])

    UX2, UY2, VX2, VY2, WA2, WB2 = _squares(unit, [(320, 0)] * 6, [UX, UY, VX, VY, WA, WB])
    unit.at(320)
    KI = ((MA * (UX2 + UY2) + MB * (VX2 + VY2) + IA * WA2 + IB * WB2) / 2).rounded()

    unit.at(330)
    B, A_ = TB + PB, TA + PA  # angles of the lines from the centers of gravity to the contact point
    turns = [B, B, A_, A_, GA, GA]
    places = [(330, 1), (330, 2), (330, 3), (330, 4), *[(430 if pivot else 400, 0)] * 2]
    shifted = [False, True, False, True, False, True]
    if pivot:
        unit.at(440)
        turns += [A_ - GA, B - GA]
        places += [(440, 1), (440, 2)]
        shifted += [True, True]
    for_cosine = each(
        unit,
        [place for place, cosine in zip(places, shifted, strict=True) if cosine],
        functions.shifted_for_cosine,
        [turn for turn, cosine in zip(turns, shifted, strict=True) if cosine],
    )
    turns = [
        for_cosine.pop(0) if cosine else turn for turn, cosine in zip(turns, shifted, strict=True)
    ]
    sin_b, cos_b, sin_a, cos_a, sin, cos, *pivot_cosines = each(unit, places, functions.sin, turns)
    D1, D2, D3, D4 = _rounded(
        _times(unit, places[:4], [DB, DB, DA, DA], [sin_b, cos_b, sin_a, cos_a])
    )

    places = [(340, i) for i in range(1, 5)]
    d3wa, d4wa, d1wb, d2wb = _times(unit, places, [D3, D4, D1, D2], [WA, WA, WB, WB])
    XA, YA, XB, YB = _contact(unit, places, (UX, UY, VX, VY), (d3wa, d4wa, d1wb, d2wb))

    A = {(row, column): ZERO for row in range(1, 7) for column in range(1, 8)}
    A[1, 1] = A[2, 2] = MA
    A[1, 3] = A[2, 4] = MB
    MUP = MU
    if not pivot:
        unit.at(400)
        MUP = _signed(MU, XA * sin - YA * cos < XB * sin - YB * cos)
        unit.at(410)
        A[3, 2] = (MA * (cos - MUP * sin)).rounded()
        A[3, 3] = (MB * (sin + MUP * cos)).rounded()
    else:
        A[3, 1], A[3, 2] = sin.rounded(), -(cos.rounded())
        A[3, 3], A[3, 4] = -A[3, 1], -A[3, 2]
        A[3, 5], A[3, 6] = _rounded(_times(unit, [(440, 1), (440, 2)], [DA, DB], pivot_cosines))
    A[4, 1], A[4, 2] = cos.rounded(), sin.rounded()
    A[4, 3], A[4, 4] = -A[4, 1], -A[4, 2]
    unit.at(460)
    A[4, 5] = (D3 * cos - D4 * sin).rounded()
    A[4, 6] = (D1 * cos - D2 * sin).rounded()
    unit.at(470)
    A[5, 2] = (MA * (D2 + D4)).rounded()
    A[5, 3] = (MB * (D1 + D3)).rounded()
    A[5, 5], A[5, 6] = IA, IB

    places = [(480, i) for i in range(1, 5)]
    em_a, em_b = _times(unit, [(480, 1), (480, 3)], [EM, EM], [MA, MB])
    A[6, 1], A[6, 2], A[6, 3], A[6, 4] = _rounded(
        _over(
            unit,
            places,
            _times(unit, places, [-em_a, em_a, -em_b, em_b], [D3, D4, D1, D2]),
            [IA, IA, IB, IB],
        )
    )
    unit.at(490)
    A[6, 5], A[6, 6] = (2 * EM - 1).rounded(), (1 - 2 * EM).rounded()

    last = M + 1
    unit.at(500)
    A[1, last] = (MA * UX + MB * VX).rounded()
    A[2, last] = (MA * UY + MB * VY).rounded()
    if pivot:
        A[3, last] = ZERO
    else:
        A[3, last] = _line_530(unit, MUP, A[3, 2], A[3, 3], UY, VX)
    unit.at(540)
    A[4, last] = (-E * ((YA - VY - d2wb) * sin + (XA - VX + d1wb) * cos)).rounded()
    unit.at(550)
    angular = (A[5, 2] * UY + A[5, 3] * VX + IA * WA + IB * WB).rounded()
    t1, t2, t3, t4 = _moments(unit, (-MA, MA, MB, MB), (D3, D4, D1, D2), (UX, UY, VX, VY), IA, IB)
    unit.at(560)
    A[6, last] = (EM * (t1 + t2 - t3 + t4 + WA - WB)).rounded()
    A[5, last] = angular

    solution = elimination.solve(unit, A, M, matrix)
    V = solution + [A[5, last], A[6, last]][M - 4 :]  # M = 4: what lines 700 and 710 find

    squares = _squares(unit, [(580, 0)] * 4 + [(590, 0)] * (M - 4), V[:M])
    unit.at(580)
    KF = ((MA * (squares[0] + squares[1]) + MB * (squares[2] + squares[3])) / 2).rounded()
    results = {"KF580": KF}
    if M == 6:
        unit.at(590)
        KF = (KF + (IA * squares[4] + IB * squares[5]) / 2).rounded()

    for name, angle in zip(ANGLES, (GA, PA, PB, TA, TB), strict=True):
        if angle.high / AG.low > LARGEST / 4:
            unit.at(600, ("TA", "TB", "PA", "PB", "GA").index(name))
            _ = (angle / AG).rounded()
    results |= {"KI": KI, "KF": KF, "XA": XA, "YA": YA, "XB": XB, "YB": YB, "MUP": MUP}
    for name in ("XA", "YA", "XB", "YB"):
        _check(unit, name, results[name])
    unit.at(*_place("LOSS"))
    results["LOSS"] = loss(KI, KF).rounded()

    places = [(700, 1), (700, 2), (710, 1), (710, 2)]
    turned = _times(unit, places, [D3, D4, D1, D2], [V[4], V[4], V[5], V[5]])
    final = dict(
        zip(("XAF", "YAF", "XBF", "YBF"), _contact(unit, places, V[:4], turned), strict=True)
    )
    final |= dict(zip(("VAX", "VAY", "VBX", "VBY", "WAF", "WBF"), V[:M], strict=False))
    for name, value in final.items():
        _check(unit, name, value)
    if matrix:
        results |= {f"A({row},{column})": value for (row, column), value in A.items()}
        results |= {"D1": D1, "D2": D2, "D3": D3, "D4": D4}
    return results | final


def _contact(
    unit: Unit, places: Places, velocities: Sequence[Reals], turned: Sequence[Reals]
) -> list[Reals]:
    """Lines 340 and 700-710: u + d3 w, v - d4 w; u - d1 w, v + d2 w."""
    d3, d4, d1, d2 = turned
    return _rounded(each(unit, places, Reals.__add__, velocities, [d3, -d4, -d1, d2]))


def _signed(MU: Reals, reverse: Bools) -> Reals:
    """Line 400's MU = -MU."""
    return select(reverse, -MU, MU) if reverse.any() else MU


def _line_530(unit: Unit, MU: Reals, A32: Reals, A33: Reals, UY: Reals, VX: Reals) -> Reals:
    """Lines 510-530: a MU of -10 or less, such as 10 made -10 by line 400, gets a pivot's 0."""
    like_pivot = ~(MU > MINUS_10)
    unit.at(530)
    some = bool(like_pivot.any())
    if some:
        unit.elsewhere = np.broadcast_to(like_pivot, unit.first.shape)
    value = (A32 * UY + A33 * VX).rounded()
    unit.elsewhere = None
    return select(like_pivot, ZERO, value) if some else value


def _moments(
    unit: Unit,
    masses: Sequence[Reals],
    arms: Sequence[Reals],
    velocities: Sequence[Reals],
    IA: Reals,
    IB: Reals,
) -> list[Reals]:
    """The terms of line 560, M * D * U / I."""
    places = [(560, 0)] * 4
    products = _times(unit, places, _times(unit, places, masses, arms), velocities)
    return _over(unit, places, products, [IA, IA, IB, IB])


def loss(KI: Reals, KF: Reals) -> Reals:
    """Line 690's kinetic energy loss in percent, as printed: its extension counts."""
    return floor(C_1E4 * (KI - KF) / KI) / 100


def floored(name: str, x: Reals) -> Reals:
    """INT (factor * x) / factor, as lines 660-760 print a velocity."""
    factor = FLOORED[name]
    return floor(factor * x) / factor


def _place(name: str) -> tuple[int, int]:
    return divmod(PRINTED[name], 1000)


def _check(unit: Unit, name: str, x: Reals) -> None:
    """Whether printing a velocity overflows. Its digits are worked out when asked for."""
    if x.high * FLOORED[name].high >= LARGEST / 4:
        unit.at(*_place(name))
        floored(name, x)
