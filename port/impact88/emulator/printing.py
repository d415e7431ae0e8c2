"""PRINT, LIST, and the messages: what the ROM displays."""

from __future__ import annotations

from ..applesoft.real import integer
from .faults import Fault, NextStatement
from .intrinsics import Intrinsics, byte_of
from .memory import ADDRESSES
from .text import CLOSE, COMMA, HEADER, MINUS, SEMICOLON, is_digit
from .tokens import FIRST, KEYWORDS, TOKENS

TAB, SPC = TOKENS["TAB("], TOKENS["SPC("]
WRAP_COLUMN = 33
INDENT = 5
"""LIST goes on in the next row, indented, when the cursor has reached a column after a character
or the blank that ends a keyword."""
LAST_NUMBER = 0xFFFF
IN_ROM, IN_STACK_PAGE = 0xD000, 0x100
"""Where messages and the digits of a number stand; only the page counts."""


class Printing(Intrinsics):
    """The statements that display."""

    def pause(self) -> None:
        """ISCNTC: control-C is looked for, and what else may end a program."""
        raise NotImplementedError

    def string_shown(self, text: bytes, address: int = IN_ROM) -> None:
        """STROUT: a message, as a temporary string. Raises FORMULA TOO COMPLEX."""
        self.used(self.temporary(0, address, address >> 8))
        length = len(text)
        self.fac = length, self.fac[1], 0
        self.output.out(text.decode("latin-1"))

    def line_number_shown(self, number: int) -> None:
        """LINPRT. Raises FORMULA TOO COMPLEX."""
        self.string_shown(self.digits(integer(number)), IN_STACK_PAGE)

    # --- PRINT --------------------------------------------------------------------------------

    def print_(self) -> None:
        """PRINT. Raises SYNTAX, and what its formulas do."""
        sp = self.sp - 2
        newline = True
        while True:
            byte = self.character()
            if byte in (0, 58):
                break
            newline = False
            if byte in (TAB, SPC):
                self.txtptr += 1
                columns = self.byte(sp - 3)
                if self.character() != CLOSE:
                    raise Fault("SYNTAX", sp - 1)
                self.txtptr += 1
                if byte == TAB:
                    self.output.tab(columns)
                else:
                    self.output.spc(columns)
            elif byte == COMMA:
                self.txtptr += 1
                self.output.zone()
            elif byte == SEMICOLON:
                self.txtptr += 1
            else:
                fac = self.formula(sp - 2)
                if self.valtyp:
                    self.output.out(self.used(fac).decode("latin-1"))
                else:
                    self.charac = 0
                    self.string_shown(self.digits(fac), IN_STACK_PAGE)
                newline = True
        if newline:
            self.output.newline()

    def byte(self, sp: int) -> int:
        """GETBYT: a number from 0 to 255. Raises SYNTAX, TYPE MISMATCH, ILLEGAL QUANTITY."""
        fac = self.number(sp - 2)
        n = byte_of(fac, sp)
        self.character()
        return n

    # --- LIST ---------------------------------------------------------------------------------

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
        raise NextStatement

    def _list_lines(self, line: int, last: int) -> None:
        ram, output = self.ram, self.output
        for _ in range(ADDRESSES):  # addresses poked may lead in a circle
            if not ram[line + 1]:
                break
            self.pause()
            output.newline_of_rom()
            number = self.word(line + 2)
            if number > last:
                break
            self.line_number_shown(number)
            pieces = [" "]
            for byte in ram[line + HEADER : ram.index(0, line + HEADER)]:
                if byte < FIRST:
                    pieces.append(chr(byte))
                else:
                    index = byte - FIRST
                    pieces.append(f" {KEYWORDS[index] if index < len(KEYWORDS) else ''} ")
            for piece in pieces:
                output.put(piece)
                if self.screen.column >= WRAP_COLUMN:
                    output.put("\n")
                    self.screen.move_to_column(INDENT)
            line = self.word(line)
        output.put("\n")
