"""Variables and arrays: values by slot, the order they came into being, and the room they take.

A simple variable takes seven bytes, an array five, two for each dimension and its elements. Both
are made when something is assigned to them; merely reading a simple variable makes none. Arrays
follow the variables in memory, strings grow down from HIMEM towards them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from ..applesoft.errorcodes import ApplesoftError, illegal_quantity
from ..applesoft.real import ZERO, Number, compare, from_stored, integer, rounded, to_integer
from .strings import EMPTY, Descriptor, StringArea
from .symbols import ARRAYS, FUNCTION, INTEGER, REAL, SIMPLE, STRING

TOP_OF_MEMORY = 0xC000
"""48K: HIMEM without a disk system."""
VARIABLE_SIZE = 7
ARRAY_HEADER = 5
ELEMENT_SIZES = {REAL: 5, INTEGER: 2, STRING: 3}
AUTOMATIC = 11
"""Elements per dimension of an array that no DIM made."""
LOWEST = from_stored("9080000020")
"""The one number below -32767.99 that the ROM lets through: a little less than -32768."""


class Array(NamedTuple):
    """``sizes`` counts the elements per dimension; ``data`` has the first subscript fastest."""

    sizes: tuple[int, ...]
    data: list[Any]
    kind: str


class Function(NamedTuple):
    """What DEF FN made: the argument's slot, and the body as it was compiled there."""

    argument: int
    body: Any
    need: int


def blank(kind: str) -> Any:
    """What a variable never assigned reads as."""
    return EMPTY if kind == STRING else None if kind == FUNCTION else ZERO


