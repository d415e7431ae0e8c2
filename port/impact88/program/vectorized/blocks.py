"""Many scenes: sorted into kinds, cut into blocks that stay in cache, and computed."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from ...mechanics import native
from ...mechanics.native.processors import shared_out, workers
from . import compiled, statements
from .realcolumns import Scenes
from .reals import Floats, compare, from_floats, select
from .result import OTHER_M, Replay
from .unit import NEVER, Bools, Ints, Unit, stamp

Computed = tuple[Mapping[str, Floats], Ints, Any]
"""Results by name, the record of failures (`Unit.first`), and which scenes are left (True)."""
BLOCK = 16384
"""Scenes computed at a time: fewer make numpy's calls dear, and threads hand the interpreter over
between these; more fall out of the cache. By the machine half as many take 5 % longer and twice as
many as long; by numpy half as many take 3 % less."""
WORTH_SHARING = 32768
"""Scenes from which it pays to note a program for just these columns, which computes once what the
scenes share: 14 ms, and where three columns vary it saves .4 us a scene. With twice as many it is
all the same to a call with 50,000; with half as many the first such call is slower."""
WORTH_A_THREAD = 8192
"""Fewer scenes are not shared out: threads would wait for each other more than they compute."""


def replay_scenes(scenes: Scenes, threads: int | None = None, block: int = BLOCK) -> Replay:
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
    unit.fails(~known, OTHER_M)
    values = {name: np.zeros(scenes.size) for name in statements.ASSIGNED}
    threads = workers(scenes.size, threads, WORTH_A_THREAD)
    block = max(1, min(block, -(-scenes.size // threads)))

    left = np.array(known)  # what has not been computed yet

    def compute(work: Callable[..., Computed]) -> None:
        """Compute what is left, block by block."""

        def some_blocks(start: int, stop: int) -> None:
            for rows, kind in jobs[start:stop]:
                columns = {name: v[rows] if v.size > 1 else v for name, v in scenes.values.items()}
                results, unit.first[rows], left[rows] = work(columns, unit.first[rows], kind)
                for name, column in results.items():
                    values[name][rows] = column

        jobs = _blocks(left, six, pivot, block)
        shared_out(some_blocks, len(jobs), max(1, min(threads, len(jobs))))

    if native.library is not None:
        compute(partial(_compiled, scenes.size >= WORTH_SHARING))
    compute(_by_arrays)
    return Replay(scenes, six, unit, values)


def _blocks(
    left: Bools, six: Bools, pivot: Bools, block: int
) -> list[tuple[Ints | slice, statements.Kind]]:
    """Which scenes go together, and their kind. A slice where they are neighbours."""
    result: list[tuple[Ints | slice, statements.Kind]] = []
    for M in (6, 4):
        for is_pivot in (False, True):
            kind = statements.Kind(M, is_pivot)
            kept = left & (six == (M == 6)) & (pivot == is_pivot)
            if kept.all():
                return [(slice(at, at + block), kind) for at in range(0, kept.size, block)]
            rows = np.flatnonzero(kept)
            result += [(rows[at : at + block], kind) for at in range(0, rows.size, block)]
    return result


def _compiled(
    sharing: bool, columns: dict[str, Floats], first: Ints, kind: statements.Kind
) -> Computed:
    """One block by the compiled machine; what it has marked is left."""
    if not sharing:
        columns = {name: np.broadcast_to(v, first.size) for name, v in columns.items()}
    varying = frozenset(name for name in compiled.NAMES if columns[name].size > 1)
    program = compiled.program(kind, varying)
    results, odd = compiled.computed(program, columns, first.size)
    return results, first, odd | (first != NEVER)


@np.errstate(all="ignore")
def _by_arrays(columns: dict[str, Floats], first: Ints, kind: statements.Kind) -> Computed:
    """One block by arrays; nothing is left."""
    own = Unit(first.size)
    own.first[...] = first
    scene = {name: from_floats(v, own, True) for name, v in columns.items()}
    results = statements.run(own, scene, kind)
    # line 400 turns MU, and line 590 adds to KF, only in scenes that get there
    for name, place, before in (
        ("MUP", stamp(400), scene["MU"]),
        ("KF", stamp(590), results.pop("KF580")),
    ):
        early = ~own.reached(place)
        if early.any():
            results[name] = select(early, before, results[name])
    return {name: x.v for name, x in results.items()}, own.first, False
