"""The rows of a table solved, in either arithmetic; a bad row is reported and left empty."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import nullcontext, suppress
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..cases.amounts import Amount, read
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

INERTIAS = ("MA", "MB", "IA", "IB")
RESISTANCES = {"UX": "MA", "UY": "MA", "VX": "MB", "VY": "MB", "WA": "IA", "WB": "IB"}
"""Velocities, each with the mass or inertia that is infinite for a barrier."""
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
    """Counts of a table's rows, and what to say of them.

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
    kind = format_of(target, target_format)
    if isinstance(source, str):
        source = read_table(source, source_format, encoding, arithmetic == "applesoft")
    solver = Solver(source, results, case, replaced, view, arithmetic, kind == "csv", results_only)
    solved = Solved(counts=source.counts, remarks=[*source.remarks])
    extent, position = source.extent
    with replacing(errors) if errors else nullcontext(io.StringIO()) as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(BadRow._fields)

        def blocks() -> Iterator[Mapping[str, Column]]:
            for block in source.blocks:
                columns, bad, ended = solver.solve(block)
                solved.rows += len(block.rows)
                solved.bad += len(bad)
                solved.ended += ended
                solved.listed += bad[: MAX_LISTED - len(solved.listed)]
                if errors:
                    writer.writerows(bad)
                if progress:
                    progress(solved.rows, position() / extent if extent else None)
                yield columns
            if not solved.rows:
                yield solver.solve(Block({name: [] for name in source.names}, []))[0]

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
        self.table, self.as_text = table, as_text
        self.is_applesoft = arithmetic == "applesoft"
        allowed = APPLESOFT_RESULTS if self.is_applesoft else tuple(RESULTS)
        self.results = tuple(results) or allowed
        check_names(self.results, allowed, f"result of --arithmetic {arithmetic}", "--outputs")
        case = case or Case.of({}, view=view)
        try:
            headings = _headings_by_name(table.names)
            self.view = _view(headings, case.view)
        except UserError as error:
            raise UserError(str(error), table.where) from None
        if self.view != case.view:
            case = Case.of(case.written, case.source, self.view, case.places, is_inferred=True)
        self.case = case
        self.replaced = {*replaced} & {*case.entries}
        self.columns = {n: h for n, h in headings.items() if n in SCENE and n not in self.replaced}
        self.kept = {
            heading: name
            for heading in table.names
            for name, _ in [heading_name(heading)]
            if not (results_only and name in SCENE)
        }
        friction = case.entries.get("MU", PLAIN_FRICTION)
        self.share = friction.value if friction.share and "MU" not in self.columns else math.nan
        self.followed = {n for n in ("TA", "TB") if case.written.get(n) == COURSE} - {*self.columns}
        self.estimated = {n for n in case.estimated if f"M{n[1]}" in self.columns} - {*self.columns}
        computed = {*self.columns, *self.followed, *self.estimated}
        computed |= set() if math.isnan(self.share) else {"MU"}
        self.constants = {n: x for n, x in case.numbers.items() if n not in computed}
        self._counts: dict[str, tuple[int, int, str]] = {}
        self._leave_out_results({*computed, *self.constants, *case.estimated, "M"})

    def _leave_out_results(self, present: set[str]) -> None:
        """Leave out results of point masses whose inputs are missing. Raises UserError where the
        table lacks another column."""
        self.may_be_points = "M" in self.columns or self.constants.get("M") == 4
        optional = OPTIONAL_OF_POINTS if self.may_be_points else ()
        lacking = [n for n in SCENE if n not in present]
        if absent := [n for n in lacking if n not in optional]:
            message = f"no column {' '.join(absent)}; --set NAME=VALUE gives one for all rows"
            raise UserError(message, self.table.where)
        scene = dict.fromkeys(present, 1.0) | {"WA": 0.0, "WB": 0.0, "M": 4.0}
        is_complete = self.is_applesoft or not lacking
        self.left_out = {} if is_complete else evaluate(scene, self.results)[1]
        self.results = tuple(name for name in self.results if name not in self.left_out)
        if not self.results:
            raise UserError("; ".join(self.remarks()), self.table.where)

    def remarks(self) -> list[str]:
        """Return the remarks on all rows so far."""
        lines = [f"{name} needs {' '.join(names)}" for name, names in self.left_out.items()]
        for row, count, text in self._counts.values():
            more = f" and {count - 1:,} more" if count > 1 else ""
            lines.append(f"{self.table.counts} {row:,}{more}: {text}")
        return lines

    def solve(self, block: Block) -> tuple[dict[str, Column], list[BadRow], int]:
        """Return a block with its results, its bad rows, and how many rows ended with an error."""
        rows = _Rows(self, block)
        self._remark(rows)
        if self.is_applesoft:
            results = rows.replay()
            is_error = (results["ERROR"] != "") & (results["ERROR"] != ZERO_DETERMINANT)
        else:
            results = rows.solve()
            is_error = np.zeros(rows.count, np.bool_)
        bad = sorted(rows.bad)
        is_error[bad] = False
        for name, values in results.items():
            values[bad] = _EMPTY.get(name, math.nan)
        columns = {heading: rows.output_column(heading) for heading in self.kept}
        for name, values in results.items():
            if name in RESULTS:
                columns[self.view.heading(name)] = self.view.shown(name, values)
            else:
                columns[name] = values
        complaints = [BadRow(block.rows[at], *rows.bad[at]) for at in bad]
        return columns, complaints, int(np.count_nonzero(is_error))

    @np.errstate(all="ignore")
    def _remark(self, rows: _Rows) -> None:
        """Count the rows that each plausibility remark applies to."""
        courses = {name[1]: rows.course(name) for name in ("TA", "TB")}
        sizes = {name: amount.value for name, amount in self.case.sizes.items()}
        for name, where, words, amount in implausible(rows.columns, self.view, courses, sizes):
            places = np.flatnonzero(np.broadcast_to(where, rows.count))
            if not places.size or name not in {*self.columns, "TA", "TB"}:
                continue
            first = int(places[0])
            entry = f"{name} = {rows.cells(name)[first]}" if name in self.columns else name
            value = float(np.broadcast_to(amount, rows.count)[first])
            text = words.format(entry=entry, amount=value)
            row, count, text = self._counts.get(name, (rows.block.rows[first], 0, text))
            self._counts[name] = row, count + places.size, text


