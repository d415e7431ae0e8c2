"""Coordinates of the impacts that meet all exact values of a reconstruction.

An impact is its velocities before and its impulse, the unknowns. For given vehicles Equations 15,
16 and 18 with exact coefficients, and exact velocities, courses and changes along an axis, are
linear in these; what they leave open has an orthonormal basis, and the coordinates are the
components along it, so that every point is one impact. Vehicles that vary are coordinates, too.

Coefficients that are not exact are quotients of these, and the density has a pole where a
denominator vanishes: E's and P_t/P_n's at a closing speed of 0, EM's between its two signs. Other
coordinates of the same impacts have the coefficients themselves, in place of directions of
impulses; there the poles are gone, but velocities known after the impact bend the density. Draws
move over both.

One exact value may be quadratic: a speed, a change of velocity or an energy. It is solved for the
last component. Any further value that is not linear is left to the density (`narrow`).

Points that differ in a choice have different branches: the sign of friction that is known in size
only, and the root of the quadratic equation."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...collision.geometry import GEOMETRY, Geometry
from ...mechanics.closedform.general import opposing
from ...mechanics.closedform.statusbits import RANGES
from ...mechanics.posed import absent_results
from ...mechanics.state import COURSE_OF, COURSES, CRUSH, DIRECTIONS, ENERGIES, SPEEDS, State
from ...names import COEFFICIENTS, IMPULSES, PIVOT, VELOCITIES
from .admissible import LARGEST_FRICTION
from .leastsquares import RANK_TOL
from .solution import Reconstruction
from .system import COMPLEX_STEP, System

Floats = NDArray[np.float64]
Array = NDArray[Any]
Branches = NDArray[np.int64]


OTHER_SIGN = 1  # bit of a branch: friction with the sign opposite to the first impact's
OTHER_ROOT = 2  # bit of a branch: the lower root of the quadratic equation

# Exact values one of which may be a quadratic condition
QUADRATIC = (*SPEEDS, "DVA", "DVB", *ENERGIES)


def friction_signs(branches: Branches) -> Floats:
    """Return the sign of friction on each branch, relative to the first impact's."""
    return np.where(branches & OTHER_SIGN, -1.0, 1.0)


@dataclass(frozen=True)
class _Conditions:
    """Linear conditions of points: ``matrix`` (rows, unknowns, points) times the scaled unknowns is
    ``right`` (rows, points)."""

    matrix: Array
    right: Array


