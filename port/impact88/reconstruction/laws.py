"""The laws that known values violate, with the amount.

A law is tested where all its terms are known: momentum along x and y, angular momentum (Equation
17), restitution (15), friction (16), moment (18), and quantities that follow from known velocities.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ..cases.amounts import Amount
from ..mechanics.solve import evaluate
from .impacts import AFTER, BEFORE, COURSES, PIVOT, SPEEDS, components

TYPED_TOL = 1e-3  # relative to the largest term, a law missed by less holds but for rounding
SIGNIFICANT = 3.0  # standard deviations from which a law is named
MOTION = (*BEFORE, *AFTER)
GEOMETRY = ("s", "c", "an", "at", "bn", "bt", "ia", "ib", "D1", "D2", "D3", "D4")
FOLLOWING = {
    "DVA": ("UX", "UY", "VAX", "VAY"),
    "DVB": ("VX", "VY", "VBX", "VBY"),
    "SA": ("UX", "UY"),
    "SB": ("VX", "VY"),
    "SAF": ("VAX", "VAY"),
    "SBF": ("VBX", "VBY"),
    "VC": BEFORE,
    "KI": BEFORE,
    "KF": AFTER,
    "EL": MOTION,
}
"""Quantities that follow from velocities alone."""


@dataclass(frozen=True)
class MissedLaw:
    """One law that known values violate.

    Parameters
    ----------
    law : str
        The law, or the name of a quantity that does not follow from the velocities.
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


@dataclass(frozen=True)
class _Balance:
    """One law as terms that sum to 0; ``size``: of a term that E = 0, or no sliding, leaves out."""

    law: str
    like: str
    terms: tuple[float, ...]
    size: float = 0.0

    @property
    def residual(self) -> float:
        return sum(self.terms)

    @property
    def largest(self) -> float:
        return max(self.size, max(map(abs, self.terms)))


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
    if not balances:
        return ()
    variances = np.zeros(len(balances))
    for name, amount in known.items():
        if amount.varies:
            shifted = list(
                _balances({**nominal, name: amount.value + amount.standard_deviation}, point)
            )
            changes = [b.residual - a.residual for a, b in zip(balances, shifted, strict=True)]
            variances += np.square(changes)
    missed = []
    for balance, sd in zip(balances, np.sqrt(variances).tolist(), strict=True):
        size = abs(balance.residual)
        if balance.largest and size > max(TYPED_TOL * balance.largest, SIGNIFICANT * sd):
            relative = size / balance.largest
            missed.append(MissedLaw(balance.law, balance.like, size, sd, relative))
    return tuple(sorted(missed, key=lambda law: -law.relative))


def _balances(known: Mapping[str, float], point: bool) -> Iterator[_Balance]:
    """Yield the laws of which all terms are known."""
    values = _with_components(known)
    spins = {} if not point else dict.fromkeys(("WA", "WB", "WAF", "WBF"), 0.0)
    values = {**values, **spins}
    ma, mb = values["MA"], values["MB"]
    for axis, names in (("x", ("UX", "VX", "VAX", "VBX")), ("y", ("UY", "VY", "VAY", "VBY"))):
        if values.keys() >= {*names} and np.isfinite(ma) and np.isfinite(mb):
            ua, ub, va, vb = (values[name] for name in names)
            terms = (ma * va, -ma * ua, mb * vb, -mb * ub)
            yield _Balance(f"momentum along {axis}", "PN", terms)
    if {"DVA", "DVB"} <= known.keys():
        yield _Balance("momentum, MA DVA = MB DVB", "PN", (ma * known["DVA"], -mb * known["DVB"]))
    yield from _following(known, values)
    if {*MOTION} <= values.keys():
        geometry, lacking = evaluate({"M": 4.0 if point else 6.0, **values}, GEOMETRY)
        if not lacking:
            g = {name: float(value) for name, value in geometry.items()}
            yield from _contact_laws(values, g, point)


def _following(known: Mapping[str, float], values: Mapping[str, float]) -> Iterator[_Balance]:
    """Yield known quantities that follow from velocities that are known apart from them."""
    for name, needs in FOLLOWING.items():
        if name not in known or not {*needs} <= values.keys():
            continue
        if name in SPEEDS and not {*needs} <= known.keys():
            continue  # the components were computed from it
        if name in SPEEDS:
            computed = float(np.hypot(values[needs[0]], values[needs[1]]))
        elif name in ("DVA", "DVB"):
            x, y, x_after, y_after = (values[n] for n in needs)
            computed = float(np.hypot(x_after - x, y_after - y))
        elif name == "EL":
            energies, lacking = evaluate(values, ("KI", "KF"))
            if lacking:
                continue
            computed = float(energies["KI"] - energies["KF"])
        else:
            results, lacking = evaluate(values, (name,))
            if lacking:
                continue
            computed = float(results[name])
        yield _Balance(name, name, (known[name], -computed))


def _contact_laws(
    values: Mapping[str, float], g: Mapping[str, float], point: bool
) -> Iterator[_Balance]:
    """Yield angular momentum, restitution, friction and moment."""
    before, after = ([values[name] for name in names] for names in (BEFORE, AFTER))
    change = [b - a for a, b in zip(before, after, strict=True)]
    ma, mb = values["MA"], values["MB"]
    if not point:
        turning = (values["IA"] * change[2], values["IB"] * change[5])
        arms = (mb * (g["D1"] + g["D3"]) * change[3], ma * (g["D2"] + g["D4"]) * change[1])
        yield _Balance("angular momentum (Equation 17)", "PM", (*turning, *arms))
    normal = (g["c"], g["s"], g["an"], -g["c"], -g["s"], g["bn"])
    tangent = (-g["s"], g["c"], g["at"], g["s"], -g["c"], g["bt"])
    if "E" in values:
        closing = sum(a * b for a, b in zip(normal, before, strict=True))
        leaving = sum(a * b for a, b in zip(normal, after, strict=True))
        terms = (leaving, values["E"] * closing)
        yield _Balance("restitution (Equation 15)", "VC", terms, abs(closing))
    pn = ma * (change[0] * g["c"] + change[1] * g["s"])
    pt = ma * (change[1] * g["c"] - change[0] * g["s"])
    if values.get("MUP") == PIVOT:
        sliding = [sum(a * b for a, b in zip(tangent, v, strict=True)) for v in (before, after)]
        yield _Balance("no sliding at separation", "VC", (sliding[1],), abs(sliding[0]))
    elif "MUP" in values:
        yield _Balance("friction (Equation 16)", "PT", (pt, -values["MUP"] * pn))
    if "EM" in values and not point:
        moment = values["IA"] * change[2] - g["an"] * pn - g["at"] * pt
        spin, em = after[2] - after[5], values["EM"]
        push = em * (g["ia"] + g["ib"]) * moment
        yield _Balance("moment (Equation 18)", "WA", ((1 - em) * spin, -push))


def _with_components(known: Mapping[str, float]) -> dict[str, float]:
    """Return values with the velocities of known speeds and courses."""
    values = dict(known)
    for course, speed in COURSES.items():
        if course in known and speed in known:
            along = components(known[speed], known[course])
            for name, value in zip(SPEEDS[speed], along, strict=True):
                values.setdefault(name, float(value))
    return values
