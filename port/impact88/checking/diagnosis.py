"""Why another program's results differ: one cause for a table where one explains it.

Every imagined program (`slips.SLIPS`) is run over a sample of the table, those that explain rows
are run over all of it, and rows are given to the cause that explains most, then to the one that
explains most of what is left. Where that leaves much unexplained, slips are tried in pairs. A cause
must earn its name: the digits that it gets right must be many more than chance would give
(`_CERTAIN`), and it must explain a share of the rows that disagree.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..accuracy import errorbound
from ..errors import UserError
from ..fields import FIELDS
from ..replay import replay
from . import otherprograms, residuals
from .agreement import Slack, Theirs, given
from .slip import Slip
from .slips import RARE, READINGS, SLIPS
from .slipsfilling import in_one_equation
from .slipsreading import changing, constant_of, times
from .slipsshowing import ALL_SPEEDS, ENERGIES, FINAL_SPINS, IMPULSES, scaled

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Columns = dict[str, Floats]
Program = tuple[Slip, ...]

PRINTED = "digits of the 1988 printout, which floors"
FLOORED = "floored to the digits given, not rounded"
TRUNCATED = "cut off at the digits given, not rounded"
APPLESOFT = "rounding in 32 bits, as Applesoft's"
SINGLE = "rounding in single precision"
UNKNOWN = "unexplained"
IN_THESE_ROWS = ", in these rows only"
"""Behind a cause that rows that agree refute."""

_WRONG_SAMPLE, _RIGHT_SAMPLE = 60, 30
_PAIR_SAMPLES = (5, 24)
_ENOUGH = 0.9
"""The share of rows explained from which no pairs are tried."""
_MAIN = 0.5
"""The share of the rows that disagree that makes a cause the table's."""
_SMALL = 0.2
"""Below this share of the rows a cause is small."""
_STRAY = 0.1
"""The share of rows that violate an equation in which nothing is wrong, at most."""
_LEAST_SHARE = 0.03
"""A cause of a smaller share of the rows that disagree is not named, where there are many."""
_MANY = 40
_LEAST_PAIR_SHARE = 0.6
_BORNE_OUT = 0.9
"""The share of the rows that agree that a cause must fit, too: less refutes it."""
_LARGE = 1e-5
"""Differences below this share of their size are no pair of slips."""
_CERTAIN, _PAIR_CERTAIN = 4.0, 8.0
"""Digits that a cause must get right beyond ours, all rows together."""
_CLOSE = 1e-9
"""Results this close, as a share of their size, are the same program's."""
_EXPLAINED = 0.1
"""A cause leaves at most this share of a row's difference."""
_WIDESPREAD = 0.5
"""The share of the rows in which coarser arithmetic can be seen that it spoils."""
_TYPICAL = 1 / 64
"""Its error there, as a share of the bound."""
_BITS = {SINGLE: (24, (27.0, 33.5)), APPLESOFT: (32, (34.0, 40.0))}
"""Cause -> bits of the arithmetic, and the range in which the bits measured against the bound lie:
rounding spoils a few bits less than the bound allows."""


@dataclass
class Case:
    """Rows of a table to be explained; all columns are of one length.

    ``texts``: the scenes as decimal text; ``wrong``: the rows that disagree."""

    scene: Columns
    texts: dict[str, list[str]]
    theirs: dict[str, Theirs]
    ours: Columns
    allowed: Slack
    wrong: Bools

    def part(self, rows: NDArray[np.intp]) -> Case:
        """Some of the rows."""
        return Case(
            {name: column[rows] for name, column in self.scene.items()},
            {name: [column[row] for row in rows] for name, column in self.texts.items()},
            {name: Theirs(c.values[rows], c.units[rows]) for name, c in self.theirs.items()},
            {name: column[rows] for name, column in self.ours.items()},
            self.allowed.part(rows),
            self.wrong[rows],
        )


