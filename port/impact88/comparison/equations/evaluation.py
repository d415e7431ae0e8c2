"""What a spelling computes for many scenes, as it stands and with statements written otherwise.

Arrays have the scenes last, edits before them: (K, n), or (1, n) of what edits do not change.
"""

from collections import ChainMap
from collections.abc import Callable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...names import SCENE
from .spelling import NEGATIVE, TYPED, Expression, Spelling, nodes

Floats = NDArray[np.float64]
Columns = Mapping[str, Any]
Changes = Mapping[str, Sequence[Any]]
"""Key of a statement -> its sides, written otherwise or as values."""

BESIDE = {"before": 1, "after": -1}
"""Rows whose columns a program may take for its own, and how far columns are rolled for them."""
AT_ONCE = 60_000
"""Scenes times edits that are computed together, to bound the memory."""

_OPERATIONS: dict[str, Callable[..., Any]] = {
    **{"+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide, NEGATIVE: np.negative},
    **{"**": lambda x, k: np.square(x) if isinstance(k, int) and k == 2 else x**k},
    **{"<": np.less, "<=": np.less_equal, ">": np.greater, ">=": np.greater_equal, "==": np.equal},
    **{"single": lambda x: np.float64(np.float32(x)), "either": np.logical_or},
}


def value(node: Expression, names: Columns, known: Mapping[int, Any] = MappingProxyType({})) -> Any:
    """The value of an expression, or what is a value already. ``known``: values of nodes by id."""
    if isinstance(node, tuple):
        if id(node) in known:
            return known[id(node)]
        function = _OPERATIONS.get(node[0]) or getattr(np, node[0])
        return function(*[value(part, names, known) for part in node[1:]])
    if isinstance(node, str):
        return np.pi if node == "pi" else names[node]
    return node


RESIDUAL = "off_"
"""Before a statement's key: what is left of it in a clamped run."""


class Run:
    """A spelling run on scenes (columns of n), as it stands: ``names``, (1, n). Columns of the rows
    beside (``before_UX``) are those of the scenes beside where none are given.

    ``clamped``: name -> values to go on with in place of what is computed; the difference of the
    two is a residual, one of ``names``, and so is that of an equation's sides.
    """

    def __init__(self, spelling: Spelling, scene: Columns, clamped: Columns | None = None) -> None:
        self.spelling = spelling
        self.clamped = {name: np.atleast_2d(column) for name, column in (clamped or {}).items()}
        columns = {name: np.atleast_2d(np.asarray(column, float)) for name, column in scene.items()}
        for row, step in BESIDE.items():
            beside = {f"{row}_{name}": np.roll(columns[name], step, -1) for name in SCENE}
            columns = beside | columns
        self.names: dict[str, Any] = {f"{TYPED}{name}": c for name, c in columns.items()}
        self.size = max(column.shape[-1] for column in columns.values())
        self._own: list[Any] = [None] * len(spelling.statements)
        basis = np.eye(len(spelling.unknown) + 1)[1:, :, None, None]
        self._unknown = dict(zip(spelling.unknown, basis, strict=True))
        if clamped is not None:
            self._unknown = {name: self.clamped[name] for name in spelling.unknown}
            self.names |= self._unknown
        with np.errstate(all="ignore"):
            self.names |= self.edited([{}])

    def edited(self, several: Sequence[Changes]) -> dict[str, Any]:
        """What edits of the program change, (K, n); at first, all that it computes."""
        made: dict[str, Any] = {}
        names = ChainMap(made, self.names)
        changed: set[str] = set()
        equations: dict[int, Any] = {}
        edits: dict[str, list[tuple[int, Sequence[Any]]]] = {}
        for k, changes in enumerate(several):
            for key, sides in changes.items():
                edits.setdefault(key, []).append((k, sides))
        for index, statement in enumerate(self.spelling.statements):
            here, own = edits.get(statement.key, []), self._own[index]
            fresh = own is None or not changed.isdisjoint(self.spelling.reads[index])
            if here or fresh:
                seen = names if statement.target else names.new_child(self._unknown)
                found = [value(side, seen) for side in statement.sides] if fresh else own
                self._own[index] = found if own is None else own
                if here:
                    found = self._rows(found, here, len(several), seen)
                if not statement.target and not self.clamped:
                    equations[index] = found
                elif not statement.target:
                    made[RESIDUAL + statement.key] = np.subtract(*found)
                elif statement.target in self.clamped:
                    made[statement.target] = self.clamped[statement.target]
                    made[RESIDUAL + statement.key] = found[0] - made[statement.target]
                else:
                    made[statement.target] = np.atleast_2d(found[0])
                    changed.add(statement.target)
            if equations and index == self.spelling.equations[-1]:
                solved = np.moveaxis(_solutions(*self.system(equations)), -1, 0)
                made |= zip(self.spelling.unknown, solved, strict=True)
                changed.update(self.spelling.unknown)
        return made

    def _rows(
        self, own: Sequence[Any], here: Sequence[tuple[int, Sequence[Any]]], count: int, seen: Any
    ) -> list[Any]:
        """A statement's sides, row by row as edits have them, and its own in all others."""
        unknown = len(self.spelling.unknown) + 1
        lead = () if self.clamped or len(own) == 1 else (unknown,)
        shape = (*lead, count, self.size)
        found = []
        for side in own:
            kind = bool if np.result_type(side) == np.bool_ else float
            found.append(np.array(np.broadcast_to(side, shape), kind))
        for k, sides in here:
            row = _Row(seen, k)
            for column, side in zip(found, sides, strict=True):
                made = value(side, row)
                column[..., k, :] = made[..., 0, :] if np.ndim(made) > 1 else made
        return found

    def system(self, equations: Mapping[int, Any]) -> tuple[Floats, Floats]:
        """Matrices (K, n, m, m) and right-hand sides (K, n, m); those that are not given are the
        program's own. Sides are evaluated for no unknown, then for each alone."""
        sides = [equations.get(index, self._own[index]) for index in self.spelling.equations]
        count = len(sides)
        shapes = [np.shape(side)[-2:] for both in sides for side in both]
        lead = np.broadcast_shapes((1, self.size), *shapes)
        matrix, rest = np.zeros((*lead, count, count)), np.empty((*lead, count))
        for row, (left, right) in enumerate(sides):
            for side, sign in ((left, 1.0), (right, -1.0)):
                if np.ndim(side) > 2:
                    matrix[..., row, :] += sign * np.moveaxis(side[1:] - side[0], 0, -1)
            left, right = (side[0] if np.ndim(side) > 2 else side for side in (left, right))
            rest[..., row] = np.subtract(right, left)
        return matrix, rest

    def distinct(self, edits: Sequence[Changes]) -> list[tuple[int, Changes]]:
        """The edits that change something, by place; of those of one statement that compute the
        same the first. They have the values, then."""
        groups: dict[str, list[int]] = {}
        for place, changes in enumerate(edits):
            groups.setdefault("" if len(changes) > 1 else next(iter(changes)), []).append(place)
        found: list[tuple[int, Changes]] = [(place, edits[place]) for place in groups.pop("", [])]
        for key, places in groups.items():
            index = self.spelling.where[key]
            line, own = self.spelling.statements[index], self._own[index]
            seen = self.names if line.target else {**self.names, **self._unknown}
            known: dict[int, Any] = {}
            for node in reversed([node for side in line.sides for node in nodes(side)]):
                if isinstance(node, tuple):
                    known[id(node)] = value(node, seen, known)
            values = [[value(side, seen, known) for side in edits[place][key]] for place in places]
            wholes = [sides[0] if line.target else np.subtract(*sides) for sides in (own, *values)]
            shape = np.broadcast_shapes((1, self.size), *map(np.shape, wholes))
            met = set[bytes]()
            for place, sides, whole in zip((-1, *places), (own, *values), wholes, strict=True):
                numbers = np.empty(shape)
                numbers[...] = whole
                # those that differ in their last bits only are alike: the same in another order
                digits = ((numbers + 0.0).view(np.int64) + (1 << 18) >> 19).tobytes()
                if digits not in met and place >= 0:
                    found.append((place, {key: sides}))
                met.add(digits)
        return found


class _Row(dict[str, Any]):
    def __init__(self, names: Columns, k: int) -> None:
        super().__init__()
        self._names, self._k = names, k

    def __missing__(self, name: str) -> Any:
        column = self._names[name]
        return column if column.shape[-2] == 1 else column[..., self._k : self._k + 1, :]


def _solutions(matrix: Floats, rest: Floats) -> Floats:
    """Solutions of systems (..., m, m); NaN where there is none. Rows are scaled, so that a small
    row is no singular one."""
    size = np.abs(matrix).max(-1)
    usable = np.asarray(np.isfinite(matrix.sum((-1, -2)) + rest.sum(-1)) & (size > 0).all(-1))
    size[~usable] = 1.0
    matrix, rest = matrix / size[..., None], rest / size
    matrix[~usable] = np.eye(matrix.shape[-1])
    try:
        found = np.linalg.solve(matrix, rest[..., None])[..., 0]
    except np.linalg.LinAlgError:
        signs, _ = np.linalg.slogdet(matrix)
        usable &= signs != 0
        matrix[~usable] = np.eye(matrix.shape[-1])
        found = np.linalg.solve(matrix, rest[..., None])[..., 0]
    found[~usable] = np.nan
    return np.asarray(found)


def chunks(count: int, scenes: int) -> Iterator[slice]:
    """Slices of ``count`` edits that are computed together."""
    step = max(1, AT_ONCE // max(scenes, 1))
    for start in range(0, count, step):
        yield slice(start, start + step)
