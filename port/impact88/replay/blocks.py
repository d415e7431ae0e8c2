"""Many scenes: sorted into kinds, cut into blocks that stay in cache, and computed."""

from __future__ import annotations

import numpy as np

from . import impact
from .columns import Scenes
from .reals import Floats, Reals, compare, from_floats
from .result import OTHER_M, Replay
from .unit import Bools, Ints, Unit, stamp

BLOCK = 4096
"""Scenes computed at a time: the least time per scene on the machines tried."""


def replay_scenes(scenes: Scenes, threads: int | None = None, block: int = BLOCK) -> Replay:
    """Replay scenes that have been read."""
    unit = Unit(scenes.count)
    unit.first[...] = scenes.first
    M = scenes.values["M"]
    six = np.broadcast_to(M == 6, scenes.count)
    known = np.broadcast_to((M == 4) | (M == 6), scenes.count)
    pivot = compare(_shared(scenes.values["MU"]), impact.MINUS_10) == 0
    pivot = np.broadcast_to(pivot, scenes.count)
    unit.at(350)
    unit.record(~known, OTHER_M)
    values = {name: np.zeros(scenes.count) for name in impact.ASSIGNED}
    with np.errstate(all="ignore"):
        for rows, kind in _blocks(known, six, pivot, block):
            _compute(scenes, rows, kind, unit, values)
    return Replay(scenes, six, unit, values)


def _shared(v: Floats) -> Reals:
    return from_floats(v, None, True)


def _blocks(
    known: Bools, six: Bools, pivot: Bools, block: int
) -> list[tuple[Ints | slice, impact.Kind]]:
    """Which scenes go together, and their kind. A slice where they are neighbours."""
    result: list[tuple[Ints | slice, impact.Kind]] = []
    for M in (6, 4):
        for is_pivot in (False, True):
            kind = impact.Kind(M, is_pivot)
            here = known & (six == (M == 6)) & (pivot == is_pivot)
            if here.all():
                return [(slice(at, at + block), kind) for at in range(0, here.size, block)]
            rows = np.flatnonzero(here)
            result += [(rows[at : at + block], kind) for at in range(0, rows.size, block)]
    return result


def _compute(
    scenes: Scenes,
    rows: Ints | slice,
    kind: impact.Kind,
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
    results = impact.run(own, scene, kind)
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
