"""Applesoft's functions, each by the ROM's own reduction and polynomial, on plain triples (`real`).

Arguments may carry an extension (it is not rounded away, except where the rule says so); so do
results. Coefficients are stored reals in hexadecimal."""

from collections.abc import Sequence
from functools import lru_cache

from . import real
from .errorcodes import illegal_quantity, overflow
from .real import BIAS, ZERO, Number

IntAndByte = tuple[Number, int]
"""A result, and the low byte of what INT, which was taken on the way, found last."""


def stored_reals(text: str) -> tuple[Number, ...]:
    """Constants from their hexadecimal bytes, separated by blanks."""
    return tuple(real.from_stored(word) for word in text.split())


LOG_COEFFICIENTS = stored_reals("7F5E56CB79 80139B0B64 8076389316 8238AA3B20")
EXP_COEFFICIENTS = stored_reals(
    "7134583E56 74167EB31B 772FEEE385 7A1D841C2A 7C6359580A 7E75FDE7C6 8031721810 8100000000"
)
SIN_COEFFICIENTS = stored_reals("84E61A2D1B 862807FBF8 8799688901 872335DFE1 86A55DE728 83490FDAA2")
ATN_COEFFICIENTS = stored_reals(
    "76B383BDD3 791EF4A6F5 7B83FCB010 7C0C1F67CA 7CDE53CBC1 7D1464704C"
    " 7DB7EA517A 7D6330887E 7E9244993A 7E4CCC91C7 7FAAAAAA13 8100000000"
)
SQRT_HALF, SQRT_TWO, MINUS_HALF, LN_TWO, LOG2_E = stored_reals(
    "803504F334 813504F334 8080000000 80317217F8 8138AA3B29"
)
TWO_PI, HALF_PI, QUARTER, HALF = stored_reals("83490FDAA2 81490FDAA2 7F00000000 8000000000")
RND_FACTOR, RND_ADDEND = stored_reals("9835447A68 6828B14620")
FIRST_SEED = real.from_stored("804FC75258")
"""RND's seed after the machine is switched on."""
ONE = real.integer(1)
EXP_ROUNDING = 0x50
"""What EXP adds to the extension of x / ln 2 before it takes that apart."""


def polynomial(coefficients: Sequence[Number], x: Number) -> Number:
    """c0 x^n + ... + cn by Horner's rule; x is rounded, the running value keeps its extension."""
    x = real.rounded(x)
    r = real.multiply(coefficients[0], x)
    for c in coefficients[1:-1]:
        r = real.multiply(x, real.add(c, r))
    return real.add(coefficients[-1], r)


def odd_polynomial(coefficients: Sequence[Number], x: Number) -> Number:
    """x times the polynomial in x squared."""
    x = real.rounded(x)
    return real.multiply(x, polynomial(coefficients, real.multiply(x, x)))


def sign(x: Number) -> Number:
    """SGN: -1, 0 or 1."""
    e, _, s = x
    return real.integer(-1 if s else 1) if e else ZERO


def logarithm(x: Number) -> Number:
    """LOG, the natural logarithm. Raises ILLEGAL QUANTITY for x <= 0."""
    e, m, s = x
    if s or not e:
        raise illegal_quantity()
    f = (BIAS, m, 0)
    f = real.subtract(ONE, real.divide(SQRT_TWO, real.add(SQRT_HALF, f)))
    f = real.add(MINUS_HALF, odd_polynomial(LOG_COEFFICIENTS, f))
    return real.multiply(LN_TWO, real.add(f, real.integer(e - BIAS)))


def integer_part(x: Number, left: int = 0) -> IntAndByte:
    """INT, and the low byte of the result, which the ROM leaves in memory. It does not look for the
    byte of a number of 32 bits or more before the point, and what was ``left`` before stays."""
    integral = real.floor(x)
    return integral, (real.to_integer(integral) & 0xFF if x[0] < real.INTEGER_EXPONENT else left)


def exponential(x: Number) -> Number:
    """EXP: e to the x. Raises OVERFLOW; underflows to zero."""
    return exponential_and_byte(x)[0]


def exponential_and_byte(x: Number, left: int = 0) -> IntAndByte:
    """EXP, and the byte of INT. It takes x apart with INT, unless that is out of range at first
    sight."""
    e, m, s = turns = _over_ln_two(x)
    if e < BIAS + 8:
        doublings = real.to_integer((e, m & ~0xFF, s))
        exponent, left = doublings + 129 & 0xFF, doublings & 0xFF
    else:
        doublings = exponent = 0
    if not exponent and not x[2]:
        raise overflow()
    if exponent <= 1:
        return ZERO, left
    fraction = real.negate(real.subtract(real.integer(doublings), turns))
    e, m, _ = polynomial(EXP_COEFFICIENTS, fraction)
    e = real.product_exponent(exponent - 1, e)
    return ((e, m, 0) if e else ZERO), left


