"""One rule: a number agrees within the rounding of a careful program, or half its last digit.

The rounding allowed is a first-order bound of the forward error (Bauer 1974; Miller and Spooner
1978): each input and each statement of the reference is changed by one unit in its last place, and
the changes of a result are added up, `SAFETY` times. The bound is the same in all systems of units.
A difference beyond it and up to `LOST_DIGITS` of the scene's largest velocity (spin, energy ...) is
rounding of a program that loses digits: it is reported, and no mistake is looked for. What
elimination may lose in a scene is bounded by Skeel's condition number of its equations.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanics.solve import solve
from ..names import (
    ENERGY,
    IMPULSE,
    NUMBER,
    PERCENT,
    RESULTS,
    SPIN,
    TURNING,
    VELOCITY,
)
from .evaluation import Floats, Program
from .spellings import COLUMNS, COMPARED, VELOCITIES

Bools = NDArray[np.bool_]
SAFETY = 4.0  # roundings of a result's own operations, and those that a spelling orders otherwise
LOST_DIGITS = 1e-10  # of the scene's size: 10 digits are what any method for 6 unknowns keeps
EPSILON = 2.0**-52
STEP = 2.0**-30  # of a change whose effect is scaled to one unit in the last place
STRIP = 4096  # scenes at a time: about a hundred arrays stay in the cache
LARGEST_BODY = 1e200  # in place of an infinite mass, whose products have no value
ELIMINATION_STEPS = 2.0**6  # roundings of an entry of six equations
EXACT = ("degree", "point", "pivot", "stick")
"""Statements without rounding of their own: pi / 180 rounds with the angles."""
IMPULSES = {"PN": "Pn", "PT": "Pt", "PM": "Pm"}
"""Results that follow from the velocities, and the impulses that the velocities follow from."""
NO_ANSWER_NEEDED = 32 | 64  # bits of STATUS: nearly singular, not finite


@dataclass(frozen=True)
class Reference:
    """Results of scenes, by name.

    ``bounds`` is what rounding may change in each; ``scales`` is the scene's largest quantity of
    the kind; ``ties``: scenes where rounding decides which way the contact slides, whose results
    the other way are ``alternatives``; ``optional``: scenes that a program may refuse.
    """

    values: Mapping[str, Floats]
    bounds: Mapping[str, Floats]
    scales: Mapping[str, Floats]
    ties: Bools
    alternatives: Mapping[str, Floats]
    optional: Bools


def by_strips(
    function: Callable[[Mapping[str, Floats], Sequence[str]], dict[str, Any]],
    scene: Mapping[str, Floats],
    names: Sequence[str],
) -> dict[str, Any]:
    """Return the columns that a function of scenes and names has, computed a strip at a time."""
    starts = range(0, max(len(scene["UX"]), 1), STRIP)
    strips = [{name: scene[name][start : start + STRIP] for name in COLUMNS} for start in starts]
    parts = [function(strip, names) for strip in strips]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


@np.errstate(all="ignore")
def reference(scene: Mapping[str, Floats], names: Sequence[str] = COMPARED) -> Reference:
    """Return the results of scenes, with what rounding may change in them.

    Parameters
    ----------
    scene : mapping of str to ndarray
        The columns of the scenes.
    names : sequence of str
        Results wanted.

    Returns
    -------
    Reference
        Arrays with a value for each scene.
    """
    sizes = ("KI", "KF", "LOSS", "PN", "PT", "PM", "MUC")
    values = solve(scene, [*dict.fromkeys([*names, *VELOCITIES, *sizes]), "STATUS"])
    bounds = by_strips(_rounding_effects, scene, names)
    ties = bounds.pop("ties")
    reversed_friction = {**scene, "MU": np.where(scene["MU"] == -10.0, scene["MU"], -scene["MU"])}
    status = values.pop("STATUS").astype(int)
    return Reference(
        values,
        bounds,
        _scales(scene, values),
        ties,
        solve(reversed_friction, names) if ties.any() else values,
        (status & NO_ANSWER_NEEDED) > 0,
    )


def _finite(scene: Mapping[str, Floats]) -> dict[str, Floats]:
    """Return scenes with large bodies in place of infinite ones."""
    bodies = ("MA", "MB", "IA", "IB")
    return {n: np.minimum(c, LARGEST_BODY) if n in bodies else c for n, c in scene.items()}


def _rounding_effects(scene: Mapping[str, Floats], names: Sequence[str]) -> dict[str, Any]:
    """Return the bounds of results, and the "ties" that rounding of the sliding velocity makes."""
    impulses = {name: impulse for name, impulse in IMPULSES.items() if name in names}
    outputs = (*names, "slide", *impulses.values())
    program = Program("impulses", _finite(scene), wanted=outputs)
    base = program.base
    targets = [s.target for s in program.statements if s.target not in EXACT]
    moves = {target: base[target] * (1 + STEP) for target in (*COLUMNS[:-1], *targets)}
    moves["MU"] = np.where(base["MU"] == -10.0, base["MU"], moves["MU"])
    sums = program.effects(({target: value} for target, value in moves.items()), outputs)
    for name, impulse in impulses.items():  # a program may have it from either
        sums[name] = np.fmax(sums[name], sums.pop(impulse))
    bounds: dict[str, Any] = {n: total * SAFETY * EPSILON / STEP for n, total in sums.items()}
    return {**bounds, "ties": np.abs(base["slide"]) <= bounds.pop("slide")}


def _scales(scene: Mapping[str, Floats], values: Mapping[str, Floats]) -> dict[str, Floats]:
    """Return the largest quantity of each result's kind in each scene."""

    def largest(*columns: Any) -> Any:
        return reduce(np.fmax, [np.abs(column) for column in columns])

    before = [scene[name] for name in ("UX", "UY", "VX", "VY")]
    impulse = np.hypot(values["PN"], values["PT"])
    kinds = {
        VELOCITY: largest(*before, *(values[name] for name in VELOCITIES[:4])),
        SPIN: largest(scene["WA"], scene["WB"], values["WAF"], values["WBF"]),
        IMPULSE: impulse,
        TURNING: largest(values["PM"], impulse * scene["DA"], impulse * scene["DB"]),
        NUMBER: largest(1.0, values["MUC"]),
        ENERGY: largest(values["KI"], values["KF"]),
        PERCENT: largest(100.0, values["LOSS"]),
    }
    size = len(scene["UX"])
    return {name: np.broadcast_to(kinds[RESULTS[name].unit], size) for name in values}


