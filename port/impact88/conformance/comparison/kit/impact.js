// Reads the kit's vectors.csv on standard input, writes a table for impact88 compare.
//   node impact.js < vectors.csv | impact88 compare -
const rad = (x) => (x * Math.PI) / 180;

function impact(g) {
  const point = g.M === 4, da = point ? 0 : g.DA, db = point ? 0 : g.DB, em = point ? 1 : g.EM;
  const ia = point ? 1 : g.IA, ib = point ? 1 : g.IB, k = em * (1 / ia + 1 / ib);
  const a = rad(g.TA + g.PA), b = rad(g.TB + g.PB), c = Math.cos(rad(g.GA)), s = Math.sin(rad(g.GA));
  const ax = -da * Math.cos(a), ay = -da * Math.sin(a), bx = db * Math.cos(b), by = db * Math.sin(b);
  const dx = g.UX - ay * g.WA - g.VX + by * g.WB, dy = g.UY + ax * g.WA - g.VY - bx * g.WB;
  const mu = dy * c - dx * s > 0 ? -g.MU : g.MU, mx = -g.MA * (s + mu * c), my = g.MA * (c - mu * s);
  const tx = g.MA * (ay - by), ty = -g.MA * (ax - bx);
  const m = [ // VAX VAY VBX VBY WAF WBF = right-hand side
    [g.MA, 0, g.MB, 0, 0, 0, g.MA * g.UX + g.MB * g.VX],
    [0, g.MA, 0, g.MB, 0, 0, g.MA * g.UY + g.MB * g.VY],
    [c, s, -c, -s, ax * s - ay * c, by * c - bx * s, -g.E * (dx * c + dy * s)],
    g.MU === -10
      ? [-s, c, s, -c, ax * c + ay * s, -bx * c - by * s, 0]
      : [mx, my, 0, 0, 0, 0, mx * g.UX + my * g.UY],
    [tx, ty, 0, 0, ia, ib, tx * g.UX + ty * g.UY + ia * g.WA + ib * g.WB],
    [k * ay * g.MA, -k * ax * g.MA, 0, 0, k * ia - 1 + em, 1 - em,
      k * (g.MA * (ay * g.UX - ax * g.UY) + ia * g.WA)],
  ];
  for (let j = 0; j < 6; j++) {
    let p = j;
    for (let i = j + 1; i < 6; i++) if (Math.abs(m[i][j]) > Math.abs(m[p][j])) p = i;
    [m[j], m[p]] = [m[p], m[j]];
    for (let i = 0; i < 6; i++) {
      const f = i === j ? 0 : m[i][j] / m[j][j];
      if (f) m[i] = m[i].map((x, n) => x - f * m[j][n]);
    }
  }
  return m.map((row, j) => row[6] / row[j]);
}

const [names, ...rows] = require("fs").readFileSync(0, "utf8").trim().split(/\r?\n/).map((line) => line.split(","));
console.log([...names, "VAX", "VAY", "VBX", "VBY", "WAF", "WBF"].join(","));
for (const row of rows) {
  const g = Object.fromEntries(names.map((name, i) => [name, Number(row[i])]));
  const possible = g.MA > 0 && g.MB > 0 && (g.M === 4 || (g.IA > 0 && g.IB > 0));
  const v = possible ? impact(g) : []; // a scene without an answer is left without one
  console.log([...row, ...[0, 1, 2, 3, 4, 5].map((i) => (Number.isFinite(v[i]) ? v[i] : ""))].join(","));
}
