"""Tables from file to file, beside the computation alone: what the doors cost."""

from __future__ import annotations

import csv
import os
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..closedform.solve import solve
from ..names import SCENE
from ..tables import arrow
from .populations import BENCHMARK, scenes

SEED = 1988


@dataclass
class Door:
    """Seconds of wall and of processor time for a table with all results."""

    name: str
    seconds: float
    processor: float


def files(count: int, solve_file: Callable[[str, str], object]) -> list[Door]:
    """Time ``count`` scenes with every result: in memory, and by ``solve_file(from, to)``."""
    columns = {
        name: np.broadcast_to(np.asarray(column, float), (count,))
        for name, column in scenes(BENCHMARK[0], count, SEED).items()
    }
    doors = [_timed("computation alone", lambda: solve(columns))]
    with tempfile.TemporaryDirectory() as folder:
        table = os.path.join(folder, "t.csv")
        with open(table, "w", encoding="utf-8", newline="") as file:
            rows = csv.writer(file, lineterminator="\n")
            rows.writerow(SCENE)
            rows.writerows(zip(*(columns[name].tolist() for name in SCENE), strict=True))
        there = arrow.available()
        doors.append(
            _timed(
                f"CSV to CSV ({'pyarrow' if there else 'csv of the standard library'})",
                lambda: solve_file(table, os.path.join(folder, "o.csv")),
            )
        )
        if there:
            solve_file(table, os.path.join(folder, "t.parquet"))
            doors.append(
                _timed(
                    "Parquet to Parquet",
                    lambda: solve_file(
                        os.path.join(folder, "t.parquet"), os.path.join(folder, "o.parquet")
                    ),
                )
            )
    return doors


def _timed(name: str, work: Callable[[], object]) -> Door:
    wall, processor = time.perf_counter(), time.process_time()
    work()
    return Door(name, time.perf_counter() - wall, time.process_time() - processor)
