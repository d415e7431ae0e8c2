"""How far rounding alone may move a result: a bound from the condition of the equations.

The final velocities' error, relative to the largest velocity about, stays below `FACTOR` times
condition (`COND`, of the equilibrated equations) times unit roundoff, in the closed form always and
in the listing's elimination as long as no pivot falls to its absolute 1E-9. Spins are measured
against the larger of the spins and of that velocity over the longer lever arm.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..names import RESULTS

Floats = NDArray[np.float64]

DOUBLE = 2.0**-53
APPLESOFT = 2.0**-32
FACTOR = 16.0
"""Largest error seen over captured and generated scenes: 1.4 in velocities, 11 in spins."""

_SPEEDS = ("UX", "UY", "VX", "VY", "VAX", "VAY", "VBX", "VBY")
_SPINS = ("WA", "WB", "WAF", "WBF")


def relative_bound(condition: float, unit: float = DOUBLE) -> float:
    """The bound for one scene, relative to its largest velocity."""
    return FACTOR * condition * unit


def relative_bounds(condition: Any, unit: float = DOUBLE) -> Floats:
    """The bound for scenes of an array of conditions."""
    condition = np.asarray(condition, float)
    return FACTOR * unit * np.maximum(np.nan_to_num(condition, nan=np.inf), 1.0)


def scales(scene: Mapping[str, Any], solved: Mapping[str, Any]) -> dict[str, Floats]:
    """For each result the size that errors of it are measured by, scene by scene.

    ``scene`` and ``solved`` are columns of n; ``solved`` holds every result of `impact88.solve`.
    Energies and impulses are made of two velocities, so they count twice.
    """
    with np.errstate(all="ignore"):
        value = {**scene, **solved}
        point = np.asarray(scene["M"], float) == 4
        arm = np.where(point, 0.0, np.fmax(np.abs(scene["DA"]), np.abs(scene["DB"])))
        spin = _largest(value, _SPINS)
        speed = np.fmax(_largest(value, _SPEEDS), arm * spin)
        spin = np.fmax(spin, np.where(arm > 0, speed / np.where(arm > 0, arm, 1.0), 0.0))
        mass = np.fmax(_finite(scene["MA"]), _finite(scene["MB"]))
        inertia = np.fmax(_finite(scene["IA"]), _finite(scene["IB"]))
        energy = np.fmax(np.abs(solved["KI"]), np.abs(solved["KF"]))
        size = {
            **dict.fromkeys(RESULTS, speed),
            **dict.fromkeys(_SPINS, spin),
            **dict.fromkeys(("KI", "KF"), 2 * energy),
            "LOSS": 200 * energy / np.abs(solved["KI"]),
            **dict.fromkeys(("PN", "PT"), 2 * mass * speed),
            "PM": 2 * np.fmax(inertia * spin, mass * speed * arm),
            **{name: np.abs(solved[name]) for name in ("MUP", "MUC", "COND")},
        }
        return {name: np.nan_to_num(column) for name, column in size.items()}


def _largest(value: Mapping[str, Any], names: tuple[str, ...]) -> Floats:
    columns = [np.abs(np.asarray(value[name], float)) for name in names if name in value]
    return np.asarray(np.fmax.reduce(np.broadcast_arrays(*columns)), float)


def _finite(column: Any) -> Floats:
    values = np.asarray(column, float)
    return np.where(np.isfinite(values), np.abs(values), 0.0)
