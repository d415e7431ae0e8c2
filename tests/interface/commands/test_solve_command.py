"""impact88 solve, from file to file."""

from __future__ import annotations

import csv
import json
import tracemalloc

import numpy as np
import pytest
from installed import impact88

from impact88 import replay, solve
from impact88.collision.casescene import sample
from impact88.interface.commands.cli import main
from impact88.bench.populations import scenes, texts
from impact88.names import RESULTS, SCENE
from impact88.tables import csvtable

NAMES = list(SCENE)


@pytest.fixture
def cases(tmp_path):
    """Twelve scenes as CSV, one of them a point mass; an id before and a note after."""
    columns = texts(scenes("casework", 12, 6))
    columns["M"][3] = "4"
    rows = [[f"c{i}", *(columns[n][i] for n in NAMES), "a, b"] for i in range(12)]
    path = tmp_path / "cases.csv"
    with path.open("w", newline="") as file:
        csv.writer(file).writerows([["id", *NAMES, "note"], *rows])
    return path


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def edit(path, row, **cells):
    rows = table(path)
    rows[row].update(cells)
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)


def expected(path):
    rows = table(path)
    return solve({n: np.array([float(row[n]) for row in rows]) for n in NAMES})


def test_results_are_those_of_solve_and_read_back_exactly(cases, tmp_path):
    out = tmp_path / "r.csv"
    assert main(["solve", str(cases), "-o", str(out)]) == 0
    rows = table(out)
    assert list(rows[0]) == ["id", *NAMES, "note", *RESULTS]
    assert [row["id"] for row in rows] == [f"c{i}" for i in range(12)]
    assert rows[0]["note"] == "a, b"
    found = expected(cases)
    for name in RESULTS:
        assert [float(row[name]) for row in rows] == found[name].tolist(), name
    assert [row["MA"] for row in rows] == [row["MA"] for row in table(cases)]  # as typed


def test_outputs_and_results_only(cases, tmp_path):
    out = tmp_path / "r.csv"
    asked = ["solve", str(cases), "-o", str(out), "--outputs", "WBF,LOSS", "--results-only"]
    assert main(asked) == 0
    assert list(table(out)[0]) == ["id", "note", "WBF", "LOSS"]


def test_other_formats_give_the_same(cases, tmp_path):
    for form in ("jsonl", "npz"):
        assert main(["solve", str(cases), "-o", str(tmp_path / f"r.{form}")]) == 0
    found = expected(cases)
    rows = [json.loads(line) for line in (tmp_path / "r.jsonl").read_text().splitlines()]
    arrays = np.load(tmp_path / "r.npz")
    for name in RESULTS:
        assert [row[name] for row in rows] == found[name].tolist()
        assert arrays[name].tolist() == found[name].tolist()
    assert arrays["id"].tolist() == [f"c{i}" for i in range(12)]
    for form in ("jsonl", "npz"):  # and from them
        out = tmp_path / f"again-{form}.csv"
        assert main(["solve", str(tmp_path / f"r.{form}"), "-o", str(out)]) == 0
        assert [float(row["VAX"]) for row in table(out)] == found["VAX"].tolist()


class TestBadRows:
    @pytest.fixture
    def spoiled(self, cases):
        edit(cases, 1, MA="heavy")
        edit(cases, 4, IB="")
        edit(cases, 5, M="5")
        edit(cases, 7, MB="inf", IB="inf")
        edit(cases, 9, GA="nan")
        return cases

    BAD = (1, 4, 5, 7, 9)

    def test_are_told_and_the_others_solved(self, spoiled, cases, tmp_path, capsys):
        out = tmp_path / "r.csv"
        assert main(["solve", str(spoiled), "-o", str(out), "--outputs", "VAX,STATUS"]) == 1
        told = capsys.readouterr().err
        assert "row 2 (line 3), MA: 'heavy' is not a number" in told
        assert "row 5 (line 6), IB: is empty; expected a number" in told
        assert "row 6 (line 7), M: 5.0 is neither 4 nor 6" in told
        assert "row 8 (line 9), VX:" in told
        assert "a barrier is at rest" in told
        assert "row 10 (line 11), GA: 'nan' is not a number" in told
        complaints = [line for line in told.splitlines() if "in one convention?" not in line]
        assert len(complaints) == 5
        rows = table(out)
        assert len(rows) == 12
        for i, row in enumerate(rows):
            assert (row["VAX"] == "nan") == (i in self.BAD)
            assert (row["STATUS"] == "64") == (i in self.BAD)

    def test_error_file(self, spoiled, tmp_path, capsys):
        errors = tmp_path / "bad.csv"
        out = tmp_path / "r.csv"
        assert main(["solve", str(spoiled), "-o", str(out), "--errors", str(errors)]) == 1
        rows = table(errors)
        assert list(rows[0]) == ["row", "line", "column", "reason"]
        assert [row["row"] for row in rows] == [str(i + 1) for i in self.BAD]
        assert [row["column"] for row in rows] == ["MA", "IB", "M", "VX", "GA"]
        assert "5 rows could not be solved" in capsys.readouterr().err

    def test_without_bad_rows_the_error_file_has_a_header_only(self, cases, tmp_path):
        errors, out = tmp_path / "bad.csv", tmp_path / "r.csv"
        assert main(["solve", str(cases), "-o", str(out), "--errors", str(errors)]) == 0
        assert errors.read_text() == "row,line,column,reason\n"


