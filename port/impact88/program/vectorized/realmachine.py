"""Programs of the Apple's reals for the compiled machine (`native/replay.h`)."""

from collections.abc import Iterable, Mapping
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...mechanics import native
from ...mechanics.native.schedule import Schedule

Addresses = NDArray[np.int64]


class Program(Schedule):
    """Steps in the form that the compiled machine runs."""

    @cached_property
    def code(self) -> NDArray[np.int32]:
        if self.places > native.library.most_places():
            raise MemoryError(f"a program of {self.places} values")
        operations = native.library.operations().decode().split()
        steps = [[operations.index(name), *places] for name, places in self.steps]
        return np.array([[*step, *[0] * (5 - len(step))] for step in steps], np.int32)

    @cached_property
    def _free_rooms(self) -> list["Room"]:
        """Working memories that no thread is using."""
        return []

    def run(
        self,
        columns: Addresses,
        results: Addresses,
        count: int,
        fixed: Mapping[str, float] = {},
    ) -> None:
        """Compute ``count`` scenes. ``columns``, ``results``: addresses in the program's order, of
        float64; ``fixed``: values of the columns that do not vary."""
        room = self._free_rooms.pop() if self._free_rooms else Room(self)
        room.moving[: len(columns)] = columns
        room.moving[len(columns) :] = results
        if fixed:
            room.values[:] = [fixed[x] if isinstance(x, str) else x for x in self.scalars]
        room.run(count)
        self._free_rooms.append(room)


class Room:
    """Per-thread working memory of a program and the argument block of the C call."""

    def __init__(self, program: Program) -> None:
        self.moving = np.empty(program.moving, np.int64)
        self.values = np.array([0.0 if isinstance(x, str) else x for x in program.scalars], float)
        self._block = np.empty(program.places * native.library.replayed_together() + 8)
        start = self._block.ctypes.data + -self._block.ctypes.data % 64  # of a cache line
        self._code = code = program.code
        call = (
            code.ctypes.data,
            program.once,
            len(code),
            self.moving.ctypes.data,
            len(program.columns),
            program.moving,
            self.values.ctypes.data,
            len(self.values),
            start,
            program.places,
        )
        self._call = np.array([*call, 0], np.int64)
        self._at = self._call.ctypes.data

    def run(self, count: int) -> None:
        """Run the program over ``count`` scenes of what ``moving`` and ``values`` hold."""
        self._call[-1] = count
        native.library.run_program(self._at)


def addresses(arrays: Iterable[NDArray[np.generic]]) -> Addresses:
    """Return the addresses of arrays."""
    return np.array([array.ctypes.data for array in arrays], np.int64)
