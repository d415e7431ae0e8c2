"""Parquet and Arrow's own files (Feather): typed columns, read and written a block at a time.

Needs pyarrow (extra ``arrow``). Numbers are taken as they are stored, texts and decimals by their
digits. What was text in a CSV becomes doubles where it is a scene's, and stays text elsewhere.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError
from ..files import ESCAPED, replacing
from ..names import SCENE
from .arrow import ArrowColumn, ArrowTexts, pyarrow
from .rows import BLOCK_ROWS, Column, Reader, Rows, Writer, scene_names, typed


def _blocks(names: Sequence[str], batches: Iterable[Any], where: str) -> Iterator[Rows]:
    first = 1
    for batch in batches:
        if batch.num_rows:
            rows = Rows(first, batch.num_rows, {}, {})
            for name, array in zip(names, batch.columns, strict=True):
                if name in SCENE:
                    rows.columns[name] = _scene_column(rows, name, array, where)
                else:
                    rows.others[name] = ArrowColumn(array)
            yield rows
            first += batch.num_rows


def _scene_column(rows: Rows, name: str, array: Any, where: str) -> Column:
    pa = pyarrow("this table")
    kind = array.type
    if pa.types.is_integer(kind) or pa.types.is_floating(kind):
        if array.null_count and name != "M":
            for index in np.flatnonzero(array.is_null().to_numpy(zero_copy_only=False)):
                rows.bad.append(rows.cell(int(index), name, "is empty; expected a number"))
        if array.null_count:
            array = array.cast(pa.float64()).fill_null(6.0 if name == "M" else np.nan)
        values: NDArray[Any] = array.to_numpy(zero_copy_only=False)
        return values
    if pa.types.is_dictionary(kind):
        array = array.dictionary_decode()
        kind = array.type
    texts = (pa.types.is_string, pa.types.is_large_string, pa.types.is_decimal)
    if not any(is_kind(kind) for is_kind in texts):
        raise UserError(f"{name} holds {kind}; expected numbers or their texts", where)
    return ArrowTexts(array.cast(pa.string()).fill_null(""))


@contextmanager
def read(path: str, form: str, encoding: str | None) -> Iterator[Reader]:
    """Open a Parquet or Arrow file. Raises UserError if it is not one."""
    pa = pyarrow("this format")
    with _arrows_errors(path):
        if form == "parquet":
            from pyarrow import parquet

            with parquet.ParquetFile(path, memory_map=True) as file:
                batches = file.iter_batches(BLOCK_ROWS, use_threads=pa.cpu_count() > 1)
                names = scene_names(file.schema_arrow.names, path)
                yield Reader(names, _blocks(names, batches, path), file.metadata.num_rows)
        else:
            with pa.memory_map(path) as source:
                file = pa.ipc.open_file(source)
                names = scene_names(file.schema.names, path)
                batches = [file.get_batch(at) for at in range(file.num_record_batches)]
                slices = (
                    batch.slice(first, BLOCK_ROWS)
                    for batch in batches
                    for first in range(0, batch.num_rows, BLOCK_ROWS)
                )
                count = sum(batch.num_rows for batch in batches)
                yield Reader(names, _blocks(names, slices, path), count)


@contextmanager
def _arrows_errors(path: str) -> Iterator[None]:
    pa = pyarrow("this table")
    try:
        yield
    except pa.ArrowException as error:
        raise UserError(f"cannot be read: {str(error).partition(chr(10))[0]}", path) from None
    except FileNotFoundError:
        raise UserError("cannot be read: No such file or directory", path) from None


class _ArrowWriter(Writer):
    """Blocks into a file whose schema is the first one's."""

    kind = "a table of typed columns"

    def __init__(self, file: IO[bytes], form: str, *columns: Any) -> None:
        super().__init__(*columns)
        self._file, self._form = file, form
        self._schema: Any = None
        self._writer: Any = None

    def put(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None:
        import pyarrow as pa

        arrays = [_array(name, rows, pa) for name in self.kept]
        arrays += [pa.array(results[name]) for name in self.results]
        table = pa.table(arrays, list(map(_encodable, self.headings)))
        if self._writer is None:
            self._open(table.schema)
        self._writer.write_table(table.cast(self._schema))

    def _open(self, schema: Any) -> None:
        import pyarrow as pa
        from pyarrow import parquet

        self._schema = schema
        if self._form == "parquet":
            # measured numbers hardly repeat: a dictionary of them takes thrice the time and room
            repeating = [field.name for field in schema if not pa.types.is_floating(field.type)]
            self._writer = parquet.ParquetWriter(self._file, schema, use_dictionary=repeating)
        else:
            self._writer = pa.ipc.new_file(self._file, schema)

    def close(self) -> None:
        if self._writer is None:  # no row at all
            import pyarrow as pa

            self._open(pa.schema([(name, pa.float64()) for name in self.headings]))
        self._writer.close()


def _array(name: str, rows: Rows, pa: Any) -> Any:
    column = rows.one_per_row(name)
    if isinstance(column, ArrowColumn) and not (isinstance(column, ArrowTexts) and name in SCENE):
        return column.array
    cells = typed(name, column)
    if name not in SCENE and not isinstance(cells, np.ndarray):
        cells = list(map(_encodable, cells))
    # whole numbers too: where one is missing, a later block of them is of doubles
    return pa.array(cells, pa.float64() if name in SCENE else None)


def _encodable(text: str) -> str:
    """A text with escapes for lone surrogates, which JSON has and Arrow's UTF-8 has not."""
    return text if text.isascii() else text.encode("utf-8", ESCAPED).decode("utf-8")


@contextmanager
def write(path: str, form: str, delimiter: str, *columns: Any) -> Iterator[Writer]:
    """Write a Parquet or Arrow file."""
    pyarrow("this format")
    with replacing(path, "wb") as file:
        writer = _ArrowWriter(file, form, *columns)
        yield writer
        writer.close()
