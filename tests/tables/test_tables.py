"""Tables of scenes: what is read, passed through, written, and what is refused, in all formats."""

from __future__ import annotations

import ast
import csv
import gzip
import inspect
import io
import json
import math
import re
import struct
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from longer import long_but

from impact88.errors import UserError
from impact88.interface.commands.cli import main
from impact88.names import SCENE
from impact88.tables import csvtable, formats
from impact88.tables.cells import TableUnits, check_scene_columns, numbers
from impact88.tables.formats import ENDINGS, FORMATS
from impact88.tables.rows import BLOCK_ROWS, BadCell, shortest
from impact88.tables.table import format_of, open_reader, open_writer

TEXTS = {name: str(i + 0.5) for i, name in enumerate(SCENE)} | {"M": "6"}


def csv_text(rows, names=(*SCENE, "note"), delimiter=","):
    out = io.StringIO()
    writer = csv.writer(out, delimiter=delimiter)
    writer.writerow(names)
    for row in rows:
        writer.writerow([row.get(name, "") for name in names])
    return out.getvalue()


def read(path, form=None):
    with open_reader(str(path), format_of(str(path), form)) as source:
        return source.names, list(source)


def copy(path, out, form, to, results, solved):
    """From one table to another, with results added."""
    with (
        open_reader(str(path), form) as source,
        open_writer(str(out), to, source, results, True) as write,
    ):
        for rows in source:
            write(rows, solved(rows))


@given(st.floats(allow_nan=False))
def test_floats_read_back_to_the_same_bits(value):
    (text,) = shortest(np.array([value]))
    assert struct.pack("<d", float(text)) == struct.pack("<d", value)


@given(st.lists(st.floats(allow_nan=True), min_size=1))
def test_pyarrow_writes_the_same_texts(values):
    array = np.array(values)
    assert csvtable.texts_of(array).to_pylist() == shortest(array)


class TestCsv:
    def test_texts_stay_texts(self, tmp_path):
        path = tmp_path / "a.csv"
        path.write_text(csv_text([{**TEXTS, "MA": "090.50", "note": 'say "x, y"\nand z'}]))
        names, (rows,) = read(path)
        assert names == [*SCENE, "note"]
        assert tuple(rows.columns["MA"]) == ("090.50",)
        assert tuple(rows.columns["note"]) == ('say "x, y"\nand z',)
        assert numbers(rows, TableUnits())["MA"].tolist() == [90.5]

    @pytest.mark.parametrize("delimiter", [",", ";", "\t"])
    @pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
    def test_delimiters_and_encodings(self, tmp_path, delimiter, encoding):
        path = tmp_path / "a.csv"
        text = csv_text([{**TEXTS, "note": "é"}], delimiter=delimiter)
        path.write_bytes(text.encode(encoding))
        _, (rows,) = read(path)
        assert tuple(rows.columns["note"]) == ("é",)
        assert tuple(rows.columns["E"]) == (TEXTS["E"],)

    def test_blocks_rows_and_lines(self, tmp_path):
        path = tmp_path / "a.csv"
        count = BLOCK_ROWS + 3
        lines = csv_text([{**TEXTS, "note": str(i)} for i in range(count)]).splitlines()
        lines.insert(1, "")  # an empty line is no row
        lines[5] = lines[5] + ",more"
        path.write_text("\n".join(lines) + "\n")
        _, blocks = read(path)
        assert [(b.first, b.count) for b in blocks] == [(1, BLOCK_ROWS), (BLOCK_ROWS + 1, 3)]
        assert blocks[0].complaints() == [
            BadCell(4, 6, "", "has 23 fields; expected 22, as in the header")
        ]
        assert blocks[1].columns["note"][-1] == str(count - 1)
        blocks[1].bad.append((0, "E", "x"))
        assert blocks[1].complaints()[0].line == BLOCK_ROWS + 3

    @pytest.mark.parametrize(
        ("text", "told"),
        [
            ("", "is empty"),
            ("E,MU,E\n1,2,3\n", "two columns named 'E'"),
            ('E,MU\n"1,2\n', "line 2"),
        ],
    )
    def test_unusable(self, tmp_path, text, told):
        path = tmp_path / "a.csv"
        path.write_text(text)
        with pytest.raises(UserError, match=told):
            read(path)

    def test_not_text(self, tmp_path):
        path = tmp_path / "a.csv"
        path.write_bytes(b"E,MU\n\xff\xfe\xfa,1\n")
        with pytest.raises(UserError, match="not UTF-8 text"):
            read(path)
        with pytest.raises(UserError, match="cannot be read"):
            read(tmp_path / "none.csv")


