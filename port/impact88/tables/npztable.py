""".npz: one array a column; arrays of length 1 or without dimension hold for all rows.

Read and written as a whole: memory grows with the file.
"""

from __future__ import annotations

import sys
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError
from ..files import replacing
from ..names import SCENE
from .rows import Column, Reader, Rows, Writer


class _NpzReader:
    delimiter = ","

    def __init__(self, arrays: dict[str, NDArray[Any]], where: str) -> None:
        self.names = list(arrays)
        lengths = {name: array.shape for name, array in arrays.items() if array.size != 1}
        if any(len(shape) != 1 for name, shape in lengths.items() if name in SCENE):
            raise UserError("holds arrays with more than one dimension", where)
        counts = {shape[0] for name, shape in lengths.items() if name in SCENE}
        if len(counts) > 1:
            told = ", ".join(f"{name} {s[0]}" for name, s in lengths.items() if name in SCENE)
            raise UserError(f"its columns differ in length: {told}", where)
        self._count = counts.pop() if counts else 1
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
                columns[name] = column if column.dtype.kind in "fiub" else column.tolist()
            else:
                others[name] = array
        yield Rows(1, self._count, columns, others)


@contextmanager
def read_npz(path: str) -> Iterator[Reader]:
    """Open an .npz table. Raises UserError if it is none, or holds Python objects."""
    if path == "-":
        raise UserError("an .npz table cannot be read from standard input; expected a file")
    try:
        with np.load(path, allow_pickle=False) as file:
            if not isinstance(file, np.lib.npyio.NpzFile):
                raise UserError("is no .npz file", path)
            arrays = {name: file[name] for name in file.files}
    except OSError as error:
        raise UserError(f"cannot be read: {error.strerror or error}", path) from None
    except (ValueError, zipfile.BadZipFile, EOFError, KeyError) as error:
        raise UserError(f"is no .npz file of plain arrays: {error}", path) from None
    yield _NpzReader(arrays, path)


class _NpzWriter:
    def __init__(self, kept: Sequence[str]) -> None:
        self._kept = kept
        self._parts: list[dict[str, NDArray[Any]]] = []

    def write(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None:
        part = {}
        for name in self._kept:
            column = rows.kept(name)
            part[name] = column if isinstance(column, np.ndarray) else _array(name, column)
        self._parts.append({**part, **results})

    def arrays(self) -> dict[str, NDArray[Any]]:
        if len(self._parts) == 1:
            return self._parts[0]
        names = self._parts[0] if self._parts else {}
        return {name: np.concatenate([part[name] for part in self._parts]) for name in names}


def _array(name: str, column: Column) -> NDArray[Any]:
    """A column of texts: doubles for a scene's name (NaN where it is no number), else text."""
    if name not in SCENE:
        return np.array(["" if cell is None else str(cell) for cell in column])
    values = np.full(len(column), np.nan)
    for i, cell in enumerate(column):
        try:
            values[i] = float(cell)
        except (TypeError, ValueError):
            continue
    return values


@contextmanager
def write_npz(path: str, kept: Sequence[str], results: Sequence[str]) -> Iterator[Writer]:
    """Write an .npz table, see `tables.table.open_writer`."""
    if path == "-" and sys.stdout.isatty():
        raise UserError("an .npz table is not for a terminal; expected -o FILE.npz")
    writer = _NpzWriter(kept)
    yield writer
    if path == "-":
        np.savez(sys.stdout.buffer, **writer.arrays())  # type: ignore[arg-type]
        return
    with replacing(path, "wb") as file:
        np.savez(file, **writer.arrays())  # type: ignore[arg-type]
