"""Needs pip install 'impact88[completion]' (shtab). The script is made from the options as they
are; make it again after an update.

examples:
  impact88 completion bash > ~/.local/share/bash-completion/completions/impact88
  impact88 completion zsh > ~/.zsh/completions/_impact88
  impact88 completion tcsh >> ~/.tcshrc
"""

import argparse
from importlib import import_module

from ...errors import library
from . import CHAPTER, CHAPTER_MEANING, COMMANDS, module_of, options

ARGUMENTS = (
    options.value("shell", "SHELL", "bash, zsh or tcsh", choices=("bash", "zsh", "tcsh")),
    options.OUTPUT,
)


def main(args: options.Args) -> None:
    shtab = library("shtab", "completion", "completion")
    parser = argparse.ArgumentParser(prog="impact88")
    commands = parser.add_subparsers()
    chapter = commands.add_parser("chapter", help=CHAPTER_MEANING).add_subparsers()
    for name, meaning in COMMANDS.items():
        command = (chapter if name in CHAPTER else commands).add_parser(name, help=meaning)
        options.declare(command, import_module(module_of(name)).ARGUMENTS)
        for action in command._actions:
            if action.type in (options.InputPath, options.OutputPath):
                folder = action.metavar in ("DIR", "FOLDER")
                action.complete = shtab.DIRECTORY if folder else shtab.FILE  # type: ignore[attr-defined]
    print(shtab.complete(parser, args.shell))
