"""Python's operators on Applesoft's reals: an expression computes what Applesoft's would.

A binary operator rounds its left operand and keeps the right one's extension, because that is what
happens to a value set aside and to one still in the accumulator (`real`). Storing in a variable is
explicit: `Real.rounded`.
"""

from __future__ import annotations

from .functions import power
from .real import (
    BIAS,
    Number,
    absolute,
    add,
    compare,
    divide,
    from_stored,
    integer,
    multiply,
    negate,
    rounded,
    subtract,
    to_stored,
)

TYPE_CHECKING = False
if TYPE_CHECKING:
    from fractions import Fraction


class Real:
    """A number in the operators of Python: left operands round, right ones keep their extension.

    Python integers are taken for constants; floats are refused, because they would smuggle in
    digits not typed. ``==`` and its kin are the ROM's comparison, so reals are not hashable and
    compare with reals only. Raises ApplesoftError: OVERFLOW, DIVISION BY ZERO, and what
    `functions.power` raises.
    """

    __slots__ = ("number",)

    def __init__(self, number: Number) -> None:
        self.number = number

    @classmethod
    def from_stored(cls, stored: bytes | str, extension: int = 0) -> Real:
        """See `from_stored`."""
        return cls(from_stored(stored, extension))

    def stored(self) -> bytes:
        """See `to_stored`."""
        return to_stored(self.number)

    def rounded(self) -> Real:
        """The value as it is stored; see `rounded`."""
        number = self.number
        return Real(rounded(number)) if number[1] & 0xFF else self

    @property
    def e(self) -> int:
        """The exponent byte."""
        return self.number[0]

    @property
    def m(self) -> int:
        """The 40-bit mantissa, extension included."""
        return self.number[1]

    @property
    def s(self) -> int:
        """The sign: 1 for negative."""
        return self.number[2]

    @property
    def extension(self) -> int:
        """The eight bits below the mantissa that storing would round away."""
        return self.number[1] & 0xFF

    def fraction(self) -> Fraction:
        """The exact value, extension included."""
        from fractions import Fraction

        e, m, s = self.number
        scale = e - BIAS - 40
        size = Fraction(m << scale) if scale >= 0 else Fraction(m, 1 << -scale)
        return -size if s else size

    def __float__(self) -> float:
        """The exact value: 40 bits and this exponent range fit a double."""
        e, m, s = self.number
        size = float(m) * 2.0 ** (e - BIAS - 40)
        return -size if s else size

    def __repr__(self) -> str:
        return f"Real({float(self)!r}, {self.stored().hex()}:{self.extension:02x})"

    def __neg__(self) -> Real:
        return Real(negate(self.number))

    def __pos__(self) -> Real:
        return self

    def __abs__(self) -> Real:
        return Real(absolute(self.number))

    def __add__(self, right: Real | int) -> Real:
        return Real(add(self.number, right.number if right.__class__ is Real else _number(right)))

    def __sub__(self, right: Real | int) -> Real:
        return Real(
            subtract(self.number, right.number if right.__class__ is Real else _number(right))
        )

    def __mul__(self, right: Real | int) -> Real:
        return Real(
            multiply(self.number, right.number if right.__class__ is Real else _number(right))
        )

    def __truediv__(self, right: Real | int) -> Real:
        return Real(
            divide(self.number, right.number if right.__class__ is Real else _number(right))
        )

    def __pow__(self, right: Real | int) -> Real:
        return Real(power(self.number, _number(right)))

    def __radd__(self, left: int) -> Real:
        return Real(add(_number(left), self.number))

    def __rsub__(self, left: int) -> Real:
        return Real(subtract(_number(left), self.number))

    def __rmul__(self, left: int) -> Real:
        return Real(multiply(_number(left), self.number))

    def __rtruediv__(self, left: int) -> Real:
        return Real(divide(_number(left), self.number))

    def __rpow__(self, left: int) -> Real:
        return Real(_number(left)) ** self

    __hash__ = None  # type: ignore[assignment]

    def __lt__(self, right: Real) -> bool:
        return _compare(self, right) > 0

    def __gt__(self, right: Real) -> bool:
        return _compare(self, right) < 0

    def __le__(self, right: Real) -> bool:
        return _compare(self, right) >= 0

    def __ge__(self, right: Real) -> bool:
        return _compare(self, right) <= 0

    def __eq__(self, right: object) -> bool:
        return _compare(self, right) == 0

    def __ne__(self, right: object) -> bool:
        return _compare(self, right) != 0

    def __bool__(self) -> bool:
        """Whether an IF on this value succeeds: anything but zero."""
        return self.number[0] != 0


def _number(operand: Real | int) -> Number:
    if operand.__class__ is int:
        return integer(operand)
    if isinstance(operand, Real):
        return operand.number
    raise TypeError(f"an Applesoft real takes whole numbers and reals, not {operand!r}")


def _compare(left: Real, right: object) -> int:
    if right.__class__ is not Real:
        raise TypeError(f"a real compares with reals only, not with {right!r}")
    stored = left.number
    if stored[1] & 0xFF:
        stored = rounded(stored)
    return compare(stored, right.number)