class Variables:
    """All variables of a machine.

    ``values`` and ``arrays`` are lists by slot, the same objects for the machine's life; ``made``
    says which simple variables exist, ``order`` and ``array_order`` since when.
    """

    def __init__(self, ram: bytearray) -> None:
        self.values: list[Any] = []
        self.made = bytearray()
        self.arrays: list[Array | None] = []
        self.order: list[int] = []
        self.array_order: list[int] = []
        self.start = 0
        self.found_slot: int | None = None
        self._end = 0
        self._arrays_size = 0
        self.strings = StringArea(ram, TOP_OF_MEMORY, self.end_of_arrays, self._held)
        self.grow()

    def grow(self) -> None:
        """Make room for names that came up since."""
        for name in SIMPLE.names[len(self.values) :]:
            self.values.append(blank(name.kind))
            self.made.append(0)
        self.arrays += [None] * (len(ARRAYS) - len(self.arrays))

    def clear(self) -> None:
        """CLEAR: none left."""
        for slot in self.order:
            self.values[slot] = blank(SIMPLE.names[slot].kind)
            self.made[slot] = 0
        for slot in self.array_order:
            self.arrays[slot] = None
        self.order.clear()
        self.array_order.clear()
        self._end = self.start
        self._arrays_size = 0
        self.strings.clear()

    def put_start(self, address: int) -> None:
        """LOMEM: where the variables begin. Clears them."""
        self.start = address
        self.clear()

    def end_of_variables(self) -> int:
        """ARYTAB."""
        return self._end

    def end_of_arrays(self) -> int:
        """STREND."""
        return self._end + self._arrays_size

    def free(self) -> Number:
        """FRE: the room left, past 32767 as a negative number."""
        self.strings.collect()
        room = self.strings.bottom - self.end_of_arrays()
        return integer((room + 0x8000 & 0xFFFF) - 0x8000)

    def _held(self) -> Iterator[Descriptor]:
        """The descriptors that variables and arrays hold, in memory's order."""
        for slot in self.order:
            value = self.values[slot]
            if value.__class__ is Descriptor:
                yield value
        for slot in self.array_order:
            array = self.arrays[slot]
            if array is not None and array.kind == STRING:
                yield from array.data

    def descriptor_address(self, string: Descriptor) -> int:
        """Where the descriptor of a string variable or element lies; 0 for any other."""
        for slot in self.order:
            if self.values[slot] is string:
                return self.address_of(slot)
        start = self._end
        for slot in self.array_order:
            array = self.arrays[slot]
            assert array is not None
            start += ARRAY_HEADER + 2 * len(array.sizes)
            size = ELEMENT_SIZES[array.kind]
            if array.kind == STRING:
                for n, element in enumerate(array.data):
                    if element is string:
                        return start + size * n
            start += size * len(array.data)
        return 0

    def lies_at_page_end(self, slot: int) -> bool:
        """Whether a simple variable's value begins at the last byte of a page."""
        # variables take 7 bytes, and 183 * 7 is 1 modulo 256
        n = (0xFD - self.start) * 183 & 0xFF
        return n < len(self.order) and slot in self.order[n::0x100]

    def find(self, slot: int) -> int:
        """A simple variable is looked up; the ROM keeps its address."""
        self.found_slot = slot
        return slot

    def found_address(self) -> int:
        """The address of the value of the variable found last."""
        if self.found_slot is None or not self.made[self.found_slot]:
            return EMPTY.address
        return self.address_of(self.found_slot)

    def address_of(self, slot: int) -> int:
        """Where a simple variable's value lies."""
        return self.start + VARIABLE_SIZE * self.order.index(slot) + 2

    def _room(self, size: int) -> None:
        """Raises OUT OF MEMORY unless so much more fits between arrays and strings."""
        end = self.end_of_arrays() + size
        if end >= self.strings.bottom:
            self.strings.collect()
            if end >= self.strings.bottom:
                raise ApplesoftError("OUT OF MEMORY")

    # --- simple variables ---------------------------------------------------------------------

    def make(self, slot: int) -> None:
        """A simple variable comes into being, zero or empty. Raises OUT OF MEMORY."""
        self._room(VARIABLE_SIZE)
        self._end += VARIABLE_SIZE
        self.made[slot] = 1
        if self.values[slot] is EMPTY:
            self.values[slot] = Descriptor(0, 0)
        self.order.append(slot)

    def place(self, slot: int) -> tuple[list[Any], int]:
        """Where a simple variable's value is kept; makes it."""
        if not self.made[slot]:
            self.make(slot)
        return self.values, slot

    # --- arrays -------------------------------------------------------------------------------

    def dimension(self, slot: int, last: Sequence[int]) -> None:
        """DIM. Raises REDIM'D ARRAY and OUT OF MEMORY."""
        if self.arrays[slot] is not None:
            raise ApplesoftError("REDIM'D ARRAY")
        self._make_array(slot, [n + 1 for n in last])

    def _make_array(self, slot: int, sizes: Sequence[int]) -> Array:
        kind = ARRAYS.names[slot].kind
        header = ARRAY_HEADER + 2 * len(sizes)
        self._room(header)
        elements = 1
        for size in sizes:
            elements *= size
        size = header + elements * ELEMENT_SIZES[kind]
        self._room(size)
        self._arrays_size += size
        self.array_order.append(slot)
        nothing = Descriptor(0, 0) if kind == STRING else ZERO
        array = Array(tuple(sizes), [nothing] * elements, kind)
        self.arrays[slot] = array
        return array

    def element1(self, slot: int, i: int) -> tuple[list[Any], int]:
        """Where an element with one subscript is kept; makes the array. Raises BAD SUBSCRIPT."""
        array = self.arrays[slot]
        if array is None:
            array = self._make_array(slot, (AUTOMATIC,))
        sizes = array[0]
        if len(sizes) != 1 or i >= sizes[0]:
            raise ApplesoftError("BAD SUBSCRIPT")
        return array[1], i

    def element2(self, slot: int, i: int, j: int) -> tuple[list[Any], int]:
        """The same with two subscripts."""
        array = self.arrays[slot]
        if array is None:
            array = self._make_array(slot, (AUTOMATIC, AUTOMATIC))
        sizes = array[0]
        if len(sizes) != 2 or i >= sizes[0] or j >= sizes[1]:
            raise ApplesoftError("BAD SUBSCRIPT")
        return array[1], i + sizes[0] * j

    def element(self, slot: int, *subscripts: int) -> tuple[list[Any], int]:
        """The same with any number of subscripts."""
        array = self.arrays[slot]
        if array is None:
            array = self._make_array(slot, (AUTOMATIC,) * len(subscripts))
        sizes = array[0]
        if len(sizes) != len(subscripts):
            raise ApplesoftError("BAD SUBSCRIPT")
        index = 0
        for i, size in zip(reversed(subscripts), reversed(sizes), strict=True):
            if i >= size:
                raise ApplesoftError("BAD SUBSCRIPT")
            index = index * size + i
        return array[1], index

    def value1(self, slot: int, i: int) -> Any:
        """The value of an element with one subscript."""
        data, index = self.element1(slot, i)
        return data[index]

    def value2(self, slot: int, i: int, j: int) -> Any:
        """The value of an element with two subscripts."""
        array = self.arrays[slot]
        if array is None:
            array = self._make_array(slot, (AUTOMATIC, AUTOMATIC))
        sizes = array[0]
        if len(sizes) != 2 or i >= sizes[0] or j >= sizes[1]:
            raise ApplesoftError("BAD SUBSCRIPT")
        return array[1][i + sizes[0] * j]

    def value(self, slot: int, *subscripts: int) -> Any:
        """The value of any element."""
        data, index = self.element(slot, *subscripts)
        return data[index]


def whole(x: Number) -> Number:
    """What an integer variable stores: rounded to 32 bits, then down. Raises ILLEGAL QUANTITY from
    32768 and -32768 on.

    The ROM means to let -32768 through, but its constant has a bit too many: it lets through
    -32768.0005 only, which is stored as 32767.
    """
    x = rounded(x)
    if x[0] >= 0x90 and compare(LOWEST, x):
        raise illegal_quantity()
    return integer((to_integer(x) + 0x8000 & 0xFFFF) - 0x8000)


def subscript(x: Number) -> int:
    """A subscript: rounded down, 0 ... 32767. Raises ILLEGAL QUANTITY for a negative or larger one,
    however small its fraction."""
    e, m, s = x
    if s or e > 143:
        raise illegal_quantity()
    return m >> 168 - e


def byte(x: Number) -> int:
    """A value from 0 to 255, rounded down. Raises ILLEGAL QUANTITY."""
    n = subscript(x)
    if n > 255:
        raise illegal_quantity()
    return n


def address(x: Number) -> int:
    """A 16-bit address; a negative one counts from the top. Raises ILLEGAL QUANTITY past 65535."""
    if x[0] > 0x90:
        raise illegal_quantity()
    return to_integer(x) & 0xFFFF
