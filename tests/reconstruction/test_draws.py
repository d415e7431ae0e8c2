"""Draws against methods that share no code with them: rejection from forward impacts, emcee."""

import numpy as np
import pytest
from collisions import INTERSECTION, REAR_END, RECORDER, SECTION_VII, random_impact, section_vii

from impact88.cases.amounts import Amount, read
from impact88.mechanics.solve import evaluate, solve
from impact88.names import VELOCITIES
from impact88.reconstruction.answer import reconstruct
from impact88.reconstruction.densities import (
    draw_correlated,
    from_normal,
    log_density,
    sampling_error,
)
from impact88.reconstruction.draws import log_densities, sample
from impact88.reconstruction.problem import WIDEST, Problem
from impact88.reconstruction.words import remarks

LEVELS = (0.05, 0.5, 0.95)


def _within(low, high):
    return Amount((low + high) / 2, low, high, "uniform")


def _forward_problem(seed, polar):
    """Return known values: two final velocities loosely, one velocity before and all coefficients
    not at all; with the limits of the unknown velocity for rejection."""
    vehicles, truth = random_impact(np.random.default_rng([4, seed]))
    entries = {name: Amount.exactly(x) for name, x in vehicles.items()}
    entries |= {name: Amount.exactly(truth[name]) for name in VELOCITIES}
    entries["VX"] = _within(truth["VX"] - 3, truth["VX"] + 2)
    del entries["UX"], entries["UY"]
    course = np.degrees(np.arctan2(truth["UY"], truth["UX"]))
    if polar:
        entries["HA"] = _within(course - 3, course + 2)
    else:
        entries["UY"] = Amount.exactly(truth["UY"])
    entries["VAX"] = _within(truth["VAX"] - 4, truth["VAX"] + 6)
    entries["WBF"] = _within(truth["WBF"] - 0.3, truth["WBF"] + 0.5)
    return entries


def _rejection(entries, draws, count, rng):
    """Return impacts drawn from the prior and kept where all known values hold."""
    columns = {n: np.full(count, a.value) for n, a in entries.items() if not a.varies}
    columns["VX"] = rng.uniform(entries["VX"].low, entries["VX"].high, count)
    if "HA" in entries:  # flat over the speed, since the course is known
        limit = WIDEST * draws.problem.speed  # of what is not known
        speed = rng.uniform(0, min(1.3 * draws["SA"].max(), limit), count)
        course = np.radians(rng.uniform(entries["HA"].low, entries["HA"].high, count))
        columns |= {"UX": speed * np.cos(course), "UY": speed * np.sin(course)}
    else:
        low, high = draws["UX"].min(), draws["UX"].max()
        columns["UX"] = rng.uniform(low - (high - low) / 3, high + (high - low) / 3, count)
    columns |= {"E": rng.uniform(0, 1, count), "EM": rng.uniform(-1, 0, count)}
    low, high = draws["MUP"].min(), draws["MUP"].max()
    friction = rng.uniform(low - (high - low) / 3, high + (high - low) / 3, count)
    sliding = evaluate(columns, ("gt",))[0]["gt"]
    wanted = "VC PN LOSS MUC VAX WBF DVA DVB"
    results = solve({**columns, "MU": np.where(sliding > 0, -friction, friction)}, wanted)
    low, high = np.minimum(results["MUC"], 0), np.maximum(results["MUC"], 0)
    allowance = 0.2 * (high - low) + 0.1
    keep = (results["VC"] > 0) & (results["PN"] > 0) & (results["LOSS"] >= 0)
    keep &= (friction >= low - allowance) & (friction <= high + allowance)
    for name in ("VAX", "WBF"):
        keep &= (results[name] >= entries[name].low) & (results[name] <= entries[name].high)
    answer = {**columns, **results, "MUP": friction}
    return {name: np.broadcast_to(x, count)[keep] for name, x in answer.items()}


@pytest.fixture
def _few_particles(monkeypatch):
    """For what does not depend on their number."""
    monkeypatch.setattr("impact88.reconstruction.draws.PARTICLES", 1000)


