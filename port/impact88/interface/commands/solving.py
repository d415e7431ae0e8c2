"""Tables solved in blocks of rows, whatever the format; bad rows are reported apart."""

import argparse
import csv
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import ExitStack, contextmanager, nullcontext, suppress
from functools import partial
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...collision.case import OWN_NAMES, VALUE_LIMIT, Case, check_value, is_share, share_of
from ...collision.doubles import double, is_number
from ...collision.fields import ZERO_DETERMINANT
from ...collision.needs import sentences
from ...collision.scenefile import case_in
from ...collision.units import Convention, convention_named
from ...errors import UserError, note, quoted
from ...files import display_name, replacing
from ...mechanics.approach import approaching
from ...mechanics.closedform.columns import INERTIAS, UNUSED_BY_POINTS, examine, refusals
from ...mechanics.closedform.share import resolve_share, share_typed
from ...mechanics.closedform.solve import solve
from ...messages.progress import progress
from ...names import DEFAULT_M, RESULTS, SCENE, check_names, missing
from ...status import Status
from ...tables.cells import (
    Amount,
    TableUnits,
    check_scene_columns,
    fill_blanks,
    numbers,
    point_masses,
    vanished,
)
from ...tables.csvtable import has_live_text
from ...tables.remarks import Remark, remarks
from ...tables.rows import BadCell, Rows, heading, shortest
from ...tables.sweep import estimates, read_ranges, read_sweep
from ...tables.table import (
    format_of,
    is_short,
    may_wait,
    open_reader,
    open_writer,
    read_ahead,
    write_behind,
)
from . import options

Results = dict[str, NDArray[Any]]

MAX_BAD_ROWS_LISTED = 20  # on stderr, when no file takes them all: one screenful


