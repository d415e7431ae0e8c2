"""A plan for the compiled machine: the same expressions, in one pass over the scenes.

`plan.Plan` hands numpy one operation at a time; here the same operations, in the same order and
with the same roundings, become a program of `impact88.native`. A product that only one sum needs is
taken together with that sum, each still rounded by itself.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from .. import native
from ..names import SCENE
from . import degrees
from .formulas import Expression
from .plan import PROJECTIONS, in_order

Array = NDArray[np.float64]
Addresses = NDArray[np.int64]

_OPERATIONS = """ADD SUBTRACT MULTIPLY DIVIDE NEGATIVE ABSOLUTE SQRT
    PRODUCT_PLUS PRODUCT_MINUS MINUS_PRODUCT PRODUCTS_PLUS PRODUCTS_MINUS
    SINE_AND_COSINE AGAINST CHOOSE EQUAL LESS LESS_OR_EQUAL EITHER BOTH NOT HYPOT
    RESULT RESULT_OR_INFINITE BITS"""
_CODES = {name: code for code, name in enumerate(_OPERATIONS.split())}
_ROWS = {name: row for row, name in enumerate(SCENE)}
_PLAIN = {
    **{"add": "ADD", "subtract": "SUBTRACT", "multiply": "MULTIPLY", "divide": "DIVIDE"},
    **{"negative": "NEGATIVE", "absolute": "ABSOLUTE", "sqrt": "SQRT", "against": "AGAINST"},
    **{"sine_and_cosine": "SINE_AND_COSINE", "choose": "CHOOSE", "equal": "EQUAL"},
    **{"less": "LESS", "less_or_equal": "LESS_OR_EQUAL", "both": "BOTH", "either": "EITHER"},
    **{"not": "NOT", "hypot": "HYPOT"},
}
"""Operation of an expression -> the machine's."""


class _Circle(ctypes.Structure):
    """What `degrees.sine_and_cosine` works with."""

    _fields_ = (
        ("turn", ctypes.c_void_p),
        *((name, ctypes.c_double) for name in "per_step step shift s0 s1 s2 c1 c2".split()),
        ("steps", ctypes.c_int64),
    )


_CIRCLE = _Circle(
    degrees.table().ctypes.data,
    1 / degrees.STEP,
    degrees.STEP,
    degrees.INTEGER_IN_LOW_BITS,
    *degrees.POLYNOMIALS,
    degrees.STEPS,
)


