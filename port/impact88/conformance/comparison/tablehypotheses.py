"""Hypotheses about another program's results, and what its rows show of them.

A hypothesis says which rows of a case it predicts. Those here are no program: the digits written,
the order of the rows, coarser arithmetic.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.fields import FIELDS
from ...equations.edits import readings, variants
from ...errors import UserError
from ...mechanics.accuracy import errorbound
from ...names import SCENE
from ...program.replay import replay
from .agreement import HALF, MAX_SLIGHT_DIFFERENCE, Bools, ComparedRows, Floats
from .predicates import Predicate
from .trials import MIN_FIT, Judge, Program, try_program

PRINTED = "digits of the 1988 printout, which floors"
FLOORED = "floored to the digits given, not rounded"
TRUNCATED = "cut off at the digits given, not rounded"
APPLESOFT = "rounding to 32 bits, as in Applesoft"
SINGLE = "rounding in single precision"
OTHER_ROWS = "results of other rows: the rows, or the results, are in another order"
INFINITE = "infinite where there is a result"
AGREES = "agrees to"  # so many digits: the row's own, and no cause
UNKNOWN = "unexplained"

MAX_REPLAYED = 4000  # rows run by the 1988 program
_MIN_REORDERED_ROWS = 3  # so that no row has another's results by chance
_MAX_TIES = 4  # rows with equal results that are tried

# bits
COST_DIGITS = 3.0
COST_WIDTH = 4.0
_MAX_BITS = 40.0  # earned by a row
_MAX_LOOSE = 1e-6  # relative error bound of a row that shows anything
_SAME_RTOL = 1e-9
"""Relative difference of results of the same program: more than the rounding of another way to
compute them, no more than the effect of 3.14159265 for pi."""
_MAX_FRACTION_LEFT = 0.1  # of a difference, in a row that is explained
MIN_AFFECTED = 0.5  # fraction of the rows able to show coarser arithmetic that it must affect
_TYPICAL_FRACTION_OF_BOUND = 1 / 64  # error of coarser arithmetic, relative to its bound
_WIDTHS = {SINGLE: (24, 27.0, 33.5), APPLESOFT: (32, 34.0, 40.0)}
"""Cause -> bits of the arithmetic, and lowest and highest number of bits measured against the
bound: a typical error is some bits smaller than the bound."""


class TableHypothesis(NamedTuple):
    """A hypothesis: what it says, which rows of a case it predicts, what it costs to state, and the
    bits that a row earns, None for those by which the row is off.

    ``program``: the program that it is, None where it is none; ``names``: the results that it
    gives; ``equivalents``: other programs that predict the same rows.
    """

    says: str
    fits: Callable[[ComparedRows], Bools]
    cost: float
    bits: float | None = None
    program: Program | None = None
    names: Sequence[str] = ()
    equivalents: Sequence[Program] = ()

    @property
    def where(self) -> Predicate | None:
        """The condition under which its program holds, None where it always does."""
        return self.program.where if self.program else None

    def results(self, scene: Mapping[str, Any]) -> dict[str, Any]:
        """Return the results that its program gives for scenes (columns of n), by name."""
        return (self.program or Program()).results(scene)


@cache
def cost_named() -> float:
    """Return the bits, whole ones, that it takes to choose one of the known alternatives."""
    return float(round(math.log2(len(variants()) + len(readings()))))


def plain_hypotheses(case: ComparedRows, wrong: Bools) -> Iterator[TableHypothesis]:
    """Yield the hypotheses about a case that are no program; ``wrong``: the rows that need a
    cause."""
    for says, match in (
        (PRINTED, _match_printout),
        (FLOORED, lambda case: _match_cut(case, np.floor)),
        (TRUNCATED, lambda case: _match_cut(case, np.trunc)),
    ):
        yield TableHypothesis(says, match, COST_DIGITS, 1.0)
    if wrong.sum() >= _MIN_REORDERED_ROWS and case.wrong.mean() > MIN_AFFECTED:
        cost = cost_named() + math.log2(wrong.size) * wrong.sum()
        yield TableHypothesis(OTHER_ROWS, lambda other: _match_other_rows(other, case), cost)
    for says in _WIDTHS:
        if _is_coarse(case, wrong, says):
            yield TableHypothesis(says, partial(_match_width, says=says), COST_WIDTH, 1.0)


def own_digits(case: ComparedRows) -> NDArray[np.object_]:
    """Return what is said of rows whose results are their own to fewer digits, and of those that
    are infinite: neither is another row's, nor a mistake's. "" of all others."""
    says = np.full(case.condition.size, "", object)
    differences = relative_differences(case).max(0, initial=0.0)
    is_infinite = np.isinf(case.values).any(0)
    for row in np.flatnonzero(case.wrong & ~is_infinite & (differences <= MAX_SLIGHT_DIFFERENCE)):
        digits = math.floor(-math.log10(max(differences[row], 1e-16)) + 1e-9)
        says[row] = f"{AGREES} {digits} digits"
    says[case.wrong & is_infinite] = INFINITE
    return says


def needs_cause(case: ComparedRows) -> Bools:
    """Return the rows that disagree by more than their last digits."""
    return np.asarray(case.wrong & (own_digits(case) == ""))


def relative_differences(case: ComparedRows) -> Floats:
    """Return the relative differences beyond the digits written, (results, rows)."""
    with np.errstate(all="ignore"):
        off, sizes = np.abs(case.values - case.ours), case.sizes
        beyond = np.maximum(off - case.units * HALF, 0.0)
        relative = np.where(sizes > 0, beyond / sizes, beyond != 0)
        return np.where(np.isfinite(off), relative, 0.0)


def evidence_bits(case: ComparedRows) -> Floats:
    """Return the bits that a row earns: those by which it is off and that its digits show."""
    relative = relative_differences(case)
    worst = relative.argmax(0), np.arange(relative.shape[1])
    has_size = case.sizes > 0
    digits = np.where(has_size, case.units * HALF / case.sizes, 0.0)
    loose = np.where(has_size, case.loose / case.sizes, 0.0)
    resolution = np.fmax(np.where(np.isfinite(digits), digits, 0.0)[worst], loose[worst])
    ratios = relative[worst] / np.fmax(resolution, 1e-12)
    bits = np.clip(np.log2(np.fmax(ratios, 1.0)), 0.0, _MAX_BITS)
    # where rounding takes most digits, what is left of them shows nothing
    return np.where(loose[worst] > _MAX_LOOSE, 0.0, bits)


def judge_of(case: ComparedRows, wrong: Bools) -> Judge:
    """Return the judge of a case: how far from the other program's results a program's may be."""
    relative = relative_differences(case)
    differences = relative.max(0, initial=0.0)
    sizes, half_units = case.sizes, case.units * HALF
    loose = np.where(sizes > 0, case.loose / sizes, 0.0)
    within = np.fmin(np.fmax(4 * loose, _SAME_RTOL), _MAX_FRACTION_LEFT * differences)
    # another program rounds its own numbers, which may be larger than anything in the scene
    theirs = np.where(wrong & np.isfinite(case.values), np.abs(case.values), 0.0)
    measure = np.fmax(sizes, theirs)
    limits = np.where(wrong, within, np.fmax(loose, _SAME_RTOL)) * measure + half_units
    named = [
        {n: row for n, row in zip(case.names, rows, strict=True) if n != "MUC"}
        for rows in (case.values, limits)
    ]
    return Judge(case.columns, named[0], named[1], wrong)


def match_program(program: Program, case: ComparedRows, names: Sequence[str]) -> Bools:
    """Return the rows of a case that a program predicts, in the results that it gives."""
    wrong = needs_cause(case)
    whole = judge_of(case, wrong)
    judge = whole.select_results(names)
    rows = try_program(program, judge).rows
    if judge.theirs.keys() < whole.theirs.keys():
        # a row that is wrong in other results alone is not explained by these
        rows &= ~(wrong & try_program(Program(), judge).rows)
    return rows


def _match_cut(case: ComparedRows, cut: Callable[[Floats], Floats]) -> Bools:
    """Return the rows whose results are ours cut at the last digit written.

    ``cut``: `numpy.floor` or `numpy.trunc`. Rounding may move a number across the step: 1e-9.
    """
    unit = np.where(case.units > 0, case.units, np.nan)
    steps, ours = case.values / unit, case.ours / unit
    tolerance = 1e-9 * np.maximum(np.abs(ours), 1.0)
    below, above = cut(ours - tolerance), cut(ours + tolerance)
    fits = (np.abs(steps - below) < 1e-6) | (np.abs(steps - above) < 1e-6)
    return np.asarray((fits | np.isnan(case.values)).all(0))


def _match_printout(case: ComparedRows) -> Bools:
    """Return the rows whose results are the 1988 program's own digits.

    At most `MAX_REPLAYED` rows that disagree are replayed; where these fit, the others need only be
    floored.
    """
    floored = _match_cut(case, np.floor)
    places, other_rows = np.split(np.flatnonzero(case.wrong), [MAX_REPLAYED])
    if not all(name in FIELDS for name in case.names):
        return np.zeros(floored.size, bool)
    columns = zip(SCENE, case.scene[:, places].tolist(), strict=False)
    try:
        replay_result = replay({name: [f"{x:.15G}" for x in column] for name, column in columns})
    except UserError:
        return np.zeros(floored.size, bool)
    rows = floored.copy()
    rows[places] = True
    for name, column in zip(case.names, case.values[:, places], strict=True):
        printed_texts = replay_result.printed(name).tolist()
        values = np.array([float(text) if text else np.nan for text in printed_texts])
        rows[places] &= np.isnan(column) | (values == column)
    rows[other_rows] &= bool(rows[places].mean() >= MIN_FIT) if places.size else False
    return rows


def _match_other_rows(case: ComparedRows, table: ComparedRows) -> Bools:
    """Return the rows whose results are those of another row of a table."""
    usable = np.isfinite(table.ours).any(1)
    matching_rows = np.zeros(case.condition.size, bool)
    if not usable.any():
        return matching_rows
    # rows that may belong together are found by the first result, then compared in all
    first = int(np.argmax(usable))
    order = np.argsort(table.ours[first])
    limits = case.units * HALF + np.fmax(case.loose, _SAME_RTOL * case.sizes)
    lowest = np.searchsorted(table.ours[first, order], case.values[first] - limits[first])
    for step in range(_MAX_TIES):
        place = order[np.minimum(lowest + step, order.size - 1)]
        within_limits = np.abs(case.values - table.ours[:, place]) <= limits
        within_limits |= np.isnan(case.values) | ~np.isfinite(table.ours[:, place])
        matching_rows |= within_limits.all(0)
    return matching_rows


def _is_coarse(case: ComparedRows, wrong: Bools, says: str) -> bool:
    """Return whether coarser arithmetic affects the whole table: most of the rows in which it would
    be visible, by as many bits as it should."""
    width, low, high = _WIDTHS[says]
    differences = relative_differences(case).max(0, initial=0.0)
    units = differences / errorbound.relative_bounds(case.condition, 1.0)
    bits = -math.log2(max(float(np.median(units[wrong])), 1e-300))
    digits = np.where(case.sizes > 0, case.units * HALF / case.sizes, 0.0)
    loose = np.where(case.sizes > 0, case.loose / case.sizes, 0.0)
    resolution = np.fmax(digits, loose).max(0)
    bounds = errorbound.relative_bounds(case.condition, 2.0**-width)
    visible = bounds * _TYPICAL_FRACTION_OF_BOUND > resolution
    fits = _match_width(case, says)
    is_widespread = (wrong & visible).sum() >= MIN_AFFECTED * visible.sum()
    return bool(
        low <= bits < high and (fits & wrong).sum() >= MIN_FIT * wrong.sum() and is_widespread
    )


def _match_width(case: ComparedRows, says: str) -> Bools:
    """Return the rows that are off by no more than coarser arithmetic may be."""
    differences = relative_differences(case).max(0, initial=0.0)
    return np.asarray(differences / case.per_unit <= 2.0 ** -_WIDTHS[says][0])


def describe_unexplained(
    broken: Sequence[str], violations: Mapping[str, Bools], difference: float
) -> str:
    """Say of a row without a cause which equations it violates, or how closely it agrees."""
    if broken and len(broken) < len(violations):
        if len(broken) == 1:
            return f"{UNKNOWN}, but only Equation {broken[0]} is violated"
        return (
            f"{UNKNOWN}, but only Equations {', '.join(broken[:-1])} and {broken[-1]} are violated"
        )
    if 0 < difference < 1e-2:
        return f"{UNKNOWN}, but agrees to about {int(-math.log10(difference))} digits"
    if violations and not broken:
        return f"{UNKNOWN}; no equation is violated by the final velocities"
    return UNKNOWN
