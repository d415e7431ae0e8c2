"""STATUS: what is unphysical or uncertain about a solved impact, one bit a reason.

The bits stand beside a result and never change it. `WORDS` says each in a sentence a report can
print; mechanics: an approach has gn < 0, a push Pn > 0, and friction cannot reverse sliding, so
|μ| above the critical |μc| is more friction than the scene can have.
"""

from __future__ import annotations

from enum import IntFlag


class Status(IntFlag):
    """Bits of STATUS; 0 is an impact with nothing to remark."""

    SEPARATING = 1
    PULLING = 2
    SLIDING_REVERSED = 4
    ENERGY_GAINED = 8
    COEFFICIENT_OUT_OF_RANGE = 16
    SINGULAR = 32
    NOT_FINITE = 64


WORDS: dict[Status, str] = {
    Status.SEPARATING: "the contact points separate already before the impact (gn >= 0)",
    Status.PULLING: "the normal impulse pulls the vehicles together (Pn < 0)",
    Status.SLIDING_REVERSED: "friction reverses the sliding: |MU| is above the critical value MUC",
    Status.ENERGY_GAINED: "kinetic energy is gained in the impact",
    Status.COEFFICIENT_OUT_OF_RANGE: (
        "E is outside 0 ... 1, EM outside -1 ... 0, or MU, with the sign it is used with, is -10 or"
        " below (which the listing takes for a pivot)"
    ),
    Status.SINGULAR: "the equations are singular or nearly so",
    Status.NOT_FINITE: "a value is missing, not finite or not allowed, or the result is not finite",
}


def names(status: int) -> list[str]:
    """The names of the bits set in ``status``, lowest first."""
    return [bit.name or "" for bit in Status if status & bit]
