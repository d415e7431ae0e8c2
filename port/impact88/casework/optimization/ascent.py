"""Sequential linear programming over the unit cube, from many search points together.

A function of k coordinates, each from 0 to 1, with r constraints (functions that must stay from 0
to 1, too) is linearized within a trust region around each search point. The linear programs that
remain are solved by a primal-dual interior-point method. Where a step leaves the feasible region
because the constraints are curved, the program is solved again with the curvature added to its
limits (a second-order correction). A step that improves the function doubles the trust region, one
that does not cuts it to a quarter."""

from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

# Chosen on 26 problems of bounds. Doubling any of these moves no bound by 1e-4 of its range, but
# for MAX_ROUNDS.
MAX_STEP = 0.5  # initial and largest trust-region radius, per coordinate
MIN_STEP = 1e-7  # a search point has converged when its trust region is smaller
CONSTRAINT_TOL = 1e-9  # a constraint exceeded by no more counts as met
# A vertex takes about ten rounds, a curved constraint twenty to forty. Twice as many move one
# bound by 2e-4 of its range.
MAX_ROUNDS = 80
# Second-order corrections of a step. With a single one, bounds of reconstructions are up to 8 %
# narrower.
MAX_CORRECTIONS = 3
MAX_BARRIER_ITERATIONS = 30  # interior-point method: each cuts the gap to about a fifth
MAX_COMPLEMENTARITY = 1e-11  # it stops below


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
) -> tuple[Array, Array, Array, Flags]:
    """Maximize or minimize a function from each of c search points, by sequential linear
    programming.

    ``u`` (c x k) and ``x`` (s x c): the points to start from and their states. ``index``: which
    function each optimizes; -1 for a point that only seeks the feasible region. ``sense``: +1
    maximizes, -1 minimizes. ``min_gain``: stop where the linear model promises less.

    Return coordinates, states and all functions at the end, and True for each point that
    converged."""
    x, functions, constraint_values, usable = problem.evaluate(u, x)
    u, reach = u.copy(), np.where(usable, MAX_STEP, 0.0)
    for _ in range(MAX_ROUNDS):
        active = np.flatnonzero(reach >= MIN_STEP)
        if not u[active].size:
            break
        slopes, constraint_slopes, state_slopes = problem.slopes(u[active], x[:, active])
        start, constraints = u[active], constraint_values[active]
        rows = np.arange(len(active))
        objective = sense[active, None] * slopes[rows, index[active]]
        value = _objective_values(functions[active], constraints, index[active], sense[active])
        seeking = index[active] < 0
        inward = (constraints < 0).astype(float) - (constraints > 1)
        objective[seeking] = np.einsum("cr,crk->ck", inward, constraint_slopes)[seeking]
        low, high = (
            np.maximum(-start, -reach[active, None]),
            np.minimum(1 - start, reach[active, None]),
        )
        # an infeasible point may not become more infeasible
        below, above = np.minimum(-constraints, 0.0), np.maximum(1 - constraints, 0.0)
        max_violation = np.maximum(
            np.maximum(-constraints, constraints - 1).max(axis=1, initial=0.0), CONSTRAINT_TOL
        )
        curvature = np.zeros_like(constraints)
        step = solve_linear_programs(objective, low, high, constraint_slopes, below, above)
        predicted_gain = (objective * step).sum(axis=1)
        for correction in range(MAX_CORRECTIONS):
            trial = np.clip(start + step, 0.0, 1.0)
            guess = x[:, active] + np.einsum("csk,ck->sc", state_slopes, trial - start)
            trial_states, trial_values, trial_constraints, usable_trial = problem.evaluate(
                trial, guess
            )
            excess = np.maximum(-trial_constraints, trial_constraints - 1).max(axis=1, initial=0.0)
            outside = usable_trial & (excess > max_violation)
            if not outside.any() or correction == MAX_CORRECTIONS - 1:
                break
            curvature[outside] = (
                trial_constraints
                - constraints
                - np.einsum("crk,ck->cr", constraint_slopes, trial - start)
            )[outside]
            step[outside] = solve_linear_programs(
                *(
                    part[outside]
                    for part in (
                        objective,
                        low,
                        high,
                        constraint_slopes,
                        below - curvature,
                        above - curvature,
                    )
                )
            )
        gain = (
            _objective_values(trial_values, trial_constraints, index[active], sense[active]) - value
        )
        better = usable_trial & ~outside & (gain > 0)
        moving = active[better]
        u[moving], x[:, moving] = trial[better], trial_states[:, better]
        functions[moving], constraint_values[moving] = (
            trial_values[better],
            trial_constraints[better],
        )
        reach[active] = np.where(better, np.minimum(2 * reach[active], MAX_STEP), reach[active] / 4)
        # the linear model predicts no further gain
        reach[active[predicted_gain <= min_gain[active]]] = 0.0
    return u, x, functions, reach < MIN_STEP


