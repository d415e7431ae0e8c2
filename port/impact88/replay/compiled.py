"""The replay's statements as a program for the compiled machine.

`statements.run` is run once with values that only note what is done with them; the machine then
does it to any number of scenes. Scenes out of the ordinary (an error, a value beyond 2^100 or below
2^-100, a comparison without its carry) are marked and left to the arrays.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from ..names import SCENE
from ..native.formulas import Expression, ExpressionTable
from ..native.program import Program, addresses
from . import statements
from .reals import ZERO, Floats, Reals, constant
from .unit import Bools, Unit

LARGE = 2.0**100
"""Beyond this, or below its inverse, a scene is marked: no ordinary one comes near, and what is
computed of ordinary ones cannot overflow before it is marked in turn."""
NAMES = tuple(name for name in SCENE if name != "M")
ODD = "ODD"
"""The result that marks a scene: 1, else 0."""


def _noting(name: str) -> Callable[[Noting, Any], Noting]:
    def method(self: Noting, other: Any) -> Noting:
        operand = other.expression if isinstance(other, Noting) else float(np.ravel(other)[0])
        return Noting(getattr(self.expression, name)(operand))

    return method


class Noting:
    """An expression where an array of numbers or conditions would be; `any` scene may be one where
    a condition holds."""

    def __init__(self, expression: Expression) -> None:
        self.expression = expression

    __lt__, __le__, __ge__ = (_noting(name) for name in ("__lt__", "__le__", "__ge__"))
    __and__, __or__ = (_noting(name) for name in ("__and__", "__or__"))

    def __eq__(self, number: Any) -> Noting:  # type: ignore[override]
        return Noting(self.expression.table.equals(self.expression, number))

    __hash__ = None  # type: ignore[assignment]

    def __invert__(self) -> Noting:
        return Noting(~self.expression)

    def any(self) -> bool:
        return True

    def select(self, yes: Reals, no: Reals) -> Noted:
        table, unit = self.expression.table, yes.unit or no.unit
        chosen = table.choose(self.expression, noted(table, yes), noted(table, no))
        return Noted(chosen, unit, yes.stored and no.stored)


class Noted(Reals):
    """A real of which only the operation that makes it is noted."""

    __slots__ = ("expression",)

    def __init__(self, expression: Expression, unit: Unit | None, stored: bool = False) -> None:
        self.expression = expression
        self.unit = unit
        self.stored = stored
        self.zero = False

    @property
    def v(self) -> Any:  # type: ignore[override]
        return Noting(self.expression)

    def _make(self, operation: str, *operands: Reals | int, stored: bool = False) -> Noted:
        table = self.expression.table
        return Noted(
            table.combine(operation, *(noted(table, x) for x in operands)), self.unit, stored
        )

    def rounded(self) -> Reals:
        return self if self.stored else self._make("real_rounded", self, stored=True)

    def __neg__(self) -> Noted:
        return self._make("negative", self, stored=self.stored)

    def __abs__(self) -> Noted:
        return self._make("absolute", self, stored=self.stored)

    def _sum(self, operation: str, left: Reals | int, right: Reals | int) -> Reals:
        """A known zero is no operand: x + 0 is x rounded, 0 + x is x."""
        left, right = as_real(left), as_real(right)
        if right.zero:
            return left.rounded()
        if left.zero:
            return -right if operation == "real_subtract" else right
        return self._make(operation, left, right)

    def __add__(self, right: Reals | int) -> Reals:
        return self._sum("real_add", self, right)

    def __radd__(self, left: Reals | int) -> Reals:
        return self._sum("real_add", left, self)

    def __sub__(self, right: Reals | int) -> Reals:
        return self._sum("real_subtract", self, right)

    def __rsub__(self, left: Reals | int) -> Reals:
        return self._sum("real_subtract", left, self)

    def __mul__(self, right: Reals | int) -> Reals:
        return ZERO if as_real(right).zero else self._make("real_multiply", self, right)

    def __rmul__(self, left: Reals | int) -> Reals:
        return ZERO if as_real(left).zero else self._make("real_multiply", left, self)

    def __truediv__(self, right: Reals | int) -> Reals:
        return self._make("real_divide", self, right)

    def __rtruediv__(self, left: Reals | int) -> Reals:
        return self._make("real_divide", left, self)

    def __lt__(self, right: Reals | int) -> Any:
        return Noting(self._make("real_less", self, right).expression)

    def __gt__(self, right: Reals | int) -> Any:
        return Noting(self._make("real_less", -self, -as_real(right)).expression)

    def exceeds(self, limit: float) -> bool:
        return False  # else the scene is marked

    def kept_within_powers(self) -> None:
        """What is not is marked."""

    def floor(self) -> Noted:
        return self._make("real_int", self)

    def fraction(self) -> Noted:
        return self._make("real_fraction", self, stored=self.stored)

    def exponent(self) -> Noted:
        return self._make("real_exponent", self, stored=True)

    def with_extension(self, more: int) -> Noted:
        bits = float(np.int64(more << 13).view(np.float64))
        halved = self._make("real_halved", self)
        table = self.expression.table
        halved.expression = table.combine("real_halved", self.expression, table.constant(bits))
        return halved

    def whole(self) -> Noted:
        return self._make("real_whole", self, stored=True)

    def scaled(self, powers: Reals) -> Noted:
        return self._make("real_scaled", self, powers)


def as_real(x: Reals | int) -> Reals:
    return constant(x) if isinstance(x, int) else x


def noted(table: ExpressionTable, x: Reals | int) -> Expression:
    """The expression of a real, which may be a constant."""
    x = as_real(x)
    return x.expression if isinstance(x, Noted) else table.constant(float(x.v[0]))


class _Notes(Unit):
    """Where errors are recorded while notes are taken: nowhere but in the mark."""

    def __init__(self, table: ExpressionTable) -> None:
        super().__init__(1)
        self.marked = table.constant(0.0)

    def skip(self, skipped: Any) -> None:
        """What is marked needlessly is computed all the same."""

    def fails(self, failed: Any, code: int) -> bool:
        if isinstance(failed, Noting):
            self.marked = self.marked.table.condition("either", self.marked, failed.expression)
        elif np.any(failed):  # in every scene
            self.marked = self.marked.table.constant(1.0)
        return False

    def still(self, chosen: dict[int, Any]) -> dict[int, Any]:
        """None: a scene in which no other row is chosen is marked by its pivot."""
        return {}


@lru_cache(maxsize=64)
def program(kind: statements.Kind, varying: frozenset[str], names: tuple[str, ...]) -> Program:
    """The program for a kind of scenes: of ``varying`` columns the results ``names``, and `ODD`."""

    def make(unit: Unit, scene: Mapping[str, Noted]) -> Mapping[str, Reals]:
        results = statements.run(unit, scene, kind)
        return {name: results[name] for name in names if name in results}

    return traced(make, NAMES, varying)


@lru_cache(maxsize=64)
def field_program(names: tuple[str, ...], varying: frozenset[str]) -> Program:
    """What PRINT gets for the fields ``names``, of ``varying`` values, and `ODD`."""

    def make(unit: Unit, given: Mapping[str, Noted]) -> Mapping[str, Reals]:
        return {name: statements.shown(name, *(given[x] for x in sources(name))) for name in names}

    return traced(make, tuple(x for name in names for x in sources(name)), varying)


def sources(field: str) -> tuple[str, ...]:
    """The values that a field is made of."""
    return ("KI", "KF") if field == "LOSS" else (field,)


def traced(
    make: Callable[[Unit, Mapping[str, Noted]], Mapping[str, Reals]],
    names: Sequence[str],
    varying: frozenset[str],
) -> Program:
    table = ExpressionTable()
    unit = _Notes(table)
    given = {}
    for name in names:
        column = table.column(name, name in varying)
        given[name] = Noted(table.combine("real_ordinary", column), unit, True)
    shown = {name: noted(table, x) for name, x in make(unit, given).items()}
    shown[ODD] = table.combine("odd", unit.marked, varies=True)
    return Program(shown, ["COPY"] * len(shown))


def computed(
    program: Program, columns: Mapping[str, Floats], count: int
) -> tuple[dict[str, Floats], Bools]:
    """The results of a program, and which scenes it has marked. ``columns``: of ``count`` values or
    of one."""
    own = [np.ascontiguousarray(columns[name]) for name in program.columns]
    found = np.empty((len(program.results), count))
    fixed = {x: float(columns[x][0]) for x in program.scalars if isinstance(x, str)}
    into = found.ctypes.data + found.strides[0] * np.arange(len(found))
    program.run(addresses(own), into, count, fixed=fixed)
    results = dict(zip(program.results, found, strict=True))
    return results, results.pop(ODD) != 0
