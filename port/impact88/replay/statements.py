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

import operator
from collections.abc import Callable, Mapping, Sequence
from itertools import groupby
from typing import NamedTuple

from ..applesoft import decimaltext as scalar
from ..fields import ANGLES, FIELDS
from . import pivoting, polynomials
from .realcolumns import PLACES
from .reals import LARGEST, ZERO, Reals, constant, floor, from_number, select, stack, zero
from .unit import Unit, stamp

C_1E3 = from_number(scalar.read("1E3")[0])
C_1E4 = from_number(scalar.read("1E4")[0])
AG = (from_number(scalar.read("3.14159265")[0]) / 180).rounded()
"""Line 300's radians per degree."""
C_1, C_100, C_10000, MINUS_10 = (
    constant(1),
    constant(100),
    constant(10000),
    constant(-10),
)


class Kind(NamedTuple):
    """What the scenes of a block have in common: the order M, and whether line 390 jumps."""

    M: int
    pivot: bool


ASSIGNED: dict[str, int] = {
    **{"KI": stamp(320), "XA": stamp(340, 1), "YA": stamp(340, 2)},
    **{"XB": stamp(340, 3), "YB": stamp(340, 4), "MUP": stamp(*PLACES["MU"])},
    **dict.fromkeys(("VAX", "VAY", "VBX", "VBY", "WAF", "WBF"), pivoting.DONE),
    **{"KF": stamp(580), "LOSS": stamp(690, 2), "XAF": stamp(700, 1), "YAF": stamp(700, 2)},
    **{"XBF": stamp(710, 1), "YBF": stamp(710, 2)},
}
"""Result -> the place in the program that sets it: a scene that got past it has the value."""

PRINTED: dict[str, int] = {
    field.name: stamp(line, position)
    for line, row in groupby(FIELDS.values(), key=lambda field: field.line)
    for position, field in enumerate(row)
}
"""Field of the printout -> its place: line, and position among the line's fields."""

_FACTORS = {2: C_100, 3: C_1E3, 4: C_10000}
FLOORED: dict[str, Reals] = {
    field.name: _FACTORS[field.places]
    for field in FIELDS.values()
    if field.places and field.name != "LOSS"  # line 690's percentage is an expression of its own
}
"""Field -> the factor of its INT (factor * x) / factor."""

Rows = Sequence[Reals]
Places = int | Sequence[tuple[int, int]]
"""Where rows are computed: a line for all of them, or a line and a position for each."""


def each(
    unit: Unit, where: Places, operation: Callable[..., Reals], *operands: Rows
) -> list[Reals]:
    """An operation on each row of operands, all rows computed together.

    What all scenes share (arrays of length 1) is kept apart from what each has of its own, and so
    computed once.
    """
    count = len(operands[0])
    if unit.one_by_one:
        return [operation(*(column[i] for column in operands)) for i in range(count)]
    places = [(where, 0)] * count if isinstance(where, int) else where
    results = [ZERO] * count
    lengths = [max(column[i].v.shape[-1] for column in operands) for i in range(count)]
    for shared in (False, True):
        rows = [i for i in range(count) if (lengths[i] == 1) == shared]
        if len(rows) == 1:
            (i,) = rows
            unit.at(*places[i])
            results[i] = operation(*(column[i] for column in operands))
        elif rows:
            unit.at_each([places[i] for i in rows])
            result = operation(*(stack([column[i] for i in rows], unit) for column in operands))
            for row, i in enumerate(rows):
                # a lone number, where a known zero decides: every row's
                results[i] = result[row] if result.v.ndim > 1 else result
    return results


def _some(
    unit: Unit, where: Places, operation: Callable[..., Reals], rows: list[int], *operands: Rows
) -> dict[int, Reals]:
    """`each`, of some rows only."""
    places = where if isinstance(where, int) else [where[i] for i in rows]
    chosen = [[column[i] for i in rows] for column in operands]
    return dict(zip(rows, each(unit, places, operation, *chosen), strict=True)) if rows else {}


def times(unit: Unit, where: Places, left: Rows, right: Rows) -> list[Reals]:
    """Products, leaving out the rows in which a factor is known to be zero."""
    rows = [i for i in range(len(left)) if left[i].high and right[i].high]
    computed = _some(unit, where, operator.mul, rows, left, right)
    return [computed.get(i) or zero(unit) for i in range(len(left))]


def plus(unit: Unit, where: Places, left: Rows, right: Rows) -> list[Reals]:
    """Sums, leaving out the rows in which a term is known to be zero."""
    rows = [i for i in range(len(left)) if left[i].high and right[i].high]
    computed = _some(unit, where, operator.add, rows, left, right)
    return _rest_one_by_one(unit, where, operator.add, computed, left, right)


