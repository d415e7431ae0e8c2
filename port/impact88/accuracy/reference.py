"""The reference: Equations 13 to 18 in 50 digits, those of mpmath (extra ``oracle``).

Two ways that share nothing with the closed form of `closedform.impact`: `equations` writes the
six equations as lines 370 to 560 do and `exact` solves them, or, where a body is infinite, the
three equations in the impulse that remain. `listing_elimination` runs the listing's own
elimination in the same 50 digits. Together they split an error (`split`) into

- *pi*: what line 300's 3.14159265 changes in the exact solution,
- *elimination*: what lines 1000 to 1170 get wrong even in 50 digits (pivots judged by an absolute
  1E-9, a stale RX), and
- *arithmetic*: the rest, which is rounding.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from ..errors import UserError
from ..names import DEFAULT_M, PIVOT
from .elimination import ORDER, eliminate, listing_rows

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


def sine_and_cosine(degrees: Number, pi: Number | None) -> tuple[Number, Number]:
    """Sine and cosine of an angle in degrees with ``pi`` for pi; exact for right angles without."""
    if pi is None:
        return mpmath.sinpi(degrees / 180), mpmath.cospi(degrees / 180)
    return mpmath.sin(degrees * pi / 180), mpmath.cos(degrees * pi / 180)


def listing_pi() -> Number:
    """The pi of line 300, as the decimal it is written as."""
    with mpmath.workdps(DIGITS + GUARD):
        return mpmath.mpf("3.14159265")


class _Terms:
    """A scene's numbers in mpmath, and lines 300 to 340 on them. Made at working precision."""

    def __init__(self, scene: Mapping[str, Any], pi: Number | None) -> None:
        self.g = {name: number(value) for name, value in scene.items()}
        g = self.g
        self.point = number(scene.get("M", DEFAULT_M)) == 4
        self.s, self.c = sine_and_cosine(g["GA"], pi)
        zero = mpmath.mpf(0)
        if self.point:
            self.D1 = self.D2 = self.D3 = self.D4 = zero
            self.WA = self.WB = zero
        else:
            s, c = sine_and_cosine(g["TB"] + g["PB"], pi)
            self.D1, self.D2 = g["DB"] * s, g["DB"] * c
            s, c = sine_and_cosine(g["TA"] + g["PA"], pi)
            self.D3, self.D4 = g["DA"] * s, g["DA"] * c
            self.WA, self.WB = g["WA"], g["WB"]
        x = (g["UX"], self.D3 * self.WA, -g["VX"], self.D1 * self.WB)
        y = (g["UY"], -self.D4 * self.WA, -g["VY"], -self.D2 * self.WB)
        self.gn = total(*(self.c * term for term in x), *(self.s * term for term in y))
        self.gt = total(*(self.c * term for term in y), *(-self.s * term for term in x))
        self.pivot = g["MU"] == PIVOT
        self.mu = -g["MU"] if self.gt > 0 and not self.pivot else g["MU"]

    def before(self) -> list[Number]:
        """The velocities before the impact, in the order of `ORDER`."""
        return [*(self.g[name] for name in ("UX", "UY", "VX", "VY")), self.WA, self.WB]


def equations(scene: Mapping[str, Any], pi: Number | None = None) -> list[list[Number]]:
    """The rows of lines 370 to 560 (6 of 7 numbers, or 4 of 5 for M = 4) for a scene of texts or
    numbers, with ``pi`` for pi. Line 510's misreading of MU below -10 is not followed."""
    with working(scene):
        return listing_rows(_Terms(scene, pi), mpmath.mpf(0))


def exact(scene: Mapping[str, Any], pi: Number | None = None) -> dict[str, Number] | None:
    """The six final velocities to 50 digits (name -> mpf), or None if the equations are singular.

    ``scene``: scene name -> decimal text, int or float. M = 4: spins pass through. Infinite bodies
    are given as ``float("inf")`` and must be at rest.
    """
    with working(scene):
        t = _Terms(scene, pi)
        if any(mpmath.isinf(t.g[name]) for name in ("MA", "IA", "MB", "IB") if name in t.g):
            solution = impulse(t)
            values = None if solution is None else velocities(t, solution)
        else:
            matrix = listing_rows(t, mpmath.mpf(0))
            values = _solve([row[:-1] for row in matrix], [row[-1] for row in matrix])
        if values is None:
            return None
        if t.point:
            values = [*values[:4], t.g.get("WA", 0), t.g.get("WB", 0)]
        return dict(zip(ORDER, values, strict=True))


