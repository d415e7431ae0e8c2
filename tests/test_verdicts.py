"""STATUS, bit by bit on both sides of its threshold, against a solution that shares no code: the
six equations as the chapter prints them, filled into a matrix and solved by elimination."""

from __future__ import annotations

import math

import numpy as np
import pytest

from impact88 import status
from impact88.chapter.staged import collisions, forward
from impact88.closedform.solve import solve
from impact88.reconstruction.outcome import outcome
from impact88.reconstruction.unknowns import solve_for
from impact88.scene import sample
from impact88.status import Status
from impact88.uncertainty.bounds import bounds
from impact88.uncertainty.uncertain import fixed

RUN_1 = {name: float(text) for name, text in sample(1).items()}
FINAL = ("VAX", "VAY", "WAF", "VBX", "VBY", "WBF")
INITIAL = ("UX", "UY", "WA", "VX", "VY", "WB")


def slips(scene, signed_mu):
    """Tangential relative velocity at C before and after, and P_t: Equations 13-18 with the
    friction coefficient as it stands in Equation 16, over unknowns Vax Vay Wa Vbx Vby Wb."""
    ma, mb, ia, ib = (scene[n] for n in ("MA", "MB", "IA", "IB"))
    g, ta, tb = (math.radians(scene[n]) for n in ("GA", "TA", "TB"))
    pa, pb = math.radians(scene["PA"]), math.radians(scene["PB"])
    d1, d2 = scene["DB"] * math.sin(tb + pb), scene["DB"] * math.cos(tb + pb)
    d3, d4 = scene["DA"] * math.sin(ta + pa), scene["DA"] * math.cos(ta + pa)
    e, em = scene["E"], scene["EM"]
    v = np.array([scene[n] for n in INITIAL])
    c, s = math.cos(g), math.sin(g)
    normal = np.array([c, s, d3 * c - d4 * s, -c, -s, d1 * c - d2 * s])
    rows = np.zeros((6, 6))
    right = np.zeros(6)
    rows[0, [0, 3]] = rows[1, [1, 4]] = ma, mb  # 13, 14
    right[:2] = rows[:2] @ v
    rows[2], right[2] = normal, -e * (normal @ v)  # 15
    rows[3, 1] = ma * (c - signed_mu * s)  # 16
    rows[3, 3] = mb * (s + signed_mu * c)
    rows[4] = [0, ma * (d2 + d4), ia, mb * (d1 + d3), 0, ib]  # 17
    right[3:5] = rows[3:5] @ v
    bracket = np.array([-ma * d3 / ia, ma * d4 / ia, 1, -mb * d1 / ib, mb * d2 / ib, -1])
    rows[5] = np.array([0, 0, -1, 0, 0, 1]) * (1 - em) + em * bracket  # 18
    right[5] = em * (bracket @ v)
    after = np.linalg.solve(rows, right)
    # velocities of both contact points, as Figure 3 has them, along t = (-sin, cos)
    tangential = []
    for x, y, w, X, Y, W in (v, after):
        a = (x + d3 * w, y - d4 * w)
        b = (X - d1 * W, Y + d2 * W)
        tangential.append(-(a[0] - b[0]) * s + (a[1] - b[1]) * c)
    pt = ma * (-(after[0] - v[0]) * s + (after[1] - v[1]) * c)
    return tangential[0], tangential[1], pt


def bits(**change):
    return Status(int(solve({**RUN_1, **change}, "STATUS")["STATUS"]))


