"""Another program: every edit that the search of `equations` knows, evaluated for one page.

One node of one statement of the listing written otherwise, columns read or shown otherwise, other
models, in double precision. One is named only where the numbers it explains are far more than
chance would give.
"""

from collections.abc import Iterator, Mapping
from functools import cache
from math import log2
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..doubles import doubles_of
from ..equations.edits import Edit, edits_of, readings
from ..equations.evaluation import Run, chunks
from ..equations.spelling import LISTING, SHOWN, spellings
from ..fields import FIELDS
from .predictions import NOT_APPLESOFT, Cause, Evidence

_BITS = {"a changed line of the listing": 24.0, "another program": 20.0}
"""Bits of an edit: one of some 5,000 lines (12) or 500 readings (9), and an office's copy in which
one is wrong at all (12, 11)."""
_CHANCE = 50.0
"""Bits that the explained numbers must have together: the digits of three of them, as two often
follow from one another (a center's velocity and its contact point's)."""
_ROUGH = 4e-7
"""Relative error of the Apple's arithmetic."""


@cache
def _edits() -> tuple[Edit, ...]:
    return (*edits_of(LISTING), *readings())


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
    values = doubles_of({name: text or "0" for name, text in scene.items()})
    run = Run(spellings()[LISTING], {name: np.array([value]) for name, value in values.items()})

    def wrong(names: Mapping[str, Any], count: int) -> NDArray[np.intp]:
        """How many of the numbers each of so many programs leaves unexplained."""
        found = np.zeros(count, np.intp)
        for name, number in numbers.items():
            shown = names.get(SHOWN + name, run.names[SHOWN + name])
            places = FIELDS[name].places
            unit = 0.0 if places is None else 10.0 ** -max(places, evidence.decimals(name))
            slack = _ROUGH * abs(float(number)) + 0.05 * unit
            ahead = np.broadcast_to(shown, (count, 1))[:, 0] - float(number)
            found += ~((ahead >= -slack) & (ahead <= unit + slack))
        return found

    if not wrong({}, 1)[0]:
        return  # what differs is the arithmetic
    named: list[Edit] = []
    with np.errstate(all="ignore"):
        for part in chunks(len(_edits()), 1):
            some = _edits()[part]
            names = run.edited([edit.sides for edit in some]).names
            named += [some[k] for k in np.flatnonzero(wrong(names, len(some)) == 0)]
    # what computes the same is named once, as the likeliest of its ways
    for edit in sorted(named, key=lambda edit: (edit.rank, len(edit.text)))[:1]:
        kind = "a changed line of the listing" if edit.title else "another program"
        note = f"{edit.text}; {NOT_APPLESOFT}"
        yield Cause(kind, note, _BITS[kind], scene, frozenset())
