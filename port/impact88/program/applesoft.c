/* Applesoft II's 40-bit reals, its decimal text, and the steps of compiled BASIC programs.

   The arithmetic is that of the ROM, rule by rule, in whole numbers, in the order of
   apple/applesoft/{real,functions,decimaltext}.py, where each rule is explained. compiler.py turns a
   program into steps of a stack machine. What a step does is said once, by a macro DO_...; two
   functions use them: `walk` runs the steps of any program, and `listing`, which generate.py prints
   into listing.h when the package is built, runs those of the 1988 listing one after another. A run
   is one program on the texts of one scene; runs share nothing, so that they may have a thread each. */

#include <setjmp.h>
#include <stdint.h>
#include <string.h>

#ifdef _MSC_VER
#include <intrin.h>
#define EXPORT __declspec(dllexport)
#define INLINE static __forceinline
#define CALLED static __declspec(noinline)
#define NO_RETURN __declspec(noreturn)
#define UNLIKELY(x) (x)
static __forceinline int leading_zeros(uint64_t x)
{
    unsigned long top;
    _BitScanReverse64(&top, x);
    return 63 - (int)top;
}
#else
#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif
#define INLINE static inline __attribute__((always_inline))
#define CALLED static __attribute__((noinline))
#define NO_RETURN __attribute__((noreturn))
#define UNLIKELY(x) __builtin_expect(!!(x), 0)
#define leading_zeros(x) __builtin_clzll(x)
#endif

/* Codes of errors, as ONERR stores them; NEXT WITHOUT FOR has 0 there. OUTSIDE: the run needs
   something that is not here, a text is no number, or there is no end within BUDGET. */
enum {
    NEXT_WITHOUT_FOR = 0x100,
    RETURN_WITHOUT_GOSUB = 22,
    ILLEGAL_QUANTITY = 53,
    OVERFLOW = 69,
    BAD_SUBSCRIPT = 107,
    DIVISION_BY_ZERO = 133,
    OUTSIDE = 0x200
};

/* (-1)^s m 2^(e - 168), m with 32 bits and the extension's 8; zero is {0, 0, 0}. */
typedef struct {
    uint64_t m;
    int32_t e, s;
} real;

#define TOP ((uint64_t)1 << 39)
#define LIMIT ((uint64_t)1 << 40)
#define ZERO ((real){0, 0, 0})

enum {
    VARIABLES = 64, /* as many as bits tell which are assigned */
    STRINGS = 8,
    INPUTS = 32,
    ELEMENTS = 256, /* of the array; the listing has 56 */
    STACK = 16,     /* of a formula; the listing needs 7 */
    DEPTH = 6,      /* of loops, and of subroutines: both fit the 6502's stack */
    ANGLES = 8,     /* sines that are kept: a program takes those of few angles, many times */
    PAGE = 2048,    /* characters; a page of the listing has 800 */
    FIELD = 16,     /* bytes of a printed number and its zero; the longest has 15 characters */
    MAX_TYPED = 200, /* characters typed into a line; the Apple takes 239 with names and signs */
    BUDGET = 1000000 /* steps; the listing takes 9,000 */
};

typedef struct {
    jmp_buf stop;
    real variable[VARIABLES], array[ELEMENTS], stack[STACK], angle[ANGLES], sine[ANGLES];
    uint64_t assigned;
    int32_t string[STRINGS];
    struct { real limit; int variable, from, line; } loop[DEPTH];
    struct { int from, line, loops; } call[DEPTH];
    int line, loops, calls, rows, columns, angles;
    int typed_line, typed, page_size, fields, most;
    char *page, (*field)[FIELD];
} run;

CALLED NO_RETURN void fail(run *its, int code) { longjmp(its->stop, code); }

/* --- numbers --------------------------------------------------------------------------------- */

INLINE real rounded(run *its, real x)
{
    x.m = (x.m + 0x80) & ~(uint64_t)0xFF;
    if (UNLIKELY(x.m == LIMIT)) {
        if (x.e == 255) fail(its, OVERFLOW);
        x.e++, x.m = TOP;
    }
    return x;
}

