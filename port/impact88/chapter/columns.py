"""Columns of numbers by name, as the chapter's functions take them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..decimals import to_double
from ..errors import UserError, quoted
from ..names import check_names, missing

Array = NDArray[np.float64]


def read_columns(known: Mapping[str, Any], names: Sequence[str]) -> list[Array]:
    """Return the columns of some names as arrays; others are ignored.

    Raises
    ------
    UserError
        For a name that is missing, and a value that is not a number or an array of numbers.
    """
    if not isinstance(known, Mapping):
        raise UserError(f"{quoted(known)} is not a mapping; expected names with their values")
    if absent := [name for name in names if name not in known]:
        raise UserError(missing(absent))
    columns = []
    for name in names:
        value = known[name]
        try:
            column = np.asarray(value)
            if column.dtype.kind in "OSU":  # texts
                column = np.reshape([to_double(str(x)) for x in column.flat], column.shape)
            columns.append(np.asarray(column, np.float64))
        except (TypeError, ValueError):
            raise UserError(f"{name} is {quoted(value)}; expected numbers") from None
    try:
        np.broadcast_shapes(*(column.shape for column in columns))
    except ValueError:
        shapes = ", ".join(f"{n} {c.shape}" for n, c in zip(names, columns, strict=True) if c.ndim)
        raise UserError(f"arrays of one shape are expected; these are {shapes}") from None
    return columns


def check_columns(known: Mapping[str, Any], allowed: Sequence[str], problem: str) -> None:
    """Raise UserError for a name that does not belong to a problem."""
    check_names(known, allowed, f"value of {problem}")
