# mypy: ignore-errors
# ruff: noqa: F821, F841
"""The impulse ratio: one impulse in a known direction, with radii of gyration in the factor."""


def statements():
    """Find the ratio of the impulses first, then the normal impulse along with it."""
    ax = da * cos(ta + pa)  # lever arm of A, x
    ay = da * sin(ta + pa)  # lever arm of A, y
    bx = db * cos(tb + pb)  # lever arm of B, x
    by = db * sin(tb + pb)  # lever arm of B, y
    an = ay * c - ax * s  # lever arm of A about the normal
    at = ax * c + ay * s  # lever arm of A about the tangent
    bn = by * c - bx * s  # lever arm of B about the normal
    bt = bx * c + by * s  # lever arm of B about the tangent
    dx = UX - VX  # relative velocity of the mass centres, x
    dy = UY - VY  # relative velocity of the mass centres, y
    gn = dx * c + dy * s + an * WA + bn * WB  # closing velocity at the contact point
    gt = dy * c - dx * s - at * WA - bt * WB  # sliding velocity at the contact point
    mu = where(gt > 0, -MU, MU)  # sign rule of MU
    m = MA * MB / (MA + MB)  # reduced mass
    z = (1 - em) * ia * ib / ((ia + ib) * (1 - 2 * em))  # moment equation: moment coefficient
    hn = an / ia - bn / ib  # moment equation: relative spin by a unit normal impulse
    ht = bt / ib - at / ia  # moment equation: relative spin by a unit tangential impulse
    rn = z * hn * (WA - WB) - (1 + E) * gn  # restitution: normal velocity to be gained
    rt = z * ht * (WA - WB) - gt  # the pivot: tangential velocity to be gained
    knn = 1 / m + an * an / ia + bn * bn / ib - z * hn * hn  # effective mass, normal
    knt = -(an * at / ia + bn * bt / ib + z * hn * ht)  # effective mass, coupling
    ktt = 1 / m + at * at / ia + bt * bt / ib - z * ht * ht  # effective mass, tangential
    ratio = where(pivot, (rt * knn - rn * knt) / (rn * ktt - rt * knt), mu)  # impulse ratio
    za = an - ratio * at  # lever arm of the impulse about A
    zb = bn - ratio * bt  # lever arm of the impulse about B
    hz = za / ia - zb / ib  # relative spin by the impulse
    q = 1 / (1 + m * (an * za / ia + bn * zb / ib - z * hn * hz))  # factor of the rotations
    Pn = m * rn * q  # normal impulse
    Pt = ratio * Pn  # tangential impulse
    Pm = where(point, 0, -z * (WA - WB + hz * Pn))  # moment equation: moment
    VAX = UX + (c - ratio * s) * Pn / MA  # final velocity of A, x
    VAY = UY + (s + ratio * c) * Pn / MA  # final velocity of A, y
    VBX = VX - (c - ratio * s) * Pn / MB  # final velocity of B, x
    VBY = VY - (s + ratio * c) * Pn / MB  # final velocity of B, y
    WAF = WA + (za * Pn + Pm) / ia  # final spin of A
    WBF = WB + (zb * Pn - Pm) / ib  # final spin of B
