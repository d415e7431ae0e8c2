"""A spelling evaluated with running error bounds: what rounding may do to the program it is."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from .evaluation import Columns, value
from .spelling import TYPED, Spelling

_ERRORS: dict[Any, Callable[..., Any]] = {
    np.add: lambda v, x, y, dx, dy: dx + dy,
    np.subtract: lambda v, x, y, dx, dy: dx + dy,
    np.multiply: lambda v, x, y, dx, dy: np.abs(x) * dy + np.abs(y) * dx,
    np.divide: lambda v, x, y, dx, dy: (dx + np.abs(v) * dy) / np.abs(y),
    np.square: lambda v, x, dx: 2 * np.abs(x) * dx,
    np.sin: lambda v, x, dx: np.abs(np.cos(x)) * dx,
    np.cos: lambda v, x, dx: np.abs(np.sin(x)) * dx,
    np.hypot: lambda v, x, y, dx, dy: dx + dy,
    np.negative: lambda v, x, dx: dx - np.abs(v),
}
"""What an operation makes of the errors of its operands, its own rounding aside."""


class Bounded:
    """Numbers, and how far rounding may have taken each, in units of roundoff."""

    def __init__(self, values: Any, errors: Any) -> None:
        self.values, self.errors = values, errors

    def __array_ufunc__(self, ufunc: Any, method: str, *operands: Any) -> Any:
        values = [_value(one) for one in operands]
        found = ufunc(*values)
        if ufunc not in _ERRORS:  # comparisons
            return found
        errors = _ERRORS[ufunc](found, *values, *map(_error, operands))
        return Bounded(found, errors + np.abs(found))

    def __array_function__(self, function: Any, types: Any, operands: Any, options: Any) -> Any:
        condition, *both = operands
        values, errors = map(_value, both), map(_error, both)
        return Bounded(np.where(condition, *values), np.where(condition, *errors))


def _value(one: Any) -> Any:
    return one.values if isinstance(one, Bounded) else one


def _error(one: Any) -> Any:
    return one.errors if isinstance(one, Bounded) else 0.0


def running_errors(spelling: Spelling, scene: Columns) -> Mapping[str, Bounded]:
    """All that a spelling without equations computes for scenes (columns of n), with bounds."""
    names: dict[str, Any] = {
        f"{TYPED}{name}": Bounded(column, np.abs(column)) for name, column in scene.items()
    }
    with np.errstate(all="ignore"):
        for one in spelling.statements:
            names[one.target] = value(one.sides[0], names)
    return names
