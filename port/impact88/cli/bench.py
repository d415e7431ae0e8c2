"""impact88 bench                          errors and run times of five methods, two minutes
impact88 bench -o FILE.md               into a file: times count on a quiet computer only
impact88 bench --json

The listing in double precision, its equations by LAPACK, the Apple's own arithmetic, and solve by
numpy and compiled, on cars like the chapter's and on cars that meet a heavy vehicle. Errors are
those of the final velocities against 50 digits (needs pip install '.[oracle]' in the checkout)."""

from __future__ import annotations

from ..errors import library
from .options import JSON, OUTPUT, Args
from .output import show, show_progress

OPTIONS = (JSON, OUTPUT)


def main(args: Args) -> None:
    """Measure errors and run times."""
    library("mpmath", "oracle", "the reference")
    from ..bench import benchmark as bench

    computer = bench.computer()
    rows = bench.measure(show_progress)
    record = {"computer": computer, "measurements": [row._asdict() for row in rows]}
    show(args, "bench", record, [bench.markdown(rows, computer)])
