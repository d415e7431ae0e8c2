"""What is run for a kind of block and the results wanted: a program, by the compiled machine in one
pass over the scenes, or by numpy one step after another (`plan`)."""

import struct
from functools import lru_cache

import numpy as np

from ..names import FINAL_VELOCITIES, PIVOT, RESULTS, SCENE
from ..native.formulas import Expression, ExpressionTable
from ..native.program import Program
from . import degrees, sinetable
from .columns import UNUSED_BY_POINTS
from .impact import impact

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
def program_for(kinds: Kinds, wanted: tuple[str, ...], sign: float | None = None) -> Program:
    """No result is a negative zero, and NaN is what is not finite; COND alone may be infinite."""
    table = ExpressionTable()
    kind = dict(zip(SCENE, kinds, strict=True))
    scene: dict[str, Expression] = {}
    for name, what in kind.items():
        if what in ("0", "1", "inf", "unused"):
            scene[name] = table.constant(0.0 if what == "unused" else float(what))
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
    endings = {"COND": "RESULT_OR_INFINITE", "STATUS": "BITS"}
    return Program({x: found[x] for x in wanted}, [endings.get(x, "RESULT") for x in wanted])


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
