"""JSON Lines: a scene is an object on a line of its own; a number is its text as written.

A column that is written has one type from the first line to the last: a scene's values are doubles
with their own digits (``1`` is written 1.0), results doubles with the fewest digits that read back
to the same, NaN is null, and infinity 1e999, which readers take for it.
"""

import json
import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ..names import SCENE
from . import jsontext
from .lines import Lines, open_text, writing
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
    heading,
    is_infinite,
    scene_names,
)


class _JsonReader:
    def __init__(self, lines: Lines) -> None:
        self._lines = lines
        self._known: set[str] = set()
        self._matched: dict[str, str] = {}  # key -> the column's name
        self._first = self._block(1)
        self._known = set(self._matched)
        self.names = list(self._first.late) if self._first else []

    def blocks(self) -> Iterator[Rows]:
        block = self._first
        while block is not None:
            if block.first == 1:
                block.late = {}
            yield block
            block = self._block(block.first + block.count)

    def _block(self, first: int) -> Rows | None:
        objects: list[dict[str, Any]] = []
        lines: list[int] = []
        bad: list[BadCell] = []
        names: dict[str, int] = {}  # name -> the line that has it first
        self._lines.taken = 0
        while (
            len(objects) < BLOCK_ROWS
            and len(objects) * len(names) < BLOCK_CELLS
            and self._lines.taken < BLOCK_CHARACTERS
        ):
            text = next(self._lines, None)
            if text is None:
                break
            if not text.strip():
                continue
            line = self._lines.number
            try:
                value, reason = jsontext.read(text), "is not a JSON object"
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
        new = [key for key in names if key not in self._matched]
        found = scene_names([*self._matched.values(), *new])[len(self._matched) :]
        self._matched |= zip(new, found, strict=True)
        late = {self._matched[n]: line for n, line in names.items() if n not in self._known}
        columns = ((self._matched[key], [o.get(key, ABSENT) for o in objects]) for key in names)
        texts = ((n, list(map(_text, c)) if n in SCENE else c) for n, c in columns)
        return Rows.of(first, len(objects), texts, lines, bad, late)


def _text(cell: Any) -> Any:
    return str(cell) if type(cell) is jsontext.Numeral else cell


@contextmanager
def read(path: str, form: str, encoding: str | None) -> Iterator[Reader]:
    """Open a JSON Lines table. Raises UserError if it cannot be read."""
    with open_text(path, encoding) as file:
        table = _JsonReader(Lines(file))
        yield Reader(table.names, table.blocks(), *file.source.extent)


def _double(cell: Any) -> str:
    if isinstance(cell, str):
        try:
            return jsontext.double(cell)
        except ValueError:
            return jsontext.number(math.inf) if is_infinite(cell) else "null"
    return jsontext.number(cell) if type(cell) in (int, float) else "null"


def _cells(name: str, column: Column) -> list[str]:
    if isinstance(column, np.ndarray):
        if column.dtype.kind == "f" or (name in SCENE and column.dtype.kind in "iub"):
            # whole numbers too: where one is missing, a later block of them is of doubles
            return list(map(jsontext.number, column.astype(np.float64, copy=False).tolist()))
        return list(map(jsontext.written, column.tolist()))
    return [
        "" if cell is ABSENT else _double(cell) if name in SCENE else jsontext.written(cell)
        for cell in column
    ]


class _JsonWriter(Writer):
    def __init__(self, file: IO[str], *columns: Any) -> None:
        super().__init__(*columns)
        self._file = file

    def put(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None:
        # a later block may hold names that the first did not, and a row need not hold all
        names = [
            name
            for name in (*self.kept, *(n for n in rows.late if n not in self.dropped))
            if name in rows.columns or name in rows.others
        ]
        headings = map(heading, (*names, *self.results))
        keys = [json.dumps(text, ensure_ascii=False) for text in headings]
        columns = [_cells(name, rows.one_per_row(name)) for name in names]
        columns += [_cells("", results[name]) for name in self.results]
        self._file.writelines(
            "{" + ", ".join(f"{k}: {v}" for k, v in zip(keys, row, strict=True) if v) + "}\n"
            for row in zip(*columns, strict=True)
        )


@contextmanager
def write(path: str, form: str, delimiter: str, *columns: Any) -> Iterator[Writer]:
    """Write a JSON Lines table."""
    with writing(path) as file:
        yield _JsonWriter(file, *columns)
