"""Comma-separated values: a header of names, a row for each scene.

Fields may be separated by commas, semicolons or tabs (told from the header) and quoted as usual.
Every field is passed through as it stands; floats are written with the fewest digits that read back
to the same double.
"""

from __future__ import annotations

import csv
import sys
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import chain
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError, quoted
from ..files import replacing
from ..names import SCENE
from .jsontext import written
from .lines import Lines, open_lines
from .rows import (
    BLOCK_CHARACTERS,
    BLOCK_ROWS,
    BadCell,
    Column,
    Reader,
    Rows,
    Writer,
    one_per_row,
    refuse_late,
    shortest,
)


class _CsvReader:
    def __init__(self, lines: Lines) -> None:
        self.total = lines.size
        self._lines = lines
        header = next((line for line in lines if line.strip()), "")
        if not header:
            raise UserError(
                "is empty; expected a header with the names of the columns", lines.where
            )
        self.delimiter = max(",;\t", key=header.count) if header.count(",") == 0 else ","
        # a header may span lines inside quotes: give the reader the line back
        self._rows = csv.reader(chain([header], lines), delimiter=self.delimiter, strict=True)
        self.names = [name.strip() for name in self._next() or ()]
        name, count = Counter(self.names).most_common(1)[0]
        if count > 1:
            raise UserError(f"has two columns named {quoted(name)}", lines.where)

    def position(self) -> int:
        return 0 if self.total is None else self._lines.position()

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


@contextmanager
def read_csv(path: str) -> Iterator[Reader]:
    """Open a CSV table. Raises UserError if it cannot be read as one."""
    with open_lines(path) as lines:
        yield _CsvReader(lines)


class _CsvWriter:
    def __init__(
        self,
        file: IO[str],
        kept: Sequence[str],
        results: Sequence[str],
        dropped: Collection[str],
        delimiter: str,
    ) -> None:
        self._dropped = dropped
        self._kept = kept
        self._results = results
        self._rows = csv.writer(file, delimiter=delimiter, lineterminator="\n")
        self._rows.writerow([*kept, *results])

    def write(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None:
        refuse_late(rows, self._dropped, "a CSV table")
        kept = (_fields(one_per_row(rows, name)) for name in self._kept)
        found = (shortest(results[name]) for name in self._results)
        self._rows.writerows(zip(*kept, *found, strict=True))


def _fields(column: Column) -> Sequence[Any]:
    if isinstance(column, np.ndarray):
        return shortest(column)
    # csv writes None as an empty field
    return [x if x is None or isinstance(x, str) else written(x) for x in column]


@contextmanager
def write_csv(
    path: str,
    kept: Sequence[str],
    results: Sequence[str],
    dropped: Collection[str],
    delimiter: str,
) -> Iterator[Writer]:
    """Write a CSV table, see `tables.table.open_writer`."""
    if path == "-":
        yield _CsvWriter(sys.stdout, kept, results, dropped, delimiter)
        return
    with replacing(path) as file:
        yield _CsvWriter(file, kept, results, dropped, delimiter)
