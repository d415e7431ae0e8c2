"""Where pyarrow is met (extra ``arrow``): columns that stay in its memory, and its readers' errors.

Cells of a column of texts become Python strings only when they are looked at.
"""

from collections.abc import Iterator, Sequence
from importlib.util import find_spec
from typing import Any

import numpy as np
from numpy.typing import NDArray

_PLAIN = np.zeros(256, bool)
_PLAIN[np.frombuffer(b"0123456789+-.eE", np.uint8)] = True
"""Characters of which pyarrow makes a number only where INPUT makes the same one."""


def available() -> bool:
    """Whether pyarrow is installed."""
    return find_spec("pyarrow") is not None


class ArrowColumn(Sequence[Any]):
    """A column in pyarrow's memory; its cells are what Python makes of them."""

    def __init__(self, array: Any) -> None:
        self.array = array

    def __len__(self) -> int:
        return len(self.array)

    def __getitem__(self, index: Any) -> Any:
        return self.array[index].as_py()

    def __iter__(self) -> Iterator[Any]:
        return iter(self.array.to_pylist())


class ArrowTexts(ArrowColumn):
    """A column of texts without nulls."""

    def doubles(self) -> NDArray[np.float64] | None:
        """The doubles that the texts are, by the rule of `impact88.doubles`; None where a cell
        needs a closer look."""
        import pyarrow as pa

        data = self.array.buffers()[2]
        if data is None:
            return None
        # where each text begins among the characters, and where the last one ends
        offsets = self.array.buffers()[1]
        ends = np.frombuffer(offsets, np.int32, len(self.array) + 1, 4 * self.array.offset)
        characters = np.frombuffer(data, np.uint8)[ends[0] : ends[-1]]
        if not _PLAIN[characters].all():
            return None
        try:
            values: NDArray[np.float64] = self.array.cast(pa.float64()).to_numpy()
        except pa.ArrowInvalid:
            return None
        return values

    def replaced(self, old: str, new: str) -> "ArrowTexts":
        """The column with every ``old`` a ``new``."""
        from pyarrow import compute

        return ArrowTexts(compute.replace_substring(self.array, old, new))

    def filled(self, text: str) -> "ArrowTexts":
        """The column with ``text`` where there is none."""
        from pyarrow import compute

        return ArrowTexts(compute.if_else(compute.equal(self.array, ""), text, self.array))


def texts_of(values: NDArray[Any]) -> Any:
    """A pyarrow array of the texts `tables.rows.shortest` makes of an array."""
    import pyarrow as pa
    import pyarrow.compute as compute

    array = pa.array(values)
    if values.dtype.kind != "f":
        return array.cast(pa.string())
    texts = array.cast(pa.string())
    size = np.abs(values)
    # pyarrow has the same digits, but another idea of when to use an exponent, and writes 1 for 1.0
    other = (size < _POINT_FROM) | (size >= _POINT_TO) | (values == np.rint(values))
    if other.any():
        # by their bits: 0.0 equals -0.0
        different, where = np.unique(values[other].view(np.int64), return_inverse=True)
        written = pa.array(list(map(repr, different.view(np.float64).tolist())))
        texts = compute.replace_with_mask(texts, pa.array(other), written.take(pa.array(where)))
    return texts


_POINT_FROM, _POINT_TO = 1e-3, 1e10
"""Between these every version of it writes a number without an exponent, as Python does."""
