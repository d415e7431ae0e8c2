"""The rows of a table solved, in either arithmetic; a bad row is reported and left empty.

A row is the case of the table with the row's cells set. Rows of plain numbers are computed as
columns, by the affine map of each heading; any other row is read as a `Case`.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
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
from .textformats import Block, Column, Table, heading_name

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


@dataclass
class Solved:
    """Counts of a table's rows, and what to say of them.

    Attributes
    ----------
    rows : int
        Rows solved or not.
    bad : int
        Rows that could not be used.
    ended : int
        Rows that ended with an Applesoft error.
    listed : list of str
        The first of the bad rows, each with its place and the reason; at the end how many there
        are, if they are more.
    remarks : list of str
        What is implausible.
    """

    rows: int = 0
    bad: int = 0
    ended: int = 0
    listed: list[str] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)


def solve_table(
    source: str | Table,
    target: str,
    results: Sequence[str] = (),
    *,
    case: Case | None = None,
    replaced: Collection[str] = (),
    arithmetic: str = "float64",
    results_only: bool = False,
    progress: Callable[[int, float | None], None] | None = None,
) -> Solved:
    """Solve each row of a table, and write the table with its results.

    Parameters
    ----------
    source : str or Table
        The file, ``-`` for standard input; or a table of `sweeping`.
    target : str
        The file to write, ``-`` for standard output.
    results : sequence of str, optional
        Names of the results, all by default.
    case : Case, optional
        Values for the columns that the table lacks; its view is that of columns that name no units.
    replaced : collection of str, optional
        Names whose values in ``case`` take the place of the table's columns.
    arithmetic : {"float64", "applesoft"}, default "float64"
        Double precision, or the 1988 program's with two more columns, ERROR and LINE.
    results_only : bool, default False
        Leave the scene's columns out.
    progress : callable, optional
        Called with the number of rows done, and the fraction of the file read if that is known.

    Returns
    -------
    Solved
        Counts, bad rows and remarks.

    Raises
    ------
    UserError
        For a file that is no table, lacks a column, or cannot be written.
    """
    as_text = is_csv(target)
    if isinstance(source, str):
        source = read_table(source, arithmetic == "applesoft")
    solver = Solver(source, results, case, replaced, arithmetic, as_text, results_only)
    solved = solver.solved
    extent, position = source.extent

    def blocks() -> Iterator[Mapping[str, Column]]:
        for block in source.blocks:
            yield solver.solve(block)
            if progress:
                progress(solved.rows, position() / extent if extent else None)
        if not solved.rows:
            yield solver.solve(Block({name: [] for name in source.names}, []))

    write_table(target, blocks())
    solved.remarks += solver.remarks()
    if solved.bad > len(solved.listed):
        solved.listed.append(f"{solved.bad:,} rows could not be used, these first")
    return solved


class Solver:
    """The computation of a table's results, a block at a time.

    Parameters
    ----------
    table : Table
        The table.
    results, case, replaced, arithmetic, results_only
        As for `solve_table`.
    as_text : bool
        Keep the scene's columns as they are in the file; else as numbers.

    Attributes
    ----------
    solved : Solved
        Counts so far.
    """

    def __init__(
        self,
        table: Table,
        results: Sequence[str] = (),
        case: Case | None = None,
        replaced: Collection[str] = (),
        arithmetic: str = "float64",
        as_text: bool = True,
        results_only: bool = False,
    ) -> None:
        self.table, self.as_text, self.results_only = table, as_text, results_only
        self.solved = Solved()
        self.is_applesoft = arithmetic == "applesoft"
        allowed = APPLESOFT_RESULTS if self.is_applesoft else tuple(RESULTS)
        check_names(results, allowed, f"result of --arithmetic {arithmetic}", "--results")
        self.results = tuple(results) or allowed
        self.case = case = case or Case.of({})
        headings = read_headings(table.names, table.where)
        self.headings = {name: headings[name] for name in SCENE if name in headings}
        try:
            self.maps = {n: case.view.map(n, unit) for n, (_, unit) in self.headings.items()}
        except UserError as error:
            raise UserError(str(error), table.where) from None
        self.columns = {*self.headings} - ({*replaced} & {*case.entries})
        known = self.columns | {*case.derived}
        self.constants = {n: x for n, x in case.numbers.items() if n not in known}
        known.update(self.constants)
        if "M" in self.columns or self.constants.get("M") == 4:
            known.update(POINT_DEFAULTS)  # rows of bodies that lack them are bad
        if absent := " ".join(name for name in SCENE if name not in known):
            message = f"no column {absent}; --set NAME=VALUE gives one for all rows"
            raise UserError(message, table.where)
        self._remarks: dict[str, str] = {}
        self._counts: Counter[str] = Counter()

    def remarks(self) -> list[str]:
        """Return the remarks on all rows so far."""
        more = {name: count - 1 for name, count in self._counts.items() if count > 1}
        return [
            f"{text} ({more[name]:,} rows more)" if name in more else text
            for name, text in self._remarks.items()
        ]

    def solve(self, block: Block) -> dict[str, Column]:
        """Return a block with its results."""
        rows = self._read(block)
        results = self._replay(rows) if self.is_applesoft else self._solve(rows)
        self._remark(rows)
        bad = sorted(rows.bad)
        for name, values in results.items():
            values[bad] = _EMPTY.get(name, math.nan)
        self.solved.rows += len(block.rows)
        self.solved.bad += len(bad)
        self.solved.listed += [rows.bad[at] for at in bad[: MAX_LISTED - len(self.solved.listed)]]
        if self.is_applesoft:
            self.solved.ended += int(np.sum(~np.isin(results["ERROR"], ["", ZERO_DETERMINANT])))
        columns: dict[str, Column] = {}
        for heading, column in block.columns.items():
            name, _ = heading_name(heading)
            if name not in SCENE:
                columns[heading] = column
            elif not self.results_only:
                columns[heading] = self._output_column(rows, name)
        view = self.case.view
        for name, values in results.items():
            is_result = name in RESULTS
            columns[view.heading(name) if is_result else name] = (
                view.shown(name, values) if is_result else values
            )
        return columns

    def _read(self, block: Block) -> _Rows:
        """Return the rows of a block: as columns of numbers, and as cases where a row has anything
        else."""
        cells = {name: block.columns[self.headings[name][0]] for name in self.columns}
        shown = {name: plain_numbers(column) for name, column in cells.items()}
        values = {n: np.full(len(block.rows), self.constants.get(n, math.nan)) for n in SCENE}
        for name, numbers in shown.items():
            factor, offset = map(float, self.maps[name])
            values[name] = offset + factor * numbers
        is_other = np.zeros(len(block.rows), bool)
        for name in SCENE:
            if name not in self.constants:
                is_other |= ~np.isfinite(values[name])
        if self.is_applesoft:
            for column in cells.values():
                lengths = enumerate(map(len, map(str, column)))
                is_other[[at for at, length in lengths if length > MAX_LENGTH]] = True
        rows = _Rows(block.rows, cells, shown, values, {}, {})
        for at in np.flatnonzero(is_other).tolist():
            try:
                rows.cases[at] = self._read_row(rows, at)
            except UserError as error:
                rows.bad[at] = str(error)
        for at, case in rows.cases.items():
            for name, text in case.texts.items():
                values[name][at] = float(text)
        return rows

    def _read_row(self, rows: _Rows, at: int) -> Case:
        """Return a row as a case. Raises UserError."""
        where = self.table.place(rows.numbers[at])
        cells = {n: _entry(column[at], self.headings[n][1]) for n, column in rows.cells.items()}
        case = Case.of({**self.case.written, **cells}, where, self.case.view)
        for name in SCENE:
            if name not in case.texts:
                raise UserError(f"{name} is empty; expected a number", where)
            if name in cells and name in case.ranges:
                raise UserError(f"{name} = {quoted(cells[name])}: expected one number", where)
            if self.is_applesoft and case.texts[name] == "INF":
                raise UserError(f"{name} = inf cannot be typed; expected a number", where)
        return case

    def _solve(self, rows: _Rows) -> dict[str, NDArray[Any]]:
        """Return the results in double precision."""
        usable, _ = evaluate(rows.values, "fit")
        for at in np.flatnonzero(usable["fit"] == 0).tolist():
            rows.bad.setdefault(at, f"{self.table.place(rows.numbers[at])}: {UNUSABLE}")
        return solve(rows.values, self.results)

    def _replay(self, rows: _Rows) -> dict[str, NDArray[Any]]:
        """Return the results of the 1988 arithmetic."""
        from ..program.replay import replay

        outcome = replay({name: self._texts(rows, name) or ["6"] for name in SCENE})
        results = {name: outcome.floats(name) for name in self.results}
        results["ERROR"] = np.where(outcome.zero_determinant, ZERO_DETERMINANT, outcome.error)
        results["LINE"] = np.array(outcome.line)
        return {name: values[: len(rows.numbers)] for name, values in results.items()}

    def _texts(self, rows: _Rows, name: str) -> list[str]:
        """Return a column as the digits typed into the 1988 program."""
        texts = [self.case.texts.get(name, "6")] * len(rows.numbers)
        if name in rows.cells:
            factor, offset = self.maps[name]
            texts = [_entry(cell, "").upper() for cell in rows.cells[name]]
            for at in (*rows.cases, *rows.bad):
                texts[at] = "6"
            if factor != 1 or offset:
                texts = [_base_digits(text, factor, offset) for text in texts]
        for at, case in rows.cases.items():
            texts[at] = case.texts[name]
        return texts

    @np.errstate(all="ignore")
    def _remark(self, rows: _Rows) -> None:
        """Count the rows with implausible values."""
        courses, _ = evaluate(rows.values, ["HA", "HB"])
        by_vehicle = {name[1]: angles for name, angles in courses.items()}
        for name, where, words in implausible(rows.values, self.case.view, by_vehicle):
            places = np.flatnonzero(where)
            if places.size and name in rows.cells:
                place = self.table.place(rows.numbers[places[0]])
                text = f"{place}: {name} = {rows.cells[name][int(places[0])]}: {words}"
                self._remarks.setdefault(name, text)
                self._counts[name] += places.size

    def _output_column(self, rows: _Rows, name: str) -> Column:
        """Return a column of the scene for the output: as it is in the file if it has texts."""
        if name not in rows.cells:
            factor, offset = map(float, self.maps[name])
            return (rows.values[name] - offset) / factor
        column, numbers = rows.cells[name], rows.shown[name]
        others = np.flatnonzero(~np.isfinite(numbers)).tolist()
        has_texts = self.as_text or any(_entry(column[at], "") for at in others)
        return column if has_texts else numbers


class _Rows(NamedTuple):
    """The rows of one block.

    ``numbers``: their lines; ``cells``: the columns of the scene as in the file, ``shown``: as
    numbers, NaN for anything else; ``values``: in base units along the listing's axes; ``cases``:
    the rows read as cases; ``bad``: the reasons of the rows that cannot be used; both by place in
    the block."""

    numbers: Sequence[int]
    cells: dict[str, Column]
    shown: dict[str, Floats]
    values: dict[str, Floats]
    cases: dict[int, Case]
    bad: dict[int, str]


def _entry(cell: Any, unit: str) -> str:
    """Return a cell as an entry of a case; a number without a unit has that of its heading."""
    if cell is None or cell != cell:
        return ""
    text = to_text(float(cell)) if isinstance(cell, float) else str(cell).strip()
    has_unit = any(character.isalpha() or character in "%°" for character in text)
    return f"{text} {unit}" if unit and text and (is_number(text) or not has_unit) else text


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
