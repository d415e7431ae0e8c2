"""Equation 19, as the chapter used it and as it printed it."""

from __future__ import annotations

import numpy as np
import pytest

from impact88.chapter import deltav
from impact88.chapter.deltav import AS_PRINTED, AS_USED, delta_v, described
from impact88.chapter.staged import collisions, predicted

SLIPS = {(6, "b")}


def test_the_default_reproduces_the_predicted_column_of_table_2() -> None:
    differing = set()
    for collision in collisions():
        found = predicted(collision)
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
    assert "without the factor 2/3" in described(AS_PRINTED)
    assert "factor 2/3" in described(AS_USED)
    assert "0.7" in described(0.7)
    assert "with the factor 2/3*, which reproduces Table 2" in str(deltav.__doc__)


def test_momenta_are_equal_and_arrays_broadcast() -> None:
    losses = np.array([0.0, 30.0, 60.0, -1.0])
    found = delta_v({"MA": 100.0, "MB": 50.0, "SA": 30.0, "SB": 40.0, "LOSS": losses})
    np.testing.assert_allclose(100.0 * found["DVA"][:3], 50.0 * found["DVB"][:3])
    assert found["DVA"][0] == 0
    assert np.isnan(found["DVA"][3])
    assert found["DVA"][2] == pytest.approx(np.sqrt(2) * found["DVA"][1])
