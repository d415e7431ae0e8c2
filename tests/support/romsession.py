"""Sessions at the ROM's own prompt: run the restored listing on a scene, or make one calculation.

Everything is typed with the keys a user would press; lower-case letters are POKEd into the listing,
as was usual in 1988. Variables are read from memory by the reference manual's appendix "Applesoft
in memory"; calculations use the entry points of John Crossley, "Applesoft Internal Entry Points"
(Apple Orchard, March 1980).
"""

import re
from functools import cached_property
from typing import Any

from romapple import Apple, Lost, State

from impact88.errors import UserError
from impact88.files import packaged_text
from impact88.program.scene import LISTING, Scene

PROMPT = "]"
LONGEST_TYPED = 239  # characters that the monitor's line reader keeps, by Apple's documents


class Session:
    """A switched-on Apple with a ROM. Raises UserError when the ROM does not come to a ``]``."""

    def __init__(self, rom: bytes) -> None:
        self.apple = Apple(rom)
        try:
            displayed = self.apple.boot()
        except Lost as lost:
            raise UserError(f"this ROM does not come to a prompt: {lost}") from None
        if displayed.rstrip()[-1:] != PROMPT:
            raise UserError(f"this ROM comes to {displayed[-20:]!r}, no prompt of Applesoft")
        self.fresh = self.apple.state()
        """The machine at its first prompt."""

    @cached_property
    def with_listing(self) -> State:
        """The machine at the prompt with the listing typed in."""
        self.apple.restore(self.fresh)
        program = packaged_text("impact88.legacy", LISTING)
        lines = program.splitlines()
        for line in lines:
            self._enter(line)
        for command in small_letters(self.apple, program):
            self._enter(command)
        return self.apple.state()

    def run_scene(self, scene: Scene) -> dict[str, Any]:
        """RUN the listing, typed once, on a scene.

        Returns, in the captures' form, the ``printout`` after the echo of RUN, the ``reals``, and
        the array ``A``. Raises UserError for a line too long to be typed, and for a program that
        does not end.
        """
        self.apple.restore(self.with_listing)
        for line in scene.typed_lines():
            self._enter(line)
        printout = self._run("".join(f"{reply}\n" for reply in scene.keyboard()))
        return {"printout": printout, "reals": _reals(self.apple), "A": _array_a(self.apple)}

    def calculate(self, operation: str, first: str, second: str, extension: str) -> str:
        """Call one routine of the ROM's arithmetic; arguments and result in the captures' form: a
        number is ``stored:raw:extension``, an error ``E`` and its code."""
        apple = self.apple
        apple.restore(self.fresh)
        operand = [_LDA, _OPERAND & 0xFF, _LDY, _OPERAND >> 8]
        if operation == "fin":
            _put(apple, _BUFFER, first.encode("ascii") + b"\0")
            _put(apple, TEXT_POINTER, _BUFFER.to_bytes(2, "little"))
            code = [*_jsr(CHRGOT), *_jsr(READ_NUMBER)]
        else:
            accumulator = bytes.fromhex(second or first)
            _put(apple, FAC, bytes([accumulator[0], accumulator[1] | 0x80, *accumulator[2:]]))
            _put(apple, FAC_SIGN, accumulator[1:2])
            _put(apple, FAC_EXTENSION, bytes.fromhex(extension))
            _put(apple, _OPERAND, bytes.fromhex(first))
            if operation in WITH_MEMORY:
                code = [*operand, *_jsr(WITH_MEMORY[operation])]
            elif operation == "pow":  # A and the flags must show the accumulator's exponent
                code = [*operand, *_jsr(LOAD_ARGUMENT), _LDA_ZERO, FAC, *_jsr(POWER)]
            else:
                code = _jsr(OF_ACCUMULATOR[operation])
        error = _execute(apple, code)
        if error:
            return error
        if operation == "cmp":
            return f"{apple.cpu.a:02x}"
        if operation == "fout":
            start = apple.cpu.a + 256 * apple.cpu.y
            return bytes(apple.memory[start : start + 20]).partition(b"\0")[0].decode("ascii")
        raw = bytes(apple.memory[FAC : FAC_SIGN + 1]).hex()
        low = f"{apple.memory[FAC_EXTENSION]:02x}"
        error = _execute(apple, [_LDX, *operand[1:], *_jsr(STORE_ROUNDED)])
        return error or f"{bytes(apple.memory[_OPERAND : _OPERAND + 5]).hex()}:{raw}:{low}"

    def _enter(self, line: str) -> None:
        if len(line) > LONGEST_TYPED:
            raise UserError(
                f"{line[:20]}… has {len(line)} characters; {LONGEST_TYPED} can be typed on a line"
            )
        self.apple.type_keys(f"{line}\n")

    def _run(self, keys: str) -> str:
        """Type RUN and the keys; return the output from the echo of RUN to the final prompt."""
        self.apple.take_output()
        self.apple.type_keys(f"RUN\n{keys}")
        return self.apple.take_output().partition("RUN\n")[2].removesuffix(f"\n{PROMPT}")


