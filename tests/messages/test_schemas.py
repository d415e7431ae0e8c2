"""What the commands print with --json has the form its schema says, and nothing more.

A field that a schema does not know is not an error for a reader. Here it is: every field
added is described.
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from captures import ROOT
from installed import impact88 as command
from tinyrom import rom

import impact88
from impact88.collision.casescene import sample
from impact88.conformance.comparison.vectors import FROZEN_ID, frozen
from impact88.conformance.qualification.selfcheck import checks
from impact88.errors import UserError
from impact88.interface.commands.cli import main
from impact88.messages import schemas
from impact88.names import FINAL_VELOCITIES
from impact88.program.run import run

PRINTOUT = str(ROOT / "legacy" / "table3-as-printed.txt")
SCENE = dict(sample(1))


@cache
def schema(name: str) -> Any:
    return json.loads(schemas.text(name))


def exact(part: Any) -> Any:
    """The schema, with no room for fields it does not describe."""
    if isinstance(part, list):
        return [exact(item) for item in part]
    if not isinstance(part, dict):
        return part
    closed = {key: exact(value) for key, value in part.items()}
    if "properties" in part:
        closed.setdefault("additionalProperties", False)
    return closed


@cache
def validator(name: str) -> jsonschema.Draft202012Validator:
    return jsonschema.Draft202012Validator(exact(schema(name)))


def check(name: str, printed: str, version: str | None = impact88.__version__) -> Any:
    found = json.loads(printed)
    assert found["schema"] == f"impact88/{name}/{schemas.NUMBERS[name]}"
    assert version is None or found["version"] == version
    validator(name).validate(found)
    return found


def printed(*arguments: str, status: int = 0, text: str = "") -> str:
    done = command(*arguments, input=text)
    assert done.returncode == status, done.stderr
    return done.stdout


def test_every_form_has_a_number() -> None:
    forms = {path.stem for path in Path(schemas.__file__).parent.glob("*.txt")}
    for name in forms ^ schemas.NUMBERS.keys():
        step = "messages/schemas/{}.txt" if name in schemas.NUMBERS else "a row for {} in NUMBERS"
        pytest.fail(f"next step: {step.format(name)}")


@pytest.mark.parametrize("name", schemas.NUMBERS)
def test_schemas_are_schemas_and_say_their_number(name: str) -> None:
    jsonschema.Draft202012Validator.check_schema(schema(name))
    assert schema(name)["$id"] == f"impact88/{name}/{schemas.NUMBERS[name]}"
    assert printed("schema", name) == schemas.text(name)


def test_names_conventions_and_unknown_names() -> None:
    listed = printed("schema")
    assert all(name in listed for name in (*schemas.NUMBERS, schemas.CONVENTIONS))
    assert "a program that refuses is right" in printed("schema", "conventions")
    table = printed("schema", "conventions").splitlines()
    for result in impact88.names.RESULTS.values():
        assert f"| {result.name} | {result.symbol} | {result.meaning} | {result.unit} |" in table
    with pytest.raises(UserError, match="no schema solve"):
        schemas.text("solve")
    assert command("schema", "solve").returncode == 2


@pytest.mark.parametrize("name", ["oracle", "compare", "solve"])
def test_conventions_are_reached_from_the_help(name: str) -> None:
    assert "impact88 schema conventions" in " ".join(printed(name, "--help").split())


@pytest.mark.parametrize(
    ("options", "status"),
    [
        (("--sample", "1"), 0),
        (("--sample", "2", "--set", "MA=0"), 0),
        (("--sample", "1", "--set", "IA=0"), 1),
        (("--sample", "1", "--arithmetic", "float64"), 0),
        (("--sample", "1", "--arithmetic", "float64", "--set", "UX=1E200"), 0),
    ],
)
def test_run(options: tuple[str, ...], status: int) -> None:
    done = command("run", "--json", *options)
    check("run", done.stdout)
    assert done.returncode in (status, 1)


def test_oracle_answers_and_refusals() -> None:
    lines = [{"id": 7, "class": "x", "scene": SCENE}, {"scene": {**SCENE, "IA": "0"}}, {"id": "a"}]
    text = "".join(f"{json.dumps(line)}\n" for line in lines)
    answers = printed("oracle", status=1, text=text).splitlines()
    assert ["error" in check("oracle", answer) for answer in answers] == [False, False, True]


def test_vectors_new_and_frozen() -> None:
    for line in printed("oracle", "--vectors", "45", "--seed", "2").splitlines():
        check("vectors", line)
    whole = frozen()
    for vector in whole[:: len(whole) // 20]:
        check("vectors", json.dumps(vector), version=None)  # they name the version that made them


@pytest.mark.parametrize("change", [None, ("25.994", "26.994"), ("MB=", "XX="), ("KE LOSS", "KE")])
def test_verify(change: tuple[str, str] | None, tmp_path) -> None:
    with open(PRINTOUT, encoding="utf-8") as file:
        text = file.read()
    if change:
        assert change[0] in text
        text = text.replace(*change)
    path = tmp_path / "printout.txt"
    path.write_text(text, encoding="utf-8")
    done = command("verify", "--json", str(path))
    check("verify", done.stdout)


def test_verify_tells_of_a_file_it_cannot_read() -> None:
    assert "error" in check("verify", printed("verify", "--json", "-", status=2, text="nothing"))


def test_compare_right_wrong_and_incomplete(tmp_path) -> None:
    path = tmp_path / "theirs.jsonl"
    for results in ({"VAX": "-13.263"}, {"VAX": "13.263", "vay": "3"}, {"VAX": "1e999"}):
        rows = [{**SCENE, **results}, {**SCENE, "MA": "0", **results}, {**SCENE, "VAX": ""}]
        path.write_text("".join(f"{json.dumps(row)}\n" for row in rows), encoding="utf-8")
        done = command("compare", "--json", str(path))
        if done.returncode != 2:
            check("compare", done.stdout)
    rows = [{"id": one["id"], **dict.fromkeys(FINAL_VELOCITIES, "")} for one in frozen(9)]
    path.write_text("".join(f"{json.dumps(row)}\n" for row in rows), encoding="utf-8")
    check("compare", command("compare", "--json", "--kit", FROZEN_ID, str(path)).stdout)


def test_selfcheck(tmp_path, monkeypatch, capsys) -> None:
    """The command on no captures, which is quick: every check fails but the published runs'."""
    (tmp_path / "printouts").symlink_to(ROOT / "golden" / "printouts")
    monkeypatch.setattr(
        "impact88.interface.commands.selfcheck_command.checks", lambda: checks(tmp_path)
    )
    assert main(["selfcheck", "--json"]) == 1
    found = check("selfcheck", capsys.readouterr().out)
    assert [one["name"] for one in found["checks"] if one["passed"]] == [
        "published",
        "published 1980",
    ]


