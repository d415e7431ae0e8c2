"""One run of the benchmark: every method on every population, errors and times together."""

from __future__ import annotations

import os
import platform
import statistics
import time
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import native
from ..accuracy.elimination import equilibrated_condition, fill
from ..accuracy.sensitivity import sensitivity
from ..processors import processors
from ..progress import Meter
from ..version import __version__
from .methods import (
    APPLESOFT,
    METHODS,
    Method,
    Prepared,
    closed_form_columns,
    prepare,
    reference,
    relative_errors,
)
from .populations import POPULATIONS, Columns, scenes

Floats = NDArray[np.float64]


@dataclass
class Measured:
    """One method on one population.

    Relative errors of the final velocities over the scenes that have an answer; ``unanswered``
    counts those without (ZERO DETERMINANT, an Applesoft error). ``over_condition`` and
    ``over_sensitivity``: the largest error divided by the method's unit roundoff and the scene's
    condition number (equilibrated 6x6 matrix) or data sensitivity. ``seconds`` per scene.
    """

    population: str
    method: str
    name: str
    scenes: int
    unanswered: int
    median: float
    per_mille: float
    largest: float
    over_condition: float
    over_sensitivity: float
    seconds: float
    timed: int

    @property
    def per_second(self) -> float:
        return 1 / self.seconds


def machine() -> dict[str, Any]:
    """What the run ran on; ``load``: how many processes wanted a core in the minute before."""

    name = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            names = [line.partition(":")[2].strip() for line in file if "model name" in line]
        name = names[0] if names else name
    except OSError:
        pass
    return {
        "processor": name,
        "cores": processors(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "impact88": __version__,
        "load": round(os.getloadavg()[0], 1) if hasattr(os, "getloadavg") else None,
    }


def enlarged(columns: Columns, count: int) -> Columns:
    """The scenes again and again until there are ``count``."""
    return {name: np.resize(values, count) for name, values in columns.items()}


def _time(method: Method, work: Callable[[], object]) -> float:
    """Processor time, which other programs do not lengthen; of several threads the clock's."""
    now = time.process_time if method.threads == 1 else time.perf_counter
    with nullcontext() if method.compiled else native.switched_off():
        start = now()
        work()
        return now() - start


def _work(method: Method, prepared: Prepared) -> Callable[[], object]:
    if method.key.startswith("closed-form"):
        return lambda: closed_form_columns(prepared, method.threads)
    ready = method.ready(prepared)
    return lambda: method.solve(ready)


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
    reference_seconds = time.process_time()
    hi, lo = reference(prepared)
    reference_seconds = (time.process_time() - reference_seconds) / count
    meter.update(1)
    condition, sensitive = equilibrated_condition(fill(columns)[0]), sensitivity(columns)
    errors: dict[str, Floats] = {}
    works: dict[str, Callable[[], object]] = {}
    timed = {method.key: max(10, round(effort * method.timed)) for method in METHODS}
    for method in METHODS:
        if method.roundoff == APPLESOFT and not POPULATIONS[name].listing:
            continue
        errors[method.key] = relative_errors(method.solve(method.ready(prepared)), hi, lo)
        works[method.key] = _work(method, prepare_many(columns, method, timed[method.key]))
        meter.update(1)
    times: dict[str, list[float]] = {key: [] for key in works}
    by_key = {method.key: method for method in METHODS}
    for _ in range(repeats):
        for key, work in works.items():
            times[key].append(_time(by_key[key], work))
            meter.update(1)
    rows = []
    for method in METHODS:
        if method.key not in errors:
            continue
        error = errors[method.key]
        fine = np.isfinite(error)
        seconds = statistics.median(times[method.key]) / timed[method.key]
        told = error[fine]
        by_condition = told / (condition[fine] * method.roundoff)
        by_sensitivity = told / (sensitive[fine] * method.roundoff)
        rows.append(
            Measured(
                name,
                method.key,
                method.name,
                count,
                int(count - fine.sum()),
                float(np.median(told)),
                float(np.quantile(told, 0.999)),
                float(told.max()),
                float(by_condition.max()),
                float(by_sensitivity.max()),
                seconds,
                timed[method.key],
            )
        )
    nothing = (0, 0.0, 0.0, 0.0, 0.0, 0.0)
    slow = Measured(
        name, "mpmath", "mpmath, 50 digits", count, *nothing, seconds=reference_seconds, timed=count
    )
    return [*rows, slow]


def prepare_many(columns: Columns, method: Method, count: int) -> Prepared:
    """``count`` scenes for a method; texts only where they are read."""
    many = enlarged(columns, count)
    if method.roundoff == APPLESOFT or method.key == "float64":
        return prepare(many)
    return Prepared(count, many, {})


def as_json(rows: Sequence[Measured]) -> list[dict[str, Any]]:
    return [{**asdict(row), "scenes_per_second": row.per_second} for row in rows]
