"""Any reconstruction with its tolerances: adjustment of observations with conditions.

What is known of an impact is adjusted so that the laws and the exact values hold (`system.System`)
and the sum of squared adjustments, each in units of its standard deviation, is least: by Gauss and
Newton's steps, or Levenberg and Marquardt's while tolerances are tightened little by little, and at
last by Newton's method, which shows that nothing beside it is less. First-order deviations and
correlations come from the same equations.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..collision.geometry import GEOMETRY, with_point_masses, within_doubles
from ..collision.mappings import within_limits
from ..collision.uncertain import Uncertain, fixed_value
from ..errors import UserError
from ..mechanics.closedform.solve import share_typed, solve
from ..mechanics.outcome import IMPOSSIBLE, outcome
from ..mechanics.state import (
    COURSES,
    CRUSH,
    DIRECTIONS,
    FORCES,
    KNOWABLE,
    OTHERS,
    QUANTITIES,
    SPEEDS,
    State,
)
from ..names import (
    COEFFICIENTS,
    FINAL_STATE,
    IMPULSES,
    PIVOT,
    SCENE,
    VELOCITIES,
    check_names,
)
from ..status import Status
from .evidence import Evidence, weigh
from .laws import missed_laws, told
from .quadrics import MAX_EQUATIONS, Paths, follow_paths, quadratic_equations
from .system import PARAMETERS, SPINS, System
from .unknowns import UnsolvableError, check_physical, solve_for, typed

Floats = NDArray[np.float64]
Progress = Callable[[int], object]

_STARTS = 240  # random starts in a batch
_IDLE_BATCHES = 4
"""The search ends when so many batches in turn find no further impact: the rarest of 80 random
problems are found from one start in 200."""
_MAX_BATCHES = 16  # of a search that keeps finding impacts
_FITTED_STARTS = 120  # starts in a batch where nothing agrees exactly and a fit is sought
_LEFT_OUT = 8  # sets of superfluous values left out, each for exact impacts as starts of a fit
_NEARBY = 0.3  # spread of starts around impacts that were found before
_ASIDE = 1e-2  # scaled distance at which a fold is told from a continuum
_FOLDED = 1e-4  # singular value, of the largest, up to which branches nearly meet
_FOLDED_PART = 1e-3  # part of a gradient along the fold up to which a quantity does not feel it
_SAME = 1e-6  # scaled variables that differ by no more are of the same impact
_TIGHTENED_FIRST, _TIGHTENED = 4, 12
"""Of the starts so many with tolerances tightened little by little, the second number where nothing
is found by then, or something not determined. Twice as many find the same in 75 problems."""
# of these none changes a solution of 104 problems when doubled
_STEPS, _LONGEST, _LAST = 50, 2.0, 1e-14
"""Of an iteration (a descent: twice as many); longest and last, the last as a share of them."""
_TIGHTER, _TIGHTEST = 0.1, 1e-12
"""Tolerances are tightened by so much at a time, to so much of an ordinary size at most."""
_ROUGHLY, _CLOSELY = 0.1, 1e-9
"""The share of the squares a descent must gain: while tolerances are tightened, and at last."""
_HELD = 100.0
"""Conditions count so many times as much as the tightest tolerance."""
_NEARLY, _HOLDS = 1e-3, 1e-10
"""What conditions may leave over where the exact solution is sought, and there."""
_BESIDE, _CLOSE = 1e-5, 0.5
"""Of ends no farther apart one is followed, no farther than the second."""
_FEW = 8
"""Ends followed where something is not determined."""
_DIFFERENCE, _DOWNWARD = 1e-6, 1e-9
"""Half the distance slopes are compared over, for curvatures; curvatures that are rounding."""
_RANK, _OPEN = 1e-10, 1e-7
"""Singular values, and shares of a gradient in the null space, up to that are none."""
_LIKELY = 4.0
"""Impacts with so many times the least sum of squares are reported, too."""
_FRICTIONS, _SETTLED = 40, 1e-12
"""Frictions tried, of which secants need six to ten, and the change of P_t/P_n at which it has
settled. Half or twice as much finds the same in 60 problems."""
_HELPFUL_FIRST = ("WAF", "WBF", "WA", "WB", "E", "MUP", "EM")
"""Of what is not known, what can be found out best."""


def straight(system: System, starts: Floats) -> tuple[Floats, Floats]:
    """Gauss and Newton from several starts, a column each: where their steps end, and the
    largest of what conditions leave over there. Steps may climb, as long as the conditions hold
    no worse."""
    x, left_over, _ = _stepped(system, starts)
    return x, left_over


def _stepped(system: System, starts: Floats) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Return the same as `straight`, and whose steps came to an end."""
    count, x = len(system.conditions), starts.copy()
    going = np.arange(x.shape[1])
    for _ in range(_STEPS):
        here = x[:, going]
        residual, slopes = system.linearized(here, system.left)
        steps = _steps(residual, slopes, count)
        size = np.abs(steps).max(axis=0, initial=0.0)
        longest = _LONGEST * np.maximum(1.0, np.abs(here).max(axis=0, initial=0.0))
        steps = steps * np.minimum(1.0, longest / np.maximum(size, longest))
        before = np.abs(residual[:count]).max(axis=0, initial=0.0)
        for _ in range(12):
            tried = here + steps
            after = np.abs(system.left(system.state(tried))[:count]).max(axis=0, initial=0.0)
            worse = after > np.maximum(1.5 * before, 1e-9)
            if not worse.any():
                break
            steps = np.where(worse, steps / 2, steps)
        x[:, going] = tried
        going = going[size >= _LAST * (1 + np.abs(tried).max(axis=0, initial=0.0))]
        if not len(going):
            break
    left_over = np.abs(system.left(system.state(x))[:count]).max(axis=0, initial=0.0)
    settled = np.ones(x.shape[1], bool)
    settled[going] = False
    return x, left_over, settled


