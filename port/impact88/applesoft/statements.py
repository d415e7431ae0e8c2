"""Compiling statements: each into the body of a Python function ``(pc) -> next pc``.

A step (`Step`) is what runs between two looks at the program: one statement, or for ``NEXT J,I`` one
of its variables. The names used in the text made here (``V``, ``first``, ``out`` ...) are supplied by
the machine (`machine.Machine`). Errors of syntax become code that raises, in the place where the ROM
would stumble: after everything before it has been done.
"""

from __future__ import annotations

from collections.abc import Callable

from .expressions import COMMA, NUMBER, OPEN, TEXT, Expressions, Piece
from .reader import QUOTE, Reader, is_digit
from .symbols import ARRAYS, INTEGER, SIMPLE, STRING
from .tokens import KEYWORDS, LAST_STATEMENT, TOKENS

SEMICOLON = ord(";")
LET_AT = 6
"""How deep the stack is when LET begins its formula; likewise below."""
TARGET_AT = 15
"""... when LET, READ or INPUT begins the first subscript of its variable."""
IF_AT = PRINT_AT = 4
BYTE_AT = 8
ADDRESS_AT = 6
TAB_AT = 9
LIMIT_AT = 8
STEP_AT = 13
TO, THEN, STEP, GOTO, GOSUB, TAB, SPC, EQUAL, MINUS, FN = (
    TOKENS[word] for word in ("TO", "THEN", "STEP", "GOTO", "GOSUB", "TAB(", "SPC(", "=", "-", "FN")
)
REFUSED = (
    *"GR PLOT HLIN VLIN HGR2 HGR HCOLOR= HPLOT DRAW XDRAW ROT= SCALE= COLOR=".split(),
    *"SHLOAD RECALL STORE LOAD SAVE &".split(),
)
"""Graphics, shapes, tape and machine-code hooks: tokenised and listed, but not done."""


class Step:
    """``code``: the function's body. ``begins``: whether a statement begins here. ``need``: how
    deep its formulas go into the stack."""

    def __init__(self, begins: bool) -> None:
        self.code: list[str] = []
        self.begins = begins
        self.need = 0


