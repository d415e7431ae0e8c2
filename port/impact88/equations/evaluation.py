"""Evaluate a spelling of the mechanics on many scenes, as it stands and with statements edited.

Arrays have the scenes last and the edits before them: (K, n), or (1, n) where no edit changes the
value.
"""

from collections import ChainMap
from collections.abc import Callable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..names import SCENE
from .spelling import NEGATIVE, TYPED, Expression, Spelling, Statement, nodes

Floats = NDArray[np.float64]
Columns = Mapping[str, Any]
Changes = Mapping[str, Sequence[Any]]
"""An edit: key of a statement -> its new sides, as expressions or as values."""

NEIGHBOUR_SHIFTS = {"before": 1, "after": -1}
"""Neighbouring row -> how far `numpy.roll` shifts a column to get it. A program may read from the
wrong row of its table."""
LAST = "last_"
"""Prefix of a final velocity's name: what the table shows for it in the row before."""
ROW = "the row's number"  # in the table, from 1, where the scene has it
MAX_VALUES_PER_CHUNK = 60_000
"""Scenes times edits computed together; bounds the memory."""

_OPERATIONS: dict[str, Callable[..., Any]] = {
    "+": np.add,
    "-": np.subtract,
    "*": np.multiply,
    "/": np.divide,
    NEGATIVE: np.negative,
    # in floats: integers have no negative powers
    "**": lambda x, k: np.square(x) if isinstance(k, int) and k == 2 else np.float_power(x, k),
    "<": np.less,
    "<=": np.less_equal,
    ">": np.greater,
    ">=": np.greater_equal,
    "==": np.equal,
    "single": lambda x: np.float64(np.float32(x)),
    "either": np.logical_or,
}


def evaluate(
    node: Expression, names: Columns, cache: Mapping[int, Any] = MappingProxyType({})
) -> Any:
    """Return the value of an expression; a number or an array is returned as it is.

    ``cache``: values of subexpressions already computed, by the `id` of the node.
    """
    if isinstance(node, tuple):
        if id(node) in cache:
            return cache[id(node)]
        name, *parts = node
        for at, part in enumerate(parts):
            if isinstance(part, tuple):
                parts[at] = evaluate(part, names, cache)
            elif isinstance(part, str):
                parts[at] = np.pi if part == "pi" else names[part]
        function = _OPERATIONS.get(name) or getattr(np, name)
        return function(*parts)
    if isinstance(node, str):
        return np.pi if node == "pi" else names[node]
    return node


def evaluate_edit(
    node: Expression, names: Columns, cache: Mapping[int, Any] = MappingProxyType({})
) -> Any:
    """Return the value of an expression that a program was edited to hold, NaN where it has none:
    an edit of an edit may ask for what no operation can do."""
    try:
        return evaluate(node, names, cache)
    except (ArithmeticError, TypeError, ValueError):
        return np.nan


class _Columns(dict[str, Any]):
    """The columns of a table as typed, by their prefixed names, and what is computed of them. A
    column of neighbouring rows (``typed_before_UX``) is made when it is read."""

    def __missing__(self, name: str) -> Any:
        if name.startswith(f"{TYPED}{LAST}"):  # not given
            return np.full((1, 1), np.nan)
        row, _, column = name.removeprefix(TYPED).partition("_")
        if row not in NEIGHBOUR_SHIFTS or column not in SCENE:
            raise KeyError(name)
        self[name] = np.roll(self[f"{TYPED}{column}"], NEIGHBOUR_SHIFTS[row], -1)
        return self[name]


RESIDUAL = "off_"
"""Prefix of a statement's key: the name of its residual in a clamped run."""


