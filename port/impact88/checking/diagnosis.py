"""Why another program's results differ: one cause for a table where one explains it.

What is looked for, in turn: right numbers written otherwise; one mistake (`trials`); the
velocities and the rest apart; two mistakes (`twofaults`); rows of several programs; coarser
arithmetic. A cause must earn its name: rows that agree must bear it out, and the bits that it gets
right in rows that disagree must be many more than choosing among so many programs yields by chance.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..accuracy import errorbound
from ..equations.evaluation import Run
from ..equations.otherprogram import Program, variants
from ..equations.spelling import LISTING, spellings
from ..errors import UserError
from ..fields import FIELDS
from ..names import FINAL_VELOCITIES
from ..progress import progress
from ..replay import replay
from . import residuals, twofaults
from .agreement import Slack, Theirs, given
from .trials import BORNE_OUT, Found, Judge, outputs, ranked, run, singles, spread

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Columns = dict[str, Floats]

PRINTED = "digits of the 1988 printout, which floors"
FLOORED = "floored to the digits given, not rounded"
TRUNCATED = "cut off at the digits given, not rounded"
APPLESOFT = "rounding in 32 bits, as Applesoft's"
SINGLE = "rounding in single precision"
UNKNOWN = "unexplained"
IN_THESE_ROWS = ", in these rows only"
"""Behind a cause that rows that agree refute."""

_WRONG_SAMPLE, _RIGHT_SAMPLE = 45, 30
_FEW = 8
"""Rows that disagree on which pairs are looked for, and half as many for pairs of readings."""
_SHARE = 0.1
"""The least share of the rows that the first of two mistakes explains alone."""
_FIRSTS = 4
"""Mistakes on top of which another is looked for."""
_SEVERAL = 3
"""Causes that a table of several programs' rows may have."""
_LARGE = 1e-5
"""Differences below this share of their size are no pair of mistakes."""
_NEED, _NEED_NAMED, _NEED_PAIR = 22.0, 10.0, 32.0
"""Bits that a cause must get right: some ten more than one of 30,000 edits, one less than one of
500 known alternatives, and as many as one pair of 30,000 edits in different equations."""
_BITS_A_ROW = 40.0
_CLOSE = 1e-9
"""Results this close, as a share of their size, are the same program's."""
_EXPLAINED = 0.1
"""A cause leaves at most this share of a row's difference."""
_WIDESPREAD = 0.5
"""The share of the rows in which coarser arithmetic can be seen that it spoils."""
_TYPICAL = 1 / 64
"""Its error there, as a share of the bound."""
_WIDTHS = {SINGLE: (24, (27.0, 33.5)), APPLESOFT: (32, (34.0, 40.0))}
"""Cause -> bits of the arithmetic, and the range in which the bits measured against the bound lie:
rounding spoils a few bits less than the bound allows."""
_EQUIVALENTS = 4
"""Other ways to say a cause that are listed."""


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


class Cause(NamedTuple):
    """A cause: what is said of it, how many of the rows that disagree it explains and of those that
    agree it fits, of how many each, and what would do the same."""

    says: str
    explains: int
    disagreeing: int
    fits: int
    agreeing: int
    equivalents: list[str]


@dataclass
class Diagnosis:
    """What `diagnose` found: the cause of each row that disagrees, in order; the evidence for each;
    and for each equation in how many rows that disagree it could be checked, and is violated."""

    causes: list[str]
    evidence: list[Cause] = field(default_factory=list)
    equations: dict[str, tuple[int, int]] = field(default_factory=dict)
    programs: list[Program] = field(default_factory=list)


@np.errstate(all="ignore")
def diagnose(case: Case) -> Diagnosis:
    """The likely causes of a case's disagreements."""
    if not case.wrong.any():
        return Diagnosis([])
    causes = np.where(case.wrong, UNKNOWN, "").astype(object)
    result = Diagnosis([])
    measure = _Measure(case)
    if not _by_digits(causes, case):
        _by_search(causes, case, measure, result)
        if (causes == UNKNOWN).sum() > (1 - BORNE_OUT) * case.wrong.sum():
            _by_precision(causes, case, measure)
    violations = residuals.violated(case.scene, case.theirs, case.allowed)
    _by_residuals(causes, measure, violations)
    rows = int(case.wrong.sum())
    result.causes = causes[case.wrong].tolist()
    result.equations = {n: (rows, int((off & case.wrong).sum())) for n, off in violations.items()}
    return result


