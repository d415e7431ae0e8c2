"""Uncertainty of a reconstruction beyond the first order: random draws and bounds.

As many of the values with limits as determine the impact are coordinates, the tightest first: each
point of the box that their limits span is an impact, solved by the chord method with the inverse
Jacobian of the nominal solution, and by Newton's method where that does not converge. The redundant
values are constraints: impacts outside their limits do not count.

Without redundancy draws are independent. With it they come from Markov chains (`_sample_chains`)
whose density is that of all known values, over velocities before, coefficients and vehicles. Bounds
are searched for from the draws and from points spread over the box (`ascent`)."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...collision.geometry import GEOMETRY, Geometry, within_doubles
from ...collision.uncertain import Uncertain, columns_of, fixed_value, random_numbers
from ...mechanics.state import CRUSH, DIRECTIONS, SPEEDS, State
from ...names import COEFFICIENTS, IMPULSES, VELOCITIES
from ..optimization.ascent import CONSTRAINT_TOL, climb, find_extremes, latin_hypercube
from ..optimization.widening import extremes
from ..uncertainty.boundstable import Spread
from .adjustment import Reconstruction, pseudo_inverse
from .posterior import SIGMAS, FeasibleRegion, Posterior
from .system import COMPLEX_STEP, PARAMETERS, System

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
Point = tuple[Floats, Floats, Floats, Flags]
Progress = Callable[[int], object]

# Chosen on 14 problems, half of them redundant. Doubled on four of those, no bound moves by 1e-4 of
# its range, unless noted, and draws change only where their density is improper.
NORMAL_CUTOFF = 6.0  # where all values are taken as normal, in standard deviations
CHUNK = 1 << 14  # draws at a time, bounds the memory
MAX_CHORD_ITERATIONS = 8  # twice as many solve no further draw
MAX_NEWTON_ITERATIONS = 12  # twice as many solve no further draw
RESIDUAL_TOL = 1e-11  # scaled residual of conditions that hold
BOX_POINTS = 1024  # random points of the box, half of them on faces
FEASIBILITY_SEARCHES = 48  # points from which a feasible one is searched for
STARTS = 4  # searches for each extreme, each from the best of a part of all points
MIN_GAIN = 1e-7  # a search stops at a gain below this fraction of the quantity's range
STANDSTILL_STARTS = 16  # slowest draws, from which a standstill is searched for
LEVEL_DRAWS = 2000  # points spread evenly over all impacts within limits, to search bounds from
SINGULAR_TOL = 1e-12  # singular values below, relative to the largest, count as zero

# Markov chains
ADAPTATION_ROUNDS = 6  # constraint surrogates are refitted this often
BURN_IN = 9  # samples discarded per chain
SAMPLES_PER_CHAIN = 20
THINNING = 40  # steps between samples
FREE_DRAWS = 4096  # draws without constraints that chains may start from
# Surrogates are fitted to points with constraints no farther from the middle of their limits, in
# widths: beyond, the pole of a quotient would spoil the fit. Without this limit, draws of one
# problem move by .6 of their deviation.
SURROGATE_RANGE = 1.5
RIDGE = 1e-9  # relative regularization of undetermined terms


@dataclass(frozen=True)
class Draws:
    """Random draws: ``values`` of each quantity, NaN where one has no solution; ``failed``: the
    fraction without; ``points``: their coordinates in the box; ``signs``: signs of friction."""

    values: dict[str, Floats]
    failed: float
    points: Floats = field(default_factory=lambda: np.empty((0, 0)), repr=False)
    signs: Floats | None = field(default=None, repr=False)

    def spread(self, name: str, quantiles: Sequence[float]) -> Spread:
        """Return mean, standard deviation and quantiles of the draws that have a solution."""
        values = self.values[name]
        return Spread.of(values[np.isfinite(values)], quantiles)


@dataclass(frozen=True)
class Range:
    """Lowest and highest value found of a quantity, and the known values that give them.

    NaN where no impact was found within all limits; infinite where E = 0 lies within its limits, or
    the denominator of a coefficient may be 0. ``searched``: True if the search converged."""

    lower: float
    upper: float
    at_lower: dict[str, float]
    at_upper: dict[str, float]
    searched: bool = True


@within_doubles
def draws(
    solution: Reconstruction,
    names: Sequence[str],
    count: int,
    seed: int = 0,
    progress: Progress = lambda impacts: None,
) -> Draws:
    """Return ``count`` random draws of the quantities ``names``: known values drawn within their
    limits, each reconstructed.

    Where no impact lies within all limits, known values are drawn as normal ones, each with its
    standard deviation."""
    rng = random_numbers(seed, 1)
    posterior = Posterior(solution, progress)
    if posterior.determined:
        sampled_points, signs = posterior.sample(count, rng)
        if len(signs):
            value_rows = posterior.values(sampled_points, signs, names)
            return Draws(dict(zip(names, value_rows, strict=True)), 0.0, sampled_points.T, signs)
    box = _ImpactBox(solution, names, progress)
    if box.redundant and box.coordinates:  # something varies, with redundancy
        points, functions = _sample_chains(box, count, rng)
        if not len(points):
            _, functions = _sample_chains(
                _ImpactBox(solution, names, progress, keep_limits=False), count, rng
            )
    else:
        parts = [box.draw(rng, min(CHUNK, count - first)) for first in range(0, count, CHUNK)]
        points = np.concatenate(parts)
        functions = box.functions(points)
    values = functions[:, : len(names)] if len(functions) else np.full((count, len(names)), np.nan)
    failed_fraction = np.isnan(values).any(axis=1).mean() if values.size else 0.0
    return Draws(dict(zip(names, values.T, strict=True)), float(failed_fraction), points)


@within_doubles
def ranges(
    solution: Reconstruction,
    names: Sequence[str],
    seed: int = 0,
    drawn: Draws | None = None,
    progress: Progress = lambda impacts: None,
) -> dict[str, Range]:
    """Return the lowest and highest value of each quantity over the limits of what is known. The
    search starts from the draws ``drawn``, too."""
    posterior = Posterior(solution, progress)
    if posterior.determined:
        return _ranges_over_branches(posterior, solution, names, seed, drawn, progress)
    box = _ImpactBox(solution, names, progress)
    points = box.inside(random_numbers(seed, 0))
    if drawn is not None and drawn.points.shape[1] == points.shape[1]:
        points = np.concatenate([points, drawn.points])
    if not len(points):
        return {name: Range(np.nan, np.nan, {}, {}) for name in names}
    functions = box.functions(points)
    # start from the best of each group of points, so that starts are apart
    groups = [np.arange(i, len(points), STARTS) for i in range(min(STARTS, len(points)))]
    (lower, upper), ends, converged = find_extremes(
        box,
        points,
        functions,
        groups=groups,
        starts=1,
        gain=MIN_GAIN,
        states=lambda start: box.evaluate_from_nominal(start)[0],
    )
    unbounded = _unbounded_names(box, solution.system.known, names)
    # a coefficient is unbounded if its denominator takes both signs
    unbounded |= {name for i, name in enumerate(box.ratios, len(names)) if lower[i] < 0 < upper[i]}
    results = {}
    for i, name in enumerate(names):
        low, high = ({n: float(v[0]) for n, v in box.data(end[i, None]).items()} for end in ends)
        results[name] = Range(
            float(lower[i]), float(upper[i]), low, high, bool(converged[:, i].all())
        )
    return results | {name: Range(-np.inf, np.inf, {}, {}) for name in unbounded if name in results}


def _ranges_over_branches(
    posterior: Posterior,
    solution: Reconstruction,
    names: Sequence[str],
    seed: int,
    previous_draws: Draws | None,
    progress: Progress,
) -> dict[str, Range]:
    """Return the same as `ranges` over all branches of impacts, searched for from draws of the
    posterior distribution."""
    points, signs = posterior.sample_level(LEVEL_DRAWS, random_numbers(seed, 0))
    if previous_draws is not None and previous_draws.signs is not None:
        points = np.concatenate([previous_draws.points.T, points], axis=1)
        signs = np.concatenate([previous_draws.signs, signs])
    if not len(signs):
        return {name: Range(np.nan, np.nan, {}, {}) for name in names}
    region = FeasibleRegion(posterior, names, points)
    (lower, upper), ends, states, converged = extremes(
        region, region.fractions(points), signs, random_numbers(seed, 2)
    )
    box = _ImpactBox(solution, names, progress)
    unbounded = _unbounded_names(box, solution.system.known, names)
    unbounded |= {n for i, n in enumerate(region.ratios, len(names)) if lower[i] < 0 < upper[i]}
    free_coordinates = slice(0, posterior.free)
    results = {}
    for i, name in enumerate(names):
        low, high = (region.values(ends[side, i], states[side, i]) for side in (0, 1))
        is_inside = all((np.abs(end[i][free_coordinates] - 0.5) < 0.5).all() for end in ends)
        has_converged = bool(converged[:, i].all()) and is_inside
        lowest = float(lower[i])
        if name in SPEEDS and lowest > 0:
            speeds = posterior.values(points, signs, [name])[0]
            slowest = np.argsort(speeds, kind="stable")[:STANDSTILL_STARTS]
            standstills = region.standstill(
                name, region.fractions(points[:, slowest]), signs[slowest]
            )
            if len(standstills):
                lowest, low, has_converged = (
                    0.0,
                    region.values(standstills[0], signs[slowest[0]]),
                    bool(converged[1, i].all()),
                )
        results[name] = Range(lowest, float(upper[i]), low, high, has_converged)
    return results | {name: Range(-np.inf, np.inf, {}, {}) for name in unbounded if name in results}


class _ImpactBox:
    """The impacts within limits, as an `ascent.SearchProblem`.

    The k coordinates are known values, from 0 to 1 between their limits. Functions: the quantities
    ``names``, then the denominators of the coefficients among them. Constraints: the redundant
    values, from 0 to 1 between their limits. ``keep_limits``: False to take each value as normal
    about its nominal one instead."""

    def __init__(
        self,
        solution: Reconstruction,
        names: Sequence[str],
        progress: Progress,
        keep_limits: bool = True,
    ) -> None:
        known, self.has_limits, self.progress = solution.system.known, keep_limits, progress
        self.coordinates, self.redundant = _independent(solution)
        adjusted = {item.name: item.adjusted for item in solution.adjusted}
        self.items: dict[str, Uncertain] = {}
        for name in (*self.coordinates, *self.redundant):
            item = known[name]
            low, high = item.limits(SIGMAS)
            if not keep_limits:
                sd, (low, high) = item.standard_deviation, sorted((item.nominal, adjusted[name]))
                low, high = low - NORMAL_CUTOFF * sd, high + NORMAL_CUTOFF * sd
                item = replace(item, kind="normal", deviation=sd)
            self.items[name] = replace(item, low=low, high=high)
        determining = {n: v for n, v in known.items() if n not in self.redundant}
        self.system = system = System(determining, adjusted=False)
        state = solution.system.state(solution.x)
        scaled = zip(system.variables, system.scales, strict=True)
        self.x = np.array([np.ravel(state[n])[0] / scale for n, scale in scaled]).reshape(-1, 1)
        jacobian = system.jacobian(self.x)
        self.inverse, null = pseudo_inverse(jacobian)
        self.square = jacobian.shape[0] == jacobian.shape[1] and not null.shape[1]
        self.names, self.nominal = names, solution.values
        self.ratios = [n for n in names if n in COEFFICIENTS and n not in system.known]
        fractions = [self._fraction(n, adjusted[n]) for n in self.coordinates]
        self.middle = np.clip(np.array([fractions]), 0.0, 1.0).reshape(1, len(fractions))

    def _fraction(self, name: str, value: Any) -> Any:
        """Return where a value lies between its limits, 0 to 1."""
        item = self.items[name]
        return (value - item.low) / (item.high - item.low)

    def data(self, u: Floats) -> dict[str, Floats]:
        """Return the known values at points of the box; exact at the limits."""
        return columns_of({n: (self.items[n].low, self.items[n].high) for n in self.coordinates}, u)

    def draw(self, rng: np.random.Generator, count: int) -> Floats:
        """Return random points of the box, each coordinate by its own distribution."""
        fractions = [
            self._fraction(name, self.items[name].draws(rng, count)) for name in self.coordinates
        ]
        return np.stack(fractions, axis=1) if fractions else np.empty((count, 0))

    # -- impacts

    def _rows(self, state: State) -> Any:
        """Return functions, then constraints of impacts, real or complex."""
        rows = [state.values["PN"]]  # for the shape
        for name in self.names:
            is_parameter = name in self.system.known and name in PARAMETERS
            value = state.values[name] if is_parameter else state[name]
            rows.append(_near(name, value, self.nominal.get(name)))
        rows += [state.quotient(name)[1] for name in self.ratios]
        for name in self.redundant:
            rows.append(self._fraction(name, _near(name, state[name], self.items[name].nominal)))
        return np.stack(np.broadcast_arrays(*rows))[1:]

    def _pack_point(self, x: Floats, state: State, usable: Flags) -> Point:
        """Return states, functions, constraints and True for each usable impact, as `evaluate`
        does."""
        self.progress(len(usable))
        rows = self._rows(state).T
        count = len(self.names) + len(self.ratios)
        functions, constraints = rows[:, :count], rows[:, count:]
        usable = usable & np.isfinite(constraints).all(axis=1)
        return x, functions, np.where(np.isfinite(constraints), constraints, -1e9), usable

    def evaluate_from_nominal(self, u: Floats, guess: Floats | None = None) -> Point:
        """Return the same as `evaluate`, by the chord method from the nominal impact or from a
        ``guess`` for each point (s x n), and by Newton's method where that does not converge."""
        data, geometry = self.data(u), None
        x = start = np.repeat(self.x, len(u), axis=1) if guess is None else guess
        if set(data) & set(GEOMETRY):
            geometry = Geometry({**self.system.constants, **data})
        residual = self._residuals(x, data, geometry)
        residual_size = np.abs(residual).max(axis=0, initial=0.0)
        for steps_left in reversed(range(MAX_CHORD_ITERATIONS)):
            previous_size = residual_size
            x = x - self.inverse @ residual
            residual = self._residuals(x, data, geometry)
            residual_size = np.abs(residual).max(axis=0, initial=0.0)
            # convergence is linear: stop if no point can get there in the steps left
            if not (
                (residual_size > RESIDUAL_TOL)
                & (residual_size * (residual_size / previous_size) ** steps_left <= RESIDUAL_TOL)
            ).any():
                break
        solved = residual_size <= RESIDUAL_TOL
        if not solved.all():
            unsolved = ~solved
            unsolved_data = {n: column[unsolved] for n, column in data.items()}
            x[:, unsolved], solved[unsolved] = self._solve_newton(unsolved_data, start[:, unsolved])
        return self._pack_point(x, self.system.state(x, data, geometry), solved)

    def functions(self, points: Floats) -> Floats:
        """Return the functions at any number of points, NaN where there is no impact."""
        blocks = []
        for first in range(0, len(points), CHUNK):
            _, functions, _, usable = self.evaluate_from_nominal(points[first : first + CHUNK])
            blocks.append(np.where(usable[:, None], functions, np.nan))
        return np.concatenate(blocks)

    def evaluate(self, u: Floats, guess: Floats) -> Point:
        """Evaluate points (`ascent.SearchProblem`) by Newton's method."""
        data = self.data(u)
        x, settled = self._solve_newton(data, guess)
        return self._pack_point(x, self.system.state(x, data), settled)

    def _residuals(
        self, x: Floats, data: Mapping[str, Floats], geometry: Geometry | None = None
    ) -> Floats:
        """Return the scaled residuals of the conditions, with the known values ``data``."""
        return np.asarray(self.system.residuals(self.system.state(x, data, geometry), data))

    def _solve_newton(self, data: Mapping[str, Floats], x: Floats) -> tuple[Floats, Flags]:
        """Return the impacts with the known values ``data`` by Newton's method from the impacts
        ``x``, and True for each that meets all conditions. A point whose residual is not halved in
        three steps is given up."""
        x, count = x.copy(), x.shape[1]
        smallest, idle_steps = np.full(count, np.inf), np.zeros(count, int)
        running = np.arange(count)
        for _ in range(MAX_NEWTON_ITERATIONS):
            point, point_data = (
                x[:, running],
                {name: column[running] for name, column in data.items()},
            )
            residual, jacobian = self.system.linearize(
                point, self.system.residuals, point_data, point_data
            )
            residual_size = np.abs(residual).max(axis=0, initial=0.0)
            idle_steps = np.where(residual_size < 0.5 * smallest, 0, idle_steps + 1)
            smallest = np.fmin(smallest, residual_size)
            unfinished = (residual_size > RESIDUAL_TOL) & (idle_steps <= 3)
            running, smallest, idle_steps = (
                running[unfinished],
                smallest[unfinished],
                idle_steps[unfinished],
            )
            if not len(running):
                break
            right_side = residual[:, unfinished].T[:, :, None]
            step = _solve(jacobian[:, :, unfinished].transpose(2, 0, 1), right_side)[:, :, 0]
            x[:, running] = point[:, unfinished] - np.nan_to_num(step.T)
        return x, np.abs(self._residuals(x, data)).max(axis=0, initial=0.0) <= 100 * RESIDUAL_TOL

    def slopes(self, u: Floats, x: Floats) -> tuple[Floats, Floats, Floats]:
        """Return derivatives (`ascent.SearchProblem`), by the implicit function theorem and complex
        steps."""
        system, data = self.system, self.data(u)
        jacobian = system.linearize(x, system.residuals, data, data)[1].transpose(2, 0, 1)
        offset_data: dict[str, Any] = {}
        for name, direction in zip(
            self.coordinates, np.eye(len(self.coordinates))[:, :, None], strict=True
        ):
            item = self.items[name]
            offset_data[name] = data[name] + 1j * COMPLEX_STEP * (item.high - item.low) * direction
        complex_states = x[:, None].astype(complex)
        condition_slopes = (
            np.imag(system.residuals(system.state(complex_states, offset_data), offset_data))
            / COMPLEX_STEP
        )
        right_side = np.broadcast_to(
            condition_slopes, (len(condition_slopes), len(self.coordinates), len(u))
        )
        state_slopes = -_solve(jacobian, right_side.transpose(2, 0, 1))
        state = system.state(
            complex_states + 1j * COMPLEX_STEP * state_slopes.transpose(1, 2, 0), offset_data
        )
        derivatives = np.nan_to_num(np.imag(self._rows(state)) / COMPLEX_STEP).transpose(2, 0, 1)
        count = len(self.names) + len(self.ratios)
        return derivatives[:, :count], derivatives[:, count:], state_slopes

    def log_volume(self, u: Floats, x: Floats) -> Floats:
        """Return the log of the Jacobian determinant of the map from the known values to velocities
        before, coefficients and vehicles, but for a constant; 0 where the known values do not
        determine everything, or are taken as normal.

        With the laws L (Equations 15, 16 and 18), the impulse P and the unknown coefficients c, the
        determinant is |dL/dP| / (|d(laws and known values)/d(velocities, P)| times the product of
        all |dL/dc|)."""
        if not (self.square and self.has_limits):
            return np.zeros(len(u))
        system, data = self.system, self.data(u)
        jacobian = system.linearize(x, system.residuals, data, data)[1]
        state = system.state(x, data)
        laws = [n for n in COEFFICIENTS if not (system.point and n == "EM")]
        values = {**state.values, **dict(zip(VELOCITIES, state.before, strict=True))}
        log_denominators = np.zeros(len(u))
        for name in laws:
            if name not in system.known:
                values[name] = state[name]
                log_denominators += np.log(np.abs(state.quotient(name)[1]))
        law_slopes = []
        for name in IMPULSES[: len(laws)]:
            offset_state = State({**values, name: values[name] + 1j * COMPLEX_STEP}, state.here)
            law_slopes.append([np.broadcast_to(np.imag(offset_state.law(n)), len(u)) for n in laws])
        impulse_determinant = np.linalg.slogdet(
            np.array(law_slopes).transpose(2, 0, 1) / COMPLEX_STEP
        )[1]
        known_determinant = np.linalg.slogdet(jacobian.transpose(2, 0, 1))[1]
        return np.asarray(impulse_determinant - known_determinant - log_denominators)

    # -- points within all constraints

    def inside(self, rng: np.random.Generator) -> Floats:
        """Return points of the box within all constraints; empty if none was found."""
        points = latin_hypercube(len(self.coordinates), BOX_POINTS, rng)
        on_faces = rng.random(points.shape) < rng.choice([0.0, 0.5, 1.0], (BOX_POINTS, 1))
        points = np.concatenate([self.middle, np.where(on_faces, np.round(points), points)])
        x, _, constraints, usable = self.evaluate_from_nominal(points)
        violation = np.where(
            usable, np.abs(constraints - 0.5).max(axis=1, initial=0.0) - 0.5, np.inf
        )
        feasible = violation <= CONSTRAINT_TOL
        if not self.redundant or feasible.sum() >= FEASIBILITY_SEARCHES:
            return points[feasible]
        starts = np.argsort(violation, kind="stable")[:FEASIBILITY_SEARCHES]
        starts = starts[np.isfinite(violation[starts]) & ~feasible[starts]]
        no_function = np.full(len(starts), -1)
        u, _, _, _ = climb(
            self,
            points[starts],
            x[:, starts],
            index=no_function,
            sense=np.ones(len(starts)),
            min_gain=np.full(len(starts), CONSTRAINT_TOL),
        )
        _, _, constraints, usable = self.evaluate_from_nominal(u)
        is_feasible = usable & (np.abs(constraints - 0.5) <= 0.5 + CONSTRAINT_TOL).all(axis=1)
        return np.concatenate([points[feasible], u[is_feasible]])

    def impact_log_density(self, u: Floats, x: Floats, constraints: Floats) -> Floats:
        """Return `log_density` as a density over velocities before, coefficients and vehicles."""
        logarithm = self.log_density(u, constraints) + self.log_volume(u, x)
        return np.where(np.isnan(logarithm), -np.inf, logarithm)

    def log_density(self, u: Floats, constraints: Floats, slack: Floats | float = 0.0) -> Floats:
        """Return the log density of all known values over the box, but for a constant. ``slack``:
        how far constraints are relaxed."""
        inside = (np.abs(u - 0.5) <= 0.5).all(1) & (np.abs(constraints - 0.5) <= 0.5 + slack).all(1)
        fractions = np.clip(np.concatenate([u, constraints], axis=1), 0.0, 1.0)
        logarithm = np.zeros(len(u))
        for item, fraction in zip(self.items.values(), fractions.T, strict=True):
            if item.kind != "uniform":
                logarithm += item.log_density(item.low + fraction * (item.high - item.low))
        return np.where(inside, logarithm, -np.inf)


