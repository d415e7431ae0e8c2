"""Whether another program's number agrees with ours, and how closely it must.

Each scene is judged by its own condition. A result agrees

* *to the double* when it is no farther off than rounding allows in the best of programs
  (`accuracy.errorbound`);
* *to the digits claimed* when it is the exact value rounded to the digits it is written with;
* *as elimination does* when it is no farther off than plain elimination in double precision may be
  in this scene. Elimination is as good as the condition number of the 6 by 6 matrix as it stands
  (masses, cosines and inertias side by side, not scaled): its forward error stays below unit
  roundoff times that number times the largest unknown. Measured on the vectors: at most 0.03 of it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..accuracy import errorbound
from ..accuracy.elimination import fill
from ..doubles import double, doubles
from ..errors import quoted
from ..names import FINAL_VELOCITIES
from ..tables.rows import Rows, one_per_row

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Columns = dict[str, Floats]

_SPINS = ("WAF", "WBF")


class Theirs(NamedTuple):
    """One column of another program's results: values, and the unit of the last digit written (0
    where it is written in binary, or with an exponent that leaves nothing)."""

    values: Floats
    units: Floats


@dataclass
class Slack:
    """How far results may be off, scene by scene, as a share of their ``sizes``.

    ``double``: for the best of programs; ``elimination``: for plain elimination in double;
    ``per_unit``: for plain elimination in other arithmetic, per unit roundoff."""

    sizes: Columns
    double: Floats
    elimination: Floats
    per_unit: Floats

    def part(self, rows: NDArray[np.intp]) -> Slack:
        """The slack of some of the scenes."""
        sizes = {name: column[rows] for name, column in self.sizes.items()}
        return Slack(sizes, self.double[rows], self.elimination[rows], self.per_unit[rows])


class Verdict(NamedTuple):
    """For one result: where it agrees to the double, to the digits claimed, as elimination does
    (each includes those before it), and the difference as a share of its size."""

    double: Bools
    digits: Bools
    elimination: Bools
    relative: Floats


_NOTHING = re.compile(
    r"|null|none|n/a|#[A-Z]+[/0-9A-Z]*[!?]?|[+-]?(nan|inf|infinity|1\.#[A-Z]+[0-9]*)(\([a-z0-9]*\))?",
    re.IGNORECASE,
)
"""What programs write where they have no result: spreadsheets' errors, C's -nan(ind), infinity."""
_WRITTEN = re.compile(r"[+-]?[0-9]*(?:\.([0-9]*))?(?:[eE]([+-]?[0-9]+))?")


def read_theirs(rows: Rows, name: str, factor: float = 1.0) -> Theirs:
    """A column of results, times ``factor`` in base units; an empty cell is NaN and counts as not
    given. What is no number is added to ``rows.bad``. Raises UserError for an array that has not a
    number for each row."""
    column = one_per_row(rows, name)
    if isinstance(column, np.ndarray) and column.dtype.kind in "fiu":
        return Theirs(column.astype(float) * factor, np.zeros(rows.count))
    texts = ["" if cell is None else str(cell).strip() for cell in column]
    there = [index for index, text in enumerate(texts) if not _NOTHING.fullmatch(text)]
    values, units = np.full(rows.count, np.nan), np.zeros(rows.count)
    try:
        values[there] = doubles([texts[index] for index in there])
    except ValueError:
        for index in there:
            try:
                values[index] = double(texts[index])
            except ValueError:
                reason = f"{quoted(texts[index])} is no number"
                rows.bad.append(rows.cell(index, name, reason))
    for index in there:
        written = _WRITTEN.fullmatch(texts[index])
        if written:
            decimals, exponent = written.groups(default="")
            power = float(exponent or 0) - len(decimals)
            units[index] = 10.0 ** min(300.0, max(power, -400.0))
    return Theirs(values * factor, units * factor)


def slack(scene: Columns, ours: Columns, rtol: float | None = None) -> Slack:
    """The slack of scenes with our results; ``rtol``: a user's own, for every scene alike."""
    sizes = errorbound.scales(scene, ours)
    best = errorbound.relative_bounds(ours["COND"], 1.0)
    with np.errstate(all="ignore"):
        condition = plain_condition(scene)
        unknowns = np.stack([np.abs(ours[name]) for name in FINAL_VELOCITIES])
        error = condition * np.nanmax(unknowns, axis=0, initial=0.0)
        shares = [error / sizes[name] for name in ("VAX", *_SPINS)]
        largest = np.nanmax(np.where(np.isfinite(shares), shares, 0.0), axis=0)
    per_unit = np.fmax(best, largest)
    if rtol is not None:
        alike = np.full(best.size, rtol)
        return Slack(sizes, alike, alike, per_unit)
    return Slack(sizes, best * errorbound.DOUBLE, per_unit * errorbound.DOUBLE, per_unit)


def plain_condition(scene: Columns) -> Floats:
    """The condition numbers (largest row sum) of the listing's matrices as they stand; infinite
    where there is no finite one. Point masses are bodies without arms that nothing turns."""
    point = scene["M"] == 4
    alone = {"DA": 0.0, "DB": 0.0, "EM": 1.0, "IA": 1.0, "IB": 1.0}
    changed = {name: np.where(point, value, scene[name]) for name, value in alone.items()}
    matrix, _ = fill({**scene, **changed})
    usable = np.asarray(np.isfinite(matrix).all(axis=(1, 2)))
    signs, _ = np.linalg.slogdet(np.where(usable[:, None, None], matrix, np.eye(6)))
    usable = usable & (signs != 0)
    inverse = np.linalg.inv(np.where(usable[:, None, None], matrix, np.eye(6)))
    condition = np.abs(matrix).sum(2).max(1) * np.abs(inverse).sum(2).max(1)
    return np.where(usable & np.isfinite(condition), condition, np.inf)


def judge(theirs: Theirs, ours: Floats, name: str, allowed: Slack) -> Verdict:
    """Where a result agrees."""
    size = allowed.sizes[name]
    with np.errstate(all="ignore"):
        off = np.abs(theirs.values - ours)
        last_bits = 2 * np.spacing(np.abs(ours))
        tight = allowed.double * size + last_bits
        loose = allowed.elimination * size + last_bits
        written = theirs.units * (0.5 + 1e-9)
        # nothing there to measure by: as a share of what they have
        measure = np.where(size > 0, size, np.abs(theirs.values))
        relative = np.minimum(np.where(off > 0, off / measure, 0.0), np.finfo(float).max)
        return Verdict(off <= tight, off <= written + tight, off <= written + loose, relative)


def given(theirs: Mapping[str, Theirs], ours: Columns) -> dict[str, Bools]:
    """Where both sides have a number."""
    return {
        name: np.isfinite(column.values) & np.isfinite(ours[name])
        for name, column in theirs.items()
    }
