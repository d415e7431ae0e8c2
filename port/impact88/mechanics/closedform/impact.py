"""The planar impact in closed form: Equations 13 to 18 solved once and for all.

Written in inverse masses and inertias, so that a rigid barrier (a body that cannot be moved) is
the number 0 and nothing special. A spin is taken as the mean spin, (Ia omega_a + Ib omega_b)/(Ia +
Ib), and what is left of the difference. The unknowns are the impulse (Pn, Pt) on A and H, Ired
times the final spins' difference (J = 1/(Ia + Ib), Ired = Ia·Ib/(Ia + Ib))::

    Omega_a = mean + J sigma·P + H/Ia        Omega_b = mean + J sigma·P - H/Ib

With w = e gn + cn, (cn, ct) the relative velocity of the mass centers, Q_ij = R delta_ij + J
sigma_i sigma_j and kappa_i = a_i/Ia - b_i/Ib, the restitution equation (15), no slip at separation
(listing lines 430-440) and the moment equation (18), *multiplied through by z = 1 - 2 em*, read::

    Q_nn Pn + Q_nt Pt + kappa_n H = -(w + sigma_n mean)
    Q_nt Pn + Q_tt Pt + kappa_t H = -(ct + sigma_t mean)                       (pivot only)
    em Ired kappa·P + z H         = -em Ired (omega_a - omega_b)

Friction has Pt = mu Pn for the middle line. Every unknown, the slip left by friction too, is found
by Cramer's rule with the factor z cancelled: no term becomes infinite at em = 1/2, and for -1 <= em
<= 0 the pivot's determinant is a sum of terms of one sign. None is found from another, nor from
both spins apart: such differences would lose their digits where an arm is far longer than a radius
of gyration, or one body far lighter than the other. What of the spins is left are the products Ired
X = Ired (b omega_a/Ib - a omega_b/Ia), and a x b = an bt - at bn, which is Ired kappa x sigma. The
moment impulse is (1 - em) H/em by Equation 18.

Single spins are no sums of mean and H either, which may cancel: in Cramer's numerators of both, the
terms of R, of w and of X are added by themselves, with p = Ired (z/Ib - em/Ia), q = 1 - em, and,
for friction, a = an + mu at, b = bn + mu bt and sigma and kappa = a/Ia - b/Ib along the impulse::

    Omega_a D = R [p omega_a + q omega_b Ired/Ia] - w [z J sigma - em Ired kappa/Ia]
                + em bn [a omega_b/Ia - b omega_a/Ib]

and with a and b (p with its inertias) exchanged for B, kappa's sign, too. At em = 0 both are the
same sums, and so the same bits. The pivot's, divided by R, are with w as a vector::

    p [R omega_a - a.w/Ia] + q [R omega_b - b.w/Ib] Ired/Ia
        + em [a.b omega_b/Ia - b.b omega_a/Ib - (a x b)(b x w)/(Ia Ib R)]

A velocity after is no sum of the one before and its change where the change takes away most of it:
the centers' relative velocity after has numerators of its own, in which what was taken away is no
term. Friction's along n, with levers for what the arms give of D::

    D (cn + R Pn) = levers cn - z R (e gn + sigma_n mean) + em R kappa_n Ired (omega_a - omega_b)

A pivot's, along x and y, are next to its velocities.

Symbols here, and what the listing calls them (its line, or the chapter's equation):

============== ====================================== ===========================================
here           is                                     in the listing
============== ====================================== ===========================================
s, c           sine and cosine of GA                  SIN (GA), COS (GA)
ma, mb, ia, ib 1/MA, 1/MB, 1/IA, 1/IB                 MA MB IA IB of line 310
D1 D2 D3 D4    arms along x and y                     the same (330)
an, bn         arms along n                           A(4,5), A(4,6) (460, Equation 15)
at, bt         arms along t                           -A(3,5), -A(3,6) (440, Equation 16, pivot)
sn, st         sigma: an + bn, at + bt
kn, kt         kappa: an/IA - bn/IB, at/IA - bt/IB
sn_, kn_ ...   the same of absolute values: "_" is a size
R              1/MA + 1/MB
both           1/IA + 1/IB
Ired, J        IA·IB/(IA + IB), 1/(IA + IB)
z              1 - 2 em                               A(6,6) (490, Equation 18)
mean, turn     mean spin, Ired (WA - WB)
dx, dy         relative velocity of the centers       UX - VX, UY - VY
cn, ct         the same along n and t
gn, gt         relative velocity of the contact point A(4,M + 1) is -E·gn (540); gt > 0 (400)
mu             MU after the sign rule                 MU (400, Equation 16)
Pn, Pt, Px, Py impulse on A                           MA·(VAX - UX) ... (Equations 13, 14)
H, moment      H/em is the moment's part PM/(1 - em)  line 560, Equation 18
spin_a, spin_b final spins                            A(5,M + 1), A(6,M + 1) (550, 560)
VAX ... VBY    final velocities                       A(1,M + 1) to A(4,M + 1) (570)
KI, KF, LOSS   energies                               320, 580 and 590
============== ====================================== ===========================================

Axes: n = (cos GA, sin GA), t = (-sin GA, cos GA), A on the +n side; P acts on A, -P on B. Every
quantity is an `Expression`: what nobody asks for is noted and never computed.
"""

