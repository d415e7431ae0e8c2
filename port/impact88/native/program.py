"""Programs for the compiled machine, made of expressions.

An expression has an ``operation``, ``operands``, and says whether it ``varies`` from scene to
scene; a column or constant has a ``value``. Each operation becomes a step of the machine, in the
order of the formulas and with their roundings. A product that only one sum needs is taken together
with that sum, each still rounded by itself.
"""

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import native

Array = NDArray[np.float64]
Addresses = NDArray[np.int64]

PROJECTIONS = ("sine", "cosine")
"""The two values that sine_and_cosine makes."""
_APART = ("sine_and_cosine", "real_multiply")
"""Operations that must not write over an operand."""


def in_order(results: Sequence[Any]) -> list[Any]:
    """All expressions the results depend on, operands before what is made of them."""
    seen: set[int] = set()
    order: list[Any] = []
    stack = [(e, False) for e in reversed(results)]
    while stack:
        e, ready = stack.pop()
        if id(e) in seen:
            continue
        if ready:
            seen.add(id(e))
            order.append(e)
        else:
            stack.append((e, True))
            stack.extend((operand, False) for operand in reversed(e.operands))
    return order


class Program:
    """The program that computes ``results`` (name -> expression), each finished by an operation of
    the machine's in ``endings``, such as RESULT; BITS makes whole numbers of 16 bits.

    ``columns``: the varying columns it reads; ``scalars``: constants and the names of the columns
    that do not vary, by which `run` finds their values.
    """

    def __init__(self, results: Mapping[str, Any], endings: Sequence[str]) -> None:
        assert native.library is not None
        order = in_order(list(results.values()))
        self.results = list(results)
        self.columns = [str(e.value) for e in order if e.operation == "column" and e.varies]
        leaves = [e for e in order if e.operation in ("column", "constant") and not e.varies]
        self.scalars: list[float | str] = [e.value for e in leaves if e.value is not None]
        self._place: dict[int, int] = {}
        for e in order:
            if e.operation == "column" and e.varies:
                self._place[id(e)] = len(self._place)
        self.moving = len(self.columns) + len(results)
        for number, e in enumerate(leaves):
            self._place[id(e)] = self.moving + number
        self.places = self.moving + len(leaves)
        self._free: list[int] = []
        self.steps: list[tuple[str, tuple[int, ...]]] = []
        work = [e for e in order if e.operation not in ("column", "constant")]
        once = [e for e in work if not e.varies]
        often = [e for e in work if e.varies]
        self._write(once, [*results.values(), *(x for e in often for x in e.operands)])
        self.once = len(self.steps)
        self._write(often, list(results.values()))
        for number, (e, ending) in enumerate(zip(results.values(), endings, strict=True)):
            self._step(ending, self._place[id(e)], len(self.columns) + number)
        if self.places > native.library.most_places():
            raise MemoryError(f"a program of {self.places} values")
        codes = _codes()
        code = [[codes[name], *places, *[0] * (5 - len(places))] for name, places in self.steps]
        self.code = np.array(code, np.int32)
        widths = [8] * len(self.columns) + [2 if ending == "BITS" else 8 for ending in endings]
        self.width = np.array(widths, np.int64)
        self._rooms: list[Room] = []
        self.kernel = native.library.kernel_of(self.digest)

    @property
    def digest(self) -> int:
        """By what the machine knows a program that it has as a whole."""
        text = repr((self.columns, self.results, self.scalars, self.steps)).encode()
        return int.from_bytes(hashlib.blake2b(text, digest_size=8).digest())

    def _step(self, name: str, *places: int) -> None:
        self.steps.append((name, places))

    def _write(self, work: Sequence[Any], kept: Sequence[Any]) -> None:
        """Append the steps for ``work``, each value in a strip of its own for as long as it is
        needed; for good if it is one of ``kept``."""
        fused = self._with_products(work, kept)
        joined = {id(e) for operands in fused.values() for e in operands[1]}
        steps = [e for e in work if id(e) not in joined and e.operation not in PROJECTIONS]
        last = {}
        for e in steps:
            for operand in self._operands(e, fused):
                last[id(operand)] = id(e)
        needed = {id(e) for e in kept}

        def release(values: Iterable[Any], after: Any) -> None:
            for value in {id(v): v for v in values}.values():
                mine = last.get(id(value)) in (None, id(after)) and id(value) in own
                if mine and id(value) not in needed:
                    self._free.append(own.pop(id(value)))

        own: dict[int, int] = {}
        for e in steps:
            name, _ = fused.get(id(e), (e.operation.upper(), ()))
            operands = self._operands(e, fused)
            places = [self._place[id(operand)] for operand in operands]
            made = [e]
            if e.operation == "sine_and_cosine":
                made = [e.table.half(e, half) for half in PROJECTIONS]
            elif e.operation not in _APART:
                release(operands, e)
            for value in made:
                place = self._free.pop() if self._free else self.places
                self.places = max(self.places, place + 1)
                self._place[id(value)] = own[id(value)] = place
            self._step(name, *places, *(self._place[id(value)] for value in made))
            if e.operation in _APART:
                release([*operands, *(v for v in made if id(v) not in last)], e)

    def _operands(self, e: Any, fused: Mapping[int, tuple[str, tuple[Any, ...]]]) -> list[Any]:
        """What a step reads: the factors of the products that are taken with it."""
        if id(e) not in fused:
            return list(e.operands)
        products = fused[id(e)][1]
        factors = [factor for product in products for factor in product.operands]
        others = [operand for operand in e.operands if operand not in products]
        return factors + others

    def _with_products(
        self, work: Sequence[Any], kept: Sequence[Any]
    ) -> dict[int, tuple[str, tuple[Any, ...]]]:
        """Sums that take products with them: id -> (operation, products)."""
        uses: dict[int, int] = {id(e): 2 for e in kept}
        for e in work:
            for operand in e.operands:
                uses[id(operand)] = uses.get(id(operand), 0) + 1
        mine = {id(e) for e in work}

        def free(e: Any) -> bool:
            return e.operation == "multiply" and uses[id(e)] == 1 and id(e) in mine

        fused: dict[int, tuple[str, tuple[Any, ...]]] = {}
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

    def run(
        self,
        columns: Addresses,
        results: Addresses,
        count: int,
        circle: int = 0,
        fixed: Mapping[str, float] = {},
        checked: Addresses | None = None,
        limits: Array | None = None,
    ) -> int:
        """Run it over ``count`` scenes. ``columns``, ``results``: of float64 columns (of uint16 for
        bits), in the program's order; ``fixed``: the columns that do not vary; ``circle``: where
        sines come from, see `closedform.fused`.

        Returns how many scenes were done: all, or those before the strips among which one of the
        columns ``checked`` leaves its ``limits``, an array of the least and the most of each.
        """
        assert native.library is not None
        room = self._rooms.pop() if self._rooms else Room(self)
        room.moving[: len(columns)] = columns
        room.moving[len(columns) :] = results
        if fixed:
            room.values[:] = [fixed[x] if isinstance(x, str) else x for x in self.scalars]
        done: int = native.library.run(*room.arguments(checked, limits, count, circle))
        self._rooms.append(room)
        return done


