"""The blocks of a table's rows solved, in either arithmetic.

Cells that cannot be used are added to their rows' complaints; remarks are gathered until the end.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..collision.case import VALUE_LIMIT, Case, share_of
from ..collision.doubles import double, is_number
from ..collision.fields import ZERO_DETERMINANT
from ..collision.needs import needs_sentences
from ..errors import UserError, quoted
from ..mechanics.closedform.columns import BODY_CONSTANTS, UNUSED_BY_POINTS, examine, refusals
from ..mechanics.closedform.general import resolve_share, share_typed
from ..mechanics.closedform.solve import solve
from ..names import DEFAULT_M, SCENE
from ..status import Status
from .cells import Amount, TableUnits, fill_blanks, find_vanished, numbers, point_masses
from .remarks import Remark, remarks
from .rows import Rows, shortest

Results = dict[str, NDArray[Any]]


@dataclass
class Filling:
    """Texts that fill columns which a table lacks, or take their place.

    ``constants``: texts in base units, the same in all rows; ``inertias``: yaw inertias, each the
    function that estimates it from the text of a row's mass; ``case``: the scene that these are of,
    if any; ``noted``: names of which something has been said."""

    constants: Mapping[str, str] = field(default_factory=dict)
    inertias: Mapping[str, Callable[[str], str]] = field(default_factory=dict)
    case: Case | None = None
    noted: Collection[str] = ()

    def fill(self, rows: Rows, units: TableUnits) -> None:
        """Put the columns into a block of rows."""
        for name, text in self.constants.items():
            rows.columns.pop(name, None)  # and with it the heading of another unit
            rows.columns[name] = [text] * rows.count
        for name, estimate in self.inertias.items():
            rows.columns[name] = self._estimate_column(rows, units, name, estimate)

    def _estimate_column(
        self, rows: Rows, units: TableUnits, name: str, estimate: Callable[[str], str]
    ) -> list[str | None]:
        """Return a column of inertias estimated from each row's own mass; nothing for a mass that
        is none, or no car's."""
        assert self.case is not None
        mass_name = f"M{name[1]}"
        texts: list[str | None] = []
        for cell in rows.columns.get(mass_name) or [None] * rows.count:
            try:
                mass = cell if isinstance(cell, str) else repr(float(cell)).upper()
                display = self.case.display_texts({mass_name: units.cell(mass_name, mass)})
                texts.append(estimate(display[mass_name]))
            except (UserError, TypeError, ValueError):
                texts.append(None)
        return texts

    def text(self, name: str) -> str | None:
        """Return the text of a constant as it was written; None for what is no constant."""
        if self.case is None or name not in self.constants:
            return None
        return self.case.given.get(name, "")


