"""Bound the rounding errors of a correct program: a running error bound of a spelling.

Each operation is charged its largest rounding error, and propagates the errors of its operands.
Equations are eliminated with partial pivoting: the computed solution of A x = b solves exactly a
system whose matrix differs from A by a few u |L||U|, entry by entry (Higham, *Accuracy and
Stability of Numerical Algorithms*, theorems 8.5, 9.3 and 9.4), with the scene's own factors L and
U. The errors of computing A and b are added, and all of them reach x through |inv(A)|. No norms
are taken, so each number's bound is in its own unit. The bound is of first order in the unit
roundoff.
"""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .evaluation import Columns, evaluate
from .spelling import COMPARISONS, NEGATIVE, TYPED, Expression, Spelling

Floats = NDArray[np.float64]
Bounded = tuple[Any, Any]
"""A value and its error bound, in units of roundoff."""

ROUNDOFF = 2.0**-53

_ERRORS: dict[str, Callable[..., Any]] = {
    "+": lambda v, x, y, dx, dy: dx + dy,
    "-": lambda v, x, y, dx, dy: dx + dy,
    "hypot": lambda v, x, y, dx, dy: dx + dy,
    "*": lambda v, x, y, dx, dy: np.abs(x) * dy + np.abs(y) * dx + ROUNDOFF * dx * dy,
    "/": lambda v, x, y, dx, dy: (dx + np.abs(v) * dy) / np.abs(y),
    "**": lambda v, x, y, dx, dy: 2 * np.abs(x) * dx + ROUNDOFF * dx * dx,
    "sin": lambda v, x, dx: np.abs(np.cos(x)) * dx,
    "cos": lambda v, x, dx: np.abs(np.sin(x)) * dx,
    NEGATIVE: lambda v, x, dx: dx - np.abs(v),
    "where": lambda v, p, x, y, dp, dx, dy: np.where(p, dx, dy) - np.abs(v),
}
"""Operation -> error that it propagates, from its value v, its operands and their errors. Its own
rounding, |v|, is added to all of them; negation and ``where`` are exact, and subtract it."""


def running_errors(
    spelling: Spelling, scene: Columns, known: Mapping[str, Bounded] = MappingProxyType({})
) -> Mapping[str, Bounded]:
    """Return every value that a spelling computes for scenes (columns of n), with its error bound.

    ``known``: values and bounds that replace the computed ones.
    """
    names: dict[str, Bounded] = {
        f"{TYPED}{name}": (column, np.abs(column)) for name, column in scene.items()
    }
    size = len(spelling.unknown) + 1
    basis = np.eye(size)[1:, :, None]
    unknown: dict[str, Bounded] = {
        name: (column, 0.0) for name, column in zip(spelling.unknown, basis, strict=True)
    }
    rows: list[tuple[Bounded, Bounded]] = []

    with np.errstate(all="ignore"):
        for index, statement in enumerate(spelling.statements):
            if statement.target in known:
                names[statement.target] = known[statement.target]
                continue
            if statement.target:
                names[statement.target] = _evaluate_with_error(statement.sides[0], names)
                continue
            visible = {**names, **unknown}
            left, right = (_evaluate_with_error(side, visible) for side in statement.sides)
            rows.append((left, right))
            if index == spelling.equations[-1]:
                count = max(np.size(column) for column in scene.values())
                names |= zip(spelling.unknown, _solve_with_errors(rows, size, count), strict=True)
    return names


def _evaluate_with_error(node: Expression, names: Mapping[str, Bounded]) -> Bounded:
    """Return the value of an expression and its error bound."""
    if isinstance(node, str):
        return (np.pi, 0.0) if node == "pi" else names[node]
    if not isinstance(node, tuple):
        return node, 0.0
    values, errors = zip(*(_evaluate_with_error(part, names) for part in node[1:]), strict=True)
    result = evaluate((node[0], *values), {})
    if node[0] in COMPARISONS:
        return result, 0.0
    return result, _ERRORS[node[0]](result, *values, *errors) + np.abs(result)


