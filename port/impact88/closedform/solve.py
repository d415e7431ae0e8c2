"""`impact88.solve`: the impact in double precision over any number of scenes.

Same physics as the 1988 listing (Equations 13 to 18, its sign rule of line 400, its pivot and its
point masses) with exact pi, by the closed form of `closedform.impact`.
"""

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
from ..mappings import in_base, in_doubles
from ..names import PIVOT, RESULTS, SCENE
from ..native.program import addresses, extremes
from ..processors import processors
from ..scene import check_mapping
from ..status import Status
from .columns import ORDINARY, Block, Buffers, Source, examine, ordinary_kinds, sources
from .fused import CIRCLE, plan_for, program_for
from .onescene import ALL, PLAIN, in_order, solve_one
from .share import share_of

Array = NDArray[Any]

_CELLS = {str, list, tuple}
_FLOATS = np.dtype(np.float64)
"""Of a column of texts, in which MU may be a share."""
_ROWS = 8 * np.arange(len(SCENE))
TILE = 16384
"""Scenes a pass works on. Two arrays fit the second-level cache and all of them the third; numpy's
cost of starting an operation (half a microsecond) is spread over enough scenes not to matter.
Measured: 4096 takes a fifth longer, 8192 and 32768 a few percent."""
SHARED_TILE = 4 * TILE
"""The same for several threads. Each operation hands Python's lock to the other thread and wants it
back; when operations are short the other has not woken up by then, and the threads take turns.
Measured on two cores: 1.6 times as fast as one with tiles this long, 1.1 times with `TILE`."""
FEW = 2048
"""Scenes up to which copying their columns is cheaper than looking at each; and as many show of
what kind the next ones are."""
TOGETHER = 1 << 28
"""Bytes up to which results are rows of one array, which is had sooner than arrays of their own (6
instead of 12 ns a scene for the six velocities of a million) but is kept as long as one of them."""
KEPT = 1 << 26
"""Bytes up to which the memory of results is used again once nobody holds any of them: paging in
fresh memory takes 6 of 26 ns a scene for the six velocities of a million, and more for all results.
Half of it spares that to half as many scenes."""
WORTH_KEEPING = 1 << 17
"""Bytes from which fresh memory has to be paged in; less is had from what was freed."""
WORTH_A_THREAD = 32768
"""Scenes for each thread from which it pays: half a millisecond of the compiled machine."""


