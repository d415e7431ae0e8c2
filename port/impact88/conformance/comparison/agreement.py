"""Grade the agreement of another program's results with ours, scene by scene.

*To the double*: within the rounding errors of the best programs. *To the digits claimed*: the
exact value rounded to the digits it is written with. *As elimination does*: within the rounding
errors of a correct program in any of the spellings (`tolerance`); or within a third of the largest
ones of trial impulses in that scene, as long as nine digits are left, or it loses no more than a
few times what elimination may. A result
is graded by itself: no other result or row has a part in it. Where rounding decides which way the
contact slides, either way counts as correct. Where rounding may leave less than two correct digits,
or too few are written, a number that shares none with ours is not compared.
"""

import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.doubles import BARE, double
from ...equations.evaluation import LAST, NEIGHBOUR_SHIFTS, ROW, Run
from ...equations.spelling import A_IMPULSE, spelling_of
from ...errors import UserError, quoted
from ...mechanics.accuracy import errorbound
from ...mechanics.closedform.solve import solve
from ...names import FINAL_VELOCITIES, SCENE
from ...tables.cells import TableUnits, last_digit
from ...tables.rows import Column, Rows
from . import tolerance

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Columns = Mapping[str, Floats]

EQUATIONS = {
    "13": "momentum along x",
    "14": "momentum along y",
    "15": "restitution",
    "16": "friction",
    "17": "angular momentum",
    "18": "moment",
}
"""Number -> subject."""
_EQUATION_RTOL = 1e-13  # rounding in evaluating an equation, relative to the sum of its terms
_NO_RESULT = re.compile(
    r"|null|none|n/a|#[A-Z]+[/0-9A-Z]*[!?]?|[+-]?(nan|1\.#(IND|QNAN|SNAN)[0-9]*)(\([a-z0-9]*\))?",
    re.IGNORECASE,
)
"""Cells that programs write for no result: spreadsheets' errors, C's -nan(ind)."""
_INFINITE = re.compile(r"([+-]?)(inf|infinity|1\.#INF[0-9]*)", re.IGNORECASE)
"""Cells that programs write for a number beyond all others, which is no refusal."""
_IS_PLAIN = np.zeros(256, bool)
_IS_PLAIN[np.frombuffer("".join(BARE - {" "}).encode(), np.uint8)] = True
"""Characters of a number without a unit, as their codes."""
HALF = 0.5 + 1e-9  # rounding to the last digit written, in units of that digit

COLUMNS = (
    *SCENE,
    *(f"{row}_{name}" for row in NEIGHBOUR_SHIFTS for name in SCENE),
    *(f"{LAST}{name}" for name in FINAL_VELOCITIES),
    ROW,
)

# grades of agreement
ABSENT = 0  # one side has no result
DOUBLE = 1
DIGITS = 2
ELIMINATION = 3
DIFFER = 4
LOST = 5  # rounding, or the digits written, leave no digit to compare

_PLAIN_FACTOR = 30.0  # of the best bound, in ordinary scenes: what elimination may add
INITIAL_VELOCITIES = ("UX", "UY", "VX", "VY", "WA", "WB")
"""In the order of the final ones."""
NO_DIGIT = 0.1  # relative difference from which a result shares no digit with ours
_NEARLY_NO_DIGIT = 0.01  # the same of a difference beyond the digits written
MAX_SLIGHT_DIFFERENCE = 1e-10
"""Relative difference up to which a result agrees but for its last digits: half of what 32 bits of
mantissa leave, a twentieth of the effect of 3.14159265 for pi."""
_TRIAL_FRACTION = 1 / 3
"""Fraction of the bound of trial impulses, in which every operation rounds at its worst. Of 63,000
numbers by correct programs that the whole bound let pass, none was beyond 0.22 of it; every 0.03
more are four times rarer."""
_MAX_TRIAL_FACTOR = (
    4.0  # of what elimination loses: what trial impulses may lose beyond nine digits
)
_MAX_EQUATION_SLACK = 1e-6  # relative to their results: what is off by more violates an equation
_MIN_EQUATION_SLACK = 1e-9  # the same of a row off by more than rounding: of programs of their own


class Question(NamedTuple):
    """The question that rows of a table answer.

    ``scene``: columns of n; ``classes``, ``labels``: of test vectors, where the rows have them;
    ``refusals``: of a kit's vectors, why a row is not compared (its place in `REASONS`, or 0).
    """

    scene: Mapping[str, Floats]
    classes: Column | None
    labels: Column | None
    refusals: NDArray[np.intp] | None = None


