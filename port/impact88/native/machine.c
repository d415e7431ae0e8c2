/* A machine for plans: it runs a program of elementwise operations over columns of doubles.

   The program says what is computed; nothing of any formula stands here. Scenes are taken a strip
   at a time, so short that all working values stay in the first-level cache. Every operation is
   the IEEE one, rounded by itself: the file must be compiled with -ffp-contract=off.

   No Python here: the functions are called through ctypes, which releases the interpreter's lock. */

#include <math.h>
#include <stdint.h>
#include <string.h>

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

/* One body, compiled for several instruction sets, chosen when the library is loaded. */
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__)
#define CLONES __attribute__((target_clones("default", "avx2", "arch=x86-64-v4")))
#else
#define CLONES
#endif

/* Scenes in a strip. For the six velocities 64 and 256 take as long within a tenth, 32 a quarter longer
   (AVX-512, columns in cache); the working values of 128 fit the second-level cache. */
#ifndef STRIP
#define STRIP 128
#endif

/* Numbers of columns that are in cache anyway: half a megabyte. */
#define CACHED 65536

/* Strips by which memory is fetched ahead, into the second-level cache (the first is too
   small, and one strip too late): 33 to 19 ns a scene where columns come from memory. */
#define AHEAD 2

/* Values a program may keep at a time. */
#define PLACES 1024

#define LOOP for (int i = 0; i < lanes; i++)
#if defined(__GNUC__) && !defined(__clang__)
#define EACH _Pragma("GCC ivdep") LOOP
#elif defined(__clang__)
#define EACH _Pragma("clang loop vectorize(assume_safety)") LOOP
#else
#define EACH __pragma(loop(ivdep)) LOOP
#endif

/* Each operation, by the name that expressions have for it. */
#define OPERATIONS(X) \
    X(ADD) X(SUBTRACT) X(MULTIPLY) X(DIVIDE) X(NEGATIVE) X(ABSOLUTE) X(SQRT) \
    X(PRODUCT_PLUS) X(PRODUCT_MINUS) X(MINUS_PRODUCT) X(PRODUCTS_PLUS) X(PRODUCTS_MINUS) \
    X(SINE_AND_COSINE) X(AGAINST) X(CHOOSE) \
    X(EQUAL) X(LESS) X(LESS_OR_EQUAL) X(EITHER) X(BOTH) X(NOT) \
    X(REAL_ROUNDED) X(REAL_ADD) X(REAL_SUBTRACT) X(REAL_MULTIPLY) X(REAL_DIVIDE) X(REAL_INT) \
    X(REAL_LESS) X(REAL_FRACTION) X(REAL_EXPONENT) X(REAL_HALVED) X(REAL_WHOLE) X(REAL_SCALED) \
    X(REAL_ORDINARY) X(ODD) \
    X(RESULT) X(RESULT_OR_INFINITE) X(COPY) X(BITS)

#define NAME(name) name,
#define TEXT(name) #name " "
enum operation { OPERATIONS(NAME) };
EXPORT const char *operations(void) { return OPERATIONS(TEXT); }

typedef struct {
    int32_t operation;
    int32_t place[5]; /* operands, then where the value goes */
} step;

/* sin k + r, cos k + r of an angle in degrees: see closedform/degrees.py, the same operations. */
typedef struct {
    const double *turn;
    double per_step, step, shift;
    double s0, s1, s2, c1, c2;
    int64_t steps;
} circle;

#include "reals.h"

