"""Bounds of the errors of results, and their sensitivity to the scene's numbers.

`FACTOR` times condition (`COND`) times unit roundoff is an estimate of errors relative to the
largest velocity about, and no bound: COND does not know the rounding of angles. In 100 scenes of
each population of the benchmark's table no error of the closed form was above an eighth of it; with
EM next to 1/2 spins were off by 2.6 times the estimate, with inertias 1e-12 of a car's by 3.5. The
listing's elimination keeps to it as long as no pivot falls to its absolute 1E-9. What bounds each
result is `result_bounds`: `CLOSED_FORM` times its own `movements`, and what its terms are off where
it is a sum that cancels.

The condition of the six equations does not bound how far final velocities move when the numbers do:
in a sideswipe the approach is a small difference of large velocities. A method is backward stable
when its error is a small multiple of the unit roundoff times that `sensitivity`.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...names import (
    ENERGY,
    FINAL_VELOCITIES,
    IMPULSE,
    PERCENT,
    PIVOT,
    RESULTS,
    SPIN,
    SPINS,
    TURNING,
    VELOCITY,
)
from ..closedform.solve import solve
from .runningerror import UNIT, listing_errors

Floats = NDArray[np.float64]

CLOSED_FORM = 64.0
"""Error of the closed form, in roundings of each number of a scene at their worst: twice the most
seen in 10^5 scenes of each of the benchmark's populations and of arms 10^±6 times a
car's (26, of pivots with unrelated masses; 8 of others)."""
DOUBLE = 2.0**-53
"""Unit roundoff of 53 bits: the largest relative change by rounding."""
APPLESOFT = UNIT
FACTOR = 16.0
"""Largest error seen over captured and generated scenes: 1.4 in velocities, 11 in spins."""
STEP = 2.0**-36
"""Relative change of a number: far above rounding, far below the nearest singularity tried. With
one twice as large a sensitivity changes by 2e-6, at most by 3e-5; next to singularities by 2 %."""

_SPEEDS = ("UX", "UY", "VX", "VY", "VAX", "VAY", "VBX", "VBY")
_GROUPS = (FINAL_VELOCITIES[:4], FINAL_VELOCITIES[4:])


def relative_bounds(condition: Any, unit: float = DOUBLE) -> Floats:
    """Return `FACTOR` times condition times ``unit``, an estimate of errors and no bound."""
    condition = np.asarray(condition, float)
    return np.asarray(FACTOR * unit * np.maximum(np.nan_to_num(condition, nan=np.inf), 1.0))


def oracle_bounds(
    scenes: Sequence[Mapping[str, str]], columns: Mapping[str, Any], solved: Mapping[str, Any]
) -> tuple[list[float], list[float]]:
    """Return error bounds of the final velocities and spins for each scene: of the closed form in
    double precision, and of the listing. They are relative to `scales`; infinite where unknown.

    The first is `CLOSED_FORM` times what rounding every number of the scene to a double does
    (`movements`); the second a running error bound (`accuracy.runningerror`).
    ``scenes``: the texts; ``columns``: their numbers, arrays of n; ``solved``: `impact88.solve`'s.
    """
    sizes = scales(columns, solved)
    change = movements(columns)
    with np.errstate(over="ignore", invalid="ignore"):
        double = {
            name: DOUBLE * (CLOSED_FORM * change[name] + abs(solved[name])) for name in change
        }
    listing = {name: np.full(len(scenes), np.inf) for name in FINAL_VELOCITIES}
    for i, scene in enumerate(scenes):
        errors = listing_errors(scene, {name: float(solved[name][i]) for name in FINAL_VELOCITIES})
        for name, error in (errors or {}).items():
            listing[name][i] = error
    return _shares(double, sizes), _shares(listing, sizes)


def _shares(errors: Mapping[str, Floats], sizes: Mapping[str, Floats]) -> list[float]:
    """Return each scene's largest error relative to its size; 0/0 is 0."""
    with np.errstate(all="ignore"):
        shares = [np.where(e == 0, 0.0, e / sizes[name]) for name, e in errors.items()]
    largest = np.max(shares, axis=0)
    bounds: list[float] = np.where(np.isnan(largest), np.inf, largest).tolist()
    return bounds


