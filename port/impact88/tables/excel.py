"""Excel workbooks (.xlsx, extra ``excel``). The header is the row with most names of a scene among
the first rows of all sheets, the first of several; where no row has any, the first row that holds
anything. What stands above it, and other sheets, are told. A number is taken by the digits that
read back to the double stored; openpyxl writes 16 digits of one, so that the last bit may differ.
"""

import datetime
import io
import math
import shutil
import zipfile
from collections.abc import Generator, Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager
from itertools import islice, product
from typing import Any, NamedTuple

import numpy as np

from ..errors import UserError, library, quoted
from ..files import decoding, replacing
from ..names import SCENE
from .budget import EMPTY_CELL, Budget
from .cells import Merged, plain, typed_cells
from .rows import (
    BLOCK_CELLS,
    BLOCK_ROWS,
    Column,
    Named,
    Put,
    Reader,
    Rows,
    names_among,
    scene_names,
)

MAX_HEADER_ROW = 50  # the header is sought among these; titles and remarks are some lines
MAX_SHEETS = 100  # those in which a table is sought
MAX_SHEETS_LISTED = 5  # of those that are not read
MAX_HIDDEN_LISTED = 5  # rows
LONGEST_CELL = 32_767
"""Characters that Excel has in a cell."""
WRITTEN = datetime.datetime(1988, 1, 1)
"""Date of every part of a workbook, so that one table is the same bytes whenever it is written."""

_Lines = Generator[tuple[int, tuple[Any, ...]], None, None]


class _Header(NamedTuple):
    """Place where a table begins: the sheet's place and title, the header's row and its texts;
    ``others``: titles of further sheets that hold anything."""

    place: int
    title: str
    row: int
    names: list[str]
    others: list[str]


class _Marks(NamedTuple):
    """Facts that a sheet gives of its cells beside values: hidden rows, and by (row, column) the
    first cell of those that each other merged cell belongs to."""

    hidden: list[int]
    merged: dict[tuple[int, int], str]


@contextmanager
def _open_workbook(path: str, budget: Budget) -> Iterator[Any]:
    """The workbook, its formulas by their values. Raises UserError."""
    openpyxl = library("openpyxl", "excel", "an .xlsx")
    with ExitStack() as stack:
        with decoding(path, "is not an .xlsx workbook"):
            with zipfile.ZipFile(path) as archive:
                budget.take(sum(member.file_size for member in archive.infolist()))
            book = openpyxl.load_workbook(path, read_only=True, data_only=True)
            stack.enter_context(closing(book))
        yield book


def _lines(sheet: Any, path: str, first: int = 1) -> _Lines:
    """Yield a sheet's rows that hold anything, with their numbers. Raises UserError."""
    with decoding(path, "is not an .xlsx workbook"):
        sheet.reset_dimensions()  # a row ends with its own last cell, wherever others have theirs
        rows = enumerate(sheet.iter_rows(min_row=first, values_only=True), first)
    while True:
        with decoding(path, "is not an .xlsx workbook"):
            number, row = next(rows, (0, ()))
        if not number:
            return
        if any(cell not in (None, "") for cell in row):
            yield number, row


def _header(book: Any, path: str, results: bool) -> _Header:
    """Find the header. Raises UserError for a book that holds nothing."""
    best: _Header | None = None
    max_count, other_sheets = -1, []
    for place, sheet in enumerate(book.worksheets[:MAX_SHEETS]):
        with closing(_lines(sheet, path)) as lines:
            rows = list(islice(lines, MAX_HEADER_ROW))
        other_sheets += [sheet.title] if rows else []
        for number, row in rows:
            texts = [_text(cell).strip() for cell in row]
            while texts and not texts[-1]:
                texts.pop()
            count = names_among(texts, results)
            if count > max_count:
                max_count, best = count, _Header(place, sheet.title, number, texts, [])
    if best is None:
        raise UserError("holds nothing; expected a header of names", path)
    return best._replace(others=[title for title in other_sheets if title != best.title])


