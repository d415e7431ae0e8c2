"""Other programs' tables: CSV, and what Python programs have in memory.

Cells stay as they are written, because their digits count.
"""

import csv
import io
import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..errors import UserError, quoted
from ..files import read_text
from ..names import DEFAULT_M, missing
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
        A CSV file, "-" (CSV on standard input), or the table itself.

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
        columns = _read_csv(os.fspath(table))
    elif isinstance(table, Mapping):
        columns = {str(name): np.atleast_1d(np.asarray(c)) for name, c in table.items()}
    elif hasattr(table, "columns"):
        columns = {str(name): np.asarray(table[name]) for name in table.columns}
    elif isinstance(table, Sequence):
        columns = _columns_of(table)
    else:
        raise UserError(f"{quoted(table)} is no table; expected a path, columns or rows")
    size = max((len(column) for column in columns.values()), default=0)
    for name, column in columns.items():
        if len(column) == 1:
            columns[name] = np.repeat(np.asarray(column), size)
        elif len(column) != size:
            raise UserError(f"column {quoted(name)} has {len(column)} rows; expected {size}")
    if not size:
        raise UserError("the table has no rows")
    return columns


def _read_csv(path: str) -> Columns:
    if not (path == "-" or path.lower().endswith(".csv")):
        raise UserError("is not a table; expected a name ending in .csv", path)
    text = read_text(path).removeprefix("\ufeff")
    try:
        header, *rows = [row for row in csv.reader(io.StringIO(text)) if row] or [[]]
    except csv.Error as error:
        raise UserError(f"cannot be read: {error}", path) from None
    names = [name.strip() for name in header]
    for name in names:
        if names.count(name) > 1:
            raise UserError(f"has two columns {quoted(name)}", path)
    for place, row in enumerate(rows, 1):
        if len(row) != len(names):
            message = f"has {len(row)} cells; expected {len(names)}, as the headings have"
            raise UserError(message, f"{path}, row {place}")
    return {name: np.array([row[k] for row in rows]) for k, name in enumerate(names)}


def _columns_of(rows: Sequence[Any]) -> Columns:
    """Return the columns of rows that are mappings; a missing cell is empty."""
    for place, row in enumerate(rows, 1):
        if not isinstance(row, Mapping):
            raise UserError(f"row {place} of the table is no mapping of names to numbers")
    names = list(dict.fromkeys(name for row in rows for name in row))
    cells = {name: [row.get(name, "") for row in rows] for name in names}
    return {name: np.array(["" if x is None else str(x) for x in c]) for name, c in cells.items()}


def scene_columns(columns: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Floats]:
    """Return the 21 columns of the scene as numbers.

    Parameters
    ----------
    columns : mapping
        A table's columns.
    values : mapping
        Values of columns that the table lacks.

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
                if str(cell := columns[name][row]).strip().lower() not in EMPTY:
                    raise UserError(f"{name} = {quoted(cell)} is not a number", f"row {row + 1}")
        elif name in values or name == "M":
            scene[name] = np.full(size, float(values.get(name, DEFAULT_M)))
        elif name in BODY_COLUMNS and (scene["M"] == 4.0).all():
            scene[name] = np.full(size, 1.0 if name in ("IA", "IB") else 0.0)
    if absent := [name for name in COLUMNS if name not in scene]:
        raise UserError(f"{missing(absent)}; expected the columns of the scene beside the results")
    return scene