class Program:
    """The program that computes ``results`` (name -> expression).

    ``columns``: the varying columns it reads, ``rows``: their numbers in the scene's table;
    ``scalars``: constants and the names of the columns
    that do not vary, in the order `run` wants their values.
    """

    def __init__(self, results: Mapping[str, Expression]) -> None:
        order = in_order(list(results.values()))
        self.results = list(results)
        self.columns = [str(e.value) for e in order if e.operation == "column" and e.varies]
        self.rows = np.array([_ROWS[name] for name in self.columns], np.int64)
        leaves = [e for e in order if e.operation in ("column", "constant") and not e.varies]
        self.scalars: list[float | str] = [e.value for e in leaves if e.value is not None]
        self._place: dict[int, int] = {}
        for e in order:
            if e.operation == "column" and e.varies:
                self._place[id(e)] = len(self._place)
        self._moving = len(self.columns) + len(results)
        for number, e in enumerate(leaves):
            self._place[id(e)] = self._moving + number
        self._taken = self._moving + len(leaves)
        self._free: list[int] = []
        self._steps: list[list[int]] = []
        work = [e for e in order if e.operation not in ("column", "constant", "bits")]
        once = [e for e in work if not e.varies]
        varying = [e for e in work if e.varies]
        shown = [e.operands[0] if e.operation == "bits" else e for e in results.values()]
        self._write(once, [*shown, *(x for e in varying for x in e.operands)], keep=True)
        self._once = len(self._steps)
        self._write(varying, shown, keep=False)
        for number, (name, e) in enumerate(results.items()):
            kind = "RESULT_OR_INFINITE" if name == "COND" else "RESULT"
            kind = "BITS" if e.operation == "bits" else kind
            self._step(kind, self._place[id(shown[number])], len(self.columns) + number)
        self._code = np.array(self._steps, np.int32)
        widths = [8] * len(self.columns) + [2 if e.dtype == "bits" else 8 for e in results.values()]
        self._width = np.array(widths, np.int64)

    def _step(self, name: str, *places: int) -> None:
        self._steps.append([_CODES[name], *places, *[0] * (5 - len(places))])

    def _write(self, work: Sequence[Expression], kept: Sequence[Expression], keep: bool) -> None:
        """Append the steps for ``work``, each value in a strip of its own for as long as it is
        needed; for good if ``keep``, or if it is one of ``kept``."""
        fused = self._with_products(work, kept)
        joined = {id(e) for operands in fused.values() for e in operands[1]}
        steps = [e for e in work if id(e) not in joined and e.operation not in PROJECTIONS]
        last = {}
        for e in steps:
            for operand in self._operands(e, fused):
                last[id(operand)] = id(e)
        needed = {id(e) for e in kept}

        def release(values: Iterable[Expression], after: Expression) -> None:
            for value in {id(v): v for v in values}.values():
                mine = last.get(id(value)) in (None, id(after)) and id(value) in own
                if mine and not keep and id(value) not in needed:
                    self._free.append(own.pop(id(value)))

        own: dict[int, int] = {}
        for e in steps:
            name, _ = fused.get(id(e), (_PLAIN[e.operation], ()))
            operands = self._operands(e, fused)
            places = [self._place[id(operand)] for operand in operands]
            made = [e]
            if e.operation == "sine_and_cosine":
                made = [e.table.half(e, half) for half in PROJECTIONS]
            else:
                release(operands, e)
            for value in made:
                place = self._free.pop() if self._free else self._taken
                self._taken = max(self._taken, place + 1)
                self._place[id(value)] = own[id(value)] = place
            self._step(name, *places, *(self._place[id(value)] for value in made))
            if e.operation == "sine_and_cosine":
                release([*operands, *(v for v in made if id(v) not in last)], e)

    def _operands(
        self, e: Expression, fused: Mapping[int, tuple[str, tuple[Expression, ...]]]
    ) -> list[Expression]:
        """What a step reads: the factors of the products that are taken with it."""
        if id(e) not in fused:
            return list(e.operands)
        products = fused[id(e)][1]
        factors = [factor for product in products for factor in product.operands]
        others = [operand for operand in e.operands if operand not in products]
        return factors + others

    def _with_products(
        self, work: Sequence[Expression], kept: Sequence[Expression]
    ) -> dict[int, tuple[str, tuple[Expression, ...]]]:
        """Sums that take products with them: id -> (operation, products)."""
        uses: dict[int, int] = {id(e): 2 for e in kept}
        for e in work:
            for operand in e.operands:
                uses[id(operand)] = uses.get(id(operand), 0) + 1
        mine = {id(e) for e in work}

        def free(e: Expression) -> bool:
            return e.operation == "multiply" and uses[id(e)] == 1 and id(e) in mine

        fused: dict[int, tuple[str, tuple[Expression, ...]]] = {}
        for e in work:
            if e.operation not in ("add", "subtract"):
                continue
            left, right = e.operands
            plus = e.operation == "add"
            if free(left) and free(right):
                fused[id(e)] = ("PRODUCTS_PLUS" if plus else "PRODUCTS_MINUS"), (left, right)
            elif free(left):
                fused[id(e)] = ("PRODUCT_PLUS" if plus else "PRODUCT_MINUS"), (left,)
            elif free(right):
                fused[id(e)] = ("PRODUCT_PLUS" if plus else "MINUS_PRODUCT"), (right,)
        return fused

    def room(self) -> Array:
        """Working memory, a set for each thread."""
        size = self._taken * native.STRIP
        block = np.empty(size + 8)
        start = -block.ctypes.data % 64 // 8  # at the start of a cache line
        return block[start : start + size].reshape(self._taken, native.STRIP)

    def run(
        self,
        fixed: Mapping[str, float],
        columns: Addresses,
        results: Addresses,
        checked: Addresses,
        limits: Array,
        count: int,
        room: Array,
    ) -> int:
        """Run it over ``count`` scenes. ``columns``, ``results``: of float64 columns (of uint16 for
        bits), in the program's order; ``fixed``: the columns that do not vary.

        Returns how many scenes were done: all, or those before the strip in which one of the
        columns ``checked`` leaves its ``limits`` (least and most).
        """
        assert native.library is not None
        values = np.array([fixed[x] if isinstance(x, str) else x for x in self.scalars], float)
        moving = np.concatenate([columns, results])
        return int(
            native.library.run(
                self._code.ctypes.data,
                self._once,
                len(self._code),
                moving.ctypes.data,
                self._width.ctypes.data,
                len(columns),
                self._moving,
                values.ctypes.data,
                len(values),
                checked.ctypes.data,
                limits.ctypes.data,
                len(checked),
                count,
                ctypes.addressof(_CIRCLE),
                room.ctypes.data,
                self._taken,
            )
        )


def extremes(columns: Addresses, count: int) -> Array:
    """The least and the largest of ``count`` numbers of each column; both NaN where one is."""
    assert native.library is not None
    found = np.empty((len(columns), 2))
    native.library.survey(columns.ctypes.data, len(columns), count, found.ctypes.data)
    return found


def addresses(arrays: Iterable[NDArray[np.generic]]) -> Addresses:
    """Where arrays begin in memory."""
    return np.array([array.ctypes.data for array in arrays], np.int64)
