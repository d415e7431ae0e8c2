"""impact88 basic                          the restored listing at the ] prompt
impact88 basic crash.bas < replies.txt  run a program, its INPUT from a file

The ] prompt of an Apple II Plus: LIST the listing, retype a line, RUN. FILE.bas holds numbered
lines as typed or as LIST prints them, or a tokenised program. At the prompt LOAD FILE reads one;
control-C breaks a program, control-D leaves (Windows: control-Z, RETURN). Graphics, tape, paddles
and machine code end in ?SYNTAX ERROR; disk commands are passed over; both are named on stderr.

exit status: 0 the program ended, 1 an Applesoft error, 2 bad input"""

from __future__ import annotations

import signal
import sys

from ..apple.applesoft.console import EndOfInput
from ..apple.applesoft.errorcodes import ApplesoftError
from ..apple.emulator.emulator import Applesoft
from ..errors import UserError, note
from ..files import display_name, packaged_bytes, read_bytes, typed_line
from ..program.run import page
from .options import Args, input_file
from .output import say

LISTING = "impact.bas"
MAX_PROGRAM_BYTES = 1_000_000  # 48K hold some 50,000
OPTIONS = (input_file("program", "FILE.bas", "run it; - is standard input", nargs="?"),)


class Terminal:
    """An Apple with the terminal as keyboard and screen."""

    def __init__(self) -> None:
        self.line = ""  # the last one typed, small letters included
        echo = not sys.stdin.isatty()
        self.apple = Applesoft(self.read, self.show, dos=True, echo=echo)

    def show(self, text: str) -> None:
        """Print characters, without those that a terminal would act on."""
        sys.stdout.write(page(text))

    def read(self) -> str | None:
        """Return the next line typed, None at the end. Control-C abandons it."""
        handler = signal.signal(signal.SIGINT, signal.default_int_handler)
        try:
            line = typed_line()
        finally:
            signal.signal(signal.SIGINT, handler)
        self.line = line or ""
        return line

    def interrupt(self, *_: object) -> None:
        """Break the program between two statements."""
        self.apple.machine.interrupted = True

    def load(self, data: bytes, source: str) -> None:
        """Load a program. Raises UserError."""
        try:
            self.apple.load(data)
        except (UserError, ApplesoftError) as error:
            advice = "expected a program that fits into 48K, one numbered line a row"
            raise UserError(f"{error}; {advice}", source) from None

    def do_disk_command(self, _: str) -> bool:
        """Do LOAD, which the disk system takes. Returns False for any other line."""
        command, _, name = self.line.strip().partition(" ")
        if command.upper() != "LOAD":
            return False
        try:
            self.load(read_bytes(name, MAX_PROGRAM_BYTES), name)
        except UserError as error:
            note("basic", str(error))
        return True


def main(args: Args) -> int:
    """Run a program, or read lines at the prompt."""
    terminal = Terminal()
    apple = terminal.apple
    if args.program:
        data = read_bytes(args.program, MAX_PROGRAM_BYTES)
        terminal.load(data, display_name(args.program))
    else:
        terminal.load(packaged_bytes("impact88.legacy", LISTING), LISTING)
    handler = signal.signal(signal.SIGINT, terminal.interrupt)
    try:
        if args.program:
            return _run(apple)
        apple.prompt(terminal.do_disk_command)
        print()
        return 0
    finally:
        signal.signal(signal.SIGINT, handler)
        for feature in apple.machine.refused:
            note("basic", f"{feature} is not supported: text only, no tape, no machine code")
        say("basic", apple.machine.ignored)


def _run(apple: Applesoft) -> bool:
    """Run the program that is loaded, and return whether it ended with an error."""
    try:
        error = apple.run()
    except EndOfInput:
        print()
        raise UserError(
            "the input ended while the program asked for more; expected a line for every INPUT"
        ) from None
    if error:
        print()  # the ROM leaves the cursor after the message
    if apple.machine.broken:
        raise KeyboardInterrupt
    return error is not None