def test_witness(tmp_path) -> None:
    """Of a ROM that prints another digit; that of one that does not has less in it."""
    path = tmp_path / "own.rom"
    right = run(sample(1), dos=False)
    path.write_bytes(rom(right.printout.replace("57.47", "57.48"), right.reals, right.A))
    done = command("witness", "--rom", str(path), "--any-rom", "--sample", "1", "--json")
    assert not check("witness", done.stdout)["passed"]
    assert done.returncode == 1


@pytest.mark.parametrize(
    "options",
    [
        ("--range", "MU=0.7 .. 0.9", "--outputs", "DVA,LOSS"),
        ("--range", "MU=-0.5 .. 4", "--range", "E=normal .1 .02", "--correlation", "MU,E=.5"),
    ],
)
def test_bounds(options: tuple[str, ...]) -> None:
    check("bounds", printed("bounds", "--sample", "1", "--samples", "500", "--json", *options))


@pytest.mark.usefixtures("brief_search")
@pytest.mark.parametrize(
    ("unknown", "known"),
    [
        (("UX", "VY"), {"VAX": "-7.459", "VBY": "41.456"}),
        (("UX", "VY"), {"VAX": "-7.459 +- 1", "VBY": "41.456 +- 1", "DVA": "40 +- 2"}),
    ],
)
def test_reconstruct(unknown: tuple[str, ...], known: dict[str, str]) -> None:
    values = {n: text for n, text in sample(3).items() if n not in unknown} | known
    options = [part for n, text in values.items() for part in ("--set", f"{n}={text}")]
    check("reconstruct", printed("reconstruct", "--samples", "200", "--json", *options))


TWO = ["--set=MA=96", "--set=MB=145"]
SPEEDS = [*TWO, "--set=SA=36.667", "--set=SB=58.667"]
AFTER = [*TWO, *(f"--set={text}" for text in "VAX=-10 VAY=20 VBX=-20 VBY=45 DT=.374".split())]
LINE = "MA=154.7 MB=99.1 E=.071 MUP=-.008 UN=-56.76 UT=0 VN=0 VT=0".split()


@pytest.mark.parametrize(
    ("name", "asked"),
    [
        ("colinear", [*(f"--set={text}" for text in LINE), "--contact-time=.1"]),
        ("delta-v", [*SPEEDS, "--set=LOSS=37.4"]),
        ("delta-v", [*SPEEDS, "--like=90-side"]),
        ("delta-v", [*SPEEDS, "--set=DVA=20"]),
        ("delta-v", AFTER),
        ("example", []),
        ("staged", []),
    ],
)
def test_the_chapter_s_problems(name: str, asked: list[str]) -> None:
    check(name, printed("chapter", name, *asked, "--json"))
