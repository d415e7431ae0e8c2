"""Further quantities of an impact: speeds, courses, directions of the force; and
results that follow from others where the scene is not known as a whole.

Functions have the form of those in `formulas`: parameters and returned names are the data flow.
Only numpy runs them, because sizes and directions need hypot and arctan2. `plan` takes a quantity
from here where `formulas` does not give it, or needs what is not known.
"""

import numpy as np
from numpy import arctan2, ceil, degrees, hypot, where

from .formulas import cross, dot, signed_friction, sine_and_cosine

REST_TOLERANCE = 1e-9
"""A body whose final speed is below this fraction of its initial one is at rest: that much of the
difference of two velocities is rounding."""


# -- sizes and directions


def speed(UX, UY):
    """Return the speed."""
    SA = hypot(UX, UY)
    return (SA,)


def course(UX, UY):
    """Return the course before the impact, NaN at rest."""
    HA = _direction(UX, UY)
    return (HA,)


def course_after_impact(VAX, VAY, SA, SAF):
    """Return the course after the impact, NaN at rest."""
    HAF = where(SAF <= REST_TOLERANCE * SA, np.nan, _direction(VAX, VAY))
    return (HAF,)


def front_of_a(TA):
    """Return the direction of A's front, which is opposite to TA."""
    front_a = TA + 180.0
    return (front_a,)


def changes_along_vehicle(ax, ay, front_a):
    """Return the velocity change forward and to the vehicle's right."""
    sine, cosine = sine_and_cosine(front_a)
    DVAF, DVAR = dot(ax, ay, cosine, sine), cross(ax, ay, cosine, sine)
    return DVAF, DVAR


def force_direction(ax, ay, front_a):
    """Return where the force comes from, in degrees clockwise from the front: above -180 and up to
    180, NaN without force."""
    angle = front_a + 180.0 - _direction(ax, ay)
    PDOFA = angle - 360.0 * ceil((angle - 180.0) / 360.0)
    return (PDOFA,)


def size_of_impulse(PN, PT):
    """Return the size of the impulse."""
    P = hypot(PN, PT)
    return (P,)


def fraction_lost(EL, KI):
    """Return the energy lost as a fraction of the energy before."""
    DT = EL / KI
    return (DT,)


def spin_ratio(EM):
    """Return the final over the initial relative spin that the moment alone makes (Equation 18 with
    no impulse): 1 at EM = 1, 0 at 0, a third at -1."""
    RR0 = -EM / (1.0 - 2.0 * EM)
    return (RR0,)


# -- from velocities and impulses that are known


def velocity_change(UX, UY, VAX, VAY):
    """Return the velocity change."""
    ax, ay = VAX - UX, VAY - UY
    return ax, ay


def impulse_on_a(MA, ax, ay, s, c):
    """Return the impulse from A's velocity change."""
    PN, PT = MA * dot(c, s, ax, ay), MA * cross(c, s, ax, ay)
    return PN, PT


def impulse_on_b(MB, bx, by, s, c):
    """Return the impulse from B's velocity change, to which it is opposite."""
    PN, PT = -MB * dot(c, s, bx, by), -MB * cross(c, s, bx, by)
    return PN, PT


def moment_on_a(IA, WA, WAF, an, at, PN, PT):
    """Return the moment impulse from A's change of spin (Equation 17)."""
    PM = IA * (WAF - WA) - dot(an, at, PN, PT)
    return (PM,)


def energy_difference(KI, KF):
    """Return the energy lost; a small loss has few digits."""
    EL = KI - KF
    return (EL,)


def measured_separation(gn_after):
    """Return the separation speed from the final velocities."""
    VS = gn_after
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
    """Return the MU of which line 400 makes a signed friction: it would make MU of that again."""
    (MU,) = signed_friction(MUP, gt)
    return (MU,)


def moment_restitution(PM, waf, wbf, ia, ib):
    """Return EM from the moment impulse and the final relative spin (Equation 18)."""
    EM = (waf - wbf) / ((waf - wbf) + PM * (ia + ib))
    return (EM,)


def _direction(x, y):
    """Return the direction of (x, y) from the x axis in degrees, NaN for (0, 0)."""
    return where((x == 0.0) & (y == 0.0), np.nan, degrees(arctan2(y, x)))
