"""How uncertain a reconstruction is: draws of what is known, and bounds, beside the first order.

A reconstruction without redundancy is a function of its known values: each draw, and each place of
the box that their limits span, is solved for itself, by iterations with the inverse Jacobian of the
nominal solution (one where only measured velocities vary, a few where coefficients or geometry do)
and by Newton's method where those do not settle. With redundancy each draw is adjusted as the
measured values are; bounds are sought over the impacts that lie within *all* limits.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..names import COEFFICIENTS
from ..reconstruction.adjustment import (
    PARAMETERS,
    Reconstruction,
    System,
    pseudo_inverse,
    tolerance,
)
from ..reconstruction.geometry import NAMES as GEOMETRY
from ..reconstruction.geometry import Geometry
from ..reconstruction.state import State
from .extremes import Piece, extremes
from .uncertain import Uncertain

Floats = NDArray[np.float64]

CHUNK = 1 << 14
CHORDS = 8
NEWTONS = 12
IDLE = 3
"""Steps without the half of what was left over, and no solution is in reach."""
SETTLED = 1e-11
"""Scaled conditions below count as met by a draw."""
ADJUSTMENTS = 12
ADJUSTED = 1e-10
"""A step so short, scaled, is the last."""
DAMPING = 1e-12
"""Of the largest square of a slope: holds still what next to nothing determines."""
SCATTERED = 1024
LEAST_GAIN = 1e-7
"""For the search for bounds: each of its impacts takes a dozen iterations."""
_SINGULAR = 1e-12
"""Singular values of so little of the largest are none."""
_GROWS = 1e10
"""A solution so much larger than its right side may be a singular matrix's."""


@dataclass(frozen=True)
class Draws:
    """``values``: each quantity's draws, NaN where one has no solution; ``failed``: their share."""

    values: dict[str, Floats]
    failed: float


@dataclass(frozen=True)
class Range:
    """Lowest and highest value found of a quantity, and the known values that give them; NaN where
    no impact was found within all limits, infinite where E = 0 lies within its limits, or what a
    coefficient is divided by may be 0."""

    lower: float
    upper: float
    at_lower: dict[str, float]
    at_upper: dict[str, float]


def draws(
    solution: Reconstruction,
    names: Sequence[str],
    count: int,
    seed: int = 0,
    progress: Callable[[int], object] = lambda draws: None,
) -> Draws:
    """``count`` random draws of what is known, each reconstructed: the quantities ``names``."""
    rng = np.random.default_rng([seed, 1])
    known = solution.system.known
    varying = solution.system.observations
    solver = _Adjusting(solution) if solution.redundancy else _Solving(solution, known)
    values = {name: np.empty(count) for name in names}
    for first in range(0, count, CHUNK):
        part = slice(first, min(first + CHUNK, count))
        data = {name: known[name].draws(rng, part.stop - part.start) for name in varying}
        state, usable = solver(data)
        for name in names:
            values[name][part] = np.where(usable, _quantity(state, known, name), np.nan)
        progress(part.stop - part.start)
    failed = np.isnan(np.stack(list(values.values()))).any(axis=0) if names else np.zeros(1)
    return Draws(values, float(failed.mean()))


