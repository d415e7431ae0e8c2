"""impact88.solve: the reference cases, the rules of the listing, skipping, bad scenes, memory."""

from __future__ import annotations

import tracemalloc
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mixedscenes import mixed_scenes, same
from passes import passes
from worked_cases import RUN_1, reference_cases, scene_of

from impact88 import solve
from impact88.collision.units import MIRRORED
from impact88.errors import UserError
from impact88.mechanics import native
from impact88.mechanics.accuracy.errorbound import scales
from impact88.mechanics.accuracy.populations import POPULATIONS, scenes
from impact88.mechanics.accuracy.reference import fifty_digits
from impact88.mechanics.closedform.columns import BLOCK, examine, part, sources
from impact88.mechanics.closedform.impactprograms import program_for
from impact88.names import FINAL_VELOCITIES, RESULTS, SCENE
from impact88.status import Status

pytestmark = pytest.mark.usefixtures("both_machines")

FORWARD = [case for case in reference_cases() if case["kind"].startswith("forward")]
NUMBERS = tuple(name for name in RESULTS if name != "STATUS")


def expected(case):
    """Result name -> what the case says, as texts of 30 digits."""
    result = case["result"]
    final, contact, impulses = result["final"], result["contact_final"], result["impulses"]
    return {
        **dict(zip(("VAX", "VAY", "VBX", "VBY", "WAF", "WBF"), final.values(), strict=True)),
        **{name + "F": text for name, text in contact.items()},
        **{"PN": impulses["Pn"], "PT": impulses["Pt"], "PM": impulses["M"]},
        **{"KI": result["KE_initial"], "LOSS": result["KE_loss_percent"]},
    }


@pytest.mark.parametrize("case", FORWARD, ids=[case["name"] for case in FORWARD])
def test_reference_case(case):
    found = solve(scene_of(case))
    for name, text in expected(case).items():
        assert found[name] == pytest.approx(float(text), rel=1e-12, abs=1e-300), name
    mu = case["result"]["mu_used"]
    assert found["MUP"] == (-10 if mu is None else float(mu))
    assert found["KF"] == pytest.approx(found["KI"] * (1 - found["LOSS"] / 100), rel=1e-13)


MAX_ERROR = 1e-9  # of each result's scale: a thousand times what the worst population rounds to


def turning(name, count=30, seed=44):
    """A population whose vehicles both spin before the impact."""
    g = scenes(name, count, seed)
    rng = np.random.default_rng(seed)
    return {**g, "WA": rng.uniform(-3, 3, count), "WB": rng.uniform(-3, 3, count)}


POINTS = {"M": np.full(30, 4.0)}
PIVOTS = {"MU": np.full(30, -10.0)}
BARRIER = {
    **dict.fromkeys(("MB", "IB"), np.full(30, np.inf)),
    **dict.fromkeys(("VX", "VY", "WB"), np.zeros(30)),
}
KINDS = {
    "friction": {},
    "pivots": PIVOTS,
    "points": POINTS,
    "point pivots": {**POINTS, **PIVOTS},
    "barrier": BARRIER,
    "barrier pivots": {**BARRIER, **PIVOTS},
    "no arms": dict.fromkeys(("DA", "DB"), np.zeros(30)),
}
"""Kinds of scene whose formulas differ, as changes of cars that all spin."""


