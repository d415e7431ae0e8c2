"""Compare another implementation's results with ours, row by row, and explain the differences.

`agreement` grades each result by the scene's condition; `diagnosis` explains differences. Rows that
could not be compared are counted by reason.
"""

import os
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.doubles import double
from ...collision.mappings import texts
from ...errors import UserError, quoted
from ...files import display_name
from ...messages.arguments import explains_arguments
from ...messages.plaintable import plain
from ...messages.progress import progress
from ...names import DEFAULT_M, RESULTS, SCENE
from ...tables.cells import TableUnits, check_scene_columns, numbers
from ...tables.formats import FORMATS
from ...tables.rows import BadCell, Reader, Rows
from ...tables.table import format_of, open_reader
from . import agreement
from .agreement import ABSENT, DIFFER, ELIMINATION, LOST, ComparedRows
from .diagnosis import Diagnosis, TableCause, Unexplained
from .tablehypotheses import AGREES, UNKNOWN, TableHypothesis
from .vectors import FAILURE, FROZEN_ID

MAX_ROWS_KEPT = 20_000
"""Rows that disagree from which a search starts; with its causes the rest is judged as it is read,
so that the memory for large tables is bounded."""
MAX_AGREEING_KEPT = 4000  # rows that a cause must not contradict
MAX_ROWS_LISTED = 20  # of those that disagree most, and of those not compared for each reason
NOT_COMPARED = ("STATUS", "COND")  # result columns
POSITIVE = ("MA", "MB", "IA", "IB")  # a scene has no other
CARRIED = ("id", "class", "label", "expect", "flags", "comment")
"""Columns of test vectors that identify the row."""

NO_RESULT = "no result on either side: theirs refuses, and so does the mathematics"
NOTHING_HERE = "theirs gives numbers where the equations have no solution"
NO_SCENE = (
    "theirs gives numbers although a mass or a moment of inertia is not positive; "
    "a program leaves the cells empty"
)
NOTHING_THERE = "theirs gives nothing where there is a result"
REFUSED = "theirs refuses a vector of the class failure, as it may"
UNREADABLE = "the row could not be read"
NO_DIGIT = "a number shares no digit with ours, where rounding or the digits written leave none"
REASONS = (UNREADABLE, NO_RESULT, NO_SCENE, NOTHING_HERE, REFUSED, NO_DIGIT, NOTHING_THERE)
HARMLESS = (NO_RESULT, REFUSED)
"""Reasons that are no fault of the program."""


class Row(NamedTuple):
    """A row that disagrees.

    Parameters
    ----------
    row, line : int
        Its number among the rows, from 1, and its line in the file, 0 without one.
    id : str
        Its entry in a column ``id``, or "".
    result, theirs, ours : str, str, float
        The result that disagrees most, the other program's text and this one's number.
    relative : float
        Their difference relative to the scene's largest velocity, spin or energy.
    cause : str
        The likely cause.
    """

    row: int
    line: int
    id: str
    result: str
    theirs: str
    ours: float
    relative: float
    cause: str


@dataclass
class Tally:
    """Counts of rows for one result.

    Parameters
    ----------
    compared : int
        Rows compared.
    double, digits, elimination : int
        Rows that agree to double precision, to all digits written, and as closely as elimination
        can.
    differ : int
        Rows that disagree.
    missing : int
        Rows without the result in the other program's table.
    largest : float
        The largest relative difference.
    """

    compared: int = 0
    double: int = 0
    digits: int = 0
    elimination: int = 0
    differ: int = 0
    missing: int = 0
    largest: float = 0.0

    def add(self, grades: NDArray[np.intp], relative: NDArray[np.float64]) -> None:
        """Count a block's rows.

        Parameters
        ----------
        grades : ndarray of int
            Grade of agreement of each row.
        relative : ndarray of float
            Relative difference of each row.
        """
        counts = np.bincount(grades, minlength=LOST + 1).tolist()
        absent, double, digits, elimination, differ, lost = counts
        self.compared += grades.size - absent - lost
        self.double += double
        self.digits += digits
        self.elimination += elimination
        self.differ += differ
        is_judged = (grades > ABSENT) & (grades < LOST)
        self.largest = float(relative.max(initial=self.largest, where=is_judged))