def tightened(system: System, x: Floats) -> tuple[Floats, float]:
    """Least squares from one start, and the largest of what conditions leave over at the end. Tight
    tolerances among loose ones make a narrow curved valley: all begin loose and are tightened
    little by little."""
    held = np.full(len(system.conditions), _HELD)
    shares = np.array(
        [system.known[n].standard_deviation / system.scale(n) for n in system.observations]
    )
    # vehicles and coefficients are known about well enough to begin with
    spared = np.array([n in GEOMETRY or n in COEFFICIENTS for n in system.observations])
    loosest, tightest = 1.0, max(float(shares.min()), _TIGHTEST)
    while loosest > tightest:
        weights = np.where(spared, 1.0, np.minimum(1.0, shares / loosest))
        x = _descended(system, x, np.concatenate([held / loosest, weights])[:, None], _ROUGHLY)
        loosest *= _TIGHTER
    rows = np.concatenate([held / tightest, np.ones(len(shares))])
    x = _descended(system, x, rows[:, None], _CLOSELY)
    return x, float(np.abs(system.left(system.state(x))[: len(held)]).max(initial=0.0))


def _descended(system: System, x: Floats, rows: Floats, enough: float) -> Floats:
    """Least squares of what conditions and observations leave over, ``rows`` times as much, in
    damped steps (Levenberg, Marquardt) until three gain less than the share ``enough``."""
    residual, damping, idle = rows * system.left(system.state(x)), 1e-3, 0
    for _ in range(2 * _STEPS):
        jacobian = rows * system.slopes(x)
        if not (np.isfinite(jacobian).all() and np.isfinite(residual).all()):
            break
        u, s, vt = np.linalg.svd(jacobian, full_matrices=False)
        before = after = float(np.square(residual).sum())
        while not after < before:
            inverse = (vt.T * (s / (s * s + damping * s[0] ** 2))) @ u.T
            step = -inverse @ residual
            size = np.abs(step).max()
            if not size > _LAST:
                return x
            step *= min(1.0, _LONGEST / size)
            tried, missed = _bent(system, x + step, residual + jacobian @ step, inverse, rows)
            after = float(np.square(missed).sum())
            damping *= 10
        x, residual, damping = tried, missed, max(damping / 100, 1e-16)
        idle = 0 if before - after > enough * before else idle + 1
        if idle == 3:
            break
    return x


def _bent(
    system: System, x: Floats, promised: Floats, inverse: Floats, rows: Floats
) -> tuple[Floats, Floats]:
    """A straight step's end brought to where what is left over is what the slopes promised, as
    long as that lessens it: so steps follow narrow curved valleys."""
    after = rows * system.left(system.state(x))
    for _ in range(_STEPS):
        if not np.square(after).sum() > 1.1 * np.square(promised).sum():
            break
        tried = x - inverse @ (after - promised)
        missed = rows * system.left(system.state(tried))
        if not np.square(missed).sum() < 0.9 * np.square(after).sum():
            break
        x, after = tried, missed
    return x, after


def polished(system: System, x: Floats) -> tuple[Floats, float]:
    """Newton's method from close by, for conditions that hold exactly and adjustments that are
    least, curvature and all: the adjusted impact, and the largest of what its conditions leave
    over, infinite where no impact is found that is least."""
    count, last, begin = len(system.conditions), np.inf, x
    for _ in range(_STEPS):
        residual, slopes = system.linearized(x, system.left)
        step, least = _newton(system, x, residual[:, 0], slopes[:, :, 0])
        size, far = np.abs(step).max(initial=0.0), 1 + np.abs(x).max(initial=0.0)
        if not size < _CLOSE * far:
            return x, np.inf
        x = x + step[:, None]
        if size < _LAST * far or 1e-9 * far > size > 0.5 * last:
            break
        last = size
    else:
        return x, np.inf
    before, after = system.left(system.state(begin)), system.left(system.state(x))
    # neither a saddle nor another valley
    if not least or np.square(after[count:]).sum() > 1.01 * np.square(before[count:]).sum() + 1e-9:
        return x, np.inf
    return x, float(np.abs(after[:count]).max(initial=0.0))


def _newton(system: System, x: Floats, residual: Floats, jacobian: Floats) -> tuple[Floats, bool]:
    """The step to where the gradient of the squares has no part along the conditions, and
    whether they curve upward there. What nothing determines to first order stays."""
    count, size = len(system.conditions), len(x)
    inverse, null = pseudo_inverse(jacobian[:count])
    loose, measured = jacobian[count:], residual[count:]
    multipliers = np.concatenate([-inverse.T @ (loose.T @ measured), measured])
    aside = _DIFFERENCE * np.eye(size)
    slopes = system.linearized(np.concatenate([x + aside, x - aside], axis=1), system.left)[1]
    ahead, behind = np.split(np.einsum("r,rik->ik", multipliers, slopes), 2, axis=1)
    curvature = (ahead - behind) / (2 * _DIFFERENCE)
    # the step along what is determined, the adjustments after it, and the multipliers
    *_, along, _ = _decomposed(jacobian)
    weight = np.abs(loose).max(initial=0.0) or 1.0
    tight, narrow = jacobian[:count] @ along.T, loose @ along.T / weight
    free, rows = len(along), len(loose)
    equations = np.zeros((free + rows + count,) * 2)
    equations[:free, :free] = along @ (curvature + curvature.T) @ along.T / (2 * weight * weight)
    equations[:free, free : free + rows], equations[:free, free + rows :] = narrow.T, tight.T
    equations[free : free + rows, :free], equations[free + rows :, :free] = narrow, tight
    equations[free : free + rows, free : free + rows] = -np.eye(rows)
    right = np.zeros(len(equations))
    right[free : free + rows], right[free + rows :] = -measured / weight, -residual[:count]
    if not (np.isfinite(equations).all() and np.isfinite(right).all()):
        raise np.linalg.LinAlgError("not finite")
    solution = np.linalg.lstsq(equations, right, rcond=1e-15)[0]
    # for every residual and every condition that says something, one curves downward
    downward = np.linalg.eigvalsh(_balanced(equations)) < -_DOWNWARD
    step: Floats = along.T @ solution[:free]
    return step, bool(downward.sum() <= rows + size - null.shape[1])


def _start(system: System, rng: np.random.Generator, count: int) -> Floats:
    """Scaled variables to begin with, ``count`` columns."""
    x = rng.standard_normal((count, len(system.variables))).T
    for i, name in enumerate(system.variables):
        if name in system.nominal:
            x[i] = system.nominal[name] / system.scales[i]
    return x


def _face(system: System, starts: Floats) -> None:
    """Turn the velocities of ``starts`` that run backwards along known courses around."""
    for name, speed in COURSES.items():
        rows = [system.variables.index(n) for n in SPEEDS[speed] if n in system.variables]
        if name in system.known and len(rows) == 2:
            angle = np.radians(system.nominal[name])
            size = np.abs(starts[rows[0]])
            starts[rows[0]], starts[rows[1]] = size * np.cos(angle), size * np.sin(angle)


