"""Equations 13 to 18 solved for any unknowns, over arrays.

Over the six velocities before the impact and the three impulses, what is known is linear: a
velocity, or one law with its coefficient. A singular value decomposition of each element's
equations tells what they determine (Golub and Van Loan, *Matrix Computations*, 5.5).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError
from ..mechanics.solve import evaluate
from ..names import check_names, missing
from .impacts import AFTER, BEFORE, COEFFICIENTS, IMPULSES, PIVOT, VEHICLES, Array, Impacts

RANK_TOL = 1e-10  # relative size of singular values, and of sliding, that is 0
DETERMINED_TOL = 1e-7  # change of a quantity along open directions that is rounding
STATE = (*BEFORE, *IMPULSES)
MOTION = (*BEFORE, *AFTER, *IMPULSES)
CONTACT = ("gn", "VS", "gt_after", "ia", "ib")
UNKNOWNS = (*BEFORE, *AFTER, *COEFFICIENTS)


@dataclass(frozen=True)
class Solution:
    """Impacts that follow from what is known.

    Parameters
    ----------
    values : dict of str to ndarray
        The unknowns by name; NaN where they are not determined.
    mismatch : ndarray
        By how much equations more than needed miss, as a velocity.
    agrees : ndarray of bool
        False where the sign of the friction does not oppose the sliding (line 400).

    Examples
    --------
    >>> known = {"M": 4, "MA": 3, "MB": 2, "GA": 0, "UX": -3, "UY": 0, "VY": 0, "VAX": 1, "VBX": 2}
    >>> (found,) = impact88.solve_for(known)
    >>> print(found["VX"].round(2), found.mismatch.round(2))
    8.0 0.0
    """

    values: Mapping[str, Array]
    mismatch: Array
    agrees: NDArray[np.bool_]

    def __getitem__(self, name: str) -> Array:
        """Return an unknown."""
        return self.values[name]


def solve_for(known: Mapping[str, Any], unknown: Iterable[str] | None = None) -> list[Solution]:
    """Return what follows from known velocities and coefficients, over arrays.

    Parameters
    ----------
    known : mapping of str to float or array_like
        The vehicles (MA MB IA IB DA DB PA PB TA TB GA; M is 6 by default, of point masses MA MB
        GA), velocities before and after, E, EM, and MUP, the signed P_t/P_n, or MU, of which both
        signs are tried. They broadcast.
    unknown : iterable of str, optional
        The unknowns wanted; by default all velocities and coefficients that are not known.

    Returns
    -------
    list of Solution
        One, or two where both signs of MU agree with the sliding they lead to.

    Raises
    ------
    UserError
        For missing vehicles, unknown names, and where nothing wanted is determined.

    Notes
    -----
    Equations 13 to 18.

    Examples
    --------
    >>> scene = impact88.sample(1).numbers()
    >>> after = impact88.solve(scene, impact88.names.FINAL_VELOCITIES)
    >>> vehicles = {n: x for n, x in scene.items() if n not in impact88.names.VELOCITIES}
    >>> before = impact88.solve_for({**vehicles, **after})
    >>> print(before[0]["UX"].round(2))
    -29.04
    """
    check_names(known, (*VEHICLES, *UNKNOWNS, "MU", "M"), "quantity")
    values, _ = evaluate(known, tuple(known))  # as numbers of one shape
    if np.all(values.pop("M", 6.0) == 4):
        values |= {name: np.zeros(()) for name in ("DA", "DB", "PA", "PB", "WA", "WB", "PM")}
        values |= {name: np.ones(()) for name in ("IA", "IB")}
        values = {"TA": np.zeros(()), "TB": np.zeros(()), **values}
    if lacking := [name for name in VEHICLES if name not in values]:
        raise UserError(missing(lacking))
    shape = np.broadcast_shapes(*(x.shape for x in values.values()))
    values = {name: np.broadcast_to(x, shape).ravel() for name, x in values.items()}
    wanted = [n for n in UNKNOWNS if n not in values] if unknown is None else list(unknown)
    check_names(wanted, UNKNOWNS, "unknown")
    solutions = []
    for reading in _readings(values):
        found, mismatch, sliding = _solve(reading, wanted)
        agrees = np.isfinite(mismatch)
        if "MU" in values:
            opposes = reading["MUP"] * sliding <= 0
            ends = (np.abs(sliding) <= RANK_TOL) | (reading["MUP"] == PIVOT)
            agrees &= ends | opposes
        reshaped = {name: x.reshape(shape) for name, x in found.items()}
        solutions.append(Solution(reshaped, mismatch.reshape(shape), agrees.reshape(shape)))
    agreeing = [solution for solution in solutions if solution.agrees.any()]
    if not agreeing or all(np.isnan(x).all() for x in agreeing[0].values.values()):
        raise UserError(f"{', '.join(wanted)} do not follow from what is known")
    return agreeing


def _readings(values: Mapping[str, Array]) -> list[dict[str, Array]]:
    """Return the values with each sign of MU as MUP."""
    rest = {name: x for name, x in values.items() if name != "MU"}
    if "MU" not in values:
        return [rest]
    mu = values["MU"]
    if np.all((mu == 0) | (mu == PIVOT)):
        return [{**rest, "MUP": mu}]
    return [{**rest, "MUP": np.where(mu == PIVOT, mu, sign * mu)} for sign in (1.0, -1.0)]


def _solve(v: Mapping[str, Array], wanted: list[str]) -> tuple[dict[str, Array], Array, Array]:
    """Return the wanted quantities, the mismatch and the sliding, of elements."""
    count = len(v["MA"])
    bodies = {name: v[name] for name in VEHICLES}
    zero, one = np.zeros(count), np.ones(count)
    basis = [Impacts({**bodies, **dict.fromkeys(STATE, zero), name: one}) for name in STATE]
    largest = [np.abs(v[name]).max(initial=0.0) for name in (*BEFORE, *AFTER) if name in v]
    speed = float(max(largest, default=0.0)) or 1.0
    mass = 1.0 / (1.0 / v["MA"] + 1.0 / v["MB"])
    sizes = np.stack([one] * 6 + [mass] * 3, 1) * speed
    rows = _Rows(basis, mass)
    used = [name for name in (*BEFORE, *AFTER, *COEFFICIENTS, "PM") if name in v]
    matrix = np.stack([rows.row(name, v[name]) for name in used], 1) * sizes[:, None]
    right = np.stack([v[name] if name in (*BEFORE, *AFTER) else zero for name in used], 1)
    scale = np.abs(matrix).max(2, keepdims=True) + 1e-300
    u, s, vt = np.linalg.svd(matrix / scale)
    keep = s > RANK_TOL * s[:, :1]
    inverse = np.where(keep, 1.0 / np.where(keep, s, 1.0), 0.0)
    parts = np.einsum("nij,ni->nj", u[:, :, : s.shape[1]], right / scale[..., 0]) * inverse
    state = np.einsum("njk,nj->nk", vt[:, : s.shape[1]], parts)
    misses = np.einsum("nij,nj->ni", matrix / scale, state) - right / scale[..., 0]
    is_open = np.concatenate([~keep, np.ones((count, 9 - s.shape[1]), bool)], 1)
    directions = np.where(is_open[..., None], vt, 0.0)
    impacts = Impacts({**bodies, **dict(zip(STATE, (state * sizes).T, strict=True))})
    found = {}
    for name in wanted:
        gradient = rows.row(name, np.broadcast_to(impacts[name], count)) * sizes
        loose = np.abs(np.einsum("njk,nk->nj", directions, gradient)).max(1)
        determined = loose <= DETERMINED_TOL * np.abs(gradient).max(1)
        found[name] = np.where(determined, impacts[name], np.nan)
    return found, np.abs(misses).max(1) * speed, np.broadcast_to(impacts["gt"] / speed, count)


class _Rows:
    """Velocities and laws as rows over the state, from the impacts of its unit vectors."""

    def __init__(self, basis: list[Impacts], mass: Array) -> None:
        self.mass = mass
        count = len(mass)
        state = {
            name: np.stack([np.broadcast_to(b[name], count) for b in basis]) for name in MOTION
        }
        bodies = {name: basis[0].values[name] for name in (*VEHICLES, "M")}
        relative, _ = evaluate({**bodies, **state, "MU": 0.0}, CONTACT)
        self.columns = {name: x.T for name, x in (*state.items(), *relative.items())}

    def row(self, name: str, value: Array) -> Array:
        """Return a velocity, or Equation 15, 16 or 18 with the value of its coefficient."""
        if name not in COEFFICIENTS:
            return self.columns[name]
        columns, x = self.columns, value[:, None]
        if name == "E":
            return np.asarray(columns["VS"] + x * columns["gn"])
        if name == "MUP":
            sliding = columns["gt_after"] * self.mass[:, None]
            return np.where(x == PIVOT, sliding, columns["PT"] - x * columns["PN"])
        push = columns["PM"] * (columns["ia"] + columns["ib"])
        return np.asarray((1.0 - x) * (columns["WAF"] - columns["WBF"]) - x * push)
