"""Computing a plan's results over arrays of scenes: by the compiled library, or by numpy.

The library (`machine.c`, with `formulas` as C) runs strips of 128 scenes; numpy runs the same
functions over longer strips, to the same bits.
"""

import ctypes
import os
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import library
from ..names import PIVOT
from . import consequences, formulas
from .plan import COLUMNS, COMPILED, FORMULAS, NUMBERS, OTHERS, PIVOTS, ROWS, Plan
from .translate import digest

Array = NDArray[Any]
Floats = NDArray[np.float64]

STRIP = 2048  # scenes that numpy computes at a time: some fifty arrays fit the second-level cache
SCENES_PER_THREAD = 1 << 14  # fewer are not worth starting a thread
ARMS = ("arm_direction_a", "arm_direction_b", "lever_arm_a", "lever_arm_b", "contact_offsets")
NOT_FINITE = 64.0
FINITE, ANY_SIZE, BITS, RAW = range(4)  # kinds of results in `machine.c`
_ONE = np.float64(1.0)
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
    armless : bool, default False
        Whether DA and DB are 0 in all scenes: no arm varies then.
    """

    def __init__(
        self,
        plan: Plan,
        wanted: tuple[str, ...],
        varying: frozenset[str],
        checked: bool,
        armless: bool = False,
    ) -> None:
        self.inputs = plan.inputs
        self.wanted = wanted
        self._varying = varying
        self._checked = checked
        changing = set(varying)
        once: list[tuple[str, int]] = []
        each: list[tuple[str, int]] = []
        for name, guard in plan.steps:
            formula = FORMULAS[name]
            if changing.isdisjoint(formula.takes) or (armless and name in ARMS):
                once.append((name, guard))
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
        pairs = [(ROWS[name], int(name in varying)) for name in plan.inputs]
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

    def run(self, inputs: Sequence[Array], results: Sequence[Array], threads: int | None) -> None:
        """Compute results of inputs.

        Parameters
        ----------
        inputs : sequence of ndarray
            Contiguous float64 arrays in the order of the plan's inputs: of one length where they
            vary, of length 1 elsewhere.
        results : sequence of ndarray
            Contiguous arrays of that length to write into.
        threads : int or None
            The number of threads, None for as many as there are processors and work.
        """
        count = results[0].size
        if self.is_compiled:
            places = np.array([address(array) for array in (*inputs, *results)], np.int64)
            self.run_at(places, count, threads)
            return
        for start in range(0, count, STRIP):
            part = slice(start, start + STRIP)
            values = {
                name: array[part] if name in self._varying else array[0]
                for name, array in zip(self.inputs, inputs, strict=True)
            }
            self._run_strip(values, [array[part] for array in results])

    def run_at(self, places: NDArray[np.int64], count: int, threads: int | None) -> None:
        """Compute ``count`` scenes by the library, given the addresses of inputs and results."""
        assert _compiled is not None
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
    try:  # four times as fast as the array's interface
        return ctypes.addressof(ctypes.c_char.from_buffer(array))
    except (TypeError, ValueError):  # read-only or empty
        return int(array.__array_interface__["data"][0])


def run_in_threads(work: Callable[[int, int], object], count: int, threads: int | None) -> None:
    """Call ``work(begin, end)`` for parts of ``count`` scenes, `SCENES_PER_THREAD` at least on each
    thread."""
    parts = min(threads or os.cpu_count() or 1, count // SCENES_PER_THREAD)
    if parts < 2:
        work(0, count)
        return
    from concurrent.futures import ThreadPoolExecutor

    ends = [count * k // parts for k in range(parts + 1)]
    with ThreadPoolExecutor(parts) as pool:
        list(pool.map(work, ends[:-1], ends[1:]))


def check_output(
    results: Mapping[str, Array], shape: tuple[int, ...], inputs: Sequence[Array]
) -> str:
    """Return why arrays cannot take the results of scenes of a shape, "" where they can."""
    for name, array in results.items():
        kind = np.uint16 if name == "STATUS" else np.float64
        if not (isinstance(array, np.ndarray) and array.shape == shape and array.dtype == kind):
            return f"out, {name}: expected an array of {kind.__name__} of shape {shape}"
        if not array.flags.carray:
            return f"out, {name}: expected a contiguous array that can be written to"
    ranges = [(address(array), array.nbytes, False) for array in inputs if array.size > 1]
    ranges += [(address(array), array.nbytes, True) for array in results.values()]
    end = end_of_result = 0
    for start, size, is_result in sorted(ranges):
        if start < end_of_result or (is_result and start < end):
            return "out: a result shares memory with a column or another result"
        end = max(end, start + size)
        end_of_result = max(end_of_result, start + size) if is_result else end_of_result
    return ""
