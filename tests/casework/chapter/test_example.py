"""Section VII, computed, against the numbers it prints."""

from __future__ import annotations

import pytest
from reference_cases import cases_of

from impact88.casework.chapter import example
from impact88.casework.chapter.example import steps
from impact88.casework.reconstruction.unknowns import solve_for

PRINTED = {
    1: {"UX": "-40.21", "VY": "58.24"},
    2: {"DVA": "36.2", "DVB": "24.0"},
    3: {"DVA": "39.1", "DVB": "25.9"},
    4: {"UX": "-43.6", "VY": "61.5"},
}
"""Step -> the numbers the chapter prints."""


@pytest.mark.parametrize(
    ("step", "name"), [(step, name) for step, names in PRINTED.items() for name in names]
)
def test_every_printed_number_is_reproduced(step: int, name: str) -> None:
    number = next(n for n in steps()[step].numbers if n.name == name)
    assert number.printed == PRINTED[step][name]
    assert number.agrees
    decimals = len(number.printed.partition(".")[2])
    assert abs(number.value - float(number.printed)) <= 0.5 * 10**-decimals


def test_the_truth_is_table_3() -> None:
    truth = steps()[0]
    assert all(number.agrees is not False for number in truth.numbers)
    assert truth["DVA"] == pytest.approx(39.1, abs=0.05)
    assert truth["LOSS"] == pytest.approx(37.4037034, abs=1e-6)


def test_the_stated_loss_would_not_give_the_printed_numbers() -> None:
    assert steps()[3]["DVA stated"] == pytest.approx(40.43, abs=0.01)
    assert steps()[3]["DVA printed"] == pytest.approx(1.5 * steps()[3]["DVA"])


def test_the_last_step_is_the_reference_case() -> None:
    (case,) = cases_of("three")
    for name, value in case.velocities.items():
        if name in ("WBF", "E", "MUP", "EM"):
            assert steps()[5][name] == pytest.approx(value, rel=1e-11)


def test_the_numbers_are_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(example.ESTIMATES, "VAX", -12.0)
    changed = steps.__wrapped__()
    assert changed[1]["UX"] == pytest.approx(steps()[1]["UX"] - 2.0)
    assert not all(n.agrees for n in changed[1].numbers)
    assert solve_for is example.solve_for
