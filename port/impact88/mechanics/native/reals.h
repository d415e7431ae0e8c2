/* The Apple's 40-bit reals in doubles: the operations of vectorized/reals.py, one number at a time and in
   the same order. What is kept out of these loops is what hardly ever happens: a number beyond 2^100
   or below 2^-100, a division by zero. The scene is marked odd then,
   and left to whoever asked. */

static inline int64_t bits_of(double x) { int64_t b; memcpy(&b, &x, 8); return b; }
static inline double of_bits(int64_t b) { double x; memcpy(&x, &b, 8); return x; }

#define ONES(low, high) ((int64_t)((~(uint64_t)0 >> (63 - (high))) & (~(uint64_t)0 << (low))))
#define EXPONENT_BITS ONES(52, 62)
#define FRACTION_BITS ONES(0, 51)
#define HALF_UNIT ((int64_t)1 << 20)
#define BIAS 894
#define LARGE 0x1p100
#define WHOLE 0x1p31
#define MAGIC 0x1.8p52 /* added to a whole number leaves it in the lowest bits */

static inline double ordinary(double x, int64_t *odd)
{
    double size = fabs(x);
    *odd |= !(size < LARGE) | ((size < 1 / LARGE) & (size != 0.0));
    return x;
}

static inline double real_cut(double x) { return of_bits(bits_of(x) & ONES(21, 63)); }

static inline double real_rounded(double x) { return of_bits((bits_of(x) + HALF_UNIT) & ONES(21, 63)); }

static inline double real_add(double left, double right)
{
    left = real_rounded(left);
    int64_t a = bits_of(left), b = bits_of(right);
    int64_t e = (a & EXPONENT_BITS) > (b & EXPONENT_BITS) ? a & EXPONENT_BITS : b & EXPONENT_BITS;
    /* the larger one's 40 bits as a whole number, and back */
    double to_units = of_bits((int64_t)(((uint64_t)(1023 + 39 + 1023) << 52) - (uint64_t)e));
    double sum = trunc(left * to_units) + trunc(right * to_units);
    /* one unit more where exponents and signs agree */
    int64_t v = bits_of(sum) + ((uint64_t)(a ^ b) >> 52 ? 0 : ONES(0, 12));
    v &= ONES(13, 63);
    v = (v & EXPONENT_BITS) > (((int64_t)(1023 + 8) << 52) - 1) ? v : 0;
    return of_bits(v) * of_bits(e - ((int64_t)39 << 52));
}

static inline double real_multiply(double left, double right)
{
    left = real_rounded(left);
    int64_t signs = bits_of(left) ^ bits_of(right);
    double a = fabs(left), b = fabs(right), product = a * b;
    double upper = of_bits(bits_of(right) & ONES(33, 62)), lower = b - upper;
    double error = a * upper - product;
    error = error + a * lower;
    int64_t v = bits_of(product) - (bits_of(error) < 0);
    int64_t cut = ((uint64_t)(signs ^ v) >> 39 & 0x2000) | 0x1FFF;
    return of_bits((v & ~cut) | (signs & ONES(63, 63)));
}

/* Two zero bytes in a row above one that is not zero: byte 0 is the extension. */
static inline int64_t has_defect(double right)
{
    int64_t b = bits_of(right);
    return (!(b & ONES(29, 44)) & !!(b & ONES(13, 28))) | (!(b & ONES(21, 36)) & !!(b & ONES(13, 20)));
}

/* The product as the ROM builds it, a byte of the right operand at a time. */
static inline double real_multiply_bytes(double left, double right)
{
    int64_t a = bits_of(real_rounded(left)), b = bits_of(right);
    if (left == 0.0 || right == 0.0) return 0.0;
    uint64_t m1 = (uint64_t)((a & FRACTION_BITS) | (int64_t)1 << 52) >> 21;
    uint64_t m2 = (uint64_t)((b & FRACTION_BITS) | (int64_t)1 << 52) >> 13;
    uint64_t built = (m2 & 0xFF) * m1;
    for (int position = 1; position < 5; position++) {
        uint64_t byte = m2 >> 8 * position & 0xFF, before = m2 >> 8 * (position - 1) & 0xFF;
        built = ((byte * m1 << 8) + built) >> 8;
        if (position == 2 || position == 3)
            built = built >> (8 + (!byte && !before)) << 8 | (built & 0xFF);
    }
    return (double)built * 0x1p-38 * (of_bits(a & ~FRACTION_BITS) * of_bits(b & ~FRACTION_BITS));
}

static inline double real_divide(double left, double right)
{
    left = real_rounded(left), right = real_rounded(right);
    int64_t signs = bits_of(left) ^ bits_of(right);
    double a = fabs(left), b = fabs(right), quotient = a / b;
    int64_t v = bits_of(quotient);
    int64_t kept = (((signs ^ v) >> 33) | ONES(20, 63)) & ONES(19, 63);
    v &= kept;
    double upper = of_bits(v & ONES(33, 62)), remainder = a - upper * b;
    remainder = remainder - (of_bits(v) - upper) * b;
    v = (v - ((int64_t)(bits_of(remainder) < 0) << 19)) & kept;
    return of_bits(v | (signs & ONES(63, 63)));
}

static inline double real_int(double x) { return fabs(x) < WHOLE ? floor(x) : x; }

/* Whether the left operand is below the accumulator, which counts as rounded, except that this carries
   nowhere: a last byte of FF with half a unit is 256, equal to 0 and above all else. */
static inline double real_less(double left, double right)
{
    double other = real_rounded(right);
    left = real_rounded(left);
    int64_t a = bits_of(left), b = bits_of(right), full = (b & ONES(20, 28)) == ONES(20, 28);
    int64_t same = full & (((a ^ b) & ONES(29, 63)) == 0), beyond = full & !same & (left == other);
    int64_t less = (left < other) & !(same & !(a & ONES(21, 28)));
    return (beyond ? left < 0 : less) ? 1.0 : 0.0;
}

/* LOG: the mantissa as a number from 1/2 to 1, and the exponent. */
static inline double real_fraction(double x) { return of_bits((bits_of(x) & FRACTION_BITS) | (int64_t)1022 << 52); }

static inline double real_exponent(double x)
{
    int64_t e = bits_of(x) >> 52 & 0x7FF;
    return of_bits(e | (int64_t)0x433 << 52) - (0x1p52 + BIAS + 128);
}

/* EXP: the rounding added to the extension, and a power of two put in. */
static inline double real_halved(double x, double half, int64_t *odd)
{
    *odd |= !(fabs(x) < 99.0);
    return x == 0.0 ? 0.0 : of_bits(bits_of(x) + bits_of(half));
}

static inline double real_scaled(double x, double power) { return of_bits(bits_of(x) + (int64_t)((uint64_t)bits_of(power + MAGIC) << 52)); }
