"""Compiling statements: which keyword begins what, and the few that fit nowhere else.

See `steps` for what they become, `flow` and `devices` for most of them.
"""

from __future__ import annotations

from collections.abc import Callable

from .devices import Devices
from .flow import Flow
from .pieces import COMMA, FN, OPEN, Piece
from .steps import EQUAL, TARGET_AT
from .symbols import ARRAYS, SIMPLE, STRING
from .tokens import KEYWORDS, LAST_STATEMENT

REFUSED = (
    *"GR PLOT HLIN VLIN HGR2 HGR HCOLOR= HPLOT DRAW XDRAW ROT= SCALE= COLOR=".split(),
    *"SHLOAD RECALL STORE LOAD SAVE &".split(),
)
"""Graphics, shapes, tape and machine-code hooks: tokenised and listed, but not done."""


class Statements(Flow, Devices):
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
            if self._over or not reader.tokens[reader.at :].strip(b" \0"):
                return
            if not reader.at_end():
                self._begin(True)
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
            found = self.formulas.variable_name()
            if found is None:
                self._fail("SYNTAX")
                return
            name, kind = found
            if reader.peek() == OPEN:
                sizes = self.formulas.subscripts(TARGET_AT)
                if isinstance(sizes, Piece):
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
        slot = formulas.function_name()
        if isinstance(slot, Piece):
            self._stop(slot)
            return
        self._emit(f"place({slot})")
        if self.direct:
            self._fail("ILLEGAL DIRECT")
            return
        if not reader.take(OPEN):
            self._fail("SYNTAX")
            return
        target = self._target(simple=True)
        if isinstance(target, Piece):
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
        start, depth = reader.at, formulas.deepest
        formulas.deepest = 0
        body = formulas.number(0)
        if not body.dead and not reader.at_end():
            body = formulas.fails("SYNTAX", body)
        self._emit(f"V[{slot}] = Function({argument}, lambda: {body.code}, {formulas.deepest})")
        reader.at, formulas.deepest = start, depth
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
"""Statements that look at nothing after them."""
_WITH_BYTE = {
    "PR#": "pr",
    "IN#": "in_",
    "HTAB": "htab",
    "VTAB": "vtab",
    "SPEED=": "speed",
}
_ALONE = {
    "END": "end(pc)",
    "STOP": "stop(pc)",
    "NEW": "new()",
    "CLEAR": "clear()",
    "POP": "pop()",
    "CONT": "return cont(pc)",
}
"""Statements that do nothing unless they stand alone."""
_STATEMENTS: dict[str, Callable[[Statements], None]] = {
    "FOR": Statements._for,
    "NEXT": Statements._next,
    "DATA": Statements._data,
    "INPUT": Statements._input,
    "DEL": Statements._del,
    "DIM": Statements._dim,
    "READ": Statements._read,
    "CALL": Statements._call,
    "HIMEM:": Statements._himem,
    "LOMEM:": Statements._lomem,
    "ONERR": Statements._onerr,
    "LET": Statements._let_keyword,
    "GOTO": Statements._goto,
    "RUN": Statements._run,
    "IF": Statements._if,
    "GOSUB": Statements._gosub,
    "RETURN": Statements._return,
    "REM": Statements._rem,
    "ON": Statements._on,
    "WAIT": Statements._wait,
    "DEF": Statements._def,
    "POKE": Statements._poke,
    "PRINT": Statements._print,
    "LIST": Statements._list,
    "GET": Statements._get,
}