def solve_table(args: options.Args) -> int:
    """Returns 1 when a row is bad or ended with an Applesoft error."""
    path = args.cases
    if bool(path) == bool(args.sample):
        raise UserError("expected one table or scene: CASES, or --sample 1, 2 or 3")
    one_scene = path is None or path.lower().endswith(".toml")
    if args.sweep and not one_scene:
        raise UserError("--sweep is for one scene; expected CASES to be a scene file (.toml)")
    source_format = "csv" if one_scene else format_of(path, args.form)
    to = args.to or (source_format if args.output == "-" else None)
    result_format = format_of(args.output, to)
    arithmetic, result_names = _float64, [*RESULTS]
    if args.arithmetic == "applesoft":
        arithmetic, result_names = (
            _applesoft,
            [n for n, q in RESULTS.items() if q.line or n == "KF"],
        )
    kind = f"result of --arithmetic {args.arithmetic}"
    outputs = options.names_given(args.outputs, result_names, "--outputs", kind) or result_names
    with ExitStack() as stack:
        swept: dict[str, Any] = {}
        if one_scene:
            options.set_pairs(args.set, (*SCENE, *OWN_NAMES))
            case = options.case_given(argparse.Namespace(**(vars(args) | {"scene": path})))
            if args.arithmetic != "applesoft" and not args.sweep:
                given, case = case, approaching(case)
                if case is not given:
                    note("solve", case.remarks["GA"])
            options.note_remarks(case.at_nominal())
            swept = read_ranges(options.sweeps(args.sweep), case)
            source = stack.enter_context(read_sweep(case, swept))
        else:
            source = stack.enter_context(open_reader(path, source_format, args.encoding))
        for remark in source.remarks:
            note("solve", remark)
        blocks = iter(source)
        first = next(blocks, None)
        blocks = chain([] if first is None else [first], blocks)
        extra_case = case if one_scene else _filling(args) if args.scene else None
        system = extra_case.units if extra_case else args.units
        units = TableUnits(
            source.names, system or args.units, first, where=display_name(path or "--sample")
        )
        units.convention = _convention(args, extra_case)
        constants: dict[str, str] = {}
        inertias: dict[str, Callable[[Rows], list[str | None]]] = {}
        if not one_scene:
            changes = options.set_pairs(args.set, (*SCENE, *OWN_NAMES))
            if extra_case is None:
                chosen = (units.system.name or None, args.axes, args.headings)
                extra_case = Case({}, "--set", *chosen)
            elif not extra_case.units and not units.system.is_bare:
                _refuse_bare(extra_case, units)
            extra_case = options.change_case(extra_case, changes, "--set").at_nominal()
            constants = _constants_given(extra_case, changes, source.names)
            inertias = {
                name: partial(
                    _estimate_inertias, units=units, name=name, estimate=estimate, case=extra_case
                )
                for name, estimate in estimates(extra_case).items()
                if name in constants and f"M{name[1]}" in source.names
            }
        points = constants.get("M", "4" if "M" in source.names else "6") == "4"
        if one_scene and extra_case is not None:
            points = extra_case.values["M"].strip() == "4"
        present = {*source.names, *constants}
        if not one_scene:
            check_scene_columns(present, points, where=display_name(path))
        lacking = _Lacking(present, points)
        if arithmetic is _applesoft and lacking.names:
            raise UserError(missing(lacking.names), display_name(path or "--sample"))
        stack.callback(lacking.say)
        if swept:  # the rest is the same in every row
            source.names = [name for name in source.names if name in swept or name not in SCENE]
        elif units.strict:
            source.names = units.headings(source.names)
        extra_columns = ["ERROR", "LINE"] if arithmetic is _applesoft else []
        headings = units.headings([*outputs, *extra_columns])
        scene_too = bool(swept) or not args.results_only
        writer = open_writer(args.output, result_format, source, headings, scene_too)
        write = stack.enter_context(writer)
        complain = stack.enter_context(_complaints(args.errors))
        meter = stack.enter_context(progress(source.total, "solve", "B"))
        in_threads = bool(swept) if one_scene else not is_short(path)
        if in_threads and not may_wait(args.output):
            write = stack.enter_context(write_behind(write))
        if in_threads and not may_wait(path or ""):
            blocks = stack.enter_context(read_ahead(blocks))
        units.based = constants
        noted_names = [*case.at_nominal().remarks] if one_scene else []
        if args.scene and extra_case is not None:
            noted_names = [name for name in extra_case.remarks if name not in source.names]
        remarks = _Remarks(noted_names, constants, extra_case)
        stack.callback(remarks.say)
        live: set[str] = set()
        stack.callback(_say_live, live)
        adverse = place = 0
        for rows in blocks:
            for name, text in constants.items():
                rows.columns.pop(name, None)  # and with it the heading of another unit
                rows.columns[name] = [text] * rows.count
            for name, estimate in inertias.items():
                rows.columns[name] = estimate(rows)
            # a block may lack what others have: a complaint where a row looks at the empty cells
            blanks = [None] * rows.count
            rows.columns |= {n: blanks for n in lacking.filled if n not in rows.columns}
            rows.columns["M"] = fill_blanks(rows.columns["M"], DEFAULT_M)
            results = arithmetic(rows, units, outputs, remarks, lacking)
            write(rows, units.shown(results))
            if result_format == "csv" and scene_too:
                for name in {*rows.columns} - {*SCENE, *live}:
                    if has_live_text(rows.columns[name]):
                        live.add(name)
            adverse += complain(rows.complaints())
            if "ERROR" in results:
                errors = results["ERROR"]
                adverse += int(np.count_nonzero((errors != "") & (errors != ZERO_DETERMINANT)))
            meter.update(rows.place - place)
            place = rows.place
    return int(adverse > 0)


def _say_live(columns: Collection[str]) -> None:
    """Say that a CSV holds texts that a spreadsheet program computes."""
    if columns:
        names = " ".join(sorted(map(heading, columns)))
        note(
            "solve",
            f"column {names}: a text that begins with = or @ is a formula to a spreadsheet "
            "program; -o FILE.xlsx keeps it a text",
        )


class _Remarks:
    """Remarks on a table's rows, gathered block by block and said once at the end.

    ``told``: names of which something has been said; ``given``: columns that are one scene's, as
    ``beside`` has them.
    """

    def __init__(self, told: Collection[str], given: Collection[str], beside: Case | None) -> None:
        self._told, self._beside = told, beside
        self._given = given
        self._found: dict[str, tuple[str, Remark]] = {}

    def look(self, rows: Rows, units: TableUnits, columns: Results) -> None:
        """Gather the remarks on some rows. ``columns``: of the scene, in base units."""

        def cell(name: str, index: int) -> str:
            if self._beside is not None and name in self._given:
                return self._beside.given.get(name, "")
            column = rows.columns[name]
            if isinstance(column, np.ndarray):
                number = column.reshape(-1)[index % column.size]
                return shortest(np.array([number]))[0].removesuffix(".0")
            return str(column[index])

        found = remarks(columns, units.system, cell)
        for name, remark in (*vanished(rows, columns), *found.items()):
            if name in self._told:
                continue
            if name in self._found:
                self._found[name][1].rows += remark.rows
            else:
                line = f" (line {rows.lines[remark.first]})" if rows.lines else ""
                self._found[name] = f"row {rows.first + remark.first}{line}", remark

    def say(self) -> None:
        """Say all of it on stderr."""
        for place, remark in self._found.values():
            note("solve", f"{place}{remark.more}: {remark.text}")


