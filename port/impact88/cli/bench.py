"""impact88 bench                          errors and run times of five methods, two minutes
impact88 bench --quick                  fewer scenes, fewer repeats
impact88 bench --measurements FILE.md   the same as a page; on a quiet computer only
impact88 bench --json

The listing in double precision, its equations by LAPACK, the Apple's own arithmetic, and solve by
numpy and compiled, on cars like the chapter's and on cars that meet a heavy vehicle. Errors are
those of the final velocities against 50 digits (needs pip install 'impact88[oracle]')."""

from __future__ import annotations

from ..errors import library
from ..layout import table
from . import options
from .output import print_json, progress

QUICK_SCENES, QUICK_REPEATS, QUICK_EFFORT = 100, 3, 0.05


def declare(parser: options.Parser) -> None:
    """Add the arguments."""
    parser.add_argument("--quick", action="store_true", help="fewer scenes and repeats")
    parser.add_argument(
        "--scenes", type=options.whole_number(1, 10**6), metavar="N", help="scenes of a population"
    )
    parser.add_argument(
        "--measurements", type=options.OutputPath, metavar="FILE", help="write a Markdown page"
    )
    options.add_json(parser)
    options.add_output(parser)


def main(args: options.Args) -> None:
    """Measure errors and run times."""
    library("mpmath", "oracle", "the reference")
    from ..bench import benchmark as bench

    where = bench.computer()
    if args.measurements:
        bench.check_quiet(where)
    repeats, effort = (QUICK_REPEATS, QUICK_EFFORT) if args.quick else (bench.REPEATS, 1.0)
    scenes = args.scenes or (QUICK_SCENES if args.quick else bench.ERROR_SCENES)
    done, steps = 0, bench.count_steps(repeats)
    with progress("bench") as meter:

        def step() -> None:
            nonlocal done
            done += 1
            meter.update(done, done / steps)

        rows = bench.measure(step, scenes, repeats, effort)
    if args.measurements:
        bench.write_measurements(args.measurements, bench.markdown(rows, where))
    if args.json:
        print_json("bench", {"computer": where, "measurements": [row._asdict() for row in rows]})
        return
    print(", ".join(f"{key} {value}" for key, value in where.items()))
    heads = ["scenes", "method", "ns a scene", "median", "99 %", "largest", "no answer"]
    cells = [
        [row.population, row.method, f"{1e9 * row.seconds:,.0f}"]
        + [f"{x:.1e}" for x in (row.median, row.percentile_99, row.largest)]
        + [str(row.unanswered)]
        for row in rows
    ]
    print("\n".join(table([heads, *cells], left=(0, 1))))
    print("relative error of the final velocities; CPU time on one core")
