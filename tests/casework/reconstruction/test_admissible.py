"""The limits of friction that nobody gave, against the closed form's critical friction."""

import numpy as np
import pytest

from impact88 import solve
from impact88.casework.chapter.staged import collisions
from impact88.casework.reconstruction.admissible import friction_limits
from impact88.collision.casescene import sample
from impact88.collision.geometry import Geometry
from impact88.mechanics.state import State
from impact88.names import IMPULSES


def state_of(numbers):
    impulses = solve(numbers, IMPULSES)
    values = {**numbers, **{name: float(impulses[name]) for name in IMPULSES}}
    return State(values, Geometry(values))


@pytest.mark.parametrize("run", [1, 2, 3])
def test_limits_are_wider_by_a_fifth_and_a_tenth(run):
    numbers = sample(run).numbers()
    critical = float(solve(numbers, ("MUC",))["MUC"])
    low, high = friction_limits(state_of(numbers))
    assert low == pytest.approx(-0.2 * critical - 0.1)
    assert high == pytest.approx(1.2 * critical + 0.1)


def test_six_of_the_eleven_staged_collisions_need_that():
    """By the friction of the chapter's Table 2; with none of it they would be impossible."""
    beyond = set()
    for collision in collisions():
        printed = collision.table2
        coefficients = {"E": printed["e"], "EM": printed["em"], "MU": printed["mu"], "M": 6.0}
        state = state_of({**collision.scene, **coefficients})
        low, high = friction_limits(state)
        assert low < printed["mu"] < high, collision.number
        low, high = friction_limits(state, strict=True)
        if not low <= printed["mu"] <= high:
            beyond.add(collision.number)
    assert beyond == {3, 8, 9, 10, 11, 12}


def test_where_nothing_ends_the_sliding_friction_is_ten_at_most():
    rng = np.random.default_rng(3)
    for _ in range(300):
        change = {name: float(rng.uniform(-80, 80)) for name in ("PA", "PB", "UX", "UY")}
        numbers = {**sample(1).numbers(), **change}
        if float(solve({**numbers, "MU": -10.0}, ("PN",))["PN"]) < 0:
            assert max(np.abs(friction_limits(state_of(numbers)))) == 10.0
            return
    pytest.fail("no such scene")
