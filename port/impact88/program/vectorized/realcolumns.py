"""From the columns a caller gives to the stored reals the listing would have."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...collision.case import check_mapping
from ...errors import UserError
from ...names import DEFAULT_M, SCENE, VELOCITIES
from .reals import Floats, Packed, from_packed
from .textcolumns import read
from .unit import NEVER, Ints, Unit, key

_AT_A_TIME = 32768
"""Texts up to which all columns are read together: few calls for few, cache for many."""

PLACES = {
    name: (SCENE[name].line, i) for i, name in enumerate(dict.fromkeys([*VELOCITIES, *SCENE]))
}
"""Where the program reads each value: line, and position in it."""


class Scenes(NamedTuple):
    """Each name's values, of length 1 where all scenes share one; the number of scenes; and what
    reading recorded, see `Unit.first`."""

    values: dict[str, Floats]
    size: int
    first: Ints


def read_columns(columns: Mapping[str, Any]) -> Scenes:
    """Read all columns. Raises UserError for a missing or unknown name, lengths that do not agree,
    a text that is not a number, or values that are neither texts nor stored reals."""
    check_mapping(columns)
    unknown = [name for name in columns if name not in SCENE]
    if unknown:
        raise UserError(f"{unknown[0]!r} is not a value of a scene (expected {' '.join(SCENE)})")
    given = {"M": DEFAULT_M, **columns}
    missing = [name for name in SCENE if name not in given]
    if missing:
        raise UserError(f"missing {' '.join(missing)}")
    texts: dict[str, Sequence[str]] = {}
    packed: dict[str, Packed] = {}
    for name in SCENE:
        _sort_out(name, given[name], texts, packed)
    sizes = {name: len(column) for name, column in texts.items()}
    sizes |= {name: column.size for name, column in packed.items()}
    lengths = set(sizes.values()) - {1}
    if len(lengths) > 1:
        all_sizes = ", ".join(f"{name} {size}" for name, size in sizes.items() if size != 1)
        raise UserError(f"columns of different lengths: {all_sizes}")
    count = lengths.pop() if lengths else 1
    first = np.full(count, NEVER, np.int64)
    values = {name: from_packed(column, None).v for name, column in packed.items()}
    together = sum(sizes[name] for name in texts) <= _AT_A_TIME
    for group in [texts] if texts and together else [{name: texts[name]} for name in texts]:
        _read_texts(group, values, first)
    return Scenes(values, count, first)


def _read_texts(texts: dict[str, Sequence[str]], values: dict[str, Floats], first: Ints) -> None:
    """Read some columns of texts as one."""
    every, *others = texts.values()
    if others:
        every = [text for column in texts.values() for text in column]
    sizes = [len(column) for column in texts.values()]
    starts = np.concatenate([[0], np.cumsum(sizes)])
    unit = Unit(len(every))
    unit.place = np.repeat([key(*PLACES[name]) for name in texts], sizes)

    def where(index: int) -> str:
        column = int(np.searchsorted(starts, index, side="right")) - 1
        row = f", row {index - starts[column] + 1}" if sizes[column] > 1 else ""
        return list(texts)[column] + row

    x = read(every, unit, where).rounded()
    for name, start, size in zip(texts, starts, sizes, strict=False):
        values[name] = x.v[start : start + size]
        np.minimum(first, unit.first[start : start + size], out=first)


def _sort_out(
    name: str, column: Any, texts: dict[str, Sequence[str]], packed: dict[str, Packed]
) -> None:
    """Put a column with the texts or with the stored reals."""
    if isinstance(column, str):
        texts[name] = [column]
    elif isinstance(column, (list, tuple)) and column and isinstance(column[0], str):
        texts[name] = column
    else:
        try:
            array = np.asarray(column)
        except ValueError:
            raise UserError(f"{name} holds cells of several shapes") from None
        if array.ndim > 1:
            raise UserError(f"{name} has {array.ndim} dimensions; expected one value or a column")
        array = array.reshape(-1)
        if array.dtype == np.uint64:
            if (array >= np.uint64(1 << 40)).any():
                raise UserError(f"{name} has a stored real of more than five bytes")
            packed[name] = array
        elif array.dtype.kind == "i":
            texts[name] = [str(n) for n in array.tolist()]
        elif array.dtype.kind in "UO" and array.size:
            texts[name] = array.tolist()
        else:
            kind = array.dtype if array.size else "nothing"
            raise UserError(
                f"{name} is {kind}; expected decimal texts, whose digits count, or stored reals "
                "as uint64"
            )
