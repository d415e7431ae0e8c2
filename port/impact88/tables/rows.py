"""Rows of a table of scenes, between a file's format and an arithmetic.

Numbers stay the decimal text they are written as until an arithmetic reads them.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from .. import doubles
from ..closedform.columns import UNUSED_BY_POINTS
from ..errors import UserError, quoted
from ..names import RESULTS, SCENE
from . import arrow, jsontext

Column = Sequence[Any] | NDArray[Any]

BLOCK_ROWS = 16384
"""Rows read, solved and written together, unless they are very long: two arrays of them fit a
second-level cache. JSON Lines and Parquet take as long with half and with four times as many."""
BLOCK_CHARACTERS = 8_000_000
BLOCK_CELLS = 2_000_000
"""Characters of text, and cells, after which a block ends: they bound the memory, not the time."""


class _Absent(str):
    """What a row holds for a key it does not have; an empty text to everybody else."""

    __slots__ = ()


ABSENT = _Absent()


class BadCell(NamedTuple):
    """Why a row cannot be used: ``row`` counts the rows of data from 1, ``line`` is the line of the
    file (0: a file without lines), ``column`` the column at fault ("" for the row as a whole)."""

    row: int
    line: int
    column: str
    reason: str

    def __str__(self) -> str:
        place = f"row {self.row}" + (f" (line {self.line})" if self.line else "")
        return f"{place}{', ' + self.column if self.column else ''}: {self.reason}"


@dataclass
class Rows:
    """Some rows of a table. ``first``: the number of the first, from 1; ``columns``: scene name ->
    texts (None where the row has none, `ABSENT` where it lacks the key) or an array; ``others``:
    the other columns, passed through; ``lines``: the file's line of each row, if it has lines;
    ``bad``: rows that could not be read; ``late``: columns that the table's first rows did not
    have, and the line of each."""

    first: int
    count: int
    columns: dict[str, Column]
    others: dict[str, Column]
    lines: Sequence[int] | None = None
    bad: list[BadCell] = field(default_factory=list)
    late: dict[str, int] = field(default_factory=dict)

    @classmethod
    def of(cls, first: int, count: int, named: Iterable[tuple[str, Column]], *more: Any) -> Rows:
        """Rows of columns of either kind."""
        rows = cls(first, count, {}, {}, *more)
        for name, column in named:
            (rows.columns if name in SCENE else rows.others)[name] = column
        return rows

    def kept(self, name: str) -> Column:
        """A column of either kind."""
        return self.columns[name] if name in self.columns else self.others[name]

    def one_per_row(self, name: str) -> Column:
        """A column with a cell for each row. Raises UserError for an array that has not as many."""
        if name not in self.columns and name not in self.others:
            return [ABSENT] * self.count  # no row of this block has the key
        column = self.kept(name)
        if not isinstance(column, np.ndarray):
            return column
        if column.size == 1:
            return np.broadcast_to(column.reshape(-1), (self.count,))
        if column.shape != (self.count,):
            shape = " by ".join(map(str, column.shape))
            raise UserError(
                f"{quoted(name)} is an array of {shape}, not a column of {self.count} rows; "
                "expected a cell for each row (only .npz results hold it as it is)"
            )
        return column

    def cell(self, index: int, column: str, reason: str) -> BadCell:
        """A complaint about the row at ``index``, counted from 0."""
        line = self.lines[index] if self.lines is not None else 0
        return BadCell(self.first + index, line, column, reason)


class Units(Protocol):
    """What a table's columns are in (`tables.tableunits.TableUnits`)."""

    def factor(self, name: str) -> float: ...

    def refuses_bare(self, name: str) -> bool: ...

    def cell(self, name: str, text: str) -> str: ...


