"""Compare another program's results with the reference, and name the mistake."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..errors import UserError
from .agreement import (
    COMPARED,
    LOST_DIGITS,
    Bools,
    elimination_bounds,
    reference,
)
from .conditions import find_condition, quantities_of
from .diagnosis import (
    MIN_BITS,
    MIN_HELD_OUT,
    REQUIRED,
    Candidate,
    Sample,
    explain,
    information,
)
from .evaluation import Floats, Program
from .kit import Answers, check_kit
from .numbers import numbers, units
from .reading import read_table, scene_columns
from .rows import cut_digits, other_rows, single_precision
from .spellings import COLUMNS, VELOCITIES
from .types import Cause, Comparison, Disagreement

MAX_SAMPLE = 80  # rows of each kind in a search, and as many kept out of it
MAX_ROWS_LISTED = 1000
ROUNDINGS = 30.0  # bounds by which a mistake's numbers may be off
MAX_CANDIDATES = 800  # rows of each kind from which those of a search are taken
STEADY = (
    0.1  # of the digits that may be lost: a row in which elimination keeps more tells of a mistake
)
MAX_RESULT_CAUSES = 4


class _Table:
    """Another program's results beside the reference."""

    def __init__(
        self, scene: Mapping[str, Floats], columns: Mapping[str, Any], factors: Mapping[str, float]
    ) -> None:
        self.scene = scene
        self.names = [name for name in COMPARED if name in columns]
        self.texts = columns
        scales = {name: factors.get(name, 1.0) for name in self.names}
        self.theirs = {name: numbers(columns[name]) * k for name, k in scales.items()}
        self.units = units({name: columns[name] for name in self.names})
        self.units = {name: unit * abs(scales[name]) for name, unit in self.units.items()}
        self.size = len(scene["UX"])
        self.empty = [n for n in self.names if not np.isfinite(self.theirs[n]).any()]
        self.reference = reference(scene, self.names)
        self.ours = dict(self.reference.values)
        self._grade()

    def limit(self, name: str) -> Floats:
        """Return how far off a correct result may be."""
        return self.reference.bounds[name] + self.units[name] / 2

    def _off(self, values: Mapping[str, Floats]) -> dict[str, Bools]:
        return {n: np.abs(self.theirs[n] - values[n]) > self.limit(n) for n in self.names}

    def _grade(self) -> None:
        """Find the results that disagree, those that lose digits, and those that are missing."""
        ref = self.reference
        if ref.ties.any():
            either = ~np.any(list(self._off(ref.alternatives).values()), 0) & ref.ties
            for name in self.names:
                self.ours[name] = np.where(either, ref.alternatives[name], self.ours[name])
        off = self._off(self.ours)
        near = {
            n: np.abs(self.theirs[n] - self.ours[n])
            <= LOST_DIGITS * ref.scales[n] + self.units[n] / 2
            for n in self.names
        }
        self.lost = np.any([off[n] & near[n] for n in self.names], 0)
        self.misfit = {n: off[n] & ~near[n] for n in self.names}
        self._excuse_elimination()
        self.wrong: Bools = np.any(list(self.misfit.values()), 0)
        answered = {n: np.isfinite(self.theirs[n]) for n in self.names}
        has_answer = {n: np.isfinite(self.ours[n]) for n in self.names}
        self.missing = np.any([~answered[n] & has_answer[n] for n in self.names], 0)
        self.missing &= ~ref.optional
        self.surplus = np.any([answered[n] & ~has_answer[n] for n in self.names], 0)
        self.compared = np.any([answered[n] & has_answer[n] for n in self.names], 0)
        self.agreeing = self.compared & ~self.wrong & ~self.missing

    def _excuse_elimination(self) -> None:
        """Take differences that elimination may cause for digits lost."""
        self.elimination = {name: np.zeros(self.size) for name in self.names}
        doubtful = np.flatnonzero(np.any(list(self.misfit.values()), 0))
        if not doubtful.size:
            return
        scene = {name: column[doubtful] for name, column in self.scene.items()}
        bounds = elimination_bounds(scene, self.names)
        excused = np.ones(doubtful.size, bool)
        for name in self.names:
            self.elimination[name][doubtful] = np.nan_to_num(bounds[name])
            off = np.abs(self.theirs[name] - self.ours[name])[doubtful]
            allowed = bounds[name] + self.limit(name)[doubtful]
            excused &= ~self.misfit[name][doubtful] | (off <= allowed)
        for name in self.names:
            self.misfit[name][doubtful[excused]] = False
        self.lost[doubtful[excused]] = True

    def relative(self, name: str) -> Floats:
        """Return differences relative to the largest quantity of the kind, theirs included."""
        size = np.fmax(self.reference.scales[name], np.abs(self.theirs[name]))
        off: Floats = np.abs(self.theirs[name] - self.ours[name]) / size
        return np.where(self.misfit[name], off, 0.0)


