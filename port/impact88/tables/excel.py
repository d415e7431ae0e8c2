"""Excel workbooks (.xlsx, extra ``excel``): the first sheet, its first row that holds anything the
header. A number is taken by the digits that read back to the double stored; openpyxl writes 16
digits of one, so that the last bit may differ."""

from __future__ import annotations

import io
import math
import os
import zipfile
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import chain, islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError, quoted
from ..files import replacing
from ..names import SCENE
from .jsontext import plain
from .npzfile import check_unpacked
from .rows import (
    BLOCK_ROWS,
    Column,
    Reader,
    Rows,
    Writer,
    heading,
    one_per_row,
    refuse_late,
    scene_names,
    typed,
)

LONGEST_CELL = 32_767
"""Characters that Excel has in a cell."""
MOST_ROWS = 1_048_576


def _library() -> Any:
    try:
        import openpyxl
    except ImportError:
        raise UserError("an .xlsx needs openpyxl; pip install 'impact88[excel]'") from None
    return openpyxl


class _ExcelReader:
    delimiter = ","

    def __init__(self, rows: Iterator[tuple[Any, ...]], where: str) -> None:
        self.total: int | None = None
        self._trusted = False
        self._where = where
        self._lines = enumerate(rows, 1)
        filled = (row for _, row in self._lines if any(cell is not None for cell in row))
        header = [_text(cell).strip() for cell in next(filled, ())]
        while header and not header[-1]:
            header.pop()
        if not header:
            raise UserError("its first sheet is empty; expected a header of names", where)
        self.names = scene_names(header)
        twice = [name for name in self.names if self.names.count(name) > 1]
        if twice:
            raise UserError(f"has two columns named {quoted(twice[0])}", where)

    def position(self) -> int:
        return 0

    def __iter__(self) -> Iterator[Rows]:
        first, width = 1, len(self.names)
        filled = (one for one in self._lines if any(cell is not None for cell in one[1]))
        while block := list(islice(filled, BLOCK_ROWS)):
            for number, row in block:
                if any(cell is not None for cell in row[width:]):
                    raise UserError(
                        f"row {number} has a cell in a column that has no name", self._where
                    )
            if not self._trusted and any(None in row for _, row in block):
                _check_computed(self._where, width)
                self._trusted = True
            full = ((*row[:width], *[None] * (width - len(row))) for _, row in block)
            cells = zip(*full, strict=True)
            columns: dict[str, Column] = {}
            others: dict[str, Column] = {}
            for name, column in zip(self.names, cells, strict=True):
                if name in SCENE:
                    columns[name] = [c if isinstance(c, bool) else _text(c) for c in column]
                else:
                    others[name] = [plain(c) if isinstance(c, bool) else _text(c) for c in column]
            yield Rows(first, len(block), columns, others, [number for number, _ in block])
            first += len(block)


def _check_computed(path: str, width: int) -> None:
    """Raise UserError where a formula has no value: libraries write formulas, spreadsheet programs
    compute them when they save."""
    openpyxl = _library()
    books = [openpyxl.load_workbook(path, read_only=True, data_only=only) for only in (True, False)]
    try:
        sheets = (book.worksheets[0].iter_rows(max_col=width) for book in books)
        for values, formulas in zip(*sheets, strict=True):
            for value, formula in zip(values, formulas, strict=True):
                if value.value is None and formula.data_type == "f":
                    raise UserError(
                        f"cell {formula.coordinate} has a formula that was never computed; "
                        "expected a workbook saved by a spreadsheet program",
                        path,
                    )
    finally:
        for book in books:
            book.close()


def _text(cell: Any) -> str:
    """What stands in a cell: a number by its shortest digits."""
    if cell is None:
        return ""
    return repr(cell).removesuffix(".0") if isinstance(cell, float) else str(cell)


@contextmanager
def read_excel(path: str) -> Iterator[Reader]:
    """Open a workbook. Raises UserError if it is none, or unpacks to more than it may."""
    openpyxl = _library()
    try:
        with zipfile.ZipFile(path) as archive:
            check_unpacked(archive.infolist(), os.path.getsize(path), path)
        book = openpyxl.load_workbook(path, read_only=True, data_only=True)
        rows = book.worksheets[0].iter_rows(values_only=True)
        rows = chain([next(rows, ())], rows)
    except OSError as error:
        raise UserError(f"cannot be read: {error.strerror or error}", path) from None
    except UserError:
        raise
    except Exception as error:  # whatever its parsers raise on arbitrary bytes
        raise UserError(f"is no .xlsx workbook: {quoted(str(error))}", path) from None
    try:
        yield _ExcelReader(_checked(rows, path), path)
    finally:
        book.close()


def _checked(rows: Iterator[tuple[Any, ...]], path: str) -> Iterator[tuple[Any, ...]]:
    try:
        yield from rows
    except Exception as error:
        raise UserError(f"is no .xlsx workbook: {quoted(str(error))}", path) from None


class _ExcelWriter:
    def __init__(
        self, sheet: Any, kept: Sequence[str], results: Sequence[str], dropped: Collection[str]
    ) -> None:
        self._sheet = sheet
        self._kept = kept
        self._results = results
        self._dropped = dropped
        self._rows = 1
        sheet.append([_cell(heading(name)) for name in (*kept, *results)])

    def write(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None:
        refuse_late(rows, self._dropped, "a workbook")
        self._rows += rows.count
        if self._rows > MOST_ROWS:
            raise UserError(f"a sheet has at most {MOST_ROWS:,} rows; expected to write CSV")
        columns = [typed(name, one_per_row(rows, name)) for name in self._kept]
        columns += [results[name] for name in self._results]
        cells = [c.tolist() if isinstance(c, np.ndarray) else c for c in columns]
        for row in zip(*cells, strict=True):
            self._sheet.append([_cell(cell) for cell in row])


def _cell(value: Any) -> Any:
    """What Excel can hold of a value: no number is an empty cell, no text is a formula."""
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else str(value)
    if isinstance(value, str):
        value = "".join(c if c.isprintable() or c in "\n\t" else "\ufffd" for c in value)
        return value[:LONGEST_CELL] or None
    return value


@contextmanager
def write_excel(
    path: str, kept: Sequence[str], results: Sequence[str], dropped: Collection[str]
) -> Iterator[Writer]:
    """Write a workbook, see `tables.table.open_writer`."""
    openpyxl = _library()
    if path == "-":
        raise UserError("xlsx is not for standard output; expected -o FILE.xlsx")
    book = openpyxl.Workbook(write_only=True)
    writer = _ExcelWriter(book.create_sheet("impact88"), kept, results, dropped)
    with replacing(path, "wb") as file:
        packed = io.BytesIO()  # a zip file that cannot be finished complains on stderr
        try:
            try:
                yield writer
            finally:  # and so does a sheet left open
                for sheet in book.worksheets:
                    sheet.close()
            book.save(packed)
        except OSError as error:  # openpyxl's own temporary files have no name of the user's
            raise UserError(f"cannot be written: {error.strerror or error}", path) from None
        file.write(packed.getbuffer())