def scales(scene: Mapping[str, Any], solved: Mapping[str, Any]) -> dict[str, Floats]:
    """Return, for each result, the size its errors are relative to, scene by scene.

    ``scene`` and ``solved`` are columns of n; ``solved`` holds every result of `impact88.solve`.
    Energies and impulses are made of two velocities, so they count twice.
    """
    with np.errstate(all="ignore"):
        value = {**scene, **solved}
        point = np.asarray(scene["M"], float) == 4
        arm = np.where(point, 0.0, np.fmax(np.abs(scene["DA"]), np.abs(scene["DB"])))
        spin = _largest(value, SPINS)
        speed = np.fmax(_largest(value, _SPEEDS), arm * spin)
        spin = np.fmax(spin, np.where(arm > 0, speed / np.where(arm > 0, arm, 1.0), 0.0))
        mass = np.fmax(_finite(scene["MA"]), _finite(scene["MB"]))
        inertia = np.fmax(_finite(scene["IA"]), _finite(scene["IB"]))
        energy = np.fmax(np.abs(solved["KI"]), np.abs(solved["KF"]))
        normal = solve({**scene, "MU": PIVOT}, ["PN"])["PN"]
        by_unit = {
            VELOCITY: speed,
            SPIN: spin,
            IMPULSE: 2 * mass * speed,
            TURNING: 2 * np.fmax(inertia * spin, mass * speed * arm),
            ENERGY: 2 * energy,
            PERCENT: 200 * energy / np.abs(solved["KI"]),  # of the energy before
            "bits": speed,  # never asked for
        }
        size = {"WA": spin, "WB": spin}
        for name, row in RESULTS.items():
            # the error of a mere number is relative to itself
            size[name] = by_unit[row.unit] if row.unit in by_unit else np.abs(solved[name])
        # a ratio of two impulses: its errors are theirs, divided by the pivot's normal one
        size["MUC"] = 2 * mass * speed * (1 + np.abs(solved["MUC"])) / np.abs(normal)
        return {name: np.nan_to_num(column) for name, column in size.items()}


def _largest(value: Mapping[str, Any], names: tuple[str, ...]) -> Floats:
    columns = [np.abs(np.asarray(value[name], float)) for name in names]
    return np.asarray(np.fmax.reduce(np.broadcast_arrays(*columns)), float)


def _finite(column: Any) -> Floats:
    values = np.asarray(column, float)
    return np.where(np.isfinite(values), np.abs(values), 0.0)


def movements(
    columns: Mapping[str, Any], outputs: Sequence[str] = FINAL_VELOCITIES
) -> dict[str, Floats]:
    """Return, for each output and scene, its change per relative change of all numbers of the scene
    at their worst: the sum of the absolute central differences over the numbers, infinite or NaN
    past the range of doubles."""
    with np.errstate(over="ignore", invalid="ignore"):
        return _movements(columns, outputs)


def _movements(columns: Mapping[str, Any], outputs: Sequence[str]) -> dict[str, Floats]:
    sums = {name: np.zeros(()) for name in outputs}
    for name, values in columns.items():
        values = np.asarray(values, np.float64)
        if name == "M":
            continue
        # a pivot's MU is a code, not a number to vary
        step = np.where(values == PIVOT, 0.0, STEP) if name == "MU" else STEP
        upper = solve({**columns, name: values * (1 + step)}, outputs)
        lower = solve({**columns, name: values * (1 - step)}, outputs)
        for result in outputs:
            change = np.abs(upper[result] - lower[result]) / (2 * STEP)
            sums[result] = sums[result] + change
    return sums


