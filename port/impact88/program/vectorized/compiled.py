"""The replay's statements as a program for the compiled machine.

`statements.run` is traced: run once on symbolic values that record the operations applied to them.
Unusual scenes (an error, a magnitude above 2^100 or below 2^-100, a comparison without its carry)
are marked in the result `ODD` and computed with arrays instead."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from ...mechanics.native.expressiontable import Expression, ExpressionTable
from ...names import SCENE
from . import statements
from .blockerrors import BlockErrors, Bools
from .realmachine import Program, addresses
from .reals import ZERO, Floats, Reals

NAMES = tuple(name for name in SCENE if name != "M")
ODD = "ODD"
"""Name of the result that is 1 for scenes to be computed with arrays, else 0."""


def _recorder(operation: str, stored: bool | None = None) -> Any:
    """Return a method that records an operation; its result is ``stored``, by default as before."""
    return lambda self, *others: self.apply(
        operation, *others, stored=self.stored if stored is None else stored
    )


class SymbolicReals(Reals):
    """A symbolic real: the expression that computes it, instead of an array of values."""

    __slots__ = ("expression",)

    def __init__(
        self, expression: Expression, errors: BlockErrors | None, stored: bool = False
    ) -> None:
        self.expression = expression
        self.errors = errors
        self.stored = stored
        self.zero = False

    @property
    def v(self) -> Any:  # type: ignore[override]
        """The expression, in place of float64 values."""
        return self.expression

    def apply(self, operation: str, *others: Reals, stored: bool = False) -> SymbolicReals:
        """Return the symbolic result of an operation on this and ``others``."""
        table = self.expression.table
        operands = (expression_of(table, x) for x in (self, *others))
        return SymbolicReals(table.combine(operation, *operands), self.errors, stored)

    def rounded(self) -> Reals:
        return self if self.stored else self.apply("real_rounded", stored=True)

    def combine(self, operation: str, left: Reals, right: Reals) -> Any:
        """Return the result of an operator; zeros are folded: x + 0 is x rounded, 0 * x is 0."""
        if operation in ("add", "subtract") and right.zero:
            return left.rounded()
        if operation in ("add", "subtract") and left.zero:
            return right if operation == "add" else -right
        if operation == "multiply" and (left.zero or right.zero):
            return ZERO
        if operation == "greater":
            operation, left, right = "less", -left, -right
        table = self.expression.table
        expression = table.combine(
            f"real_{operation}", expression_of(table, left), expression_of(table, right)
        )
        return expression if operation == "less" else SymbolicReals(expression, self.errors)

    def choose(self, condition: Any, yes: Reals, no: Reals) -> SymbolicReals:
        table = self.expression.table
        expression = table.choose(condition, expression_of(table, yes), expression_of(table, no))
        return SymbolicReals(expression, yes.errors or no.errors, yes.stored and no.stored)

    def is_below(self, limit: Reals) -> Expression:
        return self.expression < expression_of(self.expression.table, limit)

    def is_zero(self) -> Expression:
        return self.expression.table.equals(self.expression, 0.0)

    def exceeds(self, limit: float) -> bool:
        """Return False: larger values mark the scene."""
        return False

    def check_powers(self) -> None:
        """Nothing to do: powers out of range mark the scene."""

    __neg__, __abs__ = _recorder("negative"), _recorder("absolute")
    floor, scale_by_power = _recorder("real_int", False), _recorder("real_scaled", False)
    fraction, exponent = _recorder("real_fraction"), _recorder("real_exponent", True)
    whole_part = _recorder("real_whole", True)

    def with_extension(self, more: int) -> SymbolicReals:
        bits = np.int64(more << 13).view(np.float64)
        return self.apply("real_halved", Reals(np.array([bits]), None))


def expression_of(table: ExpressionTable, x: Reals) -> Expression:
    """Return the expression of a symbolic real or of a constant."""
    return x.expression if isinstance(x, SymbolicReals) else table.constant(float(x.v[0]))


class _SymbolicErrors(BlockErrors):
    """`BlockErrors` for tracing: errors are not recorded, but combined into the expression
    ``marked``."""

    def __init__(self, table: ExpressionTable) -> None:
        super().__init__(1)
        self.marked = table.constant(0.0)

    def skip(self, skipped: Any) -> None:
        """Ignore: a scene marked without need is computed with arrays, with the same result."""

    def record_error(self, failures: Any, code: int) -> bool:
        if isinstance(failures, Expression):
            self.marked = self.marked | failures
        elif np.any(failures):  # in every scene
            self.marked = self.marked.table.constant(1.0)
        return False

    def drop_empty(self, chosen: dict[int, Any]) -> dict[int, Any]:
        """Return no rows: scenes that exchange rows are marked by their pivot."""
        return {}


@lru_cache(maxsize=64)
def program(kind: statements.Kind, varying: frozenset[str]) -> Program:
    """Return the program for a kind of scenes: results and `ODD`, given the ``varying`` columns."""

    def make(errors: BlockErrors, scene: Mapping[str, SymbolicReals]) -> Mapping[str, Reals]:
        results = statements.run(errors, scene, kind)
        return {name: results[name] for name in statements.ASSIGNED if name in results}

    return trace(make, NAMES, varying)


@lru_cache(maxsize=64)
def field_program(names: tuple[str, ...], varying: frozenset[str]) -> Program:
    """Return the program for the printed values of fields ``names``, and `ODD`."""

    def make(errors: BlockErrors, given: Mapping[str, SymbolicReals]) -> Mapping[str, Reals]:
        return {
            name: statements.printed_value(name, *(given[x] for x in sources(name)))
            for name in names
        }

    return trace(make, tuple(x for name in names for x in sources(name)), varying)


def sources(field: str) -> tuple[str, ...]:
    """Return the results from which a field is printed."""
    return ("KI", "KF") if field == "LOSS" else (field,)


def trace(
    make: Callable[[BlockErrors, Mapping[str, SymbolicReals]], Mapping[str, Reals]],
    names: Sequence[str],
    varying: frozenset[str],
) -> Program:
    """Return ``make`` as a program: run once on symbolic columns ``names``, of which ``varying``
    have a value for each scene and the others one for all."""
    table = ExpressionTable()
    errors = _SymbolicErrors(table)
    symbols = {}
    for name in names:
        column = table.column(name, name in varying)
        symbols[name] = SymbolicReals(table.combine("real_ordinary", column), errors, True)
    results = {name: expression_of(table, x) for name, x in make(errors, symbols).items()}
    results[ODD] = table.combine("odd", errors.marked, varies=True)
    return Program(results, ["COPY"] * len(results))


def run_program(
    program: Program, columns: Mapping[str, Floats], count: int
) -> tuple[dict[str, Floats], Bools]:
    """Run a program on columns of ``count`` values, or of one; return its results by name, and True
    for each scene marked as `ODD`."""
    inputs = [np.ascontiguousarray(columns[name]) for name in program.columns]
    outputs = np.empty((len(program.results), count))
    scalars = {x: float(columns[x][0]) for x in program.scalars if isinstance(x, str)}
    destinations = outputs.ctypes.data + outputs.strides[0] * np.arange(len(outputs))
    program.run(addresses(inputs), destinations, count, fixed=scalars)
    results = dict(zip(program.results, outputs, strict=True))
    return results, results.pop(ODD) != 0