def _by_search(
    causes: NDArray[np.object_], case: Case, measure: _Measure, result: Diagnosis
) -> None:
    """Name programs that give their numbers."""
    whole = Judge(
        case.scene,
        {name: column.values for name, column in case.theirs.items() if name != "MUC"},
        dict(zip(measure.names, measure.limits, strict=True)),
        case.wrong,
    )
    # rows that the equations as they stand do not give: near-singular, or decided by rounding
    usual = Judge(case.scene, case.ours, whole.limit, case.wrong).of(measure.names)
    clear = usual.near(Program().results(case.scene), {})
    # rows that are wrong in what no spelling computes
    clear &= ~(case.wrong & run(Program(), whole).rows)
    rows = _sample(case, clear)
    sample = whole.part(rows)
    bits, choices = measure.bits(whole)
    if not sample.wrong.any():
        return
    whole = whole.of(_telling(sample))
    for several in _explanations(sample, measure.off[rows]):
        right = clear & ~case.wrong
        for found in several:
            fits = run(found.program, whole).rows
            explained = fits & (causes == UNKNOWN)
            if _evidence(explained & clear, bits, choices & clear) < _need(found.program):
                continue
            stands = (fits & right).sum() >= BORNE_OUT * right.sum()
            says = found.program.says + ("" if stands else IN_THESE_ROWS)
            causes[explained] = says
            same = [other.program.says for other in found.others][:_EQUIVALENTS]
            result.evidence.append(
                Cause(
                    says,
                    int(explained.sum()),
                    int(case.wrong.sum()),
                    int((fits & right).sum()),
                    int(right.sum()),
                    same,
                )
            )
            result.programs.append(found.program)
        if result.evidence:
            return


def _evidence(explained: Bools, bits: Floats, choices: Bools) -> float:
    """The bits that a cause has got right: of a branch taken one a row, and which rows they are of
    those that would show it."""
    taken, possible = int((explained & choices).sum()), int(choices.sum())
    return float(bits[explained & ~choices].sum()) + taken + math.log2(math.comb(possible, taken))


def _need(program: Program) -> float:
    named = not any(edit.rank for edit in program.edits)
    count = len(program.edits) + len(program.readings)
    return _NEED_PAIR if count > 1 else _NEED_NAMED if named else _NEED


