"""The rows of a table solved, in either arithmetic; a bad row is reported and left empty.

A row is the case of the table with the row's cells set. Rows of plain numbers are computed as
columns, by the affine map of each heading; any other row is read as a `Case`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..cases.amounts import MAX_LENGTH, Amount
from ..cases.case import POINT_DEFAULTS, Case
from ..cases.plausibility import Remark, implausible, impossible
from ..cases.units import PLAIN, View, is_measured, system_using, unit_of
from ..decimals import is_number, to_double, to_text
from ..errors import UserError, quoted
from ..mechanics.solve import evaluate, solve
from ..names import RESULTS, SCENE, check_names, quantity
from ..status import Status
from .engine import format_of, read_table, write_table
from .textformats import Block, Column, Table, heading_name

Floats = NDArray[np.float64]

MAX_LISTED = 20  # bad rows kept for the terminal: one screenful
APPLESOFT_RESULTS = tuple(n for n, row in RESULTS.items() if row.line or n == "KF")
"""Results of the 1988 arithmetic."""
ZERO_DETERMINANT = "ZERO DETERMINANT"
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
        The first of the bad rows, each with its place and the reason.
    remarks : list of str
        What is implausible, and results left out.
    """

    rows: int = 0
    bad: int = 0
    ended: int = 0
    listed: list[str] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)

    def messages(self) -> list[str]:
        """Return the bad rows listed, and how many there are if they are not all listed."""
        if self.bad == len(self.listed):
            return self.listed
        return [*self.listed, f"{self.bad:,} rows could not be used, these first"]


