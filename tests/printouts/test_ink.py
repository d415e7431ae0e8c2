"""Ink of pictures: the level between grain and ink, and the holes along a sheet's edge."""

import numpy as np
import pytest

from impact88.printouts.scan.ink import Spot, hole_columns, threshold


@pytest.mark.parametrize("inked", [0.01, 0.1, 0.5])
def test_the_level_between_grain_and_ink(inked):
    random = np.random.default_rng(3)
    grain, ink = random.normal(0.2, 0.03, 20_000), random.normal(0.8, 0.05, round(20_000 * inked))
    assert 0.3 < threshold(np.concatenate([grain, ink])) < 0.7


def test_holes_are_evenly_spaced():
    places = 40.0 * np.arange(20)
    width = 1000.0
    holes = [Spot(20.0, y, 16.0, 16.0, 0.9) for y in places]
    assert [len(column) for column in hole_columns(holes, width)] == [20]
    torn = [hole for hole in holes if hole.y not in places[5:12]]
    assert not [*hole_columns(torn, width)]