class Statements:
    """The statement compiler for one line."""

    def __init__(self, tokens: bytes, *, careful: bool = False, direct: bool = False) -> None:
        self.reader = Reader(tokens)
        self.formulas = Expressions(self.reader, careful=careful, direct=direct)
        self.direct = direct
        self.steps: list[Step] = []
        self._over = False
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

    # --- steps --------------------------------------------------------------------------------

    def _begin(self, begins: bool) -> None:
        self.steps.append(Step(begins))
        self.formulas.temporaries = 0
        self.formulas.deepest = 0

    def _end_step(self) -> None:
        self.steps[-1].need = max(self.steps[-1].need, self.formulas.deepest)

    def _emit(self, code: str) -> None:
        self.steps[-1].code.append(code)

    def _fail(self, kind: str, *before: Piece) -> None:
        self._stop(self.formulas.fails(kind, *before))

    def _stop(self, dead: Piece) -> None:
        """The statement ends in an error; nothing after it can be reached."""
        self._emit(dead.code)
        self._over = True

    def _leave(self, code: str) -> None:
        """The statement goes elsewhere for good."""
        self._emit(f"return {code}")
        self._over = True

    # --- a statement --------------------------------------------------------------------------

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

    def _with_byte(self, function: str) -> None:
        piece = self.formulas.byte(BYTE_AT)
        if piece.dead:
            self._stop(piece)
        else:
            self._emit(f"{function}({piece.code})")

    # --- LET and variables --------------------------------------------------------------------

    def _target(self, at: int = TARGET_AT, *, simple: bool = False) -> tuple[str, str] | Piece:
        """PTRGET: kind of the variable that comes next, and text for its place (list and index)."""
        found = self.formulas.variable_name()
        if found is None:
            return self.formulas.fails("SYNTAX")
        name, kind = found
        if simple and kind == INTEGER:
            return self.formulas.fails("SYNTAX")
        if simple or self.reader.peek() != OPEN:
            return kind, f"place({SIMPLE.slot(name, kind)})"
        subscripts = self.formulas.subscripts(at)
        if isinstance(subscripts, Piece):
            return subscripts
        function = f"element{len(subscripts)}" if len(subscripts) < 3 else "element"
        return kind, f"{function}({ARRAYS.slot(name, kind)}, {', '.join(subscripts)})"

    def _let(self, *, simple: bool = False) -> tuple[str, int] | None:
        """LET. Returns kind and slot of a simple variable, None when the statement has ended in an
        error (or the variable is an element)."""
        target = self._target(simple=simple)
        if isinstance(target, Piece):
            self._stop(target)
            return None
        kind, place = target
        slot = int(place[6:-1]) if place.startswith("place(") else None
        if slot is not None:
            self._emit(f"if not made_[{slot}]: make({slot})")
            to = f"V[{slot}]"
        else:
            self._emit(f"a, i = {place}")
            to = "a[i]"
        if not self.reader.take(EQUAL):
            self._fail("SYNTAX")
            return None
        value = self.formulas.formula(LET_AT)
        if not value.dead and (value.kind == TEXT) != (kind == STRING):
            value = self.formulas.fails("TYPE MISMATCH", value)
        if value.dead:
            self._stop(value)
            return None
        self._emit(f"{to} = {self._stored(kind, value)}")
        return (kind, slot) if slot is not None else None

    def _stored(self, kind: str, value: Piece) -> str:
        """Text for what a variable of a kind takes of a value."""
        if kind == STRING:
            self.formulas.free(value)
            return f"copy({value.code})" if value.variable else value.code
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
            if isinstance(target, Piece):
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

    # --- control ------------------------------------------------------------------------------

    def _line_number(self) -> int | None:
        """The line number that comes next; None (and the code to complain) past 63999."""
        number = self.reader.line_number()
        if number is None:
            self._fail("SYNTAX")
        return number

    def _goto(self) -> None:
        number = self._line_number()
        if number is not None:
            self._leave(f"first[{number}]")

    def _gosub(self) -> None:
        self._emit(f"return gosub(pc, {self.reader.line_number()})")
        self.reader.skip_statement()

    def _on(self) -> None:
        reader = self.reader
        number = self.formulas.byte(BYTE_AT)
        if number.dead:
            self._stop(number)
            return
        command = reader.peek()
        if command not in (GOTO, GOSUB):
            self._fail("SYNTAX", number)
            return
        reader.skip()
        self._emit(f"n = {number.code}")
        targets: list[int] = []
        bad = False
        while True:
            target = reader.line_number()
            bad = target is None
            if target is None:
                break
            targets.append(target)
            if not reader.take(COMMA):
                break
        table = f"({', '.join(map(str, targets))},)[n - 1]"
        if targets:
            to = f"first[{table}]" if command == GOTO else f"gosub(pc, {table})"
            self._emit(f"if 0 < n <= {len(targets)}: return {to}")
        if bad:
            self._fail("SYNTAX")

    def _if(self) -> None:
        reader, formulas = self.reader, self.formulas
        value = formulas.formula(IF_AT)
        if value.dead:
            self._stop(value)
            return
        if reader.peek() != GOTO and not reader.take(THEN):
            self._fail("SYNTAX", value)
            return
        if value.kind == NUMBER:
            condition = value.condition
        else:
            # the ROM looks at the number accumulator, where a new string's length stands, and
            # forgets the string in one of the three places
            condition = f"({value.code} != '')"
            if value.temporary:
                condition = f"lose({condition})"
                formulas.free(value)
        self._emit(f"if not {condition}: return after[pc]")
        if is_digit(reader.peek()):
            self._goto()
        else:
            self._statement()

    def _for(self) -> None:
        reader, formulas = self.reader, self.formulas
        variable = self._let(simple=True)
        if variable is None:
            self._over = True
            return
        kind, slot = variable
        self._emit(f"begin_for({slot})")
        if not reader.take(TO):
            self._fail("SYNTAX")
            return
        if kind == STRING:
            self._fail("TYPE MISMATCH")
            return
        limit = formulas.number(LIMIT_AT)
        if limit.dead:
            self._stop(limit)
            return
        self._emit(f"limit = {limit.stored}")
        by = "ONE"
        if reader.take(STEP):
            step = formulas.number(STEP_AT)
            if step.dead:
                self._stop(step)
                return
            by = step.stored
        self._emit(f"return push_for({slot}, pc + 1, limit, {by})")

    def _next(self) -> None:
        if self.reader.at_end():
            self._emit("return next_(pc, -1)")
            return
        while True:
            target = self._target()
            if isinstance(target, Piece):
                self._stop(target)
                return
            place = target[1]
            if not place.startswith("place("):
                self._fail("NEXT WITHOUT FOR", Piece(place))
                return
            self._emit(f"return next_(pc, {place[6:-1]})")
            if not self.reader.take(COMMA):
                return
            self._end_step()
            self._begin(False)

    def _return(self) -> None:
        if self.reader.at_end():
            self._leave("return_()")

    def _run(self) -> None:
        if self.reader.at_end():
            self._leave("run(None)")
            return
        self._emit("rerun()")
        number = self._line_number()
        if number is not None:
            self._leave(f"run({number})")

    def _onerr(self) -> None:
        if not self.reader.take(GOTO):
            self._fail("SYNTAX")
            return
        self._emit(f"onerr(pc, {self.reader.line_number()})")
        self.reader.skip_line()

    # --- PRINT, INPUT and their kin -----------------------------------------------------------

    def _print(self) -> None:
        reader, formulas = self.reader, self.formulas
        newline = True
        while not reader.at_end():
            newline = False
            byte = reader.peek()
            if byte in (TAB, SPC):
                reader.skip()
                columns = formulas.byte(TAB_AT)
                if not columns.dead and not reader.take(ord(")")):
                    columns = formulas.fails("SYNTAX", columns)
                if columns.dead:
                    self._stop(columns)
                    return
                self._emit(f"{'tab' if byte == TAB else 'spc'}({columns.code})")
            elif byte == COMMA:
                reader.skip()
                self._emit("zone()")
            elif byte == SEMICOLON:
                reader.skip()
            else:
                value = formulas.formula(PRINT_AT)
                if value.dead:
                    self._stop(value)
                    return
                formulas.free(value)
                self._emit(f"out({value.code if value.kind == TEXT else f'write({value.code})'})")
                newline = True
        if newline:
            self._emit("out('\\n')")

    def _input(self) -> None:
        reader = self.reader
        prompt = "?"
        if reader.take(QUOTE):
            prompt = reader.string()
            if not reader.take(SEMICOLON):
                self._fail("SYNTAX")
                return
        self._emit(f"out({prompt!r})")
        if self.direct:
            self._fail("ILLEGAL DIRECT")
            return
        self._emit(f"if input_(pc, {self._items()}): return start[pc]")

    def _get(self) -> None:
        if self.direct:
            self._fail("ILLEGAL DIRECT")
            return
        self._emit(f"get({self._items()})")

    def _read(self) -> None:
        self._emit(f"read({self._items()})")

    # --- the machine --------------------------------------------------------------------------

    def _pair(self, function: str, *, third: bool = False) -> None:
        """POKE and WAIT: an address and bytes, separated by commas."""
        formulas = self.formulas
        pieces = [formulas.address(BYTE_AT)]
        while not pieces[-1].dead and len(pieces) < 2 + third:
            if len(pieces) == 2 and self.reader.at_end():
                break
            if not self.reader.take(COMMA):
                pieces.append(formulas.fails("SYNTAX"))
            else:
                pieces.append(formulas.byte(BYTE_AT))
        if pieces[-1].dead:
            self._stop(formulas.then(*pieces))
        else:
            self._emit(f"{function}({', '.join(piece.code for piece in pieces)})")

    def _poke(self) -> None:
        self._pair("POKE")

    def _wait(self) -> None:
        self._pair("if not WAIT", third=True)
        if not self._over:
            self.steps[-1].code[-1] += ": return pc"

    def _with_address(self, function: str) -> None:
        piece = self.formulas.address(ADDRESS_AT)
        if piece.dead:
            self._stop(piece)
        else:
            self._emit(f"{function}({piece.code})")

    def _call(self) -> None:
        self._with_address("CALL")

    def _himem(self) -> None:
        self._with_address("himem")

    def _lomem(self) -> None:
        self._with_address("lomem")

    # --- the program itself -------------------------------------------------------------------

    def _list(self) -> None:
        reader = self.reader
        byte = reader.peek()
        if not (is_digit(byte) or reader.at_end() or byte in (MINUS, COMMA)):
            return
        first = last = self._line_number()
        if first is None:
            return
        if not reader.at_end():
            if not (reader.take(MINUS) or reader.take(COMMA)):
                return
            last = self._line_number()
            if last is None or not reader.at_end():
                return
        self._emit(f"list_({first}, {last or 0xFFFF})")

    def _del(self) -> None:
        if not is_digit(self.reader.peek()):
            self._fail("SYNTAX")
            return
        first = self._line_number()
        if first is None:
            return
        if not self.reader.take(COMMA):
            self._fail("SYNTAX")
            return
        last = self._line_number()
        if last is not None:
            self._emit(f"delete({first}, {last})")

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
