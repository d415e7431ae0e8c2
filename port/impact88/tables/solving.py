"""The rows of a table solved, in either arithmetic; a bad row is reported and left empty.

A row is the case of the table with the row's cells set. Rows of plain numbers are computed as
columns, by the affine map of each heading; any other row is read as a `Case`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..cases.amounts import MAX_LENGTH, Amount
from ..cases.case import POINT_DEFAULTS, Case
from ..cases.vehicles import implausible
from ..decimals import exact, is_number, to_double, to_text
from ..errors import UserError, quoted
from ..mechanics.solve import evaluate, solve
from ..names import RESULTS, SCENE, check_names
from ..status import Status
from .engine import is_csv, read_table, write_table
from .textformats import Block, Column, Columns, Table, heading_name

Floats = NDArray[np.float64]

MAX_LISTED = 20  # bad rows kept for the terminal: one screenful
APPLESOFT_RESULTS = tuple(n for n, row in RESULTS.items() if row.line or n == "KF")
"""Results of the 1988 arithmetic."""
ZERO_DETERMINANT = "ZERO DETERMINANT"
UNUSABLE = (
    "no impact has these values; expected M = 6 or 4, masses and inertias above 0, angles "
    "below 1e12, and at most one barrier (MB = inf, IB = inf), at rest"
)
_EMPTY = {"ERROR": "", "LINE": 0, "STATUS": Status.NOT_FINITE}
"""Results of a row that cannot be used; others are NaN."""


class Solver:
    """The rows of a table, solved a block at a time.

    Parameters
    ----------
    source : str or Table
        The file, ``-`` for standard input; or a table of `sweeping`.
    case : Case
        Values for the columns that the table lacks; its view is that of columns that name no units.
    results : sequence of str, optional
        Names of the results, all by default.
    replaced : collection of str, optional
        Names whose values in ``case`` take the place of the table's columns.
    arithmetic : {"float64", "applesoft"}, default "float64"
        Double precision, or the 1988 program's with two more columns, ERROR and LINE.
    results_only : bool, default False
        Leave the scene's columns out.

    Attributes
    ----------
    rows : int
        Rows so far, solved or not.
    bad : int
        Rows that could not be used.
    ended : int
        Rows that ended with an Applesoft error.
    listed : list of str
        The first of the bad rows, each with its place and the reason; at the end how many there
        are, if they are more.

    Raises
    ------
    UserError
        For a file that is no table, or lacks a column.
    """

    def __init__(
        self,
        source: str | Table,
        case: Case,
        results: Sequence[str] = (),
        replaced: Collection[str] = (),
        arithmetic: str = "float64",
        results_only: bool = False,
    ) -> None:
        self.is_applesoft = arithmetic == "applesoft"
        self.results_only = results_only
        self.rows = self.bad = self.ended = 0
        self.listed: list[str] = []
        self._remarks: dict[str, tuple[str, int]] = {}
        allowed = APPLESOFT_RESULTS if self.is_applesoft else tuple(RESULTS)
        check_names(results, allowed, f"result of --arithmetic {arithmetic}", "--results")
        self.results = tuple(results) or allowed
        if isinstance(source, str):
            source = read_table(source, self.is_applesoft)
        self.table = source
        self.case = case
        headings = read_headings(source.names, source.where)
        self.headings = {n: headings[n] for n in SCENE if n in headings}
        try:
            self.maps = {n: case.view.map(n, unit) for n, (_, unit) in self.headings.items()}
        except UserError as error:
            raise UserError(str(error), source.where) from None
        fixed = {*replaced} & {*case.entries}
        self.columns = [name for name in self.headings if name not in fixed]
        known = {*self.columns, *case.derived}
        self.constants = {n: float(x) for n, x in case.texts.items() if n not in known}
        known.update(self.constants)
        if "M" in self.columns:
            known.update(POINT_DEFAULTS)  # rows of bodies that lack them are bad
        if absent := " ".join(name for name in SCENE if name not in known):
            message = f"no column {absent}; --set NAME=VALUE gives one for all rows"
            raise UserError(message, source.where)

    def write(self, target: str, progress: Callable[[int, None], None] | None = None) -> None:
        """Solve the rows, and write the table with its results.

        Parameters
        ----------
        target : str
            The file to write, ``-`` for standard output.
        progress : callable, optional
            Called with the number of rows done, and None for the fraction, which is not known.

        Raises
        ------
        UserError
            For a file that cannot be written, and for damage that hides the rows behind it.
        """
        as_text = is_csv(target)

        def blocks() -> Iterator[Columns]:
            for block in self.table.blocks:
                yield self.solve(block, as_text)
                if progress:
                    progress(self.rows, None)
            if not self.rows:
                yield self.solve(Block([[] for _ in self.table.names], []), as_text)

        write_table(target, blocks())
        if self.bad > len(self.listed):
            self.listed.append(f"{self.bad:,} rows could not be used, these first")

    def remarks(self) -> list[str]:
        """Return what is implausible in the rows so far, the first by name with their number."""
        return [
            f"{text} ({count - 1:,} rows more)" if count > 1 else text
            for text, count in self._remarks.values()
        ]

    @np.errstate(all="ignore")
    def solve(self, block: Block, as_text: bool = True) -> dict[str, Column]:
        """Return a block with its results.

        Parameters
        ----------
        block : Block
            Rows of the table.
        as_text : bool, default True
            Keep the scene's columns as they are in the file; else as numbers where they have no
            texts.
        """
        columns = dict(zip(self.table.names, block.columns, strict=True))
        rows = self._read(columns, block.rows)
        facts, _ = evaluate(rows.values, ["fit", "HA", "HB"])
        if self.is_applesoft:
            results = self._replay(rows)
        else:
            for at in np.flatnonzero(facts["fit"] == 0).tolist():
                rows.bad.setdefault(at, f"{self.table.place(block.rows[at])}: {UNUSABLE}")
            results = solve(rows.values, self.results)
        self._remark(rows, {"TA": facts["HA"], "TB": facts["HB"]})
        bad = sorted(rows.bad)
        for name, values in results.items():
            values[bad] = _EMPTY.get(name, math.nan)
        self.rows += len(block.rows)
        self.bad += len(bad)
        self.listed += [rows.bad[at] for at in bad[: MAX_LISTED - len(self.listed)]]
        for name, (heading, _) in self.headings.items():
            if self.results_only:
                del columns[heading]
            else:
                columns[heading] = self._output_column(rows, name, as_text)
        view = self.case.view
        for name, values in results.items():
            if name in RESULTS:
                columns[view.heading(name)] = view.shown(name, values)
            else:
                columns[name] = values.tolist()
        return columns

    def _remark(self, rows: _Rows, courses: Mapping[str, Floats]) -> None:
        """Count the rows with implausible values."""
        for name, where, words in implausible(rows.values, self.case.view, courses):
            places = np.flatnonzero(where).tolist()
            if places and name in rows.cells:
                place = self.table.place(rows.numbers[places[0]])
                text = f"{place}: {name} = {rows.cells[name][places[0]]}: {words}"
                text, count = self._remarks.get(name, (text, 0))
                self._remarks[name] = text, count + len(places)

    def _read(self, columns: Columns, numbers: Sequence[int]) -> _Rows:
        """Return the rows of a block: as columns of numbers, and as cases where a row has anything
        else."""
        cells = {name: columns[self.headings[name][0]] for name in self.columns}
        values = {n: np.full(len(numbers), self.constants.get(n, math.nan)) for n in SCENE}
        is_other = np.full(len(numbers), len(cells) + len(self.constants) < len(SCENE))
        for name, column in cells.items():
            factor, offset = map(float, self.maps[name])
            values[name] = offset + factor * plain_numbers(column)
            is_other |= ~np.isfinite(values[name])
            if self.is_applesoft:
                is_other |= np.array([len(str(cell)) > MAX_LENGTH for cell in column], bool)
        rows = _Rows(numbers, cells, values, {}, {})
        for at in np.flatnonzero(is_other).tolist():
            place = self.table.place(numbers[at])
            try:
                if fault := self.table.faults.get(numbers[at]):
                    raise UserError(fault, place)
                rows.texts[at] = self._row_texts(cells, at, place)
            except UserError as error:
                rows.bad[at] = str(error)
            else:
                for name, text in rows.texts[at].items():
                    values[name][at] = float(text)
        return rows

    def _row_texts(self, columns: Columns, at: int, where: str) -> Mapping[str, str]:
        """Return the digits of a row that is read as a case. Raises UserError."""
        cells = {n: _entry(column[at], self.headings[n][1]) for n, column in columns.items()}
        case = Case.of({**self.case.written, **cells}, where, self.case.view)
        for name in SCENE:
            if name not in case.texts:
                raise UserError(f"{name} is empty; expected a number", where)
            if name in cells and name in case.ranges:
                raise UserError(f"{name} = {quoted(cells[name])}: expected one number", where)
            if self.is_applesoft and case.texts[name] == "INF":
                raise UserError(f"{name} = inf cannot be typed; expected a number", where)
        return case.texts

    def _replay(self, rows: _Rows) -> dict[str, NDArray[Any]]:
        """Return the results of the 1988 arithmetic."""
        from ..program.replay import replay

        outcome = replay({name: self._typed(rows, name) for name in SCENE})
        self.ended += int(np.count_nonzero(np.delete(outcome.error, [*rows.bad])))
        results: dict[str, NDArray[Any]] = {name: outcome.floats(name) for name in self.results}
        results["ERROR"] = np.where(outcome.zero_determinant, ZERO_DETERMINANT, outcome.error)
        results["LINE"] = np.array(outcome.line)
        return results

    def _typed(self, rows: _Rows, name: str) -> list[str]:
        """Return a column as the digits typed into the 1988 program."""
        texts = [self.case.texts.get(name, "6")] * len(rows.numbers)
        if name in rows.cells:
            factor, offset = self.maps[name]
            texts = [_entry(cell, "").upper() for cell in rows.cells[name]]
            for at in (*rows.texts, *rows.bad):
                texts[at] = "6"
            if factor != 1 or offset:
                texts = [_base_digits(text, factor, offset) for text in texts]
        for at, digits in rows.texts.items():
            texts[at] = digits[name]
        return texts

    def _output_column(self, rows: _Rows, name: str, as_text: bool) -> Column:
        """Return a column of the scene for the output: as it is in the file if it has texts."""
        if name not in rows.cells:
            factor, offset = map(float, self.maps[name])
            return (rows.values[name] - offset) / factor
        column = rows.cells[name]
        if as_text:
            return column
        numbers = plain_numbers(column)
        others = np.flatnonzero(~np.isfinite(numbers)).tolist()
        return column if any(_entry(column[at], "") for at in others) else numbers


class _Rows(NamedTuple):
    """The rows of one block.

    ``numbers``: their lines; ``cells``: the columns of the scene as in the file; ``values``: in
    base units along the listing's axes; ``texts``: the digits of the rows read as cases; ``bad``:
    the reasons of the rows that cannot be used; both by place in the block."""

    numbers: Sequence[int]
    cells: dict[str, Column]
    values: dict[str, Floats]
    texts: dict[int, Mapping[str, str]]
    bad: dict[int, str]


def _entry(cell: Any, unit: str) -> str:
    """Return a cell as an entry of a case; a number without a unit has that of its heading."""
    if cell is None or cell != cell:
        return ""
    text = to_text(float(cell)) if isinstance(cell, float) else str(cell).strip()
    if unit and text and (is_number(text) or not re.search(r"[^\W\d_]|[%°]", text)):
        return f"{text} {unit}"
    return text


def plain_numbers(column: Column) -> Floats:
    """Return a column as doubles, NaN where a cell is no plain number."""
    if hasattr(column, "cast"):  # polars
        column = column.cast(float, strict=False).to_numpy()
    elif isinstance(column, list):
        column = [_double(cell) for cell in column]
    return np.asarray(column, np.float64)


def _double(cell: Any) -> float:
    """Return the double of a cell, NaN for one that is no plain number."""
    try:
        if isinstance(cell, str):  # INPUT reads "1 0" as ten; a table's writer hardly means it
            return math.nan if " " in cell.strip() else to_double(cell)
        return float(cell)
    except (TypeError, ValueError, OverflowError):
        return math.nan


def _base_digits(text: str, factor: Fraction, offset: Fraction) -> str:
    """Return the digits of a number as shown in base units."""
    number: Any = exact(text) if to_double(text) else 0
    return Amount.exactly(number, text).mapped(factor, offset).typed


def read_headings(names: Sequence[str], where: str | None = None) -> dict[str, tuple[str, str]]:
    """Return heading and unit, "" without one, by quantity. Raises UserError for two columns of one
    quantity."""
    found: dict[str, tuple[str, str]] = {}
    for heading in names:
        name, unit = heading_name(heading)
        if name in found:
            raise UserError(f"{found[name][0]} and {heading} are two columns of {name}", where)
        if name:
            found[name] = heading, unit
    return found
