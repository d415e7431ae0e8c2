/* A machine for plans: it runs a program of elementwise operations over columns of doubles.

   The program says what is computed; nothing of any formula stands here. Scenes are taken a strip
   at a time, so short that all working values stay in the first-level cache. Every operation is
   the IEEE one, rounded by itself: the file must be compiled with -ffp-contract=off.

   No Python here: the functions are called through ctypes, which releases the interpreter's lock. */

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#ifdef _MSC_VER
#define restrict __restrict
#endif
#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

#ifdef _MSC_VER
#define ALWAYS_INLINE __forceinline
#else
#define ALWAYS_INLINE __attribute__((always_inline))
#endif

/* One body, compiled for several instruction sets, chosen when the library is loaded; for one where
   the sanitizers look on, which takes a third of the time. */
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__)
#ifndef __SANITIZE_ADDRESS__
#define SEVERAL_SETS
#endif
#endif
#ifdef SEVERAL_SETS
#define CLONES __attribute__((target_clones("default", "avx2", "arch=x86-64-v4")))
#else
#define CLONES
#endif

/* Scenes in a strip. For the six velocities 64 and 256 take as long within a tenth, 32 a quarter longer
   (AVX-512, columns in cache); the working values of 128 fit the second-level cache. */
#ifndef STRIP
#define STRIP 128
#endif

/* Values a program may keep at a time. */
#define PLACES 1024

#define LOOP for (int i = 0; i < lanes; i++)
#if defined(__GNUC__) && !defined(__clang__)
#define INDEPENDENT _Pragma("GCC ivdep")
#elif defined(__clang__)
#define INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define INDEPENDENT __pragma(loop(ivdep))
#endif
#define EACH INDEPENDENT LOOP

/* Each operation, by the name that expressions have for it; what it makes of one scene's numbers stands
   below. A condition is 1 or 0, a number's sign of zero counts for nothing. */
#define UNARIES(X) X(NEGATIVE) X(ABSOLUTE) X(SQRT) X(NOT) X(RESULT) X(RESULT_OR_INFINITE)
#define BINARIES(X) \
    X(ADD) X(SUBTRACT) X(MULTIPLY) X(DIVIDE) X(MINIMUM) X(AGAINST) X(EQUAL) X(LESS) X(LESS_OR_EQUAL) X(EITHER) X(BOTH)
#define TERNARIES(X) X(PRODUCT_PLUS) X(PRODUCT_MINUS) X(MINUS_PRODUCT) X(CHOOSE)
#define QUATERNARIES(X) X(PRODUCTS_PLUS) X(PRODUCTS_MINUS)
#define OPERATIONS(X) \
    UNARIES(X) BINARIES(X) TERNARIES(X) QUATERNARIES(X) X(SINE_AND_COSINE) X(BITS) X(COPY) \
    X(REAL_ROUNDED) X(REAL_ADD) X(REAL_SUBTRACT) X(REAL_MULTIPLY) X(REAL_DIVIDE) X(REAL_INT) \
    X(REAL_LESS) X(REAL_FRACTION) X(REAL_EXPONENT) X(REAL_HALVED) X(REAL_WHOLE) X(REAL_SCALED) \
    X(REAL_ORDINARY) X(ODD)

