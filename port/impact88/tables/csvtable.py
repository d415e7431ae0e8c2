"""Comma-separated values: a header of names, a row for each scene.

Fields are separated by commas, semicolons or tabs (detected in the header), quoted as usual, and
passed through as they stand. With pyarrow the file is read in blocks while these are plain: what is
quoted is quoted from a field's begin to its end (RFC 4180), and every record has as many fields as
the header. From the first block that is not, it is read line by line.
"""

import csv
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import chain
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError, quoted
from ..files import LONGEST_LINE
from ..names import RESULTS, SCENE
from . import arrow
from .jsontext import plain
from .lines import Lines, TextFile, open_text, writing
from .rows import (
    BLOCK_CHARACTERS,
    BLOCK_ROWS,
    BadCell,
    Column,
    Reader,
    Rows,
    Writer,
    scene_names,
    shortest,
)

BLOCK_BYTES = 1 << 22
"""A pass over a block of 4 MB takes some milliseconds; blocks of 1 and of 16 MB take as long."""


def _whole_records(stream: Any, size: int) -> bytes:
    """At least ``size`` bytes, up to the end of a line outside quotes if that comes soon."""
    parts: list[bytes] = [stream.read(size)]
    quotes = parts[0].count(b'"')
    for _ in range(10_000):
        parts.append(stream.readline(LONGEST_LINE))
        quotes += parts[-1].count(b'"')
        if not parts[-1] or (quotes % 2 == 0 and parts[-1].endswith(b"\n")):
            break
    data = b"".join(parts)
    return data if parts[-1] or not data or data.endswith(b"\n") else data + b"\n"


def _records(
    data: bytes, delimiter: str, width: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]] | None:
    """Where each record ends, and in which line; None if the data are not plain."""
    if width < 2 or b"\0" in data or data.count(b"\r") != data.count(b"\r\n"):
        return None
    if not data.endswith(b"\n"):
        return None
    characters = np.frombuffer(data, np.uint8)
    newlines = ends = np.flatnonzero(characters == ord("\n"))
    between = np.flatnonzero(characters == ord(delimiter))
    if b'"' in data:
        quotes = np.flatnonzero(characters == ord('"'))
        opening, closing = quotes[::2], quotes[1::2]
        around = np.array([*delimiter.encode(), *b'\r\n"'], np.uint8)
        before = characters[np.maximum(opening - 1, 0)][opening > 0]
        after = characters[np.minimum(closing + 1, characters.size - 1)]
        if quotes.size % 2 or not (np.isin(before, around).all() and np.isin(after, around).all()):
            return None
        # what an odd number of quotes precedes is quoted
        ends = newlines[np.searchsorted(quotes, newlines) % 2 == 0]
        between = between[np.searchsorted(quotes, between) % 2 == 0]
    fields = np.diff(np.searchsorted(between, ends), prepend=0)
    if (fields != width - 1).any():
        return None
    return ends, np.searchsorted(newlines, ends) + 1


def _parsed(data: bytes, delimiter: str, width: int) -> Any:
    """Plain records as pyarrow's columns of texts; None where it sees others."""
    import pyarrow as pa
    from pyarrow import csv

    names = list(map(str, range(width)))
    quotes = b'"' in data
    try:
        table = csv.read_csv(
            pa.BufferReader(data),
            csv.ReadOptions(column_names=names, block_size=len(data) + 1),
            csv.ParseOptions(
                delimiter=delimiter,
                quote_char='"' if quotes else False,
                newlines_in_values=quotes,
                ignore_empty_lines=False,
            ),
            csv.ConvertOptions(column_types=dict.fromkeys(names, pa.string())),
        )
    except pa.ArrowInvalid:  # bytes that are no UTF-8: the reader of lines says where
        return None
    return [column.chunk(0) for column in table.combine_chunks().columns]


