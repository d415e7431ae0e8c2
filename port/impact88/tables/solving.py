"""The rows of a table solved, in either arithmetic; a bad row is reported and left empty."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import nullcontext, suppress
from dataclasses import dataclass, field
from types import NoneType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..cases.amounts import Amount, normalize, read
from ..cases.case import COURSE, MAX_TYPED, OPTIONAL_OF_POINTS, Case
from ..cases.estimates import estimate
from ..cases.plausibility import implausible
from ..cases.units import DIMENSIONS, PLAIN, View, system_using, unit_of
from ..decimals import exact, to_double, to_doubles, to_text
from ..errors import UserError, quoted
from ..files import replacing
from ..mechanics.solve import evaluate, solve
from ..names import DEFAULT_M, RESULTS, SCENE, check_names, quantity
from ..status import Status
from .engine import format_of, read_table, write_table
from .textformats import Block, Column, Table, heading_name

Floats = NDArray[np.float64]

UNUSED_BY_POINTS = ("DA", "DB", "PA", "PB", "TA", "TB", "IA", "IB", "EM")
"""Columns that rows of point masses do not look at."""
MAX_LISTED = 20  # bad rows kept for the terminal: one screenful
APPLESOFT_RESULTS = tuple(n for n, row in RESULTS.items() if row.line or n == "KF")
"""Results of the 1988 arithmetic."""
ZERO_DETERMINANT = "ZERO DETERMINANT"


class BadRow(NamedTuple):
    """A row that cannot be used: its line or row in the file, a column, and the reason."""

    row: int
    column: str
    reason: str


@dataclass
class Solved:
    """What became of a table.

    Attributes
    ----------
    rows : int
        Rows solved or not.
    bad : int
        Rows that could not be used.
    ended : int
        Rows that ended with an Applesoft error.
    listed : list of BadRow
        The first of the bad rows.
    remarks : list of str
        How the table was read, what is implausible, and results left out.
    counts : str
        What the numbers of rows count, "line" or "row".
    """

    rows: int = 0
    bad: int = 0
    ended: int = 0
    listed: list[BadRow] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    counts: str = "row"

    def messages(self, where: str) -> list[str]:
        """Return the bad rows listed in words, and how many there are beyond them."""
        lines = [
            f"{where}, {self.counts} {bad.row:,}: {bad.column} {bad.reason}" for bad in self.listed
        ]
        if self.bad > len(lines):
            lines.append(f"{self.bad:,} rows could not be used; --errors FILE lists all of them")
        return lines


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
    encoding: str = "",
    errors: str = "",
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
    encoding : str, optional
        Of CSV that is not Unicode.
    errors : str, optional
        A CSV file for all bad rows.
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
    format_of(target, target_format)
    is_applesoft = arithmetic == "applesoft"
    table = (
        read_table(source, source_format, encoding, is_applesoft)
        if isinstance(source, str)
        else source
    )
    kind = format_of(target, target_format)
    solver = Solver(table, results, case, replaced, view, arithmetic, kind == "csv", results_only)
    solved = Solved(counts=table.counts, remarks=[*table.remarks])
    extent, position = table.extent
    with replacing(errors) if errors else nullcontext() as file:
        writer = csv.writer(file, lineterminator="\n") if file else None
        if writer:
            writer.writerow(BadRow._fields)

        def blocks() -> Iterator[Mapping[str, Column]]:
            for block in table.blocks:
                columns, bad, ended = solver.solve(block)
                solved.rows += len(block.rows)
                solved.bad += len(bad)
                solved.ended += ended
                solved.listed += bad[: MAX_LISTED - len(solved.listed)]
                if writer:
                    writer.writerows(bad)
                if progress:
                    progress(solved.rows, position() / extent if extent else None)
                yield columns
            if not solved.rows:
                yield solver.solve(Block({name: [] for name in table.names}, []))[0]

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
        self.table, self.arithmetic, self.as_text = table, arithmetic, as_text
        self.is_applesoft = arithmetic == "applesoft"
        allowed = APPLESOFT_RESULTS if self.is_applesoft else tuple(RESULTS)
        self.results = tuple(results) or allowed
        check_names(self.results, allowed, f"result of --arithmetic {arithmetic}", "--outputs")
        try:
            self.headings = _headings_by_name(table.names)
            self.view = _view(self.headings, view if case is None else case.view)
        except UserError as error:
            raise UserError(str(error), table.where) from None
        self.case = _in_view(case or Case.of({}, view=view), self.view)
        self.replaced = {name for name in replaced if name in self.case.entries}
        read_names = [n for n in self.headings if n in SCENE and n not in self.replaced]
        self.columns = {name: self.headings[name] for name in read_names}
        self.kept = [
            heading
            for heading in table.names
            if not (results_only and heading_name(heading)[0] in SCENE)
        ]
        self.constants = {n: x for n, x in self.case.numbers.items() if n not in self.columns}
        self.share = self.case.entries.get("MU") if "MU" not in self.columns else None
        self.share = self.share if self.share and self.share.share else None
        followed = {n for n in ("TA", "TB") if self.case.written.get(n) == COURSE}
        self.computed = {*self.case.estimated, *followed} - {*self.columns}
        self.computed |= {"MU"} if self.share else set()
        self._remarks: dict[str, list[Any]] = {}
        self._leave_out_results()

    def _leave_out_results(self) -> None:
        """Leave out results of point masses whose inputs are missing, and fill those that no other
        result uses. Raises UserError where the table lacks another column."""
        present = {*self.columns, *self.constants, *self.computed, "M"}
        may_be_points = "M" in self.columns or self.constants.get("M") == 4
        lacking = [n for n in SCENE if n not in present]
        if absent := [n for n in lacking if not (may_be_points and n in OPTIONAL_OF_POINTS)]:
            message = f"no column {' '.join(absent)}; --set NAME=VALUE gives one for all rows"
            raise UserError(message, self.table.where)
        self.constants |= dict.fromkeys([n for n in lacking if n not in UNUSED_BY_POINTS], 0.0)
        known = dict.fromkeys(present, 1.0) | {"WA": 0.0, "WB": 0.0, "M": 4.0}
        self.left_out = (
            evaluate(known, self.results)[1] if lacking and not self.is_applesoft else {}
        )
        self.results = tuple(name for name in self.results if name not in self.left_out)
        if not self.results:
            raise UserError("; ".join(self.remarks()), self.table.where)

    def remarks(self) -> list[str]:
        """Return the remarks on all rows so far."""
        lines = [f"{name} needs {' '.join(names)}" for name, names in self.left_out.items()]
        for row, count, text in self._remarks.values():
            more = f" and {count - 1:,} more" if count > 1 else ""
            lines.append(f"{self.table.counts} {row:,}{more}: {text}")
        return lines

    def solve(self, block: Block) -> tuple[dict[str, Column], list[BadRow], int]:
        """Return a block with its results, its bad rows, and how many rows ended with an error."""
        reading = _Reading(self, block)
        self._remark(reading.columns, block)
        if self.is_applesoft:
            results = self._applesoft(reading)
            is_error = (results["ERROR"] != "") & (results["ERROR"] != ZERO_DETERMINANT)
        else:
            solution = solve(reading.columns, self.results)
            results = {n: np.array(np.broadcast_to(x, reading.count)) for n, x in solution.items()}
            reading.refuse(results)
            is_error = np.zeros(reading.count, np.bool_)
        bad = sorted(reading.bad)
        empty = {"ERROR": "", "LINE": 0, "STATUS": Status.NOT_FINITE}
        for name, values in results.items():
            values[bad] = empty.get(name, math.nan)
        columns = {heading: reading.output_column(heading) for heading in self.kept}
        for name, values in results.items():
            is_result = name in RESULTS
            columns[self.view.heading(name) if is_result else name] = (
                self.view.shown(name, values) if is_result else values
            )
        is_error[bad] = False
        complaints = [BadRow(block.rows[at], *reading.bad[at]) for at in bad]
        return columns, complaints, int(np.count_nonzero(is_error))

    def _applesoft(self, reading: _Reading) -> dict[str, NDArray[Any]]:
        """Return the results of the 1988 arithmetic."""
        from ..program.replay import replay

        texts = {name: reading.texts(name) for name in SCENE}
        for at in reading.bad:
            for column in texts.values():
                column[at] = "6"
        if not reading.count:
            empty = np.zeros(0)
            return dict.fromkeys((*self.results, "ERROR", "LINE"), empty)
        replay_results = replay(texts)
        error = np.where(replay_results.zero_determinant, ZERO_DETERMINANT, replay_results.error)
        results = {name: replay_results.floats(name) for name in self.results}
        return {**results, "ERROR": error, "LINE": np.array(replay_results.line)}

    @np.errstate(all="ignore")
    def _remark(self, columns: Mapping[str, Floats], block: Block) -> None:
        """Count the rows that each plausibility remark applies to."""
        courses = {}
        for vehicle, x, y in (("A", "UX", "UY"), ("B", "VX", "VY")):
            if x in columns and y in columns:
                course = np.degrees(np.arctan2(columns[y], columns[x]))
                is_at_rest = (columns[x] == 0) & (columns[y] == 0)
                courses[vehicle] = np.where(is_at_rest, np.nan, course)
        sizes = {name: amount.value for name, amount in self.case.sizes.items()}
        for name, where, words, amount in implausible(columns, self.view, courses, sizes):
            if name not in self.columns and name not in ("TA", "TB"):
                continue
            places = np.flatnonzero(np.broadcast_to(where, len(block.rows)))
            if not places.size:
                continue
            if name in self._remarks:
                self._remarks[name][1] += places.size
                continue
            at = int(places[0])
            cell = block.columns[self.headings[name][0]][at] if name in self.columns else ""
            value = float(np.broadcast_to(amount, len(block.rows))[at])
            text = words.format(entry=f"{name} = {cell}", amount=value)
            self._remarks[name] = [block.rows[at], places.size, text]


class _Reading:
    """The scene's columns of one block as numbers; ``bad``: column and reason by place."""

    def __init__(self, solver: Solver, block: Block) -> None:
        self.solver, self.block, self.count = solver, block, len(block.rows)
        self.bad: dict[int, tuple[str, str]] = {}
        self.amounts: dict[str, dict[int, Amount]] = {}
        self.columns: dict[str, Floats] = {}
        self.shares = np.full(self.count, np.nan)
        self.points = np.zeros(self.count, np.bool_)
        for name in ("M", *(n for n in SCENE if n != "M")):
            if name in solver.columns:
                self.columns[name] = self._numbers(name)
            elif name in solver.constants:
                self.columns[name] = np.full(self.count, solver.constants[name])
            if name == "M":
                self.points = self.columns["M"] == 4
        self._compute()

    def _numbers(self, name: str) -> Floats:
        """Return a column in base units along the listing's axes, NaN in bad cells."""
        solver, column = self.solver, self.block.columns[self.solver.columns[name][0]]
        shown = plain_numbers(column, solver.table.decimal_comma)
        factor, offset = (float(x) for x in solver.view.map(name, solver.columns[name][1]))
        values = shown if factor == 1 and not offset else offset + factor * shown
        amounts = self.amounts[name] = {}
        cells: dict[Any, Amount | str] = {}
        places = np.flatnonzero(~np.isfinite(shown))
        if name in UNUSED_BY_POINTS:
            places = places[~self.points[places]]
        if places.size and values is shown:
            values = shown.copy()
        for at in places.tolist():
            cell = column[at]
            if cell not in cells:
                cells[cell] = self._cell(name, cell)
            amount = cells[cell]
            if isinstance(amount, str):
                self.bad.setdefault(at, (name, amount))
                continue
            amounts[at], values[at] = amount, amount.value
            if amount.share:
                self.shares[at] = amount.value
        return values

    def _cell(self, name: str, cell: Any) -> Amount | str:
        """Return the amount in a cell, or why it is none."""
        text = "" if cell is None else str(cell).strip()
        if name == "M" and not text:
            text = DEFAULT_M
        if not text or text == "nan":
            return "is empty; expected a number"
        if self.solver.table.decimal_comma:
            text = _with_point(text)
        try:
            amount = read(name, text, self.solver.view, self.solver.columns[name][1])
        except UserError as error:
            return str(error).removeprefix(f"{name} ")
        return f"= {quoted(text)} is a range; expected one number" if amount.varies else amount

    def _compute(self) -> None:
        """Add the columns that are computed for each row."""
        solver, columns = self.solver, self.columns
        for name in solver.case.estimated:
            if name in solver.computed and f"M{name[1]}" in solver.columns:
                columns[name] = self._estimates(name, columns[f"M{name[1]}"])
        for name, x, y in (("TA", "UX", "UY"), ("TB", "VX", "VY")):
            if name in solver.computed and x in columns and y in columns:
                turn = 180.0 if name == "TA" else 0.0
                columns[name] = np.degrees(np.arctan2(columns[y], columns[x])) + turn
        if "M" in solver.columns or solver.constants.get("M") == 4:
            blank = np.where(self.points, 0.0, np.nan)
            columns |= {name: blank for name in UNUSED_BY_POINTS if name not in columns}
        if solver.share:
            self.shares[:] = solver.share.value
        where = np.flatnonzero(~np.isnan(self.shares))
        if where.size:
            scene = {n: np.broadcast_to(x, self.count)[where] for n, x in columns.items()}
            critical = evaluate({n: x for n, x in scene.items() if n != "MU"}, ["MUC"])[0]
            columns["MU"] = np.array(columns.get("MU", np.full(self.count, np.nan)))
            columns["MU"][where] = self.shares[where] * np.abs(critical.get("MUC", np.nan))

    def _estimates(self, name: str, masses: Floats) -> Floats:
        """Return yaw inertias estimated from each row's mass."""
        case, vehicle = self.solver.case, name[1]
        sizes = [case.sizes[n].value for n in (f"L{vehicle}", f"B{vehicle}") if n in case.sizes]
        values = np.full(self.count, np.nan)
        for at, mass in enumerate(masses.tolist()):
            try:
                values[at] = estimate(name, mass, sizes, self.solver.view)[0]
            except UserError as error:
                self.bad.setdefault(at, (name, str(error).removeprefix(f"{name} ")))
        return values

    def refuse(self, results: Mapping[str, NDArray[Any]]) -> None:
        """Add the rows whose numbers no impact has, among those without a result."""
        suspects = np.zeros(self.count, np.bool_)
        for name, values in results.items():
            suspects |= (values == Status.NOT_FINITE) if name == "STATUS" else np.isnan(values)
        for at in np.flatnonzero(suspects).tolist():
            scene = {n: float(np.broadcast_to(x, self.count)[at]) for n, x in self.columns.items()}
            if refusal := _refusal(scene):
                name, reason = refusal
                self.bad.setdefault(at, (name, f"= {to_text(scene[name])} {reason}"))

    def texts(self, name: str) -> list[str]:
        """Return a column as the digits typed into the 1988 program."""
        solver, default = self.solver, "1" if name in ("IA", "IB") else "0"
        values = self.columns.get(name, np.full(self.count, math.nan))
        if name not in solver.columns:
            if name in solver.case.texts and name not in solver.computed:
                return [solver.case.texts[name]] * self.count
            return [default if math.isnan(x) else to_text(x) for x in values.tolist()]
        factor, offset = solver.view.map(name, solver.columns[name][1])
        is_typed = factor == 1 and not offset
        texts = []
        for at, cell in enumerate(self.block.columns[solver.columns[name][0]]):
            amount = self.amounts[name].get(at)
            if amount:
                text = to_text(float(values[at])) if amount.share else amount.typed
            elif math.isnan(values[at]):  # a bad cell, or one that point masses do not look at
                text = default
            else:
                text = cell.strip().upper() if isinstance(cell, str) else to_text(float(cell))
                text = _with_point(text) if solver.table.decimal_comma else text
                text = text if is_typed else to_text(float(offset + factor * exact(text)))
            if len(text) > MAX_TYPED or text == "INF":
                fault = f"= {quoted(cell)} cannot be typed; expected at most {MAX_TYPED} digits"
                self.bad.setdefault(at, (name, fault))
            texts.append(text)
        return texts

    def output_column(self, heading: str) -> Column:
        """Return a column of the table for the output."""
        solver, name = self.solver, heading_name(heading)[0]
        if name in solver.replaced and name in solver.case.texts:
            text = solver.view.shown_text(name, to_double(solver.case.texts[name]))
            return [text] * self.count if solver.as_text else np.full(self.count, float(text))
        if name in solver.replaced:
            return solver.view.shown(name, self.columns[name])
        column = self.block.columns.get(heading, [None] * self.count)
        if solver.as_text or name not in solver.columns:
            return column
        shown = plain_numbers(column, solver.table.decimal_comma).copy()
        factor, offset = (float(x) for x in solver.view.map(name, solver.columns[name][1]))
        for at in self.amounts[name]:
            shown[at] = (self.columns[name][at] - offset) / factor
        return shown