class TestJsonLines:
    def test_numbers_keep_their_text(self, tmp_path):
        path = tmp_path / "a.jsonl"
        path.write_text('{"MA": 90.50, "MB": "1E3", "id": 007}\n'.replace("007", "7"))
        names, (rows,) = read(path)
        assert names == ["MA", "MB", "id"]
        assert rows.scene() == {"MA": ["90.50"], "MB": ["1E3"]}

    def test_rows_that_are_no_objects(self, tmp_path):
        path = tmp_path / "a.jsonl"
        path.write_text('{"E": 1}\n\n[1]\n{"E": \n{"E": true, "MU": null}\n')
        _, (rows,) = read(path)
        assert rows.lines == [1, 3, 4, 5]
        assert [(bad.row, bad.line) for bad in rows.complaints()] == [(2, 3), (3, 4)]
        found = numbers(rows, TableUnits())
        assert found["E"].tolist()[0] == 1
        reasons = {(bad.row, bad.column): bad.reason for bad in rows.complaints()}
        assert reasons[4, "E"] == "True is not a number"

    def test_written_rows_are_json_and_pass_everything_through(self, tmp_path):
        path, out = tmp_path / "a.jsonl", tmp_path / "b.jsonl"
        told = {"id": {"deep": [1.50, None, "é"]}, "E": 1.25, "VAX": "old"}
        path.write_text(json.dumps(told) + "\n" + json.dumps({"E": 2, "late": [True]}) + "\n")
        found = {
            "VAX": np.array([0.1, math.nan]),
            "COND": np.array([math.inf, 1.0]),
            "STATUS": np.array([3, 64], np.uint8),
        }
        copy(path, out, "jsonl", "jsonl", list(found), lambda rows: found)
        first, second = (json.loads(line) for line in out.read_text().splitlines())
        assert "1.5" in out.read_text()
        assert first["id"] == told["id"]
        assert (first["VAX"], first["COND"], first["STATUS"]) == (0.1, math.inf, 3)
        assert second["VAX"] is None
        assert second["late"] == [True]


class TestNpz:
    def test_arrays_and_single_values(self, tmp_path):
        path = tmp_path / "a.npz"
        np.savez(path, MA=np.arange(3), MB=2.5, id=np.array(["a", "b", "c"]), E=["1", "x", "3"])
        names, (rows,) = read(path)
        assert names == ["MA", "MB", "id", "E"]
        found = numbers(rows, TableUnits())
        assert found["MB"].tolist() == [2.5] * 3
        assert [(bad.row, bad.column) for bad in rows.complaints()] == [(2, "E")]

    def test_unusable(self, tmp_path):
        path = tmp_path / "a.npz"
        np.savez(path, MA=np.arange(3), MB=np.arange(4))
        with pytest.raises(UserError, match="MA 3, MB 4"):
            read(path)
        np.savez(path, MA=np.zeros((2, 2)))
        with pytest.raises(UserError, match="expected one dimension"):
            read(path)
        np.savez(path, MA=np.array([{}], dtype=object))
        with pytest.raises(UserError, match="numbers or of text"):
            read(path)
        path.write_text("no archive")
        with pytest.raises(UserError, match="plain arrays"):
            read(path)


@pytest.mark.parametrize("rows", long_but([1, 9000]))
def test_pyarrow_is_imported_for_large_tables_alone(tmp_path, rows):
    """It imports pandas, which takes longer than a small table; and the bytes are the same."""
    pytest.importorskip("pyarrow")
    path = tmp_path / "a.csv"
    path.write_text(csv_text([{**TEXTS, "note": f"{i:0500}"} for i in range(rows)]))
    script = (
        "import sys\n"
        "from impact88.interface.commands.cli import main\n"
        "from impact88.tables import csvtable\n"
        "if sys.argv[1] == 'never': csvtable.arrow_available = lambda: False\n"
        "main(['solve', sys.argv[2], '--outputs', 'LOSS,STATUS'])\n"
        "print('pyarrow' in sys.modules, file=sys.stderr)\n"
    )
    usual, never = (
        subprocess.run([sys.executable, "-c", script, when, path], capture_output=True, text=True)
        for when in ("usual", "never")
    )
    assert usual.stderr.split()[-1] == str(rows > 5000)
    assert never.stderr.split()[-1] == "False"
    assert usual.stdout == never.stdout
    assert usual.stdout.count("\n") == rows + 1


