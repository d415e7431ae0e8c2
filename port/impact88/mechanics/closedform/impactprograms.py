"""Programs for each kind of block and set of results, and the bodies of the compiled kernels.

A program is run by the compiled interpreter (`native/machine.c`) in one pass over the scenes, or by
numpy one step after another (`plan`). The commonest are compiled as a whole: the kernels.
"""

import struct
from collections.abc import Iterable
from functools import lru_cache

import numpy as np

from ...collision import degrees, sinetable
from ...names import FINAL_VELOCITIES, PIVOT, RESULTS, SCENE
from ..native.formulas import Expression, ExpressionTable
from ..native.program import Program
from .columns import INERTIAS, UNUSED_BY_POINTS
from .impact import StatusFrom, impact

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
"""Address of the table of sines and its constants, ``circle`` in `native/machine.c`."""


@lru_cache(maxsize=1024)
def program_for(
    kinds: Kinds,
    wanted: tuple[str, ...],
    sign: float | None = None,
    status_from: StatusFrom = "results",
) -> Program:
    """Return the program that computes ``wanted`` of columns of these kinds.

    ``sign``, ``status_from``: see `impact`. No result is a negative zero. A result that is not
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
    results = impact(table, scene, pivot, point, infinite, sign, status_from)
    endings = {"COND": "RESULT_OR_INFINITE", "STATUS": "BITS"}
    return Program({x: results[x] for x in wanted}, [endings.get(x, "RESULT") for x in wanted])


def varying(mu: str, point: bool, infinite: bool = False, zeros: Iterable[str] = ()) -> Kinds:
    """The kinds where every column varies but M, MU of pivots, and those that are 0; ``mu``: the
    kind of MU; ``infinite``: inertias may be."""
    kinds = {"M": "4" if point else "6", "MU": mu, **dict.fromkeys(zeros, "0")}
    if infinite:
        kinds |= dict.fromkeys(INERTIAS, "array with infinities")
    if point:
        kinds |= dict.fromkeys(UNUSED_BY_POINTS, "unused")
    return tuple(kinds.get(name, "array") for name in SCENE)


ALL = tuple(RESULTS)
COLUMNS = tuple(SCENE)
FORMULAS = "d43bf4aa99000123"
"""Digest of the bodies' programs (`mechanics.kernelsource`): the library has the same formulas."""

SOURCES: tuple[StatusFrom, ...] = ("estimate", "impulse")
"""What filters find STATUS from, see `statusfilter`."""
FILTERED = {"friction": "array", "pivot": "pivot", "mixed": "mixed"}
"""Bodies that have filters, and the kind of MU in them."""
FILTERS: dict[str, tuple[str, StatusFrom]] = {
    f"{body}_status_from_{source}": (body, source) for body in FILTERED for source in SOURCES
}
"""Body of a filter -> the body it stands for, and what it finds STATUS from."""
BODIES: dict[str, Kinds] = {
    "friction": varying("array", False, True),
    "pivot": varying("pivot", False, True),
    "point": varying("array", True, True),
    "point_pivot": varying("pivot", True, True),
    "mixed": varying("mixed", False, True),
    "point_mixed": varying("mixed", True, True),
    "friction_without_moment": varying("array", False, True, ["EM"]),
    "smooth": varying("array", False, True, ["MU"]),
    "friction_without_arms": varying("array", False, True, ["DA", "DB"]),
    **{name: varying(FILTERED[body], False, True) for name, (body, _) in FILTERS.items()},
}
"""Name -> kinds of columns of each body: the formulas of one kind of scene as a C function, made by
`mechanics.kernelsource`. A kernel is a body that keeps some of its results.

The first four serve all scenes, the next two friction and pivots beside each other. Three are
shorter, for calls all of whose scenes have a 0 in these columns. The filters compute STATUS in less
time, but for scenes that they mark for the full kernel."""
_BEFORE = ("VC", "VS", "XA", "YA", "XB", "YB", "KI", "MUP")
_IMPULSES = ("PN", "PT", "PM", "MUP", "DVA", "DVB", "VC", "VS")
_ENERGIES = ("ELN", "ELT", "ELM")
_CRUSH = ("EESA", "EESB")
_CONTACTS = ("XAF", "YAF", "XBF", "YBF")
_WITH_STATUS = ("LOSS", "DVA", "DVB", "STATUS")
_SETS = (
    FINAL_VELOCITIES,
    _BEFORE,
    _IMPULSES,
    ("LOSS", "KI"),
    _ENERGIES,
    _CRUSH,
    ("LOSS", "KI", *_ENERGIES, *_CRUSH, *_IMPULSES),
    ("MUC", "MUP"),
    ("COND", "MUP"),
    _CONTACTS,
    (*_CONTACTS, *FINAL_VELOCITIES),
    ("KI", "KF"),
    ("KI", "KF", *FINAL_VELOCITIES),
    ("STATUS",),
    _WITH_STATUS,
    (*_WITH_STATUS, *FINAL_VELOCITIES),
    ALL,
)
_SETS_OF_POINTS = (
    FINAL_VELOCITIES,
    _BEFORE,
    _IMPULSES,
    ("LOSS", "KI", *_ENERGIES, *_CRUSH, *_IMPULSES),
    ("STATUS",),
    ALL,
)
KERNELS = [
    *((body, results) for body in ("friction", "pivot", "mixed") for results in _SETS),
    *(
        (body, results)
        for body in ("point", "point_pivot", "point_mixed")
        for results in _SETS_OF_POINTS
    ),
    *((body, FINAL_VELOCITIES) for body in list(BODIES)[6:9]),
    *(
        (body, ("STATUS",) if source == "estimate" else _WITH_STATUS)
        for body, (_, source) in FILTERS.items()
    ),
]
"""Body and results of each kernel, the cheapest first: the first with all results wanted is run."""
