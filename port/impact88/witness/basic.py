"""What Applesoft keeps in memory, by the reference manual's appendix "Applesoft in memory": the
program's lines, the variables, the arrays."""

import re
from collections.abc import Iterator
from typing import Any

from .apple import Apple

PROGRAM, VARIABLES, ARRAYS, ARRAYS_END = 0x67, 0x69, 0x6B, 0x6D
"""Zero-page pointers to where each begins; what is in between belongs to the one before."""
_ENTRY, _NUMBER = 7, 5
"""Bytes of a simple variable, two of them its name, and of a number."""
_NOT_ASCII = 0x80
_SPOKEN = re.compile(r'"[^"]*"?|\bREM\b(.*)')
"""The parts of a line that Applesoft keeps as they are typed."""


def reals(apple: Apple) -> dict[str, str]:
    """Every real variable by name, oldest first: five stored bytes in hexadecimal."""
    memory = apple.memory
    values = {}
    for place in range(apple.word(VARIABLES), apple.word(ARRAYS), _ENTRY):
        first, second = memory[place], memory[place + 1]
        if not (first | second) & _NOT_ASCII:  # strings, integers and functions are marked there
            values[_name(first, second)] = bytes(memory[place + 2 : place + _ENTRY]).hex()
    return values


def array(apple: Apple, name: str) -> dict[str, Any] | None:
    """An array of reals: ``dims`` (sizes) and ``data``, first subscript fastest; or None."""
    memory = apple.memory
    place, end = apple.word(ARRAYS), apple.word(ARRAYS_END)
    while place < end and (size := apple.word(place + 2)):
        start = place + 5 + 2 * memory[place + 4]
        if _name(memory[place], memory[place + 1]) == name:
            # the last subscript's size stands first, the high byte before the low
            sizes = [256 * memory[at] + memory[at + 1] for at in range(start - 2, place + 4, -2)]
            data = bytes(memory[start : place + size])
            cells = [data[at : at + _NUMBER].hex() for at in range(0, len(data), _NUMBER)]
            return {"dims": sizes, "data": cells}
        place += size
    return None


def _name(first: int, second: int) -> str:
    return (chr(first) + chr(second)).rstrip("\0")


def small_letters(apple: Apple, program: str) -> list[str]:
    """The POKEs, as commands for the prompt, that put small letters, which no key of an Apple II
    Plus types, into a program's texts in quotes and remarks. Raises ValueError when the program in
    memory is another."""
    texts = dict(_lines(apple))
    commands = []
    for line in program.splitlines():
        number, _, rest = line.partition(" ")
        for spoken in (match[1] or match[0] for match in _SPOKEN.finditer(rest)):
            if spoken == spoken.upper():
                continue
            place, text = texts[int(number)]
            offset = text.find(spoken.upper().encode("ascii"))
            if offset < 0:
                raise ValueError(f"line {number} in memory does not hold {spoken!r}")
            letters = enumerate(spoken, place + offset)
            commands += [f"POKE {at},{ord(letter)}" for at, letter in letters if letter.islower()]
    return commands


def _lines(apple: Apple) -> Iterator[tuple[int, tuple[int, bytes]]]:
    """The program in memory: line number, and where its text begins, and the text."""
    place = apple.word(PROGRAM)
    while following := apple.word(place):
        text = bytes(apple.memory[place + 4 : following - 1])
        yield apple.word(place + 2), (place + 4, text)
        place = following
