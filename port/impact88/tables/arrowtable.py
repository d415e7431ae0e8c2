"""Parquet and Arrow's own files (Feather): typed columns, read and written a block at a time.

Needs pyarrow (extra ``arrow``). Numbers are taken as they are stored, texts and decimals by their
digits. What was text in a CSV becomes doubles where it is a scene's, and stays text elsewhere.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError
from ..files import ESCAPED, replacing
from ..names import SCENE
from .arrow import ArrowColumn, ArrowTexts, pyarrow
from .rows import BLOCK_ROWS, Column, Reader, Rows, Writer, typed


class _ArrowReader(Reader):
    def __init__(self, names: Sequence[str], rows: int, batches: Iterator[Any], where: str) -> None:
        self.total = rows
        self._name(names, where)
        self._batches = batches
        self._where = where
        self._given = 0

    def position(self) -> int:
        return self._given

    def __iter__(self) -> Iterator[Rows]:
        for batch in self._batches:
            if not batch.num_rows:
                continue
            rows = Rows(self._given + 1, batch.num_rows, {}, {})
            for name, array in zip(self.names, batch.columns, strict=True):
                if name in SCENE:
                    rows.columns[name] = self._scene_column(rows, name, array)
                else:
                    rows.others[name] = ArrowColumn(array)
            self._given += batch.num_rows
            yield rows

    def _scene_column(self, rows: Rows, name: str, array: Any) -> Column:
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
        if not (
            pa.types.is_string(kind) or pa.types.is_large_string(kind) or pa.types.is_decimal(kind)
        ):
            raise UserError(f"{name} holds {kind}; expected numbers or their texts", self._where)
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
                count = file.metadata.num_rows
                yield _ArrowReader(file.schema_arrow.names, count, batches, path)
        else:
            with pa.memory_map(path) as source:
                file = pa.ipc.open_file(source)
                numbers = range(file.num_record_batches)
                slices = (
                    batch.slice(first, BLOCK_ROWS)
                    for batch in map(file.get_batch, numbers)
                    for first in range(0, batch.num_rows, BLOCK_ROWS)
                )
                count = sum(batch.num_rows for batch in map(file.get_batch, numbers))
                yield _ArrowReader(file.schema.names, count, slices, path)


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
