"""The machine that runs a program: NEWSTT, and the statements that fit nowhere else.

One method a routine of the ROM, its docstring beginning with its label in the published listings of
the ROM; a statement's is named for its keyword, with an underscore. `memory` holds the state;
`variables`, `expressions`, `inputoutput` and `flow` add a part each.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

from ..applesoft.errorcodes import ApplesoftError
from ..applesoft.real import integer
from .expressions import address_of
from .faults import Fault, Restart, placed
from .flow import BREAK, EQUAL, Flow
from .inputoutput import FROM_DATA
from .memory import DIRECT, INPUT_BUFFER, RTS, SPEED, SUBFLG_SIMPLE
from .screen import FLASHING, INVERSE, NORMAL
from .tokens import BLANK, CLOSE, COLON, COMMA, FIRST, KEYWORDS, LAST_STATEMENT, OPEN

EVERY_BYTE = bytes(range(256))
KEPT = {
    "SPEED=": (SPEED, bytes(-n & 0xFF for n in EVERY_BYTE)),
    "COLOR=": (0x30, bytes((n & 15) * 17 for n in EVERY_BYTE)),
    "HCOLOR=": (0xE4, bytes.fromhex("00 2A 55 7F 80 AA D5 FF")),
    "ROT=": (0xF9, EVERY_BYTE),
    "SCALE=": (0xE7, EVERY_BYTE),
}
"""Statements that put a byte into memory for drawing, which is not done here, and for PEEK: where,
and what for each number."""


class Machine(Flow):
    """An Apple II Plus with 48K as far as a BASIC program can tell.

    ``after_line(number)`` is called each time the program leaves a line. Of the last program:
    ``broken``, whether control-C ended it, and ``error``, in which.
    """

    def __init__(self, *devices: Any, **options: Any) -> None:
        super().__init__(*devices, **options)
        self.after_line: Callable[[int], object] | None = None
        self.error: ApplesoftError | None = None
        statements: dict[str, Callable[[], object]] = {
            word: getattr(self, f"{word.lower().rstrip(':')}_", partial(self.refuse, word))
            for word in KEYWORDS[: LAST_STATEMENT - FIRST + 1]
        }
        statements |= {
            **{word: partial(self.keep_byte, *where) for word, where in KEPT.items()},
            "HOME": self.screen.home,
            "TEXT": self.screen.full_window,
            "NORMAL": partial(self.set_mode, NORMAL),
            "INVERSE": partial(self.set_mode, INVERSE),
            "FLASH": partial(self.set_mode, FLASHING, 0x40),
            "TRACE": partial(self.trace, 0x80),
            "NOTRACE": partial(self.trace, 0),
            "LET": lambda: self.let(self.sp - 2),
            "POKE": lambda: self.poke(*self._address_and_byte()),
            "READ": lambda: self.take_items(FROM_DATA, self.datptr, self.sp - 2),
            "PR#": lambda: self.console.select(self.byte(self.sp - 4)),
            "IN#": lambda: self.byte(self.sp - 4),  # nothing but the keyboard is plugged in
        }
        alone: dict[str, Callable[[], object]]
        alone = {"CLEAR": self.clear, "CONT": self.cont, "END": self.end, "NEW": self.new}
        alone |= {"POP": self.subroutine, "RETURN": self.return_}
        alone["STOP"] = partial(self.end, BREAK)
        statements |= {word: partial(self._alone, does) for word, does in alone.items()}
        self.statements = list(statements.values())
        self.clear_stack()
        self.text_changed()
        self.variables_changed()

    def go(self, step: Callable[[], None]) -> None:
        """Do a ``step`` and whatever follows, until the machine is back at the prompt. Raises
        TooManyStatements and `console.EndOfInput`."""
        self.curlin |= DIRECT
        self.error, self.broken = None, False
        while True:
            try:
                try:
                    step()
                except KeyboardInterrupt:
                    self.interrupted = False
                    self.break_()
                except ApplesoftError as error:
                    self._handle(error)
            except ApplesoftError as error:
                step = partial(self._handle, error)
                continue
            except Restart:
                break
            step = self.next_statements
        if self.after_line and self.curlin < DIRECT:
            self.after_line(self.curlin)

    def _handle(self, error: ApplesoftError) -> None:
        """ERROR: a message and RESTART; under ONERR its line (HANDLERR), the stack left as it is.
        Raises UNDEF'D STATEMENT there, where the ROM would loop."""
        if self.errflg & 0x80:
            stack = placed(error, self.sp - 4).stack
            self.errnum, self.errstk = error.code, self.remstk
            self.errlin, self.errpos = self.curlin, self.oldtext
            self.txtptr, self.curlin = self.txtpsv, self.cursv
            self.sp = stack & 0xFF
            if stack < 0:
                self.frames.clear()
            try:
                return self.goto_()
            except ApplesoftError:
                self.errflg = 0
                raise
        error.line = self.curlin if self.curlin < DIRECT else None
        self.error = error
        self.put(f"\n?{error.kind}")
        self.clear_stack()
        self.message(b" ERROR")
        raise Restart

    def next_statements(self) -> None:
        """NEWSTT: statement after statement. Raises Restart at the program's end."""
        ram = self.ram
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
                if not ram[pos + 2]:
                    if pos < INPUT_BUFFER:  # after a bad reply to a direct GOTO's INPUT
                        raise Fault("SYNTAX", self.sp)
                    raise Restart
                self.curlin = ram[pos + 3] | ram[pos + 4] << 8
                pos += 4
            elif byte != COLON:
                raise Fault("SYNTAX", self.sp)
            if self.after_line or self.trcflg & 0x80:
                if self.after_line and line < DIRECT and line != self.curlin:
                    self.after_line(line)
                if self.trcflg & 0x80 and self.curlin < DIRECT:
                    self.put("#")
                    self.show_number(integer(self.curlin))
                    self.put(" ")
                line = self.curlin
            self.txtptr = pos + 1
            self.execute()

    def execute(self) -> None:
        """EXECUTE_STATEMENT: the statement at TXTPTR. Raises SYNTAX."""
        ram, pos = self.ram, self.txtptr
        while (byte := ram[pos]) == BLANK:
            pos += 1
        if byte >= FIRST:
            self.txtptr = pos + 1
            if byte > LAST_STATEMENT:
                raise Fault("SYNTAX", self.sp - 2)
            self.statements[byte - FIRST]()
        else:
            self.txtptr = pos
            if byte and byte != COLON:
                self.let(self.sp - 2)

    def dim_(self) -> None:
        while True:
            self.variable(self.sp - 4, dimensions=1)
            if self.at_end():
                return
            self.expect(COMMA, self.sp - 4)

    def def_(self) -> None:
        """DEF: where the formula stands, and the variable of the argument."""
        sp = self.sp - 4
        function = self.function_name(sp)
        self.refuse_direct(sp)
        self.expect(OPEN, sp)
        self.subflg = SUBFLG_SIMPLE
        argument = self.variable(sp)
        if self.valtyp:
            raise Fault("TYPE MISMATCH", sp)
        self.expect(CLOSE, sp)
        first = self.expect(EQUAL, sp)
        self.put_word(function, self.txtptr)
        self.put_word(function + 2, argument)
        self.ram[function + 4] = first
        self.data_()

    def _address(self, sp: int) -> int:
        return address_of(self.number(sp), sp)

    def _address_and_byte(self) -> tuple[int, int]:
        """GTNUM: an address, a comma, a byte."""
        place = self._address(self.sp - 6)
        self.expect(COMMA, self.sp - 6)
        return place, self.byte(self.sp - 4)

    def wait_(self) -> None:
        """WAIT: until bits come up, which nothing but control-C does here."""
        (place, mask), flip = self._address_and_byte(), 0
        if not self.at_end():
            self.expect(COMMA, self.sp - 6)
            flip = self.byte(self.sp - 4)
        while not (self.peek(place) ^ flip) & mask:
            self.pause()

    def call_(self) -> None:
        """CALL of a routine that is known, or of a bare RTS."""
        place = self._address(self.sp - 4)
        bell, normal = partial(self.put, "\a"), partial(self.set_mode, NORMAL)
        routines: dict[int, Callable[[], object]] = {
            **{0xF328: self.forget_error, 0xD66C: self.clear, 0xD683: self.clear_stack},
            **{0xFD8E: partial(self.put, "\n"), 0xFF3A: bell, 0xFBDD: bell, 0xFCA8: int},  # WAIT
            **{0xFE80: partial(self.set_mode, INVERSE), 0xFE84: normal, 0xF273: normal},
        }
        if place in routines:
            routines[place]()
        elif not self.screen.call(place) and self.peek(place) != RTS:
            self.refuse(f"CALL {place}")

    def himem_(self) -> None:
        place = self._address(self.sp - 4)
        if place < self.strend:
            raise Fault("OUT OF MEMORY", self.sp - 2)
        self.memsiz = self.fretop = place

    def lomem_(self) -> None:
        place = self._address(self.sp - 4)
        if not self.vartab <= place < self.memsiz:
            raise Fault("OUT OF MEMORY", self.sp - 2)
        self.vartab = place
        self.clear()

    def _alone(self, does: Callable[[], object]) -> None:
        """A statement that takes nothing; where something follows it does nothing."""
        if self.at_end():
            does()

    def keep_byte(self, place: int, table: bytes) -> None:
        n = self.byte(self.sp - 4)
        if n >= len(table):
            raise Fault("ILLEGAL QUANTITY", self.sp - 2)
        self.ram[place] = table[n]

    def trace(self, bit: int) -> None:
        self.trcflg = self.trcflg >> 1 | bit
