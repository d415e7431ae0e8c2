"""The planar impact of two bodies: every formula, once.

Each function computes a few quantities from others; its parameters are their names, so that a
result needs exactly the functions that lead to it (`plan`). One that gives quantities of A alone is
B's formula, too, and one that gives quantities before the impact alone holds after it: `plan` has
the names to exchange. numpy runs a function over arrays unchanged, and `translate` prints it as a C
loop. Bodies are therefore assignments of ``+ - * /``, comparisons, ``& | ~``, `where`, `fabs`,
`sqrt`, the functions under "vectors" and bits of `Status`, one name each, with decimal points in
all numbers; the last line returns the quantities that others may use, which are numbers, never
conditions. To add a result, write its function here, its row in `names.RESULTS` and its line in
`reference`.

Axes and signs: n = (cos GA, sin GA) and t = (-sin GA, cos GA), A on the +n side; the impulse acts
on A, and its opposite on B. Lower-case names: s, c sine and cosine of GA; ma, mb, ia, ib inverse
masses and inertias, 0 for a rigid barrier; an, at, bn, bt what a unit of spin adds to the velocity
of a contact point relative to the other's, along n and t; wa, wb, waf, wbf, em spins and EM, 0 for
point masses (M = 4), which have no arms and no moment; gn, gt relative velocity of the contact
points before, A's minus B's, and cn, ct that of the centers. MUP is MU with the sign that line 400
gives it.

Method: the impulse is the unknown. It has a normal part Pn, a tangential part Pt and a moment
PM = (1 - em) h. Velocities after are those before plus impulse times inverse mass (Equations 13, 14
and 17). For the relative velocities of the contact points along n and t and of the spins, Equations
15, 16 (or no slip at separation) and 18 are two or three linear equations in Pn, Pt and h, solved
by Cramer's rule. Equation 18 is multiplied by z = 1 - 2 em, so that nothing is infinite at em =
1/2. The spins are taken as the mean spin (Ia wa + Ib wb)/(Ia + Ib), which the moment does not
change, and a difference. With R = ma + mb, J = 1/(Ia + Ib), Ired = Ia Ib J, s = a + b, k = a/Ia -
b/Ib, of both directions, w = e gn + cn and turn = Ired (wa - wb)::

    (R + J sn sn) Pn +      J sn st Pt + em kn h = -(w + sn mean)
         J st sn Pn + (R + J st st) Pt + em kt h = -(ct + st mean)      pivot; or Pt = MUP Pn
          Ired kn Pn +      Ired kt Pt +    z h = -turn

For -1 <= em <= 0 both determinants are sums of terms of one sign (that of sliding while MUP
is small): nothing cancels, however long the arms are and however unequal the bodies.
"""

from numpy import absolute as fabs
from numpy import inf, nan, sqrt, where

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


# -- vectors


def dot(x, y, u, v):
    """Return the inner product of (x, y) and (u, v)."""
    return x * u + y * v


def cross(x, y, u, v):
    """Return the cross product of (x, y) and (u, v)."""
    return x * v - y * u


def sine_and_cosine(degrees):
    """Return sine and cosine of an angle in degrees.

    Quarter turns are split off exactly; the rest, up to 45 degrees, goes by the series of fdlibm.
    """
    quarters = degrees * PER_QUARTER + ROUND - ROUND
    k = quarters - 4.0 * (0.25 * quarters + ROUND - ROUND)  # -2 ... 2
    r = (degrees - 90.0 * quarters) * RADIAN
    q = r * r
    sin_r = r - r * q * (
        1.66666666666666324348e-01
        - q * (8.33333333332248946124e-03
        - q * (1.98412698298579493134e-04
        - q * (2.75573137070700676789e-06
        - q * (2.50507602534068634195e-08
        - q * 1.58969099521155010221e-10))))
    )  # fmt: skip
    cos_r = 1.0 - (0.5 * q - q * q * (
        4.16666666666666019037e-02
        - q * (1.38888888888741095749e-03
        - q * (2.48015872894767294178e-05
        - q * (2.75573143513906633035e-07
        - q * (2.08757232129817482790e-09
        - q * 1.13596475577881948265e-11))))
    ))  # fmt: skip
    sin_k = k * (2.0 - fabs(k))
    cos_k = 1.0 - fabs(k)
    sine = dot(sin_k, cos_k, cos_r, sin_r)
    cosine = cross(cos_k, sin_k, sin_r, cos_r)
    return sine, cosine