@dataclass
class Elimination:
    """Rows that agree only as closely as elimination can.

    Parameters
    ----------
    rows : int
        Their number.
    worst_row : int
        The row with the largest difference.
    worst_relative, worst_condition : float
        Its relative difference and condition number.
    """

    rows: int = 0
    worst_row: int = 0
    worst_relative: float = 0.0
    worst_condition: float = 0.0


@dataclass
class Skipped:
    """Rows not compared for one reason.

    Parameters
    ----------
    rows : int
        Their number.
    first : list of int
        The first of them.
    labels : list of str
        The labels of all of them, in a table of test vectors.
    """

    rows: int = 0
    first: list[int] = field(default_factory=list)
    labels: list[str] = field(default_factory=list)


@dataclass
class Comparison:
    """The result of `compare`.

    Parameters
    ----------
    rows, agreeing, differing : int
        Rows of the table, those whose results all agree, and those with one that does not.
    tallies : dict of str to Tally
        How many rows agree, by result.
    causes : Counter of str
        Rows that each likely cause explains.
    differences : list of Row
        Every row that disagrees, with its worst result and its likely cause.
    not_compared : dict of str to Skipped
        Rows that were not compared, by reason.
    elimination : Elimination
        Rows that agree only as closely as elimination can.
    evidence : list of TableCause
        The rows that support each cause, its score, and what else would give the same.
    programs : list of TableHypothesis
        Of the causes that are programs, those that give the results of scenes.
    skipped : list of str
        What was not looked for.
    equations : dict of str to tuple of int
        By equation, the rows in which it was checked and those that violate it.
    unexplained : dict of str to Unexplained
        Rows without a cause, by kind of scene.
    bad : list of BadCell
        Cells that could not be read.
    unknown : dict of str to str
        Columns that were not recognised, and the name that was probably meant, or "".
    place : dict of str to object
        Of a workbook, the sheet and the row of the headings.
    remarks : list of str
        How the headings were understood.

    Examples
    --------
    >>> scene = impact88.sample(1).numbers()
    >>> comparison = impact88.compare([{**scene, "LOSS": 57.0}], causes=False)
    >>> comparison.differing, comparison.worst[0].result
    (1, 'LOSS')
    """

    rows: int = 0
    agreeing: int = 0
    differing: int = 0
    tallies: dict[str, Tally] = field(default_factory=dict)
    causes: Counter[str] = field(default_factory=Counter)
    differences: list[Row] = field(default_factory=list)
    not_compared: dict[str, Skipped] = field(default_factory=dict)
    elimination: Elimination = field(default_factory=Elimination)
    evidence: list[TableCause] = field(default_factory=list)
    programs: list[TableHypothesis] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)
    equations: dict[str, tuple[int, int]] = field(default_factory=dict)
    unexplained: dict[str, Unexplained] = field(default_factory=dict)
    bad: list[BadCell] = field(default_factory=list)
    unknown: dict[str, str] = field(default_factory=dict)
    place: dict[str, Any] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)

    @property
    def worst(self) -> list[Row]:
        """The rows that disagree most, the worst first."""
        return sorted(self.differences, key=lambda row: -row.relative)[:MAX_ROWS_LISTED]

    @property
    def silent(self) -> list[str]:
        """Messages about columns, rows and cells that were not compared."""
        messages = [f"column {name} not recognised" for name in self.unknown]
        for reason, skipped_rows in self.not_compared.items():
            if reason not in HARMLESS:
                messages.append(f"{skipped_rows.rows} rows not compared: {reason}")
        for name, tally in self.tallies.items():
            if tally.missing:
                messages.append(
                    f"{tally.missing} cells of {name} are empty where there is a result"
                )
        return messages

    @property
    def summary(self) -> str:
        """The counts and the commonest cause, in one line."""
        rows = f"{self.rows} row{'s' if self.rows != 1 else ''}"
        line = f"{rows}: {self.agreeing} agree, {self.differing} disagree"
        refused_rows = sum(
            self.not_compared[name].rows for name in HARMLESS if name in self.not_compared
        )
        if refused_rows:
            line += f", {refused_rows} refused"
        if skipped_rows := sum(group.rows for group in self.not_compared.values()) - refused_rows:
            line += f", {skipped_rows} not compared"
        for cause, count in self.causes.most_common(1):
            is_cause = not cause.startswith(AGREES)
            line += f"; likely cause of {count}: {cause}" if is_cause else f"; {count}: {cause}"
        return line

    def write_junit(self, path: str, name: str, strict: bool) -> None:
        """Write the comparison as a JUnit report.

        A failing test for every row that disagrees, one test for those that agree, one for each
        reason why rows were not compared.

        Parameters
        ----------
        path, name : str
            The file to be written, and the table's name.
        strict : bool
            Rows, cells and columns that were not compared fail.
        """
        from .junit import Test, write  # XML takes 4 ms to import

        tests = [Test(f"{self.agreeing} of {self.rows} rows agree")]
        for row in self.differences:
            place = f"row {row.row}" + (f", id {row.id}" if row.id else "")
            says = f"{row.result} {row.theirs}, here {row.ours:.12g}, off by {row.relative:.2g}"
            tests.append(Test(place, "failure", f"{says}; {row.cause}"))
        tests += [Test(f"row {bad.row}", "error", str(bad)) for bad in self.bad]
        tests += [Test(says, "failure" if strict else "skipped", says) for says in self.silent]
        for reason in HARMLESS:
            if skipped_rows := self.not_compared.get(reason):
                tests.append(Test(f"{skipped_rows.rows} rows: {reason}", "skipped", reason))
        write(path, f"impact88 compare {name}", tests)

    def as_json(self) -> dict[str, Any]:
        """Return the object that ``impact88 compare --json`` prints.

        Returns
        -------
        dict of str to object
            The comparison as JSON types, in the form of ``impact88 schema compare``.
        """
        equations = {
            number: {"checked": checked, "violated": violated}
            for number, (checked, violated) in self.equations.items()
        }
        differences = [
            {"row": row.row, "id": row.id, "cause": row.cause} for row in self.differences
        ]
        fields: dict[str, Any] = {
            "summary": self.summary,
            "rows": self.rows,
            "agreeing": self.agreeing,
            "differing": self.differing,
            "results": {name: vars(tally) for name, tally in self.tallies.items()},
            "causes": dict(self.causes.most_common()),
            "evidence": [cause._asdict() for cause in self.evidence],
            "not_looked_for": self.skipped,
            "equations": equations,
            "unexplained": {name: kind._asdict() for name, kind in self.unexplained.items()},
            "worst": [row._asdict() for row in self.worst],
            "differences": differences,
            "elimination": vars(self.elimination),
            "not_compared": {
                name: vars(skipped_rows) for name, skipped_rows in self.not_compared.items()
            },
            "unknown_columns": self.unknown,
            "bad_rows": list(map(str, self.bad)),
            "table": self.place,
            "remarks": self.remarks,
        }
        return {name: plain(value) for name, value in fields.items()}


