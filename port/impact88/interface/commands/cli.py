"""The command line: which command, imported only then, and what happens to errors.

Exit status: 0 done (``ZERO DETERMINANT`` is a normal END), 1 done with an adverse result, 2
unusable input, 3 an internal error; control-C, a broken pipe and a signal to leave end with the
shell's 130, 141 and 128 + signal. There is no traceback, unless IMPACT88_DEBUG=1 asks for a bug's.
"""

import argparse
import gc
import os
import re
import signal
import sys
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from importlib import import_module

from ...errors import UserError, note, one_line
from ...files import ESCAPED
from ...names import did_you_mean
from ...version import __version__
from . import CHAPTER, COMMANDS, module_of

UNUSABLE = 2
BUG = 3
INTERRUPTED = 128 + signal.SIGINT
BROKEN_PIPE = 141
_ALLOCATIONS_PER_COLLECTION = 10_000
"""Objects made, less those freed, until the garbage collector runs; Python's default is 700."""


class _NothingToKeep(Exception):
    """A command ended with status 2: the file it was writing is not put in place."""


class _Terminated(BaseException):
    """The process was asked to leave; the argument is the signal."""


class _Parser(argparse.ArgumentParser):
    """argparse's errors in this project's form: one line, status 2."""

    def error(self, message: str) -> None:  # type: ignore[override]
        hint, choices = "", list(self._option_string_actions)
        word = re.search(r"unrecognized arguments: (-[^\s=]+)", message)
        if word is None and (word := re.search(r"invalid choice: '([^']*)'", message)):
            choices = [c for a in self._actions for c in a.choices or () if isinstance(c, str)]
        if word:
            hint = did_you_mean(word[1], choices)
        raise UserError(f"{message}{hint} (see {self.prog} --help)")

    def print_help(self, file: object = None) -> None:
        """argparse's own swallows what goes wrong: a full disk would look like success."""
        print(self.format_help(), end="")


def _dispatch(arguments: Sequence[str]) -> int:
    if not arguments:
        raise UserError("no command given (see impact88 --help)")
    name, *arguments_left = arguments
    if name == "help" and arguments_left:  # help COMMAND is COMMAND --help
        name, *arguments_left = [*arguments_left, "--help"]
    commands = [*COMMANDS, "chapter"]
    names = [command for command in COMMANDS if command not in CHAPTER] + ["chapter"]
    page = "overview" if name in ("-h", "--help", "help") else ""
    if name == "chapter":
        name, *arguments_left = arguments_left or ["--help"]
        commands = names = [*CHAPTER]
        page = "chapter_overview" if name in ("-h", "--help") else ""
    if page:
        print(getattr(import_module(".helptext", __package__), page)())
    elif name in ("-V", "--version"):
        print(f"impact88 {__version__}")
    elif name in commands:
        return _run(name, arguments_left)
    else:
        hint = did_you_mean(name, commands)
        raise UserError(f"{name!r} is not a command{hint} (expected one of: {' '.join(names)})")
    return 0


def _run(name: str, arguments: Sequence[str]) -> int:
    module = import_module(module_of(name))
    from ...collision.scenefile import known_template
    from . import options
    from .helptext import Formatter

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
    status = 0
    with suppress(_NothingToKeep), options.output_of(args, module.ARGUMENTS):
        if getattr(args, "template", False) and hasattr(module, "KNOWABLE"):
            print(known_template(module.KNOWABLE))
        elif (status := int(module.main(args) or 0)) == UNUSABLE:
            raise _NothingToKeep
    return status


def _prepare_streams() -> None:
    """Make a stream that the shell closed (``2>&-``, None in Python) read or write nothing. The
    result is UTF-8 whatever the locale, so that a file made by ``>`` is one this project reads; and
    no character is an error on a terminal that lacks it. Raises UserError when standard output is
    closed: the result would be lost without a word."""
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


def _leave(number: int, frame: object) -> None:
    signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt if number == signal.SIGINT else _Terminated(number)


