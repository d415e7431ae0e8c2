"""All exact impacts, as the solutions of quadratic equations found by homotopy continuation.

With exact vehicles and coefficients every condition is linear in velocities and impulses, or
quadratic: speeds, changes of velocity and energies. Linear conditions are eliminated; k quadratic
equations in k unknowns are left, which have 2^k complex solutions at most (Bézout). The start
system y_i² = r_i, whose solutions are known, is changed continuously into these equations, and each
solution is followed along its path. With random complex constants every isolated solution is the
end of a path (Morgan, *Solving Polynomial Systems Using Continuation for Engineering and Scientific
Problems*, 1987). Homogeneous coordinates make points at infinity ordinary points."""

import math
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...mechanics.state import COURSE_OF, SPEEDS, State
from .system import System

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

MAX_EQUATIONS = 8  # 256 paths
ZERO_TOL = 1e-11  # relative coefficients and singular values below are rounding
MAX_STEPS = 400  # per path, rejected ones included
MIN_STEP = 1e-8  # a path that needs shorter steps ends at a singular point
NEAR_END = 1e-3  # path parameter left where paths to infinity begin to be recognized
FIRST_STEP = 0.02  # of the path parameter, which runs from 0 to 1
CORRECTION_TOL = 1e-4  # largest first Newton correction of an accepted step, of a unit vector
CONVERGED = 1e-10  # largest last correction
REAL_TOL = 1e-6  # relative imaginary parts below are rounding
NEARLY_REAL = 0.3  # relative imaginary part of complex solutions that serve as starts of a fit
INFINITY_TOL = 1e-7  # homogenizing coordinate of a unit vector below which it is at infinity
# The homogenizing coordinate of a path to a w-fold point at infinity falls as the 1/w-th power of
# the parameter left, that of a path to a finite point not at all.
MIN_EXPONENT = 0.1
DISTINCT_TOL = 1e-6  # distance of unit vectors below which two paths have met
MAX_ROUNDS = 2  # with new random constants where paths met or did not end
# Names of the fraction of the initial energy that is lost, each with its unit
_RATIOS = {"LOSS": 0.01, "DT": 1.0}


class Quadrics(NamedTuple):
    """Quadratic equations (1, y)^T ``forms[i]`` (1, y) = 0 with symmetric matrices, and the map
    from y to the scaled variables: ``origin`` + ``basis`` · y."""

    forms: Floats
    origin: Floats
    basis: Floats

    @property
    def size(self) -> int:
        """The number of equations, and of unknowns."""
        return len(self.forms)


class Paths(NamedTuple):
    """The ends of all paths.

    ``real``: real ends (scaled variables, a column each); ``complex_ends`` and ``infinite_ends``:
    the numbers of complex ones and of those at infinity; ``lost``: the number of paths that did not
    end or met another; ``near``: real parts of nearly real ends."""

    real: Floats
    complex_ends: int
    infinite_ends: int
    lost: int
    near: Floats

    @property
    def total(self) -> int:
        """The number of solutions."""
        return int(self.real.shape[1]) + self.complex_ends + self.infinite_ends + self.lost


def _polynomials(system: System, state: State) -> Floats:
    """Return the residuals of the conditions, each written as a polynomial of the scaled
    variables."""
    rows = [state.law(name) / system.law_scale(name) for name in system.laws]
    for name in system.exact:
        value = system.nominal[name]
        if name in SPEEDS and COURSE_OF[name] not in system.known:
            x, y = (state[part] for part in SPEEDS[name])
        elif name in ("DVA", "DVB"):
            x, y = state.changes[:2] if name == "DVA" else state.changes[3:5]
        elif name in _RATIOS:
            residual = state.energy_lost - _RATIOS[name] * value * state.initial_energy
            rows.append(residual / system.scale("EL"))
            continue
        else:
            rows.append(system.exact_residual(state, name, system.nominal))
            continue
        rows.append((x * x + y * y - value * value) / system.speed**2)
    return np.stack(np.broadcast_arrays(state.values["PN"], *rows))[1:]


