"""STATUS: one rule for each bit of `impact88.status.Status`.

The rules are comparisons joined by & | ~, so that the same code serves arrays and `Expression`s. A
comparison with NaN is false: a bit that cannot be decided stays clear.
"""

from math import inf
from typing import Any

from ...names import PIVOT
from ...status import Status

SINGULAR_FROM = 2.0**26
"""Least COND of a SINGULAR scene: 1/sqrt(unit roundoff). Half of a double's digits may be lost
there, and at most a handful of the 32 bits of the 1988 program's numbers are left."""
ENERGY_TOLERANCE = 1e-12
"""Gain below this fraction of the initial kinetic energy is rounding: some thousand roundings."""
FRICTION_TOLERANCE = 1e-9
"""Absolute tolerance of P_t/P_n: above the rounding of a coefficient typed or solved for, below the
last digit anyone gives."""
SIDE_TOLERANCE = 1e-9
"""A center this far beyond the contact plane, as a fraction of its distance to the contact point,
is still on its own side."""
LISTING_MISREADS = PIVOT
"""Line 510 takes any MU up to this for a pivot."""


def friction_faults(
    gn: Any,
    pn: Any,
    mu: Any,
    forward: Any,
    pivot_pn: Any,
    limit: Any,
    gt: Any = 0.0,
    turning: Any = 0.0,
    yielding: Any = 0.0,
) -> tuple[Any, Any]:
    """Return (above critical, wrong direction): where friction cannot make an impact.

    ``gn``: normal relative velocity before, ``pn``: normal impulse on A, ``mu``: P_t/P_n with its
    sign, 0 for a pivot; ``forward``: the same with the sign of the pivot's P_t; ``pivot_pn``,
    ``limit``: P_n and the size of P_t on A if the sliding ended at separation; ``gt``, ``turning``,
    ``yielding``: see `slides_forth_and_back`. They broadcast.

    In an approach (gn < 0, Pn > 0) friction is admissible from 0 to what ends the sliding, the
    pivot's P_t/P_n, MUC; with more it is reversed. The direction of the sliding before the impact
    decides nothing by itself: a normal impulse on eccentric contact can turn it round without
    friction, and before it does friction may act the other way. Where the pivot's normal impulse
    would pull, no friction ends the sliding, and any in the pivot's direction is admissible. Where
    MUC is 0, none is admissible.
    """
    above, wrong = one_way_faults(gn, pn, forward, pivot_pn, limit)
    possible = slides_forth_and_back(pn, mu, gt, turning, yielding)
    return above & ~possible, wrong & ~possible


def forward_friction(mu: Any, pivot_pt: Any) -> Any:
    """Return mu along the pivot's P_t, ``pivot_pt``; of arrays."""
    return mu * (1 - 2 * (pivot_pt < 0))


def one_way_faults(gn: Any, pn: Any, forward: Any, pivot_pn: Any, limit: Any) -> tuple[Any, Any]:
    """Return (above critical, wrong direction) of friction that acts one way throughout; the
    arguments are those of `friction_faults`."""
    approach, pivot_pushes = (gn < 0) & (pn > 0), pivot_pn > 0
    backward = approach & (forward < -FRICTION_TOLERANCE)
    frictionless = pivot_pushes & (limit <= FRICTION_TOLERANCE * pivot_pn)
    above = approach & pivot_pushes & ((forward - FRICTION_TOLERANCE) * pivot_pn > limit)
    return above | backward & frictionless, backward & ~frictionless & (limit > 0)


