"""Mistakes of a table, not of a program: order of rows, digits cut off, single precision."""

from collections.abc import Mapping

import numpy as np

from .agreement import Bools
from .evaluation import Floats
from .numbers import spread
from .spellings import VELOCITIES

MIN_COLUMNS = 4  # velocities that identify a row
MIN_ROWS = 4
MAX_ROWS = 50  # that are looked up
MIN_FRACTION = 0.9  # of the rows that hold another row's results
SINGLE_ROUNDING = 2.0**29  # of a rounding in double precision: 52 bits less 23


def other_rows(
    ours: Mapping[str, Floats],
    theirs: Mapping[str, Floats],
    limits: Mapping[str, Floats],
    wrong: Bools,
) -> str:
    """Return how results are in other rows than their scenes, "" if they are not."""
    names = [name for name in VELOCITIES if name in theirs]
    if len(names) < MIN_COLUMNS or wrong.sum() < MIN_ROWS:
        return ""
    rows = spread(np.flatnonzero(wrong), MAX_ROWS)
    count = 0
    for row in rows:
        places = np.arange(wrong.size)
        for name in names:
            off = np.abs(ours[name][places] - theirs[name][row])
            places = places[off <= limits[name][row]]
        count += bool((places != row).any())
    if count < MIN_FRACTION * rows.size:
        return ""
    return "the results are those of other rows: the order of the rows differs"


def cut_digits(ours: Floats, theirs: Floats, units: Floats, wrong: Bools) -> bool:
    """Return whether the last digit is cut, not rounded: off by less than a unit, towards 0."""
    off = ((ours - theirs) * np.sign(ours))[wrong]
    unit = units[wrong]
    return bool(((unit > 0) & (off > 0) & (off < unit * (1 + 1e-9))).all())


def single_precision(ours: Floats, theirs: Floats, bounds: Floats, units: Floats) -> bool:
    """Return whether a column is in single precision, and off by no more than its rounding.

    ``bounds`` is what rounding may change in double precision.
    """
    is_number = np.isfinite(ours) & np.isfinite(theirs)
    with np.errstate(all="ignore"):
        close = np.abs(theirs - ours) <= SINGLE_ROUNDING * bounds + units / 2
        single = np.abs(theirs - theirs.astype(np.float32)) <= units / 2
    return bool((close & single)[is_number].all())
