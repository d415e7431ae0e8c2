"""Arrays of 40-bit reals, and the ROM's arithmetic on them.

A 40-bit real, extension included, is exactly a float64: 40 bits of 53, and an exponent between
-128 and 126 of +-1022. So an array of reals is a float64 array whose low 13 bits are clear, and

    rounding to 32 bits   is integer arithmetic on its bits (a carry runs into the exponent),
    a sum                 is exact once the smaller operand is cut off at the larger one's 40th bit,
    a product             is built of whole numbers, as the ROM does, and
    a quotient            is the processor's, corrected where that rounded up across a bit.

    bit 63 sign | 52-62 exponent byte + 894 | 21-51 mantissa without its top bit | 13-20 extension

An array known to be all zero costs nothing: x + 0 is x rounded and 0 * x is 0 by the ROM's own
rules. The scalar text of these rules is `impact88.applesoft.real`; the same captures drive both.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from ...applesoft.errorcodes import CODES
from ...applesoft.real import Number, integer
from .unit import Bools, Unit

Floats = npt.NDArray[np.float64]
Packed = npt.NDArray[np.uint64]

OVERFLOW = CODES["OVERFLOW"]
DIVISION_BY_ZERO = CODES["DIVISION BY ZERO"]
ILLEGAL_QUANTITY = CODES["ILLEGAL QUANTITY"]

BIAS = 894
"""What a float64's exponent field has more than the exponent byte."""
LARGEST = 2.0**127
"""One past the largest real: exponent byte 256."""
SMALLEST = 2.0**-128
"""The smallest real: exponent byte 1, mantissa 80000000."""
WHOLE = 2.0**31
"""From here on (exponent byte 160) INT leaves a number as it is, extension and all."""


def _mask(low: int, high: int) -> np.int64:
    """The bits ``low`` to ``high`` of a float64, counted from 0."""
    value = (1 << (high + 1)) - (1 << low)
    return np.int64(value - (1 << 64) if high == 63 else value)


def _wrapped(value: int) -> np.int64:
    value &= (1 << 64) - 1
    return np.int64(value - (1 << 64) if value >> 63 else value)


# Parts of a real, by the bits they take.
_SIGN = _mask(63, 63)
_EXPONENT = _mask(52, 62)
_FRACTION = _mask(0, 51)  # the mantissa without its top bit, which a float64 does not hold
_HALF_UNIT = np.int64(1 << 20)  # the extension's top bit: half of what a stored real can show
_32_BITS = _mask(21, 63)  # what a stored real keeps: the extension cleared
_40_BITS = _mask(13, 63)  # what a real keeps: what no register holds cleared
_UPPER_HALF = _mask(33, 62)  # of a factor: 20 bits, so that its products are exact

_BELOW_ONE = np.int64(1022 << 52)  # the exponent of numbers from 1/2 to 1
_TO_UNITS = _wrapped((1023 + 39 + 1023) << 52)  # less an exponent: the scale that makes it 2^39
_FROM_UNITS = np.int64(39 << 52)  # takes that scale's power of two back
_BELOW_256 = np.int64(((1023 + 8) << 52) - 1)  # a sum of fewer units has its upper 32 bits clear
_EQUAL_CARRY = np.uint64(51)  # how far right: 13 ones are left of a word of ones, else none
_ONE = np.uint64(1)
_52 = np.uint64(52)  # the bits below the exponent

_TOP = np.int64(1 << 52)  # the mantissa's top bit, put back
_EIGHT, _LAST_BYTE = np.uint64(8), np.uint64(0xFF)
_BYTE_SHIFTS = [np.uint64(8 * position) for position in range(5)]  # extension first


def _operator(name: str, reflected: bool = False) -> Callable[[Reals, Reals | int], Reals]:
    """The method of an operator; ``reflected``: with the operands the other way round."""

    def method(self: Reals, other: Reals | int) -> Reals:
        operand = other if isinstance(other, Reals) else constant(other)
        left, right = (operand, self) if reflected else (self, operand)
        # of two classes the more special one knows what to do
        special = operand if isinstance(operand, type(self)) else self
        result: Reals = special.combined(name, left, right)
        return result

    return method


