"""Frames of any kind in, the same kind out: pandas, polars and pyarrow through narwhals (extra
``frames``), structured arrays, lists of dicts, dicts.

None of these libraries is imported here unless the frame handed over is its own.
"""

import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from ..collision.doubles import is_number
from ..collision.needs import needs_sentences
from ..errors import PlausibilityWarning, UserError, library, quoted
from ..mechanics.closedform.solve import solve
from ..messages.arguments import explains_arguments
from ..names import DEFAULT_M, SCENE
from .cells import TableUnits, check_scene_columns, numbers
from .remarks import remarks
from .rows import (
    BLOCK_ROWS,
    Column,
    Reader,
    Rows,
    heading,
    heading_remarks,
    scene_names,
)

Frame = TypeVar("Frame")
Array = NDArray[Any]


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
    result and NOT_FINITE in STATUS. Texts count as `collision.doubles` reads them.

    Parameters
    ----------
    frame : DataFrame, Table, structured array, list of dict or dict of columns
        A pandas or polars DataFrame, a pyarrow Table and so on, with columns named as the scene's
        (`impact88.names.SCENE`), with their units where they have any (``UX [mph]``): the
        results are then in the same system and say so (``DVA [mph]``). Further columns stay as they
        are; a result takes the place of a column with its name. A pandas index is kept.
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

    Warns
    -----
    PlausibilityWarning
        For sizes that no vehicle has, where the columns have units, vehicles that move sideways (of
        long frames a thousand rows are looked at, and all where one does), EM = 0, and results that
        are left out, as they need a column that is not there.

    Examples
    --------
    >>> rows = impact88.solve_frame([{"MU": 0.5}, {"MU": None}], "LOSS", scene=impact88.sample(1))
    >>> [round(row["LOSS"], 2) for row in rows]
    [44.43, nan]
    """

    frame_names, cells_of = _columns_of(frame)
    if isinstance(frame, list | tuple) and not frame:
        return cast(Frame, [])
    # pandas names columns by numbers, too
    names = [name for name in scene_names(list(map(str, frame_names))) if name in SCENE]
    scene_columns = {name: cells_of(heading(name)) for name in names}
    arrays = {n: np.asanyarray(c) for n, c in scene_columns.items()}
    texts: dict[str, Column]
    texts = {n: list(np.ravel(a)) for n, a in arrays.items() if a.dtype.kind not in "fiu"}
    table = TableUnits(names, units or getattr(scene, "units", None), Rows(0, texts))
    if table.strict:
        _check_units(names, scene_columns, scene or {}, table)
    columns = {n: _numbers(n, values, table) for n, values in scene_columns.items()}
    table.based = SCENE
    for name, value in (scene or {}).items():
        if name in SCENE:
            columns.setdefault(name, _numbers(name, [value], table)[0])
    all_points = "M" in columns and bool(np.all(np.asarray(columns["M"]) == 4))
    check_scene_columns(columns, all_points, "scene=")
    solution = solve(columns, outputs, threads=threads)
    shown = table.shown(solution)
    results = {heading(name): shown[name] for name in table.headings(list(shown))}
    for sentence in needs_sentences(getattr(solution, "absent", {})):
        warnings.warn(sentence, PlausibilityWarning, stacklevel=3)  # in who called this
    cell = partial(_cell, scene_columns, scene)
    for remark in remarks(columns, table.system, cell, False).values():
        place = "1 row, at" if remark.rows == 1 else f"{remark.rows:,} rows, the first at"
        text = f"{place} position {remark.first}: {remark.text}"
        warnings.warn(text, PlausibilityWarning, stacklevel=3)
    return cast(Frame, _with_columns(frame, results))


def _cell(given: Mapping[str, Any], scene: Mapping[str, Any] | None, name: str, at: int) -> str:
    """The text of a cell as it was handed over."""
    column = given.get(name, (scene or {}).get(name))
    if isinstance(column, str):
        return column
    cells = np.ravel(np.asarray(column))
    cell = cells[at % cells.size]
    return f"{float(cell)!r}".removesuffix(".0") if cells.dtype.kind in "fiu" else str(cell)


def _check_units(
    names: Sequence[str],
    given: Mapping[str, Any],
    scene: Mapping[str, Any],
    units: TableUnits,
) -> None:
    """Raise UserError for the first bare number that measures something, where cells have units and
    nothing says what bare numbers are in."""
    scene_columns = {name: [value] for name, value in scene.items() if name in SCENE}
    columns: dict[str, Any] = {
        **scene_columns,
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
                    f"some values have units and {name} = {cell} does not; add a unit, or name a "
                    f'system for numbers without units: units="{system}" (--units {system})'
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


def _columns_of(frame: Any) -> tuple[list[Any], Callable[[Any], Any]]:
    """Return the names of a frame's columns, and a function that returns the cells of one. Raises
    UserError for what is no frame."""
    if isinstance(frame, np.ndarray):
        if frame.dtype.names is None:
            raise UserError(
                f"an array of {frame.dtype} has no columns; expected a structured array, or "
                "impact88.solve with an array for each name"
            )
        return list(frame.dtype.names), lambda name: frame[name]
    if isinstance(frame, Mapping) and not _is_dataset(frame):
        return list(frame), lambda name: frame[name]
    if isinstance(frame, list | tuple):
        if not all(isinstance(row, Mapping) for row in frame):
            raise UserError("expected a list of dicts, one for each scene")
        names = list(dict.fromkeys(name for row in frame for name in row))
        return names, lambda name: [row.get(name) for row in frame]
    table = _table(frame)[1]
    return table.columns, partial(_cells, table)


def _with_columns(frame: Any, results: Mapping[str, Array]) -> Any:
    """Return a frame of the same kind with further columns."""
    if isinstance(frame, np.ndarray):
        columns = {name: frame[name] for name in frame.dtype.names or ()} | {**results}
        extended = np.empty(frame.shape, [(name, column.dtype) for name, column in columns.items()])
        for name, column in columns.items():
            extended[name] = column
        return extended
    if isinstance(frame, Mapping) and not _is_dataset(frame):
        return {**frame, **results}
    if isinstance(frame, list | tuple):
        lists = {name: column.tolist() for name, column in results.items()}
        return [{**row, **{n: c[at] for n, c in lists.items()}} for at, row in enumerate(frame)]
    nw, table = _table(frame)
    make = partial(nw.new_series, native_namespace=nw.get_native_namespace(table))
    spread = [(name, np.broadcast_to(x, (len(table),)).copy()) for name, x in results.items()]
    return table.with_columns(*(make(*column) for column in spread)).to_native()


def _is_dataset(frame: Any) -> bool:
    """Return True for xarray's Dataset, which is a mapping, and of arrays of several dimensions."""
    return hasattr(frame, "data_vars")


