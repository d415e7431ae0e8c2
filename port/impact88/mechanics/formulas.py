"""The planar impact of two bodies: every formula, once.

Each function computes a few quantities from others; its parameters are their names, so that a
result needs exactly the functions that lead to it (`plan`). numpy runs a function over arrays
unchanged, and `translate` prints it as a C loop. Bodies are therefore assignments of ``+ - * /``,
comparisons, ``& | ~``, `where`, `fabs`, `sqrt` and bits of `Status`, one name each, with decimal
points in all numbers; the last line returns the quantities that others may use, which are numbers,
never conditions. To add a result, write its function here, its row in `names.RESULTS` and its line
in `reference`.

Axes and signs: n = (cos GA, sin GA) and t = (-sin GA, cos GA), A on the +n side; the impulse acts
on A, and its opposite on B. Lower-case names: s, c sine and cosine of GA; ma, mb, ia, ib inverse
masses and inertias, 0 for a rigid barrier; an, at, bn, bt what a unit of spin adds to the velocity
of a contact point relative to the other's, along n and t; wa, wb, waf, wbf, em spins and EM, 0 for
point masses (M = 4), which have no arms and no moment; mu MU with the sign that line 400 gives it;
gn, gt relative velocity of the contact points before, A's minus B's, and cn, ct that of the
centers.

Method: the impulse is the unknown. It has a normal part Pn, a tangential part Pt and a moment
PM = (1 - em) h. Velocities after are those before plus impulse times inverse mass (Equations 13, 14
and 17). For the relative velocities of the contact points along n and t and of the spins, Equations
15, 16 (or no slip at separation) and 18 are two or three linear equations in Pn, Pt and h, solved
by Cramer's rule. Equation 18 is multiplied by z = 1 - 2 em, so that nothing is infinite at em =
1/2. The spins are taken as the mean spin (Ia wa + Ib wb)/(Ia + Ib), which the moment does not
change, and a difference. With R = ma + mb, J = 1/(Ia + Ib), Ired = Ia Ib J, s = a + b, k = a/Ia -
b/Ib, of both directions, w = e gn + cn and turn = Ired (wa - wb)::

    (R + J sn sn) Pn +      J sn st Pt + em kn h = -(w + sn mean)
         J st sn Pn + (R + J st st) Pt + em kt h = -(ct + st mean)      pivot; or Pt = mu Pn
          Ired kn Pn +      Ired kt Pt +    z h = -turn

For -1 <= em <= 0 both determinants are sums of terms of one sign (that of sliding while mu is
small): nothing cancels, however long the arms are and however unequal the bodies.
"""

from numpy import absolute as fabs
from numpy import inf, sqrt, where

from ..names import PIVOT
from ..status import Status

INF = inf
LARGEST = 1.7976931348623157e308  # the largest double
RADIAN = 0.017453292519943295  # of a degree
PER_QUARTER = 1.0 / 90.0  # quarter turns of a degree
ROUND = 6755399441055744.0  # 1.5 * 2**52: adding it rounds to an integer
LARGEST_ANGLE = 1e12  # degrees; the quarter turns of larger ones are not exact

E_MIN = 0.0
E_MAX = 1.0
EM_MIN = -1.0
EM_MAX = 0.0
NO_MOMENT = 1.0  # the EM that stands for no moment impulse

# tolerances of STATUS
SINGULAR_FROM = 67108864.0  # 2**26, COND: half of a double's digits may be lost
ENERGY_TOLERANCE = 2e-12  # twice the gain that is rounding, as a fraction of KI: 10^4 roundings
FRICTION_TOLERANCE = 1e-9  # of P_t/P_n: above rounding, below the last digit anyone types
SIDE_TOLERANCE = 1e-9  # of a center beyond the contact plane, as a fraction of its distance


