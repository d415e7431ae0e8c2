"""Why another program's results differ: one cause for a table where one explains it.

Looked for in turn: right numbers written otherwise; one mistake, then two (`trials`), and what they
leave; rows of several programs; coarser arithmetic. Scenes as casework and its limits have them
come first, then what those beyond (no mass, MU of another pivot, overflow) show besides. Rows that
agree must bear a cause out, and the bits that it gets right must be many more than choosing among
so many programs yields by chance.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..collision.fields import FIELDS
from ..errors import UserError
from ..mechanics.accuracy import errorbound
from ..messages.progress import progress
from ..names import FINAL_VELOCITIES, PIVOT, SCENE
from ..program.vectorized import replay
from .agreement import HALF, Bools, Case, Floats, violated
from .constants import fitted
from .equations.edits import RARE_CONVENTION, readings, variants
from .equations.evaluation import Run
from .equations.spelling import LISTING, spellings
from .trials import BORNE_OUT, Found, Judge, Program, pairs, ranked, run, singles, spread

PRINTED = "digits of the 1988 printout, which floors"
FLOORED = "floored to the digits given, not rounded"
TRUNCATED = "cut off at the digits given, not rounded"
APPLESOFT = "rounding in 32 bits, as Applesoft's"
SINGLE = "rounding in single precision"
OTHER_ROWS = "results of other rows: the order of the rows, or of the results, is another"
UNKNOWN = "unexplained"
IN_THESE_ROWS = ", in these rows only"
"""Behind a cause that rows that agree refute."""

# Doubled on ten tables (seven mistakes, a bug, two pairs), here and in `trials`: all sizes together
# change no cause and take 1.4 times as long; all tolerances together change no cause.
_WRONG_SAMPLE, _RIGHT_SAMPLE = 45, 30
"""Rows that the search looks at: of ten kinds of scene some three each."""
_DEEPER, _MOST = 2, 0.5
"""Mistakes that are looked for in what others leave (pycrash has three in all), and the share of it
that one explains; one row is enough for a known convention."""
_SEVERAL, _EQUIVALENTS = 3, 4
"""Causes that a table of several programs' rows may have; other ways to say one that are listed."""
_NEEDED_ROWS, _TIES = 3, 4
"""Rows that must have others' results, so that none does by chance; rows alike in one result that
are tried."""
_LARGE = 1e-5
"""Differences below this share of their size are no pair of mistakes, but coarse arithmetic."""
_NEED, _NEED_NAMED, _NEED_PAIR = 22.0, 10.0, 32.0
"""Bits that a cause must get right: some ten more than one of 30,000 edits, one less than one of
500 known alternatives, and as many as one pair of 30,000 edits in different equations."""
_BITS_A_ROW = 40.0
"""What one row counts for at most: more than any need, so that two rows of doubles are enough."""
_CLOSE, _EXPLAINED = 1e-9, 0.1
"""Results this close, as a share of their size, are the same program's: more than another way to
compute them rounds, no more than 3.14159265 for pi does; and at most this share of a difference."""
_WIDESPREAD, _TYPICAL = 0.5, 1 / 64
"""The share of the rows that could show coarser arithmetic that it spoils; its error, as a share of
the bound."""
_WIDTHS = {SINGLE: (24, 27.0, 33.5), APPLESOFT: (32, 34.0, 40.0)}
"""Cause -> bits of the arithmetic, and the range in which the bits measured against the bound lie:
rounding spoils a few bits less than the bound allows."""
_INVERTED = "MU's sign rule inverted"
_ALIKE = (_INVERTED, "Γ half a turn on: the normal the other way round")
"""Two mistakes that give the same final velocities."""
_BRANCHES = (_INVERTED, "the critical ratio used in place of MU")
"""Models that take the other branch, of friction's sign or of the pivot, in every row."""
LOOKED_INTO = 4000
"""Rows that agree, and must bear a cause out, and rows that the 1988 program is run on: they bound
time and memory of large tables."""


class Cause(NamedTuple):
    """A cause: what is said of it, how many of the rows that disagree it explains and of those that
    agree it fits, of how many each, and what would do the same; where it is several mistakes, each,
    and the first row that shows it."""

    says: str
    explains: int
    disagreeing: int
    fits: int
    agreeing: int
    equivalents: list[str]
    parts: dict[str, int]


