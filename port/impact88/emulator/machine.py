"""The machine that runs a program: NEWSTT and the statements.

One method a routine of the ROM, named in its docstring by the label that the published listings of
the ROM give it. `memory` holds the state; each class on top of it adds a part: `text`, `strings`,
`variables`, `expressions`, `intrinsics`, `printing`, `inputs`, `flow`, `editing`; the rest is here.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from ..applesoft.console import Device, Keyboard
from ..applesoft.errorcodes import ApplesoftError
from .editing import Editing
from .faults import Fault, NextStatement, Restart, TooManyStatements, placed
from .intrinsics import address_of
from .memory import DIRECT, INPUT_BUFFER, RTS, SPEED
from .text import BLANK, COLON, COMMA, OPEN
from .tokens import KEYWORDS, LAST_STATEMENT, TOKENS
from .variables import SUBFLG_SIMPLE

REFUSALS = 8
MORE_REFUSED = "more of the kind"
"""Statements that are not done are remembered up to a number."""
COLOR, HIGH_COLOR, SCALE, ROTATION = 0x30, 0xE4, 0xE7, 0xF9
HIGH_COLORS = bytes.fromhex("00 2A 55 7F 80 AA D5 FF")
EQUAL, CLOSE_TOKEN = TOKENS["="], ord(")")
FIRST_TOKEN = 0x80
AFTER_TYPING = (0xD0, 0xD0 << 32, 0)
"""What the ROM's parser leaves in the accumulator: an address."""


