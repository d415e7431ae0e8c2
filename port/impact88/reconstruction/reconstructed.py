"""How uncertain a reconstruction is: draws of what is known, and bounds, beside the first order.

Of the values with limits as many as determine the impact are coordinates, the tightest first: each
point of the box their limits span is an impact, solved by iterations with the inverse Jacobian of
the nominal solution and by Newton's method where those do not settle. What is known beyond that is
a wall: impacts outside its limits are none.

Without redundancy draws are independent. With it they come from Markov chains whose density is that
of all known values, over velocities before, coefficients and vehicles. A chain runs between walls
that are quadratic functions, set back a little; its end is accepted by the densities proper
(Metropolis, Hastings). Bounds climb from the draws and from points spread over the box (`ascent`).
"""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..collision.geometry import GEOMETRY, Geometry, within_doubles
from ..collision.uncertain import Uncertain, columns_of, fixed_value, random_numbers
from ..mechanics.state import CRUSH, DIRECTIONS, SPEEDS, State
from ..names import COEFFICIENTS, IMPULSES, VELOCITIES
from ..optimization.ascent import CONSTRAINT_TOL, climb, find_extremes, latin_hypercube
from ..optimization.widening import extremes
from ..uncertainty.boundstable import Spread
from .adjustment import Reconstruction, pseudo_inverse
from .posterior import Ground, Posterior
from .system import COMPLEX_STEP, PARAMETERS, System

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
Point = tuple[Floats, Floats, Floats, Flags]
Progress = Callable[[int], object]

# chosen on 14 problems, half of them redundant; doubled on four of those, where nothing else is
# said, no bound moves by 1e-4 of its range, and draws only where their density is improper
SIGMAS, FAR = 3.0, 6.0
"""Where a normal without limits ends, by definition; and, taken for normal, any value."""
CHUNK = 1 << 14
"""Draws at a time: bounds the memory."""
CHORDS, NEWTONS = 8, 12
"""Steps at most; with twice as many no draw more is solved."""
SETTLED = 1e-11
"""Scaled conditions below count as met by a draw."""
SCATTERED, SEEKERS = 1024, 48
"""Points spread over the box, half of them on faces; so many seek the way inside all walls."""
STARTS = 4
"""Climbers of each extreme, each from the best of a part of all points."""
LEAST_GAIN = 1e-7
"""Of a quantity's range: a gain not worth a step."""
LEARNT, UNSEEN, WALKS, PACES = 6, 9, 20, 40
"""Times each chain's place is met while the walls are learnt, until it has forgotten its start, and
as a draw; each so many paces apart."""
STANDSTILLS = 16  # of the slowest draws, from which a standstill is sought
FEELERS = 2000  # points spread over all within limits, however unlikely
FREE = 4096
"""Draws as without walls that chains may start from."""
NEAR, RIDGE = 1.5, 1e-9
"""Walls are learnt no farther from the middle between them, where a quotient's pole would spoil
them: learnt anywhere, draws of one problem move by .6 of their deviation. The ridge holds still
what the places met do not tell."""
_SINGULAR = 1e-12
"""Singular values of so little of the largest are none."""


@dataclass(frozen=True)
class Draws:
    """``values``: each quantity's draws, NaN where one has no solution; ``failed``: their share;
    ``points``: where in the box they lie."""

    values: dict[str, Floats]
    failed: float
    points: Floats = field(default_factory=lambda: np.empty((0, 0)), repr=False)
    signs: Floats | None = field(default=None, repr=False)

    def spread(self, name: str, quantiles: Sequence[float]) -> Spread:
        """Mean, standard deviation and quantiles of those that have a solution."""
        values = self.values[name]
        return Spread.of(values[np.isfinite(values)], quantiles)


