"""Tables as people have them: headings in small letters and with units, arrays and nested objects
of JSON, workbooks with titles and several sheets, thousands with commas, .npz in blocks, frames.
Each is read as the plain table is, and what could be read in two ways is asked about."""

from __future__ import annotations

import csv
import io
import json

import numpy as np
import pytest

import impact88
from impact88.conformance.comparison.compare import compare as compare_tables
from impact88.errors import UserError
from impact88.interface.commands.cli import main
from impact88.names import SCENE
from impact88.tables import jsontable
from impact88.tables.rows import BLOCK_ROWS
from impact88.tables.table import open_reader

RESULTS = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF", "LOSS")
INPUTS = [dict(impact88.sample(number).numbers()) for number in (1, 2, 3)]
ROWS = [
    scene | {name: float(value) for name, value in impact88.solve(scene, RESULTS).items()}
    for scene in INPUTS
]
NAMES = list(ROWS[0])
COLUMNS = {name: [row[name] for row in ROWS] for name in NAMES}


def csv_text(rows, headings=tuple(NAMES)):
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(headings)
    writer.writerows([row[name] for name in NAMES] for row in rows)
    return out.getvalue()


def put(path, content):
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    return path


def agreeing(table, **options):
    found = compare_tables(table, **options)
    assert (found.rows, found.agreeing) == (3, 3), found.summary
    return found


def solved(path, capsys, *options):
    """VAX as `solve` writes it of a table's rows, and what it says."""
    status = main(["solve", str(path), "--outputs", "VAX", "--to", "csv", *options])
    out, err = capsys.readouterr()
    return status, [row["VAX"] for row in csv.DictReader(io.StringIO(out))], err


class TestHeadings:
    def test_small_letters_are_taken_with_a_note(self, tmp_path, capsys):
        plain = put(tmp_path / "a.csv", csv_text(ROWS))
        small = put(tmp_path / "b.csv", csv_text(ROWS, [name.lower() for name in NAMES]))
        assert agreeing(plain).remarks == []
        (remark,) = agreeing(small).remarks
        assert "ux" in remark
        assert "read as" in remark
        assert "VAX" in remark
        assert main(["compare", str(small)]) == 0
        assert remark in capsys.readouterr().err
        # where no results are read, a column in small letters may be anything
        (remark,) = solved(small, capsys)[2].splitlines()
        assert " ux " in remark
        assert "VAX" not in remark
        assert solved(plain, capsys)[1] == solved(small, capsys)[1]

    @pytest.mark.parametrize("pair", [("vax", "Vax"), ("ux", "Ux"), ("UX [ft/s]", "ux (ft/s)")])
    def test_two_that_are_one_name_are_refused(self, tmp_path, pair):
        name = pair[0].split()[0].upper()
        headings = [pair[0] if known == name else known for known in NAMES]
        headings[headings.index("LOSS")] = pair[1]
        path = put(tmp_path / "a.csv", csv_text(ROWS, headings))
        with pytest.raises(UserError, match=f"are both {name}; expected one"):
            compare_tables(path)

    @pytest.mark.parametrize("other", ["vax", "VAX [ft/s]", "ux"])
    def test_the_exact_name_is_read_and_the_other_told(self, tmp_path, other):
        headings = [other if name == "LOSS" else name for name in NAMES]
        found = agreeing(put(tmp_path / "a.csv", csv_text(ROWS, headings)))
        assert [remark for remark in found.remarks if f"'{other}' is not read" in remark]
        assert other in found.unknown

    def test_one_unit_beside_headings_without_asks_and_answers(self, tmp_path):
        feet = 3600 / 5280
        rows = [row | {"VAX": row["VAX"] * feet} for row in ROWS]
        headings = ["VAX [mph]" if name == "VAX" else name for name in NAMES]
        path = put(tmp_path / "a.csv", csv_text(rows, headings))
        with pytest.raises(UserError, match=r"such as VAX \[mph\].*--units us .* or chapter"):
            compare_tables(path)
        agreeing(path, units="chapter", rtol=1e-12)
        assert compare_tables(path, units="us", causes=False).differing == 3

    def test_units_in_headings_and_in_cells(self, tmp_path, capsys):
        names = ["VAX [mph]" if n == "VAX" else n for n in NAMES]
        rows = [row | {"VAX": f"{row['VAX']!r} ft/s", "UX": f"{row['UX']!r} ft/s"} for row in ROWS]
        path = put(tmp_path / "a.csv", csv_text(rows, names))
        agreeing(path, units="chapter")
        rows[0]["VAX"] = "3 kg"
        put(path, csv_text(rows, names))
        found = compare_tables(path, units="chapter")
        assert (found.agreeing, [bad.column for bad in found.bad]) == (2, ["VAX"])
        assert main(["compare", str(path), "--units", "chapter"]) == 1
        assert "3 kg" in capsys.readouterr().err


