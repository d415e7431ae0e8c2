"""Comparing another implementation's results with this one's, and saying why they differ.

Every result of every row is judged by the scene's own condition (`agreement`). Rows that disagree
are explained by `diagnosis`: which mistake or convention, made here too, gives their numbers. What
could not be compared is counted, and why.
"""

from __future__ import annotations

import difflib
import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..closedform.solve import solve
from ..doubles import double
from ..equations.otherprogram import Program
from ..errors import UserError
from ..files import called
from ..mappings import texts
from ..names import DEFAULT_M, RESULTS, SCENE
from ..plaintable import plain
from ..progress import progress
from ..tables.rows import BadCell, Rows, check_scene_columns, numbers, one_per_row
from ..tables.table import format_of, open_reader
from ..tables.tableunits import TableUnits
from .agreement import Slack, Theirs, Verdict, given, judge, read_theirs, slack
from .diagnosis import UNKNOWN, Case, Cause, diagnose
from .vectors import FAILURE

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Columns = dict[str, Floats]

WORST = 20
"""Rows that disagree most, kept for the report."""
DIAGNOSED = 4000
"""Rows that disagree, and as many that agree, that are looked into for the cause."""
BEYOND = f"not looked into: after the first {DIAGNOSED:,} that disagree"
NOT_COMPARED = ("STATUS", "COND")
CARRIED = ("id", "class", "label", "expect", "flags", "comment")
"""Columns of test vectors that say which row it is."""

NO_RESULT = "no result on either side: theirs refuses, and so does the mathematics"
NOTHING_HERE = "theirs gives numbers where the equations have no solution"
NOTHING_THERE = "theirs gives nothing where there is a result"
REFUSED = "theirs refuses a vector of the class failure, as it may"
UNREADABLE = "the row could not be read"
HARMLESS = (NO_RESULT, REFUSED)
"""Reasons that no program is to be blamed for."""


class Row(NamedTuple):
    """A row that disagrees: where it stands, its worst result, how far off, the likely cause."""

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
    """For one result: how many agree in which way, how many are missing on their side, and the
    largest relative difference."""

    compared: int = 0
    double: int = 0
    digits: int = 0
    elimination: int = 0
    differ: int = 0
    missing: int = 0
    largest: float = 0.0


@dataclass
class Elimination:
    """Rows that agree only as closely as elimination can: how many, and the worst of them."""

    rows: int = 0
    worst_row: int = 0
    worst_relative: float = 0.0
    worst_condition: float = 0.0


@dataclass
class Comparison:
    """The result of `compare_file`.

    ``causes``: likely cause -> rows it explains; ``evidence`` and ``programs``: what bears out each
    cause that is a program, and the program; ``differences``: every row that disagrees, as long
    as they are few (`DIAGNOSED`); ``not_compared``: reason -> rows; ``unknown``: columns that were
    not recognised -> the name that was meant, or "".
    """

    rows: int = 0
    agreeing: int = 0
    differing: int = 0
    tallies: dict[str, Tally] = field(default_factory=dict)
    causes: Counter[str] = field(default_factory=Counter)
    differences: list[Row] = field(default_factory=list)
    not_compared: Counter[str] = field(default_factory=Counter)
    places_not_compared: dict[str, list[int]] = field(default_factory=dict)
    elimination: Elimination = field(default_factory=Elimination)
    evidence: list[Cause] = field(default_factory=list)
    programs: list[Program] = field(default_factory=list)
    equations: dict[str, tuple[int, int]] = field(default_factory=dict)
    bad: list[BadCell] = field(default_factory=list)
    unknown: dict[str, str] = field(default_factory=dict)

    @property
    def worst(self) -> list[Row]:
        """The rows that disagree most."""
        return sorted(self.differences, key=lambda one: -one.relative)[:WORST]

    @property
    def silent(self) -> list[str]:
        """What would pass without a word: columns, rows and cells that were not compared."""
        said = [f"column {name} not recognised" for name in self.unknown]
        said += [
            f"{count} rows not compared: {reason}"
            for reason, count in self.not_compared.items()
            if reason not in HARMLESS
        ]
        said += [
            f"{tally.missing} cells of {name} are empty where there is a result"
            for name, tally in self.tallies.items()
            if tally.missing
        ]
        return said

    @property
    def summary(self) -> str:
        """One line."""
        line = f"{self.rows} rows: {self.agreeing} agree, {self.differing} disagree"
        skipped = sum(self.not_compared.values())
        if skipped:
            line += f", {skipped} not compared"
        if self.causes:
            cause, count = self.causes.most_common(1)[0]
            line += f"; likely cause of {count}: {cause}"
        return line

    def as_json(self) -> dict[str, Any]:
        """The object `impact88 compare --json` prints."""
        whole: dict[str, Any] = plain(
            {
                "summary": self.summary,
                "rows": self.rows,
                "agreeing": self.agreeing,
                "differing": self.differing,
                "results": {name: vars(tally) for name, tally in self.tallies.items()},
                "causes": dict(self.causes.most_common()),
                "evidence": [one._asdict() for one in self.evidence],
                "equations": {
                    number: {"checked": checked, "violated": violated}
                    for number, (checked, violated) in self.equations.items()
                },
                "worst": [one._asdict() for one in self.worst],
                "differences": [
                    {"row": one.row, "id": one.id, "cause": one.cause} for one in self.differences
                ],
                "elimination": vars(self.elimination),
                "not_compared": {
                    reason: {"rows": count, "first": self.places_not_compared[reason]}
                    for reason, count in self.not_compared.items()
                },
                "unknown_columns": self.unknown,
                "bad_rows": [str(bad) for bad in self.bad],
            }
        )
        return whole


