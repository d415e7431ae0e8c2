"""The compiled library and numpy give the same bits: every result, population, path and slice.

Where the library was not built these tests are skipped; the rest of the suite then runs on numpy
alone, and where it was, `test_solve` and the tests beside it run both ways.
"""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest
from longer import long_but

import impact88
from impact88.mechanics import native
from impact88.mechanics.accuracy.populations import POPULATIONS, repeat_scenes, scenes, texts
from impact88.mechanics.closedform import solve as solving
from impact88.mechanics.closedform.columns import BLOCK
from impact88.mechanics.closedform.compiledcalls import TILE
from impact88.mechanics.closedform.general import quantities
from impact88.names import RESULTS

pytestmark = pytest.mark.skipif(native.library is None, reason="built without a C compiler")

SIX = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF")


def both(columns, outputs=None, **given):
    compiled = impact88.solve(columns, outputs, **given)
    with native.switched_off():
        alone = impact88.solve(columns, outputs, **given)
    return compiled, alone


def assert_same_bits(compiled, alone):
    assert list(compiled) == list(alone)
    for name, values in alone.items():
        mine = np.asarray(compiled[name])
        assert (mine.dtype, mine.shape) == (values.dtype, values.shape), name
        assert mine.tobytes() == values.tobytes(), name


@pytest.mark.parametrize("name", POPULATIONS)
@pytest.mark.parametrize("count", [1, 2, TILE, TILE + 1])
def test_every_result_of_every_population(name, count):
    assert_same_bits(*both(repeat_scenes(scenes(name, min(count, 500), 11), count), threads=1))


def odd(count: int, seed: int) -> dict[str, np.ndarray]:
    """Casework in which scenes are now and then of another kind, or cannot be used."""
    rng = np.random.default_rng(seed)
    columns = repeat_scenes(scenes("casework", min(count, 5000), seed), count)
    columns["M"] = np.full(count, 6.0)

    def some(share: float) -> np.ndarray:
        return rng.random(count) < share

    columns["MU"][some(0.1)] = -10
    columns["MU"][some(0.01)] = -11
    columns["M"][some(0.1)] = 4
    columns["M"][some(0.001)] = 5
    columns["GA"][some(0.01)] += 3600
    columns["TA"][some(0.001)] = np.inf
    columns["IB"][some(0.01)] = np.inf
    columns["MA"][some(0.001)] = -1
    columns["UX"][some(0.001)] = np.nan
    columns["EM"][some(0.01)] = 0.5
    for name in ("UX", "UY", "WA", "VX", "VY", "WB"):
        columns[name][some(0.01)] = 0
    columns["UX"][some(0.001)] *= 1e200
    return columns


@pytest.mark.parametrize("count", [60, 127, 5000, 70_000])
def test_scenes_of_all_kinds_among_each_other(count):
    assert_same_bits(*both(odd(count, count)))


def test_kinds_that_change_far_behind_what_was_looked_at():
    """The library goes on over all scenes of one kind, and must notice where another begins."""
    count = 2 * BLOCK + 5000
    for name, value in {"MU": -10.0, "GA": 1e6, "IA": np.inf, "UX": np.nan, "M": 4.0}.items():
        columns = repeat_scenes(scenes("casework", 5000, 5), count)
        columns["M"] = np.full(count, 6.0)
        columns["EM"] = np.full(count, -0.5)
        columns[name][-5003] = value
        columns["EM"][-7] = -0.25  # a column of one value but for a single scene
        assert_same_bits(*both(columns, threads=1))


def test_a_column_of_one_value_that_another_follows_far_behind():
    columns = {name: values.copy() for name, values in scenes("casework", 3 * TILE, 6).items()}
    columns["EM"][:] = -0.5
    columns["EM"][-7] = -0.25
    assert_same_bits(*both(columns, threads=1))


def test_what_varies_may_go_beyond_what_was_looked_at(monkeypatch):
    """Numbers that are only larger than those looked at make no other kind."""
    columns = scenes("casework", 3 * TILE, 6)
    columns["UX"][-7] = 10 * columns["UX"].max()
    with native.switched_off():
        expected = impact88.solve(columns, SIX)
    monkeypatch.setattr(solving, "solve_arrays", None)  # the general path
    assert_same_bits(impact88.solve(columns, SIX), expected)


def test_slices_types_and_shapes():
    columns = odd(6000, 3)
    thirds = {name: values[::3] for name, values in columns.items()}
    assert_same_bits(*both(thirds))
    grid = {name: values.reshape(60, 100) for name, values in columns.items()}
    assert_same_bits(*both({**grid, "MU": np.linspace(-1, 1, 100)}))
    columns["UX"][np.abs(columns["UX"]) > 1e30] = 0
    single = {name: values.astype(np.float32) for name, values in columns.items()}
    assert_same_bits(*both(single))
    scalar = {name: float(values[0]) for name, values in columns.items()} | {"M": 6}
    for name in ("MU", "GA", "IA", "E"):
        assert_same_bits(*both({**scalar, name: columns[name][:50]}))
    for cell in ("85 %", "0.5", 1):
        assert_same_bits(*both({**scalar, "MU": np.full(2 * TILE, cell, object)}))
    empty = {**scalar, "MU": np.empty(0)}
    assert_same_bits(*both(empty))


def test_selections():
    columns = odd(3 * TILE, 9)
    for name in RESULTS:
        assert_same_bits(*both(columns, name))
    few = {name: values[:100] for name, values in scenes("casework", 100, 4).items()}
    for names in (SIX, ("STATUS",), ("DVA", "STATUS", "MUC")):
        assert_same_bits(*both(few, names))


