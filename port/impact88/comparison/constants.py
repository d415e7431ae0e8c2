"""Fit a constant that has a wrong value: each row gives its own, and the rows must agree."""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .conditions import roundest
from .evaluation import FITTED, Alternatives, Edit, Floats, Program, evaluate
from .mutants import entries, sites, slot_name
from .numbers import spread
from .spellings import COLUMNS, NAMES, VELOCITIES

if TYPE_CHECKING:
    from .diagnosis import Sample

ROWS = 8  # of those that disagree, that a constant is fitted to
ITERATIONS = 6  # of the secant method; more change no digit of a constant that rows agree on
FIRST_STEP = 1e-4
MIN_ROWS = 2  # that give a constant
MAX_SPREAD = 1e-2  # of the constants that the rows give, relative; the digits then decide
EXACT_SPREAD = 1e-9  # up to which the constant has all its digits
SHORT_TOLERANCE = 1e-12  # relative distance at which a constant has nine digits or fewer
KNOWN_TOLERANCE = 4e-7  # of a known ratio's distance from 1: a constant as close is that ratio
RANK = 5  # after the edits without a constant
RANK_KNOWN = 1
GROUPS = {
    "<": "GA,PA,PB,TA,TB PA,PB TA,TB DA,DB MA,MB,IA,IB MA,MB IA,IB UX,UY,VX,VY UX,UY VX,VY WA,WB",
    ">": "VAX,VAY,VBX,VBY,WAF,WBF VAX,VAY,VBX,VBY VAX,VAY VBX,VBY WAF,WBF KI,KF DVA,DVB PN,PT",
}
"""Columns read, and results shown, that share a constant."""
KNOWN = {meaning: float(evaluate(text, {})) for meaning, text in entries("ratios")}
"""Ratios of constants and units that are mistaken for each other."""


class Form(NamedTuple):
    """A way in which a constant enters.

    ``text`` has an expression for "{0}" and the constant for "{1}"; ``neutral``: the constant
    without effect; ``says``: what it does to a column.
    """

    text: str
    neutral: float
    says: str


FACTOR = Form("({0}) * {1}", 1.0, "multiplied by {}")
TERM = Form("({0}) + {1}", 0.0, "increased by {}")
CONSTANT = Form("{1}", 0.5, "always {}")
LIMIT = Form(
    "where({0} == -10, {0}, maximum(minimum({0}, {1}), -{1}))",
    0.01,
    "limited to {}",
)
LIMITED = ("E", "MU", "EM")
"""Columns that programs limit."""


@np.errstate(all="ignore")
def fit_constants(sample: "Sample", name: str, part: str) -> list[Edit]:
    """Return the edits of a part of a spelling by one constant that the rows agree on."""
    subset = sample.rows(spread(np.flatnonzero(sample.wrong), ROWS))
    program = Program(name, subset.columns)
    edits = _statement_constants(subset, program, part)
    return edits + _column_constants(subset, program) if name == NAMES[0] else edits


def _column_constants(sample: "Sample", program: Program) -> list[Edit]:
    """Return the edits of columns as they are read, or results as they are shown."""
    edits = []
    for side, verb, names in (("<", "read", COLUMNS[:-1]), (">", "shown", (*sample.theirs,))):
        groups = [group.split(",") for group in GROUPS[side].split()]
        groups = [g for g in groups if set(g) <= set(names)] + [[name] for name in names]
        for group in groups:
            for form in [FACTOR, *[TERM] * (len(group) == 1), *[LIMIT] * (group[0] in LIMITED)]:
                changes = {f"{side} {n}": [form.text.format(n, FITTED)] for n in group}
                constants = _fit(sample, program, changes, form)
                constants += [_known_factor(sample, program, changes)] if form is FACTOR else []
                for constant in filter(np.isfinite, constants):
                    number, meaning = _digits_and_meaning(constant, form)
                    says = f"{', '.join(group)} {form.says.format(number)}, as {verb}{meaning}"
                    texts = {f"{side} {n}": form.text.format(n, number) for n in group}
                    edits.append(Edit(says, texts, RANK_KNOWN if meaning else RANK - 1))
    return edits