class _Waiting(NamedTuple):
    """Rows of one block kept for the diagnosis."""

    case: Case
    rows: list[Row]


def compare_file(
    path: str | os.PathLike[str],
    form: str | None = None,
    values: Mapping[str, str] | None = None,
    rtol: float | None = None,
    encoding: str | None = None,
    units: str | None = None,
    causes: bool = True,
) -> Comparison:
    """Compare a table of scenes and results, block by block; ``units``: of columns whose heading
    names none.

    ``form``: csv, jsonl, npz, parquet, feather or xlsx where the name does not say; ``values``: for
    all rows of columns the table lacks; ``rtol``: the difference, as a share of the
    scene's largest velocity, spin or energy, that agrees, in place of what rounding allows;
    ``causes``: look for causes where rows disagree. Raises UserError when the table has no result
    column or does not give a whole scene.

    >>> import json, pathlib, tempfile
    >>> scene = impact88.sample(1).numbers()
    >>> row = {**scene, "LOSS": float(impact88.solve(scene, ["LOSS"])["LOSS"])}
    >>> table = pathlib.Path(tempfile.mkdtemp(), "theirs.jsonl")
    >>> _ = table.write_text(json.dumps(row))
    >>> impact88.compare(table).summary.partition(";")[0]
    '1 rows: 1 agree, 0 disagree'
    """
    values = texts(values or {})
    path = os.fspath(path)
    form = format_of(path, form)
    comparison = Comparison()
    waiting: list[_Waiting] = []
    with open_reader(path, form, encoding) as reader:
        wanted = [name for name in reader.names if name in RESULTS and name not in NOT_COMPARED]
        where = called(path)
        known = {*SCENE, *RESULTS, *CARRIED}
        comparison.unknown = {name: _meant(name) for name in reader.names if name not in known}
        if not wanted:
            hint = ", ".join(
                f"{name} for {meant}" for name, meant in comparison.unknown.items() if meant
            )
            raise UserError(
                f"no column of results{f' ({hint}?)' if hint else ''}; expected some of "
                f"{' '.join(RESULTS)}, beside the scene's",
                where,
            )
        scene_names = [name for name in reader.names if name in SCENE]
        check_scene_columns(scene_names, list(values), ("M",))
        comparison.tallies = {name: Tally() for name in wanted}
        with progress(reader.total, "compare", "B") as meter:
            before = 0
            table: TableUnits | None = None
            for rows in reader:
                table = table or TableUnits(reader.names, units, rows, wanted, where)
                kept = _compare_block(rows, values, wanted, comparison, rtol, table)
                if kept is not None:
                    waiting.append(kept)
                meter.update(reader.position() - before)
                before = reader.position()
    if not any(tally.compared for tally in comparison.tallies.values()):
        raise UserError("no result could be compared", where)
    if causes:
        _explain(waiting, comparison)
    return comparison