static inline __attribute__((always_inline)) void perform(
    const step *steps, int64_t count, double *const *place, const circle *circle,
    char *const *next, int64_t ahead, int64_t columns, int64_t *odd, const int lanes)
{
    int64_t pace = columns ? count / columns : 0, wait = pace;
    for (const step *s = steps; s < steps + count; s++) {
        if (pace && --wait == 0 && columns--) {
            const char *column = *next++ + ahead;
            for (int i = 0; i < STRIP * 8; i += 64) __builtin_prefetch(column + i, 0, 2);
            wait = pace;
        }
        const double *a = place[s->place[0]], *b = place[s->place[1]];
        const double *c = place[s->place[2]], *d = place[s->place[3]];
        double *o;
        switch (s->operation) {
#define UNARY(name, value) case name: o = (double *)b; EACH o[i] = (value); break;
#define BINARY(name, value) case name: o = (double *)c; EACH o[i] = (value); break;
#define TERNARY(name, value) case name: o = (double *)d; EACH o[i] = (value); break;
#define QUATERNARY(name, value) \
    case name: o = place[s->place[4]]; EACH o[i] = (value); break;
        BINARY(ADD, a[i] + b[i])
        BINARY(SUBTRACT, a[i] - b[i])
        BINARY(MULTIPLY, a[i] * b[i])
        BINARY(DIVIDE, a[i] / b[i])
        UNARY(NEGATIVE, -a[i])
        UNARY(ABSOLUTE, fabs(a[i]))
        UNARY(SQRT, sqrt(a[i]))
        TERNARY(PRODUCT_PLUS, a[i] * b[i] + c[i])
        TERNARY(PRODUCT_MINUS, a[i] * b[i] - c[i])
        TERNARY(MINUS_PRODUCT, c[i] - a[i] * b[i])
        QUATERNARY(PRODUCTS_PLUS, a[i] * b[i] + c[i] * d[i])
        QUATERNARY(PRODUCTS_MINUS, a[i] * b[i] - c[i] * d[i])
        BINARY(AGAINST, b[i] > 0.0 ? -a[i] : a[i])
        TERNARY(CHOOSE, a[i] != 0.0 ? b[i] : c[i])
        /* a condition is 1 or 0 */
        BINARY(EQUAL, a[i] == b[i] ? 1.0 : 0.0)
        BINARY(LESS, a[i] < b[i] ? 1.0 : 0.0)
        BINARY(LESS_OR_EQUAL, a[i] <= b[i] ? 1.0 : 0.0)
        BINARY(EITHER, a[i] + b[i] != 0.0 ? 1.0 : 0.0)
        BINARY(BOTH, a[i] * b[i])
        UNARY(NOT, 1.0 - a[i])
        /* the Apple's reals: see reals.h */
        UNARY(REAL_ROUNDED, real_rounded(a[i]))
        BINARY(REAL_ADD, ordinary(real_add(a[i], b[i]), odd + i))
        BINARY(REAL_SUBTRACT, ordinary(real_add(a[i], -b[i]), odd + i))
        BINARY(REAL_DIVIDE, ordinary(real_divide(a[i], b[i]), odd + i))
        case REAL_MULTIPLY: { /* never into an operand's place, so that it can be done again */
            int64_t defects = 0;
            o = (double *)c;
            EACH {
                o[i] = ordinary(real_multiply(a[i], b[i]), odd + i);
                defects |= has_defect(b[i]);
            }
            if (defects)
                LOOP if (has_defect(b[i])) o[i] = ordinary(real_multiply_bytes(a[i], b[i]), odd + i);
            break;
        }
        UNARY(REAL_INT, real_int(a[i]))
        BINARY(REAL_LESS, real_less(a[i], b[i]))
        UNARY(REAL_FRACTION, real_fraction(a[i]))
        UNARY(REAL_EXPONENT, real_exponent(a[i]))
        BINARY(REAL_HALVED, real_halved(a[i], b[i], odd + i))
        UNARY(REAL_WHOLE, floor(real_cut(a[i])))
        BINARY(REAL_SCALED, ordinary(real_scaled(a[i], b[i]), odd + i))
        UNARY(REAL_ORDINARY, ordinary(a[i], odd + i))
        UNARY(ODD, odd[i] || a[i] != 0.0 ? 1.0 : 0.0)
        UNARY(COPY, a[i])
        /* a result: no negative zero, and one NaN for all that is none */
        UNARY(RESULT, a[i] - a[i] == 0.0 ? a[i] + 0.0 : NAN)
        UNARY(RESULT_OR_INFINITE, a[i] == a[i] ? a[i] + 0.0 : NAN)
        case BITS: {
            uint16_t *bits = (uint16_t *)b;
            EACH bits[i] = (uint16_t)(int32_t)a[i];
            break;
        }
        case SINE_AND_COSINE: {
            double *sine = (double *)b, *cosine = (double *)c;
            const double *turn = circle->turn;
            const int64_t last = circle->steps - 1, quarter = circle->steps / 4;
            EACH {
                double shifted = a[i] * circle->per_step + circle->shift;
                int64_t index;
                memcpy(&index, &shifted, 8);
                index &= last;
                double x = turn[index], y = turn[index + quarter];
                double rest = a[i] - (shifted - circle->shift) * circle->step;
                double square = rest * rest;
                double small = ((square * circle->s2 + circle->s1) * square + circle->s0) * rest;
                double less = (square * circle->c2 + circle->c1) * square;
                sine[i] = x + (y * small + x * less);
                cosine[i] = y + (y * less - x * small);
            }
            break;
        }
        }
    }
}