class TestThousands:
    ROW = impact88.sample(1).numbers() | {"IA": 3728.5}

    def of(self, text):
        row = {name: text if name == "IA" else value for name, value in self.ROW.items()}
        vax = float(impact88.solve(self.ROW, ["VAX"])["VAX"])
        return [row | {"VAX": vax}]

    @pytest.mark.parametrize("form", ["csv", "jsonl"])
    def test_what_can_only_be_thousands(self, tmp_path, form, capsys):
        rows = self.of("3,728.5")
        path = tmp_path / f"a.{form}"
        names = list(rows[0])
        out = io.StringIO()
        csv.writer(out).writerows([names, list(rows[0].values())])
        put(path, out.getvalue() if form == "csv" else rows)
        assert compare_tables(path).agreeing == 1
        first = solved(path, capsys)
        assert first[0] == 0
        put(path, path.read_text().replace("3,728.5", "3728.5"))
        assert solved(path, capsys) == first
        applesoft = solved(path, capsys, "--arithmetic", "applesoft")
        put(path, path.read_text().replace("3728.5", "3,728.5"))
        assert solved(path, capsys, "--arithmetic", "applesoft") == applesoft

    @pytest.mark.parametrize("text", ["3,728", "0,728.5", "37,28.5", "3,72", "3,728,5", "3.728,5"])
    def test_what_may_be_a_decimal_comma_is_asked_about(self, text):
        found = compare_tables([*self.of("3,728.5"), *self.of(text)])
        assert (found.agreeing, [(bad.row, bad.column) for bad in found.bad]) == (1, [(2, "IA")])

    def test_results_too(self):
        scene = INPUTS[0]
        ki = float(impact88.solve(scene, ["KI"])["KI"])
        assert compare_tables([scene | {"KI": f"{ki:,.3f}"}]).agreeing == 1
        wrong = [scene | {"KI": f"{ki + 0.01:,.3f}"}]
        assert compare_tables(wrong, causes=False).differing == 1
        table = [scene | {"KI": f"{ki:.3f}"}, scene | {"KI": "100,905"}]
        assert [bad.row for bad in compare_tables(table).bad] == [2]


class TestJson:
    @pytest.mark.parametrize("indent", [None, 1])
    @pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
    def test_an_array_is_its_objects(self, tmp_path, indent, encoding, capsys):
        path = tmp_path / "a.json"
        path.write_bytes(("\n " + json.dumps(ROWS, indent=indent)).encode(encoding))
        agreeing(path)
        array = solved(path, capsys)
        path = put(tmp_path / "a.jsonl", "".join(json.dumps(row) + "\n" for row in ROWS))
        assert solved(path, capsys) == array

    def test_elements_are_told_by_their_lines(self, tmp_path):
        text = '[{"E": 12.25, "note": "a]\\"b"},\n\n {"E": 1e2}, 17, -3.5]'
        with open_reader(str(put(tmp_path / "a.json", text)), "jsonl") as reader:
            (rows,) = reader
        assert rows.columns["E"][:2] == ["12.25", "1e2"]
        assert rows.columns["note"][0] == 'a]"b'
        assert rows.lines == [1, 3, 3, 3]
        assert [place for place, *_ in rows.bad] == [2, 3]

    @pytest.mark.parametrize("beyond", [0, 1])
    def test_a_long_array_is_asked_for_line_by_line(self, tmp_path, monkeypatch, beyond):
        text = json.dumps(ROWS)
        monkeypatch.setattr(jsontable, "LONGEST_ARRAY", len(text) - beyond)
        path = put(tmp_path / "a.json", text)
        if not beyond:
            agreeing(path)
            return
        with pytest.raises(UserError, match="expected JSON Lines, an object a line"):
            compare_tables(path)

    @pytest.mark.parametrize(
        ("text", "told"),
        [
            ("[", "ends within"),
            ("[{}", "ends within"),
            ("[{},", "ends within"),
            ("[{} {}]", "has '{' where"),
            ("[{},]", "not JSON"),
            ("[{}]\n[{}]", "line 2 has text after"),
            ('[{"E": }]', "not JSON"),
            ("[" + '{"a":' * 200 + "1" + "}" * 200 + "]", "no column"),
            ("[" * 9000, "line 1"),
            ("[" + "1" * 1_100_000, "longer than"),
            ('["' + "a" * 1_100_000, "line 1 is not JSON: Unterminated string"),
            ('["' + "a" * 1_100_000 + '"]', "longer than"),
            ("[" + " \n" * 100_000, "line 100001 ends within"),
            ("[]", "no column"),
        ],
    )
    def test_unusable(self, tmp_path, text, told, capsys):
        path = put(tmp_path / "a.json", text)
        assert main(["solve", str(path)]) == 2
        assert told in capsys.readouterr().err

    def test_an_array_is_written_as_one(self, tmp_path):
        source, path = put(tmp_path / "a.json", ROWS), tmp_path / "b.json"
        assert main(["solve", str(source), "-o", str(path), "--outputs", "VAX"]) == 0
        assert [row["VAX"] for row in json.loads(path.read_text())] == COLUMNS["VAX"]

    def test_objects_inside(self, tmp_path, capsys):
        def nested(row, inputs="inputs", outputs="outputs"):
            scene = {name: row[name] for name in NAMES if name in SCENE}
            results = {name: row[name] for name in RESULTS}
            return {"id": "a", inputs: scene, outputs: results}

        rows = [nested(row) for row in ROWS]
        path = put(tmp_path / "a.jsonl", "\n".join(map(json.dumps, rows)))
        agreeing(path)
        assert solved(path, capsys)[1] == solved(put(tmp_path / "b.json", ROWS), capsys)[1]
        agreeing(put(tmp_path / "c.json", [nested(row, "Scene", "theirs") for row in ROWS]))
        # one of them echoes the inputs; two have results
        echo = [row | {"outputs": {**row["outputs"], "UX": row["inputs"]["UX"]}} for row in rows]
        agreeing(put(path, "\n".join(map(json.dumps, echo))))
        echo[1]["reference"] = echo[1]["outputs"] | {"VAX": 3}
        found = compare_tables(put(path, "\n".join(map(json.dumps, echo))))
        assert (found.agreeing, [bad.row for bad in found.bad]) == (2, [2])
        assert "two values of 'VAX'" in found.bad[0].reason

    def test_the_kits_vectors(self, tmp_path):
        path = tmp_path / "vectors.jsonl"
        assert main(["oracle", "--vectors", "12", "--no-reference", "-o", str(path)]) == 0
        found = compare_tables(path)
        assert found.agreeing > 6
        assert not found.differing


