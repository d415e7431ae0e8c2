"""The kit for other implementations: what it holds, and its programs, where their language is."""

from __future__ import annotations

import csv
import hashlib
import json
import math
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from installed import impact88

from impact88.conformance.comparison.compare import Comparison, compare
from impact88.conformance.comparison.kit import write_kit
from impact88.conformance.comparison.vectors import ANSWER, EITHER, REFUSE
from impact88.names import SCENE


@pytest.fixture(scope="module")
def kit(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("kit") / "new"
    assert set(write_kit(str(folder), 60, 3)) == {path.name for path in folder.iterdir()}
    return folder


def compared(kit: Path, text: str, causes: bool = False) -> Comparison:
    """A table of answers, as `compare --kit` judges it."""
    path = kit.parent / "theirs"
    path.write_text(text, encoding="utf-8")
    return compare(path, "jsonl" if text.startswith("{") else "csv", causes=causes, kit=str(kit))


def test_the_kit_says_what_it_is(kit: Path) -> None:
    about = json.loads((kit / "KIT.json").read_text(encoding="utf-8"))
    assert (about["kit"], about["seed"], about["vectors"]) == ("vectors/2", 3, 60)
    for name, digest in about["sha256"].items():
        assert hashlib.sha256((kit / name).read_bytes()).hexdigest() == digest


def test_both_forms_of_the_vectors_ask_the_same(kit: Path) -> None:
    whole = list(map(json.loads, (kit / "vectors.jsonl").read_text(encoding="utf-8").splitlines()))
    with (kit / "vectors.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(whole) == len(rows) == 60
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
    lines = "".join(json.dumps(row) + "\n" for row in calculated(kit / "impact.xlsx"))
    assert compared(kit, lines).passes()
    if shutil.which("soffice"):
        order = ["soffice", "--headless", "--convert-to", "csv", "--outdir", str(kit.parent)]
        subprocess.run([*order, str(kit / "impact.xlsx")], check=True, capture_output=True)
        assert compare(kit.parent / "impact.csv", causes=False, kit=str(kit)).passes()


def compiled(kit: Path) -> list[str]:
    out = kit.parent / "impact"
    subprocess.run(["gcc", "-O2", "-o", str(out), "impact.c", "-lm"], cwd=kit, check=True)
    return [str(out)]


RUNNERS = {
    "gcc": compiled,
    "python": lambda kit: [sys.executable, "impact.py"],
}


@pytest.mark.parametrize("language", RUNNERS)
def test_a_program_of_the_kit_answers_all(kit: Path, language: str) -> None:
    if language != "python" and shutil.which(language) is None:
        pytest.skip(f"{language} is not installed")
    command = RUNNERS[language](kit)
    with (kit / "vectors.csv").open("rb") as file:
        out = subprocess.run(command, cwd=kit, stdin=file, capture_output=True, check=True)
    assert compared(kit, out.stdout.decode()).passes()


@pytest.mark.long
def test_a_mistake_in_a_program_of_the_kit_is_named(kit: Path) -> None:
    script = (kit / "impact.py").read_text(encoding="utf-8")
    assert '-g["E"] * gn' in script
    (kit.parent / "wrong.py").write_text(script.replace('-g["E"]', 'g["E"]'), encoding="utf-8")
    with (kit / "vectors.csv").open("rb") as file:
        out = subprocess.run(
            [sys.executable, "wrong.py"],
            cwd=kit.parent,
            stdin=file,
            capture_output=True,
            check=True,
        )
    done = compared(kit, out.stdout.decode(), causes=True)
    assert "e with its sign lost" in done.summary


def test_the_scenes_alone_for_a_pipe(tmp_path: Path) -> None:
    out = tmp_path / "v.csv"
    assert impact88("oracle", "--vectors", "6", "-o", str(out)).returncode == 0
    assert out.read_text(encoding="utf-8").startswith("id,class,expect,flags,E,MU,EM")
    done = impact88("oracle", "--vectors", "6", "--to", "csv")
    assert done.returncode == 0
    assert done.stdout.startswith("id,class,expect,flags,E,MU,EM")
    assert done.stdout.count("\n") == 7
    assert impact88("oracle", "--to", "csv").returncode == 2
