"""The program as one row of steps: every line's compiled functions, one after the other.

A place in the program is an index into that row. The steps of a line typed without a number stand
after the program's.
"""

from __future__ import annotations

from collections.abc import MutableSequence
from typing import Any

from ..applesoft.errorcodes import ApplesoftError
from .compiledline import Namespace, compiled
from .control import GOSUB, Control, Frame
from .operand import ROOM
from .programtext import HEADER, START, Line, ProgramText
from .reader import COLON, Reader

DIRECT = 0xFF00
"""Line numbers from here on mean: typed without a line number."""
INPUT_BUFFER = 0x200
AFTER_END = 2
"""Steps behind the program's last: `halt` and `wild`."""
NO_STATEMENT = b")"
NO_LINE = Line(START - HEADER - 1, 0, b"")


class Halt(Exception):
    """The program ends."""


class ProgramGone(Halt):
    """The program ends because it took itself out."""


class Targets(dict[int, int]):
    """Line number -> its first step. Raises UNDEF'D STATEMENT, and SYNTAX for no number at all."""

    def __missing__(self, number: int | None) -> int:
        raise ApplesoftError("SYNTAX" if number is None else "UNDEF'D STATEMENT")


def halt(pc: int) -> int:
    """The step after the last."""
    raise Halt


def wild(pc: int) -> int:
    """Where a line's link leads that was poked to lead nowhere: the ROM reads on in what it finds
    there, and seldom finds a statement."""
    raise ApplesoftError("SYNTAX")


class InputBuffer(bytearray):
    """Page 2, where typed lines are read in and their tokens put in their place.

    What an earlier, longer line left stands behind them: a FOR typed on that line goes back there.
    """

    def __init__(self) -> None:
        super().__init__(256)

    def put(self, typed: bytes, tokens: bytes) -> None:
        """A line typed without a number, and its tokens."""
        for text in (typed, tokens):
            self[: len(text)] = text[: len(self)]
            if len(text) < len(self):
                self[len(text)] = 0
        if len(tokens) + 2 < len(self):
            self[len(tokens) + 2] = 0  # the ROM's parser clears one more

    def rest(self, position: int) -> bytes:
        """The bytes from a position to the end of the line there."""
        return bytes(self[position:]).partition(b"\0")[0]

    def statement_end(self, position: int) -> int:
        """Where the statement ends that goes on at a position."""
        reader = Reader(self.rest(position))
        reader.skip_statement()
        return position + reader.position


