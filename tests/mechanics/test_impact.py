"""`solve`, `prepared` and `evaluate`: both ways of computing, shapes, tables, bad input."""

import pickle
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from populations import scenes

import impact88
from impact88 import UserError, evaluate, library, prepared, sample, solve
from impact88.mechanics import kernel
from impact88.mechanics.plan import COMPILED, plan
from impact88.mechanics.solve import UNUSED_BY_POINTS
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
    state = {**g, **{n: f[n] for n in (*FINAL_VELOCITIES, "PN", "PT", "PM")}}
    values, missing = evaluate(state, list(RESULTS))
    assert missing == {}
    for name in RESULTS:
        assert values[name] == pytest.approx(f[name], rel=1e-13), name
    del state["IA"]
    values, missing = evaluate(state, ["VC", "KI"])
    assert missing == {"KI": ("IA",)}
    assert values["VC"] == f["VC"]


def test_point_masses_need_no_dimensions():
    g = {**one_scene(), "M": 4.0}
    subset = {name: x for name, x in g.items() if name not in UNUSED_BY_POINTS}
    assert_same_bits(solve(subset), solve(g))
    masses = {**g, "M": np.array([4.0, 4.0, 6.0]), "WA": np.array([0.0, 1.0, 1.0])}
    column = {**masses, "M": np.full(3, 4.0)}
    for name, array in solve(column).items():
        np.testing.assert_array_equal(array[:2], solve(masses)[name][:2], err_msg=name)


def test_prepared_has_the_bits_of_solve():
    g = one_scene()
    function = prepared("MU E", ["LOSS", "VAX", "STATUS"], g)
    rows = np.array([np.linspace(-1, 1, 300), np.linspace(0, 1, 300)])
    results = function(rows)
    assert_same_bits(solve({**g, "MU": rows[0], "E": rows[1]}, function.results), results)
    assert_same_bits(pickle.loads(pickle.dumps(function))(rows), results)
    with library.switched_off():
        assert_same_bits(function(rows), results)
    with pytest.raises(UserError, match="a row for each of MU E"):
        function([0.5])


def test_prepared_takes_numbers_and_arrays():
    loss = prepared("MU,E", "LOSS", sample(1))
    alone_value = solve({**sample(1).numbers(), "MU": 0.5, "E": 0.2}, "LOSS")["LOSS"]
    assert loss([0.5, 0.2])["LOSS"] == alone_value
    assert prepared("E MU", "LOSS", {**sample(1), "MU": "?"})([0.2, 0.5])["LOSS"] == alone_value
    assert isinstance(loss([0.5, 0.2])["LOSS"], float)
    assert np.all(loss(np.full((2, 2, 3), [[[0.5]], [[0.2]]]))["LOSS"] == alone_value)
    with pytest.raises(UserError, match="one array with a row for each of MU E"):
        loss([0.5, np.full(3, 0.2)])
    with ThreadPoolExecutor(4) as pool:
        rows = [np.random.default_rng(k).random((2, 500)) for k in range(8)]
        for row, results in zip(rows, pool.map(loss, rows), strict=True):
            assert_same_bits(loss(row), results)


@pytest.mark.parametrize(
    ("names", "results", "scene", "message"),
    [
        ("MU MX", "LOSS", {}, "'MX' is not a scene name"),
        ("MU MU", "LOSS", {}, "appears twice"),
        ("", "LOSS", {}, "no scene name"),
        ("MU", "LOSSS", {}, "'LOSSS' is not a result; did you mean LOSS"),
        ("MU", "LOSS", {"MA": 90.0}, "missing E"),
        ("MU", "MUP", {**sample(1), "UX": [1, 2]}, "UX: .* expected one that stays"),
    ],
)
def test_prepared_refuses(names, results, scene, message):
    with pytest.raises(UserError, match=message):
        prepared(names, results, scene)


def test_shapes_broadcast_and_results_go_into_out():
    g = one_scene()
    grid = {**g, "MU": np.linspace(-1, 1, 300).reshape(300, 1), "E": np.array([0.1, g["E"]])}
    results = solve(grid)
    assert results["VAX"].shape == (300, 2)
    alone = solve({**g, "MU": float(grid["MU"][7, 0])})
    assert_same_bits({n: x[7, 1] for n, x in results.items()}, alone)
    out = {"LOSS": np.empty((300, 2)), "STATUS": np.empty((300, 2), np.uint16)}
    assert solve(grid, out=out)["LOSS"] is out["LOSS"]
    assert_same_bits(out, {name: results[name] for name in out})
    assert solve({**g, "MU": np.empty(0)})["VAX"].shape == (0,)


