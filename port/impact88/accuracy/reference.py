"""The reference: Equations 13 to 18 in 50-digit arithmetic (needs mpmath, extra ``bench``).

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
from typing import TYPE_CHECKING, Any, NamedTuple

from ..errors import UserError
from ..names import DEFAULT_M
from .elimination import ORDER, eliminate

if TYPE_CHECKING:
    import mpmath  # type: ignore[import-untyped]
else:
    try:
        import mpmath
    except ImportError as missing:
        raise UserError(
            "the 50-digit reference needs mpmath; pip install 'impact88[bench]'"
        ) from missing

DIGITS = 50
GUARD = 15
"""Working digits beyond those promised; scenes span units of 1e-9 to 1e15."""

Number = Any  # mpmath.mpf, which has no usable type


def number(value: object) -> Number:
    """Decimal text or an int exactly (to the working precision), a float with its exact value."""
    return mpmath.mpf(value if isinstance(value, (int, str)) else float(value))  # type: ignore[arg-type]


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
        ag = (mpmath.pi if pi is None else pi) / 180
        ga = g["GA"] * ag
        self.s, self.c = mpmath.sin(ga), mpmath.cos(ga)
        zero = mpmath.mpf(0)
        if self.point:
            self.D1 = self.D2 = self.D3 = self.D4 = zero
            self.WA = self.WB = zero
        else:
            b, a = (g["TB"] + g["PB"]) * ag, (g["TA"] + g["PA"]) * ag
            self.D1, self.D2 = g["DB"] * mpmath.sin(b), g["DB"] * mpmath.cos(b)
            self.D3, self.D4 = g["DA"] * mpmath.sin(a), g["DA"] * mpmath.cos(a)
            self.WA, self.WB = g["WA"], g["WB"]
        dx = g["UX"] + self.D3 * self.WA - (g["VX"] - self.D1 * self.WB)
        dy = g["UY"] - self.D4 * self.WA - (g["VY"] + self.D2 * self.WB)
        self.gn = dx * self.c + dy * self.s
        self.gt = dy * self.c - dx * self.s
        self.pivot = g["MU"] == -10
        self.mu = -g["MU"] if self.gt > 0 and not self.pivot else g["MU"]


def equations(scene: Mapping[str, Any], pi: Number | None = None) -> list[list[Number]]:
    """The rows of lines 370 to 560 (6 of 7 numbers, or 4 of 5 for M = 4) for a scene of texts or
    numbers, with ``pi`` for pi. Line 510's misreading of MU below -10 is not followed."""
    with mpmath.workdps(DIGITS + GUARD):
        return _rows(_Terms(scene, pi))


def _rows(t: _Terms) -> list[list[Number]]:
    g, s, c = t.g, t.s, t.c
    MA, MB = g["MA"], g["MB"]
    D1, D2, D3, D4 = t.D1, t.D2, t.D3, t.D4
    UX, UY, VX, VY, WA, WB = g["UX"], g["UY"], g["VX"], g["VY"], t.WA, t.WB
    zero = mpmath.mpf(0)
    if t.pivot:
        # DA*COS(PA+TA-GA) = D4 cos GA + D3 sin GA, and B likewise
        slip = [s, -c, -s, c, D4 * c + D3 * s, D2 * c + D1 * s, zero]
    else:
        fa, fb = MA * (c - t.mu * s), MB * (s + t.mu * c)
        slip = [zero, fa, fb, zero, zero, zero, fa * UY + fb * VX]
    rebound = [c, s, -c, -s, D3 * c - D4 * s, D1 * c - D2 * s, -g["E"] * t.gn]
    rows = [
        [MA, zero, MB, zero, zero, zero, MA * UX + MB * VX],
        [zero, MA, zero, MB, zero, zero, MA * UY + MB * VY],
        slip,
        rebound,
    ]
    if t.point:
        return [row[:4] + row[6:] for row in rows]
    IA, IB, EM = g["IA"], g["IB"], g["EM"]
    turn_a, turn_b = MA * (D2 + D4), MB * (D1 + D3)
    rows.append([zero, turn_a, turn_b, zero, IA, IB, turn_a * UY + turn_b * VX + IA * WA + IB * WB])
    moment = [-EM * MA * D3 / IA, EM * MA * D4 / IA, -EM * MB * D1 / IB, EM * MB * D2 / IB]
    before = moment[0] * UX + moment[1] * UY + moment[2] * VX + moment[3] * VY
    rows.append([*moment, 2 * EM - 1, 1 - 2 * EM, before + EM * (WA - WB)])
    return rows