def _filling(args: options.Args) -> Case:
    """Return the case that fills the columns that the table lacks."""
    case = case_in(args.scene, args.units, args.axes, args.headings)
    options.note_remarks(case.at_nominal())
    check_names(case.at_nominal().values, SCENE, "value of a scene", display_name(args.scene))
    return case


def _convention(args: options.Args, beside: Case | None) -> Convention | None:
    """Return the directions of a table's numbers: the case's beside it, or the options'."""
    if beside is not None:
        return beside.system.convention
    return convention_named(args.axes, args.headings, "")


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
        if text != "inf" and not (name == "MU" and is_share(text)):
            check_value(name, text, case.source)
    return texts


def _estimate_inertias(
    rows: Rows, units: TableUnits, name: str, estimate: Callable[[str], str], case: Case
) -> list[str | None]:
    """Return a column of inertias estimated from each row's own mass; nothing for a mass that is
    none, or no car's."""
    texts: list[str | None] = []
    for cell in rows.columns.get(f"M{name[1]}") or [None] * rows.count:
        try:
            mass = cell if isinstance(cell, str) else repr(float(cell)).upper()
            mass_text = units.cell(f"M{name[1]}", mass)
            texts.append(estimate(case.display_texts({f"M{name[1]}": mass_text})[f"M{name[1]}"]))
        except (UserError, TypeError, ValueError):
            texts.append(None)
    return texts


class _Lacking:
    """Inputs that a table has no column for, and what is said of the results that need them once at
    the end. ``filled``: the names that its rows have, if only as empty cells."""

    def __init__(self, present: Collection[str], points: bool) -> None:
        unused = UNUSED_BY_POINTS if points else ()
        self.names = [n for n in SCENE if n not in present and n not in ("M", *unused)]
        self.filled = [name for name in SCENE if name not in self.names]
        self.absent: dict[str, tuple[str, ...]] = {}

    def say(self) -> None:
        for sentence in sentences(self.absent):
            note("solve", sentence)


def _float64(
    rows: Rows, units: TableUnits, wanted: Sequence[str], said: _Remarks, lacking: _Lacking
) -> Results:
    """The closed form in double precision."""
    columns = numbers(rows, units)
    _read_shares(rows, columns)
    said.look(rows, units, columns)
    unread = {index for index, *_ in rows.bad}
    usable = {**dict.fromkeys(lacking.names, np.ones(1)), **columns}
    complete = {name: usable[name] for name in SCENE}
    any_refused = rows.count > 0 and examine(complete).refused is not None
    for refusal in refusals(complete) if any_refused else ():
        values = np.broadcast_to(complete[refusal.column], rows.count)
        rows_refused = np.flatnonzero(np.broadcast_to(refusal.where, rows.count)).tolist()
        for index in sorted({*rows_refused} - unread):
            unread.add(index)
            rows.bad.append((index, refusal.column, f"{float(values[index])!r} {refusal.reason}"))
    found = solve(columns, wanted)
    results = dict(found)
    if lacking.names:
        lacking.absent = getattr(found, "absent", {})
        for name in lacking.absent:
            results[name] = np.full(rows.count, np.nan)
        results = {name: np.array(np.broadcast_to(results[name], rows.count)) for name in wanted}
    return _blank_rows(results, unread)


def _blank_rows(results: Results, unread: set[int]) -> Results:
    """The results, none for the rows ``unread``."""
    placeholders = {"STATUS": Status.NOT_FINITE, "ERROR": "", "LINE": 0}
    for name, result in results.items():
        result[sorted(unread)] = placeholders.get(name, np.nan)
    return results


