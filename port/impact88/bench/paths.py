"""What skipping saves: every short path and some selections of results, timed side by side; and how
the closed form compares with its floor (sines and cosines) and grows with the number of scenes.

All on one thread, in processor time: these are comparisons of work, and other programs' turns on
the machine are no part of it.
"""

from __future__ import annotations

import statistics
import time
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..accuracy.elimination import ORDER
from ..closedform.columns import Buffers, examine, sources
from ..closedform.degrees import sine_and_cosine
from ..closedform.solve import TILE, plan_for, solve
from ..names import RESULTS
from .measure import enlarged
from .populations import Columns, scenes

GENERAL = "general"
CALLS = 200
"""Calls with one scene that are timed together."""

PATHS: dict[str, dict[str, float]] = {
    GENERAL: {},
    "no spin (WA = WB = 0)": {"WA": 0, "WB": 0},
    "no friction (MU = 0)": {"MU": 0},
    "surface along y (GA = 0)": {"GA": 0},
    "EM = 1 (no moment)": {"EM": 1},
    "EM = 0": {"EM": 0},
    "one arm 0 (DB = 0)": {"DB": 0},
    "both arms 0 (DA = DB = 0)": {"DA": 0, "DB": 0},
    "point mass (M = 4)": {"M": 4},
    "barrier (B infinite)": {"MB": np.inf, "IB": np.inf, "VX": 0, "VY": 0, "WB": 0},
    "pivot (MU = -10)": {"MU": -10},
    "same vehicles (masses, inertias)": {"MA": 100, "MB": 120, "IA": 2000, "IB": 3000},
    "same place (all angles and arms)": {
        **{"GA": 30, "PA": 10, "PB": 20, "TA": 5, "TB": 95},
        **{"DA": 4, "DB": 5},
    },
    "same scene, velocities vary": {
        **{"GA": 30, "PA": 10, "PB": 20, "TA": 5, "TB": 95, "DA": 4, "DB": 5},
        **{"MA": 100, "MB": 120, "IA": 2000, "IB": 3000, "E": 0.1, "MU": 0.5, "EM": -0.5},
    },
}
"""Kinds of blocks: the columns that are the same for all scenes, as scalars."""

SELECTIONS: dict[str, tuple[str, ...]] = {
    "six final velocities": tuple(ORDER),
    "four velocities (no spins)": tuple(ORDER[:4]),
    "velocities of A": ("VAX", "VAY", "WAF"),
    "impulse PN PT": ("PN", "PT"),
    "LOSS": ("LOSS",),
    "DVA DVB": ("DVA", "DVB"),
    "KI": ("KI",),
    "contact velocities before": ("XA", "YA", "XB", "YB"),
    "COND": ("COND",),
    "STATUS": ("STATUS",),
    "all": tuple(RESULTS),
}


@dataclass
class Path:
    """``passes`` over the scenes, ``nanoseconds`` a scene (median), on one core; ``as_columns``:
    the same with full columns that hold one value, found to be alike block by block."""

    name: str
    passes: int
    nanoseconds: float
    as_columns: float | None = None


def _moving() -> Columns:
    """Casework in which every vehicle spins: nothing to skip."""
    g = scenes("casework", 4096, 1)
    rng = np.random.default_rng(1)
    return {**g, "WA": rng.uniform(0.5, 2, 4096), "WB": rng.uniform(-2, -0.5, 4096)}


def passes(columns: Any, outputs: Sequence[str]) -> int:
    """The passes the plan for these columns makes."""
    given, shape = sources(columns)
    count = min(TILE, int(np.prod(shape, dtype=np.int64)))
    buffers = Buffers(count)
    block = examine({name: buffers.block(name, s, 0, count) for name, s in given.items()})
    return plan_for(block.kinds, tuple(outputs)).passes


def clock(work: Callable[[], object]) -> float:
    """Processor time in seconds."""
    start = time.process_time()
    work()
    return time.process_time() - start


