"""What of a table is hardly meant: the same as of each of its rows alone, said once."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

import impact88
from impact88.collision.plausibility import remarks as remarks_of_one
from impact88.collision.units import RULES, SYSTEMS, System
from impact88.interface.commands.cli import main
from impact88.names import SCENE
from impact88.tables import remarks as tables
from impact88.tables.cells import TableUnits

NAMES = [*SCENE]
USUAL = {
    **dict.fromkeys(NAMES, 0.0),
    **{"MA": 3091.0, "MB": 4000.0, "IA": 2100.0, "IB": 2900.0, "M": 6.0, "EM": 1.0, "MU": 0.5},
    **{"UX": -25.0, "VX": 20.0, "DA": 4.0, "DB": 4.0, "E": 0.1},
}
"""A row in us units that nothing is to be said of."""
ODD = {
    "MA": [440.0, 441.0, 132_000.0, 133_000.0, 0.0, -5.0, np.inf, 3.091],
    "IB": [540.0, 10_000.0, 0.0, 700.0, 15_000.0],
    "UX": [-310.0, -311.0, 310.0, np.nan],
    "VY": [19.9, 20.1, -400.0],
    "DA": [49.0, 49.5, -50.0],
    "TA": [44.9, 45.1, 180.0, 400.0],
    "TB": [-44.0, 46.0],
    "EM": [0.0, -0.0, 1e-300],
    "M": [4.0],
}
"""Values on both sides of each threshold."""


def text_of(value: float) -> str:
    return repr(value).removesuffix(".0")


def in_base(row: Mapping[str, float], system: System) -> dict[str, float]:
    """A row in us units in the system's base units, by its own factors."""
    units = TableUnits([], system.name or None)
    return {name: value * units.factor(name) for name, value in row.items()}


@pytest.mark.parametrize("system", [SYSTEMS["us"], RULES], ids=["us", "bare"])
def test_a_table_is_remarked_on_as_each_of_its_rows(system: System) -> None:
    rng = np.random.default_rng(4)
    rows, expected = [], {}
    for at in range(400):
        odd = rng.choice([*ODD], rng.integers(0, 4), replace=False)
        rows.append({**USUAL, **{name: float(rng.choice(ODD[name])) for name in odd}})
        texts = {name: text_of(value) for name, value in rows[-1].items()}
        for name, text in remarks_of_one(in_base(rows[-1], system), texts, system, {}).items():
            count, first, words = expected.get(name, (0, at, text))
            expected[name] = count + 1, first, words
    based = [in_base(row, system) for row in rows]
    columns = {name: np.tile([row[name] for row in based], 50) for name in NAMES}
    found = tables.remarks(columns, system, lambda name, at: text_of(rows[at][name]))
    words = {name: (remark.rows, remark.first, remark.text) for name, remark in found.items()}
    assert words == {n: (50 * count, first, text) for n, (count, first, text) in expected.items()}
    assert len(words) >= 3


def test_one_value_for_all_rows_is_remarked_on_in_all() -> None:
    columns = {name: np.array([value]) for name, value in in_base(USUAL, SYSTEMS["us"]).items()}
    columns["MA"] = columns["MA"] / 1000
    columns["UY"] = np.zeros(7)
    (remark,) = tables.remarks(columns, SYSTEMS["us"], lambda name, at: "3.091").values()
    assert (remark.rows, remark.first, remark.more) == (7, 0, " and 6 more rows")


def test_courses_of_a_long_array_are_looked_at_evenly_and_then_counted() -> None:
    columns = {name: np.full(50_000, value) for name, value in USUAL.items()}
    assert not tables.remarks(columns, RULES, lambda name, at: "", every=False)
    columns["TA"][1::7] = 90.0
    (remark,) = tables.remarks(columns, RULES, lambda name, at: "", every=False).values()
    assert (remark.rows, remark.first) == (len(columns["TA"][1::7]), 1)


def table(path: Path, rows: list[dict[str, float]]) -> str:
    lines = [",".join(NAMES), *(",".join(text_of(row[n]) for n in NAMES) for row in rows)]
    path.write_text("\n".join(lines) + "\n")
    return str(path)


@pytest.mark.parametrize("arithmetic", ["float64", "applesoft"])
def test_the_command_says_each_remark_once(
    arithmetic: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = [{**USUAL, "MA": 3.091, "EM": 0.0} if at in (2, 5) else USUAL for at in range(8)]
    path = table(tmp_path / "cases.csv", rows)
    results = str(tmp_path / "results.csv")
    command = ["solve", path, "--units", "us", "--arithmetic", arithmetic, "-o", results]
    assert main(command) == 0
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 2
    place = "impact88 solve: row 3 (line 4) and 1 more row: "
    assert (
        said[0] == f"{place}MA = 3.091: no vehicle has that mass (200 kg to 60 t); is its unit "
        "as meant?"
    )
    assert said[1].startswith(f"{place}EM = 0: ")


def test_a_value_for_all_rows_is_shown_as_it_was_typed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = table(tmp_path / "cases.csv", [USUAL, USUAL])
    results = str(tmp_path / "results.csv")
    assert main(["solve", path, "--units", "us", "--set", "MA=3.091 lb", "-o", results]) == 0
    assert "row 1 (line 2) and 1 more row: MA = 3.091 lb: no vehicle" in capsys.readouterr().err


def test_what_the_scene_of_a_sweep_was_told_is_not_said_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text("".join(f"{n} = {text_of(v)}\n" for n, v in {**USUAL, "EM": 0.0}.items()))
    results = str(tmp_path / "results.csv")
    assert main(["solve", str(scene), "--sweep", "MU=0:1:5", "-o", results]) == 0
    assert capsys.readouterr().err.count("EM = 0") == 1


def test_frames_warn_where_they_were_handed_over() -> None:
    rows = [{**USUAL, "MA": 3.091} if at in (2, 5) else USUAL for at in range(8)]
    with pytest.warns(impact88.PlausibilityWarning) as caught:
        impact88.solve_frame(rows, "LOSS", units="us")
    (warning,) = caught
    assert warning.filename == __file__
    assert str(warning.message).startswith("2 rows, the first at position 2: MA = 3.091: no ")


def test_numbers_without_units_have_no_sizes() -> None:
    columns = {name: np.array([value, value / 1000]) for name, value in USUAL.items()}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        impact88.solve({**columns, "M": 6})
        impact88.solve_frame({**columns, "M": np.array([6.0, 6.0]), "EM": np.ones(2)})
