"""Plain columns, which `solve` reads where they are: float64 arrays of one shape, and numbers.

Hardly anything is done column by column: `bounds` and root finders make many short calls.
"""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...names import SCENE
from .compiledcalls import RowsCall, compute
from .results import address, allocate_results, results_into

Array = NDArray[Any]

PLAIN = {float, int, np.float64}
NAMES = tuple(SCENE)
_FLOATS = np.dtype(np.float64)

MAX_COPIED = 512
"""Scenes up to which all columns are copied, where nothing else needs their addresses: to ask each
array for its own takes longer."""
MAX_CONVERTED = 4096
"""Scenes up to which columns of other types, or not contiguous, are copied by one call of numpy;
longer ones are converted block by block, in memory that does not grow."""

_in_order = itemgetter(*NAMES)


class _Layout:
    """Places of columns and of numbers among a scene's values, by the types of these.

    ``columns``, ``numbers``: their places; ``in_order``: puts what is first of all columns and then
    of all numbers in the table's order; ``steps``: 1 for a column, 0 for a number.
    """

    def __init__(self, types: tuple[type, ...]) -> None:
        self.columns = [i for i, kind in enumerate(types) if kind is np.ndarray]
        self.numbers = [i for i, kind in enumerate(types) if kind is not np.ndarray]
        self.in_order = itemgetter(*np.argsort([*self.columns, *self.numbers]).tolist())
        self.steps = np.array([kind is np.ndarray for kind in types], np.int64)
        self._calls: dict[tuple[str, ...], RowsCall] = {}

    def call(self, wanted: tuple[str, ...]) -> RowsCall:
        """Return the call of such values in one array, columns first."""
        if (call := self._calls.get(wanted)) is None:
            self._calls[wanted] = call = RowsCall(wanted, self.columns, self.numbers)
        return call


@lru_cache(maxsize=256)
def _layout(types: tuple[type, ...]) -> _Layout | None:
    """Return the layout of values of these types; None unless all are arrays or plain numbers."""
    plain = all(kind is np.ndarray or kind in PLAIN for kind in types)
    return _Layout(types) if plain else None


def solve_plain(
    columns: Mapping[str, Any],
    wanted: tuple[str, ...],
    threads: int | None,
    out: Mapping[str, Array] | None,
) -> dict[str, Any] | None:
    """Return the results ``wanted`` of plain columns of one shape and numbers, or of one scene of
    plain numbers, which gives numbers (numpy's float64, STATUS uint16); None where the columns have
    to be read first. The compiled library is there.

    ``threads``, ``out``: as in `solve`.
    """
    if "M" not in columns:
        columns = {**columns, "M": 6.0}
    try:
        values = _in_order(columns)
    except KeyError:
        return None
    layout = _layout(tuple(map(type, values))) if len(columns) == len(NAMES) else None
    if layout is None:
        return None
    try:
        if layout.columns:
            return _solve_columns(layout, values, wanted, threads, out)
        return None if out is not None else layout.call(wanted).solve(np.array(values, float), ())
    except (TypeError, OverflowError):  # not numbers
        return None


def _solve_columns(
    layout: _Layout,
    values: tuple[Any, ...],
    wanted: tuple[str, ...],
    threads: int | None,
    out: Mapping[str, Array] | None,
) -> dict[str, Any] | None:
    """Return the results of columns and numbers. Raises TypeError and OverflowError for those that
    are none."""
    arrays = [values[i] for i in layout.columns]
    shape, count = arrays[0].shape, arrays[0].size
    if not all(array.shape == shape for array in arrays):
        return None
    numbers = [values[i] for i in layout.numbers]
    starts = _starts(arrays) if count > MAX_COPIED or out is not None else None
    if starts is None:
        if count > MAX_CONVERTED or out is not None:
            return None
        rows = np.concatenate([*arrays, numbers], None, dtype=np.float64, casting="same_kind")
        return layout.call(wanted).solve(rows, shape)
    constants = np.array(numbers, np.float64)
    first = address(constants)
    columns = layout.in_order([*starts, *range(first, first + constants.nbytes, 8)])
    if out is None:
        by_name, result_starts = allocate_results(wanted, shape)
    else:
        by_name, result_starts = results_into(out, wanted, shape, arrays, starts)
    compute(columns, layout.steps, wanted, result_starts, count, threads)
    return by_name


def _starts(arrays: Sequence[Array]) -> list[int] | None:
    """Return the addresses of float64 arrays; None unless all are such, contiguous and aligned."""
    for array in arrays:
        if array.dtype != _FLOATS or not (array.flags.c_contiguous and array.flags.aligned):
            return None
    return [*map(address, arrays)]
