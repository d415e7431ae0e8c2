"""Scenes that lack inputs: the results that do not use them, and what the others need.

An input is not used where any value of it gives the same result. So every scene is solved with
several values in place of what it lacks: a result that is the same for all of them stands. Nothing
is judged by such a value: of STATUS the laws count that all of them break, which include opposite
contact planes.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...collision.degrees import sin_cos
from ...collision.needs import needs_sentences, ordinary
from ...errors import UserError
from ...names import ANGLE, DEFAULT_M, LENGTH, PIVOT, SCENE, SPIN, VELOCITY, quantity
from ...status import IMPOSSIBLE, Status
from .columns import BODIES, UNUSED_BY_POINTS
from .general import solve_arrays

Array = NDArray[Any]
Solve = Callable[[Mapping[str, Any], Sequence[str]], Mapping[str, Array]]

TRIALS = 24  # values of each input that is not given; directions are 15 degrees apart
SPECIAL = {"E": (0.0, 1.0), "MU": (0.0, PIVOT), "EM": (0.0, 1.0)}
OUTWEIGHING = np.array([100.0, -100.0, 1000.0, -1000.0])
SAME = 1e-9  # relative difference of results that are the same but for rounding
ROUNDING = 1e-12  # the same relative to the largest result of its unit
PARALLEL = 1e-11  # sine of the angle between directions along one line
COMPONENTS = ("UX", "UY", "VX", "VY")
_JUDGED = IMPOSSIBLE | Status.NOT_FINITE | Status.SINGULAR | Status.MU_OUT_OF_RANGE


class Results(dict[str, Any]):
    """Results by name, without those that need an input that is not given.

    Attributes
    ----------
    absent : dict of str to tuple of str
        The results left out, each with the inputs it needs.
    """

    def __init__(self, values: Mapping[str, Any], absent: Mapping[str, tuple[str, ...]]) -> None:
        super().__init__(values)
        self.absent = dict(absent)

    def __missing__(self, name: str) -> Any:
        if name in self.absent:
            raise KeyError("; ".join(needs_sentences({name: self.absent[name]})))
        raise KeyError(name)


def not_given(columns: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the inputs that scenes lack and that their number of equations has."""
    absent = [name for name in SCENE if name not in columns and name != "M"]
    if absent and "M" in columns:
        m = np.asarray(columns["M"])
        if m.size and bool((m == 4).all()):
            absent = [name for name in absent if name not in UNUSED_BY_POINTS]
    return tuple(absent)


@np.errstate(all="ignore")
def solve_without(
    columns: Mapping[str, Any],
    shares: Array | None,
    lacking: Sequence[str],
    wanted: Sequence[str],
    threads: int | None,
) -> Results:
    """Return the wanted results of scenes that lack inputs, as far as they do not use them.

    Parameters
    ----------
    columns : mapping of str to ndarray
        What is given, in base units.
    shares : ndarray or None
        Of the critical friction, in place of MU, as `general.solve_arrays` takes them.
    lacking : sequence of str
        What is not, see `not_given`.
    wanted : sequence of str
        Names of results.
    threads : int or None
        As in `solve.solve`.

    Raises
    ------
    UserError
        If no wanted result is left.
    """

    def solve(scene: Mapping[str, Any], names: Sequence[str]) -> dict[str, Array]:
        return solve_arrays(scene, tuple(names), threads, shares=shares)

    known = {"M": np.array(float(DEFAULT_M)), **columns}
    rng = np.random.default_rng(1988)
    trials = {name: _trials(name, rng) for name in lacking}
    if "GA" in trials:
        trials["GA"] = [360.0 / TRIALS * trial for trial in range(TRIALS)]
    along = _along_a_line(known, lacking)
    completed = _complete_all(known, trials, along)
    names = [name for name in wanted if name != "STATUS"]
    if len(names) < len(wanted) and "KF" not in names:
        names.append("KF")
    solutions = [solve(scene, names) for scene in completed]
    stands = same_results(solutions[0], solutions[1:], names)
    # one that is not below 0, such as EESA where energy is gained, hides its inputs
    if zeros := [name for name in names if not any(np.any(found[name]) for found in solutions)]:
        ordinary_scenes = _ordinary_scenes(known, shares is not None, rng)
        completed_scenes = _complete_all(ordinary_scenes, trials, np.zeros(()))
        elsewhere = [solve_arrays(scene, tuple(names), threads) for scene in completed_scenes]
        same = same_results(elsewhere[0], elsewhere[1:], zeros)
        stands |= {name: stands[name] & (np.all(same[name]) | along) for name in zeros}
    absent = _inputs_used(
        lacking, completed, solutions[1], [n for n in names if not np.any(stands[n])], solve
    )
    if "KF" in absent:  # an impact that is not known is not judged
        absent["STATUS"] = absent["KF"]
    absent = {name: needs for name, needs in absent.items() if name in wanted}
    if wanted and len(absent) == len(wanted):
        raise UserError("; ".join([f"missing: {' '.join(lacking)}", *needs_sentences(absent)]))
    results = {name: np.where(stands[name], solutions[0][name], np.nan) for name in names}
    if "STATUS" in wanted and "STATUS" not in absent:
        statuses = [solve(scene, ["STATUS"])["STATUS"] for scene in completed]
        results["STATUS"] = _bits_for_all(statuses, along, lacking)
    # a number for an array without dimensions
    return Results({n: np.asarray(results[n])[()] for n in wanted if n not in absent}, absent)


