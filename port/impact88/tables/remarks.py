"""Remarks on what is hardly meant in a table (`collision.plausibility`), by columns: a remark a
rule, with the number of rows it is about and the first of them."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..collision.estimates import CARS, weight_line
from ..collision.plausibility import (
    BEYOND_ARM,
    INERTIA_RATIO,
    MAX_ARM,
    MEASURES,
    ONE_SPIN,
    VELOCITY_NAMES,
    inertia_words,
    is_sideways,
    rule_of_name,
    sideways_words,
)
from ..collision.units import System

Floats = NDArray[np.float64]
Where = NDArray[np.bool_]
Cells = Callable[[str, int], str]
"""The text of a column's cell, as it stands in the table."""
COURSES = 1000
"""Rows of an array whose courses are looked at where not all are: as many spread evenly."""
_SIZED = ("DA", "DB", "IA", "IB")
"""Columns whose sizes are looked at, beside masses and speeds."""
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
        Look at every row's courses; else at `COURSES` of them, and at all where one is amiss.
    """
    flat = {name: np.ascontiguousarray(np.ravel(column)) for name, column in columns.items()}
    if not all(column.size for column in flat.values()):
        return {}
    count = max(map(len, flat.values()))
    flat = {name: column for name, column in flat.items() if len(column) in (1, count)}
    names = [name for name in flat if name in ("M", "EM")]
    if not system.is_bare:
        names += [name for name in flat if rule_of_name(name) in MEASURES or name in _SIZED]
    limits = {name: (float(flat[name].min()), float(flat[name].max())) for name in names}
    table = _Table(flat, limits, system, cells, count)
    sizes = {} if system.is_bare else dict(table.sizes())
    return {**sizes, **dict(table.sideways(every)), **dict(table.one_spin())}


@dataclass
class _Table:
    """Columns, the least and the largest number of each, and how they are shown."""

    columns: Mapping[str, Floats]
    limits: Mapping[str, tuple[float, float]]
    system: System
    cells: Cells
    count: int

    def _bodies(self) -> Where | bool:
        """Mask of the rows whose vehicles have a size: M is not 4."""
        M = self.columns.get("M")
        return True if M is None or self.limits["M"] == (6.0, 6.0) else M != 4

    def _remark(self, name: str, where: Any, text: str) -> Iterator[tuple[str, Remark]]:
        """A remark on a column, where there are such rows."""
        spread = np.broadcast_to(where, (self.count,))
        if rows := int(np.count_nonzero(spread)):
            first = int(spread.argmax())
            yield name, Remark(rows, first, f"{name} = {self.cells(name, first)}: {text}")

    def sizes(self) -> Iterator[tuple[str, Remark]]:
        """Remarks on masses, speeds, arms and inertias."""
        for name, (least, highest) in self.limits.items():
            rule, values = rule_of_name(name), self.columns[name]
            arm = name in ("DA", "DB")
            if rule in MEASURES:
                low, high, words = MEASURES[rule]
                scale = float(self.system.scale(rule))
            elif arm:
                high = MAX_ARM
                low, scale, words = -high, float(self.system.scale("length")), BEYOND_ARM
            else:
                continue
            if low <= least * scale and highest * scale <= high:
                continue
            sizes = values * scale
            outliers = np.isfinite(sizes) & ~((low <= sizes) & (sizes <= high))
            if rule == "mass":
                outliers &= sizes > 0  # others are refused, or end the program
            yield from self._remark(name, outliers & self._bodies() if arm else outliers, words)
        for vehicle in "AB":
            yield from self._inertias(vehicle)

    def _inertias(self, vehicle: str) -> Iterator[tuple[str, Remark]]:
        """A remark on inertias that are not the rule's, nearly, where the weight is a car's."""
        name, mass = f"I{vehicle}", f"M{vehicle}"
        if not {name, mass} <= self.limits.keys():
            return
        (least, highest), (lightest, heaviest) = self.limits[name], self.limits[mass]
        low, high = INERTIA_RATIO
        smallest = weight_line(lightest, self.system)[1] if lightest > 0 else 0.0
        largest = weight_line(heaviest, self.system)[1]
        if low * largest <= least and highest <= high * smallest:
            return
        masses, inertias = self.columns[mass], self.columns[name]
        parts = [_ratios(strip, self.system) for strip in _strips(masses, inertias)]
        ratios = np.concatenate(parts)
        outliers = ~((low <= ratios) & (ratios <= high)) & ~np.isnan(ratios) & self._bodies()
        for _, remark in self._remark(name, outliers, ""):
            ratio = float(ratios[remark.first % len(ratios)])
            remark.text = inertia_words(name, self.cells(name, remark.first), ratio)
            yield name, remark

    def sideways(self, every: bool) -> Iterator[tuple[str, Remark]]:
        """Remarks on vehicles that move sideways or backwards."""
        for vehicle, (x, y, *_) in VELOCITY_NAMES.items():
            name = f"T{vehicle}"
            if not {x, y, name} <= self.columns.keys():
                continue
            columns = [self.columns[x], self.columns[y], self.columns[name]]
            turn = 180.0 if vehicle == "A" else 0.0
            rows = max(map(len, columns))
            if not every and rows > COURSES:
                evenly = np.linspace(0, rows - 1, COURSES).astype(np.int64)
                strip = [column if len(column) == 1 else column[evenly] for column in columns]
                if not is_sideways(_off_course(strip, turn)).any():
                    continue
            apart = np.concatenate([_off_course(strip, turn) for strip in _strips(*columns)])
            is_off = is_sideways(apart) & self._bodies()
            for _, remark in self._remark(name, is_off, ""):
                remark.text = sideways_words(vehicle, float(apart[remark.first % len(apart)]))
                yield name, remark

    def one_spin(self) -> Iterator[tuple[str, Remark]]:
        """A remark on EM = 0."""
        least, highest = self.limits.get("EM", (1.0, 1.0))
        if not (least > 0 or highest < 0):  # NaN where there is one
            is_zero = (self.columns["EM"] == 0) & self._bodies()
            yield from self._remark("EM", is_zero, ONE_SPIN)


def _strips(*columns: Floats) -> Iterator[list[Floats]]:
    """Columns strip by strip; those of one value whole."""
    for start in range(0, max(map(len, columns)), _STRIP):
        yield [c if len(c) == 1 else c[start : start + _STRIP] for c in columns]


@np.errstate(all="ignore")
def _ratios(columns: Sequence[Floats], system: System) -> Floats:
    """Ratio of each inertia to the rule's; NaN where there is no rule or no inertia."""
    masses, inertias = columns
    weights, usual = weight_line(masses, system)
    within_rule = (
        (CARS[0] <= weights) & (weights <= CARS[1]) & (inertias > 0) & (inertias < math.inf)
    )
    return np.where(within_rule, inertias / usual, np.nan)


@np.errstate(all="ignore")
def _off_course(columns: Sequence[Floats], turn: float) -> Floats:
    """Degrees between a velocity and a heading turned by so many; NaN where there is none."""
    x, y, heading = columns
    apart = np.degrees(np.arctan2(y, x)) - (heading + turn)
    apart = np.abs(apart - 360.0 * np.rint(apart / 360.0))
    return np.where((x == 0) & (y == 0), np.nan, apart)
