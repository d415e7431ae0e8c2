"""What skipping saves: every short path and some selections of results, timed side by side; how the
closed form compares with its floor (sines and cosines), grows with the number of scenes, and what
reading and writing files costs beside it.

All on one thread, in processor time: these are comparisons of work, and other programs' turns on
the machine are no part of it. Every function gives rows: dicts of numbers and names.
"""

from __future__ import annotations

import csv
import os
import tempfile
import time
import tracemalloc
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from ..accuracy.elimination import ORDER
from ..closedform.columns import Buffers, examine, sources
from ..closedform.degrees import sine_and_cosine
from ..closedform.fused import plan_for
from ..closedform.solve import TILE, solve
from ..names import RESULTS, SCENE
from ..tables import arrow
from .measure import enlarged, medians
from .populations import BENCHMARK, Columns, scenes

Row = dict[str, Any]

GENERAL = "general"
CALLS = 200
"""Calls with one scene that are timed together."""
SEED = 1988

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


def moving() -> Columns:
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


def kinds(count: int, repeats: int) -> list[Row]:
    """All kinds of blocks on ``count`` scenes: passes, nanoseconds a scene with scalars and with
    full columns of one value, and what of the general path's time both save."""
    general = enlarged(moving(), count)
    by_scalars: list[dict[str, Any]] = [{**general, **same} for same in PATHS.values()]
    by_columns = [
        {**general, **{name: np.full(count, float(value)) for name, value in same.items()}}
        for same in PATHS.values()
    ]
    times = _nanoseconds([_solving(k, ORDER) for k in (*by_scalars, *by_columns)], count, repeats)
    return [
        {
            "name": name,
            "passes": passes(kind, ORDER),
            "nanoseconds": scalar,
            "saved": 1 - scalar / times[0],
            "as_columns": full,
            "saved_as_columns": 1 - full / times[0],
        }
        for name, kind, scalar, full in zip(
            PATHS, by_scalars, times[: len(PATHS)], times[len(PATHS) :], strict=True
        )
    ]


def selections(count: int, repeats: int) -> list[Row]:
    """The same for selections of results; what is saved is of the time for all of them."""
    general = enlarged(moving(), count)
    works = [_solving(general, outputs) for outputs in SELECTIONS.values()]
    times = _nanoseconds(works, count, repeats)
    return [
        {
            "name": name,
            "passes": passes(general, outputs),
            "nanoseconds": taken,
            "saved": 1 - taken / times[-1],
        }
        for (name, outputs), taken in zip(SELECTIONS.items(), times, strict=True)
    ]


def floor(count: int, repeats: int) -> list[Row]:
    """Nanoseconds of the six velocities, against the sines and cosines of three angles that they
    cannot do without; and of a call with one scene, as plain numbers and as arrays of one."""
    general = enlarged(moving(), count)
    angle = general["TA"][:TILE]
    sine, cosine, *work = (np.empty(TILE) for _ in range(6))
    many = range(3 * (count // TILE))

    def numpy_sines() -> None:
        for _ in many:
            np.sin(angle, out=sine)
            np.cos(angle, out=cosine)

    def own_sines() -> None:
        for _ in many:
            sine_and_cosine(angle, sine, cosine, (work[0], work[1], work[2], work[3]))

    lone = {name: float(values[0]) for name, values in general.items()}
    one = _solving(lone, ORDER)
    arrays = _solving({name: np.array([value]) for name, value in lone.items()}, ORDER)
    works = {
        "six velocities": (_solving(general, ORDER), count),
        "six sines and cosines by numpy": (numpy_sines, count),
        "the same by closedform.degrees": (own_sines, count),
        "a call with one scene, plain numbers": (lambda: [one() for _ in range(CALLS)], CALLS),
        "the same as arrays of one": (lambda: [arrays() for _ in range(CALLS)], CALLS),
    }
    times = medians([work for work, _ in works.values()], repeats)
    return [
        {"name": name, "nanoseconds": 1e9 * taken / size}
        for (name, (_, size)), taken in zip(works.items(), times, strict=True)
    ]


def sizes(counts: Sequence[int], repeats: int) -> list[Row]:
    """The six velocities for growing numbers of scenes: seconds, nanoseconds a scene, the same into
    arrays given again and again (``out``), and MiB allocated beside the results."""
    rows = []
    base = moving()
    for count in counts:
        columns = enlarged(base, count)
        room = {name: np.zeros(count) for name in ORDER}
        into = partial(solve, columns, out=room, threads=1)
        works = (_solving(columns, ORDER), into)
        fresh, again = medians(works, repeats if count < 5_000_000 else 1)
        del room, works, into
        tracemalloc.start()
        solve(columns, ORDER, threads=1)
        extra = tracemalloc.get_traced_memory()[1] - 6 * 8 * count
        tracemalloc.stop()
        rows.append(
            {
                "scenes": count,
                "seconds": fresh,
                "nanoseconds": 1e9 * fresh / count,
                "nanoseconds_out": 1e9 * again / count,
                "extra_mib": extra / 2**20,
            }
        )
        del columns
    return rows


def doors(count: int, solve_file: Callable[[str, str], object]) -> list[Row]:
    """``count`` scenes with every result, in memory and by ``solve_file(from, to)``: seconds of
    wall and of processor time, and how many times the computation alone."""
    columns = {
        name: np.broadcast_to(np.asarray(column, float), (count,))
        for name, column in scenes(BENCHMARK[0], count, SEED).items()
    }
    with tempfile.TemporaryDirectory() as folder:
        path = {
            name: os.path.join(folder, name)
            for name in ("t.csv", "o.csv", "t.parquet", "o.parquet")
        }
        with open(path["t.csv"], "w", encoding="utf-8", newline="") as file:
            rows = csv.writer(file, lineterminator="\n")
            rows.writerow(SCENE)
            rows.writerows(zip(*(columns[name].tolist() for name in SCENE), strict=True))
        parser = "pyarrow" if arrow.available() else "csv of the standard library"
        works: dict[str, Callable[[], object]] = {
            "computation alone": lambda: solve(columns),
            f"CSV to CSV ({parser})": lambda: solve_file(path["t.csv"], path["o.csv"]),
        }
        if arrow.available():
            solve_file(path["t.csv"], path["t.parquet"])
            works["Parquet to Parquet"] = lambda: solve_file(path["t.parquet"], path["o.parquet"])
        found: list[Row] = []
        for name, work in works.items():
            wall, processor = time.perf_counter(), time.process_time()
            work()
            wall, processor = time.perf_counter() - wall, time.process_time() - processor
            alone = found[0]["processor"] if found else processor
            times = {"seconds": wall, "processor": processor, "times": processor / alone}
            found.append({"name": name, **times})
    return found


def _solving(columns: Any, outputs: Sequence[str]) -> Callable[[], object]:
    return lambda: solve(columns, outputs, threads=1)


def _nanoseconds(works: Sequence[Callable[[], object]], count: int, repeats: int) -> list[float]:
    return [1e9 * taken / count for taken in medians(works, repeats)]