class TestSliding:
    """The eleven staged collisions with Table 2's coefficients."""

    def test_the_eleven_collisions(self):
        reversed_in, driven_in = set(), set()
        for collision in collisions():
            scene = {**collision.scene, **collision.coefficients}
            before, after, pt = slips(scene, scene["MUP"])
            found = Status(int(forward(collision)["STATUS"]))
            assert (Status.SLIDING_REVERSED in found) == (before * after < 0), collision.number
            assert (Status.FRICTION_DRIVES in found) == (pt * before > 0), collision.number
            reversed_in |= {collision.number} if Status.SLIDING_REVERSED in found else set()
            driven_in |= {collision.number} if Status.FRICTION_DRIVES in found else set()
        assert reversed_in == {4, 5, 8, 9, 10, 12}
        assert driven_in == {3, 4, 5, 11}

    @pytest.mark.parametrize(
        ("number", "before", "after"),
        [
            (3, -5.40, -1.23),
            (11, 5.20, 3.49),
            (4, -9.86, 7.18),
            (5, -10.11, 7.45),
            (12, 8.02, -8.99),
        ],
    )
    def test_the_slips_told_of(self, number, before, after):
        collision = next(c for c in collisions() if c.number == number)
        scene = {**collision.scene, **collision.coefficients}
        assert slips(scene, scene["MUP"])[:2] == pytest.approx((before, after), abs=0.006)

    @pytest.mark.parametrize("number", [1, 3])
    def test_both_sides_of_the_critical_friction(self, number):
        scene = {name: float(text) for name, text in sample(number).items()}
        critical = float(solve(scene, "MUC")["MUC"])
        sign = float(np.sign(solve({**scene, "MU": 1.0}, "MUP")["MUP"]))
        for factor, is_reversed in ((0.9999, False), (1.0, False), (1.0001, True)):
            before, after, _ = slips(scene, critical * factor)
            assert (before * after < -1e-9) == is_reversed
            found = Status(
                int(solve({**scene, "MU": sign * critical * factor}, "STATUS")["STATUS"])
            )
            assert (Status.SLIDING_REVERSED in found) == is_reversed
        assert Status.SLIDING_REVERSED not in Status(
            int(solve({**scene, "MU": -10.0}, "STATUS")["STATUS"])
        )

    def test_random_scenes(self):
        rng = np.random.default_rng(12)
        seen = set()
        for _ in range(150):
            scene = RUN_1 | {n: rng.uniform(-50, 50) for n in ("UX", "UY", "VX", "VY", "PA", "PB")}
            scene |= {n: rng.uniform(-2, 2) for n in ("WA", "WB")}
            scene |= {"MU": rng.uniform(-1, 1), "E": rng.uniform(0, 1), "GA": rng.uniform(-60, 60)}
            found = solve(scene, ("STATUS", "MUP"))
            before, after, pt = slips(scene, float(found["MUP"]))
            told = Status(int(found["STATUS"]))
            assert (Status.SLIDING_REVERSED in told) == (before * after < 0)
            assert (Status.FRICTION_DRIVES in told) == (pt * before > 0)
            seen.add(told & (Status.SLIDING_REVERSED | Status.FRICTION_DRIVES))
        assert len(seen) == 4  # neither, each, both

    def test_no_slip_and_no_friction_are_no_fault(self):
        head_on = {"GA": 0.0, "UY": 0.0, "VX": 14.0, "VY": 0.0, "DA": 0.0, "DB": 0.0}
        assert bits(**head_on, MU=0.0) == Status(0)
        # 60 degrees in radians is no exact number: a slip by rounding is none
        along = {"UX": -math.cos(math.radians(30)) * 30, "UY": math.sin(math.radians(30)) * 30}
        assert bits(**{**head_on, **along, "GA": -30.0, "VX": 0.0}, MU=0.3) == Status(0)


class TestSides:
    """The contact point is at the angle TA + PA + 180 from A, at TB + PB from B."""

    def heights(self, scene):
        """Distance of each center from the contact plane, towards its own side."""
        a, b = (math.radians(scene["T" + v] + scene["P" + v] - scene["GA"]) for v in "AB")
        return scene["DA"] * math.cos(a), scene["DB"] * math.cos(b)

    @pytest.mark.parametrize("vehicle", ["A", "B"])
    def test_either_side_of_the_plane(self, vehicle):
        bit = Status.A_ON_WRONG_SIDE if vehicle == "A" else Status.B_ON_WRONG_SIDE
        level = 90 - RUN_1["T" + vehicle] + RUN_1["GA"]
        for off, is_wrong in ((-0.01, False), (0.0, False), (0.01, True)):
            scene = RUN_1 | {"P" + vehicle: level + off}
            assert (self.heights(scene)["AB".index(vehicle)] < -1e-6) == is_wrong
            assert (bit in bits(**{"P" + vehicle: level + off})) == is_wrong

    def test_a_sideswipe_set_up_the_wrong_way_round(self):
        """B's heading turned by 180 degrees: the cars stand in each other, no energy is gained."""
        sideswipe = {"GA": 80.0, "TA": 0.0, "PA": 30.0, "TB": 0.0, "PB": 30.0, "MU": 0.2}
        sideswipe |= {"UX": -30.0, "UY": -6.0, "VX": 20.0, "VY": 0.0}
        assert not bits(**sideswipe) & (Status.A_ON_WRONG_SIDE | Status.B_ON_WRONG_SIDE)
        turned = bits(**{**sideswipe, "TB": 180.0})
        assert Status.B_ON_WRONG_SIDE in turned
        assert Status.ENERGY_GAINED not in turned

    def test_what_to_turn_round(self):
        one = status.sentences(int(bits(TA=180)))
        assert any("turn round A" in line for line in one)
        plane = bits(GA=150)
        assert plane & (Status.A_ON_WRONG_SIDE | Status.B_ON_WRONG_SIDE) == (
            Status.A_ON_WRONG_SIDE | Status.B_ON_WRONG_SIDE
        )
        lines = status.sentences(int(plane))
        assert sum("contact plane" in line for line in lines) == 1
        assert any("GA by 180" in line for line in lines)
        assert not any("turn round A" in line for line in lines)

    def test_staged_collisions_and_point_masses_stand_right(self):
        sides = Status.A_ON_WRONG_SIDE | Status.B_ON_WRONG_SIDE
        for collision in collisions():
            assert not Status(int(forward(collision)["STATUS"])) & sides
        assert not bits(GA=150, M=4) & sides