def sine_and_cosine(degrees):
    """Return sine and cosine of an angle in degrees.

    Quarter turns are split off exactly; the rest, up to 45 degrees, goes by the series of fdlibm.
    """
    quarters = degrees * PER_QUARTER + ROUND - ROUND
    k = quarters - 4.0 * (0.25 * quarters + ROUND - ROUND)  # -2 ... 2
    r = (degrees - 90.0 * quarters) * RADIAN
    q = r * r
    sin_r = r + r * q * (
        -1.66666666666666324348e-01
        + q * (8.33333333332248946124e-03
        + q * (-1.98412698298579493134e-04
        + q * (2.75573137070700676789e-06
        + q * (-2.50507602534068634195e-08
        + q * 1.58969099521155010221e-10))))
    )  # fmt: skip
    cos_r = 1.0 - (0.5 * q - q * q * (
        4.16666666666666019037e-02
        + q * (-1.38888888888741095749e-03
        + q * (2.48015872894767294178e-05
        + q * (-2.75573143513906633035e-07
        + q * (2.08757232129817482790e-09
        + q * -1.13596475577881948265e-11))))
    ))  # fmt: skip
    sin_k = k * (2.0 - fabs(k))
    cos_k = 1.0 - fabs(k)
    sine = sin_k * cos_r + cos_k * sin_r
    cosine = cos_k * cos_r - sin_k * sin_r
    return sine, cosine


# -- the scene


def moment_coefficient(M, EM):
    """Return EM, 0 for point masses, and z."""
    em = where(M == 4.0, 0.0, EM)
    z = 1.0 - (em + em)
    return em, z


def body_spins(M, WA, WB):
    """Return the initial spins, 0 for point masses."""
    wa = where(M == 4.0, 0.0, WA)
    wb = where(M == 4.0, 0.0, WB)
    return wa, wb


def inverse_inertias(M, IA, IB):
    """Return the inverse inertias, 1 for point masses: they have no spin to act on."""
    ia = where(M == 4.0, 1.0, 1.0 / IA)
    ib = where(M == 4.0, 1.0, 1.0 / IB)
    return ia, ib


def contact_normal(GA):
    """Return sine and cosine of GA."""
    s, c = sine_and_cosine(GA)
    return s, c


def arm_direction_a(M, DA, PA, TA):
    """Return the length and the direction of A's arm."""
    point = M == 4.0
    da = where(point, 0.0, DA)
    angle_a = where(point, 0.0, PA + TA)
    return da, angle_a


def arm_direction_b(M, DB, PB, TB):
    """Return the length and the direction of B's arm."""
    point = M == 4.0
    db = where(point, 0.0, DB)
    angle_b = where(point, 0.0, PB + TB)
    return db, angle_b


def lever_arm_a(da, angle_a, GA):
    """Return what a unit of A's spin adds to the relative velocity along n and t."""
    sine, cosine = sine_and_cosine(angle_a - GA)
    an = da * sine
    at = -(da * cosine)
    return an, at


def lever_arm_b(db, angle_b, GA):
    """Return what a unit of B's spin adds to the relative velocity along n and t."""
    sine, cosine = sine_and_cosine(angle_b - GA)
    bn = db * sine
    bt = -(db * cosine)
    return bn, bt


def inverse_masses(MA, MB):
    """Return the inverse masses and their sum."""
    ma = 1.0 / MA
    mb = 1.0 / MB
    R = ma + mb
    return ma, mb, R


def reduced_inertia(ia, ib):
    """Return the reduced inertia, the bodies' parts in the mean spin, and 1/(Ia + Ib)."""
    Ired = 1.0 / (ia + ib)
    part_a = ib * Ired
    part_b = ia * Ired
    J = ia * part_a
    return Ired, part_a, part_b, J


def combined_arms(an, at, bn, bt, ia, ib):
    """Return the arms of the mean spin and of the difference of the spins."""
    sn = an + bn
    st = at + bt
    kn = an * ia - bn * ib
    kt = at * ia - bt * ib
    return sn, st, kn, kt


