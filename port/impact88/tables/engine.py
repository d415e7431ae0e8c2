"""One engine for tables of any format: opened by `read_table`, written whole or not at all."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import IO

from ..errors import UserError
from ..files import Source, replacing
from . import polarsformats, textformats
from .textformats import Column, Table

ENDINGS = {
    ".csv": "csv",
    ".tsv": "csv",
    ".txt": "csv",
    ".jsonl": "jsonl",
    ".ndjson": "jsonl",
    ".parquet": "parquet",
    ".xlsx": "xlsx",
}
"""Formats by the ending of a file's name."""
_WRITERS: dict[str, Callable[[IO[bytes], Iterable[Mapping[str, Column]]], None]] = {
    "csv": textformats.write_csv,
    "jsonl": textformats.write_json,
    "parquet": polarsformats.write_parquet,
    "xlsx": polarsformats.write_excel,
}


def format_of(path: str, given: str = "") -> str:
    """Return the format of a file: ``given``, else by the ending of its name; CSV for a standard
    stream. Raises UserError for another ending."""
    ending = Path(path).suffix.lower()
    if given or path == "-":
        return given or "csv"
    if ending not in ENDINGS:
        raise UserError(
            f"expected .toml to read, or a table in {' '.join(ENDINGS)} or with --from, --to", path
        )
    return ENDINGS[ending]


def read_table(path: str, kind: str = "", digits: bool = False) -> Table:
    """Return a table, whose blocks of rows are read as they are asked for.

    Parameters
    ----------
    path : str
        The file, ``-`` for standard input (CSV or JSON Lines).
    kind : {"", "csv", "jsonl", "parquet", "xlsx"}, default ""
        Its format, by default that of its name.
    digits : bool, default False
        Keep the digits of numbers in JSON, for the 1988 arithmetic; texts always keep them.

    Raises
    ------
    UserError
        For a file that cannot be read as a table, here or in its blocks.
    """
    kind = format_of(path, kind)
    if kind == "csv":
        return textformats.read_csv(path)
    if kind == "jsonl":
        return textformats.read_json(path, digits)
    if path == "-":
        raise UserError(f"{kind} cannot be read from standard input; expected a file")
    Source(path).close()  # a file that cannot be opened is named here
    return polarsformats.read_parquet(path) if kind == "parquet" else polarsformats.read_excel(path)


def write_table(path: str, blocks: Iterable[Mapping[str, Column]], kind: str = "") -> None:
    """Write blocks of rows as a table, whole or not at all.

    Parameters
    ----------
    path : str
        The file, ``-`` for standard output.
    blocks : iterable of mapping of str to column
        Columns by heading: arrays of numbers, lists of texts, or series of polars.
    kind : str, default ""
        See `read_table`.

    Raises
    ------
    UserError
        If the file cannot be written.
    """
    kind = format_of(path, kind)
    if path == "-" and kind not in ("csv", "jsonl"):
        raise UserError(f"{kind} cannot be written to standard output; expected a file")
    if path == "-":
        sys.stdout.flush()
        output = io.BufferedWriter(sys.stdout.buffer)  # an unbuffered one may write a part only
        try:
            _WRITERS[kind](output, blocks)
        finally:
            output.detach()
        return
    with replacing(path, "wb") as file:
        _WRITERS[kind](file, blocks)
