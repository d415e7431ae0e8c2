"""Headings and the contact plane that follow from the motion, and the contact point in a vehicle's
own axes."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ..errors import UserError
from .amounts import Amount

Amounts = Mapping[str, Amount]
Values = Mapping[str, float]

VECTORS = {
    "SA": ("UX", "UY", "HA"),
    "SB": ("VX", "VY", "HB"),
    "SAF": ("VAX", "VAY", "HAF"),
    "SBF": ("VBX", "VBY", "HBF"),
}
"""Speeds, each with the components and the course of its velocity."""
OWN_AXES = {"A": ("CAF", "CAL"), "B": ("CBF", "CBL")}
"""The contact point forward and to the left of a center of gravity, in place of DA PA and DB PB."""
_ACROSS = ("PDOFA", "PDOFB", "DVAR", "DVBR", "PT")
"""Directions of the impulse: where one is known, the line is not taken for granted."""
_ENOUGH = ({"SA", "SB"}, {"SAF", "SBF"})
"""Velocities along one line, either of which leave the momentum no other direction."""


def contact_point(values: Values) -> dict[str, float]:
    """Return DA PA (DB PB) of values that have CAF CAL (CBF CBL) in their place.

    Raises
    ------
    UserError
        If one of two coordinates is missing, or both pairs are given.
    """
    result: dict[str, float] = {}
    for vehicle, pair in OWN_AXES.items():
        own = [values[name] for name in pair if name in values]
        polar = f"D{vehicle}", f"P{vehicle}"
        if own and (len(own) == 1 or not values.keys().isdisjoint(polar)):
            raise UserError(
                f"expected {' and '.join(pair)}, or {' and '.join(polar)} in their place"
            )
        if own:
            result.update(zip(polar, _polar(*own), strict=True))
    return result


def _polar(x: float, y: float) -> tuple[float, float]:
    """Return size and direction in degrees of a vector."""
    return math.hypot(x, y), math.degrees(math.atan2(y, x))


def velocities(values: Values) -> dict[str, tuple[float, float]]:
    """Return the velocities whose directions are known: sizes, NaN where not known, and courses in
    degrees from the x axis. A vehicle at rest has size 0, and the course 0."""
    vectors = {}
    for speed, (x, y, course) in VECTORS.items():
        if values.get(speed) == 0:
            vectors[speed] = 0.0, 0.0
        elif x in values and y in values:
            vectors[speed] = _polar(values[x], values[y])
        elif course in values:
            vectors[speed] = values.get(speed, math.nan), values[course]
    return vectors


def courses(values: Values) -> dict[str, float]:
    """Return the vehicles' courses before the impact in degrees from the x axis, by "TA" and "TB",
    where they are known and the vehicle moves."""
    vectors = velocities(values)
    return {
        f"T{speed[1]}": vectors[speed][1] for speed in ("SA", "SB") if vectors.get(speed, (0,))[0]
    }


def line_of_motion(entries: Amounts) -> float | None:
    """Return the GA of a contact plane across the line along which both vehicles move.

    They do if the directions of both before the impact, or after it, are known exactly, all that
    are known are parallel, and none is known within limits. A vehicle at rest has no direction.

    Returns
    -------
    float or None
        Degrees, from -180 to 180; A approaches against the normal. None for another motion.
    """
    exact = {n: a.value for n, a in entries.items() if n in VECTORS or not a.varies}
    vectors = velocities(exact)
    moving = {speed: course for speed, (size, course) in vectors.items() if size}
    others = [name for speed in VECTORS.keys() - vectors for name in VECTORS[speed]]
    is_known = any(pair <= vectors.keys() for pair in _ENOUGH)
    is_alone = len({round(course, 7) % 180 for course in moving.values()}) == 1
    if not (is_known and is_alone and entries.keys().isdisjoint((*others, *_ACROSS))):
        return None
    first, line = next(iter(moving.items()))
    along_a, along_b = (
        size * math.cos(math.radians(course - line))
        for size, course in (vectors.get(speed, (math.nan, 0.0)) for speed in ("SA", "SB"))
    )
    # where not both speeds before are known, A is taken to be the faster one
    is_forward = along_a > along_b or (not along_a < along_b and first[1] == "A")
    return math.remainder(line + 180 * is_forward, 360) + 0.0
