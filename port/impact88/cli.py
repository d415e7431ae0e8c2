"""The command line: which command, and what happens to errors.

Exit status: 0 done (``ZERO DETERMINANT`` is a normal END), 1 done with an adverse result (an
Applesoft error, a bad row, a printout that differs), 2 unusable input, 3 a bug of this project.
Control-C, a broken pipe and a signal to leave end with the shell's usual 130, 141 and 128 + signal.
There is never a traceback, unless IMPACT88_DEBUG=1 asks for a bug's.

A command is imported only when it is asked for.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
import warnings
from collections.abc import Collection, Sequence
from contextlib import suppress
from importlib import import_module

from .commands import CHAPTER, COMMANDS, module_of
from .errors import UserError, shown
from .files import ESCAPED
from .signals import BROKEN_PIPE, INTERRUPTED, Terminated, orderly
from .stderr import note
from .version import __version__

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import IO

UNUSABLE = 2
BUG = 3


class _NothingToKeep(Exception):
    """A command ended with status 2: the file it was writing is not put in place."""


class _Parser(argparse.ArgumentParser):
    """argparse's errors in this project's form: one line, status 2."""

    def error(self, message: str) -> None:  # type: ignore[override]
        raise UserError(f"{message}{self._hint(message)} (see {self.prog} --help)")

    def _hint(self, message: str) -> str:
        """The option or the choice that a misspelled word comes near to."""
        from .names import did_you_mean

        if found := re.search(r"unrecognized arguments: (-[^\s=]+)", message):
            return did_you_mean(found[1], self._option_string_actions)
        if found := re.search(r"invalid choice: '([^']*)'", message):
            choices = [c for action in self._actions for c in action.choices or ()]
            return did_you_mean(found[1], [c for c in choices if isinstance(c, str)])
        return ""

    def _print_message(self, message: str, file: IO[str] | None = None) -> None:  # type: ignore[override]
        """argparse swallows what goes wrong here, and a full disk would look like success."""
        if message:
            (file or sys.stderr).write(message)


def _dispatch(arguments: Sequence[str]) -> int:
    if not arguments:
        raise UserError("no command given (see impact88 --help)")
    name, *rest = arguments
    if name == "help" and rest:  # help COMMAND is COMMAND --help
        name, *rest = [*rest, "--help"]
    if name in ("-V", "--version"):
        print(f"impact88 {__version__}")
        return 0
    if name in ("-h", "--help", "help"):
        from .commands.helptext import overview

        print(overview())
        return 0
    known: Collection[str] = [*COMMANDS, "chapter"]
    if name == "chapter":
        if not rest or rest[0] in ("-h", "--help"):
            from .commands.helptext import chapter_overview

            print(chapter_overview())
            return 0
        name, *rest = rest
        known = CHAPTER
    if name not in known:
        from .names import did_you_mean

        hint = did_you_mean(name, known)
        raise UserError(f"{name!r} is not a command{hint} (expected one of: {' '.join(known)})")
    return _run(name, rest)


def _run(name: str, arguments: Sequence[str]) -> int:
    module = import_module(module_of(name))
    from .commands import options
    from .commands.helptext import Formatter

    parser = _Parser(
        prog=f"impact88 chapter {name}" if name in CHAPTER else f"impact88 {name}",
        description=f"{COMMANDS[name][0].upper()}{COMMANDS[name][1:]}.",
        epilog=module.__doc__,
        formatter_class=Formatter,
    )
    options.declare(parser, module.ARGUMENTS)
    try:
        args = parser.parse_args(arguments)
    except SystemExit:  # --help has been printed
        return 0
    options.check_files(parser, args)
    with suppress(_NothingToKeep), options.output_of(args, module.ARGUMENTS):
        status = int(module.main(args))
        if status == UNUSABLE:
            raise _NothingToKeep
    return status


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
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _speak_any_character() -> None:
    """The result is UTF-8 whatever the locale, so that a file made by ``>`` is one this project
    reads; and no character of a file's name, an id or a unit is an error on a terminal that lacks
    it."""
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(encoding="utf-8", errors=ESCAPED)
    if hasattr(sys.stderr, "reconfigure"):
        sys.stderr.reconfigure(errors=ESCAPED)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit status."""
    arguments = sys.argv[1:] if arguments is None else arguments
    called = next((word for word in arguments[:2] if word in COMMANDS), None)
    debug = os.environ.get("IMPACT88_DEBUG") == "1"
    with orderly(), warnings.catch_warnings():
        if not sys.warnoptions and not debug:
            # a library's warnings are not for the user's terminal
            warnings.simplefilter("ignore")
        status = _status(arguments, called, debug)
    return status


def _status(arguments: Sequence[str], called: str | None, debug: bool) -> int:
    """Run one command, and make one line and a status of whatever ends it."""
    try:
        try:
            _open_closed_streams()
            _speak_any_character()
            status = _dispatch(arguments)
        except UserError as error:
            note(called, str(error))
            status = UNUSABLE
        except ModuleNotFoundError as error:
            package = (error.name or "").partition(".")[0]
            if package in ("", "impact88"):
                raise
            note(called, f"{package} is not installed; expected: pip install {package}")
            status = UNUSABLE
        except RecursionError:
            note(called, "the input is nested too deeply; expected a simpler one")
            status = UNUSABLE
        except Exception as error:
            if not _lacks_memory(error):
                raise
            note(called, "not enough memory; expected a smaller input, or more memory")
            status = UNUSABLE
        sys.stdout.flush()
    except KeyboardInterrupt:
        with suppress(ValueError):
            if sys.stderr.isatty():
                print(file=sys.stderr)  # the shell's prompt comes on a line of its own
        return INTERRUPTED
    except Terminated as signal:
        _drop_output()
        return signal.status
    except BrokenPipeError:
        _drop_output()
        return BROKEN_PIPE
    except OSError as error:  # a full disk, most likely
        place = shown(str(error.filename)) if error.filename else "standard output"
        note(called, f"{place}: {error.strerror or error}")
        _drop_output()
        return UNUSABLE
    except Exception as error:
        _tell_bug(called, error, debug)
        return BUG
    return status


def _lacks_memory(error: Exception) -> bool:
    """Whether a library, or the stack of a thread, did not fit into memory."""
    return isinstance(error, MemoryError) or any(
        words in str(error)
        for words in ("start new thread", "launch worker thread", "failed to map segment")
    )


def _tell_bug(called: str | None, error: Exception, debug: bool) -> None:
    """Say that it is ours, and where, in one line; the whole traceback on request."""
    if debug:
        import traceback

        traceback.print_exception(error)
    step = error.__traceback__
    while step is not None and step.tb_next is not None:
        step = step.tb_next
    place = ""
    if step is not None:
        place = f" at {os.path.basename(step.tb_frame.f_code.co_filename)}:{step.tb_lineno}"
    what = shown(f"{type(error).__name__}{f': {error}' if str(error) else ''}", 200)
    note(
        called,
        f"a bug of impact88, not of your input: {what}{place}"
        f"{'' if debug else ' (IMPACT88_DEBUG=1 prints the traceback)'}",
    )
