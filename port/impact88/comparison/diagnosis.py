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
from .mutants import RANK_MODEL, describe, models, sites
from .numbers import spread
from .spellings import NAMES, VELOCITIES

SCREEN_ROWS = 10  # rows that disagree on which every edit is tried
MIN_SCREENED = 2  # of them, that an edit under a condition gives
REQUIRED = 0.96  # of the rows, that an explanation gives
MARGIN = 0.01  # of the rows, by which a likelier explanation may give fewer
MIN_HELD_OUT = 4  # rows; with fewer the search uses all
MIN_BITS = 24.0  # of information in the rows: about a million edits are tried
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

    def given_by(self, name: str, edits: tuple[Edit, ...] = ()) -> Bools:
        """Return the rows that a spelling with edits gives."""
        rows: Bools = self.fits(Program(name, self.columns, edits).base)[0]
        return rows

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
        length = sum(len(text) for edit in self.edits for text in edit.changes.values())
        return sum(edit.rank for edit in self.edits), NAMES.index(self.name), length

    @property
    def text(self) -> str:
        """The edits in words."""
        return "; and ".join(describe(edit, self.name) for edit in self.edits)

    def gives(self, sample: Sample) -> Bools:
        """Return the rows of a sample that the program gives."""
        rows = sample.given_by(self.name, self.edits)
        if self.condition is not None:
            inside = self.condition.rows(quantities_of(sample.columns))
            rows = np.where(inside, rows, sample.given_by(self.name))
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
    ours = Program(NAMES[0], sample.columns).base
    bits = 0.0
    for name, theirs in sample.theirs.items():
        off = np.abs(theirs - ours[name])[sample.wrong] / sample.limits[name][sample.wrong]
        bits += float(np.log2(off[np.isfinite(off) & (off > 1)]).sum())
    return bits


def _models(name: str, part: str, is_second: bool) -> Iterator[Edit]:
    """Yield laws, in the spelling that they are written in, and conventions.

    As a second edit only those that have a name.
    """
    for edit in models() if is_second or name == NAMES[0] else ():
        shown = {key[2:] for key in edit.changes if key[0] == ">"}
        is_law = any(key[0] not in "<>" for key in edit.changes)
        is_late = bool(shown) and shown.isdisjoint(VELOCITIES)
        is_usual = edit.rank == RANK_MODEL or not is_second
        if (part == "results") == is_late and is_usual and (name == NAMES[0] or not is_law):
            yield edit


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
    targets_of_base = {key for edit in base for key in edit.changes}
    for name in names:
        wanted = tuple(sample.theirs) if part == "velocities" else ()
        small, full = (Program(name, s.columns, base, wanted) for s in (screen, sample))
        edits = [*_models(name, part, bool(base))]
        for targets, group in groupby(sites(name, part), lambda site: site.targets):
            if targets_of_base.isdisjoint(targets):
                batch = [*group]
                parts = [site.values(small) for site in batch]
                values = {key: np.concatenate([p[key] for p in parts], -2) for key in targets}
                options = [(site, k) for site in batch for k in range(len(site.options))]
                counts = screen.fits(small.propagate(values), len(options)).sum(1)
                chosen = (options[place] for place in np.flatnonzero(counts >= need))
                edits += [site.edit(k) for site, k in chosen]
        plain = sample.fits(full.base)[0]  # what an edit that changes nothing gives
        for edit in edits:
            if targets_of_base.isdisjoint(edit.changes):
                rows = sample.fits(full.run({key: [t] for key, t in edit.changes.items()}))[0]
                if (rows != plain).any() and (rows & sample.wrong).sum() >= need:
                    candidates.append(Candidate(name, (*base, edit), rows))
    return _best_first(candidates, sample)


def _best_first(candidates: Iterable[Candidate], sample: Sample) -> list[Candidate]:
    """Return candidates sorted by the rows that they give, then by their likelihood."""
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
    return _best_first(conditional, sample)


def _distinct(candidates: Sequence[Candidate]) -> list[Candidate]:
    """Return the first of the candidates that give the same rows."""
    distinct: dict[bytes, Candidate] = {}
    for candidate in candidates:
        distinct.setdefault(candidate.rows.tobytes(), candidate)
    return list(distinct.values())


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
    candidates = (
        Candidate(name, (edit,), sample.given_by(name, (edit,)))
        for name in names
        for edit in fit_constants(sample, name, part)
    )
    constants = _best_first(candidates, sample)
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
