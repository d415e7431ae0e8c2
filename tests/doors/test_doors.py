"""Every door tried with the same 2,000 scenes gives the same bits, in all results."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Iterator, Mapping
from multiprocessing.shared_memory import SharedMemory
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from longer import long_but

import impact88
from impact88.bench.populations import BENCHMARK, scenes
from impact88.interface.commands.cli import main
from impact88.mechanics.closedform.columns import UNUSED_BY_POINTS
from impact88.names import RESULTS, SCENE
from impact88.tables import csvtable
from impact88.tables.table import format_of, open_reader

COUNT = 2000
SAME = {"MA": 143.5, "EM": -0.715}
"""What all scenes have in common, for those doors at which one value may stand for a column."""


def _columns() -> dict[str, np.ndarray]:
    drawn = scenes(BENCHMARK[0], COUNT, 5)
    # a workbook keeps fifteen digits of a number
    rounded = {n: [float(f"{x:.12g}") for x in np.broadcast_to(c, COUNT)] for n, c in drawn.items()}
    columns = {name: np.array(rounded.get(name, [6.0] * COUNT)) for name in SCENE}
    columns |= {name: np.full(COUNT, value) for name, value in SAME.items()}
    columns["MU"][::7] = -10.0
    columns["M"][::11] = 4.0
    columns["MB"][5] = columns["IB"][5] = np.inf
    columns["VX"][5] = columns["VY"][5] = columns["WB"][5] = 0.0
    return columns


COLUMNS = _columns()
EXPECTED = impact88.solve(COLUMNS, threads=1)
CHANGING = {name: column for name, column in COLUMNS.items() if name not in SAME}


def bits(results: Mapping[str, Any]) -> dict[str, bytes]:
    """Results by name, bit for bit; every NaN is the same."""
    columns = {name: np.array(results[name], np.float64) for name in RESULTS}
    return {n: np.where(np.isnan(c), np.nan, c).tobytes() for n, c in columns.items()}


def differing(results: Mapping[str, Any]) -> list[str]:
    given, expected = bits(results), bits(EXPECTED)
    return [name for name in RESULTS if given[name] != expected[name]]


def test_a_last_bit_is_noticed() -> None:
    assert sum(np.isnan(EXPECTED["VAX"])) < COUNT // 100
    for name in RESULTS:
        changed = EXPECTED[name].astype(np.float64)
        changed[77] = np.nextafter(changed[77], np.inf)
        assert differing({**EXPECTED, name: changed}) == [name]
    nudged = {**COLUMNS, "UX": np.nextafter(COLUMNS["UX"], np.inf)}
    assert differing(impact88.solve(nudged))


# --- in Python -----------------------------------------------------------------------------------


def rows(columns: Mapping[str, np.ndarray] = COLUMNS) -> list[dict[str, float]]:
    lists = [column.tolist() for column in columns.values()]
    return [dict(zip(columns, row, strict=True)) for row in zip(*lists, strict=True)]


def of_rows(solved: list[dict[str, Any]]) -> dict[str, list[Any]]:
    return {name: [row[name] for row in solved] for name in RESULTS}


def one_by_one() -> Any:
    return of_rows([impact88.solve(row) for row in rows()])


def grid() -> Any:
    shaped = impact88.solve({name: column.reshape(40, 50) for name, column in COLUMNS.items()})
    return {name: column.reshape(-1) for name, column in shaped.items()}


def backwards() -> Any:
    solved = impact88.solve({name: column[::-1] for name, column in COLUMNS.items()}, threads=2)
    return {name: column[::-1] for name, column in solved.items()}


def masked() -> Any:
    return impact88.solve({n: np.ma.masked_array(c, np.zeros(COUNT)) for n, c in COLUMNS.items()})


def structured() -> Any:
    array = np.empty(COUNT, [(name, float) for name in COLUMNS])
    for name, column in COLUMNS.items():
        array[name] = column
    return impact88.solve_frame(array)


def pandas_frame() -> Any:
    return impact88.solve_frame(pytest.importorskip("pandas").DataFrame(COLUMNS))


def pandas_series() -> Any:
    frame = pytest.importorskip("pandas").DataFrame(COLUMNS)
    return impact88.solve({name: frame[name] for name in SCENE})


def polars_frame() -> Any:
    return impact88.solve_frame(pytest.importorskip("polars").DataFrame(COLUMNS))


def pyarrow_table() -> Any:
    return impact88.solve_frame(pytest.importorskip("pyarrow").table(COLUMNS))


def fresh_arrays() -> Any:
    out = {name: np.empty(COUNT, column.dtype) for name, column in EXPECTED.items()}
    impact88.solve(COLUMNS, out=out)
    return out


def shared_memory() -> Any:
    """Scenes and results in memory that other processes can have."""
    size = COUNT * 8
    shared = SharedMemory(create=True, size=size * (len(SCENE) + len(RESULTS)))
    try:
        place = iter(range(0, shared.size, size))

        def array(dtype: Any) -> np.ndarray:
            return np.ndarray(COUNT, dtype, shared.buf, next(place))

        columns = {name: array(float) for name in SCENE}
        out = {name: array(column.dtype) for name, column in EXPECTED.items()}
        for name, column in COLUMNS.items():
            columns[name][:] = column
        impact88.solve(columns, out=out)
        kept = {name: column.copy() for name, column in out.items()}
        del columns, out
        return kept
    finally:
        shared.close()
        shared.unlink()


IN_PYTHON: dict[str, Callable[[], Any]] = {
    "one by one": one_by_one,
    "two dimensions": grid,
    "backwards, two threads": backwards,
    "single values among arrays": lambda: impact88.solve({**CHANGING, **SAME}),
    "masked arrays": masked,
    "list of dicts": lambda: of_rows(impact88.solve_frame(rows())),
    "dict of lists": lambda: impact88.solve_frame({n: c.tolist() for n, c in COLUMNS.items()}),
    "texts": lambda: of_rows(
        impact88.solve_frame([{n: repr(x) for n, x in row.items()} for row in rows()])
    ),
    "a scene for what is missing": lambda: of_rows(
        impact88.solve_frame(rows(CHANGING), scene=SAME)
    ),
    "structured array": structured,
    "pandas": pandas_frame,
    "pandas columns": pandas_series,
    "polars": polars_frame,
    "pyarrow": pyarrow_table,
    "out=": fresh_arrays,
    "out= in shared memory": shared_memory,
}


@pytest.mark.parametrize("door", IN_PYTHON)
def test_in_python(door: str) -> None:
    assert not differing(IN_PYTHON[door]())


# --- files ---------------------------------------------------------------------------------------


def read(path: Path) -> dict[str, list[float]]:
    """The results in a table."""
    whole: dict[str, list[float]] = {name: [] for name in RESULTS}
    with open_reader(str(path), format_of(str(path), None)) as source:
        for block in source:
            for name in RESULTS:
                cells = block.columns[name]
                whole[name] += [np.nan if cell is None else float(str(cell)) for cell in cells]
    return whole


def write_csv(path: Path, columns: Mapping[str, np.ndarray], delimiter: str = ",") -> None:
    point = "," if delimiter == ";" else "."
    with path.open("w", newline="") as file:
        writer = csv.writer(file, delimiter=delimiter)
        writer.writerow(columns)
        texts = ([repr(x).replace(".", point) for x in c.tolist()] for c in columns.values())
        writer.writerows(zip(*texts, strict=True))


FORMS = ("csv.gz", "jsonl.gz", "npz", "parquet", "xlsx")


@pytest.fixture(params=["pyarrow", "standard library"])
def csv_by(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """By which library CSV is read and written."""
    if request.param == "pyarrow":
        pytest.importorskip("pyarrow")
    else:
        monkeypatch.setattr(csvtable, "arrow_available", lambda: False)
    return request.param


@pytest.mark.parametrize("delimiter", [",", ";"])
def test_csv(csv_by: str, delimiter: str, tmp_path: Path) -> None:
    source, there = tmp_path / "a.csv", tmp_path / "b.csv"
    write_csv(source, COLUMNS, delimiter)
    assert main(["solve", str(source), "-o", str(there)]) == 0
    assert not differing(read(there))


@pytest.mark.parametrize("form", long_but(FORMS, kept=(0, 2, 3)))
def test_a_format_out_and_in_again(form: str, tmp_path: Path) -> None:
    if form == "parquet":
        pytest.importorskip("pyarrow")
    if form == "xlsx":
        pytest.importorskip("openpyxl")
    source, there, last = tmp_path / "a.csv", tmp_path / f"b.{form}", tmp_path / "c.npz"
    write_csv(source, COLUMNS)
    if form == "xlsx":  # openpyxl writes sixteen digits of a number, enough for the scenes
        assert main(["solve", str(source), "-o", str(there), "--outputs", "STATUS"]) == 0
    else:
        assert main(["solve", str(source), "-o", str(there)]) == 0
        assert not differing(read(there))
    assert main(["solve", str(there), "-o", str(last)]) == 0
    assert not differing(np.load(last))


def test_values_for_all_rows(tmp_path: Path) -> None:
    """From a scene file and from the command line, in place of columns."""
    source, scene, there = tmp_path / "a.csv", tmp_path / "s.toml", tmp_path / "b.npz"
    write_csv(source, CHANGING)
    scene.write_text(f"MA = {SAME['MA']}\nEM = 7\n")
    more = ["--scene", str(scene), "--set", f"EM={SAME['EM']}"]
    assert main(["solve", str(source), "-o", str(there), *more]) == 0
    assert not differing(np.load(there))


def test_standard_input_and_output(tmp_path: Path) -> None:
    import subprocess
    import sys

    source = tmp_path / "a.csv"
    write_csv(source, COLUMNS)
    with source.open("rb") as file:
        done = subprocess.run(
            [sys.executable, "-m", "impact88", "solve", "-"],
            stdin=file,
            capture_output=True,
            check=True,
        )
    there = tmp_path / "b.csv"
    there.write_bytes(done.stdout)
    assert not differing(read(there))


# --- point masses and what they do not look at ---------------------------------------------------

MIXED = [
    {
        name: None if row["M"] == 4 and name in UNUSED_BY_POINTS else value
        for name, value in row.items()
    }
    for row in rows()[:200]
]
"""Scenes with M = 6 and with M = 4, these without the cells that they do not look at."""


def shortened(row: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in row.items() if value is not None}


def written(path: Path) -> Path:
    """A table of the mixed scenes in the format of its name."""
    texts = [{n: "" if v is None else repr(v) for n, v in row.items()} for row in MIXED]
    if path.suffix == ".csv":
        lines = [",".join(row.values()) for row in ({n: n for n in SCENE}, *texts)]
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    elif path.suffix == ".jsonl":
        objects = [shortened(row) if at % 2 else row for at, row in enumerate(MIXED)]
        lines = [json.dumps(row).replace("Infinity", '"inf"') for row in objects]
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    elif path.suffix == ".npz":
        np.savez(path, **{n: np.array([row[n] for row in MIXED], float) for n in SCENE})
    elif path.suffix == ".parquet":
        pa = pytest.importorskip("pyarrow")
        pa.parquet = pytest.importorskip("pyarrow.parquet")
        pa.parquet.write_table(pa.Table.from_pylist(MIXED), path)
    else:
        openpyxl = pytest.importorskip("openpyxl")
        book = openpyxl.Workbook()
        for row in ({n: n for n in SCENE}, *MIXED):
            book.active.append(
                [None if v is None else "inf" if v == np.inf else v for v in row.values()]
            )
        book.save(path)
    return path


@pytest.mark.parametrize("form", ["csv", "jsonl", "npz", "parquet", "xlsx"])
def test_tables_leave_out_what_point_masses_do_not_look_at(form: str, tmp_path: Path) -> None:
    table, out = written(tmp_path / f"mixed.{form}"), tmp_path / "out.npz"
    assert main(["solve", str(table), "-o", str(out), "--results-only"]) == 0
    with np.load(out) as found:
        for name in RESULTS:
            assert found[name].tobytes() == EXPECTED[name][:200].tobytes(), name


def test_frames_leave_out_what_point_masses_do_not_look_at() -> None:
    pandas = pytest.importorskip("pandas")
    columns = {name: [row[name] for row in MIXED] for name in SCENE}
    frames = [columns, list(map(shortened, MIXED)), pandas.DataFrame(MIXED)]
    solved = [impact88.solve_frame(frame, ["VAX", "STATUS"]) for frame in frames]
    solved[1] = {name: [row[name] for row in solved[1]] for name in ("VAX", "STATUS")}
    solved.append(impact88.solve({name: np.array(column) for name, column in columns.items()}))
    alone = [impact88.solve(shortened(row), ["VAX", "STATUS"]) for row in MIXED]
    solved.append({name: [row[name] for row in alone] for name in ("VAX", "STATUS")})
    for one in solved:
        for name in ("VAX", "STATUS"):
            assert np.array_equal(
                np.asarray(one[name], float), EXPECTED[name][:200], equal_nan=True
            )


def test_the_listing_replays_point_masses_without_them(tmp_path: Path) -> None:
    table, out = written(tmp_path / "mixed.csv"), tmp_path / "out.npz"
    arguments = ["--arithmetic", "applesoft", "--set", "MB=100", "--set", "IB=2000"]
    assert main(["solve", str(table), "-o", str(out), *arguments]) == 0
    with np.load(out) as found:
        assert np.isfinite(found["VAX"]).all()


def test_what_rows_with_six_equations_look_at_is_missed(tmp_path: Path, capfd: Any) -> None:
    table, out = tmp_path / "short.csv", tmp_path / "out.csv"
    names = [name for name in SCENE if name != "TB"]
    lines = [",".join("" if row[n] is None else repr(row[n]) for n in names) for row in MIXED[:12]]
    table.write_text("\n".join([",".join(names), *lines]) + "\n", encoding="utf-8")
    assert main(["solve", str(table), "-o", str(out)]) == 1
    told = capfd.readouterr().err
    assert "row 2 (line 3), TB: is empty; expected a number" in told
    assert "row 1 (" not in told
    assert "row 12 (" not in told
