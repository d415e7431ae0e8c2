"""Formulas: FRMEVL, its operators and its elements.

The ROM reads and computes in one go. Each level of FRMEVL has on the 6502's stack a precedence, and
for each operator that waits for its right operand the left one, rounded to five bytes. So the order
of events, errors included, is that of the ROM, and so is the room on the stack: ``sp`` is the stack
pointer at a routine's entry.

A value is what the accumulator (FAC) holds, a triple of `real`; ``valtyp`` says whether that is a
string. Where the ROM takes the one for the other, so does this.
"""

from __future__ import annotations

from collections.abc import Callable

from ..applesoft.errorcodes import ApplesoftError
from ..applesoft.real import (
    ZERO,
    Number,
    add,
    compare,
    divide,
    integer,
    multiply,
    negate,
    rounded,
    subtract,
)
from .faults import Fault, placed
from .memory import EMPTY
from .strings import IS_STRING, descriptor
from .text import BLANK, CLOSE, FUNCTION, INTEGER, OPEN, QUOTE, STRING
from .tokens import TOKENS
from .variables import SUBFLG_SIMPLE, Variables, stored_at

ROOM = 59
"""CHKMEM: a formula needs the stack pointer to be at least here."""
PENDING = 12
"""Bytes on the stack for an operator that waits for its right operand."""
POINT, DIGIT_0, DIGIT_9, LETTER_A, LETTER_Z = map(ord, ".09AZ")
FN, PLUS_TOKEN, MINUS_TOKEN, NOT_TOKEN, OR_TOKEN, GREATER, LESS, FIRST_FUNCTION = (
    TOKENS[word] for word in ("FN", "+", "-", "NOT", "OR", ">", "<", "SGN")
)
BLANK_OR_PLUS, MINUS_OR_NOT = (BLANK, PLUS_TOKEN), (MINUS_TOKEN, NOT_TOKEN)
POWER, AND, OR, NEGATE, NOT, RELATION = range(4, 10)
"""Operators by their place in MATHTBL, after + - * and /."""
PRECEDENCES = (0x79, 0x79, 0x7B, 0x7B, 0x7D, 0x50, 0x46, 0x7F, 0x7F, 0x64, 0)
RELATIONAL = PRECEDENCES[RELATION]
NONE = -1
"""No operator follows: the last place in `PRECEDENCES`."""
ONE = integer(1)
ARITHMETIC: tuple[Callable[[Number, Number], Number], ...] = (add, subtract, multiply, divide)
ERROR_DEPTHS = (3, 3, 5, 3, 6)
"""How far below a level's entry + - * / and ^ find their errors."""
SIGNS = (1, 2, 4)
"""CPRTYP's bits for >, = and <."""
TRUTHS = {1: 4, 0: 2, -1: 1}
"""CPRMASK's bits by what `compare` says of the right operand."""


