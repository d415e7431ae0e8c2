"""Files in every format: the same numbers in and out; what is refused, and what is damaged."""

import csv
import io
import json
import math
import random
import time
import zipfile
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xlsxwriter

import impact88
from impact88.cases import Case
from impact88.errors import UserError
from impact88.mechanics.solve import solve
from impact88.names import SCENE
from impact88.tables import textformats
from impact88.tables.engine import read_table, write_table
from impact88.tables.solving import Solver

ARITHMETICS = ("float64", "applesoft")
SAMPLES = [dict(impact88.sample(number)) for number in (1, 2, 3)]
LINES = [",".join(SAMPLES[0]), *(",".join(sample.values()) for sample in SAMPLES)]
PIECES = [b'"', b"'", b",", b";", b"\n", b"\r", b"\0", b"\xff", b"[" * 90, b"{", b"=", b"9" * 400]
PIECES += [b"1e999999999", b"1e-999999999", b"nan", b"inf", b"..", b"+-", b"\xff\xfe", b"," * 2000]
SCENE_FILE = """units = "us"
MA = "2,000 lb"
MA_source = "x"
IA = "estimate +- 20 %"
DA = "6 ft 6 in"
UX = "normal 30 2 mph"
UY = 3
TA = "course"
SAF = "skid 62 ft at 0.7 +- 0.05"
"""


@pytest.fixture(params=["polars", "csv module"])
def _engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    if request.param == "csv module":
        monkeypatch.setattr(textformats, "find_spec", lambda _: None)


def read_rows(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text("utf-8").splitlines()))


def columns_of(path: Path) -> dict[str, list[Any]]:
    table = read_table(str(path))
    columns: dict[str, list[Any]] = {name: [] for name in table.names}
    for block in table.blocks:
        for cells, column in zip(columns.values(), block.columns, strict=True):
            cells.extend(column.to_list() if hasattr(column, "to_list") else column)
    return columns


def file_of(folder: Path, layout: str) -> Path:
    """Return a file of rows by their names."""
    words = {"HEAD": LINES[0], "ROW": LINES[1], "SHORT": LINES[1].rpartition(",")[0], " ": "\n"}
    words["OBJECT"] = json.dumps(SAMPLES[0], separators=(",", ":"))
    for word, text in words.items():
        layout = layout.replace(word, text)
    path = folder / ("bad.jsonl" if layout.startswith("{") else "bad.csv")
    path.write_bytes(layout.encode(errors="surrogateescape"))
    return path


def solve_table(source, target, *results, units="", **options):
    solver = Solver(str(source), Case.of({"units": units}), results, **options)
    solver.write(str(target))
    return solver


def test_every_format_has_the_same_numbers(tmp_path: Path) -> None:
    source = tmp_path / "in.csv"
    source.write_text("\n".join(LINES))
    solve_table(source, tmp_path / "out.csv")
    results = columns_of(tmp_path / "out.csv")
    assert results["DA"] == [sample["DA"] for sample in SAMPLES]
    for at, sample in enumerate(SAMPLES):
        reference = solve({n: float(t) for n, t in sample.items()}, ["VAX", "LOSS"])
        assert (float(results["VAX"][at]), float(results["LOSS"][at])) == (*reference.values(),)
    for kind in ("jsonl", "parquet", "xlsx"):
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
        ("MA,MA 1,2", "'MA' twice"),
        ("MA,,MB 1,2,3", "the headings have one that is empty"),
        ("", "has no line of 1 to 10,000 headings"),
        ('HEAD ROW "ROW', "is not CSV"),
        ("MA,MB\rHEAD ROW", "is not CSV"),
        ("HEAD ROW \udcffROW", "line 3: is not UTF-8 text"),
        ("{}", "has no line of 1 to 10,000 headings"),
        ("{3 ", "line 1: is '{3\\n'; expected a JSON object of numbers and texts"),
        ('OBJECT {"MA": ', "line 2: is '{\"MA\":\\n'; expected a JSON object"),
        ('{"MA":[1]} ', "line 1: is '{\"MA\":[1]}\\n'; expected"),
        ("{" + "[" * 100_000, "expected a JSON object"),
    ],
)
def test_refused(tmp_path: Path, layout: str, message: str) -> None:
    path = file_of(tmp_path, layout)
    with pytest.raises(UserError) as error:
        solve_table(path, tmp_path / "out.csv")
    assert message in str(error.value)
    assert path.name in str(error.value)
    assert not (tmp_path / "out.csv").exists()