/* Runs a program over ``count`` scenes and returns how many were done: fewer where a column left
   the limits that the program relies on (nothing is written of the strip where it does).

   Values have places. The first ``read`` are columns in memory, those up to ``moving`` results in
   memory of ``width`` bytes a scene, ``given`` says where. All others are strips of ``room`` that
   stay: first ``scalars``, numbers that are the same for all scenes; what the ``once`` first steps
   make of them; and what the other steps need in between. ``room`` has a strip for each place.

   checked: columns of which every number must lie between limits[2k] and limits[2k + 1]. */
EXPORT CLONES int64_t run(
    const step *steps, int64_t once, int64_t length,
    char *const *given, const int64_t *width, int64_t read, int64_t moving,
    const double *scalars, int64_t scalar_count,
    const double *const *checked, const double *limits, int64_t checks,
    int64_t count, const circle *circle, double *room, int64_t places)
{
    double *place[PLACES];
    int64_t odd[STRIP] = {0};
    for (int64_t p = 0; p < places; p++) place[p] = room + p * STRIP;
    for (int64_t k = 0; k < scalar_count; k++)
        for (int i = 0; i < STRIP; i++) place[moving + k][i] = scalars[k];
    perform(steps, once, place, circle, given, 0, 0, odd, STRIP);
    int64_t always[STRIP]; /* what the scenes share makes all of them odd */
    memcpy(always, odd, sizeof odd);
    const int lanes = STRIP;
    int64_t fetched = count * read > CACHED ? moving : 0;
    for (int64_t start = 0; start < count; start += STRIP) {
        int64_t many = count - start < STRIP ? count - start : STRIP;
        for (int64_t k = 0; k < checks; k++) {
            const double *x = checked[k] + start, least = limits[2 * k], most = limits[2 * k + 1];
            int64_t outside = 0;
            for (int64_t i = 0; i < many; i++) outside |= !((x[i] >= least) & (x[i] <= most));
            if (outside) return start;
        }
        int whole = many == STRIP;
        memcpy(odd, always, sizeof odd);
        for (int64_t p = 0; p < moving; p++) {
            char *here = given[p] + start * width[p];
            place[p] = whole ? (double *)here : room + p * STRIP;
            if (!whole && p < read)
                LOOP place[p][i] = ((double *)here)[i < many ? i : 0];
        }
        perform(steps + once, length - once, place, circle, given, (start + AHEAD * STRIP) * 8, whole ? fetched : 0, odd, STRIP);
        for (int64_t p = read; p < moving && !whole; p++)
            memcpy(given[p] + start * width[p], place[p], (size_t)(many * width[p]));
    }
    return count;
}

/* The least and the largest of each column, both NaN where one is. */
EXPORT CLONES void survey(const double *const *columns, int64_t many, int64_t count, double *found)
{
    enum { lanes = 32 }; /* enough for every instruction set to keep several comparisons going */
    for (int64_t k = 0; k < many; k++) {
        const double *x = columns[k];
        double least[lanes], most[lanes];
        int64_t odd[lanes] = {0}, at = 0;
        LOOP least[i] = most[i] = x[0];
        for (; at + lanes <= count; at += lanes)
            EACH {
                double y = x[at + i];
                least[i] = y < least[i] ? y : least[i];
                most[i] = y > most[i] ? y : most[i];
                odd[i] |= y != y;
            }
        for (; at < count; at++) {
            least[0] = x[at] < least[0] ? x[at] : least[0];
            most[0] = x[at] > most[0] ? x[at] : most[0];
            odd[0] |= x[at] != x[at];
        }
        for (int i = 1; i < lanes; i++) {
            least[0] = least[i] < least[0] ? least[i] : least[0];
            most[0] = most[i] > most[0] ? most[i] : most[0];
            odd[0] |= odd[i];
        }
        found[2 * k] = odd[0] | (x[0] != x[0]) ? NAN : least[0];
        found[2 * k + 1] = odd[0] | (x[0] != x[0]) ? NAN : most[0];
    }
}

#include "texts.h"

EXPORT int64_t strip(void) { return STRIP; }
EXPORT int64_t most_places(void) { return PLACES; }
EXPORT int64_t text_width(void) { return TEXT_WIDTH; }

EXPORT const char *instructions(void)
{
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__)
    if (__builtin_cpu_supports("x86-64-v4")) return "AVX-512";
    if (__builtin_cpu_supports("avx2")) return "AVX2";
    return "SSE2";
#else
    return "baseline";
#endif
}

/* setuptools exports this name from every extension; nobody imports this one. */
EXPORT void *PyInit__machine(void) { return 0; }
