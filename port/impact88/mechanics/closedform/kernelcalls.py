"""Calls of the compiled kernels (`native/impacts.h`), which take scenes of every kind at once.

A `Call` is the argument block of the C function; one thread uses it at a time.
"""

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from .. import native
from ..native.processors import run_in_threads, workers
from ..native.program import Addresses
from .columns import INERTIAS, ORDINARY
from .impactprograms import ALL, BODIES, CIRCLE, COLUMNS, FILTERS, FORMULAS
from .statusfilter import LARGEST_E, MODERATE

MIN_SCENES_PER_THREAD = 32768
"""Chosen so that starting a thread takes a fifth of the half millisecond that its scenes take; with
half as many it takes two fifths, with twice as many calls with 65,536 scenes have one thread."""
_LARGEST = np.finfo(np.float64).max
# least and largest number of each column that needs no look at single scenes: by all kernels, and
# by filters
_LIMITS = np.array([{**ORDINARY, "MU": (-_LARGEST, _LARGEST)}[name] for name in COLUMNS])
_SIZES = np.array([(-MODERATE, MODERATE)] * len(COLUMNS))
_SIZES[[COLUMNS.index(name) for name in INERTIAS], 0] = 1 / MODERATE
_SIZES[COLUMNS.index("E")] = -LARGEST_E, LARGEST_E
_MODERATE = np.stack([np.maximum(_LIMITS, _SIZES)[:, 0], np.minimum(_LIMITS, _SIZES)[:, 1]], axis=1)
_WITHOUT = {
    "friction_without_moment": (COLUMNS.index("EM"),),
    "smooth": (COLUMNS.index("MU"),),
    "friction_without_arms": (COLUMNS.index("DA"), COLUMNS.index("DB")),
}
"""Body -> the columns that are 0 in it; see `impactprograms.BODIES`."""
COLLECTING = 500
"""Operations that collecting a scene, and putting its results in place, takes as long as."""
SCANNING = 40
"""The same for looking at a scene of a strip in which there are scenes to collect."""
_KINDS = list(BODIES)[:4]
_KERNELS = 2 * len(COLUMNS) + len(ALL)
"""Index of the first kernel in the argument block."""


def usable() -> bool:
    """Return True where the compiled kernels are built, and from these formulas."""
    return native.library is not None and _of_these_formulas()


@lru_cache(maxsize=1)
def _of_these_formulas() -> bool:
    # a result that was added since the library was built is in none of its kernels
    every_result = (1 << len(ALL)) - 1
    knows_results = native.library.kernel_of(0, every_result) is not None
    return knows_results and bool(native.library.formulas().decode() == FORMULAS)


@lru_cache(maxsize=1024)
def _kernels(wanted: tuple[str, ...], without: str | None, points: bool) -> list[int]:
    """Return the addresses of the kernels that compute ``wanted``, one for each kind of scene and
    the one of both friction and pivots, then those of the filters (see `statusfilter`), 0 where
    there is none; last `_mixed_from`.

    ``without``: body for scenes with friction in which some columns are 0; ``points``: whether all
    scenes are point masses.
    """
    bits = sum(1 << ALL.index(name) for name in wanted)
    kernel_of, bodies = native.library.kernel_of, list(BODIES)
    kinds = [*_KINDS, "point_mixed" if points else "mixed"]
    kernels = [kernel_of(bodies.index(kind), bits) for kind in kinds]
    if without is not None:
        kernels[0] = kernel_of(bodies.index(without), bits) or kernels[0]
    filters = [0] * len(kinds)
    if not points:
        for place, kind in enumerate(kinds):
            found = (kernel_of(bodies.index(body), bits) for body in _filters(kind, wanted))
            filters[place] = next(filter(None, found), 0)
    both = ("point", "point_pivot", "point_mixed") if points else ("friction", "pivot", "mixed")
    return kernels + filters + _mixed_from(both, wanted)


def _filters(kind: str, wanted: tuple[str, ...]) -> list[str]:
    """Return the bodies of a kind's filters, the cheapest first; none unless STATUS is wanted."""
    return [body for body, (of, _) in FILTERS.items() if of == kind and "STATUS" in wanted]


def _mixed_from(kinds: tuple[str, str, str], wanted: tuple[str, ...]) -> list[int]:
    """Return the least number of pivots among a strip's scenes with friction, and of such scenes
    among pivots, for which the kernel that computes both for every scene, the last of ``kinds``,
    costs less than collecting those of the rarer kind."""
    cost_of, bodies = native.library.cost_of, list(BODIES)
    bits = sum(1 << ALL.index(name) for name in wanted)
    costs = []
    for kind in kinds:
        found = (cost_of(bodies.index(body), bits) for body in [*_filters(kind, wanted), kind])
        costs.append(next(filter(None, found)))
    *alone, mixed = costs
    least = []
    for common, rarer in (alone, alone[::-1]):
        share = (mixed - common - SCANNING) / (COLLECTING + rarer)
        least.append(max(1, math.ceil(share * native.STRIP)))
    return least