def mean_spin(wa, wb, part_a, part_b, Ired):
    """Return the mean spin, by its parts too, and what the moment can change of the spins."""
    from_a = part_a * wa
    from_b = part_b * wb
    mean = from_a + from_b
    turn = Ired * (wa - wb)
    return from_a, from_b, mean, turn


def relative_velocity(UX, UY, VX, VY, s, c, an, at, bn, bt, wa, wb):
    """Return the relative velocity before, of the centers and of the contact points."""
    dx = UX - VX
    dy = UY - VY
    cn = c * dx + s * dy
    ct = c * dy - s * dx
    gn = cn + (an * wa + bn * wb)
    gt = ct + (at * wa + bt * wb)
    return cn, ct, gn, gt


def signed_friction(MU, gt):
    """Return MU after line 400: friction opposes the sliding; on a tie the sign stays."""
    mu = where(gt > 0.0, -MU, MU)
    return (mu,)


# -- the impulse


def sliding_impulse(
    E, mu, em, z, R, J, Ired, sn, st, kn, kt, an, at, bn, bt, from_a, from_b, mean, turn, cn, gn
):
    """Return the determinant, Pn and h for Pt = mu Pn."""
    w = E * gn + cn
    s_mu = sn + mu * st
    k_mu = kn + mu * kt
    D_s = z * (R + J * sn * s_mu) - em * (Ired * kn * k_mu)
    Pn_s = (em * kn * turn - z * (w + sn * mean)) / D_s
    X = (bn + mu * bt) * from_a - (an + mu * at) * from_b
    h_s = (Ired * k_mu * w - R * turn - sn * X) / D_s
    return D_s, Pn_s, h_s


def pivot_impulse(
    E,
    em,
    z,
    R,
    J,
    Ired,
    sn,
    st,
    kn,
    kt,
    an,
    at,
    bn,
    bt,
    ia,
    ib,
    from_a,
    from_b,
    mean,
    turn,
    cn,
    ct,
    gn,
):
    """Return the determinant, Pn and Pt times the determinant, and h for no slip at separation.

    The determinant is R times a sum of squares; ``lever`` is the cross product of k and s without
    the difference of its products.
    """
    w = E * gn + cn
    axb = an * bt - at * bn
    lever = (ia + ib) * axb  # k x s, without the difference of products
    sxw = sn * ct - st * w
    along_k = em * (Ired * (kn * ct - kt * w) + axb * mean)  # along k turned by a quarter
    along_s = z * J * sxw + em * turn * J * lever  # along s turned by a quarter
    of_masses = z * R
    of_twist = em * turn * R
    D_p = of_masses * (R + J * (sn * sn + st * st)) - em * (
        R * Ired * (kn * kn + kt * kt) + J * axb * lever
    )
    Nn = of_twist * kn - of_masses * (w + sn * mean) + st * along_s - kt * along_k
    Nt = of_twist * kt - of_masses * (ct + st * mean) - sn * along_s + kn * along_k
    Xn = bn * from_a - an * from_b
    Xt = bt * from_a - at * from_b
    h_p = (R * (Ired * (kn * w + kt * ct) - R * turn - (sn * Xn + st * Xt)) - J * axb * sxw) / D_p
    return D_p, Nn, Nt, h_p


def impulse(MU, mu, D_s, Pn_s, h_s, D_p, Nn, Nt, h_p):
    """Return the impulse, h and the determinant."""
    pivot = MU == PIVOT
    PN = where(pivot, Nn / D_p, Pn_s)
    PT = where(pivot, Nt / D_p, mu * Pn_s)
    h = where(pivot, h_p, h_s)
    D = where(pivot, D_p, D_s)
    return PN, PT, h, D


def moment_impulse(M, em, h):
    """Return the moment impulse."""
    PM = where(M == 4.0, 0.0, (1.0 - em) * h)
    return (PM,)


# -- after the impact


