"""impact88 basic                          the restored listing at the ] prompt
impact88 basic crash.bas < replies.txt  run a program, its INPUT from a file
impact88 basic crash.bas --prompt       run it and stay at the prompt

The ] prompt of an Apple II Plus: LIST the listing, retype a line, RUN. FILE.bas holds numbered
lines as typed or as LIST prints them, or a tokenised program. At the prompt LOAD FILE reads one and
SAVE FILE writes text; control-C breaks a program, control-D leaves (Windows: control-Z, RETURN).
Graphics, tape, paddles and machine code end in ?SYNTAX ERROR; disk commands are passed over; both
are named on stderr.

exit status: 0 the program ended, 1 an Applesoft error or --max-statements reached, 2 bad input"""

from __future__ import annotations

import os
import select
import signal
import sys
from contextlib import ExitStack, suppress

from ..apple.applesoft.console import EndOfInput
from ..apple.applesoft.errorcodes import ApplesoftError
from ..apple.emulator.emulator import Applesoft
from ..apple.emulator.faults import TooManyStatements
from ..apple.emulator.programfile import read_program
from ..errors import UserError, note
from ..files import display_name, packaged_bytes, read_bytes, replacing, typed_line
from ..program.run import page
from . import options
from .run import add_devices, check_slot

LISTING = "impact.bas"
SLOT_LINE = '190 P$ = "PR# " + "{}"'
MAX_PROGRAM_BYTES = 1_000_000  # 48K hold some 50,000
MAX_ROW = 200  # characters of the output's last row that are kept
LEAVE = "control-Z and RETURN leave" if sys.platform == "win32" else "control-D leaves"
BANNER = (
    "impact88 basic: an Apple II Plus. LIST shows the program, RUN starts it, SAVE FILE and "
    f"LOAD FILE keep one; {LEAVE}."
)
TAPE = "there is no tape; at the prompt, with DOS, SAVE FILE and LOAD FILE keep a program"


def declare(parser: options.Parser) -> None:
    """Add the arguments."""
    parser.add_argument(
        "program",
        nargs="?",
        type=options.InputPath,
        metavar="FILE.bas",
        help="a program to run; - is standard input",
    )
    parser.add_argument("--prompt", action="store_true", help="stay at the prompt after FILE.bas")
    parser.add_argument(
        "--max-statements",
        type=options.whole_number(1, 10**12),
        metavar="N",
        help="stop a program after N statements",
    )
    add_devices(parser)


class Terminal:
    """Standard input as the keyboard, standard output as the screen.

    Parameters
    ----------
    raw : bool
        True to print control characters to a pipe or file.
    """

    def __init__(self, raw: bool) -> None:
        self.is_typed = sys.stdin.isatty()
        self.is_waiting = False
        self.last_line = ""
        self._raw, self._is_screen = raw, sys.stdout.isatty()
        self._row = ""  # the last row of the output
        if self.is_typed:
            with suppress(ImportError):
                import readline  # noqa: F401  (line editing and history in input())

    @property
    def has_person(self) -> bool:
        """True if a person types and reads."""
        return self.is_typed and self._is_screen

    def show(self, text: str) -> None:
        """Print characters: on a terminal without controls that it would act on."""
        self._row = (self._row + text).rpartition("\n")[2][-MAX_ROW:]
        if self._is_screen:
            text = "".join(c for c in text if c >= " " or c in "\n\a\b")
        elif not self._raw:
            text = page(text)
        sys.stdout.write(text)

    def read(self) -> str | None:
        """Return the next line typed, None at the end."""
        sys.stdout.flush()
        self.is_waiting = True
        try:
            line = self._edited_line() if self.is_typed else typed_line()
        finally:
            self.is_waiting = False
        self.last_line = line or ""
        return line

    def is_ready(self) -> bool:
        """Return True if a program that looks for a key finds one."""
        if not self.is_typed:
            return True
        with suppress(OSError, ValueError):  # a stream that cannot be waited for
            return bool(select.select([sys.stdin], [], [], 0)[0])
        return False

    def _edited_line(self) -> str | None:
        """Return a line typed with editing; the last row is its prompt, to stay visible."""
        prompt = "".join(c for c in self._row if c >= " ")
        self._row = ""
        if prompt:
            print(end="\r", flush=True)
        try:
            return input(prompt)
        except EOFError:
            return None
        except UnicodeDecodeError:
            raise UserError("contains bytes that are not text", display_name("-")) from None

    def end_row(self) -> None:
        """Begin a new row of the output."""
        print(end="\n" if self._row else "", flush=True)


