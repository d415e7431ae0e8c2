"""The planar impact of two bodies: every formula, once.

Each function computes a few quantities from others; its parameters are their names, so a result
needs exactly the functions that lead to it. numpy runs a function over arrays as it stands, and
`translate` prints it as a C loop: bodies are assignments of ``+ - * /``, comparisons, ``& | ~``,
`where`, `fabs` and `sqrt`; the last line returns the quantities that others may use, and no
condition. To add a result, write its function (and its row in `names.RESULTS`).

The method is impulse and momentum with the impulse as unknown. The impulse on A at the contact
point has a normal part Pn, a tangential part Pt and a moment, (1 - em) h. Velocities after are
those before plus impulse times inverse mass, so a rigid barrier is the inverse mass 0. In the
relative velocities of the contact points along n, along t, and of the spins, Equations 15, 16 (or
no slip) and 18 are two or three equations in Pn, Pt and h, solved by Cramer's rule. Equation 18 is
multiplied by z = 1 - 2 em: nothing is infinite at em = 1/2. The spins are taken as the mean spin
(Ia wa + Ib wb)/(Ia + Ib), which the moment leaves alone, and a difference, so with R = 1/ma + 1/mb,
J = 1/(Ia + Ib), Ired = Ia Ib J, arms a and b, s = a + b, k = a/Ia - b/Ib, of both directions::

    (R + J sn sn) Pn +      J sn st Pt + em kn h = -(w + sn mean)           w = e gn + cn
         J st sn Pn + (R + J st st) Pt + em kt h = -(ct + st mean)           pivot; or Pt = mu Pn
          Ired kn Pn +      Ired kt Pt +    z h = -turn                     turn = Ired (wa - wb)

For -1 <= em <= 0 both determinants are sums of terms of one sign (friction's while mu is small):
nothing cancels however long the arms or unequal the bodies are.

Axes: n = (cos GA, sin GA), t = (-sin GA, cos GA), A on the +n side. A point mass (M = 4) is a body
without arm, spin and moment.
"""

from numpy import absolute as fabs
from numpy import sqrt, where

INF = float("inf")
LARGEST = 1.7976931348623157e308
PIVOT = -10.0
RADIAN = 0.017453292519943295
PER_QUARTER = 1 / 90
ROUND = 6755399441055744.0  # 1.5 * 2**52: adding it rounds to an integer
LARGEST_ANGLE = 1e12

E_MIN = 0.0
E_MAX = 1.0
EM_MIN = -1.0
EM_MAX = 0.0
NO_MOMENT = 1.0  # the EM that stands for no moment impulse

# tolerances of STATUS
SINGULAR_FROM = 2.0**26
ENERGY_TOLERANCE = 2e-12
FRICTION_TOLERANCE = 1e-9
SIDE_TOLERANCE = 1e-9


def sine_and_cosine(degrees):
    """Of degrees: quarter turns are split off exactly, the rest by Taylor series to 45 degrees."""
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
    sin_k, cos_k = k * (2.0 - fabs(k)), 1.0 - fabs(k)
    sine, cosine = sin_k * cos_r + cos_k * sin_r, cos_k * cos_r - sin_k * sin_r
    return sine, cosine


# -- the scene


def moment_coefficient(M, EM):
    """A point mass has no moment and no spin."""
    em = where(M == 4.0, 0.0, EM)
    return (em,)


def body_spins(M, WA, WB):
    wa, wb = where(M == 4.0, 0.0, WA), where(M == 4.0, 0.0, WB)
    return wa, wb


def inverse_inertias(M, IA, IB):
    ia, ib = where(M == 4.0, 1.0, 1.0 / IA), where(M == 4.0, 1.0, 1.0 / IB)
    return ia, ib


def contact_normal(GA):
    s, c = sine_and_cosine(GA)
    return s, c


def arm_direction_a(M, DA, PA, TA):
    point = M == 4.0
    da, angle_a = where(point, 0.0, DA), where(point, 0.0, PA + TA)
    return da, angle_a


def arm_direction_b(M, DB, PB, TB):
    point = M == 4.0
    db, angle_b = where(point, 0.0, DB), where(point, 0.0, PB + TB)
    return db, angle_b


def lever_arm_a(da, angle_a, GA):
    """What the spin of A adds to its contact point's velocity along n and t."""
    sine, cosine = sine_and_cosine(angle_a - GA)
    an, at = da * sine, -(da * cosine)
    return an, at


