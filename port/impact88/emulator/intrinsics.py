"""The functions that are built in: UNARY, and what it calls.

Most are worked out before the ROM sees that the argument was a string, on what the accumulator then
holds; CHR$, PEEK, FRE and POS never look.
"""

from __future__ import annotations

from collections.abc import Callable

from ..applesoft import decimaltext, functions
from ..applesoft.errorcodes import ApplesoftError, illegal_quantity
from ..applesoft.real import (
    INTEGER_EXPONENT,
    ZERO,
    Number,
    absolute,
    add,
    divide,
    floor,
    integer,
    multiply,
    negate,
    rounded,
    to_integer,
)
from .expressions import Expressions
from .faults import Fault, placed
from .memory import ADDRESSES
from .strings import LONGEST, descriptor
from .text import CLOSE, COMMA, OPEN
from .tokens import TOKENS
from .variables import positive_integer

NUMERIC: dict[str, Callable[[Number], Number]] = {
    "SGN": functions.sign,
    "ABS": absolute,
    "LOG": functions.logarithm,
    "ATN": functions.arc_tangent,
}
LOOKING_FOR_INT: dict[str, Callable[[Number], Number]] = {
    "SQR": functions.square_root,
    "EXP": functions.exponential,
    "COS": functions.cosine,
    "SIN": functions.sine,
    "TAN": functions.tangent,
}
"""Functions that ask for an INT on their way."""
ERROR_DEPTHS = {"SQR": 8, "EXP": 7}
"""How far below a formula's entry they find their errors; others 5."""
WORDS = {token: word for word, token in TOKENS.items()}
FIRST_SLICE = TOKENS["LEFT$"]
DIGITS_COUNTED = 36
SCREEN_DOT = TOKENS["SCRN("]
LARGEST_ADDRESS = 0x90
"""Exponent of the largest number GETADR takes."""


def address_of(x: Number, sp: int) -> int:
    """GETADR: a 16-bit address; a negative one counts from the top. Raises ILLEGAL QUANTITY past
    65535."""
    if x[0] > LARGEST_ADDRESS:
        raise Fault("ILLEGAL QUANTITY", sp)
    return to_integer(x) & 0xFFFF


def byte_of(x: Number, sp: int) -> int:
    """CONINT: a number from 0 to 255, rounded down. Raises ILLEGAL QUANTITY."""
    n = positive_integer(x, sp - 2)
    if n > LONGEST:
        raise Fault("ILLEGAL QUANTITY", sp)
    return n


def shifted_out(x: Number) -> int:
    """The accumulator's extension after CONINT: the bits shifted out last, a byte at a time."""
    moved = (INTEGER_EXPONENT - x[0]) // 8 if x[0] else 0
    return x[1] >> 8 * min(moved, 4) & 0xFF


