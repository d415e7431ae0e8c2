"""Run time against error: five ways to compute the same impacts, against 50 digits.

The listing in double precision, its 6x6 equations solved by LAPACK, the 1988 program's own
arithmetic (`replay`), and `solve` by numpy and compiled. Two populations: cars like the chapter's,
and cars that meet a vehicle 10 to 10^12 times as heavy, where elimination loses its digits.
"""

from __future__ import annotations

import os
import platform
import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import library
from ..decimals import to_text
from ..mechanics.reference import thirty_digits
from ..mechanics.solve import evaluate, solve
from ..names import FINAL_VELOCITIES
from ..program.replay import replay
from ..program.run import run
from ..program.scene import Scene
from ..version import __version__

Floats = NDArray[np.float64]
Columns = Mapping[str, Floats]

SEED = 1988
ERROR_SCENES = 300  # scenes of a population whose errors are taken: 50 digits take 2 ms each
REPEATS = 5  # timing repeats, of which the median is reported
LIMITS = """
E 0 .4, MU -1 1, EM -1 0, DA .5 9, DB .5 9, GA -90 90, PA -180 180, PB -180 180, TA -180 180,
TB -180 180, MA 60 200, MB 60 200, IA 900 5000, IB 900 5000, UX -90 90, UY -90 90, WA -2 2,
VX -90 90, VY -90 90, WB -2 2, M 6 6
"""
"""Ranges of cars like those of the chapter's Table 1, in ft, slug and s."""
SIGNIFICANT = 6  # digits of a scene's numbers, so that they are the same as texts and as doubles


def cars(rng: np.random.Generator, count: int) -> Columns:
    """Return scenes of cars like the chapter's."""
    columns = {}
    for entry in LIMITS.split(","):
        name, low, high = entry.split()
        columns[name] = round_columns(rng.uniform(float(low), float(high), count))
    return columns


def heavy(rng: np.random.Generator, count: int) -> Columns:
    """Return the same, with a B that is 10 to 10^12 times as heavy."""
    columns = dict(cars(rng, count))
    ratio = 10 ** rng.uniform(1, 12, count)
    for name in ("MB", "IB"):
        columns[name] = round_columns(columns[name] * ratio)
    return columns


def round_columns(values: Floats) -> Floats:
    """Return values of `SIGNIFICANT` digits."""
    return np.array([float(f"{value:.{SIGNIFICANT}g}") for value in values.tolist()])


POPULATIONS = {
    "cars": cars,
    "heavy B": heavy,
}


def texts(columns: Columns) -> dict[str, list[str]]:
    """Return scenes as typed."""
    return {name: list(map(to_text, column.tolist())) for name, column in columns.items()}


# --- the methods ---


def listing_in_double(scenes: Sequence[Scene]) -> Floats:
    """Return the final velocities by the port in double precision."""
    velocities = []
    for scene in scenes:
        record = run(scene, "float64")
        data = record.A["data"] if record.A and not record.error else [np.nan] * 6
        velocities.append(data[-6:])  # column M + 1 of A(6,7), first subscript fastest
    return np.array(velocities, float)


def typed_scenes(columns: Columns) -> list[Scene]:
    """Return scenes for the port."""
    rows = zip(*texts(columns).values(), strict=True)
    return [Scene(dict(zip(columns, row, strict=True))) for row in rows]


def replay_velocities(cells: Mapping[str, list[str]]) -> Floats:
    """Return the final velocities by `replay`."""
    results = replay(cells, threads=1)
    return np.column_stack([results.floats(name) for name in FINAL_VELOCITIES])


def lapack(columns: Columns) -> Floats:
    """Return the final velocities by LAPACK from the listing's equations, lines 300 to 560."""
    quantities = evaluate(columns, ("s", "c", "D1", "D2", "D3", "D4", "MUP"))[0].values()
    sine, cosine, d1, d2, d3, d4, mu = quantities
    names = ("MA", "MB", "IA", "IB", "EM", "UX", "UY", "WA", "VX", "VY", "WB")
    ma, mb, ia, ib, em, ux, uy, wa, vx, vy, wb = (columns[name] for name in names)
    o = np.zeros_like(ma)
    rows = (
        (ma, o, mb, o, o, o),
        (o, ma, o, mb, o, o),
        (o, ma * (cosine - mu * sine), mb * (sine + mu * cosine), o, o, o),
        (cosine, sine, -cosine, -sine, d3 * cosine - d4 * sine, d1 * cosine - d2 * sine),
        (o, ma * (d2 + d4), mb * (d1 + d3), o, ia, ib),
        (
            -em * ma * d3 / ia,
            em * ma * d4 / ia,
            -em * mb * d1 / ib,
            em * mb * d2 / ib,
            2 * em - 1,
            1 - 2 * em,
        ),
    )
    matrix = np.stack([np.stack(row, -1) for row in rows], -2)
    right = np.einsum("nij,nj->ni", matrix, np.column_stack((ux, uy, vx, vy, wa, wb)))
    right[:, 3] *= -columns["E"]
    right[:, 5] += (1 - em) * (wa - wb)
    solution: Floats = np.linalg.solve(matrix, right[:, :, None])[:, :, 0]
    return solution


