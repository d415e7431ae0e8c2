"""Sessions at the ROM's own prompt: the restored listing on a scene, any program, one calculation.

All is done with the keys a user would press; small letters are POKEd into the listing, as was done
in the days. What is left is found by the reference manual's appendix "Applesoft in memory";
calculations enter by John Crossley, "Applesoft Internal Entry Points" (Apple Orchard, March 1980).
"""

import re
from functools import cached_property
from typing import Any

from ...errors import UserError
from ...files import packaged_text
from ...messages.progress import progress
from ...program.emulated import LISTING
from ...program.scene import Scene
from .apple import Apple, Lost, State

PROMPT = "]"
_OTHER_PROMPTS = {
    "*": "the monitor's prompt *: an older monitor, or no Applesoft in this ROM",
    ">": "the prompt > of Integer BASIC; the listing is Applesoft",
}
LONGEST_TYPED = 239
"""Characters of the longest line the monitor's line reader keeps; Apple's documents say so."""


class Session:
    """A switched-on Apple with a ROM. Raises UserError when the ROM does not come to a ``]``."""

    def __init__(self, rom: bytes) -> None:
        self.apple = Apple(rom)
        try:
            displayed = self.apple.boot()
        except Lost as lost:
            raise UserError(f"this ROM does not come to a prompt: {lost}") from None
        last = displayed.rstrip()[-1:]
        if last != PROMPT:
            what = _OTHER_PROMPTS.get(last, f"{displayed[-20:]!r}, no prompt of Applesoft")
            raise UserError(f"this ROM comes to {what}")
        self._fresh = self.apple.state()

    @cached_property
    def _with_listing(self) -> State:
        self.apple.restore(self._fresh)
        program = packaged_text("impact88.legacy", LISTING)
        lines = program.splitlines()
        with progress(len(lines), "typing the listing in") as meter:
            for line in lines:
                self._enter(line)
                meter.update(1)
        for command in small_letters(self.apple, program):
            self._enter(command)
        return self.apple.state()

    def run_scene(self, scene: Scene) -> dict[str, Any]:
        """RUN the listing, typed once, on a scene: in the captures' form the ``printout`` after the
        echo of RUN, the ``reals``, and the array ``A``. Raises UserError for a line too long to be
        typed and a program that does not come to an end."""
        self.apple.restore(self._with_listing)
        self.apple.blanks = False
        for line in scene.typed_lines():
            self._enter(line)
        printout = self._run("".join(f"{reply}\n" for reply in scene.keyboard()))
        return {"printout": printout, "reals": _reals(self.apple), "A": _array_a(self.apple)}

    def run_program(self, program: str, keys: str = "", *, blanks: bool = True) -> str:
        """Type a program in, RUN, then the keys: what is displayed, without the prompts' NULs."""
        self.apple.restore(self._fresh)
        self.apple.blanks = blanks
        for line in filter(None, program.split("\n")):
            self._enter(line)
        return self._run(keys).replace("\0", "")

    def calculate(self, operation: str, first: str, second: str, extension: str) -> str:
        """One call of the ROM's arithmetic, asked and answered in the captures' form: a number is
        ``stored:raw:extension``, an error ``E`` and its code."""
        apple = self.apple
        apple.restore(self._fresh)
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
        """RUN and the keys: what is displayed after the echo of RUN up to the final prompt."""
        self.apple.take_output()
        self.apple.type_keys(f"RUN\n{keys}")
        return self.apple.take_output().partition("RUN\n")[2].removesuffix(f"\n{PROMPT}")


PROGRAM, VARIABLES, ARRAYS, ARRAYS_END = 0x67, 0x69, 0x6B, 0x6D
"""Zero-page pointers to where each begins; what is in between belongs to the one before."""
_ENTRY, _NUMBER = 7, 5
"""Bytes of a simple variable, two of them its name, and of a number; the ROM's."""
_SPOKEN = re.compile(r'"[^"\n]*"?|\bREM\b(.*)')
"""The parts of a program that Applesoft keeps as they are typed."""


def _reals(apple: Apple) -> dict[str, str]:
    """Every real variable by name, oldest first: five stored bytes in hexadecimal."""
    entries = range(apple.word(VARIABLES), apple.word(ARRAYS), _ENTRY)
    memory = (bytes(apple.memory[place : place + _ENTRY]) for place in entries)
    # strings, integers and functions have a high bit in their names
    return {_name(entry): entry[2:].hex() for entry in memory if entry[:2].isascii()}