from collections.abc import Mapping, Sequence
from math import inf, pi
from sys import float_info
from typing import NamedTuple

from ...names import PIVOT
from ...status import Status
from ..native.expressiontable import Expression, ExpressionTable
from .energy import kinetic_energy
from .statusbits import Evidence, findings

LARGEST = float_info.max
RADIAN = pi / 180
"""A degree in radians."""
MOST = 2 / 3
"""Fraction of a center's velocity that an impact without rebound takes away. Above it, the velocity
after is computed from the other body's."""


Condition = bool | Expression
"""True where all scenes are so, False where none is, else which are."""


class Given:
    """The part that all formulas share: a scene as they take it, geometry, inertia, motion before.

    ``pivot``, ``point``, ``infinite``, ``sign``: see `impact`. Groups of values are in the order
    in which they are unpacked everywhere.
    """

    def __init__(
        self,
        table: ExpressionTable,
        scene: Mapping[str, Expression],
        pivot: Condition,
        point: Condition,
        infinite: bool,
        sign: float | None,
    ) -> None:
        self.table, self.scene = table, scene
        self.pivot, self.point, self.infinite = pivot, point, infinite
        self.zero, self.one = table.constant(0.0), table.constant(1.0)
        self.E, self.masses = scene["E"], (scene["MA"], scene["MB"])
        self.velocities = tuple(scene[name] for name in ("UX", "UY", "VX", "VY"))
        # a point mass has neither arm nor spin, whatever its columns hold
        self.EM, WA, WB, DA, DB = (
            self.unless_point(scene[name]) for name in ("EM", "WA", "WB", "DA", "DB")
        )
        self.spins, self.distances = (WA, WB), (DA, DB)
        self.inertias = tuple(self.unless_point(scene[name], self.one) for name in ("IA", "IB"))
        self._set_geometry()
        self._set_inertia()
        self._set_motion(sign)

    def unless_point(self, value: Expression, instead: Expression | None = None) -> Expression:
        """Return a value, and what is there instead of it where bodies are points: by default 0."""
        instead = self.zero if instead is None else instead
        if self.point is False:
            return value
        return instead if self.point is True else self.table.choose(self.point, instead, value)

    def to_contact_axes(self, x: Expression, y: Expression) -> tuple[Expression, Expression]:
        """Return the components along n and t of a vector along x and y."""
        s, c = self.axes
        return c * x + s * y, c * y - s * x

    def to_fixed_axes(self, n: Expression, t: Expression) -> tuple[Expression, Expression]:
        """Return the components along x and y of a vector along n and t."""
        s, c = self.axes
        return c * n - s * t, s * n + c * t

    def cross_with_spins(self, a: Expression, b: Expression) -> Expression:
        """Ired X = Ired (b omega_a/Ib - a omega_b/Ia) of arms a and b in one direction."""
        of_a, of_b = self.parts_of_mean
        return b * of_a - a * of_b

    def _set_geometry(self) -> None:
        """Set the arms: what a spin adds to the contact velocity along n and t, of A, and of B with
        the sign that the relative velocity a - b takes; and line 330's numbers."""
        scene, sine_and_cosine = self.scene, self.table.sine_and_cosine
        self.axes = sine_and_cosine(scene["GA"])

        def arms(distance: Expression, angle: Expression) -> Sequence[Expression]:
            if distance.is_zero:
                return [distance] * 4
            (sine, cosine), (sn, cs) = map(sine_and_cosine, (angle, angle - scene["GA"]))
            return distance * sn, -(distance * cs), distance * sine, distance * cosine

        DA, DB = self.distances
        an, at, D3, D4 = arms(DA, scene["TA"] + scene["PA"])
        bn, bt, D1, D2 = arms(DB, scene["TB"] + scene["PB"])
        self.arms, self.fixed_arms = (an, at, bn, bt), (D3, D4, D1, D2)
        self.arm_sizes = tuple(map(self.table.absolute, self.arms))

    def _set_inertia(self) -> None:
        """Inverse masses and inertias, and what is made of them and the arms."""
        self.inverses = ma, mb, ia, ib = tuple(1.0 / x for x in (*self.masses, *self.inertias))
        R, both = ma + mb, ia + ib
        Ired = 1.0 / both
        weight_a, weight_b = ib * Ired, ia * Ired  # Ia/(Ia + Ib), of A's spin in the mean
        J = ia * weight_a  # 1/(Ia + Ib), in an order that the largest inertias survive
        self.reduced = R, both, Ired, J
        an, at, bn, bt = self.arms
        self.sums = an + bn, at + bt, an * ia - bn * ib, at * ia - bt * ib
        an_, at_, bn_, bt_ = self.arm_sizes
        self.sizes = an_ + bn_, at_ + bt_, an_ * ia + bn_ * ib, at_ * ia + bt_ * ib
        # what a body's own state and the other's weigh in its final spin times the determinant
        EM = self.EM
        self.z, other = 1.0 - (EM + EM), 1.0 - EM
        own_a, own_b = self.z * weight_a - EM * weight_b, self.z * weight_b - EM * weight_a
        self.weights = own_a, own_b, other * weight_a, other * weight_b
        WA, WB = self.spins
        self.parts_of_mean = weight_a * WA, weight_b * WB

    def _set_motion(self, sign: float | None) -> None:
        """The relative velocity before, of the mass centers along x and y, n and t, and at the
        contact point; the mean spin; friction."""
        (UX, UY, VX, VY), (WA, WB) = self.velocities, self.spins
        an, at, bn, bt = self.arms
        self.of_centers = dx, dy = UX - VX, UY - VY
        self.approach = cn, ct = self.to_contact_axes(dx, dy)
        gn, gt = cn + an * WA + bn * WB, ct + at * WA + bt * WB
        self.of_contact = gn, gt, WA - WB
        of_a, of_b = self.parts_of_mean
        _, _, Ired, _ = self.reduced
        self.mean, self.turn = of_a + of_b, Ired * (WA - WB)
        # MU after the sign rule of line 400: changed where gt > 0, kept on a tie
        MU = self.scene["MU"]
        self.mu = self.table.against(MU, gt) if sign is None else sign * MU


