"""Draws from the distribution that all known values define together, over every branch of impacts.

An impact has six velocities before, e, e_m and P_t/P_n, and vehicles. The prior of velocities and
coefficients is flat. Every known value multiplies it by its own density (uniform, triangular,
normal); an exact one is the limit of ever narrower limits. A normal value is cut off at `SIGMAS`
standard deviations where nothing else limits it.

Coordinates: the part of the velocities before and of the impulse that the exact values and the
known coefficients leave undetermined. For given vehicles and coefficients Equations 15, 16 and 18
and exact velocities, courses and changes are linear in these, so that every point is one impact and
no branch is special. The density includes the Jacobian determinant of the change of variables from
impulses to coefficients.

The sampler is sequential Monte Carlo (Del Moral, Doucet and Jasra, *Sequential Monte Carlo
Samplers*, 2006): from wide proposals about every impact found, through ever harder limits, to the
distribution itself. Particles move by differential evolution Markov chains (ter Braak, 2006) in two
halves."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...collision.geometry import GEOMETRY, Geometry
from ...collision.uncertain import Uncertain
from ...mechanics.state import BARRIER_SPEEDS, COURSES, CRUSH, DIRECTIONS, ENERGIES, SPEEDS, State
from ...names import COEFFICIENTS, IMPULSES, PIVOT, VELOCITIES
from .adjustment import Reconstruction
from .system import COMPLEX_STEP, System
from .unknowns import TIE

Floats = NDArray[np.float64]
Array = NDArray[Any]
Flags = NDArray[np.bool_]
Progress = Callable[[int], object]

# The sampler
PARTICLES = 8000
PROPOSAL_FACTOR = 12  # proposals per particle, so that thin parts of the distribution are found
MOVES_PER_STAGE = 8  # moves of every particle after each hardening of the limits
# Moves before the first draws are taken. With 24, the rarer of two branches is 5 % too rare.
BURN_IN_MOVES = 60
THINNING = 6  # moves between one set of draws and the next
MAX_STAGES = 80  # hardenings of the limits; if these do not suffice, no impact lies within limits
MIN_EFFECTIVE = 0.5  # fraction of particles that stay effective from stage to stage
MAX_HARDNESS = 40.0  # logarithm of the hardness where limits count as hard
# Probability of a step by the full difference of two particles, which leads to another branch
JUMP_PROBABILITY = 0.1
_GRID = 1e-7  # grid of coordinates, relative to the spread of the proposals
_CHUNK = 1 << 13  # impacts at a time, bounds the memory

# The proposals: Student's t about every impact found
PROPOSAL_WIDTH = 3.0  # relative to first-order standard deviations
DEGREES_OF_FREEDOM = 4.0
# Width of the broad proposals, which find other branches, in largest known speeds
BROAD_WIDTH = 1.5
BROAD_FRACTION = 0.4  # fraction of particles drawn from these

# Limits
SIGMAS = 3.0  # cut-off of unbounded normal values in standard deviations, for draws and bounds
# The flat prior ends at these two limits, or the distribution could not be normalized where the
# known values leave something open. There results depend on them.
MAX_VELOCITY = 20.0  # largest velocity before the impact, in largest known speeds
MAX_COEFFICIENT = 20.0  # largest magnitude of an unknown coefficient
LIMIT_TOL = 1e-9  # a value beyond a limit by less, in half-widths, is at it
BEYOND_DRAWS = 2.0  # bounds are searched for up to this many ranges of the draws beyond them
STANDSTILL_STEPS = 25  # Newton steps to a speed of 0
STANDSTILL_TOL = 1e-9  # relative to a typical speed

# Rank decisions
RANK_TOL = 1e-10  # singular values below, relative to the largest, count as zero
# Least ratio of the smallest singular value to the largest, of a Jacobian with columns of length 1,
# where everything is determined
DETERMINED_TOL = 1e-9
# Points tried for this test, each at half the distance from the solution, until the quadratic
# condition has a solution
MAX_NEIGHBOURS = 12

# Quantities one of which may be an exact condition: along a line its equation is quadratic
QUADRATIC = (*SPEEDS, "DVA", "DVB", *ENERGIES)


class Posterior:
    """The distribution of the impacts that agree with what is known.

    ``supported``: True if the exact values are linear conditions, except one at most, the
    ``quadratic`` one. Its equation is quadratic along the last coordinate, which is solved for; the
    magnitude of a point's sign, 1 or 2, says which root the point has. ``determined``: True if
    exact values and values within limits determine impacts in general, though perhaps not the
    solution (without an impulse, say, coefficients are undetermined)."""

    def __init__(self, solution: Reconstruction, progress: Progress = lambda impacts: None) -> None:
        self.progress, self.is_level = progress, False
        self.system = system = solution.system
        self.known = system.known
        self.unsigned = solution.typed_mu is not None
        self.first_sign = 1.0 if solution.typed_mu == self._mup() else -1.0
        self.nominal = solution.values
        varying = [n for n in self.known if self.known[n].varies]
        self.unknown = [n for n in system.variables if n in (*VELOCITIES, *IMPULSES)]
        scales = dict(zip(system.variables, system.scales, strict=True))
        self.scales = np.array([scales[n] for n in self.unknown])
        laws = [n for n in COEFFICIENTS if not (system.point and n == "EM")]
        self.laws, self.open = laws, [n for n in laws if n not in self.known]
        self.exact = [n for n in system.exact if n not in varying and n not in CRUSH]
        speeds_with_course = [speed for course, speed in COURSES.items() if course in self.exact]
        nonlinear = [n for n in self.exact if n in QUADRATIC and n not in speeds_with_course]
        self.quadratic = nonlinear[0] if nonlinear else None
        self.exact = [n for n in self.exact if n != self.quadratic]
        # friction as a fraction of each impact's own critical one is no linear condition
        self.supported = len(nonlinear) <= 1 and "MUC" not in system.constants
        crush = [n for n in CRUSH if n in self.known]
        self.crush: list[str] = sorted(crush, key=lambda n: self.known[n].varies, reverse=True)
        self.supported &= not crush or (bool(self.crush) and self.known[self.crush[0]].varies)
        inputs = (*GEOMETRY, *COEFFICIENTS, *self.crush[1:])
        self.inputs = [n for n in varying if n in inputs]
        self.measured = [
            n for n in system.observations if n not in (*inputs, *CRUSH) and n in varying
        ]
        self.items = {
            n: self._with_limits(n) for n in (*self.inputs, *self.measured, *self.crush[:1])
        }
        self.varied = bool(set(self.inputs) & {*GEOMETRY})
        self.geometry = None if self.varied else Geometry(system.constants)
        self.determined = False
        self.implied: list[str] = []
        if self.supported:
            self._choose_coordinates(solution)

    def _with_limits(self, name: str) -> Uncertain:
        """Return the known value with both limits, unbounded ones at `SIGMAS` standard
        deviations."""
        item = self.known[name]
        low, high = item.limits(SIGMAS)
        return Uncertain(item.kind, item.nominal, low, high, item.deviation)

    def _choose_coordinates(self, solution: Reconstruction) -> None:
        """Choose the coordinates: an orthonormal basis of what the exact conditions leave
        undetermined at the solutions. Set ``centers`` and ``signs`` of all solutions in these
        coordinates."""
        self.centers: list[Floats] = []
        self.signs: list[float] = []
        starts: Sequence[tuple[System, Floats]] = solution.beside or ((self.system, solution.x),)
        ys, parameters = [], []
        for system, x in starts:
            state = system.state(x)
            ys.append([float(np.ravel(np.real(state.values[n]))[0]) for n in self.unknown])
            sign = 1.0 if system.nominal.get("MUP", 1.0) == self._mup() else -1.0
            values = {n: float(np.ravel(np.real(state.values[n]))[0]) for n in self.inputs}
            parameters.append([sign * v if n == "MUP" else v for n, v in values.items()])
            self.signs.append(sign)
        first_inputs = np.array(parameters[0])[:, None]
        rows, _, _, _ = self._conditions(first_inputs, np.array([self.signs[0]]))
        # a course along an axis is no condition where the other component is known
        lengths = np.linalg.norm(rows[:, :, 0], axis=1)
        independent = lengths > RANK_TOL * lengths.max(initial=0.0)
        self.implied = [
            name
            for name, is_independent in zip(
                self.exact, independent[len(rows) - len(self.exact) :], strict=True
            )
            if not is_independent
        ]
        self.exact = [name for name in self.exact if name not in self.implied]
        matrix = rows[independent, :, 0]
        norm = np.linalg.norm(matrix, axis=1, keepdims=True)
        matrix = matrix / np.where(norm > 0, norm, 1.0)
        _, s, vt = np.linalg.svd(matrix)
        rank = int((s > RANK_TOL * s.max(initial=0.0)).sum())
        self.basis = _unique_basis(vt[rank:])
        self.supported &= rank == len(matrix)
        if self.quadratic is not None and self.supported and len(self.basis):
            self._rotate_basis(ys[0], parameters[0])
        self.free = len(self.basis) - (self.quadratic is not None)
        self.size = self.free + len(self.inputs)
        self.supported &= self.free >= 0
        for i, (y, inputs) in enumerate(zip(ys, parameters, strict=True)):
            z = self.basis @ (np.array(y) / self.scales)
            if self.quadratic is not None and self.supported:
                # the nearer of the two roots
                roots = self.signs[i] * np.array([1.0, 2.0])
                both_roots = np.tile(np.concatenate([z[:-1], inputs])[:, None], 2)
                solved, _ = self._solve_last_coordinate(
                    both_roots[: self.free], both_roots[self.free :], roots
                )
                distances = np.abs(np.real(solved[-1]) - z[-1])
                self.signs[i] = float(roots[int(np.nan_to_num(distances, nan=np.inf).argmin())])
            self.centers.append(np.concatenate([z[: self.free], inputs]))
        self.determined = self.supported and self.size > 0 and self._is_determined()

    # -- one exact value that is no linear condition

    def _quadratic_residual(self, y: Array, inputs: Array) -> Array:
        """Return the scaled residual of the quadratic condition at scaled unknowns."""
        name = self.quadratic
        assert name is not None
        values = self._values(inputs)
        geometry = Geometry(values) if self.varied else self.geometry
        scaled = dict(zip(self.unknown, y * self.scales[:, None], strict=True))
        state, target = State({**values, **scaled}, geometry), self.known[name].nominal
        if name in ("LOSS", "DT"):
            fraction = target / (100.0 if name == "LOSS" else 1.0)
            residual = state.energy_lost - fraction * state.initial_energy
            return np.asarray(residual / self.system.scale("EL"))
        if name in ENERGIES:
            return np.asarray((state[name] - target) / self.system.scale("EL"))
        along, across = (
            (state[n] for n in SPEEDS[name]) if name in SPEEDS else state.change(name[2])
        )
        residual = along * along + across * across - target * target
        return np.asarray(residual / self.system.scale(name) ** 2)

    def _rotate_basis(self, y: Sequence[float], inputs: Sequence[float]) -> None:
        """Rotate the basis so that the quadratic condition changes fastest along its last
        direction, at the solution."""
        offset_points = (np.array(y) / self.scales)[:, None] + 1j * COMPLEX_STEP * self.basis.T
        repeated_inputs = np.repeat(np.array(inputs, float)[:, None], len(self.basis), axis=1)
        slope = np.imag(self._quadratic_residual(offset_points, repeated_inputs)) / COMPLEX_STEP
        slope_size = np.linalg.norm(slope)
        direction = slope / slope_size if slope_size > 0 else np.eye(len(slope))[-1]
        orthogonal = _unique_basis_across(direction)
        self.basis = np.concatenate([orthogonal, direction[None]]) @ self.basis

    def _solve_last_coordinate(self, z: Array, inputs: Array, signs: Array) -> tuple[Array, Array]:
        """Return all coordinates of points, the last one solved from the quadratic condition, and
        the discriminant (negative where there is no solution).

        The residual a t² + b t + c is found from its values at t = -1, 0 and 1."""
        friction, takes_upper = np.sign(signs), np.abs(signs) < 1.5
        rows, right, _, _ = self._conditions(inputs, friction)
        count = z.shape[1]
        basis = np.broadcast_to(self.basis[:, :, None], (*self.basis.shape, count))
        matrix = np.concatenate([rows, basis]).transpose(2, 0, 1)
        residuals = [
            self._quadratic_residual(
                _solve_each(matrix, np.concatenate([right, z, np.full((1, count), t)]).T).T, inputs
            )
            for t in (-1.0, 0.0, 1.0)
        ]
        c, b, a = (
            residuals[1],
            (residuals[2] - residuals[0]) / 2,
            (residuals[2] + residuals[0]) / 2 - residuals[1],
        )
        discriminant = b * b - 4 * a * c
        root = np.sqrt(np.where(np.real(discriminant) >= 0, discriminant, np.nan))
        root = np.where(takes_upper, root, -root)
        # the form without cancellation
        is_stable = np.real(b) * np.real(root) <= 0
        last = np.where(is_stable, (root - b) / (2 * a), -2 * c / (b + root))
        return np.concatenate([z, last[None]]), discriminant

    def _is_determined(self) -> bool:
        """Return True if the values within limits distinguish any two neighbours of an ordinary
        impact, one at a random distance from the solution: their Jacobian has full column rank."""
        rng = np.random.default_rng(0)
        deviations = [self.known[n].standard_deviation for n in self.inputs]
        spreads = np.concatenate([np.full(self.free, BROAD_WIDTH), deviations])
        for _ in range(1 if self.quadratic is None else MAX_NEIGHBOURS):
            point = self.centers[0] + spreads * rng.standard_normal(self.size)
            slopes = self._slopes(point, self.signs[0])
            if np.abs(slopes).sum(axis=0).all():
                break
            spreads = spreads / 2  # the quadratic condition has no solution there
        sizes = np.linalg.norm(slopes, axis=0)
        if not (sizes > 0).all():
            return False
        values = np.linalg.svd(slopes / sizes, compute_uv=False)
        return len(values) == self.size and bool(values[-1] > DETERMINED_TOL * values[0])

    def _mup(self) -> float:
        return float(self.known["MUP"].nominal) if "MUP" in self.known else 1.0

    # -- impacts

    def _values(self, inputs: Array) -> dict[str, Any]:
        """Return constants and the values of the inputs."""
        return {**self.system.constants, **dict(zip(self.inputs, inputs, strict=True))}

    def _coefficient(self, name: str, values: Mapping[str, Any], signs: Array) -> Any:
        """Return a known coefficient; P_t/P_n with the sign of each point if only its size is
        known."""
        return values[name] * signs if name == "MUP" and self.unsigned else values[name]

    def _conditions(self, inputs: Array, signs: Array) -> tuple[Array, Array, Array, Array]:
        """Return the linear conditions of n points as (matrix, right side, numerators,
        denominators).

        Matrix: coefficients over the scaled unknowns (rows, unknowns, n). Right side: (rows, n).
        Numerators and denominators of the coefficients: over the unknowns and a constant (laws,
        unknowns + 1, n)."""
        size, count = len(self.unknown), inputs.shape[1] if len(inputs) else len(signs)
        values = self._values(inputs)
        geometry = Geometry(values) if self.varied else self.geometry
        unit_vectors = np.eye(size + 1, size)[:, :, None] * self.scales[None, :, None]
        state = State(
            {**values, **dict(zip(self.unknown, unit_vectors.swapaxes(0, 1), strict=True))},
            geometry,
        )

        def coefficients(row: Any) -> Array:
            """Return the coefficients of a quantity over the unknowns, then its constant, from its
            values at unit vectors and at 0."""
            wide = np.broadcast_to(row, (size + 1, count))
            return np.concatenate([wide[:size] - wide[size:], wide[size:]])

        numerators, denominators = [], []
        for name in self.laws:
            if name == "MUP" and self._mup() == PIVOT and name in self.known:
                parts = state.relative_after[1], 0.0 * state.relative_after[1]
            else:
                parts = state.quotient(name)
            numerators.append(coefficients(parts[0]))
            denominators.append(coefficients(parts[1]))
        rows = []
        for name, numerator, denominator in zip(self.laws, numerators, denominators, strict=True):
            if name in self.known:
                rows.append(numerator - self._coefficient(name, values, signs) * denominator)
        for name in self.exact:
            target = self.known[name].nominal
            if name in DIRECTIONS:
                rows.append(coefficients(state.along_and_across(name)[1]))
            elif name in SPEEDS:
                course = next(c for c, speed in COURSES.items() if speed == name)
                rows.append(coefficients(state.along_and_across(course)[0] - target))
            else:
                rows.append(coefficients(state[name] - target))
        nothing = np.empty((0, size, count)), np.empty((0, count))
        matrix, right_side = (
            (np.stack([r[:size] for r in rows]), -np.stack([r[size] for r in rows]))
            if rows
            else nothing
        )
        return (
            matrix,
            right_side,
            np.stack(numerators),
            np.stack(denominators),
        )

    def impacts(
        self, points: Array, signs: Array, with_volume: bool = True
    ) -> tuple[State, Array, Array]:
        """Return the impacts at points (coordinates, n), the log Jacobian determinant there if
        ``with_volume``, and True for each that agrees with exact courses and with the sign of
        friction."""
        z, inputs = points[: self.free], points[self.free :]
        discriminant: Any = 1.0
        if self.quadratic is not None:
            z, discriminant = self._solve_last_coordinate(z, inputs, signs)
        signs = np.sign(signs)
        rows, right_side, numerators, denominators = self._conditions(inputs, signs)
        count = points.shape[1]
        self.progress(count)
        basis = np.broadcast_to(self.basis[:, :, None], (*self.basis.shape, count))
        matrix = np.concatenate([rows, basis]).transpose(2, 0, 1)
        y = _solve_each(matrix, np.concatenate([right_side, z]).T).T
        values = self._values(inputs)
        geometry = Geometry(values) if self.varied else self.geometry
        scaled = dict(zip(self.unknown, y * self.scales[:, None], strict=True))
        state = State({**values, **scaled}, geometry)
        volume = (
            self._volume(matrix, y, numerators, denominators, values, signs)
            if with_volume
            else np.zeros(1)
        )
        if self.quadratic in ("LOSS", "DT"):
            volume = volume + np.log(np.abs(state.initial_energy))
        volume = volume - 0.5 * np.log(np.abs(discriminant))
        agrees = np.ones(count, bool)
        for name in (*self.exact, *self.implied):
            if name in DIRECTIONS:
                size = np.real(state.along_and_across(name)[0])
                agrees &= size > 0
                if with_volume and name not in self.implied:
                    volume = volume + np.log(np.abs(size))
        if self.unsigned:
            speeds = np.max([np.abs(np.real(v)) * np.ones(count) for v in state.before], axis=0)
            sliding_positive = np.real(state.relative_before[1]) > TIE * speeds  # line 400
            agrees &= np.where(sliding_positive, -self.first_sign, self.first_sign) == signs
        return state, volume, agrees

    def _volume(
        self,
        matrix: Array,
        y: Array,
        numerators: Array,
        denominators: Array,
        values: Mapping[str, Any],
        signs: Array,
    ) -> Array:
        """Return the log Jacobian determinant of the map from coordinates to velocities before and
        coefficients: with the laws L, the impulse P, the conditions R, the unknowns y and the
        denominators of unknown coefficients c, |dL/dP| / (|dR/dy| times the product of all
        |dL/dc|)."""
        impulse_rows = [i for i, name in enumerate(self.unknown) if name in IMPULSES]
        unknowns = np.concatenate([y, np.ones((1, y.shape[1]))])
        numerator_values, denominator_values = (
            np.einsum("run,un->rn", part, unknowns) for part in (numerators, denominators)
        )
        volume, rows = -np.linalg.slogdet(matrix)[1], []
        for i, name in enumerate(self.laws):
            if name in self.open:
                coefficient = numerator_values[i] / denominator_values[i]
                volume = volume - np.log(np.abs(denominator_values[i]))
            else:
                coefficient = self._coefficient(name, values, signs)
            rows.append(numerators[i][impulse_rows] - coefficient * denominators[i][impulse_rows])
        return np.asarray(volume + np.linalg.slogdet(np.array(rows).transpose(2, 0, 1))[1])

    def _value(self, state: State, name: str) -> Any:
        """Return a quantity of impacts, or a known value; directions near the nominal one."""
        is_input = name in self.known and name in (*GEOMETRY, *COEFFICIENTS, *CRUSH)
        return _unwrap(
            name, state.values[name] if is_input else state[name], self.nominal.get(name)
        )

    def values(self, points: Floats, signs: Floats, names: Sequence[str]) -> Floats:
        """Return quantities (rows) of the impacts at points."""
        rows = []
        for first in range(0, points.shape[1], _CHUNK):
            part = slice(first, first + _CHUNK)
            state, _, _ = self.impacts(points[:, part], signs[part])
            count = points[:, part].shape[1]
            rows.append([np.broadcast_to(self._value(state, n), count) for n in names])
        return np.concatenate([np.array(part).reshape(len(names), -1) for part in rows], axis=1)

    def logarithms(self, points: Floats, signs: Floats) -> tuple[Floats, Floats]:
        """Return the log density at points, limits aside, and the excess beyond limits: the sum of
        squares of the distances beyond each, in half-widths."""
        state, density, agrees = self.impacts(points, signs)
        density = np.where(agrees, density, -np.inf)
        excess = np.zeros(points.shape[1])
        for name, item in self.items.items():
            value, own_volume = self._limited_value(state, name)
            density = density + own_volume
            middle, half = (item.low + item.high) / 2, (item.high - item.low) / 2
            overshoot = np.maximum(np.abs(value - middle) / half - 1, 0.0)
            overshoot = np.where(overshoot > LIMIT_TOL, overshoot, 0.0)
            excess += overshoot * overshoot
            if item.kind != "uniform":
                inside = np.clip(value, item.low + LIMIT_TOL * half, item.high - LIMIT_TOL * half)
                density = density + item.log_density(inside)
        for name in self.open:
            above, below = state.quotient(name)
            overshoot = np.abs(above / below) / MAX_COEFFICIENT - 1
            excess = excess + np.square(np.maximum(overshoot, 0.0))
        for name, value in zip(VELOCITIES, state.before, strict=True):
            overshoot = np.abs(value) / (MAX_VELOCITY * self.system.scale(name)) - 1
            excess = excess + np.square(np.maximum(overshoot, 0.0))
        is_finite = np.isfinite(density) & np.isfinite(excess)
        if self.is_level:
            density = np.zeros_like(density)
        return np.where(is_finite, density, -np.inf), np.where(is_finite, excess, np.inf)

    def _logarithms_by_parts(self, points: Floats, signs: Floats) -> tuple[Floats, Floats]:
        """Return the same as `logarithms`, computed in blocks that bound the memory."""
        parts = [slice(i, i + _CHUNK) for i in range(0, points.shape[1], _CHUNK)]
        rows = [self.logarithms(points[:, part], signs[part]) for part in parts]
        return np.concatenate([row[0] for row in rows]), np.concatenate([row[1] for row in rows])

    def _limited_value(self, state: State, name: str) -> tuple[Any, Any]:
        """Return a value that is known within limits, and the log of the volume its own scale adds
        to the density."""
        if name in self.inputs:
            return state.values[name], 0.0
        if name not in self.crush:
            return _unwrap(name, state[name], self.known[name].nominal), 0.0
        other_energies = [state.crush_energy(n[-1]) for n in self.crush[1:]]
        energy = state["EL"] - sum(other_energies)
        if name not in BARRIER_SPEEDS:
            return energy, 0.0
        mass = state.values["M" + name[-1]]
        sign = np.where(np.real(energy) < 0, -1.0, 1.0)
        speed = sign * np.sqrt(2 * sign * energy / mass)
        return speed, -np.log(np.abs(mass * speed))

    # -- sampling

    def sample_level(self, count: int, rng: np.random.Generator) -> tuple[Floats, Floats]:
        """Return points as `sample` does, spread evenly over the coordinates within all limits,
        regardless of their density, so that improbable regions are represented."""
        self.is_level = True
        try:
            return self.sample(count, rng)
        finally:
            self.is_level = False

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Floats, Floats]:
        """Return ``count`` random points of the distribution (coordinates, n) and their friction
        signs; empty where no impact was found within all limits."""
        no_points = np.empty((self.size, 0)), np.empty(0)
        particles = min(PARTICLES, max(count, 4 * self.size, 200)) // 2 * 2
        try:
            with np.errstate(all="ignore"):
                return self._run_sampler(particles, count, rng)
        except np.linalg.LinAlgError:
            return no_points

    def _run_sampler(
        self, particles: int, count: int, rng: np.random.Generator
    ) -> tuple[Floats, Floats]:
        """Run sequential Monte Carlo: weight, resample and move particles while limits harden, then
        move them at hard limits and collect draws. Each stage hardens limits so far that the
        fraction `MIN_EFFECTIVE` of particles stays effective, found by bisection."""
        no_points = np.empty((self.size, 0)), np.empty(0)
        points, signs, proposal_density = self._propose(PROPOSAL_FACTOR * particles, rng)
        logs = (*self._logarithms_by_parts(points, signs), proposal_density(points, signs))
        hardness, min_effective = 0.0, MIN_EFFECTIVE * particles
        for _ in range(MAX_STAGES):
            log_density = _temper(logs, hardness)
            final_log_weights = _temper(logs, np.inf) - log_density
            is_last = _effective_size(final_log_weights) >= min_effective
            next_hardness = np.inf
            if not is_last:
                low, high = hardness, hardness + 4.0
                for _ in range(30):
                    middle = (low + high) / 2
                    is_effective = (
                        _effective_size(_temper(logs, middle) - log_density) >= min_effective
                    )
                    low, high = (middle, high) if is_effective else (low, middle)
                next_hardness = low
                if next_hardness > MAX_HARDNESS or not next_hardness > hardness:
                    return no_points
            weights = np.exp(_shift_logarithms(_temper(logs, next_hardness) - log_density))
            survivors = _resample(weights, particles, rng)
            points, signs = points[:, survivors], signs[survivors]
            logs = (logs[0][survivors], logs[1][survivors], logs[2][survivors])
            hardness = next_hardness
            for _ in range(MOVES_PER_STAGE):
                points, signs, logs = self._move(
                    points, signs, logs, hardness, proposal_density, rng
                )
            if is_last:
                break
        else:
            return no_points
        for _ in range(BURN_IN_MOVES):
            points, signs, logs = self._move(points, signs, logs, np.inf, proposal_density, rng)
        parts = [(points, signs)]
        while sum(part.shape[1] for part, _ in parts) < count:
            for _ in range(THINNING):
                points, signs, logs = self._move(points, signs, logs, np.inf, proposal_density, rng)
            parts.append((points, signs))
        draws = np.concatenate([part for part, _ in parts], axis=1)[:, :count]
        return draws, np.concatenate([part_signs for _, part_signs in parts])[:count]

    def _propose(self, count: int, rng: np.random.Generator) -> tuple[Floats, Floats, Any]:
        """Return the first particles, their signs and the function that computes the log of their
        density: a mixture of Student's t about every impact found."""
        roots = []
        deviations = np.array([self.known[n].standard_deviation for n in self.inputs])
        # directions that first order hardly determines are as wide as velocities may be
        prior_scale = np.concatenate(
            [np.full(self.free, PROPOSAL_WIDTH / MAX_VELOCITY), 0 * deviations]
        )
        modes = [c for c in zip(self.centers, self.signs, strict=True) if self._is_near(*c)]
        modes = modes or [(self.centers[0], self.signs[0])]
        for center, sign in modes:
            slopes = self._slopes(center, sign)
            sizes = np.linalg.norm(slopes, axis=0)
            sizes = np.where(sizes > 0, sizes, 1.0)
            square = (slopes / sizes).T @ (slopes / sizes) + np.diag(np.square(prior_scale / sizes))
            try:
                # Cholesky's root is the same in any units, up to their factors
                root = np.linalg.cholesky(np.linalg.inv(square))
            except np.linalg.LinAlgError:  # rounding leaves no positive definite matrix
                root = np.diag(1 / np.sqrt(square.diagonal()))
            roots.append(PROPOSAL_WIDTH * root / sizes[:, None])
        # broad components find what is far from all solutions
        broad_root = np.diag(np.concatenate([np.full(self.free, BROAD_WIDTH), deviations]))
        broad_modes = list(modes)
        if self.quadratic is not None:
            broad_modes += [(center, _other_root(sign)) for center, sign in modes]
        roots += [broad_root] * len(broad_modes)
        centers = [center for center, _ in (*modes, *broad_modes)]
        component_signs = [float(sign) for _, sign in (*modes, *broad_modes)]
        fractions = np.repeat(
            [(1 - BROAD_FRACTION) / len(modes), BROAD_FRACTION / len(broad_modes)],
            [len(modes), len(broad_modes)],
        )
        component = rng.choice(len(roots), size=count, p=fractions)
        normal = rng.standard_normal((count, self.size))
        chi_roots = np.sqrt(rng.chisquare(DEGREES_OF_FREEDOM, count) / DEGREES_OF_FREEDOM)
        steps = np.stack(roots)[component] @ (normal / chi_roots[:, None])[:, :, None]
        points = (np.stack(centers)[component] + steps[:, :, 0]).T
        self.grid = _GRID * np.linalg.norm(roots[0], axis=1)[:, None]
        points = self._on_grid(points)
        signs = np.array(component_signs)[component]
        inverses = [np.linalg.inv(root) for root in roots]
        log_heights = [
            np.linalg.slogdet(inverse)[1] + np.log(fraction)
            for inverse, fraction in zip(inverses, fractions, strict=True)
        ]

        def proposal_density(points: Floats, signs: Floats) -> Floats:
            total = np.full(points.shape[1], -np.inf)
            for center, sign, inverse, log_height in zip(
                centers, component_signs, inverses, log_heights, strict=True
            ):
                square = np.square(inverse @ (points - center[:, None])).sum(axis=0)
                power = (
                    -(DEGREES_OF_FREEDOM + self.size) / 2 * np.log1p(square / DEGREES_OF_FREEDOM)
                )
                total = np.logaddexp(total, np.where(signs == sign, power + log_height, -np.inf))
            return total

        return points, signs, proposal_density

    def _is_near(self, center: Floats, sign: float) -> bool:
        """Return whether an impact found has velocities that the distribution may reach: beside a
        coefficient's pole some are endless, and a distribution about them is none."""
        state, _, _ = self.impacts(center[:, None], np.array([sign]), with_volume=False)
        before = zip(VELOCITIES, state.before, strict=True)
        return all(np.all(np.abs(v) <= MAX_VELOCITY * self.system.scale(n)) for n, v in before)

    def _slopes(self, center: Floats, sign: float) -> Floats:
        """Return the derivatives of all values known within limits, in standard deviations, over
        the coordinates."""
        offset_points = center[:, None] + 1j * COMPLEX_STEP * np.eye(self.size)
        state, _, _ = self.impacts(offset_points, np.full(self.size, sign), with_volume=False)
        rows = []
        for name in self.items:
            value = np.broadcast_to(self._limited_value(state, name)[0], self.size)
            rows.append(np.imag(value) / COMPLEX_STEP / self.known[name].standard_deviation)
        return np.asarray(np.nan_to_num(np.array(rows), posinf=0.0, neginf=0.0))

    def _on_grid(self, points: Floats) -> Floats:
        """Return points rounded to a fine grid. Differential evolution multiplies rounding errors:
        without a grid, draws would depend on the system of units."""
        center = self.centers[0][:, None]
        return np.asarray(center + np.round((points - center) / self.grid) * self.grid)

    def _move(
        self,
        points: Floats,
        signs: Floats,
        logs: tuple[Floats, Floats, Floats],
        hardness: float,
        proposal_density: Any,
        rng: np.random.Generator,
    ) -> tuple[Floats, Floats, tuple[Floats, Floats, Floats]]:
        """Return all particles after one step of differential evolution of each half along
        differences of the other half, accepted by the Metropolis rule."""
        points, signs = points.copy(), signs.copy()
        parts = [log.copy() for log in logs]
        half = points.shape[1] // 2
        order = rng.permutation(points.shape[1])
        for moving, partners in ((order[:half], order[half:]), (order[half:], order[:half])):
            first, second = (rng.choice(partners, len(moving)) for _ in range(2))
            length = 2.38 / np.sqrt(2 * self.size) * np.exp(0.5 * rng.standard_normal(len(moving)))
            length = np.where(rng.random(len(moving)) < JUMP_PROBABILITY, 1.0, length)
            deviations = points[:, partners].std(axis=1, keepdims=True)
            noise = 1e-3 * deviations * rng.standard_normal((self.size, len(moving)))
            trial = points[:, moving] + length * (points[:, first] - points[:, second]) + noise
            trial = self._on_grid(trial)
            trial_signs = signs[moving]
            if self.unsigned:
                trial_signs = np.where(
                    rng.random(len(moving)) < JUMP_PROBABILITY, -trial_signs, trial_signs
                )
            if self.quadratic is not None:  # to the equation's other root
                trial_signs = np.where(
                    rng.random(len(moving)) < JUMP_PROBABILITY,
                    _other_root(trial_signs),
                    trial_signs,
                )
            trial_logs = (
                *self.logarithms(trial, trial_signs),
                proposal_density(trial, trial_signs),
            )
            moving_logs = tuple(log[moving] for log in parts)
            gain = _temper(trial_logs, hardness) - _temper(
                (moving_logs[0], moving_logs[1], moving_logs[2]), hardness
            )
            accepted = -rng.standard_exponential(len(moving)) < gain
            accepted_rows = moving[accepted]
            points[:, accepted_rows], signs[accepted_rows] = (
                trial[:, accepted],
                trial_signs[accepted],
            )
            for log, trial_log in zip(parts, trial_logs, strict=True):
                log[accepted_rows] = trial_log[accepted]
        return points, signs, (parts[0], parts[1], parts[2])


