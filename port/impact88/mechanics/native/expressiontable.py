"""Expressions over columns: formulas written once, pruned to what is asked and to what is given.

A formula is written with `Expression` operands and the usual operators, which record what would be
computed, and leave out on the spot what need not be:

- equal subexpressions become one (same operation on the same operands);
- an operand known to be exactly 0, 1 or infinite disappears: x + 0, x · 1, 0 · x, sin 0, 1/inf;
- signs go into sums: a + (-b) · c becomes a - b · c.

None of these changes a bit of a result (but the sign of a zero, which RESULT clears): a scene gets
the same digits alone, in a column, and on every path.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


def _operator(name: str, reflected: bool = False) -> Callable[[Expression, Any], Expression]:
    """The method of an operator; ``reflected``: with the operands the other way round."""

    def method(self: Expression, other: Expression | float) -> Expression:
        a, b = self, other if isinstance(other, Expression) else self.table.constant(other)
        if reflected:
            a, b = b, a
        rule = getattr(self.table, name, None)
        result: Expression = rule(a, b) if rule else self.table.combine(name, a, b)
        return result

    return method


@dataclass(slots=True, eq=False)
class Expression:
    """One value per scene: an operation on other expressions, a column, or a constant.

    ``varies`` is False when the value is the same for every scene of a block.
    """

    table: ExpressionTable
    operation: str
    operands: tuple[Expression, ...]
    varies: bool
    value: float | str | None

    def is_constant(self, number: float) -> bool:
        """Return True for the constant ``number``."""
        return self.operation == "constant" and self.value == number

    @property
    def is_zero(self) -> bool:
        return self.operation == "constant" and self.value == 0.0

    __add__ = _operator("add")
    __radd__ = _operator("add", reflected=True)
    __sub__ = _operator("subtract")
    __rsub__ = _operator("subtract", reflected=True)
    __mul__ = _operator("multiply")
    __rmul__ = _operator("multiply", reflected=True)
    __truediv__ = _operator("divide")
    __rtruediv__ = _operator("divide", reflected=True)
    # conditions; there is no == (expressions are kept apart by what they are)
    __lt__ = _operator("less")
    __gt__ = _operator("less", reflected=True)
    __le__ = _operator("less_or_equal")
    __ge__ = _operator("less_or_equal", reflected=True)
    __and__ = _operator("both")
    __or__ = _operator("either")

    def __neg__(self) -> Expression:
        return self.table.negative(self)

    def __abs__(self) -> Expression:
        return self.table.absolute(self)

    def __invert__(self) -> Expression:
        return self.table.combine("not", self)

    def any(self) -> bool:
        """Return True: a condition may hold in some scene."""
        return True


class ExpressionTable:
    """The expressions of one program, each stored once."""

    def __init__(self) -> None:
        self._kept: dict[tuple[object, ...], Expression] = {}

    def combine(
        self,
        operation: str,
        *operands: Expression,
        value: float | str | None = None,
        varies: bool | None = None,
    ) -> Expression:
        """Return the expression of an operation; a condition is 1 where it holds, else 0."""
        key = (operation, value, operands)
        if (kept := self._kept.get(key)) is not None:
            return kept
        if varies is None:
            varies = any(operand.varies for operand in operands)
        self._kept[key] = expression = Expression(self, operation, operands, varies, value)
        return expression

    def constant(self, number: float) -> Expression:
        return self.combine("constant", value=float(number), varies=False)

    def column(self, name: str, varies: bool) -> Expression:
        return self.combine("column", value=name, varies=varies)

    # -- arithmetic; every rule of pruning is here

    def add(self, a: Expression, b: Expression) -> Expression:
        if a.is_zero:
            return b
        if b.is_zero:
            return a
        if b.operation == "negative":
            return self.subtract(a, b.operands[0])
        if a.operation == "negative":
            return self.subtract(b, a.operands[0])
        return self._fold("add", a, b, lambda x, y: x + y)

    def subtract(self, a: Expression, b: Expression) -> Expression:
        if b.is_zero:
            return a
        if a.is_zero:
            return self.negative(b)
        if b.operation == "negative":
            return self.add(a, b.operands[0])
        return self._fold("subtract", a, b, lambda x, y: x - y)

    def multiply(self, a: Expression, b: Expression) -> Expression:
        if a.is_zero or b.is_zero:
            return self.constant(0.0)
        for factor, cofactor in ((a, b), (b, a)):
            if factor.is_constant(1.0):
                return cofactor
            if factor.is_constant(-1.0):
                return self.negative(cofactor)
        # signs move outwards, where a sum or another sign absorbs them
        if a.operation == "negative":
            return self.negative(self.multiply(a.operands[0], b))
        if b.operation == "negative":
            return self.negative(self.multiply(a, b.operands[0]))
        return self._fold("multiply", a, b, lambda x, y: x * y)

    def divide(self, a: Expression, b: Expression) -> Expression:
        if b.is_constant(1.0):
            return a
        if b.is_constant(math.inf):
            return self.constant(0.0)
        # 0 / b stays: b may be 0, and the quotient then is NaN
        return self.combine("divide", a, b)

    def negative(self, a: Expression) -> Expression:
        if isinstance(a.value, float):
            return self.constant(-a.value)
        if a.operation == "negative":
            return a.operands[0]
        return self.combine("negative", a)

    def _fold(
        self, operation: str, a: Expression, b: Expression, rule: Callable[[float, float], float]
    ) -> Expression:
        if isinstance(a.value, float) and isinstance(b.value, float):
            return self.constant(rule(a.value, b.value))
        return self.combine(operation, a, b)

    def absolute(self, a: Expression) -> Expression:
        return a if a.is_zero else self.combine("absolute", a)

    def root(self, a: Expression) -> Expression:
        """The square root."""
        return a if a.is_zero else self.combine("sqrt", a)

    def sine_and_cosine(self, degrees: Expression) -> tuple[Expression, Expression]:
        """Sine and cosine of an angle in degrees; sin(-x) is taken as -sin x."""
        if degrees.is_zero:
            return self.constant(0.0), self.constant(1.0)
        if degrees.operation == "negative":
            sine, cosine = self.sine_and_cosine(degrees.operands[0])
            return self.negative(sine), cosine
        pair = self.combine("sine_and_cosine", degrees)
        return self.combine("sine", pair), self.combine("cosine", pair)

    def against(self, value: Expression, slip: Expression) -> Expression:
        """Record the rule of listing line 400: whoever computes changes the sign of ``value`` where
        ``slip`` > 0."""
        if value.is_zero or slip.is_zero:
            return value
        return self.combine("against", value, slip)

    def choose(self, where: Expression, a: Expression, b: Expression) -> Expression:
        """``a`` where the condition holds, else ``b``."""
        return a if a is b else self.combine("choose", where, a, b)

    def minimum(self, a: Expression, number: float) -> Expression:
        """``a``, or ``number`` where that is less."""
        return self.combine("minimum", a, self.constant(number))

    def equals(self, a: Expression, number: float) -> Expression:
        return self.combine("equal", a, self.constant(number))
