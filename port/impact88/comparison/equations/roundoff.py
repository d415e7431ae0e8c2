"""How far rounding may take a correct program: a running error bound of a spelling as it stands.

Every operation rounds, always at its worst, and what its operands are off is carried along.
Equations are eliminated with partial pivoting: the computed solution of A x = b solves a system
whose matrix is off by a few u |L||U| entry by entry (Higham, *Accuracy and Stability of Numerical
Algorithms*, theorems 8.5, 9.3 and 9.4), with a row's own factors L and U; to that comes what
computing A and b has rounded, and all of it reaches x through |inv(A)|. Nothing in it is a norm, so
the bound of each number goes with its own unit. It is of first order in the unit roundoff.
"""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .evaluation import Columns, value
from .spelling import COMPARISONS, NEGATIVE, TYPED, Expression, Spelling

Floats = NDArray[np.float64]
Bounded = tuple[Any, Any]
"""A value, and how far it may be off, in units of roundoff."""

ROUNDOFF = 2.0**-53

_ERRORS: dict[str, Callable[..., Any]] = {
    **dict.fromkeys(("+", "-", "hypot"), lambda v, x, y, dx, dy: dx + dy),
    "*": lambda v, x, y, dx, dy: np.abs(x) * dy + np.abs(y) * dx + ROUNDOFF * dx * dy,
    "/": lambda v, x, y, dx, dy: (dx + np.abs(v) * dy) / np.abs(y),
    "**": lambda v, x, y, dx, dy: 2 * np.abs(x) * dx + ROUNDOFF * dx * dx,
    "sin": lambda v, x, dx: np.abs(np.cos(x)) * dx,
    "cos": lambda v, x, dx: np.abs(np.sin(x)) * dx,
    NEGATIVE: lambda v, x, dx: dx - np.abs(v),
    "where": lambda v, p, x, y, dp, dx, dy: np.where(p, dx, dy) - np.abs(v),
}
"""What an operation makes of the errors of its operands, its own rounding aside."""


def running_errors(
    spelling: Spelling, scene: Columns, given: Mapping[str, Bounded] = MappingProxyType({})
) -> Mapping[str, Bounded]:
    """Return all that a spelling computes for scenes (columns of n): name -> value and error.
    ``given``: what stands in place of what it computes."""
    names: dict[str, Bounded] = {
        f"{TYPED}{name}": (column, np.abs(column)) for name, column in scene.items()
    }
    size = len(spelling.unknown) + 1
    basis = np.eye(size)[1:, :, None]
    unknown: dict[str, Bounded] = {
        name: (column, 0.0) for name, column in zip(spelling.unknown, basis, strict=True)
    }
    rows: list[tuple[Bounded, Bounded]] = []

    def bounded(node: Expression, seen: Mapping[str, Bounded]) -> Bounded:
        if isinstance(node, str):
            return (np.pi, 0.0) if node == "pi" else seen[node]
        if not isinstance(node, tuple):
            return node, 0.0
        values, errors = zip(*(bounded(part, seen) for part in node[1:]), strict=True)
        whole = value((node[0], *values), {})
        if node[0] in COMPARISONS:
            return whole, 0.0
        return whole, _ERRORS[node[0]](whole, *values, *errors) + np.abs(whole)

    with np.errstate(all="ignore"):
        for index, statement in enumerate(spelling.statements):
            if statement.target in given:
                names[statement.target] = given[statement.target]
                continue
            if statement.target:
                names[statement.target] = bounded(statement.sides[0], names)
                continue
            left, right = (bounded(side, {**names, **unknown}) for side in statement.sides)
            rows.append((left, right))
            if index == spelling.equations[-1]:
                count = max(np.size(column) for column in scene.values())
                names |= zip(spelling.unknown, _eliminated(rows, size, count), strict=True)
    return names


def _eliminated(rows: list[tuple[Bounded, Bounded]], size: int, count: int) -> list[Bounded]:
    """Return the unknowns of ``count`` systems, and what elimination may take them off by."""
    # a side is evaluated for no unknown, then for each alone; one that has none has a constant only
    system, off = np.zeros((count, len(rows), size)), np.zeros((count, len(rows), size))
    for row, sides in enumerate(rows):
        for (side, side_off), sign in zip(sides, (1.0, -1.0), strict=True):
            side, side_off = np.atleast_2d(side), np.atleast_2d(side_off)
            system[:, row, 0] += sign * side[0]
            off[:, row, 0] += side_off[0]
            if len(side) > 1:
                system[:, row, 1:] += sign * (side[1:] - side[0]).T
                off[:, row, 1:] += side_off[1:].T
    matrix, right = system[..., 1:], -system[..., 0]
    backward, solvable = elimination_errors(matrix)
    matrix[~solvable] = np.eye(size - 1)
    # only the inverse's own rounding depends on how the rows and columns are scaled
    across = np.abs(matrix).max(-1, keepdims=True)
    across[across == 0] = 1.0
    down = np.abs(matrix / across).max(-2, keepdims=True)
    down[down == 0] = 1.0
    scaled = matrix / across / down
    solvable &= np.linalg.slogdet(scaled)[0] != 0
    scaled[~solvable] = np.eye(size - 1)
    inverse = np.linalg.inv(scaled) / np.swapaxes(across, -1, -2) / np.swapaxes(down, -1, -2)
    found = (inverse @ right[..., None])[..., 0]
    moved = ((backward + off[..., 1:]) @ np.abs(found)[..., None])[..., 0] + off[..., 0]
    errors = (np.abs(inverse) @ moved[..., None])[..., 0]
    found[~solvable] = errors[~solvable] = np.nan
    return list(zip(found.T, errors.T, strict=True))


def elimination_errors(matrix: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """Return how far off the matrices (n, m, m) may be, in units of roundoff, that elimination with
    partial pivoting solves in place of these, entry by entry; and which have no pivot 0."""
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
    # each entry of L U is a sum of min(i, j) products; L is solved with i of them in a row, and U
    # with one more than the rows below
    place = np.arange(1, size + 1)
    factoring = np.minimum(place[:, None], place) + place[:, None]
    off = factoring * (lower @ upper) + lower @ ((size + 1 - place)[:, None] * upper)
    errors = np.empty_like(work)
    errors[each[:, None], order] = off
    return errors, solvable
