/* The impact of many scenes: whatever of it is asked for, of scenes of every kind.

   A strip of scenes of one kind is computed by `compute_loops` (loops.h), which has every formula once.
   Scenes are taken a tile at a time, a few strips. Those of the commonest kind are computed where
   they are; of each other kind they are collected, computed, and put in place. A scene whose numbers
   cannot be used is NaN. */

/* Scenes in a strip: the rows of the commonest questions fit the first-level cache. */
#define STRIP 32
/* Rows at a distance of a power of two would drive each other out of the cache. */
#define ROW_LENGTH (STRIP + 8)
/* Scenes in a tile. Its columns are copied side by side and looked at before any scene is computed: long
   runs through memory are what the processor fetches ahead by itself, and columns whose places
   differ by a power of two, as those of 16,384 scenes do, do not drive each other out of the caches.
   The copy stays in the second-level cache. */
#define TILE (32 * STRIP)

/* The operations, by the names that expressions have for them. A condition is 1 or 0. */
#define NEGATIVE(a) (-(a))
#define ABSOLUTE(a) fabs(a)
#define SQRT(a) sqrt(a)
#define ADD(a, b) ((a) + (b))
#define SUBTRACT(a, b) ((a) - (b))
#define MULTIPLY(a, b) ((a) * (b))
#define DIVIDE(a, b) ((a) / (b))
#define MINIMUM(a, b) ((b) < (a) ? (b) : (a))
#define AGAINST(a, b) ((b) > 0.0 ? -(a) : (a))
#define CHOOSE(a, b, c) ((a) ? (b) : (c))
#define EQUAL(a, b) ((a) == (b))
#define LESS(a, b) ((a) < (b))
#define LESS_OR_EQUAL(a, b) ((a) <= (b))
#define EITHER(a, b) ((a) | (b))
#define BOTH(a, b) ((a) & (b))
#define NOT(a) (!(a))
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

/* What sines and cosines are made of. */
typedef struct {
    const double *turn;
    double per_step, step, shift;
    double s0, s1, s2, c1, c2;
    int64_t steps;
} circle;

/* Some of the loops of loops.h, a bit for each. */
typedef struct {
    uint64_t bits[2];
} loop_set;
#define HAS(set, loop) ((set).bits[(loop) / 64] >> (loop) % 64 & 1)
#define COLUMN(name) const double *restrict name = in[AT_##name];

/* Rows begin where a vector does: across the borders of cache lines loops take a fifth longer. */
#ifdef __GNUC__
#define ALIGNED __attribute__((aligned(64)))
#else
#define ALIGNED
#endif

