"""The lines of a text file of any length, each of bounded length, in bounded memory."""

import codecs
import io
import sys
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import IO, Any, cast

from ..errors import UserError, printable, quoted
from ..files import ESCAPED, LONGEST_LINE, Source, check_text, encoding_of, replacing
from .budget import Budget

_START = 4096
"""Bytes of a file's begin that are looked at."""


class Lines:
    """An iterator over lines as they stand, their ends included. ``source``: the file as it is;
    ``binary``: its bytes, unpacked; ``encoding``: what they encode; ``number``: of the line last
    given, from 1; ``taken``: the characters given since a block began; ``budget``: of what
    it decodes to. Raises UserError, naming
    file and line, for bytes that are not text, and for a line longer than `LONGEST_LINE`."""

    def __init__(self, source: Source, binary: Any, encoding: str, budget: Budget) -> None:
        self.source, self.binary, self.encoding = source, binary, encoding
        self.budget = budget
        self.where, self.number, self.taken = source.name, 0, 0
        self.go_on(b"", 0)

    def go_on(self, data: bytes, number: int) -> None:
        """Have ``data`` read before what is left of the file; ``number``: of the line before."""
        self.number = number
        self._text = self._text_of(io.BytesIO(data))
        self._left = [self.binary]  # closed with what reads it: opened when its turn comes

    def _text_of(self, binary: Any) -> io.TextIOWrapper:
        return io.TextIOWrapper(binary, self.encoding, newline="")

    def __iter__(self) -> Iterator[str]:
        return self

    def begins_with(self, mark: str) -> bool:
        """Return whether the text's first character that is no space is ``mark``; nothing is taken
        of it."""
        start = self.binary.peek(_START)[:_START].decode(self.encoding, "ignore")
        return bool(start.lstrip("\ufeff \t\r\n")[:1] == mark)

    def read(self, size: int) -> str:
        """The next ``size`` characters, fewer at the end only."""
        return self._take(lambda text: text.read(size))

    def _take(self, take: Callable[[io.TextIOWrapper], str]) -> str:
        """Return what ``take`` takes of the text. Raises UserError where it cannot be read."""
        try:
            line = take(self._text)
            if not line and self._left:
                self._text = self._text_of(self._left.pop())
                line = take(self._text)
            return line
        except UnicodeError:
            problem = (
                f"contains bytes that are not {self.encoding.removesuffix('-sig').upper()} text"
            )
            raise UserError(
                f"{problem}, in line {self.number + 1} or after it; expected UTF-8, or the "
                "encoding named, such as --encoding cp1252 for older Excel",
                self.where,
            ) from None
        except (EOFError, zlib.error, OSError) as error:
            raise self._error(f"cannot be unpacked: {error}") from None

    def __next__(self) -> str:
        line = self._take(lambda text: text.readline(LONGEST_LINE))
        if not line:
            raise StopIteration
        if len(line) >= LONGEST_LINE:
            raise self._error(f"is longer than {LONGEST_LINE:,} characters; expected a table's row")
        self.number += 1
        self.taken += len(line)
        return line

    def _error(self, message: str) -> UserError:
        return UserError(f"line {self.number + 1} {message}", self.where)


class _Unpacked(io.RawIOBase):
    """The bytes of a packed stream, counted as they are unpacked."""

    def __init__(self, packed: Any, budget: Budget) -> None:
        import gzip

        self._file, self._budget = gzip.GzipFile(fileobj=packed), budget

    def readable(self) -> bool:
        """Return True."""
        return True

    def readinto(self, buffer: Any) -> int:
        """Read into ``buffer``. Raises UserError past the budget."""
        count = self._file.readinto(buffer)
        self._budget.take(count)
        return count


@contextmanager
def open_text(path: str, encoding: str | None = None) -> Iterator[Lines]:
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
        budget = Budget(path)
        if path.lower().endswith(".gz"):
            binary = io.BufferedReader(_Unpacked(binary, budget))
        try:
            start = binary.peek(_START)[:_START]
        except (EOFError, zlib.error, OSError) as error:
            raise UserError(f"cannot be unpacked: {error}", source.name) from None
        check_text(start, source.name, "a table of text")
        name = encoding or encoding_of(start)
        yield Lines(source, binary, "utf-8-sig" if name == "utf-8" else name, budget)


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
        return
    is_packed = path.lower().endswith(".gz")
    with replacing(path, "wb" if is_packed else "w") as file:
        if is_packed:
            import gzip

            gzip_file: Any = gzip.GzipFile("", "wb", 6, file, mtime=0)
            with io.TextIOWrapper(gzip_file, "utf-8", ESCAPED, newline="\n") as text:
                yield text
        else:
            yield file
