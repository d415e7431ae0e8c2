"""impact88 bench                                        a table, about two minutes
impact88 bench --quick                                fewer scenes, some 15 seconds
impact88 bench --measurements measurements.md         the table as a page of the guide

Run time against error on this computer: the listing in double precision, its equations by LAPACK,
replay, and solve by numpy and compiled; errors are against 50 digits (extra oracle). Times are CPU
time. --measurements refuses a busy computer (load above 1)."""

from __future__ import annotations

from ..bench import benchmark
from . import options
from .output import print_json, progress, table

QUICK_EFFORT = 0.05  # fraction of the scenes that --quick times
QUICK_REPEATS = 3


def declare(parser: options.Parser) -> None:
    """Add the arguments."""
    parser.add_argument("--quick", action="store_true", help="fewer scenes and repeats")
    parser.add_argument(
        "--scenes",
        type=options.whole_number(1, 100_000),
        default=benchmark.ERROR_SCENES,
        metavar="N",
        help=f"scenes whose errors are taken (default: {benchmark.ERROR_SCENES})",
    )
    parser.add_argument(
        "--measurements", type=options.OutputPath, metavar="FILE", help="write a page of the guide"
    )
    options.add_json(parser)
    options.add_output(parser)


def main(args: options.Args) -> None:
    """Print the measurements."""
    where = benchmark.computer()
    if args.measurements:
        benchmark.check_quiet(where)
    repeats = QUICK_REPEATS if args.quick else benchmark.REPEATS
    effort = QUICK_EFFORT if args.quick else 1.0
    with progress(benchmark.count_steps(repeats), "bench") as meter:
        rows = benchmark.measure(meter.update, args.scenes, repeats, effort)
    if args.measurements:
        benchmark.write_measurements(args.measurements, benchmark.markdown(rows, where))
    if args.json:
        print_json("bench", {"computer": where, "measurements": [row._asdict() for row in rows]})
        return
    headings = ("scenes", "method", "ns a scene", "median error", "99 % below", "largest", "none")
    cells = [
        (
            m.population,
            m.method,
            f"{1e9 * m.seconds:,.0f}",
            f"{m.median:.1e}",
            f"{m.percentile_99:.1e}",
            f"{m.largest:.1e}",
            str(m.unanswered or ""),
        )
        for m in rows
    ]
    print("\n".join(table([headings, *cells], left=(0, 1))))
    print(", ".join(f"{key} {value}" for key, value in where.items()))
    print("errors: of the final velocities, in units of the scene's largest velocity or spin")
