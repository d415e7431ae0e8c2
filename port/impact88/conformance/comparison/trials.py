"""Find the program that computes the results of a table: every single mistake, and pairs of them.

All edits of all spellings are run on a few rows; those that explain any are run on more. Pairs are
found in two ways. By equations: with the other program's velocities put in, the changes that two
edits make to the residuals add up to what cancels them. By rows: one edit explains some of the rows
alone, and a second one, on top of it, the rest.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...equations.edits import CONVENTION, Edit, node_edits, readings, spelling_edits, variants
from ...equations.evaluation import RESIDUAL, Columns, Run, chunks, evaluate
from ...equations.spelling import (
    IMPULSE_MATRIX,
    IMPULSES,
    LISTING,
    SHOWN,
    Spelling,
    parse_expression,
    spellings,
)
from ...names import FINAL_VELOCITIES
from .agreement import Bools, Floats
from .predicates import Predicate, scene_quantities

MIN_FIT = 0.9
"""Fraction of the disagreeing rows, and of the agreeing ones, that a cause must fit."""
_MAX_FULL_RUNS = 60  # programs run on all rows of a sample: equivalents in nine spellings, and more
# rows that all edits are run on; the time of the search is proportional to their number
_MAX_UNEXPLAINED = 10
_MIN_OTHERS = 5
_MAX_ROWS_FOR_PAIRS = 8  # disagreeing rows on which pairs are looked for; half for two readings
_MAX_FIRST_EDITS = 4  # edits on top of which a second one is looked for
_MIN_FRACTION = 0.1
"""Fraction of the disagreeing rows that the first edit of a pair must explain alone, or in which a
result must be wrong to be explained separately."""
_RESIDUAL_TOL = 1e-11
"""Tolerance of residuals besides the digits written; rounding of their terms is about 1e-13."""


class Program(NamedTuple):
    """A spelling with edits, each made on top of the ones before; ``where``: the condition on the
    scene under which they are made, None where they always are."""

    edits: tuple[Edit, ...] = ()
    where: Predicate | None = None

    @property
    def sentence(self) -> str:
        """Say in words of mechanics what the program does. A rewritten statement that a later edit
        rewrites again is left out."""
        says = "; and ".join(edit.sentence for edit in self._visible())
        return f"{says} {self.where.text}" if self.where else says

    @property
    def formula(self) -> str:
        """The statements as they are written, and as they should be."""
        return "; ".join(edit.formula for edit in self._visible() if edit.formula)

    def _visible(self) -> list[Edit]:
        """Return the edits that no later one rewrites, those with names of their own first."""
        visible = []
        for place, edit in enumerate(self.edits):
            later_keys = {key for later in self.edits[place + 1 :] for key in later.sides}
            if edit.description or not later_keys.issuperset(edit.sides):
                visible.append(edit)
        return sorted(visible, key=lambda edit: not edit.description)

    @property
    def spelling(self) -> Spelling:
        """The edited spelling; the listing where the edits belong to none."""
        return self.in_spelling(LISTING)

    def in_spelling(self, title: str) -> Spelling:
        """Return the edited spelling, that of ``title`` where the edits belong to none."""
        spelling = spellings()[next((edit.title for edit in self.edits if edit.title), title)]
        for edit in self.edits:
            spelling = spelling.with_edits(edit.sides)
        return spelling

    def results(self, scene: Columns, title: str = LISTING) -> dict[str, Any]:
        """Return the results that the program shows for scenes (columns of n), by name."""
        run = Run(self.in_spelling(title), scene)
        results = {
            name.removeprefix(SHOWN): np.broadcast_to(column, (1, run.size))[0]
            for name, column in run.names.items()
            if name.startswith(SHOWN)
        }
        if self.where is None:
            return results
        rows, correct = self.where.rows(scene_quantities(scene)), Program().results(scene)
        return {name: np.where(rows, results[name], correct[name]) for name in correct}


class Judge(NamedTuple):
    """Rows of a table against which programs are tried.

    ``theirs``: results of the other program; ``limit``: how far from them a result may be, row by
    row, to count as the same; ``wrong``: the rows that disagree with the correct program.
    """

    scene: Columns
    theirs: Columns
    limit: Columns
    wrong: Bools

    def select_rows(self, rows: NDArray[np.intp]) -> "Judge":
        """Return the judge of some of the rows."""
        scene, theirs, limit = (
            {name: column[rows] for name, column in columns.items()} for columns in self[:3]
        )
        return Judge(scene, theirs, limit, self.wrong[rows])

    def select_results(self, names: Sequence[str]) -> "Judge":
        """Return the judge that looks at some of the results only."""
        theirs = {name: column for name, column in self.theirs.items() if name in names}
        return self._replace(theirs=theirs)

    def narrow_to(self, names: Sequence[str]) -> "Judge":
        """Return the judge of some of the results; ``wrong`` has only rows wrong in these."""
        part = self.select_results(names)
        return part._replace(wrong=~try_program(Program(), part).rows & self.wrong)

    def wrong_groups(self) -> list[list[str]]:
        """Return the groups of results that are wrong in many rows: the final velocities, and each
        other result. All results in one group, where there is no such group."""
        names = list(self.theirs)
        ours, min_rows = Program().results(self.scene), _MIN_FRACTION * self.wrong.sum()
        singles = [[name] for name in names if name not in FINAL_VELOCITIES]
        groups = [[*FINAL_VELOCITIES], *singles] if self.has_velocities else []
        return [
            group
            for group in groups
            if (self.wrong & ~self.select_results(group).matches(ours)).sum() >= min_rows
        ] or [names]

    def matches(self, results: Columns, prefix: str = "") -> Bools:
        """Return the rows, (n,) or (K, n), in which all results are within the limits.

        A result that either side lacks (NaN in the table) is not compared.
        """
        fits: Any = np.ones(self.wrong.size, bool)
        for name, theirs in self.theirs.items():
            if (mine := results.get(prefix + name)) is not None:
                fits = fits & ((np.abs(mine - theirs) <= self.limit[name]) | np.isnan(theirs))
        return np.asarray(fits)

    def sample(self, unexplained: Bools, count: int = _MAX_UNEXPLAINED) -> "Judge":
        """Return the judge of at most ``count`` unexplained rows and a few others."""
        rows = pick_evenly(np.flatnonzero(unexplained), count)
        other_rows = pick_evenly(np.flatnonzero(~unexplained), count + _MIN_OTHERS - rows.size)
        return self.select_rows(np.concatenate([rows, other_rows]))

    @property
    def has_velocities(self) -> bool:
        """True if all final velocities are judged."""
        return self.theirs.keys() >= set(FINAL_VELOCITIES)


def pick_evenly(places: NDArray[np.intp], count: int) -> NDArray[np.intp]:
    """Return at most ``count`` of the places, evenly spaced."""
    chosen = np.linspace(0, places.size - 1, min(count, places.size)).astype(int)
    return np.asarray(places[chosen])


class Trial(NamedTuple):
    """A program tried on a judge's rows: ``rows`` that it fits, and those that are ``wrong``."""

    program: Program
    rows: Bools
    wrong: Bools

    @property
    def rank(self) -> int:
        """Sum of the edits' ranks; a lower one is likelier."""
        return sum(edit.rank for edit in self.program.edits)

    @property
    def explained_count(self) -> int:
        """Number of disagreeing rows that the program explains."""
        return int((self.rows & self.wrong).sum())

    @property
    def is_supported(self) -> bool:
        """True if the program fits nearly all rows that agree."""
        return bool((self.rows & ~self.wrong).sum() >= MIN_FIT * (~self.wrong).sum())

    @property
    def is_complete(self) -> bool:
        """True if the program fits nearly all rows, those that disagree and those that agree."""
        return self.is_supported and self.explained_count >= MIN_FIT * self.wrong.sum() > 0