def test_threads_and_room_of_the_callers():
    columns = odd(280_000, 2)
    room = {name: np.empty(280_000) for name in SIX}
    alone = both(columns, SIX, threads=2)[1]
    assert_same_bits(impact88.solve(columns, out=room, threads=2), alone)


def test_quantities_that_are_no_results():
    columns = odd(500, 8)
    names = ("gt", "determinant", "critical_denominator")
    compiled = quantities(columns, names, sign=-1.0)
    with native.switched_off():
        assert_same_bits(compiled, quantities(columns, names, sign=-1.0))


REPLAYED = (
    "casework",
    "heavy",
    "singular",
    "units",
    "tangential",
    "cancelling",
    "em-half",
    "pivots",
)
SCENES = int(os.environ.get("IMPACT88_REPLAY_SCENES", "0")) or 200


@pytest.mark.parametrize("name", long_but(REPLAYED, kept=(1, 2, 3)))
def test_replay_of_every_population(name):
    """Every stored real, code and line; scenes out of the ordinary go the way of the arrays."""
    columns = texts(scenes(name, SCENES, 17))
    few = {key: values[:8] for key, values in texts(scenes("extreme", 8, 1)).items()}
    columns = {key: [*values, *few[key]] for key, values in columns.items()}
    columns["M"] = ["4" if i % 50 == 0 else "6" for i in range(SCENES + 8)]
    columns["MU"][::40] = ["-10"] * len(columns["MU"][::40])
    columns["IA"][7] = "0"
    compare_replays(columns)


@pytest.mark.parametrize("shared", ["MU", "UX", "IA"])
def test_replay_of_scenes_that_share_all_but_one(shared):
    columns = texts(scenes("casework", 2500, 6))
    one = {key: values[0] for key, values in columns.items()}
    compare_replays({**one, shared: columns[shared]})


def compare_replays(columns):
    compiled = impact88.replay(columns)
    with native.switched_off():
        alone = impact88.replay(columns)
    assert np.array_equal(compiled.code, alone.code)
    assert np.array_equal(compiled.line, alone.line)
    for name in alone.names:
        assert np.array_equal(compiled.reals(name), alone.reals(name)), name


OTHER_FORMULAS = """
import ctypes
class Library(ctypes.CDLL):
    class formulas:
        def __new__(cls):
            return b"0"
ctypes.CDLL = Library
"""


@pytest.mark.parametrize("reason", ["the variable", "an older library", "other formulas"])
def test_it_is_used_by_all_or_by_none(reason, monkeypatch):
    """By `solve`, `replay` and the texts; and reports say what is used."""
    code = "import impact88\nfrom impact88.casework.report.frame import versions\n"
    code += "print(impact88.accelerated, versions()['solve'])"
    if reason == "the variable":
        monkeypatch.setenv(native.VARIABLE, "0")
    elif reason == "other formulas":
        code = OTHER_FORMULAS + code
    else:  # a result that it was not built with
        code = f"import impact88.names as n\nn.RESULTS['XF'] = n.RESULTS['XA']\n{code}"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "None numpy\n"
    assert impact88.accelerated


@pytest.mark.parametrize("pivots", long_but([0.0, 0.1, 0.5, 1.0], kept=(1,)))
@pytest.mark.parametrize("unusable", [False, True])
def test_constants_selections_pivots_and_an_unusable_scene(pivots, unusable):
    """Each column as one number for all, and each result by itself: the bits of numpy."""
    rng = np.random.default_rng(38)
    count = 300
    columns = scenes("casework", count, 38) | {"M": np.full(count, 6.0)}
    columns["MU"] = np.where(rng.random(count) < pivots, -10.0, columns["MU"])
    with native.switched_off():
        expected = {}
        for name in columns:
            for value in {float(columns[name][0]), 0.0 if name[0] not in "MI" else 6.0}:
                given = {**columns, name: value}
                if unusable:
                    other = "UX" if name != "UX" else "UY"
                    given[other] = columns[other].copy()
                    given[other][200] = np.nan
                expected[name, value] = given, impact88.solve(given)
    for given, whole in expected.values():
        assert_same_bits(impact88.solve(given), whole)
        for chosen in (*((name,) for name in RESULTS), SIX, ("DVA", "LOSS", "STATUS")):
            found = impact88.solve(given, chosen)
            assert_same_bits(found, {name: whole[name] for name in chosen})


@pytest.mark.parametrize("change", [{"MB": np.inf, "IB": np.inf}, {"IB": np.inf}, {"MB": np.inf}])
@pytest.mark.parametrize("mu", [0.3, -10.0])
@pytest.mark.parametrize("constant", [False, True])
def test_barriers_as_constants_and_as_columns(change, mu, constant):
    columns = scenes("casework", 300, 4) | dict.fromkeys(("VX", "VY", "WB"), 0.0) | {"MU": mu}
    columns |= {k: v if constant else np.full(300, v) for k, v in change.items()}
    columns["TA"] = columns["TA"] + 7200.0
    assert_same_bits(*both(columns))
    assert_same_bits(*both({**columns, "VX": 1e-300, "WB": 1.0}))


@pytest.mark.parametrize("mu", [0.3, -10.0])
@pytest.mark.parametrize("arms", [0.0, -0.0])
def test_sines_that_no_arm_needs_are_left_out_and_change_nothing(mu, arms):
    columns = scenes("casework", 300, 4) | {"DA": arms, "DB": 0.0, "MU": mu}
    columns["TA"] = np.where(np.arange(300) % 50, columns["TA"], 1e300)
    compiled, alone = both(columns)
    assert_same_bits(compiled, alone)
    spread = {**columns, "DA": np.full(300, arms)}
    assert_same_bits(impact88.solve(spread), compiled)
