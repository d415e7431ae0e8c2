"""Sequential quadratic programming over the unit cube, from many search points together.

A function of k coordinates, each from 0 to 1, with r constraints (functions that must stay from 0
to 1, too) is linearized within a trust region around each search point; the curvature of function
and constraints along the steps taken is learnt from their slopes (the symmetric rank-one update,
Conn, Gould and Toint, 1991), and what is concave of it bends the program. The programs are solved
by a primal-dual interior-point method. A step may leave the feasible region, as constraints are
curved: it is brought back along the normals of constraints (a second-order correction), and what it
gains counts less a penalty for what is exceeded, twice the largest multiplier. A step that is
better doubles the trust region, one that is not cuts it to a quarter."""

from dataclasses import dataclass, fields
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

RESTORATIONS = 5  # last steps of points that are still beyond limits
RESTORING_STEP = 1e-2  # and their length at most, per coordinate
MAX_STEP = 0.5  # largest trust-region radius, per coordinate
MIN_STEP = 1e-7  # a search point has converged when its trust region is smaller
CONSTRAINT_TOL = 1e-9  # a constraint exceeded by no more counts as met
HELD_TOL = 1e-6  # a constraint predicted so near an end is held there
MAX_ROUNDS = 60  # steps of a search point
# Rounds of all searches for an extreme; then the best of them goes on alone. Nearly all that reach
# the extreme have converged by then.
ROUNDS_OF_ALL = 20
ABANDONED = -1.0  # trust region of a search that does not go on
# Cosine between a step and the change of gradient that is missing; with less nothing is learnt
LEAST_CURVATURE = 1e-8
GRADIENT_TOL = 1e-9  # relative; smaller changes of a gradient are rounding
MAX_BARRIER_ITERATIONS = 30  # interior-point method: each cuts the gap to about a fifth
MAX_COMPLEMENTARITY = 1e-11  # it stops below
RIDGE = 1e-14  # relative; rounding leaves matrices singular where constraints depend on one another


class SearchProblem(Protocol):
    """A search problem: m functions and r constraints over k coordinates.

    ``states`` are solutions that the problem carries along with each point, for instance the
    starting values of an iteration that evaluates it."""

    def evaluate(self, u: Array, guess: Array) -> tuple[Array, Array, Array, Flags]:
        """Evaluate points ``u`` (n x k), starting from the states ``guess`` (s x n). Return the
        states there (s x n), the functions (n x m), the constraints (n x r), and True for each
        point that could be evaluated."""

    def slopes(self, u: Array, x: Array) -> tuple[Array, Array, Array]:
        """Return the derivatives of functions (n x m x k), constraints (n x r x k) and states (n x
        s x k) over the coordinates."""


def climb(
    problem: SearchProblem,
    u: Array,
    x: Array,
    index: NDArray[np.intp],
    sense: Array,
    min_gain: Array,
    reach: Array | float = MAX_STEP,
) -> tuple[Array, Array, Array, Flags]:
    """Maximize or minimize a function from each of c search points.

    ``u`` (c x k) and ``x`` (s x c): the points to start from and their states. ``index``: which
    function each optimizes. ``sense``: +1 maximizes, -1 minimizes. ``min_gain``: stop where the
    model promises less. ``reach``: the initial trust-region radius of each.

    Return coordinates, states and all functions at the end, and True for each point that
    converged."""
    search = _Climb(problem, u, x, index, sense, reach)
    for round_number in range(MAX_ROUNDS):
        if round_number == ROUNDS_OF_ALL:
            search.keep_best()
        if not search.advance(min_gain):
            break
    search.restore()
    return search.u, search.x, search.functions, (search.reach >= 0) & (search.reach < MIN_STEP)


