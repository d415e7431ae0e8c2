"""What a solved impact means: contact point, direction of force, ΔV, energy, critical friction.

For any solution, whatever its unknowns were: it is computed from the velocities before and after
and from the impulse, as far as they are known.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..closedform.solve import solve
from ..names import FINAL_STATE, SCENE, VELOCITIES
from .geometry import Geometry
from .impulse import principal_direction

Array = NDArray[np.float64]

_FORWARD = ("MUC", "STATUS")
"""What only the forward solution can tell: it needs all initial velocities and coefficients."""


def outcome(values: Mapping[str, Any]) -> dict[str, Array]:
    """The consequences of ``values``: geometry, velocities, coefficients, PN and PT, by name.

    CAX CAY CBX CBY always; PDOFA PDOFB and P where PN and PT are given; contact velocities XA ...
    YBF, KI, KF, LOSS, DVA, DVB where the velocities they need are; MUC and STATUS where all initial
    velocities and coefficients are (MU as the listing's line 280 would hold it).
    """
    given = {name: np.asarray(value, np.float64) for name, value in values.items()}
    here = Geometry.of(given)
    if here.point.all():
        given = {"WA": np.zeros(()), "WB": np.zeros(()), "EM": np.zeros(()), **given}
        given = {"WAF": given["WA"], "WBF": given["WB"], **given}
    result = here.contact_point()
    if "PN" in given and "PT" in given:
        pn, pt = given["PN"], given["PT"]
        for vehicle, theta in (("A", given["TA"]), ("B", given["TB"])):
            result[f"PDOF{vehicle}"] = principal_direction(vehicle, theta, given["GA"], pn, pt)
        result["P"] = np.hypot(pn, pt)
    result |= _contact_velocities(here, given)
    result |= _changes(here, given)
    if all(name in given for name in SCENE if name != "M"):
        scene = {name: given[name] for name in SCENE if name in given}
        result |= solve(scene, _FORWARD)
    shape = np.broadcast_shapes(*(np.shape(value) for value in given.values()))
    return {name: np.broadcast_to(value, shape) for name, value in result.items()}


def _contact_velocities(here: Geometry, given: Mapping[str, Array]) -> dict[str, Array]:
    """Lines 340, 700 and 710."""
    found = {}
    for suffix, names in (("", VELOCITIES), ("F", FINAL_STATE)):
        arms = ((here.d3, -here.d4, names[:3], "A"), (-here.d1, here.d2, names[3:], "B"))
        for arm_x, arm_y, (x, y, spin), vehicle in arms:
            if all(name in given for name in (x, y, spin)):
                turning = np.where(here.point, 0.0, given[spin])
                found[f"X{vehicle}{suffix}"] = given[x] + arm_x * turning
                found[f"Y{vehicle}{suffix}"] = given[y] + arm_y * turning
    return found


def _changes(here: Geometry, given: Mapping[str, Array]) -> dict[str, Array]:
    found: dict[str, Array] = {}
    for vehicle, at in (("A", 0), ("B", 3)):
        names = (*VELOCITIES[at : at + 2], *FINAL_STATE[at : at + 2])
        if all(name in given for name in names):
            x, y, after_x, after_y = (given[name] for name in names)
            found[f"DV{vehicle}"] = np.hypot(after_x - x, after_y - y)
    for name, names in (("KI", VELOCITIES), ("KF", FINAL_STATE)):
        if all(velocity in given for velocity in names):
            found[name] = _energy(here, given, [given[velocity] for velocity in names])
    if "KI" in found and "KF" in found:
        with np.errstate(divide="ignore", invalid="ignore"):
            found["LOSS"] = 100 * (found["KI"] - found["KF"]) / found["KI"]
    return found


def _energy(here: Geometry, given: Mapping[str, Array], velocities: list[Array]) -> Array:
    """Lines 320, 580 and 590; point masses' spins and barriers (infinite, at rest) add nothing."""
    spins = np.where(here.point, 0.0, 1.0)
    total: Any = 0.0
    for name, at in (("MA", 0), ("MA", 1), ("IA", 2), ("MB", 3), ("MB", 4), ("IB", 5)):
        inertia = np.where(np.isinf(given[name]), 0.0, given[name])
        total = total + (spins if at in (2, 5) else 1.0) * inertia * velocities[at] ** 2
    return np.asarray(0.5 * total)
