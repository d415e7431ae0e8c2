"""Tables as text: CSV and JSON Lines, read a block of rows at a time, and written.

polars (extra ``tables``) splits plain CSV; the csv module takes every file, finds the rows that are
not as wide as the headings, and gives the same numbers.
"""

from __future__ import annotations

import csv
import io
import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from importlib.util import find_spec
from itertools import chain, islice
from typing import IO, Any, NamedTuple

import numpy as np

from ..errors import UserError, quoted
from ..files import LONGEST_LINE, check_text, display_name, open_bytes
from ..names import RESULTS, SCENE

Column = Any
"""A column of a block: an array of numbers, a list of texts, or a polars series."""
Columns = Mapping[str, Column]
"""Columns by heading."""
Rows = Iterator[tuple[int, Sequence[Any]]]
"""Rows, each with the number of its line in the file."""

CHUNK_BYTES = 8_000_000  # of CSV read at a time: some 60,000 rows, more gain nothing
BLOCK_ROWS = 20_000  # of other formats
_POINTS = str.maketrans(",", ".", ".")  # of a number with a decimal comma
_HEADING = re.compile(r"\s*(\w+)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*")
MAX_COLUMNS = 10_000  # beyond it a file is no table of scenes, and splitting it takes long


class Block(NamedTuple):
    """Rows of a table: a column for each heading, and the number of each row's line in the file."""

    columns: Sequence[Column]
    rows: Sequence[int]


class Table(NamedTuple):
    """A table being read.

    ``names``: its headings; ``blocks``: its rows; ``where``: its name in messages; ``counts``: what
    row numbers count, "line" or "row"; ``faults``: by number, why rows read so far are empty."""

    names: Sequence[str]
    blocks: Iterator[Block]
    where: str = "table"
    counts: str = "row"
    faults: Mapping[int, str] = {}

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
    match = _HEADING.fullmatch(heading)
    name, unit = match.groups(default="") if match else ("", "")
    name = name.upper()
    if name not in SCENE and name not in RESULTS:
        return "", ""
    return name, "" if unit in ("1", "-", "bits") else unit


def blocks_of(rows: Rows) -> Iterator[Block]:
    """Yield rows, each with its number, as blocks."""
    while some := list(islice(rows, BLOCK_ROWS)):
        numbers, cells = zip(*some, strict=True)
        yield Block([*map(list, zip(*cells, strict=True))], numbers)


# -- CSV


def read_csv(path: str) -> Table:
    """Return the table in a CSV file, ``-`` for standard input; fields are separated by commas,
    semicolons or tabs, and numbers among semicolons have a decimal comma. Raises UserError."""
    where, file = display_name(path), open_bytes(path)
    head = file.readline(LONGEST_LINE).removeprefix(b"\xef\xbb\xbf")
    check_text(head, where, "CSV")
    delimiter = max(",;\t", key=head.decode(errors="replace").count)
    csv.field_size_limit(LONGEST_LINE)
    faults: dict[int, str] = {}
    _, names = next(_csv_rows([head], delimiter, where, 1, faults), (1, []))

    def blocks() -> Iterator[Block]:
        number = 2
        while columns := _split_plain(
            chunk := file.read(CHUNK_BYTES) + file.readline(LONGEST_LINE), len(names), delimiter
        ):
            yield Block(columns, range(number, number + len(columns[0])))
            number += len(columns[0])
        rest = chain(io.BytesIO(chunk), iter(partial(file.readline, LONGEST_LINE), b""))
        yield from blocks_of(_csv_rows(rest, delimiter, where, number, faults, len(names)))

    read = (_with_points(names, block) for block in blocks()) if delimiter == ";" else blocks()
    return Table(names, read, where, "line", faults)


def _split_plain(chunk: bytes, width: int, delimiter: str) -> list[Column]:
    """Return the columns of a chunk by polars; none without it, at the end of the file, and where
    it has quotes, blank rows, or rows of another width, which polars fills without a word."""
    rows = chunk.count(b"\n") + (not chunk.endswith(b"\n"))
    is_plain = chunk.count(delimiter.encode()) == rows * (width - 1) and b'"' not in chunk
    if not (chunk and is_plain and find_spec("polars")):
        return []
    import polars

    with suppress(polars.exceptions.PolarsError):  # rows of more and of fewer fields; not UTF-8
        frame = polars.read_csv(
            chunk, has_header=False, infer_schema=False, quote_char=None, separator=delimiter
        )
        if frame.shape == (rows, width) and not all(column.null_count() for column in frame):
            return frame.get_columns()
    return []