class _Climb:
    """Search points, one row each: where they are (``u``, states ``x``), what they have there, how
    far their model is trusted (``reach``), and what is learnt of the ``curvature``."""

    def __init__(
        self,
        problem: SearchProblem,
        u: Array,
        x: Array,
        index: NDArray[np.intp],
        sense: Array,
        reach: Array | float,
    ) -> None:
        self.problem, self.index, self.sense = problem, index, sense
        self.x, self.functions, self.constraints, usable = problem.evaluate(u, x)
        self.u, (count, dimensions) = u.copy(), u.shape
        self.reach = np.where(usable, reach, 0.0)
        self.curvature = np.zeros((count, dimensions, dimensions))
        self.steps = np.zeros((count, dimensions))
        self.gradients = np.zeros((count, dimensions))
        self.multipliers = np.zeros((count, self.constraints.shape[1]))
        self.penalty = np.zeros(count)

    def advance(self, min_gain: Array) -> bool:
        """Take one step from each point that has not converged; return False if there is none."""
        active = np.flatnonzero(self.reach >= MIN_STEP)
        if not active.size or not self.u.shape[1]:
            self.reach[:] = 0.0
            return False
        slopes, constraint_slopes, state_slopes = self.problem.slopes(
            self.u[active], self.x[:, active]
        )
        rows = np.arange(len(active))
        objective = self.sense[active, None] * slopes[rows, self.index[active]]
        self._learn(active, objective, constraint_slopes)
        programs = self._programs(active, objective, constraint_slopes, self.curvature[active])
        step, multipliers = programs.solve()
        predicted_gain = (objective * step).sum(axis=1)
        largest = np.abs(multipliers).max(axis=1, initial=0.0)
        self.penalty[active] = np.maximum(self.penalty[active], 2 * largest)
        u = np.clip(self.u[active] + step, 0.0, 1.0)
        change = np.einsum("csk,ck->sc", state_slopes, u - self.u[active])
        reached = self.problem.evaluate(u, self.x[:, active] + change)
        self._correct(active, u, reached, step, constraint_slopes)
        lagrangian = objective - np.einsum("cr,crk->ck", multipliers, constraint_slopes)
        better = self._accept(active, u, reached)
        self.multipliers[active[better]] = multipliers[better]
        self.gradients[active[better]] = lagrangian[better]
        # the model predicts no further gain
        is_inside = excess(self.constraints[active]).max(axis=1, initial=0.0) <= CONSTRAINT_TOL
        self.reach[active[(predicted_gain <= min_gain[active]) & is_inside]] = 0.0
        return True

    def _correct(
        self,
        active: NDArray[np.intp],
        u: Array,
        reached: tuple[Array, Array, Array, Flags],
        step: Array,
        rows: Array,
    ) -> None:
        """Bring trial points ``u`` that have left the feasible region back along its normals, where
        that is better: a second-order correction. Constraints are curved, and without it steps
        along them are as short as the least radius."""
        x, functions, constraints, usable = reached
        beyond = np.flatnonzero(
            usable & (excess(constraints).max(axis=1, initial=0.0) > CONSTRAINT_TOL)
        )
        if not beyond.size:
            return
        own = active[beyond]
        predicted = self.constraints[own] + np.einsum("crk,ck->cr", rows[beyond], step[beyond])
        ends = np.where(predicted > 0.5, 1.0, 0.0)
        is_held = (np.abs(predicted - ends) < HELD_TOL) | (excess(constraints[beyond]) > 0)
        ends = np.where(excess(constraints[beyond]) > 0, np.clip(constraints[beyond], 0, 1), ends)
        is_free = (u[beyond] > 0) & (u[beyond] < 1)
        normals = rows[beyond] * is_held[:, :, None] * is_free[:, None]
        products = normals @ normals.swapaxes(1, 2)
        diagonal = np.einsum("crr->cr", products)
        diagonal += np.where(is_held, 1e-12 * diagonal.max(axis=1, keepdims=True), 1.0)
        diagonal += np.where(diagonal > 0, 0.0, 1.0)
        missing = np.where(is_held, ends - constraints[beyond], 0.0)
        corrections = np.einsum(
            "crk,cr->ck", normals, np.linalg.solve(products, missing[:, :, None])[:, :, 0]
        )
        trial = np.clip(u[beyond] + corrections, 0.0, 1.0)
        corrected = self.problem.evaluate(trial, x[:, beyond])
        better = corrected[3] & (
            self._merit(own, corrected[1], corrected[2])
            > self._merit(own, functions[beyond], constraints[beyond])
        )
        moved = beyond[better]
        u[moved], x[:, moved] = trial[better], corrected[0][:, better]
        functions[moved], constraints[moved] = corrected[1][better], corrected[2][better]

    def restore(self) -> None:
        """Move the points that are still beyond limits by the least steps that meet them."""
        for _ in range(RESTORATIONS):
            beyond = excess(self.constraints).max(axis=1, initial=0.0)
            active = np.flatnonzero(beyond > CONSTRAINT_TOL)
            if not active.size:
                break
            _, rows, _ = self.problem.slopes(self.u[active], self.x[:, active])
            nowhere, dimensions = np.zeros_like(self.u[active]), self.u.shape[1]
            self.reach[active] = np.maximum(self.reach[active], RESTORING_STEP)
            nearness = np.broadcast_to(np.eye(dimensions), (len(active), dimensions, dimensions))
            step, _ = self._programs(active, nowhere, rows, nearness).solve()
            u = np.clip(self.u[active] + step, 0.0, 1.0)
            x, functions, constraints, usable = self.problem.evaluate(u, self.x[:, active])
            better = usable & (excess(constraints).max(axis=1, initial=0.0) < beyond[active])
            moving = active[better]
            self.u[moving], self.x[:, moving] = u[better], x[:, better]
            self.functions[moving], self.constraints[moving] = (
                functions[better],
                constraints[better],
            )

    def keep_best(self) -> None:
        """End all searches but the best for each function and sense."""
        values = self._merit(np.arange(len(self.u)), self.functions, self.constraints)
        order = np.lexsort((-values, self.sense, self.index))
        goals = np.stack([self.index, self.sense])[:, order]
        is_best = np.append(True, (goals[:, 1:] != goals[:, :-1]).any(axis=0))
        self.reach[order[~is_best]] = ABANDONED

    def _learn(self, active: NDArray[np.intp], objective: Array, rows: Array) -> None:
        """Correct the curvature of the Lagrangian by how its gradient has changed along the last
        step."""
        multipliers = self.multipliers[active]
        gradient = objective - np.einsum("cr,crk->ck", multipliers, rows)
        step = self.steps[active]
        missing = (self.gradients[active] - gradient) - np.einsum(
            "ckl,cl->ck", self.curvature[active], step
        )
        along, size = (missing * step).sum(axis=1), np.linalg.norm(missing, axis=1)
        learns = np.abs(along) > LEAST_CURVATURE * size * np.linalg.norm(step, axis=1)
        learns &= size > GRADIENT_TOL * np.linalg.norm(gradient, axis=1)
        update = (
            missing[:, :, None] * missing[:, None] / np.where(learns, along, 1.0)[:, None, None]
        )
        self.curvature[active[learns]] += update[learns]
        self.steps[active] = 0.0

    def _programs(
        self, active: NDArray[np.intp], objective: Array, rows: Array, curvature: Array
    ) -> "_Programs":
        start, constraints = self.u[active], self.constraints[active]
        reach = self.reach[active, None]
        values, vectors = np.linalg.eigh(curvature)
        concave = (vectors * np.maximum(values, 0.0)[:, None]) @ vectors.swapaxes(1, 2)
        low, high = np.maximum(-start, -reach), np.minimum(1 - start, reach)
        # what is exceeded is to be met, as far as the trust region reaches
        lowest, highest = (
            np.einsum("crk,ck->cr", np.maximum(rows, 0.0), first)
            + np.einsum("crk,ck->cr", np.minimum(rows, 0.0), second)
            for first, second in ((low, high), (high, low))
        )
        below = np.minimum(-constraints, 0.5 * highest)
        above = np.maximum(1 - constraints, 0.5 * lowest)
        return _Programs(objective, concave, low, high, rows, below, above)

    def _accept(
        self, active: NDArray[np.intp], u: Array, reached: tuple[Array, Array, Array, Flags]
    ) -> Flags:
        """Move to the points ``u`` that are better: by what is maximized, less a penalty for what
        is beyond limits. Return True for each."""
        x, functions, constraints, usable = reached
        before = self._merit(active, self.functions[active], self.constraints[active])
        better = usable & (self._merit(active, functions, constraints) > before)
        moving = active[better]
        self.steps[moving] = (u - self.u[active])[better]
        self.u[moving], self.x[:, moving] = u[better], x[:, better]
        self.functions[moving], self.constraints[moving] = functions[better], constraints[better]
        reach = self.reach[active]
        self.reach[active] = np.where(better, np.minimum(2 * reach, MAX_STEP), reach / 4)
        return np.asarray(better)

    def _merit(self, active: NDArray[np.intp], functions: Array, constraints: Array) -> Array:
        rows = np.arange(len(active))
        values = self.sense[active] * functions[rows, self.index[active]]
        return np.asarray(values - self.penalty[active] * excess(constraints).sum(axis=1))


