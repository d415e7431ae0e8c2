"""Say where a mistake holds: a condition on the scene, found in half of the rows and confirmed in
the other half."""

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...equations.evaluation import ROW, Columns, Run
from ...equations.spelling import IMPULSES, spellings
from ...names import PIVOT, SCENE

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

ABOVE = "above"
BELOW = "below"
IS = "is"
IS_NOT = "is not"
COST = 8.0  # bits: which of some 60 quantities, and which of the four relations
_MIN_BITS = 10.0  # that a condition must tell beyond its own cost
_MIN_ROWS = 4  # inside and outside
# fractions of the rows, of either kind, that it may get wrong
_MAX_MISFITTED = 0.03
_MAX_MISHELD = 0.2  # in the half kept apart, and one row more of many
_FEW = 3

_QUANTITIES: dict[str, Callable[[Mapping[str, Any]], Any]] = {
    "the closing speed": lambda n: -n["gn"],
    "the sliding speed": lambda n: np.abs(n["gt"]),
    "the sliding velocity": lambda n: n["gt"],
    "the normal impulse P_n": lambda n: n["Pn"],
    "the tangential impulse P_t": lambda n: n["Pt"],
    "the size of MU": lambda n: np.abs(n["MU"]),
    "MU beyond the critical friction coefficient": lambda n: np.abs(n["MU"]) - np.abs(n["MUC"]),
    "the critical friction coefficient": lambda n: n["MUC"],
    "the initial relative spin": lambda n: n["gw"],
    "the ratio of the masses MA/MB": lambda n: n["MA"] / n["MB"],
    "A's initial speed": lambda n: np.hypot(n["UX"], n["UY"]),
    "B's initial speed": lambda n: np.hypot(n["VX"], n["VY"]),
    "A's direction TA + PA": lambda n: n["TA"] + n["PA"],
    "B's direction TB + PB": lambda n: n["TB"] + n["PB"],
    "the size of A's direction TA + PA": lambda n: np.abs(n["TA"] + n["PA"]),
    "the size of B's direction TB + PB": lambda n: np.abs(n["TB"] + n["PB"]),
    "the sliding of the centres of mass": lambda n: (
        n["ty"] * (n["UY"] - n["VY"]) + n["tx"] * (n["UX"] - n["VX"])
    ),
    "the product of closing and sliding velocity": lambda n: n["gn"] * n["gt"],
}
"""Quantity -> its value from those of the contact impulses."""
_SPECIAL = {"MU": (0.0, PIVOT), "M": (4.0,), "E": (0.0, 1.0), "EM": (0.0, 1.0, -1.0)}
"""Columns that mean something of their own at some values; all others do at 0."""
_NAMED = {
    ("MU", IS, PIVOT): "in pivots (MU = -10)",
    ("MU", IS_NOT, PIVOT): "except in pivots (MU = -10)",
    ("M", IS, 4.0): "for point masses (M = 4)",
    ("M", IS_NOT, 4.0): "except for point masses (M = 4)",
    ("the closing speed", BELOW, 0.0): "where the contact points separate already",
    ("the closing speed", ABOVE, 0.0): "where the contact points approach",
    ("the normal impulse P_n", BELOW, 0.0): "where P_n < 0",
    ("the normal impulse P_n", ABOVE, 0.0): "where P_n > 0",
    ("MU beyond the critical friction coefficient", ABOVE, 0.0): (
        "where MU is above the critical friction coefficient"
    ),
    ("MU beyond the critical friction coefficient", BELOW, 0.0): (
        "where MU is below the critical friction coefficient"
    ),
}


class Predicate(NamedTuple):
    """A condition on a scene: ``quantity`` is ``ABOVE`` or ``BELOW`` a value, or ``IS`` it or
    not."""

    quantity: str
    relation: str
    value: float

    def rows(self, quantities: Mapping[str, Floats]) -> Bools:
        """Return the rows in which it holds."""
        column = quantities[self.quantity]
        if self.relation in (IS, IS_NOT):
            return np.asarray((column == self.value) == (self.relation == IS))
        return np.asarray(column > self.value if self.relation == ABOVE else column < self.value)

    @property
    def text(self) -> str:
        """The condition in words."""
        if named := _NAMED.get((self.quantity, self.relation, self.value)):
            return named
        number = f"{self.value:.10g}"
        if self.quantity == ROW:
            if self.relation == ABOVE:
                return f"in the rows after row {math.floor(self.value)}"
            return f"in the rows up to row {math.ceil(self.value) - 1}"
        relation = self.relation if self.relation in (IS, IS_NOT) else f"is {self.relation}"
        return f"where {self.quantity} {relation} {number}"


