"""Other programs, as far as they can be imagined: the impact equations with something wrong.

A program with a mistake reads the scene in its own way, fills the 6 by 6 matrix of the listing's
lines 370 to 560 with something changed, solves it, and shows the results in its own way
(`slip.Slip`). Many such programs are run over the same scenes at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..accuracy.elimination import ORDER, fill, lapack
from ..closedform.solve import solve
from ..names import FINAL_VELOCITIES, SCENE
from ..reconstruction.geometry import Geometry
from ..reconstruction.outcome import outcome

if TYPE_CHECKING:
    from .slip import Slip

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Columns = dict[str, Floats]

AT_ONCE = 60_000
"""Matrices solved together."""
_EQUILIBRATING_ROUNDS = 3


def used_friction(scene: Columns) -> Floats:
    """MU with the sign line 400 leaves it, -10 for a pivot."""
    with np.errstate(all="ignore"):
        return np.asarray(solve(scene, "MUP")["MUP"], float)


def matrices(scene: Columns) -> tuple[Floats, Floats]:
    """The matrices (n, 6, 6) and right-hand sides (n, 6) of scenes; point masses (M = 4) are
    bodies without arms that a moment does not turn."""
    point = scene["M"] == 4
    changed = {**scene}
    for name, value in (("DA", 0.0), ("DB", 0.0), ("EM", 1.0), ("IA", 1.0), ("IB", 1.0)):
        changed[name] = np.where(point, value, scene[name])
    with np.errstate(all="ignore"):
        return fill(changed)


def plain_condition(scene: Columns) -> Floats:
    """The condition numbers (largest row sum) of the matrices as they stand; infinite where there
    is no finite one."""
    matrix, _ = matrices(scene)
    usable = _usable(matrix)
    inverse = np.linalg.inv(np.where(usable[:, None, None], matrix, np.eye(6)))
    with np.errstate(all="ignore"):
        condition = np.abs(matrix).sum(2).max(1) * np.abs(inverse).sum(2).max(1)
    return np.where(usable & np.isfinite(condition), condition, np.inf)


def _usable(matrix: Floats) -> Bools:
    """Where a matrix is finite and no pivot of it is exactly 0."""
    with np.errstate(all="ignore"):
        finite = np.asarray(np.isfinite(matrix).all(axis=(1, 2)))
        signs, _ = np.linalg.slogdet(np.where(finite[:, None, None], matrix, np.eye(6)))
    usable: Bools = finite & (signs != 0)
    return usable


def run(programs: Sequence[Sequence[Slip]], scene: Columns) -> list[Columns]:
    """The results of programs, each with its slips, on scenes (columns of one length): for each
    the columns of every result but COND, STATUS, MUC. NaN where there is none."""
    count = scene["M"].size
    step = max(1, AT_ONCE // max(count, 1))
    results: list[Columns] = []
    for at in range(0, len(programs), step):
        results += _run(programs[at : at + step], scene, count)
    return results


def _run(programs: Sequence[Sequence[Slip]], scene: Columns, count: int) -> list[Columns]:
    with np.errstate(all="ignore"):
        seen = [_as_read(slips, scene) for slips in programs]
        whole = {name: np.concatenate([one[name] for one in seen]) for name in SCENE}
        matrix, right = matrices(whole)
        parts = [slice(at * count, (at + 1) * count) for at in range(len(programs))]
        for slips, part in zip(programs, parts, strict=True):
            for slip in slips:
                if slip.equations:
                    mine = {name: column[part] for name, column in whole.items()}
                    slip.equations(matrix[part], right[part], mine)
        unknowns = _solved(matrix, right)
        results = _consequences(whole, unknowns)
        solved = []
        for slips, part in zip(programs, parts, strict=True):
            shown = {name: column[part] for name, column in results.items()}
            for slip in slips:
                shown |= slip.results(shown, scene)
            solved.append(shown)
    return solved


def _as_read(slips: Sequence[Slip], scene: Columns) -> Columns:
    """The scene as a program with these slips takes it."""
    seen = dict(scene)
    for slip in sorted(slips, key=lambda one: one.late):
        seen |= slip.scene(seen)
    return seen


def _solved(matrix: Floats, right: Floats) -> Columns:
    """The unknowns, rows and columns scaled first so that rounding plays no part."""
    usable: Bools = _usable(matrix) & np.isfinite(right).all(1)
    matrix = np.where(usable[:, None, None], matrix, np.eye(6))
    columns = np.ones((len(matrix), 6))
    right = np.where(usable[:, None], right, np.nan)
    for _ in range(_EQUILIBRATING_ROUNDS):
        by_row = np.abs(matrix).max(2)
        matrix, right = matrix / by_row[:, :, None], right / by_row
        by_column = np.abs(matrix).max(1)
        matrix, columns = matrix / by_column[:, None, :], columns / by_column
    solution = _each(matrix, right) * columns
    return {name: solution[:, place] for place, name in enumerate(ORDER)}


def _each(matrix: Floats, right: Floats) -> Floats:
    """The solutions, NaN only where LAPACK finds a zero pivot: it then solves none of those it was
    given, so they are halved until the matrix stands alone."""
    solution = lapack(matrix, right)
    if len(matrix) > 1 and np.isnan(solution).all() and not np.isnan(right).all():
        middle = len(matrix) // 2
        halves = (slice(None, middle), slice(middle, None))
        solution = np.concatenate([_each(matrix[half], right[half]) for half in halves])
    return solution


def _consequences(scene: Columns, solved: Columns) -> Columns:
    """What follows from the final velocities by definition."""
    geometry = Geometry.of(scene)
    velocities: dict[str, Any] = {name: solved[name] for name in FINAL_VELOCITIES}
    coefficients = ("E", "EM", "MU")  # without them `outcome` does not solve anything again
    results = outcome({**{n: c for n, c in scene.items() if n not in coefficients}, **velocities})
    results = {name: np.asarray(column, float) for name, column in results.items()}
    dax, day = solved["VAX"] - scene["UX"], solved["VAY"] - scene["UY"]
    results["PN"] = scene["MA"] * (geometry.cosine * dax + geometry.sine * day)
    results["PT"] = scene["MA"] * (geometry.cosine * day - geometry.sine * dax)
    moment = scene["IA"] * (solved["WAF"] - scene["WA"])
    moment -= geometry.an * results["PN"] + geometry.at * results["PT"]
    results["PM"] = np.where(geometry.point, 0.0, moment)
    results["MUP"] = used_friction(scene)
    return {**velocities, **results}
