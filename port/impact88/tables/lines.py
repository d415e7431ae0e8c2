"""The lines of a text file of any length, each of bounded length, in bounded memory."""

from __future__ import annotations

import io
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ..errors import UserError
from ..files import LONGEST_LINE, Source, called, encoding_of


class Lines:
    """An iterator over lines as they stand, their ends included.

    ``number``: of the line last given, from 1; ``taken``: the characters given since `begin_block`.
    Raises UserError, naming file and line, for bytes that are no text, and for a line, or several
    since `begin_record`, longer than `LONGEST_LINE` characters.
    """

    def __init__(self, text: io.TextIOWrapper, source: Source) -> None:
        self.where = source.name
        self.size = source.size
        self.number = 0
        self.taken = 0
        self._record_start = 0
        self._source = source
        self._encoding = text.encoding
        self._readline = text.readline

    def __iter__(self) -> Iterator[str]:
        return self

    def __next__(self) -> str:
        try:
            line = self._readline(LONGEST_LINE)
        except UnicodeDecodeError:
            what = f"holds bytes that are no {self._encoding[:6].rstrip('-').upper()} text"
            raise UserError(f"{what}, in line {self.number + 1} or after it", self.where) from None
        except (EOFError, zlib.error, OSError) as error:
            raise self.error(f"cannot be unpacked: {error}") from None
        if not line:
            raise StopIteration
        self.number += 1
        self.taken += len(line)
        if self.taken - self._record_start >= LONGEST_LINE:
            raise self.error(f"is longer than {LONGEST_LINE:,} characters; expected a table's row")
        return line

    def begin_record(self) -> None:
        """What comes next is a new record."""
        self._record_start = self.taken

    def begin_block(self) -> None:
        """What comes next is a new block: count its characters from here."""
        self.taken = self._record_start = 0

    def error(self, message: str) -> UserError:
        """A UserError about the line after the last one given."""
        return UserError(f"line {self.number + 1} {message}", self.where)

    def position(self) -> int:
        """The bytes of the file read so far."""
        return self._source.count


@contextmanager
def open_lines(path: str) -> Iterator[Lines]:
    """A text file: UTF-8, or UTF-16 with its mark, unpacked when its name ends in ``.gz``; ``-`` is
    standard input. Raises UserError if it cannot be opened."""
    with Source(path) as source:
        binary: Any = io.BufferedReader(source, 1 << 17)
        if path.lower().endswith(".gz"):
            import gzip

            binary = io.BufferedReader(gzip.GzipFile(fileobj=binary))
        try:
            start = binary.peek(3)[:3]
        except (EOFError, zlib.error, OSError) as error:
            raise UserError(f"cannot be unpacked: {error}", called(path)) from None
        encoding = encoding_of(start)
        if encoding == "utf-8-sig" or not start:
            encoding = "utf-8-sig"
        yield Lines(io.TextIOWrapper(binary, encoding=encoding, newline=""), source)