#define NEGATIVE(a) (-(a))
#define ABSOLUTE(a) fabs(a)
#define SQRT(a) sqrt(a)
#define NOT(a) ((a) == 0)
#define RESULT(a) ((a) - (a) == 0.0 ? (a) + 0.0 : NAN) /* no negative zero, one NaN for all that is none */
#define RESULT_OR_INFINITE(a) ((a) == (a) ? (a) + 0.0 : NAN)
#define ADD(a, b) ((a) + (b))
#define SUBTRACT(a, b) ((a) - (b))
#define MULTIPLY(a, b) ((a) * (b))
#define DIVIDE(a, b) ((a) / (b))
#define MINIMUM(a, b) ((b) < (a) ? (b) : (a))
#define AGAINST(a, b) ((b) > 0.0 ? -(a) : (a))
#define EQUAL(a, b) ((a) == (b))
#define LESS(a, b) ((a) < (b))
#define LESS_OR_EQUAL(a, b) ((a) <= (b))
#define EITHER(a, b) (((a) != 0) | ((b) != 0))
#define BOTH(a, b) (((a) != 0) & ((b) != 0))
#define PRODUCT_PLUS(a, b, c) ((a) * (b) + (c))
#define PRODUCT_MINUS(a, b, c) ((a) * (b) - (c))
#define MINUS_PRODUCT(a, b, c) ((c) - (a) * (b))
#define CHOOSE(a, b, c) ((a) != 0 ? (b) : (c))
#define PRODUCTS_PLUS(a, b, c, d) ((a) * (b) + (c) * (d))
#define PRODUCTS_MINUS(a, b, c, d) ((a) * (b) - (c) * (d))
#define BITS(a) ((uint16_t)(int32_t)(a))
/* sin a and cos a of an angle in degrees, as collision/degrees.py */
#define SINE_AND_COSINE(a, sine, cosine) \
    do { \
        double shifted = (a) * circle->per_step + circle->shift; \
        int64_t index; \
        memcpy(&index, &shifted, 8); \
        index &= circle->steps - 1; \
        double x = circle->turn[index], y = circle->turn[index + circle->steps / 4]; \
        double rest = (a) - (shifted - circle->shift) * circle->step, square = rest * rest; \
        double small = ((square * circle->s2 + circle->s1) * square + circle->s0) * rest; \
        double less = (square * circle->c2 + circle->c1) * square; \
        sine = x + (y * small + x * less); \
        cosine = y + (y * less - x * small); \
    } while (0)

#define NAME(name) name,
#define TEXT(name) #name " "
enum operation { OPERATIONS(NAME) };
EXPORT const char *operations(void) { return OPERATIONS(TEXT); }

typedef struct {
    int32_t operation;
    int32_t place[5]; /* operands, then where the value goes */
} step;

/* What sines and cosines are made of. */
typedef struct {
    const double *turn;
    double per_step, step, shift;
    double s0, s1, s2, c1, c2;
    int64_t steps;
} circle;

#include "reals.h"

static inline ALWAYS_INLINE void perform(
    const step *steps, int64_t count, double *const *place, const circle *circle, int64_t *odd,
    const int lanes)
{
    for (const step *s = steps; s < steps + count; s++) {
        const double *a = place[s->place[0]], *b = place[s->place[1]];
        const double *c = place[s->place[2]], *d = place[s->place[3]];
        double *o;
        switch (s->operation) {
#define UNARY(name) case name: o = (double *)b; EACH o[i] = name(a[i]); break;
#define BINARY(name) case name: o = (double *)c; EACH o[i] = name(a[i], b[i]); break;
#define TERNARY(name) case name: o = (double *)d; EACH o[i] = name(a[i], b[i], c[i]); break;
#define QUATERNARY(name) \
    case name: o = place[s->place[4]]; EACH o[i] = name(a[i], b[i], c[i], d[i]); break;
        UNARIES(UNARY) BINARIES(BINARY) TERNARIES(TERNARY) QUATERNARIES(QUATERNARY)
#define REAL_1(name, value) case name: o = (double *)b; EACH o[i] = (value); break;
#define REAL_2(name, value) case name: o = (double *)c; EACH o[i] = (value); break;
        /* the Apple's reals: see reals.h */
        REAL_1(REAL_ROUNDED, real_rounded(a[i]))
        REAL_2(REAL_ADD, ordinary(real_add(a[i], b[i]), odd + i))
        REAL_2(REAL_SUBTRACT, ordinary(real_add(a[i], -b[i]), odd + i))
        REAL_2(REAL_DIVIDE, ordinary(real_divide(a[i], b[i]), odd + i))
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
        REAL_1(REAL_INT, real_int(a[i]))
        REAL_2(REAL_LESS, real_less(a[i], b[i]))
        REAL_1(REAL_FRACTION, real_fraction(a[i]))
        REAL_1(REAL_EXPONENT, real_exponent(a[i]))
        REAL_2(REAL_HALVED, real_halved(a[i], b[i], odd + i))
        REAL_1(REAL_WHOLE, floor(real_cut(a[i])))
        REAL_2(REAL_SCALED, ordinary(real_scaled(a[i], b[i]), odd + i))
        REAL_1(REAL_ORDINARY, ordinary(a[i], odd + i))
        REAL_1(ODD, odd[i] || a[i] != 0.0 ? 1.0 : 0.0)
        REAL_1(COPY, a[i])
        case BITS: {
            uint16_t *bits = (uint16_t *)b;
            EACH bits[i] = BITS(a[i]);
            break;
        }
        case SINE_AND_COSINE: {
            double *sine = (double *)b, *cosine = (double *)c;
            EACH SINE_AND_COSINE(a[i], sine[i], cosine[i]);
            break;
        }
        }
    }
}