class Run:
    """A spelling evaluated on scenes (columns of n). ``names``: every value it computes, (1, n).

    The columns of neighbouring rows (``before_UX``, ``after_UX``) may be given; by default they are
    those of the neighbouring scenes.

    ``clamped``: name -> values that replace the computed ones downstream. The computed value minus
    the clamped one is the statement's residual, and is one of ``names``; so is the left side minus
    the right of each equation, which is then evaluated and not solved.
    """

    def __init__(self, spelling: Spelling, scene: Columns, clamped: Columns | None = None) -> None:
        self.spelling = spelling
        self.clamped = {name: np.atleast_2d(column) for name, column in (clamped or {}).items()}
        columns = {name: np.atleast_2d(np.asarray(column, float)) for name, column in scene.items()}
        self.names = _Columns({f"{TYPED}{name}": c for name, c in columns.items()})
        self.size = max(column.shape[-1] for column in columns.values())
        # sides of each statement as it stands, filled by the first run
        self._base_sides: list[Any] = [None] * len(spelling.statements)
        # an equation is linear in the unknowns: its sides are evaluated with all of them 0 and with
        # each of them 1, along a leading axis
        basis = np.eye(len(spelling.unknown) + 1)[1:, :, None, None]
        self._unknown = dict(zip(spelling.unknown, basis, strict=True))
        if clamped is not None:
            self._unknown = {name: self.clamped[name] for name in spelling.unknown}
            self.names |= self._unknown
        with np.errstate(all="ignore"):
            self.names |= self.run_edits([{}])

    def run_edits(self, edits: Sequence[Changes]) -> dict[str, Any]:
        """Return the values of every name that an edit affects, (K, n): row k is by edit k.

        Statements that are neither edited nor depend on one that is are not evaluated again.
        """
        computed: dict[str, Any] = {}
        names = ChainMap(computed, self.names)
        changed: set[str] = set()
        equations: dict[int, Any] = {}
        edits_by_key: dict[str, list[tuple[int, Sequence[Any]]]] = {}
        for k, changes in enumerate(edits):
            for key, sides in changes.items():
                edits_by_key.setdefault(key, []).append((k, sides))
        for index, statement in enumerate(self.spelling.statements):
            replacements, base = edits_by_key.get(statement.key, []), self._base_sides[index]
            is_stale = base is None or not changed.isdisjoint(self.spelling.reads[index])
            if replacements or is_stale:
                visible = names if statement.target else names.new_child(self._unknown)
                values = base
                if is_stale:
                    values = [evaluate(side, visible) for side in statement.sides]
                if base is None:
                    self._base_sides[index] = values
                if replacements:
                    values = self._replace_rows(values, replacements, len(edits), visible)
                if statement.target or self.clamped:
                    self._store(statement, values, computed, changed)
                else:
                    equations[index] = values
            if equations and index == self.spelling.equations[-1]:
                solution = np.moveaxis(_solve_systems(*self.linear_systems(equations)), -1, 0)
                computed |= zip(self.spelling.unknown, solution, strict=True)
                changed.update(self.spelling.unknown)
        return computed

    def _store(
        self,
        statement: Statement,
        sides: Sequence[Any],
        computed: dict[str, Any],
        changed: set[str],
    ) -> None:
        """Add a statement's value, or in a clamped run its residual, to ``computed``."""
        if not statement.target:
            computed[RESIDUAL + statement.key] = np.subtract(*sides)
        elif statement.target in self.clamped:
            computed[statement.target] = self.clamped[statement.target]
            computed[RESIDUAL + statement.key] = sides[0] - computed[statement.target]
        else:
            computed[statement.target] = np.atleast_2d(sides[0])
            changed.add(statement.target)

    def _replace_rows(
        self,
        base: Sequence[Any],
        replacements: Sequence[tuple[int, Sequence[Any]]],
        count: int,
        names: Any,
    ) -> list[Any]:
        """Return a statement's sides, (K, n): edited ones in the rows of their edits, ``base`` in
        all others."""
        is_number = self.clamped or len(base) == 1
        lead = () if is_number else (len(self.spelling.unknown) + 1,)
        shape = (*lead, count, self.size)
        sides = []
        for side in base:
            kind = bool if np.result_type(side) == np.bool_ else float
            sides.append(np.array(np.broadcast_to(side, shape), kind))
        for k, new_sides in replacements:
            row = _Row(names, k)
            for column, side in zip(sides, new_sides, strict=True):
                result = evaluate_edit(side, row)
                column[..., k, :] = result[..., 0, :] if np.ndim(result) > 1 else result
        return sides

    def linear_systems(self, equations: Mapping[int, Any]) -> tuple[Floats, Floats]:
        """Return matrices (K, n, m, m) and right-hand sides (K, n, m) of the equations.

        ``equations``: index of a statement -> values of its sides; the base sides are taken for
        equations that are not given. A side has its value with all unknowns 0, then with each 1.
        """
        sides = [equations.get(index, self._base_sides[index]) for index in self.spelling.equations]
        count = len(sides)
        shapes = [np.shape(side)[-2:] for pair in sides for side in pair]
        lead = np.broadcast_shapes((1, self.size), *shapes)
        matrix, constants = np.zeros((*lead, count, count)), np.empty((*lead, count))
        for row, (left, right) in enumerate(sides):
            for side, sign in ((left, 1.0), (right, -1.0)):
                if np.ndim(side) > 2:
                    matrix[..., row, :] += sign * np.moveaxis(side[1:] - side[0], 0, -1)
            left, right = (side[0] if np.ndim(side) > 2 else side for side in (left, right))
            constants[..., row] = np.subtract(right, left)
        return matrix, constants

    def distinct_edits(self, edits: Sequence[Changes]) -> list[tuple[int, Changes]]:
        """Return the edits that change a value, each with its position in ``edits``.

        Of edits of the same statement that compute the same, the first is returned, with its
        values in place of its expressions. Edits of several statements are all returned.
        """
        groups: dict[str, list[int]] = {}
        for place, changes in enumerate(edits):
            groups.setdefault("" if len(changes) > 1 else next(iter(changes)), []).append(place)
        distinct: list[tuple[int, Changes]] = [
            (place, edits[place]) for place in groups.pop("", [])
        ]
        for key, places in groups.items():
            distinct += self._distinct_edits_of(key, places, edits)
        return distinct

    def _distinct_edits_of(
        self, key: str, places: Sequence[int], edits: Sequence[Changes]
    ) -> Iterator[tuple[int, Changes]]:
        """Yield those edits of one statement that differ from it and from each other."""
        index = self.spelling.index_of[key]
        statement, base = self.spelling.statements[index], self._base_sides[index]
        names = self.names if statement.target else {**self.names, **self._unknown}
        cache: dict[int, Any] = {}
        for node in reversed([node for side in statement.sides for node in nodes(side)]):
            if isinstance(node, tuple):
                cache[id(node)] = evaluate(node, names, cache)
        values = [
            [evaluate_edit(side, names, cache) for side in edits[place][key]] for place in places
        ]
        results = [
            sides[0] if statement.target else np.subtract(*sides) for sides in (base, *values)
        ]
        shape = np.broadcast_shapes((1, self.size), *map(np.shape, results))
        numbers = np.empty((len(results), *shape))
        for row, result in zip(numbers, results, strict=True):
            row[...] = result
        # compare 33 bits of the mantissa: terms added in another order differ in the last ones;
        # adding 0.0 makes -0 a 0
        digits = (numbers + 0.0).view(np.int64) + (1 << 18) >> 19
        seen = {digits[0].tobytes()}
        for place, sides, row in zip(places, values, digits[1:], strict=True):
            if (own := row.tobytes()) not in seen:
                yield place, {key: sides}
                seen.add(own)