def _over_ln_two(x: Number) -> Number:
    """x / ln 2 as EXP takes it apart, its extension raised."""
    e, m, s = real.multiply(LOG2_E, x)
    if e:
        m += EXP_ROUNDING
        if m >= real.LIMIT:
            # the 32-bit mantissa overflows to 80000000; the extension's sum is kept as it is
            m = real.TOP | m & 0xFF
            e += 1
    return e, m, s


def power(left: Number, right: Number) -> Number:
    """left ^ right = EXP (right * LOG (left)), so X ^ 2 is not X * X. Raises ILLEGAL QUANTITY for a
    negative left with a right that is not whole, OVERFLOW. A negative left to a power of 2^31 or
    more is positive, as where nothing has taken INT before."""
    return power_and_byte(left, right)[0]


def power_and_byte(left: Number, right: Number, byte: int = 0) -> IntAndByte:
    """left ^ right, and the byte of INT. Of a negative left the byte that INT of right leaves tells
    whether that is odd: from 2^31 on an older number's."""
    if not right[0]:
        return exponential_and_byte(ZERO)
    left = real.rounded(left)
    if not left[0]:
        return ZERO, byte
    exponent = real.rounded(right)
    odd = False
    if left[2]:
        integral, byte = integer_part(exponent, byte)
        if real.compare(exponent, integral):
            raise illegal_quantity()
        odd = bool(byte & 1)
        left = real.negate(left)
    result, byte = exponential_and_byte(real.multiply(exponent, logarithm(left)), byte)
    return (real.negate(result) if odd else result), byte


def square_root(x: Number) -> Number:
    """SQR, as (x rounded) ^ 0.5. Raises ILLEGAL QUANTITY for a negative x."""
    return power(x, HALF)


def square_root_and_byte(x: Number, left: int = 0) -> IntAndByte:
    """SQR, and the byte of INT."""
    return power_and_byte(x, HALF, left)


@lru_cache(maxsize=64)  # a program asks for the sine of the same few angles over and over
def _sine(x: Number) -> tuple[Number, bool, Number, Number]:
    """The sine, and what TAN needs: the quadrant flag, and the reduced argument, a fraction of a
    turn in -1/4 ... 1/4, rounded; then what INT is taken of, the argument in turns."""
    turns = f = real.rounded(real.divide(x, TWO_PI))
    f = real.subtract(QUARTER, real.subtract(f, real.floor(f)))
    beyond_first_quarter = f[2]
    flag = False
    if beyond_first_quarter:
        f = real.add(HALF, f)
        if not f[2]:
            f = real.negate(f)
            flag = True
    else:
        f = real.negate(f)
    f = real.add(QUARTER, f)
    if beyond_first_quarter:
        f = real.negate(f)
    f = real.rounded(f)
    return odd_polynomial(SIN_COEFFICIENTS, f), flag, f, turns


def sine(x: Number) -> Number:
    """SIN of x radians."""
    return _sine(x)[0]


def cosine(x: Number) -> Number:
    """COS of x radians, as SIN (pi/2 + x)."""
    return _sine(real.add(HALF_PI, x))[0]


def tangent(x: Number) -> Number:
    """TAN of x radians: the sine over a cosine folded from the same reduced argument."""
    of_sine, flag, reduced, _ = _sine(real.rounded(x))
    f = real.add(QUARTER, real.negate(real.absolute(reduced)))
    if flag:
        f = real.negate(f)
    return real.divide(of_sine, odd_polynomial(SIN_COEFFICIENTS, f))


def sine_and_byte(x: Number, left: int = 0) -> IntAndByte:
    """SIN, and the byte of INT."""
    result, _, _, turns = _sine(x)
    return result, integer_part(turns, left)[1]


def cosine_and_byte(x: Number, left: int = 0) -> IntAndByte:
    """COS, and the byte of INT."""
    return sine_and_byte(real.add(HALF_PI, x), left)


def tangent_and_byte(x: Number, left: int = 0) -> IntAndByte:
    """TAN, and the byte of INT."""
    return tangent(x), sine_and_byte(real.rounded(x), left)[1]


def arc_tangent(x: Number) -> Number:
    """ATN in radians, -pi/2 ... pi/2."""
    f = real.absolute(x)
    inverted = f[0] > BIAS
    if inverted:
        f = real.divide(ONE, f)
    f = odd_polynomial(ATN_COEFFICIENTS, f)
    if inverted:
        f = real.subtract(HALF_PI, f)
    return real.negate(f) if x[2] else f


def random(x: Number, seed: Number) -> Number:
    """RND: the next random number, to be stored as the new seed; the seed itself for x = 0. A
    negative x starts a sequence. The bytes are shuffled and the exponent thrown away."""
    if not x[0]:
        return seed
    e, m, _ = x if x[2] else real.add(RND_ADDEND, real.multiply(RND_FACTOR, seed))
    b1, b2, b3, b4 = (m >> 8).to_bytes(4, "big")
    return real.rounded(real.normalise(BIAS, int.from_bytes((b4, b2, b3, b1, e), "big"), 0))