def _bits_for_all(statuses: Sequence[Array], along: Array, lacking: Collection[str]) -> Array:
    """Return the bits of STATUS that hold for all values of what is lacking."""
    # along a line all bits are known, where no more is lacking
    is_known = along & (not {*lacking} - {"GA", "MU"})
    mask = np.where(is_known, np.uint16(0xFFFF), np.uint16(_JUDGED))
    return np.asarray(np.bitwise_and.reduce(statuses) & mask)


def _inputs_used(
    lacking: Sequence[str],
    completed: Sequence[Mapping[str, Any]],
    second: Mapping[str, Array],
    names: Sequence[str],
    solve: Solve,
) -> dict[str, tuple[str, ...]]:
    """Return, for each of the results ``names``, the inputs of which a change alone changes it, all
    that are lacking where none does. ``second``: the results of the second of the ``completed``
    scenes."""
    if not names:
        return {}
    used: dict[str, list[str]] = {result: [] for result in names}
    for name in lacking:
        changes = [solve({**completed[1], name: other[name]}, names) for other in completed[2:5]]
        for result, same in same_results(second, changes, names).items():
            if not np.all(same):
                used[result].append(name)
    return {result: tuple(inputs or lacking) for result, inputs in used.items()}


def _trials(name: str, rng: np.random.Generator) -> list[float]:
    """Return values for an input that is not given: ordinary ones, the special ones of a
    coefficient, and velocities that outweigh any other, so that no sign hides behind them."""
    rule = quantity(name).unit
    values = ordinary(name, rng, TRIALS)
    if rule == ANGLE:
        values = np.asarray(rng.permutation(TRIALS) + rng.uniform(), np.float64) * (360.0 / TRIALS)
    if rule in (VELOCITY, SPIN, LENGTH):
        outweighing = np.abs(values[-4:]) * OUTWEIGHING
        values[-4:] = np.abs(outweighing) if rule == LENGTH else outweighing
    special = SPECIAL.get(name, ())
    values[len(values) - len(special) :] = special
    return [float(value) for value in values]


def _ordinary_scenes(
    given: Mapping[str, Array], has_shares: bool, rng: np.random.Generator
) -> dict[str, Array]:
    """Return ordinary scenes with the special values that are given: zeros, infinite bodies, the
    pivot and no moment. ``has_shares``: the friction is not what MU says."""
    scenes = {}
    for name, value in given.items():
        special = {0.0, np.inf, *SPECIAL.get(name, ())}
        is_kept = name == "M" or (value.size and np.ptp(value) == 0 and value.flat[0] in special)
        is_kept = is_kept or (np.isinf(value).all() and bool(value.size))
        is_kept = is_kept and not (name == "MU" and has_shares)
        scenes[name] = value.flat[0] if is_kept else ordinary(name, rng, 2 * TRIALS)
    return {name: np.asarray(value, np.float64) for name, value in scenes.items()}


