"""Comma-separated values: a header of names, a row for each scene.

Fields may be separated by commas, semicolons or tabs (detected in the header) and quoted as usual.
Every field is passed through as it stands; floats are written with the fewest digits that read back
to the same double.

With pyarrow the file is read in blocks of bytes, as csv would read them, while these are plain:
what is quoted is quoted from a field's begin to its end (RFC 4180), every record has as many fields
as the header, and none is empty. From the first block that is not, it is read line by line.
"""

import csv
import io
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import chain
from typing import IO, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError, quoted
from ..names import RESULTS, SCENE
from . import arrow
from .jsontext import plain
from .lines import TextFile, open_text, writing
from .rows import BLOCK_CHARACTERS, BLOCK_ROWS, BadCell, Column, Reader, Rows, Writer, shortest

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


class _CsvReader(Reader):
    def __init__(self, file: TextFile) -> None:
        self.total = file.source.size
        self._file = file
        self._blocks: PlainBlocks | None = None
        header = _plain_header(file) if arrow.available() else None
        head = file if header is None else file._replace(binary=header)
        self._lines = head.lines()
        self._start()
        if header is not None:
            width = len(self.names) + self._unnamed
            self._blocks = PlainBlocks(file.binary, self.delimiter, width, self._lines.number)

    def _start(self) -> None:
        """Read the header."""
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
        self.delimiter = max(",;\t", key=header.count) if header.count(",") == 0 else ","
        if separator:
            self.delimiter = separator.group(1)
        # a header may span lines inside quotes: give the reader the line back
        self._rows = self._reader(chain([header], lines))
        names = [name.strip() for name in self._next() or ()]
        named = names
        while named and not named[-1]:
            named = named[:-1]
        self._unnamed = len(names) - len(named)
        self._name(named, lines.where)
        if not self.names:
            raise UserError("has no names in its first line; expected a header", lines.where)

    def _reader(self, lines: Iterator[str]) -> Any:
        return csv.reader(lines, delimiter=self.delimiter, strict=True)

    def position(self) -> int:
        return 0 if self.total is None else self._lines.position()

    def __iter__(self) -> Iterator[Rows]:
        first = 1
        while self._blocks is not None and (block := self._blocks.next()) is not None:
            columns = [arrow.ArrowTexts(column.chunk(0)) for column in block.table.columns]
            yield self._rows_of(first, columns, block.lines.tolist(), [])
            first += len(block.lines)
        if self._blocks is not None:
            rest = self._file._replace(binary=self._blocks.rest(), encoding="utf-8")
            self._lines = rest.lines(self._blocks.number)
            self._rows = self._reader(self._lines)
        yield from self._line_by_line(first)

    def _line_by_line(self, first: int) -> Iterator[Rows]:
        width = len(self.names) + self._unnamed
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
            yield self._rows_of(first, list(zip(*rows, strict=True)), lines, bad)
            first += len(rows)

    def _rows_of(
        self, first: int, fields: list[Any], lines: Sequence[int], bad: list[BadCell]
    ) -> Rows:
        columns: dict[str, Column] = {}
        others: dict[str, Column] = {}
        for name, column in zip(self.names, fields, strict=False):
            if self.delimiter != "," and (name in SCENE or name in RESULTS):
                column = _with_points(column)
            (columns if name in SCENE else others)[name] = column
        for column in fields[len(self.names) :]:
            index = next((i for i, text in enumerate(column) if text), None)
            if index is not None:
                raise UserError(
                    f"line {lines[index]}: {quoted(column[index])} stands in a column that has no "
                    "name",
                    self._lines.where,
                )
        return Rows(first, len(lines), columns, others, lines, bad)

    def _block(self) -> tuple[list[list[str]], list[int]]:
        rows: list[list[str]] = []
        numbers: list[int] = []
        self._lines.begin_block()
        while len(rows) < BLOCK_ROWS and self._lines.taken < BLOCK_CHARACTERS:
            row = self._next()
            if row is None:
                break
            if row:  # an empty line is no row
                rows.append(row)
                numbers.append(self._lines.number)
        return rows, numbers

    def _next(self) -> list[str] | None:
        self._lines.begin_record()
        try:
            return next(self._rows, None)
        except csv.Error as error:
            raise UserError(f"line {self._lines.number}: {error}", self._lines.where) from None


