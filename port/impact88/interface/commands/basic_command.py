"""The ] prompt of an Apple II Plus with the restored listing loaded: LIST it, retype a line, RUN.
With a file: load that program, run it, and leave when it ends.

FILE holds numbered lines as they are typed or as LIST prints them, in rows of any width, or a
tokenised program as disk tools extract it. At the prompt LOAD FILE reads such a file and SAVE FILE
writes text, over no file but one that was loaded or saved before (not with --no-dos); control-C
breaks a running program, control-D leaves. Graphics, tape, paddles, shapes and machine code are
tokenised and listed, but not done: ?SYNTAX ERROR. There is no disk: a program's disk commands are
passed over. Either is said on stderr at the end.

examples:
  impact88 basic                          the restored listing at the prompt
  impact88 basic crash.bas < replies.txt  run a program, its INPUT from a file
  impact88 basic crash.bas --prompt       run it and stay

exit status: 0 the program ended; 1 an Applesoft error, or more than --max-statements; 2 bad input
"""

import os
import select
import signal
import sys
from collections.abc import Set
from contextlib import ExitStack, suppress
from stat import S_ISREG
from typing import IO

from ...apple.applesoft.console import EndOfInput
from ...apple.applesoft.errorcodes import ApplesoftError
from ...apple.emulator.emulator import Applesoft
from ...apple.emulator.faults import TooManyStatements
from ...apple.emulator.programfile import read_program
from ...errors import UserError, note
from ...files import display_name, packaged_bytes, read_bytes, replacing, typed_line
from ...program.run import page
from . import options
from .run_command import MACHINE, check_slot

LISTING = "impact.bas"
SLOT_LINE = '190 P$ = "PR# " + "{}"'
PROGRAM_LIMIT = 1_000_000
"""Bytes of a program's text; 48K hold some 50,000, so that twice as many change no answer."""
LEAVE = "control-Z and RETURN leave" if sys.platform == "win32" else "control-D leaves"
BANNER = (
    "impact88 basic: an Apple II Plus. LIST shows the program, RUN starts {}, SAVE FILE and "
    f"LOAD FILE keep one; {LEAVE}."
)

TAPE = "there is no tape; at the prompt, with DOS, SAVE FILE and LOAD FILE keep a program"

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
            text = "".join(c for c in text if c >= " " or c in "\n\a\b")
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

    def ready(self) -> bool:
        """Return whether a program that looks for a key finds one.

        A file or a pipe has them waiting, a terminal what has been typed with RETURN.
        """
        if not self.typing:
            return True
        with suppress(OSError, ValueError):  # no file that can be waited for
            return bool(select.select([sys.stdin], [], [], 0)[0])
        return False

    def _ask(self) -> str | None:
        """A line with the terminal's editing; what stands in the row is given as the prompt, so
        that editing does not wipe it out."""
        prompt = "".join(c for c in self.row if c >= " ")
        self.row = ""
        if prompt:
            print(end="\r", flush=True)
        try:
            return input(prompt)
        except EOFError:
            return None
        except UnicodeDecodeError:
            raise UserError("contains bytes that are not text", display_name("-")) from None

    def end_row(self) -> None:
        """Begin a new row, unless that is done."""
        print(end="\n" if self.row else "", flush=True)


def main(args: options.Args) -> int:
    if args.prompt and not args.program:
        raise UserError("--prompt needs FILE.bas; without a file the prompt appears anyway")
    check_slot(args)
    terminal = Terminal(raw=args.raw)
    with ExitStack() as stack:
        printer = stack.enter_context(replacing(args.printer)).write if args.printer else None
        machine = Applesoft(
            terminal.read, terminal.show, printer, dos=not args.no_dos, echo=not terminal.typing
        )

        machine.machine.console.ready = terminal.ready
        stack.callback(_say_what_was_not_done, machine)

        def interrupt(number: int, frame: object) -> None:
            """Break the program between two statements, or what is being typed."""
            if terminal.waiting:
                raise KeyboardInterrupt
            machine.machine.interrupted = True

        machine.machine.statements_left = args.max_statements
        load_program(machine, args.program)
        if args.slot and args.program:
            machine.machine.console.slot = args.slot
        elif args.slot:
            machine.enter(SLOT_LINE.format(args.slot))
        stack.callback(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, interrupt))
        try:
            status = _run_file(machine, terminal, stay=args.prompt) if args.program else 0
            if args.prompt or not args.program:
                if terminal.person:
                    print(BANNER.format("it" if args.program else "the 1988 listing"))
                files = {os.path.realpath(args.program)} if args.program else set()
                machine.prompt(
                    lambda line: (
                        not args.no_dos and _disk_command(machine, terminal, args.printer, files)
                    )
                )
                print()
        except TooManyStatements:
            terminal.end_row()
            note("basic", f"stopped after {args.max_statements} statements")
            return 1
        return status


