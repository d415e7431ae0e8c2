"""Frames of any kind in, the same kind out: pandas, polars and pyarrow through narwhals (extra
``frames``), xarray by the names of its dimensions, structured arrays, lists of dicts, dicts.

None of these libraries is imported here unless the frame handed over is its own.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from ..arguments import explains_arguments
from ..closedform.solve import solve
from ..doubles import is_number
from ..errors import UserError, library
from ..names import DEFAULT_M, SCENE
from .cells import TableUnits, check_scene_columns, numbers
from .rows import Column, Rows, heading, scene_names

Frame = TypeVar("Frame")
Array = NDArray[Any]
Solver = Callable[[Sequence[str], Callable[[str], Any]], dict[str, Array]]


@explains_arguments
def solve_frame(
    frame: Frame,
    outputs: Sequence[str] | str | None = None,
    *,
    scene: Mapping[str, Any] | None = None,
    units: str | None = None,
    threads: int | None = None,
) -> Frame:
    """Solve the impact of every row, and return the frame with the results as further columns.

    A row whose cell is missing (None, NaN, masked, null), no number or not allowed has NaN in every
    result and NOT_FINITE in STATUS. Texts count as `impact88.doubles` reads them.

    Parameters
    ----------
    frame : DataFrame, Table, Dataset, structured array, list of dict or dict of columns
        A pandas or polars DataFrame, a pyarrow Table, an xarray Dataset and so on, with columns
        named as the scene's (`impact88.names.SCENE`), with their units where they have any (``UX
        [mph]``): the results are then in the same system and say so (``DVA [mph]``). Further
        columns stay as they are; a result takes the place of a column with its name. A pandas index
        is kept.
    outputs : sequence of str, or str, optional
        The result names wanted; all by default.
    scene : mapping of str to str or float, optional
        Values for the columns the frame lacks, such as ``impact88.sample(1)``; M is 6 where it is
        not given.
    units : {"us", "chapter", "metric", "si"}, optional
        The system of columns that name no unit.
    threads : int, optional
        As for `impact88.solve`.

    Returns
    -------
    Frame
        The same kind of frame; results are float64 (STATUS: a whole number).

    Raises
    ------
    UserError
        For a frame of another kind, a missing scene column, and where narwhals is needed and not
        installed.

    Examples
    --------
    >>> rows = impact88.solve_frame([{"MU": 0.5}, {"MU": None}], "LOSS", scene=impact88.sample(1))
    >>> [round(row["LOSS"], 2) for row in rows]
    [44.43, nan]
    """

    def solved(names: Sequence[str], column: Callable[[str], Any]) -> dict[str, Array]:
        """The results of a frame's columns, by heading."""
        # pandas names columns by numbers, too
        found = [name for name in scene_names(list(map(str, names))) if name in SCENE]
        given = {name: column(heading(name)) for name in found}
        arrays = {n: np.asanyarray(c) for n, c in given.items()}
        texts: dict[str, Column]
        texts = {n: list(np.ravel(a)) for n, a in arrays.items() if a.dtype.kind not in "fiu"}
        table = TableUnits(found, units or getattr(scene, "units", None), Rows(0, texts))
        if table.strict:
            _check_units(found, given, scene or {}, table)
        columns = {n: _numbers(n, values, table) for n, values in given.items()}
        table.based = SCENE
        for name, value in (scene or {}).items():
            if name in SCENE:
                columns.setdefault(name, _numbers(name, [value], table)[0])
        all_points = "M" in columns and bool(np.all(np.asarray(columns["M"]) == 4))
        check_scene_columns(columns, all_points, "scene=")
        results = table.shown(solve(columns, outputs, threads=threads))
        return {heading(name): results[name] for name in table.headings(list(results))}

    is_dataset = type(frame).__module__.partition(".")[0] == "xarray"
    result: Any
    if isinstance(frame, np.ndarray):
        result = _structured(frame, solved)
    elif isinstance(frame, Mapping) and not is_dataset:
        result = {**frame, **solved(list(frame), lambda name: frame[name])}
    elif isinstance(frame, list | tuple):
        result = _dicts(frame, solved)
    else:
        result = (_dataset if hasattr(frame, "data_vars") else _narwhals)(frame, solved)
    return cast(Frame, result)


