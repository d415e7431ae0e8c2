"""Fit a constant that has a wrong value: one factor or offset, of one input, statement or result.

It is fitted to all rows and reported as a number, with the known constant that it is near to.
"""

import math
from collections.abc import Iterator
from math import pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...equations.edits import BOOLEAN_NAMES, RARE_CONVENTION, Edit
from ...equations.evaluation import Run
from ...equations.spelling import IMPULSES, LISTING, SHOWN, TYPED, Expression, Sides, spellings
from ...names import SCENE
from .trials import MIN_FIT, Judge, Program, try_program

Floats = NDArray[np.float64]

# operations by which a constant enters
FACTOR = "*"
OFFSET = "+"
_MAX_ITERATIONS = 12
_MAX_MISFIT = 10.0  # in units of the limits; a fit farther off is not run
_STEP = 1e-6  # relative step of the difference quotients
_GROUPS = (
    ("GA", "PA", "PB", "TA", "TB"),
    ("PA", "PB"),
    ("TA", "TB"),
    ("DA", "DB"),
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
        """The constant that changes nothing."""
        return 1.0 if self.operation == FACTOR else 0.0

    def sides(self, constant: float) -> dict[str, Sides]:
        """Return the statements with the constant."""
        if self.operation == FACTOR:
            inverse = 1 / constant if constant else math.inf  # where all results are zero
        else:
            inverse = -constant
        sides: dict[str, Sides] = {}
        for key, side in self.direct.items():
            sides[key] = ((self.operation, side, constant),)
        for key, side in self.inverse.items():
            sides[key] = ((self.operation, side, inverse),)
        return sides


def _targets(title: str, results: Any) -> Iterator[_Target]:
    """Yield every place for a constant in a spelling: its own statements, and for the listing
    inputs and shown ``results``, alone and in groups."""
    spelling = spellings()[title]
    if title == LISTING:
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
                place = f"{line.place}, {line.target} ({line.subject})"
                yield _Target(place, title, operation, {line.target: line.sides[0]}, {})


@np.errstate(all="ignore")
def fit_constants(judge: Judge) -> list[Program]:
    """Return programs with one fitted constant that explain nearly all rows of a small judge; those
    with a known constant come first."""
    programs: list[tuple[bool, bool, int, Program]] = []
    for title in (LISTING, IMPULSES):
        run = Run(spellings()[title], judge.scene)
        results = [name for name in judge.theirs if SHOWN + name in run.names]
        if not results:
            continue
        targets = list(_targets(title, results))
        constants = np.array([target.neutral for target in targets])
        for _ in range(_MAX_ITERATIONS):
            constants = _gauss_newton_step(run, targets, constants, judge)
        # a program takes longer to run: only where the fit is near in enough rows (NaN is near)
        misfits = _misfits(run, targets, constants, judge)
        misfits = misfits.reshape(len(targets), -1, judge.wrong.size)
        near = (~(np.abs(misfits) > _MAX_MISFIT)).all(1) & judge.wrong
        fits = near.sum(1) >= MIN_FIT * judge.wrong.sum()
        for target, constant, fit in zip(targets, constants.tolist(), fits, strict=True):
            if fit and constant != target.neutral and np.isfinite(constant):
                program = Program((_edit(target, constant),))
                trial = try_program(program, judge)
                if trial.is_supported and trial.explained_count >= MIN_FIT * judge.wrong.sum():
                    is_unknown, is_offset = not _nearest_known(constant), target.operation == OFFSET
                    programs.append((is_unknown, is_offset, len(programs), program))
    return [program for *_, program in sorted(programs, key=lambda x: x[:3])]


def _gauss_newton_step(run: Run, targets: list[_Target], constants: Floats, judge: Judge) -> Floats:
    """Return the constants after one step of Gauss-Newton, each fitted by itself."""
    steps = _STEP * np.maximum(np.abs(constants), 1e-3)
    misfits = _misfits(run, targets, constants, judge)
    slopes = (_misfits(run, targets, constants + steps, judge) - misfits) / steps[:, None]
    usable = np.isfinite(slopes) & np.isfinite(misfits)
    slopes, misfits = np.where(usable, slopes, 0.0), np.where(usable, misfits, 0.0)
    # outliers, in which the constant changes a branch, count less
    size = np.abs(misfits)
    weights = 1 / np.maximum(size, np.median(size, 1, keepdims=True) + 1e-300)
    change = (weights * slopes * misfits).sum(1) / (weights * slopes * slopes).sum(1)
    improved = constants - change
    return np.where(np.isfinite(improved) & (change != 0), improved, constants)


def _misfits(run: Run, targets: list[_Target], constants: Floats, judge: Judge) -> Floats:
    """Return the misfits of results in units of their limits, (targets, results times rows)."""
    edits = [
        target.sides(constant) for target, constant in zip(targets, constants.tolist(), strict=True)
    ]
    names = {**run.names, **run.run_edits(edits)}
    shape = (len(targets), judge.wrong.size)
    parts = [
        np.broadcast_to((names[SHOWN + name] - theirs) / judge.limit[name], shape)
        for name, theirs in judge.theirs.items()
        if SHOWN + name in names
    ]
    return np.concatenate(parts, 1)


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
    sign = "×" if target.operation == FACTOR else "+"
    known = _nearest_known(constant) if target.operation == FACTOR else ""
    text = f"{target.description} {sign} {constant:.7g}" + (f": {known}" if known else "")
    return Edit(target.title, target.sides(constant), RARE_CONVENTION, text)