def solve(
    columns: Mapping[str, object],
    outputs: Sequence[str] | str | None = None,
    *,
    threads: int | None = None,
    out: Mapping[str, Array] | None = None,
) -> dict[str, Array]:
    """Solve the impact of every scene.

    Args:
        columns: scene name -> number or array (see ``impact88.names.SCENE``); all broadcast
            together. Angles in degrees, spins in radians per unit of time. ``MU`` = -10 is the
            pivot; any other MU takes the sign line 400 gives it (changed where gt > 0, kept on a
            tie), or, as a text such as "85 %", that share of the critical friction.
            ``M`` is 6 (the default) or 4. Infinite MA, IA, MB or IB make a rigid barrier.
        outputs: the result names wanted (``impact88.names.RESULTS``), all of them by default. Only
            what they need is computed.
        threads: how many to use; by default as many as there are processors and work.
        out: result name -> array to write it into, of the broadcast shape, contiguous, float64
            (STATUS: uint16), apart from all columns; results not in it get arrays of their own. A
            loop that gives the same arrays again is spared the paging in of fresh memory. Where
            ``outputs`` is left out, its names are the results wanted.

    Returns:
        name -> array of the broadcast shape, float64 (STATUS: uint16), in the order asked. Of one
        scene, given as plain numbers, the results are numbers too (numpy's float64, which is a
        float): a few microseconds, the same bits.

    M = 4 is the point-mass impact: DA and DB count as 0; EM, angles other than GA and inertias are
    not looked at, spins pass through and stay out of the energies. An infinite body must be at
    rest and adds no energy; not both bodies may be infinite (mass or inertia).

    A scene with a number that cannot be used (not finite, M neither 4 nor 6, a mass or inertia
    that is not positive, a barrier that moves, two barriers) is NaN in every result and has
    NOT_FINITE alone in STATUS; a scene without solution is NaN in what depends on it, and so are
    ratios of zeros (LOSS and MUC where nothing moves) and what overflows; NOT_FINITE says so of all
    but MUC, which other results seldom need. None disturbs another scene: every scene gets the bits
    it would get alone, unless something overflows on the way (where numbers reach 1e±150): a term
    that is known to be 0 is left out, and beside scenes where it is not, 0 times infinity is NaN.
    A zero is +0.0 always.

    Where the listing does not solve its own equations, the equations are solved: an MU below -10,
    or MU = 10 that the sign rule makes -10 (there line 510 zeroes a right-hand side that is not a
    pivot's), is taken as the friction coefficient it is, with MU_OUT_OF_RANGE in STATUS.

    SINGULAR in STATUS means COND >= 2**26 (half of a double's digits may be lost), ENERGY_GAINED
    more than 1e-12 of KI, the FRICTION bits that P_t/P_n does not lie between 0 and MUC
    (`closedform.statusbits.friction_faults`); `impact88.status` says all in words.

    Raises UserError for unknown or missing names, columns that hold no numbers or do not broadcast,
    and arrays in ``out`` that cannot take the results.

    >>> scene = impact88.sample(1).numbers()
    >>> impact88.solve({**scene, "MU": [0.5, 0.911, -10]}, ["LOSS"])["LOSS"].round(2)
    array([44.43, 57.47, 57.56])
    """
    if type(columns) is not dict:
        check_mapping(columns)
    wanted = _wanted(tuple(out) if outputs is None and out is not None else outputs)
    mu = columns.get("MU")
    if type(mu) in _CELLS or getattr(mu, "dtype", _FLOATS).kind in "OUS":
        columns = _with_shares_typed(in_base(columns))
    values = in_order(columns)
    if values and wanted:
        few = solve_one(values, wanted) if out is None else None
        if few is None and native.library is not None:
            few = solve_plain(values, wanted, threads, out)
        if few is not None:
            return few
    results = _solved(columns, wanted, threads, out=out)
    # of one scene: numbers, not arrays without dimensions
    return {
        name: array[()] if array.ndim == 0 and out is None else array
        for name, array in results.items()
    }


def _solved(
    columns: Mapping[str, object],
    wanted: tuple[str, ...],
    threads: int | None,
    sign: float | None = None,
    out: Mapping[str, Array] | None = None,
) -> dict[str, Array]:
    given, shape = sources(columns)
    count = math.prod(shape)
    whole, _ = _rooms([name for name in wanted if out is None or name not in out], shape)
    if out is not None:
        _check_room(out, wanted, shape, [source.values for source in given.values()])
        whole |= {name: out[name] for name in wanted if name in out}
    results: dict[str, Array] = {name: whole[name].reshape(count) for name in wanted}
    if not wanted:
        return {}
    workers = _workers(count, threads, SHARED_TILE)
    tile = TILE if workers == 1 else SHARED_TILE
    _shared_out(lambda *span: _Worker(given, results, tile, sign).solve(*span), count, workers)
    return {name: whole[name] for name in wanted}


def _shared_out(work: Callable[[int, int], None], count: int, workers: int) -> None:
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


