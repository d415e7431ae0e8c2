"""Check an installation: repeat the captures of a real Apple II Plus here, and count agreements."""

import platform
import re
import sys
from collections.abc import Callable, Iterator
from hashlib import sha256
from typing import Any, NamedTuple

from ..apple import captured
from ..files import packaged_bytes
from ..names import FINAL_VELOCITIES, SCENE
from ..program.run import run
from ..version import __version__

DISK_COMMAND = re.compile(r"^\x04.*\n", re.M)
Cases = Iterator[tuple[str, bool]]
"""Name of each case, and whether it is as captured."""


class Check(NamedTuple):
    """The result of one check: how many of the cases are ``right``, and the first that is not."""

    name: str
    compares: str
    total: int
    right: int
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
        total, wrong = 0, []
        try:
            for case, is_right in cases(golden):
                total += 1
                wrong += [] if is_right else [case]
        except Exception as error:  # a check that breaks down is a check that fails
            total += 1
            wrong.append(f"broke down: {type(error).__name__}: {error}")
        yield Check(name, compares, total, total - len(wrong), next(iter(wrong), ""))


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
        },
        "checks": [{**check._asdict(), "passed": check.passed} for check in results],
    }


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


def _solve(golden: Any) -> Cases:
    """Compare results with the vectors' 30 digits; where no program may answer, expect none."""
    import numpy as np

    from .agreement import reference
    from .kit import REFUSE

    vectors = captured.rows(golden, "vectors")
    scene = {n: np.array([float(vector["scene"][n]) for vector in vectors]) for n in SCENE}
    ours = reference(scene)
    for row, vector in enumerate(vectors):
        if vector["expect"] == REFUSE:
            yield vector["id"], not any(np.isfinite(ours.values[n][row]) for n in FINAL_VELOCITIES)
            continue
        results = {n: x["reference"] for n, x in vector["results"].items() if n in ours.values}
        yield (
            vector["id"],
            all(
                digits is None or abs(ours.values[n][row] - float(digits)) <= ours.bounds[n][row]
                for n, digits in results.items()
            ),
        )


CHECKS: dict[str, tuple[str, Callable[[Any], Cases]]] = {
    "arithmetic": ("calls of the ROM's arithmetic, every bit", _arithmetic),
    "port": ("runs of the listing: printout, variables, array", _port),
    "replay": ("the same runs over arrays: every character", _replay),
    "emulator": ("Applesoft programs: every character displayed", _emulator),
    "solve": ("vectors in double precision: every result to its digits", _solve),
}
"""Name of a check -> what it compares, and its function."""