class RowSolver:
    """The way of a table's rows through an arithmetic, a block at a time.

    Parameters
    ----------
    arithmetic
        "float64" or "applesoft".
    outputs
        Names of the results.
    units
        Of the table's columns.
    filling
        What fills columns.
    columns
        Names of the columns that the rows have, with those filled.
    points
        All rows are point masses.

    Attributes
    ----------
    lacking : list of str
        Inputs for which there is no column.
    """

    def __init__(
        self,
        arithmetic: str,
        outputs: Sequence[str],
        units: TableUnits,
        filling: Filling,
        columns: Collection[str],
        points: bool,
    ) -> None:
        unused = UNUSED_BY_POINTS if points else ()
        self.lacking = [n for n in SCENE if n not in columns and n not in ("M", *unused)]
        self._solve = self._float64 if arithmetic == "float64" else self._applesoft
        self._outputs, self._units, self._filling = outputs, units, filling
        self._remarks: dict[str, tuple[str, Remark]] = {}
        self._absent: Mapping[str, tuple[str, ...]] = {}

    def solve(self, rows: Rows) -> Results:
        """Return the results of a block in base units, NaN for rows that cannot be used."""
        self._filling.fill(rows, self._units)
        # a block may lack what others have: a complaint where a row looks at the empty cells
        blanks = [None] * rows.count
        complete = [name for name in SCENE if name not in self.lacking]
        rows.columns |= {name: blanks for name in complete if name not in rows.columns}
        rows.columns["M"] = fill_blanks(rows.columns["M"], DEFAULT_M)
        return self._solve(rows)

    def needs(self) -> list[str]:
        """Return sentences on the results that need inputs for which there is no column."""
        return needs_sentences(self._absent)

    def remarks(self) -> list[str]:
        """Return the remarks on all rows so far."""
        return [f"{place}{r.more}: {r.text}" for place, r in self._remarks.values()]

    def _remark(self, rows: Rows, columns: Results) -> None:
        """Gather the remarks on some rows. ``columns``: of the scene, in base units."""

        def cell(name: str, index: int) -> str:
            if (text := self._filling.text(name)) is not None:
                return text
            column = rows.columns[name]
            if isinstance(column, np.ndarray):
                number = column.reshape(-1)[index % column.size]
                return shortest(np.array([number]))[0].removesuffix(".0")
            return str(column[index])

        table_remarks = remarks(columns, self._units.system, cell)
        for name, remark in (*find_vanished(rows, columns), *table_remarks.items()):
            if name in self._filling.noted:
                continue
            if name in self._remarks:
                self._remarks[name][1].rows += remark.rows
            else:
                line = f" (line {rows.lines[remark.first]})" if rows.lines else ""
                self._remarks[name] = f"row {rows.first + remark.first}{line}", remark

    def _float64(self, rows: Rows) -> Results:
        """The closed form in double precision."""
        columns = numbers(rows, self._units)
        _type_shares(rows, columns)
        self._remark(rows, columns)
        unread = {index for index, *_ in rows.bad}
        _refuse(rows, {**dict.fromkeys(self.lacking, np.ones(1)), **columns}, unread)
        solution = solve(columns, self._outputs)
        results = dict(solution)
        if self.lacking:
            self._absent = getattr(solution, "absent", {})
            results |= {name: np.full(rows.count, np.nan) for name in self._absent}
        return _blank_rows(
            {n: np.array(np.broadcast_to(results[n], rows.count)) for n in self._outputs}
            if self.lacking
            else results,
            unread,
        )

    def _applesoft(self, rows: Rows) -> Results:
        """The listing's own arithmetic, `impact88.replay`."""
        from ..program.replay import replay

        points = point_masses(rows)
        columns = {n: _texts(n, column, self._units) for n, column in rows.scene().items()}
        rows_resolved = Rows(rows.count, rows.columns, rows.lines, first=rows.first)
        self._remark(rows_resolved, numbers(rows_resolved, self._units))
        _fill_unused(columns, np.flatnonzero(points).tolist())
        _resolve_shares(rows, columns)
        unread = {index for index, *_ in rows.bad}
        try:
            # nearly always all cells can be read, and looking at each takes as long as solving
            outcome = None if unread else replay(columns)
        except (ValueError, TypeError):  # UserError, or cells of several types
            outcome = None
        if outcome is None:
            _complain(rows, columns, unread)
            for column in columns.values():
                for index in unread:
                    column[index] = "6"
            outcome = replay(columns)
        results: Results = {name: outcome.floats(name) for name in self._outputs}
        error = np.where(outcome.zero_determinant, ZERO_DETERMINANT, outcome.error)
        return _blank_rows({**results, "ERROR": error, "LINE": outcome.line}, unread)


def _blank_rows(results: Results, unread: set[int]) -> Results:
    """The results, none for the rows ``unread``."""
    placeholders = {"STATUS": Status.NOT_FINITE, "ERROR": "", "LINE": 0}
    for name, result in results.items():
        result[sorted(unread)] = placeholders.get(name, np.nan)
    return results


