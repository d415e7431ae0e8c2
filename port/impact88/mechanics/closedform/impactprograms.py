"""The formulas as steps, for each kind of block and set of results: what numpy runs (`plan`)."""

import struct
from functools import lru_cache

import numpy as np

from ...collision import degrees, sinetable
from ...names import PIVOT, RESULTS, SCENE
from ..native.expressiontable import Expression, ExpressionTable
from ..native.schedule import Schedule
from .impact import impact

Kinds = tuple[str, ...]
"""Kind of each column, see `closedform.columns.Block`."""

_CIRCLE = np.frombuffer(
    struct.pack(
        "P8dq",
        degrees.table().ctypes.data,
        1 / sinetable.STEP,
        sinetable.STEP,
        sinetable.INTEGER_IN_LOW_BITS,
        *sinetable.POLYNOMIALS,
        sinetable.STEPS,
    ),
    np.uint8,
).copy()
CIRCLE = _CIRCLE.ctypes.data
"""Address of the table of sines and its constants, ``circle`` in `native/impacts.h`."""


@lru_cache(maxsize=1024)
def program_for(
    kinds: Kinds,
    wanted: tuple[str, ...],
    sign: float | None = None,
) -> Schedule:
    """Return the program that computes ``wanted`` of columns of these kinds.

    ``sign``: see `impact`. No result is a negative zero. A result that is not
    finite is NaN, except that COND may be infinite.
    """
    table = ExpressionTable()
    kind = dict(zip(SCENE, kinds, strict=True))
    scene: dict[str, Expression] = {}
    for name, text in kind.items():
        if text in ("0", "1", "inf", "unused"):
            scene[name] = table.constant(0.0 if text == "unused" else float(text))
        else:
            scene[name] = table.column(name, varies=text.startswith(("array", "mixed")))
    pivot: bool | Expression = kind["MU"] == "pivot"
    if kind["MU"] == "mixed":
        pivot = table.equals(scene["MU"], PIVOT)
    point: bool | Expression = kind["M"] == "4"
    if kind["M"] == "mixed":
        point = table.equals(scene["M"], 4.0)
    infinite = any("inf" in text for text in kinds)
    results = impact(table, scene, pivot, point, infinite, sign)
    endings = {"COND": "RESULT_OR_INFINITE", "STATUS": "BITS"}
    return Schedule({x: results[x] for x in wanted}, [endings.get(x, "RESULT") for x in wanted])


ALL = tuple(RESULTS)
COLUMNS = tuple(SCENE)
