"""STATUS: reasons why an impact is unphysical or uncertain, one bit each.

The bits accompany a result and never change it. `WORDS` has a sentence for each, which a report can
print; `sentences` returns those of the bits that are set. Mechanics: an approach has gn < 0, a push
Pn > 0, with gn the normal relative velocity of the contact points before the impact, A minus B;
friction can reduce the sliding at separation to 0 and no further, so P_t lies between 0 and MUC·Pn.

A bit's number never changes its meaning. 16 once meant E, EM and MU together; since EM and MU have
bits of their own it means E alone. `RETIRED` bits are no longer set.

>>> impact88.status.names(64)
['NOT_FINITE']
"""

from collections.abc import Mapping
from enum import IntFlag
from math import copysign, cos, hypot, inf, isfinite, isinf, nan, radians, sin, sqrt
from typing import Any


class Status(IntFlag):
    """Bits of STATUS; 0 is an impact without remarks."""

    SEPARATING = 1
    PULLING = 2
    ENERGY_GAINED = 8
    E_OUT_OF_RANGE = 16
    SINGULAR = 32
    NOT_FINITE = 64
    A_ON_WRONG_SIDE = 256
    B_ON_WRONG_SIDE = 512
    EM_OUT_OF_RANGE = 1024
    MU_OUT_OF_RANGE = 2048
    FRICTION_ABOVE_CRITICAL = 4096
    FRICTION_WRONG_DIRECTION = 8192


IMPOSSIBLE = (
    Status.SEPARATING
    | Status.PULLING
    | Status.ENERGY_GAINED
    | Status.E_OUT_OF_RANGE
    | Status.EM_OUT_OF_RANGE
)
"""Bits that no real impact has: it breaks a law. The other bits are remarks: with Table 2's own
coefficients six of the chapter's eleven staged collisions have more friction than what ends their
sliding. `mechanics.outcome.broken_laws` decides these bits for arrays of impacts."""

RETIRED = {4: "SLIDING_REVERSED", 128: "FRICTION_DRIVES"}
"""Bits of version 0.2 that compared the sliding before and after the impact. Sliding that the
normal impulse reverses is possible; FRICTION_ABOVE_CRITICAL and FRICTION_WRONG_DIRECTION replace
them."""

WORDS: dict[Status, str] = {
    Status.SEPARATING: "the contact points separate already before the impact (gn >= 0)",
    Status.PULLING: "the normal impulse pulls the vehicles together (Pn < 0)",
    Status.ENERGY_GAINED: "kinetic energy is gained in the impact",
    Status.E_OUT_OF_RANGE: "E is outside 0 ... 1",
    Status.SINGULAR: "the equations are singular or nearly so",
    Status.NOT_FINITE: "a value is missing, not finite or not allowed, or a result is not a number",
    Status.A_ON_WRONG_SIDE: (
        "A's center lies on B's side of the contact plane (A belongs on the +n side): reverse A "
        "(TA by 180) or correct PA"
    ),
    Status.B_ON_WRONG_SIDE: (
        "B's center lies on A's side of the contact plane (B belongs on the -n side): reverse B "
        "(TB by 180) or correct PB"
    ),
    Status.EM_OUT_OF_RANGE: (
        "EM is outside -1 ... 0 (and not +1, which stands for no moment impulse)"
    ),
    Status.MU_OUT_OF_RANGE: (
        "MU, with the sign it is used with, is -10 or below, which the listing takes for a pivot"
    ),
    Status.FRICTION_ABOVE_CRITICAL: (
        "friction is above the critical value: it would reverse the sliding at separation, and it "
        "can only end it"
    ),
    Status.FRICTION_WRONG_DIRECTION: (
        "friction acts in the wrong direction: away from what ends the sliding"
    ),
}

_FRICTION = Status.FRICTION_ABOVE_CRITICAL | Status.FRICTION_WRONG_DIRECTION
_SIDES = Status.A_ON_WRONG_SIDE | Status.B_ON_WRONG_SIDE
_BOTH_SIDES = (
    "each center lies on the other vehicle's side of the contact plane (A belongs on the +n side): "
    "reverse the plane (GA by 180)"
)


def names(status: int) -> list[str]:
    """Return the names of the bits set in ``status``, lowest first."""
    return [bit.name or "" for bit in Status if status & bit]


