"""The reference: a scene's equations in 50 digits, those of mpmath (extra ``oracle``).

The three equations in the impulse share nothing with the closed form of `closedform.impact`; the
tests hold them to the six equations of lines 370 to 560.
"""

from collections.abc import Mapping, Sequence
from itertools import permutations
from typing import Any, NamedTuple

from ..errors import UserError
from ..names import DEFAULT_M, PIVOT
from .elimination import Terms

try:
    import mpmath as mpmath  # type: ignore[import-untyped]
except ImportError:
    raise UserError(
        "more digits than a double's need mpmath; pip install 'impact88[oracle]', or leave them "
        "out (oracle --no-reference)"
    ) from None

DIGITS = 50
GUARD = 15
"""Working digits beyond those promised, besides what the spread of a scene's numbers may cost."""

ANGLES = ("GA", "PA", "PB", "TA", "TB")

Number = Any  # mpmath.mpf, which has no usable type


def number(value: object) -> Number:
    """Decimal text or an int exactly (to the working precision), a float with its exact value."""
    return mpmath.mpf(value if isinstance(value, (int, str)) else float(value))  # type: ignore[arg-type]


def working(scene: Mapping[str, Any]) -> Any:
    """A context in which arithmetic has the digits a scene takes: those promised, `GUARD`, and
    three for each power of ten between its smallest and its largest number."""
    with mpmath.workdps(GUARD):
        sizes = [
            abs(number(value)) for name, value in scene.items() if name not in (*ANGLES, "M", "MU")
        ]
        powers = [int(mpmath.log10(x)) for x in sizes if x and mpmath.isfinite(x)]
    spread = max(powers, default=0) - min(powers, default=0)
    return mpmath.workdps(DIGITS + GUARD + 3 * spread)


def total(*terms: Number) -> Number:
    """The sum of some terms; zero where they cancel beyond all digits promised, because then what
    is left is the noise of the digits beyond."""
    result = sum(terms[1:], terms[0])
    noise = max(abs(term) for term in terms) * mpmath.mpf(10) ** -DIGITS
    return result if abs(result) > noise else mpmath.mpf(0)


def terms(scene: Mapping[str, Any], pi: Number | None = None) -> Terms:
    """A scene's numbers, with ``pi`` for pi; without, right angles are exact. Made at working
    precision."""
    g = {name: number(value) for name, value in scene.items()}

    def turn(*degrees: Number) -> tuple[Number, Number]:
        angle = sum(degrees[1:], degrees[0])
        if pi is None:
            return mpmath.sinpi(angle / 180), mpmath.cospi(angle / 180)
        return mpmath.sin(angle * pi / 180), mpmath.cos(angle * pi / 180)

    def products(a: Number, x: Sequence[Number], b: Number, y: Sequence[Number]) -> Number:
        return total(*(a * term for term in x), *(b * term for term in y))

    def against(mu: Number, slip: Number) -> Number:
        return -mu if slip > 0 else mu

    point = number(scene.get("M", DEFAULT_M)) == 4
    zero = mpmath.mpf(0)
    return Terms(g, point, g["MU"] == PIVOT, zero, turn, products, against)


def _determinant(rows: Sequence[Sequence[Number]]) -> Number:
    """Of two or three rows; 0 where its terms cancel beyond all digits promised."""
    orders = zip(permutations(range(len(rows))), (1, -1, -1, 1, 1, -1), strict=False)
    return total(
        *(
            sign * mpmath.fprod(row[j] for row, j in zip(rows, places, strict=True))
            for places, sign in orders
        )
    )


def _solve(A: Sequence[Sequence[Number]], b: Sequence[Number]) -> list[Number] | None:
    """By Cramer's rule, which in so many digits is as good as any."""
    divisor = _determinant(A)
    if not divisor:
        return None
    replaced = (
        [[*row[:j], right, *row[j + 1 :]] for row, right in zip(A, b, strict=True)]
        for j in range(len(b))
    )
    return [_determinant(rows) / divisor for rows in replaced]


class Impulse(NamedTuple):
    """What acts on A: along n, along t, and as a moment."""

    normal: Number
    tangential: Number
    moment: Number


def inverses(t: Terms) -> list[Number]:
    """Inverse masses and inertias; 0 for an infinite body, and for a point mass's inertia."""
    unmoved = {"IA", "IB"} if t.point else set()
    return [
        mpmath.mpf(0) if x in unmoved or mpmath.isinf(t.g[x]) else 1 / t.g[x]
        for x in ("MA", "MB", "IA", "IB")
    ]


def arms(t: Terms) -> tuple[Number, Number, Number, Number]:
    """What A's and B's spin add to the relative contact velocity: an, at, bn, bt."""
    s, c = t.s, t.c
    return (
        total(t.D3 * c, -t.D4 * s),
        total(-t.D4 * c, -t.D3 * s),
        total(t.D1 * c, -t.D2 * s),
        total(-t.D2 * c, -t.D1 * s),
    )


def impulse(t: Terms) -> Impulse | None:
    """The impulse of a scene: Equations 15, 16 (or no slip) and 18 in the unknowns Pn, Pt and M;
    13, 14 and 17 hold because the same impulse acts on both bodies. None if they are singular."""
    zero, one = mpmath.mpf(0), mpmath.mpf(1)
    ma, mb, ia, ib = inverses(t)
    an, at, bn, bt = arms(t)
    across = total(ia * an * at, ib * bn * bt)
    turn_n, turn_t = total(ia * an, -ib * bn), total(ia * at, -ib * bt)
    rows = [[ma + mb + ia * an**2 + ib * bn**2, across, turn_n]]
    right = [-(1 + t.g["E"]) * t.gn]
    if t.pivot:
        rows.append([across, ma + mb + ia * at**2 + ib * bt**2, turn_t])
        right.append(-t.gt)
    else:
        rows.append([-t.mu, one, zero])
        right.append(zero)
    if t.point:
        solution = _solve([row[:2] for row in rows], right)
        return None if solution is None else Impulse(solution[0], solution[1], zero)
    em = t.g["EM"]
    rows.append([(1 - em) * turn_n, (1 - em) * turn_t, (1 - 2 * em) * (ia + ib)])
    right.append((em - 1) * (t.WA - t.WB))
    solution = _solve(rows, right)
    return None if solution is None else Impulse(*solution)


def velocities(t: Terms, P: Impulse) -> list[Number]:
    """The velocities that an impulse leaves, in the order of `ORDER`."""
    ma, mb, ia, ib = inverses(t)
    an, at, bn, bt = arms(t)
    s, c, (pn, pt, m) = t.s, t.c, P
    changes = [
        (ma * c * pn, -ma * s * pt),
        (ma * s * pn, ma * c * pt),
        (-mb * c * pn, mb * s * pt),
        (-mb * s * pn, -mb * c * pt),
        (ia * an * pn, ia * at * pt, ia * m),
        (ib * bn * pn, ib * bt * pt, -ib * m),
    ]
    return [total(u, *change) for u, change in zip(t.before(), changes, strict=True)]
