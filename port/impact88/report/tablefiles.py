"""A report's tables for other programs: as CSV rows, and as a workbook with a sheet for each."""

from collections.abc import Iterator, Sequence

from ..errors import UserError
from ..files import replacing
from .findings import Table


def as_rows(tables: Sequence[Table]) -> Iterator[Sequence[str]]:
    """The tables below each other: title, headings, rows, an empty row."""
    for table in tables:
        yield [table.title]
        yield table.headings
        yield from table.rows
        yield []


def write_workbook(path: str, tables: Sequence[Table]) -> None:
    """Write a sheet for each table; cells that are numbers are numbers. Raises UserError."""
    try:
        import openpyxl
    except ImportError:
        raise UserError("an .xlsx needs openpyxl; pip install 'impact88[excel]'") from None
    book = openpyxl.Workbook()
    book.remove(book.active)
    for table in tables:
        sheet = book.create_sheet(table.title[:31])
        for row in (table.headings, *table.rows):
            sheet.append([_cell(text) for text in row])
    with replacing(path, "wb") as file:
        book.save(file)


def _cell(text: str) -> float | str | None:
    try:
        return float(text)
    except ValueError:
        return text or None
