"""Columns of scenes: from what a caller hands over to blocks ready for a plan.

Columns may be scalars or arrays of any shapes that broadcast together. They are never copied as a
whole: a block of a column that is not plain float64 is converted into a buffer when its turn comes.
Blocks are looked at once: which columns are the same for all their scenes, which are 0, which
numbers cannot be used. The answers choose the plan.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError
from ..fields import ANGLES
from ..names import DEFAULT_M, PIVOT, SCENE

Array = NDArray[Any]
Floats = NDArray[np.float64]

INERTIAS = ("MA", "MB", "IA", "IB")
BODIES = (("MA", "IA", ("UX", "UY"), "WA"), ("MB", "IB", ("VX", "VY"), "WB"))
"""Mass, inertia, velocities and spin of A and of B."""
UNUSED_BY_POINTS = ("DA", "DB", "PA", "PB", "TA", "TB", "IA", "IB", "EM")
"""What a point-mass scene (M = 4) does not look at."""

LARGE_ANGLE = 720.0
"""Angles beyond this, in degrees, are taken modulo 360 (which is exact) before they are added up:
the sums are then rounded no more coarsely than the angles people give are."""


class Source(NamedTuple):
    """A column: ``values`` flat and of full length, or of length 1; or awkward, see `block`."""

    values: Array
    shape: tuple[int, ...] | None  # of the broadcast, when ``values`` must be read through it


def sources(columns: Mapping[str, object]) -> tuple[dict[str, Source], tuple[int, ...]]:
    """Check ``columns`` and return name -> source for every scene name, in the table's order, and
    the common shape.

    Raises UserError for an unknown or missing name, a column that holds no numbers, and shapes
    that do not broadcast together. M may be missing (it is 6 in the published listing); when it is
    4 throughout, so may be what a point mass does not look at.
    """
    unknown = [name for name in columns if name not in SCENE]
    if unknown:
        raise UserError(
            f"{unknown[0]!r} is no scene name; expected {' '.join(SCENE)} "
            "(impact88.solve_frame takes further columns)"
        )
    arrays = {name: _numbers(name, columns[name]) for name in SCENE if name in columns}
    arrays.setdefault("M", np.array(float(DEFAULT_M)))
    if arrays["M"].size and bool((arrays["M"] == 4).all()):
        for name in UNUSED_BY_POINTS:
            arrays.setdefault(name, np.array(0.0))
    missing = [name for name in SCENE if name not in arrays]
    if missing:
        raise UserError(f"missing: {' '.join(missing)}; a scene needs {' '.join(SCENE)}")
    try:
        shape = np.broadcast_shapes(*(array.shape for array in arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {a.shape}" for name, a in arrays.items() if a.ndim)
        raise UserError(f"the columns' shapes do not broadcast together: {shapes}") from None
    return {name: _source(arrays[name], shape) for name in SCENE}, shape


def _numbers(name: str, values: object) -> Array:
    if isinstance(values, np.ma.MaskedArray):
        if values.dtype.kind not in "fiub":
            raise UserError(f"holds {values.dtype} values; expected numbers", f"column {name}")
        return np.ma.filled(values.astype(np.float64), np.nan)
    if hasattr(values, "__dask_graph__") and values.__dask_graph__() is not None:
        raise UserError(
            "is not computed yet; expected .compute(), or impact88.solve within map_blocks",
            f"column {name}",
        )
    array = np.asarray(values)
    if array.dtype.kind in "fiub":
        return array
    try:
        if array.dtype.kind in "USO":
            return array.astype(np.float64)
    except (TypeError, ValueError) as error:
        raise UserError(f"{error}; expected numbers", f"column {name}") from None
    raise UserError(f"holds {array.dtype} values; expected numbers", f"column {name}")


def _source(array: Array, shape: tuple[int, ...]) -> Source:
    if array.size == 1:
        return Source(array.reshape(1).astype(np.float64), None)
    if array.shape == shape and (array.ndim == 1 or array.flags.c_contiguous):
        return Source(array.reshape(-1), None)
    return Source(array, shape)


class Buffers:
    """Room for the blocks of columns that are not plain float64 arrays (one for each thread)."""

    def __init__(self, size: int) -> None:
        self.size = size
        self._kept: dict[str, Floats] = {}

    def block(self, name: str, source: Source, start: int, stop: int) -> Floats:
        """Scenes ``start`` to ``stop`` of a column, or its only value, as float64."""
        values = source.values
        if source.shape is None:
            if len(values) == 1:
                return values
            if values.dtype == np.float64 and values.strides[0] == values.itemsize:
                return values[start:stop]
            part = values[start:stop]
        else:
            part = np.broadcast_to(values, source.shape).flat[start:stop]
        if name not in self._kept:
            self._kept[name] = np.empty(self.size)
        room = self._kept[name][: stop - start]
        np.copyto(room, part)
        return room


class Block(NamedTuple):
    """A block of scenes made ready: ``fixed`` columns have length 1, ``varying`` its length.

    ``kinds`` tells of each scene name what a plan may rely on:

    - ``array``, ``scalar``, ``0`` or ``1`` (for all scenes of the block);
    - MA MB IA IB: also ``array with infinities`` and ``inf``;
    - MU: ``pivot`` or ``mixed`` (some pivots), else no pivot is in it;
    - M: ``6``, ``4`` or ``mixed``;
    - ``unused`` where all scenes are point masses and do not look at it.

    ``refused``: a boolean array, True where the numbers cannot be used, or None if nowhere.
    """

    fixed: dict[str, Floats]
    varying: dict[str, Floats]
    kinds: tuple[str, ...]
    refused: NDArray[np.bool_] | None


def examine(values: Mapping[str, Floats]) -> Block:
    """Find out what kind of block this is. ``values``: columns of one length, or of length 1.

    Every column is read once or twice, no more; only where something may be unusable are the
    scenes looked at one by one.
    """
    fixed: dict[str, Floats] = {}
    varying: dict[str, Floats] = {}
    kinds: dict[str, str] = {}
    usable = True
    only_points = bool((values["M"] == 4).all())
    for name, column in values.items():
        if only_points and name in UNUSED_BY_POINTS:
            kinds[name] = "unused"
            fixed[name] = column[:1]
            continue
        if len(column) > 1 and _same_throughout(column):
            column = column[:1]
        if name in ANGLES:
            column, kind, fine = _angle(column)
        else:
            kind, fine = _kind(name, column)
        kinds[name] = kind
        usable = usable and fine
        (fixed if len(column) == 1 else varying)[name] = column
    ordered = tuple(kinds[name] for name in SCENE)
    if usable and _at_rest_where_infinite(kinds):
        return Block(fixed, varying, ordered, None)
    together = {name: fixed[name] if name in fixed else varying[name] for name in SCENE}
    refused = _refused(together, max(map(len, values.values())))
    return Block(fixed, varying, ordered, refused if refused.any() else None)


def _same_throughout(column: Floats) -> bool:
    first = column[0]
    return bool(first == column[-1] and first == column[len(column) // 2]) and bool(
        (column == first).all()
    )


def _all_finite(column: Floats) -> bool:
    """False if some value is not finite (or the sum overflows: then they are looked at one by one);
    far cheaper than ``isfinite``."""
    return bool(np.isfinite(np.add.reduce(column)))


def _angle(column: Floats) -> tuple[Floats, str, bool]:
    """An angle's column with what is large taken modulo 360, its kind, and whether finite."""
    finite = True
    if not (column.max() <= LARGE_ANGLE and column.min() >= -LARGE_ANGLE):  # NaN is neither
        with np.errstate(invalid="ignore"):
            turned = np.fmod(column, 360.0)
        column = np.where(np.abs(column) > LARGE_ANGLE, turned, column)
        finite = bool(np.isfinite(column).all())
    if len(column) > 1:
        return column, "array", finite
    return column, _constant_kind(column), finite


