"""Which program gives the numbers of a table: every small mistake made, alone and two together.

All edits of all spellings are run over a few rows; those that explain any are run over more. Two
mistakes are looked for by equations (with their velocities put in, what two change of the residuals
adds up to what mends them) and by rows (one explains some alone, another on top of it the rest).
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..names import FINAL_VELOCITIES
from .agreement import Bools, Floats
from .equations.edits import CONVENTION, Edit, edits_of, edits_on, readings, variants
from .equations.evaluation import RESIDUAL, Columns, Run, chunks, value
from .equations.spelling import IMPULSES, LISTING, SHOWN, Spelling, expression, spellings

BORNE_OUT = 0.9
"""The share of the rows, of those that disagree as of those that agree, that a cause must fit."""
_KEPT = 60
"""Programs that are run over the larger sample: equivalents in nine spellings, and to spare."""
_FIRST_WRONG, _FIRST_RIGHT = 10, 5
"""Rows that all edits are run over: the time of the search grows with them."""
_FEW, _FIRSTS = 8, 4
"""Rows that disagree on which pairs are looked for, half as many for pairs of readings; mistakes on
top of which another is looked for."""
_SHARE = 0.1
"""The least share of the rows that disagree that the first of two mistakes explains alone, or that
a result is wrong in that is explained apart."""
_PRECISION = 1e-11
"""Of residuals, beside what the digits written allow: their terms round by some 1e-13."""


class Program(NamedTuple):
    """A spelling with edits, each made on top of those before it."""

    edits: tuple[Edit, ...] = ()

    @property
    def says(self) -> str:
        """What is wrong with it."""
        said = []
        for place, edit in enumerate(self.edits):
            later = {key for other in self.edits[place + 1 :] for key in other.sides}
            if edit.says or not later.issuperset(edit.sides):
                said.append(edit.text)
        return "; and ".join(sorted(said, key=lambda part: "should be" in part))

    @property
    def spelling(self) -> Spelling:
        """The spelling its edits are of, with them."""
        whole = spellings()[next((edit.title for edit in self.edits if edit.title), LISTING)]
        for edit in self.edits:
            whole = whole.edited(edit.sides)
        return whole

    def results(self, scene: Columns) -> dict[str, Any]:
        """All that the program shows for scenes (columns of n), by name."""
        names = Run(self.spelling, scene).names
        size = max(np.size(column) for column in scene.values())
        return {
            name.removeprefix(SHOWN): np.broadcast_to(column, (1, size))[0]
            for name, column in names.items()
            if name.startswith(SHOWN)
        }


class Judge(NamedTuple):
    """How near results must come to another program's to be the same: for some rows.

    ``limit``: how far each result may be off, row by row; ``wrong``: the rows that disagree."""

    scene: Columns
    theirs: Columns
    limit: Columns
    wrong: Bools

    def part(self, rows: NDArray[np.intp]) -> "Judge":
        """Some of the rows."""
        scene, theirs, limit = (
            {name: column[rows] for name, column in columns.items()} for columns in self[:3]
        )
        return Judge(scene, theirs, limit, self.wrong[rows])

    def of(self, names: Sequence[str]) -> "Judge":
        """By some of the results only."""
        theirs = {name: column for name, column in self.theirs.items() if name in names}
        return self._replace(theirs=theirs)

    def narrowed(self, names: Sequence[str]) -> "Judge":
        """By some of the results, of which some are wrong, in fewer rows perhaps."""
        part = self.of(names)
        return part._replace(wrong=~run(Program(), part).rows & self.wrong)

    def groups(self) -> list[list[str]]:
        """The final velocities, and each other result, of those that are wrong in many rows; all
        where none is."""
        every = list(self.theirs)
        ours, few = Program().results(self.scene), _SHARE * self.wrong.sum()
        rest = [[name] for name in every if name not in FINAL_VELOCITIES]
        parts = [[*FINAL_VELOCITIES], *rest] if self.has_velocities else []
        return [x for x in parts if (self.wrong & ~self.of(x).near(ours)).sum() >= few] or [every]

    def near(self, results: Columns, prefix: str = "") -> Bools:
        """The rows whose every result is near enough, (n,) or (K, n); NaN contradicts nothing."""
        fits: Any = np.ones(self.wrong.size, bool)
        for name, theirs in self.theirs.items():
            if (mine := results.get(prefix + name)) is not None:
                fits = fits & ((np.abs(mine - theirs) <= self.limit[name]) | np.isnan(theirs))
        return np.asarray(fits)

    def few(self, unexplained: Bools, wrong: int = _FIRST_WRONG) -> "Judge":
        """Some rows of those not explained yet, and some that agree."""
        right = spread(np.flatnonzero(~self.wrong), _FIRST_RIGHT)
        return self.part(np.concatenate([spread(np.flatnonzero(unexplained), wrong), right]))

    @property
    def has_velocities(self) -> bool:
        """Whether all final velocities are judged."""
        return self.theirs.keys() >= set(FINAL_VELOCITIES)


def spread(places: NDArray[np.intp], count: int) -> NDArray[np.intp]:
    """At most ``count`` of some places, evenly."""
    chosen = np.linspace(0, places.size - 1, min(count, places.size)).astype(int)
    return np.asarray(places[chosen])


class Found(NamedTuple):
    """A program, the rows it fits, and those that disagree."""

    program: Program
    rows: Bools
    wrong: Bools

    @property
    def rank(self) -> int:
        """How likely it is; less is likelier."""
        return sum(edit.rank for edit in self.program.edits)

    @property
    def explains(self) -> int:
        """How many of the rows that disagree it explains."""
        return int((self.rows & self.wrong).sum())

    @property
    def stands(self) -> bool:
        """Whether the rows that agree bear it out."""
        return bool((self.rows & ~self.wrong).sum() >= BORNE_OUT * (~self.wrong).sum())

    @property
    def whole(self) -> bool:
        """Whether it explains what there is to explain, and the rows that agree bear it out."""
        return self.stands and self.explains >= BORNE_OUT * self.wrong.sum() > 0


def run(program: Program, judge: Judge) -> Found:
    """A program over all rows of a judge."""
    return Found(program, judge.near(program.results(judge.scene)), judge.wrong)


def ranked(programs: Iterable[Program], judge: Judge) -> list[Found]:
    """Programs run over all rows, best first; of equals the likeliest."""
    found = [run(program, judge) for program in programs]
    found.sort(key=lambda x: (-x.explains * x.stands, -int((x.rows & ~x.wrong).sum()), x.rank))
    return found


def singles(judge: Judge, unexplained: Bools, on: Program | None = None) -> list[Found]:
    """Programs with one mistake, or with one more than ``on``, that explain rows, best first."""
    seen = list(_tried(judge.few(unexplained), on or Program()))
    seen.sort(key=lambda trial: (-int(trial.rows.sum()), trial.rank))
    return ranked((trial.program for trial in seen[:_KEPT]), judge)


def _tried(judge: Judge, base: Program) -> Iterator[Found]:
    """Programs with one mistake more than ``base`` that explain a row."""
    size = judge.wrong.size
    titled = [edit.title for edit in base.edits if edit.title]
    for title in titled[:1] or spellings():
        spelling = Program((*base.edits, Edit(title, {}))).spelling
        edits = [] if titled else [edit for edit in variants() if edit.title == title]
        if titled or title == LISTING:
            edits += [edit for edit in readings() if edit not in base.edits]
        edits += edits_on(spelling) if titled else edits_of(title)
        start = Run(spelling, judge.scene)
        found = start.distinct([spelling.composed(edit.sides) for edit in edits])
        for part in chunks(len(found), size):
            several = [changes for _, changes in found[part]]
            near = judge.near({**start.names, **start.edited(several)}, SHOWN)
            near = np.broadcast_to(near, (len(several), size))
            for k in np.flatnonzero((near & judge.wrong).any(1)):
                program = Program((*base.edits, edits[found[part][k][0]]))
                yield Found(program, near[k], judge.wrong)


def pairs(judge: Judge, alone: Sequence[Found]) -> Iterator[list[Program]]:
    """Programs with two mistakes, by stages. ``alone``: what explains rows alone."""
    yield list(_two_readings(judge.few(judge.wrong, _FEW // 2)))
    if judge.has_velocities:
        few = judge.of(FINAL_VELOCITIES).few(judge.wrong, _FEW)
        given = np.all([np.isfinite(column) for column in few.theirs.values()], axis=0)
        yield from _by_equations(few.part(np.flatnonzero(given)), judge)
    share = _SHARE * judge.wrong.sum()
    enough = [trial for trial in alone if trial.stands and trial.explains >= share]
    for trial in enough[:_FIRSTS]:
        unexplained = judge.wrong & ~trial.rows
        if unexplained.any():
            yield [more.program for more in singles(judge, unexplained, trial.program)[:2]]


def _two_readings(judge: Judge) -> Iterator[Program]:
    common = [edit for edit in readings() if edit.rank == CONVENTION]
    first = [edit for edit in common if not edit.shows]
    spelling = spellings()[IMPULSES]
    seen = dict(judge.scene) | Run(spelling, judge.scene).edited([edit.sides for edit in first])
    for other in common:
        near = judge.near(Run(spelling.edited(other.sides), seen).names, SHOWN)
        for place in np.flatnonzero(near.mean(-1) >= BORNE_OUT) if near.ndim > 1 else ():
            yield Program((first[place], other))


_IMPULSES = {
    "A": {"Px": "MA*(VAX - UX)", "Py": "MA*(VAY - UY)", "Pm": "ia*(WAF - WA) - D3*Px + D4*Py"},
    "B": {"Px": "-MB*(VBX - VX)", "Py": "-MB*(VBY - VY)", "Pm": "D1*Px - D2*Py - ib*(WBF - WB)"},
}
"""The impulses by what they change of A or of B."""
_ALONG = {
    **{"Pn": "c*Px + s*Py", "Pt": "c*Py - s*Px", "T": "Pm"},
    **{"VAN": "c*VAX + s*VAY", "VAT": "c*VAY - s*VAX"},
    **{"VBN": "c*VBX + s*VBY", "VBT": "c*VBY - s*VBX"},
}
_SUMS = 200
"""Partners of an edit that are looked at; more have coarse tables only."""


_Faults = tuple[Run, Callable[[Sequence[Mapping[str, Any]]], Floats]]
"""A run with their velocities put in, and what each of some edits leaves of its equations, by what
is allowed, (K, equations, rows)."""


def _faults(spelling: Spelling, judge: Judge, how: str) -> _Faults:
    """The equations of a spelling that their velocities violate, ``how``: with the impulses by what
    changes of A or of B."""
    names = Run(spelling, judge.scene).names

    def clamped(theirs: Columns) -> Run:
        seen = {**names, **theirs}
        made = {**_IMPULSES[how], **_ALONG}
        for name, text in made.items():
            seen[name] = value(expression(text), seen)
        return Run(spelling, judge.scene, {n: seen[n] for n in (*FINAL_VELOCITIES, *made)})

    start = clamped(judge.theirs)
    residuals = {key: x for key, x in start.names.items() if key.startswith(RESIDUAL)}
    limits: dict[str, Any] = dict.fromkeys(residuals, _PRECISION)
    for name in FINAL_VELOCITIES:
        moved = clamped({**judge.theirs, name: judge.theirs[name] + judge.limit[name]}).names
        for key, residual in residuals.items():
            limits[key] = limits[key] + np.abs(moved[key] - residual)

    def left(several: Sequence[Mapping[str, Any]]) -> Floats:
        found = {**start.names, **start.edited(several)}
        shape = (len(several), start.size)
        parts = [np.broadcast_to(found[key] / room, shape) for key, room in limits.items()]
        return np.stack(parts, 1)

    return start, left


def _by_equations(judge: Judge, whole: Judge) -> Iterator[list[Program]]:
    """Programs with two mistakes that together mend what their velocities violate; then a reading,
    and a mistake on top of it. ``judge``: a few rows, of which all have all final velocities;
    ``whole``: those that the second is to explain."""
    reading = [edit for edit in readings() if not edit.shows]
    for title, spelling in spellings().items():
        own = [*reading, *(edit for edit in variants() if edit.title == title), *edits_of(title)]
        impulses = {"Px", "Pn"} & {*spelling.where, *spelling.unknown}
        for how in "AB" if impulses else "A":
            yield _sums(_faults(spelling, judge, how), own)
    # how many residuals each reading leaves that rounding does not in nearly all rows
    _, left = _faults(spellings()[LISTING], judge, "A")
    held = np.abs(left([{}, *(edit.sides for edit in reading)])) <= 2
    violated = (held.mean(-1) < BORNE_OUT).sum(1)
    for place in np.argsort(violated[1:], kind="stable")[:_FIRSTS]:
        if violated[place + 1] < violated[0]:
            found = singles(whole, whole.wrong, Program((reading[place],)))
            yield [trial.program for trial in found[:2]]


def _sums(faults: _Faults, edits: Sequence[Edit]) -> list[Program]:
    """Programs with two edits, of which what each changes of the residuals adds up to what mends
    them: looked up among projections of the changes, sorted, by half of the rows at a time."""
    start, left = faults
    distinct = start.distinct([edit.sides for edit in edits])
    parts = [distinct[part] for part in chunks(len(distinct), start.size)]
    own = left([{}])
    changes = np.concatenate([own, *(left([made for _, made in part]) for part in parts)]) - own
    seen = np.isfinite(changes).all((1, 2)) & (np.abs(changes) > 8).any((1, 2))
    changes, made = changes[seen], [edits[distinct[k - 1][0]] for k in np.flatnonzero(seen)]
    found = set()
    rng = np.random.default_rng(88)
    for half in (slice(0, None, 2), slice(1, None, 2)):
        weights = rng.uniform(-1.0, 1.0, own[0, :, half].shape)
        sums = np.einsum("kij,ij", changes[:, :, half], weights)
        missing = -(own[0, :, half] * weights).sum() - sums
        room = 2 * np.abs(weights).sum() + _PRECISION * np.abs(sums)
        order = np.argsort(sums)
        first, last = (np.searchsorted(sums[order], missing + x) for x in (-room, room))
        for i in np.flatnonzero(last > first):
            others = order[first[i] : min(last[i], first[i] + _SUMS)]
            mended = (np.abs(own + changes[i] + changes[others]) <= 2).all(1)
            found |= {(int(i), int(j)) for j in others[mended.mean(1) >= BORNE_OUT] if i < j}
    programs = [Program((made[i], made[j])) for i, j in sorted(found)]
    return sorted(programs, key=lambda pair: pair.edits[0].rank + pair.edits[1].rank)[:_FIRSTS]
