"""One scene, for root finders and notebooks: a few microseconds a call.

The compiled machine computes all results of one scene sooner than Python asks for them. Without it
the expressions of `closedform.impact`, the only text of the formulas, are written out as the lines
of a Python function of the scene's values, once for each selection of results and kind of scene.
Python's floats are the same doubles, so the bits are those of the arrays. Whatever is out of the
ordinary (values that are no plain numbers or cannot be used, infinite bodies, a division by zero, a
result that is not finite) is left to the arrays: `solve_one` then says None.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import native
from ..fields import ANGLES
from ..names import PIVOT, RESULTS, SCENE
from ..native import program
from ..native.formulas import Expression, ExpressionTable
from .columns import INERTIAS, LARGE_ANGLE, ORDINARY, UNUSED_BY_POINTS
from .fused import CIRCLE, program_for, varying
from .impact import Impact
from .sinetable import sine_and_cosine

NAMES, ALL = tuple(SCENE), tuple(RESULTS)
LONGEST_PART = 60
"""Characters up to which what is used once is written where it is used: a local variable less. All
results take 13.7 microseconds with 0, 9.9 with 30, 9.1 with 60, 8.9 with twice that."""
PLAIN = {float, int, np.float64}
_BINARY = {
    **{"add": "+", "subtract": "-", "multiply": "*", "divide": "/"},
    **{"less": "<", "less_or_equal": "<=", "both": "and", "either": "or"},
}
_UNARY = {"negative": "-", "absolute": "abs", "not": "not ", "bits": "int"}
_HALVES = {"sine": 0, "cosine": 1}
_M, _MU = NAMES.index("M"), NAMES.index("MU")
_in_order = itemgetter(*NAMES)


def in_order(columns: Mapping[str, object]) -> tuple[Any, ...]:
    """The scene's values in the table's order; none where names are missing or unknown."""
    if "M" not in columns:
        columns = {**columns, "M": 6.0}
    try:
        return _in_order(columns) if len(columns) == len(NAMES) else ()
    except KeyError:
        return ()


def solve_one(values: tuple[Any, ...], wanted: tuple[str, ...]) -> dict[str, Any] | None:
    """The results ``wanted`` of one scene (`in_order`), numpy's float64 (STATUS: uint16), which are
    floats; None where the arrays have to look at it."""
    try:
        if not PLAIN.issuperset(map(type, values)):
            values = tuple(map(_plain, values))
        M, MU = values[_M], values[_MU]
        if M != 6 and M != 4:
            return None
        if native.library is not None:
            return by_machine(values, wanted, M == 4, MU == PIVOT)
        results = _function(wanted, M == 4, MU == PIVOT)(*map(float, values))
    except (LeftToArrays, ZeroDivisionError, OverflowError):
        return None
    if not math.isfinite(sum(results)):
        return None
    by_name: dict[str, Any] = dict(zip(wanted, map(np.float64, results), strict=True))
    if "STATUS" in by_name:
        by_name["STATUS"] = np.uint16(by_name["STATUS"])
    return by_name


class _Call:
    """A call of the machine for one scene, prepared once: all results of a kind of scene."""

    def __init__(self, point: bool, pivot: bool) -> None:
        made = program_for(varying(pivot, point), ALL)
        names = made.columns
        self.scene, self.status = np.zeros(len(NAMES)), np.zeros(1, np.uint16)
        self.results = np.zeros(len(ALL))
        self._room = program.Room(made)
        at = self.scene.ctypes.data + 8 * np.array([NAMES.index(name) for name in names], np.int64)
        into = self.results.ctypes.data + 8 * np.arange(len(ALL))
        into[-1] = self.status.ctypes.data  # STATUS
        self._room.moving[:] = [*at, *into]
        self._limits = at, np.array([ORDINARY[name] for name in names])
        self.arguments = self._room.arguments(*self._limits, 1, CIRCLE)


_calls: dict[tuple[bool, bool], list[_Call]] = defaultdict(list)
"""Those of a kind that no thread uses."""


@lru_cache(maxsize=256)
def _places(wanted: tuple[str, ...]) -> tuple[tuple[str, ...], NDArray[np.int64]]:
    """The results wanted but STATUS, and where they are among all."""
    names = tuple(name for name in wanted if name != "STATUS")
    return names, np.array([ALL.index(name) for name in names], np.int64)


def by_machine(
    values: tuple[Any, ...], wanted: tuple[str, ...], point: bool, pivot: bool
) -> dict[str, Any] | None:
    """`solve_one`, by the compiled machine."""
    free = _calls[point, pivot]
    call = free.pop() if free else _Call(point, pivot)
    call.scene[:] = values
    assert native.library is not None
    done = native.library.run(*call.arguments)
    names, places = _places(wanted)
    found, status = call.results[places], call.status[0]
    free.append(call)
    if not done or not math.isfinite(sum(found.tolist())):
        return None
    by_name: dict[str, Any] = dict(zip(names, found, strict=True))
    if len(names) < len(wanted):
        by_name["STATUS"] = status
        return {name: by_name[name] for name in wanted}
    return by_name


class LeftToArrays(Exception):
    """Values that are not plainly usable."""


def _plain(value: Any) -> float:
    """A plain number, or an array without dimensions of one. Raises `LeftToArrays`."""
    if type(value) in PLAIN:
        return float(value)
    if type(value) is np.ndarray and value.ndim == 0 and value.dtype == np.float64:
        return float(value)
    raise LeftToArrays


@lru_cache(maxsize=256)
def _function(
    wanted: tuple[str, ...], point: bool, pivot: bool
) -> Callable[..., tuple[float, ...]]:
    """The function of the scene's values, in the table's order, that gives the results."""
    table = ExpressionTable()
    scene = {name: table.column(name, varies=True) for name in NAMES}
    impact = Impact(table, scene, pivot, point, infinite=False)
    return _defined(*_written([getattr(impact, name) for name in wanted], point))


def _defined(source: str, constants: Mapping[str, float]) -> Callable[..., tuple[float, ...]]:
    """The function ``results`` of a source text."""
    names = {
        "fmod": math.fmod,
        "isfinite": math.isfinite,
        "LeftToArrays": LeftToArrays,
        "sine_and_cosine": sine_and_cosine,
        "sqrt": math.sqrt,
        **constants,
    }
    exec(compile(source, "<the formulas of one scene>", "exec"), names)
    function: Callable[..., tuple[float, ...]] = names["results"]  # type: ignore[assignment]
    return function


def _checks(point: bool) -> list[str]:
    """The lines that look whether the values can be used, and reduce angles as the arrays do."""
    asked = [name for name in NAMES if not (point and name in UNUSED_BY_POINTS)]
    usable = [f"isfinite({' + '.join(asked)})", *(f"{x} > 0.0" for x in INERTIAS if x in asked)]
    lines = [f"    if not ({' and '.join(usable)}): raise LeftToArrays"]
    for name in ANGLES:
        if name in asked:
            lines.append(f"    if not -{LARGE_ANGLE} <= {name} <= {LARGE_ANGLE}:")
            lines.append(f"        {name} = fmod({name}, 360.0)")
    return lines


def _written(results: Sequence[Expression], point: bool) -> tuple[str, dict[str, float]]:
    """The lines of the function, and the constants in them by name."""
    order = program.in_order(results)
    uses = Counter(id(operand) for e in order for operand in e.operands)
    uses.update({id(e): 2 for e in results})
    constants: dict[str, float] = {}
    text: dict[int, str] = {}
    lines = [f"def results({', '.join(NAMES)}):", *_checks(point)]
    for number, e in enumerate(order):
        name = f"v{number}"
        if e.operation == "column":
            text[id(e)] = str(e.value)
        elif e.operation == "constant":
            text[id(e)] = repr(e.value) if math.isfinite(e.value) else name
            constants[name] = e.value
        else:
            formula = _formula(e.operation, [text[id(operand)] for operand in e.operands])
            if uses[id(e)] == 1 and len(formula) < LONGEST_PART:
                text[id(e)] = f"({formula})"
            else:
                lines.append(f"    {name} = {formula}")
                text[id(e)] = name
    # adding 0.0 clears the sign of a zero, as the arrays do
    tuple_ = "".join(f"{text[id(e)]}{' + 0.0' if e.dtype == 'float' else ''}, " for e in results)
    lines.append(f"    return ({tuple_})")
    return "\n".join(lines), constants


def _formula(operation: str, operands: Sequence[str]) -> str:
    if operation in _BINARY:
        return f"{operands[0]} {_BINARY[operation]} {operands[1]}"
    if operation in _HALVES:
        return f"{operands[0]}[{_HALVES[operation]}]"
    if operation in _UNARY:
        return f"{_UNARY[operation]}({operands[0]})"
    if operation == "against":
        value, slip = operands
        return f"-{value} if {slip} > 0.0 else {value}"
    if operation == "choose":
        where, chosen, other = operands
        return f"{chosen} if {where} else {other}"
    return f"{operation}({', '.join(operands)})"
