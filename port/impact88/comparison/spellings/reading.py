# mypy: ignore-errors
# ruff: noqa: F821, F841
"""The columns of a table as quantities: radians, a point mass without arm and moment, arms."""


def statements():
    """Read a scene's columns."""
    ga = GA * pi / 180  # angle of the contact plane
    pa = PA * pi / 180  # angle from A's axis to the contact point
    pb = PB * pi / 180  # angle from B's axis to the contact point
    ta = TA * pi / 180  # heading of A
    tb = TB * pi / 180  # heading of B
    point = M == 4  # point masses
    pivot = MU == -10  # the pivot
    da = where(point, 0, DA)  # distance of A's contact point
    db = where(point, 0, DB)  # distance of B's contact point
    em = where(point, 1, EM)  # moment coefficient
    ia = where(point, 1, IA)  # inertia of A
    ib = where(point, 1, IB)  # inertia of B
    c = cos(ga)  # normal axis, x
    s = sin(ga)  # normal axis, y
    rax = -da * cos(ta + pa)  # contact point from A, x
    ray = -da * sin(ta + pa)  # contact point from A, y
    rbx = db * cos(tb + pb)  # contact point from B, x
    rby = db * sin(tb + pb)  # contact point from B, y
