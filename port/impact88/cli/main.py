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

from ..errors import UserError, note, one_line
from ..files import ESCAPED
from ..names import did_you_mean
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
OVERVIEW = """\
usage: impact88 COMMAND [options]

R. M. Brach's 1988 program for the planar impact of two vehicles, digit for digit, and the same
mechanics for today's work.

{commands}

impact88 help COMMAND gives examples and options.
exit status: 0 done, 1 adverse result, 2 unusable input, 3 internal error"""


class Parser(argparse.ArgumentParser):
    """A parser whose errors are UserErrors, and whose help begins with the command's examples."""

    def error(self, message: str) -> NoReturn:
        """Raise UserError."""
        raise UserError(f"{message} (see {self.prog.replace('impact88', 'impact88 help')})")

    def format_help(self) -> str:
        """Return examples and explanations, then usage and options."""
        examples, self.description = self.description, None
        return f"{examples}\n\n{super().format_help()}"

    def print_help(self, file: object = None) -> None:
        """Print the help; an error of writing is an error."""
        print(self.format_help(), end="")


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
    debug = os.environ.get("IMPACT88_DEBUG") == "1"
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # starting its threads takes 10 ms
    try:
        _prepare_streams()
        with warnings.catch_warnings():
            if not sys.warnoptions and not debug:
                warnings.simplefilter("ignore")  # those of libraries
            status = _dispatch(arguments)
        sys.stdout.flush()
        return status
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        _discard_output()
        return BROKEN_PIPE
    except Exception as error:
        if reason := _reason(error):
            note(command, reason)
            if isinstance(error, OSError):
                _discard_output()
            return UNUSABLE
        _report_internal(command, error, debug)
        return INTERNAL


def _dispatch(arguments: Sequence[str]) -> int:
    """Run the command that the words name. Raises UserError for words that name none."""
    name, *words = arguments or ["help"]
    if name == "help" and words:
        name, *words = [*words, "--help"]
    if name in ("-h", "--help", "help"):
        lines = "\n".join(f"  {command:<11}{meaning}" for command, meaning in COMMANDS.items())
        print(OVERVIEW.format(commands=lines))
        return 0 if arguments else UNUSABLE
    if name in ("-V", "--version"):
        print(f"impact88 {__version__}")
        return 0
    if name in GONE:
        raise UserError(f"{name} is not a command any more; use {GONE[name]}")
    if name not in COMMANDS:
        hint = did_you_mean(name, (*COMMANDS, *GONE))
        raise UserError(
            f"{one_line(name, 60)!r} is not a command{hint} (expected {' '.join(COMMANDS)})"
        )
    return _run(name, words)


def _run(name: str, words: Sequence[str]) -> int:
    """Parse a command's words and run it."""
    module = import_module(f".{name}", __package__)
    parser = Parser(f"impact88 {name}", description=module.__doc__, allow_abbrev=False)
    module.declare(parser)
    try:
        args = parser.parse_args(words)
    except SystemExit:  # the help is printed
        return 0
    check_files(args)
    with suppress(NothingWritten), printing_to(getattr(args, "output", None) or "-"):
        status = int(module.main(args) or 0)
        if status == UNUSABLE:
            raise NothingWritten
    return status


class NothingWritten(Exception):
    """The input was unusable: the output file stays as it is."""


def _prepare_streams() -> None:
    """Make the output UTF-8 whatever the locale, and replace closed streams. Raises UserError if
    standard output is closed."""
    is_closed = sys.stdout is None
    sys.stdin = sys.stdin or open(os.devnull)  # noqa: SIM115
    sys.stderr = sys.stderr or open(os.devnull, "w")  # noqa: SIM115
    sys.stdout = sys.stdout or open(os.devnull, "w")  # noqa: SIM115
    if is_closed:
        raise UserError("standard output is closed; expected somewhere to print the result")
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(encoding="utf-8", errors=ESCAPED)
    if hasattr(sys.stderr, "reconfigure"):
        sys.stderr.reconfigure(errors=ESCAPED)


def _discard_output() -> None:
    """Send what Python would still flush to nowhere: it would complain again."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _reason(error: Exception) -> str | None:
    """Return the message for an error of the input or the system; None for an internal error."""
    if isinstance(error, UserError):
        return str(error)
    if isinstance(error, OSError):
        place = one_line(str(error.filename)) if error.filename else "standard output"
        return f"{place}: {error.strerror or error}"
    if isinstance(error, ModuleNotFoundError):
        package = (error.name or "").partition(".")[0]
        if package in ("", "impact88"):
            return None
        return f"{package} is not installed; expected: pip install {package}"
    if isinstance(error, RecursionError | MemoryError):
        return "the input is too large or nested too deeply; expected a smaller one"
    return None


def _report_internal(command: str | None, error: Exception, debug: bool) -> None:
    """Print an internal error and its place in one line; the traceback on request."""
    import traceback

    frame = traceback.extract_tb(error.__traceback__)[-1]
    if debug:
        traceback.print_exception(error)
    advice = "" if debug else " (IMPACT88_DEBUG=1 prints the traceback)"
    place = f"{os.path.basename(frame.filename)}:{frame.lineno}"
    message = one_line(f"{type(error).__name__}: {error}", 200)
    note(command, f"internal error; please report it: {message} at {place}{advice}")