def exact(scene: Mapping[str, Any], pi: Number | None = None) -> dict[str, Number] | None:
    """The six final velocities to 50 digits (name -> mpf), or None if the equations are singular.

    ``scene``: scene name -> decimal text, int or float. M = 4: spins pass through. Infinite bodies
    are given as ``float("inf")`` and must be at rest.
    """
    with mpmath.workdps(DIGITS + GUARD):
        t = _Terms(scene, pi)
        if any(mpmath.isinf(t.g[name]) for name in ("MA", "IA", "MB", "IB") if name in t.g):
            found = _by_impulse(t)
        else:
            rows = _rows(t)
            found = _solve([row[:-1] for row in rows], [row[-1] for row in rows])
        if found is None:
            return None
        if t.point:
            found = [*found[:4], t.g.get("WA", 0), t.g.get("WB", 0)]
        return dict(zip(ORDER, found, strict=True))


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
        if size < mpmath.mpf(10) ** -(DIGITS + GUARD // 2):
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
    found = [mpmath.mpf(0)] * n
    for k, name in enumerate(order):
        found[name] = x[k] / column[name]
    return found


def _by_impulse(t: _Terms) -> list[Number] | None:
    """Equations 15, 16 (or no slip) and 18 in the unknowns Px, Py and M; 13, 14 and 17 hold because
    the same impulse acts on both bodies."""
    g = t.g
    zero = mpmath.mpf(0)
    ma, mb = (zero if mpmath.isinf(g[name]) else 1 / g[name] for name in ("MA", "MB"))
    if t.point:
        ia = ib = zero
    else:
        ia, ib = (zero if mpmath.isinf(g[name]) else 1 / g[name] for name in ("IA", "IB"))
    # velocity changes: rows VAX VAY VBX VBY WAF WBF, columns Px Py M
    change = [
        [ma, zero, zero],
        [zero, ma, zero],
        [-mb, zero, zero],
        [zero, -mb, zero],
        [t.D3 * ia, -t.D4 * ia, ia],
        [t.D1 * ib, -t.D2 * ib, -ib],
    ]
    x = [1, 0, -1, 0, t.D3, t.D1]
    y = [0, 1, 0, -1, -t.D4, -t.D2]
    per_x = [sum(x[i] * change[i][j] for i in range(6)) for j in range(3)]
    per_y = [sum(y[i] * change[i][j] for i in range(6)) for j in range(3)]
    rows = [[t.c * a + t.s * b for a, b in zip(per_x, per_y, strict=True)]]
    right = [-(1 + g["E"]) * t.gn]
    if t.pivot:
        rows.append([t.c * b - t.s * a for a, b in zip(per_x, per_y, strict=True)])
        right.append(-t.gt)
    else:
        rows.append([-t.s - t.mu * t.c, t.c - t.mu * t.s, zero])
        right.append(zero)
    if t.point:
        P = _solve([row[:2] for row in rows], right)
        P = None if P is None else [*P, zero]
    else:
        em = g["EM"]
        turn = [change[4][j] - change[5][j] for j in range(3)]
        rows.append([(em - 1) * turn[0], (em - 1) * turn[1], (em - 1) * turn[2] + em * (ia + ib)])
        right.append((1 - em) * (t.WA - t.WB))
        P = _solve(rows, right)
    if P is None:
        return None
    before = [g["UX"], g["UY"], g["VX"], g["VY"], t.WA, t.WB]
    count = 4 if t.point else 6
    return [before[i] + sum(change[i][j] * P[j] for j in range(3)) for i in range(count)]


def listing_elimination(
    scene: Mapping[str, Any], pi: Number | None = None
) -> dict[str, Number] | None:
    """What lines 1000 to 1170 make of the equations in 50 digits; None for ZERO DETERMINANT.

    ``pi``: the listing's 3.14159265 unless given.
    """
    with mpmath.workdps(DIGITS + GUARD):
        t = _Terms(scene, listing_pi() if pi is None else pi)
        found = eliminate(_rows(t), mpmath.mpf("1e-9"))
        if found is None:
            return None
        if t.point:
            found = [*found, t.g.get("WA", 0), t.g.get("WB", 0)]
        return dict(zip(ORDER, found, strict=True))


def relative_error(found: Mapping[str, Any] | Sequence[Any], true: Mapping[str, Any]) -> float:
    """The largest relative error of the final velocities: errors of the four velocities by the
    largest of these four, errors of the two spins by the larger spin. Infinite if not a number."""
    values = found if isinstance(found, Mapping) else dict(zip(ORDER, found, strict=True))
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


def split(scene: Mapping[str, Any], found: Mapping[str, Any]) -> Split:
    """Split the error of final velocities that the listing (in any arithmetic) ``found``.

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
        arithmetic = relative_error(found, eliminated)
        elimination = relative_error(eliminated, with_listing_pi)
    return Split(
        relative_error(found, true), arithmetic, elimination, relative_error(with_listing_pi, true)
    )
