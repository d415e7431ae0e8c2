"""Which program gives another's numbers: every small mistake made, alone and two together.

All edits of all spellings are run over a few rows that disagree and a few that agree; those that
explain any are run over more, and those that explain most over the whole table. Two mistakes are
looked for in three ways: *by outputs* (the velocities first, then the rest), *by rows* (one
explains some rows alone, another on top of it the others) and *by equations* (`twofaults`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..equations.edits import Edit, equation_edits, statement_edits
from ..equations.evaluation import Run, chunks
from ..equations.otherprogram import Program, Reading, readings, variants
from ..equations.spelling import LISTING, spellings

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Columns = Mapping[str, Any]

BORNE_OUT = 0.9
"""The share of the rows, of those that disagree as of those that agree, that a cause must fit."""
KEPT = 60
"""Programs that are run over the larger sample."""
_FIRST_WRONG, _FIRST_RIGHT = 10, 5


class Judge:
    """How near results must come to another program's to be the same: for some rows.

    ``limit``: how far each result may be off, row by row; ``wrong``: the rows that disagree."""

    def __init__(self, scene: Columns, theirs: Columns, limit: Columns, wrong: Bools) -> None:
        self.scene, self.theirs, self.limit, self.wrong = scene, theirs, limit, wrong

    def part(self, rows: NDArray[np.intp]) -> Judge:
        """Some of the rows."""
        return Judge(
            {name: column[rows] for name, column in self.scene.items()},
            {name: column[rows] for name, column in self.theirs.items()},
            {name: column[rows] for name, column in self.limit.items()},
            self.wrong[rows],
        )

    def of(self, names: Sequence[str]) -> Judge:
        """By some of the results only."""
        theirs = {name: column for name, column in self.theirs.items() if name in names}
        return Judge(self.scene, theirs, self.limit, self.wrong)

    def near(self, results: Columns, below: Columns) -> Bools:
        """The rows whose every result is near enough: (K, n) or (n,)."""
        fits: Any = np.ones(self.wrong.size, bool)
        for name, theirs in self.theirs.items():
            mine = results[name] if name in results else below.get(name)
            if mine is not None:
                # what they do not give, NaN, contradicts nothing
                fits = fits & ((np.abs(mine - theirs) <= self.limit[name]) | np.isnan(theirs))
        return np.asarray(fits)

    def few(self, unexplained: Bools, wrong: int = _FIRST_WRONG) -> NDArray[np.intp]:
        """Some rows of those not explained yet, and some that agree."""
        right = np.flatnonzero(~self.wrong)
        return np.concatenate(
            [spread(np.flatnonzero(unexplained), wrong), spread(right, _FIRST_RIGHT)]
        )


def spread(places: NDArray[np.intp], count: int) -> NDArray[np.intp]:
    """At most ``count`` of some places, evenly."""
    if places.size <= count:
        return places
    return places[np.linspace(0, places.size - 1, count).astype(int)]


class Found(NamedTuple):
    """A program, the rows it fits, and how likely its mistake is (less is likelier)."""

    program: Program
    rows: Bools
    rank: int = 0

    def explains(self, wrong: Bools) -> int:
        """How many of the rows that disagree it explains."""
        return int((self.rows & wrong).sum())

    def stands(self, wrong: Bools) -> bool:
        """Whether the rows that agree bear it out."""
        right = ~wrong
        return bool((self.rows & right).sum() >= BORNE_OUT * right.sum())

    def whole(self, wrong: Bools) -> bool:
        """Whether it explains what there is to explain, and the rows that agree bear it out."""
        return self.stands(wrong) and self.explains(wrong) >= BORNE_OUT * wrong.sum() > 0


@cache
def edits_of(title: str) -> tuple[Edit, ...]:
    """The edits of a spelling as it stands; what all share is edited in the listing's alone."""
    spelling = spellings()[title]
    places = None if title == LISTING else range(spelling.own, spelling.results)
    return (*statement_edits(spelling, places), *equation_edits(spelling))


