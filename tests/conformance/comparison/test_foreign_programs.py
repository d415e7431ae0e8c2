"""Programs in C, JavaScript and awk, of other designs than the listing's: correct ones are not
accused, and mistakes that were written before any search was run on them are named.

With IMPACT88_SWEEP=1 all eighty; `-s` shows what is said.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence

import numpy as np
import pytest
import wrongprograms
from longer import long_but
from wrongprograms import FOREIGN, Wrong

from impact88.conformance.comparison.compare import Comparison, compare
from impact88.conformance.comparison.vectors import FAILURE, FROZEN_ID, frozen, scenes
from impact88.names import FINAL_VELOCITIES, SCENE

SWEEP = os.environ.get("IMPACT88_SWEEP")
MISTAKES = [*wrongprograms.CATALOGUE["foreign"], *wrongprograms.CATALOGUE["foreign pairs"]]
FEW = [
    case for case in MISTAKES if len(case.edits) == 2 and case.program in ("phases.c", "bodies.js")
]
FEW = [FEW[2], FEW[-1]]
FEET = 0.3048
UNITS = {
    "feet, slug": (1.0, 1.0, 1.0),
    "metres, kg": (FEET, 14.59390294, 1.0),
    "inches, lb": (12.0, 32.174, 1.0),
    "centimetres, g": (100 * FEET, 14593.90294, 1.0),
    "kilometres, t, hours": (FEET / 1000, 14.59390294e-3, 3600.0),
}
"""System -> what a foot, a slug and a second are in it."""
LENGTHS, VELOCITIES = ("DA", "DB"), ("UX", "UY", "VX", "VY")
LONG_DOUBLE = [("double", "long double"), ("math.h", "tgmath.h")]
ARITHMETICS = {
    "double": {},
    "extended": {"flags": ("-mfpmath=387",)},
    "fused": {"flags": ("-O3", "-march=native", "-ffp-contract=fast")},
    "reassociated": {"flags": ("-O3", "-ffast-math", "-fno-finite-math-only")},
    "long double": {"throughout": [*LONG_DOUBLE, ("%.17g", "%.21Lg")]},
    "long double, printed as a double": {"throughout": [*LONG_DOUBLE, ("%.17g", "%.17Lg")]},
}
"""Arithmetic -> the compiler's flags, or edits of the program."""


def table(rows: Sequence[Mapping[str, str]], answers: Mapping[str, Sequence[str]]) -> list[dict]:
    return [
        {**scene, **{name: answers[name][place] for name in answers}}
        for place, scene in enumerate(rows)
    ]


def in_units(scene: Mapping[str, str], system: str) -> dict[str, str]:
    """A scene in other units, a decimal of 17 digits where it is converted."""
    length, mass, time = UNITS[system]
    factors = {
        **dict.fromkeys(LENGTHS, length),
        **dict.fromkeys(VELOCITIES, length / time),
        **dict.fromkeys(("MA", "MB"), mass),
        **dict.fromkeys(("IA", "IB"), mass * length**2),
        **dict.fromkeys(("WA", "WB"), 1 / time),
    }
    return {
        name: text if factors.get(name, 1.0) == 1.0 else repr(float(text) * factors[name])
        for name, text in scene.items()
    }


def accused(done: Comparison) -> list[str]:
    return [row.cause for row in done.differences]


@pytest.mark.parametrize("program", long_but(FOREIGN))
def test_a_correct_program_is_not_accused(program: str) -> None:
    """In any system of units, with all digits or rounded to a few."""
    if not wrongprograms.is_available(program):
        pytest.skip("no compiler, or no interpreter")
    rows = [scene for kind, _, scene in scenes(120, seed=41) if kind != FAILURE]
    # beside momenta in g and cm a trial impulse of 1 is lost
    systems = list(UNITS)[: 2 if program in ("trial.c", "shooting.js") else None]
    for system in systems:
        scaled = [in_units(scene, system) for scene in rows]
        answers = wrongprograms.answers(scaled, program)
        done = compare(table(scaled, answers), causes=False)
        assert done.differing == 0, (system, done.worst[:3])
    answers = wrongprograms.answers(rows, program)
    for digits in range(2, 8):
        rounded = {
            name: [f"{float(text):.{digits - 1}e}" if text else "" for text in column]
            for name, column in answers.items()
        }
        done = compare(table(rows, rounded), causes=False)
        assert done.differing == 0, (digits, done.worst[:3])


