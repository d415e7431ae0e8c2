# mypy: ignore-errors
# ruff: noqa: F821, F841
"""Trial impulses: what a unit of each does to every velocity, then three equations.

By virtual work the same coefficients make the contact velocities from the velocities: the rows of
a Jacobian matrix.
"""


def statements():
    """Apply unit impulses one by one, and solve for their sizes."""
    nax = c  # normal trial impulse, on A, x
    nay = s  # normal trial impulse, on A, y
    naw = rax * s - ray * c  # normal trial impulse, torque on A
    nbx = -c  # normal trial impulse, on B, x
    nby = -s  # normal trial impulse, on B, y
    nbw = rby * c - rbx * s  # normal trial impulse, torque on B
    tax = -s  # tangential trial impulse, on A, x
    tay = c  # tangential trial impulse, on A, y
    taw = rax * c + ray * s  # tangential trial impulse, torque on A
    tbx = s  # tangential trial impulse, on B, x
    tby = -c  # tangential trial impulse, on B, y
    tbw = -rbx * c - rby * s  # tangential trial impulse, torque on B
    maw = 1  # trial moment, on A
    mbw = -1  # trial moment, on B
    gn = (
        nax * UX + nay * UY + naw * WA + nbx * VX + nby * VY + nbw * WB
    )  # closing velocity at the contact point
    gt = (
        tax * UX + tay * UY + taw * WA + tbx * VX + tby * VY + tbw * WB
    )  # sliding velocity at the contact point
    gw = maw * WA + mbw * WB  # relative spin before
    mu = where(gt > 0, -MU, MU)  # sign rule of MU
    ua = 1 / MA  # inverse mass of A
    ub = 1 / MB  # inverse mass of B
    ja = 1 / ia  # inverse inertia of A
    jb = 1 / ib  # inverse inertia of B
    nn = (
        nax * ua * nax
        + nay * ua * nay
        + naw * ja * naw
        + nbx * ub * nbx
        + nby * ub * nby
        + nbw * jb * nbw
    )  # normal velocity by a normal trial impulse
    nt = (
        nax * ua * tax
        + nay * ua * tay
        + naw * ja * taw
        + nbx * ub * tbx
        + nby * ub * tby
        + nbw * jb * tbw
    )  # normal velocity by a tangential trial impulse
    nm = naw * ja * maw + nbw * jb * mbw  # normal velocity by a trial moment
    tn = (
        tax * ua * nax
        + tay * ua * nay
        + taw * ja * naw
        + tbx * ub * nbx
        + tby * ub * nby
        + tbw * jb * nbw
    )  # tangential velocity by a normal trial impulse
    tt = (
        tax * ua * tax
        + tay * ua * tay
        + taw * ja * taw
        + tbx * ub * tbx
        + tby * ub * tby
        + tbw * jb * tbw
    )  # tangential velocity by a tangential trial impulse
    tm = taw * ja * maw + tbw * jb * mbw  # tangential velocity by a trial moment
    wn = maw * ja * naw + mbw * jb * nbw  # relative spin by a normal trial impulse
    wt = maw * ja * taw + mbw * jb * tbw  # relative spin by a tangential trial impulse
    wm = maw * ja * maw + mbw * jb * mbw  # relative spin by a trial moment
    eq15 = nn * Pn + nt * Pt + nm * Pm + (1 + E) * gn  # restitution, Equation 15
    eq16 = where(pivot, tn * Pn + tt * Pt + tm * Pm + gt, Pt - mu * Pn)  # friction, Equation 16
    eq18 = where(
        point, Pm, (1 - em) * (wn * Pn + wt * Pt + wm * Pm + gw) - em * wm * Pm
    )  # moment equation, Equation 18
    Pn, Pt, Pm = solve(eq15, eq16, eq18)
    VAX = UX + ua * (nax * Pn + tax * Pt)  # final velocity of A, x
    VAY = UY + ua * (nay * Pn + tay * Pt)  # final velocity of A, y
    VBX = VX + ub * (nbx * Pn + tbx * Pt)  # final velocity of B, x
    VBY = VY + ub * (nby * Pn + tby * Pt)  # final velocity of B, y
    WAF = WA + ja * (naw * Pn + taw * Pt + maw * Pm)  # final spin of A
    WBF = WB + jb * (nbw * Pn + tbw * Pt + mbw * Pm)  # final spin of B
