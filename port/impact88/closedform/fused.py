"""What is run for a kind of block and the results wanted: numpy's plan (`plan.Plan`), one operation
at a time, or the same operations as a program of `impact88.native`, one pass over the scenes."""

import struct
from functools import lru_cache

import numpy as np

from ..names import FINAL_VELOCITIES, PIVOT, RESULTS, SCENE
from ..native.formulas import Expression, ExpressionTable
from ..native.program import Program
from . import degrees, sinetable
from .columns import UNUSED_BY_POINTS
from .impact import impact
from .plan import Plan

Kinds = tuple[str, ...]
"""Of each column, see `closedform.columns.Block`."""


_CIRCLE = np.frombuffer(
    struct.pack(
        *("P8dq", degrees.table().ctypes.data, 1 / sinetable.STEP, sinetable.STEP),
        *(sinetable.INTEGER_IN_LOW_BITS, *sinetable.POLYNOMIALS, sinetable.STEPS),
    ),
    np.uint8,
).copy()
CIRCLE = _CIRCLE.ctypes.data
"""Where the machine finds what sines and cosines are made of, ``circle`` there."""


@lru_cache(maxsize=1024)
def plan_for(kinds: Kinds, wanted: tuple[str, ...], sign: float | None = None) -> Plan:
    """By numpy."""
    return Plan(program_for(kinds, wanted, sign))


@lru_cache(maxsize=1024)
def program_for(kinds: Kinds, wanted: tuple[str, ...], sign: float | None = None) -> Program:
    """By the compiled machine: no negative zero, and NaN for what is not finite; COND alone may be
    infinite."""
    table = ExpressionTable()
    kind = dict(zip(SCENE, kinds, strict=True))
    scene: dict[str, Expression] = {}
    for name, what in kind.items():
        if what in ("0", "1", "inf"):
            scene[name] = table.constant(float(what))
        elif what == "unused":
            scene[name] = table.constant(0.0)
        else:
            scene[name] = table.column(name, varies=what.startswith(("array", "mixed")))
    pivot: bool | Expression = kind["MU"] == "pivot"
    if kind["MU"] == "mixed":
        pivot = table.equals(scene["MU"], PIVOT)
    point: bool | Expression = kind["M"] == "4"
    if kind["M"] == "mixed":
        point = table.equals(scene["M"], 4.0)
    infinite = any("inf" in what for what in kinds)
    found = impact(table, scene, pivot, point, infinite, sign)
    results: dict[str, Expression] = {name: found[name] for name in wanted}
    endings = ["RESULT_OR_INFINITE" if name == "COND" else "RESULT" for name in results]
    for number, (name, e) in enumerate(results.items()):
        if e.operation == "bits":
            # the sum of STATUS's bits becomes a whole number as it is written
            results[name], endings[number] = e.operands[0], "BITS"
    return Program(results, endings)


def varying(pivot: bool, point: bool) -> Kinds:
    """The kinds where every column varies but MU of pivots and M."""
    unused = dict.fromkeys(UNUSED_BY_POINTS if point else (), "unused")
    kinds = {"M": "4" if point else "6", "MU": "pivot" if pivot else "array", **unused}
    return tuple(kinds.get(name, "array") for name in SCENE)


KERNELS = {
    f"{name}_{len(results)}": (varying(name == "pivot", name == "point"), results)
    for name in ("friction", "pivot", "point")
    for results in (FINAL_VELOCITIES, tuple(RESULTS))
}
"""Kinds and results of the programs that the machine has as a whole (tests/kernels.py)."""
