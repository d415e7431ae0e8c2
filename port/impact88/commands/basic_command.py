"""The ] prompt of an Apple II Plus with the restored listing loaded: LIST it, retype a line, RUN.
With a file: load that program, run it, and leave when it ends.

At the prompt LOAD FILE and SAVE FILE read and write program text (not with --no-dos), control-C
breaks a running program, control-D leaves. Graphics, tape, paddles, shapes and machine code are
tokenised and listed, but not done: ?SYNTAX ERROR.

examples:
  impact88 basic                          the restored listing at the prompt
  impact88 basic crash.bas < replies.txt  run a program, its INPUT from a file
  impact88 basic crash.bas --prompt       run it and stay

exit status: 0 the program ended; 1 an Applesoft error, or more than --max-statements; 2 bad input
"""

import argparse
import signal
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from types import FrameType

from ..applesoft.console import EndOfInput
from ..applesoft.errorcodes import ApplesoftError
from ..emulator.emulator import Applesoft
from ..emulator.faults import TooManyStatements
from ..errors import UserError
from ..files import called, packaged_text, read_text, replacing, typed_line
from ..program.run import page
from ..signals import INTERRUPTED
from ..stderr import note
from . import options
from .run_command import MACHINE, check_slot

LISTING = "impact.bas"
SLOT_LINE = '190 P$ = "PR# " + "{}"'
PROGRAM_LIMIT = 1_000_000
"""Bytes of a program's text; 48K hold some 50,000."""
LEAVE = "control-Z and RETURN leave" if sys.platform == "win32" else "control-D leaves"
BANNER = f"impact88 basic: an Apple II Plus. LIST shows the program, {{}}; {LEAVE}."
_SHOWN_CONTROLS = "\n\a\b"


ARGUMENTS = (
    options.reads("program", "FILE.bas", "a program to run", nargs="?"),
    options.flag("--prompt", "stay at the prompt after FILE.bas"),
    options.count("--max-statements", 1, 10**12, "stop a program after N statements"),
    *MACHINE,
)


class Terminal:
    """Standard input as the keyboard, standard output as the screen."""

    def __init__(self, *, raw: bool = False) -> None:
        self.typing = sys.stdin.isatty()
        self.person = self.typing and sys.stdout.isatty()
        self.waiting = False
        self.last = ""
        self._raw = raw
        self._terminal = sys.stdout.isatty()
        self.row = ""  # what stands in the last row of the output
        if self.typing:
            with suppress(ImportError):
                import readline  # noqa: F401  (line editing and history in input())

    def show(self, text: str) -> None:
        """Characters for the screen; a terminal gets no control characters it would act on, a
        pipe or a file the page a person reads, unless --raw asks for all."""
        self.row = (self.row + text).rpartition("\n")[2][-200:]
        if self._terminal:
            text = "".join(c for c in text if c >= " " or c in _SHOWN_CONTROLS)
        elif not self._raw:
            text = page(text)
        sys.stdout.write(text)

    def read(self) -> str | None:
        """The next line typed, None at the end."""
        sys.stdout.flush()
        self.waiting = True
        try:
            line = self._ask() if self.typing else typed_line()
        finally:
            self.waiting = False
        self.last = line or ""
        return line

    def _ask(self) -> str | None:
        """A line with the terminal's editing; what stands in the row is given as the prompt, so
        that editing does not wipe it out."""
        prompt = "".join(c for c in self.row if c >= " ")
        self.row = ""
        if prompt:
            sys.stdout.write("\r")
            sys.stdout.flush()
        try:
            return input(prompt)
        except EOFError:
            return None
        except UnicodeDecodeError:
            raise UserError("contains bytes that are not text", called("-")) from None


@contextmanager
def _interrupts(machine: Applesoft, terminal: Terminal) -> Iterator[None]:
    """Control-C breaks the program between two statements, or what is being typed."""

    def interrupt(number: int, frame: FrameType | None) -> None:
        if terminal.waiting:
            raise KeyboardInterrupt
        machine.machine.interrupted = True

    before = signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def main(args: argparse.Namespace) -> int:
    """Run a program, or talk at the prompt."""
    if args.prompt and not args.program:
        raise UserError("--prompt needs FILE.bas; without a file the prompt appears anyway")
    check_slot(args)
    terminal = Terminal(raw=args.raw)
    with ExitStack() as stack:
        printer = stack.enter_context(replacing(args.printer)).write if args.printer else None
        machine = Applesoft(
            terminal.read, terminal.show, printer, dos=not args.no_dos, echo=not terminal.typing
        )
        machine.machine.statements_left = args.max_statements
        load_program(machine, args.program)
        if args.slot and args.program:
            machine.machine.console.slot = args.slot
        elif args.slot:
            machine.enter(SLOT_LINE.format(args.slot))
        with _interrupts(machine, terminal):
            try:
                status = _session(machine, terminal, args)
                if status == INTERRUPTED and printer is not None:
                    raise KeyboardInterrupt  # what the printer had so far replaces nothing
                return status
            except TooManyStatements:
                _end_row(terminal)
                note("basic", f"stopped after {args.max_statements} statements")
                return 1


def load_program(machine: Applesoft, path: str | None) -> None:
    """Load a file, or the restored listing. Raises UserError."""
    if path is None:
        text, where = packaged_text("impact88.legacy", LISTING), LISTING
    else:
        text, where = read_text(path, limit=PROGRAM_LIMIT), called(path)
    try:
        machine.load(text)
    except ValueError as error:
        raise UserError(f"{error}; expected a program, one numbered line a row", where) from None
    except ApplesoftError:
        raise UserError("does not fit into 48K", where) from None


def _session(machine: Applesoft, terminal: Terminal, args: argparse.Namespace) -> int:
    status = 0
    if args.program:
        status = _run_file(machine, terminal, stay=args.prompt)
    if args.prompt or not args.program:
        if terminal.person:
            print(BANNER.format("RUN starts it" if args.program else "RUN starts the 1988 listing"))
        machine.prompt(None if args.no_dos else lambda line: _disk_command(machine, terminal.last))
        print()
    for what in machine.machine.refused:
        note("basic", f"{what} is not supported: text only, no machine code")
    return status


def _run_file(machine: Applesoft, terminal: Terminal, *, stay: bool) -> int:
    try:
        error = machine.run()
    except EndOfInput:
        _end_row(terminal)
        raise UserError(
            "the input ended while the program asked for more; expected a line for every INPUT"
        ) from None
    except KeyboardInterrupt:
        return INTERRUPTED
    if not stay:
        _end_row(terminal)
    if machine.machine.broken:
        return 0 if stay else INTERRUPTED
    return 1 if error and not stay else 0


def _end_row(terminal: Terminal) -> None:
    if terminal.row:
        print()
    sys.stdout.flush()


def _disk_command(machine: Applesoft, line: str) -> bool:
    """LOAD and SAVE, which the disk system would take; whether the line was one."""
    word, _, name = line.strip().partition(" ")
    name = name.strip()
    if word.upper() not in ("LOAD", "SAVE") or not name:
        return False
    try:
        if word.upper() == "LOAD":
            load_program(machine, name)
        else:
            with replacing(name) as file:
                file.write(machine.source())
    except UserError as error:
        note("basic", str(error))
    return True
