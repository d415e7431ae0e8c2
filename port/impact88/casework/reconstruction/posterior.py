"""The distribution that all known values define together, over every branch of admissible impacts.

An impact has six velocities before, e, e_m and P_t/P_n, and vehicles. The prior is flat over the
velocities and coefficients of the admissible set (`admissible`). Every known value multiplies it by
its own density (uniform, triangular, normal); an exact one is the limit of ever narrower limits. A
normal value is cut off at `SIGMAS` standard deviations where nothing else limits it.

Points are those of `coordinates`; the density includes the volume of velocities and coefficients
that a unit of coordinates is. Where the known values leave something open, the components that they
do not determine keep the values of the best fit, the density is flat over velocities and impulses,
and only conditions that do not depend on what is open are judged."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...collision.geometry import GEOMETRY
from ...collision.uncertain import Uncertain
from ...mechanics.state import BARRIER_SPEEDS, CRUSH, DIRECTIONS, FORCES, SPEEDS, State
from ...names import COEFFICIENTS, VELOCITIES
from ..optimization.effort import CHUNK
from .admissible import FRICTION, LAWS, LEAST_IMPACT, NORMAL, Admissible, friction_limits, one_sided
from .coordinates import OTHER_ROOT, Branches, Coordinates
from .sampler import Proposal, Sample, sample
from .solution import NULL_TOL, SIGMAS, Reconstruction
from .system import COMPLEX_STEP

Floats = NDArray[np.float64]
Array = NDArray[Any]
Flags = NDArray[np.bool_]
Turned = tuple[Floats, Branches, Floats]
Progress = Callable[[int], object]

MIN_SIZE = 400  # effective draws; with fewer there is no answer

# The proposals
PROPOSAL_WIDTH = 3.0  # relative to first-order standard deviations
# Width of the broad proposals, which find other branches, in largest known speeds
BROAD_WIDTH = 1.5
BROAD_FRACTION = 0.4  # of all proposals

# Limits
# Largest velocity before the impact, in largest known speeds. Draws that reach it are said.
MAX_VELOCITY = 20.0
LIMIT_TOL = 1e-9  # a value beyond a limit by less, in half-widths, is at it
# Standard deviation, relative to its size, of an exact value that is neither linear nor solved for
NARROW = 1e-3
NARROWER = 0.05  # in bounds, in these standard deviations; one draw in 25 is as near

# Points tried for a test of rank, each at half the distance from the solution, until the quadratic
# condition has a solution
MAX_NEIGHBOURS = 12

HALF_TURN = 180.0  # degrees; directions within less form a wedge


class Posterior:
    """The distribution of the admissible impacts that agree with what is known.

    ``items``: values known within limits, by name, with both limits. ``whole``: False where known
    values leave something open. ``is_usable``: False where nothing can be drawn."""

    def __init__(self, solution: Reconstruction, progress: Progress = lambda impacts: None) -> None:
        self.progress = progress
        self.system, self.known = solution.system, solution.system.known
        self.nominal = solution.values
        self.coordinates = here = Coordinates(solution)
        self.admissible = Admissible(self.system)
        varying = [n for n in self.known if self.known[n].varies and n not in CRUSH]
        names = [n for n in varying if n in (*here.inputs, *self.system.observations)]
        names += [n for n in here.crush if n in here.inputs or n == here.crush[0]]
        names += [n for n in here.narrow if n not in names]
        self.items = {n: self._with_limits(n) for n in names}
        self.other: Coordinates | None = None
        self.is_usable, self.whole = here.usable and here.size > 0, True
        if self.is_usable and not self._is_determined():
            self.whole = False
            self._pin_what_is_open(solution)
            self.is_usable = here.size > 0
        elif self.is_usable:
            other = Coordinates(solution, here.open_laws)
            self.other = other if other.coefficients else None

    def _with_limits(self, name: str) -> Uncertain:
        """Return a known value with both limits, unbounded ones at `SIGMAS` standard deviations."""
        item = self.known[name]
        if not item.varies:
            size = abs(item.nominal) or (1.0 if name in COEFFICIENTS else self.system.scale(name))
            item = Uncertain("normal", item.nominal, -np.inf, np.inf, NARROW * size)
        low, high = item.limits(SIGMAS)
        return Uncertain(item.kind, item.nominal, low, high, item.deviation)

    # -- what the known values determine

    def _is_determined(self) -> bool:
        """Return True if the values within limits determine the velocities before the impact.

        Their Jacobian is that of an ordinary impact, at a random distance from the solution.
        Coefficients that they leave open are determined by their range in the admissible set."""
        here, rng = self.coordinates, np.random.default_rng(0)
        deviations = [self.known[n].standard_deviation for n in here.inputs]
        spreads = np.concatenate([np.full(here.free, BROAD_WIDTH), deviations])
        for _ in range(1 if here.quadratic is None else MAX_NEIGHBOURS):
            point = here.centers[0] + spreads * rng.standard_normal(here.size)
            slopes = self._slopes(point, here.branches[0], [*self.items])
            if np.abs(slopes).sum(axis=0).all():
                break
            spreads = spreads / 2  # the quadratic condition has no solution there
        names = [n for n in VELOCITIES if n in here.unknown]
        velocities = self._slopes(point, here.branches[0], names)
        sizes = np.linalg.norm(slopes, axis=0)
        units = np.where(sizes > 0, sizes, 1.0)
        _, values, vt = np.linalg.svd(slopes / units)
        rank = int((values > NULL_TOL * values.max(initial=0.0)).sum())
        open_parts = np.abs((velocities / units) @ vt[rank:].T).max(axis=1, initial=0.0)
        is_open = open_parts > NULL_TOL * np.abs(velocities / units).max(axis=1, initial=0.0)
        return not is_open.any()

    def _pin_what_is_open(self, solution: Reconstruction) -> None:
        """Keep the components that nothing determines at the solution's, and judge by conditions
        alone that do not depend on them."""
        here = self.coordinates
        slopes = self._slopes(here.centers[0], here.branches[0], [*self.items])
        slopes = slopes[:, : here.free]
        sizes = np.linalg.norm(slopes, axis=1, keepdims=True)
        _, s, vt = np.linalg.svd(slopes / np.where(sizes > 0, sizes, 1.0))
        rank = int((s > NULL_TOL * s.max(initial=0.0)).sum())
        directions = vt[rank:]
        rows = []
        for name in self.admissible.rows:
            row = self._at_offsets(
                here.centers[0], here.branches[0], partial(self.admissible.row, name=name)
            )
            rows.append(np.imag(row)[: here.free] / COMPLEX_STEP)
        judged = [
            name
            for name, row in zip(self.admissible.rows, rows, strict=True)
            if np.isfinite(row).all()
            and np.abs(directions @ row).max(initial=0.0) <= NULL_TOL * np.abs(row).max(initial=0.0)
        ]
        self.admissible.limit_to(judged)
        here.pin(directions)

    def _at_offsets(self, point: Floats, branch: int, rows: Callable[[State], Any]) -> Array:
        """Return a function of impacts at a complex step along each coordinate."""
        size = self.coordinates.size
        points = point[:, None] + 1j * COMPLEX_STEP * np.eye(size)
        state, _, _ = self.coordinates.impacts(points, np.full(size, branch))
        return np.broadcast_to(rows(state), size)

    def _slopes(self, center: Floats, branch: int, names: Sequence[str]) -> Floats:
        """Return the derivatives of quantities, in standard deviations of those that are known,
        over the coordinates."""
        rows = []
        for name in names:
            value = self._at_offsets(center, branch, partial(self._limited, name=name))
            unit = self.items[name].standard_deviation if name in self.items else 1.0
            rows.append(np.imag(value) / COMPLEX_STEP / unit)
        slopes = np.array(rows).reshape(len(rows), self.coordinates.size)
        return np.asarray(np.nan_to_num(slopes, posinf=0.0, neginf=0.0))

    # -- impacts

    def value(self, state: State, name: str) -> Any:
        """Return a quantity of impacts, or a known value; directions near the nominal one."""
        if name in self.coordinates.crush[:1]:  # follows from the energy lost and the others'
            return self.limited_value(state, name)[0]
        is_input = name in self.known and name in (*GEOMETRY, *CRUSH)
        value = state.values[name] if is_input else self._quantity(state, name)
        return _unwrapped(name, value, self.nominal.get(name))

    def _quantity(self, state: State, name: str) -> Any:
        if name in self.coordinates.exact_laws:
            value = self.known[name].nominal
            return state[name] if name == "MUP" and self.coordinates.has_sign_branches else value
        return state[name]

    def values(self, points: Floats, branches: Branches, names: Sequence[str]) -> Floats:
        """Return quantities (rows) of the impacts at points."""
        blocks = []
        for first in range(0, points.shape[1], CHUNK):
            part = slice(first, first + CHUNK)
            state, _, _ = self.coordinates.impacts(points[:, part], branches[part])
            count = points[:, part].shape[1]
            blocks.append(np.array([np.broadcast_to(self.value(state, n), count) for n in names]))
        return np.concatenate(
            [block.reshape(len(names), block.shape[-1] if len(names) else 0) for block in blocks],
            axis=1,
        )

    def _limited(self, state: State, name: str) -> Any:
        return self.limited_value(state, name)[0]

    def limited_value(self, state: State, name: str) -> tuple[Any, Any]:
        """Return a value that is known within limits, and the log of the volume its own scale adds
        to the density."""
        here = self.coordinates
        if name in here.inputs:
            return state.values[name], 0.0
        if name == "MUP":
            return self._limited_friction(state)
        if name not in here.crush:
            nominal = self.known[name].nominal if name in self.known else None
            return _unwrapped(name, state[name], nominal), 0.0
        energy = state["EL"] - sum(state.crush_energy(n[-1]) for n in here.crush[1:])
        if name not in BARRIER_SPEEDS:
            return energy, 0.0
        mass = state.values["M" + name[-1]]
        sign = np.where(np.real(energy) < 0, -1.0, 1.0)
        speed = sign * np.sqrt(2 * sign * energy / mass)
        return speed, -np.log(np.abs(mass * speed))

    def _limited_friction(self, state: State) -> tuple[Any, Any]:
        """Return P_t/P_n as it is known: with the sign of line 400, or as a fraction of what ends
        the sliding times the critical friction of the nominal values."""
        value = state["MUP"]
        if "MUC" in self.system.constants:
            critical = state.critical_friction
            return value * self.system.constants["MUC"] / critical, -np.log(np.abs(critical))
        if self.is_sign_open:
            return value * self.coordinates.sign_by_line_400(state), 0.0
        return value, 0.0

    @property
    def is_friction_relative(self) -> bool:
        """True where friction is known as a fraction of the critical one, or in size only."""
        return "MUC" in self.system.constants or self.is_sign_open

    @property
    def is_sign_open(self) -> bool:
        """True where friction is known in size, within limits: line 400 chooses its sign."""
        here = self.coordinates
        return here.unsigned and not here.has_sign_branches and self.whole

    # -- the density (`sampler.Density`)

    def logarithms(self, points: Floats, branches: Branches) -> tuple[Floats, Floats]:
        """Return the log density at points, limits aside, and the excess beyond limits
        (`sampler.Density`)."""
        here = self.coordinates
        self.progress(points.shape[1])
        state, density, agrees = here.impacts(points, branches)
        density = np.broadcast_to(density, points.shape[1])
        if self.whole:
            density = density + here.coefficient_volume(state, points)
        density = np.where(agrees, density, -np.inf)
        excess = np.zeros(points.shape[1])

        def limit(fraction: Any) -> None:
            overshoot = np.maximum(np.abs(2 * fraction - 1) - 1, 0.0)
            overshoot = np.where(overshoot > LIMIT_TOL, overshoot, 0.0)
            np.add(excess, overshoot * overshoot, out=excess)

        for name, item in self.items.items():
            value, own_volume = self.limited_value(state, name)
            density = density + own_volume
            limit((value - item.low) / (item.high - item.low))
            if item.kind != "uniform":
                room = LIMIT_TOL * (item.high - item.low) / 2
                density = density + item.log_density(
                    np.clip(value, item.low + room, item.high - room)
                )
        for name in self.admissible.rows:
            row = self.admissible.row(state, name)
            if name in LAWS:  # hard from the start: impossible impacts may fit far better
                density = np.where(row < 0, -np.inf, density)
            limit(row)
        for name, value in zip(VELOCITIES, state.before, strict=True):
            limit(0.5 + value / (2 * MAX_VELOCITY * self.system.scale(name)))
        is_finite = np.isfinite(density) & np.isfinite(excess)
        return np.where(is_finite, density, -np.inf), np.where(is_finite, excess, np.inf)

    def turned(self, points: Floats, branches: Branches, back: bool = False) -> Turned:
        """Return points over the other coordinates, or ``back`` from these (`sampler.Density`)."""
        here, there = self.coordinates, self.other
        assert there is not None
        if back:
            here, there = there, here
        state, volume, _ = here.impacts(points, branches)
        turned, own_branches = there.points_of(state, branches)
        _, own_volume, _ = there.impacts(turned, own_branches)
        return turned, own_branches, np.broadcast_to(volume - own_volume, len(branches))

    def proposals(self) -> list[Proposal]:
        """Return Student's t about every impact found, and broad ones (`sampler.Density`)."""
        here = self.coordinates
        found = [*zip(here.centers, here.branches, strict=True)]
        modes = [mode for mode in found if self._is_near(*mode)] or found[:1]
        deviations = np.array([self.known[n].standard_deviation for n in here.inputs])
        broad_root = np.diag(np.concatenate([np.full(here.free, BROAD_WIDTH), deviations]))
        at_rest = np.concatenate([np.zeros(here.free), here.centers[0][here.free :]])
        broad_modes = [*modes, *((at_rest, branch) for branch in {branch for _, branch in modes})]
        if here.quadratic is not None:
            broad_modes += [(center, branch ^ OTHER_ROOT) for center, branch in broad_modes]
        narrow = [
            Proposal(*mode, self._root(*mode), (1 - BROAD_FRACTION) / len(modes)) for mode in modes
        ]
        return narrow + [
            Proposal(*mode, broad_root, BROAD_FRACTION / len(broad_modes)) for mode in broad_modes
        ]

    def _root(self, center: Floats, branch: int) -> Floats:
        """Return the root of the covariance of proposals about an impact: of first order, widened;
        directions that first order hardly determines are as wide as velocities may be."""
        here = self.coordinates
        open_ones = [n for n in COEFFICIENTS if n in self.admissible.rows and self.whole]
        slopes = self._slopes(center, branch, [*self.items, *open_ones])
        sizes = np.linalg.norm(slopes, axis=0)
        sizes = np.where(sizes > 0, sizes, 1.0)
        prior = np.concatenate(
            [np.full(here.free, PROPOSAL_WIDTH / MAX_VELOCITY), np.zeros(len(here.inputs))]
        )
        square = (slopes / sizes).T @ (slopes / sizes) + np.diag(np.square(prior / sizes))
        try:
            # Cholesky's root is the same in any units, up to their factors
            root = np.linalg.cholesky(np.linalg.inv(square))
        except np.linalg.LinAlgError:  # rounding leaves no positive definite matrix
            root = np.diag(1 / np.sqrt(square.diagonal()))
        return np.asarray(PROPOSAL_WIDTH * root / sizes[:, None])

    def _is_near(self, center: Floats, branch: int) -> bool:
        """Return whether an impact found has velocities that the distribution may reach: beside a
        coefficient's pole some are endless, and a distribution about them is none."""
        state, _, _ = self.coordinates.impacts(center[:, None], np.array([branch]))
        before = zip(VELOCITIES, state.before, strict=True)
        return all(np.all(np.abs(v) <= MAX_VELOCITY * self.system.scale(n)) for n, v in before)

    def sample(self, count: int, rng: np.random.Generator) -> Sample | None:
        """Return ``count`` random draws, None where no impact was found within all limits."""
        return sample(self, count, rng) if self.is_usable else None

    def described(
        self, points: Floats, branches: Branches, names: Sequence[str]
    ) -> tuple[Floats, dict[str, Floats], Flags]:
        """Return of the impacts at points the quantities ``names`` (rows), each condition of the
        admissible set (laws end at 0 only), and True for friction beyond its limits before they are
        widened."""
        blocks = []
        for first in range(0, points.shape[1], CHUNK):
            part = slice(first, first + CHUNK)
            state, _, _ = self.coordinates.impacts(points[:, part], branches[part])
            rows = [self.value(state, n) for n in names]
            for name in self.admissible.rows:
                row = self.admissible.row(state, name)
                rows.append(np.minimum(row, 0.5) if name in LAWS else row)
            if FRICTION in self.admissible.rows:
                low, high = friction_limits(state, strict=True)
                rows.append((state["MUP"] < low) | (state["MUP"] > high))
            count = points[:, part].shape[1]
            blocks.append(np.array([np.broadcast_to(row, count) for row in rows], dtype=float))
        table = np.concatenate([block.reshape(len(rows), -1) for block in blocks], axis=1)
        conditions = dict(zip(self.admissible.rows, table[len(names) :], strict=False))
        is_beyond = table[-1] > 0 if FRICTION in self.admissible.rows else np.zeros(len(branches))
        return table[: len(names)], conditions, is_beyond.astype(bool)