def _rooms(
    names: Sequence[str], shape: tuple[int, ...]
) -> tuple[dict[str, Array], NDArray[np.int64]]:
    """Arrays for results, and where they begin."""
    count = math.prod(shape)
    many = max(1, TOGETHER // max(1, 8 * count))
    rooms: dict[str, Array] = {}
    where = np.empty(len(names), np.int64)
    for at in range(0, len(names), many):
        some = names[at : at + many]
        together = _memory(len(some) * count).reshape(len(some), *shape)
        rows = together if shape else [together[i, ...] for i in range(len(some))]
        rooms.update(zip(some, rows, strict=True))
        where[at : at + many] = together.ctypes.data + 8 * count * np.arange(len(some))
    if "STATUS" in rooms:
        rooms["STATUS"] = np.empty(shape, np.uint16)
        where[names.index("STATUS")] = rooms["STATUS"].ctypes.data
    return rooms, where


def _check_room(
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


def solve_plain(
    values: tuple[Any, ...],
    wanted: tuple[str, ...],
    threads: int | None,
    out: Mapping[str, Array] | None,
) -> dict[str, Array] | None:
    """The results of plain columns, all of one kind, by one call of the compiled machine a thread,
    so that hardly anything is done column by column: `bounds` and root finders make many short
    calls. None where the columns have to be looked at."""
    arrays: dict[str, Array] = {}
    fixed: dict[str, float] = {}
    shape: tuple[int, ...] = ()
    for name, value in zip(SCENE, values, strict=True):
        if type(value) is np.ndarray:
            if value.shape != shape and arrays:
                return None
            shape, arrays[name] = value.shape, value
        elif type(value) in PLAIN:
            fixed[name] = value
        else:
            return None
    count = math.prod(shape)
    if count < 2:
        return None
    if count <= FEW:
        try:
            flat = [array.reshape(-1) for array in arrays.values()]
            together = np.concatenate(flat, dtype=np.float64, casting="same_kind")
        except TypeError:  # no numbers
            return None
        where = together.ctypes.data + count * _ROWS[: len(arrays)]
    elif all(x.dtype == np.float64 and x.flags.c_contiguous for x in arrays.values()):
        where = addresses(arrays.values())
    else:
        return None
    least, most = extremes(where, min(count, FEW))
    kinds = ordinary_kinds(dict(zip(arrays, zip(least, most, strict=True), strict=True)), fixed)
    if kinds is None:
        return None
    fixed.update(zip(arrays, least, strict=True))
    program = program_for(kinds, wanted)
    place = dict(zip(arrays, where.tolist(), strict=True))
    read = np.array([place[name] for name in program.columns], np.int64)
    if out is None:
        by_name, into = _rooms(wanted, shape)
    else:
        by_name, into = _rooms([name for name in wanted if name not in out], shape)
        _check_room(out, wanted, shape, list(arrays.values()))
        by_name |= out
        into = addresses(by_name[name] for name in wanted)
        by_name = {name: by_name[name] for name in wanted}
    if count <= FEW:  # all have been looked at
        program.run(read, into, count, CIRCLE, fixed)
        return by_name
    kind = dict(zip(SCENE, kinds, strict=True))
    looked_at = [i for i, name in enumerate(arrays) if kind[name] != "unused"]
    checked = where[looked_at]
    limits = np.array(
        [
            ORDINARY[name] if kind[name] == "array" else (least[i], most[i])
            for i, name in enumerate(arrays)
            if i in looked_at
        ]
    )
    widths = program.width[len(read) :]
    short: list[int] = []

    def part(start: int, stop: int) -> None:
        at, to = read + 8 * start, into + widths * start
        done = program.run(at, to, stop - start, CIRCLE, fixed, checked + 8 * start, limits)
        if done < stop - start:
            short.append(start)

    _shared_out(part, count, _workers(count, threads, WORTH_A_THREAD))
    return None if short else by_name


def share_typed(columns: Mapping[str, Any], share: Any) -> Array:
    """MU, as line 280 would hold it, of scenes (columns without MU) for a share of the critical
    friction (`closedform.share`); NaN where no friction ends the sliding."""
    critical = quantities({**columns, "MU": PIVOT}, ("MUC", "PN", "gt"))
    with np.errstate(invalid="ignore"):
        signed = np.where(critical["PN"] > 0, np.asarray(share) * critical["MUC"], np.nan)
        return np.asarray(np.where(critical["gt"] > 0, -signed, signed) + 0.0)


def _with_shares_typed(columns: Mapping[str, Any]) -> Mapping[str, Any]:
    """Columns whose MU is a share of the critical friction, or has cells that are."""
    cells = np.asarray(columns["MU"], object)
    shares = np.array([share_of(cell) for cell in cells.ravel()], np.float64).reshape(cells.shape)
    is_share = ~np.isnan(shares)
    if not is_share.any():
        return columns
    plain = in_doubles("MU", np.where(is_share, 0.0, cells))
    others = {name: value for name, value in columns.items() if name != "MU"}
    return {**others, "MU": np.where(is_share, share_typed(others, shares), plain)}


def quantities(
    columns: Mapping[str, object], names: Sequence[str], sign: float | None = None
) -> dict[str, Array]:
    """Results and other quantities of `closedform.impact.Impact`, such as ``gt`` and
    ``determinant``, by their names there; otherwise as `solve`, on one thread.

    ``sign``: +1 to keep MU's sign in all scenes, -1 to change it, instead of line 400's rule.
    """
    return _solved(columns, tuple(names), 1, sign)


def _wanted(outputs: Sequence[str] | str | None) -> tuple[str, ...]:
    if outputs is None:
        return ALL
    names = outputs.replace(",", " ").split() if isinstance(outputs, str) else outputs
    return _known(tuple(names))


@lru_cache(maxsize=256)
def _known(names: tuple[str, ...]) -> tuple[str, ...]:
    """The names, each once. Raises UserError for one that is not a result."""
    for name in names:
        if name not in RESULTS:
            raise UserError(f"{name!r} is not a result name; expected some of {' '.join(RESULTS)}")
    return tuple(dict.fromkeys(names))


def _workers(count: int, threads: int | None, share: int) -> int:
    """How many threads, each with at least ``share`` scenes to do."""
    return max(1, min(threads or processors(), count // share))


class _Worker:
    """Solves scenes block by block, with working arrays of its own."""

    def __init__(
        self,
        given: Mapping[str, Source],
        results: Mapping[str, Array],
        tile: int,
        sign: float | None = None,
    ) -> None:
        count = len(next(iter(results.values())))
        self.tile = min(tile, count)
        self.size = min(2 * tile, count)
        self.sign = sign
        self.given = given
        self.results = results
        self.buffers = Buffers(self.size)

    @np.errstate(all="ignore")
    def solve(self, start: int, stop: int) -> None:
        for at in range(start, stop, self.size or 1):
            self.solve_block(at, min(at + self.size, stop))

    def solve_block(self, start: int, end: int) -> None:
        block = self.block_of(start, end)
        results = {name: array[start:end] for name, array in self.results.items()}
        if native.library is None:
            self.run_plan(block, results)
        else:
            self.run_program(block, results, end - start)
        if block.refused is not None:
            for name, result in results.items():
                result[block.refused] = Status.NOT_FINITE if name == "STATUS" else np.nan

    def block_of(self, start: int, end: int) -> Block:
        columns = {
            name: self.buffers.block(name, source, start, end)
            for name, source in self.given.items()
        }
        return examine(columns)

    def run_program(self, block: Block, results: Mapping[str, Array], count: int) -> None:
        """By the compiled machine."""
        program = program_for(block.kinds, tuple(results), self.sign)
        fixed = {name: float(values[0]) for name, values in block.fixed.items()}
        columns = addresses(block.varying[name] for name in program.columns)
        program.run(columns, addresses(results.values()), count, CIRCLE, fixed)

    def run_plan(self, block: Block, results: Mapping[str, Array]) -> None:
        """By numpy, a tile at a time."""
        plan = plan_for(block.kinds, tuple(results), self.sign)
        fixed = {name: float(values[0]) for name, values in block.fixed.items()}
        columns = [block.varying[name] for name in plan.program.columns]
        plan.run(columns, results, fixed, self.tile)
        for name, result in results.items():
            if name != "STATUS" and not np.isfinite(result.sum()):
                # NaN by one set of bits; COND alone may be infinite
                result[np.isnan(result) if name == "COND" else ~np.isfinite(result)] = np.nan