def quadratic_equations(system: System) -> Quadrics | None:
    """Return the equations of a ``system`` of exact values; None where they are not quadratic, or
    not as many as unknowns.

    The coefficients are found by evaluating the polynomials at 0, at plus and minus each unit
    vector and at sums of two."""
    count = len(system.variables)
    lengths = [
        name
        for name in system.exact
        if name in ("DVA", "DVB") or (name in SPEEDS and COURSE_OF[name] not in system.known)
    ]
    # a velocity of length 0 is two conditions in one
    has_zero_length = any(not system.nominal[name] > 0 for name in lengths)
    if not count or len(system.conditions) != count or has_zero_length or "MUC" in system.constants:
        return None
    pairs = [*product(range(count), repeat=2)]
    points = np.zeros((count, 1 + count + len(pairs)))
    points[:, 1 : 1 + count] = -np.eye(count)
    for column, (i, j) in enumerate(pairs, 1 + count):
        points[i, column] += 1
        points[j, column] += 1 if i != j else 0
    values = _polynomials(system, system.state(points))
    if not np.isfinite(values).all():
        return None
    constants, at_minus = values[:, 0], values[:, 1 : 1 + count]
    at_pairs = values[:, 1 + count :].reshape(count, count, count)
    at_plus = np.einsum("rii->ri", at_pairs)
    linear = (at_plus - at_minus) / 2
    squares = (at_plus + at_minus) / 2 - constants[:, None]
    forms = np.zeros((count, count + 1, count + 1))
    forms[:, 0, 0] = constants
    forms[:, 0, 1:] = forms[:, 1:, 0] = linear / 2
    cross = (at_pairs - at_plus[:, :, None] - at_plus[:, None, :] + constants[:, None, None]) / 2
    forms[:, 1:, 1:] = cross
    diagonal = np.arange(1, count + 1)
    forms[:, diagonal, diagonal] = squares
    return _without_linear(forms)


def _without_linear(forms: Floats) -> Quadrics | None:
    """Eliminate all linear equations and linear combinations. Return None where the rest does not
    have as many equations as unknowns."""
    size = forms.shape[1] - 1
    origin, basis = np.zeros(size), np.eye(size)
    while len(forms):
        largest = np.abs(forms).max(axis=(1, 2))
        if not largest.all():
            return None
        forms = forms / largest[:, None, None]
        quadratic_parts = forms[:, 1:, 1:].reshape(len(forms), -1)
        u, s, _ = np.linalg.svd(quadratic_parts)
        rank = int((s > ZERO_TOL * max(1.0, s.max(initial=0.0))).sum())
        combinations = np.einsum("ri,rab->iab", u, forms)
        if rank == len(forms):
            break
        linear_rows, right = 2 * combinations[rank:, 0, 1:], -combinations[rank:, 0, 0]
        left_vectors, singular, vt = np.linalg.svd(linear_rows)
        linear_rank = int((singular > ZERO_TOL * singular.max(initial=0.0)).sum())
        if linear_rank < len(linear_rows):
            return None  # redundant, or contradicts the others
        solution = vt[:linear_rank].T @ (
            (left_vectors.T @ right)[:linear_rank] / singular[:linear_rank]
        )
        null_basis = vt[linear_rank:].T
        origin, basis = origin + basis @ solution, basis @ null_basis
        substitution = np.zeros((forms.shape[1], 1 + null_basis.shape[1]))
        substitution[0, 0], substitution[1:, 0], substitution[1:, 1:] = 1.0, solution, null_basis
        forms = substitution.T @ combinations[:rank] @ substitution
    if len(forms) != basis.shape[1]:
        return None
    return Quadrics(forms, origin, basis)


def follow_paths(equations: Quadrics, rng: np.random.Generator) -> Paths:
    """Follow the paths to all solutions of ``equations``. Return their ends."""
    origin, real_roots = equations.origin[:, None], np.empty((equations.size, 0))
    ends = Paths(origin, 0, 0, 0, origin[:, :0])
    for _ in range(MAX_ROUNDS if equations.size else 0):
        points, finished, at_infinity = _track_paths(equations.forms, rng)
        lost = int((~finished & ~at_infinity).sum()) + _count_meetings(
            points[:, finished & ~at_infinity]
        )
        y = points[1:, ~at_infinity] / points[0, ~at_infinity]
        is_real = np.abs(y.imag).max(axis=0) <= REAL_TOL * (1 + np.abs(y).max(axis=0))
        # a path only comes close to a point where branches meet
        is_real |= ~finished[~at_infinity]
        real_roots = np.column_stack([real_roots, y[:, is_real].real])
        nearly_real = np.abs(y.imag).max(axis=0) <= NEARLY_REAL * (1 + np.abs(y).max(axis=0))
        near_ends = origin + equations.basis @ y[:, nearly_real & ~is_real].real
        real_ends = origin + equations.basis @ real_roots
        ends = Paths(real_ends, int((~is_real).sum()), int(at_infinity.sum()), lost, near_ends)
        if not lost:
            break
    return ends


