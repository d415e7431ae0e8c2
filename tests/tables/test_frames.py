"""Frames of every kind: the same scenes give the same bits through every door."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest

import impact88
from impact88.errors import UserError
from impact88.bench.populations import BENCHMARK, scenes
from impact88.names import RESULTS, SCENE
from impact88.status import Status
from impact88.tables.frames import solve_frame

COUNT = 2000
COLUMNS = {name: np.asarray(column) for name, column in scenes(BENCHMARK[0], COUNT, 5).items()}
COLUMNS = {name: np.broadcast_to(column, (COUNT,)).copy() for name, column in COLUMNS.items()}
EXPECTED = impact88.solve(COLUMNS)
NOTE = [f"n{i}" for i in range(COUNT)]


def pandas_frame() -> Any:
    pandas = pytest.importorskip("pandas")
    return pandas.DataFrame({**COLUMNS, "note": NOTE}, index=range(7, 7 + 3 * COUNT, 3))


def polars_frame() -> Any:
    return pytest.importorskip("polars").DataFrame({**COLUMNS, "note": NOTE})


def pyarrow_table() -> Any:
    return pytest.importorskip("pyarrow").table({**COLUMNS, "note": NOTE})


def records() -> Any:
    whole = {**COLUMNS, "note": np.array(NOTE)}
    array = np.empty(COUNT, [(name, column.dtype) for name, column in whole.items()])
    for name, column in whole.items():
        array[name] = column
    return array


def dicts() -> Any:
    rows = zip(*(column.tolist() for column in COLUMNS.values()), NOTE, strict=True)
    return [dict(zip([*COLUMNS, "note"], row, strict=True)) for row in rows]


KINDS = [pandas_frame, polars_frame, pyarrow_table, records, dicts]


def column(frame: Any, name: str) -> np.ndarray:
    return np.asarray([row[name] for row in frame] if isinstance(frame, list) else frame[name])


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_gives_the_bits_of_the_arrays(kind: Any) -> None:
    frame = kind()
    solved = solve_frame(frame)
    assert type(solved) is type(frame)
    for name in RESULTS:
        assert np.array_equal(column(solved, name), EXPECTED[name], equal_nan=True), name
    assert column(solved, "note").tolist() == NOTE


def test_an_index_is_kept_and_the_frame_handed_over_stays() -> None:
    frame = pandas_frame()
    before = frame.copy()
    solved = solve_frame(frame, "VAX")
    assert solved.index.equals(frame.index)
    assert list(solved.columns) == [*frame.columns, "VAX"]
    assert frame.equals(before)
    assert solve_frame(solved, "VAX").equals(solved)  # a result takes the place of its name


@pytest.mark.parametrize("kind", [pandas_frame, polars_frame, pyarrow_table])
def test_missing_cells_are_not_computed(kind: Any) -> None:
    library = pytest.importorskip(kind.__name__.partition("_")[0])
    columns = {name: column[:3].tolist() for name, column in COLUMNS.items()}
    columns["MU"][1] = None
    columns["M"] = [6.0, 6.0, None]
    frame = library.table(columns) if library.__name__ == "pyarrow" else library.DataFrame(columns)
    solved = solve_frame(frame, "VAX,STATUS")
    assert np.isnan(column(solved, "VAX")).tolist() == [False, True, False]
    assert column(solved, "STATUS")[1] == Status.NOT_FINITE
    assert column(solved, "VAX")[0] == EXPECTED["VAX"][0]


def test_masked_elements_are_not_computed() -> None:
    mu = np.ma.MaskedArray(COLUMNS["MU"][:3], [False, True, False])
    for solved in (
        impact88.solve({**{n: c[:3] for n, c in COLUMNS.items()}, "MU": mu}),
        solve_frame({**{n: c[:3] for n, c in COLUMNS.items()}, "MU": mu}),
    ):
        assert solved["STATUS"][1] == Status.NOT_FINITE
        assert np.isnan(solved["VAX"][1])
        assert solved["VAX"][2] == EXPECTED["VAX"][2]


def test_texts_count_as_input_reads_them() -> None:
    row = dict(impact88.sample(1))
    (solved,) = solve_frame([row], "VAX")
    assert solved["VAX"] == pytest.approx(-13.2626556835327)
    (solved,) = solve_frame([{**row, "MA": "1_0"}], "VAX,STATUS")
    assert (np.isnan(solved["VAX"]), solved["STATUS"]) == (True, Status.NOT_FINITE)


def test_a_scene_gives_what_the_frame_lacks() -> None:
    mu = np.array([0.1, 0.5])
    solved = solve_frame({"MU": mu}, "VAX", scene=impact88.sample(1))
    numbers = {name: float(text) for name, text in impact88.sample(1).items()}
    assert np.array_equal(solved["VAX [ft/s]"], impact88.solve({**numbers, "MU": mu}, "VAX")["VAX"])


@pytest.mark.parametrize(
    ("frame", "says"),
    [
        ({"MU": [1.0]}, "no column E EM DA"),
        ([{"MU": 1}], "no column E EM DA"),
        ([1, 2], "list of dicts"),
        (np.zeros(3), "has no columns"),
        ("text", "not a frame of values"),
    ],
)
def test_what_cannot_be_solved_is_said_in_one_line(frame: Any, says: str) -> None:
    with pytest.raises(UserError, match=says) as error:
        solve_frame(frame)
    assert "\n" not in str(error.value)


def test_a_replay_is_a_frame_too() -> None:
    pandas = pytest.importorskip("pandas")
    replayed = impact88.replay({**impact88.sample(1), "IA": ["3728", "0"]})
    frame = pandas.DataFrame(replayed.to_dict())
    assert frame["VAX"][0] == replayed.floats("VAX")[0]
    assert frame["ERROR"].tolist() == ["", "?DIVISION BY ZERO ERROR IN 480"]
    assert frame["LINE"].tolist() == [0, 480]
    assert len(replayed) == 2
    assert repr(replayed).startswith("<Replay of 2 scenes: 1 ended by an error, 0 by a zero")


def test_a_run_has_numbers_and_shows_itself() -> None:
    run = impact88.run(impact88.sample(1))
    replayed = impact88.replay(impact88.sample(1))
    assert run.floats["KI"] == replayed.floats("KI")[0]
    assert run.floats.keys() == run.reals.keys()
    assert repr(run).startswith("<Run: END; ")
    assert run._repr_html_().startswith("<pre ")
    assert "VAX= -13.263" in run._repr_html_()
    assert run._repr_html_()[5:-6].replace("\n", "").isprintable()
    double = impact88.run(impact88.sample(1), "float64")
    assert double.floats["KI"] == double.reals["KI"]


def test_narwhals_is_named_where_it_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    frame = pandas_frame()
    for name in [name for name in sys.modules if name.startswith("narwhals")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "narwhals", None)
    with pytest.raises(UserError, match=r"impact88\[frames\]"):
        solve_frame(frame)


def test_no_scene_name_hints_at_frames() -> None:
    with pytest.raises(UserError, match="solve_frame takes further columns"):
        impact88.solve({**COLUMNS, "note": 1})
    assert set(SCENE) <= set(COLUMNS) | {"M"}