def ranges(
    solution: Reconstruction, names: Sequence[str], sigmas: float = 3.0, seed: int = 0
) -> dict[str, Range]:
    """The lowest and highest value of each quantity over the limits of what is known."""
    known = solution.system.known
    kept, rest = _independent(solution)
    solver = _Solving(solution, {n: item for n, item in known.items() if n not in rest})
    limits = {name: known[name].limits(sigmas) for name in (*kept, *rest)}
    endless = _endless(solver, known, names)
    ratios = [name for name in names if name in COEFFICIENTS and name not in known]

    def data_at(points: Floats) -> dict[str, Floats]:
        columns = {}
        for i, name in enumerate(kept):
            low, high = limits[name]
            columns[name] = np.where(points[:, i] < 1, low + points[:, i] * (high - low), high)
        return columns

    def impacts(points: Floats) -> tuple[State, NDArray[np.bool_]]:
        state, usable = solver(data_at(points))
        return state, np.broadcast_to(usable, len(points))  # one where nothing is left to vary

    def outputs(points: Floats) -> Floats:
        state, usable = impacts(points)
        with np.errstate(all="ignore"):
            columns = [_quantity(state, known, name) for name in names]
        columns += [state.divisor(name) for name in ratios]
        broad = [np.broadcast_to(column, usable.shape) for column in columns]
        return np.where(usable[:, None], np.stack(broad, axis=1), np.nan)

    def within(points: Floats) -> Floats:
        """How far inside the redundant values' limits, of their widths."""
        state, usable = impacts(points)
        inside = np.full(len(points), 1.0)
        for name in rest:
            low, high = limits[name]
            nearest = np.minimum(state[name] - low, high - state[name]) / (high - low)
            inside = np.minimum(inside, nearest + 1e-9)
        return np.where(usable & ~np.isnan(inside), inside, -1.0)

    adjusted = {item.name: item.adjusted for item in solution.adjusted}
    nominal = [(adjusted[n] - limits[n][0]) / (limits[n][1] - limits[n][0]) for n in kept]
    searched = extremes(
        Piece(
            _each_once(outputs),
            len(names),
            _each_once(within) if rest else None,
        ),
        len(kept),
        np.random.default_rng([seed, 0]),
        known=np.clip(np.array([nominal]), 0.0, 1.0),
        scattered=SCATTERED,
        least_gain=LEAST_GAIN,
    )

    def inputs(point: Floats) -> dict[str, float]:
        return {name: float(column[0]) for name, column in data_at(point[None]).items()}

    return {
        name: Range(-np.inf, np.inf, {}, {})
        if name in endless
        else Range(
            float(searched.lower[i]),
            float(searched.upper[i]),
            inputs(searched.at_lower[i]),
            inputs(searched.at_upper[i]),
        )
        for i, name in enumerate(names)
    }


def _each_once(function: Callable[[Floats], Floats]) -> Callable[[Floats], Floats]:
    """Climbers on one corner, or before a face, try the same points."""

    def once(points: Floats) -> Floats:
        if not points.shape[1]:
            return function(points)
        different, of = np.unique(points, axis=0, return_inverse=True)
        return function(different)[np.ravel(of)]

    return once


def _quantity(state: State, known: Mapping[str, Uncertain], name: str) -> Floats:
    """A quantity of drawn impacts; a coefficient that is known is what was drawn."""
    value: Floats = state.values[name] if name in known and name in state.values else state[name]
    return value


