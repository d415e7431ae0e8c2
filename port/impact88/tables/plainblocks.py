"""The plain part of a CSV file, in blocks of bytes that pyarrow can read as csv would.

A block is plain when nothing is quoted, every line has as many fields as the header, and none is
empty. From the first block that is not, the file is read line by line.
"""

from __future__ import annotations

import io
from typing import Any

import numpy as np

BLOCK_BYTES = 1 << 22


class PlainBlocks:
    """Blocks of whole lines of a binary stream; ``rest`` is what they leave.

    ``number``: the lines in the blocks given so far, and those ``before`` them.
    """

    def __init__(self, stream: Any, delimiter: str, width: int, before: int) -> None:
        self.number = before
        self._stream = stream
        self._delimiter = delimiter.encode()
        self._width = width
        self._tail = b""
        self._ended = False

    def next(self) -> Any:
        """The next block as a pyarrow table of texts, its columns named 0, 1 ...; None when there
        is no plain one."""
        block = self._tail if self._ended else self._tail + self._stream.read(BLOCK_BYTES)
        if len(block) < len(self._tail) + BLOCK_BYTES:
            self._ended = True
        cut = len(block) if self._ended else block.rfind(b"\n") + 1
        data = block[:cut]
        table = self._read(data) if self._is_plain(data) else None
        self._tail = block if table is None else block[cut:]
        if table is not None:
            self.number += table.num_rows
        return table

    def rest(self) -> io.BufferedReader:
        """What no block has given."""
        return io.BufferedReader(_Joined(self._tail, self._stream))

    def _is_plain(self, data: bytes) -> bool:
        if not data or b'"' in data or b"\0" in data or data.count(b"\r") != data.count(b"\r\n"):
            return False
        if not data.endswith(b"\n"):
            data += b"\n"
        characters = np.frombuffer(data, np.uint8)
        ends = np.flatnonzero(characters == ord("\n"))
        between = np.flatnonzero(characters == ord(self._delimiter))
        fields = np.diff(np.searchsorted(between, ends), prepend=0)
        return bool((fields == self._width - 1).all()) and self._width > 1

    def _read(self, data: bytes) -> Any:
        import pyarrow as pa
        from pyarrow import csv

        names = list(map(str, range(self._width)))
        try:
            return csv.read_csv(
                pa.BufferReader(data),
                csv.ReadOptions(column_names=names, block_size=len(data) + 1),
                csv.ParseOptions(
                    delimiter=self._delimiter.decode(),
                    quote_char=False,
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
