"""Fit a constant that has a wrong value: one factor or offset, of one input, statement or result.

It is fitted to all rows and reported as a number, with the known constant that it is near to.
"""

from collections.abc import Iterator
from math import pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...equations.edits import BOOLEAN_NAMES, FITTED, Edit
from ...equations.evaluation import Run
from ...equations.spelling import IMPULSES, LISTING, SHOWN, TYPED, Expression, Sides, Spelling
from ...equations.wording import subject_words
from ...names import PIVOT, SCENE
from .agreement import Bools
from .predicates import ABOVE, Predicate
from .trials import MIN_FIT, Judge, Program, try_program

Floats = NDArray[np.float64]

# operations by which a constant enters
FACTOR = "*"
OFFSET = "+"
REPLACED = "="
_REPLACED_COLUMNS = {"E": 0.5, "MU": 0.5, "EM": 0.0}  # and where the fit starts
_MAX_ITERATIONS = 12
_MAX_MISFIT = 10.0  # in units of the limits; a fit farther off is not run
_MIN_CONSTANT = 1e-11
_STEP = 1e-6  # relative step of the difference quotients
_GROUPS = (
    ("GA", "PA", "PB", "TA", "TB"),
    ("PA", "PB"),
    ("TA", "TB"),
    ("DA", "DB"),
    ("MA", "MB", "IA", "IB"),
    ("MA", "MB"),
    ("IA", "IB"),
    ("UX", "UY", "VX", "VY"),
    ("UX", "VX"),
    ("UY", "VY"),
    ("UX", "UY"),
    ("VX", "VY"),
    ("WA", "WB"),
)
"""Inputs that may share a constant."""
_SHOWN_GROUPS = (
    ("VAX", "VAY", "VBX", "VBY"),
    ("VAX", "VBX"),
    ("VAY", "VBY"),
    ("VAX", "VAY"),
    ("VBX", "VBY"),
    ("WAF", "WBF"),
    ("KI", "KF"),
    ("DVA", "DVB"),
    ("PN", "PT"),
)
"""Results that may share a constant."""
_BOTH = ((("UX", "UY", "VX", "VY"), _SHOWN_GROUPS[0]), (("WA", "WB"), ("WAF", "WBF")))
"""Inputs that may be read with a factor, and the results then shown with its inverse."""
KNOWN = {
    "1.467 for 22/15": 1.467 * 15 / 22,
    "1.4667 for 22/15": 1.4667 * 15 / 22,
    "0.682 for 15/22": 0.682 * 22 / 15,
    "0.6818 for 15/22": 0.6818 * 22 / 15,
    "3.14 for pi": 3.14 / pi,
    "22/7 for pi": 22 / 7 / pi,
    "3.1416 for pi": 3.1416 / pi,
    "57.3 for 180/pi": 57.3 * pi / 180,
    "57.29 for 180/pi": 57.29 * pi / 180,
    "0.01745 for pi/180": 0.01745 * 180 / pi,
    "32.2 for 32.174": 32.2 / 32.174,
    "32 for 32.174": 32 / 32.174,
    "9.81 for 9.80665": 9.81 / 9.80665,
    "0.305 for 0.3048": 0.305 / 0.3048,
    "2.2 for 2.20462": 2.2 / 2.20462262,
    "ft/s to mph": 15 / 22,
    "ft/s to m/s": 0.3048,
    "ft/s to km/h": 1.09728,
    "m/s to km/h": 3.6,
    "mph to m/s": 0.44704,
    "mph to km/h": 1.609344,
    "lb to kg": 0.45359237,
    "slug to kg": 14.59390294,
    "the acceleration of gravity in ft/s2": 32.174,
    "the acceleration of gravity in m/s2": 9.80665,
    "degrees for radians": 180 / pi,
    "rpm for radians per second": 30 / pi,
    "12 inches": 12.0,
    "pi": pi,
    "2": 2.0,
    "3": 3.0,
    "4": 4.0,
    "10": 10.0,
    "100": 100.0,
    "1000": 1000.0,
    "the square root of 2": 2**0.5,
}
"""Description -> value of known factors; a constant may be near to one or to its inverse."""
_FACTOR_RTOL = 1e-6


