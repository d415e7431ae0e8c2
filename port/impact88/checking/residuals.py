"""Which of Equations 13 to 18 another program's own results violate.

The equations are evaluated on the results as they were given: no solution of ours comes in. An
equation is violated when its two sides differ by more than the digits written, and rounding, allow.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..equations.evaluation import Run
from ..equations.spelling import spellings
from .agreement import Slack, Theirs

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Columns = dict[str, Floats]

EQUATIONS = {
    "13": "momentum along x",
    "14": "momentum along y",
    "15": "restitution",
    "16": "friction",
    "17": "angular momentum",
    "18": "moment",
}
"""Number and subject."""
FORM = "equations with A's impulse"
"""The spelling in which each equation can be violated alone: none takes another for granted."""
_SPINS = {"WAF": "WA", "WBF": "WB"}
_ROUNDING = 1e-13
"""Of the sum of an equation's terms, for evaluating it."""


def violated(scene: Columns, theirs: Mapping[str, Theirs], allowed: Slack) -> dict[str, Bools]:
    """Equation number -> where it is violated, in the order 13 to 18.

    Empty when the table lacks a final velocity. A scene with a missing number violates nothing.
    """
    spelling = spellings()[FORM]
    unknowns = _unknowns(scene, theirs, spelling.unknown)
    if unknowns is None:
        return {}
    matrix, right = Run(spelling, scene).system()
    with np.errstate(all="ignore"):
        values = np.stack([unknowns[name].values for name in spelling.unknown], axis=1)
        room = np.stack(
            [
                unknowns[name].units * 0.5 + allowed.elimination * allowed.sizes[name]
                for name in spelling.unknown
            ],
            axis=1,
        )
        terms = np.abs(matrix) * np.abs(values)[:, None, :]
        limit = (np.abs(matrix) * room[:, None, :]).sum(2)
        limit += _ROUNDING * (terms.sum(2) + np.abs(right))
        off = np.abs((matrix * values[:, None, :]).sum(2) - right) > limit
    subjects = [spelling.statements[index].subject for index in spelling.equations]
    numbers = [found[0] for text in subjects if (found := re.search("[0-9]+", text))]
    return {number: off[:, numbers.index(number)] for number in EQUATIONS}


def _unknowns(
    scene: Columns, theirs: Mapping[str, Theirs], names: tuple[str, ...]
) -> dict[str, Theirs] | None:
    """The six final velocities; point masses keep their spins, given or not."""
    point = scene["M"] == 4
    unknowns = {}
    for name in names:
        column = theirs.get(name)
        if name in _SPINS and point.any():
            kept = scene[_SPINS[name]]
            mine = column.values if column else np.full(point.size, np.nan)
            unit = column.units if column else np.zeros(point.size)
            column = Theirs(np.where(point, kept, mine), np.where(point, 0.0, unit))
        if column is None:
            return None
        unknowns[name] = column
    return unknowns
