"""What the motion of the vehicles says of a case: headings, the contact plane of a collision along
one line, and the contact point in a vehicle's own axes."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ..decimals import to_text
from ..errors import UserError
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
_COMPLETE = (("SA", "SB"), ("SAF", "SBF"), ("SA", "SAF"), ("SB", "SBF"))


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
        if present and polar:
            raise UserError(f"{polar[0]} and {present[0]} are both given; expected one pair")
        if len(present) == 1:
            raise UserError(f"{present[0]} is given alone; expected {names[0]} and {names[1]}")
        if present and not any(entries[name].varies for name in names):
            forward, left = (result.pop(name).value for name in names)
            result[f"D{vehicle}"] = exact_number(math.hypot(forward, left))
            result[f"P{vehicle}"] = exact_number(math.degrees(math.atan2(left, forward)))
    return result


def courses(values: Mapping[str, float]) -> dict[str, float]:
    """Return the vehicles' courses before the impact in degrees from the x axis, by "A" and "B",
    where they are given and the vehicle moves."""
    result = {}
    for speed in ("SA", "SB"):
        x, y, course = VECTORS[speed]
        if x in values and y in values:
            if values[x] or values[y]:
                result[speed[1]] = math.degrees(math.atan2(values[y], values[x]))
        elif course in values and values.get(speed, 1.0):
            result[speed[1]] = values[course]
    return result


def headings(entries: Mapping[str, Amount]) -> dict[str, Amount]:
    """Return the TA and TB of vehicles that face a course which is known exactly: B faces TB, and A
    faces TA + 180."""
    exact = {name: amount.value for name, amount in entries.items() if not amount.varies}
    return {
        f"T{vehicle}": exact_number(math.remainder(course + 180 * (vehicle == "A"), 360))
        for vehicle, course in courses(exact).items()
    }


def line_of_motion(entries: Mapping[str, Amount]) -> tuple[float | None, bool]:
    """Return the GA of a contact plane across the line along which both vehicles move.

    They do if the exactly known directions before (or after) the impact, or those of one vehicle
    before and after and one of the other, are parallel, and no other direction is known. A vehicle
    at rest has no direction.

    Returns
    -------
    float or None
        Degrees, from -180 to 180; A approaches against the normal. None for another motion.
    bool
        True if what is known implies that the impulse is along the line.
    """
    directions = {speed: _direction(entries, speed) for speed in VECTORS}
    exact = {speed for speed, (is_exact, _) in directions.items() if is_exact}
    pairs = [{first, second} <= exact for first, second in _COMPLETE]
    if not (pairs[0] or pairs[1] or (any(pairs[2:]) and len(exact) > 2)):
        return None, False
    moving = {s: angle for s, (_, angle) in directions.items() if angle is not None}
    known_otherwise = [n for s in VECTORS if s not in exact for n in VECTORS[s] if n in entries]
    if not moving or known_otherwise or any(name in entries for name in _ACROSS):
        return None, False
    first = next(iter(moving.values()))
    if any(abs(math.sin(math.radians(angle - first))) > PARALLEL for angle in moving.values()):
        return None, False
    return _normal_of_approach(entries, moving), any(pairs[2:])


def _direction(entries: Mapping[str, Amount], speed: str) -> tuple[bool, float | None]:
    """Return whether a velocity's direction is known exactly, and it in degrees, None at rest."""
    x, y, course = VECTORS[speed]
    size, parts = entries.get(speed), [entries[n] for n in (x, y) if n in entries]
    if size and not size.varies and size.value == 0:
        return True, None
    if len(parts) == 2 and not any(part.varies for part in parts):
        if not (parts[0].value or parts[1].value):
            return True, None
        return True, math.degrees(math.atan2(parts[1].value, parts[0].value))
    if course in entries and not entries[course].varies:
        return True, entries[course].value
    return False, None


def _normal_of_approach(entries: Mapping[str, Amount], moving: Mapping[str, float]) -> float:
    """Return the direction against which A approaches B, in degrees.

    A is taken to be the faster one where not both speeds before are known."""
    velocities = [_velocity(entries, speed) for speed in ("SA", "SB")]
    if all(velocities):
        (ux, uy), (vx, vy) = (velocity for velocity in velocities if velocity)
        x, y = ux - vx, uy - vy
        if not (x or y):
            x, y = ux, uy
        if x or y:
            return math.degrees(math.atan2(-y + 0.0, -x + 0.0))
    speed, angle = next(iter(moving.items()))
    return math.remainder(angle + 180 * (speed[1] == "A"), 360)


def _velocity(entries: Mapping[str, Amount], speed: str) -> tuple[float, float] | None:
    """Return the components of a velocity, None if it is not known."""
    x, y, _ = VECTORS[speed]
    if x in entries and y in entries:
        return entries[x].value, entries[y].value
    size, (_, angle) = entries.get(speed), _direction(entries, speed)
    if size is None or (size.value and angle is None):
        return None
    turn = math.radians(angle or 0.0)
    return size.value * math.cos(turn), size.value * math.sin(turn)