class Found(NamedTuple):
    """The impulse, the motion after and what else depends on the kind of impact.

    ``moment``: H/em, which is PM/(1 - em); ``slip``: the tangential relative velocity at
    separation; ``sliding``: MU after the sign rule, 0 for a pivot; ``absolute_sum``: the
    determinant with every sum in it replaced by the sum of the absolute values.
    """

    determinant: Expression
    PN: Expression
    PT: Expression
    Px: Expression
    Py: Expression
    moment: Expression
    spin_a: Expression
    spin_b: Expression
    VAX: Expression
    VAY: Expression
    VBX: Expression
    VBY: Expression
    slip: Expression
    MUP: Expression
    sliding: Expression
    absolute_sum: Expression


class Sliding:
    """The impulse of friction, along the direction (1, mu), and what it is made of.

    ``inverse``: 1 over the determinant; ``a``, ``b``, ``sigma_J``, ``twist``, ``X``: arms, J sigma,
    Ired kappa and Ired X along the impulse; ``rebound``, ``w``: e gn, and with cn; ``push``: what w
    takes of the spins through sigma, ``em_twist`` through kappa; ``levers``: what the arms give of
    the determinant; ``of_turn``: what the spins' difference gives of Pn times the determinant;
    ``along_x``, ``along_y``: the direction along x and y.
    """

    def __init__(self, g: Given) -> None:
        z, mu, (an, at, bn, bt), (sn, _, kn, _) = g.z, g.mu, g.arms, g.sums
        (_, _, ia, ib), (R, _, Ired, J) = g.inverses, g.reduced
        (cn, _), (gn, _, _) = g.approach, g.of_contact
        self.rebound = g.E * gn
        self.w = w = self.rebound + cn
        self.a, self.b = a, b = an + mu * at, bn + mu * bt
        self.sigma_J, self.twist = J * (a + b), Ired * (a * ia - b * ib)
        self.X = g.cross_with_spins(a, b)
        self.push, self.em_twist = z * self.sigma_J, g.EM * self.twist
        self.levers = self.push * sn - self.em_twist * kn
        self.determinant = z * R + self.levers
        self.inverse = 1.0 / self.determinant
        self.of_turn = (g.EM * kn) * g.turn
        self.Pn = (self.of_turn - z * (w + sn * g.mean)) / self.determinant
        self.Pt = mu * self.Pn
        self.along_x, self.along_y = g.to_fixed_axes(g.one, mu)
        self.Px, self.Py = self.along_x * self.Pn, self.along_y * self.Pn


def _sliding_spins(g: Given, p: Sliding) -> tuple[Expression, Expression, Expression]:
    """Return H/em and both spins after an impact with friction."""
    (_, _, ia, ib), (R, _, _, _), (WA, WB) = g.inverses, g.reduced, g.spins
    (an, _, bn, _), (sn, _, _, _) = g.arms, g.sums
    own_a, own_b, other_a, other_b = g.weights
    moment = g.unless_point((p.twist * p.w - g.turn * R - sn * p.X) * p.inverse)
    cross = g.EM * (p.a * (ia * WB) - p.b * (ib * WA))
    # what w multiplies is in the determinant, too: sums that cancel have errors in common
    kept_a, kept_b = own_a * WA + other_b * WB, own_b * WB + other_a * WA
    spin_a = (R * kept_a - p.w * (p.push - ia * p.em_twist) + bn * cross) * p.inverse
    spin_b = (R * kept_b - p.w * (p.push + ib * p.em_twist) - an * cross) * p.inverse
    return moment, spin_a, spin_b


def _slip(g: Given, p: Sliding) -> Expression:
    """Return the slip that friction leaves, by Cramer's rule, too: of ct and of what the impulse
    changes of it little may be left."""
    mu, mean, w = g.mu, g.mean, p.w
    (an, at, bn, bt), (sn, st, kn, kt) = g.arms, g.sums
    (_, ct), (R, both, _, _) = g.approach, g.reduced
    # a x b, which is Ired kappa x sigma without the difference of products whose digits are lost in
    # kappa already, times (Ia + Ib)
    crossing = both * (an * bt - at * bn)
    kept = g.z * (R * ((ct + st * mean) - mu * (w + sn * mean)) + p.sigma_J * (ct * sn - st * w))
    traded = p.twist * (kt * w - kn * ct) + (g.turn * R) * (mu * kn - kt) + crossing * p.X
    return (kept + g.EM * traded) / p.determinant