class _CsvReader:
    def __init__(self, file: TextFile) -> None:
        self._file = file
        head = b""
        if arrow.available() and file.encoding.startswith("utf-8"):
            while len(head) < LONGEST_LINE and (line := file.binary.readline(LONGEST_LINE)):
                head += line
                bare = line.strip(b"\xef\xbb\xbf \r\n\t;,").lower()
                if bare and not bare.startswith(b"sep=") and head.count(b'"') % 2 == 0:
                    break
        self._lines = Lines(file, head)
        names = self._header()
        self._width = len(names)
        while names and not names[-1]:
            del names[-1]
        if not names:
            raise UserError("has no names in its first line; expected a header", file.source.name)
        self.names = scene_names(names, file.source.name)
        # a header that was taken off whole, with line ends that bytes show
        plain_ends = head.count(b"\r") == head.count(b"\r\n")
        self._in_blocks = self._lines.number == head.count(b"\n") > 0 and plain_ends

    def _header(self) -> list[str]:
        lines = self._lines
        filled = (line for line in lines if line.strip())
        header = next(filled, "")
        separator = re.fullmatch(r"sep=([,;|\t])", header.strip("\r\n \ufeff"), re.IGNORECASE)
        if separator:  # as Excel reads and writes it
            header = next(filled, "")
        if not header:
            raise UserError(
                "is empty; expected a header with the names of the columns", lines.where
            )
        self.delimiter = "," if "," in header else max(",;\t", key=header.count)
        if separator:
            self.delimiter = separator[1]
        # a header may span lines inside quotes: give the reader the line back
        self._rows = csv.reader(chain([header], lines), delimiter=self.delimiter, strict=True)
        return [name.strip() for name in self._next() or ()]

    def blocks(self) -> Iterator[Rows]:
        first, number = 1, self._lines.number
        while self._in_blocks:
            data = _whole_records(self._file.binary, BLOCK_BYTES)
            found = _records(data, self.delimiter, self._width)
            columns = found and _parsed(data, self.delimiter, self._width)
            if found is None or columns is None or len(columns[0]) != found[0].size:
                self._lines = Lines(self._file._replace(encoding="utf-8"), data, number)
                self._rows = csv.reader(self._lines, delimiter=self.delimiter, strict=True)
                break
            lines = (found[1] + number).tolist()
            yield self._rows_of(first, list(map(arrow.ArrowTexts, columns)), lines, [])
            first, number = first + len(lines), lines[-1]
        while block := self._block():
            rows, bad = list(block.values()), []
            for index, (line, row) in enumerate(block.items()):
                if len(row) != self._width:
                    reason = f"has {len(row)} fields; expected {self._width}, as in the header"
                    bad.append(BadCell(first + index, line, "", reason))
                    rows[index] = (row + [""] * self._width)[: self._width]
            yield self._rows_of(first, list(zip(*rows, strict=True)), list(block), bad)
            first += len(rows)

    def _block(self) -> dict[int, list[str]]:
        """The next rows by the line in which each ends."""
        rows: dict[int, list[str]] = {}
        self._lines.taken = 0
        while len(rows) < BLOCK_ROWS and self._lines.taken < BLOCK_CHARACTERS:
            row = self._next()
            if row is None:
                break
            if row:  # an empty line is no row
                rows[self._lines.number] = row
        return rows

    def _next(self) -> list[str] | None:
        try:
            return next(self._rows, None)
        except csv.Error as error:
            raise UserError(f"line {self._lines.number}: {error}", self._lines.where) from None

    def _rows_of(
        self, first: int, fields: list[Any], lines: Sequence[int], bad: list[BadCell]
    ) -> Rows:
        for column in fields[len(self.names) :]:
            index = next((i for i, text in enumerate(column) if text), None)
            if index is not None:
                raise UserError(
                    f"line {lines[index]}: {quoted(column[index])} stands in a column that has no "
                    "name",
                    self._lines.where,
                )
        named = (
            (n, _with_points(c) if self.delimiter != "," and (n in SCENE or n in RESULTS) else c)
            for n, c in zip(self.names, fields, strict=False)
        )
        return Rows.of(first, len(lines), named, lines, bad)


