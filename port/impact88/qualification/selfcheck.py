"""Checking an installation: what the captures of the real machine say, replayed here and now, and
counted: with hashes and versions the record a laboratory files when it qualifies an installation.
"""

import time
from collections.abc import Callable, Iterator
from decimal import Decimal
from itertools import zip_longest
from typing import Any, NamedTuple

from ..collision.fields import FIELDS, outcome_fields
from ..names import FINAL_VELOCITIES, SCENE
from ..program.run import run
from ..program.scene import sample
from ..report import frame
from . import captured

GOLDEN_RUNS = {1: "run1", 2: "run2", 3: "table3"}


class Check(NamedTuple):
    """One check: its name, what it compared, how many of how many came out right, how long it took,
    and the first that did not."""

    name: str
    compared: str
    total: int
    right: int
    seconds: float
    first_wrong: str

    @property
    def passed(self) -> bool:
        """Whether there was something to compare and all of it came out right."""
        return self.right == self.total > 0


Counted = Iterator[tuple[str, bool]]
"""What was compared, and whether it was right."""


def checks(folder: Any = None) -> Iterator[Check]:
    """All checks, one after the other. ``folder``: a path to other captures than the packaged."""
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
    """The record as one object: versions, hashes, checks, verdict."""
    return {
        "passed": all(check.passed for check in checks),
        "versions": frame.versions(),
        "hashes": frame.hashes(),
        "checks": [{**check._asdict(), "passed": check.passed} for check in checks],
        "seconds": round(sum(check.seconds for check in checks), 2),
    }


def _arithmetic(golden: Any) -> Counted:
    for several in captured.calls(golden).values():
        for row in several:
            yield "\t".join(row), captured.call(*row[:4]) == captured.result(row[4])


def _port(golden: Any) -> Counted:
    for row in captured.rows(golden, captured.SCENES):
        ported = run(row["scene"], dos=False)
        same = ported.printout == row["printout"]
        variables = captured.left_behind(ported.reals, ported.A)
        yield row["id"], same and variables == captured.left_behind(row["reals"], row["A"])


def _replay(golden: Any) -> Counted:
    from ..program.vectorized import replay

    rows = captured.rows(golden, captured.SCENES)
    replayed = replay({name: [row["scene"][name] for row in rows] for name in SCENE})
    printed = {name: replayed.printed(name).tolist() for name in FIELDS}
    for index, row in enumerate(rows):
        fields = {name: column[index] for name, column in printed.items() if column[index]}
        yield row["id"], fields == outcome_fields(row["printout"])


def _programs(golden: Any) -> Counted:
    for kind, name, texts in captured.programs(golden):
        keys, blanks = texts.get("in", ""), kind == captured.PROGRAMS
        _, displayed = captured.session(texts["bas"], keys, blanks=blanks)
        yield name, displayed == texts.get("out", "")


def _published(golden: Any) -> Counted:
    for number, name in GOLDEN_RUNS.items():
        expected = golden.joinpath("printouts", f"{name}.txt").read_bytes().decode()
        yield name, run(sample(number)).printout == expected


def _published_elsewhere(golden: Any) -> Counted:
    """The numbers of a magazine's table, which an Apple II printed, by its loop in the emulator."""
    printouts = golden.joinpath("printouts")
    program, printed = (
        printouts.joinpath(f"compute1980.{ending}").read_bytes().decode()
        for ending in ("bas", "txt")
    )
    _, displayed = captured.session(program)
    rows = zip_longest(printed.split(), displayed.split(), fillvalue="")
    for place, (expected, number) in enumerate(rows, 1):
        # the magazine has zeros before the point and at the end, which Applesoft has not
        same = expected and number and Decimal(expected) == Decimal(number)
        yield f"number {place} of Table 5", bool(same)


def _closed_form(golden: Any) -> Counted:
    """Momentum, linear and angular (Equations 13, 14, 17), by the closed form in doubles."""
    import numpy as np

    from ..comparison import agreement
    from ..mechanics.closedform.solve import solve

    rows = captured.rows(golden, captured.SCENES)
    scenes = {name: np.array([float(row["scene"][name]) for row in rows]) for name in SCENE}
    solved = solve(scenes)
    finals = {name: (solved[name], np.zeros(len(rows))) for name in FINAL_VELOCITIES}
    violated = agreement.violated(agreement.case_of(scenes, finals))
    broken = violated["13"] | violated["14"] | violated["17"]
    usable = np.all([np.isfinite(solved[name]) for name in FINAL_VELOCITIES], axis=0)
    for index in np.flatnonzero(usable).tolist():
        yield rows[index]["id"], not broken[index]


CHECKS: dict[str, tuple[str, Callable[[Any], Counted]]] = {
    "arithmetic": ("calls of the ROM's arithmetic, every bit", _arithmetic),
    "port": ("runs of the listing: printout, variables, array", _port),
    "replay": ("the same runs over arrays: every printed field", _replay),
    "emulator": ("Applesoft programs: every character displayed", _programs),
    "published": ("runs published in 1988: every character", _published),
    "published 1980": ("numbers of COMPUTE!'s Table 5: every digit", _published_elsewhere),
    "closed form": ("scenes in double precision: momentum conserved", _closed_form),
}
"""Name of a check -> what it compares, and the check."""