class Call:
    """Argument block of the C call. ``columns``: their addresses; ``steps``: 1 for a column with a
    number for each scene, 0 for one number for all."""

    def __init__(self, wanted: tuple[str, ...]) -> None:
        self._wanted = wanted
        self.block = np.zeros(_KERNELS + 2 * (len(_KINDS) + 1) + 5, np.int64)
        self._at = self.block.ctypes.data
        self.columns = self.block[: len(COLUMNS)]
        self.steps = self.block[len(COLUMNS) : 2 * len(COLUMNS)]
        self._results = self.block[2 * len(COLUMNS) : _KERNELS]
        self._places = np.array([ALL.index(name) for name in wanted], np.int64)
        self.block[-3:] = _LIMITS.ctypes.data, _MODERATE.ctypes.data, CIRCLE
        self.choose_kernels({})

    def choose_kernels(self, numbers: dict[int, float]) -> None:
        """Choose kernels by the constants, place among the columns -> number: those without
        friction, moment or arms where these are 0 in all scenes, and those of point masses."""
        zeros = {place for place, number in numbers.items() if number == 0.0}
        fit = (name for name, places in _WITHOUT.items() if zeros.issuperset(places))
        without = next(fit, None) if zeros else None
        kernels = _kernels(self._wanted, without, numbers.get(COLUMNS.index("M")) == 4.0)
        self.block[_KERNELS : _KERNELS + len(kernels)] = kernels

    def run(self, results: Addresses | Sequence[int], count: int, threads: int | None = 1) -> None:
        """Compute ``count`` scenes and write to ``results``, addresses in the order wanted."""
        self._results[self._places] = results
        work = native.library.solve_impacts
        number = 1 if threads == 1 else workers(count, threads, MIN_SCENES_PER_THREAD)
        if number == 1:
            work(self._at, 0, count)
        else:
            run_in_threads(lambda start, stop: work(self._at, start, stop), count, number)


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
        call.choose_kernels({k: float(x) for k, x in enumerate(values) if k not in places})
        rows = [ALL.index(name) for name in wanted if name != "STATUS"]
        lists = (
            np.array([*filled, *[0] * (length - len(filled))], np.int64)
            for filled, length in ((places, len(COLUMNS)), (rows, len(ALL)))
        )
        self._block = np.concatenate([call.block, [len(places), len(rows)], *lists])
        self._at = self._block.ctypes.data

    def run(self, values: int, results: int, status: int, count: int) -> None:
        """Compute ``count`` scenes. All arguments are addresses; ``status``: 0 if not wanted."""
        if count < 2 * MIN_SCENES_PER_THREAD:
            native.library.solve_prepared(self._at, values, results, status, count)
            return
        work = native.library.solve_prepared_part

        def solve_part(start: int, stop: int) -> None:
            work(self._at, values, results, status, count, start, stop)

        run_in_threads(solve_part, count, workers(count, None, MIN_SCENES_PER_THREAD))

    def bound(self, values: int, results: int, status: int, count: int) -> NDArray[np.int64]:
        """Return the arguments of `run` as a block for ``solve_bound``, valid as long as this
        object and the arrays live."""
        return np.array([self._at, values, results, status, count], np.int64)


@lru_cache(maxsize=256)
def _free_calls(wanted: tuple[str, ...]) -> list[Call]:
    """Return the list of calls for ``wanted`` that no thread is using."""
    return []


@contextmanager
def call_of(wanted: tuple[str, ...]) -> Iterator[Call]:
    """Lend a call for ``wanted`` to this thread for the length of a ``with`` block."""
    free = _free_calls(wanted)
    call = free.pop() if free else Call(wanted)
    try:
        yield call
    finally:
        free.append(call)


def solve_columns(
    columns: Sequence[NDArray[np.float64]],
    wanted: tuple[str, ...],
    results: Addresses,
    count: int,
) -> None:
    """Compute ``wanted`` of contiguous columns in the table's order, of length ``count`` or 1, and
    write them to the addresses ``results``."""
    with call_of(wanted) as call:
        call.columns[:] = [column.ctypes.data for column in columns]
        call.steps[:] = [len(column) > 1 for column in columns]
        call.choose_kernels({place: float(x[0]) for place, x in enumerate(columns) if len(x) == 1})
        call.run(results, count)