def _refuse(rows: Rows, columns: Mapping[str, NDArray[np.float64]], unread: set[int]) -> None:
    """Add the rows whose numbers cannot be used to ``rows.bad`` and to ``unread``."""
    complete = {name: columns[name] for name in SCENE}
    if not rows.count or examine(complete).refused is None:
        return
    for refusal in refusals(complete):
        values = np.broadcast_to(complete[refusal.column], rows.count)
        places = np.flatnonzero(np.broadcast_to(refusal.where, rows.count)).tolist()
        for index in sorted({*places} - unread):
            unread.add(index)
            rows.bad.append((index, refusal.column, f"{float(values[index])!r} {refusal.reason}"))


def _type_shares(rows: Rows, columns: dict[str, NDArray[np.float64]]) -> None:
    """Put numbers in place of the cells of MU that are shares of the critical friction, and
    withdraw the complaints about them."""
    places = [index for index, column, _ in rows.bad if column == "MU"]
    cells = {at: share_of(rows.columns["MU"][at]) for at in places}
    fractions = {at: share for at, share in cells.items() if share is not None}
    if fractions:
        at = list(fractions)
        scene_columns = {n: np.broadcast_to(x, (rows.count,))[at] for n, x in columns.items()}
        columns["MU"] = columns["MU"].copy()
        columns["MU"][at] = share_typed(scene_columns, list(fractions.values()))
        cells_kept = list(rows.columns["MU"])
        for index in at:  # a typed table holds the number
            cells_kept[index] = Amount(cells_kept[index], float(columns["MU"][index]))
        rows.columns["MU"] = cells_kept
        rows.bad = [bad for bad in rows.bad if bad[1] != "MU" or bad[0] not in fractions]


def _resolve_shares(rows: Rows, columns: dict[str, list[Any]]) -> None:
    """Put the text of a number in place of each cell of MU that is a share, see `_type_shares`."""
    shares: dict[int, Amount] = {}
    for index, cell in enumerate(columns["MU"]):
        if (share := share_of(cell)) is not None:
            scene = {name: column[index] for name, column in columns.items() if name in SCENE}
            with suppress(UserError, ValueError, TypeError):  # the cell's complaint follows
                columns["MU"][index] = text = resolve_share(scene, share, "")[0]
                shares[index] = Amount(cell, double(text))
    if shares:
        cells = list(rows.columns["MU"])
        rows.columns["MU"] = [shares.get(index, cell) for index, cell in enumerate(cells)]


def _fill_unused(columns: dict[str, list[Any]], points: Sequence[int]) -> None:
    """Fill what the rows of point masses need not have: the program reads it all the same."""
    for name in UNUSED_BY_POINTS if points else ():
        default = "1" if name in BODY_CONSTANTS else "0"
        for index in points:
            if columns[name][index] in (None, "", "NAN"):
                columns[name][index] = default


def _texts(name: str, column: Any, units: TableUnits) -> list[Any]:
    """A column as texts that INPUT may read, those with a unit in base units."""
    if isinstance(column, np.ndarray):
        column = [repr(x).removesuffix(".0").upper() for x in column.tolist()]
    texts = [text.strip().upper() if isinstance(text, str) else text for text in column]
    converts = units.converts(name)
    for index, text in enumerate(column):
        # 1,234.5 is a number to those who write tables, not to INPUT
        if isinstance(text, str) and (converts or "," in text) and any(map(str.isdigit, text)):
            with suppress(UserError):
                texts[index] = units.cell(name, text)
    return texts


def _complain(rows: Rows, columns: dict[str, list[Any]], unread: set[int]) -> None:
    """Add what Applesoft cannot read to ``rows.bad``, the first of every row not yet ``unread``."""
    for name, column in columns.items():
        for index, text in enumerate(column):
            if index in unread:
                continue
            if text is None or text == "":
                reason = "is empty; expected a number"
            elif not (isinstance(text, str) and is_number(text)):
                reason = f"{quoted(text)} is not a number that Applesoft reads"
            elif len(text) > VALUE_LIMIT:
                reason = f"has more than {VALUE_LIMIT} characters"
            else:
                continue
            unread.add(index)
            rows.bad.append((index, name, reason))
