"""How far final velocities move when the scene's numbers do: the condition of the data.

A method is backward stable when its error is a small multiple of the unit roundoff times this
sensitivity. The condition of the six equations alone does not bound it: in a sideswipe the approach
is a small difference of large velocities.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..closedform.solve import solve
from ..names import FINAL_VELOCITIES, PIVOT

Floats = NDArray[np.float64]

STEP = 2.0**-36
"""Relative change of a number: far above rounding, far below the nearest singularity tried."""
GROUPS = (FINAL_VELOCITIES[:4], FINAL_VELOCITIES[4:])


def movements(
    columns: Mapping[str, Any], outputs: Sequence[str] = FINAL_VELOCITIES
) -> dict[str, Floats]:
    """For every scene and each output, what it changes per relative change of all numbers of the
    scene at their worst: the sum over the numbers of the central differences' sizes.
    """
    moved = {name: np.zeros(()) for name in outputs}
    for name, values in columns.items():
        values = np.asarray(values, np.float64)
        if name == "M":
            continue
        # a pivot's MU stands for no friction: there is nothing to change
        step = np.where(values == PIVOT, 0.0, STEP) if name == "MU" else STEP
        upper = solve({**columns, name: values * (1 + step)}, outputs)
        lower = solve({**columns, name: values * (1 - step)}, outputs)
        for result in outputs:
            change = np.abs(upper[result] - lower[result]) / (2 * STEP)
            moved[result] = moved[result] + change
    return moved


def sensitivity(columns: Mapping[str, Any]) -> Floats:
    """For every scene, the largest of its `movements`, relative to the largest of its group (the
    four velocities, the two spins); at least 1."""
    present = solve(columns, FINAL_VELOCITIES)
    moved = movements(columns)
    worst = np.ones_like(present["VAX"])
    for group in GROUPS:
        scale = np.max([np.abs(present[name]) for name in group], axis=0)
        change = np.max([moved[name] for name in group], axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):
            worst = np.fmax(worst, change / scale)
    return worst
