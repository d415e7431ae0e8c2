"""Bound, row by row, the difference that rounding can make between a correct program's results and
ours.

A program counts as correct if its results lie within the rounding errors of any of the
spellings of the mechanics: a running error bound of their statements, and of eliminating their
equations with the row's own factors (`equations.roundoff`); along any axes, and with B's velocity
computed from A's change, or A's from B's. That by trial impulses, which loses far more, has a bound
of its own. No bound takes a norm over quantities
of different kinds, so none depends on the units of length and mass any more than elimination does.
The errors of our own results are added.
"""

from collections.abc import Collection, Mapping

import numpy as np
from numpy.typing import NDArray

from ...equations.evaluation import evaluate
from ...equations.roundoff import Bounded, running_errors
from ...equations.spelling import (
    A_IMPULSE,
    IMPULSES,
    LISTING,
    TRIAL_IMPULSES,
    parse_expression,
    spelling_of,
    spellings,
)
from ...mechanics.accuracy import errorbound
from ...names import FINAL_VELOCITIES, PIVOT, RESULTS

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Columns = Mapping[str, Floats]

_SPELLED = {"VC": "gn", "VS": "gn"}
"""Result -> name with the same bound in the contact impulses (VS is E times VC)."""
_BY_MOMENTUM = {
    "VAX": ("UX", "MB/MA", "VBX", "VX"),
    "VAY": ("UY", "MB/MA", "VBY", "VY"),
    "VBX": ("VX", "MA/MB", "VAX", "UX"),
    "VBY": ("VY", "MA/MB", "VAY", "UY"),
}
"""Final velocity = initial one - ratio of masses * (other body's final - initial one)."""
_VECTORS = (
    ("VAX", "VAY"),
    ("VBX", "VBY"),
    ("XAF", "YAF"),
    ("XBF", "YBF"),
    ("PN", "PT"),
)
"""Components of one vector: a program may have computed it along other axes."""
_RATIO_ROUNDINGS = (
    4.0  # of a ratio of masses times a difference of velocities, in units of roundoff
)
_OWN_EQUATIONS_MARGIN = 4.0
"""A correct program may combine the equations, and order their elimination, as no spelling does. By
columns as Fortran does, with moments about the contact point, one in 1,600 scenes was off by more
than the bound of any spelling, by 1.7 times at most."""


def best_error_bounds(
    scene: Columns, ours: Columns, sizes: Columns
) -> tuple[dict[str, Floats], Bools]:
    """Return the largest differences from ours of results by contact impulses in closed form, by
    name; and the rows in which rounding decides which way the contact slides."""
    errors = running_errors(spelling_of(IMPULSES), scene)
    bounds = {
        name: 2 * bound + 2 * np.spacing(np.abs(ours[name]))
        for name, bound in _result_bounds(scene, errors).items()
    }
    # this form of the equations gives NaN where a mass is infinite
    relative = errorbound.relative_bounds(ours["COND"])
    for name, bound in bounds.items():
        bounds[name] = np.where(np.isnan(bound), relative * sizes[name], bound)
    sliding, error = errors["gt"]
    is_open = np.abs(sliding) <= error * errorbound.DOUBLE
    return bounds, is_open & (scene["MU"] != PIVOT) & (scene["MU"] != 0)


def largest_error_bounds(
    scene: Columns, ours: Columns, sizes: Columns, best: Columns, wanted: Collection[str]
) -> dict[str, Floats]:
    """Return the largest differences from ours of results by any spelling, by name.

    ``best``: the bounds of `best_error_bounds`; ``wanted``: results; the final velocities are
    always among those returned.
    """
    bounds = {name: bound / 2 for name, bound in best.items()}
    for spelling in spellings().values():
        if spelling.title not in (IMPULSES, TRIAL_IMPULSES):
            own_bounds = _result_bounds(scene, running_errors(spelling, scene))
            bounds = {name: np.fmax(bound, own_bounds[name]) for name, bound in bounds.items()}
    if "MUC" in wanted:
        bounds["MUC"] = np.fmax(bounds["MUC"], _critical_friction_bounds(scene))
    for pair in _VECTORS:
        bounds |= dict.fromkeys(pair, np.fmax(*(bounds[name] for name in pair)))
    by_momentum = {
        name: bounds[name] + _momentum_bounds(name, scene, ours, bounds) for name in _BY_MOMENTUM
    }
    bounds |= {name: np.fmax(bounds[name], bound) for name, bound in by_momentum.items()}
    # the other results follow from velocities with these errors
    known = {name: (ours[name], bounds[name] / errorbound.DOUBLE) for name in FINAL_VELOCITIES}
    own_bounds = _result_bounds(scene, running_errors(spelling_of(IMPULSES), scene, known))
    bounds = {name: np.fmax(bound, own_bounds[name]) for name, bound in bounds.items()}
    if missing := [name for name in wanted if np.isnan(own_bounds[name]).all()]:
        relative = [bounds[name] / sizes[name] for name in FINAL_VELOCITIES]
        largest = np.max(np.where(np.isfinite(relative), relative, 0.0), 0)
        bounds |= {name: np.fmax(bounds[name], largest * sizes[name]) for name in missing}
    return {
        name: _OWN_EQUATIONS_MARGIN * bounds[name] + best[name] / 2
        for name in {*wanted, *FINAL_VELOCITIES}
    }


