"""Calls of the compiled library (`native/impacts.h`), which takes scenes of every kind at once.

Columns are read where they are (`compute`), or are rows of one array (`RowsCall`).
"""

import math
from collections.abc import Sequence
from functools import lru_cache, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import native
from ..native import QUANTITIES
from ..native.processors import run_in_threads, workers
from .columns import ORDINARY
from .impactprograms import CIRCLE, COLUMNS
from .results import address

Array = NDArray[Any]

MIN_SCENES_PER_THREAD = 32768
"""Chosen so that starting a thread takes a fifth of the half millisecond that its scenes take; with
half as many it takes two fifths, with twice as many calls with 65,536 scenes have one thread."""
_LARGEST = np.finfo(np.float64).max
# least and largest number of each column that needs no look at single scenes
_LIMITS = np.array([{**ORDINARY, "MU": (-_LARGEST, _LARGEST)}[name] for name in COLUMNS])
_NO_ARGUMENTS = np.array(
    [0] * (2 * len(COLUMNS) + len(QUANTITIES)) + [_LIMITS.ctypes.data, CIRCLE], np.int64
)


@lru_cache(maxsize=256)
def _places(wanted: tuple[str, ...]) -> NDArray[np.int64]:
    """Return the places of results in the argument block."""
    return np.array([2 * len(COLUMNS) + QUANTITIES.index(name) for name in wanted], np.int64)


def _arguments(
    columns: Sequence[int] | NDArray[np.int64],
    steps: Sequence[int] | NDArray[np.int64],
    wanted: tuple[str, ...],
    results: Sequence[int],
) -> NDArray[np.int64]:
    """Return the argument block of the C function, ``impacts`` in `native/impacts.h`."""
    block = _NO_ARGUMENTS.copy()
    block[: len(COLUMNS)] = columns
    block[len(COLUMNS) : 2 * len(COLUMNS)] = steps
    block[_places(wanted)] = results
    return block


def compute(
    columns: Sequence[int],
    steps: Sequence[int] | NDArray[np.int64],
    wanted: tuple[str, ...],
    results: Sequence[int],
    count: int,
    threads: int | None,
) -> None:
    """Compute ``count`` scenes whose columns are anywhere.

    ``columns``: addresses in the table's order; ``steps``: 1 for a column with a number for each
    scene, 0 for one number for all; ``results``: addresses in the order wanted.
    """
    block = _arguments(columns, steps, wanted, results)
    solve = partial(native.library.solve_impacts, address(block))
    run_in_threads(solve, count, workers(count, threads, MIN_SCENES_PER_THREAD))


class RowsCall:
    """Calls whose values lie in one array: a row of each column, then single numbers.

    ``columns``, ``numbers``: their places in the table; ``constants``: numbers for all others. The
    results but STATUS are rows of one array, too. Any number of threads may use it at a time.
    """

    def __init__(
        self,
        wanted: tuple[str, ...],
        columns: Sequence[int],
        numbers: Sequence[int] = (),
        constants: NDArray[np.float64] | None = None,
    ) -> None:
        self._wanted, self._columns = wanted, list(columns)
        self._rows = tuple(name for name in wanted if name != "STATUS")
        self._has_status = len(self._rows) < len(wanted)
        self._is_in_order = wanted == (*self._rows, "STATUS")
        # the block has their addresses
        self._constants = np.zeros(len(COLUMNS)) if constants is None else constants
        starts = self._constants.ctypes.data + 8 * np.arange(len(COLUMNS))
        self._steps = np.zeros(len(COLUMNS), np.int64)
        self._steps[self._columns] = 1
        given, targets = np.zeros(len(COLUMNS), np.int64), np.zeros(len(QUANTITIES), np.int64)
        given[: len(columns) + len(numbers)] = [*columns, *numbers]
        targets[: len(self._rows)] = [QUANTITIES.index(name) for name in self._rows]
        counts = [len(columns), len(numbers), len(self._rows)]
        block = _arguments(starts, self._steps, (), ())
        self._block = np.concatenate([block, counts, given, targets])
        self._at = address(self._block)

    def room(self, shape: tuple[int, ...]) -> tuple[Array, Array | None]:
        """Return uninitialized arrays for the float64 results, as rows, and for STATUS."""
        results = np.empty((len(self._rows), *shape))
        return results, np.empty(shape, np.uint16) if self._has_status else None

    def solve(self, values: Array, shape: tuple[int, ...]) -> dict[str, Array]:
        """Return the results of contiguous float64 ``values`` by name, in the order wanted, in
        fresh memory; numbers for the shape ()."""
        count = math.prod(shape)
        results, bits = self.room(shape)
        status = 0 if bits is None else address(bits)
        starts = self._at, address(values), address(results), status
        if count < 2 * MIN_SCENES_PER_THREAD:
            native.library.solve_rows(*starts, count, 0, count)
        else:
            solve = partial(native.library.solve_rows, *starts, count)
            run_in_threads(solve, count, workers(count, None, MIN_SCENES_PER_THREAD))
        by_name = dict(zip(self._rows, results))  # noqa: B905 - strict takes as long as the rest
        if bits is None:
            return by_name
        by_name["STATUS"] = bits[()]
        return by_name if self._is_in_order else {name: by_name[name] for name in self._wanted}

    def bound(self, values: Array, results: Array, bits: Array | None) -> NDArray[np.int64]:
        """Return the argument block of ``solve_impacts`` for these arrays, valid while they and
        this object live."""
        size = 8 * math.prod(values.shape[1:])
        columns = self._block[: len(COLUMNS)].copy()
        columns[self._columns] = address(values) + size * np.arange(len(self._columns))
        starts = [address(results) + size * row for row in range(len(self._rows))]
        if bits is None:
            return _arguments(columns, self._steps, self._rows, starts)
        return _arguments(columns, self._steps, (*self._rows, "STATUS"), [*starts, address(bits)])