@np.errstate(all="ignore")
def compare(
    table: Any,
    *,
    kit: str | None = None,
    values: Mapping[str, Any] | None = None,
    factors: Mapping[str, float] | None = None,
    causes: bool = True,
) -> Comparison:
    """Compare another program's results with the reference, and name the mistake.

    Parameters
    ----------
    table : path, mapping of columns, data frame or sequence of mappings
        The scenes and the results, by `impact88.names`; a file ends in ``.csv`` or ``.jsonl``.
        Texts are judged by the digits that they are written with.
    kit : str, optional
        The id or folder of a kit of test vectors that the table answers. The scenes are the kit's,
        and every vector must be answered.
    values : mapping of str to float, optional
        Values of columns of the scene that the table lacks.
    factors : mapping of str to float, optional
        What converts a column to consistent units (length, mass, time): ``{"VAX": 22 / 15}``.
    causes : bool, default True
        Look for the mistakes where rows disagree.

    Returns
    -------
    Comparison
        The verdict, how results disagree, and the mistakes that explain it.

    Raises
    ------
    UserError
        For a table that cannot be used.

    Notes
    -----
    A number agrees within the rounding of a careful program or half its last digit (`agreement`).
    A mistake is an edit of the equations that gives the rows kept out of the search (`diagnosis`).

    Examples
    --------
    >>> scene = impact88.sample(1).numbers()
    >>> comparison = impact88.compare([{**scene, "VAX": -13.2627}], causes=False)
    >>> comparison.passed, comparison.differing
    (True, 0)
    """
    columns = read_table(table)
    factors = factors or {}
    if kit is not None:
        check_kit(kit)
        answers = Answers(columns)
        comparison, wrong = compare_columns(answers.scene, answers.results, factors, causes)
        verdict = answers.verdict(wrong)
        passed = not (verdict["failed"] or verdict["stray"])
        return replace(comparison, passed=passed, kit=verdict)
    scene = scene_columns(columns, values or {})
    scene = {name: column * factors.get(name, 1.0) for name, column in scene.items()}
    if not any(name in columns for name in COMPARED):
        raise UserError(f"no results to compare; expected some of {' '.join(COMPARED)}")
    return compare_columns(scene, columns, factors, causes)[0]


def compare_columns(
    scene: Mapping[str, Floats],
    columns: Mapping[str, Any],
    factors: Mapping[str, float],
    causes: bool = True,
) -> tuple[Comparison, Bools]:
    """Return the comparison of columns of results with their scenes, and the rows that disagree."""
    table = _Table(scene, columns, factors)
    places = np.flatnonzero(table.wrong)
    complete = table.agreeing.any() and not (places.size or table.missing.any() or table.empty)
    comparison = Comparison(
        passed=bool(complete),
        rows=table.size,
        agreeing=int(table.agreeing.sum()),
        differing=int(places.size),
        notes=_notes(table),
        differing_rows=tuple((places[:MAX_ROWS_LISTED] + 1).tolist()),
    )
    if not places.size:
        return comparison, table.wrong
    found = _causes(table) if causes else ()
    disagreements = _disagreements(table, bool(found))
    return replace(comparison, causes=found, disagreements=disagreements), table.wrong


def _notes(table: _Table) -> tuple[str, ...]:
    """Return what was not compared, and digits that are lost."""
    notes = [f"{name} is empty in every row" for name in table.empty]
    missing = table.missing
    for count, says in (
        (
            int((table.lost & ~table.wrong).sum()),
            "agree to at least 10 digits, but not to double precision",
        ),
        (int(missing.sum()), "lack a result where there is one"),
        (int(table.surplus.sum()), "have a number where the equations have no answer"),
    ):
        if count and not (table.empty and says.startswith("lack")):
            notes.append(f"{count} row{'s' * (count != 1)} {says}")
    return tuple(notes)


def _disagreements(table: _Table, explained: bool) -> tuple[Disagreement, ...]:
    """Return how each result disagrees; under which condition, where no cause explains it."""
    rows = np.concatenate(
        [_spread(np.flatnonzero(x), 4 * MAX_SAMPLE) for x in (table.wrong, table.agreeing)]
    )
    quantities = {} if explained else quantities_of(_columns(table, rows))
    disagreements = []
    for name, misfit in table.misfit.items():
        if not misfit.any():
            continue
        relative = table.relative(name)
        worst = int(relative.argmax())
        where = None
        if quantities:
            where = find_condition(quantities, misfit[rows], ~table.wrong[rows])
        compared = np.isfinite(table.theirs[name]) & np.isfinite(table.ours[name])
        disagreements.append(
            Disagreement(
                name,
                int(misfit.sum()),
                int(compared.sum()),
                worst + 1,
                str(table.texts[name][worst]).strip(),
                float(table.ours[name][worst]),
                float(relative[worst]),
                str(where) if where else "",
            )
        )
    return tuple(disagreements)