def main(args: options.Args) -> int:
    """Run a program, or stay at the prompt."""
    if args.prompt and not args.program:
        raise UserError("--prompt needs FILE.bas; without a file the prompt appears anyway")
    check_slot(args)
    terminal = Terminal(args.raw)
    with ExitStack() as stack:
        printer = stack.enter_context(replacing(args.printer)).write if args.printer else None
        apple = Applesoft(
            terminal.read,
            terminal.show,
            printer,
            dos=not args.no_dos,
            echo=not terminal.is_typed,
        )
        apple.machine.console.ready = terminal.is_ready
        apple.machine.statements_left = args.max_statements
        stack.callback(_name_unsupported, apple)
        load_program(apple, args.program)
        if args.slot and args.program:
            apple.machine.console.slot = args.slot
        elif args.slot:
            apple.enter(SLOT_LINE.format(args.slot))
        _break_on_interrupt(apple, terminal, stack)
        try:
            status = _run_file(apple, terminal, args.prompt) if args.program else 0
            if args.prompt or not args.program:
                _stay_at_prompt(apple, terminal, args)
        except TooManyStatements:
            terminal.end_row()
            note("basic", f"stopped after {args.max_statements} statements")
            return 1
        return status


def _break_on_interrupt(apple: Applesoft, terminal: Terminal, stack: ExitStack) -> None:
    """Make control-C break the program between two statements, or end what is being typed."""

    def interrupt(number: int, frame: object) -> None:
        if terminal.is_waiting:
            raise KeyboardInterrupt
        apple.machine.interrupted = True

    with suppress(ValueError):  # not the main thread
        stack.callback(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, interrupt))


def _stay_at_prompt(apple: Applesoft, terminal: Terminal, args: options.Args) -> None:
    """Execute what is typed until the input ends."""
    if terminal.has_person:
        print(BANNER)
    own_files = {os.path.realpath(args.program)} if args.program else set()
    paper = os.path.realpath(args.printer) if args.printer else ""

    def is_disk_command(line: str) -> bool:
        return not args.no_dos and _disk_command(apple, terminal, own_files, paper)

    apple.prompt(is_disk_command)
    print()


def _name_unsupported(apple: Applesoft) -> None:
    """Name on stderr what a program asked for in vain."""
    for feature in apple.machine.refused:
        reason = TAPE if feature in ("LOAD", "SAVE") else "text only, no machine code"
        note("basic", f"{feature} is not supported: {reason}")
    for sentence in apple.machine.ignored:
        note("basic", sentence)


def load_program(apple: Applesoft, path: str | None) -> None:
    """Load a file, or the restored listing. Raises UserError for a file that is not a program."""
    if path is None:
        data, source = packaged_bytes("impact88.legacy", LISTING), LISTING
    else:
        data, source = read_bytes(path, limit=MAX_PROGRAM_BYTES), display_name(path)
    try:
        program = read_program(data)
        apple.machine.load(program.lines)
    except UserError as error:
        raise UserError(f"{error}; expected a program, one numbered line a row", source) from None
    except ApplesoftError:
        raise UserError("does not fit into 48K", source) from None
    for remark in program.remarks:
        note("basic", f"{source}: {remark}")


def save_program(apple: Applesoft, path: str, own_files: set[str], paper: str) -> None:
    """Write the program as text. Raises UserError for the printer's ``paper``, and for an existing
    file that is not among ``own_files`` (real paths)."""
    target = os.path.realpath(path)
    if target not in own_files and (os.path.exists(path) or target == paper):
        raise UserError("was neither loaded nor saved in this session; expected a new file", path)
    text = apple.source()
    with replacing(path) as file:
        file.write(text)
    try:
        is_whole = [*read_program(text).lines] == [*apple.machine.lines()]
    except UserError:
        is_whole = False
    note("basic", f"{path}: {'saved' if is_whole else 'text cannot hold this program as it is'}")


def _run_file(apple: Applesoft, terminal: Terminal, is_staying: bool) -> int:
    """Run the program that is loaded and return the exit status."""
    try:
        error = apple.run()
    except EndOfInput:
        terminal.end_row()
        raise UserError(
            "the input ended while the program asked for more; expected a line for every INPUT"
        ) from None
    except KeyboardInterrupt:
        if not is_staying:
            raise
    if is_staying:
        return 0
    if not (apple.machine.broken and sys.stderr.isatty()):
        terminal.end_row()
    if apple.machine.broken:
        raise KeyboardInterrupt  # the printer's file stays as it was
    return int(error is not None)


def _disk_command(apple: Applesoft, terminal: Terminal, own_files: set[str], paper: str) -> bool:
    """Do LOAD and SAVE, which the disk system takes. Returns False for any other line."""
    word, _, name = terminal.last_line.strip().partition(" ")
    word, name = word.upper(), name.strip()
    if word not in ("LOAD", "SAVE"):
        return False
    name = name.strip('"')
    try:
        if not name:
            raise UserError(f"{word} needs a file's name: {word} mine.bas")
        if word == "LOAD":
            load_program(apple, name)
        else:
            save_program(apple, name, own_files, paper)
        own_files.add(os.path.realpath(name))
    except UserError as error:
        note("basic", str(error))
    return True