class Reals:
    """An array of reals: float64 values ``v`` and what is known about them.

    ``stored``: the extension is zero; ``zero``: all are known to be zero; ``unit``: the block they
    belong to (None: constants). The last axis runs over the scenes, or has length 1 for what all
    scenes share. Operators do what the ROM does: the left operand is rounded, the right one keeps
    its extension; Python integers are constants. What is combined with a value of a block belongs
    to the block, also where it is a known zero.
    """

    __slots__ = ("bits", "stored", "unit", "v", "zero")

    def __init__(
        self, v: Floats, unit: Unit | None, stored: bool = False, zero: bool = False
    ) -> None:
        self.v = v
        self.bits = v.view(np.int64)
        self.unit = unit
        self.stored = stored
        self.zero = zero

    def rounded(self) -> Reals:
        """As a variable keeps it: 32 bits, by the top bit of the extension alone."""
        if self.stored:
            return self
        v = (self.bits + _HALF_UNIT & _32_BITS).view(np.float64)
        return Reals(v, self.unit, True, self.zero)._settled()

    def __neg__(self) -> Reals:
        return Reals(np.negative(self.v), self.unit, self.stored, self.zero)

    def __abs__(self) -> Reals:
        return Reals(np.abs(self.v), self.unit, self.stored, self.zero)

    __add__, __radd__ = _operator("add"), _operator("add", reflected=True)
    __sub__, __rsub__ = _operator("subtract"), _operator("subtract", reflected=True)
    __mul__, __rmul__ = _operator("multiply"), _operator("multiply", reflected=True)
    __truediv__ = _operator("divide")
    __lt__: Any = _operator("less")
    __gt__: Any = _operator("greater")

    def combined(self, operation: str, left: Reals, right: Reals) -> Any:
        """What an operator makes of two reals, one of which this is."""
        return _OPERATIONS[operation](left, right)

    def chosen(self, condition: Any, yes: Reals, no: Reals) -> Reals:
        """`select`, where this is one of the two."""
        v, zero = np.where(condition, yes.v, no.v), yes.zero and no.zero
        return Reals(v, yes.unit or no.unit, yes.stored and no.stored, zero)

    def below(self, limit: Reals) -> Any:
        """Where it is below: the numbers, not as the ROM compares."""
        return self.v < limit.v

    def nothing(self) -> Any:
        """Where it is zero."""
        return self.v == 0

    def exceeds(self, limit: float) -> bool:
        """Whether any magnitude is above ``limit``."""
        return bool((np.abs(self.v) > limit).any())

    def floor(self) -> Reals:
        """INT: the largest whole number not above it, its extension counted."""
        large = np.abs(self.v) >= WHOLE
        v = np.where(large, self.v, np.floor(self.v))
        return Reals(v, self.unit, self.stored or not large.any(), self.zero)

    # the parts that LOG and EXP take a number apart into, and put it together from

    def fraction(self) -> Reals:
        """The mantissa, as a number from 1/2 to 1."""
        v = ((self.bits & _FRACTION) | _BELOW_ONE).view(np.float64)
        return Reals(v, self.unit, self.stored)

    def exponent(self) -> Reals:
        """The power of two that goes with `fraction`."""
        v = ((self.bits >> 52) - (BIAS + 128)).astype(np.float64)
        return Reals(v, self.unit, True)

    def with_extension(self, more: int) -> Reals:
        """``more`` added to the extension; a carry runs into the exponent. Zero stays zero."""
        v = (self.bits + np.int64(more << 13)).view(np.float64)
        v[self.v == 0] = 0.0
        return Reals(v, self.unit)

    def kept_within_powers(self) -> Bools | None:
        """As EXP's power of two: one too large is recorded as OVERFLOW; where it is too small,
        which makes the result zero, is returned, if it is so anywhere."""
        beyond, whole = np.abs(self.v) >= 128, self.whole().v
        overflow = (beyond & (self.v > 0)) | (whole == 127)
        zero: Bools = (beyond & (self.v < 0)) | (whole == -128)
        self.fails(overflow, OVERFLOW)
        self.v[overflow | zero] = 0.0
        return zero if zero.any() else None

    def whole(self) -> Reals:
        """The largest whole number not above the upper 32 bits."""
        return Reals(np.floor((self.bits & _32_BITS).view(np.float64)), self.unit, True)

    def scaled(self, powers: Reals) -> Reals:
        """Times two to ``powers``, whole numbers: by the exponent alone."""
        v = (self.bits + (powers.v.astype(np.int64) << 52)).view(np.float64)
        return Reals(v, self.unit)

    def packed(self) -> Packed:
        """The five bytes a variable would hold, as one number: 0x8468000000 for 14.5."""
        bits = self.rounded().bits.view(np.uint64)
        e = (bits >> np.uint64(52) & np.uint64(0x7FF)) - np.uint64(BIAS)
        mantissa = bits >> np.uint64(21) & np.uint64(0x7FFFFFFF)
        sign = bits >> np.uint64(63)
        packed = e << np.uint64(32) | sign << np.uint64(31) | mantissa
        return np.where(self.v == 0, np.uint64(0), packed)

    def _settled(self) -> Reals:
        """The rules for exponents out of range: underflow is zero, overflow an error."""
        sizes = np.abs(self.v)
        if sizes.max(initial=0.0) >= LARGEST:
            self.fails(sizes >= LARGEST, OVERFLOW)
            self.v[sizes >= LARGEST] = 0.0
        self.v[sizes < SMALLEST] = 0.0
        return self

    def fails(self, failed: Any, code: int) -> bool:
        """`Unit.fails`, of the block they belong to; constants cannot fail."""
        return (self.unit or Unit(1)).fails(failed, code)

    def _of(self, unit: Unit | None) -> Reals:
        """The same; a constant becomes a value of the block it was combined with, so that an error
        it leads to later on is recorded there."""
        return self if self.unit or not unit else Reals(self.v, unit, self.stored, self.zero)


