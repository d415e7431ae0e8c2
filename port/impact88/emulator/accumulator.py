"""What earlier statements leave behind where the ROM looks without having put anything there.

Three leftovers show in programs. The *number* in the floating-point accumulator: IF takes it for a
string's truth, CHR$ and PEEK for its value. The accumulator's *extension*: before a comparison the
ROM rounds its left operand, and a string's left operand is the address of its descriptor; from 128
on it points 256 bytes too high. And the *low byte* of what INT found last: a power of 2^32 or more
takes its parity from there.

They are followed as far as programs can see them without effort: the number in careful steps only
(`linking.Steps.careful`), the extension within one formula, the low byte through INT, EXP and ^.
Looking for the end of a string, a statement or a line the ROM uses the same low byte; that is
followed in careful steps, which a program with a constant power of 2^32 or more is made of.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..applesoft import decimaltext, functions
from ..applesoft.real import (
    INTEGER_EXPONENT,
    ZERO,
    Number,
    absolute,
    floor,
    multiply,
    negate,
    rounded,
    to_integer,
)
from .strings import EMPTY, Descriptor
from .variables import Variables, byte

AFTER_TYPING = (0xD0, 0xD0 << 32, 0)
"""What the ROM's parser leaves in the accumulator: an address."""
TEMPORARY = 0x55
"""Where the ROM keeps a temporary's descriptor, on page 0."""
ROUNDS = 0x80
UPPER_HALF = 0x8000


class Accumulator:
    """``number``, ``extension`` and the low byte, and the functions that set or ask for them."""

    def __init__(self, variables: Variables, ram: bytearray) -> None:
        self.number: Number = AFTER_TYPING
        self.extension = 0
        self._last_integer: Number = ZERO
        self._last_power: tuple[Number, ...] = ()
        self._variables = variables
        self._strings = variables.strings
        self._ram = ram

    # --- the number ---------------------------------------------------------------------------

    def load(self, value: Any) -> Any:
        """A number comes into the accumulator."""
        self.number = value
        return value

    def keep(self, string: Descriptor) -> Descriptor:
        """A string was made, its length and address put there."""
        self.number = self.residue(string)
        return string

    def residue(self, string: Descriptor) -> Number:
        """The number that a string just made is there: its length for an exponent, its address."""
        address = string.address
        mantissa = (address & 0xFF) << 32 | address >> 8 << 24 | TEMPORARY << 16
        return string.length, mantissa, self.number[2]

    def left_over(self) -> Number:
        """The number that an earlier formula left."""
        return self.number

    def printed(self, x: Number) -> str:
        """PRINT's characters; the number is taken apart, its sign is lost."""
        text = decimaltext.write(x)
        self.scan()
        self.number = (max(x[0], 1), x[1], 0) if x[0] else x
        return text

    # --- the extension ------------------------------------------------------------------------

    def byte(self, x: Number) -> int:
        """A value from 0 to 255; the extension is what was shifted out last, a byte at a time."""
        n = byte(x)
        moved = (INTEGER_EXPONENT - x[0]) // 8 if x[0] else 0
        self.extension = x[1] >> 8 * min(moved, 4) & 0xFF if moved else x[1] & 0xFF
        return n

    def character(self, x: Number) -> Descriptor:
        """CHR$."""
        return self._strings.made(chr(self.byte(x)))

    def digits(self, x: Number) -> Descriptor:
        """STR$."""
        self.scan()
        return self._strings.made(decimaltext.write(x))

    def literal(self, address: int, length: int) -> Descriptor:
        """A string in the program; the extension is the high byte of its address."""
        self.extension = address >> 8
        return self._strings.temporary(length, address)

    def joined(self, left: Descriptor, right: Descriptor) -> Descriptor:
        """left + right; the extension is the high byte of the address of left's descriptor."""
        high = 0
        if left is EMPTY:
            high = EMPTY.address >> 8
        elif self._variables.end_of_arrays() >= UPPER_HALF:
            high = self._variables.descriptor_address(left) >> 8
        string = self._strings.joined(left, right)
        self.extension = high
        return string

    def left_operand(self, string: Descriptor) -> Descriptor:
        """The left operand of a comparison, a temporary: rounded up, it is another one, which lies
        on the stack's page, and the temporary keeps its place."""
        if self.extension < ROUNDS or not string.length:
            return string
        place = TEMPORARY + 3 * (len(self._strings.temporaries) - 1) + 0x100
        length, low, high = self._ram[place : place + 3]
        return Descriptor(length, low + 256 * high)

    # --- the low byte -------------------------------------------------------------------------

    def floor(self, x: Number) -> Number:
        """INT."""
        whole = floor(x)
        if x[0] < INTEGER_EXPONENT:
            self._last_integer = whole
            self._last_power = ()
        return whole

    def exponential(self, x: Number) -> Number:
        """EXP."""
        result = functions.exponential(x)
        self._last_power = (x,)
        return result

    def square_root(self, x: Number) -> Number:
        """SQR."""
        return self.power(x, functions.HALF)

    def power(self, left: Number, right: Number) -> Number:
        """left ^ right."""
        result = functions.power(left, right)
        if left[2] and rounded(right)[0] >= INTEGER_EXPONENT:
            result = negate(absolute(result)) if self._low_byte() & 1 else absolute(result)
        self._last_power = (left, right)
        return result

    def scan(self) -> None:
        """The ROM looks for the end of a string, a statement or a line, by even characters."""
        self._last_integer, self._last_power = ZERO, ()

    def scanned(self, string: Descriptor) -> Descriptor:
        """A string for whose end the ROM has looked."""
        self.scan()
        return string

    def _low_byte(self) -> int:
        """Of what INT found last, be it within EXP or ^."""
        if not self._last_power:
            return to_integer(self._last_integer) & 0xFF
        *base, x = self._last_power
        if base:
            magnitude = absolute(rounded(base[0]))
            x = (
                multiply(rounded(x), functions.logarithm(magnitude))
                if magnitude[0] and x[0]
                else ZERO
            )
        return functions.exponential_integer(x) & 0xFF


def wrapped(accumulator: Accumulator, enter: Callable[[int], object]) -> dict[str, Any]:
    """The names that careful steps use besides: work done so many bytes down the stack,
    which ``enter`` is told, and its result left in the accumulator."""

    def number_at(depth: int, function: Callable[..., Any], *operands: Any) -> Any:
        enter(depth)
        result = accumulator.load(function(*operands))
        enter(0)
        return result

    def string_at(depth: int, function: Callable[..., Any], *operands: Any) -> Any:
        enter(depth)
        result = accumulator.keep(function(*operands))
        enter(0)
        return result

    def done_at(depth: int, function: Callable[..., Any], *operands: Any) -> Any:
        enter(depth)
        result = function(*operands)
        enter(0)
        return result

    return {"number_at": number_at, "string_at": string_at, "done_at": done_at}
