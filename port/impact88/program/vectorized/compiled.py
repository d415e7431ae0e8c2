"""The replay's statements as a program for the compiled machine: `statements.run` is run once with
values that only note what is done with them. Scenes out of the ordinary (an error, a value beyond
2^100 or below 2^-100, a comparison without its carry) are marked and left to the arrays."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from ...mechanics.native.formulas import Expression, ExpressionTable
from ...mechanics.native.program import Program, addresses
from ...names import SCENE
from . import statements
from .reals import ZERO, Floats, Reals
from .unit import Bools, Unit

NAMES = tuple(name for name in SCENE if name != "M")
ODD = "ODD"
"""The result that marks a scene: 1, else 0."""


def _noted(operation: str, stored: bool | None = None) -> Any:
    """The method that notes an operation; what it makes is as it was if ``stored`` does not say."""
    return lambda self, *others: self.made(
        operation, *others, stored=self.stored if stored is None else stored
    )


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
        return self.expression

    def made(self, operation: str, *others: Reals, stored: bool = False) -> Noted:
        table = self.expression.table
        operands = (noted(table, x) for x in (self, *others))
        return Noted(table.combine(operation, *operands), self.unit, stored)

    def rounded(self) -> Reals:
        return self if self.stored else self.made("real_rounded", stored=True)

    def combined(self, operation: str, left: Reals, right: Reals) -> Any:
        """A known zero is no operand: x + 0 is x rounded, 0 + x is x, 0 * x is 0."""
        if operation in ("add", "subtract") and right.zero:
            return left.rounded()
        if operation in ("add", "subtract") and left.zero:
            return right if operation == "add" else -right
        if operation == "multiply" and (left.zero or right.zero):
            return ZERO
        if operation == "greater":
            operation, left, right = "less", -left, -right
        table = self.expression.table
        made = table.combine(f"real_{operation}", noted(table, left), noted(table, right))
        return made if operation == "less" else Noted(made, self.unit)

    def chosen(self, condition: Any, yes: Reals, no: Reals) -> Noted:
        table = self.expression.table
        made = table.choose(condition, noted(table, yes), noted(table, no))
        return Noted(made, yes.unit or no.unit, yes.stored and no.stored)

    def below(self, limit: Reals) -> Expression:
        return self.expression < noted(self.expression.table, limit)

    def nothing(self) -> Expression:
        return self.expression.table.equals(self.expression, 0.0)

    def exceeds(self, limit: float) -> bool:
        return False  # else the scene is marked

    def kept_within_powers(self) -> None:
        """What is not is marked."""

    __neg__, __abs__ = _noted("negative"), _noted("absolute")
    floor, scaled = _noted("real_int", False), _noted("real_scaled", False)
    fraction, exponent = _noted("real_fraction"), _noted("real_exponent", True)
    whole = _noted("real_whole", True)

    def with_extension(self, more: int) -> Noted:
        bits = np.int64(more << 13).view(np.float64)
        return self.made("real_halved", Reals(np.array([bits]), None))


def noted(table: ExpressionTable, x: Reals) -> Expression:
    """The expression of a real, which may be a constant."""
    return x.expression if isinstance(x, Noted) else table.constant(float(x.v[0]))


class _Notes(Unit):
    """Where errors are recorded while notes are taken: nowhere but in the mark."""

    def __init__(self, table: ExpressionTable) -> None:
        super().__init__(1)
        self.marked = table.constant(0.0)

    def skip(self, skipped: Any) -> None:
        """What is marked needlessly is computed all the same."""

    def fails(self, failed: Any, code: int) -> bool:
        if isinstance(failed, Expression):
            self.marked = self.marked | failed
        elif np.any(failed):  # in every scene
            self.marked = self.marked.table.constant(1.0)
        return False

    def still(self, chosen: dict[int, Any]) -> dict[int, Any]:
        """None: a scene in which no other row is chosen is marked by its pivot."""
        return {}


@lru_cache(maxsize=64)
def program(kind: statements.Kind, varying: frozenset[str]) -> Program:
    """The program for a kind of scenes: of ``varying`` columns the results, and `ODD`."""

    def make(unit: Unit, scene: Mapping[str, Noted]) -> Mapping[str, Reals]:
        results = statements.run(unit, scene, kind)
        return {name: results[name] for name in statements.ASSIGNED if name in results}

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
    results = {name: noted(table, x) for name, x in make(unit, given).items()}
    results[ODD] = table.combine("odd", unit.marked, varies=True)
    return Program(results, ["COPY"] * len(results))


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
