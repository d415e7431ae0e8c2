"""The machine that runs a program: NEWSTT, the statements, and entering program lines.

There is one method for each routine of the ROM, whose docstring begins with the routine's label in
the published listings; a statement's method is named after its keyword, with an underscore.
`memory`, `variables`, `expressions` and `inputoutput` contain the rest.

FOR and GOSUB put 18 and 7 bytes on the 6502's stack. They are found only as consecutive frames from
the stack pointer on, so that bytes left by an error that ONERR caught hide all frames below. In
memory a line is the address of the next one, its number, its tokens and a zero; an address of 0
ends the program. LIST and GOTO follow the addresses; a running program continues with the bytes
after a line's zero."""

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any, NamedTuple

from ..applesoft.errorcodes import ApplesoftError
from ..applesoft.real import ZERO, Number, add, compare, integer, rounded
from .expressions import ONE, address_of
from .faults import Fault, Restart, fault_if, with_stack
from .inputoutput import BREAK, BREAK_CODE, ERROR, FROM_DATA, IN, InputOutput
from .memory import (
    DIGITS,
    DIRECT,
    HEADER,
    INPUT_BUFFER,
    KEYBOARD,
    ROM,
    STACK,
    SUBFLG_SIMPLE,
    TEMPORARIES,
)
from .screen import FLASHING, INVERSE, NORMAL
from .tokens import (
    BLANK,
    CLOSE,
    COLON,
    COMMA,
    FIRST,
    KEYWORDS,
    LAST_STATEMENT,
    OPEN,
    TOKENS,
    following_line,
)

FOR_SIZE = 18  # bytes on the stack
FOR_ROOM = 74  # the lowest stack pointer at FOR
GOSUB_SIZE = 7
GOSUB_ROOM = 64
NO_VARIABLE = -1  # the variable of a GOSUB's frame
AFTER_CALL = 0x9E
"""Index on page 2 at which CALL -678 stores keys: it enters the monitor's reading of a line in the
middle, with a register as CALL left it."""
END_MARK = b"\0\0"
TO = TOKENS["TO"]
THEN = TOKENS["THEN"]
STEP = TOKENS["STEP"]
GOSUB = TOKENS["GOSUB"]
GOTO = TOKENS["GOTO"]
EQUAL = TOKENS["="]
WITHOUT_OPERANDS = ("CLEAR", "CONT", "END", "NEW", "POP", "RETURN", "STOP")
EVERY_BYTE = bytes(range(256))
STORED_BYTES = {
    "SPEED=": (0xF1, bytes(-n & 0xFF for n in EVERY_BYTE)),
    "COLOR=": (0x30, bytes((n & 15) * 17 for n in EVERY_BYTE)),
    "HCOLOR=": (0xE4, bytes.fromhex("00 2A 55 7F 80 AA D5 FF")),
    "ROT=": (0xF9, EVERY_BYTE),
    "SCALE=": (0xE7, EVERY_BYTE),
}
"""Statements that only store a byte for drawing, which is not implemented, and for PEEK: its
address, and the byte for each number."""


class Frame(NamedTuple):
    """A loop or, with `NO_VARIABLE`, a subroutine.

    ``sp``: the stack pointer below it; ``variable``: the address of the loop's variable; ``line``,
    ``text``: the place to return to; ``sign``: that of the step."""

    sp: int
    variable: int
    line: int
    text: int
    limit: Number = ZERO
    step: Number = ZERO
    sign: int = 0


