# mypy: ignore-errors
# ruff: noqa: F821, F841
"""Trial impulses: what a unit of each does to the contact velocity, then three equations."""


def statements():
    """Apply unit impulses one by one, and solve for their sizes."""
    gx = UX - WA * ray - (VX - WB * rby)  # contact velocity before, x
    gy = UY + WA * rax - (VY + WB * rbx)  # contact velocity before, y
    gn = gx * c + gy * s  # closing velocity at the contact point
    gt = gy * c - gx * s  # sliding velocity at the contact point
    gw = WA - WB  # relative spin before
    mu = where(gt > 0, -MU, MU)  # sign rule of MU
    jan = (rax * s - ray * c) / ia  # spin of A by a normal trial impulse
    jat = (rax * c + ray * s) / ia  # spin of A by a tangential trial impulse
    jbn = -(rbx * s - rby * c) / ib  # spin of B by a normal trial impulse
    jbt = -(rbx * c + rby * s) / ib  # spin of B by a tangential trial impulse
    fx = c / MA + c / MB - jan * ray + jbn * rby  # velocity by a normal trial impulse, x
    fy = s / MA + s / MB + jan * rax - jbn * rbx  # velocity by a normal trial impulse, y
    hx = -s / MA - s / MB - jat * ray + jbt * rby  # velocity by a tangential trial impulse, x
    hy = c / MA + c / MB + jat * rax - jbt * rbx  # velocity by a tangential trial impulse, y
    qx = -ray / ia - rby / ib  # velocity by a trial moment, x
    qy = rax / ia + rbx / ib  # velocity by a trial moment, y
    nn = fx * c + fy * s  # normal velocity by a normal trial impulse
    nt = hx * c + hy * s  # normal velocity by a tangential trial impulse
    nm = qx * c + qy * s  # normal velocity by a trial moment
    tn = fy * c - fx * s  # tangential velocity by a normal trial impulse
    tt = hy * c - hx * s  # tangential velocity by a tangential trial impulse
    tm = qy * c - qx * s  # tangential velocity by a trial moment
    wn = jan - jbn  # relative spin by a normal trial impulse
    wt = jat - jbt  # relative spin by a tangential trial impulse
    wm = 1 / ia + 1 / ib  # relative spin by a trial moment
    eq15 = nn * Pn + nt * Pt + nm * Pm + (1 + E) * gn  # restitution, Equation 15
    eq16 = where(pivot, tn * Pn + tt * Pt + tm * Pm + gt, Pt - mu * Pn)  # friction, Equation 16
    eq18 = where(
        point, Pm, (1 - em) * (wn * Pn + wt * Pt + wm * Pm + gw) - em * wm * Pm
    )  # moment equation, Equation 18
    Pn, Pt, Pm = solve(eq15, eq16, eq18)
    VAX = UX + (Pn * c - Pt * s) / MA  # final velocity of A, x
    VAY = UY + (Pn * s + Pt * c) / MA  # final velocity of A, y
    VBX = VX - (Pn * c - Pt * s) / MB  # final velocity of B, x
    VBY = VY - (Pn * s + Pt * c) / MB  # final velocity of B, y
    WAF = WA + jan * Pn + jat * Pt + Pm / ia  # final spin of A
    WBF = WB + jbn * Pn + jbt * Pt - Pm / ib  # final spin of B
