"""The machine that runs compiled steps: memory, screen, control stack, errors.

A program is a row of functions, its steps; each takes its own place and returns the next one's
(`linking`). Steps find the machine by the names in `vocabulary`.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from ..applesoft import decimaltext, functions
from ..applesoft.console import Device, Keyboard
from ..applesoft.errorcodes import ApplesoftError
from ..applesoft.real import Number, rounded
from . import memory
from .accumulator import AFTER_TYPING
from .control import GOSUB_SIZE, Elsewhere
from .flowcompiler import TOO_LARGE
from .hardware import Hardware
from .inputs import InputBreak
from .linking import DIRECT, Halt, ProgramGone, Steps
from .operand import ROOM
from .programtext import START
from .strings import Descriptor
from .vocabulary import names

CHUNK = 512
"""Steps between two moments when the outside world is asked."""
BREAK_CODE = 255
RETURN_ADDRESS = 2
REFUSALS = 8
MORE_REFUSED = "more of the kind"
"""Statements that are not done are remembered up to a number."""
BELL = "\a"
FORGET_ERROR, CLEAR = 0xF328, 0xD66C
"""Routines of Applesoft that a program may CALL."""


class TooManyStatements(Exception):
    """The program has done as many statements as it was allowed."""


def _exponent_sign(match: re.Match[str]) -> str:
    """VAL takes the tokens of + and - for the signs, behind an E."""
    return match[1] + ("+" if match[0][-1] == "\xc8" else "-")


class Machine(Hardware):
    """An Apple II Plus with 48K as far as a BASIC program can tell.

    ``after_line(number)`` is called each time the program leaves a line; ``statements_left`` limits
    what it may do; ``refused`` collects the statements that were asked for and are not done here;
    ``broken`` tells whether control-C ended the last program, ``last_line`` where it ended.
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
        self.broken = False
        self.last_line = 0
        self._continue: int | None = None
        self._continued_line = 0
        self._within_statement = False
        self._entered: int | None = None
        self._shown_line: int | None = None
        self._current = 0
        self._names: dict[str, Any] = {}
        self.code = Steps(self.program, self.control, self._names)
        self._names.update(names(self), **self._methods())
        self.changed()

    def changed(self) -> None:
        """The program was changed: variables are gone, and it cannot be continued. Nor resumed: the
        ROM would go on at the address where the error was, whatever stands there by then."""
        self.code.changed()
        self.errors.resume = None
        self.variables.put_start(self.program.end)
        self.clear()

    def _methods(self) -> dict[str, Any]:
        """The names that steps use for what is done here."""
        return {
            "first": self.code.first,
            "after": self.code.after,
            "start": self.code.start,
            "base": self.code.base,
            "enter": self.enter,
            "reenter": self.reenter,
            "return_": self.return_,
            "VAL": self.value,
            "junkcmp": self.compare_junk,
            "gosub": self.gosub,
            "onerr": self.onerr,
            "resume": self.resume,
            "run": self.run,
            "rerun": self.clear,
            "clear": self.clear,
            "end": self.end,
            "stop": self.stop,
            "cont": self.cont,
            "new": self.new,
            "delete": self.delete,
            "trace": self.trace,
            "list_": self.list_program,
            "call": self.call_function,
            "RND": self.random,
            "look": self.look,
            "POKE": self.poke,
            "CALL": self.call,
            "refuse": self.refuse,
            "speed": self.speed,
            "color": lambda n: self.set_byte(memory.COLOR, (n & 15) * 17),
            "hcolor": self.hcolor,
            "rot": lambda n: self.set_byte(memory.ROTATION, n),
            "scale": lambda n: self.set_byte(memory.SCALE, n),
            "himem": self.himem,
            "lomem": self.lomem,
        }

    # --- running ------------------------------------------------------------------------------

    def execute(self, tokens: bytes, typed: bytes = b"") -> None:
        """Do a line typed without a number, and whatever it starts, until the machine is back at
        the prompt; ``error`` then holds the Applesoft error that ended it, or None.

        ``typed``: the line before it was made tokens. Raises TooManyStatements and
        `console.EndOfInput`.
        """
        self.error = None
        self.broken = False
        self._entered = self._shown_line = None
        pc = self.code.put_direct(typed, tokens)
        self.control.watch(self.code.leftovers or self.errors.on)
        self.accumulator.number = AFTER_TYPING
        self.variables.grow()
        self._go(pc)

    @property
    def _slow(self) -> bool:
        """Whether each step has to be watched."""
        return bool(
            self.control.careful
            or self.tracing
            or self.after_line
            or self._entered is not None
            or self._shown_line is not None
        )

    def _go(self, pc: int) -> None:
        steps = self.code.steps
        while pc >= 0:
            try:
                while self._slow:
                    pc = self._step(pc)
                while True:
                    count = 0
                    try:
                        for count in range(1, self._chunk() + 1):  # noqa: B007
                            pc = steps[pc](pc)
                    finally:
                        if self.statements_left is not None:
                            self.statements_left -= count
                    if self.interrupted:
                        raise KeyboardInterrupt
            except Elsewhere as elsewhere:
                pc = elsewhere.pc
            except ProgramGone:
                return
            except Halt:
                self._halted(pc)
                return
            except KeyboardInterrupt as interrupt:
                self.interrupted = False
                pc = self._break(pc, in_input=isinstance(interrupt, InputBreak))
            except RecursionError:
                pc = self._handle(ApplesoftError("OUT OF MEMORY"), pc)
            except ApplesoftError as error:
                pc = self._handle(error, pc)

    def _chunk(self) -> int:
        """How many steps to do before looking round. Raises TooManyStatements."""
        if self.statements_left is None:
            return CHUNK
        if self.statements_left <= 0:
            raise TooManyStatements
        return min(CHUNK, self.statements_left)

    def _step(self, pc: int) -> int:
        """One step, with everything that may be asked of it."""
        if self.interrupted:
            raise KeyboardInterrupt
        if self.statements_left is not None:
            if self.statements_left <= 0:
                raise TooManyStatements
            self.statements_left -= 1
        code = self.code
        line = code.lines[pc]
        direct = line >= DIRECT
        if self.tracing and code.traced[pc] and not direct:
            self.output.put(f"#{self.line_of(pc)} ")
        steps = code.careful() if self.control.careful else code.steps
        self.control.formula_depth = 0
        entered = self._entered
        following = pc
        try:
            following = steps[pc](pc)
        except Elsewhere as elsewhere:
            following = elsewhere.pc
        if entered == self._entered:
            self._entered = None
        if code.lines[following] != line or code.first.get(line) == following:
            self._shown_line = None
        if self.after_line and not direct and code.lines[following] != line:
            self.after_line(line)
        return following

    def line_of(self, pc: int) -> int:
        """The line number the machine believes it is in: another line's after RESUME from an error
        in DATA, and after CONT from a line typed without a number."""
        return self.code.lines[pc] if self._shown_line is None else self._shown_line

    def _halted(self, pc: int) -> None:
        line = self.code.lines[pc]
        if line < DIRECT:
            self.last_line = line
            if pc == self.code.end:
                self._can_continue(pc, pc)
            if self.after_line and len(self.program):
                self.after_line(line)

    def _can_continue(self, pc: int, place: int) -> None:
        """END, STOP or control-C at pc: CONT goes to ``place``."""
        self._continue = place
        self._continued_line = self.line_of(pc)
        self._within_statement = False
        self.statement = self.code.place(place)

    def _handle(self, error: ApplesoftError, pc: int) -> int:
        """An error: to ONERR's line, or to the prompt (-1) with a message."""
        depth, self.control.depth = self.control.depth + self.control.formula_depth, 0
        actual = self.code.lines[pc]
        line = self.line_of(pc) if error.line is None else error.line
        if self.errors.on:
            return self._to_handler(error, line, pc, depth)
        if actual < DIRECT:
            self.last_line = line
            if self.after_line:
                self.after_line(actual)
        error.line = line if line < DIRECT else None
        self.error = error
        place = "" if error.line is None else f" IN {error.line}"
        self.output.put(f"\n?{error.kind} ERROR{BELL}{place}")
        self.forget()
        return -1

    def forget(self) -> None:
        """What every error does: the stack and the temporaries are gone, and CONT is refused."""
        self.control.clear()
        self.variables.strings.temporaries.clear()
        self._continue = None

    def _to_handler(self, error: ApplesoftError, line: int, pc: int, depth: int) -> int:
        errors = self.errors
        errors.catch(error.code, line, self.code.start[pc], len(self.control.frames))
        self.control.leave(error.kind, depth)
        self._shown_line = None
        try:
            return self.code.first[errors.handler]  # type: ignore[index]
        except ApplesoftError as undefined:
            # the ROM would come back here for ever
            errors.flag = 0
            undefined.line = errors.handler_line
            return self._handle(undefined, pc)

    def _break(self, pc: int, *, in_input: bool) -> int:
        """Control-C."""
        errors = self.errors
        start = self.code.start[pc]
        if errors.on:
            errors.catch(BREAK_CODE, self.line_of(pc), start, len(self.control.frames))
            self.control.leave("", 0)
            return self.code.first.get(errors.handler or 0, -1)
        self._say_break(pc)
        self.broken = True
        if not self.code.is_direct(pc):
            self.last_line = self.line_of(pc)
            self._can_continue(pc, start)
            self._within_statement = in_input
        return -1

    def _say_break(self, pc: int) -> None:
        place = "" if self.code.is_direct(pc) else f" IN {self.line_of(pc)}"
        self.output.put(f"\nBREAK{BELL}{place}")

    # --- statements: what comes next ----------------------------------------------------------

    def enter(self, pc: int) -> int:
        """GOTO typed without a line number: the first statement is done before the ROM notes that
        a program runs."""
        self._entered = pc
        raise Elsewhere(pc)

    def reenter(self, pc: int) -> int:
        """INPUT again after ?REENTER, from where the ROM noted last that a statement begins."""
        start = self.code.start[pc]
        if self._entered != start:
            return start
        if self._continue is None:
            raise ApplesoftError("SYNTAX")
        return self._continue

    def gosub(self, pc: int, number: int) -> int:
        """GOSUB. Raises OUT OF MEMORY and UNDEF'D STATEMENT."""
        self.control.enter(GOSUB_SIZE + RETURN_ADDRESS)
        first = self.code.first[number]
        self.control.enter(0)
        self.control.push_gosub(pc + 1)
        if self.code.is_direct(pc):
            self._entered = first
            raise Elsewhere(first)
        return self.control.settle(first)

    def return_(self, pc: int) -> int:
        """RETURN. Raises RETURN WITHOUT GOSUB."""
        back = self.control.return_()
        if self.code.is_direct(back) and self._entered != pc and not self.code.is_direct(pc):
            self._continue = self.code.start[pc]
            self._within_statement = False
        return back

    def onerr(self, pc: int, number: int | None) -> None:
        """ONERR GOTO."""
        self.errors.arm(number, self.code.lines[pc])
        if self.control.watch(True):
            raise Elsewhere(pc + 1)

    def resume(self) -> int:
        """RESUME. Where there was no error the ROM runs wild, from address 0."""
        errors = self.errors
        if errors.resume is None:
            raise ApplesoftError("SYNTAX", errors.line)
        self.forget_error()
        if errors.line not in (self.code.lines[errors.resume], self._shown_line):
            self._shown_line = errors.line
            raise Elsewhere(errors.resume)
        return errors.resume

    def forget_error(self) -> None:
        """CALL -3288: the stack as it was before the error."""
        self.control.cut(self.errors.frames)

    def run(self, number: int | None, pc: int = 0) -> int:
        """RUN. Raises UNDEF'D STATEMENT."""
        self.clear()
        if number is None:
            return 0
        try:
            return self.code.first[number if number != TOO_LARGE else None]  # type: ignore[index]
        except ApplesoftError as error:
            # to say that a program runs now the machine takes 256 from the line number, also from
            # that of a line that runs already
            line = DIRECT | self.last_line & 0xFF if self.code.is_direct(pc) else self.line_of(pc)
            error.line = line - 0x100 & 0xFFFF
            raise

    def clear(self) -> None:
        """CLEAR: no variables, no loops, DATA from the beginning; nothing to continue."""
        self.variables.clear()
        self.inputs.restore()
        self.control.clear()
        self._continue = None

    def end(self, pc: int) -> None:
        """END."""
        if not self.code.is_direct(pc):
            self.last_line = self.line_of(pc)
            self._can_continue(pc, pc + 1)
        raise Halt

    def stop(self, pc: int) -> None:
        """STOP."""
        self._say_break(pc)
        self.end(pc)

    def cont(self, pc: int) -> int:
        """CONT. Raises CAN'T CONTINUE."""
        if not self.code.is_direct(pc):
            return self.code.start[pc]  # it continues with itself, for ever
        if self._continue is None:
            raise ApplesoftError("CAN'T CONTINUE")
        if self._within_statement:
            raise ApplesoftError("SYNTAX", self._continued_line)
        if self._continued_line != self.code.lines[self._continue]:
            self._shown_line = self._continued_line
            raise Elsewhere(self._continue)
        return self._continue

    def new(self, pc: int) -> None:
        """NEW. A program that does it comes to its end, from where CONT can go on."""
        direct = self.code.is_direct(pc)
        self.program.clear()
        self.program.spare = 1
        self.changed()
        if not direct:
            self.code.put_direct(b"", b"")
            self._can_continue(self.code.end, self.code.end)
        raise ProgramGone

    def delete(self, first: int, last: int) -> None:
        """DEL. The program ends, unless there was nothing to do."""
        if self.program.delete(first, last):
            self.changed()
            raise ProgramGone

    @property
    def locked(self) -> bool:
        """Whether every line typed means RUN (POKE 214,128)."""
        return self.ram[memory.LOCK] >= 0x80

    def trace(self, pc: int, on: bool) -> None:
        """TRACE and NOTRACE."""
        self.trace_flag = self.trace_flag >> 1 | (0x80 if on else 0)
        if on != self.tracing:
            self.tracing = on
            raise Elsewhere(pc + 1)

    def list_program(self, first: int, last: int) -> None:
        """LIST."""
        program = self.program
        lines = ((n, program.tokens[n]) for n in program.between(first, 0xFFFF))
        self.output.list_lines(lines, last, self._check_break)

    def _check_break(self) -> None:
        if self.interrupted:
            raise KeyboardInterrupt

    # --- functions and memory -----------------------------------------------------------------

    def call_function(self, slot: int, argument: Number, depth: int) -> Number:
        """FN, ``depth`` bytes down the stack. Raises UNDEF'D FUNCTION and OUT OF MEMORY, and leaves
        the argument as it is then."""
        values, control = self.variables.values, self.control
        function = values[slot]
        if function is None:
            raise ApplesoftError("UNDEF'D FUNCTION")
        control.depth += depth
        saved = values[function.argument]
        values[function.argument] = rounded(argument)
        if control.pointer - control.depth - function.need < ROOM:
            raise ApplesoftError("OUT OF MEMORY")
        result: Number = function.body()
        values[function.argument] = saved
        control.depth -= depth
        return result

    def value(self, string: Descriptor) -> Number:
        """VAL: the number the text begins with, zero if it begins with none. A zero byte ends it.

        Raises OVERFLOW, and leaves behind the text the zero that the ROM puts there to end it.
        """
        text = self.variables.strings.used(string).partition("\0")[0]
        try:
            return decimaltext.read(re.sub("(?<=E)( *)[\xc8\xc9]", _exponent_sign, text), 0)[0]
        except ApplesoftError:
            self.write(string.address + string.length & 0xFFFF, 0)
            raise

    def compare_junk(self, number: Number, string: Descriptor) -> int:
        """A comparison that takes a number for a string, its mantissa's bytes for an address."""
        place = (number[1] >> 8 & 0xFF) << 8 | number[1] >> 16 & 0xFF
        length, low, high = (memory.peek(self, place + n & 0xFFFF) for n in range(3))
        address = low + 256 * high
        text = "".join(chr(memory.peek(self, address + n & 0xFFFF)) for n in range(length))
        other = self.variables.strings.used(string)
        return (text > other) - (text < other)

    def random(self, x: Number) -> Number:
        """RND."""
        self.seed = functions.random(x, self.seed)
        return self.seed

    def look(self, pc: int) -> None:
        """Where the program is, before a step that may ask."""
        self._current = pc
        self.line = self.line_of(pc)
        if not self.code.is_direct(pc):
            self.statement = self.code.place(self.code.start[pc])

    def poke(self, place: int, n: int) -> None:
        """POKE."""
        if self.write(place, n):
            raise Elsewhere(self.code.relink(self._current) + 1)

    def write(self, place: int, n: int) -> bool:
        """Put a byte at an address; whether that changed the program."""
        if not START <= place < self.program.end:
            memory.poke(self, place, n)
            return False
        if not self.program.poke(place, n):
            return False
        self.code.changed()
        return True

    def call(self, place: int) -> None:
        """CALL."""
        if place == FORGET_ERROR:
            self.forget_error()
        elif place == CLEAR:
            self.clear()
        elif not memory.call(self, place):
            self.refuse(f"CALL {place}")

    def refuse(self, what: str) -> None:
        """A statement that is not done here is a SYNTAX error, and remembered."""
        if what not in self.refused and len(self.refused) <= REFUSALS:
            self.refused.append(what if len(self.refused) < REFUSALS else MORE_REFUSED)
        raise ApplesoftError("SYNTAX")

    def speed(self, n: int) -> None:
        """SPEED=, kept for PEEK; output is always at full speed."""
        self.ram[memory.SPEED] = -n & 0xFF

    def set_byte(self, place: int, n: int) -> None:
        """COLOR=, ROT= and SCALE=: a byte for drawing, which is not done here, and for PEEK."""
        self.ram[place] = n

    def hcolor(self, n: int) -> None:
        """HCOLOR=. Raises ILLEGAL QUANTITY past 7."""
        if n >= len(memory.HIGH_COLORS):
            raise ApplesoftError("ILLEGAL QUANTITY")
        self.set_byte(memory.HIGH_COLOR, memory.HIGH_COLORS[n])

    def himem(self, place: int) -> None:
        """HIMEM:. Raises OUT OF MEMORY below the arrays."""
        if place < self.variables.end_of_arrays():
            raise ApplesoftError("OUT OF MEMORY")
        self.variables.strings.put_top(place)

    def lomem(self, place: int) -> None:
        """LOMEM:, which clears all variables. Raises OUT OF MEMORY outside the free room."""
        if not self.variables.start <= place < self.variables.strings.top:
            raise ApplesoftError("OUT OF MEMORY")
        self.variables.put_start(place)
        self.clear()
