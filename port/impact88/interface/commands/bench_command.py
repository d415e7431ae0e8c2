"""Run time against error, measured in one run on this machine: the Applesoft port, the replay over
arrays, the port in double precision, LAPACK on the 6x6 matrices, the closed form, the same in plain
C where a compiler is, and 50-digit arithmetic, which is also the reference. Needs pip install
'impact88[bench]', and for --figure impact88[plot].

populations:
{populations}

examples:
  impact88 bench                             the tables, about two minutes
  impact88 bench --quick                     one screen, some 15 seconds
  impact88 bench --figure work-precision.pdf --json -o bench.json

exit status: 0 done; 2 bad input
"""

import json

from ...bench import figure, measure, tables
from ...casework.figures.canvas import check_ending, save
from ...errors import library
from ...bench.populations import BENCHMARK, POPULATIONS
from ...messages.plaintable import plain
from ...messages.progress import progress
from . import options

__doc__ = (__doc__ or "").format(
    populations="\n".join(f"  {p.name:<14} {p.level:<8} {p.meaning}" for p in POPULATIONS.values())
)

QUICK = 0.05
"""The share of the scenes that --quick times; twice as many take twice as long."""
QUICK_POPULATIONS = ("casework", "heavy")
"""One that is easy, and one on which elimination loses its digits."""
# scenes of a population whose errors are taken: 50 digits take 5 ms each
ERROR_SCENES = 2000
QUICK_ERROR_SCENES = 300
REPEATS = 5
QUICK_REPEATS = 3

ARGUMENTS = (
    options.names_option(
        "--populations",
        f"default: {','.join(BENCHMARK)}; with --quick {','.join(QUICK_POPULATIONS)}",
    ),
    options.count(
        "--scenes",
        1,
        10**7,
        f"of each population ({ERROR_SCENES}; with --quick {QUICK_ERROR_SCENES})",
    ),
    options.seed("of the populations", 1988),
    options.count(
        "--repeats",
        1,
        1000,
        f"timing repeats; the median is reported ({REPEATS}; with --quick {QUICK_REPEATS})",
    ),
    options.flag("--quick", "one screen: fewer scenes, a twentieth of them timed"),
    options.flag("--json", "print JSON instead of tables"),
    options.OUTPUT,
    options.writes("--figure", "FILE", "draw error against time: .svg .png .pdf"),
)


def main(args: options.Args) -> None:
    if args.figure:
        check_ending(args.figure)
    library("mpmath", "bench", "the reference")
    machine = measure.machine()
    repeats = args.repeats or (QUICK_REPEATS if args.quick else REPEATS)
    scenes = args.scenes or (QUICK_ERROR_SCENES if args.quick else ERROR_SCENES)
    finite = [name for name in POPULATIONS if name != "barriers"]
    populations = options.names_given(args.populations, finite, "--populations", "population")
    populations = populations or list(QUICK_POPULATIONS if args.quick else BENCHMARK)
    with progress(measure.steps(populations, repeats), "bench") as meter:
        share = QUICK if args.quick else 1.0
        rows = measure.measure(populations, scenes, args.seed, repeats, meter.update, share)
    if args.figure:
        save(figure.work_precision(rows, machine["memory_roof"]), args.figure)
    if args.json:
        record = {"machine": machine, "seed": args.seed, "results": measure.as_json(rows)}
        print(json.dumps(plain(record), indent=1))
    else:
        text = tables.summary(rows) if args.quick else tables.results(rows)
        print("\n\n".join([tables.machine(machine), text, tables.ratios(rows)]))
