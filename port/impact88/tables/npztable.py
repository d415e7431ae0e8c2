""".npz: one array a column; arrays of length 1 or without dimension hold for all rows.

Columns are read a block of rows at a time; what is written is held until the end, since each array
stands in the file as a whole. Anybody may have made the file: what a member says of its size is
held against its array's type and shape before any memory is taken.
"""

import io
import sys
import zipfile
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, nullcontext
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError, quoted
from ..files import ESCAPED, decoding, replacing
from ..names import SCENE
from .budget import Budget
from .cells import typed_cells
from .rows import BLOCK_CHARACTERS, BLOCK_ROWS, Column, Put, Reader, Rows, scene_names

_HEADER = 1 << 17
"""Bytes in which an array's header ends: numpy reads one of 10,000 characters, and its length."""
_PACKED = "cannot be unpacked"


@contextmanager
def _members(path: str) -> Iterator[dict[str, "_Member"]]:
    """Every array of an .npz file by name, unread. Raises UserError if the file is not one, holds
    anything else, or unpacks to more than it may."""
    with ExitStack() as stack:
        with decoding(path, "is not an .npz file of plain arrays"):
            archive = stack.enter_context(zipfile.ZipFile(path))
            members = archive.infolist()
            budget = Budget(path)
            budget.check_shape(len(members))
            for name, count in Counter(member.filename for member in members).items():
                if not name.endswith(".npy"):
                    raise UserError(f"holds {quoted(name)}; expected .npy arrays only", path)
                if count > 1:
                    raise UserError(f"holds {quoted(name)} twice", path)
            budget.take(sum(member.file_size for member in members))
            arrays = {m.filename[:-4]: _Member(archive, m, path, stack) for m in members}
        yield arrays


class _Member:
    """An array of an archive, read from its begin to its end. Raises UserError for what is not an
    array of numbers or text, or has another size than its header says."""

    def __init__(
        self, archive: zipfile.ZipFile, member: zipfile.ZipInfo, path: str, stack: ExitStack
    ) -> None:
        self.where = f"{path}, {quoted(member.filename)}"
        headers = np.lib.format.read_array_header_1_0, np.lib.format.read_array_header_2_0
        with decoding(self.where, _PACKED):
            self.file: Any = stack.enter_context(archive.open(member))
            start = io.BytesIO(self.file.read(min(member.file_size, _HEADER)))
        with decoding(self.where, "is not an array of numbers or text"):
            version = np.lib.format.read_magic(start)[0]
            self.shape, fortran, self.dtype = headers[version - 1](start)
        if self.dtype.kind not in "biufcSU":
            raise UserError(
                f"holds {self.dtype}; expected an array of numbers or of text", self.where
            )
        self.size, self.fortran = prod(self.shape), fortran
        expected = start.tell() + self.size * self.dtype.itemsize
        if member.file_size != expected:
            raise UserError(
                f"has {member.file_size:,} bytes where its header says {expected:,}", self.where
            )
        self.start = start.read()

    def take(self, count: int) -> NDArray[Any]:
        """The next so many of the array's elements."""
        size = count * self.dtype.itemsize
        with decoding(self.where, _PACKED):
            data = self.start[:size]
            self.start = self.start[size:]
            data += self.file.read(size - len(data))
            if len(data) < size:
                raise EOFError("it ends before its size")
            return np.frombuffer(data, self.dtype, count)

    def take_all(self) -> NDArray[Any]:
        """The array, of which nothing was taken yet."""
        array = self.take(self.size)
        return array.reshape(self.shape[::-1]).T if self.fortran else array.reshape(self.shape)


LARGEST_TEXTS = 256_000_000
"""Bytes of the largest column of texts that is written: numpy gives each the longest one's."""


@contextmanager
def read(path: str, encoding: str | None, results: bool) -> Iterator[Reader]:
    """Open an .npz table. Raises UserError if it is not one, or holds Python objects."""
    with _members(path) as members:
        names = scene_names(list(members), None, results)
        columns = dict(zip(names, members.values(), strict=True))
        scene = {name: column for name, column in columns.items() if name in SCENE}
        for name, column in scene.items():
            if column.dtype.kind not in "fiuU":
                raise UserError(f"{name} holds {column.dtype}; expected numbers", path)
            if column.size != 1 and len(column.shape) != 1:
                shape = " by ".join(map(str, column.shape))
                raise UserError(f"{name} is an array of {shape}; expected one dimension", path)
        lengths = {name: column.size for name, column in scene.items() if column.size != 1}
        if len(set(lengths.values())) > 1:
            sizes = ", ".join(f"{name} {length}" for name, length in lengths.items())
            raise UserError(f"its columns differ in length: {sizes}", path)
        count = next(iter(lengths.values()), 1)
        yield Reader(names, _blocks(columns, count), count)


def _blocks(columns: dict[str, _Member], count: int) -> Iterator[Rows]:
    """Yield the rows; arrays that have no element for each as they are, the same every time."""
    running = {n: column for n, column in columns.items() if column.shape == (count,) != (1,)}
    whole_arrays = {n: column.take_all() for n, column in columns.items() if n not in running}
    characters = sum(c.dtype.itemsize // 4 for c in running.values() if c.dtype.kind in "US")
    max_rows = max(1, min(BLOCK_ROWS, BLOCK_CHARACTERS // max(characters, 1)))
    whole_names = {name for name, array in whole_arrays.items() if array.size != 1}
    for first in range(0, count, max_rows) if count else (0,):
        size = min(max_rows, count - first)
        rows = Rows(size, {}, whole=whole_names)
        for name in columns:
            array = running[name].take(size) if name in running else whole_arrays[name]
            if name in SCENE:
                array = np.broadcast_to(array.reshape(-1), (size,))
            is_text = name in SCENE and array.dtype.kind == "U"
            rows.columns[name] = array.tolist() if is_text else array
        yield rows


def _array(name: str, column: Column) -> NDArray[Any]:
    cells = typed_cells(name, column)
    if isinstance(cells, np.ndarray):
        return cells
    longest = max(map(len, cells), default=0)
    if 4 * longest * len(cells) > LARGEST_TEXTS:
        raise UserError(
            f"column {quoted(name)} has texts of up to {longest:,} characters, too long for "
            ".npz; write CSV or JSON Lines"
        )
    return np.array(cells, dtype=np.str_)


@contextmanager
def write(path: str, delimiter: str, headings: Sequence[str]) -> Iterator[Put]:
    """Write an .npz table as numpy.savez does, but of arrays with any name."""
    parts: list[list[NDArray[Any]]] = []
    yield lambda columns: parts.append([_array(*column) for column in columns])
    with (
        replacing(path, "wb") if path != "-" else nullcontext(sys.stdout.buffer) as file,
        zipfile.ZipFile(file, "w") as archive,
    ):
        for name, column in zip(headings, zip(*parts, strict=True), strict=bool(parts)):
            # a fixed date: the same arrays give the same bytes
            member_name = f"{name}.npy".encode("utf-8", ESCAPED).decode()
            with archive.open(zipfile.ZipInfo(member_name), "w", force_zip64=True) as out:
                same = all(part is column[0] for part in column)
                array = column[0] if same else np.concatenate(column)
                np.lib.format.write_array(out, np.asanyarray(array), allow_pickle=False)
