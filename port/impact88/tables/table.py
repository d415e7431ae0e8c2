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
    ".parquet": "parquet",
    ".feather": "feather",
    ".arrow": "feather",
    ".xlsx": "xlsx",
}
"""File name ending -> format."""


def format_of(path: str, given: str | None) -> str:
    """The format, csv or another. Raises UserError if neither name nor ``given`` says which."""
    if given:
        return given
    if path == "-":
        return "csv"
    if path.lower().endswith(".gz"):
        path = path[:-3]
    ending = "." + path.lower().rpartition(".")[2] if "." in path else ""
    if ending not in FORMATS:
        raise UserError(f"unknown format; expected a name ending in {' '.join(FORMATS)}", path)
    return FORMATS[ending]


def open_reader(
    path: str, form: str, encoding: str | None = None
) -> AbstractContextManager[Reader]:
    """Open a table for reading (``-``: standard input). Raises UserError if it is not one.

    ``encoding``: of a CSV or of JSON Lines that are not UTF-8.
    """
    if encoding is not None and form not in ("csv", "jsonl"):
        raise UserError(f"--encoding is for text; {form} has its own")
    if form == "csv":
        from .csvtable import read_csv

        return read_csv(path, encoding)
    if form == "jsonl":
        from .jsontable import read_json_lines

        return read_json_lines(path, encoding)
    if form == "npz":
        from .npztable import read_npz

        return read_npz(path)
    if form == "xlsx":
        from .excel import read_excel

        return read_excel(path)
    from .arrowtable import read_feather, read_parquet

    return (read_parquet if form == "parquet" else read_feather)(path)


def open_writer(
    path: str, form: str, source: Reader, results: Sequence[str], scene_too: bool
) -> AbstractContextManager[Writer]:
    """Open a table for writing ``results`` after the columns of ``source`` (its scene columns only
    if ``scene_too``; a column named like a result gives way to it). The file appears under its name
    when all is written."""
    dropped = {*results, *(() if scene_too else SCENE)}
    columns = ([name for name in source.names if name not in dropped], results, dropped)
    if form == "csv":
        from .csvtable import write_csv

        return write_csv(path, source.delimiter, *columns)
    if form == "jsonl":
        from .jsontable import write_json_lines

        return write_json_lines(path, *columns)
    if form == "npz":
        from .npztable import write_npz

        return write_npz(path, *columns)
    if form == "xlsx":
        from .excel import write_excel

        return write_excel(path, *columns)
    from .arrowtable import write_arrow

    return write_arrow(path, form, *columns)
