/* Trial impulses: each unit impulse is applied, the change at the contact is a column of a 3 by 3
   system, which is eliminated with pivoting. Bodies are structures, all in the table's units. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct { double m, i, x, y, vx, vy, w; } Body;
typedef struct { double n, t, s; } Gap;

static double get(const char *names, const char *row, const char *name) {
  char a[64], b[64];
  while (sscanf(names, "%63[^,\n]", a) == 1 && sscanf(row, "%63[^,\n]", b) == 1) {
    if (!strcmp(a, name)) return atof(b);
    names += strlen(a) + 1; row += strlen(b) + 1;
  }
  return 0;
}

static double rad(double deg) { return deg * 3.14159265358979323846 / 180; }

static void push(Body *b, double px, double py, double torque) {
  b->vx += px / b->m;
  b->vy += py / b->m;
  b->w += (b->x * py - b->y * px + torque) / b->i;
}

static void pair(Body *a, Body *b, double c, double s, double pn, double pt, double pm) {
  double px = c * pn - s * pt, py = s * pn + c * pt;
  push(a, px, py, pm);
  push(b, -px, -py, -pm);
}

static Gap gap(Body a, Body b, double c, double s) {
  double ux = (a.vx - a.w * a.y) - (b.vx - b.w * b.y);
  double uy = (a.vy + a.w * a.x) - (b.vy + b.w * b.x);
  Gap g = {ux * c + uy * s, uy * c - ux * s, a.w - b.w};
  return g;
}

static double energy(Body a, int point) {
  return (a.m * (a.vx * a.vx + a.vy * a.vy) + (point ? 0 : a.i * a.w * a.w)) / 2;
}

static int solve(double m[3][4]) {
  for (int j = 0; j < 3; j++) {
    int p = j;
    for (int i = j; i < 3; i++) if (fabs(m[i][j]) > fabs(m[p][j])) p = i;
    if (m[p][j] == 0) return 0;
    for (int k = 0; k < 4; k++) { double q = m[j][k]; m[j][k] = m[p][k]; m[p][k] = q; }
    for (int i = 0; i < 3; i++) {
      double f = i == j ? 0 : m[i][j] / m[j][j];
      for (int k = 0; k < 4; k++) m[i][k] -= f * m[j][k];
    }
  }
  return 1;
}

int main(void) {
  char names[4096], row[4096];
  if (!fgets(names, sizeof names, stdin)) return 1;
  printf("VAX,VAY,VBX,VBY,WAF,WBF,DVA,DVB,LOSS\n");
  while (fgets(row, sizeof row, stdin)) {
#define G(name) get(names, row, #name)
    int point = G(M) == 4;
    double e = G(E), f = G(MU), em = point ? 1 : G(EM);
    double c = cos(rad(G(GA))), s = sin(rad(G(GA)));
    double pa = rad(G(TA) + G(PA)), pb = rad(G(TB) + G(PB));
    double la = point ? 0 : G(DA), lb = point ? 0 : G(DB);
    Body a = {G(MA), point ? 1 : G(IA), -la * cos(pa), -la * sin(pa), G(UX), G(UY), G(WA)};
    Body b = {G(MB), point ? 1 : G(IB), lb * cos(pb), lb * sin(pb), G(VX), G(VY), G(WB)};
    Gap before = gap(a, b, c, s);
    double m[3][4];
    for (int k = 0; k < 3; k++) {
      Body ta = a, tb = b;
      pair(&ta, &tb, c, s, k == 0, k == 1, k == 2);
      Gap after = gap(ta, tb, c, s);
      m[0][k] = after.n - before.n;
      m[1][k] = after.t - before.t;
      m[2][k] = after.s - before.s;
    }
    m[0][3] = -(1 + e) * before.n;
    if (f == -10) {
      m[1][3] = -before.t;
    } else {
      m[1][0] = before.t > 0 ? f : -f;
      m[1][1] = 1;
      m[1][2] = m[1][3] = 0;
    }
    double spin = m[2][2];
    for (int k = 0; k < 3; k++) m[2][k] *= 1 - em;
    m[2][2] -= em * spin;
    m[2][3] = -(1 - em) * before.s;
    if (!(a.m > 0 && b.m > 0 && a.i > 0 && b.i > 0) || !solve(m)) {
      printf(",,,,,,,,\n");
      continue;
    }
    Body fa = a, fb = b;
    pair(&fa, &fb, c, s, m[0][3] / m[0][0], m[1][3] / m[1][1], m[2][3] / m[2][2]);
    double ki = energy(a, point) + energy(b, point), kf = energy(fa, point) + energy(fb, point);
    printf("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", fa.vx, fa.vy, fb.vx, fb.vy,
           fa.w, fb.w, hypot(fa.vx - a.vx, fa.vy - a.vy), hypot(fb.vx - b.vx, fb.vy - b.vy),
           100 * (1 - kf / ki));
  }
  return 0;
}
