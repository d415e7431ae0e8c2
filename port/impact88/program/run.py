"""Run the port on a scene, as if the 1988 program were typed in and started with RUN.

The port reads the scene's data lines, and its velocities from the keyboard. Which line of BASIC it
executes, and which variables that line assigns, is read from the comments of `listing`: the line of
a statement in Python is the one in the last comment above it.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, nullcontext
from functools import cache
from types import CodeType, FrameType, TracebackType
from typing import Any, NamedTuple

from ..apple.applesoft.console import Console
from ..apple.applesoft.operators import Real
from ..apple.applesoft.real import from_stored
from ..files import packaged_text
from ..names import check_names
from . import listing
from .arithmetics import ARITHMETICS, Arithmetic
from .scene import REPLY_LINES, Scene

BELL = "\a"
_UNPRINTED = {code: None for code in range(32) if chr(code) not in "\n\b"}
"""Control characters that are not shown. Control-H stays, so that a deleted character is
visible."""
_LISTING = listing.impact.__code__
_CODES = {code.co_name: code for code in _LISTING.co_consts if isinstance(code, CodeType)}
_TRANSLATIONS = {_CODES[name] for name in ("main", "gosub_1000", "gosub_1070")}
"""The functions inside `listing.impact` that contain BASIC lines: main program, subroutines."""
_ASSIGNED = re.compile(
    r"(?:^|:|THEN )([A-Z][A-Z0-9]?) =|FOR ([A-Z]+) =|(?:INPUT |,)([A-Z]{2})(?=,|$)"
)
"""A variable that a line of BASIC assigns."""


class Variables(NamedTuple):
    """The listing's variables at one time: assigned reals by name, and the array A."""

    reals: dict[str, Any]
    A: Any


AfterLine = Callable[[int, Variables], object]


class Run(NamedTuple):
    """The record of one run of the 1988 program.

    Parameters
    ----------
    printout : str
        Every character sent to the output, RETURN as newline.
    error : str or None
        The Applesoft error that ended the run.
    line : int or None
        The line of the error.
    reals : dict of str to str or float
        Every real variable that was assigned: its five stored bytes in hexadecimal, or a float in
        double precision.
    A : dict or None
        The array A: ``dims`` (sizes) and ``data``, first subscript fastest; None before line 360.
    zero_determinant : bool
        True where the program ended at line 1160.

    Examples
    --------
    >>> run = impact88.run(impact88.sample(1))
    >>> run.error, run.reals["KI"]
    (None, '91451476e4')
    """

    printout: str
    error: str | None
    line: int | None
    reals: dict[str, Any]
    A: dict[str, Any] | None
    zero_determinant: bool

    @property
    def page(self) -> str:
        """The printout without control characters, for people."""
        return page(self.printout)

    @property
    def floats(self) -> dict[str, float]:
        """The real variables as floats, equal to their five stored bytes."""
        values = self.reals.items()
        return {n: float(Real(from_stored(x)) if isinstance(x, str) else x) for n, x in values}

    def __repr__(self) -> str:
        ending = self.error or ("ZERO DETERMINANT" if self.zero_determinant else "END")
        return f"<Run: {ending}; {len(self.printout)} characters, {len(self.reals)} variables>"


def page(text: str) -> str:
    """Return a printout without the characters that only a terminal acts on: the form feed of line
    200, bells, the NULs that INPUT shows for a prompt, control-D."""
    return text.translate(_UNPRINTED)


def start(
    data: Mapping[str, str],
    console: Console,
    arithmetic: str | Arithmetic = "applesoft",
    after_line: AfterLine | None = None,
) -> Run:
    """Run the port on a console until the program ends.

    The printout, with any error message, goes to the console; that of the returned Run is empty.
    Raises UserError for an unknown arithmetic, and `console.EndOfInput`.
    """
    if not isinstance(arithmetic, Arithmetic):
        check_names([arithmetic], ARITHMETICS, "kind of arithmetic")
        arithmetic = ARITHMETICS[arithmetic]
    error, zero_determinant = None, False
    names: Mapping[str, Any]
    try:
        with _stopping(after_line, arithmetic) if after_line else nullcontext():
            names = listing.impact(data, arithmetic, console)
    except listing.End as end:
        zero_determinant = True
        names = _failure(end.__traceback__)[1]
    except Exception as exception:
        error = arithmetic.error(exception)
        if error is None:
            raise
        error.line, names = _failure(exception.__traceback__)
        replies_read = console.reply.begun if console.reply else 0
        if variable := _new_variable(error.line, names, arithmetic.unset, replies_read):
            names = {**names, variable: arithmetic.zero}
        console.put(f"\n?{error.kind} ERROR{BELL} IN {error.line}")
    reals, array = _variables(names, arithmetic.unset)
    return Run(
        "",
        error.message if error else None,
        error.line if error else None,
        {name: _record_value(value) for name, value in reals.items()},
        {"dims": array.sizes, "data": list(map(_record_value, array.data))} if array else None,
        zero_determinant,
    )