def _known_factor(sample: "Sample", program: Program, changes: Alternatives) -> float:
    """Return the known factor that gives most rows.

    Rounded results fix a large factor too loosely to be fitted.
    """
    factors = [k for ratio in KNOWN.values() for k in (ratio, 1 / ratio)]
    alternatives = {key: list(texts) * len(factors) for key, texts in changes.items()}
    fits = sample.fits(program.run(alternatives, factors), len(factors))
    return factors[int(fits.sum(1).argmax())]


def _statement_constants(sample: "Sample", program: Program, part: str) -> list[Edit]:
    """Return the edits of an expression in a statement by a constant factor or term."""
    places: dict[str, dict[str, str]] = {}
    for site in sites(program.name, part):
        (target, *twins), (expression, *others) = site.targets, site.expressions
        if not (twins or others or expression in VELOCITIES):
            value = evaluate(expression, program.scope(target, program.computed))
            if np.ndim(value) < 2 and np.size(value) > 1 and value.dtype == float:
                places.setdefault(target, {})[site.holes[0]] = expression
    edits = []
    for target, expressions in places.items():
        for form in (FACTOR, TERM, CONSTANT):
            texts = [
                hole.replace(slot_name(0), f"({form.text.format(expression, '{0}')})")
                for hole, expression in expressions.items()
            ]
            constants = _fit(
                sample, program, {target: [text.format(FITTED) for text in texts]}, form
            )
            for text, constant in zip(texts, constants, strict=True):
                if np.isfinite(constant):
                    number, note = _digits_and_meaning(constant, form)
                    rank = RANK_KNOWN if note else RANK
                    edits.append(Edit("", {target: text.format(number)}, rank, note))
    return edits


def _fit(sample: "Sample", program: Program, changes: Alternatives, form: Form) -> list[float]:
    """Return the constant in each alternative that the rows agree on, NaN where they do not.

    Notes
    -----
    The secant method, in each row by itself; the results' differences are least squares.
    """
    shape = (len(next(iter(changes.values()))), sample.wrong.size)

    def misfit(k: Floats) -> Floats:
        names = program.run(changes, k)
        differences = np.empty((len(sample.theirs), *shape))
        for row, (n, theirs) in zip(differences, sample.theirs.items(), strict=True):
            row[:] = (names[n] - theirs) / sample.limits[n]
        return differences

    k = np.full(shape, form.neutral)
    new = k + FIRST_STEP
    before = misfit(k)
    for iteration in range(ITERATIONS):
        after = misfit(new)
        slope = after - before
        good = np.isfinite(slope) & np.isfinite(after)
        step = np.where(good, after * slope, 0).sum(0) / np.where(good, slope * slope, 0).sum(0)
        step = step * (new - k)
        k, before = new, after
        new = np.where(np.isfinite(step), new - step, new)
        if not iteration:  # what does not depend on the constant tells nothing of it
            new[~np.any(good & (slope != 0), 0)] = np.nan
    return [_common_constant(row, form) for row in new]


def _common_constant(values: Floats, form: Form) -> float:
    """Return the constant that half of the rows agree on, with the fewest digits; else NaN.

    Where rounded results leave it open, those from the first quarter to the last agree.
    """
    values = np.sort(values[np.isfinite(values)])
    if values.size < MIN_ROWS:
        return np.nan
    half = values.size // 2
    start = int(np.argmin(values[half:] - values[: values.size - half]))
    middle = float(values[start + half // 2])
    if abs(middle - form.neutral) < EXACT_SPREAD:
        return np.nan
    if values[start + half] - values[start] <= EXACT_SPREAD * abs(middle):
        short = float(f"{middle:.9g}")
        return short if abs(short - middle) <= SHORT_TOLERANCE * abs(middle) else middle
    outer = (values.size - 1) // 4
    low, high = float(values[outer]), float(values[-1 - outer])
    return roundest(low, high) if high - low <= MAX_SPREAD * abs(middle) else np.nan


def _digits_and_meaning(constant: float, form: Form) -> tuple[str, str]:
    """Return a constant's digits, and what it is known as."""
    meanings = [
        name
        for name, value in KNOWN.items()
        if form is FACTOR
        and min(abs(constant / value - 1), abs(constant * value - 1))
        < KNOWN_TOLERANCE * min(1, abs(value - 1))
    ]
    return f"{constant:.15g}", f" ({meanings[0]})" if meanings else ""
