"""The listing's six equations in 50 digits, and what its elimination makes of them.

`exact` shares nothing with `accuracy.reference.impulse` but a scene's terms. `split` divides an
error into what line 300's pi changes in the exact solution, what lines 1000 to 1170 get wrong even
in 50 digits, and the rest, which is rounding.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import mpmath

from impact88.mechanics.accuracy.elimination import eliminate, listing_rows
from impact88.mechanics.accuracy.reference import (
    DIGITS,
    GUARD,
    Exact,
    impulse,
    number,
    velocities,
    working,
)
from impact88.names import FINAL_VELOCITIES

Number = Any


def listing_pi() -> Number:
    """The pi of line 300, as the decimal it is written as."""
    with mpmath.workdps(DIGITS + GUARD):
        return mpmath.mpf("3.14159265")


def equations(scene: Mapping[str, Any], pi: Number | None = None) -> list[list[Number]]:
    """The rows of lines 370 to 560 (6 of 7 numbers, or 4 of 5 for M = 4) for a scene of texts or
    numbers, with ``pi`` for pi. Line 510's misreading of MU below -10 is not followed."""
    with working(scene):
        return listing_rows(Exact(scene, pi))


def exact(scene: Mapping[str, Any], pi: Number | None = None) -> dict[str, Number] | None:
    """The six final velocities to 50 digits (name -> mpf), or None if the equations are singular.

    ``scene``: scene name -> decimal text, int or float. M = 4: spins pass through. Infinite bodies
    are given as ``float("inf")`` and must be at rest.
    """
    with working(scene):
        t = Exact(scene, pi)
        if any(mpmath.isinf(t.g[name]) for name in ("MA", "IA", "MB", "IB") if name in t.g):
            solution = impulse(t)
            values = None if solution is None else velocities(t, solution)
        else:
            matrix = listing_rows(t)
            values = _solve([row[:-1] for row in matrix], [row[-1] for row in matrix])
        if values is None:
            return None
        if t.point:
            values = [*values[:4], t.g.get("WA", 0), t.g.get("WB", 0)]
        return dict(zip(FINAL_VELOCITIES, values, strict=True))


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


def listing_elimination(
    scene: Mapping[str, Any], pi: Number | None = None
) -> dict[str, Number] | None:
    """What lines 1000 to 1170 make of the equations in 50 digits; None for ZERO DETERMINANT.

    ``pi``: the listing's 3.14159265 unless given.
    """
    with working(scene):
        t = Exact(scene, listing_pi() if pi is None else pi)
        solution = eliminate(listing_rows(t), mpmath.mpf("1e-9"))
        if solution is None:
            return None
        if t.point:
            solution = [*solution, t.g.get("WA", 0), t.g.get("WB", 0)]
        return dict(zip(FINAL_VELOCITIES, solution, strict=True))


def relative_error(computed: Mapping[str, Any] | Sequence[Any], true: Mapping[str, Any]) -> float:
    """The largest relative error of the final velocities: errors of the four velocities by the
    largest of these four, errors of the two spins by the larger spin. Infinite if not a number."""
    values = (
        computed
        if isinstance(computed, Mapping)
        else dict(zip(FINAL_VELOCITIES, computed, strict=True))
    )
    worst = 0.0
    with mpmath.workdps(DIGITS + GUARD):
        for group in (FINAL_VELOCITIES[:4], FINAL_VELOCITIES[4:]):
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