def from_floats(v: Floats, unit: Unit | None, stored: bool = False) -> Reals:
    """Reals from float64 values that are reals already."""
    reals = Reals(v, unit, stored)._settled()
    reals.zero = not v.any()
    return reals


def from_packed(packed: Packed, unit: Unit | None) -> Reals:
    """Reals from five stored bytes each, as one number (see `Reals.packed`)."""
    e = packed >> np.uint64(32)
    sign = packed >> np.uint64(31) & _ONE
    fraction = (packed & np.uint64(0x7FFFFFFF)) << np.uint64(21)
    bits = sign << np.uint64(63) | (e + np.uint64(BIAS)) << np.uint64(52) | fraction
    return from_floats(np.where(e == 0, np.uint64(0), bits).view(np.float64), unit, True)


def from_number(number: Number) -> Reals:
    """A constant: one real, extension included."""
    e, m, s = number
    if not e:
        return Reals(np.zeros(1), None, True, zero=True)
    size = m * 2.0 ** (e - 168)
    return Reals(np.array([-size if s else size]), None, not m & 0xFF)


@lru_cache(maxsize=256)
def constant(n: int) -> Reals:
    """A whole number as a constant."""
    return from_number(integer(n))


ZERO = constant(0)


def zero(unit: Unit | None) -> Reals:
    """Zero in every scene of a block, which records what fails because of it."""
    return Reals(ZERO.v, unit, True, zero=True)


def select(condition: Any, yes: Reals, no: Reals) -> Reals:
    """``yes`` where the condition holds, else ``no``."""
    special = no if isinstance(no, type(yes)) else yes
    return special.chosen(condition, yes, no)


def _add(left: Reals, right: Reals, subtract: bool) -> Reals:
    """left + right, or left + (-right).

    Both are scaled so that the larger one's 40-bit mantissa is a whole number; the smaller one is
    cut off there. Where exponents and signs agree the ROM adds one unit of the extension: such a
    sum always has 41 bits, so the extra unit rounds its halving up instead of down.
    """
    left = left.rounded()
    if right.zero:
        return left._of(right.unit)
    if left.zero:
        return (-right if subtract else right)._of(left.unit)
    unit = left.unit or right.unit
    exponents = np.maximum(left.bits & _EXPONENT, right.bits & _EXPONENT)
    to_units = (_TO_UNITS - exponents).view(np.float64)
    v, other = np.trunc(left.v * to_units), np.trunc(right.v * to_units)
    v = v - other if subtract else v + other
    bits = v.view(np.int64)
    if not right.stored:  # two stored operands give an even sum: the unit is lost
        unlike = left.bits ^ right.bits
        if subtract:
            unlike ^= _SIGN
        signs_and_exponents = unlike.view(np.uint64) >> _52
        # 13 ones where sign and exponent agree, else 0
        bits += (signs_and_exponents - _ONE >> _EQUAL_CARRY).view(np.int64)
    bits &= _40_BITS
    # normalising takes less than 256 units, the upper 32 bits all clear, for zero
    bits &= _BELOW_256 - (bits & _EXPONENT) >> 63
    v *= (exponents - _FROM_UNITS).view(np.float64)
    return Reals(v, unit)._settled()


