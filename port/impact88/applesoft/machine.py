"""The machine that runs compiled steps: memory, screen, control stack, errors, and their names.

A program is a list of functions, its steps, one after the other; each takes its own index and
returns the next one's. Steps find the machine by the names in `Machine.names`. A line typed without
a number is compiled too and stands after the program's steps.
"""

from __future__ import annotations

from collections.abc import Callable, MutableSequence
from itertools import repeat
from typing import Any

from . import decimaltext, functions, memory
from .compiler import compiled
from .console import Console, Device, Keyboard
from .control import Control, Deeper
from .errors import ApplesoftError
from .expressions import ROOM
from .inputs import Inputs
from .lister import INDENT, WRAP_COLUMN, pieces
from .program import Program
from .real import (
    ZERO,
    absolute,
    add,
    compare,
    divide,
    floor,
    integer,
    multiply,
    negate,
    rounded,
    subtract,
)
from .screen import FLASHING, INVERSE, NORMAL, Screen
from .strings import code, value
from .variables import Function, Variables, address, byte, subscript, whole

CHUNK = 512
"""Steps between two looks at the outside world."""
DIRECT = 0xFF00
"""Line numbers from here on mean: typed without a line number."""
BREAK_CODE = 255
BELL = "\a"
FLASH_BIT = 0x40


class Halt(Exception):
    """The program ends."""


class TooManyStatements(Exception):
    """The program has done as many statements as it was allowed."""


class Targets(dict[int, int]):
    """Line number -> its first step. Raises UNDEF'D STATEMENT, and SYNTAX for no number at all."""

    def __missing__(self, number: int | None) -> int:
        raise ApplesoftError("SYNTAX" if number is None else "UNDEF'D STATEMENT")


class Errors:
    """What ONERR keeps: its flag (on from 128), the last code and line, and where to go."""

    def __init__(self) -> None:
        self.flag = 0
        self.code = 0
        self.line = 0
        self.handler: int | None = None
        self.handler_line = 0
        self.resume: int | None = None
        self.frames = 0

    @property
    def on(self) -> bool:
        """Whether an error goes to the handler."""
        return self.flag >= 0x80


