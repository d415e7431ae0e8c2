"""The cells of a table as numbers in base units: by the units of its headings (``UX [mph]``, ``MA
(lb)``) and of the cells themselves; and its results in the same units."""

import json
import math
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..collision import doubles
from ..collision.doubles import is_number
from ..collision.units import (
    SYSTEMS,
    Convention,
    System,
    check_unit,
    reorient_text,
    size_of,
    system_named,
    system_using,
    text_in_base,
    units_in,
)
from ..errors import UserError, quoted
from ..mechanics.closedform.columns import OPTIONAL_OF_POINTS, UNUSED_BY_POINTS
from ..names import ENERGY, INERTIA, LENGTH, MASS, NUMBER, RESULTS, SCENE, VELOCITY, quantity
from .remarks import Remark
from .rows import ArrowTexts, Column, Heading, Rows, heading

_MEASURING = (LENGTH, VELOCITY, MASS, INERTIA, ENERGY)
"""Quantities whose bare column leaves its unit open beside columns with units."""
_NUMBERS = re.compile(r"(?<![a-zA-Z^])(?:[0-9][0-9,]*\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_WRITTEN = re.compile(r"[+-]?[0-9]*(?:\.([0-9]*))?(?:[eE]([+-]?[0-9]+))?")
RATIOS = ("1", "-", "–", "—", "")
"""Texts that stand for no unit."""


class TableUnits:
    """Units of the columns of one table. ``system``: what results are shown in, `RULES` where
    nothing names a unit; ``based``: columns that are replaced by base units. Raises UserError for a
    heading whose unit does not measure its quantity, and for bare columns beside such with units
    where ``given`` names no system."""

    def __init__(
        self,
        names: Iterable[str] = (),
        given: str | None = None,
        first: Rows | None = None,
        results: Iterable[str] = (),
        where: str = "",
    ) -> None:
        self.units: dict[str, str] = {}
        self.based: Collection[str] = ()
        self.convention: Convention | None = None
        self.strict = False
        compared = [name for name in names if name in SCENE or name in results]
        for name in compared:
            unit, rule = getattr(name, "unit", ""), quantity(name).unit
            if unit and unit != rule and not (rule == NUMBER and unit in RATIOS):
                check_unit(unit, rule, f"column {quoted(heading(name))}", where)
                self.units[name] = unit
        used = [(unit, quantity(name).unit) for name, unit in self.units.items()]
        self.system = system_named(given, "--units") if given else system_using(used, where)
        if self.system.is_bare and first is not None:
            self.system = system_using(_units_in_cells(first), where)
            self.strict = not self.system.is_bare
        elif not given and (bare := [name for name in compared if self.leaves_open(name)]):
            if not self.system.is_bare:
                # beside ft, slug and ft/s, or m, kg and m/s, bare numbers are such too
                self.system = SYSTEMS["si" if self.system.base == SYSTEMS["si"].base else "chapter"]
            foreign = [name for name in self.units if self.factor(name) != 1]
            if foreign:
                usual = self.system.label(quantity(bare[0]).unit)
                names = [n for n, s in SYSTEMS.items() if s.base == self.system.base]
                meant = " or ".join(f"{n} ({_measures(n)})" for n in names)
                raise UserError(
                    f"some columns have units, such as {heading(foreign[0])}, and {bare[0]} does "
                    f"not; expected {bare[0]} [{usual}], or --units {meant} for "
                    "what has none",
                    where,
                )

    def leaves_open(self, name: str) -> bool:
        """Return whether a column's bare numbers may be in several units."""
        return name not in self.units and quantity(name).unit in _MEASURING

    def _unit(self, name: str) -> str:
        return self.units.get(name) or self.system.usual.get(quantity(name).unit, "")

    def factor(self, name: str) -> float:
        """Factor that brings a column's bare numbers to base units."""
        rule, unit = quantity(name).unit, self._unit(name)
        size = size_of(unit, rule) if unit and name not in self.based else None
        return float(size[0] / self.system.scale(rule)) if size else 1.0

    def converts(self, name: str) -> bool:
        """Return whether a column's texts need conversion to base units."""
        return name not in self.based and (not self.system.is_bare or name in self.units)

    def cell(self, name: str, text: str) -> str:
        """One cell in base units, exactly. Raises UserError for what is not an amount."""
        unit = self._unit(name)
        usual = {quantity(name).unit: unit} if unit else {}
        if self.system.is_bare and not (system := system_using(units_in(name, text), "")).is_bare:
            raise UserError(
                f"{quoted(text)}: expected its unit in the heading, or --units {system.name}"
            )
        value = text_in_base(name, text, System("", self.system.base, usual))
        turn = self.convention.sign_and_offset(name) if self.convention else None
        return reorient_text(name, value, *turn) if turn and is_number(value) else value

    def result(self, name: str, text: str) -> tuple[float, float]:
        """A cell of a result in base units, and the size of the last digit it is written with (0
        where that is not plain to see). Raises UserError for what is not an amount."""
        value = doubles.double(self.cell(name, text))
        amounts = _NUMBERS.findall(text)
        if len(amounts) != 1:
            return value, 0.0
        number = amounts[0].replace(",", "")
        size, magnitude = last_digit(number), abs(doubles.double(number))
        return value, size * abs(value) / magnitude if magnitude else size * self.factor(name)

    def in_listing_axes(self, name: str, values: Any) -> Any:
        """Return numbers in base units in the listing's axes."""
        turn = self.convention.sign_and_offset(name) if self.convention else None
        return values if turn is None or name in self.based else turn[1] + turn[0] * values

    def headings(self, results: Sequence[str]) -> list[str]:
        """Names with the headings they have here: ``DVA [mph]``."""
        comparable = (*SCENE, *RESULTS)
        return [Heading(n, self.system.heading(n)) if n in comparable else n for n in results]

    def shown(self, results: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
        """Results in base units as they are shown."""
        system = self.system._replace(convention=self.convention)
        return {n: system.display(n, v) if n in RESULTS else v for n, v in results.items()}


def _measures(system: str) -> str:
    """The units of a system that tell it from others."""
    usual = SYSTEMS[system].usual
    return ", ".join(usual[rule] for rule in (LENGTH, VELOCITY, MASS))


def last_digit(text: str) -> float:
    """The size of the last digit that a number is written with; 0 for what is no number."""
    if not (match := _WRITTEN.fullmatch(text)):
        return 0.0
    decimals, exponent = match.groups(default="")
    power = float(exponent or 0) - len(decimals)
    return float(10.0 ** min(300.0, max(power, -400.0)))


def _units_in_cells(rows: Rows) -> list[tuple[str, str]]:
    pairs: set[tuple[str, str]] = set()
    for name, column in rows.scene().items():
        if not isinstance(column, np.ndarray):
            # "lb" and "45 deg", but not 1E5, 1,234.5 or inf
            worth = (c for c in column if isinstance(c, str) and c.strip("0123456789+-.,eE \t"))
            for text in worth:
                pairs.update(units_in(name, text))
    return list(pairs)


def check_scene_columns(
    names: Collection[str],
    points: bool = False,
    advice: str = "--set NAME=VALUE",
    where: str | None = None,
) -> None:
    """Raise UserError unless ``names`` are a scene. Of point masses only, ``points``, the masses
    and velocities of one suffice: what other results need, `impact88.solve` says."""
    optional = ("M", *(OPTIONAL_OF_POINTS if points else ()))
    missing = [name for name in SCENE if name not in names and name not in optional]
    if missing:
        raise UserError(
            f"no column {' '.join(missing)} (M may be missing; {advice} gives one value "
            "for all rows)",
            where,
        )


def fill_blanks(column: Column, text: str) -> Column:
    """A column with ``text`` where it has nothing."""
    if isinstance(column, np.ndarray):
        return column
    if isinstance(column, ArrowTexts):
        return column.with_default(text)
    return [
        text if cell in (None, "") and not isinstance(cell, Merged) else cell for cell in column
    ]


def typed_cells(name: str, column: Column) -> NDArray[Any] | list[str]:
    """A column as a typed table holds it: doubles for a scene's name, NaN where a cell is no
    number; otherwise what the array has, or texts."""
    if isinstance(column, np.ndarray):
        return column
    if name not in SCENE:
        return [plain(cell) for cell in column]
    if isinstance(column, ArrowTexts) and (doubles := column.doubles()) is not None:
        return doubles
    return np.array([np.nan if isinstance(n := _number(c), str) else n for c in column], float)


def numbers(rows: Rows, units: TableUnits) -> dict[str, NDArray[np.float64]]:
    """The scene columns of ``rows`` as doubles in base units. A cell that is not a number is NaN,
    and a complaint is added to ``rows.bad`` (unless its row has one already, or is a point mass
    that does not look at the cell)."""
    is_read, all_rows = ~point_masses(rows), np.ones(rows.count, np.bool_)
    return {
        name: _numbers(rows, name, column, units, is_read if name in UNUSED_BY_POINTS else all_rows)
        for name, column in rows.scene().items()
    }


def find_vanished(
    rows: Rows, columns: Mapping[str, NDArray[np.float64]]
) -> Iterator[tuple[str, Remark]]:
    """Yield a remark on each column with numbers too small for a double, which count as 0."""
    for name, column in rows.scene().items():
        if isinstance(column, np.ndarray):
            continue
        zeros = np.flatnonzero(columns[name] == 0)
        if not zeros.size:
            continue
        if isinstance(column, ArrowTexts):
            small = {text for text in column.among(zeros) if _is_small(text)}
        else:
            small = {text for text in map(column.__getitem__, zeros.tolist()) if _is_small(text)}
        if small:
            places = [index for index in zeros.tolist() if column[index] in small]
            text = f"{name} = {column[places[0]]} is smaller than any double and counts as 0"
            yield name, Remark(len(places), places[0], text)


def _is_small(cell: object) -> bool:
    """Return whether a text has other digits than 0 and is 0 as a double."""
    if not isinstance(cell, str) or not cell.lstrip("-+ .0")[:1].isdigit():
        return False
    return doubles.read(cell)[0] == 0


def point_masses(rows: Rows) -> NDArray[np.bool_]:
    """Which rows have M = 4. Complaints about cells that these do not look at are withdrawn."""
    all_rows = np.ones(rows.count, np.bool_)
    if "M" not in rows.columns:
        return ~all_rows
    is_four = _numbers(rows, "M", rows.columns["M"], TableUnits(), all_rows) == 4
    points = np.broadcast_to(is_four, all_rows.shape)
    rows.bad = [bad for bad in rows.bad if bad[1] not in UNUSED_BY_POINTS or not points[bad[0]]]
    return points


def _numbers(
    rows: Rows, name: str, column: Column, units: TableUnits, asked: NDArray[np.bool_]
) -> NDArray[np.float64]:
    factor = units.factor(name)
    bare_refused = units.strict and units.converts(name) and units.leaves_open(name)
    values = None if bare_refused else _plain_numbers(column)
    if values is not None:
        products = values if factor == 1 else values * factor
        return np.asarray(units.in_listing_axes(name, products))
    values = np.full(rows.count, np.nan)
    cells = list(column)
    already = {index for index, *_ in rows.bad}
    for index, cell in enumerate(cells):
        if index in already or not asked[index]:
            continue
        number = _number(cell)
        try:
            if not isinstance(number, str):
                values[index] = units.in_listing_axes(name, number * factor)
                if bare_refused and number:
                    raise UserError(f"some values have units and {cell} does not; add a unit")
            elif isinstance(cell, str) and any(map(str.isdigit, cell)):
                values[index] = doubles.double(units.cell(name, cell))
                number = float(units.in_listing_axes(name, values[index]) / factor)
                cells[index] = Amount(doubles.digits(number), number)
                rows.columns[name] = cells
            else:
                raise UserError(number)
        except ValueError as error:
            values[index] = np.nan
            rows.bad.append((index, name, str(error).removeprefix(": ")))
    return values


def _plain_numbers(column: Column) -> NDArray[np.float64] | None:
    if isinstance(column, np.ndarray) and column.dtype.kind in "fiub":
        return column.astype(np.float64, copy=False)
    if isinstance(column, ArrowTexts) and (values := column.doubles()) is not None:
        return values
    try:
        return np.array(doubles.doubles(list(column)))
    except (TypeError, ValueError):  # some cell is not a number
        return None


def _number(cell: object) -> float | str:
    """Return the double that a cell is, or why it is none."""
    if isinstance(cell, Amount):
        return cell.number
    if isinstance(cell, Merged):
        return cell.reason
    if cell is None or (isinstance(cell, str) and not cell.strip()):
        return "is empty; expected a number"
    with suppress(ValueError, TypeError):
        if not isinstance(cell, str | bool):
            return float(cell)  # type: ignore[arg-type]
        if isinstance(cell, str):
            return math.inf if is_infinite(cell) else doubles.double(cell)
    return f"{quoted(cell)} is not a number"


def is_infinite(text: str) -> bool:
    """Return whether a cell says inf, as of a barrier's mass; INPUT has no such number."""
    return text.strip().lower() == "inf"


class Amount(str):
    """A cell that is not a plain number: its text, and the ``number`` that it is in its column's
    unit. A share of the critical friction is that of its scene. Formats of texts write the text,
    formats of numbers the number."""

    __slots__ = ("number",)

    number: float

    def __new__(cls, text: str, number: float) -> "Amount":
        amount = super().__new__(cls, text)
        amount.number = number
        return amount


class Merged(str):
    """An empty cell that is merged with another one, and the ``reason`` that says so."""

    __slots__ = ("reason",)

    reason: str

    def __new__(cls, holder: str) -> "Merged":
        merged = super().__new__(cls)
        merged.reason = (
            f"is empty, for it is merged with {holder}, which holds the value; expected a number "
            "in each cell (unmerge them)"
        )
        return merged


class Numeral(str):
    """The text of a JSON number."""

    __slots__ = ()


def json_text(value: Any) -> str:
    """JSON text of a value as `read` makes it; not ASCII alone."""
    if isinstance(value, Numeral):
        return json_number(float(value)) if value in ("nan", "inf", "-inf") else str(value)
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)}: {json_text(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(json_text, value)) + "]"
    if isinstance(value, float):
        return json_number(value)
    return json.dumps(value, ensure_ascii=False, default=str)


def plain(value: Any) -> str:
    """A cell of any kind as a table of texts has it: nothing for None, else text or JSON."""
    if value is None:
        return ""
    return json_text(value) if isinstance(value, dict | list | bool) else str(value)


def json_number(value: float) -> str:
    """A float in the fewest digits that read back to it; null for NaN, which JSON has not, and
    1e999 for infinity, which readers take for it."""
    if math.isfinite(value):
        return repr(value)
    return "null" if math.isnan(value) else ("1e999" if value > 0 else "-1e999")
