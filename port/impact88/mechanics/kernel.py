"""Computing quantities over arrays of scenes: by the compiled library, or by numpy.

The library (`kernel.c`, with `formulas` as C) runs strips of 128 scenes; numpy runs the same
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
from .plan import COMPILED, FORMULAS, OTHERS, PIVOTS, ROWS
from .translate import digest

Array = NDArray[Any]

STRIP = 2048  # scenes that numpy computes at a time: some fifty arrays fit the second-level cache
SCENES_PER_THREAD = 1 << 14  # fewer are not worth starting a thread
PROCESSORS = os.cpu_count() or 1
NOT_FINITE = 64.0
# kinds of results in `kernel.c`
FINITE = 0
ANY_SIZE = 1
BITS = 2  # STATUS
RAW = 3  # as computed
KINDS = {"STATUS": BITS, "COND": ANY_SIZE}  # of checked results; the others are finite
NUMBERS = {name: number for number, name in enumerate(COMPILED)}  # of loops in the library
_address_of, _buffer_of = ctypes.addressof, ctypes.c_char.from_buffer


def _load() -> Any:
    """Return the library with its functions declared, None where there is none."""
    part = library.loaded("mechanics_formulas", digest())
    if part is not None:
        number, pointer = ctypes.c_int64, ctypes.c_void_p
        part.solve.argtypes, part.solve.restype = [pointer, pointer, number, number], None
    return part


_compiled = _load()


class Kernel:
    """The computation of quantities by formulas that the library has.

    Parameters
    ----------
    steps : sequence of (str, int)
        Formulas in order, with their guards (`plan`).
    wanted : sequence of str
        Quantities that they give; ``fit`` is among those they give where ``is_checked``.
    varying : frozenset of str
        Names of the inputs that have a number for each scene.
    is_checked : bool
        Whether results are made NaN where a scene cannot be used, or are not finite.
    """

    def __init__(
        self,
        steps: Sequence[tuple[str, int]],
        wanted: Sequence[str],
        varying: frozenset[str],
        is_checked: bool,
    ) -> None:
        self.wanted = wanted
        self._kinds = [KINDS.get(name, FINITE) if is_checked else RAW for name in wanted]
        operands = dict.fromkeys(x for name, _ in steps for x in FORMULAS[name].takes)
        inputs = operands.keys() - {x for name, _ in steps for x in FORMULAS[name].gives}
        self.fixed = [name for name in inputs if name not in varying]
        self.changing = [name for name in inputs if name in varying]
        changing = set(varying)
        once: list[tuple[str, int]] = []
        each: list[tuple[str, int]] = []
        for name, guard in steps:
            if changing.isdisjoint(FORMULAS[name].takes):
                once.append((name, 0))  # a later strip may have the pivots that the first lacks
            else:
                each.append((name, guard))
                changing.update(FORMULAS[name].gives)
        self._steps = once + each
        pairs = [(ROWS[name], 0) for name in self.fixed]
        pairs += [(ROWS[name], 1) for name in self.changing]
        pairs += [(NUMBERS[name], guard) for name, guard in self._steps]
        pairs += [(ROWS[name], kind) for name, kind in zip(wanted, self._kinds, strict=True)]
        sizes = [len(inputs), len(once), len(steps), len(wanted), ROWS["fit"]]
        self._plan = np.array([*sizes, *(x for pair in pairs for x in pair)], np.int64)
        (self._plan_address,) = addresses([self._plan])

    def compute(
        self,
        inputs: Mapping[str, Any],
        shape: tuple[int, ...],
        out: Mapping[str, Array] | None = None,
        threads: int | None = 1,
    ) -> dict[str, Array]:
        """Return results of inputs.

        Parameters
        ----------
        inputs : mapping of str to float or ndarray
            Numbers, and contiguous float64 arrays of one length for inputs that vary.
        shape : tuple of int
            The shape of the results, of that size.
        out : mapping of str to ndarray, optional
            Arrays to write the results into, instead of new ones.
        threads : int or None, default 1
            The number of threads, None for as many as there are processors and work.
        """
        numbers = np.array([inputs[name] for name in self.fixed], np.float64)
        columns = [inputs[name] for name in self.changing]
        return self.compute_columns(numbers, columns, shape, out, threads)

    def compute_columns(
        self,
        numbers: Array,
        columns: Sequence[Array],
        shape: tuple[int, ...],
        out: Mapping[str, Array] | None = None,
        threads: int | None = 1,
    ) -> dict[str, Array]:
        """Return results of the numbers of `fixed` and the columns of `changing`, as `compute`."""
        places = addresses(columns)
        if out is None:
            results, starts = self._new_arrays(shape)
        else:
            results, starts = self._check_output(out, shape, places)
        count = math.prod(shape)
        if _compiled is None or library.is_switched_off():
            self._run_by_numpy(numbers, columns, [x.reshape(-1) for x in results.values()])
        else:
            (first,) = addresses([numbers])
            places = [*range(first, first + numbers.nbytes, 8), *places, *starts]
            table = np.array(places, np.int64)
            work = partial(_compiled.solve, self._plan_address, *addresses([table]))
            run_in_threads(work, count, threads)
        return results

    def _run_by_numpy(
        self, numbers: Array, columns: Sequence[Array], results: Sequence[Array]
    ) -> None:
        """Compute results, strip by strip."""
        for start in range(0, len(results[0]), STRIP):
            part = slice(start, start + STRIP)
            values = dict(zip(self.fixed, numbers, strict=True))
            values |= {n: x[part] for n, x in zip(self.changing, columns, strict=True)}
            run_formulas(self._steps, values)
            for to, name, kind in zip(results, self.wanted, self._kinds, strict=True):
                to[part] = output(values, name, kind)

    def _new_arrays(self, shape: tuple[int, ...]) -> tuple[dict[str, Array], list[int]]:
        """Return arrays for results, rows of one block, and their addresses."""
        block = np.empty((len(self.wanted), *shape))
        (first,) = addresses([block])
        arrays: dict[str, Array] = {name: block[k, ...] for k, name in enumerate(self.wanted)}
        size = 8 * math.prod(shape)
        starts = [first + k * size for k in range(len(block))]
        if BITS in self._kinds:
            bits = arrays["STATUS"] = np.empty(shape, np.uint16)
            (starts[self._kinds.index(BITS)],) = addresses([bits])
        return arrays, starts

    def _check_output(
        self, out: Mapping[str, Array], shape: tuple[int, ...], inputs: Sequence[int]
    ) -> tuple[dict[str, Array], list[int]]:
        """Return the arrays to write results into, and their addresses. Raises UserError for arrays
        that cannot take them; ``inputs``: the addresses of the columns."""
        results = {}
        for name, kind in zip(self.wanted, self._kinds, strict=True):
            array: Any = out.get(name)
            dtype: type = np.uint16 if kind == BITS else np.float64
            is_array = isinstance(array, np.ndarray) and array.flags.carray
            if not is_array or array.shape != shape or array.dtype != dtype:
                form = f"a contiguous array of {dtype.__name__} of shape {shape}"
                raise UserError(f"out, {name}: expected {form}")
            results[name] = array
        starts = addresses(list(results.values()))
        spans = [(at, at + x.nbytes, 1) for at, x in zip(starts, results.values(), strict=True)]
        spans += [(at, at + 8 * math.prod(shape), 0) for at in inputs]
        for (_, end, is_result), (start, _, is_other) in pairwise(sorted(spans)):
            if start < end and is_result | is_other:  # columns may overlap each other
                raise UserError("out: a result shares memory with a column or another result")
        return results, starts


@np.errstate(all="ignore")
def run_formulas(steps: Sequence[tuple[str, int]], values: dict[str, Any]) -> None:
    """Add what formulas give to values, by numpy; a quantity that is there stays."""
    is_pivot = np.equal(values.get("MU", 0.0), PIVOT)
    for name, guard in steps:
        formula = FORMULAS[name]
        if (guard == PIVOTS and not is_pivot.any()) or (guard == OTHERS and is_pivot.all()):
            quantities = [np.float64(1.0)] * len(formula.gives)  # not used
        else:
            module = formulas if name in COMPILED else consequences
            function = getattr(module, formula.tree.name)
            quantities = function(*[values[operand] for operand in formula.takes])
        for quantity, array in zip(formula.gives, quantities, strict=True):
            values.setdefault(quantity, array)


def output(values: Mapping[str, Any], name: str, kind: int) -> Any:
    """Return a result as the library writes it."""
    x = values[name]
    if kind == RAW:
        return x
    largest = np.inf if kind == ANY_SIZE else formulas.LARGEST
    is_usable = (values["fit"] == 1.0) & (np.abs(x) <= largest)
    return np.where(is_usable, x + 0.0, NOT_FINITE if kind == BITS else np.nan)


def addresses(arrays: Sequence[Any]) -> list[int]:
    """Return the addresses of arrays' first elements."""
    try:  # four times as fast as the array's interface
        return [_address_of(_buffer_of(array)) for array in arrays]
    except (TypeError, ValueError):  # one is read-only or empty
        return [array.__array_interface__["data"][0] for array in arrays]


def run_in_threads(work: Callable[[int, int], object], count: int, threads: int | None) -> None:
    """Call ``work(begin, end)`` for parts of ``count`` scenes, `SCENES_PER_THREAD` at least on each
    thread."""
    parts = min(count // SCENES_PER_THREAD, threads or PROCESSORS)
    if parts < 2:
        work(0, count)
        return
    from concurrent.futures import ThreadPoolExecutor

    ends = [count * k // parts for k in range(parts + 1)]
    with ThreadPoolExecutor(parts) as pool:
        list(pool.map(work, ends[:-1], ends[1:]))
