"""The equations and rules that results obey, from the results alone."""

import numpy as np
import pytest
from populations import scenes
from worked_cases import RUN_1, reference_cases, scene_of

from impact88 import solve
from impact88.names import FINAL_VELOCITIES, RESULTS, SCENE
from impact88.status import Status

FORWARD = [case for case in reference_cases() if case["kind"].startswith("forward")]
NUMBERS = tuple(name for name in RESULTS if name != "STATUS")
STILL = {"VX": 0.0, "VY": 0.0, "WB": 0.0}


@pytest.mark.parametrize("case", FORWARD, ids=[case["name"] for case in FORWARD])
def test_worked_case(case):
    result = case["result"]
    reference = dict(zip(FINAL_VELOCITIES, result["final"].values(), strict=True))
    reference |= {name + "F": text for name, text in result["contact_final"].items()}
    impulses = result["impulses"]
    reference |= {"PN": impulses["Pn"], "PT": impulses["Pt"], "PM": impulses["M"]}
    reference |= {"KI": result["KE_initial"], "LOSS": result["KE_loss_percent"]}
    results = solve(scene_of(case))
    for name, text in reference.items():
        assert results[name] == pytest.approx(float(text), rel=1e-12, abs=1e-300), name
    mu = result["mu_used"]
    assert results["MUP"] == (-10 if mu is None else float(mu))
    assert results["KF"] == pytest.approx(results["KI"] * (1 - results["LOSS"] / 100), rel=1e-13)