class Machine(InputOutput):
    """An Apple II Plus with 48K, as seen by a BASIC program.

    ``after_line(number)`` is called each time the program leaves a line. ``broken``: True if
    control-C ended the last program; ``error``: the error that ended it, or None.
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
            **{word: partial(self.store_byte, *where) for word, where in STORED_BYTES.items()},
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
            "IN#": lambda: self.byte(self.sp - 4),  # there is no input but the keyboard
        }
        for word in WITHOUT_OPERANDS:
            statements[word] = partial(self._run_if_alone, statements[word])
        self.statements = list(statements.values())
        self.clear_stack()
        self.text_changed()
        self.variables_changed()

    def go(self, step: Callable[[], None]) -> None:
        """Run ``step`` and continue until the machine is back at the prompt. Raises
        TooManyStatements and `console.EndOfInput`."""
        self.curlin |= DIRECT
        self.error, self.broken = None, False
        while True:
            try:
                step()
                step = self.next_statements
            except KeyboardInterrupt:
                self.interrupted = False
                step = self.break_
            except ApplesoftError as error:
                step = partial(self._handle, error)
            except Restart:
                break
        if self.after_line and self.curlin < DIRECT:
            self.after_line(self.curlin)

    def _handle(self, error: ApplesoftError) -> None:
        """ERROR: show a message and RESTART; under ONERR go to its line (HANDLERR) and leave the
        stack as it is. Raises UNDEF'D STATEMENT if that line is missing, where the ROM would
        loop."""
        if self.errflg & 0x80:
            stack = with_stack(error, self.sp - 4).stack
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
        self.message(ERROR)
        raise Restart

    def next_statements(self) -> None:
        """NEWSTT: execute statements. Raises Restart at the program's end."""
        ram, statements = self.ram, self.statements
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
            pos += 1
            while (byte := ram[pos]) == BLANK:
                pos += 1
            if FIRST <= byte <= LAST_STATEMENT:
                self.txtptr = pos + 1
                statements[byte - FIRST]()
            else:
                self.txtptr = pos
                self.execute()

    def execute(self) -> None:
        """EXECUTE_STATEMENT: execute the statement at TXTPTR. Raises SYNTAX."""
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
        """DEF: store the address of the formula and that of the argument's variable."""
        sp = self.sp - 4
        function = self.function_name(sp)
        self.refuse_direct(sp)
        self.expect(OPEN, sp)
        self.subflg = SUBFLG_SIMPLE
        argument = self.variable(sp)
        fault_if(self.valtyp, "TYPE MISMATCH", sp)
        self.expect(CLOSE, sp)
        first = self.expect(EQUAL, sp)
        self.put_word(function, self.txtptr)
        self.put_word(function + 2, argument)
        self.ram[function + 4] = first
        self.data_()

    def _address(self, sp: int) -> int:
        return address_of(self.number(sp), sp)

    def _address_and_byte(self) -> tuple[int, int]:
        """GTNUM: return an address and, after a comma, a byte."""
        place = self._address(self.sp - 6)
        self.expect(COMMA, self.sp - 6)
        return place, self.byte(self.sp - 4)

    def wait_(self) -> None:
        """WAIT: wait for bits at an address; only those of a key change here."""
        (place, mask), flip = self._address_and_byte(), 0
        if not self.at_end():
            self.expect(COMMA, self.sp - 6)
            flip = self.byte(self.sp - 4)
        while not (self.peek(place) ^ flip) & mask:
            if place in KEYBOARD:
                self.console.key_code(wait=True)
            self.pause()

    def call_(self) -> None:
        """CALL: run one of the routines implemented here, or a bare RTS (0x60)."""
        place = self._address(self.sp - 4)
        bell, normal = partial(self.put, "\a"), partial(self.set_mode, NORMAL)
        routines: dict[int, Callable[[], object]] = {
            **self.screen.routines,
            0xF328: self.forget_error,
            0xD66C: self.clear_,
            0xD683: self.clear_stack,
            0xFD8E: partial(self.put, "\n"),
            0xFF3A: bell,
            0xFBDD: bell,
            0xFCA8: int,  # WAIT, which only takes time
            0xFE80: partial(self.set_mode, INVERSE),
            0xFE84: normal,
            0xF273: normal,
            0xFD0C: self.console.read_key,
            0xFD5A: partial(self.get_line, AFTER_CALL),
            0xFD67: partial(self.get_line, before="\n"),
            0xFD6A: partial(self.get_line, before=""),
            0xFD6F: self.get_line,
        }
        if place in routines:
            routines[place]()
        elif self.peek(place) != 0x60:
            self.refuse(f"CALL {place}")

    def himem_(self) -> None:
        place = self._address(self.sp - 4)
        fault_if(place < self.strend, "OUT OF MEMORY", self.sp - 2)
        self.memsiz = self.fretop = place

    def lomem_(self) -> None:
        place = self._address(self.sp - 4)
        fault_if(not self.vartab <= place < self.memsiz, "OUT OF MEMORY", self.sp - 2)
        self.vartab = place
        self.clear_()

    def _run_if_alone(self, does: Callable[[], object]) -> None:
        """Run a statement without operands; if anything follows it does nothing."""
        if self.at_end():
            does()

    def store_byte(self, place: int, table: bytes) -> None:
        n = self.byte(self.sp - 4)
        fault_if(n >= len(table), "ILLEGAL QUANTITY", self.sp - 2)
        self.ram[place] = table[n]

    def trace(self, bit: int) -> None:
        self.trcflg = self.trcflg >> 1 | bit

    def set_stack(self, sp: int) -> None:
        """TXS: set the stack pointer and drop the frames below it."""
        self.sp = sp
        while self.frames and self.frames[-1].sp < sp:
            self.frames.pop()

    def clear_stack(self) -> None:
        """STKINI: clear the stack, temporary strings and the place for CONT."""
        self.temppt = TEMPORARIES
        self.sp = STACK
        self.frames: list[Frame] = []
        self.oldtext &= 0xFF
        self.subflg = 0

    def set_pointers(self) -> None:
        """SETPTRS: set TXTPTR before the program; and CLEARC: clear variables and restore DATA."""
        self.txtptr = self.txttab - 1
        self.clear_()

    def clear_(self) -> None:
        self.fretop = self.memsiz
        self.arytab = self.strend = self.vartab
        self.simple.clear()
        self.arrays.clear()
        self.restore_()
        self.clear_stack()

    def _find_loop(self) -> tuple[int, int]:
        """GTFORPNT: return the index of the loop with FORPNT's variable (the innermost one if
        FORPNT's high byte is 0), -1 if there is none, and the stack pointer after the search."""
        sp, frames = self.sp, self.frames
        for n in range(len(frames) - 1, -1, -1):
            frame = frames[n]
            if frame.sp != sp or frame.variable == NO_VARIABLE:
                break
            if not self.forpnt >> 8:
                self.forpnt = frame.variable
            if frame.variable == self.forpnt:
                return n, sp
            sp = sp + FOR_SIZE & 0xFF
        return -1, sp

    def let(self, sp: int) -> None:
        atom = self.atoms.get(self.txtptr)
        if atom and atom[1] in self.simple and self.ram[atom[0]] == EQUAL:
            self.forpnt = self.varpnt = target = self.simple[atom[1]]
            of_integer = of_string = self.subflg = 0
            self.txtptr = atom[0] + 1
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

    def for_(self) -> None:
        """FOR: push a loop. Like the ROM, continue with whatever follows the statement."""
        self.subflg = SUBFLG_SIMPLE
        self.let(self.sp - 4)
        n, sp = self._find_loop()
        if n >= 0:
            self.set_stack(sp + FOR_SIZE & 0xFF)
        fault_if(self.sp - 2 & 0xFF < FOR_ROOM - 2, "OUT OF MEMORY", self.sp - 2)
        sp, start = self.sp, self.txtptr
        self.data_()
        back, self.txtptr = self.txtptr, start
        self.expect(TO, sp - 6)
        fault_if(self.valtyp, "TYPE MISMATCH", sp - 6)
        limit = rounded(self.number(sp - 6))
        step = ONE
        if self.character() == STEP:
            self.txtptr += 1
            step = rounded(self.number(sp - 11))
        self.fac = step
        sign = (-1 if step[2] else 1) if step[0] else 0
        self.sp = sp - FOR_SIZE & 0xFF
        self.frames.append(Frame(self.sp, self.forpnt, self.curlin, back, limit, step, sign))

    def next_(self) -> None:
        """NEXT: increment the variable and repeat the loop or end it. Raises NEXT WITHOUT FOR."""
        frames = self.frames
        if self.at_end():
            self.forpnt &= 0xFF
        else:
            self.forpnt = self.variable(self.sp - 4)
        while True:
            frame = frames[-1] if frames else None
            if frame is None or frame.sp != self.sp or frame.variable != self.forpnt:
                n, sp = self._find_loop()
                fault_if(n < 0, "NEXT WITHOUT FOR", self.sp - 2)
                self.set_stack(sp)
                frame = frames[-1]
            _, variable, line, text, limit, step, sign = frame
            self.assign(variable, add(self.value(variable), step))
            if compare(limit, self.fac) != sign:
                self.curlin, self.txtptr = line, text
                return
            frames.pop()
            self.sp = self.sp + FOR_SIZE & 0xFF
            if self.character() != COMMA:
                return
            self.txtptr += 1
            self.forpnt = self.variable(self.sp - 4)

    def goto_(self, sp: int = 0) -> None:
        """GOTO: continue at a line. Raises SYNTAX and UNDEF'D STATEMENT."""
        start = self.txtptr
        target = self.targets.get(start)
        if target is None:
            sp = sp or self.sp - 2
            number = self.line_number(sp - 2)
            self.rem_()
            search_start = self.txtptr + 1 if number >> 8 > self.curlin >> 8 else self.txttab
            exists, address = self.find_line(number, search_start)
            fault_if(not exists, "UNDEF'D STATEMENT", sp)
            target = address - 1
            if self.txttab <= start < self.prgend:
                self.targets[start] = target
        self.txtptr = target
        self.charac = 0

    def gosub_(self) -> None:
        if self.sp - 4 & 0xFF < GOSUB_ROOM - 4:
            raise Fault("OUT OF MEMORY", self.sp - 4)
        frame = Frame(self.sp - GOSUB_SIZE & 0xFF, NO_VARIABLE, self.curlin, self.txtptr)
        self.goto_(self.sp - GOSUB_SIZE - 2)
        self.frames.append(frame)
        self.sp = frame.sp

    def return_(self) -> None:
        frame = self.pop_()
        self.curlin, self.txtptr = frame.line, frame.text
        self.data_()

    def pop_(self) -> Frame:
        """POP: remove the innermost GOSUB and return its frame.

        Loops inside it are dropped: the ROM searches for a loop whose variable is at $xxFF, xx
        being left from the last assignment, and fails if there is one."""
        self.forpnt |= 0xFF
        n, sp = self._find_loop()
        if n < 0 or sp != self.sp:
            self.set_stack(sp)
        fault_if(n >= 0 or not self.frames or self.frames[-1].sp != sp, "RETURN WITHOUT GOSUB", sp)
        frame = self.frames.pop()
        self.sp = self.sp + GOSUB_SIZE & 0xFF
        return frame

    def on_(self) -> None:
        sp = self.sp - 2
        count = self.byte(sp - 2)
        command = self.character()
        fault_if(command not in (GOTO, GOSUB), "SYNTAX", sp - 1)
        while True:
            self.txtptr += 1
            count -= 1
            if not count:
                self.character()
                return self.goto_() if command == GOTO else self.gosub_()
            self.line_number(sp - 3)
            if self.character() != COMMA:
                return

    def if_(self) -> None:
        """IF: for a string the condition is the number in the accumulator, as in the ROM."""
        sp = self.sp - 2
        fac = self.formula(sp - 2)
        if self.ram[self.txtptr] != THEN and self.character() == GOTO:
            byte = GOTO
        else:
            byte = self.expect(THEN, sp - 2)
        if not fac[0]:
            self.rem_()
        elif byte in DIGITS:
            self.goto_()
        else:
            self.execute()

    def onerr_(self) -> None:
        self.expect(GOTO, self.sp - 4)
        self.txtpsv = self.txtptr
        self.errflg = 0x80 | self.errflg >> 1
        self.cursv = self.curlin
        self.rem_()

    def resume_(self) -> None:
        """RESUME: continue at the error, or, as in the ROM, at address 0 if there was none."""
        self.curlin, self.txtptr = self.errlin, self.errpos
        self.forget_error()

    def forget_error(self) -> None:
        """CALL -3288: restore the stack pointer of before the error."""
        self.set_stack(self.errstk)

    def run_(self) -> None:
        """RUN: to mark a running program the ROM subtracts 256 from the line number, also in a
        program that already runs."""
        self.curlin = self.curlin - 0x100 & 0xFFFF
        if self.at_end():
            self.set_pointers()
        else:
            self.clear_()
            self.goto_()

    def end_(self, message: bytes = b"") -> None:
        """END, or STOP with a message: end the program; CONT continues here, unless at the
        prompt."""
        if self.curlin < DIRECT:
            self.oldtext, self.oldlin = self.txtptr, self.curlin
        if message:
            self.message(message)
        raise Restart

    def stop_(self) -> None:
        self.end_(BREAK)

    def break_(self) -> None:
        """Control-C: an error under ONERR, otherwise like STOP."""
        fault_if(self.errflg & 0x80, "SYNTAX", self.sp - 4, BREAK_CODE)
        self.broken = True
        self.end_(BREAK)

    def message(self, text: bytes) -> None:
        """Show a message, and the line number in a program."""
        self.show_message(text)
        if self.curlin < DIRECT:
            self.show_message(IN)
            self.show_number(integer(self.curlin))

    def cont_(self) -> None:
        fault_if(not self.oldtext >> 8, "CAN'T CONTINUE", self.sp - 2)
        self.txtptr, self.curlin = self.oldtext, self.oldlin

    def load(self, lines: Iterable[tuple[int, bytes]]) -> None:
        """Replace the program by lines, in their order. Raises OUT OF MEMORY without changing
        anything."""
        image = b"".join(_line_bytes(*line) for line in lines) + END_MARK
        fault_if(self.txttab + len(image) >= self.memsiz, "OUT OF MEMORY", self.sp)
        self.ram[self.txttab : self.txttab + len(image)] = image
        self.vartab = self.txttab + len(image)
        self.fix_links()

    def store_line(self, number: int, tokens: bytes) -> None:
        """Insert or replace a line typed with a number, or delete it if it has no tokens."""
        ram = self.ram
        self.vartab = self.prgend
        exists, line = self.find_line(number, self.txttab)
        if exists:
            self._close(line, self.word(line))
        if tokens:
            size = HEADER + len(tokens) + 1
            self.fretop = self.memsiz
            self.arytab = self.strend = self.vartab
            fault_if(self.vartab + size >= self.fretop, "OUT OF MEMORY", self.sp)
            ram[line + size : self.vartab + size] = ram[line : self.vartab]
            self.vartab += size
            ram[line : line + size] = _line_bytes(number, tokens)
        self.fix_links()

    def _close(self, start: int, end: int) -> None:
        """Delete the program's bytes from ``start`` to ``end``."""
        if start <= end <= self.vartab:
            self.ram[start : start + self.vartab - end] = self.ram[end : self.vartab]
            self.vartab -= end - start

    def fix_links(self) -> None:
        """FIX_LINKS: set the address of the next line in each line, and clear the variables."""
        self.text_changed()
        self.set_pointers()
        ram, address = self.ram, self.txttab
        while ram[address + 1] and address < ROM:
            following = following_line(ram, address)
            if following <= address:  # the ROM never comes back
                break
            self.put_word(address, following)
            address = following
        self.prgend = self.vartab

    def new_(self) -> None:
        """NEW: clear the program. If a program does it, it ends, and CONT continues there."""
        self.lock = 0
        self.ram[self.txttab : self.txttab + 2] = END_MARK
        # the ROM adds with the carry set, which makes one byte more than the program takes
        self.vartab = self.prgend = self.txttab + 3
        self.text_changed()
        self.set_pointers()

    def del_(self) -> None:
        """DEL: delete lines and end the program, unless the range is in reverse order."""
        sp = self.sp - 2
        fault_if(self.character() not in DIGITS, "SYNTAX", sp)
        self.vartab = self.prgend
        _, start = self.find_line(self.line_number(sp - 2), self.txttab)
        self.expect(COMMA, sp - 2)
        last = self.line_number(sp - 2)
        _, end = self.find_line(last + 1 & 0xFFFF, self.txttab)
        if end < start:
            self.variables_changed()
            return
        self._close(start, end)
        self.fix_links()
        raise Restart


def _line_bytes(number: int, tokens: bytes) -> bytes:
    """Return a line as stored in memory, its link not yet set."""
    return b"\1\1" + number.to_bytes(2, "little") + tokens + b"\0"
