"""Draws from the distribution that all known values define together, over every branch.

An impact has six velocities before, e, e_m and P_t/P_n, and vehicles. Before anything is known of
them velocities and coefficients are equally likely everywhere (flat); every known value multiplies
that by its own density (uniform, triangular, normal), and an exact one is the limit of ever
narrower limits. A normal value ends at `SIGMAS` standard deviations where nothing else limits it.

Coordinates: what of the velocities before and of the impulse the exact values and the known
coefficients leave open. For given vehicles and coefficients Equations 15, 16 and 18 and exact
velocities, courses and changes are linear in these, so that every point is one impact and no branch
is special. The change of variables from impulses to coefficients is its Jacobian determinant.

The sampler is sequential Monte Carlo (Del Moral, Doucet and Jasra, *Sequential Monte Carlo
Samplers*, 2006): from wide distributions about every impact found, through ever harder limits, to
the distribution itself, by steps of differential evolution (ter Braak, 2006) in two halves.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..collision.geometry import GEOMETRY, Geometry
from ..collision.uncertain import Uncertain
from ..mechanics.state import BARRIER_SPEEDS, COURSES, CRUSH, DIRECTIONS, ENERGIES, SPEEDS, State
from ..names import COEFFICIENTS, IMPULSES, PIVOT, VELOCITIES
from .adjustment import Reconstruction
from .system import COMPLEX_STEP, System
from .unknowns import TIE

Floats = NDArray[np.float64]
Array = NDArray[Any]
Flags = NDArray[np.bool_]
Progress = Callable[[int], object]

SIGMAS = 3.0  # where a normal without limits ends, for draws and bounds alike
PARTICLES = 8000
FIRST_PARTICLES = 12  # times as many to begin with: thin arms of the distribution are met
MOVES = 8  # steps of each particle at each hardness of the limits
LAST_MOVES = (
    60  # steps before the first draws are taken: with 24 the rarer of two branches is 5 % too rare
)
BEYOND_DRAWS = 2.0  # bounds are sought so many times what draws span beyond them
_CHUNK = 1 << 13  # impacts at a time: bounds the memory
_JUMPS = 0.1  # steps the length of a difference of two particles, which join branches
_INDEPENDENT = 1e-9  # smallest over largest singular value of what is determined
MAX_NEIGHBOURS = 12  # tried, nearer and nearer, for one that an exact value allows
STANDSTILL_STEPS = 25  # Newton's, to a speed of 0
STILL = 1e-9  # of a typical speed: none
_RANK = 1e-10  # singular values up to so much of the largest are none
_GRID = 1e-7  # of the first distribution's spread
_TOUCH = 1e-9  # beyond limits by no more, in half-widths, is at them
_HARDEST = 40.0  # limits softer by e to the power of this are hard
THINNING = 6  # steps between one set of draws and the next
MAX_STAGES = 80  # of ever harder limits; then no impact lies within them
EFFECTIVE = 0.5  # particles that stay effective from stage to stage, as a fraction
WIDENING = 3.0  # of the first distributions over first-order ones
FREEDOM = 4.0  # degrees of freedom of the first distributions, Student's t
BROAD = 1.5  # spread of others, of the largest speed known, which find what else there is
BROAD_FRACTION = 0.4  # of the first particles
FARTHEST = 20.0  # velocities before are at most so many times the largest speed known
LARGEST_COEFFICIENT = 20.0  # and so are coefficients that nothing is known of, either way
LINEAR = (*SPEEDS, *DIRECTIONS, "VC", "VS", "DVAF", "DVAR", "DVBF", "DVBR")
"""Exact quantities that are linear conditions; speeds with their courses exact."""
QUADRATIC = (*SPEEDS, "DVA", "DVB", *ENERGIES)
"""Exact quantities of which one may be a condition: along a line its equation is quadratic."""


class Posterior:
    """The distribution of the impacts that agree with what is known, begun about a solution and
    those found beside it.

    ``supported``: whether the exact values are all linear conditions, but for one at most, which is
    ``curved``: its equation is quadratic along the last coordinate, that is solved for, and which
    of the two roots a point has is its sign's size, 1 or 2; ``closed``: whether they and
    the values within limits determine impacts in general, though perhaps not the solution: where
    there is no impulse, say, coefficients are open."""

    def __init__(self, solution: Reconstruction, progress: Progress = lambda impacts: None) -> None:
        self.progress, self.level = progress, False
        self.system = system = solution.system
        self.known = system.known
        self.unsigned = solution.typed_mu is not None
        self.first_sign = 1.0 if solution.typed_mu == self._mup() else -1.0
        self.nominal = solution.values
        loose = [n for n in self.known if self.known[n].varies]
        self.unknown = [n for n in system.variables if n in (*VELOCITIES, *IMPULSES)]
        scales = dict(zip(system.variables, system.scales, strict=True))
        self.scales = np.array([scales[n] for n in self.unknown])
        laws = [n for n in COEFFICIENTS if not (system.point and n == "EM")]
        self.laws, self.open = laws, [n for n in laws if n not in self.known]
        self.exact = [n for n in system.exact if n not in loose and n not in CRUSH]
        along = [speed for course, speed in COURSES.items() if course in self.exact]
        curved = [n for n in self.exact if n in QUADRATIC and n not in along]
        self.curved = curved[0] if curved else None
        self.exact = [n for n in self.exact if n != self.curved]
        # friction that is a share of each impact's own critical one is no linear condition
        self.supported = len(curved) <= 1 and "MUC" not in system.constants
        crush = [n for n in CRUSH if n in self.known]
        self.crush: list[str] = sorted(crush, key=lambda n: self.known[n].varies, reverse=True)
        self.supported &= not crush or (bool(self.crush) and self.known[self.crush[0]].varies)
        inputs = (*GEOMETRY, *COEFFICIENTS, *self.crush[1:])
        self.inputs = [n for n in loose if n in inputs]
        self.measured = [
            n for n in system.observations if n not in (*inputs, *CRUSH) and n in loose
        ]
        self.items = {n: self._cut(n) for n in (*self.inputs, *self.measured, *self.crush[:1])}
        self.varied = bool(set(self.inputs) & {*GEOMETRY})
        self.geometry = None if self.varied else Geometry(system.constants)
        self.closed = False
        self.implied: list[str] = []
        if self.supported:
            self._span(solution)

    def _cut(self, name: str) -> Uncertain:
        item = self.known[name]
        low, high = item.limits(SIGMAS)
        return Uncertain(item.kind, item.nominal, low, high, item.deviation)

    def _span(self, solution: Reconstruction) -> None:
        """Choose the coordinates: an orthonormal basis of what is left open at the solutions."""
        self.centers: list[Floats] = []
        self.signs: list[float] = []
        starts: Sequence[tuple[System, Floats]] = solution.beside or ((self.system, solution.x),)
        ys, parameters = [], []
        for system, x in starts:
            state = system.state(x)
            ys.append([float(np.ravel(np.real(state.values[n]))[0]) for n in self.unknown])
            sign = 1.0 if system.nominal.get("MUP", 1.0) == self._mup() else -1.0
            here = {n: float(np.ravel(np.real(state.values[n]))[0]) for n in self.inputs}
            parameters.append([sign * v if n == "MUP" else v for n, v in here.items()])
            self.signs.append(sign)
        first = np.array(parameters[0])[:, None]
        rows, _, _, _ = self._conditions(first, np.array([self.signs[0]]))
        # a course along an axis says nothing where the other component is known
        lengths = np.linalg.norm(rows[:, :, 0], axis=1)
        saying = lengths > _RANK * lengths.max(initial=0.0)
        self.implied = [
            name
            for name, says in zip(self.exact, saying[len(rows) - len(self.exact) :], strict=True)
            if not says
        ]
        self.exact = [name for name in self.exact if name not in self.implied]
        matrix = rows[saying, :, 0]
        norm = np.linalg.norm(matrix, axis=1, keepdims=True)
        matrix = matrix / np.where(norm > 0, norm, 1.0)
        _, s, vt = np.linalg.svd(matrix)
        rank = int((s > _RANK * s.max(initial=0.0)).sum())
        self.basis = _unique_basis(vt[rank:])
        self.supported &= rank == len(matrix)
        if self.curved is not None and self.supported and len(self.basis):
            self._turn(ys[0], parameters[0])
        self.free = len(self.basis) - (self.curved is not None)
        self.size = self.free + len(self.inputs)
        self.supported &= self.free >= 0
        for i, (y, own) in enumerate(zip(ys, parameters, strict=True)):
            z = self.basis @ (np.array(y) / self.scales)
            if self.curved is not None and self.supported:
                # which of the two roots it is: the one beside it
                turned = self.signs[i] * np.array([1.0, 2.0])
                twice = np.tile(np.concatenate([z[:-1], own])[:, None], 2)
                lifted, _ = self._lifted(twice[: self.free], twice[self.free :], turned)
                away = np.abs(np.real(lifted[-1]) - z[-1])
                self.signs[i] = float(turned[int(np.nan_to_num(away, nan=np.inf).argmin())])
            self.centers.append(np.concatenate([z[: self.free], own]))
        self.closed = self.supported and self.size > 0 and self._determines()

    # -- one exact value that is no linear condition

    def _curve(self, y: Array, inputs: Array) -> Array:
        """Return what the quadratic equation of the curved value leaves over, at scaled
        unknowns."""
        name = self.curved
        assert name is not None
        values = self._values(inputs)
        here = Geometry(values) if self.varied else self.geometry
        scaled = dict(zip(self.unknown, y * self.scales[:, None], strict=True))
        state, target = State({**values, **scaled}, here), self.known[name].nominal
        if name in ("LOSS", "DT"):
            share = target / (100.0 if name == "LOSS" else 1.0)
            missed = state.energy_lost - share * state.initial_energy
            return np.asarray(missed / self.system.scale("EL"))
        if name in ENERGIES:
            return np.asarray((state[name] - target) / self.system.scale("EL"))
        x, across = (state[n] for n in SPEEDS[name]) if name in SPEEDS else state.change(name[2])
        missed = x * x + across * across - target * target
        return np.asarray(missed / self.system.scale(name) ** 2)

    def _turn(self, y: Sequence[float], inputs: Sequence[float]) -> None:
        """Turn the basis so that the last direction is the one along which the curved value changes
        most at the solution."""
        aside = (np.array(y) / self.scales)[:, None] + 1j * COMPLEX_STEP * self.basis.T
        own = np.repeat(np.array(inputs, float)[:, None], len(self.basis), axis=1)
        slope = np.imag(self._curve(aside, own)) / COMPLEX_STEP
        size = np.linalg.norm(slope)
        direction = slope / size if size > 0 else np.eye(len(slope))[-1]
        others = _unique_basis_across(direction)
        self.basis = np.concatenate([others, direction[None]]) @ self.basis

    def _lifted(self, z: Array, inputs: Array, signs: Array) -> tuple[Array, Array]:
        """Return all coordinates of points where the curved value is what it is known to be, and
        how fast its equation changes with the last one, squared (negative: nowhere)."""
        friction, upper = np.sign(signs), np.abs(signs) < 1.5
        rows, right, _, _ = self._conditions(inputs, friction)
        count = z.shape[1]
        basis = np.broadcast_to(self.basis[:, :, None], (*self.basis.shape, count))
        matrix = np.concatenate([rows, basis]).transpose(2, 0, 1)
        at = [
            self._curve(
                _solutions(matrix, np.concatenate([right, z, np.full((1, count), t)]).T).T, inputs
            )
            for t in (-1.0, 0.0, 1.0)
        ]
        c, b, a = at[1], (at[2] - at[0]) / 2, (at[2] + at[0]) / 2 - at[1]
        square = b * b - 4 * a * c
        root = np.sqrt(np.where(np.real(square) >= 0, square, np.nan))
        root = np.where(upper, root, -root)
        # without a difference of nearly equal numbers
        plain = np.real(b) * np.real(root) <= 0
        last = np.where(plain, (root - b) / (2 * a), -2 * c / (b + root))
        return np.concatenate([z, last[None]]), square

    def _determines(self) -> bool:
        """Return whether values within limits tell apart any two neighbours of an ordinary impact:
        one at a random distance from the solution."""
        rng = np.random.default_rng(0)
        spread = [self.known[n].standard_deviation for n in self.inputs]
        aside = np.concatenate([np.full(self.free, BROAD), spread])
        for _ in range(1 if self.curved is None else MAX_NEIGHBOURS):
            point = self.centers[0] + aside * rng.standard_normal(self.size)
            slopes = self._slopes(point, self.signs[0])
            if np.abs(slopes).sum(axis=0).all():
                break
            aside = aside / 2  # beyond where the curved value can be met
        sizes = np.linalg.norm(slopes, axis=0)
        if not (sizes > 0).all():
            return False
        values = np.linalg.svd(slopes / sizes, compute_uv=False)
        return len(values) == self.size and bool(values[-1] > _INDEPENDENT * values[0])

    def _mup(self) -> float:
        return float(self.known["MUP"].nominal) if "MUP" in self.known else 1.0

    # -- impacts

    def _values(self, inputs: Array) -> dict[str, Any]:
        return {**self.system.constants, **dict(zip(self.inputs, inputs, strict=True))}

    def _coefficient(self, name: str, values: Mapping[str, Any], signs: Array) -> Any:
        return values[name] * signs if name == "MUP" and self.unsigned else values[name]

    def _conditions(self, inputs: Array, signs: Array) -> tuple[Array, Array, Array, Array]:
        """Return the linear conditions of n points: their coefficients over the scaled unknowns
        (rows, unknowns, n), what they must be (rows, n), and above and below the line of each
        coefficient's quotient (laws, unknowns and a constant, n)."""
        size, count = len(self.unknown), inputs.shape[1] if len(inputs) else len(signs)
        values = self._values(inputs)
        here = Geometry(values) if self.varied else self.geometry
        unit = np.eye(size + 1, size)[:, :, None] * self.scales[None, :, None]
        state = State({**values, **dict(zip(self.unknown, unit.swapaxes(0, 1), strict=True))}, here)

        def spread(row: Any) -> Array:
            wide = np.broadcast_to(row, (size + 1, count))
            return np.concatenate([wide[:size] - wide[size:], wide[size:]])

        above, below = [], []
        for name in self.laws:
            if name == "MUP" and self._mup() == PIVOT and name in self.known:
                parts = state.relative_after[1], 0.0 * state.relative_after[1]
            else:
                parts = state.quotient(name)
            above.append(spread(parts[0]))
            below.append(spread(parts[1]))
        rows = []
        for name, top, bottom in zip(self.laws, above, below, strict=True):
            if name in self.known:
                rows.append(top - self._coefficient(name, values, signs) * bottom)
        for name in self.exact:
            target = self.known[name].nominal
            if name in DIRECTIONS:
                rows.append(spread(state.along_and_across(name)[1]))
            elif name in SPEEDS:
                course = next(c for c, speed in COURSES.items() if speed == name)
                rows.append(spread(state.along_and_across(course)[0] - target))
            else:
                rows.append(spread(state[name] - target))
        empty = np.empty((0, size, count)), np.empty((0, count))
        matrix, right = (
            (np.stack([r[:size] for r in rows]), -np.stack([r[size] for r in rows]))
            if rows
            else empty
        )
        return (
            matrix,
            right,
            np.stack(above),
            np.stack(below),
        )

    def impacts(
        self, points: Array, signs: Array, weighed: bool = True
    ) -> tuple[State, Array, Array]:
        """Return the impacts at points (coordinates, n), the logarithm of the Jacobian determinant
        there if ``weighed``, and where exact courses are driven along, not against."""
        z, inputs = points[: self.free], points[self.free :]
        square: Any = 1.0
        if self.curved is not None:
            z, square = self._lifted(z, inputs, signs)
        signs = np.sign(signs)
        rows, right, above, below = self._conditions(inputs, signs)
        count = points.shape[1]
        self.progress(count)
        basis = np.broadcast_to(self.basis[:, :, None], (*self.basis.shape, count))
        matrix = np.concatenate([rows, basis]).transpose(2, 0, 1)
        y = _solutions(matrix, np.concatenate([right, z]).T).T
        values = self._values(inputs)
        here = Geometry(values) if self.varied else self.geometry
        scaled = dict(zip(self.unknown, y * self.scales[:, None], strict=True))
        state = State({**values, **scaled}, here)
        volume = self._volume(matrix, y, above, below, values, signs) if weighed else np.zeros(1)
        if self.curved in ("LOSS", "DT"):
            volume = volume + np.log(np.abs(state.initial_energy))
        volume = volume - 0.5 * np.log(np.abs(square))
        along = np.ones(count, bool)
        for name in (*self.exact, *self.implied):
            if name in DIRECTIONS:
                size = np.real(state.along_and_across(name)[0])
                along &= size > 0
                if weighed and name not in self.implied:
                    volume = volume + np.log(np.abs(size))
        if self.unsigned:
            speeds = np.max([np.abs(np.real(v)) * np.ones(count) for v in state.before], axis=0)
            turned = np.real(state.relative_before[1]) > TIE * speeds  # line 400
            along &= np.where(turned, -self.first_sign, self.first_sign) == signs
        return state, volume, along

    def _volume(
        self,
        matrix: Array,
        y: Array,
        above: Array,
        below: Array,
        values: Mapping[str, Any],
        signs: Array,
    ) -> Array:
        """Return the logarithm of how much of velocities before and coefficients a piece of the
        coordinates takes up: with the laws L, the impulse P, the conditions R and the denominators
        of coefficients c that are open, |dL/dP| over |dR/dy| and each |dL/dc|."""
        pushed = [i for i, name in enumerate(self.unknown) if name in IMPULSES]
        whole = np.concatenate([y, np.ones((1, y.shape[1]))])
        top, bottom = (np.einsum("run,un->rn", part, whole) for part in (above, below))
        volume, rows = -np.linalg.slogdet(matrix)[1], []
        for i, name in enumerate(self.laws):
            if name in self.open:
                coefficient = top[i] / bottom[i]
                volume = volume - np.log(np.abs(bottom[i]))
            else:
                coefficient = self._coefficient(name, values, signs)
            rows.append(above[i][pushed] - coefficient * below[i][pushed])
        return np.asarray(volume + np.linalg.slogdet(np.array(rows).transpose(2, 0, 1))[1])

    def _value(self, state: State, name: str) -> Any:
        own = name in self.known and name in (*GEOMETRY, *COEFFICIENTS, *CRUSH)
        return _near(name, state.values[name] if own else state[name], self.nominal.get(name))

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
        """Return the logarithm of the density at points, limits aside, and how far they lie outside
        all limits: the sum of squares of what is beyond, in half-widths."""
        state, plain, along = self.impacts(points, signs)
        plain = np.where(along, plain, -np.inf)
        excess = np.zeros(points.shape[1])
        for name, item in self.items.items():
            value, more = self._observed(state, name)
            plain = plain + more
            middle, half = (item.low + item.high) / 2, (item.high - item.low) / 2
            beyond = np.maximum(np.abs(value - middle) / half - 1, 0.0)
            beyond = np.where(beyond > _TOUCH, beyond, 0.0)
            excess += beyond * beyond
            if item.kind != "uniform":
                inside = np.clip(value, item.low + _TOUCH * half, item.high - _TOUCH * half)
                plain = plain + item.log_density(inside)
        for name in self.open:
            above, below = state.quotient(name)
            beyond = np.abs(above / below) / LARGEST_COEFFICIENT - 1
            excess = excess + np.square(np.maximum(beyond, 0.0))
        for name, value in zip(VELOCITIES, state.before, strict=True):
            beyond = np.abs(value) / (FARTHEST * self.system.scale(name)) - 1
            excess = excess + np.square(np.maximum(beyond, 0.0))
        sound = np.isfinite(plain) & np.isfinite(excess)
        if self.level:
            plain = np.zeros_like(plain)
        return np.where(sound, plain, -np.inf), np.where(sound, excess, np.inf)

    def _logarithms_by_parts(self, points: Floats, signs: Floats) -> tuple[Floats, Floats]:
        parts = [slice(i, i + _CHUNK) for i in range(0, points.shape[1], _CHUNK)]
        rows = [self.logarithms(points[:, part], signs[part]) for part in parts]
        return np.concatenate([row[0] for row in rows]), np.concatenate([row[1] for row in rows])

    def _observed(self, state: State, name: str) -> tuple[Any, Any]:
        """Return a value that is known within limits, and the logarithm of what its own scale adds
        to the density."""
        if name in self.inputs:
            return state.values[name], 0.0
        if name not in self.crush:
            return _near(name, state[name], self.known[name].nominal), 0.0
        rest = [state.crush_energy(n[-1]) for n in self.crush[1:]]
        energy = state["EL"] - sum(rest)
        if name not in BARRIER_SPEEDS:
            return energy, 0.0
        mass = state.values["M" + name[-1]]
        side = np.where(np.real(energy) < 0, -1.0, 1.0)
        speed = side * np.sqrt(2 * side * energy / mass)
        return speed, -np.log(np.abs(mass * speed))

    # -- sampling

    def scattered(self, count: int, rng: np.random.Generator) -> tuple[Floats, Floats]:
        """Return points as `sample` does, spread level over the coordinates within all limits: what
        is hardly likely is met as often as anything else."""
        self.level = True
        try:
            return self.sample(count, rng)
        finally:
            self.level = False

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Floats, Floats]:
        """Return ``count`` points of the distribution (coordinates, n) and their friction signs;
        none where no impact was found within all limits."""
        nothing = np.empty((self.size, 0)), np.empty(0)
        particles = min(PARTICLES, max(count, 4 * self.size, 200)) // 2 * 2
        try:
            with np.errstate(all="ignore"):
                return self._sampled(particles, count, rng)
        except np.linalg.LinAlgError:
            return nothing

    def _sampled(
        self, particles: int, count: int, rng: np.random.Generator
    ) -> tuple[Floats, Floats]:
        nothing = np.empty((self.size, 0)), np.empty(0)
        points, signs, first = self._begin(FIRST_PARTICLES * particles, rng)
        logs = (*self._logarithms_by_parts(points, signs), first(points, signs))
        hardness, needed = 0.0, EFFECTIVE * particles
        for _ in range(MAX_STAGES):
            now = _tempered(logs, hardness)
            hard = _tempered(logs, np.inf) - now
            last = _effective(hard) >= needed
            harder = np.inf
            if not last:
                low, high = hardness, hardness + 4.0
                for _ in range(30):
                    middle = (low + high) / 2
                    enough = _effective(_tempered(logs, middle) - now) >= needed
                    low, high = (middle, high) if enough else (low, middle)
                harder = low
                if harder > _HARDEST or not harder > hardness:
                    return nothing
            weights = np.exp(_lifted(_tempered(logs, harder) - now))
            chosen = _resampled(weights, particles, rng)
            points, signs = points[:, chosen], signs[chosen]
            logs = (logs[0][chosen], logs[1][chosen], logs[2][chosen])
            hardness = harder
            for _ in range(MOVES):
                points, signs, logs = self._moved(points, signs, logs, hardness, first, rng)
            if last:
                break
        else:
            return nothing
        for _ in range(LAST_MOVES):
            points, signs, logs = self._moved(points, signs, logs, np.inf, first, rng)
        parts = [(points, signs)]
        while sum(part.shape[1] for part, _ in parts) < count:
            for _ in range(THINNING):
                points, signs, logs = self._moved(points, signs, logs, np.inf, first, rng)
            parts.append((points, signs))
        drawn = np.concatenate([part for part, _ in parts], axis=1)[:, :count]
        return drawn, np.concatenate([own for _, own in parts])[:count]

    def _begin(self, count: int, rng: np.random.Generator) -> tuple[Floats, Floats, Any]:
        """Return the first particles, their signs and the function that gives the logarithm of
        their density: Student's t about every impact found."""
        roots = []
        deviations = np.array([self.known[n].standard_deviation for n in self.inputs])
        # what first order hardly tells is as wide as velocities may be
        weak = np.concatenate([np.full(self.free, WIDENING / FARTHEST), 0 * deviations])
        about = [c for c in zip(self.centers, self.signs, strict=True) if self._is_near(*c)]
        about = about or [(self.centers[0], self.signs[0])]
        for center, sign in about:
            slopes = self._slopes(center, sign)
            sizes = np.linalg.norm(slopes, axis=0)
            sizes = np.where(sizes > 0, sizes, 1.0)
            square = (slopes / sizes).T @ (slopes / sizes) + np.diag(np.square(weak / sizes))
            try:
                # Cholesky's root is the same in any units, up to their factors
                root = np.linalg.cholesky(np.linalg.inv(square))
            except np.linalg.LinAlgError:  # rounding leaves no positive definite matrix
                root = np.diag(1 / np.sqrt(square.diagonal()))
            roots.append(WIDENING * root / sizes[:, None])
        # far from all that was found, too: what first order knows nothing of
        wide = np.diag(np.concatenate([np.full(self.free, BROAD), deviations]))
        everywhere = list(about)
        if self.curved is not None:
            everywhere += [(center, _other_root(sign)) for center, sign in about]
        roots += [wide] * len(everywhere)
        centers = [center for center, _ in (*about, *everywhere)]
        own_signs = [float(sign) for _, sign in (*about, *everywhere)]
        shares = np.repeat(
            [(1 - BROAD_FRACTION) / len(about), BROAD_FRACTION / len(everywhere)],
            [len(about), len(everywhere)],
        )
        which = rng.choice(len(roots), size=count, p=shares)
        normal = rng.standard_normal((count, self.size))
        chi = np.sqrt(rng.chisquare(FREEDOM, count) / FREEDOM)
        steps = np.stack(roots)[which] @ (normal / chi[:, None])[:, :, None]
        points = (np.stack(centers)[which] + steps[:, :, 0]).T
        self.grid = _GRID * np.linalg.norm(roots[0], axis=1)[:, None]
        points = self._on_grid(points)
        signs = np.array(own_signs)[which]
        inverses = [np.linalg.inv(root) for root in roots]
        heights = [
            np.linalg.slogdet(inverse)[1] + np.log(share)
            for inverse, share in zip(inverses, shares, strict=True)
        ]

        def first(points: Floats, signs: Floats) -> Floats:
            total = np.full(points.shape[1], -np.inf)
            for center, own, inverse, height in zip(
                centers, own_signs, inverses, heights, strict=True
            ):
                square = np.square(inverse @ (points - center[:, None])).sum(axis=0)
                power = -(FREEDOM + self.size) / 2 * np.log1p(square / FREEDOM)
                total = np.logaddexp(total, np.where(signs == own, power + height, -np.inf))
            return total

        return points, signs, first

    def _is_near(self, center: Floats, sign: float) -> bool:
        """Return whether an impact found has velocities that the distribution may reach: beside a
        coefficient's pole some are endless, and a distribution about them is none."""
        state, _, _ = self.impacts(center[:, None], np.array([sign]), weighed=False)
        before = zip(VELOCITIES, state.before, strict=True)
        return all(np.all(np.abs(v) <= FARTHEST * self.system.scale(n)) for n, v in before)

    def _slopes(self, center: Floats, sign: float) -> Floats:
        """Return the derivatives of all values known within limits, in standard deviations, over
        the coordinates."""
        aside = center[:, None] + 1j * COMPLEX_STEP * np.eye(self.size)
        state, _, _ = self.impacts(aside, np.full(self.size, sign), weighed=False)
        rows = []
        for name in self.items:
            value = np.broadcast_to(self._observed(state, name)[0], self.size)
            rows.append(np.imag(value) / COMPLEX_STEP / self.known[name].standard_deviation)
        return np.asarray(np.nan_to_num(np.array(rows), posinf=0.0, neginf=0.0))

    def _on_grid(self, points: Floats) -> Floats:
        """Return points on a fine grid. Steps of differential evolution multiply rounding errors:
        without a grid draws differ from one system of units to another."""
        center = self.centers[0][:, None]
        return np.asarray(center + np.round((points - center) / self.grid) * self.grid)

    def _moved(
        self,
        points: Floats,
        signs: Floats,
        logs: tuple[Floats, Floats, Floats],
        hardness: float,
        first: Any,
        rng: np.random.Generator,
    ) -> tuple[Floats, Floats, tuple[Floats, Floats, Floats]]:
        """Return all particles after a step of differential evolution of each half by the other."""
        points, signs = points.copy(), signs.copy()
        parts = [part.copy() for part in logs]
        half = points.shape[1] // 2
        order = rng.permutation(points.shape[1])
        for own, other in ((order[:half], order[half:]), (order[half:], order[:half])):
            one, two = (rng.choice(other, len(own)) for _ in range(2))
            length = 2.38 / np.sqrt(2 * self.size) * np.exp(0.5 * rng.standard_normal(len(own)))
            length = np.where(rng.random(len(own)) < _JUMPS, 1.0, length)
            spread = points[:, other].std(axis=1, keepdims=True)
            noise = 1e-3 * spread * rng.standard_normal((self.size, len(own)))
            tried = points[:, own] + length * (points[:, one] - points[:, two]) + noise
            tried = self._on_grid(tried)
            turned = signs[own]
            if self.unsigned:
                turned = np.where(rng.random(len(own)) < _JUMPS, -turned, turned)
            if self.curved is not None:  # to the equation's other root
                turned = np.where(rng.random(len(own)) < _JUMPS, _other_root(turned), turned)
            after = (*self.logarithms(tried, turned), first(tried, turned))
            before = tuple(part[own] for part in parts)
            gain = _tempered(after, hardness) - _tempered(
                (before[0], before[1], before[2]), hardness
            )
            better = -rng.standard_exponential(len(own)) < gain
            at = own[better]
            points[:, at], signs[at] = tried[:, better], turned[better]
            for part, new in zip(parts, after, strict=True):
                part[at] = new[better]
        return points, signs, (parts[0], parts[1], parts[2])


