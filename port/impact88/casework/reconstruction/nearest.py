"""Least squares within the admissible set: the impact nearest to what is known among those that
count (`admissible`), where the nearest of all is none of them.

A condition of the set is one more condition of the equations: what lies beyond its border is a
residual, what lies within is none. At the ends of iterations the borders that are crossed are held,
and Newton's method ends on them."""

from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.geometry import within_doubles
from ...collision.units import System as Units
from ...mechanics.closedform.statusbits import RANGES
from ...mechanics.state import State
from ...messages.plaintable import number
from ...status import sentences
from .admissible import (
    APPROACH,
    ENERGY,
    LAWS,
    NORMAL,
    PUSH,
    Admissible,
    friction_limits,
)
from .leastsquares import descend, polish
from .solution import Adjusted, Reconstruction, describe
from .system import System

Floats = NDArray[np.float64]

CONDITION_TOL = 1e-9  # beyond a border by less, a condition holds
BORDER_TOL = 1e-5  # iterations that end at a border may stop as near, on either side
CANDIDATE_TOL = 1e-3  # largest scaled residual of conditions where Newton's method is started
DUPLICATE_TOL = 1e-5  # of end points closer than this one is polished
MAX_ENDS = 12  # polished


MAX_MOVES = 3  # measurements named that would have to move; of exact values all are
MIN_MOVE = 1e-3  # of an exact velocity, relative to the largest, that is named
ROUNDING = 1e-9  # of a value as it was known: what is left of it by less is zero


class Border(NamedTuple):
    """One end of a condition of the admissible set: ``name``, and 0 for its lower end, 1 for its
    upper end."""

    name: str
    end: int

    def within(self, state: State, admissible: Admissible) -> Any:
        """Return how far impacts lie within, negative beyond; real or complex."""
        return admissible.ends(state, self.name)[self.end]

    def beyond(self, state: State, admissible: Admissible) -> Any:
        """Return the same beyond the border, and 0 within."""
        within = self.within(state, admissible)
        return np.where(np.real(within) < 0, within, 0.0)


class Nearest(NamedTuple):
    """The nearest admissible impact: its equations, in which the ``borders`` that limit it are
    conditions, the scaled variables, and the sum of squared adjustments."""

    system: System
    x: Floats
    borders: tuple[str, ...]
    squares: float


def borders(system: System) -> list[Border]:
    """Return the borders that limit a fit: those of the admissible set, and of E and EM where they
    are known within a tolerance."""
    names = [name for name in Admissible(system).rows if name != NORMAL]  # that has no slope
    names += [n for n in RANGES if n in system.known and system.known[n].varies]
    return [Border(n, end) for n in names for end in ((0,) if n in LAWS else (0, 1))]


@within_doubles
def is_admissible(solution: Reconstruction) -> bool:
    """Return True if an impact found counts. Coefficients that are given are the user's."""
    system, state = solution.system, solution.system.state(solution.x)
    admissible = Admissible(system)
    if NORMAL in admissible.rows and solution.impossible:
        return False
    return all(
        _number(border.within(state, admissible)) >= -CONDITION_TOL for border in borders(system)
    )


def counts(solution: Reconstruction) -> bool:
    """Return True if an impact found is possible and, unless it follows from exact values,
    admissible, as far as it is determined. Friction that exact values need is remarked upon."""
    is_measured = solution.system.observations and not solution.assumed
    is_judged = is_measured and not solution.undetermined
    return not solution.impossible and (not is_judged or is_admissible(solution))


def with_nearest(
    solutions: list[Reconstruction], rng: np.random.Generator, count: int
) -> list[Reconstruction]:
    """Return the solutions and the nearest admissible impact, where none of them is admissible:
    first, if it agrees with what is known, and else beside each. Exact values cannot move: the
    nearest impact is sought with the same tolerance on all known velocities. ``count``: of random
    starts."""
    exact, is_assumed = solutions[0].system, solutions[0].assumed
    is_acceptable = is_admissible if exact.observations and not is_assumed else counts
    if any(solution.undetermined or is_acceptable(solution) for solution in solutions):
        return solutions
    system = exact if exact.observations else exact.with_equal_tolerances()
    roots = [system.starts_at(exact, solution.x, rng) for solution in solutions]
    found = find_nearest(system, np.concatenate([system.random_starts(rng, count), *roots], axis=1))
    if found is None:
        return solutions
    is_assumed |= system is not exact
    nearest = replace(describe(found.system, found.x, is_assumed), limited=found.borders)
    if nearest.undetermined or nearest.impossible:
        return solutions
    agrees = nearest.is_within_limits or not nearest.evidence.contradictory
    if agrees and not is_assumed:
        return [nearest, *solutions]
    return [replace(solution, nearest=nearest) for solution in solutions]


