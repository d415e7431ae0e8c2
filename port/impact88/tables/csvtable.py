"""Comma-separated values: a header of names, a row for each scene.

Fields are separated by commas, semicolons or tabs (detected in the header), quoted as usual, and
passed through as they stand. With pyarrow the file is read in blocks while these are plain: what is
quoted is quoted from a field's begin to its end (RFC 4180), and every record has as many fields as
the header. From the first block that is not, it is read line by line, and so is a file of one
block: pyarrow, and pandas with it where that is installed, is imported for the others alone.
"""

import csv
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from itertools import chain, takewhile
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError, quoted
from ..files import LONGEST_LINE
from ..names import RESULTS, SCENE
from .budget import EMPTY_CELL
from .cells import plain
from .lines import Lines, open_text, writing
from .rows import (
    BLOCK_CELLS,
    BLOCK_CHARACTERS,
    BLOCK_ROWS,
    ArrowTexts,
    Column,
    Named,
    Put,
    Reader,
    Rows,
    scene_names,
    shortest,
)

# between these every version of pyarrow writes numbers as Python does, without an exponent
_MIN_WITHOUT_EXPONENT = 1e-3
_MAX_WITHOUT_EXPONENT = 1e10
_LIVE = ("=", "@")
BLOCK_BYTES = 1 << 22
"""A pass over a block of 4 MB takes some milliseconds; blocks of 1 and of 16 MB take as long."""


def arrow_available() -> bool:
    """Return whether pyarrow is installed."""
    return find_spec("pyarrow") is not None


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


def _parse_plain(
    data: bytes, delimiter: str, width: int
) -> tuple[list[ArrowTexts], NDArray[np.int64]] | None:
    """The fields of plain records, and the line in which each record ends; None of others."""
    if width < 2 or b"\0" in data or data.count(b"\r") != data.count(b"\r\n"):
        return None
    import pyarrow as pa
    from pyarrow import compute, csv

    characters = np.frombuffer(data, np.uint8)
    newlines = ends = np.flatnonzero(characters == ord("\n"))
    quotes = np.flatnonzero(characters == ord('"'))
    if quotes.size:
        opening, closing = quotes[::2], quotes[1::2]
        around = np.array([*delimiter.encode(), *b'\r\n"'], np.uint8)
        before = characters[np.maximum(opening - 1, 0)][opening > 0]
        after = characters[np.minimum(closing + 1, characters.size - 1)]
        if quotes.size % 2 or not (np.isin(before, around).all() and np.isin(after, around).all()):
            return None
        # what an odd number of quotes precedes is quoted
        ends = newlines[np.searchsorted(quotes, newlines) % 2 == 0]
    if (np.diff(ends, prepend=-1) < width + (b"\r" in data)).any():  # an empty line
        return None
    names = list(map(str, range(width)))
    try:
        table = csv.read_csv(
            pa.BufferReader(data),
            csv.ReadOptions(column_names=names, block_size=len(data) + 1),
            csv.ParseOptions(
                delimiter=delimiter,
                quote_char='"' if quotes.size else False,
                newlines_in_values=bool(quotes.size),
                ignore_empty_lines=False,
            ),
            csv.ConvertOptions(column_types=dict.fromkeys(names, pa.string())),
        )
    except pa.ArrowInvalid:  # no UTF-8, or another count of fields: the reader of lines says where
        return None
    if not data.endswith(b"\n") or table.num_rows != ends.size:
        return None
    arrays = [column.chunk(0) for column in table.combine_chunks().columns]
    numbers = np.searchsorted(newlines, ends) + 1
    is_blank = np.ones(ends.size, np.bool_)
    for array in arrays:  # a row of bare delimiters is no row
        if not is_blank.any():
            break
        is_blank &= compute.equal(array, "").to_numpy(zero_copy_only=False)
    if is_blank.any():
        mask = pa.array(~is_blank)
        arrays, numbers = [array.filter(mask) for array in arrays], numbers[~is_blank]
    return list(map(ArrowTexts, arrays)), numbers


def _records(lines: Lines, texts: Iterator[str], delimiter: str) -> Iterator[list[str]]:
    try:
        yield from csv.reader(texts, delimiter=delimiter, strict=True)
    except csv.Error as error:
        raise UserError(f"line {lines.number}: {error}", lines.where) from None


