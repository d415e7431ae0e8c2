"""Memory for results: fresh arrays, or the caller's, which must be apart from all columns."""

import ctypes
import math
from bisect import bisect_left
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import UserError

Array = NDArray[Any]

_FLOATS = np.dtype(np.float64)
_BITS = np.dtype(np.uint16)

MAX_TOGETHER = 1 << 25
"""Bytes of an array whose rows are results: larger ones the C library maps anew each time. Fewer
arrays take less time to make, but live as long as any of their rows."""

_buffer, _start = ctypes.c_char.from_buffer, ctypes.addressof


def address(array: Any) -> int:
    """Return an array's address. The buffer of a writable contiguous one gives it in a fourth of
    the time."""
    try:
        return _start(_buffer(array))
    except (TypeError, ValueError):  # not writable, not contiguous; empty
        start: int = array.__array_interface__["data"][0]
        return start


def allocate_results(
    names: Sequence[str], shape: tuple[int, ...]
) -> tuple[dict[str, Array], list[int]]:
    """Return an uninitialized array for each result, and their addresses."""
    size = 8 * math.prod(shape)
    rows = [name for name in names if name != "STATUS"]
    together = max(1, MAX_TOGETHER // max(1, size))
    arrays, starts = {}, {}
    for at in range(0, len(rows), together):
        group = rows[at : at + together]
        block = np.empty((len(group), *shape))
        first = address(block)
        for row, name in enumerate(group):
            arrays[name], starts[name] = block[row, ...], first + size * row
    if len(rows) < len(names):
        arrays["STATUS"] = np.empty(shape, _BITS)
        starts["STATUS"] = address(arrays["STATUS"])
    return {name: arrays[name] for name in names}, [starts[name] for name in names]


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