class _Row(dict[str, Any]):
    """Mapping of names to the values by edit k alone."""

    def __init__(self, names: Columns, k: int) -> None:
        super().__init__()
        self._names, self._k = names, k

    def __missing__(self, name: str) -> Any:
        column = self._names[name]
        return column if column.shape[-2] == 1 else column[..., self._k : self._k + 1, :]


def _solve_systems(matrix: Floats, right: Floats) -> Floats:
    """Return the solutions of systems (..., m, m), NaN where a system has none.

    Rows are scaled by their largest entries, so that small coefficients alone do not make a system
    singular.
    """
    size = np.abs(matrix).max(-1)
    solvable = np.asarray(np.isfinite(matrix.sum((-1, -2)) + right.sum(-1)) & (size > 0).all(-1))
    size[~solvable] = 1.0
    matrix, right = matrix / size[..., None], right / size
    matrix[~solvable] = np.eye(matrix.shape[-1])
    try:
        solution = np.linalg.solve(matrix, right[..., None])[..., 0]
    except np.linalg.LinAlgError:
        signs, _ = np.linalg.slogdet(matrix)
        solvable &= signs != 0
        matrix[~solvable] = np.eye(matrix.shape[-1])
        solution = np.linalg.solve(matrix, right[..., None])[..., 0]
    solution[~solvable] = np.nan
    return np.asarray(solution)


def chunks(count: int, scenes: int) -> Iterator[slice]:
    """Yield slices of ``count`` edits that are computed together on so many scenes."""
    step = max(1, MAX_VALUES_PER_CHUNK // max(scenes, 1))
    for start in range(0, count, step):
        yield slice(start, start + step)
