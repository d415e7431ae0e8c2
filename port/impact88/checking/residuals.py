"""Which of Equations 13 to 18 another program's own results violate.

The equations are evaluated on the results as they were given: no solution of ours comes in. An
equation is violated when its two sides differ by more than the digits written, and rounding, allow.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..accuracy.elimination import ORDER
from ..reconstruction.geometry import Geometry
from .agreement import Slack, Theirs
from .otherprograms import matrices
from .slipsfilling import EQUATIONS, ON_A

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Columns = dict[str, Floats]

_SPINS = {"WAF": "WA", "WBF": "WB"}
_ROUNDING = 1e-13
"""Of the sum of an equation's terms, for evaluating it."""


def violated(scene: Columns, theirs: Mapping[str, Theirs], allowed: Slack) -> dict[str, Bools]:
    """Equation number -> where it is violated, in the order 13 to 18.

    Empty when the table lacks a final velocity. A scene with a missing number violates nothing.
    """
    unknowns = _unknowns(scene, theirs)
    if unknowns is None:
        return {}
    matrix, right = matrices(scene)
    for form in ON_A:
        form(matrix, right, scene)
    with np.errstate(all="ignore"):
        values = np.stack([unknowns[name].values for name in ORDER], axis=1)
        room = np.stack(
            [
                unknowns[name].units * 0.5 + allowed.elimination * allowed.sizes[name]
                for name in ORDER
            ],
            axis=1,
        )
        terms = np.abs(matrix) * np.abs(values)[:, None, :]
        limit = (np.abs(matrix) * room[:, None, :]).sum(2)
        limit += _ROUNDING * (terms.sum(2) + np.abs(right))
        off = np.abs((matrix * values[:, None, :]).sum(2) - right) > limit
    numbers = list(EQUATIONS)
    return {number: off[:, numbers.index(number)] for number in sorted(EQUATIONS)}


def _unknowns(scene: Columns, theirs: Mapping[str, Theirs]) -> dict[str, Theirs] | None:
    """The six final velocities; point masses keep their spins, given or not."""
    point = scene["M"] == 4
    unknowns = {}
    for name in ORDER:
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


def effective(scene: Columns, theirs: Mapping[str, Theirs]) -> Columns:
    """The coefficients that their results have: E, MU (as it is used) and EM; empty when a final
    velocity is missing. NaN or infinite where a coefficient plays no part."""
    unknowns = _unknowns(scene, theirs)
    if unknowns is None:
        return {}
    geometry = Geometry.of(scene)
    with np.errstate(all="ignore"):
        before = [scene[name] for name in ("UX", "UY", "WA", "VX", "VY", "WB")]
        after = [unknowns[name].values for name in ("VAX", "VAY", "WAF", "VBX", "VBY", "WBF")]
        pn = scene["MA"] * (
            geometry.cosine * (after[0] - before[0]) + geometry.sine * (after[1] - before[1])
        )
        pt = scene["MA"] * (
            geometry.cosine * (after[1] - before[1]) - geometry.sine * (after[0] - before[0])
        )
        moment = scene["IA"] * (after[2] - before[2]) - geometry.an * pn - geometry.at * pt
        shared = moment * geometry.inverse_spin_inertia
        spinning = after[2] - after[5]
        return {
            "E": -geometry.relative(after)[0] / geometry.relative(before)[0],
            "MU": pt / pn,
            "EM": spinning / (shared + spinning),
        }
