"""Sine and cosine of angles in degrees, over arrays, the same bits on every machine.

numpy's ``sin`` and ``cos`` take radians, so that a right angle is never right, and they round as
the machine's mathematical library pleases. Here an angle is split exactly into the nearest
multiple of 45/256 degree and a remainder of at most 45/512 degree: both are exact, because the
step has few bits. The multiple's sine and cosine come from a table (correctly rounded, made with
40-digit decimals); the remainder's from two short polynomials; the addition theorem joins them.
Only IEEE additions, multiplications and a table look-up are used, in a fixed order.

Error: below 3 units in the last place of the result (2.7 seen, close to multiples of 90 degrees,
where the table's entry is larger than the result; 1 elsewhere); quarter turns give exactly 0, 1
and -1.
"""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from .sinetable import INTEGER_IN_LOW_BITS, POLYNOMIALS, STEP, STEPS, turn

Floats = NDArray[np.float64]

LARGEST = 2.0**40
"""Angles beyond this (in degrees) must be taken modulo 360 by the caller first."""

_QUARTER = STEPS // 4
_S0, _S1, _S2, _C1, _C2 = POLYNOMIALS


@cache
def table() -> Floats:
    """`sinetable.turn` as an array."""
    array = np.array(turn())
    array.flags.writeable = False
    return array


def sine_and_cosine(
    angle: Floats, sine: Floats, cosine: Floats, work: tuple[Floats, Floats, Floats, Floats]
) -> None:
    """Write the sine and cosine of ``angle`` (degrees) into ``sine`` and ``cosine``.

    All are 1-d arrays of one length, ``work`` four more; none may overlap. |angle| at most
    `LARGEST`; an angle that is not finite gives NaN.
    """
    points = table()
    rest, square, small, less = work
    index = square.view(np.int64)
    np.multiply(angle, 1 / STEP, out=small)
    np.add(small, INTEGER_IN_LOW_BITS, out=small)
    np.bitwise_and(small.view(np.int64), STEPS - 1, out=index)
    points.take(index, out=sine, mode="clip")
    points[_QUARTER:].take(index, out=cosine, mode="clip")
    np.subtract(small, INTEGER_IN_LOW_BITS, out=small)
    np.multiply(small, STEP, out=small)
    np.subtract(angle, small, out=rest)
    np.multiply(rest, rest, out=square)
    np.multiply(square, _S2, out=small)
    np.add(small, _S1, out=small)
    np.multiply(small, square, out=small)
    np.add(small, _S0, out=small)
    np.multiply(small, rest, out=small)
    np.multiply(square, _C2, out=less)
    np.add(less, _C1, out=less)
    np.multiply(less, square, out=less)
    # sin(k + r) = sin k + (cos k sin r + sin k (cos r - 1)), and the cosine likewise
    np.multiply(cosine, small, out=rest)
    np.multiply(sine, less, out=square)
    np.add(rest, square, out=rest)
    np.multiply(sine, small, out=small)
    np.multiply(cosine, less, out=less)
    np.subtract(less, small, out=less)
    np.add(sine, rest, out=sine)
    np.add(cosine, less, out=cosine)


def sin_cos(angle: object) -> tuple[Floats, Floats]:
    """The sine and cosine of angles in degrees, of any size and shape."""
    flat = np.fmod(np.asarray(angle, dtype=np.float64), 360.0)
    shape, flat = flat.shape, flat.reshape(-1)
    sine, cosine, *work = (np.empty_like(flat) for _ in range(6))
    with np.errstate(invalid="ignore"):
        sine_and_cosine(flat, sine, cosine, (work[0], work[1], work[2], work[3]))
    return sine.reshape(shape), cosine.reshape(shape)