def _plain_header(file: TextFile) -> Any:
    """The bytes up to the end of the header, taken off the file, when that can be seen without
    reading on, in UTF-8. Else nothing is taken, and there is None."""
    if not file.encoding.startswith("utf-8"):
        return None
    start = file.binary.peek(1)
    end = 0
    for line in start.split(b"\n")[:-1]:
        end += len(line) + 1
        bare = line.strip(b"\xef\xbb\xbf \r\t;,")
        if bare and not bare.lower().startswith(b"sep="):
            if start.count(b'"', 0, end) % 2:  # a name goes on in the next line
                continue
            plain = start.count(b"\r", 0, end) == start.count(b"\r\n", 0, end)
            return io.BufferedReader(io.BytesIO(file.binary.read(end))) if plain else None
    return None


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
        yield _CsvReader(file)


class _CsvWriter(Writer):
    """Blocks whose columns are all pyarrow's texts go out through pyarrow."""

    kind = "a CSV table"

    def __init__(self, file: IO[str], delimiter: str, *columns: Any) -> None:
        super().__init__(*columns)
        self._file = file
        self._delimiter = delimiter
        self._ends = re.compile(f'[{re.escape(delimiter)}"\\r\\n]')
        self._write([[text] for text in self.headings])
        self._through_arrow = arrow.available() and hasattr(file, "buffer")

    def put(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None:
        columns = [rows.one_per_row(name) for name in self.kept]
        texts = [column for column in columns if isinstance(column, arrow.ArrowTexts)]
        if self._through_arrow and len(texts) == len(columns):
            arrays = [column.array for column in texts]
            self._write_arrays(arrays + [arrow.texts_of(results[name]) for name in self.results])
        else:
            self._write([*map(_fields, columns), *(shortest(results[n]) for n in self.results)])

    def _write(self, columns: Sequence[Sequence[str]]) -> None:
        rows = zip(*map(self._quoted, columns), strict=True)
        self._file.writelines([f"{row}\n" for row in map(self._delimiter.join, rows)])

    def _write_arrays(self, arrays: Sequence[Any]) -> None:
        import pyarrow as pa
        from pyarrow import csv as arrow_csv

        options = arrow_csv.WriteOptions(
            include_header=False, delimiter=self._delimiter, quoting_style="none"
        )
        out = pa.BufferOutputStream()
        try:
            arrow_csv.write_csv(pa.table(arrays, list(map(str, range(len(arrays))))), out, options)
        except pa.ArrowInvalid:  # something has to be quoted
            out = pa.BufferOutputStream()
            out.write(_quoted_rows(arrays, self._delimiter))
        self._file.flush()
        self._file.buffer.write(out.getvalue())  # type: ignore[attr-defined]

    def _quoted(self, column: Sequence[str]) -> Sequence[str]:
        """The texts, those in quotes that hold what ends a field or a line; not every version of
        csv's own writer thinks of a carriage return."""
        if not self._ends.search("".join(column)):
            return column
        return [
            '"{}"'.format(text.replace('"', '""')) if self._ends.search(text) else text
            for text in column
        ]


def _fields(column: Column) -> Sequence[str]:
    if isinstance(column, np.ndarray):
        return shortest(column)
    return column if set(map(type, column)) == {str} else list(map(plain, column))


def _quoted_rows(arrays: Sequence[Any], delimiter: str) -> bytes:
    """Rows of fields, those in quotes that hold what ends a field or a line."""
    import pyarrow as pa
    from pyarrow import compute

    fields = []
    for array in arrays:
        ends = compute.match_substring_regex(array, f'[{re.escape(delimiter)}"\r\n]')
        if compute.any(ends).as_py():
            inner = compute.replace_substring(array, '"', '""')
            quoted_ = compute.binary_join_element_wise('"', inner, '"', "")
            array = compute.if_else(ends, quoted_, array)
        fields.append(array)
    rows = compute.binary_join_element_wise(*fields, delimiter)
    if isinstance(rows, pa.ChunkedArray):
        rows = rows.combine_chunks()
    return b"".join(row.encode() + b"\n" for row in rows.to_pylist())


@contextmanager
def write(path: str, form: str, delimiter: str, *columns: Any) -> Iterator[Writer]:
    """Write a CSV table."""
    with writing(path) as file:
        yield _CsvWriter(file, delimiter, *columns)