def check_against_reference(g):
    """Every result against 50 digits from the equations, which share no formula with `solve`."""
    found = solve(g, NUMBERS)
    count = len(g["MA"])
    rows = [fifty_digits({name: float(g[name][i]) for name in SCENE}) for i in range(count)]
    true = {
        name: np.array([float(row.get(name, np.nan)) for row in rows])
        for name in NUMBERS
        if name != "COND"
    }
    for name in true:
        missing = name != "MUC" and not np.isfinite(true[name]).any()
        assert not missing, f"{name} has no reference: compute it in accuracy/reference.py"
    scale = scales(g, {**found, **true})
    tolerance = MAX_ERROR * np.fmax(1, solve(g, ["COND"])["COND"] / 1000)
    for name, exact in true.items():
        assert np.array_equal(np.isfinite(exact), np.isfinite(found[name])), name
        if name in ("EESA", "EESB"):
            # the square root of a loss that is nearly nothing has half of its digits
            error = np.abs(found[name] ** 2 - exact**2)
            size = 2 * scale["KI"] / g["MA" if name == "EESA" else "MB"]
        else:
            error, size = np.abs(found[name] - exact), scale[name]
        wrong = error > tolerance * size
        assert not wrong.any(), (
            f"{name} in closedform/impact.py is not {name} in accuracy/reference.py: off by "
            f"{np.max(error[wrong])}"
        )


@pytest.mark.parametrize("name", POPULATIONS)
def test_every_result_of_every_population_is_the_reference(name):
    check_against_reference(scenes(name, 30, 43))


@pytest.mark.parametrize("kind", KINDS)
def test_every_result_of_spinning_cars_is_the_reference(kind):
    check_against_reference({**turning("casework"), **KINDS[kind]})


def test_barrier_case():
    case = next(case for case in reference_cases() if case["kind"].startswith("barrier"))
    wall = {"mb": "inf", "Ib": "inf", "db": "0", "pb": "0", "tb": "0"}
    scene = scene_of({"kind": "barrier", "input": {**case["input"], **wall}})
    told = case["result"]
    names = {"VAX": "Vax", "VAY": "Vay", "WAF": "Wa", "PN": "Pn", "PT": "Pt", "PM": "M"}
    names |= {"LOSS": "KE_loss_percent"}
    found = solve(scene)
    for name, theirs in names.items():
        assert found[name] == pytest.approx(float(told[theirs]), rel=1e-12), name
    assert found["VBX"] == found["VBY"] == found["WBF"] == found["DVB"] == 0
    pivot = solve({**scene, "MU": -10})
    for name in names:
        if names[name] in told["pivot"]:
            assert pivot[name] == pytest.approx(float(told["pivot"][names[name]]), rel=1e-12), name


def test_barrier_is_the_limit_of_a_growing_mass():
    still = {**RUN_1, "VX": 0, "VY": 0, "WB": 0}
    wall = solve({**still, "MB": np.inf, "IB": np.inf})
    sizes = 10.0 ** np.arange(6, 14)
    heavy = solve({**still, "MB": sizes, "IB": sizes * 20})
    away = np.abs(heavy["VAX"] / wall["VAX"] - 1)
    assert np.all(away < 1e4 / sizes)
    assert np.all(away[:-2] > 1 / sizes[:-2])  # and it is not the wall already


def test_a_scene_gets_the_same_bits_alone_and_among_others():
    """Skipping and sharing never change a digit: every path computes what the general one does."""
    g = mixed_scenes()
    together = solve(g)
    assert set(np.unique(together["STATUS"])) > {0, 64}
    for i in range(0, 4000, 27):
        alone = solve({name: values[i] for name, values in g.items()})
        for name in RESULTS:
            assert same(together[name][i : i + 1], alone[name].reshape(1)), (i, name)
    for name in RESULTS:
        zeros = together[name] == 0
        assert not np.signbit(together[name][zeros]).any(), name


def test_a_selection_gets_the_same_bits_as_all():
    g = mixed_scenes(500)
    everything = solve(g)
    for name in RESULTS:
        assert np.all(same(solve(g, [name])[name] * 1.0, everything[name] * 1.0)), name


@pytest.mark.parametrize("count", [7, 128, 2048, 2049, 6001])
@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_scenes_collected_from_afar_get_the_bits_of_numpy(count, share):
    """What is of another kind waits until a strip of such scenes is full."""
    g = {**scenes("casework", count, 3), "M": 6.0}
    rng = np.random.default_rng(count)
    g["MU"] = np.where(rng.random(count) < share, -10.0, g["MU"])
    g["TB"] = np.where(rng.random(count) < 0.02, 1e9, g["TB"])
    found = solve(g)
    with native.switched_off():
        expected = solve(g)
    for name in RESULTS:
        assert np.all(same(found[name] * 1.0, expected[name] * 1.0)), name


