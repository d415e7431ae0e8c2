"""Many scenes: sorted into kinds, cut into blocks that stay in cache, and computed."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from .. import native
from ..native.program import addresses
from ..processors import processors
from . import compiled, statements
from .realcolumns import Scenes
from .reals import Floats, Reals, compare, from_floats
from .result import OTHER_M, Replay
from .unit import NEVER, Bools, Ints, Unit, stamp

BLOCK = 8192
"""Scenes computed at a time by one thread: fewer make numpy's calls dear, more fall out of the
cache."""
SHARED_BLOCK = 16384
"""The same when threads share the work: a thread holds the interpreter between numpy's calls, so
the calls should be long."""
WORTH_COMPILING = 2048
"""Scenes from which the compiled machine is asked: noting a program takes 20 milliseconds, as long
as numpy needs for 2000 scenes."""
WORTH_SHARING = 32768
"""Scenes from which it pays to note a program for just these columns, which computes once what the
scenes share."""
WORTH_A_THREAD = 8192
"""Fewer scenes are not shared out: threads would wait for each other more than they compute."""


def replay_scenes(scenes: Scenes, threads: int | None = None, block: int | None = None) -> Replay:
    """Replay scenes that have been read. ``threads``: None for as many as there are processors, as
    long as each has enough to do. ``block``: how many scenes at a time, at most."""
    unit = Unit(scenes.size)
    unit.first[...] = scenes.first
    M = scenes.values["M"]
    six = np.broadcast_to(M == 6, scenes.size)
    known = np.broadcast_to((M == 4) | (M == 6), scenes.size)
    pivot = compare(from_floats(scenes.values["MU"], None, True), statements.MINUS_10) == 0
    pivot = np.broadcast_to(pivot, scenes.size)
    unit.at(350)
    unit.record(~known, OTHER_M)
    values = {name: np.zeros(scenes.size) for name in statements.ASSIGNED}
    useful = max(1, scenes.size // WORTH_A_THREAD)
    threads = min(threads if threads is not None else processors(), useful)
    if block is None:
        block = BLOCK if threads == 1 else SHARED_BLOCK
    block = max(1, min(block, -(-scenes.size // threads)))

    def compute(one_block: Callable[..., None], left: Bools) -> None:
        """Compute the scenes that are ``left``, block by block."""
        jobs = _blocks(left, six, pivot, block)
        if threads > 1 and len(jobs) > 1:
            from concurrent.futures import ThreadPoolExecutor  # imports logging

            with ThreadPoolExecutor(threads) as pool:
                for _ in pool.map(lambda job: one_block(scenes, *job, unit, values), jobs):
                    pass
        else:
            for job in jobs:
                one_block(scenes, *job, unit, values)

    left = np.array(known)
    if native.library is not None and scenes.size >= WORTH_COMPILING:
        compute(partial(_compute_compiled, left), left.copy())
    compute(_compute, left)
    return Replay(scenes, six, unit, values)


def _blocks(
    known: Bools, six: Bools, pivot: Bools, block: int
) -> list[tuple[Ints | slice, statements.Kind]]:
    """Which scenes go together, and their kind. A slice where they are neighbours."""
    result: list[tuple[Ints | slice, statements.Kind]] = []
    for M in (6, 4):
        for is_pivot in (False, True):
            kind = statements.Kind(M, is_pivot)
            kept = known & (six == (M == 6)) & (pivot == is_pivot)
            if kept.all():
                return [(slice(at, at + block), kind) for at in range(0, kept.size, block)]
            rows = np.flatnonzero(kept)
            result += [(rows[at : at + block], kind) for at in range(0, rows.size, block)]
    return result


def _compute_compiled(
    left: Bools,
    scenes: Scenes,
    rows: Ints | slice,
    kind: statements.Kind,
    unit: Unit,
    values: dict[str, Floats],
) -> None:
    """One block by the compiled machine. ``left`` keeps the scenes that it leaves to the arrays."""
    columns = {name: scenes.values[name] for name in compiled.NAMES}
    size = unit.first[rows].size
    if scenes.size < WORTH_SHARING:
        columns = {name: np.broadcast_to(v, scenes.size) for name, v in columns.items()}
    own = {name: np.ascontiguousarray(v[rows]) for name, v in columns.items() if v.size > 1}
    program = compiled.program(kind, frozenset(own), tuple(values))
    found = np.empty((len(program.results), size))
    program.prepared(
        addresses(own[name] for name in program.columns),
        addresses(found),
        size,
        program.room(),
        fixed={name: float(v[0]) for name, v in columns.items() if v.size == 1},
    )()
    *results, odd = found
    for name, column in zip(program.results[:-1], results, strict=True):
        values[name][rows] = column
    left[rows] = (odd != 0) | (unit.first[rows] != NEVER)


@np.errstate(all="ignore")
def _compute(
    scenes: Scenes,
    rows: Ints | slice,
    kind: statements.Kind,
    unit: Unit,
    values: dict[str, Floats],
) -> None:
    """One block, its results put where they belong."""
    first = unit.first[rows]
    own = Unit(first.size)
    own.first[...] = first
    scene = {
        name: from_floats(v[rows] if v.size > 1 else v, own, True)
        for name, v in scenes.values.items()
    }
    results = statements.run(own, scene, kind)
    # line 400 turns MU, and line 590 adds to KF, only in scenes that get there
    early = ~own.reached(stamp(400, 0))
    if early.any():
        results["MUP"] = _choose(early, scene["MU"], results["MUP"])
    early = ~own.reached(stamp(590, 0))
    if early.any():
        results["KF"] = _choose(early, results["KF580"], results["KF"])
    for name, column in values.items():
        if name in results:
            column[rows] = results[name].v
    unit.first[rows] = own.first


def _choose(condition: Bools, yes: Reals, no: Reals) -> Reals:
    return Reals(np.where(condition, yes.v, no.v), no.unit, no.low, no.high, True)