def _table(frame: Any) -> tuple[Any, Any]:
    """Return narwhals, and its view of a frame. Raises UserError for what is none."""
    if _is_dataset(frame):
        raise UserError("is an xarray Dataset; expected frame.to_dataframe().reset_index()")
    nw = library("narwhals.stable.v1", "frames", f"a frame of type {type(frame).__name__}")
    try:
        return nw, nw.from_native(frame, eager_only=True)
    except TypeError:
        raise UserError(
            f"{type(frame).__module__}.{type(frame).__name__} is not a frame of values "
            "already computed; expected a DataFrame of pandas or polars, a pyarrow Table, a "
            "structured array or a list of dicts"
        ) from None


def _cells(table: Any, name: str) -> Any:
    series = table[name]
    if series.dtype.is_numeric() and not series.is_null().any():
        return np.asarray(series.to_numpy())
    return np.array(series.to_list(), dtype=object)


@contextmanager
def read_frame(frame: Any) -> Iterator[Reader]:
    """Open a frame that holds results as a table is opened that does: a DataFrame of pandas or
    polars, a pyarrow Table, a structured array, a list of dicts or a dict of columns. Numbers are
    taken as they are held, texts as they are written. Raises UserError for a frame of another
    kind."""
    headings, cells_of = _columns_of(frame.reshape(-1) if isinstance(frame, np.ndarray) else frame)
    columns = [_column(name, cells_of(name)) for name in headings]
    names = scene_names(list(map(str, headings)), "the frame", True)
    sizes = {name: len(column) for name, column in zip(names, columns, strict=True)}
    count = max(sizes.values(), default=0)
    for name, size in sizes.items():
        if size not in (1, count):
            raise UserError(f"column {quoted(heading(name))} has {size} cells, others have {count}")
    spread = [np.broadcast_to(column, (count,)) for column in columns]
    reader = Reader(names, _frame_blocks(names, spread, count), count)
    reader.remarks += heading_remarks(names, True)
    yield reader


def _frame_blocks(names: Sequence[str], columns: Sequence[Array], count: int) -> Iterator[Rows]:
    for first in range(0, count, BLOCK_ROWS):
        parts = (column[first : first + BLOCK_ROWS] for column in columns)
        rows = Rows(min(BLOCK_ROWS, count - first), {})
        for name, part in zip(names, parts, strict=True):
            empty = (
                [at for at, cell in enumerate(part) if cell is None or cell != cell]
                if name in SCENE and part.dtype.kind in "fO"
                else []
            )
            if empty and name == "M":
                part = part.copy()
                part[empty] = float(DEFAULT_M)
            elif empty:
                rows.bad += [(at, name, "is empty; expected a number") for at in empty]
            rows.columns[name] = part if part.dtype.kind in "fiub" else part.tolist()
        yield rows


def _column(name: Any, cells: Any) -> Array:
    """Return a frame's column as an array of one dimension: of numbers, or of objects."""
    if isinstance(cells, np.ma.MaskedArray):
        cells = np.ma.filled(cells.astype(np.float64), np.nan)
    array = np.asarray(cells) if isinstance(cells, np.ndarray | int | float) else None
    if array is None or array.dtype.kind not in "fiub":
        items = [cells] if isinstance(cells, str) or not hasattr(cells, "__len__") else list(cells)
        array = np.empty(len(items), object)
        array[:] = items
    if array.ndim > 1:
        shape = " by ".join(map(str, array.shape))
        raise UserError(
            f"column {quoted(str(name))} is an array of {shape}; expected one dimension"
        )
    return array.reshape(-1)