/* A program, working memory for it, and scenes.

   Values have places. The first ``read`` are columns in memory, those up to ``moving`` results in
   memory of ``width`` bytes a scene, ``given`` says where. All others are strips of ``room`` that
   stay: first ``scalars``, numbers that are the same for all scenes; what the ``once`` first steps
   make of them; and what the other steps need in between. ``room`` has a strip for each place. */
typedef struct {
    const step *steps;
    int64_t once, length;
    char *const *given;
    const int64_t *width;
    int64_t read, moving;
    const double *scalars;
    int64_t scalar_count;
    double *room;
    int64_t places, count;
    const circle *circle;
} call;

/* Runs a program over ``count`` scenes. */
EXPORT CLONES void run_program(const call *its)
{
    const call c = *its;
    double *place[PLACES];
    int64_t odd[STRIP] = {0};
    for (int64_t p = 0; p < c.places; p++) place[p] = c.room + p * STRIP;
    const int lanes = STRIP;
    for (int64_t k = 0; k < c.scalar_count; k++)
        LOOP place[c.moving + k][i] = c.scalars[k];
    perform(c.steps, c.once, place, c.circle, odd, STRIP);
    int64_t always[STRIP]; /* what the scenes share makes all of them odd */
    memcpy(always, odd, sizeof odd);
    for (int64_t start = 0; start < c.count; start += STRIP) {
        int64_t many = c.count - start < STRIP ? c.count - start : STRIP;
        int64_t full = many == STRIP;
        memcpy(odd, always, sizeof odd);
        for (int64_t p = 0; p < c.moving; p++) {
            char *here = c.given[p] + start * c.width[p];
            place[p] = full ? (double *)here : c.room + p * STRIP;
            if (!full && p < c.read)
                LOOP place[p][i] = ((double *)here)[i < many ? i : 0];
        }
        perform(c.steps + c.once, c.length - c.once, place, c.circle, odd, STRIP);
        for (int64_t p = c.read; p < c.moving && !full; p++)
            memcpy(c.given[p] + start * c.width[p], place[p], (size_t)(many * c.width[p]));
    }
}

#include "impacts.h"

/* The least and the largest of each column, both NaN where one is; of ``count`` numbers of the first
   ``many`` columns, one of the others. */
EXPORT CLONES void find_extremes(
    const double *const *columns, int64_t many, int64_t all, int64_t count, double *found)
{
    enum { lanes = 32 }; /* enough for every instruction set to keep several comparisons going */
    for (int64_t k = 0; k < all; k++) {
        const double *x = columns[k];
        double least[lanes], most[lanes];
        int64_t odd[lanes] = {0}, at = 0, length = k < many ? count : 1;
        LOOP least[i] = most[i] = x[0];
        for (; at + lanes <= length; at += lanes)
            EACH {
                double y = x[at + i];
                least[i] = y < least[i] ? y : least[i];
                most[i] = y > most[i] ? y : most[i];
                odd[i] |= y != y;
            }
        for (; at < length; at++) {
            least[0] = x[at] < least[0] ? x[at] : least[0];
            most[0] = x[at] > most[0] ? x[at] : most[0];
            odd[0] |= x[at] != x[at];
        }
        for (int i = 1; i < lanes; i++) {
            least[0] = least[i] < least[0] ? least[i] : least[0];
            most[0] = most[i] > most[0] ? most[i] : most[0];
            odd[0] |= odd[i];
        }
        odd[0] |= x[0] != x[0];
        found[2 * k] = odd[0] ? NAN : least[0];
        found[2 * k + 1] = odd[0] ? NAN : most[0];
    }
}

#include "texts.h"

EXPORT int64_t strip(void) { return STRIP; }
EXPORT int64_t most_places(void) { return PLACES; }

EXPORT const char *instructions(void)
{
#ifdef SEVERAL_SETS
    if (__builtin_cpu_supports("x86-64-v4")) return "AVX-512";
    if (__builtin_cpu_supports("avx2")) return "AVX2";
    return "SSE2";
#else
    return "baseline";
#endif
}

/* setuptools exports this name from every extension; nobody imports this one. */
EXPORT void *PyInit__machine(void) { return 0; }
