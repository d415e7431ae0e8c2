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


def absolute_bounds(
    scene: Mapping[str, Any], solved: Mapping[str, Any], names: list[str], unit: float = DOUBLE
) -> dict[str, Floats]:
    """For each of ``names`` how far rounding may move it, scene by scene (arrays of n).

    ``solved`` holds at least COND, the final velocities and ``names``. Energies and impulses take
    twice the relative bound of the velocities they are made of.
    """
    with np.errstate(all="ignore"):
        relative = FACTOR * unit * np.maximum(np.asarray(solved["COND"], float), 1.0)
        value = {**scene, **solved}
        point = np.asarray(scene["M"], float) == 4
        arm = np.where(point, 0.0, np.maximum(np.abs(scene["DA"]), np.abs(scene["DB"])))
        spin = _largest(value, _SPINS)
        speed = np.maximum(_largest(value, _SPEEDS), arm * spin)
        spin = np.maximum(spin, np.where(arm > 0, speed / np.where(arm > 0, arm, 1.0), 0.0))
        mass = np.maximum(_finite(scene["MA"]), _finite(scene["MB"]))
        energy = np.maximum(np.abs(solved.get("KI", 0.0)), mass * speed**2)
        scale = {
            **dict.fromkeys(_SPINS, spin),
            **dict.fromkeys(("KI", "KF"), 2 * energy),
            "LOSS": 200 * energy / np.abs(solved.get("KI", np.nan)),
            **dict.fromkeys(("PN", "PT"), 2 * mass * speed),
            "PM": 2 * mass * speed * np.maximum(arm, 1.0),
            **{name: np.abs(solved.get(name, np.nan)) * 4 for name in ("MUP", "MUC", "COND")},
        }
        bounds = {}
        for name in names:
            bounds[name] = np.nan_to_num(relative * scale.get(name, speed), nan=0.0)
    return bounds


def _largest(value: Mapping[str, Any], names: tuple[str, ...]) -> Floats:
    columns = [np.abs(np.asarray(value[name], float)) for name in names if name in value]
    return np.asarray(np.fmax.reduce(np.broadcast_arrays(*columns)), float)


def _finite(column: Any) -> Floats:
    values = np.asarray(column, float)
    return np.where(np.isfinite(values), np.abs(values), 0.0)
