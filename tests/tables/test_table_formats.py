"""Tables in every format: the same numbers in and out, and files that are refused by line."""

import csv
import io
import json
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import impact88
from impact88.cases import Case
from impact88.errors import UserError
from impact88.mechanics.solve import solve
from impact88.names import SCENE
from impact88.tables import textformats
from impact88.tables.engine import read_table, write_table
from impact88.tables.solving import Solver

SAMPLES = [dict(impact88.sample(number)) for number in (1, 2, 3)]
FORMATS = ("csv", "jsonl", "parquet", "xlsx")


@pytest.fixture(params=["polars", "csv module"])
def _engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    if request.param == "csv module":
        monkeypatch.setattr(textformats, "find_spec", lambda _: None)


def csv_text(rows: list[dict[str, str]], delimiter: str = ",") -> str:
    lines = [list(rows[0]), *(list(row.values()) for row in rows)]
    return "".join(delimiter.join(line) + "\n" for line in lines)


def read_rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def columns_of(path: Path) -> dict[str, list[Any]]:
    table = read_table(str(path))
    columns: dict[str, list[Any]] = {name: [] for name in table.names}
    for block in table.blocks:
        for cells, column in zip(columns.values(), block.columns, strict=True):
            cells.extend(column.to_list() if hasattr(column, "to_list") else column)
    return columns


def write(path: Path, text: str) -> Path:
    path.write_bytes(text.encode())
    return path


def solve_table(
    source: Path, target: Path, *results: str, units: str = "", **options: Any
) -> Solver:
    solver = Solver(str(source), Case.of({"units": units}), results, **options)
    solver.write(str(target))
    return solver


def test_every_format_has_the_same_numbers(tmp_path: Path) -> None:
    source = write(tmp_path / "in.csv", csv_text(SAMPLES))
    solve_table(source, tmp_path / "out.csv")
    results = columns_of(tmp_path / "out.csv")
    assert results["DA"] == [sample["DA"] for sample in SAMPLES]
    for at, sample in enumerate(SAMPLES):
        reference = solve({n: float(t) for n, t in sample.items()}, ["VAX", "LOSS"])
        assert (float(results["VAX"][at]), float(results["LOSS"][at])) == (*reference.values(),)
    for kind in FORMATS[1:]:
        path = tmp_path / f"out.{kind}"
        solve_table(source, path)
        copy = tmp_path / f"again_{kind}.csv"
        solve_table(path, copy, "VAX", "KI")
        solve_table(path, path, "KI", arithmetic="applesoft")
        floats = impact88.replay({n: [s[n] for s in SAMPLES] for n in SCENE}).floats("KI")
        assert columns_of(path)["KI"] == pytest.approx(floats.tolist(), rel=1e-15)
        for name, cells in columns_of(copy).items():
            rtol = 1e-15 if kind == "xlsx" else 0  # 16 digits are written
            assert np.allclose(np.array(cells, float), np.array(results[name], float), rtol, 0)


@pytest.mark.usefixtures("_engine")
def test_csv_has_the_bits_of_floats(tmp_path: Path) -> None:
    values = [1e16, 1.5e-5, 1e-300, 0.0, 22.0, math.nan, -1e22, 5e-324, 0.00012, math.inf]
    texts = ["a", '"', "a,b", "", "=1", "é", "x", "y", "z", ""]
    columns = {"x": np.array(values), "text": texts, "n": np.arange(10, dtype=np.uint16)}
    write_table(str(tmp_path / "out.csv"), [columns, columns])
    rows = read_rows(tmp_path / "out.csv")
    written = [float(row["x"] or "nan") for row in rows]
    assert np.array_equal(written, values * 2, equal_nan=True)
    assert [row["text"] for row in rows] == texts * 2


def test_standard_output_that_takes_a_part_has_it_all(monkeypatch: pytest.MonkeyPatch) -> None:
    class Pipe(io.RawIOBase):
        data = b""

        def writable(self) -> bool:
            return True

        def write(self, data: Any) -> int:
            self.data += bytes(data)[:5]
            return min(len(data), 5)

    pipe = Pipe()
    monkeypatch.setattr("sys.stdout", SimpleNamespace(buffer=pipe, flush=pipe.flush))
    write_table("-", [{"x": list("abcdefghi")}])
    assert pipe.data == b"x\na\nb\nc\nd\ne\nf\ng\nh\ni\n"


@pytest.mark.usefixtures("_engine")
@pytest.mark.parametrize(
    ("layout", "message"),
    [
        ("HEAD ROW ROW,1 ROW", "line 3: has 22 fields; expected 21"),
        ("HEAD ROW ROW SHORT", "line 4: has 20 fields"),
        ("HEAD ROW,1 SHORT ROW", "line 2: has 22 fields"),
        ("MA,MA 1,2", "'MA' twice"),
        ("MA,,MB 1,2,3", "the headings have one that is empty"),
        ("", "has no line of 1 to 10,000 headings"),
        ('HEAD ROW "ROW', "is not CSV"),
        ("MA,MB\rHEAD ROW", "is not CSV"),
        ("HEAD ROW \udcffROW", "line 3: is not UTF-8 text"),
    ],
)
def test_csv_refused(tmp_path: Path, layout: str, message: str) -> None:
    head, row, *_ = csv_text(SAMPLES).splitlines()
    lines = layout.replace("HEAD", head).replace("SHORT", row.rpartition(",")[0])
    path, target = tmp_path / "bad.csv", tmp_path / "out.csv"
    data = lines.replace("ROW", row).replace(" ", "\n")
    path.write_bytes(data.encode(errors="surrogateescape"))
    with pytest.raises(UserError) as error:
        solve_table(path, target)
    assert message in str(error.value)
    assert "bad.csv" in str(error.value)
    assert not target.exists()