def _sliding_velocities(g: Given, p: Sliding) -> list[Expression]:
    """Return VAX, VAY, VBX and VBY after an impact with friction.

    Where the impulse takes away most of a light body's velocity along x or y, that is found from
    the other's and the relative one after, of which no term is taken away again.
    """
    table, z, (s, c) = g.table, g.z, g.axes
    (MA, MB), (ma, mb, _, _), (R, _, _, _) = g.masses, g.inverses, g.reduced
    (UX, UY, VX, VY), (dx, dy), (cn, _) = g.velocities, g.of_centers, g.approach
    sn, _, _, _ = g.sums
    taken_x, taken_y = c * p.along_x, s * p.along_y  # 1 together
    parting = (R * (p.of_turn - z * (p.rebound + sn * g.mean)) + p.levers * cn) * p.inverse
    parting = g.unless_point(parting, -p.rebound)
    relative_x = dx * taken_y + p.along_x * (parting - s * dy)
    relative_y = dy * taken_x + p.along_y * (parting - c * dx)
    of_masses, much_of_a, much_of_b = z * p.inverse, MOST * MA, MOST * MB
    product = taken_x * taken_y
    if not product.is_zero:  # but not both taken away and added, by much friction
        of_masses = table.choose(product > -0.5, of_masses, g.zero)
    taken_x, taken_y = of_masses * taken_x, of_masses * taken_y

    def of_light(
        taken: Expression, much: Expression, instead: Expression, velocity: Expression
    ) -> Expression:
        return velocity if taken.is_zero else table.choose(taken > much, instead, velocity)

    VAX, VAY = UX + ma * p.Px, UY + ma * p.Py
    VBX, VBY = VX - mb * p.Px, VY - mb * p.Py
    return [
        of_light(taken_x, much_of_a, VBX + relative_x, VAX),
        of_light(taken_y, much_of_a, VBY + relative_y, VAY),
        of_light(taken_x, much_of_b, VAX - relative_x, VBX),
        of_light(taken_y, much_of_b, VAY - relative_y, VBY),
    ]


def _friction(g: Given) -> Found:
    """Return the impact with friction."""
    p = Sliding(g)
    moment, spin_a, spin_b = _sliding_spins(g, p)
    slip = _slip(g, p)
    VAX, VAY, VBX, VBY = _sliding_velocities(g, p)
    (sn_, st_, kn_, kt_), (R, _, Ired, J), size = g.sizes, g.reduced, abs(g.mu)
    straight = R * (1.0 + size) + J * (sn_ * (sn_ + size * st_))
    twisting = abs(g.EM) * (Ired * (kn_ * (kn_ + size * kt_)))
    return Found(
        determinant=p.determinant,
        PN=p.Pn,
        PT=p.Pt,
        Px=p.Px,
        Py=p.Py,
        moment=moment,
        spin_a=spin_a,
        spin_b=spin_b,
        VAX=VAX,
        VAY=VAY,
        VBX=VBX,
        VBY=VBY,
        slip=slip,
        MUP=g.mu,
        sliding=g.mu,
        absolute_sum=abs(g.z) * straight + twisting,
    )


class Pivot:
    """A pivot's impulse, and what it is made of: MUC and STATUS of friction take some of it, too.

    Everything is divided by R, along x and y: GA only enters by the restitution, and what is
    rounded in turning to n and t would be lost where the sliding is all but undone.

    ``numerators``: of MUC, R Pt and R Pn times the determinant; ``ax`` to ``by``, ``sx``, ``kx``
    ...: arms, sigma and kappa along x and y; ``tx``, ``ty``: Ired kappa; ``rx``, ``ry``: the
    rebound; ``wx``, ``wy``: w as a vector; ``Xx``, ``Xy``: Ired X; ``s_across``: sigma x w;
    ``of_turn_x``, ``of_turn_y``: what the spins give of the impulse; ``turn_R``: R turn;
    ``lever``, ``lever_J``: a x b times (Ia + Ib) and times J/R; ``zJ``, ``masses``: z J, z R.
    """

    def __init__(self, g: Given) -> None:
        E, EM, z, mean, turn, (s, c) = g.E, g.EM, g.z, g.mean, g.turn, g.axes
        (_, _, ia, ib), (R, both, Ired, J), (WA, WB) = g.inverses, g.reduced, g.spins
        (D3, D4, D1, D2), (dx, dy) = g.fixed_arms, g.of_centers
        self.ax, self.ay, self.bx, self.by = ax, ay, bx, by = D3, -D4, D1, -D2
        self.sx, self.sy = sx, sy = ax + bx, ay + by
        self.kx, self.ky = kx, ky = ax * ia - bx * ib, ay * ia - by * ib
        self.tx, self.ty = tx, ty = Ired * kx, Ired * ky
        rebound = E * (c * (dx + ax * WA + bx * WB) + s * (dy + ay * WA + by * WB))
        self.rx, self.ry = rx, ry = c * rebound, s * rebound
        self.wx, self.wy = wx, wy = dx + rx, dy + ry
        self.Xx, self.Xy = Xx, Xy = g.cross_with_spins(ax, bx), g.cross_with_spins(ay, by)
        # a x b = Ired kappa x sigma, without the difference of products whose digits are lost in
        # kappa already
        cross = ax * by - ay * bx
        self.R_inverse = 1.0 / R
        self.lever = lever = both * cross
        self.lever_J = (J * self.R_inverse) * cross
        # sigma x (w, ct) and (w, ct) x kappa, which the mean spin drops out of
        self.s_across = sx * wy - sy * wx
        k_across = ky * wx - kx * wy
        # the determinant divided by R: what the masses give of it and what the arms do, sums of
        # squares without cancellation however slight R is
        self.zJ, self.masses = zJ, masses = z * J, z * R
        levers = zJ * (sx * sx + sy * sy) - EM * (tx * kx + ty * ky + lever * self.lever_J)
        self.determinant = masses + levers
        # R P times the determinant, along x and y: at first without the approach of the mass
        # centers, which is -z R times it; of bodies without arms only the rebound is left
        self.turn_R, along = turn * R, zJ * self.s_across
        self.of_turn_x = self.turn_R * kx + lever * Xy
        self.of_turn_y = self.turn_R * ky - lever * Xx
        x = EM * (self.of_turn_x + ty * k_across) - masses * (rx + sx * mean)
        y = EM * (self.of_turn_y - tx * k_across) - masses * (ry + sy * mean)
        x, y = x + sy * along, y - sx * along
        RPx, RPy = x - masses * dx, y - masses * dy
        critical_denominator, critical_numerator = g.to_contact_axes(RPx, RPy)
        self.numerators = critical_numerator, critical_denominator
        divisor = R * self.determinant
        self.Px, self.Py = RPx / divisor, RPy / divisor
        self.Pn, self.Pt = g.to_contact_axes(self.Px, self.Py)


