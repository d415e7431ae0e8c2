"""solve_for: Equations 13 to 18 for any unknowns, against the impacts they come from."""

import numpy as np
import pytest
from collisions import UNKNOWNS, VEHICLES, random_impact

import impact88
from impact88.errors import UserError
from impact88.names import FINAL_STATE, VELOCITIES
from impact88.reconstruction.unknowns import solve_for


@pytest.fixture(scope="module")
def table():
    impacts = [random_impact(np.random.default_rng([9, k])) for k in range(40)]
    vehicles = {name: np.array([v[name] for v, _ in impacts]) for name in VEHICLES}
    return vehicles, {name: np.array([x[name] for _, x in impacts]) for name in UNKNOWNS}


@pytest.mark.parametrize(
    "unknown",
    [
        FINAL_STATE,
        VELOCITIES,
        ("UX", "UY", "WA", "VBX", "VBY", "WBF"),
        ("UX", "VY", "WBF", "E", "MUP", "EM"),
        ("VX",),
    ],
)
def test_unknowns_are_found_over_arrays(table, unknown):
    vehicles, truth = table
    entries = {name: x for name, x in truth.items() if name not in unknown}
    (solution,) = solve_for({**vehicles, **entries})
    for name in unknown:
        np.testing.assert_allclose(solution[name], truth[name], rtol=1e-6, atol=1e-6)
    assert solution.mismatch.max() < 1e-8 * np.abs(truth["UX"]).max()


def test_what_is_not_determined_is_nan(table):
    vehicles, truth = table
    entries = {name: truth[name] for name in ("UY", "VX", "VAX", "VAY", "VBX", "VBY")}
    (solution,) = solve_for({**vehicles, **entries}, ["UX", "VY", "WA", "E", "MUP"])
    np.testing.assert_allclose(solution["UX"], truth["UX"], rtol=1e-9)
    np.testing.assert_allclose(solution["MUP"], truth["MUP"], rtol=1e-6)
    assert np.isnan(solution["WA"]).all()
    assert np.isnan(solution["E"]).all()
    with pytest.raises(UserError, match="WA do not follow"):
        solve_for({**vehicles, **entries}, ["WA"])


def test_mismatch_of_redundant_velocities(table):
    vehicles, truth = table
    entries = {name: truth[name] for name in (*VELOCITIES, *FINAL_STATE)}
    entries["VAX"] = entries["VAX"] + 3.0
    (solution,) = solve_for({**vehicles, **entries}, ["E"])
    assert (solution.mismatch > 0.3).all()


def test_both_signs_of_mu(table):
    vehicles, truth = table
    entries = {name: truth[name] for name in (*FINAL_STATE, "E", "EM")}
    solutions = solve_for({**vehicles, **entries, "MU": np.abs(truth["MUP"])})
    off = np.min([np.abs(s["UX"] - truth["UX"]) for s in solutions], axis=0)
    assert off.max() < 1e-5
    for solution in solutions:
        assert solution.agrees.any()


def test_point_masses_and_what_is_missing():
    entries = {"M": 4, "MA": 3, "MB": 2, "GA": 0, "VAX": 1, "VBX": 2, "UY": 0, "VY": 0, "UX": -3}
    (solution,) = solve_for(entries)
    assert solution["VX"] == pytest.approx(8.0)
    with pytest.raises(UserError, match="missing MB"):
        impact88.solve_for({"MA": 3})
    with pytest.raises(UserError, match="M is 5; expected 6 for bodies or 4"):
        impact88.solve_for({**entries, "M": [4, 5]})
    assert solve_for({**entries, "EM": 0.5})[0]["VX"] == pytest.approx(8.0)
    with pytest.raises(UserError, match=r"EM may be 0\.5"):
        impact88.solve_for({**impact88.sample(1).numbers(), "EM": [0, 0.5]})
    with pytest.raises(UserError, match="UZ"):
        impact88.solve_for({**entries, "UZ": 3})


def test_no_inverse_at_e_0():
    scene = impact88.sample(1).numbers() | {"E": 0.0}
    after = impact88.solve(scene, FINAL_STATE)
    vehicles = {n: x for n, x in scene.items() if n not in VELOCITIES}
    with pytest.raises(UserError, match="do not follow"):
        solve_for({**vehicles, **after}, ["UX"])