def over(unit: Unit, where: Places, left: Rows, right: Rows) -> list[Reals]:
    """Quotients. Known zeros are divided one by one, to find the divisors that are zero."""
    rows = [i for i in range(len(left)) if left[i].high]
    computed = _some(unit, where, operator.truediv, rows, left, right)
    return _rest_one_by_one(unit, where, operator.truediv, computed, left, right)


def _rest_one_by_one(
    unit: Unit,
    where: Places,
    operation: Callable[..., Reals],
    done: Mapping[int, Reals],
    left: Rows,
    right: Rows,
) -> list[Reals]:
    """What has been done, in order, with the rows that have not, which may fail all the same."""
    results = []
    for i in range(len(left)):
        if i not in done:
            unit.at(*((where, 0) if isinstance(where, int) else where[i]))
        results.append(done[i] if i in done else operation(left[i], right[i]))
    return results


def squares(unit: Unit, where: Places, values: Rows) -> list[Reals]:
    """x ^ 2 of each, which is EXP (2 * LOG (x)); 0 ^ 2 is 0."""
    rows = [i for i in range(len(values)) if values[i].high]
    computed = _some(unit, where, polynomials.square, rows, values)
    return [computed.get(i) or zero(unit) for i in range(len(values))]


def stored(values: list[Reals]) -> list[Reals]:
    """As variables keep them: rounded."""
    return [value.rounded() for value in values]


