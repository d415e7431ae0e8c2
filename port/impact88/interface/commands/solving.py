"""Tables solved in blocks of rows, whatever the format; bad rows are reported apart."""

import argparse
import csv
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import ExitStack, contextmanager, nullcontext
from dataclasses import dataclass
from itertools import chain

import numpy as np

from ...collision.case import OWN_NAMES, Case, check_value, share_of
from ...collision.doubles import double_or_none
from ...collision.fields import ZERO_DETERMINANT
from ...collision.scenefile import case_in
from ...collision.units import convention_named
from ...errors import UserError, note
from ...files import display_name, replacing
from ...mechanics.approach import approaching
from ...messages.progress import progress
from ...names import RESULTS, SCENE, check_names, missing
from ...tables.cells import TableUnits, check_scene_columns
from ...tables.csvtable import has_live_text
from ...tables.rows import BadCell, Reader, Rows, heading
from ...tables.rowsolver import Filling, Results, RowSolver
from ...tables.sweep import estimates, read_ranges, read_sweep
from ...tables.table import (
    format_of,
    may_wait,
    open_reader,
    open_writer,
    read_ahead,
    write_behind,
)
from . import options

MAX_BAD_ROWS_LISTED = 20  # on stderr, when no file takes them all: one screenful


@dataclass
class _Table:
    """Rows to solve: their reader, its blocks, units, and what fills columns. ``where``: its name
    in messages; ``points``: all rows are point masses; ``swept``: values that run."""

    reader: Reader
    blocks: Iterator[Rows]
    units: TableUnits
    filling: Filling
    where: str
    points: bool
    swept: Collection[str]


def solve_table(args: options.Args) -> int:
    """Solve a table's rows, or one scene's. Returns 1 when a row is bad or ended with an Applesoft
    error."""
    if bool(args.cases) == bool(args.sample):
        raise UserError("expected one table or scene: CASES, or --sample 1, 2 or 3")
    is_scene = args.cases is None or args.cases.lower().endswith(".toml")
    if args.sweep and not is_scene:
        raise UserError("--sweep is for one scene; expected CASES to be a scene file (.toml)")
    if args.scene and is_scene:
        raise UserError("--scene fills a table's columns; expected CASES to be a table")
    source_format = "csv" if is_scene else format_of(args.cases, args.format)
    to = args.to or (source_format if args.output == "-" else None)
    result_format = format_of(args.output, to)
    outputs = _outputs(args)
    with ExitStack() as stack:
        opening = _scene_given(args) if is_scene else _table_given(args, source_format)
        table = stack.enter_context(opening)
        present = {*table.reader.names, *table.filling.constants}
        solver = RowSolver(
            args.arithmetic, outputs, table.units, table.filling, present, table.points
        )
        if args.arithmetic == "applesoft" and solver.lacking:
            raise UserError(missing(solver.lacking), table.where)
        stack.callback(_say, solver.needs)
        if table.swept:  # the rest is the same in every row
            names = [n for n in table.reader.names if n in table.swept or n not in SCENE]
            table.reader.names = names
        elif table.units.strict:
            table.reader.names = table.units.headings(table.reader.names)
        extra = ["ERROR", "LINE"] if args.arithmetic == "applesoft" else []
        headings = table.units.headings([*outputs, *extra])
        scene_too = bool(table.swept) or not args.results_only
        writer = open_writer(args.output, result_format, table.reader, headings, scene_too)
        write = stack.enter_context(writer)
        complain = stack.enter_context(_complaints(args.errors))
        meter = stack.enter_context(progress(table.reader.total, "solve"))
        read = table.blocks
        if not may_wait(args.output):
            write = stack.enter_context(write_behind(write))
        if not may_wait(args.cases or ""):
            read = stack.enter_context(read_ahead(read))
        table.units.based = table.filling.constants
        stack.callback(_say, solver.remarks)
        live: set[str] = set()
        stack.callback(_say, lambda: _live_remarks(live))
        adverse = place = 0
        for rows in read:
            results = solver.solve(rows)
            write(rows, table.units.shown(results))
            if result_format == "csv" and scene_too:
                live |= _live_columns(rows, live)
            adverse += complain(rows.complaints()) + _ended_by_error(results)
            meter.update(rows.place - place)
            place = rows.place
    return int(adverse > 0)


def _outputs(args: options.Args) -> list[str]:
    """Return the names of the results wanted."""
    names = [*RESULTS]
    if args.arithmetic == "applesoft":
        names = [n for n, q in RESULTS.items() if q.line or n == "KF"]
    kind = f"result of --arithmetic {args.arithmetic}"
    return options.names_given(args.outputs, names, "--outputs", kind) or names


@contextmanager
def _scene_given(args: options.Args) -> Iterator[_Table]:
    """Yield one scene as a table: of a row, or of a row for each value of its sweep."""
    options.set_pairs(args.set, (*SCENE, *OWN_NAMES))
    case = options.case_given(argparse.Namespace(**(vars(args) | {"scene": args.cases})))
    if args.arithmetic != "applesoft" and not args.sweep:
        given, case = case, approaching(case)
        if case is not given:
            note("solve", case.remarks["GA"])
    options.note_remarks(case.at_nominal())
    swept = read_ranges(options.sweeps(args.sweep), case)
    where = display_name(args.cases or "--sample")
    with read_sweep(case, swept) as reader:
        first, blocks = _first_block(reader)
        units = TableUnits(reader.names, case.units or args.units, first, where=where)
        units.convention = case.system.convention
        filling = Filling(case=case, noted=[*case.at_nominal().remarks])
        points = case.of_points
        yield _Table(reader, blocks, units, filling, where, points, swept)