INLINE real normalise(int e, uint64_t m, int s)
{
    int k = m < 0x100 ? 256 : leading_zeros(m) - 24;
    return k < e ? (real){m << k, e - k, s} : ZERO;
}

INLINE real negate(real x) { return x.s ^= x.e != 0, x; }

INLINE real absolute(real x) { return x.s = 0, x; }

INLINE real integer(int64_t n)
{
    uint64_t m = (uint64_t)(n < 0 ? -n : n);
    return m < 256 ? normalise(136, m << 32, n < 0) : normalise(160, m << 8, n < 0);
}

INLINE real add(run *its, real left, real right)
{
    if (!right.e) return left;
    if (!left.e) return right;
    int shift = left.e - right.e;
    if (shift > 0) right.m = shift < 64 ? right.m >> shift : 0, right.e = left.e;
    if (shift < 0) left.m = shift > -64 ? left.m >> -shift : 0;
    if (left.s == right.s) {
        right.m += left.m + (shift == 0); /* the ROM's carry */
        if (right.m < LIMIT) return right;
        if (right.e == 255) fail(its, OVERFLOW);
        return (real){right.m >> 1, right.e + 1, right.s};
    }
    int64_t m = (int64_t)right.m - (int64_t)left.m;
    if (shift > 0) m = -m, right.s = left.s;
    return m < 0 ? normalise(right.e, (uint64_t)-m, !right.s) : normalise(right.e, (uint64_t)m, right.s);
}

INLINE real subtract(run *its, real left, real right) { return add(its, left, negate(right)); }

INLINE int product_exponent(run *its, int e1, int e2)
{
    if (e1 + e2 >= 384) fail(its, OVERFLOW);
    return e1 + e2 < 128 ? 0 : e1 + e2 - 128;
}

INLINE real multiply(run *its, real left, real right)
{
    if (!left.e || !right.e) return ZERO;
    int e = product_exponent(its, left.e, right.e);
    uint64_t a = left.m >> 8, m = 0;
    if (!e) return ZERO;
    if (right.m & 0xFF0000 || !(right.m & 0xFFFF)) {
        m = (a * (right.m >> 8) + (a * (right.m & 0xFF) >> 8)) >> 24;
    } else {
        for (int previous = 1, byte, k = 0; k < 5; k++, previous = byte) {
            byte = (int)(right.m >> 8 * k & 0xFF);
            m = (m + ((uint64_t)byte * a << 8)) >> 8;
            if (!byte && !previous) m = m >> 9 << 8 | (m & 0xFF); /* the ROM's defect */
        }
    }
    return normalise(e, m, left.s ^ right.s);
}

INLINE real divide(run *its, real left, real right)
{
    right = rounded(its, right);
    if (!right.e) fail(its, DIVISION_BY_ZERO);
    if (!left.e) return ZERO;
    int e = left.e + (-right.e & 0xFF) - 127;
    if (e < 1) return ZERO;
    if (e > 255) fail(its, OVERFLOW);
    uint64_t a = left.m >> 8, b = right.m >> 8, q = (a << 32) / b, r = (a << 32) % b;
    return normalise(e, (q << 1 | (r << 1 >= b)) << 6, e > 1 ? left.s ^ right.s : 0);
}

/* 1: the right is larger, 0: equal, -1: smaller. */
INLINE int compare(real stored, real right)
{
    int larger;
    if (!stored.e) return right.e ? (right.s ? -1 : 1) : 0;
    if (stored.s != right.s || !right.e) return stored.s ? 1 : -1;
    if (stored.e != right.e) {
        larger = right.e > stored.e;
    } else if (stored.m >> 16 != right.m >> 16) {
        larger = right.m > stored.m;
    } else {
        int last1 = stored.m >> 8 & 0xFF, last2 = (int)(right.m >> 8 & 0xFF) + (int)(right.m >> 7 & 1);
        if (last1 == (last2 & 0xFF)) return 0;
        larger = last2 > last1;
    }
    return larger != right.s ? 1 : -1;
}

INLINE int64_t to_integer(real x) /* of less than 2^32 */
{
    int64_t m = x.s ? -(int64_t)x.m : (int64_t)x.m, shift = 168 - x.e;
    return shift < 63 ? m >> shift : -(x.s != 0);
}