def radians(unit: Unit, angles: Rows) -> list[Reals]:
    """Line 300."""
    places = [(300, i) for i in range(len(angles))]
    return stored(times(unit, places, angles, [AG] * len(angles)))


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
    last = M + 1

    # 300 GA = GA * AG: ...
    PA, PB, TA, TB, GA = radians(unit, [scene[name] for name in ANGLES])

    # 320 KI = (MA * (UX ^ 2 + UY ^ 2) + MB * (VX ^ 2 + VY ^ 2) + IA * (WA ^ 2) + IB * (WB ^ 2)) / 2
    UX2, UY2, VX2, VY2, WA2, WB2 = squares(unit, 320, [UX, UY, VX, VY, WA, WB])
    U2, V2 = plus(unit, 320, [UX2, VX2], [UY2, VY2])
    t1, t2, t3, t4 = times(unit, 320, [MA, MB, IA, IB], [U2, V2, WA2, WB2])
    KI = ((t1 + t2 + t3 + t4) / 2).rounded()

    # 330 D1 = DB * SIN (TB + PB):D2 = DB * COS (TB + PB):D3 = DA * SIN (TA + PA):D4 = ...
    TBPB, TAPA = plus(unit, 330, [TB, TA], [PB, PA])
    (sin_b, sin_a, sin), (cos_b, cos_a, cos, *pivot_cosines) = _turns(unit, TBPB, TAPA, GA, pivot)
    D1, D2, D3, D4 = stored(times(unit, 330, [DB, DB, DA, DA], [sin_b, cos_b, sin_a, cos_a]))

    # 340 XA = UX + D3 * WA:YA = UY - D4 * WA:XB = VX - D1 * WB:YB = VY + D2 * WB
    places = [(340, i) for i in range(1, 5)]
    d3wa, d4wa, d1wb, d2wb = times(unit, places, [D3, D4, D1, D2], [WA, WA, WB, WB])
    XA, YA, XB, YB = stored(plus(unit, places, [UX, UY, VX, VY], [d3wa, -d4wa, -d1wb, d2wb]))

    # 370 A(1,1) = MA:A(1,3) = MB: ... 380 A(2,2) = MA:A(2,4) = MB: ...
    A = {(row, column): ZERO for row in range(1, 7) for column in range(1, 8)}
    A[1, 1] = A[2, 2] = MA
    A[1, 3] = A[2, 4] = MB

    # 390 IF MU = -10 THEN 430
    MUP = MU
    if not pivot:
        # 400 IF (XA * SIN (GA) - YA * COS (GA)) < (XB * SIN (GA) - YB * COS (GA)) THEN MU = -MU
        t1, t2, t3, t4 = times(unit, 400, [XA, YA, XB, YB], [sin, cos, sin, cos])
        of_a, of_b = plus(unit, 400, [t1, t3], [-t2, -t4])
        reverse = of_a < of_b
        if reverse.any():
            MUP = select(reverse, -MU, MU)
        # 410 A(3,2) = MA * (COS (GA) - MU * SIN (GA)):A(3,3) = MB * (SIN (GA) + MU * COS (GA)): ...
        t1, t2 = times(unit, 410, [MUP, MUP], [sin, cos])
        t1, t2 = plus(unit, 410, [cos, sin], [-t1, t2])
        A[3, 2], A[3, 3] = stored(times(unit, 410, [MA, MB], [t1, t2]))
    else:
        # 430 A(3,1) = SIN (GA):A(3,2) = -COS (GA):A(3,3) = -A(3,1):A(3,4) = -A(3,2)
        A[3, 1], A[3, 2] = sin.rounded(), -(cos.rounded())
        A[3, 3], A[3, 4] = -A[3, 1], -A[3, 2]
        # 440 A(3,5) = DA * COS (PA + TA - GA):A(3,6) = DB * COS (PB + TB - GA)
        A[3, 5], A[3, 6] = stored(times(unit, 440, [DA, DB], pivot_cosines))

    # 450 A(4,1) = COS (GA):A(4,2) = SIN (GA):A(4,3) = -A(4,1):A(4,4) = -A(4,2)
    A[4, 1], A[4, 2] = stored([cos, sin])
    A[4, 3], A[4, 4] = -A[4, 1], -A[4, 2]
    # 460 A(4,5) = D3 * COS (GA) - D4 * SIN (GA):A(4,6) = D1 * COS (GA) - D2 * SIN (GA)
    t1, t2, t3, t4 = times(unit, 460, [D3, D4, D1, D2], [cos, sin, cos, sin])
    A[4, 5], A[4, 6] = stored(plus(unit, 460, [t1, t3], [-t2, -t4]))
    # 470 A(5,2) = MA * (D2 + D4):A(5,3) = MB * (D1 + D3):A(5,5) = IA:A(5,6) = IB: ...
    A[5, 2], A[5, 3] = stored(times(unit, 470, [MA, MB], plus(unit, 470, [D2, D1], [D4, D3])))
    A[5, 5], A[5, 6] = IA, IB
    # 480 A(6,1) = -EM * MA * D3 / IA:A(6,2) = EM * MA * D4 / IA:A(6,3) = -EM * MB * D1 / IB: ...
    em_a, em_b = times(unit, [(480, 1), (480, 3)], [EM, EM], [MA, MB])
    places = [(480, i) for i in range(1, 5)]
    products = times(unit, places, [-em_a, em_a, -em_b, em_b], [D3, D4, D1, D2])
    A[6, 1], A[6, 2], A[6, 3], A[6, 4] = stored(over(unit, places, products, [IA, IA, IB, IB]))
    # 490 A(6,5) = 2 * EM - 1:A(6,6) = 1 - 2 * EM
    unit.at(490)
    twice = 2 * EM
    A[6, 5], A[6, 6] = stored(plus(unit, 490, [twice, C_1], [-C_1, -twice]))

    # 500 A(1,M + 1) = MA * UX + MB * VX:A(2,M + 1) = MA * UY + MB * VY
    t1, t2, t3, t4 = times(unit, 500, [MA, MB, MA, MB], [UX, VX, UY, VY])
    A[1, last], A[2, last] = stored(plus(unit, 500, [t1, t3], [t2, t4]))
    A[3, last] = ZERO if pivot else _line_530(unit, MUP, A[3, 2], A[3, 3], UY, VX)
    # 540 A(4,M + 1) = -E * ((UY - D4 * WA - VY - D2 * WB) * SIN (GA)
    #                        + (UX + D3 * WA - VX + D1 * WB) * COS (GA))
    relative = plus(unit, 540, plus(unit, 540, [YA, XA], [-VY, -VX]), [-d2wb, d1wb])
    t1, t2 = times(unit, 540, relative, [sin, cos])
    A[4, last] = (-E * (t1 + t2)).rounded()
    # 550 A(5,M + 1) = MA * (D2 + D4) * UY + MB * (D1 + D3) * VX + IA * WA + IB * WB
    t1, t2, t3, t4 = times(unit, 550, [A[5, 2], A[5, 3], IA, IB], [UY, VX, WA, WB])
    angular = (t1 + t2 + t3 + t4).rounded()
    # 560 A(6,M + 1) = EM * (-MA * D3 * UX / IA + MA * D4 * UY / IA - MB * D1 * VX / IB
    #                        + MB * D2 * VY / IB + WA - WB)
    products = times(unit, 560, [-MA, MA, MB, MB], [D3, D4, D1, D2])
    products = times(unit, 560, products, [UX, UY, VX, VY])
    t1, t2, t3, t4 = over(unit, 560, products, [IA, IA, IB, IB])
    A[6, last] = (EM * (t1 + t2 - t3 + t4 + WA - WB)).rounded()
    A[5, last] = angular  # not before: of M = 4 it takes the place of IA

    # 570 GOSUB 1000
    eliminate = pivoting.solve_one_by_one if unit.one_by_one else pivoting.solve
    solution = eliminate(unit, A, M, matrix)
    V = solution + [A[5, last], A[6, last]][M - 4 :]  # M = 4: what lines 700 and 710 find

    # 580 KF = (MA * (A(1,M + 1) ^ 2 + A(2,M + 1) ^ 2) + MB * (A(3,M + 1) ^ 2 + A(4,M + 1) ^ 2)) / 2
    places = [(580, 0)] * 4 + [(590, 0)] * (M - 4)
    VAX2, VAY2, VBX2, VBY2, *spins = squares(unit, places, V[:M])
    t1, t2 = times(unit, 580, [MA, MB], plus(unit, 580, [VAX2, VBX2], [VAY2, VBY2]))
    KF = ((t1 + t2) / 2).rounded()
    results = {"KF580": KF}
    if M == 6:
        # 590 IF N = M THEN KF = KF + (IA * A(5,M + 1) ^ 2 + IB * A(6,M + 1) ^ 2) / 2
        t1, t2 = times(unit, 590, [IA, IB], spins)
        KF = (KF + (t1 + t2) / 2).rounded()

    # 600 TA = TA / AG:TB = TB / AG:PA = PA / AG:PB = PB / AG:GA = GA / AG
    for position, angle in enumerate((TA, TB, PA, PB, GA)):
        if angle.high / AG.low > LARGEST / 4:  # the angles themselves are worked out when printed
            unit.at(600, position)
            _ = (angle / AG).rounded()

    # 660 PRINT : PRINT ... INT (100 * XA) / 100; ... 690 ...( INT (1E4 * (KI - KF) / KI)) / 100
    results |= {"KI": KI, "KF": KF, "XA": XA, "YA": YA, "XB": XB, "YB": YB, "MUP": MUP}
    for name in ("XA", "YA", "XB", "YB"):
        _check(unit, name, results[name])
    unit.at(*_place("LOSS"))
    results["LOSS"] = loss(KI, KF).rounded()

    # 700 XA = A(1,M + 1) + D3 * A(5,M + 1):YA = A(2,M + 1) - D4 * A(5,M + 1)
    # 710 XB = A(3,M + 1) - D1 * A(6,M + 1):YB = A(4,M + 1) + D2 * A(6,M + 1)
    places = [(700, 1), (700, 2), (710, 1), (710, 2)]
    t3, t4, t1, t2 = times(unit, places, [D3, D4, D1, D2], [V[4], V[4], V[5], V[5]])
    contact = stored(plus(unit, places, V[:4], [t3, -t4, -t1, t2]))

    # 730 PRINT : PRINT "VAX= "; INT (1E3 * A(1,M + 1)) / 1E3; ...
    final = dict(zip(("XAF", "YAF", "XBF", "YBF"), contact, strict=True))
    final |= dict(zip(("VAX", "VAY", "VBX", "VBY", "WAF", "WBF"), V[:M], strict=False))
    for name, value in final.items():
        _check(unit, name, value)
    if matrix:
        results |= {f"A({row},{column})": value for (row, column), value in A.items()}
    return results | final