class Ground:
    """The impacts within all limits, as an `ascent.SearchProblem`.

    Coordinates run from 0 to 1, from limit to limit, or over the range of the draws and
    ``BEYOND_DRAWS`` times as much on either side. The state of a point is the sign of its friction.
    Functions: the quantities ``names``, then the denominators of the unknown coefficients among
    them. Constraints: the values within limits that are no coordinates."""

    def __init__(self, posterior: Posterior, names: Sequence[str], drawn: Floats) -> None:
        self.posterior, self.names = posterior, names
        self.ratios = [n for n in names if n in posterior.open]
        split = posterior.free
        low, high = drawn[:split].min(axis=1), drawn[:split].max(axis=1)
        reach = BEYOND_DRAWS * (high - low)
        limits = [posterior.items[n] for n in posterior.inputs]
        self.low = np.concatenate([low - reach, [item.low for item in limits]])
        self.high = np.concatenate([high + reach, [item.high for item in limits]])
        self.walls = [n for n in posterior.items if n not in posterior.inputs]

    def shares(self, points: Floats) -> Floats:
        """Return points (coordinates, n) as coordinates from 0 to 1 (n, coordinates)."""
        return np.asarray(((points - self.low[:, None]) / (self.high - self.low)[:, None]).T)

    def points(self, u: Floats) -> Floats:
        wide = self.low + u * (self.high - self.low)
        return np.asarray(np.where(u < 1, wide, self.high).T)

    def _rows(self, state: State, count: int) -> Array:
        posterior = self.posterior
        rows = [posterior._value(state, n) for n in self.names]
        rows += [state.quotient(n)[1] for n in self.ratios]
        for name in self.walls:
            item = posterior.items[name]
            rows.append((posterior._observed(state, name)[0] - item.low) / (item.high - item.low))
        return np.array([np.broadcast_to(row, count) for row in rows])

    def evaluate(self, u: Floats, guess: Floats) -> tuple[Floats, Floats, Floats, Flags]:
        """`ascent.SearchProblem`."""
        state, _, along = self.posterior.impacts(self.points(u), guess[0], weighed=False)
        rows = self._rows(state, len(u)).T
        count = len(self.names) + len(self.ratios)
        functions, walls = rows[:, :count], rows[:, count:]
        usable = along & np.isfinite(walls).all(axis=1)
        return guess, functions, np.where(np.isfinite(walls), walls, -1e9), usable

    def slopes(self, u: Floats, x: Floats) -> tuple[Floats, Floats, Floats]:
        """`ascent.SearchProblem`."""
        count, size = u.shape
        width = (self.high - self.low)[:, None, None]
        aside = 1j * COMPLEX_STEP * width * np.eye(size)[:, :, None]
        points = (self.points(u)[:, None] + aside).reshape(size, size * count)
        signs = np.tile(x[0], size)
        state, _, _ = self.posterior.impacts(points, signs, weighed=False)
        rows = np.imag(self._rows(state, size * count)) / COMPLEX_STEP
        rows = np.nan_to_num(rows).reshape(len(rows), size, count).transpose(2, 0, 1)
        split = len(self.names) + len(self.ratios)
        return rows[:, :split], rows[:, split:], np.zeros((count, 1, size))

    def standstill(self, speed: str, u: Floats, signs: Floats) -> Floats:
        """Return points within all limits where a speed is 0, sought from the points ``u``: there
        it has a kink, which no climb comes to the end of."""
        count, size = u.shape
        width = (self.high - self.low)[:, None, None]
        aside = 1j * COMPLEX_STEP * width * np.eye(size)[:, :, None]
        typical = self.posterior.system.scale(speed)
        for _ in range(STANDSTILL_STEPS):
            points = (self.points(u)[:, None] + aside).reshape(size, size * count)
            state, _, _ = self.posterior.impacts(points, np.tile(signs, size), weighed=False)
            rows = [np.broadcast_to(state[n] / typical, size * count) for n in SPEEDS[speed]]
            for name in self.walls:
                item = self.posterior.items[name]
                share = (self.posterior._observed(state, name)[0] - item.low) / (
                    item.high - item.low
                )
                inside = np.clip(np.real(share), 0.0, 1.0)
                outside = np.real(share) != inside
                rows.append(np.broadcast_to(np.where(outside, share - inside, 0.0), size * count))
            whole = np.array(rows).reshape(len(rows), size, count)
            if not np.isfinite(whole).all():
                return u[:0]
            slopes = (np.imag(whole) / COMPLEX_STEP).transpose(2, 0, 1)
            steps = np.linalg.pinv(slopes, rcond=1e-9) @ np.real(whole[:, 0]).T[:, :, None]
            u = np.clip(u - steps[:, :, 0], 0.0, 1.0)
        _, _, walls, usable = self.evaluate(u, signs[None])
        state, _, _ = self.posterior.impacts(self.points(u), signs, weighed=False)
        still = np.hypot(*(np.real(state[n]) for n in SPEEDS[speed])) < STILL * typical
        inside = (np.abs(walls - 0.5) <= 0.5 + _TOUCH).all(axis=1)
        return np.asarray(u[still & usable & inside])

    def values(self, u: Floats, sign: float) -> dict[str, float]:
        """Return the values known within limits at one point."""
        posterior = self.posterior
        state, _, _ = posterior.impacts(self.points(u[None]), np.array([sign]), weighed=False)
        return {n: float(np.ravel(posterior._observed(state, n)[0])[0]) for n in posterior.items}


