"""Error bounds of results: 64 movements of the scene.

A result computed with an error of a few times what rounding every number of the scene to a double
does to it (a backward stable one) is as accurate as its scene. `movements` measures that, and
`error_bounds` is `ROUNDINGS` of it. Velocities are measured together, and spins: a small velocity
left of a light body is accurate to the largest velocity, not to its own last digit.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from impact88 import solve
from impact88.mechanics.solve import POINT
from impact88.names import FINAL_VELOCITIES, PIVOT, RESULTS, SPIN, VELOCITY

Floats = NDArray[np.float64]

UNIT = 2.0**-53  # unit roundoff: the largest relative change by rounding to a double
ROUNDINGS = 64.0  # of every number of the scene; eight times the most seen in the six velocities
STEP = 2.0**-36  # relative change: far above rounding, far below the nearest singularity tried
VELOCITY_RESULTS = tuple(name for name, row in RESULTS.items() if row.unit == VELOCITY)
INITIAL_VELOCITIES = ("UX", "UY", "VX", "VY")
INITIAL_SPINS = ("WA", "WB")
SPIN_RESULTS = tuple(name for name, row in RESULTS.items() if row.unit == SPIN)


def movements(
    columns: Mapping[str, ArrayLike], results: Sequence[str] = FINAL_VELOCITIES
) -> dict[str, Floats]:
    """Return how far results move when all numbers of a scene change by their roundings.

    Parameters
    ----------
    columns : mapping of str to array_like
        Scenes, as `solve` takes them.
    results : sequence of str, default the final velocities
        Names of results.

    Returns
    -------
    dict of str to ndarray
        Result name -> its change per relative change of every number of the scene, all at their
        worst: the sum of the absolute central differences. Infinite or NaN beyond doubles.
    """
    scene = {name: np.asarray(values, np.float64) for name, values in columns.items()}
    sums: dict[str, Any] = {name: np.zeros(()) for name in results}
    with np.errstate(over="ignore", invalid="ignore"):
        for name, values in scene.items():
            if name == "M":
                continue
            # the MU of a pivot is a code, no number
            step = np.where((values == PIVOT) & (name == "MU"), 0.0, STEP)
            upper = solve({**scene, name: values * (1.0 + step)}, results)
            lower = solve({**scene, name: values * (1.0 - step)}, results)
            for result in results:
                change = np.abs(upper[result] - lower[result]) / (2.0 * STEP)
                sums[result] = sums[result] + change
    return sums


def error_bounds(
    columns: Mapping[str, ArrayLike], results: Sequence[str] = FINAL_VELOCITIES
) -> dict[str, Floats]:
    """Return a bound of the error of each result of `solve`.

    Parameters
    ----------
    columns : mapping of str to array_like
        Scenes, as `solve` takes them.
    results : sequence of str, default the final velocities
        Names of results, without COND and STATUS.

    Returns
    -------
    dict of str to ndarray
        Result name -> bound of the absolute error, in its own unit.

    Notes
    -----
    `ROUNDINGS` times unit roundoff times the `movements` of the result and its own size; of a
    velocity, or a spin, those of the largest one of the scene. Where the equations are singular
    within a relative step of 2**-36, differences say too little, and this is no bound.
    """
    names = tuple(dict.fromkeys((*results, *FINAL_VELOCITIES)))
    values, change = solve(columns, names), movements(columns, names)
    size = {name: np.fmax(change[name], np.abs(values[name])) for name in names}
    spins = np.asarray(columns.get("M", 6.0)) != POINT
    for group, initial, final in (
        (VELOCITY_RESULTS, INITIAL_VELOCITIES, FINAL_VELOCITIES[:4]),
        (SPIN_RESULTS, INITIAL_SPINS, FINAL_VELOCITIES[4:]),
    ):
        largest = np.max([size[name] for name in final], axis=0)
        for name in initial:
            largest = np.fmax(largest, np.abs(np.asarray(columns[name], np.float64)))
        for name in group:
            if name in size:
                shared = largest if group is VELOCITY_RESULTS else np.where(spins, largest, 0.0)
                size[name] = np.fmax(size[name], shared)
    return {name: ROUNDINGS * UNIT * size[name] for name in results}