def lever_arm_b(db, angle_b, GA):
    sine, cosine = sine_and_cosine(angle_b - GA)
    bn, bt = db * sine, -(db * cosine)
    return bn, bt


def inverse_masses(MA, MB):
    ma, mb = 1.0 / MA, 1.0 / MB
    R = ma + mb
    return ma, mb, R


def reduced_inertia(ia, ib):
    Ired = 1.0 / (ia + ib)
    part_a, part_b = ib * Ired, ia * Ired  # of the mean spin
    J = ia * part_a
    return Ired, part_a, part_b, J


def combined_arms(an, at, bn, bt, ia, ib):
    sn, st = an + bn, at + bt
    kn, kt = an * ia - bn * ib, at * ia - bt * ib
    return sn, st, kn, kt


def mean_spin(wa, wb, part_a, part_b, Ired):
    from_a, from_b = part_a * wa, part_b * wb
    mean, turn = from_a + from_b, Ired * (wa - wb)
    return from_a, from_b, mean, turn


def relative_velocity(UX, UY, VX, VY, s, c, an, at, bn, bt, wa, wb):
    """Relative velocity before along n and t, of the centers and of the contact points."""
    dx, dy = UX - VX, UY - VY
    cn, ct = c * dx + s * dy, c * dy - s * dx
    gn, gt = cn + (an * wa + bn * wb), ct + (at * wa + bt * wb)
    return cn, ct, gn, gt


def signed_friction(MU, gt):
    """MU after line 400: friction opposes the sliding; a tie keeps the sign."""
    mu = where(gt > 0.0, -MU, MU)
    return (mu,)


# -- the impulse


def sliding_impulse(E, mu, em, R, J, Ired, sn, st, kn, kt, an, at, bn, bt, from_a, from_b, mean, turn,
            cn, gn):  # fmt: skip
    """Pt = mu Pn."""
    z, w = 1.0 - (em + em), E * gn + cn
    s_mu, k_mu = sn + mu * st, kn + mu * kt
    D_s = z * (R + J * sn * s_mu) - em * (Ired * kn * k_mu)
    Pn_s = (em * kn * turn - z * (w + sn * mean)) / D_s
    X = (bn + mu * bt) * from_a - (an + mu * at) * from_b
    h_s = (Ired * k_mu * w - R * turn - sn * X) / D_s
    return D_s, Pn_s, h_s


def pivot_impulse(E, em, R, J, Ired, sn, st, kn, kt, an, at, bn, bt, ia, ib, from_a, from_b, mean, turn,
             cn, ct, gn):  # fmt: skip
    """No slip at separation. ``N`` is the impulse times the determinant, which is one of R times
    squares."""
    z, w = 1.0 - (em + em), E * gn + cn
    axb = an * bt - at * bn
    lever = (ia + ib) * axb  # k x s, without the difference of products
    sxw = sn * ct - st * w
    across = em * (Ired * (kn * ct - kt * w) + axb * mean)  # along k turned by a quarter
    upon = z * J * sxw + em * turn * J * lever  # along s turned
    straight, twist = z * R, em * turn * R
    D_p = straight * (R + J * (sn * sn + st * st)) - em * (
        R * Ired * (kn * kn + kt * kt) + J * axb * lever
    )
    Nn = twist * kn - straight * (w + sn * mean) + st * upon - kt * across
    Nt = twist * kt - straight * (ct + st * mean) - sn * upon + kn * across
    Xn, Xt = bn * from_a - an * from_b, bt * from_a - at * from_b
    h_p = (R * (Ired * (kn * w + kt * ct) - R * turn - (sn * Xn + st * Xt)) - J * axb * sxw) / D_p
    return D_p, Nn, Nt, h_p


def impulse(MU, mu, D_s, Pn_s, h_s, D_p, Nn, Nt, h_p):
    pivot = MU == PIVOT
    PN, PT = where(pivot, Nn / D_p, Pn_s), where(pivot, Nt / D_p, mu * Pn_s)
    h, D = where(pivot, h_p, h_s), where(pivot, D_p, D_s)
    return PN, PT, h, D


def moment_impulse(M, em, h):
    PM = where(M == 4.0, 0.0, (1.0 - em) * h)
    return (PM,)


