"""Tables of scenes: CSV, JSON Lines, .npz and others, read and written a block of rows at a time.

A reader yields `tables.rows.Rows`; a writer takes them back with their results. Memory does not
grow with the file (but for .npz and .xlsx).
"""

import sys
from collections.abc import Sequence
from contextlib import AbstractContextManager
from importlib import import_module
from types import ModuleType

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
_MODULES = {
    **{"csv": "csvtable", "jsonl": "jsontable", "npz": "npztable", "xlsx": "excel"},
    **dict.fromkeys(("parquet", "feather"), "arrowtable"),
}
_TEXTS = ("csv", "jsonl")


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
    ``encoding``: of a CSV or of JSON Lines that are not UTF-8."""
    if encoding is not None and form not in _TEXTS:
        raise UserError(f"--encoding is for text; {form} has its own")
    if path == "-" and form not in _TEXTS:
        raise UserError(f"{form} cannot be read from standard input; expected a file")
    opened: AbstractContextManager[Reader] = _module(form).read(path, form, encoding)
    return opened


def open_writer(
    path: str, form: str, source: Reader, results: Sequence[str], scene_too: bool
) -> AbstractContextManager[Writer]:
    """Open a table for writing ``results`` after the columns of ``source`` (its scene columns only
    if ``scene_too``; a column named like a result gives way to it). The file appears under its name
    when all is written."""
    if path == "-" and form not in _TEXTS and (form != "npz" or sys.stdout.isatty()):
        place = "a terminal" if form == "npz" else "standard output"
        raise UserError(f"{form} is not for {place}; expected -o FILE.{form}")
    dropped = {*results, *(() if scene_too else SCENE)}
    kept = [name for name in source.names if name not in dropped]
    write = _module(form).write
    opened: AbstractContextManager[Writer] = write(
        path, form, source.delimiter, kept, results, dropped
    )
    return opened


def _module(form: str) -> ModuleType:
    """The module of a format, which has ``read(path, form, encoding)`` and ``write(path, form,
    delimiter, *columns)``; each imports what it needs."""
    return import_module(f"{__package__}.{_MODULES[form]}")
