"""JSON Lines: a scene is an object on a line of its own.

A number, or a string that holds one, is taken as the decimal text it is written as. Results are
added as numbers with the fewest digits that read back to the same double; NaN, which JSON does not
have, is null, and infinity 1e999, which readers take for it.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ..files import replacing
from ..names import SCENE
from . import jsontext
from .lines import Lines, open_text
from .rows import (
    ABSENT,
    BLOCK_CELLS,
    BLOCK_CHARACTERS,
    BLOCK_ROWS,
    BadCell,
    Column,
    Reader,
    Rows,
    Writer,
    one_per_row,
)


class _JsonReader:
    delimiter = ","

    def __init__(self, lines: Lines) -> None:
        self.total = lines.size
        self._lines = lines
        self.names: list[str] = []
        self._known: set[str] = set()
        self._first = self._block(1)
        if self._first is not None:
            self.names = list(self._first.late)
            self._known = set(self.names)
            self._first.late = {}

    def position(self) -> int:
        return 0 if self.total is None else self._lines.position()

    def __iter__(self) -> Iterator[Rows]:
        block = self._first
        while block is not None:
            yield block
            block = self._block(block.first + block.count)

    def _block(self, first: int) -> Rows | None:
        objects: list[dict[str, Any]] = []
        lines: list[int] = []
        bad: list[BadCell] = []
        names: dict[str, int] = {}  # name -> the line that has it first
        self._lines.begin_block()
        while (
            len(objects) < BLOCK_ROWS
            and len(objects) * len(names) < BLOCK_CELLS
            and self._lines.taken < BLOCK_CHARACTERS
        ):
            self._lines.begin_record()
            text = next(self._lines, None)
            if text is None:
                break
            if not text.strip():
                continue
            line = self._lines.number
            try:
                value, reason = jsontext.read(text), "is no JSON object"
            except ValueError as error:
                value, reason = None, str(error)
            if not isinstance(value, dict):
                bad.append(BadCell(first + len(objects), line, "", reason))
                value = {}
            for name in value:
                names.setdefault(name, line)
            lines.append(line)
            objects.append(value)
        if not lines:
            return None
        columns: dict[str, Column] = {}
        others: dict[str, Column] = {}
        for name in names:
            cells = [value.get(name, ABSENT) for value in objects]
            if name in SCENE:
                columns[name] = [str(x) if type(x) is jsontext.Numeral else x for x in cells]
            else:
                others[name] = cells
        late = {name: line for name, line in names.items() if name not in self._known}
        return Rows(first, len(objects), columns, others, lines, bad, late)


@contextmanager
def read_json_lines(path: str, encoding: str | None = None) -> Iterator[Reader]:
    """Open a JSON Lines table. Raises UserError if it cannot be read."""
    with open_text(path, encoding) as file:
        yield _JsonReader(file.lines())


_JSON_NUMBER = re.compile(r"-?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?")


def _scene_number(value: Any) -> str:
    if isinstance(value, str) and _JSON_NUMBER.fullmatch(value):
        return value
    return jsontext.written(value)


def _cells(name: str, column: Column) -> list[str]:
    if isinstance(column, np.ndarray):
        if column.dtype.kind == "f":
            return list(map(jsontext.number, column.tolist()))
        return list(map(json.dumps, column.tolist()))
    return [
        "" if cell is ABSENT else _scene_number(cell) if name in SCENE else jsontext.written(cell)
        for cell in column
    ]


class _JsonWriter:
    def __init__(
        self, file: IO[str], kept: Sequence[str], results: Sequence[str], dropped: Collection[str]
    ) -> None:
        self._file = file
        self._kept = kept
        self._results = results
        self._dropped = dropped

    def write(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None:
        # a later block may hold names that the first did not, and a row need not hold all
        names = [
            name
            for name in (*self._kept, *(n for n in rows.late if n not in self._dropped))
            if name in rows.columns or name in rows.others
        ]
        keys = [json.dumps(name, ensure_ascii=False) for name in (*names, *self._results)]
        columns = [_cells(name, one_per_row(rows, name)) for name in names]
        columns += [_cells("", results[name]) for name in self._results]
        self._file.writelines(
            "{" + ", ".join(f"{k}: {v}" for k, v in zip(keys, row, strict=True) if v) + "}\n"
            for row in zip(*columns, strict=True)
        )


@contextmanager
def write_json_lines(
    path: str, kept: Sequence[str], results: Sequence[str], dropped: Collection[str]
) -> Iterator[Writer]:
    """Write a JSON Lines table, see `tables.table.open_writer`."""
    if path == "-":
        yield _JsonWriter(sys.stdout, kept, results, dropped)
        return
    with replacing(path) as file:
        yield _JsonWriter(file, kept, results, dropped)
