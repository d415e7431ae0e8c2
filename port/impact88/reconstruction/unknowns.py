"""Equations 13 to 18 solved for any unknowns, over arrays.

Over the six velocities before the impact and the three impulses, what is known is linear: a
velocity, or one law with its coefficient. A singular value decomposition of each element's
equations tells what they determine (Golub and Van Loan, *Matrix Computations*, 5.5).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError
from ..mechanics.solve import BODIES, POINT, evaluate
from ..names import check_names, missing
from .impacts import AFTER, BEFORE, COEFFICIENTS, IMPULSES, PIVOT, VEHICLES, Array, Impacts
from .known import check_equations, check_moment

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
    >>> (solution,) = impact88.solve_for(known)
    >>> print(solution["VX"].round(2), solution.mismatch.round(2))
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
    equations = values.pop("M", BODIES)
    check_equations(equations)
    if np.all(equations == POINT):
        values |= dict.fromkeys(("DA", "DB", "PA", "PB", "WA", "WB", "PM"), np.zeros(()))
        values |= dict.fromkeys(("IA", "IB"), np.ones(()))
        values = {"TA": np.zeros(()), "TB": np.zeros(()), **values}
    elif "EM" in values:
        check_moment(values["EM"], values["EM"])
    if lacking := [name for name in VEHICLES if name not in values]:
        raise UserError(missing(lacking))
    names = [n for n in UNKNOWNS if n not in values] if unknown is None else list(unknown)
    check_names(names, UNKNOWNS, "value to solve for")
    shape = np.broadcast_shapes(*(x.shape for x in values.values()))
    values = {name: np.broadcast_to(x, shape).ravel() for name, x in values.items()}
    solutions = [_solve(reading, names, shape) for reading in _readings(values)]
    solutions = [solution for solution in solutions if solution.agrees.any()]
    wanted = [name for name in names if name in MOTION] or names
    if not solutions or all(np.isnan(solutions[0][name]).all() for name in wanted):
        raise UserError(f"{', '.join(names)} do not follow from what is known")
    return solutions


def _readings(values: dict[str, Array]) -> list[dict[str, Array]]:
    """Return the values with each sign of MU as MUP."""
    if "MU" not in values:
        return [values]
    mu = values["MU"]
    signs = (1.0,) if np.all((mu == 0) | (mu == PIVOT)) else (1.0, -1.0)
    return [{**values, "MUP": np.where(mu == PIVOT, mu, sign * mu)} for sign in signs]


def _solve(v: Mapping[str, Array], names: Sequence[str], shape: tuple[int, ...]) -> Solution:
    """Return the unknowns of elements, in their shape."""
    count = len(v["MA"])
    bodies = {name: v[name] for name in VEHICLES}
    largest = [np.abs(v[name]).max(initial=0.0) for name in (*BEFORE, *AFTER) if name in v]
    speed = float(max(largest, default=0.0)) or 1.0
    mass = 1.0 / (1.0 / v["MA"] + 1.0 / v["MB"])
    sizes = np.stack([np.ones(count)] * 6 + [mass] * 3, 1) * speed
    columns = _columns(bodies, count)
    equations = [name for name in (*BEFORE, *AFTER, *COEFFICIENTS, "PM") if name in v]
    matrix = (
        np.stack([_row(name, v[name], columns, mass) for name in equations], 1) * sizes[:, None]
    )
    right = np.stack([v[n] * (n in BEFORE or n in AFTER) for n in equations], 1)
    scale = np.abs(matrix).max(2) + 1e-300
    matrix, right = matrix / scale[..., None], right / scale
    u, s, vt = np.linalg.svd(matrix)
    rank = s.shape[1]
    keep = s > RANK_TOL * s[:, :1]
    parts = np.einsum("nij,ni->nj", u[:, :, :rank], right) / np.where(keep, s, np.inf)
    state = np.einsum("njk,nj->nk", vt[:, :rank], parts)
    mismatch = np.abs(np.einsum("nij,nj->ni", matrix, state) - right).max(1) * speed
    is_open = np.pad(~keep, ((0, 0), (0, len(STATE) - rank)), constant_values=True)
    directions = np.where(is_open[..., None], vt, 0.0)
    impacts = Impacts({**bodies, **dict(zip(STATE, (state * sizes).T, strict=True))})
    unknowns = {}
    for name in names:
        value = np.broadcast_to(impacts[name], count)
        slopes = _row(name, value, columns, mass) * sizes
        change = np.abs(np.einsum("njk,nk->nj", directions, slopes)).max(1)
        is_determined = change <= DETERMINED_TOL * np.abs(slopes).max(1)
        unknowns[name] = np.where(is_determined, value, np.nan).reshape(shape)
    agrees = np.isfinite(mismatch)
    if "MU" in v:
        sliding = impacts["gt"] / speed
        is_end = (np.abs(sliding) <= RANK_TOL) | (v["MUP"] == PIVOT)
        agrees &= is_end | (v["MUP"] * sliding <= 0)
    return Solution(unknowns, mismatch.reshape(shape), agrees.reshape(shape))


def _columns(bodies: Mapping[str, Array], count: int) -> dict[str, Array]:
    """Return velocities, impulses and relative velocities of impacts of which one component of the
    state is 1 and the others are 0: element, component."""
    zeros = dict.fromkeys(STATE, np.zeros(count))
    impacts = [Impacts({**bodies, **zeros, name: np.ones(count)}) for name in STATE]
    state = {name: np.stack([np.broadcast_to(i[name], count) for i in impacts]) for name in MOTION}
    relative, _ = evaluate({**bodies, "M": BODIES, "MU": 0.0, **state}, CONTACT)
    return {name: x.T for name, x in (*state.items(), *relative.items())}


def _row(name: str, value: Array, columns: Mapping[str, Array], mass: Array) -> Array:
    """Return a velocity, or Equation 15, 16 or 18 with the value of its coefficient, as a row over
    the state."""
    x = value[:, None]
    if name == "E":
        return np.asarray(columns["VS"] + x * columns["gn"])
    if name == "MUP":
        sliding = columns["gt_after"] * mass[:, None]
        return np.where(x == PIVOT, sliding, columns["PT"] - x * columns["PN"])
    if name == "EM":
        push = columns["PM"] * (columns["ia"] + columns["ib"])
        return np.asarray((1.0 - x) * (columns["WAF"] - columns["WBF"]) - x * push)
    return columns[name]
