"""Local minima of weighted least squares with conditions.

Conditions hold exactly where the minimum is one of Newton's method for the Lagrangian (`polish`).
The way there, from many starts at once, is the Levenberg-Marquardt method (`descend`): conditions
are observations among others, weighed more from stage to stage, so that the first stages cross the
valleys in which the last ones stay."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .system import System

Floats = NDArray[np.float64]

# Weights of a condition, relative to an observation of one standard deviation
PENALTIES = (1.0, 1e2, 1e4, 1e6)
MAX_STEPS = 40  # of each stage
MAX_NEWTON_STEPS = 50  # of one end of iterations
FIRST_DAMPING = 1e-2  # relative to the columns of the Jacobian
MIN_DAMPING = 1e-18  # keeps steps finite where nothing determines a direction
DISTINCT_TOL = 1e-6  # points whose scaled variables differ by less are the same
XTOL = 1e-13  # relative step at convergence
MAX_POLISH_SHIFT = 0.5  # longest relative step of Newton's method
DIFFERENCE_STEP = 1e-6  # half width of the central differences for second derivatives
CURVATURE_TOL = 1e-9  # negative eigenvalues above minus this are rounding
RANK_TOL = 1e-10  # singular values below, relative to the largest, count as zero


def descend(system: System, starts: Floats, penalties: Sequence[float] = PENALTIES) -> Floats:
    """Return the ends of Levenberg-Marquardt iterations from several starts, a column each, with
    ever larger ``penalties``. A start that is not finite ends where it is."""
    x, places = starts, np.arange(starts.shape[1])
    for penalty in penalties if system.observations else PENALTIES[:1]:
        x = _descend(system, x, penalty)
        x, merged = _merge(x)
        places = merged[places]
    return x[:, places]


def _merge(x: Floats) -> tuple[Floats, NDArray[np.intp]]:
    """Return the distinct columns, and the number among them of each: ends that coincide go on as
    one."""
    is_same = np.abs(x[:, :, None] - x[:, None]).max(axis=0, initial=0.0) < DISTINCT_TOL
    np.fill_diagonal(is_same, True)
    same = np.array([row.argmax() for row in is_same], np.intp)
    first, places = np.unique(same, return_inverse=True)
    return x[:, first], places


def _descend(system: System, starts: Floats, penalty: float) -> Floats:
    """Return the ends of one stage, with this weight of conditions."""
    x = starts.copy()
    weights = np.ones((system.condition_count + len(system.observations), 1))
    weights[: system.condition_count] = penalty
    residual, jacobian = _weighted(system, x, weights)
    damping = np.full(x.shape[1], FIRST_DAMPING)
    running = np.flatnonzero(np.isfinite(residual).all(axis=0))
    for _ in range(MAX_STEPS):
        running = running[np.isfinite(jacobian[:, :, running]).all(axis=(0, 1))]
        if not len(running):
            break
        steps = _damped_steps(residual[:, running], jacobian[:, :, running], damping[running])
        trial = x[:, running] + steps
        trial_residual, trial_jacobian = _weighted(system, trial, weights)
        squares = np.square(residual[:, running]).sum(axis=0)
        trial_squares = np.nan_to_num(np.square(trial_residual).sum(axis=0), nan=np.inf)
        better = trial_squares <= squares
        moved = running[better]
        x[:, moved], residual[:, moved] = trial[:, better], trial_residual[:, better]
        jacobian[:, :, moved] = trial_jacobian[:, :, better]
        damping[running] = np.where(
            better,
            np.maximum(damping[running] / 10, MIN_DAMPING),
            damping[running] * 5,
        )
        lengths = np.abs(steps).max(axis=0, initial=0.0)
        running = running[lengths > XTOL * (1 + np.abs(trial).max(axis=0, initial=0.0))]
    return x


def _weighted(system: System, x: Floats, weights: Floats) -> tuple[Floats, Floats]:
    residual, jacobian = system.linearize(x, system.residuals)
    return weights * residual, weights[:, :, None] * jacobian


def _damped_steps(residual: Floats, jacobians: Floats, damping: Floats) -> Floats:
    """Return the Levenberg-Marquardt steps, a column each."""
    rows, size, _ = jacobians.shape
    matrices = jacobians.transpose(2, 0, 1)
    scales = np.sqrt(np.square(matrices).sum(axis=1)) + np.finfo(float).tiny
    damped_rows = (np.sqrt(damping)[:, None] * scales)[:, :, None] * np.eye(size)
    q, r = np.linalg.qr(np.concatenate([matrices, damped_rows], axis=1))
    right = np.einsum("nij,ni->nj", q[:, :rows], -residual.T)
    return np.asarray(np.linalg.solve(r, right[:, :, None])[:, :, 0].T)


def polish(system: System, x: Floats) -> Floats | None:
    """Return the minimum near a point, by Newton's method; None where there is none."""
    previous_length = np.inf
    for _ in range(MAX_NEWTON_STEPS):
        step, is_minimum = _newton_step(system, x)
        length, size = np.abs(step).max(initial=0.0), 1 + np.abs(x).max(initial=0.0)
        if not length < MAX_POLISH_SHIFT * size:
            return None
        x = x + step[:, None]
        # a tiny step that is more than half of the one before is rounding
        if length < XTOL * size or 1e-9 * size > length > 0.5 * previous_length:
            return x if is_minimum else None
        previous_length = length
    return None