@dataclass
class Diagnosis:
    """What `diagnose` found: the cause of each row that disagrees, in order; and for each equation
    in how many rows that disagree it could be checked, and is violated."""

    causes: list[str]
    equations: dict[str, tuple[int, int]] = field(default_factory=dict)


class _Fit(NamedTuple):
    """How a program fits a case: the rows it explains, and the digits it gets right in each."""

    says: str
    rows: Bools
    digits: Floats


@np.errstate(all="ignore")
def diagnose(case: Case) -> Diagnosis:
    """The likely causes of a case's disagreements."""
    if not case.wrong.any():
        return Diagnosis([])
    fits = [*_cuts(case), *_fits(_candidates(case), case)]
    causes = np.where(case.wrong, UNKNOWN, "").astype(object)
    covering = _worth_naming([fits[place] for place in _cover(fits, case)], case)
    if not covering or (covering[0].rows & case.wrong).sum() < _MAIN * case.wrong.sum():
        _by_precision(causes, case)
    for fit in covering:
        stands = (fit.rows & ~case.wrong).sum() >= _BORNE_OUT * (~case.wrong).sum()
        causes[(causes == UNKNOWN) & fit.rows] = fit.says + ("" if stands else IN_THESE_ROWS)
    violations = residuals.violated(case.scene, case.theirs, case.allowed)
    _by_residuals(causes, case, violations)
    rows = int(case.wrong.sum())
    return Diagnosis(
        causes[case.wrong].tolist(),
        {number: (rows, int((off & case.wrong).sum())) for number, off in violations.items()},
    )


def _worth_naming(covering: list[_Fit], case: Case) -> list[_Fit]:
    """The causes to be named: where most of a table stays unexplained, a cause that explains a
    small part of it may only happen to say the same there as the one that is not known."""
    rows = case.wrong.sum()
    if not covering or rows < _MANY:
        return covering
    explained = np.logical_or.reduce([fit.rows for fit in covering]) & case.wrong
    if explained.sum() >= _MAIN * rows:
        return covering
    return [fit for fit in covering if (fit.rows & case.wrong).sum() >= _SMALL * rows]


# --- which programs to imagine -------------------------------------------------------------------


def _candidates(case: Case) -> list[Program]:
    """The programs that explain rows of a sample, alone or, where none alone does, in pairs."""
    sample = case.part(_spread(case, _WRONG_SAMPLE, _RIGHT_SAMPLE))
    measure = _Measure(sample)
    total = sample.wrong.sum()
    seen: list[Slip] = []
    fits: list[_Fit] = []
    chosen: list[Slip] = []
    unexplained = sample.wrong
    stages = [(*SLIPS, *_measured(case)), RARE, _in_the_equation(sample)]
    for slips in stages:
        more = list(_visible(slips, sample))
        seen += [slip for slip, _ in more]
        fits += [measure.fit(slip.says, results) for slip, results in more]
        places = _cover(fits, sample)
        chosen = [seen[place] for place in places]
        unexplained = sample.wrong & ~np.logical_or.reduce([fits[place].rows for place in places])
        if unexplained.sum() <= (1 - _ENOUGH) * total:
            break
    found: list[Program] = [(slip,) for slip in chosen]
    if unexplained.sum() > (1 - _ENOUGH) * total and np.median(measure.off[unexplained]) > _LARGE:
        common = [slip for slip in seen if slip.common]
        main = chosen if unexplained.sum() <= (1 - _MAIN) * total else common
        found += _pairs(main, common, sample, unexplained)
    return found


def _in_the_equation(sample: Case) -> tuple[Slip, ...]:
    """Readings in the one equation that the results violate, if it is one."""
    violations = residuals.violated(sample.scene, sample.theirs, sample.allowed)
    rows = sample.wrong.sum()
    broken = [n for n, off in violations.items() if (off & sample.wrong).sum() > _STRAY * rows]
    return tuple(in_one_equation(broken[0], READINGS)) if len(broken) == 1 else ()


