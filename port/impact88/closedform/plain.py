"""Plain columns, all of one kind, by one call of the compiled machine a thread: hardly anything is
done column by column, for `bounds` and root finders make many short calls."""

import math
import sys
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import native
from ..errors import UserError
from ..names import SCENE
from ..native.program import Addresses, Program, addresses
from ..processors import shared_out, workers
from .columns import ORDINARY, UNUSED_BY_POINTS, alike_kind
from .impactprograms import CIRCLE, program_for

Array = NDArray[Any]

PLAIN = {float, int, np.float64}
NAMES = tuple(SCENE)
FEW = 4096
"""Scenes up to which copying their columns is cheaper than looking at each: of 3,000 half as many
takes 1.4 times, of 5,000 twice as many .9 times, of 7,000 as long. The first half as many show of
what kind the next ones are; looking at twice as many takes 4 % of a call with 16,384."""
KEPT = 1 << 28
"""Bytes up to which results are rows of one array, which is paged in twice as fast as arrays of
their own but is kept as long as one of them, and up to which that memory is used again once nobody
holds any of it: all results of a million scenes, which take 70 instead of 250 to 500 ns a scene; a
quarter holds none."""
WORTH_KEEPING = 1 << 17
"""Bytes from which the C library gives memory back when it is freed, and fresh memory has to be
paged in; twice or half as much makes no call slower or faster."""
WORTH_A_THREAD = 32768
"""Scenes for each thread from which it pays: half a millisecond of the compiled machine, of which
starting a thread takes a fifth. With half as many two fifths; with twice as many calls with 65,536
scenes have one thread."""


class _Survey:
    """Values of some types, of which some are columns and the others numbers (``order``: columns
    first): ``where`` they are, and what the machine finds of them: the least and the most of each
    (``found``), its kind."""

    def __init__(self, types: tuple[type, ...]) -> None:
        self.columns = [i for i, kind in enumerate(types) if kind is np.ndarray]
        self.numbers = [i for i, kind in enumerate(types) if kind is not np.ndarray]
        self.order = tuple(NAMES[i] for i in (*self.columns, *self.numbers))
        many = len(self.columns)
        # of copies side by side: what a scene more moves them by, and where they begin
        self.by_scene = 8 * np.array([*range(many), *[many] * len(self.numbers)])
        self.after = 8 * np.array([*[0] * many, *range(len(self.numbers))])
        self.where = np.empty(len(NAMES), np.int64)
        self.found = np.empty((len(NAMES), 2))
        self._ordinary = np.array([ORDINARY[name] for name in self.order])
        self._kinds = np.empty(len(NAMES), np.uint8)
        self._columns = self.where.ctypes.data, many, len(NAMES)
        self._rooms = tuple(x.ctypes.data for x in (self.found, self._ordinary, self._kinds))

    def kinds(self, count: int) -> bytes:
        native.library.survey_kinds(*self._columns, count, *self._rooms)
        return self._kinds.tobytes()

    def limits(self) -> Array:
        """What the columns must keep to beyond the scenes surveyed."""
        return np.where((self._kinds == ord("a"))[:, np.newaxis], self._ordinary, self.found)


@lru_cache(maxsize=256)
def _surveys(types: tuple[type, ...]) -> list[_Survey] | None:
    """Those that no thread uses; None where not all values are arrays and plain numbers."""
    plain = all(kind is np.ndarray or kind in PLAIN for kind in types)
    return [] if plain and np.ndarray in types else None


@lru_cache(maxsize=1024)
def _prepared(
    order: tuple[str, ...], found: bytes, wanted: tuple[str, ...]
) -> tuple[Program, Addresses, dict[str, int], Addresses] | None:
    """A program for values in some ``order``; where among them are the columns it reads, the
    numbers it wants, and what has to stay as found. None where they have to be looked at."""
    kinds = dict(zip(order, found.decode(), strict=True))
    point = kinds["M"] == "4"
    special = {("M", "4"): "4", ("MU", "p"): "pivot"}
    for name, kind in kinds.items():
        if point and name in UNUSED_BY_POINTS:
            kinds[name] = "unused"
        elif (name, kind) in special:
            kinds[name] = special[name, kind]
        elif kind in "?4p":
            return None
        else:
            kinds[name] = {"a": "array", "s": "scalar"}.get(kind) or alike_kind(name, int(kind))
    program = program_for(tuple(kinds[name] for name in NAMES), wanted)
    place = {name: i for i, name in enumerate(order)}
    read = np.array([place[name] for name in program.columns], np.int64)
    fixed = {x: place[x] for x in program.scalars if isinstance(x, str)}
    used = np.array([place[name] for name in order if kinds[name] != "unused"], np.int64)
    return program, read, fixed, used


def solve_plain(
    values: tuple[Any, ...],
    wanted: tuple[str, ...],
    threads: int | None,
    out: Mapping[str, Array] | None,
) -> dict[str, Array] | None:
    """The results ``wanted`` of values in the table's order; None where they are not plain float64
    columns of one shape and numbers, or have to be looked at."""
    types = tuple(map(type, values))
    free = _surveys(types)
    if free is None:
        return None
    survey = free.pop() if free else _Survey(types)
    try:
        arrays = [values[i] for i in survey.columns]
        numbers = [values[i] for i in survey.numbers]
        shape, count, where = arrays[0].shape, arrays[0].size, survey.where
        if count < 2 or not all(array.shape == shape for array in arrays):
            return None
        if count <= FEW:
            data = np.concatenate([*arrays, numbers], None, dtype=np.float64, casting="same_kind")
            np.multiply(survey.by_scene, count, out=where)
            where += survey.after
            where += data.ctypes.data
        elif all(x.dtype == np.float64 and x.flags.c_contiguous for x in arrays):
            data = np.array(numbers, np.float64)
            where[: len(arrays)] = addresses(arrays)
            where[len(arrays) :] = data.ctypes.data + 8 * np.arange(len(numbers))
        else:
            return None
        made = _prepared(survey.order, survey.kinds(count if count <= FEW else FEW // 2), wanted)
        if made is None:
            return None
        program, read, places, used = made
        read, fixed = where[read], {name: survey.found[i, 0] for name, i in places.items()}
        by_name, into = rooms(wanted if out is None else [x for x in wanted if x not in out], shape)
        if out is not None:
            check_room(out, wanted, shape, arrays)
            by_name = {name: out[name] if name in out else by_name[name] for name in wanted}
            into = addresses(by_name.values())
        if count <= FEW:  # all have been looked at
            program.run(read, into, count, CIRCLE, fixed)
            return by_name
        used = used[used < len(arrays)]
        checked, limits, widths = where[used], survey.limits()[used], program.width[len(read) :]
        short: list[int] = []

        def part(start: int, stop: int) -> None:
            at, to, seen = read + 8 * start, into + widths * start, checked + 8 * start
            if program.run(at, to, stop - start, CIRCLE, fixed, seen, limits) < stop - start:
                short.append(start)

        shared_out(part, count, workers(count, threads, WORTH_A_THREAD))
        return None if short else by_name
    except (TypeError, OverflowError):  # no numbers
        return None
    finally:
        free.append(survey)


_kept: list[Array] = []


def _taken(blocks: list[Array]) -> tuple[Array, int]:
    """A block taken from a list, and how many refer to it."""
    block = blocks.pop()
    return block, sys.getrefcount(block)


_NOBODY_ELSE = _taken([np.empty(0)])[1]


def _memory(count: int) -> Array:
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
