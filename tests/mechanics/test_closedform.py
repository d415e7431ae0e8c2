"""Expressions and plans: leaving out changes nothing, and no value is overwritten too early."""

from __future__ import annotations

import math
import operator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from passes import passes

from impact88.mechanics.closedform.plan import Plan
from impact88.mechanics.native.expressiontable import ExpressionTable
from impact88.mechanics.native.schedule import Schedule

LENGTH = 7
PLAIN = {"+": operator.add, "-": operator.sub, "*": operator.mul}
COLUMNS = {
    "a": np.linspace(-2, 3, LENGTH),
    "b": np.linspace(0.5, 4, LENGTH),
    "fixed": np.array([1.75]),
}


def planned(results):
    return Schedule(results, ["RESULT"] * len(results))


def run(plan):
    results = {name: np.empty(LENGTH) for name in plan.results}
    varying = [COLUMNS[name] for name in plan.columns]
    with np.errstate(all="ignore"):
        Plan(plan).run(varying, results, {"fixed": 1.75}, 4)
    return results


@given(st.data())
def test_any_formulas_give_what_numpy_gives(data):
    """Random formulas over columns and constants, several results sharing parts."""
    table = ExpressionTable()
    pool = [
        (table.column("a", True), COLUMNS["a"]),
        (table.column("b", True), COLUMNS["b"]),
        (table.column("fixed", False), COLUMNS["fixed"]),
        *((table.constant(c), np.array([c])) for c in (0.0, 1.0, -1.0, 2.5)),
    ]
    pick = st.integers(0, 10**6)
    for _ in range(data.draw(st.integers(1, 25))):
        (x, vx), (y, vy) = (pool[data.draw(pick) % len(pool)] for _ in range(2))
        kind = data.draw(st.sampled_from("+-*/nchsg"))
        with np.errstate(all="ignore"):
            if kind in PLAIN:
                pool.append((PLAIN[kind](x, y), PLAIN[kind](vx, vy)))
            elif kind == "/":
                if not np.all(vy):  # 0 / 0 and infinities are not what is tested here
                    continue
                pool.append((x / y, vx / vy))
            elif kind == "n":
                pool.append((-x, -vx))
            elif kind == "c":
                s, c = table.sine_and_cosine(x)
                pool.append((c, np.cos(np.radians(vx))))
                pool.append((s, np.sin(np.radians(vx))))
            elif kind == "h":
                pool.append((table.root(x * x), np.sqrt(vx * vx)))
            elif kind == "s":
                pool.append((table.against(x, y), np.where(vy > 0, -vx, vx)))
            else:
                condition = table.equals(x, 1.75)
                pool.append((table.choose(condition, x, y), np.where(vx == 1.75, vx, vy)))
        if not np.all(np.abs(pool[-1][1]) < 1e6):
            pool.pop()
    wanted = [pool[data.draw(pick) % len(pool)] for _ in range(data.draw(st.integers(1, 4)))]
    found = run(planned({f"r{i}": e for i, (e, _) in enumerate(wanted)}))
    for i, (_, value) in enumerate(wanted):
        np.testing.assert_allclose(
            found[f"r{i}"], np.broadcast_to(value, LENGTH), rtol=1e-7, atol=1e-7
        )


def test_what_disappears():
    table = ExpressionTable()
    a, b = table.column("a", True), table.column("b", True)
    zero, one, endless = table.constant(0.0), table.constant(1.0), table.constant(math.inf)
    assert a + zero is a
    assert zero + a is a
    assert a - zero is a
    assert a * one is a
    assert a / one is a
    assert (a * zero).is_zero
    assert (zero - a) is -a
    assert table.negative(-a) is a
    assert a + -b is a - b
    assert a - -b is a + b
    assert (-a) * (-b) is a * b
    assert (one / endless).is_zero
    assert a * b is a * b
    assert not (zero / a).is_zero  # a may be 0
    assert table.sine_and_cosine(zero)[1].is_constant(1.0)
    assert table.sine_and_cosine(-a)[1] is table.sine_and_cosine(a)[1]


def test_only_what_is_wanted_is_planned():
    table = ExpressionTable()
    a, b = table.column("a", True), table.column("b", True)
    shared = a * b
    costly = table.root(shared)
    plan = planned({"x": shared + a})
    assert passes(plan) == 2
    assert passes(planned({"x": costly, "y": costly + 1.0})) == 3
    assert planned({"x": a * 2.0}).columns == ["a"]
    constant = planned({"x": table.column("fixed", False) * 2.0})
    assert passes(constant) == 0
    assert run(constant)["x"].tolist() == [3.5] * LENGTH


@pytest.mark.parametrize("zero", [0.0, -0.0])
def test_sign_rule_keeps_the_sign_on_either_zero(zero):
    table = ExpressionTable()
    plan = planned({"x": table.against(table.column("a", True), table.column("b", True))})
    found = {"x": np.empty(3)}
    columns = [np.array([1.5, -1.5, 2.0]), np.array([zero, zero, 5e-324])]
    Plan(plan).run(columns, found, {}, 3)
    assert found["x"].tolist() == [1.5, -1.5, -2.0]