@explains_arguments
def compare(
    table: Any,
    format: str | None = None,
    values: Mapping[str, str] | None = None,
    rtol: float | None = None,
    encoding: str | None = None,
    units: str | None = None,
    causes: bool = True,
) -> Comparison:
    """Compare a table of scenes and results, block by block.

    Parameters
    ----------
    table : str, path or frame
        The table's file, or a DataFrame of pandas or polars, a pyarrow Table, a structured array, a
        list of dicts or a dict of columns.
    format : str, optional
        The file's format, where its name does not say: as ``--from`` of `impact88 solve`.
    values : mapping of str to str, optional
        Values, for all rows, of columns that the table lacks.
    rtol : float, optional
        Relative tolerance, as a fraction of the scene's largest velocity, spin or energy. By
        default, the error bound of rounding in each scene.
    encoding : str, optional
        Encoding of a CSV or JSON Lines file that is not UTF-8.
    units : {"us", "chapter", "metric", "si"}, optional
        System of units of columns whose heading names no unit.
    causes : bool, default True
        Look for causes where rows disagree.

    Returns
    -------
    Comparison
        How many rows agree, and for those that do not the likely causes.

    Raises
    ------
    UserError
        When the table has no result column or does not give a whole scene.

    Examples
    --------
    >>> scene = impact88.sample(1).numbers()
    >>> row = {**scene, "LOSS": float(impact88.solve(scene, ["LOSS"])["LOSS"])}
    >>> impact88.compare([row]).summary
    '1 row: 1 agree, 0 disagree'
    """
    if values is not None and not isinstance(values, Mapping):
        raise UserError(f"values is {quoted(values)}; expected a mapping of names to values")
    values = texts(values or {})
    if format is not None and format not in FORMATS:
        raise UserError(f"format is {quoted(format)}; expected one of {' '.join(FORMATS)}")
    if rtol is not None and not (isinstance(rtol, int | float) and 0 <= rtol < 1):
        raise UserError(f"rtol is {quoted(rtol)}; expected a share such as 1e-9")
    for name, text in (("encoding", encoding), ("units", units)):
        if text is not None and not isinstance(text, str):
            raise UserError(f"{name} is {quoted(text)}; expected a text")
    comparison = Comparison()
    search = _Search(comparison) if causes else None
    with open_table(table, format, encoding) as (reader, where):
        comparison.place, comparison.remarks = reader.place, reader.remarks
        results, unknown = result_columns(reader)
        comparison.unknown = unknown
        if not results:
            hints = [f"{name} for {column}" for name, column in unknown.items() if column]
            hint = f" ({', '.join(hints)}?)" if hints else ""
            says = f"no column of results{hint}; expected some of {' '.join(RESULTS)}, beside the "
            raise UserError(f"{says}scene's", where)
        advice = "--set NAME=VALUE"
        if "id" in reader.names:
            advice = f"where ids stand for the scenes of a kit, add --kit {FROZEN_ID}; {advice}"
        check_scene_columns({*reader.names, *values}, advice=advice, where=where)
        comparison.tallies = {name: Tally() for name in results}
        for rows, table_units in read_blocks(reader, results, where, units):
            scene = _scene_of(rows, values, table_units)
            block = compare_block(rows, scene, results, table_units, rtol)
            agreeing = block.agreeing[: max(0, MAX_AGREEING_KEPT - comparison.agreeing)]
            _count(block, comparison)
            if search is not None:
                kept = np.sort(np.concatenate([block.differing, agreeing]))
                search.add(block.case.select_rows(kept))
    if not any(tally.compared for tally in comparison.tallies.values()):
        raise UserError("no result could be compared", where)
    if search is not None and comparison.differing:
        search.finish()
        comparison.causes.update(row.cause for row in comparison.differences)
    return comparison


