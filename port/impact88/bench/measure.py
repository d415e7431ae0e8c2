"""One run of the benchmark: every method on every population, errors and times together."""

import os
import platform
import statistics
import time
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import native
from ..accuracy.elimination import equilibrated_condition, fill
from ..accuracy.sensitivity import movements, sensitivity
from ..closedform.solve import solve
from ..names import SCENE
from ..processors import processors
from ..progress import Meter
from ..version import __version__
from .methods import (
    APPLESOFT,
    COMPONENTS,
    DOUBLE,
    METHODS,
    Method,
    Prepared,
    prepare,
    reference,
    relative_errors,
)
from .populations import POPULATIONS, Columns, scenes

Floats = NDArray[np.float64]

ROOF_SCENES = 1_000_000
"""Scenes whose columns are far too many for any cache."""


@dataclass
class Measured:
    """One method on one population.

    Relative errors of the final velocities over the scenes that have an answer; ``unanswered``
    counts those without (ZERO DETERMINANT, an Applesoft error). ``over_condition`` and
    ``over_sensitivity``: the largest error divided by the method's unit roundoff and the scene's
    condition number (equilibrated 6x6 matrix) or data sensitivity. ``seconds`` per scene.
    ``errors`` and ``conditions``: of each scene with an answer.
    """

    population: str
    method: str
    name: str
    scenes: int
    seconds: float
    timed: int
    unanswered: int = 0
    median: float = 0.0
    per_mille: float = 0.0
    largest: float = 0.0
    over_condition: float = 0.0
    over_sensitivity: float = 0.0
    errors: Floats = field(default_factory=lambda: np.empty(0), repr=False)
    conditions: Floats = field(default_factory=lambda: np.empty(0), repr=False)

    @property
    def per_second(self) -> float:
        return 1 / self.seconds


