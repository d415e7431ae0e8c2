"""Where variables and arrays lie in memory, and the bytes of their values.

A simple variable: two bytes of name, five of value. An array: two of name, two of length, the
number of dimensions, each dimension's size with the last first and the high byte first, then its
elements. A string's value is its length and where its characters lie: in the program's text, or in
the string area. There strings are laid out from HIMEM down in the order of their variables, as they
are when each was made once and none was dropped; the real order depends on the past.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from ..applesoft.real import from_stored, integer, to_integer, to_stored
from .strings import Literal
from .symbols import ARRAYS, FUNCTION, INTEGER, REAL, SIMPLE
from .variables import ARRAY_HEADER, ELEMENT_SIZES, VARIABLE_SIZE, Variables

VALUE_SIZE = 5
Locate = Callable[[str], int]
"""Where a string's characters lie."""


class Field:
    """One value, or the bytes before values (``kind`` None), from ``start`` on."""

    def __init__(
        self,
        start: int,
        head: bytes,
        values: list[Any],
        index: int,
        kind: str | None,
        locate: Locate,
    ) -> None:
        self.start = start
        self._head = head
        self._values = values
        self._index = index
        self._kind = kind
        self._locate = locate

    def _bytes(self) -> bytes:
        if self._kind is None:
            return self._head
        return self._head + value_bytes(self._values[self._index], self._kind, self._locate)

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
        changed = bytearray(value_bytes(old, self._kind, self._locate).ljust(VALUE_SIZE, b"\0"))
        changed[offset] = byte
        self._values[self._index] = value_of(old, self._kind, bytes(changed))


def value_bytes(value: Any, kind: str, locate: Locate) -> bytes:
    """A value as it lies in memory."""
    if kind == REAL:
        return to_stored(value)
    if kind == INTEGER:
        return (to_integer(value) & 0xFFFF).to_bytes(2, "big")
    if kind == FUNCTION:
        return bytes(VALUE_SIZE)
    return bytes((len(value),)) + locate(value).to_bytes(2, "little")


def value_of(old: Any, kind: str, changed: bytes) -> Any:
    """The value that changed bytes stand for."""
    if kind == REAL:
        return from_stored(changed[:5])
    if kind == INTEGER:
        return integer(int.from_bytes(changed[:2], "big", signed=True))
    if kind == FUNCTION:
        return old
    return Literal(old[: changed[0]].ljust(changed[0], "\0"))


def field_at(variables: Variables, address: int, locate: Locate) -> Field | None:
    """What lies at an address among the variables and arrays, None outside them."""
    if not variables.start <= address < variables.end_of_arrays():
        return None
    index, offset = divmod(address - variables.start, VARIABLE_SIZE)
    if index < len(variables.order):
        slot = variables.order[index]
        name = SIMPLE.names[slot]
        return Field(address - offset, name.stored(), variables.values, slot, name.kind, locate)
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
            return Field(start, ARRAYS.names[slot].stored() + length + head, [], 0, None, locate)
        if address < end:
            index, offset = divmod(address - elements, size)
            return Field(address - offset, b"", array.data, index, array.kind, locate)
        start = end
    return None


def strings_in_memory(variables: Variables) -> Iterator[tuple[int, str]]:
    """Address and text of every string in the string area, from the top down."""
    at = variables.strings.top
    values = [variables.values[slot] for slot in variables.order]
    for slot in variables.array_order:
        array = variables.arrays[slot]
        values += array.data if array is not None else []
    for value in values:
        if value.__class__ is str and value:
            at -= len(value)
            yield at, value


def string_address(variables: Variables, image: bytes, start: int, text: str) -> int:
    """Where a string's characters lie; ``image`` is the program's text, from ``start`` on."""
    if text.__class__ is str:
        return next((at & 0xFFFF for at, other in strings_in_memory(variables) if other is text), 0)
    data = text.encode("latin-1", "replace")
    quoted = image.find(b'"' + data)
    at = quoted + 1 if quoted >= 0 else image.find(data)
    return start + at if text and at >= 0 else 0
