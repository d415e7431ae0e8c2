"""The functions the listing calls, over arrays: the ROM's reductions and polynomials.

Coefficients and order of the steps are those of `impact88.apple.applesoft.functions`. A branch
there is a selection here, with both sides computed; where one could fail its operand is replaced
first.
"""

from collections.abc import Sequence

from ...apple.applesoft import functions as scalar
from .reals import ILLEGAL_QUANTITY, ZERO, Reals, constant, from_number, select

_LOG = [from_number(c) for c in scalar.LOG_COEFFICIENTS]
_EXP = [from_number(c) for c in scalar.EXP_COEFFICIENTS]
_SIN = [from_number(c) for c in scalar.SIN_COEFFICIENTS]
_SQRT_HALF = from_number(scalar.SQRT_HALF)
_SQRT_TWO = from_number(scalar.SQRT_TWO)
_MINUS_HALF = from_number(scalar.MINUS_HALF)
_LN_TWO = from_number(scalar.LN_TWO)
_LOG2_E = from_number(scalar.LOG2_E)
_TWO_PI = from_number(scalar.TWO_PI)
_QUARTER = from_number(scalar.QUARTER)
_HALF = from_number(scalar.HALF)
_HALF_PI = from_number(scalar.HALF_PI)
ONE = constant(1)


def polynomial(coefficients: Sequence[Reals], x: Reals) -> Reals:
    """Return c0 x^n + ... + cn by Horner's rule; x is rounded, the sum keeps its extension."""
    x = x.rounded()
    r = coefficients[0] * x
    for c in coefficients[1:-1]:
        r = x * (c + r)
    return coefficients[-1] + r


def odd_polynomial(coefficients: Sequence[Reals], x: Reals) -> Reals:
    """Return x p(x^2), p being the polynomial of ``coefficients``."""
    x = x.rounded()
    return x * polynomial(coefficients, x * x)


def log(x: Reals) -> Reals:
    """Return the natural logarithm. Records ILLEGAL QUANTITY for x <= 0."""
    illegal = x.v <= 0
    if x.record_error(illegal, ILLEGAL_QUANTITY):
        x = select(illegal, ONE, x)
    f = x.fraction()
    f = ONE - _SQRT_TWO / (_SQRT_HALF + f)  # 1 - sqrt 2 / (sqrt 1/2 + 1/2 ... 1)
    f = _MINUS_HALF + odd_polynomial(_LOG, f)
    return _LN_TWO * (f + x.exponent())


def exp(x: Reals) -> Reals:
    """Return e to the power x. Records OVERFLOW; underflows to zero."""
    f = (_LOG2_E * x).with_extension(scalar.EXP_ROUNDING)
    underflows = f.check_powers()
    i = f.whole_part()
    # i - f is minus the fraction of f
    result = polynomial(_EXP, (-(i - f))).scale_by_power(i)
    if underflows is not None:
        result.v[underflows] = 0.0
    return result


def square(x: Reals) -> Reals:
    """Return x ^ 2, computed as EXP (2 * LOG (|x|)); 0 ^ 2 is 0."""
    if x.zero:
        return x
    is_zero = x.is_zero()
    base = abs(x.rounded())
    if not is_zero.any():
        return exp(2 * log(base))
    return select(is_zero, ZERO, exp(2 * log(select(is_zero, ONE, base))))


def sin(x: Reals) -> Reals:
    """Return the sine of x radians."""
    f = (x.rounded() / _TWO_PI).rounded()
    f = f - f.floor()
    f = _QUARTER - f
    beyond = f.v < 0  # the first quarter turn
    half = _HALF + f
    # beyond it: half where it is negative, else -half; otherwise -f
    f = -abs(select(beyond, half, f))
    f = _QUARTER + f
    return odd_polynomial(_SIN, select(beyond, -f, f).rounded())


def cos(x: Reals) -> Reals:
    """Return the cosine of x radians, computed as SIN (pi/2 + x)."""
    return sin(_HALF_PI + x)
