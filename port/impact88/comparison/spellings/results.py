# mypy: ignore-errors
# ruff: noqa: F821, F841
"""Results that follow from the velocities before and after the impact."""


def statements():
    """Compute them from the columns and the final velocities."""
    XA = UX + da * sin(ta + pa) * WA  # contact velocity of A before, x
    YA = UY - da * cos(ta + pa) * WA  # contact velocity of A before, y
    XB = VX - db * sin(tb + pb) * WB  # contact velocity of B before, x
    YB = VY + db * cos(tb + pb) * WB  # contact velocity of B before, y
    XAF = VAX + da * sin(ta + pa) * WAF  # contact velocity of A after, x
    YAF = VAY - da * cos(ta + pa) * WAF  # contact velocity of A after, y
    XBF = VBX - db * sin(tb + pb) * WBF  # contact velocity of B after, x
    YBF = VBY + db * cos(tb + pb) * WBF  # contact velocity of B after, y
    VC = -(c * (XA - XB) + s * (YA - YB))  # closing speed
    VS = E * VC  # separation speed
    sliding = c * (YA - YB) - s * (XA - XB)  # sliding velocity before
    sliding_after = c * (YAF - YBF) - s * (XAF - XBF)  # sliding velocity after
    KI = (
        0.5 * MA * (UX**2 + UY**2)
        + 0.5 * MB * (VX**2 + VY**2)
        + where(point, 0, 0.5 * ia * WA**2 + 0.5 * ib * WB**2)
    )  # initial kinetic energy
    KF = (
        0.5 * MA * (VAX**2 + VAY**2)
        + 0.5 * MB * (VBX**2 + VBY**2)
        + where(point, 0, 0.5 * ia * WAF**2 + 0.5 * ib * WBF**2)
    )  # final kinetic energy
    LOSS = 100 * (KI - KF) / KI  # energy loss in percent
    DVA = hypot(VAX - UX, VAY - UY)  # delta-V of A
    DVB = hypot(VBX - VX, VBY - VY)  # delta-V of B
    PN = MA * (c * (VAX - UX) + s * (VAY - UY))  # normal impulse on A
    PT = MA * (c * (VAY - UY) - s * (VAX - UX))  # tangential impulse on A
    PM = where(
        point, 0, ia * (WAF - WA) - (rax * s - ray * c) * PN - (rax * c + ray * s) * PT
    )  # moment impulse on A
    ELN = -(1 - E) * (c * (XA - XB) + s * (YA - YB)) * PN / 2  # energy lost along the normal
    ELT = -PT * (sliding + sliding_after) / 2  # energy lost by friction
    ELM = where(point, 0, -PM * (WA - WB + WAF - WBF) / 2)  # energy lost by the moment
    EESA = sqrt(maximum(KI - KF, 0) / MA)  # energy equivalent speed of A
    EESB = sqrt(maximum(KI - KF, 0) / MB)  # energy equivalent speed of B
    MUP = where(pivot, -10, where(sliding > 0, -MU, MU))  # friction coefficient as printed
    MUC = muc  # critical friction coefficient
