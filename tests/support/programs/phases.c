/* Two phases: the normal impulse grows until the approach has stopped, then by e of that again;
   friction goes along with it in a constant ratio. Contact frame, inverse masses. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { E, MU, EM, DA, DB, GA, PA, PB, TA, TB, MA, MB, IA, IB, UX, UY, WA, VX, VY, WB, M, N };
static const char *NAME[N] = {"E", "MU", "EM", "DA", "DB", "GA", "PA", "PB", "TA", "TB", "MA",
                              "MB", "IA", "IB", "UX", "UY", "WA", "VX", "VY", "WB", "M"};

int main(void) {
  char line[4096];
  int column[64] = {0}, count = 0;
  if (!fgets(line, sizeof line, stdin)) return 1;
  for (char *cell = strtok(line, ",\r\n"); cell; cell = strtok(NULL, ",\r\n"), count++)
    for (int k = column[count] = N; k-- > 0;) if (!strcmp(cell, NAME[k])) column[count] = k;
  printf("VAX,VAY,VBX,VBY,WAF,WBF\n");
  const double deg = acos(-1.0) / 180;
  while (fgets(line, sizeof line, stdin)) {
    double q[N + 1] = {0};
    int at = 0;
    for (char *cell = strtok(line, ",\r\n"); cell; cell = strtok(NULL, ",\r\n")) q[column[at++]] = atof(cell);
    const int bodies = q[M] != 4;
    const double cosg = cos(q[GA] * deg), sing = sin(q[GA] * deg);
    const double inva = 1 / q[MA], invb = 1 / q[MB];
    const double ja = bodies ? 1 / q[IA] : 1, jb = bodies ? 1 / q[IB] : 1;
    const double em = bodies ? q[EM] : 1;
    const double anga = (q[TA] + q[PA] - q[GA]) * deg, angb = (q[TB] + q[PB] - q[GA]) * deg;
    const double arma = bodies ? q[DA] : 0, armb = bodies ? q[DB] : 0;
    /* contact point in the frame: (ra, sa) from A, (rb, sb) from B */
    const double ra = -arma * cos(anga), sa = -arma * sin(anga);
    const double rb = armb * cos(angb), sb = armb * sin(angb);
    const double van = q[UX] * cosg + q[UY] * sing, vat = q[UY] * cosg - q[UX] * sing;
    const double vbn = q[VX] * cosg + q[VY] * sing, vbt = q[VY] * cosg - q[VX] * sing;
    const double approach = (vbn - q[WB] * sb) - (van - q[WA] * sa);
    const double slip = (vat + q[WA] * ra) - (vbt + q[WB] * rb);
    const double spin = q[WA] - q[WB];
    const double share = (1 - em) / ((1 - 2 * em) * (ja + jb));
    const double twistn = sa * ja + sb * jb, twistt = ra * ja + rb * jb;
    const double nn = inva + invb + sa * sa * ja + sb * sb * jb - share * twistn * twistn;
    const double nt = -sa * ra * ja - sb * rb * jb + share * twistn * twistt;
    const double tt = inva + invb + ra * ra * ja + rb * rb * jb - share * twistt * twistt;
    const double couplen = -share * twistn * spin, couplet = share * twistt * spin;
    double pn, pt;
    if (q[MU] == -10) {
      const double needn = (1 + q[E]) * approach + couplen, needt = couplet - slip;
      const double whole = nn * tt - nt * nt;
      pn = (needn * tt - needt * nt) / whole;
      pt = (needt * nn - needn * nt) / whole;
    } else {
      const double ratio = slip > 0 ? -q[MU] : q[MU];
      const double slope = nn + ratio * nt;
      const double compression = (approach + couplen) / slope;
      const double restitution = q[E] * approach / slope;
      pn = compression + restitution;
      pt = ratio * pn;
    }
    const double moment = bodies ? -share * (spin - twistn * pn + twistt * pt) : 0;
    const double fan = van + pn * inva, fat = vat + pt * inva;
    const double fbn = vbn - pn * invb, fbt = vbt - pt * invb;
    const double fwa = q[WA] + ja * (ra * pt - sa * pn + moment);
    const double fwb = q[WB] - jb * (rb * pt - sb * pn + moment);
    if (!(q[MA] > 0 && q[MB] > 0 && ja > 0 && jb > 0 && isfinite(pn + pt + moment))) {
      printf(",,,,,\n");
      continue;
    }
    printf("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", fan * cosg - fat * sing, fan * sing + fat * cosg,
           fbn * cosg - fbt * sing, fbn * sing + fbt * cosg, fwa, fwb);
  }
  return 0;
}
