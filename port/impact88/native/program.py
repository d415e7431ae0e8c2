"""Programs for the compiled machine."""

import hashlib
from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import native
from .schedule import Schedule

Array = NDArray[np.float64]
Addresses = NDArray[np.int64]


class Program(Schedule):
    """Steps that the compiled machine runs."""

    @cached_property
    def code(self) -> NDArray[np.int32]:
        if self.places > native.library.most_places():
            raise MemoryError(f"a program of {self.places} values")
        operations = native.library.operations().decode().split()
        steps = [[operations.index(name), *places] for name, places in self.steps]
        return np.array([[*step, *[0] * (6 - len(step))] for step in steps], np.int32)

    @cached_property
    def width(self) -> Addresses:
        """Bytes of a number of each column and result."""
        widths = [2 if ending == "BITS" else 8 for ending in self.endings]
        return np.array([8] * len(self.columns) + widths, np.int64)

    @property
    def digest(self) -> int:
        """By what the machine knows a program that it has as a whole."""
        text = repr((self.columns, self.results, self.scalars, self.steps)).encode()
        return int.from_bytes(hashlib.blake2b(text, digest_size=8).digest())

    @cached_property
    def kernel(self) -> Any:
        return native.library.kernel_of(self.digest)

    @cached_property
    def _rooms(self) -> list["Room"]:
        """Those that no thread uses."""
        return []

    def run(
        self,
        columns: Addresses,
        results: Addresses,
        count: int,
        circle: int = 0,
        fixed: Mapping[str, float] = {},
        checked: Addresses | None = None,
        limits: Array | None = None,
    ) -> int:
        """Run it over ``count`` scenes of float64 columns and results (uint16: bits), in the
        program's order; ``fixed``: the columns that do not vary; ``circle``: see
        `closedform.impactprograms`. Returns how many scenes were done: all, or those before the
        strips among which a column ``checked`` leaves its ``limits`` (least and most of each)."""
        room = self._rooms.pop() if self._rooms else Room(self)
        room.moving[: len(columns)] = columns
        room.moving[len(columns) :] = results
        if fixed:
            room.values[:] = [fixed[x] if isinstance(x, str) else x for x in self.scalars]
        room.prepare(count, circle, checked, limits)
        done = room.run()
        self._rooms.append(room)
        return done


class Room:
    """Working memory of a program, for one thread at a time, and what the machine gets to know of
    both."""

    def __init__(self, program: Program) -> None:
        self.moving = np.empty(program.moving, np.int64)
        self.values = np.array([0.0 if isinstance(x, str) else x for x in program.scalars], float)
        self._block = np.empty(program.places * native.STRIP + 8)
        start = self._block.ctypes.data + -self._block.ctypes.data % 64  # of a cache line
        self._kept = code, width = program.code, program.width
        call = (
            *(code.ctypes.data, program.once, len(code)),
            *(self.moving.ctypes.data, width.ctypes.data, len(program.columns), program.moving),
            *(self.values.ctypes.data, len(self.values)),
            *(start, program.places, program.kernel or 0),
        )
        self._call = np.array([*call, 0, 0, 0, 0, 0], np.int64)
        self._at = self._call.ctypes.data

    def prepare(
        self, count: int, circle: int, checked: Addresses | None = None, limits: Array | None = None
    ) -> None:
        """What `run` does: see `Program.run`. ``checked`` and ``limits`` are to be kept."""
        looked_at = 0, 0, 0
        if checked is not None and limits is not None:
            looked_at = checked.ctypes.data, limits.ctypes.data, len(checked)
        self._call[-5:] = *looked_at, count, circle

    def run(self) -> int:
        """`Program.run` as prepared, of what ``moving`` and ``values`` hold."""
        done: int = native.library.run_program(self._at)
        return done


def addresses(arrays: Iterable[NDArray[np.generic]]) -> Addresses:
    """Where arrays begin in memory."""
    return np.array([array.ctypes.data for array in arrays], np.int64)
