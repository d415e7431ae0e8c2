"""The emulated machine as a Python object."""

from collections import deque
from collections.abc import Callable
from functools import partial
from math import prod
from typing import Any

from ..applesoft.console import Device, EndOfInput, Keyboard, Keys, capitals, keyed
from ..applesoft.errorcodes import ApplesoftError
from ..applesoft.real import to_stored
from .faults import Fault, Restart
from .machine import Machine
from .memory import AFTER_TYPING, INPUT_BUFFER, INTEGER, MARKS, STRING
from .memory import PROMPT as PROMPT_BYTE
from .programfile import read_program
from .tokens import LINE_LIMIT, split_number, tokenise, untokenised

PROMPT = "]"
AT_PROMPT = ord(PROMPT) | 0x80


class Applesoft:
    """An Apple II Plus at the ``]`` prompt.

    ``after_line``, ``statements_left`` and ``interrupted`` of its ``machine`` are there to be set.

    Parameters
    ----------
    keyboard : callable, optional
        Returns a line when what `feed` queued is used up, None at the end.
    screen, printer : callable, optional
        Take what is sent to them; `take_output` collects what is sent to the screen where none is
        given.
    dos : bool, default False
        True where a disk system takes lines that begin with control-D.
    echo : bool, default True
        True where typed lines are part of the output.
    blanks : bool, default True
        True where skipped columns come out as blanks.

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
        printer: Device | None = None,
        *,
        dos: bool = False,
        echo: bool = True,
        blanks: bool = True,
    ) -> None:
        self._queue: deque[str] = deque()
        self._keyboard = keyboard
        self._output: list[str] = []
        device = screen or self._output.append
        self.machine = Machine(self._next_line, device, printer, blanks, dos=dos, echo=echo)

    def _next_line(self) -> str | None:
        if self._queue:
            return self._queue.popleft()
        return self._keyboard() if self._keyboard else None

    def feed(self, *lines: str) -> None:
        """Lines to be typed, for INPUT, GET or the prompt."""
        self._queue.extend(lines)

    def feed_keys(self, text: str) -> None:
        """Queue keys, a newline for RETURN; after the last there need not be one."""
        *lines, rest = text.split("\n")
        self.feed(*lines, *([Keys(rest)] if rest else []))

    def take_output(self) -> str:
        """What was sent since the last call: RETURN as newline, control characters kept."""
        text = "".join(self._output)
        self._output.clear()
        return text

    def screen_rows(self) -> list[bytes]:
        """The 24 rows of the text screen, 40 bytes each, as they lie in the machine's memory."""
        return self.machine.screen.rows()

    def screen_text(self) -> str:
        return self.machine.screen.text()

    def load(self, program: str | bytes) -> None:
        """Load a program in place of the one there is.

        Parameters
        ----------
        program : str or bytes
            Numbered lines, or the bytes of a file: a text as it is typed or as LIST prints it, or a
            tokenised program (see `programfile.read_program`).

        Raises
        ------
        UserError
            For what is no program; names the row. The program that was there stays.
        ApplesoftError
            OUT OF MEMORY; the program that was there stays.
        """
        self.machine.load(read_program(program).lines)

    def type_line(self, text: str) -> ApplesoftError | None:
        """What the machine does with a line typed at the prompt, small letters as capitals. Returns
        the error it ended in."""
        return self.enter(capitals(text)[:LINE_LIMIT])

    def enter(self, text: str) -> ApplesoftError | None:
        """The same for a line as it is."""
        self.machine.errflg >>= 1
        self.machine.error = None
        if text.strip(" "):
            self.machine.ram[PROMPT_BYTE] = AT_PROMPT
            self.machine.go(partial(self._take, text))
            self.machine.ram[PROMPT_BYTE] = AT_PROMPT
        return self.machine.error

    def _take(self, text: str) -> None:
        """PARSE: on page 2 a line's tokens come in its place. Under LOCK every line is RUN."""
        machine = self.machine
        try:
            number, rest = split_number(text) or (None, text)
        except ValueError:
            raise Fault("SYNTAX", machine.sp) from None
        if machine.lock & 0x80:
            machine.set_pointers()
            return machine.next_statements()
        tokens = tokenise(rest)
        for line in (keyed(text).encode("ascii"), tokens):
            machine.ram[INPUT_BUFFER : INPUT_BUFFER + len(line) + 1] = line + b"\0"
        machine.ram[INPUT_BUFFER + len(tokens) + 2] = 0
        machine.txtptr = INPUT_BUFFER
        machine.fac = AFTER_TYPING
        if number is None:
            return machine.execute()
        machine.store_line(number, tokens)
        raise Restart

    def source(self) -> str:
        """The program as text that `load` takes, a line a row: what SAVE writes."""
        return "".join(f"{number} {untokenised(line)}\n" for number, line in self.machine.lines())

    def run(self) -> ApplesoftError | None:
        """RUN. Returns the error that ended the program, or None. Raises `console.EndOfInput` when
        it asks for more than was fed, and `faults.TooManyStatements`."""
        return self.enter("RUN")

    def prompt(self, handle: Callable[[str], bool] | None = None) -> None:
        """Read and do lines at the ``]`` prompt until the keyboard ends. ``handle`` may take one
        for itself by returning True (the disk system's commands)."""
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
        """A simple variable, named as in BASIC: stored bytes in hexadecimal, text for a string,
        None if it was never assigned."""
        key = _key(name)
        address = self.machine.simple.get(key)
        return None if address is None else self._shown(key, address)

    def reals(self) -> dict[str, str]:
        """Every real variable that exists, oldest first: five stored bytes in hexadecimal."""
        return {
            key.to_bytes(2, "big").rstrip(b"\0").decode(): self._shown(key, address)
            for key, address in self.machine.simple.items()
            if not key & INTEGER
        }

    def array(self, name: str) -> dict[str, Any] | None:
        """An array: ``dims`` (sizes) and ``data``, first subscript fastest. None without one."""
        key = _key(name)
        array = self.machine.arrays.get(key)
        if array is None:
            return None
        start = self.machine.arytab + array.first
        places = range(start, start + prod(array.sizes) * array.element, array.element)
        data = [self._shown(key, place) for place in places]
        return {"dims": list(reversed(array.sizes)), "data": data}

    def _shown(self, key: int, place: int) -> Any:
        """A value as text: a string's characters, a number's stored bytes."""
        machine = self.machine
        kind = key & INTEGER
        if kind == STRING:
            address = machine.word(place + 1)
            return machine.ram[address : address + machine.ram[place]].decode("latin-1")
        x = machine.integer_value(place) if kind else machine.value(place)
        return to_stored(x).hex()


def _key(name: str) -> int:
    letters = name.rstrip("%$").encode("ascii")
    two = letters[:2].ljust(2, b"\0")
    return int.from_bytes(two, "big") | MARKS[name.encode()[len(letters) :]]
