"""The planar impact in closed form: Equations 13 to 18 solved once and for all.

Written in inverse masses and inertias, so that a rigid barrier (a body that cannot be moved) is
the number 0 and nothing special. A spin is taken as the mean spin, (Ia omega_a + Ib omega_b)/(Ia +
Ib), and what is left of the difference. The unknowns are the impulse (Pn, Pt) on A and H, Ired
times the final spins' difference (J = 1/(Ia + Ib), Ired = Ia·Ib/(Ia + Ib))::

    Omega_a = mean + J sigma·P + H/Ia        Omega_b = mean + J sigma·P - H/Ib

With gn° and gt° the relative contact velocities that both bodies would have at the mean spin,
Q_ij = R delta_ij + J sigma_i sigma_j and kappa_i = a_i/Ia - b_i/Ib, the restitution equation (15),
no slip at separation (listing lines 430-440) and the moment equation (18), *multiplied through by
1 - 2 em*, read::

    Q_nn Pn + Q_nt Pt + kappa_n H  = -(e gn + gn°)
    Q_nt Pn + Q_tt Pt + kappa_t H  = -gt°                                    (pivot only)
    em Ired kappa·P + (1 - 2 em) H = -em Ired (omega_a - omega_b)

Friction has Pt = mu Pn for the middle line. Every unknown is found by Cramer's rule with the factor
1 - 2 em cancelled: no term becomes infinite at em = 1/2, and for -1 <= em <= 0 the pivot's
determinant is a sum of terms of one sign. None is found from another, nor from both spins apart:
where an arm is far longer than a radius of gyration, or one body far lighter than the other, such
differences would lose their digits. H has the factor em, so that at em = 0 the final spins are the
same bits, and the moment impulse is (1 - em) H/em by Equation 18.

Axes: n = (cos GA, sin GA), t = (-sin GA, cos GA), A on the +n side; P acts on A, -P on B. Every
quantity below is an `Expression`; its formula is made when first asked for, so that what no wanted
result needs is never computed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property

from ..names import PIVOT
from .energy import kinetic_energy
from .formulas import Expression, ExpressionTable
from .statusbits import findings

Pair = tuple[Expression, Expression]


class Impact:
    """The quantities of an impact, given the expressions of a scene's columns.

    ``pivot``: True when MU = -10 throughout, False when nowhere, else the condition where it is.
    ``point``: the same for M = 4. ``sign``: what MU is multiplied with instead of the sign rule.
    """

    def __init__(
        self,
        table: ExpressionTable,
        scene: Mapping[str, Expression],
        pivot: bool | Expression,
        point: bool | Expression,
        infinite: bool,
        sign: float | None = None,
    ) -> None:
        self.table = table
        self.scene = scene
        self.pivot = pivot
        self.point = point
        self.infinite = infinite
        self.sign = sign
        self.GA, self.E, self.MU = scene["GA"], scene["E"], scene["MU"]
        self.UX, self.UY, self.VX, self.VY = (scene[name] for name in ("UX", "UY", "VX", "VY"))
        self.MA, self.MB = scene["MA"], scene["MB"]
        # a point mass has neither arm nor spin, whatever its columns hold
        self.EM, self.WA, self.WB = (self._unless_point(scene[x]) for x in ("EM", "WA", "WB"))
        self.DA, self.DB = self._unless_point(scene["DA"]), self._unless_point(scene["DB"])
        self.IA, self.IB = (self._unless_point(scene[x], 1.0) for x in ("IA", "IB"))

    def _unless_point(self, value: Expression, instead: float = 0.0) -> Expression:
        if self.point is False:
            return value
        if self.point is True:
            return self.table.constant(instead)
        return self.table.choose(self.point, self.table.constant(instead), value)

    def _by_kind(
        self, friction: Callable[[], Expression], pivot: Callable[[], Expression]
    ) -> Expression:
        if self.pivot is False:
            return friction()
        if self.pivot is True:
            return pivot()
        return self.table.choose(self.pivot, pivot(), friction())

    # -- geometry

    @cached_property
    def _n(self) -> Pair:
        s, c = self.table.sine_and_cosine(self.GA)
        return c, s

    def _arms(self, d: str, phi: str, theta: str) -> Pair:
        """(an, at): what a spin adds to the normal and tangential contact velocity of A, or the
        same of B with the sign that the *relative* velocity a - b takes."""
        distance = self.DA if d == "DA" else self.DB
        if distance.is_zero:
            return distance, distance
        s, c = self.table.sine_and_cosine(self.scene[theta] + self.scene[phi] - self.GA)
        return distance * s, -(distance * c)

    @cached_property
    def _a(self) -> Pair:
        return self._arms("DA", "PA", "TA")

    @cached_property
    def _b(self) -> Pair:
        return self._arms("DB", "PB", "TB")

    def _listing_arms(self, d: str, phi: str, theta: str) -> Pair:
        """Line 330: D3 and D4 of A, D1 and D2 of B."""
        distance = self.DA if d == "DA" else self.DB
        if distance.is_zero:
            return distance, distance
        s, c = self.table.sine_and_cosine(self.scene[theta] + self.scene[phi])
        return distance * s, distance * c

    @cached_property
    def _D3_D4(self) -> Pair:
        return self._listing_arms("DA", "PA", "TA")

    @cached_property
    def _D1_D2(self) -> Pair:
        return self._listing_arms("DB", "PB", "TB")

    # -- inertia

    @cached_property
    def _ma(self) -> Expression:
        return 1.0 / self.MA

    @cached_property
    def _mb(self) -> Expression:
        return 1.0 / self.MB

    @cached_property
    def _ia(self) -> Expression:
        return 1.0 / self.IA

    @cached_property
    def _ib(self) -> Expression:
        return 1.0 / self.IB

    @cached_property
    def R(self) -> Expression:
        return self._ma + self._mb

    @cached_property
    def Ired(self) -> Expression:
        return 1.0 / self._spins

    @cached_property
    def _spins(self) -> Expression:
        return self._ia + self._ib

    @cached_property
    def _share_b(self) -> Expression:
        """Ia/(Ia + Ib): the weight of A's spin in the mean, B's part of a difference of spins."""
        return self._ib * self.Ired

    @cached_property
    def J(self) -> Expression:
        """1/(Ia + Ib), in an order that the largest inertias survive."""
        return self._ia * self._share_b

    # -- relative velocity before impact

    @cached_property
    def _approach(self) -> Pair:
        return self.UX - self.VX, self.UY - self.VY

    @cached_property
    def _closing(self) -> Pair:
        """The relative velocity of the mass centers along n and t."""
        (c, s), (dx, dy) = self._n, self._approach
        return c * dx + s * dy, c * dy - s * dx

    def _with_spins(self, i: int) -> Expression:
        return self._closing[i] + self._a[i] * self.WA + self._b[i] * self.WB

    @cached_property
    def gn(self) -> Expression:
        return self._with_spins(0)

    @cached_property
    def gt(self) -> Expression:
        return self._with_spins(1)

    @cached_property
    def _mean_spin(self) -> Expression:
        return self._share_b * self.WA + (self._ia * self.Ired) * self.WB

    def _with_mean_spin(self, i: int) -> Expression:
        return self._closing[i] + self.sigma[i] * self._mean_spin

    @cached_property
    def _gt_mean(self) -> Expression:
        """gt°."""
        return self._with_mean_spin(1)

    @cached_property
    def gw(self) -> Expression:
        return self.WA - self.WB

    # -- coefficients

    @cached_property
    def mu(self) -> Expression:
        """MU after the sign rule of line 400: changed where gt > 0, kept on a tie."""
        if self.sign is None:
            return self.table.against(self.MU, self.gt)
        return self.sign * self.MU

    @cached_property
    def z(self) -> Expression:
        return 1.0 - (self.EM + self.EM)

    @cached_property
    def v(self) -> Expression:
        """e gn + gn°: what the normal impulse has to undo."""
        return self.E * self.gn + self._with_mean_spin(0)

    @cached_property
    def _turn(self) -> Expression:
        """Ired (omega_a - omega_b)."""
        return self.Ired * self.gw

    @cached_property
    def sigma(self) -> Pair:
        return self._a[0] + self._b[0], self._a[1] + self._b[1]

    @cached_property
    def kappa(self) -> Pair:
        return self._kappa(0), self._kappa(1)

    def _kappa(self, i: int) -> Expression:
        return self._a[i] * self._ia - self._b[i] * self._ib

    # -- friction: everything along the direction (1, mu) of the impulse

    @cached_property
    def _along_impulse(self) -> Pair:
        """sigma and kappa in the direction (1, mu)."""
        a = self._a[0] + self.mu * self._a[1]
        b = self._b[0] + self.mu * self._b[1]
        return a + b, a * self._ia - b * self._ib

    @cached_property
    def _J_sigma_mu(self) -> Expression:
        return self.J * self._along_impulse[0]

    @cached_property
    def _friction(self) -> tuple[Expression, Expression, Expression]:
        """Q, Ired kappa in the direction (1, mu), and D, of the 2x2 system left when Pt = mu Pn."""
        Q = self.R + self._J_sigma_mu * (self._a[0] + self._b[0])
        turn = self.Ired * self._along_impulse[1]
        return Q, turn, self.z * Q - self.EM * (turn * self._kappa(0))

    @cached_property
    def _friction_Pn(self) -> Expression:
        spin = self.EM * (self._kappa(0) * self._turn)
        return (spin - self.z * self.v) / self._friction[2]

    # -- pivot; with s' = (sigma_t, -sigma_n), adj(Q) x = R x + J s' (s'·x), all divided by R

    @cached_property
    def _arms_cross(self) -> Expression:
        """an bt - at bn = Ired sigma x kappa, without the difference of products whose digits are
        lost in kappa already."""
        (an, at), (bn, bt) = self._a, self._b
        return an * bt - at * bn

    @cached_property
    def _R_inverse(self) -> Expression:
        return 1.0 / self.R

    @cached_property
    def _JR(self) -> Expression:
        return self.J * self._R_inverse

    @cached_property
    def _RQ(self) -> Expression:
        """det Q / R."""
        sn, st = self.sigma
        return self.R + self.J * (sn * sn + st * st)

    @cached_property
    def _Ired_kappa(self) -> Pair:
        return self.Ired * self.kappa[0], self.Ired * self.kappa[1]

    @cached_property
    def _s_r(self) -> Expression:
        """s'·r, with r = -(v, gt°) the right-hand sides."""
        sn, st = self.sigma
        return sn * self._gt_mean - st * self.v

    @cached_property
    def _moment_turned(self) -> Expression:
        """em kappa_perp·r / R, with kappa_perp = (-kappa_t, kappa_n)."""
        kn, kt = self.kappa
        return self.EM * ((kt * self.v - kn * self._gt_mean) * self._R_inverse)

    @cached_property
    def _pivot_determinant(self) -> Expression:
        """The determinant of the three equations, divided by R: z det Q - em Ired kappa·adj
        Q·kappa, each a sum of squares, without cancellation however slight R is."""
        (kn, kt), (tn, tt) = self.kappa, self._Ired_kappa
        crossed = self._JR * self._arms_cross * (self._spins * self._arms_cross)
        return self.z * self._RQ - self.EM * (tn * kn + tt * kt + crossed)

    @cached_property
    def _pivot_numerators(self) -> Pair:
        """The impulse times the determinant: [z adj(Q) r + em Ired ((omega_a - omega_b) adj(Q)
        kappa - kappa_perp (kappa_perp·r))] / R."""
        (sn, st), (kn, kt), (tn, tt) = self.sigma, self.kappa, self._Ired_kappa
        turn = self.EM * self._turn
        along = self._JR * (self.z * self._s_r + self.EM * self.gw * self._arms_cross)
        normal = turn * kn - self.z * self.v + st * along + tt * self._moment_turned
        tangential = turn * kt - self.z * self._gt_mean - sn * along - tn * self._moment_turned
        return normal, tangential

    @cached_property
    def _pivot_sigma_P(self) -> Expression:
        """sigma·P, from which adj(Q) drops out: a slight R turns P nearly across sigma."""
        (sn, st), (kn, kt) = self.sigma, self.kappa
        turned = self.EM * self._turn * (sn * kn + st * kt)
        pushed = sn * (self.z * self.v) + st * (self.z * self._gt_mean)
        terms = turned - pushed - self._arms_cross * self._moment_turned
        return terms / self._pivot_determinant

    @cached_property
    def _pivot(self) -> Pair:
        """(Pn, Pt) for no tangential relative velocity at separation."""
        normal, tangential = self._pivot_numerators
        return normal / self._pivot_determinant, tangential / self._pivot_determinant

    # -- denominators, for whoever has to know where results are infinite

    @cached_property
    def determinant(self) -> Expression:
        """What divides every impulse: where it is zero, the equations have no solution."""
        return self._by_kind(lambda: self._friction[2], lambda: self._pivot_determinant)

    @cached_property
    def critical_denominator(self) -> Expression:
        """What divides MUC."""
        return self._pivot_numerators[0]

    # -- impulse

    @cached_property
    def PN(self) -> Expression:
        return self._by_kind(lambda: self._friction_Pn, lambda: self._pivot[0])

    @cached_property
    def PT(self) -> Expression:
        return self._by_kind(lambda: self.mu * self._friction_Pn, lambda: self._pivot[1])

    @cached_property
    def _common_spin(self) -> Expression:
        """J sigma·P: what the impulse adds to both spins alike."""

        def friction() -> Expression:
            return self._J_sigma_mu * self._friction_Pn

        def pivot() -> Expression:
            return self.J * self._pivot_sigma_P

        return self._by_kind(friction, pivot)

    @cached_property
    def _moment(self) -> Expression:
        """H/em = PM/(1 - em), by Cramer's rule."""

        def friction() -> Expression:
            Q, turn, D = self._friction
            return (turn * self.v - self._turn * Q) / D

        def pivot() -> Expression:
            tn, tt = self._Ired_kappa
            crossed = self._JR * self._arms_cross * self._s_r
            pushed = tn * self.v + tt * self._gt_mean - crossed
            return (pushed - self._turn * self._RQ) / self._pivot_determinant

        return self._unless_point(self._by_kind(friction, pivot))

    @cached_property
    def H(self) -> Expression:
        """Ired times the final spins' difference."""
        return self.EM * self._moment

    @cached_property
    def PM(self) -> Expression:
        """The moment impulse on A (0 at em = 1)."""
        return (1.0 - self.EM) * self._moment

    @cached_property
    def _Px(self) -> Expression:
        c, s = self._n
        return c * self.PN - s * self.PT

    @cached_property
    def _Py(self) -> Expression:
        c, s = self._n
        return s * self.PN + c * self.PT

    # -- after impact

    @cached_property
    def VAX(self) -> Expression:
        return self.UX + self._ma * self._Px

    @cached_property
    def VAY(self) -> Expression:
        return self.UY + self._ma * self._Py

    @cached_property
    def VBX(self) -> Expression:
        return self.VX - self._mb * self._Px

    @cached_property
    def VBY(self) -> Expression:
        return self.VY - self._mb * self._Py

    @cached_property
    def WAF(self) -> Expression:
        return self._pass_through("WA", self._spin_a)

    @cached_property
    def WBF(self) -> Expression:
        return self._pass_through("WB", self._spin_b)

    @cached_property
    def _final_mean(self) -> Expression:
        return self._mean_spin + self._common_spin

    @cached_property
    def _spin_a(self) -> Expression:
        return self._final_mean + self._ia * self.H

    @cached_property
    def _spin_b(self) -> Expression:
        return self._final_mean - self._ib * self.H

    def _pass_through(self, name: str, spin: Expression) -> Expression:
        if self.point is False:
            return spin
        if self.point is True:
            return self.scene[name]
        return self.table.choose(self.point, self.scene[name], spin)

    # -- contact velocities, lines 340, 700 and 710

    @cached_property
    def XA(self) -> Expression:
        return self.UX + self._D3_D4[0] * self.WA

    @cached_property
    def YA(self) -> Expression:
        return self.UY - self._D3_D4[1] * self.WA

    @cached_property
    def XB(self) -> Expression:
        return self.VX - self._D1_D2[0] * self.WB

    @cached_property
    def YB(self) -> Expression:
        return self.VY + self._D1_D2[1] * self.WB

    @cached_property
    def XAF(self) -> Expression:
        return self.VAX + self._D3_D4[0] * self._spin_a

    @cached_property
    def YAF(self) -> Expression:
        return self.VAY - self._D3_D4[1] * self._spin_a

    @cached_property
    def XBF(self) -> Expression:
        return self.VBX - self._D1_D2[0] * self._spin_b

    @cached_property
    def YBF(self) -> Expression:
        return self.VBY + self._D1_D2[1] * self._spin_b

    # -- energy

    def _finite(self, inertia: Expression) -> Expression:
        """An infinite body is at rest and adds no energy."""
        if inertia.is_constant(math.inf):
            return self.table.constant(0.0)
        if not self.infinite:
            return inertia
        return self.table.choose(
            self.table.equals(inertia, math.inf), self.table.constant(0.0), inertia
        )

    def _energy(self, velocities: Sequence[Expression]) -> Expression:
        """Of the velocities in the listing's order; a point mass's spins are 0 here."""
        inertias = [self._finite(x) for x in (self.MA, self.MB, self.IA, self.IB)]
        energy: Expression = kinetic_energy(inertias, velocities)
        return energy

    @cached_property
    def KI(self) -> Expression:
        return self._energy((self.UX, self.UY, self.WA, self.VX, self.VY, self.WB))

    @cached_property
    def KF(self) -> Expression:
        wa, wb = (self._unless_point(spin) for spin in (self._spin_a, self._spin_b))
        return self._energy((self.VAX, self.VAY, wa, self.VBX, self.VBY, wb))

    @cached_property
    def Gt(self) -> Expression:
        """Tangential relative velocity at separation; 0 for a pivot, by its definition."""

        def friction() -> Expression:
            return (
                self._gt_mean
                + self.R * self.PT
                + self.sigma[1] * self._common_spin
                + self.kappa[1] * self.H
            )

        return self._by_kind(friction, lambda: self.table.constant(0.0))

    @cached_property
    def _lost(self) -> Expression:
        """Twice the energy lost: the work of P and M at the mean relative velocities, negated.

        KI - KF would lose digits when little is lost; this does not.
        """
        normal = ((1.0 - self.E) * self.gn) * self.PN
        sliding = self.PT * (self.gt + self.Gt)
        turning = self.PM * (self.gw + self._spins * self.H)
        return -(normal + sliding + turning)

    @cached_property
    def LOSS(self) -> Expression:
        return (50.0 * self._lost) / self.KI

    # -- sizes and coefficients of the result

    @cached_property
    def _P(self) -> Expression:
        return self.table.hypotenuse(self.PN, self.PT)

    @cached_property
    def DVA(self) -> Expression:
        return self._ma * self._P

    @cached_property
    def DVB(self) -> Expression:
        return self._mb * self._P

    @cached_property
    def MUP(self) -> Expression:
        return self._by_kind(lambda: self.mu, lambda: self.table.constant(PIVOT))

    @cached_property
    def MUC(self) -> Expression:
        normal, tangential = self._pivot_numerators
        return tangential / normal

    # -- how far the result can be trusted

    @cached_property
    def COND(self) -> Expression:
        """An estimate of the condition number of the 6x6 equations, rows and columns scaled best.

        The determinant with every sum in it replaced by the sum of the absolute values, divided by
        the determinant, times 3: the typical ratio to Bauer's number, the spectral radius of
        |A^-1||A|. Measured over the benchmark's populations: within a factor 5 of it for 98 % of
        the scenes of each, and within 50 always.
        """
        absolute = self.table.absolute
        an, at, bn, bt = (absolute(arm) for arm in (*self._a, *self._b))
        sn, st = an + bn, at + bt
        kn, kt = an * self._ia + bn * self._ib, at * self._ia + bt * self._ib

        def friction() -> Expression:
            mu = absolute(self.mu)
            straight = self.R * (1.0 + mu) + self.J * (sn * (sn + mu * st))
            moment = absolute(self.EM) * (self.Ired * (kn * (kn + mu * kt)))
            return (absolute(self.z) * straight + moment) / absolute(self._friction[2])

        def pivot() -> Expression:
            crossed = self._spins * (an * bt + at * bn)
            moment = self.Ired * (kn * kn + kt * kt)
            moment = moment + absolute(self._JR * self._arms_cross) * crossed
            terms = absolute(self.z) * self._RQ + absolute(self.EM) * moment
            return terms / absolute(self._pivot_determinant)

        return 3.0 * self._by_kind(friction, pivot)

    @cached_property
    def STATUS(self) -> Expression:
        zero = self.table.constant(0.0)
        velocities = self.VAX + self.VAY + self.VBX + self.VBY + self.WAF + self.WBF
        found = findings(
            self.gn,
            self.PN,
            self._a[1],
            self._b[1],
            self.DA,
            self.DB,
            self._lost,
            self.KI,
            self.E,
            self.EM,
            self._by_kind(lambda: self.mu, lambda: zero),
            *self._pivot,
            self.COND,
            velocities,
        )
        bits = [condition * float(bit) for bit, condition in found.items()]
        return self.table.bits(sum(bits[1:], bits[0]))