def _solve(A: list[list[Number]], b: list[Number]) -> list[Number] | None:
    """Gaussian elimination with rows scaled, columns scaled, and complete pivoting."""
    n = len(A)
    column = [max(abs(A[i][j]) for i in range(n)) or mpmath.mpf(1) for j in range(n)]
    rows = [[A[i][j] / column[j] for j in range(n)] + [b[i]] for i in range(n)]
    for i, row in enumerate(rows):
        largest = max(abs(x) for x in row[:n])
        if largest == 0:
            return None
        rows[i] = [x / largest for x in row]
    order = list(range(n))
    for k in range(n):
        size, i, j = max((abs(rows[i][j]), i, j) for i in range(k, n) for j in range(k, n))
        if size < mpmath.mpf(10) ** (GUARD // 2 - mpmath.mp.dps):
            return None
        rows[k], rows[i] = rows[i], rows[k]
        for row in rows:
            row[k], row[j] = row[j], row[k]
        order[k], order[j] = order[j], order[k]
        for i in range(k + 1, n):
            f = rows[i][k] / rows[k][k]
            if f:
                rows[i] = [x - f * y for x, y in zip(rows[i], rows[k], strict=True)]
    x = [mpmath.mpf(0)] * n
    for k in reversed(range(n)):
        x[k] = (rows[k][n] - sum(rows[k][j] * x[j] for j in range(k + 1, n))) / rows[k][k]
    solution = [mpmath.mpf(0)] * n
    for k, name in enumerate(order):
        solution[name] = x[k] / column[name]
    return solution


class Impulse(NamedTuple):
    """What acts on A: along n, along t, and as a moment."""

    normal: Number
    tangential: Number
    moment: Number


class Inverses(NamedTuple):
    """Inverse masses and inertias; 0 for an infinite body, and for a point mass's inertia."""

    ma: Number
    mb: Number
    ia: Number
    ib: Number


def inverses(t: _Terms) -> Inverses:
    """The inverse masses and inertias of a scene."""
    zero = mpmath.mpf(0)
    spinning = () if t.point else ("IA", "IB")
    values = [zero if mpmath.isinf(t.g[x]) else 1 / t.g[x] for x in ("MA", "MB", *spinning)]
    return Inverses(*values, *([zero, zero] if t.point else []))


def arms(t: _Terms) -> tuple[Number, Number, Number, Number]:
    """What A's and B's spin add to the relative contact velocity: an, at, bn, bt."""
    s, c = t.s, t.c
    return (
        total(t.D3 * c, -t.D4 * s),
        total(-t.D4 * c, -t.D3 * s),
        total(t.D1 * c, -t.D2 * s),
        total(-t.D2 * c, -t.D1 * s),
    )


def impulse(t: _Terms) -> Impulse | None:
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


def velocities(t: _Terms, P: Impulse) -> list[Number]:
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


def listing_elimination(
    scene: Mapping[str, Any], pi: Number | None = None
) -> dict[str, Number] | None:
    """What lines 1000 to 1170 make of the equations in 50 digits; None for ZERO DETERMINANT.

    ``pi``: the listing's 3.14159265 unless given.
    """
    with working(scene):
        t = _Terms(scene, listing_pi() if pi is None else pi)
        solution = eliminate(listing_rows(t, mpmath.mpf(0)), mpmath.mpf("1e-9"))
        if solution is None:
            return None
        if t.point:
            solution = [*solution, t.g.get("WA", 0), t.g.get("WB", 0)]
        return dict(zip(ORDER, solution, strict=True))


def relative_error(computed: Mapping[str, Any] | Sequence[Any], true: Mapping[str, Any]) -> float:
    """The largest relative error of the final velocities: errors of the four velocities by the
    largest of these four, errors of the two spins by the larger spin. Infinite if not a number."""
    values = computed if isinstance(computed, Mapping) else dict(zip(ORDER, computed, strict=True))
    worst = 0.0
    with mpmath.workdps(DIGITS + GUARD):
        for group in (ORDER[:4], ORDER[4:]):
            scale = max(abs(true[name]) for name in group)
            for name in group:
                value = values[name]
                if isinstance(value, float) and not math.isfinite(value):
                    return math.inf
                error = abs((number(value) if isinstance(value, float) else value) - true[name])
                if error:
                    worst = max(worst, float(error / scale) if scale else math.inf)
    return worst


class Split(NamedTuple):
    """Relative errors of final velocities, by cause (see the module); NaN where there is none."""

    total: float
    arithmetic: float
    elimination: float
    pi: float


def split(scene: Mapping[str, Any], computed: Mapping[str, Any]) -> Split:
    """Split the error of final velocities that the listing (in any arithmetic) ``computed``.

    The parts need not add up to the total, errors being sizes. ``elimination`` and ``arithmetic``
    are NaN when the listing's elimination ends with ZERO DETERMINANT even in 50 digits.
    """
    true, with_listing_pi = exact(scene), exact(scene, listing_pi())
    if true is None or with_listing_pi is None:
        return Split(math.nan, math.nan, math.nan, math.nan)
    eliminated = listing_elimination(scene)
    if eliminated is None:
        arithmetic = elimination = math.nan
    else:
        arithmetic = relative_error(computed, eliminated)
        elimination = relative_error(eliminated, with_listing_pi)
    return Split(
        relative_error(computed, true),
        arithmetic,
        elimination,
        relative_error(with_listing_pi, true),
    )