@dataclass(frozen=True)
class Range:
    """Lowest and highest value found of a quantity, and the known values that give them; NaN where
    no impact was found within all limits, infinite where E = 0 lies within its limits, or what a
    coefficient is divided by may be 0. ``searched``: whether the search came to its end."""

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
    """``count`` random draws of what is known, each reconstructed: the quantities ``names``. Where
    no impact lies within all limits the known values are drawn as normal ones, each with its
    standard deviation."""
    rng = random_numbers(seed, 1)
    posterior = Posterior(solution, progress)
    if posterior.closed:
        drawn, signs = posterior.sample(count, rng)
        if len(signs):
            rows = posterior.values(drawn, signs, names)
            return Draws(dict(zip(names, rows, strict=True)), 0.0, drawn.T, signs)
    box = _Box(solution, names, progress)
    if box.rest and box.kept:  # else nothing varies
        points, functions = _walked(box, count, rng)
        if not len(points):
            _, functions = _walked(_Box(solution, names, progress, walls=False), count, rng)
    else:
        parts = [box.drawn(rng, min(CHUNK, count - first)) for first in range(0, count, CHUNK)]
        points = np.concatenate(parts)
        functions = box.functions(points)
    values = functions[:, : len(names)] if len(functions) else np.full((count, len(names)), np.nan)
    failed = np.isnan(values).any(axis=1).mean() if values.size else 0.0
    return Draws(dict(zip(names, values.T, strict=True)), float(failed), points)


@within_doubles
def ranges(
    solution: Reconstruction,
    names: Sequence[str],
    seed: int = 0,
    drawn: Draws | None = None,
    progress: Progress = lambda impacts: None,
) -> dict[str, Range]:
    """The lowest and highest value of each quantity over the limits of what is known. The search
    begins from ``drawn``, too."""
    posterior = Posterior(solution, progress)
    if posterior.closed:
        return _extremes(posterior, solution, names, seed, drawn, progress)
    box = _Box(solution, names, progress)
    points = box.inside(random_numbers(seed, 0))
    if drawn is not None and drawn.points.shape[1] == points.shape[1]:
        points = np.concatenate([points, drawn.points])
    if not len(points):
        return {name: Range(np.nan, np.nan, {}, {}) for name in names}
    functions = box.functions(points)
    # of each part of the points the best: climbers that stand apart
    parts = [np.arange(i, len(points), STARTS) for i in range(min(STARTS, len(points)))]
    (lower, upper), ends, done = find_extremes(
        *(box, points, functions, parts, 1, LEAST_GAIN),
        lambda start: box.from_nominal(start)[0],
    )
    endless = _endless(box, solution.system.known, names)
    # what divides a coefficient takes both signs
    endless |= {name for i, name in enumerate(box.ratios, len(names)) if lower[i] < 0 < upper[i]}
    found = {}
    for i, name in enumerate(names):
        low, high = ({n: float(v[0]) for n, v in box.data(end[i, None]).items()} for end in ends)
        found[name] = Range(float(lower[i]), float(upper[i]), low, high, bool(done[:, i].all()))
    return found | {name: Range(-np.inf, np.inf, {}, {}) for name in endless if name in found}


def _extremes(
    posterior: Posterior,
    solution: Reconstruction,
    names: Sequence[str],
    seed: int,
    drawn: Draws | None,
    progress: Progress,
) -> dict[str, Range]:
    """`ranges` over all branches: climbed from draws of the distribution."""
    points, signs = posterior.scattered(FEELERS, random_numbers(seed, 0))
    if drawn is not None and drawn.signs is not None:
        points = np.concatenate([drawn.points.T, points], axis=1)
        signs = np.concatenate([drawn.signs, signs])
    if not len(signs):
        return {name: Range(np.nan, np.nan, {}, {}) for name in names}
    ground = Ground(posterior, names, points)
    (lower, upper), ends, states, done = extremes(
        ground, ground.shares(points), signs, random_numbers(seed, 2)
    )
    box = _Box(solution, names, progress)
    endless = _endless(box, solution.system.known, names)
    endless |= {n for i, n in enumerate(ground.ratios, len(names)) if lower[i] < 0 < upper[i]}
    free = slice(0, posterior.free)
    found = {}
    for i, name in enumerate(names):
        low, high = (ground.values(ends[side, i], states[side, i]) for side in (0, 1))
        inside = all((np.abs(end[i][free] - 0.5) < 0.5).all() for end in ends)
        searched = bool(done[:, i].all()) and inside
        least = float(lower[i])
        if name in SPEEDS and least > 0:
            own = posterior.values(points, signs, [name])[0]
            slowest = np.argsort(own, kind="stable")[:STANDSTILLS]
            still = ground.standstill(name, ground.shares(points[:, slowest]), signs[slowest])
            if len(still):
                least, low, searched = (
                    0.0,
                    ground.values(still[0], signs[slowest[0]]),
                    bool(done[1, i].all()),
                )
        found[name] = Range(least, float(upper[i]), low, high, searched)
    return found | {name: Range(-np.inf, np.inf, {}, {}) for name in endless if name in found}