class TestWorkbooks:
    def book(self, path, sheets):
        openpyxl = pytest.importorskip("openpyxl")
        book = openpyxl.Workbook()
        book.remove(book.active)
        for title, rows in sheets.items():
            sheet = book.create_sheet(title)
            for row in rows:
                sheet.append(row)
        book.save(path)
        return path

    TABLE = (NAMES, *([row[name] for name in NAMES] for row in ROWS))

    def test_the_first_row_of_the_first_sheet_needs_no_word(self, tmp_path):
        found = agreeing(self.book(tmp_path / "a.xlsx", {"Rows": self.TABLE}))
        assert found.place == {"sheet": "Rows", "row": 1}
        assert found.remarks == []

    @pytest.mark.parametrize("above", [[], [["Runs, 12 May: E and MU as agreed"], [], ["MU", 3]]])
    @pytest.mark.parametrize("before", [{}, {"Notes": []}, {"Notes": [["E"], [1]]}])
    def test_title_and_sheets_are_told(self, tmp_path, above, before, capsys):
        sheets = {**before, "Rows": [*above, *self.TABLE], "Later": self.TABLE}
        path = self.book(tmp_path / "a.xlsx", sheets)
        found = agreeing(path)
        row = 1 + len(above)
        assert found.place == {"sheet": "Rows", "row": row}
        (remark,) = found.remarks
        assert f"sheet 'Rows' is read, its headings in row {row}" in remark
        assert "'Later'" in remark
        assert ("'Notes'" in remark) == bool(before.get("Notes"))
        assert main(["compare", str(path), "--json"]) == 0
        out, err = capsys.readouterr()
        assert json.loads(out)["table"] == found.place
        assert remark in err
        # rows are named as the sheet has them
        spoiled = [*self.TABLE[:2], ["heavy", *self.TABLE[2][1:]], self.TABLE[3]]
        path = self.book(tmp_path / "b.xlsx", {**before, "Rows": [*above, *spoiled]})
        (bad,) = compare_tables(path).bad
        assert (bad.row, bad.line) == (2, row + 2)
        assert solved(path, capsys)[0] == 1

    def test_formulas_above_the_table_are_no_fault(self, tmp_path):
        rows = [["=1+1"], *self.TABLE]
        rows[2] = [*rows[2][:-1], None]
        path = self.book(tmp_path / "a.xlsx", {"Rows": rows})
        assert compare_tables(path).agreeing == 3

    def test_empty(self, tmp_path):
        path = self.book(tmp_path / "a.xlsx", {"Rows": []})
        with pytest.raises(UserError, match="holds nothing"):
            compare_tables(path)


