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
from ..status import Status
from . import consequences, formulas
from .plan import COMPILED, FORMULAS, OTHERS, PIVOTS, ROWS, Step, plan
from .translate import digest

Array = NDArray[Any]

STRIP = 2048  # scenes that numpy computes at a time: some fifty arrays fit the second-level cache
SCENES_PER_THREAD = 1 << 14  # fewer are not worth starting a thread
PROCESSORS = os.cpu_count() or 1
LOOPS = [*COMPILED]  # in the order of the library
_functions = {
    name: getattr(formulas if name in COMPILED else consequences, formula.tree.name)
    for name, formula in FORMULAS.items()
}
_address_of, _buffer_of = ctypes.addressof, ctypes.c_char.from_buffer


def _load() -> Any:
    """Return the library with its functions declared, None where there is none."""
    part = library.loaded("mechanics_formulas", digest())
    if part is not None:
        number, pointer = ctypes.c_int64, ctypes.c_void_p
        part.solve.argtypes = [pointer, pointer, number, number]
    return part


_compiled = _load()


class Kernel:
    """The computation of quantities, by the library as far as it has their formulas.

    Parameters
    ----------
    wanted : tuple of str
        Names of quantities.
    known : frozenset of str
        Names of columns and quantities that are given.
    varying : frozenset of str
        Names of those that have a number for each scene.
    is_checked : bool
        Whether results are made NaN where a scene cannot be used, or are not finite.

    Attributes
    ----------
    results : list of str
        Quantities that `compute` returns: those wanted, and those that ``following`` takes.
    fixed, changing : list of str
        The inputs that `compute` takes, numbers and columns.
    following : list of (Formula, int)
        Formulas that numpy runs afterwards (`run_formulas`): those of `consequences`, those that
        give what is known, and what they lead to.
    missing : dict of str to tuple of str
        Wanted quantities that do not follow from what is known -> the columns that they lack.
    """

    def __init__(
        self,
        wanted: tuple[str, ...],
        known: frozenset[str],
        varying: frozenset[str],
        is_checked: bool,
    ) -> None:
        steps, _, self.missing = plan((*wanted, "fit") if is_checked else wanted, known)
        self._steps: list[Step] = []
        self.following: list[Step] = []
        inputs: set[str] = set()
        given: set[str] = set()
        left: set[str] = set()  # what numpy gives afterwards
        changing = set(varying)
        calls: list[int] = []
        for formula, guard in steps:
            takes, gives = formula.takes, formula.gives
            if formula.name in COMPILED and known.isdisjoint(gives) and left.isdisjoint(takes):
                varies = not changing.isdisjoint(takes)
                if varies:
                    changing.update(gives)
                calls += (LOOPS.index(formula.name), guard, varies)
                self._steps.append((formula, guard))
                inputs.update(takes)
                given.update(gives)
            else:
                self.following.append((formula, guard))
                wanted += takes
                left.update(gives)
        inputs -= given
        self.fixed = [*inputs - varying]
        self.changing = [*inputs & varying]
        self.results = [name for name in dict.fromkeys(wanted) if name in given]
        self._is_checked = is_checked
        self._bits = [k for k, name in enumerate(self.results) if is_checked and name == "STATUS"]
        rows = [ROWS[name] for name in (*self.fixed, *self.changing, *self.results)]
        sizes = (len(self.fixed), len(inputs), len(self._steps), len(self.results), is_checked)
        self._plan = np.array([*sizes, *rows, *calls], np.int64)

    def compute(
        self,
        numbers: Array,
        columns: Sequence[Array],
        shape: tuple[int, ...],
        out: Mapping[str, Any] | None = None,
        threads: int | None = 1,
    ) -> dict[str, Any]:
        """Return results of inputs.

        Parameters
        ----------
        numbers : ndarray
            A float64 for each name in ``fixed``.
        columns : sequence of ndarray
            A contiguous float64 array of one length for each name in ``changing``.
        shape : tuple of int
            The shape of the results, of that size: numbers for ().
        out : mapping of str to ndarray, optional
            Contiguous arrays to write the results into, instead of new ones.
        threads : int or None, default 1
            The number of threads, None for as many as there are processors and work.

        Raises
        ------
        UserError
            For arrays in ``out`` that cannot take the results.
        """
        count = math.prod(shape)
        places = addresses(columns)
        if out is None:  # one block: its rows do not share lines of the cache
            block = np.empty((len(self.results), count))
            arrays = [*block]
            for row in self._bits:
                arrays[row] = arrays[row].view(np.uint16)[:count]
            (first,) = addresses([block])
            starts: Sequence[int] = range(first, first + block.nbytes, block.strides[0] or 8)
        else:
            arrays = [_output_array(out.get(name), name, shape) for name in self.results]
            starts = addresses(arrays)
            _check_overlap((places, columns), (starts, arrays))
        if _compiled is None or library.is_switched_off():
            self._run_by_numpy(numbers, columns, [array.reshape(-1) for array in arrays])
        else:
            table = np.array([*addresses([numbers]), *places, *starts], np.int64)
            work = partial(_compiled.solve, *addresses([self._plan, table]))
            run_in_threads(work, count, threads)
        if out is None and len(shape) != 1:
            arrays = [array.reshape(shape) if shape else array[0] for array in arrays]
        return dict(zip(self.results, arrays, strict=True))

    def _run_by_numpy(
        self, numbers: Array, columns: Sequence[Array], rows: Sequence[Array]
    ) -> None:
        """Compute results, strip by strip."""
        for start in range(0, len(rows[0]), STRIP):
            part = slice(start, start + STRIP)
            values = dict(zip(self.fixed, numbers, strict=True))
            values |= {n: x[part] for n, x in zip(self.changing, columns, strict=True)}
            run_formulas(self._steps, values)
            for row, name in zip(rows, self.results, strict=True):
                row[part] = finish(values, name) if self._is_checked else values[name]