class _Box:
    """The impacts within limits: functions (the quantities wanted, then what divides coefficients
    among them) and walls (redundant values, 0 to 1 from limit to limit) over k coordinates, 0 to 1
    each. ``walls``: whether limits are kept, or each value is normal about its nominal one."""

    def __init__(
        self,
        solution: Reconstruction,
        names: Sequence[str],
        progress: Progress,
        walls: bool = True,
    ) -> None:
        known, self.limited, self.progress = solution.system.known, walls, progress
        self.kept, self.rest = _independent(solution)
        adjusted = {item.name: item.adjusted for item in solution.adjusted}
        self.items: dict[str, Uncertain] = {}
        for name in (*self.kept, *self.rest):
            item = known[name]
            low, high = item.limits(SIGMAS)
            if not walls:
                sd, (low, high) = item.standard_deviation, sorted((item.nominal, adjusted[name]))
                low, high = low - FAR * sd, high + FAR * sd
                item = replace(item, kind="normal", deviation=sd)
            self.items[name] = replace(item, low=low, high=high)
        determining = {n: v for n, v in known.items() if n not in self.rest}
        self.system = system = System(determining, adjusted=False)
        state = solution.system.state(solution.x)
        scaled = zip(system.variables, system.scales, strict=True)
        self.x = np.array([np.ravel(state[n])[0] / scale for n, scale in scaled]).reshape(-1, 1)
        jacobian = system.jacobian(self.x)
        self.inverse, null = pseudo_inverse(jacobian)
        self.square = jacobian.shape[0] == jacobian.shape[1] and not null.shape[1]
        self.names, self.nominal = names, solution.values
        self.ratios = [n for n in names if n in COEFFICIENTS and n not in system.known]
        shares = [self._share(n, adjusted[n]) for n in self.kept]
        self.middle = np.clip(np.array([shares]), 0.0, 1.0).reshape(1, len(shares))

    def _share(self, name: str, value: Any) -> Any:
        item = self.items[name]
        return (value - item.low) / (item.high - item.low)

    def data(self, u: Floats) -> dict[str, Floats]:
        """The known values at points of the box; exact at the limits."""
        return columns_of({n: (self.items[n].low, self.items[n].high) for n in self.kept}, u)

    def drawn(self, rng: np.random.Generator, count: int) -> Floats:
        """Points of the box by the coordinates' own distributions."""
        shares = [self._share(name, self.items[name].draws(rng, count)) for name in self.kept]
        return np.stack(shares, axis=1) if shares else np.empty((count, 0))

    # -- impacts

    def _rows(self, state: State) -> Any:
        """Functions, then walls of impacts, real or complex."""
        columns = [state.values["PN"]]  # for the shape
        for name in self.names:
            own = name in self.system.known and name in PARAMETERS
            value = state.values[name] if own else state[name]
            columns.append(_near(name, value, self.nominal.get(name)))
        columns += [state.quotient(name)[1] for name in self.ratios]
        for name in self.rest:
            columns.append(self._share(name, _near(name, state[name], self.items[name].nominal)))
        return np.stack(np.broadcast_arrays(*columns))[1:]

    def _found(self, x: Floats, state: State, usable: Flags) -> Point:
        self.progress(len(usable))
        columns = self._rows(state).T
        count = len(self.names) + len(self.ratios)
        functions, walls = columns[:, :count], columns[:, count:]
        usable = usable & np.isfinite(walls).all(axis=1)
        return x, functions, np.where(np.isfinite(walls), walls, -1e9), usable

    def from_nominal(self, u: Floats, guess: Floats | None = None) -> Point:
        """As `evaluate`, reached from the nominal impact, or from a ``guess`` of each, s x n."""
        data, geometry = self.data(u), None
        x = start = np.repeat(self.x, len(u), axis=1) if guess is None else guess
        if set(data) & set(GEOMETRY):
            geometry = Geometry({**self.system.constants, **data})
        residual = self._left(x, data, geometry)
        left = np.abs(residual).max(axis=0, initial=0.0)
        for more in reversed(range(CHORDS)):
            before = left
            x = x - self.inverse @ residual
            residual = self._left(x, data, geometry)
            left = np.abs(residual).max(axis=0, initial=0.0)
            # what is left over shrinks each time by the same factor
            if not ((left > SETTLED) & (left * (left / before) ** more <= SETTLED)).any():
                break
        settled = left <= SETTLED
        if not settled.all():
            wild = ~settled
            part = {n: column[wild] for n, column in data.items()}
            x[:, wild], settled[wild] = self._newton(part, start[:, wild])
        return self._found(x, self.system.state(x, data, geometry), settled)

    def functions(self, points: Floats) -> Floats:
        """The functions at any number of points, NaN where there is no impact."""
        found = []
        for first in range(0, len(points), CHUNK):
            _, functions, _, usable = self.from_nominal(points[first : first + CHUNK])
            found.append(np.where(usable[:, None], functions, np.nan))
        return np.concatenate(found)

    def evaluate(self, u: Floats, guess: Floats) -> Point:
        """`ascent.SearchProblem`."""
        data = self.data(u)
        x, settled = self._newton(data, guess)
        return self._found(x, self.system.state(x, data), settled)

    def _left(
        self, x: Floats, data: Mapping[str, Floats], geometry: Geometry | None = None
    ) -> Floats:
        return np.asarray(self.system.residuals(self.system.state(x, data, geometry), data))

    def _newton(self, data: Mapping[str, Floats], x: Floats) -> tuple[Floats, Flags]:
        """Impacts with the known values ``data`` by Newton's method from the impacts ``x``, and
        which of them meet all conditions. A point that comes no nearer a solution in three steps
        has none in reach."""
        x, count = x.copy(), x.shape[1]
        least, idle = np.full(count, np.inf), np.zeros(count, int)
        going = np.arange(count)
        for _ in range(NEWTONS):
            here, known = x[:, going], {name: column[going] for name, column in data.items()}
            residual, jacobian = self.system.linearize(here, self.system.residuals, known, known)
            left = np.abs(residual).max(axis=0, initial=0.0)
            idle = np.where(left < 0.5 * least, 0, idle + 1)
            least = np.fmin(least, left)
            more = (left > SETTLED) & (idle <= 3)
            going, least, idle = going[more], least[more], idle[more]
            if not len(going):
                break
            right = residual[:, more].T[:, :, None]
            step = _solved(jacobian[:, :, more].transpose(2, 0, 1), right)[:, :, 0]
            x[:, going] = here[:, more] - np.nan_to_num(step.T)
        return x, np.abs(self._left(x, data)).max(axis=0, initial=0.0) <= 100 * SETTLED

    def slopes(self, u: Floats, x: Floats) -> tuple[Floats, Floats, Floats]:
        """`ascent.SearchProblem`: by the derivatives of the conditions, without error."""
        system, data = self.system, self.data(u)
        jacobian = system.linearize(x, system.residuals, data, data)[1].transpose(2, 0, 1)
        moved: dict[str, Any] = {}
        for name, side in zip(self.kept, np.eye(len(self.kept))[:, :, None], strict=True):
            item = self.items[name]
            moved[name] = data[name] + 1j * COMPLEX_STEP * (item.high - item.low) * side
        still = x[:, None].astype(complex)
        left = np.imag(system.residuals(system.state(still, moved), moved)) / COMPLEX_STEP
        right = np.broadcast_to(left, (len(left), len(self.kept), len(u)))
        turns = -_solved(jacobian, right.transpose(2, 0, 1))
        state = system.state(still + 1j * COMPLEX_STEP * turns.transpose(1, 2, 0), moved)
        derivatives = np.nan_to_num(np.imag(self._rows(state)) / COMPLEX_STEP).transpose(2, 0, 1)
        count = len(self.names) + len(self.ratios)
        return derivatives[:, :count], derivatives[:, count:], turns

    def log_volume(self, u: Floats, x: Floats) -> Floats:
        """The logarithm, but for a constant, of how much of the space of velocities before,
        coefficients and vehicles a piece of the box takes up around its impacts: 0 where the known
        values do not determine all, or are taken for normal ones.

        With the laws L (Equations 15, 16 and 18), the impulse P and a coefficient c that is not
        known, |dL/dP| over |d(laws and known values)/d(velocities, P)| and each |dL/dc|."""
        if not (self.square and self.limited):
            return np.zeros(len(u))
        system, data = self.system, self.data(u)
        jacobian = system.linearize(x, system.residuals, data, data)[1]
        state = system.state(x, data)
        laws = [n for n in COEFFICIENTS if not (system.point and n == "EM")]
        values = {**state.values, **dict(zip(VELOCITIES, state.before, strict=True))}
        divided = np.zeros(len(u))
        for name in laws:
            if name not in system.known:
                values[name] = state[name]
                divided += np.log(np.abs(state.quotient(name)[1]))
        rows = []
        for name in IMPULSES[: len(laws)]:
            pushed = State({**values, name: values[name] + 1j * COMPLEX_STEP}, state.here)
            rows.append([np.broadcast_to(np.imag(pushed.law(n)), len(u)) for n in laws])
        forward = np.linalg.slogdet(np.array(rows).transpose(2, 0, 1) / COMPLEX_STEP)[1]
        inverse = np.linalg.slogdet(jacobian.transpose(2, 0, 1))[1]
        return np.asarray(forward - inverse - divided)

    # -- points within all walls

    def inside(self, rng: np.random.Generator) -> Floats:
        """Points of the box that lie within all walls; none where none was found."""
        points = latin_hypercube(len(self.kept), SCATTERED, rng)
        on_faces = rng.random(points.shape) < rng.choice([0.0, 0.5, 1.0], (SCATTERED, 1))
        points = np.concatenate([self.middle, np.where(on_faces, np.round(points), points)])
        x, _, walls, usable = self.from_nominal(points)
        outside = np.where(usable, np.abs(walls - 0.5).max(axis=1, initial=0.0) - 0.5, np.inf)
        good = outside <= CONSTRAINT_TOL
        if not self.rest or good.sum() >= SEEKERS:
            return points[good]
        nearest = np.argsort(outside, kind="stable")[:SEEKERS]
        nearest = nearest[np.isfinite(outside[nearest]) & ~good[nearest]]
        nobody = np.full(len(nearest), -1)
        u, _, _, _ = climb(
            *(self, points[nearest], x[:, nearest], nobody, np.ones(len(nearest))),
            np.full(len(nearest), CONSTRAINT_TOL),
        )
        _, _, walls, usable = self.from_nominal(u)
        reached = usable & (np.abs(walls - 0.5) <= 0.5 + CONSTRAINT_TOL).all(axis=1)
        return np.concatenate([points[good], u[reached]])

    def proper_density(self, u: Floats, x: Floats, walls: Floats) -> Floats:
        """`density` over the velocities before, the coefficients and the vehicles."""
        logarithm = self.density(u, walls) + self.log_volume(u, x)
        return np.where(np.isnan(logarithm), -np.inf, logarithm)

    def density(self, u: Floats, walls: Floats, beyond: Floats | float = 0.0) -> Floats:
        """The logarithm of all known values' density, but for a constant; ``beyond``: how far the
        walls are set back."""
        inside = (np.abs(u - 0.5) <= 0.5).all(1) & (np.abs(walls - 0.5) <= 0.5 + beyond).all(1)
        shares = np.clip(np.concatenate([u, walls], axis=1), 0.0, 1.0)
        logarithm = np.zeros(len(u))
        for item, share in zip(self.items.values(), shares.T, strict=True):
            if item.kind != "uniform":
                logarithm += item.log_density(item.low + share * (item.high - item.low))
        return np.where(inside, logarithm, -np.inf)


