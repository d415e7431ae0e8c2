// Rigid bodies in SI units with vectors; the moment is taken out of a 2 by 2 effective mass.
const LB = 14.593902937206364, FT = 0.3048;
const rad = (d) => (d / 180) * Math.PI;
const dot = (a, b) => a[0] * b[0] + a[1] * b[1];
const cross = (a, b) => a[0] * b[1] - a[1] * b[0];
const plus = (a, b, k = 1) => [a[0] + k * b[0], a[1] + k * b[1]];
const unit = (angle) => [Math.cos(angle), Math.sin(angle)];

class Body {
  constructor(mass, inertia, arm, v, w) {
    Object.assign(this, { im: 1 / mass, ii: 1 / inertia, arm, v, w });
  }
  contact() { return plus(this.v, [-this.arm[1] * this.w, this.arm[0] * this.w]); }
  struck(p, torque) {
    const after = Object.create(Body.prototype);
    return Object.assign(after, this, {
      v: plus(this.v, p, this.im),
      w: this.w + this.ii * (cross(this.arm, p) + torque),
    });
  }
}

function collide(g) {
  const free = g.M === 4;
  const n = unit(rad(g.GA)), t = [-n[1], n[0]];
  const armA = free ? [0, 0] : unit(rad(g.TA + g.PA)).map((x) => -x * g.DA * FT);
  const armB = free ? [0, 0] : unit(rad(g.TB + g.PB)).map((x) => x * g.DB * FT);
  const inertiaA = free ? 1 : g.IA * LB * FT * FT, inertiaB = free ? 1 : g.IB * LB * FT * FT;
  const a = new Body(g.MA * LB, inertiaA, armA, [g.UX * FT, g.UY * FT], g.WA);
  const b = new Body(g.MB * LB, inertiaB, armB, [g.VX * FT, g.VY * FT], g.WB);
  const em = free ? 1 : g.EM;
  const rel = plus(a.contact(), b.contact(), -1);
  const vn = dot(rel, n), vt = dot(rel, t), dw = a.w - b.w;
  const jn = [cross(a.arm, n), cross(b.arm, n)], jt = [cross(a.arm, t), cross(b.arm, t)];
  const im = a.im + b.im;
  const lock = (1 - em) / (1 - 2 * em) / (a.ii + b.ii);
  const wn = jn[0] * a.ii + jn[1] * b.ii, wt = jt[0] * a.ii + jt[1] * b.ii;
  const knn = im + jn[0] * jn[0] * a.ii + jn[1] * jn[1] * b.ii - lock * wn * wn;
  const ktt = im + jt[0] * jt[0] * a.ii + jt[1] * jt[1] * b.ii - lock * wt * wt;
  const knt = jn[0] * jt[0] * a.ii + jn[1] * jt[1] * b.ii - lock * wn * wt;
  const wantN = -g.E * vn - vn + lock * wn * dw;
  const wantT = -vt + lock * wt * dw;
  let jN, jT;
  if (g.MU === -10) {
    const det = knn * ktt - knt * knt;
    jN = (ktt * wantN - knt * wantT) / det;
    jT = (knn * wantT - knt * wantN) / det;
  } else {
    const k = vt > 0 ? -g.MU : g.MU;
    jN = wantN / (knn + k * knt);
    jT = k * jN;
  }
  const torque = free ? 0 : -lock * (dw + wn * jN + wt * jT);
  const impulse = plus(n.map((x) => x * jN), t, jT);
  const fa = a.struck(impulse, torque), fb = b.struck(impulse.map((x) => -x), -torque);
  return [fa.v[0] / FT, fa.v[1] / FT, fb.v[0] / FT, fb.v[1] / FT, fa.w, fb.w];
}

const [head, ...rows] = require("fs").readFileSync(0, "utf8").trim().split(/\r?\n/).map((x) => x.split(","));
console.log("VAX,VAY,VBX,VBY,WAF,WBF");
let last = null;
for (const row of rows) {
  const g = Object.fromEntries(head.map((name, i) => [name, Number(row[i])]));
  const solid = g.MA > 0 && g.MB > 0 && (g.M === 4 || (g.IA > 0 && g.IB > 0));
  const out = solid ? collide(g) : [];
  last = out;
  console.log([0, 1, 2, 3, 4, 5].map((i) => (Number.isFinite(out[i]) ? out[i] : "")).join(","));
}