class TestApplesoft:
    def test_is_replay_on_the_texts(self, cases, tmp_path):
        edit(cases, 2, MA="90315.8817")
        edit(cases, 6, UX="0", UY="0", VX="0", VY="0", WA="0", WB="0")
        edit(cases, 8, MA="0")
        out = tmp_path / "r.csv"
        asked = ["solve", str(cases), "-o", str(out), "--arithmetic", "applesoft"]
        assert main(asked) == 1  # a division by zero
        rows, typed = table(out), table(cases)
        found = replay({name: [row[name] for row in typed] for name in NAMES})
        for name in ("VAX", "WBF", "LOSS", "KI", "XAF"):
            told = [float(row[name]) for row in rows]
            np.testing.assert_array_equal(told, found.floats(name))
        assert rows[6]["ERROR"] == "?DIVISION BY ZERO ERROR IN 690"
        assert rows[6]["LINE"] == "690"
        assert rows[8]["ERROR"] == "ZERO DETERMINANT"
        assert rows[0]["ERROR"] == ""
        assert rows[0]["LINE"] == "0"

    def test_zero_determinant_is_a_normal_end(self, cases, tmp_path):
        edit(cases, 8, MA="0")
        asked = ["solve", str(cases), "-o", str(tmp_path / "r.csv"), "--arithmetic", "applesoft"]
        assert main(asked) == 0

    def test_bad_rows(self, cases, tmp_path, capsys):
        edit(cases, 1, MA="heavy")
        edit(cases, 2, GA="inf")
        out = tmp_path / "r.csv"
        asked = ["solve", str(cases), "-o", str(out), "--arithmetic", "applesoft"]
        assert main([*asked, "--outputs", "VAX"]) == 1
        told = capsys.readouterr().err
        assert "row 2 (line 3), MA:" in told
        assert "row 3 (line 4), GA:" in told
        assert [row["VAX"] == "nan" for row in table(out)][:4] == [False, True, True, False]

    def test_knows_only_what_the_listing_computes(self, cases, tmp_path, capsys):
        asked = ["solve", str(cases), "-o", "x.csv", "--arithmetic", "applesoft"]
        assert main([*asked, "--outputs", "COND"]) == 2
        assert "'COND' is not a result of --arithmetic applesoft" in capsys.readouterr().err


def test_set_gives_a_value_for_all_rows(cases, tmp_path):
    out = tmp_path / "r.csv"
    assert main(["solve", str(cases), "-o", str(out), "--set", "MU=-10", "--set", "M=6"]) == 0
    assert {row["MUP"] for row in table(out)} == {"-10.0"}
    few = tmp_path / "few.csv"
    few.write_text("E,MU,GA,MA,MB,UX,UY,WA,VX,VY,WB\n.1,.5,0,100,90,-30,0,1,0,20,0\n")
    assert main(["solve", str(few), "-o", str(out), "--set", "M=4", "--outputs", "WAF"]) == 0
    assert table(out)[0]["WAF"] == "1.0"


def test_a_table_without_rows_gives_one_without_rows(cases, tmp_path):
    empty, out = tmp_path / "empty.csv", tmp_path / "r.csv"
    empty.write_text(cases.read_text().splitlines()[0] + "\n")
    assert main(["solve", str(empty), "-o", str(out), "--outputs", "VAX"]) == 0
    assert out.read_text().splitlines() == [",".join(["id", *NAMES, "note", "VAX"])]


