"""The tolerance of the judge: what correct programs need, in any units, and no more.

The correct programs are those of `wrongprograms`, which share no code with the package.
With IMPACT88_SWEEP=1 80 scenes of each population are looked at, and every program.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from random import Random

import numpy as np
import pytest
import wrongprograms
from longer import long_but

from impact88.bench import populations
from impact88.collision.casescene import sample
from impact88.conformance.comparison import agreement, tolerance
from impact88.conformance.comparison.agreement import DIFFER, LOST
from impact88.conformance.comparison.vectors import CASEWORK, CLASSES, casework, scenes
from impact88.equations.roundoff import elimination_errors, running_errors
from impact88.equations.spelling import spellings
from impact88.mechanics.accuracy.errorbound import scales
from impact88.mechanics.accuracy.reference import thirty_digits
from impact88.mechanics.closedform.solve import solve
from impact88.names import FINAL_VELOCITIES, RESULTS, SCENE

SWEEP = os.environ.get("IMPACT88_SWEEP")
COUNT = 80 if SWEEP else 4
SOME = [wrongprograms.CORRECT.index(name) for name in ("matrix", "nine", "jacobian", "complex")]
SYSTEMS = {
    "ft-slug": (1.0, 1.0),
    "inches": (12.0, 1 / 12),
    "m-kg": (0.3048, 14.5939),
    "mm-tonne": (304.8, 0.0145939),
    "mm-kg": (304.8, 14.5939),
    "cm-g": (30.48, 14593.9),
    "km-tonne": (3.048e-4, 0.0145939),
}
"""Lengths and masses of a scene in feet and slugs are multiplied by these."""
LENGTHS = ("DA", "DB", "UX", "UY", "VX", "VY")


def columns(rows: Sequence[Mapping[str, str]]) -> dict[str, np.ndarray]:
    return {name: np.array([float(row[name]) for row in rows]) for name in SCENE}


def converted(scene: Mapping[str, np.ndarray], system: str) -> dict[str, np.ndarray]:
    length, mass = SYSTEMS[system]
    by = dict.fromkeys(LENGTHS, length) | {"MA": mass, "MB": mass}
    by |= {"IA": mass * length**2, "IB": mass * length**2}
    return {name: column * by.get(name, 1.0) for name, column in scene.items()}


def judged(
    scene: dict[str, np.ndarray], theirs: Mapping[str, np.ndarray]
) -> agreement.ComparedRows:
    exact = {name: (column, np.zeros(column.size)) for name, column in theirs.items()}
    return agreement.make_case(scene, exact)


HARD = {
    "tiny gyration radii": lambda rng: {
        n: f"{10 ** rng.uniform(-8, -1):.3g}" for n in ("IA", "IB")
    },
    "e_m near 1/2": lambda rng: {"EM": repr(0.5 + 10 ** rng.uniform(-7, -3))},
    "the angle's rounding decides": lambda rng: {
        **dict.fromkeys(("DA", "DB", "WA", "WB", "UY", "VY"), "0"),
        **{"GA": rng.choice(("-180", "90", "360")), "UX": "1E22"},
    },
    "a light B": lambda rng: {n: f"{10 ** rng.uniform(-9, 2):.3g}" for n in ("MB", "IB")},
}


def populated() -> dict[str, list[dict[str, str]]]:
    """The benchmark's populations, the kit's classes, casework in other units and made hard."""
    every = {}
    for name in populations.POPULATIONS:
        texts = populations.texts(populations.scenes(name, COUNT, 5))
        every[name] = [{n: texts[n][row] for n in SCENE} for row in range(COUNT)]
    for kind in CLASSES:
        rows = [scene for label, _, scene in scenes(3 * COUNT, 77) if label == kind]
        every[f"kit, {kind}"] = rows
    rng = Random(3)
    usual = columns([casework(rng) for _ in range(COUNT)])
    for system in SYSTEMS:
        texts = populations.texts(converted(usual, system))
        every[system] = [{n: texts[n][row] for n in SCENE} for row in range(COUNT)]
    for name, make_hard in HARD.items():
        every[name] = [casework(rng) | make_hard(rng) for _ in range(5 * COUNT)]
    return every


@pytest.mark.parametrize("program", long_but(wrongprograms.CORRECT, kept=SOME))
def test_no_correct_program_is_called_wrong(program: str) -> None:
    """In 26 populations. Of 33,000 rows of all 15 programs three have a number beyond the bound, by
    programs that eliminate in an order of no spelling where masses differ by 1e8 and more, or an
    approach is 1e-9 of the sliding."""
    wrong = count = 0
    for rows in populated().values():
        theirs = {
            name: np.array([text or "nan" for text in column], float)
            for name, column in wrongprograms.answers(rows, program).items()
        }
        grades, _ = judged(columns(rows), theirs).grade()
        wrong += (grades == DIFFER).any(0).sum()
        count += len(rows)
    assert wrong <= count // 800


def test_one_scene_in_seven_systems_has_one_tolerance() -> None:
    """The smallest error that is reported, as a share of the scene's size."""
    rows = [dict(sample(number)) for number in (1, 2, 3)]
    rows += [scene for kind, _, scene in scenes(90, 1988) if kind == CASEWORK]
    shares = []
    for system in SYSTEMS:
        scene = converted(columns(rows), system)
        nothing = {name: np.full(len(rows), 1e300) for name in FINAL_VELOCITIES}
        case = judged(scene, nothing)
        sizes = np.where(case.sizes > 0, case.sizes, np.inf)  # where nothing turns
        shares.append((case.loose / sizes).max(0))
    largest, least = np.max(shares, 0), np.min(shares, 0)
    assert np.median(largest / least) < 3
    assert (largest / least)[:3].max() < 10
    assert np.median(largest) < 3e-13
    assert (largest > 1e-12).mean() < 0.1


