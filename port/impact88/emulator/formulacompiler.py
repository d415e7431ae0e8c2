"""Compiling expressions: tokens into Python text, in the ROM's order of events.

The ROM reads and computes in one go, so an error of syntax or type shows only after everything to
its left has been computed. Here an operand that ends in such an error is *dead*: it computes what
comes before and then raises; nothing after it is read.

Values are the triples of `real`, and a string's `strings.Descriptor`. The rules in `real` round the
left operand and keep the right one's extension, as the ROM does, so nothing of that stands here.

Where the ROM takes a string for a number it takes what stands in its accumulator: the length of a
string just made, or what an earlier number left there. `residue` is the name for it; ``leftovers``
says that a formula may ask for the latter.

``depth`` is how far below the statement's beginning the 6502 stack has come. In a *careful*
compilation every formula looks at the stack before it goes deeper, and leaves its number in the
accumulator.

A string may be the left operand of a comparison, which rounds its address by the accumulator's
extension (`accumulator`). ``Operand.tracked`` is its text when that is to be followed.
"""

from __future__ import annotations

from ..applesoft import decimaltext
from ..applesoft.errorcodes import ApplesoftError
from ..applesoft.real import INTEGER_EXPONENT, Number
from .operand import (
    ALL_RELATIONS,
    CLOSE,
    COMMA,
    COMPARED,
    FIRST_FUNCTION,
    FN,
    HIGHEST,
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
    TEXT,
    USR,
    Operand,
)
from .reader import QUOTE, Reader, is_digit, is_letter
from .symbols import ARRAYS, FUNCTION, INTEGER, REAL, SIMPLE, STRING
from .tokens import TOKENS

WITHIN = {
    "add": 3,
    "subtract": 3,
    "divide": 3,
    "power": 6,
    "EXP": 7,
    "SQR": 8,
    "PEEK": 9,
    "VAL": 10,
    "CHR": 7,
    "CHR_": 7,
    "call": 3,
    "subscript": 12,
    "byte_": 8,
}
"""How deep in its own calls a routine of the ROM finds an error, where it is not `ELSEWHERE`."""
ELSEWHERE = 5
STATEMENT = -1
"""Where a statement's own calls stand, compared with those of a formula."""
VARIABLE_POINTER = (131, 132)
"""Where the ROM keeps the address of the variable it found last."""


