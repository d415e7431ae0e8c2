"""Tables as text: CSV and JSON Lines, read a block of rows at a time, and written.

polars (extra ``tables``) splits plain CSV; the csv module takes every file, names the line of a row
that is not as wide as the headings, and gives the same texts.
"""

from __future__ import annotations

import csv
import io
import json
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from itertools import islice
from typing import IO, Any, NamedTuple

import numpy as np

from ..errors import UserError, quoted
from ..files import LONGEST_LINE, Source, decode, display_name, encoding_of
from ..names import RESULTS, SCENE

Column = Any
"""A column of a block: an array of numbers, a list of texts, or a polars series."""

CHUNK_BYTES = 8_000_000  # of CSV read at a time: some 60,000 rows, more gain nothing
BLOCK_ROWS = 20_000  # of other formats
MAX_BLANK_LINES = 1_000  # in a row; more are no JSON Lines, and take long to skip
MAX_COLUMNS = 10_000  # beyond it a file is no table of scenes, and splitting it takes long


class Block(NamedTuple):
    """Rows of a table: columns by heading, and the number of each row's line in the file."""

    columns: Mapping[str, Column]
    rows: Sequence[int]


class Table(NamedTuple):
    """A table being read.

    ``names``: its headings; ``blocks``: its rows; ``where``: its name in messages; ``counts``: what
    row numbers count, "line" or "row"; ``decimal_comma``: True where numbers have one;
    ``remarks``: how it was read; ``extent``: the file's size in bytes, None if that is not known,
    and a function that returns how many were read."""

    names: list[str]
    blocks: Iterator[Block]
    where: str = "table"
    counts: str = "row"
    decimal_comma: bool = False
    remarks: tuple[str, ...] = ()
    extent: tuple[int | None, Callable[[], int]] = (None, int)


def check_headings(names: Sequence[str], where: str) -> list[str]:
    """Return headings without blanks around them. Raises UserError for one that is empty or there
    twice, and for too many."""
    headings = [name.strip() for name in names]
    if not any(headings):
        raise UserError("holds nothing; expected a line of headings", where)
    if len(headings) > MAX_COLUMNS:
        raise UserError(f"has more than {MAX_COLUMNS:,} columns; expected a table of scenes", where)
    if len({*headings}) < len(headings) or "" in headings:
        name = next(n for at, n in enumerate(headings) if not n or n in headings[:at])
        fault = f"{quoted(name)} twice" if name else f"no name for column {headings.index('') + 1}"
        raise UserError(f"the headings have {fault}; expected a name for each column", where)
    return headings


def heading_name(heading: str) -> tuple[str, str]:
    """Return the name and the unit, "" without one, of a heading such as ``ux``, ``UX [mph]`` or
    ``MA (lb)``; no name for a column that is no quantity."""
    match = re.fullmatch(r"\s*(\w+)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*", heading)
    name = match[1].upper() if match else ""
    if match is None or (name not in SCENE and name not in RESULTS):
        return "", ""
    return name, "" if match[2] in (None, "1", "-", "bits") else match[2]


# -- CSV


def read_csv(path: str, encoding: str = "") -> Table:
    """Return the table in a CSV file, ``-`` for standard input; fields are separated by commas,
    semicolons or tabs. Raises UserError."""
    where, source = display_name(path), Source(path)
    extent = source.extent
    chunks = _chunks(source, where)
    first = next(chunks, b"")
    if encoding or encoding_of(first) != "utf-8":
        first, chunks = _recode(b"".join([first, *chunks]), where, encoding), iter(())
    text = _utf8(first, where, 0)
    head = text.split("\n", 1)[0]
    delimiter = max(",;\t", key=head.count)
    with _csv_errors(where):
        reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
        names = check_headings(next(reader, []), where)
    body = first.split(b"\n", reader.line_num)[-1] if first.count(b"\n") >= reader.line_num else b""

    def blocks() -> Iterator[Block]:
        line = reader.line_num + 1
        for chunk in _chain(body, chunks):
            split = _split_plain if find_spec("polars") else _split
            yield from split(chunk, names, delimiter, line, where)
            line += chunk.count(b"\n")

    return Table(names, blocks(), where, "line", delimiter == ";", extent=extent)


@contextmanager
def _csv_errors(where: str) -> Iterator[None]:
    """Context in which errors of the csv module are UserErrors."""
    csv.field_size_limit(LONGEST_LINE)
    try:
        yield
    except csv.Error as error:
        raise UserError(f"is not CSV: {error}", where) from None


