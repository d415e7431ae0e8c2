"""The program in memory: numbered lines of tokens, and their image from address 2049 on.

In memory a line is the address of the next one, its number (two bytes each, low byte first), its
tokens and a zero; two zeros end the program. LIST and GOTO follow the addresses; a running program
goes on with the bytes behind a line's zero. The two agree unless a program pokes into itself.
"""

from __future__ import annotations

from bisect import bisect_left
from typing import NamedTuple

START = 0x801
"""TXTTAB: where the program begins. The byte before it is zero."""
HEADER = 4
END_OF_LINE = 0


class Line(NamedTuple):
    """A line as it lies in memory."""

    address: int
    number: int
    tokens: bytes

    @property
    def text(self) -> int:
        """Where its tokens begin."""
        return self.address + HEADER

    @property
    def end(self) -> int:
        """The address behind its zero."""
        return self.text + len(self.tokens) + 1


class ProgramText:
    """Lines by number, in order, and in ``ram``."""

    def __init__(self, ram: bytearray) -> None:
        self.numbers: list[int] = []
        self.tokens: dict[int, bytes] = {}
        self._ram = ram
        self._image: bytes | None = None
        self._lines: list[Line] = []
        self.as_stored = True
        """Whether links and lines agree: nothing was poked into the program."""
        self.spare = 0
        """NEW, typed, leaves one byte more than the program takes, for good."""

    def __len__(self) -> int:
        return len(self.numbers)

    def clear(self) -> None:
        """NEW."""
        self.numbers = []
        self.tokens = {}
        self._image = None

    def store(self, number: int, tokens: bytes) -> None:
        """Put a line in, or take it out if it has no tokens."""
        index = bisect_left(self.numbers, number)
        known = self.numbers[index : index + 1] == [number]
        if tokens:
            if not known:
                self.numbers.insert(index, number)
            self.tokens[number] = tokens
        elif known:
            del self.numbers[index]
            del self.tokens[number]
        self._image = None

    def delete(self, first: int, last: int) -> bool:
        """DEL: take out a range; False if the range lies before its own beginning."""
        low = bisect_left(self.numbers, first)
        high = bisect_left(self.numbers, last + 1)
        if high < low:
            return False
        for number in self.numbers[low:high]:
            del self.tokens[number]
        del self.numbers[low:high]
        self._image = None
        return True

    def between(self, first: int, last: int) -> list[int]:
        """The numbers of the lines in a range."""
        return self.numbers[bisect_left(self.numbers, first) : bisect_left(self.numbers, last + 1)]

    @property
    def image(self) -> bytes:
        """The bytes from `START` on, the two zeros at the end included."""
        if self._image is None:
            out = bytearray()
            self.as_stored = True
            self._lines = []
            for number in self.numbers:
                line = Line(START + len(out), number, self.tokens[number])
                self._lines.append(line)
                out += bytes((line.end & 0xFF, line.end >> 8 & 0xFF, number & 0xFF, number >> 8))
                out += line.tokens + bytes((END_OF_LINE,))
            self._image = bytes(out + b"\0\0")
            self._ram[START - 1] = 0
            room = self._ram[START : START + len(self._image)]
            self._ram[START : START + len(room)] = self._image[: len(room)]
        return self._image

    @property
    def end(self) -> int:
        """PRGEND: the address past the program."""
        return START + len(self.image) + self.spare

    @property
    def lines(self) -> list[Line]:
        """The lines in the order in which their addresses follow each other."""
        assert self.image is not None
        return self._lines

    def poke(self, address: int, value: int) -> bool:
        """Change a byte; whether that changed a line.

        The lines are found again by following the addresses, as LIST finds them, until one leads
        out of the program or back.
        """
        image = bytearray(self.image)
        offset = address - START
        if not 0 <= offset < len(image):
            self._ram[address] = value
            return False
        image[offset] = self._ram[address] = value
        self._image = bytes(image)
        before = self.flow()
        followed = self._lines, self._followed()
        self._lines = followed[1]
        self.as_stored = False
        self.numbers = [line.number for line in self._lines]
        self.tokens = {line.number: line.tokens for line in reversed(self._lines)}
        return before != self.flow() or followed[0] != followed[1]

    def _followed(self) -> list[Line]:
        image = self.image
        lines: list[Line] = []
        passed: set[int] = set()
        address = START
        while START <= address <= START + len(image) - HEADER - 1 and address not in passed:
            offset = address - START
            following = image[offset] + 256 * image[offset + 1]
            if following < 256:
                break
            passed.add(address)
            text = offset + HEADER
            end = image.find(END_OF_LINE, text)
            number = image[offset + 2] + 256 * image[offset + 3]
            lines.append(Line(address, number, image[text : end if end >= 0 else len(image)]))
            address = following
        return lines

    def flow(self) -> list[Line]:
        """The lines in the order in which a program runs through them: each begins behind the zero
        of the one before, whatever the addresses say."""
        image = self.image
        if self.as_stored:
            return self._lines
        lines = []
        offset = 0
        while offset + HEADER < len(image) - 1:
            end = image.find(END_OF_LINE, offset + HEADER)
            end = len(image) if end < 0 else end
            number = image[offset + 2] + 256 * image[offset + 3]
            lines.append(Line(START + offset, number, image[offset + HEADER : end]))
            offset = end + 1
        return lines

    def ends_at(self, address: int) -> bool:
        """Whether a program ends that comes to an address: the high byte of a line's link is 0."""
        offset = address - START
        return self.image[offset + 1 : offset + 2] in (b"", b"\0")
