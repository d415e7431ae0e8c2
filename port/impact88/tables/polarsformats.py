"""Tables by polars (extra ``tables``): Parquet and Excel workbooks, in and out."""

from __future__ import annotations

import math
import os
import zipfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import IO, Any

import numpy as np

from ..errors import UserError, library, quoted
from ..files import decoding
from .textformats import BLOCK_ROWS, Block, Column, Table, check_headings, heading_name

MAX_BYTES = 256_000_000  # that a file may decode to, or `MAX_RATIO` times its own size
MAX_RATIO = 20
MAX_HEADING_ROW = 50  # titles and remarks above the headings are some lines
MAX_SHEETS = 20  # in which headings are sought
MAX_SHEET_ROWS = 1_048_576  # of Excel


def polars() -> Any:
    """Return the module polars. Raises UserError without it."""
    return library("polars", "tables", "this format")


def check_size(path: str, size: int) -> None:
    """Raise UserError for a file that decodes to far more than its own size."""
    if size > max(MAX_BYTES, MAX_RATIO * os.path.getsize(path)):
        raise UserError(f"decodes to {size:,} bytes; expected less than {MAX_BYTES:,}", path)


def read_parquet(path: str) -> Table:
    """Return the table in a Parquet file. Raises UserError."""
    pl = polars()
    with decoding(path, "is not a Parquet file"):
        lazy = pl.scan_parquet(path, glob=False)
        names = lazy.collect_schema().names()
        rows = lazy.select(pl.len()).collect().item()
    check_headings(names, path)
    check_size(path, 8 * rows * len(names))

    def blocks() -> Iterator[Block]:
        for at in range(0, rows, BLOCK_ROWS):
            with decoding(path, "is not a Parquet file"):
                frame = lazy.slice(at, BLOCK_ROWS).collect()
            yield Block({name: _column(frame[name]) for name in names}, _numbers(at + 1, frame))

    return Table(names, blocks(), path)


def _numbers(first: int, frame: Any) -> range:
    """Return the numbers of a frame's rows."""
    return range(first, first + frame.height)


def _column(series: Any) -> Column:
    """Return a series as an array if it holds numbers, else its texts."""
    if series.dtype.is_numeric():
        return series.cast(polars().Float64).to_numpy()
    return series.cast(polars().String, strict=False)


def read_excel(path: str) -> Table:
    """Return the table in a workbook: the row with most of the scene's names among the first rows
    of its sheets has the headings.

    A column's cells are read as numbers, with all their bits, and what is left as text."""
    polars()
    fastexcel = library("fastexcel", "tables", "an .xlsx")
    with decoding(path, "is not an .xlsx workbook"):
        with zipfile.ZipFile(path) as archive:
            check_size(path, sum(member.file_size for member in archive.infolist()))
        book = fastexcel.read_excel(path)
        sheets = book.sheet_names[:MAX_SHEETS]
        options: dict[str, Any] = {"header_row": None, "n_rows": MAX_HEADING_ROW}
        rows = [
            (sheet, at, [str(cell or "").strip() for cell in row])
            for sheet in sheets
            for at, row in enumerate(
                book.load_sheet(sheet, dtypes="string", **options).to_polars().rows()
            )
        ]
    sheet, at, texts = max(rows, key=lambda row: _count_names(row[2]), default=("", 0, []))
    if not _count_names(texts):
        raise UserError("has no row with names of a scene; expected headings such as UX", path)
    while not texts[-1]:
        texts.pop()
    names = check_headings(texts, path)
    options = {
        "header_row": None,
        "skip_rows": at + 1,
        "use_columns": list(range(len(names))),
        "column_names": names,
        "dtype_coercion": "coerce",
    }
    with decoding(path, "is not an .xlsx workbook"):
        numbers = book.load_sheet(sheet, dtypes="float", **options).to_polars()
        words = book.load_sheet(sheet, dtypes="string", **options).to_polars()
    remarks = [f"sheet {quoted(sheet)}, headings in row {at + 1}"] if at or len(sheets) > 1 else []

    def blocks() -> Iterator[Block]:
        for start in range(0, words.height, BLOCK_ROWS):
            parts = numbers.slice(start, BLOCK_ROWS), words.slice(start, BLOCK_ROWS)
            columns = {n: _merge_cells(parts[0][n], parts[1][n]) for n in names}
            yield Block(columns, _numbers(at + 2 + start, parts[1]))

    return Table(names, blocks(), path, remarks=tuple(remarks))


def _count_names(texts: Sequence[str]) -> int:
    """Return how many texts are headings of quantities."""
    return sum(bool(heading_name(text)[0]) for text in texts)


def _merge_cells(numbers: Any, texts: Any) -> Column:
    """Return a sheet's column: numbers, or texts where a cell is one."""
    if numbers.null_count() == texts.null_count():
        return numbers.fill_null(float("nan")).to_numpy()
    pairs = zip(numbers.to_list(), texts.to_list(), strict=True)
    return [text if number is None else repr(number) for number, text in pairs]


def _is_float(column: Column) -> bool:
    """Return True for an array of floats."""
    return isinstance(column, np.ndarray) and column.dtype.kind == "f"


def frame_of(columns: Mapping[str, Column]) -> Any:
    """Return columns as a frame; a number that is none is null, and so is an empty text, which
    polars would put in quotes."""
    pl = polars()
    series = []
    for name, column in columns.items():
        cells = (
            column.tolist()
            if isinstance(column, np.ndarray) and column.dtype.kind in "UO"
            else column
        )
        if isinstance(cells, list):
            cells = [None if cell == "" else cell for cell in cells]
        series.append(pl.Series(name, cells, strict=False, nan_to_null=_is_float(column)))
    return pl.DataFrame(series)


def frame_of_texts(columns: Mapping[str, Column]) -> Any:
    """Return columns as a frame whose numbers are written in the digits of Python's floats."""
    frame = frame_of(columns)
    for name, column in columns.items():
        size = np.abs(column) if _is_float(column) else np.zeros(1)
        # polars writes these in another notation
        if np.any((size >= 1e16) | ((size < 1e-4) & (size > 0))):
            texts = [None if math.isnan(x) else repr(x) for x in column.tolist()]
            frame = frame.with_columns(polars().Series(name, texts))
    return frame


def write_parquet(file: IO[bytes], blocks: Iterable[Mapping[str, Column]]) -> None:
    """Write blocks as Parquet."""
    _concatenate(blocks).write_parquet(file)


def write_excel(file: IO[bytes], blocks: Iterable[Mapping[str, Column]]) -> None:
    """Write blocks as a workbook; texts that begin with = stay texts. Raises UserError for more
    rows than a sheet has."""
    library("xlsxwriter", "tables", "an .xlsx")
    frame = _concatenate(blocks)
    if frame.height >= MAX_SHEET_ROWS:
        raise UserError(f"a sheet has {MAX_SHEET_ROWS:,} rows; expected fewer, or .parquet")
    frame.write_excel(file, autofilter=False)


def _concatenate(blocks: Iterable[Mapping[str, Column]]) -> Any:
    """Return blocks as one frame."""
    return polars().concat([frame_of(columns) for columns in blocks], how="vertical_relaxed")
