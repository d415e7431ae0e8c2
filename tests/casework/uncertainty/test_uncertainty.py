"""Ranges and distributions, bounds, draws and drivers."""

from __future__ import annotations

import math
import os
from statistics import NormalDist
from typing import ClassVar

import numpy as np
import pytest

from impact88.casework.uncertainty.bounds import RECONSTRUCTED, _ranks, bounds
from impact88.casework.uncertainty.boundstable import as_json, table
from impact88.casework.uncertainty.ranges import input_names, read_correlations, read_inputs
from impact88.collision import uncertain
from impact88.collision.casescene import sample
from impact88.collision.uncertain import Uncertain, fixed_value, read
from impact88.errors import UserError
from impact88.bench.populations import scenes
from impact88.mechanics.closedform.general import quantities
from impact88.mechanics.closedform.solve import solve
from impact88.mechanics.outcome import forward_model, reconstruction_model
from impact88.names import FINAL_VELOCITIES, SCENE, VELOCITIES, quantity
from impact88.status import Status


def values(number: int = 1, **ranges: str) -> dict[str, Uncertain]:
    """A sample's values, some of them as ranges."""
    return read_inputs(dict(sample(number)), ranges).values


def reconstruction(number: int = 1, **ranges: str) -> dict[str, Uncertain]:
    return read_inputs(dict(sample(number)), ranges, "reconstruction").values


BRUTE_SCENES = int(os.environ.get("IMPACT88_BRUTE_SCENES") or 1)
OUTPUTS = FINAL_VELOCITIES if BRUTE_SCENES > 1 else ("VAY", "WAF", "VBX")


class TestNotation:
    @pytest.mark.parametrize(
        ("text", "kind", "low", "nominal", "high"),
        [
            ("0.911", "fixed", 0.911, 0.911, 0.911),
            ("-.5", "fixed", -0.5, -0.5, -0.5),
            ("5E-03", "fixed", 0.005, 0.005, 0.005),
            ("0.7 .. 0.9", "uniform", 0.7, 0.8, 0.9),
            ("1..2", "uniform", 1, 1.5, 2),
            ("-3 ..  -1", "uniform", -3, -2, -1),
            ("8 +- 2", "uniform", 6, 8, 10),
            ("8±2", "uniform", 6, 8, 10),
            ("-40 +- 5%", "uniform", -42, -40, -38),
            ("uniform 1 3", "uniform", 1, 2, 3),
            ("triangular 1 1.5 3", "triangular", 1, 1.5, 3),
            ("normal 2 0.5", "normal", -math.inf, 2, math.inf),
            ("normal 2 0.5 within 1 .. 4", "normal", 1, 2, 4),
            ("2 .. 2", "fixed", 2, 2, 2),
            ("normal 2 0", "fixed", 2, 2, 2),
        ],
    )
    def test_reads(self, text, kind, low, nominal, high):
        item = read(text, "MU")
        assert item.kind == kind
        assert (item.low, item.nominal, item.high) == pytest.approx((low, nominal, high))

    def test_half_width_around_the_scenes_value(self):
        assert read("+- 10%", "UX", -30.0).limits(3) == pytest.approx((-33, -27))
        assert read("+- 2", "UX", -30.0).nominal == -30

    def test_the_scenes_value_stays_nominal_inside_a_range(self):
        assert read("0.7 .. 1", "MU", 0.911).nominal == 0.911
        assert read("0.7 .. 0.8", "MU", 0.911).nominal == 0.75

    @pytest.mark.parametrize(
        ("text", "says"),
        [
            ("", "is not an amount"),
            ("0.7 to 0.9", "is not an amount"),
            ("0.9 .. 0.7", "out of order"),
            ("triangular 1 4 3", "out of order"),
            ("-1e308 .. 1e308", "wider than the range of doubles"),
            ("0 +- 1e308", "wider than the range of doubles"),
            ("normal 1 -1", "negative standard deviation"),
            ("normal 5 1 within 1 .. 2", "mean outside"),
            ("8 +- -2", "negative half width"),
            ("+- 2", "no middle"),
            ("1e999 .. 2", "too large"),
            ("normal 1", "is not an amount"),
        ],
    )
    def test_refuses(self, text, says):
        with pytest.raises(UserError, match=says) as caught:
            read(text, "MU")
        assert str(caught.value).startswith("MU: ")
        assert "\n" not in str(caught.value)

    def test_limits_of_a_normal(self):
        assert read("normal 2 0.5", "E").limits(2) == (1, 3)
        assert read("normal 2 0.5 within 1.5 .. 9", "E").limits(2) == (1.5, 3)