def same_results(
    first: Mapping[str, Array], others: Sequence[Mapping[str, Array]], names: Sequence[str]
) -> dict[str, Array]:
    """Return, for each of the results ``names``, where all ``others`` have it as the ``first``."""
    largest: dict[str, Any] = {}
    for name, value in first.items():
        rule = quantity(name).unit
        largest[rule] = np.fmax(largest.get(rule, 0.0), np.abs(value))
    same = {}
    for name in names:
        value = first[name]
        agrees: Any = np.True_
        for other in others:
            size = np.fmax(np.abs(value), np.abs(other[name]))
            limit = SAME * size + ROUNDING * largest[quantity(name).unit]
            apart = np.abs(value - other[name])
            agrees = agrees & ((apart <= limit) | (np.isnan(value) & np.isnan(other[name])))
        same[name] = np.asarray(agrees)
    return same


def _along_a_line(given: Mapping[str, Array], lacking: Collection[str]) -> Array:
    """Return where point masses move along one line, and the contact plane lies across it: there
    is none given, or the given one does."""
    if not {*COMPONENTS} <= given.keys() or _lacks_more(lacking):
        return np.False_  # type: ignore[return-value]
    plane = plane_across(given)
    along = (given["M"] == 4) & np.isfinite(plane)
    if "GA" in given:
        along = along & are_parallel(given["GA"], plane)
    return np.asarray(along)


def _lacks_more(lacking: Collection[str]) -> bool:
    """Return True if more is lacking than motion along one line makes up for."""
    return bool({*lacking} & {*COMPONENTS}) or not {*lacking} & {"GA", "MU"}


def are_parallel(first: Any, second: Any) -> Any:
    """Return where two directions, in degrees, are along one line."""
    return np.abs(sin_cos(np.subtract(first, second))[0]) <= PARALLEL


def plane_across(velocities: Mapping[str, Any]) -> Array:
    """Return GA of a contact plane across the motion of vehicles along one line, against whose
    normal A approaches; NaN where they do not move so. ``velocities``: UX UY VX VY."""
    ux, uy, vx, vy = (velocities[name] for name in COMPONENTS)
    sizes = np.hypot(ux, uy), np.hypot(vx, vy)
    along = np.abs(ux * vy - uy * vx) <= PARALLEL * sizes[0] * sizes[1]
    x, y = ux - vx, uy - vy
    still = (x == 0) & (y == 0)
    x, y = np.where(still, ux, x), np.where(still, uy, y)
    ga = np.degrees(np.arctan2(-y + 0.0, -x + 0.0))
    return np.asarray(np.where(along & (np.fmax(*sizes) > 0), ga, np.nan))


def _complete_all(
    given: Mapping[str, Array], trials: Mapping[str, Sequence[float]], along: Array
) -> list[dict[str, Any]]:
    """Return scenes completed with each of the trial values, see `_complete_scene`."""
    return [
        _complete_scene(given, {name: values[trial] for name, values in trials.items()}, along)
        for trial in range(TRIALS)
    ]


def _complete_scene(
    given: Mapping[str, Array], trial: Mapping[str, float], along: Array
) -> dict[str, Any]:
    """Return scenes with values in place of what they lack: where they move along one line the
    plane across it, and nothing that acts along the plane."""
    scene: dict[str, Any] = {**given, **trial}
    for mass, inertia, velocities, spin in BODIES:  # an infinite body is at rest
        infinite = np.isinf(scene[mass]) | np.isinf(scene.get(inertia, 1.0))
        for name in (*velocities, spin):
            if name in trial and np.any(infinite):
                scene[name] = np.where(infinite, 0.0, trial[name])
    if np.any(along):
        if "GA" in trial:
            scene["GA"] = np.where(along, plane_across(given), trial["GA"])
        free = along if "MU" in trial else along & (np.asarray(scene["MU"]) != PIVOT)
        scene["MU"] = np.where(free, 0.0, scene["MU"])
    return scene
