"""Computing a plan's results over arrays of scenes: by the compiled library, or by numpy.

The library (`machine.c`, with `formulas` as C) runs strips of 128 scenes; numpy runs the same
functions over longer strips, to the same bits.
"""

import ctypes
import math
import os
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import library
from ..errors import UserError
from ..names import PIVOT
from . import consequences, formulas
from .plan import COLUMNS, COMPILED, FORMULAS, NUMBERS, OTHERS, PIVOTS, ROWS, Plan
from .translate import digest

Array = NDArray[Any]
Floats = NDArray[np.float64]

STRIP = 2048  # scenes that numpy computes at a time: some fifty arrays fit the second-level cache
SCENES_PER_THREAD = 1 << 14  # fewer are not worth starting a thread
MAX_BLOCK = 1 << 25  # bytes; the C library maps larger arrays anew each time, page by page
NOT_FINITE = 64.0
SHARED = "out: a result shares memory with a column or another result"
FINITE, ANY_SIZE, BITS, RAW = range(4)  # kinds of results in `machine.c`
_ONE = np.float64(1.0)
_address_of, _buffer_of = ctypes.addressof, ctypes.c_char.from_buffer
FUNCTIONS: dict[str, Callable[..., tuple[Any, ...]]] = {
    name: getattr(formulas if name in COMPILED else consequences, name) for name in FORMULAS
}


def _load() -> Any:
    """Return the library with its functions declared, None where there is none."""
    compiled = library.loaded("mechanics_formulas", digest())
    if compiled is not None:
        number, pointer = ctypes.c_int64, ctypes.c_void_p
        compiled.solve.argtypes, compiled.solve.restype = [pointer, pointer, number, number], None
    return compiled


_compiled = _load()


