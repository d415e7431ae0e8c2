"""The impact as a whole by the compiled machine (`native/impacts.h`): scenes of every kind in one
call. A call is an argument block for the machine, used by one thread at a time."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from .. import native
from ..native.processors import shared_out, workers
from ..native.program import Addresses
from .columns import INERTIAS, ORDINARY
from .impactprograms import ALL, BODIES, CIRCLE, COLUMNS, FORMULAS, HURRIED
from .statusbits import MODERATE

WORTH_A_THREAD = 32768
"""Scenes for each thread from which it pays: half a millisecond of the compiled machine, of which
starting a thread takes a fifth. With half as many two fifths; with twice as many calls with 65,536
scenes have one thread."""
_LARGEST = np.finfo(np.float64).max
_LIMITS = np.array([{**ORDINARY, "MU": (-_LARGEST, _LARGEST)}[name] for name in COLUMNS])
_SIZES = np.array([(-MODERATE, MODERATE)] * len(COLUMNS))
_SIZES[[COLUMNS.index(name) for name in INERTIAS], 0] = 1 / MODERATE
_MODERATE = np.stack([np.maximum(_LIMITS, _SIZES)[:, 0], np.minimum(_LIMITS, _SIZES)[:, 1]], axis=1)
_WITHOUT = {
    "friction_without_moment": (COLUMNS.index("EM"),),
    "smooth": (COLUMNS.index("MU"),),
    "friction_without_arms": (COLUMNS.index("DA"), COLUMNS.index("DB")),
}
"""Body -> the columns that are 0 in it."""
_KINDS = list(BODIES)[:4]
_KERNELS = 2 * len(COLUMNS) + len(ALL)
"""Where in the argument block the kernels stand."""


def usable() -> bool:
    """Return whether the machine was built, and of these formulas."""
    return native.library is not None and _of_these_formulas()


@lru_cache(maxsize=1)
def _of_these_formulas() -> bool:
    # a result that was added since the library was built is in none of its kernels
    every_result = (1 << len(ALL)) - 1
    knows_results = native.library.kernel_of(0, every_result) is not None
    return knows_results and bool(native.library.formulas().decode() == FORMULAS)


@lru_cache(maxsize=1024)
def _kernels(wanted: tuple[str, ...], without: str | None) -> list[int]:
    """Where the kernels are that compute the results ``wanted`` of each kind of scene, then the
    hurried ones, 0 where there is none."""
    bits = sum(1 << ALL.index(name) for name in wanted)
    kernel_of, bodies = native.library.kernel_of, list(BODIES)
    kernels = [kernel_of(bodies.index(kind), bits) for kind in _KINDS]
    if without is not None:
        kernels[0] = kernel_of(bodies.index(without), bits) or kernels[0]
    hurried = [0] * len(_KINDS)
    if "STATUS" in wanted:
        for kind, body in HURRIED.items():
            hurried[_KINDS.index(kind)] = kernel_of(bodies.index(body), bits) or 0
    return kernels + hurried


class Call:
    """An argument block: ``columns`` says where each is in memory, ``steps`` is 1 where there is a
    number for each scene and 0 where one is for all."""

    def __init__(self, wanted: tuple[str, ...]) -> None:
        self._wanted = wanted
        self.block = np.zeros(_KERNELS + 2 * len(_KINDS) + 3, np.int64)
        self._at = self.block.ctypes.data
        self.columns = self.block[: len(COLUMNS)]
        self.steps = self.block[len(COLUMNS) : 2 * len(COLUMNS)]
        self._results = self.block[2 * len(COLUMNS) : _KERNELS]
        self._places = np.array([ALL.index(name) for name in wanted], np.int64)
        self.block[-3:] = _LIMITS.ctypes.data, _MODERATE.ctypes.data, CIRCLE
        self.choose_kernels({})

    def choose_kernels(self, numbers: dict[int, float]) -> None:
        """Take the kernels for constants, by their places among the columns: those that leave out
        friction, moment or arms where all scenes are without."""
        zeros = {place for place, number in numbers.items() if number == 0.0}
        fit = (name for name, places in _WITHOUT.items() if zeros.issuperset(places))
        kernels = _kernels(self._wanted, next(fit, None) if zeros else None)
        self.block[_KERNELS : _KERNELS + len(kernels)] = kernels

    def run(self, results: Addresses | Sequence[int], count: int, threads: int | None = 1) -> None:
        """Write the results wanted of ``count`` scenes to ``results``, addresses in their order."""
        self._results[self._places] = results
        work = native.library.solve_impacts
        many = 1 if threads == 1 else workers(count, threads, WORTH_A_THREAD)
        if many == 1:
            work(self._at, 0, count)
        else:
            shared_out(lambda start, stop: work(self._at, start, stop), count, many)


class PreparedCall:
    """A call whose varying columns, by their ``places``, and results other than STATUS are rows of
    two arrays. ``values`` holds a number for each column, to be kept as long as this. Any number of
    threads may use it at a time."""

    def __init__(
        self, wanted: tuple[str, ...], places: Sequence[int], values: NDArray[np.float64]
    ) -> None:
        call = Call(wanted)
        call.columns[:] = values.ctypes.data + 8 * np.arange(len(COLUMNS))
        call.steps[list(places)] = 1
        call.choose_kernels({k: float(x) for k, x in enumerate(values) if k not in places})
        rows = [ALL.index(name) for name in wanted if name != "STATUS"]
        lists = (
            np.array([*some, *[0] * (room - len(some))], np.int64)
            for some, room in ((places, len(COLUMNS)), (rows, len(ALL)))
        )
        self._block = np.concatenate([call.block, [len(places), len(rows)], *lists])
        self._at = self._block.ctypes.data

    def run(self, values: int, results: int, status: int, count: int) -> None:
        """Write the results of ``count`` scenes; all addresses, 0 for STATUS where not wanted."""
        if count < 2 * WORTH_A_THREAD:
            native.library.solve_prepared(self._at, values, results, status, count)
            return
        work = native.library.solve_prepared_part

        def some(start: int, stop: int) -> None:
            work(self._at, values, results, status, count, start, stop)

        shared_out(some, count, workers(count, None, WORTH_A_THREAD))

    def bound(self, values: int, results: int, status: int, count: int) -> NDArray[np.int64]:
        """The argument block of `run` for one call of ``solve_bound`` on this thread, to be kept
        no longer than this and the memory."""
        return np.array([self._at, values, results, status, count], np.int64)


@lru_cache(maxsize=256)
def _free_calls(wanted: tuple[str, ...]) -> list[Call]:
    """The calls for the results ``wanted`` that no thread uses."""
    return []


@contextmanager
def call_of(wanted: tuple[str, ...]) -> Iterator[Call]:
    """A call for the results ``wanted``, this thread's alone for as long as this lasts."""
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
    """Write the results wanted of contiguous columns in the table's order, of length ``count`` or
    1."""
    with call_of(wanted) as call:
        call.columns[:] = [column.ctypes.data for column in columns]
        call.steps[:] = [len(column) > 1 for column in columns]
        call.choose_kernels({place: float(x[0]) for place, x in enumerate(columns) if len(x) == 1})
        call.run(results, count)
