"""How far rounding may take another program's results from ours: a proved bound, row by row.

A program is right as long as its results are no farther off than rounding may take a correct
program, by any of the nine spellings of the mechanics: a running error bound of its statements, and
of eliminating its equations with that row's own factors (`equations.roundoff`); along any axes, and
with B's velocity from A's change, or A's from B's. No bound takes a norm over unlike quantities, so
that none depends on the units of length and mass beyond what elimination does. What ours are off
comes on top.
"""

from collections.abc import Collection, Mapping

import numpy as np
from numpy.typing import NDArray

from ..mechanics.accuracy import errorbound
from ..names import FINAL_VELOCITIES, PIVOT, RESULTS
from .equations.evaluation import value
from .equations.roundoff import Bounded, running_errors
from .equations.spelling import A_IMPULSE, IMPULSES, LISTING, expression, spelling_of, spellings

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Columns = Mapping[str, Floats]

_ELSEWHERE = {"VC": "gn", "VS": "gn"}
"""Results that contact impulses have under another name, or a share of it (VS is E times VC)."""
_BY_MOMENTUM = {
    "VAX": ("UX", "MB/MA", "VBX", "VX"),
    "VAY": ("UY", "MB/MA", "VBY", "VY"),
    "VBX": ("VX", "MA/MB", "VAX", "UX"),
    "VBY": ("VY", "MA/MB", "VAY", "UY"),
}
"""A final velocity: the initial one, less a ratio of masses times the other's change."""
_VECTORS = (
    ("VAX", "VAY"),
    ("VBX", "VBY"),
    ("XAF", "YAF"),
    ("XBF", "YBF"),
    ("PN", "PT"),
)
"""Components of one vector: a program may have computed it along other axes."""
_RATIO_ROUNDINGS = 4.0
"""What a ratio of masses times a difference of velocities rounds, in units of each of these."""


def of_the_best(scene: Columns, ours: Columns, sizes: Columns) -> tuple[dict[str, Floats], Bools]:
    """Return how far results by contact impulses in closed form may be from ours, name by name;
    and the rows in which rounding decides which way the contact slides."""
    errors = running_errors(spelling_of(IMPULSES), scene)
    least = _by_name(scene, errors)
    least = {name: 2 * bound + 2 * np.spacing(np.abs(ours[name])) for name, bound in least.items()}
    # where a mass is infinite, this form of the equations has no number
    shares = errorbound.relative_bounds(ours["COND"])
    for name, bound in least.items():
        least[name] = np.where(np.isnan(bound), shares * sizes[name], bound)
    sliding, off = errors["gt"]
    undecided = np.abs(sliding) <= off * errorbound.DOUBLE
    return least, undecided & (scene["MU"] != PIVOT) & (scene["MU"] != 0)


def of_any(
    scene: Columns, ours: Columns, sizes: Columns, least: Columns, wanted: Collection[str]
) -> dict[str, Floats]:
    """Return how far results by the spelling that rounding takes farthest may be from ours, name by
    name of those ``wanted``; ``least``: by the best, as `of_the_best` gives it."""
    most = {name: bound / 2 for name, bound in least.items()}
    for spelling in spellings().values():
        if spelling.title != IMPULSES:
            own = _by_name(scene, running_errors(spelling, scene))
            most = {name: np.fmax(bound, own[name]) for name, bound in most.items()}
    if "MUC" in wanted:
        most["MUC"] = np.fmax(most["MUC"], _critical(scene))
    for pair in _VECTORS:
        most |= dict.fromkeys(pair, np.fmax(*(most[name] for name in pair)))
    moved = {name: most[name] + _by_momentum(name, scene, ours, most) for name in _BY_MOMENTUM}
    most |= {name: np.fmax(most[name], bound) for name, bound in moved.items()}
    # the other results, by what the velocities may be off altogether
    given = {name: (ours[name], most[name] / errorbound.DOUBLE) for name in FINAL_VELOCITIES}
    own = _by_name(scene, running_errors(spelling_of(IMPULSES), scene, given))
    most = {name: np.fmax(bound, own[name]) for name, bound in most.items()}
    if unsaid := [name for name in wanted if np.isnan(own[name]).all()]:
        shares = [most[name] / sizes[name] for name in FINAL_VELOCITIES]
        share = np.max(np.where(np.isfinite(shares), shares, 0.0), 0)
        most |= {name: np.fmax(most[name], share * sizes[name]) for name in unsaid}
    return {name: most[name] + least[name] / 2 for name in {*wanted, *FINAL_VELOCITIES}}


def _by_name(scene: Columns, errors: Mapping[str, Bounded]) -> dict[str, Floats]:
    """Return the bounds of results; of those that a spelling does not compute, NaN."""
    count = len(next(iter(scene.values())))
    bounds = {}
    for name in RESULTS:
        _, off = errors.get(_ELSEWHERE.get(name, name), (0.0, np.nan))
        bounds[name] = np.broadcast_to(off, (count,)) * errorbound.DOUBLE
    return bounds


def _critical(scene: Columns) -> Floats:
    """Return what the critical friction is off by where the pivot's equations are eliminated."""
    pivots = {**scene, "MU": np.full_like(scene["MU"], PIVOT)}
    bounds = []
    for title in (LISTING, A_IMPULSE):
        errors = running_errors(spelling_of(title), pivots)
        (normal, off_normal), (across, off_across) = errors["PN"], errors["PT"]
        bounds.append((off_across + np.abs(across / normal) * off_normal) / np.abs(normal))
    return np.asarray(np.fmax(*bounds) * errorbound.DOUBLE)


def _by_momentum(name: str, scene: Columns, ours: Columns, bounds: Columns) -> Floats:
    """Return what the other body's change of velocity, times the ratio of masses, is off by."""
    before, ratio, other, start = _BY_MOMENTUM[name]
    times = np.asarray(value(expression(ratio), scene))
    rounded = np.abs(ours[other]) + np.abs(scene[start])
    whole = times * (bounds[other] + _RATIO_ROUNDINGS * errorbound.DOUBLE * rounded)
    return whole + _RATIO_ROUNDINGS * errorbound.DOUBLE * np.abs(scene[before])
