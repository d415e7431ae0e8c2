"""Applesoft's functions by the ROM's own reductions and polynomials, on plain triples (`real`).

Arguments and results may have an extension, which is rounded away only where the ROM does it.
Coefficients are stored reals in hexadecimal.

INT leaves the low byte of its result in memory, where the power of a negative number reads it (see
`power`). INT, and the functions that call it, take the byte left earlier and return theirs, too."""

from collections.abc import Sequence
from functools import lru_cache

from .errorcodes import illegal_quantity, overflow
from .real import (
    BIAS,
    INTEGER_EXPONENT,
    LIMIT,
    TOP,
    ZERO,
    Number,
    absolute,
    add,
    compare,
    divide,
    floor,
    from_stored,
    integer,
    multiply,
    negate,
    normalise,
    product_exponent,
    rounded,
    subtract,
    to_integer,
)

IntAndByte = tuple[Number, int]
"""A result, and the low byte of the last result of INT in its computation."""


def stored_reals(text: str) -> tuple[Number, ...]:
    """Return constants from their hexadecimal bytes, separated by blanks."""
    return tuple(from_stored(word) for word in text.split())


LOG_COEFFICIENTS = stored_reals("7F5E56CB79 80139B0B64 8076389316 8238AA3B20")
EXP_COEFFICIENTS = stored_reals(
    "7134583E56 74167EB31B 772FEEE385 7A1D841C2A 7C6359580A 7E75FDE7C6 8031721810 8100000000"
)
SIN_COEFFICIENTS = stored_reals("84E61A2D1B 862807FBF8 8799688901 872335DFE1 86A55DE728 83490FDAA2")
ATN_COEFFICIENTS = stored_reals(
    "76B383BDD3 791EF4A6F5 7B83FCB010 7C0C1F67CA 7CDE53CBC1 7D1464704C"
    " 7DB7EA517A 7D6330887E 7E9244993A 7E4CCC91C7 7FAAAAAA13 8100000000"
)
SQRT_HALF = from_stored("803504F334")
SQRT_TWO = from_stored("813504F334")
MINUS_HALF = from_stored("8080000000")
LN_TWO = from_stored("80317217F8")
LOG2_E = from_stored("8138AA3B29")
TWO_PI = from_stored("83490FDAA2")
HALF_PI = from_stored("81490FDAA2")
QUARTER = from_stored("7F00000000")
HALF = from_stored("8000000000")
RND_FACTOR = from_stored("9835447A68")
RND_ADDEND = from_stored("6828B14620")
ONE = integer(1)
EXP_ROUNDING = 0x50  # added by EXP to the extension of x / ln 2 before splitting it


def polynomial(coefficients: Sequence[Number], x: Number) -> Number:
    """Return c0 x^n + ... + cn by Horner's rule; x is rounded, the sum keeps its extension."""
    x = rounded(x)
    r = multiply(coefficients[0], x)
    for c in coefficients[1:-1]:
        r = multiply(x, add(c, r))
    return add(coefficients[-1], r)


def odd_polynomial(coefficients: Sequence[Number], x: Number) -> Number:
    """Return x p(x^2), p being the polynomial of ``coefficients``."""
    x = rounded(x)
    return multiply(x, polynomial(coefficients, multiply(x, x)))


def sign(x: Number) -> Number:
    """SGN: -1, 0 or 1."""
    e, _, s = x
    return integer(-1 if s else 1) if e else ZERO


def logarithm(x: Number) -> Number:
    """LOG, the natural logarithm. Raises ILLEGAL QUANTITY for x <= 0."""
    e, m, s = x
    if s or not e:
        raise illegal_quantity()
    f = (BIAS, m, 0)
    f = subtract(ONE, divide(SQRT_TWO, add(SQRT_HALF, f)))
    f = add(MINUS_HALF, odd_polynomial(LOG_COEFFICIENTS, f))
    return multiply(LN_TWO, add(f, integer(e - BIAS)))


def integer_part(x: Number, left: int = 0) -> IntAndByte:
    """INT, and the low byte of the result, which the ROM leaves in memory; for a number of 32 or
    more bits before the point the ROM does not compute it, and the byte ``left`` there earlier
    stays."""
    integral = floor(x)
    return integral, (to_integer(integral) & 0xFF if x[0] < INTEGER_EXPONENT else left)


