"""STATUS: one rule for each bit of `impact88.status.Status`.

The rules are comparisons joined by & | ~, so that the same code serves arrays and `Expression`s. A
comparison with NaN is false: a bit that cannot be decided stays clear.
"""

from math import inf
from typing import Any, NamedTuple

import numpy as np

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
RANGES = {"E": (0.0, 1.0), "EM": (-1.0, 0.0)}
"""Least and greatest coefficients; EM = 1 beside them stands for no moment impulse."""
LISTING_MISREADS = PIVOT
"""Line 510 takes any MU up to this for a pivot."""


UNKNOWN = np.float64(np.nan)
"""A value that is not known; of numpy, whose conditions take ``~``."""


class Evidence(NamedTuple):
    """Numbers that STATUS is judged by, which broadcast. One that is `UNKNOWN` leaves clear the
    bits that need it, but NOT_FINITE and SINGULAR.

    ``gn``: normal relative velocity at the contact point before, A minus B; ``pn``: normal impulse
    on A; ``twice_lost`` and ``initial``: energies; ``e``, ``em``: E and EM.

    Of the sides: ``arm_a``, ``arm_b``: the tangential lever arms, minus the distances of A's and
    B's center from the contact plane, each towards its own side; ``da``, ``db``: the distances to
    the contact point.

    Of friction: ``mu``: MU, or P_t/P_n, with its sign, 0 for a pivot; ``forward``: the same with
    the sign of the pivot's P_t; ``pivot_pn``, ``limit``: P_n and the size of P_t on A if the
    sliding ended at separation; ``gt``, ``turning``, ``yielding``: see `slides_forth_and_back`.

    Of the numbers: ``condition``: COND; ``sum_of_velocities``: of all six final ones.
    """

    gn: Any
    pn: Any
    twice_lost: Any
    initial: Any
    e: Any
    em: Any
    arm_a: Any = UNKNOWN
    arm_b: Any = UNKNOWN
    da: Any = UNKNOWN
    db: Any = UNKNOWN
    mu: Any = UNKNOWN
    forward: Any = UNKNOWN
    pivot_pn: Any = UNKNOWN
    limit: Any = UNKNOWN
    gt: Any = UNKNOWN
    turning: Any = UNKNOWN
    yielding: Any = UNKNOWN
    condition: Any = UNKNOWN
    sum_of_velocities: Any = UNKNOWN


def friction_faults(x: Evidence) -> tuple[Any, Any]:
    """Return (above critical, wrong direction): where friction cannot make an impact.

    In an approach (gn < 0, Pn > 0) friction is admissible from 0 to what ends the sliding, the
    pivot's P_t/P_n, MUC; with more it is reversed. The direction of the sliding before the impact
    decides nothing by itself: a normal impulse on eccentric contact can turn it round without
    friction, and before it does friction may act the other way. Where the pivot's normal impulse
    would pull, no friction ends the sliding, and any in the pivot's direction is admissible. Where
    MUC is 0, none is admissible.
    """
    above, wrong = one_way_faults(x.gn, x.pn, x.forward, x.pivot_pn, x.limit)
    possible = slides_forth_and_back(x.pn, x.mu, x.gt, x.turning, x.yielding)
    return above & ~possible, wrong & ~possible


def forward_friction(mu: Any, pivot_pt: Any) -> Any:
    """Return mu along the pivot's P_t, ``pivot_pt``; of arrays."""
    return mu * (1 - 2 * (pivot_pt < 0))


def one_way_faults(gn: Any, pn: Any, forward: Any, pivot_pn: Any, limit: Any) -> tuple[Any, Any]:
    """Return (above critical, wrong direction) of friction that acts one way throughout; the
    arguments are those of `Evidence`."""
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


def findings(x: Evidence) -> dict[Status, Any]:
    """Return, for each bit, the condition under which it is set. A NaN sets only NOT_FINITE and
    SINGULAR."""
    above, wrong = friction_faults(x)
    # velocities that cancel in the sum are infinite in the energies and their quotients
    finite = abs(x.sum_of_velocities) < inf
    finite = (
        finite & (abs(x.initial - 0.5 * x.twice_lost) < inf) & (abs(x.twice_lost / x.initial) < inf)
    )
    (least_e, most_e), (least_em, most_em) = RANGES.values()
    return {
        Status.SEPARATING: x.gn >= 0,
        Status.PULLING: x.pn < 0,
        Status.ENERGY_GAINED: -x.twice_lost > (2 * ENERGY_TOLERANCE) * x.initial,
        Status.E_OUT_OF_RANGE: (x.e < least_e) | (x.e > most_e),
        # a NaN in COND is 0/0: singular, too
        Status.SINGULAR: ~(x.condition < SINGULAR_FROM),
        Status.NOT_FINITE: ~(finite & (x.condition <= inf)),
        Status.A_ON_WRONG_SIDE: x.arm_a > SIDE_TOLERANCE * abs(x.da),
        Status.B_ON_WRONG_SIDE: x.arm_b > SIDE_TOLERANCE * abs(x.db),
        Status.EM_OUT_OF_RANGE: (x.em < least_em) | (x.em > most_em) & ((x.em < 1) | (x.em > 1)),
        Status.MU_OUT_OF_RANGE: x.mu <= LISTING_MISREADS,
        Status.FRICTION_ABOVE_CRITICAL: above,
        Status.FRICTION_WRONG_DIRECTION: wrong,
    }


def bits(conditions: dict[Status, Any]) -> Any:
    """Return STATUS, as integers, of conditions by bit over arrays, which broadcast."""
    return sum(condition * int(bit) for bit, condition in conditions.items())
