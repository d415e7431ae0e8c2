/* What a programmer writes who wants the six final velocities in C and nothing else: no pivot, no
   point mass, no infinite body, no finding. A rival of the benchmark, which compiles it. */

#include <math.h>
#include <stdint.h>

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT
#endif

#define COLUMN(name, place) const double *restrict name = in[place];
#define RESULT(name, place) double *restrict name = out[place];
#define RADIANS 0.017453292519943295

/* Equations 13 to 18 by friction, of columns in the order of the scene's names. */
EXPORT void solve_plainly(const double *const *in, double *const *out, int64_t count)
{
    COLUMN(E, 0) COLUMN(MU, 1) COLUMN(EM, 2) COLUMN(DA, 3) COLUMN(DB, 4) COLUMN(GA, 5)
    COLUMN(PA, 6) COLUMN(PB, 7) COLUMN(TA, 8) COLUMN(TB, 9) COLUMN(MA, 10) COLUMN(MB, 11)
    COLUMN(IA, 12) COLUMN(IB, 13) COLUMN(UX, 14) COLUMN(UY, 15) COLUMN(WA, 16)
    COLUMN(VX, 17) COLUMN(VY, 18) COLUMN(WB, 19)
    RESULT(VAX, 0) RESULT(VAY, 1) RESULT(VBX, 2) RESULT(VBY, 3) RESULT(WAF, 4) RESULT(WBF, 5)
    _Pragma("omp simd") /* counts only with -fopenmp-simd */
    for (int64_t i = 0; i < count; i++) {
        /* every cosine as a sine: gcc makes one call of a sine and cosine of the same angle, and
           then takes one angle at a time */
        double c = sin(RADIANS * (90 - GA[i])), s = sin(RADIANS * GA[i]);
        double of_a = TA[i] + PA[i] - GA[i], of_b = TB[i] + PB[i] - GA[i];
        double an = DA[i] * sin(RADIANS * of_a), at = -DA[i] * sin(RADIANS * (90 - of_a));
        double bn = DB[i] * sin(RADIANS * of_b), bt = -DB[i] * sin(RADIANS * (90 - of_b));
        double dx = UX[i] - VX[i], dy = UY[i] - VY[i];
        double cn = c * dx + s * dy, ct = c * dy - s * dx;
        double gn = cn + an * WA[i] + bn * WB[i], gt = ct + at * WA[i] + bt * WB[i];
        double mu = gt > 0 ? -MU[i] : MU[i];
        double ma = 1 / MA[i], mb = 1 / MB[i], ia = 1 / IA[i], ib = 1 / IB[i];
        double a = an + mu * at, b = bn + mu * bt, z = 1 - 2 * EM[i];
        /* spins after: WA + a ia Pn + ia H, WB + b ib Pn - ib H; unknown Pn and H */
        double nn = ma + mb + an * a * ia + bn * b * ib, nh = an * ia - bn * ib;
        double hn = (1 - EM[i]) * (a * ia - b * ib), hh = z * (ia + ib);
        double right_n = -(E[i] * gn + gn), right_h = -(1 - EM[i]) * (WA[i] - WB[i]);
        double determinant = nn * hh - nh * hn;
        double Pn = (right_n * hh - right_h * nh) / determinant;
        double H = (nn * right_h - hn * right_n) / determinant;
        double Px = (c - mu * s) * Pn, Py = (s + mu * c) * Pn;
        VAX[i] = UX[i] + ma * Px;
        VAY[i] = UY[i] + ma * Py;
        VBX[i] = VX[i] - mb * Px;
        VBY[i] = VY[i] - mb * Py;
        WAF[i] = WA[i] + ia * (a * Pn + H);
        WBF[i] = WB[i] + ib * (b * Pn - H);
    }
}

/* What memory alone takes: 20 columns read, six written, their sum in place of the mechanics. */
EXPORT void move_plainly(const double *const *in, double *const *out, int64_t count)
{
    COLUMN(a, 0) COLUMN(b, 1) COLUMN(c, 2) COLUMN(d, 3) COLUMN(e, 4) COLUMN(f, 5) COLUMN(g, 6)
    COLUMN(h, 7) COLUMN(j, 8) COLUMN(k, 9) COLUMN(l, 10) COLUMN(m, 11) COLUMN(n, 12)
    COLUMN(o, 13) COLUMN(p, 14) COLUMN(q, 15) COLUMN(r, 16) COLUMN(s, 17) COLUMN(t, 18)
    COLUMN(u, 19)
    RESULT(A, 0) RESULT(B, 1) RESULT(C, 2) RESULT(D, 3) RESULT(E, 4) RESULT(F, 5)
    for (int64_t i = 0; i < count; i++) {
        double sum = a[i] + b[i] + c[i] + d[i] + e[i] + f[i] + g[i] + h[i] + j[i] + k[i] + l[i]
            + m[i] + n[i] + o[i] + p[i] + q[i] + r[i] + s[i] + t[i] + u[i];
        A[i] = B[i] = C[i] = D[i] = E[i] = F[i] = sum;
    }
}
