"""Tables as text: CSV and JSON Lines, read a block of rows at a time, and written.

polars (extra ``tables``) splits plain CSV; the csv module takes every file, names the line of a row
that is not as wide as the headings, and gives the same numbers.
"""

from __future__ import annotations

import csv
import io
import json
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from importlib.util import find_spec
from itertools import chain, islice
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

    def place(self, number: int) -> str:
        """Return the place of a row for messages."""
        return f"{self.where}, {self.counts} {number:,}"


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


def blocks_of(names: Sequence[str], rows: Iterator[tuple[int, Sequence[Any]]]) -> Iterator[Block]:
    """Yield rows, each with its number, as blocks."""
    while some := list(islice(rows, BLOCK_ROWS)):
        numbers, cells = zip(*some, strict=True)
        columns = map(list, zip(*cells, strict=True))
        yield Block(dict(zip(names, columns, strict=True)), numbers)


# -- CSV


def read_csv(path: str) -> Table:
    """Return the table in a CSV file, ``-`` for standard input; fields are separated by commas,
    semicolons or tabs, and numbers among semicolons have a decimal comma. Raises UserError."""
    where, source = display_name(path), Source(path)
    file = io.BufferedReader(source)
    head = file.readline(LONGEST_LINE)
    check_text(head, where, "CSV")
    (head_text,) = _decode([head], where, 1)
    delimiter = max(",;\t", key=head_text.count)
    csv.field_size_limit(LONGEST_LINE)
    _, fields = next(_csv_rows([head_text.removeprefix("\ufeff")], delimiter, where, 1), (1, []))
    names = check_headings(fields, where)

    def blocks() -> Iterator[Block]:
        number, chunk = 2, b""
        while find_spec("polars"):
            chunk = file.read(CHUNK_BYTES) + file.readline(LONGEST_LINE)
            block = _split_plain(chunk, names, delimiter, number)
            if block is None:
                break
            yield block
            number += len(block.rows)
        rest = chain(io.BytesIO(chunk), iter(partial(file.readline, LONGEST_LINE), b""))
        lines = _decode(rest, where, number)
        yield from blocks_of(names, _csv_rows(lines, delimiter, where, number, len(names)))

    read = map(_with_points, blocks()) if delimiter == ";" else blocks()
    return Table(names, read, where, "line", source.extent)


def _decode(lines: Iterable[bytes], where: str, first: int) -> Iterator[str]:
    """Yield the texts of lines, the first of which has a number. Raises UserError."""
    for number, line in enumerate(lines, first):
        try:
            yield line.decode()
        except UnicodeDecodeError:
            fault = "is not UTF-8 text; expected a file saved as CSV UTF-8"
            raise UserError(fault, f"{where}, line {number}") from None


def _split_plain(chunk: bytes, names: Sequence[str], delimiter: str, line: int) -> Block | None:
    """Return the block of a chunk by polars; None at the end of the file, and where it has quotes,
    blank rows, or rows of another width, which polars fills without a word."""
    import polars

    marks = chunk.count(delimiter.encode())
    rows = chunk.count(b"\n") + (not chunk.endswith(b"\n"))
    if not chunk or b'"' in chunk or marks != rows * (len(names) - 1):
        return None
    options: dict[str, Any] = {"has_header": False, "infer_schema": False, "quote_char": None}
    with suppress(polars.exceptions.PolarsError):  # rows of more and of fewer fields; not UTF-8
        frame = polars.read_csv(chunk, **options, separator=delimiter, new_columns=names)
        has_gaps = all(column.null_count() for column in frame)
        if frame.shape == (rows, len(names)) and not has_gaps:
            return Block(frame.to_dict(), range(line, line + rows))
    return None


