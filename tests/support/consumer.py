"""A user's script: the tests run it, and have type checkers read it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import impact88


def printed_loss(mu: str) -> str:
    """A line of the 1988 printout, with another friction coefficient."""
    crash: impact88.Scene = impact88.sample(1).replaced({"MU": mu})
    run: impact88.Run = impact88.run(crash, dos=False)
    return next(line for line in run.printout.splitlines() if "LOSS" in line)


def losses(mu: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same in double precision, over an array."""
    scene = impact88.sample(1).numbers()
    return np.asarray(impact88.solve({**scene, "MU": mu}, results=["LOSS"])["LOSS"])


def spread() -> tuple[float, float]:
    """Bounds of one result from one range."""
    ranges: dict[str, impact88.Uncertain | float] = {**impact88.sample(1).numbers()}
    ranges["MU"] = impact88.Uncertain("uniform", 0.8, 0.7, 0.9)
    found: impact88.Bounds = impact88.bounds(ranges, ["LOSS"], samples=1000)
    return found.bounds["LOSS"].lower, found.bounds["LOSS"].upper


def replayed() -> str:
    """One printed field of many scenes."""
    crash = impact88.sample(3)
    done: impact88.Replay = impact88.replay({**crash, "MU": ["0", ".5"]})
    return " ".join(done.printed("VAX").tolist())


def judged(text: str) -> list[str]:
    """The verdict on every printout in a text."""
    return [found.verdict.name for found in impact88.verify(text)]


def solved_for() -> list[str]:
    """Initial velocities from final ones."""
    known = impact88.sample(1).numbers()
    after = impact88.solve(known, results=impact88.names.FINAL_VELOCITIES)
    given = {name: v for name, v in known.items() if name not in impact88.names.VELOCITIES}
    solutions: list[impact88.Solution] = impact88.solve_for({**given, **after})
    return [name for one in solutions for name in one.unknown]


def looked_up() -> int:
    """What is known of a scene, for another program's tests."""
    return len(impact88.oracle([impact88.sample(1)], reference=False))


def refused() -> str:
    """What a user is told of input that cannot be used."""
    try:
        impact88.run({"MA": "1"})
    except impact88.UserError as error:
        return str(error)
    return ""
