"""What one block of scenes shares while it is computed: who failed first, and where.

In the ROM an error ends the program. Over arrays the other scenes go on, so an error is recorded:
each scene keeps the first one in program order, which the records hold because lines that do not
depend on each other are computed together.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]

NEVER = np.int64(2**63 - 1)
"""The record of a scene in which nothing has failed."""

_ORDER, _CLOCK, _LINE = 40, 24, 8
"""Where a record's parts begin, in bits: the place; the count of errors, of which a block has fewer
than 65,536; the line, which is below 65,536; and the code has 8 bits."""


def stamp(line: int, position: int = 0) -> int:
    """A place in program order: a line outside the subroutine and a position within it."""
    return line * 1000 + position


def key(line: int, position: int = 0, order: int | None = None) -> int:
    """A place as records hold it, with the line a message names; ``order``: its own stamp."""
    return ((stamp(line, position) if order is None else order) << _ORDER) + (line << _LINE)


class Unit:
    """The state of one block: ``count`` scenes, along the last axis of every array. ``first`` holds
    one record a scene: place, count of errors so far, line and code packed so that the smallest is
    the first in program order."""

    def __init__(self, count: int) -> None:
        self.count = count
        self.first: Ints = np.full(count, NEVER, dtype=np.int64)
        self.elsewhere: Bools | None = None
        """The scenes that do not run the present statement; their errors are none."""
        self.place: Any = 0
        """Where the program is, as `key`; or an array, a place of its own for each scene."""
        self._clock = 0

    def skip(self, skipped: Bools | None) -> None:
        """The scenes that do not run what follows, up to ``skip(None)``."""
        self.elsewhere = None if skipped is None else np.broadcast_to(skipped, self.first.shape)

    def at(self, line: int, position: int = 0, order: int | None = None) -> None:
        """Go to a place, see `key`."""
        self.place = key(line, position, order)

    def part(self, rows: Ints) -> Unit:
        """A unit of some scenes only, at the same place."""
        part = Unit(rows.size)
        place = self.place
        part.place = place[rows] if isinstance(place, np.ndarray) else place
        return part

    def join(self, part: Unit, rows: Ints) -> None:
        """Take over what has failed in a `part`."""
        self.first[rows] = np.minimum(self.first[rows], part.first)

    def fails(self, failed: Any, code: int) -> bool:
        """Note an error where ``failed``, an array over the scenes or of length 1 for all; whether
        there is any such scene."""
        if self.elsewhere is not None:
            failed = failed & ~self.elsewhere
        if not failed.any():
            return False
        self._clock += 1
        keys = np.where(failed, self.place + (self._clock << _CLOCK) + code, NEVER)
        np.minimum(self.first, keys, out=self.first)
        return True

    def still(self, chosen: dict[int, Any]) -> dict[int, Any]:
        """What was chosen, where some scenes still have it."""
        return {row: scenes for row, scenes in chosen.items() if scenes.any()}

    def code(self) -> Ints:
        """Each scene's error code; 0 for none."""
        return np.where(self.first == NEVER, 0, self.first & ((1 << _LINE) - 1))

    def line(self) -> Ints:
        """The line each scene's error names; 0 for none."""
        line = (self.first >> _LINE) & ((1 << (_CLOCK - _LINE)) - 1)
        return np.where(self.first == NEVER, 0, line)

    def reached(self, place: int) -> Bools:
        """The scenes that got past ``place``."""
        return (self.first >> _ORDER) > place
