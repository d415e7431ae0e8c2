"""Whether another program's numbers agree with ours, and how closely they must in each scene.

*To the double*: no farther off than rounding allows in the best of programs. *To the digits
claimed*: the exact value rounded to the digits it is written with. *As elimination does*: no
farther off than rounding may take a correct program in any of the spellings (`tolerance`), result
by result. Where rounding decides which way the contact slides, either way is right; where it may
leave no digit, or too few are written to tell, a number that shares none is not compared.
"""

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..collision.doubles import double
from ..errors import UserError, quoted
from ..mechanics.accuracy import errorbound
from ..mechanics.closedform.solve import solve
from ..names import FINAL_VELOCITIES, SCENE
from ..tables.cells import TableUnits, last_digit
from ..tables.rows import Rows
from . import tolerance
from .equations.evaluation import BESIDE, Run
from .equations.spelling import A_IMPULSE, spelling_of

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
"""Number and subject."""
_ROUNDING = 1e-13
"""Of the sum of an equation's terms, for evaluating it."""
_NOTHING = re.compile(
    r"|null|none|n/a|#[A-Z]+[/0-9A-Z]*[!?]?|[+-]?(nan|inf|infinity|1\.#[A-Z]+[0-9]*)(\([a-z0-9]*\))?",
    re.IGNORECASE,
)
"""What programs write where they have no result: spreadsheets' errors, C's -nan(ind), infinity."""
HALF = 0.5 + 1e-9
"""Of the last digit written."""

COLUMNS = (*SCENE, *(f"{row}_{name}" for row in BESIDE for name in SCENE))
ABSENT, DOUBLE, DIGITS, ELIMINATION, DIFFER, LOST = range(6)
"""How a result agrees; absent where one side has none, lost where no digit of it can be told."""
NO_DIGIT = 0.1
"""Off by more than this share of its size, a result shares no digit with ours."""


class Case(NamedTuple):
    """Rows of a table, theirs and ours: arrays with the rows last, the ``names`` of results before.

    ``scene``: each row's, and those of the rows before and after (`COLUMNS`); ``units``: the last
    digit written of ``values`` (0 where there is none); ``sizes``: what errors are a share of;
    ``tight``, ``loose``: how far the best of programs, and a correct one of any spelling, may be
    off in double precision (the latter is no larger than the former where that was enough);
    ``per_unit``: the largest of a row's, as a share of its size, per unit roundoff; ``no_digit``:
    the share off by which a number has no digit in common with ours.
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

    def part(self, rows: NDArray[np.intp]) -> "Case":
        """Some of the rows."""
        return Case(self.names, *(column[..., rows] for column in self[1:]))

    @property
    def columns(self) -> dict[str, Floats]:
        """The scenes by name."""
        return dict(zip(COLUMNS, self.scene, strict=True))

    @property
    def wrong(self) -> Bools:
        """The rows that disagree."""
        return np.asarray((self.judged()[0] == DIFFER).any(0))

    def judged(self) -> tuple[NDArray[np.intp], Floats]:
        """How each result agrees, and the difference as a share of its size, (results, rows)."""
        with np.errstate(all="ignore"):
            off = np.abs(self.values - self.ours)
            written = self.units * HALF
            # nothing there to measure by: as a share of what they have
            measure = np.where(self.sizes > 0, self.sizes, np.abs(self.values))
            relative = np.minimum(np.where(off > 0, off / measure, 0.0), np.finfo(float).max)
            absent = ~(np.isfinite(self.values) & np.isfinite(self.ours))
            differ = off > written + self.loose
            lost = relative > self.no_digit
            within = (absent, differ, lost, off <= self.tight, off <= written + self.tight)
            grades = np.select(within, (ABSENT, DIFFER, LOST, DOUBLE, DIGITS), ELIMINATION)
            return grades, relative


def joined(cases: Sequence[Case]) -> Case:
    """Rows of several blocks of one table."""
    columns = zip(*(case[1:] for case in cases), strict=True)
    return Case(cases[0].names, *(np.concatenate(column, -1) for column in columns))


def case_of(
    scene: Columns, theirs: Mapping[str, tuple[Floats, Floats]], rtol: float | None = None
) -> Case:
    """Scenes (columns of n) with another program's results, values and the units of their last
    digits; ``rtol``: a user's own share that agrees, for every scene alike."""
    case, undecided = _case(scene, theirs, rtol)
    if undecided.size:
        few = {name: column[undecided] for name, column in scene.items()}
        some = {name: (a[undecided], b[undecided]) for name, (a, b) in theirs.items()}
        other, _ = _case({**few, "MU": -few["MU"]}, some, rtol)
        both = (case.part(undecided).judged()[0], other.judged()[0])
        mine, turned = ((grades == DIFFER).sum(0) for grades in both)
        better = turned < mine
        for column, instead in zip(case[4:], other[4:], strict=True):
            column[..., undecided[better]] = instead[..., better]
    return case