def _read_shares(rows: Rows, columns: dict[str, NDArray[np.float64]]) -> None:
    """Read the cells of MU that are shares of the critical friction, and withdraw the complaints
    about them."""
    places = [index for index, column, _ in rows.bad if column == "MU"]
    cells = {at: share_of(rows.columns["MU"][at]) for at in places}
    fractions = {at: share for at, share in cells.items() if share is not None}
    if fractions:
        at = list(fractions)
        scene_columns = {n: np.broadcast_to(x, (rows.count,))[at] for n, x in columns.items()}
        columns["MU"] = columns["MU"].copy()
        columns["MU"][at] = share_typed(scene_columns, list(fractions.values()))
        cells_kept = list(rows.columns["MU"])
        for index in at:  # a typed table holds the number
            cells_kept[index] = Amount(cells_kept[index], float(columns["MU"][index]))
        rows.columns["MU"] = cells_kept
        rows.bad = [bad for bad in rows.bad if bad[1] != "MU" or bad[0] not in fractions]


def _applesoft(
    rows: Rows, units: TableUnits, wanted: Sequence[str], said: _Remarks, lacking: _Lacking
) -> Results:
    """The listing's own arithmetic, `impact88.replay`."""
    from ...program.vectorized import replay

    points = point_masses(rows)
    columns = {n: _texts(n, column, units) for n, column in rows.scene().items()}
    resolved = Rows(rows.count, rows.columns, rows.lines, first=rows.first)
    said.look(resolved, units, numbers(resolved, units))
    for name in UNUSED_BY_POINTS if points.any() else ():
        # the program reads them all the same
        default = "1" if name in INERTIAS else "0"
        for index in np.flatnonzero(points).tolist():
            if columns[name][index] in (None, "", "NAN"):
                columns[name][index] = default
    shares: dict[int, Amount] = {}
    for index, cell in enumerate(columns["MU"]):
        if share_of(cell) is not None:
            scene = {name: column[index] for name, column in columns.items() if name in SCENE}
            with suppress(UserError, ValueError, TypeError):  # the cell's complaint follows
                columns["MU"][index] = text = resolve_share(scene, "")[0]
                shares[index] = Amount(cell, double(text))
    if shares:
        cells = list(rows.columns["MU"])
        rows.columns["MU"] = [shares.get(index, cell) for index, cell in enumerate(cells)]
    unread = {index for index, *_ in rows.bad}
    try:
        # nearly always all cells can be read, and looking at each takes as long as solving
        outcome = None if unread else replay(columns)
    except (ValueError, TypeError):  # UserError, or cells of several types
        outcome = None
    if outcome is None:
        _complain(rows, columns, unread)
        for column in columns.values():
            for index in unread:
                column[index] = "6"
        outcome = replay(columns)
    results: Results = {name: outcome.floats(name) for name in wanted}
    error = np.where(outcome.zero_determinant, ZERO_DETERMINANT, outcome.error)
    return _blank_rows({**results, "ERROR": error, "LINE": outcome.line}, unread)


def _texts(name: str, column: Any, units: TableUnits) -> list[Any]:
    """A column as texts that INPUT may read, those with a unit in base units."""
    if isinstance(column, np.ndarray):
        column = [repr(x).removesuffix(".0").upper() for x in column.tolist()]
    texts = [text.strip().upper() if isinstance(text, str) else text for text in column]
    converts = units.converts(name)
    for index, text in enumerate(column):
        # 1,234.5 is a number to those who write tables, not to INPUT
        if isinstance(text, str) and (converts or "," in text) and any(map(str.isdigit, text)):
            with suppress(UserError):
                texts[index] = units.cell(name, text)
    return texts


def _complain(rows: Rows, columns: dict[str, list[Any]], unread: set[int]) -> None:
    """Add what Applesoft cannot read to ``rows.bad``, the first of every row not yet ``unread``."""
    for name, column in columns.items():
        for index, text in enumerate(column):
            if index in unread:
                continue
            if text is None or text == "":
                reason = "is empty; expected a number"
            elif not (isinstance(text, str) and is_number(text)):
                reason = f"{quoted(text)} is not a number that Applesoft reads"
            elif len(text) > VALUE_LIMIT:
                reason = f"has more than {VALUE_LIMIT} characters"
            else:
                continue
            unread.add(index)
            rows.bad.append((index, name, reason))


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
