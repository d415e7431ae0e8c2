"""From the columns a caller gives to the stored reals the listing would have."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ..errors import UserError
from ..names import DEFAULT_M, SCENE, VELOCITIES
from .decimaltext import read
from .reals import Floats, from_packed
from .unit import Ints, Unit


def _input_places() -> dict[str, tuple[int, int]]:
    """Where the program reads each value: line, and position in it."""
    order = [*VELOCITIES, *(name for name in SCENE if name not in VELOCITIES)]
    return {name: (SCENE[name].line, i) for i, name in enumerate(order)}


PLACES = _input_places()


class Scenes(NamedTuple):
    """The scenes read: each name's values, of length 1 where all scenes share one; the number of
    scenes; and what reading recorded, see `Unit.first`."""

    values: dict[str, Floats]
    count: int
    first: Ints


def read_columns(columns: Mapping[str, Any]) -> Scenes:
    """Read all columns. Raises UserError for a missing or unknown name, lengths that do not agree,
    a text that is no number, or values that are neither texts nor stored reals."""
    unknown = [name for name in columns if name not in SCENE]
    if unknown:
        raise UserError(f"{unknown[0]!r} is no value of a scene (expected {' '.join(SCENE)})")
    given = {"M": DEFAULT_M, **columns}
    missing = [name for name in SCENE if name not in given]
    if missing:
        raise UserError(f"missing {' '.join(missing)}")
    arrays = {name: _array(name, given[name]) for name in SCENE}
    lengths = {array.size for array in arrays.values()} - {1}
    if len(lengths) > 1:
        sizes = ", ".join(f"{name} {array.size}" for name, array in arrays.items() if array.size > 1)
        raise UserError(f"columns of different lengths: {sizes}")
    count = lengths.pop() if lengths else 1
    unit = Unit(count)
    values = {}
    for name, array in arrays.items():
        own = Unit(array.size)
        own.at(*PLACES[name])
        if array.dtype == np.uint64:
            x = from_packed(array, own)
        else:
            x = read(array, own, name)
        values[name] = x.rounded().v
        np.minimum(unit.first, own.first, out=unit.first)
    return Scenes(values, count, unit.first)


def _array(name: str, column: Any) -> Any:
    """One column as a one-dimensional array of texts or of stored reals."""
    array = np.asarray(column)
    if array.ndim > 1:
        raise UserError(f"{name} has {array.ndim} dimensions; expected one value or a column")
    array = np.atleast_1d(array)
    kind = array.dtype.kind
    if kind == "i":
        array = array.astype(np.str_)
    elif kind == "O" and all(isinstance(text, str) for text in array):
        array = array.astype(np.str_)
    elif array.dtype == np.uint64:
        if (array >= np.uint64(1 << 40)).any():
            raise UserError(f"{name} has a stored real of more than five bytes")
    elif kind != "U":
        raise UserError(
            f"{name} is of type {array.dtype}; expected decimal texts, whose digits count, "
            "or stored reals as uint64"
        )
    return array