@np.errstate(all="ignore")
def singles(judge: Judge, unexplained: Bools, on: Program | None = None) -> list[Found]:
    """Programs with one mistake, or with one more than ``on``, that explain rows, best first."""
    small = judge.part(judge.few(unexplained))
    seen = [one for one in _tried(small, on or Program()) if (one.rows & small.wrong).any()]
    seen.sort(key=lambda one: (-int(one.rows.sum()), one.rank))
    return ranked([run(one.program, judge, one.rank) for one in seen[:KEPT]], judge.wrong)


def ranked(found: Sequence[Found], wrong: Bools) -> list[Found]:
    """Best first: those that agreeing rows bear out, then by rows explained, then by rank."""
    return sorted(
        found,
        key=lambda one: (
            -one.explains(wrong) * one.stands(wrong),
            -int((one.rows & ~wrong).sum()),
            one.rank,
        ),
    )


def run(program: Program, judge: Judge, rank: int = 0) -> Found:
    """A program over all rows of a judge."""
    return Found(program, judge.near(program.results(judge.scene), {}), rank)


def _tried(judge: Judge, base: Program) -> Iterator[Found]:
    """Programs with one mistake more than ``base``."""
    yield from _read(judge, base)
    titles = list(spellings())
    if base.edits:
        titles = [base.edits[0].spelling.title]
    else:
        for edit in variants():
            yield run(base._replace(edits=(edit,)), judge, 0)
    for order, title in enumerate(titles):
        spelling = base.spelling if base.edits else spellings()[title]
        edits = tuple(statement_edits(spelling)) if base.edits else edits_of(title)
        start = Run(spelling, base.read(judge.scene))
        for edit, rows in _all_edits(start, edits, judge, _shown(base, judge)):
            yield Found(base._replace(edits=(*base.edits, edit)), rows, 1000 * edit.rank + order)


def _read(judge: Judge, base: Program) -> Iterator[Found]:
    """Programs with one reading more than ``base``."""
    seen = base.read(judge.scene)
    start = Run(base.spelling, seen)
    others = [one for one in readings() if one not in base.readings]
    reading = [one for one in others if one.scene]
    names = start.followed({}, overlay(reading, seen)).names if reading else {}
    names = {
        name: np.broadcast_to(c, (len(reading), judge.wrong.size)) for name, c in names.items()
    }
    show = _shown(base, judge)
    near = judge.near(show(names, start.names), start.names)
    near = np.broadcast_to(near, (len(reading), judge.wrong.size)) if reading else near
    for place, one in enumerate(others):
        program, rank = base._replace(readings=(*base.readings, one)), 100 + place
        if not one.scene:
            shown = {**start.names, **show({}, start.names)}
            shown |= one.show(shown, {**start.names, **judge.scene})
            yield Found(program, judge.near(shown, {}), rank)
        elif one in reading and one.results:
            yield run(program, judge, rank)
        elif one in reading:
            yield Found(program, near[reading.index(one)], rank)


def overlay(several: Sequence[Reading], scene: Columns) -> dict[str, Any]:
    """The columns that readings change, a row a reading."""
    read = [one.read(scene) for one in several]
    names = {name for one in several for name in one.scene}
    return {
        name: np.stack([np.asarray(one.get(name, scene[name]), float) for one in read])
        for name in names
    }


def _shown(base: Program, judge: Judge) -> Callable[[Columns, Columns], Columns]:
    """What a program's readings make of results."""
    shows = [reading for reading in base.readings if reading.results]

    def show(results: Columns, below: Columns) -> Columns:
        if not shows:
            return results
        whole = {**below, **results}
        for reading in shows:
            whole |= reading.show(whole, {**whole, **judge.scene})
        return whole

    return show