class TestDraws:
    COUNT = 200_000

    @pytest.mark.parametrize(
        "text",
        ["1 .. 3", "triangular 1 1.4 3", "normal 2 0.5", "normal 2 0.5 within 1.5 .. 4"],
    )
    @pytest.mark.parametrize("way", ["alone", "copula"])
    def test_shares_below(self, text, way):
        item = read(text, "E")
        rng = np.random.default_rng(5)
        if way == "alone":
            drawn = item.draws(rng, self.COUNT)
        else:
            drawn = item.from_normal(rng.standard_normal(self.COUNT))
        shares = [0.01, 0.1, 0.25, 0.5, 0.75, 0.9, 0.99]
        found = [np.mean(drawn <= item.quantile(share)) for share in shares]
        # five standard errors
        assert found == pytest.approx(shares, abs=5 * 0.5 / math.sqrt(self.COUNT))
        assert drawn.min() >= item.low
        assert drawn.max() <= item.high

    def test_quantile_of_a_cut_normal(self):
        item = read("normal 0 1 within -1 .. 2", "E")
        standard = NormalDist()
        below = standard.cdf(-1)
        share = (standard.cdf(0.5) - below) / (standard.cdf(2) - below)
        assert item.quantile(share) == pytest.approx(0.5, rel=1e-12)
        assert (item.quantile(0), item.quantile(1)) == (-1, 2)

    def test_table_error_is_what_it_says(self):
        item = read("triangular 0 0.3 1", "E")
        variates = np.linspace(-4, 4, 4001)
        exact = [item.quantile(NormalDist().cdf(z)) for z in variates.tolist()]
        assert np.max(np.abs(item.from_normal(variates) - exact)) < 1e-6


def beside_the_tie(number: int, seed: int) -> dict[str, float]:
    """A car of the casework with UY such that gt = 0 but for rounding: line 400 is undecided."""
    scene = {name: float(v[number]) for name, v in scenes("casework", number + 1, seed).items()}
    scene["MU"] = 0.2 + abs(scene["MU"])
    for _ in range(5):
        slip = float(quantities(scene, ["gt"])["gt"])
        scene["UY"] -= slip / math.cos(math.radians(scene["GA"]))
    return scene


