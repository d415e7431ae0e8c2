"""The work of impact88 solve. `solve_command` has its help and options, which need no numpy."""

import argparse
import csv
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, nullcontext, suppress
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..closedform.columns import INERTIAS, UNUSED_BY_POINTS, examine, refusals
from ..closedform.share import resolved, share_of
from ..closedform.solve import share_typed, solve
from ..doubles import is_number
from ..errors import UserError, quoted
from ..files import called, replacing
from ..names import DEFAULT_M, RESULTS, SCENE, check_names
from ..progress import progress
from ..scene import VALUE_LIMIT, Entries, Scene, entries_in, sample
from ..status import Status
from ..stderr import note
from ..tables.overlap import ahead, behind, may_wait
from ..tables.rows import BadCell, Rows, check_scene_columns, filled, numbers, point_masses
from ..tables.sweep import read_ranges, read_sweep
from ..tables.table import format_of, open_reader, open_writer
from ..tables.tableunits import TableUnits
from . import options

Results = dict[str, NDArray[Any]]

SHOWN = 20
"""Bad rows listed on stderr when no file takes them all."""


def solve_table(arguments: argparse.Namespace) -> int:
    """Solve a table. Returns 1 when a row is bad or ended with an Applesoft error."""
    path, sweep = arguments.cases, arguments.sweep
    if bool(path) == bool(arguments.sample):
        raise UserError("expected one table or scene: CASES, or --sample 1, 2 or 3")
    one_scene = path is None or path.lower().endswith(".toml")
    if sweep and not one_scene:
        raise UserError("--sweep is for one scene; expected CASES to be a scene file (.toml)")
    source_format = "csv" if one_scene else format_of(path, arguments.form)
    to = arguments.to or (source_format if arguments.output == "-" else None)
    result_format = format_of(arguments.output, to)
    kind: type[_Float64 | _Applesoft]
    kind = _Float64 if arguments.arithmetic == "float64" else _Applesoft
    arithmetic = kind(arguments.outputs)
    with ExitStack() as stack:
        if one_scene:
            scene = Scene.from_toml(path, arguments.units) if path else sample(arguments.sample)
            options.note_remarks(scene.entries)
            ranges = read_ranges(options.sweeps(sweep), scene.units)
            source = stack.enter_context(read_sweep(scene, ranges, scene.units))
        else:
            source = stack.enter_context(open_reader(path, source_format, arguments.encoding))
        blocks = iter(source)
        first = next(blocks, None)
        blocks = chain([] if first is None else [first], blocks)
        filling = _filling(arguments)
        known = arguments.units or (filling.units if filling else None)
        units = TableUnits(source.names, known, first, where=called(path or "--sample"))
        given = options.settings(arguments.set, others=("inf",), units=units.system.name or None)
        if filling:
            given = {n: t for n, t in filling.values.items() if n not in source.names} | given
        points = given.get("M", "4" if "M" in source.names else "6") == "4"
        optional = ["M", *(UNUSED_BY_POINTS if points else ())]
        check_scene_columns(source.names, list(given), optional)
        if sweep:
            wanted = options.sweeps(sweep)  # the rest is the same in every row
            source.names = [name for name in source.names if name in wanted]
        elif units.strict:
            source.names = units.headings(source.names)
        headings = units.headings(arithmetic.columns)
        scene_too = bool(sweep) or not arguments.results_only
        writer = open_writer(arguments.output, result_format, source, headings, scene_too)
        write = stack.enter_context(writer).write
        complain = stack.enter_context(_complaints(arguments.errors))
        meter = stack.enter_context(progress(source.total, "solve", "B"))
        if not may_wait(arguments.output):
            write = stack.enter_context(behind(write))
        if not may_wait(path or ""):
            blocks = stack.enter_context(ahead(blocks))
        complaints = position = 0
        for rows in blocks:
            for name, text in given.items():
                rows.columns.pop(name, None)  # and with it the heading of another unit
                rows.columns[name] = [text] * rows.count
                rows.others.pop(name, None)
            # a name without a column has empty cells: a complaint where a row looks at them
            nothing = [None] * rows.count
            rows.columns |= {name: nothing for name in SCENE if name not in rows.columns}
            rows.columns["M"] = filled(rows.columns["M"], DEFAULT_M)
            results = arithmetic(rows, units.given(given))
            write(rows, units.shown(results))
            complaints = complain(rows.bad)
            now = source.position()
            meter.update(now - position)
            position = now
    return 1 if complaints or arithmetic.errors else 0


def _filling(arguments: argparse.Namespace) -> Entries | None:
    """What fills the columns that the table lacks."""
    if not arguments.scene:
        return None
    entries = entries_in(arguments.scene, arguments.units, single=True)
    options.note_remarks(entries)
    entries.values = {name: text for name, text in entries.values.items() if text}
    check_names(entries.values, SCENE, "value of a scene", called(arguments.scene))
    return entries


def _chosen(outputs: Sequence[str], known: Sequence[str], arithmetic: str) -> list[str]:
    chosen = options.names_given(
        outputs, known, "--outputs", f"result of --arithmetic {arithmetic}"
    )
    return chosen or list(known)