def _visible(slips: Sequence[Slip], sample: Case) -> Iterator[tuple[Slip, Columns]]:
    """The slips that can be seen in the table's columns at all, and their results."""
    plain, *results = otherprograms.run([(), *((slip,) for slip in slips)], sample.scene)
    for slip, changed in zip(slips, results, strict=True):
        if any(
            name in changed and not np.array_equal(changed[name], plain[name], equal_nan=True)
            for name in sample.theirs
        ):
            yield slip, changed


def _spread(case: Case, wrong: int, right: int) -> NDArray[np.intp]:
    """Row numbers of some rows that disagree and some that agree, spread over the table."""
    chosen = []
    for rows, count in ((case.wrong, wrong), (~case.wrong, right)):
        places = np.flatnonzero(rows)
        if places.size > count:
            places = places[np.linspace(0, places.size - 1, count).astype(int)]
        chosen.append(places)
    return np.concatenate(chosen)


def _measured(case: Case) -> list[Slip]:
    """Slips whose size the table itself tells: results a constant times ours, coefficients that
    are the same in every row."""
    slips = []
    groups = {
        "velocities": ALL_SPEEDS,
        "final spins": FINAL_SPINS,
        "energies": ENERGIES,
        "impulses": IMPULSES,
        **{name: (name,) for name in case.theirs if name != "MUC"},  # of which no program has any
    }
    for what, names in groups.items():
        there = [name for name in names if name in case.theirs]
        factor = _ratio(
            [case.theirs[name].values[case.wrong] for name in there],
            [case.ours[name][case.wrong] for name in there],
        )
        if factor is not None:
            says = f"{what} {factor:.6g} times as large as here"
            slips.append(Slip(says, results=scaled(there, factor), common=False))
    for name, values in residuals.effective(case.scene, case.theirs).items():
        usable = values[case.wrong & np.isfinite(values)]
        if usable.size and (constant := _rounded(float(np.median(usable)))) is not None:
            change = changing((name,), constant_of(constant))
            slips.append(Slip(f"{name} fixed at {constant:g}", change, late=True, common=False))
        own = case.ours["MUP"] if name == "MU" else case.scene[name]
        factor = _ratio([values[case.wrong]], [own[case.wrong]])
        if factor is not None:
            change = times((name,), factor)
            slips.append(Slip(f"{name} taken {factor:.6g} times as large", change, common=False))
    return slips


def _ratio(theirs: Sequence[Floats], ours: Sequence[Floats]) -> float | None:
    """The median ratio, where there is one that is not 1."""
    if not theirs:
        return None
    with np.errstate(all="ignore"):
        ratios = np.concatenate(theirs) / np.concatenate(ours)
    ratios = ratios[np.isfinite(ratios)]
    if not ratios.size:
        return None
    factor = float(f"{np.median(ratios):.12g}")
    return None if abs(factor - 1) < 1e-6 or factor == 0 else factor


def _rounded(value: float) -> float | None:
    """A constant as somebody would type it: three digits."""
    return float(f"{value:.3g}") if math.isfinite(value) else None


