/* The listing's statements on many scenes, in the Apple's reals (reals.h): a machine that runs a program
   of elementwise operations, made by program/vectorized/compiled.py, over columns.

   Scenes are taken a strip at a time, so short that all working values stay in the caches. */

#include "reals.h"

#define REPLAYED 128 /* scenes in a strip */
#define PLACES 1024  /* values a program may keep at a time */

#define REAL_OPERATIONS(X) \
    X(NEGATIVE) X(ABSOLUTE) X(NOT) X(EQUAL) X(LESS) X(LESS_OR_EQUAL) X(EITHER) X(BOTH) X(CHOOSE) \
    X(COPY) X(REAL_ROUNDED) X(REAL_ADD) X(REAL_SUBTRACT) X(REAL_MULTIPLY) X(REAL_DIVIDE) \
    X(REAL_INT) X(REAL_LESS) X(REAL_FRACTION) X(REAL_EXPONENT) X(REAL_HALVED) X(REAL_WHOLE) \
    X(REAL_SCALED) X(REAL_ORDINARY) X(ODD)
#define TEXT(name) #name " "
#define DO(name) DO_##name,
enum operation { REAL_OPERATIONS(DO) };
EXPORT const char *operations(void) { return REAL_OPERATIONS(TEXT); }

typedef struct {
    int32_t operation;
    int32_t place[4]; /* operands, then where the value goes */
} step;

static CLONES void perform(
    const step *steps, int64_t count, double *const *place, int64_t *odd)
{
    const int64_t lanes = REPLAYED;
    for (const step *s = steps; s < steps + count; s++) {
        const double *a = place[s->place[0]], *b = place[s->place[1]], *c = place[s->place[2]];
        double *o;
        switch (s->operation) {
#define UNARY(name, value) case DO_##name: o = (double *)b; EACH o[i] = (value); break;
#define BINARY(name, value) case DO_##name: o = (double *)c; EACH o[i] = (value); break;
        UNARY(COPY, a[i])
        UNARY(NEGATIVE, -a[i])
        UNARY(ABSOLUTE, fabs(a[i]))
        UNARY(NOT, a[i] == 0.0 ? 1.0 : 0.0)
        UNARY(ODD, odd[i] || a[i] != 0.0 ? 1.0 : 0.0)
        BINARY(EQUAL, a[i] == b[i] ? 1.0 : 0.0)
        BINARY(LESS, a[i] < b[i] ? 1.0 : 0.0)
        BINARY(LESS_OR_EQUAL, a[i] <= b[i] ? 1.0 : 0.0)
        BINARY(EITHER, (a[i] != 0.0) | (b[i] != 0.0) ? 1.0 : 0.0)
        BINARY(BOTH, (a[i] != 0.0) & (b[i] != 0.0) ? 1.0 : 0.0)
        case DO_CHOOSE: o = place[s->place[3]]; EACH o[i] = a[i] != 0.0 ? b[i] : c[i]; break;
        UNARY(REAL_ROUNDED, real_rounded(a[i]))
        UNARY(REAL_INT, real_int(a[i]))
        UNARY(REAL_FRACTION, real_fraction(a[i]))
        UNARY(REAL_EXPONENT, real_exponent(a[i]))
        UNARY(REAL_WHOLE, floor(real_cut(a[i])))
        UNARY(REAL_ORDINARY, ordinary(a[i], odd + i))
        BINARY(REAL_ADD, ordinary(real_add(a[i], b[i]), odd + i))
        BINARY(REAL_SUBTRACT, ordinary(real_add(a[i], -b[i]), odd + i))
        BINARY(REAL_DIVIDE, ordinary(real_divide(a[i], b[i]), odd + i))
        BINARY(REAL_LESS, real_less(a[i], b[i]))
        BINARY(REAL_HALVED, real_halved(a[i], b[i], odd + i))
        BINARY(REAL_SCALED, ordinary(real_scaled(a[i], b[i]), odd + i))
        case DO_REAL_MULTIPLY: { /* never into an operand's place, so that it can be done again */
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
        }
    }
}

/* A program, working memory for it, and scenes.

   Values have places. The first ``read`` are columns in memory, those up to ``moving`` results,
   ``given`` says where. All others are strips of ``room`` that stay: first ``scalars``, numbers that
   are the same for all scenes; what the ``once`` first steps make of them; and what the other steps
   need in between. ``room`` has a strip for each place. */
typedef struct {
    const step *steps;
    int64_t once, length;
    double *const *given;
    int64_t read, moving;
    const double *scalars;
    int64_t scalar_count;
    double *room;
    int64_t places, count;
} replay;

/* Runs a program over ``count`` scenes. */
EXPORT void run_program(const replay *its)
{
    const replay c = *its;
    const int64_t lanes = REPLAYED;
    double *place[PLACES];
    int64_t always[REPLAYED] = {0}, odd[REPLAYED];
    for (int64_t p = 0; p < c.places; p++) place[p] = c.room + p * REPLAYED;
    for (int64_t k = 0; k < c.scalar_count; k++)
        LOOP place[c.moving + k][i] = c.scalars[k];
    perform(c.steps, c.once, place, always); /* what the scenes share makes all of them odd */
    for (int64_t start = 0; start < c.count; start += REPLAYED) {
        int64_t many = c.count - start < REPLAYED ? c.count - start : REPLAYED;
        int64_t full = many == REPLAYED;
        memcpy(odd, always, sizeof odd);
        for (int64_t p = 0; p < c.moving; p++) {
            place[p] = full ? c.given[p] + start : c.room + p * REPLAYED;
            if (!full && p < c.read)
                LOOP place[p][i] = c.given[p][start + (i < many ? i : 0)];
        }
        perform(c.steps + c.once, c.length - c.once, place, odd);
        for (int64_t p = c.read; p < c.moving && !full; p++)
            memcpy(c.given[p] + start, place[p], (size_t)many * sizeof(double));
    }
}

EXPORT int64_t replayed_together(void) { return REPLAYED; }
EXPORT int64_t most_places(void) { return PLACES; }