INLINE real sign(real x) { return integer(x.e ? x.s ? -1 : 1 : 0); }

INLINE real floored(real x) { return x.e >= 160 ? x : integer(to_integer(x)); }

/* --- functions ------------------------------------------------------------------------------- */

INLINE real stored(uint64_t bytes)
{
    return (real){(bytes & 0xFFFFFFFF) << 8 | TOP, (int)(bytes >> 32), (int)(bytes >> 31 & 1)};
}

static const uint64_t LOG_[] = {0x7F5E56CB79, 0x80139B0B64, 0x8076389316, 0x8238AA3B20};
static const uint64_t EXP_[] = {0x7134583E56, 0x74167EB31B, 0x772FEEE385, 0x7A1D841C2A,
                               0x7C6359580A, 0x7E75FDE7C6, 0x8031721810, 0x8100000000};
static const uint64_t ATN_[] = {0x76B383BDD3, 0x791EF4A6F5, 0x7B83FCB010, 0x7C0C1F67CA, 0x7CDE53CBC1, 0x7D1464704C,
                               0x7DB7EA517A, 0x7D6330887E, 0x7E9244993A, 0x7E4CCC91C7, 0x7FAAAAAA13, 0x8100000000};
static const uint64_t SIN_[] = {0x84E61A2D1B, 0x862807FBF8, 0x8799688901, 0x872335DFE1, 0x86A55DE728, 0x83490FDAA2};
#define COUNT(x) (int)(sizeof(x) / sizeof(x)[0])
#define C(bytes) stored(0x##bytes)

static real polynomial(run *its, const uint64_t *c, int count, real x)
{
    x = rounded(its, x);
    real r = multiply(its, stored(c[0]), x);
    for (int k = 1; k < count - 1; k++) r = multiply(its, x, add(its, stored(c[k]), r));
    return add(its, stored(c[count - 1]), r);
}

static real odd_polynomial(run *its, const uint64_t *c, int count, real x)
{
    x = rounded(its, x);
    return multiply(its, x, polynomial(its, c, count, multiply(its, x, x)));
}

static real logarithm(run *its, real x)
{
    if (x.s || !x.e) fail(its, ILLEGAL_QUANTITY);
    real f = add(its, C(803504F334), (real){x.m, 128, 0});
    f = subtract(its, C(8100000000), divide(its, C(813504F334), f));
    f = add(its, C(8080000000), odd_polynomial(its, LOG_, COUNT(LOG_), f));
    return multiply(its, C(80317217F8), add(its, rounded(its, f), integer(x.e - 128)));
}

static real exponential(run *its, real x)
{
    real turns = multiply(its, C(8138AA3B29), x);
    if (turns.e && (turns.m += 0x50) >= LIMIT) turns.m = TOP | (turns.m & 0xFF), turns.e++;
    int64_t doublings = turns.e < 136 ? to_integer((real){turns.m & ~(uint64_t)0xFF, turns.e, turns.s}) : 0;
    int exponent = turns.e < 136 ? (int)(doublings + 129) & 0xFF : 0;
    if (!exponent && !x.s) fail(its, OVERFLOW);
    if (exponent <= 1) return ZERO;
    real r = polynomial(its, EXP_, COUNT(EXP_), negate(subtract(its, integer(doublings), turns)));
    r.e = product_exponent(its, exponent - 1, r.e);
    return r.e ? absolute(r) : ZERO;
}

static real power(run *its, real left, real right)
{
    if (!right.e) return exponential(its, ZERO);
    if (!left.e) return ZERO;
    real exponent = rounded(its, right);
    int odd = 0;
    if (left.s) {
        real whole = floored(exponent);
        if (compare(exponent, whole)) fail(its, ILLEGAL_QUANTITY);
        odd = whole.e < 160 && (to_integer(whole) & 1), left.s = 0;
    }
    real result = exponential(its, multiply(its, exponent, logarithm(its, left)));
    return odd ? negate(result) : result;
}

