"""Columns of scenes: from what a caller hands over to blocks ready for a plan.

Columns may be scalars or arrays of any shapes that broadcast together, and are never copied as a
whole. Blocks are looked at once: which columns are the same for all their scenes, which are 0,
which numbers cannot be used. The answers choose the program.
"""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.fields import ANGLES
from ...collision.mappings import common_shape
from ...errors import UserError
from ...names import DEFAULT_M, PIVOT, SCENE

Array = NDArray[Any]
Floats = NDArray[np.float64]

BODY_CONSTANTS = ("MA", "MB", "IA", "IB")
BODIES = (("MA", "IA", ("UX", "UY"), "WA"), ("MB", "IB", ("VX", "VY"), "WB"))
"""Mass, inertia, velocities and spin of A and of B."""
UNUSED_BY_POINTS = ("DA", "DB", "PA", "PB", "TA", "TB", "IA", "IB", "EM")
"""Names that a point-mass scene (M = 4) ignores."""
OPTIONAL_OF_POINTS = (*UNUSED_BY_POINTS, "GA", "E", "MU", "WA", "WB")
"""Names that it may lack: not every result uses them."""

BLOCK = 16384
"""Scenes computed at a time, and the least that a thread gets: two columns of them fit a
second-level cache, all columns a third."""
LARGE_ANGLE = 720.0
"""Angles beyond this, in degrees, are taken modulo 360 (which is exact) before they are added up:
the sums are then rounded no more coarsely than the angles people give are."""
Limits = tuple[float, float]
"""Least and largest number."""
_LARGEST = float(np.finfo(np.float64).max)
_SMALLEST = float(np.nextafter(0.0, 1.0))


Source = Array | Any
"""A column: flat and of full length, of length 1, or an iterator over it in the common shape."""


def part(source: Source, start: int, stop: int) -> Floats:
    """Return scenes ``start`` to ``stop`` of a column, or its only value, as contiguous float64."""
    if len(source) > 1:
        source = source[start:stop]
    return np.ascontiguousarray(source, np.float64)


def sources(columns: Mapping[str, object]) -> tuple[dict[str, Source], tuple[int, ...]]:
    """Return name -> source for every scene name, in the table's order, and the common shape.

    Parameters
    ----------
    columns : mapping of str to float or array_like
        Numbers in base units. M may be missing; when it is 4 throughout, so may
        `UNUSED_BY_POINTS`. Scenes of M = 4 may have anything there, such as NaN.

    Raises
    ------
    UserError
        For a missing name and shapes that do not broadcast together.
    """
    arrays = {name: np.asarray(columns[name]) for name in SCENE if name in columns}
    arrays.setdefault("M", np.array(float(DEFAULT_M)))
    if arrays["M"].size and bool((arrays["M"] == 4).all()):
        for name in UNUSED_BY_POINTS:
            arrays.setdefault(name, np.array(0.0))
    missing = [name for name in SCENE if name not in arrays]
    if missing:
        raise UserError(f"missing: {' '.join(missing)}; a scene needs {' '.join(SCENE)}")
    shape = common_shape("columns", arrays)
    return {name: source_of(arrays[name], shape) for name in SCENE}, shape


def source_of(array: Array, shape: tuple[int, ...]) -> Source:
    """Return an array, which broadcasts to the common shape, as a source."""
    if array.size == 1:
        return array.reshape(1)
    if array.shape == shape and (array.ndim == 1 or array.flags.c_contiguous):
        return array.reshape(-1)
    return np.broadcast_to(array, shape).flat


class Block(NamedTuple):
    """A block of scenes made ready: ``fixed`` columns have length 1, ``varying`` its length;
    ``refused``: True where the numbers cannot be used, or None if nowhere.

    ``kinds`` says of each scene name what a program may rely on: ``array``, ``scalar``, ``0`` or
    ``1`` (for all scenes), of MA MB IA IB also ``array with infinities`` and ``inf``; of MU
    ``pivot`` or ``mixed`` (some pivots), else no pivot is in it; of M ``6``, ``4`` or ``mixed``;
    ``unused`` where all scenes are point masses and do not look at it.
    """

    fixed: dict[str, Floats]
    varying: dict[str, Floats]
    kinds: tuple[str, ...]
    refused: NDArray[np.bool_] | None


def examine(values: Mapping[str, Floats]) -> Block:
    """Classify the columns of a block. ``values``: columns of one length, or of length 1. Single
    scenes are examined only where a column's limits do not rule out unusable numbers."""
    extremes = {name: _extremes(column) for name, column in values.items()}
    only_points = extremes["M"] == (4.0, 4.0)
    fixed: dict[str, Floats] = {}
    varying: dict[str, Floats] = {}
    kinds: dict[str, str] = {}
    usable = True
    for name, column in values.items():
        if only_points and name in UNUSED_BY_POINTS:
            fixed[name], kinds[name] = column[:1], "unused"
            continue
        limits = extremes[name]
        if name in ANGLES and not _is_ordinary(name, limits):
            column = _within_a_turn(column, values["M"] if name in UNUSED_BY_POINTS else None)
            limits = float(column.min()), float(column.max())
        alike = len(column) == 1 or limits[0] == limits[1]
        kinds[name], is_usable = _classify(name, column, limits, alike)
        usable = usable and is_usable
        (fixed if alike else varying)[name] = column[:1] if alike else column
    kinds_in_order = tuple(kinds[name] for name in SCENE)
    if usable and _at_rest_where_infinite(kinds):
        return Block(fixed, varying, kinds_in_order, None)
    together = {name: fixed[name] if name in fixed else varying[name] for name in SCENE}
    is_refused = np.zeros(max(map(len, values.values())), np.bool_)
    for refusal in refusals(together):
        is_refused |= refusal.where
    return Block(fixed, varying, kinds_in_order, is_refused if is_refused.any() else None)


