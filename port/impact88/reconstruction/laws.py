"""The laws that known values violate, with the amount.

A law is tested where all its terms are known: momentum along x and y (Equations 13 and 14), angular
momentum (17), and every coefficient, speed, change of velocity and energy that follows from the
known velocities.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ..cases.amounts import Amount
from ..mechanics.solve import BODIES, POINT, evaluate
from .fit import TYPED_TOL
from .impacts import AFTER, BEFORE, COURSES, PIVOT, SPEEDS, VEHICLES, Array, components

SIGNIFICANT = 3.0  # standard deviations from which a law is named
MOTION = (*BEFORE, *AFTER)
Balance = tuple[str, str, tuple[Array, ...]]
"""A law, a quantity of its unit, and its terms, which sum to 0."""
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
    relative : float
        The residual over its largest term.
    """

    law: str
    like: str
    amount: float
    relative: float


def missed_laws(known: Mapping[str, Amount], point: bool) -> tuple[MissedLaw, ...]:
    """Return the laws that known values violate by more than their tolerances, worst first.

    Parameters
    ----------
    known : mapping of str to Amount
        Known values, friction as the signed MUP.
    point : bool
        True for point masses.
    """
    measured = [name for name, amount in known.items() if amount.varies]
    values = {name: np.full(1 + len(measured), amount.value) for name, amount in known.items()}
    for k, name in enumerate(measured):
        values[name][k + 1] += known[name].standard_deviation
    laws = []
    for law, like, terms in _balances(values, point):
        nominal, *changed = np.sum(terms, axis=0).tolist()
        residual, sd = abs(nominal), math.hypot(*(x - nominal for x in changed))
        largest = max(abs(float(term[0])) for term in terms)
        if residual > max(TYPED_TOL * largest, SIGNIFICANT * sd):
            laws.append(MissedLaw(law, like, residual, residual / largest))
    return tuple(sorted(laws, key=lambda law: -law.relative))


def _balances(known: Mapping[str, Array], point: bool) -> Iterator[Balance]:
    """Yield the laws of which all terms are known."""
    state = {name: known[name] for name in (*VEHICLES, *MOTION) if name in known}
    for course, speed in COURSES.items():
        if {course, speed} <= known.keys():
            along = components(known[speed], known[course])
            state = {**dict(zip(SPEEDS[speed], along, strict=True)), **state}
    ma, mb = state["MA"], state["MB"]
    if np.isfinite(ma * mb).all():
        for axis, names in (("x", ("UX", "VX", "VAX", "VBX")), ("y", ("UY", "VY", "VAY", "VBY"))):
            if state.keys() >= {*names}:
                ua, ub, va, vb = (state[name] for name in names)
                yield f"momentum along {axis}", "PN", (ma * va, -ma * ua, mb * vb, -mb * ub)
        if {"DVA", "DVB"} <= known.keys():
            sizes = (ma * known["DVA"], -mb * known["DVB"])
            yield "momentum (MA DVA = MB DVB)", "PN", sizes
    if not point and {*MOTION, *VEHICLES} <= state.keys():
        yield _angular_momentum(state)
    given = [name for name in FOLLOWING if name in known and known[name][0] != PIVOT]
    values, _ = evaluate({**state, "M": np.array(POINT if point else BODIES)}, given)
    for name, value in values.items():
        if np.isfinite(value).all() and known.keys() >= {*SPEEDS.get(name, ())}:
            yield name, name, (known[name], -value)


def _angular_momentum(state: Mapping[str, Array]) -> Balance:
    """Return Equation 17."""
    d, _ = evaluate(state, ("D1", "D2", "D3", "D4", "ay", "bx"))
    terms = (
        state["IA"] * (state["WAF"] - state["WA"]),
        state["IB"] * (state["WBF"] - state["WB"]),
        -state["MB"] * (d["D1"] + d["D3"]) * d["bx"],
        state["MA"] * (d["D2"] + d["D4"]) * d["ay"],
    )
    return "angular momentum", "PM", terms
