"""Equation 19, as the chapter used it and as it printed it."""

from __future__ import annotations

import numpy as np
import pytest

from impact88.casework.chapter import deltav
from impact88.casework.chapter.deltav import (
    AS_PRINTED,
    AS_USED,
    delta_v,
    describe,
    initial_velocity,
    loss_of,
    speeds_before,
)
from impact88.casework.chapter.staged import collisions, predict_delta_v
from impact88.errors import UserError

SLIPS = {(6, "b")}


def test_the_default_reproduces_the_predicted_column_of_table_2() -> None:
    differing = set()
    for collision in collisions():
        found = predict_delta_v(collision)
        for vehicle in "ab":
            value = float(found[f"DV{vehicle.upper()}"])
            # to the last printed digit, the loss being printed to a tenth of a percent
            rounding = 0.05 + value * 0.05 / (2 * collision.table2["loss"])
            if abs(value - collision.table2[f"dV{vehicle}_pred"]) > rounding + 1e-9:
                differing.add((collision.number, vehicle))
    assert differing == SLIPS


def test_as_printed_it_is_half_as_much_again_and_reproduces_nothing() -> None:
    known = {"MA": 96, "MB": 145, "SA": 36.667, "SB": 58.667, "LOSS": 37.4}
    used, printed = delta_v(known), delta_v(known, AS_PRINTED)
    for name in ("DVA", "DVB"):
        assert float(printed[name]) == pytest.approx(1.5 * float(used[name]))
    assert pytest.approx(2 / 3) == AS_USED


def test_docstrings_and_output_say_which_it_is() -> None:
    assert "2/3" in str(delta_v.__doc__)
    assert "without the factor 2/3" in describe(AS_PRINTED)
    assert "factor 2/3" in describe(AS_USED)
    assert "0.7" in describe(0.7)
    assert "with the factor 2/3*, which reproduces Table 2" in str(deltav.__doc__)


def test_momenta_are_equal_and_arrays_broadcast() -> None:
    losses = np.array([0.0, 30.0, 60.0, -1.0])
    found = delta_v({"MA": 100.0, "MB": 50.0, "SA": 30.0, "SB": 40.0, "LOSS": losses})
    np.testing.assert_allclose(100.0 * found["DVA"][:3], 50.0 * found["DVB"][:3])
    assert found["DVA"][0] == 0
    assert np.isnan(found["DVA"][3])
    assert found["DVA"][2] == pytest.approx(np.sqrt(2) * found["DVA"][1])


FINALS = {"MA": 96.0, "MB": 145.0, "VAX": -10.0, "VAY": 20.0, "VBX": -20.0, "VBY": 45.0}


def test_speeds_before_start_from_equations_13_and_14() -> None:
    """Section VII: -40.21 and 58.24 ft/s are what momentum gives for these final velocities."""
    given = {**FINALS, "SA": 10 + 20 * 145 / 96, "SB": 45 + 20 * 96 / 145}
    found, expected = speeds_before(FINALS, 40.0), speeds_before(given, 40.0)
    assert found == pytest.approx(expected, rel=1e-12)
    assert (given["SA"], given["SB"]) == pytest.approx((40.21, 58.24), abs=0.005)


def test_a_final_velocity_across_as_large_as_the_change_leaves_one_root() -> None:
    assert initial_velocity(3.0, 5.0, 3.0) == 5.0
    with pytest.raises(UserError, match="less than the final velocity 3"):
        initial_velocity(2.999, 5.0, 3.0)


@pytest.mark.parametrize(
    ("known", "absent"),
    [({"MB": 1, "SA": 1, "SB": 1, "DVA": 1}, "MA"), ({"MA": 1, "MB": 1, "SA": 1, "SB": 1}, "DVA")],
)
def test_a_loss_names_what_is_missing(known: dict[str, float], absent: str) -> None:
    with pytest.raises(UserError, match=f"missing {absent} "):
        loss_of(known)
