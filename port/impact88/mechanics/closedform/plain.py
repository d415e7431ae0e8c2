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
from .columns import source_of
from .compiledcalls import TILE, call_of
from .general import solve_sources
from .results import address, allocate_results, results_into

Array = NDArray[Any]

PLAIN = {float, int, np.float64}
NAMES = tuple(SCENE)
_FLOATS = np.dtype(np.float64)

_in_order = itemgetter(*NAMES)


@lru_cache(maxsize=256)
def _places(types: tuple[type, ...]) -> tuple[tuple[int, ...], list[int]] | None:
    """Return the places of the arrays and of the numbers among values of these types; None unless
    all are arrays or plain numbers."""
    if not all(kind is np.ndarray or kind in PLAIN for kind in types):
        return None
    columns = tuple(i for i, kind in enumerate(types) if kind is np.ndarray)
    return columns, [i for i in range(len(types)) if i not in columns]


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
    places = _places(tuple(map(type, values))) if len(columns) == len(NAMES) else None
    if places is None:
        return None
    try:
        if places[0]:
            return _solve_columns(*places, values, wanted, threads, out)
        return None if out is not None else call_of(wanted, ()).solve(np.array(values, float), ())
    except (TypeError, OverflowError):  # not numbers
        return None


def _solve_columns(
    columns: tuple[int, ...],
    numbers: Sequence[int],
    values: tuple[Any, ...],
    wanted: tuple[str, ...],
    threads: int | None,
    out: Mapping[str, Array] | None,
) -> dict[str, Any] | None:
    """Return the results of values of which those at the places ``columns`` are arrays. Raises
    TypeError and OverflowError for those that are no numbers."""
    arrays, constants = [values[i] for i in columns], [values[i] for i in numbers]
    shape, count = arrays[0].shape, arrays[0].size
    if not all(array.shape == shape for array in arrays):
        return None
    call = call_of(wanted, columns)
    if count <= TILE and out is None:  # the copy that the library would make
        rows = np.concatenate([*arrays, constants], None, dtype=np.float64, casting="same_kind")
        return call.solve(rows, shape)
    if (starts := _starts(arrays)) is None:
        if not all(array.dtype.kind in "fiub" for array in arrays):
            return None
        sources = {n: source_of(np.asarray(x), shape) for n, x in zip(NAMES, values, strict=True)}
        return solve_sources(sources, shape, wanted, threads, out)
    number_row = np.array(constants, np.float64)
    first = address(number_row)
    if out is None:
        by_name, results = allocate_results(wanted, shape)
    else:
        by_name, results = results_into(out, wanted, shape, arrays, starts)
    number_starts = range(first, first + number_row.nbytes, 8)
    call.compute([*starts, *number_starts, *results], count, threads)
    return by_name


def _starts(arrays: Sequence[Array]) -> list[int] | None:
    """Return the addresses of float64 arrays; None unless all are such, contiguous and aligned."""
    for array in arrays:
        if array.dtype != _FLOATS or not (array.flags.c_contiguous and array.flags.aligned):
            return None
    return [*map(address, arrays)]
