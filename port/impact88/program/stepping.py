"""Where the port is: the BASIC line being executed, and stopping after every line.

The port itself keeps no books. The BASIC line of a Python line of `listing` is the one in the last
comment above it; the variables are those of the frame of `listing.impact`.
"""

from __future__ import annotations

import re
import sys
from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from types import FrameType, TracebackType

from ..applesoft.arrays import Array
from . import listing

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

_COMMENT = r" *# (\d+) (.*)"
_FILE = listing.impact.__code__.co_filename
_ASSIGNED = r"(?:^|:|THEN )\s*([A-Z][A-Z0-9]?) = "
_INPUT = r"INPUT ([A-Z0-9,]+)$"
_NO_REALS = ("A", "NL")
AfterLine = Callable[[int, "Variables"], object]


class Variables:
    """The listing's variables at a moment: reals by name, if assigned so far, and the array A."""

    __slots__ = ("A", "reals")

    def __init__(self, reals: Mapping[str, Any], A: Array | None) -> None:
        self.reals = reals
        self.A = A


@cache
def _comments() -> tuple[list[int], list[tuple[int, str]]]:
    """Python line numbers of the comments that hold BASIC, and what they hold, in file order."""
    import linecache

    places: list[int] = []
    lines: list[tuple[int, str]] = []
    for place, text in enumerate(linecache.getlines(_FILE, listing.__dict__), 1):
        if match := re.match(_COMMENT, text):
            places.append(place)
            lines.append((int(match.group(1)), match.group(2).rstrip("\n")))
    return places, lines


def basic_lines() -> list[tuple[int, str]]:
    """Number and text of every BASIC line in the port's comments, in the order of the file."""
    return list(_comments()[1])


def basic_line(python_line: int) -> int | None:
    """The BASIC line that a line of ``listing.py`` translates; None above the first."""
    places, lines = _comments()
    index = bisect_right(places, python_line) - 1
    return lines[index][0] if index >= 0 else None


def line_of(traceback: TracebackType | None) -> int | None:
    """The BASIC line an exception came from: that of the innermost frame inside a BASIC line."""
    line = None
    while traceback is not None:
        if traceback.tb_frame.f_code.co_filename == _FILE:
            line = basic_line(traceback.tb_lineno) or line
        traceback = traceback.tb_next
    return line


def names_in(traceback: TracebackType | None) -> Mapping[str, Any]:
    """The local names of `listing.impact` in the traceback of an exception that left it."""
    while traceback is not None:
        if traceback.tb_frame.f_code is listing.impact.__code__:
            return traceback.tb_frame.f_locals
        traceback = traceback.tb_next
    raise LookupError("the exception did not come from the listing")


def variables(names: Mapping[str, Any], unset: object) -> Variables:
    """The listing's variables among the local names of `listing.impact`; ``unset`` marks those not
    assigned."""
    reals = {
        name: value for name, value in names.items() if _is_variable(name) and value is not unset
    }
    return Variables(reals, names["A"])


def _is_variable(name: str) -> bool:
    """Whether a local name of `listing.impact` is one of BASIC's reals: the port's own have an
    underscore, small letters or a third character."""
    return len(name) <= 2 and name.isupper() and name.isalnum() and name not in _NO_REALS


def begun_assignment(line: int, known: Mapping[str, Any]) -> str | None:
    """The variable that an error in ``line`` left as a fresh zero: the first one the line assigns
    that has no value yet. Applesoft makes the variable before it works out the value."""
    text = dict(_comments()[1])[line]
    match = re.match(_INPUT, text)
    names = match.group(1).split(",") if match else re.findall(_ASSIGNED, text)
    return next((name for name in names if name not in known), None)


@contextmanager
def after_every_line(after_line: AfterLine, unset: object) -> Iterator[None]:
    """While this lasts, call ``after_line(number, variables)`` each time the port leaves a BASIC
    line: another line begins, or the program ends. Lines without an effect (REM, line 420's GOTO)
    do not count."""
    current: int | None = None
    inner = {
        code
        for code in listing.impact.__code__.co_consts
        if getattr(code, "co_name", "") in ("main", "gosub_1000", "gosub_1070")
    }

    def report(frame: FrameType) -> None:
        nonlocal current
        outer: FrameType | None = frame
        while outer is not None and outer.f_code is not listing.impact.__code__:
            outer = outer.f_back
        if current is not None and outer is not None:
            line, current = current, None
            after_line(line, variables(outer.f_locals, unset))

    def trace(frame: FrameType, event: str, _: object) -> Any:
        nonlocal current
        if frame.f_code not in inner:
            return None
        if event == "line":
            line = basic_line(frame.f_lineno)
            if line != current:
                report(frame)
                current = line
        elif event == "return" and frame.f_code.co_name == "main":
            report(frame)
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        yield
    finally:
        sys.settrace(before)
