"""The emulated machine as a Python object."""

from collections import deque
from collections.abc import Callable
from functools import partial
from math import prod
from typing import Any

from ..applesoft.console import (
    MAX_INPUT,
    Device,
    EndOfInput,
    Keyboard,
    Keys,
    capitals,
    keyboard_codes,
)
from ..applesoft.errorcodes import ApplesoftError
from ..applesoft.real import to_stored
from .faults import Fault, Restart
from .machine import Machine
from .memory import AFTER_TYPING, INPUT_BUFFER, INTEGER, MARKS, STRING
from .memory import PROMPT as PROMPT_BYTE
from .programfile import read_program
from .tokens import detokenise, split_number, tokenise

PROMPT = "]"
AT_PROMPT = ord(PROMPT) | 0x80


class Applesoft:
    """An Apple II Plus at the ``]`` prompt.

    The attributes ``after_line``, ``statements_left`` and ``interrupted`` of its ``machine`` may be
    set.

    Parameters
    ----------
    keyboard : callable, optional
        Returns the next line after those queued by `feed`, None at the end.
    screen : callable, optional
        Called with the characters sent to it, or to a printer in slot 1. Without it, `take_output`
        returns them.
    dos : bool, default False
        True if a disk system handles lines that begin with control-D.
    echo : bool, default True
        True if typed lines are part of the output.
    blanks : bool, default True
        True if skipped columns are sent as blanks.

    Examples
    --------
    >>> apple = impact88.Applesoft()
    >>> apple.load("10 INPUT A: PRINT INT (100 * A)")
    >>> apple.feed("14.52")
    >>> apple.run()
    >>> apple.take_output()
    '?\\x0014.52\\n1451\\n'
    >>> apple.reals()
    {'A': '846851eb85'}
    """

    def __init__(
        self,
        keyboard: Keyboard | None = None,
        screen: Device | None = None,
        *,
        dos: bool = False,
        echo: bool = True,
        blanks: bool = True,
    ) -> None:
        self._queue: deque[str] = deque()
        self._keyboard = keyboard
        self._output: list[str] = []
        device = screen or self._output.append
        self.machine = Machine(self._next_line, device, blanks, dos=dos, echo=echo)

    def _next_line(self) -> str | None:
        if self._queue:
            return self._queue.popleft()
        return self._keyboard() if self._keyboard else None

    def feed(self, *lines: str) -> None:
        """Queue lines to be typed, for INPUT, GET or the prompt.

        Parameters
        ----------
        *lines : str
            The lines, without RETURN.
        """
        self._queue.extend(lines)

    def feed_keys(self, text: str) -> None:
        """Queue keys, a newline for RETURN; the last line may end without one.

        Parameters
        ----------
        text : str
            The keys in the order in which they are pressed.
        """
        *lines, last = text.split("\n")
        self.feed(*lines, *([Keys(last)] if last else []))

    def take_output(self) -> str:
        """Return the output since the last call.

        Returns
        -------
        str
            Every character sent to the screen, RETURN as newline, control characters kept.
        """
        text = "".join(self._output)
        self._output.clear()
        return text

    def screen_rows(self) -> list[bytes]:
        """Return the rows of the text screen as they lie in the machine's memory.

        Returns
        -------
        list of bytes
            24 rows of 40 bytes.
        """
        return self.machine.screen.rows()

    def screen_text(self) -> str:
        """Return the text screen as text.

        Returns
        -------
        str
            24 rows, without blanks at their ends.
        """
        return self.machine.screen.text()

    def load(self, program: str | bytes) -> None:
        """Load a program in place of the present one.

        Parameters
        ----------
        program : str or bytes
            Numbered lines, or the bytes of a file: a text as typed or as printed by LIST, or a
            tokenised program (see `programfile.read_program`).

        Raises
        ------
        UserError
            If it is not a program; names the row. The present program is kept.
        ApplesoftError
            OUT OF MEMORY; the present program is kept.
        """
        self.machine.load(read_program(program))

    def type_line(self, text: str) -> ApplesoftError | None:
        """Enter a line typed at the prompt, small letters as capitals.

        Parameters
        ----------
        text : str
            The line, of which the Apple keeps 239 characters.

        Returns
        -------
        ApplesoftError or None
            The error that ended it, if any.
        """
        return self.enter(capitals(text)[:MAX_INPUT])

    def enter(self, text: str) -> ApplesoftError | None:
        """Enter a line as it is.

        Parameters
        ----------
        text : str
            The line.

        Returns
        -------
        ApplesoftError or None
            The error that ended it, if any.
        """
        self.machine.errflg >>= 1
        self.machine.error = None
        if text.strip(" "):
            self.machine.ram[PROMPT_BYTE] = AT_PROMPT
            self.machine.go(partial(self._take, text))
            self.machine.ram[PROMPT_BYTE] = AT_PROMPT
        return self.machine.error

    def _take(self, text: str) -> None:
        """PARSE: replace a line on page 2 by its tokens, then store or execute it. Under LOCK any
        line means RUN."""
        machine = self.machine
        try:
            number, statements = split_number(text) or (None, text)
        except ValueError:
            raise Fault("SYNTAX", machine.sp) from None
        if machine.lock & 0x80:
            machine.set_pointers()
            return machine.next_statements()
        tokens = tokenise(statements)
        for line in (keyboard_codes(text).encode("ascii"), tokens):
            machine.ram[INPUT_BUFFER : INPUT_BUFFER + len(line) + 1] = line + b"\0"
        machine.ram[INPUT_BUFFER + len(tokens) + 2] = 0
        machine.txtptr = INPUT_BUFFER
        machine.fac = AFTER_TYPING
        if number is None:
            return machine.execute()
        machine.store_line(number, tokens)
        raise Restart

    def source(self) -> str:
        """Return the program as text that `load` takes.

        Returns
        -------
        str
            One line a row, as SAVE writes it.
        """
        return "".join(f"{number} {detokenise(line)}\n" for number, line in self.machine.lines())

    def run(self) -> ApplesoftError | None:
        """Run the program, as RUN does.

        Returns
        -------
        ApplesoftError or None
            The error that ended it, if any.

        Raises
        ------
        EndOfInput
            When it asks for more input than was queued.
        TooManyStatements
            When it takes more statements than ``machine.statements_left`` allowed.
        """
        return self.enter("RUN")

    def prompt(self, handle: Callable[[str], bool] | None = None) -> None:
        """Read and execute lines at the ``]`` prompt until the keyboard ends.

        Parameters
        ----------
        handle : callable, optional
            Called with each line first; returns True for a line that it has handled, such as a
            command of the disk system.
        """
        while True:
            self.machine.console.put("\n")
            try:
                line = self.machine.console.read_line(PROMPT)
                if not (handle and handle(line)):
                    self.enter(line)
            except EndOfInput:
                return
            except KeyboardInterrupt:
                self.machine.console.put("\n")

    def value(self, name: str) -> Any:
        """Return the value of a simple variable.

        Parameters
        ----------
        name : str
            Its name in BASIC, such as ``A``, ``N%`` or ``A$``.

        Returns
        -------
        str or None
            Stored bytes in hexadecimal, the text of a string, None if it was never assigned.
        """
        key = _key(name)
        address = self.machine.simple.get(key)
        return None if address is None else self._value_text(key, address)

    def reals(self) -> dict[str, str]:
        """Return all real variables, the oldest first.

        Returns
        -------
        dict of str to str
            The five stored bytes of each variable in hexadecimal.
        """
        return {
            key.to_bytes(2, "big").rstrip(b"\0").decode(): self._value_text(key, address)
            for key, address in self.machine.simple.items()
            if not key & INTEGER
        }

    def array(self, name: str) -> dict[str, Any] | None:
        """Return an array.

        Parameters
        ----------
        name : str
            Its name in BASIC, without parentheses.

        Returns
        -------
        dict or None
            ``dims``, the sizes, and ``data``, the values as `value` gives them, first subscript
            fastest; None if there is no such array.
        """
        key = _key(name)
        array = self.machine.arrays.get(key)
        if array is None:
            return None
        start = self.machine.arytab + array.first
        places = range(start, start + prod(array.sizes) * array.element, array.element)
        data = [self._value_text(key, place) for place in places]
        return {"dims": list(reversed(array.sizes)), "data": data}

    def _value_text(self, key: int, place: int) -> Any:
        """Return a value as text: a string's characters, a number's stored bytes."""
        machine = self.machine
        kind = key & INTEGER
        if kind == STRING:
            address = machine.word(place + 1)
            return machine.ram[address : address + machine.ram[place]].decode("latin-1")
        x = machine.integer_value(place) if kind else machine.value(place)
        return to_stored(x).hex()


def _key(name: str) -> int:
    """Return the two bytes of a variable's name in memory, with the marks of its type."""
    letters = name.rstrip("%$").encode("ascii")
    two = letters[:2].ljust(2, b"\0")
    return int.from_bytes(two, "big") | MARKS[name.encode()[len(letters) :]]