@np.errstate(all="ignore")
def elimination_bounds(scene: Mapping[str, Floats], names: Sequence[str]) -> dict[str, Floats]:
    """Return what rounding may change in results where elimination finds the velocities.

    Notes
    -----
    Skeel's bound ``|A^-1| (|A| |x| + |b|)`` of Equations 13-18, `ELIMINATION_STEPS` roundings.
    Where one body is far heavier, elimination in a bad order loses as many digits more as their
    masses or inertias differ by.
    """
    return by_strips(_elimination_effects, scene, names)


def _elimination_effects(scene: Mapping[str, Floats], names: Sequence[str]) -> dict[str, Floats]:
    """Return what elimination may change in velocities, and by them in other results."""
    program = Program("equations", scene, wanted=VELOCITIES)
    base = program.base
    matrix, right = (array[0] for array in program.system())
    solution = np.array([base[name] for name in VELOCITIES]).T
    good = np.isfinite(matrix.sum((-2, -1))) & np.isfinite(solution).all(-1)
    inverse = np.linalg.inv(np.where(good[:, None, None], matrix, np.eye(6)))
    terms = np.abs(matrix) @ np.abs(solution)[..., None] + np.abs(right)[..., None]
    ratios = [base["MA"] / base["MB"], base["ia"] / base["ib"]]
    disparity = np.max([*ratios, *(1 / ratio for ratio in ratios)], 0)
    speed = np.abs(solution[:, :4]).max(1)
    spin = np.abs(solution[:, 4:]).max(1)
    # a spin is found beside the angular momentum of the mass centres
    spins = [
        np.fmax(spin, base[mass] * np.abs(base[arm]) * speed / base[inertia])
        for mass, arm, inertia in (("MA", "da", "ia"), ("MB", "db", "ib"))
    ]
    sizes = np.array([speed, speed, speed, speed, *spins])
    bounds = ((np.abs(inverse) @ terms)[..., 0].T + disparity * sizes) * ELIMINATION_STEPS * EPSILON
    bounds[:, ~good] = np.nan
    program = Program("impulses", _finite(scene), wanted=names)
    moves = ({n: program.base[n] + b} for n, b in zip(VELOCITIES, bounds, strict=True))
    return program.effects(moves, names)
