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

from enum import IntFlag


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
sliding. `mechanics.laws.margins` gives their distances as numbers."""

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

WRONG_SIDES = Status.A_ON_WRONG_SIDE | Status.B_ON_WRONG_SIDE
_BOTH_SIDES = (
    "each center lies on the other vehicle's side of the contact plane (A belongs on the +n side): "
    "reverse the plane (GA by 180)"
)


def names(status: int) -> list[str]:
    """Return the names of the bits set in ``status``, lowest first."""
    return [bit.name or "" for bit in Status if status & bit]


def sentences(status: int) -> list[str]:
    """Return a sentence for each bit set in ``status``, lowest first.

    Both vehicles on the wrong side are one fault, that of the contact plane."""
    on_both_sides = status & WRONG_SIDES == WRONG_SIDES
    lines = [
        WORDS[bit] for bit in Status if status & bit and not (on_both_sides and bit in WRONG_SIDES)
    ]
    return lines + [_BOTH_SIDES] * on_both_sides