def try_program(program: Program, judge: Judge) -> Trial:
    """Run a program on all rows of a judge.

    One that belongs to no spelling is run in two, for each loses digits where the other does not.
    """
    if not program.edits or any(edit.title for edit in program.edits):
        return Trial(program, judge.matches(program.results(judge.scene)), judge.wrong)
    rows = judge.matches(program.results(judge.scene, IMPULSE_MATRIX))
    other_rows = np.flatnonzero(~rows)
    if other_rows.size:
        part = judge.select_rows(other_rows)
        rows[other_rows] = part.matches(program.results(part.scene))
    return Trial(program, rows, judge.wrong)


def rank_programs(programs: Iterable[Program], judge: Judge) -> list[Trial]:
    """Run programs on all rows and sort them, best first; among equals the likeliest."""

    def order(trial: Trial) -> tuple[bool, int, int, int]:
        agreeing_count = int((trial.rows & ~trial.wrong).sum())
        return not trial.is_complete, -trial.explained_count, -agreeing_count, trial.rank

    return sorted((try_program(program, judge) for program in programs), key=order)


def find_single_edits(judge: Judge, unexplained: Bools, base: Program | None = None) -> list[Trial]:
    """Return programs with one edit, or one more than ``base``, that explain rows, best first."""
    trials = list(_try_edits(judge.sample(unexplained), base or Program()))
    trials.sort(key=lambda trial: (-int(trial.rows.sum()), trial.rank))
    return rank_programs((trial.program for trial in trials[:_MAX_FULL_RUNS]), judge)


