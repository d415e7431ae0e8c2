"""Formulas: FRMEVL, its operators and elements, and the built-in functions.

Like the ROM, this module reads and computes in one pass, with the same order of events and errors,
and with the 6502's stack pointer at a routine's entry, ``sp``. A value is the content of the
accumulator, a triple of `applesoft.real`. Where the ROM takes a string for a number, so does this
module: most functions are computed before the type of the argument is checked; CHR$, PEEK, FRE and
POS never check it."""

from collections.abc import Callable

from ..applesoft import decimaltext, functions
from ..applesoft.errorcodes import ApplesoftError, illegal_quantity
from ..applesoft.real import (
    INTEGER_EXPONENT,
    ZERO,
    Number,
    absolute,
    add,
    compare,
    divide,
    integer,
    multiply,
    negate,
    rounded,
    subtract,
    to_integer,
)
from .faults import Fault, call_at, fault_if, with_stack
from .memory import DIGITS, FUNCTION, LETTERS, MINUS, PLUS, SUBFLG_SIMPLE
from .tokens import BLANK, CLOSE, COMMA, OPEN, QUOTE, TOKENS
from .variables import LARGEST_INTEGER, LONGEST, Variables, descriptor, stored_at

MIN_STACK = 59  # CHKMEM: the lowest stack pointer for a formula
PENDING = 12  # bytes on the stack for an operator that waits for its right operand
DIGITS_COUNTED = 36  # the byte that FOUT leaves in VARPNT
LARGEST_ADDRESS = 0x90  # GETADR: the largest exponent of an address
POINT = ord(".")
FN = TOKENS["FN"]
NOT_TOKEN = TOKENS["NOT"]
OR_TOKEN = TOKENS["OR"]
GREATER = TOKENS[">"]
LESS = TOKENS["<"]
SGN = TOKENS["SGN"]
BLANK_OR_PLUS = (BLANK, PLUS)
MINUS_OR_NOT = (MINUS, NOT_TOKEN)
# operators by their place in MATHTBL, after + - * and / (0 to 3); no operator at the end
POWER = 4
AND = 5
OR = 6
NEGATE = 7
NOT = 8
RELATION = 9
NONE = 10
PRECEDENCES = (0x79, 0x79, 0x7B, 0x7B, 0x7D, 0x50, 0x46, 0x7F, 0x7F, 0x64, 0)  # of MATHTBL
RELATIONAL = PRECEDENCES[RELATION]
ONE = integer(1)
ARITHMETIC: tuple[Callable[[Number, Number], Number], ...]
ARITHMETIC = (add, subtract, multiply, divide)
ERROR_DEPTHS = (3, 3, 5, 3, 6)
"""Bytes below a level's entry at which + - * / and ^ detect their errors."""
SIGNS = (1, 2, 4)  # CPRTYP's bits for >, = and <
TRUTHS = {1: 4, 0: 2, -1: 1}  # CPRMASK's bits by the result of `compare` for the right operand

NUMERIC: dict[str, Callable[[Number], Number]] = {
    "SGN": functions.sign,
    "ABS": absolute,
    "LOG": functions.logarithm,
    "ATN": functions.arc_tangent,
}
TAKING_INT: dict[str, Callable[[Number, int], functions.IntAndByte]] = {
    "INT": functions.integer_part,
    "SQR": functions.square_root,
    "EXP": functions.exponential,
    "COS": functions.cosine,
    "SIN": functions.sine,
    "TAN": functions.tangent,
}
"""INT, and functions that use it: the byte they leave in CHARAC affects a later ^."""
FUNCTION_DEPTHS = {"SQR": 8, "EXP": 7}
"""Bytes below a formula's entry at which functions detect their errors, if not 5."""
WORDS = {token: word for word, token in TOKENS.items()}


def address_of(x: Number, sp: int) -> int:
    """GETADR: return an address, modulo 65536 if negative. Raises ILLEGAL QUANTITY past 65535."""
    if x[0] > LARGEST_ADDRESS:
        raise Fault("ILLEGAL QUANTITY", sp)
    return to_integer(x) & 0xFFFF


def byte_of(x: Number, sp: int) -> int:
    """CONINT: return a number from 0 to 255, rounded down. Raises ILLEGAL QUANTITY."""
    e, m, s = x
    n = m >> 168 - e if e <= LARGEST_INTEGER else LONGEST + 1
    if s or n > LONGEST:
        raise Fault("ILLEGAL QUANTITY", sp - 2 * (s or e > LARGEST_INTEGER))
    return n


