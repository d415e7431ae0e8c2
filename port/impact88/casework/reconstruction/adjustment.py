"""Reconstruction with tolerances: weighted least squares with equality constraints.

What is known of an impact is adjusted so that the laws and the exact values hold (`system.System`:
the conditions) and the sum of squared adjustments, each in units of its standard deviation, is
least. Candidates come from Gauss-Newton iterations, or from Levenberg-Marquardt iterations while
tolerances are tightened step by step (numerical continuation). Newton's method refines them and
confirms the minimum. First-order deviations and correlations come from the same equations."""

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.geometry import GEOMETRY, within_doubles
from ...collision.mappings import within_limits
from ...collision.uncertain import Uncertain, fixed_value
from ...errors import UserError
from ...mechanics.closedform.share import share_typed
from ...mechanics.closedform.solve import solve
from ...mechanics.outcome import outcome
from ...mechanics.posed import (
    absent_results,
    is_wrong_way,
    pose,
    turned,
    turned_sentence,
    with_headings,
)
from ...mechanics.state import (
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
from ...names import (
    COEFFICIENTS,
    FINAL_STATE,
    IMPULSES,
    PIVOT,
    SCENE,
    VELOCITIES,
    check_names,
)
from ...status import IMPOSSIBLE, Status
from .evidence import Evidence, weigh
from .laws import describe_laws, missed_laws
from .quadrics import MAX_EQUATIONS, Paths, follow_paths, quadratic_equations
from .system import PARAMETERS, SPINS, System
from .unknowns import UnsolvableError, check_physical, mu_to_type, solve_for

Floats = NDArray[np.float64]
Progress = Callable[[int], object]

# The search for every impact
BATCH_SIZE = 240  # random starts in a batch of the search for exact impacts
MAX_IDLE_BATCHES = 4  # without a new impact; the rarest of 80 problems are found once in 200 starts
MAX_BATCHES = 16
FIT_BATCH_SIZE = 120  # random starts in a batch of the search for fits
MAX_OMITTED_SETS = 8  # sets of redundant measurements left out to find starts of a fit
RESTART_SPREAD = 0.3  # relative spread of starts around impacts already found
DISTINCT_TOL = 1e-6  # impacts whose scaled variables differ by less are the same
CONTINUATION_STARTS = 4  # starts from which tolerances are tightened step by step
# Starts in all, the first ones included, where those find nothing or leave something undetermined.
# Twice as many find the same in 75 problems.
MORE_CONTINUATION_STARTS = 12
MAX_OPEN_ENDS = 8  # end points polished where something is undetermined

# Iterations. Doubling any of these changes no solution of 104 problems.
MAX_ITERATIONS = 50  # Gauss-Newton and Newton; Levenberg-Marquardt takes twice as many
MAX_STEP = 2.0  # relative step length
XTOL = 1e-14  # relative step at convergence
TOLERANCE_FACTOR = 0.1  # tolerances are tightened by this factor at a time
MIN_TOLERANCE = 1e-12  # tightest tolerance, in scaled variables
COARSE_FTOL = 0.1  # least relative decrease of the sum of squares while tolerances are tightened
FTOL = 1e-9  # least relative decrease of the sum of squares once tolerances are tightest
CONSTRAINT_WEIGHT = 100.0  # penalty weight of conditions relative to the tightest observation
CANDIDATE_TOL = 1e-3  # largest scaled residual of conditions where Newton's method is started
RESIDUAL_TOL = 1e-10  # largest scaled residual of conditions that hold
DUPLICATE_TOL = 1e-5  # of end points closer than this one is polished
MAX_POLISH_SHIFT = 0.5  # longest relative step of Newton's method
DIFFERENCE_STEP = 1e-6  # half width of the central differences for second derivatives
CURVATURE_TOL = 1e-9  # negative eigenvalues above minus this are rounding

# Rank decisions
RANK_TOL = 1e-10  # singular values below, relative to the largest, count as zero
NULL_TOL = 1e-7  # relative part of a gradient in the null space that counts as zero
FOLD_OFFSET = 1e-2  # scaled distance at which a fold is distinguished from a continuum
FOLD_TOL = 1e-4  # relative singular value below which two branches nearly meet
FOLD_GRADIENT_TOL = 1e-3  # relative part of a gradient along the fold that counts as zero

MAX_SQUARES_RATIO = 4.0  # impacts with up to this many times the least sum of squares are reported
# Secant steps for friction given as a fraction of the critical one; six to ten are needed. Half or
# twice as many find the same in 60 problems.
MAX_SECANT_STEPS = 40
FRICTION_TOL = 1e-12  # change of P_t/P_n at convergence
# Unknowns that can be determined best by other evidence
PREFERRED_MEASUREMENTS = ("WAF", "WBF", "WA", "WB", "E", "MUP", "EM")


def solve_gauss_newton(system: System, starts: Floats) -> tuple[Floats, Floats]:
    """Return the ends of Gauss-Newton iterations from several starts, a column each, and the
    largest residual of the conditions at each end.

    Steps may increase the sum of squares, as long as they do not increase the conditions' residuals
    much."""
    x, largest_residual, _ = _iterate_gauss_newton(system, starts)
    return x, largest_residual


def _iterate_gauss_newton(
    system: System, starts: Floats
) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Return the same as `solve_gauss_newton`, and True for each iteration that converged."""
    condition_count, x = len(system.conditions), starts.copy()
    running = np.arange(x.shape[1])
    for _ in range(MAX_ITERATIONS):
        point = x[:, running]
        residual, jacobian = system.linearize(point, system.residuals)
        steps = _gauss_newton_steps(residual, jacobian, condition_count)
        step_size = np.abs(steps).max(axis=0, initial=0.0)
        allowed_length = MAX_STEP * np.maximum(1.0, np.abs(point).max(axis=0, initial=0.0))
        steps = steps * np.minimum(1.0, allowed_length / np.maximum(step_size, allowed_length))
        violation = np.abs(residual[:condition_count]).max(axis=0, initial=0.0)
        for _ in range(12):
            trial = point + steps
            trial_violation = np.abs(system.residuals(system.state(trial))[:condition_count]).max(
                axis=0, initial=0.0
            )
            has_grown = trial_violation > np.maximum(1.5 * violation, 1e-9)
            if not has_grown.any():
                break
            steps = np.where(has_grown, steps / 2, steps)
        x[:, running] = trial
        running = running[step_size >= XTOL * (1 + np.abs(trial).max(axis=0, initial=0.0))]
        if not len(running):
            break
    largest_residual = np.abs(system.residuals(system.state(x))[:condition_count]).max(
        axis=0, initial=0.0
    )
    converged = np.ones(x.shape[1], bool)
    converged[running] = False
    return x, largest_residual, converged


def fit_with_continuation(system: System, x: Floats) -> tuple[Floats, float]:
    """Return the least-squares solution from one start, and the largest residual of its conditions.

    Tight tolerances among loose ones make a narrow curved valley, which descent follows slowly. So
    all tolerances begin loose and are tightened by `TOLERANCE_FACTOR` at a time, each solution the
    start of the next (continuation)."""
    weights = np.full(len(system.conditions), CONSTRAINT_WEIGHT)
    tolerances = np.array(
        [system.known[n].standard_deviation / system.scale(n) for n in system.observations]
    )
    # vehicles and coefficients keep their own tolerances from the beginning
    keeps_tolerance = np.array([n in GEOMETRY or n in COEFFICIENTS for n in system.observations])
    tolerance, final_tolerance = 1.0, max(float(tolerances.min()), MIN_TOLERANCE)
    while tolerance > final_tolerance:
        observation_weights = np.where(
            keeps_tolerance, 1.0, np.minimum(1.0, tolerances / tolerance)
        )
        x = _minimize(
            system,
            x,
            np.concatenate([weights / tolerance, observation_weights])[:, None],
            COARSE_FTOL,
        )
        tolerance *= TOLERANCE_FACTOR
    row_weights = np.concatenate([weights / final_tolerance, np.ones(len(tolerances))])
    x = _minimize(system, x, row_weights[:, None], FTOL)
    return x, float(np.abs(system.residuals(system.state(x))[: len(weights)]).max(initial=0.0))


def _minimize(system: System, x: Floats, row_weights: Floats, ftol: float) -> Floats:
    """Minimize the sum of squares of residuals times ``row_weights`` by the Levenberg-Marquardt
    method, until three steps decrease it by less than the fraction ``ftol``."""
    residual, damping, small_gains = row_weights * system.residuals(system.state(x)), 1e-3, 0
    for _ in range(2 * MAX_ITERATIONS):
        jacobian = row_weights * system.jacobian(x)
        if not (np.isfinite(jacobian).all() and np.isfinite(residual).all()):
            break
        u, s, vt = np.linalg.svd(jacobian, full_matrices=False)
        squares = trial_squares = float(np.square(residual).sum())
        while not trial_squares < squares:
            damped_inverse = (vt.T * (s / (s * s + damping * s[0] ** 2))) @ u.T
            step = -damped_inverse @ residual
            step_size = np.abs(step).max()
            if not step_size > XTOL:
                return x
            step *= min(1.0, MAX_STEP / step_size)
            trial, trial_residual = _follow_curvature(
                system, x + step, residual + jacobian @ step, damped_inverse, row_weights
            )
            trial_squares = float(np.square(trial_residual).sum())
            damping *= 10
        x, residual, damping = trial, trial_residual, max(damping / 100, 1e-16)
        small_gains = 0 if squares - trial_squares > ftol * squares else small_gains + 1
        if small_gains == 3:
            break
    return x


def _follow_curvature(
    system: System, x: Floats, predicted: Floats, inverse: Floats, row_weights: Floats
) -> tuple[Floats, Floats]:
    """Return the end of a step corrected towards the residuals that the linear model predicted, and
    its residuals, as long as the correction decreases them.

    With these corrections steps follow narrow curved valleys."""
    residual = row_weights * system.residuals(system.state(x))
    for _ in range(MAX_ITERATIONS):
        if not np.square(residual).sum() > 1.1 * np.square(predicted).sum():
            break
        trial = x - inverse @ (residual - predicted)
        trial_residual = row_weights * system.residuals(system.state(trial))
        if not np.square(trial_residual).sum() < 0.9 * np.square(residual).sum():
            break
        x, residual = trial, trial_residual
    return x, residual


def refine(system: System, x: Floats) -> tuple[Floats, float]:
    """Refine an impact by Newton's method. Return it and the largest residual of its conditions,
    infinite where the iteration does not converge to a minimum nearby."""
    condition_count, previous_size, start = len(system.conditions), np.inf, x
    for _ in range(MAX_ITERATIONS):
        residual, jacobian = system.linearize(x, system.residuals)
        step, is_minimum = _newton_step(system, x, residual[:, 0], jacobian[:, :, 0])
        step_size, point_size = np.abs(step).max(initial=0.0), 1 + np.abs(x).max(initial=0.0)
        if not step_size < MAX_POLISH_SHIFT * point_size:
            return x, np.inf
        x = x + step[:, None]
        # a tiny step that is more than half of the one before is rounding: Newton's method would
        # have shrunk it by far more
        is_rounding = 1e-9 * point_size > step_size > 0.5 * previous_size
        if step_size < XTOL * point_size or is_rounding:
            break
        previous_size = step_size
    else:
        return x, np.inf
    start_residual, end_residual = (
        system.residuals(system.state(start)),
        system.residuals(system.state(x)),
    )
    # reject saddle points, and minima of another valley
    if (
        not is_minimum
        or np.square(end_residual[condition_count:]).sum()
        > 1.01 * np.square(start_residual[condition_count:]).sum() + 1e-9
    ):
        return x, np.inf
    return x, float(np.abs(end_residual[:condition_count]).max(initial=0.0))


def _newton_step(
    system: System, x: Floats, residual: Floats, jacobian: Floats
) -> tuple[Floats, bool]:
    """Return the step of Newton's method for constrained least squares, and True if the Lagrangian
    curves upward there in every direction the conditions allow.

    With conditions c(x) = 0, observations r(x), their Jacobians C and A and the Lagrangian's
    Hessian H, the step p, the new residuals s and the multipliers l solve the augmented system

        H p + A^T s + C^T l = 0,    A p - s = -r,    C p = -c.

    Directions that nothing determines to first order are left out of p. By the inertia of this
    matrix the point is a minimum if it has no more negative eigenvalues than A has rows and C has
    rank (Nocedal and Wright, *Numerical Optimization*, 16.1).
    """
    condition_count, variable_count = len(system.conditions), len(x)
    inverse, null = pseudo_inverse(jacobian[:condition_count])
    observation_rows, observation_residual = jacobian[condition_count:], residual[condition_count:]
    multipliers = np.concatenate(
        [-inverse.T @ (observation_rows.T @ observation_residual), observation_residual]
    )
    curvature = _lagrangian_hessian(system, x, multipliers)
    *_, determined, _ = _decompose(jacobian)
    # in units of the tightest observation, so that no block is much larger than another
    weight = np.abs(observation_rows).max(initial=0.0) or 1.0
    c = jacobian[:condition_count] @ determined.T
    a = observation_rows @ determined.T / weight
    step_size, row_count = len(determined), len(observation_rows)
    steps = slice(0, step_size)
    residuals = slice(step_size, step_size + row_count)
    conditions = slice(step_size + row_count, step_size + row_count + condition_count)
    equations = np.zeros((conditions.stop, conditions.stop))
    equations[steps, steps] = (
        determined @ (curvature + curvature.T) @ determined.T / (2 * weight * weight)
    )
    equations[steps, residuals] = a.T
    equations[steps, conditions] = c.T
    equations[residuals, steps] = a
    equations[conditions, steps] = c
    equations[residuals, residuals] = -np.eye(row_count)
    right_side = np.zeros(len(equations))
    right_side[residuals] = -observation_residual / weight
    right_side[conditions] = -residual[:condition_count]
    if not (np.isfinite(equations).all() and np.isfinite(right_side).all()):
        raise np.linalg.LinAlgError("not finite")
    solution = np.linalg.lstsq(equations, right_side, rcond=1e-15)[0]
    negative = np.linalg.eigvalsh(_equilibrate(equations)) < -CURVATURE_TOL
    step: Floats = determined.T @ solution[steps]
    condition_rank = variable_count - null.shape[1]
    return step, bool(negative.sum() <= row_count + condition_rank)


def _lagrangian_hessian(system: System, x: Floats, multipliers: Floats) -> Floats:
    """Return the sum of the residuals' second derivatives times ``multipliers``, by central
    differences of the Jacobian."""
    offsets = DIFFERENCE_STEP * np.eye(len(x))
    jacobians = system.linearize(
        np.concatenate([x + offsets, x - offsets], axis=1), system.residuals
    )[1]
    ahead, behind = np.split(np.einsum("r,rik->ik", multipliers, jacobians), 2, axis=1)
    return np.asarray((ahead - behind) / (2 * DIFFERENCE_STEP))


def _random_starts(system: System, rng: np.random.Generator, count: int) -> Floats:
    """Return ``count`` random starts: scaled variables, a column each, known ones at their nominal
    values."""
    starts = rng.standard_normal((count, len(system.variables))).T
    for i, name in enumerate(system.variables):
        if name in system.nominal:
            starts[i] = system.nominal[name] / system.scales[i]
    return starts


def _align_with_courses(system: System, starts: Floats) -> None:
    """Turn the velocities in ``starts`` whose course is known to that course."""
    for name, speed in COURSES.items():
        rows = [system.variables.index(n) for n in SPEEDS[speed] if n in system.variables]
        if name in system.known and len(rows) == 2:
            angle = np.radians(system.nominal[name])
            size = np.abs(starts[rows[0]])
            starts[rows[0]], starts[rows[1]] = size * np.cos(angle), size * np.sin(angle)


def _append_distinct(impacts: Floats, candidates: Floats) -> Floats:
    """Return the columns of ``impacts`` and those of ``candidates`` that differ from all before."""
    for column in candidates.T:
        if not (np.abs(impacts - column[:, None]).max(axis=0, initial=0.0) < DISTINCT_TOL).any():
            impacts = np.column_stack([impacts, column])
    return impacts


def _equilibrate(matrix: Floats) -> Floats:
    """Scale rows and columns of a symmetric matrix so that no row is much larger than others. The
    numbers of positive and negative eigenvalues do not change (Sylvester's law of inertia)."""
    for _ in range(3):
        largest = np.sqrt(np.abs(matrix).max(axis=1, initial=0.0))
        units = np.where(largest > 0, largest, 1.0)
        matrix = matrix / np.outer(units, units)
    return matrix


def _gauss_newton_steps(residual: Floats, jacobians: Floats, condition_count: int) -> Floats:
    """Return the Gauss-Newton step of each impact (a column): it meets the first
    ``condition_count`` rows, linearized, and minimizes the others in the null space of these. Steps
    are nan where something is not finite."""
    finite = np.isfinite(residual).all(axis=0) & np.isfinite(jacobians).all(axis=(0, 1))
    steps = np.full(jacobians.shape[1:], np.nan)
    matrices, residuals = (
        jacobians[:, :, finite].transpose(2, 0, 1),
        residual[:, finite].T[:, :, None],
    )
    inverse = np.linalg.pinv(matrices[:, :condition_count], rcond=RANK_TOL)
    step = -inverse @ residuals[:, :condition_count]
    if len(residual) > condition_count:
        observation_rows = matrices[:, condition_count:]
        projector = np.eye(jacobians.shape[1]) - inverse @ matrices[:, :condition_count]
        projected_inverse = np.linalg.pinv(observation_rows @ projector, rcond=RANK_TOL)
        step = step - projector @ (
            projected_inverse @ (residuals[:, condition_count:] + observation_rows @ step)
        )
    steps[:, finite] = step[:, :, 0].T
    return steps


def pseudo_inverse(matrix: Floats) -> tuple[Floats, Floats]:
    """Return the Moore-Penrose inverse and a basis of the null space.

    Raise LinAlgError for a matrix that is not finite: LAPACK may not return from it."""
    u, s, vt, null = _decompose(matrix)
    return (vt.T / s) @ u.T, null


def _decompose(matrix: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return U, the singular values that count, V^T and a basis of the null space."""
    if not np.isfinite(matrix).all():
        raise np.linalg.LinAlgError("not finite")
    u, s, vt = np.linalg.svd(matrix)
    rank = int((s > RANK_TOL * s.max(initial=0.0)).sum())
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
    def normalized_residual(self) -> float:
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
            return f"{impacts}; the equations have no other"
        idle = f"the last {self.idle} found no other" if self.idle else "the last found a new one"
        if self.batches <= 1:
            return f"{impacts}, from {self.starts} starts"
        return f"{impacts}; {self.batches} batches of starts ({self.starts} in all), {idle}"


NOT_SEARCHED = Searched()


SHOWN = ("SA", "SB", "DVA", "DVB", "LOSS")
"""Results shown in the repr of a `Reconstruction`."""


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
    remarks : tuple of str
        Sentences on what was made of the problem: values that are not used, a contact plane that
        follows from the motion.

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
    remarks: tuple[str, ...] = ()

    def __repr__(self) -> str:
        shown = ", ".join(
            f"{name} {self.values[name]:.4g}" for name in SHOWN if name in self.values
        )
        adjusted = f", {len(self.adjusted)} values adjusted" if self.redundancy else ""
        return f"<Reconstruction: {shown or 'nothing determined'}{adjusted}>"

    @property
    def absent(self) -> dict[str, frozenset[str]]:
        """Quantities that need an input that is not given, and which."""
        return absent_results(self.system.known)

    @property
    def collides(self) -> bool:
        """True if the contact points approach and push each other, as far as that is known."""
        if not self.values.get("PN", 1.0) > 0:
            return False
        if "VC" not in self.values:  # the contact plane or a velocity is not known
            return True
        return bool(self.system.state(self.x).relative_before[0] < 0)

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
            < -RESIDUAL_TOL * system.scale("PN" if name in FORCES else "UX")
        )

    @cached_property
    def folded(self) -> tuple[str, ...]:
        """Quantities whose first-order deviations mean nothing near a fold.

        Two branches of impacts nearly meet there. The Jacobian then has weak directions w, of
        singular values near 0, along which the residuals r change only to second order. With a
        distance h, x + h w and x - h w give

            even = r(x + h w) + r(x - h w) - 2 r(x),    about h^2 w^T r'' w,
            odd  = r(x + h w) - r(x - h w),             about 2 h r' w.

        A direction with even > odd is a fold. With odd > even the residuals change to first order:
        the direction is only poorly determined. Quantities are named whose gradient has a part
        along a fold.
        """
        rows = self.system.jacobian(self.x)
        sizes = np.abs(rows).max(axis=1, initial=0.0)
        rows = rows[sizes > 0] / sizes[sizes > 0, None]
        if self.undetermined or not (len(rows) and np.isfinite(rows).all()):
            return ()
        _, singular, vt = np.linalg.svd(rows)
        weak = vt[(singular > FOLD_TOL * singular[0]).sum() :].T
        if not weak.shape[1]:
            return ()
        ahead, center, behind = (
            self.system.residuals(self.system.state(self.x + side * weak))
            for side in (FOLD_OFFSET, 0, -FOLD_OFFSET)
        )
        even, odd = np.abs(ahead + behind - 2 * center), np.abs(ahead - behind)
        weak = weak[:, even.max(axis=0) > odd.max(axis=0)]
        gradients = self.system.gradients(self.x, QUANTITIES)
        largest = np.abs(gradients).max(axis=1, initial=0.0)
        along = np.abs(gradients @ weak).max(axis=1, initial=0.0)
        return tuple(
            name
            for name, part, size in zip(QUANTITIES, along, largest, strict=True)
            if name in self.values and name not in self.system.known
            if part > FOLD_GRADIENT_TOL * size
        )

    @cached_property
    def helpful(self) -> tuple[str, ...]:
        """Further values that would determine everything undetermined, empty if none would."""
        _, null = pseudo_inverse(self.system.jacobian(self.x))
        rows, names = np.zeros((0, null.shape[1])), []
        wanted = [*dict.fromkeys((*PREFERRED_MEASUREMENTS, *self.undetermined))]
        for name, gradient in zip(wanted, self.system.gradients(self.x, wanted), strict=True):
            if name in self.undetermined and np.isfinite(gradient).all():
                row = gradient @ null / np.abs(gradient).max(initial=1e-300)
                candidate_rows = np.vstack([rows, row])
                if np.linalg.matrix_rank(candidate_rows, tol=NULL_TOL) > len(rows):
                    rows = candidate_rows
                    names.append(name)
        return tuple(names) if len(rows) == null.shape[1] else ()

    @cached_property
    def _unit_responses(self) -> tuple[Floats, Floats]:
        """Response of the scaled variables (rows) to an error of one standard deviation in each
        observation, and each observation's redundancy number: the part of such an error that its
        own adjustment shows."""
        jacobian = self.system.jacobian(self.x)
        count = len(self.system.conditions)
        _, feasible = pseudo_inverse(jacobian[:count])
        projected_inverse, _ = pseudo_inverse(jacobian[count:] @ feasible)
        responses = np.asarray(feasible @ projected_inverse)
        return responses, 1 - np.einsum("ij,ji->i", jacobian[count:], responses)

    @property
    def _responses(self) -> Floats:
        # assumed tolerances are scaled by the misfit
        return np.asarray(self._unit_responses[0] * (self.evidence.widening if self.assumed else 1))

    @cached_property
    def evidence(self) -> Evidence:
        """Verdict on the evidence: whether the measured values can all be true."""
        return self.weigh_evidence()

    @within_doubles
    def weigh_evidence(self, inside: bool | None = None) -> Evidence:
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
        redundancy_numbers = dict(
            zip(self.system.observations, self._unit_responses[1].tolist(), strict=True)
        )
        known = self.system.known
        values = {
            item.name: (
                item.measured,
                item.adjusted,
                (item.adjusted - item.measured) / known[item.name].standard_deviation,
                redundancy_numbers[item.name],
            )
            for item in self.adjusted
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
        values = {n: self.values[n] for n in (*GEOMETRY, *names) if n in self.values}
        values |= {"MU": typed_friction(self.system.state(self.x), self.values["MUP"])}
        return {"M": 4.0 if self.system.point else 6.0, "EM": 0.0, **values}


def typed_friction(state: State, signed: float) -> float:
    """Return the MU that line 400 of the listing turns into ``signed`` for this impact's
    sliding."""
    sliding = float(np.ravel(np.real(state.relative_before[1]))[0])
    return float(np.ravel(mu_to_type(signed, sliding, map(np.real, state.before)))[0])


def needs_adjustment(known: Mapping[str, Uncertain], wanted: Sequence[str] | None = None) -> bool:
    """Return True for a problem that `unknowns.solve_for` cannot solve: one with tolerances, with
    quantities it does not take, or with exact values that contradict one another."""
    if any(item.varies or name in OTHERS for name, item in known.items()):
        return True
    try:
        solutions = solve_for({name: item.nominal for name, item in known.items()}, wanted)
    except UnsolvableError:
        # values that leave something undetermined may be contradictory, too
        return bool(missed_laws({name: item.nominal for name, item in known.items()}))
    except UserError:
        return False  # `solve_for` reports it when it is called
    return any(bool(solution.contradictory) for solution in solutions)


@within_doubles
def reconstruct(
    known: Mapping[str, Uncertain | float | str], progress: Progress = lambda impacts: None
) -> list[Reconstruction]:
    """Return every impact found that agrees with what is ``known`` (`KNOWABLE` names; M is 6 by
    default).

    A number is exact, an `Uncertain` is known within its tolerance. MU is known in size only: each
    solution that agrees with the sign line 400 gives it is returned; MUP is signed. Where exact
    values contradict one another and none has a tolerance, all known velocities are given the same
    one (spins divided by the radius of gyration). ``progress`` is called with the number of impacts
    evaluated.

    Raise UserError for names and numbers that cannot be used and for exact values that
    contradict one another beside others with a tolerance, UnsolvableError where nothing unknown
    is determined."""
    values, _ = resolve_friction(_check_known(known))
    values, remarks = pose(values, fixed_value)
    point = values["M"].nominal == 4
    failure: UserError | None = None
    try:
        solutions = _impacts(values, progress)
    except UserError as error:
        solutions, failure = [], error
    status = int(outcome(solutions[0].values)["STATUS"]) if solutions else Status.SEPARATING
    if "GA" in values and is_wrong_way(status, point):
        plane = values["GA"]
        shift = turned(plane.nominal) - plane.nominal
        ends = {end: getattr(plane, end) + shift for end in ("nominal", "low", "high")}
        with suppress(UserError):
            others = _impacts({**values, "GA": replace(plane, **ends)}, progress)
            if not others[0].impossible:
                solutions = others
                if "GA" in known:
                    remarks.append(turned_sentence(plane.nominal))
    if not solutions:
        assert failure is not None
        raise failure
    return [replace(solution, remarks=tuple(remarks)) for solution in solutions]


def _impacts(values: dict[str, Uncertain], progress: Progress) -> list[Reconstruction]:
    """Return every impact found that agrees with the values as they are posed, best first."""
    values = dict(values)
    mu = values.pop("MU", None)
    readings = [values]
    if mu is not None:
        readings = [{**values, "MUP": mu}]
        if mu.varies or mu.nominal not in (0, PIVOT):
            opposite = replace(mu, nominal=-mu.nominal, low=-mu.high, high=-mu.low)
            readings.append({**values, "MUP": opposite})
    solutions: list[Reconstruction] = []
    failure: UserError | None = None
    searches: list[_Search] = []
    for reading in readings:
        try:
            searches.append(_Search(reading, progress))
        except UserError as error:
            failure = error
    # values that are contradictory for one sign of MU may agree for the other: fits are sought last
    for is_fit in (False, True):
        for search in [item for item in searches if item.assumed == is_fit]:
            try:
                solutions += search.run()
            except UserError as error:
                failure = error
                searches.remove(search)
        agreeing = [s for s in solutions if mu is None or _agrees(s, mu.nominal)]
        if agreeing:
            return _sort_solutions(agreeing, searches, mu)
    fits = [replace(s, against_sign=True) for s in solutions if s.redundancy]
    if fits:
        return _sort_solutions(fits, searches, None)
    raise failure or UnsolvableError(
        "neither sign of MU agrees with the sliding it leads to (line 400): no friction that "
        "opposes the sliding is consistent with the known values"
    )


def _invariants(values: Mapping[str, float]) -> list[float]:
    """Return what does not depend on axes, names of vehicles or units, to six digits: the
    fraction of the initial kinetic energy that is in spins, e and that energy first, then
    everything else in which impacts differ."""
    pairs = [("A", "B"), ("AF", "BF")]
    spin_energies = [
        sum(
            # a product of huge spins is infinite, a power of them an error
            values.get(spin, 0.0) * values.get(spin, 0.0) * values[inertia] / 2
            for spin, inertia in (("WA" + after, "IA"), ("WB" + after, "IB"))
            if math.isfinite(values.get(inertia, math.inf))
        )
        for after in ("", "F")
    ]
    energy = values.get("KI", 0.0)
    fractions = [x / energy if energy else 0.0 for x in spin_energies]
    speeds = [sum(values.get("S" + x, 0.0) for x in pair) for pair in pairs]
    sizes = [abs(values.get(name, 0.0)) for name in ("E", "VC", "PN", "PT", "PM", "MUP", "EM")]
    sums = [values.get("DVA", 0.0) + values.get("DVB", 0.0), values.get("EL", 0.0)]
    ranks = [fractions[0], sizes[0], energy, fractions[1], *speeds, *sums, *sizes[1:]]
    return [float(f"{x:.5e}") if abs(x) > 1e-9 else 0.0 for x in ranks]


def _sort_solutions(
    solutions: list[Reconstruction], searches: "Sequence[_Search]", mu: Uncertain | None
) -> list[Reconstruction]:
    """Return the likely solutions, sorted by physics.

    First possible impacts, then those that break physics or drive backwards along a known course,
    then those that separate or pull; among these by the sum of squared adjustments, ties by
    `_invariants`, the smaller first. Solutions that contradict the measurements are kept only where
    all do, those that drive backwards only where no others exist."""
    forward_solutions = [s for s in solutions if not s.backwards] or solutions
    # a solution that contradicts the measurements, such as standstill, is dropped if others agree
    agreeing = [s for s in forward_solutions if not s.evidence.contradictory] or forward_solutions
    possible = [s for s in agreeing if not s.impossible]
    # A possible impact is compared with the possible ones only: an impossible one that fits better
    # must not displace it. An impossible one has to compete with all.
    least_possible = min((s.squares for s in possible), default=0.0)
    least_of_all = min((s.squares for s in agreeing), default=0.0)
    likely = []
    for solution in [*possible, *(s for s in agreeing if s.impossible)]:
        least = least_of_all if solution.impossible else least_possible
        if solution.squares <= max(MAX_SQUARES_RATIO * least, 1e-9):
            likely.append(solution)

    def order(solution: Reconstruction) -> tuple[float, ...]:
        squares = float(f"{max(solution.squares, 1e-9):.6e}")
        broken = solution.impossible
        no_impact = bool(broken & (Status.SEPARATING | Status.PULLING))
        ranks = _invariants(solution.values)
        return bool(broken), no_impact, squares, broken.bit_count(), *ranks

    search = Searched(
        sum(item.batches for item in searches),
        sum(item.starts for item in searches),
        min((item.idle for item in searches), default=0),
        all(item.single for item in searches),
        len(likely),
        sum(not solution.impossible for solution in likely),
    )
    paths = [item.paths for item in searches if item.paths]
    if len(paths) == len(searches):
        path_count = sum(item.total for item in paths)
        nonreal = sum(item.complex_ends + item.infinite_ends for item in paths)
        search = search._replace(solutions=path_count, nonreal=nonreal)
    alternatives = tuple((s.system, s.x) for s in forward_solutions)
    common: dict[str, Any] = {"search": search, "beside": alternatives}
    if mu is not None and (mu.varies or mu.nominal not in (0, PIVOT)):
        common["typed_mu"] = mu.nominal
    return [replace(s, **common) for s in sorted(likely, key=order)]


def _check_known(known: Mapping[str, Uncertain | float | str]) -> dict[str, Uncertain]:
    """Return what is ``known`` as uncertain values, those of point masses filled in. Raise
    UserError for values that cannot be used."""
    values = within_limits(known)
    check_names(values, KNOWABLE, "value of an impact")
    if values.setdefault("M", fixed_value(6.0)).nominal == 4:
        without_effect = (*SPINS, "EM", "DA", "DB", "PA", "PB", "IA", "IB")
        values = {name: item for name, item in values.items() if name not in without_effect}
    check_physical(
        {n: np.array([x.nominal if x.kind == "normal" else x.low]) for n, x in values.items()}
    )
    if values["M"].varies:
        raise UserError("M must be 6, or 4 for point masses")
    _check_crush(values)
    for name, item in values.items():
        if name in SPEEDS and item.nominal < 0:
            raise UserError(f"{name} is negative; expected a speed, its course beside it")
    return _with_standing_vehicles(values)


def _with_standing_vehicles(values: dict[str, Uncertain]) -> dict[str, Uncertain]:
    """Return the values with both components of an exact speed of 0 in its place: as a condition it
    has no slope there."""
    courses = {speed: course for course, speed in COURSES.items()}
    for speed, components in SPEEDS.items():
        item = values.get(speed)
        if item is not None and not item.varies and item.nominal == 0:
            values = {n: x for n, x in values.items() if n not in (speed, courses[speed])}
            values = {n: fixed_value(0.0) for n in components} | values
    return values


def _check_crush(values: dict[str, Uncertain]) -> None:
    """Raise UserError unless the crush of both vehicles is known, or of none. Fill in a rigid
    barrier's: it absorbs no energy."""
    for vehicle in "AB":
        names = [n for n in CRUSH if n in values and n.endswith(vehicle)]
        if len(names) == 2:
            raise UserError(f"{' and '.join(names)} are both given; expected one of them")
        other_vehicle = "AB".replace(vehicle, "")
        if any(n in values for n in CRUSH if n.endswith(other_vehicle)) and not names:
            if not math.isinf(values["M" + vehicle].nominal):
                raise UserError("ELA and ELB (or EBSA and EBSB) sum to EL; expected both, or EL")
            values["EL" + vehicle] = fixed_value(0.0)
        for name in names:
            if values[name].nominal < 0:
                raise UserError(f"{name} is negative; expected what was lost in {vehicle}")


def _agrees(solution: Reconstruction, mu: float) -> bool:
    """Return True if line 400 gives ``mu`` the sign this solution has, as far as velocities are
    determined."""
    signed = solution.system.nominal["MUP"]
    is_determined = not set(VELOCITIES) & set(solution.undetermined)
    return not is_determined or typed_friction(solution.system.state(solution.x), signed) == mu


class _Search:
    """Search for the impacts nearest to what is known, friction signed, each once.

    ``initial``: the starts of the fit, a column each; ``is_consistent``: impacts agree exactly with
    all nominal values, and the starts are these; ``assumed``: exact values contradict one another,
    and the known velocities were given tolerances; ``open_solutions``: the best solution that
    leaves something undetermined."""

    def __init__(self, known: Mapping[str, Uncertain], progress: Progress) -> None:
        self.solutions: list[Reconstruction] = []
        self.open_solutions: list[Reconstruction] = []
        self.end_points: list[Floats] = []
        self.rng = np.random.default_rng(1988)
        self.batches = self.starts = self.idle = self.open_count = 0
        self.paths: Paths | None = None
        exact_system = System(known, adjusted=False, progress=progress)
        inputs_vary = any(known[name].varies for name in PARAMETERS if name in known)
        self.linear = exact_system.linear and not inputs_vary  # one valley, without bends
        x = self.exact_impacts(
            exact_system, 1 if exact_system.linear and not inputs_vary else BATCH_SIZE
        )
        self.is_consistent = bool(x.shape[1])
        self.assumed = not self.is_consistent and not any(item.varies for item in known.values())
        if self.assumed:
            for name in (n for n in (*VELOCITIES, *FINAL_STATE) if n in known):
                deviation = 1 / exact_system.gyration if name in SPINS else 1.0
                measurement = Uncertain("normal", known[name].nominal, -np.inf, np.inf, deviation)
                known = {**known, name: measurement}
        self.system = System(known, adjusted=True, progress=progress)
        count = x.shape[1] or (1 if self.linear else FIT_BATCH_SIZE)
        self.initial = _random_starts(self.system, self.rng, count)
        if self.is_consistent:
            self.initial = self.starts_at(exact_system, x)
        elif not (self.linear or self.assumed):
            self.initial = np.concatenate(
                [self.starts_without_redundancy(known), self.initial], axis=1
            )

    def starts_at(self, exact_system: System, x: Floats) -> Floats:
        """Return starts with the velocities and impulses of exact impacts ``x``."""
        starts, state = _random_starts(self.system, self.rng, x.shape[1]), exact_system.state(x)
        for row, name in enumerate(self.system.variables):
            if name in VELOCITIES or name in IMPULSES:
                starts[row] = state[name] / self.system.scales[row]
        return starts

    def starts_without_redundancy(self, known: Mapping[str, Uncertain]) -> Floats:
        """Return starts at the impacts that agree exactly with as many measured values as determine
        an impact, for several choices of the redundant ones."""
        measured = [n for n, item in known.items() if item.varies and n not in GEOMETRY]
        exact_system = System(known, adjusted=False)
        surplus = len(exact_system.conditions) - len(exact_system.variables)
        starts = self.initial[:, :0]
        if not 0 <= surplus <= len(measured):
            return starts
        omissions = [*combinations(measured, surplus)]
        for omitted in omissions[:: -(-len(omissions) // MAX_OMITTED_SETS)]:
            sufficient = {name: item for name, item in known.items() if name not in omitted}
            sufficient_system = System(sufficient, adjusted=False)
            equations = quadratic_equations(sufficient_system)
            if equations is not None and equations.size <= MAX_EQUATIONS:
                paths = follow_paths(equations, self.rng)
                roots = np.concatenate([paths.real, paths.near], axis=1)
                starts = np.concatenate([starts, self.starts_at(sufficient_system, roots)], axis=1)
        return starts

    @property
    def single(self) -> bool:
        """True where there is one impact, or a continuum of them: no search is needed or
        possible."""
        return self.linear or not (self.batches or self.paths)

    def exact_impacts(self, system: System, count: int) -> Floats:
        """Return the impacts with every known value at its nominal value, a column each.

        They are the real solutions of quadratic equations, found by homotopy continuation
        (`quadrics`). Where the equations are not quadratic, batches of ``count`` random starts are
        tried until `MAX_IDLE_BATCHES` in turn find no new impact."""
        variable_count = len(system.variables)
        impacts = np.empty((variable_count, 0))
        equations = None if self.linear else quadratic_equations(system)
        if equations is not None and equations.size <= MAX_EQUATIONS:
            paths = follow_paths(equations, self.rng)
            if paths.real.shape[1]:
                x, largest_residual = solve_gauss_newton(system, paths.real)
                impacts = _append_distinct(impacts, x[:, largest_residual <= RESIDUAL_TOL])
            if not paths.lost:
                self.paths = paths
                return impacts
        # more conditions than variables: either every start meets them or none does
        start_count = 1 if len(system.conditions) > variable_count else count
        for _ in range(MAX_BATCHES):
            starts = _random_starts(system, self.rng, start_count)
            if impacts.shape[1] and start_count > 1:
                # impacts are often found in pairs, as the roots of a quadratic equation
                nearby_count, origins = (
                    start_count // 4,
                    self.rng.integers(impacts.shape[1], size=start_count // 4),
                )
                starts[:, :nearby_count] = impacts[:, origins] * (
                    1 + RESTART_SPREAD * starts[:, :nearby_count]
                )
                _align_with_courses(system, starts[:, nearby_count : 2 * nearby_count])
            x, largest_residual = solve_gauss_newton(system, starts)
            count_before, impacts = (
                impacts.shape[1],
                _append_distinct(impacts, x[:, largest_residual <= RESIDUAL_TOL]),
            )
            if start_count < count and impacts.shape[1]:
                start_count = count  # redundant conditions that agree: search for further impacts
                continue
            if start_count == 1 or (
                not impacts.shape[1] and len(system.conditions) > variable_count
            ):
                return impacts
            self.batches, self.starts = self.batches + 1, self.starts + start_count
            self.idle = 0 if impacts.shape[1] > count_before else self.idle + 1
            if impacts.shape[1] and not self.is_isolated(system, impacts[:, :1]):
                return impacts  # a continuum of impacts
            if self.idle == MAX_IDLE_BATCHES:
                break
        return impacts

    def is_isolated(self, system: System, x: Floats) -> bool:
        """Return True if the impact ``x`` is isolated from others: its Jacobian has full column
        rank."""
        return not pseudo_inverse(system.jacobian(x))[1].shape[1]

    def run(self) -> list[Reconstruction]:
        """Return the solutions. Raise UnsolvableError where there are none."""
        has_candidates = is_finite = False
        if not self.is_consistent:
            self.paths = None  # a fit is no solution of the equations
        for batch in range(MAX_BATCHES):
            count_before = len(self.solutions)
            batch_has_candidates, batch_is_finite = self.fit(self.initial, thorough=not batch)
            has_candidates, is_finite = (
                has_candidates or batch_has_candidates,
                is_finite or batch_is_finite,
            )
            if (
                self.is_consistent
                or self.initial.shape[1] == 1
                or not has_candidates
                or self.is_open
            ):
                break
            self.batches, self.starts = self.batches + 1, self.starts + self.initial.shape[1]
            self.idle = 0 if len(self.solutions) > count_before else self.idle + 1
            if self.idle == MAX_IDLE_BATCHES:
                break
            self.initial = _random_starts(self.system, self.rng, FIT_BATCH_SIZE)
        if not (has_candidates or is_finite):
            raise np.linalg.LinAlgError("not finite")
        if has_candidates and not (self.solutions or self.open_solutions):
            raise UnsolvableError(
                "the search for the impact nearest to the known values did not converge; expected "
                "wider tolerances, or fewer values"
            )
        if not (self.solutions or self.open_solutions):
            known = self.system.known
            exact = {name: item.nominal for name, item in known.items() if not item.varies}
            laws = describe_laws(missed_laws(exact))
            raise UnsolvableError(
                f"no impact agrees with all that is known exactly{': ' * bool(laws)}{laws}; "
                "expected tolerances ('+- D') for what is measured"
            )
        # an undetermined solution counts where all others contradict the measurements
        least_squares = min((solution.squares for solution in self.solutions), default=math.inf)
        return [
            solution
            for solution in self.open_solutions
            if MAX_SQUARES_RATIO * solution.squares + 1e-9 < least_squares
        ] + self.solutions

    def fit(self, starts: Floats, thorough: bool) -> tuple[bool, bool]:
        """Add the solutions that iterations from ``starts`` lead to.

        ``thorough``: also tighten tolerances step by step from the first starts. Return True if
        conditions were nearly met anywhere, and True if any iteration stayed finite."""
        system = self.system
        ends, largest_residuals, converged = _iterate_gauss_newton(system, starts)
        squares = np.square(system.residuals(system.state(ends))[len(system.conditions) :]).sum(
            axis=0
        )
        unconverged_count = 0
        for i in np.argsort(
            np.broadcast_to(squares, largest_residuals.shape), kind="stable"
        ).tolist():
            if self.is_open and len(self.end_points) >= MAX_OPEN_ENDS:
                break
            if largest_residuals[i] <= CANDIDATE_TOL and (
                converged[i] or unconverged_count < MAX_OPEN_ENDS
            ):
                unconverged_count += not converged[i]
                self.add_solution_near(ends[:, i : i + 1])
        has_candidates = bool((largest_residuals <= CANDIDATE_TOL).any())
        first_starts, more_starts = (
            starts[:, :CONTINUATION_STARTS],
            starts[:, CONTINUATION_STARTS:MORE_CONTINUATION_STARTS],
        )
        for group in () if self.is_consistent or not thorough else (first_starts, more_starts):
            is_settled = starts.shape[1] == 1 or (group is more_starts and not self.is_open)
            if (self.solutions or self.open_solutions) and is_settled:
                break
            for start in group.T:
                end, largest_residual = fit_with_continuation(system, start[:, None])
                if largest_residual <= CANDIDATE_TOL:
                    has_candidates = True
                    self.add_solution_near(end)
        return has_candidates, bool(np.isfinite(largest_residuals).any())

    @property
    def is_open(self) -> bool:
        """True where the solution leaves something undetermined: there may be many equally good
        ones."""
        return bool(self.open_solutions) and not self.solutions

    def add_solution_near(self, end: Floats) -> None:
        """Refine ``end`` to a solution and keep it, if it is new and likely."""
        if any(np.abs(end - item).max(initial=0.0) < DUPLICATE_TOL for item in self.end_points):
            return
        self.end_points.append(end)
        try:
            x, largest_residual = refine(self.system, end)
        except np.linalg.LinAlgError:
            return  # something is not finite there
        if not largest_residual <= RESIDUAL_TOL or any(
            np.abs(x - item.x).max(initial=0.0) < DISTINCT_TOL for item in self.solutions
        ):
            return
        if pseudo_inverse(self.system.jacobian(x))[1].shape[1]:
            adjustments = self.system.residuals(self.system.state(x))[len(self.system.conditions) :]
            squares = float(np.square(adjustments).sum())
            least_squares = min((item.squares for item in self.solutions), default=math.inf)
            # skip an unlikely fold, and the continuum that was found before
            if squares > MAX_SQUARES_RATIO * least_squares + 1e-9:
                return
            if self.open_count >= MAX_OPEN_ENDS and squares > self.open_solutions[0].squares - 1e-9:
                return
        solution = _describe(self.system, x, self.assumed)
        if solution.undetermined:  # keep one: any other point of the continuum is as good
            self.open_count += 1
            candidates = (*self.open_solutions, solution)
            self.open_solutions = [
                min(
                    candidates,
                    key=lambda impact: (round(impact.squares, 9), impact.impossible != 0),
                )
            ]
        else:
            self.solutions.append(solution)


def _is_fold(system: System, x: Floats, null: Floats) -> bool:
    """Return True if the impact is isolated although first order leaves something undetermined: two
    branches meet there. Iterations from points beside a fold return to it; beside a point of a
    continuum they do not."""
    offset_points = np.concatenate([x + FOLD_OFFSET * null, x - FOLD_OFFSET * null], axis=1)
    ends, largest_residuals = solve_gauss_newton(system, offset_points)
    returned = largest_residuals <= RESIDUAL_TOL
    return bool((np.abs(ends - x).max(axis=0)[returned] < 0.1 * FOLD_OFFSET).all())


def _describe(system: System, x: Floats, assumed: bool) -> Reconstruction:
    """Return the solution at ``x``: every quantity that is determined there, and the adjustments.

    A quantity is undetermined where its gradient has a component in the null space of the
    Jacobian, unless the impact is isolated (`_is_fold`). Two kinds need more than their gradient:

    - A course does not change with the speed along it, so that its gradient may be zero; where a
      component of the velocity is undetermined, the vehicle could also drive the other way, 180°
      off.
    - The direction of the impulse is undetermined where P_n is."""
    state, rows = system.state(x), system.jacobian(x)
    adjustments = system.residuals(state)[len(system.conditions) :, 0]
    _, null = pseudo_inverse(rows)

    def to_float(array: Any) -> float:
        return float(np.ravel(array)[0])

    values = {n: to_float(state.values[n]) for n in ("M", *GEOMETRY) if n in system.known}
    absent = absent_results(system.known)
    undetermined: list[str] = []
    is_fold = bool(null.shape[1]) and _is_fold(system, x, null)
    for name, gradient in zip(QUANTITIES, system.gradients(x, QUANTITIES), strict=True):
        if name in absent or (system.point and name in (*SPINS, "PM", "EM")):
            continue
        is_known = name in COEFFICIENTS and name in system.known
        if name == "MUP" and "MUC" in system.constants:
            # MUP is then known as a fraction of MUC only, which differs from impact to impact
            is_known = False
        amount = to_float(state.values[name] if is_known else state[name])
        largest = np.abs(gradient).max(initial=0.0)
        is_open = not is_fold and np.abs(gradient @ null).max(initial=0.0) > NULL_TOL * largest
        if name in COURSES:
            along_open = bool({*undetermined} & {*SPEEDS[COURSES[name]]})
            if along_open and name in system.known and not system.known[name].varies:
                values[name] = system.known[name].nominal  # the vehicle might drive either way
                continue
            is_open |= along_open and name not in system.known
        if name in FORCES and name not in system.known:
            is_open |= "PN" not in values
        if is_known or (np.isfinite(amount) and np.isfinite(largest) and not is_open):
            values[name] = amount
        elif name in (*VELOCITIES, *FINAL_STATE, *COEFFICIENTS):
            undetermined.append(name)
    names = (*VELOCITIES, *FINAL_STATE, *COEFFICIENTS)
    unknown = [n for n in names if n not in system.known and n not in absent]
    if unknown and not any(name in values for name in unknown) and not system.observations:
        raise UnsolvableError(
            f"nothing of {' '.join(unknown)} is determined by what is known; expected more of it"
        )
    items = [
        (n, system.known[n], to_float(system.observed_value(state, n))) for n in system.observations
    ]
    adjusted = tuple(
        Adjusted(n, item.nominal, item.tolerance, adjusted_value)
        for n, item, adjusted_value in items
    )
    redundancy = len(rows) - (rows.shape[1] - null.shape[1])
    return Reconstruction(
        system=system,
        x=x,
        values=with_headings(values),
        undetermined=tuple(undetermined),
        adjusted=adjusted,
        redundancy=redundancy,
        squares=float(adjustments @ adjustments),
        assumed=assumed,
    )


# -- friction given as a fraction of the critical one


def resolve_friction(known: Mapping[str, Uncertain]) -> tuple[dict[str, Uncertain], str | None]:
    """Return ``known`` with MU, given as a fraction of the critical friction, replaced by a number
    or limits, and a sentence that says so; ``known`` and None where MU is no fraction.

    The critical friction MUC follows from the whole scene. Where that is known, so is MU; where
    part of it is solved for, MUP = fraction · MUC is one more equation, solved by the secant
    method. Raise UserError where no friction satisfies it."""
    item = known.get("MU")
    if item is None or not item.share:
        return dict(known), None
    other_values = {name: value for name, value in known.items() if name != "MU"}
    scene = {"M": 6.0} | {n: x.nominal for n, x in other_values.items() if n in SCENE}
    if len(scene) == len(SCENE) - 1:
        name, value = "MU", float(share_typed(scene, item.nominal))
    else:
        name, value = "MUP", _solve_friction(other_values, item.nominal)
    if value != value:
        raise UserError("no friction ends the sliding here; expected a number", "MU")
    text = f"MU is {100 * item.nominal:g} % of the critical friction: {name} = {value:.9g}"
    varies = item.varies or any(x.varies for x in other_values.values())
    if name == "MU" and varies:
        signed = item.nominal * float(solve({**scene, "MU": 0.0}, ("MUC",))["MUC"])
        name, value = "MUP", signed
    scale = value / item.nominal if item.nominal else 0.0
    low, high = sorted((item.low * scale, item.high * scale))
    friction = fixed_value(value)
    if item.varies:
        spread = abs(item.deviation * scale)
        friction = replace(item, nominal=value, low=low, high=high, deviation=spread, share=False)
    # Where anything varies, so does MUC: each impact then has the condition P_t = fraction MUC P_n,
    # with its own MUC. ``critical`` is the nominal one, to turn ``friction`` into the fraction.
    if varies and scale:
        friction = replace(friction, critical=scale)
    return {**other_values, name: friction}, text


def _solve_friction(other_values: Mapping[str, Uncertain], fraction: float) -> float:
    """Return the P_t/P_n that is the given fraction of MUC in the impact that follows from it and
    the other values, by the secant method."""
    exact = not needs_adjustment(other_values, None)
    numbers = {name: item.nominal for name, item in other_values.items()}

    def excess(mu: float) -> float:
        scene: dict[str, Any]
        if exact:
            scene = {**numbers, **solve_for({**numbers, "MUP": mu})[0].values}
        else:
            scene = reconstruct({**other_values, "MUP": fixed_value(mu)})[0].scene()
        scene = {name: value for name, value in scene.items() if name in SCENE}
        return mu - fraction * float(solve({**scene, "MU": 0.0}, ("MUC",))["MUC"])

    failure = UserError("no friction is found that is this share of the critical friction", "MU")
    for start in (0.3, -0.3):
        try:
            previous, current = 0.0, start
            previous_excess, excess_now = excess(previous), excess(current)
            for _ in range(MAX_SECANT_STEPS):
                if abs(excess_now) <= FRICTION_TOL or previous_excess == excess_now:
                    break
                previous, previous_excess, current = (
                    current,
                    excess_now,
                    current - excess_now * (current - previous) / (excess_now - previous_excess),
                )
                excess_now = excess(current)
            if abs(excess_now) <= 1e3 * FRICTION_TOL:
                return current
        except UserError as error:
            failure = error
    raise failure