static real reduced(run *its, real x, int *flag) /* to turns of -1/4 to 1/4 */
{
    real f = rounded(its, divide(its, rounded(its, x), C(83490FDAA2)));
    f = subtract(its, C(7F00000000), subtract(its, f, floored(f)));
    int beyond = f.s;
    if (beyond) f = add(its, C(8000000000), f);
    *flag = beyond && !f.s;
    if (!beyond || *flag) f = negate(f);
    f = add(its, C(7F00000000), f);
    return rounded(its, beyond ? negate(f) : f);
}

static real sine(run *its, real x)
{
    int flag;
    for (int k = 0; k < ANGLES; k++)
        if (its->angle[k].m == x.m && its->angle[k].e == x.e && its->angle[k].s == x.s && x.e) return its->sine[k];
    int kept = its->angles++ % ANGLES;
    its->angle[kept] = ZERO;
    its->sine[kept] = odd_polynomial(its, SIN_, COUNT(SIN_), reduced(its, x, &flag)), its->angle[kept] = x;
    return its->sine[kept];
}

static real cosine(run *its, real x) { return sine(its, add(its, C(81490FDAA2), x)); }

static real tangent(run *its, real x)
{
    int flag;
    real f = reduced(its, x, &flag), of_sine = rounded(its, odd_polynomial(its, SIN_, COUNT(SIN_), f));
    f = add(its, C(7F00000000), negate(absolute(f)));
    return divide(its, of_sine, odd_polynomial(its, SIN_, COUNT(SIN_), flag ? negate(f) : f));
}

static real arc_tangent(run *its, real x)
{
    real f = absolute(x);
    int inverted = f.e > 128;
    f = odd_polynomial(its, ATN_, COUNT(ATN_), inverted ? divide(its, C(8100000000), f) : f);
    if (inverted) f = subtract(its, C(81490FDAA2), f);
    return x.s ? negate(f) : f;
}

/* --- decimal text ---------------------------------------------------------------------------- */

static real times_ten(run *its, real x)
{
    x = rounded(its, x);
    if (!x.e) return x;
    if (x.e > 253) fail(its, OVERFLOW);
    real r = add(its, (real){x.m, x.e + 2, x.s}, x);
    if (r.e++ == 255) fail(its, OVERFLOW);
    return r;
}

static real over_ten(run *its, real x) { return divide(its, rounded(its, absolute(x)), C(8420000000)); }

/* FIN. *p is left at what is no part of the number. */
static real read_number(run *its, const char **p)
{
    const char *c = *p;
    real x = ZERO;
    int decimals = 0, point = 0, power = 0, minus = 0, down = 0, exact = 1, n;
    uint64_t whole = 0; /* up to 32 bits nothing is rounded */
    while (*c == ' ') c++;
    if (*c == '+' || *c == '-') minus = *c++ == '-';
    for (; (*c >= '0' && *c <= '9') || *c == ' ' || (*c == '.' && !point); c++) {
        if (*c == '.') point = 1;
        if (*c == '.' || *c == ' ') continue;
        decimals += point;
        if (exact && whole * 10 + 9 <= UINT32_MAX) { whole = whole * 10 + (uint64_t)(*c - '0'); continue; }
        if (exact) exact = 0, x = integer((int64_t)whole);
        x = add(its, rounded(its, times_ten(its, x)), integer(*c - '0'));
    }
    if (exact) x = integer((int64_t)whole);
    if (*c == 'E' || *c == 'e') {
        for (c++; *c == ' '; c++) continue;
        if (*c == '+' || *c == '-') down = *c++ == '-';
        for (; (*c >= '0' && *c <= '9') || *c == ' '; c++)
            if (*c != ' ' && power < 100) power = power * 10 + *c - '0';
        if (power >= 100 && !down) fail(its, OVERFLOW);
        if (power >= 100) power = 100;
    }
    n = (int8_t)((down ? -power : power) - decimals);
    for (; n > 0; n--) x = times_ten(its, x);
    for (; n < 0; n++) x = over_ten(its, x);
    *p = c;
    return minus ? negate(x) : x;
}