class Expressions(Variables):
    """FRMEVL. ``cprtyp``: what a formula left of its last relation, which the next string's + takes
    for a relation's signs."""

    cprtyp = 0
    power: Callable[[Number, Number], Number]
    function: Callable[[int, int], Number]

    def number(self, sp: int) -> Number:
        """FRMNUM: a formula that must be a number. Raises TYPE MISMATCH."""
        fac = self.formula(sp - 2)
        if self.valtyp & 0x80:
            raise Fault("TYPE MISMATCH", sp)
        return fac

    def formula(self, sp: int) -> Number:
        """FRMEVL: the value of the formula at TXTPTR. ``pending`` is what lies on the stack: for
        each operator that waits the precedence before it, the left operand, the relation."""
        ram, atoms = self.ram, self.atoms
        pos = self.txtptr
        pending: list[tuple[int, int, Number, int]] = []
        last = 0
        while True:
            if sp < ROOM and (sp & 0xFF) - 3 & 0xFF < ROOM - 3:
                raise Fault("OUT OF MEMORY", sp - 3)
            known = atoms.get(pos)
            if known:
                pos, name, constant = known
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
                    operator = NEGATE if byte == MINUS_TOKEN else NOT
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
                elif PLUS_TOKEN <= byte <= OR_TOKEN and not cprtyp:
                    operator = byte - PLUS_TOKEN
                    if operator or not valtyp:
                        pos += 1
                        break
                    self.txtptr = pos + 1
                    fac = self._concatenation(sp, fac)
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
            if valtyp & 0x80 and (waits or last != RELATIONAL) and (operator >= 0 or last):
                raise Fault("TYPE MISMATCH", sp - 2)
            while not waits and pending:
                last, doing, left, relation = pending.pop()
                sp += PENDING
                try:
                    if doing < POWER:
                        fac = ARITHMETIC[doing](left, fac)
                    elif doing == RELATION:
                        if relation & 1 or valtyp & 0x80:
                            if relation & 1 != valtyp >> 7:
                                raise Fault("TYPE MISMATCH", sp - 5)
                            order = -self.compare_strings(descriptor(left), fac)
                            valtyp = 0
                            cprtyp = cprtyp - 1 & 0xFF
                        else:
                            order = compare(left, fac)
                        fac = ONE if relation >> 1 & TRUTHS[order] else ZERO
                    elif doing == POWER:
                        fac = self.power(left, fac)
                    elif doing == NEGATE:
                        fac = negate(fac)
                    elif doing == NOT:
                        fac = ZERO if fac[0] else ONE
                    elif doing == OR:
                        fac = ONE if left[0] or fac[0] else ZERO
                    else:
                        fac = ONE if left[0] and fac[0] else ZERO
                except ApplesoftError as error:
                    raise placed(error, sp - ERROR_DEPTHS[min(doing, POWER)]) from None
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

    def _concatenation(self, sp: int, left: Number) -> Number:
        """CAT: left + the next element, whatever operator stands before."""
        self.fac = left
        self.cprtyp = 0
        right = self.element(sp - 2)
        if not self.valtyp & 0x80:
            raise Fault("TYPE MISMATCH", sp - 5)
        try:
            return self.joined(descriptor(left), descriptor(right))
        except ApplesoftError as error:
            raise placed(error, sp - 1) from None

    def element(self, sp: int) -> Number:
        """FRM_ELEMENT: a constant, a variable, a string, a function or a parenthesis. ``sp`` is
        that of the formula it stands in."""
        ram = self.ram
        pos = self.txtptr
        byte = ram[pos]
        while byte in BLANK_OR_PLUS:
            pos += 1
            byte = ram[pos]
        self.valtyp = 0
        if LETTER_A <= byte <= LETTER_Z:
            name, self.txtptr, subscripts = self.names.get(pos) or self.name_at(pos)
            if subscripts and not name & INTEGER and not self.subflg:
                self.inttyp = False
                e, m = stored_at(ram, self.array_element(name, sp - 5))
                return (e, (m | 0x80000000) << 8, m >> 31) if e else ZERO
            return self._variable(sp - 5, name, subscripts)
        self.txtptr = pos
        try:
            return self._other_element(sp, byte)
        except ApplesoftError as error:
            raise placed(error, sp - 5) from None

    def _other_element(self, sp: int, byte: int) -> Number:
        if DIGIT_0 <= byte <= DIGIT_9 or byte == POINT:
            return self.constant()
        if byte == QUOTE:
            string = self.literal(self.txtptr + 1)
            self.txtptr = self.strng2
            return string
        if byte == FN:
            return self._function_call(sp)
        if byte >= FIRST_FUNCTION:
            self.txtptr += 1
            return self.function(byte, sp)
        if byte in MINUS_OR_NOT:  # behind a string's +; the ROM goes astray
            self.txtptr += 1
            return self.formula(sp - PENDING)
        return self.parenthesis(sp - 3)

    def parenthesis(self, sp: int) -> Number:
        """PARCHK: a formula in parentheses. Raises SYNTAX."""
        self.expect(OPEN, sp - 2)
        fac = self.formula(sp - 2)
        self.expect(CLOSE, sp)
        return fac

    def _variable(self, sp: int, name: int, subscripts: bool) -> Number:
        """FRM_VARIABLE: the value of a variable or an element; of a string, where its descriptor
        lies."""
        kind = name & INTEGER
        self.inttyp = kind == INTEGER
        if subscripts and not self.subflg:
            self.valtyp = IS_STRING if kind == STRING else 0
            address = self.array_element(name, sp)
        else:
            if self.inttyp and self.subflg:
                raise Fault("SYNTAX", sp)
            self.subflg = 0
            address = self.simple.get(name, EMPTY)
            if address != EMPTY:
                self.varpnt = address
        if kind == STRING:
            self.valtyp = IS_STRING
            e, m, s = self.fac
            return e, m & 0xFFFF000000 | (address & 0xFF) << 16 | address & 0xFF00, s
        return self.integer_value(address) if kind else self.value(address)

    def function_name(self, sp: int) -> int:
        """FNC: the address of the function named after FN, which is made if there is none. Raises
        SYNTAX and TYPE MISMATCH.

        A string's name makes a variable before it is refused: with both marks in its name, that of
        the kind and that of a function, it is an integer.
        """
        self.expect(FN, sp - 2)
        self.subflg = SUBFLG_SIMPLE
        address = self.variable(sp - 2, mark=FUNCTION)
        if self.valtyp:
            raise Fault("TYPE MISMATCH", sp)
        return address

    def _function_call(self, sp: int) -> Number:
        """FUNCT: the formula of DEF FN, its variable set to the argument meanwhile. Raises UNDEF'D
        FUNCTION and SYNTAX; an error leaves the argument in the variable."""
        ram = self.ram
        place = self.function_name(sp - 5)
        argument = self.parenthesis(sp - 7)
        if self.valtyp:
            raise Fault("TYPE MISMATCH", sp - 7)
        if not ram[place + 3]:
            raise Fault("UNDEF'D FUNCTION", sp - 3)
        variable = self.varpnt = self.word(place + 2)
        value = bytes(ram[variable : variable + 5])
        self.assign(variable, argument)
        back, self.txtptr = self.txtptr, self.word(place)
        fac = self.number(sp - 14)
        if not self.at_end():
            raise Fault("SYNTAX", sp - 10)
        self.txtptr = back
        ram[variable : variable + 5] = value
        return fac
