"""How fast the port is, and what ``impact88 run --sample 1`` costs as a process.

    python tests/benchmarks/port.py

Scenes a second on one core in plain Python, best and median of several rounds; the command against
a bare ``python -c pass``, taken in turns so that both see the same machine.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

import captures
from installed import COMMAND

from impact88.program.run import run
from impact88.program.scene import Scene

ROUNDS = 9
SCENES = 100
PROCESSES = 15


def port(arithmetic: str) -> list[float]:
    """Milliseconds a scene, one number a round."""
    scenes = [Scene(case["scene"]) for case in captures.scenes()[:SCENES]]
    run(scenes[0], arithmetic)
    times = []
    for _ in range(ROUNDS):
        start = time.process_time()
        for scene in scenes:
            run(scene, arithmetic)
        times.append((time.process_time() - start) / len(scenes) * 1e3)
    return times


def processes() -> dict[str, list[float]]:
    """Milliseconds of wall-clock time a process."""
    commands = {
        "python -c pass": [sys.executable, "-c", "pass"],
        "impact88 run --sample 1": [COMMAND, "run", "--sample", "1"],
    }
    times: dict[str, list[float]] = {name: [] for name in commands}
    for _ in range(PROCESSES):
        for name, command in commands.items():
            start = time.perf_counter()
            subprocess.run(command, stdout=subprocess.DEVNULL, check=True)
            times[name].append((time.perf_counter() - start) * 1e3)
    return times


def main() -> None:
    """Measure and print."""
    for arithmetic in ("applesoft", "float64"):
        times = port(arithmetic)
        best, median = min(times), statistics.median(times)
        print(
            f"port, {arithmetic:9}: {median:.2f} ms a scene (best {best:.2f}), "
            f"{1e3 / median:,.0f} scenes a second (best {1e3 / best:,.0f})"
        )
    medians = {name: statistics.median(times) for name, times in processes().items()}
    for name, median in medians.items():
        print(f"{name:24}: {median:.1f} ms")
    bare, whole = medians.values()
    print(f"ratio: {whole / bare:.2f}")


if __name__ == "__main__":
    main()