PLAIN_FRICTION = Amount.exactly(0.0)
_EMPTY = {"ERROR": "", "LINE": 0, "STATUS": Status.NOT_FINITE}
"""Results of a row that cannot be used; others are NaN."""


class _Rows:
    """The scene's columns of one block in base units; ``bad``: column and reason by place."""

    def __init__(self, solver: Solver, block: Block) -> None:
        self.solver, self.block, self.count = solver, block, len(block.rows)
        self.bad: dict[int, tuple[str, str]] = {}
        self.amounts: dict[str, dict[int, Amount]] = {}
        self.shown: dict[str, Floats] = {}
        self.columns: dict[str, Floats] = {
            name: np.full(self.count, value) for name, value in solver.constants.items()
        }
        self.shares = np.full(self.count, solver.share)
        for name in sorted(solver.columns, key="M".__ne__):  # M decides which others are used
            self._read(name)
        if solver.may_be_points:
            is_point, ones = self.columns["M"] == 4, ("IA", "IB")  # line 480 divides by these
            used = {*self.columns, *solver.followed, *solver.estimated}
            for name in {*OPTIONAL_OF_POINTS} - used:
                self.columns[name] = np.where(is_point, float(name in ones), np.nan)
        for name in solver.estimated:
            self._estimate(name)
        for name in solver.followed:
            self.columns[name] = self.course(name) + 180.0 * (name == "TA")
        self._set_friction()

    def cells(self, name: str) -> Column:
        """Return the cells of a column."""
        return self.block.columns[self.solver.columns[name][0]]

    def _read(self, name: str) -> None:
        """Set a column, NaN in bad cells."""
        solver, cells, unit = self.solver, self.cells(name), self.solver.columns[name][1]
        factor, offset = (float(x) for x in solver.view.map(name, unit))
        shown = plain_numbers(cells)
        is_odd = ~np.isfinite(shown)
        if name in UNUSED_BY_POINTS:
            is_odd &= self.columns["M"] != 4
        self.amounts[name] = amounts = self._amounts(
            name, {at: cells[at] for at in np.flatnonzero(is_odd).tolist()}, self._amount
        )
        is_base = factor == 1 and not offset
        values = shown.copy() if is_base else offset + factor * shown
        if amounts:
            shown = shown.copy()
        for at, amount in amounts.items():
            values[at], shown[at] = amount.value, (amount.value - offset) / factor
            if amount.share:
                self.shares[at] = amount.value
        self.columns[name], self.shown[name] = values, shown

    def _amounts(
        self, name: str, cells: Mapping[int, Any], function: Callable[[str, Any], Amount]
    ) -> dict[int, Amount]:
        """Return the amounts of cells by place, those that are refused among the bad rows."""
        results: dict[Any, Amount | str] = {}
        amounts = {}
        for at, cell in cells.items():
            if cell not in results:
                try:
                    results[cell] = function(name, cell)
                except UserError as error:
                    results[cell] = str(error).removeprefix(f"{name} ")
            result = results[cell]
            if isinstance(result, str):
                self.bad.setdefault(at, (name, result))
            else:
                amounts[at] = result
        return amounts

    def _amount(self, name: str, cell: Any) -> Amount:
        """Return the amount in a cell. Raises UserError."""
        text = "" if cell is None else str(cell).strip()
        if text in ("", "nan"):
            if name != "M":
                raise UserError("is empty; expected a number")
            text = DEFAULT_M
        amount = read(name, text, self.solver.view, self.solver.columns[name][1])
        if amount.varies:
            raise UserError(f"= {quoted(text)} is a range; expected one number")
        return amount

    def _estimate(self, name: str) -> None:
        """Set yaw inertias estimated from each row's mass."""
        sizes = [amount.value for n, amount in self.solver.case.sizes.items() if n[1] == name[1]]

        def inertia(name: str, mass: float) -> Amount:
            return Amount.exactly(estimate(name, mass, sizes, self.solver.view)[0])

        masses = dict(enumerate(self.columns[f"M{name[1]}"].tolist()))
        amounts = self._amounts(name, masses, inertia)
        values = [amounts[at].value if at in amounts else math.nan for at in masses]
        self.columns[name] = np.array(values)

    def course(self, heading: str) -> Floats:
        """Return the courses of the vehicle with a heading, TA or TB, NaN at rest."""
        x, y = (self.columns[n] for n in (("UX", "UY") if heading == "TA" else ("VX", "VY")))
        return np.where((x == 0) & (y == 0), np.nan, np.degrees(np.arctan2(y, x)))

    def _set_friction(self) -> None:
        """Set the friction that is a share of the critical friction of its row."""
        where = np.flatnonzero(~np.isnan(self.shares))
        if where.size:
            scene = {n: x[where] for n, x in self.columns.items() if n != "MU"}
            values = evaluate(scene, ["MUC", "gt"])[0]
            turn = np.where(values.get("gt", 0.0) > 0, -1.0, 1.0)  # line 400 turns it again
            friction = self.columns.setdefault("MU", np.full(self.count, np.nan))
            friction[where] = self.shares[where] * turn * values.get("MUC", np.nan)
            self.shown["MU"] = friction

    def solve(self) -> dict[str, NDArray[Any]]:
        """Return the results in double precision; rows whose numbers no impact has become bad."""
        solution = solve(self.columns, self.solver.results)
        results = {n: np.array(np.broadcast_to(x, self.count)) for n, x in solution.items()}
        is_empty = np.zeros(self.count, np.bool_)
        for name, values in results.items():
            is_empty |= (values == Status.NOT_FINITE) if name == "STATUS" else np.isnan(values)
        for at in np.flatnonzero(is_empty).tolist():
            scene = {n: float(x[at]) for n, x in self.columns.items()}
            if refusal := _refusal(scene):
                name, reason = refusal
                self.bad.setdefault(at, (name, f"= {to_text(scene[name])} {reason}"))
        return results

    def replay(self) -> dict[str, NDArray[Any]]:
        """Return the results of the 1988 arithmetic."""
        from ..program.replay import replay

        texts = {name: self._texts(name) for name in SCENE}
        for at in self.bad:
            for column in texts.values():
                column[at] = "6"
        outcome = replay({name: column or ["6"] for name, column in texts.items()})
        results = {name: outcome.floats(name) for name in self.solver.results}
        results["ERROR"] = np.where(outcome.zero_determinant, ZERO_DETERMINANT, outcome.error)
        results["LINE"] = np.array(outcome.line)
        return {name: values[: self.count] for name, values in results.items()}

    def _texts(self, name: str) -> list[str]:
        """Return a column as the digits typed into the 1988 program."""
        default = "1" if name in ("IA", "IB") else "0"
        values = self.columns.get(name, np.full(self.count, np.nan))
        is_open = ~np.isfinite(values)
        is_ignored = is_open & (self.columns["M"] == 4)
        is_ignored[[*self.bad]] = True
        texts = []
        for at, digits in enumerate(self._digits(name)):
            text = digits or (default if is_ignored[at] else to_text(float(values[at])))
            is_missing = is_open[at] and not is_ignored[at]
            if is_missing or len(text) > MAX_TYPED or text == "INF":
                fault = f"= {quoted(text)} cannot be typed; expected up to {MAX_TYPED} digits"
                self.bad.setdefault(at, (name, fault))
            texts.append(text)
        return texts

    def _digits(self, name: str) -> Iterable[str]:
        """Yield the digits of a column in base units where they are written, else "" ."""
        solver = self.solver
        if name not in solver.columns:
            text = solver.case.texts.get(name, "") if name in solver.constants else ""
            yield from [text] * self.count
            return
        factor, offset = solver.view.map(name, solver.columns[name][1])
        is_base, is_turned = factor == 1 and not offset, abs(factor) == 1
        is_plain = np.isfinite(self.shown[name]).tolist()
        for at, cell in enumerate(self.cells(name)):
            if at in self.amounts[name]:
                amount = self.amounts[name][at]
                yield "" if amount.share else amount.typed
                continue
            text = cell.strip().upper() if isinstance(cell, str) else ""
            if is_plain[at] and not text:
                text = to_text(float(cell))
            if not is_plain[at] or is_base:
                yield text * is_plain[at]
            elif is_turned:  # digits are kept where only the sign changes
                yield Amount.exactly(to_double(text), text).mapped(factor, offset).typed
            else:
                yield to_text(float(offset + factor * exact(text)))

    def output_column(self, heading: str) -> Column:
        """Return a column of the table for the output."""
        solver, name = self.solver, self.solver.kept[heading]
        if name in solver.replaced:
            values = solver.constants.get(name, self.columns[name])
            return np.full(self.count, solver.view.shown(name, values))
        if name in self.shown and not solver.as_text:
            return self.shown[name]
        return self.block.columns.get(heading, [None] * self.count)