def sentences(status: int, values: Mapping[str, Any] | None = None) -> list[str]:
    """Return a sentence for each bit set in ``status``, lowest first.

    Both vehicles on the wrong side are one fault, that of the contact plane. If friction is not
    admissible, the last sentence says what would be, as far as the impact's ``values`` show it (see
    `admissible_friction`)."""
    on_both_sides = status & _SIDES == _SIDES
    lines = [WORDS[bit] for bit in Status if status & bit and not (on_both_sides and bit in _SIDES)]
    return lines + [_BOTH_SIDES] * on_both_sides + admissible_friction(status, values or {})


def admissible_friction(status: int, values: Mapping[str, Any]) -> list[str]:
    """Return a sentence on the admissible sign and size of MU, and the assumptions, or no sentence
    if ``status`` has no fault of friction or ``values`` lacks MUC or MUP.

    ``values``: MUC and MUP of the impact; the scene, PN and PM as far as they are known."""
    names = ("MUC", "MUP", "MU", "GA", "XA", "YA", "XB", "YB")
    critical, applied, given_mu, plane, xa, ya, xb, yb = (float(values.get(n, nan)) for n in names)
    if not status & _FRICTION or not isfinite(critical) or not applied:
        return []
    if critical * applied > 0 and status & Status.FRICTION_WRONG_DIRECTION:
        critical = -copysign(inf, applied)  # the pivot pulls: nothing ends the sliding
    back = _forth_and_back(values)
    text = f"admissible here: P_t/P_n {_up_to(critical, back)}"
    if abs(given_mu) > 0:  # MU is known
        turn = given_mu / applied
        text += f", that is MU {_up_to(critical * turn, back * turn)} as typed"
    if back:
        text += (
            f"; {back:.4g} by sliding forth and back, the normal impulse being what it is in this "
            "impact"
        )
    if values.get("M", 6) != 4 and values.get("EM", 0) != 1:
        text += "; assumed: the moment impulse grows in proportion to the normal impulse"
    sliding = (ya - yb) * cos(radians(plane)) - (xa - xb) * sin(radians(plane))
    if given_mu == applied and abs(sliding) <= 1e-12 * hypot(xa - xb, ya - yb):
        text += "; without sliding before the impact line 400 keeps the sign of MU"
    return [text]


_BODIES = ("GA", "DA", "DB", "TA", "PA", "TB", "PB", "MA", "MB", "IA", "IB", "WA", "WB")
_SLIDING = (*_BODIES, "UX", "UY", "VX", "VY", "PN", "PM")


def _forth_and_back(values: Mapping[str, Any]) -> float:
    """Return the largest P_t/P_n of friction against the initial sliding when the normal impulse
    reverses the sliding during the impact; 0 if it does not, or values are missing.

    With v the sliding velocity before, s the change of it by P_n and the moment impulse, and y the
    sliding per unit of tangential impulse, |P_t| <= (sqrt(2 |v s|) - |s|)² / (|s| y), if v and s
    have opposite signs and |s|/2 < |v| < 2 |s|; see
    `closedform.statusbits.slides_forth_and_back`."""
    if values.get("M", 6) == 4 or not all(name in values for name in _SLIDING):
        return 0.0
    g = {name: float(values[name]) for name in _SLIDING}
    a, b = radians(g["TA"] + g["PA"] - g["GA"]), radians(g["TB"] + g["PB"] - g["GA"])
    an, at = g["DA"] * sin(a), -g["DA"] * cos(a)
    bn, bt = g["DB"] * sin(b), -g["DB"] * cos(b)
    x, y, plane = g["UX"] - g["VX"], g["UY"] - g["VY"], radians(g["GA"])
    before = y * cos(plane) - x * sin(plane) + at * g["WA"] + bt * g["WB"]
    turning = (an * at / g["IA"] + bn * bt / g["IB"]) * g["PN"]
    turning += (at / g["IA"] - bt / g["IB"]) * g["PM"]
    yielding = 1 / g["MA"] + 1 / g["MB"] + at * at / g["IA"] + bt * bt / g["IB"]
    size = abs(turning)
    if not (before * turning < 0 and 0.5 * size < abs(before) < 2 * size and g["PN"] > 0):
        return 0.0
    max_pt = (sqrt(2 * abs(before) * size) - size) ** 2 / (size * yielding)
    return -copysign(max_pt / g["PN"], before)


def _up_to(limit: float, back: float = 0.0) -> str:
    """Return the interval from 0 to ``limit``, extended to ``back``, in words."""
    if isinf(limit):
        return "above 0" if limit > 0 else "below 0"
    low, high = min(limit, back, 0.0) + 0.0, max(limit, back, 0.0)  # a zero without a sign
    if high - low < 5e-10:
        return "= 0 only"
    return f"from {low:.4g} to {high:.4g}"
