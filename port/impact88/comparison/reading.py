"""Other programs' tables: files as `tables` reads them, and what Python programs have in memory.

Cells stay as they are written, because their digits count.
"""

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..errors import UserError, quoted
from ..names import missing
from ..tables import engine as tables
from .evaluation import Floats
from .numbers import EMPTY, numbers
from .spellings import COLUMNS

BODY_COLUMNS = ("EM", "DA", "DB", "PA", "PB", "TA", "TB", "IA", "IB")
"""Columns that point masses do not use."""
Columns = dict[str, Any]


def read_table(table: Any) -> Columns:
    """Return a table's columns by heading.

    Parameters
    ----------
    table : path, mapping of columns, data frame or sequence of mappings
        A file, "-" (CSV on standard input), or the table itself.

    Returns
    -------
    dict of str to sequence
        Columns of one length.

    Raises
    ------
    UserError
        For a table that cannot be read.
    """
    if isinstance(table, str | os.PathLike):
        columns = _read_file(os.fspath(table))
    elif isinstance(table, Mapping) or hasattr(table, "columns"):
        columns = {str(n): np.atleast_1d(table[n]) for n in getattr(table, "columns", table)}
    elif isinstance(table, Sequence):
        columns = _columns_of(table)
    else:
        raise UserError(f"{quoted(table)} is no table; expected a path, columns or rows")
    size = max(map(len, columns.values()), default=0)
    for name, column in columns.items():
        if len(column) == 1:
            columns[name] = np.repeat(column, size)
        elif len(column) != size:
            raise UserError(f"column {quoted(name)} has {len(column)} rows; expected {size}")
    if not size:
        raise UserError("the table has no rows")
    return columns


def _read_file(path: str) -> Columns:
    table = tables.read_table(path, digits=True)
    columns = [*zip(*(block.columns for block in table.blocks), strict=True)]
    for number, fault in table.faults.items():
        raise UserError(fault, table.place(number))
    return {name: np.concatenate(parts) for name, parts in zip(table.names, columns, strict=False)}


def _columns_of(rows: Sequence[Any]) -> Columns:
    """Return the columns of rows that are mappings; a missing cell is empty."""
    for place, row in enumerate(rows, 1):
        if not isinstance(row, Mapping):
            raise UserError(f"row {place} of the table is no mapping of names to numbers")
    names = dict.fromkeys(name for row in rows for name in row)
    return {name: np.array([str(row.get(name, "")) for row in rows]) for name in names}


def scene_columns(
    columns: Mapping[str, Any], factors: Mapping[str, float], values: Mapping[str, float]
) -> dict[str, Floats]:
    """Return the 21 columns of the scene in base units.

    Parameters
    ----------
    columns : mapping
        A table's columns.
    factors : mapping
        What converts each column to base units.
    values : mapping
        Values of columns that the table lacks, in base units.

    Raises
    ------
    UserError
        For missing columns.
    """
    size = len(next(iter(columns.values())))
    scene = {}
    for name in ("M", *COLUMNS[:-1]):
        if name in columns:
            scene[name] = numbers(columns[name])
            for row in np.flatnonzero(np.isnan(scene[name])):
                if (cell := str(columns[name][row])).strip().lower() not in EMPTY:
                    raise UserError(f"{name} = {quoted(cell)} is not a number", f"row {row + 1}")
            scene[name] *= factors[name]
        elif name in values:
            scene[name] = np.full(size, values[name])
        elif name in BODY_COLUMNS and (scene["M"] == 4.0).all():
            scene[name] = np.full(size, 1.0 if name in ("IA", "IB") else 0.0)
    if absent := [name for name in COLUMNS if name not in scene]:
        raise UserError(f"{missing(absent)}; expected the columns of the scene beside the results")
    return scene
