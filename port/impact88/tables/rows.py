"""Rows of a table of scenes, between a file's format and an arithmetic.

Numbers stay the decimal text they are written as until an arithmetic reads them.
"""

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError, quoted
from ..names import RESULTS, SCENE

Column = Sequence[Any] | NDArray[Any]
Named = Sequence[tuple[str, Column]]
"""A block's columns, each with its name."""
Put = Callable[[Named], None]

_PLAIN = np.zeros(256, bool)
_PLAIN[np.frombuffer(b"0123456789+-.eE", np.uint8)] = True
"""Characters of which pyarrow makes a number only where INPUT makes the same one."""
BLOCK_ROWS = 16384
"""Rows read, solved and written together, unless they are very long: two arrays of them fit a
second-level cache. JSON Lines and Parquet take as long with half and with four times as many."""
BLOCK_CHARACTERS = 8_000_000
BLOCK_CELLS = 2_000_000
"""Characters of text, and cells, after which a block ends: they bound the memory, not the time."""


class _Absent(str):
    """Cell of a row that lacks the key; an empty text to everybody else."""

    __slots__ = ()


ABSENT = _Absent()


class ArrowColumn(Sequence[Any]):
    """A column in pyarrow's memory (extra ``arrow``); cells become Python's when looked at."""

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
        """The doubles that the texts are, by the rule of `collision.doubles`; None where a cell
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

    def among(self, places: NDArray[np.intp]) -> set[str]:
        """The different texts at some places."""
        import pyarrow as pa

        return set(self.array.take(pa.array(places)).unique().to_pylist())

    def replaced(self, old: str, new: str) -> "ArrowTexts":
        """The column with every ``old`` a ``new``."""
        from pyarrow import compute

        return ArrowTexts(compute.replace_substring(self.array, old, new))

    def with_default(self, text: str) -> "ArrowTexts":
        """The column with ``text`` where there is none."""
        from pyarrow import compute

        return ArrowTexts(compute.if_else(compute.equal(self.array, ""), text, self.array))


class BadCell(NamedTuple):
    """Reason why a row cannot be used.

    Parameters
    ----------
    row, line : int
        Its number among the rows, from 1, and its line in the file, 0 without one.
    column : str
        The column at fault, "" for the row as a whole.
    reason : str
        What is wrong.
    """

    row: int
    line: int
    column: str
    reason: str

    def __str__(self) -> str:
        place = f"row {self.row}" + (f" (line {self.line})" if self.line else "")
        return f"{place}{', ' + self.column if self.column else ''}: {self.reason}"


@dataclass
class Rows:
    """Some rows of a table. ``columns``: by name, texts (None where the row has none, `ABSENT`
    where it lacks the key) or an array; ``lines``: the file's line of each row, if it has lines;
    ``bad``: rows that cannot be used, each as its index, the column at fault and the reason;
    ``late``: columns that the table's first rows did not have, and the line of each; ``whole``:
    names of arrays that have no cell for each row; ``first``: the number of the first row, from 1;
    ``place``: how far the table is read after them."""

    count: int
    columns: dict[str, Column]
    lines: Sequence[int] | None = None
    bad: list[tuple[int, str, str]] = field(default_factory=list)
    late: dict[str, int] = field(default_factory=dict)
    whole: Collection[str] = ()
    first: int = 1
    place: int = 0

    def scene(self) -> dict[str, Column]:
        """The columns that are the scene's."""
        return {name: column for name, column in self.columns.items() if name in SCENE}

    def one_per_row(self, name: str) -> Column:
        """A column with a cell for each row. Raises UserError for an array that has not as many."""
        column = self.columns.get(name)
        if column is None:
            return [ABSENT] * self.count  # no row of this block has the key
        if not isinstance(column, np.ndarray):
            return column
        if column.size == 1:
            return np.broadcast_to(column.reshape(-1), (self.count,))
        if name in self.whole or column.shape != (self.count,):
            shape = " by ".join(map(str, column.shape))
            raise UserError(
                f"{quoted(name)} is an array of {shape}, not a column; "
                "expected a cell for each row (only .npz results hold it as it is)"
            )
        return column

    def without_first(self) -> "Rows":
        """The rows after the first one."""
        columns = {
            name: ArrowTexts(column.array.slice(1))
            if isinstance(column, ArrowTexts)
            else column[1:]
            for name, column in self.columns.items()
        }
        bad = [(at - 1, column, reason) for at, column, reason in self.bad if at]
        return Rows(self.count - 1, columns, self.lines[1:] if self.lines else None, bad)

    def complaints(self) -> list[BadCell]:
        """Return the bad cells, by the rows' numbers and lines."""
        lines = self.lines
        return [BadCell(self.first + at, lines[at] if lines else 0, *why) for at, *why in self.bad]


