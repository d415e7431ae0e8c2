# mypy: ignore-errors
# ruff: noqa: F821, F841
"""The contact frame: velocities along n and t, the impulse, and back to x and y."""


def statements():
    """Compute the impulse in the contact frame, and the final velocities from it."""
    psa = ta + pa - ga  # angle from the normal to A's contact point
    psb = tb + pb - ga  # angle from the normal to B's contact point
    an = da * sin(psa)  # lever arm of A about the normal
    at = da * cos(psa)  # lever arm of A about the tangent
    bn = db * sin(psb)  # lever arm of B about the normal
    bt = db * cos(psb)  # lever arm of B about the tangent
    uan = UX * c + UY * s  # velocity of A before, normal
    uat = -UX * s + UY * c  # velocity of A before, tangential
    ubn = VX * c + VY * s  # velocity of B before, normal
    ubt = -VX * s + VY * c  # velocity of B before, tangential
    gan = uan + an * WA  # contact velocity of A before, normal
    gat = uat - at * WA  # contact velocity of A before, tangential
    gbn = ubn - bn * WB  # contact velocity of B before, normal
    gbt = ubt + bt * WB  # contact velocity of B before, tangential
    gn = gan - gbn  # closing velocity at the contact point
    gt = gat - gbt  # sliding velocity at the contact point
    gw = WA - WB  # relative spin before
    mu = where(gt > 0, -MU, MU)  # sign rule of MU
    ir = ia * ib / (ia + ib)  # reduced inertia
    z = (1 - em) / (1 - 2 * em) * ir  # moment equation: moment coefficient
    hn = an / ia - bn / ib  # moment equation: relative spin by a unit normal impulse
    ht = bt / ib - at / ia  # moment equation: relative spin by a unit tangential impulse
    knn = 1 / MA + 1 / MB + an**2 / ia + bn**2 / ib - z * hn**2  # effective mass, normal
    knt = -an * at / ia - bn * bt / ib - z * hn * ht  # effective mass, coupling
    ktt = 1 / MA + 1 / MB + at**2 / ia + bt**2 / ib - z * ht**2  # effective mass, tangential
    rn = -(1 + E) * gn + z * hn * gw  # restitution: normal velocity to be gained
    rt = -gt + z * ht * gw  # the pivot: tangential velocity to be gained
    det = knn * ktt - knt**2  # determinant of the pivot's equations
    Pn = where(pivot, (rn * ktt - rt * knt) / det, rn / (knn + mu * knt))  # normal impulse
    Pt = where(pivot, (rt * knn - rn * knt) / det, mu * Pn)  # tangential impulse
    Pm = where(point, 0, -z * (gw + hn * Pn + ht * Pt))  # moment equation: moment
    van = uan + Pn / MA  # final velocity of A, normal
    vat = uat + Pt / MA  # final velocity of A, tangential
    vbn = ubn - Pn / MB  # final velocity of B, normal
    vbt = ubt - Pt / MB  # final velocity of B, tangential
    VAX = van * c - vat * s  # final velocity of A, x
    VAY = van * s + vat * c  # final velocity of A, y
    VBX = vbn * c - vbt * s  # final velocity of B, x
    VBY = vbn * s + vbt * c  # final velocity of B, y
    WAF = WA + (an * Pn - at * Pt + Pm) / ia  # final spin of A
    WBF = WB + (bn * Pn - bt * Pt - Pm) / ib  # final spin of B
