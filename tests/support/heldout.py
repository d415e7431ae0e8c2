"""Bugs written before the search that is to find them: five programs, in five spellings.

Each program is the text of a correct one; a bug is a text in it and what stands there instead. The
package has no part in any of it. `SINGLES` are programs with one bug, `PAIRS` with two.
"""

from __future__ import annotations

import bugs
from bugs import Bug

HEAD = """
def run(g):
    E, MU, EM, M = g["E"], g["MU"], g["EM"], g["M"]
    da, db = g["DA"], g["DB"]
    ma, mb, ia, ib = g["MA"], g["MB"], g["IA"], g["IB"]
    vax, vay, wa = g["UX"], g["UY"], g["WA"]
    vbx, vby, wb = g["VX"], g["VY"], g["WB"]
    if ma <= 0 or mb <= 0:
        raise ArithmeticError
    ga, pa, pb, ta, tb = (radians(g[n]) for n in ("GA", "PA", "PB", "TA", "TB"))
    if M == 4:
        da = db = 0.0
        EM = 1.0
        ia = ib = 1.0
    elif ia <= 0 or ib <= 0:
        raise ArithmeticError
    c, s = cos(ga), sin(ga)
"""

TAIL = """
    XA, YA = vax + da*sin(ta+pa)*wa, vay - da*cos(ta+pa)*wa
    XB, YB = vbx - db*sin(tb+pb)*wb, vby + db*cos(tb+pb)*wb
    XAF, YAF = VAX + da*sin(ta+pa)*WAF, VAY - da*cos(ta+pa)*WAF
    XBF, YBF = VBX - db*sin(tb+pb)*WBF, VBY + db*cos(tb+pb)*WBF
    KI = 0.5*(ma*(vax**2 + vay**2) + mb*(vbx**2 + vby**2))
    KF = 0.5*(ma*(VAX**2 + VAY**2) + mb*(VBX**2 + VBY**2))
    if M != 4:
        KI += 0.5*ia*wa**2 + 0.5*ib*wb**2
        KF += 0.5*ia*WAF**2 + 0.5*ib*WBF**2
    LOSS = 100*(KI - KF)/KI
    DVA = hypot(VAX - vax, VAY - vay)
    DVB = hypot(VBX - vbx, VBY - vby)
    PN = ma*((VAX - vax)*c + (VAY - vay)*s)
    PT = ma*((VAY - vay)*c - (VAX - vax)*s)
    return dict(VAX=VAX, VAY=VAY, VBX=VBX, VBY=VBY, WAF=WAF, WBF=WBF, XA=XA, YA=YA, XB=XB, YB=YB,
                XAF=XAF, YAF=YAF, XBF=XBF, YBF=YBF, KI=KI, KF=KF, LOSS=LOSS, DVA=DVA, DVB=DVB,
                PN=PN, PT=PT)
"""

# the listing, translated
MATRIX = """
    d1, d2 = db*sin(tb + pb), db*cos(tb + pb)
    d3, d4 = da*sin(ta + pa), da*cos(ta + pa)
    xa, ya = vax + d3*wa, vay - d4*wa
    xb, yb = vbx - d1*wb, vby + d2*wb
    A = np.zeros((6, 6)); b = np.zeros(6)
    A[0, 0], A[0, 2] = ma, mb
    A[1, 1], A[1, 3] = ma, mb
    mu = MU
    if MU != -10:
        if xa*s - ya*c < xb*s - yb*c:
            mu = -mu
        A[2, 1] = ma*(c - mu*s)
        A[2, 2] = mb*(s + mu*c)
        b[2] = ma*(c - mu*s)*vay + mb*(s + mu*c)*vbx
    else:
        A[2, 0], A[2, 1], A[2, 2], A[2, 3] = s, -c, -s, c
        A[2, 4], A[2, 5] = da*cos(pa + ta - ga), db*cos(pb + tb - ga)
    A[3, 0], A[3, 1], A[3, 2], A[3, 3] = c, s, -c, -s
    A[3, 4], A[3, 5] = d3*c - d4*s, d1*c - d2*s
    A[4, 1], A[4, 2], A[4, 4], A[4, 5] = ma*(d2 + d4), mb*(d1 + d3), ia, ib
    A[5, 0], A[5, 1] = -EM*ma*d3/ia, EM*ma*d4/ia
    A[5, 2], A[5, 3] = -EM*mb*d1/ib, EM*mb*d2/ib
    A[5, 4], A[5, 5] = 2*EM - 1, 1 - 2*EM
    b[0], b[1] = ma*vax + mb*vbx, ma*vay + mb*vby
    b[3] = -E*((vay - d4*wa - vby - d2*wb)*s + (vax + d3*wa - vbx + d1*wb)*c)
    b[4] = ma*(d2 + d4)*vay + mb*(d1 + d3)*vbx + ia*wa + ib*wb
    b[5] = EM*(-ma*d3*vax/ia + ma*d4*vay/ia - mb*d1*vbx/ib + mb*d2*vby/ib + wa - wb)
    VAX, VAY, VBX, VBY, WAF, WBF = np.linalg.solve(A, b)
"""

