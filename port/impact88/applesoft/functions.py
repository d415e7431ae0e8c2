"""Applesoft's functions, each by the ROM's own reduction and polynomial.

Arguments may carry an extension (a function's argument is not rounded on the way in, except where
the rule says so); so do results. Coefficients are stored reals in hexadecimal, as the ROM has them.
"""

from __future__ import annotations

from collections.abc import Sequence

from .errors import illegal_quantity, overflow
from .real import (
    BIAS,
    INTEGER_EXPONENT,
    LIMIT,
    TOP,
    ZERO,
    Real,
    compare,
    floor,
    integer,
    normalise,
    product_exponent,
    to_integer,
)


def stored_reals(text: str) -> tuple[Real, ...]:
    """Constants from their hexadecimal bytes, separated by blanks."""
    return tuple(Real.from_stored(word) for word in text.split())


LOG_COEFFICIENTS = stored_reals("7F5E56CB79 80139B0B64 8076389316 8238AA3B20")
EXP_COEFFICIENTS = stored_reals(
    "7134583E56 74167EB31B 772FEEE385 7A1D841C2A 7C6359580A 7E75FDE7C6 8031721810 8100000000"
)
SIN_COEFFICIENTS = stored_reals("84E61A2D1B 862807FBF8 8799688901 872335DFE1 86A55DE728 83490FDAA2")
ATN_COEFFICIENTS = stored_reals(
    "76B383BDD3 791EF4A6F5 7B83FCB010 7C0C1F67CA 7CDE53CBC1 7D1464704C"
    " 7DB7EA517A 7D6330887E 7E9244993A 7E4CCC91C7 7FAAAAAA13 8100000000"
)
(
    SQRT_HALF,
    SQRT_TWO,
    MINUS_HALF,
    LN_TWO,
    LOG2_E,
    TWO_PI,
    HALF_PI,
    QUARTER,
    HALF,
) = stored_reals(
    "803504F334 813504F334 8080000000 80317217F8 8138AA3B29 83490FDAA2 81490FDAA2 7F00000000"
    " 8000000000"
)
RND_FACTOR, RND_ADDEND = stored_reals("9835447A68 6828B14620")
FIRST_SEED = Real.from_stored("804FC75258")
"""RND's seed after the machine is switched on."""
ONE = integer(1)
EXP_ROUNDING = 0x50
"""What EXP adds to the extension of x / ln 2 before it takes that apart."""


def polynomial(coefficients: Sequence[Real], x: Real) -> Real:
    """c0 x^n + ... + cn by Horner's rule; ``x`` is rounded, the running value keeps its extension."""
    x = x.rounded()
    r = coefficients[0] * x
    for c in coefficients[1:-1]:
        r = x * (c + r)
    return coefficients[-1] + r


def odd_polynomial(coefficients: Sequence[Real], x: Real) -> Real:
    """x times the polynomial in x squared."""
    x = x.rounded()
    return x * polynomial(coefficients, x * x)


def INT(x: Real) -> Real:
    """The floor of x, see `real.floor`."""
    return floor(x)


def ABS(x: Real) -> Real:
    """x without its sign; the extension stays."""
    return abs(x)


def SGN(x: Real) -> Real:
    """-1, 0 or 1."""
    return integer(-1 if x.s else 1) if x.e else ZERO


def LOG(x: Real) -> Real:
    """Natural logarithm. Raises ILLEGAL QUANTITY for x <= 0."""
    if x.s or not x.e:
        raise illegal_quantity()
    f = Real(BIAS, x.m, 0)
    f = ONE - SQRT_TWO / (SQRT_HALF + f)
    f = MINUS_HALF + odd_polynomial(LOG_COEFFICIENTS, f)
    return LN_TWO * (f + integer(x.e - BIAS))


