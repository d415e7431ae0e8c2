"""How fast the array replay is, and what its parts cost.

    python tests/benchmarks/replay.py [--scenes 65536] [--rounds 7]

Scenes a second for reading the texts, computing and writing all printed fields; on one thread and
on two, against the scalar port on the same scenes in the same run. Then nanoseconds an element for
each primitive. Medians of several rounds, taken in turns; the best round beside them, because other
work on the machine only ever adds time.
"""

from __future__ import annotations

import argparse
import random
import statistics
import time
from collections.abc import Callable

import numpy as np

from impact88.names import SCENE
from impact88.program.run import run
from impact88.program.vectorized import polynomials, textcolumns
from impact88.program.vectorized.blocks import replay_scenes
from impact88.program.vectorized.realcolumns import read_columns
from impact88.program.vectorized.reals import Reals, compare, from_floats
from impact88.program.vectorized.unit import Unit

PORT_SCENES = 40


def scene(choose: random.Random) -> dict[str, str]:
    """A collision as casework has it, every value typed with up to three decimals."""

    def number(low: float, high: float) -> str:
        return f"{choose.uniform(low, high):.{choose.randint(0, 3)}f}"

    return {
        **{"E": number(0, 1), "MU": number(0.2, 1.2), "EM": number(-1, 0), "M": "6"},
        **{name: number(1, 9) for name in ("DA", "DB")},
        **{name: number(-180, 180) for name in ("GA", "PA", "PB", "TA", "TB")},
        **{name: number(50, 400) for name in ("MA", "MB")},
        **{name: number(800, 9000) for name in ("IA", "IB")},
        **{name: number(-90, 90) for name in ("UX", "UY", "VX", "VY")},
        **{name: number(-5, 5) for name in ("WA", "WB")},
    }


def rounds(count: int, works: dict[str, Callable[[], object]]) -> dict[str, list[float]]:
    """Seconds each work took, once a round, in turns."""
    times: dict[str, list[float]] = {name: [] for name in works}
    for work in works.values():
        work()
    for _ in range(count):
        for name, work in works.items():
            start = time.perf_counter()
            work()
            times[name].append(time.perf_counter() - start)
    return times


def primitives(size: int) -> dict[str, Callable[[], object]]:
    """Each primitive on arrays of numbers such as collisions have."""
    choose = np.random.default_rng(1988)
    unit = Unit(size)

    def numbers(stored: bool) -> Reals:
        v = choose.uniform(0.1, 100, size) * choose.choice((-1.0, 1.0), size)
        bits = v.view(np.int64)
        bits &= np.int64(-1 << (21 if stored else 13))
        return from_floats(v, unit, stored)

    left, right, flying = numbers(True), numbers(True), numbers(False)
    positive = abs(left)
    return {
        "round": flying.rounded,
        "add, right stored": lambda: left + right,
        "add": lambda: left + flying,
        "multiply": lambda: left * flying,
        "divide": lambda: left / right,
        "INT": lambda: flying.floor(),
        "compare": lambda: compare(left, flying),
        "SIN": lambda: polynomials.sin(left),
        "LOG": lambda: polynomials.log(positive),
        "EXP": lambda: polynomials.exp(left),
        "x ^ 2": lambda: polynomials.square(left),
        "write a field": lambda: textcolumns.write(flying),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--scenes", type=int, default=65536)
    parser.add_argument("--rounds", type=int, default=7)
    options = parser.parse_args()
    choose = random.Random(1988)
    made = [scene(choose) for _ in range(options.scenes)]
    columns = {name: [one[name] for one in made] for name in SCENE}
    hundred = {name: column[:100] for name, column in columns.items()}
    scenes = read_columns(columns)
    works: dict[str, Callable[[], object]] = {
        "the scalar port": lambda: [run(one) for one in made[:PORT_SCENES]],
        "read the texts": lambda: read_columns(columns),
        "compute, 1 thread": lambda: replay_scenes(scenes, 1),
        "compute, 2 threads": lambda: replay_scenes(scenes, 2),
        "write 36 fields": lambda: replay_scenes(scenes, 2).write_fields(),
        "100 scenes, read and computed": lambda: replay_scenes(read_columns(hundred)),
    }
    sizes = {"the scalar port": PORT_SCENES, "100 scenes, read and computed": 100}
    times = rounds(options.rounds, works)
    computing = statistics.median(times["compute, 2 threads"])
    times["write 36 fields"] = [t - computing for t in times["write 36 fields"]]
    port = statistics.median(times["the scalar port"]) / PORT_SCENES
    print(f"{options.scenes} scenes, {options.rounds} rounds\n")
    print(f"{'':32}{'scenes/s':>12}{'best':>12}{'x port':>9}")
    for name, seconds in times.items():
        count = sizes.get(name, options.scenes)
        median = statistics.median(seconds) / count
        best = min(seconds) / count
        print(f"{name:32}{1 / median:12,.0f}{1 / best:12,.0f}{port / median:9.0f}")
    size = 8192
    print(f"\nprimitives, arrays of {size}{'ns/element':>16}{'best':>8}")
    with np.errstate(all="ignore"):
        for name, seconds in rounds(10 * options.rounds, primitives(size)).items():
            median = statistics.median(seconds) / size * 1e9
            print(f"{name:28}{median:12.1f}{min(seconds) / size * 1e9:8.1f}")


if __name__ == "__main__":
    main()
