"""Explain why another program's results differ: one cause for the whole table, where one fits.

Tried in turn: correct numbers written differently (floored, cut off); one mistake, then two
(`trials`), and further ones in the rows left over; rows from several programs; coarser arithmetic.
Ordinary scenes and their limiting cases come first, then what only scenes beyond them show (no
mass, another MU for the pivot, overflow). A cause must also fit the rows that agree, and must get
right many more bits than a choice among so many programs does by chance.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.fields import FIELDS
from ...equations.edits import RARE_CONVENTION, readings, variants
from ...equations.evaluation import Run
from ...equations.spelling import LISTING, spellings
from ...errors import UserError
from ...mechanics.accuracy import errorbound
from ...messages.progress import progress
from ...names import FINAL_VELOCITIES, PIVOT, SCENE
from ...program.vectorized import replay
from .agreement import HALF, Bools, Case, Floats, violated_equations
from .constants import fit_constants
from .trials import (
    MIN_FIT,
    Judge,
    Program,
    Trial,
    find_pairs,
    find_single_edits,
    pick_evenly,
    rank_programs,
    try_program,
)

PRINTED = "digits of the 1988 printout, which floors"
FLOORED = "floored to the digits given, not rounded"
TRUNCATED = "cut off at the digits given, not rounded"
APPLESOFT = "rounding in 32 bits, as Applesoft's"
SINGLE = "rounding in single precision"
OTHER_ROWS = "results of other rows: the order of the rows, or of the results, is another"
INFINITE = "infinite where there is a result"
AGREES = "agrees to"
UNKNOWN = "unexplained"
IN_THESE_ROWS = ", in these rows only"  # appended to a cause that agreeing rows contradict

# Doubled on ten tables (seven mistakes, a bug, two pairs), here and in `trials`: all sizes together
# change no cause and take 1.4 times as long; all tolerances together change no cause.
_MAX_DISAGREEING = 45  # rows that the search looks at: three each of some ten kinds of scene
_MAX_AGREEING = 30
_MAX_FURTHER_EDITS = 2  # looked for in the rows that others leave; pycrash has three in all
_MIN_FRACTION_OF_REST = 0.5
"""Fraction of the rows left over that a further edit must explain. One row is enough for a known
convention."""
_MAX_MIXED_PROGRAMS = 3  # causes of a table whose rows come from several programs
_MAX_EQUIVALENTS = 4  # other programs with the same results that are listed
_MIN_REORDERED_ROWS = 3  # so that no row has another's results by chance
_MAX_TIES = 4  # rows with equal results that are tried
_MIN_PAIR_DIFFERENCE = 1e-5
"""Relative difference below which no pair of mistakes is looked for, only coarser arithmetic."""
# bits that a cause must get right
_MIN_BITS = 22.0  # ten more than choosing one of 30,000 edits takes
_MIN_BITS_NAMED = 10.0  # one more than choosing one of 500 known alternatives
_MIN_BITS_PAIR = 32.0  # as many as choosing a pair of 30,000 edits in different equations
_MAX_BITS_PER_ROW = 40.0  # more than any of these, so that two rows of doubles are enough
_SAME_RTOL = 1e-9
"""Relative difference of results of the same program: more than the rounding of another way to
compute them, no more than the effect of 3.14159265 for pi."""
MAX_SLIGHT_DIFFERENCE = 1e-10
"""Relative difference up to which a row agrees but for its last digits, which is given no cause:
half of what 32 bits of mantissa leave, a twentieth of the effect of 3.14159265 for pi."""
_MAX_FRACTION_LEFT = 0.1  # of a difference, in a row that is explained
_MIN_AFFECTED = 0.5  # fraction of the rows able to show coarser arithmetic that it must affect
_TYPICAL_FRACTION_OF_BOUND = 1 / 64  # error of coarser arithmetic, relative to its bound
_WIDTHS = {SINGLE: (24, 27.0, 33.5), APPLESOFT: (32, 34.0, 40.0)}
"""Cause -> bits of the arithmetic, and lowest and highest number of bits measured against the
bound: a typical error is some bits smaller than the bound."""
_INVERTED = "MU's sign rule inverted"
_SAME_VELOCITIES = (_INVERTED, "Γ half a turn on: the normal the other way round")
"""Descriptions of two edits that give the same final velocities."""
_OTHER_BRANCHES = (_INVERTED, "the critical ratio used in place of MU")
"""Descriptions of the models that take the other branch, of friction's sign or of the pivot, in
every row."""
LOOKED_INTO = 4000
"""Maximum number of agreeing rows that a cause must fit, and of rows replayed by the 1988 program;
bounds the time and memory for large tables."""


class Cause(NamedTuple):
    """A cause that is a program with a mistake, or several.

    Parameters
    ----------
    says : str
        Its description.
    explains, disagreeing : int
        The rows that disagree and that it reproduces, of all that disagree.
    fits, agreeing : int
        The rows that agree and that it reproduces, of all looked at that agree.
    equivalents : list of str
        Descriptions of programs with the same results.
    parts : dict of str to int
        Of a program with several mistakes, each with the first row that shows it.
    """

    says: str
    explains: int
    disagreeing: int
    fits: int
    agreeing: int
    equivalents: list[str]
    parts: dict[str, int]


class Unexplained(NamedTuple):
    """Rows of one kind of scene.

    Parameters
    ----------
    rows, unexplained : int
        Their number, and those that disagree without a cause.
    violated : dict of str to int
        Of the latter, the rows that violate each equation.
    """

    rows: int
    unexplained: int
    violated: dict[str, int]


class Diagnosis:
    """Causes of the differences in a case.

    ``causes``: one for each row that disagrees, in order; ``evidence`` and ``programs``: of each
    cause that is a program; ``equations``: number -> rows in which it was checked, and in which it
    is violated; ``unexplained``: rows without a cause by kind of scene, {} where there are none.
    """

    @np.errstate(all="ignore")
    def __init__(self, case: Case) -> None:
        self._case, self._disagreeing = case, case.wrong
        self._causes = np.where(self._disagreeing, UNKNOWN, "").astype(object)
        self.evidence: list[Cause] = []
        self.programs: list[Program] = []
        self._explain_by_own_row()
        wrong = self._wrong = self._open
        violations = violated_equations(case)
        self.equations = {
            number: (int(wrong.sum()), int((rows & wrong).sum()))
            for number, rows in violations.items()
        }
        self.unexplained: dict[str, Unexplained] = {}
        if not wrong.any():
            return
        self._measure_differences()
        if not self._explain_by_digits():
            self._explain_by_search()
            if self._open.sum() > (1 - MIN_FIT) * wrong.sum():
                self._explain_by_order()
            if self._open.sum() > (1 - MIN_FIT) * wrong.sum():
                self._explain_by_precision()
        if self._open.any():
            self.unexplained = self._count_unexplained(violations)
        self._describe_unexplained(violations)

    def _explain_by_own_row(self) -> None:
        """Name the rows whose results are their own to fewer digits, and those that are infinite:
        neither is another row's, nor a mistake's."""
        self._causes[self._disagreeing & np.isinf(self._case.values).any(0)] = INFINITE
        differences = self._relative_differences().max(0, initial=0.0)
        for row in np.flatnonzero(self._open & (differences <= MAX_SLIGHT_DIFFERENCE)):
            digits = math.floor(-math.log10(max(differences[row], 1e-16)) + 1e-9)
            self._causes[row] = f"{AGREES} {digits} digits"

    def _relative_differences(self) -> Floats:
        """Return the relative differences beyond the digits written, (results, rows)."""
        case = self._case
        off, sizes = np.abs(case.values - case.ours), case.sizes
        beyond = np.maximum(off - case.units * HALF, 0.0)
        relative = np.where(sizes > 0, beyond / sizes, beyond != 0)
        return np.where(np.isfinite(off), relative, 0.0)

    def _measure_differences(self) -> None:
        """Set each row's largest relative difference beyond the digits written, the part of it that
        digits and rounding leave open, and the limits within which a program explains a result."""
        case, wrong = self._case, self._wrong
        off, sizes, written = np.abs(case.values - case.ours), case.sizes, case.units * HALF
        relative = self._relative_differences()
        worst = relative.argmax(0), np.arange(wrong.size)
        self._differences = relative[worst]
        digits = np.where(np.isfinite(off) & (sizes > 0), written / sizes, 0.0)
        loose = np.where(sizes > 0, case.loose / sizes, 0.0)
        self._resolutions = np.fmax(digits[worst], loose[worst])
        within_limits = np.fmin(
            np.fmax(4 * loose, _SAME_RTOL), _MAX_FRACTION_LEFT * self._differences
        )
        # another program rounds its own numbers, which may be larger than anything in the scene
        theirs = np.where(wrong & np.isfinite(case.values), np.abs(case.values), 0.0)
        measure = np.fmax(sizes, theirs)
        self._limits = (
            np.where(wrong, within_limits, np.fmax(loose, _SAME_RTOL)) * measure + written
        )

    def _count_unexplained(self, violations: Mapping[str, Bools]) -> dict[str, Unexplained]:
        """Return the rows without a cause by kind of scene; a row counts for the first kind that it
        fits."""
        g = self._case.columns
        kinds = {
            **_unusual_strata(g),
            "point masses": g["M"] == 4,
            "the pivot (MU = -10)": g["MU"] == PIVOT,
            "no friction (MU = 0)": g["MU"] == 0,
            "no moment (EM = 1)": g["EM"] == 1,
            "all other scenes": np.ones(self._wrong.size, bool),
        }
        remaining = np.ones(self._wrong.size, bool)
        counts: dict[str, Unexplained] = {}
        for name, rows in kinds.items():
            rows, remaining = rows & remaining, remaining & ~rows
            open_rows = rows & self._open
            if rows.any():
                violated = {n: int((broken & open_rows).sum()) for n, broken in violations.items()}
                violated = {number: count for number, count in violated.items() if count}
                counts[name] = Unexplained(int(rows.sum()), int(open_rows.sum()), violated)
        return counts

    @property
    def causes(self) -> list[str]:
        """The cause of each row that disagrees."""
        return list(self._causes[self._disagreeing])

    @property
    def _open(self) -> Bools:
        """The rows that disagree and have no cause yet."""
        return np.asarray(self._causes == UNKNOWN)

    def _explain_by_search(self) -> None:
        """Look for programs that give the other program's results, and assign them to rows."""
        case = self._case
        theirs, limits, ours = (
            {n: row for n, row in zip(case.names, rows, strict=True) if n != "MUC"}
            for rows in (case.values, self._limits, case.ours)
        )
        judge = Judge(case.columns, theirs, limits, self._wrong)
        # leave out near-singular rows and others in which the spelling differs from our results
        clear = judge._replace(theirs=ours).matches(Program().results(case.columns))
        # leave out rows that are wrong only in results that no spelling computes
        clear &= ~(judge.wrong & try_program(Program(), judge).rows)
        strata = _unusual_strata(case.columns)
        usual = ~np.any([*strata.values()], axis=0)
        bits, branch_rows = self._evidence_bits(judge)
        if (judge.wrong & clear & usual).any():
            self._explain_by_sample(judge, clear & usual, clear, bits, branch_rows)
        else:
            self._explain_by_sample(judge, clear, clear, bits, branch_rows)
        for name, rows in strata.items():
            self._explain_stratum(name, judge, clear & rows, bits, branch_rows)
        if not self.programs:
            self._explain_by_constant(judge, clear & usual, bits)

    def _explain_by_sample(
        self, judge: Judge, searched: Bools, clear: Bools, bits: Floats, branch_rows: Bools
    ) -> None:
        """Look for programs in a sample of the rows ``searched``; assign them to all that they
        explain, if the evidence of the ``clear`` rows suffices."""
        rows = _sample_rows(judge, searched)
        sample = judge.select_rows(rows)
        if not sample.wrong.any():
            return
        judge = judge.select_results(_independent_results(sample))
        agreeing = clear & ~judge.wrong
        ours = Program().results(judge.scene)
        wrong_results = [
            name
            for name in judge.theirs
            if (judge.wrong & ~judge.select_results([name]).matches(ours)).any()
        ]
        is_large = bool(np.median(self._differences[rows][sample.wrong]) > _MIN_PAIR_DIFFERENCE)
        for explanation in _explanations(sample, is_large):
            for program, equivalents, names in explanation:
                part = judge.narrow_to(names)
                fits = try_program(program, part).rows
                explained_rows = fits & part.wrong & self._open
                if not _has_enough_bits(program, explained_rows & clear, bits, branch_rows & clear):
                    continue
                says = self._name_both(program.description, judge) + _limitation(fits, agreeing)
                # a result that is right needs no cause, though the program gives another
                if unexplained := [name for name in wrong_results if name not in names]:
                    says += f"; {', '.join(unexplained)} {UNKNOWN}"
                same = [trial.program.description for trial in equivalents[:_MAX_EQUIVALENTS]]
                parts = _first_rows_of_edits(program, part, explained_rows)
                rows_of = (explained_rows, part.wrong, fits & agreeing, agreeing)
                self._assign(program, says, rows_of, same, parts)
            if self.evidence:
                return

    def _assign(
        self,
        program: Program,
        says: str,
        rows: tuple[Bools, Bools, Bools, Bools],
        equivalents: list[str],
        parts: dict[str, int],
    ) -> None:
        """Make a program the cause of the rows that it explains, and record the evidence.

        ``rows``: those it explains, those that disagree, those agreeing that it fits, those that
        agree.
        """
        self._causes[rows[0]] = says
        explains, disagreeing, fits, agreeing = (int(x.sum()) for x in rows)
        cause = Cause(says, explains, disagreeing, fits, agreeing, equivalents, parts)
        self.evidence.append(cause)
        self.programs.append(program)

    def _name_both(self, description: str, judge: Judge) -> str:
        """Return a description, with both names of a mistake that is one of `_SAME_VELOCITIES` and
        that the judge's results do not distinguish from the other.

        Turning the normal round affects only the rule of MU's sign, and results along the normal.
        """
        parts = description.split("; and ")
        if not set(parts) & set(_SAME_VELOCITIES):
            return description
        edits = {edit.description: edit for edit in (*variants(), *readings())}
        inverted, turned = (
            Program((edits[name],)).results(judge.scene) for name in _SAME_VELOCITIES
        )
        pair = judge._replace(theirs={n: inverted[n] for n in judge.theirs if n in inverted})
        if (~pair.matches(turned) & judge.wrong).sum() > (1 - MIN_FIT) * judge.wrong.sum():
            return description
        both = ", or ".join(_SAME_VELOCITIES)
        return "; and ".join(both if part in _SAME_VELOCITIES else part for part in parts)

    def _explain_by_constant(self, judge: Judge, clear: Bools, bits: Floats) -> None:
        """Look for a constant with a wrong value, any number, that explains nearly all rows."""
        rows = _sample_rows(judge, clear)
        sample = judge.select_rows(rows)
        if not sample.wrong.any():
            return
        judge = judge.select_results(_independent_results(sample))
        for program in fit_constants(judge.select_rows(rows)):
            fits = try_program(program, judge).rows
            explained_rows = fits & judge.wrong & self._open
            # the fitted number itself uses up the bits of one row
            if bits[explained_rows & clear].sum() < _MIN_BITS_NAMED + _MAX_BITS_PER_ROW:
                continue
            agreeing = clear & ~judge.wrong
            if (fits & agreeing).sum() < MIN_FIT * agreeing.sum():
                continue
            rows_of = (explained_rows, judge.wrong, fits & agreeing, agreeing)
            self._assign(program, program.description, rows_of, [], {})
            return

    def _explain_by_order(self) -> None:
        """Recognise results that are those of other rows."""
        case, wrong = self._case, self._wrong
        usable = np.isfinite(case.ours).any(1)
        if wrong.sum() < _MIN_REORDERED_ROWS or not usable.any():
            return
        # rows that may belong together are found by the first result, then compared in all
        first = int(np.argmax(usable))
        order = np.argsort(case.ours[first])
        limits = case.units * HALF + np.fmax(case.loose, _SAME_RTOL * case.sizes)
        lowest = np.searchsorted(case.ours[first, order], case.values[first] - limits[first])
        matching_rows = np.zeros(wrong.size, bool)
        for step in range(_MAX_TIES):
            place = order[np.minimum(lowest + step, wrong.size - 1)]
            within_limits = np.abs(case.values - case.ours[:, place]) <= limits
            within_limits |= np.isnan(case.values) | ~np.isfinite(case.ours[:, place])
            matching_rows |= within_limits.all(0)
        if (matching_rows & wrong).sum() >= MIN_FIT * wrong.sum():
            self._causes[matching_rows & wrong] = OTHER_ROWS

    def _explain_stratum(
        self, name: str, judge: Judge, rows: Bools, bits: Floats, branch_rows: Bools
    ) -> None:
        """Look for an edit that explains the rows of one kind without a cause, alone or on top of
        the first program that explains the rest."""
        unexplained = judge.wrong & self._open & rows
        if not unexplained.any():
            return
        places = np.unique(
            np.concatenate(
                [pick_evenly(np.flatnonzero(x), _MAX_DISAGREEING) for x in (unexplained, rows)]
            )
        )
        stratum_sample = judge.select_rows(places)._replace(wrong=unexplained[places])
        for base in (*self.programs[:1], Program()):
            trial = next(iter(find_single_edits(stratum_sample, stratum_sample.wrong, base)), None)
            if (
                trial is None
                or trial.explained_count < _MIN_FRACTION_OF_REST * stratum_sample.wrong.sum()
            ):
                continue
            new = Program(trial.program.edits[len(base.edits) :])
            fits = try_program(trial.program, judge).rows
            explained_rows = fits & unexplained
            if not _has_enough_bits(new, explained_rows, bits, branch_rows & rows):
                continue
            agreeing = rows & ~judge.wrong
            says = f"{name}: {trial.program.description}" + _limitation(fits, agreeing)
            parts = _first_rows_of_edits(trial.program, judge, explained_rows)
            rows_of = (explained_rows, unexplained, fits & agreeing, agreeing)
            self._assign(trial.program, says, rows_of, [], parts)
            return

    def _evidence_bits(self, judge: Judge) -> tuple[Floats, Bools]:
        """Return the bits that a cause gets right by explaining each row, 0 where it agrees; and
        the rows that show only which branch is taken, of friction's sign or of the pivot."""
        ratios = self._differences / np.fmax(self._resolutions, 1e-12)
        bits = np.clip(np.log2(ratios), 0.0, _MAX_BITS_PER_ROW)
        models = [Program((edit,)) for edit in variants() if edit.description in _OTHER_BRANCHES]
        fits = [try_program(model, judge).rows for model in models]
        branch_rows = judge.wrong & np.any(fits, axis=0)
        if branch_rows.any():
            branch_rows |= ~judge.wrong & (judge.scene["MU"] != 0) & (judge.scene["MU"] != PIVOT)
        return np.where(judge.wrong, bits, 0.0), branch_rows

    def _explain_by_digits(self) -> bool:
        """Recognise correct numbers written as the 1988 program prints them, floored or cut off.

        Returns whether nearly all rows are explained so; if not, no cause is assigned.
        """
        case, wrong = self._case, self._wrong
        fits = {
            PRINTED: _match_printout(case, wrong),
            FLOORED: _match_cut(case, np.floor),
            TRUNCATED: _match_cut(case, np.trunc),
        }
        best = max(fits, key=lambda says: int((fits[says] & wrong).sum()))
        if (fits[best] & wrong).sum() < MIN_FIT * wrong.sum():
            return False
        for says in (best, *fits):
            self._causes[self._open & fits[says]] = says
        return True

    def _explain_by_precision(self) -> None:
        """Recognise coarser arithmetic, if it affects the whole table: most of the rows in which it
        would be visible, and few that it does not explain."""
        wrong, condition = self._wrong, self._case.condition
        units = self._differences / errorbound.relative_bounds(condition, 1.0)
        bits = -math.log2(max(float(np.median(units[wrong])), 1e-300))
        for says, (width, low, high) in _WIDTHS.items():
            bounds = errorbound.relative_bounds(condition, 2.0**-width)
            visible = bounds * _TYPICAL_FRACTION_OF_BOUND > self._resolutions
            explained_rows = wrong & (self._differences / self._case.per_unit <= 2.0**-width)
            is_widespread = (wrong & visible).sum() >= _MIN_AFFECTED * visible.sum()
            if (
                low <= bits < high
                and explained_rows.sum() >= MIN_FIT * wrong.sum()
                and is_widespread
            ):
                self._causes[explained_rows & self._open] = says
                return

    def _describe_unexplained(self, violations: Mapping[str, Bools]) -> None:
        """Say of each row without a cause how closely it agrees, or which equations it violates."""
        for row in np.flatnonzero(self._open).tolist():
            broken = [number for number, rows in violations.items() if rows[row]]
            if broken and len(broken) < len(violations):
                subject = f"Equations {', '.join(broken[:-1])} and {broken[-1]} are"
                subject = subject if len(broken) > 1 else f"Equation {broken[0]} is"
                self._causes[row] = f"{UNKNOWN}, but only {subject} violated"
            elif 0 < self._differences[row] < 1e-2:
                digits = int(-math.log10(self._differences[row]))
                self._causes[row] = f"{UNKNOWN}, but agrees to about {digits} digits"
            elif violations and not broken:
                self._causes[row] = f"{UNKNOWN}; no equation is violated by the final velocities"