def _array_a(apple: Apple) -> dict[str, Any] | None:
    """The array of reals A: ``dims`` (sizes) and ``data``, first subscript fastest; or None."""
    memory = apple.memory
    place, end = apple.word(ARRAYS), apple.word(ARRAYS_END)
    while place < end and (size := apple.word(place + 2)):
        start = place + 5 + 2 * memory[place + 4]
        if _name(memory[place : place + 2]) == "A":
            # the last subscript's size stands first, the high byte before the low
            sizes = [256 * memory[at] + memory[at + 1] for at in range(start - 2, place + 4, -2)]
            data = bytes(memory[start : place + size])
            cells = [data[at : at + _NUMBER].hex() for at in range(0, len(data), _NUMBER)]
            return {"dims": sizes, "data": cells}
        place += size
    return None


def _name(entry: bytes | bytearray) -> str:
    return entry[:2].decode("latin-1").rstrip("\0")


def small_letters(apple: Apple, program: str) -> list[str]:
    """The POKEs, as commands for the prompt, that put small letters, which no key of an Apple II
    Plus types, into a program's texts in quotes and remarks. Raises ValueError when the program in
    memory is another."""
    place = apple.word(PROGRAM)
    commands = []
    spoken_texts = (match[1] or match[0] for match in _SPOKEN.finditer(program))
    for spoken in filter(re.compile("[a-z]").search, spoken_texts):
        text = spoken.upper().encode("ascii")
        place = apple.memory.find(text, place)
        if place < 0:
            raise ValueError(f"the program in memory does not hold {spoken!r}")
        letters = enumerate(spoken, place)
        commands += [f"POKE {at},{ord(letter)}" for at, letter in letters if letter.islower()]
        place += len(text)
    return commands


FAC, FAC_SIGN, FAC_EXTENSION = 0x9D, 0xA2, 0xAC
"""The accumulator: exponent, four mantissa bytes; its sign byte; the eight bits below."""
TEXT_POINTER, CHRGOT, LOAD_ARGUMENT, STORE_ROUNDED = 0xB8, 0xB7, 0xE9E3, 0xEB2B
"""The ROM's pointer to the text it reads, and three of its routines."""
ERROR = 0xD412
"""Where every error goes, with its code in X."""
WITH_MEMORY = {"add": 0xE7BE, "sub": 0xE7A7, "mul": 0xE97F, "div": 0xEA66, "cmp": 0xEBB2}
"""Memory and accumulator: the first operand is the one in memory."""
OF_ACCUMULATOR = {
    **{"neg": 0xEED0, "abs": 0xEBAF, "sgn": 0xEB90, "int": 0xEC23, "sqr": 0xEE8D, "exp": 0xEF09},
    **{"log": 0xE941, "sin": 0xEFF1, "cos": 0xEFEA, "tan": 0xF03A, "atn": 0xF09E, "fout": 0xED34},
}
POWER, READ_NUMBER = 0xEE97, 0xEC4A
"""Argument to the power of the accumulator; the number at the text pointer."""
_OPERAND, _STUB, _BACK, _BUFFER = 0x0300, 0x0310, 0x0340, 0x0200
"""Page 3 is the user's; a number to be read stands in the input buffer."""
_LDA, _LDY, _LDX, _LDA_ZERO, _JSR, _JMP = 0xA9, 0xA0, 0xA2, 0xA5, 0x20, 0x4C
"""Opcodes; the first three take the number behind them."""


def _jsr(address: int) -> list[int]:
    return [_JSR, address & 0xFF, address >> 8]


def _put(apple: Apple, address: int, data: bytes) -> None:
    for place, byte in enumerate(data, address):
        apple.memory[place] = byte


def _execute(apple: Apple, code: list[int]) -> str:
    """Run machine code; the error it ended in, in the captures' form."""
    _put(apple, _STUB, bytes([*code, _JMP, _BACK & 0xFF, _BACK >> 8]))
    apple.cpu.sp = 0xF8
    return f"E{apple.cpu.x}" if apple.call(_STUB, (_BACK, ERROR)) == ERROR else ""