# contact impulses along n and t, closed form
IMPULSE = """
    rax, ray = -da*cos(ta + pa), -da*sin(ta + pa)
    rbx, rby = db*cos(tb + pb), db*sin(tb + pb)
    nx, ny, tx, ty = c, s, -s, c
    an, at = rax*ny - ray*nx, rax*ty - ray*tx
    bn, bt = -(rbx*ny - rby*nx), -(rbx*ty - rby*tx)
    gn = (vax - vbx)*nx + (vay - vby)*ny + an*wa + bn*wb
    gt = (vax - vbx)*tx + (vay - vby)*ty + at*wa + bt*wb
    gw = wa - wb
    k = (1 - EM)/(1 - 2*EM)
    itot = ia + ib
    ired = ia*ib/itot
    kn, kt = an/ia - bn/ib, at/ia - bt/ib
    R = 1/ma + 1/mb
    knn = R + (an + bn)**2/itot + (1 - k)*ired*kn**2
    knt = (an + bn)*(at + bt)/itot + (1 - k)*ired*kn*kt
    ktt = R + (at + bt)**2/itot + (1 - k)*ired*kt**2
    rn = -(1 + E)*gn + k*ired*kn*gw
    rt = -gt + k*ired*kt*gw
    if MU == -10:
        det = knn*ktt - knt**2
        Pn = (rn*ktt - rt*knt)/det
        Pt = (rt*knn - rn*knt)/det
    else:
        mu = -MU if gt > 0 else MU
        Pn = rn/(knn + mu*knt)
        Pt = mu*Pn
    Mz = -k*ired*(gw + kn*Pn + kt*Pt)
    if M == 4:
        Mz = 0.0
    px, py = Pn*nx + Pt*tx, Pn*ny + Pt*ty
    VAX, VAY = vax + px/ma, vay + py/ma
    VBX, VBY = vbx - px/mb, vby - py/mb
    WAF = wa + (an*Pn + at*Pt + Mz)/ia
    WBF = wb + (bn*Pn + bt*Pt - Mz)/ib
"""