class FeasibleRegion:
    """The impacts within all limits, as an `ascent.SearchProblem`.

    Coordinates run from 0 to 1, from limit to limit, or over the range of the draws and
    ``BEYOND_DRAWS`` times as much on either side. The state of a point is the sign of its friction.
    Functions: the quantities ``names``, then the denominators of the unknown coefficients among
    them. Constraints: the values within limits that are no coordinates."""

    def __init__(self, posterior: Posterior, names: Sequence[str], draws: Floats) -> None:
        self.posterior, self.names = posterior, names
        self.ratios = [n for n in names if n in posterior.open]
        free = posterior.free
        low, high = draws[:free].min(axis=1), draws[:free].max(axis=1)
        reach = BEYOND_DRAWS * (high - low)
        limits = [posterior.items[n] for n in posterior.inputs]
        self.low = np.concatenate([low - reach, [item.low for item in limits]])
        self.high = np.concatenate([high + reach, [item.high for item in limits]])
        self.constraints = [n for n in posterior.items if n not in posterior.inputs]

    def fractions(self, points: Floats) -> Floats:
        """Return points (coordinates, n) as coordinates from 0 to 1 (n, coordinates)."""
        return np.asarray(((points - self.low[:, None]) / (self.high - self.low)[:, None]).T)

    def points(self, u: Floats) -> Floats:
        """Return coordinates from 0 to 1 as points (coordinates, n), exact at the upper limits."""
        points = self.low + u * (self.high - self.low)
        return np.asarray(np.where(u < 1, points, self.high).T)

    def _rows(self, state: State, count: int) -> Array:
        """Return functions, then constraints of impacts, real or complex."""
        posterior = self.posterior
        rows = [posterior._value(state, n) for n in self.names]
        rows += [state.quotient(n)[1] for n in self.ratios]
        for name in self.constraints:
            item = posterior.items[name]
            rows.append(
                (posterior._limited_value(state, name)[0] - item.low) / (item.high - item.low)
            )
        return np.array([np.broadcast_to(row, count) for row in rows])

    def evaluate(self, u: Floats, guess: Floats) -> tuple[Floats, Floats, Floats, Flags]:
        """Evaluate points (`ascent.SearchProblem`)."""
        state, _, agrees = self.posterior.impacts(self.points(u), guess[0], with_volume=False)
        rows = self._rows(state, len(u)).T
        count = len(self.names) + len(self.ratios)
        functions, constraints = rows[:, :count], rows[:, count:]
        usable = agrees & np.isfinite(constraints).all(axis=1)
        return guess, functions, np.where(np.isfinite(constraints), constraints, -1e9), usable

    def slopes(self, u: Floats, x: Floats) -> tuple[Floats, Floats, Floats]:
        """Return derivatives (`ascent.SearchProblem`), by complex steps."""
        count, dimensions = u.shape
        width = (self.high - self.low)[:, None, None]
        offsets = 1j * COMPLEX_STEP * width * np.eye(dimensions)[:, :, None]
        points = (self.points(u)[:, None] + offsets).reshape(dimensions, dimensions * count)
        signs = np.tile(x[0], dimensions)
        state, _, _ = self.posterior.impacts(points, signs, with_volume=False)
        rows = np.imag(self._rows(state, dimensions * count)) / COMPLEX_STEP
        rows = np.nan_to_num(rows).reshape(len(rows), dimensions, count).transpose(2, 0, 1)
        function_count = len(self.names) + len(self.ratios)
        return rows[:, :function_count], rows[:, function_count:], np.zeros((count, 1, dimensions))

    def standstill(self, speed: str, u: Floats, signs: Floats) -> Floats:
        """Return points within all limits where a speed is 0, by Gauss-Newton steps from the points
        ``u``. A speed has a kink there, where sequential linear programming does not converge."""
        count, dimensions = u.shape
        width = (self.high - self.low)[:, None, None]
        offsets = 1j * COMPLEX_STEP * width * np.eye(dimensions)[:, :, None]
        typical = self.posterior.system.scale(speed)
        for _ in range(STANDSTILL_STEPS):
            points = (self.points(u)[:, None] + offsets).reshape(dimensions, dimensions * count)
            state, _, _ = self.posterior.impacts(
                points, np.tile(signs, dimensions), with_volume=False
            )
            rows = [np.broadcast_to(state[n] / typical, dimensions * count) for n in SPEEDS[speed]]
            for name in self.constraints:
                item = self.posterior.items[name]
                fraction = (self.posterior._limited_value(state, name)[0] - item.low) / (
                    item.high - item.low
                )
                inside = np.clip(np.real(fraction), 0.0, 1.0)
                is_outside = np.real(fraction) != inside
                rows.append(
                    np.broadcast_to(
                        np.where(is_outside, fraction - inside, 0.0), dimensions * count
                    )
                )
            residuals = np.array(rows).reshape(len(rows), dimensions, count)
            if not np.isfinite(residuals).all():
                return u[:0]
            slopes = (np.imag(residuals) / COMPLEX_STEP).transpose(2, 0, 1)
            steps = np.linalg.pinv(slopes, rcond=1e-9) @ np.real(residuals[:, 0]).T[:, :, None]
            u = np.clip(u - steps[:, :, 0], 0.0, 1.0)
        _, _, constraints, usable = self.evaluate(u, signs[None])
        state, _, _ = self.posterior.impacts(self.points(u), signs, with_volume=False)
        stands_still = (
            np.hypot(*(np.real(state[n]) for n in SPEEDS[speed])) < STANDSTILL_TOL * typical
        )
        inside = (np.abs(constraints - 0.5) <= 0.5 + LIMIT_TOL).all(axis=1)
        return np.asarray(u[stands_still & usable & inside])

    def values(self, u: Floats, sign: float) -> dict[str, float]:
        """Return the values known within limits at one point."""
        posterior = self.posterior
        state, _, _ = posterior.impacts(self.points(u[None]), np.array([sign]), with_volume=False)
        return {
            n: float(np.ravel(posterior._limited_value(state, n)[0])[0]) for n in posterior.items
        }