def _distinct(met: Floats, more: Floats) -> Floats:
    """Return the columns of ``met`` and those of ``more`` that differ from all before."""
    for column in more.T:
        if not (np.abs(met - column[:, None]).max(axis=0, initial=0.0) < _SAME).any():
            met = np.column_stack([met, column])
    return met


def _balanced(matrix: Floats) -> Floats:
    """A symmetric matrix in other units, so that no row is much larger than others: as many of its
    eigenvalues are negative."""
    for _ in range(3):
        largest = np.sqrt(np.abs(matrix).max(axis=1, initial=0.0))
        unit = np.where(largest > 0, largest, 1.0)
        matrix = matrix / np.outer(unit, unit)
    return matrix


def _steps(residual: Floats, slopes: Floats, count: int) -> Floats:
    """The Gauss-Newton steps, a column an impact, that meet the first ``count`` rows and bring the
    others nearest; none (nan) where something is not finite."""
    finite = np.isfinite(residual).all(axis=0) & np.isfinite(slopes).all(axis=(0, 1))
    steps = np.full(slopes.shape[1:], np.nan)
    matrices, over = slopes[:, :, finite].transpose(2, 0, 1), residual[:, finite].T[:, :, None]
    inverse = np.linalg.pinv(matrices[:, :count], rcond=_RANK)
    step = -inverse @ over[:, :count]
    if len(residual) > count:
        loose = matrices[:, count:]
        free = np.eye(slopes.shape[1]) - inverse @ matrices[:, :count]
        narrowed = np.linalg.pinv(loose @ free, rcond=_RANK)
        step = step - free @ (narrowed @ (over[:, count:] + loose @ step))
    steps[:, finite] = step[:, :, 0].T
    return steps


def pseudo_inverse(matrix: Floats) -> tuple[Floats, Floats]:
    """The Moore-Penrose inverse, and a basis of the null space. Raises LinAlgError for a matrix
    that is not finite, whose singular values LAPACK may seek without end."""
    u, s, vt, null = _decomposed(matrix)
    return (vt.T / s) @ u.T, null


