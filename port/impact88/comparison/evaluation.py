"""Run a spelling on many scenes, with its statements edited, many alternatives at a time.

Arrays have a value for each scene along their last axis; alternatives of an expression are along
the axis before it. What an edit does not reach is not computed again.
"""

from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from types import CodeType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .spellings import VELOCITIES, Statement, spelling

Floats = NDArray[np.float64]
Values = dict[str, Any]
Alternatives = Mapping[str, Sequence[str]]
"""A place in a program, as an edit names it -> expressions that are tried there."""
FITTED = "fitted_constant"
"""The name of a constant that is fitted, in expressions that are tried."""


def round_to_single(x: Any) -> Any:
    """Return numbers rounded to single precision."""
    return np.asarray(x, np.float32).astype(np.float64)


FUNCTIONS: dict[str, Any] = {
    name: getattr(np, name)
    for name in "sin cos tan sqrt hypot where abs sign trunc rint fmod minimum maximum".split()
} | {
    "pi": np.pi,
    "single": round_to_single,
    "round_half_up": lambda x: np.floor(x + 0.5),
}
"""Functions and constants of statements and edits."""


class Edit(NamedTuple):
    """A mistake or a convention.

    ``changes`` maps a statement's target to the expression in its place; a column as it is read is
    "< UX", a result as it is shown "> VAX". ``says`` describes it, if it has a name; ``note``: what
    a constant is known as. The lower the ``rank``, the likelier.
    """

    says: str
    changes: Mapping[str, str]
    rank: int = 0
    note: str = ""


@cache
def _code(text: str) -> CodeType:
    return compile(text, "<statement>", "eval")


def evaluate(text: str, names: Mapping[str, Any]) -> Any:
    """Return an expression's value; NaN where it has none."""
    try:
        return eval(_code(text), FUNCTIONS, names)
    except (ArithmeticError, NameError, TypeError, ValueError):
        return np.nan


def stack(values: Sequence[Any], size: int) -> Any:
    """Return alternatives, each a value for each of ``size`` scenes, as one array."""
    arrays = [np.asarray(value) for value in values]
    largest = max(arrays, key=lambda array: array.ndim)
    shape = (*largest.shape[:-2], len(arrays), size)
    out = np.empty(shape, np.result_type(*{array.dtype for array in arrays}))
    for place, array in enumerate(arrays):  # np.concatenate is slower by far
        out[..., place, :] = array[..., 0, :] if array.ndim > 2 else array
    return out


