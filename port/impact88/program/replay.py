"""Many scenes through the 1988 listing at once: columns in; pages, fields, reals and errors out.

The listing is compiled from ``impact.bas`` (`compiler`) and executed by `applesoft.c`; without the
library the port runs each scene. Both give the Apple's own bits.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ..names import FINAL_VELOCITIES, check_names
from . import kernel
from .batches import (
    COLUMNS,
    END_LINE,
    ROWS,
    ZERO_DETERMINANT_LINE,
    message_of,
    run_port,
    run_scenes,
)
from .generate import BEFORE
from .kernel import Rows

Mask = npt.NDArray[np.bool_]
Texts = npt.NDArray[np.str_]
Stored = npt.NDArray[np.uint64]
Floats = npt.NDArray[np.float64]

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

CALL_LINE = 570  # calls the subroutines
FIRST_SUBROUTINE = 1000
FINAL_SPINS = ("WAF", "WBF")
"""Results that line 750 passes over unless M is N."""
_VARIABLES = (
    {"MUP": "MU"} | {name: f"{name}'" for name in BEFORE} | {f"{name}F": name for name in BEFORE}
)
"""Results that are another variable of the listing."""


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
            self.error[row] = message_of(rows[row])
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
        kernel.listing(), columns, run_port, (ROWS * COLUMNS, len(PRINTED)), pages, threads
    )
    return Replay(rows, printouts if pages else None)
