"""Replays: results that the faithful program prints for scenes a printout may have come from.

One scene runs in the port itself; many go through the array replay, which gives the same digits.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from ...apple.applesoft.operators import Real
from ...names import SCENE
from ...program.arithmetics import Arithmetic
from ...program.run import run
from ..fields import FIELDS, ZERO_DETERMINANT, outcome_fields


class Outcome(NamedTuple):
    """Results of a run: the printed fields by name, and the error or ``ZERO DETERMINANT`` that
    ended it (None: it ended normally)."""

    fields: dict[str, str]
    ending: str | None


def run_once(scene: Mapping[str, str], arithmetic: str | Arithmetic = "applesoft") -> Outcome:
    """Run one scene in the port and return its outcome."""
    return run_whole(scene, arithmetic)[0]


def run_whole(
    scene: Mapping[str, str], arithmetic: str | Arithmetic = "applesoft"
) -> tuple[Outcome, dict[str, float]]:
    """Run one scene in the port. Return its outcome, and the values of lines 660 to 760 before they
    are floored (none when the run does not reach its end)."""
    ported = run(scene, arithmetic)
    ending = ZERO_DETERMINANT if ported.zero_determinant else ported.error
    outcome = Outcome(outcome_fields(ported.printout), ending)
    if ending or ported.A is None:
        return outcome, {}
    value = ported.floats
    first = ported.A["dims"][0] * (int(value["M"]) + 1) + 1
    solution = [
        float(Real.from_stored(stored)) if isinstance(stored, str) else stored
        for stored in ported.A["data"][first : first + 6]
    ]
    names = "VAX", "VAY", "VBX", "VBY", *("WAF", "WBF")[: 2 * (value["M"] == value["N"])]
    return outcome, {
        "XA": value["UX"] + value["D3"] * value["WA"],
        "YA": value["UY"] - value["D4"] * value["WA"],
        "XB": value["VX"] - value["D1"] * value["WB"],
        "YB": value["VY"] + value["D2"] * value["WB"],
        "KI": value["KI"],
        "LOSS": 100 * (value["KI"] - value["KF"]) / value["KI"],
        **{f"{name}F": value[name] for name in ("XA", "YA", "XB", "YB")},
        **dict(zip(names, solution, strict=False)),
    }


def run_all(scenes: Sequence[Mapping[str, str]]) -> list[Outcome]:
    """Run scenes and return their outcomes, in order: one by the port, a table of them replayed."""
    if len(scenes) < 2:
        return [run_once(scene) for scene in scenes]
    endings, columns = run_columns(scenes, tuple(FIELDS))
    outcomes = [Outcome({}, ending or None) for ending in endings]
    for name, column in columns.items():
        for outcome, text in zip(outcomes, column.tolist(), strict=True):
            if text:
                outcome.fields[name] = text
    return outcomes


def run_columns(
    scenes: Sequence[Mapping[str, str]], names: Sequence[str]
) -> tuple[list[str], dict[str, Any]]:
    """Replay scenes. Return their endings ("" for a normal one), and for each of ``names`` the
    printed field as an array of texts ("" where the run does not get as far)."""
    from ...program.replay import replay

    # columns throughout: one program serves all batches
    replayed = replay({name: [scene[name] for scene in scenes] for name in SCENE})
    endings = replayed.error.tolist()
    for index in replayed.zero_determinant.nonzero()[0].tolist():
        endings[index] = ZERO_DETERMINANT
    return endings, {name: replayed.printed(name) for name in names}
