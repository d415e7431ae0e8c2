"""The command line: which command, and what happens to errors.

Exit status: 0 done (``ZERO DETERMINANT`` is a normal END), 1 done with an adverse result (an
Applesoft error, a bad row, a printout that differs), 2 unusable input. Control-C and a broken pipe
leave with the shell's usual 130 and 141 and no traceback.

Each command lives in ``impact88.commands.NAME`` and is imported only when it is asked for.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from importlib import import_module

from . import __version__
from .errors import UserError

COMMANDS = {
    "run": "run the 1988 program on its own data, a sample or a scene file",
    "basic": "the ] prompt with the restored listing, or run any Applesoft program",
    "scene": "print a scene file to fill in, or a sample's",
    "verify": "say whether an old printout is right, digit for digit, and if not, why",
    "oracle": "answer scenes with all that is known of them, for checking other programs",
    "compare": "say where another program's results agree with these, and if not, why",
    "selfcheck": "replay the packaged captures here, and say pass or fail, for the record",
    "witness": "the captures and this project against your own Apple II Plus ROM (extra: witness)",
    "solve": "solve a table of scenes: double precision, or Applesoft's arithmetic, fast",
    "bench": "run time against error of every method, measured on this machine",
    "bounds": "lower and upper bounds, quantiles and drivers from ranges of a scene's values",
    "figure": "draw a scene, its bounds or a figure of the chapter (extra: plot)",
    "reconstruct": "solve the impact equations for any unknowns: velocities, coefficients",
    "barrier": "the impact of one vehicle on a rigid barrier",
    "colinear": "the direct colinear impact, Equations 1-12, forward or inverse",
    "delta-v": "delta-V of both vehicles from speeds, masses and energy loss, Equation 19",
    "staged": "the eleven staged collisions: Tables 1 and 2 recomputed, fitted, compared",
    "example": "Section VII's reconstruction, step by step",
}
"""Command -> one line of help, in the order ``--help`` lists them."""

INTERRUPTED = 130
BROKEN_PIPE = 141


class _Parser(argparse.ArgumentParser):
    """argparse's errors in this project's form: one line, status 2."""

    def error(self, message: str) -> None:  # type: ignore[override]
        raise UserError(f"{message} (see {self.prog} --help)")


def _help_formatter(prog: str) -> argparse.HelpFormatter:
    """Help as wide as this project's text; argparse would load shutil to ask the terminal."""
    return argparse.RawDescriptionHelpFormatter(prog, width=96)


def _overview() -> str:
    width = max(map(len, COMMANDS)) + 2
    lines = [f"  {name:<{width}}{help_line}" for name, help_line in COMMANDS.items()]
    return "\n".join(
        [
            "usage: impact88 COMMAND [options]",
            "",
            "R. M. Brach's 1988 program for the planar impact of two vehicles, digit for digit,",
            "and the same mechanics for today's work.",
            "",
            "commands:",
            *lines,
            "",
            "impact88 COMMAND --help tells a command's options; impact88 --version the version.",
            "exit status: 0 done, 1 done with an adverse result, 2 unusable input",
        ]
    )


def _dispatch(arguments: Sequence[str]) -> int:
    if not arguments:
        raise UserError("no command given (see impact88 --help)")
    name, *rest = arguments
    if name in ("-h", "--help", "help"):
        print(_overview())
        return 0
    if name == "--version":
        print(f"impact88 {__version__}")
        return 0
    if name not in COMMANDS:
        raise UserError(f"{name!r} is no command; expected one of: {' '.join(COMMANDS)}")
    module = import_module(f".commands.{name.replace('-', '_')}", __package__)
    parser = _Parser(
        prog=f"impact88 {name}",
        description=COMMANDS[name][0].upper() + COMMANDS[name][1:] + ".",
        epilog=module.__doc__,
        formatter_class=_help_formatter,
    )
    module.add_arguments(parser)
    return int(module.main(parser.parse_args(rest)))


def _open_closed_streams() -> None:
    """A stream the shell closed (``2>&-``) is None in Python: make it read or write nothing.

    Raises UserError when standard output is closed: the result would be lost without a word.
    """
    if sys.stdin is None:
        sys.stdin = open(os.devnull)  # noqa: SIM115
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115
    if sys.stdout is None:
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115
        raise UserError("standard output is closed; expected somewhere to print the result")


def _drop_output() -> None:
    """Let stdout lead nowhere: on its way out the interpreter would flush, and complain, again."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit status."""
    arguments = sys.argv[1:] if arguments is None else arguments
    status = 2
    try:
        try:
            _open_closed_streams()
            status = _dispatch(arguments)
        except UserError as error:
            command = arguments[0] if arguments and arguments[0] in COMMANDS else None
            print(f"impact88{' ' + command if command else ''}: {error}", file=sys.stderr)
        except SystemExit as leave:  # argparse's --help
            status = leave.code if isinstance(leave.code, int) else 0
        sys.stdout.flush()
    except KeyboardInterrupt:
        print(file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        _drop_output()
        return BROKEN_PIPE
    except OSError as error:  # a full disk, most likely
        print(f"impact88: {error.filename or 'output'}: {error.strerror or error}", file=sys.stderr)
        _drop_output()
        return 2
    return status