# a 2 by 2 system for the impulse along x and y, no closed form
TWO = """
    phia, phib = ta + pa, tb + pb
    xca, yca = da*cos(phia), da*sin(phia)
    xcb, ycb = db*cos(phib), db*sin(phib)
    ux = vax + yca*wa - vbx + ycb*wb
    uy = vay - xca*wa - vby - xcb*wb
    un, ut = ux*c + uy*s, -ux*s + uy*c
    w = wa - wb
    h = 1 - 2*EM
    q = EM/h
    J = 1/(1/ia + 1/ib)
    fx, fy = yca/ia - ycb/ib, -xca/ia + xcb/ib
    sx, sy = yca + ycb, -xca - xcb
    r = 1/ma + 1/mb
    Kxx = r + sx*sx/(ia + ib) - q*J*fx*fx
    Kxy = sx*sy/(ia + ib) - q*J*fx*fy
    Kyy = r + sy*sy/(ia + ib) - q*J*fy*fy
    g1 = (1 - EM)/h*J*w
    S = np.array([[Kxx, Kxy], [Kxy, Kyy]])
    normal, tangent = np.array([c, s]), np.array([-s, c])
    drive = g1*np.array([fx, fy])
    row1 = normal @ S
    rhs1 = -(1 + E)*un + normal @ drive
    if MU == -10:
        row2 = tangent @ S
        rhs2 = -ut + tangent @ drive
    else:
        f = abs(MU)*(1 if MU >= 0 else -1)
        if ut > 0:
            f = -f
        row2 = tangent - f*normal
        rhs2 = 0.0
    Px, Py = np.linalg.solve(np.array([row1, row2]), np.array([rhs1, rhs2]))
    T = -(1 - EM)/h*J*(w + fx*Px + fy*Py)
    if M == 4:
        T = 0
    VAX = vax + Px/ma
    VAY = vay + Py/ma
    VBX = vbx - Px/mb
    VBY = vby - Py/mb
    WAF = wa + (yca*Px - xca*Py + T)/ia
    WBF = wb + (ycb*Px - xcb*Py - T)/ib
"""

# nine unknowns: velocities and impulses, as the free-body diagrams give them
NINE = """
    oa, ob = ta + pa, tb + pb
    a = (-da*cos(oa), -da*sin(oa))
    b = (db*cos(ob), db*sin(ob))
    def cross(p, q):
        return p[0]*q[1] - p[1]*q[0]
    n, t = (c, s), (-s, c)
    ca = (vax - wa*a[1], vay + wa*a[0])
    cb = (vbx - wb*b[1], vby + wb*b[0])
    rel = (ca[0] - cb[0], ca[1] - cb[1])
    before_n = rel[0]*n[0] + rel[1]*n[1]
    before_t = rel[0]*t[0] + rel[1]*t[1]
    Z = np.zeros((9, 9)); y = np.zeros(9)
    # unknown: VAX VAY WAF VBX VBY WBF PN PT M
    Z[0, 0], Z[0, 6], Z[0, 7], y[0] = ma, -c, s, ma*vax
    Z[1, 1], Z[1, 6], Z[1, 7], y[1] = ma, -s, -c, ma*vay
    Z[2, 2], Z[2, 6], Z[2, 7], Z[2, 8], y[2] = ia, -cross(a, n), -cross(a, t), -1.0, ia*wa
    Z[3, 3], Z[3, 6], Z[3, 7], y[3] = mb, c, -s, mb*vbx
    Z[4, 4], Z[4, 6], Z[4, 7], y[4] = mb, s, c, mb*vby
    Z[5, 5], Z[5, 6], Z[5, 7], Z[5, 8], y[5] = ib, cross(b, n), cross(b, t), 1.0, ib*wb
    Z[6, 0], Z[6, 1], Z[6, 2] = c, s, cross(a, n)
    Z[6, 3], Z[6, 4], Z[6, 5] = -c, -s, -cross(b, n)
    y[6] = -E*before_n
    if MU == -10:
        Z[7, 0], Z[7, 1], Z[7, 2] = -s, c, cross(a, t)
        Z[7, 3], Z[7, 4], Z[7, 5] = s, -c, -cross(b, t)
    else:
        mu = MU
        if before_t > 0:
            mu = -MU
        Z[7, 6], Z[7, 7] = -mu, 1.0
    Z[8, 2], Z[8, 5], Z[8, 8] = -(1 - EM), 1 - EM, EM*(1/ia + 1/ib)
    if M == 4:
        Z[8] = 0; Z[8, 8] = 1.0; y[8] = 0
    VAX, VAY, WAF, VBX, VBY, WBF = np.linalg.solve(Z, y)[:6]
"""

