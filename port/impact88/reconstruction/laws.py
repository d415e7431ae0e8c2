"""The laws that known values violate, with the amount.

A law is tested where all its terms are known: momentum along x and y (Equations 13 and 14), angular
momentum (17), and every coefficient, speed, change of velocity and energy that follows from the
known velocities.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..cases.amounts import Amount
from ..mechanics.solve import evaluate
from .fit import TYPED_TOL
from .impacts import AFTER, BEFORE, COURSES, PIVOT, SPEEDS, VEHICLES, components

SIGNIFICANT = 3.0  # standard deviations from which a law is named
MOTION = (*BEFORE, *AFTER)
FOLLOWING = (*"E MUP EM VC VS DVA DVB DVAF DVAR DVBF DVBR SA SB SAF SBF KI KF EL LOSS DT".split(),)
"""Quantities that follow from velocities alone."""


@dataclass(frozen=True)
class MissedLaw:
    """One law that known values violate.

    Parameters
    ----------
    law : str
        The law, or the name of a quantity that does not follow from the known velocities.
    like : str
        A quantity of the same unit.
    amount : float
        Residual of the law.
    sd : float
        Standard deviation of the residual, 0 for exact values.
    relative : float
        The residual over its largest term.
    """

    law: str
    like: str
    amount: float
    sd: float
    relative: float


class _Balance(NamedTuple):
    """One law as terms that sum to 0."""

    law: str
    like: str
    terms: tuple[float, ...]


def missed_laws(known: Mapping[str, Amount], point: bool) -> tuple[MissedLaw, ...]:
    """Return the laws that known values violate by more than their tolerances, worst first.

    Parameters
    ----------
    known : mapping of str to Amount
        Known values, friction as the signed MUP.
    point : bool
        True for point masses.
    """
    nominal = {name: amount.value for name, amount in known.items()}
    balances = list(_balances(nominal, point))
    variances = np.zeros(len(balances))
    for name, amount in known.items():
        if amount.varies and balances:
            shifted = {**nominal, name: amount.value + amount.standard_deviation}
            pairs = zip(balances, _balances(shifted, point), strict=True)
            variances += np.square([sum(b.terms) - sum(a.terms) for a, b in pairs])
    missed = []
    for (law, like, terms), variance in zip(balances, variances.tolist(), strict=True):
        residual, sd = abs(sum(terms)), float(np.sqrt(variance))
        largest = max(map(abs, terms))
        if residual > max(TYPED_TOL * largest, SIGNIFICANT * sd):
            missed.append(MissedLaw(law, like, residual, sd, residual / largest))
    return tuple(sorted(missed, key=lambda law: -law.relative))


def _balances(known: Mapping[str, float], point: bool) -> Iterator[_Balance]:
    """Yield the laws of which all terms are known."""
    vehicles = {name: known[name] for name in VEHICLES if name in known}
    motion = {name: known[name] for name in MOTION if name in known}
    for course, speed in COURSES.items():
        if course in known and speed in known:
            along = components(known[speed], known[course])
            motion = {**dict(zip(SPEEDS[speed], map(float, along), strict=True)), **motion}
    ma, mb = vehicles["MA"], vehicles["MB"]
    if np.isfinite(ma * mb):
        for axis, names in (("x", ("UX", "VX", "VAX", "VBX")), ("y", ("UY", "VY", "VAY", "VBY"))):
            if motion.keys() >= {*names}:
                ua, ub, va, vb = (motion[name] for name in names)
                terms = (ma * va, -ma * ua, mb * vb, -mb * ub)
                yield _Balance(f"momentum along {axis}", "PN", terms)
        if {"DVA", "DVB"} <= known.keys():
            sizes = (ma * known["DVA"], -mb * known["DVB"])
            yield _Balance("momentum (MA DVA = MB DVB)", "PN", sizes)
    state = {**vehicles, **motion, "M": 4.0 if point else 6.0}
    if not point and {*MOTION, *VEHICLES} <= state.keys():
        yield _angular_momentum(state)
    given = [name for name in FOLLOWING if name in known and known[name] != PIVOT]
    values, _ = evaluate(state, given)
    for name, value in values.items():
        computed = float(value)
        if np.isfinite(computed) and not {*SPEEDS.get(name, ())} - known.keys():
            yield _Balance(name, name, (known[name], -computed))


def _angular_momentum(state: Mapping[str, float]) -> _Balance:
    """Return Equation 17."""
    d, _ = evaluate(state, ("D1", "D2", "D3", "D4"))
    terms = (
        state["IA"] * (state["WAF"] - state["WA"]),
        state["IB"] * (state["WBF"] - state["WB"]),
        state["MB"] * float(d["D1"] + d["D3"]) * (state["VBX"] - state["VX"]),
        state["MA"] * float(d["D2"] + d["D4"]) * (state["VAY"] - state["UY"]),
    )
    return _Balance("angular momentum", "PM", terms)
