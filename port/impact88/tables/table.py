"""Tables of scenes: CSV, JSON Lines, .npz and others, read and written a block of rows at a time,
the next block read and the last one written while a block is solved.

A reader yields `tables.rows.Rows`; a writer takes them back with their results. Memory does not
grow with the file (what is written of .npz and .xlsx is held).
"""

import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib import import_module
from types import ModuleType
from typing import Any

from numpy.typing import NDArray

from ..errors import UserError, quoted
from ..names import SCENE
from .rows import Reader, Rows, heading, heading_remarks

FORMATS = {
    **dict.fromkeys((".csv", ".tsv", ".txt"), "csv"),
    **dict.fromkeys((".jsonl", ".ndjson", ".json"), "jsonl"),
    **{".npz": "npz", ".parquet": "parquet", ".feather": "feather", ".arrow": "feather"},
    ".xlsx": "xlsx",
}
"""File name ending -> format."""
_MODULES = {
    "csv": ("csvtable", "a CSV table"),
    "jsonl": ("jsontable", ""),
    "npz": ("npztable", "an .npz table"),
    "xlsx": ("excel", "a workbook"),
    **dict.fromkeys(("parquet", "feather"), ("arrowtable", "a table of typed columns")),
}
"""Format -> its module, and what it is called where its columns are those of the first block. A
module has ``read(path, form, encoding, results)`` and ``write(path, form, delimiter, headings)``,
which gives a function that takes a block's columns by name; each imports what it needs."""
_TEXTS = ("csv", "jsonl")


def format_of(path: str, given: str | None) -> str:
    """The format, csv or another. Raises UserError if neither name nor ``given`` says which."""
    if given:
        return given
    if path == "-":
        return "csv"
    ending = "".join(path.lower().removesuffix(".gz").rpartition(".")[1:])
    if ending not in FORMATS:
        raise UserError(f"unknown format; expected a name ending in {' '.join(FORMATS)}", path)
    return FORMATS[ending]


def _module(form: str) -> ModuleType:
    return import_module(f"{__package__}.{_MODULES[form][0]}")


@contextmanager
def open_reader(
    path: str, form: str, encoding: str | None = None, results: bool = False
) -> Iterator[Reader]:
    """Open a table for reading (``-``: standard input). Raises UserError if it is not one.
    ``encoding``: of a CSV or of JSON Lines that are not UTF-8; ``results``: results are read, too,
    by whatever letters their headings have."""
    if encoding is not None and form not in _TEXTS:
        raise UserError(f"--encoding is for text; {form} has its own")
    if path == "-" and form not in _TEXTS:
        raise UserError(f"{form} cannot be read from standard input; expected a file")
    with _module(form).read(path, form, encoding, results) as reader:
        reader.remarks += heading_remarks(reader.names, results)
        yield reader


@contextmanager
def open_writer(
    path: str, form: str, source: Reader, results: Sequence[str], scene_too: bool
) -> Iterator[Callable[[Rows, Mapping[str, NDArray[Any]]], None]]:
    """Open a table for writing ``results`` after the columns of ``source`` (its scene columns only
    if ``scene_too``; a column named like a result gives way to it): a function that writes a block
    and its results. The file appears under its name when all is written."""
    if path == "-" and form not in _TEXTS and (form != "npz" or sys.stdout.isatty()):
        place = "a terminal" if form == "npz" else "standard output"
        raise UserError(f"{form} is not for {place}; expected -o FILE.{form}")
    dropped = {*results, *(() if scene_too else SCENE)}
    kept = [name for name in source.names if name not in dropped]
    headings = [heading(name) for name in (*kept, *results)]
    with _module(form).write(path, form, source.delimiter, headings) as put:

        def write(rows: Rows, found: Mapping[str, NDArray[Any]]) -> None:
            late = [name for name in rows.late if name not in dropped]
            if late and form != "jsonl":
                raise UserError(
                    f"line {rows.late[late[0]]} has the key {quoted(late[0])}, which no row before "
                    f"it has, and {_MODULES[form][1]} begins with its columns; expected to write "
                    "JSON Lines, or the key in the first row too"
                )
            names = [*kept, *late]
            if form == "jsonl":  # a row need not hold all
                names = [name for name in names if name in rows.columns]
            cell = rows.columns.__getitem__ if form == "npz" else rows.one_per_row
            put([*((name, cell(name)) for name in names), *((n, found[n]) for n in results)])

        yield write


def may_wait(path: str) -> bool:
    """Whether reading or writing ``path`` can take for ever: standard input or output, a pipe. A
    thread that waits there would keep a terminated command from ending."""
    return path == "-" or (os.path.exists(path) and not os.path.isfile(path))


@contextmanager
def ahead(blocks: Iterable[Any]) -> Iterator[Iterator[Any]]:
    """The blocks, each read while the one before it is in use; what reading raises, they raise.
    pyarrow and numpy let go of the interpreter's lock: two processors are of use."""
    from concurrent.futures import ThreadPoolExecutor  # 8 ms, which a short table is spared

    iterator = iter(blocks)
    with ThreadPoolExecutor(1, "read") as pool:

        def taken() -> Iterator[Any]:
            waiting = pool.submit(next, iterator, None)
            while (block := waiting.result()) is not None:
                waiting = pool.submit(next, iterator, None)
                yield block

        yield taken()


@contextmanager
def behind(write: Callable[..., object]) -> Iterator[Callable[..., None]]:
    """A function that has ``write`` done in order, later (more than one call that waits gains
    nothing); what it raises is raised by the next call, or at the end."""
    from concurrent.futures import Future, ThreadPoolExecutor

    with ThreadPoolExecutor(1, "write") as pool:
        waiting: Future[object] = pool.submit(bool)

        def later(*arguments: Any) -> None:
            nonlocal waiting
            waiting.result()
            waiting = pool.submit(write, *arguments)

        yield later
        waiting.result()
