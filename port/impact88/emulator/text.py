"""Reading the program's bytes: TXTPTR, and what looks for characters, numbers and lines from there.

``txtptr`` is the address of the next byte to be read. What has been read at an address of the
program (a name, a constant, a line number) is remembered until a byte of the program changes; what
stands on page 2 is read anew each time.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import NamedTuple

from ..applesoft import decimaltext
from ..applesoft.real import Number
from .faults import Fault
from .memory import ADDRESSES, BUFFER_END, Memory
from .tokens import TOKENS

BLANK, QUOTE, COLON, COMMA, SEMICOLON = map(ord, ' ":,;')
OPEN, CLOSE, DOLLAR, PERCENT = map(ord, "()$%")
GOTO, PLUS, MINUS = (TOKENS[word] for word in ("GOTO", "+", "-"))
HEADER = 4
"""Bytes of a line before its text: the next line's address and the number."""
LINE_LIMIT = 0x19
"""LINGET refuses a further digit when the number's high byte has come so far: past 63999."""
INTEGER, STRING, FUNCTION = 0x8080, 0x0080, 0x8000
"""Top bits of a name's two bytes in memory that tell its kind; a real has none."""

_NUMERAL = re.compile(rb" *[-+]?[ 0-9]*(?:\.[ 0-9]*)?(?:E *[-+%c%c]?[ 0-9]*)?" % (PLUS, MINUS))
_NAME = re.compile(rb"([A-Z]) *([A-Z0-9]?)[A-Z0-9 ]*([$%]?) *")
_MARKS = {b"": 0, b"$": STRING, b"%": INTEGER}
_SIGNS = bytes.maketrans(bytes((PLUS, MINUS)), b"+-")

Name = tuple[int, int, bool]
"""A name's two bytes as a number, the address behind it, and whether subscripts follow."""


def is_letter(byte: int) -> bool:
    """ISLETC: A to Z; a small letter begins no name."""
    return 65 <= byte <= 90


def is_digit(byte: int) -> bool:
    """0 to 9."""
    return 48 <= byte <= 57


class Reading(NamedTuple):
    """What was found at addresses of the program: names; reals and constants that need no further
    look, with the address behind them; where GOTO leads; and, under the line numbers, the lines."""

    names: dict[int, Name]
    atoms: dict[int, tuple[int, int, Number | None]]
    targets: dict[int, int]
    lines: dict[int, int]


@lru_cache(maxsize=64)
def reading(image: bytes, start: int) -> Reading:
    """The same program read before, by whichever machine."""
    return Reading({}, {}, {}, {})


class Text(Memory):
    """The program's bytes from ``txtptr`` on. ``charac``: the ROM's CHARAC, in which INT leaves a
    byte too, or the function and its operands whose INT left it (`functions`)."""

    linnum = 0
    charac: int | tuple[str, Number, Number] = 0

    def text_changed(self) -> None:
        self.remember(Reading({}, {}, {}, {}))

    def remember(self, reading: Reading) -> None:
        """Take what has been read for what there is to read."""
        self._reading = reading
        self.names, self.atoms, self.targets, _ = reading

    def character(self) -> int:
        """CHRGOT: the byte at TXTPTR, or the next one that is no blank."""
        ram = self.ram
        while (byte := ram[self.txtptr]) == BLANK:
            self.txtptr += 1
        return byte

    def next_character(self) -> int:
        """CHRGET: the next byte that is no blank."""
        self.txtptr += 1
        return self.character()

    def at_end(self) -> bool:
        """Whether the statement ends here."""
        return self.character() in (0, COLON)

    def expect(self, byte: int, sp: int) -> int:
        """SYNCHR: past a byte that has to come next; the one after it. Raises SYNTAX."""
        ram = self.ram
        if ram[self.txtptr] != byte and self.character() != byte:
            raise Fault("SYNTAX", sp)
        self.txtptr += 1
        following = ram[self.txtptr]
        return following if following != BLANK else self.character()

    def data_(self) -> None:
        """DATA: to the next colon outside quotes, or the line's end."""
        ram, pos = self.ram, self.txtptr
        quoted = False
        while (byte := ram[pos]) and (quoted or byte != COLON):
            if byte == QUOTE:
                quoted = not quoted
            pos += 1
        self.txtptr = pos
        self.charac = 0

    def rem_(self) -> None:
        """REM: to the end of the line."""
        self.txtptr = self.ram.index(0, self.txtptr)
        self.charac = 0

    def name_at(self, pos: int) -> Name:
        """The name that begins with the letter at an address: two characters count."""
        match = _NAME.match(self.ram, pos)
        assert match is not None
        first, second, mark = match.groups()
        key = ord(first) << 8 | ord(second or b"\0") | _MARKS[mark]
        end = match.end()
        name = (key, end, self.ram[end] == OPEN)
        if BUFFER_END <= pos < self.prgend:
            self.names[pos] = name
            if not name[2] and not mark:
                self.atoms[pos] = end, key, None
        return name

    def numeral(self) -> Number:
        """FIN: the number that begins at TXTPTR, and past it; zero if none does. Raises OVERFLOW.

        Tokens stand for the signs behind an E.
        """
        match = _NUMERAL.match(self.ram, self.txtptr)
        assert match is not None  # it matches nothing, too
        self.txtptr = match.end()
        text = match[0].translate(_SIGNS, b" ").decode("ascii")
        return decimaltext.read(text)[0]

    def constant(self) -> Number:
        """FIN on a number in the program. Raises OVERFLOW."""
        pos = self.txtptr
        value = self.numeral()
        if BUFFER_END <= pos < self.prgend:
            self.atoms[pos] = self.txtptr, 0, value
        return value

    def line_number(self, sp: int) -> int:
        """LINGET: the digits that come next, in LINNUM too; 0 if there are none. Raises SYNTAX."""
        number = 0
        while is_digit(byte := self.character()):
            if number >> 8 >= LINE_LIMIT:
                raise Fault("SYNTAX", sp)
            self.charac = byte - 48
            number = 10 * number + byte - 48
            self.txtptr += 1
        self.linnum = number
        return number

    def find_line(self, number: int, address: int) -> tuple[bool, int]:
        """FNDLIN: whether a line of this number comes, from the line at an address on, and where
        it lies, or the first with a larger number, or the end."""
        ram = self.ram
        for _ in range(ADDRESSES):  # addresses poked may lead in a circle, where the ROM stays
            if not ram[address + 1]:
                return False, address
            found = ram[address + 2] | ram[address + 3] << 8
            if found >= number:
                return found == number, address
            address = ram[address] | ram[address + 1] << 8
        return False, address

    def line_address(self, number: int, beyond: int) -> int | None:
        """Where a line lies; searched from ``beyond`` on, if the ROM searches from there."""
        lines = self._reading.lines
        if not lines:
            lines.update(self._ordered_lines())
        if lines:
            return lines.get(number)
        found, address = self.find_line(number, beyond)
        return address if found else None

    def _ordered_lines(self) -> dict[int, int]:
        """Where each line lies; empty unless the numbers grow and addresses and lines agree."""
        ram = self.ram
        lines: dict[int, int] = {}
        address, last = self.txttab, -1
        while ram[address + 1]:
            number = ram[address + 2] | ram[address + 3] << 8
            following = ram.index(0, address + HEADER) + 1
            if number <= last or following != ram[address] | ram[address + 1] << 8:
                return {}
            lines[number] = address
            address, last = following, number
        return lines