def _decomposed(matrix: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """U, the singular values above rounding, V^T, and a basis of the null space."""
    if not np.isfinite(matrix).all():
        raise np.linalg.LinAlgError("not finite")
    u, s, vt = np.linalg.svd(matrix)
    rank = int((s > _RANK * s.max(initial=0.0)).sum())
    return u[:, :rank], s[:rank], vt[:rank], vt[rank:].T


# -- solutions


class Adjusted(NamedTuple):
    """One known value as measured and as adjusted.

    Parameters
    ----------
    name : str
        Name of the quantity.
    measured, tolerance, adjusted : float
        Measured value, its tolerance, and the adjusted value.
    """

    name: str
    measured: float
    tolerance: float
    adjusted: float

    @property
    def moved(self) -> float:
        """Adjustment in tolerances."""
        return (self.adjusted - self.measured) / self.tolerance


class Searched(NamedTuple):
    """Record of the search for impacts.

    Parameters
    ----------
    batches, starts : int
        Batches of random starts, and the starts in all of them.
    idle : int
        The last batches in a row that found no further impact.
    single : bool
        True if the equations are linear or leave something open, so that no search is needed or
        possible.
    impacts, possible : int
        Impacts that agree with what is known, and those of them that physics allows.
    solutions : int
        Solutions of the quadratic equations of exact values, all of which were found; 0 if they
        were not solved.
    nonreal : int
        Those that are complex or at infinity.
    """

    batches: int = 0
    starts: int = 0
    idle: int = 0
    single: bool = False
    impacts: int = 1
    possible: int = 1
    solutions: int = 0
    nonreal: int = 0

    def text(self) -> str:
        """Return a statement of the search.

        Returns
        -------
        str
            One sentence without its full stop.
        """
        impacts = "1 impact" if self.impacts == 1 else f"{self.impacts} impacts"
        if self.possible < self.impacts:
            impacts += f", {self.possible or 'none'} of which physics allows"
        if self.single:
            return impacts
        if self.solutions:
            nonreal = f"{self.nonreal or 'none'} of them complex or at infinity"
            return f"{impacts}; the equations' {self.solutions} solutions were all found, {nonreal}"
        idle = f"the last {self.idle} found no other" if self.idle else "the last found a new one"
        if self.batches <= 1:
            return f"{impacts}, from {self.starts} starts"
        return f"{impacts}; {self.batches} batches of starts ({self.starts} in all), {idle}"


NOT_SEARCHED = Searched()


SHOWN = ("SA", "SB", "DVA", "DVB", "LOSS")
"""Results that a reconstruction is told by in a session."""


@dataclass(frozen=True)
class Reconstruction:
    """One impact that agrees with what is known.

    Parameters
    ----------
    system : System
        The equations, with what is known of the impact.
    x : ndarray
        The adjusted state.
    values : dict of str to float
        Every quantity determined (`state.QUANTITIES`), and the scene's values, adjusted.
    undetermined : tuple of str
        Velocities and coefficients that nothing known determines.
    adjusted : tuple of Adjusted
        What was known within a tolerance: measured and adjusted value.
    redundancy : int
        Known values more than needed.
    squares : float
        Sum of squared adjustments in standard deviations, about the redundancy when tolerances are
        right.
    assumed : bool
        True where the tolerances were taken equal for all known velocities.
    against_sign : bool
        True where friction drives the sliding that MU's sign was chosen to oppose.
    search : Searched
        How impacts were searched for.
    typed_mu : float, optional
        MU, where it is known in size only.
    beside : tuple
        Every impact found, this one too, possible or not.

    Examples
    --------
    >>> known = {name: text for name, text in impact88.sample(1).items() if name != "MU"}
    >>> best, *others = impact88.reconstruct({**known, "VAX": "-13.3 +- 0.5"})
    >>> round(best.values["MUP"], 2)
    0.91
    """

    system: System
    x: Floats
    values: dict[str, float]
    undetermined: tuple[str, ...]
    adjusted: tuple[Adjusted, ...]
    redundancy: int
    squares: float
    assumed: bool = False
    against_sign: bool = False
    search: Searched = NOT_SEARCHED
    typed_mu: float | None = None
    beside: tuple[tuple[System, Floats], ...] = field(default=(), repr=False, compare=False)

    def __repr__(self) -> str:
        shown = ", ".join(
            f"{name} {self.values[name]:.4g}" for name in SHOWN if name in self.values
        )
        adjusted = f", {len(self.adjusted)} values adjusted" if self.redundancy else ""
        return f"<Reconstruction: {shown or 'nothing determined'}{adjusted}>"

    @property
    def collides(self) -> bool:
        """True if the contact points approach and push each other, as far as that is known."""
        state = self.system.state(self.x)
        return bool(state.relative_before[0] < 0 and self.values.get("PN", 1.0) > 0)

    @cached_property
    def impossible(self) -> Status:
        """Bits of STATUS that no real impact has, 0 if the impact is possible."""
        bits = Status(int(outcome(self.values)["STATUS"])) & IMPOSSIBLE
        if not self.collides:
            bits |= Status.PULLING if self.values.get("PN", 1.0) <= 0 else Status.SEPARATING
        return bits

    @cached_property
    def backwards(self) -> tuple[str, ...]:
        """Known courses along which a vehicle drives backwards, and PDOFs that pull."""
        state, system = self.system.state(self.x), self.system
        return tuple(
            name
            for name in DIRECTIONS
            if name in system.known
            and (COURSES.get(name) or "PN") in self.values
            and state.along_and_across(name)[0]
            < -_HOLDS * system.scale("PN" if name in FORCES else "UX")
        )

    @cached_property
    def folded(self) -> tuple[str, ...]:
        """Quantities without a first-order limit, where two branches of impacts nearly meet."""
        rows = self.system.slopes(self.x)
        sizes = np.abs(rows).max(axis=1, initial=0.0)
        rows = rows[sizes > 0] / sizes[sizes > 0, None]
        if self.undetermined or not (len(rows) and np.isfinite(rows).all()):
            return ()
        _, singular, vt = np.linalg.svd(rows)
        weak = vt[(singular > _FOLDED * singular[0]).sum() :].T
        if not weak.shape[1]:
            return ()
        # a speed at its least changes alike to both sides; what is merely uncertain does not
        ahead, here, behind = (
            self.system.left(self.system.state(self.x + side * weak))
            for side in (_ASIDE, 0, -_ASIDE)
        )
        even, odd = np.abs(ahead + behind - 2 * here), np.abs(ahead - behind)
        weak = weak[:, even.max(axis=0) > odd.max(axis=0)]
        gradients = self.system.gradients(self.x, QUANTITIES)
        largest = np.abs(gradients).max(axis=1, initial=0.0)
        along = np.abs(gradients @ weak).max(axis=1, initial=0.0)
        return tuple(
            name
            for name, part, size in zip(QUANTITIES, along, largest, strict=True)
            if name in self.values and name not in self.system.known
            if part > _FOLDED_PART * size
        )

    @cached_property
    def helpful(self) -> tuple[str, ...]:
        """Further values that would determine everything undetermined, empty if none would."""
        _, null = pseudo_inverse(self.system.slopes(self.x))
        rows, names = np.zeros((0, null.shape[1])), []
        wanted = [*dict.fromkeys((*_HELPFUL_FIRST, *self.undetermined))]
        for name, gradient in zip(wanted, self.system.gradients(self.x, wanted), strict=True):
            if name in self.undetermined and np.isfinite(gradient).all():
                row = gradient @ null / np.abs(gradient).max(initial=1e-300)
                tried = np.vstack([rows, row])
                if np.linalg.matrix_rank(tried, tol=_OPEN) > len(rows):
                    rows = tried
                    names.append(name)
        return tuple(names) if len(rows) == null.shape[1] else ()

    @cached_property
    def _unit_responses(self) -> tuple[Floats, Floats]:
        """Return how scaled variables (rows) answer to an error of each observation by its
        deviation, and which part of such an error each observation's own adjustment shows."""
        jacobian = self.system.slopes(self.x)
        count = len(self.system.conditions)
        _, free = pseudo_inverse(jacobian[:count])
        narrowed, _ = pseudo_inverse(jacobian[count:] @ free)
        responses = np.asarray(free @ narrowed)
        return responses, 1 - np.einsum("ij,ji->i", jacobian[count:], responses)

    @property
    def _responses(self) -> Floats:
        # of assumed tolerances nothing but the misfit is known
        return np.asarray(self._unit_responses[0] * (self.evidence.widening if self.assumed else 1))

    @cached_property
    def evidence(self) -> Evidence:
        """Verdict on the evidence: whether the measured values can all be true."""
        return self.weighed()

    @within_doubles
    def weighed(self, inside: bool | None = None) -> Evidence:
        """Return the verdict on the evidence, in the light of a search for feasible impacts.

        Parameters
        ----------
        inside : bool, optional
            True if some impact lies within the limits of all known values at once, False if none
            does, None if that was not searched for.

        Returns
        -------
        Evidence
            Whether the measured values can all be true, and those most at odds.
        """
        shown = dict(zip(self.system.observations, self._unit_responses[1].tolist(), strict=True))
        known = self.system.known
        values = {
            a.name: (
                *(a.measured, a.adjusted),
                *((a.adjusted - a.measured) / known[a.name].standard_deviation, shown[a.name]),
            )
            for a in self.adjusted
        }
        laws = missed_laws(self.system.nominal) if self.assumed else ()
        return weigh(self.squares, self.redundancy, values, inside, self.assumed, laws)

    @within_doubles
    def responses(self, names: Sequence[str]) -> Floats:
        """Return the first-order change of quantities per standard deviation of each known value.

        Parameters
        ----------
        names : sequence of str
            Names of m quantities.

        Returns
        -------
        ndarray, shape (m, k)
            A row for each quantity, a column for each of the k adjusted values, in the order of
            ``adjusted``.
        """
        return np.asarray(self.system.gradients(self.x, names) @ self._responses)

    @within_doubles
    def deviations(self, names: Sequence[str]) -> dict[str, float]:
        """Return first-order standard deviations of quantities, as the tolerances make them.

        Parameters
        ----------
        names : sequence of str
            Names of quantities.

        Returns
        -------
        dict of str to float
            Standard deviation of each quantity, in its own unit.

        Notes
        -----
        Where the known values contradict one another, the deviations mean nothing until they are
        multiplied by ``evidence.widening``.
        """
        sizes = np.sqrt(np.square(self.responses(names)).sum(axis=1))
        return dict(zip(names, sizes.tolist(), strict=True))

    @within_doubles
    def correlations(self, names: Sequence[str]) -> Floats:
        """Return first-order correlations of quantities.

        Parameters
        ----------
        names : sequence of str
            Names of m quantities.

        Returns
        -------
        ndarray, shape (m, m)
            Correlation coefficients, nan where a quantity does not vary.
        """
        responses = self.responses(names)
        units = responses / np.sqrt(np.square(responses).sum(axis=1, keepdims=True))
        return np.asarray(units @ units.T)

    @within_doubles
    def scene(self) -> dict[str, float]:
        """Return the impact as a scene, with MU as line 280 of the listing would hold it.

        Returns
        -------
        dict of str to float
            All 21 values of a scene by name, M too.

        Raises
        ------
        UnsolvableError
            When a value of the scene is not determined; the message names it.
        """
        names = [n for n in ("E", "EM", *VELOCITIES) if not (self.system.point and n == "EM")]
        missing = [n for n in (*names, "MUP") if n not in self.values]
        if missing:
            raise UnsolvableError(f"no scene: {' '.join(missing)} not determined")
        kept = {n: self.values[n] for n in (*GEOMETRY, *names)}
        kept |= {"MU": typed_friction(self.system.state(self.x), self.values["MUP"])}
        return {"M": 4.0 if self.system.point else 6.0, "EM": 0.0, **kept}


def typed_friction(state: State, signed: float) -> float:
    """The MU that line 400 turns into ``signed`` for this impact's sliding."""
    sliding = float(np.ravel(np.real(state.relative_before[1]))[0])
    return float(np.ravel(typed(signed, sliding, map(np.real, state.before)))[0])


def needs_adjustment(known: Mapping[str, Uncertain], wanted: Sequence[str] | None = None) -> bool:
    """Whether `unknowns.solve_for` does not do: values with limits, quantities it does not know, or
    exact values that leave over equations that do not hold."""
    if any(item.varies or name in OTHERS for name, item in known.items()):
        return True
    try:
        solutions = solve_for({name: item.nominal for name, item in known.items()}, wanted)
    except UnsolvableError:
        # what leaves something open may contradict itself all the same
        return bool(missed_laws({name: item.nominal for name, item in known.items()}))
    except UserError:
        return False  # told by the one who shows it
    return any(bool(solution.contradictory) for solution in solutions)


@within_doubles
def reconstruct(
    known: Mapping[str, Uncertain | float | str], progress: Progress = lambda impacts: None
) -> list[Reconstruction]:
    """Every impact found that agrees with what is ``known`` (`KNOWABLE` names; M 6 where left out).

    A number is exact, an `Uncertain` known within its tolerance. MU is known in size only: each
    solution that agrees with the sign line 400 gives it is returned; MUP is signed. Where exact
    values contradict one another and none has a tolerance, all known velocities are given the same
    one (spins divided by the radius of gyration). ``progress`` is called with the impacts looked
    at.

    Raises UserError for names and numbers that cannot be used and for exact values that contradict
    one another beside others with a tolerance, UnsolvableError where nothing unknown is determined.
    """
    given, _ = share_resolved(_checked(known))
    mu = given.pop("MU", None)
    readings = [given]
    if mu is not None:
        readings = [{**given, "MUP": mu}]
        if mu.varies or mu.nominal not in (0, PIVOT):
            turned = replace(mu, nominal=-mu.nominal, low=-mu.high, high=-mu.low)
            readings.append({**given, "MUP": turned})
    found: list[Reconstruction] = []
    failure: UserError | None = None
    searches: list[_Search] = []
    # what contradicts itself in one reading of MU's sign may agree in the other
    for fits in (False, True):
        for reading in readings:
            try:
                search = _Search(reading, progress)
                found += search.found() if search.assumed == fits else []
                searches.append(search)
            except UserError as error:
                failure = error
        agreeing = [s for s in found if mu is None or _agrees(s, mu.nominal)]
        if agreeing:
            return _ordered(agreeing, searches, mu)
    fitted = [replace(s, against_sign=True) for s in found if s.redundancy]
    if fitted:
        return _ordered(fitted, searches, None)
    raise failure or UnsolvableError(
        "neither sign of MU agrees with the sliding it leads to (line 400): no friction that "
        "opposes the sliding joins what is known"
    )


def _invariants(values: Mapping[str, float]) -> list[float]:
    """Return what axes, names and units do not change, as far as it is known, in six digits: the
    fraction of the kinetic energy before that is in spins, e, that energy; then what else impacts
    differ in."""
    pairs = [("A", "B"), ("AF", "BF")]
    rotation = [
        sum(
            # a product of huge spins is infinite, a power of them an error
            values.get(spin, 0.0) * values.get(spin, 0.0) * values[inertia] / 2
            for spin, inertia in (("WA" + after, "IA"), ("WB" + after, "IB"))
            if math.isfinite(values[inertia])
        )
        for after in ("", "F")
    ]
    energy = values.get("KI", 0.0)
    shares = [x / energy if energy else 0.0 for x in rotation]
    speeds = [sum(values.get("S" + x, 0.0) for x in pair) for pair in pairs]
    sizes = [abs(values.get(name, 0.0)) for name in ("E", "VC", "PN", "PT", "PM", "MUP", "EM")]
    sums = [values.get("DVA", 0.0) + values.get("DVB", 0.0), values.get("EL", 0.0)]
    ranks = [shares[0], sizes[0], energy, shares[1], *speeds, *sums, *sizes[1:]]
    return [float(f"{x:.5e}") if abs(x) > 1e-9 else 0.0 for x in ranks]


def _ordered(
    found: list[Reconstruction], searches: "Sequence[_Search]", mu: Uncertain | None
) -> list[Reconstruction]:
    """Return the likely solutions, those that contradict the measurements only where all do, in
    the order of physics: possible impacts before those that break it or drive backwards along a
    known course, those that separate or pull, which are none, last; then by the sum of squared
    adjustments. Ties by what
    no axes, names or units change, the smaller first (`_invariants`). A course is a direction: what
    drives backwards along one is kept only where nothing else is."""
    ahead = [s for s in found if not s.backwards] or found
    # what contradicts the measurements, as standstill does, is no answer beside what agrees
    agreeing = [s for s in ahead if not s.evidence.contradictory] or ahead
    possible = [s for s in agreeing if not s.impossible]
    kept = []
    for group in (possible, [s for s in agreeing if s.impossible]):
        least = min((s.squares for s in (group if group is possible else agreeing)), default=0.0)
        kept += [s for s in group if s.squares <= max(_LIKELY * least, 1e-9)]

    def order(solution: Reconstruction) -> tuple[float, ...]:
        squares = float(f"{max(solution.squares, 1e-9):.6e}")
        broken = solution.impossible
        no_impact = bool(broken & (Status.SEPARATING | Status.PULLING))
        ranks = _invariants(solution.values)
        return bool(broken), no_impact, squares, broken.bit_count(), *ranks

    search = Searched(
        sum(each.batches for each in searches),
        sum(each.starts for each in searches),
        min((each.idle for each in searches), default=0),
        all(each.single for each in searches),
        len(kept),
        sum(not solution.impossible for solution in kept),
    )
    paths = [each.paths for each in searches if each.paths]
    if len(paths) == len(searches):
        solutions = sum(each.total for each in paths)
        nonreal = sum(each.complex_ends + each.infinite_ends for each in paths)
        search = search._replace(solutions=solutions, nonreal=nonreal)
    beside = tuple((s.system, s.x) for s in ahead)
    shared: dict[str, Any] = {"search": search, "beside": beside}
    if mu is not None and (mu.varies or mu.nominal not in (0, PIVOT)):
        shared["typed_mu"] = mu.nominal
    return [replace(s, **shared) for s in sorted(kept, key=order)]


def _checked(known: Mapping[str, Uncertain | float | str]) -> dict[str, Uncertain]:
    given = within_limits(known)
    check_names(given, KNOWABLE, "value of an impact")
    if given.setdefault("M", fixed_value(6.0)).nominal == 4:
        ignored = (*SPINS, "EM", "DA", "DB", "PA", "PB", "IA", "IB")
        given = {name: item for name, item in given.items() if name not in ignored}
        given = {n: fixed_value(v) for n, v in with_point_masses({"M": 4.0}).items()} | given
    check_physical(
        {n: np.array([x.nominal if x.kind == "normal" else x.low]) for n, x in given.items()}
    )
    if given["M"].varies:
        raise UserError("M must be 6, or 4 for point masses")
    _check_crush(given)
    for name, item in given.items():
        if name in SPEEDS and item.nominal < 0:
            raise UserError(f"{name} is negative; expected a speed, its course beside it")
    return given


def _check_crush(given: dict[str, Uncertain]) -> None:
    """Raise UserError unless the crush of both vehicles is known, or of none; a rigid barrier's is
    filled in: it loses no energy."""
    for vehicle in "AB":
        names = [n for n in CRUSH if n in given and n.endswith(vehicle)]
        if len(names) == 2:
            raise UserError(f"{' and '.join(names)} are both given; expected one of them")
        own = "AB".replace(vehicle, "")
        if any(n in given for n in CRUSH if n.endswith(own)) and not names:
            if not math.isinf(given["M" + vehicle].nominal):
                raise UserError("ELA and ELB (or EBSA and EBSB) sum to EL; expected both, or EL")
            given["EL" + vehicle] = fixed_value(0.0)
        for name in names:
            if given[name].nominal < 0:
                raise UserError(f"{name} is negative; expected what was lost in {vehicle}")


def _agrees(solution: Reconstruction, mu: float) -> bool:
    signed = solution.system.nominal["MUP"]
    known = not set(VELOCITIES) & set(solution.undetermined)
    return not known or typed_friction(solution.system.state(solution.x), signed) == mu


class _Search:
    """The impacts nearest to what is known, friction signed, each once.

    ``begin``: where to begin, a column each; ``at_hand``: whether measured values agree with one
    another there; ``assumed``: exact values contradict one another, and the known velocities were
    given tolerances."""

    def __init__(self, known: Mapping[str, Uncertain], progress: Progress) -> None:
        self.solutions: list[Reconstruction] = []
        self.open: list[Reconstruction] = []
        self.followed: list[Floats] = []
        self.rng = np.random.default_rng(1988)
        self.batches = self.starts = self.idle = self.times_open = 0
        self.paths: Paths | None = None
        plain = System(known, adjusted=False, progress=progress)
        loose = any(known[name].varies for name in PARAMETERS if name in known)
        self.linear = plain.linear and not loose  # one valley, without bends
        x = self.exact_impacts(plain, 1 if plain.linear and not loose else _STARTS)
        self.at_hand = bool(x.shape[1])
        self.assumed = not self.at_hand and not any(item.varies for item in known.values())
        if self.assumed:
            for name in (n for n in (*VELOCITIES, *FINAL_STATE) if n in known):
                deviation = 1 / plain.gyration if name in SPINS else 1.0
                loose_one = Uncertain("normal", known[name].nominal, -np.inf, np.inf, deviation)
                known = {**known, name: loose_one}
        self.system = System(known, adjusted=True, progress=progress)
        count = x.shape[1] or (1 if self.linear else _FITTED_STARTS)
        self.begin = _start(self.system, self.rng, count)
        if self.at_hand:
            self.begin = self.beginnings(plain, x)
        elif not (self.linear or self.assumed):
            self.begin = np.concatenate([self.exact_without(known), self.begin], axis=1)

    def beginnings(self, plain: System, x: Floats) -> Floats:
        """Return the starts that have the velocities and impulses of exact impacts ``x``."""
        begin, state = _start(self.system, self.rng, x.shape[1]), plain.state(x)
        for row, name in enumerate(self.system.variables):
            if name in VELOCITIES or name in IMPULSES:
                begin[row] = state[name] / self.system.scales[row]
        return begin

    def exact_without(self, known: Mapping[str, Uncertain]) -> Floats:
        """Return starts at the impacts that agree exactly with all but the measured values more
        than needed, whichever these are."""
        loose = [n for n, item in known.items() if item.varies and n not in GEOMETRY]
        plain = System(known, adjusted=False)
        more = len(plain.conditions) - len(plain.variables)
        begin = self.begin[:, :0]
        if not 0 <= more <= len(loose):
            return begin
        left_out = [*combinations(loose, more)]
        for names in left_out[:: -(-len(left_out) // _LEFT_OUT)]:
            some = {name: item for name, item in known.items() if name not in names}
            reading = System(some, adjusted=False)
            equations = quadratic_equations(reading)
            if equations is not None and equations.size <= MAX_EQUATIONS:
                paths = follow_paths(equations, self.rng)
                several = np.concatenate([paths.real, paths.near], axis=1)
                begin = np.concatenate([begin, self.beginnings(reading, several)], axis=1)
        return begin

    @property
    def single(self) -> bool:
        """Whether there is one impact, or nothing that tells impacts apart."""
        return self.linear or not (self.batches or self.paths)

    def exact_impacts(self, plain: System, count: int) -> Floats:
        """Return the impacts with every known value as it stands, a column each: the real solutions
        of their quadratic equations, else sought in batches of ``count`` starts until several
        batches find no further one."""
        size = len(plain.variables)
        met = np.empty((size, 0))
        equations = None if self.linear else quadratic_equations(plain)
        if equations is not None and equations.size <= MAX_EQUATIONS:
            paths = follow_paths(equations, self.rng)
            if paths.real.shape[1]:
                x, left_over = straight(plain, paths.real)
                met = _distinct(met, x[:, left_over <= _HOLDS])
            if not paths.lost:
                self.paths = paths
                return met
        # more conditions than variables: no start meets them, unless all do
        tried = 1 if len(plain.conditions) > size else count
        for _ in range(_MAX_BATCHES):
            starts = _start(plain, self.rng, tried)
            if met.shape[1] and tried > 1:
                # impacts are often found in pairs, as the roots of a quadratic equation
                near, of = tried // 4, self.rng.integers(met.shape[1], size=tried // 4)
                starts[:, :near] = met[:, of] * (1 + _NEARBY * starts[:, :near])
                _face(plain, starts[:, near : 2 * near])
            x, left_over = straight(plain, starts)
            before, met = met.shape[1], _distinct(met, x[:, left_over <= _HOLDS])
            if tried < count and met.shape[1]:
                tried = count  # more conditions than needed, and they agree: others may, too
                continue
            if tried == 1 or (not met.shape[1] and len(plain.conditions) > size):
                return met
            self.batches, self.starts = self.batches + 1, self.starts + tried
            self.idle = 0 if met.shape[1] > before else self.idle + 1
            if met.shape[1] and not self.closed(plain, met[:, :1]):
                return met  # a continuum of impacts
            if self.idle == _IDLE_BATCHES:
                break
        return met

    def closed(self, plain: System, x: Floats) -> bool:
        """Return whether impacts stand apart from one another, as at ``x``."""
        return not pseudo_inverse(plain.slopes(x))[1].shape[1]

    def found(self) -> list[Reconstruction]:
        """The solutions. Raises UnsolvableError where there are none."""
        met = finite = False
        if not self.at_hand:
            self.paths = None  # a fit is no solution of the equations
        for batch in range(_MAX_BATCHES):
            before = len(self.solutions)
            closely, sound = self.fit(self.begin, thorough=not batch)
            met, finite = met or closely, finite or sound
            if self.at_hand or self.begin.shape[1] == 1 or not met or self.is_open:
                break
            self.batches, self.starts = self.batches + 1, self.starts + self.begin.shape[1]
            self.idle = 0 if len(self.solutions) > before else self.idle + 1
            if self.idle == _IDLE_BATCHES:
                break
            self.begin = _start(self.system, self.rng, _FITTED_STARTS)
        if not (met or finite):
            raise np.linalg.LinAlgError("not finite")
        if met and not (self.solutions or self.open):
            raise UnsolvableError(
                "the search for the impact nearest to what is known came to no end; expected wider "
                "tolerances, or fewer values"
            )
        if not (self.solutions or self.open):
            known = self.system.known
            exact = {name: item.nominal for name, item in known.items() if not item.varies}
            laws = told(missed_laws(exact))
            raise UnsolvableError(
                f"no impact agrees with all that is known exactly{': ' * bool(laws)}{laws}; "
                "expected tolerances ('+- D') for what is measured"
            )
        # what leaves something open counts where all else contradicts the measurements
        least = min((each.squares for each in self.solutions), default=math.inf)
        return [s for s in self.open if _LIKELY * s.squares + 1e-9 < least] + self.solutions

    def fit(self, begin: Floats, thorough: bool) -> tuple[bool, bool]:
        """Keep the solutions that the starts ``begin`` lead to: whether conditions were nearly met
        anywhere, and whether numbers stayed finite. ``thorough``: with tolerances tightened little
        by little, too."""
        system = self.system
        ends, over, settled_ends = _stepped(system, begin)
        squares = np.square(system.left(system.state(ends))[len(system.conditions) :]).sum(axis=0)
        wandering = 0
        for i in np.argsort(np.broadcast_to(squares, over.shape), kind="stable").tolist():
            if self.is_open and len(self.followed) >= _FEW:
                break
            if over[i] <= _NEARLY and (settled_ends[i] or wandering < _FEW):
                wandering += not settled_ends[i]
                self.follow(ends[:, i : i + 1])
        met = bool((over <= _NEARLY).any())
        few, more = begin[:, :_TIGHTENED_FIRST], begin[:, _TIGHTENED_FIRST:_TIGHTENED]
        for some in () if self.at_hand or not thorough else (few, more):
            settled = begin.shape[1] == 1 or (some is more and not self.is_open)
            if (self.solutions or self.open) and settled:
                break
            for start in some.T:
                nearby, left_over = tightened(system, start[:, None])
                if left_over <= _NEARLY:
                    met = True
                    self.follow(nearby)
        return met, bool(np.isfinite(over).any())

    @property
    def is_open(self) -> bool:
        """Whether the solution leaves something undetermined: there may be many as good."""
        return bool(self.open) and not self.solutions

    def follow(self, nearby: Floats) -> None:
        """Keep the solution beside ``nearby``, if there is one."""
        if any(np.abs(nearby - other).max(initial=0.0) < _BESIDE for other in self.followed):
            return
        self.followed.append(nearby)
        try:
            x, left_over = polished(self.system, nearby)
        except np.linalg.LinAlgError:
            return  # something is not finite there
        if not left_over <= _HOLDS or any(
            np.abs(x - other.x).max(initial=0.0) < _SAME for other in self.solutions
        ):
            return
        if pseudo_inverse(self.system.slopes(x))[1].shape[1]:
            rest = self.system.left(self.system.state(x))[len(self.system.conditions) :]
            squares = float(np.square(rest).sum())
            least = min((other.squares for other in self.solutions), default=math.inf)
            # a fold that is not likely, or the continuum that was met before
            if squares > _LIKELY * least + 1e-9:
                return
            if self.times_open >= _FEW and squares > self.open[0].squares - 1e-9:
                return
        solution = _described(self.system, x, self.assumed)
        if solution.undetermined:  # from elsewhere it would only come out otherwise
            self.times_open += 1
            both = (*self.open, solution)
            self.open = [min(both, key=lambda impact: round(impact.squares, 9))]
        else:
            self.solutions.append(solution)


def _is_fold(system: System, x: Floats, null: Floats) -> bool:
    """Return whether the impact stands alone though to first order something is open: where two
    branches meet. From aside the steps come back to it; along a continuum they stay aside."""
    aside = np.concatenate([x + _ASIDE * null, x - _ASIDE * null], axis=1)
    ends, over = straight(system, aside)
    met = over <= _HOLDS
    return bool((np.abs(ends - x).max(axis=0)[met] < 0.1 * _ASIDE).all())


def _described(system: System, x: Floats, assumed: bool) -> Reconstruction:
    state, rows = system.state(x), system.slopes(x)
    rest = system.left(state)[len(system.conditions) :, 0]
    _, null = pseudo_inverse(rows)

    def value(of: Any) -> float:
        return float(np.ravel(of)[0])

    values = {n: value(state.values[n]) for n in ("M", *GEOMETRY)}
    undetermined: list[str] = []
    fold = bool(null.shape[1]) and _is_fold(system, x, null)
    for name, gradient in zip(QUANTITIES, system.gradients(x, QUANTITIES), strict=True):
        if system.point and name in (*SPINS, "PM", "EM"):
            continue
        known = name in COEFFICIENTS and name in system.known
        if name == "MUP" and "MUC" in system.constants:
            known = False  # a share of this impact's own critical friction
        size = value(state.values[name] if known else state[name])
        largest = np.abs(gradient).max(initial=0.0)
        is_open = not fold and np.abs(gradient @ null).max(initial=0.0) > _OPEN * largest
        if name in COURSES and name not in system.known:
            # along an axis a course does not change with the speed, until it turns round
            is_open |= bool({*undetermined} & {*SPEEDS[COURSES[name]]})
        if name in FORCES and name not in system.known:
            is_open |= "PN" not in values
        if known or (np.isfinite(size) and np.isfinite(largest) and not is_open):
            values[name] = size
        elif name in (*VELOCITIES, *FINAL_STATE, *COEFFICIENTS):
            undetermined.append(name)
    unknown = [n for n in (*VELOCITIES, *FINAL_STATE, *COEFFICIENTS) if n not in system.known]
    if unknown and not any(name in values for name in unknown) and not system.observations:
        raise UnsolvableError(
            f"nothing of {' '.join(unknown)} is determined by what is known; expected more of it"
        )
    items = [(n, system.known[n], value(system.measured(state, n))) for n in system.observations]
    adjusted = tuple(Adjusted(n, item.nominal, item.tolerance, now) for n, item, now in items)
    redundancy = len(rows) - (rows.shape[1] - null.shape[1])
    return Reconstruction(
        *(system, x, values, tuple(undetermined), adjusted, redundancy, float(rest @ rest)),
        assumed,
    )


# -- friction as a share of the critical one


def share_resolved(known: Mapping[str, Uncertain]) -> tuple[dict[str, Uncertain], str | None]:
    """``known`` with a number, or limits, for a MU that is a share, and how it was found; as it is
    where MU is none. Raises UserError where no friction is found that is the share.

    The critical friction follows from the whole scene. Where that is known, MU is; where some of it
    is solved for, MUP = share · MUC is one more equation, met by trying friction until it holds."""
    item = known.get("MU")
    if item is None or not item.share:
        return dict(known), None
    others = {name: value for name, value in known.items() if name != "MU"}
    scene = {"M": 6.0} | {n: x.nominal for n, x in others.items() if n in SCENE}
    if len(scene) == len(SCENE) - 1:
        name, value = "MU", float(share_typed(scene, item.nominal))
    else:
        name, value = "MUP", _signed(others, item.nominal)
    if value != value:
        raise UserError("no friction ends the sliding here; expected a number", "MU")
    text = f"MU is {100 * item.nominal:g} % of the critical friction: {name} = {value:.9g}"
    varying = item.varies or any(x.varies for x in others.values())
    if name == "MU" and varying:
        signed = item.nominal * float(solve({**scene, "MU": 0.0}, ("MUC",))["MUC"])
        name, value = "MUP", signed
    scale = value / item.nominal if item.nominal else 0.0
    low, high = sorted((item.low * scale, item.high * scale))
    found = fixed_value(value)
    if item.varies:
        spread = abs(item.deviation * scale)
        found = replace(item, nominal=value, low=low, high=high, deviation=spread, share=False)
    if varying and scale:  # a condition of each impact: Equation 16 with its own critical friction
        found = replace(found, critical=scale)
    return {**others, name: found}, text


def _signed(others: Mapping[str, Uncertain], share: float) -> float:
    """The P_t/P_n that is a share of MUC in the impact that follows from it and the others."""
    exact = not needs_adjustment(others, None)
    numbers = {name: item.nominal for name, item in others.items()}

    def excess(mu: float) -> float:
        scene: dict[str, Any]
        if exact:
            scene = {**numbers, **solve_for({**numbers, "MUP": mu})[0].values}
        else:
            scene = reconstruct({**others, "MUP": fixed_value(mu)})[0].scene()
        scene = {name: value for name, value in scene.items() if name in SCENE}
        return mu - share * float(solve({**scene, "MU": 0.0}, ("MUC",))["MUC"])

    failure = UserError("no friction is found that is this share of the critical friction", "MU")
    for start in (0.3, -0.3):
        try:
            a, b = 0.0, start
            at_a, at_b = excess(a), excess(b)
            for _ in range(_FRICTIONS):
                if abs(at_b) <= _SETTLED or at_a == at_b:
                    break
                a, at_a, b = b, at_b, b - at_b * (b - a) / (at_b - at_a)
                at_b = excess(b)
            if abs(at_b) <= 1e3 * _SETTLED:
                return b
        except UserError as error:
            failure = error
    raise failure
