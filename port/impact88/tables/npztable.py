""".npz: one array a column; arrays of length 1 or without dimension hold for all rows.

Read and written as a whole: memory grows with the file.
"""

from __future__ import annotations

import sys
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError, quoted
from ..files import replacing
from ..names import SCENE
from .npzfile import read_arrays, write_arrays
from .rows import Column, Reader, Rows, Writer, heading, refuse_late, scene_names, typed

_NUMBERS = "fiu"
_TEXT = "U"
LARGEST_TEXTS = 256_000_000
"""Bytes of the largest column of texts that is written: numpy gives each the longest one's."""


class _NpzReader:
    delimiter = ","

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
            told = ", ".join(f"{name} {length}" for name, length in lengths.items())
            raise UserError(f"its columns differ in length: {told}", where)
        self._count = next(iter(lengths.values()), 1)
        self.total: int | None = self._count
        self._arrays = arrays

    def position(self) -> int:
        return self._count

    def __iter__(self) -> Iterator[Rows]:
        columns: dict[str, Column] = {}
        others: dict[str, Column] = {}
        for name, array in self._arrays.items():
            if name in SCENE:
                column = np.broadcast_to(array.reshape(-1), (self._count,))
                columns[name] = column if column.dtype.kind in _NUMBERS else column.tolist()
            else:
                others[name] = array
        yield Rows(1, self._count, columns, others)


@contextmanager
def read_npz(path: str) -> Iterator[Reader]:
    """Open an .npz table. Raises UserError if it is none, or holds Python objects."""
    if path == "-":
        raise UserError("an .npz table cannot be read from standard input; expected a file")
    yield _NpzReader(read_arrays(path), path)


class _NpzWriter:
    def __init__(
        self, kept: Sequence[str], results: Sequence[str], dropped: Collection[str]
    ) -> None:
        self._kept = kept
        self._results = results
        self._dropped = dropped
        self._parts: list[dict[str, NDArray[Any]]] = []

    def write(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None:
        refuse_late(rows, self._dropped, "an .npz table")
        part = {}
        for name in self._kept:
            column = rows.kept(name)
            part[name] = column if isinstance(column, np.ndarray) else _array(name, column)
        self._parts.append({**part, **{name: results[name] for name in self._results}})

    def arrays(self) -> dict[str, NDArray[Any]]:
        if len(self._parts) == 1:
            return {heading(name): array for name, array in self._parts[0].items()}
        names = self._parts[0] if self._parts else {}
        return {
            heading(name): np.concatenate([part[name] for part in self._parts]) for name in names
        }


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
def write_npz(
    path: str, kept: Sequence[str], results: Sequence[str], dropped: Collection[str]
) -> Iterator[Writer]:
    """Write an .npz table, see `tables.table.open_writer`."""
    if path == "-" and sys.stdout.isatty():
        raise UserError("an .npz table is not for a terminal; expected -o FILE.npz")
    writer = _NpzWriter(kept, results, dropped)
    yield writer
    if path == "-":
        write_arrays(sys.stdout.buffer, writer.arrays())
        return
    with replacing(path, "wb") as file:
        write_arrays(file, writer.arrays())