class TestSignOfFriction:
    """Results jump where line 400 turns MU: each side is searched as a smooth branch."""

    HALF_WIDTHS: ClassVar = {
        **{"UX": 6.0, "UY": 6.0, "VX": 6.0, "VY": 6.0, "WA": 1.0, "WB": 1.0},
        **{"GA": 10.0, "PA": 5.0, "TB": 5.0, "MU": 0.1, "E": 0.1, "MA": 10.0, "IB": 200.0},
    }
    # IMPACT88_BRUTE_SCENES sets how many scenes (20: five minutes)
    SETS = (("UX", "UY"), ("GA", "MU"), ("UX", "VY", "GA"), ("WA", "WB", "UY"), ("PA", "TB", "MA"))

    @pytest.mark.parametrize("names", SETS if BRUTE_SCENES > 1 else SETS[2:3], ids=" ".join)
    def test_no_scene_tried_lies_outside(self, names):
        """Against forty thousand scenes, half of them on faces, and steps towards better ones: no
        more than a thousandth of the range is missing."""
        rng = np.random.default_rng(400)
        for number in range(BRUTE_SCENES):
            scene = beside_the_tie(number, 31)
            ranges = {
                name: Uncertain(
                    "uniform",
                    scene[name],
                    scene[name] - self.HALF_WIDTHS[name],
                    scene[name] + self.HALF_WIDTHS[name],
                )
                for name in names
            }
            known = {name: fixed_value(value) for name, value in scene.items()}
            found = bounds({**known, **ranges}, OUTPUTS, samples=2).bounds

            low, width = (
                np.array([getattr(ranges[name], end) for name in names]) for end in ("low", "high")
            )
            width = width - low

            def tried(share, scene=scene, low=low, width=width):
                """Values of each name, negated, then as they are: 2m x n."""
                columns = dict(zip(names, (low + share * width).T, strict=True))
                solved = forward_model({**scene, **columns}, OUTPUTS)[0]
                values = np.array([solved[name] for name in OUTPUTS])
                return np.concatenate([-values, values])

            bound = np.array([(-b.lower, b.upper) for b in found.values()]).T.ravel()
            slack = 1e-3 * np.tile(np.add(*bound.reshape(2, -1)), 2)
            share = rng.random((40_000, len(names)))
            share[::2] = np.where(
                rng.random(share[::2].shape) < 0.5, np.round(share[::2]), share[::2]
            )
            every, best = np.arange(len(bound))[:, None], share[np.argsort(-tried(share))[:, :5]]
            for step in 0.4 ** np.arange(2, 9):
                near = best[:, :, None] + step * rng.standard_normal(
                    (len(bound), 5, 40, len(names))
                )
                near = np.clip(near, 0, 1).reshape(len(bound), 200, -1)
                near = np.concatenate([best, near], axis=1)
                heights = tried(near.reshape(-1, len(names))).reshape(len(bound), len(bound), -1)
                heights = heights[every[:, 0], every[:, 0]]
                assert (heights.max(axis=1) <= bound + slack).all(), (number, names)
                best = near[every, np.argsort(-heights)[:, :5]]

    def test_every_bound_is_attained_or_approached(self):
        scene = beside_the_tie(0, 31)
        around = {n: fixed_value(v) for n, v in scene.items()}
        around["UY"] = Uncertain("uniform", scene["UY"], scene["UY"] - 6, scene["UY"] + 6)
        for name, bound in bounds(around, ["VAX", "MUP"], samples=2).bounds.items():
            for value, inputs in ((bound.lower, bound.at_lower), (bound.upper, bound.at_upper)):
                assert forward_model({**scene, **inputs}, [name])[0][name] == pytest.approx(value)
        assert (bound.lower, bound.upper) == (-scene["MU"], scene["MU"])


