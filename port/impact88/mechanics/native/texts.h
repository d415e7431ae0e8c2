/* Decimal texts to the Apple's reals and back, as vectorized/textcolumns.py does both: the same steps of
   the same arithmetic. What is no plain number, or out of the ordinary, is marked odd and left. */

#define TEXT_WIDTH 15 /* the longest field: sign, point, nine digits, exponent */
#define EXACT_DIGITS 9
#define MOST_DIGITS 30
#define MOST_STEPS 38
#define SURELY_BELOW 9e7
/* No accumulator that these are compared with is a special case of real_less. */
#define NINE_DIGITS 999999999.25
#define EIGHT_DIGITS 99999999.90625

/* 4x + x, doubled: of 32 bits, so that nothing is cut off. */
static inline double times_ten(double x) { return real_rounded(x) * 10.0; }

static inline double over_ten(double x) { return real_divide(x, 10.0); }

/* One text, ended by a newline: its digits as a number (0 where it is none), and how many times this
   is multiplied by ten (divided if negative). Blanks count for nothing. Returns where the next begins. */
static inline const char *read_number(const char *p, double *value, double *times, int *minus, int *strange)
{
    int digits = 0, decimals = 0, point = 0, negative = 0, started = 0, wrong = 0, sign = 1;
    int e = 0, e_digits = 0, exponent = 0, e_negative = 0;
    int64_t whole = 0;
    double v = 0;
    for (; *p != '\n'; p++) {
        unsigned digit = (unsigned)(unsigned char)*p - '0';
        if (digit < 10) {
            if (e) {
                exponent = e_digits++ < 2 ? exponent * 10 + (int)digit : exponent;
            } else {
                if (digits++ < EXACT_DIGITS) whole = whole * 10 + digit;
                else v = real_add(times_ten(digits == EXACT_DIGITS + 1 ? (double)whole : v), digit);
                decimals += point;
            }
        } else if (*p == '.') {
            wrong |= point | e, point = 1;
        } else if (*p == '-' || *p == '+') {
            wrong |= !sign;
            if (e) e_negative = *p == '-';
            else negative = *p == '-';
        } else if (*p == 'E' || *p == 'e') {
            wrong |= e, e = started = sign = 1;
            continue;
        } else if (*p == ' ') {
            continue;
        } else {
            wrong = 1;
        }
        sign = 0, started = 1;
    }
    int steps = (e_negative ? -exponent : exponent) - decimals;
    *strange = wrong | !started | (digits > MOST_DIGITS) | (e_digits > 2) | (steps > MOST_STEPS) | (steps < -MOST_STEPS);
    *value = *strange ? 0.0 : digits > EXACT_DIGITS ? v : (double)whole;
    *times = *value != 0.0 ? steps : 0;
    *minus = negative;
    return p + 1;
}

EXPORT CLONES void read_numbers(const char *p, int64_t count, double *values, uint8_t *odd)
{
    double v[REPLAYED] = {0}, times[REPLAYED] = {0};
    int minus[REPLAYED], wrong[REPLAYED];
    int64_t strange[REPLAYED];
    const int64_t lanes = REPLAYED;
    for (int64_t start = 0; start < count; start += REPLAYED) {
        int64_t many = count - start < REPLAYED ? count - start : REPLAYED, any;
        for (int64_t i = 0; i < many; i++) p = read_number(p, v + i, times + i, minus + i, wrong + i);
        EACH strange[i] = 0;
        do {
            any = 0;
            EACH {
                double more = times_ten(v[i]), less = over_ten(v[i]), left = times[i];
                v[i] = ordinary(left > 0 ? more : left < 0 ? less : v[i], strange + i);
                times[i] = left - (left > 0 ? 1.0 : left < 0 ? -1.0 : 0.0);
                any |= times[i] != 0;
            }
        } while (any);
        for (int64_t i = 0; i < many; i++) {
            values[start + i] = minus[i] ? -v[i] : v[i];
            odd[start + i] = wrong[i] | (strange[i] != 0);
        }
    }
}

/* The nine digits of n, and how many there are behind the first before zeros alone are left. */
static inline int64_t nine_digits(uint32_t n, char *digits)
{
    uint64_t first = n / 100000000, eight = n % 100000000, tens;
    eight = eight / 10000 | eight % 10000 << 32;
    tens = (eight * 10486 >> 20) & 0x7F0000007F;
    eight = tens | (eight - 100 * tens) << 16;
    tens = (eight * 103 >> 10) & 0x000F000F000F000F;
    eight = tens | (eight - 10 * tens) << 8;
    /* a bit for each byte that is not zero, and for those before it */
    uint64_t kept = (eight + 0x7F7F7F7F7F7F7F7F) & 0x8080808080808080;
    kept |= kept >> 8, kept |= kept >> 16, kept |= kept >> 32;
    eight |= 0x3030303030303030;
    digits[0] = (char)('0' + first);
    memcpy(digits + 1, &eight, 8);
    return (int64_t)((kept >> 7) * 0x0101010101010101 >> 56);
}