def _other_root(signs: Any) -> Any:
    """Return signs with the other of the two roots: magnitude 1 for 2, 2 for 1."""
    return np.sign(signs) * (3.0 - np.abs(signs))


def _unique_basis_across(direction: Floats) -> Floats:
    """Return an orthonormal basis of the directions orthogonal to a direction."""
    projector = np.eye(len(direction)) - np.outer(direction, direction)
    return _unique_basis(np.linalg.svd(projector)[2][: len(direction) - 1])


def _solve_each(matrices: Array, right_sides: Array) -> Array:
    """Return the solutions of n systems of equations (n, unknowns), NaN where one is singular."""
    try:
        return np.asarray(np.linalg.solve(matrices, right_sides[:, :, None])[:, :, 0])
    except np.linalg.LinAlgError:
        singular = np.linalg.det(matrices) == 0
        matrices = np.where(singular[:, None, None], np.eye(matrices.shape[1]), matrices)
        solutions = np.linalg.solve(matrices, right_sides[:, :, None])[:, :, 0]
        return np.asarray(np.where(singular[:, None], np.nan, solutions))


def _unique_basis(rows: Floats) -> Floats:
    """Return an orthonormal basis of a space that does not depend on rounding, as the rows of a
    singular value decomposition do: columns of the projector, made orthogonal, the longest
    first."""
    remainder, basis = rows.T @ rows, []
    for _ in rows:
        lengths = np.linalg.norm(remainder, axis=0).round(6)
        vector = remainder[:, int(lengths.argmax())]
        basis.append(vector / np.linalg.norm(vector))
        remainder = remainder - np.outer(basis[-1], basis[-1] @ remainder)
    return np.array(basis).reshape(len(rows), rows.shape[1])