def slides_forth_and_back(pn: Any, mu: Any, gt: Any, turning: Any, yielding: Any) -> Any:
    """Return where friction can make the impact by acting against the sliding before it for as
    long as that lasts, and the other way, less long, after the normal impulse has reversed it.

    ``gt``: the sliding before, along t; ``turning``: K Pn, what the normal impulse, and the moment
    in proportion to it, adds to the sliding; ``yielding``: K_tt, what a unit of the tangential
    impulse adds.

    Let friction of coefficient m act against the sliding, and the normal impulse reverse it after
    p1 = abs(gt)/(m K_tt + abs(K)) of Pn. The net impulse is Pt = m (Pn - 2 p1) along the sliding
    before. Its least value over m is

        -Pn (w - abs(K))^2 / (abs(K) K_tt)  with  w^2 = 2 abs(gt K)/Pn,

    for abs(gt/K) between Pn/2 and 2 Pn. Below that, it only ever acts along the sliding before;
    above, friction that ends the sliding is the most. Written here without the root: with b =
    2 abs(gt) - abs(K) Pn and a = abs(Pt) K_tt, b >= a and (b - a)^2 >= 4 abs(K) Pn a.
    """
    size = abs(turning)
    across = (abs(mu) - FRICTION_TOLERANCE) * (pn * yielding)
    excess = abs(gt) + abs(gt) - size
    gap = excess - across
    # each condition is negated, so that a NaN counts as possible
    one_way = (gt * turning >= 0) | (mu * gt >= 0)
    outside = (excess <= 0) | (excess >= 3.0 * size)
    return ~(one_way | outside | (gap < 0) | (gap * gap < 4.0 * (size * across)))


def findings(
    gn: Any,
    pn: Any,
    arm_a: Any,
    arm_b: Any,
    da: Any,
    db: Any,
    twice_lost: Any,
    initial: Any,
    e: Any,
    em: Any,
    friction_mu: Any,
    forward: Any,
    pivot_pn: Any,
    limit: Any,
    gt: Any,
    turning: Any,
    yielding: Any,
    condition: Any,
    sum_of_velocities: Any,
) -> dict[Status, Any]:
    """Return, for each bit, the condition under which it is set. A NaN sets only NOT_FINITE and
    SINGULAR.

    ``gn``: normal relative velocity at the contact point, A minus B; ``pn``: normal impulse on A;
    ``arm_a``, ``arm_b``: the tangential lever arms, minus the distances of A's and B's center from
    the contact plane, each towards its own side; ``da``, ``db``: the distances to the contact
    point; ``twice_lost`` and ``initial``: energies; ``friction_mu``: MU with its sign, 0 for a
    pivot; ``forward``, ``pivot_pn``, ``limit``, ``gt``, ``turning``, ``yielding``: see
    `friction_faults`; ``condition``: COND. They broadcast.
    """
    sliding = gt, turning, yielding
    above, wrong = friction_faults(gn, pn, friction_mu, forward, pivot_pn, limit, *sliding)
    # velocities that cancel in the sum are infinite in the energies and their quotients
    finite = abs(sum_of_velocities) < inf
    finite = finite & (abs(initial - 0.5 * twice_lost) < inf) & (abs(twice_lost / initial) < inf)
    return {
        Status.SEPARATING: gn >= 0,
        Status.PULLING: pn < 0,
        Status.ENERGY_GAINED: -twice_lost > (2 * ENERGY_TOLERANCE) * initial,
        Status.E_OUT_OF_RANGE: (e < 0) | (e > 1),
        # a NaN in COND is 0/0: singular, too
        Status.SINGULAR: ~(condition < SINGULAR_FROM),
        Status.NOT_FINITE: ~(finite & (condition <= inf)),
        Status.A_ON_WRONG_SIDE: arm_a > SIDE_TOLERANCE * abs(da),
        Status.B_ON_WRONG_SIDE: arm_b > SIDE_TOLERANCE * abs(db),
        Status.EM_OUT_OF_RANGE: (em < -1) | (em > 0) & ((em < 1) | (em > 1)),
        Status.MU_OUT_OF_RANGE: friction_mu <= LISTING_MISREADS,
        Status.FRICTION_ABOVE_CRITICAL: above,
        Status.FRICTION_WRONG_DIRECTION: wrong,
    }


def bits(conditions: dict[Status, Any]) -> Any:
    """Return STATUS, as integers, of conditions by bit over arrays, which broadcast."""
    return sum(condition * int(bit) for bit, condition in conditions.items())