/* What is needed soon is fetched into the second-level cache beside the computing. */
#ifdef __GNUC__
#define FETCH(address) __builtin_prefetch(address, 0, 2)
#define FETCH_RESULT(address) __builtin_prefetch(address, 1, 2)
#else
#define FETCH(address) (void)(address)
#define FETCH_RESULT(address) (void)(address)
#endif
#define FETCH_COLUMN(name) \
    for (int64_t i = 0; i < lanes; i += 8) FETCH(ahead[AT_##name] + i);
/* Scenes between those that are written and those whose results' memory is fetched. */
#define RESULTS_AHEAD 128

#include "loops.h"

EXPORT const char *formulas(void) { return FORMULAS; }
EXPORT const char *results(void) { return NAMES_OF_RESULTS; }

#define UNUSED_BY_POINTS \
    (1u << AT_DA | 1u << AT_DB | 1u << AT_PA | 1u << AT_PB | 1u << AT_TA | 1u << AT_TB \
     | 1u << AT_IA | 1u << AT_IB | 1u << AT_EM)
#define BODY_CONSTANTS (1u << AT_MA | 1u << AT_MB | 1u << AT_IA | 1u << AT_IB)
#define ANGLES (1u << AT_GA | 1u << AT_PA | 1u << AT_PB | 1u << AT_TA | 1u << AT_TB)
#define LARGE_ANGLE 720.0 /* as in closedform/columns.py */
#define PIVOT_MU -10
#define NOT_FINITE 64 /* of STATUS */
#define REFUSED KINDS /* the kind of a scene whose numbers cannot be used */

/* ``column``: a number for each scene, or one for all where ``step`` is 0. ``result``: 0 where it is
   not wanted. ``limits``: the least and the most of each column that is ordinary. */
typedef struct {
    const double *column[COLUMNS];
    int64_t step[COLUMNS];
    void *result[RESULTS];
    const double *limits;
    const circle *circle;
} impacts;

/* What is done for a kind of scenes, and where a strip's values are. */
typedef struct {
    loop_set loops[KINDS];
    int64_t count, wanted[RESULTS];
    double fixed[COLUMNS][ROW_LENGTH] ALIGNED;
    double row[ROWS][ROW_LENGTH] ALIGNED;
} work;

/* -- looking at columns */

static int64_t is_ordinary(const impacts *c, int k, double x)
{
    return k == AT_M ? x == 4 || x == 6 : x >= c->limits[2 * k] && x <= c->limits[2 * k + 1];
}

/* Copy ``count`` numbers of a column; whether one is outside the limits. */
static CLONES int64_t bring_near(
    const double *restrict from, double *restrict to, int64_t count, double least, double most)
{
    int64_t outside = 0;
    INDEPENDENT for (int64_t i = 0; i < count; i++)
    {
        double x = from[i];
        to[i] = x;
        outside |= !((x >= least) & (x <= most));
    }
    return outside;
}

static CLONES int64_t count_equal(const double *x, int64_t count, double value)
{
    int64_t found = 0;
    for (int64_t i = 0; i < count; i++) found += x[i] == value;
    return found;
}

/* Whether constants call for a look at each scene. Those of a rigid barrier do not: an infinite mass
   or inertia beside speeds of that body that are constants, too, and 0. */
static int64_t have_odd_constants(const impacts *c, int64_t points)
{
    static const int speeds[][3] = {
        {AT_MA, AT_UX, AT_UY}, {AT_IA, AT_WA, AT_WA}, {AT_MB, AT_VX, AT_VY}, {AT_IB, AT_WB, AT_WB}};
    uint32_t infinite = 0, bodies = 0;
    for (int k = 0; k < COLUMNS; k++) {
        if (c->step[k] || (points && UNUSED_BY_POINTS >> k & 1)) continue;
        double x = *c->column[k];
        if (is_ordinary(c, k, x) || (ANGLES >> k & 1 && fabs(x) <= DBL_MAX)) continue;
        if (!(BODY_CONSTANTS >> k & 1) || x != INFINITY) return 1;
        infinite |= 1u << k;
    }
    if (!infinite) return 0;
    if (c->step[AT_M]) return 1;
    for (int n = 0; n < 4; n++) {
        if (!(infinite >> speeds[n][0] & 1)) continue;
        bodies |= n < 2 ? 1 : 2;
        for (int m = 1; m < 3; m++)
            if (c->step[speeds[n][m]] || *c->column[speeds[n][m]] != 0) return 1;
    }
    return bodies == 3;
}

static double within_a_turn(double angle)
{
    return fabs(angle) <= LARGE_ANGLE ? angle : fmod(angle, 360.0);
}

/* A tile: its scenes' numbers of the columns that vary, and of each scene what is found of it. */
typedef struct {
    int64_t count;
    double near[COLUMNS][TILE + 8] ALIGNED;
    int64_t bad[TILE], points[TILE];
    uint8_t kinds[TILE];
} tile;

/* Mark scenes whose number of a column cannot be used, but those ``spared``. */
static CLONES void mark_unusable(
    const double *x, int64_t count, int64_t inertia, const int64_t *spared, int64_t *bad)
{
    if (inertia)
        INDEPENDENT for (int64_t i = 0; i < count; i++) bad[i] |= !spared[i] & !(x[i] > 0);
    else
        INDEPENDENT for (int64_t i = 0; i < count; i++) bad[i] |= !spared[i] & !(fabs(x[i]) <= DBL_MAX);
}

/* Mark scenes of a rigid barrier that moves, or of two. */
static void mark_barriers(const impacts *c, tile *t)
{
#define AT(name) (c->step[AT_##name] ? t->near[AT_##name][i] : *c->column[AT_##name])
    for (int64_t i = 0; i < t->count; i++) {
        int64_t spins = !t->points[i], a = AT(MA) == INFINITY, b = AT(MB) == INFINITY;
        int64_t turn_a = spins & (AT(IA) == INFINITY), turn_b = spins & (AT(IB) == INFINITY);
        t->bad[i] |= a & ((AT(UX) != 0) | (AT(UY) != 0));
        t->bad[i] |= b & ((AT(VX) != 0) | (AT(VY) != 0));
        t->bad[i] |= (turn_a & (AT(WA) != 0)) | (turn_b & (AT(WB) != 0));
        t->bad[i] |= (a | turn_a) & (b | turn_b);
    }
}

/* Mark the scenes of a tile whose numbers cannot be used, and bring angles within a turn. */
static void look_at_each(const impacts *c, tile *t)
{
    static const int64_t none[TILE];
    int64_t infinite = 0;
    for (int64_t i = 0; i < t->count; i++) {
        double m = AT(M);
        t->points[i] = m == 4;
        t->bad[i] = !((m == 4) | (m == 6));
    }
    for (int k = 0; k < AT_M; k++) {
        const int64_t *spared = UNUSED_BY_POINTS >> k & 1 ? t->points : none;
        int64_t inertia = BODY_CONSTANTS >> k & 1;
        double x = *c->column[k], *y = t->near[k];
        if (inertia) infinite |= c->step[k] ? count_equal(y, t->count, INFINITY) : x == INFINITY;
        if (c->step[k]) mark_unusable(y, t->count, inertia, spared, t->bad);
        else if (inertia ? !(x > 0) : !(fabs(x) <= DBL_MAX))
            for (int64_t i = 0; i < t->count; i++) t->bad[i] |= !spared[i];
        if (c->step[k] && ANGLES >> k & 1)
            for (int64_t i = 0; i < t->count; i++) y[i] = within_a_turn(y[i]);
    }
    if (infinite) mark_barriers(c, t);
}

/* The kind of each scene of a tile, and how many there are of each; ``odd``: some may be REFUSED. */
static void find_kinds(const impacts *c, tile *t, int64_t odd, int64_t *numbers)
{
    if (odd) look_at_each(c, t);
    for (int64_t i = 0; i < t->count; i++) {
        int kind = 2 * (AT(M) == 4) + (AT(MU) == PIVOT_MU);
        t->kinds[i] = (uint8_t)(odd && t->bad[i] ? REFUSED : kind);
    }
    for (int64_t i = 0; i < t->count; i++) numbers[t->kinds[i]]++;
}

/* -- computing */

/* The loops that the wanted results need; the numbers of constant columns and results. */
static void prepare(const impacts *c, work *w, int64_t lanes)
{
    memset(w->loops, 0, sizeof w->loops);
    w->count = 0;
    for (int r = 0; r < RESULTS; r++) {
        if (!c->result[r]) continue;
        w->wanted[w->count++] = r;
        for (int k = 0; k < KINDS; k++)
            for (int n = 0; n < 2; n++) w->loops[k].bits[n] |= loops_of[k][r].bits[n];
    }
    for (int k = 0; k < COLUMNS; k++) {
        if (c->step[k]) continue;
        double x = *c->column[k];
        if (ANGLES >> k & 1) x = within_a_turn(x);
        LOOP w->fixed[k][i] = x;
    }
    /* without arms any sine of theirs will do */
    if (!c->step[AT_DA] && !c->step[AT_DB] && *c->column[AT_DA] == 0 && *c->column[AT_DB] == 0) {
        for (int k = 0; k < KINDS; k++)
            for (int n = 0; n < 2; n++) w->loops[k].bits[n] &= ~sines_of_arms.bits[n];
        for (int n = 0; n < (int)(sizeof rows_of_arms / sizeof *rows_of_arms); n++)
            LOOP w->row[rows_of_arms[n]][i] = 0.0;
    }
}

/* One NaN for all that is none, and no negative zero. */
static CLONES void finish(const double *restrict x, double *restrict to, int64_t count)
{
    INDEPENDENT for (int64_t i = 0; i < count; i++) to[i] = x[i] - x[i] == 0.0 ? x[i] + 0.0 : NAN;
}

static CLONES void finish_infinite(const double *restrict x, double *restrict to, int64_t count)
{
    INDEPENDENT for (int64_t i = 0; i < count; i++) to[i] = x[i] == x[i] ? x[i] + 0.0 : NAN;
}

static CLONES void finish_bits(const double *restrict x, uint16_t *restrict to, int64_t count)
{
    INDEPENDENT for (int64_t i = 0; i < count; i++) to[i] = (uint16_t)(int32_t)x[i];
}

/* Write a result of ``count`` scenes that were computed, ``to`` its memory. */
static void hand_over(const work *w, int kind, int r, const double *const *in, void *to, int64_t count)
{
    int place = place_of[kind][r];
    double number[ROW_LENGTH];
    const double *x = place < ROW ? in[place] : w->row[place - ROW];
    if (place >= CONSTANT) {
        for (int64_t i = 0; i < count; i++) number[i] = constants[place - CONSTANT];
        x = number;
    }
    if (r == TO_STATUS) finish_bits(x, to, count);
    else if (r == TO_COND) finish_infinite(x, to, count);
    else finish(x, to, count);
}

/* Where a result of scene ``at`` is written. */
static void *result_at(const impacts *c, int r, int64_t at)
{
    return (char *)c->result[r] + at * (r == TO_STATUS ? 2 : 8);
}

/* Compute the scenes of a strip, with as many beside them as fill vectors. */
static void compute(
    const impacts *c, work *w, int kind, const double *const *in, const double *const *ahead,
    int64_t count)
{
    compute_loops(in, ahead, w->row, c->circle, w->loops[kind], (count + 7) / 8);
}

/* Compute the scenes of a kind of the tile from ``at`` on, and put them in place. */
static void compute_apart(const impacts *c, work *w, int kind, const tile *t, int64_t at)
{
    double copy[COLUMNS][ROW_LENGTH] ALIGNED, found[STRIP];
    uint16_t bits[STRIP];
    const double *in[COLUMNS];
    for (int k = 0; k < COLUMNS; k++) in[k] = c->step[k] ? copy[k] : w->fixed[k];
    for (int64_t from = 0; from < t->count;) {
        int64_t place[ROW_LENGTH], many = 0;
        for (; from < t->count && many < STRIP; from++)
            if (t->kinds[from] == kind) place[many++] = from;
        if (!many) return;
        for (int64_t i = many; i < (many + 7) / 8 * 8; i++) place[i] = place[0];
        for (int k = 0; k < COLUMNS; k++)
            for (int64_t i = 0; i < (many + 7) / 8 * 8 && c->step[k]; i++)
                copy[k][i] = t->near[k][place[i]];
        compute(c, w, kind, in, in, many);
        for (int64_t n = 0; n < w->count; n++) {
            int r = (int)w->wanted[n];
            if (r == TO_STATUS) {
                uint16_t *to = result_at(c, r, at);
                hand_over(w, kind, r, in, bits, many);
                for (int64_t i = 0; i < many; i++) to[place[i]] = bits[i];
            } else {
                double *to = result_at(c, r, at);
                hand_over(w, kind, r, in, found, many);
                for (int64_t i = 0; i < many; i++) to[place[i]] = found[i];
            }
        }
    }
}

static void refuse(const impacts *c, const work *w, int64_t scene)
{
    for (int64_t n = 0; n < w->count; n++) {
        int r = (int)w->wanted[n];
        if (r == TO_STATUS) *(uint16_t *)result_at(c, r, scene) = NOT_FINITE;
        else *(double *)result_at(c, r, scene) = NAN;
    }
}

/* Compute the scenes of the commonest kind where they are: ``count`` from ``at`` on. */
static void compute_together(
    const impacts *c, work *w, int kind, const tile *t, int64_t at, int64_t stop)
{
    const double *in[COLUMNS], *ahead[COLUMNS];
    for (int k = 0; k < COLUMNS; k++) in[k] = c->step[k] ? t->near[k] : w->fixed[k];
    for (int64_t from = 0; from < t->count; from += STRIP) {
        int64_t many = t->count - from < STRIP ? t->count - from : STRIP;
        for (int k = 0; k < COLUMNS; k++) {
            int64_t there = at + from + TILE + STRIP <= stop && c->step[k];
            ahead[k] = there ? c->column[k] + at + from + TILE : in[k];
        }
        compute(c, w, kind, in, ahead, many);
        for (int64_t n = 0; n < w->count; n++) {
            int r = (int)w->wanted[n];
            hand_over(w, kind, r, in, result_at(c, r, at + from), many);
            for (int i = 0; i < STRIP && at + from + RESULTS_AHEAD + STRIP <= stop; i += 8)
                FETCH_RESULT((double *)result_at(c, r, at + from + RESULTS_AHEAD) + i);
        }
        for (int k = 0; k < COLUMNS; k++)
            if (c->step[k]) in[k] += STRIP;
    }
}

/* Scenes ``start`` to ``stop`` of columns that are anywhere. */
EXPORT void solve_impacts(const impacts *c, int64_t start, int64_t stop)
{
    work w;
    tile t;
    int64_t only_points = !c->step[AT_M] && *c->column[AT_M] == 4;
    int64_t odd_always = have_odd_constants(c, only_points);
    prepare(c, &w, stop - start < STRIP ? (stop - start + 7) / 8 * 8 : STRIP);

    for (int64_t at = start; at < stop; at += TILE) {
        int64_t count = stop - at < TILE ? stop - at : TILE, odd = odd_always;
        t.count = count;
        for (int k = 0; k < COLUMNS; k++) {
            if (!c->step[k]) continue;
            int64_t outside = bring_near(
                c->column[k] + at, t.near[k], count, c->limits[2 * k], c->limits[2 * k + 1]);
            for (int64_t i = count; i % 8; i++) t.near[k][i] = t.near[k][0];
            if (k != AT_M && !(only_points && UNUSED_BY_POINTS >> k & 1)) odd |= outside;
        }

        /* how many there are of each kind; the commonest is `most` */
        int64_t numbers[KINDS + 1] = {0}, pivots, points, six;
        pivots = c->step[AT_MU] ? count_equal(t.near[AT_MU], count, PIVOT_MU)
                                : *c->column[AT_MU] == PIVOT_MU ? count : 0;
        points = c->step[AT_M] ? count_equal(t.near[AT_M], count, 4) : only_points ? count : 0;
        six = c->step[AT_M] ? count_equal(t.near[AT_M], count, 6) : count - points;
        if (pivots % count == 0 && (points == count || six == count) && !odd)
            numbers[2 * (points == count) + (pivots == count)] = count;
        else find_kinds(c, &t, odd || points + six < count, numbers);
        int most = FRICTION;
        for (int k = 0; k < KINDS; k++)
            if (numbers[k] > numbers[most]) most = k;

        if (numbers[most]) compute_together(c, &w, most, &t, at, stop);
        for (int k = 0; k < KINDS; k++)
            if (k != most && numbers[k]) compute_apart(c, &w, k, &t, at);
        for (int64_t i = 0; i < count && numbers[REFUSED]; i++)
            if (t.kinds[i] == REFUSED) refuse(c, &w, at + i);
    }
}

/* Values in one array: a row of each of some columns, then single numbers. Of those and of the results
   wanted but STATUS, which are rows, too, only the places are known. */
typedef struct {
    impacts rest;
    int64_t columns, numbers, results, given[COLUMNS], wanted[RESULTS];
} rows;

/* Scenes ``start`` to ``stop`` of ``count``. */
EXPORT void solve_rows(
    const rows *its, const double *values, double *results, uint16_t *status, int64_t count,
    int64_t start, int64_t stop)
{
    impacts c = its->rest;
    const double *numbers = values + its->columns * count;
    for (int64_t k = 0; k < its->columns; k++) c.column[its->given[k]] = values + k * count;
    for (int64_t k = 0; k < its->numbers; k++) c.column[its->given[its->columns + k]] = numbers + k;
    for (int64_t r = 0; r < its->results; r++) c.result[its->wanted[r]] = results + r * count;
    c.result[TO_STATUS] = status;
    solve_impacts(&c, start, stop);
}
