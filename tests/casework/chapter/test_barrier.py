"""Rigid barrier, point masses as a limit, and force from impulse."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from reference_cases import cases_of

from impact88 import barrier, sample, solve, solve_for
from impact88.casework.chapter.barrier import BARRIER, BARRIER_AFTER, VEHICLE
from impact88.collision.geometry import GEOMETRY, clock, facing
from impact88.errors import UserError
from impact88.mechanics.outcome import forces
from impact88.mechanics.state import State

(CASE,) = cases_of("barrier")
CAR = {name: value for name, value in CASE.given.items() if name in VEHICLE}
AFTER = ("VAX", "VAY", "WAF")
FINAL = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF")


def of_result(key: str) -> float:
    return float(CASE.result[key])


def test_the_reference_case_to_1e_12() -> None:
    found = barrier(CAR)
    names = {"Vax": "VAX", "Vay": "VAY", "Wa": "WAF", "Pn": "PN", "Pt": "PT", "M": "PM"}
    names |= {"mu_used": "MUP", "KE_loss_percent": "LOSS"}
    for key, name in names.items():
        assert float(found[name]) == pytest.approx(of_result(key), rel=1e-12)
    pivot = barrier(CAR | {"MU": -10.0})
    for key, text in CASE.result["pivot"].items():
        assert float(pivot[names[key]]) == pytest.approx(float(text), rel=1e-12)


def test_solve_for_gives_the_same_and_its_inverse() -> None:
    forward = {**CAR, **BARRIER}
    (found,) = solve_for(forward)
    for key, name in (("Vax", "VAX"), ("Vay", "VAY"), ("Wa", "WAF")):
        assert float(found[name]) == pytest.approx(of_result(key), rel=1e-12)
    known = {n: v for n, v in forward.items() if n not in ("UX", "UY", "WA", "MU")}
    rebound = {name: float(found[name]) for name in AFTER}
    (back,) = solve_for({**known, **BARRIER_AFTER, **rebound, "MUP": 0.911})
    for name in ("UX", "UY", "WA"):
        tolerance = 1e-12 * float(back.worst) * 30
        assert float(back[name]) == pytest.approx(CAR[name], abs=tolerance)


def test_a_growing_mass_comes_to_the_barrier_as_the_reference_says() -> None:
    limit = np.array([of_result(key) for key in ("Vax", "Vay", "Wa")])
    for exponent, text in CASE.result["finite_mass_deviation_by_log10_mb"]:
        # the file leaves the inertia unsaid; its numbers are those of I = 100 m struck centrally
        mass = 10.0**exponent
        found = solve({**CAR, **BARRIER, "MB": mass, "IB": 100 * mass}, AFTER)
        off = np.abs(np.array([float(found[name]) for name in AFTER]) - limit).max()
        assert off == pytest.approx(float(text), rel=1e-4, abs=1e-12 * np.abs(limit).max())


vehicles = st.fixed_dictionaries(
    {
        **{"DA": st.floats(0.0, 9.0), "MA": st.floats(50.0, 200.0), "IA": st.floats(900.0, 4500.0)},
        **{name: st.floats(-90.0, 90.0) for name in ("GA", "PA", "TA")},
        **{"E": st.floats(0.0, 1.0), "MU": st.floats(0.0, 0.8), "EM": st.floats(-1.0, 0.0)},
        **{"UX": st.floats(-90.0, -10.0), "UY": st.floats(-30.0, 30.0), "WA": st.just(0.0)},
    }
)


@settings(max_examples=60)
@given(vehicles)
def test_the_barrier_is_the_limit_of_a_growing_mass(car: dict[str, float]) -> None:
    """With B's mass and inertia every term of the solution changes by what it has of them, and the
    impulse by the change of its denominator, D (closedform.impact): the bound below is that."""
    limit = barrier(car, (*AFTER, "PN", "XA", "YA"))
    found = {name: float(value) for name, value in limit.items()}
    e, em, mu, arm, ia = (car[name] for name in ("E", "EM", "MU", "DA", "IA"))
    ga = math.radians(car["GA"])
    approach = (1 + e) * (found["XA"] * math.cos(ga) + found["YA"] * math.sin(ga))
    assume(abs(approach) > 1e-3)
    turned = arm * arm * (1 + mu)
    for exponent in (8, 10):
        mb, ib = 10.0**exponent, 10.0 ** (exponent + 1)
        change = (1 - 2 * em) * (1 / mb + turned / (ia + ib)) - em * turned / (ia + ib)
        share = change * abs(found["PN"] / ((1 - 2 * em) * approach))
        assume(share < 0.5)
        heavy = solve({**car, **BARRIER, "MB": mb, "IB": ib}, AFTER)
        off = {name: abs(float(heavy[name]) - found[name]) for name in AFTER}
        rounding = 1e-9 * (100 + abs(found["PN"]))
        for name, before in (("VAX", "UX"), ("VAY", "UY")):
            assert off[name] <= 2 * share * abs(found[name] - car[before]) + rounding
        common = 2 * arm * (1 + mu) * abs(found["PN"]) / (ia + ib)
        spin = abs(found["WAF"]) * (2 * share + 2 * ia / (ia + ib)) + common
        assert off["WAF"] <= spin + rounding


@settings(max_examples=60)
@given(vehicles, st.floats(50.0, 200.0), st.floats(-30.0, 30.0))
def test_point_masses_are_the_limit_of_vanishing_arms(
    car: dict[str, float], mass: float, speed: float
) -> None:
    scene = {**car, **BARRIER, "MB": mass, "IB": 2000.0, "VY": speed, "PB": 10.0}
    names = ("VAX", "VAY", "VBX", "VBY", "PN", "PT", "LOSS")
    limit = solve({**scene, "M": 4, "DA": 0.0, "DB": 0.0}, names)
    for name, value in solve({**scene, "DA": 0.0, "DB": 0.0}, names).items():
        assert float(value) == pytest.approx(float(limit[name]), rel=1e-10, abs=1e-9)
    off = []
    for arm in (1e-2, 1e-3):
        found = solve({**scene, "DA": arm, "DB": arm}, FINAL[:4])
        off.append(max(abs(float(found[name] - limit[name])) for name in FINAL[:4]))
    # arms enter the impulse squared
    assert off[1] <= 0.011 * off[0] + 1e-10


def test_a_barrier_takes_arrays_and_refuses_what_it_has_no_place_for() -> None:
    found = barrier(CAR | {"UX": np.array([-10.0, -20.0])}, ["DVA", "LOSS"])
    assert list(found) == ["DVA", "LOSS"]
    assert found["DVA"][1] == pytest.approx(2 * found["DVA"][0])
    with pytest.raises(UserError, match="'VX' does not belong to a barrier"):
        barrier(CAR | {"VX": 1.0})
    with pytest.raises(UserError, match="'DVB' is not a barrier result"):
        barrier(CAR, ["DVB"])


# -- Section III: force from impulse


def test_average_and_peak_force_from_a_contact_time() -> None:
    found = forces(np.array([3000.0, -3000.0]), 0.15)
    assert found["FA"].tolist() == [20000.0, 20000.0]
    assert found["FM2"].tolist() == [40000.0, 40000.0]
    assert found["FM3"].tolist() == [60000.0, 60000.0]
    for time in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(UserError, match="contact time"):
            forces(1.0, time)


def pdof(vehicle: str, theta: float, gamma: float, pn: float, pt: float) -> float:
    vehicles = {**dict.fromkeys(GEOMETRY, 1.0), "TA": theta, "TB": theta, "GA": gamma}
    return float(State.of_known({**vehicles, "PN": pn, "PT": pt})[f"PDOF{vehicle}"])


@pytest.mark.parametrize(
    ("push", "expected", "hour"),
    [
        # A faces -x where TA = 0: a push towards +x is a frontal blow; its right is +y
        ((1.0, 0.0), 0.0, "12 o'clock"),
        ((0.0, -1.0), 90.0, "3 o'clock"),
        ((0.0, 1.0), -90.0, "9 o'clock"),
        ((-1.0, 0.0), 180.0, "6 o'clock"),
        ((1.0, -1.0), 45.0, "2 o'clock"),
    ],
)
def test_principal_direction_of_force(
    push: tuple[float, float], expected: float, hour: str
) -> None:
    found = pdof("A", 0.0, 0.0, *push)
    assert found == pytest.approx(expected)
    assert clock(found) == hour
    # the same push turned with the vehicle and the plane
    for angle in (-170.0, 33.0, 290.0):
        turned = pdof("A", angle, angle, *push)
        assert np.cos(np.radians(turned - expected)) == pytest.approx(1.0)
    # B takes the opposite push and faces the other way at equal headings
    assert pdof("B", 0.0, 0.0, *push) == pytest.approx(expected)


def test_pdof_of_the_published_runs() -> None:
    """Run 1: A, driving towards -x into the side of B, is struck from its front, left of center;
    B, heading 60°, from its right front."""
    scene = {name: float(text) for name, text in sample(1).items()}
    found = solve(scene, ("PN", "PT"))
    a = pdof("A", scene["TA"], scene["GA"], found["PN"], found["PT"])
    b = pdof("B", scene["TB"], scene["GA"], found["PN"], found["PT"])
    assert -30 < a < 0
    assert 0 < b < 90
    # along A's own line of travel: it slows A down
    assert abs(facing("A", scene["TA"])) == 180
    assert np.isnan(pdof("A", 0.0, 0.0, 0.0, 0.0))