def _pivot_spins(g: Given, p: Pivot) -> tuple[Expression, Expression, Expression]:
    """Return H/em and both spins after a pivot."""
    (_, _, ia, ib), (R, _, _, J), (WA, WB) = g.inverses, g.reduced, g.spins
    own_a, own_b, other_a, other_b = g.weights
    ax, ay, bx, by, wx, wy = p.ax, p.ay, p.bx, p.by, p.wx, p.wy
    moment = p.tx * wx + p.ty * wy - p.turn_R
    moment = moment - (p.sx * p.Xx + p.sy * p.Xy + p.lever_J * p.s_across)
    a_b, aa, bb = ax * bx + ay * by, ax * ax + ay * ay, bx * bx + by * by
    crossing = p.lever * (J * p.R_inverse)
    turned_a = a_b * (ia * WB) - bb * (ib * WA) - crossing * (bx * wy - by * wx)
    turned_b = a_b * (ib * WA) - aa * (ia * WB) + crossing * (ax * wy - ay * wx)
    state_a = R * WA - ia * (ax * wx + ay * wy)
    state_b = R * WB - ib * (bx * wx + by * wy)
    spin_a = own_a * state_a + other_b * state_b + g.EM * turned_a
    spin_b = own_b * state_b + other_a * state_a + g.EM * turned_b
    moment = g.unless_point(moment / p.determinant)
    return moment, spin_a / p.determinant, spin_b / p.determinant


def _pivot_velocities(g: Given, p: Pivot) -> list[Expression]:
    """Return VAX, VBX, VAY and VBY after a pivot.

    What the impact takes away and what it leaves of the mass centers' approach along x and y, times
    the determinant: of a small rest nothing that was taken away is a term. Of a light body that
    keeps little of its velocity the change has rounding errors of the size of what it lost; the
    common velocity and a share of the final relative one have not, but spoil a small change by long
    arms. Sizes, for both are negative where EM > 1/2.
    """
    table, EM, mean, (ma, mb, _, _) = g.table, g.EM, g.mean, g.inverses
    (UX, UY, VX, VY), (dx, dy), masses = g.velocities, g.of_centers, p.masses
    zJx = p.zJ * p.sx
    xx, yy = zJx * p.sx - EM * (p.tx * p.kx), (p.zJ * p.sy) * p.sy - EM * (p.ty * p.ky)
    xy, crossed = zJx * p.sy - EM * (p.tx * p.ky), EM * (p.lever * p.lever_J)
    share_a, share_b = ma * p.R_inverse, mb * p.R_inverse

    def along_axis(
        a_before: Expression,
        b_before: Expression,
        approach: Expression,
        rest: Expression,
        taken: Expression,
        left: Expression,
    ) -> tuple[Expression, Expression]:
        """Return the velocities of A and B along x or y; ``rest``: the change times the
        determinant, without ``approach``."""
        is_little = abs(left) < abs(taken)
        common = share_b * a_before + share_a * b_before
        change = (rest + table.choose(is_little, left, -taken) * approach) / p.determinant
        return (
            table.choose(is_little, common, a_before) + share_a * change,
            table.choose(is_little, common, b_before) - share_b * change,
        )

    taken_x, taken_y = masses + yy, masses + xx
    rest_x = EM * p.of_turn_x - masses * (p.sx * mean) + xy * p.wy - taken_x * p.rx
    rest_y = EM * p.of_turn_y - masses * (p.sy * mean) + xy * p.wx - taken_y * p.ry
    return [
        *along_axis(UX, VX, dx, rest_x, taken_x, xx - crossed),
        *along_axis(UY, VY, dy, rest_y, taken_y, yy - crossed),
    ]