class TestPoles:
    """Run 1 has no solution at MU = 3.19214...: beside it results are as large as one likes."""

    def test_a_pole_inside_is_no_extreme(self):
        found = bounds(values(MU="3 .. 3.4"), ["VAX", "DVA", "LOSS", "MUP", "KI"], samples=2)
        limits = {name: (bound.lower, bound.upper) for name, bound in found.bounds.items()}
        assert limits["VAX"] == (-math.inf, math.inf)
        assert limits["DVA"] == (pytest.approx(448.2129, rel=1e-6), math.inf)
        assert limits["LOSS"] == (-math.inf, pytest.approx(-55080.65, rel=1e-6))
        assert limits["MUP"] == (3, 3.4)
        assert found.bounds["VAX"].at_upper["MU"] == pytest.approx(3.192144, abs=1e-5)

    def test_a_range_that_ends_before_it_has_bounds(self):
        found = bounds(values(MU="3 .. 3.192"), ["VAX", "LOSS"], samples=2)
        assert all(np.isfinite([b.lower, b.upper]).all() for b in found.bounds.values())
        assert found.bounds["VAX"].upper > 10_000

    def test_critical_friction_has_poles_of_its_own(self):
        ranges = {"UX": "+- 30", "UY": "+- 30", "GA": "+- 30", "PA": "+- 40"}
        found = bounds(values(**ranges), ["MUC", "VAX"], samples=2).bounds
        assert (found["MUC"].lower, found["MUC"].upper) == (-math.inf, math.inf)
        assert np.isfinite([found["VAX"].lower, found["VAX"].upper]).all()

    def test_reconstruction(self):
        found = bounds(
            reconstruction(MUP="3.5 .. 4"), ["UX", "DVA"], problem="reconstruction", samples=2
        ).bounds
        assert (found["UX"].lower, found["UX"].upper) == (-math.inf, math.inf)
        assert found["DVA"].upper == math.inf

    def test_table_and_json_say_so(self):
        found = bounds(values(MU="3 .. 3.4"), ["DVA"], samples=50)
        assert "inf: unbounded; somewhere in the ranges the equations have no solution" in table(
            found
        )
        told = as_json(found)["outputs"]["DVA"]
        assert (told["upper"], told["unbounded"]) == (None, ["upper"])


class TestCopula:
    INPUTS: ClassVar = {
        "UX": read("1 .. 2", "UX"),
        "VX": read("1 .. 2", "VX"),
        "E": fixed_value(0.1),
    }

    def test_correlation_of_the_variates(self):
        names, root = uncertain.correlation_root({("UX", "VX"): -0.6}, self.INPUTS)
        assert names == ["UX", "VX"]
        assert root.T @ root == pytest.approx(np.array([[1, -0.6], [-0.6, 1]]), abs=1e-14)

    def test_whole_correlation_is_allowed(self):
        _, root = uncertain.correlation_root({("UX", "VX"): 1.0}, self.INPUTS)
        assert root[:, 0] == pytest.approx(root[:, 1], abs=1e-7)

    @pytest.mark.parametrize(
        ("pairs", "says"),
        [
            ({("UX", "E"): 0.5}, "E does not vary; those that do: UX VX"),
            ({("UX", "UX"): 1.0}, "with itself"),
            ({("UX", "VX"): 1.5}, "not a correlation"),
            ({("UX", "VX"): math.nan}, "not a correlation"),
            ({("UX", "VX"): 0.5, ("VX", "UX"): 0.4}, "twice"),
        ],
    )
    def test_refuses(self, pairs, says):
        with pytest.raises(UserError, match=says):
            uncertain.correlation_root(pairs, self.INPUTS)

    def test_contradiction(self):
        inputs = {name: read("1 .. 2", name) for name in ("UX", "VX", "VY")}
        pairs = {("UX", "VX"): 0.9, ("UX", "VY"): 0.9, ("VX", "VY"): -0.9}
        with pytest.raises(UserError, match=r"UX, VX, VY contradict .* -0\.8\)"):
            uncertain.correlation_root(pairs, inputs)
        uncertain.correlation_root({**pairs, ("VX", "VY"): 0.9}, inputs)


RANGES = {"MU": "0.6 .. 1.2", "GA": "+- 10", "UX": "+- 10%"}


@pytest.fixture(scope="module")
def found():
    return bounds(values(1, **RANGES), samples=10_000, seed=3, keep_draws=True)