class Kernel:
    """The computation of a plan in which some inputs vary from scene to scene.

    Parameters
    ----------
    plan : Plan
        Steps and inputs; ``fit`` is among its results where ``checked``.
    wanted : tuple of str
        Names of the results, none of them an input.
    varying : frozenset of str
        Names of the inputs that have a number for each scene.
    checked : bool
        Whether results are made NaN where a scene cannot be used, or are not finite.
    """

    def __init__(
        self,
        plan: Plan,
        wanted: tuple[str, ...],
        varying: frozenset[str],
        checked: bool,
    ) -> None:
        self.fixed = [name for name in plan.inputs if name not in varying]
        self.changing = [name for name in plan.inputs if name in varying]
        self.wanted = wanted
        self._varying = varying
        self._checked = checked
        changing = set(varying)
        once: list[tuple[str, int]] = []
        each: list[tuple[str, int]] = []
        for name, guard in plan.steps:
            formula = FORMULAS[name]
            if changing.isdisjoint(formula.takes):
                once.append((name, 0))  # a later strip may have the pivots that the first lacks
            else:
                each.append((name, guard))
                changing.update(formula.gives)
        self._steps = once + each
        if checked:
            kinds = {"STATUS": BITS, "COND": ANY_SIZE}
            self._kinds = [kinds.get(name, FINITE) for name in wanted]
        else:
            self._kinds = [RAW] * len(wanted)
        given = {name for step, _ in plan.steps for name in FORMULAS[step].gives}
        # a formula would replace a known quantity in its row
        self._is_translated = given.isdisjoint(plan.inputs)
        first = len(COLUMNS)
        pairs = [(ROWS[name], int(name in varying)) for name in (*self.fixed, *self.changing)]
        pairs += [(NUMBERS[name], guard) for name, guard in self._steps]
        pairs += [(ROWS[n] - first, kind) for n, kind in zip(wanted, self._kinds, strict=True)]
        fit = ROWS["fit"] - first if checked else 0
        sizes = [len(plan.inputs), len(once), len(self._steps), len(wanted), fit]
        self._plan = np.array([*sizes, *(x for pair in pairs for x in pair)], np.int64)
        self._address = self._plan.ctypes.data

    @property
    def is_compiled(self) -> bool:
        """Whether the compiled library computes it."""
        return _compiled is not None and self._is_translated and not library.is_switched_off()

    def new_results(self, shape: tuple[int, ...]) -> tuple[dict[str, Array], list[int]]:
        """Return arrays for results, rows of as few as possible, and their addresses."""
        size = 8 * math.prod(shape)
        together = max(1, MAX_BLOCK // max(1, size))
        numbers = [n for n, kind in zip(self.wanted, self._kinds, strict=True) if kind != BITS]
        arrays: dict[str, Array] = {}
        starts: list[int] = []
        for begin in range(0, len(numbers), together):
            group = numbers[begin : begin + together]
            block = np.empty((len(group), *shape))
            first = address(block)
            for row, name in enumerate(group):
                arrays[name] = block[row, ...]
                starts.append(first + size * row)
        if len(numbers) < len(self.wanted):
            bits = np.empty(shape, np.uint16)
            starts.insert(self.wanted.index("STATUS"), address(bits))
            arrays["STATUS"] = bits
            arrays = {name: arrays[name] for name in self.wanted}
        return arrays, starts

    def compute(
        self,
        inputs: Mapping[str, Any],
        shape: tuple[int, ...],
        out: Mapping[str, Array] | None,
        threads: int | None,
    ) -> dict[str, Array]:
        """Return results of inputs.

        Parameters
        ----------
        inputs : mapping of str to float or ndarray
            The plan's inputs: numbers, and contiguous float64 arrays of one length where they vary.
        shape : tuple of int
            The shape of the results, of that size.
        out : mapping of str to ndarray or None
            Arrays to write the results into; None for new ones.
        threads : int or None
            The number of threads, None for as many as there are processors and work.
        """
        places = addresses([inputs[name] for name in self.changing])
        if out is None:
            arrays, starts = self.new_results(shape)
        else:
            if lacking := [name for name in self.wanted if name not in out]:
                raise UserError(f"out lacks {' '.join(lacking)}; expected an array for each result")
            arrays = {name: out[name] for name in self.wanted}
            starts = check_output(arrays, shape, places)
        count = math.prod(shape)
        if self.is_compiled:
            numbers = np.array([inputs[name] for name in self.fixed])
            first = address(numbers)
            fixed = range(first, first + numbers.nbytes, 8)
            self.run_at([*fixed, *places, *starts], count, threads)
            return arrays
        flat = [array.reshape(-1) for array in arrays.values()]
        for start in range(0, count, STRIP):
            part = slice(start, start + STRIP)
            values = {name: np.float64(inputs[name]) for name in self.fixed}
            values.update({name: inputs[name][part] for name in self.changing})
            self._run_strip(values, [array[part] for array in flat])
        return arrays

    def run_at(self, starts: Sequence[int], count: int, threads: int | None) -> None:
        """Compute ``count`` scenes by the library, given the addresses of numbers, of arrays and of
        results, in the order of `inputs`."""
        places = np.array(starts, np.int64)
        run_in_threads(partial(_compiled.solve, self._address, address(places)), count, threads)

    @np.errstate(all="ignore")
    def _run_strip(self, value: dict[str, Any], results: Sequence[Array]) -> None:
        """Compute a strip by numpy."""
        known = frozenset(value)
        is_pivot = np.asarray(value.get("MU", 0.0)) == PIVOT
        for name, guard in self._steps:
            formula = FORMULAS[name]
            if (guard == PIVOTS and not is_pivot.any()) or (guard == OTHERS and is_pivot.all()):
                value.update(dict.fromkeys(formula.gives, _ONE))
                continue
            computed = FUNCTIONS[name](*[value[operand] for operand in formula.takes])
            for quantity, array in zip(formula.gives, computed, strict=True):
                if quantity not in known:
                    value[quantity] = array
        for to, name, kind in zip(results, self.wanted, self._kinds, strict=True):
            if kind == RAW:
                to[:] = value[name]
                continue
            largest = np.inf if kind == ANY_SIZE else formulas.LARGEST
            is_usable = (value["fit"] == 1.0) & (np.abs(value[name]) <= largest)
            to[:] = np.where(is_usable, value[name] + 0.0, NOT_FINITE if kind == BITS else np.nan)


def address(array: Any) -> int:
    """Return the address of an array's first element."""
    return addresses([array])[0]


def addresses(arrays: Sequence[Any]) -> list[int]:
    """Return the addresses of arrays' first elements."""
    try:  # four times as fast as the array's interface
        return [_address_of(_buffer_of(array)) for array in arrays]
    except (TypeError, ValueError):  # one is read-only or empty
        return [array.__array_interface__["data"][0] for array in arrays]


def run_in_threads(work: Callable[[int, int], object], count: int, threads: int | None) -> None:
    """Call ``work(begin, end)`` for parts of ``count`` scenes, `SCENES_PER_THREAD` at least on each
    thread."""
    parts = count // SCENES_PER_THREAD
    if parts > 1:
        parts = min(parts, threads or os.cpu_count() or 1)
    if parts < 2:
        work(0, count)
        return
    from concurrent.futures import ThreadPoolExecutor

    ends = [count * k // parts for k in range(parts + 1)]
    with ThreadPoolExecutor(parts) as pool:
        list(pool.map(work, ends[:-1], ends[1:]))


def check_output(
    results: Mapping[str, Array], shape: tuple[int, ...], inputs: Sequence[int]
) -> list[int]:
    """Return the addresses of arrays to write results of scenes of a shape into. Raises UserError
    for arrays that cannot take them; ``inputs``: the addresses of the columns."""
    for name, array in results.items():
        kind = np.uint16 if name == "STATUS" else np.float64
        if not (isinstance(array, np.ndarray) and array.shape == shape and array.dtype == kind):
            raise UserError(f"out, {name}: expected an array of {kind.__name__} of shape {shape}")
        if not array.flags.carray:
            raise UserError(f"out, {name}: expected a contiguous array that can be written to")
    starts = addresses(list(results.values()))
    parts = [(at, array.nbytes, True) for at, array in zip(starts, results.values(), strict=True)]
    parts += [(at, 8 * math.prod(shape), False) for at in inputs]
    for (first, size, is_result), (second, _, is_other) in pairwise(sorted(parts)):
        # columns may overlap each other
        if second - first < size and (is_result or is_other):
            raise UserError(SHARED)
    return starts