def test_defining_equations():
    """Equations 13 to 18, and no slip of the pivot."""
    g = scenes("casework", 300, 11)
    r = solve(g)
    ga = np.radians(g["GA"])
    c, s = np.cos(ga), np.sin(ga)
    for axis, (a, b), (x, y) in (("X", ("UX", "VX"), (c, -s)), ("Y", ("UY", "VY"), (s, c))):
        impulse = x * r["PN"] + y * r["PT"]
        np.testing.assert_allclose(g["MA"] * (r["VA" + axis] - g[a]), impulse, rtol=1e-9, atol=1e-7)
        np.testing.assert_allclose(g["MB"] * (r["VB" + axis] - g[b]), -impulse, atol=1e-7)
    gn = (r["XA"] - r["XB"]) * c + (r["YA"] - r["YB"]) * s
    after = (r["XAF"] - r["XBF"]) * c + (r["YAF"] - r["YBF"]) * s
    np.testing.assert_allclose(after, -g["E"] * gn, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose((r["VC"], r["VS"]), (-gn, after), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(r["PT"], r["MUP"] * r["PN"], rtol=1e-12, atol=1e-9)
    mean_mass = g["IA"] * g["IB"] / (g["IA"] + g["IB"])
    turning = (1 - g["EM"]) * (r["WBF"] - r["WAF"])
    np.testing.assert_allclose(turning, -g["EM"] * r["PM"] / mean_mass, rtol=1e-8, atol=1e-9)
    pivot = solve({**g, "MU": -10.0})
    slip = (pivot["YAF"] - pivot["YBF"]) * c - (pivot["XAF"] - pivot["XBF"]) * s
    np.testing.assert_allclose(slip, 0, atol=1e-9)
    np.testing.assert_allclose(r["MUC"], pivot["PT"] / pivot["PN"], rtol=1e-12)


@pytest.mark.parametrize("name", ["casework", "pivots", "quarter-turns", "heavy", "em-half"])
def test_the_energies_lost_are_the_work_of_each_impulse(name):
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
    size = r["KI"] + (np.abs(r["PN"]) + np.abs(r["PT"])) * np.hypot(x, y)
    for loss, reference in work.items():
        assert np.all(np.abs(r[loss] - reference) <= 1e-8 * size), loss
    lost = r["ELN"] + r["ELT"] + r["ELM"]
    terms = np.abs(r["ELN"]) + np.abs(r["ELT"]) + np.abs(r["ELM"])
    assert np.all(np.abs(lost - r["LOSS"] * r["KI"] / 100) <= 1e-14 * (r["KI"] + terms))
    assert np.all(np.abs(r["KI"] - r["KF"] - lost) <= 1e-10 * (r["KI"] + r["KF"] + terms))


def test_a_small_loss_keeps_its_digits():
    """Central, elastic but for 1e-10: the loss is (1 - E^2) of the energy of the approach."""
    scene = {**RUN_1, "GA": 0.0, "DA": 0.0, "DB": 0.0, "UX": -40.0, "UY": 0.0, "VX": 20.0}
    scene |= {"VY": 0.0, "MU": 0.0, "EM": 1.0, "E": 1 - 1e-10}
    mean_mass = 1 / (1 / scene["MA"] + 1 / scene["MB"])
    exact = mean_mass * 60**2 / 2 * (1 - scene["E"]) * (1 + scene["E"])
    results = solve(scene)
    assert results["LOSS"] * results["KI"] / 100 == pytest.approx(exact, rel=1e-14)
    assert abs(results["KI"] - results["KF"] - exact) > 1e-8 * exact


def test_energy_equivalent_speeds():
    """Each vehicle takes half of the loss, a car before a barrier all of it; none of a gain."""
    g = scenes("casework", 200, 7)
    r = solve(g)
    lost = r["LOSS"] * r["KI"] / 100
    energy = g["MA"] * r["EESA"] ** 2 / 2 + g["MB"] * r["EESB"] ** 2 / 2
    np.testing.assert_allclose(energy, np.maximum(lost, 0), rtol=1e-12, atol=1e-9)
    wall = {**RUN_1, **STILL, "MB": np.inf, "IB": np.inf}
    # head on into a wall without rebound the equivalent speed is the speed
    square = {**wall, "E": 0, "MU": 0, "M": 4, "GA": 0, "UX": -50, "UY": 0}
    assert solve(square)["EESA"] == pytest.approx(50, rel=1e-15)
    results = solve({**RUN_1, "GA": 150})
    assert (results["EESA"], results["EESB"]) == (0, 0)


def test_units_of_mass_change_no_digit_of_a_velocity():
    for name in ("casework", "pivots", "heavy"):
        g = scenes(name, 200, 9)
        results = solve(g, FINAL_VELOCITIES)
        for factor in (2.0**100, 2.0**-100):
            masses = {k: g[k] * factor for k in ("MA", "MB", "IA", "IB")}
            in_units = solve({**g, **masses}, FINAL_VELOCITIES)
            for result in FINAL_VELOCITIES:
                np.testing.assert_array_equal(in_units[result], results[result])


class TestSignRule:
    """Line 400."""

    def test_flipped_where_the_contact_points_slide_along_t(self):
        g = {**scenes("casework", 300, 5), "MU": np.full(300, 0.3)}
        r = solve(g)
        ga = np.radians(g["GA"])
        gt = (r["YA"] - r["YB"]) * np.cos(ga) - (r["XA"] - r["XB"]) * np.sin(ga)
        np.testing.assert_array_equal(r["MUP"], np.where(gt > 0, -0.3, 0.3))

    @pytest.mark.parametrize("zero", [0.0, -0.0])
    def test_a_tie_keeps_the_typed_sign(self, zero):
        scene = {**RUN_1, "GA": 0.0, "UY": zero, "VY": 0.0, "DA": 0.0, "DB": 0.0}
        for mu in (0.4, -0.4):
            assert solve({**scene, "MU": mu}, "MUP")["MUP"] == mu


def test_point_masses_keep_their_spins_out_of_the_energies():
    point = {**RUN_1, "M": 4.0, "WA": 3.0}
    results = solve(point)
    assert (results["WAF"], results["WBF"], results["PM"]) == (3, 0, 0)
    assert results["KI"] == solve(RUN_1)["KI"]
    small = {**RUN_1, "DA": 1e-13, "DB": 1e-13, "EM": 1.0}
    for name in ("VAX", "VAY", "VBX", "VBY", "LOSS"):
        assert solve(small)[name] == pytest.approx(results[name], rel=1e-12)


class TestUnusableScenes:
    def test_a_bad_number_spoils_no_other_scene(self):
        g = scenes("casework", 20, 3)
        alone = solve(g)
        for name in SCENE:
            for value in (np.nan, np.inf, -np.inf):
                if name in ("MA", "IA", "MB", "IB") and value == np.inf:
                    continue
                column = g[name].copy()
                column[7] = value
                results = solve({**g, name: column})
                assert results["STATUS"][7] == Status.NOT_FINITE, name
                for result in RESULTS:
                    remainder = np.delete(results[result], 7)
                    np.testing.assert_array_equal(
                        remainder, np.delete(alone[result], 7), err_msg=name
                    )
                    assert result == "STATUS" or np.isnan(results[result][7]), (name, result)

    @pytest.mark.parametrize(
        "change",
        [
            {"M": 5},
            {"MA": 0},
            {"MB": -1},
            {"IB": -np.inf},
            {"MB": np.inf},  # it moves
            {"MA": np.inf, "UX": 0, "UY": 0, "MB": np.inf, "VX": 0, "VY": 0},  # two
            {"IA": np.inf, "IB": np.inf},
            {"IA": np.inf, "WA": 1},
        ],
    )
    def test_refused(self, change):
        results = solve({**RUN_1, **change})
        assert results["STATUS"] == Status.NOT_FINITE
        assert all(np.isnan(results[name]) for name in NUMBERS)

    def test_what_has_no_solution_is_nan_and_reported(self):
        """EM = 1/2 with no arms: the spins are not determined."""
        results = solve({**RUN_1, "EM": 0.5, "DA": 0, "DB": 0})
        assert np.isnan(results["VAX"])
        assert results["KI"] == pytest.approx(100904.92871)
        assert results["STATUS"] & Status.NOT_FINITE
        assert results["STATUS"] & Status.SINGULAR
        assert np.isfinite(solve({**RUN_1, "EM": 0.5})["VAX"])

    def test_nothing_moves(self):
        results = solve({**RUN_1, "UX": 0, "UY": 0, "VX": 0, "VY": 0})
        assert results["VAX"] == results["KF"] == 0
        assert np.isnan(results["LOSS"])  # the listing: DIVISION BY ZERO
        assert results["STATUS"] & Status.SEPARATING
        assert results["STATUS"] & Status.NOT_FINITE
