"""The benchmark: runs, measures what it says, and its tables, JSON and figure hold together."""

from __future__ import annotations

import json

import numpy as np
import pytest

from impact88.accuracy.reference import exact, relative_error
from impact88.bench import figure, measure, paths, tables
from impact88.bench.methods import METHODS, prepare, reference, relative_errors
from impact88.bench.populations import BENCHMARK, POPULATIONS, scenes, texts
from impact88.cli import main
from impact88.figures import canvas
from impact88.progress import progress


@pytest.fixture(scope="module")
def rows():
    with progress(None, "test") as meter:
        return measure.measure(["casework", "heavy"], 40, 3, 1, meter, effort=0.02)


def test_every_method_on_every_population(rows):
    got = [(row.population, row.method) for row in rows]
    methods = [*(method.key for method in METHODS), "mpmath"]
    assert got == [(name, method) for name in ("casework", "heavy") for method in methods]
    for row in rows:
        assert row.seconds > 0
        assert 0 <= row.median <= row.per_mille <= row.largest


def test_errors_are_those_of_the_arithmetic(rows):
    by = {(row.population, row.method): row for row in rows}
    for method, low, high in (
        ("applesoft", 1e-10, 1e-6),
        ("float64", 1e-10, 1e-6),  # 3.14159265
        ("elimination", 1e-16, 1e-12),
        ("lapack", 1e-16, 1e-12),
        ("lapack-changes", 1e-16, 1e-12),
        ("closed-form", 1e-17, 1e-12),
    ):
        assert low < by["casework", method].largest < high, method
    replayed, port = by["casework", "replay"], by["casework", "applesoft"]
    assert (replayed.median, replayed.largest) == (port.median, port.largest)  # bit for bit
    assert by["heavy", "closed-form"].over_sensitivity < 64
    assert 1000 * by["heavy", "closed-form"].largest < by["heavy", "elimination"].largest


def test_errors_by_two_doubles_are_the_reference_s():
    prepared = prepare(scenes("extreme", 10, 2))
    hi, lo = reference(prepared)
    found = hi * (1 + 1e-12) + 1e-9
    mine = relative_errors(found, hi, lo)
    for i in range(10):
        true = exact({name: float(v[i]) for name, v in prepared.columns.items()})
        assert mine[i] == pytest.approx(relative_error(found[i].tolist(), true), rel=1e-9)
    found[3, 2] = np.nan
    assert np.isinf(relative_errors(found, hi, lo)[3])


def test_tables_and_ratios(rows):
    text = tables.results(rows)
    assert "casework (easy)" in text
    assert all(method.name in text for method in METHODS)
    assert max(map(len, text.splitlines())) <= 100
    assert "times as fast as LAPACK on ready-made matrices" in tables.ratios(rows)


def test_figure(rows, tmp_path):
    drawn = figure.work_precision(rows)
    assert len([text for text in drawn.texts() if text.role == "x label"]) == 2
    canvas.save(drawn, str(tmp_path / "f.svg"))


def test_command(tmp_path, capsys):
    picture = tmp_path / "f.svg"
    asked = ["bench", "--populations", "casework", "--scenes", "5", "--repeats", "1", "--quick"]
    assert main([*asked, "--json", "--figure", str(picture)]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["seed"] == 1988
    assert {"processor", "cores", "numpy"} <= set(found["machine"])
    assert found["results"][0]["scenes_per_second"] > 0
    assert picture.read_text().startswith("<?xml")
    assert main(["bench", "--scenes", "0"]) == 2
    assert main(["bench", "--populations", "easy"]) == 2
    assert main(["bench", "--figure", "f.doc"]) == 2


def test_paths_and_sizes():
    by_kind, by_output = paths.paths(2000, 1)
    assert [path.name for path in by_kind] == list(paths.PATHS)
    general = by_kind[0].passes
    assert all(path.passes < general for path in by_kind[1:] if "pivot" not in path.name)
    assert by_output[-1].passes == max(path.passes for path in by_output)
    assert "general" in tables.paths(by_kind, by_output)
    assert "floor" in tables.floor(paths.floor(50_000, 1))
    grown = paths.sizes([1000, 50_000], 1)
    assert grown[1].extra_bytes < 16e6  # working arrays, not the scenes
    assert "50,000" in tables.sizes(grown)


def test_populations_of_the_table_can_be_typed():
    assert set(BENCHMARK) <= set(POPULATIONS)
    for name in BENCHMARK:
        columns = scenes(name, 20, 1)
        for key, column in texts(columns).items():
            assert [float(text) for text in column] == columns[key].tolist()


def test_files_are_timed_beside_the_computation(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("impact88.commands.bench_command.FILE_ROWS", 300)
    assert main(["bench", "--files", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["files"]
    assert found["rows"] == 300
    names = [door["name"] for door in found["doors"]]
    assert names[0] == "computation alone"
    assert any(name.startswith("CSV to CSV") for name in names)
