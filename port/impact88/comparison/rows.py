"""Mistakes of a table, not of a program: order of rows, digits cut off, single precision."""

from collections.abc import Mapping

import numpy as np

from .evaluation import Floats
from .grading import Table
from .numbers import spread
from .spellings import VELOCITIES

MIN_COLUMNS = 4  # velocities that identify a row
MIN_ROWS = 4
MAX_ROWS = 50  # that are looked up
MIN_FRACTION = 0.9  # of the rows that hold another row's results
SINGLE_ROUNDING = 2.0**29  # of a rounding in double precision: 52 bits less 23


def mistake_of_table(table: Table, limits: Mapping[str, Floats]) -> str:
    """Return what is wrong with a table whose program is right, "" if that is not so.

    ``limits``: how far off the numbers of a program with a mistake may be.
    """
    if _are_other_rows(table, limits):
        return "the results are those of other rows: the order of the rows differs"
    if all(_is_cut(table, name) for name in table.disagreeing):
        return "the last digit is cut or rounded down, not rounded"
    if all(_is_single(table, name) for name in table.disagreeing):
        return "results are computed or written in single precision (float32)"
    return ""


def _are_other_rows(table: Table, limits: Mapping[str, Floats]) -> bool:
    """Return whether results are in other rows than their scenes."""
    names = [name for name in VELOCITIES if name in table.theirs]
    if len(names) < MIN_COLUMNS or table.wrong.sum() < MIN_ROWS:
        return False
    rows = spread(np.flatnonzero(table.wrong), MAX_ROWS)
    count = 0
    for row in rows:
        places = np.arange(table.size)
        for name in names:
            off = np.abs(table.ours[name][places] - table.theirs[name][row])
            places = places[off <= limits[name][row]]
        count += bool((places != row).any())
    return count >= MIN_FRACTION * rows.size


def _is_cut(table: Table, name: str) -> bool:
    """Return whether the last digit is cut, or rounded down: off by less than a unit, one way."""
    rows = table.misfit[name]
    off = ((table.ours[name] - table.theirs[name]) / table.units[name])[rows]
    towards_zero = off * np.sign(table.ours[name][rows])
    return any(bool(((x > 0) & (x < 1 + 1e-9)).all()) for x in (off, towards_zero))


@np.errstate(all="ignore")
def _is_single(table: Table, name: str) -> bool:
    """Return whether a column is in single precision, and off by no more than its rounding."""
    theirs, half_unit = table.theirs[name], table.units[name] / 2
    off = table.difference[name]
    is_close = off <= SINGLE_ROUNDING * table.reference.bounds[name] + half_unit
    is_single = np.abs(theirs - theirs.astype(np.float32)) <= half_unit
    return bool((is_close & is_single)[np.isfinite(off)].all())