/* Nine digits times 10^d as PRINT sets them: see apple/applesoft/decimaltext.py, lay_out. */
static inline void lay_out(const char *digits, int64_t last, int64_t d, int negative, char *text)
{
    int64_t plain = d >= -10 && d <= 0, point = plain ? d + 9 : 1, end;
    char *to = text + negative;
    text[0] = '-';
    if (point < 0) { /* below .1 */
        to[0] = '.', to[1] = '0';
        memcpy(to + 2, digits, 16);
        end = last + 3;
    } else {
        memcpy(to, digits, 16);
        to[point] = '.';
        memcpy(to + point + 1, digits + point, 16);
        end = last < point ? point : last + 2;
    }
    memset(to + end, 0, 16);
    if (!plain) {
        int64_t exponent = d + 8, size = exponent < 0 ? -exponent : exponent;
        to[end] = 'E', to[end + 1] = exponent < 0 ? '-' : '+';
        to[end + 2] = (char)('0' + size / 10), to[end + 3] = (char)('0' + size % 10);
    }
}

/* What PRINT writes of each: TEXT_WIDTH characters of four bytes, as numpy keeps text. */
EXPORT CLONES void write_numbers(const double *x, int64_t count, uint32_t *texts, uint8_t *odd)
{
    double v[REPLAYED], d[REPLAYED], size[REPLAYED];
    int64_t strange[REPLAYED], last[REPLAYED];
    char digits[REPLAYED][32] = {{0}}, text[REPLAYED][48];
    static const char zero[16] = "0";
    const int64_t lanes = REPLAYED;
    for (int64_t start = 0; start < count; start += REPLAYED, x += REPLAYED) {
        int64_t many = count - start < REPLAYED ? count - start : REPLAYED, any = 0;
        LOOP size[i] = i < many ? fabs(x[i]) : 0.0, strange[i] = 0;
        EACH {
            ordinary(size[i], strange + i);
            double kept = strange[i] ? 0.0 : size[i];
            int64_t small = (kept != 0.0) & (kept < 1.0);
            double product = real_multiply(1e9, kept);
            any |= small & has_defect(kept);
            size[i] = kept;
            v[i] = small ? product : kept;
            d[i] = small ? -9.0 : 0.0;
        }
        if (any)
            LOOP if (size[i] != 0.0 && size[i] < 1.0 && has_defect(size[i]))
                v[i] = real_multiply_bytes(1e9, size[i]);
        any = 0;
        EACH any |= v[i] > SURELY_BELOW;
        while (any) {
            any = 0;
            EACH {
                int64_t above = real_rounded(v[i]) > NINE_DIGITS;
                double less = over_ten(v[i]);
                any |= above;
                v[i] = above ? less : v[i];
                d[i] += above ? 1.0 : 0.0;
            }
        }
        EACH size[i] = (v[i] != 0.0) & (real_rounded(v[i]) != NINE_DIGITS) ? 1.0 : 0.0;
        do {
            any = 0;
            EACH {
                double more = times_ten(v[i]);
                int64_t above = (v[i] > SURELY_BELOW) & (real_rounded(v[i]) > EIGHT_DIGITS);
                int64_t below = (size[i] != 0.0) & !above;
                any |= below;
                v[i] = below ? more : v[i];
                d[i] -= below ? 1.0 : 0.0;
            }
        } while (any);
        EACH {
            double sum = real_add(0.5, v[i]);
            v[i] = size[i] != 0.0 ? sum : v[i];
            strange[i] |= !(v[i] < 1e9);
        }
        /* three passes: what has just been written by the byte is slow to read again */
        for (int64_t i = 0; i < many; i++) last[i] = nine_digits(strange[i] ? 0 : (uint32_t)v[i], digits[i]);
        for (int64_t i = 0; i < many; i++) {
            odd[start + i] = strange[i] != 0;
            if (strange[i] || v[i] < 1.0) memcpy(text[i], zero, 16);
            else lay_out(digits[i], last[i], (int64_t)d[i], x[i] < 0, text[i]);
        }
        for (int64_t i = 0; i < many; i++, texts += TEXT_WIDTH)
            for (int k = 0; k < TEXT_WIDTH; k++) texts[k] = (unsigned char)text[i][k];
    }
}