class Coordinates:
    """The coordinates of one reconstruction.

    ``unknown``: names of the unknowns; ``exact_laws``: coefficients known exactly, ``linear``:
    other linear exact values, ``quadratic``: the quadratic one or None, ``narrow``: exact values
    that are left to the density; ``inputs``: vehicles and energies of one vehicle that vary.
    ``coefficients``: those that are the first coordinates, of those asked for, and ``directions``
    (rows) of unknowns they stand for; none where impulses do not decide them. ``usable``: False
    where the conditions have no solution. ``free``: number of components, with the coefficients;
    ``size``: of coordinates. ``centers`` and ``branches``: all impacts found."""

    def __init__(self, solution: Reconstruction, coefficients: Sequence[str] = ()) -> None:
        self.system = system = solution.system
        self.known = known = system.known
        self.unknown = [n for n in system.variables if n in (*VELOCITIES, *IMPULSES)]
        scales = dict(zip(system.variables, system.scales, strict=True))
        self.scales = np.array([scales[n] for n in self.unknown])
        absent = absent_results(known)
        self.laws = [
            n for n in COEFFICIENTS if n not in absent and not (system.point and n == "EM")
        ]
        is_share = "MUC" in system.constants
        self.exact_laws = [
            n
            for n in self.laws
            if n in known and not known[n].varies and not (n == "MUP" and is_share)
        ]
        crush = [n for n in CRUSH if n in known]
        self.crush = sorted(crush, key=lambda n: known[n].varies, reverse=True)
        varying = [n for n in known if known[n].varies]
        self.inputs = [n for n in varying if n in (*GEOMETRY, *self.crush[1:])]
        # coefficients that vary follow from each impact's velocities
        self.constants = {
            n: v
            for n, v in system.constants.items()
            if n not in COEFFICIENTS or n in self.exact_laws
        }
        self.varied = bool(set(self.inputs) & {*GEOMETRY})
        self.geometry = None if self.varied else Geometry(self.constants)
        self.unsigned = solution.typed_mu is not None
        self.has_sign_branches = self.unsigned and "MUP" in self.exact_laws
        self.first_sign = 1.0 if solution.typed_mu in (None, known_friction(system)) else -1.0
        exact = [n for n in system.exact if n not in varying and n not in CRUSH]
        with_course = [speed for course, speed in COURSES.items() if course in exact]
        curved = [n for n in exact if n in QUADRATIC and n not in with_course]
        self.quadratic = curved[0] if curved else None
        self.narrow = [*curved[1:], *(n for n in self.crush[:1] if not known[n].varies)]
        if is_share and not known["MUP"].varies:
            self.narrow.append("MUP")
        self.linear = [n for n in exact if n not in curved]
        # one that is left to the density is a condition, not a direction to move along
        self.open_laws = [n for n in self.laws if n not in (*self.exact_laws, *self.narrow)]
        self.implied: list[str] = []
        self.coefficients: list[str] = []
        self.directions = np.empty((0, len(self.unknown)))
        self.pinned = np.empty((0, len(self.unknown)))
        self.pins = np.empty(0)
        self._find_basis(solution, [n for n in coefficients if n in self.open_laws])

    def _find_basis(self, solution: Reconstruction, coefficients: list[str]) -> None:
        """Find the basis, and the coordinates of all impacts found."""
        impacts: Sequence[tuple[System, Floats]] = solution.beside or ((self.system, solution.x),)
        unknowns, inputs, signs = [], [], []
        for system, x in impacts:
            values = system.state(x).values
            unknowns.append([_number(values[n]) for n in self.unknown] / self.scales)
            inputs.append(np.array([_number(values[n]) for n in self.inputs]))
            same_sign = known_friction(system) == known_friction(self.system)
            signs.append(0 if same_sign or not self.has_sign_branches else OTHER_SIGN)
        self._drop_implied(inputs[0])
        rows = self._conditions(inputs[0][:, None], np.array([signs[0]])).matrix[:, :, 0]
        norm = np.linalg.norm(rows, axis=1, keepdims=True)
        _, s, vt = np.linalg.svd(rows / np.where(norm > 0, norm, 1.0))
        rank = int((s > RANK_TOL * s.max(initial=0.0)).sum())
        self.usable = rank == len(rows)
        self.basis = unique_basis(vt[rank:])
        if coefficients:
            self._take_coefficients_out(coefficients, unknowns[0], inputs[0])
        if self.quadratic is not None and len(self.basis):
            self._turn_last_component_along_slope(unknowns[0], inputs[0])
        self.free = len(self.basis) - (self.quadratic is not None) + len(self.coefficients)
        self.size = self.free + len(self.inputs)
        self.usable &= self.free >= 0
        self.centers: list[Floats] = []
        self.branches: list[int] = []
        for y, own_inputs, sign in zip(unknowns, inputs, signs, strict=True):
            points, branches = self._points(y[:, None], own_inputs[:, None], np.array([sign]))
            self.centers.append(points[:, 0])
            self.branches.append(int(branches[0]))

    def _take_coefficients_out(self, names: list[str], y: Floats, inputs: Floats) -> None:
        """Make the directions in which impulses change these laws most ``directions``, and the
        basis that of the others."""
        self.coefficients, count = names, len(names)
        values = self._coefficients_of(y[:, None], inputs[:, None])[:, 0]
        values = np.array([_within_range(*item) for item in zip(names, values, strict=True)])
        above, below = self._quotients(inputs[:, None])
        rows = (above - values[:, None, None] * below)[:, :-1, 0]
        is_impulse = np.array([n in IMPULSES for n in self.unknown])
        _, sizes, vt = np.linalg.svd((rows * is_impulse) @ self.basis.T)
        if count <= len(sizes) and sizes[-1] > RANK_TOL * np.abs(rows).max():
            self.directions = vt[:count] @ self.basis
            self.basis = unique_basis(vt[count:]) @ self.basis
            return
        self.coefficients = []

    def _coefficients_of(self, y: Floats, inputs: Floats) -> Floats:
        """Return the coefficients (rows) of impacts."""
        state, rows = self._state(y, inputs), []
        for name in self.coefficients:
            above, below = state.quotient(name)
            rows.append(above / np.where(below == 0, 1e-300, below))
        return np.array(rows).reshape(len(rows), y.shape[1])

    def _points(self, y: Floats, inputs: Floats, signs: Branches) -> tuple[Floats, Branches]:
        """Return the points and branches of impacts with these scaled unknowns."""
        z = np.concatenate([self._coefficients_of(y, inputs), self.basis @ y])
        points = np.concatenate([z[: self.free], inputs])
        if self.quadratic is None or not self.usable:
            return points, signs
        roots = np.array([0, OTHER_ROOT])
        last = np.array(
            [np.real(self._last_component(z[: self.free], inputs, signs | r)[0]) for r in roots]
        )
        nearest = np.nan_to_num(np.abs(last - z[-1]), nan=np.inf).argmin(axis=0)
        return points, signs | roots[nearest]

    def points_of(self, state: State, branches: Branches) -> tuple[Floats, Branches]:
        """Return the points and branches of impacts with friction's sign as on ``branches``."""
        y, inputs = (
            np.array([np.broadcast_to(state.values[n], len(branches)) for n in names])
            for names in (self.unknown, self.inputs)
        )
        inputs = inputs.reshape(len(self.inputs), len(branches))
        return self._points(y / self.scales[:, None], inputs, branches & OTHER_SIGN)

    def _quotients(self, inputs: Array) -> tuple[Array, Array]:
        """Return numerators and denominators of the coefficients as linear functions of the scaled
        unknowns: what each unknown adds, then what stands without (coefficients, unknowns + 1,
        points)."""
        state, size = self._state_at_units(inputs), len(self.unknown) + 1
        parts = []
        for part in zip(*(state.quotient(n) for n in self.coefficients), strict=True):
            rows = np.array(np.broadcast_arrays(*part, np.empty((size, 1))))[:-1]
            rows[:, :-1] -= rows[:, -1:]
            parts.append(rows)
        return parts[0], parts[1]

    def _drop_implied(self, inputs: Floats) -> None:
        """Move exact values that follow from those before them from ``linear`` to ``implied``, such
        as a course along an axis where the other component is known."""
        rows = self._conditions(inputs[:, None], np.array([0])).matrix[:, :, 0]
        lengths = np.linalg.norm(rows, axis=1)
        first = len(rows) - len(self.linear)
        chosen, kept = rows[:first], []
        for name, row, length in zip(self.linear, rows[first:], lengths[first:], strict=True):
            is_row = length > RANK_TOL * lengths.max(initial=0.0)
            candidate = np.vstack([chosen, row / length]) if is_row else chosen
            if is_row and np.linalg.matrix_rank(candidate, tol=RANK_TOL) == len(candidate):
                chosen = candidate
                kept.append(name)
        self.implied = [name for name in self.linear if name not in kept]
        self.linear = kept

    def pin(self, directions: Floats) -> None:
        """Take components along these directions (rows, in components) out of the coordinates: they
        keep the values of the first impact."""
        center = self.centers[0][: self.free]
        if self.quadratic is not None:
            directions = np.column_stack([directions, np.zeros(len(directions))])
            center = np.append(center, 0.0)
        self.pinned = directions @ self.basis
        self.pins = directions @ center
        kept = unique_basis(np.linalg.svd(directions)[2][len(directions) :])
        if self.quadratic is not None:  # the last component stays the last
            kept = kept[np.abs(kept[:, -1]) < 0.5]
            kept = np.vstack([kept, np.eye(kept.shape[1])[-1]])
        turned = kept @ self.basis
        old_free, new_free = self.free, len(turned) - (self.quadratic is not None)
        self.centers = [
            np.concatenate([kept[:new_free, :old_free] @ c[:old_free], c[old_free:]])
            for c in self.centers
        ]
        self.basis, self.free = turned, new_free
        self.size = self.free + len(self.inputs)

    # -- conditions

    def values(self, inputs: Array) -> dict[str, Any]:
        """Return constants and the values of the inputs."""
        return {**self.constants, **dict(zip(self.inputs, inputs, strict=True))}

    def _state_at_units(self, inputs: Array) -> State:
        """Return the impacts at a unit of each unknown, then at none (unknowns + 1, points)."""
        size, values = len(self.unknown), self.values(inputs)
        units = np.eye(size + 1, size)[:, :, None] * self.scales[None, :, None]
        unknowns = dict(zip(self.unknown, units.swapaxes(0, 1), strict=True))
        geometry = Geometry(values) if self.varied else self.geometry
        return State({**values, **unknowns}, geometry)

    def _law_parts(self, state: State, name: str) -> tuple[Any, Any]:
        """Return numerator and denominator of a coefficient; of the pivot, its condition and 0."""
        if name in self.exact_laws and name == "MUP" and known_friction(self.system) == PIVOT:
            return state.relative_after[1], 0.0 * state.relative_after[1]
        above, below = state.quotient(name)
        return above, below

    def _conditions(self, inputs: Array, branches: Branches) -> _Conditions:
        """Return the linear conditions of points."""
        count = max(inputs.shape[1] if len(inputs) else 0, len(branches))
        state, rows = self._state_at_units(inputs), []
        for name in self.exact_laws:
            above, below = self._law_parts(state, name)
            value: Any = self.known[name].nominal
            if name == "MUP" and self.has_sign_branches:
                value = value * friction_signs(branches)
            rows.append(above - value * below)
        for name in self.linear:
            target = self.known[name].nominal
            if name in DIRECTIONS:
                rows.append(state.along_and_across(name)[1])
            elif name in SPEEDS:
                rows.append(state.along_and_across(COURSE_OF[name])[0] - target)
            else:
                rows.append(state[name] - target)
        size = len(self.unknown)
        parts = np.array([np.broadcast_to(row, (size + 1, count)) for row in rows])
        parts = parts.reshape(len(rows), size + 1, count)
        matrix, right = parts[:, :size] - parts[:, size:], -parts[:, size]
        pinned = np.broadcast_to(self.pinned[:, :, None], (*self.pinned.shape, count))
        pins = np.broadcast_to(self.pins[:, None], (len(self.pins), count))
        return _Conditions(np.concatenate([matrix, pinned]), np.concatenate([right, pins]))

    def _unknowns(self, z: Array, inputs: Array, branches: Branches) -> tuple[Array, Array]:
        """Return the scaled unknowns with these components, and the log determinant of the map."""
        count = len(self.coefficients)
        if not count:
            return self._along_basis(z, inputs, branches)
        values, rest = z[:count], z[count:]
        start, volume = self._along_basis(np.vstack([0 * values, rest]), inputs, branches)
        # for given vehicles and friction one unknowns' step along each direction serves all points
        one = slice(None) if self.varied or self.has_sign_branches else slice(1)
        aheads = [
            self._along_basis(
                np.vstack([0 * values + unit[:, None], rest])[:, one], inputs[:, one], branches[one]
            )[0]
            for unit in np.eye(count)
        ]
        steps = np.array([ahead - start[:, one] for ahead in aheads])
        # the laws are linear in the unknowns
        above, below = self._quotients(inputs if self.varied else inputs[:, :1])
        at_start = [np.einsum("ckn,kn->cn", p[:, :-1], start) + p[:, -1] for p in (above, below)]
        slopes = [np.einsum("ckn,jkn->ncj", p[:, :-1], steps) for p in (above, below)]
        laws = slopes[0] - values.T[:, :, None] * slopes[1]
        along = solve_each(laws, (values * at_start[1] - at_start[0]).T)
        denominators = at_start[1].T + np.einsum("ncj,nj->nc", slopes[1], along)
        volume = volume + np.log(np.abs(denominators)).sum(axis=1) - np.linalg.slogdet(laws)[1]
        return start + np.einsum("nj,jkn->kn", along, steps), volume

    def _along_basis(self, z: Array, inputs: Array, branches: Branches) -> tuple[Array, Array]:
        """Return the scaled unknowns at components along ``directions`` and the basis, and the
        log determinant of the map."""
        rows = np.vstack([self.directions, self.basis])
        if self.varied:
            conditions = self._conditions(inputs, branches)
            count = z.shape[1]
            basis = np.broadcast_to(rows[:, :, None], (*rows.shape, count))
            matrix = np.concatenate([conditions.matrix, basis]).transpose(2, 0, 1)
            y = solve_each(matrix, np.concatenate([conditions.right, z]).T).T
            return y, -np.linalg.slogdet(matrix)[1]
        y = np.empty((len(self.unknown), z.shape[1]), z.dtype)
        volume = np.empty(z.shape[1])
        for sign in (0, OTHER_SIGN):
            own = (branches & OTHER_SIGN) == sign
            if own.any():
                conditions = self._conditions(np.zeros((len(self.inputs), 1)), np.array([sign]))
                matrix = np.concatenate([conditions.matrix[:, :, 0], rows])
                inverse, count = np.linalg.inv(matrix), len(conditions.right)
                y[:, own] = inverse[:, :count] @ conditions.right + inverse[:, count:] @ z[:, own]
                volume[own] = -np.linalg.slogdet(matrix)[1]
        return y, volume

    # -- the quadratic condition

    def _quadratic_residual(self, y: Array, inputs: Array) -> Array:
        """Return the scaled residual of the quadratic condition at scaled unknowns."""
        name, state = self.quadratic, self._state(y, inputs)
        assert name is not None
        target = self.known[name].nominal
        if name in ("LOSS", "DT"):
            fraction = target / (100.0 if name == "LOSS" else 1.0)
            residual = state.energy_lost - fraction * state.initial_energy
            return np.asarray(residual / self.system.scale("EL"))
        if name in ENERGIES:
            return np.asarray((state[name] - target) / self.system.scale("EL"))
        x, y_part = (state[n] for n in SPEEDS[name]) if name in SPEEDS else state.change(name[2])
        residual = x * x + y_part * y_part - target * target
        return np.asarray(residual / self.system.scale(name) ** 2)

    def _turn_last_component_along_slope(self, y: Floats, inputs: Floats) -> None:
        """Turn the basis so that the quadratic condition changes fastest along its last direction,
        at the first impact."""
        offsets = y[:, None] + 1j * COMPLEX_STEP * self.basis.T
        repeated = np.repeat(inputs[:, None], len(self.basis), axis=1)
        slope = np.imag(self._quadratic_residual(offsets, repeated)) / COMPLEX_STEP
        size = np.linalg.norm(slope)
        direction = slope / size if size > 0 else np.eye(len(slope))[-1]
        projector = np.eye(len(direction)) - np.outer(direction, direction)
        across = unique_basis(np.linalg.svd(projector)[2][: len(direction) - 1])
        self.basis = np.concatenate([across, direction[None]]) @ self.basis

    def _last_component(self, z: Array, inputs: Array, branches: Branches) -> tuple[Array, Array]:
        """Return the last component, solved from the quadratic condition, and the discriminant,
        negative where there is no solution.

        The condition a t² + b t + c is found from its values at t = -1, 0 and 1."""
        behind, here, ahead = (
            self._quadratic_residual(
                self._unknowns(np.concatenate([z, np.full((1, z.shape[1]), t)]), inputs, branches)[
                    0
                ],
                inputs,
            )
            for t in (-1.0, 0.0, 1.0)
        )
        a, b, c = (ahead + behind) / 2 - here, (ahead - behind) / 2, here
        discriminant = b * b - 4 * a * c
        root = np.sqrt(np.where(np.real(discriminant) >= 0, discriminant, np.nan))
        root = np.where(branches & OTHER_ROOT, -root, root)
        # of two forms of the same root, the one in which nothing cancels
        has_no_cancellation = np.real(b) * np.real(root) <= 0
        last = np.where(has_no_cancellation, (root - b) / (2 * a), -2 * c / (b + root))
        return last, discriminant

    # -- impacts

    def _split(self, points: Array) -> tuple[Array, Array]:
        return points[: self.free], points[self.free :]

    def _state(self, y: Array, inputs: Array) -> State:
        values = self.values(inputs)
        unknowns = dict(zip(self.unknown, y * self.scales[:, None], strict=True))
        return State({**values, **unknowns}, Geometry(values) if self.varied else self.geometry)

    def impacts(self, points: Array, branches: Branches) -> tuple[State, Array, Array]:
        """Return the impacts at points (coordinates, n), the log volume of velocities before and
        impulses that a unit of the coordinates is there, and True for each that agrees with exact
        courses and the sign of exact friction."""
        z, inputs = self._split(points)
        volume: Any = 0.0
        if self.quadratic is not None:
            last, discriminant = self._last_component(z, inputs, branches)
            z = np.concatenate([z, last[None]])
            volume = -0.5 * np.log(np.abs(discriminant))
        y, own_volume = self._unknowns(z, inputs, branches)
        state, volume = self._state(y, inputs), volume + own_volume
        if self.quadratic in ("LOSS", "DT"):
            volume = volume + np.log(np.abs(state.initial_energy))
        agrees = np.ones(points.shape[1], bool)
        for name in (*self.linear, *self.implied):
            if name in DIRECTIONS:
                size = np.real(state.along_and_across(name)[0])
                agrees &= size > 0
                if name not in self.implied:
                    volume = volume + np.log(np.abs(size))
        if self.has_sign_branches:
            agrees &= self.sign_by_line_400(state) == friction_signs(branches)
        return state, volume, agrees

    def sign_by_line_400(self, state: State) -> Array:
        """Return the sign, relative to the first impact's, that line 400 gives friction known in
        size."""
        return opposing(self.first_sign, state.sliding)

    def coefficient_volume(self, state: State, points: Array) -> Array:
        """Return the log volume of coefficients that a unit of impulses is at points.

        With numerators N and denominators D of the coefficients c that are not exact, and all laws
        L = N - c D, it is |dL/dP| over the product of the D. Without a contact plane there are no
        coefficients, and the prior is flat over impulses."""
        if not self.laws:
            return np.zeros(points.shape[1])
        _, inputs = self._split(points)
        rows, volume = [], 0.0
        units = State(
            {**self.values(inputs), **self._unit_impulses(points.shape[1])},
            state.here,
        )
        for name in self.laws:
            above, below = self._law_parts(units, name)
            value: Any = None
            if name in self.exact_laws:
                value = self.known[name].nominal
            if value is None:
                numerator, denominator = state.quotient(name)
                value = numerator / denominator
                volume = volume - np.log(np.abs(denominator))
            elif name == "MUP":
                value = state["MUP"] if self.has_sign_branches else value
            rows.append(np.broadcast_to(above - value * below, (len(self.laws), points.shape[1])))
        determinant = np.linalg.slogdet(np.array(rows).transpose(2, 0, 1))[1]
        return np.asarray(volume + determinant)

    def _unit_impulses(self, count: int) -> dict[str, Any]:
        """Return velocities of 0 and a unit of each impulse (impulses, points)."""
        scales = dict(zip(self.unknown, self.scales, strict=True))
        names = [n for n in IMPULSES if n in self.unknown]
        units = np.eye(len(names))[:, :, None] * np.ones(count)
        impulses = {n: unit * scales[n] for n, unit in zip(names, units, strict=True)}
        return {**dict.fromkeys(VELOCITIES, 0.0), **impulses}


def known_friction(system: System) -> float:
    """Return the nominal P_t/P_n of a reading, 1 where friction is not known."""
    return float(system.nominal.get("MUP", 1.0))


def _within_range(name: str, value: float) -> float:
    ends = RANGES.get(name, (-LARGEST_FRICTION, LARGEST_FRICTION))
    return float(np.clip(value, *ends))


def _number(value: Any) -> float:
    return float(np.ravel(np.real(value))[0])


def unique_basis(rows: Floats) -> Floats:
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


def solve_each(matrices: Array, right_sides: Array) -> Array:
    """Return the solutions of n systems of equations (n, unknowns), NaN where one is singular."""
    try:
        return np.asarray(np.linalg.solve(matrices, right_sides[:, :, None])[:, :, 0])
    except np.linalg.LinAlgError:
        singular = np.linalg.det(matrices) == 0
        matrices = np.where(singular[:, None, None], np.eye(matrices.shape[1]), matrices)
        solutions = np.linalg.solve(matrices, right_sides[:, :, None])[:, :, 0]
        return np.asarray(np.where(singular[:, None], np.nan, solutions))