def test_nothing_half_written(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(csv_text([TEXTS]))
    out = tmp_path / "b.csv"
    out.write_text("before")
    with pytest.raises(KeyError):
        copy(path, out, "csv", "csv", ["VAX"], lambda rows: {})
    assert out.read_text() == "before"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.csv", "b.csv"]


ODD_TABLES = {
    "plain": csv_text([TEXTS, {**TEXTS, "MA": ".5"}]),
    "no end of line": csv_text([TEXTS, TEXTS]).rstrip("\r\n"),
    "unix": csv_text([TEXTS] * 3).replace("\r\n", "\n"),
    "quoted later": csv_text([TEXTS] * 3 + [{**TEXTS, "note": 'a "b", c\nd'}] + [TEXTS] * 2),
    "all quoted, as pyarrow writes": re.sub(r"[^,\r\n]+", r'"\g<0>"', csv_text([TEXTS] * 3)),
    "lines and quotes in quotes": csv_text(
        [{**TEXTS, "note": note} for note in ('a "b", c\n\nd', '""', ",", "", '"', "x\r\ny")] * 9
    ),
    "a name over two lines": csv_text([TEXTS] * 2, (*SCENE, "no\nte")),
    "an error behind lines in quotes": csv_text([{**TEXTS, "note": "a\nb"}, {**TEXTS, "MA": "x"}]),
    "quotes that quote nothing": csv_text([TEXTS] * 3).replace("\r\n", 'a"b"\r\n'),
    "more behind a quote": csv_text([TEXTS] * 3).replace("6,\r\n", '6,"a"b\r\n'),
    "a quote never closed": csv_text([TEXTS] * 3) + '"',
    "short row": csv_text([TEXTS] * 3) + "1,2\r\n" + csv_text([TEXTS]).partition("\n")[2],
    "blank lines": "\n\n" + csv_text([TEXTS] * 2).replace("\r\n", "\n\n"),
    "old ends of lines": csv_text([TEXTS] * 2).replace("\r\n", "\r"),
    "no numbers": csv_text([{**TEXTS, "MA": "x"}, {**TEXTS, "MA": ""}, {**TEXTS, "M": ""}]),
    "numbers INPUT takes": csv_text([{**TEXTS, "MA": "1 E 2", "E": "+.5"}, {**TEXTS, "E": "-"}]),
    "decimal commas": csv_text([TEXTS] * 2, delimiter=";").replace(".", ","),
    "sep": "sep=;\r\n" + csv_text([TEXTS] * 2, delimiter=";"),
    "units and small letters": csv_text([TEXTS])
    .replace("MA,", "ma [slug],")
    .replace("GA,", "Ga (deg),"),
    "unnamed columns": csv_text([TEXTS]).replace("note\r\n", "note,,\r\n").rstrip() + ",,\r\n",
    "unnamed but filled": csv_text([TEXTS]).replace("note\r\n", "note,\r\n").rstrip() + ",7\r\n",
}


@pytest.mark.parametrize("text", ODD_TABLES.values(), ids=ODD_TABLES)
@pytest.mark.parametrize("block", ["whole", 300])
def test_with_and_without_pyarrow_the_same_bytes(tmp_path, monkeypatch, capsys, text, block):
    path = tmp_path / "a.csv"
    path.write_bytes(text.encode())
    if block == "whole":
        block = max(1, len(text.encode()) - len(text.partition("\n")[0]) - 2)
    said = []
    for there in (True, False):
        monkeypatch.setattr(csvtable, "arrow_available", lambda there=there: there)
        monkeypatch.setattr(csvtable, "BLOCK_BYTES", block)
        status = main(["solve", str(path)])
        said.append((status, *capsys.readouterr()))
    assert said[0] == said[1]
    unusable = {"short row", "no numbers", "unnamed but filled", "a quote never closed"}
    unusable |= {"an error behind lines in quotes", "more behind a quote"}
    names = {text: name for name, text in ODD_TABLES.items()}
    assert (said[0][0] == 0) == (names[text] not in unusable)


def test_every_module_that_reads_and_writes_tables_is_registered():
    registered = {row.module for row in FORMATS.values()}
    for path in sorted(Path(formats.__file__).parent.glob("*.py")):
        tree = ast.parse(path.read_text("utf-8"))
        functions = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
        if {"read", "write"} <= functions and path.stem not in registered:
            pytest.fail(
                f"tables/{path.name} is of no format yet; next step: its row in ROWS of "
                "tables/formats.py"
            )


@pytest.mark.parametrize("form", FORMATS)
def test_every_registered_format_is_complete(form):
    row = FORMATS[form]
    folder = Path(formats.__file__).parent
    assert (folder / f"{row.module}.py").is_file(), (
        f"{form} has a row in ROWS of tables/formats.py and no module; next step: "
        f"tables/{row.module}.py with read and write"
    )
    for name, arguments in CALLS.items():
        function = getattr(row.load(), name, None)
        assert function, f"next step: {name}({arguments}) in tables/{row.module}.py"
        taken = ", ".join(inspect.signature(function).parameters)
        assert taken == arguments, f"next step: tables/{row.module}.py's {name}({arguments})"
    for ending in row.endings:
        assert ending.startswith(".")
        assert ENDINGS[ending] == form, f"{ending} is {ENDINGS[ending]}'s ending, too"


CALLS = {"read": "path, encoding, results", "write": "path, delimiter, headings"}


FORMULAS = [
    "=1+1",
    '=HYPERLINK("http://x")',
    "=cmd|' /C calc'!A0",
    "+1",
    "-1+2",
    "@SUM(A1)",
    "'=1",
    "#N/A",
]


@pytest.mark.parametrize("form", ["csv", "xlsx"])
def test_a_text_that_looks_like_a_formula_stays_a_text(tmp_path, form):
    openpyxl = pytest.importorskip("openpyxl")
    first, there, back = (tmp_path / name for name in ("a.csv", f"b.{form}", "c.csv"))
    first.write_text(csv_text([{**TEXTS, "note": text} for text in FORMULAS]), "utf-8")
    assert main(["solve", str(first), "-o", str(there), "--outputs", "VAX"]) == 0
    if form == "xlsx":
        sheet = openpyxl.load_workbook(there).worksheets[0]
        assert {cell.data_type for row in sheet.iter_rows() for cell in row} <= {"s", "n"}
    assert main(["solve", str(there), "-o", str(back), "--outputs", "VAX"]) == 0
    _, blocks = read(back)
    assert [text for rows in blocks for text in rows.columns["note"]] == FORMULAS


def test_one_table_is_the_same_workbook_on_any_day(tmp_path, monkeypatch):
    pytest.importorskip("openpyxl")
    first = tmp_path / "a.csv"
    first.write_text(csv_text([TEXTS]), "utf-8")
    written = []
    for day in (1, 2):
        # the clocks that openpyxl and zipfile read
        monkeypatch.setattr(time, "localtime", lambda *_, day=day: (2020, 1, day, *[0] * 6))
        monkeypatch.setattr(time, "time", lambda day=day: day * 86_400.0)
        path = tmp_path / f"{day}.xlsx"
        assert main(["solve", str(first), "-o", str(path)]) == 0
        written.append(path.read_bytes())
    assert written[0] == written[1]


def test_parquet_takes_types_as_they_are(tmp_path, capsys):
    pa = pytest.importorskip("pyarrow")
    from decimal import Decimal

    from pyarrow import parquet

    columns = {name: pa.array([float(text)] * 3) for name, text in TEXTS.items()}
    columns["MA"] = pa.array(["1E2", "x", None])
    columns["MB"] = pa.array([100, None, 100], pa.int32())
    columns["M"] = pa.array([6, None, 6])
    columns["IA"] = pa.array([Decimal("123.450")] * 3)
    columns["when"] = pa.array([0, 1, 2], pa.date32())
    parquet.write_table(pa.table(columns), tmp_path / "a.parquet")
    assert main(["solve", str(tmp_path / "a.parquet"), "--to", "csv", "--outputs", "VAX"]) == 1
    out, err = capsys.readouterr()
    rows = list(csv.DictReader(io.StringIO(out)))
    assert [row["when"] for row in rows] == ["1970-01-01", "1970-01-02", "1970-01-03"]
    assert rows[0]["IA"] == "123.450"
    assert rows[0]["VAX"] != "nan"
    assert "row 2, MB: is empty" in err
    assert "row 3, MA: is empty" in err
    parquet.write_table(pa.table({**columns, "MA": [True] * 3}), tmp_path / "b.parquet")
    assert main(["solve", str(tmp_path / "b.parquet"), "--to", "csv"]) == 2
    assert "MA holds bool; expected numbers" in capsys.readouterr().err


@pytest.mark.parametrize("delimiter", [",", ";"])
def test_what_must_be_quoted_is(tmp_path, monkeypatch, delimiter):
    """As the standard library's csv does it, and nothing else."""
    notes = ["a,b", "c;d", 'say "no"', "two\nlines", "\r", "", " ", "'", "plain"]
    monkeypatch.setattr(csvtable, "arrow_available", lambda: False)
    for note in notes:
        source, there = tmp_path / "a.csv", tmp_path / "b.csv"
        text = csv_text([{**TEXTS, "note": note}, {**TEXTS, "note": "x"}], delimiter=delimiter)
        source.write_text(text, newline="")
        assert main(["solve", str(source), "-o", str(there), "--outputs", "STATUS"]) == 0
        with there.open(newline="") as file:
            rows = list(csv.DictReader(file, delimiter=delimiter))
        assert [row["note"] for row in rows] == [note, "x"]
        if "\r" not in note:  # which not every version of csv's writer quotes
            with there.open(newline="") as file:
                again = io.StringIO()
                writer = csv.writer(again, delimiter=delimiter, lineterminator="\n")
                writer.writerows(csv.reader(file, delimiter=delimiter))
            assert again.getvalue() == there.read_bytes().decode()


@pytest.mark.parametrize(("form", "to"), [("csv", "jsonl"), ("jsonl", "jsonl.gz")])
def test_json_lines_have_one_type_a_column(tmp_path, form, to):
    """From the first line to the last, however its numbers are written, for whoever infers it."""
    pandas = pytest.importorskip("pandas")
    polars = pytest.importorskip("polars")
    pyarrow_json = pytest.importorskip("pyarrow.json")
    first = [".5", "1", "1E5", "0", "0.25", "+.75", "-10", "007"]
    cells = [*first, *["1"] * BLOCK_ROWS, "2", "1.5", "much", "", "1E-3"]
    rows = [{"id": "17" if i else "a", "MU": cell} for i, cell in enumerate(cells)]
    source, scene, there = tmp_path / f"a.{form}", tmp_path / "s.toml", tmp_path / f"b.{to}"
    scene.write_text("".join(f'{name} = "{text}"\n' for name, text in TEXTS.items()))
    if form == "csv":
        source.write_text("id,MU\n" + "".join(f"{row['id']},{row['MU']}\n" for row in rows))
    else:
        source.write_text("".join(json.dumps(row) + "\n" for row in rows))
    asked = ["--scene", str(scene), "--outputs", "VAX,STATUS", "--errors", str(tmp_path / "e")]
    assert main(["solve", str(source), "-o", str(there), *asked]) == 1
    data = (gzip.decompress if to.endswith("gz") else bytes)(there.read_bytes())
    told = [json.loads(line) for line in data.splitlines()]
    assert [row["MU"] for row in told[-5:]] == [2, 1.5, None, None, 0.001]
    assert [row["MU"] for row in told[: len(first)]] == list(map(float, first))
    kinds = {name: {type(row[name]) for row in told} - {type(None)} for name in told[0]}
    assert kinds == {"id": {str}, "MU": {float}, "VAX": {float}, "STATUS": {int}}
    arrow_schema = pyarrow_json.read_json(io.BytesIO(data)).schema
    for types in (
        pandas.read_json(io.BytesIO(data), lines=True, dtype=False).dtypes,
        polars.read_ndjson(io.BytesIO(data)).schema,
        {name: arrow_schema.field(name).type for name in arrow_schema.names},
    ):
        kinds = {name: str(types[name]).lower() for name in told[0]}
        assert kinds["id"] in ("object", "str", "string")
        assert kinds["MU"] == kinds["VAX"]
        assert kinds["MU"] in ("float64", "double")
        assert kinds["STATUS"] == "int64"


def test_infinite_mass_goes_into_every_format(tmp_path):
    """A barrier's; the rest of its column are numbers."""
    wall = {"VX": "0", "VY": "0", "WB": "0"}
    rows = [{**TEXTS, **wall, "MB": text, "IB": text} for text in ("inf", "95.8")]
    (tmp_path / "a.csv").write_text(csv_text(rows))
    outputs = ["--outputs", "VAX,STATUS"]
    texts = []
    for form in ("csv", "jsonl", "npz", "parquet"):
        there, back = tmp_path / f"b.{form}", tmp_path / "c.csv"
        assert main(["solve", str(tmp_path / "a.csv"), "-o", str(there), *outputs]) == 0
        assert main(["solve", str(there), "-o", str(back), "--results-only", *outputs]) == 0
        texts.append(back.read_text())
    assert len(set(texts)) == 1


def test_older_excel_is_read_when_told(tmp_path, capsys):
    path = tmp_path / "a.csv"
    path.write_bytes(csv_text([{**TEXTS, "note": "Straße"}]).encode("cp1252"))
    assert main(["solve", str(path)]) == 2
    assert "--encoding cp1252" in capsys.readouterr().err
    assert main(["solve", str(path), "--encoding", "cp1252"]) == 0
    assert "Straße" in capsys.readouterr().out
    assert main(["solve", str(path), "--encoding", "rot13"]) == 2


def test_a_scene_file_fills_the_columns_a_table_lacks(tmp_path, capsys):
    scene = "".join(f'{name} = "{text}"\n' for name, text in TEXTS.items())
    (tmp_path / "s.toml").write_text(f'title = "x"\n{scene}')
    whole, short = tmp_path / "a.csv", tmp_path / "b.csv"
    whole.write_text(csv_text([{**TEXTS, "MU": x, "MA": "70"} for x in ".1 .2".split()]))
    short.write_text("MU\n.1\n.2\n")
    assert main(["solve", str(whole), "--outputs", "VAX,DVA", "--results-only"]) == 0
    expected = [row.split(",")[1:] for row in capsys.readouterr().out.splitlines()]
    more = ["--scene", str(tmp_path / "s.toml"), "--set", "MA=70", "--results-only"]
    assert main(["solve", str(short), "--outputs", "VAX,DVA", *more]) == 0
    assert [row.split(",") for row in capsys.readouterr().out.splitlines()] == expected


def test_formats_are_told_by_name():
    assert format_of("a.CSV", None) == "csv"
    assert format_of("x.ndjson", None) == "jsonl"
    assert format_of("-", None) == "csv"
    assert format_of("a.dat", "npz") == "npz"
    with pytest.raises(UserError, match=r"a\.xls"):
        format_of("a.xls", None)


def test_missing_columns_are_named():
    check_scene_columns(list(SCENE)[:-1])
    with pytest.raises(UserError, match="no column GA PA"):
        check_scene_columns([n for n in SCENE if n not in ("GA", "PA", "M")])


@pytest.mark.parametrize("form", ["parquet", "xlsx", "npz"])
def test_a_damaged_file_is_no_fault_of_ours(tmp_path, monkeypatch, capsys, form):
    """Bytes changed at random: status 0 to 2 and a line that names the file, never a bug."""
    pytest.importorskip("pyarrow")
    first, whole = tmp_path / "a.csv", tmp_path / f"whole.{form}"
    first.write_text(csv_text([{**TEXTS, "note": "é"}] * 5), "utf-8")
    assert main(["solve", str(first), "-o", str(whole), "--outputs", "VAX"]) == 0
    data = whole.read_bytes()
    rng = np.random.default_rng(88)
    path = tmp_path / f"damaged.{form}"
    for case in range(60):
        damaged = bytearray(data)
        for place in rng.integers(0, len(data), (1, 3, 20)[case % 3]):
            damaged[place] = rng.integers(0, 256)
        path.write_bytes(damaged[: rng.integers(1, len(data))] if case % 5 == 0 else damaged)
        capsys.readouterr()
        status = main(["solve", str(path), "--outputs", "VAX", "-o", str(tmp_path / "o.csv")])
        err = capsys.readouterr().err
        assert status in (0, 1, 2), (case, err)
        assert status != 2 or str(path) in err.splitlines()[-1]
