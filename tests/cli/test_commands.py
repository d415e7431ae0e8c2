"""Each command on real files: what it prints, its files, and its exit status."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from commands import command

import impact88
from cases import FILES, INTERSECTION
from impact88.cli import COMMANDS, GONE
from impact88.cli.output import FORMS


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name, text in FILES.items():
        (tmp_path / name).write_text(text, "utf-8")
    page = impact88.run(impact88.sample(1)).page
    (tmp_path / "printout.txt").write_text(page, "utf-8")
    (tmp_path / "altered.txt").write_text(page.replace("-13.263", "-13.363"), "utf-8")
    (tmp_path / "scenes.jsonl").write_text(
        json.dumps({"id": 1, "scene": dict(impact88.sample(1))}) + "\n", "utf-8"
    )
    return tmp_path


STATUSES = """
0 run --sample 1
0 run crash.toml
0 run rear.toml
0 solve crash.toml --units us
2 solve crash.toml --units si
0 run --sample 1 --arithmetic float64
0 run --sample 1 --set MA=0
1 run --sample 1 --set IA=0
0 solve crash.toml
0 solve rear.toml
1 solve impossible.toml
1 solve --sample 1 --set UX=29.04
0 solve --sample 1 --sweep MU=0:1:3 --results DVA
1 solve cases.csv --scene crash.toml --results DVA
0 scene
0 scene rear-end --units metric
0 scene crash.toml --set MU=.7
0 report crash.toml -o case.html
0 report --sample 1 -o scene.svg
1 report impossible.toml -o case.html
0 verify printout.txt
1 verify altered.txt
1 verify --brief printout.txt altered.txt
0 verify --json printout.txt
0 oracle scenes.jsonl
0 oracle --kit kit
0 basic hello.bas
1 basic broken.bas
0 chapter example
0 chapter staged
0 chapter delta-v --set MA=96 --set MB=145 --set SA=36.667 --set SB=58.667 --set LOSS=37.4
0 chapter colinear --set MA=2 --set MB=1 --set E=.2 --set UN=-5 --set VN=0
0 --version
0 help
"""


@pytest.mark.parametrize("line", STATUSES.strip().splitlines())
def test_exit_statuses(line: str, folder: Path) -> None:
    status, *words = line.split()
    outcome = command(*words, input="BRACH\n", folder=folder)
    assert outcome.status == int(status), outcome
    assert "Traceback" not in outcome.err


@pytest.mark.parametrize("name", COMMANDS)
def test_help_begins_with_an_example(name: str) -> None:
    outcome = command("help", name)
    assert outcome.status == 0
    assert outcome.out.startswith(f"impact88 {name} ")
    examples = " ".join(re.findall(rf"impact88 {name} .*", outcome.out))
    options = outcome.out[outcome.out.index("\noptions:") :]
    assert {*re.findall(r"--[a-z][a-z-]+", examples)} <= {*re.findall(r"--[a-z][a-z-]+", options)}
    assert max(map(len, outcome.out.splitlines())) <= 100
    assert outcome.out == command(name, "--help").out


@pytest.mark.parametrize("name", GONE)
def test_a_command_that_is_gone_says_what_to_use(name: str) -> None:
    outcome = command(name, "crash.toml")
    assert outcome.status == 2
    assert outcome.err == f"impact88: {name} is not a command any more; use {GONE[name]}\n"


@pytest.mark.parametrize(
    "line",
    ["run --sample 1", "solve rear.toml", "verify printout.txt", "chapter example", "selfcheck"],
)
def test_json_has_a_version(line: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("impact88.comparison.selfcheck.checks", lambda: ())
    outcome = command(*line.split(), "--json", folder=folder)
    record = json.loads(outcome.out)
    name, form, version = record["schema"].split("/")
    assert (name, FORMS[form]) == ("impact88", int(version))
    assert record["version"] == impact88.__version__


@pytest.mark.parametrize(
    ("line", "hint"),
    [
        ("run --sampel 1", "did you mean --sample?"),
        ("solve crash.toml --reslts=DVA", "did you mean --results?"),
        ("solve crash.toml --outputs DVA", "did you mean --results?"),
        ("verify printout.txt --breif", "did you mean --brief?"),
        ("verify printout.txt --xyz", "unrecognized arguments: --xyz (see impact88 help verify)"),
    ],
)
def test_a_mistyped_option_has_a_hint(line: str, hint: str, folder: Path) -> None:
    outcome = command(*line.split(), folder=folder)
    assert (outcome.status, outcome.out) == (2, "")
    assert hint in outcome.err


@pytest.mark.parametrize(("restitution", "status"), [(0.1, 0), (0.9, 1)])
def test_an_impact_that_gains_energy_is_adverse(restitution: float, status: int) -> None:
    car = "MA=143.5 IA=3728 DA=7.59 GA=-30 PA=-19.8 TA=0 MU=.4 EM=1 UX=-29 UY=0 WA=0".split()
    barrier = "MB=inf IB=inf DB=0 PB=0 TB=0 VX=0 VY=0 WB=0".split()
    entries = (*car, *barrier, f"E={restitution}")
    outcome = command("solve", *(word for entry in entries for word in ("--set", entry)))
    assert outcome.status == status
    assert ("kinetic energy is gained" in outcome.out) == bool(status)


@pytest.mark.parametrize(("number", "names"), [(1, ""), (2, "IA IB PA PB TA TB EM")])
def test_a_brief_verdict_names_what_the_page_cannot_reveal(number: int, names: str) -> None:
    page = impact88.run(impact88.sample(number)).page
    outcome = command("verify", "--brief", "-", input=page)
    assert "IDENTICAL\n" in outcome.out
    assert outcome.out.partition("errors this page could not reveal: ")[2].strip() == names


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("scene intersecton", "expected intersection, rear-end, head-on, planar, barrier, crush"),
        ("solve printout.txt", "expected a table or a .toml; for a printout use verify"),
        ("solve case.png", "expected a table in .csv"),
        ("report rear.toml", "expected -o FILE.html, FILE.svg or FILE.png"),
    ],
)
def test_what_is_expected_is_said(line: str, words: str, folder: Path) -> None:
    outcome = command(*line.split(), folder=folder)
    assert outcome.status == 2
    assert words in outcome.err


def test_run_asks_standard_input(folder: Path) -> None:
    outcome = command("run", input=FILES["replies.txt"])
    assert "VAX= -13.263 VAY= 3.449 (XA=-8.78 YA= 15.91)" in outcome.out
    assert outcome.out == impact88.run(impact88.sample(1)).page


@pytest.mark.parametrize(
    ("changes", "said", "page"),
    [
        ((), "missing E (coefficient of restitution); MU", ""),
        (
            ("GA=60",),
            "as impact88 solve finds them: E MU UX UY VX VY",
            "0      60\n",
        ),
        (("SB=1", "SA=90", "E=.2"), "no impact was found, so there is none to run", ""),
    ],
)
def test_a_case_with_other_evidence_is_run_by_its_answer(
    changes: tuple[str, ...], said: str, page: str
) -> None:
    options = [word for change in changes for word in ("--set", change)]
    outcome = command("run", "-", *options, input=INTERSECTION)
    assert said in outcome.err
    assert (outcome.status, page in outcome.out) == (0 if page else 2, True)


def test_a_scene_file_is_not_written_over_another(folder: Path) -> None:
    assert command("scene", "planar", "-o", "new.toml", folder=folder).status == 0
    (folder / "new.toml").write_text("MA = 1", "utf-8")
    outcome = command("scene", "planar", "-o", "new.toml", folder=folder)
    assert (outcome.status, "is there already" in outcome.err) == (2, True)
    assert (folder / "new.toml").read_text("utf-8") == "MA = 1"


def test_a_sweep_says_that_limits_are_left_out(folder: Path) -> None:
    sweep = ("solve", "crash.toml", "--sweep", "MU=0:1:2")
    words = "takes the middle of UX, VY, E, not their limits"
    assert words in command(*sweep, folder=folder).err
    exact = (word for change in ("UX=-25", "VY=40", "E=.2") for word in ("--set", change))
    assert words not in command(*sweep, *exact, folder=folder).err


def test_a_dash_is_standard_input() -> None:
    assert command("scene", "-", input=FILES["rear.toml"]).status == 0
    verdict = command("verify", "-", input=impact88.run(impact88.sample(2)).page)
    assert verdict.status == 0
    table = "MU,DVA\n.5,1\n"
    assert command("solve", "-", "--set", "MA=1", input=table).status == 2


def test_set_is_editing_the_file(folder: Path) -> None:
    text = FILES["crash.toml"].replace("MU = 0.5", "MU = 0.7")
    (folder / "edited.toml").write_text(text, "utf-8")
    outcome = command("solve", "crash.toml", "--set", "MU=0.7", folder=folder)
    assert outcome.out == command("solve", "edited.toml", folder=folder).out


def test_bad_rows_are_named_and_the_others_solved(folder: Path) -> None:
    words = "solve cases.csv --scene crash.toml --results DVA -o out.csv"
    outcome = command(*words.split(), folder=folder)
    assert outcome.status == 1
    rows = (folder / "out.csv").read_text().splitlines()
    assert [row.split(",")[-1] != "" for row in rows[1:]] == [True, False, True]
    assert "line 3: MU = 'much'" in outcome.err


def test_output_files_are_whole_or_not_written(folder: Path) -> None:
    target = folder / "page.txt"
    target.write_text("before", "utf-8")
    assert command("run", "--sample", "1", "-o", "page.txt", "--set", "MU=x", folder=folder).status
    assert target.read_text("utf-8") == "before"
    command("run", "--sample", "1", "-o", "page.txt", folder=folder)
    assert target.read_text("utf-8") == impact88.run(impact88.sample(1)).page
    target.chmod(0o444)
    outcome = command("run", "--sample", "2", "-o", "page.txt", folder=folder)
    assert (outcome.status, "read-only" in outcome.err) == (2, True)


def test_an_output_is_never_an_input(folder: Path) -> None:
    os.link(folder / "crash.toml", folder / "same.toml")
    outcome = command("scene", "crash.toml", "-o", "same.toml", folder=folder)
    assert outcome.status == 2
    assert (folder / "crash.toml").read_text("utf-8") == FILES["crash.toml"]


def test_the_prompt_lists_retypes_and_runs() -> None:
    lines = "LIST 350\n280 E = 5E-03:MU = .5:EM = -.715\nRUN\n" + FILES["replies.txt"]
    outcome = command("basic", input=lines)
    assert "350 N = 6:M = 6: REM" in outcome.out
    assert impact88.run(impact88.sample(1).replaced({"MU": ".5"})).page in outcome.out


def test_the_prompt_loads_programs(folder: Path) -> None:
    outcome = command("basic", input="LOAD none.bas\nLOAD hello.bas\nLIST\n", folder=folder)
    assert "none.bas: cannot be read" in outcome.err
    assert '20  PRINT "HELLO, "N$' in outcome.out


def test_a_run_does_not_import_numpy() -> None:
    code = (
        "import sys; from impact88.cli.main import main; main(['run', '--sample', '1']); "
        "sys.exit('numpy' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], stdout=subprocess.DEVNULL).returncode == 0


def test_a_broken_pipe_is_no_traceback() -> None:
    shell_run = subprocess.Popen(
        [sys.executable, "-m", "impact88", *"solve --sample 1 --sweep MU=0:1:50000".split()],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert shell_run.stdout is not None
    shell_run.stdout.readline()
    shell_run.stdout.close()
    assert shell_run.wait(60) == 141
    assert shell_run.stderr is not None
    assert shell_run.stderr.read() == ""


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_a_full_disk_is_status_2() -> None:
    with open("/dev/full", "w") as full:
        shell_run = subprocess.run(
            [sys.executable, "-m", "impact88", "run", "--sample", "1"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
        )
    assert shell_run.returncode == 2
    assert shell_run.stderr == "impact88 run: standard output: No space left on device\n"


@pytest.mark.parametrize(
    ("words", "package", "message"),
    [
        ("solve cases.parquet", "polars", "solve: this format needs the extra tables"),
        (
            "oracle scenes.jsonl",
            "mpmath",
            "oracle: the reference of 30 digits needs the extra oracle",
        ),
    ],
)
def test_a_missing_extra_is_named(
    words: str, package: str, message: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "cases.parquet").write_bytes(b"PAR1")
    monkeypatch.setitem(sys.modules, package, None)
    outcome = command(*words.split(), folder=folder)
    extra = message.rpartition(" ")[2]
    assert outcome.status == 2
    assert outcome.err == f"impact88 {message}: pip install '.[{extra}]' in the checkout\n"


def test_a_compass_heading_is_clockwise_from_north(folder: Path) -> None:
    words = "--set headings=compass --set HA=90 --set HB=180 --set HAF=130 --set HBF=120".split()
    (folder / "courses.toml").write_text(
        'units = "metric"\nM = 4\nSAF = 50\nSBF = 30\nMA = 1800\nMB = 1200\n'
    )
    rows = command("solve", "courses.toml", *words, "--results", "HA,SA", folder=folder).out
    assert "course of A before impact, clockwise from north" in rows
    scene = command("scene", "courses.toml", *words, folder=folder).out
    assert "# course of A before impact, clockwise from north [deg]" in scene


def test_an_internal_error_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(args: object) -> None:
        raise RuntimeError("unexpected")

    monkeypatch.setattr("impact88.cli.scene.main", fail)
    outcome = command("scene")
    assert outcome.status == 3
    assert outcome.err.startswith("impact88 scene: internal error; please report it: RuntimeError")
    assert len(outcome.err.splitlines()) == 1