class Room:
    """Working memory of a program, for one thread at a time, and what the machine gets to know of
    both."""

    def __init__(self, program: Program) -> None:
        self.moving = np.empty(program.moving, np.int64)
        self.values = np.array([0.0 if isinstance(x, str) else x for x in program.scalars], float)
        self._block = np.empty(program.places * native.STRIP + 8)
        start = self._block.ctypes.data + -self._block.ctypes.data % 64  # of a cache line
        code, width = program.code, program.width
        self._program = (
            *(code.ctypes.data, program.once, len(code)),
            *(self.moving.ctypes.data, width.ctypes.data, len(program.columns), program.moving),
            *(self.values.ctypes.data, len(self.values)),
        )
        self._memory = (start, program.places, program.kernel)

    def arguments(
        self, checked: Addresses | None, limits: Array | None, count: int, circle: int
    ) -> Sequence[int]:
        """What the machine's ``run`` takes."""
        looked_at = 0, 0, 0
        if checked is not None and limits is not None:
            looked_at = checked.ctypes.data, limits.ctypes.data, len(checked)
        return (*self._program, *looked_at, count, circle, *self._memory)


@cache
def _codes() -> dict[str, int]:
    """The machine's operations, numbered as it does."""
    assert native.library is not None
    return {name: code for code, name in enumerate(native.library.operations().decode().split())}


def extremes(columns: Addresses, count: int) -> tuple[list[float], list[float]]:
    """The least and the largest of ``count`` numbers of each column; both NaN where one is."""
    assert native.library is not None
    found = np.empty((len(columns), 2))
    native.library.survey(columns.ctypes.data, len(columns), count, found.ctypes.data)
    least, most = found.T.tolist()
    return least, most


def addresses(arrays: Iterable[NDArray[np.generic]]) -> Addresses:
    """Where arrays begin in memory."""
    return np.array([array.ctypes.data for array in arrays], np.int64)


def read_numbers(text: bytes, count: int) -> tuple[Array, NDArray[np.bool_]]:
    """The Apple's reals that ``count`` decimal texts are, each ended by a newline, extension
    included; and which are left to others (True): no plain numbers, or very large or small."""
    assert native.library is not None
    values, odd = np.empty(count), np.empty(count, np.bool_)
    native.library.read_numbers(text, count, values.ctypes.data, odd.ctypes.data)
    return values, odd


def write_numbers(values: Array) -> tuple[NDArray[np.str_], NDArray[np.bool_]]:
    """The characters PRINT makes of reals, and which are left to others (True)."""
    assert native.library is not None
    texts = np.empty(values.shape, f"<U{native.library.text_width()}")
    odd = np.empty(values.shape, np.bool_)
    values = np.ascontiguousarray(values)
    native.library.write_numbers(
        values.ctypes.data, values.size, texts.ctypes.data, odd.ctypes.data
    )
    return texts, odd
