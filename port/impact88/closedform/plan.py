"""Plans: expressions put in order and run over blocks of scenes, a tile at a time.

A plan is a list of passes. Each pass is one numpy operation over a *tile*, a run of scenes short
enough that its working arrays stay in the processor's cache, and writes into a working array that
was allotted beforehand and is used again as soon as its value is no longer needed. Values that are
the same for all scenes are computed once per block, as arrays of length 1.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..native.formulas import Expression
from ..native.program import PROJECTIONS, in_order
from .degrees import sine_and_cosine

Array = NDArray[Any]

_DTYPES = {"float": np.float64, "bool": np.bool_, "bits": np.uint16}


def _against(value: Array, slip: Array, out: Array) -> None:
    np.copyto(out, value)
    np.negative(value, out=out, where=slip > 0)


def _choose(where: Array, a: Array, b: Array, out: Array) -> None:
    np.copyto(out, b)
    np.copyto(out, a, where=where)


def _bits(number: Array, out: Array) -> None:
    np.copyto(out, number, casting="unsafe")


OPERATIONS: dict[str, Callable[..., object]] = {
    "add": np.add,
    "subtract": np.subtract,
    "multiply": np.multiply,
    "divide": np.divide,
    "negative": np.negative,
    "absolute": np.absolute,
    "sqrt": np.sqrt,
    "equal": np.equal,
    "less": np.less,
    "less_or_equal": np.less_equal,
    "both": np.logical_and,
    "either": np.logical_or,
    "not": np.logical_not,
    "bits": _bits,
    "against": _against,
    "choose": _choose,
}
"""Operation -> the function of its operands and ``out``."""


class _Slots:
    """Allots working arrays; one that is free again is handed out first (it is still in cache).

    ``index``: value -> its place; it holds those that are no working arrays, and is added to.
    """

    def __init__(self, index: dict[int, int]) -> None:
        self.dtypes: list[str] = []
        self._index = index
        self._first = len(index)
        self._free: dict[str, list[int]] = {}
        self._taken: dict[int, int] = {}

    def take(self, value: Expression) -> int:
        """The place for a value: its own if it has one already (a result), else a working array."""
        if id(value) not in self._index:
            self._taken[id(value)] = self._next_free(value.dtype)
            self._index[id(value)] = self._first + self._taken[id(value)]
        return self._index[id(value)]

    def _next_free(self, dtype: str) -> int:
        free = self._free.setdefault(dtype, [])
        if not free:
            free.append(len(self.dtypes))
            self.dtypes.append(dtype)
        return free.pop()

    def spare(self, dtype: str, count: int) -> list[int]:
        """Places of ``count`` free working arrays, for the length of one pass."""
        slots = [self._next_free(dtype) for _ in range(count)]
        self._free[dtype] += slots
        return [self._first + slot for slot in slots]

    def give_back(self, value: Expression) -> None:
        """The value is needed no more; its working array, if it has one, is free."""
        if id(value) in self._taken:
            self._free[value.dtype].append(self._taken.pop(id(value)))


class Plan:
    """The passes that compute ``results`` (name -> expression).

    ``columns``: the names of the columns the plan reads, those that vary from scene to scene in
    ``varying``. ``passes``: how many operations it does for each scene.
    """

    def __init__(self, results: Mapping[str, Expression]) -> None:
        self.results = dict(results)
        order = in_order(list(self.results.values()))
        self.columns = [str(e.value) for e in order if e.operation == "column"]
        self.varying = [str(e.value) for e in order if e.operation == "column" and e.varies]
        self._fixed = [e for e in order if not e.varies]
        tiled = [e for e in order if e.varies]
        self.passes = sum(_weight(e) for e in tiled)
        self._schedule(tiled)

    def _schedule(self, tiled: Sequence[Expression]) -> None:
        """Give every value its place and put the passes in order. A place is an index into what
        `run` lays out: fixed values, columns, results (written where the caller wants them), and
        working arrays, which are shared by values that are not needed at the same time."""
        self._index = {id(e): i for i, e in enumerate(self._fixed)}
        self._fixed_steps = [self._fixed_step(e) for e in self._fixed]
        for e in tiled:
            if e.operation == "column":
                self._index[id(e)] = len(self._index)
        self._direct: list[str] = []
        for name, e in self.results.items():
            if e.varies and id(e) not in self._index:
                self._index[id(e)] = len(self._index)
                self._direct.append(name)
        self._slots = slots = _Slots(self._index)
        last_use = {id(operand): e for e in tiled for operand in e.operands}

        def release(e: Expression) -> None:
            for operand in e.operands:
                if last_use[id(operand)] is e:
                    slots.give_back(operand)

        self._steps: list[tuple[Callable[..., object] | None, tuple[int, ...]]] = []
        for e in tiled:
            if e.operation == "column" or e.operation in PROJECTIONS:
                continue
            operands = tuple(self._index[id(operand)] for operand in e.operands)
            if e.operation == "sine_and_cosine":
                halves = [e.table.half(e, half) for half in PROJECTIONS]
                places = [slots.take(half) for half in halves]
                self._steps.append((None, (*operands, *places, *slots.spare("float", 4))))
                for half in halves:
                    if id(half) not in last_use:
                        slots.give_back(half)
            else:
                operation = OPERATIONS[e.operation]
                if isinstance(operation, np.ufunc):
                    # it may write over an operand that nobody needs any more
                    release(e)
                self._steps.append((operation, (*operands, slots.take(e))))
            release(e)

    def _fixed_step(
        self, e: Expression
    ) -> tuple[Callable[..., object] | None, Array | str | int | None, tuple[int, ...], Any]:
        """(operation, payload, places of the operands, dtype) of a value that does not vary; the
        payload of what is no operation: a constant's array, a column's name, a projection's row, or
        None for a sine and cosine."""
        operands = tuple(self._index[id(operand)] for operand in e.operands)
        if e.operation == "constant":
            return None, np.array([e.value], dtype=np.float64), (), None
        if e.operation == "column":
            return None, str(e.value), (), None
        if e.operation in PROJECTIONS:
            return None, PROJECTIONS.index(e.operation), operands, None
        if e.operation == "sine_and_cosine":
            return None, None, operands, None
        return OPERATIONS[e.operation], None, operands, _DTYPES[e.dtype]

    def workspace(self, tile: int) -> list[Array]:
        """The working arrays for tiles of up to ``tile`` scenes (one set for each thread)."""
        return [np.empty(tile, _DTYPES[dtype]) for dtype in self._slots.dtypes]

    def fixed_values(self, columns: Mapping[str, Array]) -> list[Array]:
        """The values that are the same for all scenes of a block, each of length 1.

        ``columns``: arrays of length 1 for the columns that do not vary.
        """
        values: list[Array] = []
        for operation, payload, operands, dtype in self._fixed_steps:
            if operation is not None:
                out: Array = np.empty(1, dtype)
                operation(*[values[i] for i in operands], out)
                values.append(out)
            elif isinstance(payload, str):
                values.append(columns[payload])
            elif isinstance(payload, int):
                # a projection: row 0 or 1 of what sine_and_cosine left
                values.append(values[operands[0]][payload])
            elif payload is None:
                both = np.empty((2, 1))
                work = np.empty((4, 1))
                angle = values[operands[0]]
                sine_and_cosine(angle, both[0], both[1], (work[0], work[1], work[2], work[3]))
                values.append(both)
            else:
                values.append(payload)
        return values

    def run(
        self,
        fixed: Sequence[Array],
        columns: Mapping[str, Array],
        results: Mapping[str, Array],
        workspace: Sequence[Array],
    ) -> None:
        """Compute one tile: read the varying ``columns`` (equally long float64 arrays), write the
        ``results`` (name -> array of that length)."""
        length = len(next(iter(results.values())))
        if workspace and len(workspace[0]) != length:
            workspace = [array[:length] for array in workspace]
        places: list[Array] = [
            *fixed,
            *(columns[name] for name in self.varying),
            *(results[name] for name in self._direct),
            *workspace,
        ]
        for operation, place in self._steps:
            if operation is None:
                a, s, c, w0, w1, w2, w3 = place
                sine_and_cosine(
                    places[a],
                    places[s],
                    places[c],
                    (places[w0], places[w1], places[w2], places[w3]),
                )
            elif len(place) == 3:
                operation(places[place[0]], places[place[1]], places[place[2]])
            else:
                operation(*[places[i] for i in place])
        for name, e in self.results.items():
            if e.dtype == "float":
                # -0.0 becomes 0.0: a zero's sign would tell which path led to it
                np.add(places[self._index[id(e)]], 0.0, out=results[name])
            elif name not in self._direct:
                np.copyto(results[name], places[self._index[id(e)]])


def _weight(e: Expression) -> int:
    """How many passes over the tile an operation makes."""
    if e.operation == "column" or e.operation in PROJECTIONS:
        return 0
    return {"sine_and_cosine": 26, "against": 3, "choose": 2}.get(e.operation, 1)
