"""Programs for the compiled machine, and its other functions over arrays."""

import hashlib
from collections.abc import Iterable, Mapping, Sequence
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
        assert native.library is not None
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
        assert native.library is not None
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
        assert native.library is not None
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
        assert native.library is not None
        done: int = native.library.run_program(self._at)
        return done


def extremes(columns: Sequence[Array]) -> list[tuple[float, float]]:
    """The least and the largest number of each column, both NaN where one is; columns of one
    length, then those of one number."""
    assert native.library is not None
    found, count = np.empty((len(columns), 2)), len(columns[0])
    many = sum(len(column) == count for column in columns)
    where = addresses(columns)
    to = found.ctypes.data
    native.library.survey_kinds(where.ctypes.data, many, len(columns), count, to, 0, 0)
    return [(least, most) for least, most in found.tolist()]


def addresses(arrays: Iterable[NDArray[np.generic]]) -> Addresses:
    """Where arrays begin in memory."""
    return np.array([array.ctypes.data for array in arrays], np.int64)


def read_numbers(text: bytes, count: int) -> tuple[Array, NDArray[np.bool_]]:
    """The Apple's reals that ``count`` decimal texts are, each ended by a newline, extension
    included; and which are left to others (True): no plain numbers, or very large or small."""
    assert native.library is not None
    values, odd = np.empty(count), np.empty(count, np.bool_)
    native.library.read_numbers(text, count, values.ctypes.data, odd.ctypes.data)
    return values, odd


def write_numbers(values: Array, texts: NDArray[np.str_]) -> NDArray[np.bool_]:
    """Fill ``texts`` with the characters PRINT makes of reals; which are left to others (True)."""
    assert native.library is not None
    odd = np.empty(values.shape, np.bool_)
    native.library.write_numbers(
        values.ctypes.data, values.size, texts.ctypes.data, odd.ctypes.data
    )
    return odd
