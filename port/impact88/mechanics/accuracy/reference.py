"""The reference: every result of a scene in 50 digits, those of mpmath (extra ``oracle``).

The impulse comes from Equations 15, 16 (or no slip) and 18, which share nothing with the closed
form of `closedform.impact` (the tests hold them to the six equations of lines 370 to 560), and
everything else from the impulse, so that none is a difference of numbers that have lost it already,
and what is zero is written as 0. For point masses (M = 4) the arms count as 0 and the spins stay
out of the energies.
"""

from collections.abc import Mapping, Sequence
from itertools import permutations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import UserError
from ...names import DEFAULT_M, FINAL_VELOCITIES, PIVOT
from .elimination import Terms

try:
    import mpmath as mpmath  # type: ignore[import-untyped]
except ImportError:
    raise UserError(
        "more digits than a double's need mpmath; pip install 'impact88[oracle]', or leave them "
        "out (oracle --no-reference)"
    ) from None

DIGITS = 50
"""Correct digits of the reference: 20 more than are printed, and three times a double's."""
WRITTEN = 30
"""Digits in an oracle's answer: as many as the chapter's reference cases have."""
GUARD = 15
"""Working digits beyond `DIGITS`, besides those for the spread of a scene's numbers: with twice as
many none of 1,560 results of five populations changes in 30 digits."""
LONGEST_EXPONENT = 3
"""Digits of an exponent; scenes with longer ones are refused."""

ANGLES = ("GA", "PA", "PB", "TA", "TB")

Number = Any  # mpmath.mpf, which has no usable type


def number(value: object) -> Number:
    """Convert decimal text or an int to the working precision, a float with its exact value."""
    return mpmath.mpf(value if isinstance(value, (int, str)) else float(value))  # type: ignore[arg-type]


def working(scene: Mapping[str, Any]) -> Any:
    """Return a context with the working digits a scene needs: `DIGITS`, `GUARD`, and three
    for each power of ten between its smallest and its largest number."""
    with mpmath.workdps(GUARD):
        sizes = [
            abs(number(value)) for name, value in scene.items() if name not in (*ANGLES, "M", "MU")
        ]
        powers = [int(mpmath.log10(x)) for x in sizes if x and mpmath.isfinite(x)]
    spread = max(powers, default=0) - min(powers, default=0)
    return mpmath.workdps(DIGITS + GUARD + 3 * spread)


def total(*terms: Number) -> Number:
    """Return the sum of some terms; zero where they cancel to less than `DIGITS` digits, since the
    remainder is rounding error."""
    result = sum(terms[1:], terms[0])
    noise = max(abs(term) for term in terms) * mpmath.mpf(10) ** -DIGITS
    return result if abs(result) > noise else mpmath.mpf(0)


class Exact(Terms):
    """A scene's numbers at working precision, with ``pi`` for pi; without, right angles are
    exact."""

    def __init__(self, scene: Mapping[str, Any], pi: Number | None = None) -> None:
        self.pi = pi
        g = {name: number(value) for name, value in scene.items()}
        point = number(scene.get("M", DEFAULT_M)) == 4
        super().__init__(g, point, g["MU"] == PIVOT, mpmath.mpf(0))
        s, c = self.s, self.c
        # relative contact velocity per unit of A's and of B's spin: an, at, bn, bt
        self.arms = (
            total(self.D3 * c, -self.D4 * s),
            total(-self.D4 * c, -self.D3 * s),
            total(self.D1 * c, -self.D2 * s),
            total(-self.D2 * c, -self.D1 * s),
        )
        # 1/MA 1/MB 1/IA 1/IB; 0 of an infinite body, and of a point mass's inertia
        moved = ("MA", "MB") if point else ("MA", "MB", "IA", "IB")
        inverses = [self.zero if mpmath.isinf(g[x]) else 1 / g[x] for x in moved]
        self.inverses = [*inverses, self.zero, self.zero][:4]

    def turn(self, *degrees: Number) -> tuple[Number, Number]:
        angle = sum(degrees[1:], degrees[0])
        if self.pi is None:
            return mpmath.sinpi(angle / 180), mpmath.cospi(angle / 180)
        return mpmath.sin(angle * self.pi / 180), mpmath.cos(angle * self.pi / 180)

    def products(self, a: Number, x: Sequence[Number], b: Number, y: Sequence[Number]) -> Number:
        return total(*(a * term for term in x), *(b * term for term in y))


