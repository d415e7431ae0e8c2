"""Conditions under which a mistake holds: found in half of the rows, and confirmed in the rest."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from impact88.conformance.comparison.predicates import (
    ABOVE,
    BELOW,
    IS,
    Predicate,
    find_predicate,
    scene_quantities,
)
from impact88.conformance.comparison.trials import Program
from impact88.conformance.comparison.vectors import scenes
from impact88.equations.edits import readings
from impact88.names import SCENE

ROWS = [scene for kind, _, scene in scenes(600, seed=17) if kind != "failure"]
NUMBERS = {name: np.array([float(row[name]) for row in ROWS]) for name in SCENE}
QUANTITIES = scene_quantities(NUMBERS)


@pytest.mark.parametrize("name", ["the closing speed", "the sliding speed", "E", "MA", "WB"])
@pytest.mark.parametrize("relation", [ABOVE, BELOW])
@given(share=st.floats(0.1, 0.9))
def test_a_threshold_is_found_in_the_gap_that_the_rows_leave(
    name: str, relation: str, share: float
) -> None:
    column = QUANTITIES[name]
    value = float(np.quantile(column, share))
    inside = Predicate(name, relation, value).rows(QUANTITIES)
    if min(inside.sum(), (~inside).sum()) < 20:
        return
    found = find_predicate(QUANTITIES, inside, ~inside)
    assert found is not None
    assert (found.rows(QUANTITIES) == inside).mean() > 0.97


def test_a_mistake_with_a_condition_is_made_where_it_holds_alone() -> None:
    mistake = next(edit for edit in readings() if "Γ left out" in edit.sentence)
    where = Predicate("WA", ABOVE, 0.0)
    mixed, wrong, right = (
        program.results(NUMBERS)["VAX"]
        for program in (Program((mistake,), where), Program((mistake,)), Program())
    )
    holds = where.rows(QUANTITIES)
    assert np.array_equal(mixed[holds], wrong[holds], equal_nan=True)
    assert np.array_equal(mixed[~holds], right[~holds], equal_nan=True)
    assert (wrong[holds] != right[holds]).any()
    assert (wrong[~holds] != right[~holds]).any()


def test_values_that_mean_something_of_their_own_are_said_so() -> None:
    for name, value, says in (
        ("MU", -10.0, "in pivots (MU = -10)"),
        ("M", 4.0, "for point masses (M = 4)"),
        ("WA", 0.0, "where WA is 0"),
    ):
        inside = NUMBERS[name] == value
        found = find_predicate(QUANTITIES, inside, ~inside)
        assert found == Predicate(name, IS, value)
        assert found.text == says


def test_rows_without_a_rule_are_given_none() -> None:
    """Chance alone: a coin for each row, for many and for few."""
    rng = np.random.default_rng(3)
    for count in (2, 4, 10, 100):
        for _ in range(20):
            inside = np.zeros(len(ROWS), bool)
            inside[rng.choice(len(ROWS), count, replace=False)] = True
            found = find_predicate(QUANTITIES, inside, ~inside)
            assert found is None, (count, found)


def test_what_holds_in_half_of_the_rows_alone_is_no_rule() -> None:
    """A threshold in every other row; in the rest, as many rows at random."""
    column = QUANTITIES["the closing speed"]
    inside = column > np.median(column)
    order = np.argsort(column)
    shuffled = inside.copy()
    held = np.flatnonzero(inside)[1::2]
    shuffled[held] = False
    shuffled[np.setdiff1d(np.arange(inside.size), np.flatnonzero(inside))[: held.size]] = True
    assert order.size == inside.size
    found = find_predicate(QUANTITIES, shuffled, ~shuffled)
    assert found is None or (found.rows(QUANTITIES) == shuffled).mean() > 0.97