# -- after the impact


def velocity_changes(PN, PT, s, c, ma, mb):
    Px, Py = c * PN - s * PT, s * PN + c * PT
    ax, ay, bx, by = ma * Px, ma * Py, mb * Px, mb * Py
    return ax, ay, bx, by


def final_velocities(UX, UY, VX, VY, ax, ay, bx, by):
    VAX, VAY, VBX, VBY = UX + ax, UY + ay, VX - bx, VY - by
    return VAX, VAY, VBX, VBY


def spin_weights(em, part_a, part_b):
    """What a body's own spin, and the other's, weighs in its spin after, times the determinant."""
    z, q = 1.0 - (em + em), 1.0 - em
    own_a, own_b, given_a, given_b = (
        z * part_a - em * part_b,
        z * part_b - em * part_a,
        q * part_a,
        q * part_b,
    )
    return own_a, own_b, given_a, given_b


def sliding_spins(E, mu, em, R, J, Ired, sn, st, kn, kt, an, at, bn, bt, ia, ib, wa, wb, own_a, own_b,
                  given_a, given_b, cn, gn, D_s):  # fmt: skip
    """Not by the impulse: its parts cancel where arms are far longer than radii of gyration."""
    w, a, b = E * gn + cn, an + mu * at, bn + mu * bt
    push, twist = (1.0 - (em + em)) * J * (sn + mu * st), em * Ired * (kn + mu * kt)
    cross = em * (a * ia * wb - b * ib * wa)
    wa_s = (R * (own_a * wa + given_b * wb) - w * (push - ia * twist) + bn * cross) / D_s
    wb_s = (R * (own_b * wb + given_a * wa) - w * (push + ib * twist) - an * cross) / D_s
    return wa_s, wb_s


def pivot_spins(E, em, R, J, an, at, bn, bt, ia, ib, wa, wb, own_a, own_b, given_a, given_b, cn, ct, gn,
                   D_p):  # fmt: skip
    w, ab = E * gn + cn, an * bn + at * bt
    state_a, state_b = R * wa - ia * (an * w + at * ct), R * wb - ib * (bn * w + bt * ct)
    turn_a = em * (ab * ia * wb - (bn * bn + bt * bt) * ib * wa)
    turn_b = em * (ab * ib * wa - (an * an + at * at) * ia * wb)
    lever = em * J * (ia + ib) * (an * bt - at * bn)
    wa_p = R * (own_a * state_a + given_b * state_b + turn_a) - lever * (bn * ct - bt * w)
    wb_p = R * (own_b * state_b + given_a * state_a + turn_b) + lever * (an * ct - at * w)
    wa_p, wb_p = wa_p / D_p, wb_p / D_p
    return wa_p, wb_p


def final_spins(M, MU, WA, WB, wa_s, wb_s, wa_p, wb_p):
    point, pivot = M == 4.0, MU == PIVOT
    WAF = where(point, WA, where(pivot, wa_p, wa_s))
    WBF = where(point, WB, where(pivot, wb_p, wb_s))
    return WAF, WBF


def final_slip(MU, s, c, VAX, VAY, VBX, VBY, at, bt, waf, wbf):
    """The sliding at separation."""
    gt_after = c * (VAY - VBY) - s * (VAX - VBX) + (at * waf + bt * wbf)
    gt_after = where(MU == PIVOT, 0.0, gt_after)
    return (gt_after,)


def contact_offsets(da, angle_a, db, angle_b):
    """D3 D4 D1 D2 of line 330: along x and y, so that what is 0 there is 0."""
    sin_a, cos_a = sine_and_cosine(angle_a)
    sin_b, cos_b = sine_and_cosine(angle_b)
    D3, D4, D1, D2 = da * sin_a, da * cos_a, db * sin_b, db * cos_b
    return D3, D4, D1, D2


def contact_velocities_before(UX, UY, VX, VY, D1, D2, D3, D4, wa, wb):
    XA, YA, XB, YB = UX + D3 * wa, UY - D4 * wa, VX - D1 * wb, VY + D2 * wb
    return XA, YA, XB, YB


def contact_velocities_after(VAX, VAY, VBX, VBY, D1, D2, D3, D4, WAF, WBF):
    XAF, YAF, XBF, YBF = VAX + D3 * WAF, VAY - D4 * WAF, VBX - D1 * WBF, VBY + D2 * WBF
    return XAF, YAF, XBF, YBF