def exponential(x: Number, left: int = 0) -> IntAndByte:
    """EXP: e to the power x. Raises OVERFLOW; underflows to zero.

    INT splits x / ln 2 unless its exponent shows it out of range."""
    e, m, s = turns = _over_ln_two(x)
    if e < BIAS + 8:
        doublings = to_integer((e, m & ~0xFF, s))
        exponent, left = doublings + 129 & 0xFF, doublings & 0xFF
    else:
        doublings = exponent = 0
    if not exponent and not x[2]:
        raise overflow()
    if exponent <= 1:
        return ZERO, left
    fraction = negate(subtract(integer(doublings), turns))
    e, m, _ = polynomial(EXP_COEFFICIENTS, fraction)
    e = product_exponent(exponent - 1, e)
    return ((e, m, 0) if e else ZERO), left


def _over_ln_two(x: Number) -> Number:
    """Return x / ln 2 with `EXP_ROUNDING` added to its extension."""
    e, m, s = multiply(LOG2_E, x)
    if e:
        m += EXP_ROUNDING
        if m >= LIMIT:
            # the 32-bit mantissa overflows to 80000000, and the extension keeps its sum
            m = TOP | m & 0xFF
            e += 1
    return e, m, s


def power(left: Number, right: Number, byte: int = 0) -> IntAndByte:
    """left ^ right = EXP (right * LOG (left)), so X ^ 2 is not X * X.

    Raises OVERFLOW, and ILLEGAL QUANTITY for a negative left with a fractional right. For a
    negative left, the byte that INT (right) leaves decides if right is odd; from 2^31 on it is the
    byte of an earlier INT."""
    if not right[0]:
        return exponential(ZERO)
    left = rounded(left)
    if not left[0]:
        return ZERO, byte
    exponent = rounded(right)
    odd = False
    if left[2]:
        integral, byte = integer_part(exponent, byte)
        if compare(exponent, integral):
            raise illegal_quantity()
        odd = bool(byte & 1)
        left = negate(left)
    result, byte = exponential(multiply(exponent, logarithm(left)), byte)
    return (negate(result) if odd else result), byte


def square_root(x: Number, left: int = 0) -> IntAndByte:
    """SQR, as (x rounded) ^ 0.5. Raises ILLEGAL QUANTITY for a negative x."""
    return power(x, HALF, left)


@lru_cache(maxsize=64)  # programs use the sine of the same few angles repeatedly
def _sine(x: Number, left: int) -> tuple[Number, int, bool, Number]:
    """Return the sine, the byte of INT, and two values for TAN: the quadrant flag, and the reduced
    argument, a fraction of a turn in -1/4 ... 1/4, rounded."""
    f = rounded(divide(x, TWO_PI))
    whole_turns, byte = integer_part(f, left)
    f = subtract(QUARTER, subtract(f, whole_turns))
    beyond_first_quarter = f[2]
    flag = False
    if beyond_first_quarter:
        f = add(HALF, f)
        if not f[2]:
            f = negate(f)
            flag = True
    else:
        f = negate(f)
    f = add(QUARTER, f)
    if beyond_first_quarter:
        f = negate(f)
    f = rounded(f)
    return odd_polynomial(SIN_COEFFICIENTS, f), byte, flag, f


def sine(x: Number, left: int = 0) -> IntAndByte:
    """SIN of x radians."""
    return _sine(x, left)[:2]


def cosine(x: Number, left: int = 0) -> IntAndByte:
    """COS of x radians, computed as SIN (pi/2 + x)."""
    return sine(add(HALF_PI, x), left)


def tangent(x: Number, left: int = 0) -> IntAndByte:
    """TAN of x radians: the sine divided by the cosine of the same reduced argument."""
    of_sine, byte, flag, remainder = _sine(rounded(x), left)
    f = add(QUARTER, negate(absolute(remainder)))
    if flag:
        f = negate(f)
    return divide(of_sine, odd_polynomial(SIN_COEFFICIENTS, f)), byte


def arc_tangent(x: Number) -> Number:
    """ATN in radians, -pi/2 ... pi/2."""
    f = absolute(x)
    is_inverted = f[0] > BIAS
    if is_inverted:
        f = divide(ONE, f)
    f = odd_polynomial(ATN_COEFFICIENTS, f)
    if is_inverted:
        f = subtract(HALF_PI, f)
    return negate(f) if x[2] else f


def random(x: Number, seed: Number) -> Number:
    """RND: the next random number, to be stored as the new seed; the seed itself for x = 0.

    A negative x starts a sequence. The bytes are shuffled and the exponent discarded."""
    if not x[0]:
        return seed
    e, m, _ = x if x[2] else add(RND_ADDEND, multiply(RND_FACTOR, seed))
    b1, b2, b3, b4 = (m >> 8).to_bytes(4, "big")
    return rounded(normalise(BIAS, int.from_bytes((b4, b2, b3, b1, e), "big"), 0))
