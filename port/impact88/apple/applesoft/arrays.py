"""Arrays of numbers with subscripts from 0, checked like in the ROM."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .errorcodes import ApplesoftError, illegal_quantity
from .operators import Real


def subscript(x: Any) -> int:
    """Return a subscript, rounded down, 0 ... 32767. Raises ILLEGAL QUANTITY."""
    if x.__class__ is Real:
        e, m, s = x.number
        if s or e > 143:
            raise illegal_quantity()
        return int(m >> 168 - e)
    if not 0 <= x < 32768:
        raise illegal_quantity()
    return int(x)


class Array:
    """``DIM NAME(m, n)`` or ``DIM NAME(m)``: elements from (0, 0), initially zero.

    ``store``: the function that rounds a stored value; ``data``: the elements, first subscript
    fastest; ``sizes``: their number per dimension. Raises BAD SUBSCRIPT."""

    def __init__(self, sizes: Sequence[Any], store: Any, zero: Any) -> None:
        self.sizes = [subscript(last) + 1 for last in sizes]
        self._store = store
        self._rows, self._columns = (*self.sizes, 1)[:2]
        self.data = [zero] * (self._rows * self._columns)

    def _at(self, place: tuple[Any, Any]) -> int:
        """Return the index of an element in ``data``. Raises BAD SUBSCRIPT."""
        i, j = place
        i = i if i.__class__ is int else subscript(i)
        j = j if j.__class__ is int else subscript(j)
        if i >= self._rows or j >= self._columns:
            raise ApplesoftError("BAD SUBSCRIPT")
        return i + self._rows * j

    def __getitem__(self, place: tuple[Any, Any]) -> Any:
        return self.data[self._at(place)]

    def __setitem__(self, place: tuple[Any, Any], value: Any) -> None:
        self.data[self._at(place)] = self._store(value)