def velocity_changes(PN, PT, s, c, ma, mb):
    """Return A's velocity change along x and y, and the reverse of B's."""
    Px = c * PN - s * PT
    Py = s * PN + c * PT
    ax = ma * Px
    ay = ma * Py
    bx = mb * Px
    by = mb * Py
    return ax, ay, bx, by


def final_velocities(UX, UY, VX, VY, ax, ay, bx, by):
    """Return the final velocities (Equations 13 and 14)."""
    VAX = UX + ax
    VAY = UY + ay
    VBX = VX - bx
    VBY = VY - by
    return VAX, VAY, VBX, VBY


def spin_weights(em, z, part_a, part_b):
    """Return the weights of a body's own and the other's spin in its final spin."""
    q = 1.0 - em
    own_a = z * part_a - em * part_b
    own_b = z * part_b - em * part_a
    given_a = q * part_a
    given_b = q * part_b
    return own_a, own_b, given_a, given_b


def sliding_spins(
    E,
    mu,
    em,
    z,
    R,
    J,
    Ired,
    sn,
    st,
    kn,
    kt,
    an,
    at,
    bn,
    bt,
    ia,
    ib,
    wa,
    wb,
    own_a,
    own_b,
    given_a,
    given_b,
    cn,
    gn,
    D_s,
):
    """Return the final spins of sliding bodies (Equation 17).

    They are not computed from the impulse, whose parts cancel where arms are far longer than radii
    of gyration.
    """
    w = E * gn + cn
    a = an + mu * at
    b = bn + mu * bt
    push = z * J * (sn + mu * st)
    twist = em * Ired * (kn + mu * kt)
    cross = em * (a * ia * wb - b * ib * wa)
    wa_s = (R * (own_a * wa + given_b * wb) - w * (push - ia * twist) + bn * cross) / D_s
    wb_s = (R * (own_b * wb + given_a * wa) - w * (push + ib * twist) - an * cross) / D_s
    return wa_s, wb_s


def pivot_spins(
    E, em, R, J, an, at, bn, bt, ia, ib, wa, wb, own_a, own_b, given_a, given_b, cn, ct, gn, D_p
):
    """Return the final spins of bodies without slip at separation."""
    w = E * gn + cn
    ab = an * bn + at * bt
    state_a = R * wa - ia * (an * w + at * ct)
    state_b = R * wb - ib * (bn * w + bt * ct)
    turn_a = em * (ab * ia * wb - (bn * bn + bt * bt) * ib * wa)
    turn_b = em * (ab * ib * wa - (an * an + at * at) * ia * wb)
    lever = em * J * (ia + ib) * (an * bt - at * bn)
    wa_p = R * (own_a * state_a + given_b * state_b + turn_a) - lever * (bn * ct - bt * w)
    wb_p = R * (own_b * state_b + given_a * state_a + turn_b) + lever * (an * ct - at * w)
    wa_p = wa_p / D_p
    wb_p = wb_p / D_p
    return wa_p, wb_p


def final_spins(M, MU, WA, WB, wa_s, wb_s, wa_p, wb_p):
    """Return the final spins; those of point masses pass through."""
    point = M == 4.0
    pivot = MU == PIVOT
    WAF = where(point, WA, where(pivot, wa_p, wa_s))
    WBF = where(point, WB, where(pivot, wb_p, wb_s))
    return WAF, WBF


def final_slip(MU, s, c, VAX, VAY, VBX, VBY, at, bt, waf, wbf):
    """Return the sliding at separation."""
    gt_after = c * (VAY - VBY) - s * (VAX - VBX) + (at * waf + bt * wbf)
    gt_after = where(MU == PIVOT, 0.0, gt_after)
    return (gt_after,)


