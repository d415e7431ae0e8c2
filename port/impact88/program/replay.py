"""Many scenes through the 1988 listing at once: columns in; pages, fields, reals and errors out.

The listing is compiled from ``impact.bas`` (`compiler`) and executed by `applesoft.c`; without the
library the port runs each scene. Both give the Apple's own bits.
"""

from __future__ import annotations

import ctypes
import os
import re
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import numpy.typing as npt

from ..apple.applesoft.errorcodes import CODES, ApplesoftError
from ..apple.applesoft.operators import Real
from ..errors import UserError
from ..names import FINAL_VELOCITIES, check_names
from . import kernel
from .arithmetics import APPLESOFT
from .generate import BEFORE
from .kernel import OUTSIDE, PAGE, Program, Rows
from .run import BELL, run
from .scene import Scene, check_number, complete

Mask = npt.NDArray[np.bool_]
Texts = npt.NDArray[np.str_]
Stored = npt.NDArray[np.uint64]
Floats = npt.NDArray[np.float64]
Cells = Mapping[str, list[Any]]

PRINTED = (
    "MA MB IA IB DA DB PA PB TA TB GA UX UY WA XA YA VX VY WB XB YB E MUP EM KI LOSS "
    "VAX VAY XAF YAF VBX VBY XBF YBF WAF WBF"
).split()
"""The numbers of a page in printing order."""

COMPUTED = {
    name: line
    for line, names in (
        (320, "KI"),
        (340, "XA YA XB YB"),
        (400, "MUP"),
        (570, "VAX VAY VBX VBY WAF WBF"),
        (590, "KF"),
        (690, "LOSS"),
        (700, "XAF YAF"),
        (710, "XBF YBF"),
    )
    for name in names.split()
}
"""The results, and the line after which the program has each."""

LINE_340 = slice(31, 35)
"""The values that line 340 stores, among all that a run stores."""
ROWS = 7  # of the array A
COLUMNS = 8
BLOCK = 4096
"""Scenes of one call of the library: enough for its overhead to vanish, few enough for the
processor's cache."""
END_LINE = 780
ZERO_DETERMINANT_LINE = 1160
CALL_LINE = 570  # calls the subroutines
FIRST_SUBROUTINE = 1000
FINAL_SPINS = ("WAF", "WBF")
"""Results that line 750 passes over unless M is N."""
_VARIABLES = (
    {"MUP": "MU"} | {name: f"{name}'" for name in BEFORE} | {f"{name}F": name for name in BEFORE}
)
"""Results that are another variable of the listing."""
_KINDS = {code: kind for kind, code in CODES.items()}
_TYPED = re.compile(r"[ -~]*")
_DISK_COMMAND = re.compile(r"^\x04.*\n", re.M)