def _solve_with_errors(rows: list[tuple[Bounded, Bounded]], size: int, count: int) -> list[Bounded]:
    """Return the unknowns of ``count`` systems of equations with their error bounds.

    ``rows``: the two sides of each equation, evaluated with all unknowns 0, then with each 1; a
    side without unknowns has its constant only. ``size``: number of unknowns, plus one.
    """
    system, system_errors = np.zeros((2, count, len(rows), size))
    for row, sides in enumerate(rows):
        for (side, side_errors), sign in zip(sides, (1.0, -1.0), strict=True):
            side, side_errors = np.atleast_2d(side), np.atleast_2d(side_errors)
            system[:, row, 0] += sign * side[0]
            system_errors[:, row, 0] += side_errors[0]
            if len(side) > 1:
                system[:, row, 1:] += sign * (side[1:] - side[0]).T
                system_errors[:, row, 1:] += side_errors[1:].T
    matrix, right = system[..., 1:], -system[..., 0]
    backward, solvable = elimination_errors(matrix)
    matrix[~solvable] = np.eye(size - 1)
    # rows and columns are scaled to make the inverse accurate; the bound does not depend on it
    row_scales = np.abs(matrix).max(-1, keepdims=True)
    row_scales[row_scales == 0] = 1.0
    column_scales = np.abs(matrix / row_scales).max(-2, keepdims=True)
    column_scales[column_scales == 0] = 1.0
    scaled = matrix / row_scales / column_scales
    solvable &= np.linalg.slogdet(scaled)[0] != 0
    scaled[~solvable] = np.eye(size - 1)
    inverse = np.linalg.inv(scaled)
    inverse = inverse / np.swapaxes(row_scales, -1, -2) / np.swapaxes(column_scales, -1, -2)
    solution = (inverse @ right[..., None])[..., 0]
    # |x - computed x| <= |inv(A)| ((|dA backward| + |dA rounding|) |x| + |db|)
    matrix_errors = backward + system_errors[..., 1:]
    residual = (matrix_errors @ np.abs(solution)[..., None])[..., 0] + system_errors[..., 0]
    errors = (np.abs(inverse) @ residual[..., None])[..., 0]
    solution[~solvable] = errors[~solvable] = np.nan
    return list(zip(solution.T, errors.T, strict=True))


def elimination_errors(matrix: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """Return the backward error of elimination with partial pivoting, and which matrices have one.

    The first array, (n, m, m), bounds entry by entry how far the matrices that are solved exactly
    may be from the given ones, in units of roundoff. The second, (n,), is False for matrices with a
    pivot of 0.
    """
    work = matrix.copy()
    count, size, _ = work.shape
    each = np.arange(count)
    order = np.tile(np.arange(size), (count, 1))
    solvable = np.asarray(np.isfinite(work).all((-1, -2)))
    work[~solvable] = 0.0
    for step in range(size):
        pivot = step + np.abs(work[:, step:, step]).argmax(-1)
        for array in (work, order):
            array[each, step], array[each, pivot] = array[each, pivot], array[each, step].copy()
        divisor = work[:, step, step].copy()
        solvable &= divisor != 0
        divisor[divisor == 0] = 1.0
        factors = work[:, step + 1 :, step] / divisor[:, None]
        work[:, step + 1 :, step] = factors
        work[:, step + 1 :, step + 1 :] -= factors[:, :, None] * work[:, step, None, step + 1 :]
    lower, upper = np.abs(np.tril(work, -1)) + np.eye(size), np.abs(np.triu(work))
    # each entry of L U is a sum of min(i, j) products; solving with L takes i of them in row i, and
    # solving with U one more than there are rows below
    place = np.arange(1, size + 1)
    factoring = np.minimum(place[:, None], place) + place[:, None]
    permuted = factoring * (lower @ upper) + lower @ ((size + 1 - place)[:, None] * upper)
    errors = np.empty_like(work)
    errors[each[:, None], order] = permuted
    return errors, solvable
