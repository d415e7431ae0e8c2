"""The 40-bit real of Applesoft II, and its arithmetic rule by rule.

    value   exponent byte e, 40-bit mantissa m, sign s:   (-1)^s * m * 2^(e - 168)
    m       top 32 bits: the mantissa, its top bit always set; low 8 bits: the *extension*
    zero    e = 0, and here always the one object ZERO (the ROM leaves odd mantissas behind)

A *stored* value has five bytes and no extension; a value *in flight*, in the accumulator (FAC), has
one. In a binary operation the left operand is set aside in five bytes (ARG), so it is rounded; the
right one is still in the accumulator and keeps its extension. The operators of `Real` do just that,
so a Python expression computes what the same Applesoft expression does. Storing is explicit:
`Real.rounded`.

Each rule stands once: rounding in `Real.rounded`, normalising in `normalise`, comparing in
`compare`. Where the ROM differs from a machine that is merely correct, a name says so: `EQUAL_CARRY`
(an extra unit when exponents are equal), `_multiply_with_defect` (double zero byte), and the
comparison's missing carry.
"""

from __future__ import annotations

from fractions import Fraction

from .errors import division_by_zero, overflow

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


class Real:
    """A number as the accumulator holds it: exponent ``e``, 40-bit mantissa ``m``, sign ``s``.

    Operators round the left operand and keep the right one's extension. Python integers are taken
    for constants; floats are refused, because they would smuggle in digits nobody typed. ``==`` and
    its kin are the ROM's comparison, so reals are not hashable and take only reals.
    Raises ApplesoftError: OVERFLOW past 255 in the exponent, DIVISION BY ZERO.
    """

    __slots__ = ("e", "m", "s")

    def __init__(self, e: int, m: int, s: int) -> None:
        self.e = e
        self.m = m
        self.s = s

    # --- taking apart and putting together -------------------------------------------------------

    @staticmethod
    def from_stored(stored: bytes | str, extension: int = 0) -> Real:
        """The value of five stored bytes (or ten hexadecimal digits), with an extension byte."""
        data = bytes.fromhex(stored) if isinstance(stored, str) else stored
        if len(data) != 5:
            raise ValueError(f"a stored real has five bytes, not {len(data)}")
        e = data[0]
        if e == 0:
            return ZERO
        mantissa = int.from_bytes(data[1:], "big")
        return Real(e, (mantissa | 0x80000000) << 8 | extension, mantissa >> 31)

    def stored(self) -> bytes:
        """The five bytes a variable gets when this value is assigned to it: rounded, with the sign
        in the mantissa's top bit."""
        r = self.rounded()
        mantissa = r.m >> 8 & 0x7FFFFFFF | r.s << 31
        return bytes((r.e,)) + mantissa.to_bytes(4, "big")

    @property
    def extension(self) -> int:
        """The eight bits below the mantissa that storing would round away."""
        return self.m & 0xFF

    def rounded(self) -> Real:
        """The value as it is stored: 32 bits, by the extension's top bit alone."""
        m = self.m
        extension = m & 0xFF
        if not extension:
            return self
        e = self.e
        m -= extension
        if extension >= 0x80:
            m += 0x100
            if m == LIMIT:
                m = TOP
                e += 1
                if e > 255:
                    raise overflow()
        return Real(e, m, self.s)

    def fraction(self) -> Fraction:
        """The exact value, extension included."""
        scale = self.e - BIAS - 40
        size = Fraction(self.m << scale) if scale >= 0 else Fraction(self.m, 1 << -scale)
        return -size if self.s else size

    def __float__(self) -> float:
        """The exact value: 40 bits and this exponent range fit a double."""
        size = float(self.m) * 2.0 ** (self.e - BIAS - 40)
        return -size if self.s else size

    def __repr__(self) -> str:
        return f"Real({float(self)!r}, {self.stored().hex()}:{self.extension:02x})"

    # --- operators: left rounds, right keeps its extension -----------------------------------------

    def __neg__(self) -> Real:
        return Real(self.e, self.m, self.s ^ 1) if self.e else self

    def __pos__(self) -> Real:
        return self

    def __abs__(self) -> Real:
        return Real(self.e, self.m, 0) if self.s else self

    def __add__(self, right: Real | int) -> Real:
        if right.__class__ is int:
            right = integer(right)  # type: ignore[arg-type]
        elif not isinstance(right, Real):
            return NotImplemented
        return _add(self, right, right.s)  # type: ignore[union-attr]

    def __sub__(self, right: Real | int) -> Real:
        if right.__class__ is int:
            right = integer(right)  # type: ignore[arg-type]
        elif not isinstance(right, Real):
            return NotImplemented
        return _add(self, right, right.s ^ 1)  # type: ignore[union-attr,arg-type]

    def __mul__(self, right: Real | int) -> Real:
        if right.__class__ is int:
            right = integer(right)  # type: ignore[arg-type]
        elif not isinstance(right, Real):
            return NotImplemented
        e = self.e
        e2 = right.e  # type: ignore[union-attr]
        if not e or not e2:
            return ZERO
        m = self.m
        if m & 0xFF:
            left = self.rounded()
            m = left.m
            e = left.e
        e = product_exponent(e, e2)
        if not e:
            return ZERO
        m2 = right.m  # type: ignore[union-attr]
        # both kinds of double zero byte have a zero in the mantissa's third byte
        if m2 & 0xFF0000 or not m2 & 0xFFFF:
            m = m * m2 >> 40
        else:
            m = _multiply_with_defect(m, m2)
        if m < TOP:  # the product of two normalised mantissas is short by one bit at most
            if e == 1:
                return ZERO
            return Real(e - 1, m << 1, self.s ^ right.s)  # type: ignore[union-attr]
        return Real(e, m, self.s ^ right.s)  # type: ignore[union-attr]

    def __truediv__(self, right: Real | int) -> Real:
        if right.__class__ is int:
            right = integer(right)  # type: ignore[arg-type]
        elif not isinstance(right, Real):
            return NotImplemented
        right = right.rounded()  # type: ignore[union-attr]
        if not right.e:
            raise division_by_zero()
        left = self.rounded()
        if not left.e:
            return ZERO
        total = left.e + (-right.e & 0xFF)
        if total < BIAS:
            return ZERO
        if total >= BIAS + 256:
            raise overflow()
        e = total - BIAS
        s = left.s ^ right.s if e else 0  # exponent 0 does not make a zero here, it loses the sign
        e += 1
        if e > 255:
            raise overflow()
        return normalise(e, (left.m << 33) // right.m << 6, s)

    def __pow__(self, right: Real | int) -> Real:
        from .functions import power

        if right.__class__ is int:
            right = integer(right)  # type: ignore[arg-type]
        elif not isinstance(right, Real):
            return NotImplemented
        return power(self, right)  # type: ignore[arg-type]

    def __radd__(self, left: int) -> Real:
        return integer(left) + self

    def __rsub__(self, left: int) -> Real:
        return integer(left) - self

    def __rmul__(self, left: int) -> Real:
        return integer(left) * self

    def __rtruediv__(self, left: int) -> Real:
        return integer(left) / self

    def __rpow__(self, left: int) -> Real:
        return integer(left) ** self

    __hash__ = None  # type: ignore[assignment]

    def __lt__(self, right: Real) -> bool:
        return compare(self.rounded(), right) > 0

    def __gt__(self, right: Real) -> bool:
        return compare(self.rounded(), right) < 0

    def __le__(self, right: Real) -> bool:
        return compare(self.rounded(), right) >= 0

    def __ge__(self, right: Real) -> bool:
        return compare(self.rounded(), right) <= 0

    def __eq__(self, right: object) -> bool:
        if not isinstance(right, Real):
            raise TypeError(f"a real compares with reals only, not with {right!r}")
        return compare(self.rounded(), right) == 0

    def __ne__(self, right: object) -> bool:
        return not self == right

    def __bool__(self) -> bool:
        """Whether an IF on this value succeeds: anything but zero."""
        return self.e != 0


ZERO = Real(0, 0, 0)


def normalise(e: int, m: int, s: int) -> Real:
    """The real with a 40-bit mantissa ``m`` whose top bits may be clear.

    Zero if the top 32 bits are all clear, whatever the extension holds; zero too, without a word,
    when the exponent runs out.
    """
    if m < 0x100:
        return ZERO
    k = 40 - m.bit_length()
    return Real(e - k, m << k, s) if k < e else ZERO


def product_exponent(e1: int, e2: int) -> int:
    """The exponent of a product before normalising; 0 for an underflow. Raises OVERFLOW."""
    total = e1 + e2
    if total < BIAS:
        return 0
    if total >= BIAS + 256:
        raise overflow()
    return total - BIAS


def _add(left: Real, right: Real, s2: int) -> Real:
    """left + right, with ``s2`` for the right operand's sign (a subtraction flips it)."""
    m1 = left.m
    if m1 & 0xFF:
        left = left.rounded()
        m1 = left.m
    e1 = left.e
    e2 = right.e
    if not e2:
        return left
    m2 = right.m
    if not e1:
        return Real(e2, m2, s2)
    s1 = left.s
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
            m1 >>= 1
            e1 += 1
            if e1 > 255:
                raise overflow()
        return Real(e1, m1, s1)
    if shift > 0:
        m1 -= m2 >> shift
    else:
        m1 = m2 - (m1 >> -shift)
        e1 = e2
        s1 = s2
        if m1 < 0:  # only with equal exponents
            m1 = -m1
            s1 ^= 1
    if m1 >= TOP:
        return Real(e1, m1, s1)
    return normalise(e1, m1, s1)


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


def compare(stored: Real, right: Real) -> int:
    """1 if the accumulator ``right`` is larger than ``stored``, 0 if equal, -1 if smaller.

    Sign, then exponent, then the upper three mantissa bytes; only when all agree, the last byte
    against the accumulator's last byte plus the top bit of its extension. That addition carries
    nowhere: 256 counts as equal to 0, and as larger than anything else.
    """
    e1 = stored.e
    e2 = right.e
    s2 = right.s
    if not e1:
        return (-1 if s2 else 1) if e2 else 0
    if stored.s != s2 or not e2:
        return 1 if stored.s else -1
    if e1 != e2:
        larger = e2 > e1
    else:
        high1 = stored.m >> 16
        high2 = right.m >> 16
        if high1 != high2:
            larger = high2 > high1
        else:
            last1 = stored.m >> 8 & 0xFF
            last2 = (right.m >> 8 & 0xFF) + (right.m >> 7 & 1)
            if last1 == last2 & 0xFF:
                return 0
            larger = last2 > last1
    return 1 if larger != bool(s2) else -1


def floor(x: Real) -> Real:
    """INT: the largest whole number not above ``x``, its extension counted; extension 0.

    A number of 32 bits or more before the point stays as it is, extension and all.
    """
    return x if x.e >= INTEGER_EXPONENT else integer(to_integer(x))


def to_integer(x: Real) -> int:
    """The floor of ``x``, extension counted, as a Python integer."""
    shift = BIAS + 40 - x.e
    if shift <= 0:
        n = x.m << -shift
        return -n if x.s else n
    return -x.m >> shift if x.s else x.m >> shift


def _from_integer(n: int) -> Real:
    size = abs(n)
    length = size.bit_length()
    if length > 32:
        raise ValueError(f"{n} has more than 32 bits; write it as decimal text")
    return Real(BIAS + length, size << 40 - length, int(n < 0)) if n else ZERO


_SMALL = {n: _from_integer(n) for n in range(-16, 129)}


def integer(n: int) -> Real:
    """A whole number of at most 32 bits, exact. Raises ValueError for a larger one and TypeError
    for what is no int."""
    known = _SMALL.get(n)
    if known is not None and n.__class__ is int:
        return known
    if n.__class__ is not int:
        raise TypeError(f"an Applesoft real takes whole numbers and reals, not {n!r}")
    return _from_integer(n)
