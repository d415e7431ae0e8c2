"""The units of a table: of its headings (``UX [mph]``, ``MA (lb)``), its cells, its results."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..amounts import converted, units_in
from ..errors import UserError, quoted
from ..names import RESULTS, SCENE, quantity
from ..units import (
    NUMBER,
    RULES,
    SYSTEMS,
    System,
    check_unit,
    size_of,
    system_named,
    system_using,
)
from .rows import Heading, Rows, heading

_MEASURING = ("length", "length/time", "mass", "mass·length²", "mass·length²/time²")
"""What a bare column beside others with units leaves open."""
_RATIOS = ("1", "-", "–", "—", "")


class TableUnits:
    """What the columns of one table are in. ``system``: what results are shown in, `RULES` where
    nothing names a unit. Raises UserError for a heading whose unit does not measure its quantity,
    and for bare columns beside such with units where ``given`` names no system."""

    def __init__(
        self,
        names: Sequence[str],
        given: str | None,
        first: Rows | None = None,
        results: Iterable[str] = (),
        where: str = "",
    ) -> None:
        self.units: dict[str, str] = {}
        self.based: frozenset[str] = frozenset()
        compared = (*SCENE, *results)
        for name in names:
            unit = getattr(name, "unit", "")
            if name not in compared or not unit:
                continue
            rule = quantity(name).unit
            if unit == rule or (rule == NUMBER and unit in _RATIOS):
                continue
            check_unit(unit, rule, f"column {quoted(heading(name))}", where)
            self.units[name] = unit
        used = [(unit, quantity(name).unit) for name, unit in self.units.items()]
        self.system = system_named(given, "--units") if given else system_using(used, where)
        if self.system is RULES and first is not None:
            self.system = system_using(_units_in_cells(first), where)
            self.strict = self.system is not RULES
        else:
            self.strict = False
            bare = [n for n in names if n in compared and self._open(n)]
            if bare and self.system is not RULES and not given:
                # beside ft, slug and ft/s, or m, kg and m/s, bare numbers are such too
                self.system = SYSTEMS["si" if self.system.base == SYSTEMS["si"].base else "chapter"]
            if bare and not given and any(self.factor(name) != 1 for name in self.units):
                usual = self.system.label(quantity(bare[0]).unit)
                raise UserError(
                    f"column {bare[0]} has no unit, and others have; expected {bare[0]} [{usual}], "
                    f"or --units {self.system.name}",
                    where,
                )

    def _open(self, name: str) -> bool:
        return name not in self.units and quantity(name).unit in _MEASURING

    def _unit(self, name: str) -> str:
        return self.units.get(name) or self.system.usual.get(quantity(name).unit, "")

    def factor(self, name: str) -> float:
        """What a column's bare numbers are multiplied with to be in base units."""
        if name in self.based:
            return 1.0
        rule, unit = quantity(name).unit, self._unit(name)
        size = size_of(unit, rule) if unit else None
        return float(size[0] / self.system.scale(rule)) if size else 1.0

    def given(self, names: Iterable[str]) -> TableUnits:
        """The same of columns of which some are replaced by base units."""
        result = copy(self)
        result.based = frozenset(names)
        return result

    def converts(self, name: str) -> bool:
        """Whether a column's texts have to be looked at."""
        return name not in self.based and (self.system is not RULES or name in self.units)

    def refuses_bare(self, name: str) -> bool:
        """Whether bare numbers of a column leave their unit open."""
        return self.strict and self.converts(name) and self._open(name)

    def cell(self, name: str, text: str) -> str:
        """One cell in base units, exactly. Raises UserError for what is not an amount."""
        unit = self._unit(name)
        usual = {quantity(name).unit: unit} if unit else {}
        if self.system is RULES and (found := system_using(units_in(name, text), "")) is not RULES:
            raise UserError(
                f"{quoted(text)}: expected its unit in the heading, or --units {found.name}"
            )
        return converted(name, text, System("", self.system.base, usual, {}))

    def headings(self, results: Sequence[str]) -> list[str]:
        """Names with the headings they have here: ``DVA [mph]``."""
        known = (*SCENE, *RESULTS)
        return [Heading(n, self.system.heading(n)) if n in known else n for n in results]

    def shown(self, results: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
        """Results in base units as they are shown."""
        if self.system is RULES:
            return dict(results)
        factors = {n: self.system.factor(n) for n in results if n in RESULTS}
        return {n: v * factors[n] if factors.get(n, 1.0) != 1 else v for n, v in results.items()}


def _units_in_cells(rows: Rows) -> list[tuple[str, str]]:
    """The units that cells have, each with what it measures."""
    found: set[tuple[str, str]] = set()
    for name, column in rows.columns.items():
        if not isinstance(column, np.ndarray):
            # "lb" and "45 deg", but not 1E5 or inf
            worth = (c for c in column if isinstance(c, str) and c.strip("0123456789+-.eE \t"))
            for text in worth:
                found.update(units_in(name, text))
    return list(found)