def _pairs(
    main: Sequence[Slip], common: Sequence[Slip], sample: Case, unexplained: Bools
) -> list[Program]:
    """Pairs that explain what no slip alone explains: one of ``main``, which explain other rows
    alone if any do, and one of ``common``."""
    if main is common:
        pairs: list[Program] = list(combinations(common, 2))
    else:
        pairs = [(one, other) for one in main for other in common if other not in main]
    for size in _PAIR_SAMPLES:
        places = np.flatnonzero(unexplained)
        few = sample.part(places[:: max(1, places.size // size)][:size])
        results = otherprograms.run(pairs, few.scene)
        measure = _Measure(few)
        explained = [measure.fit("", one).rows.mean() >= _LEAST_PAIR_SHARE for one in results]
        pairs = [pair for pair, good in zip(pairs, explained, strict=True) if good]
        if not pairs:
            break
    return pairs


def _says(program: Program) -> str:
    return "; and ".join(slip.says for slip in program)


# --- which of them fit ---------------------------------------------------------------------------


def _fits(programs: Sequence[Program], case: Case) -> list[_Fit]:
    results = otherprograms.run(programs, case.scene) if programs else []
    measure = _Measure(case)
    return [
        measure.fit(_says(program), result, len(program))
        for program, result in zip(programs, results, strict=True)
    ]


class _Measure:
    """How far a case's results are from ours, and how near a program must come to explain them."""

    def __init__(self, case: Case) -> None:
        # a result is a row here: numpy then has few operations to start for each program
        self.names = list(case.theirs)
        there = given(case.theirs, case.ours)
        self.there = np.stack([there[name] for name in self.names])
        self.values = np.stack([case.theirs[name].values for name in self.names])
        units = np.stack([case.theirs[name].units for name in self.names])
        self.sizes = np.stack([case.allowed.sizes[name] for name in self.names])
        self.written = units * (0.5 + 1e-9)
        with np.errstate(all="ignore"):
            real = np.where(self.there, self._difference(case.ours), 0.0)
            shown = np.where(self.there & (self.sizes > 0), self.written / self.sizes, 0.0)
            worst = np.argmax(real, axis=0)[None]
            off = np.take_along_axis(real, worst, 0)[0]
            room = np.fmax(np.take_along_axis(shown, worst, 0)[0], case.allowed.elimination)
            digits = np.log10(np.clip(off / np.fmax(room, 1e-12), 1.0, 1e12))
        near = np.fmin(np.fmax(4 * case.allowed.elimination, _CLOSE), _EXPLAINED * off)
        self.limit = np.where(case.wrong, near, case.allowed.elimination)
        self.off, self.room = off, room
        self.digits = np.where(case.wrong, digits, 0.0)

    def _difference(self, results: Columns) -> Floats:
        """How far results are off beyond the digits they are written with, as shares."""
        mine = np.stack([results.get(name, values) for name, values in self._columns()])
        beyond = np.maximum(np.abs(self.values - mine) - self.written, 0.0)
        return np.where(self.sizes > 0, beyond / self.sizes, np.where(beyond == 0, 0.0, np.inf))

    def _columns(self) -> Iterator[tuple[str, Floats]]:
        return zip(self.names, self.values, strict=True)

    def fit(self, says: str, results: Columns, slips: int = 1) -> _Fit:
        """The rows whose every result a program explains; MUC, which it does not give, it does."""
        with np.errstate(all="ignore"):
            near = (self._difference(results) <= self.limit) | ~self.there
        need = _CERTAIN if slips == 1 else _PAIR_CERTAIN
        rows: Bools = np.logical_and.reduce(near)
        return _Fit(says, rows, self.digits * _CERTAIN / need)


def _cover(fits: Sequence[_Fit], case: Case) -> list[int]:
    """The programs that explain most rows that disagree, then most of those left. Of equals, the
    one that the rows that agree do not contradict, then the first."""
    unexplained = case.wrong.copy()
    chosen: list[int] = []
    least = _LEAST_SHARE * case.wrong.sum() if case.wrong.sum() >= _MANY else 0
    while unexplained.any() and fits:
        merit = [
            (int((fit.rows & unexplained).sum()), int((fit.rows & ~case.wrong).sum()), -place)
            for place, fit in enumerate(fits)
        ]
        best = -max(merit)[2]
        explained = fits[best].rows & unexplained
        if explained.sum() <= least or fits[best].digits[explained].sum() < _CERTAIN:
            break
        chosen.append(best)
        unexplained &= ~fits[best].rows
    return chosen


# --- digits and rounding -------------------------------------------------------------------------


def _cuts(case: Case) -> list[_Fit]:
    """Ways of writing right numbers: as the 1988 program does, floored, cut off."""
    digits = np.where(case.wrong, _CERTAIN, 0.0)
    cuts: list[tuple[str, Callable[[Floats], Floats]]] = [
        (FLOORED, np.floor),
        (TRUNCATED, np.trunc),
    ]
    fits = [_Fit(PRINTED, _as_printed(case), digits)]
    for says, cut in cuts:
        rows = np.ones(case.wrong.size, bool)
        for name, column in case.theirs.items():
            there = np.isfinite(column.values)
            rows &= ~there | _is_cut(column, case.ours[name], cut)
        fits.append(_Fit(says, rows, digits))
    return fits


def _is_cut(theirs: Theirs, ours: Floats, cut: Callable[[Floats], Floats]) -> Bools:
    """Whether a result is ours cut at the last digit written (a hair of rounding allowed)."""
    with np.errstate(all="ignore"):
        unit = np.where(theirs.units > 0, theirs.units, np.nan)
        steps, near = theirs.values / unit, ours / unit
        hair = 1e-9 * np.maximum(np.abs(near), 1.0)
        low, high = cut(near - hair), cut(near + hair)
        return (np.abs(steps - low) < 1e-6) | (np.abs(steps - high) < 1e-6)


def _as_printed(case: Case) -> Bools:
    """Rows that are the 1988 program's own digits."""
    none = np.zeros(case.wrong.size, bool)
    if not all(name in FIELDS for name in case.theirs):
        return none
    try:
        replayed = replay(case.texts)
    except UserError:
        return none
    rows = np.ones(case.wrong.size, bool)
    for name, column in case.theirs.items():
        printed = replayed.printed(name).tolist()
        values = np.array([float(text) if text else np.nan for text in printed])
        rows &= ~np.isfinite(column.values) | (values == column.values)
    return rows


def _by_precision(causes: NDArray[np.object_], case: Case) -> None:
    """Name coarser arithmetic where it is the whole table's: most rows in which it could be seen
    suffer from it, and hardly a row more than it explains."""
    measure = _Measure(case)
    bound = case.allowed.per_unit
    with np.errstate(all="ignore"):
        share = measure.off / bound
        best = measure.off / errorbound.relative_bounds(case.ours["COND"], 1.0)
        bits = -math.log2(max(float(np.median(best[case.wrong])), 1e-300))
    for says, (width, (low, high)) in _BITS.items():
        visible = errorbound.relative_bounds(case.ours["COND"], 2.0**-width) * _TYPICAL
        seen = visible > measure.room
        explained = case.wrong & (share <= 2.0**-width)
        if (
            low <= bits < high
            and explained.sum() >= _ENOUGH * case.wrong.sum()
            and (case.wrong & seen).sum() >= _WIDESPREAD * seen.sum()
        ):
            causes[explained] = says
            return


def _by_residuals(causes: NDArray[np.object_], case: Case, violations: Mapping[str, Bools]) -> None:
    """For rows without a cause: how closely they agree, or which equations they violate."""
    worst = _Measure(case).off
    for row in np.flatnonzero(causes == UNKNOWN).tolist():
        broken = [number for number, off in violations.items() if off[row]]
        if broken and len(broken) < len(violations):
            word = "Equation" if len(broken) == 1 else "Equations"
            causes[row] = f"{UNKNOWN}, but only {word} {_listed(broken)} violated"
        elif 0 < worst[row] < 1e-2:
            causes[row] = f"{UNKNOWN}, but agrees to about {int(-math.log10(worst[row]))} digits"
        elif violations and not broken:
            causes[row] = f"{UNKNOWN}; no equation is violated by the final velocities"


def _listed(words: Sequence[str]) -> str:
    *first, last = words
    return f"{', '.join(first)} and {last} are" if first else f"{last} is"
