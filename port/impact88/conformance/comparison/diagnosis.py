"""Explain why another program's results differ: hypotheses compared by one score.

A hypothesis predicts every row, those that agree included. It earns the bits by which the rows that
disagree are off and that it gets right, loses those of the rows that agree and that it contradicts,
and pays for what it takes to state it. That nothing is wrong but the last digits is one of them;
others are the digits written, the order of the rows, coarser arithmetic, and programs: with a
convention of their own, another law, one edit or several, or a constant. A program may hold where a
condition on the scene does, which is found in half of the rows and must hold in the other half.
"""

import math
import time
from collections.abc import Iterator, Mapping, Sequence
from random import Random
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.doubles import doubles_of
from ...equations.edits import FITTED, RARE_CONVENTION, Edit
from ...equations.evaluation import Run
from ...equations.spelling import IMPULSES, LISTING, spellings
from ...messages.progress import progress
from ...names import FINAL_VELOCITIES, PIVOT, SCENE
from .agreement import Bools, ComparedRows, violated_equations
from .constants import fit_constants, limit_instead
from .predicates import COST as PREDICATE_COST
from .predicates import find_predicate, scene_quantities
from .tablehypotheses import (
    COST_DIGITS,
    UNKNOWN,
    TableHypothesis,
    cost_named,
    describe_unexplained,
    evidence_bits,
    judge_of,
    match_program,
    needs_cause,
    own_digits,
    plain_hypotheses,
    relative_differences,
)
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
from .vectors import casework

# bounds of a search
MAX_SEARCHED = 400  # rows of each kind, that disagree and that agree, a search looks at
MAX_SECONDS = 12.0  # of processor time, after which no further edits are looked for
_ROWS_PER_CHUNK = 20_000  # rows on which a program is run at once
_MAX_CAUSES = 4
_MAX_CANDIDATES = 25  # programs with one edit for which a condition is sought
_MAX_EQUIVALENTS = 3  # other programs with the same results that are listed
_MIN_ROWS_LEFT = 2  # in which a further mistake is looked for

# bits
_COST_EDIT = 16.0  # choosing one of some 50,000 edits
_COST_CONSTANT = 50.0  # its place, and its value
_NEARLY = 0.97  # of the best score: nearly as good
_COST_LEFT_OUT = 40.0  # a result that is wrong as well, and not given
_MIN_SCORE = 6.0
_CONTRADICTED = 40.0  # lost by a row that agrees
_MIN_PAIR_DIFFERENCE = 1e-5
"""Relative difference below which no pair of mistakes is looked for, only coarser arithmetic."""


class TableCause(NamedTuple):
    """A cause of differences.

    Parameters
    ----------
    says : str
        What the program does.
    formula : str
        What is written in it, and what should be; "" for a cause that is no statement.
    where : str
        The condition on the scene under which it holds, "" where it always does.
    explains, disagreeing : int
        The rows that disagree and that it predicts, of all that disagree.
    open : list of str
        Results that are wrong as well, and that it does not predict.
    fits, agreeing : int
        The rows that agree and that it predicts, of all looked at that agree.
    score : float
        Bits that it gets right, less those that it takes to state it.
    equivalents : list of str
        Other programs with the same results in this table.
    apart : dict of str to str
        A scene that would tell it from the first of those, {} where there is none.
    parts : dict of str to int
        Of a program with several mistakes, each with the first row that shows it.
    """

    says: str
    formula: str
    where: str
    explains: int
    disagreeing: int
    open: list[str]
    fits: int
    agreeing: int
    score: float
    equivalents: list[str]
    apart: dict[str, str]
    parts: dict[str, int]


class Unexplained(NamedTuple):
    """Rows of one kind of scene.

    Parameters
    ----------
    rows, unexplained : int
        Those that disagree, and those of them without a cause.
    violated : dict of str to int
        Of the latter, the rows that violate each equation.
    """

    rows: int
    unexplained: int
    violated: dict[str, int]