def _csv_rows(
    lines: Iterable[bytes],
    delimiter: str,
    where: str,
    number: int,
    faults: dict[int, str],
    width: int = 0,
) -> Rows:
    """Yield the rows of CSV that are not blank, with their lines, by the csv module; a row of
    another width is a fault, and its fields are empty. Raises UserError."""
    reader = csv.reader(map(bytes.decode, lines), delimiter=delimiter, strict=True)
    line = number
    try:
        for row in reader:
            if any(row):
                if width and len(row) != width:
                    faults[line] = f"has {len(row)} fields; expected {width}, as in the headings"
                    row = [""] * width
                yield line, row
            line = number + reader.line_num
    except csv.Error as error:
        raise UserError(f"is not CSV: {error}", where) from None
    except UnicodeDecodeError:
        fault = "is not UTF-8 text; expected a file saved as CSV UTF-8"
        raise UserError(fault, f"{where}, line {line}") from None


def _with_points(names: Sequence[str], block: Block) -> Block:
    """Return a block whose quantities have decimal points in place of decimal commas."""
    columns = [*block.columns]
    for at, name in enumerate(names):
        if heading_name(name)[0]:
            cells = (cell or "" for cell in columns[at])
            columns[at] = [cell.translate(_POINTS) if "," in cell else cell for cell in cells]
    return Block(columns, block.rows)


# -- JSON Lines


def read_json(path: str, digits: bool = False) -> Table:
    """Return the table in a file of JSON Lines, one object for each row. ``digits``: keep those of
    numbers, as texts. Raises UserError."""
    where, file = display_name(path), open_bytes(path)
    lines = enumerate(iter(partial(file.readline, LONGEST_LINE), b""), 1)
    rows = (
        (at, _json_row(text, f"{where}, line {at}", digits)) for at, text in lines if text.strip()
    )
    first = next(rows, (1, {}))
    faults: dict[int, str] = {}
    names = [*first[1]]

    def cells() -> Rows:
        for at, row in chain([first], rows):
            if unknown := row.keys() - names:
                faults[at] = f"{quoted(min(unknown))} is not in the first row; expected its names"
                row = {}
            yield at, [row.get(name) for name in names]

    return Table(names, blocks_of(cells()), where, "line", faults)


def _json_row(line: bytes, where: str, digits: bool) -> dict[str, Any]:
    """Return the flat object in a line. Raises UserError."""
    numeral = str if digits else None
    with suppress(ValueError, RecursionError):
        row = json.loads(line.decode("utf-8-sig"), parse_float=numeral, parse_int=numeral)
        if isinstance(row, dict) and not any(type(x) in (dict, list, bool) for x in row.values()):
            return row
    fault = f"is {quoted(line[:99].decode(errors='replace'))}; expected a JSON object"
    raise UserError(f"{fault} of numbers and texts for each row", where)


# -- writing


def write_csv(file: IO[bytes], blocks: Iterable[Columns]) -> None:
    """Write blocks as CSV; a number that is none is an empty field."""
    for number, columns in enumerate(blocks):
        if find_spec("polars"):
            from .polarsformats import frame_of

            # not into the file: polars hides which error of the file it met
            text = frame_of(columns).write_csv(include_header=not number)
        else:
            lines = io.StringIO(newline="")
            writer = csv.writer(lines, lineterminator="\n")
            writer.writerows([[*columns], *_rows(columns)][bool(number) :])
            text = lines.getvalue()
        file.write(text.encode())


def write_json(file: IO[bytes], blocks: Iterable[Columns]) -> None:
    """Write blocks as JSON Lines; a number that is none is null."""
    for columns in blocks:
        rows = (dict(zip(columns, row, strict=True)) for row in _rows(columns))
        text = "".join(f"{json.dumps(row, ensure_ascii=False)}\n" for row in rows)
        file.write(re.sub(r'(?<=": )(-?)Infinity', r"\g<1>1e999", text).encode())


def _rows(columns: Columns) -> Iterator[tuple[Any, ...]]:
    """Return the rows of columns, None for a number that is none."""
    lists = (np.asarray(column, object).tolist() for column in columns.values())
    cells = ([None if cell != cell else cell for cell in column] for column in lists)
    return zip(*cells, strict=True)
