"""A line of the listing written otherwise: every edit of one node of one statement, evaluated.

The edits are those of the search for other programs' faults (`equations.edits`), in double
precision. One is named only where the numbers it explains are far more than chance would give.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from math import log2
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..doubles import doubles_of
from ..equations.edits import Edit, statement_edits
from ..equations.evaluation import Run
from ..equations.spelling import LISTING, spellings
from ..fields import FIELDS
from .machines import NOT_APPLESOFT, Cause
from .predictions import Evidence

_BITS = 24.0
"""Bits of a line written otherwise: one of some 5,000 edits (12), and an office's copy in which a
line is wrong at all (12)."""
_CHANCE = 50.0
"""Bits that the explained numbers must have together: the digits of three of them, as two often
follow from one another (a center's velocity and its contact point's)."""
_NAMED = 3
"""Of the edits that compute the same so many are named, the likeliest."""
KIND = "a line of the listing written otherwise"
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
    numbers = {n: some[0] for n, some in evidence.results.items() if some and n in evidence.texts}
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

    def wrong(names: Mapping[str, Any], count: int) -> NDArray[np.intp]:
        """How many of the numbers each of so many runs leaves unexplained."""
        found = np.zeros(count, np.intp)
        for name, number in numbers.items():
            values = np.broadcast_to(names.get(name, run.names[name]), (count, 1))[:, 0]
            places = FIELDS[name].places
            unit = 0.0 if places is None else 10.0 ** -max(places, evidence.decimals(name))
            slack = _ROUGH * abs(float(number)) + 0.05 * unit
            ahead = values - float(number)
            found += ~((ahead >= -slack) & (ahead <= unit + slack))
        return found

    if not wrong({}, 1)[0]:
        return  # what differs is the arithmetic
    named: list[tuple[int, str]] = []
    with np.errstate(all="ignore"):
        for index, edits in _edits().items():
            names = run.followed({index: run.edited(index, [e.sides[index] for e in edits])}).names
            explaining = np.flatnonzero(wrong(names, len(edits)) == 0).tolist()
            named += [(edits[place].rank, edits[place].text()) for place in explaining]
    for _, text in sorted(named, key=lambda one: one[0])[:_NAMED]:
        yield Cause(KIND, f"{text}; {NOT_APPLESOFT}", _BITS, scene, frozenset())