@pytest.mark.usefixtures("_engine")
@pytest.mark.parametrize(
    ("layout", "faults"),
    [
        ("HEAD ROW ROW,1 ROW", {3: "has 22 fields; expected 21, as in the headings"}),
        ("HEAD ROW ROW SHORT", {4: "has 20 fields"}),
        ("HEAD ROW,1 SHORT ROW", {2: "has 22 fields", 3: "has 20 fields"}),
        ('OBJECT {"car":1} OBJECT', {2: "'car' is not in the first row; expected its names"}),
    ],
)
@pytest.mark.parametrize("arithmetic", ARITHMETICS)
def test_rows_of_another_width_are_bad_rows(
    tmp_path: Path, layout: str, faults: dict[int, str], arithmetic: str
) -> None:
    path = file_of(tmp_path, layout)
    solver = solve_table(path, tmp_path / "out.csv", "VAX", arithmetic=arithmetic)
    assert (solver.rows, solver.bad) == (3, len(faults))
    for listed, (line, fault) in zip(solver.listed, faults.items(), strict=True):
        assert listed.startswith(f"{path}, line {line}: {fault}")
    rows = read_rows(tmp_path / "out.csv")
    for line, row in enumerate(rows, 2 - (path.suffix == ".jsonl")):
        assert (row["UX"], row["VAX"]) == ("", "") if line in faults else float(row["VAX"])


@pytest.mark.usefixtures("_engine")
@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_layouts_of_csv(tmp_path: Path, ending: str) -> None:
    plain = "\n".join([*LINES, ""])
    source, target = tmp_path / "in.csv", tmp_path / "out.csv"

    def results(data: bytes) -> list[str]:
        source.write_bytes(data)
        outcome = solve_table(source, target, "VAX")
        assert (outcome.rows, outcome.bad) == (3, 0)
        assert float(read_rows(target)[0]["DA"]) == float(SAMPLES[0]["DA"])
        return [row["VAX"] for row in read_rows(target)]

    reference = results(plain.encode())
    european = plain.replace(",", ";").replace(".", ",")
    for text in (plain, plain.rstrip("\n"), european, plain.replace(",", "\t")):
        assert results(text.replace("\n", ending).encode()) == reference
        assert results(b"\xef\xbb\xbf" + text.replace("\n", ending).encode()) == reference
    source.write_text(LINES[0])
    assert solve_table(source, target, arithmetic="applesoft").rows == 0
    gaps = [LINES[0], "", LINES[1], "," * 20, "", *LINES[2:], "," * 20, ""]
    assert results(ending.join(gaps).encode()) == reference
    in_quotes = plain.replace(SAMPLES[0]["DA"], f'"{SAMPLES[0]["DA"]}"')
    assert results(in_quotes.encode()) == reference


def test_json_keeps_digits(tmp_path: Path) -> None:
    scene = {**SAMPLES[0], "UX": "-90315.88170"}
    numbers = {n: float(t) for n, t in scene.items() if n != "UX"}
    text = json.dumps({"id": 7, "car": "Infinity", **numbers}).replace("}", ', "UX": -90315.88170}')
    source, target = tmp_path / "in.jsonl", tmp_path / "out.jsonl"
    source.write_text(text)
    solve_table(source, target, "KI")
    row = json.loads(target.read_text())
    assert (row["id"], row["car"]) == (7, "Infinity")
    solve_table(source, target, "KI", arithmetic="applesoft")
    row = json.loads(target.read_text())
    reference = impact88.replay({**{n: str(float(t)) for n, t in scene.items()}, "UX": scene["UX"]})
    assert (row["KI"], row["ERROR"]) == (reference.floats("KI")[0], "")


def test_workbooks(tmp_path: Path) -> None:
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
    source = tmp_path / "short.xlsx"
    write_table(str(source), [{"UX": np.array([0.5, 0.25]), "UY": ["0.125", "3 mph"]}])
    digits = "0.30000000000000004"
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(tmp_path / "long.xlsx", "w") as new:
        for item in old.infolist():
            data = old.read(item)
            new.writestr(item, data.replace(b"<v>0.5</v>", f"<v>{digits}</v>".encode()))
    assert columns_of(tmp_path / "long.xlsx")["UX"] == [float(digits), 0.25]


def damage(data: bytes, rng: random.Random) -> bytes:
    for _ in range(rng.choice((1, 2, 5))):
        at, to = sorted(rng.randrange(len(data) + 1) for _ in range(2))
        piece = rng.choice((rng.choice(PIECES), data[at:to], rng.randbytes(1)))
        data = data[:at] + piece + data[at + rng.choice((0, 1, 40)) :]
    return data


@pytest.mark.parametrize("kind", ["toml", "csv", "jsonl", "xlsx", "parquet"])
def test_damaged_files_end_in_a_result_or_in_one_line(tmp_path: Path, kind: str) -> None:
    rng, path, target = random.Random(kind), tmp_path / f"file.{kind}", tmp_path / "out.csv"
    if kind == "toml":
        path.write_text(SCENE_FILE)
    else:
        scene = impact88.sample(1).numbers()
        write_table(str(path), [{name: np.full(9, number) for name, number in scene.items()}])
    data = path.read_bytes()
    for _ in range(10):
        path.write_bytes(damage(data, rng))
        start, message, arithmetic = time.process_time(), path.name, rng.choice(ARITHMETICS)
        try:
            if kind == "toml":
                Case.load(str(path))
            else:
                solve_table(path, target, arithmetic=arithmetic)
        except UserError as error:
            message = str(error)
        assert path.name in message
        assert "\n" not in message
        assert time.process_time() - start < 2