def _rounds(works: Sequence[Callable[[], object]], repeats: int) -> list[float]:
    times: list[list[float]] = [[] for _ in works]
    for _ in range(repeats):
        for taken, work in zip(times, works, strict=True):
            taken.append(clock(work))
    return [statistics.median(taken) for taken in times]


def paths(count: int, repeats: int) -> tuple[list[Path], list[Path]]:
    """Time all kinds of blocks and selections on ``count`` scenes, one core."""
    general = enlarged(_moving(), count)
    kinds: list[dict[str, Any]] = [{**general, **same} for same in PATHS.values()]
    columns = [
        {**general, **{name: np.full(count, float(value)) for name, value in same.items()}}
        for same in PATHS.values()
    ]
    works = [_solving(k, ORDER) for k in (*kinds, *columns)]
    times = [1e9 * t / count for t in _rounds(works, repeats)]
    by_kind = [
        Path(name, passes(kind, ORDER), scalar, full)
        for name, kind, scalar, full in zip(
            PATHS, kinds, times[: len(kinds)], times[len(kinds) :], strict=True
        )
    ]
    works = [_solving(general, outputs) for outputs in SELECTIONS.values()]
    by_output = [
        Path(name, passes(general, outputs), 1e9 * t / count)
        for (name, outputs), t in zip(SELECTIONS.items(), _rounds(works, repeats), strict=True)
    ]
    return by_kind, by_output


def _solving(columns: Any, outputs: Sequence[str]) -> Callable[[], object]:
    return lambda: solve(columns, outputs, threads=1)


def _solving_into(columns: Any, room: dict[str, Any]) -> Callable[[], object]:
    return lambda: solve(columns, out=room, threads=1)


@dataclass
class Floor:
    """Nanoseconds a scene: the six velocities, and six sines and cosines of three angles alone, by
    numpy and by `closedform.degrees`; and a call of `solve` with one scene, as plain numbers and as
    arrays of one."""

    solve: float
    numpy_sines: float
    own_sines: float
    one_scene: float
    array_of_one: float


def floor(count: int, repeats: int) -> Floor:
    """Time the closed form against the sines and cosines it cannot do without, one core."""
    general = enlarged(_moving(), count)
    angle = general["TA"][:TILE]
    out = [np.empty(TILE) for _ in range(6)]
    tiles = range(count // TILE)

    def numpy_sines() -> None:
        for _ in tiles:
            for _ in range(3):
                np.sin(angle, out=out[0])
                np.cos(angle, out=out[1])

    def own_sines() -> None:
        for _ in tiles:
            for _ in range(3):
                sine_and_cosine(angle, out[0], out[1], (out[2], out[3], out[4], out[5]))

    times = _rounds([_solving(general, ORDER), numpy_sines, own_sines], repeats)
    lone = {name: float(values[0]) for name, values in general.items()}
    one = _solving(lone, ORDER)
    arrays = _solving({name: np.array([value]) for name, value in lone.items()}, ORDER)

    def calls(work: Callable[[], object]) -> Callable[[], object]:
        return lambda: [work() for _ in range(CALLS)]

    alone = _rounds([calls(one), calls(arrays)], repeats)
    return Floor(*(1e9 * t / count for t in times), *(1e9 * t / CALLS for t in alone))


@dataclass
class Size:
    """How the closed form grows: seconds for ``scenes``, the same into arrays given again and again
    (``out``), and bytes allocated beside the results."""

    scenes: int
    seconds: float
    seconds_out: float
    extra_bytes: int


def sizes(counts: Sequence[int], repeats: int) -> list[Size]:
    """Time the six velocities for growing numbers of scenes."""
    out = []
    base = _moving()
    for count in counts:
        columns = enlarged(base, count)
        room = {name: np.zeros(count) for name in ORDER}
        works = [_solving(columns, ORDER), _solving_into(columns, room)]
        seconds, seconds_out = _rounds(works, repeats if count < 5_000_000 else 1)
        del room, works
        tracemalloc.start()
        solve(columns, ORDER, threads=1)
        extra = tracemalloc.get_traced_memory()[1] - 6 * 8 * count
        tracemalloc.stop()
        out.append(Size(count, seconds, seconds_out, extra))
        del columns
    return out
