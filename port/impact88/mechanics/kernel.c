/* The impact, strip by strip: the functions of formulas.h run over a strip of scenes in turn. */

#include <math.h>
#include <stdint.h>
#include <string.h>

#define STRIP 128 /* scenes whose rows stay in the nearest caches */
typedef double ROW[STRIP + 8] __attribute__((aligned(64)));
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("tree-vectorize", "vect-cost-model=dynamic")
#define EACH _Pragma("GCC ivdep") for (int i = 0; i < STRIP; i++)
#else
#define EACH for (int i = 0; i < STRIP; i++)
#endif
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__)
#define CLONES static __attribute__((target_clones("default", "avx2", "arch=x86-64-v4")))
#else
#define CLONES static
#endif
#ifdef _MSC_VER
#define INLINE static __forceinline
#else
#define INLINE static inline __attribute__((always_inline))
#endif
#define inf INFINITY
#define nan NAN
#define where(condition, yes, no) ((condition) ? (yes) : (no))
#include "formulas.h"

/* What is not finite, and everything of a scene that cannot be used, is NaN; no zero is negative. */
CLONES void finish(const double *x, const double *fit, double *to, double most)
{
    EACH to[i] = (fit[i] == 1.0) & (fabs(x[i]) <= most) ? x[i] + 0.0 : NAN;
}

CLONES void finish_bits(const double *x, const double *fit, uint16_t *to)
{
    EACH to[i] = (uint16_t)(int32_t)(fit[i] == 1.0 ? x[i] : 64.0);
}

const char *mechanics_formulas(void) { return FORMULAS; }

const char *instructions(void)
{
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("x86-64-v4")) return "x86-64-v4";
    if (__builtin_cpu_supports("avx2")) return "avx2";
#endif
    return "baseline";
}

/* ``plan``: the numbers of inputs that are one number for all scenes, of inputs, of functions, of
   results, and whether results are checked; the rows of inputs and of results; then function, guard
   (1: where pivots are, 2: where others are) and whether it varies with the scene, in order.
   ``places``: the addresses of the numbers, of the other inputs, and of the results. */
void solve(const int64_t *plan, void *const *places, int64_t begin, int64_t end)
{
    ROW row[ROWS]; /* those of columns: of numbers, and of the last strip's ends */
    const int64_t fixed = plan[0], inputs = plan[1], steps = plan[2], results = plan[3];
    const int64_t checked = plan[4], *input = plan + 5, *result = input + inputs;
    const double *in[COLUMNS] = {0};
    for (int64_t at = begin; at < end; at += STRIP) {
        int64_t count = end - at < STRIP ? end - at : STRIP, pivots = 0;
        for (int64_t k = 0; k < inputs; k++) {
            int64_t n = input[k], varies = k >= fixed;
            const double *from = varies ? places[1 + k - fixed] : (double *)places[0] + k;
            double *copy = row[n];
            if (n < COLUMNS) in[n] = varies && count == STRIP ? from + at : copy;
            if (n < COLUMNS && in[n] != copy) continue;
            if (varies) memcpy(copy, from + at, (size_t)count * sizeof *from);
            else if (at == begin) copy[0] = *from;
            for (int64_t i = varies ? count : 1; i < STRIP; i++) copy[i] = copy[0];
        }
        if (in[AT_MU]) EACH pivots += in[AT_MU][i] == PIVOT;
        const int64_t *step = result + results;
        for (int64_t k = 0; k < steps; k++, step += 3) {
            int64_t guard = step[1], varies = step[2];
            if (varies && (guard == 1 ? !pivots : guard == 2 && pivots == STRIP)) continue;
            if (varies || at == begin) loops[step[0]](in, row); /* others: a later strip has pivots */
        }
        for (int64_t k = 0; k < results; k++) {
            int64_t n = result[k], bits = checked && n == AT_STATUS, size = bits ? 2 : 8;
            const double *x = row[n], *fit = row[AT_fit];
            char *there = (char *)places[1 + inputs - fixed + k] + at * size;
            double last[STRIP];
            void *to = count == STRIP && checked ? (void *)there : last;
            if (bits) finish_bits(x, fit, to);
            else if (checked) finish(x, fit, to, n == AT_COND ? INFINITY : LARGEST);
            if (to == last) memcpy(there, checked ? to : x, (size_t)(count * size));
        }
    }
}
