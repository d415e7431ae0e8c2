"""Plain columns, all of one kind, by one call of the compiled machine a thread: hardly anything is
done column by column, for `bounds` and root finders make many short calls."""

import math
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import native
from ..errors import UserError
from ..names import SCENE
from ..native.program import Addresses, addresses
from ..processors import processors
from .columns import ORDINARY, UNUSED_BY_POINTS, alike_kind
from .impactprograms import CIRCLE, program_for

Array = NDArray[Any]

PLAIN = {float, int, np.float64}
NAMES = tuple(SCENE)
FEW = 2048
"""Scenes up to which copying their columns is cheaper than looking at each; and as many show of
what kind the next ones are."""
TOGETHER = 1 << 28
"""Bytes up to which results are rows of one array, which is paged in twice as fast as arrays of
their own but is kept as long as one of them."""
KEPT = 1 << 28
"""Bytes up to which the memory of results is used again once nobody holds any of them: all results
of a million scenes, which take 70 instead of 250 to 500 ns a scene; a quarter holds none."""
WORTH_KEEPING = 1 << 17
"""Bytes from which fresh memory has to be paged in; less is had from what was freed."""
WORTH_A_THREAD = 32768
"""Scenes for each thread from which it pays: half a millisecond of the compiled machine."""


class _Layout:
    """Which of a scene's values are columns and which are numbers (``order``: columns first), and
    room for what the machine finds of them."""

    def __init__(self, types: tuple[type, ...]) -> None:
        self.columns = [i for i, kind in enumerate(types) if kind is np.ndarray]
        self.numbers = [i for i, kind in enumerate(types) if kind is not np.ndarray]
        self.order = [NAMES[i] for i in (*self.columns, *self.numbers)]
        self.limits = np.array([ORDINARY[name] for name in self.order])
        many = len(self.columns)
        # of copies side by side: what a scene more moves them by, and where they begin
        self.by_scene = 8 * np.array([*range(many), *[many] * len(self.numbers)])
        self.after = 8 * np.array([*[0] * many, *range(len(self.numbers))])
        self.free: list[_Look] = []


class _Look:
    """What the machine finds of columns: the least and the most of each (``found``), its kind."""

    def __init__(self, layout: _Layout) -> None:
        self.where = np.empty(len(NAMES), np.int64)
        self.found = np.empty((len(NAMES), 2))
        self._kinds = np.empty(len(NAMES), np.uint8)
        self._many = self.where.ctypes.data, len(layout.columns), len(NAMES)
        rooms = self.found, layout.limits, self._kinds
        self._rooms = tuple(room.ctypes.data for room in rooms)

    def kinds(self, count: int) -> bytes:
        assert native.library is not None
        native.library.survey_kinds(*self._many, count, *self._rooms)
        return self._kinds.tobytes()


@lru_cache(maxsize=256)
def _layout(types: tuple[type, ...]) -> _Layout | None:
    plain = all(kind is np.ndarray or kind in PLAIN for kind in types)
    return _Layout(types) if plain and np.ndarray in types else None


class _Prepared:
    """A program for columns of some kinds, and where in a layout it finds what it reads."""

    def __init__(self, layout: _Layout, found: Mapping[str, str], wanted: tuple[str, ...]) -> None:
        kinds = []
        for name in NAMES:
            kind = found[name]
            if found["M"] == "4" and name in UNUSED_BY_POINTS:
                kinds.append("unused")
            elif kind in "4p" and name == {"4": "M", "p": "MU"}[kind]:
                kinds.append("4" if kind == "4" else "pivot")
            elif kind in "?4p":
                raise ValueError(name)
            else:
                kinds.append({"a": "array", "s": "scalar"}.get(kind) or alike_kind(name, int(kind)))
        self.program = program_for(tuple(kinds), wanted)
        place = {name: i for i, name in enumerate(layout.order)}
        self.read = np.array([place[name] for name in self.program.columns], np.int64)
        scalars = [x for x in self.program.scalars if isinstance(x, str)]
        self.fixed = {name: place[name] for name in scalars}
        kind_of = dict(zip(NAMES, kinds, strict=True))
        checked = [i for i in range(len(layout.columns)) if kind_of[layout.order[i]] != "unused"]
        self.checked = np.array(checked, np.int64)
        self.array = np.array([[kind_of[layout.order[i]] == "array"] for i in checked])
        self.limits = layout.limits[checked]
        self.widths = self.program.width[len(self.read) :]


@lru_cache(maxsize=1024)
def _prepared(layout: _Layout, kinds: bytes, wanted: tuple[str, ...]) -> _Prepared | None:
    """None where the numbers have to be looked at."""
    try:
        return _Prepared(layout, dict(zip(layout.order, kinds.decode(), strict=True)), wanted)
    except ValueError:
        return None


