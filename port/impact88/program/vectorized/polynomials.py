"""The functions the listing calls, over arrays: the ROM's reductions and polynomials.

The coefficients are those of `impact88.applesoft.functions`, and so is the order of the steps. What
is a branch there is a selection here; where a branch cannot fail both ways are computed.
"""

from collections.abc import Sequence

from ...applesoft import functions as scalar
from .reals import ILLEGAL_QUANTITY, ZERO, Reals, constant, from_number, select

_LOG = [from_number(c) for c in scalar.LOG_COEFFICIENTS]
_EXP = [from_number(c) for c in scalar.EXP_COEFFICIENTS]
_SIN = [from_number(c) for c in scalar.SIN_COEFFICIENTS]
_SQRT_HALF, _SQRT_TWO = from_number(scalar.SQRT_HALF), from_number(scalar.SQRT_TWO)
_MINUS_HALF, _LN_TWO = from_number(scalar.MINUS_HALF), from_number(scalar.LN_TWO)
_LOG2_E, _TWO_PI = from_number(scalar.LOG2_E), from_number(scalar.TWO_PI)
_QUARTER, _HALF = from_number(scalar.QUARTER), from_number(scalar.HALF)
_HALF_PI = from_number(scalar.HALF_PI)
ONE = constant(1)


def polynomial(coefficients: Sequence[Reals], x: Reals) -> Reals:
    """c0 x^n + ... + cn by Horner's rule; x is rounded, the running value keeps its extension."""
    x = x.rounded()
    r = coefficients[0] * x
    for c in coefficients[1:-1]:
        r = x * (c + r)
    return coefficients[-1] + r


def odd_polynomial(coefficients: Sequence[Reals], x: Reals) -> Reals:
    """x times the polynomial in x squared."""
    x = x.rounded()
    return x * polynomial(coefficients, x * x)


def log(x: Reals) -> Reals:
    """Natural logarithm. Records ILLEGAL QUANTITY for x <= 0."""
    illegal = x.v <= 0
    if x.fails(illegal, ILLEGAL_QUANTITY):
        x = select(illegal, ONE, x)
    f = x.fraction()
    f = ONE - _SQRT_TWO / (_SQRT_HALF + f)  # 1 - sqrt 2 / (sqrt 1/2 + 1/2 ... 1)
    f = _MINUS_HALF + odd_polynomial(_LOG, f)
    return _LN_TWO * (f + x.exponent())


def exp(x: Reals) -> Reals:
    """e to the x. Records OVERFLOW; underflows to zero."""
    f = (_LOG2_E * x).with_extension(scalar.EXP_ROUNDING)
    zero = f.kept_within_powers()
    i = f.whole()
    # f less its floor
    result = polynomial(_EXP, (-(i - f))).scaled(i)
    if zero is not None:
        result.v[zero] = 0.0
    return result


def square(x: Reals) -> Reals:
    """x ^ 2, which is EXP (2 * LOG (x)) with the sign left out; 0 ^ 2 is 0."""
    if x.zero:
        return x
    nothing = x.nothing()
    base = abs(x.rounded())
    if not nothing.any():
        return exp(2 * log(base))
    return select(nothing, ZERO, exp(2 * log(select(nothing, ONE, base))))


def sin(x: Reals) -> Reals:
    """Sine of x radians."""
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
    """Cosine of x radians, as SIN (pi/2 + x)."""
    return sin(_HALF_PI + x)
