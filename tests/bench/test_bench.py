"""The benchmark: runs, measures what it says, and its tables, JSON and figure hold together."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import pytest
from fiftydigits import exact, relative_error

from impact88.bench import figure, measure, plainc, tables
from impact88.bench.methods import METHODS, relative_errors
from impact88.casework.figures import canvas
from impact88.interface.commands.cli import main
from impact88.bench.populations import (
    BENCHMARK,
    POPULATIONS,
    scenes,
    texts,
)
from impact88.mechanics.accuracy.reference import two_doubles
from impact88.mechanics.closedform.solve import solve
from impact88.messages.progress import progress
from impact88.names import FINAL_VELOCITIES


@pytest.fixture(autouse=True)
def small_roof(monkeypatch):
    """What memory takes is no test's matter."""
    monkeypatch.setattr(measure, "ROOF_SCENES", 1000)


@pytest.fixture(scope="module")
def rows():
    with progress(None, "test") as meter:
        return measure.measure(["casework", "heavy"], 40, 3, 1, meter.update, effort=0.005)


def test_every_method_on_every_population(rows):
    got = [(row["population"], row["method"]) for row in rows]
    there = [method for method in METHODS if plainc.available() or not method.plain]
    methods = [*(method.key for method in there), "mpmath"]
    assert got == [(name, method) for name in ("casework", "heavy") for method in methods]
    for row in rows:
        assert row["seconds"] > 0
        if row["method"] != "mpmath":
            assert 0 <= row["median"] <= row["percentile_99"] <= row["largest"]


def test_errors_are_those_of_the_arithmetic(rows):
    by = {(row["population"], row["method"]): row for row in rows}
    for method, low, high in (
        ("applesoft", 1e-10, 1e-6),
        ("float64", 1e-10, 1e-6),  # 3.14159265
        ("elimination", 1e-16, 1e-12),
        ("lapack", 1e-16, 1e-12),
        ("lapack-changes", 1e-16, 1e-12),
        ("closed-form", 1e-17, 1e-12),
    ):
        assert low < by["casework", method]["largest"] < high, method
    replayed, port = by["casework", "replay"], by["casework", "applesoft"]
    assert all(replayed[key] == port[key] for key in ("median", "largest"))  # bit for bit
    assert by["heavy", "closed-form"]["over_sensitivity"] < 64
    assert 1000 * by["heavy", "closed-form"]["largest"] < by["heavy", "elimination"]["largest"]


def test_errors_by_two_doubles_are_the_reference_s():
    columns = scenes("extreme", 10, 2)
    hi, lo = two_doubles(columns)
    found = hi * (1 + 1e-12) + 1e-9
    mine = relative_errors(found, hi, lo)
    for i in range(10):
        true = exact({name: float(v[i]) for name, v in columns.items()})
        assert mine[i] == pytest.approx(relative_error(found[i].tolist(), true), rel=1e-9)
    found[3, 2] = np.nan
    assert np.isinf(relative_errors(found, hi, lo)[3])


def test_tables_and_ratios(rows):
    text = tables.results(rows)
    assert "casework (easy)" in text
    names = [method.name for method in METHODS if plainc.available() or not method.plain]
    assert all(name in text for name in names)
    assert max(map(len, text.splitlines())) <= 100
    assert "times as fast as LAPACK on ready-made matrices" in tables.ratios(rows)


def test_figures(rows, tmp_path):
    drawn = figure.work_precision(rows, 1e-8)
    assert len([text for text in drawn.texts() if text.role == "x label"]) == 2
    roles = [item.role for item in drawn.items]
    assert roles.count("memory roof") == 2
    canvas.save(drawn, str(tmp_path / "f.svg"))


def test_command(tmp_path, capsys):
    picture = tmp_path / "f.svg"
    asked = [
        "bench",
        "--populations",
        "casework",
        "--scenes",
        "5",
        "--repeats",
        "1",
        "--quick",
    ]
    asked += ["--json", "--figure", str(picture)]
    assert main(asked) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["seed"] == 1988
    assert {"processor", "cores", "numpy", "memory_roof"} <= set(found["machine"])
    assert found["results"][0]["scenes_per_second"] > 0
    assert picture.read_text().startswith("<?xml")
    assert main(["bench", "--scenes", "0"]) == 2
    assert main(["bench", "--populations", "easy"]) == 2
    assert main(["bench", "--figure", "f.doc"]) == 2


@pytest.mark.long
def test_quick_is_one_screen(capsys):
    asked = ["bench", "--quick", "--scenes", "5", "--repeats", "1"]
    assert main(asked) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) <= 40
    assert max(map(len, lines)) <= 120
    assert "casework: median" in "".join(lines)
    assert "times what memory alone takes" in lines[-1]


def test_plain_c_is_left_out_with_a_word_where_no_compiler_is(monkeypatch):
    monkeypatch.setattr(plainc, "available", lambda: False)
    columns = scenes("casework", 10, 3)
    methods = {method.key for method in METHODS if measure.applies(method, "casework", columns)}
    assert methods == {method.key for method in METHODS if not method.plain}
    assert "no C compiler" in tables.machine(measure.machine())


@pytest.mark.skipif(not plainc.available(), reason="there is no C compiler")
@pytest.mark.parametrize("flags", plainc.FLAGS)
@pytest.mark.parametrize("name", ["casework", "heavy", "units"])
def test_plain_c_solves_the_same_equations(name, flags):
    columns = scenes(name, 500, 7)
    results = plainc.solve(plainc.prepare(columns), flags)
    expected = solve(columns, FINAL_VELOCITIES)
    size = max(np.abs(expected[velocity]).max() for velocity in ("VAX", "VAY", "VBX", "VBY"))
    for velocity, values in results.items():
        scale = size if velocity.startswith("V") else np.abs(expected[velocity]).max()
        assert np.abs(values - expected[velocity]).max() < 1e-11 * scale
    room = {velocity: np.zeros(500) for velocity in FINAL_VELOCITIES}
    plainc.move(plainc.prepare(columns), room)
    total = sum(columns[key] for key in plainc.COLUMNS)
    assert all(values == pytest.approx(total) for values in room.values())


@pytest.mark.skipif(not plainc.available(), reason="there is no C compiler")
def test_plain_c_leaves_the_process_its_arithmetic():
    """gcc's -ffast-math would have subnormal numbers taken for 0, by everything else, too."""
    code = (
        "import numpy as np; from impact88.bench import plainc; assert plainc.available(); "
        "print((np.array([2.0**-1000]) * 2.0**-70).tobytes().hex())"  # not ==: 0 would be equal
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == np.array([2.0**-1070]).tobytes().hex()


@pytest.mark.skipif(not plainc.available(), reason="there is no C compiler")
def test_plain_c_knows_no_pivot():
    rival = next(method for method in METHODS if method.plain)
    assert not measure.applies(rival, "pivots", scenes("pivots", 10, 3))


def test_populations_of_the_table_can_be_typed():
    assert set(BENCHMARK) <= set(POPULATIONS)
    for name in BENCHMARK:
        columns = scenes(name, 20, 1)
        for key, column in texts(columns).items():
            assert [float(text) for text in column] == columns[key].tolist()
