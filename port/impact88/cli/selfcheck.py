"""impact88 selfcheck                              check this installation: pass or fail
impact88 selfcheck --json -o qualification.json

Replays what a real Apple II Plus did (the ROM's arithmetic, runs of the listing, programs) through
port, replay and emulator, compares every result of solve with 30 digits, and prints counts, hashes
and versions: the record of an installation.

exit status: 0 everything is as captured; 1 something is not; 2 bad input"""

from __future__ import annotations

from .options import JSON, OUTPUT, Args
from .output import show

OPTIONS = (JSON, OUTPUT)


def main(args: Args) -> bool:
    """Check the installation."""
    from ..comparison import selfcheck

    results = list(selfcheck.checks())
    record = selfcheck.record(results)
    show(args, "selfcheck", record, [selfcheck.as_text(results)])
    return not record["passed"]
