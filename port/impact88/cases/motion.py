"""Headings and the contact plane that follow from the motion, and the contact point in a vehicle's
own axes."""

from __future__ import annotations

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
_ENOUGH = ({"SA", "SB"}, {"SAF", "SBF"})
"""Velocities along one line, either of which leave the momentum no other direction."""


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


def velocities(entries: Mapping[str, Amount]) -> dict[str, tuple[float, float]]:
    """Return the velocities whose directions are known exactly: sizes, NaN where not known, and
    courses in degrees from the x axis. A vehicle at rest has size 0, and the course 0."""
    exact = {name: amount.value for name, amount in entries.items() if not amount.varies}
    vectors = {}
    for speed, (x, y, course) in VECTORS.items():
        if exact.get(speed) == 0:
            vectors[speed] = 0.0, 0.0
        elif x in exact and y in exact:
            size = math.hypot(exact[x], exact[y])
            vectors[speed] = size, math.degrees(math.atan2(exact[y], exact[x]))
        elif course in exact:
            vectors[speed] = entries[speed].value if speed in entries else math.nan, exact[course]
    return vectors


def courses(entries: Mapping[str, Amount]) -> dict[str, float]:
    """Return the vehicles' courses before the impact in degrees from the x axis, by "A" and "B",
    where they are known exactly and the vehicle moves."""
    vectors = velocities(entries)
    before = {speed[1]: vectors[speed] for speed in ("SA", "SB") if speed in vectors}
    return {vehicle: course for vehicle, (size, course) in before.items() if size}


def line_of_motion(entries: Mapping[str, Amount]) -> float | None:
    """Return the GA of a contact plane across the line along which both vehicles move.

    They do if the directions of both before the impact, or after it, are known exactly, all that
    are known are parallel, and none is known within limits. A vehicle at rest has no direction.

    Returns
    -------
    float or None
        Degrees, from -180 to 180; A approaches against the normal. None for another motion.
    """
    vectors = velocities(entries)
    moving = [speed for speed, (size, _) in vectors.items() if size]
    others = [name for speed in VECTORS.keys() - vectors for name in VECTORS[speed]]
    is_known = any(pair <= vectors.keys() for pair in _ENOUGH)
    if not (is_known and moving and entries.keys().isdisjoint((*others, *_ACROSS))):
        return None
    line = vectors[moving[0]][1]
    along = dict.fromkeys(("SA", "SB"), math.nan)
    for speed, (size, course) in vectors.items():
        angle = math.radians(course - line)
        if size and abs(math.sin(angle)) > PARALLEL:
            return None
        along[speed] = size * math.cos(angle)
    approach = along["SA"] - along["SB"]
    # where not both speeds before are known, A is taken to be the faster one
    is_forward = approach > 0 or (not approach < 0 and moving[0][1] == "A")
    return math.remainder(line + 180 * is_forward, 360) + 0.0


def plane_across(entries: Mapping[str, Amount]) -> tuple[dict[str, Amount], list[str]]:
    """Return the entries of point masses that move along one line with a contact plane across it,
    along which nothing acts, and remarks; other entries unchanged."""
    result = dict(entries)
    line = line_of_motion(entries) if entries["M"].value == 4 and "GA" not in entries else None
    if line is None:
        return result, []
    result["GA"] = exact_number(line)
    friction = [name for name in ("MU", "MUP") if name in entries]
    unused = ""
    if not any(entries[name].value == PIVOT for name in friction):
        unused = "".join(f"; {name} is not used" for name in friction)
        result.pop("MUP", None)
        vectors = velocities(entries).keys()
        is_implied = {"SA", "SAF"} <= vectors or {"SB", "SBF"} <= vectors
        if friction or not is_implied:
            result["MU"] = exact_number(0.0)
    remark = (
        "the motion is along one line: the contact plane is across it, and nothing acts along the "
        f"plane (MU = 0{unused})"
    )
    return result, [remark]
