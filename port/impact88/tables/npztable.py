""".npz: one array a column; arrays of length 1 or without dimension hold for all rows.

Read and written as a whole: memory grows with the file.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError, quoted
from ..files import replacing
from ..names import SCENE
from .npzfile import read_arrays, write_arrays
from .rows import Column, Reader, Rows, Writer, scene_names, typed

_NUMBERS = "fiu"
_TEXT = "U"
LARGEST_TEXTS = 256_000_000
"""Bytes of the largest column of texts that is written: numpy gives each the longest one's."""


class _NpzReader(Reader):
    def __init__(self, arrays: dict[str, NDArray[Any]], where: str) -> None:
        self.names = scene_names(list(arrays))
        arrays = dict(zip(self.names, arrays.values(), strict=True))
        scene = {name: array for name, array in arrays.items() if name in SCENE}
        for name, array in scene.items():
            if array.dtype.kind not in _NUMBERS + _TEXT:
                raise UserError(f"{name} holds {array.dtype}; expected numbers", where)
            if array.size != 1 and array.ndim != 1:
                shape = " by ".join(map(str, array.shape))
                raise UserError(f"{name} is an array of {shape}; expected one dimension", where)
        lengths = {name: array.size for name, array in scene.items() if array.size != 1}
        if len(set(lengths.values())) > 1:
            sizes = ", ".join(f"{name} {length}" for name, length in lengths.items())
            raise UserError(f"its columns differ in length: {sizes}", where)
        self._count = next(iter(lengths.values()), 1)
        self.total: int | None = self._count
        self._arrays = arrays

    def position(self) -> int:
        return self._count

    def __iter__(self) -> Iterator[Rows]:
        columns, others = self._split(self._arrays, self._arrays.values())
        for name in columns:
            column = np.broadcast_to(self._arrays[name].reshape(-1), (self._count,))
            columns[name] = column if column.dtype.kind in _NUMBERS else column.tolist()
        yield Rows(1, self._count, columns, others)


@contextmanager
def read_npz(path: str) -> Iterator[Reader]:
    """Open an .npz table. Raises UserError if it is not one, or holds Python objects."""
    if path == "-":
        raise UserError("an .npz table cannot be read from standard input; expected a file")
    yield _NpzReader(read_arrays(path), path)


class _NpzWriter(Writer):
    kind = "an .npz table"

    def __init__(self, *columns: Any) -> None:
        super().__init__(*columns)
        self._parts: list[list[NDArray[Any]]] = []

    def put(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None:
        columns = [(name, rows.kept(name)) for name in self.kept]
        arrays = [c if isinstance(c, np.ndarray) else _array(name, c) for name, c in columns]
        self._parts.append([*arrays, *(results[name] for name in self.results)])

    def arrays(self) -> dict[str, NDArray[Any]]:
        """The whole columns by heading."""
        if not self._parts:
            return {}
        columns = zip(*self._parts, strict=True)
        whole = (parts[0] if len(parts) == 1 else np.concatenate(parts) for parts in columns)
        return dict(zip(self.headings, whole, strict=True))


def _array(name: str, column: Column) -> NDArray[Any]:
    cells = typed(name, column)
    if isinstance(cells, np.ndarray):
        return cells
    longest = max(map(len, cells), default=0)
    if 4 * longest * len(cells) > LARGEST_TEXTS:
        raise UserError(
            f"column {quoted(name)} has texts of up to {longest:,} characters, too long for "
            ".npz; expected to write CSV or JSON Lines"
        )
    return np.array(cells, dtype=np.str_)


@contextmanager
def write_npz(path: str, *columns: Any) -> Iterator[Writer]:
    """Write an .npz table, see `tables.table.open_writer`."""
    if path == "-" and sys.stdout.isatty():
        raise UserError("an .npz table is not for a terminal; expected -o FILE.npz")
    writer = _NpzWriter(*columns)
    yield writer
    if path == "-":
        write_arrays(sys.stdout.buffer, writer.arrays())
        return
    with replacing(path, "wb") as file:
        write_arrays(file, writer.arrays())
