"""CSV in blocks of bytes that pyarrow can read as csv would.

A block is plain when what is quoted is quoted from a field's begin to its end (RFC 4180), every
record has as many fields as the header, and none is empty. From the first block that is not, the
file is read line by line.
"""

from __future__ import annotations

import io
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

BLOCK_BYTES = 1 << 22
"""A pass over a block of 4 MB takes some milliseconds; blocks of 1 and of 16 MB take as long."""


class Block(NamedTuple):
    """Records as a pyarrow table of texts, its columns named 0, 1 ..., and the line of the file
    in which each ends."""

    table: Any
    lines: NDArray[np.int64]


class PlainBlocks:
    """Blocks of whole records of a binary stream; ``rest`` is what they leave.

    ``number``: the lines in the blocks given so far, and those ``before`` them.
    """

    def __init__(self, stream: Any, delimiter: str, width: int, before: int) -> None:
        self.number = before
        self._stream = stream
        self._delimiter = ord(delimiter)
        self._width = width
        self._tail = b""
        self._ended = False

    def next(self) -> Block | None:
        """The next block; None when there is no plain one."""
        block = self._tail if self._ended else self._tail + self._stream.read(BLOCK_BYTES)
        if len(block) < len(self._tail) + BLOCK_BYTES:
            self._ended = True
        self._tail = block
        ends, lines = self._records(block)
        if not ends.size:
            return None
        cut = min(int(ends[-1]) + 1, len(block))
        table = self._read(block[:cut], b'"' in block)
        if table is None or table.num_rows != ends.size:
            return None
        self._tail = block[cut:]
        found = Block(table, lines + self.number)
        self.number = int(found.lines[-1])
        return found

    def _records(self, data: bytes) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Where each record ends, and how many lines that makes; none if the data are not plain."""
        none = np.empty(0, np.int64), np.empty(0, np.int64)
        if b"\0" in data or data.count(b"\r") != data.count(b"\r\n"):
            return none
        if self._ended and data and not data.endswith(b"\n"):
            data += b"\n"
        characters = np.frombuffer(data, np.uint8)
        newlines = ends = np.flatnonzero(characters == ord("\n"))
        between = np.flatnonzero(characters == self._delimiter)
        if b'"' in data:
            quotes = np.flatnonzero(characters == ord('"'))
            opening, closing = quotes[::2], quotes[1::2]
            around = np.array([self._delimiter, *b'\r\n"'], np.uint8)
            before = characters[np.maximum(opening - 1, 0)]
            after = characters[np.minimum(closing + 1, characters.size - 1)]
            if not (np.isin(before[opening > 0], around).all() and np.isin(after, around).all()):
                return none
            # what an odd number of quotes precedes is quoted
            ends = newlines[np.searchsorted(quotes, newlines) % 2 == 0]
            between = between[np.searchsorted(quotes, between) % 2 == 0]
        if self._ended and ends.size and ends[-1] + 1 != len(data):
            return none  # a quote that nothing closes
        fields = np.diff(np.searchsorted(between, ends), prepend=0)
        if self._width < 2 or (fields != self._width - 1).any():
            return none
        return ends, np.searchsorted(newlines, ends) + 1

    def rest(self) -> io.BufferedReader:
        """What no block has given."""
        return io.BufferedReader(_Joined(self._tail, self._stream))

    def _read(self, data: bytes, quoted: bool) -> Any:
        import pyarrow as pa
        from pyarrow import csv

        names = list(map(str, range(self._width)))
        try:
            return csv.read_csv(
                pa.BufferReader(data),
                csv.ReadOptions(column_names=names, block_size=len(data) + 1),
                csv.ParseOptions(
                    delimiter=chr(self._delimiter),
                    quote_char='"' if quoted else False,
                    newlines_in_values=quoted,
                    ignore_empty_lines=False,
                ),
                csv.ConvertOptions(column_types=dict.fromkeys(names, pa.string())),
            ).combine_chunks()
        except pa.ArrowInvalid:  # bytes that are no UTF-8: the reader of lines says where
            return None


class _Joined(io.RawIOBase):
    """Some bytes, then a stream."""

    def __init__(self, first: bytes, stream: Any) -> None:
        self._first = memoryview(first)
        self._stream = stream

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: Any) -> int:
        if self._first:
            count = min(len(buffer), len(self._first))
            buffer[:count] = self._first[:count]
            self._first = self._first[count:]
            return count
        data = self._stream.read1(len(buffer))
        buffer[: len(data)] = data
        return len(data)
