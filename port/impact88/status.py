"""STATUS: what is unphysical or uncertain about an impact, one bit a reason.

The bits stand beside a result and never change it. `WORDS` says each in a sentence a report can
print, `sentences` all that are set. Mechanics: an approach has gn < 0, a push Pn > 0; friction acts
against the sliding (Pt·gt < 0) and can end it but not reverse it (gt·Gt >= 0), with gn, gt the
relative velocities of the contact points before the impact, A minus B, Gn, Gt those after it.

A bit's number never changes its meaning. 16 stood for E, EM and MU together once; since EM and MU
have numbers of their own it stands for E alone.
"""

from __future__ import annotations

from enum import IntFlag


class Status(IntFlag):
    """Bits of STATUS; 0 is an impact with nothing to remark."""

    SEPARATING = 1
    PULLING = 2
    SLIDING_REVERSED = 4
    ENERGY_GAINED = 8
    E_OUT_OF_RANGE = 16
    SINGULAR = 32
    NOT_FINITE = 64
    FRICTION_DRIVES = 128
    A_ON_WRONG_SIDE = 256
    B_ON_WRONG_SIDE = 512
    EM_OUT_OF_RANGE = 1024
    MU_OUT_OF_RANGE = 2048


WORDS: dict[Status, str] = {
    Status.SEPARATING: "the contact points separate already before the impact (gn >= 0)",
    Status.PULLING: "the normal impulse pulls the vehicles together (Pn < 0)",
    Status.SLIDING_REVERSED: (
        "the sliding at the contact point is reversed by the impact, which friction cannot do"
    ),
    Status.ENERGY_GAINED: "kinetic energy is gained in the impact",
    Status.E_OUT_OF_RANGE: "E is outside 0 ... 1",
    Status.SINGULAR: "the equations are singular or nearly so",
    Status.NOT_FINITE: "a value is missing, not finite or not allowed, or a result is no number",
    Status.FRICTION_DRIVES: (
        "friction drives the sliding: the tangential impulse acts with the slip, not against it"
    ),
    Status.A_ON_WRONG_SIDE: (
        "A's center lies on B's side of the contact plane (A belongs on the +n side): turn round A "
        "(TA by 180) or correct PA"
    ),
    Status.B_ON_WRONG_SIDE: (
        "B's center lies on A's side of the contact plane (B belongs on the -n side): turn round B "
        "(TB by 180) or correct PB"
    ),
    Status.EM_OUT_OF_RANGE: (
        "EM is outside -1 ... 0 (and not +1, which stands for no moment impulse)"
    ),
    Status.MU_OUT_OF_RANGE: (
        "MU, with the sign it is used with, is -10 or below, which the listing takes for a pivot"
    ),
}

_SIDES = Status.A_ON_WRONG_SIDE | Status.B_ON_WRONG_SIDE
_BOTH_SIDES = (
    "each center lies on the other vehicle's side of the contact plane (A belongs on the +n side): "
    "turn round the plane (GA by 180)"
)


def names(status: int) -> list[str]:
    """The names of the bits set in ``status``, lowest first."""
    return [bit.name or "" for bit in Status if status & bit]


def sentences(status: int) -> list[str]:
    """What the bits set in ``status`` say, lowest bit first; both vehicles on the wrong sides is
    one fault, the contact plane's."""
    if status & _SIDES != _SIDES:
        return [WORDS[bit] for bit in Status if status & bit]
    return [*(WORDS[bit] for bit in Status if status & bit & ~_SIDES), _BOTH_SIDES]