@pytest.mark.usefixtures("_engine")
@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_layouts_of_csv(tmp_path: Path, ending: str) -> None:
    plain = csv_text(SAMPLES)
    target = tmp_path / "out.csv"

    def results(data: bytes) -> list[str]:
        (tmp_path / "in.csv").write_bytes(data)
        outcome = solve_table(tmp_path / "in.csv", target, "VAX")
        assert (outcome.rows, outcome.bad) == (3, 0)
        assert float(read_rows(target)[0]["DA"]) == float(SAMPLES[0]["DA"])
        return [row["VAX"] for row in read_rows(target)]

    reference = results(plain.encode())
    european = "\n".join(line.replace(".", "_").replace(",", ";") for line in plain.splitlines())
    european = european.replace("_", ",")
    for text in (plain, plain.rstrip("\n"), european, plain.replace(",", "\t")):
        assert results(text.replace("\n", ending).encode()) == reference
        assert results(b"\xef\xbb\xbf" + text.replace("\n", ending).encode()) == reference
    lines = plain.splitlines()
    (tmp_path / "in.csv").write_text(lines[0])
    assert solve_table(tmp_path / "in.csv", target, arithmetic="applesoft").rows == 0
    gaps = [lines[0], "", lines[1], "," * 20, "", *lines[2:], "," * 20, ""]
    assert results(ending.join(gaps).encode()) == reference
    in_quotes = plain.replace(SAMPLES[0]["DA"], f'"{SAMPLES[0]["DA"]}"')
    assert results(in_quotes.encode()) == reference


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "has no line of 1 to 10,000 headings"),
        ("3\n", "line 1: is '3\\n'; expected a JSON object of numbers and texts"),
        ('{"MA": 1}\n{"MA": \n', "line 2: is '{\"MA\": \\n'; expected a JSON object"),
        ('{"MA": 1}\n{"MB": 1}\n', "line 2: 'MB' is not in the first row"),
        ('{"MA": [1]}\n', "line 1: is '{\"MA\": [1]}\\n'; expected"),
        ("[" * 100_000, "expected a JSON object"),
    ],
)
def test_json_refused(tmp_path: Path, text: str, message: str) -> None:
    path = write(tmp_path / "bad.jsonl", text)
    with pytest.raises(UserError) as error:
        list(read_table(str(path)).blocks)
    assert message in str(error.value)


def test_json_keeps_digits(tmp_path: Path) -> None:
    scene = {**SAMPLES[0], "UX": "-90315.88170"}
    numbers = {n: float(t) for n, t in scene.items() if n != "UX"}
    text = json.dumps({"id": 7, "car": "Infinity", **numbers}).replace("}", ', "UX": -90315.88170}')
    target = tmp_path / "out.jsonl"
    source = write(tmp_path / "in.jsonl", text)
    solve_table(source, target, "KI")
    row = json.loads(target.read_text())
    assert (row["id"], row["car"]) == (7, "Infinity")
    solve_table(source, target, "KI", arithmetic="applesoft")
    row = json.loads(target.read_text())
    reference = impact88.replay({**{n: str(float(t)) for n, t in scene.items()}, "UX": scene["UX"]})
    assert row["KI"] == reference.floats("KI")[0]
    assert row["ERROR"] is None or row["ERROR"] == ""


def test_workbooks(tmp_path: Path) -> None:
    import xlsxwriter

    path = tmp_path / "book.xlsx"
    book = xlsxwriter.Workbook(str(path))
    sheet = book.add_worksheet("scenes")
    sheet.write_row(0, 0, ["Crash tests of 1988"])
    sheet.write_row(3, 0, ["note", "UX [mph]", *(f"{n} " for n in SCENE if n not in ("UX", "M"))])
    sheet.write_row(4, 0, ["first", "25 mph", *[1.1] * 19])
    sheet.write_string(5, 0, "=second")
    sheet.write_row(5, 1, [30.5, *[1.1] * 19])
    book.close()
    target = tmp_path / "out.xlsx"
    outcome = solve_table(path, target, "VAX", units="us")
    assert (outcome.rows, outcome.bad) == (2, 0)
    columns = columns_of(target)
    assert columns["UX [mph]"] == ["25 mph", "30.5"]
    assert columns["note"] == ["first", "=second"]


def test_floats_of_workbooks_keep_their_bits(tmp_path: Path) -> None:
    import zipfile

    source = tmp_path / "short.xlsx"
    write_table(str(source), [{"UX": np.array([0.5, 0.25]), "UY": ["0.125", "3 mph"]}])
    digits = "0.30000000000000004"
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(tmp_path / "long.xlsx", "w") as new:
        for item in old.infolist():
            data = old.read(item)
            new.writestr(item, data.replace(b"<v>0.5</v>", f"<v>{digits}</v>".encode()))
    assert columns_of(tmp_path / "long.xlsx")["UX"] == [float(digits), 0.25]
