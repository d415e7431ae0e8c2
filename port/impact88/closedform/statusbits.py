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
"""What may be gained of the initial kinetic energy before it counts: some thousand roundings."""
FRICTION_TOLERANCE = 1e-9
"""How far P_t/P_n may lie outside what friction can do: above the rounding of a coefficient typed
or solved for, below the last digit anyone gives."""
SIDE_TOLERANCE = 1e-9
"""How far a center may lie beyond the contact plane, of its distance to the contact point."""
LISTING_MISREADS = PIVOT
"""Line 510 takes any MU not above this for a pivot."""


def friction_faults(
    gn: Array, pn: Array, mu: Array, pivot_pn: Array, pivot_pt: Array
) -> tuple[Array, Array]:
    """(above critical, wrong direction): where friction cannot make an impact.

    ``gn``: normal relative velocity before, ``pn``: normal impulse on A, ``mu``: P_t/P_n with its
    sign, 0 for a pivot; ``pivot_pn``, ``pivot_pt``: the impulse on A if the sliding ended at
    separation. They broadcast.

    In an approach (gn < 0, Pn > 0) friction is admissible from 0 to what ends the sliding: the
    pivot's P_t/P_n, MUC. With less some of the sliding is left, against which friction still acts;
    with more it is reversed. A normal impulse on eccentric contact turns the sliding round without
    any friction, so its direction before the impact decides nothing. Where the pivot's normal
    impulse would pull, no friction ends the sliding, and any in the pivot's direction is
    admissible. Where MUC is 0 no friction is, for without it the points do not slide apart.
    """
    room = FRICTION_TOLERANCE
    approach, limited = (gn < 0) & (pn > 0), pivot_pn > 0
    most = np.abs(pivot_pt)
    forward = np.where(pivot_pt < 0, -mu, mu)
    backward = approach & (forward < -room)
    none = limited & (most <= room * pivot_pn)
    above = approach & limited & ((forward - room) * pivot_pn > most)
    return above | backward & none, backward & ~none & (most > 0)


def set_bits(
    gn: Array,
    pn: Array,
    arm_a: Array,
    arm_b: Array,
    da: Array,
    db: Array,
    twice_lost: Array,
    initial: Array,
    e: Array,
    em: Array,
    friction_mu: Array,
    pivot_pn: Array,
    pivot_pt: Array,
    condition: Array,
    sum_of_velocities: Array,
    out: Array,
) -> None:
    """Set in ``out`` (integers) every bit by its own rule; one that cannot be decided (NaN) stays
    clear, but for NOT_FINITE and SINGULAR, which NaN is reason enough for.

    ``gn``: normal relative velocity at the contact point, A minus B; ``pn``: normal impulse on A;
    ``arm_a``, ``arm_b``: the tangential lever arms, minus the distances of A's and B's center from
    the contact plane, each towards its own side; ``da``, ``db``: the distances to the contact
    point; ``twice_lost`` and ``initial``: energies; ``friction_mu``: MU with its sign, 0 for a
    pivot; ``pivot_pn``, ``pivot_pt``: see `friction_faults`; ``condition``: COND. They broadcast.
    """

    def set_where(bit: Status, condition: Array) -> None:
        np.bitwise_or(out, condition * out.dtype.type(bit), out=out)

    out.fill(0)
    set_where(Status.SEPARATING, gn >= 0)
    set_where(Status.PULLING, pn < 0)
    set_where(Status.ENERGY_GAINED, -twice_lost > (2 * ENERGY_TOLERANCE) * initial)
    set_where(Status.E_OUT_OF_RANGE, (e < 0) | (e > 1))
    # NaN: 0/0 in the condition itself, as singular as can be
    set_where(Status.SINGULAR, ~(condition < SINGULAR_FROM))
    # what the sum of velocities does not show, the energies and the quotients do
    for value in (sum_of_velocities, initial - 0.5 * twice_lost, twice_lost / initial):
        set_where(Status.NOT_FINITE, ~np.isfinite(value))
    set_where(Status.NOT_FINITE, np.isnan(condition))
    set_where(Status.A_ON_WRONG_SIDE, arm_a > SIDE_TOLERANCE * np.abs(da))
    set_where(Status.B_ON_WRONG_SIDE, arm_b > SIDE_TOLERANCE * np.abs(db))
    set_where(Status.EM_OUT_OF_RANGE, (em < -1) | (em > 0) & (em != 1))
    set_where(Status.MU_OUT_OF_RANGE, friction_mu <= LISTING_MISREADS)
    above, wrong = friction_faults(gn, pn, friction_mu, pivot_pn, pivot_pt)
    set_where(Status.FRICTION_ABOVE_CRITICAL, above)
    set_where(Status.FRICTION_WRONG_DIRECTION, wrong)


register("status", set_bits)
