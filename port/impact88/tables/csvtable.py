"""Comma-separated values: a header of names, a row for each scene.

Fields may be separated by commas, semicolons or tabs (told from the header) and quoted as usual.
Every field is passed through as it stands; floats are written with the fewest digits that read back
to the same double.
"""

from __future__ import annotations

import csv
import io
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import islice
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError
from ..files import replacing
from ..names import SCENE
from .rows import BLOCK_ROWS, BadCell, Column, Reader, Rows, Writer, shortest


@contextmanager
def open_text(path: str) -> Iterator[tuple[io.TextIOWrapper[Any], int | None]]:
    """A text file (UTF-8, or UTF-16 with its mark; ``-`` is standard input) and its size in bytes.

    Raises UserError if it cannot be opened or is no such text.
    """
    try:
        binary = sys.stdin.buffer if path == "-" else open(path, "rb")  # noqa: SIM115
    except OSError as error:
        raise UserError(f"cannot be read: {error.strerror or error}", path) from None
    where = "standard input" if path == "-" else path
    text: io.TextIOWrapper[Any] | None = None
    try:
        start = binary.peek(3)[:3] if isinstance(binary, io.BufferedReader) else b""
        encoding = "utf-16" if start[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
        text = io.TextIOWrapper(binary, encoding=encoding, newline="")
        size = None
        if path != "-" and os.path.isfile(path):
            size = os.path.getsize(path)
        yield text, size
    except UnicodeDecodeError as error:
        raise UserError(f"holds bytes that are no {error.encoding} text", where) from None
    finally:
        if path != "-":
            binary.close()
        elif text is not None:
            text.detach()


class _CsvReader:
    def __init__(self, text: io.TextIOWrapper[Any], size: int | None, where: str) -> None:
        self.total = size
        self._text = text
        self._where = where
        header = text.readline()
        if not header.strip():
            raise UserError("is empty; expected a header with the names of the columns", where)
        self.delimiter = max(",;\t", key=header.count) if header.count(",") == 0 else ","
        # a header may span lines inside quotes: give the reader the line back
        self._rows = csv.reader(_chain(header, text), delimiter=self.delimiter, strict=True)
        try:
            self.names = [name.strip() for name in next(self._rows)]
        except csv.Error as error:
            raise UserError(f"line 1: {error}", where) from None
        twice = [n for i, n in enumerate(self.names) if n in self.names[:i]]
        if twice:
            raise UserError(f"has two columns named {twice[0]!r}", where)

    def position(self) -> int:
        return 0 if self.total is None else self._text.buffer.tell()

    def __iter__(self) -> Iterator[Rows]:
        first, width = 1, len(self.names)
        while True:
            rows, lines = self._block()
            if not rows:
                return
            bad = []
            for index, row in enumerate(rows):
                if len(row) != width:
                    reason = f"has {len(row)} fields; expected {width}, as in the header"
                    bad.append(BadCell(first + index, lines[index], "", reason))
                    rows[index] = (row + [""] * width)[:width]
            columns: dict[str, Column] = {}
            others: dict[str, Column] = {}
            for name, fields in zip(self.names, zip(*rows, strict=True), strict=True):
                (columns if name in SCENE else others)[name] = fields
            yield Rows(first, len(rows), columns, others, lines, bad)
            first += len(rows)

    def _block(self) -> tuple[list[list[str]], list[int]]:
        rows, lines = [], []
        filled = (row for row in self._rows if row)  # an empty line is no row
        try:
            for row in islice(filled, BLOCK_ROWS):
                rows.append(row)
                lines.append(self._rows.line_num)
        except csv.Error as error:
            raise UserError(f"line {self._rows.line_num}: {error}", self._where) from None
        return rows, lines


def _chain(first: str, rest: Iterator[str]) -> Iterator[str]:
    yield first
    yield from rest


@contextmanager
def read_csv(path: str) -> Iterator[Reader]:
    """Open a CSV table. Raises UserError if it cannot be read as one."""
    where = "standard input" if path == "-" else path
    with open_text(path) as (text, size):
        yield _CsvReader(text, size, where)


class _CsvWriter:
    def __init__(
        self, file: IO[str], kept: Sequence[str], results: Sequence[str], delimiter: str
    ) -> None:
        self._kept = kept
        self._results = results
        self._rows = csv.writer(file, delimiter=delimiter, lineterminator="\n")
        self._rows.writerow([*kept, *results])

    def write(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None:
        kept = (_fields(rows.kept(name)) for name in self._kept)
        found = (shortest(results[name]) for name in self._results)
        self._rows.writerows(zip(*kept, *found, strict=True))


def _fields(column: Column) -> Sequence[Any]:
    if isinstance(column, np.ndarray):
        return shortest(column)
    return column  # csv writes None as an empty field


@contextmanager
def write_csv(
    path: str, kept: Sequence[str], results: Sequence[str], delimiter: str
) -> Iterator[Writer]:
    """Write a CSV table, see `tables.table.open_writer`."""
    if path == "-":
        yield _CsvWriter(sys.stdout, kept, results, delimiter)
        return
    with replacing(path) as file:
        yield _CsvWriter(file, kept, results, delimiter)
