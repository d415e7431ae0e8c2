"""Two mistakes in one program, told apart: *by equations*, their velocities put into every edited
one, so that no elimination mixes the faults; and readings of the scene two together, or one with an
edit of the equations."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, product
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..equations.edits import Edit
from ..equations.evaluation import Run
from ..equations.otherprogram import Program, readings
from ..equations.spelling import LISTING, Spelling, spellings
from ..names import FINAL_VELOCITIES
from .trials import BORNE_OUT, Judge, edits_of, every_edit, overlay

Bools = NDArray[np.bool_]
Columns = Mapping[str, Any]

_EACH = 3
"""Edits of those that mend the same equations that are tried together with others."""
_READINGS = 4
"""Readings under which edits of the equations are looked for: those that leave fewest violated."""


class _Fault(NamedTuple):
    """An edit, and the equations that hold with it, which did not."""

    edit: Edit
    mends: frozenset[int]


@np.errstate(all="ignore")
def pairs(judge: Judge) -> Iterator[Program]:
    """Programs with two mistakes in different equations. ``judge``: a few rows, of which all have
    all final velocities."""
    for title in spellings():
        for violated, faults in _faults(title, judge, judge.scene):
            by_mended: dict[frozenset[int], list[Edit]] = {}
            for fault in sorted(faults, key=lambda one: one.edit.rank):
                by_mended.setdefault(fault.mends, []).append(fault.edit)
            for one, other in combinations(by_mended, 2):
                if one | other == violated:
                    both = product(by_mended[one][:_EACH], by_mended[other][:_EACH])
                    for edits in both:
                        yield Program(edits)


@np.errstate(all="ignore")
def read_and_edited(judge: Judge) -> Iterator[Program]:
    """Programs with a reading and an edit."""
    spelling = spellings()[LISTING]
    start, limits = _start(spelling, judge, judge.scene, "AA")
    several = [one for one in readings() if one.scene and not one.results]
    found = start.followed({}, overlay(several, judge.scene)).residuals
    count = np.zeros(len(several))
    for index, residual in start.residuals.items():
        good = np.abs(found.get(index, residual)) <= 10 * limits[index]
        count += np.mean(np.broadcast_to(good, (len(several), judge.wrong.size)), 1) < BORNE_OUT
    before = sum(not _mostly(np.abs(r) <= limits[i]) for i, r in start.residuals.items())
    for place in np.argsort(count, kind="stable")[:_READINGS]:
        if count[place] >= before:
            break
        scene = Program((), (several[place],)).read(judge.scene)
        for title in spellings():
            for violated, faults in _faults(title, judge, scene):
                whole = [fault.edit for fault in faults if fault.mends == violated]
                for edit in sorted(whole, key=lambda one: one.rank)[:_EACH]:
                    yield Program((edit,), (several[place],))


@np.errstate(all="ignore")
def two_readings(judge: Judge) -> Iterator[Program]:
    """Programs with two of the commoner readings. ``judge``: very few rows."""
    start = Run(spellings()[LISTING], judge.scene)
    common = [one for one in readings() if one.common]
    changing = [one for one in common if one.scene]
    shows = [one for one in common if one.results and not one.scene]
    for place, first in enumerate(changing):
        seen = first.read(judge.scene)
        second = changing[place + 1 :]
        if second:
            changed = {**seen, **overlay(second, {**judge.scene, **seen})}
            names = start.followed({}, changed).names
            names |= first.show(names, {**start.names, **names, **judge.scene})
            near = np.atleast_2d(judge.near(names, start.names))
            for other in np.flatnonzero(near.mean(1) >= BORNE_OUT):
                yield Program((), (first, second[other]))
        alone = Program((), (first,)).results(judge.scene)
        for show in shows:
            shown = {**alone, **show.show(alone, {**alone, **judge.scene})}
            if _mostly(judge.near(shown, {})):
                yield Program((), (first, show))


def _faults(
    title: str, judge: Judge, scene: Columns
) -> Iterator[tuple[frozenset[int], list[_Fault]]]:
    """For each way to take the impulses from their velocities: the equations of a spelling that
    these violate, and the edits that mend some and break none."""
    spelling = spellings()[title]
    for how in product("AB", "AB") if title not in _WITHOUT_IMPULSES else ["AA"]:
        start, limits = _start(spelling, judge, scene, how)
        holds = {i: np.abs(found) <= limits[i] for i, found in start.residuals.items()}
        violated = frozenset(i for i, good in holds.items() if not _mostly(good))
        faults: list[_Fault] = []
        if violated:
            edits = [e for e in edits_of(title) if min(e.sides) < spelling.results]
            for changes, kept in every_edit(start, edits, judge.wrong.size):
                faults += _mending(start, changes, kept, limits, violated)
        yield violated, faults


def _start(
    spelling: Spelling, judge: Judge, scene: Columns, how: Sequence[str]
) -> tuple[Run, dict[int, Any]]:
    """A spelling with their velocities put in, and how far from 0 its residuals may be."""
    names = Run(spelling, scene).names
    start = Run(spelling, scene, _clamps(names, judge.theirs, how))
    limits: dict[int, Any] = dict.fromkeys(start.residuals, 1e-11)
    for name in FINAL_VELOCITIES:
        moved = {**judge.theirs, name: judge.theirs[name] + judge.limit[name]}
        for index, found in Run(spelling, scene, _clamps(names, moved, how)).residuals.items():
            limits[index] = limits[index] + np.abs(found - start.residuals[index])
    return start, limits


def _mending(
    start: Run,
    changes: Mapping[int, Any],
    edits: Sequence[Edit],
    limits: Mapping[int, Any],
    violated: frozenset[int],
) -> Iterator[_Fault]:
    """The edits that mend equations and break none."""
    found = start.followed(changes).residuals
    good = {
        index: np.broadcast_to(
            np.mean(np.abs(residual) <= 2 * limits[index], axis=-1) >= BORNE_OUT, (len(edits),)
        )
        for index, residual in found.items()
    }
    for place, edit in enumerate(edits):
        holding = {index for index, flags in good.items() if flags[place]}
        broken = good.keys() - holding
        # an equation that it touches and that still fails may be the other's
        if holding & violated and not broken - violated:
            yield _Fault(edit, frozenset(holding & violated))


def _mostly(good: Bools) -> bool:
    return bool(np.mean(good) >= BORNE_OUT)


_WITHOUT_IMPULSES = (LISTING, "equations with A's impulse")


def _clamps(names: Columns, theirs: Columns, how: Sequence[str]) -> dict[str, Any]:
    """Their velocities, and the impulses by what these change of A or of B: ``how`` says of which,
    for the linear impulse and for the moment."""
    v = {name: theirs[name] for name in FINAL_VELOCITIES}
    g = names
    if how[0] == "A":
        px, py = g["MA"] * (v["VAX"] - g["UX"]), g["MA"] * (v["VAY"] - g["UY"])
    else:
        px, py = -g["MB"] * (v["VBX"] - g["VX"]), -g["MB"] * (v["VBY"] - g["VY"])
    if how[1] == "A":
        moment = g["ia"] * (v["WAF"] - g["WA"]) - g["D3"] * px + g["D4"] * py
    else:
        moment = g["D1"] * px - g["D2"] * py - g["ib"] * (v["WBF"] - g["WB"])
    pn, pt = g["c"] * px + g["s"] * py, g["c"] * py - g["s"] * px
    return {**v, "Px": px, "Py": py, "Pn": pn, "Pt": pt, "Pm": moment, "T": moment}