class Unexplained(NamedTuple):
    """Rows of one kind of scene: how many there are, how many of them disagree without a cause, and
    in how many of these each equation is violated."""

    rows: int
    unexplained: int
    violated: dict[str, int]


class Diagnosis:
    """Why rows of a case disagree: ``causes`` of each that does, in order; the ``evidence`` for
    each, and the ``programs``; ``equations``: in how many of the rows each could be checked, and is
    violated; ``unexplained``: by kind of scene, where rows are left without a cause."""

    @np.errstate(all="ignore")
    def __init__(self, case: Case) -> None:
        self._case, self._wrong = case, (wrong := case.wrong)
        self._causes = np.where(wrong, UNKNOWN, "").astype(object)
        self.evidence: list[Cause] = []
        self.programs: list[Program] = []
        violations = violated(case)
        self.equations = {
            number: (int(wrong.sum()), int((off & wrong).sum()))
            for number, off in violations.items()
        }
        # how far off the results are, and how near a program must come to explain them
        off, sizes, written = np.abs(case.values - case.ours), case.sizes, case.units * HALF
        beyond = np.maximum(off - written, 0.0)
        share = np.where(sizes > 0, beyond / sizes, beyond != 0)
        share = np.where(np.isfinite(off), share, 0.0)
        worst = share.argmax(0), np.arange(wrong.size)
        self._off = share[worst]
        digits = np.where(np.isfinite(off) & (sizes > 0), written / sizes, 0.0)
        loose = np.where(sizes > 0, case.loose / sizes, 0.0)
        self._room = np.fmax(digits[worst], loose[worst])
        near = np.fmin(np.fmax(4 * loose, _CLOSE), _EXPLAINED * self._off)
        # another program rounds what it has, which may be larger than anything in the scene
        theirs = np.where(wrong & np.isfinite(case.values), np.abs(case.values), 0.0)
        measure = np.fmax(sizes, theirs)
        self._limits = np.where(wrong, near, np.fmax(loose, _CLOSE)) * measure + written
        if not self._by_digits():
            self._by_search()
            if self._open.sum() > (1 - BORNE_OUT) * wrong.sum():
                self._by_order()
            if self._open.sum() > (1 - BORNE_OUT) * wrong.sum():
                self._by_precision()
        self.unexplained = self._by_kind(violations) if self._open.any() else {}
        self._by_residuals(violations)

    def _by_kind(self, violations: Mapping[str, Bools]) -> dict[str, Unexplained]:
        """Return what is left without a cause, by kind of scene; each row is of the first kind that
        it fits."""
        g = self._case.columns
        kinds = {
            **_strata(g),
            "point masses": g["M"] == 4,
            "the pivot (MU = -10)": g["MU"] == PIVOT,
            "no friction (MU = 0)": g["MU"] == 0,
            "no moment (EM = 1)": g["EM"] == 1,
            "all other scenes": np.ones(self._wrong.size, bool),
        }
        left = np.ones(self._wrong.size, bool)
        counted: dict[str, Unexplained] = {}
        for name, rows in kinds.items():
            rows, left = rows & left, left & ~rows
            open_rows = rows & self._open
            if rows.any():
                violated = {n: int((off & open_rows).sum()) for n, off in violations.items()}
                violated = {number: count for number, count in violated.items() if count}
                counted[name] = Unexplained(int(rows.sum()), int(open_rows.sum()), violated)
        return counted

    @property
    def causes(self) -> list[str]:
        """The cause of each row that disagrees."""
        return list(self._causes[self._wrong])

    @property
    def _open(self) -> Bools:
        return np.asarray(self._causes == UNKNOWN)

    def _by_search(self) -> None:
        case = self._case
        theirs, limits, ours = (
            {n: row for n, row in zip(case.names, rows, strict=True) if n != "MUC"}
            for rows in (case.values, self._limits, case.ours)
        )
        whole = Judge(case.columns, theirs, limits, self._wrong)
        # rows that the equations as they stand do not give: near-singular, or decided by rounding
        clear = whole._replace(theirs=ours).near(Program().results(case.columns))
        # rows that are wrong in what no spelling computes
        clear &= ~(whole.wrong & run(Program(), whole).rows)
        strata = _strata(case.columns)
        usual = ~np.any([*strata.values()], axis=0)
        bits, choices = self._bits(whole)
        # casework and its limits first; then what only scenes beyond them show
        if (whole.wrong & clear & usual).any():
            self._by_sample(whole, clear & usual, clear, bits, choices)
        else:
            self._by_sample(whole, clear, clear, bits, choices)
        for name, rows in strata.items():
            self._by_stratum(name, whole, clear & rows, bits, choices)
        if not self.programs:
            self._by_constant(whole, clear & usual, bits)

    def _by_sample(
        self, whole: Judge, searched: Bools, clear: Bools, bits: Floats, choices: Bools
    ) -> None:
        """Name what explains a table, looked for in a sample of the rows ``searched``."""
        rows = _sample(whole, searched)
        sample = whole.part(rows)
        if not sample.wrong.any():
            return
        whole = whole.of(_telling(sample))
        right = clear & ~whole.wrong
        ours = Program().results(whole.scene)
        amiss = [n for n in whole.theirs if (whole.wrong & ~whole.of([n]).near(ours)).any()]
        coarse = bool(np.median(self._off[rows][sample.wrong]) > _LARGE)
        for several in _explanations(sample, coarse):
            for program, others, names in several:
                part = whole.narrowed(names)
                fits = run(program, part).rows
                explained = fits & part.wrong & self._open
                if not _earned(program, explained & clear, bits, choices & clear):
                    continue
                stands = (fits & right).sum() >= BORNE_OUT * right.sum()
                says = self._in_both_words(program.says, whole) + ("" if stands else IN_THESE_ROWS)
                # a result that is right needs no cause, whatever the program makes of it
                if unexplained := [name for name in amiss if name not in names]:
                    says += f"; {', '.join(unexplained)} {UNKNOWN}"
                self._causes[explained] = says
                same = [other.program.says for other in others[:_EQUIVALENTS]]
                a, b, c, d = (int(x.sum()) for x in (explained, part.wrong, fits & right, right))
                parts = _parts(program, part, explained)
                self.evidence.append(Cause(says, a, b, c, d, same, parts))
                self.programs.append(program)
            if self.evidence:
                return

    def _in_both_words(self, says: str, judge: Judge) -> str:
        """What is said of a program; where it is one of two that hardly a row tells apart, both.
        The normal's direction matters to the rule of MU's sign alone, but for results along it."""
        parts = says.split("; and ")
        if not set(parts) & set(_ALIKE):
            return says
        edits = {edit.says: edit for edit in (*variants(), *readings()) if edit.says in _ALIKE}
        inverted, turned = (Program((edits[name],)).results(judge.scene) for name in _ALIKE)
        alike = judge._replace(theirs={n: inverted[n] for n in judge.theirs if n in inverted})
        if (~alike.near(turned) & judge.wrong).sum() > (1 - BORNE_OUT) * judge.wrong.sum():
            return says
        return "; and ".join(", or ".join(_ALIKE) if part in _ALIKE else part for part in parts)

    def _by_constant(self, judge: Judge, clear: Bools, bits: Floats) -> None:
        """Name a constant that is wrong: any number that explains nearly all rows."""
        rows = _sample(judge, clear)
        sample = judge.part(rows)
        if not sample.wrong.any():
            return
        judge = judge.of(_telling(sample))
        for program in fitted(judge.part(rows)):
            fits = run(program, judge).rows
            explained = fits & judge.wrong & self._open
            # a number has been chosen, too
            if bits[explained & clear].sum() < _NEED_NAMED + _BITS_A_ROW:
                continue
            right = clear & ~judge.wrong
            if (fits & right).sum() < BORNE_OUT * right.sum():
                continue
            self._causes[explained] = program.says
            a, b, c, d = (int(x.sum()) for x in (explained, judge.wrong, fits & right, right))
            self.evidence.append(Cause(program.says, a, b, c, d, [], {}))
            self.programs.append(program)
            return

    def _by_order(self) -> bool:
        """Name results that are ours of other rows; whether that is all."""
        case, wrong = self._case, self._wrong
        usable = np.isfinite(case.ours).any(1)
        if wrong.sum() < _NEEDED_ROWS or not usable.any():
            return False
        first = int(np.argmax(usable))
        order = np.argsort(case.ours[first])
        limits = case.units * HALF + np.fmax(case.loose, _CLOSE * case.sizes)
        lowest = np.searchsorted(case.ours[first, order], case.values[first] - limits[first])
        matched = np.zeros(wrong.size, bool)
        for step in range(_TIES):
            place = order[np.minimum(lowest + step, wrong.size - 1)]
            near = np.abs(case.values - case.ours[:, place]) <= limits
            near |= ~(np.isfinite(case.values) & np.isfinite(case.ours[:, place]))
            matched |= near.all(0)
        if (matched & wrong).sum() < BORNE_OUT * wrong.sum():
            return False
        self._causes[matched & wrong] = OTHER_ROWS
        return True

    def _by_stratum(
        self, name: str, judge: Judge, rows: Bools, bits: Floats, choices: Bools
    ) -> None:
        """Name what the rows of one kind that are still open show, alone or on top of what explains
        the rest."""
        left = judge.wrong & self._open & rows
        if not left.any():
            return
        places = np.concatenate([spread(np.flatnonzero(x), _WRONG_SAMPLE) for x in (left, rows)])
        few = judge.part(np.unique(places))
        few = few._replace(wrong=left[np.unique(places)])
        for base in (*self.programs[:1], Program()):
            trial = next(iter(singles(few, few.wrong, base)), None)
            if trial is None or not trial.explains >= _MOST * few.wrong.sum():
                continue
            new = Program(trial.program.edits[len(base.edits) :])
            fits = run(trial.program, judge).rows
            explained = fits & left
            if not _earned(new, explained, bits, choices & rows):
                continue
            right = rows & ~judge.wrong
            stands = (fits & right).sum() >= BORNE_OUT * right.sum()
            says = f"{name}: {trial.program.says}" + ("" if stands else IN_THESE_ROWS)
            self._causes[explained] = says
            a, b, c, d = (int(x.sum()) for x in (explained, left, fits & right, right))
            parts = _parts(trial.program, judge, explained)
            self.evidence.append(Cause(says, a, b, c, d, [], parts))
            self.programs.append(trial.program)
            return

    def _bits(self, judge: Judge) -> tuple[Floats, Bools]:
        """What a cause that explains a row has got right by it; and the rows that show nothing but
        which branch is taken, of friction's sign or of the pivot."""
        bits = np.clip(np.log2(self._off / np.fmax(self._room, 1e-12)), 0.0, _BITS_A_ROW)
        others = [Program((edit,)) for edit in variants() if edit.says in _BRANCHES]
        choices = judge.wrong & np.any([run(other, judge).rows for other in others], axis=0)
        if choices.any():
            choices |= ~judge.wrong & (judge.scene["MU"] != 0) & (judge.scene["MU"] != -10)
        return np.where(judge.wrong, bits, 0.0), choices

    def _by_digits(self) -> bool:
        """Name the way right numbers are written, as the 1988 program does, floored or cut off,
        where that is all; whether it is."""
        case, wrong = self._case, self._wrong
        fits = {PRINTED: _as_printed(case, wrong)}
        fits |= {FLOORED: _are_cut(case, np.floor), TRUNCATED: _are_cut(case, np.trunc)}
        best = max(fits, key=lambda says: int((fits[says] & wrong).sum()))
        if (fits[best] & wrong).sum() < BORNE_OUT * wrong.sum():
            return False
        for says in (best, *fits):
            self._causes[self._open & fits[says]] = says
        return True

    def _by_precision(self) -> None:
        """Name coarser arithmetic where it is the whole table's: most rows in which it could be
        seen suffer from it, and hardly a row more than it explains."""
        wrong, condition = self._wrong, self._case.condition
        best = self._off / errorbound.relative_bounds(condition, 1.0)
        bits = -math.log2(max(float(np.median(best[wrong])), 1e-300))
        for says, (width, low, high) in _WIDTHS.items():
            seen = errorbound.relative_bounds(condition, 2.0**-width) * _TYPICAL > self._room
            explained = wrong & (self._off / self._case.per_unit <= 2.0**-width)
            whole = explained.sum() >= BORNE_OUT * wrong.sum()
            if low <= bits < high and whole and (wrong & seen).sum() >= _WIDESPREAD * seen.sum():
                self._causes[explained & self._open] = says
                return

    def _by_residuals(self, violations: Mapping[str, Bools]) -> None:
        """For rows without a cause: how closely they agree, or which equations they violate."""
        for row in np.flatnonzero(self._open).tolist():
            broken = [number for number, off in violations.items() if off[row]]
            if broken and len(broken) < len(violations):
                which = f"Equations {', '.join(broken[:-1])} and {broken[-1]} are"
                which = which if len(broken) > 1 else f"Equation {broken[0]} is"
                self._causes[row] = f"{UNKNOWN}, but only {which} violated"
            elif 0 < self._off[row] < 1e-2:
                digits = int(-math.log10(self._off[row]))
                self._causes[row] = f"{UNKNOWN}, but agrees to about {digits} digits"
            elif violations and not broken:
                self._causes[row] = f"{UNKNOWN}; no equation is violated by the final velocities"