def _is_ordinary(name: str, limits: Limits) -> bool:
    """Return True if a column's least and largest number, no NaN, need no closer look."""
    low, high = UNEXAMINED[name]
    return low <= limits[0] and limits[1] <= high


def _within_a_turn(column: Floats, m: Floats | None) -> Floats:
    """Return angles of which the large ones are reduced; 0 where ``m`` says that bodies are
    points."""
    if m is not None:
        column = np.where(m == 4, 0.0, column)
    with np.errstate(invalid="ignore"):
        return np.where(np.abs(column) <= LARGE_ANGLE, column, np.fmod(column, 360.0))


def _classify(name: str, column: Floats, limits: Limits, alike: bool) -> tuple[str, bool]:
    """Return the kind of a column, and True if each of its numbers is usable for certain."""
    kind = "scalar" if alike else "array"
    if _is_ordinary(name, limits):
        return (alike_kind(name, limits[0]) if alike else kind), True
    if name == "M":
        if limits == (4.0, 4.0):
            return "4", True
        return ("6" if alike else "mixed"), False
    if name in BODY_CONSTANTS:
        if alike and limits[1] == np.inf:
            return "inf", True
        return (kind if alike else "array with infinities"), False
    if name == "MU":
        if bool((column == PIVOT).any()):
            kind = "pivot" if alike else "mixed"
        return kind, limits[0] >= -_LARGEST and limits[1] <= _LARGEST
    return kind, False


def _extremes(column: Floats) -> Limits:
    """Return the least and the largest number of a column; both are NaN where one number is."""
    if len(column) == 1:
        return (float(column[0]),) * 2
    return float(column.min()), float(column.max())


UNEXAMINED: dict[str, Limits] = {
    **dict.fromkeys(SCENE, (-_LARGEST, _LARGEST)),
    **dict.fromkeys(ANGLES, (-LARGE_ANGLE, LARGE_ANGLE)),
    **dict.fromkeys(BODY_CONSTANTS, (_SMALLEST, _LARGEST)),
    "M": (6.0, 6.0),
    "MU": (float(np.nextafter(PIVOT, 0.0)), _LARGEST),
}
"""Name -> limits within which no single number of a column has to be examined."""


def alike_kind(name: str, value: float) -> str:
    """Return the kind of a column that has one value, within its limits in `UNEXAMINED`."""
    if name == "M":
        return str(int(value))
    # formulas keep every inertia, even of 1
    return "scalar" if name in BODY_CONSTANTS else {0.0: "0", 1.0: "1"}.get(value, "scalar")


def _at_rest_where_infinite(kinds: Mapping[str, str]) -> bool:
    """Return True where the kinds alone show that infinite bodies are at rest, and one at most."""
    infinite = []
    for mass, inertia, velocities, spin in BODIES:
        no_shift, no_turn = kinds[mass] == "inf", kinds[inertia] == "inf"
        if no_shift and any(kinds[name] != "0" for name in velocities):
            return False
        if no_turn and kinds[spin] != "0":
            return False
        infinite.append(no_shift or no_turn)
    return not all(infinite)


class Refusal(NamedTuple):
    """Why scenes cannot be used: the column at fault, the reason, and where (True)."""

    column: str
    reason: str
    where: NDArray[np.bool_]


def refusals(columns: Mapping[str, Floats]) -> Iterator[Refusal]:
    """Yield the unusable numbers in ``columns`` (every scene name -> array of one length, or of
    length 1). `UNUSED_BY_POINTS` are not examined in point-mass scenes."""
    point = columns["M"] == 4
    yield Refusal("M", "is neither 4 nor 6", ~(point | (columns["M"] == 6)))
    for name, column in columns.items():
        if name == "M":
            continue
        is_examined = ~point if name in UNUSED_BY_POINTS else True
        if name in BODY_CONSTANTS:
            yield Refusal(name, "is not above 0", ~(column > 0) & is_examined)
        else:
            yield Refusal(name, "is not finite", ~np.isfinite(column) & is_examined)
    infinite = []
    for mass, inertia, velocities, spin in BODIES:
        no_shift = columns[mass] == np.inf
        no_turn = (columns[inertia] == np.inf) & ~point
        for name in velocities:
            moves = no_shift & (columns[name] != 0)
            yield Refusal(name, f"is not 0, but {mass} is infinite: a barrier is at rest", moves)
        turns = no_turn & (columns[spin] != 0)
        yield Refusal(spin, f"is not 0, but {inertia} is infinite: a barrier is at rest", turns)
        infinite.append(no_shift | no_turn)
    yield Refusal("MB", "or IB is infinite, and so is MA or IA", infinite[0] & infinite[1])
