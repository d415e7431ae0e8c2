"""Strings in memory: three bytes describe one, and its characters lie in RAM.

A `Descriptor` is a length and an address. The characters of a string in the program lie in the
program's text, all others in the string area, which grows down from HIMEM. When it meets the
arrays, strings no variable holds any more are collected, and if that is not enough: OUT OF MEMORY.

A string that a formula makes is a *temporary*: it holds one of three places until it is used, and
gives its room back if it lies lowest then. A string that is never used (by IF, or because an error
came in between) keeps its place until the stack is cleared.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from ..applesoft.errorcodes import ApplesoftError, illegal_quantity

LONGEST = 255
PLACES = 3
"""Temporaries at once."""


class Descriptor:
    """A string: ``length`` characters at ``address``. A variable's changes when strings move."""

    __slots__ = ("address", "length")

    def __init__(self, length: int, address: int) -> None:
        self.length = length
        self.address = address


EMPTY = Descriptor(0, 0xE09A)
"""What a string variable reads as that was never assigned: a zero in ROM."""


class StringArea:
    """The strings of a machine, in ``ram`` between the arrays' end and HIMEM, from the ``top``.

    ``floor()`` is the first address it may not grow past; ``held()`` gives the descriptors that
    variables and arrays hold, in the order in which they lie in memory.
    """

    def __init__(
        self,
        ram: bytearray,
        top: int,
        floor: Callable[[], int],
        held: Callable[[], Iterable[Descriptor]],
    ) -> None:
        self.top = top
        self.bottom = top
        self.temporaries: list[Descriptor] = []
        self._ram = ram
        self._floor = floor
        self._held = held

    def put_top(self, address: int) -> None:
        """HIMEM: strings that exist stay where they are, above or below."""
        self.top = self.bottom = address

    def clear(self) -> None:
        """CLEAR: no strings."""
        self.bottom = self.top
        self.temporaries.clear()

    # --- room ---------------------------------------------------------------------------------

    def collect(self) -> None:
        """Move the strings that variables hold together below HIMEM, the highest first.

        When the highest of those left to move is a temporary, the ROM takes it for the end: it and
        all strings below stay where they are, and what is made later overwrites them.
        """
        self.bottom = self.top
        floor, ram = self._floor(), self._ram
        strings = [(each.address, n, each) for n, each in enumerate(self._strings()) if each.length]
        for address, _, string in sorted(strings, key=lambda entry: entry[:2], reverse=True):
            if not floor <= address < self.bottom:
                continue
            if string in self.temporaries:
                return
            self.bottom -= string.length
            ram[self.bottom : self.bottom + string.length] = ram[address : address + string.length]
            string.address = self.bottom

    def _strings(self) -> Iterable[Descriptor]:
        yield from self.temporaries
        yield from self._held()

    def take(self, size: int) -> int:
        """The address of new room. Raises OUT OF MEMORY."""
        if self.bottom - size < self._floor():
            self.collect()
            if self.bottom - size < self._floor():
                raise ApplesoftError("OUT OF MEMORY")
        self.bottom -= size
        return self.bottom

    # --- characters and temporaries -----------------------------------------------------------

    def text(self, string: Descriptor) -> str:
        """Its characters, codes 0 to 255."""
        return self._ram[string.address : string.address + string.length].decode("latin-1")

    def temporary(self, length: int, address: int) -> Descriptor:
        """A new temporary. Raises FORMULA TOO COMPLEX."""
        if len(self.temporaries) == PLACES:
            raise ApplesoftError("FORMULA TOO COMPLEX")
        string = Descriptor(length, address)
        self.temporaries.append(string)
        return string

    def release(self, string: Descriptor) -> bool:
        """Give back the place of a temporary if it is the latest; whether it was one."""
        if self.temporaries and self.temporaries[-1] is string:
            self.temporaries.pop()
            return True
        return False

    def free(self, string: Descriptor) -> Descriptor:
        """A string has been used: a temporary gives back its place, and its room if it is the
        lowest."""
        if self.release(string) and string.address == self.bottom:
            self.bottom += string.length
        return string

    def used(self, string: Descriptor) -> str:
        """The characters of a string that has been used with that."""
        text = self.text(string)
        self.free(string)
        return text

    def shown(self, text: str) -> str:
        """The characters of a string in the program that is used at once. Raises FORMULA TOO
        COMPLEX if there is no place for it."""
        if len(self.temporaries) == PLACES:
            raise ApplesoftError("FORMULA TOO COMPLEX")
        return text

    # --- operations that make a string --------------------------------------------------------

    def new(self, text: str) -> Descriptor:
        """A string for a variable, its characters put into the area. Raises OUT OF MEMORY."""
        address = self.take(len(text))
        self._ram[address : address + len(text)] = text.encode("latin-1")
        return Descriptor(len(text), address)

    def made(self, text: str) -> Descriptor:
        """A temporary with these characters. Raises OUT OF MEMORY and FORMULA TOO COMPLEX."""
        string = self.new(text)
        return self.temporary(string.length, string.address)

    def kept(self, string: Descriptor) -> Descriptor:
        """What assigning a temporary stores: the string itself."""
        self.release(string)
        return string

    def copied(self, string: Descriptor) -> Descriptor:
        """What assigning a variable stores: a copy, unless the characters are the program's."""
        if string.address < self.bottom:
            return Descriptor(string.length, string.address)
        address = self.take(string.length)
        self._move(string.address, address, string.length)
        return Descriptor(string.length, address)

    def _move(self, source: int, target: int, length: int) -> None:
        """The ROM copies the last character first."""
        ram = self._ram
        if target < source < target + length:
            for offset in range(length - 1, -1, -1):
                ram[target + offset] = ram[source + offset]
        else:
            ram[target : target + length] = ram[source : source + length]

    def joined(self, left: Descriptor, right: Descriptor) -> Descriptor:
        """left + right. Raises STRING TOO LONG past 255 characters."""
        length = left.length + right.length
        if length > LONGEST:
            raise ApplesoftError("STRING TOO LONG")
        address = self.take(length)
        self._move(left.address, address, left.length)
        self.free(right)
        self._move(right.address, address + left.length, right.length)
        self.free(left)
        return self.temporary(length, address)

    def _part(self, string: Descriptor, first: int, length: int) -> Descriptor:
        address = self.take(length)
        source = string.address + first
        self.free(string)
        self._move(source, address, length)
        return self.temporary(length, address)

    def left(self, string: Descriptor, n: int) -> Descriptor:
        """LEFT$. Raises ILLEGAL QUANTITY for n = 0, as all three do."""
        if not n:
            raise illegal_quantity()
        return self._part(string, 0, min(n, string.length))

    def right(self, string: Descriptor, n: int) -> Descriptor:
        """RIGHT$."""
        if not n:
            raise illegal_quantity()
        n = min(n, string.length)
        return self._part(string, string.length - n, n)

    def mid(self, string: Descriptor, n: int, length: int = LONGEST) -> Descriptor:
        """MID$; without a length, all the rest."""
        if not n:
            raise illegal_quantity()
        first = min(n - 1, string.length)
        return self._part(string, first, min(length, string.length - first))

    # --- operations that use one --------------------------------------------------------------

    def compare(self, left: Descriptor, right: Descriptor) -> int:
        """1 if the left string is larger, 0 if they are equal, -1 if it is smaller."""
        other = self.used(right)
        text = self.used(left)
        return (text > other) - (text < other)

    def code(self, string: Descriptor) -> int:
        """ASC. Raises ILLEGAL QUANTITY for the empty string."""
        text = self.used(string)
        if not text:
            raise illegal_quantity()
        return ord(text[0])