class ComparedRows(NamedTuple):
    """Rows of a table with our results for them: arrays (results, rows), or (rows,).

    ``names``: of the results; ``scene``: each row's columns, those of the rows before and after,
    the other program's velocities of the row before, and the row's number (`COLUMNS`);
    ``values``: the other program's results; ``units``: of the last digit written (0 for binary
    numbers); ``ours``: our results; ``sizes``: errors are relative to them; ``condition``: COND.
    ``tight``, ``loose``: error bounds in double precision of the best programs, and of any correct
    one (equal to the former where that was enough); ``per_unit``: the largest
    relative ``loose`` of a row's velocities per unit roundoff; ``no_digit``: relative difference
    from which a number shares no digit with ours.
    """

    names: tuple[str, ...]
    scene: Floats
    values: Floats
    units: Floats
    ours: Floats
    sizes: Floats
    condition: Floats
    tight: Floats
    loose: Floats
    per_unit: Floats
    no_digit: Floats

    def select_rows(self, rows: NDArray[np.intp]) -> "ComparedRows":
        """Return the case of some of the rows."""
        return ComparedRows(self.names, *(column[..., rows] for column in self[1:]))

    @property
    def columns(self) -> dict[str, Floats]:
        """The scenes by name."""
        return dict(zip(COLUMNS, self.scene, strict=True))

    @property
    def rows(self) -> list[int]:
        """The rows' numbers in the table, from 1."""
        return [int(number) for number in self.columns[ROW]]

    @property
    def wrong(self) -> Bools:
        """The rows that disagree."""
        return np.asarray((self.grade()[0] == DIFFER).any(0))

    def grade(self) -> tuple[NDArray[np.intp], Floats]:
        """Return the grade of each result and its relative difference, both (results, rows)."""
        with np.errstate(all="ignore"):
            off = np.abs(self.values - self.ours)
            half_units = self.units * HALF
            # a size of 0 is no measure: take the other program's number
            measure = np.where(self.sizes > 0, self.sizes, np.abs(self.values))
            relative = np.minimum(np.where(off > 0, off / measure, 0.0), np.finfo(float).max)
            # an infinite number is an answer, and no finite one's
            absent = np.isnan(self.values) | ~np.isfinite(self.ours)
            differ = off > half_units + self.loose
            beyond = (off - half_units) / measure
            lost = (relative > self.no_digit) | (
                beyond > _NEARLY_NO_DIGIT / NO_DIGIT * self.no_digit
            )
            within = (absent, differ, lost, off <= self.tight, off <= half_units + self.tight)
            grades = np.select(within, (ABSENT, DIFFER, LOST, DOUBLE, DIGITS), ELIMINATION)
            return grades, relative


def concatenate_cases(cases: Sequence[ComparedRows]) -> ComparedRows:
    """Return one case of several blocks of a table."""
    columns = zip(*(case[1:] for case in cases), strict=True)
    return ComparedRows(cases[0].names, *(np.concatenate(column, -1) for column in columns))


def make_case(
    scene: Columns,
    theirs: Mapping[str, tuple[Floats, Floats]],
    rtol: float | None = None,
    first: int = 1,
) -> ComparedRows:
    """Compare scenes (columns of n) with another program's results.

    ``theirs``: name -> values and the units of their last digits; ``rtol``: the user's own relative
    tolerance, for all scenes, in place of the error bounds; ``first``: number of the first row in
    the table. Where rounding decides which way the
    contact slides, our results are those of the sliding that agrees better.
    """
    case, open_rows = _compare_scenes(scene, theirs, rtol)
    if open_rows.size:
        part = {name: column[open_rows] for name, column in scene.items()}
        results = {name: (a[open_rows], b[open_rows]) for name, (a, b) in theirs.items()}
        reversed_case, _ = _compare_scenes({**part, "MU": -part["MU"]}, results, rtol)
        # the nearer of the two, as rounding may leave neither within the bounds
        ours, other = (x.grade()[1].max(0) for x in (case.select_rows(open_rows), reversed_case))
        better = other < ours
        for column, replacement in zip(case[4:], reversed_case[4:], strict=True):
            column[..., open_rows[better]] = replacement[..., better]
    case.columns[ROW][:] = np.arange(first, first + case.condition.size)
    return case


