"""STATUS, bit by bit on both sides of its threshold, against computations that share no code."""

import math

import numpy as np
import pytest
from populations import POPULATIONS, scenes
from routh import judged

from impact88 import sample, solve, status
from impact88.chapter.staged import collisions
from impact88.status import Status

RUN_1 = sample(1).numbers()
FRICTION = Status.FRICTION_ABOVE_CRITICAL | Status.FRICTION_WRONG_DIRECTION
SIDES = Status.A_ON_WRONG_SIDE | Status.B_ON_WRONG_SIDE


def bits(**change):
    return Status(int(solve({**RUN_1, **change}, "STATUS")["STATUS"]))


def friction(scene):
    return np.asarray(solve(scene, "STATUS")["STATUS"]) & np.uint16(FRICTION)


def head_ons(count, seed, straight, central=False):
    """Return cars with each center on its own side of the contact plane, to 80 degrees off the
    normal, or with headings and centers on it; driving along their axes without spins, or not."""
    rng = np.random.default_rng(seed)
    scene = scenes("casework", count, seed)
    for vehicle, (x, y) in (("A", ("UX", "UY")), ("B", ("VX", "VY"))):
        off = rng.uniform(-80, 80, count)
        if central:
            off, scene["T" + vehicle] = 0.0, scene["GA"]
        scene["P" + vehicle] = scene["GA"] - scene["T" + vehicle] + off
        if straight:
            speed, heading = rng.uniform(-90, 90, count), np.radians(scene["T" + vehicle])
            scene[x], scene[y] = speed * np.cos(heading), speed * np.sin(heading)
            scene["W" + vehicle] = np.zeros(count)
    return scene


def staged_scene(collision):
    """Return a staged collision's scene with Table 2's coefficients, MU as typed."""
    scene = {**collision.scene, **collision.coefficients}
    scene["MU"] = scene.pop("MUP")
    is_reversed = solve(scene, "MUP")["MUP"] != scene["MU"]
    return {**scene, "MU": -scene["MU"]} if is_reversed else scene


class TestFriction:
    """Friction that cannot make the impact, by Routh's process."""

    def test_the_eleven_collisions(self):
        statuses = {c.number: Status(int(solve(staged_scene(c))["STATUS"])) for c in collisions()}
        assert {number for number, x in statuses.items() if not x & FRICTION} == {1, 4, 5, 6, 7}
        assert not any(x & SIDES for x in statuses.values())
        for collision in collisions():
            scene = {**collision.scene, **collision.coefficients}
            is_possible = judged(scene, scene["MUP"])[1]
            assert is_possible == (not statuses[collision.number] & FRICTION)

    @pytest.mark.parametrize(
        ("straight", "central", "part"),
        [(False, False, 0.32), (True, False, 0.32), (False, True, 0.25), (True, True, 0.0)],
    )
    def test_random_scenes(self, straight, central, part):
        scene = head_ons(4000, 5, straight, central)
        results = solve(scene, ("STATUS", "MUP"))
        approaching, possible = judged(scene, results["MUP"])
        has_bit = (results["STATUS"] & np.uint16(FRICTION)) != 0
        assert possible[approaching].mean() == pytest.approx(part, abs=0.03)
        assert not (possible & has_bit & approaching).any()
        assert not (~possible & ~has_bit & approaching).any()
        assert not has_bit[~approaching].any()

    @pytest.mark.parametrize("population", POPULATIONS)
    def test_no_friction_and_the_pivot_are_no_fault(self, population):
        scene = scenes(population, 500, 6)
        for mu in (0.0, -10.0):
            assert not friction({**scene, "MU": mu}).any()

    @pytest.mark.parametrize("number", [1, 3])
    def test_both_sides_of_the_critical_friction(self, number):
        scene = sample(number).numbers()
        critical = float(solve(scene, "MUC")["MUC"])
        sign = float(np.sign(solve({**scene, "MU": 1.0}, "MUP")["MUP"]))
        for friction_at, bit in (
            (critical + 5e-10, 0),
            (critical + 2e-9, Status.FRICTION_ABOVE_CRITICAL),
            (-5e-10, 0),
            (-2e-9, Status.FRICTION_WRONG_DIRECTION),
        ):
            assert friction({**scene, "MU": sign * friction_at}) == bit
            assert bool(bit) != judged(scene, friction_at)[1]

    def test_no_slip_and_no_friction_are_no_fault(self):
        head_on = {"GA": 0.0, "UY": 0.0, "VX": 14.0, "VY": 0.0, "DA": 0.0, "DB": 0.0}
        assert bits(**head_on, MU=0.0) == Status(0)
        assert bits(**head_on, MU=0.3) == Status.FRICTION_ABOVE_CRITICAL