def _limitation(fits: Bools, agreeing: Bools) -> str:
    """Return `IN_THESE_ROWS` for a cause that does not fit nearly all agreeing rows, else ""."""
    return "" if (fits & agreeing).sum() >= MIN_FIT * agreeing.sum() else IN_THESE_ROWS


def _unusual_strata(g: Mapping[str, Floats]) -> dict[str, Bools]:
    """Return the rows beyond ordinary scenes and their limiting cases, by what is unusual."""
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


def _match_cut(case: Case, cut: Callable[[Floats], Floats]) -> Bools:
    """Return the rows whose results are ours cut at the last digit written.

    ``cut``: `numpy.floor` or `numpy.trunc`. Rounding may move a number across the step: 1e-9.
    """
    unit = np.where(case.units > 0, case.units, np.nan)
    steps, ours = case.values / unit, case.ours / unit
    tolerance = 1e-9 * np.maximum(np.abs(ours), 1.0)
    below, above = cut(ours - tolerance), cut(ours + tolerance)
    fits = (np.abs(steps - below) < 1e-6) | (np.abs(steps - above) < 1e-6)
    return np.asarray((fits | np.isnan(case.values)).all(0))


def _match_printout(case: Case, wrong: Bools) -> Bools:
    """Return the rows whose results are the 1988 program's own digits.

    At most `LOOKED_INTO` rows are replayed; where these fit, the others need only be floored.
    """
    rows = np.zeros(wrong.size, bool)
    places, others = np.split(np.flatnonzero(wrong), [LOOKED_INTO])
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
        rows[places] &= np.isnan(column) | (values == column)
    rows[others] = (rows[places].mean() >= MIN_FIT) & _match_cut(case, np.floor)[others]
    return rows