def _determinant(rows: Sequence[Sequence[Number]]) -> Number:
    """Return the determinant of two or three rows; 0 where its terms cancel (see `total`)."""
    orders = zip(permutations(range(len(rows))), (1, -1, -1, 1, 1, -1), strict=False)
    return total(
        *(
            sign * mpmath.fprod(row[j] for row, j in zip(rows, places, strict=True))
            for places, sign in orders
        )
    )


def _solve(A: Sequence[Sequence[Number]], b: Sequence[Number]) -> list[Number] | None:
    """Solve two or three equations by Cramer's rule, accurate enough in so many digits; None where
    they are singular."""
    divisor = _determinant(A)
    if not divisor:
        return None
    replacements = (
        [[*row[:j], right, *row[j + 1 :]] for row, right in zip(A, b, strict=True)]
        for j in range(len(b))
    )
    return [_determinant(rows) / divisor for rows in replacements]


def impulse(t: Exact) -> list[Number] | None:
    """Return the impulse on A along n, along t, and its moment; None if the equations are singular.

    They are Equations 15, 16 (or no slip) and 18 in the unknowns Pn, Pt and M; 13, 14 and 17 hold
    because the same impulse acts on both bodies."""
    (ma, mb, ia, ib), (an, at, bn, bt) = t.inverses, t.arms
    across = total(ia * an * at, ib * bn * bt)
    turn_n, turn_t = total(ia * an, -ib * bn), total(ia * at, -ib * bt)
    rows = [[ma + mb + ia * an**2 + ib * bn**2, across, turn_n]]
    right = [-(1 + t.g["E"]) * t.gn]
    if t.pivot:
        rows.append([across, ma + mb + ia * at**2 + ib * bt**2, turn_t])
        right.append(-t.gt)
    else:
        rows.append([-t.mu, mpmath.mpf(1), t.zero])
        right.append(t.zero)
    if t.point:
        solution = _solve([row[:2] for row in rows], right)
        return solution and [*solution, t.zero]
    em = t.g["EM"]
    rows.append([(1 - em) * turn_n, (1 - em) * turn_t, (1 - 2 * em) * (ia + ib)])
    right.append((em - 1) * (t.WA - t.WB))
    return _solve(rows, right)


def velocities(t: Exact, P: Sequence[Number]) -> list[Number]:
    """Return the velocities after an impulse, in the order of `FINAL_VELOCITIES`."""
    (ma, mb, ia, ib), (an, at, bn, bt) = t.inverses, t.arms
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


def thirty_digits(scene: Mapping[str, str]) -> dict[str, str]:
    """Return result name -> 30 digits; empty when the equations are singular or make no sense.
    Results without a value (LOSS where nothing moves, MUC where a pivot feels no impulse) are left
    out."""
    exponents = (text.upper().replace(" ", "").partition("E")[2] for text in scene.values())
    if any(len(exponent.lstrip("+-0")) > LONGEST_EXPONENT for exponent in exponents):
        return {}  # a number of thousands of digits is no measurement
    try:
        values = fifty_digits(scene)
    except (ValueError, ZeroDivisionError):
        return {}
    with mpmath.workdps(DIGITS):
        return {
            name: mpmath.nstr(value, WRITTEN) if value else "0"
            for name, value in values.items()
            if mpmath.isfinite(value)
        }