class TestForward:
    RANGES = RANGES

    def test_bounds_are_attained(self, found):
        known = {name: item.nominal for name, item in values(1, **self.RANGES).items()}
        for name, bound in found.bounds.items():
            for at, value in ((bound.at_lower, bound.lower), (bound.at_upper, bound.upper)):
                assert forward_model({**known, **at}, [name])[0][name] == value
                for source, (low, high) in found.limits.items():
                    assert low <= at[source] <= high

    def test_no_draw_lies_outside(self, found):
        for name, bound in found.bounds.items():
            assert found.draws[name].min() >= bound.lower
            assert found.draws[name].max() <= bound.upper

    def test_no_scene_of_a_fine_grid_lies_outside(self, found):
        axes = [np.linspace(*found.limits[name], 61) for name in self.RANGES]
        grid = dict(zip(self.RANGES, map(np.ravel, np.meshgrid(*axes)), strict=True))
        rest = {name: item.nominal for name, item in values(1).items()}
        solved = forward_model({**rest, **grid}, list(found.bounds))[0]
        for name, bound in found.bounds.items():
            slack = 1e-9 * (bound.upper - bound.lower)
            assert solved[name].min() >= bound.lower - slack
            assert solved[name].max() <= bound.upper + slack

    def test_loss_turns_around_inside(self, found):
        loss = found.bounds["LOSS"]
        assert loss.upper > loss.corner_upper + 0.1
        low, high = found.limits["GA"]
        assert low < loss.at_upper["GA"] < high

    def test_spreads_are_those_of_the_draws(self, found):
        for name, spread in found.spreads.items():
            draws = found.draws[name]
            assert spread.mean == pytest.approx(draws.mean())
            assert spread.deviation == pytest.approx(draws.std(ddof=1))
            for share, value in spread.quantiles.items():
                assert value == np.quantile(draws, share)

    def test_drives_of_one_input_alone(self):
        found = bounds(values(1, UX="-32 .. -26"), ["VAX", "DVA"], samples=2000)
        # A faster means A pushed harder: VAX falls with -UX, DVA grows
        assert found.drives["DVA"]["UX"].rank_correlation == pytest.approx(-1)
        drive, bound = found.drives["DVA"]["UX"], found.bounds["DVA"]
        assert (drive.at_high, drive.at_low) == (bound.lower, bound.upper)
        assert drive.swing == bound.upper - bound.lower

    def test_rank_correlation_of_ties(self):
        # the pivot's printed MU does not vary; its rank correlation does not exist
        found = bounds(values(1, UX="+- 1", MU="-10"), ["MUP"], samples=100)
        assert math.isnan(found.drives["MUP"]["UX"].rank_correlation)

    def test_seed(self):
        again = [
            bounds(values(1, **self.RANGES), ["DVA"], samples=500, seed=seed, keep_draws=True)
            for seed in (1, 1, 2)
        ]
        assert (again[0].draws["DVA"] == again[1].draws["DVA"]).all()
        assert (again[0].draws["DVA"] != again[2].draws["DVA"]).all()
        assert again[0].bounds == again[1].bounds

    def test_more_draws_begin_with_the_same(self):
        few, many = (
            bounds(values(1, **self.RANGES), ["DVA"], samples=n, keep_draws=True).draws["DVA"]
            for n in (40_000, 70_000)
        )
        assert (few[:32_768] == many[:32_768]).all()

    def test_correlation_narrows_a_difference(self):
        # point masses along x: VAX is linear in UX and VX, so its variance is known
        ranges = {"UX": "normal -30 2", "VX": "normal 10 1", "GA": "0", "MU": "0", "E": "0"}
        scene = values(2, **ranges)
        share = scene["MB"].nominal / (scene["MA"].nominal + scene["MB"].nominal)
        for correlation in (-0.8, 0.0, 0.8):
            pairs = {("UX", "VX"): correlation} if correlation else {}
            found = bounds(scene, ["VAX"], samples=100_000, correlations=pairs)
            a, b = (1 - share) * 2, share * 1
            expected = math.sqrt(a**2 + b**2 + 2 * correlation * a * b)
            assert found.spreads["VAX"].deviation == pytest.approx(expected, rel=0.01)

    def test_sigmas_say_where_a_normal_ends(self):
        wide, narrow = (
            bounds(values(2, UX="normal -30 2"), ["DVA"], samples=10, sigmas=k).limits["UX"]
            for k in (3, 1)
        )
        assert wide == (-36, -24)
        assert narrow == (-32, -28)

    def test_warnings_are_shares(self, found):
        known = {name: item.nominal for name, item in values(1).items()}
        assert 0 < found.warnings["FRICTION_ABOVE_CRITICAL"] < 1
        assert forward_model({**known, "MU": 1.2, "GA": -20}, ["STATUS"])[0]["STATUS"] & 4096

    def test_exclude(self):
        scene = values(1, MU="0.6 .. 1.2")
        everything = bounds(scene, ["MUP", "DVA"], samples=5000)
        critical = float(forward_model({**sample_numbers(1), "MU": 0}, ["MUC"])[0]["MUC"])
        allowed = bounds(scene, ["MUP", "DVA"], samples=5000, exclude=["FRICTION_ABOVE_CRITICAL"])
        assert everything.bounds["MUP"].upper == 1.2
        assert everything.bounds["MUP"].upper_warnings == ("FRICTION_ABOVE_CRITICAL",)
        assert allowed.bounds["MUP"].upper == pytest.approx(critical, abs=1e-6)
        assert allowed.bounds["MUP"].upper_warnings == ()
        assert allowed.unusable == pytest.approx((1.2 - critical) / 0.6, abs=0.02)
        assert allowed.bounds["DVA"].upper < everything.bounds["DVA"].upper

    def test_point_masses_have_no_spins(self):
        assert "WAF" not in bounds(values(2, UX="+- 1"), samples=10).bounds

    def test_jump_where_the_sign_of_friction_turns(self):
        # UY carries the sliding through gt = 0, where line 400 turns MU's sign
        scene = values(2, UY="-20 .. 60")
        found = bounds(scene, ["PT"], samples=4000, keep_draws=True).bounds["PT"]
        assert found.lower < 0 < found.upper