def _strata(g: Mapping[str, Floats]) -> dict[str, Bools]:
    """Return the rows beyond casework and its limits, by what is unusual about them."""
    bodies = np.fmin(g["MA"], g["MB"]) <= 0
    bodies |= (g["M"] != 4) & (np.fmin(g["IA"], g["IB"]) <= 0)
    speeds = np.max([np.abs(g[name]) for name in ("UX", "UY", "VX", "VY")], 0)
    turned = np.any([g[name] != 0 for name in ("DA", "DB", "WA", "WB")], axis=0)
    return {
        "masses or inertias of 0 or less": bodies,
        "point masses with arms or spins left": (g["M"] == 4) & turned,
        "MU of 10 and more, or below -10": (g["MU"] >= 10) | (g["MU"] < -10),
        "velocities beyond 1E12": speeds > 1e12,
    }


def _are_cut(case: Case, cut: Callable[[Floats], Floats]) -> Bools:
    """Rows whose results are ours cut at the last digit written (a hair of rounding allowed)."""
    unit = np.where(case.units > 0, case.units, np.nan)
    steps, near = case.values / unit, case.ours / unit
    hair = 1e-9 * np.maximum(np.abs(near), 1.0)
    fits = (np.abs(steps - cut(near - hair)) < 1e-6) | (np.abs(steps - cut(near + hair)) < 1e-6)
    return np.asarray((fits | ~np.isfinite(case.values)).all(0))