def test_pivots_after_the_first_scenes():
    """Alone in a sweep of MU, whose other columns are numbers."""
    g = one_scene()
    mu = np.linspace(0, 1, 600)
    mu[[300, 599]] = -10
    for names in ("VAX", "WAF", "PN PT PM", "STATUS VAX"):
        results = solve({**g, "MU": mu}, names)
        alone = solve({**g, "MU": -10.0}, names)
        for i in (300, 599):
            assert_same_bits({n: x[i] for n, x in results.items()}, alone)
        assert_same_bits(prepared("MU", names, g)([mu]), results)
        with library.switched_off():
            assert_same_bits(solve({**g, "MU": mu}, names), results)


def test_out_wherever_its_arrays_lie_in_memory():
    """Side by side in one block, STATUS of 2 bytes a scene; and overlapping by a byte."""
    n = 300
    block = np.zeros(18 * n, np.uint8)
    g = {**one_scene(), "MU": np.linspace(0, 1, n)}
    reference = solve(g)
    for status, speed, loss in ((0, 2, 10), (8, 0, 10), (16, 0, 8)):
        out = {"STATUS": block[status * n : (status + 2) * n].view(np.uint16)}
        for name, at in (("VAX", speed), ("LOSS", loss)):
            out[name] = block[at * n : (at + 8) * n].view(np.float64)
        assert_same_bits(solve(g, out=out), {name: reference[name] for name in out})
        with pytest.raises(UserError, match="shares memory"):
            solve({**g, "MU": out["VAX"]}, out=out)
    out = {"VAX": block[: 8 * n].view(np.float64), "LOSS": block[8 : 8 + 8 * n].view(np.float64)}
    with pytest.raises(UserError, match="shares memory"):
        solve(g, out=out)


def test_columns_that_are_not_aligned_or_read_only():
    g = mixed_scenes(300)
    reference = solve(g, "VAX STATUS")
    copies = {
        name: np.frombuffer(b"." + x.tobytes(), np.float64, offset=1) for name, x in g.items()
    }
    assert_same_bits(solve(copies, "VAX STATUS"), reference)
    rows = np.frombuffer(b"." + g["E"].tobytes(), np.float64, offset=1).reshape(1, -1)
    scene = one_scene()
    together = solve({**scene, "E": g["E"]}, "VAX")
    assert_same_bits(prepared("E", "VAX", scene)(rows), together)


def test_threads_and_layouts_change_no_bit():
    g = mixed_scenes(50_000)
    reversed_g = {name: x[::-1] for name, x in g.items()}
    results = solve(g, "VAX STATUS COND", threads=1)
    for threads in (2, 3):
        assert_same_bits(solve(g, "VAX STATUS COND", threads=threads), results)
        backward = solve(reversed_g, "VAX STATUS COND", threads=threads)
        assert_same_bits({n: x[::-1] for n, x in backward.items()}, results)


FRAMES = ["pandas", "polars", "pyarrow"]


@pytest.mark.parametrize("kind", FRAMES)
def test_frames_give_arrays(kind):
    library_of = pytest.importorskip(kind)
    g = mixed_scenes(60)
    columns = {**g, "note": ["a"] * 60, "E": g["E"].astype(np.float32)}
    make = library_of.table if kind == "pyarrow" else library_of.DataFrame
    assert_same_bits(solve(make(columns), ["VAX", "LOSS"]), solve(columns, ["VAX", "LOSS"]))
    holes = make({**columns, "UX": [None, *g["UX"][1:].tolist()]})
    results = solve(holes, ["VAX", "STATUS"])
    assert np.isnan(results["VAX"][0])
    assert results["STATUS"][0] == 64
    moving = dict(
        zip("MA MB IA IB UX UY VX VY WA WB".split(), [2, 1, 1, 1, 3, 4, 0, 2, 0, 0], strict=True)
    )
    assert solve(make({name: [x] for name, x in moving.items()}), "KI")["KI"] == 27.0


def test_values_of_other_types():
    g = one_scene()
    reference = solve(g, "VAX LOSS")
    texts = {name: repr(x) for name, x in g.items()}
    assert_same_bits(solve(texts, "VAX LOSS"), reference)
    row = solve({**g, "MU": [repr(g["MU"]), g["MU"], None]}, "VAX")["VAX"]
    assert row[0] == row[1] == reference["VAX"]
    assert np.isnan(row[2])
    array = np.ma.masked_array([g["MU"], g["MU"]], [False, True])
    assert np.isnan(solve({**g, "MU": array}, "VAX")["VAX"]).tolist() == [False, True]
    assert solve({**g, "M": 6, "MA": np.float32(90)}, "VAX") == solve({**g, "MA": 90}, "VAX")


