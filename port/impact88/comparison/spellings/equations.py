# mypy: ignore-errors
# ruff: noqa: F821, F841
"""Equations 13-18 as the listing sets them up, solved for the six final velocities."""


def statements():
    """Write each equation as left side minus right side."""
    D1 = db * sin(tb + pb)  # line 330: D1
    D2 = db * cos(tb + pb)  # line 330: D2
    D3 = da * sin(ta + pa)  # line 330: D3
    D4 = da * cos(ta + pa)  # line 330: D4
    CXA = UX + D3 * WA  # contact velocity of A before, x
    CYA = UY - D4 * WA  # contact velocity of A before, y
    CXB = VX - D1 * WB  # contact velocity of B before, x
    CYB = VY + D2 * WB  # contact velocity of B before, y
    mu = where(CXA * s - CYA * c < CXB * s - CYB * c, -MU, MU)  # line 400: sign rule of MU
    slip = (
        MA * (c - mu * s) * VAY
        + MB * (s + mu * c) * VBX
        - (MA * (c - mu * s) * UY + MB * (s + mu * c) * VX)
    )  # friction, Equation 16
    hold = (
        s * VAX
        - c * VAY
        - s * VBX
        + c * VBY
        + da * cos(pa + ta - ga) * WAF
        + db * cos(pb + tb - ga) * WBF
    )  # the pivot, in place of Equation 16
    eq13 = MA * VAX + MB * VBX - (MA * UX + MB * VX)  # momentum along x, Equation 13
    eq14 = MA * VAY + MB * VBY - (MA * UY + MB * VY)  # momentum along y, Equation 14
    eq15 = (
        c * VAX
        + s * VAY
        - c * VBX
        - s * VBY
        + (D3 * c - D4 * s) * WAF
        + (D1 * c - D2 * s) * WBF
        + E * ((UY - D4 * WA - VY - D2 * WB) * s + (UX + D3 * WA - VX + D1 * WB) * c)
    )  # restitution, Equation 15
    eq16 = where(pivot, hold, slip)  # friction, Equation 16
    eq17 = (
        MA * (D2 + D4) * VAY
        + MB * (D1 + D3) * VBX
        + ia * WAF
        + ib * WBF
        - (MA * (D2 + D4) * UY + MB * (D1 + D3) * VX + ia * WA + ib * WB)
    )  # angular momentum, Equation 17
    eq18 = (
        -em * MA * D3 / ia * VAX
        + em * MA * D4 / ia * VAY
        - em * MB * D1 / ib * VBX
        + em * MB * D2 / ib * VBY
        + (2 * em - 1) * WAF
        + (1 - 2 * em) * WBF
        - em
        * (-MA * D3 * UX / ia + MA * D4 * UY / ia - MB * D1 * VX / ib + MB * D2 * VY / ib + WA - WB)
    )  # moment equation, Equation 18
    VAX, VAY, VBX, VBY, WAF, WBF = solve(eq13, eq14, eq15, eq16, eq17, eq18)
