"""Where the port is: the BASIC line being executed, and stopping after every line.

The BASIC line of a Python line of `listing` is the one in the last comment above it; `linetable`
holds it, for a package of compiled files alone."""

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
"""The listing's variables at a moment: reals by name, if assigned so far, and the array A."""


def basic_line(python_line: int) -> int | None:
    """The BASIC line that a line of ``listing.py`` translates; None above the first."""
    index = bisect_right(linetable.PYTHON_LINES, python_line) - 1
    return linetable.BASIC_LINES[index] if index >= 0 else None


_CODES = {code.co_name: code for code in _LISTING.co_consts if isinstance(code, CodeType)}
_TRANSLATIONS = {_CODES[name] for name in ("main", "gosub_1000", "gosub_1070")}
"""The functions inside `listing.impact` that BASIC lines stand in: main program, subroutines."""


def left_at(traceback: TracebackType | None) -> tuple[int | None, dict[str, Any]]:
    """Where an exception left `listing.impact`: the innermost BASIC line that it came from, and the
    local names."""
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
    """The listing's variables among the local names of `listing.impact`; ``unset`` marks those not
    assigned."""
    values = ((name, names[name]) for name in linetable.REALS if name in names)
    return Variables({name: value for name, value in values if value is not unset}, names["A"])


def begun_assignment(line: int, known: Mapping[str, Any], asked: int | None) -> str | None:
    """The variable that an error in ``line`` left as a new zero: the first one the line assigns
    that has no value yet. Applesoft creates the variable before it evaluates the formula.
    ``asked``: how many variables the last reply to an INPUT had reached."""
    assigned = linetable.ASSIGNED.get(line, [])
    if line in linetable.INPUTS and asked is not None:
        assigned = assigned[:asked]
    return next((name for name in assigned if name not in known), None)


@contextmanager
def after_every_line(after_line: AfterLine, unset: object) -> Iterator[None]:
    """While this lasts, call ``after_line(number, variables)`` each time the port leaves a BASIC
    line: another line begins, or the program ends. Lines without an effect (REM, line 420's GOTO)
    do not count."""
    current: int | None = None

    def trace(frame: FrameType, event: str, _: object) -> Any:
        nonlocal current
        if frame.f_code not in _TRANSLATIONS:
            return None
        ended = event == "return" and frame.f_code is _CODES["main"]
        line = basic_line(frame.f_lineno) if event == "line" else None if ended else current
        if line != current:
            left, current = current, line
            outer: FrameType | None = frame
            while outer is not None and outer.f_code is not _LISTING:
                outer = outer.f_back
            if left is not None and outer is not None:
                after_line(left, variables(outer.f_locals, unset))
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        yield
    finally:
        sys.settrace(before)