class Program:
    """A spelling evaluated on scenes, with edits made.

    Parameters
    ----------
    name : str
        The spelling.
    columns : mapping of str to ndarray
        The scenes, the number of the row, and final velocities to take instead of computing them.
    edits : sequence of Edit
        Edits, the later on top of the earlier.
    wanted : sequence of str, optional
        The results that are computed; all by default.
    """

    def __init__(
        self,
        name: str,
        columns: Mapping[str, Floats],
        edits: Sequence[Edit] = (),
        wanted: Sequence[str] = (),
    ) -> None:
        self.name = name
        self.spelling = spelling(name)
        self.size = int(np.size(columns["UX"]))
        self.columns = columns
        self.statements = list(self.spelling.statements)
        if wanted:
            first = self.spelling.results
            self.statements[first:] = _ancestors(self.statements[first:], wanted)
        identity = np.eye(len(self.spelling.unknowns) + 1)[1:]
        self.basis = dict(zip(self.spelling.unknowns, identity[:, :, None, None], strict=True))
        written: dict[str, str] = {}
        for edit in edits:
            written |= edit.changes
        self.statements = [s._replace(text=written.get(s.target, s.text)) for s in self.statements]
        read = {n[2:]: evaluate(t, columns) for n, t in written.items() if n[0] == "<"}
        self.shown = [{key: [text] for key, text in edit.changes.items()} for edit in edits]
        self.linear = {*self.spelling.equations, "slip", "hold"}
        self._plans: dict[tuple[frozenset[str], ...], list[Statement]] = {}
        texts = {statement.target: [statement.text] for statement in self.statements}
        self.computed = self._advance({**columns, **read, FITTED: (np.nan,)}, columns, texts)
        if columns.keys() >= {*VELOCITIES}:
            del self.statements[: self.spelling.results]
        self.base = self._show(self.computed, {})

    def scope(self, target: str, names: Values) -> Values:
        """Return the names that a statement's expression may read, with their values."""
        return {**names, **self.basis} if target in self.linear else names

    def propagate(self, values: Mapping[str, Any]) -> Values:
        """Return all values where some statements or columns have other values."""
        return self._show(self._advance({**self.computed, **values}, values, {}), {})

    def effects(
        self, changes: Iterable[Mapping[str, Any]], names: Iterable[str]
    ) -> dict[str, Floats]:
        """Return by how much each change of values changes results, added up."""
        sums = {name: np.zeros(self.size) for name in names}
        for values in changes:
            outcome = self.propagate(values)
            for name, total in sums.items():
                if outcome[name] is not self.base[name]:
                    total += np.abs(outcome[name] - self.base[name])
        return sums

    def run(self, changes: Alternatives, constants: Iterable[Any] = (np.nan,)) -> Values:
        """Return all values with other expressions in some places.

        ``changes`` has the alternatives of each place, and ``constants`` the value of `FITTED` in
        each of them.
        """
        scope = {**self.columns, FITTED: constants}
        columns = {
            key[2:]: self._values(texts, scope) for key, texts in changes.items() if key[0] == "<"
        }
        names = {**self.computed, FITTED: constants, **columns}
        return self._show(self._advance(names, columns, changes), changes)

    def _values(self, texts: Sequence[str], scope: Values) -> Any:
        """Return the values of alternatives, each with its constant."""
        constants = zip(texts, scope[FITTED], strict=True)
        values = [evaluate(text, {**scope, FITTED: constant}) for text, constant in constants]
        return values[0] if len(values) == 1 else stack(values, self.size)

    def _plan(self, kept: frozenset[str], edited: frozenset[str]) -> list[Statement]:
        """Return the statements to compute where names are changed, and statements edited."""
        dirty, plan = {*kept}, []
        for statement in self.statements:
            target = statement.target
            is_stale = target in edited or not dirty.isdisjoint(statement.reads)
            if is_stale and target not in kept:
                plan.append(statement)
                dirty.update(target.split(", "))
        return plan

    def _advance(self, names: Values, kept: Iterable[str], changes: Alternatives) -> Values:
        """Compute what is edited or follows from names that have other values, and keep these."""
        key = (frozenset(kept), frozenset(changes))
        if key not in self._plans:
            self._plans[key] = self._plan(*key)
        for statement in self._plans[key]:
            target = statement.target
            if statement.is_solution:
                names.update(self._solve([names[name] for name in self.spelling.equations]))
                continue
            scope = self.scope(target, names)
            texts = changes.get(target)
            names[target] = self._values(texts, scope) if texts else evaluate(statement.text, scope)
        return names

    def _show(self, names: Values, changes: Alternatives) -> Values:
        """Return computed values, with results as they are shown."""
        for shown in (*self.shown, changes):
            results = {
                key[2:]: self._values(texts, names) for key, texts in shown.items() if key[0] == ">"
            }
            names = {**names, **results} if results else names
        return names

    def _solve(self, equations: Sequence[Any]) -> dict[str, Any]:
        """Return the unknowns for which the equations are 0; NaN where there are none."""
        matrix, right = self.system(equations)
        good = np.isfinite(matrix.sum((-2, -1))) & np.isfinite(right.sum(-1))
        matrix[~good] = np.eye(right.shape[-1])
        try:
            solution = np.linalg.solve(matrix, right[..., None])[..., 0]
        except np.linalg.LinAlgError:
            good &= np.linalg.det(matrix) != 0
            matrix[~good] = np.eye(right.shape[-1])
            solution = np.linalg.solve(matrix, right[..., None])[..., 0]
        solution[~good] = np.nan
        values = np.moveaxis(solution, -1, 0)
        if values.shape[1] == 1:
            values = values[:, 0]
        return dict(zip(self.spelling.unknowns, values, strict=True))

    def system(self, equations: Sequence[Any] | None = None) -> tuple[Floats, Floats]:
        """Return matrices (alternatives, scenes, m, m) with rows scaled to 1, and right sides."""
        if equations is None:
            equations = [self.base[name] for name in self.spelling.equations]
        count = len(self.spelling.unknowns) + 1
        arrays = [np.asarray(equation, np.float64) for equation in equations]
        alternatives = max([a.shape[-2] for a in arrays if a.ndim > 1], default=1)
        shape = (count, alternatives, self.size)
        residuals = np.array([np.broadcast_to(array, shape) for array in arrays])
        matrix = np.moveaxis(residuals[:, 1:] - residuals[:, :1], (0, 1), (-2, -1))
        right = np.moveaxis(-residuals[:, 0], 0, -1)
        scale = np.abs(matrix).max(-1)
        return matrix / scale[..., None], right / scale


def _ancestors(statements: Sequence[Statement], wanted: Sequence[str]) -> list[Statement]:
    """Return the statements that names need."""
    inputs, chosen = set(wanted), []
    for statement in reversed(statements):
        if statement.target in inputs:
            inputs |= statement.reads
            chosen.append(statement)
    return chosen[::-1]


def statement_of(name: str, target: str) -> Statement:
    """Return a spelling's statement."""
    return next(s for s in spelling(name).statements if s.target == target)