def _first_rows_of_edits(program: Program, judge: Judge, explained_rows: Bools) -> dict[str, int]:
    """Return each mistake of a program with several, and the first row that it takes to explain."""
    first_rows = {}
    for edit in program.edits if len(program.edits) > 1 else ():
        without = Program(tuple(x for x in program.edits if x is not edit))
        needs_edit = explained_rows & ~try_program(without, judge).rows
        if needs_edit.any():
            first_rows[edit.text] = int(np.argmax(needs_edit))
    return first_rows


def _has_enough_bits(
    program: Program, explained_rows: Bools, bits: Floats, branch_rows: Bools
) -> bool:
    """Return whether a cause gets right the bits that it must.

    A branch taken counts for one bit a row, and the choice of its rows for log2 of the number of
    choices: of k rows among n that would show it, log2(n over k).
    """
    count, possible = int((explained_rows & branch_rows).sum()), int(branch_rows.sum())
    earned_bits = float(bits[explained_rows & ~branch_rows].sum()) + count
    required_bits = _MIN_BITS_NAMED if program.edits[0].rank <= RARE_CONVENTION else _MIN_BITS
    required_bits = _MIN_BITS_PAIR if len(program.edits) > 1 else required_bits
    return earned_bits + math.log2(math.comb(possible, count)) >= required_bits


