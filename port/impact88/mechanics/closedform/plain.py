"""Short path of `solve` for plain columns: float64 arrays of one shape, and numbers.

Each thread makes one call of the compiled kernels, and hardly anything is done column by column:
`bounds` and root finders make many short calls.
"""

import math
import sys
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import UserError
from ...names import SCENE
from ..native.program import Addresses, addresses
from .kernelcalls import call_of

Array = NDArray[Any]

PLAIN = {float, int, np.float64}
NAMES = tuple(SCENE)
_FLOATS = np.dtype(np.float64)
_BITS = np.dtype(np.uint16)
MAX_CONVERTED = 4096
"""Scenes up to which columns of other types, or not contiguous, are copied by one call of numpy;
longer ones are left to the general path, which converts them tile by tile."""
MAX_COPIED = 512
"""Scenes up to which copying all columns is cheaper than asking each for its address."""
MAX_REUSED_BYTES = 1 << 28
"""Size up to which results are rows of one array, whose memory is used again once no result of it
is referenced. One array is paged in twice as fast as many, but lives as long as any of its rows.
Chosen for all results of a million scenes: 70 instead of 250 to 500 ns a scene; a quarter of this
size is too small for them."""
MIN_REUSED_BYTES = 1 << 17
"""Size from which the C library returns freed memory to the system, so that fresh memory has to be
paged in. Twice or half as much makes no call slower or faster."""


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
    """Return the layout of values of these types; None unless all are arrays or plain numbers, at
    least one an array."""
    plain = all(kind is np.ndarray or kind in PLAIN for kind in types)
    return _Layout(types) if plain and np.ndarray in types else None


def solve_plain(
    values: tuple[Any, ...],
    wanted: tuple[str, ...],
    threads: int | None,
    out: Mapping[str, Array] | None,
) -> dict[str, Array] | None:
    """Return the results ``wanted`` of values in the table's order; None where these are not plain
    columns of one shape and numbers, and the general path has to look at them.

    ``threads``, ``out``: as in `solve`.
    """
    layout = _layout(tuple(map(type, values)))
    if layout is None:
        return None
    arrays = [values[i] for i in layout.columns]
    numbers = {i: values[i] for i in layout.numbers}
    shape, count = arrays[0].shape, arrays[0].size
    if count < 2 or not all(array.shape == shape for array in arrays):
        return None
    inputs = _inputs(layout, arrays, list(numbers.values()))
    if inputs is None:
        return None
    _memory, input_addresses = inputs
    missing = wanted if out is None else [name for name in wanted if name not in out]
    by_name, result_addresses = allocate_results(missing, shape)
    if out is not None:
        check_output_arrays(out, wanted, shape, arrays)
        by_name = {name: out[name] if name in out else by_name[name] for name in wanted}
        result_addresses = addresses(by_name.values())
    with call_of(wanted) as call:
        call.columns[layout.order] = input_addresses
        call.steps[:] = layout.steps
        call.choose_kernels(numbers)
        call.run(result_addresses, count, threads)
    return by_name


def _inputs(
    layout: _Layout, arrays: list[Array], numbers: list[float]
) -> tuple[Array, Addresses] | None:
    """Return an array to be kept for the length of the call, and the addresses of all values.

    Long float64 columns are read where they are, and only the numbers are copied; of few scenes
    all values are copied into one block. None where neither is possible.
    """
    count = arrays[0].size
    try:
        if count > MAX_COPIED and all(_is_plain(array) for array in arrays):
            data = np.array(numbers, np.float64)
            number_addresses = data.ctypes.data + 8 * np.arange(len(numbers))
            return data, np.concatenate([addresses(arrays), number_addresses])
        if count <= MAX_CONVERTED:
            data = np.concatenate([*arrays, numbers], None, dtype=np.float64, casting="same_kind")
            return data, data.ctypes.data + count * layout.strides + layout.offsets
    except (TypeError, OverflowError):  # not numbers
        pass
    return None


def _is_plain(array: Array) -> bool:
    return array.dtype == np.float64 and array.flags.c_contiguous and array.flags.aligned


