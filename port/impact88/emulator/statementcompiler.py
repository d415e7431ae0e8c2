"""Compiling statements: which keyword begins what, and the few that fit nowhere else.

See `linecompiler` for what they become, `flowcompiler` and `devicecompiler` for most of them.
"""

from __future__ import annotations

from collections.abc import Callable

from .devicecompiler import DeviceCompiler
from .flowcompiler import FlowCompiler
from .linecompiler import EQUAL, TARGET_AT
from .operand import COMMA, FN, OPEN, Operand
from .symbols import ARRAYS, SIMPLE, STRING
from .tokens import KEYWORDS, LAST_STATEMENT

REFUSED = (
    *"GR PLOT HLIN VLIN HGR2 HGR HPLOT DRAW XDRAW".split(),
    *"SHLOAD RECALL STORE LOAD SAVE &".split(),
)
"""Drawing, shapes, tape and machine-code hooks: tokenised and listed, but not done."""


class StatementCompiler(FlowCompiler, DeviceCompiler):
    """The statement compiler for one line: `steps` holds what it made."""

    def __init__(self, tokens: bytes, *, careful: bool = False, direct: bool = False) -> None:
        super().__init__(tokens, careful=careful, direct=direct)
        self._line()

    def _line(self) -> None:
        reader = self.reader
        while True:
            self._begin(True)
            self._statement()
            self._end_step()
            if self._over or not reader.tokens[reader.position :].strip(b" \0"):
                return
            if not reader.at_end():
                self._begin(True)
                self.steps[-1].traced = False
                self._fail("SYNTAX")
                return
            if not reader.peek():
                return
            reader.skip()

    def _statement(self) -> None:
        reader = self.reader
        if reader.at_end():
            return
        token = reader.peek()
        if token < 0x80:
            self._let()
        elif token > LAST_STATEMENT:
            self._fail("SYNTAX")
        else:
            reader.skip()
            word = KEYWORDS[token - 0x80]
            if word in REFUSED:
                self._emit(f"refuse({word!r})")
                self._over = True
            elif word in _SIMPLE_CALLS:
                self._emit(_SIMPLE_CALLS[word])
            elif word in _WITH_BYTE:
                self._with_byte(_WITH_BYTE[word])
            elif word in _ALONE:
                if reader.at_end():
                    self._emit(_ALONE[word])
            else:
                _STATEMENTS[word](self)

    def _dim(self) -> None:
        reader = self.reader
        while True:
            variable = self.formulas.variable_name()
            if variable is None:
                self._fail("SYNTAX")
                return
            name, kind = variable
            if reader.peek() == OPEN:
                sizes = self.formulas.subscripts(TARGET_AT)
                if isinstance(sizes, Operand):
                    self._stop(sizes)
                    return
                self._emit(f"dimension({ARRAYS.slot(name, kind)}, ({', '.join(sizes)},))")
            else:
                self._emit(f"place({SIMPLE.slot(name, kind)})")
            if reader.at_end():
                return
            if not reader.take(COMMA):
                self._fail("SYNTAX")
                return

    def _def(self) -> None:
        reader, formulas = self.reader, self.formulas
        if not reader.take(FN):
            self._fail("SYNTAX")
            return
        slot, refused = formulas.function_name()
        if refused is not None:
            self._stop(refused)
            return
        self._emit(f"place({slot})")
        if self.direct:
            self._fail("ILLEGAL DIRECT")
            return
        if not reader.take(OPEN):
            self._fail("SYNTAX")
            return
        target = self._target(simple=True)
        if isinstance(target, Operand):
            self._stop(target)
            return
        kind, place = target
        self._emit(place)
        if kind == STRING:
            self._fail("TYPE MISMATCH")
        elif not reader.take(ord(")")) or not reader.take(EQUAL):
            self._fail("SYNTAX")
        else:
            self._body(slot, int(place[6:-1]))

    def _body(self, slot: int, argument: int) -> None:
        """The formula of DEF FN. It is read when the function is called, so errors show then."""
        reader, formulas = self.reader, self.formulas
        start, depth = reader.position, formulas.deepest
        formulas.deepest = 0
        body = formulas.number(0)
        if not body.dead and not reader.at_end():
            body = formulas.fails("SYNTAX", body)
        self._emit(f"V[{slot}] = Function({argument}, lambda: {body.code}, {formulas.deepest})")
        reader.position, formulas.deepest = start, depth
        reader.skip_statement()

    def _data(self) -> None:
        self.reader.skip_statement()

    def _rem(self) -> None:
        self.reader.skip_line()

    def _let_keyword(self) -> None:
        self._let()


_SIMPLE_CALLS = {
    "HOME": "home()",
    "TEXT": "text()",
    "TRACE": "trace(pc, True)",
    "NOTRACE": "trace(pc, False)",
    "NORMAL": "normal()",
    "INVERSE": "inverse()",
    "FLASH": "flash()",
    "RESTORE": "restore()",
    "RESUME": "return resume()",
}
"""StatementCompiler that look at nothing after them."""
_WITH_BYTE = {
    "PR#": "pr",
    "IN#": "in_",
    "HTAB": "htab",
    "VTAB": "vtab",
    "SPEED=": "speed",
    "COLOR=": "color",
    "HCOLOR=": "hcolor",
    "ROT=": "rot",
    "SCALE=": "scale",
}
_ALONE = {
    "END": "end(pc)",
    "STOP": "stop(pc)",
    "NEW": "new(pc)",
    "CLEAR": "clear()",
    "POP": "pop()",
    "CONT": "return cont(pc)",
}
"""StatementCompiler that do nothing unless they stand alone."""
_STATEMENTS: dict[str, Callable[[StatementCompiler], None]] = {
    "FOR": StatementCompiler._for,
    "NEXT": StatementCompiler._next,
    "DATA": StatementCompiler._data,
    "INPUT": StatementCompiler._input,
    "DEL": StatementCompiler._del,
    "DIM": StatementCompiler._dim,
    "READ": StatementCompiler._read,
    "CALL": StatementCompiler._call,
    "HIMEM:": StatementCompiler._himem,
    "LOMEM:": StatementCompiler._lomem,
    "ONERR": StatementCompiler._onerr,
    "LET": StatementCompiler._let_keyword,
    "GOTO": StatementCompiler._goto,
    "RUN": StatementCompiler._run,
    "IF": StatementCompiler._if,
    "GOSUB": StatementCompiler._gosub,
    "RETURN": StatementCompiler._return,
    "REM": StatementCompiler._rem,
    "ON": StatementCompiler._on,
    "WAIT": StatementCompiler._wait,
    "DEF": StatementCompiler._def,
    "POKE": StatementCompiler._poke,
    "PRINT": StatementCompiler._print,
    "LIST": StatementCompiler._list,
    "GET": StatementCompiler._get,
}
