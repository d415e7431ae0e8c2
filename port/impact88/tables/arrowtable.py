"""Parquet: typed columns, read and written a block at a time.

Needs pyarrow (extra ``arrow``). Numbers are taken as they are stored, texts and decimals by their
digits. What was text in a CSV becomes doubles where it is a scene's, and stays text elsewhere.
"""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import Any

import numpy as np

from ..errors import UserError, library
from ..files import ESCAPED, decoding, replacing
from ..names import SCENE
from .cells import typed_cells
from .rows import (
    BLOCK_ROWS,
    ArrowColumn,
    ArrowTexts,
    Column,
    Named,
    Put,
    Reader,
    Rows,
    scene_names,
)


def _blocks(pa: Any, names: Sequence[str], batches: Iterable[Any], where: str) -> Iterator[Rows]:
    for batch in batches:
        if not (count := batch.num_rows):
            continue
        rows = Rows(count, {})
        for name, array in zip(names, batch.columns, strict=True):
            in_scene = name in SCENE
            rows.columns[name] = (
                _scene_column(pa, rows, name, array, where) if in_scene else ArrowColumn(array)
            )
        yield rows


def _scene_column(pa: Any, rows: Rows, name: str, array: Any, where: str) -> Column:
    if pa.types.is_dictionary(array.type):
        array = array.dictionary_decode()
    kind = array.type
    if pa.types.is_integer(kind) or pa.types.is_floating(kind):
        if array.null_count:
            missing = np.flatnonzero(array.is_null().to_numpy(zero_copy_only=False)).tolist()
            if name != "M":
                rows.bad += [(index, name, "is empty; expected a number") for index in missing]
            array = array.cast(pa.float64()).fill_null(6.0 if name == "M" else np.nan)
        values: Column = array.to_numpy(zero_copy_only=False)
        return values
    texts = (pa.types.is_string, pa.types.is_large_string, pa.types.is_decimal)
    if not any(is_kind(kind) for is_kind in texts):
        raise UserError(f"{name} holds {kind}; expected numbers or their texts", where)
    return ArrowTexts(array.cast(pa.string()).fill_null(""))


@contextmanager
def read(path: str, form: str, encoding: str | None, results: bool) -> Iterator[Reader]:
    """Open a Parquet file. Raises UserError if it is not one."""
    pa = library("pyarrow", "arrow", "this format")
    from pyarrow import parquet

    with ExitStack() as stack:
        with decoding(path):
            file = stack.enter_context(parquet.ParquetFile(path, memory_map=True))
            headings, count = file.schema_arrow.names, file.metadata.num_rows
            batches = file.iter_batches(BLOCK_ROWS, use_threads=pa.cpu_count() > 1)
        names = scene_names(headings, path, results)
        yield Reader(names, _blocks(pa, names, _validate_each(batches, path), path), count)


def _validate_each(batches: Iterable[Any], path: str) -> Iterator[Any]:
    """Yield the batches, each checked whole. Raises UserError for what the library refuses."""
    batches = iter(batches)
    while True:
        with decoding(path):
            batch = next(batches, None)
            if batch is None:
                return
            batch.validate(full=True)
        yield batch


def _encodable(text: str) -> str:
    """A text with escapes for lone surrogates, which JSON has and Arrow's UTF-8 has not."""
    return text if text.isascii() else text.encode("utf-8", ESCAPED).decode("utf-8")


@contextmanager
def write(path: str, form: str, delimiter: str, headings: Sequence[str]) -> Iterator[Put]:
    """Write a Parquet file, whose schema is the first block's."""
    pa = library("pyarrow", "arrow", "this format")
    from pyarrow import parquet

    headings = list(map(_encodable, headings))
    writer_and_schema: list[Any] = []

    def array(name: str, column: Column) -> Any:
        if isinstance(column, ArrowColumn) and (type(column) is ArrowColumn or name not in SCENE):
            return column.array
        cells = typed_cells(name, column)
        if not isinstance(cells, np.ndarray):
            cells = list(map(_encodable, cells))
        # whole numbers too: where one is missing, a later block of them is of doubles
        return pa.array(cells, pa.float64() if name in SCENE else None)

    def writer(schema: Any) -> Any:
        # measured numbers hardly repeat: a dictionary of them takes thrice the time and room
        repeating = [field.name for field in schema if not pa.types.is_floating(field.type)]
        return parquet.ParquetWriter(file, schema, use_dictionary=repeating)

    def put(columns: Named) -> None:
        table = pa.table([array(*column) for column in columns], headings)
        if not writer_and_schema:
            writer_and_schema.extend((writer(table.schema), table.schema))
        writer_and_schema[0].write_table(table.cast(writer_and_schema[1]))

    with replacing(path, "wb") as file:
        yield put
        if not writer_and_schema:  # no row at all
            writer_and_schema.append(writer(pa.schema([(name, pa.float64()) for name in headings])))
        writer_and_schema[0].close()