def _turns(
    unit: Unit, TBPB: Reals, TAPA: Reals, GA: Reals, pivot: bool
) -> tuple[list[Reals], list[Reals]]:
    """All sines and cosines of lines 330 to 460: of TB + PB, TA + PA and GA; for pivots also line
    440's cosines of PA + TA - GA and PB + TB - GA."""
    angles = [TBPB, TAPA, GA]
    places = [(330, 0), (330, 0), (430 if pivot else 400, 0)]
    cosine_places = list(places)
    turned = list(angles)
    if pivot:
        turned += plus(unit, 440, [TAPA, TBPB], [-GA, -GA])
        cosine_places += [(440, 0), (440, 0)]
    shifted = each(unit, cosine_places, polynomials.shifted_for_cosine, turned)
    sines = each(unit, places + cosine_places, polynomials.sin, angles + shifted)
    return sines[:3], sines[3:]


def _line_530(unit: Unit, MU: Reals, A32: Reals, A33: Reals, UY: Reals, VX: Reals) -> Reals:
    """Lines 510-530: a MU of -10 or less, such as 10 made -10 by line 400, gets a pivot's 0."""
    like_pivot = ~(MU > MINUS_10)
    some = bool(like_pivot.any())
    if some:
        unit.skip(like_pivot)
    # 530 A(3,M + 1) = MA * (COS (GA) - MU * SIN (GA)) * UY + MB * (SIN (GA) + MU * COS (GA)) * VX
    t1, t2 = times(unit, 530, [A32, A33], [UY, VX])
    unit.at(530)
    value = (t1 + t2).rounded()
    unit.skip(None)
    return select(like_pivot, ZERO, value) if some else value


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