WALL = {"MB": np.inf, "IB": np.inf, "VX": 0.0, "VY": 0.0, "WB": 0.0}


@pytest.mark.parametrize(
    ("change", "usable"),
    [
        ({}, True),
        ({"VX": -0.0}, True),
        ({"VX": 1.0}, False),
        ({"WB": 1.0}, False),
        ({"MA": np.inf, "UX": 0.0, "UY": 0.0}, False),
        ({"IB": 2000.0, "WB": 1.0}, True),
        ({"MB": 100.0, "VX": 1.0}, True),
        ({"M": 4.0, "IA": np.inf, "IB": np.nan, "WB": 1.0}, True),
        ({"VX": np.zeros(300)}, True),
        ({"M": np.where(np.arange(300) % 2, 4.0, 6.0)}, True),
    ],
)
def test_a_barrier_of_constants_is_one_of_columns(change, usable):
    """Constants that need no look at each scene are told from those that do."""
    g = {**scenes("casework", 300, 3), **WALL, **change}
    found = solve(g)
    spread = solve({name: np.broadcast_to(x, 300).copy() for name, x in g.items()})
    with native.switched_off():
        expected = solve(g)
    assert np.isfinite(found["VAX"]).all() == usable
    assert np.isnan(found["VAX"]).all() != usable
    for name in RESULTS:
        assert np.all(same(found[name] * 1.0, expected[name] * 1.0)), name
        assert np.all(same(found[name] * 1.0, spread[name] * 1.0)), name


def test_threads_and_blocks_change_nothing():
    count = 2 * BLOCK + 77
    g = {name: np.resize(v, count) for name, v in mixed_scenes(999).items()}
    one = solve(g, threads=1)
    two = solve({name: np.repeat(v, 2)[::2] for name, v in g.items()}, threads=2)
    for name in RESULTS:
        assert np.all(same(one[name] * 1.0, two[name] * 1.0)), name
        assert np.all(same(one[name][:999] * 1.0, one[name][999:1998] * 1.0)), name


def test_results_stay_what_they_are_while_anybody_holds_one():
    g = {name: np.resize(v, 20_000) for name, v in mixed_scenes(500).items()}
    others = {**g, "UX": g["UX"] + 1}
    found = solve(g, FINAL_VELOCITIES)
    held, before = found["VBX"][::7], found["VBX"][::7].copy()
    del found
    for _ in range(3):
        solve(others, FINAL_VELOCITIES)
    assert np.all(same(held, before))
    expected = [solve(columns, "VAX")["VAX"] for columns in (g, others)]
    with ThreadPoolExecutor(4) as pool:
        for first, second in pool.map(lambda _: (solve(g), solve(others)), range(6)):
            assert np.all(same(first["VAX"], expected[0]))
            assert np.all(same(second["VAX"], expected[1]))


@given(st.data())
def test_momentum_is_conserved_and_the_energies_agree(data):
    seed = data.draw(st.integers(0, 10**6))
    g = scenes(data.draw(st.sampled_from(["casework", "quarter-turns", "em-half"])), 20, seed)
    r = solve(g)
    size = g["MA"] * 90 + g["MB"] * 90
    for ours, ax, bx in (("X", "UX", "VX"), ("Y", "UY", "VY")):
        before = g["MA"] * g[ax] + g["MB"] * g[bx]
        after = g["MA"] * r["VA" + ours] + g["MB"] * r["VB" + ours]
        assert np.all(np.abs(after - before) <= 1e-11 * (size + np.hypot(r["PN"], r["PT"])))
    lost = r["KI"] - r["KF"]
    assert np.all(np.abs(lost - r["LOSS"] * r["KI"] / 100) <= 1e-10 * (r["KI"] + r["KF"]))