def solve_table(
    source: str | Table,
    target: str,
    results: Sequence[str] = (),
    *,
    case: Case | None = None,
    replaced: Collection[str] = (),
    view: View = PLAIN,
    arithmetic: str = "float64",
    results_only: bool = False,
    source_format: str = "",
    target_format: str = "",
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
        Values for the columns that the table lacks.
    replaced : collection of str, optional
        Names whose values in ``case`` take the place of the table's columns.
    view : View, optional
        Units, axes and headings of columns that name none.
    arithmetic : {"float64", "applesoft"}, default "float64"
        Double precision, or the 1988 program's with two more columns, ERROR and LINE.
    results_only : bool, default False
        Leave the scene's columns out.
    source_format, target_format : str, optional
        Formats of standard streams.
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
    kind = format_of(target, target_format)
    if isinstance(source, str):
        source = read_table(source, source_format, arithmetic == "applesoft")
    solver = Solver(source, results, case, replaced, view, arithmetic, kind == "csv", results_only)
    solved = solver.solved
    extent, position = source.extent

    def blocks() -> Iterator[Mapping[str, Column]]:
        for block in source.blocks:
            yield solver.solve(block)
            if progress:
                progress(solved.rows, position() / extent if extent else None)
        if not solved.rows:
            yield solver.solve(Block({name: [] for name in source.names}, []))

    write_table(target, blocks(), kind)
    solved.remarks += solver.remarks()
    return solved


class Solver:
    """The computation of a table's results, a block at a time.

    Parameters
    ----------
    table : Table
        The table.
    results, case, replaced, view, arithmetic, results_only
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
        view: View = PLAIN,
        arithmetic: str = "float64",
        as_text: bool = True,
        results_only: bool = False,
    ) -> None:
        self.table, self.as_text, self.solved = table, as_text, Solved()
        self.is_applesoft = arithmetic == "applesoft"
        allowed = APPLESOFT_RESULTS if self.is_applesoft else tuple(RESULTS)
        check_names(results, allowed, f"result of --arithmetic {arithmetic}", "--results")
        case = case or Case.of({}, view=view)
        try:
            headings, self.view = read_headings(table.names, case.view)
        except UserError as error:
            raise UserError(str(error), table.where) from None
        if self.view != case.view:
            case = Case.of(case.written, case.source, self.view, case.places, is_inferred=True)
        self.case = case
        self.replaced = {*replaced} & {*case.entries}
        self.columns = {n: h for n, h in headings.items() if n in SCENE and n not in self.replaced}
        names = {heading: heading_name(heading)[0] for heading in table.names}
        self.kept = {h: name for h, name in names.items() if name not in SCENE or not results_only}
        self.constants = {n: x for n, x in case.numbers.items() if n not in self.columns}
        self.derived = {*case.derived} - {*self.columns}  # each row has its own
        self._counts: dict[str, tuple[int, int, str]] = {}
        self._choose_results(tuple(results) or allowed)

    def _choose_results(self, results: Sequence[str]) -> None:
        """Set the results, without those of point masses whose inputs the table lacks. Raises
        UserError where it lacks another column."""
        present = {*self.columns, *self.constants, *self.derived}
        self.lacking = [name for name in SCENE if name not in present]
        may_be_points = "M" in self.columns or self.constants.get("M") == 4
        absent = [n for n in self.lacking if not may_be_points or n not in POINT_DEFAULTS]
        if absent:
            message = f"no column {' '.join(absent)}; --set NAME=VALUE gives one for all rows"
            raise UserError(message, self.table.where)
        scene = {"WA": 0.0, "WB": 0.0, **dict.fromkeys(present, 1.0), "M": 4.0}
        self.left_out = {} if self.is_applesoft else evaluate(scene, results)[1]
        self.results = [name for name in results if name not in self.left_out]
        if not self.results:
            raise UserError("; ".join(self.remarks()), self.table.where)

    def remarks(self) -> list[str]:
        """Return the remarks on all rows so far."""
        lines = [f"{name} needs {' '.join(names)}" for name, names in self.left_out.items()]
        for row, count, text in self._counts.values():
            tail = f" and {count - 1:,} more" if count > 1 else ""
            lines.append(f"{self.table.counts} {row:,}{tail}: {text}")
        return lines

    def solve(self, block: Block) -> dict[str, Column]:
        """Return a block with its results."""
        rows = _Rows(self, block)
        results = rows.replay() if self.is_applesoft else rows.solve()
        for name, where, words in rows.implausible():
            self._count(rows, name, where, words)
        bad = sorted(rows.bad)
        for name, values in results.items():
            values[bad] = _EMPTY.get(name, math.nan)
        self.solved.rows += rows.count
        self.solved.bad += len(bad)
        self.solved.listed += [rows.bad[at] for at in bad[: MAX_LISTED - len(self.solved.listed)]]
        if self.is_applesoft:
            errors = results["ERROR"]
            self.solved.ended += int(np.sum((errors != "") & (errors != ZERO_DETERMINANT)))
        columns = {heading: rows.output_column(heading) for heading in self.kept}
        for name, values in results.items():
            is_result = name in RESULTS
            heading = self.view.heading(name) if is_result else name
            columns[heading] = self.view.shown(name, values) if is_result else values
        return columns

    def _count(self, rows: _Rows, name: str, where: Any, words: str) -> None:
        """Count the rows that a remark applies to."""
        places = np.flatnonzero(np.broadcast_to(where, rows.count))
        if places.size and name in self.columns:
            cell = rows.cells(name)[int(places[0])]
            first = rows.block.rows[places[0]], 0, f"{name} = {cell}: {words}"
            row, count, text = self._counts.get(name, first)
            self._counts[name] = row, count + places.size, text


class _Rows:
    """The rows of one block.

    ``values``: the scene's columns in base units; ``cases``: the rows that are read as cases;
    ``bad``: the reasons of the rows that cannot be used; both by place in the block."""

    def __init__(self, solver: Solver, block: Block) -> None:
        self.solver, self.block, self.count = solver, block, len(block.rows)
        self.bad: dict[int, str] = {}
        self.cases: dict[int, Case] = {}
        self.shown = {n: plain_numbers(self.cells(n)) for n in solver.columns}
        constants = {**dict.fromkeys(SCENE, math.nan), **solver.constants}
        self.values = {name: np.full(self.count, value) for name, value in constants.items()}
        is_other = np.full(self.count, bool(solver.derived))
        for name, shown in self.shown.items():
            factor, offset = self.map(name)
            self.values[name] = offset + factor * shown
            is_other |= ~np.isfinite(shown)
            if solver.is_applesoft:
                is_other |= np.array(
                    [len(str(cell)) > MAX_LENGTH for cell in self.cells(name)], bool
                )
        for name in solver.lacking:
            default = float(POINT_DEFAULTS[name])
            self.values[name] = np.where(self.values["M"] == 4, default, math.nan)
            is_other |= np.isnan(self.values[name])
        for at in np.flatnonzero(is_other).tolist():
            try:
                self._read_row(at)
            except UserError as error:
                self.bad[at] = str(error)

    def cells(self, name: str) -> Column:
        """Return the cells of a column."""
        return self.block.columns[self.solver.columns[name][0]]

    def map(self, name: str) -> tuple[float, float]:
        """Return factor and offset from a column's cells to base units."""
        factor, offset = self.solver.view.map(name, self.solver.columns[name][1])
        return float(factor), float(offset)

    def place(self, at: int) -> str:
        """Return the place of a row for messages."""
        table = self.solver.table
        return f"{table.where}, {table.counts} {self.block.rows[at]:,}"

    def _read_row(self, at: int) -> None:
        """Read a row as a case. Raises UserError."""
        solver, where = self.solver, self.place(at)
        cells = {n: _entry(self.cells(n)[at], unit) for n, (_, unit) in solver.columns.items()}
        case = Case.of({**solver.case.written, **cells}, where, solver.view)
        if case.view != solver.view:
            raise UserError("has units; expected them in the headings, or --units", where)
        ranges = {*case.ranges} & {*cells}
        for name in SCENE:
            if name not in case.texts:
                raise UserError(f"{name} is empty; expected a number", where)
            if name in ranges:
                raise UserError(f"{name} = {quoted(cells[name])}: expected one number", where)
            if solver.is_applesoft and case.texts[name] == "INF":
                raise UserError(f"{name} = inf cannot be typed; expected a number", where)
        self.cases[at] = case
        for name, value in {**dict.fromkeys(case.omitted, 1.0), **case.numbers}.items():
            self.values[name][at] = value

    def solve(self) -> dict[str, NDArray[Any]]:
        """Return the results in double precision."""
        for name, mask, words in impossible(self.values):
            for at in np.flatnonzero(np.broadcast_to(mask, self.count)).tolist():
                digits = to_text(float(self.values[name][at]))
                self.bad.setdefault(at, f"{self.place(at)}: {name} = {digits} {words}")
        solution = solve(self.values, self.solver.results)
        return {name: np.array(np.broadcast_to(x, self.count)) for name, x in solution.items()}

    def replay(self) -> dict[str, NDArray[Any]]:
        """Return the results of the 1988 arithmetic."""
        from ..program.replay import replay

        outcome = replay({name: self._texts(name) or ["6"] for name in SCENE})
        results = {name: outcome.floats(name) for name in self.solver.results}
        results["ERROR"] = np.where(outcome.zero_determinant, ZERO_DETERMINANT, outcome.error)
        results["LINE"] = np.array(outcome.line)
        return {name: values[: self.count] for name, values in results.items()}

    def _texts(self, name: str) -> list[str]:
        """Return a column as the digits typed into the 1988 program."""
        solver = self.solver
        if name in solver.columns:
            cells = [_entry(cell, "").upper() for cell in self.cells(name)]
            texts = [text if is_number(text) else "0" for text in cells]  # others are cases
            factor, offset = solver.view.map(name, solver.columns[name][1])
            if factor != 1 or offset:
                exact = (Amount.exactly(to_double(text), text) for text in texts)
                texts = [amount.mapped(factor, offset).typed for amount in exact]
        else:
            texts = [solver.case.texts.get(name) or POINT_DEFAULTS.get(name, "")] * self.count
        for at, case in self.cases.items():
            texts[at] = case.texts[name]
        for at in self.bad:
            texts[at] = "6"
        return texts

    @np.errstate(all="ignore")
    def implausible(self) -> list[Remark]:
        """Return the remarks on implausible values."""
        courses = {}
        for vehicle, (x, y) in {"A": ("UX", "UY"), "B": ("VX", "VY")}.items():
            angle = np.degrees(np.arctan2(self.values[y], self.values[x]))
            rests = (self.values[x] == 0) & (self.values[y] == 0)
            courses[vehicle] = np.where(rests, math.nan, angle)
        return list(implausible(self.values, self.solver.view, courses))

    def output_column(self, heading: str) -> Column:
        """Return a column of the table for the output."""
        solver, name = self.solver, self.solver.kept[heading]
        if name in solver.replaced:
            return solver.view.shown(name, self.values[name])
        if name not in self.shown or solver.as_text:
            return self.block.columns.get(heading, [None] * self.count)
        column, rows = self.shown[name].copy(), [*self.cases]
        factor, offset = self.map(name)
        column[rows] = (self.values[name][rows] - offset) / factor
        return column


def _entry(cell: Any, unit: str) -> str:
    """Return a cell as an entry of a case; a number without a unit has that of its heading."""
    if cell is None or cell != cell:
        return ""
    text = cell.strip() if isinstance(cell, str) else to_text(float(cell))
    has_unit = any(character.isalpha() or character in "%°" for character in text)
    return f"{text} {unit}" if unit and text and (is_number(text) or not has_unit) else text


def plain_numbers(column: Column) -> Floats:
    """Return a column as doubles, NaN where a cell is no plain number."""
    if isinstance(column, np.ndarray):
        return column.astype(np.float64, copy=False)
    if hasattr(column, "cast"):  # polars
        import polars

        return np.array(column.cast(polars.Float64, strict=False).to_numpy(), np.float64)
    return np.array([_double(cell) for cell in column], np.float64)


def _double(cell: Any) -> float:
    """Return the double of a cell, NaN for one that is no plain number."""
    try:
        if isinstance(cell, str):  # INPUT reads "1 0" as ten; a table's writer hardly means it
            return math.nan if " " in cell.strip() else to_double(cell)
        return float(cell)
    except (TypeError, ValueError, OverflowError):
        return math.nan


def read_headings(
    names: Sequence[str], view: View, measured: Collection[str] = SCENE
) -> tuple[dict[str, tuple[str, str]], View]:
    """Return heading and symbol of the unit by quantity, and the view of the table: the one given,
    else with the system that the units of ``measured`` quantities name.

    Raises UserError for two columns of one quantity, for a unit that does not measure it, and where
    only some headings have units."""
    headings: dict[str, tuple[str, str]] = {}
    for heading in names:
        name, symbol = heading_name(heading)
        if name in headings:
            raise UserError(f"{headings[name][0]} and {heading} are two columns of {name}")
        if name:
            is_read = bool(symbol) and name in measured
            unit = unit_of(quantity(name).unit, symbol).symbol if is_read else ""
            headings[name] = heading, unit
    rules = {n: quantity(n).unit for n in headings if n in measured}
    bare = [n for n, rule in rules.items() if is_measured(rule) and not headings[n][1]]
    units = [unit_of(rule, headings[n][1]) for n, rule in rules.items() if headings[n][1]]
    system = view.units or system_using(units)
    if system and bare and not view.units:
        raise UserError(
            f"some headings have units, and {bare[0]} has none; expected "
            f"{View(system).heading(bare[0])}, or --units {system} for columns without"
        )
    return headings, View(system, view.axes, view.headings)