# as otherprogram has it, the impulse from A's change alone
ONA = """
    ax, ay = -da*np.cos(ta + pa), -da*np.sin(ta + pa)
    bx, by = db*np.cos(tb + pb), db*np.sin(tb + pb)
    dvx = (vax - ay*wa) - (vbx - by*wb)
    dvy = (vay + ax*wa) - (vby + bx*wb)
    closing = dvx*c + dvy*s
    slip = dvy*c - dvx*s
    mu = -MU if slip > 0 else MU
    kx, ky = -s - mu*c, c - mu*s
    friction = [ma*kx, ma*ky, 0, 0, 0, 0, ma*kx*vax + ma*ky*vay]
    if MU == -10:
        friction = [-s, c, s, -c, ax*c + ay*s, -bx*c - by*s, 0]
    hx, hy = ma*(ay - by), ma*(bx - ax)
    q = EM*(1/ia + 1/ib)
    rows = np.array([
        [ma, 0, mb, 0, 0, 0, ma*vax + mb*vbx],
        [0, ma, 0, mb, 0, 0, ma*vay + mb*vby],
        [c, s, -c, -s, ax*s - ay*c, by*c - bx*s, -E*closing],
        friction,
        [hx, hy, 0, 0, ia, ib, hx*vax + hy*vay + ia*wa + ib*wb],
        [q*ma*ay, -q*ma*ax, 0, 0, q*ia - (1 - EM), 1 - EM, q*(ma*ay*vax - ma*ax*vay + ia*wa)],
    ], dtype=float)
    VAX, VAY, VBX, VBY, WAF, WBF = np.linalg.solve(rows[:, :6], rows[:, 6])
"""

PROGRAMS = {"matrix": MATRIX, "impulse": IMPULSE, "two": TWO, "nine": NINE, "on A": ONA}
bugs.PROGRAMS.update({name: HEAD + text + TAIL for name, text in PROGRAMS.items()})