@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.long
def test_a_small_error_is_found_in_any_units(system: str) -> None:
    rows = [scene for kind, _, scene in scenes(90, 8) if kind == CASEWORK]
    scene = converted(columns([dict(sample(1)), *rows]), system)
    ours = {name: solve(scene)[name] for name in FINAL_VELOCITIES}
    sizes = scales(scene, solve(scene))
    for name in FINAL_VELOCITIES:
        # what trial impulses may lose depends on the units: up to ORDINARY_BOUND is allowed
        off = sizes[name] * {"ft-slug": 1e-10, "m-kg": 3e-10}.get(system, 2e-9)
        grades, _ = judged(scene, {**ours, name: ours[name] + off}).grade()
        assert (grades == DIFFER).any(0).mean() > 0.9
        grades, _ = judged(scene, {**ours, name: ours[name] * 1.03}).grade()
        assert (grades == DIFFER).any(0).all()


def test_no_vector_takes_any_number() -> None:
    """Stale pivot rows and singular frictions among them."""
    scene = columns([scene for _, _, scene in scenes(300, 1988)])
    ours = solve(scene)
    for name in FINAL_VELOCITIES:
        case = judged(scene, {name: np.full(len(ours[name]), 123456.789)})
        assert (case.grade()[0][0] == DIFFER)[np.isfinite(ours[name])].all()


@pytest.mark.long
def test_the_bound_is_one_of_the_exact_result() -> None:
    """Against thirty digits: by elimination in double precision, of every spelling."""
    rows = [scene for _, _, scene in scenes(120, 12)]
    scene = columns(rows)
    exact = [thirty_digits(sample(1).replaced(row)) for row in rows]
    judged_numbers = 0
    for spelling in spellings().values():
        errors = running_errors(spelling, scene)
        for name in FINAL_VELOCITIES:
            values, off = (np.broadcast_to(part, (len(rows),)) for part in errors[name])
            for row, digits in enumerate(exact):
                if (known := digits.get(name)) is not None and np.isfinite(values[row]):
                    difference = abs(values[row] - float(known))
                    room = (off[row] + abs(values[row])) * 2.0**-53
                    assert difference <= room, (spelling.title, name, rows[row])
                    judged_numbers += 1
    assert judged_numbers > 4000


def test_elimination_is_bounded_entry_by_entry() -> None:
    """Rows and columns scaled by powers of two in any way: what is off scales with them, as long as
    the pivots are the same."""
    rng = np.random.default_rng(4)
    matrix = rng.normal(size=(50, 6, 6))
    errors, solvable = elimination_errors(matrix)
    across = 2.0 ** rng.integers(-40, 40, 6)
    scaled, _ = elimination_errors(matrix * across)
    assert solvable.all()
    np.testing.assert_allclose(scaled, errors * across, rtol=1e-12)
    assert (errors >= np.abs(matrix)).all()
    assert not elimination_errors(np.zeros((1, 3, 3)))[1].any()