class _Target(NamedTuple):
    """A place for a constant. ``direct`` and ``inverse``: statements (key -> side) that the
    constant, or its inverse, is multiplied by or added to."""

    description: str
    title: str
    operation: str
    direct: dict[str, Expression]
    inverse: dict[str, Expression]

    @property
    def neutral(self) -> float:
        """The constant that changes nothing, or from which the fit starts."""
        if self.operation == REPLACED:
            return _REPLACED_COLUMNS[self.description]
        return 1.0 if self.operation == FACTOR else 0.0

    def sides(self, constant: Any) -> dict[str, Sides]:
        """Return the statements with the constant, one for all rows or one for each."""
        if self.operation == REPLACED:
            typed = self.direct[self.description]
            return {self.description: (("+", constant, ("*", 0, typed)),)}
        # the inverse is infinite where all results are zero
        inverse = np.divide(1, constant) if self.operation == FACTOR else -constant
        sides: dict[str, Sides] = {}
        for key, side in self.direct.items():
            sides[key] = ((self.operation, side, constant),)
        for key, side in self.inverse.items():
            sides[key] = ((self.operation, side, inverse),)
        return sides


def limit_instead(program: Program, where: Predicate) -> Program | None:
    """Return the program that limits a column to a number, in place of one in which it is always
    that beyond another; None where the program does something else."""
    *others, last = program.edits
    column = where.quantity
    match last.sides.get(column), where.relation:
        case ((("+", float() as number, ("*", 0, str() as typed)),), "above" | "below" as relation):
            name, more = ("minimum", "") if relation == ABOVE else ("maximum", " and more")
            text = f"{column} is limited to {number:.7g}{more}"
            limited: Expression = (name, typed, float(f"{number:.7g}"))
            if column == "MU":
                limited = ("where", ("==", typed, PIVOT), typed, limited)
            return Program((*others, Edit("", {column: (limited,)}, FITTED, text)))
    return None


def _targets(title: str, spelling: Spelling, results: Any, has_columns: bool) -> Iterator[_Target]:
    """Yield every place for a constant in a spelling: its own statements, and with the columns
    inputs and shown ``results``, alone and in groups."""
    if has_columns:
        for name in _REPLACED_COLUMNS:
            yield _Target(name, "", REPLACED, {name: f"{TYPED}{name}"}, {})
        inputs = [(name,) for name in SCENE if name != "M"]
        for operation in (FACTOR, OFFSET):
            for group in (*_GROUPS, *inputs):
                if operation == FACTOR or len(group) == 1:
                    sides: dict[str, Expression] = {name: f"{TYPED}{name}" for name in group}
                    yield _Target(", ".join(group), "", operation, sides, {})
            for group in (*_SHOWN_GROUPS, *((name,) for name in results)):
                if set(group) <= set(results):
                    sides = {f"{SHOWN}{name}": name for name in group}
                    yield _Target(f"{', '.join(group)} as shown", "", operation, sides, {})
        for group, shown in _BOTH:
            if set(shown) <= set(results):
                yield _Target(
                    f"{', '.join(group)}, and the results by its inverse",
                    "",
                    FACTOR,
                    {name: f"{TYPED}{name}" for name in group},
                    {f"{SHOWN}{name}": name for name in shown},
                )
    for index, line in enumerate(spelling.statements):
        is_computed = line.target not in ("", *SCENE) and not line.target.startswith(SHOWN)
        is_own = index >= spelling.own_start or title == LISTING
        if is_computed and is_own and line.target not in BOOLEAN_NAMES:
            for operation in (FACTOR, OFFSET):
                place = f"{subject_words(line.subject)} ({line.target})"
                yield _Target(place, title, operation, {line.target: line.sides[0]}, {})