def _say_what_was_not_done(machine: Applesoft) -> None:
    for feature in machine.machine.refused:
        reason = TAPE if feature in ("LOAD", "SAVE") else "text only, no machine code"
        note("basic", f"{feature} is not supported: {reason}")
    for sentence in machine.machine.ignored:
        note("basic", sentence)


def load_program(machine: Applesoft, path: str | None) -> None:
    """Load a file, or the restored listing. Raises UserError."""
    if path is None:
        data, source = packaged_bytes("impact88.legacy", LISTING), LISTING
    else:
        data, source = read_bytes(path, limit=PROGRAM_LIMIT), display_name(path)
    try:
        program = read_program(data)
        machine.machine.load(program.lines)
    except UserError as error:
        raise UserError(f"{error}; expected a program, one numbered line a row", source) from None
    except ApplesoftError:
        raise UserError("does not fit into 48K", source) from None
    for remark in program.remarks:
        note("basic", f"{source}: {remark}")


def _same_file(path: str, stream: IO[str]) -> bool:
    """Return whether a stream reads or writes the regular file of that name."""
    try:
        file = os.stat(path)
        return S_ISREG(file.st_mode) and os.path.samestat(file, os.fstat(stream.fileno()))
    except (OSError, ValueError, AttributeError):  # no such file; a stream closed or of no file
        return False


def save_program(machine: Applesoft, path: str, printer: str | None, files: Set[str]) -> None:
    """Write the program as text, and say so on stderr, or that it is not what the machine holds.
    Raises UserError, also for a file that this command reads or writes otherwise, and for one that
    stands there and is none of ``files`` (real paths), which this session loaded or saved."""
    if printer and os.path.realpath(path) == os.path.realpath(printer):
        raise UserError("is the printer's paper; expected another file", path)
    if any(_same_file(path, stream) for stream in (sys.stdin, sys.stdout, sys.stderr)):
        raise UserError("is the input or the output of this command; expected another file", path)
    if os.path.isfile(path) and os.path.realpath(path) not in files:
        raise UserError("was neither loaded nor saved in this session; expected a new file", path)
    text = machine.source()
    with replacing(path) as file:
        file.write(text)
    try:
        lines = read_program(text).lines
    except UserError as error:
        note("basic", f"{path}: text cannot hold this program: {error}")
        return
    new_lines = [line for line in machine.machine.lines() if line not in lines]
    if new_lines:
        note(
            "basic", f"{path}: text cannot hold line {new_lines[0][0]} as it is; LOAD makes another"
        )
    else:
        note("basic", f"{path}: saved, {len(lines)} line{'s' * (len(lines) != 1)}")


def _run_file(machine: Applesoft, terminal: Terminal, *, stay: bool) -> int:
    try:
        error = machine.run()
    except EndOfInput:
        terminal.end_row()
        raise UserError(
            "the input ended while the program asked for more; expected a line for every INPUT"
        ) from None
    except KeyboardInterrupt:
        if not stay:
            raise
    if stay:
        return 0
    if not (machine.machine.broken and sys.stderr.isatty()):  # else the command line ends it
        terminal.end_row()
    if machine.machine.broken:
        raise KeyboardInterrupt  # what the printer had so far replaces nothing
    return int(error is not None)


def _disk_command(
    machine: Applesoft, terminal: Terminal, printer: str | None, files: set[str]
) -> bool:
    """LOAD and SAVE, which the disk system would take; whether the last line was one. ``files``:
    real paths of those that were loaded or saved; this one is added."""
    word, _, name = terminal.last.strip().partition(" ")
    name = name.strip()
    if (word := word.upper()) not in ("LOAD", "SAVE"):
        return False
    if len(name) > 1 and name[0] == name[-1] == '"':
        name = name[1:-1]
    try:
        if not name:
            raise UserError(f"{word} needs a file's name: {word} mine.bas")
        if word == "LOAD":
            load_program(machine, name)
        else:
            save_program(machine, name, printer, files)
        files.add(os.path.realpath(name))
    except UserError as error:
        note("basic", str(error))
    return True
