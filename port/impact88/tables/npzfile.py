"""The arrays of an .npz file, which anybody may have made: read within limits, written by name.

A member's own words about itself (its packed size, its array's type and shape) are held against
each other before any memory is taken.
"""

from __future__ import annotations

import io
import os
import zipfile
from collections.abc import Mapping
from math import prod
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError, quoted
from ..files import ESCAPED

MOST_ARRAYS = 10_000
UNPACKED = 256_000_000
"""Bytes that a small file may unpack to; a larger one `RATIO` times its own."""
RATIO = 20
_HEADER = 10_000
_KINDS = "biufcSU"


def read_arrays(path: str) -> dict[str, NDArray[Any]]:
    """Every array of an .npz file by name.

    Raises UserError if it is not one, holds anything else, or unpacks to more than it may.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            members = archive.infolist()
            _check(members, os.path.getsize(path), path)
            return {m.filename[:-4]: _array(archive, m, path) for m in members}
    except OSError as error:
        raise UserError(f"cannot be read: {error.strerror or error}", path) from None
    except (zipfile.BadZipFile, ValueError, EOFError, NotImplementedError) as error:
        raise _refused(path, error) from None


def _refused(path: str, error: Exception) -> UserError:
    if isinstance(error, UserError):
        return error
    return UserError(f"is not an .npz file of plain arrays: {error}", path)


def _check(members: list[zipfile.ZipInfo], size: int, path: str) -> None:
    if len(members) > MOST_ARRAYS:
        raise UserError(f"holds {len(members):,} arrays; at most {MOST_ARRAYS:,} are read", path)
    seen = set()
    for member in members:
        if not member.filename.endswith(".npy"):
            raise UserError(f"holds {quoted(member.filename)}; expected .npy arrays only", path)
        if member.flag_bits & 1:
            raise UserError("is encrypted; expected a plain .npz file", path)
        if member.filename in seen:
            raise UserError(f"holds {quoted(member.filename)} twice", path)
        seen.add(member.filename)
    check_unpacked(members, size, path)


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


def _array(archive: zipfile.ZipFile, member: zipfile.ZipInfo, path: str) -> NDArray[Any]:
    where = f"{path}, {quoted(member.filename)}"
    try:
        with archive.open(member) as file:
            data = file.read(member.file_size + 1)
    except (OSError, MemoryError):
        raise
    except Exception as error:  # zlib, struct, lzma ... each have their own
        raise UserError(f"cannot be unpacked: {error}", where) from None
    dtype, shape, start = _header(data, where)
    expected = start + prod(shape) * dtype.itemsize
    if dtype.kind not in _KINDS:
        raise UserError(f"holds {dtype}; expected an array of numbers or of text", where)
    if len(data) != expected or len(data) != member.file_size:
        raise UserError(f"has {len(data):,} bytes where its header says {expected:,}", where)
    return np.lib.format.read_array(io.BytesIO(data), allow_pickle=False)


def _header(data: bytes, where: str) -> tuple[np.dtype[Any], tuple[int, ...], int]:
    """Type and shape of the array, and where its numbers begin."""
    file = io.BytesIO(data)
    try:
        version = np.lib.format.read_magic(file)
        read = {
            (1, 0): np.lib.format.read_array_header_1_0,
            (2, 0): np.lib.format.read_array_header_2_0,
        }[version]
        shape, _, dtype = read(file, max_header_size=_HEADER)
    except MemoryError:
        raise
    except Exception as error:  # whatever a literal's parser raises on arbitrary bytes
        reason = quoted(str(error).partition("\n")[0])
        raise UserError(f"is not an array of numbers or text: {reason}", where) from None
    if any(length < 0 for length in shape):
        raise UserError("has a negative length", where)
    return dtype, shape, file.tell()


def write_arrays(file: IO[bytes], arrays: Mapping[str, NDArray[Any]]) -> None:
    """An .npz file as numpy.savez writes it, but of arrays with any name."""
    with zipfile.ZipFile(file, "w") as archive:
        for name, array in arrays.items():
            # a fixed date: the same arrays give the same bytes
            member = zipfile.ZipInfo(f"{name}.npy".encode("utf-8", ESCAPED).decode())
            with archive.open(member, "w", force_zip64=True) as out:
                np.lib.format.write_array(out, np.asanyarray(array), allow_pickle=False)