def result_bounds(columns: Mapping[str, Any]) -> dict[str, Floats]:
    """Return a bound of the error of each result by the closed form, in its own unit.

    Parameters
    ----------
    columns : mapping of str to array_like
        Scene name -> numbers, as `impact88.solve` takes them, M among them.

    Returns
    -------
    dict of str to ndarray
        For every result but COND (an estimate) and STATUS (bits): a bound of its absolute error;
        infinite or NaN where there is none.

    Notes
    -----
    A running error bound by results: what is computed at once is off by `CLOSED_FORM` roundings of
    each number of the scene at their worst and of itself; what is a sum of results by what these
    are off together. A velocity also counts the roundings of the one before, a spin those of the
    one before times COND: where a body with a large inertia keeps its spin and friction is next to
    what makes the equations singular, WBF was off by 190 of its own roundings (COND 2040).

    Movements are central differences with steps of 2**-36. Where the equations are singular within
    a step, they say too little, and this is no bound: seen once under evolution, with IA 2e-9 and
    an arm's angle 5e-12 degrees from where friction's arm vanishes.
    """
    names = [name for name in RESULTS if name not in ("COND", "STATUS")]
    g = {name: np.asarray(x, np.float64) for name, x in columns.items()}
    with np.errstate(all="ignore"):
        f, change = solve(columns, [*names, "COND"]), movements(columns, names)
        unit = CLOSED_FORM * DOUBLE
        bound: dict[str, Floats] = {n: unit * (change[n] + np.abs(f[n])) for n in names}
        initial = {"VAX": "UX", "VAY": "UY", "VBX": "VX", "VBY": "VY"}
        initial_of_other = {"VAX": "VX", "VAY": "VY", "VBX": "UX", "VBY": "UY"}
        pivot = g["MU"] == PIVOT
        for name, before in initial.items():
            # of a pivot the closed form may go by the common velocity
            common = np.where(pivot, np.abs(g[initial_of_other[name]]), 0.0)
            bound[name] = bound[name] + unit * (np.abs(g[before]) + common)
        point = g["M"] == 4
        for body in "AB":
            # next to a singularity the numerator of a spin that a large inertia keeps cancels, as
            # the determinant does
            spin = np.where(point, 0.0, np.abs(g[f"W{body}"]))
            near_singular = np.where(spin == 0, 0.0, f["COND"] * spin)
            bound[f"W{body}F"] = bound[f"W{body}F"] + 4 * DOUBLE * near_singular
            arm = np.where(point, 0.0, g[f"D{body}"])
            from_spin = np.where(arm == 0, 0.0, np.abs(arm) * bound[f"W{body}F"])
            for axis in "XY":
                bound[f"{axis}{body}F"] = (
                    bound[f"{axis}{body}F"] + bound[f"V{body}{axis}"] + from_spin
                )
        moving = [("MA", "VAX"), ("MA", "VAY"), ("MB", "VBX"), ("MB", "VBY")]
        for inertia, name in (*moving, ("IA", "WAF"), ("IB", "WBF")):
            of_body = np.where(np.isinf(g[inertia]) | (point & (name in SPINS)), 0.0, g[inertia])
            bound["KF"] = bound["KF"] + of_body * bound[name] * (np.abs(f[name]) + bound[name])
        lost = f["LOSS"] / 100 * f["KI"]
        off = bound["ELN"] + bound["ELT"] + bound["ELM"]
        bound["LOSS"] = bound["LOSS"] + 100 * off / f["KI"]
        for name, mass, other in (("EESA", "MA", "MB"), ("EESB", "MB", "MA")):
            part = np.where(np.isinf(g[other]), 2.0, 1.0) / g[mass]
            least, largest = (np.sqrt(part * np.maximum(lost + x, 0.0)) for x in (-off, off))
            bound[name] = bound[name] + (largest - least)
        return {name: np.asarray(bound[name]) for name in names}


def sensitivity(columns: Mapping[str, Any]) -> Floats:
    """Return each scene's largest of `movements`, relative to the largest of its group (the four
    velocities, the two spins); at least 1."""
    present = solve(columns, FINAL_VELOCITIES)
    movement = movements(columns)
    worst = np.ones_like(present["VAX"])
    for group in _GROUPS:
        scale = np.max([np.abs(present[name]) for name in group], axis=0)
        change = np.max([movement[name] for name in group], axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):
            worst = np.fmax(worst, change / scale)
    return worst