class Diagnosis:
    """Causes of the differences in a table, found in a sample of it.

    ``case``: rows that disagree, and some that agree, in the table's order. `assign` then gives the
    causes of rows, which need not be the same.

    ``equations``: number -> rows in which it was checked, and in which it is violated;
    ``unexplained``: rows that disagree, and those without a cause, by kind of scene; ``skipped``:
    what was not looked for.
    """

    @np.errstate(all="ignore")
    def __init__(self, case: ComparedRows) -> None:
        self.hypotheses: list[TableHypothesis] = []
        self.skipped: list[str] = []
        self.equations: dict[str, tuple[int, int]] = {}
        self._kinds: dict[str, Unexplained] = {}
        self._evidence: list[TableCause] = []
        self._ends = time.process_time() + MAX_SECONDS
        self._known_rows: dict[int, tuple[TableHypothesis, Bools]] = {}
        wrong = needs_cause(case)
        places = _sample_rows(case, wrong)
        self._sample = case.select_rows(places)
        self._wrong = wrong[places]
        if self._wrong.any():
            self._search()

    # --- rows ---

    @np.errstate(all="ignore")
    def assign(self, case: ComparedRows) -> list[str]:
        """Return the cause of each row of a case that disagrees, "" for the others; and count them
        for the evidence."""
        causes: list[str] = []
        count = case.condition.size
        for start in range(0, count, _ROWS_PER_CHUNK):
            places = np.arange(start, min(start + _ROWS_PER_CHUNK, count))
            causes += self._assign_chunk(case.select_rows(places))
        return causes

    def _assign_chunk(self, case: ComparedRows) -> list[str]:
        wrong = case.wrong
        causes = np.where(wrong, own_digits(case), "").astype(object)
        is_open = wrong & (causes == "")
        for place, hypothesis in enumerate(self.hypotheses):
            fits = hypothesis.fits(case)
            explained_rows = is_open & fits
            causes[explained_rows] = self._evidence[place].says
            is_open &= ~explained_rows
            self._count(place, case, explained_rows, fits)
        violations = violated_equations(case)
        for number, broken in violations.items():
            checked_rows, violated_rows = self.equations.get(number, (0, 0))
            count = int((broken & wrong).sum())
            self.equations[number] = checked_rows + int(wrong.sum()), violated_rows + count
        self._count_unexplained(case, is_open, violations)
        differences = relative_differences(case).max(0, initial=0.0)
        for row in np.flatnonzero(is_open).tolist():
            causes[row] = describe_unexplained(
                [number for number, broken in violations.items() if broken[row]],
                violations,
                float(differences[row]),
            )
        return list(causes)

    def _count(self, place: int, case: ComparedRows, explained: Bools, fits: Bools) -> None:
        """Count a chunk's rows for a cause: those that it explains, and those that it predicts."""
        cause, hypothesis = self._evidence[place], self.hypotheses[place]
        disagreeing = case.wrong
        agreeing = ~disagreeing & np.isfinite(case.ours).any(0)
        parts = dict(cause.parts)
        program = hypothesis.program
        if program is not None and len(program.edits) > 1 and explained.any():
            judge = judge_of(case, disagreeing)
            for edit in program.edits:
                if edit.sentence not in parts:
                    without = Program(tuple(x for x in program.edits if x is not edit))
                    needs_edit = explained & ~try_program(without, judge).rows
                    if needs_edit.any():
                        parts[edit.sentence] = case.rows[int(np.argmax(needs_edit))]
        self._evidence[place] = cause._replace(
            explains=cause.explains + int(explained.sum()),
            disagreeing=cause.disagreeing + int(disagreeing.sum()),
            fits=cause.fits + int((agreeing & fits).sum()),
            agreeing=cause.agreeing + int(agreeing.sum()),
            parts=parts,
        )

    @property
    def evidence(self) -> list[TableCause]:
        """The causes that explain a row, and what they explain."""
        return [cause for cause in self._evidence if cause.explains]

    @property
    def unexplained(self) -> dict[str, Unexplained]:
        """The rows that disagree by kind of scene; {} where all have a cause."""
        has_any = any(kind.unexplained for kind in self._kinds.values())
        return self._kinds if has_any else {}

    def _count_unexplained(
        self, case: ComparedRows, is_open: Bools, violations: Mapping[str, Bools]
    ) -> None:
        """Count the rows that disagree by kind of scene; a row counts for the first kind that it
        fits."""
        g = case.columns
        bodies = np.fmin(g["MA"], g["MB"]) <= 0
        bodies |= (g["M"] != 4) & (np.fmin(g["IA"], g["IB"]) <= 0)
        kinds = {
            "masses or inertias of 0 or less": bodies,
            "point masses": g["M"] == 4,
            "the pivot (MU = -10)": g["MU"] == PIVOT,
            "no friction (MU = 0)": g["MU"] == 0,
            "no moment (EM = 1)": g["EM"] == 1,
            "all other scenes": np.ones(is_open.size, bool),
        }
        remaining = case.wrong
        for name, rows in kinds.items():
            rows, remaining = rows & remaining, remaining & ~rows
            open_rows = rows & is_open
            if not rows.any():
                continue
            known_rows = self._kinds.get(name, Unexplained(0, 0, {}))
            violated_rows = dict(known_rows.violated)
            for number, broken in violations.items():
                if count := int((broken & open_rows).sum()):
                    violated_rows[number] = violated_rows.get(number, 0) + count
            self._kinds[name] = Unexplained(
                known_rows.rows + int(rows.sum()),
                known_rows.unexplained + int(open_rows.sum()),
                violated_rows,
            )

    # --- the search ---

    def _search(self) -> None:
        """Look for the hypotheses that explain the sample."""
        case, wrong = self._sample, self._wrong
        self._bits = evidence_bits(case)
        self._agreeing = ~wrong & np.isfinite(case.ours).any(0)
        # what the digits alone explain is no mistake
        score_pairs = [(self._score(x), x) for x in plain_hypotheses(case, wrong)]
        best = max(score_pairs, key=lambda pair: pair[0], default=None)
        if best and best[0] >= _MIN_SCORE and best[1].cost == COST_DIGITS:
            rows = best[1].fits(case)
            if (rows & wrong).sum() >= MIN_FIT * wrong.sum():
                for _, hypothesis in sorted(score_pairs, key=lambda pair: -pair[0]):
                    if hypothesis.cost == COST_DIGITS:
                        self._add(hypothesis)
                return
        with progress(None, "look for the cause") as self._meter:
            self._meter.update(0)
            for hypothesis in self._programs():
                score_pairs.append((self._score(hypothesis), hypothesis))
        explained_rows = np.zeros(wrong.size, bool)
        chosen: list[tuple[TableHypothesis, float]] = []
        for _ in range(_MAX_CAUSES):
            scores = [(self._score(x, explained_rows), x) for _, x in score_pairs]
            highest = max((score for score, _ in scores), default=0.0)
            if highest < _MIN_SCORE:
                break
            # a few rows more or fewer are rounding's: of hypotheses that explain nearly as much,
            # the one that takes least to state
            near = [(self._cost(x), -score, x) for score, x in scores if score >= _NEARLY * highest]
            _, score, hypothesis = min(near, key=lambda each: each[:2])
            rows_gained = self._fits(hypothesis) & wrong & ~explained_rows
            if chosen and rows_gained.sum() < _MIN_ROWS_LEFT:
                break
            chosen.append((hypothesis, -score))
            explained_rows |= rows_gained
        # a program that more rows contradict than confirm is not the other one, though it has a
        # part of it
        rows_left = (wrong & ~explained_rows & (self._bits > 0)).sum()
        for hypothesis, score in chosen:
            if hypothesis.where or (self._fits(hypothesis) & wrong).sum() >= rows_left:
                self._add(hypothesis, score)

    def _fits(self, hypothesis: TableHypothesis) -> Bools:
        """Return the rows of the sample that a hypothesis predicts."""
        if id(hypothesis) not in self._known_rows:
            self._known_rows[id(hypothesis)] = hypothesis, hypothesis.fits(self._sample)
        return self._known_rows[id(hypothesis)][1]

    def _score(self, hypothesis: TableHypothesis, explained: Bools | None = None) -> float:
        """Return the bits that a hypothesis gets right in the sample, less what it costs.

        ``explained``: rows that another cause explains already.
        """
        fits = self._fits(hypothesis)
        rows_gained = fits & self._wrong
        contradicted = ~fits & self._agreeing
        if explained is not None:
            rows_gained &= ~explained
        cost = self._cost(hypothesis)
        if hypothesis.bits is None:
            return float(self._bits[rows_gained].sum() - _CONTRADICTED * contradicted.sum() - cost)
        return float(hypothesis.bits * (rows_gained.sum() - contradicted.sum()) - cost)

    def _cost(self, hypothesis: TableHypothesis) -> float:
        """Return the bits that it takes to state a hypothesis, and which of the rows that disagree
        it explains, where it holds: a condition that says so is worth them."""
        rows = self._wrong & (self._bits > 0)
        if hypothesis.where is not None:
            rows &= hypothesis.where.rows(self._quantities)
        count = int((rows & self._fits(hypothesis)).sum())
        return hypothesis.cost + math.log2(math.comb(int(rows.sum()), count))

    def _add(self, hypothesis: TableHypothesis, score: float | None = None) -> None:
        """Make a hypothesis a cause."""
        score = self._score(hypothesis) if score is None else score
        program = hypothesis.program
        equivalents, apart = _tell_apart(
            hypothesis._replace(equivalents=self._equal_programs(hypothesis))
        )
        self.hypotheses.append(hypothesis)
        self._evidence.append(
            TableCause(
                says=hypothesis.says,
                formula=program.formula if program else "",
                where=hypothesis.where.text if hypothesis.where else "",
                explains=0,
                disagreeing=0,
                open=[name for name in self._names if name not in hypothesis.names]
                if program
                else [],
                fits=0,
                agreeing=0,
                score=round(score, 1),
                equivalents=equivalents,
                apart=apart,
                parts={},
            )
        )

    def _equal_programs(self, hypothesis: TableHypothesis) -> list[Program]:
        """Return the equivalents of a hypothesis that give the same in every column that is wrong
        in the table, those too that the search for it left aside."""
        if hypothesis.program is None:
            return []
        judge = judge_of(self._sample, self._wrong)
        columns = [judge.select_results([name]) for name in self._names]

        def fits(program: Program) -> Bools:
            results = program.results(judge.scene)
            return np.array([column.matches(results) for column in columns])

        mine = fits(hypothesis.program)
        candidates = hypothesis.equivalents[: 4 * _MAX_EQUIVALENTS]
        return [x for x in candidates if ((fits(x) == mine).mean(-1) >= _NEARLY).all()]

    def _programs(self) -> Iterator[TableHypothesis]:
        """Yield the programs that explain rows of the sample, with the conditions under which they
        do."""
        case = self._sample
        judge = judge_of(case, self._wrong)
        # leave out near-singular rows and others in which the spelling differs from our results:
        # no program is contradicted by them
        ours = dict(zip(case.names, case.ours, strict=True))
        clear = judge._replace(theirs={n: ours[n] for n in judge.theirs}).matches(
            Program().results(case.columns)
        )
        self._agreeing &= clear
        # and rows that are wrong only in results that no spelling computes
        clear &= ~(judge.wrong & try_program(Program(), judge).rows)
        self._quantities = scene_quantities(case.columns)
        judge = judge.select_results(_independent_results(judge.select_rows(np.flatnonzero(clear))))
        places = np.flatnonzero(clear)
        small = judge.select_rows(places)
        if not small.wrong.any():
            return
        self._shown = self._bits[places] > 0
        ours = Program().results(small.scene)
        self._names = [
            name
            for name in small.theirs
            if (small.wrong & ~small.select_results([name]).matches(ours)).any()
        ]
        median = np.median(relative_differences(case).max(0)[self._wrong])
        is_large = bool(median > _MIN_PAIR_DIFFERENCE)
        groups = small.wrong_groups()
        if len(groups) == 1:
            yield from self._explain(small, is_large)
            return
        elsewhere = {name for group in groups[1:] for name in group}
        names = [name for name in small.theirs if name not in elsewhere]
        partial_ones = list(self._explain(small.narrow_to(names), is_large))
        yield from partial_ones
        whole_ones = [
            self._hypothesis(x.program, small, x.equivalents)
            for x in partial_ones
            if x.program is not None
        ]
        # one constant may explain all results, and no single one tells what it belongs to
        constants = rank_programs(fit_constants(small, small.wrong, Program()), small)
        whole_ones += self._with_conditions(constants, ~small.wrong, small)
        yield from whole_ones
        best = self._best(partial_ones)
        if best and best.program and not best.where and not self._are_explained(whole_ones, small):
            extended_programs = list(self._extend(best.program, small))
            yield from extended_programs
            whole_ones += extended_programs
        for group in groups[1:] if not self._are_explained(whole_ones, small) else ():
            other = small.narrow_to(group)
            if other.wrong.any():
                yield from self._explain(other, False)

    def _extend(self, program: Program, judge: Judge) -> Iterator[TableHypothesis]:
        """Yield a program with an edit more, by which it gives the other results, too."""
        trial = try_program(program, judge)
        if not trial.is_complete:
            for better in find_single_edits(judge, judge.wrong & ~trial.rows, program)[:2]:
                yield self._hypothesis(better.program, judge)

    def _explain(self, judge: Judge, is_large: bool) -> Iterator[TableHypothesis]:
        """Yield programs that explain rows of a judge: with one edit, a constant, two edits, or an
        edit on top of the best; and where they hold."""
        singles, hypotheses = self._try_one_change(judge, judge.wrong, ~judge.wrong, Program())
        yield from hypotheses
        best = self._best(hypotheses)
        if best is not None:
            more = list(self._explain_rest(best, hypotheses, judge))
            yield from more
            if self._are_explained([best, *more], judge):
                return
        elif not is_large:
            self.skipped.append("two mistakes at once (the differences are too small)")
            return
        for programs in find_pairs(judge, singles):
            self._meter.update(1)
            trials = rank_programs(programs, judge)
            yield from self._with_conditions(trials[:2], ~judge.wrong, judge)
            if trials and trials[0].is_complete:
                return
            if not self._has_time():
                self.skipped.append("two mistakes at once, in some ways of writing the equations")
                return

    def _try_one_change(
        self,
        judge: Judge,
        left: Bools,
        known: Bools,
        base: Program,
    ) -> tuple[list[Trial], list[TableHypothesis]]:
        """Return the programs with one change more than ``base`` that explain rows ``left``, and
        with the conditions under which they hold: edits, and constants where these leave rows.

        ``known``: the rows that are explained without the change.
        """
        trials = find_single_edits(judge, left, base)
        hypotheses = list(self._with_conditions(trials, known, judge))
        best, shown = self._best(hypotheses), left & self._shows(judge)
        if best is None or (shown & ~try_program(best.program or Program(), judge).rows).any():
            constants = rank_programs(fit_constants(judge, left, base), judge)
            hypotheses += self._with_conditions(constants, known, judge)
            trials += constants
        self._meter.update(1)
        return trials, hypotheses

    def _explain_rest(
        self,
        best: TableHypothesis,
        hypotheses: Sequence[TableHypothesis],
        judge: Judge,
    ) -> Iterator[TableHypothesis]:
        """Yield what explains the rows that the best of the hypotheses leaves: another mistake
        beside it, or on top of it."""
        fits = try_program(best.program or Program(), judge).rows
        known_rows, rows_left = ~judge.wrong | fits, judge.wrong & ~fits & self._shows(judge)
        if rows_left.sum() < _MIN_ROWS_LEFT:
            return
        for base in self._bases(best, hypotheses):
            if not self._has_time():
                self.skipped.append("further mistakes in the unexplained rows")
                return
            trials, more = self._try_one_change(judge, rows_left, known_rows, base)
            yield from more
            least = MIN_FIT * rows_left.sum(), _NEARLY * known_rows.sum()
            if any(
                (trial.rows & rows_left).sum() >= least[0]
                and (trial.rows & known_rows).sum() >= least[1]
                for trial in trials
            ):
                return

    def _bases(self, best: TableHypothesis, hypotheses: Sequence[TableHypothesis]) -> list[Program]:
        """Return the programs on top of which a second mistake is looked for: the best, one like it
        in the spelling that other models are written in, and the correct one."""
        bases = [Program(best.program.edits if best.program else ())]
        enough = _NEARLY * self._score(best)
        for hypothesis in hypotheses:
            programs = [x for x in (hypothesis.program, *hypothesis.equivalents) if x is not None]
            models = [Program(x.edits) for x in programs if x.spelling.title == IMPULSES]
            if models and self._score(hypothesis) >= enough:
                bases += [x for x in models[:1] if x not in bases]
                break
        return [*bases, Program()]

    def _shows(self, judge: Judge) -> Bools:
        """Return the rows of a judge that show anything, as rounding leaves them digits."""
        return self._shown if judge.wrong.size == self._shown.size else judge.wrong

    def _has_time(self) -> bool:
        return time.process_time() < self._ends

    def _are_explained(
        self,
        hypotheses: Sequence[TableHypothesis],
        judge: Judge,
    ) -> bool:
        """Return whether those of the hypotheses that are worth their cost explain nearly all rows
        that disagree."""
        shown = judge.wrong & self._shows(judge)
        rows_left = shown.copy()
        for hypothesis in hypotheses:
            if self._score(hypothesis) >= _MIN_SCORE:
                rows_left &= ~try_program(hypothesis.program or Program(), judge).rows
        return bool(rows_left.sum() <= (1 - MIN_FIT) * shown.sum())

    def _best(self, hypotheses: Sequence[TableHypothesis]) -> TableHypothesis | None:
        """Return the hypothesis with the highest score, None where none is worth its cost."""
        score_pairs = [(self._score(x), x) for x in hypotheses]
        score, best = max(score_pairs, key=lambda pair: pair[0], default=(0.0, None))
        return best if score >= _MIN_SCORE else None

    def _with_conditions(
        self,
        trials: Sequence[Trial],
        known: Bools,
        judge: Judge,
    ) -> Iterator[TableHypothesis]:
        """Yield programs as hypotheses, and with the conditions that keep out the rows that
        contradict them, and those that they leave without a cause.

        ``known``: the rows that are explained without them.
        """
        quantities = scene_quantities(judge.scene)
        groups: dict[bytes, list[Trial]] = {}
        for trial in trials:
            groups.setdefault(trial.rows.tobytes(), []).append(trial)
        for group in list(groups.values())[:_MAX_CANDIDATES]:
            first, *alike = sorted(group, key=_plainness)
            programs = [trial.program for trial in alike]
            yield self._hypothesis(first.program, judge, programs)
            inside = first.rows & ~known & self._shows(judge)
            outside = ~first.rows & (known | self._shows(judge))
            conditions = [
                find_predicate(quantities, inside, rows)
                for rows in (outside & known, outside)
                if rows.any() and inside.any()
            ]
            for predicate in filter(None, dict.fromkeys(conditions)):
                if limited := limit_instead(first.program, predicate):
                    yield self._hypothesis(limited, judge)
                else:
                    where, *others = (
                        program._replace(where=predicate) for program in (first.program, *programs)
                    )
                    yield self._hypothesis(where, judge, others)

    def _hypothesis(
        self, program: Program, judge: Judge, equivalents: Sequence[Program] = ()
    ) -> TableHypothesis:
        """Return a program as a hypothesis about the judge's results."""
        names = tuple(judge.theirs)
        left_out = [name for name in self._names if name not in names]
        says = program.sentence
        if left_out:
            says += f"; {', '.join(left_out)} {UNKNOWN}"
        cost = sum(map(_cost_of, program.edits)) + _COST_LEFT_OUT * len(left_out)
        return TableHypothesis(
            says,
            lambda case: match_program(program, case, names),
            cost + (PREDICATE_COST if program.where else 0.0),
            program=program,
            names=names,
            equivalents=equivalents,
        )