class Replay:
    """The results of `replay`, a value for each scene; names as in `impact88.names`.

    A scene that ended with an error has the results of the lines before. Later ones are NaN as
    floats, 0 as stored reals and "" as printed fields (see `present`).

    Attributes
    ----------
    names : tuple of str
        The names of the results.
    error : ndarray of str
        The message that ended each scene, "" without one. ZERO DETERMINANT is a normal end.
    line : ndarray of int
        The line at which the scene ended early (1160 for ZERO DETERMINANT), else 0.
    zero_determinant : ndarray of bool
        True for each scene that ended with ZERO DETERMINANT.
    fields : ndarray of bytes
        The printed numbers, a row for each scene and a column for each name of `PRINTED`.
    pages : list of str or None
        All that each scene printed, if that was asked for, as `Run.printout`.

    Examples
    --------
    >>> results = impact88.replay({**impact88.sample(1), "MU": [".5", ".911"]})
    >>> results.printed("LOSS").tolist()
    ['44.43', '57.47']
    """

    names = tuple(COMPUTED)

    def __init__(self, rows: Rows, pages: list[str] | None) -> None:
        code, line = rows["code"], rows["line"]
        self.zero_determinant = (code == 0) & (line == ZERO_DETERMINANT_LINE)
        self.line = np.where(line == END_LINE, 0, line)
        self.error = np.full(len(rows), "", "<U48")
        for row in code.nonzero()[0]:
            self.error[row] = _message(rows[row])
        self.fields = rows["fields"]
        self.pages = pages
        self._rows = rows
        self._main_line = np.where(line >= FIRST_SUBROUTINE, CALL_LINE, line)

    def __len__(self) -> int:
        return len(self._rows)

    def present(self, name: str) -> Mask:
        """Return a mask of the scenes that have a result.

        Parameters
        ----------
        name : str
            A name of `COMPUTED`.

        Returns
        -------
        ndarray of bool
            True for each scene that got past the line of the result.
        """
        check_names([name], COMPUTED, "result of a replay")
        present = self._main_line > COMPUTED[name]
        if name in FINAL_SPINS:
            present &= self.printed(name) != ""
        return present

    def printed(self, name: str) -> Texts:
        """Return a field of the printout, character for character.

        Parameters
        ----------
        name : str
            A name of `PRINTED`; the MU that line 680 prints is MUP.

        Returns
        -------
        ndarray of str
            The field of each scene, such as "-8.78" or "5E-03", "" for a scene that ended before
            it.
        """
        check_names([name], PRINTED, "printed field")
        return self.fields[:, PRINTED.index(name)].astype(str)

    def reals(self, name: str) -> Stored:
        """Return a variable or result as the five bytes that the Apple stored.

        Parameters
        ----------
        name : str
            A variable of the listing, whose last value counts, or a result; LOSS is none, because
            the program prints it without storing it.

        Returns
        -------
        ndarray of uint64
            The bytes of each scene as one number, which ``f"{x:010x}"`` writes in hexadecimal; 0
            for a zero, and for a scene without the result.
        """
        if name in FINAL_VELOCITIES:  # in column M + 1 of the array A
            column = np.clip(unpack(self.reals("M")), 0, COLUMNS - 2).astype(int) + 1
            place = FINAL_VELOCITIES.index(name) + 1 + ROWS * column
            values: Stored = self._rows["array"][np.arange(len(self)), place]
        else:
            variables = kernel.listing().steps.variables
            variable = _VARIABLES.get(name, name)
            check_names([variable], variables, "variable of the listing")
            values = self._rows["reals"][:, variables.index(variable)]
        return values * self.present(name) if name in COMPUTED else values

    def floats(self, name: str) -> Floats:
        """Return a result as floats: stored reals exactly, LOSS as the printed number.

        Parameters
        ----------
        name : str
            A variable of the listing, or a result.

        Returns
        -------
        ndarray of float
            The result of each scene, NaN for a scene without it.
        """
        if name == "LOSS":
            texts = self.printed(name)
            return np.where(texts == "", "nan", texts).astype(float)
        values = unpack(self.reals(name))
        return np.where(self.present(name), values, np.nan) if name in COMPUTED else values


def _message(row: np.void) -> str:
    """Return the message of the error that ended a run."""
    return ApplesoftError(_KINDS[int(row["code"]) & 0xFF], int(row["line"])).message


def unpack(stored: Stored) -> Floats:
    """Return stored reals as floats, exactly."""
    words = stored.astype(np.int64)
    exponent = words >> 32
    sizes = np.ldexp((words & 0x7FFFFFFF | 0x80000000).astype(float), exponent - 160)
    return np.where(exponent == 0, 0.0, np.where(words >> 31 & 1, -sizes, sizes))


def replay(
    columns: Mapping[str, Any], *, pages: bool = False, threads: int | None = None
) -> Replay:
    """Run the 1988 listing's own arithmetic on many scenes at once.

    Every bit is that of an Apple II Plus. A scene that ends with an error there ends with the same
    error here, without affecting the others.

    Parameters
    ----------
    columns : mapping of str to str, int, or sequence of them
        Values by the scene's names (`impact88.names.SCENE`; M defaults to 6), each one value for
        all scenes or a column of n. A value is decimal text, which Applesoft reads digit by digit
        (so "90315.8817" and "90315.88170" differ in the last bit), or a whole number, which means
        its digits. Floats are refused, because the digits typed matter.
    pages : bool, default False
        Keep all that each scene prints.
    threads : int, optional
        Maximum number of threads; by default one for each processor.

    Returns
    -------
    Replay
        The results as printed, as stored reals and as floats; each scene's error and its line.

    Raises
    ------
    UserError
        For columns that cannot be used.

    Notes
    -----
    All lines of the listing, from its first prompt to END. Some 10 microseconds and 1.4 kB a
    scene; without the compiled library, as long as `run` takes for each.

    Examples
    --------
    >>> impact88.replay(impact88.sample(1)).printed("XB").tolist()
    ['14.51']
    """
    rows, printouts = run_scenes(
        kernel.listing(), columns, _run_port, (ROWS * COLUMNS, len(PRINTED)), pages, threads
    )
    return Replay(rows, printouts if pages else None)


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
                message = f"\n{_message(part[row]).replace(' IN', BELL + ' IN')}" if code else ""
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


# --- one scene by the port ---


def _run_port(rows: Rows, scene: Scene) -> str:
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