@np.errstate(all="ignore")
def scene_quantities(scene: Columns) -> dict[str, Floats]:
    """Return the quantities that a condition may be about, of scenes (columns of n)."""
    run = Run(spellings()[IMPULSES], scene)
    quantities = {name: run.names[name] for name in SCENE}
    quantities |= {name: compute(run.names) for name, compute in _QUANTITIES.items()}
    quantities[ROW] = np.asarray(scene.get(ROW, np.arange(1.0, run.size + 1)))
    return {name: np.broadcast_to(column, (1, run.size))[0] for name, column in quantities.items()}


def find_predicate(
    quantities: Mapping[str, Floats], inside: Bools, outside: Bools
) -> Predicate | None:
    """Return the condition that holds in the rows ``inside`` and not in those ``outside``.

    It is found in every other row of either kind, and must hold in the rest. None where none does,
    and where the rows are too few to tell a condition from chance.
    """
    places = [np.flatnonzero(rows) for rows in (inside, outside)]
    counts = [place.size for place in places]
    if min(counts) < _MIN_ROWS or math.log2(math.comb(sum(counts), counts[0])) < COST + _MIN_BITS:
        return None
    fitted_rows = [place[0::2] for place in places]
    held_out = [place[1::2] for place in places]
    best: tuple[float, int, Predicate] | None = None
    for rank, (name, column) in enumerate(quantities.items()):
        for predicate in _candidates(name, column, *fitted_rows):
            fits = predicate.rows(quantities)
            wrong = [
                [(there.size, (~fits[there]).sum()), (elsewhere.size, fits[elsewhere].sum())]
                for there, elsewhere in (fitted_rows, held_out)
            ]
            if any(count > _MAX_MISFITTED * size for size, count in wrong[0]):
                continue
            # the border falls somewhere between two rows, and others may lie there
            if any(count > (size > _FEW) + _MAX_MISHELD * size for size, count in wrong[1]):
                continue
            misfits = sum(int(count) for half in wrong for _, count in half)
            key = float(misfits), rank + 100 * (name == ROW)
            if best is None or key < best[:2]:
                best = (*key, predicate)
    if best is None:
        return None
    # its border by all rows
    predicate, column = best[2], quantities[best[2].quantity]
    borders = _candidates(predicate.quantity, column, *places)
    predicate = next((x for x in borders if x.relation == predicate.relation), predicate)
    return _round_value(predicate, column, inside, outside)


def _candidates(
    name: str, column: Floats, inside: NDArray[np.intp], outside: NDArray[np.intp]
) -> Iterator[Predicate]:
    """Yield the conditions on one quantity that divide the rows."""
    within, without = column[inside], column[outside]
    if not (np.isfinite(within).all() and np.isfinite(without).all()):
        return
    if name in SCENE:
        for value in _SPECIAL.get(name, (0.0,)):
            if (within == value).all() or (without == value).all():
                yield Predicate(name, IS if (within == value).all() else IS_NOT, value)
    for relation, sign in ((ABOVE, 1.0), (BELOW, -1.0)):
        # the border that gets most rows right: a few may be on the wrong side
        low, high = np.sort(sign * within), np.sort(sign * without)
        wrong = np.searchsorted(low, high, "right") + np.arange(high.size - 1, -1, -1)
        at = high[int(np.argmin(wrong))]
        above = low[low > at]
        if above.size and wrong.min() <= _MAX_MISFITTED * (low.size + high.size):
            yield Predicate(name, relation, sign * float((at + above[0]) / 2))


def _round_value(predicate: Predicate, column: Floats, inside: Bools, outside: Bools) -> Predicate:
    """Return the condition with the roundest number that divides all rows as well."""
    if predicate.relation in (IS, IS_NOT):
        return predicate
    fits = predicate.rows({predicate.quantity: column})
    used = inside | outside
    lows = column[used & (fits != (predicate.relation == ABOVE))]
    highs = column[used & (fits == (predicate.relation == ABOVE))]
    if not lows.size or not highs.size:
        return predicate
    low, high = float(lows.max()), float(highs.min())
    above = predicate.relation == ABOVE
    if low <= 0 < high if above else low < 0 <= high:
        return predicate._replace(value=0.0)
    for power in range(math.floor(math.log10(max(-low, high))), -16, -1):
        first, last = math.ceil(low / 10.0**power), math.floor(high / 10.0**power)
        for count in sorted({first, last}, key=abs) if first <= last else ():
            value = float(f"{count}e{power}")
            if low <= value < high if above else low < value <= high:
                return predicate._replace(value=value)
    return predicate