def fifty_digits(scene: Mapping[str, str | float]) -> dict[str, Any]:
    """Return result name -> mpf; empty when the equations are singular.

    ``scene``: decimal texts, or floats with their exact values."""
    texts = {
        name: value.replace(" ", "") or "0" if isinstance(value, str) else value
        for name, value in scene.items()
    }
    with working(texts):
        t = Exact(texts)
        P = impulse(t)
        if P is None:
            return {}
        after = velocities(t, P)
        f = dict(zip(FINAL_VELOCITIES, after, strict=True))
        f |= _contact_velocities(t, t.before(), "") | _contact_velocities(t, after, "F")
        for name, suffix, sign in (("VC", "", -1), ("VS", "F", 1)):
            x, y = (total(f[f"{axis}A{suffix}"], -f[f"{axis}B{suffix}"]) for axis in "XY")
            f[name] = sign * total(t.c * x, t.s * y)
        f |= _energies(t, P, after)
        size = mpmath.hypot(*P[:2])
        f |= {"DVA": t.inverses[0] * size, "DVB": t.inverses[1] * size}
        f |= {**dict(zip(("PN", "PT", "PM"), P, strict=True)), "MUP": t.mu}
        if t.point:
            f |= {"WAF": t.g["WA"], "WBF": t.g["WB"]}
        pivot = impulse(Exact({**texts, "MU": "-10"}))
        return f | ({"MUC": pivot[1] / pivot[0]} if pivot and pivot[0] else {})


def _contact_velocities(t: Terms, velocities: list[Any], suffix: str) -> dict[str, Any]:
    """Lines 340, 700 and 710."""
    ax, ay, bx, by, wa, wb = velocities
    return {
        f"XA{suffix}": total(ax, t.D3 * wa),
        f"YA{suffix}": total(ay, -t.D4 * wa),
        f"XB{suffix}": total(bx, -t.D1 * wb),
        f"YB{suffix}": total(by, t.D2 * wb),
    }


def _energies(t: Exact, P: Sequence[Number], after: list[Number]) -> dict[str, Number]:
    """Lines 320, 580, 590 and 690; what is lost by the work of the impulse at the mean of the
    relative velocities before and after; the energy equivalent speeds, half of the loss in each
    body or all of it before a rigid one."""
    g, before = t.g, t.before()
    bodies = ["MA", "MA", "MB", "MB", *([] if t.point else ["IA", "IB"])]

    def energy(velocities: list[Any]) -> Any:
        pairs = zip(bodies, velocities, strict=False)
        # an infinite body is at rest
        return mpmath.fsum(g[x] * v**2 for x, v in pairs if not mpmath.isinf(g[x])) / 2

    initial = energy(before)
    values = {"KI": initial, "KF": energy(after)}
    (an, at, bn, bt), s, c = t.arms, t.s, t.c
    ax, ay, bx, by, wa, wb = (u + v for u, v in zip(before, after, strict=True))
    if t.point:
        wa = wb = mpmath.mpf(0)
    normal = total(c * ax, s * ay, -c * bx, -s * by, an * wa, bn * wb)
    sliding = total(c * ay, -s * ax, -c * by, s * bx, at * wa, bt * wb)
    sums = normal, sliding, total(wa, -wb)
    # the impulse's work is half of its product with the sum of the velocities before and after
    losses = [-p * v / 2 for p, v in zip(P, sums, strict=True)]
    values |= dict(zip(("ELN", "ELT", "ELM"), losses, strict=True))
    loss = total(*losses)
    if initial:
        values["LOSS"] = 100 * loss / initial
    rigid = mpmath.isinf(g["MA"]) or mpmath.isinf(g["MB"])
    part = max(loss, mpmath.mpf(0)) / (1 if rigid else 2)
    for name, inverse in zip(("EESA", "EESB"), t.inverses[:2], strict=True):
        values[name] = mpmath.sqrt(2 * part * inverse)
    return values


def two_doubles(
    columns: Mapping[str, NDArray[np.float64]], names: Sequence[str] = FINAL_VELOCITIES
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return results to 50 digits, a column for each of ``names``, each number as the sum of two
    doubles (hi, lo); NaN where there is none."""
    hi, lo = np.full((2, len(columns["MA"]), len(names)), np.nan)
    for i in range(len(hi)):
        true = fifty_digits({name: float(values[i]) for name, values in columns.items()})
        for j, name in enumerate(names):
            if name in true:
                hi[i, j] = float(true[name])
                lo[i, j] = float(true[name] - hi[i, j])
    return hi, lo