def _no_slip(g: Given, p: Pivot) -> Found:
    """Return the pivot: no sliding at separation."""
    moment, spin_a, spin_b = _pivot_spins(g, p)
    VAX, VBX, VAY, VBY = _pivot_velocities(g, p)
    (an_, at_, bn_, bt_), (_, _, kn_, kt_), (R, both, Ired, J) = g.arm_sizes, g.sizes, g.reduced
    twisting = Ired * (kn_ * kn_ + kt_ * kt_)
    twisting = twisting + abs(p.lever_J) * (both * (an_ * bt_ + at_ * bn_))
    straight = R + J * (p.sx * p.sx + p.sy * p.sy)
    return Found(
        determinant=p.determinant,
        PN=p.Pn,
        PT=p.Pt,
        Px=p.Px,
        Py=p.Py,
        moment=moment,
        spin_a=spin_a,
        spin_b=spin_b,
        VAX=VAX,
        VAY=VAY,
        VBX=VBX,
        VBY=VBY,
        slip=g.zero,
        MUP=g.table.constant(PIVOT),
        sliding=g.zero,
        absolute_sum=abs(g.z) * straight + abs(g.EM) * twisting,
    )


def _contact_velocities(g: Given, found: Found) -> tuple[Expression, ...]:
    """Return XAF, YAF, XBF and YBF.

    The contact points part by the rebound along n and the slip along t. Where the terms of the one
    are smaller, with those of rebound and slip, the other is found from it: of the terms of a car
    that stops at a barrier, or of a long arm that hits, little is left. An arm has the rounding
    errors of its angle, too, times the component across.
    """
    table, scene, E, pivot, zero = g.table, g.scene, g.E, g.pivot, g.zero
    absolute, unless_point, to_fixed_axes = table.absolute, g.unless_point, g.to_fixed_axes
    (UX, UY, VX, VY), (WA, WB), (s, c) = g.velocities, g.spins, g.axes
    (an, _, bn, _), (D3, D4, D1, D2), (R, _, _, _) = g.arms, g.fixed_arms, g.reduced
    (cn, ct), (gn, gt, _) = g.approach, g.of_contact
    PT, slip, spin_a, spin_b = found.PT, found.slip, found.spin_a, found.spin_b
    VAX, VAY, VBX, VBY = found.VAX, found.VAY, found.VBX, found.VBY
    part_x, part_y = to_fixed_axes(-(E * gn), slip)
    slipping = absolute(ct) + absolute(gt) + absolute(R * PT)
    if not isinstance(pivot, bool):
        slipping = table.choose(pivot, zero, slipping)
    elif pivot:
        slipping = zero
    rebounding = absolute(E) * (absolute(cn) + absolute(an * WA) + absolute(bn * WB))

    def contacts(
        before: tuple[Expression, Expression],
        after: tuple[Expression, Expression],
        turned: tuple[Expression, Expression],
        rounded: tuple[Expression, Expression],
        parting: Expression,
        of_parting: Expression,
    ) -> tuple[Expression, Expression]:
        """Return the contact points' velocities of A and B along x or y.

        ``before`` and ``after``: the centers' velocities; ``turned``: what the spins add;
        ``rounded``: the derivative by the arm's angle, times that; ``parting``: the relative
        velocity after, ``of_parting``: the sizes of its terms.
        """
        terms = [absolute(x) + absolute(y) for x, y in zip(before, after, strict=True)]
        terms_a, terms_b = (
            x + absolute(y) + absolute(z) for x, y, z in zip(terms, turned, rounded, strict=True)
        )
        a, b = (x + y for x, y in zip(after, turned, strict=True))
        of_a = table.choose(terms_b + of_parting < terms_a, b + parting, a)
        of_b = table.choose(terms_a + of_parting < terms_b, a - parting, b)
        return unless_point(of_a, after[0]), unless_point(of_b, after[1])

    # in an order of their own: a kernel has the sums whose sines it takes in another loop
    angle_a, angle_b = scene["PA"] + scene["TA"], scene["PB"] + scene["TB"]
    arc_a, arc_b = (RADIAN * angle_a) * spin_a, (RADIAN * angle_b) * spin_b
    turned_x, turned_y = (D3 * spin_a, -(D1 * spin_b)), (-(D4 * spin_a), D2 * spin_b)
    rounded_x, rounded_y = (D4 * arc_a, D2 * arc_b), (D3 * arc_a, D1 * arc_b)
    terms_x = absolute(s) * slipping + absolute(c) * rebounding
    terms_y = absolute(c) * slipping + absolute(s) * rebounding
    XAF, XBF = contacts((UX, VX), (VAX, VBX), turned_x, rounded_x, part_x, terms_x)
    YAF, YBF = contacts((UY, VY), (VAY, VBY), turned_y, rounded_y, part_y, terms_y)
    return XAF, YAF, XBF, YBF


class Energies(NamedTuple):
    """Kinetic energies before and after, twice the energy lost in all, and twice the works of the
    normal, the tangential and the moment impulse; ``works``: twice what these lose."""

    KI: Expression
    KF: Expression
    twice_lost: Expression
    crushed: Expression
    rubbed: Expression
    twisted: Expression
    works: Expression