@pytest.mark.parametrize("arithmetic", long_but(ARITHMETICS))
def test_a_correct_program_in_another_arithmetic_is_not_accused(arithmetic: str) -> None:
    """Of trial impulses, whose equations lose digits to large velocities, in closed form, and by
    elimination in Fortran's order."""
    if not wrongprograms.is_available("trial.c"):
        pytest.skip("no compiler")
    rows = [scene for kind, _, scene in scenes(240, seed=43) if kind != FAILURE]
    for program in ("trial.c", "phases.c", "columns.c"):
        answers = wrongprograms.answers(rows, program, **ARITHMETICS[arithmetic])
        done = compare(table(rows, answers), causes=False)
        assert done.differing == 0, (program, done.worst[:3])


@pytest.mark.long
def test_single_precision_is_told_and_no_mistake_is_named() -> None:
    if not wrongprograms.is_available("phases.c"):
        pytest.skip("no compiler")
    rows = [scene for kind, _, scene in scenes(90, seed=43) if kind == "casework"]
    answers = wrongprograms.answers(rows, "phases.c", throughout=[("double", "float")])
    done = compare(table(rows, answers))
    assert done.differing > 0
    assert not done.programs
    assert set(accused(done)) <= {"rounding in single precision"}, done.causes


@pytest.mark.parametrize("program", long_but(p for p in FOREIGN if p != "shooting.js"))
def test_a_program_in_any_language_conforms_to_the_frozen_set(program: str) -> None:
    if not wrongprograms.is_available(program):
        pytest.skip("no compiler, or no interpreter")
    vectors = frozen()
    rows = [vector["scene"] for vector in vectors]
    answers = {
        "id": [vector["id"] for vector in vectors],
        **wrongprograms.answers(rows, program),
    }
    done = compare(table(rows, answers), kit=FROZEN_ID)
    assert done.passes(), done.kit.failures[:5]
    assert done.kit.badge.startswith(f"impact88 vectors {FROZEN_ID}: conforms, 1000 of 1000")


@pytest.mark.parametrize("mistake", MISTAKES if SWEEP else FEW, ids=str)
@pytest.mark.long
def test_a_mistake_is_named_and_its_condition_holds_elsewhere(mistake: Wrong) -> None:
    """What is named gives the program's numbers in scenes that the table does not have."""
    if not wrongprograms.is_available(mistake.program):
        pytest.skip("no compiler, or no interpreter")
    rows = [scene for _, _, scene in scenes(240, seed=31)]
    done = compare(table(rows, wrongprograms.answers(rows, mistake.program, mistake.edits)))
    print(mistake.says, "|", done.causes.most_common(3))
    assert done.programs, done.causes
    cause = done.evidence[0]
    assert mistake.where in cause.says
    assert cause.score > 0
    fresh = [scene for kind, _, scene in scenes(450, seed=99) if kind != FAILURE]
    numbers = {name: np.array([float(scene[name]) for scene in fresh]) for name in SCENE}
    mine = done.programs[0].results(numbers)
    theirs = wrongprograms.answers(fresh, mistake.program, mistake.edits)
    off = np.zeros(len(fresh), bool)
    for name in FINAL_VELOCITIES:
        column = np.array([float(text) if text else np.nan for text in theirs[name]])
        off |= np.abs(mine[name] - column) > 1e-6 * (1 + np.abs(column))
    assert off.mean() <= 0.03
