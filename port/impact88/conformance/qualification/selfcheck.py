"""Check an installation: repeat the captures of the real machine here, and count agreements.

With hashes and versions, the result is the record a laboratory files to qualify an installation.
"""

import time
from collections.abc import Callable, Iterator
from decimal import Decimal
from itertools import zip_longest
from typing import Any, NamedTuple

from ...apple import captured
from ...casework.report import frame
from ...collision.casescene import sample
from ...collision.fields import FIELDS, outcome_fields
from ...names import FINAL_VELOCITIES, SCENE
from ...program.run import run

GOLDEN_RUNS = {1: "run1", 2: "run2", 3: "table3"}


class Check(NamedTuple):
    """Result of one check: its name, what it ``compared``, the ``total`` number of cases and how
    many were ``right``, the seconds it took, and the first case that was wrong, "" if none."""

    name: str
    compared: str
    total: int
    right: int
    seconds: float
    first_wrong: str

    @property
    def passed(self) -> bool:
        """True if there was at least one case and all were right."""
        return self.right == self.total > 0


Counted = Iterator[tuple[str, bool]]
"""Name of each case compared, and whether it was right."""


def checks(folder: Any = None) -> Iterator[Check]:
    """Run all checks, one after the other. ``folder``: path of captures other than the packaged."""
    golden = folder or captured.golden()
    for name, (compared, cases) in CHECKS.items():
        start = time.perf_counter()
        total, wrong = 0, []
        try:
            for case, ok in cases(golden):
                total += 1
                wrong += [] if ok else [case]
        except Exception as error:  # a check that breaks down is a check that fails
            total += 1
            wrong.append(f"broke down: {type(error).__name__}: {error}")
        seconds = time.perf_counter() - start
        yield Check(name, compared, total, total - len(wrong), seconds, next(iter(wrong), ""))


def record(checks: list[Check]) -> dict[str, Any]:
    """Return the record as one object: verdict, versions, hashes, checks."""
    return {
        "passed": all(check.passed for check in checks),
        "versions": frame.versions(),
        "hashes": frame.hashes(),
        "checks": [{**check._asdict(), "passed": check.passed} for check in checks],
        "seconds": round(sum(check.seconds for check in checks), 2),
    }


def _arithmetic(golden: Any) -> Counted:
    for rows in captured.calls(golden).values():
        for row in rows:
            yield "\t".join(row), captured.call(*row[:4]) == captured.result(row[4])


def _port(golden: Any) -> Counted:
    for row in captured.rows(golden, captured.SCENES):
        listing_run = run(row["scene"], dos=False)
        same = listing_run.printout == row["printout"]
        variables = captured.memory_contents(listing_run.reals, listing_run.A)
        yield row["id"], same and variables == captured.memory_contents(row["reals"], row["A"])


def _replay(golden: Any) -> Counted:
    from ...program.replay import replay

    rows = captured.rows(golden, captured.SCENES)
    replay_result = replay({name: [row["scene"][name] for row in rows] for name in SCENE})
    printed_text = {name: replay_result.printed(name).tolist() for name in FIELDS}
    for index, row in enumerate(rows):
        fields = {name: column[index] for name, column in printed_text.items() if column[index]}
        yield row["id"], fields == outcome_fields(row["printout"])


def _programs(golden: Any) -> Counted:
    for kind, name, texts in captured.programs(golden):
        keys, blanks = texts.get("in", ""), kind == captured.PROGRAMS
        _, screen_text = captured.session(texts["bas"], keys, blanks=blanks)
        yield name, screen_text == texts.get("out", "")


def _check_published(golden: Any) -> Counted:
    for number, name in GOLDEN_RUNS.items():
        expected_text = golden.joinpath("printouts", f"{name}.txt").read_bytes().decode()
        yield name, run(sample(number)).printout == expected_text


def _published_elsewhere(golden: Any) -> Counted:
    """Compare the numbers of a magazine's table, printed by an Apple II, with its program's output
    in the emulator."""
    printouts = golden.joinpath("printouts")
    program, printed_text = (
        printouts.joinpath(f"compute1980.{ending}").read_bytes().decode()
        for ending in ("bas", "txt")
    )
    _, screen_text = captured.session(program)
    rows = zip_longest(printed_text.split(), screen_text.split(), fillvalue="")
    for place, (expected_text, number) in enumerate(rows, 1):
        # the magazine adds zeros before the point and at the end
        same = expected_text and number and Decimal(expected_text) == Decimal(number)
        yield f"number {place} of Table 5", bool(same)


def _solve(golden: Any) -> Counted:
    """Compare every result of `solve` with the frozen vectors' digits, within its error bound;
    where no program may answer, it must give no number."""
    import numpy as np

    from ...mechanics.accuracy.errorbound import result_bounds
    from ...mechanics.closedform.solve import solve
    from ..comparison.vectors import REFUSE

    vectors = captured.rows(golden, "vectors")
    scenes = {name: np.array([float(row["scene"][name]) for row in vectors]) for name in SCENE}
    solved, bounds = solve(scenes), result_bounds(scenes)
    for index, vector in enumerate(vectors):
        digits = {name: result["reference"] for name, result in vector["results"].items()}
        is_refused = vector["expect"] == REFUSE
        known = {} if is_refused else {n: float(text) for n, text in digits.items() if text}
        yield (
            vector["id"],
            not (is_refused and any(np.isfinite(solved[n][index]) for n in FINAL_VELOCITIES))
            and all(
                solved[n][index] == x or abs(solved[n][index] - x) <= bounds[n][index]
                for n, x in known.items()
            ),
        )


CHECKS: dict[str, tuple[str, Callable[[Any], Counted]]] = {
    "arithmetic": ("calls of the ROM's arithmetic, every bit", _arithmetic),
    "port": ("runs of the listing: printout, variables, array", _port),
    "replay": ("the same runs over arrays: every printed field", _replay),
    "emulator": ("Applesoft programs: every character displayed", _programs),
    "published": ("runs published in 1988: every character", _check_published),
    "published 1980": ("numbers of COMPUTE!'s Table 5: every digit", _published_elsewhere),
    "solve": ("vectors in double precision: every result to its digits", _solve),
}
"""Name of a check -> what it compares, and its function."""
