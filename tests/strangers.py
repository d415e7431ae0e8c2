"""Bugs in programs that are written in no spelling the search knows: by a Jacobian and masses in
matrices; by textbook lever arms and an impulse ratio; in complex numbers, with the impulses' work.

`SINGLES` are programs with one bug, `PAIRS` with two.
"""

from __future__ import annotations

import bugs
from bugs import Bug

# Delassus matrix: three impulses from J inv(M) J'
JACOBIAN = """
def run(case):
    th = {k: np.deg2rad(case[k]) for k in ("GA", "PA", "PB", "TA", "TB")}
    free = case["M"] == 4
    e, f = case["E"], case["MU"]
    em = 1.0 if free else case["EM"]
    arms = np.array([0.0, 0.0]) if free else np.array([case["DA"], case["DB"]])
    inert = np.array([1.0, 1.0]) if free else np.array([case["IA"], case["IB"]])
    mass = np.array([case["MA"], case["MB"]])
    q = np.array([case["UX"], case["UY"], case["WA"], case["VX"], case["VY"], case["WB"]])
    inv = 1/np.array([mass[0], mass[0], inert[0], mass[1], mass[1], inert[1]])
    n = np.array([np.cos(th["GA"]), np.sin(th["GA"])])
    t = np.array([-n[1], n[0]])
    alpha, beta = th["TA"] + th["PA"], th["TB"] + th["PB"]
    r1 = -arms[0]*np.array([np.cos(alpha), np.sin(alpha)])
    r2 = arms[1]*np.array([np.cos(beta), np.sin(beta)])
    J = np.zeros((3, 6))
    J[0] = [n[0], n[1], r1[0]*n[1] - r1[1]*n[0], -n[0], -n[1], -(r2[0]*n[1] - r2[1]*n[0])]
    J[1] = [t[0], t[1], r1[0]*t[1] - r1[1]*t[0], -t[0], -t[1], -(r2[0]*t[1] - r2[1]*t[0])]
    J[2] = [0, 0, 1, 0, 0, -1]
    W = J @ np.diag(inv) @ J.T
    u = J @ q
    K, rhs = W.copy(), np.zeros(3)
    rhs[0] = -(1 + e)*u[0]
    if f == -10:
        rhs[1] = -u[1]
    else:
        K[1] = [f if u[1] > 0 else -f, 1, 0]
    K[2] = (1 - em)*W[2]
    K[2, 2] -= em*(inv[2] + inv[5])
    rhs[2] = -(1 - em)*u[2]
    p = np.linalg.solve(K, rhs)
    v = q + inv*(J.T @ p)
    ke0 = 0.5*np.sum(q[[0, 1, 3, 4]]**2/inv[[0, 1, 3, 4]])
    ke1 = 0.5*np.sum(v[[0, 1, 3, 4]]**2/inv[[0, 1, 3, 4]])
    if not free:
        ke0 += 0.5*(q[2]**2/inv[2] + q[5]**2/inv[5])
        ke1 += 0.5*(v[2]**2/inv[2] + v[5]**2/inv[5])
    return dict(VAX=v[0], VAY=v[1], WAF=v[2], VBX=v[3], VBY=v[4], WBF=v[5],
                KI=ke0, KF=ke1, LOSS=100*(ke0 - ke1)/ke0,
                DVA=np.linalg.norm(v[:2] - q[:2]), DVB=np.linalg.norm(v[3:5] - q[3:5]))
"""