def _plainness(trial: Trial) -> tuple[int, bool, int]:
    """Return what programs that give the same are sorted by: the likeliest first, of these one that
    is said in words and not by a formula, and briefly."""
    sentence = trial.program.sentence
    if any(edit.rank == FITTED for edit in trial.program.edits):  # in the order of their places
        return trial.rank, False, 0
    return trial.rank, any(sign in sentence for sign in "*/+"), len(sentence)


def _cost_of(edit: Edit) -> float:
    """Return the bits that it takes to state an edit."""
    if edit.rank == FITTED:
        return _COST_CONSTANT
    return cost_named() if edit.rank <= RARE_CONVENTION else _COST_EDIT + (edit.rank - 3)


def _sample_rows(case: ComparedRows, wrong: Bools) -> NDArray[np.intp]:
    """Return at most `MAX_SEARCHED` rows that disagree, and as many that agree, in the table's
    order: evenly by kind of scene."""
    g = case.columns
    conditions = (
        g["MU"] == PIVOT,
        g["M"] == 4,
        g["MU"] == 0,
        (g["WA"] == 0) & (g["WB"] == 0),
        (g["DA"] == 0) & (g["DB"] == 0),
        g["EM"] == 1,
    )
    kind = np.sum([condition << place for place, condition in enumerate(conditions)], 0)
    chosen = []
    for rows in (wrong, ~wrong):
        places = np.flatnonzero(rows)
        if places.size > MAX_SEARCHED:
            places = places[np.argsort(kind[places], kind="stable")]
            _, first, counts = np.unique(kind[places], return_index=True, return_counts=True)
            evenly = pick_evenly(np.arange(places.size), MAX_SEARCHED - 2 * first.size)
            places = places[np.unique(np.concatenate([evenly, first, first + counts - 1]))]
        chosen.append(places)
    return np.sort(np.concatenate(chosen))


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


