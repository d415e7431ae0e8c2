// Shooting: guess the normal impulse, see with what speed the contact points part, and correct the
// guess by the secant; the moment is found in the same way inside. All is linear, so that two
// guesses are enough.
const STEP = 1000;
const line = (f) => { const a = f(0), b = (f(STEP) - a) / STEP; return -a / b; };
const turn = Math.PI / 180;

function after(g, s, pn, pt, pm) {
  const px = pn * s.cos - pt * s.sin, py = pn * s.sin + pt * s.cos;
  return {
    ax: g.UX + px / g.MA, ay: g.UY + py / g.MA,
    bx: g.VX - px / g.MB, by: g.VY - py / g.MB,
    aw: g.WA + (s.ax * py - s.ay * px + pm) / s.ia,
    bw: g.WB - (s.bx * py - s.by * px + pm) / s.ib,
  };
}
const closing = (s, v) =>
  (v.ax - v.aw * s.ay - v.bx + v.bw * s.by) * s.cos + (v.ay + v.aw * s.ax - v.by - v.bw * s.bx) * s.sin;
const sliding = (s, v) =>
  (v.ay + v.aw * s.ax - v.by - v.bw * s.bx) * s.cos - (v.ax - v.aw * s.ay - v.bx + v.bw * s.by) * s.sin;

function impact(g) {
  const point = g.M === 4;
  const da = point ? 0 : g.DA, db = point ? 0 : g.DB;
  const s = {
    cos: Math.cos(g.GA * turn), sin: Math.sin(g.GA * turn),
    ax: -da * Math.cos((g.TA + g.PA) * turn), ay: -da * Math.sin((g.TA + g.PA) * turn),
    bx: db * Math.cos((g.TB + g.PB) * turn), by: db * Math.sin((g.TB + g.PB) * turn),
    ia: point ? 1 : g.IA, ib: point ? 1 : g.IB,
  };
  const v0 = after(g, s, 0, 0, 0);
  const approach = closing(s, v0), slip = sliding(s, v0);
  const moment = (pn, pt) => {
    if (point || g.EM === 1) return 0;
    return line((pm) => {
      const v = after(g, s, pn, pt, pm);
      return (1 - g.EM) * (v.aw - v.bw) - g.EM * pm * (1 / s.ia + 1 / s.ib);
    });
  };
  const shoot = (pn, pt) => after(g, s, pn, pt, moment(pn, pt));
  const friction = slip > 0 ? -g.MU : g.MU;
  const tangential = (pn) =>
    g.MU === -10 ? line((pt) => sliding(s, shoot(pn, pt))) : friction * pn;
  const pn = line((p) => closing(s, shoot(p, tangential(p))) + g.E * approach);
  return shoot(pn, tangential(pn));
}

const [head, ...rows] = require("fs").readFileSync(0, "utf8").trim().split(/\r?\n/).map((x) => x.split(","));
console.log("VAX,VAY,VBX,VBY,WAF,WBF,DVA,DVB");
for (const row of rows) {
  const g = {};
  head.forEach((name, i) => { g[name] = parseFloat(row[i]); });
  const refused = !(g.MA > 0 && g.MB > 0 && (g.M === 4 || (g.IA > 0 && g.IB > 0)));
  const v = refused ? {} : impact(g);
  const dva = Math.hypot(v.ax - g.UX, v.ay - g.UY), dvb = Math.hypot(v.bx - g.VX, v.by - g.VY);
  console.log([v.ax, v.ay, v.bx, v.by, v.aw, v.bw, dva, dvb].map((x) => (Number.isFinite(x) ? x : "")).join(","));
}
