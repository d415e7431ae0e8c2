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

from ..cases.case import POINT_DEFAULTS
from ..errors import UserError
from ..mechanics.solve import BODIES, POINT, evaluate
from ..names import check_names, missing
from .impacts import AFTER, BEFORE, COEFFICIENTS, IMPULSES, PIVOT, VEHICLES, Array, Impacts
from .known import check_equations, check_moment

RANK_TOL = 1e-10  # relative size of singular values, and of sliding, that is 0
DETERMINED_TOL = 1e-6  # change of a quantity along open directions that is rounding
STATE = (*BEFORE, *IMPULSES)
MOTION = (*BEFORE, *AFTER)
CONTACT = ("gn", "VS", "gt_after", "ia", "ib")
UNKNOWNS = (*MOTION, *COEFFICIENTS)


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
        values |= {name: np.array(float(text)) for name, text in POINT_DEFAULTS.items()}
    elif "EM" in values:
        check_moment(values["EM"], values["EM"])
    if lacking := [name for name in VEHICLES if name not in values]:
        raise UserError(missing(lacking))
    names = [n for n in UNKNOWNS if n not in values] if unknown is None else list(unknown)
    check_names(names, UNKNOWNS, "value to solve for")
    arrays = np.broadcast_arrays(*values.values())
    shape = arrays[0].shape
    values = dict(zip(values, map(np.ravel, arrays), strict=True))
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
    bodies = {name: v[name] for name in VEHICLES}
    speeds = (float(np.abs(v[name]).max(initial=0.0)) for name in MOTION if name in v)
    speed = max(speeds, default=0.0) or 1.0
    mass = 1.0 / (1.0 / v["MA"] + 1.0 / v["MB"])
    sizes = np.stack([np.ones_like(mass)] * 6 + [mass] * 3) * speed
    columns = _columns(bodies, sizes)
    equations = {name: _row(name, v[name], columns, mass) for name in UNKNOWNS if name in v}
    matrix = np.stack([*equations.values()]).transpose(2, 0, 1)
    right = np.stack([v[name] * (name in MOTION) for name in equations], 1)
    scale = np.abs(matrix).max(2) + 1e-300
    matrix, right = matrix / scale[..., None], right / scale
    inverse = np.linalg.pinv(matrix, RANK_TOL)
    state = np.einsum("nij,nj->in", inverse, right)
    mismatch = np.abs(np.einsum("nij,jn->ni", matrix, state) - right).max(1) * speed
    open_changes = np.eye(len(STATE)) - inverse @ matrix
    impacts = Impacts({**bodies, **dict(zip(STATE, state * sizes, strict=True))})
    unknowns = {}
    for name in names:
        slopes = _row(name, impacts[name], columns, mass)
        change = np.abs(np.einsum("njk,kn->jn", open_changes, slopes)).max(0)
        is_determined = change <= DETERMINED_TOL * np.abs(slopes).max(0)
        unknowns[name] = np.where(is_determined, impacts[name], np.nan).reshape(shape)
    agrees = np.isfinite(mismatch)
    if "MU" in v:
        sliding = impacts["gt"] / speed
        is_end = (np.abs(sliding) <= RANK_TOL) | (v["MUP"] == PIVOT)
        agrees &= is_end | (v["MUP"] * sliding <= 0)
    return Solution(unknowns, mismatch.reshape(shape), agrees.reshape(shape))


def _columns(bodies: Mapping[str, Array], sizes: Array) -> dict[str, Array]:
    """Return velocities, impulses and relative velocities of impacts of which one component of the
    state has its size and the others are 0: component, element."""
    states = np.eye(len(STATE))[..., None] * sizes[:, None]
    impacts = Impacts({**bodies, **dict(zip(STATE, states, strict=True))})
    state = {name: impacts[name] for name in (*MOTION, *IMPULSES)}
    relative, _ = evaluate({**bodies, "M": BODIES, "MU": 0.0, **state}, CONTACT)
    return state | relative


def _row(name: str, x: Array, columns: Mapping[str, Array], mass: Array) -> Array:
    """Return a velocity, or Equation 15, 16 or 18 with the value of its coefficient, over the
    state."""
    if name == "E":
        return np.asarray(columns["VS"] + x * columns["gn"])
    if name == "MUP":
        return np.where(x == PIVOT, columns["gt_after"] * mass, columns["PT"] - x * columns["PN"])
    if name == "EM":
        push = columns["PM"] * (columns["ia"] + columns["ib"])
        return np.asarray((1.0 - x) * (columns["WAF"] - columns["WBF"]) - x * push)
    return columns[name]
