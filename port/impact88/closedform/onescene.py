"""One scene: the same formulas as straight Python, for root finders and notebooks.

numpy spends its time on calls, not on numbers, when there is one number a call. Here the
expressions of `closedform.impact`, the only text of the formulas, are written out as the lines of a
Python function of the scene's values, once for each selection of results and kind of scene, and
compiled. Python's floats are the same doubles, so the bits are those of the arrays. Whatever is out
of the ordinary (values that are no plain numbers or cannot be used, infinite bodies, a division by
zero, a result that is not finite) is left to the arrays: `solve_one` then says None.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from operator import itemgetter
from typing import Any

import numpy as np

from .. import native
from ..fields import ANGLES
from ..names import DEFAULT_M, PIVOT, SCENE
from ..native.formulas import Expression, ExpressionTable
from ..native.program import Program, in_order
from . import degrees
from .columns import INERTIAS, LARGE_ANGLE, UNUSED_BY_POINTS
from .fused import CIRCLE
from .impact import Impact

NAMES = tuple(SCENE)
_PLAIN = {float, int, np.float64}
_BINARY = {
    **{"add": "+", "subtract": "-", "multiply": "*", "divide": "/"},
    **{"less": "<", "less_or_equal": "<=", "both": "and", "either": "or"},
}
_UNARY = {"negative": "-", "absolute": "abs", "not": "not ", "bits": "int"}
_HALVES = {"sine": 0, "cosine": 1}
_M, _MU = NAMES.index("M"), NAMES.index("MU")
_in_order = itemgetter(*NAMES)


def solve_one(columns: Mapping[str, object], wanted: tuple[str, ...]) -> dict[str, Any] | None:
    """The results ``wanted`` of one scene, numpy's float64 (STATUS: uint16), which are floats; None
    where the arrays have to look at it. ``columns``: as `solve`'s."""
    if "M" not in columns:
        columns = {**columns, "M": DEFAULT_M}
    if len(columns) != len(NAMES):
        return None
    try:
        values = _in_order(columns)
        if not _PLAIN.issuperset(map(type, values)):
            values = tuple(map(_plain, values))
        numbers = tuple(map(float, values))
        M, MU = numbers[_M], numbers[_MU]
        if M != 6 and M != 4:
            return None
        results = _function(wanted, M == 4, MU == PIVOT, native.library)(*numbers)
    except (KeyError, LeftToArrays, ZeroDivisionError, OverflowError):
        return None
    if not math.isfinite(sum(results)):
        return None
    by_name: dict[str, Any] = dict(zip(wanted, map(np.float64, results), strict=True))
    if "STATUS" in by_name:
        by_name["STATUS"] = np.uint16(by_name["STATUS"])
    return by_name


class LeftToArrays(Exception):
    """Values that are not plainly usable."""


def _plain(value: Any) -> float:
    """A plain number, or an array without dimensions of one. Raises `LeftToArrays`."""
    if type(value) in _PLAIN:
        return float(value)
    if type(value) is np.ndarray and value.ndim == 0 and value.dtype == np.float64:
        return float(value)
    raise LeftToArrays


@lru_cache(maxsize=256)
def _function(
    wanted: tuple[str, ...], point: bool, pivot: bool, machine: object
) -> Callable[..., tuple[float, ...]]:
    """The function of the scene's values, in the table's order, that gives the results."""
    table = ExpressionTable()
    scene = {name: table.column(name, varies=True) for name in NAMES}
    impact = Impact(table, scene, pivot, point, infinite=False)
    results = {name: getattr(impact, name) for name in wanted}
    if native.library is not None and results:
        return _Compiled(results, point)
    source, constants = _written(list(results.values()), point)
    return _defined(source, constants)


def _defined(source: str, constants: Mapping[str, float]) -> Callable[..., tuple[float, ...]]:
    """The function ``results`` of a source text."""
    names = {
        "fmod": math.fmod,
        "isfinite": math.isfinite,
        "LeftToArrays": LeftToArrays,
        "sine_and_cosine": _sine_and_cosine(),
        "sqrt": math.sqrt,
        **constants,
    }
    exec(compile(source, "<the formulas of one scene>", "exec"), names)
    function: Callable[..., tuple[float, ...]] = names["results"]  # type: ignore[assignment]
    return function


class _Compiled:
    """The same function by the compiled machine, which has its own room in every thread."""

    def __init__(self, results: Mapping[str, Expression], point: bool) -> None:
        checks = [f"def results({', '.join(NAMES)}):", *_checks(point)]
        self._checked = _defined("\n".join([*checks, f"    return {', '.join(NAMES)}"]), {})
        shown = {n: e.operands[0] if e.operation == "bits" else e for n, e in results.items()}
        self._program = Program(shown, ["RESULT"] * len(shown))
        self._rows = [NAMES.index(name) for name in self._program.columns]
        self._picked = itemgetter(*self._rows)
        self._of_thread = threading.local()

    def __call__(self, *numbers: float) -> tuple[float, ...]:
        scene = self._checked(*numbers)
        if not hasattr(self._of_thread, "ready"):
            self._of_thread.ready = self._ready()
        columns, results, run = self._of_thread.ready
        columns[:] = self._picked(scene)
        run()
        return tuple(results.tolist())

    def _ready(self) -> tuple[Any, Any, Callable[[], int]]:
        """Room for the columns and the results of one scene, and the call that fills it."""
        columns, results = np.empty(len(self._rows)), np.empty(len(self._program.results))
        read, written = (
            array.ctypes.data + 8 * np.arange(len(array)) for array in (columns, results)
        )
        run = self._program.prepared(read, written, 1, self._program.room(), CIRCLE)
        return columns, results, run


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
    constants: dict[str, float] = {}
    place: dict[int, str] = {}
    lines = [f"def results({', '.join(NAMES)}):", *_checks(point)]
    for number, e in enumerate(in_order(results)):
        operands = [place[id(operand)] for operand in e.operands]
        if e.operation == "column":
            place[id(e)] = str(e.value)
            continue
        name = place[id(e)] = f"v{number}"
        if e.operation == "constant":
            constants[name] = float(e.value)
            continue
        lines.append(f"    {name} = {_formula(e.operation, operands)}")
    # adding 0.0 clears the sign of a zero, as the arrays do
    tuple_ = "".join(f"{place[id(e)]}{' + 0.0' if e.dtype == 'float' else ''}, " for e in results)
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
    return f"{operation}({', '.join(operands)})"


def _sine_and_cosine() -> Callable[[float], tuple[float, float]]:
    """`degrees.sine_and_cosine` of one angle: the same operations, one after another."""
    turn = degrees.table().tolist()
    quarter = degrees.STEPS // 4
    last, shift = degrees.STEPS - 1, degrees.INTEGER_IN_LOW_BITS
    step, per_step = degrees.STEP, 1 / degrees.STEP
    s0, s1, s2, c1, c2 = degrees.POLYNOMIALS

    def sine_and_cosine(angle: float) -> tuple[float, float]:
        steps = angle * per_step + shift - shift
        index = int(steps) & last
        sine, cosine = turn[index], turn[index + quarter]
        rest = angle - steps * step
        square = rest * rest
        small = ((square * s2 + s1) * square + s0) * rest
        less = (square * c2 + c1) * square
        return (
            sine + (cosine * small + sine * less),
            cosine + (cosine * less - sine * small),
        )

    return sine_and_cosine