# -- the scene


def moment_coefficient(M, EM):
    """Return EM, 0 for point masses, and z."""
    em = where(M == 4.0, 0.0, EM)
    z = 1.0 - (em + em)
    return em, z


def body_spin(M, WA):
    """Return the spin, 0 for point masses."""
    wa = where(M == 4.0, 0.0, WA)
    return (wa,)


def inverse_inertia(M, IA):
    """Return the inverse inertia, 1 for point masses: they have no spin to act on."""
    ia = where(M == 4.0, 1.0, 1.0 / IA)
    return (ia,)


def contact_normal(GA):
    """Return sine and cosine of GA."""
    s, c = sine_and_cosine(GA)
    return s, c


def arm_direction(M, DA, PA, TA):
    """Return the length and the direction of the arm."""
    point = M == 4.0
    da = where(point, 0.0, DA)
    angle_a = where(point, 0.0, PA + TA)
    return da, angle_a


def lever_arm(da, angle_a, GA):
    """Return what a unit of spin adds to the relative velocity along n and t."""
    sine, cosine = sine_and_cosine(angle_a - GA)
    an = da * sine
    at = -(da * cosine)
    return an, at


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
    """Return the relative velocity, of the centers and of the contact points."""
    dx = UX - VX
    dy = UY - VY
    cn = dot(c, s, dx, dy)
    ct = cross(c, s, dx, dy)
    gn = cn + dot(an, bn, wa, wb)
    gt = ct + dot(at, bt, wa, wb)
    return cn, ct, gn, gt


def normal_change(E, cn, gn):
    """Return what the impulse changes of the velocity along n, but for spins."""
    w = E * gn + cn
    return (w,)


def signed_friction(MU, gt):
    """Return MU after line 400: friction opposes the sliding; on a tie the sign stays."""
    MUP = where((gt > 0.0) & (MU != PIVOT), -MU, MU)
    return (MUP,)


# -- the impulse


def sliding_impulse(
    MUP, em, z, R, J, Ired, sn, st, kn, kt, an, at, bn, bt, from_a, from_b, mean, turn, w
):
    """Return the determinant, and Pn and h times it, for Pt = MUP Pn; and the arms of an impulse of
    1 along n and MUP along t."""
    af = an + MUP * at
    bf = bn + MUP * bt
    sf = sn + MUP * st
    kf = kn + MUP * kt
    D_s = z * (R + J * sn * sf) - em * (Ired * kn * kf)
    Pn_s = em * kn * turn - z * (w + sn * mean)
    h_s = Ired * kf * w - R * turn - sn * cross(bf, af, from_b, from_a)
    return D_s, Pn_s, h_s, af, bf, sf, kf


def pivot_impulse(
    em, z, R, J, Ired, sn, st, kn, kt, an, at, bn, bt, ia, ib, from_a, from_b, mean, turn, ct, w
):
    """Return the determinant, and Pn, Pt and h times it, for no slip at separation.

    The determinant is R times a sum of squares; ``lever`` is the cross product of k and s without
    the difference of its products.
    """
    axb = cross(an, at, bn, bt)
    lever = (ia + ib) * axb
    sxw = cross(sn, st, w, ct)
    along_k = em * (Ired * cross(kn, kt, w, ct) + axb * mean)  # along k turned by a quarter
    along_s = z * J * sxw + em * turn * J * lever  # along s turned by a quarter
    of_masses = z * R
    of_twist = em * turn * R
    D_p = of_masses * (R + J * dot(sn, st, sn, st)) - em * (
        R * Ired * dot(kn, kt, kn, kt) + J * axb * lever
    )
    Nn = of_twist * kn - of_masses * (w + sn * mean) + st * along_s - kt * along_k
    Nt = of_twist * kt - of_masses * (ct + st * mean) - sn * along_s + kn * along_k
    Xn = cross(bn, an, from_b, from_a)
    Xt = cross(bt, at, from_b, from_a)
    twist = Ired * dot(kn, kt, w, ct) - R * turn - dot(sn, st, Xn, Xt)
    h_p = R * twist - J * axb * sxw
    return D_p, Nn, Nt, h_p


