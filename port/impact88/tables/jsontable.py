"""JSON Lines: a scene is an object on a line of its own.

A number, or a string that holds one, is taken as the decimal text it is written as. Results are
added as numbers with the fewest digits that read back to the same double; NaN, which JSON does not
have, is null, and infinity 1e999, which readers take for it.
"""

from __future__ import annotations

import json
import math
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import islice
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ..files import replacing
from ..names import SCENE
from .csvtable import open_text
from .rows import BLOCK_ROWS, BadCell, Column, Reader, Rows, Writer


class _Numeral(str):
    """The text of a JSON number."""

    __slots__ = ()


def _constant(name: str) -> _Numeral:
    return _Numeral({"NaN": "nan", "Infinity": "inf", "-Infinity": "-inf"}[name])


_decode = json.JSONDecoder(
    parse_float=_Numeral, parse_int=_Numeral, parse_constant=_constant
).decode


class _JsonReader:
    delimiter = ","

    def __init__(self, text: Any, size: int | None) -> None:
        self.total = size
        self._text = text
        self._numbered = enumerate(text, 1)
        self._first = self._block(1)
        self.names = [] if self._first is None else self._first[1]

    def position(self) -> int:
        return 0 if self.total is None else int(self._text.buffer.tell())

    def __iter__(self) -> Iterator[Rows]:
        block = self._first
        while block is not None:
            rows = block[0]
            yield rows
            block = self._block(rows.first + rows.count)

    def _block(self, first: int) -> tuple[Rows, list[str]] | None:
        objects: list[dict[str, Any]] = []
        lines: list[int] = []
        bad: list[BadCell] = []
        filled = ((number, text) for number, text in self._numbered if text.strip())
        for line, text in islice(filled, BLOCK_ROWS):
            lines.append(line)
            try:
                found = _decode(text)
                reason = "" if isinstance(found, dict) else "is no JSON object"
            except ValueError as error:
                reason = f"is no JSON: {error}"
            if reason:
                found = {}
                bad.append(BadCell(first + len(objects), line, "", reason))
            objects.append(found)
        if not lines:
            return None
        names = list(dict.fromkeys(name for found in objects for name in found))
        columns: dict[str, Column] = {}
        others: dict[str, Column] = {}
        for name in names:
            if name in SCENE:
                columns[name] = [_decimal(found.get(name)) for found in objects]
            else:
                others[name] = [found.get(name) for found in objects]
        return Rows(first, len(objects), columns, others, lines, bad), names


def _decimal(value: Any) -> Any:
    """A cell's decimal text; what is neither number nor string stays what it is, and is refused."""
    return str(value) if isinstance(value, str) else value


@contextmanager
def read_json_lines(path: str) -> Iterator[Reader]:
    """Open a JSON Lines table. Raises UserError if it cannot be read."""
    with open_text(path) as (text, size):
        yield _JsonReader(text, size)


_JSON_NUMBER = re.compile(r"-?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?")


def _written(value: Any) -> str:
    """JSON text of a value as `_decode` made it."""
    if isinstance(value, _Numeral):
        return _float(float(value)) if value in ("nan", "inf", "-inf") else str(value)
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)}: {_written(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_written, value)) + "]"
    return json.dumps(value, ensure_ascii=False)


def _scene_number(value: Any) -> str:
    if isinstance(value, str) and _JSON_NUMBER.fullmatch(value):
        return value
    return json.dumps(value, ensure_ascii=False)


def _float(value: float) -> str:
    if math.isfinite(value):
        return repr(value)
    return "null" if math.isnan(value) else ("1e999" if value > 0 else "-1e999")


def _cells(name: str, column: Column) -> list[str]:
    if isinstance(column, np.ndarray):
        if column.dtype.kind == "f":
            return list(map(_float, column.tolist()))
        return list(map(json.dumps, column.tolist()))
    return list(map(_scene_number if name in SCENE else _written, column))


class _JsonWriter:
    def __init__(self, file: IO[str], kept: Sequence[str], results: Sequence[str]) -> None:
        self._file = file
        self._kept = kept
        self._results = results

    def write(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None:
        # a later block may hold names that the first did not
        late = [n for n in rows.others if n not in self._kept and n not in self._results]
        names = [n for n in (*self._kept, *late) if n in rows.columns or n in rows.others]
        keys = [json.dumps(name, ensure_ascii=False) for name in (*names, *self._results)]
        columns = [_cells(name, rows.kept(name)) for name in names]
        columns += [_cells("", results[name]) for name in self._results]
        self._file.writelines(
            "{" + ", ".join(f"{k}: {v}" for k, v in zip(keys, row, strict=True)) + "}\n"
            for row in zip(*columns, strict=True)
        )


@contextmanager
def write_json_lines(path: str, kept: Sequence[str], results: Sequence[str]) -> Iterator[Writer]:
    """Write a JSON Lines table, see `tables.table.open_writer`."""
    if path == "-":
        yield _JsonWriter(sys.stdout, kept, results)
        return
    with replacing(path) as file:
        yield _JsonWriter(file, kept, results)