@pytest.mark.parametrize("polar", [False, True])
def test_draws_are_those_of_rejection(polar):
    entries = _forward_problem(int(polar), polar)
    draws = sample(Problem(entries))
    survivors = _rejection(entries, draws, 600_000, np.random.default_rng(1))
    assert len(survivors["UX"]) > 2400
    for name in ("UX", "VX", "VAX", "WBF", "E", "EM", "MUP", "DVA", "DVB", "LOSS"):
        reference = np.quantile(survivors[name], LEVELS)
        off = np.abs(np.quantile(draws[name], LEVELS) - reference) / survivors[name].std()
        assert off.max() < 0.15, (name, off)


@pytest.mark.parametrize(
    "entries", [pytest.param(REAR_END | {"SA": "5.5 +- .5", "E": "normal .2 .05"}, id="rear end"),
              pytest.param(SECTION_VII, id="section VII", marks=pytest.mark.long)]
)  # fmt: skip
def test_draws_are_those_of_emcee(entries):
    emcee = pytest.importorskip("emcee")
    amounts = {name: read(name, str(value)) for name, value in entries.items()}
    problem = Problem(amounts)
    draws = sample(problem)
    d = len(problem.names)

    def log_density(points):
        state = log_densities(problem, points)
        return np.where(state.holds, state.prior + state.likelihood, -np.inf)

    walkers = max(4 * d, 40)
    moves = [(emcee.moves.DEMove(), 0.7), (emcee.moves.StretchMove(), 0.3)]
    sampler = emcee.EnsembleSampler(walkers, d, log_density, vectorize=True, moves=moves)
    sampler.random_state = np.random.RandomState(1).get_state()
    sampler.run_mcmc(draws.points[:walkers], 600 if d < 4 else 4000)
    chain = sampler.get_chain(discard=100, flat=True)
    for k in range(d):
        reference = np.quantile(chain[:, k], LEVELS)
        off = np.abs(np.quantile(draws.points[:, k], LEVELS) - reference) / chain[:, k].std()
        assert off.max() < 0.15, (problem.names[k], off)


@pytest.mark.parametrize("seed", [5, 7])  # from a uniform E and EM: no draws, no large losses
def test_draws_of_many_unknowns_lose_no_part_of_the_impacts(seed):
    vehicles, truth = random_impact(np.random.default_rng([7, 1]))
    entries = {name: Amount.exactly(x) for name, x in vehicles.items()}
    widths = dict.fromkeys(("VAX", "VAY", "VBX", "VBY"), 2) | {"WAF": 0.3, "WBF": 0.3}
    for name, width in {**widths, "UX": 3, "VY": 3}.items():
        entries[name] = _within(truth[name] - width, truth[name] + width)
    draws = sample(Problem(entries), 8000, seed)
    assert draws.families > 100
    assert np.quantile(draws["LOSS"], 0.95) == pytest.approx(97.2, abs=0.3)


def test_draws_of_section_vii():
    result = section_vii()
    assert -43.9 < np.quantile(result.draws["UX"], 0.05) < -43.4
    assert -36.9 < np.quantile(result.draws["UX"], 0.95) < -36.5
    low, high = result.intervals["SA"]
    # all corners: UX = VAX + 145/96 VBX
    assert 35.188 < low < result.values["SA"] < high < 45.229
    assert "reaches 0 and 1" in result.assumed["E"]
    assert 0 < result.intervals["E"][0] < 0.1
    assert "E" not in result.values
    exact = {**SECTION_VII, "VAX": -10, "VAY": 20, "VBX": -20, "VBY": 45}
    assert "SA" not in reconstruct(exact, samples=0)[0].intervals


@pytest.mark.usefixtures("_few_particles")
def test_draws_depend_on_the_seed_alone():
    problem = Problem({name: read(name, str(value)) for name, value in RECORDER.items()})
    first, repeat, other = (sample(problem, count=1000, seed=seed) for seed in (0, 0, 1))
    np.testing.assert_array_equal(first.points, repeat.points)
    assert not np.array_equal(first.points, other.points)
    assert first.families > 20


