"""The errors of a block of scenes while it is computed: each scene's first one, and its place.

In the ROM an error ends the program. Over arrays the other scenes continue, so errors are recorded,
and each scene keeps the first one in program order. The records contain that order, because
independent lines are computed together.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]

NEVER = np.int64(2**63 - 1)  # the record of a scene without an error

# A record is place << 40 | count of errors << 24 | line << 8 | code: the smallest is the first in
# program order. A block has fewer than 65,536 errors, and lines are below 65,536.
_ORDER = 40
_CLOCK = 24
_LINE = 8


def stamp(line: int, position: int = 0) -> int:
    """Return a place in program order: a line of the main program, and a position within it."""
    return line * 1000 + position


def key(line: int, position: int = 0, order: int | None = None) -> int:
    """Return a place as a record holds it: its stamp (``order``, by default that of ``line``) and
    the line for messages."""
    return ((stamp(line, position) if order is None else order) << _ORDER) + (line << _LINE)


class BlockErrors:
    """The errors of one block of ``count`` scenes, which lie along the last axis of every array.

    ``first`` holds the record of each scene's first error, `NEVER` without one."""

    def __init__(self, count: int) -> None:
        self.count = count
        self.first: Ints = np.full(count, NEVER, dtype=np.int64)
        self.elsewhere: Bools | None = None
        """Scenes that do not run the present statement, whose errors are ignored."""
        self.place: Any = 0
        """The present place, see `key`; an array if each scene has its own."""
        self._clock = 0

    def skip(self, skipped: Bools | None) -> None:
        """Ignore errors of the ``skipped`` scenes until ``skip(None)``."""
        self.elsewhere = None if skipped is None else np.broadcast_to(skipped, self.first.shape)

    def at(self, line: int, position: int = 0, order: int | None = None) -> None:
        """Set the present place, see `key`."""
        self.place = key(line, position, order)

    def part(self, rows: Ints) -> BlockErrors:
        """Return the record of the scenes ``rows``, at the same place."""
        part = BlockErrors(rows.size)
        place = self.place
        part.place = place[rows] if isinstance(place, np.ndarray) else place
        return part

    def join(self, part: BlockErrors, rows: Ints) -> None:
        """Merge the errors of a `part` into the scenes ``rows``."""
        self.first[rows] = np.minimum(self.first[rows], part.first)

    def record_error(self, failures: Any, code: int) -> bool:
        """Record an error where ``failures``, an array over the scenes or of length 1 for all.
        Return True if any scene failed."""
        if self.elsewhere is not None:
            failures = failures & ~self.elsewhere
        if not failures.any():
            return False
        self._clock += 1
        keys = np.where(failures, self.place + (self._clock << _CLOCK) + code, NEVER)
        np.minimum(self.first, keys, out=self.first)
        return True

    def drop_empty(self, chosen: dict[int, Any]) -> dict[int, Any]:
        """Return the rows that at least one scene has chosen."""
        return {row: scenes for row, scenes in chosen.items() if scenes.any()}

    def code(self) -> Ints:
        """Return each scene's error code, 0 without an error."""
        return np.where(self.first == NEVER, 0, self.first & ((1 << _LINE) - 1))

    def line(self) -> Ints:
        """Return the line of each scene's error, 0 without an error."""
        line = (self.first >> _LINE) & ((1 << (_CLOCK - _LINE)) - 1)
        return np.where(self.first == NEVER, 0, line)

    def has_passed(self, place: int) -> Bools:
        """Return True for each scene that got past ``place``."""
        return (self.first >> _ORDER) > place
