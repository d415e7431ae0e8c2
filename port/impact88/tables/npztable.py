""".npz: one array a column; arrays of length 1 or without dimension hold for all rows.

Read and written as a whole: memory grows with the file. Anybody may have made it: what a member
says of its size is held against its array's type and shape before any memory is taken.
"""

import io
import os
import sys
import zipfile
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError, quoted
from ..files import ESCAPED, replacing
from ..names import SCENE
from .cells import typed
from .rows import Column, Put, Reader, Rows, scene_names

MOST_ARRAYS = 10_000
"""A table has some fifty columns."""
UNPACKED, RATIO = 256_000_000, 20
"""Bytes that a small file may unpack to; a larger one so many times its own. Doubles pack to a
third; with twice as much a file of 100 MB may take 4 GB of memory."""


def _arrays(path: str) -> dict[str, NDArray[Any]]:
    """Every array of an .npz file by name. Raises UserError if it is not one, holds anything else,
    or unpacks to more than it may."""
    try:
        with zipfile.ZipFile(path) as archive:
            members = archive.infolist()
            if len(members) > MOST_ARRAYS:
                raise UserError(
                    f"holds {len(members):,} arrays; at most {MOST_ARRAYS:,} are read", path
                )
            for name, count in Counter(member.filename for member in members).items():
                if not name.endswith(".npy"):
                    raise UserError(f"holds {quoted(name)}; expected .npy arrays only", path)
                if count > 1:
                    raise UserError(f"holds {quoted(name)} twice", path)
            check_unpacked(members, os.path.getsize(path), path)
            return {m.filename[:-4]: _member(archive, m, path) for m in members}
    except OSError as error:
        raise UserError(f"cannot be read: {error.strerror or error}", path) from None
    except UserError:
        raise
    except (zipfile.BadZipFile, ValueError, EOFError, NotImplementedError) as error:
        raise UserError(f"is not an .npz file of plain arrays: {error}", path) from None


def check_unpacked(members: list[zipfile.ZipInfo], size: int, path: str) -> None:
    """Raise UserError when an archive of ``size`` bytes unpacks to more than is read."""
    unpacked = sum(member.file_size for member in members)
    limit = max(UNPACKED, RATIO * size)
    if unpacked > limit:
        raise UserError(
            f"has {size:,} bytes that unpack to {unpacked:,}; at most {limit:,} are read "
            "(numpy.savez writes arrays unpacked)",
            path,
        )


def _member(archive: zipfile.ZipFile, member: zipfile.ZipInfo, path: str) -> NDArray[Any]:
    where = f"{path}, {quoted(member.filename)}"
    headers = np.lib.format.read_array_header_1_0, np.lib.format.read_array_header_2_0
    problem = "cannot be unpacked"
    try:
        with archive.open(member) as file:
            data = io.BytesIO(file.read(member.file_size + 1))
        problem = "is not an array of numbers or text"
        shape, _, dtype = headers[np.lib.format.read_magic(data)[0] - 1](data)
    except (OSError, MemoryError):
        raise
    except Exception as error:  # zlib, struct, lzma, a literal's parser ... each have their own
        reason = str(error).partition("\n")[0]
        raise UserError(f"{problem}: {reason}", where) from None
    if dtype.kind not in "biufcSU":
        raise UserError(f"holds {dtype}; expected an array of numbers or of text", where)
    size, expected = data.getbuffer().nbytes, data.tell() + prod(shape) * dtype.itemsize
    if size != expected or size != member.file_size:
        raise UserError(f"has {size:,} bytes where its header says {expected:,}", where)
    data.seek(0)
    return np.lib.format.read_array(data, allow_pickle=False)


LARGEST_TEXTS = 256_000_000
"""Bytes of the largest column of texts that is written: numpy gives each the longest one's."""


@contextmanager
def read(path: str, form: str, encoding: str | None) -> Iterator[Reader]:
    """Open an .npz table. Raises UserError if it is not one, or holds Python objects."""
    arrays = _arrays(path)
    names = scene_names(list(arrays))
    columns: dict[str, Any] = dict(zip(names, arrays.values(), strict=True))
    scene = {name: array for name, array in columns.items() if name in SCENE}
    for name, array in scene.items():
        if array.dtype.kind not in "fiuU":
            raise UserError(f"{name} holds {array.dtype}; expected numbers", path)
        if array.size != 1 and array.ndim != 1:
            shape = " by ".join(map(str, array.shape))
            raise UserError(f"{name} is an array of {shape}; expected one dimension", path)
    lengths = {name: array.size for name, array in scene.items() if array.size != 1}
    if len(set(lengths.values())) > 1:
        sizes = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise UserError(f"its columns differ in length: {sizes}", path)
    count = next(iter(lengths.values()), 1)
    for name, array in scene.items():
        spread = np.broadcast_to(array.reshape(-1), (count,))
        columns[name] = spread.tolist() if spread.dtype.kind == "U" else spread
    yield Reader(names, [Rows(count, columns)], count)


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
def write(path: str, form: str, delimiter: str, headings: Sequence[str]) -> Iterator[Put]:
    """Write an .npz table as numpy.savez does, but of arrays with any name."""
    parts: list[list[NDArray[Any]]] = []
    yield lambda columns: parts.append([_array(*column) for column in columns])
    with (
        replacing(path, "wb") if path != "-" else nullcontext(sys.stdout.buffer) as file,
        zipfile.ZipFile(file, "w") as archive,
    ):
        for name, column in zip(headings, zip(*parts, strict=True), strict=bool(parts)):
            # a fixed date: the same arrays give the same bytes
            escaped = f"{name}.npy".encode("utf-8", ESCAPED).decode()
            with archive.open(zipfile.ZipInfo(escaped), "w", force_zip64=True) as out:
                array = column[0] if len(column) == 1 else np.concatenate(column)
                np.lib.format.write_array(out, np.asanyarray(array), allow_pickle=False)