def _chain(first: bytes, others: Iterable[bytes]) -> Iterator[bytes]:
    """Yield chunks that hold anything."""
    if first:
        yield first
    yield from others


def _chunks(source: Source, where: str) -> Iterator[bytes]:
    """Yield the bytes of a CSV file in chunks that end with a row's end outside quotes."""
    rest = b""
    while data := source.read(CHUNK_BYTES):
        rest += data
        end = rest.rfind(b"\n") + 1
        if end and rest.count(b'"', 0, end) % 2 == 0:
            yield _with_newlines(rest[:end])
            rest = rest[end:]
        elif len(rest) > 4 * CHUNK_BYTES:
            raise UserError("has a line or a quoted text that does not end; expected CSV", where)
    source.close()
    if rest:
        yield _with_newlines(rest)


def _with_newlines(data: bytes) -> bytes:
    """Return bytes whose lines end with a newline alone."""
    return data.replace(b"\r\n", b"\n") if b"\r" in data else data


def _recode(data: bytes, where: str, encoding: str) -> bytes:
    """Return text in an encoding, by default that of its mark, as UTF-8. Raises UserError."""
    try:
        text = data.decode(encoding) if encoding else decode(data, where)
    except (LookupError, UnicodeDecodeError) as error:
        raise UserError(f"cannot be read as {quoted(encoding)}: {error}", where) from None
    return _with_newlines(text.encode())


def _utf8(chunk: bytes, where: str, line: int) -> str:
    """Return the text of bytes. Raises UserError."""
    try:
        return chunk.decode("utf-8-sig" if line == 0 else "utf-8")
    except UnicodeDecodeError as error:
        place = f"{where}, line {max(line, 1) + chunk.count(bytes([10]), 0, error.start)}"
        raise UserError("is not UTF-8 text; expected --encoding, such as cp1252", place) from None


_PLAIN_CSV: dict[str, Any] = {"has_header": False, "infer_schema": False, "quote_char": None}


def _split_plain(
    chunk: bytes, names: Sequence[str], delimiter: str, line: int, where: str
) -> Iterator[Block]:
    """Yield the block of a chunk by polars where it has neither quotes nor rows of another width;
    polars fills those without a word."""
    import polars

    rows = chunk.count(b"\n") + (not chunk.endswith(b"\n"))
    is_odd = any(mark in chunk for mark in (b'"', b"\r", b"\n\n")) or chunk.startswith(b"\n")
    frame = None
    with suppress(polars.exceptions.PolarsError):  # a row of more fields, which `_split` names
        frame = None if is_odd else polars.read_csv(chunk, **_PLAIN_CSV, separator=delimiter)
    if frame is not None and frame.shape == (rows, len(names)):
        frame.columns = list(names)
        # a row of fewer fields has nothing in the last column
        fields = rows * (len(names) - 1)
        is_odd = frame[names[-1]].has_nulls() and chunk.count(delimiter.encode()) != fields
    else:
        is_odd = True
    if is_odd or frame is None:
        yield from _split(chunk, names, delimiter, line, where)
        return
    blank = frame.select(polars.all_horizontal(polars.all().is_null())).to_series()
    numbers: Sequence[int] = range(line, line + rows)
    if blank.any():
        numbers = [n for n, is_blank in zip(numbers, blank, strict=True) if not is_blank]
        frame = frame.filter(~blank)
    yield Block({name: frame[name] for name in names}, numbers)


def _split(
    chunk: bytes, names: Sequence[str], delimiter: str, line: int, where: str
) -> Iterator[Block]:
    """Yield the block of a chunk by the csv module. Raises UserError for a row of another width."""
    text = _utf8(chunk, where, line)
    rows, numbers = [], []
    with _csv_errors(where):
        reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
        start = line
        for row in reader:
            if len(row) not in (0, len(names)):
                fault = f"has {len(row)} fields; expected {len(names)}, as in the headings"
                raise UserError(fault, f"{where}, line {start}")
            if any(row):
                rows.append(row)
                numbers.append(start)
            start = line + reader.line_num
    if rows:
        columns = zip(names, zip(*rows, strict=True), strict=True)
        yield Block({name: list(column) for name, column in columns}, numbers)


# -- JSON Lines


class Numeral(str):
    """The digits of a JSON number."""

    __slots__ = ()


def read_json(path: str, digits: bool = False) -> Table:
    """Return the table in a file of JSON Lines, one object for each row, or of one array of
    objects. ``digits``: keep those of numbers. Raises UserError."""
    where = display_name(path)
    source = Source(path)
    extent = source.extent
    records = _json_records(io.BufferedReader(source), where, Numeral if digits else None)
    first = next(records, None)
    if first is None:
        raise UserError("holds nothing; expected an object for each row", where)
    names = check_headings(list(first[1]), where)
    return Table(names, _json_blocks(names, first, records, where), where, "line", extent=extent)


