"""No option of any command writes over a file that another one reads or writes, under any name."""

from __future__ import annotations

import argparse
import os
import re
from itertools import permutations, product
from pathlib import Path

import pytest
from test_options import arguments

from impact88.interface.commands.cli import COMMANDS, main
from impact88.interface.commands.options import InputPath, OutputPath

FILES = (InputPath, OutputPath)
FOLDERS = ("DIR", "FOLDER")
LINKS = {"symlink": os.symlink, "hardlink": os.link}


def spelled(action: argparse.Action, value: str) -> str:
    return f"{action.option_strings[0]}={value}" if action.option_strings else value


def pairs(command: str) -> list[tuple[argparse.Action, argparse.Action]]:
    """A command's arguments that name files, two at a time, the second one written."""
    named = [action for action in arguments(command) if action.type in FILES]
    written = [a for a in named if a.type is OutputPath and a.metavar not in FOLDERS]
    return [(first, second) for first, second in permutations(named, 2) if second in written]


def test_what_names_a_file_says_whether_it_is_read_or_written() -> None:
    metavars = re.compile(r"FILE|FOLDER|DIR|CASES|RESULTS|PRINTOUT|THEIRS|SCENE")
    silent = [
        (command, action.metavar)
        for command in COMMANDS
        for action in arguments(command)
        if metavars.search(str(action.metavar)) and action.type not in FILES
    ]
    assert silent == []


@pytest.mark.parametrize("command", [command for command in COMMANDS if pairs(command)])
def test_no_file_is_written_that_is_read_or_written_elsewhere(
    command: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Every two arguments that name one file, the second by each way that a file can be named."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "kept.svg").write_text("before")
    names = ["./kept.svg"]
    for kind, make in LINKS.items():
        make("kept.svg", f"{kind}.svg")
        names.append(f"{kind}.svg")
    there = sorted(tmp_path.iterdir())
    for (first, second), other in product(pairs(command), names):
        needed = [
            spelled(action, action.choices[0] if action.choices else "needed.txt")
            for action in arguments(command)
            if action.dest not in (first.dest, second.dest)
            and (action.required or (not action.option_strings and action.nargs in (None, "+")))
        ]
        asked = [*needed, spelled(first, "kept.svg"), spelled(second, other)]
        assert main([*command.split(), *asked]) == 2, asked
        said = capsys.readouterr().err
        assert re.search(r" names a file that is read|the file of \S+ too", said), asked
        assert (tmp_path / "kept.svg").read_text() == "before", asked
        assert sorted(tmp_path.iterdir()) == there, asked


@pytest.mark.parametrize(
    "asked",
    [
        ["oracle", "bad.txt"],
        ["verify", "bad.txt"],
        ["run", "bad.txt"],
        ["solve", "bad.txt", "--to=csv"],
        ["compare", "bad.txt"],
        ["reconstruct", "bad.txt"],
    ],
    ids=lambda asked: asked[0],
)
def test_status_2_replaces_nothing(
    asked: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.txt").write_bytes(b"\xff\xfe\0nothing")
    (tmp_path / "kept").write_text("before")
    assert main([*asked, "-o", "kept"]) == 2
    assert (tmp_path / "kept").read_text() == "before"
    assert len(list(tmp_path.iterdir())) == 2


def test_a_folder_to_write_into_holds_no_file_that_is_read(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rom = tmp_path / "scenes.jsonl.gz"
    rom.write_bytes(b"rom")
    assert main(["witness", f"--rom={rom}", f"--save={tmp_path}"]) == 2
    assert "the folder of a file that is read" in capsys.readouterr().err
    assert rom.read_bytes() == b"rom"


def test_patterns_are_expanded_where_no_shell_did(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("b.txt", "a.txt", "[c].txt"):
        (tmp_path / name).write_text("no printout")
    assert main(["verify", "?.txt", "[c].txt", "none*.txt"]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert [re.findall(r"\S+\.txt", line)[0].rstrip(":") for line in lines] == [
        "a.txt",
        "b.txt",
        "[c].txt",
        "none*.txt",
    ]
