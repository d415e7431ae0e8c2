"""Trials: what the faithful program prints for scenes that a printout may have come from.

Few scenes go through the port itself, many through the array replay, which gives the same digits.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from . import printout
from .names import SCENE

_FEW = 6
"""Up to this many scenes the port is as quick as the replay, and needs no numpy."""


class Outcome(NamedTuple):
    """What a run prints: the fields by name, and the error or ``ZERO DETERMINANT`` that ended it
    (None: it ended normally)."""

    fields: dict[str, str]
    ending: str | None


def run_once(scene: Mapping[str, str], arithmetic: str = "applesoft") -> Outcome:
    """The outcome of one scene in the port."""
    from .run import run

    done = run(scene, arithmetic)
    return outcome_of(done.printout)


def outcome_of(text: str) -> Outcome:
    """The outcome shown by what one run printed."""
    shown = printout.read_printouts(text)[0]
    return Outcome({name: one.text for name, one in shown.fields.items()}, shown.ending)


def run_all(scenes: Sequence[Mapping[str, str]]) -> list[Outcome]:
    """The outcome of each scene, in order."""
    if len(scenes) <= _FEW:
        return [run_once(scene) for scene in scenes]
    from .replay import replay

    columns = {}
    for name in SCENE:
        column = [scene[name] for scene in scenes]
        columns[name] = column[0] if column.count(column[0]) == len(column) else column
    done = replay(columns)
    endings: list[str | None] = [text or None for text in done.error.tolist()]
    for index in done.zero_determinant.nonzero()[0].tolist():
        endings[index] = printout.ZERO_DETERMINANT
    outcomes = [Outcome({}, ending) for ending in endings]
    for name in printout.FIELDS:
        for outcome, text in zip(outcomes, done.printed(name).tolist(), strict=True):
            if text:
                outcome.fields[name] = text
    return outcomes


def unfloored(scene: Mapping[str, str], arithmetic: str = "applesoft") -> dict[str, float]:
    """The values that lines 660 to 760 floor before they print them, unfloored; empty when the run
    does not reach its end."""
    from .applesoft.real import Real
    from .run import run

    done = run(scene, arithmetic)
    if done.error or done.zero_determinant or done.A is None:
        return {}

    def number(stored: str | float) -> float:
        return float(Real.from_stored(stored)) if isinstance(stored, str) else stored

    value = {name: number(stored) for name, stored in done.reals.items()}
    rows = done.A["dims"][0]
    column = int(value["M"]) + 1
    solution = [number(done.A["data"][row + rows * column]) for row in range(1, 7)]
    found = {
        "XA": value["UX"] + value["D3"] * value["WA"],
        "YA": value["UY"] - value["D4"] * value["WA"],
        "XB": value["VX"] - value["D1"] * value["WB"],
        "YB": value["VY"] + value["D2"] * value["WB"],
        "LOSS": 100 * (value["KI"] - value["KF"]) / value["KI"],
        **{f"{name}F": value[name] for name in ("XA", "YA", "XB", "YB")},
        **dict(zip(("VAX", "VAY", "VBX", "VBY"), solution, strict=False)),
    }
    if value["M"] == value["N"]:
        found |= {"WAF": solution[4], "WBF": solution[5]}
    return found
