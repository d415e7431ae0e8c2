"""Excel workbooks (.xlsx, extra ``excel``): the first sheet, its first row that holds anything the
header. A number is taken by the digits that read back to the double stored; openpyxl writes 16
digits of one, so that the last bit may differ."""

import io
import math
import os
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError, library, quoted
from ..files import replacing
from ..names import SCENE
from .jsontext import plain
from .npztable import check_unpacked
from .rows import BLOCK_ROWS, Reader, Rows, Writer, scene_names, typed

LONGEST_CELL = 32_767
"""Characters that Excel has in a cell."""


def _names(lines: Iterator[tuple[int, tuple[Any, ...]]], where: str) -> list[str]:
    """The header: the first row that holds anything."""
    header = [_text(cell).strip() for _, row in islice(lines, 1) for cell in row]
    while header and not header[-1]:
        header.pop()
    if not header:
        raise UserError("its first sheet is empty; expected a header of names", where)
    return scene_names(header, where)


def _blocks(
    names: list[str], lines: Iterator[tuple[int, tuple[Any, ...]]], where: str
) -> Iterator[Rows]:
    first, width, trusted = 1, len(names), False
    while block := list(islice(lines, BLOCK_ROWS)):
        for number, row in block:
            if any(cell is not None for cell in row[width:]):
                raise UserError(f"row {number} has a cell in a column that has no name", where)
        if not trusted and any(None in row for _, row in block):
            _check_computed(where, width)
            trusted = True
        full = ((*row[:width], *[None] * (width - len(row))) for _, row in block)
        cells = zip(names, zip(*full, strict=True), strict=True)
        columns = (
            (
                n,
                [
                    _text(c) if not isinstance(c, bool) else c if n in SCENE else plain(c)
                    for c in cs
                ],
            )
            for n, cs in cells
        )
        yield Rows.of(first, len(block), columns, [number for number, _ in block])
        first += len(block)


def _check_computed(path: str, width: int) -> None:
    """Raise UserError where a formula has no value: libraries write formulas, spreadsheet programs
    compute them when they save."""
    openpyxl = library("openpyxl", "excel", "an .xlsx")
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
def read(path: str, form: str, encoding: str | None) -> Iterator[Reader]:
    """Open a workbook. Raises UserError if it is not one, or unpacks to more than it may."""
    openpyxl = library("openpyxl", "excel", "an .xlsx")
    with _parsing(path):
        with zipfile.ZipFile(path) as archive:
            check_unpacked(archive.infolist(), os.path.getsize(path), path)
        book = openpyxl.load_workbook(path, read_only=True, data_only=True)
        rows = book.worksheets[0].iter_rows(values_only=True)

    def filled() -> Iterator[tuple[int, tuple[Any, ...]]]:
        with _parsing(path):
            for number, row in enumerate(rows, 1):
                if any(cell is not None for cell in row):
                    yield number, row

    lines = filled()
    try:
        names = _names(lines, path)
        yield Reader(names, _blocks(names, lines, path))
    finally:
        book.close()


@contextmanager
def _parsing(path: str) -> Iterator[None]:
    """Whatever openpyxl raises on arbitrary bytes is a UserError."""
    try:
        yield
    except OSError as error:
        raise UserError(f"cannot be read: {error.strerror or error}", path) from None
    except UserError:
        raise
    except Exception as error:
        raise UserError(f"is not an .xlsx workbook: {quoted(str(error))}", path) from None


class _ExcelWriter(Writer):
    kind = "a workbook"

    def __init__(self, sheet: Any, *columns: Any) -> None:
        super().__init__(*columns)
        self._sheet = sheet
        self._rows = 1
        sheet.append([_cell(text) for text in self.headings])

    def put(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None:
        self._rows += rows.count
        if self._rows > 1_048_576:
            raise UserError("a sheet has at most 1,048,576 rows; expected to write CSV")
        columns = [typed(name, rows.one_per_row(name)) for name in self.kept]
        columns += [results[name] for name in self.results]
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
def write(path: str, form: str, delimiter: str, *columns: Any) -> Iterator[Writer]:
    """Write a workbook."""
    openpyxl = library("openpyxl", "excel", "an .xlsx")
    book = openpyxl.Workbook(write_only=True)
    writer = _ExcelWriter(book.create_sheet("impact88"), *columns)
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
