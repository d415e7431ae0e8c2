"""Agreement with the evidence: which value, law or condition of physics, and by how much."""

import numpy as np
import pytest
from collisions import RECORDER, SECTION_VII, random_impact
from scipy.special import chdtrc

from impact88.cases.amounts import Amount
from impact88.cases.units import View
from impact88.chapter.staged import collisions
from impact88.mechanics.inverse import complete
from impact88.mechanics.solve import evaluate
from impact88.names import FINAL_STATE, VELOCITIES
from impact88.reconstruction.answer import reconstruct
from impact88.reconstruction.fit import Search, chi_square_tail, expected_unseen
from impact88.reconstruction.problem import Problem
from impact88.reconstruction.words import check, evidence, refusal

MOTION = (*VELOCITIES, *FINAL_STATE)
KINDS = {
    **dict.fromkeys(("VAX", "VAY", "VBX", "VBY", "UX", "SAF", "DVA"), 2.0),
    **dict.fromkeys(("WAF", "WBF"), 0.3),
    **dict.fromkeys(("HAF", "PDOFA"), 3.0),
    "EL": 5000.0,
}
"""Twelve kinds of values, each with its tolerance."""


def _within(value, tolerance):
    return Amount(value, value - tolerance, value + tolerance, "uniform")


@pytest.fixture(scope="module")
def measurements():
    """A collision of which all velocities are measured well, with everything that follows."""
    vehicles, truth = random_impact(np.random.default_rng(12))
    consequences, _ = evaluate(complete({**vehicles, **truth}).values, tuple(KINDS))
    entries = {name: Amount.exactly(x) for name, x in vehicles.items()}
    entries |= {name: _within(truth[name], 0.02 if name[0] == "W" else 0.2) for name in MOTION}
    return entries, {name: float(x) for name, x in consequences.items()}


@pytest.mark.parametrize("times", [5, pytest.param(50, marks=pytest.mark.long)])
@pytest.mark.parametrize("kind", KINDS)
def test_a_value_at_odds_is_named_with_its_amount(measurements, kind, times):
    entries, truth = measurements
    if kind in ("SAF", "HAF"):
        entries = {n: x for n, x in entries.items() if n not in ("VAX", "VAY")}
        entries |= {"SAF": _within(truth["SAF"], 0.2), "HAF": _within(truth["HAF"], 0.3)}
    tolerance = KINDS[kind]
    shift = min(times * tolerance, 150.0) if kind in ("HAF", "PDOFA") else times * tolerance
    entries = {**entries, kind: _within(truth[kind] + shift, tolerance)}
    result = reconstruct(entries, samples=0)[0]
    assert result.verdict == "contradictory"
    assert kind in result.evidence.at_odds
    test = result.tests[kind]
    assert abs(test.by_others - truth[kind]) < tolerance
    assert f"{kind} " in evidence(result)


def test_values_within_their_tolerances_agree(measurements):
    entries, truth = measurements
    shifted = {kind: _within(truth[kind] + 0.9 * tol, tol) for kind, tol in KINDS.items()}
    result = reconstruct(entries | shifted, samples=0)[0]
    assert result.verdict in ("agrees", "at a limit")
    assert {*KINDS} <= {*result.tests}


def test_the_law_that_misses_is_named_with_its_amount():
    entries = {"M": 4, "MA": 3000 / 32.174, "MB": 2000 / 32.174, "UX": 40, "UY": 0, "VX": 0}
    entries |= {"VY": -30, "VAX": 20, "VAY": -10, "VBX": 10, "VBY": -15}
    result = reconstruct(entries)[0]
    assert result.verdict == "contradictory"
    (law,) = result.laws
    assert law.law == "momentum along x"
    assert law.amount == pytest.approx((3000 * 20 - 2000 * 10) / 32.174)
    assert "momentum along x misses by 1243 lb-s" in evidence(result, View("chapter")).lower()
    assert "VBX" in result.evidence.at_odds
    assert "The nearest one has" in refusal(result)
    assert not result.intervals
    assert " sd)" not in evidence(result) + refusal(result)