def contact_offsets(da, angle_a, db, angle_b):
    """Return the arms along x and y, d3 d4 d1 d2 of line 330: what is 0 there is 0."""
    sin_a, cos_a = sine_and_cosine(angle_a)
    sin_b, cos_b = sine_and_cosine(angle_b)
    D3 = da * sin_a
    D4 = da * cos_a
    D1 = db * sin_b
    D2 = db * cos_b
    return D3, D4, D1, D2


def contact_velocities_before(UX, UY, VX, VY, D1, D2, D3, D4, wa, wb):
    """Return the contact points' velocities before the impact (line 340)."""
    XA = UX + D3 * wa
    YA = UY - D4 * wa
    XB = VX - D1 * wb
    YB = VY + D2 * wb
    return XA, YA, XB, YB


def contact_velocities_after(VAX, VAY, VBX, VBY, D1, D2, D3, D4, WAF, WBF):
    """Return the contact points' velocities after the impact (lines 700, 710)."""
    XAF = VAX + D3 * WAF
    YAF = VAY - D4 * WAF
    XBF = VBX - D1 * WBF
    YBF = VBY + D2 * WBF
    return XAF, YAF, XBF, YBF


def closing_speed(gn):
    """Return the closing speed along the normal."""
    VC = -gn
    return (VC,)


def separation_speed(E, gn):
    """Return the separation speed along the normal (Equation 15)."""
    VS = -(E * gn)
    return (VS,)


def delta_v(ax, ay, bx, by):
    """Return the sizes of the velocity changes."""
    DVA = sqrt(ax * ax + ay * ay)
    DVB = sqrt(bx * bx + by * by)
    return DVA, DVB


def printed_friction(MU, mu):
    """Return the friction coefficient as line 680 prints it."""
    MUP = where(MU == PIVOT, PIVOT, mu)
    return (MUP,)


def critical_friction(Nn, Nt):
    """Return the P_t/P_n that just ends the sliding."""
    MUC = Nt / Nn
    return (MUC,)


# -- energies


def finite_inertias(M, MA, MB, IA, IB):
    """Return masses and inertias with a finite number for infinite ones.

    An infinite body is at rest: times 0 any number will do. Point masses have no inertia.
    """
    fa = where(MA < INF, MA, LARGEST)
    fb = where(MB < INF, MB, LARGEST)
    ja = where(IA < INF, IA, LARGEST)
    jb = where(IB < INF, IB, LARGEST)
    ja = where(M == 4.0, 0.0, ja)
    jb = where(M == 4.0, 0.0, jb)
    return fa, fb, ja, jb


def energy_before(fa, fb, ja, jb, UX, UY, wa, VX, VY, wb):
    """Return the kinetic energy before the impact."""
    KI = 0.5 * (fa * (UX * UX + UY * UY) + fb * (VX * VX + VY * VY) + (ja * wa * wa + jb * wb * wb))
    return (KI,)


def final_body_spins(M, WAF, WBF):
    """Return the final spins, 0 for point masses."""
    waf = where(M == 4.0, 0.0, WAF)
    wbf = where(M == 4.0, 0.0, WBF)
    return waf, wbf


def energy_after(fa, fb, ja, jb, VAX, VAY, waf, VBX, VBY, wbf):
    """Return the kinetic energy after the impact."""
    KF = fa * (VAX * VAX + VAY * VAY) + fb * (VBX * VBX + VBY * VBY)
    KF = 0.5 * (KF + (ja * waf * waf + jb * wbf * wbf))
    return (KF,)


def normal_loss(E, gn, PN):
    """Return the energy that the normal impulse takes, at the mean relative velocity."""
    ELN = -0.5 * ((1.0 - E) * gn * PN)
    return (ELN,)


def tangential_loss(gt, gt_after, PT):
    """Return the energy that the tangential impulse takes, at the mean sliding."""
    ELT = -0.5 * (PT * (gt + gt_after))
    return (ELT,)


def moment_loss(wa, wb, waf, wbf, PM):
    """Return the energy that the moment impulse takes, at the mean relative spin."""
    ELM = -0.5 * (PM * ((wa - wb) + (waf - wbf)))
    return (ELM,)


