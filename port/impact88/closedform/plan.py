"""Plans: expressions put in order and run over blocks of scenes, a tile at a time.

A plan is a list of passes. Each pass is one numpy operation over a *tile*, a run of scenes short
enough that its working arrays stay in the processor's cache, and writes into a working array that
was allotted beforehand and is used again as soon as its value is no longer needed. Values that are
the same for all scenes are computed once per block, as arrays of length 1.
"""

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
        index = self._index = {id(e): i for i, e in enumerate(self._fixed)}
        for e in tiled:
            if e.operation == "column":
                index[id(e)] = len(index)
        self._direct: list[str] = []
        for name, e in self.results.items():
            if e.varies and id(e) not in index:
                index[id(e)] = len(index)
                self._direct.append(name)
        first = len(index)
        last_use = {id(operand): e for e in tiled for operand in e.operands}
        free: dict[str, list[int]] = {dtype: [] for dtype in _DTYPES}
        working: set[int] = set()
        self._dtypes: list[str] = []

        def working_array(dtype: str) -> int:
            if not free[dtype]:
                free[dtype].append(first + len(self._dtypes))
                self._dtypes.append(dtype)
            return free[dtype].pop()  # the last one given back is still in cache

        def place(e: Expression) -> int:
            if id(e) not in index:
                index[id(e)] = working_array(e.dtype)
                working.add(id(e))
            return index[id(e)]

        def release(values: Sequence[Expression], e: Expression) -> None:
            for value in values:
                if last_use.get(id(value), e) is e and id(value) in working:
                    working.discard(id(value))
                    free[value.dtype].append(index[id(value)])

        self._steps: list[tuple[Callable[..., object] | None, tuple[int, ...]]] = []
        for e in tiled:
            if e.operation == "column" or e.operation in PROJECTIONS:
                continue
            operands = tuple(index[id(operand)] for operand in e.operands)
            if e.operation == "sine_and_cosine":
                halves = [e.table.half(e, half) for half in PROJECTIONS]
                places = [place(half) for half in halves]
                spare = [working_array("float") for _ in range(4)]
                free["float"] += spare
                self._steps.append((None, (*operands, *places, *spare)))
                release([*halves, *e.operands], e)
            else:
                operation = OPERATIONS[e.operation]
                if isinstance(operation, np.ufunc):
                    # it may write over an operand that is not needed any more
                    release(e.operands, e)
                self._steps.append((operation, (*operands, place(e))))
                release(e.operands, e)

    def workspace(self, tile: int) -> list[Array]:
        """The working arrays for tiles of up to ``tile`` scenes (one set for each thread)."""
        return [np.empty(tile, _DTYPES[dtype]) for dtype in self._dtypes]

    def fixed_values(self, columns: Mapping[str, Array]) -> list[Array]:
        """The values that are the same for all scenes of a block, each of length 1.

        ``columns``: arrays of length 1 for the columns that do not vary.
        """
        values: dict[int, Array] = {}
        for e in self._fixed:
            operands = [values[id(operand)] for operand in e.operands]
            if e.operation == "constant":
                value = np.array([e.value], np.float64)
            elif e.operation == "column":
                value = columns[str(e.value)]
            elif e.operation in PROJECTIONS:
                value = operands[0][PROJECTIONS.index(e.operation)]
            elif e.operation == "sine_and_cosine":
                value, work = np.empty((2, 1)), np.empty((4, 1))
                both, four = (value[0], value[1]), (work[0], work[1], work[2], work[3])
                sine_and_cosine(operands[0], *both, four)
            else:
                value = np.empty(1, _DTYPES[e.dtype])
                OPERATIONS[e.operation](*operands, value)
            values[id(e)] = value
        return list(values.values())

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