class Steps:
    """The row of steps, and lists beside it with an entry for each.

    ``traced``: whether TRACE shows it. ``lines``: the number of its line. ``after``: where the next
    line begins. ``start``: where its statement begins. ``base``: the address of its line's tokens,
    ``position``: where among them the ROM stands before the step. ``first`` finds a line's first
    step; ``end`` is the step after the program's last.
    """

    def __init__(self, program: ProgramText, control: Control, names: Namespace) -> None:
        self._program = program
        self._control = control
        self._names = names
        self._linked = False
        self._careful: list[Any] = []
        self.buffer = InputBuffer()
        self.steps: list[Any] = []
        self.traced: list[bool] = []
        self.lines: list[int] = []
        self.after: list[int] = []
        self.start: list[int] = []
        self.base: list[int] = []
        self.position: list[int] = []
        self.first = Targets()
        self.end = 0
        self.leftovers = False
        self._sources: list[tuple[int, bytes, int]] = []

    def changed(self) -> None:
        """The program is another one now."""
        self._linked = False

    def is_direct(self, pc: int) -> bool:
        """Whether a step was typed without a line number."""
        return self.lines[pc] >= DIRECT

    def place(self, pc: int) -> int:
        """The address where the ROM stands before a step: the colon or the zero in front of it."""
        position = self.position[pc]
        before_line = HEADER if position < 0 and not self.is_direct(pc) else 0
        return self.base[pc] + position - before_line

    def _tables(self) -> tuple[MutableSequence[Any], ...]:
        return (
            self.steps,
            self.traced,
            self.lines,
            self.after,
            self.start,
            self.base,
            self.position,
        )

    def _link(self) -> None:
        """Line up the steps of the program."""
        self._linked = True
        self._careful = []
        self.leftovers = False
        self.first.clear()
        self._sources.clear()
        for table in self._tables():
            table.clear()
        deepest = 0
        lines = self._program.flow()
        if self._program.as_stored:
            for line in lines:
                self.first[line.number] = len(self.steps)
                deepest = max(deepest, self._append(line.tokens, line.number, line.text))
        else:
            deepest = self._append_poked(lines)
        self.end = len(self.steps)
        last = lines[-1] if lines else NO_LINE
        self._append_end(last.number, last.text, len(last.tokens))
        self._append_step(wild, last.number, last.text, 0)
        self._control.safe = ROOM + deepest

    def _append_poked(self, lines: list[Line]) -> int:
        """The steps of a program that poked into itself, in which links may lead anywhere; returns
        how deep they go into the stack."""
        deepest = 0
        places: dict[int, int] = {}
        for line in lines:
            places[line.address] = len(self.steps)
            deepest = max(deepest, self._append(line.tokens, line.number, line.text))
            if self._program.ends_at(line.end) and line is not lines[-1]:
                self._append_end(line.number, line.text, len(line.tokens))
        for line in self._program.lines:
            self.first.setdefault(line.number, places.get(line.address, len(self.steps) + 1))
        return deepest

    def _append(self, tokens: bytes, number: int, base: int, shift: int = 0) -> int:
        """A line's steps; returns how deep they go into the stack. The line's own positions are
        ``shift`` less than those kept."""
        line = compiled(tokens, direct=number == DIRECT)
        first = len(self.steps)
        count = len(line.traced)
        self._sources.append((number, tokens, first))
        self.steps += line.functions(self._names)
        self.traced += line.traced
        self.lines += [number] * count
        self.after += [first + count] * count
        self.base += [base] * count
        self.position += [n + shift for n in line.positions] if shift else line.positions
        self.leftovers |= line.leftovers
        self.start += [first + n for n in line.starts]
        return line.need

    def _append_end(self, number: int, base: int, position: int) -> None:
        self._append_step(halt, number, base, position)

    def _append_step(self, step: Any, number: int, base: int, position: int) -> None:
        pc = len(self.steps)
        values = (step, False, number, pc, pc, base, position)
        for table, value in zip(self._tables(), values, strict=True):
            table.append(value)

    def careful(self) -> list[Any]:
        """The steps, looking at the stack and at the accumulator as they go."""
        if len(self._careful) != len(self.steps):
            self._careful = list(self.steps)
            for number, tokens, first in self._sources:
                line = compiled(tokens, careful=True, direct=number == DIRECT)
                self._careful[first : first + len(line.codes)] = line.functions(self._names)
        return self._careful

    def put_direct(self, typed: bytes, tokens: bytes) -> int:
        """Steps for a line typed without a number, after the program's; where they begin.

        Loops and subroutines that an earlier typed line began go back to the same place in the
        buffer, whatever stands there now.
        """
        if not self._linked:
            self._link()
        self.buffer.put(typed, tokens)
        return self._place_direct(tokens)

    def _place_direct(self, tokens: bytes) -> int:
        first = self.end + AFTER_END
        back = {
            frame.back: self._position_back(frame)
            for frame in self._control.frames
            if frame.back >= first
        }
        for table in self._tables():
            del table[first:]
        self._sources = [source for source in self._sources if source[2] < first]
        self._careful = []
        self._append(tokens, DIRECT, INPUT_BUFFER)
        self._append_end(DIRECT, INPUT_BUFFER, len(tokens))
        places = {old: self._rest_of_buffer(position) for old, position in back.items()}
        self._control.send_back(lambda old: places.get(old, old))
        return first

    def _position_back(self, frame: Frame) -> int:
        """Where in the buffer a loop or subroutine goes back to."""
        if frame.slot == GOSUB and frame.back > self.end + AFTER_END:
            return self.buffer.statement_end(max(self.position[frame.back - 1], -1) + 2)
        return self.position[frame.back]

    def _rest_of_buffer(self, position: int) -> int:
        """Steps for what stands in the buffer from a position on, a colon if a statement."""
        rest = self.buffer.rest(max(position, 0))
        first = len(self.steps)
        if rest:
            tokens = rest[1:] if rest[0] == COLON else NO_STATEMENT
            self._append(tokens, DIRECT, INPUT_BUFFER, position + 1)
        self._append_line_behind(position + len(rest))
        return first

    def _append_line_behind(self, position: int) -> None:
        """What comes behind a zero in the buffer: the end, or, if the second byte from there is
        none, a line of a program that the ROM takes the rest of the buffer for."""
        behind = self.buffer[position : position + HEADER + 1]
        if len(behind) <= HEADER or not behind[2]:
            self._append_end(DIRECT, INPUT_BUFFER, position)
            return
        number = behind[3] + 256 * behind[4]
        tokens = self.buffer.rest(position + HEADER + 1)
        self._append(tokens, number, INPUT_BUFFER, position + HEADER + 1)
        self._append_line_behind(position + HEADER + 1 + len(tokens))

    def relink(self, pc: int) -> int:
        """Link again while the program runs, because a byte of it was changed; where ``pc`` is
        now."""
        lines, end = list(self.lines), self.end
        base, position = list(self.base), list(self.position)
        direct = [table[end + AFTER_END :] for table in self._tables()]
        sources = [source for source in self._sources if source[2] >= end + AFTER_END]
        self._link()
        shift = self.end - end
        self._sources += [(number, tokens, first + shift) for number, tokens, first in sources]
        for table, rest in zip(self._tables(), direct, strict=True):
            table += rest
        for table in (self.after, self.start):
            for n in range(self.end + AFTER_END, len(table)):
                table[n] += shift

        def moved(place: int) -> int:
            if lines[place] >= DIRECT or place >= end:
                return place + shift
            address = base[place] + position[place]
            same = (
                n
                for n in range(self.end)
                if self.base[n] + self.position[n] >= address and self.base[n] >= base[place]
            )
            return next(same, self.end)

        self._control.send_back(moved)
        return moved(pc)
