"""Plain columns by one call of the compiled machine a thread: hardly anything is done column by
column, for `bounds` and root finders make many short calls."""

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
_FLOATS, _BITS = np.dtype(np.float64), np.dtype(np.uint16)
FEW = 4096
"""Scenes up to which columns of other types or in pieces are copied side by side by one call of
numpy; more are left to the arrays, which take them in tiles."""
VERY_FEW = 512
"""Scenes up to which copying columns side by side is cheaper than asking each for its address."""
KEPT = 1 << 28
"""Bytes up to which results are rows of one array, which is paged in twice as fast as arrays of
their own but is kept as long as one of them, and up to which that memory is used again once nobody
holds any of it: all results of a million scenes, which take 70 instead of 250 to 500 ns a scene; a
quarter holds none."""
WORTH_KEEPING = 1 << 17
"""Bytes from which the C library gives memory back when it is freed, and fresh memory has to be
paged in; twice or half as much makes no call slower or faster."""


class _Layout:
    """Values of some types: which are columns and which are numbers."""

    def __init__(self, types: tuple[type, ...]) -> None:
        self.columns = [i for i, kind in enumerate(types) if kind is np.ndarray]
        self.numbers = [i for i, kind in enumerate(types) if kind is not np.ndarray]
        self.order = np.array([*self.columns, *self.numbers])
        self.steps = np.array([kind is np.ndarray for kind in types], np.int64)
        many = len(self.columns)
        # of copies side by side: what a scene more moves them by, and where they begin
        self.by_scene = 8 * np.array([*range(many), *[many] * len(self.numbers)])
        self.after = 8 * np.array([*[0] * many, *range(len(self.numbers))])


@lru_cache(maxsize=256)
def _layout(types: tuple[type, ...]) -> _Layout | None:
    """None where not all values are arrays and plain numbers."""
    plain = all(kind is np.ndarray or kind in PLAIN for kind in types)
    return _Layout(types) if plain and np.ndarray in types else None


def solve_plain(
    values: tuple[Any, ...],
    wanted: tuple[str, ...],
    threads: int | None,
    out: Mapping[str, Array] | None,
) -> dict[str, Array] | None:
    """The results ``wanted`` of values in the table's order; None where they are not plain columns
    of one shape and numbers."""
    layout = _layout(tuple(map(type, values)))
    if layout is None:
        return None
    arrays = [values[i] for i in layout.columns]
    numbers = {i: values[i] for i in layout.numbers}
    shape, count = arrays[0].shape, arrays[0].size
    if count < 2 or not all(array.shape == shape for array in arrays):
        return None
    try:
        if count > VERY_FEW and all(_is_plain(array) for array in arrays):
            data = np.array(list(numbers.values()), np.float64)
            where = np.concatenate(
                [addresses(arrays), data.ctypes.data + 8 * np.arange(len(numbers))]
            )
        elif count <= FEW:
            data = np.concatenate(
                [*arrays, list(numbers.values())], None, dtype=np.float64, casting="same_kind"
            )
            where = data.ctypes.data + count * layout.by_scene + layout.after
        else:
            return None
    except (TypeError, OverflowError):  # no numbers
        return None
    by_name, into = rooms(wanted if out is None else [x for x in wanted if x not in out], shape)
    if out is not None:
        check_room(out, wanted, shape, arrays)
        by_name = {name: out[name] if name in out else by_name[name] for name in wanted}
        into = addresses(by_name.values())
    with call_of(wanted) as call:
        call.columns[layout.order] = where
        call.steps[:] = layout.steps
        call.choose_kernels(numbers)
        call.run(into, count, threads)
    return by_name


def _is_plain(array: Array) -> bool:
    return array.dtype == np.float64 and array.flags.c_contiguous and array.flags.aligned


_kept: list[Array] = []


def _taken(blocks: list[Array]) -> tuple[Array, int]:
    """A block taken from a list, and how many refer to it."""
    block = blocks.pop()
    return block, sys.getrefcount(block)


_NOBODY_ELSE = _taken([np.empty(0)])[1]


def memory(count: int) -> Array:
    """So many float64, those of an earlier call where no array refers to them any more."""
    block, references = _taken(_kept) if _kept else (None, 0)
    if block is None or block.size != count or references > _NOBODY_ELSE:
        block = np.empty(count)
    if WORTH_KEEPING <= block.nbytes <= KEPT:
        _kept[:] = [block]
    return block


def rooms(names: Sequence[str], shape: tuple[int, ...]) -> tuple[dict[str, Array], Addresses]:
    """Arrays for results, and where they begin."""
    count = math.prod(shape)
    many = max(1, KEPT // max(1, 8 * count))
    made: dict[str, Array] = {}
    where = np.empty(len(names), np.int64)
    for at in range(0, len(names), many):
        some = names[at : at + many]
        together = memory(len(some) * count).reshape(len(some), *shape)
        rows = together if shape else [together[i, ...] for i in range(len(some))]
        made.update(zip(some, rows, strict=True))
        where[at : at + many] = together.ctypes.data + 8 * count * np.arange(len(some))
    if "STATUS" in made:
        made["STATUS"] = np.empty(shape, np.uint16)
        where[names.index("STATUS")] = made["STATUS"].ctypes.data
    return made, where


def check_room(
    out: Mapping[str, Array],
    wanted: Sequence[str],
    shape: tuple[int, ...],
    columns: Sequence[Array],
) -> None:
    """Raises UserError for arrays that cannot take the results."""
    for name, array in out.items():
        where = f"out, {name}"
        if name not in wanted:
            raise UserError(
                f"is not a result asked for; expected some of {' '.join(wanted)}", where
            )
        dtype = _BITS if name == "STATUS" else _FLOATS
        if not isinstance(array, np.ndarray) or array.dtype != dtype or array.shape != shape:
            got = f"{array.dtype} {array.shape}" if isinstance(array, np.ndarray) else type(array)
            raise UserError(f"is {got}; expected an array of {dtype} {shape}", where)
        flags = array.flags
        if not (flags.c_contiguous and flags.writeable and flags.aligned):
            raise UserError("is not contiguous, not aligned or not writable", where)
    _check_apart(out, columns)


def _check_apart(out: Mapping[str, Array], columns: Sequence[Array]) -> None:
    """Raises UserError where a result shares memory with a column or another result: one pass over
    the stretches of memory by where they begin. Columns may overlap each other."""
    stretches = [(*_stretch(array), name) for name, array in out.items()]
    stretches += [(*_stretch(column), "") for column in columns]
    last, holder = 0, ""  # where the results so far end, and which ends there
    last_column = 0
    for start, end, name in sorted(stretches):
        if start == end:
            continue
        if start < last or (name and start < last_column):
            raise UserError(
                "shares memory with a column or another result", f"out, {name or holder}"
            )
        if name:
            last, holder = max((last, holder), (end, name))
        else:
            last_column = max(last_column, end)


def _stretch(array: Array) -> tuple[int, int]:
    """Where an array's memory begins and ends."""
    start = array.ctypes.data
    if array.flags.c_contiguous:
        return start, start + array.nbytes
    if not array.size:
        return start, start
    moves = [(n - 1) * stride for n, stride in zip(array.shape, array.strides, strict=True)]
    below, above = sum(min(0, move) for move in moves), sum(max(0, move) for move in moves)
    return start + below, start + above + array.itemsize