class Reader:
    """An open table; iterating it yields `Rows`. ``names``: its columns (of JSON Lines, those of
    the first row); ``total``: its size in the units of ``position``, which are rows unless a format
    has its own (None: unknown); ``delimiter``: between a CSV's fields."""

    def __init__(
        self,
        names: list[str],
        blocks: Iterable[Rows],
        total: int | None = None,
        position: Callable[[], int] | None = None,
        delimiter: str = ",",
    ) -> None:
        self.names, self.total, self.delimiter = names, total, delimiter
        self._blocks = blocks
        self._given = 0
        self.position = position or (lambda: self._given)

    def __iter__(self) -> Iterator[Rows]:
        for rows in self._blocks:
            self._given += rows.count
            yield rows


class Writer:
    """A table being written: the columns ``kept`` of a reader, then the ``results``; ``dropped``
    columns are not wanted."""

    kind = ""
    """What messages call it, where its columns are those of the first block."""

    def __init__(
        self, kept: Sequence[str], results: Sequence[str], dropped: Collection[str]
    ) -> None:
        self.kept, self.results, self.dropped = kept, results, dropped
        self.headings = [heading(name) for name in (*kept, *results)]

    def write(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None:
        """Write a block. Raises UserError for a column that the first block did not have."""
        for name, line in rows.late.items() if self.kind else ():
            if name not in self.dropped:
                raise UserError(
                    f"line {line} has the key {quoted(name)}, which no row before it has, and "
                    f"{self.kind} begins with its columns; expected to write JSON Lines, or the "
                    "key in the first row too"
                )
        self.put(rows, results)

    def put(self, rows: Rows, results: Mapping[str, NDArray[Any]]) -> None:
        """Write a block whose columns fit."""
        raise NotImplementedError


class Heading(str):
    """A column's name, with the heading that is ``written`` over it and the ``unit`` that names."""

    written: str
    unit: str

    def __new__(cls, name: str, written: str, unit: str = "") -> Heading:
        made = super().__new__(cls, name)
        made.written, made.unit = written, unit
        return made


def heading(name: str) -> str:
    """What is written over a column."""
    return getattr(name, "written", name)


_UNIT = re.compile(r"(.*?)\s*(?:\[([^]]*)\]|\(([^)]*)\))\s*")


def scene_names(names: Sequence[str], where: str | None = None) -> list[str]:
    """The names of a table's columns: those in small letters, or with a unit behind them (``Mu
    [1]``), are the scene's or a result's names where the table has no such column otherwise. Raises
    UserError for two columns of one name, where the table has a name (``where``)."""
    known = set(names)
    matched: list[str] = []
    for name in names:
        match = _UNIT.fullmatch(name)
        bare = (match[1] if match else name).strip().upper()
        unit = (match[2] or match[3] or "").strip() if match else ""
        taken = bare in known or not (bare in SCENE or (unit and bare in RESULTS))
        matched.append(name if taken else Heading(bare, name, unit))
        known.add(matched[-1])
    twice = next((name for name, count in Counter(matched).items() if count > 1), None)
    if where is not None and twice is not None:
        raise UserError(f"has two columns named {quoted(twice)}", where)
    return matched


def filled(column: Column, text: str) -> Column:
    """A column with ``text`` where it has nothing."""
    if isinstance(column, np.ndarray):
        return column
    if isinstance(column, arrow.ArrowTexts):
        return column.filled(text)
    return [text if cell in (None, "") else cell for cell in column]


def typed(name: str, column: Column) -> NDArray[Any] | list[str]:
    """A column as a typed table holds it: doubles for a scene's name, NaN where a cell is no
    number; otherwise what the array has, or texts."""
    if isinstance(column, np.ndarray):
        return column
    if name not in SCENE:
        return [jsontext.plain(cell) for cell in column]
    if isinstance(column, arrow.ArrowTexts) and (found := column.doubles()) is not None:
        return found
    return np.array([np.nan if _why_no_number(cell) else _double(cell) for cell in column], float)


def shortest(values: NDArray[Any]) -> list[str]:
    """Floats in the fewest digits that read back exactly; anything else as str writes it."""
    return list(map(repr if values.dtype.kind == "f" else str, values.tolist()))


def numbers(rows: Rows, units: Units | None = None) -> dict[str, NDArray[np.float64]]:
    """The scene columns of ``rows`` as doubles, in base units where ``units`` says what they are
    in. A cell that is not a number is NaN, and a complaint is added to ``rows.bad`` (unless its row
    has one already, or is a point mass that does not look at the cell)."""
    asked, every = ~point_masses(rows), np.ones(rows.count, np.bool_)
    return {
        name: _numbers(rows, name, column, units, asked if name in UNUSED_BY_POINTS else every)
        for name, column in rows.columns.items()
    }


def point_masses(rows: Rows) -> NDArray[np.bool_]:
    """Which rows have M = 4. Complaints about cells that these do not look at are withdrawn."""
    every = np.ones(rows.count, np.bool_)
    if "M" not in rows.columns:
        return ~every
    points = np.broadcast_to(_numbers(rows, "M", rows.columns["M"], None, every) == 4, every.shape)
    rows.bad[:] = [
        bad
        for bad in rows.bad
        if bad.column not in UNUSED_BY_POINTS or not points[bad.row - rows.first]
    ]
    return points


def _numbers(
    rows: Rows, name: str, column: Column, units: Units | None, asked: NDArray[np.bool_]
) -> NDArray[np.float64]:
    factor = units.factor(name) if units else 1.0
    bare_refused = units is not None and units.refuses_bare(name)
    values = None if bare_refused else _plain_numbers(column)
    if values is not None:
        return values if factor == 1 else values * factor
    values = np.full(rows.count, np.nan)
    cells = list(column)
    already = {bad.row for bad in rows.bad}
    for index, text in enumerate(cells):
        if rows.first + index in already or not asked[index]:
            continue
        try:
            if _why_no_number(text) is None:
                value = _double(text) * factor
                if bare_refused and value:
                    raise UserError(f"{text} has no unit, and others have")
            elif units and isinstance(text, str) and any(map(str.isdigit, text)):
                value = doubles.double(units.cell(name, text))
                cells[index] = f"{value / factor:.15g}"
                rows.columns[name] = cells
            else:
                raise UserError(_why_no_number(text) or "")
            values[index] = value
        except (UserError, ValueError) as error:
            rows.bad.append(rows.cell(index, name, str(error).removeprefix(": ")))
    return values


def _plain_numbers(column: Column) -> NDArray[np.float64] | None:
    """The numbers of a column that holds nothing else."""
    if isinstance(column, np.ndarray) and column.dtype.kind in "fiub":
        return column.astype(np.float64, copy=False)
    if isinstance(column, arrow.ArrowTexts) and (values := column.doubles()) is not None:
        return values
    try:
        return np.array(doubles.doubles(list(column)))
    except (TypeError, ValueError):  # some cell is not a number
        return None


def _why_no_number(text: object) -> str | None:
    if text is None or (isinstance(text, str) and not text.strip()):
        return "is empty; expected a number"
    if isinstance(text, str) and (is_infinite(text) or doubles.is_number(text)):
        return None
    return f"{quoted(text)} is not a number"


def _double(text: str) -> float:
    return math.inf if is_infinite(text) else doubles.double(text)


def is_infinite(text: str) -> bool:
    """Whether a cell says inf, the mass and the inertia of a barrier; INPUT has no such number."""
    return text.strip().lower() == "inf"


def check_scene_columns(
    names: Sequence[str],
    given: Sequence[str],
    optional: Sequence[str],
    help_: str = "--set NAME=VALUE",
) -> None:
    """Raise UserError unless ``names`` (a file's scene columns) and ``given`` (those given beside
    the file) together are a scene; those ``optional`` may be missing."""
    missing = [name for name in SCENE if name not in {*names, *given, *optional}]
    if missing:
        raise UserError(
            f"no column {' '.join(missing)}; expected columns named {' '.join(SCENE)} "
            f"(M may be missing; {help_} gives one value for all rows)"
        )
