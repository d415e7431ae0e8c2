"""What a solved impact means: contact point, direction of force, ΔV, energy, critical friction.

For any solution, whatever its unknowns were: it is computed from the velocities before and after
and from the impulse, as far as they are known.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..closedform.energy import kinetic_energy
from ..closedform.solve import quantities, solve
from ..closedform.statusbits import bits, findings
from ..names import FINAL_STATE, PIVOT, SCENE, VELOCITIES
from .geometry import Geometry, with_point_masses
from .impulse import principal_direction
from .state import COURSES, SPEEDS, course, in_vehicle_axes

Array = NDArray[Any]

_FORWARD = ("MUC", "COND")
"""What only the forward solution can tell: it needs all initial velocities and coefficients."""
_PLANE = {"A": (("UX", "VAX"), ("UY", "VAY")), "B": (("VX", "VBX"), ("VY", "VBY"))}
"""The components of each vehicle's velocity, before and after."""
_INERTIAS = ("MA", "MB", "IA", "IB")


def outcome(values: Mapping[str, Any]) -> dict[str, Array]:
    """The consequences of ``values``: geometry, velocities, coefficients, PN and PT, by name.

    CAX CAY CBX CBY and STATUS always; PDOFA PDOFB and P where PN and PT are given; contact
    velocities XA ... YBF, KI, KF, LOSS, DVA, DVB (with their components in vehicle axes), speeds
    and courses where the velocities they need are; MUC where all initial velocities and
    coefficients are (MU as the listing's line 280 would hold it).
    """
    headings = [(v, f"T{v}") for v in "AB" if f"T{v}" in values]
    whole = with_point_masses(values)
    given = {name: np.asarray(value, np.float64) for name, value in whole.items()}
    geometry = Geometry.of(given)
    if geometry.point.all():
        given = {"WA": np.zeros(()), "WB": np.zeros(()), "EM": np.zeros(()), **given}
        given = {"WAF": given["WA"], "WBF": given["WB"], **given}
    result = geometry.contact_point()
    if "PN" in given and "PT" in given:
        pn, pt = given["PN"], given["PT"]
        for vehicle, theta in headings:
            result[f"PDOF{vehicle}"] = principal_direction(
                vehicle, given[theta], given["GA"], pn, pt
            )
        result["P"] = np.hypot(pn, pt)
    for name, sign, velocities in (("VC", -1.0, VELOCITIES), ("VS", 1.0, FINAL_STATE)):
        if all(velocity in given for velocity in velocities):
            result[name] = sign * geometry.relative([given[v] for v in velocities])[0]
    result |= _contact_velocities(geometry, given)
    result |= velocity_changes(given)
    result |= energies(geometry, given)
    for course_name, speed in COURSES.items():
        if all(name in given for name in SPEEDS[speed]):
            x, y = (given[name] for name in SPEEDS[speed])
            result[speed], result[course_name] = np.hypot(x, y), course(x, y)
    for vehicle, theta in headings:
        if f"DV{vehicle}" in result:
            change = (given[late] - given[early] for early, late in _PLANE[vehicle])
            forward, right = in_vehicle_axes(vehicle, given[theta], *change)
            result |= {f"DV{vehicle}F": forward, f"DV{vehicle}R": right}
    condition: Any = 1.0
    if all(name in given for name in SCENE if name != "M"):
        scene = {name: given[name] for name in SCENE if name in given}
        result["MUC"], condition = solve(scene, _FORWARD).values()
    result["STATUS"] = status(geometry, given | result, condition)
    shape = np.broadcast_shapes(*(np.shape(value) for value in given.values()))
    return {name: np.broadcast_to(value, shape) for name, value in result.items()}