def _sample_rows(judge: Judge, clear: Bools) -> NDArray[np.intp]:
    """Return rows that disagree, then some that agree, evenly by kind of scene: the first and the
    last of every kind at least."""
    g = judge.scene
    conditions = (
        g["MU"] == PIVOT,
        g["M"] == 4,
        g["MU"] == 0,
        (g["WA"] == 0) & (g["WB"] == 0),
        Program().results(g)["MUP"] == g["MU"],
        (g["DA"] == 0) & (g["DB"] == 0),
    )
    kind = np.sum([condition << place for place, condition in enumerate(conditions)], 0)
    chosen = []
    for rows, count in ((judge.wrong, _MAX_DISAGREEING), (~judge.wrong, _MAX_AGREEING)):
        places = np.flatnonzero(rows & clear)
        places = places[np.argsort(kind[places], kind="stable")]
        _, first, counts = np.unique(kind[places], return_index=True, return_counts=True)
        evenly = pick_evenly(np.arange(places.size), count)
        chosen.append(places[np.unique(np.concatenate([evenly, first, first + counts - 1]))])
    return np.concatenate(chosen)


_Explanation = tuple[Program, Sequence[Trial], Sequence[str]]
"""A program that explains rows, others that explain the same, and the results that it gives."""


def _explanations(judge: Judge, is_large: bool) -> Iterator[list[_Explanation]]:
    """Yield lists of programs that together explain a table, the simplest first.

    ``is_large``: differences are so large that two mistakes are looked for.
    """
    with progress(20, "look for the cause") as meter:
        meter.update(0)
        groups = judge.select_results(_independent_results(judge)).wrong_groups()
        first = judge.narrow_to(groups[0])
        singles = find_single_edits(first, first.wrong)
        complete = [trial for trial in singles if trial.is_complete]
        stages = find_pairs(first, singles) if is_large else iter(())
        while not complete and (programs := next(stages, None)) is not None:
            meter.update(1)
            complete = [trial for trial in rank_programs(programs, first) if trial.is_complete]
        if complete:
            wrong = {name for group in groups[1:] for name in group}
            remaining = judge.narrow_to([name for name in judge.theirs if name not in wrong])
            yield [_extend_to_groups(_add_edits(complete, remaining), groups, judge)]
        yield _mixed_programs(singles, first, judge)


