"""Tables of scenes: CSV, JSON Lines and .npz, read and written a block of rows at a time.

A reader yields `Rows`; a writer takes the same `Rows` back with the results found for them, so
that what the file held is passed through as it stood. Numbers stay decimal text until an arithmetic
reads them. Memory does not grow with the file (.npz excepted, which is arrays as a whole).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from .errors import UserError
from .names import SCENE

Column = Sequence[Any] | NDArray[Any]

BLOCK_ROWS = 16384
FORMATS = {
    ".csv": "csv",
    ".tsv": "csv",
    ".txt": "csv",
    ".jsonl": "jsonl",
    ".ndjson": "jsonl",
    ".npz": "npz",
}
"""File name ending -> format."""


class BadCell(NamedTuple):
    """Why a row cannot be used: ``row`` counts the rows of data from 1, ``line`` is the line of the
    file (0: a file without lines), ``column`` the column at fault ("" for the row as a whole)."""

    row: int
    line: int
    column: str
    reason: str

    def __str__(self) -> str:
        place = f"row {self.row}" + (f" (line {self.line})" if self.line else "")
        return f"{place}{', ' + self.column if self.column else ''}: {self.reason}"


@dataclass
class Rows:
    """Some rows of a table.

    ``first``: the number of the first, from 1; ``columns``: scene name -> texts (None where the row
    has none) or an array; ``others``: the other columns, passed through; ``lines``: the file's line
    of each row, if it has lines; ``bad``: rows that could not be read.
    """

    first: int
    count: int
    columns: dict[str, Column]
    others: dict[str, Column]
    lines: Sequence[int] | None = None
    bad: list[BadCell] = field(default_factory=list)

    def kept(self, name: str) -> Column:
        """A column of either kind."""
        return self.columns[name] if name in self.columns else self.others[name]

    def cell(self, index: int, column: str, reason: str) -> BadCell:
        """A complaint about the row at ``index``, counted from 0."""
        line = self.lines[index] if self.lines is not None else 0
        return BadCell(self.first + index, line, column, reason)


class Reader(Protocol):
    """An open table.

    ``names``: its columns (of JSON Lines, those of the first row); ``delimiter``: between a CSV's
    fields; ``total``: its size in the units of ``position`` (None: unknown).
    """

    names: list[str]
    delimiter: str
    total: int | None

    def __iter__(self) -> Iterator[Rows]: ...

    def position(self) -> int: ...


class Writer(Protocol):
    """A table being written."""

    def write(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None: ...


def format_of(path: str, given: str | None) -> str:
    """csv, jsonl or npz. Raises UserError if neither ``given`` nor the file's name tells."""
    if given:
        return given
    if path == "-":
        return "csv"
    ending = "." + path.lower().rpartition(".")[2] if "." in path else ""
    if ending not in FORMATS:
        raise UserError(f"cannot tell its format; expected a name in {' '.join(FORMATS)}", path)
    return FORMATS[ending]


def open_reader(path: str, form: str) -> AbstractContextManager[Reader]:
    """Open a table for reading (``-``: standard input). Raises UserError if it is none."""
    if form == "csv":
        from .csvtable import read_csv

        return read_csv(path)
    if form == "jsonl":
        from .jsontable import read_json_lines

        return read_json_lines(path)
    from .npztable import read_npz

    return read_npz(path)


def open_writer(
    path: str, form: str, source: Reader, results: Sequence[str], scene_too: bool
) -> AbstractContextManager[Writer]:
    """Open a table for writing ``results`` after the columns of ``source`` (its scene columns only
    if ``scene_too``; a column named like a result gives way to it). The file appears under its name
    when all is written."""
    kept = [n for n in source.names if n not in results and (scene_too or n not in SCENE)]
    if form == "csv":
        from .csvtable import write_csv

        return write_csv(path, kept, results, source.delimiter)
    if form == "jsonl":
        from .jsontable import write_json_lines

        return write_json_lines(path, kept, results)
    from .npztable import write_npz

    return write_npz(path, kept, results)


def shortest(values: NDArray[Any]) -> list[str]:
    """Floats in the fewest digits that read back exactly; anything else as str writes it."""
    return list(map(repr if values.dtype.kind == "f" else str, values.tolist()))


def numbers(rows: Rows) -> dict[str, NDArray[np.float64]]:
    """The scene columns of ``rows`` as doubles. A cell that is no number is NaN, and a complaint is
    added to ``rows.bad`` (unless its row has one already)."""
    return {name: _numbers(rows, name, column) for name, column in rows.columns.items()}


def _numbers(rows: Rows, name: str, column: Column) -> NDArray[np.float64]:
    if isinstance(column, np.ndarray) and column.dtype.kind in "fiub":
        return column.astype(np.float64, copy=False)
    try:
        values = np.array(list(map(float, column)))
        if "_" not in "".join(column):
            return values
    except (TypeError, ValueError):
        pass
    values = np.full(rows.count, np.nan)
    already = {bad.row for bad in rows.bad}
    for index, text in enumerate(column):
        reason = _why_no_number(text)
        if reason is None:
            values[index] = float(text)
        elif rows.first + index not in already:
            rows.bad.append(rows.cell(index, name, reason))
    return values


def _why_no_number(text: object) -> str | None:
    if text is None or (isinstance(text, str) and not text.strip()):
        return "is empty; expected a number"
    try:
        if isinstance(text, str) and "_" in text:
            raise ValueError
        float(text)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return f"{text!r} is no number"
    return None


def check_scene_columns(
    names: Sequence[str], given: Sequence[str], optional: Sequence[str]
) -> None:
    """Raise UserError unless ``names`` (a file's scene columns) and ``given`` (those given beside
    the file) together are a scene; those ``optional`` may be missing."""
    missing = [
        name for name in SCENE if name not in names and name not in given and name not in optional
    ]
    if missing:
        raise UserError(
            f"no column {' '.join(missing)}; expected columns named {' '.join(SCENE)} "
            "(M may be missing; --set NAME=VALUE gives one value for all rows)"
        )
