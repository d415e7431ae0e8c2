"""Compare another program's results with the reference, and name the mistake."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..errors import UserError
from .agreement import COMPARED, Bools
from .conditions import find_condition, quantities_of
from .evaluation import Floats
from .grading import Table
from .kit import Answers, check_kit
from .mistakes import MAX_SAMPLE, columns_of, find_causes
from .numbers import spread
from .reading import read_table, scene_columns
from .types import Comparison, Disagreement

MAX_ROWS_LISTED = 1000


@np.errstate(all="ignore")
def compare(
    table: Any,
    *,
    kit: str | None = None,
    values: Mapping[str, Any] | None = None,
    factors: Mapping[str, float] | None = None,
    causes: bool = True,
) -> Comparison:
    """Compare another program's results with the reference, and name the mistake.

    Parameters
    ----------
    table : path, mapping of columns, data frame or sequence of mappings
        The scenes and the results, by `impact88.names`; a file ends in ``.csv``.
        Texts are judged by the digits that they are written with.
    kit : str, optional
        The id of the kit of test vectors that the table answers, 1988.1. The scenes are the kit's,
        and every vector must be answered.
    values : mapping of str to float, optional
        Values of columns of the scene that the table lacks.
    factors : mapping of str to float, optional
        What converts a column to consistent units (length, mass, time): ``{"VAX": 22 / 15}``.
    causes : bool, default True
        Look for the mistakes where rows disagree.

    Returns
    -------
    Comparison
        The verdict, how results disagree, and the mistakes that explain it.

    Raises
    ------
    UserError
        For a table that cannot be used.

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
    factors = factors or {}
    if kit is not None:
        check_kit(kit)
        answers = Answers(columns)
        comparison, wrong = compare_columns(answers.scene, answers.results, factors, causes)
        verdict = answers.verdict(wrong)
        passed = not (verdict["failed"] or verdict["stray"])
        return replace(comparison, passed=passed, kit=verdict)
    scene = scene_columns(columns, values or {})
    scene = {name: column * factors.get(name, 1.0) for name, column in scene.items()}
    if not any(name in columns for name in COMPARED):
        raise UserError(f"no results to compare; expected some of {' '.join(COMPARED)}")
    return compare_columns(scene, columns, factors, causes)[0]


def compare_columns(
    scene: Mapping[str, Floats],
    columns: Mapping[str, Any],
    factors: Mapping[str, float],
    causes: bool = True,
) -> tuple[Comparison, Bools]:
    """Return the comparison of columns of results with their scenes, and the rows that disagree."""
    table = Table(scene, columns, factors)
    places = np.flatnonzero(table.wrong)
    complete = table.agreeing.any() and not (places.size or table.missing.any() or table.empty)
    comparison = Comparison(
        passed=bool(complete),
        rows=table.size,
        agreeing=int(table.agreeing.sum()),
        differing=int(places.size),
        notes=table.notes(),
        differing_rows=tuple((places[:MAX_ROWS_LISTED] + 1).tolist()),
    )
    if not places.size:
        return comparison, table.wrong
    cause_list = find_causes(table) if causes else ()
    disagreements = _disagreements(table, bool(cause_list))
    return replace(comparison, causes=cause_list, disagreements=disagreements), table.wrong


def _disagreements(table: Table, explained: bool) -> tuple[Disagreement, ...]:
    """Return how each result disagrees; under which condition, where no cause explains it."""
    rows = np.concatenate(
        [spread(np.flatnonzero(x), 4 * MAX_SAMPLE) for x in (table.wrong, table.agreeing)]
    )
    quantities = {} if explained else quantities_of(columns_of(table, rows))
    disagreements = []
    for name, misfit in table.misfit.items():
        if not misfit.any():
            continue
        relative = table.relative_difference(name)
        worst = int(relative.argmax())
        condition = (
            find_condition(quantities, misfit[rows], ~table.wrong[rows]) if quantities else None
        )
        pairs = np.isfinite(table.theirs[name]) & np.isfinite(table.ours[name])
        disagreements.append(
            Disagreement(
                name,
                int(misfit.sum()),
                int(pairs.sum()),
                worst + 1,
                str(table.columns[name][worst]).strip(),
                float(table.ours[name][worst] / table.factors[name]),
                float(relative[worst]),
                str(condition or ""),
            )
        )
    return tuple(disagreements)