def _extend_to_groups(
    trials: Sequence[Trial], groups: Sequence[list[str]], judge: Judge
) -> _Explanation:
    """Choose one of the programs that explain the first group of results, and extend it to others.

    Of programs equal on that group, the one that fits most rows in all results is chosen, or the
    likeliest. Where it does not explain another group, an edit is added that does.
    """
    equals = [trial for trial in trials if np.array_equal(trial.rows, trials[0].rows)]
    equals.sort(key=lambda trial: (-int(try_program(trial.program, judge).rows.sum()), trial.rank))
    program = equals[0].program
    wrong = [name for group in groups for name in group]
    names = [name for name in judge.theirs if name in groups[0] or name not in wrong]
    for group in (wrong, *groups[1:3]) if len(groups) > 1 else ():
        part = judge.narrow_to([*names, *group])
        trial = try_program(program, part)
        if not trial.is_complete:
            trial = next(iter(find_single_edits(part, part.wrong & ~trial.rows, program)), trial)
        if trial.is_complete:
            program, names = trial.program, [*names, *group]
        if set(wrong) <= set(names):
            break
    return program, equals[1:] if program is equals[0].program else (), names


def _add_edits(trials: Sequence[Trial], judge: Judge) -> Sequence[Trial]:
    """Add edits to the best program while they explain most of the rows that it leaves: mistakes in
    a branch that few rows take. Returns ``trials`` themselves where there are none."""
    for _ in range(_MAX_FURTHER_EDITS):
        remaining = judge.wrong & ~trials[0].rows
        better = []
        for trial in (
            find_single_edits(judge, remaining, trials[0].program) if remaining.any() else ()
        ):
            count = (trial.rows & remaining).sum()
            is_convention = trial.program.edits[-1].rank <= RARE_CONVENTION
            is_enough = count >= _MIN_FRACTION_OF_REST * remaining.sum()
            if trial.is_complete and is_enough and (count > 1 or is_convention):
                better.append(trial)
        if not better:
            break
        trials = better
    return trials


