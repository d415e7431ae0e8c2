"""The exact impacts as the solutions of quadratic equations, all of them.

With exact vehicles and coefficients every condition is linear in velocities and impulses, or
quadratic: speeds, changes of velocity and energies. Linear conditions are eliminated; k quadratic
equations in k unknowns are left, which have 2^k complex solutions at most (Bézout). Each is
followed along a path from those of y_i² = r_i, k equations that anyone can solve, as one system is
changed into the other: with random complex constants every isolated solution is the end of a path
(Morgan, *Solving Polynomial Systems Using Continuation for Engineering and Scientific Problems*,
1987). Paths run in homogeneous coordinates, where infinity is a point like any other.
"""

import math
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..mechanics.state import COURSES, SPEEDS, State
from .system import System

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

MAX_EQUATIONS = 8  # 256 paths
ZERO_TOL = 1e-11  # coefficients and singular values up to that, of the largest, are rounding
CONSISTENCY_TOL = 1e-9  # scaled residual of linear conditions that agree
MAX_STEPS = 400  # of a path, the rejected ones included
MIN_STEP = 1e-8  # a path that needs smaller ones ends at a singular point
NEAR_END = 1e-3  # remaining way from which on it is seen whether a path runs to infinity
FIRST_STEP = 0.02
CORRECTION_TOL = 1e-4  # largest first correction, of a vector of length 1
CONVERGED = 1e-10  # last correction
REAL_TOL = 1e-6  # imaginary parts up to that, of the largest part, are rounding
NEARLY_REAL = 0.3  # imaginary parts up to that leave a start for a fit
INFINITY_TOL = 1e-7  # homogenizing coordinate of a vector of length 1 below which it is at infinity
MIN_EXPONENT = 0.1
"""The homogenizing coordinate of a path to a w-fold point at infinity falls as the 1/w-th power of
the remaining way, that of a path to a finite one not at all."""
DISTINCT_TOL = 1e-6  # distance of unit vectors up to which two paths have met
ROUNDS = 2  # paths are followed again, with other constants, where some met or came to no end
_COURSE_OF = {speed: course for course, speed in COURSES.items()}
_RATIOS = {"LOSS": 0.01, "DT": 1.0}
"""Names of the fraction of the energy before that is lost, each with its unit."""


class Quadrics(NamedTuple):
    """Quadratic equations ``forms[i]`` (symmetric matrices over 1, y) and the map from y to the
    scaled variables: ``origin`` + ``basis`` · y."""

    forms: Floats
    origin: Floats
    basis: Floats

    @property
    def size(self) -> int:
        """The number of equations, and of unknowns."""
        return len(self.forms)


class Paths(NamedTuple):
    """The ends of all paths: ``real`` ones (scaled variables, a column each), how many are complex
    or at infinity, and how many came to no end or met another (``lost``); ``near``: the real parts
    of complex ones that are nearly real."""

    real: Floats
    complex_ends: int
    infinite_ends: int
    lost: int
    near: Floats

    @property
    def total(self) -> int:
        """The number of solutions."""
        return int(self.real.shape[1]) + self.complex_ends + self.infinite_ends + self.lost


def _rows(system: System, state: State) -> Floats:
    """Return the conditions' residuals, each as a polynomial of the scaled variables."""
    rows = [state.law(name) / system.law_scale(name) for name in system.laws]
    for name in system.exact:
        value = system.nominal[name]
        if name in SPEEDS and _COURSE_OF[name] not in system.known:
            x, y = (state[part] for part in SPEEDS[name])
        elif name in ("DVA", "DVB"):
            x, y = state.changes[:2] if name == "DVA" else state.changes[3:5]
        elif name in _RATIOS:
            left = state.energy_lost - _RATIOS[name] * value * state.initial_energy
            rows.append(left / system.scale("EL"))
            continue
        else:
            rows.append(system.exact_residual(state, name, system.nominal))
            continue
        rows.append((x * x + y * y - value * value) / system.speed**2)
    return np.stack(np.broadcast_arrays(state.values["PN"], *rows))[1:]


