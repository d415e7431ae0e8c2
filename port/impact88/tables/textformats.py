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
from contextlib import suppress
from importlib.util import find_spec
from itertools import chain, islice
from typing import IO, Any, NamedTuple

import numpy as np

from ..errors import UserError, quoted
from ..files import LONGEST_LINE, Source, decode, display_name, encoding_of
from ..names import RESULTS, SCENE

Column = Any
"""A column of a block: an array of numbers, a list of texts, or a polars series."""

CHUNK_BYTES = 8_000_000  # of CSV read at a time: some 60,000 rows, more gain nothing
BLOCK_ROWS = 20_000  # of other formats
MAX_COLUMNS = 10_000  # beyond it a file is no table of scenes, and splitting it takes long


class Block(NamedTuple):
    """Rows of a table: columns by heading, and the number of each row's line in the file."""

    columns: Mapping[str, Column]
    rows: Sequence[int]


class Table(NamedTuple):
    """A table being read.

    ``names``: its headings; ``blocks``: its rows; ``where``: its name in messages; ``counts``: what
    row numbers count, "line" or "row";
    ``remarks``: how it was read; ``extent``: the file's size in bytes, None if that is not known,
    and a function that returns how many were read."""

    names: list[str]
    blocks: Iterator[Block]
    where: str = "table"
    counts: str = "row"
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
    semicolons or tabs, and numbers among semicolons have a decimal comma. Raises UserError."""
    where, source = display_name(path), Source(path)
    extent = source.extent
    chunks = _chunks(source, where)
    first = next(chunks, b"")
    if encoding or encoding_of(first) != "utf-8":
        first, chunks = _recode(b"".join([first, *chunks]), where, encoding), iter(())
    line, _, body = first.partition(b"\n")
    head = _utf8(line, where, 1).removeprefix("\ufeff")
    delimiter = max(",;\t", key=head.count)
    names = check_headings(next(_split_rows(head, delimiter, where), []), where)

    def blocks() -> Iterator[Block]:
        line = 2
        for chunk in chain([body] if body else [], chunks):
            block = find_spec("polars") and _split_plain(chunk, names, delimiter, line)
            block = block or _split(chunk, names, delimiter, line, where)
            if block.rows:
                yield _with_points(block) if delimiter == ";" else block
            line += chunk.count(b"\n")

    return Table(names, blocks(), where, "line", extent=extent)


def _split_rows(text: str, delimiter: str, where: str) -> Iterator[list[str]]:
    """Yield the fields of each row, also of blank lines inside quotes. Raises UserError."""
    csv.field_size_limit(LONGEST_LINE)
    try:
        yield from csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
    except csv.Error as error:
        raise UserError(f"is not CSV: {error}", where) from None


def _chunks(source: Source, where: str) -> Iterator[bytes]:
    """Yield the bytes of a CSV file in chunks that end with a row's end outside quotes."""
    tail = b""
    while data := source.read(CHUNK_BYTES):
        tail += data
        end = tail.rfind(b"\n") + 1
        if end and tail.count(b'"', 0, end) % 2 == 0:
            yield tail[:end].replace(b"\r\n", b"\n")
            tail = tail[end:]
        elif len(tail) > 4 * CHUNK_BYTES:
            raise UserError("has a line or a quoted text that does not end; expected CSV", where)
    source.close()
    if tail:
        yield tail.replace(b"\r\n", b"\n")


def _recode(data: bytes, where: str, encoding: str) -> bytes:
    """Return text in an encoding, by default that of its mark, as UTF-8. Raises UserError."""
    try:
        text = data.decode(encoding) if encoding else decode(data, where)
    except (LookupError, UnicodeDecodeError) as error:
        raise UserError(f"cannot be read as {quoted(encoding)}: {error}", where) from None
    return text.replace("\r\n", "\n").encode()


def _utf8(chunk: bytes, where: str, line: int) -> str:
    """Return the text of bytes that begin in a line. Raises UserError."""
    try:
        return chunk.decode()
    except UnicodeDecodeError as error:
        place = f"{where}, line {line + chunk.count(bytes([10]), 0, error.start)}"
        raise UserError("is not UTF-8 text; expected --encoding, such as cp1252", place) from None


