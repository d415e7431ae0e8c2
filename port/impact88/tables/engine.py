"""One engine for tables of any format: opened by `read_table`, written whole or not at all."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import IO

from ..errors import UserError
from ..files import replacing
from .polarsformats import read_excel, read_parquet, write_excel, write_parquet
from .textformats import (
    Columns,
    Table,
    check_headings,
    read_csv,
    read_json,
    write_csv,
    write_json,
)

_Format = tuple[Callable[[str], Table], Callable[[IO[bytes], Iterable[Columns]], None]]

_FORMATS: dict[str, _Format] = {
    **dict.fromkeys((".csv", ".tsv", ".txt"), (read_csv, write_csv)),
    **dict.fromkeys((".jsonl", ".ndjson"), (read_json, write_json)),
    ".parquet": (read_parquet, write_parquet),
    ".xlsx": (read_excel, write_excel),
}
"""Reader and writer by the ending of a file's name."""


def _format_of(path: str) -> _Format:
    """Return reader and writer of a file: CSV for a standard stream. Raises UserError."""
    ending = ".csv" if path == "-" else Path(path).suffix.lower()
    if ending not in _FORMATS:
        raise UserError(f"expected a table in {' '.join(_FORMATS)}, or .toml to read", path)
    return _FORMATS[ending]


def is_csv(path: str) -> bool:
    """Return True for a file whose numbers are texts. Raises UserError for one of no format."""
    return _format_of(path)[0] is read_csv


def read_table(path: str, digits: bool = False) -> Table:
    """Return a table, whose blocks of rows are read as they are asked for.

    Parameters
    ----------
    path : str
        The file, ``-`` for CSV on standard input. Its name gives the format.
    digits : bool, default False
        Keep the digits of numbers in JSON, for the 1988 arithmetic; texts always keep them.

    Raises
    ------
    UserError
        For a file that cannot be read as a table, here or in its blocks.
    """
    reader, _ = _format_of(path)
    table = read_json(path, digits) if reader is read_json else reader(path)
    return table._replace(names=check_headings(table.names, table.where))


def write_table(path: str, blocks: Iterable[Columns]) -> None:
    """Write blocks of rows as a table, whole or not at all.

    Parameters
    ----------
    path : str
        The file, ``-`` for CSV on standard output.
    blocks : iterable of mapping of str to column
        Columns by heading: arrays of numbers, lists of texts, or series of polars.

    Raises
    ------
    UserError
        If the file cannot be written.
    """
    _, write = _format_of(path)
    if path != "-":
        with replacing(path, "wb") as file:
            write(file, blocks)
        return
    sys.stdout.flush()
    output = io.BufferedWriter(sys.stdout.buffer)  # an unbuffered one may write a part only
    try:
        write(output, blocks)
    finally:
        output.detach()
