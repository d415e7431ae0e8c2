"""The caller's columns, read as the stored reals that the listing would have."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...collision.case import check_mapping
from ...errors import UserError
from ...names import DEFAULT_M, SCENE, VELOCITIES
from .blockerrors import NEVER, BlockErrors, Ints, key
from .reals import Floats, Packed, from_packed
from .textcolumns import MAX_TEXTS, read

PLACES = {
    name: (SCENE[name].line, i) for i, name in enumerate(dict.fromkeys([*VELOCITIES, *SCENE]))
}
"""Name -> line at which the program reads the value, and position among all values."""


class Scenes(NamedTuple):
    """The scenes to replay.

    ``values``: by name, of length 1 if all scenes share one; ``size``: the number of scenes;
    ``first``: errors recorded while reading, see `BlockErrors.first`."""

    values: dict[str, Floats]
    size: int
    first: Ints


def read_columns(columns: Mapping[str, Any]) -> Scenes:
    """Read all columns. Raises UserError for a missing or unknown name, columns of different
    lengths, a text that is not a number, or values that are neither texts nor stored reals."""
    check_mapping(columns)
    unknown = [name for name in columns if name not in SCENE]
    if unknown:
        raise UserError(f"{unknown[0]!r} is not a value of a scene (expected {' '.join(SCENE)})")
    all_columns = {"M": DEFAULT_M, **columns}
    missing = [name for name in SCENE if name not in all_columns]
    if missing:
        raise UserError(f"missing {' '.join(missing)}")
    texts: dict[str, Sequence[str]] = {}
    packed_columns: dict[str, Packed] = {}
    for name in SCENE:
        _sort_out(name, all_columns[name], texts, packed_columns)
    sizes = {name: len(column) for name, column in texts.items()}
    sizes |= {name: column.size for name, column in packed_columns.items()}
    lengths = set(sizes.values()) - {1}
    if len(lengths) > 1:
        all_sizes = ", ".join(f"{name} {size}" for name, size in sizes.items() if size != 1)
        raise UserError(f"columns of different lengths: {all_sizes}")
    count = lengths.pop() if lengths else 1
    first = np.full(count, NEVER, np.int64)
    values = {name: from_packed(column, None).v for name, column in packed_columns.items()}
    text_names, together = [*texts], max(1, MAX_TEXTS // max(count, 1))
    for at in range(0, len(texts), together):
        _read_texts({name: texts[name] for name in text_names[at : at + together]}, values, first)
    return Scenes(values, count, first)


def _read_texts(texts: dict[str, Sequence[str]], values: dict[str, Floats], first: Ints) -> None:
    """Read columns of texts in one call; add their reals to ``values``, their errors to
    ``first``."""
    cells, *other_columns = texts.values()
    if other_columns:
        cells = [text for column in texts.values() for text in column]
    sizes = [len(column) for column in texts.values()]
    starts = np.concatenate([[0], np.cumsum(sizes)])
    errors = BlockErrors(len(cells))
    errors.place = np.repeat([key(*PLACES[name]) for name in texts], sizes)

    def place_of(index: int) -> str:
        column = int(np.searchsorted(starts, index, side="right")) - 1
        row = f", row {index - starts[column] + 1}" if sizes[column] > 1 else ""
        return list(texts)[column] + row

    x = read(cells, errors, place_of).rounded()
    for name, start, size in zip(texts, starts, sizes, strict=False):
        values[name] = x.v[start : start + size]
        np.minimum(first, errors.first[start : start + size], out=first)


def _sort_out(
    name: str, column: Any, texts: dict[str, Sequence[str]], packed: dict[str, Packed]
) -> None:
    """Add a column to ``texts`` or, as stored reals, to ``packed``. Raises UserError."""
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
