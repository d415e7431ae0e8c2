"""What sine and cosine of degrees are made of (`collision.degrees`), and those of one angle.

Python's own numbers alone: a scene is read without numpy.
"""

from collections.abc import Callable
from decimal import Context, Decimal, localcontext
from functools import cache
from typing import Any

STEPS = 2048
"""Table entries in a full turn."""
STEP = 360 / STEPS
"""45/256 degree: exact, and so is its product with any number below 2**47."""

_PI = Decimal("3.14159265358979323846264338327950288419716939937510")
_QUARTER = STEPS // 4
# adding this leaves the nearest integer in a double's lowest bits
INTEGER_IN_LOW_BITS = 1.5 * 2.0**52


@cache
def turn() -> list[float]:
    """sin of the multiples of `STEP`, a turn and a quarter, so that cos is the same table later."""
    octant = _QUARTER // 2
    with localcontext(Context(prec=40)):
        step = 2 * _PI / STEPS
        sine, cosine = _series(step, step, 3), _series(Decimal(1), step, 2)
        x, y = Decimal(1), Decimal(0)
        points = []
        for _ in range(octant + 1):
            points.append((float(x), float(y)))
            x, y = x * cosine - y * sine, x * sine + y * cosine
    rising = [y for _, y in points] + [x for x, _ in reversed(points[:-1])]
    half = rising + rising[-2:0:-1]
    full = half + [-y for y in half]
    full[STEPS // 2] = 0.0
    return full + full[:_QUARTER]


def _series(term: Decimal, x: Decimal, first: int) -> Decimal:
    """Of the sine from x and 3, of the cosine from 1 and 2."""
    total = term
    for n in range(first, 25, 2):
        term = -term * x * x / (n * (n - 1))
        total += term
    return total


with localcontext(Context(prec=40)):
    _r = _PI / 180
    POLYNOMIALS = tuple(map(float, (_r, -(_r**3) / 6, _r**5 / 120, -(_r**2) / 2, _r**4 / 24)))
"""Coefficients of sin r = r·(s0 + s1·r² + s2·r⁴) and cos r - 1 = r²·(c1 + c2·r²), r in degrees: the
series themselves. The first term left out is, at |r| = STEP/2, below 3e-21 of the sine and 2e-20 of
the cosine."""


def sine_and_cosine(
    angle: Any, table: Any = None, whole: Callable[[Any], Any] = int
) -> tuple[Any, Any]:
    """Sine and cosine of an angle in degrees, finite and at most 2**40; of an array of them with an
    array for a ``table`` and ``whole`` for making whole numbers. The operations stand in a fixed
    order, that of ``native/machine.c``."""
    table = turn() if table is None else table
    s0, s1, s2, c1, c2 = POLYNOMIALS
    steps = angle * (1 / STEP) + INTEGER_IN_LOW_BITS - INTEGER_IN_LOW_BITS
    index = whole(steps) & (STEPS - 1)
    sine, cosine = table[index], table[index + _QUARTER]
    rest = angle - steps * STEP
    square = rest * rest
    small = ((square * s2 + s1) * square + s0) * rest
    less = (square * c2 + c1) * square
    # sin(k + r) = sin k + (cos k sin r + sin k (cos r - 1)), and the cosine likewise
    return sine + (cosine * small + sine * less), cosine + (cosine * less - sine * small)
