"""PRINT, LIST and the messages: what the ROM displays, and the statements that prepare for it."""

from __future__ import annotations

from ..applesoft.real import Number, integer
from .faults import Fault
from .intrinsics import Intrinsics, byte_of
from .memory import ADDRESSES
from .screen import HEIGHT, WIDTH
from .text import CLOSE, COLON, COMMA, HEADER, MINUS, SEMICOLON, is_digit
from .tokens import FIRST, TOKENS, spelling

TAB, SPC = TOKENS["TAB("], TOKENS["SPC("]
ZONE = 16
LAST_ZONE_FROM = 24
"""From this column on a comma begins a new line."""
WRAP_COLUMN = 33
INDENT = 5
"""LIST goes on in the next row, indented, when the cursor has reached a column after a character
or the blank that ends a keyword."""
LAST_NUMBER = 0xFFFF
IN_ROM, IN_STACK_PAGE = 0xD000, 0x100
"""Where messages and the digits of a number stand; only the page counts."""


class Printing(Intrinsics):
    """The statements that display. ``flash`` is set in every printing character they send."""

    def put(self, text: str) -> None:
        """OUTDO: characters, high bit dropped, RETURN as newline."""
        if self.flash or not text.isascii() or "\r" in text:
            bit = self.flash & 0x7F
            codes = (ord(character) & 0x7F for character in text)
            text = "".join(chr(n | bit if n >= 32 else n) for n in codes).replace("\r", "\n")
        self.console.put(text)

    def show(self, text: bytes) -> None:
        """STRPRT: a string's characters. A line feed moves down and leaves the column as it is."""
        first, *others = text.decode("latin-1").split("\n")
        self.put(first)
        for other in others:
            column = self.screen.column
            self.put("\n")
            self.screen.stay_at(column)
            self.put(other)

    def show_message(self, text: bytes, address: int = IN_ROM) -> None:
        """STROUT: a text that is no variable's, as a temporary string. Raises FORMULA TOO
        COMPLEX."""
        self.used(self.temporary(0, address, address >> 8))
        self.fac = len(text), self.fac[1], 0
        self.show(text)

    def show_number(self, x: Number) -> None:
        """FOUT and STROUT. Raises FORMULA TOO COMPLEX."""
        self.charac = 0
        self.show_message(self.digits(x), IN_STACK_PAGE)

    def print_(self) -> None:
        """PRINT. Raises SYNTAX, and what its formulas do."""
        sp = self.sp - 2
        newline = True
        while (byte := self.character()) and byte != COLON:
            newline = False
            if byte in (TAB, SPC):
                self._skip_columns(byte, sp - 1)
            elif byte == COMMA:
                self.txtptr += 1
                self._next_zone()
            elif byte == SEMICOLON:
                self.txtptr += 1
            else:
                fac = self.formula(sp - 2)
                if self.valtyp:
                    self.show(self.used(fac))
                else:
                    self.show_number(fac)
                newline = True
        if newline:
            self.console.put("\n")

    def _skip_columns(self, token: int, sp: int) -> None:
        """SPC: so many blanks; TAB: up to a column, counted from 1, 0 as 256. Raises SYNTAX."""
        self.txtptr += 1
        columns = self.byte(sp - 2)
        if self.character() != CLOSE:
            raise Fault("SYNTAX", sp)
        self.txtptr += 1
        if token == TAB:
            columns = (columns - 1 & 0xFF) - self.screen.column
        if columns > 0:
            self.put(" " * columns)

    def _next_zone(self) -> None:
        """The comma: on to the next zone, or to a new line."""
        column = self.screen.column
        if column >= LAST_ZONE_FROM:
            self.put("\n")
        else:
            self.screen.column = column + ZONE & 0xF0

    def byte(self, sp: int) -> int:
        """GETBYT: a number from 0 to 255. Raises SYNTAX, TYPE MISMATCH, ILLEGAL QUANTITY."""
        return byte_of(self.number(sp - 2), sp)

    def htab_(self) -> None:
        """HTAB: to a column, counted from 1, on a later line if there is none such on this one."""
        column = self.byte(self.sp - 4) - 1 & 0xFF
        while column >= WIDTH:
            self.put("\n")
            column -= WIDTH
        self.screen.column = column

    def vtab_(self) -> None:
        """VTAB: to a row, counted from 1. Raises ILLEGAL QUANTITY past 24."""
        row = self.byte(self.sp - 4)
        if not 1 <= row <= HEIGHT:
            raise Fault("ILLEGAL QUANTITY", self.sp - 2)
        self.screen.move_to_row(row - 1)

    def set_mode(self, mask: int, flash: int = 0) -> None:
        """NORMAL, INVERSE, FLASH."""
        self.flash = flash
        self.screen.mask = mask

    def list_(self) -> None:
        """LIST. Raises SYNTAX for a line number past 63999."""
        sp = self.sp - 2
        byte = self.character()
        if not (is_digit(byte) or self.at_end() or byte in (MINUS, COMMA)):
            return
        number = self.line_number(sp - 2)
        _, line = self.find_line(number, self.txttab)
        if not self.at_end():
            if self.character() not in (MINUS, COMMA):
                return
            self.txtptr += 1
            number = self.line_number(sp - 2)
            if not self.at_end():
                return
        self._list_lines(line, number or LAST_NUMBER)

    def _list_lines(self, line: int, last: int) -> None:
        ram = self.ram
        for _ in range(ADDRESSES):  # addresses poked may lead in a circle
            if not ram[line + 1]:
                break
            self.pause()
            self.put("\n")
            number = self.word(line + 2)
            if number > last:
                break
            self.show_number(integer(number))
            tokens = ram[line + HEADER : ram.index(0, line + HEADER)]
            for piece in (" ", *map(_listed, tokens)):
                self.put(piece)
                if self.screen.column >= WRAP_COLUMN:
                    self.put("\n")
                    self.screen.column = INDENT
            line = self.word(line)
        self.put("\n")


def _listed(byte: int) -> str:
    """What LIST writes for a byte before it asks where the cursor is."""
    return chr(byte) if byte < FIRST else f" {spelling(byte)} "
