"""Strings: descriptors, temporaries, room and its collection.

A descriptor is three bytes, a length and an address. The characters of a string in the program lie
in the program's text, all others in the string area, which grows down from MEMSIZ to FRETOP. When
it meets the arrays, strings that no variable holds any more are collected.

A string in the accumulator is a number as it lies there: the length of one just made for the
exponent, its address in the first two bytes of the mantissa, and in the last two the address of
the descriptor, which is all that counts. The ROM's STRNG1 is the accumulator's extension too.
"""

from __future__ import annotations

from ..applesoft.errorcodes import ApplesoftError
from ..applesoft.real import Number
from .memory import ROM, TEMPORARIES, TEMPORARIES_END
from .text import QUOTE, Text

DESCRIPTOR = 3
IS_STRING = 0xFF
LONGEST = 255


def descriptor(string: Number) -> int:
    """The address of the descriptor of a string in the accumulator."""
    mantissa = string[1]
    return mantissa >> 16 & 0xFF | mantissa & 0xFF00


class Strings(Text):
    """The string area and the temporaries. ``fac``: what the accumulator held last. ``valtyp``:
    `IS_STRING` when that is a string."""

    fac: Number
    valtyp = 0
    strng2 = 0

    def collect_garbage(self) -> None:
        """GARBAG: move the strings that variables hold together below MEMSIZ, the highest first.

        When the highest of those left to move is a temporary, the ROM takes it for the end: it and
        all strings below stay where they are, and what is made later overwrites them.
        """
        ram = self.ram
        self.fretop = self.memsiz
        places = [*range(TEMPORARIES, self.temppt, DESCRIPTOR), *self._held()]
        strings = [(self.word(place + 1), n, place) for n, place in enumerate(places) if ram[place]]
        for address, _, place in sorted(strings, reverse=True):
            if not self.strend <= address < self.fretop:
                continue
            if place < TEMPORARIES_END:
                return
            length = ram[place]
            self.fretop -= length
            ram[self.fretop : self.fretop + length] = ram[address : address + length]
            self.put_word(place + 1, self.fretop)

    def _held(self) -> list[int]:
        """Where the descriptors of string variables and elements lie, in memory's order."""
        ram = self.ram
        places = [
            place + 2
            for place in range(self.vartab, self.arytab, 7)
            if ram[place] < 0x80 <= ram[place + 1]
        ]
        array = self.arytab
        while array < self.strend and (size := self.word(array + 2)):
            if ram[array] < 0x80 <= ram[array + 1]:
                places += range(array + 5 + 2 * ram[array + 4], array + size, DESCRIPTOR)
            array += size
        return places

    def room(self, length: int) -> int:
        """GETSPA: the address of new room for characters. Raises OUT OF MEMORY."""
        if self.fretop - length < self.strend:
            self.collect_garbage()
            if self.fretop - length < self.strend:
                raise ApplesoftError("OUT OF MEMORY")
        self.fretop -= length
        return self.fretop

    def move(self, source: int, target: int, length: int) -> None:
        """MOVSTR: copy characters, the last one first."""
        ram = self.ram
        if target < source < target + length:
            for offset in range(length - 1, -1, -1):
                ram[target + offset] = ram[source + offset]
        else:
            ram[target : target + length] = ram[source : source + length]

    def characters(self, place: int) -> bytes:
        """The characters of the string that a descriptor describes."""
        address = self.word(place + 1)
        return bytes(self.ram[address : address + self.ram[place]])

    def temporary(self, length: int, address: int, extension: int = 0) -> Number:
        """PUTNEW: a new temporary, in the accumulator. Raises FORMULA TOO COMPLEX."""
        place = self.temppt
        if place == TEMPORARIES_END:
            raise ApplesoftError("FORMULA TOO COMPLEX")
        self.ram[place] = length
        self.put_word(place + 1, address)
        self.lastpt = place
        self.temppt = place + DESCRIPTOR
        self.valtyp = IS_STRING
        mantissa = (address & 0xFF) << 32 | (address >> 8) << 24 | place << 16 | extension
        self.fac = length, mantissa, self.fac[2]
        return self.fac

    def literal(self, address: int, *ends: int) -> Number:
        """STRLIT, STRLT2: the string that begins at an address and ends at a zero or one of
        ``ends``, a quote unless given; STRNG2 is behind it, and behind its quote. What stands on
        page 0 or 2 is copied. Raises OUT OF MEMORY and FORMULA TOO COMPLEX."""
        ram = self.ram
        end = ram.index(0, address)
        for byte in ends or (QUOTE,):
            found = ram.find(byte, address, end)
            end = found if found >= 0 else end
        length = end - address & 0xFF
        self.strng2 = end + (ram[end] == QUOTE)
        self.charac = 0
        page = address >> 8
        if page in (0, 2):
            copy = self.room(length)
            self.move(address, copy, length)
            address = copy
        return self.temporary(length, address, page)

    def made(self, text: bytes) -> Number:
        """STRINI and PUTNEW: a temporary with characters. Raises OUT OF MEMORY and FORMULA TOO
        COMPLEX."""
        address = self.room(len(text))
        self.ram[address : address + len(text)] = text
        return self.temporary(len(text), address)

    def release(self, place: int) -> bool:
        """FRETMS: give back a temporary's place if it is the latest; whether it was."""
        if place != self.lastpt:
            return False
        self.temppt = place
        self.lastpt = place - DESCRIPTOR
        return True

    def freed(self, place: int) -> tuple[int, int]:
        """FRETMP: length and address of a string that has been used: a temporary gives back its
        place, and its room if it is the lowest."""
        released = self.release(place)
        length, address = self.ram[place], self.word(place + 1)
        if released and address == self.fretop:
            self.fretop += length
        return length, address

    def used(self, string: Number) -> bytes:
        """FREFAC: the characters of the string in the accumulator, which has been used then."""
        length, address = self.freed(descriptor(string))
        return bytes(self.ram[address : address + length])

    def assign_string(self, target: int, string: Number) -> None:
        """PUTSTR: a variable takes the string in the accumulator: itself if it is a temporary or
        its characters are the program's, a copy of another variable's. Raises OUT OF MEMORY."""
        ram = self.ram
        place = descriptor(string)
        if self.word(place + 1) >= self.fretop and place >= self.vartab:
            length = ram[place]
            address = self.room(length)
            self.move(self.word(place + 1), address, length)
        else:
            self.release(place)
            length, address = ram[place], self.word(place + 1)
        if target < ROM:
            ram[target] = length
            self.put_word(target + 1, address)

    def joined(self, left: int, right: int) -> Number:
        """CAT: left + right, by their descriptors. Raises STRING TOO LONG past 255 characters,
        OUT OF MEMORY and FORMULA TOO COMPLEX."""
        ram = self.ram
        size = ram[left]
        length = size + ram[right]
        if length > LONGEST:
            raise ApplesoftError("STRING TOO LONG")
        address = self.room(length)
        self.move(self.word(left + 1), address, size)
        more, source = self.freed(right)
        self.move(source, address + size, more)
        self.freed(left)
        return self.temporary(length, address, left >> 8)

    def part(self, place: int, first: int, length: int, extension: int) -> Number:
        """The last part of LEFT$, RIGHT$ and MID$: characters of a string from an offset on."""
        address = self.room(length)
        _, source = self.freed(place)
        self.move(source + first, address, length)
        return self.temporary(length, address, extension)

    def compare_strings(self, left: int, right: Number) -> int:
        """STRCMP: 1 if the string of the left descriptor is larger, 0 if they are equal, -1 if it
        is smaller."""
        other = self.used(right)
        length, address = self.freed(left)
        text = bytes(self.ram[address : address + length])
        return (text > other) - (text < other)