def test_monte_carlo_errors_are_the_scatter_between_seeds():
    entries = REAR | {"SA": "normal 25 5", "SB": "0 .. 10"}
    results = [reconstruct(entries, samples=1000, seed=seed)[0] for seed in range(12)]
    ends = np.array([result.intervals["SA"] for result in results])
    scatter = ends.std(0, ddof=1).max() / (ends[:, 1] - ends[:, 0]).mean()
    assert 0.5 < results[0].sampling_error / scatter < 2
    assert "intervals of 1,000 draws: Monte Carlo error of their ends" in " ".join(
        remarks(results[0])
    )


@pytest.mark.long
def test_monte_carlo_errors_of_moved_particles_are_not_too_small():
    problem = Problem(_forward_problem(0, False))
    draws = [sample(problem, count=8000, seed=seed) for seed in range(8)]
    for name in ("UX", "VX", "E", "EM", "MUP", "DVA"):
        ends = np.array([np.quantile(d[name], (0.05, 0.95)) for d in draws])
        errors = [
            sampling_error(d[name], tuple(end), d.family)
            for d, end in zip(draws, ends, strict=True)
        ]
        width = (ends[:, 1] - ends[:, 0]).mean()
        assert np.mean(errors) > 0.5 * ends.std(0, ddof=1).max() / width, name


REAR = {"M": 4, "MA": 42, "MB": 31, "HA": 0, "HB": 0, "SA": 40, "SB": 5, "E": 0.2}


@pytest.mark.parametrize(
    ("change", "name", "ends"),
    [
        ({"SA": "10 .. 40"}, "SA", (11.5, 38.5)),
        ({"SB": "0 .. 10"}, "SB", (0.5, 9.5)),
        ({"SA": "normal 25 5"}, "SA", (16.8, 33.2)),
        ({"SA": "triangular 10 10 40"}, "SA", (10, 30.51)),
        ({"SA": None, "SAF": "15 .. 35", "HAF": 0}, "SAF", (16, 34)),
    ],
)
def test_a_value_that_nothing_checks_is_distributed_as_stated(change, name, ends):
    result = reconstruct(REAR | change, samples=8000)[0]
    assert result.evidence.redundancy == 0
    assert result.intervals[name] == pytest.approx(ends, abs=0.25)


def test_draws_of_an_intersection_are_the_momentum_of_what_was_drawn():
    entries = INTERSECTION | {"SAF": "20 .. 60", "HAF": "-45 .. -35", "SBF": "20 .. 40"}
    result = reconstruct(entries)[0]
    rng = np.random.default_rng(0)
    a, b = rng.uniform(20, 60, 200_000), rng.uniform(20, 40, 200_000)
    course = np.radians(rng.uniform(-45, -35, 200_000))
    x = 1800 * a * np.cos(course) + 1200 * b * np.cos(np.radians(-30))
    y = 1800 * a * np.sin(course) + 1200 * b * np.sin(np.radians(-30))
    for name, reference in {"SA": x / 1800, "SB": -y / 1200, "SAF": a, "SBF": b}.items():
        off = np.quantile(result.draws[name], LEVELS) - np.quantile(reference, LEVELS)
        assert np.abs(off).max() < 0.05 * reference.std(), name


@pytest.mark.parametrize(
    ("change", "verdict"), [("11.8 +- .37", "agrees"), ("11.8 +- .3", "contradictory")]
)
def test_draws_that_fail_contradict_nothing(monkeypatch, change, verdict):
    """The best fit has SA beyond its limits; within all limits there is an impact, or none."""
    monkeypatch.setattr("impact88.reconstruction.answer.sample", lambda *options: None)
    entries = {"M": 4, "MA": 42, "MB": 31, "HA": 0, "SB": 0, "E": 0.1, "SA": "28 +- 2"}
    result = reconstruct({**entries, "DVA": change})[0]
    assert result.tests["SA"].adjusted < 26
    assert result.verdict == verdict