def _all_edits(
    start: Run, edits: Sequence[Edit], judge: Judge, show: Callable[[Columns, Columns], Columns]
) -> Iterator[tuple[Edit, Bools]]:
    """Edits, and the rows they fit; of those that compute the same the likeliest only."""
    size = judge.wrong.size
    for changes, kept in every_edit(start, edits, size):
        names = start.followed(changes).names
        near = judge.near(show(names, start.names), start.names)
        yield from zip(kept, np.broadcast_to(near, (len(kept), size)), strict=True)


def every_edit(
    start: Run, edits: Sequence[Edit], size: int
) -> Iterator[tuple[Mapping[int, Any], Sequence[Edit]]]:
    """The changes for `Run.followed` that edits make, as many at once as are of one statement."""
    single: dict[int, list[Edit]] = {}
    for edit in edits:
        if len(edit.sides) == 1:
            single.setdefault(next(iter(edit.sides)), []).append(edit)
    for index, several in single.items():
        several.sort(key=lambda edit: edit.rank)
        values = start.edited(index, [edit.sides[index] for edit in several])
        apart = _distinct(values, start.own(index))
        kept = [several[place] for place in apart]
        values = values[:, apart] if values.ndim == 3 else values[apart]
        for part in chunks(len(kept), size):
            yield {index: values[:, part] if values.ndim == 3 else values[part]}, kept[part]
    for edit in edits:
        if len(edit.sides) > 1:
            yield start.several(edit.sides), [edit]


def _distinct(values: Any, own: Any) -> list[int]:
    """Which of the edits of a statement change it, each value once: (K, n) or (u, K, n)."""
    rows = np.moveaxis(values, 1, 0) if values.ndim == 3 else values
    known = {_ten_digits(own.reshape(1, -1))[0].tobytes()}
    apart = []
    for place, row in enumerate(_ten_digits(rows.reshape(len(rows), -1))):
        key = row.tobytes()
        if key not in known:
            known.add(key)
            apart.append(place)
    return apart


def _ten_digits(values: Any) -> NDArray[np.int64]:
    """Numbers that differ in other digits only are alike: the same in another order."""
    bits = (np.ascontiguousarray(values, dtype=np.float64) + 0.0).view(np.int64)
    return (bits + (1 << 18)) >> 19


# --- what follows from the velocities ------------------------------------------------------------


@np.errstate(all="ignore")
def outputs(judge: Judge, base: Program) -> Iterator[Program]:
    """Programs that give the velocities as ``base`` does and show something of the rest, or derive
    it, otherwise: one thing more, or one for each column that needs it."""
    program = base
    for name in judge.theirs:
        column = judge.of([name])
        if run(program, column).rows.mean() >= BORNE_OUT:
            continue
        found = [one for one in _outputs(column, program) if one.whole(~run(program, column).rows)]
        if not found:
            return
        # of equals, what sets most columns right at once
        program = max(
            (one.program for one in found[:_ALIKE]), key=lambda one: run(one, judge).rows.sum()
        )
    if program is not base:
        yield program


_ALIKE = 8
"""Programs alike in one column that are compared by the others."""


def _outputs(judge: Judge, base: Program) -> list[Found]:
    small = judge.part(judge.few(judge.wrong))
    found = []
    for place, reading in enumerate(readings()):
        if reading.results and not reading.scene and reading not in base.readings:
            program = base._replace(readings=(*base.readings, reading))
            found.append(run(program, small, 100 + place))
    spelling = base.spelling
    start = Run(spelling, base.read(small.scene))
    places = range(spelling.results, len(spelling.statements))
    edits = tuple(statement_edits(spelling, places))
    for edit, rows in _all_edits(start, edits, small, _shown(base, small)):
        found.append(Found(base._replace(edits=(*base.edits, edit)), rows, 1000 * edit.rank))
    found = [one for one in found if one.rows.mean() >= BORNE_OUT]
    found.sort(key=lambda one: one.rank)
    return [run(one.program, judge, one.rank) for one in found[:KEPT]]