def _refusal(scene: Mapping[str, float]) -> tuple[str, str] | None:
    """Return a value that no impact has, and why; None for a scene without one."""
    if scene["M"] not in (4, 6):
        return "M", "is neither 4 nor 6"
    for name, value in scene.items():
        if scene["M"] == 4 and name in UNUSED_BY_POINTS:
            continue
        if name in ("MA", "MB", "IA", "IB") and not value > 0:
            return name, "is not above 0"
        if not (math.isfinite(value) or (value == math.inf and name in ("MA", "MB", "IA", "IB"))):
            return name, "is no finite number"
    for inertia, names in (("MA", "UX UY"), ("MB", "VX VY"), ("IA", "WA"), ("IB", "WB")):
        for name in names.split():
            if scene[inertia] == math.inf and scene[name]:
                return name, f"is not 0, and {inertia} is infinite: a barrier is at rest"
    if all(math.inf in (scene[f"M{vehicle}"], scene[f"I{vehicle}"]) for vehicle in "AB"):
        return "MB", "or IB is infinite, and so is MA or IA"
    return None


def plain_numbers(column: Column, decimal_comma: bool = False) -> Floats:
    """Return a column as doubles, NaN where a cell is no plain number."""
    if isinstance(column, np.ndarray) and column.dtype.kind in "fiub":
        return column.astype(np.float64, copy=False)
    if hasattr(column, "cast"):  # polars
        import polars

        if decimal_comma:
            column = column.str.replace(r"^\s*([-+]?\d*),(\d+)\s*$", "${1}.${2}")
        return np.array(column.cast(polars.Float64, strict=False).to_numpy(), np.float64)
    cells = [_with_point(cell) if cell else cell for cell in column] if decimal_comma else column
    with suppress(OverflowError):  # a whole number beyond doubles
        if {*map(type, cells)} <= {float, int, NoneType}:
            return np.array(cells, np.float64)
    with suppress(TypeError, ValueError):  # some cell is no plain number
        if " " not in "".join(cells):
            return np.array(to_doubles(cells))
    return np.array([_double(cell) for cell in cells], np.float64)