@pytest.mark.usefixtures("_few_particles")
def test_values_known_exactly_have_no_interval():
    entries = {"M": 4, "MA": 1500, "MB": 1200, "HA": 0, "HB": 90, "SAF": "16 +- .1"}
    result = reconstruct(
        {**entries, "SBF": "16 +- .1", "HAF": "43 +- 3", "HBF": "45 +- 3"}, samples=1000
    )[0]
    assert {"HA", "HB"}.isdisjoint(result.intervals)
    assert {"SA", "SB"} <= result.intervals.keys()


def test_a_normal_course_beside_a_half_turn_is_not_cut():
    entries = {"M": 4, "MA": 155, "MB": 78, "SA": "normal 20 .6", "HA": 0, "SB": "normal 40 1.2"}
    result = reconstruct({**entries, "HB": "normal 180 5", "E": 0, "MU": -10})[0]
    low, high = result.intervals["VY"]
    assert low == pytest.approx(-high, rel=0.1)


def test_no_impact_within_all_limits():
    entries = {"M": 4, "MA": 1, "MB": 1, "HA": 0, "SA": "10 +- 1", "SB": 0, "E": "0 .. 0.1"}
    result = reconstruct({**entries, "SBF": "8 +- .1", "HBF": 0})[0]
    assert result.verdict == "contradictory"
    assert not result.draws


@pytest.mark.parametrize(
    "amount",
    [
        Amount(1.0, 0.0, 3.0, "triangular"),
        Amount(2.0, 1.0, 3.0, "uniform"),
        Amount(0.0, -np.inf, np.inf, "normal", 2.0),
        Amount(0.0, -1.0, 3.0, "normal", 2.0),
    ],
)
def test_densities(amount):
    rng = np.random.default_rng(0)
    values = from_normal(amount, rng.standard_normal(200_000))
    ends = np.quantile(values, np.linspace(0.02, 0.98, 40))
    middle = (ends[1:] + ends[:-1]) / 2
    measurements = 0.96 / 39 / np.diff(ends)
    density = np.exp(log_density(amount, middle))
    np.testing.assert_allclose(
        measurements / measurements.mean(), density / density.mean(), rtol=0.1
    )


def test_correlated_values():
    amounts = {"MA": Amount(2.0, 1.0, 3.0, "uniform"), "IA": Amount(2.0, 1.0, 3.0, "uniform")}
    draws = draw_correlated(amounts, 50_000, np.random.default_rng(0), {("MA", "IA"): 0.8})
    reference = 6 / np.pi * np.arcsin(0.4)  # rank correlation of a Gaussian copula
    assert np.corrcoef(draws.T)[0, 1] == pytest.approx(reference, abs=0.01)


@pytest.mark.parametrize("speed", [40, 38])
def test_a_result_at_its_least_value_has_an_interval(speed):
    known = {"M": 4, "MA": 5000, "MB": 2500, "SA": "20 +- 2", "HA": 0, "TA": 0}
    result = reconstruct(known | {"SB": f"{speed} +- 2", "HB": 180, "TB": 180, "E": 0})[0]
    rng = np.random.default_rng(0)  # momentum of 20,000 plastic impacts
    draws = rng.uniform(18, 22, 20_000), rng.uniform(speed - 2, speed + 2, 20_000)
    common = np.abs(5000 * draws[0] - 2500 * draws[1]) / 7500
    assert result.values["SAF"] == pytest.approx(abs(100 - 2.5 * speed) / 7.5, abs=1e-6)
    low, high = (0, np.quantile(common, 0.9)) if speed == 40 else np.quantile(common, (0.05, 0.95))
    assert result.intervals["SAF"] == pytest.approx((low, high), abs=0.03)
    if speed == 38:  # both stop, or go on to either side: no course is excluded
        assert result.intervals["HAF"] == (-180, 180)


@pytest.mark.parametrize("speed", [40, 39.9])
def test_contact_points_that_do_not_approach_are_remarked(speed):
    known = {"M": 4, "MA": 3000, "MB": 3000, "SA": 40, "HA": 0, "SB": speed, "HB": 0, "E": 0.1}
    result = reconstruct(known | {"TA": 0, "TB": 0}, samples=0)[0]
    assert any("do not approach" in line for line in remarks(result)) == (speed == 40)
