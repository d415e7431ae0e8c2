"""The control stack: FOR loops and GOSUBs, as the ROM keeps them on the 6502's stack.

A FOR takes 18 bytes, a GOSUB 7; the stack pointer starts at 248 and a formula needs it at 59 or
more. An error that ONERR catches leaves what was on the stack lying there, and everything below it
out of reach, until RESUME or the manual's CALL -3288 clears it away.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from ..applesoft.errorcodes import ApplesoftError
from ..applesoft.real import ZERO, Number, add, compare, rounded
from .operand import ROOM, STACK
from .variables import Variables

FOR_SIZE = 18
FOR_ROOM = 74
GOSUB_SIZE = 7
GOSUB_ROOM = 64
GOSUB = -2
LEFTOVER = -3
_LEFT_BY = {
    "ILLEGAL QUANTITY": 4,
    "BAD SUBSCRIPT": 4,
    "REDIM'D ARRAY": 6,
    "TYPE MISMATCH": 5,
    "SYNTAX": 4,
    "RETURN WITHOUT GOSUB": 0,
}
"""Bytes that an error outside any formula leaves on the stack, else 2: as in the plainest statement
that runs into it."""


class Frame(NamedTuple):
    """``slot``: the variable of a FOR, or GOSUB, or LEFTOVER. ``back``: the step to go back to.
    ``sign`` is that of the step; for LEFTOVER, how many bytes were left."""

    slot: int
    back: int
    limit: Number = ZERO
    step: Number = ZERO
    sign: int = 0


class Elsewhere(Exception):
    """Go on at ``pc``, in another manner: the stack may have too little room for a formula now."""

    def __init__(self, pc: int) -> None:
        self.pc = pc


class Control:
    """The stack. ``pointer`` is the 6502's; ``safe`` is the lowest at which no formula of the
    program can run out of stack; below it steps are compiled to look."""

    def __init__(self, variables: Variables) -> None:
        self.frames: list[Frame] = []
        self.pointer = STACK
        self.safe = 0
        self.careful = False
        self.watched = False
        self.depth = 0
        self.formula_depth = 0
        self.assigned_page = 0
        self._values = variables.values
        self._variables = variables

    def clear(self) -> None:
        """STKINI."""
        self.frames.clear()
        self.pointer = STACK
        self.careful = self.watched
        self.depth = 0

    def watch(self, watched: bool) -> bool:
        """Whether steps are to be careful whatever the stack; whether that is something new."""
        before = self.careful
        self.watched = watched
        self.careful = self._must_be_careful()
        return self.careful and not before

    def _must_be_careful(self) -> bool:
        return self.watched or self.pointer < self.safe

    def enter(self, depth: int) -> None:
        """A formula is worked out ``depth`` bytes down the stack."""
        self.formula_depth = depth

    def assign(self, slot: int) -> None:
        """A simple variable is about to be assigned; the ROM keeps its address."""
        self._variables.find(slot)
        self.assigned_page = self._variables.address_of(slot) >> 8

    def _look(self, pc: int) -> None:
        careful = self._must_be_careful()
        if careful != self.careful:
            self.careful = careful
            raise Elsewhere(pc)

    def send_back(self, moved: Callable[[int], int]) -> None:
        """The steps that loops and subroutines go back to have moved."""
        self.frames[:] = [frame._replace(back=moved(frame.back)) for frame in self.frames]

    # --- what careful steps ask ---------------------------------------------------------------

    def room(self, depth: int) -> None:
        """Raises OUT OF MEMORY if a formula cannot begin ``depth`` bytes down."""
        self.formula_depth = depth
        if self.pointer - self.depth - depth < ROOM:
            raise ApplesoftError("OUT OF MEMORY")
        self.formula_depth = 0

    # --- FOR and NEXT -------------------------------------------------------------------------

    def begin_for(self, slot: int) -> None:
        """A loop with the same variable ends, and those inside it. Raises OUT OF MEMORY."""
        for n in range(len(self.frames) - 1, -1, -1):
            loop = self.frames[n].slot
            if loop < 0:
                break
            if loop == slot:
                self._drop(n)
                break
        if self.pointer < FOR_ROOM:
            raise ApplesoftError("OUT OF MEMORY")

    def push_for(self, slot: int, back: int, limit: Number, step: Number) -> int:
        """A loop begins; returns where its body does."""
        sign = (-1 if step[2] else 1) if step[0] else 0
        self.frames.append(Frame(slot, back, limit, step, sign))
        self.pointer -= FOR_SIZE
        if self._variables.lies_at_page_end(slot):
            self.watched = True  # RETURN may take this loop for what it looks for
            self.assign(slot)
            self._look(back)
        if self.pointer < self.safe:
            self._look(back)
        return back

    def next_(self, pc: int, slot: int) -> int:
        """NEXT of a variable, or of the innermost loop (-1): where to go on."""
        frames = self.frames
        if not frames or frames[-1].slot != slot:
            self._find(slot)
        slot, back, limit, step, sign = frames[-1]
        values = self._values
        values[slot] = value = rounded(add(values[slot], step))
        if compare(limit, value) != sign:
            return back
        self._drop(len(frames) - 1)
        if self.careful:
            self._look(pc + 1)
        return pc + 1

    def _find(self, slot: int) -> None:
        """Bring the variable's loop to the top. Raises NEXT WITHOUT FOR."""
        if slot >= 0:
            self._variables.place(slot)
        for n in range(len(self.frames) - 1, -1, -1):
            loop = self.frames[n].slot
            if loop < 0:
                break
            if slot in (-1, loop):
                self._drop(n + 1)
                return
        raise ApplesoftError("NEXT WITHOUT FOR")

    def _drop(self, n: int) -> None:
        """Forget the frames from the n-th on."""
        for frame in self.frames[n:]:
            if frame.slot >= 0:
                self.pointer += FOR_SIZE
            else:
                self.pointer += GOSUB_SIZE if frame.slot == GOSUB else frame.sign
        del self.frames[n:]

    # --- GOSUB and RETURN ---------------------------------------------------------------------

    def push_gosub(self, back: int) -> None:
        """Raises OUT OF MEMORY."""
        if self.pointer < GOSUB_ROOM:
            raise ApplesoftError("OUT OF MEMORY")
        self.frames.append(Frame(GOSUB, back))
        self.pointer -= GOSUB_SIZE

    def settle(self, pc: int) -> int:
        """After GOSUB: go on at pc, carefully if need be."""
        if self.pointer < self.safe:
            self._look(pc)
        return pc

    def return_(self) -> int:
        """RETURN: where to go on. Raises RETURN WITHOUT GOSUB."""
        back = self._return_place()
        if self.careful:
            self._look(back)
        return back

    def pop(self) -> None:
        """POP. Raises RETURN WITHOUT GOSUB."""
        self._return_place()

    def _return_place(self) -> int:
        frames = self.frames
        n = len(frames) - 1
        while n >= 0 and frames[n].slot >= 0:
            if self._taken_for_gosub(frames[n].slot):
                raise ApplesoftError("RETURN WITHOUT GOSUB")
            n -= 1
        # the ROM has moved its stack pointer before it finds that there is no GOSUB
        self._drop(n + 1)
        if n < 0 or frames[n].slot != GOSUB:
            raise ApplesoftError("RETURN WITHOUT GOSUB")
        back = frames[n].back
        self._drop(n)
        return back

    def _taken_for_gosub(self, slot: int) -> bool:
        """Whether a loop looks like what RETURN looks for: a variable at $xxFF, xx being left over
        from the last assignment."""
        variables = self._variables
        return (
            variables.lies_at_page_end(slot)
            and variables.address_of(slot) >> 8 == self.assigned_page
        )

    # --- errors that ONERR catches ------------------------------------------------------------

    def leave(self, kind: str, depth: int) -> None:
        """What an error that happened ``depth`` bytes down leaves on the stack, for as long as the
        program runs. A pointer that goes below the stack's page comes in again at the top."""
        size = depth or _LEFT_BY.get(kind, 2)
        if self.pointer < size:
            self.frames.clear()
            self.pointer = self.pointer - size & 0xFF
            self.frames.append(Frame(LEFTOVER, 0, sign=STACK - self.pointer))
        elif self.frames and self.frames[-1].slot == LEFTOVER:
            self.frames[-1] = Frame(LEFTOVER, 0, sign=self.frames[-1].sign + size)
            self.pointer -= size
        elif size:
            self.frames.append(Frame(LEFTOVER, 0, sign=size))
            self.pointer -= size
        self.careful = self._must_be_careful()

    def cut(self, frames: int) -> None:
        """Back to as many frames as there were."""
        self._drop(frames)
        self.careful = self._must_be_careful()
