"""JSON Lines: a scene is an object on a line of its own, or in an array of objects; a number is its
text as written. What an object holds in objects of its own (``{"inputs": {"UX": 1}}``) is the
row's, where names of the scene are among it, or of results where these are read.

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
from typing import Any, NoReturn

import numpy as np

from ..apple.applesoft.decimaltext import scan
from ..collision import doubles
from ..errors import UserError, quoted
from ..files import LONGEST_LINE
from ..names import RESULTS, SCENE
from .budget import EMPTY_CELL
from .cells import Amount, Numeral, is_infinite, json_number, json_text
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
_decoder = json.JSONDecoder(
    parse_float=Numeral, parse_int=Numeral, parse_constant=lambda name: Numeral(float(name))
)


def _read(text: str) -> tuple[Any, str]:
    """The value of a JSON text, and why it is none."""
    try:
        value = _decoder.decode(text)
        deep = text.count("[") + text.count("{") > DEEPEST and _depth(value) > DEEPEST
    except RecursionError:
        deep = True
    except ValueError as error:
        return None, f"is not JSON: {error}"
    return (None, f"is nested deeper than {DEEPEST} levels") if deep else (value, "")


def _depth(value: Any) -> int:
    if not isinstance(value, dict | list):
        return 0
    return 1 + max(map(_depth, value.values() if isinstance(value, dict) else value), default=0)


_SPACE = re.compile("[ \t\r\n\ufeff]*")
LONGEST_ARRAY = 256_000_000  # characters: as many bytes as any other file may decode to


def _values(lines: Lines) -> Iterator[tuple[int, Any, str]]:
    """Yield the values on the lines, each with its line and why it is none, "" if it is one."""
    for text in lines:
        if text.strip():
            yield (lines.number, *_read(text))


def _elements(lines: Lines) -> Iterator[tuple[int, Any, str]]:
    """Yield the elements of an array, which is held whole, each with the line in which it begins.
    Raises UserError for what is no array."""
    text = lines.read(LONGEST_ARRAY + 1)
    if len(text) > LONGEST_ARRAY:
        raise UserError(
            f"holds an array of more than {LONGEST_ARRAY:,} characters; expected JSON Lines, an "
            "object a line",
            lines.where,
        )
    line, at = 1, 0

    def refuse(says: str) -> NoReturn:
        raise UserError(f"line {line} {says}", lines.where)

    def next_mark(start: int) -> str:
        """Go to the first character from ``start`` on that is no space, and return it."""
        nonlocal line, at
        end = _SPACE.match(text, start).end()  # type: ignore[union-attr]
        line += text.count("\n", at, end)
        at = end
        return text[at : at + 1]

    mark, expected = next_mark(0), "["
    while mark != "]" or expected == "[":
        if not mark:
            refuse("ends within an array; expected ']'")
        if mark not in expected:
            refuse(f"has {quoted(mark)} where {' or '.join(map(quoted, expected))} is expected")
        following = next_mark(at + 1)
        if following == "]" and mark == "[":
            break
        if not following:
            refuse("ends within an array; expected ']'")
        try:
            value, end = _decoder.raw_decode(text, at)
        except ValueError as error:
            refuse(f"is not JSON: {error}")
        except RecursionError:
            refuse(f"is nested deeper than {DEEPEST} levels")
        if end - at >= LONGEST_LINE:
            refuse(f"begins a value longer than {LONGEST_LINE:,} characters")
        opened = text.count("[", at, end) + text.count("{", at, end)
        deep = opened > DEEPEST and _depth(value) > DEEPEST
        lines.taken += end - at
        yield line, value, f"is nested deeper than {DEEPEST} levels" if deep else ""
        mark, expected = next_mark(end), ",]"
    if next_mark(at + 1):
        refuse("has text after the array's end; expected one array, or an object a line")


def _flatten(row: dict[str, Any], results: bool) -> dict[str, Any]:
    """The row with what its objects hold that is its own. Raises ValueError for a name with two
    values."""
    flat = dict(row)
    holders: dict[str, str] = {}
    for key, inner in row.items():
        if not isinstance(inner, dict):
            continue
        names = scene_names(list(inner), None, results)
        if not any(name in SCENE or (results and name in RESULTS) for name in names):
            continue
        del flat[key]
        for name, cell in inner.items():
            # the kit's vectors have each result in several forms
            value = cell.get("double", cell) if isinstance(cell, dict) else cell
            if name not in flat:
                flat[name], holders[name] = value, f"in {quoted(key)}"
            elif flat[name] != value:
                first = holders.get(name, "beside it")
                raise ValueError(f"has two values of {quoted(name)}, in {quoted(key)} and {first}")
    return flat


def _blocks(lines: Lines, values: Iterator[tuple[int, Any, str]], results: bool) -> Iterator[Rows]:
    column_names: dict[str, str] = {}  # key -> the column's name
    first_columns: set[str] | None = None  # the first block's columns
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
            and (following := next(values, None)) is not None
        ):
            number, value, reason = following
            if not reason and not isinstance(value, dict):
                reason = "is not a JSON object"
            elif not reason and dict in map(type, value.values()):
                try:
                    value = _flatten(value, results)
                except ValueError as error:
                    reason = str(error)
            if reason:
                bad.append((len(objects), "", reason))
                value = {}
            for key in value:
                keys.setdefault(key, number)
            numbers.append(number)
            objects.append(value)
        if not objects:
            return
        lines.budget.take(EMPTY_CELL * (len(objects) * len(keys) - sum(map(len, objects))))
        new = [key for key in keys if key not in column_names]
        lines.budget.check_shape(len(column_names) + len(new))
        all_names = scene_names([*column_names.values(), *new], None, results)
        column_names |= zip(new, all_names[len(column_names) :], strict=True)
        columns: dict[str, Column] = {}
        for key in keys:
            cells = [value.get(key, ABSENT) for value in objects]
            name = column_names[key]
            columns[name] = list(map(_text, cells)) if name in SCENE else cells
        first_columns = set(columns) if first_columns is None else first_columns
        late = {name: keys[key] for key in keys if (name := column_names[key]) not in first_columns}
        yield Rows(len(objects), columns, numbers, bad, late)


def _text(cell: Any) -> Any:
    return str(cell) if type(cell) is Numeral else cell


@contextmanager
def read(path: str, encoding: str | None, results: bool) -> Iterator[Reader]:
    """Open a JSON Lines table. Raises UserError if it cannot be read."""
    with open_text(path, encoding) as lines:
        values = (_elements if lines.begins_with("[") else _values)(lines)
        blocks = _blocks(lines, values, results)
        first = list(islice(blocks, 1))
        names = [name for rows in first for name in rows.columns]
        yield Reader(names, chain(first, blocks), *lines.source.extent)


_JSON = re.compile(r"-?(?:0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?")


def _double(cell: Any) -> str:
    """A scene's cell as JSON writes a double: its own digits, and never as a whole number, so that
    readers who go by what they see give all of a column one type."""
    if isinstance(cell, Amount):
        return json_number(cell.number)
    if not isinstance(cell, str):
        return json_number(cell) if type(cell) in (int, float) else "null"
    if match := _JSON.fullmatch(cell):
        return cell if match[1] or match[2] else cell + ".0"
    if not doubles.is_number(cell):
        return json_number(math.inf) if is_infinite(cell) else "null"
    sign, integer_digits, decimals, exponent_sign, exponent, _ = scan(cell.upper())
    power = f"E{exponent_sign}{exponent}" if exponent else ""
    return f"{sign.strip('+')}{integer_digits.lstrip('0') or '0'}.{decimals or '0'}{power}"


def _cells(name: str, column: Column) -> list[str]:
    if isinstance(column, np.ndarray):
        if column.dtype.kind == "f" or (name in SCENE and column.dtype.kind in "iub"):
            # whole numbers too: where one is missing, a later block of them is of doubles
            return list(map(json_number, column.astype(np.float64, copy=False).tolist()))
        return list(map(json_text, column.tolist()))
    write = _double if name in SCENE else json_text
    return ["" if cell is ABSENT else write(cell) for cell in column]


@contextmanager
def write(path: str, delimiter: str, headings: Sequence[str]) -> Iterator[Put]:
    """Write a JSON Lines table, of blocks that need not all have the same columns; under a name
    that ends in .json an array of the same objects."""
    is_array = path.lower().removesuffix(".gz").endswith(".json")
    with writing(path) as file:
        mark = "[\n" if is_array else ""

        def put_block(columns: Named) -> None:
            nonlocal mark
            keys = [json.dumps(heading(name), ensure_ascii=False) for name, _ in columns]
            cells = zip(*(_cells(*column) for column in columns), strict=True)
            lines = (
                "{" + ", ".join(f"{k}: {v}" for k, v in zip(keys, row, strict=True) if v) + "}"
                for row in cells
            )
            if not is_array:
                file.writelines(f"{line}\n" for line in lines)
                return
            for line in lines:
                file.write(mark + line)
                mark = ",\n"

        yield put_block
        if is_array:
            file.write(("[" if mark == "[\n" else "\n") + "]\n")