def test_digits_that_tell_nothing_are_not_agreement() -> None:
    """1E5 for -13.3 is within the last digit written, and says nothing."""
    scene = columns([dict(sample(1))])
    theirs = {"VAX": (np.array([0.0]), np.array([1e5])), "VAY": (np.array([1e9]), np.array([0.0]))}
    grades, _ = agreement.make_case(scene, theirs).grade()
    assert grades[0, 0] == LOST
    assert grades[1, 0] == DIFFER
    sizes = scales(scene, {name: column.astype(float) for name, column in solve(scene).items()})
    assert sizes["VAX"][0] > 13


@pytest.mark.parametrize("wrong", [1.0, 1.01])
def test_a_result_is_graded_by_itself(wrong: float) -> None:
    """By trial impulses a large velocity loses digits: with another column wrong, or other rows, it
    agrees as it does alone."""
    rows = [scene for kind, _, scene in scenes(120, 43) if kind != "failure"]
    theirs = {
        name: np.array([text or "nan" for text in column], float)
        for name, column in wrongprograms.answers(rows, "jacobian").items()
    }
    rng = np.random.default_rng(3)
    noise = 1 + 5e-12 * rng.choice((-1.0, 1.0), len(rows))
    theirs = {name: column * noise for name, column in theirs.items()}
    alone, _ = judged(columns(rows), {"VAX": theirs["VAX"]}).grade()
    grades, _ = judged(columns(rows), {**theirs, "WBF": theirs["WBF"] * wrong}).grade()
    np.testing.assert_array_equal(grades[list(theirs).index("VAX")], alone[0])


def test_a_large_bound_of_ours_hides_no_violation() -> None:
    """Next to a friction that makes the equations singular: of another friction than MU."""
    rows = [scene for _, label, scene in scenes(1000, 1988) if label == "singular friction"]
    scene = columns(rows)
    ours = {name: solve(scene)[name] for name in FINAL_VELOCITIES}
    other = solve({**scene, "MU": np.arctan(scene["MU"])})
    for theirs, is_violated in ((ours, False), ({n: other[n] for n in ours}, True)):
        violated = agreement.violated_equations(judged(scene, theirs))
        assert (violated["16"] == is_violated).all()
        assert not violated["13"].any()
        assert not violated["14"].any()


def test_what_elimination_may_lose_is_added_in_ordinary_scenes_alone() -> None:
    """To the precision that a row shows, where the user's tolerance is exceeded; the bounds of
    others have it already."""
    scene = columns([scene for kind, _, scene in scenes(200, seed=5) if kind != "failure"])
    ours = solve(scene, FINAL_VELOCITIES)
    exact, off = (
        agreement.make_case(scene, {n: (v * by, 0 * v) for n, v in ours.items()}, 1e-9).per_unit
        for by in (1.0, 1.01)
    )
    is_ordinary = tolerance.is_ordinary(scene, solve(scene, ["COND"])["COND"])
    is_finite = np.isfinite(exact)
    assert (off > exact)[is_ordinary & is_finite].mean() > 0.9
    np.testing.assert_array_equal(off[~is_ordinary], exact[~is_ordinary])


def test_no_bound_of_an_ordinary_scene_reaches_the_one_that_stands_for_it() -> None:
    """What is farther off is wrong whatever its own bound is, which is then not computed."""
    rows = [scene for _, _, scene in scenes(1500, seed=21)]
    scene = {name: np.array([float(row[name]) for row in rows]) for name in SCENE}
    with np.errstate(all="ignore"):
        ours = {name: column.astype(float) for name, column in solve(scene).items()}
        sizes = scales(scene, ours)
        best, _ = tolerance.best_error_bounds(scene, ours, sizes)
        names = [name for name in RESULTS if name not in ("STATUS", "COND")]
        bounds = tolerance.largest_error_bounds(scene, ours, sizes, best, names)
        usual = tolerance.is_ordinary(scene, ours["COND"])
        assert usual.mean() > 0.5
        for name in names:
            measured = usual & (sizes[name] > 0)
            assert (bounds[name] / sizes[name])[measured].max() < tolerance.ORDINARY_BOUND / 3