def _with_points(column: Column) -> Column:
    """Numbers with decimal commas as numbers with points; a comma cannot mean anything else where
    it does not separate fields. A cell with a unit stays as it is."""
    if isinstance(column, arrow.ArrowTexts):
        points = column.replaced(",", ".")
        if points.doubles() is not None:
            return points
    return [
        text if text.strip("0123456789+-.,eE \t") else text.replace(",", ".") for text in column
    ]


@contextmanager
def read(path: str, form: str, encoding: str | None) -> Iterator[Reader]:
    """Open a CSV table. Raises UserError if it cannot be read as one."""
    with open_text(path, encoding) as file:
        table = _CsvReader(file)
        yield Reader(table.names, table.blocks(), *file.source.extent, table.delimiter)


class _CsvWriter(Writer):
    """Blocks whose columns are all pyarrow's texts go out through pyarrow."""

    kind = "a CSV table"

    def __init__(self, file: IO[str], delimiter: str, *columns: Any) -> None:
        super().__init__(*columns)
        self._file = file
        self._delimiter = delimiter
        self._ends = f'[{re.escape(delimiter)}"\r\n]'
        self._write([[text] for text in self.headings])
        self._through_arrow = arrow.available() and hasattr(file, "buffer")

    def put(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None:
        columns = [rows.one_per_row(name) for name in self.kept]
        texts = [column.array for column in columns if isinstance(column, arrow.ArrowTexts)]
        if self._through_arrow and len(texts) == len(columns):
            arrays = [*texts, *(arrow.texts_of(results[name]) for name in self.results)]
            self._file.flush()
            self._file.buffer.write(self._joined(arrays))  # type: ignore[attr-defined]
        else:
            self._write([*map(_fields, columns), *(shortest(results[n]) for n in self.results)])

    def _write(self, columns: Sequence[Sequence[str]]) -> None:
        rows = zip(*map(self._quoted, columns), strict=True)
        self._file.writelines([f"{row}\n" for row in map(self._delimiter.join, rows)])

    def _quoted(self, column: Sequence[str]) -> Sequence[str]:
        """The texts, those in quotes that hold what ends a field or a line; not every version of
        csv's own writer thinks of a carriage return."""
        ends = re.compile(self._ends)
        if not ends.search("".join(column)):
            return column
        return [
            '"{}"'.format(text.replace('"', '""')) if ends.search(text) else text for text in column
        ]

    def _joined(self, arrays: Sequence[Any]) -> Any:
        """The same of pyarrow's texts: the bytes of whole rows."""
        import pyarrow as pa
        from pyarrow import compute

        def joined(*parts: Any, by: str = "") -> Any:
            texts = (pa.scalar(part) if isinstance(part, str) else part for part in (*parts, by))
            return compute.binary_join_element_wise(*texts)

        fields = []
        for array in arrays:
            held = bytes(
                array.buffers()[2] or b""
            )  # a search of a regex in every text takes longer
            if any(mark.encode() in held for mark in (self._delimiter, '"', "\r", "\n")):
                ends = compute.match_substring_regex(array, self._ends)
                doubled = joined('"', compute.replace_substring(array, '"', '""'), '"')
                array = compute.if_else(ends, doubled, array)
            fields.append(array)
        return joined(joined(*fields, by=self._delimiter), "\n").buffers()[2]


def _fields(column: Column) -> Sequence[str]:
    if isinstance(column, np.ndarray):
        return shortest(column)
    return column if set(map(type, column)) == {str} else list(map(plain, column))


@contextmanager
def write(path: str, form: str, delimiter: str, *columns: Any) -> Iterator[Writer]:
    """Write a CSV table."""
    with writing(path) as file:
        yield _CsvWriter(file, delimiter, *columns)