class _Search:
    """The causes of a table's differences, sought in the first rows that disagree."""

    def __init__(self, comparison: Comparison) -> None:
        self._comparison = comparison
        self._kept: list[ComparedRows] = []
        self._diagnosis: Diagnosis | None = None
        self._causes: list[str] = []

    def add(self, case: ComparedRows) -> None:
        """Keep a block's rows, or judge them if the causes are known."""
        if self._diagnosis is not None:
            self._assign(self._diagnosis, case)
            return
        self._kept.append(case)
        if self._comparison.differing >= MAX_ROWS_KEPT:
            self._diagnose()

    def finish(self) -> None:
        """Add the causes to the comparison."""
        diagnosis = self._diagnosis or self._diagnose()
        comparison = self._comparison
        comparison.equations = diagnosis.equations
        comparison.unexplained = diagnosis.unexplained
        comparison.evidence = diagnosis.evidence
        comparison.programs = [x for x in diagnosis.hypotheses if x.program is not None]
        comparison.skipped = diagnosis.skipped
        comparison.differences = [
            row._replace(cause=cause)
            for row, cause in zip(comparison.differences, self._causes, strict=True)
        ]

    def _diagnose(self) -> Diagnosis:
        self._diagnosis = Diagnosis(agreement.concatenate_cases(self._kept))
        for case in self._kept:
            self._assign(self._diagnosis, case)
        self._kept = []
        return self._diagnosis

    def _assign(self, diagnosis: Diagnosis, case: ComparedRows) -> None:
        self._causes += filter(None, diagnosis.assign(case))


