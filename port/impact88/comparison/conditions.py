"""Conditions under which a mistake holds: a decision stump over the scene."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from .agreement import Bools
from .evaluation import Floats, Program, evaluate
from .spellings import COLUMNS

QUANTITIES = {
    "the closing speed": "-gn",
    "the size of the closing speed": "abs(gn)",
    "the sliding velocity": "gt",
    "the sliding speed": "abs(gt)",
    "the normal impulse": "Pn",
    "the size of MU": "abs(MU)",
    "the size of MU less the critical friction coefficient": "abs(MU) - abs(muc)",
    "the sliding velocity of the mass centres": "(UX - VX)*tx + (UY - VY)*ty",
    "the closing speed times the sliding velocity": "-gn*gt",
    "the relative spin before": "gw",
    "TA + PA": "TA + PA",
    "TB + PB": "TB + PB",
    "the size of TA + PA": "abs(TA + PA)",
    "the size of TB + PB": "abs(TB + PB)",
    "MA / MB": "MA/MB",
    "the number of the row": "row",
}
"""Further quantities of a condition, in names of ``spellings/impulses.py``."""
SPECIAL_VALUES = {"MU": (-10.0,), "M": (4.0,)}
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


def quantities_of(columns: Mapping[str, Floats]) -> dict[str, Floats]:
    """Return what a condition may be about, by name."""
    program = Program("impulses", columns)
    values: dict[str, Any] = {name: columns[name] for name in COLUMNS}
    values |= {name: evaluate(text, program.base) for name, text in QUANTITIES.items()}
    size = program.size
    return {name: np.broadcast_to(np.asarray(x, float), size) for name, x in values.items()}


def find_condition(
    quantities: Mapping[str, Floats], inside: Bools, outside: Bools
) -> Condition | None:
    """Return the condition that separates the rows ``inside`` from those ``outside``."""
    if inside.sum() < MIN_ROWS or outside.sum() < MIN_ROWS:
        return None
    best: tuple[float, int, Condition] | None = None
    for place, (name, column) in enumerate(quantities.items()):
        use = (inside | outside) & np.isfinite(column)
        options = [(r, v) for v in SPECIAL_VALUES.get(name, ()) for r in ("equal to", "not")]
        options += _cuts(column[use], inside[use])
        for relation, value in options:
            condition = Condition(name, relation, value)
            errors = (condition.rows(quantities) != inside) & (inside | outside)
            share = float(errors.sum() / min(inside.sum(), outside.sum()))
            key = share, place - 100 * (relation in ("equal to", "not"))
            if share <= MAX_ERRORS and (best is None or key < best[:2]):
                best = *key, condition
    return best[2] if best else None


def _cuts(column: Floats, inside: Bools) -> list[tuple[str, float]]:
    """Return the best cut above and the best one below."""
    order = np.argsort(column, kind="stable")
    values, counts = column[order], np.cumsum(inside[order])
    cuts = np.flatnonzero(np.diff(values))
    if not cuts.size:
        return []
    rows_below, inside_below = cuts + 1, counts[cuts]
    wrong_above = inside_below + (order.size - rows_below) - (counts[-1] - inside_below)
    options = []
    for relation, wrong in (("above", wrong_above), ("below", order.size - wrong_above)):
        cut = cuts[int(np.argmin(wrong))]
        options.append((relation, roundest(values[cut], values[cut + 1])))
    return options


def roundest(low: float, high: float) -> float:
    """Return the number with the fewest digits between two."""
    if low <= 0 <= high:
        return 0.0
    for digits in range(1, 16):
        number = float(f"{(low + high) / 2:.{digits}g}")
        if low <= number <= high:
            return number
    return (low + high) / 2