class Machine:
    """An Apple II Plus with 48K as far as a BASIC program can tell.

    ``after_line(number)`` is called each time the program leaves a line; ``statements_left`` limits
    what it may do; ``refused`` collects the statements that were asked for and are not done here;
    ``broken`` tells whether control-C ended the last program.
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
        self.screen = Screen(screen, blanks=blanks)
        self.console = Console(keyboard, self.screen.write, printer, dos=dos, echo=echo)
        self.program = Program()
        self.variables = Variables()
        self.control = Control(self.variables.values, self.variables)
        self.errors = Errors()
        self.inputs = Inputs(
            self.program, self.console, self.variables.strings, lambda: self.errors.on
        )
        self.ram: dict[int, int] = {}
        self.seed = functions.FIRST_SEED
        self.flash_bit = 0
        self.tracing = False
        self.interrupted = False
        self.statements_left: int | None = None
        self.after_line: Callable[[int], object] | None = None
        self.refused: list[str] = []
        self.error: ApplesoftError | None = None
        self.broken = False
        self._continue: int | None = None
        self._here = 0
        self._line = 0
        self._linked = False
        self._steps: list[Any] = []
        self._careful: list[Any] = []
        self._direct = b""
        self._end = 0
        self._begins: list[bool] = []
        self._lines: list[int] = []
        self._first = Targets()
        self._after: list[int] = []
        self._start: list[int] = []
        self.names = self._names()
        self.changed()

    # --- the names steps use ------------------------------------------------------------------

    def _names(self) -> dict[str, Any]:
        variables, strings, control = self.variables, self.variables.strings, self.control
        return {
            # numbers
            "add": add,
            "subtract": subtract,
            "multiply": multiply,
            "divide": divide,
            "power": functions.power,
            "negate": negate,
            "rounded": rounded,
            "compare": compare,
            "ONE": integer(1),
            "TRUTH": (ZERO, integer(1)),
            "SGN": functions.sign,
            "INT": floor,
            "ABS": absolute,
            "SQR": functions.square_root,
            "LOG": functions.logarithm,
            "EXP": functions.exponential,
            "SIN": functions.sine,
            "COS": functions.cosine,
            "TAN": functions.tangent,
            "ATN": functions.arc_tangent,
            "RND": self._random,
            "byte": byte,
            "address": address,
            "subscript": subscript,
            "whole": whole,
            # strings
            "joined": strings.joined,
            "left": strings.left,
            "right": strings.right,
            "mid": strings.mid,
            "made": strings.made,
            "copy": strings.copy,
            "CHR": lambda x: strings.character(byte(x)),
            "STR": lambda x: strings.made(decimaltext.write(x)),
            "LEN": lambda text: integer(len(text)),
            "ASC": lambda text: integer(code(text)),
            "VAL": lambda text: value(text, decimaltext.read),
            "write": decimaltext.write,
            # variables
            "V": variables.values,
            "made_": variables.made,
            "make": variables.make,
            "place": variables.place,
            "element1": variables.element1,
            "element2": variables.element2,
            "element": variables.element,
            "value1": variables.value1,
            "value2": variables.value2,
            "value": variables.value,
            "dimension": variables.dimension,
            "Function": Function,
            "call": self._call_function,
            "FRE": self._free,
            "clear": self.clear_variables,
            # control
            "first": self._first,
            "after": self._after,
            "start": self._start,
            "bad": _bad,
            "begin_for": control.begin_for,
            "push_for": control.push_for,
            "next_": control.next_,
            "gosub": self._gosub,
            "return_": control.return_,
            "pop": control.pop,
            "room": control.room,
            "places": control.places,
            "lose": self._lose,
            "onerr": self._onerr,
            "resume": self._resume,
            "run": self._run,
            "rerun": self.clear_variables,
            "end": self._end_statement,
            "stop": self._stop,
            "cont": self._cont,
            "new": self._new,
            "trace": self._trace,
            # the outside
            "out": self.out,
            "zone": self._zone,
            "tab": self._tab,
            "spc": self._spc,
            "POS": lambda _: integer(self.screen.column),
            "htab": self._htab,
            "vtab": self._vtab,
            "home": self.screen.home,
            "text": self.screen.full_window,
            "normal": self.normal,
            "inverse": self.inverse,
            "flash": self.flash,
            "speed": lambda _: None,
            "pr": self._pr,
            "in_": lambda _: None,
            "read": self.inputs.read,
            "restore": self.inputs.restore,
            "input_": self.inputs.input_,
            "get": self.inputs.get,
            "list_": self._list,
            "delete": self._delete,
            # memory
            "here": self._look_here,
            "PEEK": lambda x: integer(memory.peek(self, address(x))),
            "POKE": lambda place, n: memory.poke(self, place, n),
            "WAIT": self._wait,
            "CALL": self._call,
            "himem": self._himem,
            "lomem": self._lomem,
            "refuse": self._refuse,
        }

    # --- linking ------------------------------------------------------------------------------

    def changed(self) -> None:
        """The program was changed: variables are gone, and it cannot be continued."""
        self._linked = False
        self.variables.put_start(self.program.end)
        self.clear_variables()

    def _link(self) -> None:
        """Line up the steps of the program."""
        if self._linked:
            return
        self._linked = True
        self._careful = []
        self._first.clear()
        for table in self._tables():
            table.clear()
        deepest = 0
        for number in self.program.numbers:
            self._first[number] = len(self._steps)
            deepest = max(deepest, self._append(self.program.tokens[number], number))
        self._end = len(self._steps)
        self._append_end(self._lines[-1] if self._lines else 0)
        self.control.safe = ROOM + deepest
        self.variables.grow()

    def _tables(self) -> tuple[MutableSequence[Any], ...]:
        """What is known of each step."""
        return self._steps, self._begins, self._lines, self._after, self._start

    def _append(self, tokens: bytes, number: int, *, direct: bool = False) -> int:
        """A line's steps; returns how deep they go into the stack."""
        line = compiled(tokens, direct=direct)
        steps = line.functions(self.names)
        at = len(self._steps)
        self._steps += steps
        self._begins += line.begins
        self._lines += [number] * len(steps)
        self._after += [at + len(steps)] * len(steps)
        for n, begins in enumerate(line.begins, at):
            self._start.append(n if begins else self._start[-1])
        return max(line.needs)

    def _append_end(self, number: int) -> None:
        self._steps.append(_halt)
        self._begins.append(False)
        self._lines.append(number)
        self._after.append(len(self._steps) - 1)
        self._start.append(len(self._steps) - 1)

    def _carefully(self) -> list[Any]:
        """The same steps, looking at the stack as they go."""
        if not self._careful:
            for number in self.program.numbers:
                line = compiled(self.program.tokens[number], careful=True)
                self._careful += line.functions(self.names)
            self._careful.append(_halt)
        return self._careful

    def _put_direct(self, tokens: bytes) -> int:
        """Steps for a line typed without a number, after the program's; where they begin."""
        self._link()
        at = self._end + 1
        for table in self._tables():
            del table[at:]
        self._append(tokens, DIRECT, direct=True)
        self._append_end(DIRECT)
        self.variables.grow()
        self._direct = tokens
        # loops and subroutines that an earlier typed line began have nowhere to go back to
        last = len(self._steps) - 1
        frames = self.control.frames
        for n, frame in enumerate(frames):
            if frame.back >= at:
                frames[n] = frame._replace(back=last)
        return at

    # --- running ------------------------------------------------------------------------------

    def execute(self, tokens: bytes) -> None:
        """Do a line typed without a number, and whatever it starts, until the machine is back at
        the prompt; ``error`` then holds the Applesoft error that ended it, or None.

        Raises TooManyStatements and `console.EndOfInput`.
        """
        self.error = None
        self.broken = False
        self._go(self._put_direct(tokens))

    def _go(self, pc: int) -> None:
        steps = self._steps
        while True:
            try:
                if self.control.careful or self.tracing or self.after_line:
                    while True:
                        pc = self._step(pc)
                while True:
                    chunk = CHUNK
                    if self.statements_left is not None:
                        chunk = self._allowed()
                    for _ in repeat(None, chunk):
                        pc = steps[pc](pc)
                    if self.interrupted:
                        raise KeyboardInterrupt
            except Deeper as deeper:
                pc = deeper.pc
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
            if pc < 0:
                return

    def _allowed(self) -> int:
        assert self.statements_left is not None
        chunk = min(CHUNK, self.statements_left)
        if chunk <= 0:
            raise TooManyStatements
        self.statements_left -= chunk
        return chunk

    def _step(self, pc: int) -> int:
        """One step, with everything that may be asked of it."""
        if self.interrupted:
            raise KeyboardInterrupt
        if self.statements_left is not None:
            if self.statements_left <= 0:
                raise TooManyStatements
            self.statements_left -= 1
        line = self._lines[pc]
        direct = line >= DIRECT
        if self.tracing and self._begins[pc] and not direct:
            self.out(f"#{line} ")
        steps = self._carefully() if self.control.careful and not direct else self._steps
        to: int = steps[pc](pc)
        if self.after_line and not direct and self._lines[to] != line:
            self.after_line(line)
        careful_now = self.control.careful or self.tracing or self.after_line
        if not careful_now:
            raise Deeper(to)
        return to

    def _halted(self, pc: int) -> None:
        line = self._lines[pc]
        if line < DIRECT:
            self._line = line
            if pc == self._end:
                self._continue = pc
            if self.after_line:
                self.after_line(line)

    def _handle(self, error: ApplesoftError, pc: int) -> int:
        """An error: to ONERR's line, or to the prompt (-1) with a message."""
        self.control.depth = 0
        line = self._lines[pc] if error.line is None else error.line
        if self.errors.on:
            return self._to_handler(error, line, pc)
        if self._lines[pc] < DIRECT:
            self._line = self._lines[pc]
            if self.after_line:
                self.after_line(self._line)
        error.line = line if line < DIRECT or line in _RUN_LINES else None
        self.error = error
        place = "" if error.line is None else f" IN {error.line}"
        self.out(f"\n?{error.kind} ERROR{BELL}{place}")
        self.control.clear()
        self._continue = None
        return -1

    def _to_handler(self, error: ApplesoftError, line: int, pc: int) -> int:
        errors = self.errors
        errors.code = error.code
        errors.line = line
        errors.resume = self._start[pc]
        errors.frames = len(self.control.frames)
        self.control.leave(error.kind)
        try:
            return self._first[errors.handler]  # type: ignore[index]
        except ApplesoftError as undefined:
            # the ROM would come back here for ever
            errors.flag = 0
            undefined.line = errors.handler_line
            return self._handle(undefined, pc)

    def _break(self, pc: int) -> int:
        """Control-C."""
        if self.errors.on:
            errors = self.errors
            errors.code = BREAK_CODE
            errors.line = self._lines[pc]
            errors.resume = self._start[pc]
            errors.frames = len(self.control.frames)
            self.control.leave("")
            return self._first.get(errors.handler or 0, -1)
        self._say_break(pc)
        self.broken = True
        if self._lines[pc] < DIRECT:
            self._continue = self._start[pc]
        return -1

    def _say_break(self, pc: int) -> None:
        line = self._lines[pc]
        self.out(f"\nBREAK{BELL}" + ("" if line >= DIRECT else f" IN {line}"))

    # --- statements: control ------------------------------------------------------------------

    def _gosub(self, pc: int, number: int) -> int:
        self.control.push_gosub(pc + 1)
        return self.control.settle(self._first[number])

    def _lose(self, condition: bool) -> bool:
        return self.control.lose(condition)

    def _onerr(self, pc: int, number: int | None) -> None:
        errors = self.errors
        errors.flag = 0x80 | errors.flag >> 1
        errors.handler = number
        errors.handler_line = self._lines[pc]

    def _resume(self) -> int:
        if self.errors.resume is None:
            raise ApplesoftError("SYNTAX")
        self.control.cut(self.errors.frames)
        return self.errors.resume

    def forget_error(self) -> None:
        """CALL -3288: the stack as it was before the error."""
        self.control.cut(self.errors.frames)

    def _run(self, number: int | None) -> int:
        if number is None:
            self.clear_variables()
            return 0
        try:
            return self._first[number]
        except ApplesoftError as error:
            # the machine has taken 256 from the line number, whatever it was
            error.line = 0xFE00 | self._line & 0xFF
            raise

    def clear_variables(self) -> None:
        """CLEAR: no variables, no loops, DATA from the beginning; nothing to continue."""
        self.variables.clear()
        self.inputs.restore()
        self.control.clear()
        self._continue = None

    def _end_statement(self, pc: int) -> None:
        if self._lines[pc] < DIRECT:
            self._continue = pc + 1
        raise Halt

    def _stop(self, pc: int) -> None:
        self._say_break(pc)
        self._end_statement(pc)

    def _cont(self, pc: int) -> int:
        if pc <= self._end:
            return self._start[pc]  # it continues with itself, for ever
        if self._continue is None:
            raise ApplesoftError("CAN'T CONTINUE")
        return self._continue

    def _new(self) -> None:
        self.program.clear()
        self.program.spare = 1
        self.changed()
        raise Halt

    def _delete(self, first: int, last: int) -> None:
        if self.program.delete(first, last):
            self.changed()
            raise Halt

    def _trace(self, pc: int, on: bool) -> None:
        if on != self.tracing:
            self.tracing = on
            raise Deeper(pc + 1)

    def _call_function(self, slot: int, argument: Any, at: int) -> Any:
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
        result = function.body()
        values[function.argument] = saved
        control.depth -= at
        return result

    # --- statements: the outside --------------------------------------------------------------

    def out(self, text: str) -> None:
        """Show characters: high bit dropped, RETURN as newline."""
        if self.flash_bit or not text.isascii() or "\r" in text:
            bit = self.flash_bit & 0x7F
            codes = (ord(character) & 0x7F for character in text)
            text = "".join(chr(n | bit if n >= 32 else n) for n in codes).replace("\r", "\n")
        self.console.put(text)

    def _zone(self) -> None:
        column = self.screen.column
        if column >= 24:
            self.out("\n")
        else:
            self.screen.move_to_column(column + 16 & 0xF0)

    def _tab(self, column: int) -> None:
        spaces = (column - 1 & 0xFF) - self.screen.column
        if spaces > 0:
            self.out(" " * spaces)

    def _spc(self, n: int) -> None:
        self.out(" " * n)

    def _htab(self, column: int) -> None:
        column = column - 1 & 0xFF
        while column >= 40:
            self.out("\n")
            column -= 40
        self.screen.move_to_column(column)

    def _vtab(self, row: int) -> None:
        if not 1 <= row <= 24:
            raise ApplesoftError("ILLEGAL QUANTITY")
        self.screen.move_to_row(row - 1)

    def normal(self) -> None:
        """NORMAL."""
        self.flash_bit = 0
        self.screen.set_mode(NORMAL)

    def inverse(self) -> None:
        """INVERSE."""
        self.flash_bit = 0
        self.screen.set_mode(INVERSE)

    def flash(self) -> None:
        """FLASH."""
        self.flash_bit = FLASH_BIT
        self.screen.set_mode(FLASHING)

    def _pr(self, slot: int) -> None:
        self.console.slot = slot & 7

    def _list(self, first: int, last: int) -> None:
        numbers = self.program.between(first, 0xFFFF)
        for number in numbers:
            self.out("\n")
            if number > last:
                break
            for piece in pieces(number, self.program.tokens[number]):
                self.out(piece)
                if self.screen.column >= WRAP_COLUMN:
                    self.out("\n")
                    self.screen.move_to_column(INDENT)
            if self.interrupted:
                raise KeyboardInterrupt
        self.out("\n")

    # --- statements: memory -------------------------------------------------------------------

    def _random(self, x: Any) -> Any:
        self.seed = functions.random(x, self.seed)
        return self.seed

    def _free(self, _: Any) -> Any:
        self.variables.strings.collect()
        free = self.variables.strings.bottom - self.variables.end_of_arrays()
        return integer((free + 0x8000 & 0xFFFF) - 0x8000)

    def _look_here(self, pc: int) -> None:
        self._here = pc

    def line_now(self) -> int:
        """CURLIN: the line being executed."""
        return self._lines[self._here]

    def poke_program(self, place: int, n: int) -> None:
        """POKE into the program's text: tokens may be changed, not its structure."""
        for number in self.program.numbers:
            offset = place - self.program.address_of(number) - 4
            tokens = self.program.tokens[number]
            if 0 <= offset < len(tokens) and n:
                self.program.store(number, tokens[:offset] + bytes((n,)) + tokens[offset + 1 :])
                self._relink()
                return

    def _relink(self) -> None:
        """Link again while the program runs; every place in it may have moved."""
        where = {at: (line, at - self._first.get(line, 0)) for at, line in enumerate(self._lines)}

        def moved(pc: int) -> int:
            line, offset = where[pc]
            if line >= DIRECT:
                return pc - old_end + self._end
            at = self._first[line] + offset
            return at if self._lines[at] == line else self._after[self._first[line]]

        old_end, direct = self._end, self._direct
        self._linked = False
        self._link()
        frames = self.control.frames
        if direct:
            self._put_direct(direct)
        frames[:] = [frame._replace(back=moved(frame.back)) for frame in frames]
        if self._lines:
            raise Deeper(moved(self._here) + 1)

    def _wait(self, place: int, mask: int, flip: int = 0) -> bool:
        return bool((memory.peek(self, place) ^ flip) & mask)

    def _call(self, place: int) -> None:
        if not memory.call(self, place):
            self._refuse(f"CALL {place}")

    def _refuse(self, what: str) -> None:
        if what not in self.refused:
            self.refused.append(what)
        raise ApplesoftError("SYNTAX")

    def _himem(self, place: int) -> None:
        if place < self.variables.end_of_arrays():
            raise ApplesoftError("OUT OF MEMORY")
        strings = self.variables.strings
        strings.top = strings.bottom = place

    def _lomem(self, place: int) -> None:
        if not self.variables.start <= place < self.variables.strings.top:
            raise ApplesoftError("OUT OF MEMORY")
        self.variables.put_start(place)
        self.clear_variables()


_RUN_LINES = range(0xFE00, 0xFF00)


def _bad(kind: str) -> None:
    raise ApplesoftError(kind)


def _halt(pc: int) -> int:
    raise Halt