def _check_units(
    names: Sequence[str],
    given: Mapping[str, Any],
    scene: Mapping[str, Any],
    units: TableUnits,
) -> None:
    """Raise UserError for the first bare number that measures something, where cells have units and
    nothing says what bare numbers are in."""
    beside = {name: [value] for name, value in scene.items() if name in SCENE}
    columns: dict[str, Any] = {
        **beside,
        **{str(name): np.ravel(given[heading(name)]) for name in names},
    }
    for name, cells in columns.items():
        if not units.leaves_open(name):
            continue
        for cell in cells:
            bare = isinstance(cell, int | float | np.number) or (
                isinstance(cell, str) and is_number(cell)
            )
            if bare and cell == cell and float(cell):
                system = units.system.name
                raise UserError(
                    f"{name} = {cell} has no unit, and others have; expected one, or "
                    f'units="{system}" for bare numbers (--units {system})'
                )


def _numbers(name: str, values: Any, units: TableUnits) -> Array:
    """Cells as doubles in base units, NaN for what is missing or no number; of M, 6."""
    if isinstance(values, np.ma.MaskedArray):
        values = np.ma.filled(values.astype(np.float64), np.nan)
    array = np.asarray(values)
    cells = array.reshape(-1)
    if name == "M" and array.dtype.kind in "fO":
        absent = [cell is None or cell != cell for cell in cells]
        cells = np.where(absent, float(DEFAULT_M), cells)
    column = cells if array.dtype.kind in "fiu" else cells.tolist()
    return numbers(Rows(array.size, {name: column}), units)[name].reshape(array.shape)


def _structured(frame: Array, solved: Solver) -> Array:
    names = frame.dtype.names
    if names is None:
        raise UserError(
            f"an array of {frame.dtype} has no columns; expected a structured array, or "
            "impact88.solve with an array for each name"
        )
    columns = {n: frame[n] for n in names}
    extended = columns | solved(names, lambda name: columns[name])
    result = np.empty(frame.shape, [(name, column.dtype) for name, column in extended.items()])
    for name, column in extended.items():
        result[name] = column
    return result


def _dicts(rows: Sequence[Any], solved: Solver) -> list[dict[str, Any]]:
    if not all(isinstance(row, Mapping) for row in rows):
        raise UserError("expected a list of dicts, one for each scene")
    if not rows:
        return []
    names = list(dict.fromkeys(name for row in rows for name in row))
    found = solved(names, lambda name: [row.get(name) for row in rows])
    results = {name: column.tolist() for name, column in found.items()}
    return [{**row, **{n: c[at] for n, c in results.items()}} for at, row in enumerate(rows)]


def _dataset(frame: Any, solved: Solver) -> Any:
    """An xarray Dataset: dimensions of the same name belong together."""
    import xarray

    names = [heading(name) for name in scene_names(list(frame)) if name in SCENE]
    lazy = [name for name in names if frame[name].chunks is not None]
    if lazy:
        raise UserError(
            f"{lazy[0]} is not computed yet; expected frame.compute(), or "
            "xarray.map_blocks(impact88.solve_frame, frame)"
        )
    spread = xarray.broadcast(*(frame[name] for name in names))
    columns = {n: column.values for n, column in zip(names, spread, strict=True)}
    dims = spread[0].dims if spread else ()
    results = solved(names, columns.__getitem__)
    return frame.assign({name: (dims, array) for name, array in results.items()})


def _narwhals(frame: Any, solved: Solver) -> Any:
    nw = library("narwhals.stable.v1", "frames", f"a frame of type {type(frame).__name__}")
    try:
        table = nw.from_native(frame, eager_only=True)
    except TypeError:
        raise UserError(
            f"{type(frame).__module__}.{type(frame).__name__} is not a frame of values "
            "already computed; expected a DataFrame of pandas or polars, a pyarrow Table, an "
            "xarray Dataset, a structured array or a list of dicts"
        ) from None

    def cells(name: str) -> Any:
        series = table[name]
        if series.dtype.is_numeric() and not series.is_null().any():
            return np.asarray(series.to_numpy())
        return np.array(series.to_list(), dtype=object)

    make = partial(nw.new_series, native_namespace=nw.get_native_namespace(table))
    results = solved(table.columns, cells).items()
    spread = ((name, np.broadcast_to(array, (len(table),)).copy()) for name, array in results)
    return table.with_columns(*(make(*column) for column in spread)).to_native()
