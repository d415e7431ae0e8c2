"""Every number of a file is what exact arithmetic gives, and is shown as it was written."""

import math
from fractions import Fraction

import exactcases
import numpy as np
import pytest

from impact88.cases import Case


@pytest.mark.parametrize("seed", range(60))
def test_entries_are_exact_and_shown_as_written(seed: int) -> None:
    text, _, exact = exactcases.scene_file(seed)
    case = Case.loads(text)
    for name, numbers in exact.items():
        amount = case.entries[name]
        read = amount.value, amount.low, amount.high, amount.sd
        for is_, exact_number in zip(read, numbers, strict=True):
            assert math.isclose(is_, exact_number, rel_tol=1e-12, abs_tol=1e-300), (name, text)

        base, view = float(numbers[0]), case.view
        factor, offset = view.map(name)
        shown = (Fraction(base) - offset) / factor
        turn = 360 if view.headings and name in ("TA", "TB") else math.inf
        largest = max(abs(base), abs(offset)) if offset else 0
        error = math.remainder(float(Fraction(view.shown(name, base)) - shown), turn)
        assert abs(error) <= 2 * math.ulp(float(max(abs(shown), largest)))
        value = Case.of({name: view.shown(name, base)}, view=view).entries[name].value
        assert abs(math.remainder(value - base, turn)) <= 2 * math.ulp(
            float(max(abs(base), largest))
        )
        array = view.shown(name, np.array([base, base]))
        error = math.remainder(float(Fraction(float(array[1])) - shown), turn)
        assert abs(error) <= 2 * math.ulp(float(max(abs(shown), largest)))