def _near(name: str, value: Floats, nominal: float | None) -> Floats:
    """Return a course or PDOF shifted by full turns to be near the nominal one; other values as
    they are."""
    if name not in DIRECTIONS or nominal is None:
        return value
    return np.asarray(value - 360 * np.round((np.real(value) - nominal) / 360))


@dataclass(frozen=True)
class _Chains:
    """Where all Markov chains stand: coordinates ``u`` (chains, k), and constraints, functions and
    log density there."""

    u: Floats
    constraints: Floats
    functions: Floats
    density: Floats

    def __getitem__(self, rows: NDArray[np.intp]) -> "_Chains":
        return _Chains(
            self.u[rows], self.constraints[rows], self.functions[rows], self.density[rows]
        )

    def accept(self, accepted: Flags, proposals: "_Chains") -> "_Chains":
        """Return the chains with the accepted ``proposals`` in place of their points."""
        wide = accepted[:, None]
        return _Chains(
            np.where(wide, proposals.u, self.u),
            np.where(wide, proposals.constraints, self.constraints),
            np.where(wide, proposals.functions, self.functions),
            np.where(accepted, proposals.density, self.density),
        )


class _Surrogate:
    """Quadratic functions of the coordinates that approximate constraints and states, fitted to
    impacts that were solved."""

    def __init__(self, center: Floats, constraint_count: int, state_count: int) -> None:
        self.center, self.constraint_count = center, constraint_count
        self.row, self.column = np.triu_indices(center.shape[1])
        self.points: Floats = np.empty((0, center.shape[1]))
        self.values: Floats = np.empty((0, constraint_count + state_count))
        self.coefficients: Floats = np.empty((0, constraint_count + state_count))

    def add(self, u: Floats, x: Floats, constraints: Floats, usable: Flags) -> None:
        """Add solved impacts to those that the functions are fitted to, unless their constraints
        are far from the limits."""
        near = usable & (np.abs(constraints - 0.5) < SURROGATE_RANGE).all(axis=1)
        self.points = np.vstack([self.points, u[near]])
        self.values = np.vstack([self.values, np.hstack([constraints, x.T])[near]])

    def fit(self) -> None:
        """Fit the functions by least squares, with a small ridge for undetermined terms."""
        matrix = self._terms(self.points)
        square = matrix.T @ matrix
        square += RIDGE * np.trace(square) / len(square) * np.eye(len(square))
        self.coefficients = np.asarray(np.linalg.solve(square, matrix.T @ self.values), np.float64)

    def constraints(self, u: Floats) -> Floats:
        return np.asarray(self._terms(u) @ self.coefficients[:, : self.constraint_count])

    def states(self, u: Floats) -> Floats:
        return np.asarray((self._terms(u) @ self.coefficients[:, self.constraint_count :]).T)

    def _terms(self, u: Floats) -> Floats:
        offsets = u - self.center
        squares = offsets[:, self.row] * offsets[:, self.column]
        return np.concatenate([np.ones((len(u), 1)), offsets, squares], axis=1)


