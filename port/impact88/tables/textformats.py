"""Tables as text: CSV and JSON Lines, read a block of rows at a time, and written.

polars (extra ``tables``) splits plain CSV; the csv module takes every file, names the line of a row
that is not as wide as the headings, and gives the same numbers.
"""

from __future__ import annotations

import csv
import io
import json
import math
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from importlib.util import find_spec
from itertools import chain, count, islice
from typing import IO, Any, NamedTuple

import numpy as np

from ..errors import UserError, quoted
from ..files import LONGEST_LINE, Source, check_text, display_name
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
    row numbers count, "line" or "row"; ``extent``: the file's size in bytes, None if that is not
    known, and a function that returns how many were read."""

    names: list[str]
    blocks: Iterator[Block]
    where: str = "table"
    counts: str = "row"
    extent: tuple[int | None, Callable[[], int]] = (None, int)


def check_headings(names: Sequence[str], where: str) -> list[str]:
    """Return headings without blanks around them. Raises UserError for one that is empty or there
    twice, and for too many."""
    headings = [name.strip() for name in names]
    if not any(headings) or len(headings) > MAX_COLUMNS:
        raise UserError(
            f"has no line of 1 to {MAX_COLUMNS:,} headings, such as UX [mph]; expected a table or "
            "a .toml; for a printout use verify",
            where,
        )
    for name, number in Counter(headings).items():
        if number > 1 or not name:
            fault = f"{quoted(name)} twice" if name else "one that is empty"
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


def read_csv(path: str) -> Table:
    """Return the table in a CSV file, ``-`` for standard input; fields are separated by commas,
    semicolons or tabs, and numbers among semicolons have a decimal comma. Raises UserError."""
    where, source = display_name(path), Source(path)
    file = io.BufferedReader(source)
    line = file.readline(LONGEST_LINE)
    check_text(line, where, "CSV")
    head = _decode(line, where, 1).removeprefix("\ufeff")
    delimiter = max(",;\t", key=head.count)
    csv.field_size_limit(LONGEST_LINE)
    try:
        fields = next(csv.reader([head], delimiter=delimiter, strict=True), [])
    except csv.Error as error:
        raise UserError(f"is not CSV: {error}", where) from None
    names = check_headings(fields, where)

    def blocks() -> Iterator[Block]:
        number = 2
        for chunk in _chunks(file, where):
            block = _split_plain(chunk, names, delimiter, number) if find_spec("polars") else None
            block = block or _split(chunk, names, delimiter, number, where)
            if block.rows:
                yield _with_points(block) if delimiter == ";" else block
            number += _count(chunk, b"\n")

    return Table(names, blocks(), where, "line", source.extent)


def _chunks(file: IO[bytes], where: str) -> Iterator[bytes]:
    """Yield the bytes of a CSV file in chunks of whole lines that end outside quotes."""
    chunk = b""
    while data := file.read(CHUNK_BYTES):
        chunk += data + file.readline(LONGEST_LINE)
        if chunk.count(b'"') % 2 == 0:
            yield chunk if chunk.endswith(b"\n") else chunk + b"\n"
            chunk = b""
        elif len(chunk) > 4 * CHUNK_BYTES:
            raise UserError("has a quoted text that does not end; expected CSV", where)
    if chunk:
        yield chunk


def _count(chunk: bytes, character: bytes) -> int:
    """Return how often a character is in a chunk; faster than ``count`` for frequent ones."""
    return int(np.count_nonzero(np.frombuffer(chunk, np.uint8) == ord(character)))


def _decode(chunk: bytes, where: str, line: int) -> str:
    """Return the text of bytes that begin in a line. Raises UserError."""
    try:
        return chunk.decode()
    except UnicodeDecodeError as error:
        place = f"{where}, line {line + chunk.count(bytes([10]), 0, error.start)}"
        raise UserError("is not UTF-8 text; expected a file saved as CSV UTF-8", place) from None


def _split_plain(chunk: bytes, names: Sequence[str], delimiter: str, line: int) -> Block | None:
    """Return the block of a chunk by polars; None where it has quotes, blank rows, or rows of
    another width, which polars fills without a word."""
    import polars

    rows, marks = _count(chunk, b"\n"), _count(chunk, delimiter.encode())
    if b'"' in chunk or marks != rows * (len(names) - 1):
        return None
    options: dict[str, Any] = {"has_header": False, "infer_schema": False, "quote_char": None}
    with suppress(polars.exceptions.PolarsError):  # rows of more and of fewer fields; not UTF-8
        frame = polars.read_csv(chunk, **options, separator=delimiter)
        columns = dict(zip(names, frame.get_columns(), strict=False))
        has_gaps = all(column.null_count() for column in columns.values())
        if frame.shape == (rows, len(names)) and not has_gaps:
            return Block(columns, range(line, line + rows))
    return None


def _split(chunk: bytes, names: Sequence[str], delimiter: str, line: int, where: str) -> Block:
    """Return the block of a chunk by the csv module. Raises UserError for a row of another
    width."""
    text = io.StringIO(_decode(chunk, where, line), newline="")
    reader = csv.reader(text, delimiter=delimiter, strict=True)
    rows, numbers, number = [], [], line
    try:
        for row in reader:
            if len(row) not in (0, len(names)):
                fault = f"has {len(row)} fields; expected {len(names)}, as in the headings"
                raise UserError(fault, f"{where}, line {number}")
            if any(row):
                rows.append(row)
                numbers.append(number)
            number = line + reader.line_num
    except csv.Error as error:
        raise UserError(f"is not CSV: {error}", where) from None
    columns = zip(*rows, strict=True) if rows else [()] * len(names)
    return Block({n: list(column) for n, column in zip(names, columns, strict=True)}, numbers)


def _with_points(block: Block) -> Block:
    """Return a block whose quantities have decimal points in place of decimal commas."""
    columns = {
        heading: [
            cell.replace(".", "").replace(",", ".") if cell and "," in cell else cell
            for cell in column
        ]
        if heading_name(heading)[0]
        else column
        for heading, column in block.columns.items()
    }
    return block._replace(columns=columns)


# -- JSON Lines


def read_json(path: str, digits: bool = False) -> Table:
    """Return the table in a file of JSON Lines, one object for each row. ``digits``: keep those of
    numbers, as texts. Raises UserError."""
    where, source = display_name(path), Source(path)
    rows = _json_rows(io.BufferedReader(source), where, str if digits else None)
    first = next(rows, (1, {}))
    names = check_headings(list(first[1]), where)

    def blocks() -> Iterator[Block]:
        remaining = chain([first], rows)
        while block := list(islice(remaining, BLOCK_ROWS)):
            columns = {name: [row.get(name) for _, row in block] for name in names}
            yield Block(columns, [number for number, _ in block])

    return Table(names, blocks(), where, "line", source.extent)


def _json_rows(
    file: IO[bytes], where: str, numeral: type[str] | None
) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield the objects of a file with their lines. Raises UserError for a line that is no flat
    object, or has a name that the first has not."""
    names: set[str] = set()
    for number in count(1):
        line = file.readline(LONGEST_LINE)
        if not line:
            return
        if not line.strip():
            continue
        try:
            row = json.loads(line.decode("utf-8-sig"), parse_float=numeral, parse_int=numeral)
        except (ValueError, RecursionError):
            row = None
        if not isinstance(row, dict) or any(type(x) in (dict, list, bool) for x in row.values()):
            fault = f"is {quoted(line[:99].decode(errors='replace'))}; expected a JSON object"
            raise UserError(f"{fault} of numbers and texts for each row", f"{where}, line {number}")
        names = names or {*row}
        if unknown := {*row} - names:
            fault = f"{quoted(min(unknown))} is not in the first row; expected its names"
            raise UserError(fault, f"{where}, line {number}")
        yield number, row


# -- writing


def write_csv(file: IO[bytes], blocks: Iterable[Mapping[str, Column]]) -> None:
    """Write blocks as CSV; a number that is none is an empty field."""
    is_first = True
    for columns in blocks:
        if find_spec("polars"):
            from .polarsformats import frame_of

            data = io.BytesIO()  # polars hides which error of the file it met
            frame_of(columns).write_csv(data, include_header=is_first)
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
    return column.tolist() if isinstance(column, np.ndarray) else list(column)
