"""What comes next: GOTO, FOR and NEXT, ONERR, END and CONT; the program's lines, NEW and DEL.

FOR and GOSUB put 18 and 7 bytes on the 6502's stack, and are found only from the stack pointer on,
frame upon frame: what an error that ONERR caught left there hides all below it. In memory a line is
the address of the next one, its number, its tokens and a zero; an address of 0 ends the program.
LIST and GOTO follow the addresses; a running program goes on with the bytes behind a line's zero.
"""

from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

from ..applesoft.real import ZERO, Number, add, compare, integer, rounded
from .expressions import ONE
from .faults import Fault, Restart
from .inputoutput import BREAK_CODE, InputOutput
from .memory import ADDRESSES, DIGITS, DIRECT, GOTO, HEADER, ROM, STACK, SUBFLG_SIMPLE, TEMPORARIES
from .tokens import COMMA, TOKENS
from .variables import store

FOR_SIZE, FOR_ROOM, GOSUB_SIZE, GOSUB_ROOM, NO_VARIABLE = 18, 74, 7, 64, -1
"""Bytes on the stack, and where the stack pointer has to be at least; a GOSUB's variable."""
TO, THEN, STEP, GOSUB, EQUAL = (TOKENS[word] for word in ("TO", "THEN", "STEP", "GOSUB", "="))


class Frame(NamedTuple):
    """A loop or, without a variable, a subroutine: the stack pointer below it, the address of the
    variable, where it goes back to; ``sign``: of the step."""

    sp: int
    variable: int
    line: int
    text: int
    limit: Number = ZERO
    step: Number = ZERO
    sign: int = 0


NO_FRAME, END_MARK, BREAK = Frame(-1, NO_VARIABLE, 0, 0), b"\0\0", b"\rBREAK"