@pytest.mark.parametrize(
    ("columns", "arguments", "message"),
    [
        ({"MU": "much"}, {}, "MU = 'much' at position 0 is no number"),
        ({"MU": [1.0, "x"]}, {}, "MU = 'x' at position 1 is no number"),
        ({"MU": 1j}, {}, "at position 0 is no number"),
        ({"MU": [[1.0], [1.0, 2.0]]}, {}, "expected a number or an array"),
        ({"MU": np.ones(3), "E": np.ones(4)}, {}, r"do not broadcast together: E \(4,\), MU"),
        ({}, {"results": "VX"}, "'VX' is not a result"),
        ({}, {"results": ""}, "no result is asked for"),
        ({}, {"threads": "x"}, "threads is 'x'; expected a whole number above 0"),
        ({}, {"threads": 0}, "threads is 0; expected a whole number above 0"),
        (
            {"MU": np.ones(3)},
            {"out": {"VAX": np.ones(2)}},
            "out, VAX: expected a contiguous array of float64",
        ),
        ({"MU": np.ones(3)}, {"out": {"VAX": np.ones(6)[::2]}}, "expected a contiguous array"),
        (
            {},
            {"results": "VAX KI", "out": {"KI": np.ones(())}},
            "out, VAX: expected a contiguous array of float64",
        ),
    ],
)
def test_input_that_cannot_be_used(columns, arguments, message):
    with pytest.raises(UserError, match=message):
        solve({**one_scene(), **columns}, **arguments)


def test_other_input_that_cannot_be_used():
    mu = np.ones(3)
    with pytest.raises(UserError, match="shares memory"):
        solve({**one_scene(), "MU": mu}, out={"VAX": mu})
    for frame in ("crash.toml", 5, [1.0, 2.0]):
        with pytest.raises(UserError, match="expected a mapping or a data frame"):
            solve(frame)
    with pytest.raises(UserError, match="'VAZ' is not a quantity of an impact"):
        evaluate(one_scene(), "VAZ")


def test_missing_columns_are_named():
    subset = {n: x for n, x in one_scene().items() if n != "IA"}
    with pytest.raises(UserError, match=r"missing IA \(yaw moment of inertia of A\)"):
        solve(subset, "VAX")
    assert solve(subset, "VC")["VC"] == solve(one_scene(), "VC")["VC"]


def test_evaluate_at_small_and_large_sizes_by_both_ways():
    g = mixed_scenes(5000)
    names = ["VAX", "gn", "SA", "PDOFA", "LOSS", "STATUS"]
    together = evaluate(g, names)[0]
    subset = evaluate({name: x[:100] for name, x in g.items()}, names)[0]
    with library.switched_off():
        slow = evaluate(g, names)[0]
    for name in names:
        np.testing.assert_array_equal(together[name][:100], subset[name])
        np.testing.assert_array_equal(together[name], slow[name])
    assert evaluate(one_scene(), "UX VAX")[0]["UX"] == one_scene()["UX"]
    # the spin of the pivot, of scenes that are none
    pivot = solve({**one_scene(), "MU": -10.0}, "WAF")["WAF"]
    parts, _ = evaluate(one_scene(), "wa_p D_p")
    assert parts["wa_p"] / parts["D_p"] == pivot
    # of a quantity that a formula gives among others the known value counts
    values, _ = evaluate({**one_scene(), "VAX": 5.0}, ["XAF", "VAY"])
    assert values["XAF"] != solve(one_scene(), "XAF")["XAF"]
    assert values["VAY"] == solve(one_scene(), "VAY")["VAY"]


def test_the_library_stays_off_until_the_last_block_ends():
    """Blocks of two threads end in any order."""
    first, second = library.switched_off(), library.switched_off()
    first.__enter__()
    second.__enter__()
    first.__exit__(None, None, None)
    assert library.is_switched_off()
    second.__exit__(None, None, None)
    assert not library.is_switched_off()


def test_a_library_of_other_formulas_is_not_used(monkeypatch):
    monkeypatch.setattr(kernel, "digest", lambda: "0123456789abcdef")
    assert kernel._load() is None


@pytest.mark.parametrize("switch", ["0", "1"])
def test_the_switch_of_the_environment(switch):
    code = (
        "import impact88; print(impact88.accelerated, impact88.solve(impact88.sample(1), 'LOSS'))"
    )
    environment = {"IMPACT88_ACCELERATED": switch, "PATH": ""}
    run = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True
    )
    reference = None if switch == "0" else impact88.accelerated
    assert run.stdout.startswith(f"{reference} "), run.stderr


def test_the_direction_of_the_force_on_a_point_mass_is_measured_from_its_heading():
    scene = {"M": 4, "MA": 1, "MB": 1, "UX": 1, "UY": 0, "VX": 0, "VY": 0, "GA": 0, "E": 0}
    scene |= {"MU": 0, "WA": 0, "WB": 0, "TB": 90}
    values, missing = evaluate(scene, ["PDOFA", "PDOFB"])
    assert not missing
    assert np.isnan(values["PDOFA"])  # TA is not given
    assert values["PDOFB"] == -90  # pushed along +x, B faces +y: from its left
