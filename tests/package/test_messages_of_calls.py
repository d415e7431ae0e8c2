"""Calls that cannot be answered give one line of what is expected."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import impact88
from impact88.comparison.words import as_junit

SCENE = impact88.sample(1).numbers()
PREPARED = impact88.prepared(["MU", "E"], "LOSS", SCENE)


class LazyFrame:
    """A frame whose columns are not computed yet."""

    columns = tuple(SCENE)

    def collect(self) -> dict[str, Any]:
        return SCENE


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: PREPARED(0.5), "a row for each of MU E"),
        (lambda: PREPARED(0.5, 0.1), "a row for each of MU E"),
        (lambda: PREPARED([0.5]), "a row for each of MU E"),
        (lambda: impact88.solve(LazyFrame(), "LOSS"), "LazyFrame has no columns"),
        (lambda: impact88.replay(LazyFrame()), "LazyFrame is not a mapping"),
        (lambda: impact88.verify(""), "'': expected a printout's text"),
        (
            lambda: impact88.solve_for({n: x for n, x in SCENE.items() if n not in "VX VY WB"}),
            "do not follow from what is known",
        ),
    ],
)
def test_a_call_that_cannot_be_answered_says_what_is_expected(call: Any, words: str) -> None:
    with pytest.raises(impact88.UserError, match=words) as error:
        call()
    assert "\n" not in str(error.value)


def test_a_call_that_can_is_answered() -> None:
    assert float(PREPARED([0.5, 0.1])["LOSS"]) == pytest.approx(46.2454, abs=1e-4)
    known = {n: x for n, x in SCENE.items() if n != "WB"} | impact88.solve(SCENE, ["WBF"])
    assert np.isfinite(impact88.solve_for(known, ["WB"])[0]["WB"])


def test_no_cause_is_only_noted_where_one_was_looked_for() -> None:
    row = {**impact88.sample(1), "VAX": "-14.7"}
    assert "no cause was found" in impact88.compare(row).notes
    comparison = impact88.compare(row, causes=False)
    assert comparison.notes == ()
    assert "tests='2' failures='1'" in as_junit(comparison, "table")