def run(
    scene: Mapping[str, str],
    arithmetic: str | Arithmetic = "applesoft",
    *,
    dos: bool = True,
    after_line: AfterLine | None = None,
) -> Run:
    """Run the 1988 program on a scene and return its printout, variables and error.

    Parameters
    ----------
    scene : mapping of str to str
        The scene, as texts: the digits typed matter.
    arithmetic : {"applesoft", "float64"} or Arithmetic, default "applesoft"
        The arithmetic that computes and writes numbers.
    dos : bool, default True
        True if a disk system handles lines that begin with control-D.
    after_line : callable, optional
        Called after every BASIC line with its number and the variables.

    Returns
    -------
    Run
        The record of the run.

    Raises
    ------
    UserError
        For an unknown arithmetic, or a scene that cannot be typed into the program
        (`Scene.check_typed`).

    Examples
    --------
    >>> impact88.run(impact88.sample(1)).page.splitlines()[-3]
    ' WA= -1.745 WB= -.8202'
    """
    scene = scene if isinstance(scene, Scene) else Scene(scene)
    scene.check_typed()
    characters: list[str] = []
    replies = iter(scene.keyboard())
    console = Console(lambda: next(replies, None), characters.append, dos=dos)
    record = start(scene, console, arithmetic, after_line)
    return record._replace(printout="".join(characters))


def _record_value(value: Any) -> Any:
    """Return a real's stored bytes in hexadecimal; a double unchanged, or as text if not finite."""
    if isinstance(value, Real):
        return value.to_bytes().hex()
    return value if math.isfinite(value) else str(value)


# --- lines and variables of the port ---


@cache
def _lines() -> list[tuple[int, str]]:
    """Return, for each line of `listing`, the BASIC line that it translates and its statements."""
    lines = [(0, "")]
    for row in packaged_text("impact88.program", "listing.py").splitlines():
        comment = re.match(r" +# (\d+) (.*)", row)
        lines.append((int(comment[1]), comment[2]) if comment else lines[-1])
    return lines


def basic_line(python_line: int) -> int:
    """Return the BASIC line that a line of ``listing.py`` translates, 0 above the first."""
    return _lines()[python_line][0]


def _new_variable(line: int, names: Mapping[str, Any], unset: object, replies_read: int) -> str:
    """Return the variable that an error left as a new zero, "" without one.

    Applesoft creates a variable before it evaluates the formula, so it is the first one assigned in
    the line that has no value yet. ``replies_read``: the variables that INPUT had reached."""
    statements = dict(_lines())[line].partition(" REM")[0]
    assigned = ["".join(names) for names in _ASSIGNED.findall(statements)]
    if line in REPLY_LINES:
        assigned = assigned[:replies_read]
    return next((name for name in assigned if names[name] is unset), "")


def _failure(traceback: TracebackType | None) -> tuple[int, Mapping[str, Any]]:
    """Return the innermost BASIC line that raised an exception in the port, and its names."""
    line, names = 0, {}
    while traceback is not None:
        frame = traceback.tb_frame
        if frame.f_code is _LISTING:
            names = frame.f_locals
        elif frame.f_code in _TRANSLATIONS:
            line = basic_line(traceback.tb_lineno) or line
        traceback = traceback.tb_next
    return line, names


def _variables(names: Mapping[str, Any], unset: Any) -> Variables:
    """Return the variables among the local names of `listing.impact`: those of one or two letters
    that are numbers. ``unset``: the value of those not assigned."""
    kind = type(unset)
    reals = {n: x for n, x in names.items() if len(n) < 3 and type(x) is kind and x is not unset}
    return Variables(reals, names["A"])


@contextmanager
def _stopping(after_line: AfterLine, arithmetic: Arithmetic) -> Iterator[None]:
    """Context in which ``after_line(number, variables)`` is called each time the port leaves a
    BASIC line, because another one begins or the program ends. Lines without effect (REM, line
    420's GOTO) are skipped."""
    current = 0

    def trace(frame: FrameType, event: str, _: object) -> Any:
        nonlocal current
        if frame.f_code not in _TRANSLATIONS:
            return None
        line = basic_line(frame.f_lineno) if event == "line" else current
        if event == "return" and frame.f_code is _CODES["main"]:
            line = 0
        if line != current:
            finished_line, current = current, line
            outer: Any = frame
            while outer.f_code is not _LISTING:
                outer = outer.f_back
            if finished_line:
                after_line(finished_line, _variables(outer.f_locals, arithmetic.unset))
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        yield
    finally:
        sys.settrace(before)
