"""Frames of any kind in, the same kind out: pandas, polars and pyarrow through narwhals (extra
``frames``), xarray by the names of its dimensions, structured arrays, lists of dicts, dicts.

None of these libraries is imported here unless the frame handed over is its own.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from .. import doubles
from ..closedform.columns import UNUSED_BY_POINTS
from ..closedform.solve import solve
from ..errors import UserError
from ..names import DEFAULT_M, SCENE
from .rows import check_scene_columns

Frame = TypeVar("Frame")
Array = NDArray[Any]
Solver = Callable[[Mapping[str, Array]], dict[str, Array]]


def solve_frame(
    frame: Frame,
    outputs: Sequence[str] | str | None = None,
    *,
    scene: Mapping[str, Any] | None = None,
    threads: int | None = None,
) -> Frame:
    """Solve the impact of every row, and return the frame with the results as further columns.

    Args:
        frame: a pandas or polars DataFrame, a pyarrow Table, an xarray Dataset, a structured
            array, a list of dicts or a dict of columns, with columns named as the scene's
            (``impact88.names.SCENE``). Further columns stay as they are; a result takes the place
            of a column with its name. A pandas index is kept.
        outputs: the result names wanted, all of them by default.
        scene: values for the columns the frame lacks, such as ``impact88.sample(1)``; M is 6
            where it is given nowhere.
        threads: as for `impact88.solve`.

    Returns:
        the same kind of frame; results are float64 (STATUS: a whole number).

    A row whose cell is missing (None, NaN, masked, null), no number or not allowed has NaN in every
    result and NOT_FINITE in STATUS. Texts count as `impact88.doubles` reads them.

    Raises UserError for a frame of another kind, a missing scene column, and where narwhals is
    needed and not installed.
    """

    def solver(columns: Mapping[str, Array]) -> dict[str, Array]:
        given = dict(columns)
        for name, value in (scene or {}).items():
            if name in SCENE:
                given.setdefault(name, _numbers([value])[0])
        all_points = "M" in given and bool(np.all(np.asarray(given["M"]) == 4))
        check_scene_columns(
            list(given), (), ("M", *(UNUSED_BY_POINTS if all_points else ())), "scene="
        )
        return solve(given, outputs, threads=threads)

    kind = type(frame)
    result: Any
    if isinstance(frame, np.ndarray):
        result = _structured(frame, solver)
    elif isinstance(frame, Mapping) and kind.__module__.partition(".")[0] != "xarray":
        result = {**frame, **solver({n: _numbers(frame[n]) for n in SCENE if n in frame})}
    elif isinstance(frame, list | tuple):
        result = _dicts(frame, solver)
    elif hasattr(frame, "data_vars"):
        result = _dataset(frame, solver)
    else:
        result = _narwhals(frame, solver)
    return result


def _numbers(values: Any) -> Array:
    """Cells as doubles, NaN for what is missing or no number."""
    if isinstance(values, np.ma.MaskedArray):
        return np.ma.filled(values.astype(np.float64), np.nan)
    array = np.asarray(values)
    if array.dtype.kind in "fiu":
        return array
    cells = array.reshape(-1).tolist()
    return np.array([_number(cell) for cell in cells], np.float64).reshape(array.shape)


def _number(cell: Any) -> float:
    if isinstance(cell, str):
        try:
            return doubles.double(cell)
        except ValueError:
            return float("inf") if cell.strip().lower() == "inf" else float("nan")
    if cell is None or isinstance(cell, bool):
        return float("nan")
    try:
        return float(cell)
    except (TypeError, ValueError):
        return float("nan")


def _structured(frame: Array, solver: Solver) -> Array:
    names = frame.dtype.names
    if names is None:
        raise UserError(
            f"an array of {frame.dtype} has no columns; expected a structured array, or "
            "impact88.solve with an array for each name"
        )
    columns = {n: frame[n] for n in names}
    whole = columns | solver({n: _numbers(columns[n]) for n in SCENE if n in columns})
    result = np.empty(frame.shape, [(name, column.dtype) for name, column in whole.items()])
    for name, column in whole.items():
        result[name] = column
    return result


def _dicts(rows: Sequence[Any], solver: Solver) -> list[dict[str, Any]]:
    if not all(isinstance(row, Mapping) for row in rows):
        raise UserError("expected a list of dicts, one for each scene")
    names = [name for name in SCENE if any(name in row for row in rows)]
    default = {"M": float(DEFAULT_M)}
    columns = {n: _numbers([row.get(n, default.get(n)) for row in rows]) for n in names}
    if not rows:
        return []
    results = {name: column.tolist() for name, column in solver(columns).items()}
    return [
        {**row, **{name: column[at] for name, column in results.items()}}
        for at, row in enumerate(rows)
    ]


def _dataset(frame: Any, solver: Solver) -> Any:
    """An xarray Dataset: dimensions of the same name belong together."""
    import xarray

    names = [name for name in SCENE if name in frame]
    lazy = [name for name in names if frame[name].chunks is not None]
    if lazy:
        raise UserError(
            f"{lazy[0]} is not computed yet; expected frame.compute(), or "
            "xarray.map_blocks(impact88.solve_frame, frame)"
        )
    spread = xarray.broadcast(*(frame[name] for name in names))
    columns = {n: _numbers(column.values) for n, column in zip(names, spread, strict=True)}
    dims = spread[0].dims if spread else ()
    return frame.assign({name: (dims, array) for name, array in solver(columns).items()})


def _narwhals(frame: Any, solver: Solver) -> Any:
    try:
        import narwhals.stable.v1 as nw
    except ImportError:
        raise UserError(
            f"a frame of type {type(frame).__name__} needs narwhals; pip install 'impact88[frames]'"
        ) from None
    try:
        table = nw.from_native(frame, eager_only=True)
    except TypeError:
        raise UserError(
            f"{type(frame).__module__}.{type(frame).__name__} is no frame that is known here and "
            "computed already; expected a DataFrame of pandas or polars, a pyarrow Table, an "
            "xarray Dataset, a structured array or a list of dicts"
        ) from None
    columns = {name: _series(name, table[name], nw) for name in SCENE if name in table.columns}
    results = solver(columns)
    backend = nw.get_native_namespace(table)
    count = len(table)
    return table.with_columns(
        *(
            nw.new_series(name, np.broadcast_to(array, (count,)).copy(), native_namespace=backend)
            for name, array in results.items()
        )
    ).to_native()


def _series(name: str, series: Any, nw: Any) -> Array:
    if series.dtype.is_numeric() and not series.is_null().any():
        return np.asarray(series.to_numpy())
    cells = series.to_list()
    if name == "M":
        cells = [DEFAULT_M if cell is None or cell != cell else cell for cell in cells]
    return _numbers(np.array(cells, dtype=object))