def sample_numbers(number):
    return {name: float(text) for name, text in sample(number).items()}


class TestRefusals:
    @pytest.mark.parametrize(
        ("changes", "options", "says"),
        [
            ({"M": read("4 .. 6", "M")}, {}, "M: expected 6"),
            ({"MU": read("-12 .. 1", "MU")}, {}, "MU: a range must not include -10"),
            ({"XX": fixed_value(1)}, {}, "'XX' is not a value"),
            ({}, {"outputs": ["FOO"]}, "'FOO' is not a result"),
            ({}, {"outputs": []}, "no result is asked for"),
            ({}, {"samples": 1}, "too few"),
            ({}, {"sigmas": 0.0}, "span nothing"),
            ({}, {"quantiles": [2.0]}, "not a quantile"),
            ({}, {"problem": "sideways"}, "not a problem"),
            ({}, {"exclude": ["BAD"]}, "not a warning"),
            ({"MA": fixed_value(0)}, {}, "no finite value at the nominal"),
        ],
    )
    def test_refuses(self, changes, options, says):
        with pytest.raises(UserError, match=says):
            bounds({**values(1, UX="+- 1"), **changes}, **options)

    def test_missing(self):
        scene = values(1, UX="+- 1")
        del scene["GA"]
        with pytest.raises(UserError, match="GA missing; the forward problem needs it"):
            bounds(scene)