class _Solving:
    """Impacts from known values, as many as unknowns: n of each -> n impacts."""

    def __init__(self, solution: Reconstruction, known: Mapping[str, Uncertain]) -> None:
        self.system = System(known, adjusted=False)
        adjusted = solution.system.state(solution.x)
        names, scales = self.system.variables, self.system.scales
        self.x = np.array(
            [np.ravel(adjusted[n])[0] / scale for n, scale in zip(names, scales, strict=True)]
        ).reshape(-1, 1)
        jacobian = self.system.jacobian(self.x, self.system.left)[:, :, 0]
        self.inverse, null = pseudo_inverse(jacobian)
        self.square = jacobian.shape[0] == jacobian.shape[1] and not null.shape[1]

    def __call__(self, data: Mapping[str, Floats]) -> tuple[State, NDArray[np.bool_]]:
        """The impacts, and which of them meet all conditions."""
        geometry = None
        if set(data) & set(GEOMETRY):
            geometry = Geometry.of({**self.system.constants, **data})
        with np.errstate(all="ignore"):
            if self.system.linear and self.square and set(data) & set(PARAMETERS):
                x = self._linear(data, geometry)
                settled = np.asarray(np.isfinite(x).all(axis=0))
            else:
                x, settled = self._chords(data, geometry)
        return self.system.state(x, data, geometry), settled

    def _linear(self, data: Mapping[str, Floats], geometry: Geometry | None) -> Floats:
        """The conditions are linear in the variables: their matrix, column by column, and right
        side are what they leave over of unit vectors and of none."""
        count, size = len(next(iter(data.values()))), len(self.x)
        none = np.zeros((size, 1))
        right = np.broadcast_to(self.left(none, data, geometry), (size, count))
        matrices = np.empty((count, size, size))
        for i in range(size):
            unit = none.copy()
            unit[i] = 1.0
            matrices[:, :, i] = (self.left(unit, data, geometry) - right).T
        return -_solved(matrices, right.T).T

    def _chords(
        self, data: Mapping[str, Floats], geometry: Geometry | None
    ) -> tuple[Floats, NDArray[np.bool_]]:
        count = len(next(iter(data.values()))) if data else 1
        x = np.repeat(self.x, count, axis=1)
        residual = self.left(x, data, geometry)
        left = np.abs(residual).max(axis=0, initial=0.0)
        for more in reversed(range(CHORDS)):
            before = left
            x = x - self.inverse @ residual
            residual = self.left(x, data, geometry)
            left = np.abs(residual).max(axis=0, initial=0.0)
            # what is left over shrinks each time by the same factor
            if not ((left > SETTLED) & (left * (left / before) ** more <= SETTLED)).any():
                break
        settled = left <= SETTLED
        if not settled.all():
            wild = np.broadcast_to(~settled, (count,))
            x[:, wild] = self._newton({n: column[wild] for n, column in data.items()}, wild.sum())
            residual = self.left(x, data, geometry)
            settled = np.abs(residual).max(axis=0, initial=0.0) <= 100 * SETTLED
        return x, np.broadcast_to(settled, (count,))

    def left(
        self, x: Floats, data: Mapping[str, Floats], geometry: Geometry | None = None
    ) -> Floats:
        return np.asarray(self.system.left(self.system.state(x, data, geometry), data))

    def _newton(self, data: Mapping[str, Floats], count: int) -> Floats:
        """The same by Newton's method, from the nominal impact. A point that comes no nearer a
        solution for a while has none in reach."""
        x = np.repeat(self.x, count, axis=1)
        least, idle = np.full(count, np.inf), np.zeros(count, int)
        going = np.arange(count)
        for _ in range(NEWTONS):
            here, known = x[:, going], {name: column[going] for name, column in data.items()}
            residual, jacobian = self.system.linearized(here, self.system.left, known, known)
            left = np.abs(residual).max(axis=0, initial=0.0)
            idle = np.where(left < 0.5 * least, 0, idle + 1)
            least = np.fmin(least, left)
            more = (left > SETTLED) & (idle <= IDLE)
            going, least, idle = going[more], least[more], idle[more]
            if not len(going):
                break
            step = _solved(jacobian[:, :, more].transpose(2, 0, 1), residual[:, more].T).T
            x[:, going] = here[:, more] - np.nan_to_num(step)
        return x


class _Adjusting:
    """Impacts adjusted to measured values: n of each -> n impacts."""

    def __init__(self, solution: Reconstruction) -> None:
        self.system, self.x = solution.system, solution.x

    def __call__(self, data: Mapping[str, Floats]) -> tuple[State, NDArray[np.bool_]]:
        system, count = self.system, len(self.system.conditions)
        x = np.repeat(self.x, len(next(iter(data.values()))), axis=1)
        size, going = len(system.variables), np.arange(x.shape[1])
        with np.errstate(all="ignore"):
            for _ in range(ADJUSTMENTS):
                targets = {name: column[going] for name, column in data.items()}
                residual, slopes = system.linearized(x[:, going], system.left, targets=targets)
                jacobian = slopes.transpose(2, 0, 1)
                exact, loose = jacobian[:, :count], jacobian[:, count:]
                # tight tolerances must not drown the conditions
                weight = np.abs(loose).max(axis=(1, 2), initial=1e-300)
                loose = loose / weight[:, None, None]
                # Lagrange: the normal equations bordered with the conditions
                bordered = np.zeros((len(going), size + count, size + count))
                normal = loose.transpose(0, 2, 1) @ loose
                bordered[:, :size, :size] = normal + DAMPING * np.eye(size)
                bordered[:, :size, size:] = exact.transpose(0, 2, 1)
                bordered[:, size:, :size] = exact
                right = np.zeros((len(going), size + count))
                right[:, :size] = np.einsum("nji,jn->ni", loose, residual[count:] / weight)
                right[:, size:] = residual[:count].T
                step = _solved(bordered, right).T[:size]
                x[:, going] -= step
                going = going[np.abs(step).max(axis=0, initial=0.0) > ADJUSTED]
                if not len(going):
                    break
            state = system.state(x)
            met = np.abs(system.left(state, data)[:count]).max(axis=0, initial=0.0) <= 1e-9
        return state, np.broadcast_to(met, x.shape[1:])


