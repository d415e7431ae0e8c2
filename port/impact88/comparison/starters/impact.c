/* Reads the kit's vectors.csv on standard input, writes a table for impact88 compare.
     cc -O2 -o impact impact.c -lm && ./impact < vectors.csv | impact88 compare -            */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { E, MU, EM, DA, DB, GA, PA, PB, TA, TB, MA, MB, IA, IB, UX, UY, WA, VX, VY, WB, M, COUNT };
static const char *NAMES[COUNT] = {"E",  "MU", "EM", "DA", "DB", "GA", "PA", "PB", "TA", "TB", "MA",
                                   "MB", "IA", "IB", "UX", "UY", "WA", "VX", "VY", "WB", "M"};

static double rad(double degrees) { return degrees * acos(-1.0) / 180; }

/* Impulses along n and t and the moment, on A; 0 where there is no answer. */
static int impact(const double *g, double *v) {
  int point = g[M] == 4;
  if (!(g[MA] > 0 && g[MB] > 0 && (point || (g[IA] > 0 && g[IB] > 0)))) return 0;
  double da = point ? 0 : g[DA], db = point ? 0 : g[DB], em = point ? 1 : g[EM];
  double ia = point ? 1 : 1 / g[IA], ib = point ? 1 : 1 / g[IB], ma = 1 / g[MA], mb = 1 / g[MB];
  double a = rad(g[TA] + g[PA]), b = rad(g[TB] + g[PB]), c = cos(rad(g[GA])), s = sin(rad(g[GA]));
  double an = da * (sin(a) * c - cos(a) * s), at = -da * (cos(a) * c + sin(a) * s);
  double bn = db * (sin(b) * c - cos(b) * s), bt = -db * (cos(b) * c + sin(b) * s);
  double dx = g[UX] - g[VX], dy = g[UY] - g[VY], w = g[WA] - g[WB];
  double gn = dx * c + dy * s + an * g[WA] + bn * g[WB];
  double gt = dy * c - dx * s + at * g[WA] + bt * g[WB];
  /* everything times 1 - 2 EM, so that EM = 1/2 is nothing special */
  double h = 1 - 2 * em, q = 1 - em, i = 1 / (ia + ib);
  double kn = an * ia - bn * ib, kt = at * ia - bt * ib;
  double nn = h * (ma + mb + an * an * ia + bn * bn * ib) - q * i * kn * kn;
  double nt = h * (an * at * ia + bn * bt * ib) - q * i * kn * kt;
  double tt = h * (ma + mb + at * at * ia + bt * bt * ib) - q * i * kt * kt;
  double rn = -h * (1 + g[E]) * gn + q * i * kn * w, rt = -h * gt + q * i * kt * w, pn, pt;
  if (g[MU] == -10) {
    double det = nn * tt - nt * nt;
    pn = (rn * tt - rt * nt) / det;
    pt = (rt * nn - rn * nt) / det;
  } else {
    double mu = gt > 0 ? -g[MU] : g[MU];
    pn = rn / (nn + mu * nt);
    pt = mu * pn;
  }
  double moment = point ? 0 : -q / h * i * (w + kn * pn + kt * pt);
  double px = pn * c - pt * s, py = pn * s + pt * c;
  v[0] = g[UX] + px * ma;
  v[1] = g[UY] + py * ma;
  v[2] = g[VX] - px * mb;
  v[3] = g[VY] - py * mb;
  v[4] = g[WA] + (an * pn + at * pt + moment) * ia;
  v[5] = g[WB] + (bn * pn + bt * pt - moment) * ib;
  for (int k = 0; k < 6; k++)
    if (!isfinite(v[k])) return 0;
  return 1;
}

int main(void) {
  static char line[65536], copy[65536];
  int place[COUNT];
  for (int row = 0; fgets(line, sizeof line, stdin); row++) {
    line[strcspn(line, "\r\n")] = 0;
    strcpy(copy, line);
    double g[COUNT] = {0}, v[6];
    int column = 0;
    for (char *cell = copy, *end; cell; cell = end ? end + 1 : NULL, column++) {
      if ((end = strchr(cell, ','))) *end = 0;
      for (int k = 0; k < COUNT; k++) {
        if (!row && !strcmp(cell, NAMES[k])) place[k] = column;
        if (row && place[k] == column) g[k] = strtod(cell, NULL);
      }
    }
    printf("%s", line);
    if (!row) printf(",VAX,VAY,VBX,VBY,WAF,WBF\n");
    else if (impact(g, v)) {
      for (int k = 0; k < 6; k++) printf(",%.17g", v[k]);
      printf("\n");
    } else printf(",,,,,,\n"); /* a scene without an answer is left without one */
  }
  return 0;
}