# lever arms normal to the line of impact, reduced mass, an impulse ratio; the pivot is a ratio too
RATIO = """
def run(case):
    rad = pi/180
    m1, m2 = case["MA"], case["MB"]
    if case["M"] == 4:
        d1 = d2 = 0
        em = 1
        k1sq, k2sq = 1/m1, 1/m2
    else:
        d1, d2, em = case["DA"], case["DB"], case["EM"]
        k1sq, k2sq = case["IA"]/m1, case["IB"]/m2
    G = case["GA"]*rad
    psi1 = (case["TA"] + case["PA"])*rad - G
    psi2 = (case["TB"] + case["PB"])*rad - G
    dc, dd = d1*sin(psi1), d1*cos(psi1)
    db, da = d2*sin(psi2), d2*cos(psi2)
    v1n = case["UX"]*cos(G) + case["UY"]*sin(G)
    v1t = case["UY"]*cos(G) - case["UX"]*sin(G)
    v2n = case["VX"]*cos(G) + case["VY"]*sin(G)
    v2t = case["VY"]*cos(G) - case["VX"]*sin(G)
    O1, O2 = case["WA"], case["WB"]
    vrn = (v1n + dc*O1) - (v2n - db*O2)
    vrt = (v1t - dd*O1) - (v2t + da*O2)
    mbar = m1*m2/(m1 + m2)
    J1, J2 = m1*k1sq, m2*k2sq
    Jbar = J1*J2/(J1 + J2)
    kap = (1 - em)/(1 - 2*em)*Jbar
    dO = O1 - O2
    un = dc/J1 - db/J2
    ut = -dd/J1 + da/J2
    bn = -(1 + case["E"])*vrn + kap*un*dO
    bt = -vrt + kap*ut*dO
    if case["MU"] == -10:
        A = 1/mbar + dc**2/J1 + db**2/J2 - kap*un**2
        B = -dc*dd/J1 - db*da/J2 - kap*un*ut
        C = 1/mbar + dd**2/J1 + da**2/J2 - kap*ut**2
        ratio = (bt*A - bn*B)/(bn*C - bt*B)
    else:
        ratio = -case["MU"] if vrt > 0 else case["MU"]
    z1, z2 = dc - ratio*dd, db - ratio*da
    slope = z1/J1 - z2/J2
    Pn = mbar*bn/(1 + mbar*(dc*z1/(m1*k1sq) + db*z2/(m2*k2sq) - kap*un*slope))
    Pt = ratio*Pn
    T = 0 if case["M"] == 4 else -kap*(dO + slope*Pn)
    V1n, V1t = v1n + Pn/m1, v1t + Pt/m1
    V2n, V2t = v2n - Pn/m2, v2t - Pt/m2
    W1 = O1 + (z1*Pn + T)/J1
    W2 = O2 + (z2*Pn - T)/J2
    return dict(VAX=V1n*cos(G) - V1t*sin(G), VAY=V1n*sin(G) + V1t*cos(G),
                VBX=V2n*cos(G) - V2t*sin(G), VBY=V2n*sin(G) + V2t*cos(G), WAF=W1, WBF=W2)
"""

# complex numbers: real part along the normal; unit responses; energy by the impulses' work
COMPLEX = """
def run(case):
    turn = cmath.exp(-1j*radians(case["GA"]))
    point = case["M"] == 4
    em = 1.0 if point else case["EM"]
    la, lb = (0.0, 0.0) if point else (case["DA"], case["DB"])
    ja, jb = (1.0, 1.0) if point else (case["IA"], case["IB"])
    ma, mb = case["MA"], case["MB"]
    za = -la*cmath.exp(1j*radians(case["TA"] + case["PA"]))*turn
    zb = lb*cmath.exp(1j*radians(case["TB"] + case["PB"]))*turn
    u = complex(case["UX"], case["UY"])*turn
    w = complex(case["VX"], case["VY"])*turn
    wa, wb = case["WA"], case["WB"]

    def torque(z, p):
        return (z.conjugate()*p).imag

    def gap(va, oa, vb, ob):
        return (va + 1j*oa*za) - (vb + 1j*ob*zb)

    def response(p, moment):
        oa = (torque(za, p) + moment)/ja
        ob = -(torque(zb, p) + moment)/jb
        return gap(p/ma, oa, -p/mb, ob), oa - ob

    approach, spin = gap(u, wa, w, wb), wa - wb
    share = 1 - em
    target = -(1 + case["E"])*approach.real
    moving, turning = response(0, 1.0)
    if case["MU"] == -10:
        gn, sn = response(1, 0.0)
        gt, st = response(1j, 0.0)
        a = [[gn.real, gt.real, moving.real], [gn.imag, gt.imag, moving.imag],
             [share*sn, share*st, share*turning - em*(1/ja + 1/jb)]]
        pn, pt, pm = np.linalg.solve(a, [target, -approach.imag, -share*spin])
        p = complex(pn, pt)
    else:
        mu = -case["MU"] if approach.imag > 0 else case["MU"]
        g, k = response(1 + 1j*mu, 0.0)
        diagonal = share*turning - em*(1/ja + 1/jb)
        det = g.real*diagonal - moving.real*share*k
        pn = (target*diagonal + moving.real*share*spin)/det
        pm = (-g.real*share*spin - share*k*target)/det
        p = pn*(1 + 1j*mu)
    if point:
        pm = 0.0
    ua, ub = u + p/ma, w - p/mb
    oa = wa + (torque(za, p) + pm)/ja
    ob = wb - (torque(zb, p) + pm)/jb
    mean = (approach + gap(ua, oa, ub, ob))/2
    work = (p.conjugate()*mean).real + pm*((wa - wb) + (oa - ob))/2
    ki = (ma*abs(u)**2 + mb*abs(w)**2)/2 + (0 if point else (ja*wa**2 + jb*wb**2)/2)
    if point and (wa or wb):
        work = (p.conjugate()*((u - w) + (ua - ub))/2).real
    ca, cb = (ua + 1j*oa*za)/turn, (ub + 1j*ob*zb)/turn
    a, b = ua/turn, ub/turn
    return dict(VAX=a.real, VAY=a.imag, VBX=b.real, VBY=b.imag, WAF=oa, WBF=ob,
                XAF=ca.real, YAF=ca.imag, XBF=cb.real, YBF=cb.imag,
                KI=ki, KF=ki + work, LOSS=-100*work/ki, PN=p.real, PT=p.imag)
"""

