"""The command line: which command, imported only then, and what happens to errors.

Exit status: 0 done (``ZERO DETERMINANT`` is a normal END), 1 done with an adverse result, 2
unusable input, 3 a bug of this project; control-C, a broken pipe and a signal to leave end with the
shell's 130, 141 and 128 + signal. There is no traceback, unless IMPACT88_DEBUG=1 asks for a bug's.
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
from .names import did_you_mean
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
        hint, known = "", list(self._option_string_actions)
        word = re.search(r"unrecognized arguments: (-[^\s=]+)", message)
        if word is None and (word := re.search(r"invalid choice: '([^']*)'", message)):
            known = [c for a in self._actions for c in a.choices or () if isinstance(c, str)]
        if word:
            hint = did_you_mean(word[1], known)
        raise UserError(f"{message}{hint} (see {self.prog} --help)")

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


def _prepare_streams() -> None:
    """Make a stream that the shell closed (``2>&-``, None in Python) read or write nothing. The
    result is UTF-8 whatever the locale, so that a file made by ``>`` is one this project reads; and
    no character is an error on a terminal that lacks it. Raises UserError when standard output is
    closed: the result would be lost without a word."""
    closed = sys.stdout is None
    sys.stdin = sys.stdin or open(os.devnull)  # noqa: SIM115
    sys.stderr = sys.stderr or open(os.devnull, "w")  # noqa: SIM115
    sys.stdout = sys.stdout or open(os.devnull, "w")  # noqa: SIM115
    if closed:
        raise UserError("standard output is closed; expected somewhere to print the result")
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(encoding="utf-8", errors=ESCAPED)
    if hasattr(sys.stderr, "reconfigure"):
        sys.stderr.reconfigure(errors=ESCAPED)


def _drop_output() -> None:
    """Let stdout lead nowhere: on its way out the interpreter would flush, and complain, again."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit status."""
    arguments = sys.argv[1:] if arguments is None else arguments
    called = next((word for word in arguments[:2] if word in COMMANDS), None)
    debug = os.environ.get("IMPACT88_DEBUG") == "1"
    with orderly(), warnings.catch_warnings():
        if not sys.warnoptions and not debug:
            # a library's warnings are not for the user's terminal
            warnings.simplefilter("ignore")
        try:
            status = _status(arguments, called)
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
            _report_bug(called, error, debug)
            return BUG
    return status


def _status(arguments: Sequence[str], called: str | None) -> int:
    """Run one command; what is the input's fault, or the machine's, is one line and a status."""
    try:
        _prepare_streams()
        return _dispatch(arguments)
    except UserError as error:
        note(called, str(error))
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if package in ("", "impact88"):
            raise
        note(called, f"{package} is not installed; expected: pip install {package}")
    except RecursionError:
        note(called, "the input is nested too deeply; expected a simpler one")
    except Exception as error:
        # a library, or the stack of a thread
        words = ("start new thread", "launch worker thread", "failed to map segment")
        if not isinstance(error, MemoryError) and not any(text in str(error) for text in words):
            raise
        note(called, "not enough memory; expected a smaller input, or more memory")
    return UNUSABLE


def _report_bug(called: str | None, error: Exception, debug: bool) -> None:
    """One line on a bug of ours and where it is; the whole traceback on request."""
    if debug:
        import traceback

        traceback.print_exception(error)
    step, place = error.__traceback__, ""
    while step is not None:
        place = f" at {os.path.basename(step.tb_frame.f_code.co_filename)}:{step.tb_lineno}"
        step = step.tb_next
    what = shown(f"{type(error).__name__}{f': {error}' if str(error) else ''}", 200)
    advice = "" if debug else " (IMPACT88_DEBUG=1 prints the traceback)"
    note(called, f"a bug of impact88, not of your input: {what}{place}{advice}")