def _as_printed(case: Case, wrong: Bools) -> Bools:
    """Rows that are the 1988 program's own digits; beyond so many, where those are, floored."""
    rows = np.zeros(wrong.size, bool)
    places, more = np.split(np.flatnonzero(wrong), [LOOKED_INTO])
    if not all(name in FIELDS for name in case.names):
        return rows
    columns = zip(SCENE, case.scene[:, places].tolist(), strict=False)
    try:
        replayed = replay({name: [f"{x:.15G}" for x in column] for name, column in columns})
    except UserError:
        return rows
    rows[places] = True
    for name, column in zip(case.names, case.values[:, places], strict=True):
        printed = replayed.printed(name).tolist()
        values = np.array([float(text) if text else np.nan for text in printed])
        rows[places] &= ~np.isfinite(column) | (values == column)
    rows[more] = (rows[places].mean() >= BORNE_OUT) & _are_cut(case, np.floor)[more]
    return rows


def _parts(program: Program, judge: Judge, explained: Bools) -> dict[str, int]:
    """What is wrong with a program in several ways: each, and the first row that shows it."""
    parts = {}
    for edit in program.edits if len(program.edits) > 1 else ():
        without = Program(tuple(other for other in program.edits if other is not edit))
        shows = explained & ~run(without, judge).rows
        if shows.any():
            parts[edit.text] = int(np.argmax(shows))
    return parts


