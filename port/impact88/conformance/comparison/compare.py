"""Compare another implementation's results with ours, row by row, and explain the differences.

`agreement` grades each result by the scene's condition; `diagnosis` explains differences. Rows that
could not be compared are counted by reason. Of a kit, `answers` finds each row's vector: its scene
is then compared, every result is due, and so is every vector.
"""

import os
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.doubles import double
from ...collision.mappings import texts
from ...errors import UserError, one_line, quoted
from ...files import display_name
from ...messages.arguments import explains_arguments
from ...messages.plaintable import plain
from ...messages.progress import progress
from ...names import DEFAULT_M, FINAL_VELOCITIES, RESULTS, SCENE
from ...tables.cells import TableUnits, check_scene_columns, numbers
from ...tables.formats import FORMATS
from ...tables.rows import BadCell, Reader, Rows
from ...tables.table import format_of, open_reader
from . import agreement, reasons
from .agreement import ABSENT, DIFFER, ELIMINATION, LOST, ComparedRows, Question
from .diagnosis import Diagnosis, TableCause, Unexplained
from .tablehypotheses import AGREES, UNKNOWN, TableHypothesis
from .vectors import FAILURE, FROZEN_ID

TYPE_CHECKING = False
if TYPE_CHECKING:
    from .answers import KitAnswers

MAX_ROWS_KEPT = 20_000
"""Rows that disagree from which a search starts; with its causes the rest is judged as it is read,
so that the memory for large tables is bounded."""
MAX_AGREEING_KEPT = 4000  # rows that a cause must not contradict
MAX_NAMED = 5  # rows and labels in one sentence
MAX_ROWS_LISTED = 20  # of those that disagree most, and of those not compared for each reason
NOT_COMPARED = ("STATUS", "COND")  # result columns
POSITIVE = ("MA", "MB", "IA", "IB")  # a scene has no other
CARRIED = ("id", "class", "label", "expect", "flags", "comment")
"""Columns of test vectors that identify the row."""


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

    def __str__(self) -> str:
        theirs = one_line(self.theirs, 40)
        size = f"relative difference {self.relative:.2g}"
        return f"{self.result} {theirs}, expected {self.ours:.12g}, {size}"


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
    kit : KitAnswers or None
        The verdict on each vector, where the table was judged as answers to a kit.

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
    kit: "KitAnswers | None" = None

    @property
    def worst(self) -> list[Row]:
        """The rows that disagree most, the worst first."""
        return sorted(self.differences, key=lambda row: -row.relative)[:MAX_ROWS_LISTED]

    @property
    def silent(self) -> list[str]:
        """Messages about columns, rows and cells that were not compared."""
        messages = []
        for name, meant in list(self.unknown.items())[:MAX_ROWS_LISTED]:
            hint = f"; did you mean {meant}? (a unit stands in brackets: {meant} [mph])"
            messages.append(f"column {name} is not recognised{hint * bool(meant)}")
        if len(self.unknown) > MAX_ROWS_LISTED:
            count = len(self.unknown) - MAX_ROWS_LISTED
            messages.append(f"and {count} more columns are not recognised")
        for reason, group in self.not_compared.items():
            if reason not in reasons.HARMLESS:
                messages.append(describe(reason, group, lists_rows=True))
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
        counts = {reason: group.rows for reason, group in self.not_compared.items()}
        missing = counts.pop(reasons.MISSING, 0)
        refused = sum(counts.pop(reason, 0) for reason in reasons.HARMLESS)
        others = {"refused": refused, "missing": missing, "not compared": sum(counts.values())}
        line += "".join(f", {count} {word}" for word, count in others.items() if count)
        for cause, count in self.causes.most_common(1):
            is_cause = not cause.startswith(AGREES)
            line += f"; likely cause of {count}: {cause}" if is_cause else f"; {count}: {cause}"
        return line

    def passes(self, strict: bool = False) -> bool:
        """Return True if nothing disagrees, every row was read and every vector of a kit passes.

        Parameters
        ----------
        strict : bool, default False
            Rows, cells and columns that were not compared fail.

        Returns
        -------
        bool
            False where something fails.
        """
        if self.kit is not None:
            return self.kit.conforms
        return not (self.differing or self.bad or (strict and self.silent))

    def write_junit(self, path: str, name: str, strict: bool) -> None:
        """Write the comparison as a JUnit report.

        A failing test for every row that disagrees, one test for those that agree, one for each
        reason why rows were not compared. Of a kit, a test for every vector, with its class.

        Parameters
        ----------
        path, name : str
            The file to be written, and the table's name.
        strict : bool
            Rows, cells and columns that were not compared fail.
        """
        from .junit import Test, write  # XML takes 4 ms to import

        if self.kit is not None:
            properties = {f"kit.{key}": str(value) for key, value in self.kit.identity.items()}
            write(path, f"impact88 compare --kit, {name}", self.kit.tests(), **properties)
            return
        tests = [Test(f"{self.agreeing} of {self.rows} rows agree")]
        for row in self.differences:
            place = f"row {row.row}" + (f", id {row.id}" if row.id else "")
            tests.append(Test(place, "failure", f"{row}; {row.cause}"))
        tests += [Test(f"row {bad.row}", "error", str(bad)) for bad in self.bad]
        tests += [Test(says, "failure" if strict else "skipped", says) for says in self.silent]
        for reason in reasons.HARMLESS:
            if group := self.not_compared.get(reason):
                tests.append(Test(describe(reason, group), "skipped", reason))
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
        if self.kit is not None:
            fields["kit"] = self.kit.as_json()
        return {name: plain(value) for name, value in fields.items()}


