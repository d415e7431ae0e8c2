"""Arrays of 40-bit reals, and the ROM's arithmetic on them.

A 40-bit real, extension included, is exactly a float64: 40 bits of 53, and an exponent between
-128 and 126 of +-1022. So an array of reals is a float64 array whose low 13 bits are clear, and

    rounding to 32 bits   is integer arithmetic on its bits (a carry runs into the exponent); a sum
    is exact after truncating the smaller operand at the larger one's 40th bit; a product
    is built from whole numbers, as in the ROM; a quotient            is the processor's, corrected
    where its rounding changed the 34th bit.

    bit 63 sign | 52-62 exponent byte + 894 | 21-51 mantissa without its top bit | 13-20 extension

An array known to be all zero costs nothing: x + 0 is x rounded and 0 * x is 0 by the ROM's rules.
The scalar form of these rules is `impact88.apple.applesoft.real`; the same captures test both.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from ...apple.applesoft.errorcodes import CODES
from ...apple.applesoft.real import Number, integer
from .blockerrors import BlockErrors, Bools

Floats = npt.NDArray[np.float64]
Packed = npt.NDArray[np.uint64]

OVERFLOW = CODES["OVERFLOW"]
DIVISION_BY_ZERO = CODES["DIVISION BY ZERO"]
ILLEGAL_QUANTITY = CODES["ILLEGAL QUANTITY"]

BIAS = 894  # a float64's exponent field minus the exponent byte
OVERFLOW_LIMIT = 2.0**127  # exponent byte 256, one past the largest real
MIN_REAL = 2.0**-128  # exponent byte 1, mantissa 80000000
INT_LIMIT = 2.0**31  # exponent byte 160: INT leaves larger numbers unchanged, with extension


def _mask(low: int, high: int) -> np.int64:
    """Return a mask of bits ``low`` to ``high`` of a float64, counted from 0."""
    value = (1 << (high + 1)) - (1 << low)
    return np.int64(value - (1 << 64) if high == 63 else value)


def _to_int64(value: int) -> np.int64:
    """Return ``value`` modulo 2^64 as a signed integer."""
    value &= (1 << 64) - 1
    return np.int64(value - (1 << 64) if value >> 63 else value)


# Parts of a real, as masks of bits.
_SIGN = _mask(63, 63)
_EXPONENT = _mask(52, 62)
_FRACTION = _mask(0, 51)  # the mantissa without its top bit, which a float64 does not hold
_HALF_UNIT = np.int64(
    1 << 20
)  # the extension's top bit: half a unit in the last place of a stored real
_32_BITS = _mask(21, 63)  # the bits of a stored real: without the extension
_40_BITS = _mask(13, 63)  # the bits of a real in the ROM's registers
_UPPER_HALF = _mask(33, 62)  # of a quotient: 20 bits of mantissa, so that its products are exact

_BELOW_ONE = np.int64(1022 << 52)  # the exponent of numbers from 1/2 to 1
_TO_UNITS = _to_int64((1023 + 39 + 1023) << 52)  # minus an exponent: the factor that makes it 2^39
_FROM_UNITS = np.int64(39 << 52)  # undoes that factor
_BELOW_256 = np.int64(((1023 + 8) << 52) - 1)  # a sum below 256 units has its upper 32 bits clear
_EQUAL_CARRY = np.uint64(51)  # right shift that turns -1 into 13 ones and small numbers into 0
_ONE = np.uint64(1)
_52 = np.uint64(52)  # the bits below the exponent

_TOP = np.int64(1 << 52)  # the mantissa's top bit, put back
_EIGHT = np.uint64(8)
_LAST_BYTE = np.uint64(0xFF)
_BYTE_SHIFTS = [np.uint64(8 * position) for position in range(5)]  # extension first


def _operator(name: str, reflected: bool = False) -> Callable[[Reals, Reals | int], Reals]:
    """Return the method of an operator; ``reflected``: with its operands swapped."""

    def method(self: Reals, other: Reals | int) -> Reals:
        operand = other if isinstance(other, Reals) else constant(other)
        left, right = (operand, self) if reflected else (self, operand)
        # a subclass (symbolic reals) handles mixed operands
        special = operand if isinstance(operand, type(self)) else self
        result: Reals = special.combine(name, left, right)
        return result

    return method


class Reals:
    """An array of reals.

    Parameters
    ----------
    v : ndarray of float64
        The values. The last axis runs over the scenes, or has length 1 if all scenes share it.
    errors : BlockErrors or None
        The block of scenes they belong to, which records their errors; None for constants.
    stored : bool, default False
        True if the extensions are known to be zero.
    zero : bool, default False
        True if all values are known to be zero.

    Notes
    -----
    Operators follow the ROM: the left operand is rounded, the right one keeps its extension. Python
    integers are constants. A result belongs to the block of its operands, even if it is a known
    zero.
    """

    __slots__ = ("bits", "errors", "stored", "v", "zero")

    def __init__(
        self, v: Floats, errors: BlockErrors | None, stored: bool = False, zero: bool = False
    ) -> None:
        self.v = v
        self.bits = v.view(np.int64)
        self.errors = errors
        self.stored = stored
        self.zero = zero

    def rounded(self) -> Reals:
        """Return the values as a variable stores them: rounded to 32 bits by the extension's top
        bit."""
        if self.stored:
            return self
        v = (self.bits + _HALF_UNIT & _32_BITS).view(np.float64)
        return Reals(v, self.errors, True, self.zero)._check_exponents()

    def __neg__(self) -> Reals:
        return Reals(np.negative(self.v), self.errors, self.stored, self.zero)

    def __abs__(self) -> Reals:
        return Reals(np.abs(self.v), self.errors, self.stored, self.zero)

    __add__, __radd__ = _operator("add"), _operator("add", reflected=True)
    __sub__, __rsub__ = _operator("subtract"), _operator("subtract", reflected=True)
    __mul__, __rmul__ = _operator("multiply"), _operator("multiply", reflected=True)
    __truediv__ = _operator("divide")
    __lt__: Any = _operator("less")
    __gt__: Any = _operator("greater")

    def combine(self, operation: str, left: Reals, right: Reals) -> Any:
        """Return the result of an operator on two reals, one of which is this."""
        return _OPERATIONS[operation](left, right)

    def choose(self, condition: Any, yes: Reals, no: Reals) -> Reals:
        """Return `select` of two reals, one of which is this."""
        v, zero = np.where(condition, yes.v, no.v), yes.zero and no.zero
        return Reals(v, yes.errors or no.errors, yes.stored and no.stored, zero)

    def is_below(self, limit: Reals) -> Any:
        """Return where the values are below ``limit``, as numbers (the ROM's comparison: ``<``)."""
        return self.v < limit.v

    def is_zero(self) -> Any:
        """Return where the values are zero."""
        return self.v == 0

    def exceeds(self, limit: float) -> bool:
        """Return True if any magnitude is above ``limit``."""
        return bool((np.abs(self.v) > limit).any())

    def floor(self) -> Reals:
        """Return INT: the largest whole number not above the value, extension included."""
        large = np.abs(self.v) >= INT_LIMIT
        v = np.where(large, self.v, np.floor(self.v))
        return Reals(v, self.errors, self.stored or not large.any(), self.zero)

    # the parts into which LOG and EXP split a number, and from which they compose it

    def fraction(self) -> Reals:
        """Return the mantissa as a number from 1/2 to 1."""
        v = ((self.bits & _FRACTION) | _BELOW_ONE).view(np.float64)
        return Reals(v, self.errors, self.stored)

    def exponent(self) -> Reals:
        """Return the exponent e of value = fraction * 2^e, see `fraction`."""
        v = ((self.bits >> 52) - (BIAS + 128)).astype(np.float64)
        return Reals(v, self.errors, True)

    def with_extension(self, more: int) -> Reals:
        """Return the value with ``more`` added to its extension, carry included; zero stays
        zero."""
        v = (self.bits + np.int64(more << 13)).view(np.float64)
        v[self.v == 0] = 0.0
        return Reals(v, self.errors)

    def check_powers(self) -> Bools | None:
        """Check the values as EXP's powers of two and set those out of range to 0 in place.

        Too large a power is recorded as OVERFLOW. Returns where a power is too small, which makes
        the result of EXP zero; None if nowhere."""
        beyond, power = np.abs(self.v) >= 128, self.whole_part().v
        overflow = (beyond & (self.v > 0)) | (power == 127)
        zero: Bools = (beyond & (self.v < 0)) | (power == -128)
        self.record_error(overflow, OVERFLOW)
        self.v[overflow | zero] = 0.0
        return zero if zero.any() else None

    def whole_part(self) -> Reals:
        """Return the largest whole number not above the value, extension cut off."""
        return Reals(np.floor((self.bits & _32_BITS).view(np.float64)), self.errors, True)

    def scale_by_power(self, powers: Reals) -> Reals:
        """Return the value times 2^powers, whole numbers, by adding to the exponent."""
        v = (self.bits + (powers.v.astype(np.int64) << 52)).view(np.float64)
        return Reals(v, self.errors)

    def pack(self) -> Packed:
        """Return the five bytes of a variable as one number: 0x8468000000 for 14.5."""
        bits = self.rounded().bits.view(np.uint64)
        e = (bits >> np.uint64(52) & np.uint64(0x7FF)) - np.uint64(BIAS)
        mantissa = bits >> np.uint64(21) & np.uint64(0x7FFFFFFF)
        sign = bits >> np.uint64(63)
        five_bytes = e << np.uint64(32) | sign << np.uint64(31) | mantissa
        return np.where(self.v == 0, np.uint64(0), five_bytes)

    def _check_exponents(self) -> Reals:
        """Set underflows to zero and record overflows, in place; return self."""
        sizes = np.abs(self.v)
        if sizes.max(initial=0.0) >= OVERFLOW_LIMIT:
            self.record_error(sizes >= OVERFLOW_LIMIT, OVERFLOW)
            self.v[sizes >= OVERFLOW_LIMIT] = 0.0
        self.v[sizes < MIN_REAL] = 0.0
        return self

    def record_error(self, failed: Any, code: int) -> bool:
        """Record an error where ``failed``, see `BlockErrors`; constants have no record."""
        return (self.errors or BlockErrors(1)).record_error(failed, code)

    def _of(self, errors: BlockErrors | None) -> Reals:
        """Return the values, constants as values of a block, so that errors they cause
        later are recorded there."""
        return self if self.errors or not errors else Reals(self.v, errors, self.stored, self.zero)


def from_floats(v: Floats, errors: BlockErrors | None, stored: bool = False) -> Reals:
    """Return reals of float64 values with at most 40 significant bits."""
    reals = Reals(v, errors, stored)._check_exponents()
    reals.zero = not v.any()
    return reals


def from_packed(packed: Packed, errors: BlockErrors | None) -> Reals:
    """Return reals of five stored bytes each, as one number (see `Reals.pack`)."""
    e = packed >> np.uint64(32)
    sign = packed >> np.uint64(31) & _ONE
    fraction = (packed & np.uint64(0x7FFFFFFF)) << np.uint64(21)
    bits = sign << np.uint64(63) | (e + np.uint64(BIAS)) << np.uint64(52) | fraction
    return from_floats(np.where(e == 0, np.uint64(0), bits).view(np.float64), errors, True)


def from_number(number: Number) -> Reals:
    """Return one real, extension included, as a constant."""
    e, m, s = number
    if not e:
        return Reals(np.zeros(1), None, True, zero=True)
    size = m * 2.0 ** (e - 168)
    return Reals(np.array([-size if s else size]), None, not m & 0xFF)


@lru_cache(maxsize=256)
def constant(n: int) -> Reals:
    """Return a whole number as a constant."""
    return from_number(integer(n))


ZERO = constant(0)


def zero(errors: BlockErrors | None) -> Reals:
    """Return zero as a value of a block, so that errors it causes are recorded there."""
    return Reals(ZERO.v, errors, True, zero=True)


def select(condition: Any, yes: Reals, no: Reals) -> Reals:
    """Return ``yes`` where the condition holds, else ``no``."""
    special = no if isinstance(no, type(yes)) else yes
    return special.choose(condition, yes, no)


def _add(left: Reals, right: Reals, subtract: bool) -> Reals:
    """Return left + right, or left + (-right).

    Both operands are scaled so that the larger one's 40-bit mantissa is a whole number, which
    truncates the smaller one. Where exponents and signs agree the ROM adds one unit of the
    extension: such a sum always has 41 bits, so the unit rounds its halving up instead of down.
    """
    left = left.rounded()
    if right.zero:
        return left._of(right.errors)
    if left.zero:
        return (-right if subtract else right)._of(left.errors)
    errors = left.errors or right.errors
    exponents = np.maximum(left.bits & _EXPONENT, right.bits & _EXPONENT)
    to_units = (_TO_UNITS - exponents).view(np.float64)
    v, addend = np.trunc(left.v * to_units), np.trunc(right.v * to_units)
    v = v - addend if subtract else v + addend
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
    return Reals(v, errors)._check_exponents()


def _multiply(left: Reals, right: Reals) -> Reals:
    """Return left * right, built like the ROM's, one byte of the right operand at a time.

    The result is the exact product truncated to 40 bits before normalising, except for a defect of
    the ROM: at a second zero byte in a row the upper 32 bits of the partial product move one bit
    too far. Bytes are numbered from the extension, 0, to the top, 4, which is never zero.
    """
    left = left.rounded()
    errors = left.errors or right.errors
    if left.zero or right.zero:
        return zero(errors)
    m1 = ((left.bits & _FRACTION | _TOP) >> 21).view(np.uint64)
    m2 = ((right.bits & _FRACTION | _TOP) >> 13).view(np.uint64)
    product = (m2 & _LAST_BYTE) * m1  # is shifted left and right by 8
    was_null = m2 & _LAST_BYTE == 0
    for position in range(1, 5):
        byte = m2 >> _BYTE_SHIFTS[position] & _LAST_BYTE
        product = (byte * m1 << _EIGHT) + product >> _EIGHT
        is_null = byte == 0
        # nothing is built yet after zeros at 0 and 1
        second_null = is_null & was_null
        if position in (2, 3) and second_null.any():
            product = product >> _EIGHT + second_null << _EIGHT | product & _LAST_BYTE
        was_null = is_null
    # the top bit of byte 4 is set, so the product has 39 or 40 bits; normalising one of 39 bits
    # appends a zero, as it is here
    v = product.astype(np.float64) * 2.0**-38
    v *= (left.bits & ~_FRACTION).view(np.float64) * (right.bits & ~_FRACTION).view(np.float64)
    result = Reals(v, errors)
    if np.abs(v).max(initial=0.0) >= OVERFLOW_LIMIT / 2:  # the ROM decides before it normalises
        exponents = ((left.bits & _EXPONENT) >> 52) + ((right.bits & _EXPONENT) >> 52)
        overflows = (exponents >= 384 + 2 * BIAS) & (v != 0)
        result.record_error(overflows, OVERFLOW)
        v[overflows] = 0.0
    return result._check_exponents()


def _divide(left: Reals, right: Reals) -> Reals:
    """Return left / right, both rounded: a quotient truncated to 34 bits, or to 33 if the
    dividend's mantissa is the smaller one.

    The processor's quotient is truncated there; where its own rounding had carried into that bit,
    the exactly computed remainder is negative and one unit is subtracted.
    """
    errors = left.errors or right.errors
    right = right.rounded()
    by_zero = right.v == 0
    if by_zero.any():
        (errors or BlockErrors(1)).record_error(by_zero, DIVISION_BY_ZERO)
        right = select(by_zero, constant(1), right)
    left = left.rounded()
    if left.zero:
        return zero(errors)
    signs = left.bits ^ right.bits
    a, b = np.abs(left.v), np.abs(right.v)
    v = a / b
    bits = v.view(np.int64)
    kept_bits = (signs ^ bits) >> 52 - 19 & _mask(19, 19) | _mask(20, 63)
    bits &= kept_bits
    upper = (bits & _UPPER_HALF).view(np.float64)
    remainder = a - upper * b
    remainder -= (v - upper) * b
    bits += remainder.view(np.int64) >> 63 << 19
    bits &= kept_bits
    bits |= signs & _SIGN

    result = Reals(v, errors)
    difference = ((left.bits & _EXPONENT) - (right.bits & _EXPONENT)) >> 52
    overflows = (difference >= 127) & (left.v != 0)  # the ROM decides before it normalises
    if overflows.any():
        result.record_error(overflows, OVERFLOW)
        v[overflows] = 0.0
    loses_sign = np.broadcast_to(
        difference == -128, v.shape
    )  # the ROM loses the sign at exponent 0
    v[loses_sign] = np.abs(v[loses_sign])
    return result._check_exponents()


def compare(stored: Reals, right: Reals) -> npt.NDArray[np.int8]:
    """Return 1 where the accumulator ``right`` is larger than ``stored``, 0 if equal, -1 if
    smaller.

    The ROM compares with the accumulator rounded, but without a carry from the last byte: FF with a
    half unit becomes 256, which equals 0 and is larger than any other byte.
    """
    stored = stored.rounded()
    v = right.v
    if right.stored:
        return ((stored.v < v).view(np.int8)) - ((stored.v > v).view(np.int8))
    last = _mask(20, 28)
    all_ones = (right.bits & last) == last
    rounded = ((right.bits + _HALF_UNIT) & _32_BITS).view(np.float64)
    order = ((stored.v < rounded).view(np.int8)) - ((stored.v > rounded).view(np.int8))
    if all_ones.any():
        upper = _mask(29, 63)
        equal_above = all_ones & (stored.bits & upper == right.bits & upper)
        order = np.where(equal_above & (stored.bits & _mask(21, 28) == 0), np.int8(0), order)
        # one unit above it in magnitude: equal to it with a carry, beyond it without
        no_carry = all_ones & (stored.v == rounded) & ~equal_above
        order = np.where(no_carry, np.where(stored.v > 0, np.int8(-1), np.int8(1)), order)
    return order


_OPERATIONS: dict[str, Callable[[Reals, Reals], Any]] = {
    "add": lambda left, right: _add(left, right, False),
    "subtract": lambda left, right: _add(left, right, True),
    "multiply": _multiply,
    "divide": _divide,
    "less": lambda left, right: compare(left, right) > 0,
    "greater": lambda left, right: compare(left, right) < 0,
}
