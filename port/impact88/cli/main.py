"""Which command runs, and what happens to errors.

Exit status: 0 done, 1 an adverse result, 2 unusable input, 3 an internal error; 130 interrupted,
141 a broken pipe. A traceback appears only for an internal error, if IMPACT88_DEBUG is 1."""

from __future__ import annotations

import argparse
import gc
import os
import sys
import warnings
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module

from ..errors import UserError, note
from ..files import ESCAPED
from ..names import check_names, did_you_mean
from ..version import __version__
from . import COMMANDS, GONE
from .options import check_files, printing_to

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NoReturn

UNUSABLE = 2
INTERNAL = 3
INTERRUPTED = 130
BROKEN_PIPE = 141
COLLECTION_THRESHOLD = 10_000  # allocations between garbage collections; Python's 700 costs 10 %
HELP = ("-h", "--help")
OVERVIEW = """\
usage: impact88 COMMAND [options]

R. M. Brach's 1988 program for the planar impact of two vehicles, digit for digit, and the same
mechanics for today's work.

{commands}

impact88 help COMMAND gives examples and options.
exit status: 0 done, 1 adverse result, 2 unusable input, 3 internal error"""


class Parser(argparse.ArgumentParser):
    """A parser whose errors are UserErrors."""

    def error(self, message: str) -> NoReturn:
        """Raise UserError."""
        raise UserError(f"{message} (see {self.prog.replace('impact88', 'impact88 help')})")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Parameters
    ----------
    arguments : sequence of str, optional
        The words of the command line; by default those of the process.

    Returns
    -------
    int
        The exit status.
    """
    if arguments is None:
        arguments = sys.argv[1:]
        gc.set_threshold(COLLECTION_THRESHOLD)
    command = next((word for word in arguments[:2] if word in COMMANDS), None)
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # starting its threads takes 10 ms
    try:
        _prepare_streams()
        with warnings.catch_warnings(action="ignore"):  # those of libraries
            status = _dispatch(arguments)
        sys.stdout.flush()
        return status
    except KeyboardInterrupt:
        return INTERRUPTED
    except UserError as error:
        note(command, str(error))
        return UNUSABLE
    except (RecursionError, MemoryError):
        note(command, "the input is too large or nested too deeply; expected a smaller one")
        return UNUSABLE
    except OSError as error:  # those of files are UserErrors
        _discard_output()
        if isinstance(error, BrokenPipeError):
            return BROKEN_PIPE
        note(command, f"standard output: {error.strerror or error}")
        return UNUSABLE
    except Exception as error:
        if os.environ.get("IMPACT88_DEBUG") == "1":
            sys.excepthook(*sys.exc_info())
        advice = "(IMPACT88_DEBUG=1 prints the traceback)"
        note(command, f"internal error; please report it: {error!r} {advice}")
        return INTERNAL


def _dispatch(arguments: Sequence[str]) -> int:
    """Run the command that the words name. Raises UserError for words that name none."""
    name, *words = arguments or ["help"]
    if name == "help" and words:
        name, *words = [*words, "--help"]
    if name in (*HELP, "help"):
        lines = "\n".join(f"  {command:<11}{meaning}" for command, meaning in COMMANDS.items())
        print(OVERVIEW.format(commands=lines))
        return 0 if arguments else UNUSABLE
    if name in ("-V", "--version"):
        print(f"impact88 {__version__}")
        return 0
    if name in GONE:
        raise UserError(f"{name} is not a command any more; use {GONE[name]}")
    check_names([name], COMMANDS, "command")
    return _run(name, words)


def _run(name: str, words: Sequence[str]) -> int:
    """Run a command, or print its help."""
    module = import_module(f".{name}", __package__)
    parser = Parser(f"impact88 {name}", allow_abbrev=False)
    for names, keywords in module.OPTIONS:
        parser.add_argument(*names, **keywords)
    if {*HELP} & {*words}:
        print(f"{module.__doc__}\n\n{parser.format_help()}", end="")
        return 0
    args, unknown = parser.parse_known_args(words)
    if unknown:
        options = [option for names, _ in module.OPTIONS for option in names]
        word = unknown[0].partition("=")[0].replace("--outputs", "--results")  # its name in 0.3
        hint = did_you_mean(word, options)
        parser.error(f"unrecognized arguments: {' '.join(unknown)}{hint}")
    check_files(args)
    with printing_to("-" if hasattr(module, "WRITES") else getattr(args, "output", "-")):
        return int(module.main(args) or 0)


def _prepare_streams() -> None:
    """Make the output UTF-8 whatever the locale. Raises UserError if a stream is closed."""
    if None in (sys.stdin, sys.stdout, sys.stderr):
        raise UserError("a standard stream is closed; expected input, output and errors")
    sys.stdout.reconfigure(encoding="utf-8", errors=ESCAPED)  # type: ignore[union-attr]
    sys.stderr.reconfigure(errors=ESCAPED)  # type: ignore[union-attr]


def _discard_output() -> None:
    """Send what Python would still flush to nowhere: it would complain again."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
