"""Mistakes in the programs of ``foreign/``: what is changed, and what that means.

`SINGLES` have one, `PAIRS` two. ``says`` is what a reader is to recognise in the sentence that
`compare` prints; ``where``, of those that hold in some scenes only, what must stand in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from foreign import Change


class Mistake(NamedTuple):
    """A mistake: the program it is in, what is changed there, its meaning, its condition."""

    key: str
    program: str
    changes: Sequence[Change]
    says: str
    where: str = ""


SINGLES = [
    Mistake(
        "t1", "trial.c",
        [("(b->x * py - b->y * px + torque)", "(b->x * px - b->y * py + torque)")],
        "the impulse's components are exchanged in its moment about each centre of mass",
    ),
    Mistake(
        "t2", "trial.c",
        [("(a.vx - a.w * a.y)", "(a.vx + a.w * a.y)")],
        "A's spin has the wrong sign in the contact velocity along x",
    ),
    Mistake(
        "t3", "trial.c",
        [("py = s * pn + c * pt", "py = s * pn - c * pt")],
        "the tangential impulse has the wrong sign along y",
    ),
    Mistake(
        "t4", "trial.c",
        [("before.t > 0 ? f : -f", "before.t > 0 ? -f : f")],
        "friction acts with the sliding, not against it",
    ),
    Mistake(
        "t5", "trial.c",
        [("-(1 + e) * before.n", "-e * before.n")],
        "restitution: e in place of 1 + e, the closing velocity is not stopped first",
    ),
    Mistake(
        "t6", "trial.c",
        [("-(1 - em) * before.s", "-before.s")],
        "the moment: the relative spin before the impact lacks its factor 1 - e_m",
    ),
    Mistake(
        "t7", "trial.c",
        [("{G(MA), point ? 1 : G(IA),", "{G(MA), point ? 1 : G(IB),")],
        "B's inertia is taken for A's",
    ),
    Mistake(
        "t8", "trial.c",
        [("rad(G(TA) + G(PA))", "rad(G(TA) - G(PA))")],
        "A's angle phi is taken with the wrong sign",
    ),
    Mistake(
        "t9", "trial.c",
        [("-(1 + e) * before.n", "-(1 + (before.n > -10 ? 0 : e)) * before.n")],
        "e is 0 where the closing speed is below 10",
        "closing",
    ),
    Mistake(
        "t10", "trial.c",
        [("push(b, -px, -py, -pm)", "push(b, -px, -py, pm)")],
        "the moment acts on B with the wrong sign",
    ),
    Mistake(
        "p1", "phases.c",
        [("(vbn - q[WB] * sb)", "(vbn + q[WB] * sb)")],
        "B's spin has the wrong sign in the closing velocity",
    ),
    Mistake(
        "p2", "phases.c",
        [("q[E] * approach / slope", "q[E] * compression")],
        "restitution is of the impulse (Poisson), not of the velocity: e multiplies the moment's "
        "share too",
    ),
    Mistake(
        "p3", "phases.c",
        [("rb * rb * jb - share * twistt * twistt", "rb * rb * jb + share * twistt * twistt")],
        "the moment's share has the wrong sign in the tangential compliance",
    ),
    Mistake(
        "p4", "phases.c",
        [("-sa * ra * ja - sb * rb * jb", "-sa * ra * ja + sb * rb * jb")],
        "B's term has the wrong sign in the compliance across (normal and tangential coupled)",
    ),
    Mistake(
        "p5", "phases.c",
        [("fbn = vbn - pn * invb", "fbn = vbn - pn * inva")],
        "A's mass is taken for B's in B's final normal velocity",
    ),
    Mistake(
        "p6", "phases.c",
        [("((1 - 2 * em) * (ja + jb))", "(1 - 2 * em) * (1 / ja + 1 / jb)")],
        "the inertias' sum in place of the reduced inertia, in the moment's share",
    ),
    Mistake(
        "p7", "phases.c",
        [("if (q[MU] == -10)", "if (q[MU] == -10 || q[MU] > 0.5)")],
        "the pivot (no sliding after) where MU is above 0.5",
        "MU",
    ),
    Mistake(
        "p8", "phases.c",
        [("slip > 0 ? -q[MU] : q[MU]", "slip > 0 ? -fmin(q[MU], 0.6) : fmin(q[MU], 0.6)")],
        "MU is capped at 0.6",
        "0.6",
    ),
    Mistake(
        "p9", "phases.c",
        [("pn = compression + restitution;", "pn = fmax(0, compression + restitution);")],
        "no impulse where the vehicles separate: the normal impulse may not pull",
    ),
    Mistake(
        "p10", "phases.c",
        [("acos(-1.0) / 180", "3.1416 / 180")],
        "3.1416 for pi",
    ),
    Mistake(
        "b1", "bodies.js",
        [("=> -x * g.DA * FT", "=> x * g.DA * FT")],
        "A's contact point is on the wrong side of A",
    ),
    Mistake(
        "b2", "bodies.js",
        [("jt = [cross(a.arm, t), cross(b.arm, t)]", "jt = [cross(a.arm, t), cross(a.arm, t)]")],
        "A's tangential arm is taken for B's",
    ),
    Mistake(
        "b3", "bodies.js",
        [("ktt = im + jt[0]", "ktt = jt[0]")],
        "the masses are left out of the tangential compliance",
    ),
    Mistake(
        "b4", "bodies.js",
        [("jN = wantN / (knn + k * knt)", "jN = wantN / knn")],
        "the normal impulse is found without friction, and friction is added after",
    ),
    Mistake(
        "b5", "bodies.js",
        [("jN = wantN / (knn + k * knt);\n    jT = k * jN;",
          "jN = wantN / knn;\n    const most = Math.abs(g.MU * jN);\n"
          "    jT = Math.max(-most, Math.min(most, (wantT - knt * jN) / ktt));")],
        "normal impulse first, then friction that stops the sliding, capped at MU times it",
    ),
    Mistake(
        "b6", "bodies.js",
        [("g.IA * LB * FT * FT", "g.IA * LB * FT")],
        "A's inertia is converted with feet once, not squared: it is 3.28 times too large",
    ),
    Mistake(
        "b7", "bodies.js",
        [("[g.UX * FT, g.UY * FT], g.WA)",
          "[g.UX * FT, g.UY * FT], g.WA || (last && last[4]) || 0)")],
        "where A has no spin, the final spin of the row before is taken",
        "WA",
    ),
    Mistake(
        "b8", "bodies.js",
        [("const free = g.M === 4;", "const free = false;")],
        "point masses (M = 4) are not known: treated as bodies",
    ),
    Mistake(
        "b9", "bodies.js",
        [("const k = vt > 0", "const k = dot(plus(a.v, b.v, -1), t) > 0")],
        "friction's sign is judged by the velocities of the centres of mass, not of the contact",
    ),
    Mistake(
        "b10", "bodies.js",
        [("-lock * (dw + wn * jN + wt * jT)", "-lock * (wn * jN + wt * jT)")],
        "the relative spin before the impact is left out of the moment",
    ),
    Mistake(
        "s1", "shooting.js",
        [("+ g.E * approach)", "+ g.E * g.E * approach)")],
        "e squared",
    ),
    Mistake(
        "s2", "shooting.js",
        [("g.VX - px / g.MB", "g.VX - px / g.MA")],
        "A's mass is taken for B's in B's velocity along x",
    ),
    Mistake(
        "s3", "shooting.js",
        [("s.ay * px + pm) / s.ia", "s.ay * px + pm) / s.ib")],
        "B's inertia is taken for A's in A's spin",
    ),
    Mistake(
        "s4", "shooting.js",
        [("* s.cos + (v.ay + v.aw * s.ax - v.by - v.bw * s.bx) * s.sin",
          "* s.cos + (v.ay + v.aw * s.ax - v.by + v.bw * s.bx) * s.sin")],
        "B's spin has the wrong sign along y in the closing velocity, before and after",
    ),
    Mistake(
        "s5", "shooting.js",
        [("g.EM * pm * (1 / s.ia + 1 / s.ib)", "g.EM * pm / (s.ia + s.ib)")],
        "the inverse of the inertias' sum in place of the sum of their inverses, in the moment",
    ),
    Mistake(
        "s6", "shooting.js",
        [("if (point || g.EM === 1) return 0;", "return 0;")],
        "no moment impulse at all, as if e_m were 1",
    ),
    Mistake(
        "s7", "shooting.js",
        [("slip > 0 ? -g.MU : g.MU", "slip > 5 ? -g.MU : slip < -5 ? g.MU : 0")],
        "no friction where the sliding is slower than 5",
        "slid",
    ),
    Mistake(
        "s8", "shooting.js",
        [("ax: -da * Math.cos((g.TA + g.PA) * turn)", "ax: -da * Math.cos(g.PA * turn)")],
        "A's heading is left out of its contact point along x",
    ),
    Mistake(
        "s9", "shooting.js",
        [("db = point ? 0 : g.DB", "db = point ? 0 : g.DA")],
        "A's arm is taken for B's",
    ),
    Mistake(
        "s10", "shooting.js",
        [("sliding(s, shoot(pn, pt)))", "sliding(s, shoot(pn, pt)) + g.E * slip)")],
        "the pivot: the sliding is reversed with e, not stopped",
    ),
    Mistake(
        "g1", "gyration.awk",
        [('v["IB"]) / v["MB"]', 'v["IB"]) / v["MA"]')],
        "B's radius of gyration is found with A's mass",
    ),
    Mistake(
        "g2", "gyration.awk",
        [("ha = dista * sin(alpha); fa = -dista * cos(alpha)",
          "ha = dista * cos(alpha); fa = -dista * sin(alpha)")],
        "sine and cosine are exchanged in A's arms",
    ),
    Mistake(
        "g3", "gyration.awk",
        [("seemn = (1 + ha * ha / ka2)", "seemn = (1 + ha / ka2)")],
        "A's normal arm is not squared in the normal compliance",
    ),
    Mistake(
        "g4", "gyration.awk",
        [("spinm = 1 / (ma * ka2) + 1 / (mb * kb2)", "spinm = 1 / (ma * ka2 + mb * kb2)")],
        "the sum of the inertias in place of the reduced inertia, in the moment's share",
    ),
    Mistake(
        "g5", "gyration.awk",
        [("* closing + part * spinn * turning", "* closing - part * spinn * turning")],
        "the relative spin before has the wrong sign in the restitution",
    ),
    Mistake(
        "g6", "gyration.awk",
        [("mixed -= part * spinn * spint", "mixed -= 0")],
        "the moment's share is left out of the compliance across",
    ),
    Mistake(
        "g7", "gyration.awk",
        [("(hb * in_ + fb * it + couple)", "(hb * in_ + fb * it - couple)")],
        "the moment acts on B's spin with the wrong sign",
    ),
    Mistake(
        "g8", "gyration.awk",
        [('th = rad(v["GA"])', 'th = rad(int(v["GA"]))')],
        "GA is cut to whole degrees",
    ),
    Mistake(
        "g9", "gyration.awk",
        [('uta = v["UY"] * nx - v["UX"] * ny', 'uta = v["UY"] * nx + v["UX"] * ny')],
        "A's tangential velocity before has the wrong sign in its x part",
    ),
    Mistake(
        "g10", "gyration.awk",
        [('f = sliding > 0 ? -v["MU"] : v["MU"]',
          'f = sliding > 0 ? -v["MU"] : v["MU"]; if (v["MU"] < 0.2) f = 0')],
        "no friction where MU is below 0.2",
        "MU",
    ),
    Mistake(
        "m1", "momentum.awk",
        [("gx = (MA * UX + MB * VX)", "gx = (MA * VX + MB * UX)")],
        "the masses are exchanged in the x velocity of the common centre of mass",
    ),
    Mistake(
        "m2", "momentum.awk",
        [("share = MB / (MA + MB)", "share = MA / (MA + MB)")],
        "the relative velocity after is shared out with the masses exchanged",
    ),
    Mistake(
        "m3", "momentum.awk",
        [("- bx * by / IB", "- bx * bx / IB")],
        "B's arm along x is taken for that along y in the compliance across x and y",
    ),
    Mistake(
        "m4", "momentum.awk",
        [("mu = ut > 0 ? -MU : MU", "mu = MU")],
        "MU is used with the sign typed, whichever way the contact slides",
    ),
    Mistake(
        "m5", "momentum.awk",
        [("(1 - EM) * mm - EM * mm", "(1 - EM) * mm + EM * mm")],
        "e_m's term in the moment has the wrong sign",
    ),
    Mistake(
        "m6", "momentum.awk",
        [("q3 = -(1 - EM) * dw", "q3 = -(1 - EM) * WA")],
        "B's spin before is left out of the moment's equation",
    ),
    Mistake(
        "m7", "momentum.awk",
        [("waf = WA + (ax * py - ay * px + pm)", "waf = WA + (ax * py + ay * px + pm)")],
        "the arm along y has the wrong sign in A's final spin",
    ),
    Mistake(
        "m8", "momentum.awk",
        [('A = ($where["TA"] + $where["PA"]) *', 'A = ($where["TA"] + $where["PA"]) % 180 *')],
        "A's direction (TA + PA) is wrapped at 180 degrees",
    ),
    Mistake(
        "m9", "momentum.awk",
        [("EM = 1; DA = DB = 0;", "EM = 1;")],
        "the arms of point masses are not set to 0",
    ),
    Mistake(
        "m10", "momentum.awk",
        [("q1 = -(1 + E) * un", "q1 = -(1 + (un < -50 ? E / 2 : E)) * un")],
        "e is halved where the closing speed is above 50",
        "closing",
    ),
]  # fmt: skip

_TWOS = (
    "t2 t8, t5 t10, t4 t7, p1 p5, p4 p10, p8 p6, b1 b6, b9 b10, b4 b8, s1 s2, s3 s9, s5 s8, s2 s6, "
    "g1 g7, g3 g9, g5 g8, m1 m6, m2 m4, m3 m7, m5 m9"
)
_BY_KEY = {mistake.key: mistake for mistake in SINGLES}


def _pair(first: Mistake, second: Mistake) -> Mistake:
    return Mistake(
        f"{first.key} {second.key}",
        first.program,
        [*first.changes, *second.changes],
        f"{first.says}; and {second.says}",
        first.where or second.where,
    )


PAIRS = [_pair(*(_BY_KEY[key] for key in two.split())) for two in _TWOS.split(", ")]