class TestRanges:
    @pytest.mark.parametrize(
        ("name", "bit", "inside", "outside"),
        [
            ("E", Status.E_OUT_OF_RANGE, (0.0, 1.0), (-0.001, 1.001)),
            ("EM", Status.EM_OUT_OF_RANGE, (-1.0, 0.0, 1.0), (-1.001, 0.001, 0.999, 1.001)),
            ("MU", Status.MU_OUT_OF_RANGE, (-10.0, -9.999, 9.0), (-10.001,)),
        ],
    )
    def test_each_has_a_bit_of_its_own(self, name, bit, inside, outside):
        ranges = Status.E_OUT_OF_RANGE | Status.EM_OUT_OF_RANGE | Status.MU_OUT_OF_RANGE
        for value in inside:
            assert not bits(**{name: value}) & ranges, value
        for value in outside:
            assert bits(**{name: value}) & ranges == bit, value

    def test_numbers_keep_their_meaning(self):
        """Results written down by earlier versions are read by their numbers."""
        kept = {"SEPARATING": 1, "PULLING": 2, "SLIDING_REVERSED": 4, "ENERGY_GAINED": 8}
        kept |= {"SINGULAR": 32, "NOT_FINITE": 64, "FRICTION_DRIVES": 128}
        assert {name: int(Status[name]) for name in kept} == kept
        assert all(status.WORDS[bit] for bit in Status)


class TestEverySolver:
    """solve, solve_for and bounds tell the same of one impact."""

    @pytest.mark.parametrize(
        "change",
        [{}, {"GA": 150.0}, {"MU": -0.4}, {"TB": 240.0}, {"EM": 1.0}, {"E": 1.2}, {"MU": 1.2}],
    )
    def test_agree(self, change):
        scene = {**RUN_1, **change}
        expected = int(solve(scene, "STATUS")["STATUS"])
        after = {name: float(value) for name, value in solve(scene, (*FINAL, "MUP")).items()}
        forward_again = solve_for({n: v for n, v in scene.items() if n not in FINAL})[0]
        assert int(outcome({**scene, **forward_again.values})["STATUS"]) == expected
        known = {n: v for n, v in {**scene, **after}.items() if n not in (*INITIAL, "MU")}
        (back,) = solve_for(known)
        assert int(outcome({**known, **back.values})["STATUS"]) == expected
        ranges = {name: fixed(value) for name, value in known.items()}
        ranges["DA"] = status_range(scene["DA"])
        told = bounds(ranges, ["SA"], problem="reconstruction", samples=2).warnings
        assert set(told) == set(status.names(expected))


def status_range(value):
    """Uncertain in the last digit: something must vary."""
    from impact88.uncertainty.uncertain import read

    return read(f"{value} +- 1e-12", "DA")


def test_barrier_reconstruction_has_energies():
    """An infinite body at rest adds no energy, in every solver."""
    from impact88.reconstruction.model import reconstruction_model

    wall = {**RUN_1, "MB": np.inf, "IB": np.inf, "VX": 0.0, "VY": 0.0, "WB": 0.0, "E": 0.1}
    names = (*FINAL, "MUP", "KI", "KF", "LOSS", "STATUS")
    after = {name: float(value) for name, value in solve(wall, names).items()}
    known = {n: v for n, v in wall.items() if n not in (*INITIAL, "MU")} | {
        n: after[n] for n in (*FINAL, "MUP")
    }
    found = reconstruction_model(known, ["KI", "KF", "LOSS", "STATUS"])
    for name in ("KI", "KF", "LOSS"):
        assert float(found[name]) == pytest.approx(after[name], rel=1e-10)
    assert int(found["STATUS"]) == int(after["STATUS"])