def _solved(matrices: Floats, right: Floats) -> Floats:
    """The solutions of so many systems of equations; the least ones where a matrix is singular or
    not square, none (0) where it is not finite."""
    finite = np.asarray(np.isfinite(matrices).all(axis=(1, 2)))
    matrices = np.where(finite[:, None, None], matrices, np.eye(*matrices.shape[1:]))
    right = np.where(finite[:, None], right, 0.0)
    rows, columns = matrices.shape[1:]
    if rows > columns:
        return _least(matrices, right)
    if rows < columns:  # the least solution lies in the rows' space
        across = matrices.transpose(0, 2, 1)
        solution = (across @ _eliminated(matrices @ across, right)[:, :, None])[:, :, 0]
        missed = np.abs((matrices @ solution[:, :, None])[:, :, 0] - right).max(axis=1)
        far = ~(missed <= 1e-6 * np.abs(right).max(axis=1))
    else:
        solution = _eliminated(matrices, right)
        size = np.abs(matrices).max(axis=(1, 2), initial=0.0)
        grown = size * np.abs(solution).max(axis=1, initial=0.0)
        far = ~(grown <= _GROWS * np.abs(right).max(axis=1, initial=0.0))
    if far.any():
        solution[far] = _least(matrices[far], right[far])
    return np.asarray(solution, np.float64)


def _eliminated(matrices: Floats, right: Floats) -> Floats:
    """The solutions by elimination, NaN where a matrix is singular: one must not cost the others
    theirs."""
    solution = np.full(right.shape, np.nan)
    try:
        solution[:] = np.linalg.solve(matrices, right[:, :, None])[:, :, 0]
    except np.linalg.LinAlgError:
        regular = np.linalg.slogdet(matrices)[0] != 0  # the same elimination, which raises nothing
        solution[regular] = np.linalg.solve(matrices[regular], right[regular, :, None])[:, :, 0]
    return solution


def _least(matrices: Floats, right: Floats) -> Floats:
    """The least solutions, of the equations that a singular matrix leaves."""
    product: Floats = (np.linalg.pinv(matrices, rcond=_SINGULAR) @ right[:, :, None])[:, :, 0]
    return product


def _independent(solution: Reconstruction) -> tuple[list[str], list[str]]:
    """The values with a tolerance that determine the impact, and the redundant rest; the tightest
    first, so that few impacts fall outside the others' limits."""
    system = solution.system
    jacobian = system.jacobian(solution.x, system.left)[:, :, 0]
    count = len(system.conditions)
    basis = jacobian[:count]
    order = sorted(
        range(len(system.observations)),
        key=lambda i: (
            system.observations[i] not in GEOMETRY,
            tolerance(system.known[system.observations[i]]) / system.scale(system.observations[i]),
        ),
    )
    rank = _rank(basis)
    kept, rest = [], []
    for i in order:
        row = jacobian[count + i]
        tried = np.vstack([basis, row / np.linalg.norm(row)])
        if system.observations[i] in GEOMETRY:  # what is no quantity cannot be redundant
            kept.append(i)
            basis, rank = tried, _rank(tried)
        elif _rank(tried) > rank:
            basis, rank = tried, rank + 1
            kept.append(i)
        else:
            rest.append(i)
    names = system.observations
    return [names[i] for i in sorted(kept)], [names[i] for i in sorted(rest)]


def _rank(rows: Floats) -> int:
    return rows.shape[1] - pseudo_inverse(rows)[1].shape[1]


def _endless(
    solver: _Solving, known: Mapping[str, Uncertain], names: Sequence[str]
) -> tuple[str, ...]:
    """The quantities that nothing determines when E is 0, where it may be."""
    system = solver.system
    if "E" not in system.laws or not known["E"].low <= 0 <= known["E"].high:
        return ()
    nothing = System({**system.known, "E": Uncertain("fixed", 0.0, 0.0, 0.0)}, adjusted=False)
    _, null = pseudo_inverse(nothing.jacobian(solver.x, nothing.left)[:, :, 0])
    if not null.shape[1]:
        return ()
    gradients = {name: nothing.gradient(solver.x, name) for name in names}
    return tuple(
        name
        for name, slope in gradients.items()
        if np.abs(slope @ null).max() > 1e-7 * np.abs(slope).max(initial=0.0)
    )