def _csv_rows(
    lines: Iterable[str], delimiter: str, where: str, number: int, width: int = 0
) -> Iterator[tuple[int, list[str]]]:
    """Yield the rows of CSV that are not blank, with their lines, by the csv module. Raises
    UserError for a row of another width."""
    reader = csv.reader(lines, delimiter=delimiter, strict=True)
    line = number
    try:
        for row in reader:
            if width and len(row) not in (0, width):
                fault = f"has {len(row)} fields; expected {width}, as in the headings"
                raise UserError(fault, f"{where}, line {line}")
            if any(row):
                yield line, row
            line = number + reader.line_num
    except csv.Error as error:
        raise UserError(f"is not CSV: {error}", where) from None


def _with_points(block: Block) -> Block:
    """Return a block whose quantities have decimal points in place of decimal commas."""
    columns = dict(block.columns)
    for heading, column in columns.items():
        if heading_name(heading)[0]:
            cells = (cell or "" for cell in column)
            columns[heading] = [
                cell.replace(".", "").replace(",", ".") if "," in cell else cell for cell in cells
            ]
    return Block(columns, block.rows)


# -- JSON Lines


def read_json(path: str, number: type[str] | None = None) -> Table:
    """Return the table in a file of JSON Lines, one object for each row. ``number``: str to keep
    the digits of numbers, as texts. Raises UserError."""
    where, source = display_name(path), Source(path)
    lines = enumerate(iter(partial(io.BufferedReader(source).readline, LONGEST_LINE), b""), 1)
    rows = (
        (at, _json_row(text, f"{where}, line {at}", number)) for at, text in lines if text.strip()
    )
    first = next(rows, (1, {}))
    names = check_headings([*first[1]], where)

    def cells() -> Iterator[tuple[int, list[Any]]]:
        for at, row in chain([first], rows):
            if unknown := row.keys() - first[1].keys():
                fault = f"{quoted(min(unknown))} is not in the first row; expected its names"
                raise UserError(fault, f"{where}, line {at}")
            yield at, [row.get(name) for name in first[1]]

    return Table(names, blocks_of(names, cells()), where, "line", source.extent)


def _json_row(line: bytes, where: str, numeral: type[str] | None) -> dict[str, Any]:
    """Return the flat object in a line. Raises UserError."""
    with suppress(ValueError, RecursionError):
        row = json.loads(line.decode("utf-8-sig"), parse_float=numeral, parse_int=numeral)
        if isinstance(row, dict) and not any(type(x) in (dict, list, bool) for x in row.values()):
            return row
    fault = f"is {quoted(line[:99].decode(errors='replace'))}; expected a JSON object"
    raise UserError(f"{fault} of numbers and texts for each row", where)


# -- writing


def write_csv(file: IO[bytes], blocks: Iterable[Mapping[str, Column]]) -> None:
    """Write blocks as CSV; a number that is none is an empty field."""
    for number, columns in enumerate(blocks):
        if find_spec("polars"):
            from .polarsformats import frame_of

            data = io.BytesIO()  # polars hides which error of the file it met
            frame_of(columns).write_csv(data, include_header=not number)
            file.write(data.getbuffer())
        else:
            text = io.StringIO(newline="")
            writer = csv.writer(text, lineterminator="\n")
            writer.writerows([[*columns], *_rows(columns)][bool(number) :])
            file.write(text.getvalue().encode())


def write_json(file: IO[bytes], blocks: Iterable[Mapping[str, Column]]) -> None:
    """Write blocks as JSON Lines; a number that is none is null."""
    for columns in blocks:
        rows = (dict(zip(columns, row, strict=True)) for row in _rows(columns))
        text = "".join(f"{json.dumps(row, ensure_ascii=False)}\n" for row in rows)
        file.write(re.sub(r'(?<=": )(-?)Infinity', r"\g<1>1e999", text).encode())


def _rows(columns: Mapping[str, Column]) -> Iterator[tuple[Any, ...]]:
    """Return the rows of columns, None for a number that is none."""
    lists = []
    for column in columns.values():
        cells = column.tolist() if isinstance(column, np.ndarray) else column
        lists.append([None if cell != cell else cell for cell in cells])
    return zip(*lists, strict=True)