def _multiply(left: Reals, right: Reals) -> Reals:
    """left * right as the ROM builds it, a byte of the right operand at a time: the exact product
    cut to 40 bits before normalising, but for its defect. After a second zero byte in a row the
    upper 32 bits of what has been built move one bit too far.

    The bytes of the 40 bits are numbered from the extension, 0, to the top, 4, which is never zero.
    """
    left = left.rounded()
    unit = left.unit or right.unit
    if left.zero or right.zero:
        return zero(unit)
    m1 = ((left.bits & _FRACTION | _TOP) >> 21).view(np.uint64)
    m2 = ((right.bits & _FRACTION | _TOP) >> 13).view(np.uint64)
    built = (m2 & _LAST_BYTE) * m1  # is shifted left and right by 8
    before = m2 & _LAST_BYTE == 0
    for position in range(1, 5):
        byte = m2 >> _BYTE_SHIFTS[position] & _LAST_BYTE
        built = (byte * m1 << _EIGHT) + built >> _EIGHT
        none = byte == 0
        # nothing is built yet after zeros at 0 and 1
        twice = none & before
        if position in (2, 3) and twice.any():
            built = built >> _EIGHT + twice << _EIGHT | built & _LAST_BYTE
        before = none
    # 39 or 40 bits long, byte 4 sees to that; the bit a shorter one leaves empty is zero, as after
    # normalising
    v = built.astype(np.float64) * 2.0**-38
    v *= (left.bits & ~_FRACTION).view(np.float64) * (right.bits & ~_FRACTION).view(np.float64)
    result = Reals(v, unit)
    if np.abs(v).max(initial=0.0) >= LARGEST / 2:  # judged before it is normalised
        exponents = ((left.bits & _EXPONENT) >> 52) + ((right.bits & _EXPONENT) >> 52)
        failed = (exponents >= 384 + 2 * BIAS) & (v != 0)
        result.fails(failed, OVERFLOW)
        v[failed] = 0.0
    return result._settled()


def _divide(left: Reals, right: Reals) -> Reals:
    """left / right, both rounded: a quotient of 34 bits, or 33 where the mantissa divided is the
    smaller one.

    The processor's quotient is cut there, and where it had been rounded up to that bit the
    remainder, computed exactly, is negative and one unit is taken back.
    """
    unit = left.unit or right.unit
    right = right.rounded()
    by_zero = right.v == 0
    if by_zero.any():
        (unit or Unit(1)).fails(by_zero, DIVISION_BY_ZERO)
        right = select(by_zero, constant(1), right)
    left = left.rounded()
    if left.zero:
        return zero(unit)
    signs = left.bits ^ right.bits
    a, b = np.abs(left.v), np.abs(right.v)
    v = a / b
    bits = v.view(np.int64)
    kept = (signs ^ bits) >> 52 - 19 & _mask(19, 19) | _mask(20, 63)
    bits &= kept
    upper = (bits & _UPPER_HALF).view(np.float64)
    remainder = a - upper * b
    remainder -= (v - upper) * b
    bits += remainder.view(np.int64) >> 63 << 19
    bits &= kept
    bits |= signs & _SIGN

    result = Reals(v, unit)
    difference = ((left.bits & _EXPONENT) - (right.bits & _EXPONENT)) >> 52
    failed = (difference >= 127) & (left.v != 0)  # judged before it is normalised
    if failed.any():
        result.fails(failed, OVERFLOW)
        v[failed] = 0.0
    signless = np.broadcast_to(difference == -128, v.shape)  # exponent 0 loses the sign
    v[signless] = np.abs(v[signless])
    return result._settled()


def compare(stored: Reals, right: Reals) -> npt.NDArray[np.int8]:
    """1 where the accumulator ``right`` is larger than ``stored``, 0 where equal, -1 where smaller.

    The accumulator counts as rounded, except that this rounding carries nowhere: a last byte of FF
    with a half unit counts as 256, equal to 0 and larger than anything else.
    """
    stored = stored.rounded()
    v = right.v
    if right.stored:
        return ((stored.v < v).view(np.int8)) - ((stored.v > v).view(np.int8))
    last = _mask(20, 28)
    full = (right.bits & last) == last
    rounded = ((right.bits + _HALF_UNIT) & _32_BITS).view(np.float64)
    order = ((stored.v < rounded).view(np.int8)) - ((stored.v > rounded).view(np.int8))
    if full.any():
        upper = _mask(29, 63)
        same = full & (stored.bits & upper == right.bits & upper)
        order = np.where(same & (stored.bits & _mask(21, 28) == 0), np.int8(0), order)
        # one unit above it in magnitude: equal to it with a carry, beyond it without
        beyond = full & (stored.v == rounded) & ~same
        order = np.where(beyond, np.where(stored.v > 0, np.int8(-1), np.int8(1)), order)
    return order


_OPERATIONS: dict[str, Callable[[Reals, Reals], Any]] = {
    "add": lambda left, right: _add(left, right, False),
    "subtract": lambda left, right: _add(left, right, True),
    "multiply": _multiply,
    "divide": _divide,
    "less": lambda left, right: compare(left, right) > 0,
    "greater": lambda left, right: compare(left, right) < 0,
}
