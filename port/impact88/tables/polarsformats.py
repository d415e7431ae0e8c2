"""Tables by polars (extra ``tables``): Parquet and Excel workbooks, in and out."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Iterable, Iterator
from typing import IO, Any

from ..errors import UserError, library
from ..files import decoding
from .textformats import BLOCK_ROWS, Block, Column, Columns, Table, heading_name

MAX_BYTES = 256_000_000  # that a file may decode to, or `MAX_RATIO` times its own size
MAX_RATIO = 20
MAX_HEADING_ROW = 50  # titles and remarks above the headings are some lines
MAX_SHEET_ROWS = 1_048_576  # of Excel


def polars() -> Any:
    """Return the module polars. Raises UserError without it."""
    return library("polars", "tables", "this format")


def _check_size(path: str, size: int) -> None:
    """Raise UserError for a file that decodes to far more than its own size."""
    if size > max(MAX_BYTES, MAX_RATIO * os.path.getsize(path)):
        raise UserError(f"decodes to {size:,} bytes; expected less than {MAX_BYTES:,}", path)


def read_parquet(path: str) -> Table:
    """Return the table in a Parquet file. Raises UserError."""
    pl = polars()
    with decoding(path, "is not a Parquet file"):
        lazy = pl.scan_parquet(path, glob=False)
        _check_size(path, 8 * lazy.select(pl.len()).collect().item() * len(lazy.collect_schema()))
        frame = lazy.collect()
    return Table(frame.columns, _blocks(frame, 1), path)


def _blocks(frame: Any, first: int) -> Iterator[Block]:
    """Yield a frame whose first row has a number as blocks: numbers as doubles, and all else as
    texts."""
    for start in range(0, frame.height, BLOCK_ROWS):
        part = frame.slice(start, BLOCK_ROWS)
        yield Block([*map(_column, part)], range(first + start, first + start + part.height))


def _column(series: Any) -> Column:
    """Return a series as an array if it holds numbers, else its texts."""
    if series.dtype.is_numeric():
        return series.cast(float).to_numpy()
    return series.cast(str, strict=False).to_list()


def read_excel(path: str) -> Table:
    """Return the table in the first sheet of a workbook: the first row that has a name of the scene
    has the headings.

    A column's cells are read as numbers, with all their bits, and what is left as text. Raises
    UserError."""
    polars()
    fastexcel = library("fastexcel", "tables", "an .xlsx")
    with decoding(path, "is not an .xlsx workbook"):
        with zipfile.ZipFile(path) as archive:
            _check_size(path, sum(member.file_size for member in archive.infolist()))
        book = fastexcel.read_excel(path)
        numbers, texts = (
            book.load_sheet(0, header_row=None, dtypes=kind, dtype_coercion="coerce").to_polars()
            for kind in ("float", "string")
        )
    for first, row in enumerate(texts.head(MAX_HEADING_ROW).rows(), 1):
        names = [cell or "" for cell in row]
        if any(heading_name(name)[0] for name in names):
            numbers, texts = numbers[first:], texts[first:]
            break
    else:
        raise UserError("has no row with names of a scene; expected headings such as UX", path)
    while not names[-1].strip():
        names.pop()
    columns = [
        number if number.null_count() == text.null_count() else number.cast(str).fill_null(text)
        for _, number, text in zip(names, numbers, texts, strict=False)
    ]
    return Table(names, _blocks(polars().DataFrame(columns), first + 1), path)


def frame_of(columns: Columns) -> Any:
    """Return columns as a frame; a number that is none is null, and so is an empty text, which
    polars would put in quotes."""
    series = []
    for name, column in columns.items():  # expressions hang after a damaged Parquet file
        if isinstance(column, list):
            column = [None if cell == "" else cell for cell in column]
        series.append(polars().Series(name, column, strict=False, nan_to_null=True))
    return polars().DataFrame(series)


def write_parquet(file: IO[bytes], blocks: Iterable[Columns]) -> None:
    """Write blocks as Parquet."""
    _concatenate(blocks).write_parquet(file)


def write_excel(file: IO[bytes], blocks: Iterable[Columns]) -> None:
    """Write blocks as a workbook; texts that begin with = stay texts. Raises UserError for more
    rows than a sheet has."""
    library("xlsxwriter", "tables", "an .xlsx")
    frame = _concatenate(blocks)
    if frame.height >= MAX_SHEET_ROWS:
        raise UserError(f"a sheet has {MAX_SHEET_ROWS:,} rows; expected fewer, or .parquet")
    frame.write_excel(file, autofilter=False)


def _concatenate(blocks: Iterable[Columns]) -> Any:
    """Return blocks as one frame."""
    return polars().concat(map(frame_of, blocks), how="vertical_relaxed")