def _refusal(scene: Mapping[str, float]) -> tuple[str, str] | None:
    """Return a value that no impact has, and why; None for a scene without one."""
    ignored = UNUSED_BY_POINTS if scene["M"] == 4 else ()
    numbers = {name: value for name, value in scene.items() if name not in ignored}
    barriers = {name for name in INERTIAS if numbers.get(name) == math.inf}
    faults = [("M", scene["M"] not in (4, 6), "is neither 4 nor 6")]
    for name, value in numbers.items():
        is_infinite = not math.isfinite(value) and name not in barriers
        faults.append((name, name in INERTIAS and not value > 0, "is not above 0"))
        faults.append((name, is_infinite, "is no finite number"))
    for name, inertia in RESISTANCES.items():
        reason = f"is not 0, and {inertia} is infinite: a barrier is at rest"
        faults.append((name, inertia in barriers and scene[name] != 0, reason))
    are_both = len({name[1] for name in barriers}) > 1
    faults.append(("MB", are_both, "or IB is infinite, and so is MA or IA"))
    return next(((name, reason) for name, is_fault, reason in faults if is_fault), None)


def plain_numbers(column: Column) -> Floats:
    """Return a column as doubles, NaN where a cell is no plain number."""
    if isinstance(column, np.ndarray) and column.dtype.kind in "fiub":
        return column.astype(np.float64, copy=False)
    if hasattr(column, "cast"):  # polars
        import polars

        return np.array(column.cast(polars.Float64, strict=False).to_numpy(), np.float64)
    with suppress(TypeError, ValueError):  # some cell is no plain number
        if " " not in "".join(column):
            return np.array(to_doubles(column))
    return np.array([_double(cell) for cell in column], np.float64)


def _double(cell: Any) -> float:
    """Return the double of a cell, NaN for one that is no plain number."""
    try:
        if isinstance(cell, str):  # INPUT reads "1 0" as ten; a table's writer hardly means it
            return math.nan if " " in cell.strip() else to_double(cell)
        return float(cell)
    except (TypeError, ValueError, OverflowError):
        return math.nan


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