def impulse(M, MU, MUP, em, D_s, Pn_s, h_s, D_p, Nn, Nt, h_p):
    """Return the impulse, the moment impulse and the determinant."""
    pivot = MU == PIVOT
    D = where(pivot, D_p, D_s)
    PN = where(pivot, Nn, Pn_s) / D
    PT = where(pivot, Nt / D, MUP * PN)
    PM = where(M == 4.0, 0.0, (1.0 - em) * (where(pivot, h_p, h_s) / D))
    return PN, PT, PM, D


# -- after the impact


def velocity_changes(PN, PT, s, c, ma, mb):
    """Return the velocity changes along x and y."""
    Px = cross(c, s, PT, PN)
    Py = dot(c, s, PT, PN)
    ax = ma * Px
    ay = ma * Py
    bx = -(mb * Px)
    by = -(mb * Py)
    return ax, ay, bx, by


def final_velocity(UX, UY, ax, ay):
    """Return the final velocity (Equations 13 and 14)."""
    VAX = UX + ax
    VAY = UY + ay
    return VAX, VAY


def spin_weights(em, z, part_a, part_b):
    """Return the weights of a body's spin in its own final spin, and in the other's."""
    own_a = z * part_a - em * part_b
    given_a = (1.0 - em) * part_a
    return own_a, given_a


def sliding_spins(
    em,
    z,
    R,
    J,
    Ired,
    an,
    bn,
    af,
    bf,
    sf,
    kf,
    ia,
    ib,
    wa,
    wb,
    own_a,
    own_b,
    given_a,
    given_b,
    w,
):
    """Return the final spins of sliding bodies (Equation 17), times the determinant.

    They are not computed from the impulse, whose parts cancel where arms are far longer than radii
    of gyration.
    """
    push = z * J * sf
    twist = em * Ired * kf
    change = em * (af * ia * wb - bf * ib * wa)
    wa_s = R * dot(own_a, given_b, wa, wb) - w * (push - ia * twist) + bn * change
    wb_s = R * dot(own_b, given_a, wb, wa) - w * (push + ib * twist) - an * change
    return wa_s, wb_s


def pivot_state(R, ia, wa, an, at, ct, w):
    """Return R times the spin that the impulse between point masses would leave."""
    state_a = R * wa - ia * dot(an, at, w, ct)
    return (state_a,)


def pivot_spin(em, R, J, an, at, bn, bt, ia, ib, wa, wb, own_a, given_b, state_a, state_b, ct, w):
    """Return the final spin without slip at separation, times the determinant."""
    turn = em * (dot(an, at, bn, bt) * ia * wb - dot(bn, bt, bn, bt) * ib * wa)
    lever = em * J * (ia + ib) * cross(an, at, bn, bt)
    wa_p = R * (dot(own_a, given_b, state_a, state_b) + turn) - lever * cross(bn, bt, w, ct)
    return (wa_p,)


def final_spin(M, MU, WA, wa_s, wa_p, D):
    """Return the final spin; that of a point mass passes through."""
    WAF = where(M == 4.0, WA, where(MU == PIVOT, wa_p, wa_s) / D)
    return (WAF,)


def contact_offset(da, angle_a):
    """Return the arm along x and y, d3 d4 d1 d2 of line 330: what is 0 there is 0."""
    sine, cosine = sine_and_cosine(angle_a)
    D3 = da * sine
    D4 = da * cosine
    return D3, D4


def contact_point(D1, D2, D3, D4):
    """Return the contact point from the centers of gravity."""
    CAX = -D4
    CAY = -D3
    CBX = D2
    CBY = D1
    return CAX, CAY, CBX, CBY


def contact_velocity(UX, UY, wa, CAX, CAY):
    """Return the contact point's velocity (lines 340, 700 and 710)."""
    XA = UX - CAY * wa
    YA = UY + CAX * wa
    return XA, YA


