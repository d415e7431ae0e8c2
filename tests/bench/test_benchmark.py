"""The benchmark: its methods agree, errors are those of 50 digits."""

from __future__ import annotations

import json
from functools import partial

import numpy as np
import pytest

from impact88.bench import benchmark
from impact88.cli.main import main

pytest.importorskip("mpmath")


@pytest.fixture(scope="module")
def measurements():
    steps = []
    rows = benchmark.measure(lambda *step: steps.append(step), scenes=12, repeats=1, effort=1e-4)
    assert steps[-1] == (len(rows), 1.0)
    return {(row.population, row.method): row for row in rows}


def test_every_method_on_every_population(measurements):
    assert len(measurements) == len(benchmark.METHODS) * len(benchmark.POPULATIONS)
    assert all(row.seconds > 0 and row.unanswered == 0 for row in measurements.values())


def test_errors_are_those_of_the_arithmetic(measurements):
    by_method = {
        method: row.largest for (name, method), row in measurements.items() if name == "cars"
    }
    listing, lapack, replay, by_numpy, by_library = by_method.values()
    assert 1e-10 < listing < 1e-6  # eight decimals of pi
    assert 1e-10 < replay < 1e-5
    assert lapack < 1e-11
    assert by_numpy == by_library < 1e-13


def test_elimination_loses_the_digits_of_a_heavy_vehicle(measurements):
    largest = {
        method: row.largest for (name, method), row in measurements.items() if name != "cars"
    }
    assert largest["listing's equations by LAPACK"] > 1e-9
    assert largest["solve, compiled"] < 1e-13


def test_relative_errors_are_in_units_of_the_largest_velocity_and_spin():
    exact = np.array([[1.0, -4.0, 2.0, 0.0, 0.5, -2.0]])
    velocities = np.array([[1.0, -4.0, 2.0, 0.04, 0.5, -2.1]])
    assert benchmark.relative_errors(velocities, exact) == pytest.approx([0.05])


def test_the_command_writes_a_page_or_json(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(benchmark, "METHODS", benchmark.METHODS[1:3])
    few = partial(benchmark.measure, scenes=3, repeats=1, effort=0.05)
    monkeypatch.setattr(benchmark, "measure", few)
    page = tmp_path / "measurements.md"
    assert main(["bench", "-o", str(page)]) == 0
    assert "| cars | replay: the Apple's arithmetic |" in page.read_text("utf-8")
    assert main(["bench", "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["measurements"]) == 4
