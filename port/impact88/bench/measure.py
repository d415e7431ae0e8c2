"""One run of the benchmark: every method on every population, errors and times together.

All by processor time, which other programs do not lengthen; of several threads by the clock's. Rows
are dicts of numbers and names.
"""

import os
import platform
import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanics import native
from ..mechanics.accuracy.errorbound import APPLESOFT, scales, sensitivity
from ..mechanics.closedform.columns import BLOCK
from ..mechanics.closedform.plan import Plan
from ..mechanics.closedform.solve import solve
from ..mechanics.native.expressiontable import ExpressionTable
from ..mechanics.native.processors import processors
from ..mechanics.native.schedule import Schedule
from ..names import FINAL_VELOCITIES, PIVOT, SCENE
from ..version import __version__
from . import plainc
from .methods import METHODS, Method, relative_errors
from .populations import POPULATIONS, repeat_scenes, scenes

Row = dict[str, Any]
Floats = NDArray[np.float64]
ROOF_SCENES = 1_000_000
"""Scenes whose columns are too many for any cache."""


def machine() -> Row:
    """Return what the run ran on; ``load``: average number of processes ready to run in the minute
    before."""
    name = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            name = next(line.partition(":")[2].strip() for line in file if "model name" in line)
    except (OSError, StopIteration):
        pass
    return {
        "processor": name,
        "instructions": native.accelerated,
        "cores": processors(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "impact88": __version__,
        "load": round(os.getloadavg()[0], 1) if hasattr(os, "getloadavg") else None,
        "plain_c": plainc.version() if plainc.available() else None,
        "plain_c_flags": list(plainc.FLAGS) if plainc.available() else None,
        "memory_roof": memory_roof(),
    }


def mover(columns: Mapping[str, Any], results: Mapping[str, Any]) -> Callable[[], object]:
    """Work that reads ``columns`` and writes ``results``, their sum in place of the mechanics: a
    loop in plain C, or, where no compiler is, as numpy does it."""
    if plainc.available():
        return partial(plainc.move, plainc.prepare(columns), results)
    table = ExpressionTable()
    first, *columns_left = (table.column(name, varies=True) for name in columns)
    program = Schedule(dict.fromkeys(results, sum(columns_left, first)), ["RESULT"] * len(results))
    read = [columns[name] for name in program.columns]
    return partial(Plan(program).run, read, results, {}, BLOCK)


def memory_roof() -> float:
    """Seconds a scene that memory alone takes: 20 columns read, six written."""
    columns = {name: np.ones(ROOF_SCENES) for name in SCENE if name != "M"}
    move = mover(columns, {name: np.zeros(ROOF_SCENES) for name in FINAL_VELOCITIES})
    return medians([move], 7)[0] / ROOF_SCENES


def medians(works: Sequence[Callable[[], object]], repeats: int, calls: int = 1) -> list[float]:
    """The median processor time of each work in ``calls`` calls, in seconds; a round does every
    one, so that all see the same machine."""
    times: list[list[float]] = [[] for _ in works]
    for _ in range(repeats):
        for durations, work in zip(times, works, strict=True):
            start = time.process_time()
            for _ in range(calls):
                work()
            durations.append(time.process_time() - start)
    return [statistics.median(durations) for durations in times]


def applies(method: Method, population: str, columns: Mapping[str, Any]) -> bool:
    """Return whether a method can be given these scenes, and is there."""
    if method.roundoff == APPLESOFT and not POPULATIONS[population].listing:
        return False
    return not method.plain or (plainc.available() and not (columns["MU"] == PIVOT).any())


def steps(populations: Sequence[str], repeats: int) -> int:
    """Return the number of times that `measure` reports progress."""
    return len(populations) * (1 + len(METHODS) * (1 + repeats))


def measure(
    populations: Sequence[str],
    count: int,
    seed: int,
    repeats: int,
    progress: Callable[[int], object],
    effort: float = 1.0,
) -> list[Row]:
    """All methods on ``populations``, ``count`` scenes of each. Times are medians of ``repeats``
    rounds, each method once a round; ``effort``: the share of `Method.timed` scenes to time.

    A row has the relative errors of the final velocities over the scenes with an answer;
    ``unanswered`` counts those without (ZERO DETERMINANT, an Applesoft error).
    ``over_sensitivity``: the largest divided by the method's unit roundoff and the scene's data
    sensitivity. ``over_condition``: the largest quotient of an error, by its scene's
    `errorbound.scales`, and COND, divided by the roundoff. ``seconds`` per scene; ``memory``, of
    the closed form: what `mover` takes of as many scenes, in the same rounds.
    """
    from ..mechanics.accuracy.reference import two_doubles

    rows: list[Row] = []
    for name in populations:
        columns = scenes(name, count, seed)
        start = time.process_time()
        hi, lo = two_doubles(columns)
        reference_seconds = (time.process_time() - start) / count
        progress(1)
        solutions, sensitive = solve(columns), sensitivity(columns)
        by_name = scales(columns, solutions)
        sizes = np.stack([by_name[result] for result in FINAL_VELOCITIES], axis=1)
        works: list[tuple[Method, Any, list[float]]] = []
        mine: list[Row] = []
        for method in METHODS:
            if not applies(method, name, columns):
                continue
            velocities = method.velocities(columns)
            errors = relative_errors(velocities, hi, lo)
            scaled_errors = relative_errors(velocities, hi, lo, sizes) / solutions["COND"]
            scenes_timed = max(10, round(effort * method.timed))
            works.append((method, method.prepare(repeat_scenes(columns, scenes_timed)), []))
            mine.append(
                {
                    "population": name,
                    "method": method.key,
                    "name": method.name,
                    "scenes": count,
                    "timed": scenes_timed,
                    **_error_fields(errors, scaled_errors, sensitive, method.roundoff),
                }
            )
            progress(1)
        inputs = next(prepared for method, prepared, _ in works if method.key == "closed-form")
        room = {result: np.zeros(len(inputs["MA"])) for result in FINAL_VELOCITIES}
        move = mover({key: inputs[key] for key in plainc.COLUMNS}, room)
        memory: list[float] = []
        for _ in range(repeats):
            memory += medians([move], 1)
            for method, prepared, times in works:
                now = time.process_time if method.threads == 1 else time.perf_counter
                start = now()
                method.run(prepared)
                times.append(now() - start)
                progress(1)
        for row, (_, _, times) in zip(mine, works, strict=True):
            row["seconds"] = statistics.median(times) / row["timed"]
            if row["method"] == "closed-form":
                row["memory"] = statistics.median(memory) / row["timed"]
        slow = {"population": name, "method": "mpmath", "name": "mpmath, 50 digits"}
        rows += [*mine, {**slow, "scenes": count, "timed": count, "seconds": reference_seconds}]
    return rows


def _error_fields(errors: Floats, scaled_errors: Floats, sensitive: Floats, roundoff: float) -> Row:
    """A row's fields on the errors of the scenes with an answer. ``scaled_errors``: over COND."""
    fine = np.isfinite(errors)
    return {
        "unanswered": int(errors.size - fine.sum()),
        "median": float(np.median(errors[fine])),
        "percentile_99": float(np.quantile(errors[fine], 0.99)),
        "largest": float(errors[fine].max()),
        "over_condition": float(scaled_errors[fine].max() / roundoff),
        "over_sensitivity": float((errors / sensitive)[fine].max() / roundoff),
    }


def as_json(rows: Sequence[Row]) -> list[Row]:
    return [row | {"scenes_per_second": 1 / row["seconds"]} for row in rows]