/* FOUT. Returns the length of the text. */
static int write_number(run *its, real x, char *text)
{
    char digits[16], *to = text;
    int d = 0, last = 8, order;
    if (!x.e) return *text = '0', 1;
    if (x.s) *to++ = '-', x.s = 0;
    if (x.e <= 128) x = multiply(its, C(9E6E6B2800), x), d = -9;
    for (; (order = compare(C(9E6E6B27FD), x)) > 0; d++) x = over_ten(its, x);
    if (order) {
        for (; compare(C(9B3EBC1FFD), x) <= 0; d--) x = times_ten(its, x);
        x = add(its, C(8000000000), x);
    }
    uint64_t n = (uint64_t)to_integer(x);
    for (int k = 8; k >= 0; k--, n /= 10) digits[k] = (char)('0' + n % 10);
    while (last > 0 && digits[last] == '0') last--;
    int plain = d >= -10 && d <= 0, point = plain ? d + 9 : 1;
    if (point < 0) *to++ = '.', *to++ = '0';
    for (int k = 0; k <= last || k < point; k++) {
        if (k == point) *to++ = '.';
        *to++ = digits[k];
    }
    if (!plain) {
        int size = d + 8 < 0 ? -d - 8 : d + 8;
        *to++ = 'E', *to++ = d + 8 < 0 ? '-' : '+', *to++ = (char)('0' + size / 10), *to++ = (char)('0' + size % 10);
    }
    return (int)(to - text);
}

/* --- steps ----------------------------------------------------------------------------------- */

typedef struct {
    int32_t operation, a;
} step;

typedef struct {
    const step *steps; /* null for the listing */
    const real *constants;
    const char *texts;     /* what PRINT shows, one after another */
    const int32_t *starts; /* of each text, and the end of the last */
} program;

INLINE int subscript(run *its, real x)
{
    x = rounded(its, x);
    if (x.s || x.e > 143) fail(its, ILLEGAL_QUANTITY);
    return (int)(x.e ? x.m >> (168 - x.e) : 0);
}

INLINE int place(run *its, real x, real y)
{
    int row = subscript(its, x), column = subscript(its, y);
    if (UNLIKELY(!its->rows)) fail(its, OUTSIDE); /* Applesoft would make an array of 11 by 11 */
    if (UNLIKELY(row >= its->rows || column >= its->columns)) fail(its, BAD_SUBSCRIPT);
    return row + its->rows * column;
}

static void dim(run *its, real x, real y)
{
    int rows = subscript(its, x) + 1, columns = subscript(its, y) + 1;
    if (its->rows || (int64_t)rows * columns > ELEMENTS) fail(its, OUTSIDE);
    its->rows = rows;
    its->columns = columns;
}

/* bits: 1 for >, 2 for =, 4 for < */
INLINE real comparison(real x, real y, int bits)
{
    int order = compare(x, y);
    return integer((bits & (order < 0 ? 1 : 2 << order)) != 0);
}

static void put(run *its, const char *text, int size)
{
    if (!its->page) return;
    if (its->page_size + size > PAGE) fail(its, OUTSIDE);
    memcpy(its->page + its->page_size, text, (size_t)size);
    its->page_size += size;
}

static void print(run *its, real x)
{
    char text[32] = "";
    if (!its->page && its->fields >= its->most) return; /* writing has no errors */
    int size = write_number(its, x, text);
    if (its->fields < its->most) memcpy(its->field[its->fields++], text, FIELD);
    put(its, text, size);
}

static void show(run *its, const program *p, int text)
{
    put(its, p->texts + p->starts[text], p->starts[text + 1] - p->starts[text]);
}

static void echo(run *its, const char *text) { put(its, text, (int)(strchr(text, '\n') - text)); }

/* Read a text that was typed at a prompt, or into a program line, where it must begin like a number
   (E is a variable there). */
static real read_typed(run *its, const char *text, int in_line)
{
    const char *c = text;
    while (*c == ' ' || (in_line && (*c == '+' || *c == '-'))) c++;
    if (*c == '\n' || (in_line && *c != '.' && (*c < '0' || *c > '9'))) fail(its, OUTSIDE);
    real x = read_number(its, &text);
    if (*text != '\n') fail(its, OUTSIDE);
    if (its->typed_line != its->line) {
        its->typed_line = its->line;
        its->typed = 0;
    }
    its->typed += (int)(text - c);
    if (its->typed > MAX_TYPED) fail(its, OUTSIDE);
    return x;
}

