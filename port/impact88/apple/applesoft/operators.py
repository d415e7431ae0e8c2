"""Python's operators on Applesoft's reals: an expression has the same result as in Applesoft.

A binary operator rounds its left operand, which the ROM stores, and keeps the extension of the
right one, which is in the accumulator. Assignment to a variable is explicit: `Real.rounded`."""

from __future__ import annotations

import operator
from collections.abc import Callable

from .functions import power
from .real import (
    BIAS,
    Number,
    add,
    compare,
    divide,
    integer,
    multiply,
    negate,
    rounded,
    subtract,
    to_stored,
)


def _binary(rule: Callable[[Number, Number], Number]) -> tuple[Callable[..., Real], ...]:
    """Return the methods of an operator, normal and reflected (a whole number on the left)."""

    def forward(left: Real, right: Real | int) -> Real:
        return Real(rule(left.number, right.number if right.__class__ is Real else _number(right)))

    def reverse(right: Real, left: int) -> Real:
        return Real(rule(_number(left), right.number))

    return forward, reverse


def _comparison(holds: Callable[[int, int], bool]) -> Callable[[Real, object], bool]:
    """Return the method of a comparison."""

    def method(left: Real, right: object) -> bool:
        if right.__class__ is not Real:
            raise TypeError(f"a real compares with reals only, not with {right!r}")
        number = left.number
        return holds(0, compare(rounded(number) if number[1] & 0xFF else number, right.number))

    return method


class Real:
    """A number for Python's operators.

    Integers are constants; floats are refused, because they would add digits that were not typed.
    Comparisons are the ROM's, so reals are not hashable and compare with reals only. Raises
    ApplesoftError."""

    __slots__ = ("number",)

    def __init__(self, number: Number) -> None:
        self.number = number

    def to_bytes(self) -> bytes:
        """Return the five bytes that a variable stores, see `real.to_stored`."""
        return to_stored(self.number)

    def rounded(self) -> Real:
        """Return the value as a variable stores it, see `real.rounded`."""
        number = self.number
        return Real(rounded(number)) if number[1] & 0xFF else self

    def __float__(self) -> float:
        """Return the exact value: 40 bits and this exponent range fit a double."""
        e, m, s = self.number
        size = float(m) * 2.0 ** (e - BIAS - 40)
        return -size if s else size

    def __repr__(self) -> str:
        return f"Real({float(self)!r}, {self.to_bytes().hex()}:{self.number[1] & 0xFF:02x})"

    def __neg__(self) -> Real:
        return Real(negate(self.number))

    __add__, __radd__ = _binary(add)
    __sub__, __rsub__ = _binary(subtract)
    __mul__, __rmul__ = _binary(multiply)
    __truediv__, __rtruediv__ = _binary(divide)
    __pow__ = _binary(lambda left, right: power(left, right)[0])[0]
    __lt__, __gt__ = _comparison(operator.lt), _comparison(operator.gt)
    __le__, __ge__ = _comparison(operator.le), _comparison(operator.ge)
    __eq__, __ne__ = _comparison(operator.eq), _comparison(operator.ne)


def _number(operand: object) -> Number:
    """Return a whole number's number. Raises TypeError for any other object."""
    if operand.__class__ is int:
        return integer(operand)
    raise TypeError(f"an Applesoft real takes whole numbers and reals, not {operand!r}")