PROGRAMS = {"jacobian": JACOBIAN, "ratio": RATIO, "complex": COMPLEX}
bugs.PROGRAMS.update(PROGRAMS)

SINGLES: list[tuple[str, Bug]] = [
    ("jacobian", ("r1[0]*n[1] - r1[1]*n[0], -n[0]", "r1[1]*n[0] - r1[0]*n[1], -n[0]")),
    ("jacobian", ("-n[1], -(r2[0]*n[1] - r2[1]*n[0])]", "-n[1], r2[0]*n[1] - r2[1]*n[0]]")),
    ("jacobian", ("r1[0]*t[1] - r1[1]*t[0], -t[0]", "r1[0]*t[1] + r1[1]*t[0], -t[0]")),
    ("jacobian", ("J[2] = [0, 0, 1, 0, 0, -1]", "J[2] = [0, 0, 1, 0, 0, 1]")),
    ("jacobian", ("mass[0], inert[0], mass[1], mass[1], inert[1]]",
                  "mass[0], inert[0], mass[0], mass[1], inert[1]]")),
    ("jacobian", ("mass[0], inert[0], mass[1], mass[1], inert[1]]",
                  "mass[0], inert[1], mass[1], mass[1], inert[0]]")),
    ("jacobian", ("t = np.array([-n[1], n[0]])", "t = np.array([n[1], n[0]])")),
    ("jacobian", ("t = np.array([-n[1], n[0]])", "t = np.array([n[1], -n[0]])")),
    ("jacobian", ("rhs[0] = -(1 + e)*u[0]", "rhs[0] = -e*u[0]")),
    ("jacobian", ("rhs[0] = -(1 + e)*u[0]", "rhs[0] = -(1 + e*e)*u[0]")),
    ("jacobian", ("rhs[1] = -u[1]", "rhs[1] = u[1]")),
    ("jacobian", ("[f if u[1] > 0 else -f, 1, 0]", "[f, 1, 0]")),
    ("jacobian", ("[f if u[1] > 0 else -f, 1, 0]", "[f if u[0] > 0 else -f, 1, 0]")),
    ("jacobian", ("K[2] = (1 - em)*W[2]", "K[2] = (1 + em)*W[2]")),
    ("jacobian", ("K[2, 2] -= em*(inv[2] + inv[5])", "K[2, 2] += em*(inv[2] + inv[5])")),
    ("jacobian", ("K[2, 2] -= em*(inv[2] + inv[5])", "K[2, 2] -= em*inv[2]")),
    ("jacobian", ("rhs[2] = -(1 - em)*u[2]", "rhs[2] = 0")),
    ("jacobian", ("v = q + inv*(J.T @ p)", "v = q - inv*(J.T @ p)")),
    ("jacobian", ("K, rhs = W.copy(), np.zeros(3)", "K, rhs = np.diag(np.diag(W)), np.zeros(3)")),
    ("jacobian", ('alpha, beta = th["TA"] + th["PA"], th["TB"] + th["PB"]',
                  'alpha, beta = th["TA"] - th["PA"], th["TB"] - th["PB"]')),
    ("jacobian", ("r2 = arms[1]*", "r2 = -arms[1]*")),
    ("jacobian", ("ke1 += 0.5*(v[2]**2/inv[2] + v[5]**2/inv[5])",
                  "ke1 += 0.5*(q[2]**2/inv[2] + q[5]**2/inv[5])")),
    ("jacobian", ("np.deg2rad(case[k])", "case[k]*np.pi/200")),
    ("jacobian", ("DVB=np.linalg.norm(v[3:5] - q[3:5])", "DVB=np.linalg.norm(v[3:6] - q[3:6])")),
    ("jacobian", ('em = 1.0 if free else case["EM"]', 'em = 1.0 if free else 0.3*case["EM"]')),
    ("ratio", ('k1sq, k2sq = case["IA"]/m1, case["IB"]/m2',
               'k1sq, k2sq = case["IA"]/m2, case["IB"]/m1')),
    ("ratio", ("dc, dd = d1*sin(psi1), d1*cos(psi1)", "dc, dd = d1*cos(psi1), d1*sin(psi1)")),
    ("ratio", ("db, da = d2*sin(psi2), d2*cos(psi2)", "db, da = d2*sin(psi1), d2*cos(psi2)")),
    ("ratio", ('psi2 = (case["TB"] + case["PB"])*rad - G',
               'psi2 = (case["TB"] + case["PB"])*rad + G')),
    ("ratio", ('v1t = case["UY"]*cos(G) - case["UX"]*sin(G)',
               'v1t = case["UY"]*cos(G) + case["UX"]*sin(G)')),
    ("ratio", ('v2n = case["VX"]*cos(G) + case["VY"]*sin(G)',
               'v2n = case["VX"]*sin(G) + case["VY"]*cos(G)')),
    ("ratio", ("vrn = (v1n + dc*O1) - (v2n - db*O2)", "vrn = (v1n + dc*O1) - (v2n + db*O2)")),
    ("ratio", ("vrn = (v1n + dc*O1) - (v2n - db*O2)", "vrn = v1n - v2n")),
    ("ratio", ("vrt = (v1t - dd*O1) - (v2t + da*O2)", "vrt = (v1t + dd*O1) - (v2t - da*O2)")),
    ("ratio", ("mbar = m1*m2/(m1 + m2)", "mbar = m1*m2/(m1 - m2)")),
    ("ratio", ("mbar = m1*m2/(m1 + m2)", "mbar = (m1 + m2)/2")),
    ("ratio", ("Jbar = J1*J2/(J1 + J2)", "Jbar = J1*J2/(m1 + m2)")),
    ("ratio", ("kap = (1 - em)/(1 - 2*em)*Jbar", "kap = (1 - em)/(2 - em)*Jbar")),
    ("ratio", ("kap = (1 - em)/(1 - 2*em)*Jbar", "kap = (1 - em)*Jbar")),
    ("ratio", ("dO = O1 - O2", "dO = O1 + O2")),
    ("ratio", ("un = dc/J1 - db/J2", "un = dc/J1 + db/J2")),
    ("ratio", ("ut = -dd/J1 + da/J2", "ut = dd/J1 + da/J2")),
    ("ratio", ("ratio = (bt*A - bn*B)/(bn*C - bt*B)", "ratio = (bt*A + bn*B)/(bn*C - bt*B)")),
    ("ratio", ('ratio = -case["MU"] if vrt > 0 else case["MU"]',
               'ratio = case["MU"] if vrt > 0 else -case["MU"]')),
    ("ratio", ("z1, z2 = dc - ratio*dd, db - ratio*da", "z1, z2 = dc + ratio*dd, db - ratio*da")),
    ("ratio", ("slope = z1/J1 - z2/J2", "slope = z1/J1 + z2/J2")),
    ("ratio", ("Pn = mbar*bn/(1 + mbar*(dc*z1", "Pn = mbar*bn/(1 - mbar*(dc*z1")),
    ("ratio", ("- kap*un*slope))", "+ kap*un*slope))")),
    ("ratio", ("db*z2/(m2*k2sq) - kap", "db*z2/(m2*k1sq) - kap")),
    ("ratio", ("W2 = O2 + (z2*Pn - T)/J2", "W2 = O2 - (z2*Pn - T)/J2")),
    ("ratio", ("W1 = O1 + (z1*Pn + T)/J1", "W1 = O1 + (z1*Pn + T)/J2")),
    ("ratio", ("VAX=V1n*cos(G) - V1t*sin(G)", "VAX=V1n*cos(G) + V1t*sin(G)")),
    ("ratio", ("rad = pi/180", "rad = 0.01745")),
    ("complex", ('turn = cmath.exp(-1j*radians(case["GA"]))',
                 'turn = cmath.exp(1j*radians(case["GA"]))')),
    ("complex", ("zb = lb*cmath.exp", "zb = -lb*cmath.exp")),
    ("complex", ("(z.conjugate()*p).imag", "(z*p).imag")),
    ("complex", ("(z.conjugate()*p).imag", "(z.conjugate()*p).real")),
    ("complex", ("(va + 1j*oa*za) - (vb + 1j*ob*zb)", "(va + 1j*oa*za) - (vb - 1j*ob*zb)")),
    ("complex", ("(va + 1j*oa*za) - (vb + 1j*ob*zb)", "(va - 1j*oa*za) - (vb - 1j*ob*zb)")),
    ("complex", ("ob = -(torque(zb, p) + moment)/jb", "ob = (torque(zb, p) + moment)/jb")),
    ("complex", ("ob = -(torque(zb, p) + moment)/jb", "ob = -(torque(zb, p) - moment)/jb")),
    ("complex", ("return gap(p/ma, oa, -p/mb, ob)", "return gap(p/ma, oa, -p/ma, ob)")),
    ("complex", ('target = -(1 + case["E"])*approach.real',
                 'target = -(1 + sqrt(case["E"]))*approach.real')),
    ("complex", ('mu = -case["MU"] if approach.imag > 0', 'mu = -case["MU"] if approach.real > 0')),
    ("complex", ('mu = -case["MU"] if approach.imag > 0', 'mu = -case["MU"] if (u - w).imag > 0')),
    ("complex", ("det = g.real*diagonal - moving.real*share*k",
                 "det = g.real*diagonal + moving.real*share*k")),
    ("complex", ("pm = (-g.real*share*spin - share*k*target)/det",
                 "pm = (-g.real*share*spin + share*k*target)/det")),
    ("complex", ("diagonal = share*turning - em*(1/ja + 1/jb)",
                 "diagonal = share*turning - em/(ja + jb)")),
    ("complex", ("oa = wa + (torque(za, p) + pm)/ja", "oa = wa + (torque(za, p) - pm)/ja")),
    ("complex", ("mean = (approach + gap(ua, oa, ub, ob))/2",
     "mean = approach + gap(ua, oa, ub, ob)")),
    ("complex", ("pm*((wa - wb) + (oa - ob))/2", "pm*((wa - wb) - (oa - ob))/2")),
    ("complex", ("ca, cb = (ua + 1j*oa*za)/turn", "ca, cb = (ua + 1j*wa*za)/turn")),
    ("complex", ("a, b = ua/turn, ub/turn", "a, b = ua*turn, ub*turn")),
    ("complex", ("[share*sn, share*st, share*turning", "[share*st, share*sn, share*turning")),
    ("complex", ("target, -approach.imag, -share*spin", "target, 0, -share*spin")),
    ("complex", ("share = 1 - em", "share = 1 - em**2")),
]  # fmt: skip