def closing_speed(gn):
    """Return the closing speed along the normal."""
    VC = -gn
    return (VC,)


def separation_speed(E, gn):
    """Return the separation speed along the normal (Equation 15)."""
    VS = -(E * gn)
    return (VS,)


def delta_v(ax, ay):
    """Return the size of the velocity change."""
    DVA = sqrt(dot(ax, ay, ax, ay))
    return (DVA,)


def critical_friction(Nn, Nt):
    """Return the P_t/P_n that just ends the sliding."""
    MUC = Nt / Nn
    return (MUC,)


# -- energies


def finite_inertia(M, MA, IA):
    """Return mass and inertia with a finite number for infinite ones.

    An infinite body is at rest: times 0 any number will do. Point masses have no inertia.
    """
    fa = where(MA < INF, MA, LARGEST)
    ja = where(M == 4.0, 0.0, where(IA < INF, IA, LARGEST))
    return fa, ja


def energy(fa, fb, ja, jb, UX, UY, wa, VX, VY, wb):
    """Return the kinetic energy."""
    moving = dot(fa, fb, dot(UX, UY, UX, UY), dot(VX, VY, VX, VY))
    KI = 0.5 * (moving + dot(ja * wa, jb * wb, wa, wb))
    return (KI,)


def normal_loss(E, gn, PN):
    """Return the energy that the normal impulse takes, at the mean relative velocity."""
    ELN = -0.5 * ((1.0 - E) * gn * PN)
    return (ELN,)


def tangential_loss(MU, gt, gt_after, PT):
    """Return the energy that the tangential impulse takes, at the mean sliding."""
    ELT = -0.5 * (PT * (gt + where(MU == PIVOT, 0.0, gt_after)))
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


def equivalent_speed(EL, MB, ma):
    """Return the speed of half the loss in a body, of all before a rigid barrier."""
    lost = where(EL < 0.0, 0.0, EL)
    EESA = sqrt(where(MB == INF, lost + lost, lost)) * sqrt(ma)
    return (EESA,)


# -- verdicts


def condition_number(MU, MUP, em, z, D, R, J, Ired, sn, st, an, at, bn, bt, ia, ib):
    """Return the determinant with absolute values in every sum, over itself."""
    size = fabs(MUP)
    z_ = fabs(z)
    sn_, st_, kn_, kt_ = combined_arms(fabs(an), fabs(at), fabs(bn), fabs(bt), ia, -ib)
    of_s = z_ * (R * (1.0 + size) + J * sn_ * (sn_ + size * st_)) + fabs(em) * (
        Ired * kn_ * (kn_ + size * kt_)
    )
    of_p = z_ * R * (R + J * dot(sn, st, sn, st)) + fabs(em) * (
        R * Ired * dot(kn_, kt_, kn_, kt_)
        + J * fabs(cross(an, at, bn, bt)) * (ia + ib) * (fabs(an * bt) + fabs(at * bn))
    )
    COND = 3.0 * (where(MU == PIVOT, of_p, of_s) / fabs(D))
    return (COND,)


def body_usability(M, MA, IA, UX, UY, WA):
    """Return 1 for a free body, 0 for one that is infinite and at rest, NaN for an impossible one.

    Masses and inertias are above 0; a point mass has no inertia.
    """
    turns = (M == 4.0) | (IA < INF)
    rests = ((MA < INF) | (UX == 0.0) & (UY == 0.0)) & (turns | (WA == 0.0))
    good = (MA > 0.0) & ((M == 4.0) | (IA > 0.0)) & rests
    free_a = where(good, where((MA < INF) & turns, 1.0, 0.0), nan)
    return (free_a,)


def usability(M, E, MU, EM, DA, DB, GA, PA, PB, TA, TB, UX, UY, WA, VX, VY, WB, free_a, free_b):
    """Return 1 where the numbers of a scene can be used, 0 elsewhere.

    They are finite (a sum is finite where its terms are), and one body at most is infinite.
    """
    turns = fabs(PA) + fabs(PB) + fabs(TA) + fabs(TB)
    body = (fabs(EM + DA + DB) < INF) & (turns < LARGEST_ANGLE) & (M == 6.0) | (M == 4.0)
    finite = (fabs(E + MU + UX + UY + WA + VX + VY + WB) < INF) & (fabs(GA) < LARGEST_ANGLE)
    fit = where(body & finite & (free_a + free_b > 0.0), 1.0, 0.0)
    return (fit,)


