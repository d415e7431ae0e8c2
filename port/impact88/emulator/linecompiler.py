"""Compiling a line's steps: what statements have in common, LET, and the variables they name.

A step is what runs without interruption: one statement, or for ``NEXT J,I`` one of its
variables. It becomes the body of a Python function ``(pc) -> next pc``. The names used in the text
made here (``V``, ``first``, ``out`` ...) are supplied by the machine (`machine.Machine`). Errors of
syntax become code that raises, in the place where the ROM would stumble: after everything before it
has been done.
"""

from __future__ import annotations

from .formulacompiler import FormulaCompiler
from .operand import COMMA, OPEN, TEXT, Operand
from .reader import Reader
from .symbols import ARRAYS, INTEGER, SIMPLE, STRING
from .tokens import TOKENS

LET_AT = 6
"""How deep the stack is when LET begins its formula; likewise elsewhere."""
CALLED = 2
"""A return address, when FOR calls LET."""
TARGET_AT = 15
"""... when LET, READ or INPUT begins the first subscript of its variable."""
EQUAL = TOKENS["="]


class Step:
    """``code``: the function's body. ``begins``: whether a statement begins here, ``traced``:
    whether TRACE shows it. ``position``: where the ROM stands in the line's tokens before it: at
    the colon, or before the line. ``need``: how deep its formulas go into the stack."""

    def __init__(self, begins: bool, position: int) -> None:
        self.code: list[str] = []
        self.begins = begins
        self.traced = begins
        self.position = position
        self.need = 0


class LineCompiler:
    """The steps of one line as they are made."""

    def __init__(self, tokens: bytes, *, careful: bool = False, direct: bool = False) -> None:
        self.reader = Reader(tokens)
        self.formulas = FormulaCompiler(self.reader, careful=careful, direct=direct)
        self.direct = direct
        self.steps: list[Step] = []
        self._over = False

    # --- steps --------------------------------------------------------------------------------

    def _begin(self, begins: bool) -> None:
        self.steps.append(Step(begins, self.reader.position - 1))
        self.formulas.deepest = 0

    def _end_step(self) -> None:
        self.steps[-1].need = max(self.steps[-1].need, self.formulas.deepest)

    def _emit(self, code: str) -> None:
        self.steps[-1].code.append(code)

    def _fail(self, kind: str, *before: Operand) -> None:
        self._stop(self.formulas.fails(kind, *before))

    def _stop(self, dead: Operand) -> None:
        """The statement ends in an error; nothing after it on the line can be reached."""
        self._emit(dead.code)
        self._over = True

    def _leave(self, code: str) -> None:
        """The statement goes elsewhere for good."""
        self._emit(f"return {code}")
        self._over = True

    def _line_number(self) -> int | None:
        """The line number that comes next; None (and the code to complain) past 63999."""
        number = self.reader.line_number()
        if number is None:
            self._fail("SYNTAX")
        return number

    # --- LET and variables --------------------------------------------------------------------

    def _target(self, depth: int = TARGET_AT, *, simple: bool = False) -> tuple[str, str] | Operand:
        """PTRGET: kind of the variable that comes next, and text for its place (list and index)."""
        variable = self.formulas.variable_name()
        if variable is None:
            return self.formulas.fails("SYNTAX")
        name, kind = variable
        if simple and kind == INTEGER:
            return self.formulas.fails("SYNTAX")
        if simple or self.reader.peek() != OPEN:
            return kind, f"place({SIMPLE.slot(name, kind)})"
        subscripts = self.formulas.subscripts(depth)
        if isinstance(subscripts, Operand):
            return subscripts
        function = f"element{len(subscripts)}" if len(subscripts) < 3 else "element"
        return kind, f"{function}({ARRAYS.slot(name, kind)}, {', '.join(subscripts)})"

    def _let(self, *, simple: bool = False) -> tuple[str, int] | None:
        """LET. Returns kind and slot of a simple variable, None when the statement has ended in an
        error (or the variable is an element)."""
        target = self._target(simple=simple)
        if isinstance(target, Operand):
            self._stop(target)
            return None
        kind, place = target
        slot = int(place[6:-1]) if place.startswith("place(") else None
        if slot is not None:
            self._emit(f"if not made_[{slot}]: make({slot})")
            if self.formulas.careful:
                self._emit(f"assign({slot})")
            to = f"V[{slot}]"
        else:
            self._emit(f"a, i = {place}")
            to = "a[i]"
        if not self.reader.take(EQUAL):
            self._fail("SYNTAX")
            return None
        value = self.formulas.formula(LET_AT + CALLED if simple else LET_AT)
        if not value.dead and (value.kind == TEXT) != (kind == STRING):
            value = self.formulas.fails("TYPE MISMATCH", value, within=6)
        if value.dead:
            self._stop(value)
            return None
        self._emit(f"{to} = {self._stored(kind, value)}")
        return (kind, slot) if slot is not None else None

    def _stored(self, kind: str, value: Operand) -> str:
        """Text for what a variable of a kind takes of a value."""
        if kind == STRING:
            return self.formulas.to_string("copied" if value.variable else "kept", value.code)
        if kind == INTEGER:
            return f"whole({value.code})"
        return value.stored

    def _items(self) -> str:
        """The variables of READ, INPUT or GET: text for a tuple of kinds and of functions that give
        the places.

        They are looked up one by one, each when the value before has been stored.
        """
        items = []
        while True:
            target = self._target()
            if isinstance(target, Operand):
                items.append(f"('', lambda: {target.code})")
                self._over = True
                break
            kind, place = target
            items.append(f"({kind!r}, lambda: {place})")
            if self.reader.at_end():
                break
            if not self.reader.take(COMMA):
                items.append("('', lambda: bad('SYNTAX'))")
                self._over = True
                break
        return f"({', '.join(items)},)"
