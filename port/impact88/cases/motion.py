"""Headings and the contact plane that follow from the motion, and the contact point in a vehicle's
own axes."""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping

from ..decimals import to_text
from ..errors import UserError
from ..names import PIVOT
from .amounts import Amount

VECTORS = {
    "SA": ("UX", "UY", "HA"),
    "SB": ("VX", "VY", "HB"),
    "SAF": ("VAX", "VAY", "HAF"),
    "SBF": ("VBX", "VBY", "HBF"),
}
"""Speeds, each with the components and the course of its velocity."""
OWN_AXES = {"A": ("CAF", "CAL"), "B": ("CBF", "CBL")}
"""The contact point forward and to the left of a center of gravity, in place of DA PA and DB PB."""
PARALLEL = 1e-9  # largest sine between directions along one line; rounding leaves 1e-16
_ACROSS = ("PDOFA", "PDOFB", "DVAR", "DVBR", "PT")
"""Directions of the impulse: where one is known, the line is not taken for granted."""
_ENOUGH = ("SA SB", "SAF SBF", "SA SAF SB", "SA SAF SBF", "SB SBF SA", "SB SBF SAF")
"""Velocities that give the directions of all four by the momentum."""


def exact_number(value: float) -> Amount:
    """Return a computed number as an exact amount with digits to type."""
    return Amount.exactly(value, to_text(value))


def contact_point(entries: Mapping[str, Amount]) -> dict[str, Amount]:
    """Return entries with DA PA (DB PB) in place of CAF CAL (CBF CBL).

    The point's own coordinates stay where they are known within limits, which are no limits of
    distance and angle.

    Raises
    ------
    UserError
        If one of two coordinates is missing, or both pairs are given.
    """
    result = dict(entries)
    for vehicle, names in OWN_AXES.items():
        present = [name for name in names if name in entries]
        polar = [name for name in (f"D{vehicle}", f"P{vehicle}") if name in entries]
        if present and (polar or len(present) == 1):
            raise UserError(
                f"{present[0]} is given; expected {names[0]} and {names[1]}, or D{vehicle} and "
                f"P{vehicle} in their place"
            )
        if present and not any(entries[name].varies for name in names):
            forward, side = (result.pop(name).value for name in names)
            result[f"D{vehicle}"] = exact_number(math.hypot(forward, side))
            result[f"P{vehicle}"] = exact_number(math.degrees(math.atan2(side, forward)))
    return result


def courses(entries: Mapping[str, Amount]) -> dict[str, float]:
    """Return the vehicles' courses before the impact in degrees from the x axis, by "A" and "B",
    where they are known exactly and the vehicle moves."""
    result = {}
    for speed in ("SA", "SB"):
        motion, (x, _, course) = velocity(entries, speed), VECTORS[speed]
        if motion:
            is_typed = course in entries and x not in entries
            result[speed[1]] = (
                entries[course].value if is_typed else math.degrees(cmath.phase(motion))
            )
    return result


def headings(entries: Mapping[str, Amount]) -> dict[str, Amount]:
    """Return the TA and TB of vehicles that face a course which is known exactly: B faces TB, and A
    faces TA + 180."""
    return {
        f"T{vehicle}": exact_number(math.remainder(course + 180 * (vehicle == "A"), 360))
        for vehicle, course in courses(entries).items()
    }


def line_of_motion(entries: Mapping[str, Amount]) -> float | None:
    """Return the GA of a contact plane across the line along which both vehicles move.

    They do if the exactly known directions before (or after) the impact, or those of one vehicle
    before and after and one of the other, are parallel, and no other direction is known. A vehicle
    at rest has no direction.

    Returns
    -------
    float or None
        Degrees, from -180 to 180; A approaches against the normal. None for another motion.
    """
    vectors = {speed: velocity(entries, speed) for speed in VECTORS}
    velocities = {speed: vector for speed, vector in vectors.items() if vector is not None}
    uncertain = [n for s in VECTORS if s not in velocities for n in VECTORS[s] if n in entries]
    moving = [vector for vector in velocities.values() if vector]
    is_known = any({*speeds.split()} <= {*velocities} for speeds in _ENOUGH)
    if not (is_known and moving) or any(n in entries for n in (*uncertain, *_ACROSS)):
        return None
    if any(abs((moving[0].conjugate() * v).imag) > PARALLEL * abs(v * moving[0]) for v in moving):
        return None
    # A is taken to be the faster one where not both speeds before are velocities
    has_speeds = all(name in entries or VECTORS[name][0] in entries for name in ("SA", "SB"))
    approach = velocities.get("SA", 0j) - velocities.get("SB", 0j) if has_speeds else 0j
    if not approach:
        speed = next(name for name, vector in velocities.items() if vector)
        approach = velocities[speed] if speed[1] == "A" else -velocities[speed]
    return math.degrees(math.atan2(-approach.imag + 0.0, -approach.real + 0.0))


def plane_across(entries: Mapping[str, Amount]) -> tuple[dict[str, Amount], list[str]]:
    """Return the entries of point masses that move along one line with a contact plane across it,
    along which nothing acts, and remarks; other entries unchanged."""
    line = line_of_motion(entries) if entries["M"].value == 4 and "GA" not in entries else None
    if line is None:
        return dict(entries), []
    remarks = [
        "the motion is along one line: the contact plane is across it, and nothing acts along the "
        "plane (MU = 0)"
    ]
    result = {**entries, "GA": exact_number(line)}
    is_implied = any(
        None not in (velocity(entries, before), velocity(entries, after))
        for before, after in (("SA", "SAF"), ("SB", "SBF"))
    )
    friction = [name for name in ("MU", "MUP") if name in entries]
    if friction and entries[friction[0]].value == PIVOT:
        return result, remarks
    for name in friction:
        del result[name]
        remarks.append(f"{name} is not used: nothing slides along the plane")
    if friction or not is_implied:
        result["MU"] = exact_number(0.0)
    return result, remarks


def velocity(entries: Mapping[str, Amount], speed: str) -> complex | None:
    """Return a velocity x + iy, 0 at rest, None if its direction is not known exactly; its size is
    1 if that is not known."""
    values = {n: entries[n].value for n in (speed, *VECTORS[speed]) if n in entries}
    exact = {name: value for name, value in values.items() if not entries[name].varies}
    x, y, course = (exact.get(name) for name in VECTORS[speed])
    if exact.get(speed) == 0:
        return 0j
    if x is not None and y is not None:
        return complex(x, y)
    if course is not None:
        return cmath.rect(values.get(speed, 1.0), math.radians(course))
    return None