def _earned(program: Program, explained: Bools, bits: Floats, choices: Bools) -> bool:
    """Whether a cause has got right the bits that it must: of a branch taken one a row, and which
    rows they are of those that would show it."""
    taken, possible = int((explained & choices).sum()), int(choices.sum())
    right = float(bits[explained & ~choices].sum()) + taken
    need = _NEED_NAMED if program.edits[0].rank <= RARE_CONVENTION else _NEED
    need = _NEED_PAIR if len(program.edits) > 1 else need
    return right + math.log2(math.comb(possible, taken)) >= need


def _sample(judge: Judge, clear: Bools) -> NDArray[np.intp]:
    """Rows that disagree, then some that agree, by kind of scene: of every kind its first and last
    at least."""
    g = judge.scene
    kinds = (
        *(g["MU"] == -10, g["M"] == 4, g["MU"] == 0, (g["WA"] == 0) & (g["WB"] == 0)),
        *(Program().results(g)["MUP"] == g["MU"], (g["DA"] == 0) & (g["DB"] == 0)),
    )
    kind = np.sum([of_it << place for place, of_it in enumerate(kinds)], 0)
    chosen = []
    for rows, count in ((judge.wrong, _WRONG_SAMPLE), (~judge.wrong, _RIGHT_SAMPLE)):
        places = np.flatnonzero(rows & clear)
        places = places[np.argsort(kind[places], kind="stable")]
        _, first, many = np.unique(kind[places], return_index=True, return_counts=True)
        evenly = spread(np.arange(places.size), count)
        chosen.append(places[np.unique(np.concatenate([evenly, first, first + many - 1]))])
    return np.concatenate(chosen)


