"""Kit, oracle, selfcheck, and the tables that are read."""

from __future__ import annotations

import csv
import gzip
import json
import subprocess
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

import impact88
from impact88.apple import captured
from impact88.cases import Case, View
from impact88.comparison import kit, oracle, selfcheck, words
from impact88.comparison.spellings import COMPARED, VELOCITIES
from impact88.tables.solving import Solver

US_ROW = ".1,.5,-.8,7,4,-30,-20,-40,0,60,4600,3100,3700,2000,-20,0,0,10,17,0,6"


def in_thousandths(text: str) -> str:
    return f"{float(text):.3f}" if text else ""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("kit")
    kit.write_kit(str(place))
    return place


@pytest.fixture(scope="module")
def rows(folder: Path) -> list[dict[str, str]]:
    """Return the answers of the starter program in Python."""
    with open(folder / "vectors.csv") as file:
        run = subprocess.run(
            [sys.executable, str(folder / "impact.py")],
            stdin=file,
            capture_output=True,
            text=True,
            check=True,
        )
    return list(csv.DictReader(run.stdout.splitlines()))


class TestKit:
    def test_the_starter_program_passes(self, rows: list[dict[str, str]]) -> None:
        comparison = impact88.compare(rows, kit=kit.FROZEN_ID)
        assert comparison.passed
        assert comparison.kit["passed"] == comparison.kit["vectors"] == 1000

    @pytest.mark.parametrize(
        ("reason", "cheat"),
        [
            (kit.NO_ANSWER, lambda row, _: {**row, **dict.fromkeys(VELOCITIES, "")}),
            (kit.NO_ANSWER, lambda row, _: {**row, **dict.fromkeys(VELOCITIES, "nan")}),
            (kit.NO_NUMBER, lambda row, _: {**row, "VAX": "inf"}),
            (kit.PARTIAL, lambda row, _: {**row, "WBF": ""}),
            (kit.COARSE, lambda row, _: {**row, **dict.fromkeys(VELOCITIES, "1.5")}),
            (kit.COARSE, lambda row, _: {**row, **{n: in_thousandths(row[n]) for n in VELOCITIES}}),
            (kit.DISAGREES, lambda row, _: {**row, **dict.fromkeys(VELOCITIES, "1.23456")}),
            (kit.DISAGREES, lambda row, rows: {**row, **{n: rows[6][n] for n in VELOCITIES}}),
            (kit.SURPLUS, lambda row, _: {**row, **dict.fromkeys(VELOCITIES, "0")}),
            (kit.CHANGED, lambda row, _: {**row, "E": "0.123"}),
            (kit.MISSING, lambda row, _: {**row, "id": "1988"}),
            (kit.REPEATED, lambda row, rows: {**row, "id": rows[0]["id"]}),
        ],
    )
    def test_cheats_fail_with_their_reason(
        self, rows: list[dict[str, str]], reason: str, cheat: Any
    ) -> None:
        comparison = impact88.compare(
            [cheat(row, rows) for row in rows], kit=kit.FROZEN_ID, causes=False
        )
        assert not comparison.passed
        assert reason in comparison.kit["failed"]
        report = ElementTree.fromstring(words.as_junit(comparison, "kit").partition("\n")[2])
        assert int(report.attrib["failures"]) == 1000 - comparison.kit["passed"]

    def test_other_ids_are_no_kit(self) -> None:
        with pytest.raises(impact88.UserError, match=r"expected its id, 1988\.1"):
            impact88.compare([{"id": "1"}], kit="1988.2")


class TestOracle:
    def test_it_gives_the_frozen_answers(self) -> None:
        vectors = kit.frozen_vectors()[::100]
        answers = impact88.oracle([vector["scene"] for vector in vectors])
        for vector, answer in zip(vectors, answers, strict=True):
            assert answer["printout"] == vector["printout"]
            assert answer["ending"] == vector["ending"]
            for name, frozen in vector["results"].items():
                ours = answer["results"][name]
                assert [ours[k] for k in ("printed", "stored", "decimal", "reference")] == [
                    frozen[k] for k in ("printed", "stored", "decimal", "reference")
                ]
                if frozen["reference"] and ours["double"] is not None:
                    off = abs(ours["double"] - float(frozen["reference"]))
                    assert off <= ours["bound"] or not off

    def test_lines_that_cannot_be_used_are_answered_with_an_error(self) -> None:
        good = json.dumps({"id": 7, "scene": dict(impact88.sample(1))})
        lines = [good, "{", '{"id": "x", "scene": {"MA": "1"}}', "[]"]
        answers = list(oracle.answer_lines(lines, reference=False))
        assert [entry["id"] for entry in answers] == [7, None, "x", None]
        assert ["error" in entry for entry in answers] == [False, True, True, True]
        assert answers[2]["error"]["line"] == 3

    @pytest.mark.parametrize("scene", [{"MA": "1"}, {**impact88.sample(1), "M": "5"}, 3])
    def test_an_unusable_scene_is_refused(self, scene: Any) -> None:
        with pytest.raises(impact88.UserError):
            impact88.oracle(scene, False)


