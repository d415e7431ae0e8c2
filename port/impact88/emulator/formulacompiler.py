"""Compiling expressions: tokens into Python text, in the ROM's order of events.

The ROM reads and computes in one go, so an error of syntax or type shows only after everything to
its left has been computed. Here a piece that ends in such an error is *dead*: it computes what
comes before and then raises; nothing after it is read.

Values are the triples of `real` and ``str``. The rules in `real` round the left operand and keep
the right one's extension, as the ROM does, so nothing of that stands here.

``at`` is how far below the statement's beginning the 6502 stack has come. In a *careful*
compilation every formula looks at the stack before it goes deeper.
"""

from __future__ import annotations

from ..applesoft import decimaltext
from ..applesoft.errors import ApplesoftError
from ..applesoft.real import Number
from .operand import (
    ANYTHING,
    CLOSE,
    COMMA,
    COMPARED,
    FIRST_FUNCTION,
    FN,
    HIGHEST,
    MAKING_TEXT,
    MINUS,
    NOT,
    NUMBER,
    NUMERIC,
    OF_TEXT,
    OPEN,
    OPERATORS,
    PARENTHESIS,
    PENDING,
    PLUS,
    POINT,
    REFUSED_FUNCTIONS,
    RELATION_BITS,
    RELATIONAL,
    RELATIONS,
    ROOM,
    SLICES,
    STACK,
    TEMPORARIES,
    TEXT,
    USR,
    Operand,
)
from .reader import QUOTE, Reader, is_digit, is_letter
from .strings import Literal
from .symbols import ARRAYS, FUNCTION, INTEGER, REAL, SIMPLE, STRING
from .tokens import TOKENS