def EXP(x: Real) -> Real:
    """e to the x. Raises OVERFLOW; underflows to zero."""
    f = LOG2_E * x
    e = f.e
    if e:
        m = f.m + EXP_ROUNDING
        if m >= LIMIT:
            # the 32-bit mantissa overflows to 80000000; the extension's sum is kept as it is
            m = TOP | m & 0xFF
            e += 1
        f = Real(e, m, f.s)
    if e >= BIAS + 8:
        return _exp_out_of_range(f.s)
    i = to_integer(Real(e, f.m & ~0xFF, f.s)) if e else 0
    k = i + 129 & 0xFF
    if not k:
        return _exp_out_of_range(int(i < 0))
    k -= 1
    if not k:
        return ZERO
    g = polynomial(EXP_COEFFICIENTS, -(integer(i) - f))
    e = product_exponent(k, g.e)
    return Real(e, g.m, 0) if e else ZERO


def _exp_out_of_range(negative: int) -> Real:
    if negative:
        return ZERO
    raise overflow()


def power(left: Real, right: Real) -> Real:
    """left ^ right = EXP(right * LOG(left)), so X ^ 2 is not X * X.

    Raises ILLEGAL QUANTITY for a negative left with a right that is not whole, OVERFLOW.
    """
    if not right.e:
        return EXP(ZERO)
    left = left.rounded()
    if not left.e:
        return ZERO
    p = right.rounded()
    odd = False
    if left.s:
        whole = floor(p)
        if compare(p, whole):
            raise illegal_quantity()
        # beyond 32 bits the ROM still looks at the mantissa's last bit
        odd = bool((p.m >> 8 if p.e >= INTEGER_EXPONENT else to_integer(p)) & 1)
        left = -left
    result = EXP(p * LOG(left))
    return -result if odd else result


def SQR(x: Real) -> Real:
    """Square root, as (x rounded) ^ 0.5. Raises ILLEGAL QUANTITY for a negative x."""
    return power(x.rounded(), HALF)


def _sine(x: Real) -> tuple[Real, bool, Real]:
    """SIN, with what TAN needs of it: the quadrant flag and the reduced argument, rounded.

    The angle becomes a fraction of a turn, and that is folded into -1/4 ... 1/4.
    """
    f = (x.rounded() / TWO_PI).rounded()
    f = f - floor(f)
    f = QUARTER - f
    beyond_first_quarter = f.s
    flag = False
    if beyond_first_quarter:
        f = HALF + f
        if not f.s:
            f = -f
            flag = True
    else:
        f = -f
    f = QUARTER + f
    if beyond_first_quarter:
        f = -f
    f = f.rounded()
    return odd_polynomial(SIN_COEFFICIENTS, f), flag, f


def SIN(x: Real) -> Real:
    """Sine of x radians."""
    return _sine(x)[0]


def COS(x: Real) -> Real:
    """Cosine of x radians, as SIN (pi/2 + x)."""
    return _sine(HALF_PI + x)[0]


def TAN(x: Real) -> Real:
    """Tangent of x radians: the sine over a cosine folded from the same reduced argument."""
    sine, flag, reduced = _sine(x.rounded())
    f = QUARTER + -abs(reduced)
    if flag:
        f = -f
    return sine.rounded() / odd_polynomial(SIN_COEFFICIENTS, f)


def ATN(x: Real) -> Real:
    """Arc tangent in radians, -pi/2 ... pi/2."""
    f = abs(x)
    inverted = f.e > BIAS
    if inverted:
        f = ONE / f
    f = odd_polynomial(ATN_COEFFICIENTS, f)
    if inverted:
        f = HALF_PI - f
    return -f if x.s else f


def RND(x: Real, seed: Real) -> Real:
    """The next random number, to be stored as the new seed; the seed itself for x = 0.

    A negative x starts a sequence of its own. The bytes are shuffled and the exponent thrown away.
    """
    if not x.e:
        return seed
    f = x if x.s else RND_ADDEND + RND_FACTOR * seed
    b1, b2, b3, b4 = (f.m >> 8).to_bytes(4, "big")
    return normalise(BIAS, int.from_bytes((b4, b2, b3, b1, f.e), "big"), 0).rounded()