def replace_nonfinite(values: Array) -> Array:
    """Return ``values`` with -inf in place of all that are not finite."""
    return np.where(np.isfinite(values), values, -np.inf)


def excess(constraints: Array) -> Array:
    """Return by how much constraints are beyond their limits, 0 within."""
    return np.asarray(np.maximum(np.maximum(-constraints, constraints - 1), 0.0))


@dataclass(frozen=True)
class _Programs:
    """c concave quadratic programs of one size: maximize ``objectives`` (c x k) times a step, less
    half of ``curvatures`` (c x k x k) times it twice, between ``low`` and ``high``, while ``rows``
    (c x r x k) times the step stays between ``below`` and ``above``."""

    objectives: Array
    curvatures: Array
    low: Array
    high: Array
    rows: Array
    below: Array
    above: Array

    def chosen(self, which: Flags) -> "_Programs":
        """Return some of the programs."""
        return _Programs(*(getattr(self, part.name)[which] for part in fields(self)))

    def solve(self) -> tuple[Array, Array]:
        """Return the steps (c x k) and the multipliers of the rows (c x r). A program without a
        solution gets any step within ``low`` and ``high``."""
        steps = np.where(self.objectives > 0, self.high, np.where(self.objectives < 0, self.low, 0))
        multipliers = np.zeros(self.below.shape)
        row_values = np.einsum("crk,ck->cr", self.rows, steps)
        is_limited = ((row_values < self.below) | (row_values > self.above)).any(axis=1)
        is_limited |= self.curvatures.any(axis=(1, 2))
        if is_limited.any():
            limited = self.chosen(is_limited)
            steps[is_limited], multipliers[is_limited] = limited._by_interior_points()
        return steps, multipliers

    def _by_interior_points(self) -> tuple[Array, Array]:
        """Solve all by a primal-dual interior-point method.

        In units of the trust region each program is: maximize g·y - y·B y / 2 subject to A y + s =
        b, s >= 0, with multipliers z >= 0. Newton's method is applied to B y + A^T z = g, A y + s =
        b and s z = mu, with mu a tenth of the mean of s z; steps end 1 % before a slack or
        multiplier reaches 0."""
        count, row_count, dimensions = self.rows.shape
        size = np.abs(self.objectives).max(axis=1, keepdims=True)
        size = np.where(size > 0, size, 1.0)
        unit = np.maximum(self.high, -self.low).max(axis=1)[:, None]
        objectives = self.objectives / size
        curvatures = self.curvatures * (unit / size)[:, :, None]
        identity = np.broadcast_to(np.eye(dimensions), (count, dimensions, dimensions))
        half = np.concatenate([identity, self.rows], axis=1)
        matrix = np.concatenate([half, -half], axis=1)
        transposed = np.ascontiguousarray(matrix.swapaxes(1, 2))
        ends = [self.high, self.above, -self.low, -self.below]
        limits = np.concatenate(ends, axis=1) / unit
        step = 0.5 * (self.low + self.high) / unit
        upper, lower = np.split(limits, 2, axis=1)
        width = np.maximum(upper + lower, 1e-12)
        widths = np.concatenate([width, width], axis=1)
        slacks = np.clip(limits - _times(matrix, step), 0.1 * widths, widths)
        multipliers = 1 / np.maximum(slacks, 0.1)
        for _ in range(MAX_BARRIER_ITERATIONS):
            target_product = 0.1 * (slacks * multipliers).mean(axis=1)[:, None]
            running = target_product > MAX_COMPLEMENTARITY
            if not running.any():
                break
            residual = limits - _times(matrix, step) - slacks
            terms = (target_product - multipliers * residual) / slacks
            right_side = objectives - _times(curvatures, step) - _times(transposed, terms)
            normal = transposed @ (matrix * (multipliers / slacks)[:, :, None]) + curvatures
            finite = np.isfinite(normal).all(axis=(1, 2)) & np.isfinite(right_side).all(axis=1)
            normal[~finite], right_side[~finite] = np.eye(dimensions), 0.0
            # in units of its diagonal, and with RIDGE on that, no matrix is singular
            scale = 1 / np.sqrt(np.einsum("ckk->ck", normal))
            normal = normal * scale[:, :, None] * scale[:, None] + RIDGE * np.eye(dimensions)
            right_side = (right_side * scale)[:, :, None]
            newton_step = scale * np.linalg.solve(normal, right_side)[:, :, 0]
            slack_step = residual - _times(matrix, newton_step)
            multiplier_step = (target_product - multipliers * (slacks + slack_step)) / slacks
            primal_length = running * _fraction_to_zero(slacks, slack_step)
            dual_length = running * _fraction_to_zero(multipliers, multiplier_step)
            step = step + primal_length * newton_step
            slacks = slacks + primal_length * slack_step
            multipliers = multipliers + dual_length * multiplier_step
        of_rows = multipliers[:, dimensions : dimensions + row_count]
        of_rows = of_rows - multipliers[:, 2 * dimensions + row_count :]
        steps = np.clip(np.nan_to_num(step * unit), self.low, self.high)
        return np.asarray(steps), np.asarray(np.nan_to_num(of_rows * size))


def _times(matrices: Array, vectors: Array) -> Array:
    """Return the products of c matrices and c vectors."""
    return np.asarray((matrices @ vectors[:, :, None])[:, :, 0])


def _fraction_to_zero(values: Array, changes: Array) -> Array:
    """Return the largest fraction of the changes, up to 1, that keeps all values positive."""
    fractions = np.where(changes < 0, -values / np.where(changes < 0, changes, -1.0), np.inf)
    return np.asarray(np.minimum(1.0, 0.99 * fractions.min(axis=1))[:, None])
