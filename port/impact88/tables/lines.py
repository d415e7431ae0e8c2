"""The lines of a text file of any length, each of bounded length, in bounded memory."""

import codecs
import io
import sys
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from typing import IO, Any, NamedTuple, cast

from ..errors import UserError, printable, quoted
from ..files import ESCAPED, LONGEST_LINE, Source, called, encoding_of, replacing


class TextFile(NamedTuple):
    """A text file open for reading: its bytes, unpacked; what they encode; where they come from."""

    binary: Any
    encoding: str
    source: Source


class Lines:
    """An iterator over lines as they stand, their ends included. ``first``: lines already taken off
    the file; ``before``: how many lines came before those; ``number``: of the line last given, from
    1; ``taken``: the characters given since a block began. Raises UserError, naming file and line,
    for bytes that are not text, and for a line longer than `LONGEST_LINE` characters."""

    def __init__(self, file: TextFile, first: bytes = b"", before: int = 0) -> None:
        self.where = file.source.name
        self.number = before
        self.taken = 0
        self._encoding = file.encoding
        self._open = partial(io.TextIOWrapper, encoding=file.encoding, newline="")
        self._rest = [file.binary]  # closed with what reads it: opened when its turn comes
        self._text = self._open(io.BytesIO(first))

    def __iter__(self) -> Iterator[str]:
        return self

    def __next__(self) -> str:
        try:
            line = self._text.readline(LONGEST_LINE)
            if not line and self._rest:
                self._text = self._open(self._rest.pop())
                line = self._text.readline(LONGEST_LINE)
        except UnicodeError:
            what = f"contains bytes that are not {self._encoding.removesuffix('-sig').upper()} text"
            raise UserError(
                f"{what}, in line {self.number + 1} or after it; expected UTF-8, or the encoding "
                "named, such as --encoding cp1252 for older Excel",
                self.where,
            ) from None
        except (EOFError, zlib.error, OSError) as error:
            raise self.error(f"cannot be unpacked: {error}") from None
        if not line:
            raise StopIteration
        if len(line) >= LONGEST_LINE:
            raise self.error(f"is longer than {LONGEST_LINE:,} characters; expected a table's row")
        self.number += 1
        self.taken += len(line)
        return line

    def error(self, message: str) -> UserError:
        """A UserError about the line after the last one given."""
        return UserError(f"line {self.number + 1} {message}", self.where)


@contextmanager
def open_text(path: str, encoding: str | None = None) -> Iterator[TextFile]:
    """A text file: UTF-8, or UTF-16 with its mark, or of the ``encoding`` given; unpacked when its
    name ends in ``.gz``; ``-`` is standard input. Raises UserError if it cannot be opened."""
    if encoding is not None:
        try:
            "".encode(codecs.lookup(encoding).name)
        except (LookupError, ValueError):
            raise UserError(
                f"--encoding: {quoted(encoding)} is not a known text encoding; expected one such "
                "as cp1252"
            ) from None
    with Source(path) as source:
        binary: Any = io.BufferedReader(source)
        if path.lower().endswith(".gz"):
            import gzip

            packed: Any = gzip.GzipFile(fileobj=binary)
            binary = io.BufferedReader(packed)
        try:
            start = binary.peek(3)[:3]
        except (EOFError, zlib.error, OSError) as error:
            raise UserError(f"cannot be unpacked: {error}", called(path)) from None
        name = encoding or encoding_of(start)
        yield TextFile(binary, "utf-8-sig" if name == "utf-8" else name, source)


class _Terminal(io.TextIOBase):
    """Standard output where it is a terminal: no cell's control characters reach it."""

    def write(self, text: str) -> int:
        return sys.stdout.write(printable(text, "\n\t"))


@contextmanager
def writing(path: str) -> Iterator[IO[str]]:
    """A text file to write, packed when its name ends in ``.gz`` (the same text gives the same
    bytes); ``-`` is standard output. It appears under its name when all is written."""
    if path == "-":
        yield cast(IO[str], _Terminal()) if sys.stdout.isatty() else sys.stdout
    elif path.lower().endswith(".gz"):
        import gzip

        with replacing(path, "wb") as file:
            packed: Any = gzip.GzipFile("", "wb", 6, file, mtime=0)
            with io.TextIOWrapper(packed, "utf-8", ESCAPED, newline="\n") as text:
                yield text
    else:
        with replacing(path) as file:
            yield file
