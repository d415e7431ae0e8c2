"""The search for the scene of a page, against every combination run by the port."""

from itertools import product
from random import Random

import numpy as np
import pytest

from impact88.collision.casescene import sample
from impact88.collision.fields import FIELDS, INPUTS, outcome_fields
from impact88.names import SCENE
from impact88.printouts.recovery.search import (
    COUNTS,
    MISMATCH,
    SCREENING_RTOL,
    Column,
    Evidence,
    Expected,
    Search,
    column_of,
    kinetic_energy,
)
from impact88.program.replay import replay
from impact88.program.run import run

RESULTS = [name for name in FIELDS if name not in INPUTS]


def printed(scene: dict[str, str]) -> dict[str, str]:
    return outcome_fields(run(scene).printout)


def evidence(page: dict[str, str]) -> Evidence:
    results = [Expected(name, {page[name]: 0.0}, MISMATCH) for name in RESULTS]
    return Evidence(results, {*INPUTS}, {}, has_final_spins=True)


def columns(page: dict[str, str], texts: dict[str, list[tuple[str, float]]]) -> list[Column]:
    options = {name: texts.get(name, [(page[name], 0.0)]) for name in INPUTS}
    return [*(column_of(*pair) for pair in options.items()), column_of("M", [("6", 0.0)], True)]


@pytest.mark.parametrize("seed", range(4))
def test_the_scene_found_is_the_cheapest_of_all(seed: int) -> None:
    """Masses enter the energy, angles and arms do not; a result may be misprinted, too."""
    draw = Random(seed)
    scene = sample(1)
    some = {
        "MA": ["143.5", "148.5", "149.5"],
        "UX": ["-29.04", "29.04"],
        "DA": ["7.59", "759"],
        "PB": ["-38.7", "-33.7", "38.7"],
    }
    texts = {
        name: sorted(
            ((text, draw.choice((0.0, 0.5, 1.5, 2.8))) for text in each), key=lambda x: x[1]
        )
        for name, each in some.items()
    }
    page = printed({**scene, **{name: draw.choice(each) for name, each in some.items()}})
    page[draw.choice(RESULTS)] = "1.23"
    expected = evidence(page)
    costs = {}
    for combination in product(*texts.values()):
        tried = {name: text for name, (text, _) in zip(texts, combination, strict=True)}
        found = printed({**scene, **tried})
        wrong = sum(found.get(name) != page[name] for name in RESULTS)
        costs[tuple(tried.values())] = sum(cost for _, cost in combination) + MISMATCH * wrong
    _, best = Search(expected).nearest(columns(page, texts))[0]
    assert best.cost == pytest.approx(min(costs.values()))
    assert costs[tuple(best.scene[name] for name in texts)] == pytest.approx(best.cost)


@pytest.mark.parametrize("changes", [{}, {"VY": "-40"}], ids=["MU as typed", "MU turned"])
def test_a_scene_that_its_inputs_make_unlikely_is_found_in_a_later_batch(
    changes: dict[str, str],
) -> None:
    page = printed({**sample(1), **changes, "MA": "148.5"})
    masses = [("143.5", 0.0), *((f"{mass}.5", 2.0) for mass in range(100, 160))]
    arms = [*((f"7.{arm}", 1.0) for arm in range(100, 400)), ("7.59", 1.5)]
    _, best = Search(evidence(page)).nearest(columns(page, {"MA": masses, "DA": arms}))[0]
    assert len(masses) > COUNTS[0]
    assert (best.scene["MA"], best.wrong) == ("148.5", frozenset())


def test_results_that_a_page_lacks_count_against_a_scene_that_prints_them() -> None:
    """Of central impacts without spins M = 4 prints the same but for the final spins."""
    page = printed({**sample(1), "DA": "0", "DB": "0", "M": "4"})
    results = [Expected(name, {page[name]: 0.0}, MISMATCH) for name in RESULTS if name in page]
    assert len(results) == len(RESULTS) - 2
    *inputs, _ = columns(page, {})
    for dearer, found in ((0.5, "4"), (2.0, "6")):  # two results that are not there cost .6 each
        of_m = column_of("M", [("6", 0.0), ("4", dearer)], True)
        _, best = Search(Evidence(results, {*INPUTS}, {})).nearest([*inputs, of_m])[0]
        assert best.scene["M"] == found


def test_the_energy_in_doubles_is_as_near_as_the_search_takes_it_to_be() -> None:
    draw = Random(7)
    texts = {
        name: [f"{draw.uniform(1, 9) * 10.0 ** draw.randint(-3, 4):.6g}" for _ in range(400)]
        for name in SCENE
        if name != "M"
    }
    numbers = {name: np.array([float(text) for text in each]) for name, each in texts.items()}
    exact = replay({**texts, "M": "6"}).floats("KI")
    error = np.abs(kinetic_energy(numbers) - exact) / exact
    assert np.nanmax(error) < SCREENING_RTOL / 20
