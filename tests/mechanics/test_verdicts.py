"""STATUS, bit by bit on both sides of its threshold, against computations that share no code."""

from __future__ import annotations

import math
import os

import numpy as np
import pytest
from routh import final, impulse, judged, possible

from impact88 import status
from impact88.casework.chapter.colinear import colinear
from impact88.casework.chapter.staged import collisions, forward
from impact88.casework.reconstruction.unknowns import solve_for
from impact88.casework.uncertainty.bounds import bounds
from impact88.collision.casescene import sample
from impact88.collision.uncertain import fixed_value
from impact88.mechanics.accuracy.populations import POPULATIONS, scenes
from impact88.mechanics.closedform.solve import solve
from impact88.mechanics.friction import admissible_friction
from impact88.mechanics.outcome import outcome
from impact88.status import Status

pytestmark = pytest.mark.usefixtures("both_machines")

RUN_1 = {name: float(text) for name, text in sample(1).items()}
FINAL = ("VAX", "VAY", "WAF", "VBX", "VBY", "WBF")
INITIAL = ("UX", "UY", "WA", "VX", "VY", "WB")


def bits(**change):
    return Status(int(solve({**RUN_1, **change}, "STATUS")["STATUS"]))


FRICTION = Status.FRICTION_ABOVE_CRITICAL | Status.FRICTION_WRONG_DIRECTION


def friction(scene):
    """The friction bits of every scene."""
    return np.asarray(solve(scene, "STATUS")["STATUS"]) & np.uint16(FRICTION)


def head_ons(count, seed, straight, central=False):
    """Casework with each center on its own side of the contact plane, to 80 degrees off the normal,
    or with headings and centers on it; driving along their axes without spins, or anyhow."""
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