def test_values_that_agree_but_for_the_rounding_of_what_was_typed():
    vehicles, truth = random_impact(np.random.default_rng(3))
    rounded_values = {name: float(f"{truth[name]:.5g}") for name in MOTION}
    result = reconstruct({**vehicles, **rounded_values}, samples=0)[0]
    assert result.verdict == "agrees"
    assert result.values["E"] == pytest.approx(truth["E"], abs=0.01)


def test_energy_that_is_gained_is_impossible():
    entries = {"M": 4, "MA": 3000, "MB": 2000, "HA": 0, "HB": 0, "SAF": 30, "HAF": 0, "SBF": 45}
    result = reconstruct({**entries, "HBF": 0, "SB": 30})[0]
    assert result.verdict == "impossible"
    assert result.is_adverse
    assert {"energy", "E"} <= set(result.broken)
    assert "energy would be gained" in refusal(result)
    assert result.values["SA"] == pytest.approx(40)


def test_no_vehicle_travels_against_its_course():
    entries = {"M": 4, "MA": 1000, "MB": 1000, "HA": 0, "SB": 0, "E": 0, "MU": -10}
    assert reconstruct({**entries, "VBX": 10}, samples=0)[0].verdict == "agrees"
    result = reconstruct({**entries, "VBX": -10}, samples=0)[0]
    assert result.is_adverse
    assert "A would travel against its course HA" in refusal(result)


CROSSING = {"M": 4, "MA": "3650 +- 100", "MB": "2875 +- 100", "HB": 0, "TA": 0, "TB": 0}
CROSSING |= {"SAF": "32 +- 1", "HAF": "40 +- 3", "SBF": "37 +- 1", "HBF": "50 +- 3"}


@pytest.mark.parametrize("change", [{}, {"HB": "0 +- 3"}])
@pytest.mark.parametrize(("course", "agrees"), [(30, False), (45, True)])
def test_a_speed_along_a_course_is_not_negative(course, agrees, change):
    """The momentum points along 45 degrees: no A that came from 30 degrees gives it with B's."""
    result = reconstruct(CROSSING | change | {"HA": course}, samples=4000)[0]
    assert result.values["SB"] >= 0
    assert result.is_adverse != agrees
    if not agrees:
        assert result.verdict == "contradictory"
        assert result.evidence.redundancy >= 1
        assert not result.intervals
    for name, (low, high) in result.intervals.items():
        assert low <= result.values[name] <= high


@pytest.mark.parametrize(("change", "agrees"), [("12 +- 1.2", True), ("14.8 +- .6", False)])
def test_an_impact_beyond_the_limits_of_values_is_none(change, agrees):
    entries = {"M": 4, "MA": 42, "MB": 31, "HA": 0, "SB": 0, "E": 0.1}
    result = reconstruct({**entries, "SA": "28 +- 2", "DVA": change}, samples=4000)[0]
    assert result.evidence.probability > 1e-3
    assert result.is_adverse != agrees
    assert bool(result.intervals) == agrees


def test_distances_to_what_others_say_are_in_their_own_standard_deviations():
    entries = {"M": 4, "MA": 42, "MB": 31, "HA": 0, "SB": 0, "E": 0.1}
    result = reconstruct({**entries, "SA": "28 +- 2", "DVA": "12 +- 1.2"}, samples=0)[0]
    # by momentum, DVA = SA 1.1 31 / 73
    slope = 1.1 * 31 / 73
    sd = np.hypot(2 / np.sqrt(3), 1.2 / np.sqrt(3) / slope)
    distance = (28 - 12 / slope) / sd
    assert abs(result.tests["SA"].residual) == pytest.approx(distance, rel=1e-4)
    assert check(result, "SA").endswith(f"({distance:.1f} sd)")


def test_a_value_that_no_other_checks_is_not_beside_others():
    result = reconstruct(RECORDER, samples=0)[0]
    checked = {name for name, test in result.tests.items() if np.isfinite(test.by_others)}
    assert checked == {"DVA", "DVB"}
    result = reconstruct(RECORDER | {"DVB": None}, samples=0)[0]
    assert all(np.isnan(test.by_others) for test in result.tests.values())