class TestReconstruction:
    @pytest.mark.parametrize("number", [1, 3])
    def test_finds_the_samples_velocities_again(self, number):
        inputs = reconstruction(number, E="+- 1%")
        found = bounds(inputs, problem="reconstruction", samples=100)
        scene = sample_numbers(number)
        for name in VELOCITIES:
            assert found.bounds[name].nominal == pytest.approx(scene[name], abs=1e-9)
        assert found.bounds["SA"].nominal == pytest.approx(abs(scene["UX"]), abs=1e-9)

    def test_agrees_with_the_forward_solution(self):
        """Loss, ΔV, impulses and critical friction of the impact found are the forward ones."""
        inputs = {name: item.nominal for name, item in reconstruction(3).items()}
        found = reconstruction_model(inputs, RECONSTRUCTED)[0]
        names = ["DVA", "DVB", "KI", "KF", "LOSS", "PN", "PT", "PM", "MUC"]
        solved = forward_model(sample_numbers(3), names)[0]
        for name in names:
            assert found[name] == pytest.approx(solved[name], rel=1e-10), name

    def test_status_agrees_with_the_forward_solution(self):
        rng = np.random.default_rng(2)
        count = 400
        scene = {**sample_numbers(3), "E": rng.uniform(0.05, 1.2, count)}
        scene |= {
            "MU": rng.uniform(0, 2, count),
            "EM": rng.uniform(-1, -0.1, count),
            "UX": rng.uniform(-60, 60, count),
            "VY": rng.uniform(-60, 60, count),
            "WA": rng.uniform(-2, 2, count),
        }
        forward = forward_model(scene, [*FINAL_VELOCITIES, "MUP", "STATUS"])[0]
        inputs = {name: scene[name] for name in input_names("reconstruction") if name in scene}
        inputs |= {name: forward[name] for name in (*FINAL_VELOCITIES, "MUP")}
        found = reconstruction_model(inputs, ["STATUS", *VELOCITIES])[0]
        for name in VELOCITIES:
            assert np.broadcast_to(scene[name], count) == pytest.approx(found[name], abs=1e-7)
        # the condition of the forward equations is no matter of a reconstruction
        forward["STATUS"] &= ~np.uint16(Status.SINGULAR)
        assert found["STATUS"].tolist() == forward["STATUS"].tolist()
        assert len(set(forward["STATUS"].tolist())) > 5  # the scenes do differ

    @pytest.mark.parametrize(("typed", "share"), [("0.3", None), ("-0.3", 1.0)])
    def test_friction_that_drives_is_told(self, typed, share):
        # line 400 makes a positive MU oppose the sliding and a negative one push it on
        texts = {**sample(3), "MU": typed}
        inputs = read_inputs(texts, {"VAX": "+- 0.1"}, "reconstruction").values
        found = bounds(inputs, ["SA"], problem="reconstruction", samples=200)
        assert found.warnings.get("FRICTION_WRONG_DIRECTION") == share

    @pytest.mark.parametrize(
        ("changes", "says"),
        [
            ({"MUP": fixed_value(-10)}, "MUP: the pivot"),
            ({"E": fixed_value(0)}, "no reconstruction at E = 0"),
            ({"E": read("-.1 .. .2", "E")}, "no reconstruction at E = 0"),
            ({"EM": read("-.5 .. 0", "EM")}, "no reconstruction at EM = 0"),
        ],
    )
    def test_refuses_what_cannot_be_reconstructed(self, changes, says):
        with pytest.raises(UserError, match=says):
            bounds({**reconstruction(3, VAX="+- 1"), **changes}, problem="reconstruction")

    def test_point_masses_need_no_moment_coefficient(self):
        scene = {**reconstruction(2, VAX="+- 1"), "EM": fixed_value(0)}
        assert "WA" not in bounds(scene, problem="reconstruction", samples=10).bounds