_SCENES_TRIED = 60  # to tell two programs apart
_SAME_ELSEWHERE = 1e-6  # relative difference up to which they are the same


def _tell_apart(hypothesis: TableHypothesis) -> tuple[list[str], dict[str, str]]:
    """Return the programs that give the same in this table, and elsewhere other velocities or
    impulses; and a scene in which the first of them gives other velocities."""
    if not hypothesis.equivalents:
        return [], {}
    rng = Random(88)
    scenes = [casework(rng) for _ in range(_SCENES_TRIED)]
    for place, scene in enumerate(scenes):
        scene |= {"MU": "-10"} if place % 6 == 5 else {}
    numbers = [doubles_of(scene) for scene in scenes]
    columns = {name: np.array([row[name] for row in numbers]) for name in SCENE}
    mine = hypothesis.results(columns)
    others: list[str] = []
    apart: dict[str, str] = {}
    for program in hypothesis.equivalents:
        results = hypothesis._replace(program=program).results(columns)
        off = np.max([_distance(mine[name], results[name]) for name in FINAL_VELOCITIES], 0)
        if max(off.max(), _distance(mine["PN"], results["PN"]).max()) > _SAME_ELSEWHERE:
            if not others and off.max() > _SAME_ELSEWHERE:
                scene = scenes[int(off.argmax())]
                apart = {name: scene[name] for name in SCENE}
            others.append(program.sentence)
    return list(dict.fromkeys(others))[:_MAX_EQUIVALENTS], apart


def _distance(one: Any, other: Any) -> Any:
    with np.errstate(all="ignore"):
        off = np.abs(one - other) / (1 + np.abs(one))
    return np.where(np.isnan(off), np.isnan(one) != np.isnan(other), off)