def find_extremes(
    problem: SearchProblem,
    points: Array,
    functions: Array,
    groups: Sequence[NDArray[np.intp]],
    starts: int,
    gain: float,
    states: Callable[[Array], Array],
) -> tuple[Array, Array, Flags]:
    """Return the lowest and the highest values of m functions (2 x m), where they lie (2 x m x k),
    and True for each search that converged.

    Searches start from the best ``starts`` points of each group (row numbers of ``points``), in the
    states that ``states`` computes for them. A value is nan where the function has none at any
    point. ``gain``: stop where the predicted gain is a smaller fraction of a function's range."""
    count = functions.shape[1]
    index, sense = np.tile(np.arange(count), 2), np.repeat([-1.0, 1.0], count)
    values = replace_nonfinite(functions[:, index] * sense)
    start_numbers = np.concatenate(
        [group[np.argsort(-values[group], axis=0, kind="stable")[:starts]] for group in groups]
    )
    largest = values.max(axis=0)
    min_gain = gain * np.maximum(np.nan_to_num(largest + np.roll(largest, count), neginf=0.0), 0.0)
    start_points = points[start_numbers.reshape(-1)]
    index, sense, min_gain = (
        np.tile(array, len(start_numbers)) for array in (index, sense, min_gain)
    )
    u, _, end_functions, converged_ends = climb(
        problem, start_points, states(start_points), index, sense, min_gain
    )
    end_values = replace_nonfinite(end_functions[np.arange(len(u)), index] * sense).reshape(
        start_numbers.shape
    )
    winners, columns = end_values.argmax(axis=0), np.arange(2 * count)
    best_values = end_values[winners, columns]
    extreme_points: Array = u.reshape(*start_numbers.shape, points.shape[1])[winners, columns]
    extremes = sense[: 2 * count] * np.where(np.isneginf(best_values), np.nan, best_values)
    converged = converged_ends.reshape(start_numbers.shape)[winners, columns]
    return (
        extremes.reshape(2, count),
        extreme_points.reshape(2, count, -1),
        converged.reshape(2, count),
    )


def replace_nonfinite(values: Array) -> Array:
    """Return ``values`` with -inf in place of all that are not finite."""
    return np.where(np.isfinite(values), values, -np.inf)


def latin_hypercube(dimensions: int, count: int, rng: np.random.Generator) -> Array:
    """Return ``count`` points of a Latin hypercube: each coordinate has one point in each of
    ``count`` strata."""
    strata = rng.permuted(np.tile(np.arange(count), (dimensions, 1)), axis=1).T
    return (strata + rng.random(strata.shape)) / count


def _objective_values(
    functions: Array, constraints: Array, index: NDArray[np.intp], sense: Array
) -> Array:
    """Return the value each search point maximizes: its function times its sense, or minus the sum
    of constraint violations for a point that seeks the feasible region."""
    values = sense * functions[np.arange(len(functions)), index]
    violation = np.maximum(np.maximum(-constraints, constraints - 1), 0.0).sum(axis=1)
    return np.where(index < 0, -violation, values)