def _try_edits(judge: Judge, base: Program) -> Iterator[Trial]:
    """Yield the programs with one more edit than ``base`` that explain a row.

    Where an edit of ``base`` belongs to a spelling, only that spelling is edited.
    """
    size = judge.wrong.size
    base_titles = [edit.title for edit in base.edits if edit.title]
    for title in base_titles[:1] or spellings():
        spelling = Program((*base.edits, Edit(title, {}))).spelling
        changed_keys = {key for edit in base.edits for key in edit.sides}
        edits = [x for x in variants() if x.title == title and changed_keys.isdisjoint(x.sides)]
        if base_titles or title == LISTING:
            edits += [edit for edit in readings() if edit not in base.edits]
        edits += node_edits(spelling) if base_titles else spelling_edits(title)
        start = Run(spelling, judge.scene)
        distinct = start.distinct_edits([spelling.compose(edit.sides) for edit in edits])
        for part in chunks(len(distinct), size):
            changes = [edit_changes for _, edit_changes in distinct[part]]
            fits = judge.matches({**start.names, **start.run_edits(changes)}, SHOWN)
            fits = np.broadcast_to(fits, (len(changes), size))
            for k in np.flatnonzero((fits & judge.wrong).any(1)):
                program = Program((*base.edits, edits[distinct[part][k][0]]))
                yield Trial(program, fits[k], judge.wrong)