class Machine(Editing):
    """An Apple II Plus with 48K as far as a BASIC program can tell.

    ``after_line(number)`` is called each time the program leaves a line; ``statements_left`` limits
    what it may do; ``interrupted`` is control-C; ``refused`` holds the statements that were asked
    for and are not done here; ``broken``: whether control-C ended the last program; ``last_line``:
    where it ended; ``error``: the error it ended in.
    """

    def __init__(
        self,
        keyboard: Keyboard,
        screen: Device,
        printer: Device | None = None,
        *,
        dos: bool = False,
        echo: bool = True,
        blanks: bool = True,
    ) -> None:
        super().__init__(keyboard, screen, printer, dos=dos, echo=echo, blanks=blanks)
        self.interrupted = False
        self.statements_left: int | None = None
        self.after_line: Callable[[int], object] | None = None
        self.refused: list[str] = []
        self.error: ApplesoftError | None = None
        self.fac = AFTER_TYPING
        statements = _statements(self)
        self._statements: list[Callable[[], None]] = [
            statements[word] if word in statements else partial(self.refuse, word)
            for word in KEYWORDS[: LAST_STATEMENT - FIRST_TOKEN + 1]
        ]
        self.text_changed()
        self.variables_changed()

    # --- running ------------------------------------------------------------------------------

    def execute_direct(self, typed: bytes, tokens: bytes) -> None:
        """Do a line typed without a number, and whatever it starts, until the machine is back at
        the prompt; ``error`` then holds the error that ended it, or None.

        ``typed``: the line before it was made tokens. Raises TooManyStatements and
        `console.EndOfInput`.
        """
        ram = self.ram
        ram[INPUT_BUFFER : INPUT_BUFFER + len(typed) + 1] = typed + b"\0"
        ram[INPUT_BUFFER : INPUT_BUFFER + len(tokens) + 1] = tokens + b"\0"
        ram[INPUT_BUFFER + len(tokens) + 2] = 0
        self.txtptr = INPUT_BUFFER
        self.fac = AFTER_TYPING
        self.curlin |= DIRECT
        self.error = None
        self.broken = False
        self._go(self._first_statement)

    def run_locked(self) -> None:
        """A line typed while LOCK is set: RUN."""
        self.set_pointers()
        self.curlin |= DIRECT
        self.error = None
        self.broken = False
        self._go(self._statements_on)

    def _first_statement(self) -> None:
        if self.character():
            self.execute()

    def _go(self, begin: Callable[[], None]) -> None:
        """Statements until RESTART, errors handled."""
        step = begin
        while True:
            try:
                try:
                    step()
                    step = self._statements_on
                except KeyboardInterrupt:
                    self.interrupted = False
                    self.break_()
                except NextStatement:
                    step = self._statements_on
            except Restart:
                return self._back_at_prompt()
            except ApplesoftError as error:
                try:
                    self._handle(error)
                except Restart:
                    return self._back_at_prompt()
                step = self._statements_on

    def _back_at_prompt(self) -> None:
        if self.curlin < DIRECT:
            self.last_line = self.curlin
            if self.after_line:
                self.after_line(self.curlin)

    def _handle(self, error: ApplesoftError) -> None:
        """ERROR: to ONERR's line, or a message and RESTART."""
        if self.errflg & 0x80:
            try:
                self.handle(error.code, placed(error, self.sp - 4).stack)
                return
            except ApplesoftError as undefined:
                error = undefined
        line = self.curlin
        error.line = line if line < DIRECT else None
        self.error = error
        self.output.put(f"\n?{error.kind}")
        self.clear_stack()
        self.message(b" ERROR")
        raise Restart

    def pause(self) -> None:
        """ISCNTC: control-C, or no more statements. Raises KeyboardInterrupt and
        TooManyStatements."""
        if self.interrupted:
            raise KeyboardInterrupt
        if self.statements_left is not None:
            if self.statements_left <= 0:
                raise TooManyStatements
            self.statements_left -= 1

    def _statements_on(self) -> None:
        """NEWSTT: statement after statement. Raises Restart at the program's end."""
        ram, statements = self.ram, self._statements
        line = self.curlin
        while True:
            self.remstk = self.sp
            if self.interrupted or self.statements_left is not None:
                self.pause()
            pos = self.txtptr
            if self.curlin < DIRECT:
                self.oldtext = pos
            byte = ram[pos]
            if not byte:
                if not ram[pos + 2] and pos >= INPUT_BUFFER:  # page 0 holds no program
                    raise Restart
                self.curlin = ram[pos + 3] | ram[pos + 4] << 8
                pos += 4
            elif byte != COLON:
                raise Fault("SYNTAX", self.sp)
            if self.after_line or self.trcflg & 0x80:
                self._watch(line)
                line = self.curlin
            pos += 1
            byte = ram[pos]
            while byte == BLANK:
                pos += 1
                byte = ram[pos]
            if byte >= FIRST_TOKEN:
                self.txtptr = pos + 1
                if byte > LAST_STATEMENT:
                    raise Fault("SYNTAX", self.sp - 2)
                statements[byte - FIRST_TOKEN]()
            else:
                self.txtptr = pos
                if byte and byte != COLON:
                    self.let(self.sp - 2)

    def _watch(self, before: int) -> None:
        """Between two statements: a line has been left; TRACE."""
        if self.after_line and before < DIRECT and before != self.curlin:
            self.after_line(before)
        if self.trcflg & 0x80 and self.curlin < DIRECT:
            self.output.put("#")
            self.line_number_shown(self.curlin)
            self.output.put(" ")

    def execute(self) -> None:
        """EXECUTE_STATEMENT: the statement at TXTPTR. Raises SYNTAX."""
        byte = self.character()
        if byte >= FIRST_TOKEN:
            self.txtptr += 1
            if byte > LAST_STATEMENT:
                raise Fault("SYNTAX", self.sp - 2)
            self._statements[byte - FIRST_TOKEN]()
        elif byte and byte != COLON:
            self.let(self.sp - 2)

    # --- variables ----------------------------------------------------------------------------

    def let_keyword(self) -> None:
        """LET with its keyword."""
        self.let(self.sp - 2)

    def let(self, sp: int) -> None:
        """LET. Raises SYNTAX, TYPE MISMATCH, ILLEGAL QUANTITY, and what its formulas do."""
        known = self.atoms.get(self.txtptr)
        if known and known[1] in self.simple and self.ram[known[0]] == EQUAL:
            self.forpnt = self.varpnt = target = self.simple[known[1]]
            of_integer = of_string = self.subflg = 0
            self.txtptr = known[0] + 1
        else:
            self.forpnt = target = self.variable(sp - 2)
            of_integer, of_string = self.inttyp, self.valtyp
            self.expect(EQUAL, sp - 2)
        fac = self.formula(sp - 4)
        if self.valtyp & 0x80 != of_string & 0x80:
            raise Fault("TYPE MISMATCH", sp - 3)
        if of_string:
            self.assign_string(target, fac)
        elif of_integer:
            self.assign_integer(target, fac, sp - 2)
        else:
            self.assign(target, fac)

    def dim(self) -> None:
        """DIM."""
        while True:
            self.variable(self.sp - 4, dimensions=1)
            if self.at_end():
                return
            self.expect(COMMA, self.sp - 4)

    def def_(self) -> None:
        """DEF: where the formula stands, and the variable of the argument. Errors in the formula
        show when it is used. Raises SYNTAX, TYPE MISMATCH, ILLEGAL DIRECT."""
        sp = self.sp - 2
        function = self.function_name(sp - 2)
        self.refuse_direct(sp - 2)
        self.expect(OPEN, sp - 2)
        self.subflg = SUBFLG_SIMPLE
        argument = self.variable(sp - 2)
        if self.valtyp:
            raise Fault("TYPE MISMATCH", sp - 2)
        self.expect(CLOSE_TOKEN, sp - 2)
        first = self.expect(EQUAL, sp - 2)
        self.put_word(function, self.txtptr)
        self.put_word(function + 2, argument)
        self.ram[function + 4] = first
        self.to_statement_end()

    # --- memory -------------------------------------------------------------------------------

    def address(self, sp: int) -> int:
        """GETADR on a formula: a 16-bit address. Raises ILLEGAL QUANTITY."""
        return address_of(self.number(sp - 2), sp - 2)

    def _address_and_byte(self) -> tuple[int, int]:
        """GTNUM: an address, a comma, a byte."""
        sp = self.sp - 2
        place = address_of(self.number(sp - 4), sp - 4)
        self.expect(COMMA, sp - 4)
        return place, self.byte(sp - 2)

    def poke_statement(self) -> None:
        """POKE."""
        place, n = self._address_and_byte()
        self.poke(place, n)

    def wait(self) -> None:
        """WAIT: until bits come up, which nothing but control-C does here."""
        place, mask = self._address_and_byte()
        flip = 0
        if not self.at_end():
            self.expect(COMMA, self.sp - 6)
            flip = self.byte(self.sp - 4)
        while not (self.peek(place) ^ flip) & mask:
            self.pause()

    def call(self) -> None:
        """CALL of a routine that is known, or of a bare RTS."""
        place = self.address(self.sp - 2)
        if place == 0xF328:
            self.forget_error()
        elif place == 0xD66C:
            self.clear()
        elif place == 0xD683:
            self.clear_stack()
        elif not (self.screen.call(place) or self.output.call(place) or self.peek(place) == RTS):
            self.refuse(f"CALL {place}")

    def himem(self) -> None:
        """HIMEM:. Raises OUT OF MEMORY below the arrays."""
        place = self.address(self.sp - 2)
        if place < self.strend:
            raise Fault("OUT OF MEMORY", self.sp - 2)
        self.memsiz = self.fretop = place

    def lomem(self) -> None:
        """LOMEM:, which clears all variables. Raises OUT OF MEMORY outside the free room."""
        place = self.address(self.sp - 2)
        if not self.vartab <= place < self.memsiz:
            raise Fault("OUT OF MEMORY", self.sp - 2)
        self.vartab = place
        self.clear()

    def clear_statement(self) -> None:
        """CLEAR."""
        if self.at_end():
            self.clear()

    # --- devices ------------------------------------------------------------------------------

    def with_byte(self, function: Callable[[int], object]) -> Callable[[], None]:
        """A statement that is a keyword and a byte."""

        def statement() -> None:
            sp = self.sp - 4
            n = self.byte(sp)
            try:
                function(n)
            except ApplesoftError as error:
                raise placed(error, sp + 2) from None

        return statement

    def byte_kept(self, place: int, table: bytes = bytes(range(256))) -> Callable[[int], None]:
        """COLOR=, ROT= and the like: a byte for drawing, which is not done here, and for PEEK."""

        def keep(n: int) -> None:
            if n >= len(table):
                raise ApplesoftError("ILLEGAL QUANTITY")
            self.ram[place] = table[n]

        return keep

    def trace(self, on: bool) -> Callable[[], None]:
        """TRACE and NOTRACE."""

        def statement() -> None:
            self.trcflg = self.trcflg >> 1 | (0x80 if on else 0)

        return statement

    def refuse(self, what: str) -> None:
        """What is not done here is a SYNTAX error, and remembered."""
        if what not in self.refused and len(self.refused) <= REFUSALS:
            self.refused.append(what if len(self.refused) < REFUSALS else MORE_REFUSED)
        raise Fault("SYNTAX", self.sp - 4)


