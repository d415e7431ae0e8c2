"""The program as one row of steps: every line's compiled functions, one after the other.

A place in the program is an index into that row. The steps of a line typed without a number stand
after the program's.
"""

from __future__ import annotations

from collections.abc import MutableSequence
from typing import Any

from ..applesoft.errors import ApplesoftError
from .compiledline import Namespace, compiled
from .control import Control
from .operand import ROOM
from .programtext import ProgramText

DIRECT = 0xFF00
"""Line numbers from here on mean: typed without a line number."""


class Halt(Exception):
    """The program ends."""


class Targets(dict[int, int]):
    """Line number -> its first step. Raises UNDEF'D STATEMENT, and SYNTAX for no number at all."""

    def __missing__(self, number: int | None) -> int:
        raise ApplesoftError("SYNTAX" if number is None else "UNDEF'D STATEMENT")


def halt(pc: int) -> int:
    """The step after the last."""
    raise Halt


class Steps:
    """The row, and of each step: whether a statement ``begins`` with it, its line (``lines``),
    where the next line begins (``after``), and where its statement does (``start``). ``first``
    finds a line's first step; ``end`` is the step after the program's last."""

    def __init__(self, program: ProgramText, control: Control, names: Namespace) -> None:
        self._program = program
        self._control = control
        self._names = names
        self._linked = False
        self._careful: list[Any] = []
        self._direct = b""
        self.steps: list[Any] = []
        self.begins: list[bool] = []
        self.lines: list[int] = []
        self.after: list[int] = []
        self.start: list[int] = []
        self.first = Targets()
        self.end = 0

    def changed(self) -> None:
        """The program is another one now."""
        self._linked = False

    def is_direct(self, pc: int) -> bool:
        """Whether a step was typed without a line number."""
        return self.lines[pc] >= DIRECT

    def _tables(self) -> tuple[MutableSequence[Any], ...]:
        return self.steps, self.begins, self.lines, self.after, self.start

    def _link(self) -> None:
        """Line up the steps of the program."""
        self._linked = True
        self._careful = []
        self.first.clear()
        for table in self._tables():
            table.clear()
        deepest = 0
        for number in self._program.numbers:
            self.first[number] = len(self.steps)
            deepest = max(deepest, self._append(self._program.tokens[number], number))
        self.end = len(self.steps)
        self._append_end(self.lines[-1] if self.lines else 0)
        self._control.safe = ROOM + deepest

    def _append(self, tokens: bytes, number: int) -> int:
        """A line's steps; returns how deep they go into the stack."""
        line = compiled(tokens, direct=number == DIRECT)
        at = len(self.steps)
        self.steps += line.functions(self._names)
        self.begins += line.begins
        self.lines += [number] * len(line.begins)
        self.after += [at + len(line.begins)] * len(line.begins)
        for n, begins in enumerate(line.begins, at):
            self.start.append(n if begins else self.start[-1])
        return max(line.needs)

    def _append_end(self, number: int) -> None:
        self.after.append(len(self.steps))
        self.start.append(len(self.steps))
        self.steps.append(halt)
        self.begins.append(False)
        self.lines.append(number)

    def careful(self) -> list[Any]:
        """The program's steps, looking at the stack as they go."""
        if not self._careful:
            for number in self._program.numbers:
                line = compiled(self._program.tokens[number], careful=True)
                self._careful += line.functions(self._names)
            self._careful.append(halt)
        return self._careful

    def put_direct(self, tokens: bytes) -> int:
        """Steps for a line typed without a number, after the program's; where they begin."""
        if not self._linked:
            self._link()
        at = self.end + 1
        for table in self._tables():
            del table[at:]
        self._direct = tokens
        self._append(tokens, DIRECT)
        self._append_end(DIRECT)
        # loops and subroutines that an earlier typed line began have nowhere to go back to
        self._control.send_back(lambda back: back if back < at else len(self.steps) - 1)
        return at

    def relink(self, pc: int) -> int:
        """Link again while the program runs, because a token was changed; where ``pc`` is now."""
        lines, end = list(self.lines), self.end
        first = dict(self.first)

        def moved(place: int) -> int:
            if lines[place] >= DIRECT:
                return place - end + self.end
            line = lines[place]
            at = self.first[line] + place - first[line]
            return at if self.lines[at] == line else self.after[self.first[line]]

        backs = [frame.back for frame in self._control.frames]
        self._linked = False
        self.put_direct(self._direct)
        places = iter(backs)
        self._control.send_back(lambda _: moved(next(places)))
        return moved(pc)
