"""Answers that an expert of the other side would attack."""

from __future__ import annotations

import math

import numpy as np
import pytest

import impact88
from impact88.errors import UserError

POINTS = {"M": 4, "MA": 1500.0, "MB": 1200.0}
SCENE = {
    "MA": 99.5,
    "MB": 87.0,
    "IA": 1800.0,
    "IB": 1500.0,
    "DA": 6.0,
    "PA": 10.0,
    "DB": 5.0,
    "PB": 100.0,
    "TA": 180.0,
    "TB": 90.0,
    "GA": 150.0,
    "EM": 1.0,
    "WA": 0.0,
    "WB": 0.0,
    "UX": 44.0,
    "UY": 0.0,
    "VX": 0.0,
    "VY": 36.67,
    "E": 0.1,
}
CROSSING = {**POINTS, "HA": 0, "HB": 90, "SAF": "16 +- .1", "SBF": "14 +- .1"}


@pytest.mark.parametrize(
    ("courses", "verdict"),
    [((44, 40), "agrees"), ((43, 45), "at a limit"), ((35, 50), "contradictory")],
)
def test_a_limit_of_physics_checks_values(courses: tuple[int, int], verdict: str) -> None:
    """A leaves towards x faster than B only if it drove through it."""
    courses_after = {"HAF": f"{courses[0]} +- 3", "HBF": f"{courses[1]} +- 3"}
    answer = impact88.reconstruct({**CROSSING, "SBF": "16 +- .1", **courses_after}, samples=0)[0]
    assert answer.verdict == verdict
    if verdict == "contradictory":
        assert answer.evidence.redundancy == 1
        assert answer.evidence.probability < 1e-3
        assert "E" in answer.broken
        assert abs(answer.tests["HAF"].residual) > 3


def test_what_others_say_of_a_value_obeys_physics_and_momentum() -> None:
    entries = {
        **POINTS,
        "UX": 20,
        "UY": 0,
        "VX": 0,
        "VY": 0,
        "VAX": 15,
        "VAY": 0,
        "VBX": 3,
        "VBY": 0,
    }
    answer = impact88.reconstruct(entries, samples=0)[0]
    assert answer.verdict == "contradictory"
    assert answer.values["VAX"] <= answer.values["VBX"] + 1e-6
    assert 1500 * 20 / 2700 < answer.tests["VBX"].by_others < 15


def test_values_after_a_plastic_impact_contradict_one_another() -> None:
    entries = {**CROSSING, "HAF": 30, "HBF": 30, "MU": -10}
    assert impact88.reconstruct(entries, samples=0)[0].verdict == "contradictory"
    equal = impact88.reconstruct({**entries, "SAF": 16, "SBF": 16}, samples=0)[0]
    assert equal.verdict == "agrees"
    assert equal.values["SA"] == pytest.approx(16 * math.cos(math.pi / 6) * 2700 / 1500)
    assert equal.values["SB"] == pytest.approx(16 * math.sin(math.pi / 6) * 2700 / 1200)


def test_a_barrier_rests() -> None:
    wall = {"M": 4, "MA": 1500.0, "MB": math.inf, "SA": "30 +- 2", "HA": 0, "E": ".1 +- .1"}
    answer = impact88.reconstruct(wall, samples=2000)[0]
    assert answer.verdict == "agrees"
    assert answer.values["DVA"] == pytest.approx(33)
    assert answer.values["LOSS"] == pytest.approx(99)
    assert answer.intervals["DVA"] == pytest.approx((29.5, 36.6), abs=0.3)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("E", -1e-06, "E is -1e-06; expected 0 to 1"),
        ("E", 0, ""),
        ("E", 1, ""),
        ("E", 1.001, "E is 1.001; expected 0 to 1"),
        ("EM", -1.001, "EM is -1.001; expected -1 to 0, or 1 for no"),
        ("EM", -1, ""),
        ("EM", 0, ""),
        ("EM", 0.001, "EM is 0.001; expected -1 to 0, or 1 for no"),
        ("EM", 1, ""),
    ],
)
def test_given_coefficients_lie_in_their_ranges(name: str, value: float, message: str) -> None:
    scene = {**SCENE, "MU": 0.0, name: value}
    after = impact88.solve(scene, ["VAX", "VAY", "VBX", "VBY"])
    entries = {n: x for n, x in scene.items() if n not in ("UX", "UY", "VX", "VY", "MU")}
    entries |= {"MUP": float(impact88.solve(scene, ["MUP"])["MUP"])}
    entries |= {n: float(x) for n, x in after.items()}
    if value == 0 and name == "E":
        entries |= {"UX": scene["UX"], "UY": 0.0}
    if message:
        with pytest.raises(UserError, match=message):
            impact88.reconstruct(entries, samples=0)
    else:
        assert impact88.reconstruct(entries, samples=0)[0].verdict == "agrees"


def test_ranges_of_motions_left_open_are_named() -> None:
    entries = {**POINTS, "SA": 20, "HA": 0, "HB": 90, "DVA": "9 +- 1"}
    answer = impact88.reconstruct(entries, samples=0)[0]
    assert "SB" in answer.undetermined
    assert "20 times" in answer.assumed["SB"]


def test_share_of_the_critical_friction_lies_in_its_interval() -> None:
    """The normal impulse turns the sliding here; the share must not drive it."""
    scene = {**SCENE, "GA": "150 +- 10", "E": ".1 +- .1", "MU": "85 %"}
    answer = impact88.bounds(scene, ["DVA", "HAF", "PDOFA"], samples=2000)
    for bound in answer.outputs.values():
        low, high = bound.interval
        assert low < bound.nominal < high
    critical = float(impact88.solve({**SCENE, "MU": 0.0}, ["MUC"])["MUC"])
    case = impact88.cases.Case.of({**{n: str(x) for n, x in SCENE.items()}, "MU": "85 %"})
    friction = impact88.solve(case.numbers, ["MUP"])["MUP"]
    assert float(np.asarray(friction)) == pytest.approx(0.85 * critical)