@dataclass
class Reader:
    """An open table; iterating it yields `Rows`. ``names``: its columns (of JSON Lines, those of
    the first row); ``total``: its size in the units of ``position``, which are rows unless a format
    has its own (None: unknown); ``delimiter``: between a CSV's fields; ``place``: where in its file
    the table stands, where a file may hold several (``{"sheet": "Rows", "row": 3}``); ``remarks``:
    what a user should know of how the table was read."""

    names: list[str]
    blocks: Iterable[Rows]
    total: int | None = None
    position: Callable[[], int] | None = None
    delimiter: str = ","
    place: dict[str, Any] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)

    def __iter__(self) -> Iterator[Rows]:
        read = 0
        for rows in self.blocks:
            rows.first = read + 1
            read += rows.count
            rows.place = self.position() if self.position else read
            yield rows


class Heading(str):
    """A column's name, with the heading that is ``written`` over it and the ``unit`` that names."""

    written: str
    unit: str

    def __new__(cls, name: str, written: str, unit: str = "") -> "Heading":
        made = super().__new__(cls, name)
        made.written, made.unit = written, unit
        return made


def heading(name: str) -> str:
    """Return the heading written over a column."""
    return getattr(name, "written", name)


_UNIT = re.compile(r"(.*?)\s*(?:\[([^]]*)\]|\(([^)]*)\))\s*")


def _taken_apart(text: str) -> tuple[str, str]:
    """A heading's name and its unit."""
    match = _UNIT.fullmatch(text)
    return (match[1].strip(), (match[2] or match[3] or "").strip()) if match else (text.strip(), "")


def scene_names(names: Sequence[str], where: str | None = None, results: bool = False) -> list[str]:
    """The names of a table's columns: those in small letters, or with a unit behind them (``Mu
    [1]``), are the scene's or a result's names where the table has no such column otherwise; a
    result's without a unit only where ``results`` are read, since elsewhere it may be anything
    (``pm``). Raises UserError for two columns that would be one, and, where the table has a name
    (``where``), for two of the same heading."""
    present = set(names)
    columns: list[str] = []
    sources: dict[str, str] = {}
    for name in names:
        text, unit = _taken_apart(name)
        bare = text.upper()
        is_kept = bare in present or not (
            bare in SCENE or (bare in RESULTS and (results or bool(unit)))
        )
        if bare in sources and bare not in present and (bare in SCENE or results):
            first = heading(sources[bare])
            says = f"columns {quoted(first)} and {quoted(name)} are both {bare}; expected one"
            raise UserError(says, where or "")
        is_kept = is_kept or bare in sources
        columns.append(name if is_kept else Heading(bare, name, unit))
        sources.setdefault(columns[-1], columns[-1])
    twice = next((name for name, count in Counter(columns).items() if count > 1), None)
    if where is not None and twice is not None:
        raise UserError(f"has two columns named {quoted(twice)}", where)
    return columns


def names_among(texts: Sequence[str], results: bool = False) -> int:
    """Count the texts that are headings of a scene's columns, or of results', where these are
    read."""
    bare_names = {_taken_apart(text)[0].upper() for text in texts}
    return len(bare_names & ({*SCENE, *RESULTS} if results else {*SCENE}))


def heading_remarks(names: Sequence[str], results: bool = False) -> list[str]:
    """Return remarks on how headings were understood: which are names in other letters,
    and which stand beside the column that is read."""
    remarks: list[str] = []
    present = set(names)
    names_read = [name for name in names if _taken_apart(heading(name))[0] != name.strip()]
    names_read = [name for name in names_read if isinstance(name, Heading)]
    if names_read:
        remarks.append(
            f"columns {' '.join(map(heading, names_read))} are read as {' '.join(names_read)}"
        )
    for name in names:
        bare = _taken_apart(name)[0].upper()
        if bare != name and bare in present and (bare in SCENE or (results and bare in RESULTS)):
            remarks.append(f"column {quoted(name)} is not read: there is {bare}, too")
    return remarks


def shortest(values: NDArray[Any]) -> list[str]:
    """Floats in the fewest digits that read back exactly; anything else as str writes it."""
    return list(map(repr if values.dtype.kind == "f" else str, values.tolist()))