@contextmanager
def read(path: str, encoding: str | None, results: bool) -> Iterator[Reader]:
    """Open a CSV table. Raises UserError if it cannot be read as one."""
    with open_text(path, encoding) as lines:
        head = b""
        if arrow_available() and lines.encoding.startswith("utf-8"):
            while len(head) < LONGEST_LINE and (line := lines.binary.readline(LONGEST_LINE)):
                head += line
                bare = line.strip(b"\xef\xbb\xbf \r\n\t;,").lower()
                if bare and not bare.startswith(b"sep=") and head.count(b'"') % 2 == 0:
                    break
        lines.go_on(head, 0)
        nonblank_lines = (line for line in lines if line.strip())
        header = next(nonblank_lines, "")
        separator = re.fullmatch(r"sep=([,;|\t])", header.strip("\r\n \ufeff"), re.IGNORECASE)
        if separator:  # as Excel reads and writes it
            header = next(nonblank_lines, "")
        if not header:
            raise UserError(
                "is empty; expected a header with the names of the columns", lines.where
            )
        delimiter = "," if "," in header else max(",;\t", key=header.count)
        if separator:
            delimiter = separator[1]
        # a header may span lines inside quotes
        records = _records(lines, chain([header], lines), delimiter)
        names = [name.strip() for name in next(records, ())]
        width = len(names)
        lines.budget.check_shape(width)
        while names and not names[-1]:
            del names[-1]
        if not names:
            raise UserError("has no names in its first line; expected a header", lines.where)
        names = scene_names(names, lines.where, results)
        # a header that was taken off whole, with line ends that bytes show
        plain_ends = head.count(b"\r") == head.count(b"\r\n")
        in_blocks = lines.number == head.count(b"\n") > 0 and plain_ends
        blocks = (
            Rows(
                len(numbers), _name_columns(fields, numbers, names, delimiter, lines), numbers, bad
            )
            for fields, numbers, bad in _blocks(lines, records, delimiter, width, in_blocks)
        )
        yield Reader(names, blocks, *lines.source.extent, delimiter)


_Block = tuple[Sequence[Column], list[int], list[tuple[int, str, str]]]


def _blocks(
    lines: Lines, records: Iterator[list[str]], delimiter: str, width: int, in_blocks: bool
) -> Iterator[_Block]:
    """The fields of some rows by column, the line in which each row ends, and what is bad."""
    number = lines.number
    is_first = True
    while in_blocks:
        data = _whole_records(lines.binary, BLOCK_BYTES)
        is_all, is_first = is_first and len(data) < BLOCK_BYTES, False
        if is_all or (block := _parse_plain(data, delimiter, width)) is None:
            lines.encoding = "utf-8"
            lines.go_on(data, number)
            records, in_blocks = _records(lines, lines, delimiter), False
        else:
            numbers = (block[1] + number).tolist()
            number += data.count(b"\n")
            if numbers:
                yield block[0], numbers, []
    while True:
        rows: dict[int, list[str]] = {}  # by the line in which each ends
        lines.taken = 0
        while (
            len(rows) < BLOCK_ROWS
            and len(rows) * width < BLOCK_CELLS
            and lines.taken < BLOCK_CHARACTERS
        ):
            if (row := next(records, None)) is None:
                break
            if any(row):
                rows[lines.number] = row
            else:  # an empty line is no row, and one of bare commas neither
                lines.budget.take(EMPTY_CELL)
        if not rows:
            return
        bad = [
            (index, "", f"has {len(row)} fields; expected {width}, as in the header")
            for index, row in enumerate(rows.values())
            if len(row) != width
        ]
        for number in [list(rows)[index] for index, *_ in bad]:
            lines.budget.take(EMPTY_CELL * max(0, width - len(rows[number])))
            rows[number] = (rows[number] + [""] * width)[:width]
        yield list(zip(*rows.values(), strict=True)), list(rows), bad


def _name_columns(
    fields: Sequence[Column], numbers: list[int], names: list[str], delimiter: str, lines: Lines
) -> dict[str, Column]:
    for column in fields[len(names) :]:
        index = next((i for i, text in enumerate(column) if text), None)
        if index is not None:
            raise UserError(
                f"line {numbers[index]}: {quoted(column[index])} stands in a column that has no "
                "name",
                lines.where,
            )
    columns = dict(zip(names, fields, strict=False))
    for name in names if delimiter != "," else ():
        if name in SCENE or name in RESULTS:
            columns[name] = _with_points(columns[name])
    return columns


def _with_points(column: Column) -> Column:
    """Numbers with decimal commas as numbers with points; a comma cannot mean anything else where
    it does not separate fields. A cell with a unit stays as it is."""
    if isinstance(column, ArrowTexts):
        points = column.replaced(",", ".")
        if points.doubles() is not None:
            return points
    return [
        text if text.strip("0123456789+-.,eE \t") else text.replace(",", ".") for text in column
    ]


