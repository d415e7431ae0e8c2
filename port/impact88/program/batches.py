"""Many scenes of one program: columns in, rows of results and printouts out.

The library (`kernel`) runs blocks of scenes in threads. What it leaves, and everything without it,
is run scene by scene: the listing by the port.
"""

from __future__ import annotations

import ctypes
import os
import re
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from ..apple.applesoft.errorcodes import CODES, ApplesoftError
from ..apple.applesoft.operators import Real
from ..errors import UserError
from . import kernel
from .arithmetics import APPLESOFT
from .generate import BEFORE
from .kernel import OUTSIDE, PAGE, Program, Rows
from .run import BELL, run
from .scene import Scene, check_number, complete

Cells = Mapping[str, list[Any]]

LINE_340 = slice(31, 35)
"""The values that line 340 stores, among all that a run stores."""
ROWS = 7  # of the array A
COLUMNS = 8
BLOCK = 4096
"""Scenes of one call of the library: enough for its overhead to vanish, few enough for the
processor's cache."""
END_LINE = 780
ZERO_DETERMINANT_LINE = 1160
_KINDS = {code: kind for kind, code in CODES.items()}
_TYPED = re.compile(r"[ -~]*")
_DISK_COMMAND = re.compile(r"^\x04.*\n", re.M)


def message_of(row: np.void) -> str:
    """Return the message of the error that ended a run."""
    return ApplesoftError(_KINDS[int(row["code"]) & 0xFF], int(row["line"])).message


def read_columns(columns: Mapping[str, Any]) -> Cells:
    """Return the texts of each input, or one for all scenes. Raises UserError."""
    cells = {name: _texts(name, column) for name, column in complete(columns).items()}
    sizes = {name: len(column) for name, column in cells.items() if len(column) != 1}
    if len({*sizes.values()}) > 1:
        lengths = ", ".join(f"{name} {size}" for name, size in sizes.items())
        raise UserError(f"columns of different lengths: {lengths}")
    return cells


def _texts(name: str, column: Any) -> list[Any]:
    """Return a column as a list of texts. Raises UserError for what is neither text nor a whole
    number."""
    if isinstance(column, (str, int, np.integer)):
        column = [column]
    try:
        cells = column.tolist() if isinstance(column, np.ndarray) else list(column)
    except TypeError:
        raise UserError(f"{column!r:.60} is no text and no column of texts", name) from None
    if set(map(type, cells)) != {str} or not _TYPED.fullmatch("".join(cells)):
        cells = [str(cell) if isinstance(cell, (int, np.integer)) else cell for cell in cells]
        for row, cell in enumerate(cells, 1):
            check_number(name, cell, f"row {row}")
    return cells


def run_scenes(
    program: Program | None,
    columns: Mapping[str, Any],
    run_singly: Callable[[Rows, Scene], str],
    sizes: tuple[int, int],
    pages: bool,
    threads: int | None = None,
) -> tuple[Rows, list[str]]:
    """Return the rows of results of scenes, and their printouts, "" without pages.

    ``run_singly``: runs a scene that the library leaves, which are all without it, fills its row,
    and returns its printout; ``sizes``: of array and fields in a row, see `kernel.row_type`. Raises
    UserError for columns that cannot be used."""
    cells = read_columns(columns)
    variables = len(program.steps.variables) if program else 0
    count = max({len(column) for column in cells.values()} - {1}, default=1)
    rows = np.zeros(count, kernel.row_type(variables, *sizes))
    printouts = [""] * count

    def work(start: int) -> None:
        part = rows[start : start + BLOCK]
        buffer = ctypes.create_string_buffer(PAGE * len(part)) if pages else None
        if program and kernel.compiled_library():
            texts = [cells[name] for name in program.names]
            program.run(
                [t if len(t) == 1 else t[start : start + BLOCK] for t in texts], part, buffer
            )
        else:
            part["code"] = OUTSIDE
        characters = buffer.raw if buffer else b""
        codes, sizes = part["code"].tolist(), part["size"].tolist()
        for row in range(len(part)) if characters else part["code"].nonzero()[0].tolist():
            code = codes[row]
            if code in (OUTSIDE, CODES["OVERFLOW"]):  # of a text, too, that is no number
                scene = _scene(cells, start + row)
            if code == OUTSIDE:
                printouts[start + row] = run_singly(part[row : row + 1], scene)
            else:
                page = characters[PAGE * row : PAGE * row + sizes[row]].decode("ascii")
                message = f"\n{message_of(part[row]).replace(' IN', BELL + ' IN')}" if code else ""
                printouts[start + row] = _DISK_COMMAND.sub("", page) + message

    starts = range(0, len(rows), BLOCK)
    with ThreadPoolExecutor(threads or os.cpu_count()) as pool:  # the library runs without the GIL
        list((pool.map if len(starts) > 1 else map)(work, starts))
    return rows, printouts


def _scene(cells: Cells, row: int) -> Scene:
    """Return the scene of a row. Raises UserError if its texts cannot be typed."""
    texts = {name: column[row % len(column)] for name, column in cells.items()}
    scene = Scene(texts, source=f"row {row + 1}")
    scene.check_typed()
    return scene


def run_port(rows: Rows, scene: Scene) -> str:
    """Run a scene by the port, fill its row and return its printout."""
    fields: list[str] = []
    stores: list[Real] = []

    def write(x: Real) -> str:
        fields.append(APPLESOFT.write(x))
        return fields[-1]

    def store(x: Real) -> Real:
        stores.append(APPLESOFT.LET(x))
        return stores[-1]

    record = run(scene, APPLESOFT._replace(write=write, LET=store))
    ending = ZERO_DETERMINANT_LINE if record.zero_determinant else END_LINE
    rows["code"] = CODES.get((record.error or "")[1:].partition(" ERROR")[0], 0)
    rows["line"] = record.line or ending
    rows["fields"][0, : len(fields)] = fields
    if record.A:
        rows["array"] = list(map(_stored_number, record.A["data"]))
    before = {f"{n}'": x.to_bytes().hex() for n, x in zip(BEFORE, stores[LINE_340], strict=False)}
    values = {**record.reals, **before}
    for k, name in enumerate(kernel.listing().steps.variables):
        rows["reals"][0, k] = _stored_number(values.get(name, "0"))
    return record.printout


def _stored_number(text: str) -> int:
    """Return stored bytes as a number; of a zero all are 0."""
    return 0 if text.startswith("00") else int(text, 16)
