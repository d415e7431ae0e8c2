"""Strings: what each operation makes of them, and the memory they take.

A string is a Python ``str`` of characters 0 to 255. One that stands in the program's text is a
`Literal`: variables may share it, and it takes no room. Every other string takes its length in the
string area, which grows down from HIMEM; when it meets the arrays, strings no variable holds any
more are collected, and if that is not enough: OUT OF MEMORY.
"""

from __future__ import annotations

from collections.abc import Callable

from ..applesoft.errors import ApplesoftError, illegal_quantity
from ..applesoft.real import Number

LONGEST = 255


class Literal(str):
    """A string in the program's text."""

    __slots__ = ()


class StringArea:
    """The room between the arrays' end and HIMEM, from the top.

    ``floor()`` is the first address it may not grow past; ``live()`` counts the characters that
    variables hold.
    """

    def __init__(self, top: int, floor: Callable[[], int], live: Callable[[], int]) -> None:
        self.top = top
        self.bottom = top
        self._floor = floor
        self._live = live

    def put_top(self, address: int) -> None:
        """HIMEM: strings that exist stay where they are, above or below."""
        self.top = self.bottom = address

    def clear(self) -> None:
        """CLEAR: no strings."""
        self.bottom = self.top

    def collect(self) -> None:
        """Forget strings that no variable holds."""
        self.bottom = self.top - self._live()

    def take(self, size: int) -> None:
        """Room for a string. Raises OUT OF MEMORY."""
        if self.bottom - size < self._floor():
            self.collect()
            if self.bottom - size < self._floor():
                raise ApplesoftError("OUT OF MEMORY")
        self.bottom -= size

    # --- operations that make a string --------------------------------------------------------

    def made(self, text: str) -> str:
        """A new string. Raises OUT OF MEMORY."""
        self.take(len(text))
        return text

    def copy(self, text: str) -> str:
        """What assigning one variable to another stores: a copy, unless it is a literal."""
        if text.__class__ is str:
            self.take(len(text))
        return text

    def joined(self, left: str, right: str) -> str:
        """left + right. Raises STRING TOO LONG past 255 characters."""
        text = str.__add__(left, right)
        if len(text) > LONGEST:
            raise ApplesoftError("STRING TOO LONG")
        self.take(len(text))
        return text

    def left(self, text: str, n: int) -> str:
        """LEFT$. Raises ILLEGAL QUANTITY for n = 0, as all three do."""
        if not n:
            raise illegal_quantity()
        return self.made(str(text[:n]))

    def right(self, text: str, n: int) -> str:
        """RIGHT$."""
        if not n:
            raise illegal_quantity()
        return self.made(str(text[-n:]))

    def mid(self, text: str, n: int, length: int = LONGEST) -> str:
        """MID$; without a length, all the rest."""
        if not n:
            raise illegal_quantity()
        return self.made(str(text[n - 1 : n - 1 + length]))

    def character(self, code: int) -> str:
        """CHR$."""
        self.take(1)
        return chr(code)


def code(text: str) -> int:
    """ASC. Raises ILLEGAL QUANTITY for the empty string."""
    if not text:
        raise illegal_quantity()
    return ord(text[0])


def value(text: str, read: Callable[[str, int], tuple[Number, int]]) -> Number:
    """VAL: the number the text begins with, zero if it begins with none. Raises OVERFLOW."""
    # a zero byte ends the text
    return read(text.partition("\0")[0], 0)[0]