@contextmanager
def _table_given(args: options.Args, format_name: str) -> Iterator[_Table]:
    """Yield the table that CASES names, filled from ``--scene`` and ``--set``."""
    where = display_name(args.cases)
    with open_reader(args.cases, format_name, args.encoding) as reader:
        first, blocks = _first_block(reader)
        extra_case = _scene_beside(args) if args.scene else None
        system = (extra_case.units if extra_case else None) or args.units
        units = TableUnits(reader.names, system, first, where=where)
        if extra_case:
            units.convention = extra_case.system.convention
        else:
            units.convention = convention_named(args.axes, args.headings, "")
        filling = _filling(args, extra_case, units, reader.names)
        present = {*reader.names, *filling.constants}
        m = filling.constants.get("M", "4" if "M" in reader.names else "6")
        points = double_or_none(m) == 4
        check_scene_columns(present, points, where=where)
        yield _Table(reader, blocks, units, filling, where, points, ())


def _first_block(reader: Reader) -> tuple[Rows | None, Iterator[Rows]]:
    """Say how a table was read, and return its first block, and all of them."""
    for remark in reader.remarks:
        note("solve", remark)
    blocks = iter(reader)
    first = next(blocks, None)
    return first, chain([] if first is None else [first], blocks)


def _scene_beside(args: options.Args) -> Case:
    """Return the case that fills the columns that the table lacks."""
    case = case_in(args.scene, args.units, args.axes, args.headings)
    options.note_remarks(case.at_nominal())
    check_names(case.at_nominal().values, SCENE, "value of a scene", display_name(args.scene))
    return case


def _filling(
    args: options.Args, beside: Case | None, units: TableUnits, columns: Collection[str]
) -> Filling:
    """Return what ``--set`` and a scene ``beside`` the table give for all its rows."""
    changes = options.set_pairs(args.set, (*SCENE, *OWN_NAMES))
    if beside is None:
        case = Case({}, "--set", units.system.name or None, args.axes, args.headings)
    else:
        case = beside
        if not case.units and not units.system.is_bare:
            _refuse_bare(case, units)
    case = options.change_case(case, changes, "--set").at_nominal()
    constants = _constants_given(case, changes, columns)
    inertias = {
        name: estimate
        for name, estimate in estimates(case).items()
        if name in constants and f"M{name[1]}" in columns
    }
    names_noted = [name for name in case.remarks if name not in columns] if args.scene else []
    return Filling(constants, inertias, case, names_noted)


def _refuse_bare(case: Case, units: TableUnits) -> None:
    """Raise UserError where a scene's bare numbers measure what the table has units for."""
    for name in case.values:
        if name in case.given and units.leaves_open(name):
            system = units.system.name
            raise UserError(
                f"{name} = {case.given[name]} has no unit, and the table's columns have; expected "
                f'one, or units = "{system}" in the file (--units {system})',
                case.source,
            )


def _constants_given(
    case: Case, changes: Collection[str], columns: Collection[str]
) -> dict[str, str]:
    """Return what takes the place of a table's columns, or stands for those it lacks: texts in base
    units."""
    texts = {n: t for n, t in case.values.items() if n in case.given or n not in (*columns, "M")}
    texts = {n: t for n, t in texts.items() if n in changes or n not in columns}
    for name, text in texts.items():
        if text != "inf" and not (name == "MU" and share_of(text) is not None):
            check_value(name, text, case.source)
    return texts


def _say(sentences: Callable[[], Sequence[str]]) -> None:
    for sentence in sentences():
        note("solve", sentence)


def _live_columns(rows: Rows, known: Collection[str]) -> set[str]:
    """Return further columns with texts that a spreadsheet program computes."""
    return {n for n in {*rows.columns} - {*SCENE, *known} if has_live_text(rows.columns[n])}


def _live_remarks(columns: Collection[str]) -> list[str]:
    """Return the remark on a CSV that holds texts that a spreadsheet program computes."""
    names = " ".join(sorted(map(heading, columns)))
    says = (
        f"column {names}: a text that begins with = or @ is a formula to a spreadsheet program; "
        "-o FILE.xlsx keeps it a text"
    )
    return [says] if columns else []


def _ended_by_error(results: Results) -> int:
    """Count the scenes that an Applesoft error ended; ZERO DETERMINANT is a normal end."""
    if "ERROR" not in results:
        return 0
    errors = results["ERROR"]
    return int(np.count_nonzero((errors != "") & (errors != ZERO_DETERMINANT)))


@contextmanager
def _complaints(path: str | None) -> Iterator[Callable[[Sequence[BadCell]], int]]:
    """A function that says of bad cells what is wrong, to a file or of the first to stderr, and
    returns how many there are."""
    count = 0
    with replacing(path) if path else nullcontext() as file:
        rows = csv.writer(file, lineterminator="\n") if file else None
        if rows:
            rows.writerow(BadCell._fields)

        def take(cells: Sequence[BadCell]) -> int:
            nonlocal count
            if rows:
                rows.writerows(sorted(cells))
            else:
                for cell in sorted(cells)[: max(0, MAX_BAD_ROWS_LISTED - count)]:
                    note("solve", str(cell))
            count += len(cells)
            return len(cells)

        yield take
    if (path and count) or count > MAX_BAD_ROWS_LISTED:
        advice = f": see {path}" if path else "; --errors FILE lists all of them"
        summary = f"{count:,} row{'s' if count > 1 else ''} could not be solved"
        note("solve", f"{summary}{advice}")