def _other_root(signs: Any) -> Any:
    return np.sign(signs) * (3.0 - np.abs(signs))


def _unique_basis_across(direction: Floats) -> Floats:
    """Return an orthonormal basis of all that is orthogonal to a direction."""
    projector = np.eye(len(direction)) - np.outer(direction, direction)
    return _unique_basis(np.linalg.svd(projector)[2][: len(direction) - 1])


def _solutions(matrices: Array, right: Array) -> Array:
    """Return the solutions of n systems of equations (n, unknowns), NaN where one is singular."""
    try:
        return np.asarray(np.linalg.solve(matrices, right[:, :, None])[:, :, 0])
    except np.linalg.LinAlgError:
        singular = np.linalg.det(matrices) == 0
        matrices = np.where(singular[:, None, None], np.eye(matrices.shape[1]), matrices)
        found = np.linalg.solve(matrices, right[:, :, None])[:, :, 0]
        return np.asarray(np.where(singular[:, None], np.nan, found))


def _unique_basis(rows: Floats) -> Floats:
    """Return the orthonormal basis of a space that rounding does not turn, as it turns the rows of
    a singular value decomposition: its projector's columns made orthogonal, the longest first."""
    left, basis = rows.T @ rows, []
    for _ in rows:
        lengths = np.linalg.norm(left, axis=0).round(6)
        vector = left[:, int(lengths.argmax())]
        basis.append(vector / np.linalg.norm(vector))
        left = left - np.outer(basis[-1], basis[-1] @ left)
    return np.array(basis).reshape(len(rows), rows.shape[1])


