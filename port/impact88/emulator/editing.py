"""The program as it is typed: lines put in and taken out, NEW, DEL, and its text again.

In memory a line is the address of the next one, its number (two bytes each, low byte first), its
tokens and a zero; an address of 0 ends the program. LIST and GOTO follow the addresses; a running
program goes on with the bytes behind a line's zero. The two agree unless a program pokes into
itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from .faults import Fault, Restart
from .flow import Flow
from .memory import ADDRESSES, ROM
from .text import COMMA, HEADER, is_digit, reading

END_MARK = b"\0\0"


class Editing(Flow):
    """The program between TXTTAB and PRGEND."""

    def lines(self) -> Iterator[tuple[int, bytes]]:
        """Numbers and tokens, as the addresses lead."""
        ram, address = self.ram, self.txttab
        passed: set[int] = set()
        while ram[address + 1] and address not in passed and address < ROM:
            passed.add(address)
            yield self.word(address + 2), bytes(ram[address + 4 : ram.index(0, address + 4)])
            address = self.word(address)

    def load(self, lines: Iterable[tuple[int, bytes]]) -> None:
        """Put lines in place of the program. Raises OUT OF MEMORY, and changes nothing then."""
        image = bytearray()
        for number, tokens in sorted(dict(lines).items()):
            if tokens:
                image += b"\1\1" + number.to_bytes(2, "little") + tokens + b"\0"
        image += END_MARK
        if self.txttab + len(image) >= self.memsiz:
            raise Fault("OUT OF MEMORY", self.sp)
        self.ram[self.txttab : self.txttab + len(image)] = image
        self.vartab = self.txttab + len(image)
        self.fix_links()

    def store_line(self, number: int, tokens: bytes) -> None:
        """A line typed with a number: put in, or taken out if it has no tokens. Raises OUT OF
        MEMORY."""
        ram = self.ram
        self.vartab = self.prgend
        known, line = self.find_line(number, self.txttab)
        if known:
            self._close(line, self.word(line))
        if tokens:
            size = HEADER + len(tokens) + 1
            self.fretop = self.memsiz
            self.arytab = self.strend = self.vartab
            if self.vartab + size >= self.fretop:
                raise Fault("OUT OF MEMORY", self.sp)
            ram[line + size : self.vartab + size] = ram[line : self.vartab]
            self.vartab += size
            ram[line : line + size] = b"\1\1" + number.to_bytes(2, "little") + tokens + b"\0"
        self.fix_links()

    def _close(self, start: int, end: int) -> None:
        """Take out what lies from start to end."""
        if start <= end <= self.vartab:
            self.ram[start : start + self.vartab - end] = self.ram[end : self.vartab]
            self.vartab -= end - start

    def fix_links(self) -> None:
        """FIX_LINKS: each line the address of the next one; no variables."""
        self.text_changed()
        self.set_pointers()
        ram, address = self.ram, self.txttab
        while ram[address + 1] and address < ROM:
            following = ram.index(0, address + HEADER) + 1
            self.put_word(address, following)
            address = following
        self.prgend = self.vartab
        self.remember(reading(bytes(ram[self.txttab : self.prgend]), self.txttab))

    def new_(self) -> None:
        """NEW. A program that does it comes to its end, from where CONT can go on."""
        if not self.at_end():
            return
        self.lock = 0
        self.ram[self.txttab : self.txttab + 2] = END_MARK
        # the carry is set here, so that there is one byte more than the program takes
        self.vartab = self.prgend = self.txttab + 3
        self.text_changed()
        self.set_pointers()

    def del_(self) -> None:
        """DEL. The program ends, unless the range lies before its own beginning. Raises SYNTAX."""
        sp = self.sp - 2
        if not is_digit(self.character()):
            raise Fault("SYNTAX", sp)
        self.vartab = self.prgend
        _, start = self.find_line(self.line_number(sp - 2), self.txttab)
        self.expect(COMMA, sp - 2)
        last = self.line_number(sp - 2)
        _, end = self.find_line(last + 1 & ADDRESSES - 1, self.txttab)
        if end < start:
            self.variables_changed()
            return
        self._close(start, end)
        self.fix_links()
        raise Restart