def _blocks(
    names: list[str], lines: _Lines, where: str, marks: _Marks, budget: Budget
) -> Iterator[Rows]:
    width = len(names)
    while block := list(islice(lines, max(1, min(BLOCK_ROWS, BLOCK_CELLS // width)))):
        for number, row in block:
            if any(cell is not None for cell in row[width:]):
                raise UserError(f"row {number} has a cell in a column that has no name", where)
        budget.take(EMPTY_CELL * sum(width - len(row) for _, row in block if len(row) < width))
        if marks.merged:
            block = [(number, _with_merged(number, row, width, marks)) for number, row in block]
        full = ((*row[:width], *[None] * (width - len(row))) for _, row in block)
        columns: dict[str, Column] = {}
        for name, cells in zip(names, zip(*full, strict=True), strict=True):
            keep = bool if name in SCENE else ()  # a truth value is no number
            columns[name] = [cell if isinstance(cell, keep) else _text(cell) for cell in cells]
        yield Rows(len(block), columns, [number for number, _ in block])


def _marks(path: str, part: str, header: _Header, budget: Budget) -> _Marks:
    """Read a sheet's marks. Raises UserError where a formula has no value: libraries write
    formulas, spreadsheet programs compute them when they save."""
    from xml.etree.ElementTree import iterparse

    from openpyxl.utils.cell import range_boundaries

    marks = _Marks([], {})
    with decoding(path, "is not an .xlsx workbook"), zipfile.ZipFile(path) as archive:
        with archive.open(part) as sheet:
            if not any(mark in piece for piece in _pieces(sheet) for mark in _MARKS):
                return marks
        number = 0
        with archive.open(part) as sheet:
            for event, element in iterparse(sheet, ("start", "end")):
                tag = element.tag.rpartition("}")[2]
                if event == "start":
                    if tag == "row":
                        number = int(element.get("r", number + 1))
                        if element.get("hidden") in ("1", "true") and number > header.row:
                            marks.hidden.append(number)
                    continue
                if tag == "mergeCell":
                    left, top, right, bottom = range_boundaries(element.get("ref"))
                    budget.take(EMPTY_CELL * (right - left + 1) * (bottom - top + 1))
                    holder = element.get("ref").partition(":")[0]
                    cells = product(range(top, bottom + 1), range(left, right + 1))
                    marks.merged.update(dict.fromkeys(cells, holder))
                elif tag == "c" and number > header.row and _is_uncomputed(element):
                    raise UserError(
                        f"cell {element.get('r')} has a formula that was never computed; expected "
                        "a workbook saved by a spreadsheet program",
                        path,
                    )
                if tag in ("row", "mergeCell"):
                    element.clear()
    return marks


_MARKS = (b"hidden", b"mergeCell ", b"<f", b":f>", b":f ")


def _pieces(file: Any) -> Iterator[bytes]:
    """Yield the bytes of a file, each piece with the end of the one before."""
    end = b""
    while piece := file.read(1 << 20):
        yield end + piece
        end = piece[-16:]


def _is_uncomputed(cell: Any) -> bool:
    """Return whether a cell has a formula and no value."""
    texts = {child.tag.rpartition("}")[2]: child.text for child in cell}
    return "f" in texts and not texts.get("v")


def _with_merged(number: int, row: tuple[Any, ...], width: int, marks: _Marks) -> tuple[Any, ...]:
    """The row with its empty cells that are merged with others told from the rest."""
    full = (*row, *[None] * (width - len(row)))
    return tuple(
        Merged(holder) if cell is None and (holder := marks.merged.get((number, column))) else cell
        for column, cell in enumerate(full, 1)
    )


def _text(cell: Any) -> str:
    if isinstance(cell, Merged):
        return cell
    return repr(cell).removesuffix(".0") if isinstance(cell, float) else plain(cell)


@contextmanager
def read(path: str, encoding: str | None, results: bool) -> Iterator[Reader]:
    """Open a workbook. Raises UserError if it is not one, or unpacks to more than it may."""
    budget = Budget(path)
    with _open_workbook(path, budget) as book:
        header = _header(book, path, results)
        budget.check_shape(len(header.names))
        names = scene_names(header.names, path, results)
        sheet = book.worksheets[header.place]
        marks = _marks(path, sheet._worksheet_path, header, budget)
        with closing(_lines(sheet, path, header.row + 1)) as lines:
            reader = Reader(names, _blocks(names, lines, path, marks, budget))
            if marks.hidden:
                reader.remarks.append(_hidden_words(marks.hidden))
            reader.place = {"sheet": header.title, "row": header.row}
            if header.place or header.row > 1 or header.others:
                read = f"sheet {quoted(header.title)} is read, its headings in row {header.row}"
                titles = ", ".join(map(quoted, header.others[:MAX_SHEETS_LISTED]))
                ellipsis = ", ..." if len(header.others) > MAX_SHEETS_LISTED else ""
                reader.remarks.append(read + (f"; not read: {titles}{ellipsis}" if titles else ""))
            yield reader


def _hidden_words(rows: list[int]) -> str:
    first = ", ".join(map(str, rows[:MAX_HIDDEN_LISTED]))
    ellipsis = ", ..." if len(rows) > MAX_HIDDEN_LISTED else ""
    are = "s {} are" if len(rows) > 1 else " {} is"
    return f"row{are.format(first + ellipsis)} hidden in the sheet, and read like the others"


class _Archive(zipfile.ZipFile):
    """A zip archive whose bytes depend on nothing but what is written into it."""

    def _entry(self, name: str) -> zipfile.ZipInfo:
        entry = zipfile.ZipInfo(name, WRITTEN.timetuple()[:6])
        entry.compress_type = zipfile.ZIP_DEFLATED
        return entry

    def writestr(  # type: ignore[override]
        self, name: str, data: str | bytes
    ) -> None:
        """Write a part without the date of today."""
        super().writestr(self._entry(name), data)

    def write(self, filename: Any, arcname: Any = None, *args: Any, **keywords: Any) -> None:
        """Copy a file into the archive without its date."""
        with open(filename, "rb") as part, self.open(self._entry(arcname), "w") as entry:
            shutil.copyfileobj(part, entry)


def _value(value: Any) -> Any:
    """The value as Excel can hold it: a NaN is an empty cell, a character that is not one of XML's
    is replaced, and a longer text than a cell holds is cut."""
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else str(value)
    if isinstance(value, str):
        value = "".join(c if c.isprintable() or c in "\n\t" else "\ufffd" for c in value)
        return value[:LONGEST_CELL] or None
    return value


@contextmanager
def write(path: str, delimiter: str, headings: Sequence[str]) -> Iterator[Put]:
    """Write a workbook."""
    openpyxl = library("openpyxl", "excel", "an .xlsx")
    book = openpyxl.Workbook(write_only=True)
    book.properties.created = book.properties.modified = WRITTEN
    sheet = book.create_sheet("impact88")

    def cell(value: Any) -> Any:
        """Return a cell of the value; a text that looks like a formula or an error stays a text."""
        value = _value(value)
        if not (isinstance(value, str) and value.startswith(("=", "#"))):
            return value
        text = openpyxl.cell.WriteOnlyCell(sheet, value)
        text.data_type = "s"
        text.quotePrefix = True  # a spreadsheet program keeps it a text when it is edited
        return text

    sheet.append([cell(text) for text in headings])
    count = 1

    def put_block(columns: Named) -> None:
        nonlocal count
        cells = (typed_cells(*column) for column in columns)
        rows = list(
            zip(*(c.tolist() if isinstance(c, np.ndarray) else c for c in cells), strict=True)
        )
        count += len(rows)
        if count > 1_048_576:
            raise UserError("a sheet has at most 1,048,576 rows; write CSV")
        for row in rows:
            sheet.append([cell(value) for value in row])

    with replacing(path, "wb") as file:
        archive = io.BytesIO()  # a zip file that cannot be finished complains on stderr
        try:
            try:
                yield put_block
            finally:  # and so does a sheet left open
                sheet.close()
            openpyxl.writer.excel.ExcelWriter(book, _Archive(archive, "w")).save()
        except OSError as error:  # openpyxl's own temporary files have no name of the user's
            raise UserError(f"cannot be written: {error.strerror or error}", path) from None
        file.write(archive.getbuffer())
