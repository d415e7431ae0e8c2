"""Conditions under which a mistake holds: a decision stump over the scene."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from .agreement import Bools
from .evaluation import Floats, Program, evaluate
from .mutants import entries
from .spellings import COLUMNS

RELATIONS: dict[str, Any] = {
    "above": np.greater,
    "below": np.less,
    "equal to": np.equal,
    "not": np.not_equal,
}
MAX_ERRORS = 0.03  # of the rows: where digits are few, some fit by chance
MIN_ROWS = 4  # on each side


class Condition(NamedTuple):
    """A quantity of the scene that is "above", "below", "equal to" or "not" a value."""

    quantity: str
    relation: str
    value: float

    def rows(self, quantities: Mapping[str, Floats]) -> Bools:
        """Return the rows in which it holds."""
        relation: Callable[[Floats, float], Bools] = RELATIONS[self.relation]
        return relation(quantities[self.quantity], self.value)

    def __str__(self) -> str:
        return f"where {self.quantity} is {self.relation} {self.value:.6g}"


SPECIAL_CONDITIONS = (
    Condition("MU", "equal to", -10.0),
    Condition("MU", "not", -10.0),
    Condition("M", "equal to", 4.0),
    Condition("M", "not", 4.0),
)


def quantities_of(columns: Mapping[str, Floats]) -> dict[str, Floats]:
    """Return what a condition may be about, by name."""
    program = Program("impulses", columns)
    values: dict[str, Any] = {name: columns[name] for name in COLUMNS}
    values |= {name: evaluate(text, program.base) for name, text in entries("quantities")}
    size = program.size
    return {name: np.broadcast_to(np.asarray(x, float), size) for name, x in values.items()}


def find_condition(
    quantities: Mapping[str, Floats], inside: Bools, outside: Bools
) -> Condition | None:
    """Return the condition that separates the rows ``inside`` from those ``outside``."""
    fewest = min(inside.sum(), outside.sum())
    if fewest < MIN_ROWS:
        return None
    rows = inside | outside
    conditions = list(SPECIAL_CONDITIONS)
    for name, column in quantities.items():
        conditions += _cuts(name, column[rows], inside[rows])
    errors = [int((c.rows(quantities) != inside)[rows].sum()) for c in conditions]
    best = int(np.argmin(errors))
    return conditions[best] if errors[best] <= MAX_ERRORS * fewest else None


def _cuts(name: str, column: Floats, inside: Bools) -> list[Condition]:
    """Return the best conditions above and below a value."""
    values = np.unique(column[np.isfinite(column)])
    if values.size < 2:
        return []
    errors = ((column > values[:-1, None]) != inside).sum(1)
    cuts = {"above": errors.argmin(), "below": errors.argmax()}
    return [Condition(name, r, roundest(values[k], values[k + 1])) for r, k in cuts.items()]


def roundest(low: float, high: float) -> float:
    """Return the number with the fewest digits between two."""
    if low <= 0 <= high:
        return 0.0
    for digits in range(1, 16):
        number = float(f"{(low + high) / 2:.{digits}g}")
        if low <= number <= high:
            return number
    return (low + high) / 2