def _sample(case: Case, clear: Bools) -> NDArray[np.intp]:
    """Rows that disagree, then some that agree, of every kind of scene."""
    g = case.scene
    kinds = np.stack(
        [
            *(g["MU"] == -10, g["M"] == 4, g["MU"] == 0, (g["WA"] == 0) & (g["WB"] == 0)),
            *(case.ours["MUP"] == g["MU"], (g["DA"] == 0) & (g["DB"] == 0)),
        ]
    )
    kind = (kinds * 2 ** np.arange(len(kinds))[:, None]).sum(0)
    chosen = []
    for rows, count in ((case.wrong, _WRONG_SAMPLE), (~case.wrong, _RIGHT_SAMPLE)):
        places = np.flatnonzero(rows & clear)
        groups = [places[kind[places] == one] for one in np.unique(kind[places])]
        least = -(-count // max(4 * len(groups), 1))
        taken = [spread(group, least) for group in groups]
        rest = np.setdiff1d(places, np.concatenate(taken)) if groups else places
        taken.append(spread(rest, max(count - sum(map(len, taken)), 0)))
        together = np.sort(np.concatenate(taken)).astype(np.intp)
        chosen.append(together[np.argsort(kind[together], kind="stable")])
    return np.concatenate(chosen)


# --- which programs ------------------------------------------------------------------------------


class _Chosen(NamedTuple):
    """A program that explains rows, and others that explain the same."""

    program: Program
    others: list[Found]


def _explanations(judge: Judge, off: Floats) -> Iterator[list[_Chosen]]:
    """Lists of programs that together explain a table, the simplest first."""
    with progress(5, "look for the cause") as meter:
        meter.update(0)
        reduced = judge.of(_telling(judge))
        alone = singles(reduced, reduced.wrong)
        if alone and alone[0].whole(judge.wrong):
            # what it leaves may be another mistake's: a branch that few rows take
            found = []
            if alone[0].explains(judge.wrong) < judge.wrong.sum():
                found = [run(program, reduced) for program in _by_rows(reduced, alone)]
                found = ranked(found, judge.wrong)
            if found and found[0].explains(judge.wrong) == judge.wrong.sum():
                yield [_best(found, judge)]
            yield [_best(alone, judge)]
        meter.update(1)
        if np.median(off[judge.wrong]) > _LARGE:
            for programs in _pairs(judge, reduced, alone, meter.update):
                found = ranked([run(program, reduced) for program in programs], judge.wrong)
                found = [one for one in found if one.whole(judge.wrong)]
                if found:
                    yield [_best(found, judge)]
        several = _several(alone, judge)
        if several:
            yield several


def _telling(judge: Judge) -> list[str]:
    """The final velocities, and what does not follow from theirs as it should: what does says
    nothing more."""
    names = list(judge.theirs)
    if not _has_velocities(judge):
        return names
    theirs = {name: judge.theirs[name] for name in FINAL_VELOCITIES}
    follows = Run(spellings()[LISTING], judge.scene, theirs).names
    return [
        name
        for name in names
        if name in FINAL_VELOCITIES
        or name not in follows
        or judge.of([name]).near(follows, {}).mean() < BORNE_OUT
    ]


def _has_velocities(judge: Judge) -> bool:
    return all(name in judge.theirs for name in FINAL_VELOCITIES)


def _best(found: Sequence[Found], judge: Judge) -> _Chosen:
    """Of programs that explain alike, the one that all results bear out, or the likeliest."""
    top = found[0]
    alike = [one for one in found if np.array_equal(one.rows, top.rows)]
    full = [run(one.program, judge, one.rank) for one in alike]
    order = sorted(range(len(alike)), key=lambda i: (-int(full[i].rows.sum()), alike[i].rank))
    return _Chosen(alike[order[0]].program, [alike[i] for i in order[1:]])


def _pairs(
    judge: Judge, reduced: Judge, alone: Sequence[Found], done: Callable[[int], object]
) -> Iterator[list[Program]]:
    """Programs with two mistakes, by stages."""
    few = reduced.part(reduced.few(reduced.wrong, _FEW))
    if _has_velocities(judge):
        velocities = judge.of(FINAL_VELOCITIES)
        ours = run(Program(), velocities)
        wrong = judge.wrong & ~ours.rows
        if wrong.sum() <= (1 - BORNE_OUT) * judge.wrong.sum():
            yield list(outputs(reduced, Program()))
            done(1)
            return
        velocities = Judge(judge.scene, velocities.theirs, judge.limit, wrong)
        first = [one for one in singles(velocities, wrong) if one.whole(wrong)]
        done(1)
        for one in first[:_FIRSTS]:
            yield list(outputs(reduced, one.program))
        finals = velocities.part(velocities.few(wrong, _FEW))
        finals = finals.part(
            np.flatnonzero(np.all([np.isfinite(c) for c in finals.theirs.values()], axis=0))
        )
        for look in (twofaults.pairs, twofaults.read_and_edited):
            found = [run(program, velocities) for program in look(finals)]
            good = [one for one in ranked(found, wrong) if one.whole(wrong)]
            yield [one.program for one in good]
            for one in good[:_FIRSTS]:
                yield list(outputs(reduced, one.program))
        done(1)
    yield list(_by_rows(reduced, alone))
    done(1)
    yield list(twofaults.two_readings(few.part(few.few(few.wrong, _FEW // 2))))


def _by_rows(judge: Judge, alone: Sequence[Found]) -> Iterator[Program]:
    """One mistake explains some rows alone; another, on top of it, the others."""
    enough = [one for one in alone if one.explains(judge.wrong) >= _SHARE * judge.wrong.sum()]
    for one in [one for one in enough if one.stands(judge.wrong)][:_FIRSTS]:
        unexplained = judge.wrong & ~one.rows
        if unexplained.any():
            for other in singles(judge, unexplained, one.program)[:2]:
                yield other.program


def _several(alone: Sequence[Found], judge: Judge) -> list[_Chosen]:
    """Few programs that explain nearly all rows, each some: a table of several programs' rows."""
    left = judge.wrong.copy()
    chosen: list[_Chosen] = []
    while alone and left.any() and len(chosen) < _SEVERAL:
        best = max(alone, key=lambda one: ((one.rows & left).sum(), -one.rank))
        if not (best.rows & left).any():
            break
        chosen.append(_Chosen(best.program, []))
        left &= ~best.rows
    explained = judge.wrong.sum() - left.sum()
    return chosen if explained >= BORNE_OUT * judge.wrong.sum() else []


# --- how near ------------------------------------------------------------------------------------


class _Measure:
    """How far a case's results are from ours, and how near a program must come to explain them."""

    def __init__(self, case: Case) -> None:
        self.names = list(case.theirs)
        there = given(case.theirs, case.ours)
        mask = np.stack([there[name] for name in self.names])
        values = np.stack([case.theirs[name].values for name in self.names])
        ours = np.stack([case.ours[name] for name in self.names])
        sizes = np.stack([case.allowed.sizes[name] for name in self.names])
        written = np.stack([case.theirs[name].units for name in self.names]) * (0.5 + 1e-9)
        beyond = np.maximum(np.abs(values - ours) - written, 0.0)
        share = np.where(sizes > 0, beyond / sizes, np.where(beyond == 0, 0.0, 1.0))
        share = np.where(mask, share, 0.0)
        worst = np.argmax(share, axis=0)[None]
        self.off = np.take_along_axis(share, worst, 0)[0]
        shown = np.where(mask & (sizes > 0), written / sizes, 0.0)
        self.room = np.fmax(np.take_along_axis(shown, worst, 0)[0], case.allowed.elimination)
        near = np.fmin(np.fmax(4 * case.allowed.elimination, _CLOSE), _EXPLAINED * self.off)
        self.limits = np.where(case.wrong, near, np.fmax(case.allowed.elimination, _CLOSE)) * sizes
        self.limits = self.limits + written

    def bits(self, judge: Judge) -> tuple[Floats, Bools]:
        """What a cause that explains a row has got right by it; and the rows that show nothing but
        which branch is taken, of friction's sign or of the pivot."""
        bits = np.clip(np.log2(self.off / np.fmax(self.room, 1e-12)), 0.0, _BITS_A_ROW)
        choices = np.zeros(bits.size, bool)
        for edit in variants():
            if edit.says in _BRANCHES:
                other = run(Program((edit,)), judge).rows
                choices |= other & judge.wrong
        if choices.any():
            choices |= ~judge.wrong & (judge.scene["MU"] != 0) & (judge.scene["MU"] != -10)
        return np.where(judge.wrong, bits, 0.0), choices


_BRANCHES = (
    "MU's sign rule inverted",
    "the critical ratio used in place of MU",
)
"""What takes the other branch, of friction's sign or of the pivot, in every row."""


# --- digits and rounding -------------------------------------------------------------------------


def _by_digits(causes: NDArray[np.object_], case: Case) -> bool:
    """Name the way right numbers are written, as the 1988 program does, floored or cut off, where
    that is all; whether it is."""
    fits = {PRINTED: _as_printed(case)}
    cuts: list[tuple[str, Callable[[Floats], Floats]]] = [
        (FLOORED, np.floor),
        (TRUNCATED, np.trunc),
    ]
    for says, cut in cuts:
        rows = np.ones(case.wrong.size, bool)
        for name, column in case.theirs.items():
            there = np.isfinite(column.values)
            rows &= ~there | _is_cut(column, case.ours[name], cut)
        fits[says] = rows
    best = max(fits, key=lambda says: int((fits[says] & case.wrong).sum()))
    if (fits[best] & case.wrong).sum() < BORNE_OUT * case.wrong.sum():
        return False
    for says in (best, *fits):
        causes[(causes == UNKNOWN) & fits[says]] = says
    return True


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


def _by_precision(causes: NDArray[np.object_], case: Case, measure: _Measure) -> None:
    """Name coarser arithmetic where it is the whole table's: most rows in which it could be seen
    suffer from it, and hardly a row more than it explains."""
    share = measure.off / case.allowed.per_unit
    best = measure.off / errorbound.relative_bounds(case.ours["COND"], 1.0)
    bits = -math.log2(max(float(np.median(best[case.wrong])), 1e-300))
    for says, (width, (low, high)) in _WIDTHS.items():
        visible = errorbound.relative_bounds(case.ours["COND"], 2.0**-width) * _TYPICAL
        seen = visible > measure.room
        explained = case.wrong & (share <= 2.0**-width)
        if (
            low <= bits < high
            and explained.sum() >= BORNE_OUT * case.wrong.sum()
            and (case.wrong & seen).sum() >= _WIDESPREAD * seen.sum()
        ):
            causes[explained & (causes == UNKNOWN)] = says
            return


def _by_residuals(
    causes: NDArray[np.object_], measure: _Measure, violations: Mapping[str, Bools]
) -> None:
    """For rows without a cause: how closely they agree, or which equations they violate."""
    worst = measure.off
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
