"""Check an installation: repeat the captures of a real Apple II Plus here, and count agreements."""

import gzip
import platform
import re
import sys
import time
from collections.abc import Callable, Iterator
from decimal import Decimal
from hashlib import sha256
from importlib import resources
from itertools import zip_longest
from typing import Any, NamedTuple

from ..apple import captured
from ..files import packaged_bytes
from ..names import FINAL_VELOCITIES, SCENE
from ..program.run import run
from ..program.scene import sample
from ..version import __version__

PUBLISHED_RUNS = {1: "run1", 2: "run2", 3: "table3"}
DISK_COMMAND = re.compile(r"^\x04.*\n", re.M)
Cases = Iterator[tuple[str, bool]]
"""Name of each case, and whether it is as captured."""


class Check(NamedTuple):
    """The result of one check: how many of the cases are ``right``, and the first that is not."""

    name: str
    compares: str
    total: int
    right: int
    seconds: float
    first_wrong: str

    @property
    def passed(self) -> bool:
        """True if there was a case and all were right."""
        return self.right == self.total > 0


def checks(folder: Any = None) -> Iterator[Check]:
    """Yield the result of each check as it ends.

    Parameters
    ----------
    folder : path, optional
        Captures laid out as golden/; by default the packaged ones.
    """
    golden = folder or captured.golden()
    for name, (compares, cases) in CHECKS.items():
        start = time.perf_counter()
        total, wrong = 0, []
        try:
            for case, is_right in cases(golden):
                total += 1
                wrong += [] if is_right else [case]
        except Exception as error:  # a check that breaks down is a check that fails
            total += 1
            wrong.append(f"broke down: {type(error).__name__}: {error}")
        seconds = time.perf_counter() - start
        yield Check(name, compares, total, total - len(wrong), seconds, next(iter(wrong), ""))


def record(results: list[Check]) -> dict[str, Any]:
    """Return the record of an installation: verdict, versions, hashes and checks.

    Parameters
    ----------
    results : list of Check
        What `checks` yielded.

    Returns
    -------
    dict
        An object for JSON.
    """
    return {
        "passed": all(check.passed for check in results),
        "versions": {
            "impact88": __version__,
            "python": f"{platform.python_implementation()} {platform.python_version()}",
            "numpy": getattr(sys.modules.get("numpy"), "__version__", "not installed"),
            "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        },
        "hashes": {
            "listing": sha256(packaged_bytes("impact88.legacy", "impact.bas")).hexdigest(),
            "captures": _hash_of_captures(),
        },
        "checks": [{**check._asdict(), "passed": check.passed} for check in results],
        "seconds": round(sum(check.seconds for check in results), 2),
    }


def _hash_of_captures() -> str:
    """Return the SHA-256 over all packaged captures, in the order of their names."""
    golden = resources.files("impact88.golden")
    digest = sha256()
    for name in ("scenes.jsonl.gz", "fuzz.jsonl.gz", "vectors.jsonl.gz"):
        digest.update(gzip.decompress(golden.joinpath(name).read_bytes()))
    for operation, calls in sorted(captured.calls(golden).items()):
        digest.update(f"{operation}{calls}".encode())
    return digest.hexdigest()


def as_text(results: list[Check]) -> str:
    """Return the record as lines of text."""
    lines = []
    for check in results:
        verdict = "pass" if check.passed else "FAIL"
        lines.append(
            f"{verdict}  {check.name:<14} {check.right:>6} of {check.total:>6} {check.compares}"
        )
        if not check.passed:
            lines.append(f"      first wrong: {check.first_wrong or 'nothing to compare'}")
    summary = record(results)
    for name, text in (summary["versions"] | summary["hashes"]).items():
        lines.append(f"{name:<10} {text}")
    lines.append(f"{'time':<10} {summary['seconds']} s")
    lines.append(f"{'result':<10} {'PASS' if summary['passed'] else 'FAIL'}")
    return "\n".join(lines)


def _arithmetic(golden: Any) -> Cases:
    for rows in captured.calls(golden).values():
        for row in rows:
            yield "\t".join(row), captured.call(*row[:4]) == captured.result(row[4])


def _port(golden: Any) -> Cases:
    for row in captured.rows(golden, captured.SCENES):
        listing_run = run(row["scene"], dos=False)
        variables = captured.memory_contents(listing_run.reals, listing_run.A)
        capture = captured.memory_contents(row["reals"], row["A"])
        yield row["id"], listing_run.printout == row["printout"] and variables == capture


def _replay(golden: Any) -> Cases:
    from ..program.replay import replay

    rows = captured.rows(golden, captured.SCENES)
    columns = {name: [row["scene"][name] for row in rows] for name in SCENE}
    results = replay(columns, pages=True)
    for row, page in zip(rows, results.pages or [], strict=True):
        # the captures were made without a disk system, where lines with control-D are printed
        yield row["id"], page == DISK_COMMAND.sub("", row["printout"])


def _emulator(golden: Any) -> Cases:
    for kind, name, texts in captured.programs(golden):
        blanks = kind == captured.PROGRAMS
        _, screen = captured.session(texts["bas"], texts.get("in", ""), blanks=blanks)
        yield name, screen == texts.get("out", "")


def _published_runs(golden: Any) -> Cases:
    for number, name in PUBLISHED_RUNS.items():
        capture = golden.joinpath("printouts", f"{name}.txt").read_bytes().decode()
        yield name, run(sample(number)).printout == capture


def _magazine(golden: Any) -> Cases:
    folder = golden.joinpath("printouts")
    program, table = (
        folder.joinpath(f"compute1980.{ending}").read_bytes().decode() for ending in ("bas", "txt")
    )
    _, screen = captured.session(program)
    pairs = zip_longest(table.split(), screen.split(), fillvalue="nan")
    for place, (capture, number) in enumerate(pairs, 1):
        # the magazine adds zeros before the point and at the end
        yield f"number {place} of Table 5", Decimal(capture) == Decimal(number)


def _solve(golden: Any) -> Cases:
    """Compare results with the vectors' 30 digits; where no program may answer, expect none."""
    import numpy as np

    from .agreement import reference
    from .kit import REFUSE

    vectors = captured.rows(golden, "vectors")
    scene = {n: np.array([float(vector["scene"][n]) for vector in vectors]) for n in SCENE}
    ours = reference(scene)
    for row, vector in enumerate(vectors):
        is_refused = vector["expect"] == REFUSE
        names = (
            FINAL_VELOCITIES if is_refused else [n for n in ours.values if n in vector["results"]]
        )
        is_right = True
        for name in names:
            value, digits = ours.values[name][row], vector["results"][name]["reference"]
            if is_refused or digits is None:
                is_right &= not (is_refused and np.isfinite(value))
            else:
                off = abs(value - float(digits))
                is_right &= bool(off <= ours.bounds[name][row])
        yield vector["id"], is_right


CHECKS: dict[str, tuple[str, Callable[[Any], Cases]]] = {
    "arithmetic": ("calls of the ROM's arithmetic, every bit", _arithmetic),
    "port": ("runs of the listing: printout, variables, array", _port),
    "replay": ("the same runs over arrays: every character", _replay),
    "emulator": ("Applesoft programs: every character displayed", _emulator),
    "published": ("runs published in 1988: every character", _published_runs),
    "published 1980": ("numbers of COMPUTE!'s Table 5: every digit", _magazine),
    "solve": ("vectors in double precision: every result to its digits", _solve),
}
"""Name of a check -> what it compares, and its function."""
