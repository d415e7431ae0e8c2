"""Headings and the contact plane that follow from the motion, and the contact point in a vehicle's
own axes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

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
_ENOUGH = ({"SA", "SB"}, {"SAF", "SBF"})
"""Velocities along one line, either of which leave the momentum no other direction."""


class Velocity(NamedTuple):
    """A velocity: its size and its course in degrees from the x axis."""

    size: float
    course: float


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
    for vehicle, pair in OWN_AXES.items():
        own = [entries[name] for name in pair if name in entries]
        polar = f"D{vehicle}", f"P{vehicle}"
        if own and (len(own) == 1 or not entries.keys().isdisjoint(polar)):
            raise UserError(
                f"expected {' and '.join(pair)}, or {' and '.join(polar)} in their place"
            )
        if own and not any(amount.varies for amount in own):
            forward, left = (result.pop(name).value for name in pair)
            angle = math.degrees(math.atan2(left, forward))
            result[polar[0]] = exact_number(math.hypot(forward, left))
            result[polar[1]] = exact_number(angle)
    return result


def courses(entries: Mapping[str, Amount]) -> dict[str, float]:
    """Return the vehicles' courses before the impact in degrees from the x axis, by "A" and "B",
    where they are known exactly and the vehicle moves."""
    motions = {vehicle: velocity(entries, f"S{vehicle}") for vehicle in "AB"}
    return {vehicle: v.course for vehicle, v in motions.items() if v and v.size}


def headings(entries: Mapping[str, Amount]) -> dict[str, Amount]:
    """Return the TA and TB of vehicles that face a course which is known exactly: B faces TB, and A
    faces TA + 180."""
    return {
        f"T{vehicle}": exact_number(math.remainder(course + 180 * (vehicle == "A"), 360))
        for vehicle, course in courses(entries).items()
    }


def line_of_motion(entries: Mapping[str, Amount]) -> float | None:
    """Return the GA of a contact plane across the line along which both vehicles move.

    They do if the directions of both before the impact, or after it, are known exactly, all that
    are known are parallel, and none is known within limits. A vehicle at rest has no direction.

    Returns
    -------
    float or None
        Degrees, from -180 to 180; A approaches against the normal. None for another motion.
    """
    vectors = {speed: velocity(entries, speed) for speed in VECTORS}
    velocities = {speed: vector for speed, vector in vectors.items() if vector}
    moving = [speed for speed, vector in velocities.items() if vector.size]
    others = [name for s in VECTORS if s not in velocities for name in VECTORS[s]]
    is_known = any(pair <= velocities.keys() for pair in _ENOUGH)
    if not (is_known and moving and entries.keys().isdisjoint((*others, *_ACROSS))):
        return None
    line = velocities[moving[0]].course
    angles = {speed: math.radians(velocities[speed].course - line) for speed in velocities}
    if any(abs(math.sin(angles[speed])) > PARALLEL for speed in moving):
        return None
    along = {speed: v.size * math.cos(angles[speed]) for speed, v in velocities.items()}
    has_speeds = all(name in entries or VECTORS[name][0] in entries for name in ("SA", "SB"))
    approach = along.get("SA", 0.0) - along.get("SB", 0.0) if has_speeds else 0.0
    # where not both speeds before are known, A is taken to be the faster one
    is_forward = approach > 0 if approach else moving[0][1] == "A"
    return math.remainder(line + 180 * is_forward, 360) + 0.0


def plane_across(entries: Mapping[str, Amount]) -> tuple[dict[str, Amount], list[str]]:
    """Return the entries of point masses that move along one line with a contact plane across it,
    along which nothing acts, and remarks; other entries unchanged."""
    line = line_of_motion(entries) if entries["M"].value == 4 and "GA" not in entries else None
    if line is None:
        return dict(entries), []
    friction = [name for name in ("MU", "MUP") if name in entries]
    is_locked = any(entries[name].value == PIVOT for name in friction)
    unused = "" if is_locked else "".join(f"; {name} is not used" for name in friction)
    remark = (
        "the motion is along one line: the contact plane is across it, and nothing acts along the "
        f"plane (MU = 0{unused})"
    )
    is_implied = any(
        velocity(entries, before) and velocity(entries, after)
        for before, after in (("SA", "SAF"), ("SB", "SBF"))
    )
    result = {**entries, "GA": exact_number(line)}
    if is_locked:
        return result, [remark]
    result.pop("MUP", None)
    if friction or not is_implied:
        result["MU"] = exact_number(0.0)
    return result, [remark]


def velocity(entries: Mapping[str, Amount], speed: str) -> Velocity | None:
    """Return a velocity, None if its direction is not known exactly; its size is 1 if that is not
    known."""
    x, y, course = (entries.get(name) for name in VECTORS[speed])
    size = entries.get(speed)
    if size and not size.varies and not size.value:
        return Velocity(0.0, 0.0)
    if x and y and not (x.varies or y.varies):
        angle = math.degrees(math.atan2(y.value, x.value))
        return Velocity(math.hypot(x.value, y.value), angle)
    if course and not course.varies:
        return Velocity(size.value if size else 1.0, course.value)
    return None