_reusable: list[Array] = []
"""The block of results of the last call, or nothing."""


def _pop_block(blocks: list[Array]) -> tuple[Array, int]:
    """Take the last block from a list; return it and its reference count."""
    block = blocks.pop()
    return block, sys.getrefcount(block)


_UNSHARED = _pop_block([np.empty(0)])[1]
"""Reference count of a block that no result refers to."""


def memory(count: int) -> Array:
    """Return an uninitialized array of ``count`` float64: that of an earlier call where no result
    refers to it any more."""
    block, references = _pop_block(_reusable) if _reusable else (None, 0)
    if block is None or block.size != count or references > _UNSHARED:
        block = np.empty(count)
    if MIN_REUSED_BYTES <= block.nbytes <= MAX_REUSED_BYTES:
        _reusable[:] = [block]
    return block


def allocate_results(
    names: Sequence[str], shape: tuple[int, ...]
) -> tuple[dict[str, Array], Addresses]:
    """Return an uninitialized array for each result, and their addresses."""
    count = math.prod(shape)
    per_block = max(1, MAX_REUSED_BYTES // max(1, 8 * count))
    arrays: dict[str, Array] = {}
    starts = np.empty(len(names), np.int64)
    for at in range(0, len(names), per_block):
        group = names[at : at + per_block]
        block = memory(len(group) * count).reshape(len(group), *shape)
        rows = block if shape else [block[i, ...] for i in range(len(group))]
        arrays.update(zip(group, rows, strict=True))
        starts[at : at + per_block] = block.ctypes.data + 8 * count * np.arange(len(group))
    if "STATUS" in arrays:
        arrays["STATUS"] = np.empty(shape, np.uint16)
        starts[names.index("STATUS")] = arrays["STATUS"].ctypes.data
    return arrays, starts


def check_output_arrays(
    out: Mapping[str, Array],
    wanted: Sequence[str],
    shape: tuple[int, ...],
    columns: Sequence[Array],
) -> None:
    """Raise UserError for arrays that cannot take the results."""
    for name, array in out.items():
        place = f"out, {name}"
        if name not in wanted:
            raise UserError(
                f"is not among the requested results; expected some of {' '.join(wanted)}", place
            )
        dtype = _BITS if name == "STATUS" else _FLOATS
        if not isinstance(array, np.ndarray) or array.dtype != dtype or array.shape != shape:
            got = f"{array.dtype} {array.shape}" if isinstance(array, np.ndarray) else type(array)
            raise UserError(f"is {got}; expected an array of {dtype} {shape}", place)
        flags = array.flags
        if not (flags.c_contiguous and flags.writeable and flags.aligned):
            raise UserError("is not contiguous, not aligned or not writable", place)
    _check_apart(out, columns)


def _check_apart(out: Mapping[str, Array], columns: Sequence[Array]) -> None:
    """Raise UserError where a result shares memory with a column or another result: one pass over
    the address ranges in order. Columns may overlap each other."""
    ranges = [(*_address_range(array), name) for name, array in out.items()]
    ranges += [(*_address_range(column), "") for column in columns]
    results_end, last_result = 0, ""  # the highest address of the results so far, and of which
    columns_end = 0
    for start, end, name in sorted(ranges):
        if start == end:
            continue
        if start < results_end or (name and start < columns_end):
            raise UserError(
                "shares memory with a column or another result", f"out, {name or last_result}"
            )
        if name:
            results_end, last_result = max((results_end, last_result), (end, name))
        else:
            columns_end = max(columns_end, end)


def _address_range(array: Array) -> tuple[int, int]:
    """Return the addresses of an array's first byte and of the one behind its last."""
    start = array.ctypes.data
    if array.flags.c_contiguous:
        return start, start + array.nbytes
    if not array.size:
        return start, start
    moves = [(n - 1) * stride for n, stride in zip(array.shape, array.strides, strict=True)]
    below, above = sum(min(0, move) for move in moves), sum(max(0, move) for move in moves)
    return start + below, start + above + array.itemsize
