"""A line of the listing written otherwise: every edit of one node of one statement, evaluated.

The edits are those of the search for other programs' faults (`equations.edits`), in double
precision. One is named only where the numbers it explains are far more than chance would give.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from math import log2

import numpy as np

from ..doubles import doubles_of
from ..equations.edits import Edit, statement_edits
from ..equations.evaluation import Run
from ..equations.spelling import LISTING, spellings
from ..fields import FIELDS
from .evidence import Evidence
from .machines import NOT_APPLESOFT, Cause

_BITS = 24.0
"""Bits of a line written otherwise: one of some 5,000 edits (12), and an office's copy in which a
line is wrong at all (12)."""
_CHANCE = 50.0
"""Bits that the explained numbers must have together: the digits of three of them, as two often
follow from one another (a center's velocity and its contact point's)."""
_ROUGH = 4e-7
"""Relative error of the Apple's arithmetic."""


@cache
def _edits() -> dict[int, list[Edit]]:
    """The edits of each statement."""
    grouped: dict[int, list[Edit]] = {}
    for edit in statement_edits(spellings()[LISTING]):
        grouped.setdefault(next(iter(edit.sides)), []).append(edit)
    return grouped


def causes(evidence: Evidence, differing: frozenset[str]) -> Iterator[Cause]:
    """The edits that explain all that differs."""
    numbers = {name: some[0] for name, some in evidence.results.items() if some}
    told = sum(
        log2(1 + abs(float(numbers[name])) * 10.0 ** (FIELDS[name].places or 0))
        for name in differing & set(numbers)
    )
    if told < _CHANCE:
        return
    scene = evidence.recovered.scene
    columns = {
        n: np.array([x]) for n, x in doubles_of({n: t or "0" for n, t in scene.items()}).items()
    }
    run = Run(spellings()[LISTING], columns)
    with np.errstate(all="ignore"):
        for index, edits in _edits().items():
            names = run.followed({index: run.edited(index, [e.sides[index] for e in edits])}).names
            wrong = np.zeros(len(edits), int)
            for name, number in numbers.items():
                values = np.broadcast_to(names.get(name, run.names[name]), (len(edits), 1))[:, 0]
                places = FIELDS[name].places
                unit = 10.0**-places if places is not None else 0.0
                slack = _ROUGH * abs(float(number)) + 0.05 * unit
                ahead = values - float(number)
                wrong += ~((ahead >= -slack) & (ahead <= unit + slack))
            for place in np.flatnonzero(wrong == 0).tolist():
                text = edits[place].text()
                yield Cause(
                    "a line of the listing written otherwise", f"{text}; {NOT_APPLESOFT}", _BITS,
                    scene, frozenset(),
                )  # fmt: skip
