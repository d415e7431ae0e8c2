"""JSON Lines: a scene is an object on a line of its own; a number is its text as written.

A column that is written has one type from the first line to the last: a scene's values are doubles
with their own digits (``1`` is written 1.0), results doubles with the fewest digits that read back
to the same, NaN is null, and infinity 1e999, which readers take for it.
"""

import json
import math
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import chain, islice
from typing import Any

import numpy as np

from .. import doubles
from ..applesoft.decimaltext import scan
from ..names import SCENE
from .cells import Numeral, is_infinite, json_number, json_text
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

DEEPEST = 100
"""Lists and objects inside one another that are read: a bound; Python itself reads a thousand."""
_decode = json.JSONDecoder(
    parse_float=Numeral, parse_int=Numeral, parse_constant=lambda name: Numeral(float(name))
).decode


def _read(text: str) -> Any:
    """The value of a JSON text. Raises ValueError if it is not one, or nested too deeply."""
    try:
        value = _decode(text)
        deep = text.count("[") + text.count("{") > DEEPEST and _depth(value) > DEEPEST
    except RecursionError:
        deep = True
    except ValueError as error:
        raise ValueError(f"is not JSON: {error}") from None
    if deep:
        raise ValueError(f"is nested deeper than {DEEPEST} levels")
    return value


def _depth(value: Any) -> int:
    if not isinstance(value, dict | list):
        return 0
    return 1 + max(map(_depth, value.values() if isinstance(value, dict) else value), default=0)


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
                value, reason = _read(text), "is not a JSON object"
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
    return str(cell) if type(cell) is Numeral else cell


@contextmanager
def read(path: str, form: str, encoding: str | None) -> Iterator[Reader]:
    """Open a JSON Lines table. Raises UserError if it cannot be read."""
    with open_text(path, encoding) as lines:
        blocks = _blocks(lines)
        first = list(islice(blocks, 1))
        names = [name for rows in first for name in rows.columns]
        yield Reader(names, chain(first, blocks), *lines.source.extent)


_JSON = re.compile(r"-?(?:0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?")


def _double(cell: Any) -> str:
    """A scene's cell as JSON writes a double: its own digits, and never as a whole number, so that
    readers who go by what they see give all of a column one type."""
    if not isinstance(cell, str):
        return json_number(cell) if type(cell) in (int, float) else "null"
    if match := _JSON.fullmatch(cell):
        return cell if match[1] or match[2] else cell + ".0"
    if not doubles.is_number(cell):
        return json_number(math.inf) if is_infinite(cell) else "null"
    sign, whole, decimals, exponent_sign, exponent, _ = scan(cell.upper())
    power = f"E{exponent_sign}{exponent}" if exponent else ""
    return f"{sign.strip('+')}{whole.lstrip('0') or '0'}.{decimals or '0'}{power}"


def _cells(name: str, column: Column) -> list[str]:
    if isinstance(column, np.ndarray):
        if column.dtype.kind == "f" or (name in SCENE and column.dtype.kind in "iub"):
            # whole numbers too: where one is missing, a later block of them is of doubles
            return list(map(json_number, column.astype(np.float64, copy=False).tolist()))
        return list(map(json_text, column.tolist()))
    write = _double if name in SCENE else json_text
    return ["" if cell is ABSENT else write(cell) for cell in column]


@contextmanager
def write(path: str, form: str, delimiter: str, headings: Sequence[str]) -> Iterator[Put]:
    """Write a JSON Lines table, of blocks that need not all have the same columns."""
    with writing(path) as file:

        def put(columns: Named) -> None:
            keys = [json.dumps(heading(name), ensure_ascii=False) for name, _ in columns]
            file.writelines(
                "{" + ", ".join(f"{k}: {v}" for k, v in zip(keys, row, strict=True) if v) + "}\n"
                for row in zip(*(_cells(*column) for column in columns), strict=True)
            )

        yield put
