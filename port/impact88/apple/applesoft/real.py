"""The 40-bit real of Applesoft II, and its arithmetic rule by rule.

    value   (e, m, s):   (-1)^s * m * 2^(e - 168)
    e       exponent byte, 1 ... 255
    m       40-bit mantissa. Top 32 bits: the mantissa proper, its top bit always set;
            low 8 bits: the *extension*
    s       sign, 1 for negative
    zero    e = 0, and here always (0, 0, 0): the ROM leaves odd mantissas, which count
            for nothing

A *stored* value has five bytes and no extension; a value *in flight*, in the accumulator (FAC), has
one. In a binary operation the left operand is set aside in five bytes (ARG), so it is rounded; the
right one is still in the accumulator and keeps its extension.

The rules are functions on plain triples (`Number`), each in one place: `rounded`, `normalise`,
`add`, `multiply`, `divide`, `compare`, `floor`. `operators.Real` clothes a triple in Python's
operators.

Where the ROM differs from a machine that is merely correct, a name says so: `EQUAL_CARRY` (an extra
unit when exponents are equal), `_multiply_with_defect` (double zero byte), and the comparison's
missing carry (`compare`).
"""

from functools import lru_cache

from .errorcodes import division_by_zero, overflow

Number = tuple[int, int, int]
"""Exponent, 40-bit mantissa, sign."""

TOP = 1 << 39
"""The top bit of a 40-bit mantissa: set in every number but zero."""
LIMIT = 1 << 40
"""One past the largest mantissa."""
BIAS = 128
INTEGER_EXPONENT = 160
"""At this exponent the 32-bit mantissa is the value itself; from here on all values are whole."""
EQUAL_CARRY = 1
"""The ROM skips the alignment that would clear the carry when exponents are equal, and so adds one
unit of the extension to a sum of like signs. A correct machine would add nothing."""

ZERO: Number = (0, 0, 0)


# --- the rules --------------------------------------------------------------------------------


def rounded(x: Number) -> Number:
    """ROUND $EB72: the value as it is stored: 32 bits, by the extension's top bit alone. Raises
    OVERFLOW."""
    e, m, s = x
    extension = m & 0xFF
    if not extension:
        return x
    m -= extension
    if extension >= 0x80:
        m += 0x100
        if m == LIMIT:
            if e == 255:
                raise overflow()
            return e + 1, TOP, s
    return e, m, s


def normalise(e: int, m: int, s: int) -> Number:
    """NORMALIZE $E82E: the number with a 40-bit mantissa ``m`` whose top bits may be clear.

    Zero if the top 32 bits are all clear, whatever the extension holds; zero too, without a word,
    when the exponent runs out.
    """
    if m < 0x100:
        return ZERO
    k = 40 - m.bit_length()
    return (e - k, m << k, s) if k < e else ZERO


def negate(x: Number) -> Number:
    """-x; zero stays as it is."""
    e, m, s = x
    return (e, m, s ^ 1) if e else x


def absolute(x: Number) -> Number:
    """ABS: x without its sign; the extension stays."""
    e, m, s = x
    return (e, m, 0) if s else x


def add(left: Number, right: Number) -> Number:
    """FADDT $E7C1: left + right, the left operand rounded, the right one with its extension. Raises
    OVERFLOW.

    The operand with the smaller exponent is shifted right; what falls below 40 bits is lost.
    """
    e1, m1, s1 = left
    if m1 & 0xFF:
        left = e1, m1, s1 = rounded(left)
    e2, m2, s2 = right
    if not e2:
        return left
    if not e1:
        return right
    shift = e1 - e2
    if s1 == s2:
        if shift > 0:
            m1 += m2 >> shift
        elif shift:
            m1 = (m1 >> -shift) + m2
            e1 = e2
        else:
            m1 += m2 + EQUAL_CARRY
        if m1 >= LIMIT:
            if e1 == 255:
                raise overflow()
            return e1 + 1, m1 >> 1, s1
        return e1, m1, s1
    if shift > 0:
        m1 -= m2 >> shift
    else:
        m1 = m2 - (m1 >> -shift)
        e1 = e2
        s1 = s2
        if m1 < 0:  # only with equal exponents
            m1 = -m1
            s1 ^= 1
    return (e1, m1, s1) if m1 >= TOP else normalise(e1, m1, s1)


def subtract(left: Number, right: Number) -> Number:
    """left - right, which is left + (-right)."""
    e, m, s = right
    return add(left, (e, m, s ^ 1)) if e else rounded(left)


def multiply(left: Number, right: Number) -> Number:
    """FMULTT $E982: left * right, the left operand rounded, the right one with its extension.
    Raises OVERFLOW."""
    e1, m1, s1 = left
    e2, m2, s2 = right
    if not e1 or not e2:
        return ZERO
    if m1 & 0xFF:
        e1, m1, s1 = rounded(left)
    e = product_exponent(e1, e2)
    if not e:
        return ZERO
    # both kinds of double zero byte have a zero in the mantissa's third byte
    m = m1 * m2 >> 40 if m2 & 0xFF0000 or not m2 & 0xFFFF else _multiply_with_defect(m1, m2)
    if m >= TOP:
        return e, m, s1 ^ s2
    # the product of two normalised mantissas is short by one bit at most
    return (e - 1, m << 1, s1 ^ s2) if e > 1 else ZERO


