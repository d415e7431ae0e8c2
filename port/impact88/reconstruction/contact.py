"""The contact point moved, or given in a vehicle's own axes.

DA PA and DB PB are the contact point's polar coordinates in each vehicle, from its front (A faces
TA + 180, B faces TB). One point has four numbers there, so a move of it changes all four together:
varied apart they tear it in two.
"""

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from ..doubles import double
from ..errors import UserError
from ..scene import OWN_AXES
from .doublerange import within_doubles

MOVES = ("CX", "CY")
"""How far the contact point moves along the scene's x and y."""


def placed(names: Iterable[str], given: Iterable[str]) -> tuple[str, ...]:
    """``names`` with CAF CAL in place of DA PA, CBF CBL of DB PB, where those are ``given``."""
    own: dict[str, str] = {}
    for vehicle, axes in OWN_AXES.items():
        if set(axes) & set(given):
            own |= dict(zip((f"D{vehicle}", f"P{vehicle}"), axes, strict=True))
    return tuple(own.get(name, name) for name in names)


@within_doubles
def moved(values: Mapping[str, Any]) -> dict[str, Any]:
    """``values`` (a scene's geometry, numbers or arrays, with CX and CY, or CAF CAL CBF CBL) with
    DA PA DB PB of the contact point as it is moved, or given, and without those."""
    kept = dict(values)
    for vehicle, axes in OWN_AXES.items():
        if axes[0] in kept:
            forward, left = (np.asarray(kept.pop(name), np.float64) for name in axes)
            kept[f"D{vehicle}"] = np.hypot(forward, left)
            kept[f"P{vehicle}"] = np.degrees(np.arctan2(left, forward))
    if not set(MOVES) & set(kept):
        return kept
    values, kept = kept, {name: value for name, value in kept.items() if name not in MOVES}
    dx, dy = (np.asarray(values.get(name, 0.0), np.float64) for name in MOVES)
    for vehicle, sign in (("A", -1.0), ("B", 1.0)):
        heading = np.asarray(values[f"T{vehicle}"], np.float64)
        distance = np.asarray(values[f"D{vehicle}"], np.float64)
        angle = np.radians(heading + values[f"P{vehicle}"])
        # A's polar coordinates point from the contact point to its center of gravity
        x = distance * np.cos(angle) + sign * dx
        y = distance * np.sin(angle) + sign * dy
        kept[f"D{vehicle}"] = np.hypot(x, y)
        kept[f"P{vehicle}"] = np.degrees(np.arctan2(y, x)) - heading
    return kept


def moved_texts(texts: Mapping[str, str], dx: float, dy: float) -> dict[str, str]:
    """What a move of the contact point changes in a scene's texts: DA PA DB PB. Raises UserError
    where a number of it lies beyond the range of doubles."""
    names = [kind + vehicle for vehicle in "AB" for kind in "DPT"]
    values = moved({**{name: double(texts[name]) for name in names}, "CX": dx, "CY": dy})
    changed = {name: float(values[name]) for name in ("DA", "PA", "DB", "PB")}
    for name, value in changed.items():
        if not math.isfinite(value):
            raise UserError(
                f"the contact point cannot be moved: {name} would be {value}; expected numbers "
                "within the range of doubles"
            )
    return {name: repr(value).upper() for name, value in changed.items()}