def _spread(places: Any, count: int) -> Any:
    """Return at most so many places, evenly spread."""
    return places[np.linspace(0, places.size - 1, min(count, places.size)).astype(int)]


def _columns(table: _Table, rows: Any) -> dict[str, Floats]:
    """Return rows of the scene with those of the rows before and after, and the row's number."""
    columns = {name: table.scene[name][rows] for name in COLUMNS}
    for name in COLUMNS:
        columns[f"{name}_before"] = table.scene[name][rows - 1]
        columns[f"{name}_after"] = table.scene[name][(rows + 1) % table.size]
    columns["row"] = rows + 1.0
    return columns


def _causes(table: _Table) -> tuple[Cause, ...]:
    """Return the mistakes behind the rows that disagree."""
    wrong_names = [name for name, misfit in table.misfit.items() if misfit.any()]
    total = int(table.wrong.sum())
    limits = {n: _wide_limit(table, n) for n in table.names}
    if says := other_rows(table.ours, table.theirs, limits, table.wrong):
        return (Cause(says, "", tuple(wrong_names), total, total),)
    if all(
        cut_digits(table.ours[n], table.theirs[n], table.units[n], table.misfit[n])
        for n in wrong_names
    ):
        says = "the last digit is cut, not rounded"
        return (Cause(says, "", tuple(wrong_names), total, total),)
    if all(single_precision(table.ours[n], table.theirs[n]) for n in wrong_names):
        says = "results are computed or written in single precision (float32)"
        return (Cause(says, "", tuple(wrong_names), total, total),)
    return _mistakes(table, limits)


def _wide_limit(table: _Table, name: str) -> Floats:
    """Return how far off the numbers of a program with a mistake may be."""
    size = np.fmax(table.reference.scales[name], np.abs(table.theirs[name]))
    rounding = np.fmax(ROUNDINGS * table.reference.bounds[name], LOST_DIGITS * size / 10)
    rounding += table.elimination[name]
    return table.units[name] / 2 + rounding


def _samples(
    table: _Table, limits: Mapping[str, Floats], names: Sequence[str]
) -> tuple[Sample, Sample]:
    """Return the rows of a search, and those kept out of it, where rounding is not magnified."""
    wrong = np.any([table.misfit[n] for n in names], 0)
    kinds = []
    for kind in (wrong, table.agreeing & ~wrong):
        rows = _spread(np.flatnonzero(kind), MAX_CANDIDATES)
        steady = rows[_is_steady(table, rows, names)]
        rows = steady if steady.size >= min(2 * MIN_HELD_OUT, rows.size) else rows
        kinds.append(_spread(rows, 2 * MAX_SAMPLE))
    parts = []
    for offset in (0, 1):
        rows = [kind[offset::2] if kind.size >= 2 * MIN_HELD_OUT else kind for kind in kinds]
        places = np.sort(np.concatenate(rows))
        parts.append(
            Sample(
                _columns(table, places),
                {n: table.theirs[n][places] for n in names},
                {n: limits[n][places] for n in names},
                wrong[places],
            )
        )
    return parts[0], parts[1]


def _is_steady(table: _Table, rows: Any, names: Sequence[str]) -> Bools:
    """Return whether rounding is not magnified in rows, whatever the method."""
    scene = {name: table.scene[name][rows] for name in COLUMNS}
    judged = [n for n in VELOCITIES if n in names] or list(names)
    bounds = elimination_bounds(scene, judged)
    sizes = [bounds[n] / np.fmax(table.reference.scales[n][rows], 1e-300) for n in judged]
    steady: Bools = ~(np.max(sizes, 0) > STEADY * LOST_DIGITS)
    return steady


def _mistakes(table: _Table, limits: Mapping[str, Floats]) -> tuple[Cause, ...]:
    """Return the mistake in the velocities, then those in the results that follow from them."""
    usable = [n for n in table.names if n not in table.empty]
    velocities = [n for n in VELOCITIES if n in usable]
    results = [n for n in usable if n not in VELOCITIES]
    if len(velocities) < len(VELOCITIES):
        return _mistakes_together(table, limits, usable)
    causes = []
    candidate = None
    if any(table.misfit[n].any() for n in velocities):
        sample, held_out = _samples(table, limits, velocities)
        if _has_information(sample):
            candidate = explain(sample, held_out)
    if candidate is not None:
        explained = [n for n in results if _is_given(candidate, table, limits, n)]
        results = [n for n in results if n not in explained]
        names = [n for n in (*velocities, *explained) if table.misfit[n].any()]
        causes.append(_as_cause(candidate, table, limits, velocities, names))
    return (*causes, *_result_mistakes(table, limits, results))


