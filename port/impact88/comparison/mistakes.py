"""Find the mistakes behind the rows of a table that disagree."""

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .agreement import LOST_DIGITS, elimination_bounds
from .diagnosis import MIN_BITS, MIN_HELD_OUT, REQUIRED, Candidate, Sample, explain, information
from .evaluation import Floats
from .grading import Table
from .numbers import spread
from .rows import cut_digits, other_rows, single_precision
from .spellings import COLUMNS, VELOCITIES
from .types import Cause

MAX_SAMPLE = 80  # rows of each kind in a search, and as many kept out of it
MAX_CANDIDATES = 800  # rows of each kind from which those of a search are taken
STEADY = 0.1  # of the digits that may be lost: rows in which elimination keeps more are preferred
ROUNDINGS = 30.0  # bounds by which a mistake's numbers may be off
BLOCK = 20_000  # rows in which a cause is counted at a time
MAX_RESULT_CAUSES = 4
Places = NDArray[np.intp]


def columns_of(table: Table, rows: Places) -> dict[str, Floats]:
    """Return rows of the scene, and the row's number."""
    columns = {name: table.scene[name][rows] for name in COLUMNS}
    return {**columns, "row": (rows + 1).astype(np.float64)}


def find_causes(table: Table) -> tuple[Cause, ...]:
    """Return the mistakes behind the rows that disagree."""
    names = [name for name, misfit in table.misfit.items() if misfit.any()]
    if says := _mistake_of_table(table, names):
        total = int(table.wrong.sum())
        return (Cause(says, "", tuple(names), total, total),)
    return Diagnosis(table).causes()


def _mistake_of_table(table: Table, names: Sequence[str]) -> str:
    """Return what is wrong with a table whose program is right, "" if that is not so."""
    limits = {n: mistake_limit(table, n) for n in table.names}
    if says := other_rows(table.ours, table.theirs, limits, table.wrong):
        return says
    pairs = [(table.ours[n], table.theirs[n], table.units[n], table.misfit[n]) for n in names]
    if all(cut_digits(*pair) for pair in pairs):
        return "the last digit is cut, not rounded"
    bounds = table.reference.bounds
    if all(
        single_precision(*pair[:2], bounds[n], pair[2])
        for n, pair in zip(names, pairs, strict=True)
    ):
        return "results are computed or written in single precision (float32)"
    return ""


def mistake_limit(table: Table, name: str) -> Floats:
    """Return how far off the numbers of a program with a mistake may be."""
    size = np.fmax(table.reference.scales[name], np.abs(table.theirs[name]))
    rounding = np.fmax(ROUNDINGS * table.reference.bounds[name], LOST_DIGITS * size / 10)
    return table.units[name] / 2 + rounding + table.elimination[name]


