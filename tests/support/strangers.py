"""Bugs in programs that are written in no spelling the search knows: by a Jacobian and masses in
matrices; by textbook lever arms and an impulse ratio; in complex numbers, with the impulses' work;
as nine equations at once; by vectors.

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

# a class of vehicle and four unknowns; temporaries of a C program in the contact frame
FOUR = """
class Car:
    def __init__(self, m, i, d, ang, vx, vy, w, side):
        self.m, self.i, self.w = m, i, w
        self.v = np.array([vx, vy])
        self.r = side*d*np.array([cos(ang), sin(ang)])
    def contact(self):
        return self.v + self.w*np.array([-self.r[1], self.r[0]])
    def lever(self, direction):
        return self.r[0]*direction[1] - self.r[1]*direction[0]

def run(case):
    light = case["M"] == 4
    D = pi/180.0
    A = Car(case["MA"], 1.0 if light else case["IA"], 0.0 if light else case["DA"],
            (case["TA"] + case["PA"])*D, case["UX"], case["UY"], case["WA"], -1)
    B = Car(case["MB"], 1.0 if light else case["IB"], 0.0 if light else case["DB"],
            (case["TB"] + case["PB"])*D, case["VX"], case["VY"], case["WB"], +1)
    em = 1.0 if light else case["EM"]
    n = np.array([cos(case["GA"]*D), sin(case["GA"]*D)])
    t = np.array([-n[1], n[0]])
    slip = A.contact() - B.contact()
    closing, sliding = slip @ n, slip @ t
    la, lb = A.lever(n), B.lever(n)
    ta, tb = A.lever(t), B.lever(t)
    k = A.m/B.m
    L = np.zeros((4, 4)); R = np.zeros(4)
    L[0, :2] = (1 + k)*n
    L[0, 2], L[0, 3] = la, -lb
    R[0] = -case["E"]*closing + n @ (B.v + k*A.v)
    if case["MU"] == -10:
        L[1, :2] = (1 + k)*t
        L[1, 2], L[1, 3] = ta, -tb
        R[1] = t @ (B.v + k*A.v)
    else:
        sign = 1 if sliding > 0 else -1
        push = t + sign*case["MU"]*n
        L[1, :2] = push
        R[1] = push @ A.v
    turn = (la - lb)*n + (ta - tb)*t
    L[2, :2] = -A.m*turn
    L[2, 2], L[2, 3] = A.i, B.i
    R[2] = A.i*A.w + B.i*B.w - A.m*(turn @ A.v)
    q = em*(A.i + B.i)/(A.i*B.i)
    spin = la*n + ta*t
    L[3, :2] = -q*A.m*spin
    L[3, 2], L[3, 3] = q*A.i - (1 - em), 1 - em
    R[3] = q*(A.i*A.w - A.m*(spin @ A.v))
    x = np.linalg.solve(L, R)
    va = x[:2]
    vb = B.v - k*(va - A.v)
    dv = va - A.v
    return dict(VAX=va[0], VAY=va[1], VBX=vb[0], VBY=vb[1], WAF=x[2], WBF=x[3],
                PN=A.m*(dv @ n), PT=A.m*(dv @ t), DVA=sqrt(dv @ dv), DVB=k*sqrt(dv @ dv))
"""
CISH = """
def run(p):
    RAD = 57.29577951308232
    t0 = p["GA"]/RAD; c = cos(t0); s = sin(t0)
    point = p["M"] == 4
    e1 = 1.0 if point else p["EM"]
    ja = 1.0 if point else p["IA"]; jb = 1.0 if point else p["IB"]
    # rotate everything to the contact frame
    t1 = c*p["UX"] + s*p["UY"]; t2 = c*p["UY"] - s*p["UX"]
    t3 = c*p["VX"] + s*p["VY"]; t4 = c*p["VY"] - s*p["VX"]
    t5 = (p["TA"] + p["PA"])/RAD - t0
    xa = 0.0 if point else p["DA"]*cos(t5); ya = 0.0 if point else p["DA"]*sin(t5)
    t5 = (p["TB"] + p["PB"])/RAD - t0
    xb = 0.0 if point else p["DB"]*cos(t5); yb = 0.0 if point else p["DB"]*sin(t5)
    # closing and sliding
    g1 = t1 + ya*p["WA"] - t3 + yb*p["WB"]
    g2 = t2 - xa*p["WA"] - t4 - xb*p["WB"]
    t6 = 1/p["MA"] + 1/p["MB"]
    a11 = t6 + ya*ya/ja + yb*yb/jb
    a12 = -ya*xa/ja - yb*xb/jb
    a22 = t6 + xa*xa/ja + xb*xb/jb
    # third: spin against spin
    b1 = ya/ja - yb/jb; b2 = xb/jb - xa/ja; b3 = 1/ja + 1/jb
    r1 = -(1 + p["E"])*g1; r2 = -g2; r3 = (e1 - 1)*(p["WA"] - p["WB"])
    t7 = 1 - e1
    h1 = t7*b1; h2 = t7*b2; h3 = t7*b3 - e1*b3
    if p["MU"] != -10:
        mu = p["MU"] if g2 <= 0 else -p["MU"]
        t8 = a11 + mu*a12; t9 = h1 + mu*h2
        t10 = t8*h3 - b1*t9
        pn = (r1*h3 - b1*r3)/t10; pm = (t8*r3 - t9*r1)/t10
        pt = mu*pn
    else:
        # cofactors
        t8 = a22*h3 - b2*h2; t9 = a12*h3 - b2*h1; t10 = a12*h2 - a22*h1
        t11 = a11*t8 - a12*t9 + b1*t10
        pn = (r1*t8 - a12*(r2*h3 - b2*r3) + b1*(r2*h2 - a22*r3))/t11
        pt = (a11*(r2*h3 - b2*r3) - r1*t9 + b1*(a12*r3 - r2*h1))/t11
        pm = (a11*(a22*r3 - r2*h2) - a12*(a12*r3 - r2*h1) + r1*t10)/t11
    if point: pm = 0.0
    t1 += pn/p["MA"]; t2 += pt/p["MA"]; t3 -= pn/p["MB"]; t4 -= pt/p["MB"]
    w1 = p["WA"] + (ya*pn - xa*pt + pm)/ja
    w2 = p["WB"] + (yb*pn - xb*pt - pm)/jb
    return dict(VAX=c*t1 - s*t2, VAY=s*t1 + c*t2, VBX=c*t3 - s*t4, VBY=s*t3 + c*t4, WAF=w1, WBF=w2,
                XAF=c*(t1 + ya*w1) - s*(t2 - xa*w1), YAF=s*(t1 + ya*w1) + c*(t2 - xa*w1))