def _independent_results(judge: Judge) -> list[str]:
    """Return the final velocities and the results that do not follow from theirs correctly.

    A result computed correctly from wrong velocities adds no information.
    """
    if not judge.has_velocities:
        return list(judge.theirs)
    theirs = {name: judge.theirs[name] for name in FINAL_VELOCITIES}
    implied = Run(spellings()[LISTING], judge.scene, theirs).names
    fractions = {
        name: judge.select_results([name]).matches(implied).mean()
        for name in judge.theirs
        if name in implied and name not in FINAL_VELOCITIES
    }
    return [name for name in judge.theirs if fractions.get(name, 0.0) < MIN_FIT]


def _mixed_programs(singles: Sequence[Trial], part: Judge, judge: Judge) -> list[_Explanation]:
    """Return a few programs that together explain nearly all rows of ``part``, each some of them;
    none where they do not. The table then has rows of several programs.

    A program gives all results of ``judge`` where its rows fit in all, else those of ``part``.
    """
    remaining = part.wrong.copy()
    chosen: list[_Explanation] = []
    while singles and remaining.any() and len(chosen) < _MAX_MIXED_PROGRAMS:
        best = max(singles, key=lambda trial: ((trial.rows & remaining).sum(), -trial.rank))
        explained_rows = best.rows & remaining
        if not explained_rows.any():
            break
        fits_all = (try_program(best.program, judge).rows & explained_rows).sum()
        gives_all = fits_all >= MIN_FIT * explained_rows.sum()
        chosen.append((best.program, (), [*(judge if gives_all else part).theirs]))
        remaining &= ~best.rows
    count = part.wrong.sum() - remaining.sum()
    return chosen if count >= MIN_FIT * part.wrong.sum() else []
