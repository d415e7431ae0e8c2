"""Python's operators on Applesoft's reals: an expression computes what Applesoft's would.

A binary operator rounds its left operand, which was set aside, and keeps the extension of the right
one, still in the accumulator. Storing in a variable is explicit: `Real.rounded`."""

from __future__ import annotations

import operator
from collections.abc import Callable

from . import real
from .functions import power
from .real import BIAS, Number, compare, from_stored, integer, rounded, to_stored


def _binary(rule: Callable[[Number, Number], Number]) -> tuple[Callable[..., Real], ...]:
    """An operator, and what it is with a whole number on the left."""

    def forward(left: Real, right: Real | int) -> Real:
        return Real(rule(left.number, right.number if right.__class__ is Real else _number(right)))

    def reflected(right: Real, left: int) -> Real:
        return Real(rule(_number(left), right.number))

    return forward, reflected


def _comparison(holds: Callable[[int, int], bool]) -> Callable[[Real, object], bool]:
    def compared(left: Real, right: object) -> bool:
        if right.__class__ is not Real:
            raise TypeError(f"a real compares with reals only, not with {right!r}")
        stored = left.number
        return holds(0, compare(rounded(stored) if stored[1] & 0xFF else stored, right.number))

    return compared


class Real:
    """A number in Python's operators. Integers are taken for constants; floats are refused, because
    they would smuggle in digits not typed. ``==`` and its kin are the ROM's comparison, so reals
    are not hashable and compare with reals only. Raises ApplesoftError."""

    __slots__ = ("number",)

    def __init__(self, number: Number) -> None:
        self.number = number

    @classmethod
    def from_stored(cls, stored: bytes | str) -> Real:
        """See `from_stored`."""
        return cls(from_stored(stored))

    def stored(self) -> bytes:
        """See `to_stored`."""
        return to_stored(self.number)

    def rounded(self) -> Real:
        """The value as it is stored; see `rounded`."""
        number = self.number
        return Real(rounded(number)) if number[1] & 0xFF else self

    @property
    def extension(self) -> int:
        """The eight bits below the mantissa that storing would round away."""
        return self.number[1] & 0xFF

    def __float__(self) -> float:
        """The exact value: 40 bits and this exponent range fit a double."""
        e, m, s = self.number
        size = float(m) * 2.0 ** (e - BIAS - 40)
        return -size if s else size

    def __repr__(self) -> str:
        return f"Real({float(self)!r}, {self.stored().hex()}:{self.extension:02x})"

    def __neg__(self) -> Real:
        return Real(real.negate(self.number))

    __add__, __radd__ = _binary(real.add)
    __sub__, __rsub__ = _binary(real.subtract)
    __mul__, __rmul__ = _binary(real.multiply)
    __truediv__, __rtruediv__ = _binary(real.divide)
    __pow__ = _binary(power)[0]
    __lt__, __gt__ = _comparison(operator.lt), _comparison(operator.gt)
    __le__, __ge__ = _comparison(operator.le), _comparison(operator.ge)
    __eq__, __ne__ = _comparison(operator.eq), _comparison(operator.ne)
    __hash__ = None  # type: ignore[assignment]


def _number(operand: Real | int) -> Number:
    if operand.__class__ is int:
        return integer(operand)
    if isinstance(operand, Real):
        return operand.number
    raise TypeError(f"an Applesoft real takes whole numbers and reals, not {operand!r}")