# zero-page pointers to the start of each area, which extends to the next one
PROGRAM = 0x67
VARIABLES = 0x69
ARRAYS = 0x6B
ARRAYS_END = 0x6D
_ENTRY_SIZE = 7  # bytes of a simple variable, two of them its name
_NUMBER_SIZE = 5  # bytes of a stored number
_VERBATIM = re.compile(r'"[^"\n]*"?|\bREM\b(.*)')
"""Parts of a program that Applesoft keeps as they are typed: strings and remarks."""


def _reals(apple: Apple) -> dict[str, str]:
    """Return every real variable by name, oldest first: five stored bytes in hexadecimal."""
    entries = range(apple.word(VARIABLES), apple.word(ARRAYS), _ENTRY_SIZE)
    memory = (bytes(apple.memory[place : place + _ENTRY_SIZE]) for place in entries)
    # strings, integers and functions have a high bit in their names
    return {_name(entry): entry[2:].hex() for entry in memory if entry[:2].isascii()}


def _array_a(apple: Apple) -> dict[str, Any] | None:
    """Return the array of reals A: ``dims`` (sizes) and ``data``, first subscript fastest; None if
    there is none."""
    memory = apple.memory
    place, end = apple.word(ARRAYS), apple.word(ARRAYS_END)
    while place < end and (size := apple.word(place + 2)):
        start = place + 5 + 2 * memory[place + 4]
        if _name(memory[place : place + 2]) == "A":
            # the last subscript's size comes first, the high byte before the low
            sizes = [256 * memory[at] + memory[at + 1] for at in range(start - 2, place + 4, -2)]
            data = bytes(memory[start : place + size])
            starts = range(0, len(data), _NUMBER_SIZE)
            cells = [data[at : at + _NUMBER_SIZE].hex() for at in starts]
            return {"dims": sizes, "data": cells}
        place += size
    return None


def _name(entry: bytes | bytearray) -> str:
    return entry[:2].decode("latin-1").rstrip("\0")


def small_letters(apple: Apple, program: str) -> list[str]:
    """Return the POKE commands that put lower-case letters into a program's strings and remarks; an
    Apple II Plus has no keys for them. Raises ValueError when another program is in memory."""
    place = apple.word(PROGRAM)
    commands = []
    verbatim_texts = (match[1] or match[0] for match in _VERBATIM.finditer(program))
    for verbatim in filter(re.compile("[a-z]").search, verbatim_texts):
        text = verbatim.upper().encode("ascii")
        place = apple.memory.find(text, place)
        if place < 0:
            raise ValueError(f"the program in memory does not hold {verbatim!r}")
        letters = enumerate(verbatim, place)
        commands += [f"POKE {at},{ord(letter)}" for at, letter in letters if letter.islower()]
        place += len(text)
    return commands


# the floating-point accumulator in page 0
FAC = 0x9D  # exponent, then four mantissa bytes
FAC_SIGN = 0xA2
FAC_EXTENSION = 0xAC  # the eight bits below the mantissa

TEXT_POINTER = 0xB8  # address of the text that the ROM reads

# routines of the ROM
CHRGOT = 0xB7
LOAD_ARGUMENT = 0xE9E3
STORE_ROUNDED = 0xEB2B
POWER = 0xEE97  # argument to the power of the accumulator
READ_NUMBER = 0xEC4A  # reads the number at the text pointer
ERROR = 0xD412  # every error comes here, with its code in X
WITH_MEMORY = {"add": 0xE7BE, "sub": 0xE7A7, "mul": 0xE97F, "div": 0xEA66, "cmp": 0xEBB2}
"""Routines of two operands: the first in memory, the second in the accumulator."""
OF_ACCUMULATOR = {
    "neg": 0xEED0,
    "abs": 0xEBAF,
    "sgn": 0xEB90,
    "int": 0xEC23,
    "sqr": 0xEE8D,
    "exp": 0xEF09,
    "log": 0xE941,
    "sin": 0xEFF1,
    "cos": 0xEFEA,
    "tan": 0xF03A,
    "atn": 0xF09E,
    "fout": 0xED34,
}
"""Routines of one operand, in the accumulator."""

# memory used here: page 3 is free for users
_OPERAND = 0x0300
_STUB = 0x0310
_BACK = 0x0340
_BUFFER = 0x0200  # the input buffer, for a number to be read

# opcodes
_LDA = 0xA9  # immediate, as the next two
_LDY = 0xA0
_LDX = 0xA2
_LDA_ZERO = 0xA5
_JSR = 0x20
_JMP = 0x4C


def _jsr(address: int) -> list[int]:
    return [_JSR, address & 0xFF, address >> 8]


def _put(apple: Apple, address: int, data: bytes) -> None:
    for place, byte in enumerate(data, address):
        apple.memory[place] = byte


def _execute(apple: Apple, code: list[int]) -> str:
    """Run machine code; return the error it ended in, in the captures' form, "" if none."""
    _put(apple, _STUB, bytes([*code, _JMP, _BACK & 0xFF, _BACK >> 8]))
    apple.cpu.sp = 0xF8
    return f"E{apple.cpu.x}" if apple.call(_STUB, (_BACK, ERROR)) == ERROR else ""
