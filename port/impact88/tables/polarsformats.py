"""Tables by polars (extra ``tables``): Parquet and Excel workbooks, in and out."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Iterable, Iterator, Mapping
from typing import IO, Any

from ..errors import UserError, library
from ..files import decoding
from .textformats import BLOCK_ROWS, Block, Column, Table, check_headings, heading_name

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
        names = lazy.collect_schema().names()
        rows = lazy.select(pl.len()).collect().item()
    _check_size(path, 8 * rows * len(names))
    return _table_of(lazy, names, path, 1)


def _table_of(lazy: Any, names: list[str], path: str, first: int) -> Table:
    """Return a lazy frame as a table whose first row has a number: numbers as doubles, and all else
    as texts."""
    pl = polars()
    numeric = pl.selectors.numeric()
    texts = (~numeric).cast(pl.String, strict=False)
    lazy = lazy.with_columns(numeric.cast(pl.Float64), texts)

    def blocks() -> Iterator[Block]:
        number = first
        while True:
            with decoding(path, "cannot be decoded"):
                frame = lazy.slice(number - first, BLOCK_ROWS).collect()
            if not frame.height:
                return
            yield Block(dict(zip(names, frame, strict=True)), range(number, number + frame.height))
            number += frame.height

    return Table(check_headings(names, path), blocks(), path)


def read_excel(path: str) -> Table:
    """Return the table in the first sheet of a workbook: the row with most of the scene's names
    among the first has the headings.

    A column's cells are read as numbers, with all their bits, and what is left as text. Raises
    UserError."""
    pl = polars()
    fastexcel = library("fastexcel", "tables", "an .xlsx")

    def load(kind: str, **options: Any) -> Any:
        with decoding(path, "is not an .xlsx workbook"):
            return book.load_sheet(0, dtypes=kind, header_row=None, **options).to_polars()

    with decoding(path, "is not an .xlsx workbook"):
        with zipfile.ZipFile(path) as archive:
            _check_size(path, sum(member.file_size for member in archive.infolist()))
        book = fastexcel.read_excel(path)
    rows = [[cell or "" for cell in row] for row in load("string", n_rows=MAX_HEADING_ROW).rows()]
    counts = [sum(bool(heading_name(cell)[0]) for cell in row) for row in rows]
    if not any(counts):
        raise UserError("has no row with names of a scene; expected headings such as UX", path)
    place = counts.index(max(counts))
    headings = rows[place]
    while not headings[-1].strip():
        headings.pop()
    names = check_headings(headings, path)
    options = {"skip_rows": place + 1, "use_columns": [*range(len(names))], "column_names": names}
    numbers = load("float", dtype_coercion="coerce", **options)
    texts = load("string", dtype_coercion="coerce", **options)
    frame = pl.DataFrame(map(_merge_cells, numbers, texts))
    return _table_of(frame.lazy(), names, path, place + 2)


def _merge_cells(numbers: Any, texts: Any) -> Any:
    """Return a sheet's column: numbers, or texts where a cell is one."""
    if numbers.null_count() == texts.null_count():
        return numbers
    return numbers.cast(polars().String).fill_null(texts)


def frame_of(columns: Mapping[str, Column]) -> Any:
    """Return columns as a frame; a number that is none is null, and so is an empty text, which
    polars would put in quotes."""
    selectors = polars().selectors
    frame = polars().DataFrame(dict(columns), strict=False)
    return frame.with_columns(
        selectors.float().fill_nan(None), selectors.string().replace("", None)
    )


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
    return polars().concat(map(frame_of, blocks), how="vertical_relaxed")
