"""The program in memory: numbered lines of tokens, and their image from address 2049 on.

In memory a line is the address of the next one, its number (two bytes each, low byte first), its
tokens and a zero; two zeros end the program.
"""

from __future__ import annotations

from bisect import bisect_left

START = 0x801
"""TXTTAB: where the program begins. The byte before it is zero."""
HEADER = 4


class ProgramText:
    """Lines by number, in order."""

    def __init__(self) -> None:
        self.numbers: list[int] = []
        self.tokens: dict[int, bytes] = {}
        self._image: bytes | None = None
        self._starts: list[int] = []
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
        at = bisect_left(self.numbers, number)
        known = self.numbers[at : at + 1] == [number]
        if tokens:
            if not known:
                self.numbers.insert(at, number)
            self.tokens[number] = tokens
        elif known:
            del self.numbers[at]
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
            self._starts = []
            for number in self.numbers:
                self._starts.append(START + len(out))
                tokens = self.tokens[number]
                link = START + len(out) + HEADER + len(tokens) + 1
                out += bytes((link & 0xFF, link >> 8 & 0xFF, number & 0xFF, number >> 8))
                out += tokens + b"\0"
            self._image = bytes(out + b"\0\0")
        return self._image

    @property
    def end(self) -> int:
        """PRGEND: the address past the program."""
        return START + len(self.image) + self.spare

    def address_of(self, number: int) -> int:
        """The address of a line."""
        assert self.image is not None
        return self._starts[bisect_left(self.numbers, number)]
