"""Sine and cosine of angles in degrees, over arrays, the same bits on every machine: an angle is
split exactly into the nearest multiple of 45/256 degree, whose sine and cosine come from a table,
and a remainder, whose come from two short polynomials; the addition theorem joins them.

Error: below 3 units in the last place (2.7 seen, close to multiples of 90 degrees; 1 elsewhere);
quarter turns give exactly 0, 1 and -1. numpy's functions take radians, so that a right angle is
never right, and round as the machine's mathematical library pleases.
"""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from . import sinetable

Floats = NDArray[np.float64]


@cache
def table() -> Floats:
    """`sinetable.turn` as an array."""
    array = np.array(sinetable.turn())
    array.flags.writeable = False
    return array


def sine_and_cosine(angle: Floats) -> tuple[Floats, Floats]:
    """The sine and cosine of ``angle`` (degrees), at most 2**40; NaN of what is not finite."""
    return sinetable.sine_and_cosine(angle, table(), lambda steps: steps.astype(np.int64))


def sin_cos(angle: object) -> tuple[Floats, Floats]:
    """The sine and cosine of angles in degrees, of any size and shape."""
    with np.errstate(invalid="ignore"):
        return sine_and_cosine(np.fmod(np.asarray(angle, dtype=np.float64), 360.0))