class Diagnosis:
    """The search for the mistakes in a table."""

    def __init__(self, table: Table) -> None:
        self.table = table
        self.names = [n for n in table.names if n not in table.empty and n != "MUC"]

    @cached_property
    def limits(self) -> dict[str, Floats]:
        """Largest differences of the numbers of a program with a mistake."""
        return {name: mistake_limit(self.table, name) for name in self.names}

    def causes(self) -> tuple[Cause, ...]:
        """Return the mistake in the velocities, then those in results that follow from them."""
        velocities = [n for n in VELOCITIES if n in self.names]
        if len(velocities) < len(VELOCITIES):
            return self._cause_of_all()
        results = [n for n in self.names if n not in VELOCITIES]
        candidate = self._search(velocities, "velocities")
        if candidate is None:
            return self._causes_of_results(results)
        alike = [n for n in results if self._gives(candidate, n)]
        cause = self._cause(candidate, velocities, [*velocities, *alike])
        return (cause, *self._causes_of_results([n for n in results if n not in alike]))

    def _cause_of_all(self) -> tuple[Cause, ...]:
        """Return the mistake in a table without all velocities."""
        for part in ("velocities", "results"):
            candidate = self._search(self.names, part)
            if candidate is not None:
                return (self._cause(candidate, self.names, self.names),)
        return ()

    def _search(self, names: Sequence[str], part: str) -> Candidate | None:
        sample, held_out = self._samples(names)
        enough = information(sample) >= MIN_BITS
        return explain(sample, held_out, part) if enough else None

    def _causes_of_results(self, results: Sequence[str]) -> tuple[Cause, ...]:
        """Return the mistakes in results, which follow from the table's own velocities."""
        names = [n for n in results if self.table.misfit[n].any()]
        causes: list[Cause] = []
        while names and len(causes) < MAX_RESULT_CAUSES:
            sample, held_out = (self._following(s) for s in self._samples(names))
            names = [n for n in names if _disagreement(sample.only([n])).wrong.any()]
            groups = [names] * (len(names) > 1) + [[name] for name in names]
            candidate = None
            while groups and candidate is None:
                parts = [_disagreement(s.only(groups[0])) for s in (sample, held_out)]
                if information(parts[0]) >= MIN_BITS:
                    candidate = explain(parts[0], parts[1], "results")
                group = groups.pop(0)
            if candidate is None:
                break
            fitting = [n for n in names if candidate.gives(held_out.only([n])).mean() >= REQUIRED]
            causes.append(self._cause(candidate, fitting or group, fitting or group, follows=True))
            names = [n for n in names if n not in (fitting or group)]
        return tuple(causes)

    def _sample(self, rows: Places, names: Sequence[str]) -> Sample:
        """Return rows of the table with some of its results."""
        return Sample(
            columns_of(self.table, rows),
            {n: self.table.theirs[n][rows] for n in names},
            {n: self.limits[n][rows] for n in names},
            np.any([self.table.misfit[n][rows] for n in names], 0),
        )

    def _samples(self, names: Sequence[str]) -> tuple[Sample, Sample]:
        """Return the rows of a search, and those kept out of it."""
        wrong = np.any([self.table.misfit[n] for n in names], 0)
        kinds = []
        for kind in (wrong, self.table.agreeing & ~wrong):
            rows = spread(np.flatnonzero(kind), MAX_CANDIDATES)
            steady = self._steady_rows(rows, names)
            rows = steady if steady.size >= min(2 * MIN_HELD_OUT, rows.size) else rows
            kinds.append(spread(rows, 2 * MAX_SAMPLE))
        halves = [
            np.concatenate([k[start::2] if k.size >= 2 * MIN_HELD_OUT else k for k in kinds])
            for start in (0, 1)
        ]
        return self._sample(np.sort(halves[0]), names), self._sample(np.sort(halves[1]), names)

    def _steady_rows(self, rows: Places, names: Sequence[str]) -> Places:
        """Return the rows in which rounding is not magnified, whatever the method."""
        scene = {name: self.table.scene[name][rows] for name in COLUMNS}
        bounds = elimination_bounds(scene, [n for n in VELOCITIES if n in names] or list(names))
        scales = self.table.reference.scales
        loss = [bound / np.fmax(scales[n][rows], 1e-300) for n, bound in bounds.items()]
        steady = np.flatnonzero(~(np.max(loss, 0) > STEADY * LOST_DIGITS))
        return rows.take(steady)

    def _following(self, sample: Sample) -> Sample:
        """Return a sample whose results follow from the velocities that the table has."""
        rows = sample.columns["row"].astype(int) - 1
        velocities = {n: self.table.theirs[n][rows] for n in VELOCITIES}
        sample = sample._replace(columns={**sample.columns, **velocities})
        program = sample.program("impulses")
        moves = ({n: x + self.limits[n][rows]} for n, x in velocities.items())
        effects = program.effects(moves, sample.theirs)
        return sample._replace(limits={n: x + effects[n] for n, x in sample.limits.items()})

    def _gives(self, candidate: Candidate, name: str) -> bool:
        """Return whether a program that gives the velocities gives a result, too."""
        _, held_out = self._samples([*VELOCITIES, name])
        return bool(candidate.gives(held_out.only([name])).mean() >= REQUIRED)

    def _cause(
        self,
        candidate: Candidate,
        judged: Sequence[str],
        explained: Sequence[str],
        follows: bool = False,
    ) -> Cause:
        """Return a program as a cause, with the number of rows that it gives.

        ``judged``: the results that it must give; ``explained``: those that it is the cause of;
        ``follows``: it computes them from the table's velocities.
        """
        misfit = self.table.misfit
        wrong = np.flatnonzero(np.any([misfit[n] for n in judged], 0))
        count = 0
        for start in range(0, wrong.size, BLOCK):
            sample = self._sample(wrong[start : start + BLOCK], judged)
            sample = self._following(sample) if follows else sample
            count += int(candidate.gives(sample).sum())
        names = tuple(n for n in explained if misfit[n].any())
        where = str(candidate.condition or "")
        return Cause(candidate.text, where, names, count, wrong.size, candidate.alternatives)


def _disagreement(sample: Sample) -> Sample:
    """Return a sample with the rows as wrong in which results do not follow from velocities."""
    wrong = ~sample.fits(sample.program("impulses").base)[0]
    if wrong.mean() <= 1 - REQUIRED:
        wrong[:] = False
    return sample._replace(wrong=wrong)
