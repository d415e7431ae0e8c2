"""Find the mistakes behind the rows of a table that disagree."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .agreement import LOST_DIGITS
from .diagnosis import MIN_HELD_OUT, REQUIRED, Candidate, Sample, explain
from .evaluation import Floats, Program
from .grading import Table
from .mutants import describe_names
from .numbers import spread
from .rows import mistake_of_table
from .spellings import COLUMNS, VELOCITIES
from .types import MAX_ROWS_LISTED, Cause

MAX_SAMPLE = 80  # rows of each kind in a search, and as many kept out of it
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
    diagnosis = Diagnosis(table)
    if says := mistake_of_table(table, diagnosis.limits):
        total = int(table.wrong.sum())
        return (Cause(says, "", tuple(table.disagreeing), total, total),)
    return diagnosis.causes()


def mistake_limit(table: Table, name: str) -> Floats:
    """Return how far off the numbers of a program with a mistake may be."""
    scale = table.reference.scales[name]
    growth = np.fmax(np.abs(table.theirs[name]) / scale, 1)
    if name in VELOCITIES:  # near a singularity their errors grow alike
        growth **= 2
    lost = LOST_DIGITS / 10 * scale * growth
    rounding: Floats = np.fmax(ROUNDINGS * table.reference.bounds[name], lost)
    return rounding + table.units[name] / 2 + table.elimination[name]


class Diagnosis:
    """The search for the mistakes in a table.

    Attributes
    ----------
    names : list of str
        The results that tell a mistake.
    limits : dict of str to ndarray
        Largest differences of the numbers of a program with a mistake.
    velocities : list of str
        The final velocities, from which other results follow; none where one is missing.
    """

    def __init__(self, table: Table) -> None:
        self.table = table
        self.names = [n for n in table.names if n not in table.empty and n != "MUC"]
        self.limits = {name: mistake_limit(table, name) for name in table.names}
        self.velocities = [*VELOCITIES] if {*VELOCITIES} <= {*self.names} else []

    def causes(self) -> tuple[Cause, ...]:
        """Return the mistake in the velocities, then those in results that follow from them."""
        judged = self.velocities or self.names
        sample, held_out = self._samples(judged)
        candidate = explain(sample, held_out, "velocities")
        results = [n for n in self.names if n not in self.velocities]
        if candidate is None:
            return self._causes_of_results(results)
        given = [*judged]
        for name in results:
            _, held_out = self._samples([*judged, name])
            given += self._given(candidate, held_out, [name])
        others = self._causes_of_results([n for n in self.names if n not in given])
        return (self._cause(candidate, judged, given), *others)

    def _causes_of_results(self, names: Sequence[str]) -> tuple[Cause, ...]:
        """Return the mistakes in results, which follow from the table's own velocities."""
        causes: list[Cause] = []
        right: list[str] = []  # they follow from the velocities, with a mistake's edit, too
        while names and len(causes) < MAX_RESULT_CAUSES:
            samples = self._samples([*names, *right])
            right += [n for n in names if not _disagreement(samples[0].only([n])).wrong.any()]
            names = [n for n in names if n not in right]
            for group in [names, *([name] for name in names)]:
                parts = [_disagreement(sample.only([*group, *right])) for sample in samples]
                candidate = explain(parts[0], parts[1], "results")
                if candidate is not None:
                    break
            else:
                break
            given = self._given(candidate, samples[1], names)
            causes.append(self._cause(candidate, given, given))
            names = [n for n in names if n not in given]
        return tuple(causes)

    def _samples(self, names: Sequence[str]) -> list[Sample]:
        """Return the rows of a search, and those kept out of it."""
        wrong = self.table.differing(names)
        steady = self.table.agreeing & ~self.table.lost
        kinds = [spread(np.flatnonzero(kind), 2 * MAX_SAMPLE) for kind in (wrong, steady)]
        return [
            self._sample(
                np.concatenate([k[start::2] if k.size >= 2 * MIN_HELD_OUT else k for k in kinds]),
                names,
            )
            for start in (0, 1)
        ]

    def _sample(self, rows: Places, names: Sequence[str]) -> Sample:
        """Return rows of the table with some of its results.

        Results without velocities follow from those that the table has, with all their digits
        where the velocities agree.
        """
        limits = {n: self.limits[n][rows] for n in names}
        velocities: dict[str, Floats] = {}
        columns = columns_of(self.table, rows)
        if {*VELOCITIES}.isdisjoint(names):
            table = self.table
            wrong = table.differing(self.velocities)[rows]
            for n in self.velocities:
                velocities[n] = np.where(wrong, table.theirs[n][rows], table.ours[n][rows])
            program = Program("impulses", {**columns, **velocities}, wanted=names)
            moves = ({n: x + wrong * self.limits[n][rows]} for n, x in velocities.items())
            effects = program.effects(moves, names)
            limits = {name: limit + effects[name] for name, limit in limits.items()}
        return Sample(
            {**columns, **velocities},
            {n: self.table.theirs[n][rows] for n in names},
            limits,
            self.table.differing(names)[rows],
        )

    def _given(self, candidate: Candidate, held_out: Sample, names: Sequence[str]) -> list[str]:
        """Return the results that a program gives."""
        return [n for n in names if candidate.gives(held_out.only([n])).mean() >= REQUIRED]

    def _cause(
        self, candidate: Candidate, judged: Sequence[str], explained: Sequence[str]
    ) -> Cause:
        """Return a program as a cause, with the number of rows that it gives.

        ``judged``: the results that it must give; ``explained``: those that it is the cause of.
        """
        wrong = np.flatnonzero(self.table.differing(judged))
        rest: list[int] = []
        for start in range(0, wrong.size, BLOCK):
            rows = wrong[start : start + BLOCK]
            rest += (rows[~candidate.gives(self._sample(rows, judged))] + 1).tolist()
        names = tuple(n for n in self.table.disagreeing if n in explained)
        where = str(candidate.condition or "")
        return Cause(
            candidate.text,
            where,
            names,
            wrong.size - len(rest),
            wrong.size,
            candidate.alternatives,
            describe_names(candidate.edits[0], candidate.name),
            tuple(rest[:MAX_ROWS_LISTED]),
        )


def _disagreement(sample: Sample) -> Sample:
    """Return a sample with the rows as wrong in which results do not follow from velocities."""
    wrong = ~sample.given_by("impulses")
    if wrong.mean() <= 1 - REQUIRED:
        wrong[:] = False
    return sample._replace(wrong=wrong)