def machine() -> dict[str, Any]:
    """What the run ran on; ``load``: how many processes wanted a core in the minute before;
    ``memory_roof``: seconds a scene for reading its columns and writing six results."""

    name = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            names = [line.partition(":")[2].strip() for line in file if "model name" in line]
        name = names[0] if names else name
    except OSError:
        pass
    return {
        "processor": name,
        "instructions": native.accelerated,
        "cores": processors(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "impact88": __version__,
        "load": round(os.getloadavg()[0], 1) if hasattr(os, "getloadavg") else None,
        "memory_roof": memory_roof(),
    }


def memory_roof(repeats: int = 3) -> float:
    """Seconds a scene that memory alone takes: 20 columns read, six written."""
    columns = np.ones((len(SCENE) - 1, ROOF_SCENES))
    results = np.ones((6, ROOF_SCENES))

    def move() -> None:
        for column in columns:
            column.max()
        for result in results:
            result.fill(1.0)

    return min(medians([move], 1)[0] for _ in range(repeats)) / ROOF_SCENES


def medians(works: Sequence[Callable[[], object]], repeats: int) -> list[float]:
    """The median processor time of each work, in seconds; a round does every one once, so that all
    see the same machine."""
    times: list[list[float]] = [[] for _ in works]
    for _ in range(repeats):
        for taken, work in zip(times, works, strict=True):
            start = time.process_time()
            work()
            taken.append(time.process_time() - start)
    return [statistics.median(taken) for taken in times]


def enlarged(columns: Columns, count: int) -> Columns:
    """The scenes again and again until there are ``count``."""
    return {name: np.resize(values, count) for name, values in columns.items()}


def _work(method: Method, columns: Columns, count: int) -> Callable[[], float]:
    """What times a method on ``count`` scenes: processor time, which other programs do not
    lengthen; of several threads the clock's."""
    many = enlarged(columns, count)
    typed = method.roundoff == APPLESOFT or method.key == "float64"
    ready = method.ready(prepare(many) if typed else Prepared(count, many, {}))
    now = time.process_time if method.threads == 1 else time.perf_counter

    def work() -> float:
        with nullcontext() if method.compiled else native.switched_off():
            start = now()
            method.solve(ready)
            return now() - start

    return work


def measure(
    populations: Sequence[str],
    count: int,
    seed: int,
    repeats: int,
    meter: Meter,
    effort: float = 1.0,
) -> list[Measured]:
    """Measure all methods on ``populations``, ``count`` scenes of each. Times are medians of
    ``repeats`` rounds; a round times every method once, so that all see the same machine.
    ``effort``: the share of `Method.timed` scenes to time."""
    return [
        row
        for name in populations
        for row in _measure_population(name, count, seed, repeats, meter, effort)
    ]


def steps(populations: Sequence[str], repeats: int) -> int:
    """How often `measure` will tell its meter."""
    return len(populations) * (1 + len(METHODS) * (1 + repeats))


def _measure_population(
    name: str, count: int, seed: int, repeats: int, meter: Meter, effort: float
) -> list[Measured]:
    columns = scenes(name, count, seed)
    prepared = prepare(columns)
    start = time.process_time()
    hi, lo = reference(prepared)
    reference_seconds = (time.process_time() - start) / count
    meter.update(1)
    condition, sensitive = equilibrated_condition(fill(columns)[0]), sensitivity(columns)
    rows = {}
    works = {}
    for method in METHODS:
        if method.roundoff == APPLESOFT and not POPULATIONS[name].listing:
            continue
        error = relative_errors(method.velocities(prepared), hi, lo)
        fine = np.isfinite(error)
        told = error[fine]
        timed = max(10, round(effort * method.timed))
        works[method.key] = _work(method, columns, timed)
        rows[method.key] = Measured(
            *(name, method.key, method.name, count, 0.0, timed),
            unanswered=int(count - fine.sum()),
            median=float(np.median(told)),
            per_mille=float(np.quantile(told, 0.999)),
            largest=float(told.max()),
            over_condition=float((told / (condition[fine] * method.roundoff)).max()),
            over_sensitivity=float((told / (sensitive[fine] * method.roundoff)).max()),
            errors=told,
            conditions=condition[fine],
        )
        meter.update(1)
    times: dict[str, list[float]] = {key: [] for key in works}
    for _ in range(repeats):
        for key, work in works.items():
            times[key].append(work())
            meter.update(1)
    for key, row in rows.items():
        row.seconds = statistics.median(times[key]) / row.timed
    slow = Measured(name, "mpmath", "mpmath, 50 digits", count, reference_seconds, count)
    return [*rows.values(), slow]


def components(populations: Sequence[str], count: int, seed: int) -> list[dict[str, Any]]:
    """The closed form's errors result by result, each relative to itself, on ``count`` scenes of
    each population and on the same with EM = 0: the median, the largest, and the largest relative
    to what rounding every number of the scene to a double does (``over_rounding``)."""
    rows = []
    for name in populations:
        made = scenes(name, count, seed)
        for label, columns in ((name, made), (f"{name}, EM = 0", {**made, "EM": np.zeros(count)})):
            hi, lo = reference(prepare(columns), COMPONENTS)
            found = solve(columns, COMPONENTS)
            moved = movements(columns, COMPONENTS)
            for place, result in enumerate(COMPONENTS):
                true = hi[:, place]
                error = np.abs((found[result] - true) - lo[:, place])
                told = np.isfinite(error) & (true != 0)
                relative = error[told] / np.abs(true[told])
                over = error[told] / (DOUBLE * (moved[result] + np.abs(true))[told])
                summary = {
                    "median": np.median(relative) if told.any() else 0.0,
                    "largest": relative.max(initial=0.0),
                    "over_rounding": over.max(initial=0.0),
                }
                row = {key: float(value) for key, value in summary.items()}
                rows.append({"population": label, "result": result, **row})
    return rows


def as_json(rows: Sequence[Measured]) -> list[dict[str, Any]]:
    arrays = ("errors", "conditions")
    return [
        {
            **{key: value for key, value in vars(row).items() if key not in arrays},
            "scenes_per_second": row.per_second,
        }
        for row in rows
    ]
