"""Compare another program's results with the reference, and name the mistake."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..cases.case import Case
from ..cases.units import View
from ..errors import UserError
from ..names import SCENE
from ..tables.solving import read_headings
from .conditions import find_condition, quantities_of
from .grading import Table
from .kit import HEAD, REMARKS, Answers
from .mistakes import MAX_SAMPLE, columns_of, find_causes
from .numbers import spread
from .reading import read_table, scene_columns
from .spellings import COMPARED
from .types import MAX_ROWS_LISTED, Cause, Comparison, Disagreement


@np.errstate(all="ignore")
def compare(
    table: Any,
    *,
    kit: str | None = None,
    values: Mapping[str, Any] | None = None,
    units: str = "",
    causes: bool = True,
) -> Comparison:
    """Compare another program's results with the reference, and name the mistake.

    Parameters
    ----------
    table : path, mapping of columns, data frame or sequence of mappings
        The scenes and the results, with headings such as ``VAX`` or ``VAX [mph]`` and in files as
        `impact88 solve` reads them. Texts are judged by the digits that they are written with.
    kit : str, optional
        The id of the kit of test vectors that the table answers, 1988.1. The scenes are the kit's,
        and every vector must be answered.
    values : mapping of str to float or str, optional
        Values of columns of the scene that the table lacks.
    units : {"", "us", "chapter", "metric", "si"}, default ""
        Units of columns and values that name none; "" for any consistent units.
    causes : bool, default True
        Look for the mistakes where rows disagree.

    Returns
    -------
    Comparison
        The verdict, how results disagree, and the mistakes that explain it.

    Raises
    ------
    UserError
        For a table that cannot be used, and without a column of results.

    Notes
    -----
    A number agrees within the rounding of a careful program or half its last digit (`agreement`).
    A mistake is an edit of the equations that gives the rows kept out of the search (`diagnosis`).

    Examples
    --------
    >>> scene = impact88.sample(1).numbers()
    >>> comparison = impact88.compare([{**scene, "VAX": -13.2627}], causes=False)
    >>> comparison.passed, comparison.differing
    (True, 0)
    """
    columns = read_table(table)
    values = values or {}
    case = Case.of(values, "--set", View.of(units=units or ("chapter" if kit else "")))
    measured = (*SCENE, *COMPARED)
    headings = read_headings([*columns])
    names = {heading: name for name, (heading, _) in headings.items()}
    factors = {
        n: float(case.view.map(n, unit)[0]) for n, (_, unit) in headings.items() if n in measured
    }
    columns = {names.get(heading, heading): column for heading, column in columns.items()}
    others = [name for name in columns if name not in (*measured, *HEAD, *REMARKS)]
    for name in case.numbers:
        if name in (SCENE if kit else columns) and (name != "M" or "M" in case.written):
            raise UserError(f"{name} is set, and in the table or kit, too; expected one of the two")
    answers = None if kit is None else Answers(columns, kit)
    if not (answers or any(name in columns for name in COMPARED)):
        raise UserError(
            f"no results to compare, only {' '.join(others) or 'the scene'}; expected headings "
            f"such as {' '.join(COMPARED)}"
        )
    scene = answers.scene if answers else scene_columns(columns, factors, case.numbers)
    table = Table(scene, answers.results if answers else columns, factors)
    comparison = _comparison(table, causes, others)
    if answers:
        verdict = answers.verdict(table.wrong)
        passed = not (verdict["failed"] or verdict["stray"])
        comparison = replace(comparison, passed=passed, kit=verdict)
    return comparison


def _comparison(table: Table, causes: bool, others: Sequence[str]) -> Comparison:
    """Return the comparison of a table, with the causes where they are wanted.

    ``others``: columns that are not compared.
    """
    places = np.flatnonzero(table.wrong)
    is_complete = table.agreeing.any() and not (places.size or table.missing.any() or table.empty)
    is_lone = places.size == 1 and table.agreeing.any()  # one row fits some edit by chance
    notes = table.notes()
    cause_list: tuple[Cause, ...] = ()
    if causes and places.size:
        cause_list = () if is_lone else find_causes(table)
        note = "one row alone disagrees: no cause is named" if is_lone else "no cause was found"
        notes += [] if cause_list else [note]
    notes += [f"columns not compared: {' '.join(others)}"] if others else []
    return Comparison(
        passed=bool(is_complete),
        rows=table.size,
        agreeing=int(table.agreeing.sum()),
        differing=int(places.size),
        results=tuple(name for name in table.names if name not in table.empty),
        causes=cause_list,
        disagreements=_disagreements(table, bool(cause_list)),
        notes=tuple(notes),
        differing_rows=tuple((places[:MAX_ROWS_LISTED] + 1).tolist()),
    )


def _disagreements(table: Table, explained: bool) -> tuple[Disagreement, ...]:
    """Return how each result disagrees; under which condition, where no cause explains it."""
    rows = np.concatenate(
        [spread(np.flatnonzero(x), 4 * MAX_SAMPLE) for x in (table.wrong, table.agreeing)]
    )
    quantities = {} if explained else quantities_of(columns_of(table, rows))
    disagreements = []
    for name in table.disagreeing:
        misfit = table.misfit[name]
        relative = table.relative_difference(name)
        worst = int(relative.argmax())
        condition = quantities and find_condition(quantities, misfit[rows], ~table.wrong[rows])
        disagreements.append(
            Disagreement(
                name,
                int(misfit.sum()),
                int(np.isfinite(table.difference[name]).sum()),
                worst + 1,
                str(table.columns[name][worst]).strip(),
                float(table.ours[name][worst] / table.factors[name]),
                float(relative[worst]),
                str(condition or ""),
            )
        )
    return tuple(disagreements)