def closing_speed(gn):
    VC = -gn
    return (VC,)


def separation_speed(E, gn):
    VS = -(E * gn)
    return (VS,)


def delta_v(ax, ay, bx, by):
    DVA, DVB = sqrt(ax * ax + ay * ay), sqrt(bx * bx + by * by)
    return DVA, DVB


def printed_friction(MU, mu):
    MUP = where(MU == PIVOT, PIVOT, mu)
    return (MUP,)


def critical_friction(Nn, Nt):
    MUC = Nt / Nn
    return (MUC,)


# -- energies


def finite_inertias(M, MA, MB, IA, IB):
    """An infinite body is at rest: times 0 any number will do."""
    fa, fb = where(MA < INF, MA, LARGEST), where(MB < INF, MB, LARGEST)
    ja, jb = where(IA < INF, IA, LARGEST), where(IB < INF, IB, LARGEST)
    ja, jb = where(M == 4.0, 0.0, ja), where(M == 4.0, 0.0, jb)
    return fa, fb, ja, jb


def energy_before(fa, fb, ja, jb, UX, UY, wa, VX, VY, wb):
    KI = 0.5 * (fa * (UX * UX + UY * UY) + fb * (VX * VX + VY * VY) + (ja * wa * wa + jb * wb * wb))
    return (KI,)


def final_body_spins(M, WAF, WBF):
    waf, wbf = where(M == 4.0, 0.0, WAF), where(M == 4.0, 0.0, WBF)
    return waf, wbf


def energy_after(fa, fb, ja, jb, VAX, VAY, waf, VBX, VBY, wbf):
    KF = fa * (VAX * VAX + VAY * VAY) + fb * (VBX * VBX + VBY * VBY)
    KF = 0.5 * (KF + (ja * waf * waf + jb * wbf * wbf))
    return (KF,)


def normal_loss(E, gn, PN):
    """Each impulse's work, at the mean of the relative velocities before and after."""
    ELN = -0.5 * ((1.0 - E) * gn * PN)
    return (ELN,)


def tangential_loss(gt, gt_after, PT):
    ELT = -0.5 * (PT * (gt + gt_after))
    return (ELT,)


def moment_loss(wa, wb, waf, wbf, PM):
    ELM = -0.5 * (PM * ((wa - wb) + (waf - wbf)))
    return (ELM,)


def energy_loss(ELN, ELT, ELM, KI):
    """KI - KF would lose its digits where little is lost."""
    EL = ELN + ELT + ELM
    LOSS = 100.0 * EL / KI
    return EL, LOSS


def equivalent_speeds(EL, MA, MB, ma, mb):
    """Half of the loss in each body, all of it before a rigid barrier."""
    twice = where(EL < 0.0, 0.0, EL + EL)
    EESA = sqrt(where(MB == INF, twice, 0.5 * twice)) * sqrt(ma)
    EESB = sqrt(where(MA == INF, twice, 0.5 * twice)) * sqrt(mb)
    return EESA, EESB


# -- verdicts


def condition_number(MU, mu, em, D, R, J, Ired, an, at, bn, bt, ia, ib):
    """The determinant with absolute values in every sum, over itself."""
    size, z_ = where(MU == PIVOT, 0.0, fabs(mu)), fabs(1.0 - (em + em))
    sn_, st_ = fabs(an) + fabs(bn), fabs(at) + fabs(bt)
    kn_, kt_ = fabs(an) * ia + fabs(bn) * ib, fabs(at) * ia + fabs(bt) * ib
    of_s = z_ * (R * (1.0 + size) + J * sn_ * (sn_ + size * st_))
    of_s = of_s + fabs(em) * (Ired * kn_ * (kn_ + size * kt_))
    sn, st = an + bn, at + bt
    of_p = z_ * R * (R + J * (sn * sn + st * st)) + fabs(em) * (
        R * Ired * (kn_ * kn_ + kt_ * kt_)
        + J * fabs(an * bt - at * bn) * (ia + ib) * (fabs(an * bt) + fabs(at * bn))
    )
    COND = 3.0 * (where(MU == PIVOT, of_p, of_s) / fabs(D))
    return (COND,)