@pytest.mark.parametrize("name", ["casework", "pivots", "quarter-turns", "heavy", "em-half"])
def test_the_energies_lost_are_the_work_of_each_impulse_and_sum_to_the_loss(name):
    """Computed again from velocities and impulses alone."""
    g = scenes(name, 400, 42)
    r = solve(g)
    ga = np.radians(g["GA"])
    c, s = np.cos(ga), np.sin(ga)
    before = r["XA"] - r["XB"], r["YA"] - r["YB"]
    after = r["XAF"] - r["XBF"], r["YAF"] - r["YBF"]
    x, y = (u + v for u, v in zip(before, after, strict=True))
    spins = g["WA"] - g["WB"] + r["WAF"] - r["WBF"]
    work = {
        "ELN": -r["PN"] * (c * x + s * y) / 2,
        "ELT": -r["PT"] * (c * y - s * x) / 2,
        "ELM": -r["PM"] * spins / 2,
    }
    size = r["KI"] + np.abs(r["PN"] * np.hypot(x, y)) + np.abs(r["PT"] * np.hypot(x, y))
    for name_of_loss, expected in work.items():
        assert np.all(np.abs(r[name_of_loss] - expected) <= 1e-8 * size), name_of_loss
    lost = r["ELN"] + r["ELT"] + r["ELM"]
    terms = np.abs(r["ELN"]) + np.abs(r["ELT"]) + np.abs(r["ELM"])
    assert np.all(np.abs(lost - r["LOSS"] * r["KI"] / 100) <= 1e-14 * (r["KI"] + terms))


