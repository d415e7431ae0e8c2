"""A floating-point filter for STATUS: its bits from an estimate of the impact and a bound of the
estimate's error.

A comparison whose sides are farther apart than the bound has the outcome that the results
themselves would give. A scene in which one comparison is closer, or in which SINGULAR or NOT_FINITE
may be set, is marked `UNDECIDED`, and the full kernel computes it.

The estimate takes the restitution equation (15) and no slip (lines 430-440), with the moment
equation (18) eliminated from them. With z = 1 - 2 em, q = 1 - em, T = q Ired, and K what a unit of
impulse adds to the relative velocity (g_n, g_t) of the contact points::

    A_ij = z K_ij - T kappa_i kappa_j
    r_n = T kappa_n (omega_a - omega_b) - z (1 + e) g_n
    r_t = T kappa_t (omega_a - omega_b) - z g_t

    friction:  (A_nn + mu A_nt) Pn = r_n,  Pt = mu Pn        pivot:  A P = r

No sum of terms in it exceeds in size products of

    Z = |z| + |q|,  F = 2,  K = K_nn + K_tt,  V = |dx| + |dy| + (|DA| + |DB|) (|WA| + |WB|)

(|A_ij| <= Z K, as Ired kappa_i kappa_j <= K by Cauchy's inequality; |r| <= Z F V, as |e| <= 1), and
none in the formulas of `closedform.impact` does. A result takes fewer than a hundred roundings on
the way, and so does its estimate: they differ by less than `ROUNDINGS` of these products.

What is divided by a determinant D has an error greater by `growth`, g = Z K (1 + |mu|)/|D|, or
(Z K)^2/|D| of a pivot. With |z| > Z/4 the impulse is at most 2 F V g/K, and what it changes of the
sliding at most 20 g V. In the energies V may be replaced by 2 sqrt(KI K), since each term has the
velocities of bodies only with their own arms: the terms are at most some hundred times g^2 KI,
and their errors parts of 7500 g^3 KI.
"""

from typing import Any, NamedTuple

from ...status import Status
from ..native.formulas import Expression, ExpressionTable
from .statusbits import FRICTION_TOLERANCE, findings, one_way_faults

MODERATE = 1e15
"""Largest size of a scene's numbers for a filter; the least inertia is its inverse. No product in
it or in a final velocity then exceeds 1e300."""
UNDECIDED = 0x8000
"""Bit beside STATUS's that a filter sets; no caller sees it."""
ROUNDINGS = 2.0**-43
"""Bound of what estimate and results differ by, as a part of the product that bounds their terms:
1024 units of rounding."""
REGULAR = 2.0**-10
"""Least determinant that is decided on, as a part of the product that bounds its terms. COND is at
most 27 times the inverse, far below `statusbits.SINGULAR_FROM`."""
LARGEST_E = 1.0
"""Largest size of E for a filter."""
LARGEST_LOSS = 1e150
"""Largest loss, as a part of the initial energy, that is certain to be finite in all results."""

LEAST_LOSS = 1e-60
"""Added to the loss, so that the initial energy is at least 1e-210, and no square underflows."""


class Impulse(NamedTuple):
    """An impulse as far as STATUS depends on it."""

    normal: Any
    turning: Any
    yielding: Any
    twice_lost: Any


def _far_apart(terms: tuple[Any, Any, Any], bound: Any, margin: Any) -> Any:
    """Return where the comparisons of `statusbits.slides_forth_and_back` are certain.

    ``terms``: the sliding before, and what the normal and the tangential impulse change of it, all
    at most 20 times ``bound`` in size and known to a ninth of ``margin``.
    """
    gt, turning, across = terms
    size = abs(turning)
    excess = abs(gt) + abs(gt) - size
    gap, rest = excess - across, excess - 3.0 * size
    # where the sign of the turning is not certain, it is too slight to reverse the sliding
    far = (size + abs(gt) > 5.0 * margin) & (abs(excess) > margin)
    far = far & (abs(rest) > margin) & (abs(gap) > margin)
    return far & (abs(gap * gap - 4.0 * (size * across)) > 200.0 * (margin * bound))