def quadratic_equations(system: System) -> Quadrics | None:
    """Return the equations of a ``system`` of exact values; None where they are no quadratic
    equations, or not as many as unknowns."""
    size = len(system.variables)
    lengths = [
        name
        for name in system.exact
        if name in ("DVA", "DVB") or (name in SPEEDS and _COURSE_OF[name] not in system.known)
    ]
    # a velocity of length 0 is two conditions in one
    still = any(not system.nominal[name] > 0 for name in lengths)
    if not size or len(system.conditions) != size or still or "MUC" in system.constants:
        return None
    pairs = [*product(range(size), repeat=2)]
    points = np.zeros((size, 1 + size + len(pairs)))
    points[:, 1 : 1 + size] = -np.eye(size)
    for column, (i, j) in enumerate(pairs, 1 + size):
        points[i, column] += 1
        points[j, column] += 1 if i != j else 0
    values = _rows(system, system.state(points))
    if not np.isfinite(values).all():
        return None
    at_zero, behind = values[:, 0], values[:, 1 : 1 + size]
    both = values[:, 1 + size :].reshape(size, size, size)
    ahead = np.einsum("rii->ri", both)
    linear = (ahead - behind) / 2
    squares = (ahead + behind) / 2 - at_zero[:, None]
    forms = np.zeros((size, size + 1, size + 1))
    forms[:, 0, 0] = at_zero
    forms[:, 0, 1:] = forms[:, 1:, 0] = linear / 2
    cross = (both - ahead[:, :, None] - ahead[:, None, :] + at_zero[:, None, None]) / 2
    forms[:, 1:, 1:] = cross
    diagonal = np.arange(1, size + 1)
    forms[:, diagonal, diagonal] = squares
    return _without_linear(forms)


def _without_linear(forms: Floats) -> Quadrics | None:
    """Return the equations with all linear ones, and linear combinations, eliminated."""
    size = forms.shape[1] - 1
    origin, basis = np.zeros(size), np.eye(size)
    while len(forms):
        largest = np.abs(forms).max(axis=(1, 2))
        if not largest.all():
            return None
        forms = forms / largest[:, None, None]
        curved = forms[:, 1:, 1:].reshape(len(forms), -1)
        u, s, _ = np.linalg.svd(curved)
        rank = int((s > ZERO_TOL * max(1.0, s.max(initial=0.0))).sum())
        mixed = np.einsum("ri,rab->iab", u, forms)
        if rank == len(forms):
            break
        rows, right = 2 * mixed[rank:, 0, 1:], -mixed[rank:, 0, 0]
        left, singular, vt = np.linalg.svd(rows)
        kept = int((singular > ZERO_TOL * singular.max(initial=0.0)).sum())
        if kept < len(rows):
            return None  # says nothing, or contradicts the others
        at = vt[:kept].T @ ((left.T @ right)[:kept] / singular[:kept])
        free = vt[kept:].T
        origin, basis = origin + basis @ at, basis @ free
        change = np.zeros((forms.shape[1], 1 + free.shape[1]))
        change[0, 0], change[1:, 0], change[1:, 1:] = 1.0, at, free
        forms = change.T @ mixed[:rank] @ change
    if len(forms) != basis.shape[1]:
        return None
    return Quadrics(forms, origin, basis)


def follow_paths(equations: Quadrics, rng: np.random.Generator) -> Paths:
    """Return where the paths to all solutions of ``equations`` end."""
    origin, met = equations.origin[:, None], np.empty((equations.size, 0))
    ends = Paths(origin, 0, 0, 0, origin[:, :0])
    for _ in range(ROUNDS if equations.size else 0):
        z, done, infinite = _tracked(equations.forms, rng)
        lost = int((~done & ~infinite).sum()) + _meetings(z[:, done & ~infinite])
        y = z[1:, ~infinite] / z[0, ~infinite]
        is_real = np.abs(y.imag).max(axis=0) <= REAL_TOL * (1 + np.abs(y).max(axis=0))
        # where branches meet a path comes close only
        is_real |= ~done[~infinite]
        met = np.column_stack([met, y[:, is_real].real])
        aside = np.abs(y.imag).max(axis=0) <= NEARLY_REAL * (1 + np.abs(y).max(axis=0))
        near = origin + equations.basis @ y[:, aside & ~is_real].real
        several = origin + equations.basis @ met
        ends = Paths(several, int((~is_real).sum()), int(infinite.sum()), lost, near)
        if not lost:
            break
    return ends


