"""The impact by `impact88.mechanics.solve`: both ways of computing, shapes, bad input, evaluate."""

import pickle

import numpy as np
import pytest

from impact88 import UserError, library
from impact88.mechanics.accuracy.populations import scenes
from impact88.mechanics.plan import COMPILED, plan
from impact88.mechanics.solve import UNUSED_BY_POINTS, evaluate, prepared, solve
from impact88.names import FINAL_VELOCITIES, RESULTS


def mixed_scenes(count=5000, seed=1):
    g = scenes("casework", count, seed)
    g["MU"][::7], g["M"][::11], g["UX"][::13] = -10, 4, np.nan
    g["MB"][::17] = g["IB"][::17] = np.inf
    g["VX"][::17] = g["VY"][::17] = g["WB"][::17] = 0.0
    return g


def one_scene(seed=2):
    return {name: float(x[0]) for name, x in scenes("casework", 1, seed).items()}


def assert_same_bits(first, second):
    assert list(first) == list(second)
    for name in first:
        np.testing.assert_array_equal(first[name], second[name], err_msg=name)


def test_numpy_has_the_bits_of_the_library():
    g = mixed_scenes()
    results = solve(g)
    with library.switched_off():
        assert_same_bits(solve(g), results)


@pytest.mark.parametrize("name", RESULTS)
def test_only_what_a_result_needs_is_computed(name):
    assert len(plan((name, "fit")).steps) < len(COMPILED)
    g = mixed_scenes(300)
    alone = solve({n: g[n] for n in plan((name, "fit")).inputs}, name)[name]
    np.testing.assert_array_equal(alone, solve(g)[name])


def test_a_scene_alone_has_the_bits_that_it_has_among_others():
    g = mixed_scenes(400)
    together = solve(g)
    for i in (0, 1, 7, 11, 13, 17, 399):
        alone = solve({name: x[i] for name, x in g.items()})
        assert_same_bits(alone, {name: x[i] for name, x in together.items()})


def test_known_velocities_and_impulses_give_the_remaining_results():
    g = one_scene()
    f = solve(g)
    known = {**g, **{n: f[n] for n in (*FINAL_VELOCITIES, "PN", "PT", "PM")}}
    values, missing = evaluate(known, list(RESULTS))
    assert missing == {}
    for name in RESULTS:
        assert values[name] == pytest.approx(f[name], rel=1e-13), name
    del known["IA"]
    values, missing = evaluate(known, ["VC", "KI"])
    assert missing == {"KI": ("IA",)}
    assert values["VC"] == f["VC"]


def test_point_masses_need_no_dimensions():
    g = {**one_scene(), "M": 4.0}
    few = {name: x for name, x in g.items() if name not in UNUSED_BY_POINTS}
    assert_same_bits(solve(few), solve(g))
    mixed = {**g, "M": np.array([4.0, 4.0, 6.0]), "WA": np.array([0.0, 1.0, 1.0])}
    column = {**mixed, "M": np.full(3, 4.0)}
    for name, array in solve(column).items():
        np.testing.assert_array_equal(array[:2], solve(mixed)[name][:2], err_msg=name)


def test_prepared_has_the_bits_of_solve():
    g = one_scene()
    function = prepared("MU E", ["LOSS", "VAX", "STATUS"], g)
    rows = np.array([np.linspace(-1, 1, 300), np.linspace(0, 1, 300)])
    results = function(rows)
    assert_same_bits(solve({**g, "MU": rows[0], "E": rows[1]}, function.results), results)
    assert_same_bits(pickle.loads(pickle.dumps(function))(rows), results)
    with library.switched_off():
        assert_same_bits(function(rows), results)
    with pytest.raises(UserError, match="expected 2 rows: MU E"):
        function([0.5])


def test_missing_columns_are_named():
    with pytest.raises(UserError, match=r"missing IA \(yaw moment of inertia of A\)"):
        solve({n: x for n, x in one_scene().items() if n != "IA"}, "VAX")