def test_baarda_and_chi_square():
    result = reconstruct(RECORDER, samples=0)[0]
    assert (round(result.evidence.squares, 2), result.evidence.redundancy) == (1.39, 1)
    assert round(result.evidence.probability, 2) == 0.24
    assert result.values["E"] == pytest.approx(0.19, abs=0.01)
    # one redundant value: all residuals have the size of the root of the sum of squares
    sizes = {abs(test.residual) for test in result.tests.values() if test.residual}
    assert max(sizes) == pytest.approx(result.evidence.squares**0.5)
    assert min(sizes) == pytest.approx(max(sizes))


@pytest.mark.parametrize(("x", "degrees"), [(0.5, 1), (3.2, 2), (11.1, 3), (40.0, 8), (2000.0, 4)])
def test_chi_square_tail(x, degrees):
    assert chi_square_tail(x, degrees) == pytest.approx(chdtrc(degrees, x), rel=1e-9, abs=1e-300)


def test_stopping_rule():
    # Boender and Rinnooy Kan 1987: (W (N - 1) / (N - W - 2)) minima are expected in all
    assert expected_unseen(3, 120) == pytest.approx(3 * 119 / 115 - 3)
    assert expected_unseen(3, 5) == np.inf


def _staged_case(number, sd=3.0):
    """Return a staged collision with Table 2's weights: 25 ft² on the squares of spins."""
    collision = next(c for c in collisions() if c.number == number)
    entries = {name: Amount.exactly(x) for name, x in collision.scene.items()}
    for name, x in collision.measured.items():
        if np.isfinite(x):
            entries[name] = Amount(x, -np.inf, np.inf, "normal", sd / 5 if name[0] == "W" else sd)
    return collision, entries


@pytest.mark.parametrize("number", [1, 5, 8, 9, 11])
def test_staged_collisions_have_the_friction_of_table_2(number):
    collision, entries = _staged_case(number)
    result = reconstruct(entries, samples=0)[0]
    assert result.verdict in ("agrees", "at a limit")
    assert -1e-6 <= result.values["E"] <= 1
    assert -1 - 1e-6 <= result.values["EM"] <= 1e-6
    assert abs(result.values["MUP"] - collision.coefficients["MUP"]) <= 0.1


@pytest.mark.parametrize("number", [6, 9])
def test_nearest_impact_within_physics_is_that_of_another_method(number):
    from scipy.optimize import minimize

    _, entries = _staged_case(number)
    problem = Problem(entries)
    search = Search(problem)
    start = search.run()[0][0].point / search.sizes

    def within(x):
        rows = problem.margins(problem.impacts(x[None] * search.sizes))
        return np.array([np.ravel(row)[0] for _, row in rows])

    ends = [
        minimize(
            lambda x: float((search.residuals(x[None])[0] ** 2).sum()),
            start + np.random.default_rng(k).normal(0, 0.3, len(start)) * bool(k),
            constraints=[{"type": "ineq", "fun": within}],
            method="SLSQP",
        )
        for k in range(4)
    ]
    best = min(end.fun for end in ends if within(end.x).min() > -1e-7)
    answer = Search(problem, limited=True).nearest([search.run()[0][0]])
    assert answer.squares == pytest.approx(best, rel=2e-3)


def test_what_is_open_and_what_would_help():
    result = reconstruct(SECTION_VII, samples=0)[0]
    assert {"WA", "WB", "WAF", "WBF", "E", "EM"} <= set(result.undetermined)
    assert result.advice == ("WAF", "WBF", "WA")
    complete_entries = {**SECTION_VII, "WAF": -2.9, "WBF": -0.9, "WA": 0}
    assert not reconstruct(complete_entries, samples=0)[0].undetermined
    assert list(result.drivers["UX"]) == ["VBX", "VAX"]
    assert result.drivers["UX"]["VBX"] == pytest.approx(145**2 / (145**2 + 96**2))
