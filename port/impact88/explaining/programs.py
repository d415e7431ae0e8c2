"""Another program: every edit that the search of `equations` knows, evaluated for one page.

One node of one statement of the listing written otherwise, columns read or shown otherwise, other
models, in double precision. One is named only where the numbers it explains are far more than
chance would give.
"""

from collections.abc import Iterator, Mapping
from math import log2
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..doubles import doubles_of
from ..equations.edits import Edit, edits_of, readings
from ..equations.evaluation import Run, chunks
from ..equations.spelling import LISTING, SHOWN, spellings
from ..fields import FIELDS
from .causes import NOT_APPLESOFT, Cause, PageEvidence

_BITS = {"a changed line of the listing": 24.0, "another program": 20.0}
"""Bits of an edit: one of some 5,000 lines (12) or 500 readings (9), and an office's copy in which
one is wrong at all (12, 11)."""
_CHANCE = 50.0
"""Bits that the explained numbers must have together: the digits of three of them, as two often
follow from one another (a center's velocity and its contact point's)."""
_ROUGH = 4e-7
"""Relative error of the Apple's arithmetic."""


def causes(page: PageEvidence) -> Iterator[Cause]:
    """The edit that explains all that differs: of those that compute the same the likeliest."""
    numbers = {name: some[0] for name, some in page.results.items() if some and name in page.texts}
    differ = page.base & set(numbers)
    if sum(log2(1 + abs(numbers[n]) * 10.0 ** (FIELDS[n].places or 0)) for n in differ) < _CHANCE:
        return
    values = doubles_of(page.recovered.scene)
    run = Run(spellings()[LISTING], {name: np.array([value]) for name, value in values.items()})

    def wrong(names: Mapping[str, Any], count: int) -> NDArray[np.intp]:
        """How many of the numbers each of so many programs leaves unexplained."""
        found = np.zeros(count, np.intp)
        for name, number in numbers.items():
            shown = names.get(SHOWN + name, run.names[SHOWN + name])
            places = FIELDS[name].places
            unit = 0.0 if places is None else 10.0 ** -max(places, page.decimals(name))
            slack = _ROUGH * abs(number) + 0.05 * unit
            ahead = np.broadcast_to(shown, (count, 1))[:, 0] - number
            found += ~((ahead >= -slack) & (ahead <= unit + slack))
        return found

    if not wrong({}, 1)[0]:
        return  # what differs is the arithmetic
    edits = (*edits_of(LISTING), *readings())
    named: list[Edit] = []
    for part in chunks(len(edits), 1):
        names = run.edited([edit.sides for edit in edits[part]])
        alike = np.flatnonzero(wrong(names, len(edits[part])) == 0)
        named += [edits[part][k] for k in alike]
    if named:
        edit = min(named, key=lambda edit: (edit.rank, len(edit.text)))
        kind = "a changed line of the listing" if edit.title else "another program"
        yield Cause(kind, f"{edit.text}; {NOT_APPLESOFT}", _BITS[kind], frozenset())