def test_energy_equivalent_speeds():
    """Each vehicle takes half of the loss, a car before a barrier all of it; none of a gain."""
    g = scenes("casework", 200, 7)
    r = solve(g)
    lost = r["LOSS"] * r["KI"] / 100
    taken = g["MA"] * r["EESA"] ** 2 / 2 + g["MB"] * r["EESB"] ** 2 / 2
    np.testing.assert_allclose(taken, np.maximum(lost, 0), rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(g["MA"] * r["EESA"] ** 2, g["MB"] * r["EESB"] ** 2, rtol=1e-12)
    still = {"VX": 0, "VY": 0, "WB": 0}
    wall = {**RUN_1, **still, "MB": np.inf, "IB": np.inf}
    found = solve(wall)
    lost = found["LOSS"] * found["KI"] / 100
    assert found["EESA"] == pytest.approx(np.sqrt(2 * lost / RUN_1["MA"]), rel=1e-14)
    assert found["EESB"] == 0
    among = solve({**wall, "MB": np.array([120.0, np.inf]), "IB": np.array([2e3, np.inf])})
    assert among["EESA"][1] == found["EESA"]
    # head on into a wall without rebound the equivalent speed is the speed
    square = {**wall, "E": 0, "MU": 0, "M": 4, "GA": 0, "UX": -50, "UY": 0}
    assert solve(square)["EESA"] == pytest.approx(50, rel=1e-15)
    gained = solve({**RUN_1, "GA": 150})
    assert (gained["EESA"], gained["EESB"]) == (0, 0)


def test_defining_equations_hold():
    """Equations 15, 16 and 18, from the results alone."""
    g = scenes("casework", 300, 11)
    r = solve(g)
    ga = np.radians(g["GA"])
    c, s = np.cos(ga), np.sin(ga)
    gn = (r["XA"] - r["XB"]) * c + (r["YA"] - r["YB"]) * s
    after = (r["XAF"] - r["XBF"]) * c + (r["YAF"] - r["YBF"]) * s
    np.testing.assert_allclose(after, -g["E"] * gn, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(r["PT"], r["MUP"] * r["PN"], rtol=1e-12, atol=1e-9)
    reduced = g["IA"] * g["IB"] / (g["IA"] + g["IB"])
    left = (1 - g["EM"]) * (r["WBF"] - r["WAF"])
    np.testing.assert_allclose(left, -g["EM"] * r["PM"] / reduced, rtol=1e-8, atol=1e-9)
    pivot = solve({**g, "MU": -10.0})
    slip = (pivot["YAF"] - pivot["YBF"]) * c - (pivot["XAF"] - pivot["XBF"]) * s
    np.testing.assert_allclose(slip, 0, atol=1e-9)
    np.testing.assert_allclose(r["MUC"], pivot["PT"] / pivot["PN"], rtol=1e-12)


def test_units_of_mass_change_no_bit_of_a_velocity():
    """Powers of two: whatever is computed scales exactly, unless it leaves the range on the way."""
    for name in ("casework", "pivots", "heavy"):
        g = scenes(name, 200, 9)
        here = solve(g, FINAL_VELOCITIES)
        for power in (600, -600):
            other = {k: g[k] * 2.0**power for k in ("MA", "MB", "IA", "IB")}
            there = solve({**g, **other}, FINAL_VELOCITIES)
            for result in FINAL_VELOCITIES:
                assert np.all(same(here[result], there[result])), (name, power, result)


def test_final_spins_are_the_same_bits_where_em_is_zero():
    for name in ("casework", "heavy", "pivots"):
        found = solve({**scenes(name, 300, 4), "EM": 0.0}, ["WAF", "WBF"])
        assert np.all(same(found["WAF"], found["WBF"])), name


class TestSignRule:
    """Line 400."""

    def test_flipped_when_gt_is_positive_and_kept_when_negative(self):
        assert solve({**RUN_1, "MU": 0.5})["MUP"] == 0.5  # gt = -43.6
        assert solve({**RUN_1, "MU": -0.5})["MUP"] == -0.5
        other = {**RUN_1, "UY": 100.0}
        assert solve({**other, "MU": 0.5})["MUP"] == -0.5

    @pytest.mark.parametrize("zero", [0.0, -0.0])
    def test_a_tie_keeps_the_typed_sign(self, zero):
        tie = {**RUN_1, "GA": 0.0, "UY": zero, "VY": zero}
        for mu in (0.5, -0.5):
            assert solve({**tie, "MU": mu})["MUP"] == mu
            assert solve({**tie, "MU": np.array([mu, mu + 0.125])})["MUP"][0] == mu
            uy = np.array([zero, 1.0, -1.0])
            np.testing.assert_array_equal(solve({**tie, "UY": uy, "MU": mu})["MUP"], [mu, -mu, mu])

    def test_ten_turned_to_minus_ten_is_friction_and_flagged(self):
        """Line 510 would zero a right-hand side; the equations themselves are solved."""
        scene = {**RUN_1, "UY": 100.0, "MU": 10.0}
        found = solve(scene)
        assert found["MUP"] == -10
        assert found["PT"] == pytest.approx(-10 * found["PN"])
        assert found["STATUS"] & Status.MU_OUT_OF_RANGE
        below = solve({**RUN_1, "MU": -11.0})
        assert below["PT"] == pytest.approx(-11 * below["PN"])
        assert below["STATUS"] & Status.MU_OUT_OF_RANGE
        assert not solve({**RUN_1, "MU": -10.0})["STATUS"] & Status.MU_OUT_OF_RANGE


class TestPointMass:
    def test_arms_count_as_nothing_and_spins_pass_through(self):
        plain = solve({**RUN_1, "DA": 0, "DB": 0, "M": 4})
        given_all = solve({**RUN_1, "WA": 2.5, "WB": -1, "M": 4})
        for name in ("VAX", "VAY", "VBX", "VBY", "KI", "KF", "LOSS", "XA", "XAF", "PM"):
            assert given_all[name] == plain[name], name
        assert (given_all["WAF"], given_all["WBF"]) == (2.5, -1)
        assert given_all["XA"] == RUN_1["UX"]

    def test_is_not_asked_for_what_it_does_not_look_at(self):
        names = ("E", "MU", "GA", "MA", "MB", "UX", "UY", "WA", "VX", "VY", "WB")
        few = solve({**{name: RUN_1[name] for name in names}, "M": 4})
        full = solve({**RUN_1, "M": 4})
        unused = solve({**RUN_1, "M": 4, "IA": np.nan, "EM": np.inf, "TB": np.nan})
        for name in RESULTS:
            assert few[name] == full[name] == unused[name], name

    def test_is_the_limit_of_shrinking_arms(self):
        point = solve({**RUN_1, "M": 4}, FINAL_VELOCITIES[:4])
        near = solve({**RUN_1, "DA": 1e-9, "DB": 1e-9}, FINAL_VELOCITIES[:4])
        for name in point:
            assert near[name] == pytest.approx(point[name], rel=1e-12)


class TestBadScenes:
    def test_one_never_spoils_another(self):
        g = scenes("casework", 50, 3)
        alone = solve(g)
        for name in SCENE:
            for value in (np.nan, np.inf, -np.inf):
                if name in ("MA", "IA", "MB", "IB") and value == np.inf:
                    continue
                column = g[name].copy()
                column[7] = value
                found = solve({**g, name: column})
                assert found["STATUS"][7] == Status.NOT_FINITE, name
                for result in RESULTS:
                    rest = np.delete(found[result], 7)
                    np.testing.assert_array_equal(rest, np.delete(alone[result], 7), err_msg=name)
                    assert result == "STATUS" or np.isnan(found[result][7]), (name, result)

    @pytest.mark.parametrize(
        "change",
        [
            {"M": 5},
            {"M": 0},
            {"MA": 0},
            {"MB": -1},
            {"IA": 0},
            {"IB": -np.inf},
            {"MB": np.inf},  # it moves
            {"MA": np.inf, "UX": 0, "UY": 0, "MB": np.inf, "VX": 0, "VY": 0},  # two
            {"IA": np.inf, "IB": np.inf},
            {"IA": np.inf, "MB": np.inf, "VX": 0, "VY": 0},
            {"IA": np.inf, "WA": 1},
        ],
    )
    def test_refused(self, change):
        found = solve({**RUN_1, **change})
        assert found["STATUS"] == Status.NOT_FINITE
        assert all(np.isnan(found[name]) for name in NUMBERS)

    def test_what_has_no_solution_is_nan_and_told(self):
        """em = 1/2 with no arms: the spins are not determined."""
        found = solve({**RUN_1, "EM": 0.5, "DA": 0, "DB": 0})
        assert np.isnan(found["VAX"])
        assert found["KI"] == pytest.approx(100904.92871)
        assert found["STATUS"] & Status.NOT_FINITE
        assert found["STATUS"] & Status.SINGULAR

    def test_nothing_moves(self):
        found = solve({**RUN_1, "UX": 0, "UY": 0, "VX": 0, "VY": 0})
        assert found["VAX"] == found["KF"] == 0
        assert np.isnan(found["LOSS"])  # the listing: DIVISION BY ZERO
        assert np.isnan(found["MUC"])
        assert found["STATUS"] & Status.SEPARATING
        assert found["STATUS"] & Status.NOT_FINITE

    def test_what_overflows_is_told(self):
        found = solve({**RUN_1, "UX": -1e160})
        assert np.isfinite(found["VAX"])
        assert np.isnan(found["KI"])
        assert found["STATUS"] & Status.NOT_FINITE

    def test_no_result_is_missing_without_a_word(self):
        rng = np.random.default_rng(160)
        g = mixed_scenes(3000, 6)
        for name in g:
            if name not in ("M", "MU", *("GA", "PA", "PB", "TA", "TB")):
                wild = g[name] * 10.0 ** rng.uniform(-165, 165, 3000)
                g[name] = np.where(rng.random(3000) < 0.1, wild, g[name])
        found = solve(g)
        told_of = [name for name in NUMBERS if name != "MUC"]
        missing = np.any([np.isnan(found[name]) for name in told_of], axis=0)
        told = (found["STATUS"] & Status.NOT_FINITE) != 0
        assert 500 < missing.sum() < 2500
        np.testing.assert_array_equal(told, missing)


class TestStatus:
    def status(self, **change):
        return Status(int(solve({**RUN_1, **change}, "STATUS")["STATUS"]))

    def test_published_runs_have_nothing_to_remark(self):
        assert self.status() == Status(0)
        assert self.status(MU=-10) == Status(0)
        assert self.status(M=4) == Status(0)

    def test_bits(self):
        assert Status.SEPARATING in self.status(UX=40)
        assert Status.PULLING in self.status(UX=40)
        # run 1 with GA = 150 prints a loss of -40.98 %
        turned = self.status(GA=150)
        assert Status.ENERGY_GAINED in turned
        assert self.status(E=1.0, EM=-1.0, MU=0.0) == Status(0)
        assert Status.SINGULAR in self.status(MU=3.19214397)

    def test_turned_surface_gains_what_the_listing_prints(self):
        assert np.floor(100 * solve({**RUN_1, "GA": 150})["LOSS"]) / 100 == -40.98


class TestColumns:
    def test_shapes_broadcast(self):
        mu, e = np.linspace(0, 1, 5)[:, np.newaxis], np.linspace(0, 0.5, 7)
        found = solve({**RUN_1, "MU": mu, "E": e})
        assert found["VAX"].shape == (5, 7)
        assert found["VAX"][3, 2] == solve({**RUN_1, "MU": mu[3, 0], "E": e[2]})["VAX"]
        assert solve(RUN_1)["VAX"].shape == ()
        assert solve({**RUN_1, "MU": np.empty(0)})["STATUS"].shape == (0,)

    def test_order_of_the_columns_does_not_matter(self):
        backwards = dict(reversed(list(scenes("casework", 30, 4).items())))
        found, same_scenes = solve(backwards), solve(scenes("casework", 30, 4))
        np.testing.assert_array_equal(found["WBF"], same_scenes["WBF"])

    def test_any_numbers(self):
        ints = solve({**RUN_1, "IA": np.array([3728, 4000], np.int32)})
        halves = np.array([[3728.0, 1], [4000.0, 1]])[:, 0]  # not contiguous
        np.testing.assert_array_equal(ints["VAX"], solve({**RUN_1, "IA": halves})["VAX"])
        assert solve({name: str(value) for name, value in RUN_1.items()})["VAX"] == ints["VAX"][0]

    def test_outputs(self):
        assert list(solve(RUN_1, "WBF,VAX")) == ["WBF", "VAX"]
        assert list(solve(RUN_1)) == list(RESULTS)
        assert solve(RUN_1, []) == {}

    @pytest.mark.parametrize(
        ("columns", "outputs", "told"),
        [
            ({**RUN_1, "MX": 1}, None, "'MX' is not a scene name"),
            ({"MA": 1, "M": 6}, None, "missing: E MU"),
            ({**RUN_1, "MA": "heavy"}, None, "column MA"),
            ({**RUN_1, "MA": 1j}, None, "column MA"),
            ({**RUN_1, "MA": [1, 2], "MB": [1, 2, 3]}, None, r"MA \(2,\), MB \(3,\)"),
            (RUN_1, ["VAX", "VX"], "'VX' is not a result name"),
        ],
    )
    def test_unusable(self, columns, outputs, told):
        with pytest.raises(UserError, match=told):
            solve(columns, outputs)


def passes_of(columns, outputs=FINAL_VELOCITIES):
    """How many passes over the scenes the plan for these columns makes."""
    given, shape = sources(columns)
    block = examine({name: part(source, 0, shape[0]) for name, source in given.items()})
    return passes(program_for(block.kinds, tuple(outputs)))


class TestSkipping:
    """What a scene does not need is not computed; counted in passes, timed by `impact88 bench`."""

    def general(self):
        return scenes("casework", 100, 1) | {"WA": np.linspace(1, 2, 100), "WB": np.full(100, 0.5)}

    @pytest.mark.parametrize(
        ("change", "at_most"),
        [
            ({"MU": 0.0}, 0.97),
            ({"WA": 0.0, "WB": 0.0}, 0.92),
            # single spins by Cramer's rule and velocities of light bodies take passes that no
            # constant angle and no missing arm spares
            ({"GA": 0.0}, 0.815),
            ({"EM": 1.0}, 0.97),
            ({"EM": 0.0}, 0.96),
            ({"DB": 0.0}, 0.82),
            ({"DA": 0.0, "DB": 0.0}, 0.54),
            ({"MB": np.inf, "IB": np.inf, "VX": 0.0, "VY": 0.0, "WB": 0.0}, 0.85),
            ({"M": 4.0}, 0.41),
            ({"MA": 100.0, "MB": 120.0, "IA": 2e3, "IB": 3e3}, 0.95),
            ({"GA": 30.0, "PA": 10.0, "PB": 20.0, "TA": 0.0, "TB": 90.0}, 0.68),
        ],
    )
    def test_paths(self, change, at_most):
        general = self.general()
        assert passes_of({**general, **change}) <= at_most * passes_of(general)
        # a block of scenes that are all alike takes the same path as a scalar
        columns = {name: np.full(100, value) for name, value in change.items()}
        assert passes_of({**general, **columns}) == passes_of({**general, **change})

    def test_outputs(self):
        general = self.general()
        everything = passes_of(general, tuple(RESULTS))
        assert passes_of(general, ["KI"]) <= 0.05 * everything
        assert passes_of(general, ["XA"]) <= 0.15 * everything
        assert passes_of(general, ["PN"]) < passes_of(general, FINAL_VELOCITIES) < everything / 1.5

    def test_no_trigonometry_for_a_point_mass_but_of_the_surface(self):
        assert passes_of({**self.general(), "M": 4.0, "GA": 0.0}) < 35


def test_nothing_stays_of_results_that_nobody_holds():
    g = scenes("casework", 2000, 1) | {"MU": np.linspace(0, 1, 2000)}
    solve(g)
    tracemalloc.start()
    try:
        for count in (2000, 200_000):
            found = solve({name: np.resize(v, count) for name, v in g.items()}, threads=1)
            assert tracemalloc.get_traced_memory()[0] > count * 8 * len(NUMBERS)
            del found
            assert tracemalloc.get_traced_memory()[0] < 200_000
    finally:
        tracemalloc.stop()


def test_memory_is_bounded_by_the_results():
    count = 400_000
    g = {name: float(v[0]) for name, v in scenes("casework", 1, 1).items()}
    g["MU"] = np.linspace(0, 1, count).astype(np.float32)  # to be converted block by block
    room = solve(g, ["VAX"])
    tracemalloc.start()
    try:
        solve(g, out=room, threads=1)
        into_given = tracemalloc.get_traced_memory()[1]
        solve(g, ["VAX"], threads=1)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert into_given < peak - count * 7  # no result of its own
    assert peak < count * 8 + 8e6  # the result, and working arrays that do not grow


@pytest.mark.parametrize("name", POPULATIONS)
def test_populations_are_seeded_and_usable(name):
    a, b, c = scenes(name, 40, 1), scenes(name, 40, 1), scenes(name, 40, 2)
    assert set(a) == set(SCENE)
    assert all(np.array_equal(a[n], b[n]) for n in SCENE)
    assert not all(np.array_equal(a[n], c[n]) for n in SCENE)
    found = solve(a)
    assert np.all(np.isfinite(found["VAX"]))


def test_results_that_a_mirror_negates_are_those_of_the_table():
    """MIRRORED, by which axes = "sae" reads and shows, against collisions seen in a mirror."""
    columns = scenes("casework", 200, 5)
    mirrored = {name: -values if name in MIRRORED else values for name, values in columns.items()}
    seen, reflected = solve(columns, list(RESULTS)), solve(mirrored, list(RESULTS))
    for name in RESULTS:
        sign = -1 if name in MIRRORED else 1
        np.testing.assert_allclose(
            reflected[name], sign * seen[name], rtol=1e-7, atol=1e-7, err_msg=name
        )
