"""Kinetic energy before and after an impact: one text for every solver.

Plain sums and products, so that they serve arrays, numbers and the `Expression`s of a plan alike.
"""

from collections.abc import Sequence
from typing import Any


def kinetic_energy(inertias: Sequence[Any], velocities: Sequence[Any]) -> Any:
    """Lines 320, 580 and 590 of the listing. ``inertias``: MA MB IA IB, an infinite one (at rest)
    given as 0; ``velocities``: in the order of ``names.VELOCITIES``, spins 0 for point masses."""
    ma, mb, ia, ib = inertias
    ax, ay, wa, bx, by, wb = velocities
    moving = ma * (ax * ax + ay * ay)
    moving = moving + mb * (bx * bx + by * by)
    moving = moving + ia * (wa * wa) + ib * (wb * wb)
    return 0.5 * moving