def _statements(machine: Machine) -> dict[str, Callable[[], None]]:
    with_byte, kept = machine.with_byte, machine.byte_kept
    output, screen = machine.output, machine.screen
    return {
        "END": machine.end,
        "FOR": machine.for_,
        "NEXT": machine.next_,
        "DATA": machine.to_statement_end,
        "INPUT": machine.input_,
        "DEL": machine.delete,
        "DIM": machine.dim,
        "READ": machine.read,
        "TEXT": screen.full_window,
        "PR#": with_byte(machine.console.select),
        "IN#": with_byte(lambda slot: None),  # nothing but the keyboard is plugged in
        "CALL": machine.call,
        "HCOLOR=": with_byte(kept(HIGH_COLOR, HIGH_COLORS)),
        "HTAB": with_byte(output.htab),
        "HOME": screen.home,
        "ROT=": with_byte(kept(ROTATION)),
        "SCALE=": with_byte(kept(SCALE)),
        "TRACE": machine.trace(True),
        "NOTRACE": machine.trace(False),
        "NORMAL": output.normal,
        "INVERSE": output.inverse,
        "FLASH": output.flash,
        "COLOR=": with_byte(kept(COLOR, bytes((n & 15) * 17 for n in range(256)))),
        "POP": machine.pop,
        "VTAB": with_byte(output.vtab),
        "HIMEM:": machine.himem,
        "LOMEM:": machine.lomem,
        "ONERR": machine.onerr,
        "RESUME": machine.resume,
        "SPEED=": with_byte(kept(SPEED, bytes(-n & 0xFF for n in range(256)))),
        "LET": machine.let_keyword,
        "GOTO": machine.goto_known,
        "RUN": machine.run,
        "IF": machine.if_,
        "RESTORE": machine.restore,
        "GOSUB": machine.gosub,
        "RETURN": machine.return_,
        "REM": machine.to_line_end,
        "STOP": machine.stop,
        "ON": machine.on,
        "WAIT": machine.wait,
        "DEF": machine.def_,
        "POKE": machine.poke_statement,
        "PRINT": machine.print_,
        "CONT": machine.cont,
        "LIST": machine.list_,
        "CLEAR": machine.clear_statement,
        "GET": machine.get,
        "NEW": machine.new,
    }