SINGLES: tuple[tuple[str, Bug], ...] = (
    ("matrix", ("d3*c - d4*s, d1*c - d2*s", "d3*c + d4*s, d1*c - d2*s")),
    ("matrix", ("d3*c - d4*s, d1*c - d2*s", "d3*c - d4*s, d2*c - d1*s")),
    ("matrix", ("A[2, 1] = ma*(c - mu*s)", "A[2, 1] = ma*(c + mu*s)")),
    ("matrix", ("A[2, 2] = mb*(s + mu*c)", "A[2, 2] = mb*(s - mu*c)")),
    ("matrix", ("A[4, 2], A[4, 4], A[4, 5] = ma*(d2 + d4), mb*(d1 + d3)",
                "A[4, 2], A[4, 4], A[4, 5] = ma*(d2 - d4), mb*(d1 + d3)")),
    ("matrix", ("= 2*EM - 1, 1 - 2*EM", "= 2*EM - 1, 2*EM - 1")),
    ("matrix", ("= 2*EM - 1, 1 - 2*EM", "= EM - 1, 1 - EM")),
    ("matrix", ("+ wa - wb)", "+ wa + wb)")),
    ("matrix", ("xa, ya = vax + d3*wa, vay - d4*wa", "xa, ya = vax - d3*wa, vay - d4*wa")),
    ("matrix", ("A[5, 0], A[5, 1] = -EM*ma*d3/ia, EM*ma*d4/ia",
                "A[5, 0], A[5, 1] = -EM*ma*d3/ia, EM*ma*d3/ia")),
    ("matrix", ("+ mb*(s + mu*c)*vbx\n", "+ mb*(s + mu*c)*vby\n")),
    ("matrix", ("vby - d2*wb)*s + (vax + d3*wa - vbx + d1*wb)*c",
                "vby + d2*wb)*s + (vax + d3*wa - vbx - d1*wb)*c")),
    ("matrix", ("da*cos(pa + ta - ga)", "da*cos(pa - ta - ga)")),
    ("matrix", ("da*cos(pa + ta - ga)", "da*sin(pa + ta - ga)")),
    ("matrix", ("xa*s - ya*c < xb*s - yb*c", "xa*s - ya*c > xb*s - yb*c")),
    ("matrix", ("xa*s - ya*c < xb*s - yb*c", "vax*s - vay*c < vbx*s - vby*c")),
    ("matrix", ("d1, d2 = db*sin(tb + pb), db*cos(tb + pb)",
                "d1, d2 = db*sin(tb - pb), db*cos(tb - pb)")),
    ("matrix", ("A[1, 1], A[1, 3] = ma, mb", "A[1, 1], A[1, 3] = ma, ma")),
    ("impulse", ("rn = -(1 + E)*gn", "rn = -(1 - E)*gn")),
    ("impulse", ("rn = -(1 + E)*gn + k*ired*kn*gw", "rn = -(1 + E)*gn - k*ired*kn*gw")),
    ("impulse", ("rn = -(1 + E)*gn + k*ired*kn*gw", "rn = -(1 + E)*gn")),
    ("impulse", ("rn = -(1 + E)*gn", "rn = -E*gn")),
    ("impulse", ("Mz = -k*ired*(gw", "Mz = k*ired*(gw")),
    ("impulse", ("bn*Pn + bt*Pt - Mz", "bn*Pn + bt*Pt + Mz")),
    ("impulse", ("(an*Pn + at*Pt + Mz)/ia", "(an*Pn - at*Pt + Mz)/ia")),
    ("impulse", ("Pn = rn/(knn + mu*knt)", "Pn = rn/(knn - mu*knt)")),
    ("impulse", ("Pn = rn/(knn + mu*knt)", "Pn = rn/(ktt + mu*knt)")),
    ("impulse", ("Pn = rn/(knn + mu*knt)", "Pn = rn/knn")),
    ("impulse", ("k = (1 - EM)/(1 - 2*EM)", "k = (1 + EM)/(1 - 2*EM)")),
    ("impulse", ("k = (1 - EM)/(1 - 2*EM)", "k = (1 - EM)/(1 + 2*EM)")),
    ("impulse", ("ired = ia*ib/itot", "ired = ia*ib")),
    ("impulse", ("ired = ia*ib/itot", "ired = itot/(ia*ib)")),
    ("impulse", ("kn, kt = an/ia - bn/ib", "kn, kt = an/ia + bn/ib")),
    ("impulse", ("R = 1/ma + 1/mb", "R = 1/(ma + mb)")),
    ("impulse", ("nx, ny, tx, ty = c, s, -s, c", "nx, ny, tx, ty = c, s, s, -c")),
    ("impulse", ("Pt = (rt*knn - rn*knt)/det", "Pt = (rt*ktt - rn*knt)/det")),
    ("impulse", ("det = knn*ktt - knt**2", "det = knn*ktt + knt**2")),
    ("impulse", ("-MU if gt > 0 else MU", "MU if gt > 0 else -MU")),
    ("impulse", ("-MU if gt > 0 else MU", "MU")),
    ("impulse", ("bn, bt = -(rbx*ny", "bn, bt = (rbx*ny")),
    ("impulse", ("VBX, VBY = vbx - px/mb, vby - py/mb", "VBX, VBY = vbx - px/ma, vby - py/ma")),
    ("impulse", ("px, py = Pn*nx + Pt*tx", "px, py = Pn*nx - Pt*tx")),
    ("two", ("xcb, ycb = db*cos(phib), db*sin(phib)", "xcb, ycb = db*sin(phib), db*cos(phib)")),
    ("two", ("q = EM/h", "q = -EM/h")),
    ("two", ("fx, fy = yca/ia - ycb/ib", "fx, fy = yca/ia + ycb/ib")),
    ("two", ("J = 1/(1/ia + 1/ib)", "J = 1/ia + 1/ib")),
    ("two", ("uy = vay - xca*wa", "uy = vay + xca*wa")),
    ("two", ("row2 = tangent - f*normal", "row2 = tangent + f*normal")),
    ("two", ("rhs2 = -ut + tangent @ drive", "rhs2 = tangent @ drive")),
    ("two", ("WBF = wb + (ycb*Px - xcb*Py - T)/ib", "WBF = wb + (ycb*Px + xcb*Py - T)/ib")),
    ("two", ("WBF = wb + (ycb*Px - xcb*Py - T)/ib", "WBF = wb - (ycb*Px - xcb*Py - T)/ib")),
    ("nine", ("ca = (vax - wa*a[1]", "ca = (vax + wa*a[1]")),
    ("nine", ("-cross(a, n), -cross(a, t), -1.0, ia*wa", "-cross(a, n), cross(a, t), -1.0, ia*wa")),
    ("nine", ("1 - EM, EM*(1/ia + 1/ib)", "1 - EM, EM*(1/(ia + ib))")),
    ("nine", ("1 - EM, EM*(1/ia + 1/ib)", "1 - EM, -EM*(1/ia + 1/ib)")),
    ("nine", ("cross(b, n), cross(b, t), 1.0, ib*wb", "cross(b, n), cross(b, t), 1.0, ib*wa")),
    ("nine", ("b = (db*cos(ob)", "b = (-db*cos(ob)")),
    ("nine", ("mb, c, -s, mb*vbx", "mb, c, s, mb*vbx")),
    ("nine", ("y[6] = -E*before_n", "y[6] = E*before_n")),
    ("nine", ("before_t > 0", "before_n > 0")),
    ("on A", ("hx, hy = ma*(ay - by), ma*(bx - ax)", "hx, hy = ma*(ay + by), ma*(bx - ax)")),
    ("on A", ("hx*vax + hy*vay + ia*wa + ib*wb", "ia*wa + ib*wb")),
    ("on A", ("q = EM*(1/ia + 1/ib)", "q = EM/ia")),
    ("on A", ("q*ia - (1 - EM), 1 - EM", "q*ia - (1 + EM), 1 + EM")),
    ("on A", ("kx, ky = -s - mu*c", "kx, ky = -s + mu*c")),
    ("on A", ("ax*s - ay*c, by*c - bx*s", "ax*s - ay*c, bx*s - by*c")),
    ("on A", ("[-s, c, s, -c, ax*c + ay*s", "[-s, c, s, -c, ax*c - ay*s")),
    # reading and showing
    ("matrix", ('radians(g[n]) for n in ("GA"', 'g[n]*3.1416/180 for n in ("GA"')),
    ("nine", ('g["UX"], g["UY"], g["WA"]', 'g["UX"], g["UY"], radians(g["WA"])')),
    ("impulse", ('ma, mb, ia, ib = g["MA"], g["MB"], g["IA"], g["IB"]',
                 'ma, mb, ia, ib = g["MA"]/32.2, g["MB"]/32.2, g["IA"], g["IB"]')),
    ("two", ('E, MU, EM, M = g["E"], g["MU"], g["EM"]',
             'E, MU, EM, M = g["E"], g["MU"], abs(g["EM"])')),
    ("matrix", ('vbx, vby, wb = g["VX"], g["VY"]', 'vbx, vby, wb = g["VX"], -g["VY"]')),
    ("on A", ("ga, pa, pb, ta, tb = (", "ga, pa, ta, pb, tb = (")),
    ("two", ('da, db = g["DA"], g["DB"]', 'da, db = g["DA"], g["DA"]')),
    ("impulse", ("VBX=VBX, VBY=VBY, WAF=WAF", "VBX=VBX, VBY=VBY, WAF=degrees(WAF)")),
    ("nine", ("XAF, YAF = VAX + da*sin(ta+pa)*WAF", "XAF, YAF = VAX + da*sin(ta+pa)*wa")),
    ("two", ("KF += 0.5*ia*WAF**2 + 0.5*ib*WBF**2", "KF += 0.5*ia*WAF**2 + 0.5*ia*WBF**2")),
    ("on A", ("LOSS = 100*(KI - KF)/KI", "LOSS = 100*(KI - KF)/KF")),
    ("impulse", ("DVB = hypot(VBX - vbx, VBY - vby)", "DVB = hypot(VBX, VBY) - hypot(vbx, vby)")),
    ("matrix", ("PT = ma*((VAY - vay)*c -", "PT = ma*((VAY - vay)*c +")),
    ("nine", ("    if M != 4:\n        KI +=", "    if True:\n        KI +=")),
)  # fmt: skip