@contextmanager
def _orderly() -> Iterator[None]:
    """Within, control-C is a KeyboardInterrupt once, SIGTERM and SIGHUP are `_Terminated`: they
    would end Python on the spot, with half-written files left beside their names. A signal that the
    caller ignores (nohup, a shell's background job) or handles stays as it is. Outside the main
    thread, where Python takes no handlers, nothing changes."""
    usual = {"SIGINT": signal.default_int_handler, "SIGTERM": signal.SIG_DFL}
    usual["SIGHUP"] = signal.SIG_DFL  # none on Windows
    old_handlers = {}
    with suppress(ValueError):  # not the main thread
        for name, handler in usual.items():
            number = getattr(signal, name, None)
            if number is not None and signal.getsignal(number) == handler:
                old_handlers[number] = signal.signal(number, _leave)
    try:
        yield
    finally:
        for number, handler in old_handlers.items():
            signal.signal(number, handler)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit status.

    Without ``arguments`` those of the process, which then is this command's alone: garbage is
    collected seldom, and not at its end.
    """
    if arguments is None:
        # what a command imports stays: searching it again and again takes a tenth of a short run
        gc.set_threshold(_ALLOCATIONS_PER_COLLECTION)
        try:
            return main(sys.argv[1:])
        finally:
            gc.freeze()
    command = next((word for word in arguments[:2] if word in COMMANDS), None)
    debug = os.environ.get("IMPACT88_DEBUG") == "1"
    # numpy's BLAS starts a thread for every processor as it is loaded: 10 ms, and of no use to
    # systems of 6 by 6
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    with _orderly(), warnings.catch_warnings():
        if not sys.warnoptions and not debug:
            # a library's warnings are not for the user's terminal
            warnings.simplefilter("ignore")
        try:
            try:
                _prepare_streams()
                status = _dispatch(arguments)
            except Exception as error:
                if not (reason := _reason(error)):
                    raise
                note(command, reason)
                status = UNUSABLE
            sys.stdout.flush()
            return status
        except KeyboardInterrupt:
            with suppress(ValueError):
                if sys.stderr.isatty():
                    print(file=sys.stderr)  # the shell's prompt comes on a line of its own
            return INTERRUPTED
        except _Terminated as stop:
            status = 128 + stop.args[0]
        except BrokenPipeError:
            status = BROKEN_PIPE
        except OSError as error:  # a full disk, most likely
            place = one_line(str(error.filename)) if error.filename else "standard output"
            note(command, f"{place}: {error.strerror or error}")
            status = UNUSABLE
        except Exception as error:
            _report_bug(command, error, debug)
            return BUG
        with suppress(OSError, ValueError):
            # on its way out the interpreter would flush, and complain, again
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return status


def _reason(error: Exception) -> str | None:
    """Return the message for an error that the input or the machine caused; None for a bug."""
    if isinstance(error, UserError):
        return str(error)
    if isinstance(error, ModuleNotFoundError):
        package, _, wing = (error.name or "").partition(".")
        if package == "impact88" and wing and "." not in wing:
            return f"impact88.{wing} is not installed; expected: the whole package"
        if package in ("", "impact88"):
            return None
        return f"{package} is not installed; expected: pip install {package}"
    if isinstance(error, RecursionError):
        return "the input is nested too deeply; expected a simpler one"
    # of a library, or for the stack of a thread
    words = ("start new thread", "launch worker thread", "failed to map segment")
    if isinstance(error, MemoryError) or any(text in str(error) for text in words):
        return "not enough memory; expected a smaller input, or more memory"
    return None


def _report_bug(called: str | None, error: Exception, debug: bool) -> None:
    """Report an internal error and its place in one line; the whole traceback on request."""
    if debug:
        import traceback

        traceback.print_exception(error)
    step, place = error.__traceback__, ""
    while step is not None:
        place = f" at {os.path.basename(step.tb_frame.f_code.co_filename)}:{step.tb_lineno}"
        step = step.tb_next
    description = one_line(f"{type(error).__name__}{f': {error}' if str(error) else ''}", 200)
    advice = "" if debug else " (IMPACT88_DEBUG=1 prints the traceback)"
    note(called, f"internal error; please report it: {description}{place}{advice}")