def solve_velocities(columns: Columns) -> Floats:
    """Return the final velocities by `solve`."""
    return np.column_stack(list(solve(columns, FINAL_VELOCITIES, threads=1).values()))


class Method(NamedTuple):
    """A way to compute the final velocities: its name, how many scenes to time, the function, what
    it is given (made of columns, not timed), and whether the compiled library may be used."""

    name: str
    timed: int
    function: Callable[[Any], Floats]
    prepare: Callable[[Columns], Any] = dict
    is_compiled: bool = True

    def run(self, inputs: Any) -> Floats:
        """Return the final velocities."""
        with nullcontext() if self.is_compiled else library.switched_off():
            return self.function(inputs)


METHODS = (
    Method("listing in double precision", 200, listing_in_double, typed_scenes),
    Method("listing's equations by LAPACK", 100_000, lapack),
    Method("replay: the Apple's arithmetic", 20_000, replay_velocities, texts),
    Method("solve by numpy", 200_000, solve_velocities, is_compiled=False),
    Method("solve, compiled", 1_000_000, solve_velocities),
)


# --- measuring ---


class Measurement(NamedTuple):
    """One method on one population: seconds of CPU time a scene, and relative errors of the final
    velocities of the scenes with an answer, in units of the largest of a scene."""

    population: str
    method: str
    seconds: float
    median: float
    percentile_99: float
    largest: float
    unanswered: int


def measure(
    progress: Callable[[int, float], object],
    scenes: int = ERROR_SCENES,
    repeats: int = REPEATS,
    effort: float = 1.0,
) -> list[Measurement]:
    """Measure every method on every population.

    Parameters
    ----------
    progress : callable
        Called after each measurement with their number, and the fraction of all.
    scenes : int, default 300
        Scenes of a population whose errors are taken.
    repeats : int, default 5
        Timing repeats; the median is reported.
    effort : float, default 1
        Fraction of `Method.timed` scenes that is timed.

    Returns
    -------
    list of Measurement
        By population and method.
    """
    measurements = []
    for number, (population, make) in enumerate(POPULATIONS.items()):
        columns = make(np.random.default_rng([SEED, number]), scenes)
        exact = _reference(columns)
        for method in METHODS:
            errors = relative_errors(method.run(method.prepare(columns)), exact)
            finite = errors[np.isfinite(errors)]
            count = max(1, round(method.timed * effort))
            repetition = {name: np.resize(column, count) for name, column in columns.items()}
            inputs = method.prepare(repetition)
            seconds = []
            for _ in range(repeats):
                start = time.process_time()
                method.run(inputs)
                seconds.append((time.process_time() - start) / count)
            measurements.append(
                Measurement(
                    population,
                    method.name,
                    statistics.median(seconds),
                    float(np.median(finite)),
                    float(np.quantile(finite, 0.99)),
                    float(finite.max()),
                    len(errors) - len(finite),
                )
            )
            done = len(measurements)
            progress(done, done / (len(POPULATIONS) * len(METHODS)))
    return measurements


def _reference(columns: Columns) -> Floats:
    """Return the final velocities from 50 digits."""
    exact = map(thirty_digits, typed_scenes(columns))
    return np.array([[float(digits[name]) for name in FINAL_VELOCITIES] for digits in exact])


def relative_errors(velocities: Floats, exact: Floats) -> Floats:
    """Return the largest error of each scene, in units of its largest final velocity, or spin."""
    errors = np.abs(velocities - exact)
    linear = errors[:, :4].max(1) / np.abs(exact[:, :4]).max(1)
    angular = errors[:, 4:].max(1) / np.abs(exact[:, 4:]).max(1)
    larger: Floats = np.maximum(linear, angular)
    return larger


# --- the record ---


def computer() -> dict[str, Any]:
    """Return what the measurement ran on; ``load``: average number of running processes."""
    name = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            name = next(line.partition(":")[2].strip() for line in file if "model name" in line)
    except (OSError, StopIteration):
        pass
    return {
        "processor": name,
        "instructions": library.accelerated or "not compiled",
        "python": platform.python_version(),
        "numpy": np.__version__,
        "impact88": __version__,
        "load": round(os.getloadavg()[0], 1) if hasattr(os, "getloadavg") else 0.0,
    }


def markdown(measurements: Sequence[Measurement], where: Mapping[str, Any]) -> str:
    """Return the measurements as a page of the guide."""
    rows = [
        f"| {m.population} | {m.method} | {1e9 * m.seconds:,.0f} | {m.median:.1e} | "
        f"{m.percentile_99:.1e} | {m.largest:.1e} | {m.unanswered} |"
        for m in measurements
    ]
    circumstances = ", ".join(f"{key} {value}" for key, value in where.items())
    return "\n".join(
        (
            "# Measurements",
            "",
            f"Made by `impact88 bench` ({circumstances}).",
            "Times are CPU time on one core; errors are of the final velocities, against 50",
            "digits, in units of the scene's largest velocity or spin.",
            "",
            "| scenes | method | ns a scene | median error | 99 % below | largest | no answer |",
            "|---|---|---|---|---|---|---|",
            *rows,
            "",
        )
    )