PAIRS: tuple[tuple[str, Bug, Bug], ...] = (
    ("matrix", ("d3*c - d4*s, d1*c - d2*s", "d3*c + d4*s, d1*c - d2*s"),
     ("+ wa - wb)", "+ wa + wb)")),
    ("matrix", ("A[2, 1] = ma*(c - mu*s)", "A[2, 1] = ma*(c + mu*s)"),
     ("= ma*(d2 + d4), mb*(d1 + d3)", "= ma*(d2 - d4), mb*(d1 + d3)")),
    ("matrix", ("da*cos(pa + ta - ga)", "da*sin(pa + ta - ga)"),
     ("A[2, 2] = mb*(s + mu*c)", "A[2, 2] = mb*(s - mu*c)")),
    ("matrix", ('vax, vay, wa = g["UX"], g["UY"], g["WA"]',
                'vax, vay, wa = g["UX"], g["UY"], radians(g["WA"])'),
     ("KF += 0.5*ia*WAF**2 + 0.5*ib*WBF**2", "KF += ia*WAF**2 + ib*WBF**2")),
    ("impulse", ("rn = -(1 + E)*gn", "rn = -(1 - E)*gn"),
     ("bn*Pn + bt*Pt - Mz", "bn*Pn + bt*Pt + Mz")),
    ("impulse", ("VBX, VBY = vbx - px/mb", "VBX, VBY = vbx + px/mb"),
     ("k = (1 - EM)/(1 - 2*EM)", "k = (1 + EM)/(1 - 2*EM)")),
    ("impulse", ("-MU if gt > 0 else MU", "MU if gt > 0 else -MU"),
     ("LOSS = 100*(KI - KF)/KI", "LOSS = (KI - KF)/KI")),
    ("impulse", ("det = knn*ktt - knt**2", "det = knn*ktt + knt**2"),
     ("Pn = rn/(knn + mu*knt)", "Pn = rn/(knn - mu*knt)")),
    ("two", ("uy = vay - xca*wa", "uy = vay + xca*wa"),
     ("VBX = vbx - Px/mb", "VBX = vbx - Px/ma")),
    ("two", ("J = 1/(1/ia + 1/ib)", "J = 1/ia + 1/ib"),
     ("DVA = hypot(VAX - vax, VAY - vay)", "DVA = abs(VAX - vax)")),
    ("nine", ("ca = (vax - wa*a[1]", "ca = (vax + wa*a[1]"),
     ("1 - EM, EM*(1/ia + 1/ib)", "1 - EM, -EM*(1/ia + 1/ib)")),
    ("nine", ("y[6] = -E*before_n", "y[6] = E*before_n"),
     ("-cross(a, n), -cross(a, t), -1.0", "-cross(a, n), cross(a, t), -1.0")),
    ("nine", ('ma, mb, ia, ib = g["MA"], g["MB"], g["IA"], g["IB"]',
              'ma, mb, ia, ib = g["MA"], g["MB"], g["IA"]/2, g["IB"]/2'),
     ("before_t > 0", "before_t < 0")),
    ("on A", ("hx, hy = ma*(ay - by), ma*(bx - ax)", "hx, hy = ma*(ay + by), ma*(bx - ax)"),
     ("q = EM*(1/ia + 1/ib)", "q = EM/ia")),
    ("on A", ("kx, ky = -s - mu*c", "kx, ky = -s + mu*c"),
     ("VBX=VBX, VBY=VBY, WAF=WAF, WBF=WBF",
      "VBX=VBX, VBY=VBY, WAF=degrees(WAF), WBF=degrees(WBF)")),
    ("on A", ('vbx, vby, wb = g["VX"], g["VY"], g["WB"]',
              'vbx, vby, wb = g["VX"], g["VY"], -g["WB"]'),
     ("ma*vay + mb*vby]", "ma*vay - mb*vby]")),
)  # fmt: skip