"""

# effective masses over arrays; a spreadsheet's columns; SI units and unit responses
PERC = """
def run(row):
    g = np.radians(row["GA"])
    frame = np.array([[np.cos(g), np.sin(g)], [-np.sin(g), np.cos(g)]])
    plain = row["M"] == 4
    m = np.array([row["MA"], row["MB"]])
    J = np.ones(2) if plain else np.array([row["IA"], row["IB"]])
    d = np.zeros(2) if plain else np.array([row["DA"], row["DB"]])
    em = 1.0 if plain else row["EM"]
    k2 = J/m
    a = np.radians(np.array([row["TA"] + row["PA"], row["TB"] + row["PB"]]))
    xy = np.vstack([d*np.cos(a), d*np.sin(a)])*np.array([-1.0, 1.0])
    r = frame @ xy
    U = frame @ np.array([[row["UX"], row["VX"]], [row["UY"], row["VY"]]])
    om = np.array([row["WA"], row["WB"]])
    tip = U + om*np.vstack([-r[1], r[0]])
    rel = tip[:, 0] - tip[:, 1]
    hn = -r[1]
    ht = r[0]
    dom = om[0] - om[1]
    side = np.array([1.0, -1.0])
    jj = 1/np.sum(1/J)
    couple = (1 - em)/(1 - 2*em)*jj
    # a unit of normal impulse, as if the mass stood at the contact
    eff_n = np.sum((1 + hn*hn/k2)/m)
    eff_t = np.sum((1 + ht*ht/k2)/m)
    eff_x = np.sum(hn*ht/k2/m)
    T0 = -couple*dom
    # the line of impact
    sn, st = np.sum(hn/J), np.sum(ht/J)
    need = -(1 + row["E"])*rel[0] - sn*T0
    if row["MU"] == -10:
        stop = -rel[1] - st*T0
        A = np.array([[eff_n - couple*sn*sn, eff_x - couple*sn*st],
                      [eff_x - couple*sn*st, eff_t - couple*st*st]])
        S = np.linalg.inv(A) @ np.array([need, stop])
    else:
        tilt = -np.sign(rel[1])*row["MU"] if rel[1] != 0 else row["MU"]
        line = np.array([1.0, tilt])
        h = line @ np.vstack([hn, ht])
        gamma = k2/(k2 + h*hn)
        S = line*need/(np.sum(1/(gamma*m)) - couple*sn*np.sum(h/J))
    T = 0.0 if plain else T0 - couple*(sn*S[0] + st*S[1])
    V = U + np.outer(S, side/m)
    om2 = om + side*(hn*S[0] + ht*S[1] + T)/J
    out = frame.T @ V
    dv = np.hypot(*(V - U))
    before = np.sum(m*np.sum(U**2, axis=0))/2 + (0 if plain else np.sum(J*om**2)/2)
    after = np.sum(m*np.sum(V**2, axis=0))/2 + (0 if plain else np.sum(J*om2**2)/2)
    return dict(VAX=out[0, 0], VAY=out[1, 0], VBX=out[0, 1], VBY=out[1, 1], WAF=om2[0], WBF=om2[1],
                DVA=dv[0], DVB=dv[1], LOSS=100*(before - after)/before, PN=S[0], PT=S[1])
"""
SHEET = """
def run(R):
    B2 = R["GA"]*pi/180
    C2 = 0 if R["M"] == 4 else R["DA"]
    D2 = 0 if R["M"] == 4 else R["DB"]
    E2 = 1 if R["M"] == 4 else R["EM"]
    F2 = 1 if R["M"] == 4 else 1/R["IA"]
    G2 = 1 if R["M"] == 4 else 1/R["IB"]
    H2 = 1/R["MA"]
    I2 = 1/R["MB"]
    # contact point from each centre
    J2 = -C2*cos((R["TA"] + R["PA"])*pi/180)
    K2 = -C2*sin((R["TA"] + R["PA"])*pi/180)
    L2 = D2*cos((R["TB"] + R["PB"])*pi/180)
    M2 = D2*sin((R["TB"] + R["PB"])*pi/180)
    # contact velocities, x and y
    N2 = R["UX"] - R["WA"]*K2
    O2 = R["UY"] + R["WA"]*J2
    P2 = R["VX"] - R["WB"]*M2
    Q2 = R["VY"] + R["WB"]*L2
    # difference along normal and tangent
    R2 = (N2 - P2)*cos(B2) + (O2 - Q2)*sin(B2)
    S2 = (O2 - Q2)*cos(B2) - (N2 - P2)*sin(B2)
    T2 = R["WA"] - R["WB"]
    # compliance in x and y with no moment
    U2 = H2 + I2 + K2^2*F2 + M2^2*G2
    V2 = -J2*K2*F2 - L2*M2*G2
    W2 = H2 + I2 + J2^2*F2 + L2^2*G2
    # spin per impulse
    X2 = -K2*F2 - M2*G2
    Y2 = J2*F2 + L2*G2
    Z2 = (1 - E2)/((1 - 2*E2)*(F2 + G2))
    # compliance with the moment's share
    AA2 = U2 - Z2*X2^2
    AB2 = V2 - Z2*X2*Y2
    AC2 = W2 - Z2*Y2^2
    # to normal and tangent
    AD2 = AA2*cos(B2)^2 + 2*AB2*cos(B2)*sin(B2) + AC2*sin(B2)^2
    AE2 = (AC2 - AA2)*cos(B2)*sin(B2) + AB2*(cos(B2)^2 - sin(B2)^2)
    AF2 = AA2*sin(B2)^2 - 2*AB2*cos(B2)*sin(B2) + AC2*cos(B2)^2
    AG2 = -(1 + R["E"])*R2 + Z2*T2*(X2*cos(B2) + Y2*sin(B2))
    AH2 = -S2 + Z2*T2*(Y2*cos(B2) - X2*sin(B2))
    # friction: impulse ratio
    AI2 = R["MU"] if S2 <= 0 else -R["MU"]
    AJ2 = (AG2*AF2 - AH2*AE2)/(AD2*AF2 - AE2^2) if R["MU"] == -10 else AG2/(AD2 + AI2*AE2)
    AK2 = (AH2*AD2 - AG2*AE2)/(AD2*AF2 - AE2^2) if R["MU"] == -10 else AI2*AJ2
    AL2 = AJ2*cos(B2) - AK2*sin(B2)
    AM2 = AJ2*sin(B2) + AK2*cos(B2)
    AN2 = 0 if R["M"] == 4 else -Z2*(T2 + X2*AL2 + Y2*AM2)
    # after
    AO2 = R["UX"] + AL2*H2
    AP2 = R["UY"] + AM2*H2
    AQ2 = R["VX"] - AL2*I2
    AR2 = R["VY"] - AM2*I2
    AS2 = R["WA"] + F2*(J2*AM2 - K2*AL2 + AN2)
    AT2 = R["WB"] - G2*(L2*AM2 - M2*AL2 + AN2)
    AU2 = (R["MA"]*(R["UX"]^2 + R["UY"]^2) + R["MB"]*(R["VX"]^2 + R["VY"]^2))/2
    AV2 = 0 if R["M"] == 4 else (R["WA"]^2/F2 + R["WB"]^2/G2)/2
    AW2 = (R["MA"]*(AO2^2 + AP2^2) + R["MB"]*(AQ2^2 + AR2^2))/2
    AX2 = 0 if R["M"] == 4 else (AS2^2/F2 + AT2^2/G2)/2
    AY2 = 100*(1 - (AW2 + AX2)/(AU2 + AV2))
    return dict(VAX=AO2, VAY=AP2, VBX=AQ2, VBY=AR2, WAF=AS2, WBF=AT2,
                KI=AU2 + AV2, KF=AW2 + AX2, LOSS=AY2)