class TestInputs:
    def test_finals_of_the_forward_solution(self):
        inputs = read_inputs(dict(sample(1)), {"VAX": "+- 1"}, "reconstruction")
        assert inputs.values["VAX"].limits(3) == pytest.approx((-14.2626557, -12.2626557))
        assert inputs.values["VBY"] == fixed_value(inputs.values["VBY"].nominal)
        assert set(inputs.derived) == {"VAY", "VBX", "VBY", "WAF", "WBF", "MUP"}

    def test_friction_takes_the_sign_of_line_400(self):
        # turned by 180 degrees, run 1 slides the other way
        texts = {**sample(1), "MU": "0.3 .. 0.5", "GA": "150"}
        inputs = read_inputs(texts, {}, "reconstruction")
        assert inputs.values["MUP"].limits(3) == (-0.5, -0.3)
        inputs = read_inputs({**texts, "GA": "-30"}, {}, "reconstruction")
        assert inputs.values["MUP"].limits(3) == (0.3, 0.5)

    def test_finals_of_the_file(self):
        texts = dict(sample(3)) | dict.fromkeys(FINAL_VELOCITIES, "1") | {"MUP": "-.4"}
        for name in VELOCITIES:
            del texts[name]
        inputs = read_inputs(texts, {}, "reconstruction")
        assert inputs.derived == ()
        assert inputs.values["MUP"].nominal == -0.4
        assert set(inputs.values) == set(input_names("reconstruction"))

    def test_mup_is_asked_for(self):
        texts = dict(sample(3)) | dict.fromkeys(FINAL_VELOCITIES, "1")
        with pytest.raises(UserError, match=r"MUP missing.*signed P_t/P_n"):
            read_inputs(texts, {}, "reconstruction")

    def test_a_file_serves_both_problems(self):
        texts = dict(sample(3)) | dict.fromkeys(FINAL_VELOCITIES, "1") | {"MUP": "-.4"}
        assert set(read_inputs(texts, {}).values) == set(SCENE)

    def test_correlations(self):
        assert read_correlations("UX,VX 0.5; ma , ia -.9", "x") == {
            ("UX", "VX"): 0.5,
            ("MA", "IA"): -0.9,
        }
        for bad in ("UX VX", "UX,VX", "UX,VX much", ",VX 0.5"):
            with pytest.raises(UserError, match="not a correlation"):
                read_correlations(bad, "x")

    @pytest.mark.parametrize("name", [*SCENE, *FINAL_VELOCITIES, "SA", "SB", "MUP"])
    def test_everything_has_a_unit(self, name):
        assert quantity(name).unit


@pytest.mark.parametrize("levels", [1, 3, 40, 10**9])
def test_ranks_count_what_is_smaller_and_half_of_what_is_equal(levels: int) -> None:
    values = np.random.default_rng(levels).integers(0, levels, 200) * 0.7
    smaller = (values < values[:, None]).sum(axis=1)
    equal = (values == values[:, None]).sum(axis=1) - 1
    expected = smaller + equal / 2
    np.testing.assert_array_equal(_ranks(values), expected - expected.mean())


def test_energy_is_judged_where_what_is_not_given_has_no_part_in_it() -> None:
    """Of point masses: without friction e above 1 gains energy, with an unknown one it may not."""
    values = {"M": 4.0, "MA": 100.0, "MB": 90.0, "GA": -30.0, "UX": -40.0, "UY": 0.0}
    values |= {"VX": 20.0, "VY": 25.0, "E": read("1.2 .. 1.5", "E")}
    known = bounds(values | {"MU": 0.0}, outputs=["VC"], samples=100)
    assert known.warnings["ENERGY_GAINED"] == 1
    assert bounds(values, outputs=["VC"], samples=100).warnings == {}


@pytest.mark.parametrize(("of_a", "of_b"), [(5, 10), (10, 5), (-5, -10), (-10, 5), (5, 0), (0, 5)])
def test_the_plane_across_a_line_is_the_one_that_solve_takes(of_a: float, of_b: float) -> None:
    """Whichever is faster, A approaches against the normal: VC and PN are above 0."""
    known = {"M": 4.0, "MA": 100.0, "MB": 90.0, "UX": of_a, "UY": 0.0, "VX": of_b, "VY": 0.0}
    found = bounds({**known, "E": read("0.2 .. 0.4", "E")}, outputs=["VC", "PN"], samples=2).bounds
    expected = solve({**known, "E": 0.3}, ("VC", "PN"))
    assert found["VC"].nominal == expected["VC"] == abs(of_a - of_b)
    assert found["PN"].nominal == pytest.approx(float(expected["PN"]))
    assert found["PN"].lower > 0