class TestNpz:
    def test_blocks_hold_the_same(self, tmp_path):
        count = BLOCK_ROWS + 3
        values = np.arange(count) / 7
        texts = np.array([f"{i}" for i in range(count)])
        turned = np.asfortranarray(np.arange(6.0).reshape(2, 3))
        odd = np.zeros(BLOCK_ROWS)  # as long as a block, and no column
        arrays = {"E": values, "MU": texts, "EM": 0.5, "id": texts, "map": turned, "odd": odd}
        for save in (np.savez, np.savez_compressed):
            save(tmp_path / "a.npz", **arrays)
            with open_reader(str(tmp_path / "a.npz"), "npz") as reader:
                blocks = list(reader)
            assert [rows.count for rows in blocks] == [BLOCK_ROWS, 3]
            assert np.array_equal(np.concatenate([b.columns["E"] for b in blocks]), values)
            assert [text for b in blocks for text in b.columns["MU"]] == texts.tolist()
            assert blocks[1].columns["EM"].tolist() == [0.5] * 3
            assert blocks[1].one_per_row("id").tolist() == texts[-3:].tolist()
            assert np.array_equal(blocks[1].columns["map"], turned)
            with pytest.raises(UserError, match="not a column"):
                blocks[0].one_per_row("odd")

    def test_whole_arrays_are_written_as_they_are(self, tmp_path):
        count = BLOCK_ROWS + 3
        scene = {name: np.full(count, value) for name, value in INPUTS[0].items()}
        beside = {"map": np.arange(6.0).reshape(2, 3), "note": np.array(["all"])}
        np.savez(tmp_path / "a.npz", **scene, **beside)
        asked = ["solve", str(tmp_path / "a.npz"), "--outputs", "VAX"]
        assert main([*asked, "-o", str(tmp_path / "b.npz")]) == 0
        found = np.load(tmp_path / "b.npz")
        assert found["VAX"].shape == found["UX"].shape == (count,)
        assert np.array_equal(found["map"], beside["map"])
        assert found["note"].tolist() == ["all"]

    def test_damage_within_is_told(self, tmp_path, capsys):
        path = tmp_path / "a.npz"
        np.savez(path, **{name: np.full(4000, value) for name, value in ROWS[0].items()})
        data = bytearray(path.read_bytes())
        data[20000] ^= 1
        path.write_bytes(data)
        assert main(["compare", str(path)]) == 2
        assert "CRC" in capsys.readouterr().err


class TestFrames:
    @pytest.mark.parametrize("kind", ["dict", "dicts", "pandas", "polars", "pyarrow", "structured"])
    def test_each_kind(self, kind):
        if kind == "dict":
            frame = COLUMNS
        elif kind == "dicts":
            frame = ROWS
        elif kind == "structured":
            frame = np.array([tuple(row.values()) for row in ROWS], [(n, float) for n in NAMES])
        else:
            library = pytest.importorskip(kind)
            pytest.importorskip("narwhals")
            frame = (library.table if kind == "pyarrow" else library.DataFrame)(COLUMNS)
        assert agreeing(frame).tallies["VAX"].double == 3

    def test_missing_and_wrong_cells(self):
        wrong = [ROWS[0] | {"MA": None}, ROWS[1] | {"M": None}, ROWS[2] | {"VAX": 1.0}]
        found = compare_tables(wrong, causes=False)
        assert (found.agreeing, found.differing) == (1, 1)
        assert [(bad.row, bad.column) for bad in found.bad] == [(1, "MA")]
        missing = [ROWS[0] | {"VAX": float("nan")}, ROWS[1]]
        assert compare_tables(missing).tallies["VAX"].missing == 1

    def test_headings_as_in_files(self):
        assert agreeing({name.lower(): column for name, column in COLUMNS.items()}).remarks
        metric = {"VAX [mph]": [1.0] * 3, **COLUMNS}
        del metric["VAX"]
        with pytest.raises(UserError, match="some columns have units"):
            compare_tables(metric)

    @pytest.mark.parametrize(
        "frame",
        [
            3,
            None,
            [1, 2],
            [],
            {},
            np.zeros(3),
            {"E": [1, 2], "VAX": [1, 2, 3]},
            {"E": np.zeros((2, 2))},
            [{"ux": 1, "Ux": 1}],
        ],
    )
    def test_unusable(self, frame):
        with pytest.raises(UserError):
            compare_tables(frame)

    def test_format_is_a_files(self):
        with pytest.raises(UserError, match="a frame has its own"):
            compare_tables(ROWS, format="csv")
