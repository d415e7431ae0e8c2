"""Name the mistake: mutation analysis, turned round.

A competent programmer's program is nearly right (DeMillo, Lipton and Sayward 1978), so what it
computes is computed by a small edit of the reference. Every edit is tried on a few rows that
disagree; one that gives the other table's numbers, to their last digit, is tried on more. An edit
that gives some rows only is one under a condition on the scene. Where one edit is not enough, a
constant is fitted, or a second edit is looked for on top of the best. Nothing is named that does
not give the rows kept out of the search.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .agreement import Bools
from .conditions import Condition, find_condition, quantities_of
from .constants import fit_constants
from .evaluation import Edit, Floats, Program
from .mutants import RANK_MODEL, Site, describe, models, sites
from .numbers import spread
from .spellings import NAMES, VELOCITIES, spelling

SCREEN_ROWS = 10  # rows that disagree on which every edit is tried
MIN_SCREENED = 2  # of them, that an edit under a condition gives
REQUIRED = 0.96  # of the rows, that an explanation gives
MARGIN = 0.01  # of the rows, by which a likelier explanation may give fewer
MIN_HELD_OUT = 4  # rows; with fewer the search uses all
MIN_BITS = 24.0  # of information in the rows: about a million edits are tried
WITH_READING = ("impulses", "trial")  # spellings in which a mistake of the reading is looked for
MAX_CONDITIONAL = 60  # edits for which a condition is looked for
MAX_BASES = 4  # edits on top of which a second one is looked for
MAX_ALTERNATIVES = 3  # listed, of those that give the same numbers


class Sample(NamedTuple):
    """Rows on which programs are tried.

    ``columns`` of the scene, ``theirs`` (results), ``limits`` (how far off each may be), ``wrong``:
    the rows that disagree.
    """

    columns: Mapping[str, Floats]
    theirs: Mapping[str, Floats]
    limits: Mapping[str, Floats]
    wrong: Bools

    def rows(self, places: NDArray[np.intp]) -> "Sample":
        """Return some of the rows."""
        parts = [{n: c[places] for n, c in part.items()} for part in self[:3]]
        return Sample(parts[0], parts[1], parts[2], self.wrong[places])

    def only(self, names: Iterable[str]) -> "Sample":
        """Return the sample with some of the results."""
        return self._replace(theirs={n: self.theirs[n] for n in names if n in self.theirs})

    def program(
        self, name: str, edits: tuple[Edit, ...] = (), wanted: Sequence[str] = ()
    ) -> Program:
        """Return a spelling with edits on the rows; with their final velocities, if given."""
        velocities = {n: self.columns[n] for n in VELOCITIES if n in self.columns}
        return Program(name, self.columns, edits, velocities or None, wanted)

    def fits(self, names: Mapping[str, Any], alternatives: int = 1) -> Bools:
        """Return (alternatives, rows): whether all results are within their limits."""
        shape = (alternatives, self.wrong.size)
        fit = np.ones(shape, bool)
        for name, theirs in self.theirs.items():
            ours = names[name]
            difference = np.abs(ours - theirs)
            close = (difference <= self.limits[name]) & np.isfinite(difference)
            fit &= close | ~(np.isfinite(ours) | np.isfinite(theirs))
            if not fit.any():
                break
        return fit


class Candidate(NamedTuple):
    """A program: a spelling with edits, under a condition; the rows of a sample that it gives."""

    name: str
    edits: tuple[Edit, ...]
    rows: Bools
    condition: Condition | None = None
    alternatives: tuple[str, ...] = ()

    @property
    def rank(self) -> tuple[int, int, int]:
        """The likeliest first, and of those the smallest edit."""
        length = sum(len(text) for edit in self.edits for text in edit.written)
        return sum(edit.rank for edit in self.edits), NAMES.index(self.name), length

    @property
    def text(self) -> str:
        """The edits in words."""
        return "; and ".join(describe(edit, self.name) for edit in self.edits)

    def gives(self, sample: Sample) -> Bools:
        """Return the rows of a sample that the program gives."""
        rows: Bools = sample.fits(sample.program(self.name, self.edits).base)[0]
        if self.condition is not None:
            inside = self.condition.rows(quantities_of(sample.columns))
            plain = sample.fits(sample.program(self.name).base)[0]
            rows = np.where(inside, rows, plain)
        return rows


def score(rows: Bools, sample: Sample) -> int:
    """Return how many rows that disagree are given, less those that agree and are not."""
    return int((rows & sample.wrong).sum() - (~rows & ~sample.wrong).sum())


def is_complete(rows: Bools, sample: Sample) -> bool:
    """Return whether enough rows of both kinds are given."""
    return all(
        (rows & kind).sum() >= REQUIRED * kind.sum() for kind in (sample.wrong, ~sample.wrong)
    )


def information(sample: Sample) -> float:
    """Return the bits that the rows that disagree hold: into how many their difference divides."""
    ours = sample.program(NAMES[0]).base
    bits = 0.0
    for name, theirs in sample.theirs.items():
        off = np.abs(theirs - ours[name])[sample.wrong] / sample.limits[name][sample.wrong]
        bits += float(np.log2(off[np.isfinite(off) & (off > 1)]).sum())
    return bits


def _trials(name: str, part: str, is_second: bool) -> Iterator[Site | Edit]:
    """Yield what is tried in a part of a spelling: sites, then laws and conventions.

    Mistakes of the reading are tried in some spellings only, laws in the one that they are written
    in, and as a second edit only those that have a name.
    """
    text = spelling(name)
    reading = {statement.target for statement in text.statements[: text.own]}
    for site in sites(name, part):
        if is_second or name in WITH_READING or reading.isdisjoint(site.targets):
            yield site
    for edit in models() if is_second or name == NAMES[0] else ():
        shown = {key[2:] for key in edit.changes if key[0] == ">"}
        is_law = any(key[0] not in "<>" for key in edit.changes)
        is_late = bool(shown) and shown.isdisjoint(VELOCITIES)
        is_usual = edit.rank == RANK_MODEL or not is_second
        if (part == "results") == is_late and is_usual and (name == NAMES[0] or not is_law):
            yield edit


def _screened(
    trials: Sequence[Site | Edit], program: Program, screen: Sample
) -> Iterator[tuple[Site | Edit, NDArray[np.intp]]]:
    """Yield trials of the same statements, and the number of rows that each option gives."""
    made = [trial.values(program) for trial in trials if isinstance(trial, Site)]
    if len(made) == len(trials):
        values = {key: np.concatenate([v[key] for v in made], -2) for key in made[0]}
        sizes = [len(trial.options) for trial in trials]
        counts = screen.fits(program.propagate(values), sum(sizes)).sum(1)
        yield from zip(trials, np.split(counts, np.cumsum(sizes)[:-1]), strict=True)
    else:
        for trial in trials:
            yield trial, screen.fits(trial.run(program), len(trial.options)).sum(1)


@np.errstate(all="ignore")
def search(
    sample: Sample, part: str, names: Sequence[str] = NAMES, base: tuple[Edit, ...] = ()
) -> list[Candidate]:
    """Return the programs with one edit more than ``base`` that give rows, the best first.

    ``part``: "velocities" or "results", whose statements are edited. With a sample whose columns
    hold final velocities the results follow from those.
    """
    screen = sample.rows(spread(np.flatnonzero(sample.wrong), SCREEN_ROWS))
    need = min(MIN_SCREENED, screen.wrong.size)
    candidates: list[Candidate] = []
    targets = {key for edit in base for key in edit.changes}
    for name in names:
        wanted = tuple(sample.theirs) if part == "velocities" else ()
        small, full = (s.program(name, base, wanted) for s in (screen, sample))
        plain = sample.fits(full.base)[0]  # what an edit that changes nothing gives
        trials = (t for t in _trials(name, part, bool(base)) if targets.isdisjoint(t.targets))
        for _, batch in groupby(trials, lambda trial: trial.targets):
            for trial, counts in _screened([*batch], small, screen):
                options = np.flatnonzero(counts >= need).tolist()
                values = trial.run(full, options) if options else {}
                fits = sample.fits(values, len(options)) if options else ()
                candidates += [
                    Candidate(name, (*base, trial.edit(k)), rows)
                    for k, rows in zip(options, fits, strict=True)
                    if (rows != plain).any()
                ]
    return sorted(candidates, key=lambda c: (-score(c.rows, sample), c.rank))


def _conditional(candidates: Sequence[Candidate], sample: Sample) -> list[Candidate]:
    """Return candidates with the condition under which they hold, where one is found."""
    quantities = quantities_of(sample.columns)
    conditional = []
    for candidate in _distinct(candidates)[:MAX_CONDITIONAL]:
        inside, outside = candidate.rows & sample.wrong, ~candidate.rows
        condition = find_condition(quantities, inside, outside & ~sample.wrong)
        if condition is not None:
            rows = np.where(condition.rows(quantities), candidate.rows, ~sample.wrong)
            conditional.append(candidate._replace(condition=condition, rows=rows))
    return sorted(conditional, key=lambda c: (-score(c.rows, sample), c.rank))


def _distinct(candidates: Sequence[Candidate]) -> list[Candidate]:
    """Return the likeliest of the candidates that give the same rows."""
    best: dict[bytes, Candidate] = {}
    for candidate in candidates:
        key = candidate.rows.tobytes()
        if key not in best or candidate.rank < best[key].rank:
            best[key] = candidate
    return list(best.values())


def explain(sample: Sample, held_out: Sample, part: str) -> Candidate | None:
    """Return the likeliest program that gives the rows, and those kept out of the search.

    None where the rows that disagree hold too little information. Two edits give a few rows by
    chance: they are looked for only where some that disagree are kept out.
    """
    if information(sample) < MIN_BITS:
        return None
    are_kept_out = sample.columns["row"][0] != held_out.columns["row"][0]  # that disagree are first
    stages = _stages(sample, part, MAX_BASES if are_kept_out else 0)
    causes = (_confirm(stage, sample, held_out) for stage in stages)
    return next((cause for cause in causes if cause is not None), None)


def _stages(sample: Sample, part: str, bases: int) -> Iterator[list[Candidate]]:
    """Yield candidates: one edit, one under a condition, a constant, two on ``bases`` of one."""
    names = NAMES if part == "velocities" else NAMES[:1]
    singles = search(sample, part, names)
    yield singles
    yield _conditional(singles, sample)
    constants = [
        Candidate(name, (edit,), sample.fits(sample.program(name, (edit,)).base)[0])
        for name in names
        for edit in fit_constants(sample, name, part)
    ]
    yield [*constants, *_conditional(constants, sample)]
    harmless = [
        c for c in singles if (c.rows & ~sample.wrong).sum() >= REQUIRED * (~sample.wrong).sum()
    ]
    for base in _distinct(harmless)[:bases]:
        pairs = search(sample, part, (base.name,), base.edits)
        yield [*pairs, *_conditional(pairs[:10], sample)]


def _confirm(candidates: Sequence[Candidate], sample: Sample, held_out: Sample) -> Candidate | None:
    """Return the likeliest candidate that gives the rows kept out of the search, too."""
    usable = [c for c in candidates if is_complete(c.rows, sample)]
    best = max((score(c.rows, sample) for c in usable), default=0)
    margin = MARGIN * sample.wrong.size
    usable.sort(key=lambda c: (score(c.rows, sample) < best - margin, c.rank))
    confirmed = [c for c in usable[:MAX_CONDITIONAL] if is_complete(c.gives(held_out), held_out)]
    if not confirmed:
        return None
    first = confirmed[0]
    texts = [c.text for c in confirmed if c.condition == first.condition]
    others = [text for text in dict.fromkeys(texts) if text != first.text]
    return first._replace(alternatives=tuple(others[:MAX_ALTERNATIVES]))