@within_doubles
def refusal(solution: Reconstruction, units: Units) -> str:
    """Return why no admissible impact agrees with what is known: the conditions that an impact
    found misses, by how much, and which known values would have to move how far for the nearest
    admissible one."""
    state, admissible = solution.system.state(solution.x), Admissible(solution.system)
    misses = [
        _amount(border, state, units)
        for border in ([] if solution.undetermined else borders(solution.system))
        if _number(border.within(state, admissible)) < -CONDITION_TOL
    ]
    misses = misses or sentences(solution.impossible)
    text = f"no impact that physics allows agrees with what is known: {'; '.join(misses)}"
    moves = [] if solution.nearest is None else _moves(solution.nearest, units)
    return f"{text}. The nearest one has {'; '.join(moves)}" if moves else text


def _moves(nearest: Reconstruction, units: Units) -> list[str]:
    """Return the known values that the nearest admissible impact has elsewhere, and where: those
    beyond one standard deviation, the farthest ones, or all exact ones that move."""
    known = nearest.system.known

    def deviations(item: Adjusted) -> float:
        return abs(item.adjusted - item.measured) / known[item.name].standard_deviation

    least = MIN_MOVE * float(nearest.system.speed) if nearest.assumed else 1.0
    moves: list[str] = []
    for item in sorted(nearest.adjusted, key=deviations, reverse=True):
        if deviations(item) < least or (len(moves) == MAX_MOVES and not nearest.assumed):
            break
        adjusted = item.adjusted if abs(item.adjusted) > ROUNDING * abs(item.measured) else 0.0
        old, new = (units.display_unwrapped(item.name, x) for x in (item.measured, adjusted))
        place = f"{item.name} at {number(new, 4)} {units.unit(item.name)}".rstrip()
        moved = "" if nearest.assumed else f" ({deviations(item):.1f} sd)"
        moves.append(f"{place}, not {number(old, 4)}{moved}")
    return moves


def _amount(border: Border, state: State, units: Units) -> str:
    """Return by how much an impact misses a condition, in words."""

    def amount(name: str, value: Any) -> str:
        size = number(abs(units.factor(name)) * abs(_number(value)), 3)
        return f"{size} {units.unit(name)}".rstrip()

    if border.name == APPROACH:
        return f"the vehicles separate at {amount('VC', state.relative_before[0])}"
    if border.name == PUSH:
        return f"the impulse pulls with {amount('PN', state.values['PN'])}"
    if border.name == ENERGY:
        return f"energy of {amount('EL', state.energy_lost)} is gained"
    value = number(_number(state[border.name]), 3)
    if border.name in RANGES:
        low, high = RANGES[border.name]
        reason = " (1, no moment at the contact, counts where it is given)" * (border.name == "EM")
        return f"{border.name} is {value}, not from {low:g} to {high:g}{reason}"
    ends = [number(_number(end), 3) for end in friction_limits(state)]
    return f"P_t/P_n is {value}, not from {ends[0]} to {ends[1]}"


def find_nearest(system: System, starts: Floats) -> Nearest | None:
    """Return the nearest admissible impact that iterations from ``starts`` lead to, None if no
    admissible impact meets what is known exactly."""
    admissible, limits = Admissible(system), borders(system)
    limited = system.limited_by([partial(b.beyond, admissible=admissible) for b in limits])
    ends = descend(limited, starts)
    residual = limited.residuals(limited.state(ends))
    count = limited.condition_count
    squares = np.square(residual[count:]).sum(axis=0)
    is_candidate = np.abs(residual[:count]).max(axis=0, initial=0.0) <= CANDIDATE_TOL
    best: Nearest | None = None
    tried: list[Floats] = []
    for i in np.argsort(squares, kind="stable"):
        end = ends[:, i : i + 1]
        is_new = all(np.abs(end - other).max() > DUPLICATE_TOL for other in tried)
        if not (is_candidate[i] and is_new) or len(tried) == MAX_ENDS:
            continue
        tried.append(end)
        for reach in (0.0, BORDER_TOL):
            found = _polish_on_borders(system, end, admissible, limits, reach)
            if found is not None and (best is None or found.squares < best.squares):
                best = found
    return best


def _polish_on_borders(
    system: System, end: Floats, admissible: Admissible, limits: list[Border], reach: float
) -> Nearest | None:
    """Return the minimum near an end of iterations on the borders that are crossed there, or as
    near as ``reach``; None where there is none, or it is not admissible."""
    state = system.state(end)
    held = [b for b in limits if _number(b.within(state, admissible)) < reach]
    on_borders = system.limited_by([partial(b.within, admissible=admissible) for b in held])
    try:
        x = polish(on_borders, end)
    except np.linalg.LinAlgError:
        return None
    if x is None:
        return None
    state = system.state(x)
    if any(_number(border.within(state, admissible)) < -CONDITION_TOL for border in limits):
        return None
    adjustments = on_borders.residuals(state)[on_borders.condition_count :]
    names = tuple(border.name for border in held)
    return Nearest(on_borders, x, names, float(np.square(adjustments).sum()))


def _number(value: Any) -> float:
    return float(np.ravel(np.real(value))[0])