class FeasibleRegion:
    """The impacts within all limits, as an `ascent.SearchProblem`.

    Coordinates run from 0 to 1, from limit to limit, or over the range of the draws and
    ``BEYOND_DRAWS`` times as much on either side. The state of a point is its branch. Functions:
    the quantities ``names``, speeds squared, as a speed has a kink at 0. Constraints: the values
    within limits that are no coordinates, and the conditions of the admissible set."""

    BEYOND_DRAWS = 2.0

    def __init__(self, posterior: Posterior, names: Sequence[str], draws: Floats) -> None:
        self.posterior, self.names = posterior, names
        here = posterior.coordinates
        low, high = draws[: here.free].min(axis=1), draws[: here.free].max(axis=1)
        reach = self.BEYOND_DRAWS * (high - low)
        limits = [posterior.items[n] for n in here.inputs]
        self.low = np.concatenate([low - reach, [item.low for item in limits]])
        self.high = np.concatenate([high + reach, [item.high for item in limits]])
        self.limited = {n: item for n, item in posterior.items.items() if n not in here.inputs}
        for name in here.narrow:
            item, reach = self.limited[name], NARROWER * self.limited[name].deviation
            low, high = item.nominal - reach, item.nominal + reach
            self.limited[name] = replace(item, low=low, high=high)

    def near_exact(self, points: Floats, branches: Branches) -> NDArray[np.intp]:
        """Return the numbers of the points that meet narrow values as nearly as bounds do."""
        names = self.posterior.coordinates.narrow
        within = np.ones(points.shape[1], bool)
        for first in range(0, points.shape[1] if names else 0, CHUNK):
            part = slice(first, first + CHUNK)
            state, _, _ = self.posterior.coordinates.impacts(points[:, part], branches[part])
            for name in names:
                value, _ = self.posterior.limited_value(state, name)
                item = self.limited[name]
                within[part] &= (item.low <= value) & (value <= item.high)
        return np.flatnonzero(within)

    def fractions(self, points: Floats) -> Floats:
        """Return points (coordinates, n) as coordinates from 0 to 1 (n, coordinates)."""
        return np.asarray(((points - self.low[:, None]) / (self.high - self.low)[:, None]).T)

    def points(self, u: Floats) -> Floats:
        """Return coordinates from 0 to 1 as points (coordinates, n), exact at the upper limits."""
        points = self.low + u * (self.high - self.low)
        return np.asarray(np.where(u < 1, points, self.high).T)

    def _constraints(self, state: State) -> list[Any]:
        """Return the constraints of impacts, real or complex."""
        admissible, rows = self.posterior.admissible, []
        for name, item in self.limited.items():
            rows += self._within(state, name, item)
        for name in admissible.rows:
            if name in (*LAWS, NORMAL):
                rows.append(admissible.row(state, name))
            else:
                rows += map(one_sided, admissible.ends(state, name))
        return rows

    def _within(self, state: State, name: str, item: Uncertain) -> list[Any]:
        """Return the constraints that hold where a value lies within its limits. Coefficients and
        courses are quotients; their limits are products, in which they are smooth at a closing
        speed of 0 and at a standstill."""
        posterior, system = self.posterior, self.posterior.system
        if name in COEFFICIENTS and not (name == "MUP" and posterior.is_friction_relative):
            ends = posterior.admissible.ends(state, name, (item.low, item.high))
            return [one_sided(end) for end in ends]
        if name in DIRECTIONS and item.high - item.low < HALF_TURN:
            size = system.scale("PN") if name in FORCES else system.speed
            sign = -1.0 if name in FORCES else 1.0
            low, high = (state.along_and_across(name, x)[1] for x in (item.low, item.high))
            along = state.along_and_across(name, (item.low + item.high) / 2)[0]
            inside = [sign * low / size, -sign * high / size, along / size - LEAST_IMPACT]
            return [one_sided(distance) for distance in inside]
        value, _ = posterior.limited_value(state, name)
        return [(value - item.low) / (item.high - item.low)]

    def _rows(self, state: State, count: int) -> Array:
        """Return functions, then constraints of impacts, real or complex."""
        rows = [self._function(state, n) for n in self.names] + self._constraints(state)
        return np.array([np.broadcast_to(row, count) for row in rows])

    def _function(self, state: State, name: str) -> Any:
        if name not in SPEEDS:
            return self.posterior.value(state, name)
        x, y = (state[n] for n in SPEEDS[name])
        return x * x + y * y

    def evaluate(self, u: Floats, guess: Floats) -> tuple[Floats, Floats, Floats, Flags]:
        """Evaluate points (`ascent.SearchProblem`)."""
        branches = guess[0].astype(np.int64)
        state, _, agrees = self.posterior.coordinates.impacts(self.points(u), branches)
        self.posterior.progress(len(u))
        rows = self._rows(state, len(u)).T
        functions, constraints = rows[:, : len(self.names)], rows[:, len(self.names) :]
        usable = agrees & np.isfinite(constraints).all(axis=1)
        return guess, functions, np.where(np.isfinite(constraints), constraints, -1e9), usable

    def _offset_impacts(self, u: Floats, branches: Branches) -> State:
        """Return the impacts at complex steps along each coordinate, all of the first one first."""
        count, dimensions = u.shape
        width = (self.high - self.low)[:, None, None]
        offsets = 1j * COMPLEX_STEP * width * np.eye(dimensions)[:, :, None]
        points = (self.points(u)[:, None] + offsets).reshape(dimensions, dimensions * count)
        state, _, _ = self.posterior.coordinates.impacts(points, np.tile(branches, dimensions))
        return state

    def slopes(self, u: Floats, x: Floats) -> tuple[Floats, Floats, Floats]:
        """Return derivatives (`ascent.SearchProblem`), by complex steps."""
        count, dimensions = u.shape
        state = self._offset_impacts(u, x[0].astype(np.int64))
        rows = np.imag(self._rows(state, dimensions * count)) / COMPLEX_STEP
        rows = np.nan_to_num(rows).reshape(len(rows), dimensions, count).transpose(2, 0, 1)
        size = len(self.names)
        return rows[:, :size], rows[:, size:], np.zeros((count, 1, dimensions))

    def known_values(self, u: Floats, branch: float) -> dict[str, float]:
        """Return the values known within limits at one point."""
        posterior, branches = self.posterior, np.array([int(branch)])
        state, _, _ = posterior.coordinates.impacts(self.points(u[None]), branches)
        return {
            n: float(np.ravel(posterior.limited_value(state, n)[0])[0]) for n in posterior.items
        }


def _unwrapped(name: str, value: Any, nominal: float | None) -> Any:
    """Return a course or PDOF shifted by full turns to be near the nominal one; other values as
    they are."""
    if name not in DIRECTIONS or nominal is None:
        return value
    return value - 360 * np.round((np.real(value) - nominal) / 360)