class TestSides:
    """The contact point is at the angle TA + PA + 180 from A, at TB + PB from B."""

    @pytest.mark.parametrize("vehicle", ["A", "B"])
    def test_either_side_of_the_plane(self, vehicle):
        bit = Status.A_ON_WRONG_SIDE if vehicle == "A" else Status.B_ON_WRONG_SIDE
        level = 90 - RUN_1["T" + vehicle] + RUN_1["GA"]
        for off, is_wrong in ((-0.01, False), (0.0, False), (0.01, True)):
            angle = math.radians(RUN_1["T" + vehicle] + level + off - RUN_1["GA"])
            assert (RUN_1["D" + vehicle] * math.cos(angle) < -1e-6) == is_wrong
            change = {"P" + vehicle: level + off}
            assert (bit in bits(**change)) == is_wrong

    def test_what_to_reverse(self):
        sentences = status.sentences(int(bits(TA=180)))
        assert any("reverse A" in line for line in sentences)
        assert bits(GA=150) & SIDES == SIDES
        lines = status.sentences(int(bits(GA=150)))
        assert sum("contact plane" in line for line in lines) == 1
        assert any("GA by 180" in line for line in lines)
        assert not bits(GA=150, M=4) & SIDES


class TestRangesAndEnergies:
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
            change = {name: value}
            assert not bits(**change) & ranges, value
        for value in outside:
            change = {name: value}
            assert bits(**change) & ranges == bit, value

    def test_published_runs_have_no_remark(self):
        for number in (1, 2, 3):
            assert not solve(sample(number), "STATUS")["STATUS"]

    def test_a_gain_of_energy_is_reported_from_1e_12_on(self):
        """E a little above 1 without friction and moment: the gain is (E^2 - 1) of the approach."""
        head_on = {"GA": 0.0, "UX": -9.0, "UY": 0.0, "VX": 9.0, "VY": 0.0, "MB": RUN_1["MA"]}
        head_on |= {"DA": 0.0, "DB": 0.0, "MU": 0.0, "EM": 1.0}
        assert Status.ENERGY_GAINED not in bits(**head_on, E=1 + 3e-13)
        assert Status.ENERGY_GAINED in bits(**head_on, E=1 + 8e-13)

    def test_approach_and_push(self):
        """Vehicles that separate already and pull each other together, and their mirror image."""
        head_on = {"GA": 0.0, "UY": 0.0, "VX": 0.0, "VY": 0.0, "DA": 0.0, "DB": 0.0, "MU": 0.0}
        assert bits(**head_on, UX=-1e-9) & 3 == 0
        assert bits(**head_on, UX=0.0) & 3 == Status.SEPARATING
        assert bits(**head_on, UX=1e-9) & 3 == Status.SEPARATING | Status.PULLING

    def test_numbers_keep_their_meaning(self):
        """Results that earlier versions wrote are read by their numbers."""
        values = {"SEPARATING": 1, "PULLING": 2, "ENERGY_GAINED": 8, "E_OUT_OF_RANGE": 16}
        values |= {"SINGULAR": 32, "NOT_FINITE": 64, "A_ON_WRONG_SIDE": 256, "B_ON_WRONG_SIDE": 512}
        values |= {"EM_OUT_OF_RANGE": 1024, "MU_OUT_OF_RANGE": 2048}
        values |= {"FRICTION_ABOVE_CRITICAL": 4096, "FRICTION_WRONG_DIRECTION": 8192}
        assert {bit.name: int(bit) for bit in Status} == values
        assert not set(status.RETIRED) & set(values.values())
        assert all(status.WORDS[bit] for bit in Status)

    def test_singular_from_a_condition_of_2_26(self):
        """Friction next to what makes the determinant 0."""
        g = scenes("singular", 300, 2)
        results = solve(g, ("COND", "STATUS"))
        has_bit = (results["STATUS"] & np.uint16(Status.SINGULAR)) != 0
        np.testing.assert_array_equal(has_bit, results["COND"] >= 2.0**26)
        assert 50 < has_bit.sum() < 250