def find_pairs(judge: Judge, singles: Sequence[Trial]) -> Iterator[list[Program]]:
    """Yield lists of programs with two edits, from the cheapest search to the most expensive.

    ``singles``: programs with one edit that explain some rows.
    """
    yield list(_pairs_of_readings(judge.sample(judge.wrong, _MAX_ROWS_FOR_PAIRS // 2)))
    if judge.has_velocities:
        some_rows = judge.select_results(FINAL_VELOCITIES).sample(judge.wrong, _MAX_ROWS_FOR_PAIRS)
        is_given = np.all([np.isfinite(column) for column in some_rows.theirs.values()], axis=0)
        yield from _pairs_by_equations(some_rows.select_rows(np.flatnonzero(is_given)), judge)
    min_rows = _MIN_FRACTION * judge.wrong.sum()
    firsts = [t for t in singles if t.is_supported and t.explained_count >= min_rows]
    for first in firsts[:_MAX_FIRST_EDITS]:
        unexplained = judge.wrong & ~first.rows
        if unexplained.any():
            trials = find_single_edits(judge, unexplained, first.program)
            yield [trial.program for trial in trials[:2]]


def _pairs_of_readings(judge: Judge) -> Iterator[Program]:
    """Yield pairs of common conventions, the first of them one of reading, that explain the rows.

    Each second edit is run on the scenes as all the first edits read them, (K, n).
    """
    common = [edit for edit in readings() if edit.rank == CONVENTION]
    firsts = [edit for edit in common if not edit.changes_output]
    spelling = spellings()[IMPULSES]
    base_run = Run(spelling, judge.scene)
    scenes = dict(judge.scene) | base_run.run_edits([edit.sides for edit in firsts])
    for second in common:
        fits = judge.matches(Run(spelling.with_edits(second.sides), scenes).names, SHOWN)
        for place in np.flatnonzero(fits.mean(-1) >= MIN_FIT) if fits.ndim > 1 else ():
            yield Program((firsts[place], second))


_IMPULSES = {
    "A": {"Px": "MA*(VAX - UX)", "Py": "MA*(VAY - UY)", "Pm": "ia*(WAF - WA) - D3*Px + D4*Py"},
    "B": {"Px": "-MB*(VBX - VX)", "Py": "-MB*(VBY - VY)", "Pm": "D1*Px - D2*Py - ib*(WBF - WB)"},
}
"""Vehicle -> the impulses, computed from the change of its velocities."""
_COMPONENTS = {
    "Pn": "c*Px + s*Py",
    "Pt": "c*Py - s*Px",
    "T": "Pm",
    "VAN": "c*VAX + s*VAY",
    "VAT": "c*VAY - s*VAX",
    "VBN": "c*VBX + s*VBY",
    "VBT": "c*VBY - s*VBX",
}
"""Impulses and velocities along n and t."""
_MAX_PARTNERS = 200
"""Partners of an edit that are looked at; only tables with few digits have more."""


class _Residuals(NamedTuple):
    """``run``: a spelling with the other program's velocities put in; ``of_edits``: the residuals
    that each of several edits leaves, relative to their limits, (K, equations, rows)."""

    run: Run
    of_edits: Callable[[Sequence[Mapping[str, Any]]], Floats]


def _clamped_residuals(spelling: Spelling, judge: Judge, vehicle: str) -> _Residuals:
    """Return the residuals of a spelling's equations with the other program's velocities put in,
    and impulses computed from the velocity change of ``vehicle``, A or B.

    A residual's limit is what its change is when each velocity moves by its own limit.
    """
    names = Run(spelling, judge.scene).names

    def clamp(theirs: Columns) -> Run:
        values = {**names, **theirs}
        formulas = {**_IMPULSES[vehicle], **_COMPONENTS}
        for name, text in formulas.items():
            values[name] = evaluate(parse_expression(text), values)
        return Run(spelling, judge.scene, {n: values[n] for n in (*FINAL_VELOCITIES, *formulas)})

    run = clamp(judge.theirs)
    residuals = {key: x for key, x in run.names.items() if key.startswith(RESIDUAL)}
    limits: dict[str, Any] = dict.fromkeys(residuals, _RESIDUAL_TOL)
    for name in FINAL_VELOCITIES:
        moved = {**judge.theirs, name: judge.theirs[name] + judge.limit[name]}
        moved_names = clamp(moved).names
        for key, residual in residuals.items():
            limits[key] = limits[key] + np.abs(moved_names[key] - residual)

    def of_edits(edits: Sequence[Mapping[str, Any]]) -> Floats:
        values = {**run.names, **run.run_edits(edits)}
        shape = (len(edits), run.size)
        parts = [np.broadcast_to(values[key] / limit, shape) for key, limit in limits.items()]
        return np.stack(parts, 1)

    return _Residuals(run, of_edits)


def _pairs_by_equations(judge: Judge, full: Judge) -> Iterator[list[Program]]:
    """Yield programs with two edits that together cancel the residuals of the other program's
    velocities; then with a reading, and an edit on top of it.

    ``judge``: a few rows, in which all final velocities are given; ``full``: all rows, which the
    edit on top of a reading is to explain.
    """
    input_edits = [edit for edit in readings() if not edit.changes_output]
    for title, spelling in spellings().items():
        models = [edit for edit in variants() if edit.title == title]
        edits = [*input_edits, *models, *spelling_edits(title)]
        has_impulses = {"Px", "Pn"} & {*spelling.index_of, *spelling.unknown}
        for vehicle in "AB" if has_impulses else "A":
            yield _cancelling_pairs(_clamped_residuals(spelling, judge, vehicle), edits)
    # rank the readings by the number of equations or statements that they leave violated
    gains = np.zeros(len(input_edits), int)
    for title, vehicle in ((LISTING, "A"), (IMPULSES, "A"), (IMPULSES, "B")):
        _, residuals_of = _clamped_residuals(spellings()[title], judge, vehicle)
        is_small = np.abs(residuals_of([{}, *(edit.sides for edit in input_edits)])) <= 2
        violated = (is_small.mean(-1) < MIN_FIT).sum(1)
        gains = np.maximum(gains, violated[0] - violated[1:])
    for place in np.argsort(-gains, kind="stable")[:_MAX_FIRST_EDITS]:
        if gains[place] > 0:
            trials = find_single_edits(full, full.wrong, Program((input_edits[place],)))
            yield [trial.program for trial in trials[:2]]


def _cancelling_pairs(residuals: _Residuals, edits: Sequence[Edit]) -> list[Program]:
    """Return programs with two edits whose changes d of the residuals r cancel them: r + d_i + d_j
    is 0 within the limits.

    Candidates come from a random projection w: for each i, the j with w.d_j = -w.r - w.d_i are
    looked up in the sorted projections. Half of the rows is projected at a time, so that a pair is
    found though some rows do not fit.
    """
    run, residuals_of = residuals
    distinct = run.distinct_edits([edit.sides for edit in edits])
    parts = [distinct[part] for part in chunks(len(distinct), run.size)]
    base = residuals_of([{}])
    edited = [residuals_of([changes for _, changes in part]) for part in parts]
    deltas = np.concatenate([base, *edited]) - base
    # 8 limits: smaller changes are no mistakes that show
    usable = np.isfinite(deltas).all((1, 2)) & (np.abs(deltas) > 8).any((1, 2))
    deltas = deltas[usable]
    candidates = [edits[distinct[k - 1][0]] for k in np.flatnonzero(usable)]
    pairs = set()
    rng = np.random.default_rng(88)
    for half in (slice(0, None, 2), slice(1, None, 2)):
        weights = rng.uniform(-1.0, 1.0, base[0, :, half].shape)
        sums = np.einsum("kij,ij", deltas[:, :, half], weights)
        missing = -(base[0, :, half] * weights).sum() - sums
        tolerance = 2 * np.abs(weights).sum() + _RESIDUAL_TOL * np.abs(sums)
        order = np.argsort(sums)
        starts = np.searchsorted(sums[order], missing - tolerance)
        ends = np.searchsorted(sums[order], missing + tolerance)
        for i in np.flatnonzero(ends > starts):
            partners = order[starts[i] : min(ends[i], starts[i] + _MAX_PARTNERS)]
            cancels = (np.abs(base + deltas[i] + deltas[partners]) <= 2).all(1)
            fitting = partners[cancels.mean(1) >= MIN_FIT]
            pairs |= {(int(i), int(j)) for j in fitting if i < j}
    programs = [Program((candidates[i], candidates[j])) for i, j in sorted(pairs)]
    programs.sort(key=lambda pair: pair.edits[0].rank + pair.edits[1].rank)
    return programs[:_MAX_FIRST_EDITS]
