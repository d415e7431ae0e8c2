"""Many scenes at once: the captured runs and calls of the real ROM, errors, columns refused."""

from __future__ import annotations

import random

import captures
import numpy as np
import pytest
import romcalls
from emulation import load_machine

from impact88 import library
from impact88.apple.captured import memory_contents, result
from impact88.errors import UserError
from impact88.names import SCENE
from impact88.program import kernel
from impact88.program.batches import BLOCK
from impact88.program.kernel import Program, row_type
from impact88.program.replay import COMPUTED, PRINTED, replay
from impact88.program.run import run
from impact88.program.scene import sample

CASES = captures.scenes()
COLUMNS = {name: [case["scene"][name] for case in CASES] for name in SCENE}
ELEMENTS = 56
CALLS_STEP = 25  # of the captured calls, one in so many

needs_library = pytest.mark.skipif(kernel.compiled_library() is None, reason="no compiled library")


def without_disk_commands(page: str) -> str:
    """Return a captured page, of an Apple without a disk system, as one with it shows it."""
    return page.replace("\x04PR# 0\n", "").replace("\x04PR#0\n", "")


@pytest.fixture(params=["library", "port"])
def step(request, monkeypatch):
    """The step through the captures by each way; the port is three hundred times slower."""
    if request.param == "port":
        monkeypatch.setattr(kernel, "compiled_library", lambda: None)
        return 12
    if kernel.compiled_library() is None:
        pytest.skip("no compiled library")
    return 1


@pytest.mark.captures
def test_pages_of_captured_runs(step):
    columns = {name: column[::step] for name, column in COLUMNS.items()}
    pages = replay(columns, pages=True).pages
    assert pages == [without_disk_commands(case["printout"]) for case in CASES[::step]]


@needs_library
@pytest.mark.captures
@pytest.mark.parametrize("printed", [True, False], ids=["printed C", "walked steps"])
def test_memory_after_captured_runs(printed):
    """The listing as it is printed into the library, and its steps, walked."""
    steps = kernel.listing().steps
    rows = np.zeros(len(CASES), row_type(len(steps.variables), ELEMENTS, len(PRINTED)))
    Program(steps, in_library=printed).run(list(COLUMNS.values()), rows)
    for row, case in enumerate(CASES):
        reals = {
            name: f"{real:010x}"
            for (k, name), real in zip(enumerate(steps.variables), rows["reals"][row], strict=True)
            if int(rows["assigned"][row]) >> k & 1
        }
        data = [f"{element:010x}" for element in rows["array"][row]]
        array = {"dims": [7, 8], "data": data} if rows["rows"][row] else None
        assert memory_contents(reals, array) == memory_contents(case["reals"], case["A"])


@needs_library
@pytest.mark.captures
@pytest.mark.parametrize("path", captures.arithmetic_files(), ids=captures.vector_file_id)
def test_captured_calls_of_the_rom(path):
    calls = list(captures.vectors(path))[:: CALLS_STEP if path.parent.name == "arithmetic" else 1]
    for operation, first, second, extension, answer in calls:
        outcome = romcalls.call(operation, first, second, extension)
        assert outcome is None or outcome == result(answer), (first, second)


SPECIAL = ["0", "-0", ".", "1E38", "-1E38", "1E-38", "1E19", "-10", "10", "90", "1E9", "- 1 2.5"]


def extreme_scene(rng: random.Random) -> dict[str, str]:
    """Return a scene with some values special, of any size, or changed."""
    scene = {**sample(1), "M": rng.choice(["6", "6", "4", "5", "0", "7", "-1"])}
    for name in SCENE.keys() - {"M"}:
        kind = rng.random()
        if kind < 0.1:
            scene[name] = rng.choice(SPECIAL)
        elif kind < 0.2:
            scene[name] = f"{rng.choice('-+')}{10 ** rng.uniform(-12, 12):.{rng.randint(0, 9)}E}"
        elif kind < 0.6:
            scene[name] = f"{float(scene[name]) * rng.uniform(0.9, 1.1):.{rng.randint(0, 9)}f}"
    return scene


@needs_library
def test_extreme_scenes_against_the_port():
    rng = random.Random(65)
    scenes = [extreme_scene(rng) for _ in range(120)]
    results = replay({name: [scene[name] for scene in scenes] for name in SCENE}, pages=True)
    runs = list(map(run, scenes))
    assert results.pages == [record.printout for record in runs]
    assert results.error.tolist() == [record.error or "" for record in runs]
    assert results.zero_determinant.tolist() == [record.zero_determinant for record in runs]
    assert len(set(results.line.tolist())) > 6


def test_results_with_and_without_the_library(monkeypatch):
    rng = random.Random(66)
    scenes = [*CASES[:20], *({"scene": extreme_scene(rng)} for _ in range(30))]
    columns = {name: [scene["scene"][name] for scene in scenes] for name in SCENE}
    by_library = replay(columns)
    monkeypatch.setattr(kernel, "compiled_library", lambda: None)
    by_port = replay(columns)
    for name in COMPUTED:
        np.testing.assert_array_equal(by_library.floats(name), by_port.floats(name))
        if name != "LOSS":
            np.testing.assert_array_equal(by_library.reals(name), by_port.reals(name))
    np.testing.assert_array_equal(by_library.fields, by_port.fields)
    np.testing.assert_array_equal(by_library.error, by_port.error)


