# mypy: ignore-errors
# ruff: noqa: F821, F841
"""Free bodies: impulse and momentum of each, with restitution, friction and moment."""


def statements():
    """Write each equation as left side minus right side."""
    an = rax * s - ray * c  # lever arm of A about the normal
    at = rax * c + ray * s  # lever arm of A about the tangent
    bn = rbx * s - rby * c  # lever arm of B about the normal
    bt = rbx * c + rby * s  # lever arm of B about the tangent
    gn = c * UX + s * UY + an * WA - c * VX - s * VY - bn * WB  # closing velocity
    gt = c * UY - s * UX + at * WA - c * VY + s * VX - bt * WB  # sliding velocity
    mu = where(gt > 0, -MU, MU)  # sign rule of MU
    eqax = MA * (VAX - UX) - (c * Pn - s * Pt)  # impulse and momentum of A, x
    eqay = MA * (VAY - UY) - (s * Pn + c * Pt)  # impulse and momentum of A, y
    eqbx = MB * (VBX - VX) + (c * Pn - s * Pt)  # impulse and momentum of B, x
    eqby = MB * (VBY - VY) + (s * Pn + c * Pt)  # impulse and momentum of B, y
    eqaw = ia * (WAF - WA) - (an * Pn + at * Pt) - Pm  # angular momentum of A
    eqbw = ib * (WBF - WB) + (bn * Pn + bt * Pt) + Pm  # angular momentum of B
    eq15 = (
        c * VAX + s * VAY + an * WAF - c * VBX - s * VBY - bn * WBF + E * gn
    )  # restitution, Equation 15
    eq16 = where(
        pivot, c * VAY - s * VAX + at * WAF - c * VBY + s * VBX - bt * WBF, Pt - mu * Pn
    )  # friction, Equation 16
    eq18 = where(
        point, Pm, em * (1 / ia + 1 / ib) * Pm - (1 - em) * (WAF - WBF)
    )  # moment equation, Equation 18
    VAX, VAY, VBX, VBY, WAF, WBF, Pn, Pt, Pm = solve(
        eqax, eqay, eqbx, eqby, eqaw, eqbw, eq15, eq16, eq18
    )