def filtered_status(
    table: ExpressionTable,
    pivot: bool | Expression,
    exact: Impulse | None,
    *,
    e: Expression,
    em: Expression,
    mu: Expression,
    da: Expression,
    db: Expression,
    wa: Expression,
    wb: Expression,
    dx: Expression,
    dy: Expression,
    gn: Expression,
    gt: Expression,
    arms: tuple[Expression, Expression, Expression, Expression],
    inverses: tuple[Expression, Expression, Expression],
    reduced: Expression,
    initial: Expression,
) -> Expression:
    """Return STATUS, `UNDECIDED` among its bits.

    ``exact``: the impulse where a kernel computes it for other results, else None. ``arms``: A's
    along n and t, B's along n and t; ``inverses``: 1/MA + 1/MB, 1/IA, 1/IB; ``reduced``: Ired;
    ``initial``: kinetic energy; the others as in `statusbits.findings`.
    """
    absolute = table.absolute
    an, at, bn, bt = arms
    R, ia, ib = inverses
    z, q = 1.0 - (em + em), 1.0 - em
    gw, T = wa - wb, q * reduced

    # -- the equations, and the bounds of their terms
    ian, iat, ibn, ibt = ia * an, ia * at, ib * bn, ib * bt
    Knn, Knt, Ktt = R + (an * ian + bn * ibn), an * iat + bn * ibt, R + (at * iat + bt * ibt)
    kn, kt = ian - ibn, iat - ibt
    Tkn, Tkt = T * kn, T * kt
    Ann, Ant, Att = z * Knn - Tkn * kn, z * Knt - Tkn * kt, z * Ktt - Tkt * kt
    rn, rt = Tkn * gw - (z * (1.0 + e)) * gn, Tkt * gw - z * gt
    Z, K = absolute(z) + absolute(q), Knn + Ktt
    V = absolute(dx) + absolute(dy) + (absolute(da) + absolute(db)) * (absolute(wa) + absolute(wb))
    ZK, speed_margin = Z * K, ROUNDINGS * V
    right_margin = Z * (speed_margin + speed_margin)
    margin, largest = right_margin * ZK, ZK * ZK
    certain = absolute(z) > 0.25 * Z

    # -- the pivot's impulse times its determinant
    pivot_determinant = Ann * Att - Ant * Ant
    pivot_n, pivot_t = rn * Att - rt * Ant, rt * Ann - rn * Ant

    # -- the impulse
    def pick(of_pivot: Expression, of_friction: Expression) -> Expression:
        if isinstance(pivot, bool):
            return of_pivot if pivot else of_friction
        return table.choose(pivot, of_pivot, of_friction)

    grip = 1.0 + absolute(mu)
    determinant = pick(pivot_determinant, Ann + mu * Ant)
    largest_determinant = pick(largest, ZK * grip)
    certain = certain & (absolute(determinant) > REGULAR * largest_determinant)
    if exact is None:
        inverse = 1.0 / (determinant * z)
        of_z, of_determinant = inverse * determinant, inverse * z
        numerator = pick(pivot_n, rn)
        normal = numerator * of_determinant
        tangential = pick(pivot_t * of_determinant, mu * normal)
        spinning = kn * normal + kt * tangential + gw
        moment = -((T * of_z) * spinning)
        turning = Knt * normal + kt * moment
        slip = pick(gt, gt + gt + (Ktt * tangential + turning))
        lost = ((1.0 - e) * gn) * normal + tangential * slip
        lost = -(lost + moment * (gw - (em * of_z) * spinning))
        impulse = Impulse(normal, turning, Ktt, lost)
        certain = certain & (absolute(numerator) > pick(margin, right_margin))
        growth = largest_determinant * absolute(of_determinant)
        energy_margin = ((8e3 * ROUNDINGS) * ((growth * growth) * growth)) * initial
        certain = certain & (absolute(lost) > energy_margin)
    else:
        impulse = exact
    lost = absolute(impulse.twice_lost)
    certain = certain & (lost + LEAST_LOSS < LARGEST_LOSS * initial)

    # -- the bits, and which of friction's comparisons are too close
    pivot_pn, limit = table.against(pivot_n, -pivot_determinant), absolute(pivot_t)
    forward = table.against(mu, -(pivot_t * pivot_determinant))
    status = findings(
        gn=gn,
        pn=impulse.normal,
        arm_a=at,
        arm_b=bt,
        da=da,
        db=db,
        twice_lost=impulse.twice_lost,
        initial=initial,
        e=e,
        em=em,
        friction_mu=mu,
        forward=forward,
        pivot_pn=pivot_pn,
        limit=limit,
        gt=gt,
        turning=impulse.turning,
        yielding=impulse.yielding,
        condition=R,
        sum_of_velocities=R,
    )
    del status[Status.SINGULAR], status[Status.NOT_FINITE]
    if pivot is True:
        del status[Status.FRICTION_ABOVE_CRITICAL], status[Status.FRICTION_WRONG_DIRECTION]
    else:
        pushing = absolute(pivot_n)
        excess = (absolute(mu) - FRICTION_TOLERANCE) * pushing - limit
        rest = limit - FRICTION_TOLERANCE * pushing
        decided = absolute(pivot_determinant) > ROUNDINGS * largest
        decided = decided & (absolute(rest) > margin) & (absolute(excess) > margin * grip)
        decided = decided & ((limit > margin) | (pivot_pn > 0.0))
        if exact is None:
            faults = one_way_faults(gn, impulse.normal, forward, pivot_pn, limit)
            gap_terms = gt, turning, (absolute(mu) - FRICTION_TOLERANCE) * (normal * Ktt)
            far = _far_apart(gap_terms, growth * V, (100.0 * growth) * (growth * speed_margin))
            decided = decided & (~(faults[0] | faults[1]) | far)
        certain = certain & (decided if pivot is False else decided | pivot)
    bits = [condition * float(bit) for bit, condition in status.items()]
    bits.append(~certain * float(UNDECIDED))
    status_bits: Expression = sum(bits[1:], bits[0])
    return status_bits