@pytest.mark.parametrize(
    ("changes", "error", "last", "following"),
    [
        ({"IA": "0"}, "?DIVISION BY ZERO ERROR IN 480", "MUP", "VAX"),
        ({"UX": "1E39"}, "?OVERFLOW ERROR IN 210", None, "KI"),
        ({"M": "1E39"}, "?OVERFLOW ERROR IN 350", "YB", "MUP"),
        ({"UX": "1E30"}, "?OVERFLOW ERROR IN 320", None, "KI"),
        ({"M": "7"}, "?BAD SUBSCRIPT ERROR IN 500", "MUP", "VAX"),
    ],
)
def test_a_scene_with_an_error_keeps_what_was_computed_before(changes, error, last, following):
    scene = sample(1).replaced(changes)
    results = replay({name: [text, sample(3)[name]] for name, text in scene.items()})
    assert results.error.tolist() == [error, ""]
    assert np.isfinite(results.floats("VAX")[1])
    assert np.isnan(results.floats(following)[0])
    assert results.reals(following)[0] == 0
    assert last is None or results.present(last)[0]


def test_point_masses_have_no_final_spins():
    results = replay(sample(2))
    assert results.printed("WAF").tolist() == [""]
    assert np.isnan(results.floats("WAF")).all()
    assert results.printed("VAX").tolist() == ["-15.669"]


def test_zero_determinant_is_a_normal_end():
    results = replay(sample(1).replaced({"MA": "0"}))
    assert (results.error[0], results.line[0]) == ("", 1160)
    assert results.zero_determinant[0]


def test_stored_reals_are_those_of_the_emulator():
    machine = load_machine(sample(3))
    machine.run()
    results = replay(sample(3))
    contents = {name: f"{results.reals(name)[0]:010x}" for name in ("KI", "KF", "D1", "AG")}
    assert contents == {name: machine.value(name) for name in contents}
    assert f"{results.reals('VBX')[0]:010x}" == machine.array("A")["data"][7 * 7 + 3]


def test_columns_of_any_kind_and_one_value_for_all():
    arrays = replay({**sample(1), "MU": np.array([".5", ".911"]), "GA": (-30, 15)})
    lists = replay({**sample(1), "MU": [".5", ".911"], "GA": ["-30", "15"]})
    assert arrays.printed("LOSS").tolist() == lists.printed("LOSS").tolist()
    assert len(replay({**sample(1), "MU": []})) == 0


@needs_library
def test_threads_change_nothing():
    count = BLOCK + 5
    columns = {**sample(1), "UX": [f"{-29 - k / 1000:.3f}" for k in range(count)]}
    single, double = (replay(columns, pages=True, threads=n) for n in (1, 2))
    assert single.pages == double.pages
    np.testing.assert_array_equal(single.fields, double.fields)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"MU": ["1", "x"]}, "row 2: MU = 'x' is not a number as typed"),
        ({"MU": ["1", ""]}, "row 2: MU = ''"),
        ({"MU": ["1", "1\n2"]}, "row 2: MU = '1\\\\n2'"),
        ({"MU": ["1", "1é"]}, "row 2: MU = '1é'"),
        ({"MU": ["1", "1E99x"]}, "row 2: MU = '1E99x'"),
        ({"MU": ["1", 0.5]}, "row 2: MU = 0.5 is not a number as typed; expected a text"),
        ({"MU": ["1", None]}, "row 2: MU = None"),
        ({"MU": 0.5}, "MU: 0.5 is no text"),
        ({"MU": ["1", "2"], "E": ["1"] * 3}, "columns of different lengths: E 3, MU 2"),
        ({"MUU": "1"}, "did you mean MU"),
        ({"E": "E5"}, "E = 'E5' is a number to INPUT but not in program line 280"),
        ({"UX": "1" * 30 + "." + "1" * 210}, "the Apple takes 239"),
    ],
)
def test_columns_that_cannot_be_used(changes, message, step):
    with pytest.raises(UserError, match=message):
        replay({**sample(1), **changes})


def test_a_missing_column_is_named():
    with pytest.raises(UserError, match=r"missing UX \(initial x velocity of A\)"):
        replay({name: text for name, text in sample(1).items() if name != "UX"})


def test_a_name_that_is_no_result():
    with pytest.raises(UserError, match="'LOST' is not a printed field; did you mean LOSS"):
        replay(sample(1)).printed("LOST")


@needs_library
def test_a_library_of_another_listing_is_not_used(monkeypatch):
    kernel._library.cache_clear()
    monkeypatch.setattr(kernel, "digest", lambda steps: "another")
    assert kernel.compiled_library() is None
    assert replay(sample(1)).printed("XB").tolist() == ["14.51"]
    kernel._library.cache_clear()


@needs_library
def test_the_library_can_be_switched_off():
    with library.switched_off():
        assert kernel.compiled_library() is None
    assert kernel.compiled_library() is not None