""".replace("^", "**")
SI = """
SLUG, FOOT = 14.59390294, 0.3048
def run(inp):
    deg = 0.017453292519943295
    pm = inp["M"] == 4
    m1 = inp["MA"]*SLUG; m2 = inp["MB"]*SLUG
    i1 = inp["IA"]*SLUG*FOOT*FOOT; i2 = inp["IB"]*SLUG*FOOT*FOOT
    if pm: i1 = 1.0; i2 = 1.0
    em = inp["EM"]
    if pm: em = 1.0
    l1 = inp["DA"]*FOOT; l2 = inp["DB"]*FOOT
    if pm: l1 = 0.0; l2 = 0.0
    x1 = -l1*cos(deg*(inp["TA"] + inp["PA"])); y1 = -l1*sin(deg*(inp["TA"] + inp["PA"]))
    x2 = l2*cos(deg*(inp["TB"] + inp["PB"])); y2 = l2*sin(deg*(inp["TB"] + inp["PB"]))
    nx = cos(deg*inp["GA"]); ny = sin(deg*inp["GA"])
    start = [inp["UX"]*FOOT, inp["UY"]*FOOT, inp["WA"], inp["VX"]*FOOT, inp["VY"]*FOOT, inp["WB"]]

    def kick(s, px, py, tq):
        s = list(s)
        s[0] += px/m1
        s[1] += py/m1
        s[2] += (x1*py - y1*px + tq)/i1
        s[3] -= px/m2
        s[4] -= py/m2
        s[5] -= (x2*py - y2*px + tq)/i2
        return s
    def normal(s):
        vx = (s[0] - s[2]*y1) - (s[3] - s[5]*y2)
        vy = (s[1] + s[2]*x1) - (s[4] + s[5]*x2)
        return vx*nx + vy*ny
    def slide(s):
        vx = (s[0] - s[2]*y1) - (s[3] - s[5]*y2)
        vy = (s[1] + s[2]*x1) - (s[4] + s[5]*x2)
        return vy*nx - vx*ny
    def twist(s):
        return s[2] - s[5]
    zero = [0.0]*6
    ir = i1*i2/(i1 + i2)
    part = (1.0 - em)/(1.0 - 2.0*em)
    def with_moment(s, before):
        # the moment takes its part of the relative spin
        return kick(s, 0.0, 0.0, -part*ir*(twist(s) - 0.0*before))
    base = with_moment(start, 0)
    dn = with_moment(kick(zero, nx, ny, 0.0), 0)
    dt = with_moment(kick(zero, -ny, nx, 0.0), 0)
    want = -inp["E"]*normal(start) - normal(base)
    if inp["MU"] > -10 or inp["MU"] < -10:
        f = inp["MU"]
        if slide(start) > 0.0: f = -f
        pn = want/(normal(dn) + f*normal(dt))
        pt = f*pn
    else:
        det = normal(dn)*slide(dt) - normal(dt)*slide(dn)
        pn = (want*slide(dt) + slide(base)*normal(dt))/det
        pt = (-slide(base)*normal(dn) - want*slide(dn))/det
    px = pn*nx - pt*ny; py = pn*ny + pt*nx
    end = kick(start, px, py, 0.0)
    if not pm: end = with_moment(end, 0)
    e0 = 0.5*m1*(start[0]**2 + start[1]**2) + 0.5*m2*(start[3]**2 + start[4]**2)
    e1 = 0.5*m1*(end[0]**2 + end[1]**2) + 0.5*m2*(end[3]**2 + end[4]**2)
    if not pm:
        e0 += 0.5*i1*start[2]**2 + 0.5*i2*start[5]**2
        e1 += 0.5*i1*end[2]**2 + 0.5*i2*end[5]**2
    return dict(VAX=end[0]/FOOT, VAY=end[1]/FOOT, WAF=end[2], VBX=end[3]/FOOT, VBY=end[4]/FOOT,
                WBF=end[5],
                XAF=(end[0] - end[2]*y1)/FOOT, YAF=(end[1] + end[2]*x1)/FOOT,
                XBF=(end[3] - end[5]*y2)/FOOT, YBF=(end[4] + end[5]*x2)/FOOT,
                DVA=hypot(end[0] - start[0], end[1] - start[1])/FOOT, LOSS=100.0*(e0 - e1)/e0)
