"""The impacts that count: those that break no law and need no more friction than there is.

Laws always hold: the contact points approach, the normal impulse pushes, no kinetic energy is
gained; E lies from 0 to 1 and EM from -1 to 0 where they are not given. Where friction is not
given, P_t/P_n lies between 0 and what ends the sliding, or what sliding forth and back allows
(`mechanics.closedform.statusbits`), widened as the chapter's eleven staged collisions need it.

Each condition is a `Row`: a number that lies from 0 to 1 where it holds, smooth there, real or
complex. `mechanics.outcome.broken_laws` decides the same laws for results."""

from collections.abc import Collection, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...mechanics.closedform.statusbits import RANGES
from ...mechanics.friction import friction_forth_and_back
from ...mechanics.outcome import broken_laws
from ...mechanics.posed import absent_results
from ...mechanics.state import State
from ...names import COEFFICIENTS
from .system import System

Array = NDArray[Any]

WIDER = 0.2  # widening of friction's limits on either side, relative to their distance
MORE = 0.1  # and beside that
# Where nothing ends the sliding, P_t/P_n has no other limit; 10, as MU = -10 is the listing's pivot
LARGEST_FRICTION = 10.0
# Least closing speed and normal impulse, relative to typical ones: at 0 coefficients are 0 / 0
LEAST_IMPACT = 1e-8

APPROACH = "approach"
PUSH = "push"
ENERGY = "energy"
NORMAL = "normal"  # some normal allows the impact; judged where the contact plane is not given
FRICTION = "MUP"
LAWS = (APPROACH, PUSH, ENERGY)

SENTENCE = "counted are impacts in which the vehicles approach, push and gain no energy"
ENDS = {
    APPROACH: "the vehicles would not approach",
    PUSH: "the vehicles would pull",
    ENERGY: "energy would be gained",
    "E": "E would leave 0 ... 1",
    "EM": "EM would leave -1 ... 0",
    NORMAL: "no contact plane would allow the impact",
    FRICTION: "friction would reverse the sliding",
}
"""Condition -> where an interval that ends at it ends: "where ..."."""


class Admissible:
    """The admissible set of a reconstruction. ``rows``: names of the conditions that are judged:
    laws, and coefficients that are not given. ``given``: coefficients known, exactly or within
    limits."""

    def __init__(self, system: System) -> None:
        self.given = [n for n in COEFFICIENTS if n in system.known]
        absent = absent_results(system.known)
        open_ones = [n for n in COEFFICIENTS if n not in self.given and n not in absent]
        if system.point and "EM" in open_ones:
            open_ones.remove("EM")
        laws = LAWS if "GA" in system.known else (ENERGY, NORMAL)
        self.rows: Sequence[str] = (*laws, *open_ones)
        self.speed, self.mass = system.speed, system.mass
        self.spin = system.speed / system.gyration

    def limit_to(self, names: Collection[str]) -> None:
        """Judge by these conditions alone."""
        self.rows = [name for name in self.rows if name in names]

    def row(self, state: State, name: str) -> Any:
        """Return one condition of impacts: it holds from 0 to 1."""
        if name == NORMAL:
            return np.where(broken_laws(state) == 0, 0.5, -1.0)
        above_low, below_high = self.ends(state, name)
        if name in LAWS:
            return one_sided(above_low)
        return above_low / (above_low + below_high)

    def ends(
        self, state: State, name: str, limits: tuple[float, float] | None = None
    ) -> tuple[Any, Any]:
        """Return how far impacts lie within the lower and the upper end of a condition, beyond
        where negative, as velocities and impulses in typical ones: without quotients, so that they
        are smooth where a denominator vanishes. A law has no upper end. ``limits``: those of a
        coefficient that is known within some."""
        if name in LAWS:
            values = {
                APPROACH: -state.relative_before[0] / self.speed - LEAST_IMPACT,
                PUSH: state.values["PN"] / (self.mass * self.speed) - LEAST_IMPACT,
                ENERGY: state.energy_lost / (self.mass * self.speed**2),
            }
            return values[name], np.inf
        above, below = state.quotient(name)
        sign = np.where(np.real(below) < 0, -1.0, 1.0)
        low, high = limits or (RANGES[name] if name in RANGES else friction_limits(state))
        size = {"E": self.speed, "EM": self.spin}.get(name, self.mass * self.speed)
        return sign * (above - low * below) / size, sign * (high * below - above) / size

    def sentence(self) -> str:
        """Return the admissible set in one sentence, without its full stop."""
        parts = [SENTENCE]
        for name, (low, high) in RANGES.items():
            if name in self.rows:
                parts.append(f"{name} lies from {low:g} to {high:g}")
        if FRICTION in self.rows:
            parts.append(
                f"P_t/P_n lies between 0 and what ends the sliding, {WIDER:.0%} of that and "
                f"{MORE:g} more on either side, and within {LARGEST_FRICTION:g}"
            )
        return f"{', '.join(parts[:-1])} and {parts[-1]}" if parts[1:] else parts[0]


def one_sided(within: Any) -> Any:
    """Return a number that lies from 0 to 1 where ``within`` is not negative."""
    return within / (1 + np.where(np.real(within) < 0, -within, within))


def friction_limits(state: State, strict: bool = False) -> tuple[Any, Any]:
    """Return the lowest and the highest P_t/P_n that friction makes, widened unless ``strict``."""
    critical = _clipped(_critical_friction(state))
    back = friction_forth_and_back(state)
    low, high = _least(critical, back), -_least(-critical, -back)
    if strict:
        return low, high
    room = WIDER * (high - low) + MORE
    return _clipped(low - room), _clipped(high + room)


def _clipped(value: Any) -> Any:
    return np.where(np.abs(np.real(value)) < LARGEST_FRICTION, value, _largest_along(value))


def _largest_along(value: Any) -> Any:
    return np.sign(np.real(value)) * LARGEST_FRICTION


def _least(first: Any, second: Any) -> Any:
    """Return the least of two numbers and 0; of complex ones that with the least real part."""
    least = np.where(np.real(first) < np.real(second), first, second)
    return np.where(np.real(least) < 0, least, 0.0)


def _critical_friction(state: State) -> Any:
    """Return P_t/P_n of the impact whose sliding ends at separation; where that would pull, nothing
    ends the sliding, and the largest there is along its P_t."""
    normal, tangential = state.pivot_impulse
    return np.where(
        np.real(normal) > 0,
        tangential / np.where(np.real(normal) > 0, normal, 1.0),
        _largest_along(tangential),
    )