@np.errstate(all="ignore")
def fit_constants(judge: Judge, unexplained: Bools, base: Program) -> list[Program]:
    """Return programs with one constant more than ``base``, fitted, that explain nearly all rows
    that are unexplained, of which a few are looked at; those with a known constant come first."""
    judge = judge._replace(wrong=unexplained).sample(unexplained)
    programs: list[tuple[bool, bool, int, Program]] = []
    titles = next(([edit.title] for edit in base.edits if edit.title), [LISTING, IMPULSES])
    for title in titles:
        spelling = base.in_spelling(title)
        run = Run(spelling, judge.scene)
        results = [name for name in judge.theirs if SHOWN + name in run.names]
        if not results:
            continue
        targets = list(_targets(title, spelling, results, title == titles[0]))
        neutral = np.array([target.neutral for target in targets])
        # each row by itself tells the constant; what most rows tell is taken
        estimates = np.repeat(neutral[:, None], judge.wrong.size, 1)
        for _ in range(_MAX_ITERATIONS):
            estimates = _gauss_newton_step(run, targets, estimates, judge)
        constants = np.nanmedian(estimates[:, judge.wrong], 1)
        # a program takes longer to run: only where the fit is near in enough rows (NaN is near)
        every_row = np.repeat(constants[:, None], judge.wrong.size, 1)
        misfits = _misfits(run, targets, every_row, judge)
        near = (~(np.abs(misfits) > _MAX_MISFIT)).all(1) & judge.wrong
        fits = near.sum(1) >= MIN_FIT * judge.wrong.sum()
        for target, constant, fit in zip(targets, constants.tolist(), fits, strict=True):
            is_new = abs(constant - target.neutral) > _MIN_CONSTANT and np.isfinite(constant)
            if fit and is_new and abs(constant) > _MIN_CONSTANT:  # 0 is an edit
                program = Program((*base.edits, _edit(target, constant)))
                trial = try_program(program, judge)
                if trial.explained_count >= MIN_FIT * judge.wrong.sum():
                    is_unknown, is_offset = not _nearest_known(constant), target.operation == OFFSET
                    programs.append((is_unknown, is_offset, len(programs), program))
    return [program for *_, program in sorted(programs, key=lambda x: x[:3])]


def _gauss_newton_step(run: Run, targets: list[_Target], constants: Floats, judge: Judge) -> Floats:
    """Return the constants (targets, rows) after one step of Gauss-Newton, each by itself."""
    steps = _STEP * np.maximum(np.abs(constants), 1e-3)
    misfits = _misfits(run, targets, constants, judge)
    slopes = (_misfits(run, targets, constants + steps, judge) - misfits) / steps[:, None]
    usable = np.isfinite(slopes) & np.isfinite(misfits)
    slopes, misfits = np.where(usable, slopes, 0.0), np.where(usable, misfits, 0.0)
    change = (slopes * misfits).sum(1) / (slopes * slopes).sum(1)
    next_constants = constants - change
    return np.where(np.isfinite(next_constants) & (change != 0), next_constants, constants)


def _misfits(run: Run, targets: list[_Target], constants: Floats, judge: Judge) -> Floats:
    """Return the misfits of results in units of their limits, (targets, results, rows)."""
    edits = [
        run.spelling.compose(target.sides(row))
        for target, row in zip(targets, constants, strict=True)
    ]
    names = {**run.names, **run.run_edits(edits)}
    shape = (len(targets), judge.wrong.size)
    parts = [
        np.broadcast_to((names[SHOWN + name] - theirs) / judge.limit[name], shape)
        for name, theirs in judge.theirs.items()
        if SHOWN + name in names
    ]
    return np.stack(parts, 1)


def _nearest_known(constant: float) -> str:
    """Return the description of the known factor that a constant is near to, "" if none."""
    for description, value in KNOWN.items():
        if abs(constant / value - 1) < _FACTOR_RTOL:
            return description
        if abs(constant / (1 / value) - 1) < _FACTOR_RTOL:
            return f"the inverse of {description}"
    return ""


def _edit(target: _Target, constant: float) -> Edit:
    """Return the edit that puts a constant in, described with its value."""
    if target.operation == REPLACED:
        text = f"{target.description} is always {constant:.7g}"
        return Edit("", target.sides(constant), FITTED, text)
    known = _nearest_known(constant) if target.operation == FACTOR else ""
    change = "multiplied by" if target.operation == FACTOR else "increased by"
    text = f"{target.description}: {change} {constant:.7g}" + (f" ({known})" if known else "")
    return Edit(target.title, target.sides(constant), FITTED, text)
