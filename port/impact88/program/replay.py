"""Many scenes through the 1988 listing at once: columns in; pages, fields, reals and errors out.

The listing is compiled from ``impact.bas`` (`compiler`) and executed by `applesoft.c`; without the
library the port runs each scene. Both give the Apple's own bits.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ..apple.applesoft.errorcodes import CODES, ApplesoftError
from ..apple.applesoft.operators import Real
from ..errors import UserError
from ..names import DEFAULT_M, FINAL_VELOCITIES, SCENE, check_names, missing
from . import kernel
from .arithmetics import APPLESOFT, Arithmetic
from .generate import BEFORE
from .kernel import OUTSIDE, PAGE, Program, Results, empty_results
from .run import BELL, Run, run
from .scene import Scene

Mask = npt.NDArray[np.bool_]
Texts = npt.NDArray[np.str_]
Stored = npt.NDArray[np.uint64]
Floats = npt.NDArray[np.float64]
Cells = Mapping[str, list[Any]]

PRINTED = {
    name: line
    for line, names in (
        (620, "MA MB IA IB"),
        (630, "DA DB"),
        (650, "PA PB TA TB GA"),
        (660, "UX UY WA XA YA"),
        (670, "VX VY WB XB YB"),
        (680, "E MUP EM"),
        (690, "KI LOSS"),
        (730, "VAX VAY XAF YAF"),
        (740, "VBX VBY XBF YBF"),
        (760, "WAF WBF"),
    )
    for name in names.split()
}
"""The numbers of a page in printing order, and the line that prints each."""

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

ROWS, COLUMNS = 7, 8  # of the array A
ZERO_DETERMINANT_LINE = 1160
FIRST_SUBROUTINE = 1000
"""Line from which on the program is in a subroutine that line 570 calls."""
FINAL_SPINS = ("WAF", "WBF")
"""Results that line 750 passes over unless M is N."""
_VARIABLES = (
    {"MUP": "MU"} | {name: f"{name}'" for name in BEFORE} | {f"{name}F": name for name in BEFORE}
)
"""Results that are another variable of the listing."""
_KINDS = {code: kind for kind, code in CODES.items()}
_DISK_COMMAND = re.compile(r"^\x04.*\n", re.M)


class Replay:
    """The results of `replay`, a value for each scene; names as in `impact88.names`.

    A scene that ended with an error has the results of the lines before. Later ones are NaN as
    floats, 0 as stored reals and "" as printed fields (see `present`).

    Attributes
    ----------
    count : int
        The number of scenes.
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

    def __init__(self, results: Results, pages: list[str] | None) -> None:
        code, line = results.ending[:, 0], results.ending[:, 1]
        self.count = len(code)
        self.zero_determinant = (code == 0) & (line == ZERO_DETERMINANT_LINE)
        self.line = np.where((code != 0) | self.zero_determinant, line, 0)
        self.error = np.full(self.count, "", "<U48")
        for at in code.nonzero()[0].tolist():
            self.error[at] = _error(results, at).message
        self.fields = results.fields
        self.pages = pages
        self._results = results
        # while a subroutine runs, the main program is in line 570
        in_main = np.where(self.line >= FIRST_SUBROUTINE, 570, self.line)
        self._reached = np.where(self.line == 0, FIRST_SUBROUTINE, in_main)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the results."""
        return tuple(COMPUTED)

    def __len__(self) -> int:
        return self.count

    def __repr__(self) -> str:
        errors = int(np.count_nonzero(self.error != ""))
        return (
            f"<Replay of {self.count:,} scenes: {errors:,} ended by an error, "
            f"{int(self.zero_determinant.sum()):,} by a zero determinant>"
        )

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
        present = self._reached > COMPUTED[name]
        if name in FINAL_SPINS:
            present &= self.reals("N") == self.reals("M")
        return present

    def printed(self, name: str) -> Texts:
        """Return a field of the printout, character for character.

        Parameters
        ----------
        name : str
            A name of `PRINTED`; MU is the MUP that line 680 prints.

        Returns
        -------
        ndarray of str
            The field of each scene, such as "-8.78" or "5E-03", "" for a scene that ended before
            it.
        """
        check_names([name], [*PRINTED, "MU"], "printed field")
        column = list(PRINTED).index("MUP" if name == "MU" else name)
        return self.fields[:, column].astype(str)

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
            values = np.take_along_axis(self._results.array, place[:, None], 1)[:, 0]
        else:
            variables = kernel.listing().steps.variables
            check_names([_VARIABLES.get(name, name)], variables, "variable of the listing")
            values = self._results.reals[:, variables.index(_VARIABLES.get(name, name))]
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

    def to_dict(self) -> dict[str, npt.NDArray[Any]]:
        """Return all results as columns of one length, which a DataFrame of any library takes.

        Returns
        -------
        dict of str to ndarray
            Every result as floats, and of each scene ERROR, the message that ended it, and LINE.
        """
        ending = np.where(self.zero_determinant, "ZERO DETERMINANT", self.error)
        results = {name: self.floats(name) for name in self.names}
        return {**results, "ERROR": ending, "LINE": self.line}


def _error(results: Results, row: int) -> ApplesoftError:
    code, line, *_ = results.ending[row].tolist()
    return ApplesoftError(_KINDS[code & 0xFF], line)


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
    cells = read_columns(columns)
    variables = kernel.listing().steps.variables
    results = empty_results(_count(cells), len(variables), ROWS * COLUMNS, len(PRINTED))

    def run_port(row: int, scene: Scene) -> str:
        numbers: list[str] = []
        record = run(scene, _recording(numbers))
        _fill(results, row, record, numbers)
        return record.printout

    texts = run_scenes(kernel.listing(), cells, results, run_port, pages, threads)
    return Replay(results, texts if pages else None)


def read_columns(columns: Mapping[str, Any]) -> Cells:
    """Return the texts of each input, or one for all scenes. Raises UserError."""
    if not isinstance(columns, Mapping):
        raise UserError(f"{columns!r:.60} is not a mapping of names to columns")
    check_names(columns, SCENE, "value of a scene")
    if names := [name for name in SCENE if name not in columns and name != "M"]:
        raise UserError(missing(names))
    cells = {name: _texts(name, columns.get(name, DEFAULT_M)) for name in SCENE}
    if len({len(column) for column in cells.values()} - {1}) > 1:
        sizes = ", ".join(f"{name} {len(c)}" for name, c in cells.items() if len(c) != 1)
        raise UserError(f"columns of different lengths: {sizes}")
    return cells


def _texts(name: str, column: Any) -> list[Any]:
    """Return a column as a list of texts. Raises UserError for what is neither text nor a whole
    number."""
    if isinstance(column, (str, int, np.integer)):
        column = [column]
    try:
        cells = column if isinstance(column, list) else list(column)
    except TypeError:
        raise UserError(f"{column!r:.60} is no text and no column of texts", name) from None
    try:
        "".join(cells)  # faster than looking at each
        return cells
    except TypeError:
        pass
    for row, cell in enumerate(cells):
        if isinstance(cell, bool) or not isinstance(cell, (str, int, np.integer)):
            raise UserError(
                f"{cell!r:.60} is not a number as typed; expected a text or a whole number",
                f"{name}, row {row + 1}",
            )
    return list(map(str, cells))


def _count(cells: Cells) -> int:
    """Return the number of scenes: 1 where no column has another length."""
    return next((len(column) for column in cells.values() if len(column) != 1), 1)


def run_scenes(
    program: Program | None,
    cells: Cells,
    results: Results,
    run_singly: Callable[[int, Scene], str],
    pages: bool,
    threads: int | None = None,
) -> list[str]:
    """Run scenes, fill their results and return their printouts, "" without ``pages``.

    ``run_singly``: runs the scene of a row that the library leaves, which are all without it.
    Raises UserError for a text that is not a number."""
    printouts = [""] * len(results.ending)

    def work(start: int, stop: int) -> None:
        part = Results._make(array[start:stop] for array in results)
        code = np.full(stop - start, OUTSIDE)
        text = np.empty((stop - start, PAGE if pages else 0), "S1")
        if program and kernel.compiled_library():
            columns = [cells[name] for name in program.names]
            columns = [column if len(column) == 1 else column[start:stop] for column in columns]
            try:
                program.run(columns, part, text if pages else None)
            except ValueError:  # other characters than ASCII's, or several lines
                for row in range(start, stop):
                    _scene(cells, row)
                raise
            code = part.ending[:, 0]
        characters = text.tobytes()
        sizes = part.ending[:, 2].tolist()
        rows = range(stop - start) if pages else code.nonzero()[0].tolist()
        for row in rows:
            if code[row] == OUTSIDE:
                printouts[start + row] = run_singly(start + row, _scene(cells, start + row))
            elif code[row] == CODES["OVERFLOW"]:
                _scene(cells, start + row)  # raises if the number too large is none
            if pages and code[row] != OUTSIDE:
                page = characters[PAGE * row : PAGE * row + sizes[row]]
                printouts[start + row] = _with_error(part, row, page.decode("ascii"))

    kernel.run_blocks(work, len(results.ending), threads)
    return printouts


def _scene(cells: Cells, row: int) -> Scene:
    """Return the scene of a row. Raises UserError if its texts cannot be typed."""
    texts = {name: column[0] if len(column) == 1 else column[row] for name, column in cells.items()}
    scene = Scene(texts, source=f"row {row + 1}")
    scene.check_typed()
    return scene


def _with_error(part: Results, row: int, page: str) -> str:
    """Return a printout as a disk system lets it pass, with the error that ended it."""
    page = _DISK_COMMAND.sub("", page)
    if not part.ending[row, 0]:
        return page
    return f"{page}\n{_error(part, row).message.replace(' IN', BELL + ' IN')}"


# --- one scene by the port ---


def _recording(fields: list[str]) -> Arithmetic:
    """Return the Applesoft arithmetic, appending each number that it writes to ``fields``."""

    def write(x: Real) -> str:
        fields.append(APPLESOFT.write(x))
        return fields[-1]

    return Arithmetic(**{**vars(APPLESOFT), "write": write})


def _fill(part: Results, row: int, record: Run, fields: Sequence[str]) -> None:
    """Set a row of results from a run of the port."""
    code, line = 0, ZERO_DETERMINANT_LINE if record.zero_determinant else 0
    if record.error:
        kind = record.error.removeprefix("?").partition(" ERROR")[0]
        code, line = CODES[kind], record.line or 0
    part.ending[row] = code, line, 0, 0
    part.fields[row] = [*fields, *[""] * (len(PRINTED) - len(fields))]
    if record.A:
        part.array[row] = [_stored_number(value) for value in record.A["data"]]
    values = dict(record.reals)
    if not code or line > COMPUTED["XA"]:
        values |= _contact_velocities(record.reals)
    for k, name in enumerate(kernel.listing().steps.variables):
        part.reals[row, k] = _stored_number(values.get(name, "0" * 10))


def _stored_number(text: str) -> int:
    """Return stored bytes as a number; of a zero all are 0."""
    return 0 if text.startswith("00") else int(text, 16)


def _contact_velocities(reals: Mapping[str, str]) -> dict[str, str]:
    """Return the variables of line 340, which lines 700 and 710 use again."""
    x = {name: Real.from_stored(value) for name, value in reals.items()}
    values = (
        x["UX"] + x["D3"] * x["WA"],
        x["UY"] - x["D4"] * x["WA"],
        x["VX"] - x["D1"] * x["WB"],
        x["VY"] + x["D2"] * x["WB"],
    )
    return {f"{n}'": v.to_bytes().hex() for n, v in zip(BEFORE, values, strict=True)}
