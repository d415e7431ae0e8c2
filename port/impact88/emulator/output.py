"""What PRINT and its kin do to the screen: characters, columns, modes, and LIST."""

from __future__ import annotations

from ..applesoft.console import Console
from ..applesoft.errorcodes import illegal_quantity
from .screen import FLASHING, HEIGHT, INVERSE, NORMAL, WIDTH, Screen

FLASH_BIT = 0x40
ZONE = 16
LAST_ZONE_FROM = 24
"""From this column on a comma begins a new line."""


class Output:
    """The statements' side of a screen. ``flash_bit`` is set in every printing character sent."""

    def __init__(self, console: Console, screen: Screen) -> None:
        self._console = console
        self._screen = screen
        self.flash_bit = 0

    def out(self, text: str) -> None:
        """PRINT's characters. A line feed moves down and leaves the column as it is."""
        first, *others = text.split("\n")
        self.put(first)
        for other in others:
            column = self._screen.column
            self.put("\n")
            self._screen.stay_at(column)
            self.put(other)

    def newline(self) -> None:
        """What PRINT ends with."""
        self._console.put("\n")

    def put(self, text: str) -> None:
        """Characters: high bit dropped, RETURN as newline."""
        if self.flash_bit or not text.isascii() or "\r" in text:
            bit = self.flash_bit & 0x7F
            codes = (ord(character) & 0x7F for character in text)
            text = "".join(chr(n | bit if n >= 32 else n) for n in codes).replace("\r", "\n")
        self._console.put(text)

    def zone(self) -> None:
        """The comma: on to the next zone, or to a new line."""
        column = self._screen.column
        if column >= LAST_ZONE_FROM:
            self.put("\n")
        else:
            self._screen.move_to_column(column + ZONE & 0xF0)

    def tab(self, column: int) -> None:
        """TAB: blanks up to a column, counted from 1; 0 counts as 256."""
        spaces = (column - 1 & 0xFF) - self._screen.column
        if spaces > 0:
            self.put(" " * spaces)

    def spc(self, n: int) -> None:
        """SPC: n blanks."""
        self.put(" " * n)

    def htab(self, column: int) -> None:
        """HTAB: to a column, counted from 1, on a later line if there is none such on this one."""
        column = column - 1 & 0xFF
        while column >= WIDTH:
            self.put("\n")
            column -= WIDTH
        self._screen.move_to_column(column)

    def vtab(self, row: int) -> None:
        """VTAB: to a row, counted from 1. Raises ILLEGAL QUANTITY past 24."""
        if not 1 <= row <= HEIGHT:
            raise illegal_quantity()
        self._screen.move_to_row(row - 1)

    def normal(self) -> None:
        """NORMAL."""
        self.flash_bit = 0
        self._screen.set_mode(NORMAL)

    def inverse(self) -> None:
        """INVERSE."""
        self.flash_bit = 0
        self._screen.set_mode(INVERSE)

    def flash(self) -> None:
        """FLASH."""
        self.flash_bit = FLASH_BIT
        self._screen.set_mode(FLASHING)

    def newline_of_rom(self) -> None:
        """CRDO: a new line whatever the output."""
        self.put("\n")

    def call(self, address: int) -> bool:
        """CALL of a routine of the monitor that displays; whether it is one."""
        if address == 0xFD8E:
            self.put("\n")
        elif address in (0xFF3A, 0xFBDD):
            self.put("\a")
        elif address == 0xFE80:
            self.inverse()
        elif address in (0xFE84, 0xF273):
            self.normal()
        else:
            return address == 0xFCA8  # WAIT
        return True