def solve_plain(
    values: tuple[Any, ...],
    wanted: tuple[str, ...],
    threads: int | None,
    out: Mapping[str, Array] | None,
) -> dict[str, Array] | None:
    """The results ``wanted`` of values in the table's order; None where they are not plain float64
    columns of one shape and numbers, or have to be looked at."""
    layout = _layout(tuple(map(type, values)))
    if layout is None:
        return None
    arrays = [values[i] for i in layout.columns]
    shape, count = arrays[0].shape, arrays[0].size
    if count < 2 or not all(array.shape == shape for array in arrays):
        return None
    numbers = [values[i] for i in layout.numbers]
    look = layout.free.pop() if layout.free else _Look(layout)
    try:
        if count <= FEW:
            data = np.concatenate([*arrays, numbers], None, dtype=np.float64, casting="same_kind")
        else:
            data = np.array(numbers, np.float64)
    except (TypeError, OverflowError):  # no numbers
        return None
    if count <= FEW:
        np.multiply(layout.by_scene, count, out=look.where)
        look.where += layout.after
        look.where += data.ctypes.data
    elif all(x.dtype == np.float64 and x.flags.c_contiguous for x in arrays):
        look.where[: len(arrays)] = addresses(arrays)
        look.where[len(arrays) :] = data.ctypes.data + 8 * np.arange(len(numbers))
    else:
        return None
    made = _prepared(layout, look.kinds(min(count, FEW)), wanted)
    if made is None:
        return None
    fixed = {name: look.found[i, 0] for name, i in made.fixed.items()}
    by_name, into = rooms(wanted if out is None else [x for x in wanted if x not in out], shape)
    if out is not None:
        check_room(out, wanted, shape, arrays)
        by_name = {name: out[name] if name in out else by_name[name] for name in wanted}
        into = addresses(by_name.values())
    read = look.where[made.read]
    short: list[int] = []
    if count <= FEW:  # all have been looked at
        made.program.run(read, into, count, CIRCLE, fixed)
    else:
        checked = look.where[made.checked]
        limits = np.where(made.array, made.limits, look.found[made.checked])

        def part(start: int, stop: int) -> None:
            at, to, seen = read + 8 * start, into + made.widths * start, checked + 8 * start
            if made.program.run(at, to, stop - start, CIRCLE, fixed, seen, limits) < stop - start:
                short.append(start)

        shared_out(part, count, workers(count, threads, WORTH_A_THREAD))
    layout.free.append(look)
    return None if short else by_name


def workers(count: int, threads: int | None, share: int) -> int:
    """How many threads, each with at least ``share`` scenes to do."""
    return max(1, min(threads or processors(), count // share))


def shared_out(work: Callable[[int, int], None], count: int, workers: int) -> None:
    """Do ``work(start, stop)`` of all scenes, an equal part by each of some threads."""
    size = -(-count // workers)
    failures: list[BaseException] = []

    def part(start: int) -> None:
        try:
            work(start, min(start + size, count))
        except BaseException as error:
            failures.append(error)

    others = [threading.Thread(target=part, args=(k * size,)) for k in range(1, workers)]
    for thread in others:
        thread.start()
    part(0)
    for thread in others:
        thread.join()
    if failures:
        raise failures[0]


_kept: list[Array] = []


def _memory(count: int) -> Array:
    """So many float64, those of an earlier call where no array refers to them any more."""
    block = _kept.pop() if _kept else None
    if block is None or block.size != count or sys.getrefcount(block) > 2:  # here, and the argument
        block = np.empty(count)
    if WORTH_KEEPING <= block.nbytes <= KEPT:
        _kept[:] = [block]
    return block


def rooms(names: Sequence[str], shape: tuple[int, ...]) -> tuple[dict[str, Array], Addresses]:
    """Arrays for results, and where they begin."""
    count = math.prod(shape)
    many = max(1, TOGETHER // max(1, 8 * count))
    made: dict[str, Array] = {}
    where = np.empty(len(names), np.int64)
    for at in range(0, len(names), many):
        some = names[at : at + many]
        together = _memory(len(some) * count).reshape(len(some), *shape)
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
        dtype = np.dtype(np.uint16 if name == "STATUS" else np.float64)
        if not isinstance(array, np.ndarray) or array.dtype != dtype or array.shape != shape:
            got = f"{array.dtype} {array.shape}" if isinstance(array, np.ndarray) else type(array)
            raise UserError(f"is {got}; expected an array of {dtype} {shape}", where)
        if not (array.flags.c_contiguous and array.flags.writeable):
            raise UserError("is not contiguous or not writable", where)
        others = [*columns, *(other for key, other in out.items() if key != name)]
        if any(np.may_share_memory(array, other) for other in others):
            raise UserError("shares memory with a column or another result", where)
