"""A problem as it is posed: what is known made complete where the motion says it, and freed of
what cannot be used."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np

from ..collision.geometry import ARMS, GEOMETRY
from ..collision.needs import needs_in_words
from ..collision.uncertain import Uncertain
from ..names import FINAL_STATE, PIVOT, SPINS, VELOCITIES
from ..status import WRONG_SIDES, Status
from .closedform.omitted import COMPONENTS, are_parallel, plane_across
from .state import COURSE_AFTER, COURSE_OF, CRUSH, FORCES, KNOWABLE, QUANTITIES, SPEEDS
from .uses import inputs_of

_ENERGIES = ("KI", "KF", "EL", "LOSS", "DT", *CRUSH)


def pose(
    known: Mapping[str, Any], fixed: Callable[[float], Any]
) -> tuple[dict[str, Any], list[str]]:
    """Return what is known as the equations take it, and sentences on what was made of it.

    Point masses that move along one line need no GA: the contact plane lies across the line, and
    nothing acts along the plane. What needs an input that is not given is left out.

    Parameters
    ----------
    known : mapping of str to Uncertain, float or array
        Values by name (`state.KNOWABLE`).
    fixed : callable
        Makes such a value of a number.

    Returns
    -------
    dict, list of str
        The values to be used, and remarks.
    """
    values, remarks = dict(known), []
    point = bool(np.all(_number(values.get("M", 6.0)) == 4))
    line, is_implied = line_of_motion(values) if point else (None, False)
    if line is not None:
        across = "GA" not in values
        if across:
            values["GA"] = fixed(line)
            remarks.append(
                "the motion is along one line: the contact plane is taken across it, and nothing "
                "acts along the plane"
            )
        along = across or are_parallel(_single_number(values["GA"]), line)
        friction = next((n for n in ("MUP", "MU") if n in values), None)
        if along and friction is None and not is_implied:
            values["MUP"] = fixed(0.0)
        elif across and friction and np.any(_number(values[friction]) != PIVOT):
            del values[friction]
            values["MUP"] = fixed(0.0)
            remarks.append(f"{friction} is not used: nothing slides along the contact plane")
    for vehicle in "AB":
        if _may_have_stood(values, vehicle):
            values[f"T{vehicle}"] = fixed(COURSE_AFTER)
    return values, remarks + _leave_out_unusable(values, point)


def _may_have_stood(values: Mapping[str, Any], vehicle: str) -> bool:
    """Return True for a vehicle that faces its course, of which no course before is known and whose
    speed before is or may be 0: an adjustment of that 0 must not turn it round."""
    theta, speed = (values.get(f"{kind}{vehicle}") for kind in "TS")
    if theta is None or f"H{vehicle}" in values or not np.isnan(_single_number(theta)):
        return False
    parts = [values.get(name) for name in SPEEDS[f"S{vehicle}"]]
    if all(part is not None and _is_exact(part) for part in parts):
        return all(_single_number(part) == 0 for part in parts)
    return isinstance(speed, Uncertain) and speed.low <= 0


def _leave_out_unusable(values: dict[str, Any], point: bool) -> list[str]:
    """Remove what needs an input that is not given; return a sentence for each such input."""
    absent = {name for name in GEOMETRY if name not in values and (not point or name not in ARMS)}
    absent |= {name for name in ("TA", "TB") if name not in values}
    armless = not point and not absent.isdisjoint(ARMS)
    friction = _number(values.get("MUP", values.get("MU", np.nan)))
    is_pivot = bool(np.all(friction == PIVOT))
    is_locked = is_pivot and bool(np.all(_number(values.get("E", np.nan)) == 0)) and not armless
    unusable: dict[str, frozenset[str]] = {}
    for name in [n for n in values if n in KNOWABLE and n not in GEOMETRY and n != "M"]:
        if name in (*VELOCITIES, *FINAL_STATE):
            continue
        law = {"MU": "MUP", **dict.fromkeys(CRUSH, "EL")}.get(name, name)
        law = "E" if law == "MUP" and is_pivot else law
        needs = inputs_of(law, point) & absent
        if armless and name in _ENERGIES:
            needs = frozenset(absent & {*ARMS})
        if needs and not (is_locked and name in ("E", "MU", "MUP")):
            unusable[name] = needs
    for name in unusable:
        del values[name]
    return [
        f"{text}, and {'is' if len(names) == 1 else 'are'} not used"
        for names, text in needs_in_words(unusable)
    ]


def absent_results(known: Mapping[str, Any]) -> dict[str, frozenset[str]]:
    """Return the quantities that need an input that is not given, and which."""
    point = bool(np.all(_number(known.get("M", 6.0)) == 4))
    absent = {name for name in GEOMETRY if name not in known}
    no_turning = frozenset() if point else frozenset(absent & {*ARMS})
    result = {}
    for name in QUANTITIES:
        needs = inputs_of(name, point) & absent
        if name in (*SPINS, "PM", "EM"):
            needs = no_turning
        if needs and name not in known:
            result[name] = needs
    return result


def with_headings(values: Mapping[str, float]) -> dict[str, float]:
    """Return values with the numbers of TA and TB that are `state.COURSE`, as far as the courses
    are among the values: the one before the impact, or after it of a vehicle that was at rest or is
    `state.COURSE_AFTER`."""
    result = dict(values)
    for vehicle in "AB":
        theta = f"T{vehicle}"
        if theta in values and not np.isfinite(values[theta]):
            course = values.get(f"H{vehicle}", np.nan)
            at_rest = np.isnan(course) and values.get(f"S{vehicle}") == 0
            if at_rest or np.isinf(values[theta]):
                course = values.get(f"H{vehicle}F", course)
            if not np.isnan(course):
                front = course + 180 if vehicle == "A" else course
                result[theta] = float(np.remainder(front + 180, 360) - 180)
    return result


def is_wrong_way(status: int, point: bool) -> bool:
    """Return True if an impact has A on the other side of its contact plane than GA says: the
    contact points do not approach, and both centers lie beyond the plane or have no place."""
    broken = status & (Status.SEPARATING | Status.PULLING)
    return bool(broken) and (point or status & WRONG_SIDES == WRONG_SIDES)


def is_meant_turned(status: int, turned_status: int, point: bool) -> bool:
    """Return True if GA is meant the other way round: so the vehicles approach, and as it is given
    the impact is the wrong way.

    ``status``, ``turned_status``: STATUS of the impact with GA as given and turned by 180 degrees.
    Where both are the wrong way, the side from which the vehicles approach is taken."""
    if not is_wrong_way(status, point) or turned_status & Status.SEPARATING:
        return False
    return bool(status & Status.SEPARATING) or not is_wrong_way(turned_status, point)


def turned(degrees: float) -> float:
    """Return the opposite direction, of the smaller size."""
    return degrees - 180 if degrees > 0 else degrees + 180


def turned_sentence(plane: float) -> str:
    """Return the remark on a GA that was turned."""
    return (
        f"GA = {plane:.6g} is taken as {turned(plane):.6g}, A being on the other side of the "
        "contact plane: so the vehicles approach"
    )


def line_of_motion(known: Mapping[str, Any]) -> tuple[float | None, bool]:
    """Return the normal of the contact plane of vehicles that move along one line, as GA, and True
    if what is known implies that the impulse is along it; None where they do not move so, or are
    not known to.

    Their directions are known to be parallel before the impact, or after it, or those of one
    vehicle before and after and one of the other, and nothing known is across the line. A vehicle
    at rest has no direction. A is taken to be the faster one where not both velocities before are
    known."""
    nowhere = None, False
    if not {*FORCES, "DVAR", "DVBR"}.isdisjoint(known):
        return nowhere
    directions: dict[str, float | None] = {}
    for speed in SPEEDS:
        direction = _direction(known, speed)
        if direction is not None:
            directions[speed] = None if np.isnan(direction) else direction
    pairs = (("SA", "SB"), ("SAF", "SBF"), ("SA", "SAF"), ("SB", "SBF"))
    complete = [all(name in directions for name in pair) for pair in pairs]
    if not (complete[0] or complete[1] or (any(complete[2:]) and len(directions) > 2)):
        return nowhere
    moving = {name: angle for name, angle in directions.items() if angle is not None}
    if not moving:
        return nowhere
    first, *other_courses = moving.values()
    if not all(are_parallel(first, other) for other in other_courses):
        return nowhere
    for speed in SPEEDS:
        if speed not in directions and _may_leave(known, speed, first):
            return nowhere
    before = {name: _single_number(known.get(name, np.nan)) for name in COMPONENTS}
    line = float(plane_across(before))
    if np.isnan(line):
        name = next(iter(moving))
        line = 180 - float(np.remainder(-first if name[1] == "A" else 180 - first, 360))
    return line, any(complete[2:])


def _may_leave(known: Mapping[str, Any], speed: str, line: float) -> bool:
    """Return True if what is known of a velocity is not along the line: its direction is not known
    exactly, and its course is known otherwise, or its component across an axis."""
    x, y = SPEEDS[speed]
    across = {0.0: y, 90.0: x}.get(round(line % 180, 6) % 180)
    return COURSE_OF[speed] in known or {x, y} <= {*known} or across in known


def _direction(known: Mapping[str, Any], speed: str) -> float | None:
    """Return the exact direction of a velocity in degrees, NaN for one at rest; None where it is
    not known exactly."""
    parts = [known.get(name) for name in SPEEDS[speed]]
    course = known.get(COURSE_OF[speed])
    if speed in known and _is_exact(known[speed]) and _single_number(known[speed]) == 0:
        return np.nan
    if all(part is not None for part in parts):
        x, y = (_single_number(part) for part in parts)
        zero = [_is_exact(part) and _single_number(part) == 0 for part in parts]
        if all(zero):
            return np.nan
        if any(zero) or all(map(_is_exact, parts)):
            return float(np.degrees(np.arctan2(y, x)))
        return None
    if course is not None and _is_exact(course):
        return _single_number(course)
    return None


def _number(value: Any) -> Any:
    return value.nominal if isinstance(value, Uncertain) else value


def _single_number(value: Any) -> float:
    """Return the one number that a value is, NaN for an array of several."""
    numbers: Iterable[float] = np.unique(np.ravel(np.asarray(_number(value), np.float64)))
    first, *other_numbers = numbers
    return float(first) if not other_numbers else np.nan


def _is_exact(value: Any) -> bool:
    return not (isinstance(value, Uncertain) and value.varies)
