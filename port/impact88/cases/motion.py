"""Headings and the contact plane that follow from the motion, and the contact point in a vehicle's
own axes."""

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
    vectors = {speed: _vector(entries, speed) for speed in VECTORS}
    known = {speed: vector for speed, vector in vectors.items() if vector is not None}
    pairs = [{first, second} <= {*known} for first, second in _COMPLETE]
    open_names = [n for s in VECTORS if s not in known for n in VECTORS[s] if n in entries]
    moving = [vector for vector in known.values() if vector]
    is_known = pairs[0] or pairs[1] or (any(pairs[2:]) and len(known) > 2)
    if not (is_known and moving) or open_names or any(name in entries for name in _ACROSS):
        return None, False
    if any(abs((moving[0].conjugate() * v).imag) > PARALLEL * abs(v * moving[0]) for v in moving):
        return None, False
    # A is taken to be the faster one where not both speeds before are known
    has_speeds = all(name in entries or VECTORS[name][0] in entries for name in ("SA", "SB"))
    approach = known.get("SA", 0j) - known.get("SB", 0j) if has_speeds else 0j
    if not approach:
        speed = next(name for name, vector in known.items() if vector)
        approach = known[speed] if speed[1] == "A" else -known[speed]
    return math.degrees(math.atan2(-approach.imag + 0.0, -approach.real + 0.0)), any(pairs[2:])


def _vector(entries: Mapping[str, Amount], speed: str) -> complex | None:
    """Return a velocity x + iy, 0 at rest, None if its direction is not known exactly; its size is
    1 if that is not known."""
    x, y, course = VECTORS[speed]
    size = entries.get(speed)
    if size and not size.varies and size.value == 0:
        return 0j
    if x in entries and y in entries and not (entries[x].varies or entries[y].varies):
        return complex(entries[x].value, entries[y].value)
    if course in entries and not entries[course].varies:
        turn = math.radians(entries[course].value)
        return (size.value if size else 1.0) * complex(math.cos(turn), math.sin(turn))
    return None
