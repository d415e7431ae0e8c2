"""`commands.options`: one spelling and one reader for what several commands take."""

from __future__ import annotations

import argparse
import importlib
import re
from pathlib import Path

import pytest

from impact88.errors import UserError
from impact88.interface.commands import options
from impact88.interface.commands.cli import COMMANDS, main

WITH_SET = (
    "run --sample 1|solve cases.csv|compare cases.csv|reconstruct|barrier|colinear|delta-v|"
    "report --sample 1 -o page.html"
)


def arguments(command: str) -> list[argparse.Action]:
    """What a command takes."""
    parser = argparse.ArgumentParser()
    module = importlib.import_module(
        f"impact88.interface.commands.{command.replace('-', '_')}_command"
    )
    options.declare(parser, module.ARGUMENTS)
    return parser._actions


def declared(command: str) -> dict[str, argparse.Action]:
    """The options of a command, by spelling."""
    return {
        name: action
        for action in arguments(command)
        for name in action.option_strings
        if action.help != argparse.SUPPRESS
    }


ALL = {command: declared(command) for command in COMMANDS}


@pytest.mark.parametrize("option", sorted({name for one in ALL.values() for name in one}))
def test_an_option_takes_the_same_words_in_every_command(option: str) -> None:
    """One spelling has one form; none takes several words, which would swallow a file's name."""
    forms = {
        (type(one[option]).__name__, one[option].nargs) for one in ALL.values() if option in one
    }
    assert len(forms) == 1
    assert next(iter(forms))[1] in (None, 0)


@pytest.mark.parametrize("command", WITH_SET.split("|"))
class TestSet:
    @pytest.fixture(autouse=True)
    def table(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.chdir(tmp_path)
        (tmp_path / "cases.csv").write_text("E,VAX\n1,2\n")

    def refused(self, command: str, capsys: pytest.CaptureFixture[str], *settings: str) -> str:
        assert main([*command.split(), *(f"--set={text}" for text in settings)]) == 2
        captured = capsys.readouterr()
        assert captured.out == ""
        assert captured.err.count("\n") == 1
        return captured.err

    def test_twice(self, command: str, capsys: pytest.CaptureFixture[str]) -> None:
        assert "--set: MA is given twice" in self.refused(command, capsys, "MA=1", "ma=2")

    def test_no_value(self, command: str, capsys: pytest.CaptureFixture[str]) -> None:
        assert "expected NAME=VALUE" in self.refused(command, capsys, "MA")

    def test_no_name(self, command: str, capsys: pytest.CaptureFixture[str]) -> None:
        assert "'MASS' is not a name used here" in self.refused(command, capsys, "mass=1")

    def test_letter_typed_twice(self, command: str, capsys: pytest.CaptureFixture[str]) -> None:
        assert "did you mean MA?" in self.refused(command, capsys, "MAA=3")

    @pytest.mark.parametrize("text", ["1_0", "nan", "much", "M=1 2x"])
    def test_no_number(self, command: str, text: str, capsys: pytest.CaptureFixture[str]) -> None:
        assert " is no" in self.refused(command, capsys, f"MA={text}")


class TestNames:
    def test_commas_blanks_and_repetition(self) -> None:
        known = ("VAX", "VAY", "LOSS")
        assert options.names_given(["vax,LOSS", "VAY VAX"], known, "-x") == ["VAX", "LOSS", "VAY"]
        assert options.names_given([], known, "-x") == []

    def test_a_near_miss_is_pointed_at(self) -> None:
        with pytest.raises(UserError, match="'LOS' is not a result"):
            options.names_given(["LOS"], ("LOSS",), "--outputs")
        with pytest.raises(UserError, match="did you mean STATUS"):
            options.names_given(["STATSU"], ("STATUS",), "--outputs")

    def test_no_name_at_all(self) -> None:
        with pytest.raises(UserError, match="no name given"):
            options.names_given([","], ("LOSS",), "--outputs")


@pytest.mark.parametrize(
    ("command", "printed"),
    [
        ("reconstruct --sample 1", r"DELTA-V +A 16\.2.*\n +B 24\.2"),
        ("chapter delta-v --sample 3 --set LOSS=37.4", r"37\.4 +39\.0981 +25\.8856"),
        (
            "chapter barrier --sample 1",
            r"BEFORE IMPACT +A 29 ft/s \(19\.8 mph\), heading 180\nDELTA-V +A 37\.3",
        ),
    ],
)
def test_a_sample_is_known_wherever_a_scene_is_read(
    command: str, printed: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(command.split()) == 0
    assert re.search(printed, capsys.readouterr().out)
    assert main([*command.split(), "crash.toml"]) == 2
    assert "both given" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["run", "scene", "bounds"])
def test_output_to_a_file_is_what_is_printed(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    extra = ["--range", "MU=.7 .. .9", "--samples", "100"] if command == "bounds" else []
    assert main([command, "--sample", "1", *extra]) == 0
    printed = capsys.readouterr().out
    path = tmp_path / "out.txt"
    assert main([command, "--sample", "1", *extra, "-o", str(path)]) == 0
    assert capsys.readouterr().out == ""
    assert path.read_text(encoding="utf-8") == printed


def test_nothing_is_written_when_the_input_is_unusable(tmp_path: Path) -> None:
    path = tmp_path / "out.txt"
    path.write_text("before")
    assert main(["run", "--sample", "1", "--set", "MA=x", "-o", str(path)]) == 2
    assert path.read_text() == "before"
    assert list(tmp_path.iterdir()) == [path]
