"""Further quantities of an impact: speeds, courses, directions of the force; and
results that follow from others where the scene is not known as a whole.

Functions have the form of those in `formulas`: parameters and returned names are the data flow.
Only numpy runs them, because sizes and directions need hypot and arctan2. `plan` takes a quantity
from here where `formulas` does not give it, or needs what is not known.
"""

import numpy as np
from numpy import arctan2, ceil, degrees, hypot, where

from ..names import PIVOT
from .formulas import sine_and_cosine

REST_TOLERANCE = 1e-9
"""A body whose final speed is below this fraction of its initial one is at rest: that much of the
difference of two velocities is rounding."""


# -- sizes and directions


def speeds_before(UX, UY, VX, VY):
    """Return the initial speeds."""
    SA, SB = hypot(UX, UY), hypot(VX, VY)
    return SA, SB


def speeds_after(VAX, VAY, VBX, VBY):
    """Return the final speeds."""
    SAF, SBF = hypot(VAX, VAY), hypot(VBX, VBY)
    return SAF, SBF


def course_before_a(UX, UY):
    """Return the course of A before the impact, NaN at rest."""
    HA = _direction(UX, UY)
    return (HA,)


def course_before_b(VX, VY):
    """Return the course of B before the impact, NaN at rest."""
    HB = _direction(VX, VY)
    return (HB,)


def course_after_a(VAX, VAY, SA, SAF):
    """Return the course of A after the impact, NaN at rest."""
    HAF = where(SAF <= REST_TOLERANCE * SA, np.nan, _direction(VAX, VAY))
    return (HAF,)


def course_after_b(VBX, VBY, SB, SBF):
    """Return the course of B after the impact, NaN at rest."""
    HBF = where(SBF <= REST_TOLERANCE * SB, np.nan, _direction(VBX, VBY))
    return (HBF,)


def changes_along_a(ax, ay, TA):
    """Return A's velocity change forward and to its right; A's front is opposite to TA."""
    sine, cosine = sine_and_cosine(TA + 180.0)
    DVAF, DVAR = ax * cosine + ay * sine, ax * sine - ay * cosine
    return DVAF, DVAR


def changes_along_b(bx, by, TB):
    """Return B's velocity change forward and to its right."""
    sine, cosine = sine_and_cosine(TB)
    DVBF, DVBR = -(bx * cosine + by * sine), by * cosine - bx * sine
    return DVBF, DVBR


def force_on_a(ax, ay, TA):
    """Return where the force on A comes from, clockwise from its front."""
    PDOFA = _clockwise(TA + 180.0, ax, ay)
    return (PDOFA,)


def force_on_b(bx, by, TB):
    """Return where the force on B comes from, clockwise from its front."""
    PDOFB = _clockwise(TB, -bx, -by)
    return (PDOFB,)


def size_of_impulse(PN, PT):
    """Return the size of the impulse."""
    P = hypot(PN, PT)
    return (P,)


def fraction_lost(EL, KI):
    """Return the energy lost as a fraction of the energy before."""
    DT = EL / KI
    return (DT,)


def contact_point(D1, D2, D3, D4):
    """Return the contact point from the centers of gravity."""
    CAX, CAY, CBX, CBY = -D4, -D3, D2, D1
    return CAX, CAY, CBX, CBY


def spin_ratio(EM):
    """Return the final over the initial relative spin that the moment alone makes (Equation 18 with
    no impulse): 1 at EM = 1, 0 at 0, a third at -1."""
    RR0 = -EM / (1.0 - 2.0 * EM)
    return (RR0,)


# -- from velocities and impulses that are known


def change_of_a(UX, UY, VAX, VAY):
    """Return A's velocity change."""
    ax, ay = VAX - UX, VAY - UY
    return ax, ay


def change_of_b(VX, VY, VBX, VBY):
    """Return B's velocity change, reversed as its impulse is."""
    bx, by = VX - VBX, VY - VBY
    return bx, by


def impulse_on_a(MA, ax, ay, s, c):
    """Return the impulse from A's velocity change."""
    PN, PT = MA * (c * ax + s * ay), MA * (c * ay - s * ax)
    return PN, PT


def impulse_on_b(MB, bx, by, s, c):
    """Return the impulse from B's velocity change."""
    PN, PT = MB * (c * bx + s * by), MB * (c * by - s * bx)
    return PN, PT


def moment_on_a(IA, WA, WAF, an, at, PN, PT):
    """Return the moment impulse from A's change of spin (Equation 17)."""
    PM = IA * (WAF - WA) - (an * PN + at * PT)
    return (PM,)


def energy_difference(KI, KF):
    """Return the energy lost; a small loss has few digits."""
    EL = KI - KF
    return (EL,)


def normal_separation(s, c, VAX, VAY, VBX, VBY, an, bn, waf, wbf):
    """Return the separation speed from the final velocities."""
    VS = c * (VAX - VBX) + s * (VAY - VBY) + (an * waf + bn * wbf)
    return (VS,)


def restitution(VC, VS):
    """Return E from the closing and the separation speed (Equation 15)."""
    E = VS / VC
    return (E,)


def impulse_ratio(PN, PT):
    """Return the signed friction (Equation 16)."""
    MUP = PT / PN
    return (MUP,)


def typed_friction(MUP, gt):
    """Return the MU of which line 400 makes a signed friction."""
    MU = where((gt > 0.0) & (MUP != PIVOT), -MUP, MUP)
    return (MU,)


def moment_restitution(PM, waf, wbf, ia, ib):
    """Return EM from the moment impulse and the final relative spin (Equation 18)."""
    EM = (waf - wbf) / ((waf - wbf) + PM * (ia + ib))
    return (EM,)


def _direction(x, y):
    """Return the direction of (x, y) from the x axis in degrees, NaN for (0, 0)."""
    return where((x == 0.0) & (y == 0.0), np.nan, degrees(arctan2(y, x)))


def _clockwise(front, x, y):
    """Return where a force along (x, y) comes from, in degrees clockwise from a front: above -180
    and up to 180, NaN without force."""
    angle = front + 180.0 - _direction(x, y)
    return angle - 360.0 * ceil((angle - 180.0) / 360.0)