"""

# nine equations at once: momenta, restitution, friction, moment
KKT = """
def run(s):
    deg = pi/180.0
    point = s["M"] == 4
    a, b = s["TA"] + s["PA"], s["TB"] + s["PB"]
    rad_a, rad_b = (0.0, 0.0) if point else (s["DA"], s["DB"])
    # contact point seen from the mass centers
    cax, cay = -rad_a*cos(a*deg), -rad_a*sin(a*deg)
    cbx, cby = rad_b*cos(b*deg), rad_b*sin(b*deg)
    g = s["GA"]*deg
    ex, ey = cos(g), sin(g)
    ia, ib = (1.0, 1.0) if point else (s["IA"], s["IB"])
    em = 1.0 if point else s["EM"]
    # relative velocity at the contact point
    dx = s["UX"] - s["WA"]*cay - s["VX"] + s["WB"]*cby
    dy = s["UY"] + s["WA"]*cax - s["VY"] - s["WB"]*cbx
    approach = dx*ex + dy*ey
    sliding = dy*ex - dx*ey
    A = np.zeros((9, 9)); y = np.zeros(9)
    # momentum of each body: m V - P = m U
    A[0, 0] = s["MA"]; A[0, 6] = -1; y[0] = s["MA"]*s["UX"]
    A[1, 1] = s["MA"]; A[1, 7] = -1; y[1] = s["MA"]*s["UY"]
    A[2, 3] = s["MB"]; A[2, 6] = 1; y[2] = s["MB"]*s["VX"]
    A[3, 4] = s["MB"]; A[3, 7] = 1; y[3] = s["MB"]*s["VY"]
    # spin: I W - (c x P) - T = I w
    A[4, 2] = ia; A[4, 6] = cay; A[4, 7] = -cax; A[4, 8] = -1; y[4] = ia*s["WA"]
    A[5, 5] = ib; A[5, 6] = -cby; A[5, 7] = cbx; A[5, 8] = 1; y[5] = ib*s["WB"]
    # restitution
    A[6, 0] = ex; A[6, 1] = ey; A[6, 2] = -cay*ex + cax*ey
    A[6, 3] = -ex; A[6, 4] = -ey; A[6, 5] = cby*ex - cbx*ey
    y[6] = -s["E"]*approach
    # friction, or no sliding afterwards
    if s["MU"] == -10:
        A[7, 0] = -ey; A[7, 1] = ex; A[7, 2] = cay*ey + cax*ex
        A[7, 3] = ey; A[7, 4] = -ex; A[7, 5] = -cby*ey - cbx*ex
    else:
        mu = -s["MU"] if sliding > 0 else s["MU"]
        A[7, 6] = -ey - mu*ex; A[7, 7] = ex - mu*ey
    # moment
    red = 1.0/(1.0/ia + 1.0/ib)
    A[8, 8] = em
    A[8, 2] = -(1.0 - em)*red; A[8, 5] = (1.0 - em)*red
    x = np.linalg.solve(A, y)
    before = 0.5*s["MA"]*(s["UX"]**2 + s["UY"]**2) + 0.5*s["MB"]*(s["VX"]**2 + s["VY"]**2)
    after = 0.5*s["MA"]*(x[0]**2 + x[1]**2) + 0.5*s["MB"]*(x[3]**2 + x[4]**2)
    if not point:
        before += 0.5*ia*s["WA"]**2 + 0.5*ib*s["WB"]**2
        after += 0.5*ia*x[2]**2 + 0.5*ib*x[5]**2
    return dict(VAX=x[0], VAY=x[1], VBX=x[3], VBY=x[4], WAF=x[2], WBF=x[5],
                DVA=hypot(x[0] - s["UX"], x[1] - s["UY"]),
                DVB=hypot(x[3] - s["VX"], x[4] - s["VY"]),
                LOSS=100.0*(before - after)/before)
"""

# vectors, and the matrix of what an impulse at the contact point changes there
VEC = """
def rot(v):
    return np.array([-v[1], v[0]])

def run(s):
    unit = lambda d: np.array([np.cos(np.radians(d)), np.sin(np.radians(d))])
    point = s["M"] == 4
    n = unit(s["GA"]); t = rot(n)
    ca = -(0 if point else s["DA"])*unit(s["TA"] + s["PA"])
    cb = (0 if point else s["DB"])*unit(s["TB"] + s["PB"])
    wA, wB = (0.0, 0.0) if point else (1/s["IA"], 1/s["IB"])
    u = np.array([s["UX"], s["UY"]]); v = np.array([s["VX"], s["VY"]])
    g = (u + s["WA"]*rot(ca)) - (v + s["WB"]*rot(cb))
    # what an impulse at the contact point changes of the velocity there
    K = (1/s["MA"] + 1/s["MB"])*np.eye(2)
    K = K + wA*np.outer(rot(ca), rot(ca)) + wB*np.outer(rot(cb), rot(cb))
    h = wA*rot(ca) + wB*rot(cb)
    share = 0.0
    if not point:
        share = (1 - s["EM"])/(1 - 2*s["EM"])/(wA + wB)
        K = K - share*np.outer(h, h)
    spin = s["WA"] - s["WB"]
    goal = g - share*spin*h
    want = -s["E"]*(g @ n) - goal @ n
    if s["MU"] != -10:
        along = n - np.sign(g @ t)*s["MU"]*t if g @ t != 0 else n + s["MU"]*t
        P = want/(n @ K @ along)*along
    else:
        rows = np.array([n @ K, t @ K])
        P = np.linalg.solve(rows, np.array([want, -(goal @ t)]))
    T = -share*(spin + h @ P)
    U = u + P/s["MA"]; V = v - P/s["MB"]
    WA = s["WA"] + wA*(rot(ca) @ P + T)
    WB = s["WB"] - wB*(rot(cb) @ P + T)
    return dict(VAX=U[0], VAY=U[1], VBX=V[0], VBY=V[1], WAF=WA, WBF=WB)