def _near(name: str, value: Floats, nominal: float | None) -> Floats:
    """A course or PDOF by full turns so that it is near the nominal one; else as it is."""
    if name not in DIRECTIONS or nominal is None:
        return value
    return np.asarray(value - 360 * np.round((np.real(value) - nominal) / 360))


def _walked(box: _Box, count: int, rng: np.random.Generator) -> tuple[Floats, Floats]:
    """``count`` points within all walls, by Markov chains, and the functions there; none where
    there is no such point."""
    begin = box.inside(rng)
    if not len(begin):
        return begin, np.empty((0, len(box.names)))
    chains, k = -(-count // WALKS), len(box.kept)
    # draws as without walls, and points between those inside: out of a corner hardly a step leads
    shares = rng.dirichlet(np.ones(4), chains)[:, :, None]
    between = (shares * begin[rng.integers(len(begin), size=(chains, 4))]).sum(axis=1)
    free = np.concatenate([box.drawn(rng, FREE), between, begin])
    x, functions, walls, usable = box.from_nominal(free)
    density = np.where(usable, box.proper_density(free, x, walls), -np.inf)
    # the draws' own density is in them already; one heavy weight would hold all chains
    among, weights = np.isfinite(density), np.zeros(len(free))
    more = density[among] - box.density(free[among], np.full_like(walls[among], 0.5))
    weights[among] = np.exp(more - more.max(initial=-np.inf))
    weights = np.minimum(weights, weights.sum() / np.sqrt(among.sum() or 1))
    if not weights.any():
        weights[-len(begin) :] = 1.0
    start = rng.choice(len(free), chains, p=weights / weights.sum())
    u, functions, density = free[start], functions[start], density[start]
    row, column = np.triu_indices(k)
    center = u[:1]

    def terms(points: Floats) -> Floats:
        off = points - center
        return np.concatenate([np.ones((len(off), 1)), off, off[:, row] * off[:, column]], axis=1)

    seen = usable & (np.abs(walls - 0.5) < NEAR).all(axis=1)
    met_at, met_there = free[seen], np.hstack([walls, x.T])[seen]
    walls, drawn, r = walls[start], [], len(box.rest)
    for walk in range(UNSEEN + WALKS):
        if walk <= LEARNT:
            # quadratic functions for walls and states, from those met
            matrix = terms(met_at)
            square = matrix.T @ matrix
            square += RIDGE * np.trace(square) / len(square) * np.eye(len(square))
            model = np.linalg.solve(square, matrix.T @ met_there)
            back = 1.1 * np.abs(walls - terms(u) @ model[:, :r]).max(axis=0)
            spread = np.cov(u.T).reshape(k, k) + 1e-6 * np.eye(k)
            root = np.linalg.cholesky(spread).T * 2.4 / np.sqrt(k)
        height = plain = box.density(u, terms(u) @ model[:, :r], back)
        v = u
        for pace in range(PACES):
            move = rng.standard_normal(v.shape) @ root
            if pace % 2:
                move *= rng.random(v.shape) < 0.3
            tried = v + move * np.exp(rng.standard_normal((chains, 1)))
            after = box.density(tried, terms(tried) @ model[:, :r], back)
            moved = -rng.standard_exponential(chains) < after - height
            v, height = np.where(moved[:, None], tried, v), np.where(moved, after, height)
        x, values, ahead, usable = box.from_nominal(v, (terms(v) @ model[:, r:]).T)
        after = np.where(usable, box.proper_density(v, x, ahead), -np.inf)
        moved = -rng.standard_exponential(chains) < (after - density) - (height - plain)
        u, walls = np.where(moved[:, None], v, u), np.where(moved[:, None], ahead, walls)
        functions, density = (
            np.where(moved[:, None], values, functions),
            np.where(moved, after, density),
        )
        if walk < LEARNT:
            # who started where hardly anybody comes follows one who has moved
            if moved.any():
                of = np.where(moved, np.arange(chains), rng.choice(np.flatnonzero(moved), chains))
                u, walls, functions, density = u[of], walls[of], functions[of], density[of]
            seen = usable & (np.abs(ahead - 0.5) < NEAR).all(axis=1)
            met_at = np.vstack([met_at, v[seen]])
            met_there = np.vstack([met_there, np.hstack([ahead, x.T])[seen]])
        elif walk >= UNSEEN:
            drawn.append((u, functions))
    points, values = (np.concatenate(part)[:count] for part in zip(*drawn, strict=True))
    return points, values


def _solved(matrices: Floats, right: Floats) -> Floats:
    """The solutions of n systems of equations, n x rows x columns, for several right sides each, n
    x rows x m; the least ones where a matrix is singular or not square, none (0) where it is not
    finite."""
    finite = np.asarray(np.isfinite(matrices).all(axis=(1, 2)) & np.isfinite(right).all((1, 2)))
    rows, columns = matrices.shape[1:]
    matrices = np.where(finite[:, None, None], matrices, np.eye(rows, columns))
    right = np.where(finite[:, None, None], right, 0.0)
    if rows == columns:
        with suppress(np.linalg.LinAlgError):  # one is singular
            return np.asarray(np.linalg.solve(matrices, right), np.float64)
    return np.asarray(np.linalg.pinv(matrices, rcond=_SINGULAR) @ right)


def _independent(solution: Reconstruction) -> tuple[list[str], list[str]]:
    """The values with a tolerance that determine the impact, and the redundant rest; the tightest
    first, so that few impacts fall outside the others' limits."""
    system = solution.system
    jacobian = system.jacobian(solution.x)
    count, names = len(system.conditions), system.observations
    inputs = (*GEOMETRY, *CRUSH)  # what is no quantity cannot be redundant

    def tightness(i: int) -> tuple[bool, float]:
        name = names[i]
        return name not in inputs, system.known[name].tolerance / system.scale(name)

    basis = jacobian[:count]
    rank, kept = _rank(basis), []
    for i in sorted(range(len(names)), key=tightness):
        row = jacobian[count + i]
        tried = np.vstack([basis, row / np.linalg.norm(row)])
        if names[i] in inputs or _rank(tried) > rank:
            basis, rank = tried, _rank(tried)
            kept.append(names[i])
    return [n for n in names if n in kept], [n for n in names if n not in kept]


def _rank(rows: Floats) -> int:
    return int(rows.shape[1] - pseudo_inverse(rows)[1].shape[1])


def _endless(box: _Box, known: Mapping[str, Uncertain], names: Sequence[str]) -> set[str]:
    """The quantities that nothing determines when E is 0, where it may be."""
    if "E" not in box.system.laws or not known["E"].low <= 0 <= known["E"].high:
        return set()
    nothing = System({**box.system.known, "E": fixed_value(0.0)}, adjusted=False)
    _, null = pseudo_inverse(nothing.jacobian(box.x))
    slopes = nothing.gradients(box.x, names)
    left_open = np.abs(slopes @ null).max(axis=1, initial=0.0)
    endless = left_open > 1e-7 * np.abs(slopes).max(axis=1, initial=0.0)
    return {name for name, without_end in zip(names, endless, strict=True) if without_end}
