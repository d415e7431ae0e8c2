"""The BASIC line that the port executes, and callbacks after every line.

The BASIC line of a Python line of `listing` is the one in the last comment above it. `linetable`
stores them, for installations without source files."""

from __future__ import annotations

import sys
from bisect import bisect_right
from collections import namedtuple
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from types import CodeType, FrameType, TracebackType

from . import linetable, listing

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

_LISTING = listing.impact.__code__
AfterLine = Callable[[int, "Variables"], object]

if _LISTING.co_firstlineno != linetable.FIRST_PYTHON_LINE:
    raise ImportError(
        "linetable.py does not belong to listing.py; run python tests/support/linetable.py"
    )


Variables = namedtuple("Variables", "reals A")
"""The listing's variables at one time: assigned reals by name, and the array A."""


def basic_line(python_line: int) -> int | None:
    """Return the BASIC line that a line of ``listing.py`` translates; None above the first."""
    index = bisect_right(linetable.PYTHON_LINES, python_line) - 1
    return linetable.BASIC_LINES[index] if index >= 0 else None


_CODES = {code.co_name: code for code in _LISTING.co_consts if isinstance(code, CodeType)}
_TRANSLATIONS = {_CODES[name] for name in ("main", "gosub_1000", "gosub_1070")}
"""The functions inside `listing.impact` that contain BASIC lines: main program, subroutines."""


def failure_state(traceback: TracebackType | None) -> tuple[int | None, dict[str, Any]]:
    """Return the innermost BASIC line that raised an exception in `listing.impact`, and the local
    names there."""
    line, names = None, {}
    while traceback is not None:
        frame = traceback.tb_frame
        if frame.f_code is _LISTING:
            names = frame.f_locals
        elif frame.f_code in _TRANSLATIONS:
            line = basic_line(traceback.tb_lineno) or line
        traceback = traceback.tb_next
    return line, names


def variables(names: Mapping[str, Any], unset: object) -> Variables:
    """Return the listing's variables among the local names of `listing.impact`; ``unset`` is the
    value of those not assigned."""
    values = ((name, names[name]) for name in linetable.REALS if name in names)
    return Variables({name: value for name, value in values if value is not unset}, names["A"])


def unfinished_assignment(
    line: int, values: Mapping[str, Any], input_count: int | None
) -> str | None:
    """Return the variable that an error in ``line`` left as a new zero, None without one.

    Applesoft creates a variable before it evaluates the formula, so it is the first one assigned in
    the line that has no value yet. ``values``: the variables with values; ``input_count``: the
    number of variables that the last reply to INPUT had reached."""
    names = linetable.ASSIGNED.get(line, [])
    if line in linetable.INPUTS and input_count is not None:
        names = names[:input_count]
    return next((name for name in names if name not in values), None)


@contextmanager
def after_every_line(after_line: AfterLine, unset: object) -> Iterator[None]:
    """Context in which ``after_line(number, variables)`` is called each time the port leaves a
    BASIC line, because another one begins or the program ends. Lines without effect (REM, line
    420's GOTO) are skipped."""
    current: int | None = None

    def trace(frame: FrameType, event: str, _: object) -> Any:
        nonlocal current
        if frame.f_code not in _TRANSLATIONS:
            return None
        is_end = event == "return" and frame.f_code is _CODES["main"]
        line = basic_line(frame.f_lineno) if event == "line" else None if is_end else current
        if line != current:
            finished_line, current = current, line
            outer: FrameType | None = frame
            while outer is not None and outer.f_code is not _LISTING:
                outer = outer.f_back
            if finished_line is not None and outer is not None:
                after_line(finished_line, variables(outer.f_locals, unset))
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        yield
    finally:
        sys.settrace(before)