def _double(cell: Any) -> float:
    """Return the double of a cell, NaN for one that is no plain number."""
    try:
        if isinstance(cell, str):  # INPUT reads "1 0" as ten; a table's writer hardly means it
            return math.nan if " " in cell.strip() else to_double(cell)
        return float(cell)
    except (TypeError, ValueError, OverflowError):
        return math.nan


def _with_point(text: str) -> str:
    """Return a number with a decimal comma as one with a point."""
    head, comma, tail = text.rpartition(",")
    is_decimal = comma and "," not in head and tail[:1].isdigit()
    return f"{head.replace('.', '')}.{tail}" if is_decimal else text


def _headings_by_name(names: Sequence[str]) -> dict[str, tuple[str, str]]:
    """Return heading and symbol of the unit by quantity. Raises UserError for two columns of one
    quantity, and for a unit that does not measure it."""
    headings: dict[str, tuple[str, str]] = {}
    for heading in names:
        name, unit = heading_name(heading)
        if not name:
            continue
        if name in headings:
            raise UserError(f"{headings[name][0]} and {heading} are two columns of {name}")
        symbol = unit_of(quantity(name).unit, unit).symbol if unit and name in SCENE else ""
        headings[name] = heading, symbol
    return headings


def _view(headings: Mapping[str, tuple[str, str]], view: View) -> View:
    """Return the view of a table: the one given, else with the system that its headings' units
    name. Raises UserError where only some headings have units."""
    if view.units:
        return view
    units = {n: u for n, (_, u) in headings.items() if n in SCENE and SCENE[n].unit in DIMENSIONS}
    system = system_using([(SCENE[n].unit, unit) for n, unit in units.items() if unit])
    bare = [name for name, unit in units.items() if not unit]
    if system and bare:
        usual = View(system).heading(bare[0])
        raise UserError(
            f"some headings have units, and {bare[0]} has none; expected {usual}, or "
            f"--units {system} for columns without"
        )
    return View(system, view.axes, view.headings)


def _in_view(case: Case, view: View) -> Case:
    """Return the case of a table's constants in the table's view. Raises UserError for a scene
    file's bare numbers beside columns with units."""
    if case.view == view:
        return case
    for name, text in case.written.items():
        is_measured = name in SCENE and SCENE[name].unit in DIMENSIONS
        is_bare = isinstance(text, str) and normalize(text)[-1:].isdigit()
        if is_measured and is_bare and case.place(name) != "--set":
            message = f'{name} = {text} has no unit, and the columns have; expected units = "..."'
            raise UserError(message, case.place(name))
    return Case.of(case.written, case.source, view, case.places)