@np.errstate(all="ignore")
def _case(
    scene: Columns, theirs: Mapping[str, tuple[Floats, Floats]], rtol: float | None
) -> tuple[Case, NDArray[np.intp]]:
    """The case, and the rows in which rounding decides which way the contact slides."""
    ours = {name: column.astype(float) for name, column in solve(scene).items()}
    sizes = errorbound.scales(scene, ours)
    columns = np.stack([scene[name] for name in SCENE])
    beside = (np.roll(columns, step, -1) for step in BESIDE.values())
    values, units = (np.stack(column) for column in zip(*theirs.values(), strict=True))
    mine, measures = (np.stack([found[name] for name in theirs]) for found in (ours, sizes))
    least, undecided = tolerance.of_the_best(scene, ours, sizes)
    tight = np.stack([least[name] for name in theirs])
    if rtol is not None:
        tight = rtol * measures + 2 * np.spacing(np.abs(mine))
    loose = tight.copy()
    per_unit = np.max([least[name] / sizes[name] for name in FINAL_VELOCITIES], 0)
    beyond = (np.abs(values - mine) > tight + units * HALF).any(0)
    if rtol is None and (rows := np.flatnonzero(beyond)).size:
        few, some, their_sizes, floor = (
            {name: column[rows] for name, column in found.items()}
            for found in (scene, ours, sizes, least)
        )
        most = tolerance.of_any(few, some, their_sizes, floor, theirs)
        loose[:, rows] = [most[name] for name in theirs]
        shares = [most[name] / their_sizes[name] for name in FINAL_VELOCITIES]
        per_unit[rows] = np.max(np.where(np.isfinite(shares), shares, 0.0), axis=0)
    scenes = np.concatenate([columns, *beside])
    # a tolerance of the user's own is taken as it is
    no_digit = np.full(len(values[0]), NO_DIGIT if rtol is None else np.inf)
    found = (scenes, values, units, mine, measures, ours["COND"], tight, loose)
    case = Case(tuple(theirs), *found, per_unit / errorbound.DOUBLE, no_digit)
    return case, np.flatnonzero(undecided)


def read_theirs(rows: Rows, name: str, units: TableUnits) -> tuple[Floats, Floats]:
    """A column of results in base units, and the unit of the last digit written (0 where it is
    written in binary). An empty cell is NaN and counts as not given; what is no number is added to
    ``rows.bad``. Raises UserError for an array that has not a number for each row."""
    column, factor = rows.one_per_row(name), units.factor(name)
    if isinstance(column, np.ndarray) and column.dtype.kind in "fiu":
        return column.astype(float) * factor, np.zeros(rows.count)
    values, last = np.full(rows.count, np.nan), np.zeros(rows.count)
    for index, cell in enumerate(column):
        if isinstance(cell, float):  # of a frame
            values[index] = cell * factor
            continue
        text = "" if cell is None else str(cell).strip()
        if _NOTHING.fullmatch(text):
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


@np.errstate(all="ignore")
def violated(case: Case) -> dict[str, Bools]:
    """Which of Equations 13 to 18 their results violate: number -> rows; empty when the table lacks
    a final velocity (point masses keep their spins, given or not).

    The equations are evaluated on the results as given, in a spelling in which none takes another
    for granted. One is violated when its sides differ by more than the digits written, and
    rounding, allow; a missing number violates nothing.
    """
    spelling, scene = spelling_of(A_IMPULSE), case.columns
    point = scene["M"] == 4
    slack = case.units * 0.5 + case.loose
    given = dict(zip(case.names, zip(case.values, slack, strict=True), strict=True))
    for name in ("WAF", "WBF"):
        kept = scene[name[:2]]
        if name in given or point.all():
            value, room = given.get(name, (kept, 0.0))
            given[name] = np.where(point, kept, value), np.where(point, 0.0, room)
    if set(spelling.unknown) - given.keys():
        return {}
    values, room = np.stack([given[name] for name in spelling.unknown], 2)[..., None, :]
    matrix, right = (whole[0] for whole in Run(spelling, scene).system({}))
    terms = matrix * values
    limit = (np.abs(matrix) * room).sum(2) + _ROUNDING * (np.abs(terms).sum(2) + np.abs(right))
    off = np.abs(terms.sum(2) - right) > limit
    subjects = [spelling.statements[index].subject for index in spelling.equations]
    rows = {re.findall("[0-9]+", text)[0]: off[:, row] for row, text in enumerate(subjects)}
    return {number: rows[number] for number in EQUATIONS}
