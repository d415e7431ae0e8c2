"""Tables of scenes: CSV, JSON Lines and .npz, read and written a block of rows at a time.

A reader yields `tables.rows.Rows`; a writer takes the same rows back with the results found for
them, so that what the file held is passed through as it stood. Memory does not grow with the file
(.npz excepted, which is arrays as a whole).
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager

from ..errors import UserError
from ..names import SCENE
from .rows import Reader, Writer

FORMATS = {
    ".csv": "csv",
    ".tsv": "csv",
    ".txt": "csv",
    ".jsonl": "jsonl",
    ".ndjson": "jsonl",
    ".npz": "npz",
}
"""File name ending -> format."""


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
    dropped = {*results, *(() if scene_too else SCENE)}
    kept = [name for name in source.names if name not in dropped]
    if form == "csv":
        from .csvtable import write_csv

        return write_csv(path, kept, results, dropped, source.delimiter)
    if form == "jsonl":
        from .jsontable import write_json_lines

        return write_json_lines(path, kept, results, dropped)
    from .npztable import write_npz

    return write_npz(path, kept, results, dropped)