class TestFriction:
    """Friction that cannot make the impact, by Routh's process, which shares nothing with it."""

    def test_the_eleven_collisions(self):
        told = {c.number: Status(int(forward(c)["STATUS"])) & FRICTION for c in collisions()}
        assert {number for number, bits in told.items() if not bits} == {1, 4, 5, 6, 7}
        wrong = {n for n, bits in told.items() if bits == Status.FRICTION_WRONG_DIRECTION}
        assert wrong == {12}
        for collision in collisions():
            scene = {**collision.scene, **collision.coefficients}
            assert judged(scene, scene["MUP"])[1] == (not told[collision.number])

    @pytest.mark.parametrize(
        ("straight", "central", "share"),
        [(False, False, 0.32), (True, False, 0.32), (False, True, 0.25), (True, True, 0.0)],
    )
    def test_random_scenes(self, straight, central, share):
        count = int(os.environ.get("IMPACT88_FRICTION", "10000"))
        scene = head_ons(count, 5, straight, central)
        found = solve(scene, ("STATUS", "MUP"))
        approaching, possible = judged(scene, found["MUP"])
        accused = (found["STATUS"] & np.uint16(FRICTION)) != 0
        assert possible[approaching].mean() == pytest.approx(share, abs=0.02)
        assert not (possible & accused & approaching).any()
        assert not (~possible & ~accused & approaching).any()
        assert not accused[~approaching].any()

    @pytest.mark.parametrize("off", [30, 60, 88])
    def test_forth_and_back_by_the_events_alone(self, off):
        """The judge's interval is that of its process over a grid of coefficients, and the process
        that of small steps."""
        scene = head_ons(200, off, straight=False)
        rng = np.random.default_rng(off)
        for vehicle in "AB":
            turned = scene["GA"] - scene["T" + vehicle] + rng.uniform(-off, off, 200)
            scene["P" + vehicle] = turned
        pn, _, gn, gt, K, tt = impulse(scene, solve(scene, "MUP")["MUP"])
        keep = (gn < 0) & (pn > 0)
        pn, gt, K, tt = (values[keep] for values in (pn, gt, K, tt))
        low, high = possible(gt, K, tt, pn)
        most = (np.abs(K) + np.abs(gt) / pn) / tt * 1.5
        every = [final(share * most, gt, K, tt, pn) for share in np.linspace(0, 1, 3000)]
        size = np.abs(high - low)
        assert np.all(np.min(every, axis=0) >= low - 1e-9 * pn)
        assert np.all(np.max(every, axis=0) <= high + 1e-9 * pn)
        assert np.all(np.min(every, axis=0) <= low + 2e-3 * size + 1e-9)
        assert np.all(np.max(every, axis=0) >= high - 2e-3 * size - 1e-9)
        mu = most * rng.uniform(0, 1, len(most))
        slip, q, steps = gt.copy(), np.zeros_like(gt), 4000
        for _ in range(steps):
            by_normal = K * pn / steps
            # as much friction as there is against the sliding, no more than ends it in this step
            by_friction = np.clip(-(slip + by_normal) / tt, -mu * pn / steps, mu * pn / steps)
            slip, q = slip + by_normal + tt * by_friction, q + by_friction
        np.testing.assert_allclose(q, final(mu, gt, K, tt, pn), rtol=0, atol=4e-3 * pn.max())

    def test_both_sides_of_the_limit_of_sliding_forth_and_back(self):
        """A scene whose friction acts against the sliding before, although the pivot's does not:
        the limit by bisection of the judge."""
        scene = head_ons(12000, 5, straight=False)
        pn, _, _, gt, K, _ = impulse(scene, solve(scene, "MUP")["MUP"])
        # sliding that the normal impulse alone turns round, half to twice as fast as it does
        shift = -K * pn * np.random.default_rng(5).uniform(0.5, 2, 12000) - gt
        scene["UX"] = scene["UX"] - shift * np.sin(np.radians(scene["GA"]))
        scene["UY"] = scene["UY"] + shift * np.cos(np.radians(scene["GA"]))
        told = solve(scene, ("STATUS", "MUP", "MUC"))
        approaching, fine = judged(scene, told["MUP"])
        pushes = solve({**scene, "MU": -10.0}, "PN")["PN"] > 0
        across = approaching & fine & pushes & (told["MUP"] * told["MUC"] < -1e-6)
        assert across.sum() > 10
        tried = 0
        for place in np.flatnonzero(across)[:20]:
            one = {name: float(column[place]) for name, column in scene.items()}
            sign = 1.0 if told["MUP"][place] == one["MU"] else -1.0
            inside = float(told["MUP"][place])
            outside = 1.5 * inside
            while judged(one, outside)[1]:
                outside *= 1.5
            if not judged(one, outside)[0]:
                continue  # with that much friction the vehicles would pull
            tried += 1
            for _ in range(60):
                middle = 0.5 * (inside + outside)
                inside, outside = (middle, outside) if judged(one, middle)[1] else (inside, middle)
            for share, accused in ((1 - 1e-6, False), (1 + 1e-6, True)):
                scene_there = {**one, "MU": sign * inside * share}
                assert bool(friction(scene_there)) == accused
            values = {**one, "MU": sign * outside * 1.0001}
            values |= {name: float(value) for name, value in solve(values).items()}
            (text,) = admissible_friction(int(values["STATUS"]), values)
            assert "by sliding forth and back" in text
            assert "assumed: the moment impulse grows in proportion to the normal" in text
            limit = float(text.partition("; ")[2].split()[0])
            assert limit == pytest.approx(inside, rel=2e-3)
        assert tried >= 8

    @pytest.mark.parametrize("population", POPULATIONS)
    def test_no_friction_and_the_pivot_are_no_fault(self, population):
        scene = scenes(population, 2000, 6)
        for mu in (0.0, -10.0):
            assert not friction({**scene, "MU": mu}).any()

    @pytest.mark.parametrize("number", [1, 3])
    def test_both_sides_of_the_critical_friction(self, number):
        scene = {name: float(text) for name, text in sample(number).items()}
        critical = float(solve(scene, "MUC")["MUC"])
        sign = float(np.sign(solve({**scene, "MU": 1.0}, "MUP")["MUP"]))
        for signed, expected in (
            (critical + 5e-10, 0),
            (critical + 2e-9, Status.FRICTION_ABOVE_CRITICAL),
            (-5e-10, 0),
            (-2e-9, Status.FRICTION_WRONG_DIRECTION),
        ):
            assert friction({**scene, "MU": sign * signed}) == expected
            assert bool(expected) != judged(scene, signed)[1]

    def test_straight_head_ons_keep_the_sign_typed(self):
        """No sliding before the impact: the offset alone decides which sign is admissible."""
        scene = RUN_1 | {"GA": 0.0, "UX": -30.0, "UY": 0.0, "VX": 30.0, "VY": 0.0}
        scene |= {"WA": 0.0, "WB": 0.0, "TA": 180.0, "TB": 0.0, "PA": 160.0, "PB": 20.0, "MU": 0.3}
        critical = float(solve(scene, "MUC")["MUC"])
        assert critical < -0.05
        assert friction(scene) == Status.FRICTION_WRONG_DIRECTION
        assert friction({**scene, "MU": -0.3}) == Status.FRICTION_ABOVE_CRITICAL
        assert friction({**scene, "MU": critical / 2}) == 0
        found = {name: float(value) for name, value in solve(scene).items()}
        text = admissible_friction(int(found["STATUS"]), scene | found)[-1]
        assert f"P_t/P_n from {critical:.4g} to 0, that is MU from {critical:.4g} to 0" in text
        assert text.endswith("line 400 keeps the sign of MU")

    def test_no_end_of_the_sliding(self):
        """Where the pivot would pull, any friction in its direction is admissible."""
        scene = head_ons(20000, 8, straight=True)
        pivot = solve({**scene, "MU": -10.0}, ("PN", "PT"))
        found = solve(scene, ("STATUS", "MUP", "PN", "MUC"))
        pulls = (pivot["PN"] < 0) & (found["PN"] > 0) & (friction(scene) == 0)
        assert (pulls & (found["MUP"] * found["MUC"] < 0)).sum() > 50
        wrong = np.flatnonzero((pivot["PN"] < 0) & (friction(scene) != 0))[0]
        one = {name: float(column[wrong]) for name, column in scene.items()}
        values = one | {name: float(value) for name, value in solve(one).items()}
        limit = "below 0" if values["MUP"] > 0 else "above 0"
        assert f"P_t/P_n {limit}" in admissible_friction(int(values["STATUS"]), values)[-1]

    def test_no_slip_and_no_friction_are_no_fault(self):
        head_on = {"GA": 0.0, "UY": 0.0, "VX": 14.0, "VY": 0.0, "DA": 0.0, "DB": 0.0}
        assert bits(**head_on, MU=0.0) == Status(0)
        assert bits(**head_on, MU=0.3) == Status.FRICTION_ABOVE_CRITICAL
        values = RUN_1 | head_on | {"MU": 0.3}
        values |= {name: float(value) for name, value in solve(values).items()}
        assert "P_t/P_n = 0 only" in admissible_friction(int(values["STATUS"]), values)[-1]

    def test_colinear_judges_alike(self):
        known = {"MA": 154.7, "MB": 99.1, "E": 0.1, "UN": -50.0, "UT": 10.0, "VN": 0.0, "VT": 0.0}
        critical = float(colinear({**known, "MUP": 0.0})["MUC"])
        for mu in (0.5 * critical, critical, 1.1 * critical, -0.1 * critical):
            head_on = RUN_1 | {"DA": 0.0, "DB": 0.0, "WA": 0.0, "WB": 0.0, "GA": 0.0, "MU": -mu}
            head_on |= {"MA": 154.7, "MB": 99.1, "E": 0.1, "UX": -50.0, "UY": 10.0}
            found = colinear({**known, "MUP": mu})["STATUS"]
            assert found == solve({**head_on, "VX": 0.0, "VY": 0.0}, "STATUS")["STATUS"]


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
        assert any("reverse A" in line for line in one)
        plane = bits(GA=150)
        assert plane & (Status.A_ON_WRONG_SIDE | Status.B_ON_WRONG_SIDE) == (
            Status.A_ON_WRONG_SIDE | Status.B_ON_WRONG_SIDE
        )
        lines = status.sentences(int(plane))
        assert sum("contact plane" in line for line in lines) == 1
        assert any("GA by 180" in line for line in lines)
        assert not any("reverse A" in line for line in lines)

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
        kept = {"SEPARATING": 1, "PULLING": 2, "ENERGY_GAINED": 8, "E_OUT_OF_RANGE": 16}
        kept |= {"SINGULAR": 32, "NOT_FINITE": 64, "A_ON_WRONG_SIDE": 256, "B_ON_WRONG_SIDE": 512}
        kept |= {"EM_OUT_OF_RANGE": 1024, "MU_OUT_OF_RANGE": 2048}
        kept |= {"FRICTION_ABOVE_CRITICAL": 4096, "FRICTION_WRONG_DIRECTION": 8192}
        assert {bit.name: int(bit) for bit in Status} == kept
        assert not set(status.RETIRED) & set(kept.values())
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
        ranges = {name: fixed_value(value) for name, value in known.items()}
        ranges["DA"] = status_range(scene["DA"])
        told = bounds(ranges, ["SA"], problem="reconstruction", samples=2).warnings
        assert set(told) == set(status.names(expected))


def status_range(value):
    """Uncertain in the last digit: something must vary."""
    from impact88.collision.uncertain import read

    return read(f"{value} +- 1e-12", "DA")


def test_barrier_reconstruction_has_energies():
    """An infinite body at rest adds no energy, in every solver."""
    from impact88.mechanics.outcome import reconstruction_model

    wall = {**RUN_1, "MB": np.inf, "IB": np.inf, "VX": 0.0, "VY": 0.0, "WB": 0.0, "E": 0.1}
    names = (*FINAL, "MUP", "KI", "KF", "LOSS", "STATUS")
    after = {name: float(value) for name, value in solve(wall, names).items()}
    known = {n: v for n, v in wall.items() if n not in (*INITIAL, "MU")} | {
        n: after[n] for n in (*FINAL, "MUP")
    }
    found = reconstruction_model(known, ["KI", "KF", "LOSS", "STATUS"])[0]
    for name in ("KI", "KF", "LOSS"):
        assert float(found[name]) == pytest.approx(after[name], rel=1e-10)
    assert int(found["STATUS"]) == int(after["STATUS"])