def _output_array(array: Any, name: str, shape: tuple[int, ...]) -> Any:
    """Return an array for a result. Raises UserError where it cannot take results of a shape."""
    dtype: type = np.uint16 if name == "STATUS" else np.float64
    is_array = isinstance(array, np.ndarray) and array.flags.carray
    if not is_array or array.shape != shape or array.dtype != dtype:
        form = f"a contiguous array of {dtype.__name__} of shape {shape}"
        raise UserError(f"out, {name}: expected {form}")
    return array


def _check_overlap(*groups: tuple[Sequence[int], Sequence[Array]]) -> None:
    """Raise UserError where results share memory. ``groups``: columns and results, their addresses
    and arrays."""
    spans = []
    for is_result, (starts, arrays) in enumerate(groups):
        spans += [(at, at + x.nbytes, is_result) for at, x in zip(starts, arrays, strict=True)]
    for (_, end, is_result), (start, _, is_other) in pairwise(sorted(spans)):
        if start < end and is_result | is_other:  # columns may overlap each other
            raise UserError("out: a result shares memory with a column or another result")


@np.errstate(all="ignore")
def run_formulas(steps: Sequence[Step], values: dict[str, Any]) -> None:
    """Add what formulas give to values, by numpy; a quantity that is there stays."""
    is_pivot = np.equal(values.get("MU", 0.0), PIVOT)
    for formula, guard in steps:
        if (guard == PIVOTS and not is_pivot.any()) or (guard == OTHERS and is_pivot.all()):
            quantities = [np.float64(1.0)] * len(formula.gives)  # not used
        else:
            function = _functions[formula.name]
            quantities = function(*[values[operand] for operand in formula.takes])
        for quantity, array in zip(formula.gives, quantities, strict=True):
            values.setdefault(quantity, array)


def finish(values: Mapping[str, Any], name: str) -> Any:
    """Return a result as the library writes it."""
    x = values[name]
    largest = np.inf if name == "COND" else formulas.LARGEST
    is_usable = (values["fit"] == 1.0) & (np.abs(x) <= largest)
    return np.where(is_usable, x + 0.0, Status.NOT_FINITE if name == "STATUS" else np.nan)


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