class TestSelfcheck:
    @pytest.fixture
    def captures(self, tmp_path: Path) -> Path:
        """A tenth of a per cent of the captures, and an altered scene."""
        golden = captured.golden()
        scenes = captured.rows(golden, captured.SCENES)[:3]
        scenes[1]["printout"] = scenes[1]["printout"].replace("9", "8", 1)
        with gzip.open(tmp_path / "scenes.jsonl.gz", "wt") as file:
            file.writelines(json.dumps(row) + "\n" for row in scenes)
        return tmp_path

    def test_an_altered_capture_fails(self, captures: Path) -> None:
        checks = {check.name: check for check in selfcheck.checks(captures)}
        assert (checks["port"].right, checks["port"].total) == (2, 3)
        assert (checks["replay"].right, checks["replay"].total) == (2, 3)
        assert not checks["emulator"].passed
        assert "FAIL" in selfcheck.as_text(list(checks.values()))
        assert not selfcheck.record(list(checks.values()))["passed"]

    @pytest.mark.long
    def test_all_captures_come_out(self) -> None:
        assert selfcheck.record(list(selfcheck.checks()))["passed"]


class TestTables:
    @pytest.mark.parametrize(
        ("name", "text", "words_in_message"),
        [
            ("a.csv", "MA,VAX\n1\n", "line 2"),
            ("a.csv", "MA,MA\n1,2\n", "twice"),
            ("a.csv", "MA,ma\n1,2\n", "two columns of MA"),
            ("a.csv", "MA,VAX\n1,2\n", "missing"),
            ("a.csv", "MA\n", "no rows"),
            ("a.csv", "MA,VAX [kg]\n1,2\n", "kg is not a unit of length/time"),
            ("a.csv", "MA,VAX [mph]\n1,2\n", "VAX is in mph"),
            ("a.md", "", r"a\.md: expected a table in \.csv"),
            ("a.csv", 'M,MA,VAX\n6,"1,810",2\n', "row 1: MA = '1,810' is not a number"),
        ],
    )
    def test_unusable_files_are_named(
        self, tmp_path: Path, name: str, text: str, words_in_message: str
    ) -> None:
        (tmp_path / name).write_text(text)
        with pytest.raises(impact88.UserError, match=words_in_message):
            impact88.compare(str(tmp_path / name))

    def test_files_and_columns_are_one_table(self, tmp_path: Path) -> None:
        scene = dict(impact88.sample(1))
        row = {**scene, "VAX": "-13.263"}
        (tmp_path / "a.csv").write_text(f"{','.join(row)}\n{','.join(row.values())}\n")
        tables: list[Any] = [tmp_path / "a.csv", str(tmp_path / "a.csv"), row, [row]]
        assert all(impact88.compare(table).passed for table in tables)
        assert impact88.compare({"VAX": ["-13.263"]}, values=scene).passed

    @pytest.mark.parametrize("digit", ["3", "4"])
    @pytest.mark.parametrize("heading", ["VAX", "vax", "Vax [ft/s]", "VAX[FT/S]"])
    def test_headings_are_read_as_solve_reads_them(self, heading: str, digit: str) -> None:
        row = {**impact88.sample(1), heading: f"-13.26{digit}"}
        comparison = impact88.compare(row, units="chapter", causes=False)
        assert comparison.passed == (digit == "3")
        assert comparison.results == ("VAX",)

    @pytest.mark.parametrize(("number", "passed"), [("-9.0427", True), ("-9.0437", False)])
    def test_a_heading_with_a_unit_converts_its_column(self, number: str, passed: bool) -> None:
        row = {**impact88.sample(1), "VAX [mph]": number}
        comparison = impact88.compare(row, units="chapter", causes=False)
        assert comparison.passed == passed
        assert [item.theirs for item in comparison.disagreements] == [number] * (not passed)
        if not passed:
            assert comparison.disagreements[0].ours == pytest.approx(-9.04272, abs=1e-5)

    def test_what_solve_writes_passes_and_is_compared(self, tmp_path: Path) -> None:
        (tmp_path / "a.csv").write_text(f"{','.join(impact88.names.SCENE)}\n{US_ROW}\n")
        case = Case.of({}, view=View("us"))
        for name in ("b.csv", "b.jsonl"):
            Solver(str(tmp_path / "a.csv"), case).write(str(tmp_path / name))
            comparison = impact88.compare(tmp_path / name, units="us")
            assert comparison.passed
            assert comparison.results == COMPARED
            assert comparison.notes == ("columns not compared: COND STATUS",)

    def test_columns_that_are_not_compared_are_named(self) -> None:
        row = {**impact88.sample(1), "VAX": "-13.263"}
        assert impact88.compare({**row, "id": 1}).notes == ()
        comparison = impact88.compare({**row, "VAXX": 1, "VAX1 [mph]": 2})
        assert comparison.notes == ("columns not compared: VAXX VAX1 [mph]",)
        assert "results compared: VAX\n" in str(comparison)

    @pytest.mark.parametrize("column", [{}, {"VAXX": 1}, {"STATUS": 0}])
    def test_results_of_the_table_are_needed(self, column: Any) -> None:
        with pytest.raises(impact88.UserError, match="no results"):
            impact88.compare({**impact88.sample(1), **column})

    def test_a_value_that_the_table_has_is_not_set(self) -> None:
        scene = dict(impact88.sample(1))
        row = {**scene, "VAX": "-13.263"}
        for name in ("MU", "M"):
            with pytest.raises(impact88.UserError, match=f"{name} is set, and in the table"):
                impact88.compare({**row, "M": 6}, values={name: scene.get(name, "6")})
        friction = row.pop("MU")
        assert impact88.compare(row, values={"MU": friction}).passed
        assert not impact88.compare(row, values={"MU": ".5"}, causes=False).passed
        with pytest.raises(impact88.UserError, match="MU is set"):
            impact88.compare(row, values={"MU": ".5"}, kit=kit.FROZEN_ID)

    def test_values_are_in_the_units_of_the_headings(self) -> None:
        row = {**impact88.sample(1), "VAX": "-13.263"}
        mass = float(row.pop("MA")) * 32.17404856
        for values in ({"MA": f"{mass} lb"}, {"MA": "143.5 slug"}):
            assert impact88.compare(row, values=values, units="chapter").passed
        assert not impact88.compare(row, values={"MA": mass}, units="chapter", causes=False).passed

    def test_semicolons_and_decimal_commas_are_read(self, tmp_path: Path) -> None:
        row = {**impact88.sample(1), "VAX": "-13.263"}
        text = "\n".join(";".join(cells) for cells in (row, row.values())).replace(".", ",")
        (tmp_path / "a.csv").write_text(text)
        assert impact88.compare(tmp_path / "a.csv").passed
        (tmp_path / "a.csv").write_text(text.replace("-13,263", "-13,264"))
        assert not impact88.compare(tmp_path / "a.csv", causes=False).passed

    @pytest.mark.parametrize("cell", ["", "n/a", "-13,263"])
    def test_the_first_missing_result_is_named(self, cell: str) -> None:
        row = {**impact88.sample(1), "VAX": "-13.263", "LOSS": "57.47"}
        comparison = impact88.compare([row, {**row, "VAX": cell}, {**row, "VAX": ""}])
        assert comparison.notes == (
            "rows that lack a result where there is one: 2",
            f"the first of them is row 2: VAX = {cell!r}; expected a number",
        )
        assert not comparison.passed
        assert not impact88.compare([row, row]).notes

    def test_a_comparison_is_text_and_json(self) -> None:
        comparison = impact88.compare({**impact88.sample(1), "VAX": "-13.2", "KI": "1"})
        first = "NOT PASSED: rows 1, agreeing 0, disagreeing 1, without numbers to compare 0\n"
        assert str(comparison).startswith(first)
        fields = words.as_json(comparison)
        assert fields["disagreements"][0]["theirs"] == "-13.2"