@contextmanager
def open_table(
    table: Any, format: str | None, encoding: str | None
) -> Iterator[tuple[Reader, str]]:
    """Open a table's file or a data frame; yields the reader, and the table's name in messages.
    Raises UserError."""
    if isinstance(table, str | os.PathLike):
        path = os.fspath(table)
        with open_reader(path, format_of(path, format), encoding, True) as reader:
            yield reader, display_name(path)
        return
    from ...tables.frames import read_frame

    if format is not None or encoding is not None:
        raise UserError("format and encoding are a file's; a frame has its own")
    with read_frame(table) as reader:
        yield reader, ""


def _result_meant(name: str) -> str:
    """Return the result or scene column that a name probably stands for, "" if none: the same in
    upper case, before the first character that is no letter, or nearly the same."""
    columns = (*RESULTS, *SCENE)
    upper = name.strip().upper()
    for text in (upper, re.split(r"[^A-Z]", upper)[0]):
        if text in columns:
            return text
    from difflib import get_close_matches  # rarely needed

    return next(iter(get_close_matches(upper, columns, 1, 0.75)), "")


class Block(NamedTuple):
    """Some rows of a table, compared: grades and relative differences are (results, rows)."""

    rows: Rows
    scene: Mapping[str, NDArray[np.float64]]
    case: ComparedRows
    grades: NDArray[np.intp]
    relative: NDArray[np.float64]

    @property
    def differing(self) -> NDArray[np.intp]:
        """The rows with a result that disagrees."""
        return np.flatnonzero((self.grades == DIFFER).any(0))

    @property
    def agreeing(self) -> NDArray[np.intp]:
        """The rows that could be compared, and agree."""
        is_judged = ((self.grades > ABSENT) & (self.grades < LOST)).any(0)
        return np.flatnonzero(is_judged & ~np.isin(self.grades, (DIFFER, LOST)).any(0))


def result_columns(reader: Reader) -> tuple[list[str], dict[str, str]]:
    """Return a table's columns of results that are compared, and those that are not recognised,
    with the name that was probably meant, or ""."""
    results = [str(n) for n in reader.names if n in RESULTS and n not in NOT_COMPARED]
    known = {*SCENE, *RESULTS, *CARRIED}
    return results, {str(n): _result_meant(str(n)) for n in reader.names if n not in known}


def read_blocks(
    reader: Reader, results: Sequence[str], where: str, units: str | None = None
) -> Iterator[tuple[Rows, TableUnits]]:
    """Yield a table's rows, some at a time, with the units of its columns; shows the progress."""
    table_units: TableUnits | None = None
    before = 0
    with progress(reader.total, "compare") as meter:
        for rows in reader:
            table_units = table_units or TableUnits(reader.names, units, rows, results, where)
            yield rows, table_units
            meter.update(rows.place - before)
            before = rows.place


@np.errstate(all="ignore")
def compare_block(
    rows: Rows,
    scene: Mapping[str, NDArray[np.float64]],
    results: Sequence[str],
    units: TableUnits,
    rtol: float | None = None,
) -> Block:
    """Compare rows of a table with our results for scenes (columns of n). Of a row with a cell that
    could not be read, no result is compared."""
    theirs = {name: agreement.read_theirs(rows, name, units) for name in results}
    unreadable = [index for index, *_ in rows.bad]
    for column, _ in theirs.values():
        column[unreadable] = np.nan
    case = agreement.make_case(scene, theirs, rtol, rows.first)
    return Block(rows, scene, case, *case.grade())


def _scene_of(
    rows: Rows, values: Mapping[str, str], units: TableUnits
) -> dict[str, NDArray[np.float64]]:
    """Return the scenes of rows: their own columns, and values for all rows of those they lack."""
    constants = {"M": DEFAULT_M, **values}
    scene = {
        name: np.full(rows.count, double(text)) for name, text in constants.items() if name in SCENE
    }
    return scene | numbers(rows, units)