class _Float64:
    """The closed form in double precision."""

    errors = 0

    def __init__(self, outputs: Sequence[str]) -> None:
        self.columns = _chosen(outputs, tuple(RESULTS), "float64")

    def __call__(self, rows: Rows, units: TableUnits) -> Results:
        columns = numbers(rows, units)
        _read_shares(rows, columns)
        unread = {bad.row - rows.first for bad in rows.bad}
        refused = rows.count > 0 and examine(columns).refused is not None
        for refusal in refusals(columns) if refused else ():
            for index in np.flatnonzero(np.broadcast_to(refusal.where, rows.count)).tolist():
                if index not in unread:
                    unread.add(index)
                    value = float(np.broadcast_to(columns[refusal.column], rows.count)[index])
                    reason = f"{value!r} {refusal.reason}"
                    rows.bad.append(rows.cell(index, refusal.column, reason))
        results = solve(columns, self.columns)
        unusable = sorted(unread)
        for name, result in results.items():
            result[unusable] = Status.NOT_FINITE if name == "STATUS" else np.nan
        return results


def _read_shares(rows: Rows, columns: dict[str, NDArray[np.float64]]) -> None:
    """Read the cells of MU that are shares of the critical friction, and withdraw the complaints
    about them."""
    places = [bad.row - rows.first for bad in rows.bad if bad.column == "MU"]
    cells = {at: share_of(rows.columns["MU"][at]) for at in places}
    found = {at: share for at, share in cells.items() if share is not None}
    if found:
        at = list(found)
        shared = {n: np.broadcast_to(x, (rows.count,))[at] for n, x in columns.items()}
        columns["MU"] = columns["MU"].copy()
        columns["MU"][at] = share_typed(shared, list(found.values()))
        rows.bad[:] = [
            bad for bad in rows.bad if bad.column != "MU" or bad.row - rows.first not in found
        ]


class _Applesoft:
    """The listing's own arithmetic, `impact88.replay`."""

    KNOWN = tuple(name for name in RESULTS if RESULTS[name].line or name == "KF")

    def __init__(self, outputs: Sequence[str]) -> None:
        self.names = _chosen(outputs, self.KNOWN, "applesoft")
        self.columns = [*self.names, "ERROR", "LINE"]
        self.errors = 0

    def __call__(self, rows: Rows, units: TableUnits) -> Results:
        from ..replay import replay

        points = point_masses(rows)
        columns = {n: _texts(n, column, units) for n, column in rows.columns.items()}
        for name in UNUSED_BY_POINTS if points.any() else ():
            # the program reads them all the same
            default = "1" if name in INERTIAS else "0"
            for index in np.flatnonzero(points).tolist():
                if columns[name][index] in (None, "", "NAN"):
                    columns[name][index] = default
        for index, cell in enumerate(columns["MU"]):
            if share_of(cell) is not None:
                scene = {name: column[index] for name, column in columns.items() if name in SCENE}
                with suppress(UserError, ValueError, TypeError):  # the cell's complaint follows
                    columns["MU"][index] = resolved(scene, "")[0]
        unread = {bad.row - rows.first for bad in rows.bad}
        try:
            # nearly always all cells can be read, and looking at each takes as long as solving
            replayed = None if unread else replay(columns)
        except (ValueError, TypeError):  # UserError, or cells of several types
            replayed = None
        if replayed is None:
            _complain(rows, columns, unread)
            for column in columns.values():
                for index in unread:
                    column[index] = "6"
            replayed = replay(columns)
        error = np.where(replayed.zero_determinant, "ZERO DETERMINANT", replayed.error)
        results: Results = {name: replayed.floats(name) for name in self.names}
        results |= {"ERROR": error, "LINE": replayed.line}
        unusable = sorted(unread)
        for name, result in results.items():
            result[unusable] = {"ERROR": "", "LINE": 0}.get(name, np.nan)
        self.errors += int(np.count_nonzero(error != "")) - int(replayed.zero_determinant.sum())
        return results


def _texts(name: str, column: Any, units: TableUnits) -> list[Any]:
    """A column as texts that INPUT may read, those with a unit in base units."""
    if isinstance(column, np.ndarray):
        column = [repr(x).removesuffix(".0").upper() for x in column.tolist()]
    texts = [text.strip().upper() if isinstance(text, str) else text for text in column]
    if not units.converts(name):
        return texts
    for index, text in enumerate(column):
        if isinstance(text, str) and any(map(str.isdigit, text)):
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
            rows.bad.append(rows.cell(index, name, reason))


@contextmanager
def _complaints(path: str | None) -> Iterator[Callable[[Sequence[BadCell]], int]]:
    """A function that says of bad cells what is wrong, to a file or of the first to stderr, and
    returns how many there have been."""
    count = 0
    with replacing(path) if path else nullcontext() as file:
        rows = csv.writer(file, lineterminator="\n") if file else None
        if rows:
            rows.writerow(BadCell._fields)

        def take(cells: Sequence[BadCell]) -> int:
            nonlocal count
            for cell in sorted(cells):
                count += 1
                if rows:
                    rows.writerow(cell)
                elif count <= SHOWN:
                    note("solve", str(cell))
            return count

        yield take
    if (path and count) or count > SHOWN:
        where = f": see {path}" if path else "; --errors FILE lists all of them"
        unsolved = f"{count:,} row{'s' if count > 1 else ''} could not be solved"
        note("solve", f"{unsolved}{where}")
