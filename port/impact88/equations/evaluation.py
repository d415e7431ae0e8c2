"""What a spelling computes for many scenes, as it stands and with statements written otherwise.

Arrays have the scenes last. A name that an edit changes has an axis more, in front: one entry an
edit, so that all edits of a statement run through the rest of the program together.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .spelling import Spelling

Floats = NDArray[np.float64]
Columns = Mapping[str, Any]

AT_ONCE = 60_000
"""Scenes times edits that are computed together, to bound the memory."""

_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: np.add,
    ast.Sub: np.subtract,
    ast.Mult: np.multiply,
    ast.Div: np.divide,
}
_COMPARED: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Lt: np.less,
    ast.LtE: np.less_equal,
    ast.Gt: np.greater,
    ast.GtE: np.greater_equal,
    ast.Eq: np.equal,
}
FUNCTIONS: dict[str, Callable[..., Any]] = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "abs": np.abs,
    "sqrt": np.sqrt,
    "hypot": np.hypot,
    "where": np.where,
    "minimum": np.minimum,
    "maximum": np.maximum,
    "sign": np.sign,
    "trunc": np.trunc,
    "round": np.round,
    "degrees": np.degrees,
    "radians": np.radians,
    "nextafter": np.nextafter,
    "single": lambda x: np.float64(np.float32(x)),
    "added": lambda x, y: np.abs(x) + np.abs(y),
    "squared": lambda x, y: x * x + y * y,
    "either": np.logical_or,
}


def value(node: ast.expr, names: Columns, known: Mapping[int, Any] | None = None) -> Any:
    """The value of an expression. ``known``: values of nodes by their ``id``."""
    if known is not None and id(node) in known:
        return known[id(node)]
    if isinstance(node, ast.Name):
        return np.pi if node.id == "pi" else names[node.id]
    if isinstance(node, ast.Constant):
        return node.value
    if isinstance(node, ast.BinOp):
        left, right = value(node.left, names, known), value(node.right, names, known)
        if isinstance(node.op, ast.Pow):
            return np.square(left) if isinstance(right, int) and right == 2 else left**right
        return _BINARY[type(node.op)](left, right)
    if isinstance(node, ast.UnaryOp):
        return np.negative(value(node.operand, names, known))
    if isinstance(node, ast.Compare):
        left, right = value(node.left, names, known), value(node.comparators[0], names, known)
        return _COMPARED[type(node.ops[0])](left, right)
    assert isinstance(node, ast.Call)
    assert isinstance(node.func, ast.Name)
    return FUNCTIONS[node.func.id](*(value(one, names, known) for one in node.args))


class Run:
    """A spelling run on scenes (columns of n), as it stands.

    ``clamped``: name -> values to go on with once it has been computed, in place of what was; the
    difference of the two is a residual, and so is that of an equation's sides.
    """

    def __init__(self, spelling: Spelling, scene: Columns, clamped: Columns | None = None) -> None:
        self.spelling = spelling
        self.size = int(np.size(scene["M"])) if np.ndim(scene["M"]) else 1
        self.clamped = clamped
        self._known: dict[int, Any] = {}
        count = len(spelling.unknown)
        basis = np.zeros((count, count + 1, 1))
        for place in range(count):
            basis[place, place + 1] = 1
        self._basis = {n: basis[i] for i, n in enumerate(spelling.unknown)}
        self._deep = {n: basis[i][:, None] for i, n in enumerate(spelling.unknown)}
        self.names: dict[str, Any] = {**scene, **(self._unknowns({}) if clamped else {})}
        self.residuals: dict[int, Any] = {}
        self._sides: dict[int, tuple[Any, Any]] = {}
        with np.errstate(all="ignore"):
            self._follow()

    def _follow(self) -> None:
        for index, one in enumerate(self.spelling.statements):
            if one.target:
                self._assign(index, one.target, value(one.sides[0], self.names))
            else:
                names = {**self.names, **self._unknowns(self._basis)}
                left, right = (value(side, names) for side in one.sides)
                self._sides[index] = self._linear(left, right)
                if self.clamped is not None:
                    self.residuals[index] = left - right
                elif index == self.spelling.equations[-1]:
                    self.names |= self._solved({})

    def _unknowns(self, basis: Columns) -> Columns:
        if self.clamped is None:
            return basis
        return {name: self.clamped[name] for name in self.spelling.unknown}

    def _keep(self, node: ast.expr, names: Columns) -> Any:
        """Remember the value of every node, those below first."""
        if isinstance(node, ast.Constant):
            return
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.expr) and not (
                isinstance(node, ast.Call) and child is node.func
            ):
                self._keep(child, names)
        if not isinstance(node, ast.Name):
            self._known[id(node)] = value(node, names, self._known)

    def _assign(self, index: int, target: str, found: Any) -> None:
        if self.clamped is not None and target in self.clamped:
            self.residuals[index] = found - self.clamped[target]
            found = self.clamped[target]
        self.names[target] = found

    def _linear(self, left: Any, right: Any) -> tuple[Any, Any]:
        """Coefficients (unknowns first) and right-hand side of an equation evaluated on the basis:
        nothing, then each unknown alone."""
        count = len(self.spelling.unknown) + 1
        difference = np.subtract(left, right) if np.ndim(right) > 1 else left
        if np.shape(difference)[:1] != (count,):
            difference = np.broadcast_to(difference, (count, *np.shape(difference)[-2:]))
        constant = difference[0]
        rest = -constant if np.ndim(right) > 1 else right - constant
        return difference[1:] - constant, rest

    def edited(self, index: int, edits: Sequence[tuple[ast.expr, ...]]) -> Any:
        """What a statement gives when written otherwise: (edits, n), or of an equation the linear
        form (unknowns + 1, edits, n), its sides subtracted; of clamped ones the residual."""
        one, shape = self.spelling.statements[index], (self.size,)
        names = self.names if one.target else {**self.names, **self._unknowns(self._basis)}
        for side in one.sides:
            self._keep(side, names)
        rows = []
        for sides in edits:
            if one.target:
                rows.append(np.broadcast_to(value(sides[0], names, self._known), shape))
                continue
            left, right = (value(side, names, self._known) for side in sides)
            form = np.subtract(left, right)
            if self.clamped is None:
                count = len(self.spelling.unknown) + 1
                # the right-hand side counts once: as the constant
                if np.ndim(left) > 1 and np.ndim(right) <= 1:
                    form = np.array(np.broadcast_to(left, (count, self.size)), float)
                    form[0] = form[0] - right
                    form[1:] -= np.broadcast_to(left, (count, self.size))[0]
                else:
                    form = np.array(np.broadcast_to(form, (count, self.size)), float)
                    form[1:] -= form[0]
                rows.append(form)
            else:
                rows.append(np.broadcast_to(form, shape))
        return np.stack(rows, axis=-2 if not one.target and self.clamped is None else 0)

    def system(self) -> tuple[Floats, Floats]:
        """The matrices (n, m, m) and right-hand sides (n, m) of the equations as they stand."""
        count = len(self.spelling.unknown)
        matrix, rest = np.empty((self.size, count, count)), np.empty((self.size, count))
        for row, index in enumerate(self.spelling.equations):
            left, right = self._sides[index]
            for column in range(count):
                matrix[:, row, column] = left[column]
            rest[:, row] = right
        return matrix, rest

    def own(self, index: int) -> Any:
        """What a statement gives as it stands, in the form of `edited`."""
        return self.edited(index, [self.spelling.statements[index].sides])

    def several(self, sides: Mapping[int, tuple[ast.expr, ...]]) -> dict[int, Any]:
        """Changes for `followed` of statements that are to be computed in turn."""

        def later(made: tuple[ast.expr, ...]) -> Callable[[Columns], Any]:
            if len(made) == 1:
                return lambda names: value(made[0], names)
            return lambda names: tuple(value(side, names) for side in made)

        return {index: later(made) for index, made in sides.items()}

    def followed(self, changes: Mapping[int, Any], overlay: Columns | None = None) -> Outcome:
        """The rest of the program after statements gave ``changes`` (of `edited`), and with other
        values of the scene (``overlay``); K edits at once."""
        names: dict[str, Any] = dict(overlay or {})
        residuals: dict[int, Any] = {}
        sides: dict[int, tuple[Any, Any]] = {}
        everything = _Layered(names, self.names)
        moved = set(names)
        for index, one in enumerate(self.spelling.statements):
            touched = not moved.isdisjoint(self.spelling.reads[index])
            if index not in changes and not touched:
                pass
            elif one.target:
                found = changes.get(index)
                if callable(found):
                    found = found(everything)
                if found is None:
                    found = value(one.sides[0], everything)
                if self.clamped is not None and one.target in self.clamped:
                    residuals[index] = found - everything[one.target]
                    continue
                names[one.target] = found
                moved.add(one.target)
            elif self.clamped is not None:
                found = changes.get(index)
                if callable(found) or found is None:
                    below = _Layered(names, {**self.names, **self._unknowns({})})
                    left, right = (
                        found(below)
                        if found is not None
                        else tuple(value(side, below) for side in one.sides)
                    )
                    found = left - right
                residuals[index] = found
            else:
                found = changes.get(index)
                if found is not None and not callable(found):
                    sides[index] = found[1:], -found[0]
                else:
                    below = _Layered({**names, **self._deep}, self.names)
                    left, right = (
                        found(below)
                        if found is not None
                        else tuple(value(side, below) for side in one.sides)
                    )
                    sides[index] = _form(left, right, len(self.spelling.unknown) + 1)
            if (
                self.spelling.equations
                and index == self.spelling.equations[-1]
                and self.clamped is None
                and sides
            ):
                names |= self._solved(sides)
                moved |= set(self.spelling.unknown)
        return Outcome(names, residuals)

    def _solved(self, changed: Mapping[int, tuple[Any, Any]]) -> dict[str, Any]:
        """The unknowns, NaN where the equations have no solution."""
        sides = {**self._sides, **changed}
        lead = np.broadcast_shapes(
            (1, self.size),
            *(np.shape(right) for _, right in sides.values()),
            *(np.shape(left)[1:] for left, _ in sides.values()),
        )
        count = len(self.spelling.unknown)
        matrix, rest = np.empty((*lead, count, count)), np.empty((*lead, count))
        for row, index in enumerate(self.spelling.equations):
            left, right = sides[index]
            for column in range(count):
                matrix[..., row, column] = left[column]
            rest[..., row] = right
        found = solved(matrix, rest)
        if not changed:
            found = found[0]
        return {name: found[..., place] for place, name in enumerate(self.spelling.unknown)}


class Outcome:
    """Names and residuals that edits change: (K, n), or (n,) where they are alike."""

    def __init__(self, names: dict[str, Any], residuals: dict[int, Any]) -> None:
        self.names, self.residuals = names, residuals


class _Layered(dict[str, Any]):
    """Names over others."""

    def __init__(self, above: Mapping[str, Any], below: Mapping[str, Any]) -> None:
        super().__init__()
        self._above, self._below = above, below

    def __getitem__(self, name: str) -> Any:
        return self._above[name] if name in self._above else self._below[name]


def _form(left: Any, right: Any, count: int) -> tuple[Any, Any]:
    """Coefficients and right-hand side of sides evaluated on the basis (count, 1, 1)."""
    if np.ndim(right) > 2:
        left, right = np.subtract(left, right), 0.0
    if np.ndim(left) < 3:
        left = np.broadcast_to(left, (count, *np.shape(left)))
    return left[1:] - left[0], right - left[0]


def solved(matrix: Floats, rest: Floats) -> Floats:
    """Solutions of systems (..., m, m); NaN where there is none."""
    usable = np.asarray(np.isfinite(matrix).all((-1, -2)) & np.isfinite(rest).all(-1))
    # rows are scaled, so that a small row is no singular one
    size = np.abs(np.where(usable[..., None, None], matrix, 1.0)).max(-1)
    usable &= (size > 0).all(-1)
    size = np.where(size > 0, size, 1.0)
    count = matrix.shape[-1]
    matrix = np.where(usable[..., None, None], matrix / size[..., None], np.eye(count))
    rest = np.where(usable[..., None], rest / size, 0.0)
    try:
        found = np.linalg.solve(matrix, rest[..., None])[..., 0]
    except np.linalg.LinAlgError:
        signs, _ = np.linalg.slogdet(matrix)
        usable &= signs != 0
        matrix = np.where(usable[..., None, None], matrix, np.eye(count))
        found = np.linalg.solve(matrix, rest[..., None])[..., 0]
    return np.where(usable[..., None], found, np.nan)


def chunks(count: int, scenes: int) -> Iterator[slice]:
    """Slices of ``count`` edits that are computed together."""
    step = max(1, AT_ONCE // max(scenes, 1))
    for start in range(0, count, step):
        yield slice(start, start + step)
