"""What is run for a kind of block and the results wanted: a program, by the compiled machine in one
pass over the scenes, or by numpy one step after another."""

import operator
import struct
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..names import FINAL_VELOCITIES, PIVOT, RESULTS, SCENE
from ..native.formulas import Expression, ExpressionTable
from ..native.program import Program
from ..native.schedule import Schedule
from . import degrees, sinetable
from .columns import UNUSED_BY_POINTS
from .impact import impact

Kinds = tuple[str, ...]
"""Of each column, see `closedform.columns.Block`."""
Array = NDArray[Any]

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


_STEPS: dict[str, Callable[..., Any]] = {
    **{"ADD": operator.add, "SUBTRACT": operator.sub, "MULTIPLY": operator.mul},
    **{"DIVIDE": operator.truediv, "NEGATIVE": operator.neg, "ABSOLUTE": abs, "SQRT": np.sqrt},
    **{"EQUAL": operator.eq, "LESS": operator.lt, "LESS_OR_EQUAL": operator.le},
    **{"BOTH": operator.and_, "EITHER": operator.or_, "NOT": operator.invert, "CHOOSE": np.where},
    "AGAINST": lambda value, slip: np.where(slip > 0, -value, value),
    "PRODUCT_PLUS": lambda a, b, c: a * b + c,
    "PRODUCT_MINUS": lambda a, b, c: a * b - c,
    "MINUS_PRODUCT": lambda a, b, c: c - a * b,
    "PRODUCTS_PLUS": lambda a, b, c, d: a * b + c * d,
    "PRODUCTS_MINUS": lambda a, b, c, d: a * b - c * d,
    "SINE_AND_COSINE": degrees.sine_and_cosine,
    # a zero's sign would tell which path led to it
    **dict.fromkeys(("RESULT", "RESULT_OR_INFINITE"), lambda value: value + 0.0),
    "BITS": lambda number: number.astype(np.uint16),
}


def by_numpy(
    program: Schedule,
    columns: Sequence[Array],
    results: Mapping[str, Array],
    fixed: Mapping[str, float],
    tile: int,
) -> None:
    """Run a program: read the varying ``columns`` (equally long float64 arrays, in the program's
    order), write the ``results``; ``fixed``: the columns that do not vary. ``tile`` scenes are
    taken at a time, so that what is worked with stays in the processor's cache."""
    values: dict[int, Any] = {
        place: np.array([fixed[scalar] if isinstance(scalar, str) else scalar])
        for place, scalar in enumerate(program.scalars, program.moving)
    }
    steps = program.steps
    for low in range(0, len(next(iter(results.values()))), tile):
        values |= {place: column[low : low + tile] for place, column in enumerate(columns)}
        for name, places in steps:
            if name == "SINE_AND_COSINE":
                values[places[1]], values[places[2]] = _STEPS[name](values[places[0]])
            else:
                values[places[-1]] = _STEPS[name](*[values[place] for place in places[:-1]])
        for place, result in enumerate(results.values(), len(columns)):
            result[low : low + tile] = values[place]
        steps = program.steps[program.once :]
    for result, ending in zip(results.values(), program.endings, strict=True):
        if ending != "BITS" and not np.isfinite(result.sum()):
            # NaN by one set of bits
            result[~np.isfinite(result) if ending == "RESULT" else np.isnan(result)] = np.nan


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
