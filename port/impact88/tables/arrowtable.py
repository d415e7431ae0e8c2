"""Parquet: typed columns, read and written a block at a time.

Needs pyarrow (extra ``arrow``). Numbers are taken as they are stored, texts and decimals by their
digits. What was text in a CSV becomes doubles where it is a scene's, and stays text elsewhere.
"""

import itertools
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import Any

import numpy as np

from ..errors import UserError, library
from ..files import ESCAPED, decoding, replacing
from ..names import SCENE
from .budget import Budget
from .cells import typed_cells
from .rows import (
    BLOCK_CHARACTERS,
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


def _text_sizes(pa: Any, array: Any) -> Any:
    """Bytes of each text of a dictionary-encoded array, before any of them is copied."""
    from pyarrow import compute

    sizes = compute.binary_length(array.dictionary).fill_null(0)
    return sizes.take(array.indices.fill_null(0)).to_numpy(zero_copy_only=False).astype(np.int64)


def _decode_column(pa: Any, batches: Iterable[Any], budget: Budget) -> Iterator[Any]:
    """Yield the batches with their texts decoded, in parts that hold `BLOCK_CHARACTERS` each or one
    row. Raises UserError past the budget."""
    for batch in batches:
        places = [
            place
            for place, kind in enumerate(batch.schema.types)
            if pa.types.is_dictionary(kind) and _is_text(pa, kind.value_type)
        ]
        sizes = sum(
            (_text_sizes(pa, batch.column(place)) for place in places),
            np.zeros(batch.num_rows, np.int64),
        )
        budget.take(int(sizes.sum()))
        parts = np.cumsum(sizes) // BLOCK_CHARACTERS
        starts = [0, *(np.flatnonzero(np.diff(parts)) + 1).tolist(), batch.num_rows]
        for start, end in itertools.pairwise(starts):
            part = batch.slice(start, end - start)
            columns = part.columns
            for place in places:
                columns[place] = columns[place].dictionary_decode()
            yield pa.RecordBatch.from_arrays(columns, part.schema.names) if places else part


def _is_text(pa: Any, kind: Any) -> bool:
    types = pa.types
    tests = types.is_string, types.is_large_string, types.is_binary, types.is_large_binary
    return any(test(kind) for test in tests)


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
    if pa.types.is_dictionary(array.type):  # of numbers
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
def read(path: str, encoding: str | None, results: bool) -> Iterator[Reader]:
    """Open a Parquet file. Raises UserError if it is not one."""
    pa = library("pyarrow", "arrow", "this format")
    from pyarrow import parquet

    budget = Budget(path)
    with ExitStack() as stack:
        with decoding(path):
            file = stack.enter_context(parquet.ParquetFile(path, memory_map=True))
            headings, count = file.schema_arrow.names, file.metadata.num_rows
            budget.check_shape(len(headings), count)
            budget.take(_largest_chunk(file.metadata))
            # one text that a thousand rows share is read once, and counted before it is copied
            texts = [f.name for f in file.schema_arrow if _is_text(pa, f.type)]
            file = stack.enter_context(
                parquet.ParquetFile(path, memory_map=True, read_dictionary=texts)
            )
            batches = file.iter_batches(BLOCK_ROWS, use_threads=pa.cpu_count() > 1)
        names = scene_names(headings, path, results)
        batches = _decode_column(pa, _validate_each(batches, path), budget)
        yield Reader(names, _blocks(pa, names, batches, path), count)


def _largest_chunk(metadata: Any) -> int:
    """The largest size that a column of a row group unpacks to: it may be one page."""
    groups = (metadata.row_group(at) for at in range(metadata.num_row_groups))
    sizes = (
        group.column(at).total_uncompressed_size
        for group in groups
        for at in range(group.num_columns)
    )
    return max(sizes, default=0)


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
def write(path: str, delimiter: str, headings: Sequence[str]) -> Iterator[Put]:
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

    def put_block(columns: Named) -> None:
        table = pa.table([array(*column) for column in columns], headings)
        if not writer_and_schema:
            writer_and_schema.extend((writer(table.schema), table.schema))
        writer_and_schema[0].write_table(table.cast(writer_and_schema[1]))

    with replacing(path, "wb") as file:
        yield put_block
        if not writer_and_schema:  # no row at all
            writer_and_schema.append(writer(pa.schema([(name, pa.float64()) for name in headings])))
        writer_and_schema[0].close()
