"""impact88 selfcheck                              check this installation: pass or fail
impact88 selfcheck --json -o qualification.json

Replays what a real Apple II Plus did (the ROM's arithmetic, runs of the listing, programs, the
published runs) through port, replay and emulator, compares every result of solve with 30 digits,
and prints counts, hashes and versions: the record of an installation.

exit status: 0 everything is as captured; 1 something is not; 2 bad input"""

from __future__ import annotations

from . import options
from .output import print_json, progress


def declare(parser: options.Parser) -> None:
    """Add the arguments."""
    options.add_json(parser)
    options.add_output(parser)


def main(args: options.Args) -> int:
    """Check the installation."""
    from ..comparison import selfcheck

    results = []
    with progress("selfcheck") as meter:
        for check in selfcheck.checks():
            results.append(check)
            meter.update(len(results))
    record = selfcheck.record(results)
    if args.json:
        print_json("selfcheck", record, indent=2)
    else:
        print(selfcheck.as_text(results))
    return int(not record["passed"])
