"""STATUS over arrays: one rule a bit of `impact88.status.Status`, for every solver."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..names import PIVOT
from ..status import Status
from .plan import register

Array = NDArray[Any]

SINGULAR_FROM = 2.0**26
"""COND from which SINGULAR is set: 1/sqrt(unit roundoff). Half of a double's digits may be lost
there, and of the 32 bits of the 1988 program's numbers a handful at most are left."""
ENERGY_TOLERANCE = 1e-12
"""What may be gained, or friction may drive, of the initial kinetic energy before it counts."""
SLIP_TOLERANCE = 1e-12
"""Product of the slips before and after, of the square of the closing speed: a slip of a millionth
of it is none, so that rounding cannot make a scene at the critical friction slide back."""
SIDE_TOLERANCE = 1e-9
"""How far a center may lie beyond the contact plane, of its distance to the contact point."""
LISTING_MISREADS = PIVOT
"""Line 510 takes any MU not above this for a pivot."""


def set_bits(
    gn: Array,
    gt: Array,
    after_gt: Array,
    pn: Array,
    pt: Array,
    arm_a: Array,
    arm_b: Array,
    da: Array,
    db: Array,
    twice_lost: Array,
    initial: Array,
    e: Array,
    em: Array,
    friction_mu: Array,
    condition: Array,
    sum_of_velocities: Array,
    out: Array,
) -> None:
    """Set in ``out`` (integers) every bit by its own rule; one that cannot be decided (NaN) stays
    clear, but for NOT_FINITE and SINGULAR, which NaN is reason enough for.

    ``gn``, ``gt``, ``after_gt``: relative velocities at the contact point, A minus B; ``pn``,
    ``pt``: the impulse on A; ``arm_a``, ``arm_b``: the tangential lever arms, minus the distances
    of A's and B's center from the contact plane, each towards its own side; ``da``, ``db``: the
    distances to the contact point; ``twice_lost`` and ``initial``: energies; ``friction_mu``: MU
    with its sign, 0 for a pivot; ``condition``: COND. They broadcast.
    """

    def set_where(bit: Status, condition: Array) -> None:
        np.bitwise_or(out, condition * out.dtype.type(bit), out=out)

    out.fill(0)
    set_where(Status.SEPARATING, gn >= 0)
    set_where(Status.PULLING, pn < 0)
    set_where(Status.SLIDING_REVERSED, -gt * after_gt > SLIP_TOLERANCE * gn * gn)
    set_where(Status.ENERGY_GAINED, -twice_lost > (2 * ENERGY_TOLERANCE) * initial)
    set_where(Status.E_OUT_OF_RANGE, (e < 0) | (e > 1))
    # NaN: 0/0 in the condition itself, as singular as can be
    set_where(Status.SINGULAR, ~(condition < SINGULAR_FROM))
    # what the sum of velocities does not tell, the energies and the quotients do
    for value in (sum_of_velocities, initial - 0.5 * twice_lost, twice_lost / initial):
        set_where(Status.NOT_FINITE, ~np.isfinite(value))
    set_where(Status.NOT_FINITE, np.isnan(condition))
    set_where(Status.FRICTION_DRIVES, pt * gt > ENERGY_TOLERANCE * initial)
    set_where(Status.A_ON_WRONG_SIDE, arm_a > SIDE_TOLERANCE * np.abs(da))
    set_where(Status.B_ON_WRONG_SIDE, arm_b > SIDE_TOLERANCE * np.abs(db))
    set_where(Status.EM_OUT_OF_RANGE, (em < -1) | (em > 0) & (em != 1))
    set_where(Status.MU_OUT_OF_RANGE, friction_mu <= LISTING_MISREADS)


register("status", set_bits)