def solve_linear_programs(
    objectives: Array, low: Array, high: Array, rows: Array, below: Array, above: Array
) -> Array:
    """Return the steps (c x k) that maximize the linear ``objectives`` between ``low`` and ``high``
    while ``rows`` (c x r x k) times the step stays between ``below`` and ``above``.

    These are c linear programs of one size. Where the unconstrained step violates a row, a
    primal-dual interior-point method solves the program. A program without a solution gets any step
    within ``low`` and ``high``."""
    steps = np.where(objectives > 0, high, np.where(objectives < 0, low, 0.0))
    row_values = np.einsum("crk,ck->cr", rows, steps)
    is_limited = ((row_values < below) | (row_values > above)).any(axis=1)
    if is_limited.any():
        arguments = (objectives, low, high, rows, below, above)
        steps[is_limited] = _solve_constrained(*(argument[is_limited] for argument in arguments))
    return steps


def _solve_constrained(
    objectives: Array, low: Array, high: Array, rows: Array, below: Array, above: Array
) -> Array:
    """Solve the linear programs of `solve_linear_programs` whose rows are active.

    In units of the trust region each program is: maximize g·y subject to A y + s = b, s >= 0, with
    multipliers z >= 0. Newton's method is applied to A^T z = g, A y + s = b and s z = mu, with mu a
    tenth of the mean of s z; steps end 1 % before a slack or multiplier reaches 0."""
    count, row_count, dimensions = rows.shape
    objective_size = np.abs(objectives).max(axis=1, keepdims=True)
    unit = np.maximum(high, -low).max(axis=1)[:, None]
    scaled_objectives = objectives / np.where(objective_size > 0, objective_size, 1.0)
    matrix = np.concatenate(
        [np.broadcast_to(np.eye(dimensions), (count, dimensions, dimensions)), rows], axis=1
    )
    matrix = np.concatenate([matrix, -matrix], axis=1)
    limits = np.concatenate([high, above, -low, -below], axis=1) / unit

    def max_fraction(values: Array, changes: Array) -> Array:
        """Return the largest fraction of the changes, up to 1, that keeps all values positive."""
        fractions = np.where(changes < 0, -values / np.where(changes < 0, changes, -1.0), np.inf)
        return np.asarray(np.minimum(1.0, 0.99 * fractions.min(axis=1))[:, None])

    step = 0.5 * (low + high) / unit
    widths = np.tile(
        np.maximum(
            limits[:, : dimensions + row_count] + limits[:, dimensions + row_count :], 1e-12
        ),
        2,
    )
    slacks = np.clip(limits - np.einsum("crk,ck->cr", matrix, step), 0.1 * widths, widths)
    multipliers = 1 / np.maximum(slacks, 0.1)
    for _ in range(MAX_BARRIER_ITERATIONS):
        target_product = 0.1 * (slacks * multipliers).mean(axis=1)[:, None]
        running = target_product > MAX_COMPLEMENTARITY
        if not running.any():
            break
        primal_residual = limits - np.einsum("crk,ck->cr", matrix, step) - slacks
        multiplier_terms = (target_product - multipliers * primal_residual) / slacks
        right_side = scaled_objectives - np.einsum("crk,cr->ck", matrix, multiplier_terms)
        normal_matrix = matrix.swapaxes(1, 2) @ (matrix * (multipliers / slacks)[:, :, None])
        finite = np.isfinite(normal_matrix).all(axis=(1, 2)) & np.isfinite(right_side).all(axis=1)
        normal_matrix[~finite], right_side[~finite] = np.eye(dimensions), 0.0
        try:
            newton_step = np.linalg.solve(normal_matrix, right_side[:, :, None])[:, :, 0]
        except np.linalg.LinAlgError:
            break
        slack_step = primal_residual - np.einsum("crk,ck->cr", matrix, newton_step)
        multiplier_step = (target_product - multipliers * (slacks + slack_step)) / slacks
        primal_length, dual_length = (
            running * max_fraction(slacks, slack_step),
            running * max_fraction(multipliers, multiplier_step),
        )
        step, slacks, multipliers = (
            step + primal_length * newton_step,
            slacks + primal_length * slack_step,
            multipliers + dual_length * multiplier_step,
        )
    return np.asarray(np.clip(np.nan_to_num(step * unit), low, high))
