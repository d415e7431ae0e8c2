/* The impact as a whole, over scenes of all kinds: each kind's formulas with numbers that stay in
   registers (kernels.h), the same operations as the programs that numpy runs.

   Scenes are taken a strip at a time. The kernel of the kind that most scenes of a strip are of runs
   over all of it, on the columns themselves; scenes of another kind, or with angles of many turns,
   are collected until they fill a strip, then computed by their own kernel, and put in place. A scene
   whose numbers cannot be used is NaN. Constants are strips filled once. */

/* Eight scenes fill a cache line of each column: one vector, or a few, and one line to fetch. */
#define EACH_EIGHT for (int64_t eight = 0; eight < 8 * eights; eight += 8)
#define EACH_OF_EIGHT INDEPENDENT for (int64_t i = eight; i < eight + 8; i++)
#ifdef __GNUC__
#define FETCH(name) __builtin_prefetch(ahead[AT_##name] + eight, 0, 2);
#define FETCH_RESULT(address) __builtin_prefetch(address, 1, 2)
#else
#define FETCH(name)
#define FETCH_RESULT(address)
#endif

/* ``ahead``: the columns of later scenes, fetched into the second-level cache while these are computed. */
typedef void (*kernel)(
    const double *const *in, double *const *out, const circle *circle, const double *const *ahead,
    int64_t eights);

#include "kernels.h"

