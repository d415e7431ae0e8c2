# mypy: ignore-errors
# ruff: noqa: F821, F841
"""The impulse by effective masses: restitution and friction at the contact point."""


def statements():
    """Compute the impulse, and the final velocities from it."""
    nx = c  # normal axis, x
    ny = s  # normal axis, y
    tx = -s  # tangential axis, x
    ty = c  # tangential axis, y
    an = rax * ny - ray * nx  # lever arm of A about the normal
    at = rax * ty - ray * tx  # lever arm of A about the tangent
    bn = rbx * ny - rby * nx  # lever arm of B about the normal
    bt = rbx * ty - rby * tx  # lever arm of B about the tangent
    gx = UX - WA * ray - (VX - WB * rby)  # contact velocity before, x
    gy = UY + WA * rax - (VY + WB * rbx)  # contact velocity before, y
    gn = gx * nx + gy * ny  # closing velocity at the contact point
    gt = gx * tx + gy * ty  # sliding velocity at the contact point
    gw = WA - WB  # relative spin before
    slide = gx * tx + gy * ty  # sliding velocity in the sign rule of MU
    mu = where(slide > 0, -MU, MU)  # sign rule of MU
    wan = an / ia  # spin of A by a unit normal impulse
    wat = at / ia  # spin of A by a unit tangential impulse
    wbn = bn / ib  # spin of B by a unit normal impulse
    wbt = bt / ib  # spin of B by a unit tangential impulse
    hn = wan + wbn  # moment equation: relative spin by a unit normal impulse
    ht = wat + wbt  # moment equation: relative spin by a unit tangential impulse
    m = 1 / (1 / MA + 1 / MB)  # reduced mass
    ir = 1 / (1 / ia + 1 / ib)  # reduced inertia
    k = (1 - em) / (1 - 2 * em)  # moment equation: moment coefficient
    kn = an / ia + bn / ib  # normal velocity by a unit moment
    kt = at / ia + bt / ib  # tangential velocity by a unit moment
    un = 1 / m + an * wan + bn * wbn  # effective mass without moment, normal
    unt = an * wat + bn * wbt  # effective mass without moment, coupling in the normal equation
    utn = at * wan + bt * wbn  # effective mass without moment, coupling in the tangential equation
    ut = 1 / m + at * wat + bt * wbt  # effective mass without moment, tangential
    knn = un - k * ir * kn * hn  # effective mass, normal
    knt = unt - k * ir * kn * ht  # effective mass, coupling in the normal equation
    ktn = utn - k * ir * kt * hn  # effective mass, coupling in the tangential equation
    ktt = ut - k * ir * kt * ht  # effective mass, tangential
    rn = -(1 + E) * gn + k * ir * kn * gw  # restitution: normal velocity to be gained
    rt = -gt + k * ir * kt * gw  # the pivot: tangential velocity to be gained
    det = knn * ktt - knt * ktn  # determinant of the pivot's equations
    pnp = (rn * ktt - rt * knt) / det  # normal impulse of the pivot
    ptp = (rt * knn - rn * ktn) / det  # tangential impulse of the pivot
    muc = ptp / pnp  # critical friction coefficient
    pnf = rn / (knn + mu * knt)  # normal impulse with friction
    stick = pivot  # scenes without sliding at separation
    Pn = where(stick, pnp, pnf)  # normal impulse
    Pt = where(stick, ptp, mu * Pn)  # tangential impulse
    Pm = where(point, 0, -k * ir * (gw + hn * Pn + ht * Pt))  # moment equation: moment
    Px = Pn * nx + Pt * tx  # impulse, x
    Py = Pn * ny + Pt * ty  # impulse, y
    VAX = UX + Px / MA  # final velocity of A, x
    VAY = UY + Py / MA  # final velocity of A, y
    VBX = VX - Px / MB  # final velocity of B, x
    VBY = VY - Py / MB  # final velocity of B, y
    WAF = WA + wan * Pn + wat * Pt + Pm / ia  # final spin of A
    WBF = WB - wbn * Pn - wbt * Pt - Pm / ib  # final spin of B