def test_standard_input_and_output(cases):
    text = cases.read_text(encoding="utf-8")
    done = impact88("solve", "-", "--outputs", "KI", "--results-only", input=text)
    assert done.returncode == 0
    out = done.stdout.splitlines()
    assert out[0] == "id,note,KI"
    assert float(out[1].rpartition(",")[2]) == expected(cases)["KI"][0]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["none.csv", "-o", "r.csv"], "none.csv: cannot be read"),
        (["cases.xls", "-o", "r.csv"], "unknown format"),
        (["{cases}", "-o", "r.csv", "--outputs", "VAX,SPEED"], "'SPEED' is not a result"),
        (["{cases}", "-o", "r.csv", "--set", "MX=1"], "--set: 'MX' is not a name used here"),
        (["{cases}", "-o", "r.csv", "--set", "MU=x"], "'x' is not a number"),
        (["{cases}", "-o", "nowhere/r.csv"], "cannot be written"),
        (["{few}", "-o", "r.csv"], "no column MU EM"),
        (["{cases}", "-o", "r.csv", "--sweep", "MU=0:1:3"], "--sweep is for one scene"),
        (["a.toml", "-o", "r.csv", "--scene", "b.toml"], "--scene fills a table's columns"),
    ],
)
def test_unusable(cases, tmp_path, monkeypatch, capsys, arguments, told):
    monkeypatch.chdir(tmp_path)
    few = tmp_path / "few.csv"
    few.write_text("E\n1\n")
    filled = [a.replace("{cases}", str(cases)).replace("{few}", str(few)) for a in arguments]
    assert main(["solve", *filled]) == 2
    err = capsys.readouterr().err
    assert told in err
    assert err.count("\n") == 1
    assert not (tmp_path / "r.csv").exists()


@pytest.mark.long
def test_memory_does_not_grow_with_the_file(cases, tmp_path, monkeypatch):
    monkeypatch.setattr(csvtable, "BLOCK_ROWS", 500)
    monkeypatch.setattr(csvtable, "BLOCK_BYTES", 50_000)
    lines = cases.read_text().splitlines(keepends=True)
    peaks = []
    for rows in (200, 3_000, 12_000):  # the first only to have everything imported
        big = tmp_path / "big.csv"
        with big.open("w") as file:
            file.write(lines[0])
            file.writelines(lines[1 + i % 12] for i in range(rows))
        tracemalloc.start()
        try:
            main(["solve", str(big), "-o", str(tmp_path / "r.csv"), "--outputs", "VAX"])
            peaks.append(tracemalloc.get_traced_memory()[1])
        finally:
            tracemalloc.stop()
    # four times the rows: how many blocks are under way at once differs from run to run
    assert peaks[2] < 2 * peaks[1]


class TestSweep:
    def rows(self, capsys, *arguments):
        assert main(["solve", *arguments]) == 0
        rows = csv.DictReader(capsys.readouterr().out.splitlines())
        # a heading is a name and its unit
        return [{heading.split(" ")[0]: cell for heading, cell in row.items()} for row in rows]

    def test_each_row_is_what_the_scene_gives_with_that_value(self, tmp_path, capsys):
        path = tmp_path / "crash.toml"
        path.write_text(sample(1).to_toml(), encoding="utf-8")
        options = ["--sweep", "MU=0:1:3", "--sweep", "GA=-35:-25:2", "--outputs", "DVA,LOSS"]
        rows = self.rows(capsys, str(path), *options)
        assert [(r["MU"], r["GA"]) for r in rows][:3] == [
            ("0", "-35"),
            ("0", "-25"),
            ("0.5", "-35"),
        ]
        assert len(rows) == 6
        for row in rows:
            changed = sample(1).replaced({"MU": row["MU"], "GA": row["GA"]})
            alone = solve({n: float(t) for n, t in changed.items()}, ("DVA", "LOSS"))
            assert float(row["DVA"]) == alone["DVA"]
            assert float(row["LOSS"]) == alone["LOSS"]

    def test_a_scene_file_is_a_table_of_one_row(self, tmp_path, capsys):
        path = tmp_path / "crash.toml"
        path.write_text(sample(1).to_toml(), encoding="utf-8")
        (row,) = self.rows(capsys, str(path), "--outputs", "LOSS", "--results-only")
        assert float(row["LOSS"]) == solve({n: float(t) for n, t in sample(1).items()})["LOSS"]

    @pytest.mark.parametrize(
        ("setting", "message"),
        [
            ("MU=0:1", "not LOW:HIGH:COUNT"),
            ("MU=0:1:0", "out of range"),
            ("MU=0:x:3", "is not an amount"),
            ("FOO=0:1:3", "'FOO' is not a value of a scene"),
            ("MU=0:1:100000000", "out of range"),
        ],
    )
    def test_refuses_in_one_line(self, setting, message, tmp_path, capsys):
        path = tmp_path / "crash.toml"
        path.write_text(sample(1).to_toml(), encoding="utf-8")
        assert main(["solve", str(path), "--sweep", setting]) == 2
        err = capsys.readouterr().err
        assert message in err
        assert err.count("\n") == 1
