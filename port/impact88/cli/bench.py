"""impact88 bench                          errors and run times of five methods, two minutes
impact88 bench --quick                  fewer scenes, fewer repeats
impact88 bench -o FILE.md               into a file: times count on a quiet computer only
impact88 bench --json

The listing in double precision, its equations by LAPACK, the Apple's own arithmetic, and solve by
numpy and compiled, on cars like the chapter's and on cars that meet a heavy vehicle. Errors are
those of the final velocities against 50 digits (needs pip install 'impact88[oracle]')."""

from __future__ import annotations

from ..errors import library
from .options import JSON, OUTPUT, Args, flag
from .output import progress, show

QUICK_SCENES, QUICK_REPEATS, QUICK_EFFORT = 100, 3, 0.05
OPTIONS = (flag("--quick", "fewer scenes and repeats"), JSON, OUTPUT)


def main(args: Args) -> None:
    """Measure errors and run times."""
    library("mpmath", "oracle", "the reference")
    from ..bench import benchmark as bench

    where = bench.computer()
    scenes, repeats, effort = bench.ERROR_SCENES, bench.REPEATS, 1.0
    if args.quick:
        scenes, repeats, effort = QUICK_SCENES, QUICK_REPEATS, QUICK_EFFORT
    done, steps = 0, bench.count_steps(repeats)
    with progress("bench") as update:

        def step() -> None:
            nonlocal done
            done += 1
            update(done, done / steps)

        rows = bench.measure(step, scenes, repeats, effort)
    page = bench.markdown(rows, where)
    record = {"computer": where, "measurements": [row._asdict() for row in rows]}
    show(args.json, "bench", record, [page])
