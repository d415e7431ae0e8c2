"""Needs pip install 'impact88[completion]' (shtab). The script is made from the options as they
are; make it again after an update.

examples:
  impact88 completion bash > ~/.local/share/bash-completion/completions/impact88
  impact88 completion zsh > ~/.zsh/completions/_impact88
  impact88 completion tcsh >> ~/.tcshrc
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from importlib import import_module

from ..errors import library
from . import CHAPTER, CHAPTER_MEANING, COMMANDS, module_of, options

ARGUMENTS = (
    options.value("shell", "SHELL", "bash, zsh or tcsh", choices=("bash", "zsh", "tcsh")),
    options.OUTPUT,
)


def main(args: argparse.Namespace) -> int:
    """Print the script."""
    shtab = library("shtab", "completion", "completion")
    print(shtab.complete(whole_parser(), args.shell))
    return 0


def whole_parser() -> argparse.ArgumentParser:
    """All commands with all options, files marked for shtab."""
    parser = argparse.ArgumentParser(prog="impact88")
    commands = parser.add_subparsers()
    _add(commands, [name for name in COMMANDS if name not in CHAPTER])
    _add(commands.add_parser("chapter", help=CHAPTER_MEANING).add_subparsers(), CHAPTER)
    return parser


def _add(
    commands: argparse._SubParsersAction[argparse.ArgumentParser], names: Iterable[str]
) -> None:
    import shtab

    for name in names:
        parser = commands.add_parser(name, help=COMMANDS[name])
        options.declare(parser, import_module(module_of(name)).ARGUMENTS)
        for action in parser._actions:
            if action.type in (options.InputFile, options.OutputFile):
                action.complete = shtab.FILE  # type: ignore[attr-defined]
            elif action.type in (options.InputFolder, options.OutputFolder):
                action.complete = shtab.DIRECTORY  # type: ignore[attr-defined]
