"""Kinetic energy before and after an impact, the same code for every solver.

It consists of sums and products, so that it serves arrays, numbers and `Expression`s alike.
"""

from collections.abc import Sequence
from typing import Any


def kinetic_energy(inertias: Sequence[Any], velocities: Sequence[Any]) -> Any:
    """Return the kinetic energy of lines 320, 580 and 590.

    ``inertias``: MA MB IA IB, an infinite one (at rest) given as 0; ``velocities``: in the order of
    ``names.VELOCITIES``, spins 0 for point masses."""
    ma, mb, ia, ib = inertias
    ax, ay, wa, bx, by, wb = velocities
    moving = ma * (ax * ax + ay * ay)
    moving = moving + mb * (bx * bx + by * by)
    moving = moving + ia * (wa * wa) + ib * (wb * wb)
    return 0.5 * moving