static void call(run *its, int from)
{
    if (its->calls == DEPTH) fail(its, OUTSIDE);
    its->call[its->calls].line = its->line;
    its->call[its->calls].loops = its->loops;
    its->call[its->calls++].from = from;
}

static int returned(run *its)
{
    if (!its->calls) fail(its, RETURN_WITHOUT_GOSUB);
    its->calls--;
    if (its->loops > its->call[its->calls].loops) fail(its, OUTSIDE); /* depends on addresses */
    its->line = its->call[its->calls].line;
    return its->call[its->calls].from;
}

/* A subroutine does not see the loops outside it. */
INLINE int first_loop(run *its) { return its->calls ? its->call[its->calls - 1].loops : 0; }

/* A FOR of a variable whose loop is open closes that loop and those inside it. */
static void loop(run *its, int variable, int from, real limit)
{
    for (int k = first_loop(its); k < its->loops; k++)
        if (its->loop[k].variable == variable) its->loops = k;
    if (its->loops == DEPTH) fail(its, OUTSIDE);
    its->loop[its->loops].limit = rounded(its, limit);
    its->loop[its->loops].variable = variable;
    its->loop[its->loops].from = from;
    its->loop[its->loops++].line = its->line;
}

/* Return the step at which the loop began, or -1 at its end. The current line becomes that of FOR. */
INLINE int next(run *its, int variable)
{
    int first = first_loop(its), k = its->loops - 1;
    while (k >= first && its->loop[k].variable != variable) k--;
    if (k < first) fail(its, NEXT_WITHOUT_FOR);
    its->loops = k + 1;
    real x = rounded(its, add(its, its->variable[variable], integer(1)));
    its->variable[variable] = x;
    if (compare(its->loop[k].limit, x) > 0) return its->loops = k, -1;
    its->line = its->loop[k].line;
    return its->loop[k].from;
}

/* Called forms, for statements that run once; OP(add) is one of both. */
#define CALLED_FORM(f) CALLED real called_##f(run *its, real x, real y) { return f(its, x, y); }
CALLED_FORM(add)
CALLED_FORM(subtract)
CALLED_FORM(multiply)
CALLED_FORM(divide)
#define OP(f) f

/* What a step does with its number a, and with the stack from t[0], the first number that it takes
   or leaves. How many it takes and leaves: OPERATIONS in compiler.py. */
#define DO_LINE its->line = a
#define DO_CONSTANT t[0] = constants[a]
#define DO_VARIABLE t[0] = its->variable[a]
#define DO_ELEMENT t[0] = its->array[place(its, t[0], t[1])]
#define DO_PLACE t[0].e = place(its, t[0], t[1])
#define DO_ADD t[0] = OP(add)(its, t[0], t[1])
#define DO_SUBTRACT t[0] = OP(subtract)(its, t[0], t[1])
#define DO_MULTIPLY t[0] = OP(multiply)(its, t[0], t[1])
#define DO_DIVIDE t[0] = OP(divide)(its, t[0], t[1])
#define DO_POWER t[0] = power(its, t[0], t[1])
#define DO_COMPARE t[0] = comparison(t[0], t[1], a)
#define DO_AND t[0] = integer(t[0].e && t[1].e)
#define DO_OR t[0] = integer(t[0].e || t[1].e)
#define DO_NEGATE t[0] = negate(t[0])
#define DO_INT t[0] = floored(t[0])
#define DO_ABS t[0] = absolute(t[0])
#define DO_SGN t[0] = sign(t[0])
#define DO_SQR t[0] = power(its, rounded(its, t[0]), C(8000000000))
#define DO_EXP t[0] = exponential(its, t[0])
#define DO_LOG t[0] = logarithm(its, t[0])
#define DO_SIN t[0] = sine(its, t[0])
#define DO_COS t[0] = cosine(its, t[0])
#define DO_TAN t[0] = tangent(its, t[0])
#define DO_ATN t[0] = arc_tangent(its, t[0])
#define DO_ROUND t[0] = rounded(its, t[0])
#define DO_TOUCH its->assigned |= (uint64_t)1 << a
#define DO_STORE its->variable[a] = rounded(its, t[0])
#define DO_STORE_ELEMENT its->array[t[0].e] = rounded(its, t[1])
#define DO_DIM dim(its, t[0], t[1])
#define DO_PRINT print(its, t[0])
#define DO_TEXT show(its, p, a)
#define DO_STRING its->string[a / 256] = a % 256
#define DO_SHOW show(its, p, its->string[a])
#define DO_ECHO echo(its, input[a])
#define DO_READ t[0] = read_typed(its, input[a], 0)
#define DO_TYPED t[0] = read_typed(its, input[a], 1)