/* A body with the results it keeps: the compiler leaves out what these do not need. */
#define KERNEL(number, kind, body, results, cost) \
    static CLONES void kernel_##number( \
        const double *const *in, double *const *out, const circle *circle, \
        const double *const *ahead, int64_t eights) \
    { \
        body(in, out, circle, ahead, eights, results##u); \
    }
KERNELS(KERNEL)

#define ROW(number, kind, body, results, cost) {kind, results##u, kernel_##number, cost},
static const struct {
    int64_t body;
    uint64_t results;
    kernel run;
    int64_t cost;
} kernels[] = {KERNELS(ROW)};

/* The place of the first kernel of a body that has all results wanted, or -1. */
static int64_t find_kernel(int64_t body, uint64_t wanted)
{
    for (int64_t k = 0; k < (int64_t)(sizeof kernels / sizeof *kernels); k++)
        if (kernels[k].body == body && !(wanted & ~kernels[k].results)) return k;
    return -1;
}

/* That kernel, or 0. */
EXPORT kernel kernel_of(int64_t body, uint64_t wanted)
{
    int64_t k = find_kernel(body, wanted);
    return k < 0 ? 0 : kernels[k].run;
}

/* Its cost in operations, or 0. */
EXPORT int64_t cost_of(int64_t body, uint64_t wanted)
{
    int64_t k = find_kernel(body, wanted);
    return k < 0 ? 0 : kernels[k].cost;
}

EXPORT const char *formulas(void) { return FORMULAS; }

/* Strips whose columns are copied side by side and looked at before any is computed, where there are
   more: long runs through memory are what the processor fetches ahead by itself, and columns whose
   places differ by a power of two, as those of 16,384 scenes do, do not drive each other out of the
   caches. So many scenes' columns stay in the second-level cache. */
#ifndef AT_ONCE
#define AT_ONCE 16
#endif

/* Strips of results fetched ahead of those that are written. */
#define RESULTS_AHEAD 4

/* Strips that go to the full kernels after one in which a filter left too many scenes undecided. */
#define UNFILTERED 15

#define UNUSED_BY_POINTS \
    (1u << AT_DA | 1u << AT_DB | 1u << AT_PA | 1u << AT_PB | 1u << AT_TA | 1u << AT_TB \
     | 1u << AT_IA | 1u << AT_IB | 1u << AT_EM)
#define INERTIAS (1u << AT_MA | 1u << AT_MB | 1u << AT_IA | 1u << AT_IB)
#define ANGLES (1u << AT_GA | 1u << AT_PA | 1u << AT_PB | 1u << AT_TA | 1u << AT_TB)
#define LARGE_ANGLE 720.0 /* as in closedform/written.py */
#define NOT_FINITE 64     /* of STATUS */
/* MIXED: the kernel of friction and pivots beside each other, which is no scene's kind. */
enum kind { FRICTION, PIVOT, POINT, POINT_PIVOT, REFUSED, KINDS, MIXED = REFUSED };

/* ``column``: a number for each scene, or one for all where ``step`` is 0. ``result``: 0 where it is
   not wanted. ``limits``: the least and the most of each column that is ordinary; ``moderate``: that a
   filter takes. */
typedef struct {
    const double *column[COLUMNS];
    int64_t step[COLUMNS];
    void *result[RESULTS];
    kernel kernels[KINDS], filters[KINDS];
    int64_t mixed_from[2];
    const double *limits, *moderate;
    const circle *circle;
} impacts;

/* The kind of each scene of a strip, and whether an angle has to be brought within a turn. */
static inline ALWAYS_INLINE void find_kinds(
    const double *const *x, int64_t many, int64_t *kind, int64_t *turned)
{
    int64_t points[STRIP], bad[STRIP], large[STRIP];
    for (int64_t i = 0; i < many; i++) {
        points[i] = x[AT_M][i] == 4;
        bad[i] = !(points[i] | (x[AT_M][i] == 6)), large[i] = 0;
    }
    for (int c = 0; c < AT_M; c++) {
        const double *y = x[c];
        int64_t of_points = !(UNUSED_BY_POINTS >> c & 1);
        if (INERTIAS >> c & 1)
            for (int64_t i = 0; i < many; i++) bad[i] |= (of_points | !points[i]) & !(y[i] > 0);
        else
            for (int64_t i = 0; i < many; i++)
                bad[i] |= (of_points | !points[i]) & !(fabs(y[i]) <= DBL_MAX);
        if (ANGLES >> c & 1)
            for (int64_t i = 0; i < many; i++)
                large[i] |= (of_points | !points[i]) & (fabs(y[i]) > LARGE_ANGLE);
    }
    for (int64_t i = 0; i < many; i++) {
        /* what is infinite is at rest, and one body at most */
        int64_t a = x[AT_MA][i] == INFINITY, b = x[AT_MB][i] == INFINITY, spins = !points[i];
        int64_t turn_a = spins & (x[AT_IA][i] == INFINITY), turn_b = spins & (x[AT_IB][i] == INFINITY);
        bad[i] |= a & ((x[AT_UX][i] != 0) | (x[AT_UY][i] != 0));
        bad[i] |= b & ((x[AT_VX][i] != 0) | (x[AT_VY][i] != 0));
        bad[i] |= (turn_a & (x[AT_WA][i] != 0)) | (turn_b & (x[AT_WB][i] != 0));
        bad[i] |= (a | turn_a) & (b | turn_b);
        kind[i] = bad[i] ? REFUSED : 2 * points[i] + (x[AT_MU][i] == -10);
        turned[i] = large[i] & !bad[i];
    }
}

/* Whether a number of a column is outside the limits, in scenes ``from`` to ``to``. */
static inline ALWAYS_INLINE int64_t find_odd(
    const impacts *c, const double *limits, int64_t points, int64_t from, int64_t to)
{
    int64_t odd = 0;
    for (int k = 0; k < AT_M; k++) {
        if (!c->step[k] || (points && UNUSED_BY_POINTS >> k & 1)) continue;
        const double *x = c->column[k], least = limits[2 * k], most = limits[2 * k + 1];
        int64_t outside = 0;
        for (int64_t i = from; i < to; i++) outside |= !((x[i] >= least) & (x[i] <= most));
        odd |= outside;
    }
    return odd;
}

/* Copy ``length`` scenes from ``at`` side by side; whether a number is outside the limits. */
static inline ALWAYS_INLINE int64_t bring_near(
    const impacts *c, const double *limits, int64_t points, int64_t at, int64_t length,
    double (*near)[AT_ONCE * STRIP + 8])
{
    int64_t odd = 0;
    for (int k = 0; k < COLUMNS; k++) {
        if (!c->step[k]) continue;
        const double *restrict x = c->column[k] + at;
        const double least = limits[2 * k], most = limits[2 * k + 1];
        double *restrict y = near[k];
        int64_t outside = 0;
        for (int64_t i = 0; i < length; i++) {
            y[i] = x[i];
            outside |= !((x[i] >= least) & (x[i] <= most));
        }
        if (k != AT_M && !(points && UNUSED_BY_POINTS >> k & 1)) odd |= outside;
    }
    return odd;
}

/* Whether constants call for a look at each scene. Those of a rigid barrier do not: an infinite mass
   or inertia beside speeds of that body that are constants, too, and 0. ``fixed``: with angles
   within a turn. */
static int64_t find_odd_constants(
    const impacts *c, const double *limits, int64_t points, double (*fixed)[STRIP])
{
    static const int speeds[][3] = {
        {AT_MA, AT_UX, AT_UY}, {AT_IA, AT_WA, AT_WA}, {AT_MB, AT_VX, AT_VY}, {AT_IB, AT_WB, AT_WB}};
    int64_t infinite = 0, bodies = 0;
    for (int k = 0; k < COLUMNS; k++) {
        if (c->step[k] || (points && UNUSED_BY_POINTS >> k & 1)) continue;
        double y = fixed[k][0];
        if (k == AT_M ? y == 4 || y == 6 : y >= limits[2 * k] && y <= limits[2 * k + 1]) continue;
        if (!(INERTIAS >> k & 1) || y != INFINITY) return 1;
        infinite |= (int64_t)1 << k;
    }
    if (!infinite) return 0;
    if (c->step[AT_M]) return 1;
    for (int n = 0; n < 4; n++) {
        if (!(infinite >> speeds[n][0] & 1)) continue;
        bodies |= n < 2 ? 1 : 2;
        for (int m = 1; m < 3; m++)
            if (c->step[speeds[n][m]] || fixed[speeds[n][m]][0] != 0) return 1;
    }
    return bodies == 3;
}

/* The kernel of a kind over ``eights``, of which ``many`` scenes count: its filter where ``skipped`` is
   given and 0. More than ``bearable`` scenes that this leaves undecided go to the full kernel at once,
   and so do the next strips. How many are left. */
static inline ALWAYS_INLINE int64_t run_kernel(
    const impacts *c, int k, int64_t *skipped, int64_t bearable, const double *const *in,
    double *const *out, const double *const *ahead, int64_t eights, int64_t many)
{
    int64_t undecided = 0;
    if (skipped && c->filters[k] && !skipped[k]) {
        c->filters[k](in, out, c->circle, ahead, eights);
        for (int64_t i = 0; i < many; i++) undecided += out[STATUS_AT][i] >= UNDECIDED;
        if (undecided <= bearable) return undecided;
        skipped[k] = UNFILTERED;
    } else if (skipped && skipped[k])
        skipped[k]--;
    c->kernels[k](in, out, c->circle, ahead, eights);
    return 0;
}

/* Some scenes of a strip, a bit for each. */
#define WORDS (STRIP / 64)
typedef struct {
    uint64_t words[WORDS];
} subset;

/* Those of the first ``count`` scenes for whose number ``i`` the condition holds. */
#define FIND_SUBSET(some, count, condition) \
    for (int w = 0; w < WORDS; w++) { \
        uint64_t word = 0; \
        int64_t first = 64 * w, end = (count) - first < 64 ? (count) : first + 64; \
        for (int64_t i = first; i < end; i++) word |= (uint64_t)!!(condition) << (i - first); \
        (some).words[w] = word; \
    }

static inline ALWAYS_INLINE int64_t lowest_bit(uint64_t word)
{
#ifdef __GNUC__
    return __builtin_ctzll(word);
#else
    int64_t place = 0;
    while (!(word >> place & 1)) place++;
    return place;
#endif
}

/* Scenes of one kind from anywhere, computed once there are enough of them: copied side by side while
   their strip is in cache. ``slowly``: not by a filter. */
typedef struct {
    int64_t many, slowly, place[2 * STRIP];
    double copy[COLUMNS][2 * STRIP];
} collection;

/* Add the scenes ``some`` of the strip ``x``, which is from ``at`` on. */
static inline ALWAYS_INLINE void collect(
    const impacts *c, collection *into, const double *const *x, const subset *some, int64_t at)
{
    int64_t many = into->many, first = many;
    for (int w = 0; w < WORDS; w++)
        for (uint64_t rest = some->words[w]; rest; rest &= rest - 1)
            into->place[many++] = at + 64 * w + lowest_bit(rest);
    into->many = many;
    for (int k = 0; k < COLUMNS && first < many; k++)
        for (int64_t i = first; i < many && c->step[k]; i++) into->copy[k][i] = x[k][into->place[i] - at];
}

/* The first ``n`` of a collection: computed, and put in place. ``copies``: the constants' strips. */
static inline ALWAYS_INLINE void solve_collected(
    const impacts *c, int k, collection *of, int64_t n, const double **copies, double (*found)[STRIP])
{
    double *finds[RESULTS];
    int64_t padded = (n + 7) / 8 * 8, *place = of->place;
    for (int col = 0; col < COLUMNS; col++) {
        if (!c->step[col]) continue;
        double *y = of->copy[col];
        copies[col] = y;
        if (ANGLES >> col & 1) {
            int64_t large = 0;
            for (int64_t i = 0; i < n; i++) large |= !(fabs(y[i]) <= LARGE_ANGLE);
            for (int64_t i = 0; i < n && large; i++)
                if (!(fabs(y[i]) <= LARGE_ANGLE)) y[i] = fmod(y[i], 360.0);
        }
        for (int64_t i = n; i < padded; i++) y[i] = y[0]; /* only where none are left */
    }
    for (int r = 0; r < RESULTS; r++) finds[r] = found[r];
    int64_t never[KINDS] = {0};
    run_kernel(c, k, of->slowly ? 0 : never, 0, copies, finds, copies, padded / 8, n);
    for (int r = 0; r < RESULTS; r++) {
        if (!c->result[r]) continue;
        if (r == STATUS_AT) {
            uint16_t *status = c->result[r];
            for (int64_t i = 0; i < n; i++) status[place[i]] = BITS(found[r][i]);
        } else {
            double *result = c->result[r];
            for (int64_t i = 0; i < n; i++) result[place[i]] = found[r][i];
        }
    }
    of->many -= n;
    of->slowly &= of->many > 0;
    for (int64_t i = 0; i < of->many; i++) place[i] = place[n + i];
    for (int col = 0; col < COLUMNS; col++)
        for (int64_t i = 0; i < of->many && c->step[col]; i++)
            of->copy[col][i] = of->copy[col][n + i];
}

/* Scenes ``start`` to ``stop``. */
EXPORT CLONES void solve_impacts(const impacts *its, int64_t start, int64_t stop)
{
    const impacts c = *its;
    double fixed[COLUMNS][STRIP], found[RESULTS][STRIP];
    const double *in[COLUMNS], *copies[COLUMNS], *ahead[COLUMNS];
    double near[COLUMNS][AT_ONCE * STRIP + 8], *out[RESULTS];
    int64_t together = stop - start <= AT_ONCE * STRIP, first = start;
    collection collected[REFUSED];
    int64_t skipped[KINDS] = {0};
    int64_t large_always, large_somewhere = 0, large, odd_always, odd, looked = start, only_points;
    int64_t lanes = stop - start < STRIP ? (stop - start + 7) / 8 * 8 : STRIP;

    only_points = !c.step[AT_M] && *c.column[AT_M] == 4;
    for (int k = 0; k < COLUMNS; k++) {
        if (c.step[k]) continue;
        double y = *c.column[k];
        if (ANGLES >> k & 1 && !(fabs(y) <= LARGE_ANGLE)) y = fmod(y, 360.0);
        for (int64_t i = 0; i < lanes; i++) fixed[k][i] = y;
        in[k] = copies[k] = fixed[k];
    }
    /* where a filter may run, what is large is looked for first, then what is odd among it */
    int64_t filtering = c.filters[FRICTION] || c.filters[PIVOT];
    const double *limits = filtering ? c.moderate : c.limits;
    large_always = find_odd_constants(&c, limits, only_points, fixed);
    odd_always = filtering ? find_odd_constants(&c, c.limits, only_points, fixed) : large_always;
    for (int k = 0; k < REFUSED; k++) collected[k].many = collected[k].slowly = 0;

    for (int64_t at = start; at < stop; at += STRIP) {
        int64_t many = stop - at < STRIP ? stop - at : STRIP, whole = many / 8;
        if (at >= looked) {
            int64_t length = stop - at < AT_ONCE * STRIP ? stop - at : AT_ONCE * STRIP;
            large_somewhere = large_always;
            if (together) large_somewhere |= find_odd(&c, limits, only_points, at, at + length);
            else large_somewhere |= bring_near(&c, limits, only_points, at, length, near);
            first = at, looked = at + length;
        }
        large = large_always || (large_somewhere && find_odd(&c, limits, only_points, at, at + many));
        odd = large;
        if (large && filtering) odd = odd_always || find_odd(&c, c.limits, only_points, at, at + many);
        for (int k = 0; k < COLUMNS; k++)
            if (c.step[k]) in[k] = together ? c.column[k] + at : near[k] + (at - first);
        int64_t later = at + AT_ONCE * STRIP;
        for (int k = 0; k < COLUMNS; k++)
            ahead[k] = c.step[k] && !together && later + STRIP <= stop ? c.column[k] + later : in[k];
        /* what is not wanted goes where nobody looks */
        for (int r = 0; r < RESULTS; r++)
            out[r] = c.result[r] && r != STATUS_AT ? (double *)c.result[r] + at : found[r];
        for (int r = 0; r < RESULTS; r++)
            if (c.result[r] && r != STATUS_AT && !together && at + (RESULTS_AHEAD + 1) * STRIP <= stop)
                for (int64_t i = 0; i < STRIP; i += 8) FETCH_RESULT(out[r] + RESULTS_AHEAD * STRIP + i);
        uint16_t *status = c.result[STATUS_AT] ? (uint16_t *)c.result[STATUS_AT] + at : 0;

        int64_t kind[STRIP], turned[STRIP], numbers[KINDS] = {0}, pivots = 0, most = FRICTION;
        if (c.step[AT_MU])
            for (int64_t i = 0; i < many; i++) pivots += in[AT_MU][i] == -10;
        else
            pivots = *in[AT_MU] == -10 ? many : 0;
        int64_t apart = odd || c.step[AT_M]; /* scenes are looked at one by one */
        if (odd) {
            find_kinds(in, many, kind, turned);
            for (int64_t i = 0; i < many; i++) numbers[kind[i]] += !turned[i];
        } else if (apart) {
            int64_t points = 0, six = 0;
            for (int64_t i = 0; i < many; i++) {
                points += in[AT_M][i] == 4;
                six += in[AT_M][i] == 6;
            }
            if ((pivots == 0 || pivots == many) && (points == many || six == many)) {
                apart = 0;
                numbers[2 * (points == many) + (pivots == many)] = many;
            } else
                for (int64_t i = 0; i < many; i++) {
                    int64_t m = in[AT_M][i] == 4;
                    kind[i] = m | (in[AT_M][i] == 6) ? 2 * m + (in[AT_MU][i] == -10) : REFUSED;
                    turned[i] = 0;
                    numbers[kind[i]]++;
                }
        } else {
            numbers[2 * only_points] = many - pivots;
            numbers[2 * only_points + 1] = pivots;
        }
        for (int k = 0; k < REFUSED; k++)
            if (numbers[k] > numbers[most]) most = k;

        int64_t done = numbers[most] ? 8 * whole : 0, undecided = 0;
        int64_t rarer = 2 * pivots > many, mixed = !apart && done == many;
        mixed = mixed && (rarer ? many - pivots : pivots) >= c.mixed_from[rarer];
        if (done)
            undecided = run_kernel(
                &c, mixed ? MIXED : most, large ? 0 : skipped, STRIP / 8, in, out, ahead, whole, done);
        for (int64_t i = 0; i < done && status; i++) status[i] = BITS(found[STATUS_AT][i]);
        subset some;
        for (int k = most & 2; undecided && k < (most & 2) + 2; k++) {
            if (k != most && !mixed) continue;
            FIND_SUBSET(some, done, (status[i] >= UNDECIDED)
                & (apart ? kind[i] == k : (in[AT_MU][i] == -10) == (k & 1)))
            collect(&c, collected + k, in, &some, at);
            collected[k].slowly = 1;
        }
        /* the rest of the strip, and what is of another kind */
        if (apart) {
            for (int k = 0; k < REFUSED; k++) {
                FIND_SUBSET(some, many, (kind[i] == k) & ((k != most) | turned[i] | (i >= done)))
                collect(&c, collected + k, in, &some, at);
                collected[k].slowly |= large;
            }
            for (int64_t i = 0; i < many && numbers[REFUSED]; i++)
                for (int r = 0; r < RESULTS && kind[i] == REFUSED; r++) {
                    if (!c.result[r]) continue;
                    if (r == STATUS_AT) status[i] = NOT_FINITE;
                    else out[r][i] = NAN;
                }
        } else if (!mixed) {
            for (int kind_of_mu = 0; kind_of_mu < 2; kind_of_mu++) {
                int k = (most & 2) | kind_of_mu;
                int64_t from = k == most ? done : 0;
                if (!numbers[k] || from == many) continue;
                FIND_SUBSET(some, many, ((in[AT_MU][i] == -10) == kind_of_mu) & (i >= from))
                collect(&c, collected + k, in, &some, at);
                collected[k].slowly |= large;
            }
        }
        for (int k = 0; k < REFUSED; k++)
            if (collected[k].many >= STRIP)
                solve_collected(&c, k, collected + k, STRIP, copies, found);
    }
    for (int k = 0; k < REFUSED; k++)
        if (collected[k].many)
            solve_collected(&c, k, collected + k, collected[k].many, copies, found);
}

/* A call that is made again and again: of some columns and all results wanted only the places are known,
   their rows lie one after another in memory, but STATUS. */
typedef struct {
    impacts rest;
    int64_t columns, results, given[COLUMNS], wanted[RESULTS];
} prepared;

static void find_rows(
    impacts *c, const prepared *its, const double *values, double *results, uint16_t *status,
    int64_t count)
{
    *c = its->rest;
    for (int64_t k = 0; k < its->columns; k++) c->column[its->given[k]] = values + k * count;
    for (int64_t r = 0; r < its->results; r++) c->result[its->wanted[r]] = results + r * count;
    c->result[STATUS_AT] = status;
}

/* All of ``count`` scenes. */
EXPORT void solve_prepared(
    const prepared *its, const double *values, double *results, uint16_t *status, int64_t count)
{
    impacts c;
    find_rows(&c, its, values, results, status, count);
    solve_impacts(&c, 0, count);
}

/* Scenes ``start`` to ``stop`` of them. */
EXPORT void solve_prepared_part(
    const prepared *its, const double *values, double *results, uint16_t *status, int64_t count,
    int64_t start, int64_t stop)
{
    impacts c;
    find_rows(&c, its, values, results, status, count);
    solve_impacts(&c, start, stop);
}

/* The same arrays at each call. */
typedef struct {
    const prepared *call;
    const double *values;
    double *results;
    uint16_t *status;
    int64_t count;
} bound;

EXPORT void solve_bound(const bound *its)
{
    solve_prepared(its->call, its->values, its->results, its->status, its->count);
}