def _meant(name: str) -> str:
    """The result or scene column that a name stands for, in other letters or nearly."""
    known = (*RESULTS, *SCENE)
    plain = name.strip().upper()
    if plain in known:
        return plain
    close = difflib.get_close_matches(plain, known, 1, 0.75)
    return close[0] if close else ""


@np.errstate(all="ignore")
def _compare_block(
    rows: Rows,
    values: Mapping[str, str],
    wanted: Sequence[str],
    comparison: Comparison,
    rtol: float | None,
    units: TableUnits,
) -> _Waiting | None:
    """Judge a block and count; the rows to be explained are returned."""
    whole = {"M": DEFAULT_M, **values}
    scene = {name: np.full(rows.count, double(whole[name])) for name in whole if name in SCENE}
    scene |= numbers(rows, units)
    if any(units.converts(name) for name in scene):
        rows.columns |= {name: scene[name] for name in rows.columns}
    scene = {name: scene[name] for name in SCENE}
    ours = {name: column.astype(float) for name, column in solve(scene).items()}
    allowed = slack(scene, ours, rtol)
    theirs = {name: read_theirs(rows, name, units.factor(name)) for name in wanted}
    verdicts = {name: judge(theirs[name], ours[name], name, allowed) for name in wanted}
    bad = {one.row for one in rows.bad}
    readable = np.array([rows.first + index not in bad for index in range(rows.count)], bool)
    there = {name: mask & readable for name, mask in given(theirs, ours).items()}
    compared = np.logical_or.reduce(list(there.values()))
    wrong = np.zeros(rows.count, bool)
    for name in wanted:
        wrong |= there[name] & ~verdicts[name].elimination
        judged = readable & np.isfinite(ours[name]) & compared
        _tally(comparison.tallies[name], verdicts[name], there[name], judged)
    comparison.rows += rows.count
    comparison.bad += rows.bad
    comparison.agreeing += int((compared & ~wrong).sum())
    comparison.differing += int(wrong.sum())
    _count_skipped(comparison, rows, readable, compared, theirs, ours)
    _count_elimination(comparison, rows, verdicts, there, compared & ~wrong, ours["COND"])
    places = np.flatnonzero(compared)
    room = DIAGNOSED - len(comparison.differences)
    keep = np.concatenate(
        [np.flatnonzero(wrong)[: max(room, 0)], np.flatnonzero(compared & ~wrong)[:DIAGNOSED]]
    )
    comparison.causes[BEYOND] += max(int(wrong.sum()) - max(room, 0), 0)
    if not places.size or not keep.size:
        return None
    theirs_by_name = [
        _row(rows, index, theirs, ours, verdicts, there) for index in np.flatnonzero(wrong).tolist()
    ]
    theirs_by_name = theirs_by_name[: max(room, 0)]
    comparison.differences += theirs_by_name
    case = Case(scene, _texts(rows, values), theirs, ours, allowed, wrong)
    return _Waiting(case.part(keep), theirs_by_name)


def _tally(tally: Tally, verdict: Verdict, there: Bools, judged: Bools) -> None:
    tally.compared += int(there.sum())
    tally.double += int((there & verdict.double).sum())
    tally.digits += int((there & verdict.digits & ~verdict.double).sum())
    tally.elimination += int((there & verdict.elimination & ~verdict.digits).sum())
    tally.differ += int((there & ~verdict.elimination).sum())
    tally.missing += int((judged & ~there).sum())
    if there.any():
        tally.largest = max(tally.largest, float(verdict.relative[there].max()))


def _count_skipped(
    comparison: Comparison,
    rows: Rows,
    readable: Bools,
    compared: Bools,
    theirs: Mapping[str, Theirs],
    ours: Columns,
) -> None:
    """Count the rows that were not compared, by reason."""
    solvable = np.logical_or.reduce([np.isfinite(ours[name]) for name in theirs])
    answered = np.logical_or.reduce([np.isfinite(column.values) for column in theirs.values()])
    kinds = rows.others.get("class")
    may = np.array([str(kind) == FAILURE for kind in kinds], bool) if kinds is not None else False
    reasons = {
        UNREADABLE: ~readable,
        NO_RESULT: readable & ~solvable & ~answered,
        NOTHING_HERE: readable & ~solvable & answered,
        REFUSED: readable & solvable & ~answered & may,
        NOTHING_THERE: readable & solvable & ~compared & ~(~answered & may),
    }
    for reason, which in reasons.items():
        which &= ~compared
        if which.any():
            comparison.not_compared[reason] += int(which.sum())
            first = comparison.places_not_compared.setdefault(reason, [])
            first += [rows.first + index for index in np.flatnonzero(which).tolist()]
            del first[WORST:]


