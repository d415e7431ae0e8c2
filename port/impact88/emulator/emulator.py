"""The emulated machine as a Python object: load, type, run, feed keys, take output, read variables.

machine = Applesoft()
machine.load("10 INPUT A\\n20 PRINT A / 3")
machine.feed("1")
machine.run()
machine.take_output()          # '?\\x001\\n.333333333\\n'
machine.reals()                # {'A': '8100000000'}
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from ..applesoft.console import Device, EndOfInput, Keyboard, Keys, capitals, keyed
from ..applesoft.errorcodes import ApplesoftError
from ..applesoft.real import to_stored
from .lister import source
from .machine import Machine
from .strings import Descriptor
from .symbols import ARRAYS, REAL, SIMPLE, Name
from .tokens import LINE_LIMIT, TOKENS, split_number, tokenise

PROMPT = "]"
RUN = bytes((TOKENS["RUN"],))


class Applesoft:
    """An Apple II Plus at the ``]`` prompt.

    ``keyboard`` is asked for a line when what `feed` queued is used up; ``screen`` and ``printer``
    take what is sent to them, which `take_output` collects when no screen is given. ``dos``:
    whether a disk system takes control-D lines; ``echo``: whether typed lines are part of the
    output; ``blanks``: whether columns skipped by comma zones and HTAB come out as blanks.

    `machine` is the machine itself; its ``after_line``, ``statements_left`` and ``interrupted`` are
    there to be set.
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
        self.machine = Machine(
            self._next_line,
            screen or self._output.append,
            printer,
            dos=dos,
            echo=echo,
            blanks=blanks,
        )

    # --- keyboard and screen ------------------------------------------------------------------

    def _next_line(self) -> str | None:
        if self._queue:
            return self._queue.popleft()
        return self._keyboard() if self._keyboard else None

    def feed(self, *lines: str) -> None:
        """Queue lines to be typed, for INPUT, GET or the prompt."""
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

    def screen_text(self) -> str:
        """The 24 rows of the text screen."""
        return self.machine.screen.text()

    # --- the program --------------------------------------------------------------------------

    def load(self, text: str) -> None:
        """A program from text, one numbered line a row, its case kept; replaces the one there is.

        Raises ValueError, naming the row, for a row that does not begin with a number up to 63999
        or is too long to be typed, and ApplesoftError OUT OF MEMORY.
        """
        lines: list[tuple[int, str]] = []
        for row, line in enumerate(text.split("\n"), 1):
            if not line.strip():
                continue
            try:
                numbered = split_number(line.rstrip("\r"))
            except ValueError as error:
                raise ValueError(f"row {row}: {error}") from None
            if numbered is None:
                raise ValueError(f"row {row} has no line number")
            if len(line) > LINE_LIMIT:
                raise ValueError(f"row {row} has {len(line)} characters; a line takes {LINE_LIMIT}")
            lines.append(numbered)
        self.machine.program.clear()
        for number, rest in lines:
            self.machine.program.store(number, tokenise(rest))
        self._check_size()
        self.machine.changed()

    def _check_size(self) -> None:
        if self.machine.program.end >= self.machine.variables.strings.top:
            self.machine.program.clear()
            self.machine.changed()
            raise ApplesoftError("OUT OF MEMORY")

    def type_line(self, text: str) -> ApplesoftError | None:
        """What the machine does with a line typed at the prompt, once RETURN is pressed.

        Small letters become capitals, as on its keyboard. Returns the error it ended in.
        """
        return self.enter(capitals(text)[:LINE_LIMIT])

    def enter(self, text: str) -> ApplesoftError | None:
        """The same for a line as it is."""
        machine = self.machine
        machine.errors.flag >>= 1
        machine.error = None
        typed = keyed(text).encode("ascii")
        try:
            numbered = split_number(text)
        except ValueError:
            return self._complain(ApplesoftError("SYNTAX"))
        if machine.locked and text.strip(" "):
            machine.execute(RUN, typed)
        elif numbered is not None:
            number, rest = numbered
            machine.program.store(number, tokenise(rest))
            try:
                self._check_size()
            except ApplesoftError as error:
                return self._complain(error)
            machine.changed()
        elif text.strip(" "):
            machine.execute(tokenise(text), typed)
        return machine.error

    def _complain(self, error: ApplesoftError) -> ApplesoftError:
        self.machine.output.put(f"\n?{error.kind} ERROR\a")
        self.machine.forget()
        self.machine.error = error
        return error

    def source(self) -> str:
        """The program as text that `load` takes."""
        program = self.machine.program
        return source((number, program.tokens[number]) for number in program.numbers)

    def run(self) -> ApplesoftError | None:
        """RUN. Returns the error that ended the program, None if it simply ended.

        Raises `console.EndOfInput` when it asks for more than was fed, `machine.TooManyStatements`.
        """
        return self.enter("RUN")

    def prompt(self, handle: Callable[[str], bool] | None = None) -> None:
        """Read and do lines at the ``]`` prompt until the keyboard ends.

        ``handle`` may take a line for itself by returning True (the disk system's commands).
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

    # --- variables ----------------------------------------------------------------------------

    def value(self, name: str) -> Any:
        """A simple variable: five stored bytes in hexadecimal, text for a string, None if it was
        never assigned. ``name`` as in BASIC: ``A``, ``N%``, ``A$``."""
        kind = name[-1] if name[-1] in "%$" else REAL
        slot = SIMPLE.slots.get(Name(name.rstrip("%$")[:2], kind))
        if slot is None or slot >= len(self.machine.variables.made):
            return None
        if not self.machine.variables.made[slot]:
            return None
        return self._shown(self.machine.variables.values[slot])

    def reals(self) -> dict[str, str]:
        """Every real variable that exists, oldest first: five stored bytes in hexadecimal."""
        variables = self.machine.variables
        return {
            SIMPLE.names[slot].text: self._shown(variables.values[slot])
            for slot in variables.order
            if SIMPLE.names[slot].kind == REAL
        }

    def array(self, name: str) -> dict[str, Any] | None:
        """An array: ``dims`` (sizes) and ``data``, first subscript fastest. None without one."""
        kind = name[-1] if name[-1] in "%$" else REAL
        slot = ARRAYS.slots.get(Name(name.rstrip("%$")[:2], kind))
        arrays = self.machine.variables.arrays
        array = arrays[slot] if slot is not None and slot < len(arrays) else None
        if array is None:
            return None
        return {"dims": list(array.sizes), "data": [self._shown(element) for element in array.data]}

    def _shown(self, value: Any) -> Any:
        """A value as text: a string's characters, a number's stored bytes."""
        if isinstance(value, Descriptor):
            return self.machine.variables.strings.text(value)
        return to_stored(value).hex()