def _has_information(sample: Sample) -> bool:
    ours = Program("impulses", sample.columns).base
    return information(sample, ours) >= MIN_BITS


def _mistakes_together(
    table: _Table, limits: Mapping[str, Floats], names: list[str]
) -> tuple[Cause, ...]:
    """Return the mistake in a table without all velocities."""
    sample, held_out = _samples(table, limits, names)
    if not _has_information(sample):
        return ()
    for part in ("velocities", "results"):
        candidate = explain(sample, held_out, part)
        if candidate is not None:
            wrong = [n for n in names if table.misfit[n].any()]
            return (_as_cause(candidate, table, limits, names, wrong),)
    return ()


def _is_given(candidate: Candidate, table: _Table, limits: Mapping[str, Floats], name: str) -> bool:
    """Return whether a program gives a result, too."""
    _, sample = _samples(table, limits, [*VELOCITIES, name])
    return bool(candidate.gives(sample.only([name])).mean() >= REQUIRED)


def _as_cause(
    candidate: Candidate,
    table: _Table,
    limits: Mapping[str, Floats],
    judged: Sequence[str],
    names: Sequence[str],
    velocities: bool = False,
) -> Cause:
    """Return a candidate as a cause, with the rows of the table that it explains."""
    wrong = np.flatnonzero(np.any([table.misfit[n] for n in judged], 0))
    explained = 0
    for start in range(0, wrong.size, 20_000):
        rows = wrong[start : start + 20_000]
        sample = Sample(
            _columns(table, rows),
            {n: table.theirs[n][rows] for n in judged},
            {n: limits[n][rows] for n in judged},
            np.ones(rows.size, bool),
        )
        if velocities:
            sample = _from_velocities(sample, table, rows)
        explained += int(candidate.gives(sample).sum())
    where = str(candidate.condition or "")
    return Cause(candidate.text, where, tuple(names), explained, wrong.size, candidate.alternatives)


def _from_velocities(sample: Sample, table: _Table, rows: Any) -> Sample:
    """Return a sample whose results follow from the velocities that the table has."""
    theirs = {n: table.theirs[n][rows] for n in VELOCITIES}
    program = Program("impulses", sample.columns, (), theirs)
    limits = dict(sample.limits)
    for name in VELOCITIES:
        moved = program.propagate({name: theirs[name] + _wide_limit(table, name)[rows]})
        for result in sample.theirs:
            limits[result] = limits[result] + np.abs(moved[result] - program.base[result])
    return sample._replace(columns={**sample.columns, **theirs}, limits=limits)


def _result_mistakes(
    table: _Table, limits: Mapping[str, Floats], results: Sequence[str]
) -> tuple[Cause, ...]:
    """Return the mistakes in results, computed from the table's own velocities."""
    results = [n for n in results if table.misfit[n].any() and n != "MUC"]
    causes: list[Cause] = []
    while results and len(causes) < MAX_RESULT_CAUSES:
        samples = [
            _from_velocities(sample, table, sample.columns["row"].astype(int) - 1)
            for sample in _samples(table, limits, results)
        ]
        samples = [_marked(sample) for sample in samples]
        results = [n for n in results if _disagrees(samples[0].only([n]))]
        groups = [results] * (len(results) > 1) + [[name] for name in results]
        for group in groups:
            sample, held_out = (_marked(s.only(group)) for s in samples)
            candidate = explain(sample, held_out, "results") if sample.wrong.any() else None
            if candidate is not None:
                fixed = [
                    n for n in results if candidate.gives(samples[1].only([n])).mean() >= REQUIRED
                ]
                fixed = fixed or list(group)
                causes.append(_as_cause(candidate, table, limits, fixed, fixed, velocities=True))
                results = [n for n in results if n not in fixed]
                break
        else:
            break
    return tuple(causes)


def _plain(sample: Sample) -> dict[str, Any]:
    """Return what the reference computes from a sample's own velocities."""
    return sample.program("impulses").base


def _marked(sample: Sample) -> Sample:
    """Return a sample with the rows as wrong in which the results do not follow."""
    return sample._replace(wrong=~sample.fits(_plain(sample))[0])


def _disagrees(sample: Sample) -> bool:
    return bool((~sample.fits(_plain(sample))).mean() > 1 - REQUIRED)