def _energies(g: Given, found: Found, H: Expression, PM: Expression) -> Energies:
    """Return the energies of an impact whose moment impulse is PM."""
    table, zero, infinite, pivot = g.table, g.zero, g.infinite, g.pivot
    unless_point, absolute, E = g.unless_point, table.absolute, g.E
    (MA, MB), (IA, IB) = g.masses, g.inertias
    (UX, UY, VX, VY), (WA, WB), (_, both, _, _) = g.velocities, g.spins, g.reduced
    (dx, dy), (gn, gt, gw) = g.of_centers, g.of_contact
    PN, PT, Px, Py, slip = found.PN, found.PT, found.Px, found.Py, found.slip
    VAX, VAY, VBX, VBY = found.VAX, found.VAY, found.VBX, found.VBY
    spin_a, spin_b = found.spin_a, found.spin_b

    def finite(inertia: Expression) -> Expression:
        """An infinite body is at rest, exactly, before and after: times 0 any number will do."""
        if inertia.is_constant(inf):
            return zero
        return table.minimum(inertia, LARGEST) if infinite else inertia

    inertias = [finite(x) for x in (MA, MB, IA, IB)]
    KI = kinetic_energy(inertias, (UX, UY, WA, VX, VY, WB))
    final_spins = unless_point(spin_a), unless_point(spin_b)
    KF = kinetic_energy(inertias, (VAX, VAY, final_spins[0], VBX, VBY, final_spins[1]))
    # Twice the energy lost by each impulse: its work at the mean of the relative velocities before
    # and after, negated. KI - KF would lose digits when little is lost.
    crushed, rubbed = ((1.0 - E) * gn) * PN, PT * (gt + slip)
    twisted = PM * (gw + both * H)
    lost = -(crushed + rubbed + twisted)
    all_lost = lost
    if pivot is not False:
        # What long arms make of a pivot's works nearly cancels: then the loss is what the impulse
        # does at the centers and what the spins lose, if these have the smaller terms.
        x, y = dx + (VAX - VBX), dy + (VAY - VBY)
        (wa, wb), (fa, fb) = (WA, WB), final_spins
        of_spins = inertias[2] * ((wa - fa) * (wa + fa)) + inertias[3] * ((wb - fb) * (wb + fb))
        in_spins = inertias[2] * (wa * wa + fa * fa) + inertias[3] * (wb * wb + fb * fb)
        in_works = absolute(crushed) + absolute(rubbed) + absolute(twisted)
        smaller = absolute(Px * x) + absolute(Py * y) + in_spins < in_works
        of_pivot = table.choose(smaller, of_spins - (Px * x + Py * y), lost)
        all_lost = of_pivot if pivot is True else table.choose(pivot, of_pivot, lost)
    return Energies(KI, KF, all_lost, crushed, rubbed, twisted, lost)


def _equivalent_speeds(g: Given, twice_lost: Expression) -> tuple[Expression, Expression]:
    """Return EESA and EESB."""
    table, zero, infinite = g.table, g.zero, g.infinite
    (MA, MB), (ma, mb, _, _) = g.masses, g.inverses
    # of an impact that gains energy nothing is left for crush; NaN stays NaN
    twice_crush = table.choose(twice_lost < 0.0, zero, twice_lost)
    root_of_all, root_of_half = table.root(twice_crush), table.root(0.5 * twice_crush)

    def equivalent_speed(inverse_mass: Expression, other: Expression) -> Expression:
        """The speed whose kinetic energy is the body's part of the loss: half, or all of it where
        the other body is a rigid barrier. Roots apart: the product of a large energy and a large
        inverse mass may overflow."""
        own = root_of_half
        if other.is_constant(inf):
            own = root_of_all
        elif infinite:
            own = table.choose(table.equals(other, inf), root_of_all, root_of_half)
        return own * table.root(inverse_mass)

    return equivalent_speed(ma, MB), equivalent_speed(mb, MA)


def _velocity_changes(g: Given, found: Found) -> tuple[Expression, Expression]:
    """Return DVA and DVB."""
    table, Px, Py, (ma, mb, _, _) = g.table, found.Px, found.Py, g.inverses

    def change_size(inverse_mass: Expression) -> Expression:
        """Return the size of a center's velocity change, by operations that every machine rounds
        alike."""
        x, y = inverse_mass * Px, inverse_mass * Py
        return table.root(x * x + y * y)

    return change_size(ma), change_size(mb)


def _condition(g: Given, found: Found) -> Expression:
    """Return COND, an estimate of the condition number of the 6x6 equations, scaled best.

    It is the determinant with every sum in it replaced by the sum of the absolute values, divided
    by the determinant, times 3, the typical ratio to Bauer's number, the spectral radius of
    |A^-1||A|. Over 10^4 scenes of each of the benchmark's populations within a factor 5 of it for
    98 % and within 55 always; for EM within 1e-1 to 1e-16 of 1/2, for 91 % and 400.
    """
    return 3.0 * (found.absolute_sum / g.table.absolute(found.determinant))