def shifted_out(x: Number) -> int:
    """Return the accumulator's extension after CONINT: the last byte shifted out."""
    shifts = (INTEGER_EXPONENT - x[0]) // 8 if x[0] else 0
    return x[1] >> 8 * min(shifts, 4) & 0xFF


class Expressions(Variables):
    """Evaluation of formulas."""

    def number(self, sp: int) -> Number:
        """FRMNUM: return the value of a numeric formula. Raises TYPE MISMATCH for a string."""
        fac = self.formula(sp - 2)
        if self.valtyp & 0x80:
            raise Fault("TYPE MISMATCH", sp)
        return fac

    def formula(self, sp: int) -> Number:
        """FRMEVL: return the value of the formula at TXTPTR.

        ``pending`` holds the content of the stack, for each operator that waits for its right
        operand: the precedence before it, the operator, its left operand, its relation. Operators
        are applied as soon as one of no higher precedence follows."""
        # not split: the ROM's one loop, and the emulator spends most of its time in it
        ram, atoms = self.ram, self.atoms
        pos = self.txtptr
        pending: list[tuple[int, int, Number, int]] = []
        last = 0
        while True:
            if sp < MIN_STACK and (sp & 0xFF) - 3 & 0xFF < MIN_STACK - 3:
                raise Fault("OUT OF MEMORY", sp - 3)
            atom = atoms.get(pos)
            if atom:
                pos, name, constant = atom
                valtyp = cprtyp = 0
                if constant:
                    fac = constant
                else:
                    self.subflg = 0
                    address = self.simple.get(name)
                    if address:
                        self.varpnt = address
                        e, m = stored_at(ram, address)
                        fac = (e, (m | 0x80000000) << 8, m >> 31) if e else ZERO
                    else:
                        fac = ZERO
            else:
                byte = ram[pos]
                while byte in BLANK_OR_PLUS:
                    pos += 1
                    byte = ram[pos]
                if byte in MINUS_OR_NOT:
                    pos += 1
                    operator = NEGATE if byte == MINUS else NOT
                    pending.append((last, operator, ZERO, 0))
                    last = PRECEDENCES[operator]
                    sp -= PENDING
                    continue
                self.txtptr = pos
                fac = self.element(sp)
                pos = self.txtptr
                valtyp = self.valtyp
                cprtyp = 0
            while True:
                byte = ram[pos]
                if byte == BLANK:
                    pos += 1
                elif PLUS <= byte <= OR_TOKEN and not cprtyp:
                    operator = byte - PLUS
                    if operator or not valtyp:
                        pos += 1
                        break
                    # CAT: left + the next element, whatever operator precedes
                    self.txtptr, self.fac, self.cprtyp = pos + 1, fac, 0
                    right = self.element(sp - 2)
                    if not self.valtyp & 0x80:
                        raise Fault("TYPE MISMATCH", sp - 5)
                    fac = call_at(sp - 1, self.concatenate, descriptor(fac), descriptor(right))
                    pos, cprtyp = self.txtptr, self.cprtyp
                elif GREATER <= byte <= LESS:
                    signs = SIGNS[byte - GREATER] ^ cprtyp
                    if signs < cprtyp:
                        raise Fault("SYNTAX", sp - 1)
                    cprtyp = signs
                    pos += 1
                elif cprtyp:
                    operator = RELATION
                    cprtyp = (cprtyp << 1 | valtyp & 1) & 0xFF
                    valtyp >>= 1
                    break
                else:
                    operator = NONE
                    break
            waits = last < PRECEDENCES[operator]
            if valtyp & 0x80 and (waits or last != RELATIONAL) and (operator != NONE or last):
                raise Fault("TYPE MISMATCH", sp - 2)
            while not waits and pending:
                last, waiting, left, relation = pending.pop()
                sp += PENDING
                try:
                    if waiting < POWER:
                        fac = ARITHMETIC[waiting](left, fac)
                    elif waiting == RELATION:
                        if relation & 1 or valtyp & 0x80:
                            if relation & 1 != valtyp >> 7:
                                raise Fault("TYPE MISMATCH", sp - 5)
                            right_text = self.release_text(descriptor(fac))  # STRCMP
                            left_text = self.release_text(descriptor(left))
                            order = (left_text < right_text) - (left_text > right_text)
                            valtyp = 0
                            cprtyp = cprtyp - 1 & 0xFF
                        else:
                            order = compare(left, fac)
                        fac = ONE if relation >> 1 & TRUTHS[order] else ZERO
                    elif waiting == POWER:
                        fac, self.charac = functions.power(left, fac, self.charac)
                    elif waiting == NEGATE:
                        fac = negate(fac)
                    elif waiting == NOT:
                        fac = ZERO if fac[0] else ONE
                    elif waiting == OR:
                        fac = ONE if left[0] or fac[0] else ZERO
                    else:
                        fac = ONE if left[0] and fac[0] else ZERO
                except ApplesoftError as error:
                    raise with_stack(error, sp - ERROR_DEPTHS[min(waiting, POWER)]) from None
                waits = last < PRECEDENCES[operator]
            if not waits:
                self.txtptr = pos
                self.valtyp = valtyp
                self.cprtyp = cprtyp
                self.fac = fac
                return fac
            if fac[1] & 0xFF and fac[0]:
                fac = rounded(fac)
            self.fac = fac
            pending.append((last, operator, fac, cprtyp))
            last = PRECEDENCES[operator]
            sp -= PENDING

    def element(self, sp: int) -> Number:
        """FRM_ELEMENT: return the value of a constant, variable, string, function or
        parenthesis."""
        ram = self.ram
        pos = self.txtptr
        byte = ram[pos]
        while byte in BLANK_OR_PLUS:
            pos += 1
            byte = ram[pos]
        self.valtyp = 0
        self.txtptr = pos
        if byte in LETTERS:
            address = self.variable(sp - 5, make=False)
            if self.valtyp:
                e, m, s = self.fac
                return e, m & 0xFFFF000000 | (address & 0xFF) << 16 | address & 0xFF00, s
            return self.integer_value(address) if self.inttyp else self.value(address)
        try:
            if byte in DIGITS or byte == POINT:
                return self.constant()
            if byte == QUOTE:
                return self.literal(pos + 1)
            if byte == FN:
                return self._function_call(sp)
            if byte >= SGN:
                self.txtptr += 1
                return self.function(byte, sp)
            if byte in MINUS_OR_NOT:  # after a string's +: the ROM jumps to a formula
                self.txtptr += 1
                return self.formula(sp - PENDING)
            return self.parenthesis(sp - 3)
        except ApplesoftError as error:
            raise with_stack(error, sp - 5) from None

    def parenthesis(self, sp: int) -> Number:
        """PARCHK: return the value of a formula in parentheses. Raises SYNTAX."""
        self.expect(OPEN, sp - 2)
        fac = self.formula(sp - 2)
        self.expect(CLOSE, sp)
        return fac

    def function_name(self, sp: int) -> int:
        """FNC: return the address of the function named after FN, created if necessary. A name with
        the marks of a string and a function counts as an integer variable, and is created, too."""
        self.expect(FN, sp - 2)
        self.subflg = SUBFLG_SIMPLE
        address = self.variable(sp - 2, mark=FUNCTION)
        fault_if(self.valtyp, "TYPE MISMATCH", sp)
        return address

    def _function_call(self, sp: int) -> Number:
        """FUNCT: return the value of a DEF FN, whose variable is set meanwhile (and after an
        error)."""
        ram = self.ram
        place = self.function_name(sp - 5)
        argument = self.parenthesis(sp - 7)
        fault_if(self.valtyp, "TYPE MISMATCH", sp - 7)
        fault_if(not ram[place + 3], "UNDEF'D FUNCTION", sp - 3)
        variable = self.varpnt = self.word(place + 2)
        value = bytes(ram[variable : variable + 5])
        self.assign(variable, argument)
        back, self.txtptr = self.txtptr, self.word(place)
        fac = self.number(sp - 14)
        fault_if(not self.at_end(), "SYNTAX", sp - 10)
        self.txtptr = back
        ram[variable : variable + 5] = value
        return fac

    def function(self, token: int, sp: int) -> Number:
        """UNARY: return the value of a function in a formula with this ``sp``."""
        if token >= TOKENS["LEFT$"]:
            return self._slice(token, sp)
        if token == TOKENS["SCRN("]:
            self.refuse("SCRN")
        fac = self.parenthesis(sp - 6)
        word = WORDS[token]
        try:
            if word in NUMERIC:
                result = NUMERIC[word](fac)
            elif word in TAKING_INT:
                result, self.charac = TAKING_INT[word](fac, self.charac)
            else:  # the method named for the function
                result = getattr(self, f"_{word.rstrip('$').lower()}")(fac, sp - 5)
        except ApplesoftError as error:
            raise with_stack(error, sp - FUNCTION_DEPTHS.get(word, 5)) from None
        if self.valtyp and word not in ("CHR$", "STR$"):
            raise Fault("TYPE MISMATCH", sp - 3)
        return result

    def _rnd(self, fac: Number, sp: int) -> Number:
        self.seed = functions.random(fac, self.seed)
        return self.seed

    def _usr(self, fac: Number, sp: int) -> Number:
        """USR: the routine there after power-on refuses every argument."""
        raise illegal_quantity()

    def _fre(self, fac: Number, sp: int) -> Number:
        """FRE: return the free bytes, past 32767 as a negative number."""
        if self.valtyp:
            self.release_text(descriptor(fac))
        self.collect_garbage()
        self.valtyp = 0
        return integer((self.fretop - self.strend + 0x8000 & 0xFFFF) - 0x8000)

    def _pos(self, fac: Number, sp: int) -> Number:
        self.valtyp = 0
        return integer(self.screen.column & 0xFF)

    def _peek(self, fac: Number, sp: int) -> Number:
        self.valtyp = 0
        return integer(self.peek(address_of(fac, sp - 4)))

    def _pdl(self, fac: Number, sp: int) -> Number:
        byte_of(fac, sp - 2)
        self.refuse("PDL")
        return ZERO

    def _text(self, fac: Number, sp: int) -> bytes:
        """GETSTR: return a string argument. Raises TYPE MISMATCH for a number."""
        fault_if(not self.valtyp, "TYPE MISMATCH", sp - 6)
        self.valtyp = 0
        return self.release_text(descriptor(fac))

    def _len(self, fac: Number, sp: int) -> Number:
        return integer(len(self._text(fac, sp)))

    def _asc(self, fac: Number, sp: int) -> Number:
        text = self._text(fac, sp)
        fault_if(not text, "ILLEGAL QUANTITY", sp)
        return integer(text[0])

    def _val(self, fac: Number, sp: int) -> Number:
        """VAL: return the number of a string. After OVERFLOW the zero written after it stays."""
        address = self.word(descriptor(fac) + 1) if self.valtyp else 0
        text = self._text(fac, sp)
        if not text:
            return ZERO
        back, self.txtptr = self.txtptr, address
        end = address + len(text) & 0xFFFF
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
        """FOUT: return the characters of a number; the count of digits leaves a byte in VARPNT."""
        if x[0]:
            self.varpnt = self.varpnt & 0xFF00 | DIGITS_COUNTED
        return decimaltext.write(x).encode("ascii")

    def _str(self, fac: Number, sp: int) -> Number:
        fault_if(self.valtyp, "TYPE MISMATCH", sp - 2)
        text = self.digits(fac)
        self.charac = 0
        return self.new_string(text)

    def _chr(self, fac: Number, sp: int) -> Number:
        code = byte_of(fac, sp - 2)
        return self.new_string(bytes((code,)), shifted_out(fac))

    def _slice(self, token: int, sp: int) -> Number:
        """LEFT$, RIGHT$ and MID$: return part of a string. Raises ILLEGAL QUANTITY for a first
        0."""
        self.expect(OPEN, sp - 6)
        string = self.formula(sp - 6)
        self.expect(COMMA, sp - 6)
        fault_if(not self.valtyp, "TYPE MISMATCH", sp - 6)
        place = descriptor(string)
        last = self.number(sp - 10)
        first, length = byte_of(last, sp - 8), LONGEST
        word = WORDS.get(token, "")
        if word == "MID$" and self.character() != CLOSE:
            self.expect(COMMA, sp - 10)
            last = self.number(sp - 12)
            length = byte_of(last, sp - 10)
        self.expect(CLOSE, sp - 12)
        fault_if(not first or not word, "ILLEGAL QUANTITY", sp - 5)
        size = self.ram[place]
        if word == "MID$":
            start = min(first - 1, size)
            length = min(length, size - start)
        else:
            length = min(first, size)
            start = 0 if word == "LEFT$" else size - length
        address = self.allocate(length)
        _, source = self.free_string(place)
        self.move(source + start, address, length)
        return self.temporary(length, address, shifted_out(last))
