/* Equations 13 to 18 for the six final velocities, in a matrix stored by columns as Fortran stores
   it, and eliminated column by column in the order of LINPACK: multipliers first, then each later
   column. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define N 6
#define AT(row, column) a[(column) * N + (row)]

static double field(const char *head, const char *line, const char *name) {
  size_t length = strlen(name);
  for (; head && line; head = strchr(head, ','), line = strchr(line, ',')) {
    head += *head == ',';
    line += *line == ',';
    if (!strncmp(head, name, length) && strchr(",\r\n", head[length])) return atof(line);
  }
  return 0;
}

static int eliminate(double *a, double *b) {
  for (int k = 0; k < N; k++) {
    int pivot = k;
    for (int i = k + 1; i < N; i++) if (fabs(AT(i, k)) > fabs(AT(pivot, k))) pivot = i;
    if (AT(pivot, k) == 0) return 0;
    double swap = AT(pivot, k);
    AT(pivot, k) = AT(k, k);
    AT(k, k) = swap;
    for (int i = k + 1; i < N; i++) AT(i, k) *= -1 / AT(k, k);
    for (int j = k + 1; j <= N; j++) {
      double *column = j < N ? &AT(0, j) : b, factor = column[pivot];
      column[pivot] = column[k];
      column[k] = factor;
      for (int i = k + 1; i < N; i++) column[i] += factor * AT(i, k);
    }
  }
  for (int k = N; k-- > 0;) {
    b[k] /= AT(k, k);
    for (int i = 0; i < k; i++) b[i] -= b[k] * AT(i, k);
  }
  return 1;
}

int main(void) {
  static char head[4096], line[4096];
  if (!fgets(head, sizeof head, stdin)) return 1;
  printf("VAX,VAY,VBX,VBY,WAF,WBF\n");
  while (fgets(line, sizeof line, stdin)) {
#define Q(name) field(head, line, #name)
    const double degree = acos(-1.0) / 180, ma = Q(MA), mb = Q(MB);
    const int point = Q(M) == 4;
    const double ia = point ? 1 : Q(IA), ib = point ? 1 : Q(IB), em = point ? 1 : Q(EM);
    const double da = point ? 0 : Q(DA), db = point ? 0 : Q(DB);
    const double c = cos(Q(GA) * degree), s = sin(Q(GA) * degree);
    const double ta = (Q(TA) + Q(PA)) * degree, tb = (Q(TB) + Q(PB)) * degree;
    /* the contact point, from each centre of mass */
    const double ax = -da * cos(ta), ay = -da * sin(ta), bx = db * cos(tb), by = db * sin(tb);
    const double u[N] = {Q(UX), Q(UY), Q(VX), Q(VY), Q(WA), Q(WB)};
    /* its velocity on A less that on B, along the normal and across */
    const double normal[N] = {c, s, -c, -s, ax * s - ay * c, by * c - bx * s};
    const double across[N] = {-s, c, s, -c, ax * c + ay * s, -by * s - bx * c};
    double closing = 0, sliding = 0, a[N * N] = {0}, b[N] = {0};
    for (int j = 0; j < N; j++) {
      closing += normal[j] * u[j];
      sliding += across[j] * u[j];
    }
    const double mu = sliding > 0 ? -Q(MU) : Q(MU);
    const int pivot = Q(MU) == -10;
    const double share = em * (1 / ia + 1 / ib);
    AT(0, 0) = AT(1, 1) = ma;
    AT(0, 2) = AT(1, 3) = mb;
    for (int j = 0; j < N; j++) AT(2, j) = pivot ? across[j] : 0;
    if (!pivot) {
      AT(2, 0) = -s - mu * c;
      AT(2, 1) = c - mu * s;
    }
    for (int j = 0; j < N; j++) AT(3, j) = normal[j];
    AT(4, 0) = ma * ay;
    AT(4, 1) = -ma * ax;
    AT(4, 2) = mb * by;
    AT(4, 3) = -mb * bx;
    AT(4, 4) = ia;
    AT(4, 5) = ib;
    AT(5, 0) = share * ma * ay;
    AT(5, 1) = -share * ma * ax;
    AT(5, 4) = share * ia;
    for (int i = 0; i < N; i++)
      for (int j = 0; j < N; j++) b[i] += AT(i, j) * u[j];
    b[3] = -Q(E) * closing;
    if (pivot) b[2] = 0;
    AT(5, 4) -= 1 - em;
    AT(5, 5) += 1 - em;
    if (!(ma > 0 && mb > 0 && ia > 0 && ib > 0) || !eliminate(a, b)) {
      printf(",,,,,\n");
      continue;
    }
    printf("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", b[0], b[1], b[2], b[3], b[4], b[5]);
  }
  return 0;
}