def _tempered(logs: tuple[Floats, Floats, Floats], hardness: float) -> Floats:
    """Return the logarithm of the density with softened limits: 0, the first distribution;
    infinite, the distribution itself. ``logs``: the density, what is beyond limits, the first
    density."""
    plain, excess, first = logs
    if hardness == np.inf:
        return np.where(excess > 0, -np.inf, plain)
    if hardness == 0:
        return first
    part = -np.expm1(-hardness)
    return np.asarray(part * plain + (1 - part) * first - np.expm1(hardness) * excess)


def _lifted(logarithms: Floats) -> Floats:
    clean = np.where(np.isnan(logarithms), -np.inf, logarithms)
    return np.asarray(clean - clean.max(initial=-1e300))


def _effective(logarithms: Floats) -> float:
    """Return the effective number of particles with these logarithms of weights."""
    weights = np.exp(_lifted(logarithms))
    total = weights.sum()
    return float(total * total / np.square(weights).sum()) if total > 0 else 0.0


def _resampled(weights: Floats, count: int, rng: np.random.Generator) -> NDArray[np.intp]:
    """Return which particles go on, ``count`` of them, by systematic resampling."""
    places = (rng.random() + np.arange(count)) / count
    sums = np.cumsum(weights / weights.sum())
    return np.minimum(np.searchsorted(sums, places), len(weights) - 1)


def _near(name: str, value: Any, nominal: float | None) -> Any:
    """Return a course or PDOF by full turns near the nominal one; else the value as it is."""
    if name not in DIRECTIONS or nominal is None:
        return value
    return value - 360 * np.round((np.real(value) - nominal) / 360)