class FormulaCompiler:
    """The expression compiler for one line."""

    def __init__(self, reader: Reader, *, careful: bool, direct: bool) -> None:
        self.reader = reader
        self.careful = careful
        self.direct = direct
        self.constants: dict[str, Number | str] = {}
        self.deepest = 0
        self.leftovers = False
        self._depth = STATEMENT
        self._strings_compared = False

    # --- errors -------------------------------------------------------------------------------

    def fails(self, kind: str, *before: Operand, within: int = ELSEWHERE) -> Operand:
        """An operand that computes ``before`` and then raises, ``within`` bytes further down."""
        code = f"bad({kind!r})"
        if self.careful:
            code = f"done_at({self._depth + within}, bad, {kind!r})"
        if before:
            code = f"({', '.join(operand.code for operand in before)}, {code})"
        return Operand(code, dead=True)

    def then(self, *operands: Operand) -> Operand:
        """Pieces of which the last is dead."""
        if len(operands) == 1:
            return operands[0]
        return Operand(f"({', '.join(operand.code for operand in operands)})", dead=True)

    # --- careful steps ------------------------------------------------------------------------

    def at_depth(self, function: str, *operands: str, leaves: str = "done_at") -> str:
        """Text for a call that is made where the formula now stands on the stack; ``leaves``: what
        it leaves in the accumulator."""
        if self.careful:
            depth = self._depth + WITHIN.get(function, ELSEWHERE)
            return f"{leaves}({', '.join((str(depth), function, *operands))})"
        return f"{function}({', '.join(operands)})"

    def to_number(self, function: str, *operands: str) -> str:
        """The same for one that makes a number."""
        return self.at_depth(function, *operands, leaves="number_at")

    def to_string(self, function: str, *operands: str) -> str:
        """The same for one that makes a string."""
        return self.at_depth(function, *operands, leaves="string_at")

    def loaded(self, code: str) -> str:
        """A number that comes into the accumulator as it is."""
        return f"load({code})" if self.careful else code

    def truth(self, condition: str) -> Operand:
        """1 or 0."""
        if self.careful:
            return Operand(f"load(TRUTH[{condition}])", rounded=True)
        return Operand(f"TRUTH[{condition}]", rounded=True, truth=condition)

    # --- constants ----------------------------------------------------------------------------

    def real(self, value: Number) -> str:
        """The name of a constant real."""
        e, m, s = value
        name = f"c_{e:02x}{m:010x}{s}"
        self.constants[name] = value
        return name

    def literal(self) -> Operand:
        """A string in the program, its opening quote read; typed without a line number, it has to
        be copied."""
        offset = self.reader.position
        text = self.reader.string()
        if self.direct:
            name = f"t_{text.encode('latin-1').hex()}"
            self.constants[name] = text
            code = self.to_string("made", name)
            return Operand(f"scanned({code})" if self.careful else code, TEXT)
        place = (f"base[pc] + {offset}", str(len(text)))
        code, tracked = (self.to_string(name, *place) for name in ("literal", "literal_"))
        if self.careful:
            code, tracked = f"scanned({code})", f"scanned({tracked})"
        return Operand(code, TEXT, tracked=tracked, text=text)

    def residue(self, string: Operand) -> Operand:
        """The number that the accumulator holds when a string has been found."""
        if string.variable:
            self.leftovers = True
            return Operand(f"({string.code}, left_over())[1]")
        return Operand(f"residue({string.code})")

    # --- formulas -----------------------------------------------------------------------------

    def number(self, depth: int) -> Operand:
        """FRMNUM: a formula that must be a number."""
        operand = self.formula(depth)
        if not operand.dead and operand.kind == TEXT:
            return self.fails("TYPE MISMATCH", operand, within=7)
        return operand

    def formula(self, depth: int, last: int = 0) -> Operand:
        """FRMEVL: a formula, up to an operator that does not bind closer than ``last``."""
        before, self._depth = self._depth, depth
        operand = self._formula(depth, last)
        self._depth = before
        return operand

    def _formula(self, depth: int, last: int) -> Operand:
        self.deepest = max(self.deepest, depth)
        if depth > STACK - ROOM:
            return self.fails("OUT OF MEMORY")
        left = self.element(depth)
        self._strings_compared = False
        if self.careful:
            left.code = f"(room({depth}), {left.code})[1]"
            left.truth = None
        reader = self.reader
        while not left.dead:
            start = reader.position
            byte = reader.peek()
            relation = 0
            if byte in RELATION_BITS:
                relation = self._relation()
                if not relation:
                    return self.fails("SYNTAX", left)
                precedence, operator = RELATIONAL, ""
            elif byte == PLUS and left.kind == TEXT:
                reader.skip()
                left = self._join(left, depth)
                if self._strings_compared and not left.dead:
                    # the ROM still holds the flags of the comparison, and takes them for another
                    relation = ALL_RELATIONS
                    precedence, operator = RELATIONAL, ""
                else:
                    continue
            elif byte in OPERATORS:
                precedence, operator = OPERATORS[byte]
                reader.skip()
            else:
                break
            if precedence <= last:
                reader.position = start
                if relation and left.kind == TEXT:
                    left = self.residue(left)
                    left.text_relation = True
                break
            if operator and left.kind == TEXT:
                return self.fails("TYPE MISMATCH", left, within=2)
            of_text = left.kind == TEXT or left.text_relation
            right = self.formula(depth + PENDING, precedence)
            if right.dead:
                return self.then(left, right)
            if relation:
                left, chained = self._compared(left, of_text, relation, right), right
            elif right.kind == TEXT:
                return self.fails("TYPE MISMATCH", left, right, within=PENDING + 2)
            else:
                left, chained = self._operated(left, operator, right), right
            left.text_relation = chained.text_relation
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

    def _compared(self, left: Operand, of_text: bool, relation: int, right: Operand) -> Operand:
        """left relation right. Whether it compares strings was settled by what stood before the
        relation: a number there if another relation came between (``"A"="B"=1``)."""
        if of_text != (right.kind == TEXT):
            return self.fails("TYPE MISMATCH", left, right)
        if of_text:
            self._strings_compared = True
            order = "strcmp" if left.kind == TEXT else "junkcmp"
            code = f"left_operand({left.tracked})" if left.tracked else left.code
            order = self.at_depth(order, code, right.code)
            truth = f"({order} {RELATIONS[relation]} 0)" if relation != 7 else f"bool(({order},))"
        elif relation == ALL_RELATIONS:
            truth = f"bool(({left.code}, {right.code}))"
        else:
            truth = f"(compare({left.stored}, {right.code}) {COMPARED[relation]})"
        return self.truth(truth)

    def _operated(self, left: Operand, operator: str, right: Operand) -> Operand:
        if operator == "power" and right.huge:
            self.leftovers = True
        if operator in "&|":
            return self.truth(f"({left.condition} {operator} {right.condition})")
        return Operand(self.to_number(operator, left.code, right.code))

    def _join(self, left: Operand, depth: int) -> Operand:
        """left + the next element, whatever operator stands before."""
        self._depth = depth + 2
        right = self.element(depth + 2)
        self._depth = depth
        if right.dead:
            return self.then(left, right)
        if right.kind == NUMBER:
            return self.fails("TYPE MISMATCH", left, right)
        code = self.to_string("joined", left.code, right.code)
        tracked = self.to_string("joined_", left.code, right.code)
        return Operand(code, TEXT, tracked=tracked)

    # --- elements -----------------------------------------------------------------------------

    def element(self, depth: int) -> Operand:
        """FRM_ELEMENT: a constant, a variable, a function, a sign or a parenthesis."""
        reader = self.reader
        while reader.take(PLUS):
            pass
        byte = reader.peek()
        if is_digit(byte) or byte == POINT:
            return self._constant()
        if is_letter(byte):
            return self._variable(depth)
        if byte == QUOTE:
            reader.skip()
            return self.literal()
        if byte in (MINUS, NOT):
            reader.skip()
            operand = self.formula(depth + PENDING, HIGHEST)
            if operand.dead:
                return operand
            if operand.kind == TEXT:
                return self.fails("TYPE MISMATCH", operand, within=PENDING + 2)
            if byte == MINUS:
                code = self.to_number("negate", operand.code)
                return Operand(code, rounded=operand.rounded)
            return self.truth(f"(not {operand.condition})")
        if byte == FN:
            return self._call(depth)
        if byte >= FIRST_FUNCTION:
            reader.skip()
            return self._function(byte, depth)
        return self._parenthesis(depth + PARENTHESIS)

    def _constant(self) -> Operand:
        reader = self.reader
        try:
            value, reader.position = decimaltext.read(reader.number_text, reader.position)
        except ApplesoftError as error:
            return self.fails(error.kind)
        whole = None
        e, m, s = value
        if not s and e <= 143 and not m & (1 << 168 - e) - 1:
            whole = m >> 168 - e
        code = self.loaded(self.real(value))
        whole = None if self.careful else whole
        return Operand(code, rounded=not m & 0xFF, whole=whole, huge=e >= INTEGER_EXPONENT)

    def _parenthesis(self, depth: int) -> Operand:
        """PARCHK: a formula in parentheses."""
        if not self.reader.take(OPEN):
            return self.fails("SYNTAX", within=max(ELSEWHERE, depth - self._depth))
        inner = self.formula(depth)
        if inner.dead:
            return inner
        if not self.reader.take(CLOSE):
            return self.fails("SYNTAX", inner, within=depth - self._depth - 2)
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

    def _variable(self, depth: int) -> Operand:
        variable = self.variable_name()
        assert variable is not None
        name, kind = variable
        value_kind = TEXT if kind == STRING else NUMBER
        if self.reader.peek() == OPEN:
            subscripts = self.subscripts(depth + 16)
            if isinstance(subscripts, Operand):
                return subscripts
            function = f"value{len(subscripts)}" if len(subscripts) < 3 else "value"
            code = self.at_depth(function, str(ARRAYS.slot(name, kind)), *subscripts)
        else:
            slot = SIMPLE.slot(name, kind)
            code = f"V[find({slot})]" if self.careful else f"V[{slot}]"
        if value_kind == NUMBER:
            code = self.loaded(code)
        return Operand(code, value_kind, rounded=True, variable=kind == STRING)

    def subscripts(self, depth: int) -> list[str] | Operand:
        """Text for each subscript, from the parenthesis on; a dead operand if one fails."""
        self.reader.skip()
        subscripts: list[Operand] = []
        while True:
            operand = self.number(depth + 2 * len(subscripts))
            if operand.dead:
                return self.then(*subscripts, operand)
            if operand.whole is not None:
                subscripts.append(Operand(str(operand.whole)))
            else:
                subscripts.append(Operand(self.at_depth("subscript", operand.code)))
            if not self.reader.take(COMMA):
                break
        if not self.reader.take(CLOSE):
            return self.fails("SYNTAX", *subscripts)
        return [operand.code for operand in subscripts]

    # --- functions ----------------------------------------------------------------------------

    def function_name(self) -> tuple[int, Operand | None]:
        """The slot of the function that is named after FN, and a dead operand if the name is none.

        A string's name makes a variable before it is refused: with both marks in its name, that of
        the kind and that of a function, it is an integer.
        """
        variable = self.variable_name()
        if variable is None or variable[1] == INTEGER:
            return -1, self.fails("SYNTAX")
        name, kind = variable
        if kind == STRING:
            place = Operand(f"place({SIMPLE.slot(name, INTEGER)})")
            return -1, self.fails("TYPE MISMATCH", place)
        return SIMPLE.slot(name, FUNCTION), None

    def _call(self, depth: int) -> Operand:
        self.reader.skip()
        slot, refused = self.function_name()
        if refused is not None:
            return refused
        place = Operand(f"place({slot})")
        argument = self._parenthesis(depth + 9)
        if argument.dead:
            return self.then(place, argument)
        if argument.kind == TEXT:
            return self.fails("TYPE MISMATCH", place, argument)
        name = f"place({slot})[1]"
        return Operand(self.to_number("call", name, argument.code, str(depth + 16)))

    def _function(self, token: int, depth: int) -> Operand:
        """A function of one argument. Most are worked out before the ROM sees that the argument
        was a string; CHR$, PEEK and those of ANYTHING never look."""
        if token in SLICES:
            return self._slice(SLICES[token], depth)
        argument = self._parenthesis(depth + 8)
        if argument.dead:
            return argument
        if token == TOKENS["FRE"]:
            code = "FREE" if argument.kind == TEXT else "FRE"
            return Operand(self.to_number(code, argument.code), rounded=True)
        if token == TOKENS["POS"]:
            return Operand(self.to_number("POS", argument.code), rounded=True)
        if token in OF_TEXT:
            if argument.kind == NUMBER:
                return self.fails("TYPE MISMATCH", argument, within=11)
            code = self.to_number(OF_TEXT[token], argument.code)
            return Operand(code, rounded=token != TOKENS["VAL"])
        if token == USR:
            return self.fails("ILLEGAL QUANTITY", argument)
        if token == TOKENS["STR$"]:
            if argument.kind == TEXT:
                return self.fails("TYPE MISMATCH", argument)
            return Operand(self.to_string("STR", argument.code), TEXT)
        text = argument.kind == TEXT
        if text:
            argument = self.residue(argument)
        if token == TOKENS["CHR$"]:
            code, tracked = (self.to_string(name, argument.code) for name in ("CHR", "CHR_"))
            return Operand(code, TEXT, tracked=tracked)
        if token in REFUSED_FUNCTIONS:
            return Operand(f"({argument.code}, refuse({REFUSED_FUNCTIONS[token]!r}))", dead=True)
        if token not in NUMERIC:
            return self.fails("SYNTAX", argument)
        if token == TOKENS["PEEK"] and argument.whole in VARIABLE_POINTER:
            self.leftovers = True
        code = self.to_number(NUMERIC[token], argument.code)
        value = Operand(code, rounded=token == TOKENS["PEEK"])
        return self.fails("TYPE MISMATCH", value) if text and token != TOKENS["PEEK"] else value

    def _slice(self, function: str, depth: int) -> Operand:
        """LEFT$, RIGHT$ and MID$."""
        reader = self.reader
        if not reader.take(OPEN):
            return self.fails("SYNTAX")
        text = self.formula(depth + 6)
        if text.dead:
            return text
        if not reader.take(COMMA):
            return self.fails("SYNTAX", text, within=6)
        if text.kind == NUMBER:
            return self.fails("TYPE MISMATCH", text, within=6)
        arguments = [text]
        last = None
        for place in (depth + 12, depth + 14):
            last = self.number(place)
            n = self._as_int("byte", 255, last, within=8)
            if n.dead:
                return self.then(*arguments, n)
            arguments.append(n)
            if function != "mid" or not reader.take(COMMA):
                break
        if not reader.take(CLOSE):
            return self.fails("SYNTAX", *arguments)
        codes = [each.code for each in arguments]
        code = self.to_string(function, *codes)
        if last is None or last.whole is not None:
            return Operand(code, TEXT)
        codes[-1] = self.at_depth("byte_", last.code)
        return Operand(code, TEXT, tracked=self.to_string(function, *codes))

    def byte(self, depth: int) -> Operand:
        """GETBYT: a number from 0 to 255, as text for an int."""
        return self._as_int("byte", 255, self.number(depth))

    def address(self, depth: int) -> Operand:
        """GETADR: a 16-bit address, as text for an int."""
        return self._as_int("address", 32767, self.number(depth))

    def _as_int(
        self, function: str, limit: int, operand: Operand, *, within: int = ELSEWHERE
    ) -> Operand:
        if operand.dead:
            return operand
        if operand.whole is not None and operand.whole <= limit:
            return Operand(str(operand.whole))
        code = f"{function}({operand.code})"
        if self.careful:
            code = f"done_at({self._depth + within}, {function}, {operand.code})"
        return Operand(code)
