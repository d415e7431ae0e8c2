"""Table and polynomials for sine and cosine of degrees, and both functions of one angle.

Uses Python's own numbers only, so that a scene is read without numpy; arrays: `collision.degrees`.
"""

from collections.abc import Callable
from decimal import Context, Decimal, localcontext
from functools import cache
from typing import Any

STEPS = 2048
"""Table entries in a full turn."""
STEP = 360 / STEPS
"""45/256 degree: exact, as is its product with any whole number below 2**47."""

_PI = Decimal("3.14159265358979323846264338327950288419716939937510")
_QUARTER = STEPS // 4
INTEGER_IN_LOW_BITS = 1.5 * 2.0**52  # adding it rounds a double to the nearest integer


@cache
def turn() -> list[float]:
    """Return sin(k STEP) for a turn and a quarter: entry k + STEPS/4 is the cosine."""
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
    """Return a Taylor series: of the sine for term = x, first = 3, of the cosine for 1 and 2."""
    total = term
    for n in range(first, 25, 2):
        term = -term * x * x / (n * (n - 1))
        total += term
    return total


with localcontext(Context(prec=40)):
    _r = _PI / 180
    POLYNOMIALS = tuple(map(float, (_r, -(_r**3) / 6, _r**5 / 120, -(_r**2) / 2, _r**4 / 24)))
"""Taylor coefficients of sin r = r (s0 + s1 r² + s2 r⁴) and cos r - 1 = r² (c1 + c2 r²), r in
degrees. At |r| = STEP/2 the first omitted term is below 3e-21 (sine) and 2e-20 (cosine)."""


def sine_and_cosine(
    angle: Any, table: Any = None, whole: Callable[[Any], Any] = int
) -> tuple[Any, Any]:
    """Return sine and cosine of a finite angle in degrees, at most 2**40.

    For arrays, ``table`` is `turn` as an array and ``whole`` converts an array to integers. The
    order of operations is that of ``native/impacts.h``, so that the bits agree."""
    table = turn() if table is None else table
    s0, s1, s2, c1, c2 = POLYNOMIALS
    steps = angle * (1 / STEP) + INTEGER_IN_LOW_BITS - INTEGER_IN_LOW_BITS
    index = whole(steps) & (STEPS - 1)
    sine, cosine = table[index], table[index + _QUARTER]
    remainder = angle - steps * STEP
    square = remainder * remainder
    sin_r = ((square * s2 + s1) * square + s0) * remainder
    cos_r_less_one = (square * c2 + c1) * square
    # sin(k + r) = sin k + (cos k sin r + sin k (cos r - 1)), and the cosine likewise
    return (
        sine + (cosine * sin_r + sine * cos_r_less_one),
        cosine + (cosine * cos_r_less_one - sine * sin_r),
    )