def trial_bounds(scene: Columns, ours: Columns) -> dict[str, Floats]:
    """Return the bounds of a program that finds its equations by trial impulses, by name: what a
    unit impulse changes is lost beside a large velocity. NaN for results that it lacks."""
    errors = running_errors(spelling_of(TRIAL_IMPULSES), scene)
    bounds = _result_bounds(scene, errors)
    return {name: bound + 2 * np.spacing(np.abs(ours[name])) for name, bound in bounds.items()}


# what makes a scene ordinary
_MAX_CONDITION = 1e3
_MAX_MASS_RATIO = 100.0
_MAX_INERTIA_RATIO = 1e3
_MAX_ARM = 10.0  # in radii of gyration
_MIN_DISTANCE_FROM_HALF = 0.05  # of e_m, at 1/2 of which the moment has no solution
ORDINARY_BOUND = 1e-9
"""Relative difference that no bound of an ordinary scene reaches; among 40,000 the largest was
a sixth of it."""


def is_ordinary(scene: Columns, condition: Floats) -> Bools:
    """Return the rows in which no correct program's results are `ORDINARY_BOUND` from ours."""
    with np.errstate(all="ignore"):
        bodies, ia, ib = scene["M"] != 4, scene["IA"], scene["IB"]
        masses, inertias = scene["MA"] / scene["MB"], np.where(bodies, ia / ib, 1.0)
        is_usual = (scene["MA"] > 0) & (condition < _MAX_CONDITION) & (scene["MU"] != PIVOT)
        for ratio, largest in ((masses, _MAX_MASS_RATIO), (inertias, _MAX_INERTIA_RATIO)):
            is_usual &= (ratio <= largest) & (ratio * largest >= 1)
        for mass, arm, inertia in (("MA", "DA", ia), ("MB", "DB", ib)):
            largest_moment = _MAX_ARM**2 * inertia
            is_usual &= ~bodies | (scene[mass] * scene[arm] ** 2 <= largest_moment)
        is_usual &= ~bodies | (np.abs(scene["EM"] - 0.5) >= _MIN_DISTANCE_FROM_HALF)
    return np.asarray(is_usual)


def _result_bounds(scene: Columns, errors: Mapping[str, Bounded]) -> dict[str, Floats]:
    """Return the error bounds of results, NaN for those that a spelling does not compute."""
    count = len(next(iter(scene.values())))
    bounds = {}
    for name in RESULTS:
        _, error = errors.get(_SPELLED.get(name, name), (0.0, np.nan))
        bounds[name] = np.broadcast_to(error, (count,)) * errorbound.DOUBLE
    return bounds


def _critical_friction_bounds(scene: Columns) -> Floats:
    """Return the error bound of PT/PN where the pivot's equations are solved by elimination."""
    pivots = {**scene, "MU": np.full_like(scene["MU"], PIVOT)}
    bounds = []
    for title in (LISTING, A_IMPULSE):
        errors = running_errors(spelling_of(title), pivots)
        (pn, pn_error), (pt, pt_error) = errors["PN"], errors["PT"]
        bounds.append((pt_error + np.abs(pt / pn) * pn_error) / np.abs(pn))
    return np.asarray(np.fmax(*bounds) * errorbound.DOUBLE)


def _momentum_bounds(name: str, scene: Columns, ours: Columns, bounds: Columns) -> Floats:
    """Return the error bound of a final velocity computed from the other body's change."""
    initial, ratio, other_final, other_initial = _BY_MOMENTUM[name]
    masses = np.asarray(evaluate(parse_expression(ratio), scene))
    size = np.abs(ours[other_final]) + np.abs(scene[other_initial])
    unit = _RATIO_ROUNDINGS * errorbound.DOUBLE
    return masses * (bounds[other_final] + unit * size) + unit * np.abs(scene[initial])