def _split_plain(chunk: bytes, names: Sequence[str], delimiter: str, line: int) -> Block | None:
    """Return the block of a chunk by polars; None where it has quotes, blank rows, or rows of
    another width, which polars fills without a word."""
    import polars

    lines = b"\n" + chunk.removesuffix(b"\n") + b"\n"
    mark = delimiter.encode()
    rows = lines.count(b"\n") - 1
    odd = (b'"', b"\r", b"\n\n", b"\n" + mark * (len(names) - 1) + b"\n")
    if any(part in lines for part in odd) or lines.count(mark) != rows * (len(names) - 1):
        return None
    options: dict[str, Any] = {"has_header": False, "infer_schema": False, "quote_char": None}
    with suppress(polars.exceptions.PolarsError):  # rows of more and of fewer fields; not UTF-8
        frame = polars.read_csv(chunk, **options, separator=delimiter)
        if frame.shape == (rows, len(names)):
            columns = dict(zip(names, frame.get_columns(), strict=True))
            return Block(columns, range(line, line + rows))
    return None


def _split(chunk: bytes, names: Sequence[str], delimiter: str, line: int, where: str) -> Block:
    """Return the block of a chunk by the csv module. Raises UserError for a row of another
    width."""
    rows, numbers = [], []
    for row in _split_rows(_utf8(chunk, where, line), delimiter, where):
        if len(row) not in (0, len(names)):
            fault = f"has {len(row)} fields; expected {len(names)}, as in the headings"
            raise UserError(fault, f"{where}, line {line}")
        if any(row):
            rows.append(row)
            numbers.append(line)
        line += 1 + sum(cell.count("\n") for cell in row)
    columns = zip(*rows, strict=True) if rows else [()] * len(names)
    return Block({n: list(column) for n, column in zip(names, columns, strict=True)}, numbers)


_DECIMAL_COMMA = r"^\s*([-+]?\d*)\.?(\d*),(\d)"


def _with_points(block: Block) -> Block:
    """Return a block whose quantities have decimal points in place of decimal commas."""
    columns = dict(block.columns)
    for heading, column in columns.items():
        if not heading_name(heading)[0]:
            continue
        if isinstance(column, list):
            columns[heading] = [re.sub(_DECIMAL_COMMA, r"\1\2.\3", cell) for cell in column]
        else:
            columns[heading] = column.str.replace(_DECIMAL_COMMA, "${1}${2}.${3}")
    return block._replace(columns=columns)


# -- JSON Lines


def read_json(path: str, digits: bool = False) -> Table:
    """Return the table in a file of JSON Lines, one object for each row, or of one array of
    objects. ``digits``: keep those of numbers, as texts. Raises UserError."""
    where, source = display_name(path), Source(path)
    records = _records(io.BufferedReader(source), where, str if digits else None)
    first = next(records, None)
    if first is None:
        raise UserError("holds nothing; expected an object for each row", where)
    names = check_headings(list(first[1]), where)

    def blocks() -> Iterator[Block]:
        rows = chain([first], records)
        while block := list(islice(rows, BLOCK_ROWS)):
            for number, row in block:
                for name in row.keys() - {*names}:
                    fault = (
                        f"{quoted(name)} is not in the first row; expected the same names in each"
                    )
                    raise UserError(fault, f"{where}, line {number}")
            columns = {name: [row.get(name) for _, row in block] for name in names}
            yield Block(columns, [number for number, _ in block])

    return Table(names, blocks(), where, "line", extent=source.extent)


def _records(
    file: IO[bytes], where: str, numeral: type[str] | None
) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield the objects of a file with their lines, of an array with their numbers. Raises
    UserError for a value that is no flat object."""
    number = 0
    while line := file.readline(LONGEST_LINE):
        number += 1
        place = f"{where}, line {number}"
        if line.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"["):
            line += file.read(LONGEST_LINE * 100)
        elif len(line) == LONGEST_LINE:
            raise UserError(f"is longer than {LONGEST_LINE:,} bytes; expected one row", place)
        value = _json(line, place, numeral) if line.strip() else []
        for at, row in enumerate(value if isinstance(value, list) else [value], number):
            if not isinstance(row, dict):
                raise UserError(f"is {quoted(row)}; expected an object for each row", place)
            for name, cell in row.items():
                if isinstance(cell, dict | list | bool):
                    fault = f"{quoted(name)} is no number and no text; expected one of these"
                    raise UserError(fault, place)
            yield at, row


def _json(data: bytes, place: str, numeral: type[str] | None) -> Any:
    """Return the value of a JSON text, its numbers as ``numeral``. Raises UserError."""
    try:
        text = data.decode("utf-8-sig")
        return json.loads(text, parse_float=numeral, parse_int=numeral)
    except (ValueError, RecursionError) as error:
        reason = getattr(error, "msg", None) or "not UTF-8 text, or nested too deeply"
        raise UserError(f"is not JSON: {reason}; expected an object for each row", place) from None


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
