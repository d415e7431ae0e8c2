"""Where variables and arrays lie in memory, and the bytes of their values.

A simple variable: two bytes of name, five of value. An array: two of name, two of length, the
number of dimensions, each dimension's size with the last first and the high byte first, then its
elements. A string's value is its length and where its characters lie.
"""

from __future__ import annotations

from typing import Any

from ..applesoft.real import from_stored, integer, to_integer, to_stored
from .strings import Descriptor
from .symbols import ARRAYS, FUNCTION, INTEGER, REAL, SIMPLE
from .variables import ARRAY_HEADER, ELEMENT_SIZES, VARIABLE_SIZE, Variables

VALUE_SIZE = 5


class Field:
    """One value, or the bytes before values (``kind`` None), from ``start`` on."""

    def __init__(
        self, start: int, head: bytes, values: list[Any], index: int, kind: str | None
    ) -> None:
        self.start = start
        self._head = head
        self._values = values
        self._index = index
        self._kind = kind

    def _bytes(self) -> bytes:
        if self._kind is None:
            return self._head
        return self._head + value_bytes(self._values[self._index], self._kind)

    def read(self, address: int) -> int:
        """The byte at an address."""
        offset = address - self.start
        data = self._bytes()
        return data[offset] if offset < len(data) else 0

    def write(self, address: int, byte: int) -> None:
        """Change a byte of the value; names and sizes stay as they are."""
        offset = address - self.start - len(self._head)
        if self._kind is None or offset < 0:
            return
        old = self._values[self._index]
        changed = bytearray(value_bytes(old, self._kind).ljust(VALUE_SIZE, b"\0"))
        changed[offset] = byte
        self._values[self._index] = value_of(old, self._kind, bytes(changed))


def value_bytes(value: Any, kind: str) -> bytes:
    """A value as it lies in memory."""
    if kind == REAL:
        return to_stored(value)
    if kind == INTEGER:
        return (to_integer(value) & 0xFFFF).to_bytes(2, "big")
    if kind == FUNCTION:
        return bytes(VALUE_SIZE)
    return bytes((value.length,)) + value.address.to_bytes(2, "little")


def value_of(old: Any, kind: str, changed: bytes) -> Any:
    """The value that changed bytes stand for."""
    if kind == REAL:
        return from_stored(changed[:5])
    if kind == INTEGER:
        return integer(int.from_bytes(changed[:2], "big", signed=True))
    if kind == FUNCTION:
        return old
    return Descriptor(changed[0], int.from_bytes(changed[1:3], "little"))


def field_at(variables: Variables, address: int) -> Field | None:
    """What lies at an address among the variables and arrays, None outside them."""
    if not variables.start <= address < variables.end_of_arrays():
        return None
    index, offset = divmod(address - variables.start, VARIABLE_SIZE)
    if index < len(variables.order):
        slot = variables.order[index]
        name = SIMPLE.names[slot]
        return Field(address - offset, name.stored(), variables.values, slot, name.kind)
    start = variables.end_of_variables()
    for slot in variables.array_order:
        array = variables.arrays[slot]
        assert array is not None
        size = ELEMENT_SIZES[array.kind]
        head = bytes((len(array.sizes),))
        head += b"".join(n.to_bytes(2, "big") for n in reversed(array.sizes))
        elements = start + ARRAY_HEADER - 1 + len(head)
        end = elements + size * len(array.data)
        if address < elements:
            length = (end - start).to_bytes(2, "little")
            return Field(start, ARRAYS.names[slot].stored() + length + head, [], 0, None)
        if address < end:
            index, offset = divmod(address - elements, size)
            return Field(address - offset, b"", array.data, index, array.kind)
        start = end
    return None