PAIRS: list[tuple[str, Bug, Bug]] = [
    ("jacobian", ("r1[0]*n[1] - r1[1]*n[0], -n[0]", "r1[1]*n[0] - r1[0]*n[1], -n[0]"),
     ("rhs[0] = -(1 + e)*u[0]", "rhs[0] = -(1 - e)*u[0]")),
    ("jacobian", ("[f if u[1] > 0 else -f, 1, 0]", "[-f if u[1] > 0 else f, 1, 0]"),
     ("DVA=np.linalg.norm(v[:2] - q[:2])", "DVA=np.linalg.norm(v[:2])")),
    ("jacobian", ("rhs[2] = -(1 - em)*u[2]", "rhs[2] = (1 - em)*u[2]"),
     ("rhs[0] = -(1 + e)*u[0]", "rhs[0] = -e*u[0]")),
    ("jacobian", ("K[2, 2] -= em*(inv[2] + inv[5])", "K[2, 2] += em*(inv[2] + inv[5])"),
     ("[f if u[1] > 0 else -f, 1, 0]", "[f, 1, 0]")),
    ("jacobian", ('mass = np.array([case["MA"], case["MB"]])',
                  'mass = np.array([case["MA"], case["MB"]])/32.174'),
     ("100*(ke0 - ke1)/ke0", "(ke0 - ke1)/ke0")),
    ("jacobian", ('case["UX"], case["UY"], case["WA"]', 'case["UX"], case["UY"], -case["WA"]'),
     ("rhs[1] = -u[1]", "rhs[1] = u[1]")),
    ("ratio", ("vrn = (v1n + dc*O1) - (v2n - db*O2)", "vrn = v1n - v2n"),
     ("W2 = O2 + (z2*Pn - T)/J2", "W2 = O2 + (z2*Pn + T)/J2")),
    ("ratio", ('ratio = -case["MU"] if vrt > 0 else case["MU"]', 'ratio = case["MU"]'),
     ("W1 = O1 + (z1*Pn + T)/J1", "W1 = O1 + z1*Pn/J1")),
    ("ratio", ("kap = (1 - em)/(1 - 2*em)*Jbar", "kap = (1 + em)/(1 - 2*em)*Jbar"),
     ("VBY=V2n*sin(G) + V2t*cos(G)", "VBY=V2n*sin(G) - V2t*cos(G)")),
    ("ratio", ("vrt = (v1t - dd*O1) - (v2t + da*O2)", "vrt = v1t - v2t"),
     ('k1sq, k2sq = case["IA"]/m1, case["IB"]/m2', 'k1sq, k2sq = case["IB"]/m1, case["IA"]/m2')),
    ("ratio", ('G = case["GA"]*rad', 'G = (case["GA"] + 90)*rad'),
     ("V2n, V2t = v2n - Pn/m2, v2t - Pt/m2", "V2n, V2t = v2n - Pn/m2, v2t + Pt/m2")),
    ("complex", ("(va + 1j*oa*za) - (vb + 1j*ob*zb)", "(va + 1j*oa*za) - (vb - 1j*ob*zb)"),
     ("share = 1 - em", "share = 1 + em")),
    ("complex", ('target = -(1 + case["E"])*approach.real',
                 'target = -(1 + case["E"]**2)*approach.real'),
     ("LOSS=-100*work/ki", "LOSS=100*work/ki")),
    ("complex", ("ob = wb - (torque(zb, p) + pm)/jb", "ob = wb - (torque(zb, p) - pm)/jb"),
     ('mu = -case["MU"] if approach.imag > 0', 'mu = -case["MU"] if approach.imag < 0')),
    ("complex", ('wa, wb = case["WA"], case["WB"]',
     'wa, wb = radians(case["WA"]), radians(case["WB"])'),
     ("target, -approach.imag, -share*spin", "target, 0, -share*spin")),
    ("complex", ("ua, ub = u + p/ma, w - p/mb", "ua, ub = u + p/ma, w + p/mb"),
     ("PN=p.real, PT=p.imag", "PN=p.imag, PT=p.real")),
    ("complex", ("oa = wa + (torque(za, p) + pm)/ja", "oa = wa + (torque(za, p) + pm)/jb"),
     ("(0 if point else (ja*wa**2 + jb*wb**2)/2)", "0")),
]  # fmt: skip