def usability(M, E, MU, EM, DA, DB, GA, PA, PB, TA, TB, MA, MB, IA, IB, UX, UY, WA, VX, VY, WB):
    """1 where a scene's numbers can be used: finite (a sum is, where its terms are), masses and
    inertias above 0; an infinite body is at rest, and there is one at most."""
    point = M == 4.0
    good = (point | (M == 6.0)) & (fabs(E + MU + UX + UY + WA + VX + VY + WB) < INF)
    good = good & (fabs(GA) < LARGEST_ANGLE) & (MA > 0.0) & (MB > 0.0)
    turns = fabs(PA) + fabs(PB) + fabs(TA) + fabs(TB)
    body = (fabs(EM + DA + DB) < INF) & (turns < LARGEST_ANGLE) & (IA > 0.0) & (IB > 0.0)
    free_a, free_b = MA < INF, MB < INF
    turns_a, turns_b = point | (IA < INF), point | (IB < INF)
    good = good & (point | body) & ((free_a & turns_a) | (free_b & turns_b))
    good = good & (free_a | (UX == 0.0) & (UY == 0.0)) & (turns_a | (WA == 0.0))
    good = good & (free_b | (VX == 0.0) & (VY == 0.0)) & (turns_b | (WB == 0.0))
    fit = where(good, 1.0, 0.0)
    return (fit,)


def status_bits(E, MU, mu, em, an, at, bn, bt, da, db, ia, ib, kt, R, gn, gt, PN, PM, D_p, Nn, Nt, KI,
           EL, COND, VAX, VAY, VBX, VBY, WAF, WBF):  # fmt: skip
    """The bits of `impact88.status.Status`. A comparison with NaN is false."""
    size, f = fabs(Nt), where(MU == PIVOT, 0.0, mu)
    sign = where(D_p < 0.0, -1.0, 1.0)
    pushes, along = Nn * sign, where(Nt * sign < 0.0, -f, f)
    approach = (gn < 0.0) & (PN > 0.0)
    backward = approach & (along < -FRICTION_TOLERANCE)
    none = (pushes > 0.0) & (size <= FRICTION_TOLERANCE * pushes)
    above = approach & (pushes > 0.0) & ((along - FRICTION_TOLERANCE) * pushes > size)
    # friction against the sliding before it, and back after the normal impulse has reversed it
    turned = (an * at * ia + bn * bt * ib) * PN + kt * PM
    back = (fabs(f) - FRICTION_TOLERANCE) * (PN * (R + (at * at * ia + bt * bt * ib)))
    excess = fabs(gt) + fabs(gt) - fabs(turned)
    gap = excess - back
    forth = (gt * turned >= 0.0) | (f * gt >= 0.0) | (excess <= 0.0)
    forth = forth | (excess >= 3.0 * fabs(turned)) | (gap < 0.0)
    forth = forth | (gap * gap < 4.0 * (fabs(turned) * back))
    total = VAX + VAY + VBX + VBY + WAF + WBF
    finite = (fabs(total) < INF) & (fabs(KI - EL) < INF) & (fabs(EL / KI) < INF)
    STATUS = where(gn >= 0.0, 1.0, 0.0) + where(PN < 0.0, 2.0, 0.0)
    STATUS = STATUS + where(-(EL + EL) > ENERGY_TOLERANCE * KI, 8.0, 0.0)
    STATUS = STATUS + where((E < E_MIN) | (E > E_MAX), 16.0, 0.0)
    STATUS = STATUS + where(COND < SINGULAR_FROM, 0.0, 32.0)
    STATUS = STATUS + where(finite & (COND <= INF), 0.0, 64.0)
    STATUS = STATUS + where(at > SIDE_TOLERANCE * fabs(da), 256.0, 0.0)
    STATUS = STATUS + where(bt > SIDE_TOLERANCE * fabs(db), 512.0, 0.0)
    STATUS = STATUS + where(
        (em < EM_MIN) | (em > EM_MAX) & ((em < NO_MOMENT) | (em > NO_MOMENT)), 1024.0, 0.0
    )
    STATUS = STATUS + where(f <= PIVOT, 2048.0, 0.0)
    STATUS = STATUS + where((above | backward & none) & forth, 4096.0, 0.0)
    STATUS = STATUS + where(backward & ~none & (size > 0.0) & forth, 8192.0, 0.0)
    return (STATUS,)