class Intrinsics(Expressions):
    """UNARY."""

    def function(self, token: int, sp: int) -> Number:
        """UNARY: a function of one argument, or of a string and numbers; ``sp`` is that of the
        formula it stands in. Raises SYNTAX, TYPE MISMATCH, and what the function does."""
        if token >= FIRST_SLICE:
            return self._slice(token, sp)
        if token == SCREEN_DOT:
            self.refuse("SCRN")
        fac = self.parenthesis(sp - 6)
        word = WORDS[token]
        try:
            result = self._applied(word, fac, sp - 5)
        except ApplesoftError as error:
            raise placed(error, sp - ERROR_DEPTHS.get(word, 5)) from None
        if self.valtyp and word not in ("CHR$", "STR$"):
            raise Fault("TYPE MISMATCH", sp - 3)
        return result

    def _applied(self, word: str, fac: Number, sp: int) -> Number:
        if word in NUMERIC:
            return NUMERIC[word](fac)
        if word in LOOKING_FOR_INT:
            result: Number = LOOKING_FOR_INT[word](fac)
            self.charac = word, ZERO, fac
        else:  # the method named for the function
            result = getattr(self, f"_{word.rstrip('$').lower()}")(fac, sp)
        return result

    def _int(self, fac: Number, sp: int) -> Number:
        whole = floor(fac)
        if fac[0] < INTEGER_EXPONENT:
            self.charac = to_integer(whole) & 0xFF
        return whole

    def power(self, left: Number, right: Number) -> Number:
        """FPWRT: left ^ right. INT does not find the parity of a power of 2^32 or more, and leaves
        that of an older number."""
        result = functions.power(left, right)
        if left[2] and rounded(right)[0] >= INTEGER_EXPONENT:
            result = negate(absolute(result)) if self._int_byte() & 1 else absolute(result)
        self.charac = "^", left, right
        return result

    def _int_byte(self) -> int:
        """The low byte of what INT found last, be it within another function."""
        if isinstance(self.charac, int):
            return self.charac
        word, left, x = self.charac
        if word in ("SIN", "COS", "TAN"):
            if word == "COS":
                x = add(functions.HALF_PI, x)
            return to_integer(rounded(divide(x, functions.TWO_PI))) & 0xFF
        if word == "SQR":
            left, x = x, functions.HALF
        if word != "EXP":
            base = absolute(rounded(left))
            x = multiply(rounded(x), functions.logarithm(base)) if base[0] and x[0] else ZERO
        return functions.exponential_integer(x) & 0xFF

    def _rnd(self, fac: Number, sp: int) -> Number:
        self.seed = functions.random(fac, self.seed)
        return self.seed

    def _usr(self, fac: Number, sp: int) -> Number:
        """USR: what switching on puts there refuses every argument."""
        raise illegal_quantity()

    def _fre(self, fac: Number, sp: int) -> Number:
        """FRE: the room left, past 32767 as a negative number."""
        if self.valtyp:
            self.used(fac)
        self.collect_garbage()
        self.valtyp = 0
        return integer((self.fretop - self.strend + 0x8000 & 0xFFFF) - 0x8000)

    def _pos(self, fac: Number, sp: int) -> Number:
        """POS, whatever its argument."""
        self.valtyp = 0
        return integer(self.screen.column & 0xFF)

    def _peek(self, fac: Number, sp: int) -> Number:
        self.valtyp = 0
        return integer(self.peek(address_of(fac, sp - 4)))

    def _pdl(self, fac: Number, sp: int) -> Number:
        """PDL: nothing is plugged in."""
        byte_of(fac, sp - 2)
        self.refuse("PDL")
        return ZERO

    def _text(self, fac: Number, sp: int) -> bytes:
        """GETSTR: the characters of the argument, which becomes a number. Raises TYPE MISMATCH."""
        if not self.valtyp:
            raise Fault("TYPE MISMATCH", sp - 6)
        self.valtyp = 0
        return self.used(fac)

    def _len(self, fac: Number, sp: int) -> Number:
        return integer(len(self._text(fac, sp)))

    def _asc(self, fac: Number, sp: int) -> Number:
        """ASC. Raises ILLEGAL QUANTITY for the empty string."""
        text = self._text(fac, sp)
        if not text:
            raise Fault("ILLEGAL QUANTITY", sp)
        return integer(text[0])

    def _val(self, fac: Number, sp: int) -> Number:
        """VAL: the number a string begins with, zero if it begins with none. Raises OVERFLOW, and
        leaves behind the string the zero that is put there to end it."""
        address = self.word(descriptor(fac) + 1) if self.valtyp else 0
        text = self._text(fac, sp)
        if not text:
            return ZERO
        back, self.txtptr = self.txtptr, address
        end = address + len(text) & ADDRESSES - 1
        byte, self.ram[end] = self.ram[end], 0
        self.character()
        try:
            result = self.numeral()
        except ApplesoftError:
            if end < self.vartab:
                self.text_changed()
            raise Fault("OVERFLOW", sp - 5) from None
        self.ram[end] = byte
        self.txtptr = back
        return result

    def digits(self, x: Number) -> bytes:
        """FOUT: the characters of a number. Counting digits it leaves a byte in VARPNT."""
        if x[0]:
            self.varpnt = self.varpnt & 0xFF00 | DIGITS_COUNTED
        return decimaltext.write(x).encode("ascii")

    def _str(self, fac: Number, sp: int) -> Number:
        if self.valtyp:
            raise Fault("TYPE MISMATCH", sp - 2)
        text = self.digits(fac)
        self.charac = 0
        return self.made(text)

    def _chr(self, fac: Number, sp: int) -> Number:
        code = byte_of(fac, sp - 2)
        address = self.room(1)
        self.ram[address] = code
        return self.temporary(1, address, shifted_out(fac))

    def _slice(self, token: int, sp: int) -> Number:
        """LEFT$, RIGHT$ and MID$: parts of a string. Raises ILLEGAL QUANTITY for a first number of
        0."""
        self.expect(OPEN, sp - 6)
        string = self.formula(sp - 6)
        self.expect(COMMA, sp - 6)
        if not self.valtyp:
            raise Fault("TYPE MISMATCH", sp - 6)
        place = descriptor(string)
        last = self.number(sp - 10)
        first = byte_of(last, sp - 8)
        length = LONGEST
        word = WORDS.get(token, "")
        if word == "MID$" and self.character() != CLOSE:
            self.expect(COMMA, sp - 10)
            last = self.number(sp - 12)
            length = byte_of(last, sp - 10)
        self.expect(CLOSE, sp - 12)
        if not first or not word:
            raise Fault("ILLEGAL QUANTITY", sp - 5)
        size = self.ram[place]
        if word == "MID$":
            start = min(first - 1, size)
            length = min(length, size - start)
        else:
            length = min(first, size)
            start = 0 if word == "LEFT$" else size - length
        return self.part(place, start, length, shifted_out(last))
