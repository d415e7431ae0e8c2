"""Calls of the compiled library (`native/impacts.h`), which takes scenes of every kind at once.

Columns are read where they are (`Call.compute`), or are rows of one array (`Call.solve`).
"""

import math
from collections.abc import Sequence
from functools import lru_cache, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import native
from ..native import QUANTITIES
from ..native.processors import run_in_threads
from .columns import BLOCK, UNEXAMINED
from .impactprograms import CIRCLE, COLUMNS
from .results import address

Array = NDArray[Any]

TILE = 1024
"""Scenes whose columns the library copies side by side, as ``TILE`` of `native/impacts.h`."""
_LARGEST = np.finfo(np.float64).max
# least and largest number of each column that needs no look at single scenes
_LIMITS = np.array([{**UNEXAMINED, "MU": (-_LARGEST, _LARGEST)}[name] for name in COLUMNS])
_NO_ARGUMENTS = np.array(
    [0] * (2 * len(COLUMNS) + len(QUANTITIES)) + [_LIMITS.ctypes.data, CIRCLE], np.int64
)


class Call:
    """Calls with the same columns and results.

    ``columns``, ``numbers``: their places in the table, of what has a number for each scene and of
    what has one for all; ``constants``: numbers for all others. Any number of threads may use it at
    a time.
    """

    def __init__(
        self,
        wanted: tuple[str, ...],
        columns: Sequence[int],
        numbers: Sequence[int] = (),
        constants: NDArray[np.float64] | None = None,
    ) -> None:
        self._rows = [name for name in wanted if name != "STATUS"]
        self._wanted, self._has_status = wanted, len(self._rows) < len(wanted)
        self._is_in_order = wanted == (*self._rows, "STATUS")
        # the block has their addresses
        self._constants = np.zeros(len(COLUMNS)) if constants is None else constants
        block = _NO_ARGUMENTS.copy()
        block[: len(COLUMNS)] = self._constants.ctypes.data + 8 * np.arange(len(COLUMNS))
        block[len(COLUMNS) + np.array(columns, int)] = 1
        results = [QUANTITIES.index(name) for name in wanted]
        inputs = [*columns, *numbers]
        self._places = np.array([*inputs, *(2 * len(COLUMNS) + at for at in results)])
        given, targets = np.zeros(len(COLUMNS), np.int64), np.zeros(len(QUANTITIES), np.int64)
        given[: len(inputs)] = inputs
        targets[: len(self._rows)] = [QUANTITIES.index(name) for name in self._rows]
        counts = [len(columns), len(numbers), len(self._rows)]
        self._block = np.concatenate([block, counts, given, targets])
        self._at = address(self._block)

    def arguments(self, addresses: Sequence[int]) -> NDArray[np.int64]:
        """Return the argument block of the C function, ``impacts`` in `native/impacts.h`, for the
        ``addresses`` of the columns, the numbers, and the results in the order wanted."""
        block = self._block.copy()
        block[self._places] = addresses
        return block

    def compute(self, addresses: Sequence[int], count: int, threads: int | None) -> None:
        """Compute ``count`` scenes, whose columns are anywhere; see `arguments`."""
        block = self.arguments(addresses)
        solve = partial(native.library.solve_impacts, address(block))
        run_in_threads(solve, count, BLOCK, threads)

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
        solve = partial(native.library.solve_rows, *starts, count)
        run_in_threads(solve, count, BLOCK, None)
        by_name = dict(zip(self._rows, results))  # noqa: B905 - strict takes as long as the rest
        if bits is None:
            return by_name
        by_name["STATUS"] = bits[()]
        return by_name if self._is_in_order else {name: by_name[name] for name in self._wanted}


@lru_cache(maxsize=256)
def call_of(wanted: tuple[str, ...], columns: tuple[int, ...]) -> Call:
    """Return the call of ``columns``, by their places in the table, and numbers for all others."""
    return Call(wanted, columns, [at for at in range(len(COLUMNS)) if at not in columns])