@np.errstate(all="ignore")
def _compare_scenes(
    scene: Columns, theirs: Mapping[str, tuple[Floats, Floats]], rtol: float | None
) -> tuple[ComparedRows, NDArray[np.intp]]:
    """Return the case, and the rows in which rounding decides which way the contact slides."""
    # not split: the columns of one case, most of which depend on those above
    solution = {name: column.astype(float) for name, column in solve(scene).items()}
    scales = errorbound.scales(scene, solution)
    columns = np.stack([scene[name] for name in SCENE])
    neighbours = (np.roll(columns, shift, -1) for shift in NEIGHBOUR_SHIFTS.values())
    values, units = (np.stack(column) for column in zip(*theirs.values(), strict=True))
    unknown = np.full(values.shape[1], np.nan)
    last = np.stack([np.roll(theirs.get(name, (unknown,))[0], 1) for name in FINAL_VELOCITIES])
    last[:, :1] = np.nan
    # a program that has no result keeps none
    own = np.stack([scene[name] for name in INITIAL_VELOCITIES])
    last = np.where(np.isnan(last), own, last)
    ours = np.stack([solution[name] for name in theirs])
    sizes = np.stack([scales[name] for name in theirs])
    best_bounds, open_rows = tolerance.best_error_bounds(scene, solution, scales)
    tight = np.stack([best_bounds[name] for name in theirs])
    if rtol is not None:
        tight = rtol * sizes + 2 * np.spacing(np.abs(ours))
    loose = tight.copy()
    per_unit = np.max([best_bounds[name] / scales[name] for name in FINAL_VELOCITIES], 0)
    off = np.abs(values - ours) - units * HALF
    beyond = (off > tight).any(0)
    is_far = (off > tolerance.ORDINARY_BOUND * sizes) & (sizes > 0)
    # a number that is far off in an ordinary scene needs no bound
    is_plain = tolerance.is_ordinary(scene, solution["COND"]) & (~(off > tight) | is_far).all(0)
    per_unit[beyond & is_plain] *= _PLAIN_FACTOR
    if rtol is None and (rows := np.flatnonzero(beyond & ~is_plain)).size:
        # these bounds take long: only for rows that are beyond the tight ones
        part_scene, part_solved, part_scales, part_bounds = (
            {name: column[rows] for name, column in table.items()}
            for table in (scene, solution, scales, best_bounds)
        )
        bounds = tolerance.largest_error_bounds(
            part_scene, part_solved, part_scales, part_bounds, theirs
        )
        trials = tolerance.trial_bounds(part_scene, part_solved)
        for place, name in enumerate(theirs):
            most = np.fmax(
                tolerance.ORDINARY_BOUND * part_scales[name], _MAX_TRIAL_FACTOR * bounds[name]
            )
            allowed = np.fmax(np.fmin(_TRIAL_FRACTION * trials[name], most), bounds[name])
            is_allowed = off[place, rows] <= allowed
            loose[place, rows] = np.where(is_allowed, allowed, bounds[name])
        relative = [bounds[name] / part_scales[name] for name in FINAL_VELOCITIES]
        per_unit[rows] = np.max(np.where(np.isfinite(relative), relative, 0.0), axis=0)
    case = ComparedRows(
        names=tuple(theirs),
        scene=np.concatenate([columns, *neighbours, last, last[:1]]),
        values=values,
        units=units,
        ours=ours,
        sizes=sizes,
        condition=solution["COND"],
        tight=tight,
        loose=loose,
        per_unit=per_unit / errorbound.DOUBLE,
        # with the user's own tolerance all numbers are compared
        no_digit=np.full(len(values[0]), NO_DIGIT if rtol is None else np.inf),
    )
    return case, np.flatnonzero(open_rows)


