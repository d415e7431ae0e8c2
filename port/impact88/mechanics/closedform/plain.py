"""Short path of `solve` for plain columns: float64 arrays of one shape, and numbers.

Each thread makes one call of the compiled library, and hardly anything is done column by column:
`bounds` and root finders make many short calls.
"""

import ctypes
import math
from bisect import bisect_left
from collections.abc import Mapping, Sequence
from functools import lru_cache
from itertools import pairwise
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import UserError
from ...names import SCENE
from .compiledcalls import Call, CallOfOneScene, free_calls

Array = NDArray[Any]

PLAIN = {float, int, np.float64}
NAMES = tuple(SCENE)
_FLOATS = np.dtype(np.float64)
_BITS = np.dtype(np.uint16)
MAX_CONVERTED = 4096
"""Scenes up to which columns of other types, or not contiguous, are copied by one call of numpy;
longer ones are left to the general path, which converts them tile by tile."""
MAX_COPIED = 512
"""Scenes up to which all columns are copied, where nothing else needs their addresses."""
MAX_TOGETHER = 1 << 25
"""Bytes up to which the results are rows of one array, which takes less time to make than many but
lives as long as any of them. Larger arrays the C library maps anew each time."""

_in_order = itemgetter(*NAMES)


class _Layout:
    """Places of columns and of numbers among a scene's values, by the types of these.

    ``columns``, ``numbers``: their places; ``order``: columns, then numbers; ``steps``: 1 for a
    column, 0 for a number. Of values copied into one block, columns first: ``strides``, bytes per
    scene before each value begins, and ``offsets``, further bytes.
    """

    def __init__(self, types: tuple[type, ...]) -> None:
        self.columns = [i for i, kind in enumerate(types) if kind is np.ndarray]
        self.numbers = [i for i, kind in enumerate(types) if kind is not np.ndarray]
        self.order = np.array([*self.columns, *self.numbers])
        self.steps = np.array([kind is np.ndarray for kind in types], np.int64)
        count = len(self.columns)
        self.strides = 8 * np.array([*range(count), *[count] * len(self.numbers)])
        self.offsets = 8 * np.array([*[0] * count, *range(len(self.numbers))])


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
    plain numbers, which gives numbers (numpy's float64, STATUS uint16); None where the general path
    has to look at them.

    ``threads``, ``out``: as in `solve`.
    """
    if "M" not in columns:
        columns = {**columns, "M": 6.0}
    try:
        values = _in_order(columns)
    except KeyError:
        return None
    if len(columns) != len(NAMES):
        return None
    layout = _layout(tuple(map(type, values)))
    if layout is None:
        return None
    if layout.columns:
        return _solve_columns(layout, values, wanted, threads, out)
    return _solve_one(values, wanted) if out is None else None


def _solve_columns(
    layout: _Layout,
    values: tuple[Any, ...],
    wanted: tuple[str, ...],
    threads: int | None,
    out: Mapping[str, Array] | None,
) -> dict[str, Any] | None:
    """Return the results of columns of one shape and numbers, laid out as ``layout`` says."""
    arrays = [values[i] for i in layout.columns]
    shape, count = arrays[0].shape, arrays[0].size
    if count < 2 or not all(array.shape == shape for array in arrays):
        return None
    # of few scenes copying all columns is cheaper than asking each for its address
    in_place = count > MAX_COPIED or out is not None
    inputs = _inputs(layout, arrays, [values[i] for i in layout.numbers], in_place)
    if inputs is None:
        return None
    _memory, starts, are_columns = inputs
    if out is None:
        by_name, result_starts = allocate_results(wanted, shape)
    else:
        column_starts = starts[: len(arrays)] if are_columns else None
        by_name, result_starts = results_into(out, wanted, shape, arrays, column_starts)
    free = free_calls(wanted)
    call = free.pop() if free else Call(wanted)
    call.columns[layout.order] = starts
    call.steps[:] = layout.steps
    call.run(result_starts, count, threads)
    free.append(call)
    return by_name


def _solve_one(values: tuple[Any, ...], wanted: tuple[str, ...]) -> dict[str, Any] | None:
    """Return the results of one scene's numbers; None where a whole number is no double."""
    free = free_calls(wanted, CallOfOneScene)
    call = free.pop() if free else CallOfOneScene(wanted)
    try:
        return call.solve(values)
    except OverflowError:
        return None
    finally:
        free.append(call)


def _inputs(
    layout: _Layout, arrays: list[Array], numbers: list[float], in_place: bool
) -> tuple[Array, Any, bool] | None:
    """Return an array to be kept for the length of the call, the addresses of all values, and
    whether they are the columns' own.

    ``in_place``: float64 columns are read where they are, and only the numbers are copied; else,
    of few scenes, all values are copied into one block. None where neither is possible.
    """
    count = arrays[0].size
    try:
        if in_place and all(_is_plain(array) for array in arrays):
            data = np.array(numbers, np.float64)
            first = address(data)
            numbers_at = range(first, first + data.nbytes, 8)
            return data, [*map(address, arrays), *numbers_at], True
        if count <= MAX_CONVERTED:
            data = np.concatenate([*arrays, numbers], None, dtype=np.float64, casting="same_kind")
            return data, address(data) + count * layout.strides + layout.offsets, False
    except (TypeError, OverflowError):  # not numbers
        pass
    return None


def _is_plain(array: Array) -> bool:
    return array.dtype == _FLOATS and array.flags.c_contiguous and array.flags.aligned


def address(array: Any) -> int:
    """Return an array's address. The buffer of a writable contiguous one gives it in a fourth of
    the time."""
    try:
        return ctypes.addressof(ctypes.c_char.from_buffer(array))
    except (TypeError, ValueError):  # not writable, not contiguous; empty
        start: int = array.__array_interface__["data"][0]
        return start


def allocate_results(
    names: Sequence[str], shape: tuple[int, ...]
) -> tuple[dict[str, Array], list[int]]:
    """Return an uninitialized array for each result, and their addresses."""
    size = 8 * math.prod(shape)
    if not shape or size * len(names) > MAX_TOGETHER or len(names) == 1:
        arrays = {name: np.empty(shape, _type_of(name)) for name in names}
        return arrays, [address(array) for array in arrays.values()]
    block = np.empty((len(names), *shape))
    first = address(block)
    arrays = dict(zip(names, block, strict=True))
    starts = list(range(first, first + size * len(names), size)) if size else [first] * len(names)
    if "STATUS" in arrays:
        arrays["STATUS"] = np.empty(shape, _BITS)
        starts[names.index("STATUS")] = address(arrays["STATUS"])
    return arrays, starts


def results_into(
    out: Mapping[str, Array],
    wanted: Sequence[str],
    shape: tuple[int, ...],
    columns: Sequence[Array],
    column_starts: Sequence[int] | None = None,
) -> tuple[dict[str, Array], list[int]]:
    """Return the results' arrays, of ``out`` where they are in it, and their addresses. Raises
    UserError.

    ``column_starts``: the addresses of columns that are all contiguous and of the results' size.
    """
    addresses = _check_output_arrays(out, wanted, shape)
    size = 8 * math.prod(shape)
    every = sorted([*addresses.values(), *(column_starts or ())])
    if column_starts is None or any(b - a < size for a, b in pairwise(every)):
        _check_apart(out, addresses, columns)
    if len(out) == len(wanted):
        return {name: out[name] for name in wanted}, [addresses[name] for name in wanted]
    missing = [name for name in wanted if name not in out]
    arrays, starts = allocate_results(missing, shape)
    starts_by_name = {**addresses, **dict(zip(missing, starts, strict=True))}
    arrays = {name: out[name] if name in out else arrays[name] for name in wanted}
    return arrays, [starts_by_name[name] for name in wanted]


def _type_of(name: str) -> np.dtype[Any]:
    return _BITS if name == "STATUS" else _FLOATS


def _check_output_arrays(
    out: Mapping[str, Array], wanted: Sequence[str], shape: tuple[int, ...]
) -> dict[str, int]:
    """Return the addresses of arrays for results. Raises UserError for those that cannot take
    them."""
    starts: dict[str, int] = {}
    for name in wanted:
        if name not in out:
            continue
        array, dtype = out[name], _type_of(name)
        if not isinstance(array, np.ndarray) or array.dtype != dtype or array.shape != shape:
            got = f"{array.dtype} {array.shape}" if isinstance(array, np.ndarray) else type(array)
            raise UserError(f"is {got}; expected an array of {dtype} {shape}", f"out, {name}")
        if not array.flags.carray:
            raise UserError("is not contiguous, not aligned or not writable", f"out, {name}")
        starts[name] = address(array)
    if len(starts) < len(out):
        unknown = next(name for name in out if name not in starts)
        raise UserError(
            f"is not among the requested results; expected some of {' '.join(wanted)}",
            f"out, {unknown}",
        )
    return starts


def _check_apart(
    out: Mapping[str, Array], starts: Mapping[str, int], columns: Sequence[Array]
) -> None:
    """Raise UserError where a result shares memory with a column or another result. Columns may
    overlap each other."""
    ranges = sorted((start, start + out[name].nbytes, name) for name, start in starts.items())
    ends = [end for _, end, _ in ranges]
    for (_, end, name), (start, _, _) in pairwise(ranges):
        if start < end:
            _refuse_shared(name)
    for column in columns:
        start, end = _address_range(column)
        # the first result that ends behind the column's beginning
        place = bisect_left(ends, start + 1)
        if start < end and place < len(ranges) and ranges[place][0] < end:
            _refuse_shared(ranges[place][2])


def _refuse_shared(name: str) -> None:
    raise UserError("shares memory with a column or another result", f"out, {name}")


def _address_range(array: Array) -> tuple[int, int]:
    """Return the addresses of an array's first byte and of the one behind its last."""
    start = address(array)
    if array.flags.c_contiguous:
        return start, start + array.nbytes
    if not array.size:
        return start, start
    moves = [(n - 1) * stride for n, stride in zip(array.shape, array.strides, strict=True)]
    below, above = sum(min(0, move) for move in moves), sum(max(0, move) for move in moves)
    return start + below, start + above + array.itemsize