def moment_ratio(em: Any) -> Any:
    """R/R0: the relative spin after the impact over that before, as far as the moment impulse alone
    makes it (Equation 18 as printed with P = 0): -em/(1 - 2 em). 1 at em = +1, no moment; 0 at 0,
    where the spins become equal; 1/3 at -1. Infinite at em = 1/2."""
    em = np.asarray(em, np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        return -em / (1 - 2 * em)


def _contact_velocities(geometry: Geometry, given: Mapping[str, Array]) -> dict[str, Array]:
    """Lines 340, 700 and 710."""
    velocities = {}
    for suffix, names in (("", VELOCITIES), ("F", FINAL_STATE)):
        arms = (
            (geometry.d3, -geometry.d4, names[:3], "A"),
            (-geometry.d1, geometry.d2, names[3:], "B"),
        )
        for arm_x, arm_y, (x, y, spin), vehicle in arms:
            if all(name in given for name in (x, y, spin)):
                turning = np.where(geometry.point, 0.0, given[spin])
                velocities[f"X{vehicle}{suffix}"] = given[x] + arm_x * turning
                velocities[f"Y{vehicle}{suffix}"] = given[y] + arm_y * turning
    return velocities


def velocity_changes(given: Mapping[str, Array]) -> dict[str, Array]:
    """DVA and DVB, each where the velocities it needs are given."""
    changes: dict[str, Array] = {}
    for vehicle, first in (("A", 0), ("B", 3)):
        names = (*VELOCITIES[first : first + 2], *FINAL_STATE[first : first + 2])
        if all(name in given for name in names):
            x, y, after_x, after_y = (given[name] for name in names)
            changes[f"DV{vehicle}"] = np.hypot(after_x - x, after_y - y)
    return changes


def energies(geometry: Geometry, given: Mapping[str, Array]) -> dict[str, Array]:
    """KI and KF where the velocities they need are given, and LOSS where both are. Point masses'
    spins and barriers (infinite, at rest) add nothing."""
    inertias = [np.where(np.isinf(given[name]), 0.0, given[name]) for name in _INERTIAS]
    result: dict[str, Array] = {}
    for name, velocities in (("KI", VELOCITIES), ("KF", FINAL_STATE)):
        if all(velocity in given for velocity in velocities):
            six = [given[velocity] for velocity in velocities]
            six[2], six[5] = (np.where(geometry.point, 0.0, six[i]) for i in (2, 5))
            result[name] = kinetic_energy(inertias, six)
    if len(result) == 2:
        with np.errstate(divide="ignore", invalid="ignore"):
            result["LOSS"] = 100 * (result["KI"] - result["KF"]) / result["KI"]
    return result


def _pivot_impulse(given: Mapping[str, Array]) -> tuple[Array, Array]:
    """PN and PT of the same impact if the sliding ended at separation, where that can be told."""
    scene = {name: given[name] for name in SCENE if name in given} | {"MU": np.array(PIVOT)}
    if not all(name in scene for name in SCENE if name != "M"):
        return np.array(np.nan), np.array(np.nan)
    solved = quantities(scene, ("PN", "PT"))
    return solved["PN"], solved["PT"]


def status(geometry: Geometry, given: Mapping[str, Array], condition: Any = 1.0) -> Array:
    """STATUS of an impact known from both sides; what cannot be decided for lack of a value is not
    remarked. ``given``: velocities, coefficients, PN PT, KI KF as far as they are known;
    ``condition``: COND, where the forward equations are at hand."""
    missing = np.array(np.nan)

    def value(name: str) -> Array:
        return given.get(name, missing)

    known = [name for name in (*VELOCITIES, *FINAL_STATE) if name in given]
    with np.errstate(invalid="ignore"):
        operands = (
            geometry.relative([value(name) for name in VELOCITIES])[0],
            value("PN"),
            geometry.at,
            geometry.bt,
            np.where(geometry.point, 0.0, given["DA"]),
            np.where(geometry.point, 0.0, given["DB"]),
            # energies that are not known are not numbers that are not finite
            2 * (value("KI") - value("KF")) if "KF" in given and "KI" in given else np.zeros(()),
            given.get("KI", np.ones(())),
            value("E"),
            np.where(geometry.point, 0.0, value("EM")),
            np.where(value("MUP") == PIVOT, 0.0, value("MUP")),
            *_pivot_impulse(given),
            np.asarray(condition),
            sum((given[name] for name in known), np.zeros(())),
        )
        return np.asarray(bits(findings(*operands)), np.uint16)