def friction_bits(MU, MUP, an, at, bn, bt, ia, ib, kt, R, gn, gt, PN, PM, D_p, Nn, Nt):
    """Return the bits of friction above critical and in the wrong direction.

    Friction is above critical, or in the wrong direction, unless it can act against the sliding
    before the impact and then, when the normal impulse has reversed the sliding, the other way
    (``one_way``: where it cannot). The net impulse is then at least
    -Pn (w - K)^2/(K Ktt), w^2 = 2 gt K/Pn, with K and Ktt what units of Pn (and the moment with it)
    and of Pt add to the sliding, for gt/K between Pn/2 and 2 Pn; here without the root.
    """
    critical = fabs(Nt)
    friction = where(MU == PIVOT, 0.0, MUP)
    sign = where(D_p < 0.0, -1.0, 1.0)
    pushing = Nn * sign
    along = where(Nt * sign < 0.0, -friction, friction)
    backward = along < -FRICTION_TOLERANCE
    no_sliding = (pushing > 0.0) & (critical <= FRICTION_TOLERANCE * pushing)
    beyond = (pushing > 0.0) & ((along - FRICTION_TOLERANCE) * pushing > critical)
    turned = dot(an * at, bn * bt, ia, ib) * PN + kt * PM
    back = (fabs(friction) - FRICTION_TOLERANCE) * (PN * (R + dot(at * at, bt * bt, ia, ib)))
    size = fabs(turned)
    excess = fabs(gt) + fabs(gt) - size
    gap = excess - back
    one_way = (
        (gt * turned >= 0.0)
        | (friction * gt >= 0.0)
        | (excess <= 0.0)
        | (excess >= 3.0 * size)
        | (gap < 0.0)
        | (gap * gap < 4.0 * (size * back))
    )
    impossible = one_way & (gn < 0.0) & (PN > 0.0)
    above = (beyond | backward & no_sliding) & impossible
    wrong = backward & ~no_sliding & (critical > 0.0) & impossible
    of_friction = where(above, Status.FRICTION_ABOVE_CRITICAL, 0.0) + where(
        wrong, Status.FRICTION_WRONG_DIRECTION, 0.0
    )
    return (of_friction,)


def status(
    E,
    MU,
    MUP,
    em,
    da,
    at,
    db,
    bt,
    gn,
    PN,
    KI,
    EL,
    COND,
    VAX,
    VAY,
    VBX,
    VBY,
    WAF,
    WBF,
    of_friction,
):
    """Return the bits of `impact88.status.Status`; a comparison with NaN is false."""
    moment = (em < EM_MIN) | (em > EM_MAX) & (em != NO_MOMENT)
    moves = fabs(VAX + VAY + VBX + VBY + WAF + WBF) < INF
    finite = moves & (fabs(KI - EL) < INF) & (fabs(EL / KI) < INF) & (COND <= INF)
    STATUS = (
        of_friction
        + where((E < E_MIN) | (E > E_MAX), Status.E_OUT_OF_RANGE, 0.0)
        + where(moment, Status.EM_OUT_OF_RANGE, 0.0)
        + where((MU != PIVOT) & (MUP <= PIVOT), Status.MU_OUT_OF_RANGE, 0.0)
        + where(at > SIDE_TOLERANCE * fabs(da), Status.A_ON_WRONG_SIDE, 0.0)
        + where(bt > SIDE_TOLERANCE * fabs(db), Status.B_ON_WRONG_SIDE, 0.0)
        + where(gn >= 0.0, Status.SEPARATING, 0.0)
        + where(PN < 0.0, Status.PULLING, 0.0)
        + where(-(EL + EL) > ENERGY_TOLERANCE * KI, Status.ENERGY_GAINED, 0.0)
        + where(COND < SINGULAR_FROM, 0.0, Status.SINGULAR)
        + where(finite, 0.0, Status.NOT_FINITE)
    )
    return (STATUS,)