def _constant_kind(column: Floats) -> str:
    return {0.0: "0", 1.0: "1"}.get(float(column[0]), "scalar")


def _kind(name: str, column: Floats) -> tuple[str, bool]:
    """The kind of a column of a block, and False when some value may be unusable."""
    alike = len(column) == 1
    if name == "M":
        if alike and column[0] in (4, 6):
            return str(int(column[0])), True
        return ("6" if alike else "mixed"), False
    if name in INERTIAS:
        positive = bool(column.min() > 0)
        if positive and _all_finite(column):
            return ("scalar" if alike else "array"), True
        if alike:
            return ("inf" if column[0] == np.inf else "scalar"), positive
        return "array with infinities", False
    if name == "MU" and not column.min() > PIVOT:
        fine = bool(np.isfinite(column).all())
        pivots = column == PIVOT
        if pivots.any():
            return ("pivot" if alike else "mixed"), fine
        return ("scalar" if alike else "array"), fine
    return (_constant_kind(column) if alike else "array"), _all_finite(column)


def _at_rest_where_infinite(kinds: Mapping[str, str]) -> bool:
    """Whether the kinds alone show that infinite bodies are at rest, and one at most."""
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
    """What cannot be used in ``columns`` (every scene name -> array of one length, or of length 1):
    a number not finite, M neither 4 nor 6, a mass or inertia not above 0, an infinite body that
    moves, two infinite bodies. A point-mass scene is not asked for what it does not look at."""
    point = columns["M"] == 4
    yield Refusal("M", "is neither 4 nor 6", ~(point | (columns["M"] == 6)))
    for name, column in columns.items():
        if name == "M":
            continue
        asked = ~point if name in UNUSED_BY_POINTS else True
        if name in INERTIAS:
            yield Refusal(name, "is not above 0", ~(column > 0) & asked)
        else:
            yield Refusal(name, "is not finite", ~np.isfinite(column) & asked)
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


def _refused(columns: Mapping[str, Floats], length: int) -> NDArray[np.bool_]:
    """Which scenes cannot be used."""
    refused = np.zeros(length, np.bool_)
    for refusal in refusals(columns):
        refused |= refusal.where
    return refused