class FormulaCompiler:
    """The expression compiler for one line."""

    def __init__(self, reader: Reader, *, careful: bool, direct: bool) -> None:
        self.reader = reader
        self.careful = careful
        self.direct = direct
        self.constants: dict[str, Number | str] = {}
        self.temporaries = 0
        self.deepest = 0

    # --- errors -------------------------------------------------------------------------------

    def fails(self, kind: str, *before: Operand) -> Operand:
        """A piece that computes ``before`` and then raises."""
        code = f"bad({kind!r})"
        if before:
            code = f"({', '.join(piece.code for piece in before)}, {code})"
        return Operand(code, dead=True)

    def then(self, *pieces: Operand) -> Operand:
        """Pieces of which the last is dead."""
        if len(pieces) == 1:
            return pieces[0]
        return Operand(f"({', '.join(piece.code for piece in pieces)})", dead=True)

    # --- constants ----------------------------------------------------------------------------

    def real(self, value: Number) -> str:
        """The name of a constant real."""
        e, m, s = value
        name = f"c_{e:02x}{m:010x}{s}"
        self.constants[name] = value
        return name

    def literal(self, text: str) -> Operand:
        """A string in the program; typed without a line number, it has to be copied."""
        if self.temporaries == TEMPORARIES:
            return self.fails("FORMULA TOO COMPLEX")
        self.temporaries += 1
        name = f"t_{text.encode('latin-1').hex()}"
        self.constants[name] = Literal(text)
        code = f"made(str({name}))" if self.direct else name
        return self._placed(code)

    def _placed(self, code: str) -> Operand:
        if self.careful:
            code = f"(places({self.temporaries}), {code})[1]"
        return Operand(code, TEXT, temporary=True)

    def free(self, piece: Operand) -> None:
        """A string has been used."""
        if piece.temporary:
            self.temporaries -= 1

    def made(self, code: str) -> Operand:
        """A string that was made; it holds a place."""
        if self.temporaries == TEMPORARIES:
            return Operand(f"({code}, bad('FORMULA TOO COMPLEX'))", dead=True)
        self.temporaries += 1
        return self._placed(code)

    # --- formulas -----------------------------------------------------------------------------

    def number(self, at: int) -> Operand:
        """FRMNUM: a formula that must be a number."""
        piece = self.formula(at)
        if not piece.dead and piece.kind == TEXT:
            return self.fails("TYPE MISMATCH", piece)
        return piece

    def formula(self, at: int, last: int = 0) -> Operand:
        """FRMEVL: a formula, up to an operator that does not bind closer than ``last``."""
        self.deepest = max(self.deepest, at)
        if at > STACK - ROOM:
            return self.fails("OUT OF MEMORY")
        left = self.element(at)
        if self.careful:
            left.code = f"(room({at}), {left.code})[1]"
            left.truth = None
        reader = self.reader
        while not left.dead:
            start = reader.at
            byte = reader.peek()
            if byte in RELATION_BITS:
                relation = self._relation()
                if not relation:
                    return self.fails("SYNTAX", left)
                precedence, operator = RELATIONAL, ""
            elif byte == PLUS and left.kind == TEXT:
                reader.skip()
                left = self._join(left, at)
                continue
            elif byte in OPERATORS:
                relation = 0
                precedence, operator = OPERATORS[byte]
                reader.skip()
            else:
                break
            if precedence <= last:
                reader.at = start
                break
            if operator and left.kind == TEXT:
                return self.fails("TYPE MISMATCH", left)
            right = self.formula(at + PENDING, precedence)
            if right.dead:
                return self.then(left, right)
            if relation:
                left = self._compared(left, relation, right)
            elif right.kind == TEXT:
                return self.fails("TYPE MISMATCH", left, right)
            else:
                left = self._operated(left, operator, right)
        return left

    def _relation(self) -> int:
        """The bits of a relation in any order of its signs; 0 when one comes twice."""
        bits = 0
        while bit := RELATION_BITS.get(self.reader.peek(), 0):
            if bits & bit:
                return 0
            bits |= bit
            self.reader.skip()
        return bits

    def _compared(self, left: Operand, relation: int, right: Operand) -> Operand:
        if left.kind != right.kind:
            return self.fails("TYPE MISMATCH", left, right)
        self.free(right)
        self.free(left)
        if relation == 7:
            truth = f"bool(({left.code}, {right.code}))"
        elif left.kind == TEXT:
            truth = f"({left.code} {RELATIONS[relation]} {right.code})"
        else:
            truth = f"(compare({left.stored}, {right.code}) {COMPARED[relation]})"
        return Operand(f"TRUTH[{truth}]", rounded=True, truth=truth)

    def _operated(self, left: Operand, operator: str, right: Operand) -> Operand:
        if operator in "&|":
            truth = f"({left.condition} {operator} {right.condition})"
            return Operand(f"TRUTH[{truth}]", rounded=True, truth=truth)
        return Operand(f"{operator}({left.code}, {right.code})")

    def _join(self, left: Operand, at: int) -> Operand:
        """left + the next element, whatever operator stands before."""
        right = self.element(at + 2)
        if right.dead:
            return self.then(left, right)
        if right.kind == NUMBER:
            return self.fails("TYPE MISMATCH", left, right)
        self.free(right)
        self.free(left)
        return self.made(f"joined({left.code}, {right.code})")

    # --- elements -----------------------------------------------------------------------------

    def element(self, at: int) -> Operand:
        """FRM_ELEMENT: a constant, a variable, a function, a sign or a parenthesis."""
        reader = self.reader
        while reader.take(PLUS):
            pass
        byte = reader.peek()
        if is_digit(byte) or byte == POINT:
            return self._constant()
        if is_letter(byte):
            return self._variable(at)
        if byte == QUOTE:
            reader.skip()
            return self.literal(reader.string())
        if byte in (MINUS, NOT):
            reader.skip()
            operand = self.formula(at + PENDING, HIGHEST)
            if operand.dead:
                return operand
            if operand.kind == TEXT:
                return self.fails("TYPE MISMATCH", operand)
            if byte == MINUS:
                return Operand(f"negate({operand.code})", rounded=operand.rounded)
            truth = f"(not {operand.condition})"
            return Operand(f"TRUTH[{truth}]", rounded=True, truth=truth)
        if byte == FN:
            return self._call(at)
        if byte >= FIRST_FUNCTION:
            reader.skip()
            return self._function(byte, at)
        return self._parenthesis(at + PARENTHESIS)

    def _constant(self) -> Operand:
        reader = self.reader
        try:
            value, reader.at = decimaltext.read(reader.number_text, reader.at)
        except ApplesoftError as error:
            return self.fails(error.kind)
        whole = None
        e, m, s = value
        if not s and e <= 143 and not m & (1 << 168 - e) - 1:
            whole = m >> 168 - e
        return Operand(self.real(value), rounded=not m & 0xFF, whole=whole)

    def _parenthesis(self, at: int) -> Operand:
        """PARCHK: a formula in parentheses."""
        if not self.reader.take(OPEN):
            return self.fails("SYNTAX")
        inner = self.formula(at)
        if inner.dead:
            return inner
        if not self.reader.take(CLOSE):
            return self.fails("SYNTAX", inner)
        return inner

    # --- variables ----------------------------------------------------------------------------

    def variable_name(self) -> tuple[str, str] | None:
        """Name and kind of the variable that comes next, None if none does."""
        name = self.reader.name()
        if name is None:
            return None
        for kind in (STRING, INTEGER):
            if self.reader.take(ord(kind)):
                return name, kind
        return name, REAL

    def _variable(self, at: int) -> Operand:
        found = self.variable_name()
        assert found is not None
        name, kind = found
        value_kind = TEXT if kind == STRING else NUMBER
        if self.reader.peek() == OPEN:
            subscripts = self.subscripts(at + 16)
            if isinstance(subscripts, Operand):
                return subscripts
            function = f"value{len(subscripts)}" if len(subscripts) < 3 else "value"
            code = f"{function}({ARRAYS.slot(name, kind)}, {', '.join(subscripts)})"
        else:
            code = f"V[{SIMPLE.slot(name, kind)}]"
        return Operand(code, value_kind, rounded=True, variable=kind == STRING)

    def subscripts(self, at: int) -> list[str] | Operand:
        """Text for each subscript, from the parenthesis on; a dead piece if one fails."""
        self.reader.skip()
        subscripts: list[Operand] = []
        while True:
            piece = self.number(at + 2 * len(subscripts))
            if piece.dead:
                return self.then(*subscripts, piece)
            if piece.whole is not None:
                subscripts.append(Operand(str(piece.whole)))
            else:
                subscripts.append(Operand(f"subscript({piece.code})"))
            if not self.reader.take(COMMA):
                break
        if not self.reader.take(CLOSE):
            return self.fails("SYNTAX", *subscripts)
        return [piece.code for piece in subscripts]

    # --- functions ----------------------------------------------------------------------------

    def function_name(self) -> int | Operand:
        """The slot of the function that is named after FN."""
        found = self.variable_name()
        if found is None or found[1] == INTEGER:
            return self.fails("SYNTAX")
        if found[1] == STRING:
            return self.fails("TYPE MISMATCH")
        return SIMPLE.slot(found[0], FUNCTION)

    def _call(self, at: int) -> Operand:
        self.reader.skip()
        slot = self.function_name()
        if isinstance(slot, Operand):
            return slot
        named = Operand(f"place({slot})")
        argument = self._parenthesis(at + 9)
        if argument.dead:
            return self.then(named, argument)
        if argument.kind == TEXT:
            return self.fails("TYPE MISMATCH", named, argument)
        return Operand(f"call({slot}, {argument.code}, {at + 16})")

    def _function(self, token: int, at: int) -> Operand:
        if token in SLICES:
            return self._slice(SLICES[token], at)
        argument = self._parenthesis(at + 8)
        if argument.dead:
            return argument
        if token in ANYTHING:
            self.free(argument)
            return Operand(f"{ANYTHING[token]}({argument.code})", rounded=True)
        if token in OF_TEXT:
            if argument.kind == NUMBER:
                return self.fails("TYPE MISMATCH", argument)
            self.free(argument)
            return Operand(f"{OF_TEXT[token]}({argument.code})", rounded=token != TOKENS["VAL"])
        if token == USR:
            return self.fails("ILLEGAL QUANTITY", argument)
        if argument.kind == TEXT:
            return self.fails("TYPE MISMATCH", argument)
        if token in MAKING_TEXT:
            return self.made(f"{MAKING_TEXT[token]}({argument.code})")
        if token in REFUSED_FUNCTIONS:
            return Operand(f"({argument.code}, refuse({REFUSED_FUNCTIONS[token]!r}))", dead=True)
        if token in NUMERIC:
            return Operand(f"{NUMERIC[token]}({argument.code})", rounded=token == TOKENS["PEEK"])
        return self.fails("SYNTAX", argument)

    def _slice(self, function: str, at: int) -> Operand:
        """LEFT$, RIGHT$ and MID$."""
        reader = self.reader
        if not reader.take(OPEN):
            return self.fails("SYNTAX")
        text = self.formula(at + 6)
        if text.dead:
            return text
        if not reader.take(COMMA):
            return self.fails("SYNTAX", text)
        if text.kind == NUMBER:
            return self.fails("TYPE MISMATCH", text)
        arguments = [text]
        for place in (at + 12, at + 14):
            n = self.byte(place)
            if n.dead:
                return self.then(*arguments, n)
            arguments.append(n)
            if function != "mid" or not reader.take(COMMA):
                break
        if not reader.take(CLOSE):
            return self.fails("SYNTAX", *arguments)
        self.free(text)
        return self.made(f"{function}({', '.join(piece.code for piece in arguments)})")

    def byte(self, at: int) -> Operand:
        """GETBYT: a number from 0 to 255, as text for an int."""
        return self._as_int("byte", 255, self.number(at))

    def address(self, at: int) -> Operand:
        """GETADR: a 16-bit address, as text for an int."""
        return self._as_int("address", 32767, self.number(at))

    @staticmethod
    def _as_int(function: str, limit: int, piece: Operand) -> Operand:
        if piece.dead:
            return piece
        if piece.whole is not None and piece.whole <= limit:
            return Operand(str(piece.whole))
        return Operand(f"{function}({piece.code})")
