"""Conformance to the kit: nothing that is missing, changed or too much passes."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import math
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import jsonschema
import pytest
from installed import impact88
from longer import long_but

from impact88.conformance.comparison.conformance import Conformance, check_conformance
from impact88.conformance.comparison.kit import write_kit
from impact88.conformance.comparison.vectors import REFUSE
from impact88.errors import UserError
from impact88.messages import schemas
from impact88.names import FINAL_VELOCITIES

COUNT = 96
Table = list[dict[str, str]]


@pytest.fixture(scope="module")
def kit(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("kit") / "kit"
    write_kit(str(folder), COUNT, 1988, False)
    return folder


@pytest.fixture(scope="module")
def answers(kit: Path) -> Table:
    """What the kit's program in Python answers."""
    with (kit / "vectors.csv").open("rb") as file:
        done = subprocess.run(
            [sys.executable, "impact.py"], cwd=kit, stdin=file, capture_output=True, check=True
        )
    return list(csv.DictReader(io.StringIO(done.stdout.decode())))


def written(rows: Table) -> str:
    out = io.StringIO()
    writer = csv.DictWriter(out, list(rows[0]))
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue()


def judged(kit: Path, path: Path, rows: Table) -> Conformance:
    path.write_text(written(rows), encoding="utf-8")
    return check_conformance(str(kit), str(path), "csv")


def of_a_kind(rows: Table, expect: str) -> list[int]:
    return [at for at, row in enumerate(rows) if row["expect"] == expect]


def test_a_correct_program_conforms(kit: Path, answers: Table, tmp_path: Path) -> None:
    done = judged(kit, tmp_path / "theirs.csv", answers)
    assert (done.conforms, done.passed) == (True, COUNT)
    assert done.refused >= len(of_a_kind(answers, REFUSE)) > 0
    digest = hashlib.sha256((tmp_path / "theirs.csv").read_bytes()).hexdigest()
    assert done.sha256 == digest
    assert digest[:12] in done.badge
    few = [{name: row[name] for name in ("id", *FINAL_VELOCITIES)} for row in answers]
    assert judged(kit, tmp_path / "few.csv", few[::-1]).conforms


def two_thirds_deleted(rows: Table) -> Table:
    return rows[::3]


def infinite_from_row_12(rows: Table) -> Table:
    return [*rows[:11], *(row | dict.fromkeys(FINAL_VELOCITIES, "Infinity") for row in rows[11:])]


def empty_from_row_12(rows: Table) -> Table:
    return [*rows[:11], *(row | dict.fromkeys(FINAL_VELOCITIES, "") for row in rows[11:])]


def one_where_there_is_nothing(rows: Table) -> Table:
    return [
        row | dict.fromkeys(FINAL_VELOCITIES, "1") if row["expect"] == REFUSE else row
        for row in rows
    ]


def a_row_twice(rows: Table) -> Table:
    return [*rows, rows[5]]


def an_id_made_up(rows: Table) -> Table:
    return [*rows, {**rows[5], "id": "1988-999999"}]


def an_input_one_bit_off(rows: Table) -> Table:
    return [{**rows[0], "MA": repr(math.nextafter(float(rows[0]["MA"]), 0))}, *rows[1:]]


def a_cell_left_out(rows: Table) -> Table:
    return [{**rows[0], "VBX": ""}, *rows[1:]]


def a_word_for_a_refusal(rows: Table) -> Table:
    at = of_a_kind(rows, REFUSE)[0]
    return [*rows[:at], {**rows[at], "VAX": "impossible"}, *rows[at + 1 :]]


def one_infinity_for_a_refusal(rows: Table) -> Table:
    at = of_a_kind(rows, REFUSE)[0]
    return [*rows[:at], {**rows[at], "VAX": "-inf"}, *rows[at + 1 :]]


def ids_of_other_rows(rows: Table) -> Table:
    return [
        {**row, "id": other["id"]} for row, other in zip(rows, rows[3:] + rows[:3], strict=True)
    ]


def digits_that_say_nothing(rows: Table) -> Table:
    return [{**rows[0], "VAX": "0E9"}, *rows[1:]]


def a_number_off(rows: Table) -> Table:
    return [{**rows[0], "WBF": repr(float(rows[0]["WBF"]) * (1 + 1e-9))}, *rows[1:]]


WRONG: dict[Callable[[Table], Table], str] = {
    two_thirds_deleted: "missing",
    infinite_from_row_12: "no answer",
    empty_from_row_12: "no answer",
    one_where_there_is_nothing: "no solution",
    a_row_twice: "repeated",
    an_id_made_up: "",
    an_input_one_bit_off: "inputs",
    a_cell_left_out: "partial",
    a_word_for_a_refusal: "malformed",
    one_infinity_for_a_refusal: "no solution",
    ids_of_other_rows: "inputs",
    digits_that_say_nothing: "no digit",
    a_number_off: "differs",
}