_Chosen = tuple[Program, Sequence[Found], Sequence[str]]
"""A program that explains rows, others that explain the same, and the results that it gives."""


def _explanations(judge: Judge, coarse: bool) -> Iterator[list[_Chosen]]:
    """Lists of programs that together explain a table, the simplest first; ``coarse``: the rows are
    so far off that two mistakes are looked for."""
    with progress(20, "look for the cause") as meter:
        meter.update(0)
        groups = judge.of(_telling(judge)).groups()
        first = judge.narrowed(groups[0])
        alone = singles(first, first.wrong)
        found = [trial for trial in alone if trial.whole]
        stages = pairs(first, alone) if coarse else iter(())
        while not found and (programs := next(stages, None)) is not None:
            meter.update(1)
            found = [trial for trial in ranked(programs, first) if trial.whole]
        if found:
            wrong = {name for group in groups[1:] for name in group}
            rest = judge.narrowed([name for name in judge.theirs if name not in wrong])
            yield [_completed(_deepened(found, rest), groups, judge)]
        yield _several(alone, first, judge)


def _completed(found: Sequence[Found], groups: Sequence[list[str]], judge: Judge) -> _Chosen:
    """Of programs that explain the first group of results alike, the one that all bear out, or the
    likeliest; with what explains the other groups besides."""
    alike = [trial for trial in found if np.array_equal(trial.rows, found[0].rows)]
    alike.sort(key=lambda trial: (-int(run(trial.program, judge).rows.sum()), trial.rank))
    program = alike[0].program
    wrong = [name for group in groups for name in group]
    names = [name for name in judge.theirs if name in groups[0] or name not in wrong]
    for more in (wrong, *groups[1:3]) if len(groups) > 1 else ():
        part = judge.narrowed([*names, *more])
        trial = run(program, part)
        if not trial.whole:
            trial = next(iter(singles(part, part.wrong & ~trial.rows, program)), trial)
        if trial.whole:
            program, names = trial.program, [*names, *more]
        if set(wrong) <= set(names):
            break
    return program, alike[1:] if program is alike[0].program else (), names


def _deepened(found: Sequence[Found], judge: Judge) -> Sequence[Found]:
    """With what the best leaves looked into: another mistake's, of a branch that few rows take."""
    for _ in range(_DEEPER):
        left = judge.wrong & ~found[0].rows
        more = []
        for trial in singles(judge, left, found[0].program) if left.any() else ():
            explains = (trial.rows & left).sum()
            known = trial.program.edits[-1].rank <= RARE_CONVENTION
            if trial.whole and explains >= _MOST * left.sum() and (explains > 1 or known):
                more.append(trial)
        if not more:
            break
        found = more
    return found


def _telling(judge: Judge) -> list[str]:
    """The final velocities, and what does not follow from theirs as it should: what does says
    nothing more."""
    if not judge.has_velocities:
        return list(judge.theirs)
    theirs = {name: judge.theirs[name] for name in FINAL_VELOCITIES}
    follows = Run(spellings()[LISTING], judge.scene, theirs).names
    known = {*follows} - {*FINAL_VELOCITIES}
    alone = {name: judge.of([name]).near(follows).mean() for name in judge.theirs if name in known}
    return [name for name in judge.theirs if alone.get(name, 0.0) < BORNE_OUT]


def _several(alone: Sequence[Found], part: Judge, judge: Judge) -> list[_Chosen]:
    """Few programs that explain nearly all rows, each some, by some results or by all: a table of
    several programs' rows."""
    left = part.wrong.copy()
    chosen: list[_Chosen] = []
    while alone and left.any() and len(chosen) < _SEVERAL:
        best = max(alone, key=lambda trial: ((trial.rows & left).sum(), -trial.rank))
        new = best.rows & left
        if not new.any():
            break
        gives_all = (run(best.program, judge).rows & new).sum() >= BORNE_OUT * new.sum()
        chosen.append((best.program, (), [*(judge if gives_all else part).theirs]))
        left &= ~best.rows
    explained = part.wrong.sum() - left.sum()
    return chosen if explained >= BORNE_OUT * part.wrong.sum() else []
