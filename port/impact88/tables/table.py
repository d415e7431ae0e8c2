"""Tables of scenes: CSV, JSON Lines, .npz and others, read and written a block of rows at a time,
the next block read and the last one written while a block is solved.

A reader yields `tables.rows.Rows`; a writer takes them back with their results. Memory does not
grow with the file (what is written of .npz and .xlsx is held, and a JSON array that is read).
"""

import _thread
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from itertools import chain
from typing import Any

from numpy.typing import NDArray

from ..collision.units import size_of
from ..errors import UserError, quoted
from ..names import RESULTS, SCENE, quantity
from .cells import RATIOS
from .formats import ENDINGS, FORMATS
from .rows import Heading, Reader, Rows, heading, heading_remarks


def format_of(path: str, given: str | None) -> str:
    """Return the name of a table's format. Raises UserError if neither name nor ``given`` says."""
    if given:
        return given
    if path == "-":
        return "csv"
    ending = "".join(path.lower().removesuffix(".gz").rpartition(".")[1:])
    if ending not in ENDINGS:
        raise UserError(f"unknown format; expected a name ending in {' '.join(ENDINGS)}", path)
    return ENDINGS[ending]


@contextmanager
def open_reader(
    path: str, format_name: str, encoding: str | None = None, results: bool = False
) -> Iterator[Reader]:
    """Open a table for reading (``-``: standard input). Raises UserError if it is not one.

    ``encoding``: of a text that is not UTF-8. ``results``: read columns of results, too, whatever
    the case of their headings.
    """
    row = FORMATS[format_name]
    if encoding is not None and not row.is_text:
        raise UserError(f"--encoding is for text; {format_name} has its own")
    if path == "-" and not row.is_text:
        raise UserError(f"{format_name} cannot be read from standard input; expected a file")
    with row.load().read(path, encoding, results) as reader:
        _read_units_row(reader, results)
        reader.remarks += heading_remarks(reader.names, results)
        yield reader


def _read_units_row(reader: Reader, results: bool) -> None:
    """Take the first row for the units of its columns where it holds units and no number.

    A heading that has a unit keeps it. Cells of other columns are not looked at."""
    blocks = iter(reader.blocks)
    first = next(blocks, None)
    reader.blocks = blocks if first is None else chain([first], blocks)
    names_known = [n for n in reader.names if n in SCENE or (results and n in RESULTS)]
    if first is None or not first.lines or any(n not in first.columns for n in names_known):
        return
    cells = {n: str(first.columns[n][0] or "").strip().strip("[]()") for n in names_known}
    units = {n: cell for n, cell in cells.items() if cell and cell not in RATIOS}
    if not units:
        return
    for name, unit in units.items():
        if size_of(unit, quantity(name).unit) is None:
            return
    headings = {n: f"{heading(n)} [{unit}]" for n, unit in units.items()}
    reader.names = [
        Heading(n, headings[n], units[n]) if n in units and not getattr(n, "unit", "") else n
        for n in reader.names
    ]
    reader.remarks.append(f"line {first.lines[0]} is read as the units of its columns")
    reader.blocks = chain([first.without_first()], blocks)


@contextmanager
def open_writer(
    path: str, format_name: str, source: Reader, results: Sequence[str], scene_too: bool
) -> Iterator[Callable[[Rows, Mapping[str, NDArray[Any]]], None]]:
    """Open a table for writing, and yield a function that writes a block and its results.

    ``results`` follow the columns of ``source``, whose scene columns are kept only if
    ``scene_too``; a column named like a result gives way to it. The file appears under its name
    when all is written.
    """
    row = FORMATS[format_name]
    if path == "-" and not row.is_text and (not row.pipes_out or sys.stdout.isatty()):
        place = "a terminal" if row.pipes_out else "standard output"
        raise UserError(f"{format_name} is not for {place}; expected -o FILE{row.endings[0]}")
    names_omitted = {*results, *(() if scene_too else SCENE)}
    source_names = [name for name in source.names if name not in names_omitted]
    headings = [heading(name) for name in (*source_names, *results)]
    with row.load().write(path, source.delimiter, headings) as put:

        def write(rows: Rows, solved: Mapping[str, NDArray[Any]]) -> None:
            late = [name for name in rows.late if name not in names_omitted]
            if late and not row.rows_vary:
                raise UserError(
                    f"line {rows.late[late[0]]} has the key {quoted(late[0])}, which no row before "
                    f"it has, and {row.noun} begins with its columns; write JSON "
                    "Lines, or give the key in the first row too"
                )
            names = [*source_names, *late]
            if row.rows_vary:
                names = [name for name in names if name in rows.columns]
            column_of = rows.columns.__getitem__ if row.keeps_arrays else rows.one_per_row
            passed_columns = [(name, column_of(name)) for name in names]
            put([*passed_columns, *((name, solved[name]) for name in results)])

        yield write


def may_wait(path: str) -> bool:
    """Return whether reading or writing ``path`` can block: standard input or output, a pipe.

    A thread that waits there would keep a terminated command from ending.
    """
    return path == "-" or (os.path.exists(path) and not os.path.isfile(path))


def _start(call: Callable[..., Any], *arguments: Any) -> Callable[[], Any]:
    """Call on a thread of its own; return a function that waits for the value, or raises the error.

    A table of one row has such threads, too: `_thread` is imported in no time."""
    outcome: list[Any] = []
    running = _thread.allocate_lock()
    running.acquire()

    def run() -> None:
        try:
            outcome.extend((call(*arguments), None))
        except BaseException as error:
            outcome.extend((None, error))
        running.release()

    def result() -> Any:
        with running:
            value, error = outcome
        if error is not None:
            raise error
        return value

    _thread.start_new_thread(run, ())
    return result


@contextmanager
def read_ahead(blocks: Iterable[Any]) -> Iterator[Iterator[Any]]:
    """Yield the blocks, each read by a thread while the one before it is in use.

    An error of reading is raised when its block is asked for. pyarrow and numpy release the GIL, so
    that a second processor is of use.
    """
    iterator = iter(blocks)
    waiting = _start(next, iterator, None)

    def read_blocks() -> Iterator[Any]:
        nonlocal waiting
        while (block := waiting()) is not None:
            waiting = _start(next, iterator, None)
            yield block

    try:
        yield read_blocks()
    finally:
        with suppress(BaseException):
            waiting()


@contextmanager
def write_behind(write: Callable[..., object]) -> Iterator[Callable[..., None]]:
    """Yield a function that has a thread call ``write``.

    Calls keep their order; more than one that waits gains nothing. An error of one is raised by the
    next call, or at the end.
    """
    waiting = _start(bool)

    def later(*arguments: Any) -> None:
        nonlocal waiting
        waiting()
        waiting = _start(write, *arguments)

    try:
        yield later
    finally:
        with suppress(BaseException):
            waiting()
    waiting()