def _tracked(
    forms: Floats, rng: np.random.Generator
) -> tuple[Complexes, NDArray[np.bool_], NDArray[np.bool_]]:
    """Return the ends of all paths, columns of length 1 (1, y in homogeneous coordinates), which
    of them were reached, and which are at infinity."""
    count = len(forms)
    # other combinations of the same equations, all as large
    turn = np.linalg.qr(rng.standard_normal((count, count)))[0]
    norms = np.sqrt(np.square(forms).sum(axis=(1, 2)))
    last = np.einsum("ij,jab->iab", turn, forms / norms[:, None, None])
    radii = np.exp(2j * math.pi * rng.random(count)) * rng.uniform(0.5, 2.0, count)
    first = np.zeros_like(last, dtype=complex)
    first[:, 0, 0] = -radii
    first[range(count), range(1, count + 1), range(1, count + 1)] = 1.0
    first *= np.exp(2j * math.pi * rng.random())
    signs = np.array([*product((1.0, -1.0), repeat=count)]).T
    z = np.concatenate([np.ones((1, signs.shape[1])), np.sqrt(radii)[:, None] * signs])
    z = z / np.sqrt(np.square(np.abs(z)).sum(axis=0))
    s, step = np.zeros(z.shape[1]), np.full(z.shape[1], FIRST_STEP)
    going = np.arange(z.shape[1])
    change = last - first
    # the last place of each path that is not near its end
    before, farther = np.ones(z.shape[1]), np.abs(z[0])

    def tangent(z: Complexes, s: Floats) -> Complexes:
        return _solved(_jacobian(first, change, z, s), -np.einsum("iab,ap,bp->ip", change, z, z))

    for _ in range(MAX_STEPS):
        here, at, by = z[:, going], s[going], np.minimum(step[going], 1 - s[going])
        # the classical method of Runge and Kutta
        a = tangent(here, at)
        b = tangent(here + by / 2 * a, at + by / 2)
        c = tangent(here + by / 2 * b, at + by / 2)
        d = tangent(here + by * c, at + by)
        there, then = here + by / 6 * (a + 2 * b + 2 * c + d), at + by
        there = there / np.sqrt(np.square(np.abs(there)).sum(axis=0))
        sizes = []
        for _ in range(3):
            matrices = _jacobian(first, change, there, then)
            off = np.einsum("iap,ap->ip", _mixed(first, change, then, there), there)
            correction = _solved(matrices, -off)
            there = there + correction
            sizes.append(np.sqrt(np.square(np.abs(correction)).sum(axis=0)))
            there = there / np.sqrt(np.square(np.abs(there)).sum(axis=0))
        good = (sizes[0] < CORRECTION_TOL) & (sizes[-1] < CONVERGED)
        moved = going[good]
        z[:, moved], s[moved] = there[:, good], then[good]
        early = moved[1 - s[moved] > NEAR_END]
        before[early], farther[early] = 1 - s[early], np.abs(z[0, early])
        easy = good & (sizes[0] < CORRECTION_TOL / 32)
        step[going] = np.where(easy, 2 * by, np.where(good, by, by / 3))
        going = going[(s[going] < 1) & (step[going] > MIN_STEP)]
        if not len(going):
            break
    done, way = s >= 1, np.maximum(1 - s, np.finfo(float).tiny)
    size = np.abs(z[0])
    exponent = np.log(farther / np.maximum(size, 1e-300)) / np.log(before / way)
    infinite = (done & (size < INFINITY_TOL)) | (
        ~done & (way < NEAR_END**2) & (exponent > MIN_EXPONENT) & (size < math.sqrt(NEAR_END))
    )
    return z, done, infinite


def _mixed(first: Complexes, change: Complexes, s: Floats, z: Complexes) -> Complexes:
    """Return the forms at each path's ``s`` times z: equations, coordinates, paths."""
    return np.asarray(first @ z + s * (change @ z))


def _jacobian(first: Complexes, change: Complexes, z: Complexes, s: Floats) -> Complexes:
    """Return the derivatives, a matrix a path; the last row: steps are at a right angle to z."""
    rows = 2 * _mixed(first, change, s, z)
    return np.concatenate([rows, z.conj()[None]]).transpose(2, 0, 1)


def _solved(matrices: Complexes, right: Complexes) -> Complexes:
    """Return the step of each path (columns); nan where a matrix is singular."""
    sides = np.concatenate([right, np.zeros((1, right.shape[1]))]).T[:, :, None]
    try:
        return np.asarray(np.linalg.solve(matrices, sides)[:, :, 0].T, np.complex128)
    except np.linalg.LinAlgError:
        return np.full((len(right) + 1, right.shape[1]), np.nan, np.complex128)


def _meetings(z: Complexes) -> int:
    """Return how many ends are those of other paths, too."""
    cosines = np.abs(z.conj().T @ z)
    alike = np.triu(1 - cosines < DISTINCT_TOL**2, 1)
    return int(alike.any(axis=0).sum())
