"""The kit for other implementations: what it holds, its programs, and the judge of answers to it:
nothing that is missing, changed or too much passes."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import math
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import jsonschema
import pytest
from installed import impact88

from impact88.conformance.comparison.compare import Comparison, compare
from impact88.conformance.comparison.kit import write_kit
from impact88.conformance.comparison.reasons import (
    CHANGED,
    DISAGREES,
    MISSING,
    NO_DIGIT,
    NO_SCENE,
    NOTHING_THERE,
    PARTIAL,
    REPEATED,
    STRAY,
    UNREADABLE,
)
from impact88.conformance.comparison.vectors import ANSWER, EITHER, REFUSE
from impact88.errors import UserError
from impact88.messages import schemas
from impact88.names import FINAL_VELOCITIES, SCENE

COUNT = 96
Table = list[dict[str, str]]


def answers_of(kit: Path, *command: str) -> str:
    """What a program answers to the kit's vectors."""
    with (kit / "vectors.csv").open("rb") as file:
        done = subprocess.run(command, cwd=kit, stdin=file, capture_output=True, check=True)
    return done.stdout.decode()


@pytest.fixture(scope="module")
def kit(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("kit") / "new"
    assert set(write_kit(str(folder), COUNT)) == {path.name for path in folder.iterdir()}
    return folder


@pytest.fixture(scope="module")
def answers(kit: Path) -> Table:
    """What the kit's program in Python answers."""
    return list(csv.DictReader(io.StringIO(answers_of(kit, sys.executable, "impact.py"))))


def test_the_kit_says_what_it_is(kit: Path) -> None:
    about = json.loads((kit / "KIT.json").read_text(encoding="utf-8"))
    assert (about["kit"], about["seed"], about["vectors"]) == ("vectors/2", 1988, COUNT)
    for name, digest in about["sha256"].items():
        assert hashlib.sha256((kit / name).read_bytes()).hexdigest() == digest


def test_both_forms_of_the_vectors_ask_the_same(kit: Path) -> None:
    whole = list(map(json.loads, (kit / "vectors.jsonl").read_text(encoding="utf-8").splitlines()))
    with (kit / "vectors.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(whole) == len(rows) == COUNT
    for one, row in zip(whole, rows, strict=True):
        assert one["scene"] == {name: row[name] for name in SCENE}
        assert (one["id"], one["expect"]) == (row["id"], row["expect"])
        finite = one["results"]["VAX"]["double"] is not None
        assert one["expect"] in ((ANSWER, EITHER) if finite else (REFUSE, ANSWER))
        assert '"' not in row["comment"]
    assert {one["expect"] for one in whole} == {ANSWER, REFUSE, EITHER}
    assert {f"{n} negative" for n in ("MA", "MB", "IA", "IB")} < {one["label"] for one in whole}


def test_one_archive_holds_the_same_bytes(tmp_path: Path) -> None:
    folder, archive = tmp_path / "kit", tmp_path / "kit.zip"
    done = impact88("oracle", "--kit", str(archive), "--vectors", "6", "--seed", "3")
    assert done.stdout.split() == write_kit(str(folder), 6, 3)
    with zipfile.ZipFile(archive) as packed:
        for path in folder.iterdir():
            assert packed.read(path.name) == path.read_bytes(), path.name


def calculated(path: Path) -> list[dict[str, object]]:
    """The first sheet of a workbook, its formulas calculated; None where one refuses."""
    book = pytest.importorskip("openpyxl").load_workbook(path)
    known: dict[tuple[str, str], object] = {}

    def cell(place: str) -> object:
        title, at = place.split("!")
        if (title, at) not in known:
            held = book[title][at].value
            known[title, at] = evaluated(held) if str(held).startswith("=") else held
        return known[title, at]

    def evaluated(formula: str) -> object:
        text = re.sub(r"(?<![<>])=", "==", formula[1:]).replace("^", "**")
        text = re.sub(r"IF\(([^,]*<==0)", lambda found: f"IF({found[1].replace('==', '=')}", text)
        text = re.sub(r"(?:vectors|between)![A-Z]+[0-9]+", lambda m: f'cell("{m[0]}")', text)
        return eval(lazily(text.replace("<==", "<=")), {"cell": cell, **FUNCTIONS})

    heads = [one.value for one in book["vectors"][1]]
    rows = []
    for row in book["vectors"].iter_rows(min_row=2):
        found: dict[str, object] = {}
        for name, one in zip(heads, row, strict=True):
            try:
                found[name] = cell(f"vectors!{one.coordinate}")
            except (ArithmeticError, LookupError):
                found[name] = "#DIV/0!"
        rows.append(found)
    return rows


FUNCTIONS = {
    "SIN": math.sin, "COS": math.cos, "SQRT": math.sqrt, "MIN": min, "PI": lambda: math.pi,
    "NA": lambda: {}["refused"],
    "IF": lambda condition, there, otherwise: there() if condition else otherwise(),
}  # fmt: skip


def lazily(text: str) -> str:
    """A formula whose IF calculates only what it takes."""
    at = text.find("IF(")
    if at < 0:
        return text
    parts, depth, start, place = [], 0, at + 3, at + 3
    while depth >= 0:
        depth += {"(": 1, ")": -1}.get(text[place], 0)
        if depth < 0 or (depth == 0 and text[place] == ","):
            parts.append(text[start:place])
            start = place + 1
        place += 1
    condition, there, otherwise = map(lazily, parts)
    whole = f"_IF({condition}, lambda: {there}, lambda: {otherwise})".removeprefix("_")
    return text[:at] + whole + lazily(text[place:])


def test_the_spreadsheet_answers_all(kit: Path) -> None:
    """Its formulas, calculated here; by LibreOffice, too, where that is installed."""
    assert compare(calculated(kit / "impact.xlsx"), kit=str(kit)).passes()
    if shutil.which("soffice"):
        order = ["soffice", "--headless", "--convert-to", "csv", "--outdir", str(kit.parent)]
        subprocess.run([*order, str(kit / "impact.xlsx")], check=True, capture_output=True)
        assert compare(kit.parent / "impact.csv", causes=False, kit=str(kit)).passes()


@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc is not installed")
def test_the_program_in_c_answers_all(kit: Path, tmp_path: Path) -> None:
    binary, theirs = tmp_path / "impact", tmp_path / "theirs.csv"
    subprocess.run(["gcc", "-O2", "-o", binary, "impact.c", "-lm"], cwd=kit, check=True)
    theirs.write_text(answers_of(kit, str(binary)), encoding="utf-8")
    assert compare(theirs, kit=str(kit)).passes()


@pytest.mark.long
def test_a_mistake_in_a_program_of_the_kit_is_named(kit: Path, tmp_path: Path) -> None:
    script = (kit / "impact.py").read_text(encoding="utf-8")
    assert '-g["E"] * gn' in script
    wrong, theirs = tmp_path / "wrong.py", tmp_path / "theirs.csv"
    wrong.write_text(script.replace('-g["E"]', 'g["E"]'), encoding="utf-8")
    theirs.write_text(answers_of(kit, sys.executable, str(wrong)), encoding="utf-8")
    assert "e with its sign lost" in compare(theirs, kit=str(kit)).summary


def test_the_scenes_alone_for_a_pipe(tmp_path: Path) -> None:
    out = tmp_path / "v.csv"
    assert impact88("oracle", "--vectors", "6", "-o", str(out)).returncode == 0
    assert out.read_text(encoding="utf-8").startswith("id,class,expect,flags,E,MU,EM")
    done = impact88("oracle", "--vectors", "6", "--to", "csv")
    assert done.returncode == 0
    assert done.stdout.startswith("id,class,expect,flags,E,MU,EM")
    assert done.stdout.count("\n") == 7
    assert impact88("oracle", "--to", "csv").returncode == 2


# --- the answers to it, judged ---


def written(rows: Table) -> str:
    out = io.StringIO()
    writer = csv.DictWriter(out, list(rows[0]))
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue()


def judged(kit: Path, path: Path, rows: Table) -> Comparison:
    path.write_text(written(rows), encoding="utf-8")
    return compare(path, causes=False, kit=str(kit))


def of_a_kind(rows: Table, expect: str) -> list[int]:
    return [at for at, row in enumerate(rows) if row["expect"] == expect]


def test_a_correct_program_conforms(kit: Path, answers: Table, tmp_path: Path) -> None:
    done = judged(kit, tmp_path / "theirs.csv", answers)
    assert done.passes()
    assert f"conforms, {COUNT} of {COUNT}" in done.kit.badge
    refused = [verdict for verdict in done.kit.verdicts if verdict.reason]
    assert len(refused) >= len(of_a_kind(answers, REFUSE)) > 0
    digest = hashlib.sha256((tmp_path / "theirs.csv").read_bytes()).hexdigest()
    assert done.kit.sha256 == digest
    assert digest[:12] in done.kit.badge
    few = [{name: row[name] for name in ("id", *FINAL_VELOCITIES)} for row in answers]
    assert judged(kit, tmp_path / "few.csv", few[::-1]).passes()
    assert compare(few, kit=str(kit)).passes()


def changed(rows: Table, at: int, **cells: str) -> Table:
    return [*rows[:at], {**rows[at], **cells}, *rows[at + 1 :]]


def all_answered(rows: Table, text: str, expect: str = "") -> Table:
    """Rows with one text for every result, those of one expectation or all."""
    cells = dict.fromkeys(FINAL_VELOCITIES, text)
    return [row | cells if expect in row["expect"] else row for row in rows]


def shifted(rows: Table) -> Table:
    """Rows with the ids of others."""
    ids = [row["id"] for row in rows[3:] + rows[:3]]
    return [{**row, "id": other} for row, other in zip(rows, ids, strict=True)]


def refused(rows: Table) -> int:
    """The first row that has no answer."""
    return of_a_kind(rows, REFUSE)[0]


WRONG: dict[str, tuple[str, Callable[[Table], Table]]] = {
    "two thirds deleted": (MISSING, lambda rows: rows[::3]),
    "infinite": (DISAGREES, lambda rows: [*rows[:11], *all_answered(rows[11:], "Infinity")]),
    "empty": (NOTHING_THERE, lambda rows: [*rows[:11], *all_answered(rows[11:], "")]),
    "empty throughout": (NOTHING_THERE, lambda rows: all_answered(rows, "")),
    "1 where there is nothing": (NO_SCENE, lambda rows: all_answered(rows, "1", REFUSE)),
    "a row twice": (REPEATED, lambda rows: [*rows, rows[5]]),
    "an id made up": (STRAY, lambda rows: [*rows, {**rows[5], "id": "1988-999999"}]),
    "no id": (STRAY, lambda rows: [*rows, {**rows[5], "id": ""}]),
    "an input one bit off": (
        CHANGED,
        lambda rows: changed(rows, 0, MA=repr(math.nextafter(float(rows[0]["MA"]), 0))),
    ),
    "an input in words": (UNREADABLE, lambda rows: changed(rows, 0, MA="heavy")),
    "a cell left out": (PARTIAL, lambda rows: changed(rows, 0, VBX="")),
    "a word for a refusal": (UNREADABLE, lambda rows: changed(rows, refused(rows), VAX="no")),
    "infinity for a refusal": (
        NO_SCENE,
        lambda rows: changed(rows, refused(rows), VAX="inf"),
    ),
    "ids of other rows": (CHANGED, shifted),
    "digits that say nothing": (NO_DIGIT, lambda rows: changed(rows, 0, VAX="0E9")),
    "a number off": (
        DISAGREES,
        lambda rows: changed(rows, 0, WBF=repr(float(rows[0]["WBF"]) * (1 + 1e-10))),
    ),
}
"""What is wrong -> what is said of it, and the table."""


@pytest.mark.parametrize("what", WRONG)
def test_what_is_wrong_does_not_pass(kit: Path, answers: Table, tmp_path: Path, what: str) -> None:
    reason, change = WRONG[what]
    done = judged(kit, tmp_path / "theirs.csv", change(answers))
    assert not done.passes()
    assert reason in ([DISAGREES] if done.differing else done.not_compared)
    assert reason == STRAY or reason in {verdict.reason for verdict in done.kit.failures}
    assert "does not conform" in done.kit.badge


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
        assert [one.vector.id for one in done.kit.failures] == [row["id"]], row["comment"]
        if at > 4:
            break


def test_a_kit_that_was_changed_is_refused(kit: Path, answers: Table, tmp_path: Path) -> None:
    theirs = tmp_path / "theirs.csv"
    theirs.write_text(written(answers), encoding="utf-8")
    names = {path.name: path.read_bytes() for path in kit.iterdir()}
    first = names["vectors.csv"].split(b"\n")[1]
    easier = names["vectors.csv"].replace(first, first.replace(b",6,", b",4,"))
    about = json.loads(names["KIT.json"])
    hashes = {"vectors.csv": hashlib.sha256(easier).hexdigest()}
    for says, vectors, changes in (
        ("not hold the vectors of seed 1988", easier, {}),
        ("not hold the vectors of seed 1988", easier, {"sha256": hashes}),
        ("not hold the vectors of seed 1988", names["vectors.csv"], {"vectors": 90}),
        ("not hold the vectors of seed 1988", b"id", {"vectors": 0}),
        ("not hold the vectors of seed 3", names["vectors.csv"], {"seed": 3}),
        ("has no seed", names["vectors.csv"], {"seed": None}),
        ("this version judges", names["vectors.csv"], {"kit": "vectors/1"}),
        ("not a JSON object", names["vectors.csv"], None),
    ):
        place = tmp_path / "changed.zip"
        record = [1] if changes is None else {**about, **changes}
        with zipfile.ZipFile(place, "w") as archive:
            archive.writestr("vectors.csv", vectors)
            archive.writestr("KIT.json", json.dumps(record))
        with pytest.raises(UserError, match=says):
            compare(theirs, kit=str(place))
    for place, says in ((tmp_path / "nowhere", "cannot be read"), (theirs, "is no kit")):
        with pytest.raises(UserError, match=says):
            compare(theirs, kit=str(place))


def test_the_command(kit: Path, answers: Table, tmp_path: Path) -> None:
    theirs, junit = tmp_path / "theirs.csv", tmp_path / "junit.xml"
    theirs.write_text(written(WRONG["a number off"][1](answers)), encoding="utf-8")
    judge = ["compare", "--kit", str(kit), "--no-causes"]
    done = impact88(*judge, str(theirs), "--junit", str(junit), "--json")
    assert done.returncode == 1, done.stderr
    found = json.loads(done.stdout)
    jsonschema.Draft202012Validator(json.loads(schemas.text("compare"))).validate(found)
    assert set(found) == set(json.loads(schemas.text("compare"))["properties"])
    assert (found["kit"]["passed"], found["kit"]["failed"]) == (COUNT - 1, 1)
    assert found["kit"]["failures"][0]["reason"] == DISAGREES
    suite = ElementTree.parse(junit).getroot()
    assert (suite.get("tests"), suite.get("failures")) == (str(COUNT), "1")
    theirs.write_text(written(answers), encoding="utf-8")
    done = impact88(*judge, "-", input=theirs.read_text(encoding="utf-8"))
    assert done.returncode == 0, done.stdout
    assert done.stdout.splitlines()[-1].startswith("impact88 vectors/2 seed 1988: conforms, 96 of")
    for more in (("--set", "EM=1"), ("--rtol", "1e-9"), ("--units", "us")):
        done = impact88(*judge, str(theirs), *more)
        assert (done.returncode, done.stderr.count("\n")) == (2, 1)


def test_a_table_without_ids_or_velocities_is_refused(
    kit: Path, answers: Table, tmp_path: Path
) -> None:
    for left_out in ("id", "WAF"):
        rows = [{name: row[name] for name in row if name != left_out} for row in answers]
        with pytest.raises(UserError, match=f"no column {left_out}"):
            judged(kit, tmp_path / "theirs.csv", rows)