def energy_loss(ELN, ELT, ELM):
    """Return the energy lost; the difference of the energies would lose digits of a small one."""
    EL = ELN + ELT + ELM
    return (EL,)


def percent_lost(EL, KI):
    """Return the energy lost in percent of that before."""
    LOSS = 100.0 * EL / KI
    return (LOSS,)


def equivalent_speeds(EL, MA, MB, ma, mb):
    """Return the speeds of half the loss in each body, of all before a rigid barrier."""
    twice = where(EL < 0.0, 0.0, EL + EL)
    EESA = sqrt(where(MB == INF, twice, 0.5 * twice)) * sqrt(ma)
    EESB = sqrt(where(MA == INF, twice, 0.5 * twice)) * sqrt(mb)
    return EESA, EESB


# -- verdicts


def condition_number(MU, mu, em, z, D, R, J, Ired, sn, st, an, at, bn, bt, ia, ib):
    """Return the determinant with absolute values in every sum, over itself."""
    size = where(MU == PIVOT, 0.0, fabs(mu))
    z_ = fabs(z)
    sn_ = fabs(an) + fabs(bn)
    st_ = fabs(at) + fabs(bt)
    kn_ = fabs(an) * ia + fabs(bn) * ib
    kt_ = fabs(at) * ia + fabs(bt) * ib
    of_s = z_ * (R * (1.0 + size) + J * sn_ * (sn_ + size * st_))
    of_s = of_s + fabs(em) * (Ired * kn_ * (kn_ + size * kt_))
    of_p = z_ * R * (R + J * (sn * sn + st * st)) + fabs(em) * (
        R * Ired * (kn_ * kn_ + kt_ * kt_)
        + J * fabs(an * bt - at * bn) * (ia + ib) * (fabs(an * bt) + fabs(at * bn))
    )
    COND = 3.0 * (where(MU == PIVOT, of_p, of_s) / fabs(D))
    return (COND,)


def usability(M, E, MU, EM, DA, DB, GA, PA, PB, TA, TB, MA, MB, IA, IB, UX, UY, WA, VX, VY, WB):
    """Return 1 where the numbers of a scene can be used, 0 elsewhere.

    They are finite (a sum is finite where its terms are), masses and inertias are above 0, an
    infinite body is at rest, and there is one at most.
    """
    point = M == 4.0
    good = (point | (M == 6.0)) & (fabs(E + MU + UX + UY + WA + VX + VY + WB) < INF)
    good = good & (fabs(GA) < LARGEST_ANGLE) & (MA > 0.0) & (MB > 0.0)
    turns = fabs(PA) + fabs(PB) + fabs(TA) + fabs(TB)
    body = (fabs(EM + DA + DB) < INF) & (turns < LARGEST_ANGLE) & (IA > 0.0) & (IB > 0.0)
    free_a = MA < INF
    free_b = MB < INF
    turns_a = point | (IA < INF)
    turns_b = point | (IB < INF)
    good = good & (point | body) & ((free_a & turns_a) | (free_b & turns_b))
    good = good & (free_a | (UX == 0.0) & (UY == 0.0)) & (turns_a | (WA == 0.0))
    good = good & (free_b | (VX == 0.0) & (VY == 0.0)) & (turns_b | (WB == 0.0))
    fit = where(good, 1.0, 0.0)
    return (fit,)