def _count(block: Block, comparison: Comparison) -> None:
    """Count a block's rows for the comparison."""
    rows, case, grades = block.rows, block.case, block.grades
    comparison.rows += rows.count
    comparison.bad += rows.complaints()
    comparison.agreeing += block.agreeing.size
    comparison.differing += block.differing.size
    is_solved = (grades > ABSENT).any(0) & np.isfinite(case.ours)
    for place, tally in enumerate(comparison.tallies.values()):
        tally.add(grades[place], block.relative[place])
        tally.missing += int((is_solved[place] & (grades[place] == ABSENT)).sum())
    _count_not_compared(block, comparison)
    _count_elimination(block, comparison.elimination)
    comparison.differences += _rows_of(block)


def _count_not_compared(block: Block, comparison: Comparison) -> None:
    """Count a block's rows that were not compared, by reason."""
    rows, case, grades = block.rows, block.case, block.grades
    unreadable = np.zeros(rows.count, bool)
    unreadable[[index for index, *_ in rows.bad]] = True
    skipped_rows = np.ones(rows.count, bool)
    skipped_rows[np.concatenate([block.differing, block.agreeing])] = False
    if not skipped_rows.any():
        return
    solvable, has_answer = np.isfinite(case.ours).any(0), np.isfinite(case.values).any(0)
    kinds = rows.columns.get("class", [""] * rows.count)
    refused_rows = solvable & ~has_answer & np.array([str(kind) == FAILURE for kind in kinds], bool)
    positive = np.all([block.scene[name] > 0 for name in POSITIVE], 0)
    lost = (grades == LOST).any(0)
    conditions = (
        unreadable,
        ~solvable & ~has_answer,
        ~solvable & ~positive,
        ~solvable,
        refused_rows,
    )
    reasons = np.select((*conditions, lost), REASONS[:-1], REASONS[-1])
    labels = rows.columns.get("label")
    for reason in REASONS:
        places = np.flatnonzero(skipped_rows & (reasons == reason))
        if places.size:
            group = comparison.not_compared.setdefault(reason, Skipped())
            group.rows += places.size
            group.first = (group.first + (rows.first + places).tolist())[:MAX_ROWS_LISTED]
            if labels is not None:
                row_labels = dict.fromkeys(str(labels[place]) for place in places.tolist())
                group.labels += [label for label in row_labels if label not in group.labels]


def _count_elimination(block: Block, elimination: Elimination) -> None:
    """Count a block's rows that agree as closely as elimination can."""
    grades = block.grades
    cells = (grades == ELIMINATION) & ~(grades == DIFFER).any(0)
    largest_by_row = np.where(cells, block.relative, 0.0).max(0)
    elimination.rows += int(cells.any(0).sum())
    if (largest := float(largest_by_row.max(initial=0.0))) > elimination.worst_relative:
        worst = int(largest_by_row.argmax())
        elimination.worst_row, elimination.worst_relative = block.rows.first + worst, largest
        elimination.worst_condition = float(block.case.condition[worst])


def _rows_of(block: Block) -> Iterator[Row]:
    """Yield the rows of a block that disagree, without a cause yet."""
    rows, case, places = block.rows, block.case, block.differing
    worst = np.where(block.grades == DIFFER, block.relative, -1.0).argmax(0)[places]
    ids = rows.one_per_row("id") if "id" in rows.columns else None
    columns_written = [rows.one_per_row(name) for name in case.names]
    ours, relative = case.ours[worst, places].tolist(), block.relative[worst, places].tolist()
    for place, (index, result) in enumerate(zip(places.tolist(), worst.tolist(), strict=True)):
        yield Row(
            row=rows.first + index,
            line=rows.lines[index] if rows.lines else 0,
            id=str(ids[index]) if ids is not None else "",
            result=case.names[result],
            theirs=str(columns_written[result][index]),
            ours=ours[place],
            relative=relative[place],
            cause=UNKNOWN,
        )
