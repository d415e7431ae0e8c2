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
    return {name: action for action in arguments(command) for name in action.option_strings}


ALL = {command: declared(command) for command in COMMANDS}


def test_an_option_takes_the_same_words_in_every_command() -> None:
    """One spelling has one form; none takes several words, which would swallow a file's name."""
    forms: dict[str, set[tuple[str, object]]] = {}
    for taken in ALL.values():
        for option, action in taken.items():
            forms.setdefault(option, set()).add((type(action).__name__, action.nargs))
    assert {option: found for option, found in forms.items() if len(found) > 1} == {}
    others = {option: words for option, ((_, words),) in forms.items() if words not in (None, 0)}
    assert others == {"--vectors": "?"}  # the number of the frozen vectors may be left out


WRONG_SETTINGS = {
    ("MA=1", "ma=2"): "--set: MA is given twice",
    ("MA",): "expected NAME=VALUE",
    ("mass=1",): "'MASS' is not a name used here",
    ("MAA=3",): "did you mean MA?",
    **{(f"MA={text}",): " is no" for text in ("1_0", "nan", "much", "M=1 2x")},
}
"""What is set, and what every command says of it."""


@pytest.mark.parametrize("command", WITH_SET.split("|"))
def test_what_is_wrong_with_a_setting_is_said_in_one_line_by_every_command(
    command: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cases.csv").write_text("E,VAX\n1,2\n")
    for settings, said in WRONG_SETTINGS.items():
        assert main([*command.split(), *(f"--set={text}" for text in settings)]) == 2
        captured = capsys.readouterr()
        assert (captured.out, captured.err.count("\n")) == ("", 1), settings
        assert said in captured.err


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
            r"BEFORE IMPACT +A 29 ft/s \(19\.8 mph\), heading 180\n.*\n.*\nDELTA-V +A 37\.3",
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