def _newton_step(system: System, x: Floats) -> tuple[Floats, bool]:
    """Return the step of Newton's method for the Lagrangian, and True if that curves upward along
    the conditions.

    With conditions c(x) = 0, observations r(x) and their Jacobians C and A the step is one to the
    conditions, -C⁺c, and one along them. The latter is written in units of the observations, w,
    which change by a unit vector along each: A Z V S⁻¹ = U, with the null space Z of C and A Z = U
    S V^T. Directions that nothing determines to first order are left out."""
    residual, jacobian = (array[..., 0] for array in system.linearize(x, system.residuals))
    count = system.condition_count
    inverse, null = pseudo_inverse(jacobian[:count])
    a, r = jacobian[count:], residual[count:]
    to_conditions = -inverse @ residual[:count]
    u, s, vt, _ = decompose(a @ null, np.abs(a).max(initial=0.0))
    units = null @ vt.T / s
    multipliers = np.concatenate([-inverse.T @ (a.T @ r), r])
    curvature = _lagrangian_hessian(system, x, multipliers)
    hessian = np.eye(len(s)) + units.T @ curvature @ units
    gradient = u.T @ (r + a @ to_conditions) + units.T @ (curvature @ to_conditions)
    if not (np.isfinite(hessian).all() and np.isfinite(gradient).all()):
        raise np.linalg.LinAlgError("not finite")
    is_minimum = np.linalg.eigvalsh(hessian).min(initial=0.0) > -CURVATURE_TOL
    step = to_conditions - units @ np.linalg.lstsq(hessian, gradient, rcond=None)[0]
    return step, bool(is_minimum)


def _lagrangian_hessian(system: System, x: Floats, multipliers: Floats) -> Floats:
    """Return the sum of the residuals' second derivatives times ``multipliers``, by central
    differences of the Jacobian."""
    offsets = DIFFERENCE_STEP * np.eye(len(x))
    jacobians = system.linearize(
        np.concatenate([x + offsets, x - offsets], axis=1), system.residuals
    )[1]
    ahead, behind = np.split(np.einsum("r,rik->ik", multipliers, jacobians), 2, axis=1)
    hessian = (ahead - behind) / (2 * DIFFERENCE_STEP)
    return np.asarray(hessian + hessian.T) / 2


def pseudo_inverse(matrix: Floats) -> tuple[Floats, Floats]:
    """Return the Moore-Penrose inverse of a matrix and a basis of its null space. Raise LinAlgError
    for one that is not finite: LAPACK may not return from it."""
    u, s, vt, null = decompose(matrix)
    return (vt.T / s) @ u.T, null


def decompose(matrix: Floats, size: float = 0.0) -> tuple[Floats, Floats, Floats, Floats]:
    """Return U, the singular values that count beside the largest or ``size``, V^T and a basis of
    the null space."""
    if not np.isfinite(matrix).all():
        raise np.linalg.LinAlgError("not finite")
    u, s, vt = np.linalg.svd(matrix)
    rank = int((s > RANK_TOL * s.max(initial=size)).sum())
    return u[:, :rank], s[:rank], vt[:rank], vt[rank:].T