def _track_paths(
    forms: Floats, rng: np.random.Generator
) -> tuple[Complexes, NDArray[np.bool_], NDArray[np.bool_]]:
    """Return the ends of all paths (unit vectors of homogeneous coordinates 1, y, a column each),
    True for each that was reached, and True for each at infinity.

    Along F(z, s) = start + s (target - start), s from 0 to 1, each step predicts by the classical
    Runge-Kutta method and corrects by three Newton iterations. It is rejected, and shortened to a
    third, where these do not converge."""
    # not split: one step of one iteration, all of whose arrays its parts share
    count = len(forms)
    # random orthogonal combinations of the normalized equations
    rotation = np.linalg.qr(rng.standard_normal((count, count)))[0]
    norms = np.sqrt(np.square(forms).sum(axis=(1, 2)))
    target = np.einsum("ij,jab->iab", rotation, forms / norms[:, None, None])
    radii = np.exp(2j * math.pi * rng.random(count)) * rng.uniform(0.5, 2.0, count)
    start_system = np.zeros_like(target, dtype=complex)
    start_system[:, 0, 0] = -radii
    start_system[range(count), range(1, count + 1), range(1, count + 1)] = 1.0
    start_system *= np.exp(2j * math.pi * rng.random())
    signs = np.array([*product((1.0, -1.0), repeat=count)]).T
    z = np.concatenate([np.ones((1, signs.shape[1])), np.sqrt(radii)[:, None] * signs])
    z = z / np.sqrt(np.square(np.abs(z)).sum(axis=0))
    s, step = np.zeros(z.shape[1]), np.full(z.shape[1], FIRST_STEP)
    running = np.arange(z.shape[1])
    difference = target - start_system
    # parameter left and homogenizing coordinate at the last point far from the end
    reference_way, reference_size = np.ones(z.shape[1]), np.abs(z[0])

    def tangent(z: Complexes, s: Floats) -> Complexes:
        return _solve(
            _jacobian(start_system, difference, z, s), -np.einsum("iab,ap,bp->ip", difference, z, z)
        )

    for _ in range(MAX_STEPS):
        points, places, lengths = (
            z[:, running],
            s[running],
            np.minimum(step[running], 1 - s[running]),
        )
        a = tangent(points, places)
        b = tangent(points + lengths / 2 * a, places + lengths / 2)
        c = tangent(points + lengths / 2 * b, places + lengths / 2)
        d = tangent(points + lengths * c, places + lengths)
        trial, trial_places = points + lengths / 6 * (a + 2 * b + 2 * c + d), places + lengths
        trial = trial / np.sqrt(np.square(np.abs(trial)).sum(axis=0))
        sizes = []
        for _ in range(3):
            matrices = _jacobian(start_system, difference, trial, trial_places)
            values = np.einsum(
                "iap,ap->ip", _apply_forms(start_system, difference, trial_places, trial), trial
            )
            correction = _solve(matrices, -values)
            trial = trial + correction
            sizes.append(np.sqrt(np.square(np.abs(correction)).sum(axis=0)))
            trial = trial / np.sqrt(np.square(np.abs(trial)).sum(axis=0))
        accepted = (sizes[0] < CORRECTION_TOL) & (sizes[-1] < CONVERGED)
        advanced = running[accepted]
        z[:, advanced], s[advanced] = trial[:, accepted], trial_places[accepted]
        far_from_end = advanced[1 - s[advanced] > NEAR_END]
        reference_way[far_from_end], reference_size[far_from_end] = (
            1 - s[far_from_end],
            np.abs(z[0, far_from_end]),
        )
        easily_corrected = accepted & (sizes[0] < CORRECTION_TOL / 32)
        step[running] = np.where(
            easily_corrected, 2 * lengths, np.where(accepted, lengths, lengths / 3)
        )
        running = running[(s[running] < 1) & (step[running] > MIN_STEP)]
        if not len(running):
            break
    finished, remaining = s >= 1, np.maximum(1 - s, np.finfo(float).tiny)
    size = np.abs(z[0])
    exponent = np.log(reference_size / np.maximum(size, 1e-300)) / np.log(reference_way / remaining)
    at_infinity = (finished & (size < INFINITY_TOL)) | (
        ~finished
        & (remaining < NEAR_END**2)
        & (exponent > MIN_EXPONENT)
        & (size < math.sqrt(NEAR_END))
    )
    return z, finished, at_infinity


def _apply_forms(
    start_system: Complexes, difference: Complexes, s: Floats, z: Complexes
) -> Complexes:
    """Return the forms at each path's ``s`` times z: equations, coordinates, paths."""
    return np.asarray(start_system @ z + s * (difference @ z))


def _jacobian(start_system: Complexes, difference: Complexes, z: Complexes, s: Floats) -> Complexes:
    """Return the derivatives, a matrix per path; the last row makes steps orthogonal to z."""
    derivatives = 2 * _apply_forms(start_system, difference, s, z)
    return np.concatenate([derivatives, z.conj()[None]]).transpose(2, 0, 1)


def _solve(matrices: Complexes, right: Complexes) -> Complexes:
    """Return the step of each path (columns); nan for all where a matrix is singular."""
    sides = np.concatenate([right, np.zeros((1, right.shape[1]))]).T[:, :, None]
    try:
        return np.asarray(np.linalg.solve(matrices, sides)[:, :, 0].T, np.complex128)
    except np.linalg.LinAlgError:
        return np.full((len(right) + 1, right.shape[1]), np.nan, np.complex128)


def _count_meetings(z: Complexes) -> int:
    """Return the number of ends that coincide with another path's."""
    cosines = np.abs(z.conj().T @ z)
    same = np.triu(1 - cosines < DISTINCT_TOL**2, 1)
    return int(same.any(axis=0).sum())