#include "listing.h"

CALLED void walk(run *its, const program *p, const char *const *input)
{
    const real *constants = p->constants;
    real *t = its->stack;
    int budget = BUDGET, to;
    for (const step *s = p->steps; budget--; s++) {
        int a = s->a;
        switch (s->operation) {
#define CASE(name, taken, left) case name: t -= taken; DO_##name; t += left; break;
        EACH_PLAIN_STEP(CASE)
        case UNLESS: t--; if (!t[0].e) s = p->steps + a - 1; break;
        case GOTO: s = p->steps + a - 1; break;
        case GOSUB: call(its, (int)(s - p->steps)), s = p->steps + a - 1; break;
        case RETURN: s = p->steps + returned(its); break;
        case FOR: t--, loop(its, a, (int)(s - p->steps), t[0]); break;
        case NEXT: if ((to = next(its, a)) >= 0) s = p->steps + to; break;
        case END: return;
        }
    }
    fail(its, OUTSIDE);
}

/* A function of its own: a jump to setjmp loses what is local to its caller. */
static int run_once(run *its, const program *p, const char *const *input)
{
    int code = setjmp(its->stop);
    if (!code && p->steps) walk(its, p, input);
    else if (!code) listing(its, p, input);
    return code;
}

static uint64_t packed(real x)
{
    return x.e ? (uint64_t)x.e << 32 | (x.m >> 8 & 0x7FFFFFFF) | (uint64_t)x.s << 31 : 0;
}

/* Return the digest of the listing's steps for which this file was compiled. */
EXPORT const char *applesoft_source(void) { return LISTING; }

/* Run a program on `count` scenes. text: for each input the texts of all scenes, each ended by a
   newline, or one text for all where `single`. row: the results of each scene, as `row_type` in
   kernel.py has them. pages: PAGE characters for each scene, or null. */
EXPORT void applesoft_run(const program *p, const char *const *text, const uint8_t *single, int64_t count, int inputs,
                          int variables, int elements, int fields, char *row, char *pages)
{
    const char *input[INPUTS];
    run its;
    memcpy(input, text, (size_t)inputs * sizeof *text);
    for (int64_t n = 0; n < count; n++) {
        int32_t *ending = (int32_t *)row;
        uint64_t *words = (uint64_t *)row + 2;
        memset(&its, 0, sizeof its);
        its.field = (char(*)[FIELD])(words + 1 + variables + elements);
        its.most = fields;
        its.page = pages ? pages + n * PAGE : 0;
        ending[0] = run_once(&its, p, input);
        ending[1] = its.line;
        ending[2] = its.page_size;
        ending[3] = its.rows;
        words[0] = its.assigned;
        for (int k = 0; k < variables; k++) words[1 + k] = packed(its.variable[k]);
        for (int k = 0; k < elements; k++) words[1 + variables + k] = packed(its.array[k]);
        for (int k = 0; k < inputs; k++)
            if (!single[k]) input[k] = strchr(input[k], '\n') + 1;
        row = (char *)(its.field + fields);
    }
}

/* Run one program for tests: of its numbers it leaves the stack and the first one printed. */
EXPORT int applesoft_steps(const program *p, const char *const *input, real *stack, char (*field)[FIELD])
{
    run its;
    memset(&its, 0, sizeof its);
    its.field = field;
    its.most = 1;
    int code = run_once(&its, p, input);
    memcpy(stack, its.stack, sizeof its.stack);
    return code;
}
