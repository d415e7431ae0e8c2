"""What skipping saves: every short path and some selections of results, timed side by side; how the
closed form grows with the number of scenes, from one; and what reading and writing files costs
beside it.

All on one thread, in processor time: these are comparisons of work, and other programs' turns on
the machine are no part of it. Every function gives rows: dicts of numbers and names.
"""

import csv
import os
import tempfile
import time
import tracemalloc
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..accuracy.elimination import ORDER
from ..closedform.columns import Buffers, examine, sources
from ..closedform.fused import plan_for
from ..closedform.solve import TILE, solve
from ..names import RESULTS, SCENE
from ..tables import arrow
from .measure import enlarged, medians
from .populations import BENCHMARK, Columns, scenes

Row = dict[str, Any]

GENERAL = "general"
AT_ONCE = 500
"""Scenes in calls that are timed together, where a call has fewer."""
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
    """The six velocities of all kinds of blocks of ``count`` scenes: passes, nanoseconds a scene,
    and what of the general path's time is saved."""
    general = enlarged(moving(), count)
    return _compared(
        {name: ({**general, **same}, tuple(ORDER)) for name, same in PATHS.items()}, count, repeats
    )


def selections(count: int, repeats: int) -> list[Row]:
    """The same of selections of results; what is saved is of the time for all of them."""
    general = enlarged(moving(), count)
    works = {name: (general, outputs) for name, outputs in reversed(SELECTIONS.items())}
    return _compared(works, count, repeats)


def _compared(works: dict[str, tuple[Any, tuple[str, ...]]], count: int, repeats: int) -> list[Row]:
    """What is saved is of the first one's time."""
    times = medians([_solving(*work) for work in works.values()], repeats)
    return [
        {
            "name": name,
            "passes": passes(*work),
            "nanoseconds": 1e9 * taken / count,
            "saved": 1 - taken / times[0],
        }
        for (name, work), taken in zip(works.items(), times, strict=True)
    ]


def sizes(counts: Sequence[int], repeats: int) -> list[Row]:
    """The six velocities for growing numbers of scenes: seconds a call, nanoseconds a scene, the
    same into arrays given again and again (``out``), and MiB allocated beside the results."""
    rows = []
    base = moving()
    for count in counts:
        columns: Any = enlarged(base, count)
        if count == 1:
            columns = {name: float(values[0]) for name, values in columns.items()}
        room = {name: np.zeros(np.shape(columns["MA"])) for name in ORDER}
        calls = range(max(1, AT_ONCE // count))
        works = (
            lambda columns=columns, calls=calls: [solve(columns, ORDER, threads=1) for _ in calls],
            lambda columns=columns, calls=calls, room=room: [
                solve(columns, out=room, threads=1) for _ in calls
            ],
        )
        times = medians(works, repeats if count < 5_000_000 else 1)
        fresh, again = (taken / len(calls) for taken in times)
        del room, works
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
