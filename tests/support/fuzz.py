"""Hostile input to every command, for as long as wanted.

    python tests/support/fuzz.py                        a minute
    python tests/support/fuzz.py --seconds 36000        a night
    python tests/support/fuzz.py --cases 1000000 --seed 7 --keep found/
    python tests/support/fuzz.py --kinds npz csv --cases 5000
    python tests/support/fuzz.py --case found/npz-7-12.json

Every case is a function of kind and seed. What goes wrong is told, kept as a file if --keep names a
folder, and ends with status 1; a file that stays in tests/corpus/ is run with the tests for ever.
"""

from __future__ import annotations

import argparse
import os
import random
import resource
import sys
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from itertools import repeat
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from fuzzing.case import Case
from fuzzing.judge import faults
from fuzzing.kinds import KINDS, make

BATCH = 500
ADDRESSES = 6_000_000_000
"""Bytes of address space a worker may take: a case that wants more fails instead of the machine."""

Found = list[tuple[Case, list[str]]]


def batch(kinds: list[str], seed: int, number: int) -> tuple[Counter[str], Found]:
    """Cases of one batch: how many of each kind, and those that went wrong."""
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))
    rng = random.Random(f"{seed} {number}")
    weights = [KINDS[kind][1] for kind in kinds]
    if not any(weights):  # those the mixture leaves out
        weights = [1] * len(kinds)
    counts: Counter[str] = Counter()
    found: Found = []
    for index in range(BATCH):
        (kind,) = rng.choices(kinds, weights)
        case = make(kind, f"{seed}.{number}.{index}")
        wrong = faults(case)
        counts[kind] += 1
        if wrong:
            found.append((case, wrong))
    return counts, found


def main() -> int:
    """Run cases; 1 if any went wrong."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--cases", type=int)
    parser.add_argument("--seed", type=int, default=1988)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--keep", type=Path, metavar="FOLDER")
    parser.add_argument("--case", type=Path, nargs="+", default=[], metavar="FILE")
    args = parser.parse_args()
    for path in args.case:
        wrong = faults(Case.from_json(path.read_text("utf-8")))
        print(path, *(wrong or ["well"]), sep="\n  ")
    if args.case:
        return 0
    seconds = args.seconds or (None if args.cases else 60)
    counts, wrong = campaign(args.kinds, args.seed, args.cases, seconds, args.jobs, args.keep)
    told = ", ".join(f"{kind} {count:,}" for kind, count in counts.items())
    print(f"{counts.total():,} cases ({told}): {wrong} went wrong")
    return int(wrong > 0)


def campaign(
    kinds: list[str],
    seed: int,
    cases: int | None,
    seconds: float | None,
    jobs: int | None,
    keep: Path | None,
) -> tuple[Counter[str], int]:
    """Run batches until there are enough; each in a process that ends with it."""
    began, counts, wrong, number = time.monotonic(), Counter[str](), 0, 0
    seen: Counter[str] = Counter()
    with ProcessPoolExecutor(jobs, max_tasks_per_child=4) as pool:
        while (cases is None or counts.total() < cases) and (
            seconds is None or time.monotonic() - began < seconds
        ):
            numbers = range(number, number + (jobs or 1))
            number = numbers.stop
            for count, found in pool.map(batch, repeat(kinds), repeat(seed), numbers):
                counts += count
                if counts.total() % 20_000 == 0:
                    print(f"{counts.total():,} cases, {wrong} went wrong", file=sys.stderr)
                for case, faults_of_it in found:
                    wrong += 1
                    key = faults_of_it[0][-120:]
                    seen[key] += 1
                    if seen[key] > 3:
                        continue
                    print(
                        case.kind, case.seed, case.arguments, *faults_of_it, sep="\n  ", flush=True
                    )
                    if keep:
                        keep.mkdir(parents=True, exist_ok=True)
                        name = f"{case.kind}-{case.seed}.json"
                        (keep / name).write_text(case.to_json(), "utf-8")
    return counts, wrong


if __name__ == "__main__":
    sys.exit(main())