def friction_bits(MU, mu, an, at, bn, bt, ia, ib, kt, R, gn, gt, PN, PM, D_p, Nn, Nt):
    """Return the bits of friction above critical and in the wrong direction.

    Friction is above critical, or in the wrong direction, unless it can act against the sliding
    before the impact and then, when the normal impulse has reversed the sliding, the other way
    (``one_way``: where it cannot). The net impulse is then at least
    -Pn (w - K)^2/(K Ktt), w^2 = 2 gt K/Pn, with K and Ktt what units of Pn (and the moment with it)
    and of Pt add to the sliding, for gt/K between Pn/2 and 2 Pn; here without the root.
    """
    critical = fabs(Nt)
    friction = where(MU == PIVOT, 0.0, mu)
    sign = where(D_p < 0.0, -1.0, 1.0)
    pushing = Nn * sign
    along = where(Nt * sign < 0.0, -friction, friction)
    approach = (gn < 0.0) & (PN > 0.0)
    backward = approach & (along < -FRICTION_TOLERANCE)
    no_sliding = (pushing > 0.0) & (critical <= FRICTION_TOLERANCE * pushing)
    above = approach & (pushing > 0.0) & ((along - FRICTION_TOLERANCE) * pushing > critical)
    turned = (an * at * ia + bn * bt * ib) * PN + kt * PM
    back = (fabs(friction) - FRICTION_TOLERANCE) * (PN * (R + (at * at * ia + bt * bt * ib)))
    excess = fabs(gt) + fabs(gt) - fabs(turned)
    gap = excess - back
    one_way = (gt * turned >= 0.0) | (friction * gt >= 0.0) | (excess <= 0.0)
    one_way = one_way | (excess >= 3.0 * fabs(turned)) | (gap < 0.0)
    one_way = one_way | (gap * gap < 4.0 * (fabs(turned) * back))
    above = (above | backward & no_sliding) & one_way
    wrong = backward & ~no_sliding & (critical > 0.0) & one_way
    of_friction = where(above, Status.FRICTION_ABOVE_CRITICAL, 0.0)
    of_friction = of_friction + where(wrong, Status.FRICTION_WRONG_DIRECTION, 0.0)
    return (of_friction,)


def coefficient_bits(E, MU, mu, em):
    """Return the bits of coefficients out of range."""
    moment = (em < EM_MIN) | (em > EM_MAX) & ((em < NO_MOMENT) | (em > NO_MOMENT))
    of_range = where((E < E_MIN) | (E > E_MAX), Status.E_OUT_OF_RANGE, 0.0)
    of_range = of_range + where(moment, Status.EM_OUT_OF_RANGE, 0.0)
    of_range = of_range + where((MU != PIVOT) & (mu <= PIVOT), Status.MU_OUT_OF_RANGE, 0.0)
    return (of_range,)


def side_bits(da, at, db, bt):
    """Return the bits of centers on the wrong side of the contact plane."""
    of_sides = where(at > SIDE_TOLERANCE * fabs(da), Status.A_ON_WRONG_SIDE, 0.0)
    of_sides = of_sides + where(bt > SIDE_TOLERANCE * fabs(db), Status.B_ON_WRONG_SIDE, 0.0)
    return (of_sides,)


def solution_bits(KI, EL, COND, VAX, VAY, VBX, VBY, WAF, WBF):
    """Return the bits of scenes without a solution, or nearly so."""
    finite = fabs(VAX + VAY + VBX + VBY + WAF + WBF) < INF
    finite = finite & (fabs(KI - EL) < INF) & (fabs(EL / KI) < INF) & (COND <= INF)
    of_solution = where(finite, 0.0, Status.NOT_FINITE)
    of_solution = of_solution + where(COND < SINGULAR_FROM, 0.0, Status.SINGULAR)
    return (of_solution,)


def status(gn, PN, KI, EL, of_range, of_friction, of_sides, of_solution):
    """Return the bits of `impact88.status.Status`; a comparison with NaN is false."""
    STATUS = of_range + of_friction + of_sides + of_solution
    STATUS = STATUS + where(gn >= 0.0, Status.SEPARATING, 0.0)
    STATUS = STATUS + where(PN < 0.0, Status.PULLING, 0.0)
    STATUS = STATUS + where(-(EL + EL) > ENERGY_TOLERANCE * KI, Status.ENERGY_GAINED, 0.0)
    return (STATUS,)