def _count_elimination(
    comparison: Comparison,
    rows: Rows,
    verdicts: Mapping[str, Verdict],
    there: Mapping[str, Bools],
    agreeing: Bools,
    condition: Floats,
) -> None:
    loose = np.zeros(agreeing.size, bool)
    relative = np.zeros(agreeing.size)
    for name, verdict in verdicts.items():
        only = there[name] & verdict.elimination & ~verdict.digits & agreeing
        loose |= only
        relative = np.where(only, np.fmax(relative, verdict.relative), relative)
    tally = comparison.elimination
    tally.rows += int(loose.sum())
    if loose.any():
        worst = int(np.argmax(np.where(loose, relative, -1.0)))
        if relative[worst] > tally.worst_relative:
            tally.worst_row = rows.first + worst
            tally.worst_relative = float(relative[worst])
            tally.worst_condition = float(condition[worst])


def _row(
    rows: Rows,
    index: int,
    theirs: Mapping[str, Theirs],
    ours: Columns,
    verdicts: Mapping[str, Verdict],
    there: Mapping[str, Bools],
) -> Row:
    """A row that disagrees, by its worst result."""
    off = {
        name: float(verdict.relative[index])
        for name, verdict in verdicts.items()
        if there[name][index] and not verdict.elimination[index]
    }
    name = max(off, key=lambda one: off[one])
    ids = one_per_row(rows, "id") if "id" in rows.others else None
    return Row(
        rows.first + index,
        rows.lines[index] if rows.lines else 0,
        str(ids[index]) if ids is not None else "",
        name,
        str(one_per_row(rows, name)[index]),
        float(ours[name][index]),
        off[name],
        UNKNOWN,
    )


def _texts(rows: Rows, values: Mapping[str, str]) -> dict[str, list[str]]:
    """The scenes as decimal text."""
    return {
        name: list(map(str, rows.columns[name]))
        if name in rows.columns
        else [values.get(name, DEFAULT_M)] * rows.count
        for name in SCENE
    }


def _explain(waiting: list[_Waiting], comparison: Comparison) -> None:
    """Find the causes, over the whole table at once."""
    if comparison.differing:
        case = _joined([one.case for one in waiting])
        rows = np.concatenate([np.flatnonzero(case.wrong), np.flatnonzero(~case.wrong)[:DIAGNOSED]])
        diagnosis = diagnose(case.part(rows))
        comparison.equations = diagnosis.equations
        comparison.evidence = diagnosis.evidence
        comparison.programs = diagnosis.programs
        comparison.differences = [
            row._replace(cause=cause)
            for row, cause in zip(comparison.differences, diagnosis.causes, strict=True)
        ]
        comparison.causes.update(diagnosis.causes)
    comparison.causes += Counter()  # drops what counts 0


def _joined(cases: Sequence[Case]) -> Case:
    def together(columns: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
        return {name: np.concatenate([one[name] for one in columns]) for name in columns[0]}

    first = cases[0]
    return Case(
        together([one.scene for one in cases]),
        {name: [text for one in cases for text in one.texts[name]] for name in first.texts},
        {
            name: Theirs(
                np.concatenate([one.theirs[name].values for one in cases]),
                np.concatenate([one.theirs[name].units for one in cases]),
            )
            for name in first.theirs
        },
        together([one.ours for one in cases]),
        Slack(
            together([one.allowed.sizes for one in cases]),
            np.concatenate([one.allowed.double for one in cases]),
            np.concatenate([one.allowed.elimination for one in cases]),
            np.concatenate([one.allowed.per_unit for one in cases]),
        ),
        np.concatenate([one.wrong for one in cases]),
    )