def describe(reason: str, group: Skipped, lists_rows: bool = False) -> str:
    """Return how many rows were refused, are missing or were not compared, and why."""
    word = "refused" if reason in reasons.HARMLESS else "not compared"
    word = "missing" if reason == reasons.MISSING else word
    first = ", ".join(map(str, group.first[:MAX_NAMED])) + ", ..." * (group.rows > MAX_NAMED)
    rows = f" ({first})" if lists_rows and group.first else ""
    labels = ", ".join(filter(None, group.labels[:MAX_NAMED]))
    labels += f" and {len(group.labels) - MAX_NAMED} more" * (len(group.labels) > MAX_NAMED)
    ending = f" (labels: {labels})" if labels else ""
    return f"{group.rows} row{'s' * (group.rows != 1)} {word}{rows}: {reason}{ending}"


@explains_arguments
def compare(
    table: Any,
    format: str | None = None,
    values: Mapping[str, str] | None = None,
    rtol: float | None = None,
    encoding: str | None = None,
    units: str | None = None,
    causes: bool = True,
    kit: str | None = None,
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
    kit : str, optional
        A kit of test vectors that the table answers, by their ids: its folder, its archive (.zip),
        or the id of the frozen set. The scenes are the kit's, and every vector must be answered.

    Returns
    -------
    Comparison
        How many rows agree, and for those that do not the likely causes.

    Raises
    ------
    UserError
        When the table has no result column or does not give a whole scene; with a kit, when that
        cannot be read, or the table lacks ids or a final velocity.

    Examples
    --------
    >>> scene = impact88.sample(1).numbers()
    >>> row = {**scene, "LOSS": float(impact88.solve(scene, ["LOSS"])["LOSS"])}
    >>> impact88.compare([row]).summary
    '1 row: 1 agree, 0 disagree'
    """
    # eight arguments, and not split: the options of `impact88 compare`, each used once
    if values is not None and not isinstance(values, Mapping):
        raise UserError(f"values is {quoted(values)}; expected a mapping of names to values")
    if kit is not None and (values or units or rtol is not None):
        says = "a kit has scenes, units and tolerances of its own"
        raise UserError(f"{says}; expected no --set, --units or --rtol with it")
    values = texts(values or {})
    if format is not None and format not in FORMATS:
        raise UserError(f"format is {quoted(format)}; expected one of {' '.join(FORMATS)}")
    if rtol is not None and not (isinstance(rtol, int | float) and 0 <= rtol < 1):
        raise UserError(f"rtol is {quoted(rtol)}; expected a share such as 1e-9")
    for name, text in (("encoding", encoding), ("units", units), ("kit", kit)):
        if text is not None and not isinstance(text, str):
            raise UserError(f"{name} is {quoted(text)}; expected a text")
    comparison = Comparison()
    answers = comparison.kit = None if kit is None else _read_answers(kit)
    search = _Search(comparison) if causes else None
    with _open_table(table, format, encoding, answers) as (reader, where):
        comparison.place, comparison.remarks = reader.place, reader.remarks
        results, unknown = _result_columns(reader)
        comparison.unknown = unknown
        if answers is not None:
            if missing := [name for name in ("id", *FINAL_VELOCITIES) if name not in reader.names]:
                wanted = f"the kit's id and all of {' '.join(FINAL_VELOCITIES)}"
                raise UserError(f"no column {' '.join(missing)}; expected {wanted}", where)
        elif not results:
            hints = [f"{name} for {column}" for name, column in unknown.items() if column]
            hint = f" ({', '.join(hints)}?)" if hints else ""
            says = f"no column of results{hint}; expected some of {' '.join(RESULTS)}, beside the "
            raise UserError(f"{says}scene's", where)
        else:
            advice = "--set NAME=VALUE"
            if "id" in reader.names:
                advice = f"where ids stand for the scenes of a kit, add --kit {FROZEN_ID}; {advice}"
            check_scene_columns({*reader.names, *values}, advice=advice, where=where)
        comparison.tallies = {name: Tally() for name in results}
        for rows, table_units in _read_blocks(reader, results, where, units):
            if answers is not None:
                question = answers.find(rows, table_units)
            else:
                scene = _scene_of(rows, values, table_units)
                question = Question(scene, rows.columns.get("class"), rows.columns.get("label"))
            block = _compare_block(rows, question, results, table_units, rtol)
            agreeing = block.agreeing[: max(0, MAX_AGREEING_KEPT - comparison.agreeing)]
            _count(block, comparison)
            if answers is not None:
                answers.add(rows, block.codes, _details(block))
            if search is not None:
                kept = np.sort(np.concatenate([block.differing, agreeing]))
                search.add(block.case.select_rows(kept))
    if answers is not None:
        labels = [verdict.vector.label for verdict in answers.verdicts if not verdict.row]
        _skip(comparison, reasons.MISSING, [0] * len(labels), labels)
    elif not any(tally.compared for tally in comparison.tallies.values()):
        raise UserError("no result could be compared", where)
    if search is not None and comparison.differing:
        search.finish()
        comparison.causes.update(row.cause for row in comparison.differences)
    return comparison


def _read_answers(kit: str) -> "KitAnswers":
    """Return the verdicts on a kit's vectors, of which none is answered yet."""
    from .answers import KitAnswers  # archives take 10 ms to import
    from .kit import read_kit

    return KitAnswers(read_kit(kit))


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
def _open_table(
    table: Any, format: str | None, encoding: str | None, answers: "KitAnswers | None"
) -> Iterator[tuple[Reader, str]]:
    """Open a table's file or a data frame; yields the reader, and the table's name in messages.
    Raises UserError."""
    if isinstance(table, str | os.PathLike):
        path = os.fspath(table)
        hashed = nullcontext(path) if answers is None else answers.hash_table(path)
        with hashed as copy, open_reader(copy, format_of(path, format), encoding, True) as reader:
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
    """Some rows of a table, compared: grades and relative differences are (results, rows);
    ``codes``: the place in `REASONS` of what is said of each row, 0 where it agrees."""

    rows: Rows
    question: Question
    case: ComparedRows
    grades: NDArray[np.intp]
    relative: NDArray[np.float64]
    codes: NDArray[np.intp]

    @property
    def differing(self) -> NDArray[np.intp]:
        """The rows with a result that disagrees."""
        return np.flatnonzero(self.codes == reasons.REASONS.index(reasons.DISAGREES))

    @property
    def agreeing(self) -> NDArray[np.intp]:
        """The rows that could be compared, and agree."""
        return np.flatnonzero(self.codes == 0)


def _result_columns(reader: Reader) -> tuple[list[str], dict[str, str]]:
    """Return a table's columns of results that are compared, and those that are not recognised,
    with the name that was probably meant, or ""."""
    results = [str(n) for n in reader.names if n in RESULTS and n not in NOT_COMPARED]
    known = {*SCENE, *RESULTS, *CARRIED}
    return results, {str(n): _result_meant(str(n)) for n in reader.names if n not in known}


def _read_blocks(
    reader: Reader, results: Sequence[str], where: str, units: str | None
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
def _compare_block(
    rows: Rows,
    question: Question,
    results: Sequence[str],
    units: TableUnits,
    rtol: float | None,
) -> Block:
    """Compare rows of a table with our results. Of a row with a cell that could not be read, or
    that does not answer its vector, no result is compared."""
    theirs = {name: agreement.read_theirs(rows, name, units) for name in results}
    refusals = np.zeros(rows.count, int) if question.refusals is None else question.refusals
    refusals[[index for index, *_ in rows.bad]] = reasons.REASONS.index(reasons.UNREADABLE)
    for column, _ in theirs.values():
        column[refusals > 0] = np.nan
    case = agreement.make_case(question.scene, theirs, rtol, rows.first)
    grades, relative = case.grade()
    codes = np.where(refusals > 0, refusals, _reasons(question, case, grades))
    return Block(rows, question, case, grades, relative, codes)


def _reasons(question: Question, case: ComparedRows, grades: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return what is said of each row, as a place in `REASONS`."""
    given, due = np.isfinite(case.values), np.isfinite(case.ours)
    has_answer, is_solvable, is_lost = given.any(0), due.any(0), (grades == LOST).any(0)
    may_refuse = is_partial = np.zeros(has_answer.size, bool)
    if question.classes is not None:
        may_refuse = np.array([str(kind) == FAILURE for kind in question.classes], bool)
    is_excess = ~is_solvable & has_answer
    if question.refusals is not None:
        # of a kit every result is due, and no number where there is none, an infinite one included
        is_excess |= (~np.isnan(case.values) & ~due).any(0)
        is_partial = np.asarray((due & ~given).any(0) & has_answer)
    is_positive = np.all([question.scene[name] > 0 for name in POSITIVE], 0)
    # the first that holds is said
    rows_by_reason = {
        reasons.DISAGREES: (grades == DIFFER).any(0),
        reasons.NO_SCENE: is_excess & ~is_positive,
        reasons.NOTHING_HERE: is_excess,
        reasons.PARTIAL: is_partial,
        reasons.AGREEMENT: ((grades > ABSENT) & (grades < LOST)).any(0) & ~is_lost,
        reasons.NO_RESULT: ~is_solvable,
        reasons.REFUSED: ~has_answer & may_refuse,
        reasons.NO_DIGIT: is_lost,
        reasons.NOTHING_THERE: np.ones_like(may_refuse),
    }
    places = [reasons.REASONS.index(reason) for reason in rows_by_reason]
    return np.select(list(rows_by_reason.values()), places)


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
    for code in np.unique(block.codes).tolist():
        reason = reasons.REASONS[code]
        if reason not in (reasons.AGREEMENT, reasons.DISAGREES):
            places = np.flatnonzero(block.codes == code).tolist()
            labels = block.question.labels
            row_labels = [] if labels is None else [str(labels[place]) for place in places]
            _skip(comparison, reason, [rows.first + place for place in places], row_labels)
    _count_elimination(block, comparison.elimination)
    comparison.differences += _rows_of(block)


def _skip(comparison: Comparison, reason: str, rows: Sequence[int], labels: Sequence[str]) -> None:
    """Count rows that were not compared; of one that the table lacks the number is 0."""
    if rows:
        group = comparison.not_compared.setdefault(reason, Skipped())
        group.rows += len(rows)
        group.first = [*group.first, *filter(None, rows)][:MAX_ROWS_LISTED]
        group.labels = list(dict.fromkeys([*group.labels, *labels]))


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


def _details(block: Block) -> dict[int, str]:
    """Return the results at fault, by row, of the rows that do not agree."""
    case, names = block.case, np.array(block.case.names)
    given, due = ~np.isnan(case.values), np.isfinite(case.ours)
    at_fault = (given ^ due) | (block.grades == LOST)
    places = np.flatnonzero(block.codes).tolist()
    details = {block.rows.first + place: " ".join(names[at_fault[:, place]]) for place in places}
    return details | {row.row: str(row) for row in _rows_of(block)}