def product_exponent(e1: int, e2: int) -> int:
    """The exponent of a product before normalising; 0 for an underflow. Raises OVERFLOW."""
    total = e1 + e2
    if total < BIAS:
        return 0
    if total >= BIAS + 256:
        raise overflow()
    return total - BIAS


def _multiply_with_defect(m1: int, m2: int) -> int:
    """The upper 40 bits of m1 * m2 as the ROM builds them, a byte of the right operand at a time.

    The ROM takes a short way past a zero byte, and after a second zero byte in a row enters it with
    the carry wrong: the upper 32 bits of what has been built move one bit too far. A correct
    machine's result is ``m1 * m2 >> 40``.
    """
    built = 0
    previous = 1
    for position in range(5):
        byte = m2 >> 8 * position & 0xFF
        built = built + byte * m1 >> 8
        if not byte and not previous:
            built = built >> 9 << 8 | built & 0xFF
        previous = byte
    return built


def divide(left: Number, right: Number) -> Number:
    """FDIVT $EA69: left / right, both rounded. Raises DIVISION BY ZERO (for 0 / 0 too) and
    OVERFLOW."""
    e2, m2, s2 = rounded(right)
    if not e2:
        raise division_by_zero()
    e1, m1, s1 = rounded(left)
    if not e1:
        return ZERO
    total = e1 + (-e2 & 0xFF)
    if total < BIAS:
        return ZERO
    e = total - BIAS + 1
    if e > 255:
        raise overflow()
    # an exponent of 0 before that 1 is added does not make a zero here, it loses the sign
    digits = (m1 << 33) // m2 if m2 >> 39 else quotient_by_loop(m1 >> 8, m2 >> 8)
    return normalise(e, digits << 6, s1 ^ s2 if e > 1 else 0)


def quotient_by_loop(dividend: int, divisor: int) -> int:
    """Return the quotient of the ROM's loop of shifts and subtractions, 34 bits.

    By a string's descriptor, whose top bit may be clear, it gives no quotient; what is left is
    compared only where its own top bit is set.
    """
    digits, larger = 0, dividend >= divisor
    for _ in range(34):
        digits = digits << 1 | larger
        if larger:
            dividend = dividend - divisor & 0xFFFFFFFF
        dividend <<= 1
        larger = bool(dividend >> 32) or (dividend >> 31 == 1 and dividend >= divisor)
        dividend &= 0xFFFFFFFF
    return digits


def compare(stored: Number, right: Number) -> int:
    """FCOMP $EBB2: 1 if the accumulator ``right`` is larger than ``stored``, 0 if equal, -1 if
    smaller.

    Sign, then exponent, then the upper three mantissa bytes; only when all agree, the last byte
    against the accumulator's last byte plus the top bit of its extension. That addition carries
    nowhere: 256 counts as equal to 0, and as larger than anything else.
    """
    e1, m1, s1 = stored
    e2, m2, s2 = right
    if not e1:
        return (-1 if s2 else 1) if e2 else 0
    if s1 != s2 or not e2:
        return 1 if s1 else -1
    if e1 != e2:
        larger = e2 > e1
    elif m1 >> 16 != m2 >> 16:
        larger = m2 > m1
    else:
        last1 = m1 >> 8 & 0xFF
        last2 = (m2 >> 8 & 0xFF) + (m2 >> 7 & 1)
        if last1 == last2 & 0xFF:
            return 0
        larger = last2 > last1
    return 1 if larger != bool(s2) else -1


def to_integer(x: Number) -> int:
    """QINT $EBF2: the floor of ``x``, extension counted, as a Python integer."""
    e, m, s = x
    if s:
        m = -m
    return m >> BIAS + 40 - e if e < BIAS + 40 else m << e - BIAS - 40


def floor(x: Number) -> Number:
    """INT $EC23: the largest whole number not above ``x``, its extension counted; extension 0.

    A number of 32 bits or more before the point stays as it is, extension and all.
    """
    return x if x[0] >= INTEGER_EXPONENT else integer(to_integer(x))


# --- whole numbers and stored bytes -----------------------------------------------------------


@lru_cache(maxsize=512)  # mostly digits, subscripts and the constants of formulas
def integer(n: int) -> Number:
    """A whole number of at most 32 bits, exact."""
    size = abs(n)
    length = size.bit_length()
    return (BIAS + length, size << 40 - length, int(n < 0)) if n else ZERO


def from_stored(stored: bytes | str, extension: int = 0) -> Number:
    """The value of five stored bytes (or ten hexadecimal digits), with an extension byte."""
    data = bytes.fromhex(stored) if isinstance(stored, str) else stored
    e = data[0]
    if e == 0:
        return ZERO
    mantissa = int.from_bytes(data[1:], "big")
    return e, (mantissa | 0x80000000) << 8 | extension, mantissa >> 31


def to_stored(x: Number) -> bytes:
    """The five bytes a variable gets when ``x`` is assigned to it: rounded, with the sign in the
    mantissa's top bit. Raises OVERFLOW."""
    e, m, s = rounded(x)
    return bytes((e,)) + (m >> 8 & 0x7FFFFFFF | s << 31).to_bytes(4, "big")