def _status(
    g: Given, p: Pivot, found: Found, energies: Energies, PM: Expression, COND: Expression
) -> Expression:
    """Return STATUS."""
    table, absolute, pivot, E, EM = g.table, g.table.absolute, g.pivot, g.E, g.EM
    (an, at, bn, bt), (_, _, _, kt), (DA, DB) = g.arms, g.sums, g.distances
    (_, _, ia, ib), (R, _, _, _), (gn, gt, _) = g.inverses, g.reduced, g.of_contact
    critical_numerator, critical_denominator = p.numerators
    pivot_determinant, PN, sliding = p.determinant, found.PN, found.sliding
    lost, KI = energies.works, energies.KI
    WAF = g.unless_point(found.spin_a, g.scene["WA"])
    WBF = g.unless_point(found.spin_b, g.scene["WB"])
    sum_of_velocities = found.VAX + found.VAY + found.VBX + found.VBY + WAF + WBF
    turning = (an * at * ia + bn * bt * ib) * PN + kt * PM
    yielding = R + (at * at * ia + bt * bt * ib)
    sign_of_pivot = table.choose(pivot_determinant < 0.0, table.constant(-1.0), table.constant(1.0))
    status = findings(
        Evidence(
            gn=gn,
            pn=PN,
            arm_a=at,
            arm_b=bt,
            da=DA,
            db=DB,
            twice_lost=lost,
            initial=KI,
            e=E,
            em=EM,
            mu=sliding,
            # only signs and ratios of the pivot's impulse count: its numerators will do
            forward=table.against(sliding, -(critical_numerator * sign_of_pivot)),
            pivot_pn=critical_denominator * sign_of_pivot,
            limit=absolute(critical_numerator),
            gt=gt,
            turning=turning,
            yielding=yielding,
            condition=COND,
            sum_of_velocities=sum_of_velocities,
        )
    )
    if pivot is True:  # of friction none is at fault
        del status[Status.FRICTION_ABOVE_CRITICAL], status[Status.FRICTION_WRONG_DIRECTION]
    bits = [condition * float(bit) for bit, condition in status.items()]
    status_bits: Expression = sum(bits[1:], bits[0])
    return status_bits


def impact(
    table: ExpressionTable,
    scene: Mapping[str, Expression],
    pivot: Condition,
    point: Condition,
    infinite: bool,
    sign: float | None = None,
) -> dict[str, Expression]:
    """The results of an impact by name, of the expressions of a scene's columns; beside them ``gn``
    and ``gt``, ``determinant``, which is zero where the equations have no solution, and
    ``critical_denominator``, which divides MUC.

    ``pivot``: True when MU = -10 throughout, False when nowhere, else the condition where it is.
    ``point``: the same for M = 4. ``infinite``: whether a body may be. ``sign``: what MU is
    multiplied with instead of the sign rule.
    """
    # not split: one result after another, each from those above
    g = Given(table, scene, pivot, point, infinite, sign)
    p = Pivot(g)
    if isinstance(pivot, bool):
        found = _no_slip(g, p) if pivot else _friction(g)
    else:
        pairs = zip(_no_slip(g, p), _friction(g), strict=True)
        found = Found(*(table.choose(pivot, fixed, sliding) for fixed, sliding in pairs))
    H, PM = g.EM * found.moment, (1.0 - g.EM) * found.moment
    XAF, YAF, XBF, YBF = _contact_velocities(g, found)
    energies = _energies(g, found, H, PM)
    KI, KF, twice_lost, crushed, rubbed, twisted, _ = energies
    EESA, EESB = _equivalent_speeds(g, twice_lost)
    DVA, DVB = _velocity_changes(g, found)
    COND = _condition(g, found)
    STATUS = _status(g, p, found, energies, PM, COND)
    (UX, UY, VX, VY), (WA, WB), (gn, gt, _) = g.velocities, g.spins, g.of_contact
    D3, D4, D1, D2 = g.fixed_arms
    critical_numerator, critical_denominator = p.numerators
    return {
        "gn": gn,
        "gt": gt,
        "determinant": found.determinant,
        "PN": found.PN,
        "PT": found.PT,
        "PM": PM,
        "critical_denominator": critical_denominator,
        "VC": -gn,
        "VS": g.E * -gn,
        "VAX": found.VAX,
        "VAY": found.VAY,
        "VBX": found.VBX,
        "VBY": found.VBY,
        "WAF": g.unless_point(found.spin_a, scene["WA"]),
        "WBF": g.unless_point(found.spin_b, scene["WB"]),
        # lines 340, 700 and 710
        "XA": UX + D3 * WA,
        "YA": UY - D4 * WA,
        "XB": VX - D1 * WB,
        "YB": VY + D2 * WB,
        "XAF": XAF,
        "YAF": YAF,
        "XBF": XBF,
        "YBF": YBF,
        "KI": KI,
        "KF": KF,
        "LOSS": (50.0 * twice_lost) / KI,
        "COND": COND,
        "MUP": found.MUP,
        "MUC": critical_numerator / critical_denominator,
        "ELN": -0.5 * crushed,
        "ELT": -0.5 * rubbed,
        "ELM": -0.5 * twisted,
        "EESA": EESA,
        "EESB": EESB,
        "DVA": DVA,
        "DVB": DVB,
        "STATUS": STATUS,
    }