def read_theirs(rows: Rows, name: str, units: TableUnits) -> tuple[Floats, Floats]:
    """Return a column of results in base units, and the units of their last digits.

    The unit is 0 for binary numbers. An empty cell is NaN and counts as not given; one that says
    infinity is infinite; cells that are
    not numbers are added to ``rows.bad``. Raises UserError for an array without a number for each
    row.
    """
    column, factor = rows.one_per_row(name), units.factor(name)
    if isinstance(column, np.ndarray) and column.dtype.kind in "fiu":
        return column.astype(float) * factor, np.zeros(rows.count)
    if (plain := _read_plain(list(column))) is not None:
        return plain[0] * factor, plain[1] * factor
    values, last = np.full(rows.count, np.nan), np.zeros(rows.count)
    for index, cell in enumerate(column):
        if isinstance(cell, float):  # from a data frame
            values[index] = cell * factor
            continue
        text = "" if cell is None else str(cell).strip()
        if _NO_RESULT.fullmatch(text):
            continue
        if infinite := _INFINITE.fullmatch(text):
            values[index] = float(f"{infinite[1]}inf")
            continue
        try:
            values[index] = double(text) * factor
            last[index] = last_digit(text) * factor
        except ValueError:
            try:
                if not any(map(str.isdigit, text)):
                    raise UserError(f"{quoted(text)} is not a number") from None
                values[index], last[index] = units.result(name, text)
            except UserError as error:
                rows.bad.append((index, name, str(error).removeprefix(": ")))
    return values, last


def _read_plain(texts: Sequence[object]) -> tuple[Floats, Floats] | None:
    """Return a column of plain numbers and empty cells, and the units of their last digits; None
    where a cell needs a closer look."""
    if not all(isinstance(text, str) for text in texts):
        return None
    cells = [str(text) for text in texts]
    joined = "".join(cells)
    if not joined.isascii():  # half a surrogate pair cannot even be encoded
        return None
    characters = np.frombuffer(joined.encode(), np.uint8)
    if not _IS_PLAIN[characters].all():
        return None
    try:
        values = np.array([float(text or "nan") for text in cells])
    except ValueError:
        return None
    ends = np.cumsum([len(text) for text in cells])
    decimals = np.zeros(values.size, int)
    points = np.flatnonzero(characters == ord("."))
    rows = np.searchsorted(ends, points, "right")
    decimals[rows] = ends[rows] - points - 1
    last = np.array([10.0**-count for count in range(decimals.max(initial=0) + 1)])[decimals]
    last[np.isnan(values)] = 0.0
    exponents = np.flatnonzero((characters == ord("e")) | (characters == ord("E")))
    for row in np.searchsorted(ends, exponents, "right").tolist():
        last[row] = last_digit(cells[row])
    return values, last


@np.errstate(all="ignore")
def violated_equations(case: ComparedRows) -> dict[str, Bools]:
    """Return the rows that violate each of Equations 13 to 18, by the equation's number.

    Empty when the table lacks a final velocity (the spins of point masses are those before the
    impact, given or not). The equations are evaluated on the other program's results, in a spelling
    in which none presupposes another. One is violated when its sides differ by more than the digits
    written and rounding allow: that of ours in a row whose velocities agree, else that of theirs,
    for large bounds of ours say nothing about other numbers. A missing number violates nothing.
    """
    spelling, scene = spelling_of(A_IMPULSE), case.columns
    point = scene["M"] == 4
    parts = zip(case.values, case.units * 0.5, case.loose, strict=True)
    theirs: dict[str, Any] = dict(zip(case.names, parts, strict=True))
    is_velocity = [name in spelling.unknown for name in case.names]
    differ = (case.grade()[0][is_velocity] == DIFFER).any(0)
    for name in ("WAF", "WBF"):
        initial = scene[name[:2]]
        if name in theirs or point.all():
            exact = np.stack([initial, np.zeros_like(initial), np.zeros_like(initial)])
            theirs[name] = np.where(point, exact, theirs.get(name, exact))
    if set(spelling.unknown) - theirs.keys():
        return {}
    columns = np.stack([theirs[name] for name in spelling.unknown], 2)
    values, digits, rounding = columns[..., None, :]
    matrices, rights = Run(spelling, scene).linear_systems({})
    matrix, right = matrices[0], rights[0]
    terms = matrix * values
    size = np.abs(terms).sum(2) + np.abs(right)
    slack = (np.abs(matrix) * rounding).sum(2) + _EQUATION_RTOL * size
    own_slack = np.clip(slack, _MIN_EQUATION_SLACK * size, _MAX_EQUATION_SLACK * size)
    limit = np.where(differ[:, None], own_slack, slack) + (np.abs(matrix) * digits).sum(2)
    violated = np.abs(terms.sum(2) - right) > limit
    subjects = [spelling.statements[index].subject for index in spelling.equations]
    rows = {re.findall("[0-9]+", text)[0]: violated[:, row] for row, text in enumerate(subjects)}
    return {number: rows[number] for number in EQUATIONS}
