"""Applesoft's functions over arrays: the ROM's reductions and polynomials, step by step.

The coefficients are those of `impact88.applesoft.functions`, and so is the order of the steps. What
is a branch there is a selection here; where a branch cannot fail both ways are computed.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..applesoft import functions as scalar
from .reals import (
    ILLEGAL_QUANTITY,
    OVERFLOW,
    WHOLE,
    ZERO,
    Bools,
    Reals,
    constant,
    floor,
    from_number,
    select,
)

_LOG = [from_number(c) for c in scalar.LOG_COEFFICIENTS]
_EXP = [from_number(c) for c in scalar.EXP_COEFFICIENTS]
_SIN = [from_number(c) for c in scalar.SIN_COEFFICIENTS]
_ATN = [from_number(c) for c in scalar.ATN_COEFFICIENTS]
_SQRT_HALF = from_number(scalar.SQRT_HALF)
_SQRT_TWO = from_number(scalar.SQRT_TWO)
_MINUS_HALF = from_number(scalar.MINUS_HALF)
_LN_TWO = from_number(scalar.LN_TWO)
_LOG2_E = from_number(scalar.LOG2_E)
_TWO_PI = from_number(scalar.TWO_PI)
_HALF_PI = from_number(scalar.HALF_PI)
_QUARTER = from_number(scalar.QUARTER)
HALF = from_number(scalar.HALF)
ONE = constant(1)
_TWO = constant(2)


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


def sgn(x: Reals) -> Reals:
    """-1, 0 or 1."""
    return Reals(np.sign(x.v), x.unit, 1.0, 1.0, True)


def log(x: Reals) -> Reals:
    """Natural logarithm. Records ILLEGAL QUANTITY for x <= 0."""
    illegal = x.v <= 0
    if illegal.any():
        x._unit().record(illegal, ILLEGAL_QUANTITY)
        x = select(illegal, ONE, x)
    f = x.fraction()
    f = (ONE - _SQRT_TWO / (_SQRT_HALF + f)).within(0.172)  # 1 - sqrt 2 / (sqrt 1/2 + 1/2 ... 1)
    f = _MINUS_HALF + odd_polynomial(_LOG, f)
    return _LN_TWO * (f + x.exponent())


def exp(x: Reals) -> Reals:
    """e to the x. Records OVERFLOW; underflows to zero."""
    f = (_LOG2_E * x).with_extension(scalar.EXP_ROUNDING)
    zero: Bools | None = None
    if f.high >= 127:
        v = f.v
        beyond = np.abs(v) >= 128
        whole = f.whole().v
        overflow = (beyond & (v > 0)) | (whole == 127)
        x._unit().record(overflow, OVERFLOW)
        zero = (beyond & (v < 0)) | (whole == -128)
        v[overflow | zero] = 0.0
    i = f.whole()
    # f less its floor
    result = polynomial(_EXP, (-(i - f)).within(1.0)).scaled(i)
    if zero is not None:
        result.v[zero] = 0.0
        result._settle()
    return result


def square(x: Reals) -> Reals:
    """x ^ 2, which is EXP (2 * LOG (x)) with the sign left out; 0 ^ 2 is 0."""
    nothing = x.v == 0
    base = abs(x.rounded())
    if not nothing.any():
        return exp(_TWO * log(base))
    return select(nothing, ZERO, exp(_TWO * log(select(nothing, ONE, base))))


def power(left: Reals, right: Reals) -> Reals:
    """left ^ right = EXP(right * LOG(left)), so x ^ 2 is not x * x.

    Records ILLEGAL QUANTITY for a negative left with a right that is not whole, OVERFLOW.
    """
    left = left.rounded()
    one = right.v == 0
    nothing = (left.v == 0) & ~one
    if nothing.any():  # the power is not looked at
        right = select(nothing, ONE, right)
    p = right.rounded()
    negative = (left.v < 0) & ~one
    base = abs(left)
    whole = floor(p)
    odd: Bools | None = None
    if negative.any():
        fraction = negative & (p.v != whole.v)
        if fraction.any():
            left._unit().record(fraction, ILLEGAL_QUANTITY)
        odd = negative & _odd(p, whole)
    if nothing.any() or not left.full:
        base = select(left.v == 0, ONE, base)
    exponent = p * log(base)
    if one.any():
        exponent = select(one, ZERO, exponent)
    result = exp(exponent)
    if nothing.any():
        result = select(nothing, ZERO, result)
    if odd is not None and odd.any():
        result = select(odd, -result, result)
    return result


def _odd(p: Reals, whole: Reals) -> Bools:
    """The lowest bit of INT(p); from 32 bits on, of p's mantissa."""
    mantissa_bit = (p.bits >> 21) & 1
    small = np.abs(whole.v) < WHOLE
    integer_bit = np.where(small, whole.v, 0.0).astype(np.int64) & 1
    return np.where(small, integer_bit, mantissa_bit) == 1


def sqr(x: Reals) -> Reals:
    """Square root, as (x rounded) ^ 0.5. Records ILLEGAL QUANTITY for a negative x."""
    return power(x.rounded(), HALF)


def _sine(x: Reals) -> tuple[Reals, Bools, Bools, Reals]:
    """SIN; which arguments lie beyond the first quarter turn; whether 0.5 + f came out at or above
    zero; and the reduced argument, rounded."""
    f = (x.rounded() / _TWO_PI).rounded()
    f = (f - floor(f)).within(1.0)
    f = _QUARTER - f
    beyond = f.v < 0
    half = HALF + f
    # beyond the first quarter: half where it is negative, else -half; otherwise -f
    f = -abs(select(beyond, half, f)).within(0.25)
    f = (_QUARTER + f).within(0.25)
    f = select(beyond, -f, f).rounded()
    return odd_polynomial(_SIN, f), beyond, half.v >= 0, f


def sin(x: Reals) -> Reals:
    """Sine of x radians."""
    return _sine(x)[0]


def cos(x: Reals) -> Reals:
    """Cosine of x radians, as SIN (pi/2 + x)."""
    return sin(shifted_for_cosine(x))


def shifted_for_cosine(x: Reals) -> Reals:
    """The argument whose sine is COS (x)."""
    return _HALF_PI + x


def tan(x: Reals) -> Reals:
    """Tangent of x radians: the sine over a cosine folded from the same reduced argument."""
    sine, beyond, high, reduced = _sine(x.rounded())
    f = _QUARTER + -abs(reduced)
    f = select(beyond & high, -f, f)
    return sine.rounded() / odd_polynomial(_SIN, f)


def atn(x: Reals) -> Reals:
    """Arc tangent in radians, -pi/2 ... pi/2."""
    size = abs(x)
    inverted = size.v >= 1
    f = size
    if inverted.any():
        f = select(inverted, ONE / select(inverted, size, ONE), size)
    f = odd_polynomial(_ATN, f)
    f = select(inverted, _HALF_PI - f, f)
    return select(x.v < 0, -f, f)