@pytest.mark.parametrize(
    "change", long_but(WRONG, kept=range(5)), ids=lambda change: change.__name__
)
def test_what_is_wrong_does_not_pass(
    kit: Path, answers: Table, tmp_path: Path, change: Callable[[Table], Table]
) -> None:
    done = judged(kit, tmp_path / "theirs.csv", change(answers))
    assert not done.conforms
    reasons = {verdict.reason for verdict in done.failures}
    assert (WRONG[change] in reasons) if WRONG[change] else done.strays
    assert "does not conform" in done.badge


@pytest.mark.long
def test_every_vector_is_judged_by_itself(kit: Path, answers: Table, tmp_path: Path) -> None:
    """Any one answer changed by 1e-6 of it, left out, or given where none is: that one fails."""
    for at, row in enumerate(answers):
        if row["expect"] == REFUSE:
            changed = {**row, "VAY": "0"}
        elif row["VAX"] and float(row["VAX"]):
            changed = {**row, "VAX": repr(float(row["VAX"]) * (1 + 1e-6))}
        else:
            continue
        if "singular" in row["comment"] or "stale" in row["comment"]:
            continue
        done = judged(kit, tmp_path / "theirs.csv", [*answers[:at], changed, *answers[at + 1 :]])
        assert [verdict.vector.id for verdict in done.failures] == [row["id"]], row["comment"]
        if at > 4:
            break


def test_a_kit_that_was_changed_is_refused(kit: Path, answers: Table, tmp_path: Path) -> None:
    theirs = tmp_path / "theirs.csv"
    theirs.write_text(written(answers), encoding="utf-8")
    names = {path.name: path.read_bytes() for path in kit.iterdir()}
    first = names["vectors.csv"].split(b"\n")[1]
    easier = names["vectors.csv"].replace(first, first.replace(b",6,", b",4,"))
    about = json.loads(names["KIT.json"])
    again = {**about, "sha256": {"vectors.csv": hashlib.sha256(easier).hexdigest()}}
    hostile = {
        "not the file": {"vectors.csv": easier},
        "not the vector": {"vectors.csv": easier, "KIT.json": json.dumps(again).encode()},
        "not a JSON object": {"KIT.json": b"[1]"},
        "this version judges": {"KIT.json": json.dumps({**about, "kit": "vectors/1"}).encode()},
        "no seed": {"KIT.json": json.dumps({**about, "vectors": -1}).encode()},
        "has 96 vectors": {"KIT.json": json.dumps({**about, "vectors": 90}).encode()},
    }
    for number, (says, changed) in enumerate(hostile.items()):
        place = tmp_path / f"{number}.zip"
        with zipfile.ZipFile(place, "w") as archive:
            for name, data in {**names, **changed}.items():
                archive.writestr(name, data)
        with pytest.raises(UserError, match=says):
            check_conformance(str(place), str(theirs), "csv")
    for place in (tmp_path / "nowhere", theirs):
        with pytest.raises(UserError):
            check_conformance(str(place), str(theirs), "csv")


def test_the_command(kit: Path, answers: Table, tmp_path: Path) -> None:
    theirs, junit = tmp_path / "theirs.csv", tmp_path / "junit.xml"
    theirs.write_text(written(a_number_off(answers)), encoding="utf-8")
    done = impact88("compare", "--kit", str(kit), str(theirs), "--junit", str(junit), "--json")
    assert done.returncode == 1, done.stderr
    found = json.loads(done.stdout)
    jsonschema.Draft202012Validator(json.loads(schemas.text("conformance"))).validate(found)
    assert set(found) == set(json.loads(schemas.text("conformance"))["properties"])
    assert (found["passed"], found["failed"]) == (COUNT - 1, 1)
    assert found["failures"][0]["reason"] == "differs"
    suite = ElementTree.parse(junit).getroot()
    assert (suite.get("tests"), suite.get("failures")) == (str(COUNT), "1")
    theirs.write_text(written(answers), encoding="utf-8")
    done = impact88("compare", "--kit", str(kit), "-", input=theirs.read_text(encoding="utf-8"))
    assert done.returncode == 0, done.stdout
    assert done.stdout.splitlines()[-1].startswith("impact88 vectors/2 seed 1988: conforms, 96 of")
    for more in (("--set", "EM=1"), ("--rtol", "1e-9"), ("--units", "us")):
        done = impact88("compare", "--kit", str(kit), str(theirs), *more)
        assert (done.returncode, done.stderr.count("\n")) == (2, 1)


def test_a_table_without_ids_or_velocities_is_refused(
    kit: Path, answers: Table, tmp_path: Path
) -> None:
    for left_out in ("id", "WAF"):
        rows = [{name: row[name] for name in row if name != left_out} for row in answers]
        with pytest.raises(UserError, match=f"no column {left_out}"):
            judged(kit, tmp_path / "theirs.csv", rows)
