"""Calls of the compiled library (`native/impacts.h`), which takes scenes of every kind at once.

A `Call` is the argument block of the C function; one thread uses it at a time.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import native
from ..native.processors import run_in_threads, workers
from .columns import ORDINARY
from .impactprograms import CIRCLE, COLUMNS, FORMULAS, QUANTITIES

MIN_SCENES_PER_THREAD = 32768
"""Chosen so that starting a thread takes a fifth of the half millisecond that its scenes take; with
half as many it takes two fifths, with twice as many calls with 65,536 scenes have one thread."""
_LARGEST = np.finfo(np.float64).max
# least and largest number of each column that needs no look at single scenes
_LIMITS = np.array([{**ORDINARY, "MU": (-_LARGEST, _LARGEST)}[name] for name in COLUMNS])


def usable() -> bool:
    """Return True where the library is built, and from these formulas."""
    return native.library is not None and _of_these_formulas()


@lru_cache(maxsize=1)
def _of_these_formulas() -> bool:
    # a result that was added since the library was built is none of its results
    results = tuple(native.library.results().decode().split())
    return results == QUANTITIES and bool(native.library.formulas().decode() == FORMULAS)


class Call:
    """Argument block of the C call for the results ``wanted``.

    ``columns``: addresses of the columns; ``steps``: 1 for a column with a number for each scene, 0
    for one number for all. ``numbers``: memory for those; `column_of_number` is where each is.
    """

    def __init__(self, wanted: tuple[str, ...]) -> None:
        self.block = np.zeros(2 * len(COLUMNS) + len(QUANTITIES) + 2, np.int64)
        self.at = self.block.ctypes.data
        self.columns = self.block[: len(COLUMNS)]
        self.steps = self.block[len(COLUMNS) : 2 * len(COLUMNS)]
        self.results = self.block[2 * len(COLUMNS) : -2]
        self.places = np.array([QUANTITIES.index(name) for name in wanted], np.int64)
        self.numbers = np.zeros(len(COLUMNS))
        self.column_of_number = self.numbers.ctypes.data + 8 * np.arange(len(COLUMNS))
        self.block[-2:] = _LIMITS.ctypes.data, CIRCLE

    def run(self, results: Any, count: int, threads: int | None) -> None:
        """Compute ``count`` scenes and write to ``results``, addresses in the order wanted."""
        self.results[self.places] = results
        solve = native.library.solve_impacts
        number = workers(count, threads, MIN_SCENES_PER_THREAD)
        if number == 1:
            solve(self.at, 0, count)
        else:
            run_in_threads(lambda start, stop: solve(self.at, start, stop), count, number)


class CallOfOneScene(Call):
    """A call of one scene, whose numbers and results have memory of their own."""

    def __init__(self, wanted: tuple[str, ...]) -> None:
        super().__init__(wanted)
        self.columns[:] = self.column_of_number
        self._found, self._status = np.zeros(len(wanted)), np.zeros(1, np.uint16)
        self.results[self.places] = self._found.ctypes.data + 8 * np.arange(len(wanted))
        self._has_status = "STATUS" in wanted
        if self._has_status:
            self.results[QUANTITIES.index("STATUS")] = self._status.ctypes.data
        self._wanted = wanted

    def solve(self, values: Sequence[float]) -> dict[str, Any]:
        """Return the results of a scene's values in the table's order, as numpy's float64, STATUS
        as uint16. Raises OverflowError for whole numbers that no double holds."""
        self.numbers[:] = values
        native.library.solve_impacts(self.at, 0, 1)
        by_name: dict[str, Any] = dict(zip(self._wanted, self._found, strict=True))
        if self._has_status:
            by_name["STATUS"] = self._status[0]
        return by_name


class PreparedCall:
    """A call whose varying columns, by their ``places``, and results other than STATUS are rows of
    two arrays. ``values`` holds a number for each column, and must live as long as this. Any number
    of threads may use it at a time."""

    def __init__(
        self, wanted: tuple[str, ...], places: Sequence[int], values: NDArray[np.float64]
    ) -> None:
        call = Call(wanted)
        call.columns[:] = values.ctypes.data + 8 * np.arange(len(COLUMNS))
        call.steps[list(places)] = 1
        rows = [QUANTITIES.index(name) for name in wanted if name != "STATUS"]
        lists = (
            np.array([*filled, *[0] * (length - len(filled))], np.int64)
            for filled, length in ((places, len(COLUMNS)), (rows, len(QUANTITIES)))
        )
        self._block = np.concatenate([call.block, [len(places), len(rows)], *lists])
        self._at = self._block.ctypes.data

    def run(self, values: int, results: int, status: int, count: int) -> None:
        """Compute ``count`` scenes. All arguments are addresses; ``status``: 0 if not wanted."""
        solve = native.library.solve_prepared
        if count < 2 * MIN_SCENES_PER_THREAD:
            solve(self._at, values, results, status, count, 0, count)
            return

        def solve_part(start: int, stop: int) -> None:
            solve(self._at, values, results, status, count, start, stop)

        run_in_threads(solve_part, count, workers(count, None, MIN_SCENES_PER_THREAD))

    def bound(self, values: int, results: int, status: int, count: int) -> NDArray[np.int64]:
        """Return the arguments of `run` as a block for ``solve_bound``, valid as long as this
        object and the arrays live."""
        return np.array([self._at, values, results, status, count], np.int64)


@lru_cache(maxsize=256)
def free_calls(wanted: tuple[str, ...], kind: type[Any] = Call) -> list[Any]:
    """Return the list of calls for ``wanted`` that no thread is using: one is taken from it, or
    made, for the length of a call, and put back."""
    return []


def solve_columns(
    columns: Sequence[NDArray[np.float64]],
    wanted: tuple[str, ...],
    results: Sequence[int],
    count: int,
) -> None:
    """Compute ``wanted`` of contiguous columns in the table's order, of length ``count`` or 1, and
    write them to the addresses ``results``."""
    call = Call(wanted)
    call.columns[:] = [column.ctypes.data for column in columns]
    call.steps[:] = [len(column) > 1 for column in columns]
    call.run(results, count, 1)
