"""Remarks on what is hardly meant in a table (`collision.plausibility`): a remark a column, with
the number of rows it is about and the first of them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..collision.plausibility import implausible
from ..collision.units import System

Floats = NDArray[np.float64]
Cells = Callable[[str, int], str]
"""The text of a column's cell, as it stands in the table."""
COURSES_SAMPLED = 1000
"""Rows of an array whose courses are looked at where not all are: as many spread evenly."""
_STRIP = 16384
"""Rows looked at together: they stay in cache."""


@dataclass
class Remark:
    """A remark on ``rows`` rows of a table, the ``first`` of which ``text`` is about."""

    rows: int
    first: int
    text: str

    @property
    def more(self) -> str:
        """Number of rows beside the first."""
        other_rows = self.rows - 1
        return f" and {other_rows:,} more row{'s' * (other_rows > 1)}" if other_rows else ""


@np.errstate(all="ignore")
def remarks(
    columns: Mapping[str, Floats], system: System, cells: Cells, every: bool = True
) -> dict[str, Remark]:
    """Return, by name, what of a table's rows is hardly meant.

    Parameters
    ----------
    columns
        The scene's columns in base units and the listing's axes, of one value or of one a row.
    system
        What the table is in; sizes are looked at where it has units.
    cells
        The text of a cell.
    every
        Look at every row's courses; else at `COURSES_SAMPLED` of them, and at all where one is
        amiss.
    """
    flat = {name: np.ravel(column) for name, column in columns.items()}
    if not all(column.size for column in flat.values()):
        return {}
    count = max(map(len, flat.values()))
    flat = {name: column for name, column in flat.items() if len(column) in (1, count)}
    if not every and count > COURSES_SAMPLED:
        evenly = _rows_of(flat, np.linspace(0, count - 1, COURSES_SAMPLED).astype(np.int64))
        sampled_remarks = implausible(evenly, _courses(evenly), system, {})
        amiss = {name for name, mask, *_ in sampled_remarks if np.any(mask)}
        flat = {n: column for n, column in flat.items() if n not in ("TA", "TB") or n in amiss}
    table_remarks: dict[str, Remark] = {}
    for start in range(0, count, _STRIP):
        strip = _rows_of(flat, slice(start, start + _STRIP))
        shape = (min(_STRIP, count - start),)
        for name, mask, words, amount in implausible(strip, _courses(strip), system, {}):
            mask = np.broadcast_to(mask, shape)
            if not (rows := int(np.count_nonzero(mask))):
                continue
            if name in table_remarks:
                table_remarks[name].rows += rows
                continue
            at = int(mask.argmax())
            entry = f"{name} = {cells(name, start + at)}"
            text = words.format(entry=entry, amount=np.broadcast_to(amount, shape)[at])
            table_remarks[name] = Remark(rows, start + at, text)
    return table_remarks


def _rows_of(columns: Mapping[str, Floats], rows: slice | NDArray[np.int64]) -> dict[str, Floats]:
    """Some rows of the columns; those of one value whole."""
    return {name: c if len(c) == 1 else c[rows] for name, c in columns.items()}


def _courses(columns: Mapping[str, Floats]) -> dict[str, Floats]:
    """Courses of the vehicles whose heading is known, in degrees; NaN of those at rest."""
    courses = {}
    for vehicle, x, y in (("A", "UX", "UY"), ("B", "VX", "VY")):
        if {x, y, f"T{vehicle}"} <= columns.keys():
            course = np.degrees(np.arctan2(columns[y], columns[x]))
            courses[vehicle] = np.where((columns[x] == 0) & (columns[y] == 0), np.nan, course)
    return courses