def _json_records(
    file: IO[bytes], where: str, numeral: type[Numeral] | None
) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield the objects of a file, with their lines."""
    number = blank = 0
    while line := file.readline(LONGEST_LINE):
        number += 1
        place = f"{where}, line {number}"
        if number == 1 and line.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"["):
            data = line + file.read(LONGEST_LINE * 100)
            for at, row in enumerate(_json(data, where, numeral), 1):
                yield at, _record(row, f"{where}, object {at}")
            return
        if len(line) == LONGEST_LINE:
            raise UserError(f"is longer than {LONGEST_LINE:,} bytes; expected one row", place)
        if line.strip():
            blank = 0
            yield number, _record(_json(line, place, numeral), place)
        elif (blank := blank + 1) > MAX_BLANK_LINES:
            raise UserError(f"{MAX_BLANK_LINES:,} blank lines; expected an object a line", place)


def _json(data: bytes, place: str, numeral: type[Numeral] | None) -> Any:
    """Return the value of a JSON text, its numbers as ``numeral``. Raises UserError."""
    try:
        text = data.decode("utf-8-sig")
        return json.loads(text, parse_float=numeral, parse_int=numeral)
    except (ValueError, RecursionError) as error:
        reason = getattr(error, "msg", None) or "not UTF-8 text, or nested too deeply"
        raise UserError(f"is not JSON: {reason}; expected an object for each row", place) from None


def _record(value: Any, place: str) -> dict[str, Any]:
    """Return a row. Raises UserError for a value that is no flat object."""
    if not isinstance(value, dict):
        raise UserError(f"is {quoted(value)}; expected an object, a name and a value each", place)
    nested = next((name for name, x in value.items() if isinstance(x, dict | list | bool)), None)
    if nested is not None:
        raise UserError(f"{quoted(nested)} is no number and no text; expected one of these", place)
    return value


def _json_blocks(
    names: Sequence[str],
    first: tuple[int, dict[str, Any]],
    records: Iterator[tuple[int, dict[str, Any]]],
    where: str,
) -> Iterator[Block]:
    """Yield the blocks of a file whose first row has the headings ``names``."""
    block = [first, *islice(records, BLOCK_ROWS)]
    known = {*names}
    while block:
        for number, row in block:
            if not row.keys() <= known:
                name = next(name for name in row if name not in known)
                fault = f"{quoted(name)} is not in the first row; expected the same names in each"
                raise UserError(fault, f"{where}, line {number}")
        columns = {name: [row.get(name) for _, row in block] for name in names}
        yield Block(columns, [number for number, _ in block])
        block = list(islice(records, BLOCK_ROWS))


# -- writing


def write_csv(file: IO[bytes], blocks: Iterable[Mapping[str, Column]]) -> None:
    """Write blocks as CSV; a number that is none is an empty field."""
    is_first = True
    for columns in blocks:
        if find_spec("polars"):
            from .polarsformats import frame_of_texts

            data = io.BytesIO()  # polars hides which error of the file it met
            frame_of_texts(columns).write_csv(data, include_header=is_first)
            file.write(data.getbuffer())
        else:
            text = io.StringIO(newline="")
            writer = csv.writer(text, lineterminator="\n")
            writer.writerows([columns.keys()] if is_first else [])
            writer.writerows(zip(*map(_cells, columns.values()), strict=True))
            file.write(text.getvalue().encode())
        is_first = False


def write_json(file: IO[bytes], blocks: Iterable[Mapping[str, Column]]) -> None:
    """Write blocks as JSON Lines; a number that is none is null."""
    for columns in blocks:
        names = list(columns)
        rows = zip(*map(_cells, columns.values()), strict=True)
        lines = [json.dumps(dict(zip(names, row, strict=True)), ensure_ascii=False) for row in rows]
        file.write("".join(f"{line}\n" for line in lines).replace("Infinity", "1e999").encode())


def _cells(column: Column) -> list[Any]:
    """Return a column as a list, None for a number that is none."""
    if isinstance(column, np.ndarray) and column.dtype.kind == "f":
        return [None if math.isnan(x) else x for x in column.tolist()]
    if hasattr(column, "to_list"):
        return column.to_list()  # type: ignore[no-any-return]
    return column.tolist() if isinstance(column, np.ndarray) else list(column)
