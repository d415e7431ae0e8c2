"""Friction that can make an impact, as numbers and in words; `closedform.statusbits` decides it."""

from collections.abc import Mapping
from math import copysign, inf, isfinite, isinf, nan
from typing import Any

import numpy as np

from .. import status as words
from ..names import SCENE
from ..status import Status
from .state import State

FAULTS = Status.FRICTION_ABOVE_CRITICAL | Status.FRICTION_WRONG_DIRECTION


def status_sentences(status: int, values: Mapping[str, Any]) -> list[str]:
    """Return a sentence for each bit set in ``status``, and on what friction would be admissible,
    as far as the impact's ``values`` show it (see `admissible_friction`)."""
    return words.sentences(status) + admissible_friction(status, values)


def admissible_friction(status: int, values: Mapping[str, Any]) -> list[str]:
    """Return a sentence on the admissible sign and size of MU, and the assumptions, or no sentence
    if ``status`` has no fault of friction or ``values`` lacks MUC or MUP.

    ``values``: MUC and MUP of the impact; the scene, PN and PM as far as they are known."""
    critical, applied, typed = (float(values.get(name, nan)) for name in ("MUC", "MUP", "MU"))
    if not status & FAULTS or not isfinite(critical) or not applied:
        return []
    if critical * applied > 0 and status & Status.FRICTION_WRONG_DIRECTION:
        critical = -copysign(inf, applied)  # the pivot pulls: nothing ends the sliding
    known = {name: float(values[name]) for name in (*SCENE, "PN", "PM") if name in values}
    state = State.of_known(known)
    back = float(friction_forth_and_back(state))
    text = f"admissible here: P_t/P_n {_up_to(critical, back)}"
    if abs(typed) > 0:  # MU is known
        turn = typed / applied
        text += f", that is MU {_up_to(critical * turn, back * turn)} as typed"
    if back:
        text += (
            f"; {back:.4g} by sliding forth and back, the normal impulse being what it is in this "
            "impact"
        )
    if values.get("M", 6) != 4 and values.get("EM", 0) != 1:
        text += "; assumed: the moment impulse grows in proportion to the normal impulse"
    if typed == applied and not state.sliding:
        text += "; without sliding before the impact line 400 keeps the sign of MU"
    return [text]


def _up_to(limit: float, back: float = 0.0) -> str:
    """Return the interval from 0 to ``limit``, extended to ``back``, in words."""
    if isinf(limit):
        return "above 0" if limit > 0 else "below 0"
    low, high = min(limit, back, 0.0) + 0.0, max(limit, back, 0.0)  # a zero without a sign
    if high - low < 5e-10:
        return "= 0 only"
    return f"from {low:.4g} to {high:.4g}"


def friction_forth_and_back(state: State) -> Any:
    """Return the largest P_t/P_n of friction against the sliding before the impact where the normal
    impulse reverses the sliding; 0 if it does not, or values are not known.

    |P_t| <= (sqrt(2 |v s|) - |s|)² / (|s| y), with v the sliding before, s what P_n and the moment
    impulse add to it and y what a unit of P_t adds, if v and s have opposite signs and
    |s|/2 < |v| < 2 |s|: the root of `closedform.statusbits.slides_forth_and_back`."""
    sliding, (turning, yielding) = state.relative_before[1], state.slip_changes
    pn = state.values["PN"]
    size = np.where(np.real(turning) < 0, -turning, turning)
    speed = np.where(np.real(sliding) < 0, -sliding, sliding)
    reverses = np.real(turning) * np.real(sliding) < 0
    reverses &= (np.real(speed) > 0.5 * np.real(size)) & (np.real(speed) < 2 * np.real(size))
    reverses &= np.real(pn) > 0
    size, speed = np.where(reverses, size, 1.0), np.where(reverses, speed, 1.0)
    largest = np.square(np.sqrt(2 * speed * size) - size) / (size * yielding * pn)
    return np.where(reverses, -np.sign(np.real(sliding)) * largest, 0.0)
