"""JSON Lines: a scene is an object on a line of its own; a number is its text as written.

A column that is written has one type from the first line to the last: a scene's values are doubles
with their own digits (``1`` is written 1.0), results doubles with the fewest digits that read back
to the same, NaN is null, and infinity 1e999, which readers take for it.
"""

import json
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import chain, islice
from typing import Any

import numpy as np

from ..names import SCENE
from . import jsontext
from .cells import is_infinite
from .lines import Lines, open_text, writing
from .rows import (
    ABSENT,
    BLOCK_CELLS,
    BLOCK_CHARACTERS,
    BLOCK_ROWS,
    Column,
    Named,
    Put,
    Reader,
    Rows,
    heading,
    scene_names,
)


def _blocks(lines: Lines) -> Iterator[Rows]:
    matched: dict[str, str] = {}  # key -> the column's name
    known: set[str] | None = None  # the first block's columns
    while True:
        objects: list[dict[str, Any]] = []
        numbers: list[int] = []
        bad: list[tuple[int, str, str]] = []
        keys: dict[str, int] = {}  # key -> the line that has it first
        lines.taken = 0
        while (
            len(objects) < BLOCK_ROWS
            and len(objects) * len(keys) < BLOCK_CELLS
            and lines.taken < BLOCK_CHARACTERS
            and (text := next(lines, None)) is not None
        ):
            if not text.strip():
                continue
            try:
                value, reason = jsontext.read(text), "is not a JSON object"
            except ValueError as error:
                value, reason = None, str(error)
            if not isinstance(value, dict):
                bad.append((len(objects), "", reason))
                value = {}
            for key in value:
                keys.setdefault(key, lines.number)
            numbers.append(lines.number)
            objects.append(value)
        if not objects:
            return
        new = [key for key in keys if key not in matched]
        matched |= zip(new, scene_names([*matched.values(), *new])[len(matched) :], strict=True)
        columns: dict[str, Column] = {}
        for key in keys:
            cells = [value.get(key, ABSENT) for value in objects]
            name = matched[key]
            columns[name] = list(map(_text, cells)) if name in SCENE else cells
        known = set(columns) if known is None else known
        late = {name: keys[key] for key in keys if (name := matched[key]) not in known}
        yield Rows(len(objects), columns, numbers, bad, late)


def _text(cell: Any) -> Any:
    return str(cell) if type(cell) is jsontext.Numeral else cell


@contextmanager
def read(path: str, form: str, encoding: str | None) -> Iterator[Reader]:
    """Open a JSON Lines table. Raises UserError if it cannot be read."""
    with open_text(path, encoding) as lines:
        blocks = _blocks(lines)
        first = list(islice(blocks, 1))
        names = [name for rows in first for name in rows.columns]
        yield Reader(names, chain(first, blocks), *lines.source.extent)


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
    write = _double if name in SCENE else jsontext.written
    return ["" if cell is ABSENT else write(cell) for cell in column]


@contextmanager
def write(path: str, form: str, delimiter: str, names: Sequence[str]) -> Iterator[Put]:
    """Write a JSON Lines table, of blocks that need not all have the same columns."""
    with writing(path) as file:

        def put(columns: Named) -> None:
            keys = [json.dumps(heading(name), ensure_ascii=False) for name, _ in columns]
            file.writelines(
                "{" + ", ".join(f"{k}: {v}" for k, v in zip(keys, row, strict=True) if v) + "}\n"
                for row in zip(*(_cells(*column) for column in columns), strict=True)
            )

        yield put
