"""The chapter's numbers: Section VII, Tables 1 and 2, published tests, the two special cases."""

import numpy as np
import pytest

from impact88.chapter import deltav, staged
from impact88.chapter.barrier import BARRIER, barrier
from impact88.chapter.colinear import FINAL, INITIAL, colinear, colinear_inverse
from impact88.chapter.example import steps
from impact88.chapter.validation import checks, medians
from impact88.errors import UserError
from impact88.mechanics.solve import solve


def test_section_vii_gives_every_number_that_the_chapter_prints():
    numbers = [number for step in steps() for number in step.numbers if number.printed]
    assert [n.printed for n in numbers[3:7]] == ["-40.21", "58.24", "36.2", "24.0"]
    assert len(numbers) == 11
    assert all(number.agrees for number in numbers)


def test_table_2_is_recomputed_but_for_its_slips():
    rows = staged.comparison()
    assert len(rows) == 77
    odd = {(row.collision, row.column) for row in rows if not row.agrees}
    slips = {(3, "loss"), (11, "dVa_comp"), (12, "dVb_comp"), (6, "dVb_pred")}
    lost = {(8, "dVa_exp")}
    assert odd == slips | lost
    assert all(
        row.explanation and row.explanation != "not explained" for row in rows if not row.agrees
    )


def test_published_crash_tests():
    values = {(source, quantity): (count, middle, largest)
             for source, quantity, _, _, count, middle, largest in medians(checks())}  # fmt: skip
    count, _, largest = values["NHTSA oblique offset", "critical impulse ratio"]
    assert (count, round(largest, 3)) == (4, 0.006)
    count, middle, largest = values["IIHS small overlap", "ΔV along the course"]
    assert (count, round(middle, 2), round(largest, 1)) == (21, 0.92, 4.8)


@pytest.fixture
def impacts():
    rng = np.random.default_rng(2)
    inputs = {"MA": 154.7, "MB": 99.1, "E": rng.uniform(0.1, 1, 200)}
    inputs["MUP"] = rng.normal(0, 0.5, 200)
    return inputs | {name: rng.normal(0, 30, 200) for name in INITIAL}


def test_colinear_impact_is_that_of_point_masses(impacts):
    values = colinear(impacts)
    scene = {"M": 4, "MA": 154.7, "MB": 99.1, "E": impacts["E"], "GA": 0, "WA": 0, "WB": 0}
    scene |= {x: impacts[n] for x, n in zip(("UX", "UY", "VX", "VY"), INITIAL, strict=True)}
    slides_along_t = impacts["UT"] > impacts["VT"]
    scene["MU"] = np.where(slides_along_t, -impacts["MUP"], impacts["MUP"])
    reference = solve(scene)
    for name, like in zip(FINAL, ("VAX", "VAY", "VBX", "VBY"), strict=True):
        np.testing.assert_allclose(values[name], reference[like], atol=1e-9)
    np.testing.assert_allclose(values["LOSS"], reference["LOSS"], atol=1e-9)


def test_colinear_inverse_goes_back(impacts):
    values = colinear(impacts)
    after = {name: values[name] for name in FINAL}
    back = colinear_inverse({n: impacts[n] for n in ("MA", "MB", "E", "MUP")} | after)
    for name in INITIAL:
        np.testing.assert_allclose(back[name], impacts[name], atol=1e-9)


def test_no_inverse_without_restitution():
    inputs = {"MA": 1, "MB": 2, "MUP": 0, **dict.fromkeys(FINAL, 1.0)}
    with pytest.raises(UserError, match="E = 0"):
        colinear_inverse({**inputs, "E": 0})
    assert np.isnan(colinear_inverse({**inputs, "E": [0.0, 0.5]})["UN"][0])


def test_a_barrier_is_a_body_of_enormous_mass():
    car = {"DA": 7.59, "GA": -30, "PA": -19.8, "TA": 0, "MA": 143.5, "IA": 3728}
    car |= {"E": 0.1, "MU": 0.4, "EM": -1, "UX": -29, "UY": 0, "WA": 0}
    heavy = solve({**BARRIER, **car, "MB": 1e13, "IB": 1e13})
    for name, value in barrier(car).items():
        np.testing.assert_allclose(value, heavy[name], rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize(("name", "value"), [("MB", 3), ("UZ", 1)])
def test_what_is_no_value_of_a_barrier(name, value):
    with pytest.raises(UserError, match=name):
        barrier({name: value})


def test_losses_and_speeds_for_equation_19():
    inputs = {"MA": 96, "MB": 145, "SA": 36.667, "SB": 58.667}
    energy = 0.374 * (96 * 36.667**2 + 145 * 58.667**2) / 2
    assert deltav.loss_of_energy({**inputs, "EL": energy}) == pytest.approx(37.4)
    assert deltav.initial_velocity(5.0, -3.0, 4.0) == pytest.approx(-6.0)
    with pytest.raises(UserError, match="less than the final velocity"):
        deltav.initial_velocity(1.0, 0.0, 2.0)
    with pytest.raises(UserError, match="LOSS"):
        deltav.delta_v(inputs)


def test_error_of_equation_19_against_the_measurements():
    off = []
    for collision in staged.collisions():
        changes = staged.prediction(collision)
        table = collision.table2
        off += [float(changes["DV" + v.upper()]) - table[f"dV{v}_exp"] for v in "ab"]
    assert round(float(np.sqrt(np.mean(np.square(off)))), 1) == 3.8
    assert round(float(np.abs(off).max()), 1) == 8.2