"""

PROGRAMS = {
    **{"jacobian": JACOBIAN, "ratio": RATIO, "complex": COMPLEX},
    **{"four": FOUR, "cish": CISH},
    **{"perc": PERC, "sheet": SHEET, "si": SI},
    **{"kkt": KKT, "vec": VEC},
}
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
    ("four", ("np.array([-self.r[1], self.r[0]])", "np.array([self.r[1], -self.r[0]])")),
    ("four", ("self.r[0]*direction[1] - self.r[1]*direction[0]",
      "self.r[0]*direction[1] + self.r[1]*direction[0]")),
    ("four", ('case["VX"], case["VY"], case["WB"], +1)',
      'case["VX"], case["VY"], case["WB"], -1)')),
    ("four", ('em = 1.0 if light else case["EM"]', 'em = 1.0 if light else -case["EM"]')),
    ("four", ("closing, sliding = slip @ n, slip @ t", "closing, sliding = slip @ t, slip @ n")),
    ("four", ("k = A.m/B.m", "k = B.m/A.m")),
    ("four", ("L[0, 2], L[0, 3] = la, -lb", "L[0, 2], L[0, 3] = la, lb")),
    ("four", ("L[0, 2], L[0, 3] = la, -lb", "L[0, 2], L[0, 3] = 0, 0")),
    ("four", ("*closing + n @ (B.v + k*A.v)", "*closing + n @ (A.v + k*B.v)")),
    ("four", ("L[1, 2], L[1, 3] = ta, -tb", "L[1, 2], L[1, 3] = la, -lb")),
    ("four", ("R[1] = t @ (B.v + k*A.v)", "R[1] = -sliding + t @ (B.v + k*A.v)")),
    ("four", ("sign = 1 if sliding > 0 else -1", "sign = -1 if sliding > 0 else 1")),
    ("four", ("sign = 1 if sliding > 0 else -1", "sign = 1 if closing > 0 else -1")),
    ("four", ("turn = (la - lb)*n + (ta - tb)*t", "turn = (la + lb)*n + (ta + tb)*t")),
    ("four", ("turn = (la - lb)*n + (ta - tb)*t", "turn = (la - lb)*n - (ta - tb)*t")),
    ("four", ("R[2] = A.i*A.w + B.i*B.w - A.m*(turn @ A.v)",
      "R[2] = A.i*A.w + B.i*B.w + A.m*(turn @ A.v)")),
    ("four", ("q = em*(A.i + B.i)/(A.i*B.i)", "q = em*(A.i*B.i)/(A.i + B.i)")),
    ("four", ("q = em*(A.i + B.i)/(A.i*B.i)", "q = em/(A.i + B.i)")),
    ("four", ("q*A.i - (1 - em), 1 - em", "q*A.i - (1 - em), em - 1")),
    ("four", ("R[3] = q*(A.i*A.w", "R[3] = q*(A.i*B.w")),
    ("four", ("vb = B.v - k*(va - A.v)", "vb = B.v + k*(va - A.v)")),
    ("four", ("DVB=k*sqrt(dv @ dv)", "DVB=sqrt(dv @ dv)/k")),
    ("four", ("spin = la*n + ta*t", "spin = ta*n + la*t")),
    ("cish", ("RAD = 57.29577951308232", "RAD = 57.3")),
    ("cish", ('t1 = c*p["UX"] + s*p["UY"]', 't1 = c*p["UX"] - s*p["UY"]')),
    ("cish", ('t4 = c*p["VY"] - s*p["VX"]', 't4 = c*p["VY"] - s*p["UX"]')),
    ("cish", ('t5 = (p["TA"] + p["PA"])/RAD - t0', 't5 = (p["TA"] + p["PA"])/RAD')),
    ("cish", ('t5 = (p["TB"] + p["PB"])/RAD - t0', 't5 = (p["TB"] + p["PA"])/RAD - t0')),
    ("cish", ('g1 = t1 + ya*p["WA"] - t3 + yb*p["WB"]', 'g1 = t1 + ya*p["WA"] - t3 - yb*p["WB"]')),
    ("cish", ('g2 = t2 - xa*p["WA"] - t4 - xb*p["WB"]', 'g2 = t2 - xa*p["WA"] - t4 + xb*p["WB"]')),
    ("cish", ("a11 = t6 + ya*ya/ja + yb*yb/jb", "a11 = t6 + ya*ya/ja - yb*yb/jb")),
    ("cish", ("a12 = -ya*xa/ja - yb*xb/jb", "a12 = ya*xa/ja + yb*xb/jb")),
    ("cish", ("a22 = t6 + xa*xa/ja + xb*xb/jb", "a22 = t6 + xa*xa/ja")),
    ("cish", ("b1 = ya/ja - yb/jb", "b1 = ya/ja + yb/jb")),
    ("cish", ("b2 = xb/jb - xa/ja", "b2 = xa/ja - xb/jb")),
    ("cish", ("r1 = -(1 + p[\"E\"])*g1", "r1 = -(1 - p[\"E\"])*g1")),
    ("cish", ('r3 = (e1 - 1)*(p["WA"] - p["WB"])', 'r3 = (1 - e1)*(p["WA"] - p["WB"])')),
    ("cish", ("h3 = t7*b3 - e1*b3", "h3 = t7*b3 + e1*b3")),
    ("cish", ("t8 = a11 + mu*a12; t9 = h1 + mu*h2", "t8 = a11 + mu*a12; t9 = h1 - mu*h2")),
    ("cish", ("t10 = t8*h3 - b1*t9", "t10 = t8*h3 + b1*t9")),
    ("cish", ("t11 = a11*t8 - a12*t9 + b1*t10", "t11 = a11*t8 - a12*t9 - b1*t10")),
    ("cish", ("mu = p[\"MU\"] if g2 <= 0 else -p[\"MU\"]",
      "mu = abs(p[\"MU\"]) if g2 <= 0 else -abs(p[\"MU\"])")),
    ("cish", ("t3 -= pn/p[\"MB\"]; t4 -= pt/p[\"MB\"]", "t3 -= pn/p[\"MB\"]; t4 += pt/p[\"MB\"]")),
    ("cish", ("w1 = p[\"WA\"] + (ya*pn - xa*pt + pm)/ja",
      "w1 = p[\"WA\"] + (ya*pn - xa*pt)/ja + pm")),
    ("cish", ("w2 = p[\"WB\"] + (yb*pn - xb*pt - pm)/jb",
      "w2 = p[\"WB\"] + (yb*pn + xb*pt - pm)/jb")),
    ("cish", ("VAY=s*t1 + c*t2", "VAY=s*t1 - c*t2")),
    ("perc", ("[-np.sin(g), np.cos(g)]]", "[np.sin(g), np.cos(g)]]")),
    ("perc", ("*np.array([-1.0, 1.0])", "*np.array([1.0, 1.0])")),
    ("perc", ("tip = U + om*np.vstack([-r[1], r[0]])", "tip = U + om*np.vstack([r[1], r[0]])")),
    ("perc", ("tip = U + om*np.vstack([-r[1], r[0]])", "tip = U")),
    ("perc", ("ht = r[0]\n", "ht = -r[0]\n")),
    ("perc", ("dom = om[0] - om[1]", "dom = om[1] - om[0]")),
    ("perc", ("couple = (1 - em)/(1 - 2*em)*jj", "couple = (1 - em)/(1 - em*em)*jj")),
    ("perc", ("jj = 1/np.sum(1/J)", "jj = np.sum(J)")),
    ("perc", ("gamma = k2/(k2 + h*hn)", "gamma = k2/(k2 + h*h)")),
    ("perc", ("gamma = k2/(k2 + h*hn)", "gamma = k2/(k2 - h*hn)")),
    ("perc", ("k2 = J/m", "k2 = J")),
    ("perc", ("tilt = -np.sign(rel[1])*row[\"MU\"]", "tilt = -np.sign(rel[0])*row[\"MU\"]")),
    ("perc", ("need = -(1 + row[\"E\"])*rel[0] - sn*T0", "need = -(1 + row[\"E\"])*rel[0]")),
    ("perc", ("om2 = om + side*(hn*S[0]", "om2 = om + (hn*S[0]")),
    ("perc", ("out = frame.T @ V", "out = frame @ V")),
    ("perc", ("dv = np.hypot(*(V - U))", "dv = np.hypot(*V) - np.hypot(*U)")),
    ("sheet", ('F2 = 1 if R["M"] == 4 else 1/R["IA"]', 'F2 = 1 if R["M"] == 4 else 1/R["IB"]')),
    ("sheet", ('M2 = D2*sin((R["TB"] + R["PB"])*pi/180)',
      'M2 = D2*sin((R["TB"] + R["PA"])*pi/180)')),
    ("sheet", ('Q2 = R["VY"] + R["WB"]*L2', 'Q2 = R["VY"] + R["WA"]*L2')),
    ("sheet", ("R2 = (N2 - P2)*cos(B2) + (O2 - Q2)*sin(B2)",
      "R2 = (N2 - P2)*cos(B2) + (O2 - Q2)*cos(B2)")),
    ("sheet", ("U2 = H2 + I2 + K2**2*F2 + M2**2*G2", "U2 = H2 + I2 + K2**2*F2 + M2**2*F2")),
    ("sheet", ("W2 = H2 + I2 + J2**2*F2", "W2 = H2 + J2**2*F2")),
    ("sheet", ("V2 = -J2*K2*F2 - L2*M2*G2", "V2 = -J2*K2*F2 + L2*M2*G2")),
    ("sheet", ("AD2 = AA2*cos(B2)**2 + 2*AB2*", "AD2 = AA2*cos(B2)**2 + AB2*")),
    ("sheet", ("AE2 = (AC2 - AA2)*", "AE2 = (AA2 - AC2)*")),
    ("sheet", ("AM2 = AJ2*sin(B2) + AK2*cos(B2)", "AM2 = AJ2*sin(B2) - AK2*cos(B2)")),
    ("sheet", ("AB2 = V2 - Z2*X2*Y2", "AB2 = V2")),
    ("sheet", ("AT2 = R[\"WB\"] - G2*(L2*AM2 - M2*AL2 + AN2)",
      "AT2 = R[\"WB\"] + G2*(L2*AM2 - M2*AL2 + AN2)")),
    ("sheet", ("(R[\"WA\"]**2/F2 + R[\"WB\"]**2/G2)/2", "(R[\"WA\"]**2*F2 + R[\"WB\"]**2*G2)/2")),
    ("si", ('i1 = inp["IA"]*SLUG*FOOT*FOOT', 'i1 = inp["IA"]*SLUG*FOOT')),
    ("si", ("l1 = inp[\"DA\"]*FOOT; l2 = inp[\"DB\"]*FOOT", "l1 = inp[\"DA\"]; l2 = inp[\"DB\"]")),
    ("si", ("WAF=end[2], ", "WAF=end[2]/deg, ")),
    ("si", ("s[4] -= py/m2", "s[4] -= px/m2")),
    ("si", ("s[5] -= (x2*py - y2*px + tq)/i2", "s[5] -= (x2*py - y2*px + tq)/i1")),
    ("si", ("want = -inp[\"E\"]*normal(start) - normal(base)",
      "want = -inp[\"E\"]*normal(start) - normal(start)")),
    ("si", ("want = -inp[\"E\"]*normal(start) - normal(base)",
      "want = -inp[\"E\"]*normal(base) - normal(base)")),
    ("si", ("if slide(start) > 0.0: f = -f", "if slide(base) > 0.0: f = -f")),
    ("si", ("px = pn*nx - pt*ny; py = pn*ny + pt*nx", "px = pn*nx + pt*ny; py = pn*ny + pt*nx")),
    ("si", ("return s[2] - s[5]", "return s[2] + s[5]")),
    ("si", ("e1 += 0.5*i1*end[2]**2 + 0.5*i2*end[5]**2",
      "e1 += 0.5*i1*end[2]**2 + 0.5*i2*start[5]**2")),
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
    ("four", ("k = A.m/B.m", "k = B.m/A.m"), ("DVB=k*sqrt(dv @ dv)", "DVB=sqrt(dv @ dv)")),
    ("four", ("L[0, 2], L[0, 3] = la, -lb", "L[0, 2], L[0, 3] = la, lb"),
     ("sign = 1 if sliding > 0 else -1", "sign = -1 if sliding > 0 else 1")),
    ("four", ("turn = (la - lb)*n + (ta - tb)*t", "turn = (la + lb)*n + (ta - tb)*t"),
     ("q*A.i - (1 - em), 1 - em", "q*A.i - (1 + em), 1 + em")),
    ("four", ('em = 1.0 if light else case["EM"]', 'em = 1.0 if light else -case["EM"]'),
     ("vb = B.v - k*(va - A.v)", "vb = B.v + k*(va - A.v)")),
    ("cish", ("b1 = ya/ja - yb/jb", "b1 = ya/ja + yb/jb"),
     ("r1 = -(1 + p[\"E\"])*g1", "r1 = -p[\"E\"]*g1")),
    ("cish", ('g1 = t1 + ya*p["WA"] - t3 + yb*p["WB"]', 'g1 = t1 - t3'),
     ("VAY=s*t1 + c*t2", "VAY=s*t1 - c*t2")),
    ("cish", ("t10 = t8*h3 - b1*t9", "t10 = t8*h3 + b1*t9"),
     ("t3 -= pn/p[\"MB\"]", "t3 += pn/p[\"MB\"]")),
    ("cish", ("a12 = -ya*xa/ja - yb*xb/jb", "a12 = ya*xa/ja + yb*xb/jb"),
     ("w2 = p[\"WB\"] + (yb*pn - xb*pt - pm)/jb", "w2 = p[\"WB\"] + (yb*pn - xb*pt + pm)/jb")),
    ("perc", ("dom = om[0] - om[1]", "dom = om[1] - om[0]"),
     ("need = -(1 + row[\"E\"])*rel[0] - sn*T0", "need = -row[\"E\"]*rel[0] - sn*T0")),
    ("perc", ("tilt = -np.sign(rel[1])*row[\"MU\"]", "tilt = np.sign(rel[1])*row[\"MU\"]"),
     ("om2 = om + side*(hn*S[0] + ht*S[1] + T)/J", "om2 = om + side*(hn*S[0] + ht*S[1])/J")),
    ("perc", ("em = 1.0 if plain else row[\"EM\"]", "em = 1.0 if plain else abs(row[\"EM\"])"),
     ("out = frame.T @ V", "out = V")),
    ("perc", ("*np.array([-1.0, 1.0])", "*np.array([-1.0, -1.0])"),
     ("V = U + np.outer(S, side/m)", "V = U - np.outer(S, side/m)")),
    ("perc", ("LOSS=100*(before - after)/before", "LOSS=(before - after)/before"),
     ("hn = -r[1]", "hn = r[1]")),
    ("sheet", ("R2 = (N2 - P2)*cos(B2) + (O2 - Q2)*sin(B2)",
      "R2 = (N2 - P2)*cos(B2) - (O2 - Q2)*sin(B2)"),
     ("AS2 = R[\"WA\"] + F2*(J2*AM2 - K2*AL2 + AN2)",
      "AS2 = R[\"WA\"] + F2*(J2*AM2 + K2*AL2 + AN2)")),
    ("sheet", ("T2 = R[\"WA\"] - R[\"WB\"]", "T2 = R[\"WA\"] + R[\"WB\"]"),
     ("AR2 = R[\"VY\"] - AM2*I2", "AR2 = R[\"VY\"] - AM2*H2")),
    ("sheet", ("AI2 = R[\"MU\"] if S2 <= 0 else -R[\"MU\"]", "AI2 = R[\"MU\"]"),
     ("AG2 = -(1 + R[\"E\"])*R2 +", "AG2 = -(1 - R[\"E\"])*R2 +")),
    ("sheet", ("AY2 = 100*(1 - (AW2 + AX2)/(AU2 + AV2))", "AY2 = 100*(1 - AW2/AU2)"),
     ("Y2 = J2*F2 + L2*G2", "Y2 = J2*F2 - L2*G2")),
    ("sheet", ("AN2 = 0 if R[\"M\"] == 4 else -Z2*(T2 +", "AN2 = 0 if R[\"M\"] == 4 else Z2*(T2 +"),
     ("AP2 = R[\"UY\"] + AM2*H2", "AP2 = R[\"UY\"] - AM2*H2")),
    ("sheet", ("B2 = R[\"GA\"]*pi/180", "B2 = R[\"GA\"]*3.14/180"),
     ("AT2 = R[\"WB\"] - G2*(L2*AM2 - M2*AL2 + AN2)",
      "AT2 = R[\"WB\"] - G2*(L2*AM2 - M2*AL2 - AN2)")),
    ("si", ("XAF=(end[0] - end[2]*y1)/FOOT", "XAF=(end[0] + end[2]*y1)/FOOT"),
     ("part = (1.0 - em)/(1.0 - 2.0*em)", "part = (1.0 - em)/(1.0 + 2.0*em)")),
    ("si", ("start = [inp[\"UX\"]*FOOT, inp[\"UY\"]*FOOT, inp[\"WA\"]",
      "start = [inp[\"UX\"]*FOOT, inp[\"UY\"]*FOOT, inp[\"WA\"]*deg"),
     ("if slide(start) > 0.0: f = -f", "f = f")),
    ("si", ("DVA=hypot(end[0] - start[0], end[1] - start[1])/FOOT",
      "DVA=hypot(end[0], end[1])/FOOT - hypot(start[0], start[1])/FOOT"),
     ("want = -inp[\"E\"]*normal(start) - normal(base)",
      "want = -sqrt(abs(inp[\"E\"]))*normal(start) - normal(base)")),
    ("si", ("l1 = inp[\"DA\"]*FOOT; l2 = inp[\"DB\"]*FOOT",
      "l1 = inp[\"DB\"]*FOOT; l2 = inp[\"DA\"]*FOOT"),
     ("px = pn*nx - pt*ny; py", "px = pn*nx + pt*ny; py")),
    ("si", ("s[5] -= (x2*py - y2*px + tq)/i2", "s[5] -= (x2*py - y2*px - tq)/i2"),
     ("ir = i1*i2/(i1 + i2)", "ir = i1*i2/(m1 + m2)")),
    ("si", ("nx = cos(deg*inp[\"GA\"]); ny = sin(deg*inp[\"GA\"])",
      "nx = cos(deg*inp[\"GA\"]); ny = -sin(deg*inp[\"GA\"])"),
     ("VBX=end[3]/FOOT, VBY=end[4]/FOOT", "VBX=end[3], VBY=end[4]")),
    ("si", ("i1 = inp[\"IA\"]*SLUG*FOOT*FOOT; i2 = inp[\"IB\"]*SLUG*FOOT*FOOT",
      "i1 = inp[\"IA\"]*SLUG; i2 = inp[\"IB\"]*SLUG"),
     ("s[1] += py/m1", "s[1] += py/m2")),
]  # fmt: skip

SINGLES += [
    (
        "kkt",
        (
            "cbx, cby = rad_b*cos(b*deg), rad_b*sin(b*deg)",
            "cbx, cby = -rad_b*cos(b*deg), -rad_b*sin(b*deg)",
        ),
    ),
    (
        "kkt",
        (
            "cax, cay = -rad_a*cos(a*deg), -rad_a*sin(a*deg)",
            "cax, cay = -rad_a*sin(a*deg), -rad_a*cos(a*deg)",
        ),
    ),
    ("kkt", ('s["TB"] + s["PB"]\n', 's["TB"] - s["PB"]\n')),
    ("kkt", ('A[2, 3] = s["MB"]; A[2, 6] = 1;', 'A[2, 3] = s["MB"]; A[2, 6] = -1;')),
    ("kkt", ('y[3] = s["MB"]*s["VY"]', 'y[3] = s["MA"]*s["VY"]')),
    ("kkt", ("A[4, 6] = cay; A[4, 7] = -cax;", "A[4, 6] = cay; A[4, 7] = cax;")),
    ("kkt", ("A[5, 8] = 1; y[5]", "A[5, 8] = -1; y[5]")),
    ("kkt", ("A[5, 6] = -cby; A[5, 7] = cbx;", "A[5, 6] = cby; A[5, 7] = -cbx;")),
    ("kkt", ('y[6] = -s["E"]*approach', 'y[6] = s["E"]*approach')),
    (
        "kkt",
        (
            'mu = -s["MU"] if sliding > 0 else s["MU"]',
            'mu = -abs(s["MU"]) if sliding > 0 else abs(s["MU"])',
        ),
    ),
    (
        "kkt",
        ('mu = -s["MU"] if sliding > 0 else s["MU"]', 'mu = s["MU"] if sliding > 0 else -s["MU"]'),
    ),
    ("kkt", ("red = 1.0/(1.0/ia + 1.0/ib)", "red = ia + ib")),
    ("kkt", ("A[8, 8] = em", "A[8, 8] = 1.0")),
    ("kkt", ("A[6, 2] = -cay*ex + cax*ey", "A[6, 2] = -cay*ey + cax*ex")),
    ("kkt", ("A[7, 3] = ey; A[7, 4] = -ex;", "A[7, 3] = -ey; A[7, 4] = ex;")),
    ("kkt", ('dy = s["UY"] + s["WA"]*cax', 'dy = s["UY"] - s["WA"]*cax')),
    ("kkt", ('g = s["GA"]*deg', 'g = -s["GA"]*deg')),
    ("kkt", ("LOSS=100.0*(before - after)/before", "LOSS=100.0*(before - after)/after")),
    (
        "kkt",
        (
            "A[7, 6] = -ey - mu*ex; A[7, 7] = ex - mu*ey",
            "A[7, 6] = -ey - mu*ex; A[7, 7] = ex + mu*ey",
        ),
    ),
    ("vec", ('g = (u + s["WA"]*rot(ca)) - (v + s["WB"]*rot(cb))', "g = u - v")),
    ("vec", ("wA*np.outer(rot(ca), rot(ca)) + wB", "wA*np.outer(ca, ca) + wB")),
    ("vec", ("h = wA*rot(ca) + wB*rot(cb)", "h = wA*rot(ca) - wB*rot(cb)")),
    ("vec", ('/(1 - 2*s["EM"])/(wA + wB)', '/(1 + 2*s["EM"])/(wA + wB)')),
    ("vec", ('/(1 - 2*s["EM"])/(wA + wB)', "/(wA + wB)")),
    ("vec", ('spin = s["WA"] - s["WB"]', 'spin = s["WB"] - s["WA"]')),
    ("vec", ('np.sign(g @ t)*s["MU"]*t', 's["MU"]*t')),
    ("vec", ("T = -share*(spin + h @ P)", "T = -share*(h @ P)")),
    ("vec", ('U = u + P/s["MA"]', 'U = u + P/s["MB"]')),
    ("vec", ('WB = s["WB"] - wB*(rot(cb) @ P + T)', 'WB = s["WB"] - wB*(rot(cb) @ P - T)')),
    ("vec", ('WA = s["WA"] + wA*(rot(ca) @ P + T)', 'WA = s["WA"] + wA*(rot(ca) @ P)')),
    ("vec", ('K = (1/s["MA"] + 1/s["MB"])*np.eye(2)', 'K = (1/(s["MA"] + s["MB"]))*np.eye(2)')),
    ("vec", ("np.array([want, -(goal @ t)])", "np.array([want, -(g @ t)])")),
]
PAIRS += [
    (
        "kkt",
        (
            "cbx, cby = rad_b*cos(b*deg), rad_b*sin(b*deg)",
            "cbx, cby = -rad_b*cos(b*deg), -rad_b*sin(b*deg)",
        ),
        ('y[6] = -s["E"]*approach', 'y[6] = s["E"]*approach'),
    ),
    ("kkt", ('s["TB"] + s["PB"]\n', 's["TB"] - s["PB"]\n'), ("A[8, 8] = em", "A[8, 8] = 1.0")),
    (
        "kkt",
        ('y[3] = s["MB"]*s["VY"]', 'y[3] = s["MA"]*s["VY"]'),
        ("after += 0.5*ia*x[2]**2 + 0.5*ib*x[5]**2", "after += 0.5*ib*x[2]**2 + 0.5*ia*x[5]**2"),
    ),
    (
        "kkt",
        ("A[5, 6] = -cby; A[5, 7] = cbx;", "A[5, 6] = cby; A[5, 7] = -cbx;"),
        ('mu = -s["MU"] if sliding > 0 else s["MU"]', 'mu = s["MU"] if sliding > 0 else -s["MU"]'),
    ),
    (
        "kkt",
        ("A[6, 2] = -cay*ex + cax*ey", "A[6, 2] = -cay*ey + cax*ex"),
        ('g = s["GA"]*deg', 'g = -s["GA"]*deg'),
    ),
    (
        "kkt",
        ("A[4, 6] = cay; A[4, 7] = -cax;", "A[4, 6] = cay; A[4, 7] = cax;"),
        (
            'mu = -s["MU"] if sliding > 0 else s["MU"]',
            'mu = -abs(s["MU"]) if sliding > 0 else abs(s["MU"])',
        ),
    ),
    (
        "vec",
        ('n = unit(s["GA"]); t = rot(n)', 'n = unit(s["GA"]); t = -rot(n)'),
        ('/(1 - 2*s["EM"])/(wA + wB)', "/(wA + wB)"),
    ),
    (
        "vec",
        ("h = wA*rot(ca) + wB*rot(cb)", "h = wA*rot(ca) - wB*rot(cb)"),
        ('U = u + P/s["MA"]', 'U = u + P/s["MB"]'),
    ),
    (
        "vec",
        ('/(1 - 2*s["EM"])/(wA + wB)', '/(1 + 2*s["EM"])/(wA + wB)'),
        ('K = (1/s["MA"] + 1/s["MB"])*np.eye(2)', 'K = (1/(s["MA"] + s["MB"]))*np.eye(2)'),
    ),
    (
        "vec",
        ('g = (u + s["WA"]*rot(ca)) - (v + s["WB"]*rot(cb))', "g = u - v"),
        ('spin = s["WA"] - s["WB"]', 'spin = s["WB"] - s["WA"]'),
    ),
    (
        "vec",
        ('np.sign(g @ t)*s["MU"]*t', 's["MU"]*t'),
        ('WA = s["WA"] + wA*(rot(ca) @ P + T)', 'WA = s["WA"] + wA*(rot(ca) @ P)'),
    ),
]
