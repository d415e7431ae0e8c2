"""The machine that runs compiled steps: memory, screen, control stack, errors.

A program is a row of functions, its steps; each takes its own place and returns the next one's
(`linking`). Steps find the machine by the names in `vocabulary`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..applesoft import functions
from ..applesoft.console import Device, Keyboard
from ..applesoft.errors import ApplesoftError
from ..applesoft.real import Number, rounded
from . import memory
from .control import Elsewhere
from .hardware import Hardware
from .linking import DIRECT, Halt, Steps
from .operand import ROOM
from .programtext import START
from .vocabulary import names

CHUNK = 512
"""Steps between two looks at the outside world."""
BREAK_CODE = 255
BELL = "\a"
FASTEST = 255
FORGET_ERROR, CLEAR = 0xF328, 0xD66C
"""Routines of Applesoft that a program may CALL."""
_RUN_LINES = range(0xFE00, 0xFF00)
"""What RUN of a missing line makes of the line number at the prompt."""


class TooManyStatements(Exception):
    """The program has done as many statements as it was allowed."""


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
        self._continue: int | None = None
        self._here = 0
        self.last_line = 0
        self._names: dict[str, Any] = {}
        self.code = Steps(self.program, self.control, self._names)
        self._names.update(names(self), **self._methods())
        self.changed()

    def changed(self) -> None:
        """The program was changed: variables are gone, and it cannot be continued."""
        self.code.changed()
        self.variables.put_start(self.program.end)
        self.clear()

    def _methods(self) -> dict[str, Any]:
        """The names that steps use for what is done here."""
        return {
            "first": self.code.first,
            "after": self.code.after,
            "start": self.code.start,
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
            "here": self.look_here,
            "POKE": self.poke,
            "CALL": self.call,
            "refuse": self.refuse,
            "speed": self.speed,
            "himem": self.himem,
            "lomem": self.lomem,
        }

    # --- running ------------------------------------------------------------------------------

    def execute(self, tokens: bytes) -> None:
        """Do a line typed without a number, and whatever it starts, until the machine is back at
        the prompt; ``error`` then holds the Applesoft error that ended it, or None.

        Raises TooManyStatements and `console.EndOfInput`.
        """
        self.error = None
        self.broken = False
        pc = self.code.put_direct(tokens)
        self.variables.grow()
        self._go(pc)

    def _go(self, pc: int) -> None:
        steps = self.code.steps
        while pc >= 0:
            try:
                while self.control.careful or self.tracing or self.after_line:
                    pc = self._step(pc)
                while True:
                    done = 0
                    try:
                        for done in range(1, self._chunk() + 1):  # noqa: B007
                            pc = steps[pc](pc)
                    finally:
                        if self.statements_left is not None:
                            self.statements_left -= done
                    if self.interrupted:
                        raise KeyboardInterrupt
            except Elsewhere as elsewhere:
                pc = elsewhere.pc
            except Halt:
                self._halted(pc)
                return
            except KeyboardInterrupt:
                self.interrupted = False
                pc = self._break(pc)
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
        if self.tracing and code.begins[pc] and not direct:
            self.output.put(f"#{line} ")
        steps = code.careful() if self.control.careful and not direct else code.steps
        to = pc
        try:
            to = steps[pc](pc)
        except Elsewhere as elsewhere:
            to = elsewhere.pc
        if self.after_line and not direct and code.lines[to] != line:
            self.after_line(line)
        return to

    def _halted(self, pc: int) -> None:
        line = self.code.lines[pc]
        if line < DIRECT:
            self.last_line = line
            if pc == self.code.end:
                self._continue = pc
            if self.after_line and len(self.program):
                self.after_line(line)

    def _handle(self, error: ApplesoftError, pc: int) -> int:
        """An error: to ONERR's line, or to the prompt (-1) with a message."""
        self.control.depth = 0
        here = self.code.lines[pc]
        line = here if error.line is None else error.line
        if self.errors.on:
            return self._to_handler(error, line, pc)
        if here < DIRECT:
            self.last_line = here
            if self.after_line:
                self.after_line(here)
        error.line = line if line < DIRECT else None
        self.error = error
        place = "" if error.line is None else f" IN {error.line}"
        self.output.put(f"\n?{error.kind} ERROR{BELL}{place}")
        self.control.clear()
        self._continue = None
        return -1

    def _to_handler(self, error: ApplesoftError, line: int, pc: int) -> int:
        errors = self.errors
        errors.catch(error.code, line, self.code.start[pc], len(self.control.frames))
        self.control.leave(error.kind)
        try:
            return self.code.first[errors.handler]  # type: ignore[index]
        except ApplesoftError as undefined:
            # the ROM would come back here for ever
            errors.flag = 0
            undefined.line = errors.handler_line
            return self._handle(undefined, pc)

    def _break(self, pc: int) -> int:
        """Control-C."""
        errors = self.errors
        start = self.code.start[pc]
        if errors.on:
            errors.catch(BREAK_CODE, self.code.lines[pc], start, len(self.control.frames))
            self.control.leave("")
            return self.code.first.get(errors.handler or 0, -1)
        self._say_break(pc)
        self.broken = True
        if not self.code.is_direct(pc):
            self._continue = start
        return -1

    def _say_break(self, pc: int) -> None:
        place = "" if self.code.is_direct(pc) else f" IN {self.code.lines[pc]}"
        self.output.put(f"\nBREAK{BELL}{place}")

    # --- statements: what comes next ----------------------------------------------------------

    def gosub(self, pc: int, number: int) -> int:
        """GOSUB. Raises OUT OF MEMORY and UNDEF'D STATEMENT."""
        self.control.push_gosub(pc + 1)
        return self.control.settle(self.code.first[number])

    def onerr(self, pc: int, number: int | None) -> None:
        """ONERR GOTO."""
        self.errors.arm(number, self.code.lines[pc])

    def resume(self) -> int:
        """RESUME. Where there was no error the ROM runs wild; here it is a SYNTAX error."""
        if self.errors.resume is None:
            raise ApplesoftError("SYNTAX")
        self.forget_error()
        return self.errors.resume

    def forget_error(self) -> None:
        """CALL -3288: the stack as it was before the error."""
        self.control.cut(self.errors.frames)

    def run(self, number: int | None) -> int:
        """RUN. Raises UNDEF'D STATEMENT."""
        self.clear()
        if number is None:
            return 0
        try:
            return self.code.first[number]
        except ApplesoftError as error:
            # the machine has taken 256 from the line number, whatever it was
            error.line = _RUN_LINES.start | self.last_line & 0xFF
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
            self._continue = pc + 1
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
        return self._continue

    def new(self) -> None:
        """NEW."""
        self.program.clear()
        self.program.spare = 1
        self.changed()
        raise Halt

    def delete(self, first: int, last: int) -> None:
        """DEL. The program ends, unless there was nothing to do."""
        if self.program.delete(first, last):
            self.changed()
            raise Halt

    def trace(self, pc: int, on: bool) -> None:
        """TRACE and NOTRACE."""
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

    def call_function(self, slot: int, argument: Number, at: int) -> Number:
        """FN, ``at`` bytes down the stack. Raises UNDEF'D FUNCTION and OUT OF MEMORY."""
        values, control = self.variables.values, self.control
        function = values[slot]
        if function is None:
            self.variables.place(slot)
            raise ApplesoftError("UNDEF'D FUNCTION")
        control.depth += at
        if control.pointer - control.depth - function.need < ROOM:
            raise ApplesoftError("OUT OF MEMORY")
        saved = values[function.argument]
        values[function.argument] = rounded(argument)
        result: Number = function.body()
        values[function.argument] = saved
        control.depth -= at
        return result

    def random(self, x: Number) -> Number:
        """RND."""
        self.seed = functions.random(x, self.seed)
        return self.seed

    def look_here(self, pc: int) -> None:
        """Where the program is, before a step that may ask."""
        self._here = pc
        self.line = self.code.lines[pc]

    def poke(self, place: int, n: int) -> None:
        """POKE. In the program's text tokens may be changed, its structure not."""
        if not START <= place < self.program.end:
            memory.poke(self, place, n)
            return
        for number in self.program.numbers:
            offset = place - self.program.address_of(number) - 4
            tokens = self.program.tokens[number]
            if 0 <= offset < len(tokens) and n:
                self.program.store(number, tokens[:offset] + bytes((n,)) + tokens[offset + 1 :])
                pc = self.code.relink(self._here)
                self.variables.grow()
                raise Elsewhere(pc + 1)

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
        if what not in self.refused:
            self.refused.append(what)
        raise ApplesoftError("SYNTAX")

    def speed(self, n: int) -> None:
        """SPEED=, kept for PEEK; output is always at full speed."""
        self.ram[memory.SPEED] = -n & FASTEST

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