def _texts(column: Column) -> Sequence[str]:
    if isinstance(column, np.ndarray):
        return shortest(column)
    return column if set(map(type, column)) == {str} else list(map(plain, column))


def texts_of(values: NDArray[Any]) -> Any:
    """A pyarrow array of the texts `shortest` makes of an array."""
    import pyarrow as pa
    from pyarrow import compute

    array = pa.array(values)
    if values.dtype.kind != "f":
        return array.cast(pa.string())
    texts = array.cast(pa.string())
    size = np.abs(values)
    # pyarrow has the same digits, but another idea of when to use an exponent, and writes 1 for 1.0
    differing = (
        (size < _MIN_WITHOUT_EXPONENT)
        | (size >= _MAX_WITHOUT_EXPONENT)
        | (values == np.rint(values))
    )
    if differing.any():
        # by their bits: 0.0 equals -0.0
        distinct_bits, places = np.unique(values[differing].view(np.int64), return_inverse=True)
        python_texts = pa.array(list(map(repr, distinct_bits.view(np.float64).tolist())))
        texts = compute.replace_with_mask(
            texts, pa.array(differing), python_texts.take(pa.array(places))
        )
    return texts


def _in_arrow(column: Column) -> Any:
    """A column as pyarrow's texts; None where Python writes them."""
    if isinstance(column, ArrowTexts):
        return column.array
    if not isinstance(column, np.ndarray) or not column.dtype.isnative:
        return None
    return texts_of(column) if column.dtype.char == "d" or column.dtype.kind in "iuU" else None


def _row_bytes(arrays: Sequence[Any], delimiter: str, ends: str) -> Any:
    """The bytes of rows, those texts in quotes that hold what ends a field or a line."""
    import pyarrow as pa
    from pyarrow import compute

    def join_columns(*parts: Any, by: str = "") -> Any:
        texts = (pa.scalar(part) if isinstance(part, str) else part for part in (*parts, by))
        return compute.binary_join_element_wise(*texts)

    fields = []
    for array in arrays:
        content = bytes(array.buffers()[2] or b"")  # a search of a regex in every text takes longer
        if any(mark.encode() in content for mark in (delimiter, '"', "\r", "\n")):
            quoted_texts = join_columns('"', compute.replace_substring(array, '"', '""'), '"')
            array = compute.if_else(compute.match_substring_regex(array, ends), quoted_texts, array)
        fields.append(array)
    return join_columns(join_columns(*fields, by=delimiter), "\n").buffers()[2]


def has_live_text(column: Column) -> bool:
    """Return whether a spreadsheet program would compute a text of the column: it takes one that
    begins with = or @ for a formula."""
    if isinstance(column, ArrowTexts):
        from pyarrow import compute

        starts = (compute.starts_with(column.array, mark) for mark in _LIVE)
        return any(compute.any(mask).as_py() for mask in starts)
    if isinstance(column, np.ndarray) and column.dtype.kind not in "USO":
        return False
    return any(isinstance(cell, str) and cell.startswith(_LIVE) for cell in column)


@contextmanager
def write(path: str, delimiter: str, headings: Sequence[str]) -> Iterator[Put]:
    """Write a CSV table. From the first block of pyarrow's texts, or with as many rows as a block
    has, arrays go out through pyarrow."""
    ends = f'[{re.escape(delimiter)}"\r\n]'
    is_long = False

    def fields(column: Column) -> Sequence[str]:
        """Not every version of csv's own writer thinks of a carriage return."""
        texts = _texts(column)
        if not re.search(ends, "".join(texts)):
            return texts
        return ['"{}"'.format(t.replace('"', '""')) if re.search(ends, t) else t for t in texts]

    def put_block(columns: Named) -> None:
        nonlocal is_long
        is_long = is_long or any(
            isinstance(column, ArrowTexts) or len(column) >= BLOCK_ROWS for _, column in columns
        )
        candidates = (_in_arrow(column) for _, column in columns if through_arrow and is_long)
        arrays = list(takewhile(lambda array: array is not None, candidates))
        if arrays and len(arrays) == len(columns) and len(arrays[0]):
            file.flush()
            file.buffer.write(_row_bytes(arrays, delimiter, ends))  # type: ignore[attr-defined]
        else:
            rows = zip(*(fields(column) for _, column in columns), strict=True)
            file.writelines([f"{row}\n" for row in map(delimiter.join, rows)])

    with writing(path) as file:
        through_arrow = False
        put_block([(text, [text]) for text in headings])
        through_arrow = arrow_available() and hasattr(file, "buffer")
        yield put_block