def _temper(logs: tuple[Floats, Floats, Floats], hardness: float) -> Floats:
    """Return the log density with softened limits, from the proposal (hardness 0) to the
    distribution itself (infinite). ``logs``: log density, excess beyond limits, log proposal
    density."""
    density, excess, proposal_density = logs
    if hardness == np.inf:
        return np.where(excess > 0, -np.inf, density)
    if hardness == 0:
        return proposal_density
    weight = -np.expm1(-hardness)
    return np.asarray(
        weight * density + (1 - weight) * proposal_density - np.expm1(hardness) * excess
    )


def _shift_logarithms(logarithms: Floats) -> Floats:
    """Return logarithms less the largest, those that are nan as -inf."""
    clean = np.where(np.isnan(logarithms), -np.inf, logarithms)
    return np.asarray(clean - clean.max(initial=-1e300))


def _effective_size(logarithms: Floats) -> float:
    """Return the effective number of particles with these log weights: (sum w)² / sum w²."""
    weights = np.exp(_shift_logarithms(logarithms))
    total = weights.sum()
    return float(total * total / np.square(weights).sum()) if total > 0 else 0.0


def _resample(weights: Floats, count: int, rng: np.random.Generator) -> NDArray[np.intp]:
    """Return the numbers of ``count`` surviving particles, by systematic resampling."""
    positions = (rng.random() + np.arange(count)) / count
    sums = np.cumsum(weights / weights.sum())
    return np.minimum(np.searchsorted(sums, positions), len(weights) - 1)


def _unwrap(name: str, value: Any, nominal: float | None) -> Any:
    """Return a course or PDOF shifted by full turns to be near the nominal one; other values as
    they are."""
    if name not in DIRECTIONS or nominal is None:
        return value
    return value - 360 * np.round((np.real(value) - nominal) / 360)