class Flow(InputOutput):
    """The statements that say what comes next, and the program between TXTTAB and PRGEND."""

    execute: Callable[[], None]

    def set_stack(self, sp: int) -> None:
        """TXS: what lay below is gone."""
        self.sp = sp
        while self.frames and self.frames[-1].sp < sp:
            self.frames.pop()

    def clear_stack(self) -> None:
        """STKINI: nothing on the stack, no temporaries, nothing to continue."""
        self.temppt = TEMPORARIES
        self.sp = STACK
        self.frames: list[Frame] = []
        self.oldtext &= 0xFF
        self.subflg = 0

    def set_pointers(self) -> None:
        """SETPTRS: TXTPTR before the program; and CLEARC: no variables, DATA from the beginning."""
        self.txtptr = self.txttab - 1
        self.clear()

    def clear(self) -> None:
        self.fretop = self.memsiz
        self.arytab = self.strend = self.vartab
        self.simple.clear()
        self.arrays.clear()
        self.restore_()
        self.clear_stack()

    def _find_loop(self) -> tuple[int, int]:
        """GTFORPNT: the loop with FORPNT's variable, or the innermost one if FORPNT's high byte is
        0, or -1; where the stack pointer came to in looking."""
        sp, frames = self.sp, self.frames
        for n, frame in reversed(list(enumerate(frames))):
            if frame.sp != sp or frame.variable == NO_VARIABLE:
                break
            if not self.forpnt >> 8:
                self.forpnt = frame.variable
            if frame.variable == self.forpnt:
                return n, sp
            sp = sp + FOR_SIZE & 0xFF
        return -1, sp

    def let(self, sp: int) -> None:
        """LET, with its keyword or without."""
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
            e, m, s = self.fac = rounded(fac) if fac[1] & 0xFF else fac
            store(self.ram, target, e, m >> 8 & 0x7FFFFFFF | s << 31)

    def for_(self) -> None:
        """FOR. The ROM goes on with whatever stands behind it."""
        self.subflg = SUBFLG_SIMPLE
        self.let(self.sp - 4)
        n, sp = self._find_loop()
        if n >= 0:
            self.set_stack(sp + FOR_SIZE & 0xFF)
        if self.sp - 2 & 0xFF < FOR_ROOM - 2:
            raise Fault("OUT OF MEMORY", self.sp - 2)
        sp = self.sp
        start = self.txtptr
        self.data_()
        back, self.txtptr = self.txtptr, start
        self.expect(TO, sp - 6)
        if self.valtyp:
            raise Fault("TYPE MISMATCH", sp - 6)
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
        """NEXT. Raises NEXT WITHOUT FOR."""
        if self.at_end():
            self.forpnt &= 0xFF
        else:
            self.forpnt = self.variable(self.sp - 4)
        while True:
            frame = self.frames[-1] if self.frames else NO_FRAME
            if frame.sp != self.sp or frame.variable != self.forpnt:
                n, sp = self._find_loop()
                if n < 0:
                    raise Fault("NEXT WITHOUT FOR", self.sp - 2)
                self.set_stack(sp)
                frame = self.frames[-1]
            _, variable, line, text, limit, step, sign = frame
            self.assign(variable, add(self.value(variable), step))
            if compare(limit, self.fac) != sign:
                self.curlin = line
                self.txtptr = text
                return
            self.frames.pop()
            self.sp = self.sp + FOR_SIZE & 0xFF
            if self.character() != COMMA:
                return
            self.txtptr += 1
            self.forpnt = self.variable(self.sp - 4)

    def goto_(self, sp: int = 0) -> None:
        """GOTO. Raises SYNTAX and UNDEF'D STATEMENT."""
        start = self.txtptr
        target = self.targets.get(start)
        if target is None:
            sp = sp or self.sp - 2
            number = self.line_number(sp - 2)
            self.rem_()
            beyond = self.txtptr + 1 if number >> 8 > self.curlin >> 8 else self.txttab
            found, address = self.find_line(number, beyond)
            if not found:
                raise Fault("UNDEF'D STATEMENT", sp)
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
        frame = self.subroutine()
        self.curlin, self.txtptr = frame.line, frame.text
        self.data_()

    def subroutine(self) -> Frame:
        """The innermost GOSUB, which is over then. The ROM looks for a loop whose variable lies at
        $xxFF, xx being left over from the last assignment, and fails if there is one."""
        self.forpnt |= 0xFF
        n, sp = self._find_loop()
        if n < 0 or sp != self.sp:
            self.set_stack(sp)
        if n >= 0 or not self.frames or self.frames[-1].sp != sp:
            raise Fault("RETURN WITHOUT GOSUB", sp)
        frame = self.frames.pop()
        self.sp = self.sp + GOSUB_SIZE & 0xFF
        return frame

    def on_(self) -> None:
        sp = self.sp - 2
        count = self.byte(sp - 2)
        command = self.character()
        if command not in (GOTO, GOSUB):
            raise Fault("SYNTAX", sp - 1)
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
        """IF. Of a string the ROM sees the number that stands in the accumulator."""
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
        """RESUME. Where there was no error the ROM goes on at address 0."""
        self.curlin, self.txtptr = self.errlin, self.errpos
        self.forget_error()

    def forget_error(self) -> None:
        """CALL -3288: the stack as it was before the error."""
        self.set_stack(self.errstk)

    def run_(self) -> None:
        """RUN. To say that a program runs now the machine takes 256 from the line number, also
        from that of a line that runs already."""
        self.curlin = self.curlin - 0x100 & 0xFFFF
        if self.at_end():
            self.set_pointers()
        else:
            self.clear()
            self.goto_()

    def end(self, message: bytes = b"") -> None:
        """END, or STOP with a message; CONT goes on here, unless at the prompt."""
        if self.curlin < DIRECT:
            self.oldtext, self.oldlin = self.txtptr, self.curlin
        if message:
            self.message(message)
        raise Restart

    def break_(self) -> None:
        """Control-C: an error under ONERR, else as STOP."""
        if self.errflg & 0x80:
            raise Fault("SYNTAX", self.sp - 4, BREAK_CODE)
        self.broken = True
        self.end(BREAK)

    def message(self, text: bytes) -> None:
        """A text, the bell, the line if there is one."""
        self.show_message(text + b"\a")
        if self.curlin < DIRECT:
            self.show_message(b" IN ")
            self.show_number(integer(self.curlin))

    def cont(self) -> None:
        if not self.oldtext >> 8:
            raise Fault("CAN'T CONTINUE", self.sp - 2)
        self.txtptr, self.curlin = self.oldtext, self.oldlin

    def lines(self) -> Iterator[tuple[int, bytes]]:
        """Numbers and tokens, as the addresses lead."""
        ram, address = self.ram, self.txttab
        passed: set[int] = set()
        while ram[address + 1] and address not in passed and address < ROM:
            passed.add(address)
            yield self.word(address + 2), bytes(ram[address + 4 : ram.index(0, address + 4)])
            address = self.word(address)

    def load(self, lines: Iterable[tuple[int, bytes]]) -> None:
        """Put lines in place of the program. Raises OUT OF MEMORY, and changes nothing then."""
        numbered = sorted(dict(lines).items())
        image = b"".join(_linked(*line) for line in numbered if line[1]) + END_MARK
        if self.txttab + len(image) >= self.memsiz:
            raise Fault("OUT OF MEMORY", self.sp)
        self.ram[self.txttab : self.txttab + len(image)] = image
        self.vartab = self.txttab + len(image)
        self.fix_links()

    def store_line(self, number: int, tokens: bytes) -> None:
        """A line typed with a number: put in, or taken out if it has no tokens."""
        ram = self.ram
        self.vartab = self.prgend
        known, line = self.find_line(number, self.txttab)
        if known:
            self._close(line, self.word(line))
        if tokens:
            size = HEADER + len(tokens) + 1
            self.fretop = self.memsiz
            self.arytab = self.strend = self.vartab
            if self.vartab + size >= self.fretop:
                raise Fault("OUT OF MEMORY", self.sp)
            ram[line + size : self.vartab + size] = ram[line : self.vartab]
            self.vartab += size
            ram[line : line + size] = _linked(number, tokens)
        self.fix_links()

    def _close(self, start: int, end: int) -> None:
        if start <= end <= self.vartab:
            self.ram[start : start + self.vartab - end] = self.ram[end : self.vartab]
            self.vartab -= end - start

    def fix_links(self) -> None:
        """FIX_LINKS: each line the address of the next one; no variables."""
        self.text_changed()
        self.set_pointers()
        ram, address = self.ram, self.txttab
        while ram[address + 1] and address < ROM:
            following = ram.index(0, address + HEADER) + 1
            self.put_word(address, following)
            address = following
        self.prgend = self.vartab

    def new(self) -> None:
        """NEW. A program that does it comes to its end, from where CONT can go on."""
        self.lock = 0
        self.ram[self.txttab : self.txttab + 2] = END_MARK
        # the carry is set here, so that there is one byte more than the program takes
        self.vartab = self.prgend = self.txttab + 3
        self.text_changed()
        self.set_pointers()

    def del_(self) -> None:
        """DEL. The program ends, unless the range lies before its own beginning."""
        sp = self.sp - 2
        if self.character() not in DIGITS:
            raise Fault("SYNTAX", sp)
        self.vartab = self.prgend
        _, start = self.find_line(self.line_number(sp - 2), self.txttab)
        self.expect(COMMA, sp - 2)
        last = self.line_number(sp - 2)
        _, end = self.find_line(last + 1 & ADDRESSES - 1, self.txttab)
        if end < start:
            self.variables_changed()
            return
        self._close(start, end)
        self.fix_links()
        raise Restart


def _linked(number: int, tokens: bytes) -> bytes:
    """A line in memory, its link to be fixed."""
    return b"\1\1" + number.to_bytes(2, "little") + tokens + b"\0"
