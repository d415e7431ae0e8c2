"""Forward bounds against a grid and corners; quantiles, drivers, what cannot be used."""

from itertools import product

import numpy as np
import pytest

import impact88
from impact88.cases.amounts import Amount
from impact88.errors import UserError
from impact88.mechanics.solve import solve
from impact88.reconstruction.bounds import bounds

SAMPLE = {name: float(x) for name, x in impact88.sample(1).numbers().items()}
OUTPUTS = ("VAX", "WBF", "DVA", "LOSS", "PT")


@pytest.mark.parametrize("seed", range(4))
def test_no_value_of_a_grid_lies_outside(seed):
    rng = np.random.default_rng(seed)
    names = rng.choice(
        ["GA", "MU", "E", "EM", "DA", "PA", "UX", "VY", "MA", "WA"], 4, False
    ).tolist()
    widths = {
        "GA": 20,
        "MU": 0.5,
        "E": 0.2,
        "EM": 0.2,
        "DA": 2,
        "PA": 15,
        "UX": 8,
        "VY": 8,
        "MA": 20,
        "WA": 1,
    }
    limits = {n: SAMPLE[n] + widths[n] * np.array([-rng.random(), rng.random()]) for n in names}
    values = {**SAMPLE, **{n: f"{low} .. {high}" for n, (low, high) in limits.items()}}
    answer = bounds(values, OUTPUTS, samples=100)
    grids = np.meshgrid(*(np.linspace(*limits[n], 13) for n in names))
    reference = solve({**SAMPLE, **dict(zip(names, map(np.ravel, grids), strict=True))}, OUTPUTS)
    for name, bound in answer.outputs.items():
        width = bound.upper - bound.lower
        assert bound.lower <= reference[name].min() + 1e-6 * width
        assert bound.upper >= reference[name].max() - 1e-6 * width


def test_corners_are_reached_exactly():
    values = {**SAMPLE, "UX": "-31 .. -27", "VX": "12 .. 16", "E": "0 .. 0.1"}
    bound = bounds(values, "VAX", samples=100).outputs["VAX"]
    corners = product((-31, -27), (12, 16), (0, 0.1))
    results = [
        float(solve({**SAMPLE, "UX": a, "VX": b, "E": e}, "VAX")["VAX"]) for a, b, e in corners
    ]
    assert (bound.lower, bound.upper) == pytest.approx((min(results), max(results)), rel=1e-14)


def test_quantiles_drivers_and_warnings():
    answer = bounds({**SAMPLE, "GA": "-30 +- 5", "MU": "0.7 .. 0.9"}, ["DVA", "LOSS"])
    dva = answer.outputs["DVA"]
    assert (round(dva.lower, 3), round(dva.upper, 3)) == (10.947, 18.203)
    assert dva.quantiles[0.5] == pytest.approx(14.56, abs=0.02)
    assert list(dva.drivers) == ["GA", "MU"]
    assert dva.drivers["GA"] == pytest.approx(4.712, abs=0.01)
    assert answer.warnings["FRICTION_ABOVE_CRITICAL"] == pytest.approx(0.122, abs=0.005)


def test_correlations_narrow_the_draws_but_not_the_bounds():
    values = {**SAMPLE, "UX": "-31 .. -27", "VX": "12 .. 16"}
    alone, together = (
        bounds(values, "DVA", correlations=pairs).outputs["DVA"]
        for pairs in ({}, {("UX", "VX"): 0.95})
    )
    assert (alone.lower, alone.upper) == (together.lower, together.upper)
    assert np.diff(together.interval) < 0.6 * np.diff(alone.interval)


def test_monte_carlo_error_is_the_scatter_between_seeds():
    values = {**SAMPLE, "UX": "-31 .. -27"}
    answers = [bounds(values, "VAX", samples=400, seed=seed, limits=False) for seed in range(20)]
    ends = np.array([answer.outputs["VAX"].interval for answer in answers])
    scatter = ends.std(0, ddof=1).max() / (ends[:, 1] - ends[:, 0]).mean()
    assert 0.5 < answers[0].sampling_error / scatter < 2


@pytest.mark.parametrize("moment", [0.5, "0.4 .. 0.6", "normal 0 0.2"])
def test_equation_18_determines_no_moment_at_a_half(moment):
    with pytest.raises(UserError, match=r"EM may be 0\.5"):
        bounds({**SAMPLE, "UX": "-31 .. -27", "EM": moment}, "DVA", samples=10)
    points = {"M": 4, "MA": 3, "MB": 2, "UX": "-3 +- 1", "VX": 0, "GA": 0, "E": 0, "MU": 0}
    points |= {"UY": 0, "VY": 0, "EM": moment}
    assert bounds(points, "DVA", samples=10).outputs["DVA"].lower == pytest.approx(0.8)


def test_moving_the_contact_point_and_a_share_of_the_critical_friction():
    answer = bounds({**SAMPLE, "CX": "0 +- 1", "MU": "70 .. 90 %"}, "VAX DVA").outputs
    assert (round(answer["VAX"].lower, 3), round(answer["VAX"].upper, 3)) == (-16.299, -14.149)
    assert (round(answer["DVA"].lower, 3), round(answer["DVA"].upper, 3)) == (12.766, 15.143)


def test_inputs_that_no_wanted_result_uses_need_not_be_given():
    values = {"M": 4, "MA": 3000, "MB": 2000, "UX": "-40 +- 2", "UY": 3, "VX": 10, "VY": -20}
    assert list(bounds(values, "KI", samples=10).outputs) == ["KI"]
    with pytest.raises(UserError, match="DVA cannot be computed: missing E"):
        bounds(values, "DVA")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"UX": -29.0}, "no value is known within limits"),
        ({"MX": 3}, "MX"),
        ({"MB": float("nan")}, "MB"),
        ({"E": "many"}, "E"),
        ({"M": 5}, "M is 5; expected 6 for bodies or 4 for point masses"),
    ],
)
def test_what_cannot_be_used(change, words):
    with pytest.raises(UserError, match=words):
        bounds({**SAMPLE, "UX": "-29 +- 1", **change}, "DVA")
    with pytest.raises(UserError, match="contradict"):
        bounds(
            {**SAMPLE, "UX": "-29 +- 1", "VX": "12 .. 16", "VY": "24 .. 26"},
            "DVA",
            correlations={("UX", "VX"): 0.9, ("VX", "VY"): 0.9, ("UX", "VY"): -0.9},
        )


@pytest.mark.parametrize("name", ["MA", "MB", "IA", "IB"])
def test_limits_of_masses_and_inertias_lie_above_0(name):
    scene = dict(impact88.sample(1))
    middle = float(scene[name])
    for text in ("1 +- 1", "0 .. 3", "normal 3 1", Amount(middle, -1.0, 2 * middle, "uniform")):
        with pytest.raises(UserError, match=f"{name} is known within limits that reach 0"):
            bounds({**scene, name: text}, "DVA", samples=10)
    for text in (f"{middle} +- {0.9 * middle}", f"normal {middle} {0.3 * middle}"):
        assert bounds({**scene, name: text}, "DVA", samples=10).outputs["DVA"].lower > 0