def _sample_chains(box: _ImpactBox, count: int, rng: np.random.Generator) -> tuple[Floats, Floats]:
    """Return ``count`` random points within all constraints, by Markov chain Monte Carlo, and the
    functions there; nothing where no point lies within them.

    To solve an impact for every step would be slow. A chain takes `THINNING` Metropolis steps on a
    surrogate density, which has quadratic functions for constraints, and only the end is solved. It
    is accepted with probability min(1, [p(v) q(u)] / [p(u) q(v)]), p the exact and q the surrogate
    density, so that the chain has the exact distribution (the surrogate transition method: Liu,
    *Monte Carlo Strategies in Scientific Computing*, 2001, 9.4.3). During the first
    `ADAPTATION_ROUNDS` surrogate and steps are fitted again to all impacts solved so far.
    """
    feasible = box.inside(rng)
    if not len(feasible):
        return feasible, np.empty((0, len(box.names)))
    chain_count = -(-count // SAMPLES_PER_CHAIN)
    starts = _chain_starts(box, feasible, chain_count, rng)
    x, functions, constraints, usable = box.evaluate_from_nominal(starts)
    density = np.where(usable, box.impact_log_density(starts, x, constraints), -np.inf)
    weights = _start_weights(box, starts, constraints, density, len(feasible))
    chosen = rng.choice(len(starts), chain_count, p=weights / weights.sum())
    chains = _Chains(starts, constraints, functions, density)[chosen]
    surrogate = _Surrogate(chains.u[:1], len(box.redundant), len(x))
    surrogate.add(starts, x, constraints, usable)
    samples = []
    for sweep in range(BURN_IN + SAMPLES_PER_CHAIN):
        if sweep <= ADAPTATION_ROUNDS:
            surrogate.fit()
            # the surrogate's limits are relaxed by its own error
            slack = 1.1 * np.abs(chains.constraints - surrogate.constraints(chains.u)).max(axis=0)
            step_root = _step_root(chains.u)

        def surrogate_density(u: Floats, slack: Floats = slack) -> Floats:
            return box.log_density(u, surrogate.constraints(u), slack)

        start_density = surrogate_density(chains.u)
        v, end_density = _walk(chains.u, start_density, surrogate_density, step_root, rng)
        x, functions, constraints, usable = box.evaluate_from_nominal(v, surrogate.states(v))
        density = np.where(usable, box.impact_log_density(v, x, constraints), -np.inf)
        log_ratio = (density - chains.density) - (end_density - start_density)
        accepted = -rng.standard_exponential(chain_count) < log_ratio
        chains = chains.accept(accepted, _Chains(v, constraints, functions, density))
        if sweep < ADAPTATION_ROUNDS:
            if accepted.any():
                # chains stuck at an improbable start continue from one that has moved
                donors = rng.choice(np.flatnonzero(accepted), chain_count)
                chains = chains[np.where(accepted, np.arange(chain_count), donors)]
            surrogate.add(v, x, constraints, usable)
        elif sweep >= BURN_IN:
            samples.append((chains.u, chains.functions))
    points, values = (np.concatenate(part)[:count] for part in zip(*samples, strict=True))
    return points, values


def _chain_starts(
    box: _ImpactBox, feasible: Floats, chain_count: int, rng: np.random.Generator
) -> Floats:
    """Return points that chains may start from: draws without regard to constraints, random means
    of four feasible points, as few steps lead out of a corner, and the feasible points."""
    fractions = rng.dirichlet(np.ones(4), chain_count)[:, :, None]
    corners = feasible[rng.integers(len(feasible), size=(chain_count, 4))]
    means = (fractions * corners).sum(axis=1)
    return np.concatenate([box.draw(rng, FREE_DRAWS), means, feasible])


def _start_weights(
    box: _ImpactBox, starts: Floats, constraints: Floats, density: Floats, feasible_count: int
) -> Floats:
    """Return importance weights of the starts: exact density over that of the free draws. No weight
    is so large that all chains would start at one point."""
    possible, weights = np.isfinite(density), np.zeros(len(starts))
    free_density = box.log_density(starts[possible], np.full_like(constraints[possible], 0.5))
    log_weights = density[possible] - free_density
    weights[possible] = np.exp(log_weights - log_weights.max(initial=-np.inf))
    weights = np.minimum(weights, weights.sum() / np.sqrt(possible.sum() or 1))
    if not weights.any():
        weights[-feasible_count:] = 1.0
    return np.asarray(weights)


def _step_root(u: Floats) -> Floats:
    """Return the root of the covariance of random-walk steps: that of the chains, times 2.4² / k
    (Gelman, Roberts and Gilks, 1996)."""
    k = u.shape[1]
    covariance = np.cov(u.T).reshape(k, k) + 1e-6 * np.eye(k)
    return np.asarray(np.linalg.cholesky(covariance).T * 2.4 / np.sqrt(k))


def _walk(
    u: Floats,
    density: Floats,
    log_density: Callable[[Floats], Floats],
    step_root: Floats,
    rng: np.random.Generator,
) -> tuple[Floats, Floats]:
    """Take `THINNING` Metropolis steps from each point, of very different lengths, every second one
    along few coordinates. Return the ends and their log density."""
    for number in range(THINNING):
        steps = rng.standard_normal(u.shape) @ step_root
        if number % 2:
            steps *= rng.random(u.shape) < 0.3
        trial = u + steps * np.exp(rng.standard_normal((len(u), 1)))
        trial_density = log_density(trial)
        accepted = -rng.standard_exponential(len(u)) < trial_density - density
        u = np.where(accepted[:, None], trial, u)
        density = np.where(accepted, trial_density, density)
    return u, density


def _solve(matrices: Floats, right_sides: Floats) -> Floats:
    """Solve n systems of equations (n x rows x columns) for several right sides each (n x rows x
    m).

    Solutions are minimum-norm least squares where a matrix is singular or not square, 0 where it is
    not finite."""
    finite = np.asarray(
        np.isfinite(matrices).all(axis=(1, 2)) & np.isfinite(right_sides).all((1, 2))
    )
    rows, columns = matrices.shape[1:]
    matrices = np.where(finite[:, None, None], matrices, np.eye(rows, columns))
    right_sides = np.where(finite[:, None, None], right_sides, 0.0)
    if rows == columns:
        with suppress(np.linalg.LinAlgError):  # one is singular
            return np.asarray(np.linalg.solve(matrices, right_sides), np.float64)
    return np.asarray(np.linalg.pinv(matrices, rcond=SINGULAR_TOL) @ right_sides)


def _independent(solution: Reconstruction) -> tuple[list[str], list[str]]:
    """Return the values with a tolerance that determine the impact, and the redundant rest. The
    tightest come first, so that few impacts fall outside the limits of the rest."""
    system = solution.system
    jacobian = system.jacobian(solution.x)
    count, names = len(system.conditions), system.observations
    never_redundant = (*GEOMETRY, *CRUSH)  # these are not computed from a state

    def tightness(i: int) -> tuple[bool, float]:
        name = names[i]
        return name not in never_redundant, system.known[name].tolerance / system.scale(name)

    basis = jacobian[:count]
    rank, determining = _rank(basis), []
    for i in sorted(range(len(names)), key=tightness):
        row = jacobian[count + i]
        candidate_basis = np.vstack([basis, row / np.linalg.norm(row)])
        if names[i] in never_redundant or _rank(candidate_basis) > rank:
            basis, rank = candidate_basis, _rank(candidate_basis)
            determining.append(names[i])
    return [n for n in names if n in determining], [n for n in names if n not in determining]


def _rank(rows: Floats) -> int:
    return int(rows.shape[1] - pseudo_inverse(rows)[1].shape[1])


def _unbounded_names(
    box: _ImpactBox, known: Mapping[str, Uncertain], names: Sequence[str]
) -> set[str]:
    """Return the quantities that nothing determines when E is 0, if E may be 0."""
    if "E" not in box.system.laws or not known["E"].low <= 0 <= known["E"].high:
        return set()
    system_at_zero = System({**box.system.known, "E": fixed_value(0.0)}, adjusted=False)
    _, null = pseudo_inverse(system_at_zero.jacobian(box.x))
    slopes = system_at_zero.gradients(box.x, names)
    null_parts = np.abs(slopes @ null).max(axis=1, initial=0.0)
    is_unbounded = null_parts > 1e-7 * np.abs(slopes).max(axis=1, initial=0.0)
    return {name for name, flag in zip(names, is_unbounded, strict=True) if flag}
